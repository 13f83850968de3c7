//! The lane for scales at which plain f64 arithmetic could over- or underflow.
//!
//! Every feature is computed on offsets scaled by its own power of two, by the functions of the plain lane and hence
//! with the same bits. Slow, and rare: f32 scenes never come here, f64 scenes only beyond 2^-250..2^250, for repeated
//! vertices, and for distances that are tiny beside the primitive.

use super::key::Key;
use super::line::Line;
use super::plane::{EDGES, Plane};
use super::scalar::edge_precedes;
use super::vector::{
    V3, bounds, exponent, larger, largest, lexicographically_less, norm_squared, power_of_two, scale_by_power, sub,
};
use super::{Nearest, NearestFeature};

/// Edges shorter than 2^-100 of the distance to the query are their end points, with an error of 2^-100 M.
const SPECK: f64 = power_of_two(-100);

/// Offsets divided by a power of two that brings their largest component into [1, 2), and the exponent of that power.
/// `None` if all are zero.
fn scaled_offsets<const N: usize>(query: V3, vertices: [V3; N]) -> Option<([V3; N], i32)> {
    let mut offsets = vertices.map(|v| sub(v, query));
    let mut base = 0;
    if largest(&offsets) == f64::INFINITY {
        // Coordinates at the edge of the range: subtract at an eighth of the scale. What a component may lose to
        // underflow there is below 2^-2000 of the offset.
        base = 3;
        offsets = vertices.map(|v| sub(v.map(|x| x * 0.125), query.map(|x| x * 0.125)));
    }
    let size = largest(&offsets);
    if size == 0.0 {
        return None;
    }
    let e = exponent(size);
    Some((offsets.map(|v| v.map(|x| scale_by_power(x, -e))), base + e))
}

/// An upper bound of the largest component of the offsets, infinite if it exceeds f64.
fn size_of(query: V3, vertices: &[V3]) -> f64 {
    vertices.iter().fold(0.0, |m, v| larger(m, largest(&[sub(*v, query)])))
}

#[cold]
#[inline(never)]
pub(super) fn point(query: V3, vertex: V3) -> Nearest {
    let size = size_of(query, &[vertex]);
    vertex_candidate(query, 0, vertex, size)
}

fn vertex_candidate(query: V3, index: usize, vertex: V3, size: f64) -> Nearest {
    let ([offset], exponent) = scaled_offsets(query, [vertex]).unwrap_or(([[0.0; 3]], 0));
    let key = Key::of_scaled_offset(offset, exponent);
    Nearest { key, offset, exponent, feature: NearestFeature::Vertex(index), size }
}

/// The nearest vertex in the scaled lane.
fn nearest_vertex_candidate(query: V3, vertices: &[V3], size: f64) -> Nearest {
    let mut best = vertex_candidate(query, 0, vertices[0], size);
    let mut at = 0;
    for (i, v) in vertices.iter().enumerate().skip(1) {
        let candidate = vertex_candidate(query, i, *v, size);
        if candidate.key < best.key || (candidate.key == best.key && lexicographically_less(*v, vertices[at])) {
            (best, at) = (candidate, i);
        }
    }
    best
}

fn edge_candidate(query: V3, index: usize, ends: [V3; 2], size: f64) -> Option<Nearest> {
    let (ends, exponent) = scaled_offsets(query, ends)?;
    if largest(&[sub(ends[1], ends[0])]) < SPECK {
        return None;
    }
    let foot = Line::new(ends, ends.map(norm_squared)).foot(ends)?;
    let key = Key::of_scaled_offset(foot.offset, exponent);
    Some(Nearest { key, offset: foot.offset, exponent, feature: NearestFeature::Edge(index, foot.weights), size })
}

#[cold]
#[inline(never)]
pub(super) fn segment(query: V3, vertices: [V3; 2]) -> Nearest {
    let size = size_of(query, &vertices);
    let vertex = nearest_vertex_candidate(query, &vertices, size);
    match edge_candidate(query, 0, vertices, size) {
        Some(edge) if edge.key < vertex.key => edge,
        _ => vertex,
    }
}

fn face_candidate(query: V3, vertices: [V3; 3], size: f64) -> Option<Nearest> {
    let (offsets, exponent) = scaled_offsets(query, vertices)?;
    let longest = EDGES.map(|[i, j]| largest(&[sub(offsets[j], offsets[i])]));
    if larger(larger(longest[0], longest[1]), longest[2]) < SPECK {
        return None;
    }
    let squares = offsets.map(norm_squared);
    let lines = EDGES.map(|[i, j]| Line::new([offsets[i], offsets[j]], [squares[i], squares[j]]));
    let foot = Plane::new(offsets, &lines, largest(&offsets))?.foot(offsets, bounds(&offsets))?;
    let key = Key::of_scaled_offset(foot.offset, exponent);
    Some(Nearest { key, offset: foot.offset, exponent, feature: NearestFeature::Face(foot.weights), size })
}

#[cold]
#[inline(never)]
pub(super) fn triangle(query: V3, vertices: [V3; 3]) -> Nearest {
    let size = size_of(query, &vertices);
    let mut best = nearest_vertex_candidate(query, &vertices, size);
    for (i, [j, k]) in EDGES.into_iter().enumerate() {
        if let Some(edge) = edge_candidate(query, i, [vertices[j], vertices[k]], size)
            && (edge.key < best.key || (edge.key == best.key && edge_precedes(&vertices, i, best.feature)))
        {
            best = edge;
        }
    }
    match face_candidate(query, vertices, size) {
        Some(face) if face.key < best.key => face,
        _ => best,
    }
}
