//! Structures that the kernels use as well (`kernels/*.cuh`), with the same fields.

use bytemuck::{Pod, Zeroable};

/// A primitive in a local frame (`plate.cuh`).
#[repr(C, align(16))]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct Plate {
    pub(crate) origin: [f32; 3],
    pub(crate) along: [f32; 3],
    pub(crate) up: [f32; 3],
    pub(crate) length: f32,
    /// The direction of the side from A to the apex, and its length.
    pub(crate) left: [f32; 3],
    /// The direction of the side from B to the apex, and its length.
    pub(crate) right: [f32; 3],
}

/// A node of four children (`tree.cuh`).
#[repr(C, align(16))]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct Node {
    /// For each axis the lower and the upper bounds of the children.
    pub(crate) bounds: [[[f32; 4]; 2]; 3],
    pub(crate) first: [u32; 4],
    pub(crate) count: [u32; 4],
}

/// The vertices of a primitive, or [`NO_VERTEX`], and its id (`answer.cuh`).
#[repr(C, align(16))]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct Primitive {
    pub(crate) vertex: [u32; 3],
    pub(crate) id: u32,
}

pub(crate) const NO_VERTEX: u32 = u32::MAX;

/// An address on the card.
pub(crate) type Address = u64;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Grid {
    pub(crate) low: [i32; 3],
    pub(crate) cells: [i32; 3],
    pub(crate) levels: i32,
    pub(crate) per_cell: f32,
    pub(crate) first_entry: u32,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Index {
    pub(crate) nodes: Address,
    pub(crate) plates: Address,
    pub(crate) primitives: Address,
    pub(crate) vertices: Address,
    pub(crate) entries: Address,
    pub(crate) items: Address,
    pub(crate) grids: [Grid; 2],
    pub(crate) grid_count: i32,
    pub(crate) centre: [f64; 3],
    pub(crate) per_unit: f64,
}

/// The addresses of distances, lower bounds, points, weights, primitives and features; 0 for an unwanted column.
pub(crate) type Columns = [Address; 6];

#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Batch {
    pub(crate) index: Index,
    pub(crate) columns: Columns,
    pub(crate) queries: Address,
    pub(crate) order: Address,
    pub(crate) keys: Address,
    pub(crate) ranks: Address,
    pub(crate) starts: Address,
    pub(crate) placed: Address,
    pub(crate) rest: Address,
    pub(crate) rest_count: Address,
    pub(crate) undecided: Address,
    pub(crate) undecided_count: Address,
    pub(crate) radius: f64,
    pub(crate) prune: f64,
    pub(crate) gathered: Address,
    pub(crate) answers: Columns,
    pub(crate) has_f32_queries: u32,
}

/// The number of keys by which queries are sorted, and the number of keys to which a thread assigns places.
pub(crate) const KEYS: usize = 1 << 22;
pub(crate) const KEYS_PER_GROUP: usize = 64;

/// A cell whose list is to be made (`lists.cuh`).
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct Cell {
    pub(crate) entry: u32,
    pub(crate) at: [i32; 3],
    pub(crate) first: u32,
    pub(crate) count: u32,
}

/// The value of [`Cell::first`] for a cell whose candidates come from the tree.
pub(crate) const FROM_TREE: u32 = u32::MAX;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub(crate) struct Counters {
    pub(crate) list_items: u64,
    pub(crate) entries: u64,
    pub(crate) cells: u64,
    pub(crate) candidates: u64,
    pub(crate) left_out: u64,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Building {
    pub(crate) nodes: Address,
    pub(crate) plates: Address,
    pub(crate) entries: Address,
    pub(crate) items: Address,
    pub(crate) cells: Address,
    pub(crate) children: Address,
    pub(crate) candidates: Address,
    pub(crate) next_candidates: Address,
    pub(crate) counters: Address,
    pub(crate) item_capacity: u32,
    pub(crate) entry_capacity: u32,
    pub(crate) candidate_capacity: u32,
    pub(crate) cell_capacity: u32,
    pub(crate) side: f32,
    pub(crate) divide_above: u32,
    pub(crate) list_limit: u32,
    pub(crate) is_last_level: u32,
}
