//! The work of one thread on cells.

use crate::list::block::Block;
use crate::octree::budget::{Account, Spent};
use crate::octree::cell::{OpenCell, RefinedCell};
use crate::octree::lattice::{Lattice, LatticeDistances};
use crate::octree::split_rule::CellCentre;
use p2m_core::engine::vector::V3;
use rustc_hash::FxHashMap;

/// A task of one thread: the cells that it finished, and the cells that it left open.
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
    /// The amounts that the task takes from the budgets.
    pub(crate) account: Account,
    /// The memory that each cell uses again.
    pub(crate) scratch: Scratch,
}

/// Memory that each cell uses again.
#[derive(Default)]
pub(crate) struct Scratch {
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
        Self { resolution, account: Account::new(before), ..Self::default() }
    }

    /// Adds a cell and returns its number.
    pub(crate) fn add_cell(&mut self) -> usize {
        self.cells.push(RefinedCell::Tree);
        self.cells.len() - 1
    }
}
