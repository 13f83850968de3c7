//! CodeWriter of cells: the rows of the octree.

use crate::list::block::Block;
use crate::octree::refinement::RefinedCell;
use crate::options::OctreeReport;
use p2m_bvh::engine::packet::LANES;

/// What a code means is in its three highest bits, the rest is a number:
pub(crate) const KIND_SHIFT: u32 = 29;
/// the first of eight rows of codes, two levels of cubes;
pub(crate) const KIND_TWO_LEVELS: u32 = 0;
/// a row of codes, one level;
pub(crate) const KIND_ONE_LEVEL: u32 = 1;
/// the first block of a list;
pub(crate) const KIND_LIST: u32 = 2;
/// a packet and its lane;
pub(crate) const KIND_SINGLE: u32 = 3;
/// none: the tree answers.
pub(crate) const FALLBACK_CODE: u32 = 4 << KIND_SHIFT;

/// CodeWriter of eight cubes, x lowest.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C, align(32))]
pub(crate) struct Row(pub(crate) [u32; 8]);

/// The codes of cells, as they are made.
pub(crate) struct CodeWriter<'a> {
    pub(crate) rows: Vec<Row>,
    pub(crate) blocks: Vec<Block>,
    pub(crate) report: &'a mut OctreeReport,
}

/// A code, decoded.
pub(crate) enum CellCode {
    /// Rows of codes of smaller cubes. Locating a query never ends at one.
    Rows,
    /// The number of the first block of a list.
    List(usize),
    /// A packet and the lane of the primitive that is the nearest one everywhere in the cell.
    Single(usize, usize),
    /// The tree answers.
    Tree,
}

impl CellCode {
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
    /// Keeps a cell of a level, and gives its code.
    pub(crate) fn encode(&mut self, cell: RefinedCell, level: usize) -> u32 {
        let code = |what: u32, n: usize| {
            u32::try_from(n).ok().filter(|n| n >> KIND_SHIFT == 0).map_or(FALLBACK_CODE, |n| what << KIND_SHIFT | n)
        };
        self.report.depth = self.report.depth.max(level);
        match cell {
            RefinedCell::Tree => {
                self.report.trees += 1;
                FALLBACK_CODE
            }
            RefinedCell::Single(packet, lane) => {
                self.report.singles += 1;
                code(KIND_SINGLE, packet as usize * LANES + usize::from(lane))
            }
            RefinedCell::Blocks(blocks) => {
                self.report.lists += 1;
                self.report.entries += blocks.iter().map(|block| usize::from(block.len)).sum::<usize>();
                let first = self.blocks.len();
                self.blocks.extend(blocks);
                code(KIND_LIST, first)
            }
            RefinedCell::Split(children) => {
                let row = self.rows.len();
                let inner = children.iter().filter(|child| matches!(child, RefinedCell::Split(_))).count();
                // Two levels at once, unless most of their codes would be the same.
                if inner < 4 {
                    self.rows.push(Row([FALLBACK_CODE; 8]));
                    for (c, child) in children.into_iter().enumerate() {
                        self.rows[row].0[c] = self.encode(child, level + 1);
                    }
                    return code(KIND_ONE_LEVEL, row);
                }
                self.rows.resize(row + 8, Row([FALLBACK_CODE; 8]));
                for (c, child) in children.into_iter().enumerate() {
                    match child {
                        RefinedCell::Split(grandchildren) => {
                            for (g, grandchild) in grandchildren.into_iter().enumerate() {
                                let code = self.encode(grandchild, level + 2);
                                self.set_grandchild(row, c, g, code);
                            }
                        }
                        leaf => {
                            let code = self.encode(leaf, level + 1);
                            (0..8).for_each(|g| self.set_grandchild(row, c, g, code));
                        }
                    }
                }
                code(KIND_TWO_LEVELS, row)
            }
        }
    }

    /// Puts the code of grandchild `g` of child `c` into a node of two levels: two bits for each axis, x lowest.
    fn set_grandchild(&mut self, row: usize, c: usize, g: usize, code: u32) {
        let slot: usize = (0..3).map(|k| ((c >> k & 1) << 1 | (g >> k & 1)) << (2 * k)).sum();
        self.rows[row + slot / 8].0[slot % 8] = code;
    }
}
