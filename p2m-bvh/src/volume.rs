//! The bounding volumes that a tree may have.

use crate::construct::{SplitOptions, TreeOptions};
use crate::traverse::compiled::CompiledSearches;
use crate::tree::PacketTree;
use p2m_core::Aabb;

/// The bounding volume of the nodes of a [`PacketTree`]: [`Aabb<f64>`] or a k-DOP of the crate p2m-kdop.
///
/// The trait is sealed, because searches rest on proofs about the rounding of the nodes. Everything else about a tree
/// is the same for all volumes.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a bounding volume of trees",
    note = "volumes are `Aabb<f64>` and k-DOPs with an even K from 6 to 26"
)]
pub trait Volume: CompiledSearches {
    /// The options with which a tree is built.
    type Options: TreeOptions<Self::Shared>;
    /// The directions of the faces of all volumes of a tree. For boxes, which need none, the type is `()`.
    type Directions;

    /// The directions of the faces, from the data that all volumes of a tree share.
    fn directions(shared: &Self::Shared) -> &Self::Directions;
}

impl Volume for Aabb<f64> {
    type Options = SplitOptions;
    type Directions = ();

    fn directions((): &()) -> &() {
        &()
    }
}

impl<V: Volume> PacketTree<V> {
    /// The directions of the faces of the volumes, as [`Volume::Directions`] describes them.
    #[must_use]
    pub fn directions(&self) -> &V::Directions {
        V::directions(&self.shared)
    }
}
