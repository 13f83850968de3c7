//! The locator of an index: the default one or another one.

use crate::voronoi::grid_locator::GridLocator;
use crate::voronoi::locator::Locator;
use p2m_core::engine::vector::V3;
use std::sync::Arc;

/// The locator of an index. The grid has a variant of its own, so that calls of the default locator are direct.
#[derive(Clone, Debug)]
#[allow(clippy::large_enum_variant, reason = "an index has one locator, and a box would be one more address to read")]
pub(crate) enum AnyLocator {
    /// The default locator.
    Grid(GridLocator),
    /// A locator that was chosen in the options.
    Other(Arc<dyn Locator>),
}

impl AnyLocator {
    /// Returns a site near a point of the domain, as [`Locator::start`].
    #[inline(always)]
    pub(crate) fn start(&self, position: &V3) -> Option<usize> {
        match self {
            Self::Grid(grid) => grid.start(position),
            Self::Other(locator) => locator.start(position),
        }
    }

    /// Returns the heap memory in bytes.
    pub(crate) fn memory(&self) -> usize {
        match self {
            Self::Grid(grid) => grid.memory(),
            Self::Other(locator) => locator.memory(),
        }
    }

    /// Prefetches the memory that [`start`](Self::start) reads first.
    #[inline(always)]
    pub(crate) fn prefetch(&self, position: &V3) {
        if let Self::Grid(grid) = self {
            grid.prefetch(position);
        }
    }

    /// Prefetches the memory that [`start`](Self::start) reads second.
    #[inline(always)]
    pub(crate) fn prefetch_more(&self, position: &V3) {
        if let Self::Grid(grid) = self {
            grid.prefetch_more(position);
        }
    }
}
