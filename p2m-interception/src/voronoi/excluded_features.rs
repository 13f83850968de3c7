//! The exclusion of a feature by planes: all of a region is on the wrong side of one plane, or each of its points is on
//! the wrong side of one of two planes.

use p2m_core::engine::vector::{V3, dot, sub};

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

/// The test of one feature: its planes, and the heights of a region above them. Its vectors are reused.
#[derive(Default)]
pub(crate) struct ExcludedFeatures {
    /// The mean of the points that span the region.
    mean: V3,
    /// The planes so far.
    planes: Vec<PlaneHeights>,
    /// The heights of the points above some planes: those whose right side does not contain the mean, and
    /// others on demand.
    heights: Vec<f64>,
    /// Whether one plane has excluded the feature already.
    is_decided: bool,
}

/// A plane, with the heights of a region above it.
struct PlaneHeights {
    /// The plane, with its margin.
    plane: Plane,
    /// The height of the mean of the region.
    mean: f64,
    /// The index of the first height of the points, if the heights have been computed.
    first: Option<usize>,
}

impl Plane {
    /// Returns the height of a point above the plane, increased by the margin. It is negative on the wrong side.
    fn height(&self, x: &V3) -> f64 {
        dot(sub(*x, self.point), self.direction) + self.margin
    }
}

impl ExcludedFeatures {
    /// Begins another region.
    pub(crate) fn begin_region(&mut self, region: &[V3]) {
        let sum = region.iter().fold([0.0; 3], |sum, h| [sum[0] + h[0], sum[1] + h[1], sum[2] + h[2]]);
        self.mean = sum.map(|x| x / region.len() as f64);
    }

    /// Begins another feature.
    pub(crate) fn begin_feature(&mut self) {
        self.planes.clear();
        self.heights.clear();
        self.is_decided = false;
    }

    /// Adds a plane of the feature.
    pub(crate) fn add(&mut self, region: &[V3], plane: Plane) {
        if self.is_decided {
            return;
        }
        let mean = plane.height(&self.mean);
        self.planes.push(PlaneHeights { plane, mean, first: None });
        // All points can have a negative height only if their mean has.
        if mean < 0.0 {
            self.is_decided = self.heights_above(self.planes.len() - 1, region).iter().all(|x| *x < 0.0);
        }
    }

    /// Returns the heights of the points above a plane.
    fn heights_above(&mut self, number: usize, region: &[V3]) -> &[f64] {
        let PlaneHeights { plane, first, .. } = &mut self.planes[number];
        let first = *first.get_or_insert_with(|| {
            let first = self.heights.len();
            self.heights.extend(region.iter().map(|h| plane.height(h)));
            first
        });
        &self.heights[first..first + region.len()]
    }

    /// Returns whether the planes exclude the feature.
    pub(crate) fn is_excluded(&mut self, region: &[V3]) -> bool {
        if self.is_decided || region.is_empty() {
            return true;
        }
        for i in 0..self.planes.len() {
            for j in 0..i {
                if self.planes[i].mean + self.planes[j].mean < 0.0 {
                    self.heights_above(i, region);
                    self.heights_above(j, region);
                    let [a, b] = [i, j].map(|n| &self.heights[self.planes[n].first.unwrap_or(0)..][..region.len()]);
                    if a.iter().zip(b).all(|(x, y)| x + y < 0.0) {
                        return true;
                    }
                }
            }
        }
        false
    }
}
