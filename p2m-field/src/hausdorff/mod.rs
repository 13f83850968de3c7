//! The Hausdorff distance of two scenes, between certified bounds.
//!
//! The one-sided Hausdorff distance h(A, B) is the largest distance of a point of A from B, over all points of the
//! triangles, segments and points of A. The Hausdorff distance is the larger one of h(A, B) and h(B, A).
//!
//! # Method
//!
//! The method is a branch and bound over pieces of A: points, segments and triangles, which are the primitives at first
//! \[Guthe2005\]. The piece with the largest upper bound is cut in the middle of its longest edge, until that bound is
//! within the tolerance of the lower bound.
//!
//! - **Lower bound.** The distance of any point of A is a lower bound. The corners of all primitives are queried first,
//!   in a batch and shared ones once, and then the points at which pieces are cut. The best one is certified
//!   ([`CertifiedQuery`]), so its distance is correct to the last digit.
//! - **Upper bound.** For a primitive p of B and a point x, the distance d(x, p) is a convex function of x, because p
//!   is convex. So its maximum over a piece is at a corner, and for all x of the piece with the corners c1, c2, c3
//!   d(x, B) <= d(x, p) <= max d(ci, p).
//!
//!   The smallest such bound is taken over the primitives that are nearest to a corner, and one that is nearest to a
//!   point inside \[Tang2009, Kang2018\]. A piece whose points have one nearest primitive p in common needs no cut: the
//!   bound is then the distance of a corner. The bound is never above the one that follows from the Lipschitz
//!   condition, d(ci, B) plus the largest distance of another corner from ci, because d(cj, p) <= |cj - ci| + d(ci, p).
//!
//! - **Upper bound by several primitives.** If no single one of these primitives bounds a piece well enough, the piece
//!   is divided along the edges of one of them, and its parts are bounded by different ones ([`covering`]). Where two
//!   surfaces are the same set with other triangles, most pieces lie on two or three triangles of a plane. Without
//!   these bounds they would be cut along all edges until they are as small as the tolerance.
//!
//! Pieces of both directions share one queue, so the direction with the larger distance ends the other one early.
//!
//! # Rounding
//!
//! The middle of an edge is rounded, so a piece is not exactly a part of its primitive. Let u be the unit roundoff of
//! the scalar, eta its smallest subnormal, and s the largest magnitude of a coordinate of the primitive. The middle of
//! two corners that are off their exact places by e1 and e2 is off by at most (e1 + e2) / 2 + sqrt(3) (1.01 u s + 2
//! eta): the two halves err by eta / 2 each, their sum in f64 by u s, and the conversion to f32 by u s. So a corner
//! after k cuts is off by at most k r with r = 2 (u s + 2 eta). Parts of a piece are divided in f64. A point
//! (1 - t) a + t b between two corners of a part is off by at most 4 r' more than these, where r' is r for f64: the
//! weight, the products and the sum err by 3 sqrt(3) u s.
//!
//! A point x of the exact piece is the sum of its exact corners with some weights, and the sum of the rounded corners
//! with the same weights is within k r of x. After l divisions of a part it is within k r + 4 l r' of x. Hence
//!
//! - d(x, B) <= max (d^(ci, p) + error of d^) + k r, where the kernel bounds the error of a computed distance d^ by 8 u
//!   M (contract N1 of [`ClosestPoint`]). The sum is rounded up;
//! - h(A, B) >= l - k r, where l is the certified lower bound on d(ci, B), because the exact corner is in A. The
//!   difference is rounded down. k is 0 for vertices of the scene.
//!
//! A piece cannot be improved by a cut if its upper bound exceeds the distance of one of its corners by no more than
//! these errors, or if the middle of its longest edge is an end of that edge. The search ends if the piece with the
//! largest bound is one of these. So it ends for every tolerance, and the difference of the bounds is then as small as
//! rounding allows.

mod covering;
mod search;
#[cfg(test)]
mod tests;

use nalgebra::Point3;
use p2m_core::{CertifiedQuery, CertifyError, ClosestPoint, PrimitiveId, Real, Soup};
use search::{Search, Side};
use std::ops::ControlFlow;

/// The queries that a Hausdorff distance asks of an index. Every index of this project answers them.
pub trait HausdorffIndex<T: Real>: ClosestPoint<T> + CertifiedQuery<T> + Sync {}

impl<T: Real, I: ClosestPoint<T> + CertifiedQuery<T> + Sync + ?Sized> HausdorffIndex<T> for I {}

/// Options of [`hausdorff_distance`] and [`one_sided_hausdorff_distance`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct HausdorffOptions<T: Real> {
    /// The largest difference of the bounds, in units of the scenes. A negative number and NaN count as 0: the bounds
    /// are then as near to each other as rounding allows, if `max_queries` suffices. With an infinite one
    /// only vertices are asked.
    pub tolerance: T,
    /// The largest number of queries besides the vertices. When it is exhausted, the result has the bounds that were
    /// reached. The default is 2^24.
    pub max_queries: u64,
    /// Whether all threads of the current pool are used, which does not change the result. Without the feature `rayon`
    /// one thread is used in any case. The default is `true`.
    pub parallel: bool,
}

impl<T: Real> HausdorffOptions<T> {
    /// Creates options with a tolerance.
    #[must_use]
    pub fn new(tolerance: T) -> Self {
        Self { tolerance, max_queries: 1 << 24, parallel: true }
    }
    /// Sets the largest number of queries besides the vertices.
    #[must_use]
    pub fn with_max_queries(self, max_queries: u64) -> Self {
        Self { max_queries, ..self }
    }
    /// Sets whether all threads of the current pool are used.
    #[must_use]
    pub fn with_parallel(self, parallel: bool) -> Self {
        Self { parallel, ..self }
    }
}

/// The direction of a one-sided distance: which scene is measured, and from which one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Direction {
    /// A point of the first scene is farthest from the second one.
    FirstToSecond,
    /// A point of the second scene is farthest from the first one.
    SecondToFirst,
}

/// A Hausdorff distance between bounds. Lengths are in units of the scenes, and arrays of two have the
/// first scene first.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct HausdorffDistance<T: Real> {
    /// A certified lower bound on the true Hausdorff distance.
    pub lower_bound: T,
    /// A certified upper bound. It exceeds the lower one by at most the tolerance, unless rounding does not allow it, a
    /// limit of queries was reached, or the search was ended.
    pub upper_bound: T,
    /// Whether the upper bound exceeds the lower one by at most the tolerance, before both are rounded to the scalar.
    pub is_tolerance_reached: bool,
    /// A point whose distance from the other scene attains the lower bound, and its closest point there.
    pub points: [Point3<T>; 2],
    /// The primitives that contain these points. A vertex of the measured scene has the lowest id of the
    /// primitives that share it.
    pub primitives: [PrimitiveId; 2],
    /// Which of the scenes has the point that is farthest from the other one.
    pub direction: Direction,
    /// The number of queries that were asked.
    pub queries: u64,
}

/// The state of a search for a Hausdorff distance.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct HausdorffProgress<T: Real> {
    /// The lower bound so far, which never decreases.
    pub lower_bound: T,
    /// The upper bound so far, which is infinite until the vertices were asked, and never increases.
    pub upper_bound: T,
    /// The number of queries so far.
    pub queries: u64,
}

/// Receives the state of a search from time to time, and ends it by [`ControlFlow::Break`].
pub type ReportProgress<'a, T> = dyn FnMut(&HausdorffProgress<T>) -> ControlFlow<()> + 'a;

/// Returns the largest distance of a point of the first scene from the second one, given an index of the second one;
/// `None` if either scene is empty.
///
/// The result is the same for every exact index of the second scene, bit for bit, and for every number of threads.
///
/// ```
/// use nalgebra::Point3;
/// use p2m_core::{BruteForce, Element, Soup};
/// use p2m_field::{HausdorffOptions, one_sided_hausdorff_distance};
/// use std::ops::ControlFlow;
///
/// // The middle of a segment is farther from two points than its ends are.
/// let at = |x| Point3::new(x, 0.0, 0.0);
/// let beam = Soup::new(vec![at(0.0), at(8.0)], [Element::Segment([0, 1])])?;
/// let posts = Soup::new(vec![at(0.0), at(8.0)], [Element::Point(0), Element::Point(1)])?;
/// let posts = BruteForce::new(&posts)?;
/// let options = HausdorffOptions::new(0.001);
/// let found = one_sided_hausdorff_distance(&beam, &posts, &options, &mut |_| ControlFlow::Continue(()))?;
/// let found = found.expect("no scene is empty");
/// assert!(found.lower_bound <= 4.0 && 4.0 <= found.upper_bound && found.upper_bound - found.lower_bound <= 0.001);
/// assert_eq!(found.points[0], at(4.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`CertifyError::NoVertices`] if a primitive of your own without vertices is nearest to a point that was asked.
///
/// # Accuracy
/// Both bounds hold in spite of rounding. The point of the first scene is a vertex of it, or within 2 k (u s + 2 eta)
/// of it, where s is the largest coordinate of its primitive and k the number of times that the primitive was cut, at
/// most some hundred. The lower bound is less by that much, and correct to the last digit for a vertex.
///
/// # Complexity
/// One query per vertex, and two per cut. Few primitives are cut if the distance is large beside the primitives. Where
/// whole faces are equally far or the same, the number of cuts is about the number of primitives of both scenes there
/// times log(1 / tolerance). For n vertices, m primitives and q other queries the memory is 40 (n + q) + 40 (m + q)
/// bytes in f64.
pub fn one_sided_hausdorff_distance<T: Real, I: HausdorffIndex<T> + ?Sized>(
    first: &Soup<T>,
    index: &I,
    options: &HausdorffOptions<T>,
    progress: &mut ReportProgress<'_, T>,
) -> Result<Option<HausdorffDistance<T>>, CertifyError> {
    Search::new(&[Side { surface: first, target: &index }], options).run(progress)
}

/// Returns the Hausdorff distance of two scenes, each given with its index: the larger one of both one-sided distances.
/// It is `None` if either scene is empty.
///
/// Everything else is as [`one_sided_hausdorff_distance`] says.
///
/// ```
/// use nalgebra::Vector3;
/// use p2m_core::BruteForce;
/// use p2m_field::{HausdorffOptions, hausdorff_distance};
/// use p2m_mixed::generate::{IcoSphere, ico_sphere};
/// use std::ops::ControlFlow;
///
/// // The distance of a convex surface from its translated copy is the length of the translation.
/// let ball = ico_sphere(&IcoSphere { frequency: 2 })?;
/// let mut moved = ball.clone();
/// moved.map_positions(|p| p + Vector3::new(0.3, 0.0, 0.4))?;
/// let [a, b] = [BruteForce::new(&ball)?, BruteForce::new(&moved)?];
/// let options = HausdorffOptions::new(1e-4);
/// let found = hausdorff_distance((&ball, &a), (&moved, &b), &options, &mut |_| ControlFlow::Continue(()))?;
/// let found = found.expect("no scene is empty");
/// assert!(found.lower_bound <= 0.5 + 1e-15 && 0.5 - 1e-15 <= found.upper_bound);
/// assert!(found.upper_bound - found.lower_bound <= 1e-4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`CertifyError::NoVertices`] if a primitive of your own without vertices is nearest to a point that was asked.
pub fn hausdorff_distance<T: Real, I: HausdorffIndex<T> + ?Sized, J: HausdorffIndex<T> + ?Sized>(
    first: (&Soup<T>, &I),
    second: (&Soup<T>, &J),
    options: &HausdorffOptions<T>,
    progress: &mut ReportProgress<'_, T>,
) -> Result<Option<HausdorffDistance<T>>, CertifyError> {
    let sides = [Side { surface: first.0, target: &second.1 }, Side { surface: second.0, target: &first.1 }];
    Search::new(&sides, options).run(progress)
}
