//! The traits that backends implement.

use crate::{Best, Closest, PrimitiveSet, QueryOptions, Real};
use nalgebra::Point3;

/// Closest points of a scene. A backend writes one method, [`search`](Self::search).
///
/// # Contract
///
/// In short: no query fails or panics, and every exact index gives the same distance and primitive. Distances are Euclidean, not
/// signed, and in the unit of the coordinates; where the scene is in f64, in metres, and a kilometre wide, they are right to 1e-12
/// metres (8 * 2^-53 * 1000 m) for queries in its box.
///
/// u is [`Real::UNIT_ROUNDOFF`], eta the smallest subnormal, d the true distance, d^ the computed one, M(t) the largest
/// distance from the query to a vertex of primitive t, *key* the number by which candidates are compared
/// ([`Key`](crate::Key)).
///
/// - **N1 distance**: for all finite input, |d^ - d| <= [`ERROR_CONSTANT`](crate::kernel::ERROR_CONSTANT) u M + eta
///   (proved, see docs/proofs/accuracy.md; the largest observed is 3.3 u M), for points 4 u d + eta. Infinite only if d, or d
///   plus that error, exceeds the scalar's range.
/// - **N2 identity**: the true distance of the returned primitive exceeds d by at most the sum of both error bounds.
/// - **N3 agreement**: every exact backend returns the same bits for distance and primitive. Ties go to the lowest id
///   among equal keys.
/// - **N4 invariance**: the same bits (but for the signs of zeros) under permutation of primitives (up to ids) and of a
///   primitive's vertices, and under scaling by powers of two while input and results stay normal and are zero or
///   at least 2^-200 of the largest coordinate (observed; products of smaller ones may underflow).
/// - **N5 point**: a vertex is answered verbatim; any other point lies in the primitive's box and within 4 u |q| + 8 u
///   M of the primitive.
/// - **N6 totality**: `None` for an empty set, when nothing lies within the (inclusive) radius, and for a query that is
///   not finite. No query panics. A degenerate primitive is the set it spans.
/// - **N7 approximation**: `lower_bound` <= d always; with epsilon, d^ <= (1 + epsilon) d up to the error of N1.
///
/// [`CertifiedQuery`](crate::CertifiedQuery) has N8: the nearest primitive without doubt, and its distance rounded once.
///
/// Usable as a generic bound and as `dyn ClosestPoint<T>`:
///
/// ```
/// use p2m_core::{BruteForce, ClosestPoint, Point, QueryOptions};
/// use nalgebra::Point3;
///
/// let index = BruteForce::new([Point::new(Point3::new(1.0, 0.0, 0.0))]).unwrap();
/// let index: &dyn ClosestPoint<f64> = &index;
/// assert_eq!(index.closest_point(&Point3::origin()).unwrap().distance, 1.0);
/// let near = QueryOptions::default().with_max_distance(0.5);
/// assert!(index.closest_point_with(&Point3::origin(), &near).is_none());
/// ```
pub trait ClosestPoint<T: Real> {
    /// Offers to `best` every primitive that could win. `query` is finite.
    fn search(&self, query: &Point3<T>, best: &mut Best<T>);

    /// The closest point within what `options` ask.
    fn closest_point_with(&self, query: &Point3<T>, options: &QueryOptions<T>) -> Option<Closest<T>> {
        if !query.iter().all(|x| x.is_finite()) {
            return None;
        }
        let mut best = Best::new(options);
        self.search(query, &mut best);
        best.finish()
    }

    /// The closest point.
    fn closest_point(&self, query: &Point3<T>) -> Option<Closest<T>> {
        self.closest_point_with(query, &QueryOptions::default())
    }

    /// Answers `queries` one by one into `out`, in their order.
    ///
    /// # Panics
    /// If the slices differ in length.
    fn closest_points_into(&self, queries: &[Point3<T>], options: &QueryOptions<T>, out: &mut [Option<Closest<T>>]) {
        assert_eq!(queries.len(), out.len(), "one answer for each query");
        for (query, answer) in queries.iter().zip(out) {
            *answer = self.closest_point_with(query, options);
        }
    }
}

/// What an index that is borrowed answers.
impl<T: Real, I: ClosestPoint<T> + ?Sized> ClosestPoint<T> for &I {
    fn search(&self, query: &Point3<T>, best: &mut Best<T>) {
        (**self).search(query, best);
    }

    fn closest_point_with(&self, query: &Point3<T>, options: &QueryOptions<T>) -> Option<Closest<T>> {
        (**self).closest_point_with(query, options)
    }

    fn closest_points_into(&self, queries: &[Point3<T>], options: &QueryOptions<T>, out: &mut [Option<Closest<T>>]) {
        (**self).closest_points_into(queries, options, out);
    }
}

/// How an index is built; apart from [`ClosestPoint`] so that the latter stays usable as `dyn`.
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
pub trait BuildIndex<T: Real, S: PrimitiveSet<T>>: ClosestPoint<T> + Sized {
    /// What can be chosen.
    type Options: Default;
    /// Why it can fail.
    type Error: std::error::Error;

    /// Builds the index over `set`, which it keeps: hand over a reference to borrow the scene, or the scene itself to have
    /// both in one value.
    ///
    /// # Errors
    /// [`BuildError::NonFinite`](crate::BuildError::NonFinite) and [`BuildError::TooMany`](crate::BuildError::TooMany) (more than
    /// 2^30 primitives) of the indexes of this project; one of your own may have others. An empty set is none.
    fn build(set: S, options: &Self::Options) -> Result<Self, Self::Error>;
}
