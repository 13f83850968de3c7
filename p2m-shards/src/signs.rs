//! Signs of closed surfaces, by the number of times that a ray crosses the triangles of all shards.

use crate::nearest::is_finite;
use crate::rays::{counts, entry};
use crate::search::Search;
use crate::{ShardError, ShardedIndex};
use nalgebra::{Point3, Vector3};
use p2m_core::{Position, Ray};

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
        self.check_inside()?;
        self.answer(self.inside(&query.point()))
    }

    /// Returns the search that decides whether a point is inside.
    pub(crate) fn inside(&self, query: &Point3<f64>) -> impl Search<Answer = bool> + use<> {
        counts(self.shortest_ray(query), |index, ray| index.crossings(ray), |crossings| crossings % 2 == 1)
    }

    /// Returns the ray along an axis that may hit the fewest shards, if the point is finite.
    fn shortest_ray(&self, query: &Point3<f64>) -> Option<Ray> {
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
        let directions = axes.into_iter().flat_map(|axis| [axis, -axis]).filter(|_| is_finite(query));
        let rays = directions.filter_map(|direction| Ray::new(query, &direction).ok());
        rays.min_by_key(|ray| self.boxes.iter().filter(|bounds| !entry(ray, bounds).is_nan()).count())
    }

    /// Checks that the scene has triangles alone.
    pub(crate) fn check_inside(&self) -> Result<(), ShardError> {
        let manifest = self.manifest();
        if manifest.segments > 0 || manifest.points > 0 { Err(ShardError::NoInside) } else { Ok(()) }
    }
}
