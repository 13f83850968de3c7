//! Brute force: every query evaluates every primitive. All other indexes are tested against it.

use crate::{
    Best, BuildError, BuildIndex, CertifiedQuery, ClosestPoint, Collector, Crossing, Hits, IndexStats, Near, NearQuery,
    Primitive, PrimitiveId, PrimitiveSet, Ray, RayCollector, RayQuery, Real, Shape, check_set, shape_of,
};
use nalgebra::Point3;
use std::ops::ControlFlow;

/// An index without a data structure, which evaluates every primitive. It is kept simple, so that it is evidently
/// correct.
///
/// # Complexity
/// Building takes O(n), since it checks the set. A query takes O(n). It needs no memory besides the set.
///
/// # Examples
/// ```
/// use nalgebra::Point3;
/// use p2m_core::{BruteForce, ClosestPoint, Segment};
///
/// let wires = [0.0, 3.0].map(|y| Segment::new(Point3::new(0.0, y, 0.0), Point3::new(9.0, y, 0.0)));
/// let index = BruteForce::new(&wires)?;
/// let answer = index.closest_point(&[4.0, 2.0, 0.0]).expect("two wires");
/// assert_eq!((answer.primitive.index(), answer.distance), (1, 1.0));
/// # Ok::<(), p2m_core::BuildError>(())
/// ```
#[derive(Clone, Debug)]
pub struct BruteForce<S> {
    set: S,
}

impl<S> BruteForce<S> {
    /// Checks a set and keeps it.
    ///
    /// # Errors
    /// It returns a [`BuildError`] for a coordinate that is not finite and for too many primitives.
    pub fn new<T: Real>(set: S) -> Result<Self, BuildError>
    where
        S: PrimitiveSet<T>,
    {
        check_set(&set)?;
        Ok(Self { set })
    }

    /// Returns the set over which the index was built.
    pub fn set(&self) -> &S {
        &self.set
    }

    /// Returns the set and drops the index.
    pub fn into_set(self) -> S {
        self.set
    }
}

impl<T: Real, S: PrimitiveSet<T>> ClosestPoint<T> for BruteForce<S> {
    fn search(&self, query: &Point3<T>, best: &mut Best<T>) {
        for id in (0..self.set.len()).map(PrimitiveId::new) {
            best.offer(id, self.set.get(id).project(query));
        }
    }
}

impl<T: Real, S: PrimitiveSet<T>> NearQuery<T> for BruteForce<S> {
    fn search_near(&self, query: &Point3<T>, near: &mut Near<'_>) {
        for id in (0..self.set.len()).map(PrimitiveId::new) {
            if near.is_done() {
                return;
            }
            near.offer(id, self.set.get(id).project(query));
        }
    }
}

impl<T: Real, S: PrimitiveSet<T>> RayQuery<T> for BruteForce<S> {
    fn search_ray<'r>(&self, ray: &'r Ray, hits: &mut Hits<'r>) {
        let only_crossings = hits.only_crossings();
        let _ = (0..self.set.len()).map(PrimitiveId::new).try_for_each(|id| {
            match Crossing::from_primitive(&self.set.get(id), ray, hits.limit(), only_crossings) {
                Some(crossing) => hits.offer(id, &crossing),
                None => ControlFlow::Continue(()),
            }
        });
    }

    fn visit_ray_candidates(&self, _: &Ray, visit: &mut dyn FnMut(PrimitiveId, &[[f64; 3]]) -> f64) {
        let mut ids = (0..self.set.len()).map(PrimitiveId::new);
        let _ = ids.find(|id| visit(*id, &[]) == f64::NEG_INFINITY);
    }
}

impl<T: Real, S: PrimitiveSet<T>> CertifiedQuery<T> for BruteForce<S> {
    fn shape(&self, id: PrimitiveId) -> Option<Shape<T>> {
        shape_of(&self.set, id)
    }
}

impl<T: Real, S: PrimitiveSet<T>> IndexStats<T> for BruteForce<S> {
    fn parts(&self) -> Vec<(&'static str, usize)> {
        Vec::new()
    }
}

impl<T: Real, S: PrimitiveSet<T>> BuildIndex<T, S> for BruteForce<S> {
    type Options = ();
    type Error = BuildError;

    fn build(set: S, _options: &()) -> Result<Self, BuildError> {
        Self::new(set)
    }
}
