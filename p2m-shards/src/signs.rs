//! Signs of closed surfaces, by the number of times that a ray crosses the triangles of all shards.

use crate::nearest::is_finite;
use crate::{ShardError, ShardedIndex};
use nalgebra::{Point3, Vector3};
use p2m_core::Ray;

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
    /// casts no rays, and [`ShardError::Load`] and [`ShardError::OtherShard`] if a shard that is needed has a wrong
    /// file.
    pub fn is_inside(&self, query: &Point3<f64>) -> Result<bool, ShardError> {
        self.check_inside()?;
        if !is_finite(query) {
            return Ok(false);
        }
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
        let directions = axes.into_iter().flat_map(|axis| [axis, -axis]);
        let rays = directions.filter_map(|direction| Ray::new(query, &direction).ok());
        let Some(ray) = rays.min_by_key(|ray| self.count_shards_along(ray)) else { return Ok(false) };
        Ok(self.crossings(&ray)? % 2 == 1)
    }

    /// Checks that the scene has triangles alone.
    pub(crate) fn check_inside(&self) -> Result<(), ShardError> {
        let manifest = self.manifest();
        if manifest.segments > 0 || manifest.points > 0 { Err(ShardError::NoInside) } else { Ok(()) }
    }
}
