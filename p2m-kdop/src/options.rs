//! The options of a k-DOP tree.

use crate::Directions;
use p2m_bvh::SplitOptions;

/// The options of building a k-DOP tree.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct KdopOptions<const K: usize> {
    /// The directions of the faces of its k-DOPs.
    pub directions: Directions<K>,
    /// The options of the splits, which are the same as for an AABB tree.
    pub splits: SplitOptions,
}

impl<const K: usize> KdopOptions<K> {
    /// Creates options with these directions and the default splits.
    #[must_use]
    pub fn new(directions: Directions<K>) -> Self {
        Self { directions, splits: SplitOptions::default() }
    }
    /// Sets the options of splits.
    #[must_use]
    pub fn with_splits(self, splits: SplitOptions) -> Self {
        Self { splits, ..self }
    }
}

impl<const K: usize> Default for KdopOptions<K>
where
    Directions<K>: Default,
{
    /// Returns the options with the default directions, which exist for K = 6, 14, 18 and 26.
    fn default() -> Self {
        Self::new(Directions::default())
    }
}
