//! Ray queries.

use super::collector::Hits;
use super::hit::Hit;
use super::line::Ray;
use crate::{PrimitiveId, Real};

/// Ray queries of a scene. A backend implements two methods, [`search_ray`](Self::search_ray) and
/// [`visit_ray_candidates`](Self::visit_ray_candidates).
///
/// # Contract
///
/// - **Exact**: triangles, segments and points are closed sets, and whether the line of the ray intersects one is
///   decided without rounding, for all finite scenes and rays. There is no tolerance, and no ray slips through between
///   two triangles that share an edge or a vertex.
/// - **Parameter**: the parameter of a hit is the exact one rounded to the nearest f64. A hit counts if the rounded
///   parameter lies in the closed range of the ray. So if consecutive ranges ([t0, t1], [t1.next_up(), t2], ..) cover a
///   line, each hit of the line is in one of them.
/// - **Shared edges and vertices**: a hit there counts once for each primitive that it belongs to, with equal
///   parameters. [`crossings`](Self::crossings) counts it as often as the surface is crossed.
/// - **In the plane of a triangle**: the ray runs along the triangle for an interval of parameters, and hits it at the
///   least one in its range. A triangle without area is the segment or the point that it spans.
/// - **Segments and points** are hit exactly, or within the radius of the ray. With a radius the hit is at the
///   parameter nearest to the primitive, which has to be in the range.
/// - **Order**: hits are ordered by parameter and then by id.
/// - **Agreement**: all backends find the same hits with the same bits. Only
///   [`any_intersection`](Self::any_intersection) may return different hits.
///
/// A primitive of your own answers by [`Primitive::intersect_ray`](crate::Primitive::intersect_ray). It is not part of
/// the surface, so it is never crossed.
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
/// Brute force takes O(n). Trees take expected O(log n + k) for k hits that are needed.
///
/// # References
/// The functions are modelled on the trees of CGAL (manual of its k-DOP tree, section Ray Intersection).
#[diagnostic::on_unimplemented(
    message = "`{Self}` answers no queries by rays with coordinates of type `{T}`",
    note = "`AabbTree`, `KdopTree` and `BruteForce` do; the octree and the P2M index answer closest-point queries only"
)]
pub trait RayQuery<T: Real> {
    /// Offers to `hits` every hit that it could need.
    fn search_ray<'r>(&self, ray: &'r Ray, hits: &mut Hits<'r>);

    /// Calls `visit` at most once for each primitive that the ray hits, or would hit if its origin were moved by up to
    /// its [error](Ray::with_origin_error). Other primitives may be visited as well.
    ///
    /// `visit` gets the id of a primitive, and its vertices if the search has them at hand; otherwise it gets no
    /// vertices. It returns the parameter above which hits are no longer needed; minus infinity ends the search. An
    /// index that is composed of other indexes uses this method to find the candidates in one of them.
    fn visit_ray_candidates(&self, ray: &Ray, visit: &mut dyn FnMut(PrimitiveId, &[[f64; 3]]) -> f64);

    /// Returns whether the ray hits any primitive.
    fn do_intersect(&self, ray: &Ray) -> bool {
        let mut hits = Hits::any();
        self.search_ray(ray, &mut hits);
        hits.one.is_some()
    }

    /// Returns the hit that is found first, or `None` if there is no hit.
    fn any_intersection(&self, ray: &Ray) -> Option<Hit> {
        let mut hits = Hits::any();
        self.search_ray(ray, &mut hits);
        hits.one.map(|(id, crossing)| crossing.hit(id))
    }

    /// Returns the hit with the least parameter. Ties go to the lowest id. Parameters are equal if they round to the
    /// same f64; all parameters beyond the range of f64 are infinite.
    fn first_intersection(&self, ray: &Ray) -> Option<Hit> {
        let mut hits = Hits::first();
        self.search_ray(ray, &mut hits);
        hits.one.map(|(id, crossing)| crossing.hit(id))
    }

    /// Returns all hits, one for each primitive that is hit, ordered by parameter and then by id.
    fn all_intersections(&self, ray: &Ray) -> Vec<Hit> {
        let mut hits = Hits::all();
        self.search_ray(ray, &mut hits);
        hits.sorted()
    }

    /// Returns the number of primitives that are hit.
    fn count(&self, ray: &Ray) -> usize {
        let mut hits = Hits::count();
        self.search_ray(ray, &mut hits);
        hits.count
    }

    /// Returns how often the ray crosses the surface that the triangles form.
    ///
    /// The ray is perturbed symbolically: it is moved by an infinitely small amount along x, a still smaller one along
    /// y and another one along z, the same for all triangles. It then avoids all edges and vertices. So the number is
    /// even for a line and every closed surface, and odd for a ray that begins inside of one. A triangle counts if the
    /// moved line crosses it and the parameter of its plane is in the range; a ray that begins on a triangle is taken
    /// to begin just before it. Segments, points and triangles without area are not part of the surface.
    ///
    /// # References
    /// The perturbation is the simulation of simplicity \[Edelsbrunner1990\].
    fn crossings(&self, ray: &Ray) -> usize {
        let mut hits = Hits::crossings();
        self.search_ray(ray, &mut hits);
        hits.count
    }

    /// Returns the number of crossings from the back of a triangle to its front minus the number from front to back.
    /// Crossings are counted as in [`crossings`](Self::crossings).
    ///
    /// For a closed surface whose neighbouring triangles have the same orientation, this is the winding number of the
    /// origin of the ray, whatever its direction: 1 in a surface whose fronts are outside, and 2 where two such
    /// surfaces overlap.
    fn signed_crossings(&self, ray: &Ray) -> i64 {
        let mut hits = Hits::crossings();
        self.search_ray(ray, &mut hits);
        hits.signed_count
    }
}
