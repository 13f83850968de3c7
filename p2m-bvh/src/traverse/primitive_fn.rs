//! Functions through which searches access the primitives of a set.
//!
//! They are not type parameters of the searches, so that searches do not depend on the set and are compiled once.

use nalgebra::Point3;
use p2m_core::{Collector, Crossing, Primitive, PrimitiveId, PrimitiveSet, Ray, Real};

/// A function that offers a primitive to the collector, unless its key exceeds a square. It is called for primitives
/// without stored vertices.
pub type EvaluateFn<'a, C> = &'a dyn Fn(&mut C, PrimitiveId, f64);

/// A function that returns the crossing of a ray with a primitive, unless its parameter exceeds a limit. It is called
/// for primitives without stored vertices.
pub type IntersectFn<'a, 'r> = &'a dyn Fn(PrimitiveId, f64) -> Option<Crossing<'r>>;

/// Returns the [`EvaluateFn`] of a set.
pub fn evaluation<T: Real, S: PrimitiveSet<T> + ?Sized, C: Collector>(
    set: &S,
    query: &Point3<T>,
) -> impl Fn(&mut C, PrimitiveId, f64) {
    move |collector, id, square| {
        if let Some(projection) = set.get(id).project_within(query, square) {
            collector.offer(id, projection);
        }
    }
}

/// Returns the [`IntersectFn`] of a set.
pub(crate) fn intersection<'r, T: Real, S: PrimitiveSet<T> + ?Sized>(
    set: &S,
    ray: &'r Ray,
    only_crossings: bool,
) -> impl Fn(PrimitiveId, f64) -> Option<Crossing<'r>> {
    move |id, limit| Crossing::from_primitive(&set.get(id), ray, limit, only_crossings)
}
