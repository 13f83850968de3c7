//! The reference kernel: nearest feature of a point, segment or triangle, in f64.
//!
//! Everything is computed on *offsets*, the vertices minus the query, so the query is the origin. That subtraction is
//! the only place where the position of the scene in space enters; it moves each vertex by at most u times its
//! distance. What follows is the distance from the origin to the triangle of the rounded offsets, whatever shape
//! rounding has given it. The value is the smallest of the keys of
//!
//! - the three vertices,
//! - the feet on the three edges ([`Line`], the same code for a segment), and
//! - the foot on the face ([`Plane`]),
//!
//! each accepted only where its weights are positive, so a lower-dimensional feature always covers what a higher one
//! leaves out. Values of vertices and edges depend on their own end points alone (in any order) and therefore carry
//! the same bits in every primitive that contains them. docs/proofs/accuracy.md derives the error bound.
//!
//! # Work
//!
//! First estimates of all feet come cheap and tell, with a margin wider than their errors, which feet can win; usually
//! one is left to be computed in full. They also tell when the whole primitive is farther than a caller is interested
//! in. Neither changes the value.
//!
//! # Scale
//!
//! No step compares with an absolute constant. Plain f64 arithmetic is used while no square can leave its range
//! ([`plain_scale`]); otherwise every feature is computed on offsets scaled by their own power of two
//! ([`rescaled`](super::rescaled)), by the same functions and hence with the same bits. Which of several
//! formulas is used depends on ratios of lengths only: on shape, never on scale.

use super::edge::Line;
use super::face::{EDGES, Plane};
use super::key::{Key, SQUARE_MIN};
use super::vector::{
    V3, bounds, dot, larger, largest, lexicographically_less, norm_squared, power_of_two, smaller, sub,
};
use super::{Nearest, of_edge, of_vertex, rescaled};
use crate::Feature;

/// The scaled lane takes edges below 2^-100 of the distance for their end points; plain arithmetic demands a little
/// more, so that the two lanes agree on what such a speck is.
const PLAIN_SIZE_PER_EDGE_SQUARED: f64 = power_of_two(196);
/// Offsets within 2^-250..2^250 have squares, and squares of squares, well inside the range of f64.
pub(super) const PLAIN_MIN: f64 = power_of_two(-250);
pub(super) const PLAIN_MAX: f64 = power_of_two(250);
/// Rough squares of edges and faces of ordinary shape err by less than 2^-37 of the square of the offsets' size; what
/// is farther than the best rough one by more than this cannot win.
const ROUGH_MARGIN: f64 = power_of_two(-34);
/// A foot that is accepted wrongly, by rounding, is within 2^-40 of the squared size of a foot that is right.
pub(super) const OUTWARD_MARGIN: f64 = power_of_two(-38);

/// Whether the features of these offsets can be computed in plain f64: the largest component `size` and the shortest
/// edge, given by the inverse of its square, are of ordinary size. A zero edge is not.
#[inline(always)]
fn plain_scale(size: f64, inverse: f64) -> bool {
    (PLAIN_MIN..=PLAIN_MAX).contains(&size) && inverse * (size * size) <= PLAIN_SIZE_PER_EDGE_SQUARED
}

/// The nearest of `vertices`, whose offsets have the squared lengths `squares`; ties by lexicographic order.
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

/// Whether edge i goes before a feature with the same key: never before a vertex, and before another edge if its end
/// points come first in lexicographic order.
#[cold]
pub(super) fn edge_precedes(vertices: &[V3; 3], i: usize, other: Feature) -> bool {
    let Feature::Edge(j) = other else { return false };
    let sorted = |i: usize| {
        let [a, b] = EDGES[i].map(|k| vertices[k]);
        if lexicographically_less(b, a) { [b, a] } else { [a, b] }
    };
    sorted(i) < sorted(usize::from(j))
}

/// The nearest feature of a single point; `None` if its key certainly exceeds `prune`.
#[inline(always)]
pub(crate) fn point(query: V3, vertex: V3, prune: f64) -> Option<Nearest> {
    let offset = sub(vertex, query);
    let square = norm_squared(offset);
    if square > prune {
        return None;
    }
    Some(match Key::plain(square) {
        Some(key) => {
            let (feature, weights) = of_vertex(0);
            Nearest { key, offset, exponent: 0, feature, weights, size: largest(&[offset]) }
        }
        None => rescaled::point(query, vertex),
    })
}

/// Lower bound of the key, from the box of the offsets: the same arithmetic as [`Aabb::lower_bound`](crate::Aabb).
#[inline(always)]
fn box_bound([low, high]: [V3; 2]) -> f64 {
    let mut gap = [0.0; 3];
    for k in 0..3 {
        gap[k] = larger(larger(low[k], -high[k]), 0.0);
    }
    norm_squared(gap)
}

/// The nearest feature of a segment; `None` if its key certainly exceeds `prune`.
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
    let line = Line::new(*offsets, squares);
    if !plain_scale(size, line.inverse) {
        return Some(rescaled::segment(query, *vertices));
    }
    let vertex = nearest_vertex(vertices, &squares);
    let mut best = (squares[vertex], offsets[vertex], of_vertex(vertex));
    if line.t > 0.0 {
        if line.square - ROUGH_MARGIN * (size * size) > prune {
            return None;
        }
        if let Some(foot) = line.foot(*offsets)
            && foot.square < best.0
        {
            best = (foot.square, foot.offset, of_edge(0, foot.weights));
        }
    } else if best.0 > prune {
        return None;
    }
    match plain_nearest(best, size) {
        Some(nearest) => Some(nearest),
        None => Some(rescaled::segment(query, *vertices)),
    }
}

/// The nearest feature of a triangle; `None` if its key certainly exceeds `prune`.
#[inline(always)]
pub(crate) fn triangle(query: V3, vertices: [V3; 3], prune: f64) -> Option<Nearest> {
    let offsets = [sub(vertices[0], query), sub(vertices[1], query), sub(vertices[2], query)];
    let bounds = bounds(&offsets);
    if box_bound(bounds) > prune {
        return None;
    }
    triangle_features_apart(query, &vertices, &offsets, bounds, prune)
}

/// Not inlined: it is large, and the loops that call it are better off with registers of their own.
#[inline(never)]
fn triangle_features_apart(
    query: V3,
    vertices: &[V3; 3],
    offsets: &[V3; 3],
    bounds: [V3; 2],
    prune: f64,
) -> Option<Nearest> {
    triangle_features(query, vertices, offsets, bounds, prune)
}

/// The same as [`triangle`] for one that is probably near: inlined, and without a look at its box.
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
    // Where both edges at the nearest vertex clearly lead away from the query, no foot is accepted on them or on the
    // face, and one on the third edge is longer: the vertex is the answer.
    let offset = offsets[vertex];
    let [next, last] = [sub(offsets[(vertex + 1) % 3], offset), sub(offsets[(vertex + 2) % 3], offset)];
    let least = smaller(dot(offset, next), dot(offset, last));
    if least > OUTWARD_MARGIN * (size * size)
        && (PLAIN_MIN..=PLAIN_MAX).contains(&size)
        && let Some(key) = Key::plain(squares[vertex])
    {
        let (feature, weights) = of_vertex(vertex);
        let nearest = Nearest { key, offset, exponent: 0, feature, weights, size };
        return (squares[vertex] <= prune).then_some(nearest);
    }
    let lines = [
        Line::new([offsets[0], offsets[1]], [squares[0], squares[1]]),
        Line::new([offsets[1], offsets[2]], [squares[1], squares[2]]),
        Line::new([offsets[2], offsets[0]], [squares[2], squares[0]]),
    ];
    if !plain_scale(size, larger(larger(lines[0].inverse, lines[1].inverse), lines[2].inverse)) {
        return Some(rescaled::triangle(query, *vertices));
    }
    let plane = Plane::new(*offsets, &lines, size);
    let (face, doubt) = match &plane {
        Some(plane) => plane.estimate(),
        None => (f64::INFINITY, 1.0),
    };
    let mut rough = smaller(squares[vertex], face);
    for line in &lines {
        // Far away, rounding can mistake the nearer end, and the foot then lies beyond the farther one.
        rough = if line.t > 0.0 && line.t < 1.0 { smaller(line.square, rough) } else { rough };
    }
    let margin = ROUGH_MARGIN * doubt * (size * size);
    if rough - margin > prune {
        return None;
    }
    let limit = rough + margin;

    let mut best = (squares[vertex], offsets[vertex], of_vertex(vertex));
    for (i, [j, k]) in EDGES.into_iter().enumerate() {
        if lines[i].t > 0.0
            && lines[i].square <= limit
            && let Some(foot) = lines[i].foot([offsets[j], offsets[k]])
            && (foot.square < best.0 || (foot.square == best.0 && edge_precedes(vertices, i, best.2.0)))
        {
            best = (foot.square, foot.offset, of_edge(i, foot.weights));
        }
    }
    if let Some(plane) = plane
        && plane.may_be_within(limit)
        && let Some(foot) = plane.foot(*offsets, bounds)
        && foot.square < best.0
    {
        best = (foot.square, foot.offset, (Feature::Face, foot.weights));
    }
    match plain_nearest(best, size) {
        Some(nearest) => Some(nearest),
        None => Some(rescaled::triangle(query, *vertices)),
    }
}

/// The result of the plain lane, unless its square has lost digits to underflow.
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
