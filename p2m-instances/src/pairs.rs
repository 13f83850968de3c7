//! Pair queries: the closest pairs of primitives of two scenes.

use crate::id::InstanceId;
use crate::instance::Instance;
use crate::instances::{InstanceTree, Instances};
use nalgebra::Point3;
use p2m_core::engine::pairs::{PairSide, ShapeSide};
use p2m_core::pair::{ClosestPair, Hull, Motion, PairOptions, PairQuery, closest_as_guess};
use p2m_core::{Aabb, AnyIndex, Near, NearQuery, PrimitiveId, Real};

impl<T: Real, I: AnyIndex<T> + ?Sized> PairQuery<T> for Instances<T, I> {
    fn primitive_count(&self) -> usize {
        self.count_primitives()
    }

    fn hull(&self, id: PrimitiveId) -> Hull {
        let (instance, local) = self.owner_of(id).expect("the id is one of the scene");
        instance.moved(local, &[])
    }

    fn pair_bounds(&self) -> Aabb<f64> {
        self.bounds()
    }

    fn visit_pair_sides(
        &self,
        motions: &[Motion],
        near: &Aabb<f64>,
        search: &mut dyn FnMut(&dyn PairSide, usize) -> f64,
    ) -> bool {
        let mut visit = |instance: &Instance<I>| visit_instance(instance, motions, near, search);
        // The box in the frame of the scene. Its centre and half of its diagonal tell how far an instance may be from a
        // point. A motion rounds vertices of the scene by as much as the scene is large.
        let near = motions.iter().rev().fold(*near, |near, motion| motion.apply_inverse_to_box(&near));
        let centre = nalgebra::center(&near.min, &near.max);
        let half = nalgebra::distance(&near.min, &near.max) * 0.5;
        let size = half + centre.coords.amax() + motions.iter().map(|motion| norm(motion.translation())).sum::<f64>();
        let margin = |tree: &InstanceTree| {
            let all = tree.tree.pair_bounds();
            half + (size + norm(all.min.into()) + norm(all.max.into())) * ROUNDING
        };
        let ordered = self.tree.as_ref().map(|tree| (tree, margin(tree))).filter(|(_, margin)| margin.is_finite());
        match ordered {
            Some((tree, margin)) => {
                let boxes = tree.tree.set();
                let mut visit_box =
                    |id: PrimitiveId, _: &[[f64; 3]]| visit(&self.instances[boxes[id.index()].position]) + margin;
                let all = f64::INFINITY;
                tree.tree.search_near(&centre, &mut Near::shrinking(all, all, &mut visit_box));
            }
            None => {
                let _ = self.instances.iter().find(|instance| visit(instance).is_nan());
            }
        }
        true
    }

    fn guess_closest(&self, point: [f64; 3]) -> Option<([f64; 3], PrimitiveId)> {
        closest_as_guess(self, point)
    }
}

/// Calls `search` with the trees of an instance, or with each of its primitives if it has no trees, and returns the
/// last result.
fn visit_instance<T: Real, I: AnyIndex<T> + ?Sized>(
    instance: &Instance<I>,
    motions: &[Motion],
    near: &Aabb<f64>,
    search: &mut dyn FnMut(&dyn PairSide, usize) -> f64,
) -> f64 {
    let chain: Vec<Motion> = std::iter::once(instance.motion).chain(motions.iter().copied()).collect();
    let mut reach = f64::INFINITY;
    let mut search = |side: &dyn PairSide, id: usize| {
        reach = search(side, id);
        reach
    };
    let index = instance.object.index.as_pair_query();
    let has_trees = index.is_some_and(|index| {
        index.visit_pair_sides(&chain, near, &mut |side, offset| search(side, instance.first + offset))
    });
    if !has_trees {
        for id in instance.local_ids() {
            let moved = |vertex| motions.iter().fold(vertex, |vertex, motion| motion.apply(vertex));
            let hull = instance.moved(id, &[]).map(moved);
            if search(&ShapeSide(hull.vertices()), instance.scene_id(id).index()).is_nan() {
                break;
            }
        }
    }
    reach
}

/// The margin for the rounding of motions that is added to distances, as a fraction of all magnitudes.
const ROUNDING: f64 = 1024.0 * f64::EPSILON;

fn norm(vector: [f64; 3]) -> f64 {
    Point3::from(vector).coords.norm()
}

/// One instance of a scene, as a scene of its own with the ids of the object.
struct Alone<'a, I: ?Sized>(&'a Instance<I>);

impl<T: Real, I: AnyIndex<T> + ?Sized> PairQuery<T> for Alone<'_, I> {
    fn primitive_count(&self) -> usize {
        self.0.primitives().len()
    }

    fn hull(&self, id: PrimitiveId) -> Hull {
        self.0.moved(id, &[])
    }

    fn pair_bounds(&self) -> Aabb<f64> {
        self.0.bounds
    }

    fn visit_pair_sides(
        &self,
        motions: &[Motion],
        near: &Aabb<f64>,
        search: &mut dyn FnMut(&dyn PairSide, usize) -> f64,
    ) -> bool {
        visit_instance(self.0, motions, near, &mut |side, id| search(side, id - self.0.first));
        true
    }

    fn guess_closest(&self, point: [f64; 3]) -> Option<([f64; 3], PrimitiveId)> {
        let motion = &self.0.motion;
        let (closest, id) = closest_as_guess(&*self.0.object.index, motion.apply_inverse(point))?;
        Some((motion.apply(closest), id))
    }
}

impl<T: Real, I: AnyIndex<T> + ?Sized> Instances<T, I> {
    /// Returns all pairs of instances that are within a distance of each other, each with its closest pair of
    /// primitives. The distance is inclusive, in units of the scene. With the distance 0 it finds the instances that
    /// intersect. The ids of the primitives are their ids in the scene. The first instance of a pair was added before
    /// the second, and pairs are in the order of instances.
    ///
    /// ```
    /// use nalgebra::{Isometry3, Point3};
    /// use p2m_bvh::AabbTree;
    /// use p2m_core::{Segment};
    /// use p2m_instances::Instances;
    /// use std::sync::Arc;
    ///
    /// let rod = [Segment::new(Point3::new(0.0, 0.0, 0.0), Point3::new(1.0, 0.0, 0.0))];
    /// let rod = Arc::new(AabbTree::new(rod)?);
    /// let mut scene = Instances::new();
    /// for (i, x) in [0.0, 1.5, 9.0].into_iter().enumerate() {
    ///     scene.edit().add(&format!("rod {i}"), &rod, Isometry3::translation(x, 0.0, 0.0))?;
    /// }
    /// let near = scene.near_instances(1.0);
    /// let [first, second] = near[0].0.map(|id| scene.instance(id).expect("in the scene").name());
    /// assert_eq!((near.len(), first, second, near[0].1.distance), (1, "rod 0", "rod 1", 0.5));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Complexity
    /// It takes a query of the tree of boxes for each instance, and a search for the closest pair of primitives for
    /// each pair of instances whose boxes are near.
    #[must_use]
    pub fn near_instances(&self, max_distance: T) -> Vec<([InstanceId; 2], ClosestPair<T>)> {
        let options = PairOptions::default().with_max_distance(max_distance);
        // Rounded up, with room for the rounding of a distance to the scalar.
        let reach = max_distance.to_f64() * (1.0 + 4.0 * T::UNIT_ROUNDOFF);
        let limit = reach * reach * (1.0 + 8.0 * f64::EPSILON) + f64::MIN_POSITIVE;
        let mut found = Vec::new();
        let mut test = |a: &Instance<I>, b: &Instance<I>| {
            if a.bounds.gap_squared(&b.bounds) <= limit
                && let Some(mut pair) = Alone(a).closest_pair(&Alone(b), &options)
            {
                let [i, j] = pair.primitives;
                pair.primitives = [a.scene_id(i), b.scene_id(j)];
                found.push(([a.id(), b.id()], pair));
            }
        };
        for (i, a) in self.instances.iter().enumerate() {
            let centre = nalgebra::center(&a.bounds.min, &a.bounds.max);
            let radius = nalgebra::distance(&a.bounds.min, &a.bounds.max) * 0.5;
            let around = (radius + reach) * (1.0 + 8.0 * f64::EPSILON) + f64::MIN_POSITIVE;
            match self.tree.as_ref().filter(|_| around.is_finite()) {
                Some(tree) => {
                    let boxes = tree.tree.set();
                    let mut near: Vec<usize> = Vec::new();
                    let mut take = |id: PrimitiveId, _: &[[f64; 3]]| {
                        near.push(boxes[id.index()].position);
                        around
                    };
                    tree.tree.search_near(&centre, &mut Near::shrinking(around, f64::INFINITY, &mut take));
                    near.sort_unstable();
                    near.into_iter().filter(|j| *j > i).for_each(|j| test(a, &self.instances[j]));
                }
                None => self.instances[i + 1..].iter().for_each(|b| test(a, b)),
            }
        }
        found
    }
}
