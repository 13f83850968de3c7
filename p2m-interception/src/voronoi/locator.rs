//! The interface of locators: they find the site at which the walk to the cell of a query begins.

use crate::delaunay::BOUNDING;
use crate::voronoi::neighbours::NeighbourTable;
use p2m_core::engine::simd::Isa;
use p2m_core::engine::vector::V3;
use std::fmt::Debug;
use std::sync::Arc;

/// Finds a site near a query point.
///
/// Any site will do: the index walks from there to the nearest site, whose cell contains the query point. So answers do
/// not depend on the locator. Searches panic if the returned number is not the number of a site.
pub trait Locator: Debug + Send + Sync {
    /// Returns the number of a site near a point of the domain, or `None` if the tree should answer. The point is in
    /// the units of [`LocatorSites::positions`].
    fn start(&self, position: &[f64; 3]) -> Option<usize>;

    /// Returns the heap memory that the locator owns, in bytes.
    fn memory(&self) -> usize;
}

/// Makes the locator of an index from its sites: a function such as `KdTreeLocator::build`.
pub type BuildLocator = fn(&LocatorSites<'_>) -> Arc<dyn Locator>;

/// The sites of an index, from which its locator is built. They have the same unit as the points that
/// [`Locator::start`] takes.
#[derive(Clone, Copy)]
pub struct LocatorSites<'a> {
    pub(crate) neighbours: &'a NeighbourTable,
    pub(crate) isa: Isa,
    /// The box of the vertices of the scene, a little larger.
    pub(crate) scene_box: [V3; 2],
    /// The box in which queries are located.
    pub(crate) domain_box: [V3; 2],
}

impl LocatorSites<'_> {
    /// Returns the number of the first site. The others follow, as many as there are [`positions`](Self::positions).
    #[must_use]
    pub fn first(&self) -> usize {
        BOUNDING
    }

    /// Returns the positions of the sites from the first one on.
    pub fn positions(&self) -> impl Iterator<Item = [f64; 3]> + '_ {
        self.neighbours.sites[BOUNDING..].iter().map(|site| site.position)
    }
}
