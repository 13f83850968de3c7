//! Box queries.

use crate::{Aabb, BruteForce, Primitive, PrimitiveId, PrimitiveSet, Real};
use std::ops::ControlFlow;

/// Queries for the primitives that intersect a box. A backend implements one method, [`visit_box`](Self::visit_box).
///
/// # Contract
///
/// - **Exact**: the box and the primitives are closed sets, so a primitive that touches a face, an edge or a corner of
///   the box intersects it, and one at the smallest representable distance does not. This is decided without rounding
///   ([`Primitive::intersects_box`]) for all finite scenes, so all backends find the same primitives.
/// - **Any box**: a box without extent is a rectangle, a segment or a point. Sides may lie at infinity. An empty box
///   (`min > max` on some axis) and one with a NaN coordinate intersect nothing.
/// - **Interior**: a triangle or segment that passes through the box without a vertex in it intersects the box. A
///   closed mesh around the box does not, since it is a surface.
///
/// ```
/// use p2m_core::{Aabb, BoxQuery, BruteForce, Triangle};
/// use nalgebra::Point3;
///
/// let scene = [Triangle::new(Point3::new(0.0, 0.0, 0.0), Point3::new(4.0, 0.0, 0.0), Point3::new(0.0, 4.0, 0.0))];
/// let index = BruteForce::new(&scene).unwrap();
/// let block = |x: f64| Aabb { min: Point3::new(x, x, -1.0), max: Point3::new(9.0, 9.0, 1.0) };
/// // The box touches the triangle at one point of its longest edge.
/// assert!(index.intersects_box(&block(2.0)));
/// assert!(!index.intersects_box(&block(2.0 + 4.0 * f64::EPSILON)));
/// ```
///
/// # References
/// The queries are `BoxIntersectsAPrimitive` and `GetPrimitivesInABox` of \[Cavarga2021\]. The latter does not test the
/// primitives of the leaves there.
#[diagnostic::on_unimplemented(
    message = "`{Self}` answers no queries by boxes with coordinates of type `{T}`",
    note = "`AabbTree`, `KdopTree` and `BruteForce` do; the octree and the P2M index answer closest-point queries only"
)]
pub trait BoxQuery<T: Real> {
    /// Calls `visit` once for each primitive that intersects `bounds`, in any order, until `visit` breaks. Returns
    /// whether it did.
    ///
    /// # Complexity
    /// Brute force takes O(n). Trees visit the nodes whose bounds intersect the box.
    fn visit_box(&self, bounds: &Aabb<T>, visit: &mut dyn FnMut(PrimitiveId) -> ControlFlow<()>) -> ControlFlow<()>;

    /// Returns whether any primitive intersects the box.
    fn intersects_box(&self, bounds: &Aabb<T>) -> bool {
        self.visit_box(bounds, &mut |_| ControlFlow::Break(())).is_break()
    }

    /// Replaces the content of `out` by all primitives that intersect the box, in increasing order.
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
            .filter(|id| self.set().get(*id).intersects_box(bounds))
            .try_for_each(visit)
    }
}
