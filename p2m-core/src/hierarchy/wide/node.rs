//! Nodes of eight boxes, in f32 in a frame of the scene.

use crate::Aabb;
use crate::kernel::{exponent, power_of_two};
use crate::simd::Lanes;
use nalgebra::Point3;

/// Children of a node.
pub(super) const WIDTH: usize = 8;

/// Eight boxes side by side. Unused ones are empty: infinitely far from everything.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Node {
    pub(super) min: [[f32; WIDTH]; 3],
    pub(super) max: [[f32; WIDTH]; 3],
    pub(super) children: [Child; WIDTH],
}

const _: () = assert!(size_of::<Node>() == 256);

/// A node or a packet, by its number; `NONE` for neither.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Child(pub(super) u32);

const PACKET_BIT: u32 = 1 << 31;

impl Child {
    pub(super) const NONE: Self = Self(u32::MAX);

    pub(super) fn node(number: usize) -> Self {
        Self(u32::try_from(number).expect("fewer nodes than primitives"))
    }
    pub(super) fn packet(number: usize) -> Self {
        Self(u32::try_from(number).expect("fewer packets than primitives") | PACKET_BIT)
    }
    #[inline(always)]
    pub(super) fn is_packet(self) -> bool {
        self.0 & PACKET_BIT != 0
    }
    #[inline(always)]
    pub(super) fn number(self) -> usize {
        (self.0 & !PACKET_BIT) as usize
    }
}

impl Node {
    pub(super) const EMPTY: Self =
        Self { min: [[f32::INFINITY; WIDTH]; 3], max: [[f32::NEG_INFINITY; WIDTH]; 3], children: [Child::NONE; WIDTH] };

    pub(super) fn put(&mut self, place: usize, bounds: [[f32; 3]; 2], child: Child) {
        let [low, high] = bounds;
        self.min.iter_mut().zip(low).for_each(|(row, x)| row[place] = x);
        self.max.iter_mut().zip(high).for_each(|(row, x)| row[place] = x);
        self.children[place] = child;
    }

    /// The children in use, with their boxes in the frame.
    pub(super) fn boxes(&self) -> impl Iterator<Item = ([[f32; 3]; 2], Child)> + '_ {
        let used = (0..WIDTH).filter(|&i| self.children[i] != Child::NONE);
        used.map(|i| {
            ([[0, 1, 2].map(|k: usize| self.min[k][i]), [0, 1, 2].map(|k: usize| self.max[k][i])], self.children[i])
        })
    }

    /// Squares of lower bounds of the distances to the eight boxes: at most 2^-20 (relative) too large, apart from
    /// underflow.
    #[inline(always)]
    pub(super) fn lower_bounds<L: Lanes>(&self, query: &Query) -> L {
        let mut sum = L::splat(0.0);
        for k in 0..3 {
            let below = L::load(&self.min[k]).sub(L::splat(query.high[k]));
            let above = L::splat(query.low[k]).sub(L::load(&self.max[k]));
            let gap = below.max(above).max(L::splat(0.0));
            sum = gap.mul_add(gap, sum);
        }
        sum
    }
}

/// The frame of the nodes' boxes: the scene fits into the cube from -1 to 1 (from -4 to 4, for the largest ones).
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    centre: [f64; 3],
    pub(super) unit: f64,
    pub(super) per_unit: f64,
}

/// Units in which squares of lengths are plain, as searches in f32 need them.
const PLAIN: std::ops::RangeInclusive<f64> = power_of_two(-320)..=power_of_two(300);
/// Beyond this many units from the scene, its boxes are asked in f64.
const FARTHEST: f64 = power_of_two(40);

/// A query in the frame, in f32 rounded both ways.
#[derive(Clone, Copy, Debug)]
pub(super) struct Query {
    pub(super) low: [f32; 3],
    pub(super) high: [f32; 3],
}

impl Frame {
    pub(super) fn around(bounds: &Aabb<f64>) -> Self {
        // Halves first: sums and differences of two finite numbers may not be finite.
        let halves: [f64; 3] = std::array::from_fn(|k| bounds.max[k] * 0.5 - bounds.min[k] * 0.5);
        let centre: [f64; 3] = std::array::from_fn(|k| bounds.max[k] * 0.5 + bounds.min[k] * 0.5);
        let half = halves.into_iter().fold(0.0, f64::max);
        // A scene that is one point has the size of what rounding takes from it.
        let half = if half > 0.0 { half } else { centre.iter().fold(0.0, |a, x| x.abs().max(a)) * f64::EPSILON };
        let e = if half > 0.0 && half.is_finite() { exponent(half) + 1 } else { 0 };
        // Not so small that its inverse overflows, nor so large that it does.
        let unit = power_of_two(e.clamp(-1000, 1022));
        Self { centre, unit, per_unit: unit.recip() }
    }

    /// The query in the frame; `None` if it is too far or the frame too small or large to search in f32.
    #[inline(always)]
    #[allow(
        clippy::cast_possible_truncation,
        reason = "rounded both ways, which covers the rounding of the difference"
    )]
    pub(super) fn query(&self, query: &[f64; 3]) -> Option<Query> {
        let q: [f64; 3] = std::array::from_fn(|k| (query[k] - self.centre[k]) * self.per_unit);
        let largest = q[0].abs().max(q[1].abs()).max(q[2].abs());
        if !(PLAIN.contains(&self.unit) && largest <= FARTHEST) {
            return None;
        }
        let mut result = Query { low: [0.0; 3], high: [0.0; 3] };
        for (k, x) in q.into_iter().enumerate() {
            let x = x as f32;
            // At least a unit in the last place, where the conversion errs by half of one.
            let margin = x.abs() * f32::EPSILON + f32::MIN_POSITIVE;
            (result.low[k], result.high[k]) = (x - margin, x + margin);
        }
        Some(result)
    }

    /// A box in the frame, rounded outwards.
    #[allow(clippy::cast_possible_truncation, reason = "rounded outwards, which covers the rounding of the difference")]
    pub(super) fn enclose(&self, bounds: &Aabb<f64>) -> [[f32; 3]; 2] {
        let place = |p: &Point3<f64>, k: usize| ((p[k] - self.centre[k]) * self.per_unit) as f32;
        [[0, 1, 2].map(|k| place(&bounds.min, k).next_down()), [0, 1, 2].map(|k| place(&bounds.max, k).next_up())]
    }

    /// A box around a box of the frame.
    pub(super) fn disclose(&self, bounds: &[[f32; 3]; 2]) -> Aabb<f64> {
        let place = |x: f32, k: usize| self.centre[k] + f64::from(x) * self.unit;
        Aabb {
            min: Point3::from(std::array::from_fn(|k| place(bounds[0][k], k).next_down())),
            max: Point3::from(std::array::from_fn(|k| place(bounds[1][k], k).next_up())),
        }
    }

    /// The square of a length of the scene in the frame, rounded up.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "rounded up before")]
    pub(super) fn square_above(&self, square: f64) -> f32 {
        // 2^-20 for the bounds it is compared with and for this product, 2^-120 for what underflows in either.
        let square = square * (self.per_unit * self.per_unit) * (1.0 + power_of_two(-19)) + power_of_two(-120);
        if square < f64::from(f32::MAX) { square as f32 } else { f32::MAX }
    }
}
