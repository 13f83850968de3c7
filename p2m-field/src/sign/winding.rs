//! Generalised winding numbers, by rays and caps.
//!
//! The winding number of triangles around a point is the sum of their solid angles divided by 4 pi \[Jacobson2013\].
//! For a closed surface it is an integer, which the crossings of one ray decide without rounding. A surface with a
//! boundary is closed by caps, whose solid angles are subtracted again (the module `caps`).

use super::caps::caps;
use super::local::Local;
use super::solid_angles::{Estimate, SolidAngles, sum_of_all};
use super::surface::Surface;
use super::types::{RayTree, SharedSoup, Sign, SignError, check_kinds, ray};
use nalgebra::Point3;
use p2m_bvh::TreeIndex;
use p2m_core::{Aabb, Hits, Ray, RayQuery, Real, Soup};

/// The generalised winding numbers of a set of triangles.
///
/// ```
/// use nalgebra::Point3;
/// use p2m_mixed::generate::{IcoSphere, ico_sphere};
/// use p2m_field::sign::WindingNumbers;
///
/// let ball = ico_sphere(&IcoSphere::default()).unwrap();
/// let winding = WindingNumbers::new(&ball)?;
/// assert_eq!(winding.number(&Point3::origin(), 0.01), 1.0);
/// assert_eq!(winding.number(&Point3::new(3.0, 0.0, 0.0), 0.01), 0.0);
/// # Ok::<(), p2m_field::sign::SignError>(())
/// ```
#[derive(Clone)]
pub struct WindingNumbers<S> {
    soup: S,
    /// The tree of the surface in which rays are cast, unless an index stands for it.
    rays: Option<RayTree<S>>,
    /// The caps of a surface with a boundary.
    caps: Option<Box<Caps>>,
}

#[derive(Clone)]
struct Caps {
    rays: TreeIndex<f64, Soup<f64>, Aabb<f64>>,
    angles: SolidAngles,
}

impl<S: SharedSoup> WindingNumbers<S> {
    /// Prepares the winding numbers of a soup.
    ///
    /// # Errors
    /// [`SignError::OtherKinds`] if a primitive is not a triangle, and [`SignError::Build`] if a tree cannot be built.
    ///
    /// # Complexity
    /// O(n log n) time. Memory is 60 bytes per triangle and 300 bytes per edge of the boundary.
    pub fn new(soup: S) -> Result<Self, SignError> {
        check_kinds(&soup)?;
        let surface = Surface::new(&soup);
        Self::of_surface(soup, &surface, true)
    }

    /// Prepares the winding numbers of a surface. Unless `has_tree`, it has no tree of its own, and all methods need
    /// rays.
    pub(super) fn of_surface(soup: S, surface: &Surface, has_tree: bool) -> Result<Self, SignError> {
        let rays = has_tree.then(|| TreeIndex::new(soup.clone())).transpose()?;
        let caps = if surface.boundary.is_empty() {
            None
        } else {
            let caps = caps(&soup, surface);
            Some(Box::new(Caps { angles: SolidAngles::new(&caps), rays: TreeIndex::new(caps)? }))
        };
        Ok(Self { soup, rays, caps })
    }

    /// Returns the winding number of a point, within the accuracy.
    ///
    /// It is 1 inside of a closed surface whose fronts are outside, 0 outside, and in between near holes. Triangles of
    /// opposite orientations count with opposite signs. The number of a surface without a boundary is an exact integer,
    /// whatever the accuracy. A point that is not finite has the number NaN.
    ///
    /// # Accuracy
    /// The error is at most `accuracy`, unless rounding errors exceed it: about 1e-14 for each triangle of the caps
    /// that is summed up exactly, and up to 4e-15 l / d at the distance d from a boundary edge of the length l.
    #[must_use]
    pub fn number(&self, query: &Point3<f64>, accuracy: f64) -> f64 {
        self.number_by(query, accuracy, None::<&dyn RayQuery<f64>>)
    }

    pub(super) fn number_by<T: Real>(&self, query: &Point3<f64>, accuracy: f64, rays: Option<&dyn RayQuery<T>>) -> f64 {
        if query.iter().any(|x| !x.is_finite()) {
            return f64::NAN;
        }
        self.estimate(query, rays, |estimate| estimate.error <= accuracy).value
    }

    /// Returns the winding number of a point as the sum over all triangles.
    ///
    /// # Accuracy
    /// The rounding error is about 1e-14 per triangle (observed), and more at an edge, as for [`number`](Self::number).
    ///
    /// # Complexity
    /// O(n).
    #[must_use]
    pub fn sum(&self, query: &Point3<f64>) -> f64 {
        sum_of_all(&self.soup, query).value
    }

    /// Estimates the winding number of a finite point, until `is_enough` accepts the estimate or it is as good as it
    /// gets.
    fn estimate<T: Real>(
        &self,
        query: &Point3<f64>,
        rays: Option<&dyn RayQuery<T>>,
        is_enough: impl Fn(Estimate) -> bool,
    ) -> Estimate {
        let crossings = self.crossings(query, rays);
        let Some(angles) = self.solid_angles() else { return Estimate::ZERO.complement(crossings) };
        match angles.estimate(query, |caps| is_enough(caps.complement(crossings))) {
            Some(caps) => caps.complement(crossings),
            // The query is on an edge of a cap.
            None => sum_of_all(&self.soup, query),
        }
    }

    /// Returns the signed number of crossings of a ray from a point with the surface and its caps. The surface is
    /// searched by `rays`, if it is given.
    pub(super) fn crossings<T: Real>(&self, query: &Point3<f64>, rays: Option<&dyn RayQuery<T>>) -> i64 {
        let ray = ray(query);
        let crossings = self.hits(&ray, Hits::crossings(), rays).signed_count;
        crossings + self.caps.as_ref().map_or(0, |caps| caps.rays.signed_crossings(&ray))
    }

    /// Returns the sign of a point that is not on the surface.
    pub(crate) fn sign<T: Real>(&self, query: &Point3<f64>, rays: Option<&dyn RayQuery<T>>) -> Sign {
        let estimate = self.estimate(query, rays, Estimate::is_decided);
        if estimate.is_decided() { estimate.sign() } else { Sign::Undefined }
    }

    /// Returns the common sign of all points of a ball that the surface does not cross, or `None` if they may differ.
    pub(super) fn sign_in_ball<T: Real>(
        &self,
        radius: f64,
        centre: &Point3<f64>,
        rays: Option<&dyn RayQuery<T>>,
    ) -> Option<Sign> {
        let crossings = self.crossings(centre, rays);
        let Some(angles) = self.solid_angles() else { return Some(Estimate::ZERO.complement(crossings).sign()) };
        let estimate = |local: &Local| local.estimate().complement(crossings);
        // Triangles that are near may have any solid angle in the ball.
        let is_enough = |local: &Local| !local.is_whole() || estimate(local).is_decided();
        let mut local = angles.local(angles.point(centre), radius)?;
        angles.refine(&mut local, is_enough);
        (local.is_whole() && estimate(&local).is_decided()).then(|| estimate(&local).sign())
    }

    /// Returns the solid angles of the caps, if there are any.
    pub(super) fn solid_angles(&self) -> Option<&SolidAngles> {
        self.caps.as_ref().map(|caps| &caps.angles)
    }

    pub(super) fn is_closed(&self) -> bool {
        self.caps.is_none()
    }

    /// Returns the hits of a ray on the surface, which is searched by `rays`, if it is given.
    pub(super) fn hits<'r, T: Real>(
        &self,
        ray: &'r Ray,
        mut hits: Hits<'r>,
        rays: Option<&dyn RayQuery<T>>,
    ) -> Hits<'r> {
        match (rays, &self.rays) {
            (Some(rays), _) => rays.search_ray(ray, &mut hits),
            (None, Some(tree)) => tree.search_ray(ray, &mut hits),
            (None, None) => {}
        }
        hits
    }
}

impl Estimate {
    pub(super) const ZERO: Self = Self { value: 0.0, error: 0.0 };

    /// Returns the winding number of a surface, given this sum over its caps and the number of crossings with both.
    #[allow(clippy::cast_precision_loss, reason = "there are fewer than 2^30 crossings")]
    pub(super) fn complement(self, crossings: i64) -> Self {
        Self { value: crossings as f64 - self.value, ..self }
    }

    /// Returns whether the number is certainly above a half in magnitude, or certainly below it.
    pub(super) fn is_decided(self) -> bool {
        (self.value.abs() - 0.5).abs() > self.error
    }

    /// Returns the sign of a number that is decided.
    pub(super) fn sign(self) -> Sign {
        if self.value.abs() > 0.5 { Sign::Inside } else { Sign::Outside }
    }
}
