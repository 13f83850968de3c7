//! Certified queries for any index.
//!
//! An index finds all primitives that may be nearest, given the error bounds of the kernel. In most cases there is one
//! such primitive, or several that share their nearest feature. [`decide`] returns the nearest of them.

use super::candidate::Candidate;
use super::decide::{decide, is_within};
use crate::near_query::{Near, search_near_if_valid};
use crate::pair::Hull;
use crate::real::to_f64_array;
use crate::{Closest, NearQuery, Position, Primitive, PrimitiveId, PrimitiveSet, QueryOptions, Real, Shape};

/// The error of a certified query.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CertifyError {
    /// A primitive that may be nearest is of a type of your own without [`vertices`](crate::Primitive::vertices), so
    /// its exact distance is unknown.
    #[error("primitive {id} is no point, segment or triangle of known vertices")]
    NoVertices {
        /// The first such primitive.
        id: PrimitiveId,
    },
}

/// Queries whose answers are correct to the last bit (contract N8).
///
/// Coordinates are taken as real numbers. The primitive is the nearest one, and exact ties go to the lowest id. The
/// distance is the true one, rounded once to the nearest f64, and once more for scenes in f32. So its error is less
/// than one unit in the last place at any scale, even if the query is so near the surface that the usual error of 8 u M
/// exceeds the distance. The lower bound is at most the true distance, and at most one unit in the last place below the
/// reported one. The other fields of the answer equal those of [`ClosestPoint`](crate::ClosestPoint) for that
/// primitive.
///
/// ```
/// use nalgebra::Point3;
/// use p2m_core::{BruteForce, CertifiedQuery, ClosestPoint, Point, Segment, Shape};
///
/// // The distances of the point and the segment differ by less than the rounding error of the kernel.
/// let segment = Segment::new(Point3::new(-3.0, 0.0, 0.0), Point3::new(3.0, 2.0, 0.0));
/// let scene = [Shape::Segment(segment), Shape::Point(Point::new(Point3::new(-0.9_f64.sqrt(), 0.0, 0.0)))];
/// let index = BruteForce::new(&scene).unwrap();
/// let answer = index.certified_closest_point(&[0.0; 3], &Default::default()).unwrap().unwrap();
/// assert_eq!(answer.primitive.index(), 1);
/// assert!(answer.lower_bound <= answer.distance);
/// ```
///
/// # Complexity
/// It takes the search of [`ClosestPoint`](crate::ClosestPoint), and a few hundred nanoseconds for the candidates. It
/// takes a few microseconds if big integers have to decide: for exact ties of different features, queries on a surface,
/// and scales near the ends of the range of f64.
pub trait CertifiedQuery<T: Real>: NearQuery<T> {
    /// Returns a primitive of the scene as a shape, or `None` for a primitive of your own without vertices.
    fn shape(&self, id: PrimitiveId) -> Option<Shape<T>>;

    /// Returns the certified closest point. Of the options only the largest distance is used, which is compared without
    /// rounding.
    ///
    /// # Errors
    /// It returns [`CertifyError::NoVertices`] if a primitive that may be nearest has no vertices.
    fn certified_closest_point(
        &self,
        query: &dyn Position<T>,
        options: &QueryOptions<T>,
    ) -> Result<Option<Closest<T>>, CertifyError> {
        let mut near = Near::for_certification(options.max_distance);
        search_near_if_valid(self, query, &mut near);
        let found = near.certification_candidates();
        let hulls = found.iter().map(|one| {
            let shape = self.shape(one.id).ok_or(CertifyError::NoVertices { id: one.id })?;
            Ok(Hull::of(&shape))
        });
        let hulls: Vec<Hull> = hulls.collect::<Result<_, _>>()?;
        let candidates: Vec<_> = (found.iter().zip(&hulls))
            .map(|(one, hull)| Candidate { id: one.id, vertices: hull.vertices(), feature: one.projection.feature })
            .collect();
        if candidates.is_empty() {
            return Ok(None);
        }
        let query = to_f64_array(&query.point());
        let decision = decide(query, &candidates);
        let winner = &candidates[decision.winner];
        if options.max_distance < T::INFINITY && !is_within(query, winner.vertices, options.max_distance.to_f64()) {
            return Ok(None);
        }
        let one = &found[decision.winner];
        Ok(Some(Closest {
            distance: T::round_from_f64(decision.distance.nearest),
            lower_bound: T::round_down_from_f64(decision.distance.lower),
            ..crate::query::answer::answer(one.id, &one.projection, 0.0)
        }))
    }
}

/// Returns a primitive of a set as a shape, made of its vertices. It implements [`CertifiedQuery::shape`] for an index
/// over that set. It is `None` for a primitive without vertices.
pub fn shape_of<T: Real, S: PrimitiveSet<T> + ?Sized>(set: &S, id: PrimitiveId) -> Option<Shape<T>> {
    Shape::from_vertices(set.get(id).vertices())
}
