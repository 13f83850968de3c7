//! Queries for near pairs of primitives: of a tree and a shape, and of two trees.

use crate::traverse::pairs::{ShapeSide, search_pairs};
use crate::{TreeIndex, Volume};
use nalgebra::Isometry3;
use p2m_core::engine::real::{from_f64_array, to_f64_array};
use p2m_core::engine::vector::{V3, dot, sub};
use p2m_core::pair::{
    ClosestPair, Motion, NearestPair, PairOptions, PairQuery, Pairs, bounds_of, hull_of, offer_hint_of_set, project,
};
use p2m_core::{Aabb, ClosestPoint, PrimitiveId, PrimitiveSet, Real};
use std::ops::ControlFlow;

/// Returns the id of a shape.
fn shape_id() -> PrimitiveId {
    PrimitiveId::new(0)
}

impl<T: Real, S: PrimitiveSet<T>, V: Volume> PairQuery<T> for TreeIndex<T, S, V> {
    fn search_hull(&self, hull: &[[f64; 3]], pairs: &mut Pairs<'_>) {
        if pairs.is_nearest() {
            let on_shape = |point| project(point, hull, f64::INFINITY).map(|p| (p.point.coords.into(), shape_id()));
            let guess = guess_pair(centre(&bounds_of(hull)), |point| self.closest_for_guess(point), on_shape);
            if let Some([primitive, _]) = guess {
                self.offer_hint(primitive, hull, pairs);
            }
        }
        V::as_pair_side(self.tree(), None, &mut |side| search_pairs(side, &ShapeSide(hull), pairs));
    }

    fn offer_hint(&self, primitive: PrimitiveId, hull: &[[f64; 3]], pairs: &mut Pairs<'_>) {
        offer_hint_of_set(self.set(), [primitive, shape_id()], hull, pairs);
    }
}

impl<T: Real, S: PrimitiveSet<T>, V: Volume> TreeIndex<T, S, V> {
    /// Returns the nearest points of this scene and another one, which the options may move; `None` if one is empty, if
    /// nothing is within the largest distance, or if the box of the moved scene is beyond the range of f64.
    ///
    /// ```
    /// use nalgebra::{Isometry3, Point3, Vector3};
    /// use p2m_bvh::AabbTree;
    /// use p2m_core::pair::PairOptions;
    /// use p2m_core::{BuildIndex, Triangle};
    ///
    /// let triangle = [Triangle::new(Point3::origin(), Point3::new(1.0, 0.0, 0.0), Point3::new(0.0, 1.0, 0.0))];
    /// let scene = AabbTree::build(&triangle, &Default::default())?;
    /// let raised = PairOptions::default().with_motion(Isometry3::translation(0.0, 0.0, 2.0));
    /// let nearest = scene.closest_pair(&scene, &raised).expect("both have a triangle");
    /// assert_eq!((nearest.distance, nearest.is_intersecting), (2.0, false));
    /// // The next search begins with this pair.
    /// let turned = Isometry3::new(Vector3::new(0.0, 0.0, 0.5), Vector3::y());
    /// let next = scene.closest_pair(&scene, &raised.with_motion(turned).with_hint(nearest.primitives));
    /// assert!(next.is_some_and(|pair| pair.is_intersecting));
    /// # Ok::<(), p2m_core::BuildError>(())
    /// ```
    ///
    /// # Panics
    /// Panics if there are primitives without [vertices](p2m_core::Primitive::vertices), as primitives of your own may.
    ///
    /// # Accuracy
    /// The answer is that of all pairs of primitives, bit for bit, where vertices of the other scene are moved and
    /// rounded first ([`Motion`]). The error of a distance is at most
    /// [`ERROR_CONSTANT_OF_PAIRS`](p2m_core::pair::ERROR_CONSTANT_OF_PAIRS) u M + 4 eta, and 32 u (|v| + |t|) for
    /// the rounding of moved vertices.
    ///
    /// # Complexity
    /// It takes expected O(log n) steps for scenes that are apart, and O(n) where they are about equally near in many
    /// places.
    pub fn closest_pair<R: PrimitiveSet<T>, U: Volume>(
        &self,
        other: &TreeIndex<T, R, U>,
        options: &PairOptions<T>,
    ) -> Option<ClosestPair<T>> {
        let mut pairs = Pairs::nearest(options.max_distance);
        self.search_pairs(other, options.motion.as_ref(), options.hint, &mut pairs);
        pairs.finish()
    }

    /// Returns whether a primitive of this scene and one of another are within the largest distance. The search ends at
    /// the first pair. With a largest distance of 0 it tests whether scenes in f64 intersect, which is exact.
    ///
    /// # Panics
    /// Panics if there are primitives without vertices.
    pub fn is_any_pair_near<R: PrimitiveSet<T>, U: Volume>(
        &self,
        other: &TreeIndex<T, R, U>,
        options: &PairOptions<T>,
    ) -> bool {
        let mut end = |_: [PrimitiveId; 2], _: &NearestPair| ControlFlow::Break(());
        let mut pairs = Pairs::each(options.max_distance, &mut end);
        self.search_pairs(other, options.motion.as_ref(), options.hint, &mut pairs);
        pairs.has_ended()
    }

    /// Calls a function for each pair of primitives within the largest distance of the options, until it breaks, and
    /// returns whether it did. The order is that of the search. The hint is not used.
    ///
    /// # Panics
    /// Panics if there are primitives without vertices.
    pub fn visit_pairs_within<R: PrimitiveSet<T>, U: Volume>(
        &self,
        other: &TreeIndex<T, R, U>,
        options: &PairOptions<T>,
        visit: &mut dyn FnMut(&ClosestPair<T>) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let mut each = |ids: [PrimitiveId; 2], pair: &_| {
            let mut alone = Pairs::nearest(options.max_distance);
            alone.offer(ids, pair);
            alone.finish().map_or(ControlFlow::Continue(()), |pair| visit(&pair))
        };
        let mut pairs = Pairs::each(options.max_distance, &mut each);
        self.search_pairs(other, options.motion.as_ref(), None, &mut pairs);
        if pairs.has_ended() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    /// Offers the pairs of two scenes that may be near.
    fn search_pairs<R: PrimitiveSet<T>, U: Volume>(
        &self,
        other: &TreeIndex<T, R, U>,
        motion: Option<&Isometry3<f64>>,
        hint: Option<[PrimitiveId; 2]>,
        pairs: &mut Pairs<'_>,
    ) {
        let motion = motion.map(Motion::new);
        let bounds = other.tree().bounds();
        let moved = motion.map_or(*bounds, |motion| motion.apply_to_box(bounds));
        if pairs.is_done() || !moved.is_finite() {
            return;
        }
        let guess = pairs.is_nearest().then(|| {
            let apply = |point: V3| motion.map_or(point, |motion| motion.apply(point));
            let undo = |point: V3| motion.map_or(point, |motion| motion.turn_back(sub(point, motion.translation())));
            let on_second = |point| other.closest_for_guess(undo(point)).map(|(point, id)| (apply(point), id));
            guess_pair(centre(&moved), |point| self.closest_for_guess(point), on_second)
        });
        for [i, j] in hint.into_iter().chain(guess.flatten()) {
            if j.index() < other.set().len() {
                let (hull, len) = hull_of(&other.set().get(j), motion.as_ref());
                offer_hint_of_set(self.set(), [i, j], &hull[..len], pairs);
            }
        }
        V::as_pair_side(self.tree(), None, &mut |a| {
            U::as_pair_side(other.tree(), motion, &mut |b| search_pairs(a, b, pairs));
        });
    }

    /// Returns the closest point of the scene and its primitive, for a guess: the query is rounded.
    fn closest_for_guess(&self, point: V3) -> Option<(V3, PrimitiveId)> {
        let closest = self.closest_point(&from_f64_array(point))?;
        Some((to_f64_array(&closest.point), closest.primitive))
    }
}

/// The largest number of turns of a guess.
const MAX_TURNS: usize = 32;
/// A turn is worthwhile if it makes the distance smaller by this factor.
const WORTHWHILE: f64 = 0.999;

/// Returns a pair that is probably near: the closest point of each scene to that of the other, in turns, beginning with
/// the closest point of the first one to `point`. The distance falls with each turn, to a local minimum. With a good
/// pair, a search cuts few nodes.
fn guess_pair(
    mut point: V3,
    on_first: impl Fn(V3) -> Option<(V3, PrimitiveId)>,
    on_second: impl Fn(V3) -> Option<(V3, PrimitiveId)>,
) -> Option<[PrimitiveId; 2]> {
    let mut best = f64::INFINITY;
    let mut pair = None;
    for _ in 0..MAX_TURNS {
        let (on_a, a) = on_first(point)?;
        let (on_b, b) = on_second(on_a)?;
        point = on_b;
        let offset = sub(on_b, on_a);
        let square = dot(offset, offset);
        // The comparison is false for what is not a number.
        if square < best {
            pair = Some([a, b]);
        }
        if !(square < best * WORTHWHILE) {
            break;
        }
        best = square;
    }
    pair
}

fn centre(bounds: &Aabb<f64>) -> V3 {
    nalgebra::center(&bounds.min, &bounds.max).coords.into()
}
