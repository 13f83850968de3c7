//! References to nodes and packets.

/// The number of children of a node.
pub const WIDTH: usize = 8;

/// A reference to a node or a packet by its number, or to neither.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NodeRef(pub u32);

/// The bit that is set in references to packets.
const PACKET_BIT: u32 = 1 << 31;

impl NodeRef {
    /// The reference to neither a node nor a packet, which marks unused slots.
    pub const NONE: Self = Self(u32::MAX);

    /// Returns a reference to a node.
    ///
    /// # Panics
    /// Panics if the number does not fit into 32 bits.
    pub fn node(number: usize) -> Self {
        Self(u32::try_from(number).expect("fewer nodes than primitives"))
    }
    /// Returns a reference to a packet.
    ///
    /// # Panics
    /// Panics if the number does not fit into 32 bits.
    pub fn packet(number: usize) -> Self {
        Self(u32::try_from(number).expect("fewer packets than primitives") | PACKET_BIT)
    }
    /// Returns whether the reference is to a packet.
    #[inline(always)]
    pub fn is_packet(self) -> bool {
        self.0 & PACKET_BIT != 0
    }
    /// Returns the number of the node or the packet.
    #[inline(always)]
    pub fn number(self) -> usize {
        (self.0 & !PACKET_BIT) as usize
    }
}
