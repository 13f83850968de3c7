//! The plain kernel for eight triangles or segments side by side, each with its own query point.
//!
//! The basic idea is to give each triangle a lane of its own. Every lane makes the same f64 operations in the same
//! order as `kernel::triangle`, most of them by the same code, so its result has the same bits. There are no branches
//! per lane: all features are computed and the best one is selected by masks, whereas the single kernel skips features
//! that cannot win. Neither choice changes the result. A lane is not *certain* if the single kernel would leave this
//! path; the single kernel then has to compute it:
//!
//! - scales that are not plain, and squares that have lost digits or all of them to underflow;
//! - slivers, and feet so close to the border of a face that their weights do not decide;
//! - ties between vertices, between edges, or between the lengths of edges, which are decided by the order of vertices.
//!
//! [docs/proofs/accuracy.md] has the proof that the bits are equal.
//!
//! [docs/proofs/accuracy.md]: https://github.com/p2m-rs/p2m/blob/main/docs/proofs/accuracy.md

#![allow(clippy::needless_range_loop, reason = "iterators with closures would be compiled without the instruction set")]

use super::edge::{EDGES, EdgeLine};
use super::face::{FacePlane, MIN_CERTAIN_WEIGHT};
use super::key::{Key, SQUARE_MAX, SQUARE_MIN};
use super::nearest::{ERROR_PER_SIZE, FACE_CODE, edge_feature_code, feature_of_code};
use super::triangle::{MAX_PLAIN_SIZE, MAX_SIZE_PER_EDGE_SQUARED, MIN_PLAIN_SIZE, OUTWARD_MARGIN, ROUGH_SQUARE_MARGIN};
use super::vector::{add, bounds, clamp, dot, larger, largest, norm_squared, select, smaller, sub};
use crate::Projection;
use crate::simd::{Doubles, InstructionSet, Isa, SimdKernel};
use nalgebra::Point3;

/// The number of primitives that are computed at once.
pub const SIDE_BY_SIDE: usize = 8;
/// One number per primitive.
pub type Row = [f64; SIDE_BY_SIDE];

/// The query points and the vertices of eight primitives. `vertices[v][k]` has coordinate k of vertex v of each
/// primitive.
#[derive(Clone, Debug)]
pub struct TriangleLanes<const N: usize> {
    queries: [Row; 3],
    vertices: [[Row; 3]; N],
}

impl<const N: usize> Default for TriangleLanes<N> {
    fn default() -> Self {
        Self { queries: [[0.0; SIDE_BY_SIDE]; 3], vertices: [[[0.0; SIDE_BY_SIDE]; 3]; N] }
    }
}

impl<const N: usize> TriangleLanes<N> {
    /// Copies one lane to another.
    #[inline(always)]
    pub fn copy_lane(&mut self, from: usize, to: usize) {
        for row in self.queries.iter_mut().chain(self.vertices.as_flattened_mut()) {
            row[to] = row[from];
        }
    }

    /// Sets the query point and the vertices in a lane.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, query: &[f64; 3], vertices: [&[f64; 3]; N]) {
        for k in 0..3 {
            self.queries[k][lane] = query[k];
            for v in 0..N {
                self.vertices[v][k][lane] = vertices[v][k];
            }
        }
    }

    #[inline(always)]
    fn load<D: Doubles>(&self) -> ([D; 3], [[D; 3]; N]) {
        let mut vertices = [[D::splat(0.0); 3]; N];
        for v in 0..N {
            for k in 0..3 {
                vertices[v][k] = D::load(&self.vertices[v][k]);
            }
        }
        ([D::load(&self.queries[0]), D::load(&self.queries[1]), D::load(&self.queries[2])], vertices)
    }
}

/// The nearest points of eight primitives. By default no lane is certain.
#[derive(Clone, Debug, Default)]
pub struct LaneResults {
    square: Row,
    point: [Row; 3],
    weights: [Row; 3],
    size: Row,
    feature: Row,
    /// Lower bounds on the true distances.
    lower_bound: Row,
    /// One bit per lane: whether its result is certain, that is equal to the result of the single kernel.
    certain: u8,
    /// One bit per lane: whether its result was not computed.
    skipped: u8,
}

impl LaneResults {
    /// Returns whether the primitive in a lane was skipped and has to be computed in a later call.
    #[inline(always)]
    #[must_use]
    pub fn was_skipped(&self, lane: usize) -> bool {
        self.skipped >> lane & 1 == 1
    }

    /// Returns the squared distance in a lane and a lower bound on the true distance, or `None` if the single kernel
    /// has to compute the lane.
    #[inline(always)]
    #[must_use]
    pub fn square_and_lower_bound(&self, lane: usize) -> Option<(f64, f64)> {
        (self.certain >> lane & 1 == 1).then(|| (self.square[lane], self.lower_bound[lane]))
    }

    /// Returns the result in a lane, or `None` if the single kernel has to compute the lane.
    #[inline(always)]
    #[must_use]
    pub fn projection(&self, lane: usize) -> Option<Projection> {
        if self.certain >> lane & 1 == 0 {
            return None;
        }
        Some(Projection {
            key: Key::of_plain_square(self.square[lane]),
            point: Point3::new(self.point[0][lane], self.point[1][lane], self.point[2][lane]),
            feature: feature_of_code(self.feature[lane]),
            barycentric: [self.weights[0][lane], self.weights[1][lane], self.weights[2][lane]],
            error: ERROR_PER_SIZE * self.size[lane],
        })
    }
}

/// One of three alternatives in each lane: the first one, unless one of two masks is true.
#[derive(Clone, Copy)]
struct Choice<D: Doubles> {
    is_second: D::Mask,
    is_third: D::Mask,
}

impl<D: Doubles> Choice<D> {
    /// Chooses the smallest of three numbers; ties go to the first.
    #[inline(always)]
    fn smallest([x, y, z]: [D; 3]) -> Self {
        let is_second = y.is_below(x);
        let is_third = z.is_below(D::select(is_second, y, x));
        Self { is_second: is_second & !is_third, is_third }
    }

    #[inline(always)]
    fn of(self, [x, y, z]: [D; 3]) -> D {
        D::select(self.is_third, z, D::select(self.is_second, y, x))
    }

    #[inline(always)]
    fn of_vectors(self, [x, y, z]: [[D; 3]; 3]) -> [D; 3] {
        select(self.is_third, z, select(self.is_second, y, x))
    }

    /// Returns 1 for the chosen alternative, and 0 for the others.
    #[inline(always)]
    fn weights(self) -> [D; 3] {
        let (zero, one) = (D::splat(0.0), D::splat(1.0));
        let is_first = !(self.is_second | self.is_third);
        [D::select(is_first, one, zero), D::select(self.is_second, one, zero), D::select(self.is_third, one, zero)]
    }
}

/// The best feature so far, lane by lane.
#[derive(Clone, Copy)]
struct BestFeature<D> {
    square: D,
    offset: [D; 3],
    weights: [D; 3],
    /// The code of the feature.
    feature: D,
}

impl<D: Doubles> BestFeature<D> {
    /// Replaces the feature in the lanes where a mask is true.
    #[inline(always)]
    fn replace(&mut self, mask: D::Mask, other: Self) {
        self.square = D::select(mask, other.square, self.square);
        self.offset = select(mask, other.offset, self.offset);
        self.weights = select(mask, other.weights, self.weights);
        self.feature = D::select(mask, other.feature, self.feature);
    }

    /// Stores the result. The nearest point lies in the box `bounds`, and equals `vertex` where the feature is a
    /// vertex.
    #[inline(always)]
    fn store(
        self,
        query: [D; 3],
        [low, high]: [[D; 3]; 2],
        vertex: [D; 3],
        size: D,
        is_uncertain: D::Mask,
    ) -> LaneResults {
        let is_vertex = self.feature.is_at_most(D::splat(2.0));
        let point = select(is_vertex, vertex, clamp(add(query, self.offset), low, high));
        let zero = D::splat(0.0);
        let [x, y, z] = self.offset;
        let is_zero = x.equals(zero) & y.equals(zero) & z.equals(zero);
        let is_plain = D::splat(SQUARE_MIN).is_at_most(self.square) & self.square.is_below(D::splat(SQUARE_MAX));
        let mut result = LaneResults {
            square: [0.0; SIDE_BY_SIDE],
            point: [[0.0; SIDE_BY_SIDE]; 3],
            weights: [[0.0; SIDE_BY_SIDE]; 3],
            size: [0.0; SIDE_BY_SIDE],
            feature: [0.0; SIDE_BY_SIDE],
            lower_bound: [0.0; SIDE_BY_SIDE],
            certain: D::bits((is_plain | is_zero) & !is_uncertain),
            skipped: 0,
        };
        self.square.store(&mut result.square);
        for k in 0..3 {
            point[k].store(&mut result.point[k]);
            self.weights[k].store(&mut result.weights[k]);
        }
        size.store(&mut result.size);
        (self.square.sqrt() - D::splat(ERROR_PER_SIZE) * size).store(&mut result.lower_bound);
        self.feature.store(&mut result.feature);
        result
    }
}

/// Returns whether the largest component of the offsets is in the plain range.
#[inline(always)]
fn is_plain_size<D: Doubles>(size: D) -> D::Mask {
    D::splat(MIN_PLAIN_SIZE).is_at_most(size) & size.is_at_most(D::splat(MAX_PLAIN_SIZE))
}

/// Returns whether the single kernel would use plain f64 for these offsets, given their largest component and the
/// inverse square of the shortest edge.
#[inline(always)]
fn is_plain<D: Doubles>(size: D, inverse: D) -> D::Mask {
    is_plain_size(size) & (inverse * (size * size)).is_at_most(D::splat(MAX_SIZE_PER_EDGE_SQUARED))
}

/// Returns the line of edge i. Without ties, the nearer end is the end with the smaller square.
#[inline(always)]
fn line<D: Doubles>(offsets: &[[D; 3]; 3], squares: &[D; 3], i: usize) -> EdgeLine<D> {
    let [j, k] = EDGES[i];
    EdgeLine::from_nearer_end([offsets[j], offsets[k]], [squares[j], squares[k]], squares[k].is_below(squares[j]))
}

/// The most triangles that may be skipped if the nearest points of all others are vertices. There is no record of how
/// the number was tuned.
const MAX_SKIPPED: u32 = 3;

/// The nearest vertices of eight triangles.
#[derive(Clone, Copy)]
struct NearestVertices<D: Doubles> {
    query: [D; 3],
    vertices: [[D; 3]; 3],
    /// The vectors from the query points to the vertices.
    offsets: [[D; 3]; 3],
    /// The box around the offsets, and the largest component.
    offset_bounds: [[D; 3]; 2],
    size: D,
    /// The squared lengths of the offsets.
    squares: [D; 3],
    /// The index of the nearest vertex.
    nearest: Choice<D>,
    /// The nearest vertex as a feature.
    vertex: BestFeature<D>,
    /// Whether two vertices are equally near.
    are_tied: D::Mask,
    /// Whether both edges at the nearest vertex clearly lead away from the query, so that the vertex is the nearest
    /// point.
    is_vertex: D::Mask,
}

impl<D: Doubles> NearestVertices<D> {
    #[inline(always)]
    fn new(eight: &TriangleLanes<3>) -> Self {
        let (query, vertices) = eight.load::<D>();
        let offsets = [sub(vertices[0], query), sub(vertices[1], query), sub(vertices[2], query)];
        let offset_bounds = bounds(&offsets);
        let size = largest(&offset_bounds);
        let squares = [norm_squared(offsets[0]), norm_squared(offsets[1]), norm_squared(offsets[2])];
        let are_tied = squares[0].equals(squares[1]) | squares[1].equals(squares[2]) | squares[2].equals(squares[0]);
        let nearest = Choice::smallest(squares);
        let offset = nearest.of_vectors(offsets);
        let next = sub(nearest.of_vectors([offsets[1], offsets[2], offsets[0]]), offset);
        let last = sub(nearest.of_vectors([offsets[2], offsets[0], offsets[1]]), offset);
        let vertex = BestFeature {
            square: nearest.of(squares),
            offset,
            weights: nearest.weights(),
            feature: nearest.of([D::splat(0.0), D::splat(1.0), D::splat(2.0)]),
        };
        let least = smaller(dot(offset, next), dot(offset, last));
        let is_vertex = (D::splat(OUTWARD_MARGIN) * (size * size)).is_below(least);
        Self { query, vertices, offsets, offset_bounds, size, squares, nearest, vertex, are_tied, is_vertex }
    }

    /// Returns whether the nearest point is certainly a vertex.
    #[inline(always)]
    fn is_certain(&self) -> D::Mask {
        self.is_vertex & is_plain_size(self.size) & !self.are_tied
    }

    /// Returns one bit per triangle: whether its nearest point may be other than a vertex.
    #[inline(always)]
    fn uncertain_lanes(&self) -> u8 {
        !D::bits(self.is_certain())
    }

    /// Returns the results of the triangles whose nearest point is certainly a vertex, and skips the others.
    #[inline(always)]
    fn certain(&self) -> LaneResults {
        let point = self.nearest.of_vectors(self.vertices);
        let found = self.vertex.store(self.query, [point, point], point, self.size, !self.is_certain());
        LaneResults { skipped: self.uncertain_lanes(), ..found }
    }
}

/// Returns the squared distance of each of eight triangles whose nearest point is certainly a vertex, with the bits of
/// the single kernel, and infinity for the others.
#[inline(always)]
#[must_use]
pub fn certain_vertex_squares<D: Doubles>(eight: &TriangleLanes<3>) -> Row {
    let around = NearestVertices::<D>::new(eight);
    let mut squares = [0.0; SIDE_BY_SIDE];
    D::select(around.is_certain(), around.vertex.square, D::splat(f64::INFINITY)).store(&mut squares);
    squares
}

/// Computes the nearest points of eight triangles.
///
/// If `may_skip`, and the nearest point of most of them is a vertex, the others are skipped.
#[inline(always)]
#[must_use]
fn triangles<D: Doubles>(eight: &TriangleLanes<3>, may_skip: bool) -> LaneResults {
    let around = NearestVertices::<D>::new(eight);
    if may_skip && around.uncertain_lanes().count_ones() <= MAX_SKIPPED {
        return around.certain();
    }
    let NearestVertices {
        query,
        vertices,
        offsets,
        offset_bounds,
        size,
        squares,
        nearest,
        vertex,
        are_tied,
        is_vertex,
    } = around;
    let zero = D::splat(0.0);

    let lines = [line(&offsets, &squares, 0), line(&offsets, &squares, 1), line(&offsets, &squares, 2)];
    let inverses = [lines[0].inverse, lines[1].inverse, lines[2].inverse];
    let mut is_uncertain = !is_plain(size, larger(larger(inverses[0], inverses[1]), inverses[2]));

    // The longest edge has the smallest inverse square.
    let longest = Choice::smallest(inverses);
    let ends = [
        select(lines[0].is_second_nearer, offsets[1], offsets[0]),
        select(lines[1].is_second_nearer, offsets[2], offsets[1]),
        select(lines[2].is_second_nearer, offsets[0], offsets[2]),
    ];
    let base = EdgeLine {
        is_second_nearer: lines[0].is_second_nearer,
        direction: longest.of_vectors([lines[0].direction, lines[1].direction, lines[2].direction]),
        inverse: longest.of(inverses),
        t: longest.of([lines[0].t, lines[1].t, lines[2].t]),
        square: longest.of([lines[0].square, lines[1].square, lines[2].square]),
    };
    let shorter =
        [longest.of([inverses[1], inverses[2], inverses[0]]), longest.of([inverses[2], inverses[0], inverses[1]])];
    is_uncertain = is_uncertain | base.inverse.equals(shorter[0]) | base.inverse.equals(shorter[1]);
    let n = longest.of_vectors(ends);
    let (plane, is_outside) = FacePlane::new(&base, n, longest.of_vectors([offsets[2], offsets[0], offsets[1]]), size);
    is_uncertain = is_uncertain | plane.is_sliver() & !is_outside;
    let (estimate, error_factor) = plane.estimate();
    let mut rough = smaller(vertex.square, D::select(is_outside, D::splat(f64::INFINITY), estimate));
    for line in &lines {
        let is_inside = zero.is_below(line.t) & line.t.is_below(D::splat(1.0));
        rough = D::select(is_inside, smaller(line.square, rough), rough);
    }
    let error_factor = D::select(is_outside, D::splat(1.0), error_factor);
    let limit = rough + D::splat(ROUGH_SQUARE_MARGIN) * error_factor * (size * size);

    let mut best = vertex;
    let face_bounds = bounds(&vertices);
    let [mut low, mut high] = face_bounds;
    for i in 0..3 {
        let [j, k] = EDGES[i];
        let (foot, is_inside) = lines[i].foot([offsets[j], offsets[k]]);
        let is_accepted = is_inside & lines[i].square.is_at_most(limit);
        let is_nearer = is_accepted & foot.square.is_below(best.square);
        is_uncertain = is_uncertain | is_accepted & foot.square.equals(best.square);
        let mut weights = [zero; 3];
        (weights[j], weights[k]) = edge_weights(&lines[i], foot.t);
        let feature = D::splat(edge_feature_code(i));
        best.replace(is_nearer, BestFeature { square: foot.square, offset: foot.offset, weights, feature });
        let edge_bounds = bounds(&[vertices[j], vertices[k]]);
        (low, high) = (select(is_nearer, edge_bounds[0], low), select(is_nearer, edge_bounds[1], high));
    }
    let (foot, least) = plane.ordinary_foot(n, offset_bounds);
    let may_be_inside = !is_outside & plane.may_be_within(limit) & zero.is_below(least);
    is_uncertain = is_uncertain | may_be_inside & least.is_below(D::splat(MIN_CERTAIN_WEIGHT));
    let is_nearer = may_be_inside & foot.square.is_below(best.square);
    let weights = face_weights(foot.weights, longest, &lines);
    let feature = D::splat(FACE_CODE);
    best.replace(is_nearer, BestFeature { square: foot.square, offset: foot.offset, weights, feature });
    (low, high) = (select(is_nearer, face_bounds[0], low), select(is_nearer, face_bounds[1], high));

    best.replace(is_vertex, vertex);
    is_uncertain = are_tied | !is_plain_size(size) | is_uncertain & !is_vertex;
    best.store(query, [low, high], nearest.of_vectors(vertices), size, is_uncertain)
}

/// Returns the weights of the two ends of an edge for a foot at `t`.
#[inline(always)]
fn edge_weights<D: Doubles>(line: &EdgeLine<D>, t: D) -> (D, D) {
    let rest = D::splat(1.0) - t;
    (D::select(line.is_second_nearer, t, rest), D::select(line.is_second_nearer, rest, t))
}

/// Returns the weights of a foot on a face in the order of the vertices. The arguments are the weights of the nearer
/// and the farther end of the longest edge, and of the apex.
#[inline(always)]
fn face_weights<D: Doubles>([wn, wf, wa]: [D; 3], longest: Choice<D>, lines: &[EdgeLine<D>; 3]) -> [D; 3] {
    let mut ends = [[wn; 2]; 3];
    for i in 0..3 {
        let is_second_nearer = lines[i].is_second_nearer;
        ends[i] = [D::select(is_second_nearer, wf, wn), D::select(is_second_nearer, wn, wf)];
    }
    // Edge i runs from vertex i to vertex i + 1, and the apex is the third vertex.
    [
        longest.of([ends[0][0], wa, ends[2][1]]),
        longest.of([ends[0][1], ends[1][0], wa]),
        longest.of([wa, ends[1][1], ends[2][0]]),
    ]
}

/// Computes the nearest points of eight segments.
#[inline(always)]
#[must_use]
fn segments<D: Doubles>(eight: &TriangleLanes<2>) -> LaneResults {
    let (query, vertices) = eight.load::<D>();
    let (zero, one) = (D::splat(0.0), D::splat(1.0));
    let offsets = [sub(vertices[0], query), sub(vertices[1], query)];
    let size = largest(&offsets);
    let squares = [norm_squared(offsets[0]), norm_squared(offsets[1])];
    let is_second = squares[1].is_below(squares[0]);
    let line = EdgeLine::from_nearer_end(offsets, squares, is_second);
    let is_uncertain = squares[0].equals(squares[1]) | !is_plain(size, line.inverse);
    let mut best = BestFeature {
        square: D::select(is_second, squares[1], squares[0]),
        offset: select(is_second, offsets[1], offsets[0]),
        weights: [D::select(is_second, zero, one), D::select(is_second, one, zero), zero],
        feature: D::select(is_second, one, zero),
    };
    let (foot, is_inside) = line.foot(offsets);
    let is_nearer = is_inside & foot.square.is_below(best.square);
    let (first, second) = edge_weights(&line, foot.t);
    let weights = [first, second, zero];
    let feature = D::splat(edge_feature_code(0));
    best.replace(is_nearer, BestFeature { square: foot.square, offset: foot.offset, weights, feature });
    best.store(query, bounds(&vertices), select(is_second, vertices[1], vertices[0]), size, is_uncertain)
}

/// Computes the nearest points of eight triangles with an instruction set. If `may_skip`, and a vertex is the nearest
/// point of most of them, the others are left out. No lane is certain if lanes of f64 are slower than the single kernel.
#[inline(never)]
#[must_use]
pub fn evaluate_triangles(isa: Isa, eight: &TriangleLanes<3>, may_skip: bool) -> LaneResults {
    isa.run_in_doubles(Triangles(eight, may_skip), LaneResults::default)
}

/// Computes the nearest points of eight segments with an instruction set. No lane is certain if lanes of f64 are slower than the single kernel.
#[inline(never)]
#[must_use]
pub fn evaluate_segments(isa: Isa, eight: &TriangleLanes<2>) -> LaneResults {
    isa.run_in_doubles(Segments(eight), LaneResults::default)
}

struct Triangles<'a>(&'a TriangleLanes<3>, bool);
struct Segments<'a>(&'a TriangleLanes<2>);

impl SimdKernel for Triangles<'_> {
    type Output = LaneResults;
    #[inline(always)]
    fn run<I: InstructionSet>(self) -> LaneResults {
        triangles::<I::Doubles>(self.0, self.1)
    }
}

impl SimdKernel for Segments<'_> {
    type Output = LaneResults;
    #[inline(always)]
    fn run<I: InstructionSet>(self) -> LaneResults {
        segments::<I::Doubles>(self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Feature;
    use p2m_testkit::families;
    use rand::{Rng, RngExt};

    struct CertainVertices<'a>(&'a TriangleLanes<3>);

    impl SimdKernel for CertainVertices<'_> {
        type Output = Row;
        #[inline(always)]
        fn run<I: InstructionSet>(self) -> Row {
            certain_vertex_squares::<I::Doubles>(self.0)
        }
    }

    /// The bits of a projection.
    fn bits(p: &Projection) -> (Key, [u64; 3], Feature, [u64; 3], u64) {
        let point: [f64; 3] = p.point.coords.into();
        (p.key, point.map(f64::to_bits), p.feature, p.barycentric.map(f64::to_bits), p.error.to_bits())
    }

    /// Returns a query and a primitive with this number of vertices. Half of the cases are built to break kernels, and
    /// the others have ordinary shapes and sizes.
    fn case(rng: &mut impl Rng, vertex_count: usize) -> ([f64; 3], Vec<[f64; 3]>) {
        if rng.random_range(0..2) == 0 {
            loop {
                let case = families::case(rng);
                if case.vertices.len() == vertex_count {
                    return (case.query, case.vertices);
                }
            }
        }
        let away = 2f64.powi(rng.random_range(-20..8));
        let mut point = |size: f64| [(); 3].map(|()| rng.random_range(-size..size));
        let vertices: Vec<[f64; 3]> = (0..vertex_count).map(|_| point(1.0)).collect();
        let weights = point(1.0).map(f64::abs);
        let sum: f64 = weights[..vertex_count].iter().sum();
        let offset = point(away);
        let on = |k: usize| (0..vertex_count).map(|v| vertices[v][k] * weights[v] / sum).sum::<f64>();
        ([0, 1, 2].map(|k: usize| on(k) + offset[k]), vertices)
    }

    /// Compares eight primitives side by side with the single kernel, on every instruction set, and returns the
    /// features of the certain lanes.
    fn compare<const N: usize>(
        rng: &mut impl Rng,
        run: impl Fn(Isa, &TriangleLanes<N>, bool) -> LaneResults,
        single: impl Fn([f64; 3], [[f64; 3]; N]) -> Projection,
    ) -> Vec<Feature> {
        let cases: Vec<_> = (0..SIDE_BY_SIDE).map(|_| case(rng, N)).collect();
        let mut eight = TriangleLanes::default();
        for (lane, (query, vertices)) in cases.iter().enumerate() {
            eight.set(lane, query, std::array::from_fn(|v| &vertices[v]));
        }
        let mut features = Vec::new();
        for (isa, may_skip) in Isa::available().into_iter().flat_map(|isa| [(isa, true), (isa, false)]) {
            let found = run(isa, &eight, may_skip);
            features.clear();
            for (lane, (query, vertices)) in cases.iter().enumerate() {
                let expected = single(*query, std::array::from_fn(|v| vertices[v]));
                if let Some(found) = found.projection(lane) {
                    assert_eq!(bits(&found), bits(&expected), "{isa}: {query:?} {vertices:?}");
                    features.push(found.feature);
                }
            }
        }
        features
    }

    #[test]
    fn lanes_of_triangles_have_the_bits_of_the_single_kernel() {
        let mut counts = [0; 8];
        let certain_vertex_count = std::cell::Cell::new(0u32);
        let cases = p2m_testkit::cases(40_000, 4_000);
        for case in cases.clone() {
            let mut rng = p2m_testkit::rng("triangles side by side", case);
            let features = compare::<3>(
                &mut rng,
                |isa, eight, may_skip| {
                    let found = isa.run(Triangles(eight, may_skip));
                    for (lane, square) in isa.run(CertainVertices(eight)).into_iter().enumerate() {
                        let certain = found.projection(lane).filter(|p| matches!(p.feature, Feature::Vertex(_)));
                        let key = certain.and_then(|p| p.key.plain_square());
                        assert!(square == f64::INFINITY || key == Some(square), "{isa}, lane {lane}: {square}");
                        certain_vertex_count.set(certain_vertex_count.get() + u32::from(square < f64::INFINITY));
                    }
                    found
                },
                |q, v| Projection::onto_near_triangle(q, &v, f64::INFINITY).expect("no key exceeds infinity"),
            );
            counts[7] += SIDE_BY_SIDE - features.len();
            for feature in features {
                counts[usize::from(feature.code())] += 1;
            }
        }
        println!("certain lanes by feature, and others: {counts:?}");
        assert!(cases.have_more_than(8_000, counts.into_iter().min().unwrap_or(0)), "{counts:?}");
        assert!(cases.have_more_than(8_000, certain_vertex_count.get() as usize), "{certain_vertex_count:?}");
    }

    #[test]
    fn lanes_of_segments_have_the_bits_of_the_single_kernel() {
        let mut counts = [0; 4];
        let cases = p2m_testkit::cases(20_000, 2_000);
        for case in cases.clone() {
            let mut rng = p2m_testkit::rng("segments side by side", case);
            let features = compare::<2>(
                &mut rng,
                |isa, eight, _| isa.run(Segments(eight)),
                |q, v| Projection::onto_segment(q, &v, f64::INFINITY).expect("no key exceeds infinity"),
            );
            counts[3] += SIDE_BY_SIDE - features.len();
            for feature in features {
                counts[match feature {
                    Feature::Vertex(i) => usize::from(i),
                    _ => 2,
                }] += 1;
            }
        }
        println!("certain lanes by feature, and others: {counts:?}");
        assert!(cases.have_more_than(8_000, counts.into_iter().min().unwrap_or(0)), "{counts:?}");
    }
}
