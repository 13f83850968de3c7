//! The crate bvh as a backend. The crate has the tree and the search, and its user has to compute the distance to a
//! primitive.

use crate::backend::{Answer, BenchIndex, BoxedIndex, Prepared, Unavailable};
use crate::scene::Scene;
use bvh::aabb::{Aabb, Bounded};
use bvh::bounding_hierarchy::BHShape;
use bvh::bvh::Bvh;
use bvh::point_query::PointDistance;
use nalgebra::Point3;
use p2m_core::{PrimitiveId, PrimitiveSet, Shape};

/// A primitive with the index of its node, as the crate requires.
struct Primitive {
    shape: Shape<f64>,
    node: usize,
}

impl Bounded<f64, 3> for Primitive {
    fn aabb(&self) -> Aabb<f64, 3> {
        self.shape.vertices().iter().fold(Aabb::empty(), |bounds, vertex| bounds.grow(vertex))
    }
}

impl BHShape<f64, 3> for Primitive {
    fn set_bh_node_index(&mut self, node: usize) {
        self.node = node;
    }
    fn bh_node_index(&self) -> usize {
        self.node
    }
}

impl PointDistance<f64, 3> for Primitive {
    #[inline(always)]
    fn distance_squared(&self, query: Point3<f64>) -> f64 {
        let nearest = match &self.shape {
            Shape::Triangle(triangle) => on_triangle(&query, &triangle.vertices),
            Shape::Segment(segment) => on_segment(&query, &segment.vertices),
            Shape::Point(point) => point.position,
            _ => unreachable!("a soup has no other shapes"),
        };
        (query - nearest).norm_squared()
    }
}

/// Returns the closest point of a segment.
fn on_segment(query: &Point3<f64>, [a, b]: &[Point3<f64>; 2]) -> Point3<f64> {
    let along = b - a;
    let (part, length) = (along.dot(&(query - a)), along.norm_squared());
    if part <= 0.0 {
        *a
    } else if part >= length {
        *b
    } else {
        a + along * (part / length)
    }
}

/// Returns the closest point of a triangle by the region of the query (Ericson, Real-Time Collision Detection, 5.1.5).
pub(crate) fn on_triangle(query: &Point3<f64>, [a, b, c]: &[Point3<f64>; 3]) -> Point3<f64> {
    let (ab, ac, ap) = (b - a, c - a, query - a);
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return *a;
    }
    let bp = query - b;
    let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
    if d3 >= 0.0 && d4 <= d3 {
        return *b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    let cp = query - c;
    let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
    if d6 >= 0.0 && d5 <= d6 {
        return *c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    let scale = 1.0 / (va + vb + vc);
    a + ab * (vb * scale) + ac * (vc * scale)
}

/// The tree and the primitives that it refers to.
struct Tree {
    tree: Bvh<f64, 3>,
    primitives: Vec<Primitive>,
}

/// Prepares the backend of the list. It copies the primitives, as a user of the crate has to, and builds on one thread.
#[allow(clippy::unnecessary_wraps, reason = "every backend is prepared by a function of this type")]
pub(crate) fn prepare(scene: &Scene) -> Result<Prepared, Unavailable> {
    let soup = &*scene.double;
    let shapes = (0..soup.len()).map(|i| soup.get(PrimitiveId::new(i)));
    let mut primitives: Vec<_> = shapes.map(|shape| Primitive { shape, node: 0 }).collect();
    let build = move || Ok(Box::new(Tree { tree: Bvh::build(&mut primitives), primitives }) as BoxedIndex);
    Ok(Prepared { build: Box::new(build), borrowed: 0 })
}

impl BenchIndex for Tree {
    type Scalar = f64;

    #[inline(always)]
    fn query(&self, query: &Point3<f64>) -> Answer {
        let found = self.tree.nearest_to(*query, &self.primitives);
        found.map_or(Answer::NONE, |(_, distance)| Answer { distance, id: u32::MAX })
    }
}
