//! The kernel for scales at which plain f64 arithmetic could overflow or underflow.
//!
//! Each feature is computed from offsets that are scaled by a power of two of its own, with the functions of the plain
//! kernel and hence with the same bits. The code is slow but rarely used: never for f32 scenes, and for f64 scenes only
//! beyond 2^-250..2^250, for repeated vertices, and for distances that are tiny relative to the primitive.

use super::edge::{EDGES, EdgeLine, edge_precedes};
use super::face::{Corners, FacePlane};
use super::key::Key;
use super::nearest::{Nearest, edge_feature, vertex_feature};
use super::vector::{
    V3, bounds, clamp, exponent, larger, largest, lexicographically_less, norm_squared, power_of_two, scale_by_power,
    sub,
};
use crate::Feature;

/// The length of an edge, 2^-100 of the distance to the query, below which the edge is replaced by its ends. The error
/// is 2^-100 M.
const MIN_EDGE_PER_DISTANCE: f64 = power_of_two(-100);

/// The offsets of some vertices, scaled by a power of two.
struct ScaledOffsets<const N: usize> {
    /// The offsets divided by 2^`base`. `base` is 0 unless differences of coordinates overflow.
    raw: [V3; N],
    base: i32,
    /// The offsets `raw` divided by 2^`exponent`, so that the largest component is in [1, 2).
    offsets: [V3; N],
    exponent: i32,
}

impl<const N: usize> ScaledOffsets<N> {
    /// Scales the offsets of `vertices`, or returns `None` if all are zero.
    fn new(query: V3, vertices: [V3; N]) -> Option<Self> {
        let mut raw = vertices.map(|v| sub(v, query));
        let mut base = 0;
        if largest(&raw) == f64::INFINITY {
            // A component loses less than 2^-2000 of the offset to underflow in this division.
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

    /// Converts a foot that was computed from `offsets` to a result.
    ///
    /// Scaling down may have lost small components, so that the key could be below the bound of the box. Such a foot is
    /// scaled back and clamped to the box of the unscaled offsets. Scaling up loses nothing, so a foot that was scaled
    /// up remains scaled.
    fn candidate(&self, foot: V3, (feature, weights): (Feature, V3), size: f64) -> Nearest {
        let (offset, exponent) = if self.exponent > 0 {
            let [low, high] = bounds(&self.raw);
            (clamp(foot.map(|x| scale_by_power(x, self.exponent)), low, high), self.base)
        } else {
            (foot, self.base + self.exponent)
        };
        Nearest { key: Key::from_scaled_offset(offset, exponent), offset, exponent, feature, weights, size }
    }
}

/// Returns an upper bound on the largest component of the offsets, which is infinite beyond the range of f64.
fn size_of(query: V3, vertices: &[V3]) -> f64 {
    vertices.iter().fold(0.0, |m, v| larger(m, largest(&[sub(*v, query)])))
}

/// Returns the nearest point of a single point.
#[cold]
#[inline(never)]
pub(super) fn point(query: V3, vertex: V3) -> Nearest {
    let size = size_of(query, &[vertex]);
    vertex_candidate(query, 0, vertex, size)
}

/// Returns a vertex as a result.
fn vertex_candidate(query: V3, index: usize, vertex: V3, size: f64) -> Nearest {
    let (offset, exponent) = ScaledOffsets::new(query, [vertex]).map_or(([0.0; 3], 0), |s| (s.raw[0], s.base));
    let key = Key::from_scaled_offset(offset, exponent);
    let (feature, weights) = vertex_feature(index);
    Nearest { key, offset, exponent, feature, weights, size }
}

/// Returns the nearest vertex as a result.
fn nearest_vertex_candidate(query: V3, vertices: &[V3], size: f64) -> Nearest {
    let mut best = vertex_candidate(query, 0, vertices[0], size);
    let mut best_index = 0;
    for (i, v) in vertices.iter().enumerate().skip(1) {
        let candidate = vertex_candidate(query, i, *v, size);
        if candidate.key < best.key || (candidate.key == best.key && lexicographically_less(*v, vertices[best_index])) {
            (best, best_index) = (candidate, i);
        }
    }
    best
}

/// Returns the foot on an edge as a result, if it is inside of the edge.
fn edge_candidate(query: V3, index: usize, ends: [V3; 2], size: f64) -> Option<Nearest> {
    let scaled = ScaledOffsets::new(query, ends)?;
    let ends = scaled.offsets;
    if largest(&[sub(ends[1], ends[0])]) < MIN_EDGE_PER_DISTANCE {
        return None;
    }
    let line = EdgeLine::new(ends, ends.map(norm_squared));
    let (foot, is_inside) = line.foot(ends);
    is_inside.then(|| scaled.candidate(foot.offset, edge_feature(index, line.weights(foot.t)), size))
}

/// Returns the nearest point of a segment.
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

/// Returns the foot on the face as a result, if it is inside of the face.
fn face_candidate(query: V3, vertices: [V3; 3], size: f64) -> Option<Nearest> {
    let scaled = ScaledOffsets::new(query, vertices)?;
    let offsets = scaled.offsets;
    let edges = EDGES.map(|[i, j]| largest(&[sub(offsets[j], offsets[i])]));
    if larger(larger(edges[0], edges[1]), edges[2]) < MIN_EDGE_PER_DISTANCE {
        return None;
    }
    let squares = offsets.map(norm_squared);
    let lines = EDGES.map(|[i, j]| EdgeLine::new([offsets[i], offsets[j]], [squares[i], squares[j]]));
    let corners = Corners::new(offsets, &lines);
    let ordered = corners.order.map(|i| offsets[i]);
    let (plane, is_outside) = FacePlane::new(&lines[corners.base], ordered[0], ordered[2], largest(&offsets));
    if is_outside {
        return None;
    }
    let foot = plane.foot(ordered, bounds(&offsets))?;
    Some(scaled.candidate(foot.offset, (Feature::Face, corners.in_order(foot.weights)), size))
}

/// Returns the nearest point of a triangle.
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
