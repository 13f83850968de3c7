//! The data of a refinement: what all cells share, what a cell inherits from its parent, and what becomes of it.

use crate::list::block::Block;
use crate::octree::budget::{FinishedPart, Spent};
use crate::octree::cell::Cube;
use crate::octree::cell_list::MAX_LIST_PACKETS;
use crate::octree::lattice::{Lattice, LatticeDistances};
use crate::options::Domain;
use p2m_bvh::PacketTree;
use p2m_bvh::engine::node::NodeRef;
use p2m_core::engine::vector::V3;
use p2m_core::{Aabb, PrimitiveId};
use rustc_hash::FxHashMap;

/// The time in which a query tests a packet of a list or of the tree, in nanoseconds. The three times were observed on
/// one processor. Only their ratios matter, and the cells depend on each of them.
pub(crate) const NS_PER_PACKET: f64 = 40.0;
/// The time in which a query bounds the packets of one block of a list, in nanoseconds.
pub(crate) const NS_PER_BLOCK: f64 = 15.0;
/// The time in which a query visits a node of the tree, in nanoseconds.
pub(crate) const NS_PER_NODE: f64 = 30.0;

/// A cell of an octree that is being built.
#[derive(Clone, Copy, Debug)]
pub(crate) enum RefinedCell {
    /// The tree answers in the cell.
    Tree,
    /// One primitive is the nearest everywhere in the cell. The fields are its packet and its lane.
    Single(u32, u8),
    /// The cell has a list. The fields are the number of the task that made it, and its first block there.
    List(u32, u32),
    /// The cell is split. Its eight children begin at this number. Child c lies above the centre on axis k if bit k of
    /// c is set.
    Split(usize),
}

/// The cells of an octree that is being built, or of a part of it.
#[derive(Default)]
pub(crate) struct RefinedCells {
    /// The cells.
    pub(crate) cells: Vec<RefinedCell>,
    /// The blocks of all lists, as each task made them.
    pub(crate) blocks: Vec<Vec<Block>>,
}

/// A cell that a later pass splits if the budgets allow it.
pub(crate) struct OpenCell {
    /// The place of the cell. The tree answers in it until the cell is finished.
    pub(crate) place: Place,
    /// The cube of the cell.
    pub(crate) cube: Cube,
    /// Nodes or packets of the tree that can hold the answer in the cell.
    pub(crate) candidates: Vec<OpenCandidate>,
    /// Whether all candidates are packets.
    pub(crate) has_packets: bool,
    /// The resolution from which on a split is worth its memory.
    pub(crate) resolution: f64,
}

impl OpenCell {
    /// Returns whether the cell gets a list if it is not split.
    pub(crate) fn may_have_list(&self) -> bool {
        self.has_packets && self.candidates.len() <= MAX_LIST_PACKETS
    }
}

/// The place of a cell among those of a task or of an octree.
#[derive(Clone, Copy)]
pub(crate) struct Place {
    /// The number of the cell.
    pub(crate) number: usize,
    /// The part of the domain that the cell covers.
    pub(crate) part: f64,
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
    /// The resolution of the last pass. No pass splits cells for which it is too low.
    pub(crate) last_resolution: f64,
    /// Whether cells are refined on all threads.
    pub(crate) parallel: bool,
    /// The budgets.
    pub(crate) budgets: Spent,
    /// The finished part of the domain.
    pub(crate) finished: FinishedPart<'a>,
}

/// A node or a packet of the tree that can hold the answer in a cell.
#[derive(Clone, Copy)]
pub(crate) struct Candidate {
    /// The box around it.
    pub(crate) bounds: Aabb<f64>,
    /// The node or the packet.
    pub(crate) child: NodeRef,
    /// The node of which it is a child, or [`NodeRef::NONE`] for the root of the tree.
    pub(crate) parent: NodeRef,
    /// The index of the packet among the candidates of the parent.
    pub(crate) index: u32,
    /// The lanes of the packet that can hold the answer, as bits.
    pub(crate) lanes: u16,
}

/// A candidate of an open cell. It has no box, because open cells may have most of the candidates in memory.
pub(crate) struct OpenCandidate {
    child: NodeRef,
    parent: NodeRef,
    lanes: u16,
}

impl From<&Candidate> for OpenCandidate {
    fn from(&Candidate { child, parent, lanes, .. }: &Candidate) -> Self {
        Self { child, parent, lanes }
    }
}

impl Refinement<'_> {
    /// Returns the candidates of an open cell.
    pub(crate) fn candidates_of(&self, cell: &OpenCell) -> Vec<Candidate> {
        let candidates = cell.candidates.iter().map(|&OpenCandidate { child, parent, lanes }| {
            let found = (parent != NodeRef::NONE).then(|| self.tree.child_boxes(parent).find(|(_, c)| *c == child));
            let bounds = found.flatten().map_or(*self.tree.bounds(), |(bounds, _)| bounds);
            Candidate { bounds, child, parent, index: 0, lanes }
        });
        candidates.collect()
    }
}

/// The distances from the lattice of the parent of a cell, which include those from the corners of the cell.
#[derive(Clone, Copy)]
pub(crate) struct KnownDistances<'a> {
    /// The distances to each packet of the parent.
    pub(crate) distances: &'a [LatticeDistances],
    /// The points of the lattice that are the corners of the cell.
    pub(crate) corners: &'a [usize; 8],
}

/// The work of one thread: the cells that it finished, those that it left open, and memory that each cell uses again.
#[derive(Default)]
pub(crate) struct CellTask {
    /// The resolution of the pass.
    pub(crate) resolution: f64,
    /// The finished cells. The numbers of children and tasks begin at zero.
    pub(crate) cells: Vec<RefinedCell>,
    /// The blocks of their lists.
    pub(crate) blocks: Vec<Block>,
    /// The cells that are left open.
    pub(crate) open: Vec<OpenCell>,
    /// The numbers of the cells that the task began with.
    pub(crate) roots: Vec<usize>,
    /// The amounts that had been spent before the task, or by an earlier time.
    pub(crate) before: Spent,
    /// The amounts that have been spent, those from before the task included.
    pub(crate) spent: Spent,
    /// The largest amounts that the task itself had spent before a split.
    pub(crate) peak: Spent,
    /// Whether cells were not split because a budget was exceeded.
    pub(crate) is_truncated: bool,
    /// The nearest points of the scene that the tree found, by the bits of the lattice points. They are remembered
    /// because neighbouring cells share lattice points.
    pub(crate) nearest_points: FxHashMap<[u64; 3], V3>,
    /// The memory of the current split.
    pub(crate) lattice: Lattice,
    /// Vectors for the distances of splits: one for each cell on the path to the current one.
    pub(crate) distances: Vec<Vec<LatticeDistances>>,
    /// The centre of the current cell.
    pub(crate) centre: CellCentre,
}

impl CellTask {
    /// Begins a task of a pass.
    pub(crate) fn new(resolution: f64, before: Spent) -> Self {
        Self { resolution, before, spent: before, ..Self::default() }
    }

    /// Returns whether no cell may be split any more, because a budget is exceeded.
    pub(crate) fn exceeds(&mut self, budgets: Spent) -> bool {
        self.peak = self.peak.max(self.spent - self.before);
        let exceeds = self.spent.exceeds(budgets);
        self.is_truncated |= exceeds;
        exceeds
    }

    /// Adds a cell and returns its number.
    pub(crate) fn add_cell(&mut self) -> usize {
        self.cells.push(RefinedCell::Tree);
        self.cells.len() - 1
    }
}

/// The middle of a cell, and what bounds at its corners predict for queries there. Its vectors are used again.
#[derive(Default)]
pub(crate) struct CellCentre {
    /// The nearest point of the scene, which is a dominator.
    pub(crate) y: V3,
    /// The squared lower bounds of the distances from the centre to the boxes of all candidates.
    pub(crate) box_squares: Vec<f64>,
    /// For each candidate lower bounds of the distances from the corners to its lanes.
    pub(crate) from_corners: Vec<[f64; 8]>,
    /// The number of packets that a block with boxes would let pass.
    pub(crate) passing_boxes: usize,
    /// The number of packets that a block with corners would let pass.
    pub(crate) passing_corners: usize,
}
