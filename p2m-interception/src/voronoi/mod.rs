//! The partition of space into Voronoi cells \[Zong2023\].
//!
//! The project has its name from this method, and most of this crate is about it: some 30 files and, with
//! [`delaunay`](crate::delaunay), more than 7,000 lines, where the octree takes 2,800. The octree, the lists and the
//! trees do not use it, so whoever works on them need not read it.
//!
//! The sites are the vertices of the scene and some added points ([`sites`]). In its cell a site is nearer than all
//! other sites. A site that is a point of the scene dominates its own cell. The tree answers in the cells of the other,
//! auxiliary sites. A cell is the convex hull of the circumcentres of its Delaunay tetrahedra.
//! By the corner test, a primitive can be the answer in the cell only if it intersects one of the circumscribed balls.
//! So the packets of each ball, which a [`flood`] finds, serve the lists of four cells. (The paper grows each list by
//! flooding over cells, and clips the cells.) Six artificial sites far outside make all cells bounded.
//!
//! The modules from sites to lists are [`corner`], [`corners`], [`flood`], [`crowded`], [`packet_cells`],
//! [`cell_packets`] and [`cells`]. A query is located by a [`locator`], walks over the [`neighbours`] of sites, and
//! searches a list ([`query`]). [docs/proofs/p2m.md] has the proofs.
//!
//! [docs/proofs/p2m.md]: https://github.com/p2m-rs/p2m/blob/main/docs/proofs/p2m.md

pub(crate) mod adjacency;
pub(crate) mod any_locator;
pub(crate) mod budget;
pub(crate) mod cell;
pub(crate) mod cell_packets;
pub(crate) mod cell_polytope;
pub(crate) mod cells;
pub(crate) mod circumsphere;
pub(crate) mod compare_distances;
pub(crate) mod corner;
pub(crate) mod corner_values;
pub(crate) mod corners;
pub(crate) mod crowded;
pub(crate) mod excluded_features;
pub(crate) mod feature_relevance;
pub(crate) mod flood;
pub(crate) mod grid_locator;
#[cfg(feature = "paper")]
pub(crate) mod kd_tree_locator;
pub(crate) mod list_filter;
pub(crate) mod local_numbers;
pub(crate) mod locator;
pub(crate) mod neighbour_block;
pub(crate) mod neighbours;
pub(crate) mod packet_cells;
pub(crate) mod primitive_frame;
pub(crate) mod query;
#[cfg(feature = "paper")]
pub(crate) mod region_tree;
pub(crate) mod saved;
pub(crate) mod site;
pub(crate) mod sites;
mod validate;

pub use list_filter::{BuildListFilter, ListFilter, Region};
pub use locator::{BuildLocator, Locator, LocatorSites};

use crate::list::block::{BLOCK_WIDTH, Block, MAX_BLOCKS};
use crate::list::search;
use crate::options::{P2mOptions, P2mReport};
use crate::partition::Partition;
use crate::progress::{BuildStage, Progress, ProgressReporter};
use crate::voronoi::any_locator::AnyLocator;
use crate::voronoi::budget::{BuildBudget, Limits};
use crate::voronoi::cell::CellContext;
use crate::voronoi::cells::VoronoiLists;
use crate::voronoi::grid_locator::GridLocator;
use crate::voronoi::list_filter::ListFilters;
use crate::voronoi::neighbours::NeighbourTable;
use crate::voronoi::sites::{BOUNDING_DISTANCE, Sites};
use nalgebra::Point3;
use p2m_bvh::PacketTree;
use p2m_core::engine::real::to_f64_array;
use p2m_core::engine::vector::V3;
use p2m_core::storage::Array;
use p2m_core::{Aabb, Isa, PrimitiveId, PrimitiveSet, Real};

/// If more than one cell in this many would be left to the tree, no cells are stored and the tree answers everything.
const FALLBACK_CELLS_DIVISOR: usize = 4;
/// The width of the cube of the domain, in widths of the scene.
const DOMAIN_SCENE_SIZES: f64 = 10.0;

/// An interception index whose cells are the Voronoi cells of the vertices, over a set of primitives that it
/// does not store.
///
/// [`P2mIndex`](crate::P2mIndex) combines it with its set.
#[derive(Clone, Debug)]
pub struct Voronoi {
    /// The tree over the packets. It answers outside of the domain and in cells without a list.
    pub(crate) tree: PacketTree,
    /// The reciprocal of `unit`.
    pub(crate) per_unit: f64,
    /// The unit in which the positions of sites are stored, a power of two.
    pub(crate) unit: f64,
    /// The slack of the corner test: a dominator has to be nearer by this much.
    pub(crate) slack: f64,
    /// The low corner of the domain.
    pub(crate) low: V3,
    /// The high corner of the domain.
    pub(crate) high: V3,
    /// The sites and their neighbours.
    pub(crate) neighbours: NeighbourTable,
    /// The locator. It is `None` if there are no cells.
    pub(crate) locator: Option<AnyLocator>,
    /// The blocks of the lists. The first block of a list has the number of its site.
    pub(crate) blocks: Array<Block>,
    /// The filters of long lists.
    pub(crate) filters: ListFilters,
    /// For each auxiliary site a point of the scene near it.
    pub(crate) anchors: Array<V3>,
    /// The statistics of the build.
    pub(crate) report: P2mReport,
}

impl Voronoi {
    /// Returns the blocks of a site that has a list.
    fn blocks_of(&self, site: usize) -> impl Iterator<Item = &Block> {
        let first = &self.blocks[site];
        let rest = &self.blocks[self.neighbours.sites[site].list as usize..][..usize::from(first.following)];
        std::iter::once(first).chain(rest)
    }

    /// Builds the cells, unless the scene or a budget does not allow it.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
    fn build_cells(&mut self, options: &P2mOptions, reporter: &ProgressReporter<'_>) {
        let tree = &self.tree;
        let bounds = vertex_bounds(tree);
        let half_width = (bounds.max - bounds.min).max() * 0.5;
        // The tree answers a scene without extent, or one that f32 cannot resolve. `half_width` is NaN if there are no
        // vertices.
        if !tree.frame.is_plain() || half_width.is_nan() || half_width <= 0.0 {
            return;
        }
        let centre = to_f64_array(&nalgebra::center(&bounds.min, &bounds.max));
        let domain = half_width * DOMAIN_SCENE_SIZES;
        let (low, high) = (centre.map(|x| x - domain), centre.map(|x| x + domain));
        let scene_box = padded(&bounds);
        // A flat scene may be so far from the origin that f64 has no numbers on both sides of its plane.
        if (0..3).any(|k| scene_box[0][k] >= scene_box[1][k] || low[k] >= high[k]) {
            return;
        }
        let tree_bounds = tree.bounds();
        let size = (tree_bounds.max - tree_bounds.min).max();
        let far = half_width.max(size) * BOUNDING_DISTANCE + centre.iter().fold(0.0f64, |a, x| a.max(x.abs()));
        // The rounding of keys, of corners and of added points is below 2^-44 of `far`.
        let slack = far / (1u64 << 40) as f64;
        let max_list_packets = options.max_list_packets.min(MAX_BLOCKS * BLOCK_WIDTH);
        let parallel = options.splits.parallel;
        let max_added_sites = (tree.leaves.vertices.len() as f64 * options.max_extra_sites) as usize;
        let budget = &BuildBudget::new(options.memory, options.work, tree.packets().1);
        let limits = Limits { parallel, slack, max_list_packets, max_added_sites, budget };
        let Some(mut sites) = Sites::new(tree, &bounds, limits, reporter) else {
            self.report.fallback_cells = tree.leaves.vertices.len();
            return;
        };
        // Locating a cell that turns out to have no list costs a query more than a few lists save.
        let fallback_count = sites.count_fallback_cells();
        if fallback_count * FALLBACK_CELLS_DIVISOR > sites.delaunay.sites().len() {
            self.report.fallback_cells = fallback_count;
            return;
        }
        let corners_of_packets = sites.corners.take_corners_of_packets(tree.leaves.packets.len());
        let cells = CellContext {
            tree,
            sites: &sites,
            limits,
            filter: options.list_filter.map(|build| (options.filter_above, build.0)),
        };
        let (unit, per_unit) = (sites.delaunay.unit(), sites.delaunay.unit().recip());
        let build_locator = |neighbours: &NeighbourTable| {
            let sites = LocatorSites::new(tree, neighbours, per_unit, [low, high]);
            match options.locator {
                Some(build) => AnyLocator::Other(build.0(&sites)),
                None => AnyLocator::Grid(GridLocator::new(&sites)),
            }
        };
        let mut report = self.report;
        let Some(VoronoiLists { neighbours, locator, mut blocks, filters }) =
            cells.build_lists(corners_of_packets, build_locator, &mut report, reporter)
        else {
            self.report.fallback_cells = sites.delaunay.sites().len();
            return;
        };
        self.report = report;
        self.slack = slack;
        (self.unit, self.per_unit) = (unit, per_unit);
        self.anchors = sites.anchors.iter().map(|(_, anchor)| *anchor).collect::<Vec<_>>().into();
        drop(sites);
        (self.low, self.high) = (low, high);
        (self.neighbours, self.filters) = (neighbours, filters);
        reporter.begin_stage(BuildStage::Locator);
        self.locator = Some(locator.unwrap_or_else(|| build_locator(&self.neighbours)));
        self.report.filtered = self.filters.count();
        blocks.shrink_to_fit();
        self.blocks = blocks.into();
        self.report.bytes = self.memory() - self.tree.memory();
    }
}

impl<'a> LocatorSites<'a> {
    /// Makes the sites of a table over a tree, in a domain. `per_unit` is the reciprocal of the unit of the sites.
    pub(crate) fn new(tree: &PacketTree, neighbours: &'a NeighbourTable, per_unit: f64, domain: [V3; 2]) -> Self {
        let scaled = |p: V3| p.map(|x| x * per_unit);
        let scene_box = padded(&vertex_bounds(tree)).map(scaled);
        Self { neighbours, isa: tree.isa(), scene_box, domain_box: domain.map(scaled) }
    }
}

/// Returns the box around the vertices of a tree. Primitives of unknown kinds have no vertices, so they
/// may lie outside.
fn vertex_bounds(tree: &PacketTree) -> Aabb<f64> {
    let vertices = tree.leaves.vertices.iter().map(|v| Point3::from(*v));
    vertices.fold(Aabb::empty(), |all, v| all.union(&Aabb { min: v, max: v }))
}

/// Returns the corners of a box that is enlarged on all sides by an eighth of its longest side.
fn padded(bounds: &Aabb<f64>) -> [V3; 2] {
    let pad = (bounds.max - bounds.min).max() * 0.125;
    [to_f64_array(&bounds.min).map(|x| x - pad), to_f64_array(&bounds.max).map(|x| x + pad)]
}

impl Partition for Voronoi {
    type Options = P2mOptions;
    type Report = P2mReport;

    fn build<T: Real, S: PrimitiveSet<T> + Sync + ?Sized>(
        set: &S,
        options: &P2mOptions,
        progress: &(dyn Fn(Progress) + Sync),
    ) -> Self {
        let reporter = ProgressReporter::new(progress, BuildStage::Tree);
        let tree = PacketTree::build(set, &options.splits);
        let report = P2mReport { tree_bytes: tree.memory(), ..P2mReport::default() };
        let mut index = Self {
            tree,
            per_unit: 0.0,
            unit: 0.0,
            slack: 0.0,
            low: [0.0; 3],
            high: [0.0; 3],
            neighbours: NeighbourTable::default(),
            locator: None,
            blocks: Array::default(),
            filters: ListFilters::default(),
            anchors: Array::default(),
            report,
        };
        index.build_cells(options, &reporter);
        reporter.advance([0.0, 100.0], 1, 1);
        index
    }

    fn tree(&self) -> &PacketTree {
        &self.tree
    }

    fn report(&self) -> P2mReport {
        self.report
    }

    fn parts(&self) -> Vec<(&'static str, usize)> {
        vec![
            ("sites", self.neighbours.memory() + self.anchors.memory()),
            ("locator", self.locator.as_ref().map_or(0, AnyLocator::memory)),
            ("lists", self.blocks.memory()),
            ("filters", self.filters.memory()),
            ("tree", self.tree.memory()),
        ]
    }

    fn list(&self, point: &Point3<f64>) -> Option<Vec<PrimitiveId>> {
        let site = self.locate_site(point).filter(|site| self.neighbours.sites[*site].has_list())?;
        Some(search::list_primitives(&self.tree, self.blocks_of(site)))
    }

    fn list_lengths(&self) -> Vec<usize> {
        let sites = (0..self.neighbours.sites.len()).filter(|site| self.neighbours.sites[*site].has_list());
        sites.map(|site| self.blocks_of(site).map(Block::primitive_count).sum()).collect()
    }

    fn with_isa(self, isa: Isa) -> Self {
        Self { tree: self.tree.with_isa(isa), ..self }
    }
}
