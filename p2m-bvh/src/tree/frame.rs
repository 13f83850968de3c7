//! The frame of a tree: the coordinate system in which its nodes are stored in f32.

use nalgebra::Point3;
use p2m_core::Aabb;
use p2m_core::engine::simd::Doubles;
use p2m_core::engine::vector::{exponent, power_of_two};

/// A box in the frame: its lower and its upper corner.
pub(crate) type FrameBox = [[f32; 3]; 2];

/// The frame of a tree: an origin and a unit with which the scene fits into the cube from -1 to 1, or from -4 to 4 if
/// the scene is as large as f64 allows.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// The origin of the frame, in coordinates of the scene.
    pub centre: [f64; 3],
    /// The unit of the frame, a power of two.
    pub unit: f64,
    /// The inverse of the unit.
    pub per_unit: f64,
}

/// The units for which squares of lengths stay in the plain range of keys, as searches in f32 require.
const PLAIN_UNITS: std::ops::RangeInclusive<f64> = power_of_two(-320)..=power_of_two(300);
/// The distance from the centre, in units of the frame, above which queries are searched in f64.
const MAX_QUERY_UNITS: f64 = power_of_two(40);

impl Frame {
    /// Returns the frame of a scene with this box.
    pub fn around(bounds: &Aabb<f64>) -> Self {
        // Coordinates are halved first, because sums and differences of two finite numbers may overflow.
        let halves: [f64; 3] = std::array::from_fn(|k| bounds.max[k] * 0.5 - bounds.min[k] * 0.5);
        let centre: [f64; 3] = std::array::from_fn(|k| bounds.max[k] * 0.5 + bounds.min[k] * 0.5);
        let half = halves.into_iter().fold(0.0, f64::max);
        // A scene of a single point gets the size of the rounding error of its coordinates.
        let half = if half > 0.0 { half } else { centre.iter().fold(0.0, |a, x| x.abs().max(a)) * f64::EPSILON };
        let e = if half > 0.0 && half.is_finite() { exponent(half) + 1 } else { 0 };
        // The limits keep both the unit and its inverse finite.
        let unit = power_of_two(e.clamp(-1000, 1022));
        Self { centre, unit, per_unit: unit.recip() }
    }

    /// Converts a point of the scene to the frame.
    #[inline(always)]
    pub fn place(&self, point: &[f64; 3]) -> [f64; 3] {
        std::array::from_fn(|k| (point[k] - self.centre[k]) * self.per_unit)
    }

    /// Converts a query point to the frame. It is `None` if the point is too far away to search in f32, or if the frame
    /// is too small or too large for that.
    #[inline(always)]
    pub fn local(&self, query: &[f64; 3]) -> Option<[f64; 3]> {
        let q = self.place(query);
        let largest = q[0].abs().max(q[1].abs()).max(q[2].abs());
        (PLAIN_UNITS.contains(&self.unit) && largest <= MAX_QUERY_UNITS).then_some(q)
    }

    /// Returns whether squares of lengths of the scene stay in the plain range of keys, so that searches in f32 are
    /// possible.
    #[inline]
    pub fn is_plain(&self) -> bool {
        PLAIN_UNITS.contains(&self.unit)
    }

    /// Converts a box of the scene to the frame, rounded outwards.
    #[allow(clippy::cast_possible_truncation, reason = "rounded outwards, which covers the rounding of the difference")]
    pub fn enclose(&self, bounds: &Aabb<f64>) -> FrameBox {
        let [min, max] = [&bounds.min, &bounds.max].map(|corner| self.place(&[corner.x, corner.y, corner.z]));
        [min.map(|x| (x as f32).next_down()), max.map(|x| (x as f32).next_up())]
    }

    /// Converts a box of the frame to the scene, rounded outwards.
    pub fn to_scene(&self, bounds: &Aabb<f64>) -> Aabb<f64> {
        let coordinate = |x: f64, k: usize| self.centre[k] + x * self.unit;
        Aabb {
            min: Point3::from(std::array::from_fn(|k| coordinate(bounds.min[k], k).next_down())),
            max: Point3::from(std::array::from_fn(|k| coordinate(bounds.max[k], k).next_up())),
        }
    }

    /// Converts the square of a length in the frame, such as the bound of a node, to the scene and rounds it down.
    pub fn square_below(&self, square: f32) -> f64 {
        // The margins equal the margins of `square_above`.
        let square = f64::from(square) * (1.0 - power_of_two(-19)) - power_of_two(-120);
        square.max(0.0) * (self.unit * self.unit)
    }

    /// Converts the square of a length of the scene to the frame and rounds it up, so that it can be compared with
    /// bounds of nodes.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "rounded up before")]
    pub fn square_above(&self, square: f64) -> f32 {
        // The margin is 2^-20 for the bounds with which the result is compared and for this product, and 2^-120 for
        // underflow in either.
        let square = square * (self.per_unit * self.per_unit) * (1.0 + power_of_two(-19)) + power_of_two(-120);
        if square < f64::from(f32::MAX) { square as f32 } else { f32::MAX }
    }

    /// Converts lengths of the scene to squares that can be compared with bounds of nodes, as
    /// [`square_above`](Self::square_above) does for one square.
    #[inline(always)]
    pub fn squares_above<D: Doubles>(&self, lengths: D, to: &mut [f32]) {
        let factor = self.per_unit * self.per_unit * (1.0 + power_of_two(-19));
        let squares = lengths * lengths * D::splat(factor) + D::splat(power_of_two(-120));
        squares.min(D::splat(f64::from(f32::MAX))).store_f32(to);
    }
}
