//! Rays: which primitives a ray meets, and where.
//!
//! A [`Ray`] is asked of an index by [`RayQuery`]. Whether it meets a primitive is decided without rounding, and the
//! parameter of a hit is the exact one rounded to the nearest f64; so all backends answer the same bits, and the least
//! parameter belongs to the first hit.

#![allow(clippy::float_cmp, reason = "nothing here has a tolerance")]

mod collector;
mod crossing;
mod exact;
mod line;
mod plane;
mod stats_collector;

pub use collector::{Hits, RayCollector};
pub use crossing::{Crossing, Hit, RayHit, Side};
pub use line::{Ray, RayError};
pub use stats_collector::RayStatsCollector;

pub use exact::foot;

use crate::kernel::power_of_two;
use crate::{BruteForce, PrimitiveId, PrimitiveSet, Real};
use std::ops::ControlFlow;

/// More than what products, and parameters, may lack that underflow, in parts of what they are multiplied with.
pub const TINY: f64 = power_of_two(-1000);

/// What a ray meets of a scene. A backend writes one method, [`search_ray`](Self::search_ray).
///
/// # Contract
///
/// - **Exact**: triangles, segments and points are closed sets, and whether the line of the ray meets one is decided
///   without rounding, for all finite scenes and rays. There is no tolerance, and nothing slips through between two
///   triangles that share an edge or a vertex.
/// - **Parameter**: the exact parameter of a hit, rounded to the nearest f64. A hit counts if *that* lies in the closed
///   range of the ray: ranges that follow one another ([t0, t1], [t1.next_up(), t2], ..) share the hits of a line out
///   among them.
/// - **Shared edges and vertices**: a hit there is one for each primitive that it belongs to, with equal parameters.
///   [`crossings`](Self::crossings) counts it as often as the surface is crossed.
/// - **In the plane of a triangle**: the ray touches it along a stretch, and hits it at the least parameter of that in
///   its range. A triangle without area is the segment or the point that it spans.
/// - **Segments and points** are met exactly, or within the radius of the ray: then the hit is where the line is nearest
///   to the primitive, which has to be in the range.
/// - **Order**: by parameter; of equal parameters the lowest id comes first.
/// - **Agreement**: every backend finds the same hits with the same bits. Only which hit is
///   [any](Self::any_intersection) depends on the backend.
///
/// A primitive of your own answers by [`Primitive::intersect_ray`](crate::Primitive::intersect_ray). It is no part of a
/// surface that is crossed.
///
/// ```
/// use nalgebra::{Point3, Vector3};
/// use p2m_core::{BruteForce, Ray, RayQuery, Triangle};
///
/// let square = [
///     Triangle::new(Point3::new(0.0, 0.0, 0.0), Point3::new(2.0, 0.0, 0.0), Point3::new(2.0, 2.0, 0.0)),
///     Triangle::new(Point3::new(0.0, 0.0, 0.0), Point3::new(2.0, 2.0, 0.0), Point3::new(0.0, 2.0, 0.0)),
/// ];
/// let index = BruteForce::new(&square).unwrap();
/// // Through the diagonal, which both have.
/// let ray = Ray::new(&Point3::new(1.0, 1.0, 3.0), &Vector3::new(0.0, 0.0, -1.0)).unwrap();
/// let first = index.first_intersection(&ray).unwrap();
/// assert_eq!((first.primitive.index(), first.parameter), (0, 3.0));
/// assert_eq!(index.all_intersections(&ray).len(), 2);
/// assert_eq!(index.crossings(&ray), 1);
/// ```
///
/// # Complexity
/// O(n) for brute force; expected O(log n + k) for trees and k hits that are wanted.
///
/// # References
/// The functions are those of the trees of CGAL (manual of its k-DOP tree, section Ray Intersection).
pub trait RayQuery<T: Real> {
    /// Offers to `hits` every hit that it could want.
    fn search_ray<'r>(&self, ray: &'r Ray, hits: &mut Hits<'r>);

    /// Whether the ray meets anything.
    fn do_intersect(&self, ray: &Ray) -> bool {
        let mut hits = Hits::any();
        self.search_ray(ray, &mut hits);
        hits.one.is_some()
    }

    /// Some hit, if there is one: the one that is found first.
    fn any_intersection(&self, ray: &Ray) -> Option<Hit> {
        let mut hits = Hits::any();
        self.search_ray(ray, &mut hits);
        hits.one.map(|(id, crossing)| crossing.hit(id))
    }

    /// The hit with the least parameter, and of equal ones that with the lowest id. Parameters are equal if they round to
    /// the same f64: beyond its range they are all infinite.
    fn first_intersection(&self, ray: &Ray) -> Option<Hit> {
        let mut hits = Hits::first();
        self.search_ray(ray, &mut hits);
        hits.one.map(|(id, crossing)| crossing.hit(id))
    }

    /// All hits, one for each primitive that is met, in the order of their parameters and then of ids.
    fn all_intersections(&self, ray: &Ray) -> Vec<Hit> {
        let mut hits = Hits::all();
        self.search_ray(ray, &mut hits);
        hits.sorted()
    }

    /// How many primitives are met.
    fn count(&self, ray: &Ray) -> usize {
        let mut hits = Hits::count();
        self.search_ray(ray, &mut hits);
        hits.count
    }

    /// How often the ray crosses the surface that the triangles make, as if it were moved aside by an infinitely small
    /// amount (along x, by a still smaller one along y, and one along z), the same for all triangles: it then passes
    /// beside all edges and vertices, and touches nothing. So the number for a line is even for every closed surface,
    /// and that for a ray is odd where it begins inside. A triangle counts if the line, moved aside, crosses it, and the
    /// parameter of its plane is in the range: a ray that begins on a triangle begins just before it.
    ///
    /// Segments and points are no surface, nor are triangles without area.
    ///
    /// # References
    /// Simulation of simplicity \[Edelsbrunner1990\].
    fn crossings(&self, ray: &Ray) -> usize {
        let mut hits = Hits::crossings();
        self.search_ray(ray, &mut hits);
        hits.count
    }
}

impl<T: Real, S: PrimitiveSet<T>> RayQuery<T> for BruteForce<S> {
    fn search_ray<'r>(&self, ray: &'r Ray, hits: &mut Hits<'r>) {
        let only_crossings = hits.only_crossings();
        let _ = (0..self.set().len()).map(PrimitiveId::new).try_for_each(|id| {
            match Crossing::of(&self.set().get(id), ray, hits.limit(), only_crossings) {
                Some(crossing) => hits.offer(id, &crossing),
                None => ControlFlow::Continue(()),
            }
        });
    }
}
