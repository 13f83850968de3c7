//! Certified answers of any index.
//!
//! An index is asked for everything that may be nearest once the errors of the kernel are allowed for; mostly that is one
//! primitive, or those that share its nearest feature. [`decide`] tells which of them it is.

use super::{Candidate, decide, is_within};
use crate::near_query::{Near, search_near_if_valid};
use crate::real::to_f64_array;
use crate::{Closest, NearQuery, PrimitiveId, PrimitiveSet, QueryOptions, Real, Shape};
use nalgebra::Point3;

/// Why an answer cannot be certified.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CertifyError {
    /// A primitive of your own that may be nearest has no [`vertices`](crate::Primitive::vertices): only its code knows
    /// where it is.
    #[error("primitive {id} is no point, segment or triangle of known vertices")]
    NoVertices {
        /// The first such primitive.
        id: PrimitiveId,
    },
}

/// Answers that are right to the last bit (contract N8).
///
/// The primitive is nearest among the real sets of points that the coordinates describe, the lowest id of those that are
/// exactly equally near, and the distance is the true one: rounded once to the nearest f64, and for scenes in f32 once more,
/// so it is off by less than one unit in the last place, also for queries so near the surface that the usual error of 8 u M is
/// larger than the distance. Scales do not matter. The lower bound is not above the true distance and at most a unit below what is reported. Everything
/// else of the answer is as of [`ClosestPoint`](crate::ClosestPoint) for that primitive.
///
/// ```
/// use nalgebra::Point3;
/// use p2m_core::{BruteForce, CertifiedQuery, ClosestPoint, Point, Segment, Shape};
///
/// // A point beside a segment, as near as makes no difference to rounding.
/// let segment = Segment::new(Point3::new(-3.0, 0.0, 0.0), Point3::new(3.0, 2.0, 0.0));
/// let scene = [Shape::Segment(segment), Shape::Point(Point::new(Point3::new(-0.9_f64.sqrt(), 0.0, 0.0)))];
/// let index = BruteForce::new(&scene).unwrap();
/// let answer = index.certified_closest_point(&Point3::origin(), &Default::default()).unwrap().unwrap();
/// assert_eq!(answer.primitive.index(), 1);
/// assert!(answer.lower_bound <= answer.distance);
/// ```
///
/// # Complexity
/// The search of [`ClosestPoint`](crate::ClosestPoint), and for what may be nearest some hundred nanoseconds; some
/// microseconds where integers of any length have to decide: exact ties of different features, queries on a surface, scales near
/// the ends of the range.
pub trait CertifiedQuery<T: Real>: NearQuery<T> {
    /// A primitive of the scene; `None` for one of your own without vertices.
    fn shape(&self, id: PrimitiveId) -> Option<Shape<T>>;

    /// The closest point. Of the options the largest distance alone matters; it is compared without rounding.
    ///
    /// # Errors
    /// [`CertifyError::NoVertices`].
    fn certified_closest_point(
        &self,
        query: &Point3<T>,
        options: &QueryOptions<T>,
    ) -> Result<Option<Closest<T>>, CertifyError> {
        let mut near = Near::for_certification(options.max_distance);
        search_near_if_valid(self, query, &mut near);
        let found = near.certification_candidates();
        let shapes = found.iter().map(|one| {
            let shape = self.shape(one.id).ok_or(CertifyError::NoVertices { id: one.id })?;
            let mut vertices = [[0.0; 3]; 3];
            let own = shape.vertices();
            vertices.iter_mut().zip(own).for_each(|(to, vertex)| *to = to_f64_array(vertex));
            Ok((vertices, own.len()))
        });
        let shapes: Vec<_> = shapes.collect::<Result<_, _>>()?;
        let candidates: Vec<_> = (found.iter().zip(&shapes))
            .map(|(one, (vertices, count))| Candidate {
                id: one.id,
                vertices: &vertices[..*count],
                feature: one.projection.feature,
            })
            .collect();
        if candidates.is_empty() {
            return Ok(None);
        }
        let query = to_f64_array(query);
        let decision = decide(query, &candidates);
        let winner = &candidates[decision.winner];
        if options.max_distance < T::INFINITY && !is_within(query, winner.vertices, options.max_distance.to_f64()) {
            return Ok(None);
        }
        let one = &found[decision.winner];
        Ok(Some(Closest {
            distance: T::of_f64(decision.distance),
            lower_bound: T::of_f64_below(decision.lower),
            ..crate::query::answer::answer(one.id, &one.projection, 0.0)
        }))
    }
}

/// The shape that a primitive of a set is, by its vertices: what [`CertifiedQuery::shape`] has to say.
pub fn shape_of<T: Real, S: PrimitiveSet<T> + ?Sized>(set: &S, id: PrimitiveId) -> Option<Shape<T>> {
    use crate::{Point, Primitive, Segment, Triangle};
    let primitive = set.get(id);
    match *primitive.vertices() {
        [a] => Some(Point::new(a).into()),
        [a, b] => Some(Segment::new(a, b).into()),
        [a, b, c] => Some(Triangle::new(a, b, c).into()),
        _ => None,
    }
}
