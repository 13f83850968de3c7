//! The reference kernel: nearest feature of a point, segment or triangle, in f64.
//!
//! Everything is computed on *offsets*, the vertices minus the query, so the query is the origin. That subtraction is
//! the only place where the position of the scene in space enters; it moves each vertex by at most u times its
//! distance. What follows is the distance from the origin to the triangle of the rounded offsets, whatever shape
//! rounding has given it. The value is the smallest of the keys of
//!
//! - the three vertices,
//! - the feet on the three edges ([`edge_foot`], the same code for a segment), and
//! - the foot on the face ([`face_foot`]),
//!
//! each accepted only where its weights are positive, so a lower-dimensional feature always covers what a higher one
//! leaves out. Values of vertices and edges depend on their own end points alone (in any order) and therefore carry
//! the same bits in every primitive that contains them. docs/accuracy.md derives the error bound.
//!
//! # Scale
//!
//! No step compares with an absolute constant. Plain f64 arithmetic is used while no square can leave its range
//! ([`plain_scale`]); otherwise every feature is computed on offsets scaled by their own power of two
//! ([`scaled_triangle`] and its siblings), by the same functions and hence with the same bits. Which of several
//! formulas is used depends on ratios of lengths only: on shape, never on scale.

use super::double::{self, Double};
use super::key::{Key, SQUARE_MIN};
use super::vector::{
    V3, add_scaled, clamp_between, dot, exponent, larger, largest, lexicographically_less, norm_squared, power_of_two,
    scale_by_power, smaller, sub,
};
use super::{Nearest, NearestFeature};

/// Triangles whose height is below 2^-10 of their longest edge get that height in double-double.
const SLIVER_SINE_SQUARED: f64 = power_of_two(-20);
/// Triangles whose height is below 2^-57 of their longest edge are their edges: no face point is further from the
/// edges than that height, which is at most u M / 8.
const NEEDLE_SINE_SQUARED: f64 = power_of_two(-114);
/// Weights below 2^-49 may owe their sign to rounding.
const UNDECIDED_WEIGHT: f64 = power_of_two(-49);
/// Edges shorter than 2^-100 of the distance to the query are their end points, with an error of 2^-100 M.
const SPECK: f64 = power_of_two(-100);
/// Plain arithmetic demands a little more than `SPECK`, so that the two lanes agree on what a speck is.
const PLAIN_SIZE_PER_EDGE_SQUARED: f64 = power_of_two(196);
/// Offsets within 2^-250..2^250 have squares, and squares of squares, well inside the range of f64.
const PLAIN_MIN: f64 = power_of_two(-250);
const PLAIN_MAX: f64 = power_of_two(250);

/// The foot of the perpendicular from the origin onto the line through two points.
struct LineFoot {
    /// The end that is nearer to the origin: 0 or 1.
    near: usize,
    /// From the nearer to the farther end.
    direction: V3,
    /// 1 / |direction|^2
    inverse: f64,
    /// Position of the foot: 0 at the nearer end, 1 at the farther one.
    t: f64,
    /// The foot itself.
    foot: V3,
}

/// The foot on the line through `ends`, whose squared lengths are `squares`.
///
/// Projecting from the nearer end keeps t |direction| below the distance to it; the second step projects the first
/// foot again and so removes the error of the first division and of the first sum along the line.
#[inline(always)]
fn line_foot(ends: [V3; 2], squares: [f64; 2]) -> LineFoot {
    let second_nearer =
        squares[1] < squares[0] || (squares[1] == squares[0] && lexicographically_less(ends[1], ends[0]));
    let near = usize::from(second_nearer);
    let (n, f) = if second_nearer { (ends[1], ends[0]) } else { (ends[0], ends[1]) };
    let direction = sub(f, n);
    let inverse = 1.0 / norm_squared(direction);
    let t = -(dot(n, direction) * inverse);
    let foot = add_scaled(n, t, direction);
    let correction = -(dot(foot, direction) * inverse);
    LineFoot { near, direction, inverse, t: t + correction, foot: add_scaled(foot, correction, direction) }
}

/// A foot inside an edge or a face: offset, its square, and the weights of the vertices it was computed from.
#[derive(Clone, Copy)]
struct Foot<const N: usize> {
    offset: V3,
    square: f64,
    weights: [f64; N],
}

impl LineFoot {
    /// The foot if it lies strictly inside the edge. NaN is not inside.
    #[inline(always)]
    fn inside(&self, ends: [V3; 2]) -> Option<Foot<2>> {
        if !(self.t > 0.0 && self.t < 1.0) {
            return None;
        }
        let offset = clamp_between(self.foot, ends[0], ends[1]);
        let weights = if self.near == 0 { [1.0 - self.t, self.t] } else { [self.t, 1.0 - self.t] };
        Some(Foot { offset, square: norm_squared(offset), weights })
    }
}

/// Edge i runs from vertex i to vertex i + 1.
const EDGES: [[usize; 2]; 3] = [[0, 1], [1, 2], [2, 0]];

/// The foot of the perpendicular from the origin onto the plane of a triangle, if it lies strictly inside.
///
/// `lines` are the line feet of the three edges. The longest edge and the height over it form an orthogonal frame in
/// which the two weights decouple, so a sliver's error is not multiplied by the inverse of its sine; the height alone
/// needs care, see [`sliver_height`].
#[inline(always)]
fn face_foot(vertices: [V3; 3], lines: &[LineFoot; 3]) -> Option<Foot<3>> {
    let base = longest_edge(vertices, lines);
    let line = &lines[base];
    let near = EDGES[base][line.near];
    let far = EDGES[base][1 - line.near];
    let apex = 3 - near - far;
    let (n, f, a) = (vertices[near], vertices[far], vertices[apex]);

    let d = line.direction;
    let side = sub(a, n);
    let mut along = dot(side, d) * line.inverse;
    let mut height = add_scaled(side, -along, d);
    let mut height_squared = norm_squared(height);
    let sliver = height_squared * line.inverse < SLIVER_SINE_SQUARED;
    if sliver {
        (along, height) = sliver_height(n, f, a);
        height_squared = norm_squared(height);
        if !(height_squared * line.inverse >= NEEDLE_SINE_SQUARED) {
            return None;
        }
    }
    let inverse_height = 1.0 / height_squared;

    // First solution, from the foot on the base line; then the point by its weights, and one step on its residual.
    let wa = -(dot(line.foot, height) * inverse_height);
    let wf = line.t - along * wa;
    let wn = (1.0 - wf) - wa;
    let point: V3 = std::array::from_fn(|k| wn * n[k] + wf * f[k] + wa * a[k]);
    let step_d = -(dot(point, d) * line.inverse);
    let step_h = -(dot(point, height) * inverse_height);
    let wa = wa + step_h;
    let wf = wf + (step_d - along * step_h);
    let wn = (1.0 - wf) - wa;
    let least = smaller(smaller(wn, wf), wa);
    if !(least > 0.0) || (least < UNDECIDED_WEIGHT && !sliver && !strictly_inside(n, f, a)) {
        return None;
    }
    let point = add_scaled(add_scaled(point, step_d, d), step_h, height);
    let offset = clamp_to_triangle(point, vertices);
    let mut weights = [0.0; 3];
    (weights[near], weights[far], weights[apex]) = (wn, wf, wa);
    Some(Foot { offset, square: norm_squared(offset), weights })
}

#[inline(always)]
fn clamp_to_triangle(x: V3, [a, b, c]: [V3; 3]) -> V3 {
    std::array::from_fn(|k| {
        let low = smaller(smaller(a[k], b[k]), c[k]);
        let high = larger(larger(a[k], b[k]), c[k]);
        larger(smaller(x[k], high), low)
    })
}

/// Ties go to the edge whose opposite vertex comes first in lexicographic order, so that the choice does not depend
/// on how the vertices are numbered.
#[inline(always)]
fn longest_edge(vertices: [V3; 3], lines: &[LineFoot; 3]) -> usize {
    let mut best = 0;
    for i in 1..3 {
        // The longer edge has the smaller inverse.
        let (x, y) = (lines[i].inverse, lines[best].inverse);
        if x < y || (x == y && lexicographically_less(vertices[(i + 2) % 3], vertices[(best + 2) % 3])) {
            best = i;
        }
    }
    best
}

/// The height of the triangle over its base `n`-`f`, as the vector from the base line to the apex `a`, and the
/// position of its foot on the base, both rounded from double-double: relative error below 2^-44 of the height for
/// every height that is not a needle's.
#[cold]
fn sliver_height(n: V3, f: V3, a: V3) -> (f64, V3) {
    let d: [Double; 3] = std::array::from_fn(|k| Double::difference(f[k], n[k]));
    let side: [Double; 3] = std::array::from_fn(|k| Double::difference(a[k], n[k]));
    let along = double::dot(side, d) / double::dot(d, d);
    (along.round(), std::array::from_fn(|k| (side[k] - along * d[k]).round()))
}

/// Whether the foot on the face has three positive weights, in double-double: a foot exactly on an edge belongs to the
/// edge, which rounding of the weights alone would not show.
#[cold]
fn strictly_inside(n: V3, f: V3, a: V3) -> bool {
    let edge = |to: V3| -> [Double; 3] { std::array::from_fn(|k| Double::difference(to[k], n[k])) };
    let (e, s) = (edge(f), edge(a));
    let to_query = n.map(|x| Double::difference(0.0, x));
    let [ee, es, ss] = [double::dot(e, e), double::dot(e, s), double::dot(s, s)];
    let [qe, qs] = [double::dot(to_query, e), double::dot(to_query, s)];
    // Cramer's rule; every weight times the determinant.
    let wf = ss * qe - es * qs;
    let wa = ee * qs - es * qe;
    let wn = (ee * ss - es * es) - (wf + wa);
    // Products of four lengths, of which `e` is the longest edge, with at least 95 good bits.
    let noise = power_of_two(-95) * ee.round() * (ee.round() + (ee.round() * norm_squared(n)).sqrt());
    wn.round() > noise && wf.round() > noise && wa.round() > noise
}

/// Whether the features of these offsets can be computed in plain f64: the largest component `size` and the shortest
/// edge, given by the inverse of its square, are of ordinary size. A zero edge is not.
#[inline(always)]
fn plain_scale(size: f64, inverse: f64) -> bool {
    (PLAIN_MIN..=PLAIN_MAX).contains(&size) && inverse * (size * size) <= PLAIN_SIZE_PER_EDGE_SQUARED
}

/// Whether a result of the plain lane stands: its square has not lost digits to underflow.
#[inline(always)]
fn plain_result(square: f64, offset: V3) -> bool {
    square >= SQUARE_MIN || offset == [0.0; 3]
}

/// The nearest of `vertices`, whose offsets have the squared lengths `squares`; ties by lexicographic order.
#[inline(always)]
fn nearest_vertex<const N: usize>(vertices: [V3; N], squares: [f64; N]) -> usize {
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
fn edge_precedes(vertices: &[V3; 3], i: usize, other: NearestFeature) -> bool {
    let NearestFeature::Edge(j, _) = other else { return false };
    let sorted = |i: usize| {
        let [a, b] = EDGES[i].map(|k| vertices[k]);
        if lexicographically_less(b, a) { [b, a] } else { [a, b] }
    };
    sorted(i) < sorted(j)
}

/// The nearest feature of a single point.
#[inline(always)]
pub(crate) fn point(query: V3, vertex: V3) -> Nearest {
    let offset = sub(vertex, query);
    match Key::plain(norm_squared(offset)) {
        Some(key) => Nearest { key, offset, exponent: 0, feature: NearestFeature::Vertex(0), size: largest(&[offset]) },
        None => scaled_point(query, vertex),
    }
}

/// The nearest feature of a segment.
#[inline(always)]
pub(crate) fn segment(query: V3, vertices: [V3; 2]) -> Nearest {
    let offsets = vertices.map(|v| sub(v, query));
    let size = largest(&offsets);
    let squares = offsets.map(norm_squared);
    let line = line_foot(offsets, squares);
    if plain_scale(size, line.inverse) {
        let vertex = nearest_vertex(vertices, squares);
        let mut best = (squares[vertex], offsets[vertex], NearestFeature::Vertex(vertex));
        if let Some(foot) = line.inside(offsets)
            && foot.square < best.0
        {
            best = (foot.square, foot.offset, NearestFeature::Edge(0, foot.weights));
        }
        if plain_result(best.0, best.1) {
            let key = Key::plain(best.0).unwrap_or(Key::ZERO);
            return Nearest { key, offset: best.1, exponent: 0, feature: best.2, size };
        }
    }
    scaled_segment(query, vertices)
}

/// The nearest feature of a triangle.
#[inline(always)]
pub(crate) fn triangle(query: V3, vertices: [V3; 3]) -> Nearest {
    let offsets = vertices.map(|v| sub(v, query));
    let size = largest(&offsets);
    let squares = offsets.map(norm_squared);
    let lines = EDGES.map(|[i, j]| line_foot([offsets[i], offsets[j]], [squares[i], squares[j]]));
    if plain_scale(size, larger(larger(lines[0].inverse, lines[1].inverse), lines[2].inverse)) {
        let vertex = nearest_vertex(vertices, squares);
        let mut best = (squares[vertex], offsets[vertex], NearestFeature::Vertex(vertex));
        for (i, [j, k]) in EDGES.into_iter().enumerate() {
            if let Some(foot) = lines[i].inside([offsets[j], offsets[k]])
                && (foot.square < best.0 || (foot.square == best.0 && edge_precedes(&vertices, i, best.2)))
            {
                best = (foot.square, foot.offset, NearestFeature::Edge(i, foot.weights));
            }
        }
        if let Some(foot) = face_foot(offsets, &lines)
            && foot.square < best.0
        {
            best = (foot.square, foot.offset, NearestFeature::Face(foot.weights));
        }
        if plain_result(best.0, best.1) {
            let key = Key::plain(best.0).unwrap_or(Key::ZERO);
            return Nearest { key, offset: best.1, exponent: 0, feature: best.2, size };
        }
    }
    scaled_triangle(query, vertices)
}

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
fn scaled_point(query: V3, vertex: V3) -> Nearest {
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
    let foot = line_foot(ends, ends.map(norm_squared)).inside(ends)?;
    let key = Key::of_scaled_offset(foot.offset, exponent);
    Some(Nearest { key, offset: foot.offset, exponent, feature: NearestFeature::Edge(index, foot.weights), size })
}

#[cold]
#[inline(never)]
fn scaled_segment(query: V3, vertices: [V3; 2]) -> Nearest {
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
    let lines = EDGES.map(|[i, j]| {
        let ends = [offsets[i], offsets[j]];
        line_foot(ends, ends.map(norm_squared))
    });
    let foot = face_foot(offsets, &lines)?;
    let key = Key::of_scaled_offset(foot.offset, exponent);
    Some(Nearest { key, offset: foot.offset, exponent, feature: NearestFeature::Face(foot.weights), size })
}

#[cold]
#[inline(never)]
fn scaled_triangle(query: V3, vertices: [V3; 3]) -> Nearest {
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
