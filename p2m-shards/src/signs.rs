//! Signs of surfaces without a boundary, by the crossings of a ray with the triangles of all shards.

use crate::nearest::is_finite;
use crate::rays::{as_sum, counts, entry};
use crate::search::Search;
use crate::{ShardError, ShardedIndex};
use nalgebra::{Point3, Vector3};
use p2m_core::{Position, Ray};
use p2m_field::sign::SignRule;

impl ShardedIndex {
    /// Returns the rule that decides which points are inside: the same one as
    /// [`SignedDistance::new`](p2m_field::sign::SignedDistance::new) chooses for the whole scene.
    ///
    /// # Errors
    /// It returns [`ShardError::NoInside`] for a scene with segments or points, and [`ShardError::Open`] for
    /// an open surface.
    pub fn sign_rule(&self) -> Result<SignRule, ShardError> {
        let manifest = self.manifest();
        let has_others = manifest.segments > 0 || manifest.points > 0;
        manifest.sign_rule().ok_or(if has_others { ShardError::NoInside } else { ShardError::Open })
    }

    /// Returns whether a point is inside of the surface that the triangles form, by [`sign_rule`](Self::sign_rule).
    /// Points on the surface are on either side, and points that are not finite are outside.
    ///
    /// The direction of the ray is the one of the six along the axes that passes the fewest boxes of shards. Every
    /// direction gives the same answer.
    ///
    /// # Errors
    /// It returns the errors of [`sign_rule`](Self::sign_rule), [`ShardError::NoRays`] if the backend casts no rays,
    /// and the [errors of loading a shard](ShardError#loading-a-shard).
    pub fn contains(&self, query: &impl Position<f64>) -> Result<bool, ShardError> {
        let rule = self.sign_rule()?;
        self.answer(self.inside(rule, &query.point()))
    }

    /// Returns the search that decides whether a point is inside.
    pub(crate) fn inside(&self, rule: SignRule, query: &Point3<f64>) -> impl Search<Answer = bool> + use<> {
        let ray = self.shortest_ray(query);
        match rule {
            SignRule::Winding => counts(ray, |index, ray| index.signed_crossings(ray), |sum| sum != 0),
            SignRule::Parity => counts(ray, |index, ray| as_sum(index.crossings(ray)), |sum| sum % 2 != 0),
        }
    }

    /// Returns the ray along an axis that may hit the fewest shards, if the point is finite.
    fn shortest_ray(&self, query: &Point3<f64>) -> Option<Ray> {
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
        let directions = axes.into_iter().flat_map(|axis| [axis, -axis]).filter(|_| is_finite(query));
        let rays = directions.filter_map(|direction| Ray::new(query, &direction).ok());
        rays.min_by_key(|ray| self.boxes.iter().filter(|bounds| !entry(ray, bounds).is_nan()).count())
    }
}
