//! Queries for the primitives nearest to a shape.

use super::{ClosestPair, Motion, PairOptions, Pairs, nearest_of_hulls};
use crate::kernel::vector::V3;
use crate::real::to_f64_array;
use crate::{Primitive, PrimitiveId, PrimitiveSet, Real};
use std::ops::ControlFlow;

/// Queries for the primitives of a scene that are nearest to a shape: a point, a segment or a triangle.
///
/// A shape with a radius, such as a capsule or a thick plate, is its axis or face: subtract the radius from the distance,
/// or ask for what is within the radius.
///
/// ```
/// use nalgebra::Point3;
/// use p2m_core::pair::{PairOptions, PairQuery};
/// use p2m_core::{BruteForce, Segment, Triangle};
///
/// let floor = [Triangle::new(Point3::new(0.0, 0.0, 0.0), Point3::new(9.0, 0.0, 0.0), Point3::new(0.0, 9.0, 0.0))];
/// let scene = BruteForce::new(&floor)?;
/// // A capsule of radius 0.5 above the floor.
/// let axis = Segment::new(Point3::new(1.0, 1.0, 2.0), Point3::new(1.0, 3.0, 1.0));
/// let nearest = scene.closest_to(&axis, &PairOptions::default()).expect("the scene is not empty");
/// assert_eq!(nearest.distance - 0.5, 0.5);
/// assert_eq!(nearest.points, [Point3::new(1.0, 3.0, 0.0), Point3::new(1.0, 3.0, 1.0)]);
/// assert!(!scene.is_any_near(&axis, &PairOptions::default().with_max_distance(0.5)));
/// # Ok::<(), p2m_core::BuildError>(())
/// ```
///
/// The motion of the options moves the shape.
pub trait PairQuery<T: Real> {
    /// Offers every pair of a primitive of the scene and the hull of one to three vertices that may be near. The id of
    /// the hull is 0.
    ///
    /// # Panics
    /// Panics if the scene has primitives without vertices.
    fn search_hull(&self, hull: &[[f64; 3]], pairs: &mut Pairs<'_>);

    /// Offers the pair of one primitive and the hull, if the scene has the primitive.
    fn offer_hint(&self, primitive: PrimitiveId, hull: &[[f64; 3]], pairs: &mut Pairs<'_>);

    /// Returns the nearest points of the scene and the shape; `None` if nothing is within the largest distance, and for
    /// a shape whose coordinates are not finite, before or after its motion.
    ///
    /// # Panics
    /// Panics if the scene or the shape has primitives without vertices.
    ///
    /// # Accuracy
    /// The error of the distance is at most [`ERROR_CONSTANT_OF_PAIRS`](super::ERROR_CONSTANT_OF_PAIRS) u M + 4 eta,
    /// and indexes agree bit for bit.
    fn closest_to<P: Primitive<T>>(&self, shape: &P, options: &PairOptions<T>) -> Option<ClosestPair<T>>
    where
        Self: Sized,
    {
        let mut pairs = Pairs::nearest(options.max_distance);
        search(self, shape, options, &mut pairs);
        pairs.finish()
    }

    /// Returns whether a primitive is within the largest distance of the shape. The search ends at the first one.
    ///
    /// # Panics
    /// Panics if the scene or the shape has primitives without vertices.
    fn is_any_near<P: Primitive<T>>(&self, shape: &P, options: &PairOptions<T>) -> bool
    where
        Self: Sized,
    {
        let mut end = |_, _: &_| ControlFlow::Break(());
        let mut pairs = Pairs::each(options.max_distance, &mut end);
        search(self, shape, options, &mut pairs);
        pairs.has_ended()
    }
}

fn search<T: Real>(
    index: &impl PairQuery<T>,
    shape: &impl Primitive<T>,
    options: &PairOptions<T>,
    pairs: &mut Pairs<'_>,
) {
    let motion = options.motion.as_ref().map(Motion::new);
    let (vertices, len) = hull_of(shape, motion.as_ref());
    let hull = &vertices[..len];
    if pairs.is_done() || !hull.as_flattened().iter().all(|x| x.is_finite()) {
        return;
    }
    if let Some([primitive, _]) = options.hint {
        index.offer_hint(primitive, hull, pairs);
    }
    index.search_hull(hull, pairs);
}

/// Returns the vertices of a primitive in f64 and after a motion, and their number.
///
/// # Panics
/// Panics if there are none.
#[doc(hidden)]
pub fn hull_of<T: Real>(primitive: &impl Primitive<T>, motion: Option<&Motion>) -> ([V3; 3], usize) {
    let vertices = primitive.vertices();
    assert!(!vertices.is_empty(), "distances between primitives are defined for those that have vertices");
    let mut hull = [[0.0; 3]; 3];
    for (to, vertex) in hull.iter_mut().zip(vertices) {
        let vertex = to_f64_array(vertex);
        *to = motion.map_or(vertex, |motion| motion.apply(vertex));
    }
    (hull, vertices.len())
}

/// Offers the pair of a primitive of a set and the hull of the primitive with the id `other`.
pub(crate) fn offer_of_set<T: Real, S: PrimitiveSet<T> + ?Sized>(
    set: &S,
    [id, other]: [PrimitiveId; 2],
    hull: &[V3],
    pairs: &mut Pairs<'_>,
) {
    let (vertices, len) = hull_of(&set.get(id), None);
    pairs.offer_result([id, other], nearest_of_hulls(&vertices[..len], hull, pairs.prune_above()));
}

/// Offers the pair of a primitive of a set and the hull of the primitive with the id `other`, if the set has the
/// primitive.
#[doc(hidden)]
pub fn offer_hint_of_set<T: Real, S: PrimitiveSet<T> + ?Sized>(
    set: &S,
    ids: [PrimitiveId; 2],
    hull: &[V3],
    pairs: &mut Pairs<'_>,
) {
    if ids[0].index() < set.len() {
        offer_of_set(set, ids, hull, pairs);
    }
}

/// Offers all pairs of two sets, of which the second is moved. All searches of trees are tested against it. What the
/// motion moves beyond the range of f64 is left out.
///
/// # Panics
/// Panics if there are primitives without vertices.
///
/// # Complexity
/// It takes the product of the numbers of primitives.
pub fn offer_all_pairs<T: Real>(
    a: &(impl PrimitiveSet<T> + ?Sized),
    b: &(impl PrimitiveSet<T> + ?Sized),
    motion: Option<&Motion>,
    pairs: &mut Pairs<'_>,
) {
    for j in (0..b.len()).map(PrimitiveId::new) {
        let (hull, len) = hull_of(&b.get(j), motion);
        if !hull.as_flattened().iter().all(|x| x.is_finite()) {
            continue;
        }
        for i in (0..a.len()).map(PrimitiveId::new) {
            if pairs.is_done() {
                return;
            }
            offer_of_set(a, [i, j], &hull[..len], pairs);
        }
    }
}
