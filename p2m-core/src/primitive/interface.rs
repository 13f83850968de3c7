//! The trait of primitives.

use super::box_intersection;
use super::projection::Projection;
use crate::{Aabb, Ray, RayHit, Real};
use nalgebra::Point3;

/// A primitive: a set of points that has a nearest point to any query.
///
/// [`Point`](crate::Point), [`Segment`](crate::Segment), [`Triangle`](crate::Triangle) and [`Shape`](crate::Shape) meet
/// the whole contract of [`ClosestPoint`](crate::ClosestPoint). For a primitive of your own, every index of this
/// project still finds the primitive with the smallest key, lowest id first, and agrees bitwise with
/// [`BruteForce`](crate::BruteForce) (N3, and N6 for totality), provided that
///
/// - `project` is a pure function that returns for every finite query, and
/// - its point lies in `aabb()`, and its key is computed by [`Projection::new`].
///
/// N1, N2 and N5 (accuracy) then hold with your own `error` in place of 8 u M, and N4 (invariance) as far as your
/// arithmetic guarantees it. Use a tree for such primitives: the lists of `P2mIndex` contain triangles, segments and
/// points only.
///
/// ```
/// use p2m_core::{Aabb, BruteForce, ClosestPoint, Feature, Primitive, Projection, Ray, RayHit, check_primitive};
/// use nalgebra::Point3;
///
/// struct Ball { centre: Point3<f64>, radius: f64 }
///
/// impl Primitive<f64> for Ball {
///     fn aabb(&self) -> Aabb<f64> {
///         let r = nalgebra::Vector3::repeat(self.radius);
///         Aabb::from_points(&[self.centre - r, self.centre + r])
///     }
///     fn project(&self, query: &Point3<f64>) -> Projection {
///         let v = query - self.centre;
///         let point = if v.norm() <= self.radius { *query } else { self.centre + v * (self.radius / v.norm()) };
///         let point = self.aabb().clamp(point);
///         Projection::new(query, point, Feature::Face, [1.0, 0.0, 0.0], 1e-15 * (v.norm() + self.radius))
///     }
///     fn intersect_ray(&self, _: &Ray) -> Option<RayHit> {
///         unreachable!("no rays are cast at this scene")
///     }
/// }
///
/// let ball = |x, radius| Ball { centre: Point3::new(x, 0.0, 0.0), radius };
/// let scene = [ball(0.0, 1.0), ball(5.0, 2.0)];
/// let answer = BruteForce::new(&scene).unwrap().closest_point(&Point3::new(2.5, 0.0, 0.0)).unwrap();
/// assert_eq!(answer.primitive.index(), 1);
/// check_primitive(&scene[0], &[Point3::origin(), Point3::new(0.0, 3.0, 1.0), Point3::new(-9.0, 0.5, 0.0)]).unwrap();
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a primitive with coordinates of type `{T}`",
    note = "primitives are `Triangle<{T}>`, `Segment<{T}>`, `Point<{T}>`, `Shape<{T}>` and types of your own"
)]
pub trait Primitive<T: Real> {
    /// Returns the smallest box that contains the primitive. It is not finite if a coordinate is not.
    fn aabb(&self) -> Aabb<T>;

    /// Returns the nearest point to a finite query.
    fn project(&self, query: &Point3<T>) -> Projection;

    /// Returns the nearest point, or `None` if its key certainly exceeds `square`.
    ///
    /// A search passes the square above which it would prune, so a primitive with a cheap bound can save the work. The
    /// default calls [`project`](Self::project).
    #[inline]
    fn project_within(&self, query: &Point3<T>, square: f64) -> Option<Projection> {
        let _ = square;
        Some(self.project(query))
    }

    /// Returns the one to three vertices of a primitive that *is* the [`Point`](crate::Point),
    /// [`Segment`](crate::Segment) or [`Triangle`](crate::Triangle) of these vertices.
    ///
    /// Indexes then filter it by more than its box, and may evaluate that shape instead of calling `project`. The
    /// default returns no vertices, which is right for a primitive whose `project` differs from the shape's in any bit.
    fn vertices(&self) -> &[Point3<T>] {
        &[]
    }

    /// Returns whether the primitive has a point in a closed box, for [`BoxQuery`](crate::BoxQuery).
    ///
    /// It is exact for the primitives of this project. The default tests the box of the primitive, so it may also
    /// return `true` for a primitive that misses the box, but never `false` for one that intersects it.
    fn intersects_box(&self, bounds: &Aabb<T>) -> bool {
        match self.vertices() {
            [] => !bounds.is_empty() && bounds.intersects(&self.aabb()),
            vertices => box_intersection::intersects_box(vertices, bounds),
        }
    }

    /// Returns the hit of a ray on a primitive that has no [`vertices`](Self::vertices).
    ///
    /// It has to be a pure function. The point lies in `aabb()` and the parameter in the range of the ray. Rays miss a
    /// primitive that returns `None`, so there is no default: a program that casts no rays may write `unreachable!()`.
    /// Primitives with vertices are hit as the contract of [`RayQuery`](crate::RayQuery) says, and this method is not
    /// called for them.
    fn intersect_ray(&self, ray: &Ray) -> Option<RayHit>;

    /// Returns whether all coordinates are finite.
    #[inline(always)]
    fn is_finite(&self) -> bool {
        self.aabb().is_finite()
    }
}

impl<T: Real, P: Primitive<T>> Primitive<T> for &P {
    #[inline(always)]
    fn aabb(&self) -> Aabb<T> {
        (*self).aabb()
    }
    #[inline(always)]
    fn project(&self, query: &Point3<T>) -> Projection {
        (*self).project(query)
    }
    #[inline(always)]
    fn project_within(&self, query: &Point3<T>, square: f64) -> Option<Projection> {
        (*self).project_within(query, square)
    }
    #[inline(always)]
    fn vertices(&self) -> &[Point3<T>] {
        (*self).vertices()
    }
    fn intersects_box(&self, bounds: &Aabb<T>) -> bool {
        (*self).intersects_box(bounds)
    }
    fn intersect_ray(&self, ray: &Ray) -> Option<RayHit> {
        (*self).intersect_ray(ray)
    }
    #[inline(always)]
    fn is_finite(&self) -> bool {
        (*self).is_finite()
    }
}
