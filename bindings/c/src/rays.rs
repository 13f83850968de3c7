//! Rays.

use crate::arrays::{check_pointer, reference, write};
use crate::index::Index;
use crate::queries::{Batch, BatchOptions, P2M_NO_PRIMITIVE};
use crate::status::{Call, Status, invalid, run};
use crate::threads::{Cancel, with_threads};
use nalgebra::{Point3, Vector3};
use p2m_core::{RayQuery, Side, batch};
use std::ffi::{c_int, c_void};

/// A ray: the points `origin + t * direction` with `t_min <= t <= t_max`.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// The point with the parameter 0.
    pub origin: [f64; 3],
    /// The direction, of any length but 0. Parameters are in units of this length.
    pub direction: [f64; 3],
    /// The smallest parameter.
    pub t_min: f64,
    /// The largest parameter, which may be infinite.
    pub t_max: f64,
    /// The distance within which segments and points count as hit. Triangles are hit exactly.
    pub radius: f64,
}

/// A hit of a ray.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Hit {
    /// The parameter, with a single rounding; infinity if there is no hit.
    pub t: f64,
    /// The point on the primitive that is hit.
    pub point: [f64; 3],
    /// The weights of the vertices of the primitive.
    pub weights: [f64; 3],
    /// The id of the primitive, or `P2M_NO_PRIMITIVE`.
    pub primitive: u32,
    /// The side from which a triangle is hit: 1 from the front, -1 from the back, and 0 along it or without a hit.
    pub side: i8,
}

impl Hit {
    const NONE: Self =
        Self { t: f64::INFINITY, point: [f64::NAN; 3], weights: [f64::NAN; 3], primitive: P2M_NO_PRIMITIVE, side: 0 };
}

impl From<&p2m_core::Hit> for Hit {
    fn from(hit: &p2m_core::Hit) -> Self {
        let side = match hit.side {
            Side::Front => 1,
            Side::Back => -1,
            Side::Along => 0,
        };
        Self {
            t: hit.parameter,
            point: hit.point().into(),
            weights: hit.barycentric(),
            primitive: hit.primitive.number(),
            side,
        }
    }
}

impl Ray {
    pub(crate) fn checked(&self) -> Call<p2m_core::Ray> {
        let ray = p2m_core::Ray::new(&Point3::from(self.origin), &Vector3::from(self.direction));
        let ray = ray.and_then(|ray| ray.with_range(self.t_min, self.t_max));
        ray.and_then(|ray| ray.with_radius(self.radius)).map_err(|error| invalid(format!("ray: {error}")))
    }
}

impl Index {
    pub(crate) fn rays(&self) -> Call<&(dyn RayQuery<f64> + Sync)> {
        let unsupported = || self.unsupported("casts no rays", |backend| backend.casts_rays);
        self.built.index.as_ray_query().ok_or_else(unsupported)
    }
}

/// Finds the first hit of a ray, the one with the smallest parameter, and of equal ones the one with the lowest id.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn p2m_first_hit(index: *const Index, ray: *const Ray, hit: *mut Hit) -> Status {
    // SAFETY: the caller vouches for the pointers.
    run(|| unsafe {
        let (index, ray) = (reference(index, "index")?.rays()?, reference(ray, "ray")?.checked()?);
        write(hit, "hit", index.first_intersection(&ray).as_ref().map_or(Hit::NONE, Hit::from))
    })
}

/// Writes whether a ray hits anything.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn p2m_any_hit(index: *const Index, ray: *const Ray, is_hit: *mut bool) -> Status {
    // SAFETY: the caller vouches for the pointers.
    run(|| unsafe {
        let (index, ray) = (reference(index, "index")?.rays()?, reference(ray, "ray")?.checked()?);
        write(is_hit, "is_hit", index.do_intersect(&ray))
    })
}

/// A function that receives a hit, and the `user` pointer of the call. Any result but 0 ends the search.
pub type VisitHit = Option<unsafe extern "C" fn(hit: *const Hit, user: *mut c_void) -> c_int>;

/// Calls a function for all hits of a ray, one for each primitive that is hit, the nearest first. The function must not
/// throw or jump out.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn p2m_visit_hits(
    index: *const Index,
    ray: *const Ray,
    visit: VisitHit,
    user: *mut c_void,
) -> Status {
    // SAFETY: the caller vouches for the pointers and the function.
    run(|| unsafe {
        let (index, ray) = (reference(index, "index")?.rays()?, reference(ray, "ray")?.checked()?);
        let visit = visit.ok_or_else(|| invalid("visit: the function is null"))?;
        for hit in index.all_intersections(&ray).iter().map(Hit::from) {
            if visit(&raw const hit, user) != 0 {
                break;
            }
        }
        Ok(())
    })
}

/// Finds the first hits of many rays. `hits` has room for `count`. `options` may be null, and its largest distance is
/// ignored.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn p2m_first_hits(
    index: *const Index,
    rays: *const Ray,
    count: usize,
    options: *const BatchOptions,
    hits: *mut Hit,
) -> Status {
    // SAFETY: the caller vouches for the pointers.
    run(|| unsafe {
        let (index, batch) = (reference(index, "index")?.rays()?, Batch::new(options)?);
        if count == 0 {
            return Ok(());
        }
        reference(rays, "rays")?;
        check_pointer(hits, "hits")?;
        if count.checked_mul(size_of::<Ray>()).is_none_or(|bytes| isize::try_from(bytes).is_err()) {
            return Err(invalid(format!("rays: {count} of them do not fit into memory")));
        }
        let rays: Call<Vec<_>> = std::slice::from_raw_parts(rays, count).iter().map(Ray::checked).collect();
        let rays = rays?;
        let found = with_threads(batch.threads, |is_parallel| {
            let origin = |ray: &p2m_core::Ray| Point3::from(ray.origin);
            batch::map(&rays, &batch.options(is_parallel), origin, |ray| {
                Cancel::check(batch.cancel).ok().and_then(|()| index.first_intersection(ray))
            })
        })?;
        Cancel::check(batch.cancel)?;
        for (i, hit) in found.iter().enumerate() {
            write(hits.wrapping_add(i), "hits", hit.as_ref().map_or(Hit::NONE, Hit::from))?;
        }
        Ok(())
    })
}
