//! The lane for scales at which plain f64 arithmetic could over- or underflow.
//!
//! Every feature is computed on offsets scaled by its own power of two, by the functions of the plain lane and hence
//! with the same bits. Slow, and rare: f32 scenes never come here, f64 scenes only beyond 2^-250..2^250, for repeated
//! vertices, and for distances that are tiny beside the primitive.

use super::edge::{Foot, Line};
use super::face::{EDGES, Plane};
use super::key::Key;
use super::triangle::edge_precedes;
use super::vector::{
    V3, bounds, clamp, exponent, larger, largest, lexicographically_less, norm_squared, power_of_two, scale_by_power,
    sub,
};
use super::{Nearest, of_edge, of_vertex};
use crate::Feature;

/// Edges shorter than 2^-100 of the distance to the query are their end points, with an error of 2^-100 M.
const SPECK: f64 = power_of_two(-100);

/// The offsets of some vertices, scaled.
struct Scaled<const N: usize> {
    /// Divided by 2^`base`: 1, unless coordinates are at the edge of the range, where differences overflow.
    raw: [V3; N],
    base: i32,
    /// `raw` divided by 2^`exponent`, which brings the largest component into [1, 2).
    offsets: [V3; N],
    exponent: i32,
}

impl<const N: usize> Scaled<N> {
    /// `None` if all offsets are zero.
    fn new(query: V3, vertices: [V3; N]) -> Option<Self> {
        let mut raw = vertices.map(|v| sub(v, query));
        let mut base = 0;
        if largest(&raw) == f64::INFINITY {
            // What a component loses to underflow by this division is below 2^-2000 of the offset.
            base = 3;
            raw = vertices.map(|v| sub(v.map(|x| x * 0.125), query.map(|x| x * 0.125)));
        }
        let size = largest(&raw);
        if size == 0.0 {
            return None;
        }
        let exponent = exponent(size);
        Some(Self { raw, base, offsets: raw.map(|v| v.map(|x| scale_by_power(x, -exponent))), exponent })
    }

    /// A foot computed from `offsets`, as a candidate.
    ///
    /// Scaling down may have lost small components, and with them the promise that the key is not below the bound of
    /// the box: such a foot is scaled back and moved into the box of the offsets as they were. (Scaling up loses
    /// nothing, scaling back would.)
    fn candidate<const M: usize>(&self, foot: &Foot<M>, (feature, weights): (Feature, V3), size: f64) -> Nearest {
        let (offset, exponent) = if self.exponent > 0 {
            let [low, high] = bounds(&self.raw);
            (clamp(foot.offset.map(|x| scale_by_power(x, self.exponent)), low, high), self.base)
        } else {
            (foot.offset, self.base + self.exponent)
        };
        Nearest { key: Key::from_scaled_offset(offset, exponent), offset, exponent, feature, weights, size }
    }
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
    let (offset, exponent) = Scaled::new(query, [vertex]).map_or(([0.0; 3], 0), |s| (s.raw[0], s.base));
    let key = Key::from_scaled_offset(offset, exponent);
    let (feature, weights) = of_vertex(index);
    Nearest { key, offset, exponent, feature, weights, size }
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
    let scaled = Scaled::new(query, ends)?;
    let ends = scaled.offsets;
    if largest(&[sub(ends[1], ends[0])]) < SPECK {
        return None;
    }
    let foot = Line::new(ends, ends.map(norm_squared)).foot(ends)?;
    Some(scaled.candidate(&foot, of_edge(index, foot.weights), size))
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
    let scaled = Scaled::new(query, vertices)?;
    let offsets = scaled.offsets;
    let edges = EDGES.map(|[i, j]| largest(&[sub(offsets[j], offsets[i])]));
    if larger(larger(edges[0], edges[1]), edges[2]) < SPECK {
        return None;
    }
    let squares = offsets.map(norm_squared);
    let lines = EDGES.map(|[i, j]| Line::new([offsets[i], offsets[j]], [squares[i], squares[j]]));
    let foot = Plane::new(offsets, &lines, largest(&offsets))?.foot(offsets, bounds(&offsets))?;
    Some(scaled.candidate(&foot, (Feature::Face, foot.weights), size))
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
