//! The traits that backends implement: queries for the closest point, and building.

use crate::{BatchAnswer, Best, Closest, Position, PrimitiveSet, QueryOptions, RayQuery, Real};
use nalgebra::Point3;

/// Closest-point queries of a scene. A backend implements one method, [`search`](Self::search).
///
/// # Contract
///
/// In short, no query fails or panics, and every exact index returns the same distance and primitive. Distances are
/// Euclidean, without sign, and in the unit of the coordinates. For a scene in f64 whose box has a diagonal of one
/// kilometre, the error is at most 8 * 2^-53 * 1000 m, less than 1e-12 m, for queries in the box.
///
/// Let u be [`Real::UNIT_ROUNDOFF`], eta the smallest subnormal, d the true distance, d^ the computed one, and M(t) the
/// largest distance from the query to a vertex of primitive t. The *key* ([`Key`](crate::Key)) is the number by which
/// candidates are compared.
///
/// - **N1 distance**: for all finite input, |d^ - d| <= [`ERROR_CONSTANT`](crate::kernel::ERROR_CONSTANT) u M + eta.
///   This is proved in [docs/proofs/accuracy.md]; the largest error observed is 3.3 u M. For points the bound is
///   4 u d + eta. The distance is infinite only if d, or d plus that error, exceeds the range of the scalar.
/// - **N2 identity**: the true distance of the returned primitive exceeds d by at most the sum of the error bounds of
///   that primitive and the nearest one.
/// - **N3 agreement**: every exact backend returns the same bits for distance and primitive. Of equal keys the
///   lowest id wins.
/// - **N4 invariance**: the bits, apart from the signs of zeros, do not change under permutation of primitives (up to
///   ids) and of the vertices of a primitive. They do not change under scaling by powers of two either, while input and
///   results stay normal and are zero or at least 2^-200 of the largest coordinate. (This is observed; products of
///   smaller ones may underflow.)
/// - **N5 point**: a vertex is returned verbatim. Any other point lies in the box of the primitive, and within
///   4 u |q| + 8 u M of the primitive.
/// - **N6 totality**: the answer is `None` for an empty set, if nothing lies within the inclusive radius, and for a
///   query that is not finite. No query panics. A degenerate primitive is the convex hull of its vertices: a segment or
///   a point.
/// - **N7 approximation**: `lower_bound` <= d for all options. With epsilon, d^ <= (1 + epsilon) d up to the
///   error of N1.
///
/// N8 is the contract of [`CertifiedQuery`](crate::CertifiedQuery): the primitive is certainly the nearest one, and its
/// distance is rounded once.
///
/// The trait can be used as a generic bound and as `dyn ClosestPoint<T>`:
///
/// ```
/// use p2m_core::{BruteForce, ClosestPoint, Point, QueryOptions};
/// use nalgebra::Point3;
///
/// let index = BruteForce::new([Point::new(Point3::new(1.0, 0.0, 0.0))]).unwrap();
/// let index: &dyn ClosestPoint<f64> = &index;
/// assert_eq!(index.closest_point(&[0.0; 3]).unwrap().distance, 1.0);
/// let near = QueryOptions::default().with_max_distance(0.5);
/// assert!(index.closest_point_with(&[0.0; 3], &near).is_none());
/// ```
///
/// [docs/proofs/accuracy.md]: https://github.com/p2m-rs/p2m/blob/main/docs/proofs/accuracy.md
#[diagnostic::on_unimplemented(
    message = "`{Self}` answers no closest-point queries with coordinates of type `{T}`",
    note = "indexes do, such as `AabbTree` and `BruteForce`, and references, `Box`, `Rc` and `Arc` to them",
    note = "an index over a scene in f32 answers `Point3<f32>`, and one over a scene in f64 answers `Point3<f64>`"
)]
pub trait ClosestPoint<T: Real> {
    /// Offers to `best` every primitive that could be the answer. `query` is finite.
    fn search(&self, query: &Point3<T>, best: &mut Best<T>);

    /// Returns the closest point subject to `options`, or `None` if nothing is within the largest distance.
    #[inline]
    fn closest_point_with(&self, query: &dyn Position<T>, options: &QueryOptions<T>) -> Option<Closest<T>> {
        let query = query.point();
        if !query.iter().all(|x| x.is_finite()) {
            return None;
        }
        let mut best = Best::new(options);
        self.search(&query, &mut best);
        best.finish()
    }

    /// Returns the closest point, or `None` for an empty set and for a query that is not finite.
    #[inline]
    fn closest_point(&self, query: &dyn Position<T>) -> Option<Closest<T>> {
        self.closest_point_with(query, &QueryOptions::default())
    }

    /// Answers queries on the current thread, in any order, by calling `answered` once for each query with its position
    /// and its answer.
    ///
    /// Backends that interleave searches override this method. Each answer has the distance, primitive, point, feature
    /// and weights that [`closest_point_with`](Self::closest_point_with) returns; with approximate options the whole
    /// answer is the same. The certified lower bound may differ in its last bits, since it depends on the primitives
    /// that a search evaluates.
    fn answer_queries(
        &self,
        queries: &[Point3<T>],
        options: &QueryOptions<T>,
        answered: &mut dyn FnMut(usize, BatchAnswer<'_, T>),
    ) {
        answer_one_by_one(self, queries, options, answered);
    }

    /// Answers `queries` into `out`, in their order and on the current thread.
    ///
    /// [`batch::closest_points_into`](crate::batch::closest_points_into) reorders queries and uses all threads.
    ///
    /// # Panics
    /// It panics if the slices differ in length.
    fn closest_points_into(&self, queries: &[Point3<T>], options: &QueryOptions<T>, out: &mut [Option<Closest<T>>]) {
        assert_eq!(queries.len(), out.len(), "one answer for each query");
        self.answer_queries(queries, options, &mut |i, found| out[i] = found.closest());
    }

    /// Returns the index as a [`RayQuery`] that casts rays with little work, if it is one.
    #[doc(hidden)]
    fn rays(&self) -> Option<&dyn RayQuery<T>> {
        None
    }
}

/// The default implementation of [`ClosestPoint::answer_queries`].
#[doc(hidden)]
pub fn answer_one_by_one<T: Real, I: ClosestPoint<T> + ?Sized>(
    index: &I,
    queries: &[Point3<T>],
    options: &QueryOptions<T>,
    answered: &mut dyn FnMut(usize, BatchAnswer<'_, T>),
) {
    let template = Best::new(options);
    for (i, query) in queries.iter().enumerate() {
        let mut best = template.clone();
        if query.iter().all(|x| x.is_finite()) {
            index.search(query, &mut best);
        }
        answered(i, best.found());
    }
}

/// Building an index. It is not part of [`ClosestPoint`], so that [`ClosestPoint`] can be used as `dyn`.
///
/// ```
/// use p2m_core::{BruteForce, BuildIndex, ClosestPoint, PrimitiveSet};
/// use nalgebra::Point3;
///
/// fn height<S: PrimitiveSet<f64>, I: BuildIndex<f64, S>>(scene: S) -> Result<Option<f64>, I::Error> {
///     let index = I::build(scene, &I::Options::default())?;
///     Ok(index.closest_point(&Point3::new(0.0, 0.0, 10.0)).map(|c| c.distance))
/// }
///
/// let scene = [p2m_core::Point::new(Point3::new(0.0, 0.0, 4.0))];
/// assert_eq!(height::<_, BruteForce<_>>(&scene).unwrap(), Some(6.0));
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot be built over `{S}` with coordinates of type `{T}`",
    note = "a scene is a `PrimitiveSet<{T}>`, owned, borrowed or in an `Arc`, and has to be `Sync`"
)]
pub trait BuildIndex<T: Real, S: PrimitiveSet<T>>: ClosestPoint<T> + Sized {
    /// The options of building.
    type Options: Default;
    /// The error of building.
    type Error: std::error::Error;

    /// Builds the index over `set`, which it keeps. Pass a reference to borrow the scene, the scene itself to have both
    /// in one value, or an `Arc` to share the scene with other owners. The set may be empty.
    ///
    /// # Errors
    /// The indexes of this project return [`BuildError::NonFinite`](crate::BuildError::NonFinite) for a coordinate that
    /// is not finite, and [`BuildError::TooMany`](crate::BuildError::TooMany) for more than 2^30 primitives.
    fn build(set: S, options: &Self::Options) -> Result<Self, Self::Error>;
}
