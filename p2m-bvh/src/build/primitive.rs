//! Primitives and boxes as the splits of a build see them.

use nalgebra::Point3;
use p2m_core::{Aabb, PrimitiveId, Real};

/// A primitive that is being sorted into a leaf: its box in f64, at half scale so that no sum overflows.
#[derive(Clone, Copy)]
pub(crate) struct BuildPrimitive {
    pub(crate) min: [f64; 3],
    pub(crate) max: [f64; 3],
    pub(crate) id: PrimitiveId,
}

impl BuildPrimitive {
    pub(crate) fn new<T: Real>(b: &Aabb<T>, id: PrimitiveId) -> Self {
        let half = |p: &Point3<T>| std::array::from_fn(|k| p[k].to_f64() * 0.5);
        Self { min: half(&b.min), max: half(&b.max), id }
    }

    /// The coordinate of the centre along an axis, at full scale.
    #[inline]
    pub(crate) fn centre(&self, axis: usize) -> f64 {
        self.min[axis] + self.max[axis]
    }
}

/// A box that grows while primitives are added to it.
#[derive(Clone, Copy)]
pub(crate) struct GrowingBox {
    pub(crate) min: [f64; 3],
    pub(crate) max: [f64; 3],
}

impl GrowingBox {
    pub(crate) const EMPTY: Self = Self { min: [f64::INFINITY; 3], max: [f64::NEG_INFINITY; 3] };

    /// Adds a box, given by its two corners.
    #[inline]
    pub(crate) fn add(&mut self, min: &[f64; 3], max: &[f64; 3]) {
        for k in 0..3 {
            self.min[k] = if min[k] < self.min[k] { min[k] } else { self.min[k] };
            self.max[k] = if max[k] > self.max[k] { max[k] } else { self.max[k] };
        }
    }

    pub(crate) fn longest_side(&self) -> f64 {
        (0..3).map(|k| self.max[k] - self.min[k]).fold(0.0, f64::max)
    }

    /// The axis of the longest side, the last one if several are equally long.
    pub(crate) fn longest_axis(&self) -> usize {
        // Coordinates are halved first, because a difference may overflow.
        let side = |k: usize| self.max[k] * 0.5 - self.min[k] * 0.5;
        (0..3).max_by(|a, b| side(*a).total_cmp(&side(*b))).unwrap_or(0)
    }
}
