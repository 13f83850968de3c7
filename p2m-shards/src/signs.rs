//! Signs of closed surfaces, by the number of times that a ray crosses the triangles of all shards.

use crate::nearest::is_finite;
use crate::{ShardError, ShardedIndex};
use nalgebra::{Point3, Vector3};
use p2m_core::{Position, Ray};
use rayon::prelude::*;

impl ShardedIndex {
    /// Returns whether a point is inside of the closed surface that the triangles form: a ray from it crosses the
    /// surface an odd number of times. Points on the surface are on either side, and points that are not finite are
    /// outside.
    ///
    /// The direction of the ray is one of the six along the axes, that which passes the fewest boxes of shards. For a
    /// closed surface every direction gives the same answer. That the surface is closed is not checked.
    ///
    /// # Errors
    /// It returns [`ShardError::NoInside`] for a scene with segments or points, [`ShardError::NoRays`] if the backend
    /// casts no rays, and the [errors of loading a shard](ShardError#loading-a-shard).
    pub fn is_inside(&self, query: &impl Position<f64>) -> Result<bool, ShardError> {
        let query = &query.point();
        self.check_inside()?;
        self.shortest_ray(query).map_or(Ok(false), |ray| Ok(self.crossings(&ray)? % 2 == 1))
    }

    /// Returns for each point whether it is inside, as [`is_inside`](Self::is_inside) does, on all threads of the
    /// current pool.
    ///
    /// # Errors
    /// It returns the errors of [`is_inside`](Self::is_inside).
    ///
    /// # Complexity
    /// Each shard is loaded at most once. Comparing n rays with the boxes of s shards takes O(n s), and memory is about
    /// 150 bytes for each point.
    pub fn are_inside(&self, queries: &[impl Position<f64>]) -> Result<Vec<bool>, ShardError> {
        self.check_inside()?;
        let rays: Vec<Option<Ray>> = queries.par_iter().map(|query| self.shortest_ray(&query.point())).collect();
        let mut are_inside = vec![false; queries.len()];
        for number in 0..self.boxes.len() {
            let meets = |ray: &Option<Ray>| ray.as_ref().is_some_and(|ray| self.meets(ray, number));
            if !rays.par_iter().any(meets) {
                continue;
            }
            let shard = self.shard(number)?;
            let index = self.ray_query(&shard)?;
            are_inside.par_iter_mut().zip(&rays).for_each(|(is_inside, ray)| {
                if let Some(ray) = ray.as_ref().filter(|ray| self.meets(ray, number)) {
                    *is_inside ^= index.crossings(ray) % 2 == 1;
                }
            });
        }
        Ok(are_inside)
    }

    /// Returns the ray along an axis that may hit the fewest shards, if the point is finite.
    fn shortest_ray(&self, query: &Point3<f64>) -> Option<Ray> {
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
        let directions = axes.into_iter().flat_map(|axis| [axis, -axis]).filter(|_| is_finite(query));
        let rays = directions.filter_map(|direction| Ray::new(query, &direction).ok());
        rays.min_by_key(|ray| self.count_shards_along(ray))
    }

    /// Checks that the scene has triangles alone.
    pub(crate) fn check_inside(&self) -> Result<(), ShardError> {
        let manifest = self.manifest();
        if manifest.segments > 0 || manifest.points > 0 { Err(ShardError::NoInside) } else { Ok(()) }
    }
}
