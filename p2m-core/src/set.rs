//! Sets of primitives, which indexes are built over.

use crate::{Aabb, BuildError, Primitive, Real};

/// Number of a primitive in its set, from 0, in the order in which the user gave them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(transparent)]
pub struct PrimitiveId(u32);

impl PrimitiveId {
    /// How many primitives a set can hold: 2^30, which leaves two bits to structures that pack a kind beside an id.
    pub const MAX_COUNT: usize = 1 << 30;

    /// The id of the primitive at `index`.
    ///
    /// # Panics
    /// If `index` is not below [`PrimitiveId::MAX_COUNT`].
    #[inline]
    #[must_use]
    #[allow(clippy::cast_possible_truncation, reason = "checked on the line before")]
    pub fn new(index: usize) -> Self {
        assert!(index < Self::MAX_COUNT, "primitive index {index} exceeds the range of ids");
        Self(index as u32)
    }

    /// As it is kept.
    #[inline(always)]
    #[doc(hidden)]
    pub fn number(self) -> u32 {
        self.0
    }

    /// Its place in the set.
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

/// Primitives numbered 0, 1, 2, ..
///
/// An index is generic over the set, so a homogeneous one (a slice of [`Triangle`](crate::Triangle)s, say) compiles to
/// the kernel of its primitive alone, while a [`Soup`](crate::Soup) hands out [`Shape`](crate::Shape)s at the price of
/// one match.
pub trait PrimitiveSet<T: Real> {
    /// What `get` hands out.
    type Primitive<'a>: Primitive<T>
    where
        Self: 'a;

    /// How many there are.
    fn len(&self) -> usize;

    /// The primitive of that number.
    ///
    /// # Panics
    /// May panic if `id` is not below `len`.
    fn get(&self, id: PrimitiveId) -> Self::Primitive<'_>;

    /// Whether there are none.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The box around all of them; the empty box if there are none.
    ///
    /// # Complexity
    /// O(n).
    fn aabb(&self) -> Aabb<T> {
        (0..self.len()).map(|i| self.get(PrimitiveId::new(i)).aabb()).fold(Aabb::empty(), |all, one| all.union(&one))
    }
}

impl<T: Real, P: Primitive<T>> PrimitiveSet<T> for [P] {
    type Primitive<'a>
        = &'a P
    where
        P: 'a;

    #[inline(always)]
    fn len(&self) -> usize {
        <[P]>::len(self)
    }
    #[inline(always)]
    fn get(&self, id: PrimitiveId) -> &P {
        &self[id.index()]
    }
}

impl<T: Real, P: Primitive<T>, const N: usize> PrimitiveSet<T> for [P; N] {
    type Primitive<'a>
        = &'a P
    where
        P: 'a;

    #[inline(always)]
    fn len(&self) -> usize {
        N
    }
    #[inline(always)]
    fn get(&self, id: PrimitiveId) -> &P {
        &self[id.index()]
    }
}

impl<T: Real, P: Primitive<T>> PrimitiveSet<T> for Vec<P> {
    type Primitive<'a>
        = &'a P
    where
        P: 'a;

    #[inline(always)]
    fn len(&self) -> usize {
        Vec::len(self)
    }
    #[inline(always)]
    fn get(&self, id: PrimitiveId) -> &P {
        &self[id.index()]
    }
}

impl<T: Real, S: PrimitiveSet<T> + ?Sized> PrimitiveSet<T> for &S {
    type Primitive<'a>
        = S::Primitive<'a>
    where
        Self: 'a;

    #[inline(always)]
    fn len(&self) -> usize {
        (**self).len()
    }
    #[inline(always)]
    fn get(&self, id: PrimitiveId) -> Self::Primitive<'_> {
        (**self).get(id)
    }
}

/// Checks what every index demands of its set: few enough primitives, finite coordinates.
///
/// # Errors
/// [`BuildError::TooMany`] and [`BuildError::NonFinite`].
pub fn check_set<T: Real, S: PrimitiveSet<T> + ?Sized>(set: &S) -> Result<(), BuildError> {
    if set.len() > PrimitiveId::MAX_COUNT {
        return Err(BuildError::TooMany { len: set.len() });
    }
    match (0..set.len()).map(PrimitiveId::new).find(|id| !set.get(*id).is_finite()) {
        Some(id) => Err(BuildError::NonFinite { id }),
        None => Ok(()),
    }
}
