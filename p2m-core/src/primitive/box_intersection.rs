//! The exact test whether a primitive intersects a box.
//!
//! Two convex polytopes are disjoint if and only if one of these directions separates them: a face normal of either, or
//! the cross product of an edge of each (separating-axis theorem \[Gottschalk1996\]). For a box the directions are
//!
//! - its axes, on which the box of the primitive decides,
//! - the normal of the triangle, for which signs of [`orientation_3d`] at two corners decide, and
//! - the cross product of an edge and an axis. In the projection along that axis, the line through the edge separates
//!   if all corners of a rectangle are on one side; signs of [`orientation_2d`] at two corners decide.
//!
//! So nothing is rounded. The box is first reduced to its intersection with the box of the primitive. This does not
//! change the answer, and makes the corners of the box finite.

use crate::predicates::{orientation_2d, orientation_3d};
use crate::real::to_f64_array;
use crate::{Aabb, Real};
use nalgebra::Point3;
use std::cmp::Ordering::{self, Equal, Greater, Less};

/// Returns whether the convex hull of one to three finite vertices has a point in a closed box. It is `false` for a box
/// that is empty or has a NaN coordinate.
pub(super) fn intersects_box<T: Real>(vertices: &[Point3<T>], bounds: &Aabb<T>) -> bool {
    let hull_bounds = Aabb::from_points(vertices);
    // A box that is empty on one axis may still overlap the box of the primitive on all axes.
    if bounds.is_empty() || !bounds.intersects(&hull_bounds) {
        return false;
    }
    let is_in_box = |p: &Point3<T>| bounds.contains(&Aabb { min: *p, max: *p });
    if vertices.iter().any(is_in_box) {
        return true;
    }
    let part = bounds.intersection(&hull_bounds);
    let corners = [to_f64_array(&part.min), to_f64_array(&part.max)];
    match vertices {
        [a, b] => (0..3).all(|axis| !line_separates(axis, to_f64_array(a), to_f64_array(b), Equal, &corners)),
        [a, b, c] => triangle_intersects([a, b, c].map(to_f64_array), &corners),
        _ => false, // a point outside of the box
    }
}

fn triangle_intersects([a, b, c]: [[f64; 3]; 3], corners: &[[f64; 3]; 2]) -> bool {
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

/// Projects a point along an axis: returns the other two coordinates in cyclic order.
fn project(axis: usize, p: [f64; 3]) -> [f64; 2] {
    [p[(axis + 1) % 3], p[(axis + 2) % 3]]
}

/// Returns whether the line through `p` and `q`, projected along `axis`, has the box strictly on one side and the
/// primitive on the other. `inside` is the side of the third vertex. `Equal` means that there is no third vertex, so
/// the box may be on either side.
fn line_separates(axis: usize, p: [f64; 3], q: [f64; 3], inside: Ordering, corners: &[[f64; 3]; 2]) -> bool {
    let [p, q] = [p, q].map(|v| project(axis, v));
    let [low, high] = corners.map(|corner| project(axis, corner));
    // The leftmost corner has the smaller x if y rises along the line, and the larger x otherwise. The same holds for
    // y.
    let (x_left, x_right) = if q[1] > p[1] { (low[0], high[0]) } else { (high[0], low[0]) };
    let (y_left, y_right) = if q[0] > p[0] { (high[1], low[1]) } else { (low[1], high[1]) };
    (inside != Less && orientation_2d(p, q, [x_left, y_left]) == Less)
        || (inside != Greater && orientation_2d(p, q, [x_right, y_right]) == Greater)
}
