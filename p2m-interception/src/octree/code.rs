//! The codes of cells: 32-bit numbers that a query follows from the cube of the domain to a leaf.
//!
//! The three highest bits of a code are its kind, and the other bits are a number.

use crate::list::block::Block;
use crate::octree::cell::{RefinedCell, RefinedCells};
use crate::options::OctreeReport;
use p2m_bvh::engine::packet::LANES;

/// The number of bits of the number in a code. The kind is above them.
pub(crate) const KIND_SHIFT: u32 = 29;
/// The kind of a cube that is split twice. Its number is the first of eight rows, which have the codes of 64 cubes.
pub(crate) const KIND_TWO_LEVELS: u32 = 0;
/// The kind of a cube that is split once. Its number is the row with the codes of the eight children.
pub(crate) const KIND_ONE_LEVEL: u32 = 1;
/// The kind of a leaf with a list. Its number is the first block of the list.
pub(crate) const KIND_LIST: u32 = 2;
/// The kind of a leaf in which one primitive is the nearest everywhere. Its number is the packet times [`LANES`], plus
/// the lane.
pub(crate) const KIND_SINGLE: u32 = 3;
/// The code of a leaf that the tree answers.
pub(crate) const FALLBACK_CODE: u32 = 4 << KIND_SHIFT;

/// The codes of eight cubes in one cache line. The bits of the index are the halves on the axes, x lowest.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C, align(32))]
pub(crate) struct Row(pub(crate) [u32; 8]);

/// Writes the codes of refined cells into rows, and the blocks of their lists in the same order.
pub(crate) struct CodeWriter<'a> {
    /// The refined cells.
    pub(crate) refined: &'a RefinedCells,
    /// The rows so far.
    pub(crate) rows: Vec<Row>,
    /// The blocks of all lists so far.
    pub(crate) blocks: Vec<Block>,
    /// The report, whose counts of cells grow.
    pub(crate) report: &'a mut OctreeReport,
}

/// A decoded code.
pub(crate) enum CellCode {
    /// The cube is split. Locating a query never ends at such a code.
    Rows,
    /// The leaf has a list, which begins at this block.
    List(usize),
    /// One primitive is the nearest everywhere in the leaf. The fields are its packet and its lane.
    Single(usize, usize),
    /// The tree answers in the leaf.
    Tree,
}

impl CellCode {
    /// Decodes a code.
    pub(crate) fn decode(code: u32) -> Self {
        let number = (code & ((1 << KIND_SHIFT) - 1)) as usize;
        match code >> KIND_SHIFT {
            KIND_TWO_LEVELS | KIND_ONE_LEVEL => Self::Rows,
            KIND_LIST => Self::List(number),
            KIND_SINGLE => Self::Single(number / LANES, number % LANES),
            _ => Self::Tree,
        }
    }
}

impl CodeWriter<'_> {
    /// Stores a cell of a level and returns its code. A cell whose number does not fit into a code is left
    /// to the tree.
    pub(crate) fn encode(&mut self, cell: usize, level: usize) -> u32 {
        let pack = |kind: u32, n: usize| {
            u32::try_from(n).ok().filter(|n| n >> KIND_SHIFT == 0).map_or(FALLBACK_CODE, |n| kind << KIND_SHIFT | n)
        };
        self.report.depth = self.report.depth.max(level);
        let is_split = |cell: usize| matches!(self.refined.cells[cell], RefinedCell::Split(_));
        match self.refined.cells[cell] {
            RefinedCell::Tree => {
                self.report.fallback_cells += 1;
                FALLBACK_CODE
            }
            RefinedCell::Single(packet, lane) => {
                self.report.single_cells += 1;
                pack(KIND_SINGLE, packet as usize * LANES + usize::from(lane))
            }
            RefinedCell::List(task, number) => {
                let list = &self.refined.blocks[task as usize][number as usize..];
                let list = &list[..=usize::from(list[0].following)];
                self.report.list_cells += 1;
                self.report.entries += list.iter().map(|block| usize::from(block.len)).sum::<usize>();
                let first = self.blocks.len();
                self.blocks.extend_from_slice(list);
                pack(KIND_LIST, first)
            }
            RefinedCell::Split(children) => {
                let row = self.rows.len();
                let inner = (children..children + 8).filter(|child| is_split(*child)).count();
                // Two levels share eight rows, unless most of their codes would be the same.
                if inner < 4 {
                    self.rows.push(Row([FALLBACK_CODE; 8]));
                    for c in 0..8 {
                        self.rows[row].0[c] = self.encode(children + c, level + 1);
                    }
                    return pack(KIND_ONE_LEVEL, row);
                }
                self.rows.resize(row + 8, Row([FALLBACK_CODE; 8]));
                for c in 0..8 {
                    if let RefinedCell::Split(grandchildren) = self.refined.cells[children + c] {
                        for g in 0..8 {
                            let code = self.encode(grandchildren + g, level + 2);
                            self.set_grandchild(row, c, g, code);
                        }
                    } else {
                        let code = self.encode(children + c, level + 1);
                        (0..8).for_each(|g| self.set_grandchild(row, c, g, code));
                    }
                }
                pack(KIND_TWO_LEVELS, row)
            }
        }
    }

    /// Stores the code of grandchild `g` of child `c` in the rows of two levels. The position has two bits for each
    /// axis, x lowest.
    fn set_grandchild(&mut self, row: usize, c: usize, g: usize, code: u32) {
        let slot: usize = (0..3).map(|k| ((c >> k & 1) << 1 | (g >> k & 1)) << (2 * k)).sum();
        self.rows[row + slot / 8].0[slot % 8] = code;
    }
}
