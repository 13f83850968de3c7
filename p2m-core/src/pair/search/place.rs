//! The place of a node in the tree of a side.

/// The number of children of a node.
pub const WIDTH: usize = 8;

/// The number that marks an unused slot.
pub const NO_NODE: u32 = u32::MAX;

/// A node or a packet of primitives, with the slot that holds its bounds.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// The number of the node.
    pub node: u32,
    /// The number of its parent; [`NO_NODE`] for the root.
    pub parent: u32,
    /// Its slot in the parent.
    pub slot: u8,
    /// The sum of the sides of its box, rounded.
    pub size: f32,
}

impl Place {
    /// Returns the place of a root.
    #[must_use]
    pub fn root(node: u32) -> Self {
        Self { node, parent: NO_NODE, slot: 0, size: f32::INFINITY }
    }
}
