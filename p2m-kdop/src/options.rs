use crate::Directions;
use p2m_bvh::SplitOptions;

/// How a k-DOP tree is built: directions, and splits as for a tree of boxes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct KdopOptions<const K: usize> {
    /// The normals of its k-DOPs.
    pub directions: Directions<K>,
    /// How primitives are split.
    pub splits: SplitOptions,
}

impl<const K: usize> KdopOptions<K> {
    /// With these directions and the usual splits.
    #[must_use]
    pub fn new(directions: Directions<K>) -> Self {
        Self { directions, splits: SplitOptions::default() }
    }
    /// With other splits.
    #[must_use]
    pub fn with_splits(self, splits: SplitOptions) -> Self {
        Self { splits, ..self }
    }
}

impl<const K: usize> Default for KdopOptions<K>
where
    Directions<K>: Default,
{
    /// For K = 6, 14, 18 and 26.
    fn default() -> Self {
        Self::new(Directions::default())
    }
}
