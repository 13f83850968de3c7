//! Rays: the hits of the shards whose boxes a ray may hit.

use crate::{Shard, ShardError, ShardedIndex};
use p2m_core::{Aabb, Hit, Ray, RayQuery};

/// A hit of a ray in a sharded index.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ShardHit {
    /// The id of the primitive in the whole scene.
    pub id: u64,
    /// The number of the shard that has it.
    pub shard: usize,
    /// The hit. Its field `primitive` is the id within the shard.
    pub hit: Hit,
}

/// The unit roundoff times the number of roundings of a parameter below, with room to spare.
const SLACK: f64 = 8.0 * f64::EPSILON;

/// Returns a lower bound on the parameters at which a ray may hit something in a box, or `None` if it hits nothing
/// there.
///
/// A coordinate less the origin is rounded once, and the parameter of a plane once more, so both are known up to a
/// factor; underflow adds a few smallest subnormals. Without these margins a hit on the face of a box could be lost.
pub(crate) fn entry(ray: &Ray, bounds: &Aabb<f64>) -> Option<f64> {
    let [mut first, mut last] = ray.range();
    let (origin, direction, radius) = (ray.origin(), ray.direction(), ray.radius());
    for k in 0..3 {
        let (mut low, mut high) = (bounds.min[k], bounds.max[k]);
        if radius > 0.0 {
            (low, high) = ((low - radius).next_down(), (high + radius).next_up());
        }
        if direction[k] == 0.0 {
            if origin[k] < low || origin[k] > high {
                return None;
            }
            continue;
        }
        let ends = [low, high].map(|x| (x - origin[k]) / direction[k]);
        let (near, far) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
        // An infinite end comes from an overflow, so the parameter may be a finite one.
        if near.is_finite() {
            first = first.max(near - near.abs() * SLACK - 8.0 * f64::from_bits(1));
        }
        if far.is_finite() {
            last = last.min(far + far.abs() * SLACK + 8.0 * f64::from_bits(1));
        }
    }
    (first <= last).then_some(first)
}

impl ShardedIndex {
    /// Returns the shards that a ray may hit with their entries, the least entry first.
    fn shards_along(&self, ray: &Ray) -> Vec<(f64, usize)> {
        let hit = |(number, bounds)| Some((entry(ray, bounds)?, number));
        let mut along: Vec<(f64, usize)> = self.boxes.iter().enumerate().filter_map(hit).collect();
        along.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        along
    }

    /// Returns the number of shards that a ray may hit.
    pub(crate) fn count_shards_along(&self, ray: &Ray) -> usize {
        self.boxes.iter().filter(|bounds| entry(ray, bounds).is_some()).count()
    }

    /// Returns whether a ray may hit a shard.
    pub(crate) fn meets(&self, ray: &Ray, number: usize) -> bool {
        entry(ray, &self.boxes[number]).is_some()
    }

    /// Returns the queries of rays of a shard.
    pub(crate) fn ray_query<'a>(&self, shard: &'a Shard) -> Result<&'a (dyn RayQuery<f64> + Sync), ShardError> {
        shard.index().as_ray_query().ok_or_else(|| ShardError::NoRays { backend: self.manifest().backend.clone() })
    }

    /// Calls a function with each shard that a ray may hit, in the order of their entries, until it returns `false`.
    fn visit_along(
        &self,
        ray: &Ray,
        mut visit: impl FnMut(usize, &Shard, &dyn RayQuery<f64>) -> bool,
    ) -> Result<(), ShardError> {
        for (_, number) in self.shards_along(ray) {
            let shard = self.shard(number)?;
            if !visit(number, &shard, self.ray_query(&shard)?) {
                break;
            }
        }
        Ok(())
    }

    /// Returns the hit with the least parameter, and of equal parameters the one with the lowest id.
    ///
    /// # Errors
    /// It returns [`ShardError::NoRays`] if the backend casts no rays, and the
    /// [errors of loading a shard](ShardError#loading-a-shard).
    pub fn first_intersection(&self, ray: &Ray) -> Result<Option<ShardHit>, ShardError> {
        let mut best: Option<ShardHit> = None;
        for (entry, number) in self.shards_along(ray) {
            if best.is_some_and(|best| entry > best.hit.parameter) {
                break;
            }
            let shard = self.shard(number)?;
            let rays = self.ray_query(&shard)?;
            // The range ends at the best hit, at which another one with a lower id may be.
            let end = best.map_or(ray.range()[1], |best| best.hit.parameter);
            let shorter = ray.with_range(ray.range()[0], end).unwrap_or(*ray);
            if let Some(hit) = rays.first_intersection(&shorter) {
                let hit = ShardHit { id: shard.global_id(hit.primitive), shard: number, hit };
                let is_first = |best: ShardHit| (hit.hit.parameter, hit.id) < (best.hit.parameter, best.id);
                if best.is_none_or(is_first) {
                    best = Some(hit);
                }
            }
        }
        Ok(best)
    }

    /// Returns all hits, ordered by parameter and of equal parameters by id.
    ///
    /// # Errors
    /// It returns the errors of [`first_intersection`](Self::first_intersection).
    pub fn all_intersections(&self, ray: &Ray) -> Result<Vec<ShardHit>, ShardError> {
        let mut all = Vec::new();
        self.visit_along(ray, |number, shard, rays| {
            let hits = rays.all_intersections(ray).into_iter();
            all.extend(hits.map(|hit| ShardHit { id: shard.global_id(hit.primitive), shard: number, hit }));
            true
        })?;
        all.sort_unstable_by(|a, b| a.hit.parameter.total_cmp(&b.hit.parameter).then(a.id.cmp(&b.id)));
        Ok(all)
    }

    /// Returns the number of primitives that are hit.
    ///
    /// # Errors
    /// It returns the errors of [`first_intersection`](Self::first_intersection).
    pub fn count(&self, ray: &Ray) -> Result<usize, ShardError> {
        let mut count = 0;
        self.visit_along(ray, |_, _, rays| {
            count += rays.count(ray);
            true
        })?;
        Ok(count)
    }

    /// Returns how often the ray crosses the surface that the triangles form
    /// ([`RayQuery::crossings`](p2m_core::RayQuery::crossings)).
    ///
    /// # Errors
    /// It returns the errors of [`first_intersection`](Self::first_intersection).
    pub fn crossings(&self, ray: &Ray) -> Result<usize, ShardError> {
        let mut count = 0;
        self.visit_along(ray, |_, _, rays| {
            count += rays.crossings(ray);
            true
        })?;
        Ok(count)
    }

    /// Returns whether the ray hits any primitive.
    ///
    /// # Errors
    /// It returns the errors of [`first_intersection`](Self::first_intersection).
    pub fn do_intersect(&self, ray: &Ray) -> Result<bool, ShardError> {
        let mut is_hit = false;
        self.visit_along(ray, |_, _, rays| {
            is_hit = rays.do_intersect(ray);
            !is_hit
        })?;
        Ok(is_hit)
    }
}
