//! Excluded features: a feature that needs the query on one side of some planes cannot hold the nearest point in a
//! region that lies on the wrong side of one plane, or of which each point is on the wrong side of one of two planes.

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
        let all = self.blocks.iter().flat_map(|[x, y, z]| (0..BLOCK_POINTS).map(|place| [x[place], y[place], z[place]]));
        all.take(self.count)
    }
}

/// The test of one feature: its planes, and the heights of a region above them. Its vectors are reused.
#[derive(Default)]
pub(crate) struct ExcludedFeatures {
    /// A point of the convex hull of the region, about in its middle.
    middle: V3,
    /// The planes so far.
    planes: Vec<PlaneHeights>,
    /// The heights of the points above some planes: those whose right side does not contain the middle, and
    /// others on demand.
    heights: Vec<[f64; BLOCK_POINTS]>,
    /// Whether one plane has excluded the feature already.
    is_decided: bool,
}

/// A plane, with the heights of a region above it.
struct PlaneHeights {
    /// The plane, with its margin.
    plane: Plane,
    /// The height of the middle of the region.
    middle: f64,
    /// The index of the first block of heights, or [`NOT_COMPUTED`].
    first: usize,
}

/// Marks that the heights above a plane are not computed yet.
const NOT_COMPUTED: usize = usize::MAX;

impl Plane {
    /// Returns the heights of points above the plane, increased by the margin. They are negative on the wrong side.
    #[inline(always)]
    fn heights<F: Float>(&self, [x, y, z]: [F; 3]) -> F {
        let [px, py, pz] = self.point.map(F::splat);
        let [dx, dy, dz] = self.direction.map(F::splat);
        (x - px) * dx + (y - py) * dy + (z - pz) * dz + F::splat(self.margin)
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
        self.heights.clear();
        self.is_decided = false;
    }

    /// Adds a plane of the feature. It returns whether the plane excludes the feature, so that no other plane is
    /// needed.
    #[inline(always)]
    pub(crate) fn add<D: Doubles>(&mut self, region: &RegionPoints, plane: Plane) -> bool {
        let middle = plane.heights(self.middle);
        let mut first = NOT_COMPUTED;
        // All points can have a negative height only if their middle has.
        if middle < 0.0 {
            first = self.heights.len();
            self.is_decided = self.compute_heights::<D>(&plane, region);
        }
        self.planes.push(PlaneHeights { plane, middle, first });
        self.is_decided
    }

    /// Computes the heights of the points above a plane, and returns whether all are negative.
    #[inline(always)]
    fn compute_heights<D: Doubles>(&mut self, plane: &Plane, region: &RegionPoints) -> bool {
        let mut is_below = 0xff;
        for [x, y, z] in &region.blocks {
            let heights = plane.heights([D::load(x), D::load(y), D::load(z)]);
            is_below &= D::bits(heights.is_below(D::splat(0.0)));
            let mut row = [0.0; BLOCK_POINTS];
            heights.store(&mut row);
            self.heights.push(row);
        }
        is_below == 0xff
    }

    /// Returns whether the planes exclude the feature.
    #[inline(always)]
    pub(crate) fn is_excluded<D: Doubles>(&mut self, region: &RegionPoints) -> bool {
        if self.is_decided {
            return true;
        }
        for i in 1..self.planes.len() {
            for j in 0..i {
                if self.planes[i].middle + self.planes[j].middle < 0.0 && self.is_excluded_by_two::<D>(region, i, j) {
                    return true;
                }
            }
        }
        false
    }

    /// Returns whether the heights above two planes have a negative sum at all points.
    #[inline(always)]
    fn is_excluded_by_two<D: Doubles>(&mut self, region: &RegionPoints, i: usize, j: usize) -> bool {
        for number in [i, j] {
            if self.planes[number].first == NOT_COMPUTED {
                self.planes[number].first = self.heights.len();
                let plane = self.planes[number].plane;
                self.compute_heights::<D>(&plane, region);
            }
        }
        let [a, b] = [i, j].map(|number| &self.heights[self.planes[number].first..][..region.blocks.len()]);
        a.iter().zip(b).all(|(a, b)| D::bits((D::load(a) + D::load(b)).is_below(D::splat(0.0))) == 0xff)
    }
}
