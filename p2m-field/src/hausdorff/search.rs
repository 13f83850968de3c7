//! The branch and bound of a Hausdorff distance.
//!
//! In pseudo-code:
//!
//! ```text
//! query all vertices; lower = the largest of their distances, certified
//! queue = the primitives of which some point may be farther than lower + tolerance
//! while the largest upper bound in the queue exceeds lower + tolerance:
//!     take the pieces with the largest upper bounds: an eighth of the queue, but at least 1024
//!     query one point of each piece: a point inside at first, later the middle of its longest edge
//!     raise lower to the largest of these distances, certified
//!     for each piece, or for its halves if the middle of an edge was queried:
//!         bound it by the primitives that are nearest to its corners and to the point inside
//!         return it to the queue if the bound exceeds lower + tolerance
//! upper = the largest bound in the queue, or of a piece that did not return to it
//! ```

use super::covering::{MAX_SHAPES, Part};
use super::{Direction, HausdorffDistance, HausdorffIndex, HausdorffOptions, HausdorffProgress, ReportProgress};
use nalgebra::Point3;
use p2m_core::batch::{self, BatchOptions, ClosestColumns};
use p2m_core::engine::real::{from_f64_array, to_f64_array};
use p2m_core::engine::vector::V3;
use p2m_core::{CertifyError, Closest, Primitive, PrimitiveId, PrimitiveSet, QueryOptions, Real, Shape, Soup};
use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::ops::ControlFlow;

/// The least number of pieces that are improved in a round. Some of them could be left out if they were improved one by
/// one, but their queries are answered side by side on all threads.
const MIN_PIECES_PER_ROUND: usize = 1 << 10;
/// Each round improves one over this number of a long queue. Most of its pieces have to be cut anyway, and many queries
/// at once visit the index in a better order.
const ROUNDS_PER_QUEUE: usize = 8;
/// The number of vertices or primitives that are handled between two reports of progress.
const ITEMS_PER_REPORT: usize = 1 << 18;
/// The factor by which an upper bound of a few roundings is enlarged.
const ROUND_UP: f64 = 1.0 + 8.0 * f64::EPSILON;
/// A bound on what the roundings of subnormal numbers add to an upper bound.
const SUBNORMALS: f64 = f64::from_bits(8);

/// One direction of the search: a scene whose points are measured, and an index of the other scene.
#[derive(Clone, Copy)]
pub(super) struct Side<'a, T: Real> {
    pub(super) surface: &'a Soup<T>,
    pub(super) target: &'a dyn HausdorffIndex<T>,
}

/// A point whose distance is known.
struct Corner<T: Real> {
    point: Point3<T>,
    distance: T,
    /// The nearest primitive of the other scene.
    nearest: u32,
}

/// A part of a primitive whose bound exceeds the limit.
#[derive(Clone, Copy)]
struct Piece {
    /// An upper bound on the distances of its points.
    upper: f64,
    /// The indices of its corners. A point has its corner three times, and a segment has its second corner twice.
    corners: [u32; 3],
    /// The primitive that it is a part of.
    primitive: u32,
    /// A primitive of the other scene that is probably near all of its points.
    candidate: u32,
    /// The number of cuts that it results from.
    depth: u16,
    side: u8,
    /// Whether the nearest primitive of a point inside was queried, or is not needed.
    is_sampled: bool,
    /// Whether rounding leaves nothing to gain by a cut.
    is_final: bool,
}

impl PartialEq for Piece {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Piece {}

impl PartialOrd for Piece {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Piece {
    fn cmp(&self, other: &Self) -> Ordering {
        self.upper.total_cmp(&other.upper)
    }
}

/// A query that improves the bound of a piece.
struct Step<T: Real> {
    piece: Piece,
    point: Point3<T>,
    /// The number of the edge that the point cuts; `None` for a point inside.
    edge: Option<usize>,
    /// The index that the point has among the corners.
    corner: u32,
}

/// An upper bound on the distances of the points of a piece from the other scene.
struct Bound {
    upper: f64,
    /// The primitive that the bound follows from.
    primitive: u32,
    is_final: bool,
}

/// The point that attains the lower bound.
struct Farthest<T: Real> {
    /// Its computed distance, less its drift.
    estimate: f64,
    point: Point3<T>,
    side: usize,
    /// The primitive that contains it; `None` for a vertex.
    primitive: Option<u32>,
    closest: Closest<T>,
}

pub(super) struct Search<'a, T: Real> {
    sides: &'a [Side<'a, T>],
    options: &'a HausdorffOptions<T>,
    tolerance: f64,
    corners: Vec<Corner<T>>,
    pieces: BinaryHeap<Piece>,
    /// An upper bound on the distances of all points that are in no piece of the queue.
    settled: f64,
    /// The certified lower bound.
    lower: f64,
    farthest: Option<Farthest<T>>,
    /// The number of corners that are vertices of the scenes.
    vertices: usize,
}

impl<'a, T: Real> Search<'a, T> {
    pub(super) fn new(sides: &'a [Side<'a, T>], options: &'a HausdorffOptions<T>) -> Self {
        Self {
            sides,
            options,
            // NaN becomes 0 as well.
            tolerance: options.tolerance.to_f64().max(0.0),
            corners: Vec::new(),
            pieces: BinaryHeap::new(),
            settled: f64::INFINITY,
            lower: 0.0,
            farthest: None,
            vertices: 0,
        }
    }

    /// Returns the bounds, or `None` if a scene is empty.
    pub(super) fn run(
        mut self,
        progress: &mut ReportProgress<'_, T>,
    ) -> Result<Option<HausdorffDistance<T>>, CertifyError> {
        for side in self.sides {
            let Some(first) = side.surface.elements().next() else { return Ok(None) };
            let point = side.surface.positions()[first.indices()[0] as usize];
            if side.target.closest_point(&point).is_none() {
                return Ok(None);
            }
        }
        let flow = self.start(progress)?;
        if flow.is_continue() {
            while self.improve()? && progress(&self.progress()).is_continue() {}
        }
        Ok(self.finish())
    }

    /// Queries all vertices, and puts the primitives that their distances do not settle into the queue.
    fn start(&mut self, progress: &mut ReportProgress<'_, T>) -> Result<ControlFlow<()>, CertifyError> {
        let mut corners_of_sides = Vec::new();
        for (number, side) in self.sides.iter().enumerate() {
            let (used, corner_of_position) = used_positions(side.surface, self.corners.len());
            corners_of_sides.push(corner_of_position);
            for points in used.chunks(ITEMS_PER_REPORT) {
                let first = self.corners.len();
                self.ask(number, points);
                let farthest = (first..self.corners.len()).map(|i| (self.corners[i].distance.to_f64(), i));
                if let Some((distance, i)) = farthest.reduce(|a, b| if b.0 > a.0 { b } else { a }) {
                    self.raise_lower_bound(distance, i, number, None, 0.0)?;
                }
                if progress(&self.progress()).is_break() {
                    return Ok(ControlFlow::Break(()));
                }
            }
        }
        self.vertices = self.corners.len();
        let mut settled: f64 = 0.0;
        for (number, corner_of_position) in corners_of_sides.into_iter().enumerate() {
            let surface = self.sides[number].surface;
            for start in (0..surface.len()).step_by(ITEMS_PER_REPORT) {
                let ids = (start..surface.len().min(start + ITEMS_PER_REPORT)).map(PrimitiveId::new);
                let pieces = ids.map(|id| self.whole(number, id, &corner_of_position));
                settled = settled.max(self.queue(pieces.collect())?);
                if progress(&self.progress()).is_break() {
                    return Ok(ControlFlow::Break(()));
                }
            }
        }
        self.settled = settled;
        Ok(ControlFlow::Continue(()))
    }

    /// Returns the piece that is a whole primitive.
    #[allow(clippy::cast_possible_truncation, reason = "there are one or two sides")]
    fn whole(&self, side: usize, id: PrimitiveId, corner_of_position: &[u32]) -> Piece {
        let element = self.sides[side].surface.element(id);
        let corner = |i: u32| corner_of_position[i as usize];
        let corners = match *element.indices() {
            [a, b, c] => [corner(a), corner(b), corner(c)],
            [a, b] => [corner(a), corner(b), corner(b)],
            ref others => [corner(others[0]); 3],
        };
        Piece {
            upper: f64::INFINITY,
            corners,
            primitive: id.number(),
            candidate: self.corners[corners[0] as usize].nearest,
            depth: 0,
            side: side as u8,
            // A segment is cut at its middle, and a point has no other point inside.
            is_sampled: element.indices().len() < 3,
            is_final: false,
        }
    }

    /// Improves the pieces with the largest upper bounds, by one query each. Returns `false` if there is nothing to
    /// improve.
    fn improve(&mut self) -> Result<bool, CertifyError> {
        let limit = self.limit();
        let count = (self.pieces.len() / ROUNDS_PER_QUEUE).max(MIN_PIECES_PER_ROUND) as u64;
        let count = count.min(self.queries_left());
        let mut steps: Vec<Step<T>> = Vec::new();
        while (steps.len() as u64) < count {
            let Some(piece) = self.pieces.peek().filter(|piece| piece.upper > limit) else { break };
            let Some(step) = self.step(piece) else { break };
            self.pieces.pop();
            steps.push(step);
        }
        if steps.is_empty() {
            return Ok(false);
        }
        for number in 0..self.sides.len() {
            let mut of_side: Vec<_> = steps.iter_mut().filter(|step| usize::from(step.piece.side) == number).collect();
            let points: Vec<_> = of_side.iter().map(|step| step.point).collect();
            for (step, corner) in of_side.iter_mut().zip(self.corners.len()..) {
                step.corner = corner_index(corner);
            }
            self.ask(number, &points);
        }
        // Of equally far points, the first one counts.
        let farthest = (steps.iter())
            .map(|step| (self.corners[step.corner as usize].distance.to_f64() - self.drift_of_step(step), step))
            .reduce(|a, b| if b.0 > a.0 { b } else { a });
        if let Some((estimate, step)) = farthest {
            let (corner, drift) = (step.corner as usize, self.drift_of_step(step));
            let Piece { side, primitive, .. } = step.piece;
            self.raise_lower_bound(estimate, corner, usize::from(side), Some(primitive), drift)?;
        }
        let pieces = steps.iter().flat_map(|step| self.after(step)).collect();
        let settled = self.queue(pieces)?;
        self.settled = self.settled.max(settled);
        Ok(true)
    }

    /// Returns the query that improves the bound of a piece, or `None` if no query does.
    fn step(&self, piece: &Piece) -> Option<Step<T>> {
        if piece.is_final {
            return None;
        }
        let points = piece.corners.map(|corner| self.corners[corner as usize].point);
        let edge = longest_edge(&points);
        let middle = middle(&points[edge], &points[(edge + 1) % 3]);
        if middle == points[edge] || middle == points[(edge + 1) % 3] {
            return None;
        }
        let step = Step { piece: *piece, point: middle, edge: Some(edge), corner: 0 };
        if piece.is_sampled {
            return Some(step);
        }
        let inside = self::middle(&middle, &points[(edge + 2) % 3]);
        Some(Step { point: inside, edge: None, ..step })
    }

    /// Returns the pieces that replace a piece, once the query of the step has been answered.
    fn after(&self, step: &Step<T>) -> Vec<Piece> {
        let Some(edge) = step.edge else {
            let candidate = self.corners[step.corner as usize].nearest;
            return vec![Piece { candidate, is_sampled: true, ..step.piece }];
        };
        let piece = Piece { depth: step.piece.depth + 1, ..step.piece };
        let [a, b, c] = [0, 1, 2].map(|i| piece.corners[(edge + i) % 3]);
        let m = step.corner;
        if piece.corners[1] == piece.corners[2] {
            return vec![Piece { corners: [a, m, m], ..piece }, Piece { corners: [b, m, m], ..piece }];
        }
        vec![Piece { corners: [a, m, c], ..piece }, Piece { corners: [m, b, c], ..piece }]
    }

    /// Bounds the distances of pieces, and puts the pieces above the limit into the queue. Returns the largest bound of
    /// the other pieces.
    fn queue(&mut self, mut pieces: Vec<Piece>) -> Result<f64, CertifyError> {
        let limit = self.limit();
        // Scenes mostly have neighbours in order, and sorting the pieces takes longer than it saves.
        let options = BatchOptions::default().with_parallel(self.options.parallel).with_reorder(false);
        let position = |piece: &Piece| self.corners[piece.corners[0] as usize].point.map(T::to_f64);
        let bounds = batch::map(&pieces, &options, position, |piece| self.bound(piece, limit));
        let mut settled: f64 = 0.0;
        for (piece, bound) in pieces.iter_mut().zip(bounds) {
            let bound = bound?;
            // The bound of a piece holds for its parts as well.
            piece.upper = bound.upper.min(piece.upper);
            (piece.candidate, piece.is_final) = (bound.primitive, bound.is_final);
            if piece.upper <= limit {
                settled = settled.max(piece.upper);
            } else {
                self.pieces.push(*piece);
            }
        }
        Ok(settled)
    }

    /// Bounds the distances of the points of a piece, by its candidate and the primitives nearest to its corners, until
    /// a bound is within the limit.
    fn bound(&self, piece: &Piece, limit: f64) -> Result<Bound, CertifyError> {
        let corners = piece.corners.map(|corner| &self.corners[corner as usize]);
        let target = self.sides[usize::from(piece.side)].target;
        let drift = self.drift(piece, piece.depth);
        let reached = corners.map(|corner| corner.distance.to_f64()).into_iter().fold(0.0, f64::max);
        let ids = [piece.candidate, corners[0].nearest, corners[1].nearest, corners[2].nearest];
        let points = corners.map(|corner| corner.point);
        let mut best = Bound { upper: f64::INFINITY, primitive: piece.candidate, is_final: false };
        let (mut shapes, mut shape_count) = ([None; MAX_SHAPES], 0);
        for (i, &id) in ids.iter().enumerate() {
            if ids[..i].contains(&id) {
                continue;
            }
            let id = PrimitiveId::new(id as usize);
            let shape = target.shape(id).ok_or(CertifyError::NoVertices { id })?;
            let rough = (rough_distance(&points, &shape) + drift) * ROUND_UP + SUBNORMALS;
            if rough <= self.lower {
                return Ok(Bound { upper: rough, primitive: id.number(), is_final: false });
            }
            let (mut farthest, mut upper, mut error) = (0.0f64, 0.0f64, 0.0f64);
            for corner in corners {
                let projection = shape.project(&corner.point);
                let distance = projection.key.distance();
                farthest = farthest.max(distance);
                upper = upper.max(distance + projection.error);
                error = error.max(projection.error);
            }
            let upper = (upper + drift) * ROUND_UP + SUBNORMALS;
            if upper < best.upper {
                // The comparison is false for NaN, so that infinite distances are final.
                let can_improve = farthest - reached > 2.0 * (error + drift + 4.0 * T::UNIT_ROUNDOFF * farthest);
                best = Bound { upper, primitive: id.number(), is_final: !can_improve };
            }
            if best.upper <= limit {
                return Ok(best);
            }
            shapes[shape_count] = in_f64(&shape);
            shape_count += 1;
        }
        if best.is_final || shape_count < 2 {
            return Ok(best);
        }
        let cover =
            Part::whole(&points).cover(&shapes[..shape_count], limit - drift, 4.0 * self.drift_of_cut::<f64>(piece));
        let upper = (cover + drift) * ROUND_UP + SUBNORMALS;
        best.upper = best.upper.min(upper);
        Ok(best)
    }

    /// Returns a bound on the distance of a corner of a piece from its exact place, after so many cuts.
    fn drift(&self, piece: &Piece, cuts: u16) -> f64 {
        if cuts == 0 { 0.0 } else { f64::from(cuts) * self.drift_of_cut::<T>(piece) }
    }

    /// Returns a bound on the distance of the middle of an edge, rounded to a scalar, from its exact place, if the ends
    /// are exact.
    fn drift_of_cut<R: Real>(&self, piece: &Piece) -> f64 {
        let primitive = self.sides[usize::from(piece.side)].surface.get(PrimitiveId::new(piece.primitive as usize));
        let size = primitive.vertices().iter().map(|v| v.map(T::to_f64).coords.amax()).fold(0.0, f64::max);
        2.0 * (R::UNIT_ROUNDOFF * size + 2.0 * R::SMALLEST_SUBNORMAL) * ROUND_UP
    }

    /// Returns a bound on the distance of the point of a step from its exact place. A point inside is the middle of a
    /// middle and a corner.
    fn drift_of_step(&self, step: &Step<T>) -> f64 {
        self.drift(&step.piece, step.piece.depth + if step.edge.is_some() { 1 } else { 2 })
    }

    /// Queries the distances of points, and appends the points to the corners.
    fn ask(&mut self, side: usize, points: &[Point3<T>]) {
        let (mut distance, mut nearest) = (vec![T::INFINITY; points.len()], vec![0; points.len()]);
        let columns = ClosestColumns::default().with_distance(&mut distance).with_primitive(&mut nearest);
        let batch = BatchOptions::default().with_parallel(self.options.parallel);
        batch::closest_columns_into(self.sides[side].target, points, &QueryOptions::default(), &batch, columns);
        let answers = points.iter().zip(distance).zip(nearest);
        self.corners.extend(answers.map(|((&point, distance), nearest)| Corner { point, distance, nearest }));
    }

    /// Raises the lower bound to the certified distance of a corner, less its drift, if it is larger. `estimate`
    /// is the computed value.
    fn raise_lower_bound(
        &mut self,
        estimate: f64,
        corner: usize,
        side: usize,
        primitive: Option<u32>,
        drift: f64,
    ) -> Result<(), CertifyError> {
        if self.farthest.as_ref().is_some_and(|farthest| estimate <= farthest.estimate) {
            return Ok(());
        }
        let point = self.corners[corner].point;
        let Some(closest) = self.sides[side].target.certified_closest_point(&point, &QueryOptions::default())? else {
            return Ok(());
        };
        // The difference is rounded by at most a unit in the last place.
        let lower = if drift == 0.0 {
            closest.lower_bound.to_f64()
        } else {
            (closest.lower_bound.to_f64() - drift).next_down()
        };
        if self.farthest.is_none() || lower > self.lower {
            self.lower = lower.max(self.lower);
            self.farthest = Some(Farthest { estimate, point, side, primitive, closest });
        }
        Ok(())
    }

    /// Returns the limit that the upper bounds of all pieces in the queue exceed.
    fn limit(&self) -> f64 {
        self.lower + self.tolerance
    }

    fn upper(&self) -> f64 {
        self.pieces.peek().map_or(self.settled, |piece| piece.upper.max(self.settled))
    }

    fn queries_left(&self) -> u64 {
        // Corners have indices of 32 bits.
        let asked = self.corners.len() - self.vertices;
        let indices = (u32::MAX as usize).saturating_sub(self.corners.len());
        self.options.max_queries.saturating_sub(asked as u64).min(indices as u64)
    }

    fn progress(&self) -> HausdorffProgress<T> {
        HausdorffProgress {
            lower_bound: T::round_down_from_f64(self.lower),
            upper_bound: round_up(self.upper()),
            queries: self.corners.len() as u64,
        }
    }

    fn finish(self) -> Option<HausdorffDistance<T>> {
        let is_tolerance_reached = self.upper() <= self.limit();
        let HausdorffProgress { lower_bound, upper_bound, queries } = self.progress();
        let farthest = self.farthest?;
        let surface = self.sides[farthest.side].surface;
        let has_vertex = |id: &PrimitiveId| surface.get(*id).vertices().contains(&farthest.point);
        let primitive = match farthest.primitive {
            Some(primitive) => PrimitiveId::new(primitive as usize),
            None => (0..surface.len()).map(PrimitiveId::new).find(has_vertex)?,
        };
        let mut points = [farthest.point, farthest.closest.point];
        let mut primitives = [primitive, farthest.closest.primitive];
        let direction = if farthest.side == 0 { Direction::FirstToSecond } else { Direction::SecondToFirst };
        if direction == Direction::SecondToFirst {
            points.swap(0, 1);
            primitives.swap(0, 1);
        }
        Some(HausdorffDistance {
            lower_bound,
            upper_bound,
            is_tolerance_reached,
            points,
            primitives,
            direction,
            queries,
        })
    }
}

/// Returns the positions that primitives use, and the index of each among the corners, from `first` on.
fn used_positions<T: Real>(surface: &Soup<T>, first: usize) -> (Vec<Point3<T>>, Vec<u32>) {
    let positions = surface.positions();
    let mut corner_of_position = vec![u32::MAX; positions.len()];
    let mut used = Vec::new();
    for element in surface.elements() {
        for &i in element.indices() {
            let corner = &mut corner_of_position[i as usize];
            if *corner == u32::MAX {
                *corner = corner_index(first + used.len());
                used.push(positions[i as usize]);
            }
        }
    }
    (used, corner_of_position)
}

#[allow(clippy::cast_possible_truncation, reason = "two scenes have at most 2^32 vertices, and queries are limited")]
fn corner_index(index: usize) -> u32 {
    index as u32
}

/// Returns the number of the longest edge, by its largest component. Edge i runs from corner i to the next.
fn longest_edge<T: Real>(points: &[Point3<T>; 3]) -> usize {
    let length = |i: usize| (points[(i + 1) % 3] - points[i]).amax();
    (1..3).fold(0, |longest, i| if length(i) > length(longest) { i } else { longest })
}

/// Returns an upper bound on the distances of points from a primitive, apart from a few roundings: by the nearest
/// vertex in the sum norm, which takes a tenth of the time of the kernel.
fn rough_distance<T: Real>(points: &[Point3<T>; 3], shape: &Shape<T>) -> f64 {
    let distance = |p: &Point3<T>, v: &Point3<T>| (0..3).map(|k| (p[k].to_f64() - v[k].to_f64()).abs()).sum::<f64>();
    let nearest = |p: &Point3<T>| shape.vertices().iter().map(|v| distance(p, v)).fold(f64::INFINITY, f64::min);
    points.iter().map(nearest).fold(0.0, f64::max)
}

/// Returns a primitive in f64.
fn in_f64<T: Real>(shape: &Shape<T>) -> Option<Shape<f64>> {
    let vertices: [V3; 3] = std::array::from_fn(|i| shape.vertices().get(i).map_or([0.0; 3], to_f64_array));
    Shape::from_vertices(&vertices[..shape.vertices().len()])
}

/// Returns the middle of two points, rounded.
fn middle<T: Real>(a: &Point3<T>, b: &Point3<T>) -> Point3<T> {
    let (a, b) = (to_f64_array(a), to_f64_array(b));
    from_f64_array(std::array::from_fn(|k| a[k] * 0.5 + b[k] * 0.5))
}

/// Returns the least number of the scalar that is not below a number.
fn round_up<T: Real>(value: f64) -> T {
    -T::round_down_from_f64(-value)
}
