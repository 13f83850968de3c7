//! Which primitives meet a box, and the leaf nearest to a point.

use crate::{Aabb, BruteForce, Closest, Primitive, PrimitiveId, PrimitiveSet, Real};
use nalgebra::Point3;
use std::ops::ControlFlow;

/// Which primitives of a scene meet a box. A backend writes one method, [`visit_box`](Self::visit_box).
///
/// # Contract
///
/// - **Exact**: box and primitives are closed sets, so one that touches a face, an edge or a corner of the box meets
///   it, and one that passes by at the smallest representable distance does not. Decided without rounding
///   ([`Primitive::meets_box`]), for all finite scenes; every backend finds the same primitives.
/// - **Any box**: a box without extent is a rectangle, a segment or a point. Sides may lie at infinity. An empty box
///   (`min > max` on some axis) and one with a NaN coordinate meet nothing.
/// - **Filled**: a triangle or segment that runs through the box without a vertex in it meets the box; a closed mesh
///   around the box does not, for it is a surface.
///
/// ```
/// use p2m_core::{Aabb, BoxQuery, BruteForce, Triangle};
/// use nalgebra::Point3;
///
/// let scene = [Triangle::new(Point3::new(0.0, 0.0, 0.0), Point3::new(4.0, 0.0, 0.0), Point3::new(0.0, 4.0, 0.0))];
/// let index = BruteForce::new(&scene).unwrap();
/// let block = |x: f64| Aabb { min: Point3::new(x, x, -1.0), max: Point3::new(9.0, 9.0, 1.0) };
/// assert!(index.meets_box(&block(2.0))); // at one point, on the longest edge
/// assert!(!index.meets_box(&block(2.0 + 4.0 * f64::EPSILON)));
/// ```
///
/// # References
/// `BoxIntersectsAPrimitive` and `GetPrimitivesInABox` in \[Cavarga2021\], the latter of which does not test the
/// primitives of the leaves.
pub trait BoxQuery<T: Real> {
    /// Calls `visit` once for every primitive that meets `bounds`, in any order, until it breaks; whether it did.
    ///
    /// # Complexity
    /// O(n) for brute force; trees open the nodes that meet the box.
    fn visit_box(&self, bounds: &Aabb<T>, visit: &mut dyn FnMut(PrimitiveId) -> ControlFlow<()>) -> ControlFlow<()>;

    /// Whether any primitive meets the box.
    fn meets_box(&self, bounds: &Aabb<T>) -> bool {
        self.visit_box(bounds, &mut |_| ControlFlow::Break(())).is_break()
    }

    /// Replaces the content of `out` by all primitives that meet the box, in increasing order.
    fn primitives_in_box_into(&self, bounds: &Aabb<T>, out: &mut Vec<PrimitiveId>) {
        out.clear();
        let _ = self.visit_box(bounds, &mut |id| {
            out.push(id);
            ControlFlow::Continue(())
        });
        out.sort_unstable();
    }
}

impl<T: Real, S: PrimitiveSet<T>> BoxQuery<T> for BruteForce<S> {
    fn visit_box(&self, bounds: &Aabb<T>, visit: &mut dyn FnMut(PrimitiveId) -> ControlFlow<()>) -> ControlFlow<()> {
        (0..self.set().len())
            .map(PrimitiveId::new)
            .filter(|id| self.set().get(*id).meets_box(bounds))
            .try_for_each(visit)
    }
}

/// The closest point of the leaf that a tree finds first: an approximate answer at the price of one way down.
///
/// `distance` is that of a point of the scene, so never below the true one (apart from the error of N1), but may exceed
/// it by any factor; `lower_bound` is certified as in [`ClosestPoint`](crate::ClosestPoint), from the branches left
/// aside. If both meet the answer is the exact one. `None` for an empty set and for a query that is not finite.
///
/// Which leaf that is depends on the tree, so backends do not agree.
///
/// # References
/// `GetClosestLeafNode` in \[Cavarga2021\].
pub trait ClosestLeaf<T: Real> {
    /// The closest point among the primitives of one leaf.
    ///
    /// # Complexity
    /// O(depth).
    fn closest_leaf(&self, query: &Point3<T>) -> Option<Closest<T>>;
}
