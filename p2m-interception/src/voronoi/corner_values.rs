//! EvaluateCorners of the function of the corner test at the corners of a polytope.

use crate::list::corner_test::{DistancesAtPoints, LaneDistances, MinOverLanes};
use crate::voronoi::cell_polytope::CellPolytope;
use p2m_bvh::PacketTree;
use p2m_bvh::engine::packet::{LANES, Packet};
use p2m_core::engine::simd::{InstructionSet, SimdKernel};
use p2m_core::engine::vector::V3;
use p2m_core::{Best, QueryOptions};

/// From so many units of a packet on, filters are not precise enough.
const FILTER_RANGE_UNITS: f64 = (1u64 << 19) as f64;

/// What is known about a packet and a polytope.
#[derive(Default)]
pub(crate) struct CornerValues {
    /// Of each corner the values of the function for the lanes of a packet, rounded down, in squares of its unit.
    pub(crate) values: Vec<[f32; LANES]>,
    /// The lanes that are not above zero at some corner.
    pub(crate) near_lanes: u16,
    /// Of each corner the lanes that are not above zero there; of each edge those that are at one end alone.
    pub(crate) lanes_below: Vec<u16>,
    pub(crate) lanes_crossing: Vec<u16>,
    /// The region of a lane.
    pub(crate) region: Vec<V3>,
    /// How many times packets were tested at a corner, and primitives evaluated.
    pub(crate) tests: usize,
}

/// How far at least the nearest of some lanes of a packet is from a site, in the unit of the packet.
pub(crate) struct SiteDistances<'a> {
    pub(crate) tree: &'a PacketTree,
    pub(crate) distances: [LaneDistances; 1],
}

impl<'a> SiteDistances<'a> {
    pub(crate) fn new(tree: &'a PacketTree, packet: &Packet, site: &V3) -> Self {
        let mut distances = [LaneDistances::UNKNOWN];
        tree.isa().run(DistancesAtPoints { packet, points: &[*site], distances: &mut distances, nearest: &mut [None] });
        Self { tree, distances }
    }

    pub(crate) fn least(&self, lanes: u16) -> f64 {
        self.tree.isa().run(MinOverLanes { distances: &self.distances, lanes })[0]
    }
}

impl CornerValues {
    /// The values of a packet at the corners of a polytope.
    pub(crate) fn compute(&mut self, polytope: &CellPolytope, packet: &Packet, tree: &PacketTree) {
        self.values.clear();
        self.tests += polytope.corners.len();
        self.near_lanes = tree.isa().run(EvaluateCorners { polytope, packet, values: &mut self.values });
        self.evaluate_far_packets(polytope, packet, tree);
        self.lanes_below.clear();
        for values in &self.values {
            let mut lanes = 0;
            for (lane, value) in values.iter().enumerate() {
                lanes |= u16::from(*value <= 0.0) << lane;
            }
            self.lanes_below.push(lanes);
        }
        self.near_lanes &= self.lanes_below.iter().fold(0, |all, lanes| all | lanes);
        self.lanes_crossing.clear();
        let lanes_below = &self.lanes_below;
        self.lanes_crossing
            .extend(polytope.edges.iter().map(|[i, j]| lanes_below[*i as usize] ^ lanes_below[*j as usize]));
    }

    /// Evaluates what the filter is too coarse for: corners from which the packet is small.
    #[allow(clippy::cast_possible_truncation, reason = "rounded down")]
    fn evaluate_far_packets(&mut self, polytope: &CellPolytope, packet: &Packet, tree: &PacketTree) {
        let per_unit = packet.per_unit();
        if !packet.has_vertices() || polytope.max_upper_bound * per_unit < FILTER_RANGE_UNITS {
            return;
        }
        for (i, values) in self.values.iter_mut().enumerate() {
            let reach = polytope.upper_bounds[i];
            if reach * per_unit < FILTER_RANGE_UNITS {
                continue;
            }
            for lane in (0..LANES).filter(|lane| self.near_lanes >> lane & 1 == 1) {
                if values[lane] > 0.0 {
                    continue;
                }
                self.tests += 1;
                let mut best = Best::<f64>::new(&QueryOptions::default());
                packet.offer(lane, &tree.leaves.vertices, polytope.corners[i], f64::INFINITY, &mut best);
                let Some(closest) = best.finish() else { continue };
                // Less for the rounding of the kernel.
                let least = closest.distance * (1.0 - 1e-14) - reach * 1e-14 - polytope.errors[i];
                let value = (least - reach) * (least + reach) * per_unit * per_unit;
                values[lane] = values[lane].max((value as f32).next_down());
            }
        }
    }

    /// The points that span the region of a lane.
    pub(crate) fn find_region(&mut self, polytope: &CellPolytope, lane: usize) {
        self.region.clear();
        for (corner, _) in
            polytope.corners.iter().zip(&self.lanes_below).filter(|(_, lanes_below)| **lanes_below >> lane & 1 == 1)
        {
            self.region.push(*corner);
        }
        for (edge, _) in polytope
            .edges
            .iter()
            .zip(&self.lanes_crossing)
            .filter(|(_, lanes_crossing)| **lanes_crossing >> lane & 1 == 1)
        {
            let [i, j] = edge.map(|i| i as usize);
            let [a, b] = [i, j].map(|i| f64::from(self.values[i][lane]));
            // The part of the way from i, a little farther than the zero of the chord.
            let t = a / (a - b) + if a <= 0.0 { 1e-6 } else { -1e-6 };
            let (from, to) = (polytope.corners[i], polytope.corners[j]);
            self.region.push(std::array::from_fn(|k| from[k] + t * (to[k] - from[k])));
        }
    }
}

/// The function at all corners of a polytope for the lanes of a packet, as an operation: which lanes are not above zero at
/// all of them.
struct EvaluateCorners<'a> {
    polytope: &'a CellPolytope,
    packet: &'a Packet,
    values: &'a mut Vec<[f32; LANES]>,
}

impl SimdKernel for EvaluateCorners<'_> {
    type Output = u16;

    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "rounded down; sixteen lanes")]
    fn run<I: InstructionSet>(self) -> u16 {
        let Self { polytope, packet, values } = self;
        let mut near_lanes = 0;
        let per_unit = packet.per_unit();
        for (i, corner) in polytope.corners.iter().enumerate() {
            // Nothing is known where f32 cannot site the corner.
            let mut own = [f32::NEG_INFINITY; LANES];
            if let Some(local) = packet.local(corner) {
                let mut squares = [0.0; LANES];
                packet.squares::<I>(&local, f32::INFINITY, &mut squares);
                let less = local.excess + ((polytope.errors[i] * per_unit) as f32) * 1.001;
                let reach = (polytope.upper_bounds[i] * per_unit) as f32 * (1.0 + 4.0 * f32::EPSILON);
                for (value, square) in own.iter_mut().zip(squares) {
                    let least = (square.sqrt() * (1.0 - 4.0 * f32::EPSILON) - less).max(0.0);
                    // Of two squares, whose difference may be much less.
                    *value = (least - reach) * (least + reach);
                }
            }
            for (lane, value) in own.iter().enumerate() {
                near_lanes |= u32::from(*value <= 0.0) << lane;
            }
            values.push(own);
        }
        (near_lanes & packet.lanes()) as u16
    }
}
