//! Queries for the nearest primitives of two scenes, or of a scene and a shape.

use super::search::{PairSide, ShapeSide, search_pairs};
use super::{ClosestPair, Hull, Motion, NearestPair, PairOptions, Pairs, bounds_of, nearest_of_hulls, project};
use crate::certified::{PairCandidate, decide_pairs};
use crate::kernel::vector::{V3, dot, sub};
use crate::real::{from_f64_array, to_f64_array};
use crate::{Aabb, ClosestPoint, Primitive, PrimitiveId, PrimitiveSet, Real};
use std::ops::ControlFlow;

/// Queries for the primitives of a scene that are nearest to a shape or to another scene.
///
/// A shape is a point, a segment or a triangle, with or without a radius: a segment with a radius is a capsule
/// ([`PairOptions::radius`]). The motion of the options moves the shape or the other scene.
///
/// ```
/// use nalgebra::{Isometry3, Point3};
/// use p2m_core::pair::{PairOptions, PairQuery};
/// use p2m_core::{BruteForce, Segment, Triangle};
///
/// let floor = [Triangle::new(Point3::new(0.0, 0.0, 0.0), Point3::new(9.0, 0.0, 0.0), Point3::new(0.0, 9.0, 0.0))];
/// let scene = BruteForce::new(&floor)?;
/// // A capsule of radius 0.5 above the floor.
/// let axis = Segment::new(Point3::new(1.0, 1.0, 2.0), Point3::new(1.0, 3.0, 1.0));
/// let capsule = PairOptions::default().with_radius(0.5);
/// let nearest = scene.closest_to(&axis, &capsule).expect("the scene is not empty");
/// assert_eq!(nearest.distance, 0.5);
/// assert_eq!(nearest.points, [Point3::new(1.0, 3.0, 0.0), Point3::new(1.0, 3.0, 0.5)]);
/// assert!(!scene.is_any_near(&axis, &capsule.with_max_distance(0.25)));
///
/// // The scene and its copy, moved up by 2.
/// let raised = PairOptions::default().with_motion(Isometry3::translation(0.0, 0.0, 2.0));
/// let nearest = scene.closest_pair(&scene, &raised).expect("both have a triangle");
/// assert_eq!((nearest.distance, nearest.is_intersecting), (2.0, false));
/// # Ok::<(), p2m_core::BuildError>(())
/// ```
///
/// A pointer to an index is an index, so call a trait object through a reference to the pointer: if `index` is a `&dyn
/// PairQuery<T>`, then `(&index).closest_to(..)`.
///
/// # Accuracy
/// The answers of all indexes equal the answer over all pairs of primitives, bit for bit, where moved vertices are
/// rounded first ([`Motion`]); only lower bounds depend on the index. The error of a distance is at most
/// [`ERROR_CONSTANT_OF_PAIRS`](super::ERROR_CONSTANT_OF_PAIRS) u M + 4 eta, and 32 u (|v| + |t|) more for moved
/// vertices v and a translation t.
///
/// # Panics
/// All methods panic if there are primitives without [vertices](Primitive::vertices), as may be the case for types of
/// your own.
///
/// # Complexity
/// Trees take expected O(log n) steps for scenes that are apart, and O(n) if the scenes are about equally near in many
/// places. Brute force evaluates all pairs. So do trees if distances exceed 2^400, and certified queries if a motion
/// moves a scene so far away that rounding makes all pairs equally near.
#[diagnostic::on_unimplemented(
    message = "`{Self}` answers no queries for pairs with coordinates of type `{T}`",
    note = "`AabbTree`, `KdopTree` and `BruteForce` do; the octree and the P2M index answer closest-point queries only"
)]
pub trait PairQuery<T: Real> {
    /// Returns the number of primitives.
    fn primitive_count(&self) -> usize;

    /// Returns the vertices of a primitive in f64.
    fn hull(&self, id: PrimitiveId) -> Hull;

    /// Returns a box around the scene. The default bounds the vertices of all primitives.
    #[doc(hidden)]
    fn pair_bounds(&self) -> Aabb<f64> {
        let ids = (0..self.primitive_count()).map(PrimitiveId::new);
        ids.fold(Aabb::empty(), |all, id| all.union(&bounds_of(self.hull(id).vertices())))
    }

    /// Calls `search` with each tree of the index and the motions that are applied to it, in their order, and returns
    /// `true`. The default, for an index that is not made of trees, returns `false`.
    ///
    /// `search` gets a tree and the offset of the ids of its primitives. It returns the distance from the box `near`
    /// beyond which no other tree is needed. The nearest trees come first.
    #[doc(hidden)]
    fn visit_pair_sides(
        &self,
        motions: &[Motion],
        near: &Aabb<f64>,
        search: &mut dyn FnMut(&dyn PairSide, usize) -> f64,
    ) -> bool {
        let _ = (motions, near, search);
        false
    }

    /// Returns a point of the scene that is probably close to `point`, and its primitive. A search starts from it, so
    /// it may be any point. The default returns none.
    #[doc(hidden)]
    fn guess_closest(&self, point: V3) -> Option<(V3, PrimitiveId)> {
        let _ = point;
        None
    }

    /// Returns whether a search should go on. Searches call it on the first index before each step. The default is
    /// `true`; [`Interruptible`](crate::batch::Interruptible) ends searches early.
    #[doc(hidden)]
    fn goes_on(&self) -> bool {
        true
    }

    /// Returns the nearest points of the scene and a shape. It is `None` if nothing is within the largest distance, and
    /// for a shape whose coordinates are not finite, before or after its motion.
    fn closest_to<P: Primitive<T>>(&self, shape: &P, options: &PairOptions<T>) -> Option<ClosestPair<T>>
    where
        Self: Sized,
    {
        let mut pairs = Pairs::nearest(options);
        search_shape(self, shape, options, &mut pairs);
        pairs.finish()
    }

    /// Returns whether a primitive is within the largest distance of a shape. The search ends at the first such
    /// primitive.
    fn is_any_near<P: Primitive<T>>(&self, shape: &P, options: &PairOptions<T>) -> bool
    where
        Self: Sized,
    {
        let mut end = |_, _: &_| ControlFlow::Break(());
        let mut pairs = Pairs::each(options, &mut end);
        search_shape(self, shape, options, &mut pairs);
        pairs.has_ended()
    }

    /// Returns the primitive of the scene that is certainly nearest to a shape, in real arithmetic. Exact ties go to
    /// the lowest id. The distance is the true one, rounded once to the nearest f64, and once more for scenes in f32.
    /// Of the options the radius and the hint are not used, and the largest distance is compared without rounding.
    ///
    /// # Complexity
    /// It takes the search of [`closest_to`](Self::closest_to), and about ten microseconds per pair that rounding does
    /// not distinguish.
    fn certified_closest_to<P: Primitive<T>>(&self, shape: &P, options: &PairOptions<T>) -> Option<ClosestPair<T>>
    where
        Self: Sized,
    {
        let motion = options.motion.as_ref().map(Motion::new);
        let of_shape = moved(Hull::of(shape), motion.as_ref());
        let hulls = |[id, _]: [PrimitiveId; 2]| [self.hull(id), of_shape];
        certify(options, |pairs| search_shape(self, shape, options, pairs), hulls, &|| self.goes_on())
    }

    /// Calls a function for each primitive within the largest distance of a shape, until the function breaks, and
    /// returns whether it did. The order is the order of the search.
    fn visit_near<P: Primitive<T>>(
        &self,
        shape: &P,
        options: &PairOptions<T>,
        visit: &mut dyn FnMut(&ClosestPair<T>) -> ControlFlow<()>,
    ) -> ControlFlow<()>
    where
        Self: Sized,
    {
        visit_each(options, visit, &mut |pairs| search_shape(self, shape, options, pairs))
    }

    /// Returns the nearest points of this scene and another one. It is `None` if a scene is empty, if nothing is within
    /// the largest distance, or if the box of the moved scene is beyond the range of f64.
    fn closest_pair<Q: PairQuery<T> + ?Sized>(&self, other: &Q, options: &PairOptions<T>) -> Option<ClosestPair<T>>
    where
        Self: Sized,
    {
        let mut pairs = Pairs::nearest(options);
        search_scenes(self, other, options, &mut pairs);
        pairs.finish()
    }

    /// Returns the certainly nearest pair of primitives of this scene and another one, in real arithmetic, as
    /// [`certified_closest_to`](Self::certified_closest_to) does for a shape. A motion moves and rounds the vertices
    /// first.
    fn certified_closest_pair<Q: PairQuery<T> + ?Sized>(
        &self,
        other: &Q,
        options: &PairOptions<T>,
    ) -> Option<ClosestPair<T>>
    where
        Self: Sized,
    {
        let motion = options.motion.as_ref().map(Motion::new);
        let hulls = |[i, j]: [PrimitiveId; 2]| [self.hull(i), moved(other.hull(j), motion.as_ref())];
        certify(options, |pairs| search_scenes(self, other, options, pairs), hulls, &|| self.goes_on())
    }

    /// Returns whether a primitive of this scene and a primitive of another are within the largest distance of each
    /// other. The search ends at the first such pair. With a largest distance of 0 it tests whether the scenes
    /// intersect, which is exact.
    fn is_any_pair_near<Q: PairQuery<T> + ?Sized>(&self, other: &Q, options: &PairOptions<T>) -> bool
    where
        Self: Sized,
    {
        let mut end = |_: [PrimitiveId; 2], _: &NearestPair| ControlFlow::Break(());
        let mut pairs = Pairs::each(options, &mut end);
        search_scenes(self, other, options, &mut pairs);
        pairs.has_ended()
    }

    /// Calls a function for each pair of primitives within the largest distance of the options, until the function
    /// breaks, and returns whether it did. The order is the order of the search.
    fn visit_pairs_within<Q: PairQuery<T> + ?Sized>(
        &self,
        other: &Q,
        options: &PairOptions<T>,
        visit: &mut dyn FnMut(&ClosestPair<T>) -> ControlFlow<()>,
    ) -> ControlFlow<()>
    where
        Self: Sized,
    {
        visit_each(options, visit, &mut |pairs| search_scenes(self, other, options, pairs))
    }
}

/// Returns the certified nearest pair among the candidates that a search leaves. `hulls` returns the vertices of a
/// pair.
fn certify<T: Real>(
    options: &PairOptions<T>,
    search: impl FnOnce(&mut Pairs<'_>),
    hulls: impl Fn([PrimitiveId; 2]) -> [Hull; 2],
    goes_on: &dyn Fn() -> bool,
) -> Option<ClosestPair<T>> {
    let mut pairs = Pairs::for_certification(options);
    search(&mut pairs);
    let candidate = |(ids, pair)| PairCandidate { ids, hulls: hulls(ids), pair };
    let candidates: Vec<_> = pairs.certification_candidates().into_iter().map(candidate).collect();
    let (winner, distance) = decide_pairs(&candidates, options.max_distance, goes_on)?;
    let winner = &candidates[winner];
    let mut alone = Pairs::nearest(&PairOptions::<T>::default());
    alone.offer(winner.ids, &winner.pair);
    let (lower_bound, distance) = (T::round_down_from_f64(distance.lower), T::round_from_f64(distance.nearest));
    alone.finish().map(|pair| ClosestPair { distance, lower_bound, ..pair })
}

/// Calls `visit` for each pair that `search` offers.
fn visit_each<T: Real>(
    options: &PairOptions<T>,
    visit: &mut dyn FnMut(&ClosestPair<T>) -> ControlFlow<()>,
    search: &mut dyn FnMut(&mut Pairs<'_>),
) -> ControlFlow<()> {
    let mut each = |ids: [PrimitiveId; 2], pair: &_| {
        let mut alone = Pairs::nearest(options);
        alone.offer(ids, pair);
        alone.finish().map_or(ControlFlow::Continue(()), |pair| visit(&pair))
    };
    let mut pairs = Pairs::each(options, &mut each);
    search(&mut pairs);
    if pairs.has_ended() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}

/// Offers the pairs of a scene and a shape that may be near. The id of the shape is 0.
fn search_shape<T: Real>(
    index: &(impl PairQuery<T> + ?Sized),
    shape: &impl Primitive<T>,
    options: &PairOptions<T>,
    pairs: &mut Pairs<'_>,
) {
    let motion = options.motion.as_ref().map(Motion::new);
    search_hull(index, moved(Hull::of(shape), motion.as_ref()).vertices(), options.hint, pairs);
}

/// Offers the pairs of a scene and a hull of one to three vertices that may be near. There are none if a coordinate is
/// not finite.
pub(super) fn search_hull<T: Real>(
    index: &(impl PairQuery<T> + ?Sized),
    hull: &[V3],
    hint: Option<[PrimitiveId; 2]>,
    pairs: &mut Pairs<'_>,
) {
    if pairs.is_done() || !hull.as_flattened().iter().all(|x| x.is_finite()) {
        return;
    }
    let shape_id = PrimitiveId::new(0);
    let on_shape = |point| project(point, hull, f64::INFINITY).map(|p| (p.point.coords.into(), shape_id));
    let guess = || guess_pair(centre(&bounds_of(hull)), &|point| index.guess_closest(point), &on_shape);
    offer_hints(index, hint, guess, pairs, &mut |id| (id == shape_id).then(|| Hull::new(hull)));
    let is_tree = index.visit_pair_sides(&[], &bounds_of(hull), &mut |side, offset| {
        pairs.set_offsets([offset, 0]);
        search_pairs(side, &ShapeSide(hull), &|| index.goes_on(), pairs);
        pairs.reach()
    });
    pairs.set_offsets([0, 0]);
    if !is_tree {
        for id in (0..index.primitive_count()).map(PrimitiveId::new) {
            if pairs.is_done() || !index.goes_on() {
                return;
            }
            offer_of_index(index, [id, shape_id], hull, pairs);
        }
    }
}

/// Offers the pairs of two scenes that may be near.
fn search_scenes<T: Real>(
    first: &(impl PairQuery<T> + ?Sized),
    second: &(impl PairQuery<T> + ?Sized),
    options: &PairOptions<T>,
    pairs: &mut Pairs<'_>,
) {
    if pairs.is_done() {
        return;
    }
    let motion = options.motion.as_ref().map(Motion::new);
    let moved_hull = |id: PrimitiveId| moved(second.hull(id), motion.as_ref());
    let bounds = second.pair_bounds();
    let bounds = motion.map_or(bounds, |motion| motion.apply_to_box(&bounds));
    if !bounds.is_finite() {
        return;
    }
    let apply = |point: V3| motion.map_or(point, |motion| motion.apply(point));
    let undo = |point: V3| motion.map_or(point, |motion| motion.apply_inverse(point));
    let on_second = |point| second.guess_closest(undo(point)).map(|(point, id)| (apply(point), id));
    let guess = || guess_pair(centre(&bounds), &|point| first.guess_closest(point), &on_second);
    offer_hints(first, options.hint, guess, pairs, &mut |id| {
        (id.index() < second.primitive_count()).then(|| moved_hull(id))
    });
    // Both are trees unless a call returns `false`, which it does before it searches anything.
    let mut is_second_tree = true;
    let is_first_tree = first.visit_pair_sides(&[], &bounds, &mut |a, offset_a| {
        is_second_tree = second.visit_pair_sides(motion.as_slice(), &a.bounds(), &mut |b, offset_b| {
            pairs.set_offsets([offset_a, offset_b]);
            search_pairs(a, b, &|| first.goes_on(), pairs);
            pairs.reach()
        });
        if is_second_tree { pairs.reach() } else { f64::NAN }
    });
    pairs.set_offsets([0, 0]);
    if is_first_tree && is_second_tree {
        return;
    }
    for j in (0..second.primitive_count()).map(PrimitiveId::new) {
        let hull = moved_hull(j);
        for i in (0..first.primitive_count()).map(PrimitiveId::new) {
            if pairs.is_done() || !first.goes_on() {
                return;
            }
            offer_of_index(first, [i, j], hull.vertices(), pairs);
        }
    }
}

/// Returns a hull after a motion.
fn moved(hull: Hull, motion: Option<&Motion>) -> Hull {
    motion.map_or(hull, |motion| hull.map(|vertex| motion.apply(vertex)))
}

/// Offers the user's hint and a guess, if the search is for the nearest pair. Ids that a scene does not have are
/// ignored.
fn offer_hints<T: Real>(
    first: &(impl PairQuery<T> + ?Sized),
    hint: Option<[PrimitiveId; 2]>,
    guess: impl FnOnce() -> Option<[PrimitiveId; 2]>,
    pairs: &mut Pairs<'_>,
    hull_of_second: &mut dyn FnMut(PrimitiveId) -> Option<Hull>,
) {
    if !pairs.is_nearest() {
        return;
    }
    // A guess takes a few closest-point queries. A good hint is better than a guess, and a bad one costs little.
    for [i, j] in hint.into_iter().chain(guess()) {
        if let Some(hull) = hull_of_second(j)
            && i.index() < first.primitive_count()
        {
            offer_of_index(first, [i, j], hull.vertices(), pairs);
        }
    }
}

/// Offers the pair of a primitive of an index and a hull, which is the primitive with the id `other`.
fn offer_of_index<T: Real>(
    index: &(impl PairQuery<T> + ?Sized),
    [id, other]: [PrimitiveId; 2],
    hull: &[V3],
    pairs: &mut Pairs<'_>,
) {
    pairs.offer_result([id, other], nearest_of_hulls(index.hull(id).vertices(), hull, pairs.kernel_limit()));
}

/// The most alternations of a guess. There is no record of how it was tuned.
const MAX_TURNS: usize = 32;
/// The factor by which an alternation has to reduce the squared distance to be worth another one. There is no record of
/// how it was tuned.
const WORTHWHILE: f64 = 0.999;

/// Returns a pair that is probably near, for the search to start from (decision 054).
///
/// The basic idea is alternating projection: project a point onto the first scene, the result onto the second scene,
/// that result onto the first scene again, and so on. The distance falls with each step, to a local minimum, after a
/// few closest-point queries. With a good pair at hand, the search prunes most nodes at once. `point` is the first
/// point to project.
fn guess_pair(
    mut point: V3,
    on_first: &dyn Fn(V3) -> Option<(V3, PrimitiveId)>,
    on_second: &dyn Fn(V3) -> Option<(V3, PrimitiveId)>,
) -> Option<[PrimitiveId; 2]> {
    let mut best = f64::INFINITY;
    let mut pair = None;
    for _ in 0..MAX_TURNS {
        let (on_a, a) = on_first(point)?;
        let (on_b, b) = on_second(on_a)?;
        point = on_b;
        let offset = sub(on_b, on_a);
        let square = dot(offset, offset);
        // The comparison is false for NaN.
        if square < best {
            pair = Some([a, b]);
        }
        let is_worthwhile = square < best * WORTHWHILE;
        if !is_worthwhile {
            break;
        }
        best = square;
    }
    pair
}

fn centre(bounds: &Aabb<f64>) -> V3 {
    nalgebra::center(&bounds.min, &bounds.max).coords.into()
}

/// The usual implementation of [`PairQuery::guess_closest`]: a closest-point query, rounded to the scalar type of the
/// index.
#[doc(hidden)]
pub fn closest_as_guess<T: Real>(
    index: &(impl ClosestPoint<T> + ?Sized),
    point: [f64; 3],
) -> Option<(V3, PrimitiveId)> {
    let closest = index.closest_point(&from_f64_array(point))?;
    Some((to_f64_array(&closest.point), closest.primitive))
}

impl<T: Real, S: PrimitiveSet<T>> PairQuery<T> for crate::BruteForce<S> {
    fn primitive_count(&self) -> usize {
        self.set().len()
    }

    fn hull(&self, id: PrimitiveId) -> Hull {
        Hull::of(&self.set().get(id))
    }
}
