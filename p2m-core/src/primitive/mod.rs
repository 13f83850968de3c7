//! The primitives of a scene, and what a primitive of your own has to bring.

mod in_box;
mod point;
mod segment;
mod shape;
mod triangle;

pub use point::Point;
pub use segment::Segment;
pub use shape::Shape;
pub use triangle::Triangle;

use crate::kernel::{Key, Nearest, triangle as plain_kernel};
use crate::real::to_f64_array;
use crate::{Aabb, Ray, RayHit, Real};
use nalgebra::Point3;

/// The part of a primitive that holds its nearest point, by its number in that primitive: neighbours in a mesh have numbers
/// of their own.
///
/// A point has `Vertex(0)`; a segment `Vertex(0)`, `Vertex(1)` and `Edge(0)`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Feature {
    /// Vertex i.
    Vertex(u8),
    /// The inside of edge i, which runs from vertex i to vertex i + 1 (cyclically).
    Edge(u8),
    /// The inside of the face.
    Face,
}

impl std::fmt::Display for Feature {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Vertex(i) => write!(f, "vertex{i}"),
            Self::Edge(i) => write!(f, "edge{i}"),
            Self::Face => f.write_str("face"),
        }
    }
}

/// The nearest point of one primitive, before it is rounded to the scalar of the scene.
///
/// Everything is in f64 and in units of the scene, whatever its scalar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projection {
    /// What decides between primitives: the squared length of the offset from the query.
    pub key: Key,
    /// The nearest point.
    pub point: Point3<f64>,
    /// The lowest-dimensional feature that holds it.
    pub feature: Feature,
    /// Weights of the primitive's vertices, >= 0, adding up to 1 within 4 u; unused ones are 0.
    pub barycentric: [f64; 3],
    /// Bound on the error of [`Key::distance`], apart from one smallest subnormal.
    pub error: f64,
}

impl Projection {
    /// A projection for a primitive of your own, from the query and its nearest point.
    ///
    /// The key is computed from `point - query`, componentwise, which makes it never less than the lower bound of any
    /// box that contains `point`. `error` is your bound on how far the distance may be from the true one; certified
    /// lower bounds are as good as it is.
    ///
    /// ```
    /// use p2m_core::{Feature, Projection};
    /// use nalgebra::Point3;
    ///
    /// let p = Projection::new(&Point3::new(0.0f64, 3.0, 4.0), Point3::origin(), Feature::Face, [1.0, 0.0, 0.0], 0.0);
    /// assert_eq!(p.key.distance(), 5.0);
    /// ```
    #[must_use]
    pub fn new<T: Real>(
        query: &Point3<T>,
        point: Point3<f64>,
        feature: Feature,
        barycentric: [f64; 3],
        error: f64,
    ) -> Self {
        let q = to_f64_array(query);
        let key = Key::of_offset(std::array::from_fn(|k| point[k] - q[k]));
        Self { key, point, feature, barycentric, error }
    }

    /// The same as [`of_triangle`](Self::of_triangle) for one that is probably near.
    #[inline(always)]
    #[doc(hidden)]
    pub fn of_near_triangle(query: [f64; 3], vertices: &[[f64; 3]; 3], square: f64) -> Option<Self> {
        Some(Self::from_nearest(&plain_kernel::near_triangle(query, *vertices, square)?, query, vertices))
    }

    /// On a triangle, as the contract has it; `None` if its key certainly exceeds `square`.
    #[inline(always)]
    #[doc(hidden)]
    pub fn of_triangle(query: [f64; 3], vertices: &[[f64; 3]; 3], square: f64) -> Option<Self> {
        Some(Self::from_nearest(&plain_kernel::triangle(query, *vertices, square)?, query, vertices))
    }

    /// The same on a segment.
    #[inline(always)]
    #[doc(hidden)]
    pub fn of_segment(query: [f64; 3], vertices: &[[f64; 3]; 2], square: f64) -> Option<Self> {
        Some(Self::from_nearest(&plain_kernel::segment(query, *vertices, square)?, query, vertices))
    }

    /// The same on a point.
    #[inline(always)]
    #[doc(hidden)]
    pub fn of_point(query: [f64; 3], vertex: &[[f64; 3]; 1], square: f64) -> Option<Self> {
        Some(Self::from_nearest(&plain_kernel::point(query, vertex[0], square)?, query, vertex))
    }

    #[inline(always)]
    fn from_nearest<const N: usize>(nearest: &Nearest, query: [f64; 3], vertices: &[[f64; 3]; N]) -> Self {
        Self {
            key: nearest.key,
            point: Point3::from(nearest.point(query, vertices)),
            feature: nearest.feature,
            barycentric: nearest.weights,
            error: nearest.error(),
        }
    }
}

/// Something that has a nearest point to any query.
///
/// [`Point`], [`Segment`], [`Triangle`] and [`Shape`] keep the whole contract of [`ClosestPoint`](crate::ClosestPoint).
/// For a primitive of your own, every index of this project still finds the primitive of the smallest key, lowest id
/// first, and agrees bitwise with [`BruteForce`](crate::BruteForce) (N3, and N6 for totality), provided that
///
/// - `project` is a pure function that returns for every finite query,
/// - its point lies in `aabb()`, and its key is made by [`Projection::new`].
///
/// N1, N2 and N5 (accuracy) then hold with your own `error` in place of 4 u M, N4 (invariance) as far as your
/// arithmetic has it.
///
/// ```
/// use p2m_core::{Aabb, BruteForce, ClosestPoint, Feature, Primitive, Projection};
/// use nalgebra::Point3;
///
/// struct Ball { centre: Point3<f64>, radius: f64 }
///
/// impl Primitive<f64> for Ball {
///     fn aabb(&self) -> Aabb<f64> {
///         let r = nalgebra::Vector3::repeat(self.radius);
///         Aabb::of_points(&[self.centre - r, self.centre + r])
///     }
///     fn project(&self, query: &Point3<f64>) -> Projection {
///         let v = query - self.centre;
///         let point = if v.norm() <= self.radius { *query } else { self.centre + v * (self.radius / v.norm()) };
///         let point = self.aabb().clamp(point);
///         Projection::new(query, point, Feature::Face, [1.0, 0.0, 0.0], 1e-15 * (v.norm() + self.radius))
///     }
/// }
///
/// let scene = [Ball { centre: Point3::origin(), radius: 1.0 }, Ball { centre: Point3::new(5.0, 0.0, 0.0), radius: 2.0 }];
/// let answer = BruteForce::new(&scene).unwrap().closest_point(&Point3::new(2.5, 0.0, 0.0)).unwrap();
/// assert_eq!(answer.primitive.index(), 1);
/// ```
pub trait Primitive<T: Real> {
    /// The smallest box that holds the primitive; not finite if a coordinate is not.
    fn aabb(&self) -> Aabb<T>;

    /// The nearest point to a finite query.
    fn project(&self, query: &Point3<T>) -> Projection;

    /// The nearest point, or `None` if its key certainly exceeds `square`: a search passes what it would prune above,
    /// and a primitive that can tell cheaply saves the work. `project` by default.
    #[inline]
    fn project_within(&self, query: &Point3<T>, square: f64) -> Option<Projection> {
        let _ = square;
        Some(self.project(query))
    }

    /// The one to three vertices of a primitive that *is* the [`Point`], [`Segment`] or [`Triangle`] of these: indexes
    /// then filter it by more than its box, and may ask that shape in its place. None by default; a primitive whose
    /// `project` differs from that shape's in any bit leaves it so.
    fn vertices(&self) -> &[Point3<T>] {
        &[]
    }

    /// Whether it has a point in a closed box, for [`BoxQuery`](crate::BoxQuery). Exact for the primitives of this
    /// project; by default, whether its own box does, which for a primitive of your own finds at least those that do.
    fn meets_box(&self, bounds: &Aabb<T>) -> bool {
        !bounds.is_empty() && bounds.meets(&self.aabb())
    }

    /// Where a ray meets a primitive that has no [`vertices`](Self::vertices): nowhere by default. A pure function; the
    /// point lies in `aabb()`, and the parameter is in the range of the ray, or there is no hit. Others are met where
    /// the contract of [`RayQuery`](crate::RayQuery) says.
    fn intersect_ray(&self, ray: &Ray) -> Option<RayHit> {
        let _ = ray;
        None
    }

    /// Whether all coordinates are finite.
    fn is_finite(&self) -> bool {
        self.aabb().is_finite()
    }
}

/// Nothing is beyond an infinite bound.
const UNBOUNDED: &str = "no key exceeds infinity";

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
    fn meets_box(&self, bounds: &Aabb<T>) -> bool {
        (*self).meets_box(bounds)
    }
    fn intersect_ray(&self, ray: &Ray) -> Option<RayHit> {
        (*self).intersect_ray(ray)
    }
    #[inline(always)]
    fn is_finite(&self) -> bool {
        (*self).is_finite()
    }
}
