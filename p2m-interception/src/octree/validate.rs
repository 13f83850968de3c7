//! Validation of the octree of a saved file.
//!
//! The checks take one pass over the rows and the blocks. They cover what locating a query and searching its list rely
//! on in order to end without a panic. They do not cover bounds and lists that lack a primitive, which can only make
//! answers wrong.

use crate::list::block::MAX_LEVEL;
use crate::octree::Octree;
use crate::octree::code::{CellCode, FALLBACK_CODE, KIND_ONE_LEVEL, KIND_SHIFT};
use p2m_core::storage::{LoadError, check_chunks, require};

/// The section with the fields that are not arrays.
pub(super) const OCTREE: &str = "octree";
/// The section with the rows of codes.
pub(super) const CODES: &str = "octree/codes";
/// The section with the blocks of all lists.
pub(super) const LISTS: &str = "octree/lists";

/// Checks the codes, the blocks and the report of an octree.
pub(super) fn check(octree: &Octree) -> Result<(), LoadError> {
    let report = &octree.report;
    require(octree.low.iter().all(|x| x.is_finite()), OCTREE, "the cube of the domain is not finite")?;
    let cells = [report.single_cells, report.list_cells, report.fallback_cells];
    let codes = octree.rows.len().saturating_mul(8).saturating_add(1);
    require(cells.iter().all(|count| *count <= codes), OCTREE, "the report has more cells than there are codes")?;
    let lane_masks = octree.tree.lane_masks();
    check_blocks(octree, &lane_masks)?;
    check_codes(octree, &lane_masks)
}

/// Checks the blocks. The lists have to lie one after the other.
fn check_blocks(octree: &Octree, lane_masks: &[u16]) -> Result<(), LoadError> {
    let blocks = &octree.blocks;
    check_chunks(blocks, |first, chunk| {
        for (block, number) in chunk.iter().zip(first..) {
            require(block.has_valid_fields(lane_masks), LISTS, "a number is out of range")?;
            // The blocks of a list count down to its last one.
            let left = number.checked_sub(1).map_or(0, |before| blocks[before].following);
            require(left == 0 || block.following == left - 1, LISTS, "a list overlaps another one")?;
        }
        Ok(())
    })?;
    require(blocks.last().is_none_or(|last| last.following == 0), LISTS, "the last list has no end")
}

/// Checks the codes. A code that leads to an earlier row is refused, because locating a query would not end; so is one
/// that leads below the last level, because a position has no more bits.
fn check_codes(octree: &Octree, lane_masks: &[u16]) -> Result<(), LoadError> {
    // The level of the cubes whose codes are in each row; 0 if no code leads to the row yet.
    let mut levels = vec![0; octree.rows.len()];
    check_code(octree, lane_masks, octree.root, 0, 0, &mut levels)?;
    for (number, row) in octree.rows.iter().enumerate() {
        let level = levels[number];
        require(level > 0, CODES, "a row comes before the code that leads to it, or there is no such code")?;
        row.0.iter().try_for_each(|code| check_code(octree, lane_masks, *code, level, number + 1, &mut levels))?;
    }
    Ok(())
}

/// Checks the code of a cube of a level. It may lead to rows from `first_row` on that no other code leads to.
fn check_code(
    octree: &Octree,
    lane_masks: &[u16],
    code: u32,
    level: u8,
    first_row: usize,
    levels: &mut [u8],
) -> Result<(), LoadError> {
    let is_one_level = code >> KIND_SHIFT == KIND_ONE_LEVEL;
    match CellCode::decode(code) {
        CellCode::Rows => {
            let (count, level) = if is_one_level { (1, level + 1) } else { (8, level + 2) };
            require(level <= MAX_LEVEL, CODES, "a code leads below the last level")?;
            let first = (code & !(KIND_ONE_LEVEL << KIND_SHIFT)) as usize;
            let rows = levels.get_mut(first..first + count);
            let is_new = rows.is_some_and(|rows| {
                let is_unused = first >= first_row && rows.iter().all(|level| *level == 0);
                rows.fill(level);
                is_unused
            });
            require(is_new, CODES, "a row does not exist, is used twice, or comes before the code that leads to it")
        }
        CellCode::List(first) => require(first < octree.blocks.len(), CODES, "a list does not exist"),
        CellCode::Single(packet, lane) => {
            let is_lane = lane_masks.get(packet).is_some_and(|mask| mask >> lane & 1 == 1);
            require(is_lane, CODES, "a primitive does not exist")
        }
        CellCode::Tree => require(code == FALLBACK_CODE, CODES, "a code has no meaning"),
    }
}
