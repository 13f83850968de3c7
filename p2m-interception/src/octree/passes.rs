//! The passes of a refinement: each one splits the cells that are worth it at its resolution, which is higher than that
//! of the pass before.
//!
//! No cell is split twice: a pass begins with the cells that the pass before has left open. So the build can stop after
//! any pass, and every open cell gets a list then. It stops where a pass exceeds a budget. The cells of that pass are
//! discarded, which takes at most the rest of the budget of work. Whether a pass exceeds a budget and which passes there
//! are does not depend on the number of threads.

use crate::octree::refinement::{CellTask, OpenCell, Place, RefinedCell, RefinedCells, Refinement};
use crate::parallel_chunks::map_chunks_in_order;
use p2m_core::engine::vector::V3;
use std::ops::Range;

/// The ratio of the resolutions of two passes.
const RESOLUTION_STEP: f64 = 0.3;
/// The resolution of the first pass is this power of [`RESOLUTION_STEP`], unless the last one is lower.
const FIRST_POWER: i32 = 8;
/// A pass makes two steps at once if less than this part of each budget was spent before.
const SPENT_FOR_TWO_STEPS: f64 = 0.1;
/// The largest number of cells that a thread takes at a time.
const MAX_CELLS_PER_CHUNK: usize = 64;
/// The least number of chunks into which the cells of a pass are divided, if there are enough.
const MIN_CHUNKS: usize = 256;

/// What becomes of an open cell.
type FateOf<'a> = fn(&Refinement<'a>, &mut CellTask, &OpenCell, Place) -> RefinedCell;

impl<'a> Refinement<'a> {
    /// Refines the cube of the domain, whose cell is the first one. It returns the cells and their resolution, or
    /// `None` if even the coarsest cells exceed a budget.
    pub(crate) fn refine(&self, low: V3, side: f64) -> Option<(RefinedCells, f64)> {
        let mut power = FIRST_POWER;
        let resolution_at = |power: i32| RESOLUTION_STEP.powi(power).min(self.last_resolution);
        let mut task = CellTask { resolution: resolution_at(power), ..CellTask::default() };
        let number = task.add_cell();
        task.made.cells[number] = self.refine_root(&mut task, low, side, Place { number, part: 1.0 });
        if self.counters.is_exceeded() {
            return None;
        }
        let CellTask { made: mut refined, mut open, mut resolution, .. } = task;
        while !open.is_empty() {
            power -= if self.counters.spent_part() < SPENT_FOR_TWO_STEPS { 2 } else { 1 };
            let next = resolution_at(power);
            let (split, rest): (Vec<_>, Vec<_>) = open.into_iter().partition(|cell| cell.resolution <= next);
            open = rest;
            let (spent, cells, blocks, rest) =
                (self.counters.spent(), refined.cells.len(), refined.blocks.len(), open.len());
            split.iter().for_each(|cell| self.counters.release(cell));
            let numbers = self.run(&split, next, &mut refined, &mut open, Self::split_open);
            if self.counters.is_exceeded() {
                self.counters.restore(spent);
                refined.cells.truncate(cells);
                refined.blocks.truncate(blocks);
                open.truncate(rest);
                open.extend(split);
                break;
            }
            refined.set(&split, &numbers);
            resolution = next;
        }
        let resolution = if open.is_empty() { self.last_resolution } else { resolution };
        open.iter().for_each(|cell| self.counters.release(cell));
        let numbers = self.run(&open, resolution, &mut refined, &mut Vec::new(), Self::finish_open);
        refined.set(&open, &numbers);
        Some((refined, resolution))
    }

    /// Determines what becomes of open cells and appends the results. It returns their numbers.
    fn run(
        &self,
        cells: &[OpenCell],
        resolution: f64,
        refined: &mut RefinedCells,
        open: &mut Vec<OpenCell>,
        fate_of: FateOf<'a>,
    ) -> Vec<usize> {
        let mut numbers = Vec::with_capacity(cells.len());
        let chunk_len = (cells.len() / MIN_CHUNKS).clamp(1, MAX_CELLS_PER_CHUNK);
        let work = |range: Range<usize>| {
            let mut task = CellTask { resolution, ..CellTask::default() };
            let mut roots = Vec::with_capacity(range.len());
            for cell in &cells[range] {
                let number = task.add_cell();
                task.made.cells[number] = fate_of(self, &mut task, cell, Place { number, ..cell.place });
                roots.push(number);
            }
            (roots, task.made, task.open)
        };
        map_chunks_in_order(cells.len(), chunk_len, self.parallel, work, |(roots, made, more)| {
            let first = refined.cells.len();
            numbers.extend(roots.into_iter().map(|root| first + root));
            refined.append(made);
            open.extend(more.into_iter().map(|mut cell| {
                cell.place.number += first;
                cell
            }));
        });
        numbers
    }
}

impl RefinedCells {
    /// Appends the cells and blocks of a task, whose numbers begin at zero.
    fn append(&mut self, made: Self) {
        let (cells, blocks) = (self.cells.len(), self.blocks.len());
        self.cells.extend(made.cells.into_iter().map(|cell| match cell {
            RefinedCell::Split(first) => RefinedCell::Split(cells + first),
            RefinedCell::List(first) => RefinedCell::List(blocks + first),
            other => other,
        }));
        self.blocks.extend(made.blocks);
    }

    /// Sets what has become of open cells, given the numbers of the results.
    fn set(&mut self, open: &[OpenCell], numbers: &[usize]) {
        for (cell, number) in open.iter().zip(numbers) {
            self.cells[cell.place.number] = self.cells[*number];
        }
    }
}
