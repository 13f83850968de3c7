//! The two scalar types of scenes, f32 and f64.
//!
//! All decisions are made in f64 for both types. Coordinates in f32 convert to f64 exactly, squares of their
//! differences neither overflow nor underflow there, and the answer is rounded once at the end. So there is one kernel,
//! and a scalar type is defined by its conversions.

use nalgebra::{Point3, RealField};

mod sealed {
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
}

/// The scalar type of coordinates: `f32` or `f64`.
///
/// The trait is sealed. The accuracy contract is proved for these two types, and the proof needs an exact
/// conversion to f64.
pub trait Real: RealField + Copy + Default + sealed::Sealed {
    /// The number infinity.
    const INFINITY: Self;
    /// The unit roundoff u, half the distance from 1 to the next larger number: 2^-24 for f32, 2^-53 for f64.
    const UNIT_ROUNDOFF: f64;
    /// The smallest positive number eta: 2^-149 for f32, 2^-1074 for f64.
    const SMALLEST_SUBNORMAL: f64;

    /// Converts to f64, exactly.
    fn to_f64(self) -> f64;
    /// Rounds to the nearest number of this type, ties to even.
    fn round_from_f64(value: f64) -> Self;
    /// Returns the largest f64 that [`round_from_f64`](Self::round_from_f64) rounds to this number. NaN stays NaN.
    fn to_f64_above(self) -> f64;
    /// Returns the largest number of this type that is at most `value`. NaN stays NaN.
    fn round_down_from_f64(value: f64) -> Self;
}

impl Real for f64 {
    const INFINITY: Self = f64::INFINITY;
    const UNIT_ROUNDOFF: f64 = f64::EPSILON / 2.0;
    const SMALLEST_SUBNORMAL: f64 = 5e-324;

    #[inline(always)]
    fn to_f64(self) -> f64 {
        self
    }
    #[inline(always)]
    fn round_from_f64(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn to_f64_above(self) -> f64 {
        self
    }
    #[inline(always)]
    fn round_down_from_f64(value: f64) -> Self {
        value
    }
}

impl Real for f32 {
    const INFINITY: Self = f32::INFINITY;
    const UNIT_ROUNDOFF: f64 = f32::EPSILON as f64 / 2.0;
    const SMALLEST_SUBNORMAL: f64 = 1.401_298_464_324_817e-45;

    #[inline(always)]
    fn to_f64(self) -> f64 {
        f64::from(self)
    }
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "rounding to nearest is what this function promises")]
    fn round_from_f64(value: f64) -> Self {
        value as f32
    }
    fn to_f64_above(self) -> f64 {
        if !self.is_finite() {
            return f64::from(self);
        }
        // Numbers above the largest one round as if 2^128 were the next one.
        let next = if self < Self::MAX { f64::from(self.next_up()) } else { 2.0 * 2f64.powi(127) };
        let middle = (f64::from(self) + next) / 2.0;
        if Self::round_from_f64(middle) <= self { middle } else { middle.next_down() }
    }
    fn round_down_from_f64(value: f64) -> Self {
        let nearest = Self::round_from_f64(value);
        if f64::from(nearest) > value { nearest.next_down() } else { nearest }
    }
}

/// Converts a point to an array of f64, exactly.
#[inline(always)]
pub fn to_f64_array<T: Real>(point: &Point3<T>) -> [f64; 3] {
    [point.x.to_f64(), point.y.to_f64(), point.z.to_f64()]
}

/// Rounds an array of f64 to the nearest coordinates of a scene.
#[inline(always)]
pub fn from_f64_array<T: Real>(point: [f64; 3]) -> Point3<T> {
    Point3::new(T::round_from_f64(point[0]), T::round_from_f64(point[1]), T::round_from_f64(point[2]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constants_are_what_they_are_named() {
        assert_eq!(f64::UNIT_ROUNDOFF, 2f64.powi(-53));
        assert_eq!(f32::UNIT_ROUNDOFF, 2f64.powi(-24));
        assert_eq!(<f64 as Real>::SMALLEST_SUBNORMAL, f64::from_bits(1));
        assert_eq!(<f32 as Real>::SMALLEST_SUBNORMAL, f64::from(f32::from_bits(1)));
    }

    #[test]
    fn what_rounds_to_a_number_ends_where_it_says() {
        for x in [0.0, f32::from_bits(1), f32::from_bits(2), 1.0, 1.0f32.next_up(), 3.7e-12, 1e30, f32::MAX, -1.0] {
            let above = x.to_f64_above();
            assert_eq!((f32::round_from_f64(above), f32::round_from_f64(above.next_up())), (x, x.next_up()));
        }
        assert!(f32::INFINITY.to_f64_above() == f64::INFINITY && f32::NAN.to_f64_above().is_nan());
    }

    #[test]
    fn rounding_down_never_rises() {
        assert_eq!(f32::round_down_from_f64(1.0), 1.0);
        assert_eq!(f32::round_down_from_f64(1.0 + 1e-9), 1.0);
        assert_eq!(f32::round_down_from_f64(1.0 - 1e-9), 1.0f32.next_down());
        assert_eq!(f32::round_down_from_f64(1e300), f32::MAX);
        assert_eq!(f32::round_down_from_f64(1e-300), 0.0);
    }
}
