//! The cells of an octree that is being built.

use crate::list::block::{BLOCK_WIDTH, Block};
use crate::octree::budget::Spent;
use crate::octree::candidate::OpenCandidate;
use crate::octree::cube::Cube;
use crate::octree::split_rule::MAX_LIST_PACKETS;

/// The largest number of tests per packet that the list of an open cell takes: at the eight corners and at the centre.
const TESTS_PER_OPEN_PACKET: usize = 9;

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
    /// All cells of the octree or the part.
    pub(crate) cells: Vec<RefinedCell>,
    /// The blocks of all lists, as each task made them.
    pub(crate) blocks: Vec<Vec<Block>>,
}

impl RefinedCells {
    /// Appends the cells and blocks of a task, whose numbers begin at zero.
    pub(crate) fn append(&mut self, (cells, blocks): (Vec<RefinedCell>, Vec<Block>)) {
        let first = self.cells.len();
        let task = u32::try_from(self.blocks.len()).expect("few tasks");
        self.cells.extend(cells.into_iter().map(|cell| match cell {
            RefinedCell::Split(children) => RefinedCell::Split(first + children),
            RefinedCell::List(_, block) => RefinedCell::List(task, block),
            other => other,
        }));
        self.blocks.push(blocks);
    }
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

    /// Returns the most that the list of the cell may take. It is reserved until the cell is split or finished.
    pub(crate) fn reserved(&self) -> Spent {
        let packets = if self.may_have_list() { self.candidates.len() } else { 0 };
        Spent::new(packets.div_ceil(BLOCK_WIDTH) * size_of::<Block>(), packets * TESTS_PER_OPEN_PACKET)
    }
}

/// The place of a cell among the cells of a task or of an octree.
#[derive(Clone, Copy)]
pub(crate) struct Place {
    /// The number of the cell.
    pub(crate) number: usize,
    /// The part of the domain that the cell covers.
    pub(crate) part: f64,
}
