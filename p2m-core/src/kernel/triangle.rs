//! The plain kernel: the nearest feature of a point, segment or triangle in f64.
//!
//! All computations use *offsets*, the vertices minus the query, so the query is the origin. Only this subtraction
//! depends on the position of the scene in space; it moves each vertex by at most u times its distance. The kernel then
//! computes the distance from the origin to the triangle of the rounded offsets, whatever shape rounding has given it.
//! The result is the smallest key of
//!
//! - the three vertices,
//! - the feet on the three edges ([`EdgeLine`], which segments use as well), and
//! - the foot on the face ([`FacePlane`]).
//!
//! A foot is accepted only if its weights are positive, so features of lower dimension cover all other cases. The
//! values of a vertex or an edge depend on its own ends alone, in any order, and so have the same bits in every
//! primitive that contains it. [docs/proofs/accuracy.md] derives the error bound.
//!
//! # Work
//!
//! Rough squares of all feet are cheap. With a margin wider than their errors, they exclude all features that cannot
//! win; in most cases one feature remains to be computed in full. They also exclude primitives beyond the caller's
//! limit. Neither changes the result.
//!
//! # Scale
//!
//! No step compares with an absolute constant. Plain f64 arithmetic is used if no square can leave its range
//! ([`has_plain_scale`]). Otherwise each feature is computed from offsets that are scaled by a power of two of its own
//! ([`rescaled`](super::rescaled)), by the same functions and hence with the same bits. The choice between formulas
//! depends on ratios of lengths, and so on the shape but never on the scale.
//!
//! [docs/proofs/accuracy.md]: https://github.com/p2m-rs/p2m/blob/main/docs/proofs/accuracy.md

use super::edge::{EDGES, EdgeLine, edge_precedes};
use super::face::{Corners, FacePlane};
use super::key::{Key, SQUARE_MIN};
use super::nearest::{Nearest, edge_feature, vertex_feature};
use super::rescaled;
use super::vector::{
    V3, bounds, dot, larger, largest, lexicographically_less, norm_squared, power_of_two, smaller, sub,
};
use crate::Feature;

/// The largest ratio of size to shortest edge, squared, for which the plain kernel is used. The rescaled kernel
/// replaces edges below 2^-100 of the distance by their ends; this limit is stricter, so that the two kernels agree.
pub(super) const MAX_SIZE_PER_EDGE_SQUARED: f64 = power_of_two(196);
/// The least size of offsets whose squares, and squares of squares, are well inside of the range of f64.
pub(super) const MIN_PLAIN_SIZE: f64 = power_of_two(-250);
/// The largest size of offsets whose squares, and squares of squares, are well inside of the range of f64.
pub(super) const MAX_PLAIN_SIZE: f64 = power_of_two(250);
/// The margin, relative to the squared size of the offsets, by which a rough square has to exceed another one so that
/// its feature cannot win. Rough squares of edges and faces of ordinary shape have errors below 2^-37 of the squared
/// size.
pub(super) const ROUGH_SQUARE_MARGIN: f64 = power_of_two(-34);
/// The margin, relative to the squared size of the offsets, by which an edge certainly leads away from the query. A
/// foot that is accepted wrongly because of rounding is within 2^-40 of the squared size of a correct foot.
pub(super) const OUTWARD_MARGIN: f64 = power_of_two(-38);

/// Returns whether the features of these offsets can be computed in plain f64: the largest component, `size`, and the
/// shortest edge, whose inverse square is `inverse`, are of ordinary size. An edge of length zero is not.
#[inline(always)]
fn has_plain_scale(size: f64, inverse: f64) -> bool {
    (MIN_PLAIN_SIZE..=MAX_PLAIN_SIZE).contains(&size) && inverse * (size * size) <= MAX_SIZE_PER_EDGE_SQUARED
}

/// Returns the index of the nearest of `vertices`, whose offsets have the squared lengths `squares`. Ties go to the
/// first vertex in lexicographic order.
#[inline(always)]
fn nearest_vertex<const N: usize>(vertices: &[V3; N], squares: &[f64; N]) -> usize {
    let mut best = 0;
    for i in 1..N {
        if squares[i] < squares[best]
            || (squares[i] == squares[best] && lexicographically_less(vertices[i], vertices[best]))
        {
            best = i;
        }
    }
    best
}

/// Returns the nearest point of a single point, or `None` if its key certainly exceeds `prune`.
#[inline(always)]
pub(crate) fn point(query: V3, vertex: V3, prune: f64) -> Option<Nearest> {
    let offset = sub(vertex, query);
    let square = norm_squared(offset);
    if square > prune {
        return None;
    }
    let found = plain_nearest((square, offset, vertex_feature(0)), largest(&[offset]));
    Some(found.unwrap_or_else(|| rescaled::point(query, vertex)))
}

/// Returns a lower bound on the key, given the box of the offsets. It uses the arithmetic of
/// [`Aabb::lower_bound`](crate::Aabb::lower_bound).
#[inline(always)]
fn box_bound([low, high]: [V3; 2]) -> f64 {
    let mut gap = [0.0; 3];
    for k in 0..3 {
        gap[k] = larger(larger(low[k], -high[k]), 0.0);
    }
    norm_squared(gap)
}

/// Returns the nearest point of a segment, or `None` if its key certainly exceeds `prune`.
#[inline(always)]
pub(crate) fn segment(query: V3, vertices: [V3; 2], prune: f64) -> Option<Nearest> {
    let offsets = [sub(vertices[0], query), sub(vertices[1], query)];
    if box_bound(bounds(&offsets)) > prune {
        return None;
    }
    segment_features(query, &vertices, &offsets, prune)
}

#[inline(always)]
fn segment_features(query: V3, vertices: &[V3; 2], offsets: &[V3; 2], prune: f64) -> Option<Nearest> {
    let size = largest(offsets);
    let squares = [norm_squared(offsets[0]), norm_squared(offsets[1])];
    let line = EdgeLine::new(*offsets, squares);
    if !has_plain_scale(size, line.inverse) {
        return Some(rescaled::segment(query, *vertices));
    }
    let vertex = nearest_vertex(vertices, &squares);
    let mut best = (squares[vertex], offsets[vertex], vertex_feature(vertex));
    if line.t > 0.0 {
        if line.square - ROUGH_SQUARE_MARGIN * (size * size) > prune {
            return None;
        }
        let (foot, is_inside) = line.foot(*offsets);
        if is_inside && foot.square < best.0 {
            best = (foot.square, foot.offset, edge_feature(0, line.weights(foot.t)));
        }
    } else if best.0 > prune {
        return None;
    }
    match plain_nearest(best, size) {
        Some(nearest) => Some(nearest),
        None => Some(rescaled::segment(query, *vertices)),
    }
}

/// Returns the nearest point of a triangle, or `None` if its key certainly exceeds `prune`.
#[inline(always)]
pub(crate) fn triangle(query: V3, vertices: [V3; 3], prune: f64) -> Option<Nearest> {
    let offsets = [sub(vertices[0], query), sub(vertices[1], query), sub(vertices[2], query)];
    let bounds = bounds(&offsets);
    if box_bound(bounds) > prune {
        return None;
    }
    triangle_features_outlined(query, &vertices, &offsets, bounds, prune)
}

/// Calls [`triangle_features`] without inlining it, because it is large and would take registers from the loops that
/// call it.
#[inline(never)]
fn triangle_features_outlined(
    query: V3,
    vertices: &[V3; 3],
    offsets: &[V3; 3],
    bounds: [V3; 2],
    prune: f64,
) -> Option<Nearest> {
    triangle_features(query, vertices, offsets, bounds, prune)
}

/// Returns the nearest point of a triangle that is probably near, or `None` if its key certainly exceeds `prune`. It is
/// inlined, and skips the test of the triangle's box.
#[inline(always)]
pub(crate) fn near_triangle(query: V3, vertices: [V3; 3], prune: f64) -> Option<Nearest> {
    let offsets = [sub(vertices[0], query), sub(vertices[1], query), sub(vertices[2], query)];
    triangle_features(query, &vertices, &offsets, bounds(&offsets), prune)
}

#[inline(always)]
fn triangle_features(query: V3, vertices: &[V3; 3], offsets: &[V3; 3], bounds: [V3; 2], prune: f64) -> Option<Nearest> {
    let size = largest(&bounds);
    let squares = [norm_squared(offsets[0]), norm_squared(offsets[1]), norm_squared(offsets[2])];
    let vertex = nearest_vertex(vertices, &squares);
    // If both edges at the nearest vertex clearly lead away from the query, no foot is accepted on them or on the face,
    // and a foot on the third edge is farther. So the vertex is the nearest point.
    let offset = offsets[vertex];
    let [next, last] = [sub(offsets[(vertex + 1) % 3], offset), sub(offsets[(vertex + 2) % 3], offset)];
    let least = smaller(dot(offset, next), dot(offset, last));
    if least > OUTWARD_MARGIN * (size * size)
        && (MIN_PLAIN_SIZE..=MAX_PLAIN_SIZE).contains(&size)
        && let Some(key) = Key::plain(squares[vertex])
    {
        let (feature, weights) = vertex_feature(vertex);
        let nearest = Nearest { key, offset, exponent: 0, feature, weights, size };
        return (squares[vertex] <= prune).then_some(nearest);
    }
    let lines = [
        EdgeLine::new([offsets[0], offsets[1]], [squares[0], squares[1]]),
        EdgeLine::new([offsets[1], offsets[2]], [squares[1], squares[2]]),
        EdgeLine::new([offsets[2], offsets[0]], [squares[2], squares[0]]),
    ];
    if !has_plain_scale(size, larger(larger(lines[0].inverse, lines[1].inverse), lines[2].inverse)) {
        return Some(rescaled::triangle(query, *vertices));
    }
    let corners = Corners::new(*offsets, &lines);
    let ordered = [offsets[corners.order[0]], offsets[corners.order[1]], offsets[corners.order[2]]];
    let (plane, is_outside) = FacePlane::new(&lines[corners.base], ordered[0], ordered[2], size);
    let plane = (!is_outside).then_some(plane);
    let (face, error_factor) = match &plane {
        Some(plane) => plane.estimate(),
        None => (f64::INFINITY, 1.0),
    };
    let mut rough = smaller(squares[vertex], face);
    for line in &lines {
        // For a distant query, rounding can confuse the two ends. The foot then lies beyond the farther one.
        rough = if line.t > 0.0 && line.t < 1.0 { smaller(line.square, rough) } else { rough };
    }
    let margin = ROUGH_SQUARE_MARGIN * error_factor * (size * size);
    if rough - margin > prune {
        return None;
    }
    let limit = rough + margin;

    let mut best = (squares[vertex], offsets[vertex], vertex_feature(vertex));
    for (i, [j, k]) in EDGES.into_iter().enumerate() {
        if lines[i].t > 0.0
            && lines[i].square <= limit
            && let (foot, true) = lines[i].foot([offsets[j], offsets[k]])
            && (foot.square < best.0 || (foot.square == best.0 && edge_precedes(vertices, i, best.2.0)))
        {
            best = (foot.square, foot.offset, edge_feature(i, lines[i].weights(foot.t)));
        }
    }
    if let Some(plane) = plane
        && plane.may_be_within(limit)
        && let Some(foot) = plane.foot(ordered, bounds)
        && foot.square < best.0
    {
        best = (foot.square, foot.offset, (Feature::Face, corners.in_order(foot.weights)));
    }
    match plain_nearest(best, size) {
        Some(nearest) => Some(nearest),
        None => Some(rescaled::triangle(query, *vertices)),
    }
}

/// Returns the result of the plain kernel, or `None` if its square has lost digits to underflow.
#[inline(always)]
fn plain_nearest((square, offset, (feature, weights)): (f64, V3, (Feature, V3)), size: f64) -> Option<Nearest> {
    let key = if square >= SQUARE_MIN {
        Key::plain(square)?
    } else if offset == [0.0; 3] {
        Key::ZERO
    } else {
        return None;
    };
    Some(Nearest { key, offset, exponent: 0, feature, weights, size })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_query_at_a_point_has_the_result_of_the_path_for_all_scales() {
        for (query, vertex) in [([1.5, -2.0, 1e300], [1.5, -2.0, 1e300]), ([0.0; 3], [-0.0; 3]), ([-0.0; 3], [0.0; 3])]
        {
            let (found, expected) = (point(query, vertex, f64::INFINITY).unwrap(), rescaled::point(query, vertex));
            assert_eq!((found.key, found.offset), (Key::ZERO, expected.offset));
            assert_eq!((found.exponent, found.feature), (expected.exponent, expected.feature));
            assert_eq!((found.weights, found.size), (expected.weights, expected.size));
        }
    }
}
