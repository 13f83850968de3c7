//! The values of the function of the corner test at some corners, for the lanes of a packet.

use crate::list::corner_test::{DistancesAtPoint, LaneDistances, LeastOfLanes};
use crate::voronoi::cell_polytope::CornerPoints;
use p2m_bvh::PacketTree;
use p2m_bvh::engine::packet::{LANES, Locals, PLACES, Packet};
use p2m_core::engine::side_by_side::{SIDE_BY_SIDE, TriangleLanes, evaluate_triangles};
use p2m_core::engine::simd::{InstructionSet, SimdKernel};
use p2m_core::engine::vector::V3;
use p2m_core::{Best, QueryOptions};

/// The distance from a packet, in its units, from which on its filter is too imprecise. Primitives are evaluated
/// exactly there.
const FILTER_RANGE_UNITS: f64 = (1u64 << 19) as f64;

/// The values of one packet at some corners. Its vectors are reused.
#[derive(Default)]
pub(crate) struct CornerValues {
    /// For each corner the values of the lanes, rounded down, in squares of the unit of the packet.
    pub(crate) values: Vec<[f32; LANES]>,
    /// The lanes whose value is not above zero at some corner, as bits.
    pub(crate) near_lanes: u16,
    /// For each corner the lanes whose value is not above zero there.
    pub(crate) lanes_below: Vec<u16>,
    /// The number of tests of a packet at a corner, and of evaluated primitives.
    pub(crate) tests: usize,
}

/// The lower bounds of the distances from a site to the lanes of a packet.
pub(crate) struct SiteDistances<'a> {
    /// The tree, for its instruction set.
    pub(crate) tree: &'a PacketTree,
    /// The distances from the site.
    pub(crate) distances: LaneDistances,
}

impl<'a> SiteDistances<'a> {
    /// Runs the filter of a packet at a site.
    pub(crate) fn new(tree: &'a PacketTree, packet: &Packet, site: &V3) -> Self {
        Self { tree, distances: tree.isa().run(DistancesAtPoint { packet, point: site }).0 }
    }

    /// Returns a lower bound of the distance to the nearest of some lanes, in the unit of the packet.
    pub(crate) fn least(&self, lanes: u16) -> f64 {
        self.tree.isa().run(LeastOfLanes { distances: &self.distances, lanes })
    }
}

impl CornerValues {
    /// Computes the values of some lanes of a packet at some corners. Other lanes have values as well, which may be
    /// lower, and are not near.
    pub(crate) fn compute(&mut self, corners: &CornerPoints, packet: &Packet, lanes: u16, tree: &PacketTree) {
        self.values.clear();
        self.tests += corners.positions.len();
        self.near_lanes = lanes & tree.isa().run(EvaluateCorners { corners, packet, values: &mut self.values });
        if packet.has_vertices() && corners.max_upper_bound * packet.per_unit() >= FILTER_RANGE_UNITS {
            let (values, lanes) = (&mut self.values[..], self.near_lanes);
            self.tests += EvaluateAtFarCorners { corners, packet, tree, lanes, values }.run();
        }
        self.lanes_below.clear();
        for values in &self.values {
            let mut lanes = 0;
            for (lane, value) in values.iter().enumerate() {
                lanes |= u16::from(*value <= 0.0) << lane;
            }
            self.lanes_below.push(lanes);
        }
        self.near_lanes &= self.lanes_below.iter().fold(0, |all, lanes| all | lanes);
    }

    /// Records that all values at a corner are above zero, which another test has shown.
    pub(crate) fn raise_above_zero(&mut self, corner: usize) {
        self.lanes_below[corner] = 0;
        self.values[corner].iter_mut().for_each(|value| *value = value.max(f32::MIN_POSITIVE));
    }
}

/// A SIMD kernel that computes the values of a packet at some corners. It returns the lanes whose value is not above
/// zero at some corner.
struct EvaluateCorners<'a> {
    corners: &'a CornerPoints,
    packet: &'a Packet,
    values: &'a mut Vec<[f32; LANES]>,
}

impl SimdKernel for EvaluateCorners<'_> {
    type Output = u16;

    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "rounded down; sixteen lanes")]
    fn run<I: InstructionSet>(self) -> u16 {
        let Self { corners, packet, values } = self;
        let mut near_lanes = 0;
        let per_unit = packet.per_unit();
        let (mut locals, mut squares) = (Locals::default(), [[0.0; LANES]; PLACES]);
        let lengths = corners.upper_bounds.chunks(PLACES).zip(corners.errors.chunks(PLACES));
        for (positions, (upper_bounds, errors)) in corners.positions.chunks(PLACES).zip(lengths) {
            packet.squares_at_points::<I>(positions, &mut locals, &mut squares);
            for (place, (upper_bound, error)) in upper_bounds.iter().zip(errors).enumerate() {
                // The value is unknown if f32 cannot represent the corner in the frame of the packet.
                let mut lane_values = [f32::NEG_INFINITY; LANES];
                if locals.far >> place & 1 == 0 {
                    let max_error = locals.excess[place] + ((error * per_unit) as f32) * 1.001;
                    let upper_bound = (upper_bound * per_unit) as f32 * (1.0 + 4.0 * f32::EPSILON);
                    for (value, square) in lane_values.iter_mut().zip(squares[place]) {
                        let least = (square.sqrt() * (1.0 - 4.0 * f32::EPSILON) - max_error).max(0.0);
                        // The product form keeps the relative precision of the difference of two squares, which may be
                        // much smaller than both.
                        *value = (least - upper_bound) * (least + upper_bound);
                    }
                }
                for (lane, value) in lane_values.iter().enumerate() {
                    near_lanes |= u32::from(*value <= 0.0) << lane;
                }
                values.push(lane_values);
            }
        }
        (near_lanes & packet.lanes()) as u16
    }
}

/// The evaluation of primitives at corners that are too far from the packet for its filter, unless the filter has
/// excluded them.
struct EvaluateAtFarCorners<'a> {
    corners: &'a CornerPoints,
    packet: &'a Packet,
    tree: &'a PacketTree,
    /// The lanes in question.
    lanes: u16,
    values: &'a mut [[f32; LANES]],
}

impl EvaluateAtFarCorners<'_> {
    /// Evaluates the primitives of some corners and lanes, which have places in `eight`.
    fn evaluate(&mut self, eight: &TriangleLanes<3>, places: &[(usize, usize)]) {
        let nearest = evaluate_triangles(self.tree.isa(), eight, false);
        for (place, &(corner, lane)) in places.iter().enumerate() {
            match nearest.square_and_lower_bound(place) {
                Some((square, _)) => self.raise(corner, lane, square.sqrt()),
                None => self.evaluate_single(corner, lane),
            }
        }
    }

    /// Evaluates the primitive in a lane at a corner.
    #[cold]
    fn evaluate_single(&mut self, corner: usize, lane: usize) {
        let mut best = Best::<f64>::new(&QueryOptions::default());
        let vertices = &self.tree.leaves.vertices;
        self.packet.offer(lane, vertices, self.corners.positions[corner], f64::INFINITY, &mut best);
        if let Some(closest) = best.finish() {
            self.raise(corner, lane, closest.distance);
        }
    }

    /// Raises a value to the value that a distance gives.
    #[allow(clippy::cast_possible_truncation, reason = "rounded down")]
    fn raise(&mut self, corner: usize, lane: usize, distance: f64) {
        let (upper_bound, per_unit) = (self.corners.upper_bounds[corner], self.packet.per_unit());
        // The bound is lowered by the rounding of the kernel.
        let least = distance * (1.0 - 1e-14) - upper_bound * 1e-14 - self.corners.errors[corner];
        let value = (least - upper_bound) * (least + upper_bound) * per_unit * per_unit;
        let to = &mut self.values[corner][lane];
        *to = to.max((value as f32).next_down());
    }

    /// Returns the number of evaluations.
    fn run(mut self) -> usize {
        let (mut eight, mut places, mut pending, mut tests) = (TriangleLanes::default(), [(0, 0); SIDE_BY_SIDE], 0, 0);
        for corner in 0..self.values.len() {
            if self.corners.upper_bounds[corner] * self.packet.per_unit() < FILTER_RANGE_UNITS {
                continue;
            }
            for lane in 0..LANES {
                if self.lanes >> lane & 1 == 0 || self.values[corner][lane] > 0.0 {
                    continue;
                }
                tests += 1;
                let Some(vertices) = self.packet.triangle_corners(lane, &self.tree.leaves.vertices) else {
                    self.evaluate_single(corner, lane);
                    continue;
                };
                eight.set(pending, &self.corners.positions[corner], vertices);
                places[pending] = (corner, lane);
                pending += 1;
                if pending == SIDE_BY_SIDE {
                    self.evaluate(&eight, &places);
                    pending = 0;
                }
            }
        }
        if pending > 0 {
            // The other places have a triangle already, or none.
            self.evaluate(&eight, &places[..pending]);
        }
        tests
    }
}
