//! What the refinement of an octree works on.

use crate::list::block::Block;
use crate::list::corner_test::Found;
use crate::octree::budget::Done;
use crate::options::Domain;
use p2m_bvh::PacketTree;
use p2m_bvh::engine::node::NodeRef;
use p2m_core::engine::vector::V3;
use p2m_core::{Aabb, PrimitiveId};

/// Nanoseconds that a query takes to test a packet, of a list or of the tree of boxes (observed on one processor; of these costs only the
/// ratios matter, and the cells depend on each of them).
pub(crate) const NANOSECONDS_A_PACKET: f64 = 40.0;
/// Nanoseconds that a query takes to bound the packets of a block of a list.
pub(crate) const NANOSECONDS_A_BLOCK: f64 = 15.0;
/// Nanoseconds that a query takes to visit a node of the tree of boxes.
pub(crate) const NANOSECONDS_A_NODE: f64 = 30.0;

/// A cell that is done, or its eight children: child c lies above the middle on axis k if bit k of c is set.
pub(crate) enum Cell {
    /// The tree answers.
    Tree,
    /// One primitive: packet and lane.
    Single(u32, u8),
    /// The list.
    Blocks(Vec<Block>),
    Split(Box<[Cell; 8]>),
}

/// What a search of the tree finds, and visits.
pub(crate) struct Searched {
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
    pub(crate) owners: &'a [PrimitiveId],
    /// A search of the tree.
    pub(crate) search: &'a (dyn Fn(V3) -> Searched + Sync),
    pub(crate) domain: Domain,
    /// By how much a dominator has to be nearer.
    pub(crate) slack: f64,
    /// Boxes with queries evenly in them, and how many for each unit of volume.
    pub(crate) even: &'a [(Aabb<f64>, f64)],
    /// Queries for each packet.
    pub(crate) per_packet: f64,
    pub(crate) resolution: f64,
    pub(crate) parallel: bool,
    pub(crate) done: Done<'a>,
}

/// What a coarse cell cannot rule out.
#[derive(Clone, Copy)]
pub(crate) struct Candidate {
    pub(crate) child: NodeRef,
    pub(crate) bounds: Aabb<f64>,
}

/// A packet that a fine cell cannot rule out: its lanes, and what its filter finds at the corners.
#[derive(Clone, Copy)]
pub(crate) struct Item {
    pub(crate) packet: u32,
    pub(crate) lanes: u16,
    pub(crate) bounds: Aabb<f64>,
    pub(crate) found: [Found; 8],
}

/// The primitive that seems nearest to a point.
#[derive(Clone, Copy)]
pub(crate) struct Nearest {
    /// An upper bound.
    pub(crate) distance: f64,
    pub(crate) packet: u32,
    pub(crate) lane: usize,
}

impl Nearest {
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
pub(crate) struct Middle {
    /// What the filters of its items find there.
    pub(crate) found: Vec<Found>,
    /// Whether filters tell how near all of the items are.
    pub(crate) whole: bool,
    /// The nearest point.
    pub(crate) y: V3,
    /// How many items bounds by boxes and by corners let pass.
    pub(crate) boxes: usize,
    pub(crate) corners: usize,
}
