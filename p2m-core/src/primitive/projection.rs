//! The projection of a query onto a primitive.

use super::feature::Feature;
use crate::Real;
use crate::kernel::{Key, Nearest, triangle as plain_kernel};
use crate::real::to_f64_array;
use nalgebra::Point3;

/// The nearest point of one primitive, before it is rounded to the scalar of the scene.
///
/// All numbers are in f64 and in units of the scene, for both scalars.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projection {
    /// The squared length of the offset from the query, by which primitives are compared.
    pub key: Key,
    /// The nearest point.
    pub point: Point3<f64>,
    /// The feature of lowest dimension that contains the nearest point.
    pub feature: Feature,
    /// The weights of the vertices of the primitive. They are >= 0 and add up to 1 within 4 u; unused ones are 0.
    pub barycentric: [f64; 3],
    /// A bound on the error of [`Key::distance`], apart from one smallest subnormal.
    pub error: f64,
}

impl Projection {
    /// Creates the projection of a primitive of your own, from the query and its nearest point.
    ///
    /// The key is computed from `point - query`, componentwise, so it is never less than the lower bound of a box that
    /// contains `point`. `error` is your bound on the error of the distance; certified lower bounds are only as good as
    /// this bound.
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
        let key = Key::from_offset(std::array::from_fn(|k| point[k] - q[k]));
        Self { key, point, feature, barycentric, error }
    }

    /// Projects onto a triangle that is probably near. The function is inlined and skips the test of the triangle's
    /// box. It returns `None` if the key certainly exceeds `square`.
    #[inline(always)]
    #[doc(hidden)]
    pub fn onto_near_triangle(query: [f64; 3], vertices: &[[f64; 3]; 3], square: f64) -> Option<Self> {
        Some(Self::from_nearest(&plain_kernel::near_triangle(query, *vertices, square)?, query, vertices))
    }

    /// Projects onto a triangle. It returns `None` if the key certainly exceeds `square`.
    #[inline(always)]
    #[doc(hidden)]
    pub fn onto_triangle(query: [f64; 3], vertices: &[[f64; 3]; 3], square: f64) -> Option<Self> {
        Some(Self::from_nearest(&plain_kernel::triangle(query, *vertices, square)?, query, vertices))
    }

    /// Projects onto a segment. It returns `None` if the key certainly exceeds `square`.
    #[inline(always)]
    #[doc(hidden)]
    pub fn onto_segment(query: [f64; 3], vertices: &[[f64; 3]; 2], square: f64) -> Option<Self> {
        Some(Self::from_nearest(&plain_kernel::segment(query, *vertices, square)?, query, vertices))
    }

    /// Projects onto a point. It returns `None` if the key certainly exceeds `square`.
    #[inline(always)]
    #[doc(hidden)]
    pub fn onto_point(query: [f64; 3], vertex: &[[f64; 3]; 1], square: f64) -> Option<Self> {
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
