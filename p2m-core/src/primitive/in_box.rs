//! Whether a primitive meets a box, exactly.
//!
//! Two convex polytopes are disjoint iff one of these directions separates them: a face normal of either, or the cross
//! product of an edge of each (separating-axis theorem [Gottschalk1996]). For a box those are the axes (the box of the
//! primitive decides), the normal of the triangle (signs of [`orientation_3d`] at two corners), and an edge against an
//! axis. In the projection along that axis the latter is the line through the edge against a rectangle, of which the
//! two extreme corners matter: signs of [`orientation_2d`]. So nothing is ever rounded.
//!
//! The box is first cut down to that of the primitive, which changes no answer: numbers get smaller, and a box may be
//! infinite.

use crate::predicates::{orientation_2d, orientation_3d};
use crate::real::to_f64_array;
use crate::{Aabb, Real};
use nalgebra::Point3;
use std::cmp::Ordering::{self, Equal, Greater, Less};

/// Whether the hull of one to three finite vertices has a point in the closed box; false for an empty or NaN box.
pub(super) fn meets<T: Real, const N: usize>(vertices: &[Point3<T>; N], bounds: &Aabb<T>) -> bool {
    let own = Aabb::of_points(vertices);
    // A box that is empty on one axis need not look it next to the primitive.
    if bounds.is_empty() || !bounds.meets(&own) {
        return false;
    }
    let holds = |p: &Point3<T>| bounds.contains(&Aabb { min: *p, max: *p });
    if vertices.iter().any(holds) {
        return true;
    }
    let part = bounds.intersection(&own);
    let corners = [to_f64_array(&part.min), to_f64_array(&part.max)];
    let vertices = vertices.each_ref().map(to_f64_array);
    match *vertices.as_slice() {
        [a, b] => (0..3).all(|axis| !line_separates(axis, a, b, Equal, &corners)),
        [a, b, c] => triangle_meets([a, b, c], &corners),
        _ => false, // a point that the box does not hold
    }
}

fn triangle_meets([a, b, c]: [[f64; 3]; 3], corners: &[[f64; 3]; 2]) -> bool {
    // The components of the normal are twice the areas of the projections.
    let normal: [Ordering; 3] = std::array::from_fn(|axis| {
        let [a, b, c] = [a, b, c].map(|p| project(axis, p));
        orientation_2d(a, b, c)
    });
    let edges = [[a, b], [b, c], [c, a]];
    if (0..3).any(|axis| edges.iter().any(|[p, q]| line_separates(axis, *p, *q, normal[axis], corners))) {
        return false;
    }
    let highest: [f64; 3] = std::array::from_fn(|k| corners[usize::from(normal[k] == Greater)][k]);
    let lowest: [f64; 3] = std::array::from_fn(|k| corners[usize::from(normal[k] != Greater)][k]);
    orientation_3d(a, b, c, highest) != Less && orientation_3d(a, b, c, lowest) != Greater
}

/// The other two coordinates, in cyclic order.
fn project(axis: usize, p: [f64; 3]) -> [f64; 2] {
    [p[(axis + 1) % 3], p[(axis + 2) % 3]]
}

/// Whether, seen along `axis`, the box lies strictly beyond the line through `p` and `q`: on the side that `inside`
/// (where the primitive's third vertex lies) is opposite of, on either side if there is none.
fn line_separates(axis: usize, p: [f64; 3], q: [f64; 3], inside: Ordering, corners: &[[f64; 3]; 2]) -> bool {
    let [p, q] = [p, q].map(|v| project(axis, v));
    let [low, high] = corners.map(|corner| project(axis, corner));
    // Left of the line is where x falls if y rises along it, and the other way round.
    let (x_left, x_right) = if q[1] > p[1] { (low[0], high[0]) } else { (high[0], low[0]) };
    let (y_left, y_right) = if q[0] > p[0] { (high[1], low[1]) } else { (low[1], high[1]) };
    (inside != Less && orientation_2d(p, q, [x_left, y_left]) == Less)
        || (inside != Greater && orientation_2d(p, q, [x_right, y_right]) == Greater)
}
