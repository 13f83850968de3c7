//! The options of the indexes, and the statistics of what was built.

use crate::list::block::{BLOCK_WIDTH, MAX_BLOCKS};
use crate::octree::budget::MIN_PRIMITIVES_FOR_BUDGETS;
use crate::voronoi::list_filter::BuildListFilter;
use crate::voronoi::locator::BuildLocator;
use p2m_bvh::SplitOptions;
use p2m_core::{Aabb, CellSummary};

/// The part of space where queries are expected. Cells are made only there, and the tree answers elsewhere with
/// the same results.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Domain {
    /// Queries are expected everywhere. Cells reach to ten times the size of the scene's box.
    #[default]
    Everywhere,
    /// Queries are expected in a box.
    Box(Aabb<f64>),
    /// Queries are expected within this distance of the scene.
    Band(f64),
}

/// The options of an octree.
///
/// The budgets limit the index itself, not the memory while it is built. If a budget would be exceeded, the least
/// valuable cells stay coarser. If not even the coarsest cells fit, there are none and the tree answers everything.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct OctreeOptions {
    /// The splits of the tree, which define the packets, and whether all threads are used.
    pub splits: SplitOptions,
    /// The part of space where queries are expected.
    pub domain: Domain,
    /// The fineness of cells. Larger is finer: 1 takes about one and a half times the memory of 0.3, the default. If
    /// it is not positive, there are no cells and the tree answers everything.
    pub resolution: f64,
    /// The memory budget of cells and lists, in bytes per primitive of the scene. It is 190 by default. A scene with
    /// fewer than 10,000 primitives has the budget of 10,000.
    pub memory: f64,
    /// The work budget, in tests of a packet at a point per primitive. It is 200 by default. A scene with fewer than
    /// 10,000 primitives has the budget of 10,000.
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
    /// Sets the part of space where queries are expected.
    #[must_use]
    pub fn with_domain(self, domain: Domain) -> Self {
        Self { domain, ..self }
    }
    /// Sets the fineness of cells.
    #[must_use]
    pub fn with_resolution(self, resolution: f64) -> Self {
        Self { resolution, ..self }
    }
    /// Sets the memory budget.
    #[must_use]
    pub fn with_memory(self, memory: f64) -> Self {
        Self { memory, ..self }
    }
    /// Sets the work budget.
    #[must_use]
    pub fn with_work(self, work: f64) -> Self {
        Self { work, ..self }
    }
    /// Multiplies the resolution by a factor, and the budgets of memory and work as well if the factor is above 1.
    ///
    /// Finer cells have shorter lists, so less is computed, but more lies in memory. A single query waits for memory,
    /// so it gains little. A batch fetches the memory of one query while it computes others, so it gains more:
    /// [docs/measurements/octree.md] has the time, the memory and the build of a factor of 30.
    ///
    /// [docs/measurements/octree.md]: https://github.com/p2m-rs/p2m/blob/main/docs/measurements/octree.md
    #[must_use]
    pub fn with_finer_cells(self, factor: f64) -> Self {
        let Self { resolution, memory, work, .. } = self;
        let budget = factor.max(1.0);
        Self { resolution: resolution * factor, memory: memory * budget, work: work * budget, ..self }
    }
    /// Lowers the memory budget to a number of bytes in all, for a scene of `primitives` primitives.
    #[must_use]
    pub fn with_max_bytes(self, bytes: usize, primitives: usize) -> Self {
        let most = bytes as f64 / primitives.max(MIN_PRIMITIVES_FOR_BUDGETS) as f64;
        Self { memory: self.memory.min(most), ..self }
    }
    /// Sets the splits of the tree.
    #[must_use]
    pub fn with_splits(self, splits: SplitOptions) -> Self {
        Self { splits, ..self }
    }
}

/// The size of an octree if its refinement ended now.
///
/// All numbers are upper bounds, because a list that is not made yet may turn out shorter than the space reserved for
/// it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct RefinementProgress {
    /// The number of cells.
    pub cells: usize,
    /// The number of cells with a list.
    pub list_cells: usize,
    /// The number of packets in all lists.
    pub entries: usize,
    /// The memory of cells and lists in bytes.
    pub bytes: usize,
}

impl RefinementProgress {
    /// Returns the mean number of packets in a list.
    #[must_use]
    pub fn mean_list_length(&self) -> f64 {
        self.entries as f64 / self.list_cells.max(1) as f64
    }
}

/// The statistics of an octree.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct OctreeReport {
    /// The number of cells with a list.
    pub list_cells: usize,
    /// The number of cells in which one primitive is the nearest everywhere.
    pub single_cells: usize,
    /// The number of cells that the tree answers, outside of the domain or because a list would be long.
    pub fallback_cells: usize,
    /// The number of packets in all lists.
    pub entries: usize,
    /// The number of halvings of the domain on the longest path to a cell.
    pub depth: usize,
    /// The memory of cells and lists in bytes.
    pub bytes: usize,
    /// The memory of the tree over the packets in bytes.
    pub tree_bytes: usize,
    /// The number of tests of a packet at a point while building.
    pub work: u64,
    /// The resolution at which all cells were refined. It is less than requested if a budget would have been exceeded,
    /// or if the refinement was ended early.
    pub resolution: f64,
}

impl OctreeReport {
    /// Returns the counts in the order in which a file stores them.
    pub(crate) fn counts(&mut self) -> [&mut usize; 7] {
        [
            &mut self.list_cells,
            &mut self.single_cells,
            &mut self.fallback_cells,
            &mut self.entries,
            &mut self.depth,
            &mut self.bytes,
            &mut self.tree_bytes,
        ]
    }
}

impl std::fmt::Display for OctreeReport {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { list_cells, single_cells, fallback_cells, entries, bytes, tree_bytes, work, resolution, .. } = self;
        let mean = *entries as f64 / (*list_cells).max(1) as f64;
        let megabytes = |bytes: usize| bytes as f64 / 1e6;
        write!(
            f,
            "{list_cells} cells with lists of {mean:.1} packets on average, {single_cells} with one primitive, "
        )?;
        write!(f, "{fallback_cells} left to the tree; ")?;
        write!(f, "{:.1} MB of cells, {:.1} MB of tree, {work} tests", megabytes(*bytes), megabytes(*tree_bytes))?;
        let digits = if *resolution < 0.01 { 5 } else { 2 };
        write!(f, ", resolution {resolution:.digits$}")
    }
}

impl From<OctreeReport> for CellSummary {
    fn from(report: OctreeReport) -> Self {
        let counts = vec![
            ("list_cells", report.list_cells as u64),
            ("single_primitive_cells", report.single_cells as u64),
            ("fallback_cells", report.fallback_cells as u64),
            ("bytes", report.bytes as u64),
            ("tree_bytes", report.tree_bytes as u64),
            ("packet_tests", report.work),
        ];
        Self { text: report.to_string(), counts, resolution: Some(report.resolution) }
    }
}

/// A pointer to a function that builds a part of an index. It is compared by address, so the same function may compare
/// as different.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FnPointer<F>(pub(crate) F);

/// The options of a P2M index.
///
/// The index has no cells, and the tree answers everything, if a budget would be exceeded or if there are more than
/// sixteen Delaunay tetrahedra for each vertex of a packet.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct P2mOptions {
    /// The splits of the tree, which define the packets, and whether all threads are used.
    pub splits: SplitOptions,
    /// The largest number of packets in a list. It is 96 by default, and at most 2048. The tree answers in cells
    /// with more packets.
    pub max_list_packets: usize,
    /// The largest number of added sites for each vertex of a packet, where a vertex of several packets counts several
    /// times. It is 0.5 by default. Sites are added where many primitives are about as near as the nearest vertex: on
    /// long edges, on wide faces, and in the middle of round shapes.
    pub max_extra_sites: f64,
    /// The function that makes the locator, which finds a site near a query. `None` stands for a grid, the default.
    pub(crate) locator: Option<FnPointer<BuildLocator>>,
    /// The function that makes the filter of each long list. There are no filters by default.
    pub(crate) list_filter: Option<FnPointer<BuildListFilter>>,
    /// The number of primitives above which a list gets a filter, if there are filters. It is 64 by default.
    pub filter_above: usize,
    /// The memory budget of the lists, in bytes per primitive, which also limits the packets around all corners while
    /// building. It is 3072 by default. A scene with fewer than 1000 primitives has the budget of 1000.
    pub memory: f64,
    /// The work budget, in tests of a node or a packet at a point per primitive. It is 2,000 by default, which is about
    /// 25 times what meshes need and three times what slivers do. A scene with fewer than 1000 primitives has the
    /// budget of 1000.
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
            work: 2_000.0,
        }
    }
}

impl P2mOptions {
    /// Sets the splits of the tree.
    #[must_use]
    pub fn with_splits(self, splits: SplitOptions) -> Self {
        Self { splits, ..self }
    }
    /// Sets the largest number of packets in a list.
    #[must_use]
    pub fn with_max_list_packets(self, max_list_packets: usize) -> Self {
        Self { max_list_packets, ..self }
    }
    /// Sets the largest number of added sites for each vertex of a packet.
    #[must_use]
    pub fn with_max_extra_sites(self, max_extra_sites: f64) -> Self {
        Self { max_extra_sites, ..self }
    }
    /// Allows lists to be as long as in the paper: no site is added, a list may have 2048 packets, and the budgets of
    /// memory and work are 100,000 bytes and 1,000,000 tests per primitive. Between slivers a build takes up to 40
    /// times as long as by default ([docs/measurements/p2m.md] has figures).
    ///
    /// [docs/measurements/p2m.md]: https://github.com/p2m-rs/p2m/blob/main/docs/measurements/p2m.md
    #[must_use]
    pub fn with_long_lists(self) -> Self {
        let max_list_packets = MAX_BLOCKS * BLOCK_WIDTH;
        self.with_max_extra_sites(0.0).with_max_list_packets(max_list_packets).with_memory(1e5).with_work(1e6)
    }
    /// Returns the options of the paper \[Zong2023\]: [long lists](Self::with_long_lists), the locator
    /// [`KdTreeLocator`](crate::KdTreeLocator), and the filter [`RegionTree`](crate::RegionTree) for each list of more
    /// than 64 primitives.
    #[cfg(feature = "paper")]
    #[must_use]
    pub fn as_in_paper() -> Self {
        let long = Self::default().with_long_lists();
        long.with_locator(crate::KdTreeLocator::build).with_list_filter(crate::RegionTree::build).with_filter_above(64)
    }
    /// Sets the function that makes the locator. Answers do not depend on it. A saved index has a grid instead.
    ///
    /// A query calls the locator through a pointer, and begins its walk at the site that it returns. The grid, which is
    /// the default, is the fastest locator that was measured. With a `KdTreeLocator` a query takes up to three
    /// times as long.
    #[must_use]
    pub fn with_locator(self, build: BuildLocator) -> Self {
        Self { locator: Some(FnPointer(build)), ..self }
    }
    /// Sets the function that makes the filters of long lists. Answers do not depend on it. A saved index has no
    /// filters.
    ///
    /// Without filters, which is the default, a search bounds eight packets of a list at a time and begins with the
    /// nearest. With a `RegionTree` for each long list, a query takes up to ten times as long where lists are long, and
    /// the index takes up to 70 times the memory.
    #[must_use]
    pub fn with_list_filter(self, build: BuildListFilter) -> Self {
        Self { list_filter: Some(FnPointer(build)), ..self }
    }
    /// Sets the number of primitives above which a list gets a filter.
    #[must_use]
    pub fn with_filter_above(self, filter_above: usize) -> Self {
        Self { filter_above, ..self }
    }
    /// Sets the memory budget.
    #[must_use]
    pub fn with_memory(self, memory: f64) -> Self {
        Self { memory, ..self }
    }
    /// Sets the work budget.
    #[must_use]
    pub fn with_work(self, work: f64) -> Self {
        Self { work, ..self }
    }
}

/// The statistics of a P2M index.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct P2mReport {
    /// The number of cells with a list.
    pub list_cells: usize,
    /// The number of lists that have a filter.
    pub filtered: usize,
    /// The number of points of the scene that were added to its vertices as sites.
    pub added: usize,
    /// The number of auxiliary sites, which are beside the scene and in whose cells the tree answers.
    pub auxiliary: usize,
    /// The number of other cells that the tree answers. If they are more than a quarter of all cells, the tree answers
    /// everything and no cells are stored.
    pub fallback_cells: usize,
    /// The number of packets that were examined for lists: those that intersect a ball at a corner of the cell.
    pub candidates: usize,
    /// The largest number of packets that were examined for one list.
    pub max_candidates: usize,
    /// The number of packets in all lists.
    pub entries: usize,
    /// The number of primitives in all lists.
    pub primitives: usize,
    /// The memory of cells and lists in bytes.
    pub bytes: usize,
    /// The memory of the tree over the packets in bytes.
    pub tree_bytes: usize,
}

impl P2mReport {
    /// Returns the numbers in the order in which a file stores them.
    fn numbers(&mut self) -> [&mut usize; 11] {
        [
            &mut self.list_cells,
            &mut self.filtered,
            &mut self.added,
            &mut self.auxiliary,
            &mut self.fallback_cells,
            &mut self.candidates,
            &mut self.max_candidates,
            &mut self.entries,
            &mut self.primitives,
            &mut self.bytes,
            &mut self.tree_bytes,
        ]
    }
}

impl From<P2mReport> for [u64; 11] {
    fn from(mut report: P2mReport) -> Self {
        report.numbers().map(|number| *number as u64)
    }
}

impl From<[u64; 11]> for P2mReport {
    #[allow(clippy::cast_possible_truncation, reason = "numbers to report")]
    fn from(numbers: [u64; 11]) -> Self {
        let mut report = Self::default();
        report.numbers().into_iter().zip(numbers).for_each(|(to, number)| *to = number as usize);
        report
    }
}

impl std::fmt::Display for P2mReport {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self {
            list_cells, filtered, added, auxiliary, fallback_cells, entries, primitives, bytes, tree_bytes, ..
        } = self;
        let mean = |count: &usize| *count as f64 / (*list_cells).max(1) as f64;
        let megabytes = |bytes: &usize| *bytes as f64 / 1e6;
        write!(
            f,
            "{list_cells} cells with lists of {:.1} primitives in {:.1} packets on average, ",
            mean(primitives),
            mean(entries)
        )?;
        if *filtered > 0 {
            write!(f, "{filtered} of them filtered, ")?;
        }
        write!(f, "{fallback_cells} left to the tree; {added} sites added on the scene and {auxiliary} beside it; ")?;
        write!(f, "{:.1} MB of cells, {:.1} MB of tree", megabytes(bytes), megabytes(tree_bytes))
    }
}

impl From<P2mReport> for CellSummary {
    fn from(report: P2mReport) -> Self {
        let counts = vec![
            ("list_cells", report.list_cells as u64),
            ("fallback_cells", report.fallback_cells as u64),
            ("packets", report.entries as u64),
            ("primitives", report.primitives as u64),
            ("bytes", report.bytes as u64),
            ("tree_bytes", report.tree_bytes as u64),
        ];
        Self { text: report.to_string(), counts, resolution: None }
    }
}
