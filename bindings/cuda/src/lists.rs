//! Construction of interception lists, which the card makes level by level.
//!
//! The basic idea: the finest lists are the best, so the host tries to divide every cell with more than 16 candidates,
//! one level after the other, until the lists no longer fit into the memory. Then it makes the last levels again with a
//! larger number of candidates above which a cell is divided, and accepts the first choice that fits.

use crate::CudaError;
use crate::card::Card;
use crate::raw::{Address, Building, Cell, Counters, FROM_TREE, Grid};
use bytemuck::{Zeroable, bytes_of, bytes_of_mut, cast_slice};

/// The size of the largest grid, in boxes of the scene.
const MAX_REACH: f64 = 1e6;
/// The largest number of roots along a side of a grid.
const MAX_ROOTS: f64 = 64.0;
/// The largest number of levels below the roots.
const MAX_LEVELS: i32 = 6;
/// The choices for the number of candidates above which a cell is divided, from the finest lists to the coarsest. The
/// first one whose lists fit into the memory is used. No record exists of how the numbers were chosen.
const DIVIDE_ABOVE: [u32; 6] = [16, 24, 32, 48, 64, 96];
/// The number of cells whose lists a launch makes. Drivers end kernels that take seconds on cards with a display.
const CELLS_PER_LAUNCH: usize = 1 << 17;
/// The longest list of a cell that is not divided for lack of memory. With a longer one the tree would be faster (no
/// record of the measurement exists).
const LIST_LIMIT: u32 = 128;

/// The size of the grids, and the memory that they may take.
pub(crate) struct ListPlan {
    /// Half of the box of the scene, in the frame.
    pub(crate) half_extent: [f64; 3],
    /// The number of primitives.
    pub(crate) primitives: usize,
    /// The size of the larger grid in boxes of the scene. Below 1 there is no such grid.
    pub(crate) reach: f64,
    /// The memory of all lists, in bytes.
    pub(crate) memory: usize,
}

/// The lists of all grids.
pub(crate) struct Lists<M> {
    pub(crate) grids: Vec<Grid>,
    pub(crate) entries: M,
    pub(crate) items: M,
    /// The bytes that they take.
    pub(crate) memory: usize,
    /// The number of cells without a list.
    pub(crate) left_out: u64,
}

/// The scene on the card from which lists are made.
#[derive(Clone, Copy)]
pub(crate) struct Source {
    pub(crate) nodes: u64,
    pub(crate) plates: u64,
}

/// A finished level of a grid, kept so that it can be made again as the last level.
struct Level<M> {
    cells: M,
    cell_count: usize,
    candidates: M,
    side: f32,
    /// The counters before the level was made.
    before: Counters,
}

/// Makes the lists of a small grid around the scene and of a larger one.
pub(crate) fn make<C: Card>(card: &C, source: Source, plan: &ListPlan) -> Result<Lists<C::Memory>, CudaError> {
    let longest = plan.half_extent.into_iter().fold(0.0, f64::max);
    let margin = 0.05 * longest + f64::MIN_POSITIVE;
    // Memory is counted in words of four bytes. An entry takes two, and an item takes one. While lists are made,
    // entries and items have a buffer of the full size each, because their proportion is not known.
    let words = u32::try_from(plan.memory / 4).unwrap_or(u32::MAX).clamp(1 << 12, u32::MAX / 4);
    let (entries, items) = (card.allocate(words as usize * 4)?, card.allocate(words as usize * 4)?);
    let mut counters = Counters::default();
    let mut grids = Vec::new();
    let factors = [1.0, plan.reach];
    for (number, factor) in factors.into_iter().enumerate().filter(|(_, factor)| (1.0..=MAX_REACH).contains(factor)) {
        let half = plan.half_extent.map(|x| x * factor + margin * factor);
        // The first grid may take two thirds of the memory.
        let limit = if number == 0 && factors[1] >= 1.0 { words / 3 * 2 } else { words };
        let building = Building {
            nodes: source.nodes,
            plates: source.plates,
            entries: card.address(&entries),
            items: card.address(&items),
            entry_capacity: words / 2,
            item_capacity: words,
            list_limit: LIST_LIMIT,
            ..Building::default()
        };
        let grid = grid(half, plan.primitives, counters.entries);
        if let Some(grid) = make_grid(card, grid, building, limit, &mut counters)? {
            grids.push(grid);
        }
    }
    let bytes = |count: u64, size: usize| usize::try_from(count).map_or(usize::MAX, |count| count * size);
    let (entry_bytes, item_bytes) = (bytes(counters.entries, 8), bytes(counters.list_items, 4));
    let (entries, items) = (card.copy(&entries, entry_bytes)?, card.copy(&items, item_bytes)?);
    Ok(Lists { grids, entries, items, memory: entry_bytes + item_bytes, left_out: counters.left_out })
}

/// Returns a grid over a box around the origin.
#[allow(clippy::cast_possible_truncation, clippy::cast_precision_loss, reason = "small numbers")]
fn grid(half: [f64; 3], primitives: usize, first_entry: u64) -> Grid {
    let longest = half.into_iter().fold(0.0, f64::max);
    let roots = (primitives as f64).cbrt().clamp(8.0, MAX_ROOTS);
    let side = (2.0 * longest / roots).log2().ceil().clamp(-100.0, 30.0).exp2();
    let low = half.map(|x| (-x / side).floor() as i32);
    let cells: [i32; 3] = std::array::from_fn(|k| (half[k] / side).floor() as i32 + 1 - low[k]);
    Grid { low, cells, levels: 0, per_cell: side.recip() as f32, first_entry: first_entry as u32 }
}

/// Makes the lists of a grid. Returns `None` if even the lists of its roots do not fit into the memory.
fn make_grid<C: Card>(
    card: &C,
    mut grid: Grid,
    mut building: Building,
    limit: u32,
    counters: &mut Counters,
) -> Result<Option<Grid>, CudaError> {
    let before = *counters;
    let root_count =
        grid.cells.iter().fold(1u64, |count, &cells| count.saturating_mul(u64::from(cells.unsigned_abs())));
    let entries = before.entries.saturating_add(root_count);
    if entries > u64::from(building.entry_capacity) {
        return Ok(None);
    }
    let roots = roots(&grid);
    let mut level = Level {
        cells: card.upload(cast_slice(&roots))?,
        cell_count: roots.len(),
        candidates: card.allocate(4)?,
        side: grid.per_cell.recip(),
        before: Counters { entries, ..before },
    };
    let mut above: Option<Level<C::Memory>> = None;
    let mut shared = card.allocate(size_of::<Counters>())?;
    let fits = |after: &Counters| after.list_items + 2 * after.entries <= u64::from(limit);
    // The index in `DIVIDE_ABOVE` of the choice for the level above.
    let mut choice = 0;
    loop {
        let (after, _) = make_level(card, &mut building, &level, &mut shared, None)?;
        if !fits(&after) {
            choice += 1;
            let Some(parents) = &above else { return Ok(None) };
            let divided = DIVIDE_ABOVE
                .get(choice)
                .map(|divide_above| make_level(card, &mut building, parents, &mut shared, Some(*divide_above)));
            if let Some(divided) = divided {
                level = divided?.1;
            } else {
                // No choice is left, so the level above, whose lists did fit, becomes the last one.
                level = above.take().expect("it is some");
                grid.levels -= 1;
            }
            continue;
        }
        // After a coarser choice, no further level is tried.
        if choice == 0 && grid.levels < MAX_LEVELS {
            match make_level(card, &mut building, &level, &mut shared, Some(DIVIDE_ABOVE[0])) {
                Ok((divided, children)) if children.cell_count > 0 && fits(&divided) => {
                    above = Some(std::mem::replace(&mut level, children));
                    grid.levels += 1;
                    continue;
                }
                // There is nothing to divide, or no memory for it, so this level is the last one.
                Ok(_) | Err(CudaError::Memory(_)) => {}
                Err(error) => return Err(error),
            }
            // The attempt to divide has changed this level, so its lists are made again.
            let (_, _) = make_level(card, &mut building, &level, &mut shared, None)?;
        }
        *counters = after;
        #[allow(clippy::cast_precision_loss, reason = "a power of two")]
        let finest = (1u32 << grid.levels) as f32;
        grid.per_cell *= finest;
        return Ok(Some(grid));
    }
}

/// Makes the lists of a level. With `divide_above`, cells with more candidates are divided instead. Returns the
/// counters after the level, and the cells of the next one.
fn make_level<C: Card>(
    card: &C,
    building: &mut Building,
    level: &Level<C::Memory>,
    shared: &mut C::Memory,
    divide_above: Option<u32>,
) -> Result<(Counters, Level<C::Memory>), CudaError> {
    let mut counters = Counters { cells: 0, candidates: 0, ..level.before };
    card.write(shared, bytes_of(&counters))?;
    let (children, candidates) = divide_above.map_or((0, 0), |_| (level.cell_count * 8, level.cell_count * 48));
    let cells = card.allocate(children.max(1) * size_of::<Cell>())?;
    let next_candidates = card.allocate(candidates.max(1) * 4)?;
    *building = Building {
        cells: card.address(&level.cells),
        candidates: card.address(&level.candidates),
        children: card.address(&cells),
        next_candidates: card.address(&next_candidates),
        counters: card.address(shared),
        cell_capacity: u32::try_from(children).unwrap_or(u32::MAX),
        candidate_capacity: u32::try_from(candidates).unwrap_or(u32::MAX),
        side: level.side,
        divide_above: divide_above.unwrap_or(u32::MAX),
        is_last_level: u32::from(divide_above.is_none()),
        ..*building
    };
    for first in (0..level.cell_count).step_by(CELLS_PER_LAUNCH) {
        let part = Building { cells: building.cells + (first * size_of::<Cell>()) as Address, ..*building };
        card.launch("p2m_make_list", CELLS_PER_LAUNCH.min(level.cell_count - first), &part)?;
    }
    card.read(shared, bytes_of_mut(&mut counters))?;
    let cell_count = usize::try_from(counters.cells).map_or(children, |cells| cells.min(children));
    let next = Level { cells, cell_count, candidates: next_candidates, side: level.side / 2.0, before: counters };
    Ok((counters, next))
}

/// Returns the roots of a grid as cells.
#[allow(clippy::cast_possible_truncation, reason = "at most a few hundred thousand roots")]
fn roots(grid: &Grid) -> Vec<Cell> {
    let [x, y, z] = grid.cells;
    let mut roots = Vec::with_capacity((x * y * z).unsigned_abs() as usize);
    for k in 0..z {
        for j in 0..y {
            for i in 0..x {
                let entry = grid.first_entry + roots.len() as u32;
                let at = [grid.low[0] + i, grid.low[1] + j, grid.low[2] + k];
                roots.push(Cell { entry, at, first: FROM_TREE, ..Cell::zeroed() });
            }
        }
    }
    roots
}
