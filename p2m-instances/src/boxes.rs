//! Queries by boxes.

use crate::Instances;
use crate::instance::{Instance, shape, size};
use nalgebra::Point3;
use p2m_core::{Aabb, AnyIndex, BoxQuery, Primitive, PrimitiveId, Real};
use std::ops::ControlFlow;

impl<T: Real, I: AnyIndex<T> + ?Sized> BoxQuery<T> for Instances<T, I> {
    fn visit_box(&self, bounds: &Aabb<T>, visit: &mut dyn FnMut(PrimitiveId) -> ControlFlow<()>) -> ControlFlow<()> {
        let bounds = bounds.to_f64();
        match &self.tree {
            Some(tree) => tree.tree.visit_box(&bounds, &mut |id| {
                visit_instance(&self.instances[tree.tree.set()[id.index()].position], &bounds, visit)
            }),
            None => self.instances.iter().try_for_each(|instance| visit_instance(instance, &bounds, visit)),
        }
    }
}

/// Calls `visit` for the primitives of an instance that intersect a box after the motion.
fn visit_instance<T: Real, I: AnyIndex<T> + ?Sized>(
    instance: &Instance<I>,
    bounds: &Aabb<f64>,
    visit: &mut dyn FnMut(PrimitiveId) -> ControlFlow<()>,
) -> ControlFlow<()> {
    // The part of the box outside of the instance has no effect, and may be infinite.
    let part = bounds.intersection(&instance.bounds);
    if part.is_empty() {
        return ControlFlow::Continue(());
    }
    let mut test = |id| {
        let intersects = shape(&instance.moved::<T>(id, &[])).intersects_box(bounds);
        if intersects { visit(instance.scene_id(id)) } else { ControlFlow::Continue(()) }
    };
    match instance.object.index.as_box_query() {
        Some(index) => index.visit_box(&local_box(instance, &part), &mut test),
        None => instance.local_ids().try_for_each(test),
    }
}

/// Returns a box in the frame of an object that contains what the motion moves into a box, rounding included. It
/// may be infinite.
fn local_box<T: Real, I: ?Sized>(instance: &Instance<I>, bounds: &Aabb<f64>) -> Aabb<T> {
    let moved_back = instance.motion.apply_inverse_to_box(bounds);
    let corner = std::array::from_fn(|k| bounds.min[k].abs().max(bounds.max[k].abs()));
    let margin = instance.margin(size(corner));
    // The box of an overflow is not a number, and stands for all space.
    let below = |x: f64| if x.is_nan() { -T::INFINITY } else { T::round_down_from_f64(x) };
    let min = moved_back.min.map(|x| below((x - margin).next_down()));
    let max = moved_back.max.map(|x| -below(-(x + margin).next_up()));
    Aabb { min: Point3::from(min.coords), max: Point3::from(max.coords) }
}
