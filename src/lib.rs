//! p2m: closest points of scenes.
pub use p2m_core::*;
#[cfg(feature = "bvh")]
pub use p2m_bvh::*;
