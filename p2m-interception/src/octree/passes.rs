//! The passes of a refinement. Each pass splits the cells that are worth it at its resolution, which is higher than the
//! resolution of the pass before.
//!
//! No cell is split twice: a pass begins with the cells that the pass before has left open. It takes the most valuable
//! ones first, and ends where their children would exceed a budget. Then the build ends as well, and each cell that is
//! still open gets a list. So a build can end after any cell of a pass, and it uses its budgets.
//!
//! A caller may end the build early in the same way: after each chunk it sees the size that the octree would have
//! ([`RefinementProgress`]).
//!
//! The cells of a pass are refined in chunks, on all threads, and the chunks are kept one after the other. Which chunk
//! is the last one to be kept depends only on what they take together, and not on the number of threads. A chunk that
//! exceeds a budget ends at once, so each thread wastes at most what is left of the budgets.

use crate::list::block::Block;
use crate::octree::budget::Spent;
use crate::octree::cell::{OpenCell, Place, RefinedCell, RefinedCells};
use crate::octree::refinement::Refinement;
use crate::octree::task::{CellTask, Scratch};
use crate::options::RefinementProgress;
use crate::parallel_chunks::map_chunks_in_order;
use p2m_core::engine::vector::V3;
use std::ops::{ControlFlow, Range};
use std::sync::Mutex;

/// The resolution of the first pass, unless the resolution of the last pass is lower.
///
/// docs/decisions/058-passes-of-rising-resolution.md records that four passes take 7 % more tests than three on
/// dragon_871k. No record exists of the scenes on which this and the next constants were chosen.
const FIRST_RESOLUTION: f64 = 2e-4;
/// The largest ratio of the resolutions of two passes. More passes leave more cells open, and resuming an open cell
/// takes about a third of the tests of a split.
const MAX_STEP: f64 = 40.0;
/// The smallest ratio of the resolutions of two passes.
const MIN_STEP: f64 = 1.5;
/// The exponent of the growth of an octree: at r times the resolution, its cells take about r to this power times as
/// much from the budgets.
const POWER_OF_RESOLUTION: f64 = 0.6;
/// The largest number of cells that a thread takes at a time.
const MAX_CELLS_PER_CHUNK: usize = 64;
/// The least number of chunks into which the cells of a pass are divided, if there are enough.
const MIN_CHUNKS: usize = 256;

/// A function that splits or finishes an open cell.
type CellAction<'a> = fn(&Refinement<'a>, &mut CellTask, &OpenCell, Place) -> RefinedCell;

/// An octree between two passes.
#[derive(Default)]
pub(crate) struct Passes {
    /// The cells. The cube of the domain is the first one.
    pub(crate) refined: RefinedCells,
    /// The cells that are open.
    open: Vec<OpenCell>,
    /// The amounts that the cells take of the budgets.
    pub(crate) spent: Spent,
    /// The resolution of the last pass.
    pub(crate) resolution: f64,
    /// The cells and lists.
    counts: Counts,
}

/// The numbers of cells and lists. An open cell that may have a list counts as a list of all of its candidates.
#[derive(Default)]
struct Counts {
    cells: usize,
    lists: usize,
    entries: usize,
}

impl Counts {
    /// Adds finished and split cells, the blocks of their lists, and open cells. `roots` has the numbers of the cells
    /// that the task began with, which have been counted as open.
    fn add(&mut self, made: &[RefinedCell], blocks: &[Block], open: &[OpenCell], roots: &[usize]) {
        let is_split = |cell: &RefinedCell| matches!(cell, RefinedCell::Split(_));
        let leaves = made.iter().filter(|cell| !is_split(cell)).count();
        self.cells = self.cells + leaves - roots.len();
        self.lists += made.iter().filter(|cell| matches!(cell, RefinedCell::List(..))).count();
        self.entries += blocks.iter().map(|block| usize::from(block.len)).sum::<usize>();
        let lists = open.iter().filter(|cell| cell.may_have_list());
        self.lists += lists.clone().count();
        self.entries += lists.map(|cell| cell.candidates.len()).sum::<usize>();
    }

    /// Removes the lists of open cells, which are refined.
    fn remove_lists(&mut self, open: &[OpenCell]) {
        let lists = open.iter().filter(|cell| cell.may_have_list());
        self.lists -= lists.clone().count();
        self.entries -= lists.map(|cell| cell.candidates.len()).sum::<usize>();
    }
}

impl Passes {
    /// Refines the cube of the domain, until `visit` ends it. The result is `None` if even the coarsest cells
    /// exceed a budget.
    pub(crate) fn run(
        refinement: &Refinement<'_>,
        low: V3,
        side: f64,
        visit: &mut dyn FnMut(&RefinementProgress) -> ControlFlow<()>,
    ) -> Option<Self> {
        let resolution = FIRST_RESOLUTION.min(refinement.last_resolution);
        let mut task = CellTask::new(resolution, Spent::default());
        let number = task.add_cell();
        task.cells[number] = refinement.refine_root(&mut task, low, side, Place { number, part: 1.0 });
        let spent = task.account.spent;
        if spent.exceeds(refinement.budgets) {
            return None;
        }
        let mut counts = Counts::default();
        counts.add(&task.cells, &task.blocks, &task.open, &[]);
        let CellTask { cells, blocks, open, .. } = task;
        let refined = RefinedCells { cells, blocks: vec![blocks] };
        let mut passes = Self { refined, open, spent, resolution, counts };
        let mut is_kept = true;
        let mut is_stopped = visit(&passes.so_far()).is_break();
        while is_kept && !is_stopped && !passes.open.is_empty() {
            let spent = passes.spent.part_of(refinement.budgets);
            let step = spent.powf(-1.0 / POWER_OF_RESOLUTION).clamp(MIN_STEP, MAX_STEP);
            let next = (passes.resolution * step).min(refinement.last_resolution);
            let (mut valuable, rest): (Vec<_>, Vec<_>) =
                std::mem::take(&mut passes.open).into_iter().partition(|cell| cell.resolution <= next);
            // Cells of about the same value stay in the order of their places, so that neighbours follow each other.
            valuable.sort_by(|a, b| a.resolution.log2().floor().total_cmp(&b.resolution.log2().floor()));
            passes.open = rest;
            let left = passes.process_open_cells(refinement, valuable, next, Refinement::split_open, &mut |passes| {
                is_stopped |= visit(&passes.so_far()).is_break();
                is_stopped
            });
            is_kept = left.is_empty();
            passes.open.extend(left);
            if is_kept {
                passes.resolution = next;
            }
        }
        if passes.open.is_empty() {
            passes.resolution = refinement.last_resolution;
        }
        let open = std::mem::take(&mut passes.open);
        passes.process_open_cells(refinement, open, 0.0, Refinement::finish_open, &mut |_| false);
        Some(passes)
    }

    /// Returns what the octree would be if all open cells got their lists now.
    fn so_far(&self) -> RefinementProgress {
        let Counts { cells, lists, entries } = self.counts;
        RefinementProgress { cells, list_cells: lists, entries, bytes: usize::try_from(self.spent.bytes).unwrap_or(0) }
    }

    /// Splits or finishes open cells in order until a budget is exceeded or `is_last` returns `true` after a chunk.
    /// Returns the cells that are still open then.
    fn process_open_cells<'a>(
        &mut self,
        refinement: &Refinement<'a>,
        mut cells: Vec<OpenCell>,
        resolution: f64,
        fate_of: CellAction<'a>,
        is_last: &mut dyn FnMut(&Self) -> bool,
    ) -> Vec<OpenCell> {
        let chunk_len = (cells.len() / MIN_CHUNKS).clamp(1, MAX_CELLS_PER_CHUNK);
        // The amounts that the chunks kept so far have taken, or `None` once no more chunks are kept.
        let kept = Mutex::new(Some(self.spent));
        let current = || *kept.lock().expect("no thread panics");
        let set_current = |spent: Option<Spent>| *kept.lock().expect("no thread panics") = spent;
        let refine = |range: Range<usize>, before: Spent| {
            let mut task = CellTask::new(resolution, before);
            for cell in &cells[range.clone()] {
                task.account.spent = task.account.spent - cell.reserved();
                let number = task.add_cell();
                task.cells[number] = fate_of(refinement, &mut task, cell, Place { number, ..cell.place });
                task.roots.push(number);
            }
            // A finished task needs no memory for splits while it waits to be kept.
            task.scratch = Scratch::default();
            (range, task)
        };
        let mut done = 0;
        map_chunks_in_order(
            cells.len(),
            chunk_len,
            refinement.parallel,
            |range| Some(refine(range, current()?)),
            |chunk| {
                let (Some(spent), Some((range, mut task))) = (current(), chunk) else { return };
                // The task may have begun before the chunks ahead of it were kept. Whether it fits depends on what
                // these took, so a task that ended early without need is run again.
                if task.account.is_truncated && !(spent + task.account.peak).exceeds(refinement.budgets) {
                    task = refine(range.clone(), spent).1;
                }
                let own = task.account.own();
                if (spent + task.account.peak.max(own)).exceeds(refinement.budgets) {
                    set_current(None);
                    return;
                }
                let spent = spent + own;
                set_current(Some(spent));
                let CellTask { cells: made, blocks, open, roots, .. } = task;
                done = range.end;
                self.counts.remove_lists(&cells[range.clone()]);
                self.counts.add(&made, &blocks, &open, &roots);
                let first = self.refined.cells.len();
                self.refined.append((made, blocks));
                for (cell, root) in cells[range].iter().zip(roots) {
                    self.refined.cells[cell.place.number] = self.refined.cells[first + root];
                }
                self.open.extend(open.into_iter().map(|mut cell| {
                    cell.place.number += first;
                    cell
                }));
                self.spent = spent;
                if is_last(self) {
                    set_current(None);
                }
            },
        );
        cells.split_off(done)
    }
}
