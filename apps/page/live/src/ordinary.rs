//! The closest point in ordinary f32 arithmetic, with which the page compares p2m: the textbook formulas in the
//! coordinates of the scene, and the distance from the rounded closest point.

use p2m::nalgebra::{Point3, Vector3};
use p2m::{Element, Soup};

/// Returns the closest point of a scene, found by trying all primitives.
pub(crate) fn closest_point(soup: &Soup<f32>, query: &Point3<f32>) -> Option<(Point3<f32>, f32)> {
    let distances = soup.elements().map(|element| {
        let vertex = |i: u32| soup.positions()[i as usize];
        let point = match element {
            Element::Point(a) => vertex(a),
            Element::Segment([a, b]) => on_segment(vertex(a), vertex(b), query),
            Element::Triangle(triangle) => on_triangle(triangle.map(vertex), query),
        };
        (point, (query - point).norm())
    });
    distances.min_by(|a, b| a.1.total_cmp(&b.1))
}

fn on_segment(a: Point3<f32>, b: Point3<f32>, query: &Point3<f32>) -> Point3<f32> {
    let along = b - a;
    let square = along.norm_squared();
    let t = if square > 0.0 { ((query - a).dot(&along) / square).clamp(0.0, 1.0) } else { 0.0 };
    a + along * t
}

fn on_triangle([a, b, c]: [Point3<f32>; 3], query: &Point3<f32>) -> Point3<f32> {
    let normal: Vector3<f32> = (b - a).cross(&(c - a));
    let is_inside = |from: Point3<f32>, to: Point3<f32>| normal.dot(&(to - from).cross(&(query - from))) >= 0.0;
    let square = normal.norm_squared();
    if square > 0.0 && is_inside(a, b) && is_inside(b, c) && is_inside(c, a) {
        return query - normal * ((query - a).dot(&normal) / square);
    }
    let edges = [(a, b), (b, c), (c, a)].map(|(from, to)| on_segment(from, to, query));
    edges.into_iter().min_by(|p, q| (query - p).norm().total_cmp(&(query - q).norm())).unwrap_or(a)
}
