//! Primitives and boxes as the splits of a build see them.

use nalgebra::Point3;
use p2m_core::{Aabb, PrimitiveId, Real};

/// A primitive that is being sorted into a leaf.
#[derive(Clone, Copy)]
pub(crate) struct BuildPrimitive {
    /// The box in f64, at half scale so that no sum overflows.
    pub(crate) bounds: GrowingBox,
    pub(crate) id: PrimitiveId,
}

impl BuildPrimitive {
    pub(crate) fn new<T: Real>(b: &Aabb<T>, id: PrimitiveId) -> Self {
        let half = |p: &Point3<T>| std::array::from_fn(|k| p[k].to_f64() * 0.5);
        Self { bounds: GrowingBox::new(half(&b.min), half(&b.max)), id }
    }

    /// The coordinate of the centre along an axis, at full scale.
    #[inline(always)]
    pub(crate) fn centre(&self, axis: usize) -> f64 {
        self.bounds.min(axis) + self.bounds.max(axis)
    }
}

/// A box that grows while others are added to it: its lower corner, and the negated coordinates of its upper corner.
/// So all six numbers are minima, which are computed in lanes.
#[derive(Clone, Copy)]
pub(crate) struct GrowingBox([f64; 6]);

impl GrowingBox {
    pub(crate) const EMPTY: Self = Self([f64::INFINITY; 6]);

    /// Makes a box from its corners.
    #[inline(always)]
    pub(crate) fn new(min: [f64; 3], max: [f64; 3]) -> Self {
        Self([min[0], min[1], min[2], -max[0], -max[1], -max[2]])
    }

    /// The least coordinate along an axis.
    #[inline(always)]
    pub(crate) fn min(&self, axis: usize) -> f64 {
        self.0[axis]
    }

    /// The largest coordinate along an axis.
    #[inline(always)]
    pub(crate) fn max(&self, axis: usize) -> f64 {
        -self.0[3 + axis]
    }

    /// Adds a box.
    #[inline(always)]
    pub(crate) fn add(&mut self, other: &Self) {
        for (bound, other) in self.0.iter_mut().zip(&other.0) {
            *bound = if *other < *bound { *other } else { *bound };
        }
    }

    pub(crate) fn longest_side(&self) -> f64 {
        (0..3).map(|k| self.max(k) - self.min(k)).fold(0.0, f64::max)
    }

    /// The axis of the longest side, the last one if several are equally long.
    pub(crate) fn longest_axis(&self) -> usize {
        // Coordinates are halved first, because a difference may overflow.
        let side = |k: usize| self.max(k) * 0.5 - self.min(k) * 0.5;
        (0..3).max_by(|a, b| side(*a).total_cmp(&side(*b))).unwrap_or(0)
    }
}
