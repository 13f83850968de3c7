//! Candidate lists of boxes: distances of many points from the few primitives that can be nearest in a box.
//!
//! An index answers one query after the other. Points that fill a box, such as the points of a grid, have the same few
//! primitives to choose from. [`Candidates`] are the primitives that can be nearest in a box, found among the
//! candidates of a larger box, and [`CandidateLists::distances`] evaluates them for all points of the box, with points
//! as lanes of a vector.
//!
//! # Which primitives can be nearest in a box
//!
//! Let s be any point of the scene. For any primitive p, |q - s|^2 - d(q, p)^2 is convex in q, because it is the
//! maximum over x in p of 2 q (x - s) + |s|^2 - |x|^2, which are linear in q. So if s is nearer than p at the eight
//! corners of a box, it is nearer in all of the box, and p is not the nearest primitive anywhere in it (**proved**).
//! The closest points to the eight corners serve as s. Of a flat surface with primitives of the size of the box, the
//! primitives below the box and around its rim remain. A group of primitives is excluded if its bounding box is.
//!
//! # Error bound
//!
//! Points, their offsets from a primitive and distances are computed in f64, in a frame of each primitive that is
//! orthonormal to some u, for slivers as well. Let R be the largest distance of a point of the box from a vertex of any
//! candidate, and E = 2^-44 R + 2^-400. Then
//!
//! > |computed - true| <= E, and |computed - computed by the contract's kernel| <= E.
//!
//! **Proof** (constants are rounded up; u = 2^-53).
//!
//! - An offset is rounded by u R. Its three components in the frame are rounded by 3 u R each for the sums and by 4 u R
//!   for the axes, and axes that are not quite orthonormal change lengths by 10 u R. That is 23 u R for the offset. The
//!   vertices of the primitive have offsets of at most 2 R, so they add twice as much: 46 u R.
//! - The rest is about a triangle in the plane whose corners are numbers of f64. Directions of edges are accurate to 4
//!   u, sums of two products to 10 u R, and the components perpendicular to an edge and beyond its ends to 20 u R
//!   together.
//! - A point counts as inside if it is by 2^-46 R = 128 u R for all edges, and then it is inside without rounding too.
//!   A point that is inside and does not count is within 128 u R + 79 u R of the line of an edge. It is as near to the
//!   boundary, since the segment to that line leaves the triangle before it ends, and that bounds its error.
//! - Squares and the root add 6 u R. All together is less than 400 u R. The contract's own 8 u R is added, and 512 u R
//!   is 2^-44 R.
//! - Edges below 2^-450 count as points, and squares lose less than 2^-1000 near zero; 2^-400 exceeds both. Coordinates
//!   up to 2^250 have squares. The closest point of a query has the error of its distance.
//!
//! A value that is rounded to f32 equals the value of the kernel if all of [d - E, d + E] is rounded to it. For other
//! points the kernel evaluates all candidates. That is one point of 10^5 if the scene is not much farther away than it
//! is large.
//!
//! Dominators have to be nearer by a slack that covers these errors. Let m be the largest distance of a corner from s.
//! Then p is excluded if it is farther than s at all corners by 16 E m + 64 E^2 in the computed squares. In the true
//! squares that is at least 12 E m + 47 E^2, since the squares of p err by 2 E (m + 8 E) + E^2. By convexity it holds
//! in all of the box, where |q - s| <= m, so d(q, p)^2 >= (|q - s| + 4 E)^2. Hence p is farther than s by 4 E, the
//! primitive of s is within E of s, and the distances of the kernel are in the same order. That primitive may be
//! excluded by another one that is nearer still, but the one that is nearest by the kernel cannot be. So the candidates
//! give the same values as all primitives, bit for bit.

mod candidates;
mod error_bounds;
mod evaluate;
mod groups;
mod local_primitive;
mod narrow;
mod squared_distances;

pub use candidates::{Candidates, Detail};
pub use error_bounds::MAX_COORDINATE;

use evaluate::Evaluate;
use groups::Groups;
use nalgebra::Point3;
use narrow::Narrow;
use p2m_core::engine::simd::Isa;
use p2m_core::{Aabb, Best, Collector, Primitive, PrimitiveId, PrimitiveSet, QueryOptions, check_set};

/// All primitives of a set, each in a frame of its own, and a hierarchy of groups of them.
#[derive(Debug)]
pub struct CandidateLists<'a, S: ?Sized> {
    set: &'a S,
    groups: Groups,
    isa: Isa,
}

impl<'a, S: PrimitiveSet<f64> + ?Sized> CandidateLists<'a, S> {
    /// Prepares the candidate lists of a set.
    ///
    /// Returns `None` if a primitive is not the convex hull of its [`vertices`](Primitive::vertices), if a coordinate
    /// is not finite or exceeds [`MAX_COORDINATE`], or if memory does not suffice.
    ///
    /// # Complexity
    /// O(n log n) time; 238 bytes per primitive.
    #[must_use]
    pub fn new(set: &'a S) -> Option<Self> {
        let Aabb { min, max } = set.aabb();
        let is_plain = set.is_empty() || min.iter().chain(max.iter()).all(|x| x.abs() <= MAX_COORDINATE);
        // Boxes may ignore NaN, so the coordinates are checked as well, as they are for an index.
        if !is_plain || check_set(set).is_err() {
            return None;
        }
        Some(Self { set, groups: Groups::new(set)?, isa: Isa::best() })
    }

    /// Selects the instruction set, which does not change any value.
    #[must_use]
    pub fn with_isa(self, isa: Isa) -> Self {
        Self { isa, ..self }
    }

    /// Returns the set.
    #[must_use]
    pub fn set(&self) -> &'a S {
        self.set
    }

    /// Returns the memory of the lists in bytes.
    #[must_use]
    pub fn memory(&self) -> usize {
        self.groups.memory()
    }

    /// Returns all primitives as candidates of any box.
    #[must_use]
    pub fn all(&self) -> Candidates {
        let entries = self.groups.root().into_iter().collect();
        Candidates { entries, nearest: 0.0, reach: f64::INFINITY, bounds: None }
    }

    /// Returns the candidates of a part of a box, found among the candidates of the box.
    ///
    /// # Panics
    /// If the part is empty, not contained in the box of `candidates`, or has coordinates above [`MAX_COORDINATE`].
    /// Candidates of other lists may cause a panic or a wrong result.
    ///
    /// # Complexity
    /// O(k) for k candidates.
    #[must_use]
    pub fn narrowed(&self, candidates: &Candidates, part: &Aabb<f64>, detail: Detail) -> Candidates {
        assert!(candidates.covers(part), "{part:?} is not in the box of these candidates");
        Narrow { groups: &self.groups, candidates, part, detail }.run_on(self.isa)
    }

    /// Computes the distances at all points (x, y, z) of a grid in the box of `candidates`.
    ///
    /// `axes` has the coordinates along each axis, and x runs fastest in `values`. The values are the distances of
    /// [`ClosestPoint::closest_point`](p2m_core::ClosestPoint::closest_point) in f64, rounded to f32, bit for bit.
    /// Returns the number of points that needed the contract's kernel.
    ///
    /// # Panics
    /// If the values are not one for each point, if a point is not in the box, or if the candidates have groups.
    ///
    /// # Complexity
    /// O(k) per point and k candidates.
    pub fn distances(&self, candidates: &Candidates, axes: [&[f64]; 3], values: &mut [f32]) -> usize {
        assert_eq!(axes.iter().map(|axis| axis.len()).product::<usize>(), values.len(), "a value for each point");
        if candidates.is_empty() || values.is_empty() {
            values.fill(f32::INFINITY);
            return 0;
        }
        let end = |pick: fn(f64, f64) -> f64| Point3::from(axes.map(|axis| axis.iter().copied().fold(axis[0], pick)));
        assert!(candidates.covers(&Aabb { min: end(f64::min), max: end(f64::max) }), "points outside of the box");
        let evaluate = Evaluate { groups: &self.groups, candidates, axes, values: &mut *values };
        let ambiguous = evaluate.run_on(self.isa);
        let [xs, ys, _] = axes;
        for &n in &ambiguous {
            let [i, j, k] = [n % xs.len(), n / xs.len() % ys.len(), n / (xs.len() * ys.len())];
            values[n] = self.kernel_distance(candidates, Point3::new(xs[i], ys[j], axes[2][k]));
        }
        ambiguous.len()
    }

    /// Returns the candidates that are no groups.
    pub(crate) fn primitives(&self, candidates: &Candidates) -> impl Iterator<Item = PrimitiveId> {
        candidates.entries.iter().filter_map(|entry| entry.primitive()).map(|i| self.groups.ids[i])
    }

    /// Computes the distance of a point from the candidates by the kernel of the contract.
    #[allow(clippy::cast_possible_truncation, reason = "values are rounded to f32")]
    fn kernel_distance(&self, candidates: &Candidates, point: Point3<f64>) -> f32 {
        let mut best = Best::new(&QueryOptions::<f64>::default());
        for id in self.primitives(candidates) {
            if let Some(projection) = self.set.get(id).project_within(&point, best.prune_above()) {
                best.offer(id, projection);
            }
        }
        best.finish().map_or(f32::INFINITY, |closest| closest.distance as f32)
    }
}

#[cfg(test)]
mod tests;
