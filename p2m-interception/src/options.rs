//! What can be chosen about an octree, and what it became.

use crate::voronoi::list_filter::BuildListFilter;
use crate::voronoi::locator::BuildLocator;
use p2m_bvh::SplitOptions;
use p2m_core::Aabb;

/// Where queries are to be expected: model only what a scene and its queries require. Elsewhere the tree answers, just
/// as right.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Domain {
    /// Everywhere: cells reach to ten times the size of the scene's box.
    #[default]
    Everywhere,
    /// In a box.
    Box(Aabb<f64>),
    /// At most this far from the scene.
    Band(f64),
}

/// How an octree is built. Budgets are upper limits of the index, not of what building it takes: where one would be
/// exceeded, cells are made coarser everywhere, with the next power of 0.3 for a resolution that fits; or none are
/// made.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct OctreeOptions {
    /// How the packets of the tree are made, and whether all threads are used.
    pub splits: SplitOptions,
    /// Where queries are expected.
    pub domain: Domain,
    /// How fine cells are: larger is finer, 1 takes about one and a half times the memory of 0.3, which is the default. Without
    /// a positive number there are no cells, and the tree answers everything.
    pub resolution: f64,
    /// What cells may take, in bytes for each primitive of the scene (for at least 10,000 primitives). 190 by default.
    pub memory: f64,
    /// How many times packets may be tested while building, at one point each, for each primitive (for at least
    /// 10,000). 200 by default.
    pub work: f64,
}

impl Default for OctreeOptions {
    fn default() -> Self {
        Self {
            splits: SplitOptions::default(),
            domain: Domain::Everywhere,
            resolution: 0.3,
            memory: 190.0,
            work: 200.0,
        }
    }
}

impl OctreeOptions {
    /// With queries in a part of space.
    #[must_use]
    pub fn with_domain(self, domain: Domain) -> Self {
        Self { domain, ..self }
    }
    /// With finer or coarser cells.
    #[must_use]
    pub fn with_resolution(self, resolution: f64) -> Self {
        Self { resolution, ..self }
    }
    /// With another memory budget.
    #[must_use]
    pub fn with_memory(self, memory: f64) -> Self {
        Self { memory, ..self }
    }
    /// With another build budget.
    #[must_use]
    pub fn with_work(self, work: f64) -> Self {
        Self { work, ..self }
    }
    /// With other splits.
    #[must_use]
    pub fn with_splits(self, splits: SplitOptions) -> Self {
        Self { splits, ..self }
    }
}

/// What an octree is made of.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct OctreeReport {
    /// CellContext with a list.
    pub lists: usize,
    /// CellContext of which one primitive is the nearest throughout.
    pub singles: usize,
    /// CellContext that the tree answers: outside of the domain, or where a list would not be short.
    pub trees: usize,
    /// Packets in all lists.
    pub entries: usize,
    /// The length of the longest way to a cell, in halvings of the domain.
    pub depth: usize,
    /// Bytes of cells and lists.
    pub bytes: usize,
    /// Bytes of the tree over the packets.
    pub tree_bytes: usize,
    /// How many times a packet was tested at a point.
    pub work: u64,
    /// The resolution: less than was asked for where that would have exceeded a budget.
    pub resolution: f64,
}

impl std::fmt::Display for OctreeReport {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { lists, singles, trees, entries, bytes, tree_bytes, work, resolution, .. } = self;
        let mean = *entries as f64 / (*lists).max(1) as f64;
        let megabytes = |bytes: usize| bytes as f64 / 1e6;
        write!(f, "{lists} cells with lists of {mean:.1} packets on average, {singles} with one primitive, ")?;
        write!(f, "{trees} left to the tree; ")?;
        write!(f, "{:.1} MB of cells, {:.1} MB of tree, {work} tests", megabytes(*bytes), megabytes(*tree_bytes))?;
        let digits = if *resolution < 0.01 { 5 } else { 2 };
        write!(f, ", resolution {resolution:.digits$}")
    }
}

/// A function to build a part with. Two are equal if they have the same address, so equal functions may differ.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FnPointer<F>(pub(crate) F);

impl PartialEq for FnPointer<BuildLocator> {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::fn_addr_eq(self.0, other.0)
    }
}

impl PartialEq for FnPointer<BuildListFilter> {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::fn_addr_eq(self.0, other.0)
    }
}

/// How a P2M index is built. Budgets are upper limits: where one would be exceeded, or there are more than sixteen Delaunay
/// tetrahedra for each vertex of a packet, there are no cells, and the tree answers everything.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct P2mOptions {
    /// How the packets of the tree are made, and whether all threads are used.
    pub splits: SplitOptions,
    /// VoronoiLists of more packets are left to the tree: 96 by default. More than 2048 count as 2048.
    pub max_list_packets: usize,
    /// At most so many sites are added for each vertex of a packet (one that several packets have counts several times),
    /// where many primitives are about as near as the nearest vertex: on long edges and wide faces, and in the middle
    /// of round shapes. 0.5 by default.
    pub max_extra_sites: f64,
    /// Makes the locator, by which a query finds a site near its own. By default it is a grid.
    pub(crate) locator: Option<FnPointer<BuildLocator>>,
    /// Makes the filter of each long list. By default there are none.
    pub(crate) list_filter: Option<FnPointer<BuildListFilter>>,
    /// If there are filters, a list of more primitives than this has one. 64 by default.
    pub filter_above: usize,
    /// What the lists, and while building the packets around all corners of cells, may take each, in bytes for each primitive
    /// (for at least 1000): 3072 by default. Where that is exceeded, the tree answers alone.
    pub memory: f64,
    /// How many times packets may be tested while building, at one point each, for each primitive (for at least 1000).
    /// 20,000 by default. Where that is exceeded, the tree answers alone.
    pub work: f64,
}

impl Default for P2mOptions {
    fn default() -> Self {
        Self {
            splits: SplitOptions::default(),
            max_list_packets: 96,
            max_extra_sites: 0.5,
            locator: None,
            list_filter: None,
            filter_above: 64,
            memory: 3072.0,
            work: 20_000.0,
        }
    }
}

impl P2mOptions {
    /// With other splits.
    #[must_use]
    pub fn with_splits(self, splits: SplitOptions) -> Self {
        Self { splits, ..self }
    }
    /// With lists of more or fewer packets.
    #[must_use]
    pub fn with_max_list_packets(self, max_list_packets: usize) -> Self {
        Self { max_list_packets, ..self }
    }
    /// With more or fewer sites.
    #[must_use]
    pub fn with_max_extra_sites(self, max_extra_sites: f64) -> Self {
        Self { max_extra_sites, ..self }
    }
    /// With another locator than a grid. Answers do not depend on it. A saved index has a grid instead.
    #[must_use]
    pub fn with_locator(self, build: BuildLocator) -> Self {
        Self { locator: Some(FnPointer(build)), ..self }
    }
    /// With filters of long lists. Answers do not depend on them. A saved index has none.
    #[must_use]
    pub fn with_list_filter(self, build: BuildListFilter) -> Self {
        Self { list_filter: Some(FnPointer(build)), ..self }
    }
    /// With filters for longer or shorter lists.
    #[must_use]
    pub fn with_filter_above(self, filter_above: usize) -> Self {
        Self { filter_above, ..self }
    }
    /// With another memory budget.
    #[must_use]
    pub fn with_memory(self, memory: f64) -> Self {
        Self { memory, ..self }
    }
    /// With another build budget.
    #[must_use]
    pub fn with_work(self, work: f64) -> Self {
        Self { work, ..self }
    }
}

/// What a P2M index is made of.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct P2mReport {
    /// CellContext with a list.
    pub lists: usize,
    /// Those of them that have a filter.
    pub filtered: usize,
    /// Points of the scene that were added to its vertices as sites.
    pub added: usize,
    /// Sites beside the scene, in whose cells the tree answers.
    pub auxiliary: usize,
    /// Other cells that the tree answers: where these are a quarter of all, it answers everything, and nothing is kept.
    pub trees: usize,
    /// Packets that were looked at for lists: those that meet a ball at a corner of the cell.
    pub candidates: usize,
    /// The most for one cell.
    pub most_candidates: usize,
    /// Packets in all lists.
    pub entries: usize,
    /// Primitives in all lists.
    pub primitives: usize,
    /// Bytes of cells and lists.
    pub bytes: usize,
    /// Bytes of the tree over the packets.
    pub tree_bytes: usize,
}

/// The report as numbers of a file.
impl From<P2mReport> for [u64; 11] {
    fn from(report: P2mReport) -> Self {
        let P2mReport {
            lists,
            filtered,
            added,
            auxiliary,
            trees,
            candidates,
            most_candidates,
            entries,
            primitives,
            bytes,
            tree_bytes,
        } = report;
        [lists, filtered, added, auxiliary, trees, candidates, most_candidates, entries, primitives, bytes, tree_bytes]
            .map(|n| n as u64)
    }
}

impl From<[u64; 11]> for P2mReport {
    #[allow(clippy::cast_possible_truncation, reason = "numbers to report")]
    fn from(numbers: [u64; 11]) -> Self {
        let [
            lists,
            filtered,
            added,
            auxiliary,
            trees,
            candidates,
            most_candidates,
            entries,
            primitives,
            bytes,
            tree_bytes,
        ] = numbers.map(|n| n as usize);
        Self {
            lists,
            filtered,
            added,
            auxiliary,
            trees,
            candidates,
            most_candidates,
            entries,
            primitives,
            bytes,
            tree_bytes,
        }
    }
}

impl std::fmt::Display for P2mReport {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { lists, filtered, added, auxiliary, trees, entries, primitives, bytes, tree_bytes, .. } = self;
        let mean = |count: &usize| *count as f64 / (*lists).max(1) as f64;
        let megabytes = |bytes: &usize| *bytes as f64 / 1e6;
        write!(
            f,
            "{lists} cells with lists of {:.1} primitives in {:.1} packets on average, ",
            mean(primitives),
            mean(entries)
        )?;
        if *filtered > 0 {
            write!(f, "{filtered} of them filtered, ")?;
        }
        write!(f, "{trees} left to the tree; {added} sites added on the scene and {auxiliary} beside it; ")?;
        write!(f, "{:.1} MB of cells, {:.1} MB of tree", megabytes(bytes), megabytes(tree_bytes))
    }
}
