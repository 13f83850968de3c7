//! Rays: the hits of the shards whose boxes a ray may hit.

use crate::search::{Search, collect};
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

impl ShardHit {
    fn new(number: usize, shard: &Shard, hit: Hit) -> Self {
        Self { id: shard.global_id(hit.primitive), shard: number, hit }
    }
}

/// The unit roundoff times the number of roundings of a parameter below, with room to spare.
const SLACK: f64 = 8.0 * f64::EPSILON;

/// Returns a lower bound on the parameters at which a ray may hit something in a box, or NaN if it hits nothing there.
///
/// A coordinate less the origin is rounded once, and the parameter of a plane once more, so both are known up to a
/// factor; underflow adds a few smallest subnormals. Without these margins a hit on the face of a box could be lost.
pub(crate) fn entry(ray: &Ray, bounds: &Aabb<f64>) -> f64 {
    let [mut first, mut last] = ray.range();
    let (origin, direction, radius) = (ray.origin(), ray.direction(), ray.radius());
    for k in 0..3 {
        let (mut low, mut high) = (bounds.min[k], bounds.max[k]);
        if radius > 0.0 {
            (low, high) = ((low - radius).next_down(), (high + radius).next_up());
        }
        if direction[k] == 0.0 {
            if origin[k] < low || origin[k] > high {
                return f64::NAN;
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
    if first <= last { first } else { f64::NAN }
}

/// Returns the queries of rays of a shard.
fn ray_query(shard: &Shard) -> Result<&(dyn RayQuery<f64> + Sync), ShardError> {
    shard.index().as_ray_query().ok_or_else(|| ShardError::NoRays { backend: shard.backend().to_owned() })
}

/// Returns the search for the first hit.
pub(crate) fn first_hit(ray: &Ray) -> impl Search<Answer = Option<ShardHit>> + use<> {
    collect(
        *ray,
        None,
        entry,
        |best: &Option<ShardHit>| best.map_or(f64::INFINITY, |best| best.hit.parameter),
        |best, ray, number, shard| {
            // The range ends at the best hit, at which another one with a lower id may be.
            let end = best.map_or(ray.range()[1], |best| best.hit.parameter);
            let shorter = ray.with_range(ray.range()[0], end).unwrap_or(*ray);
            let hit = ray_query(shard)?.first_intersection(&shorter).map(|hit| ShardHit::new(number, shard, hit));
            let is_first =
                |hit: &ShardHit| best.is_none_or(|best| (hit.hit.parameter, hit.id) < (best.hit.parameter, best.id));
            *best = hit.filter(is_first).or(*best);
            Ok(())
        },
        |best| best,
    )
}

/// Returns the search for all hits.
pub(crate) fn all_hits(ray: &Ray) -> impl Search<Answer = Vec<ShardHit>> + use<> {
    collect(
        *ray,
        Vec::new(),
        entry,
        |_| f64::INFINITY,
        |all, ray, number, shard| {
            let hits = ray_query(shard)?.all_intersections(ray);
            all.try_reserve(hits.len())?;
            all.extend(hits.into_iter().map(|hit| ShardHit::new(number, shard, hit)));
            Ok(())
        },
        |mut all| {
            all.sort_unstable_by(|a, b| a.hit.parameter.total_cmp(&b.hit.parameter).then(a.id.cmp(&b.id)));
            all
        },
    )
}

/// Returns the search for the sum of the counts of shards. Without a ray the sum is 0.
pub(crate) fn counts<R: Send>(
    ray: Option<Ray>,
    count: fn(&dyn RayQuery<f64>, &Ray) -> i64,
    finish: fn(i64) -> R,
) -> impl Search<Answer = R> {
    collect(
        ray,
        0,
        |ray, bounds| ray.as_ref().map_or(f64::NAN, |ray| entry(ray, bounds)),
        |_| f64::INFINITY,
        move |sum, ray, _, shard| {
            let index = ray_query(shard)?;
            *sum += ray.as_ref().map_or(0, |ray| count(index, ray));
            Ok(())
        },
        finish,
    )
}

/// Returns the search for the number of hits.
pub(crate) fn count(ray: &Ray) -> impl Search<Answer = usize> + use<> {
    counts(Some(*ray), |index, ray| as_sum(index.count(ray)), as_count)
}

/// Returns the search for the number of crossings.
pub(crate) fn crossings(ray: &Ray) -> impl Search<Answer = usize> + use<> {
    counts(Some(*ray), |index, ray| as_sum(index.crossings(ray)), as_count)
}

/// Returns a count as a summand. A scene has fewer primitives than i64 counts.
pub(crate) fn as_sum(count: usize) -> i64 {
    i64::try_from(count).unwrap_or(i64::MAX)
}

fn as_count(sum: i64) -> usize {
    usize::try_from(sum).unwrap_or(usize::MAX)
}

/// Returns the search that decides whether anything is hit.
pub(crate) fn any_hit(ray: &Ray) -> impl Search<Answer = bool> + use<> {
    collect(
        *ray,
        false,
        entry,
        |is_hit| if *is_hit { f64::NAN } else { f64::INFINITY },
        |is_hit, ray, _, shard| {
            *is_hit = ray_query(shard)?.do_intersect(ray);
            Ok(())
        },
        |is_hit| is_hit,
    )
}

impl ShardedIndex {
    /// Returns the hit with the least parameter, and of equal parameters the one with the lowest id.
    ///
    /// # Errors
    /// It returns [`ShardError::NoRays`] if the backend casts no rays, and the
    /// [errors of loading a shard](ShardError#loading-a-shard).
    pub fn first_intersection(&self, ray: &Ray) -> Result<Option<ShardHit>, ShardError> {
        self.answer(first_hit(ray))
    }

    /// Returns all hits, ordered by parameter and of equal parameters by id.
    ///
    /// # Errors
    /// It returns the errors of [`first_intersection`](Self::first_intersection).
    pub fn all_intersections(&self, ray: &Ray) -> Result<Vec<ShardHit>, ShardError> {
        self.answer(all_hits(ray))
    }

    /// Returns the number of primitives that are hit.
    ///
    /// # Errors
    /// It returns the errors of [`first_intersection`](Self::first_intersection).
    pub fn count(&self, ray: &Ray) -> Result<usize, ShardError> {
        self.answer(count(ray))
    }

    /// Returns how often the ray crosses the surface that the triangles form
    /// ([`RayQuery::crossings`](p2m_core::RayQuery::crossings)).
    ///
    /// # Errors
    /// It returns the errors of [`first_intersection`](Self::first_intersection).
    pub fn crossings(&self, ray: &Ray) -> Result<usize, ShardError> {
        self.answer(crossings(ray))
    }

    /// Returns whether the ray hits any primitive.
    ///
    /// # Errors
    /// It returns the errors of [`first_intersection`](Self::first_intersection).
    pub fn do_intersect(&self, ray: &Ray) -> Result<bool, ShardError> {
        self.answer(any_hit(ray))
    }
}
