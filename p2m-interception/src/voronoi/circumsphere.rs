//! The spheres through four points, whose centres are the corners of Voronoi cells.
//!
//! Let A, B, C be the offsets from the first point to the others. The circumcentre lies at
//! `(|A|^2 B x C + |B|^2 C x A + |C|^2 A x B) / (2 A . B x C)` from the first point. It is computed in f64, and in
//! double-double arithmetic if the error is too large because the tetrahedron is thin. The error is bounded in either
//! case.

use p2m_core::engine::arithmetic::{Number, cross, dot};
use p2m_core::engine::double_double::{self, Double};
use p2m_core::engine::vector::V3;
use p2m_core::engine::vector::power_of_two;

/// The circumcentre of a tetrahedron.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Circumcentre {
    /// The computed position.
    pub(crate) position: V3,
    /// An upper bound of the distance from the computed position to the exact one.
    pub(crate) error: f64,
}

/// The error bound of the numerator and of the denominator in f64, relative to the sums of their absolute terms. It
/// covers 12 roundings.
const ROUNDING: f64 = 8.0 * f64::EPSILON;
/// The centre is computed in double-double arithmetic if its error in f64 is more than this part of the radius.
const MAX_RELATIVE_ERROR: f64 = power_of_two(-24);

/// Returns the numerator, and half of the denominator.
fn quotient<N: Number>([a, b, c]: [[N; 3]; 3]) -> ([N; 3], N) {
    let (bc, ca, ab) = (cross(b, c), cross(c, a), cross(a, b));
    let (aa, bb, cc) = (dot(a, a), dot(b, b), dot(c, c));
    (std::array::from_fn(|k| aa * bc[k] + bb * ca[k] + cc * ab[k]), dot(a, bc))
}

/// Returns the sums of the absolute terms of the numerator and of half of the denominator.
fn sizes(offsets: &[V3; 3]) -> (V3, f64) {
    let [a, b, c] = offsets.map(|v| v.map(f64::abs));
    let cross =
        |a: &V3, b: &V3| -> V3 { [a[1] * b[2] + a[2] * b[1], a[2] * b[0] + a[0] * b[2], a[0] * b[1] + a[1] * b[0]] };
    let (bc, ca, ab) = (cross(&b, &c), cross(&c, &a), cross(&a, &b));
    let (aa, bb, cc) = (dot(a, a), dot(b, b), dot(c, c));
    (std::array::from_fn(|k| aa * bc[k] + bb * ca[k] + cc * ab[k]), dot(a, bc))
}

/// Returns the circumcentre of four points, or `None` if they are in a plane or too nearly so. Coordinates have to be
/// zero or between 2^-161 and 2^100 in size.
pub(crate) fn circumcentre(points: &[V3; 4]) -> Option<Circumcentre> {
    let [o, rest @ ..] = points;
    let offsets = rest.map(|p| std::array::from_fn(|k| p[k] - o[k]));
    let sizes = sizes(&offsets);
    let in_f64 = finish(o, quotient(offsets), &sizes, ROUNDING);
    let is_precise = |c: &Circumcentre| {
        c.error <= MAX_RELATIVE_ERROR * (0..3).map(|k| (c.position[k] - o[k]).abs()).fold(0.0, f64::max)
    };
    if let Some(found) = in_f64.filter(is_precise) {
        return Some(found);
    }
    let offsets = rest.map(|p| std::array::from_fn(|k| Double::difference(p[k], o[k])));
    let (numerator, half) = quotient(offsets);
    finish(o, (numerator.map(Double::round), half.round()), &sizes, double_double::ROUNDING)
}

/// Divides, and bounds the error. The result is `None` if the denominator may be 0.
fn finish(o: &V3, (numerator, half): (V3, f64), sizes: &(V3, f64), rounding: f64) -> Option<Circumcentre> {
    let min_half = half.abs() - rounding * sizes.1;
    if min_half.is_nan() || min_half <= 0.0 {
        return None;
    }
    let mut error = 0.0;
    let position = std::array::from_fn(|k| {
        let x = numerator[k] / (2.0 * half);
        // These are the errors of numerator and denominator, of the quotient, and of the sum.
        let component_error = (rounding * sizes.0[k] * 0.5 + x.abs() * rounding * sizes.1) / min_half;
        let position = o[k] + x;
        error += component_error + (x.abs() + position.abs()) * (2.0 * f64::EPSILON);
        position
    });
    // The sum of the errors of the components is at least the length of the error. The factor covers its own rounding.
    (error < f64::INFINITY).then_some(Circumcentre { position, error: error * (1.0 + 1e-9) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use dashu_int::IBig;
    use p2m_core::engine::exact::{self, common_exponent, difference};
    use p2m_core::predicates::orientation_3d;
    use rand::{Rng, RngExt};
    use std::cmp::Ordering;

    /// Returns whether a position is within `error` of the exact circumcentre. With N the exact numerator and 2 D the
    /// denominator, this means |2 D x - N| <= 2 |D| error, which integers decide.
    fn is_within_error(points: &[V3; 4], found: &Circumcentre) -> bool {
        let exponent = common_exponent(points.as_flattened().iter().chain(&found.position).chain(&[found.error]));
        let [o, rest @ ..] = points;
        let [a, b, c] = rest.map(|p| difference(p, *o, exponent));
        let x = difference(found.position, *o, exponent);
        let error = exact::integer(found.error, exponent);
        let (bc, ca, ab) = (exact::cross(&b, &c), exact::cross(&c, &a), exact::cross(&a, &b));
        let (aa, bb, cc) = (exact::dot(&a, &a), exact::dot(&b, &b), exact::dot(&c, &c));
        let half = exact::dot(&a, &bc);
        let off: [IBig; 3] =
            std::array::from_fn(|k| &half * &x[k] * IBig::from(2) - (&aa * &bc[k] + &bb * &ca[k] + &cc * &ab[k]));
        exact::dot(&off, &off) <= &half * &half * &error * &error * IBig::from(4)
    }

    fn point(rng: &mut impl Rng) -> V3 {
        std::array::from_fn(|_| rng.random_range(-1.0..1.0))
    }

    #[test]
    fn errors_are_bounded_however_thin_the_tetrahedron_is() {
        let (mut precise, mut unknown) = (0, 0);
        let cases = p2m_testkit::cases(20_000, 4_000);
        for case in cases.clone() {
            let mut rng = p2m_testkit::rng("spheres", case);
            let mut points = [(); 4].map(|()| point(&mut rng));
            let thin = 2f64.powi(-rng.random_range(0..60));
            let scale = 2f64.powi(-rng.random_range(0..40));
            let around = if rng.random() { point(&mut rng) } else { [0.0; 3] };
            for p in &mut points {
                p[2] *= thin;
                *p = std::array::from_fn(|k| around[k] + p[k] * scale);
            }
            let [a, b, c, d] = points;
            match circumcentre(&points) {
                Some(found) => {
                    assert!(is_within_error(&points, &found), "{points:?} {found:?}");
                    let tighter = Circumcentre { error: found.error * 2f64.powi(-10), ..found };
                    precise += usize::from(!is_within_error(&points, &tighter));
                }
                // Only four points in a plane have no circumcentre.
                None => unknown += usize::from(orientation_3d(a, b, c, d) != Ordering::Equal),
            }
        }
        println!("bounds within 2^10 of the error: {precise}, unknown: {unknown}");
        assert!(cases.have_more_than(10_000, precise) && cases.have_fewer_than(10, unknown), "{precise} {unknown}");
    }
}
