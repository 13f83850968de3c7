//! Keys: extended-range squared distances, by which candidates are compared.

use super::vector::{V3, largest, norm_squared, power_of_two, scale_by_power};
use std::cmp::Ordering;

/// The exponent of two that bounds plain squares. Squares below 2^-800, and from 2^800 on, are in other tiers.
const PLAIN_SQUARE_BITS: i32 = 800;
/// The least plain square.
pub(super) const SQUARE_MIN: f64 = power_of_two(-PLAIN_SQUARE_BITS);
/// The least square above the plain range.
pub(super) const SQUARE_MAX: f64 = power_of_two(PLAIN_SQUARE_BITS);
/// The exponent of two by which the squares of neighbouring tiers are scaled.
const TIER_SHIFT: i32 = 2 * PLAIN_SQUARE_BITS;

/// The squared length of the offset from the query to the nearest point, with a larger exponent range than f64.
///
/// Keys decide between primitives, in pruning and in ties. Several squares have the same square root, so equal
/// distances may have different keys. A key is a plain square if the square lies in [2^-800, 2^800). Smaller and larger
/// lengths are in tiers of their own, whose squares are stored times 2^1600 or 2^-1600. The tier depends on the value
/// alone, and the bits of the square are the same as in the plain computation. So comparisons depend neither on the
/// formula by which a key was computed nor on the scale of the scene.
///
/// Keys are ordered by value and never NaN.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Key {
    square: f64,
    tier: i32,
}

impl Key {
    /// The key of length zero.
    pub const ZERO: Self = Self { square: 0.0, tier: 0 };
    /// A key above the keys of all lengths.
    pub const INFINITY: Self = Self { square: f64::INFINITY, tier: 1 };

    /// Returns the key of an offset in units of the scene. An offset with a NaN component has the key
    /// [`Key::INFINITY`], so that it never wins.
    #[inline]
    #[must_use]
    pub fn from_offset(offset: [f64; 3]) -> Self {
        let square = norm_squared(offset);
        Self::plain(square).unwrap_or_else(|| Self::from_scaled_offset(offset, 0))
    }

    /// Returns the key of a plain square, and `None` for any other square. That includes zero, which may be an
    /// underflow.
    #[inline(always)]
    pub(super) fn plain(square: f64) -> Option<Self> {
        (SQUARE_MIN..SQUARE_MAX).contains(&square).then_some(Self { square, tier: 0 })
    }

    /// Returns the key of a plain square or of zero.
    #[inline(always)]
    pub(super) fn of_plain_square(square: f64) -> Self {
        Self { square, tier: 0 }
    }

    /// Returns the key of `offset` * 2^`exponent`.
    #[cold]
    pub(crate) fn from_scaled_offset(offset: V3, exponent: i32) -> Self {
        if !offset.iter().all(|x| x.is_finite()) {
            return Self::INFINITY;
        }
        let size = largest(&[offset]);
        if size == 0.0 {
            return Self::ZERO;
        }
        let size_exponent = super::vector::exponent(size);
        // The square is in [1, 12). Any other power of two as the scale gives the same bits unless it underflows.
        let square = norm_squared(offset.map(|x| scale_by_power(x, -size_exponent)));
        let shift = 2 * (size_exponent + exponent);
        let tier = match shift + super::vector::exponent(square) {
            s if s < -PLAIN_SQUARE_BITS => -1,
            s if s >= PLAIN_SQUARE_BITS => 1,
            _ => 0,
        };
        let square = scale_by_power(square, shift - tier * TIER_SHIFT);
        // A square below the lowest tier, which is far below the smallest subnormal, becomes the key of zero.
        if square == 0.0 { Self::ZERO } else { Self { square, tier } }
    }

    /// Returns the length: the square root of the key, rounded to nearest. It is infinite beyond the range of f64.
    #[inline]
    #[must_use]
    pub fn distance(self) -> f64 {
        let root = self.square.sqrt();
        if self.tier == 0 { root } else { scale_by_power(root, self.tier * PLAIN_SQUARE_BITS) }
    }

    /// Returns two numbers that are ordered lexicographically as keys are. They serve programs that compare keys
    /// elsewhere.
    #[must_use]
    pub fn order(self) -> [f64; 2] {
        // Zero is below all tiers, although it has the tier of plain squares.
        let tier = if self.square == 0.0 { -2 } else { self.tier };
        [f64::from(tier), self.square]
    }

    /// Returns a square that is not below the key, for pruning by bounds that are computed in plain f64.
    ///
    /// It is the key itself in the plain range. It is 2^-800 below the plain range, where squares of f64 lose their
    /// digits, and infinity above it.
    #[inline]
    #[must_use]
    pub fn square_above(self) -> f64 {
        match self.tier {
            0 => self.square.max(SQUARE_MIN),
            1 => f64::INFINITY,
            _ => SQUARE_MIN,
        }
    }

    /// Returns the square if it is plain.
    #[inline]
    pub(crate) fn plain_square(self) -> Option<f64> {
        (self.tier == 0).then_some(self.square)
    }

    /// Compares keys of different tiers.
    #[cold]
    #[inline]
    fn compare_tiers(self, other: Self) -> Ordering {
        match (self.square == 0.0, other.square == 0.0) {
            (true, true) => Ordering::Equal,
            (true, false) => Ordering::Less,
            (false, true) => Ordering::Greater,
            (false, false) => self.tier.cmp(&other.tier),
        }
    }
}

impl Eq for Key {}

impl PartialOrd for Key {
    #[inline]
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Key {
    #[inline]
    fn cmp(&self, other: &Self) -> Ordering {
        // Squares are never NaN, and a sum of squares is never -0.
        if self.tier == other.tier { self.square.total_cmp(&other.square) } else { self.compare_tiers(*other) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key(x: f64) -> Key {
        Key::from_offset([x, 0.0, 0.0])
    }

    #[test]
    fn keys_are_ordered_by_length_over_the_whole_range_of_f64() {
        let mut lengths = vec![0.0, f64::from_bits(1), f64::from_bits(3), f64::MIN_POSITIVE, f64::MAX];
        lengths.extend((-1070..1023).step_by(7).map(|e| scale_by_power(1.0, e)));
        lengths.extend([-401, -400, -399, 399, 400, 401].map(|e| 1.1 * power_of_two(e)));
        lengths.sort_by(f64::total_cmp);
        for (i, &a) in lengths.iter().enumerate() {
            assert_eq!(key(a).distance(), a);
            for (j, &b) in lengths.iter().enumerate() {
                assert_eq!(key(a).cmp(&key(b)), a.total_cmp(&b), "{a:e} {b:e} {i} {j}");
                assert_eq!(key(a).order().partial_cmp(&key(b).order()), Some(a.total_cmp(&b)), "{a:e} {b:e}");
            }
        }
        assert!(key(f64::MAX) < Key::from_offset([f64::MAX; 3]));
        assert!(Key::from_offset([f64::MAX; 3]) < Key::INFINITY);
        assert_eq!(Key::from_offset([f64::MAX; 3]).distance(), f64::INFINITY);
        assert_eq!(Key::from_offset([f64::NAN, 1.0, 2.0]), Key::INFINITY);
    }

    #[test]
    fn a_key_does_not_depend_on_the_scale_it_was_computed_in() {
        for o in [[0.3, -0.7, 0.1], [1e-9, 1.0, 3.0], [1.0 / 3.0; 3]] {
            for e in [-1000, -500, -402, -400, -398, -30, 0, 30, 398, 400, 402, 500, 1000] {
                let scaled = o.map(|x| scale_by_power(x, e));
                let at_one = Key::from_offset(o);
                assert_eq!(Key::from_offset(scaled), Key::from_scaled_offset(o, e));
                assert_eq!(Key::from_offset(scaled).distance(), scale_by_power(at_one.distance(), e));
            }
        }
    }

    #[test]
    fn there_is_one_zero() {
        for exponent in [-1300, -1336, -1338, -1400, -3000] {
            let (tiny, zero) = (Key::from_scaled_offset([1.0, 0.0, 0.0], exponent), Key::ZERO);
            assert_eq!(tiny == zero, exponent < -1337, "{exponent}: {tiny:?}");
            assert_eq!(tiny == zero, tiny.cmp(&zero) == Ordering::Equal);
        }
    }

    #[test]
    fn the_ends_of_the_plain_range_have_one_key_by_either_route() {
        for e in [-400, 400] {
            let at = power_of_two(e);
            for x in [at.next_down(), at, at.next_up()] {
                assert_eq!(key(x), Key::from_scaled_offset([x, 0.0, 0.0], 0), "{x:e}");
            }
        }
    }

    #[test]
    fn the_square_for_pruning_is_never_below_the_key() {
        for x in [0.0, 1e-320, 1e-170, 1e-100, 1.0, 1e100, 1e170, 1e300] {
            assert!(key(x).square_above() >= x * x);
        }
    }
}
