//! Queries for near pairs of primitives: of a tree and a shape, and of two trees.

use crate::traverse::pairs::{MovedSide, ShapeSide, TreeSide, search_pairs};
use crate::{TreeIndex, Volume};
use nalgebra::Isometry3;
use p2m_core::pair::{ClosestPair, Motion, NearestPair, PairOptions, PairQuery, Pairs, hull_of, offer_hint_of_set};
use p2m_core::{PrimitiveId, PrimitiveSet, Real};
use std::ops::ControlFlow;

impl<T: Real, S: PrimitiveSet<T>, V: Volume> PairQuery<T> for TreeIndex<T, S, V> {
    fn search_hull(&self, hull: &[[f64; 3]], pairs: &mut Pairs<'_>) {
        search_pairs(&TreeSide(self.tree()), &ShapeSide(hull), pairs);
    }

    fn offer_hint(&self, primitive: PrimitiveId, hull: &[[f64; 3]], pairs: &mut Pairs<'_>) {
        offer_hint_of_set(self.set(), [primitive, PrimitiveId::new(0)], hull, pairs);
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
        if let Some([i, j]) = hint
            && j.index() < other.set().len()
        {
            let (hull, len) = hull_of(&other.set().get(j), motion.as_ref());
            offer_hint_of_set(self.set(), [i, j], &hull[..len], pairs);
        }
        let (a, b) = (TreeSide(self.tree()), TreeSide(other.tree()));
        match motion {
            Some(motion) => search_pairs(&a, &MovedSide { tree: b, motion }, pairs),
            None => search_pairs(&a, &b, pairs),
        }
    }
}
