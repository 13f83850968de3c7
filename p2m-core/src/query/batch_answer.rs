//! An unconverted answer of a batch.

use super::best::{Best, BestF64};
use crate::{Closest, Real};
use std::marker::PhantomData;

/// The answer to one query of a batch. It converts to [`Closest`], or to the requested fields alone.
#[derive(Clone, Copy, Debug)]
pub struct BatchAnswer<'a, T: Real> {
    minimum: &'a BestF64,
    scalar: PhantomData<T>,
}

impl<'a, T: Real> BatchAnswer<'a, T> {
    /// Wraps the running minimum of a search that has ended.
    #[inline(always)]
    #[doc(hidden)]
    pub fn new(minimum: &'a BestF64) -> Self {
        Self { minimum, scalar: PhantomData }
    }

    /// Returns the answer, or `None` if nothing lies within the largest distance or the query is not finite.
    #[inline]
    #[must_use]
    pub fn closest(&self) -> Option<Closest<T>> {
        self.minimum.finish()
    }

    /// Returns the lower bound of the answer. Without an answer it is a lower bound on the distances of all primitives.
    #[inline]
    pub(crate) fn lower_bound(&self) -> T {
        self.closest().map_or_else(|| self.minimum.lower_bound_without_answer(), |closest| closest.lower_bound)
    }

    /// Returns the distance and the primitive's index of [`closest`](Self::closest), without computing the other
    /// fields.
    #[inline]
    #[must_use]
    pub fn distance_and_index(&self) -> Option<(T, u32)> {
        self.minimum.distance_and_primitive().map(|(distance, id)| (T::round_from_f64(distance), id.number()))
    }
}

impl<T: Real> Best<T> {
    /// Returns the answer so far, from which the requested fields can be converted.
    #[must_use]
    pub fn found(&self) -> BatchAnswer<'_, T> {
        BatchAnswer::new(self.minimum_ref())
    }
}
