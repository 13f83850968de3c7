//! Angles and random numbers that are the same on every platform, bit for bit.
//!
//! The mathematical libraries of platforms differ in their rounding. Sines and cosines therefore come from the crate
//! libm, which computes them by additions, multiplications and divisions of f64 in a fixed order. `powi` and `mul_add`
//! are not used.

use chacha20::ChaCha8Rng;
use chacha20::rand_core::{Rng, SeedableRng};
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_4};

/// Sine and cosine of an angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SinCos {
    pub(super) sin: f64,
    pub(super) cos: f64,
}

impl SinCos {
    /// Returns sine and cosine of `part / whole` turns. Angles that are mirror images of each other have
    /// the same digits.
    pub(super) fn of_fraction(part: u64, whole: u32) -> Self {
        let whole = u64::from(whole);
        // The product is below 2^35.
        let eighths = part % whole * 8;
        let (octant, rest) = (eighths / whole, eighths % whole);
        let rest = if octant.is_multiple_of(2) { rest } else { whole - rest };
        Self::of_octant(octant, rest as f64 / whole as f64)
    }

    /// Returns sine and cosine of a finite number of turns.
    pub(super) fn of_turns(turns: f64) -> Self {
        // Both differences are exact for turns >= 0. A tiny negative number counts as one turn.
        let eighths = (turns - turns.floor()) * 8.0;
        let octant = eighths.floor().min(7.0);
        let rest = eighths - octant;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a whole number from 0 to 7")]
        let octant = octant as u64;
        Self::of_octant(octant, if octant.is_multiple_of(2) { rest } else { 1.0 - rest })
    }

    /// Returns sine and cosine in an octant. `rest` is the distance to the nearest axis in eighths of a turn, from
    /// 0 to 1.
    fn of_octant(octant: u64, rest: f64) -> Self {
        // The diagonal is a case of its own, so that both numbers are equal there.
        let (s, c) = if rest < 1.0 { libm::sincos(rest * FRAC_PI_4) } else { (FRAC_1_SQRT_2, FRAC_1_SQRT_2) };
        let (sin, cos) = match octant {
            0 => (s, c),
            1 => (c, s),
            2 => (c, -s),
            3 => (s, -c),
            4 => (-s, -c),
            5 => (-c, -s),
            6 => (-c, s),
            _ => (-s, c),
        };
        // The sum of -0 and 0 is 0.
        Self { sin: sin + 0.0, cos: cos + 0.0 }
    }
}

/// Returns the rotation by an angle in degrees about axis 0, 1 or 2, counter-clockwise if the axis points
/// at the viewer.
pub(super) fn rotation(axis: usize, degrees: f64) -> Matrix3<f64> {
    let SinCos { sin, cos } = SinCos::of_turns(degrees / 360.0);
    let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut matrix = Matrix3::identity();
    (matrix[(a, a)], matrix[(a, b)]) = (cos, 0.0 - sin);
    (matrix[(b, a)], matrix[(b, b)]) = (sin, cos);
    matrix
}

/// Returns the upper 53 bits as a number from 0 inclusive to 1 exclusive.
pub(super) fn unit(bits: u64) -> f64 {
    (bits >> 11) as f64 / (1u64 << 53) as f64
}

/// Returns a uniformly distributed vector of the unit ball. `next` is a source of random bits.
pub(super) fn in_ball(mut next: impl FnMut() -> u64) -> Vector3<f64> {
    loop {
        let v = Vector3::from_fn(|_, _| 2.0 * unit(next()) - 1.0);
        if v.x * v.x + v.y * v.y + v.z * v.z <= 1.0 {
            return v;
        }
    }
}

/// A generator of random numbers.
pub(super) struct Random(ChaCha8Rng);

impl Random {
    pub(super) fn new(seed: u64) -> Self {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        Self(ChaCha8Rng::from_seed(key))
    }

    pub(super) fn bits(&mut self) -> u64 {
        self.0.next_u64()
    }

    /// Returns a number from 0 inclusive to 1 exclusive.
    pub(super) fn unit(&mut self) -> f64 {
        unit(self.bits())
    }

    /// Returns an integer below `end`, which has to be below 2^32.
    pub(super) fn below(&mut self, end: u64) -> u64 {
        // The bias is below 2^-32.
        ((self.bits() >> 32) * end) >> 32
    }

    pub(super) fn in_ball(&mut self) -> Vector3<f64> {
        in_ball(|| self.bits())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn sine_and_cosine_are_those_of_the_library_within_three_roundings() {
        for whole in [1, 3, 8, 12, 360, 1000, 99_991] {
            for part in 0..u64::from(whole).min(5000) {
                let turns = part as f64 / f64::from(whole);
                for (name, value) in
                    [("fraction", SinCos::of_fraction(part, whole)), ("turns", SinCos::of_turns(turns))]
                {
                    let (sin, cos) = (TAU * turns).sin_cos();
                    // TAU itself and its product are rounded: the angle of the library is off by up to TAU * 2^-52.
                    let bound = 7.0 * f64::EPSILON;
                    assert!((value.sin - sin).abs() <= bound, "{name} {part}/{whole}: {} {sin}", value.sin);
                    assert!((value.cos - cos).abs() <= bound, "{name} {part}/{whole}: {} {cos}", value.cos);
                }
            }
        }
    }

    #[test]
    fn angles_that_mirror_each_other_have_the_same_digits() {
        for whole in [4, 12, 100, 1004] {
            let quarter = u64::from(whole) / 4;
            for part in 0..quarter {
                let SinCos { sin, cos } = SinCos::of_fraction(part, whole);
                let turned = |n: u64| SinCos::of_fraction(part + n * quarter, whole);
                assert_eq!(turned(1), SinCos { sin: cos, cos: 0.0 - sin });
                assert_eq!(turned(2), SinCos { sin: 0.0 - sin, cos: 0.0 - cos });
                assert_eq!(turned(3), SinCos { sin: 0.0 - cos, cos: sin });
                let back = SinCos::of_fraction(u64::from(whole) - part, whole);
                assert_eq!(back, SinCos { sin: 0.0 - sin, cos });
            }
        }
    }

    #[test]
    fn axes_and_diagonals_are_exact() {
        let half = FRAC_1_SQRT_2;
        for (i, (sin, cos)) in (0..8u32).zip([
            (0.0, 1.0),
            (half, half),
            (1.0, 0.0),
            (half, -half),
            (0.0, -1.0),
            (-half, -half),
            (-1.0, 0.0),
            (-half, half),
        ]) {
            assert_eq!(SinCos::of_fraction(u64::from(i), 8), SinCos { sin, cos });
            for turns in [-3.0, 0.0, 7.0] {
                assert_eq!(SinCos::of_turns(turns + f64::from(i) / 8.0), SinCos { sin, cos });
            }
        }
        assert_eq!(SinCos::of_turns(-1e-300), SinCos { sin: 0.0, cos: 1.0 });
    }

    #[test]
    fn powers_of_a_tenth() {
        for decades in 0..=300 {
            let expected: f64 = format!("1e-{decades}").parse().unwrap();
            let value = libm::exp10(-f64::from(decades));
            let bound = f64::from(decades + 1) * 5.0 * f64::EPSILON;
            assert!((value / expected - 1.0).abs() <= bound, "{decades}: {value}");
        }
        assert_eq!(libm::exp10(0.0), 1.0);
        assert!((libm::exp10(-0.5) / 0.1f64.sqrt() - 1.0).abs() <= 5.0 * f64::EPSILON);
    }

    #[test]
    fn quarter_turns_permute_coordinates_exactly() {
        let p = Vector3::new(2.0, 3.0, 5.0);
        assert_eq!(rotation(0, 90.0) * p, Vector3::new(2.0, -5.0, 3.0));
        assert_eq!(rotation(1, 90.0) * p, Vector3::new(5.0, 3.0, -2.0));
        assert_eq!(rotation(2, -270.0) * p, Vector3::new(-3.0, 2.0, 5.0));
    }

    #[test]
    fn random_numbers_stay_in_their_ranges_and_reach_their_ends() {
        let mut random = Random::new(1);
        let mut seen = [0; 7];
        for _ in 0..7000 {
            seen[usize::try_from(random.below(7)).unwrap()] += 1;
        }
        assert!(seen.iter().all(|n| (900..1100).contains(n)), "{seen:?}");
        assert_eq!((unit(0), unit(u64::MAX)), (0.0, 1.0 - f64::EPSILON / 2.0));
        let ball: Vec<_> = (0..8000).map(|_| random.in_ball()).collect();
        assert!(ball.iter().all(|v| v.norm() <= 1.0));
        // An eighth of the ball is within half its radius.
        let inner = ball.iter().filter(|v| v.norm() <= 0.5).count();
        assert!((850..1150).contains(&inner), "{inner}");
        assert_ne!(Random::new(1).bits(), Random::new(2).bits());
    }
}
