//! Where the walk to the cell of a query begins.

use super::fan::Fans;
use super::hints::{Fill, Grid};
use crate::delaunay::BOUNDING;
use crate::kernel::vector::V3;
use crate::simd::Isa;

/// Finds a site near a query.
///
/// Any site will do: from there the index walks to the nearest one, of which it is certain. So answers do not depend on
/// the locator, and it may err, but for numbers that no site has: for these searches panic.
pub trait Locator: Send + Sync + Sized + 'static {
    /// Whether this is [`Hints`](super::Hints), with which queries are compiled in this crate.
    #[doc(hidden)]
    const IS_USUAL: bool = false;

    /// For some sites.
    fn new(sites: &LocatorSites<'_>) -> Self;

    /// The number of a site near a place in the domain; `None` for none, then the tree answers.
    fn start(&self, place: &[f64; 3]) -> Option<usize>;

    /// Heap memory, in bytes.
    fn memory(&self) -> usize;

    /// Asks for the memory that [`start`](Self::start) reads first,
    #[inline(always)]
    fn prefetch(&self, _place: &[f64; 3]) {}

    /// and for what it reads then.
    #[inline(always)]
    fn prefetch_more(&self, _place: &[f64; 3]) {}
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
