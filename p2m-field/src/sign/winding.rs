//! Generalised winding numbers, by rays and caps.
//!
//! The winding number of triangles around a point is the sum of their solid angles divided by 4 pi \[Jacobson2013\].
//! For a closed surface it is an integer, which the crossings of one ray decide without rounding. A surface with a
//! boundary is closed by caps, whose solid angles are subtracted again (the module `caps`).

use super::caps::caps;
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
    /// O(n log n) time. Memory is 60 bytes for each triangle and 300 bytes for each edge of the boundary.
    pub fn new(soup: S) -> Result<Self, SignError> {
        check_kinds(&soup)?;
        let surface = Surface::new(&soup);
        Self::of_surface(soup, &surface, true)
    }

    /// Without a tree of its own, all methods need rays.
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
    /// The error is at most `accuracy`, unless rounding errors exceed it: about 1e-14 for each triangle of the caps that is
    /// summed up exactly, and up to 4e-15 l / d at the distance d from a boundary edge of the length l.
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
    /// The rounding error is about 1e-14 for each triangle (observed), and more at an edge, as for [`number`](Self::number).
    ///
    /// # Complexity
    /// O(n).
    #[must_use]
    pub fn sum(&self, query: &Point3<f64>) -> f64 {
        sum_of_all(&self.soup, query).value
    }

    /// Returns an estimate of the winding number of a finite point that is enough, or as good as it gets.
    fn estimate<T: Real>(
        &self,
        query: &Point3<f64>,
        rays: Option<&dyn RayQuery<T>>,
        is_enough: impl Fn(Estimate) -> bool,
    ) -> Estimate {
        #[allow(clippy::cast_precision_loss, reason = "there are fewer than 2^30 crossings")]
        let whole = self.crossings(query, rays) as f64;
        let Some(caps) = &self.caps else { return Estimate { value: whole, error: 0.0 } };
        let less = |caps: Estimate| Estimate { value: whole - caps.value, error: caps.error };
        match caps.angles.estimate(query, |caps| is_enough(less(caps))) {
            Some(estimate) => less(estimate),
            // The query is on an edge of a cap.
            None => sum_of_all(&self.soup, query),
        }
    }

    /// Returns the signed number of crossings of a ray from a point with the surface and its caps. The surface is that
    /// of `rays`, if there are any.
    pub(super) fn crossings<T: Real>(&self, query: &Point3<f64>, rays: Option<&dyn RayQuery<T>>) -> i64 {
        let ray = ray(query);
        let crossings = self.hits(&ray, Hits::crossings(), rays).signed_count;
        crossings + self.caps.as_ref().map_or(0, |caps| caps.rays.signed_crossings(&ray))
    }

    /// Returns the sign of a point that is not on the surface.
    pub(crate) fn sign<T: Real>(&self, query: &Point3<f64>, rays: Option<&dyn RayQuery<T>>) -> Sign {
        let estimate = self.estimate(query, rays, Estimate::is_decided);
        match estimate.is_decided() {
            true if estimate.value.abs() > 0.5 => Sign::Inside,
            true => Sign::Outside,
            false => Sign::Undefined,
        }
    }

    /// Returns the common sign of all points that a path of at most the length `path`, within `radius` of a point and
    /// without crossing the surface, connects with the point. It is `None` if they may differ.
    pub(super) fn sign_along<T: Real>(
        &self,
        path: f64,
        radius: f64,
        point: &Point3<f64>,
        rays: Option<&dyn RayQuery<T>>,
    ) -> Option<Sign> {
        let change = self.max_change(path, radius, point);
        if change >= 0.5 {
            return None;
        }
        let is_clear = |estimate: Estimate| (estimate.value.abs() - 0.5).abs() > estimate.error + change;
        let estimate = self.estimate(point, rays, is_clear);
        is_clear(estimate).then(|| if estimate.value.abs() > 0.5 { Sign::Inside } else { Sign::Outside })
    }

    /// Returns an upper bound on the change of winding numbers along a path that does not cross the surface, has at
    /// most the length `path`, and is within `radius` of a point. A change that may be a half is infinite.
    fn max_change(&self, path: f64, radius: f64, point: &Point3<f64>) -> f64 {
        self.caps.as_ref().map_or(0.0, |caps| caps.angles.max_change(path, radius, point, 0.5))
    }

    pub(super) fn is_closed(&self) -> bool {
        self.caps.is_none()
    }

    /// Returns the hits of a ray on the surface, which is that of `rays`, if there are any.
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
    /// Returns whether the number is certainly above a half in magnitude, or certainly below it.
    fn is_decided(self) -> bool {
        (self.value.abs() - 0.5).abs() > self.error
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sign::surface::Surface;
    use p2m_core::{BruteForce, ClosestPoint};
    use p2m_mixed::generate::{IcoSphere, TorusKnot, ico_sphere, torus_knot};
    use p2m_testkit::vector;
    use rand::RngExt;

    #[test]
    fn winding_numbers_change_by_at_most_their_bound() {
        let knot = torus_knot(&TorusKnot::default()).expect("valid");
        assert!(Surface::new(&knot).boundary.is_empty());
        let ball = ico_sphere(&IcoSphere { frequency: 8 }).expect("valid");
        let low = |t: &[u32; 3]| t.iter().all(|i| ball.positions()[*i as usize].x <= 0.0);
        let half = ball.triangles().iter().filter(|t| low(t)).copied().collect();
        let half = Soup::from_triangles(ball.positions().to_vec(), half).expect("valid");
        // One triangle is missing, and another one is duplicated.
        let mut rest = knot.triangles()[1..].to_vec();
        rest.push(rest[500]);
        let holes = Soup::from_triangles(knot.positions().to_vec(), rest).expect("valid");
        for (soup, edges, name) in [(half, 24, "half a ball"), (holes, 6, "a hole")] {
            let surface = Surface::new(&soup);
            let found = surface.boundary.len();
            assert!(found == edges || name == "half a ball" && found > 10, "{name}: {found} edges");
            let winding = WindingNumbers::new(&soup).expect("triangles");
            let surface = BruteForce::new(&soup).expect("valid");
            let (mut bounded, mut largest) = (0, 0.0f64);
            let cases = p2m_testkit::cases(2000, 60);
            for case in cases.clone() {
                let mut rng = p2m_testkit::rng(name, case);
                let centre = Point3::from(vector(&mut rng) * 1.5);
                let radius = surface.closest_point(&centre).expect("not empty").distance * rng.random_range(0.01..0.99);
                let bound = winding.max_change(radius, radius, &centre);
                if bound >= 0.5 {
                    continue;
                }
                bounded += 1;
                let other = centre + vector(&mut rng).normalize() * radius;
                let change = (winding.sum(&other) - winding.sum(&centre)).abs();
                assert!(change <= bound + 1e-9, "{name}, case {case}: {change} for {bound}");
                largest = largest.max(change / bound);
            }
            println!("{name}: {bounded} are bounded, at most {largest:.2} of the bound");
            let is_decisive = cases.have_more_than(500, bounded) && (cases.is_replay() || largest > 0.005);
            assert!(is_decisive, "{name}: {bounded} are bounded, {largest}");
        }
    }
}
