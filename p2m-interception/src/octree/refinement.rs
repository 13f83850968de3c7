//! What the refinement of an octree works on.

use crate::list::block::Block;
use crate::list::corner_test::LaneDistances;
use crate::octree::budget::BudgetCounters;
use crate::options::Domain;
use p2m_bvh::PacketTree;
use p2m_bvh::engine::node::NodeRef;
use p2m_core::engine::vector::V3;
use p2m_core::{Aabb, PrimitiveId};

/// Nanoseconds that a query takes to test a packet, of a list or of the tree of passing_boxes (observed on one processor; of these costs only the
/// ratios matter, and the cells depend on each of them).
pub(crate) const NS_PER_PACKET: f64 = 40.0;
/// Nanoseconds that a query takes to bound the packets of a block of a list.
pub(crate) const NS_PER_BLOCK: f64 = 15.0;
/// Nanoseconds that a query takes to visit a node of the tree of passing_boxes.
pub(crate) const NS_PER_NODE: f64 = 30.0;

/// A cell that is counters, or its eight children: child c lies above the middle on axis k if bit k of c is set.
pub(crate) enum RefinedCell {
    /// The tree answers.
    Tree,
    /// One primitive: packet and lane.
    Single(u32, u8),
    /// The list.
    Blocks(Vec<Block>),
    Split(Box<[RefinedCell; 8]>),
}

/// What a search of the tree finds, and visits.
pub(crate) struct TreeProbe {
    /// The nearest point of the scene, of any primitive.
    pub(crate) nearest: V3,
    pub(crate) nodes: usize,
    pub(crate) packets: usize,
    pub(crate) primitives: usize,
}

/// What the refinement of all cells shares.
pub(crate) struct Refinement<'a> {
    pub(crate) tree: &'a PacketTree,
    /// For each vertex of the tree the lowest primitive that has it.
    pub(crate) lowest_owners: &'a [PrimitiveId],
    /// A search of the tree.
    pub(crate) search: &'a (dyn Fn(V3) -> TreeProbe + Sync),
    pub(crate) domain: Domain,
    /// By how much a dominator has to be nearer.
    pub(crate) slack: f64,
    /// Boxes with queries evenly in them, and how many for each unit of volume.
    pub(crate) uniform_boxes: &'a [(Aabb<f64>, f64)],
    /// Queries for each packet.
    pub(crate) inv_packet_count: f64,
    pub(crate) resolution: f64,
    pub(crate) parallel: bool,
    pub(crate) counters: BudgetCounters<'a>,
}

/// What a coarse cell cannot rule out.
#[derive(Clone, Copy)]
pub(crate) struct CoarseCandidate {
    pub(crate) child: NodeRef,
    pub(crate) bounds: Aabb<f64>,
}

/// A packet that a fine cell cannot rule out: its lanes, and what its filter finds at the passing_corners.
#[derive(Clone, Copy)]
pub(crate) struct PacketCandidate {
    pub(crate) packet: u32,
    pub(crate) lanes: u16,
    pub(crate) bounds: Aabb<f64>,
    pub(crate) distances: [LaneDistances; 8],
}

/// The primitive that seems nearest to a point.
#[derive(Clone, Copy)]
pub(crate) struct NearestSample {
    /// An upper bound.
    pub(crate) distance: f64,
    pub(crate) packet: u32,
    pub(crate) lane: usize,
}

impl NearestSample {
    pub(crate) const NONE: Self = Self { distance: f64::INFINITY, packet: 0, lane: 0 };

    pub(crate) fn add(&mut self, near: Option<(f64, usize)>, packet: u32) {
        if let Some((distance, lane)) = near
            && distance < self.distance
        {
            *self = Self { distance, packet, lane };
        }
    }
}

/// The middle of a cell.
pub(crate) struct CellCentre {
    /// What the filters of its items find there.
    pub(crate) distances: Vec<LaneDistances>,
    /// Whether filters tell how near all of the items are.
    pub(crate) has_all_bounds: bool,
    /// The nearest point.
    pub(crate) y: V3,
    /// How many items bounds by passing_boxes and by passing_corners let pass.
    pub(crate) passing_boxes: usize,
    pub(crate) passing_corners: usize,
}
