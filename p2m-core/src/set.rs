//! Sets of primitives, over which indexes are built.

use crate::{Aabb, BuildError, Primitive, PrimitiveId, Real};

/// A set of primitives with the ids 0, 1, 2, ...
///
/// An index is generic over its set. So an index over a homogeneous set, such as a slice of
/// [`Triangle`](crate::Triangle)s, is compiled for the kernel of that primitive alone. A [`Soup`](crate::Soup) returns
/// [`Shape`](crate::Shape)s, at the cost of one `match`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a scene with coordinates of type `{T}`",
    note = "scenes are `Soup<{T}>`, slices, arrays and vectors of primitives, and `&`, `Box` and `Arc` of them"
)]
pub trait PrimitiveSet<T: Real> {
    /// The type of primitives that [`get`](Self::get) returns.
    type Primitive<'a>: Primitive<T>
    where
        Self: 'a;

    /// Returns the number of primitives.
    fn len(&self) -> usize;

    /// Returns the primitive with an id.
    ///
    /// # Panics
    /// It may panic if `id` is not below `len`.
    fn get(&self, id: PrimitiveId) -> Self::Primitive<'_>;

    /// Returns whether the set is empty.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the smallest box around all primitives. It is the empty box for an empty set.
    ///
    /// # Complexity
    /// It takes O(n).
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

/// Checks a set for an index: at most 2^30 primitives, and only finite coordinates.
///
/// # Errors
/// It returns [`BuildError::TooMany`] or [`BuildError::NonFinite`].
///
/// # Complexity
/// It takes O(n).
pub fn check_set<T: Real, S: PrimitiveSet<T> + ?Sized>(set: &S) -> Result<(), BuildError> {
    if set.len() > PrimitiveId::MAX_COUNT {
        return Err(BuildError::TooMany { len: set.len() });
    }
    let first_bad = (0..set.len()).map(PrimitiveId::new).find(|id| !set.get(*id).is_finite());
    first_bad.map_or(Ok(()), |id| Err(BuildError::NonFinite { id }))
}
