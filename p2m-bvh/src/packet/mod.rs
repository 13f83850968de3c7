//! Packets: up to sixteen primitives of one kind, whose distances are bounded together.
//!
//! A packet ([`layout`]) stores the vertices of its primitives as 16-bit whole numbers in a frame of its own, so that
//! one vector instruction handles one coordinate of many primitives. That takes half the memory of f32 and is more
//! precise, because the frame is only as large as the packet. The distance filter ([`distance_filter`]) and the line
//! filter ([`line_filter`]) compute in f32 which primitives cannot be the answer. They decide nothing else: the kernel
//! of the contract evaluates every primitive that they do not exclude.

mod distance_filter;
mod layout;
mod line;
mod line_filter;
mod member;
mod squared_distance;

pub use distance_filter::{Local, Locals, PLACES, ROUND_UP, at_most, smallest};
pub use layout::{LANES, Packet, frame_unit};
pub use line::RayLine;
pub use member::{Kind, Member, Members};
