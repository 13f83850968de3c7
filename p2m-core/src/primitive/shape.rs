//! A primitive of a mixed scene: a point, a segment or a triangle.

use super::interface::Primitive;
use super::point::Point;
use super::projection::Projection;
use super::segment::Segment;
use super::triangle::Triangle;
use crate::{Aabb, Ray, RayHit, Real};
use nalgebra::Point3;

/// One primitive of a mixed scene.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Shape<T: Real> {
    /// A primitive that is a point.
    Point(Point<T>),
    /// A primitive that is a segment.
    Segment(Segment<T>),
    /// A primitive that is a triangle.
    Triangle(Triangle<T>),
}

impl<T: Real> Shape<T> {
    /// Creates a point, a segment or a triangle from one to three vertices. It is `None` for any other number of
    /// vertices.
    #[must_use]
    pub fn from_vertices<P: Copy + Into<Point3<T>>>(vertices: &[P]) -> Option<Self> {
        match *vertices {
            [a] => Some(Self::Point(Point::new(a.into()))),
            [a, b] => Some(Self::Segment(Segment::new(a.into(), b.into()))),
            [a, b, c] => Some(Self::Triangle(Triangle::new(a.into(), b.into(), c.into()))),
            _ => None,
        }
    }

    /// Returns the one to three vertices.
    #[must_use]
    pub fn vertices(&self) -> &[Point3<T>] {
        match self {
            Self::Point(p) => std::slice::from_ref(&p.position),
            Self::Segment(s) => &s.vertices,
            Self::Triangle(t) => &t.vertices,
        }
    }
}

impl<T: Real> Primitive<T> for Shape<T> {
    #[inline(always)]
    fn aabb(&self) -> Aabb<T> {
        Aabb::from_points(self.vertices())
    }

    #[inline(always)]
    fn project(&self, query: &Point3<T>) -> Projection {
        self.project_within(query, f64::INFINITY).expect("no key exceeds infinity")
    }

    #[inline(always)]
    fn project_within(&self, query: &Point3<T>, square: f64) -> Option<Projection> {
        match self {
            Self::Point(p) => p.project_within(query, square),
            Self::Segment(s) => s.project_within(query, square),
            Self::Triangle(t) => t.project_within(query, square),
        }
    }

    #[inline(always)]
    fn vertices(&self) -> &[Point3<T>] {
        Self::vertices(self)
    }

    fn intersect_ray(&self, _: &Ray) -> Option<RayHit> {
        None
    }
}

impl<T: Real> From<Point<T>> for Shape<T> {
    fn from(point: Point<T>) -> Self {
        Self::Point(point)
    }
}

impl<T: Real> From<Segment<T>> for Shape<T> {
    fn from(segment: Segment<T>) -> Self {
        Self::Segment(segment)
    }
}

impl<T: Real> From<Triangle<T>> for Shape<T> {
    fn from(triangle: Triangle<T>) -> Self {
        Self::Triangle(triangle)
    }
}
