//! Distances in exact rational arithmetic.
//!
//! Coordinates are integers in units of a common power of two, so everything up to the squared distance is exact:
//! a fraction of two integers. Only where a bound on the distance itself is to be checked is its root taken, in fixed
//! point with at least 60 bits below u M, and rounded so that a check can only be too strict.

use dashu_int::ops::{BitTest, SquareRoot};
use dashu_int::{IBig, UBig};
use std::cmp::Ordering;

/// Three coordinates.
pub(crate) type V = [IBig; 3];

/// A finite f64 as mantissa and exponent.
fn decompose(x: f64) -> (i64, i64) {
    let bits = x.to_bits();
    let exponent = i64::try_from((bits >> 52) & 0x7ff).expect("eleven bits");
    let fraction = i64::try_from(bits & ((1 << 52) - 1)).expect("52 bits");
    let (mantissa, exponent) = if exponent == 0 { (fraction, -1074) } else { (fraction | 1 << 52, exponent - 1075) };
    (if x.is_sign_negative() { -mantissa } else { mantissa }, exponent)
}

/// The exponent of the lowest set bit; a large one for zero.
pub(crate) fn lowest_bit(x: f64) -> i64 {
    let (mantissa, exponent) = decompose(x);
    if mantissa == 0 { 2000 } else { exponent + i64::from(mantissa.trailing_zeros()) }
}

/// x as a multiple of 2^unit, which must divide it.
pub(crate) fn integer(x: f64, unit: i64) -> IBig {
    let (mantissa, exponent) = decompose(x);
    let shift = exponent - unit;
    let up = |n: i64| usize::try_from(n).expect("not negative");
    if shift >= 0 { IBig::from(mantissa) << up(shift) } else { IBig::from(mantissa) >> up(-shift) }
}

pub(crate) fn sub(a: &V, b: &V) -> V {
    std::array::from_fn(|k| &a[k] - &b[k])
}

pub(crate) fn dot(a: &V, b: &V) -> IBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

pub(crate) fn cross(a: &V, b: &V) -> V {
    std::array::from_fn(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        &a[i] * &b[j] - &a[j] * &b[i]
    })
}

/// A non-negative fraction.
#[derive(Clone, Debug)]
struct Fraction {
    numerator: IBig,
    denominator: IBig,
}

impl Fraction {
    fn cmp(&self, other: &Self) -> Ordering {
        (&self.numerator * &other.denominator).cmp(&(&other.numerator * &self.denominator))
    }
}

/// The exact squared distance from a query to the convex hull of one to three vertices.
#[derive(Clone, Debug)]
pub struct Distance {
    square: Fraction,
    /// The largest squared distance from the query to a vertex.
    reach: IBig,
    /// Lengths are in units of 2^unit.
    unit: i64,
}

impl Distance {
    /// The distance from `query` to the point, segment or triangle of `vertices`, degenerate or not; all finite.
    #[must_use]
    pub fn new(query: [f64; 3], vertices: &[[f64; 3]]) -> Self {
        let unit = vertices.as_flattened().iter().chain(&query).map(|x| lowest_bit(*x)).min().expect("coordinates");
        let exact = |p: [f64; 3]| p.map(|x| integer(x, unit));
        let q = exact(query);
        let offsets: Vec<V> = vertices.iter().map(|v| sub(&exact(*v), &q)).collect();
        let squares: Vec<IBig> = offsets.iter().map(|v| dot(v, v)).collect();
        let mut candidates: Vec<Fraction> =
            squares.iter().map(|s| Fraction { numerator: s.clone(), denominator: IBig::ONE }).collect();
        let n = offsets.len();
        let edges = match n {
            1 => 0,
            2 => 1,
            _ => 3,
        };
        for i in 0..edges {
            let (a, b) = (&offsets[i], &offsets[(i + 1) % n]);
            let d = sub(b, a);
            let length = dot(&d, &d);
            let along = -dot(a, &d);
            if along > IBig::ZERO && along < length {
                let numerator = &squares[i] * &length - &along * &along;
                candidates.push(Fraction { numerator, denominator: length });
            }
        }
        if n == 3 {
            let normal = cross(&sub(&offsets[1], &offsets[0]), &sub(&offsets[2], &offsets[0]));
            let inside = (0..3).all(|i| {
                let (a, b) = (&offsets[i], &offsets[(i + 1) % 3]);
                // The query is the origin: (b - a) x (0 - a) must not point against the normal.
                dot(&normal, &cross(a, &sub(b, a))) >= IBig::ZERO
            });
            let denominator = dot(&normal, &normal);
            if inside && denominator > IBig::ZERO {
                let height = dot(&normal, &offsets[0]);
                candidates.push(Fraction { numerator: &height * &height, denominator });
            }
        }
        let square = candidates.into_iter().min_by(Fraction::cmp).expect("at least one vertex");
        let reach = squares.into_iter().max().expect("at least one vertex");
        Self { square, reach, unit }
    }

    /// Compares two exact distances.
    #[must_use]
    pub fn compare(&self, other: &Self) -> Ordering {
        let unit = self.unit.min(other.unit);
        let at = |d: &Self| Fraction {
            numerator: &d.square.numerator << usize::try_from(2 * (d.unit - unit)).expect("not negative"),
            denominator: d.square.denominator.clone(),
        };
        at(self).cmp(&at(other))
    }

    /// Distance and reach, each rounded down, as multiples of 2^fine.
    fn fixed(&self, fine: i64) -> (UBig, UBig) {
        let shift = usize::try_from(2 * (self.unit - fine)).expect("finer than the input");
        let root = |x: IBig| UBig::try_from(x).expect("squares are not negative").sqrt();
        let square = (&self.square.numerator << shift) / &self.square.denominator;
        (root(square), root(&self.reach << shift))
    }

    /// |computed - true| in units of u M, M being the largest distance from the query to a vertex, after `eta` has been
    /// taken off; rounded up. Infinite if `computed` is infinite or NaN although the true distance is below 2^1024.
    ///
    /// `bits` is 53 for u = 2^-53.
    #[must_use]
    pub fn error(&self, computed: f64, bits: u32, eta: f64) -> f64 {
        self.error_per(computed, bits, eta, false)
    }

    /// The same in units of u d.
    #[must_use]
    pub fn relative_error(&self, computed: f64, bits: u32, eta: f64) -> f64 {
        self.error_per(computed, bits, eta, true)
    }

    fn error_per(&self, computed: f64, bits: u32, eta: f64, relative: bool) -> f64 {
        if !computed.is_finite() {
            let limit = Self::new([0.0; 3], &[[f64::MAX, 0.0, 0.0]]);
            return if computed > 0.0 && self.compare(&limit) == Ordering::Greater { 0.0 } else { f64::INFINITY };
        }
        // Where it cannot matter beside u M it would only make numbers longer; the distance may be any part of M.
        let eta = if relative || self.unit < lowest_bit(eta) + 174 { eta } else { 0.0 };
        // 2 max(bits, 64) bits below the lowest bit of anything: u M is at least 2^(unit - 53).
        let fine = self.unit.min(lowest_bit(computed)).min(lowest_bit(eta)) - 160;
        let (distance, reach) = self.fixed(fine);
        let computed = integer(computed, fine);
        let difference = (computed - IBig::from(distance.clone())).into_parts().1 + UBig::ONE;
        let eta = UBig::try_from(integer(eta, fine)).expect("not negative");
        if difference <= eta {
            return 0.0;
        }
        let per = if relative { distance } else { reach };
        if per == UBig::ZERO {
            return if difference <= UBig::ONE { 0.0 } else { f64::INFINITY };
        }
        // In 2^-20 of u M, rounded up.
        let ratio = ((difference - eta) << (20 + bits as usize)) / per + UBig::ONE;
        ratio.to_f64().value() / f64::from(1 << 20)
    }

    /// Whether the true distance is at least `bound`; it is not if that is infinite or NaN.
    #[must_use]
    pub fn is_at_least(&self, bound: f64) -> bool {
        if bound <= 0.0 {
            return true;
        }
        if !bound.is_finite() {
            return false;
        }
        self.compare(&Self::new([0.0; 3], &[[bound, 0.0, 0.0]])) != Ordering::Less
    }

    /// The true distance as the sum of a rounded one and what that leaves, to more than 110 bits. Of scenes whose scale
    /// is not extreme: neither is to leave the range of f64.
    #[must_use]
    pub fn length(&self) -> [f64; 2] {
        // 118 bits of the distance, or somewhat less or more.
        let of = |x: &IBig| i64::try_from(x.bit_len()).expect("small");
        let bits = (of(&self.square.numerator) - of(&self.square.denominator)) / 2;
        let fine = self.unit + (bits - 118).min(0);
        let (distance, _) = self.fixed(fine);
        let rounded = distance.to_f64().value();
        let rest = (IBig::from(distance) - integer(rounded, 0)).to_f64().value();
        let exponent = i32::try_from(fine).expect("small");
        [rounded, rest].map(|x| x * 2f64.powi(exponent / 2) * 2f64.powi(exponent - exponent / 2))
    }

    /// The largest distance from the query to a vertex, within a few roundings.
    #[must_use]
    pub fn reach(&self) -> f64 {
        self.of_reach(1.0)
    }

    /// So many times that; only the result has to be in range.
    #[must_use]
    pub fn of_reach(&self, factor: f64) -> f64 {
        let fine = self.unit - 64;
        let (_, reach) = self.fixed(fine);
        let excess = reach.bit_len().saturating_sub(64);
        let leading = (reach >> excess).to_f64().value() * factor;
        let exponent = i32::try_from(fine).expect("small") + i32::try_from(excess).expect("small");
        // In two steps, so that neither factor leaves the range of f64.
        leading * 2f64.powi(exponent / 2) * 2f64.powi(exponent - exponent / 2)
    }
}

/// Whether the convex hull of one to three vertices has a point in a closed box; all finite.
///
/// Clips the hull by the six half-spaces, one after the other, in homogeneous coordinates.
#[must_use]
pub fn meets_box(vertices: &[[f64; 3]], corners: &[[f64; 3]; 2]) -> bool {
    let unit = vertices.iter().chain(corners).flatten().map(|x| lowest_bit(*x)).min().expect("coordinates");
    let mut hull: Vec<[IBig; 4]> =
        vertices.iter().map(|v| std::array::from_fn(|k| if k < 3 { integer(v[k], unit) } else { IBig::ONE })).collect();
    for k in 0..3 {
        let [low, high] = corners.each_ref().map(|corner| integer(corner[k], unit));
        hull = clip(&hull, |p| &p[k] - &low * &p[3]);
        hull = clip(&hull, |p| &high * &p[3] - &p[k]);
    }
    !hull.is_empty()
}

/// Whether a . b is at most `bound`; a and b are finite.
#[must_use]
pub fn is_product_at_most(a: [f64; 3], b: [f64; 3], bound: f64) -> bool {
    if !bound.is_finite() {
        return bound > 0.0;
    }
    let unit = |v: &[f64; 3]| v.iter().map(|x| lowest_bit(*x)).min().expect("coordinates");
    let (of_a, of_b) = (unit(&a), unit(&b));
    let exact = |v: [f64; 3], unit: i64| v.map(|x| integer(x, unit));
    let fine = lowest_bit(bound).min(of_a + of_b);
    let up = usize::try_from(of_a + of_b - fine).expect("not negative");
    dot(&exact(a, of_a), &exact(b, of_b)) << up <= integer(bound, fine)
}

/// The part of a convex polygon (or segment, or point) on which `height`, which is linear, is not negative.
fn clip(hull: &[[IBig; 4]], height: impl Fn(&[IBig; 4]) -> IBig) -> Vec<[IBig; 4]> {
    let heights: Vec<IBig> = hull.iter().map(height).collect();
    let mut rest = Vec::new();
    for (i, p) in hull.iter().enumerate() {
        let j = (i + 1) % hull.len();
        let (at_p, at_q) = (&heights[i], &heights[j]);
        if *at_p >= IBig::ZERO {
            rest.push(p.clone());
        }
        if (*at_p > IBig::ZERO && *at_q < IBig::ZERO) || (*at_p < IBig::ZERO && *at_q > IBig::ZERO) {
            // Both weights have the sign of at_p; the last coordinate has to stay positive.
            let sign = if *at_p > IBig::ZERO { IBig::ONE } else { -IBig::ONE };
            rest.push(std::array::from_fn(|k| (&hull[j][k] * at_p - &p[k] * at_q) * &sign));
        }
    }
    rest
}

#[cfg(test)]
mod tests {
    use super::*;

    const T: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];

    fn is(query: [f64; 3], vertices: &[[f64; 3]], expected: f64) -> bool {
        Distance::new(query, vertices).relative_error(expected, 53, 0.0) < 1e-5
    }

    #[test]
    fn closed_forms() {
        assert!(is([1.0, 1.0, -7.0], &T, 7.0));
        assert!(is([-3.0, -4.0, 0.0], &T, 5.0));
        assert!(is([2.0, -3.0, 4.0], &T, 5.0));
        assert!(!is([5.0, 5.0, 0.0], &T, 0.0));
        // The root of 8 is no f64: its rounding is seen, and is within half an ulp.
        assert!((0.1..1.0).contains(&Distance::new([4.0, 4.0, 0.0], &T).relative_error(8f64.sqrt(), 53, 0.0)));
        assert!(is([1.0, 5.0, 0.0], &T[..2], 5.0));
        assert!(is([7.0, 4.0, 0.0], &T[..2], 5.0));
        assert!(is([3e-300, 4e-300 - 4e-300, 0.0], &T[..1], 3e-300));
        assert!(is([0.0, 0.0, -1e308], &T, 1e308));
        let flat = [[0.0; 3], [1.0, 1.0, 1.0], [3.0, 3.0, 3.0]];
        assert!(is([4.0, 3.0, 3.0], &flat, 1.0));
    }

    #[test]
    fn hulls_meet_boxes_in_closed_forms() {
        let block = |x: f64| [[x, x, -1.0], [9.0, 9.0, 1.0]];
        assert!(meets_box(&T, &block(2.0)) && !meets_box(&T, &block(2.0 + 4.0 * f64::EPSILON)));
        assert!(meets_box(&T, &[[0.5, 0.5, -1.0], [0.6, 0.6, 1.0]]), "through the face");
        assert!(!meets_box(&T, &[[0.5, 0.5, 0.1], [0.6, 0.6, 1.0]]), "above the face");
        assert!(meets_box(&T[1..], &[[1.0, 3.0, 0.0], [1.0, 3.0, 0.0]]) && !meets_box(&T[1..], &block(2.1)));
        assert!(meets_box(&T[..1], &[[-1.0; 3], [0.0; 3]]) && !meets_box(&T[..1], &[[-1.0; 3], [-1e-300; 3]]));
    }

    #[test]
    fn products_are_compared_without_rounding() {
        let (a, b) = ([1.0 + f64::EPSILON, 1e200, 0.5], [1.0 - f64::EPSILON, 0.0, 4.0]);
        assert!(is_product_at_most(a, b, 3.0) && !is_product_at_most(a, b, 3f64.next_down()));
        assert!(is_product_at_most(a, b, f64::INFINITY) && !is_product_at_most(a, b, f64::NAN));
        assert!(
            is_product_at_most([1e-200; 3], [1e-200; 3], 5e-324) && !is_product_at_most([1e-200; 3], [1e-200; 3], 0.0)
        );
    }

    #[test]
    fn errors_are_measured_in_units_of_u_m() {
        let d = Distance::new([0.0, 0.0, 1.0], &T);
        let one_off = 1.0 + f64::EPSILON;
        // M = sqrt(17), u = eps / 2
        let expected = 2.0 / 17f64.sqrt();
        assert!((d.error(one_off, 53, 0.0) - expected).abs() < 1e-5);
        assert_eq!(d.error(f64::NAN, 53, 0.0), f64::INFINITY);
        assert_eq!(d.error(f64::INFINITY, 53, 0.0), f64::INFINITY);
        // A distance of 2.2e-309, rounded, of vertices that are whole multiples of 2^-344.
        let long = [[-7.794685076942073e307, 4.9483662130201084e-88, -44.0], [0.00390625, 0.0, 0.0]];
        let d309 = Distance::new([0.0; 3], &long);
        assert_eq!(d309.relative_error(2.2050281480702e-309, 53, f64::from_bits(1)), 0.0);
        assert!(d309.relative_error(2.2050281480702e-309, 53, 0.0) > 1.0);
        assert!((d.reach() - 17f64.sqrt()).abs() < 1e-14);
        assert!(d.is_at_least(1.0) && !d.is_at_least(one_off));
    }

    #[test]
    fn lengths_have_twice_as_many_digits() {
        // The diagonal of a square, whose root is known; and a whole number.
        let [rounded, rest] = Distance::new([0.0; 3], &[[1.0, 1.0, 0.0]]).length();
        assert_eq!((rounded, rest), (std::f64::consts::SQRT_2, -9.667_293_313_452_913e-17));
        assert_eq!(Distance::new([0.0, 0.0, 3.0], &T).length(), [3.0, 0.0]);
        assert_eq!(Distance::new([1e-3, 1e-3, 0.0], &T).length(), [0.0, 0.0]);
        // Near the surface, seen from far corners: the error is in units of the latter.
        let query = [0.1, 0.2, 1e-9];
        let [near, rest] = Distance::new(query, &T).length();
        assert_eq!((near, rest.abs() < 1e-30), (1e-9, true));
        // However near: the height over a plane that is not along the axes, 1 / sqrt(3) of a unit in the last place.
        let tilted = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let [near, rest] = Distance::new([0.25, 0.25, 0.5 + 2f64.powi(-53)], &tilted).length();
        let expected = 2f64.powi(-53) / 3f64.sqrt();
        assert!((near - expected).abs() <= expected * f64::EPSILON && rest != 0.0, "{near:e} + {rest:e}, {expected:e}");
    }
}
