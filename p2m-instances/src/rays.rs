//! Queries by rays.

use crate::Instances;
use crate::instance::{Instance, size};
use p2m_core::kernel::power_of_two;
use p2m_core::{AnyIndex, Crossing, Hits, PrimitiveId, Ray, RayCollector, RayQuery, Real};

/// A direction whose largest component is smaller than this loses digits when it is turned: 2^-900.
const MIN_DIRECTION: f64 = power_of_two(-900);

impl<T: Real, I: AnyIndex<T> + ?Sized> RayQuery<T> for Instances<T, I> {
    fn search_ray<'r>(&self, ray: &'r Ray, hits: &mut Hits<'r>) {
        let only_crossings = hits.only_crossings();
        self.visit_instances(ray, &mut |instance, limit| {
            let mut limit = limit.min(hits.limit());
            visit_instance(instance, ray, limit, &mut |id, vertices| {
                let moved = instance.moved::<T>(id, vertices);
                if let Some(crossing) = Crossing::from_vertices(ray, moved.vertices(), hits.limit(), only_crossings) {
                    let flow = hits.offer(instance.scene_id(id), &crossing);
                    limit = if flow.is_break() { f64::NEG_INFINITY } else { hits.limit() };
                }
                limit
            });
            limit
        });
    }

    fn visit_ray_candidates(&self, ray: &Ray, visit: &mut dyn FnMut(PrimitiveId, &[[f64; 3]]) -> f64) {
        self.visit_instances(ray, &mut |instance, mut limit| {
            visit_instance(instance, ray, limit, &mut |id, vertices| {
                let moved = instance.moved::<T>(id, vertices);
                limit = limit.min(visit(instance.scene_id(id), moved.vertices()));
                limit
            });
            limit
        });
    }
}

impl<T: Real, I: AnyIndex<T> + ?Sized> Instances<T, I> {
    /// Calls `visit` for the instances that a ray may hit, with the parameter above which hits are not needed. It
    /// returns that parameter from then on.
    fn visit_instances(&self, ray: &Ray, visit: &mut dyn FnMut(&Instance<I>, f64) -> f64) {
        let mut limit = f64::INFINITY;
        let mut visit = |instance: &Instance<I>| {
            limit = visit(instance, limit);
            limit
        };
        match &self.tree {
            Some(tree) => {
                let boxes = tree.tree.set();
                tree.tree.visit_ray_candidates(ray, &mut |id, _| visit(&self.instances[boxes[id.index()].position]));
            }
            None => {
                let _ = self.instances.iter().find(|instance| visit(instance) == f64::NEG_INFINITY);
            }
        }
    }
}

/// Calls `visit` for the primitives of an instance that a ray may hit up to a parameter. It returns that
/// parameter from then on.
fn visit_instance<T: Real, I: AnyIndex<T> + ?Sized>(
    instance: &Instance<I>,
    ray: &Ray,
    limit: f64,
    visit: &mut dyn FnMut(PrimitiveId, &[[f64; 3]]) -> f64,
) {
    if limit < ray.range()[0] {
        return;
    }
    match (instance.object.index.as_ray_query(), local_ray(instance, ray, limit)) {
        (Some(index), Some(local)) => index.visit_ray_candidates(&local, visit),
        _ => {
            let _ = instance.local_ids().find(|id| visit(*id, &[]) == f64::NEG_INFINITY);
        }
    }
}

/// Returns a ray up to a parameter in the frame of an object, or `None` where that leaves the range of f64.
///
/// Where the ray hits a moved primitive, a ray of the same direction from an origin that is moved by less than the
/// error of the origin hits the primitive in the frame of the object, with the same parameter.
fn local_ray<I: ?Sized>(instance: &Instance<I>, ray: &Ray, limit: f64) -> Option<Ray> {
    let origin = instance.motion.apply_inverse(ray.origin().into());
    let direction = instance.motion.apply_inverse_to_vector(ray.direction().into());
    let error = instance.margin(size(ray.origin().into()) + ray.radius()) + ray.origin_error();
    let is_in_range = direction.iter().any(|x| x.abs() >= MIN_DIRECTION) && error.is_finite();
    let [min, max] = ray.range();
    let local = Ray::new::<f64>(&origin.into(), &direction.into()).ok().filter(|_| is_in_range)?;
    Some(local.with_range(min, max.min(limit)).ok()?.with_radius(ray.radius()).ok()?.with_origin_error(error))
}
