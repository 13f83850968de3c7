//! The values of the function of the corner test at some corners, for the lanes of a packet.

use crate::list::corner_test::{DistancesAtPoint, LaneDistances, LeastOfLanes};
use crate::voronoi::cell_polytope::CornerPoints;
use p2m_bvh::PacketTree;
use p2m_bvh::engine::packet::{LANES, Locals, PLACES, Packet};
use p2m_core::engine::simd::{InstructionSet, SimdKernel};
use p2m_core::engine::vector::V3;
use p2m_core::{Best, QueryOptions};

/// The distance, in units of a packet, from which the filter of the packet is too imprecise. Primitives are
/// evaluated exactly instead.
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
    /// Computes the values of a packet at some corners.
    pub(crate) fn compute(&mut self, corners: &CornerPoints, packet: &Packet, tree: &PacketTree) {
        self.values.clear();
        self.tests += corners.positions.len();
        self.near_lanes = tree.isa().run(EvaluateCorners { corners, packet, values: &mut self.values });
        self.evaluate_far_packets(corners, packet, tree);
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

    /// Evaluates primitives at the corners that are so far from the packet that its filter is too imprecise.
    #[allow(clippy::cast_possible_truncation, reason = "rounded down")]
    fn evaluate_far_packets(&mut self, corners: &CornerPoints, packet: &Packet, tree: &PacketTree) {
        let per_unit = packet.per_unit();
        if !packet.has_vertices() || corners.max_upper_bound * per_unit < FILTER_RANGE_UNITS {
            return;
        }
        for (i, values) in self.values.iter_mut().enumerate() {
            let upper_bound = corners.upper_bounds[i];
            if upper_bound * per_unit < FILTER_RANGE_UNITS {
                continue;
            }
            for lane in (0..LANES).filter(|lane| self.near_lanes >> lane & 1 == 1) {
                if values[lane] > 0.0 {
                    continue;
                }
                self.tests += 1;
                let mut best = Best::<f64>::new(&QueryOptions::default());
                packet.offer(lane, &tree.leaves.vertices, corners.positions[i], f64::INFINITY, &mut best);
                let Some(closest) = best.finish() else { continue };
                // The bound is lowered by the rounding of the kernel.
                let least = closest.distance * (1.0 - 1e-14) - upper_bound * 1e-14 - corners.errors[i];
                let value = (least - upper_bound) * (least + upper_bound) * per_unit * per_unit;
                values[lane] = values[lane].max((value as f32).next_down());
            }
        }
    }
}

/// A SIMD kernel that computes the values of a packet at some corners. It returns the lanes that are not above zero at
/// some corner.
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
