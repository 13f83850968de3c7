//! Ids of primitives.

/// The index of a primitive in its set, from 0, in the order in which the primitives were given.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(transparent)]
pub struct PrimitiveId(u32);

impl PrimitiveId {
    /// The most primitives in a set, 2^30. Two bits are left for structures that pack a kind with an id.
    pub const MAX_COUNT: usize = 1 << 30;

    /// Returns the id of the primitive at `index`.
    ///
    /// # Panics
    /// It panics if `index` is not below [`PrimitiveId::MAX_COUNT`].
    #[inline]
    #[must_use]
    #[allow(clippy::cast_possible_truncation, reason = "checked on the line before")]
    pub fn new(index: usize) -> Self {
        assert!(index < Self::MAX_COUNT, "primitive index {index} exceeds the range of ids");
        Self(index as u32)
    }

    /// Returns the index as a u32.
    #[inline(always)]
    #[doc(hidden)]
    pub fn number(self) -> u32 {
        self.0
    }

    /// Returns the index of the primitive in its set.
    #[inline]
    #[must_use]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

impl std::fmt::Display for PrimitiveId {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.fmt(f)
    }
}
