//! The data of a refinement: what all cells share, what a cell inherits from its parent, and what becomes of it.

use crate::list::block::Block;
use crate::list::corner_test::LaneDistances;
use crate::octree::budget::BudgetCounters;
use crate::options::Domain;
use p2m_bvh::PacketTree;
use p2m_bvh::engine::node::NodeRef;
use p2m_core::engine::vector::V3;
use p2m_core::{Aabb, PrimitiveId};

/// The time in which a query tests a packet of a list or of the tree, in nanoseconds. The three times were observed on
/// one processor. Only their ratios matter, and the cells depend on each of them.
pub(crate) const NS_PER_PACKET: f64 = 40.0;
/// The time in which a query bounds the packets of one block of a list, in nanoseconds.
pub(crate) const NS_PER_BLOCK: f64 = 15.0;
/// The time in which a query visits a node of the tree, in nanoseconds.
pub(crate) const NS_PER_NODE: f64 = 30.0;

/// A finished cell. Child c of a split cell lies above the centre on axis k if bit k of c is set.
pub(crate) enum RefinedCell {
    /// The tree answers in the cell.
    Tree,
    /// One primitive is the nearest everywhere in the cell. The fields are its packet and its lane.
    Single(u32, u8),
    /// The blocks of the list of the cell.
    Blocks(Vec<Block>),
    /// The eight children of the cell.
    Split(Box<[RefinedCell; 8]>),
}

/// The result of one search of the tree, and the work of it.
pub(crate) struct TreeProbe {
    /// The nearest point of the scene, on whichever primitive.
    pub(crate) nearest: V3,
    /// The number of visited nodes.
    pub(crate) nodes: usize,
    /// The number of tested packets.
    pub(crate) packets: usize,
    /// The number of evaluated primitives.
    pub(crate) primitives: usize,
}

/// A refinement of the cube of a domain: everything that is the same for all cells.
pub(crate) struct Refinement<'a> {
    /// The tree over the packets.
    pub(crate) tree: &'a PacketTree,
    /// For each vertex of the tree the primitive with the lowest id that has this vertex.
    pub(crate) lowest_owners: &'a [PrimitiveId],
    /// Searches the tree for the nearest point of the scene.
    pub(crate) search: &'a (dyn Fn(V3) -> TreeProbe + Sync),
    /// The domain in which queries are expected.
    pub(crate) domain: Domain,
    /// The slack of the corner test: a dominator has to be nearer by this much.
    pub(crate) slack: f64,
    /// The boxes in which queries are uniform, each with the number of queries in a unit of volume.
    pub(crate) uniform_boxes: &'a [(Aabb<f64>, f64)],
    /// The reciprocal of the number of packets: each packet has this share of the queries on the surface.
    pub(crate) inv_packet_count: f64,
    /// The resolution, which multiplies the value of a split.
    pub(crate) resolution: f64,
    /// Whether large cells are refined on all threads.
    pub(crate) parallel: bool,
    /// The budgets, and what has been spent of them.
    pub(crate) counters: BudgetCounters<'a>,
}

/// A node or a packet of the tree that a coarse cell cannot exclude.
#[derive(Clone, Copy)]
pub(crate) struct CoarseCandidate {
    /// The node or the packet.
    pub(crate) child: NodeRef,
    /// The box around it.
    pub(crate) bounds: Aabb<f64>,
}

/// A packet that a fine cell cannot exclude.
#[derive(Clone, Copy)]
pub(crate) struct PacketCandidate<'a> {
    /// The number of the packet.
    pub(crate) packet: u32,
    /// The lanes that pass the corner test, as bits.
    pub(crate) lanes: u16,
    /// The box around the packet.
    pub(crate) bounds: Aabb<f64>,
    /// The distances from some points to its lanes.
    pub(crate) distances: &'a [LaneDistances],
    /// The indices of the corners of the cell among these points.
    pub(crate) corners: &'a [usize; 8],
}

/// The primitive that the filters find nearest to a point.
#[derive(Clone, Copy)]
pub(crate) struct NearestSample {
    /// An upper bound of the distance to it. It is infinite if no filter could be used.
    pub(crate) distance: f64,
    /// The packet of the primitive.
    pub(crate) packet: u32,
    /// The lane of the primitive.
    pub(crate) lane: usize,
}

impl NearestSample {
    /// A sample before any packet was added.
    pub(crate) const NONE: Self = Self { distance: f64::INFINITY, packet: 0, lane: 0 };

    /// Replaces the sample if a packet has a lane with a lower upper bound.
    pub(crate) fn add(&mut self, near: Option<(f64, usize)>, packet: u32) {
        if let Some((distance, lane)) = near
            && distance < self.distance
        {
            *self = Self { distance, packet, lane };
        }
    }
}

/// The filters at the centre of a cell, and what they predict for queries there.
pub(crate) struct CellCentre {
    /// The distances from the centre to each packet of the cell.
    pub(crate) distances: Vec<LaneDistances>,
    /// Whether the filters bound the distances to all packets. Packets of unknown primitives have no vertices and
    /// no such bounds.
    pub(crate) has_all_bounds: bool,
    /// The nearest point of the scene, which is a dominator.
    pub(crate) y: V3,
    /// The number of packets that a block with boxes would let pass.
    pub(crate) passing_boxes: usize,
    /// The number of packets that a block with corners would let pass.
    pub(crate) passing_corners: usize,
}
