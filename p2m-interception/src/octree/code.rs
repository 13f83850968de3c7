//! Codes of cells: the rows of the octree.

use crate::list::block::Block;
use crate::octree::refinement::Cell;
use crate::options::OctreeReport;
use p2m_bvh::engine::packet::LANES;

/// What a code means is in its three highest bits, the rest is a number:
pub(crate) const SHIFT: u32 = 29;
/// the first of eight rows of codes, two levels of cubes;
pub(crate) const TWO_LEVELS: u32 = 0;
/// a row of codes, one level;
pub(crate) const ONE_LEVEL: u32 = 1;
/// the first block of a list;
pub(crate) const LIST: u32 = 2;
/// a packet and its lane;
pub(crate) const SINGLE: u32 = 3;
/// none: the tree answers.
pub(crate) const TREE: u32 = 4 << SHIFT;

/// Codes of eight cubes, x lowest.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C, align(32))]
pub(crate) struct Row(pub(crate) [u32; 8]);

/// The codes of cells, as they are made.
pub(crate) struct Codes<'a> {
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
        let number = (code & ((1 << SHIFT) - 1)) as usize;
        match code >> SHIFT {
            TWO_LEVELS | ONE_LEVEL => Self::Rows,
            LIST => Self::List(number),
            SINGLE => Self::Single(number / LANES, number % LANES),
            _ => Self::Tree,
        }
    }
}

impl Codes<'_> {
    /// Keeps a cell of a level, and gives its code.
    pub(crate) fn code(&mut self, cell: Cell, level: usize) -> u32 {
        let code =
            |what: u32, n: usize| u32::try_from(n).ok().filter(|n| n >> SHIFT == 0).map_or(TREE, |n| what << SHIFT | n);
        self.report.depth = self.report.depth.max(level);
        match cell {
            Cell::Tree => {
                self.report.trees += 1;
                TREE
            }
            Cell::Single(packet, lane) => {
                self.report.singles += 1;
                code(SINGLE, packet as usize * LANES + usize::from(lane))
            }
            Cell::Blocks(blocks) => {
                self.report.lists += 1;
                self.report.entries += blocks.iter().map(|block| usize::from(block.len)).sum::<usize>();
                let first = self.blocks.len();
                self.blocks.extend(blocks);
                code(LIST, first)
            }
            Cell::Split(children) => {
                let row = self.rows.len();
                let inner = children.iter().filter(|child| matches!(child, Cell::Split(_))).count();
                // Two levels at once, unless most of their codes would be the same.
                if inner < 4 {
                    self.rows.push(Row([TREE; 8]));
                    for (c, child) in children.into_iter().enumerate() {
                        self.rows[row].0[c] = self.code(child, level + 1);
                    }
                    return code(ONE_LEVEL, row);
                }
                self.rows.resize(row + 8, Row([TREE; 8]));
                for (c, child) in children.into_iter().enumerate() {
                    match child {
                        Cell::Split(grandchildren) => {
                            for (g, grandchild) in grandchildren.into_iter().enumerate() {
                                let code = self.code(grandchild, level + 2);
                                self.put(row, c, g, code);
                            }
                        }
                        leaf => {
                            let code = self.code(leaf, level + 1);
                            (0..8).for_each(|g| self.put(row, c, g, code));
                        }
                    }
                }
                code(TWO_LEVELS, row)
            }
        }
    }

    /// Puts the code of grandchild `g` of child `c` into a node of two levels: two bits for each axis, x lowest.
    fn put(&mut self, row: usize, c: usize, g: usize, code: u32) {
        let place: usize = (0..3).map(|k| ((c >> k & 1) << 1 | (g >> k & 1)) << (2 * k)).sum();
        self.rows[row + place / 8].0[place % 8] = code;
    }
}
