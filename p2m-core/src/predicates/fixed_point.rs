//! Determinants of whole numbers below 2^61, in five words: no rounding, no allocation.

use crate::kernel::power_of_two;
use crate::kernel::vector::{V3, exponent, larger, largest};
use std::cmp::Ordering;

/// Differences of whole numbers below 2^61.
type Row = [i64; 3];

/// The differences p - origin in units of 2^-61 of the least power of two above all coordinates; `None` if these are
/// not whole. They are if no coordinate but 0 is below 2^-8 of the largest, or if all have few bits, as in grids.
#[inline]
#[allow(clippy::float_cmp, clippy::cast_precision_loss, reason = "whether it is whole is equality")]
pub(super) fn rows<const N: usize>(points: &[V3; N], origin: V3) -> Option<[Row; N]> {
    let size = larger(largest(points), largest(&[origin]));
    let scale = if size == 0.0 { 1.0 } else { power_of_two(60 - exponent(size)) };
    let mut is_whole = true;
    let mut whole = |x: f64| {
        let scaled = x * scale;
        #[allow(clippy::cast_possible_truncation, reason = "below 2^61")]
        let n = scaled as i64;
        is_whole &= n as f64 == scaled;
        n
    };
    let origin = origin.map(&mut whole);
    let mut rows = [[0; 3]; N];
    for (row, p) in rows.iter_mut().zip(points) {
        for k in 0..3 {
            row[k] = whole(p[k]) - origin[k];
        }
    }
    is_whole.then_some(rows)
}

/// The sign of a x b . c.
pub(super) fn orientation([a, b, c]: [Row; 3]) -> Ordering {
    // Below 6 2^186.
    let mut sum = [0; 3];
    for (k, z) in c.into_iter().enumerate() {
        add(&mut sum, product(minor(a, b, (k + 1) % 3, (k + 2) % 3), z));
    }
    sign(&sum)
}

/// `Greater` if the origin is inside the sphere of four points with orientation(b - a, c - a, d - a) > 0.
pub(super) fn sphere(rows: [Row; 4]) -> Ordering {
    let [a, b, c, d] = rows;
    let xy = |p: Row, q: Row| minor(p, q, 0, 1);
    let (ab, bc, cd, da, ac, bd) = (xy(a, b), xy(b, c), xy(c, d), xy(d, a), xy(a, c), xy(b, d));
    // Of b, c, d, and of what follows it in the circle.
    let determinants = [
        three([(cd, b[2]), (-bd, c[2]), (bc, d[2])]),
        three([(da, c[2]), (ac, d[2]), (cd, a[2])]),
        three([(ab, d[2]), (bd, a[2]), (da, b[2])]),
        three([(bc, a[2]), (-ac, b[2]), (ab, c[2])]),
    ];
    // Below 24 2^186 3 2^124.
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

/// p_i q_j - q_i p_j, below 2^125.
#[inline(always)]
#[allow(clippy::inline_always, reason = "four instructions")]
fn minor(p: Row, q: Row, i: usize, j: usize) -> i128 {
    i128::from(p[i]) * i128::from(q[j]) - i128::from(q[i]) * i128::from(p[j])
}

/// The sum of three products.
#[inline]
fn three(terms: [(i128, i64); 3]) -> [u64; 3] {
    let mut sum = [0; 3];
    for (a, b) in terms {
        add(&mut sum, product(a, b));
    }
    sum
}

/// a b in words of two's complement, the lowest first.
#[inline]
#[allow(clippy::cast_possible_truncation, reason = "words of it")]
fn product(a: i128, b: i64) -> [u64; 3] {
    let (m, n) = (a.unsigned_abs(), u128::from(b.unsigned_abs()));
    let low = (m as u64 as u128) * n;
    let high = (m >> 64) * n + (low >> 64);
    let words = [low as u64, high as u64, (high >> 64) as u64];
    if (a < 0) == (b < 0) { words } else { negative(words) }
}

/// a b, of numbers that are not negative.
#[inline]
#[allow(clippy::cast_possible_truncation, reason = "words of it")]
fn wide_product(a: [u64; 3], b: u128) -> [u64; 5] {
    let mut words = [0; 5];
    for (j, b) in [b as u64, (b >> 64) as u64].into_iter().enumerate() {
        let mut carry = 0;
        for (i, a) in a.into_iter().enumerate() {
            // At most (2^64 - 1)^2 + 2 (2^64 - 1).
            let sum = u128::from(a) * u128::from(b) + u128::from(words[i + j]) + carry;
            words[i + j] = sum as u64;
            carry = sum >> 64;
        }
        words[j + 3] = carry as u64;
    }
    words
}

#[inline]
fn add<const N: usize>(sum: &mut [u64; N], summand: [u64; N]) {
    let mut carry = false;
    for (s, x) in sum.iter_mut().zip(summand) {
        let (with_x, over) = s.overflowing_add(x);
        let (with_carry, over_again) = with_x.overflowing_add(u64::from(carry));
        (*s, carry) = (with_carry, over | over_again);
    }
}

#[inline]
fn negative<const N: usize>(words: [u64; N]) -> [u64; N] {
    let mut sum = words.map(|w| !w);
    let mut one = [0; N];
    one[0] = 1;
    add(&mut sum, one);
    sum
}

fn sign<const N: usize>(words: &[u64; N]) -> Ordering {
    if words[N - 1] >> 63 == 1 {
        Ordering::Less
    } else if words.iter().all(|w| *w == 0) {
        Ordering::Equal
    } else {
        Ordering::Greater
    }
}
