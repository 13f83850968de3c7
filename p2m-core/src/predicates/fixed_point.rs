//! Signs of determinants in fixed-point arithmetic: integers below 2^61 in units of a common power of two.
//!
//! Sums of their products fit into five 64-bit words, so there is neither rounding nor allocation.

use crate::kernel::power_of_two;
use crate::kernel::vector::{V3, exponent, larger, largest};
use std::cmp::Ordering;

/// A vector whose components are differences of integers below 2^61.
type Row = [i64; 3];

/// Returns the differences p - origin in units of 2^-61 of the least power of two above all coordinates, or `None` if a
/// coordinate is not a multiple of the unit.
///
/// All coordinates are multiples if each is 0 or at least 2^-8 of the largest one, or if all have few bits, as in
/// grids.
#[inline]
#[allow(clippy::float_cmp, clippy::cast_precision_loss, reason = "a multiple of the unit is one exactly")]
pub(super) fn rows<const N: usize>(points: &[V3; N], origin: V3) -> Option<[Row; N]> {
    let size = larger(largest(points), largest(&[origin]));
    let scale = if size == 0.0 { 1.0 } else { power_of_two(60 - exponent(size)) };
    let mut all_are_integers = true;
    let mut to_integer = |x: f64| {
        let scaled = x * scale;
        #[allow(clippy::cast_possible_truncation, reason = "below 2^61")]
        let n = scaled as i64;
        all_are_integers &= n as f64 == scaled;
        n
    };
    let origin = origin.map(&mut to_integer);
    let mut rows = [[0; 3]; N];
    for (row, p) in rows.iter_mut().zip(points) {
        for k in 0..3 {
            row[k] = to_integer(p[k]) - origin[k];
        }
    }
    all_are_integers.then_some(rows)
}

/// Returns the sign of a x b . c.
pub(super) fn orientation([a, b, c]: [Row; 3]) -> Ordering {
    // The magnitude of the sum is below 6 2^186.
    let mut sum = [0; 3];
    for (k, z) in c.into_iter().enumerate() {
        add(&mut sum, product(minor(a, b, (k + 1) % 3, (k + 2) % 3), z));
    }
    sign(&sum)
}

/// Returns `Greater` if the origin is inside the sphere of four points for which orientation(b - a, c - a, d - a) is
/// positive.
pub(super) fn sphere(rows: [Row; 4]) -> Ordering {
    let [a, b, c, d] = rows;
    let xy = |p: Row, q: Row| minor(p, q, 0, 1);
    let (ab, bc, cd, da, ac, bd) = (xy(a, b), xy(b, c), xy(c, d), xy(d, a), xy(a, c), xy(b, d));
    // These are the determinants of the rows b, c, d and of their cyclic shifts.
    let determinants = [
        sum_of_products([(cd, b[2]), (-bd, c[2]), (bc, d[2])]),
        sum_of_products([(da, c[2]), (ac, d[2]), (cd, a[2])]),
        sum_of_products([(ab, d[2]), (bd, a[2]), (da, b[2])]),
        sum_of_products([(bc, a[2]), (-ac, b[2]), (ab, c[2])]),
    ];
    // The magnitude of the sum is below 24 2^186 3 2^124.
    let mut sum = [0; 5];
    for (i, (row, determinant)) in rows.iter().zip(determinants).enumerate() {
        let square = |x: i64| u128::from(x.unsigned_abs()) * u128::from(x.unsigned_abs());
        let length = square(row[0]) + square(row[1]) + square(row[2]);
        let is_negative = determinant[2] >> 63 == 1;
        let magnitude = if is_negative { negative(determinant) } else { determinant };
        let term = wide_product(magnitude, length);
        add(&mut sum, if is_negative == (i % 2 == 0) { negative(term) } else { term });
    }
    sign(&sum)
}

/// Returns p_i q_j - q_i p_j, whose magnitude is below 2^125.
#[inline(always)]
#[allow(clippy::inline_always, reason = "four instructions")]
fn minor(p: Row, q: Row, i: usize, j: usize) -> i128 {
    i128::from(p[i]) * i128::from(q[j]) - i128::from(q[i]) * i128::from(p[j])
}

/// Returns the sum of three products.
#[inline]
fn sum_of_products(terms: [(i128, i64); 3]) -> [u64; 3] {
    let mut sum = [0; 3];
    for (a, b) in terms {
        add(&mut sum, product(a, b));
    }
    sum
}

/// Returns a b as words in two's complement, the lowest word first.
#[inline]
#[allow(clippy::cast_possible_truncation, reason = "words of the product")]
fn product(a: i128, b: i64) -> [u64; 3] {
    let (m, n) = (a.unsigned_abs(), u128::from(b.unsigned_abs()));
    let low = (m as u64 as u128) * n;
    let high = (m >> 64) * n + (low >> 64);
    let words = [low as u64, high as u64, (high >> 64) as u64];
    if (a < 0) == (b < 0) { words } else { negative(words) }
}

/// Returns a b for non-negative numbers, the lowest word first.
#[inline]
#[allow(clippy::cast_possible_truncation, reason = "words of the product")]
fn wide_product(a: [u64; 3], b: u128) -> [u64; 5] {
    let mut words = [0; 5];
    for (j, b) in [b as u64, (b >> 64) as u64].into_iter().enumerate() {
        let mut carry = 0;
        for (i, a) in a.into_iter().enumerate() {
            // The sum is at most (2^64 - 1)^2 + 2 (2^64 - 1), which is below 2^128.
            let sum = u128::from(a) * u128::from(b) + u128::from(words[i + j]) + carry;
            words[i + j] = sum as u64;
            carry = sum >> 64;
        }
        words[j + 3] = carry as u64;
    }
    words
}

/// Adds a number in two's complement to a sum.
#[inline]
fn add<const N: usize>(sum: &mut [u64; N], summand: [u64; N]) {
    let mut carry = false;
    for (s, x) in sum.iter_mut().zip(summand) {
        let (with_x, overflow) = s.overflowing_add(x);
        let (with_carry, overflow_by_carry) = with_x.overflowing_add(u64::from(carry));
        (*s, carry) = (with_carry, overflow | overflow_by_carry);
    }
}

/// Returns the negative of a number in two's complement.
#[inline]
fn negative<const N: usize>(words: [u64; N]) -> [u64; N] {
    let mut sum = words.map(|w| !w);
    let mut one = [0; N];
    one[0] = 1;
    add(&mut sum, one);
    sum
}

/// Returns the sign of a number in two's complement.
fn sign<const N: usize>(words: &[u64; N]) -> Ordering {
    if words[N - 1] >> 63 == 1 {
        Ordering::Less
    } else if words.iter().all(|w| *w == 0) {
        Ordering::Equal
    } else {
        Ordering::Greater
    }
}
