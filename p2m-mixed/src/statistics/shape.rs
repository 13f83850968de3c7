//! Lengths, areas and shapes of primitives at any scale, and the exact decision whether a triangle has an area.
//!
//! Floating-point arithmetic is used where it is accurate to 2^-20, scaled arithmetic where squares would leave the
//! range, and exact integers where a triangle is so flat that its area would be mostly rounding error. Results beyond
//! the range of f64 are rounded to the nearest number.

use dashu_int::ops::BitTest;
use nalgebra::Point3;
use p2m_core::engine::arithmetic::cross;
use p2m_core::engine::exact;
use p2m_core::engine::vector::{V3, largest, norm_squared, sub};
use p2m_core::kernel::power_of_two;

/// Triangles whose height is below 2^-26 of the longest edge are measured in integers. Floating-point arithmetic has an
/// absolute error below 2^-48 in this ratio, so triangles without area are among them, and the area of other triangles
/// is accurate to 2^-22.
const EXACT_BELOW_SINE: f64 = power_of_two(-26);
/// The range of offsets that need no scaling. Their fourth powers are in the range of f64.
const UNSCALED_OFFSETS: std::ops::RangeInclusive<f64> = power_of_two(-200)..=power_of_two(200);

/// The measures of a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct TriangleMeasures {
    /// The lengths of the edges. Edge i runs from vertex i to vertex i + 1.
    pub(super) edges: V3,
    /// The area, which is zero if and only if the corners are on a line.
    pub(super) area: f64,
    /// The height over the longest edge, divided by that edge. It is zero if and only if the area is.
    pub(super) sine: f64,
}

impl TriangleMeasures {
    pub(super) fn new(corners: [Point3<f64>; 3]) -> Self {
        let corners = corners.map(|p| [p.x, p.y, p.z]);
        let lengths = [0, 1, 2].map(|i| length(corners[i], corners[(i + 1) % 3]));
        // `offsets` are the edges divided by 2^exponent.
        let edges =
            |unit: f64| [0, 1, 2].map(|i| sub(corners[(i + 1) % 3].map(|x| x * unit), corners[i].map(|x| x * unit)));
        let (mut offsets, mut exponent) = (edges(1.0), 0);
        let mut size = largest(&offsets);
        if size == 0.0 {
            return Self { edges: lengths, area: 0.0, sine: 0.0 };
        }
        if !UNSCALED_OFFSETS.contains(&size) {
            if size > 1.0 {
                // Differences of quarter coordinates are finite. They may lose digits to underflow, which is negligible
                // at such sizes.
                offsets = edges(0.25);
                exponent = 2;
                size = largest(&offsets);
            }
            let scale = libm::ilogb(size);
            offsets = offsets.map(|v| v.map(|x| libm::scalbn(x, -scale)));
            exponent += scale;
        }
        let longest = offsets.iter().fold(0.0f64, |a, v| a.max(norm_squared(*v)));
        let cross = norm_squared(cross(offsets[0], offsets[1])).sqrt();
        if cross > EXACT_BELOW_SINE * longest {
            let area = representable(libm::scalbn(cross / 2.0, 2 * exponent));
            return Self { edges: lengths, area, sine: cross / longest };
        }
        match exact_cross(corners) {
            None => Self { edges: lengths, area: 0.0, sine: 0.0 },
            Some((cross, power)) => {
                let area = representable(libm::scalbn(cross / 2.0, power));
                let sine = representable(libm::scalbn(cross / longest, power - 2 * exponent));
                Self { edges: lengths, area, sine }
            }
        }
    }
}

/// Returns the distance between two points, which is zero only if they are equal.
pub(super) fn length(a: V3, b: V3) -> f64 {
    let offset = sub(b, a);
    let size = largest(&[offset]);
    if UNSCALED_OFFSETS.contains(&size) || size == 0.0 {
        return norm_squared(offset).sqrt();
    }
    let (offset, exponent) = if size > 1.0 { (sub(b.map(|x| x / 4.0), a.map(|x| x / 4.0)), 2) } else { (offset, 0) };
    let scale = libm::ilogb(largest(&[offset]));
    let scaled = offset.map(|x| libm::scalbn(x, -scale));
    representable(libm::scalbn(norm_squared(scaled).sqrt(), scale + exponent))
}

/// Returns the length of the cross product of two edges as a number and the exponent of a power of two to multiply it
/// by, or `None` if it is zero.
#[cold]
fn exact_cross(corners: [V3; 3]) -> Option<(f64, i32)> {
    let unit = exact::common_exponent(corners.as_flattened());
    let [e, f] = [1, 2].map(|i| exact::difference(corners[i], corners[0], unit));
    let cross = exact::cross(&e, &f);
    let bits = cross.iter().map(BitTest::bit_len).max().unwrap_or(0);
    if bits == 0 {
        return None;
    }
    // The upper 60 bits suffice for the accuracy.
    let drop = bits.saturating_sub(60);
    #[allow(clippy::cast_precision_loss, reason = "a length to be rounded")]
    let rounded = cross.map(|x| i64::try_from(x >> drop).map_or(f64::NAN, |x| x as f64));
    let power = i32::try_from(drop).ok()? + 2 * unit;
    Some((norm_squared(rounded).sqrt(), power))
}

/// Returns the positive finite number nearest to a positive number.
fn representable(x: f64) -> f64 {
    x.clamp(f64::from_bits(1), f64::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn measure(corners: [V3; 3]) -> TriangleMeasures {
        TriangleMeasures::new(corners.map(Point3::from))
    }

    /// The measures of a 3-4-5 triangle are exact at every scale.
    #[test]
    fn measures_are_exact_at_every_scale() {
        for e in [-1060, -1022, -600, -540, -201, -200, -30, 0, 30, 200, 201, 500, 540, 1019] {
            let [s, t] = [3.0, 4.0].map(|x| libm::scalbn(x, e));
            let found = measure([[s, 0.0, 0.0], [0.0, t, 0.0], [0.0, 0.0, 0.0]]);
            assert_eq!(found.edges, [libm::scalbn(5.0, e), t, s], "{e}");
            assert_eq!(found.sine, 12.0 / 25.0, "{e}");
            let area = libm::scalbn(6.0, e);
            assert_eq!(found.area, representable(libm::scalbn(area, e)), "{e}");
        }
        let huge = measure([[f64::MAX, 0.0, 0.0], [-f64::MAX, 0.0, 0.0], [0.0, f64::MAX, 0.0]]);
        assert_eq!((huge.edges[0], huge.area, huge.sine), (f64::MAX, f64::MAX, 0.5));
        let tiny = f64::from_bits(1);
        let found = measure([[0.0; 3], [tiny, 0.0, 0.0], [0.0, tiny, 0.0]]);
        assert_eq!((found.edges[0], found.edges[2], found.area, found.sine), (tiny, tiny, tiny, 0.5));
    }

    /// Every triangle on a lattice, moved and scaled without rounding, is compared with integer arithmetic.
    #[test]
    fn zero_area_is_decided_as_integers_do() {
        let at = |i: i64| [i % 3, i / 3 % 3, i / 9];
        let mut zero = 0;
        for code in 0..27 * 27 * 27 {
            let v = [at(code % 27), at(code / 27 % 27), at(code / 729)];
            let [e, f] = [1, 2].map(|i| [0, 1, 2].map(|k| v[i][k] - v[0][k]));
            let cross = [e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]];
            let expected = cross.iter().map(|x| (x * x) as f64).sum::<f64>().sqrt() / 2.0;
            zero += usize::from(expected == 0.0);
            for (scale, offset) in [(1.0, 0.0), (power_of_two(-1000), 0.0), (power_of_two(900), 0.0), (0.25, 1e12)] {
                let found = measure(v.map(|p| p.map(|x| x as f64 * scale + offset)));
                assert_eq!(found.area == 0.0, expected == 0.0, "{v:?} {scale} {offset}");
                assert_eq!(found.sine == 0.0, expected == 0.0, "{v:?} {scale} {offset}");
            }
            assert_eq!(measure(v.map(|p| p.map(|x| x as f64))).area, expected, "{v:?}");
        }
        assert!(zero > 27, "{zero}");
    }

    #[test]
    fn collinear_and_nearly_collinear_corners_are_distinguished() {
        let collinear = measure([[0.0; 3], [0.1, 0.2, 0.4], [0.2, 0.4, 0.8]]);
        assert_eq!((collinear.area, collinear.sine), (0.0, 0.0));
        let off = f64::from_bits(0.2f64.to_bits() + 1);
        let found = measure([[0.0; 3], [0.1, 0.2, 0.4], [off, 0.4, 0.8]]);
        // The cross product is one unit in the last place of 0.2 times |(0, 0.4, -0.2)|.
        let ulp = off - 0.2;
        assert!((found.area / (ulp * 0.2f64.sqrt() / 2.0) - 1.0).abs() < 1e-15, "{}", found.area);
        assert!((found.sine / (ulp * 0.2f64.sqrt() / 0.84) - 1.0).abs() < 1e-15, "{}", found.sine);
        // One corner has an exponent that is 2000 below that of the others.
        let tiny = 1e-300;
        assert_eq!(measure([[0.0; 3], [1e300, 0.0, 0.0], [tiny, 0.0, 0.0]]).area, 0.0);
        let found = measure([[0.0; 3], [1e300, 0.0, 0.0], [1e300, tiny, 0.0]]);
        assert_eq!((found.area, found.sine), (0.5, f64::from_bits(1)));
        assert!(found.edges[1] == tiny, "{:?}", found.edges);
    }

    /// The needles are just above and below the limit between floating-point and exact arithmetic.
    #[test]
    fn floating_point_and_exact_arithmetic_agree() {
        for e in 10..40 {
            let height = power_of_two(-e);
            let found = measure([[1e3, 7.0, 1.0], [1e3 + 1.0, 7.0, 1.0], [1e3 + 0.5, 7.0 + height, 1.0]]);
            assert_eq!((found.area, found.sine), (height / 2.0, height), "{e}");
        }
    }
}
