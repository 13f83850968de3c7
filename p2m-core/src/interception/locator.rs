//! Where the walk to the cell of a query begins.

use super::fan::Fans;
use super::hints::{Fill, Grid, Hints};
use crate::delaunay::BOUNDING;
use crate::kernel::vector::V3;
use crate::simd::Isa;
use std::fmt::Debug;
use std::sync::Arc;

/// Finds a site near a query point.
///
/// Any site will do: the index walks from there to the nearest site, whose cell holds the query point. So answers do not
/// depend on the locator. A number that no site has makes searches panic.
pub trait Locator: Debug + Send + Sync {
    /// Returns the number of a site near a point of the domain, or `None` if the tree should answer. The point is in the
    /// units of [`LocatorSites::places`].
    fn start(&self, place: &[f64; 3]) -> Option<usize>;

    /// The heap memory that the locator owns, in bytes.
    fn memory(&self) -> usize;
}

/// Makes the locator of an index from its sites: a function such as `KdTreeLocator::build`.
pub type BuildLocator = fn(&LocatorSites<'_>) -> Arc<dyn Locator>;

/// The locator of an index. Calls of the grid are direct, since it is the default.
#[derive(Clone, Debug)]
pub(super) enum AnyLocator {
    Grid(Hints),
    Other(Arc<dyn Locator>),
}

impl AnyLocator {
    #[inline(always)]
    pub(super) fn start(&self, place: &V3) -> Option<usize> {
        match self {
            Self::Grid(grid) => grid.start(place),
            Self::Other(locator) => locator.start(place),
        }
    }

    pub(super) fn memory(&self) -> usize {
        match self {
            Self::Grid(grid) => grid.memory(),
            Self::Other(locator) => locator.memory(),
        }
    }

    /// Prefetches the memory that [`start`](Self::start) reads first.
    #[inline(always)]
    pub(super) fn prefetch(&self, place: &V3) {
        if let Self::Grid(grid) = self {
            grid.prefetch(place);
        }
    }

    /// Prefetches the memory that [`start`](Self::start) reads second.
    #[inline(always)]
    pub(super) fn prefetch_more(&self, place: &V3) {
        if let Self::Grid(grid) = self {
            grid.prefetch_more(place);
        }
    }
}

/// Sites by their numbers, in the units that places are given in.
#[derive(Clone, Copy)]
pub struct LocatorSites<'a> {
    pub(super) fans: &'a Fans,
    pub(super) isa: Isa,
    /// The box of the vertices, a little larger.
    pub(super) own: [V3; 2],
    /// That of queries.
    pub(super) domain: [V3; 2],
}

impl LocatorSites<'_> {
    /// The number of the first site; the others follow, as many as there are [`places`](Self::places).
    #[must_use]
    pub fn first(&self) -> usize {
        BOUNDING
    }

    /// The places of the sites from the first one on.
    pub fn places(&self) -> impl Iterator<Item = [f64; 3]> + '_ {
        self.fans.sites[BOUNDING..].iter().map(|site| site.place)
    }

    /// Sites to begin at in each cell of a grid.
    pub(super) fn fill(&self, grid: &mut Grid) {
        self.isa.run(Fill { grid, fans: self.fans, first: BOUNDING });
    }
}
