//! The test that excludes features of a primitive from a region.
//!
//! A feature can hold the nearest point only for queries on the right side of all of its planes. So it is excluded if
//! the whole region lies on the wrong side of one plane. It is also excluded if each point of the region lies on the
//! wrong side of at least one of two planes, which is certain if the sum of the two heights is negative in the whole
//! region.

use p2m_core::engine::simd::{Doubles, Float};
use p2m_core::engine::vector::V3;

/// The number of points in a block of a region.
const BLOCK_POINTS: usize = 8;

/// A plane through a point with a normal of length 1. A query on its right side has a height of at least minus
/// `margin`.
#[derive(Clone, Copy)]
pub(crate) struct Plane {
    /// A point of the plane.
    pub(crate) point: V3,
    /// The normal of the plane, which points to the right side.
    pub(crate) direction: V3,
    /// The height below the plane up to which points count as above.
    pub(crate) margin: f64,
}

/// The points that span a region, in blocks of eight. The last block repeats its first point.
#[derive(Default)]
pub(crate) struct RegionPoints {
    blocks: Vec<[[f64; BLOCK_POINTS]; 3]>,
    /// The number of points.
    count: usize,
}

impl RegionPoints {
    /// Removes all points.
    #[inline(always)]
    pub(crate) fn clear(&mut self) {
        self.blocks.clear();
        self.count = 0;
    }

    /// Adds a point.
    #[inline(always)]
    pub(crate) fn push(&mut self, point: V3) {
        let place = self.count % BLOCK_POINTS;
        self.count += 1;
        match self.blocks.last_mut() {
            Some(block) if place > 0 => {
                for (row, x) in block.iter_mut().zip(point) {
                    row[place] = x;
                }
            }
            _ => self.blocks.push(point.map(|x| [x; BLOCK_POINTS])),
        }
    }

    /// Returns the points.
    pub(crate) fn iter(&self) -> impl Iterator<Item = V3> + '_ {
        let all =
            self.blocks.iter().flat_map(|[x, y, z]| (0..BLOCK_POINTS).map(|place| [x[place], y[place], z[place]]));
        all.take(self.count)
    }
}

/// The test of one feature: its planes, and their heights. Its vectors are reused.
#[derive(Default)]
pub(crate) struct ExcludedFeatures {
    /// A point of the convex hull of the region, about in its middle.
    middle: V3,
    /// The planes so far, each with the height of the middle of the region.
    planes: Vec<(Plane, f64)>,
}

impl Plane {
    /// Returns the heights of points above the plane, increased by the margin. They are negative on the wrong side.
    #[inline(always)]
    fn heights<F: Float>(&self, [x, y, z]: [F; 3]) -> F {
        let Self { point: [px, py, pz], direction: [dx, dy, dz], margin } = *self;
        let (x, y, z) = (x - F::splat(px), y - F::splat(py), z - F::splat(pz));
        x * F::splat(dx) + y * F::splat(dy) + z * F::splat(dz) + F::splat(margin)
    }
}

impl ExcludedFeatures {
    /// Begins another region.
    #[inline(always)]
    pub(crate) fn begin_region<D: Doubles>(&mut self, region: &RegionPoints) {
        let mut sum = [D::splat(0.0); 3];
        for block in &region.blocks {
            for (sum, row) in sum.iter_mut().zip(block) {
                *sum = *sum + D::load(row);
            }
        }
        let share = 1.0 / (region.blocks.len() * BLOCK_POINTS) as f64;
        for (middle, sum) in self.middle.iter_mut().zip(sum) {
            let mut row = [0.0; BLOCK_POINTS];
            sum.store(&mut row);
            let [a, b, c, d, e, f, g, h] = row;
            *middle = (((a + b) + (c + d)) + ((e + f) + (g + h))) * share;
        }
    }

    /// Begins another feature.
    #[inline(always)]
    pub(crate) fn begin_feature(&mut self) {
        self.planes.clear();
    }

    /// Adds a plane of the feature. Returns whether it excludes the feature, alone or together with an earlier plane.
    #[inline(always)]
    pub(crate) fn add<D: Doubles>(&mut self, region: &RegionPoints, plane: Plane) -> bool {
        let height = plane.heights(self.middle);
        // All points can have a negative height only if their middle has.
        if height < 0.0 && are_below::<D, 1>(region, [&plane]) {
            return true;
        }
        for (other, other_height) in &self.planes {
            if height + other_height < 0.0 && are_below::<D, 2>(region, [&plane, other]) {
                return true;
            }
        }
        self.planes.push((plane, height));
        false
    }
}

/// Returns whether the sum of the heights above some planes is negative at all points of a region.
#[inline(always)]
fn are_below<D: Doubles, const N: usize>(region: &RegionPoints, planes: [&Plane; N]) -> bool {
    for [x, y, z] in &region.blocks {
        let points = [D::load(x), D::load(y), D::load(z)];
        let mut sum = planes[0].heights(points);
        for plane in &planes[1..] {
            sum = sum + plane.heights(points);
        }
        if D::bits(sum.is_below(D::splat(0.0))) != 0xff {
            return false;
        }
    }
    true
}
