//! A partition into Voronoi cells \[Zong2023\].
//!
//! Sites are the vertices of the scene, and some more (`sites`): in its cell a site is the nearest one, so it is a
//! dominator, and the cell is the hull of the centres of its Delaunay tetrahedra. By the corner test a primitive can be
//! the answer in the cell only if it meets one of their circumscribed balls, so one ball query for each tetrahedron
//! serves four lists: no flooding, no cutting of cells. Six far sites close the cells of the hull.

pub(crate) mod adjacency;
pub(crate) mod any_locator;
pub(crate) mod budget;
pub(crate) mod cell;
pub(crate) mod cell_polytope;
pub(crate) mod cells;
pub(crate) mod circumsphere;
pub(crate) mod compare_distances;
pub(crate) mod corner_values;
pub(crate) mod corners;
pub(crate) mod crowded;
pub(crate) mod feature_relevance;
pub(crate) mod grid_locator;
#[cfg(feature = "kiddo")]
pub(crate) mod kd_tree_locator;
pub(crate) mod list_filter;
pub(crate) mod locator;
pub(crate) mod neighbour_block;
pub(crate) mod neighbours;
pub(crate) mod query;
#[cfg(feature = "rstar")]
pub(crate) mod region_tree;
pub(crate) mod saved;
pub(crate) mod site;
pub(crate) mod sites;

pub use list_filter::{BuildListFilter, ListFilter, Region};
pub use locator::{BuildLocator, Locator, LocatorSites};

use crate::list::block::Block;
use crate::list::search;
use crate::options::{P2mOptions, P2mReport};
use crate::partition::Partition;
use crate::progress::{BuildStage, Progress, Teller};
use crate::voronoi::any_locator::AnyLocator;
use crate::voronoi::budget::{Allowance, Limits};
use crate::voronoi::cell::Cells;
use crate::voronoi::cells::Lists;
use crate::voronoi::grid_locator::Hints;
use crate::voronoi::list_filter::Filters;
use crate::voronoi::neighbours::Fans;
use crate::voronoi::sites::{BOUNDING_DISTANCE, Sites};
use nalgebra::Point3;
use p2m_bvh::PacketTree;
use p2m_core::engine::real::to_f64_array;
use p2m_core::engine::vector::V3;
use p2m_core::storage::Array;
use p2m_core::{Aabb, Isa, PrimitiveId, PrimitiveSet, Real};

/// As many packets as a list can have.
const LONGEST: usize = 2048;
/// Where one of so many cells would be left to the tree, it answers everything.
const MOST_LEFT: usize = 4;
/// The cube of the domain is so many times as wide as the scene.
const REACH: f64 = 10.0;

/// An interception index whose cells are those of the vertices, over a set of primitives that it does not keep.
#[derive(Clone, Debug)]
pub struct Voronoi {
    pub(crate) tree: PacketTree,
    /// Of the places of sites.
    pub(crate) per_unit: f64,
    pub(crate) unit: f64,
    /// By how much a dominator has to be nearer.
    pub(crate) slack: f64,
    pub(crate) low: V3,
    pub(crate) high: V3,
    pub(crate) fans: Fans,
    pub(crate) locator: Option<AnyLocator>,
    pub(crate) blocks: Array<Block>,
    pub(crate) filters: Filters,
    /// Of auxiliary sites points of the scene that are near.
    pub(crate) anchors: Array<V3>,
    pub(crate) report: P2mReport,
}

impl Voronoi {
    /// The blocks of a site that has a list.
    fn blocks_of(&self, site: usize) -> impl Iterator<Item = &Block> {
        let first = &self.blocks[site];
        let rest = &self.blocks[self.fans.sites[site].list as usize..][..usize::from(first.more)];
        std::iter::once(first).chain(rest)
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
    fn make_cells(&mut self, options: &P2mOptions, teller: &Teller<'_>) {
        let tree = &self.tree;
        let bounds = vertex_bounds(tree);
        let half = (bounds.max - bounds.min).max() * 0.5;
        // No extent, or one that f32 cannot tell apart; not for NaN either, which comes of no vertices.
        if !tree.frame.is_plain() || half.is_nan() || half <= 0.0 {
            return;
        }
        let centre = to_f64_array(&nalgebra::center(&bounds.min, &bounds.max));
        let domain = half * REACH;
        let (low, high) = (centre.map(|x| x - domain), centre.map(|x| x + domain));
        let own = padded(&bounds);
        // In the plane of a flat scene, far out, f64 has no room beside it.
        if (0..3).any(|k| own[0][k] >= own[1][k] || low[k] >= high[k]) {
            return;
        }
        let whole = tree.bounds();
        let size = (whole.max - whole.min).max();
        let far = half.max(size) * BOUNDING_DISTANCE + centre.iter().fold(0.0f64, |a, x| a.max(x.abs()));
        // Rounding of keys, of corners and of added points: all below 2^-44 of this.
        let slack = far / (1u64 << 40) as f64;
        let most = options.max_list_packets.min(LONGEST);
        let parallel = options.splits.parallel;
        let added = (tree.leaves.vertices.len() as f64 * options.max_extra_sites) as usize;
        let allowance = &Allowance::new(options.memory, options.work, tree.packets().1);
        let limits = Limits { parallel, slack, most, added, allowance };
        let Some(sites) = Sites::new(tree, &bounds, limits, teller) else {
            self.report.trees = tree.leaves.vertices.len();
            return;
        };
        // To find one's cell in vain costs more than the few lists save.
        let left = sites.left_to_the_tree();
        if left * MOST_LEFT > sites.delaunay.sites().len() {
            self.report.trees = left;
            return;
        }
        let cells = Cells {
            tree,
            sites: &sites,
            limits,
            filter: options.list_filter.map(|build| (options.filter_above, build.0)),
        };
        let mut report = self.report;
        let Some(Lists { fans, mut blocks, filters }) = cells.lists(&mut report, teller) else {
            self.report.trees = sites.delaunay.sites().len();
            return;
        };
        self.report = report;
        self.slack = slack;
        let Sites { delaunay, anchors, .. } = sites;
        (self.unit, self.per_unit) = (delaunay.unit(), delaunay.unit().recip());
        self.anchors = anchors.into_iter().map(|(_, anchor)| anchor).collect::<Vec<_>>().into();
        drop(delaunay);
        (self.low, self.high) = (low, high);
        (self.fans, self.filters) = (fans, filters);
        teller.begin(BuildStage::Locator);
        let sites = self.locator_sites();
        let locator = match options.locator {
            Some(build) => AnyLocator::Other(build.0(&sites)),
            None => AnyLocator::Grid(Hints::new(&sites)),
        };
        self.locator = Some(locator);
        self.report.filtered = self.filters.count();
        blocks.shrink_to_fit();
        self.blocks = blocks.into();
        self.report.bytes = self.memory() - self.tree.memory();
    }
}

impl Voronoi {
    /// The sites and the boxes that a locator is made from.
    pub(crate) fn locator_sites(&self) -> LocatorSites<'_> {
        let scaled = |p: V3| p.map(|x| x * self.per_unit);
        let own = padded(&vertex_bounds(&self.tree)).map(scaled);
        LocatorSites { fans: &self.fans, isa: self.tree.isa(), own, domain: [self.low, self.high].map(scaled) }
    }
}

/// The box around the vertices of a tree. Primitives of one's own have none, so they may lie outside.
fn vertex_bounds(tree: &PacketTree) -> Aabb<f64> {
    let vertices = tree.leaves.vertices.iter().map(|v| Point3::from(*v));
    vertices.fold(Aabb::empty(), |all, v| all.union(&Aabb { min: v, max: v }))
}

/// A box, larger on all sides by an eighth of its longest side.
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
        let teller = Teller::new(progress, BuildStage::Tree);
        let tree = PacketTree::build(set, &options.splits);
        let report = P2mReport { tree_bytes: tree.memory(), ..P2mReport::default() };
        let mut index = Self {
            tree,
            per_unit: 0.0,
            unit: 0.0,
            slack: 0.0,
            low: [0.0; 3],
            high: [0.0; 3],
            fans: Fans::default(),
            locator: None,
            blocks: Array::default(),
            filters: Filters::default(),
            anchors: Array::default(),
            report,
        };
        index.make_cells(options, &teller);
        teller.reach([0.0, 100.0], 1, 1);
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
            ("sites", self.fans.memory() + self.anchors.memory()),
            ("locator", self.locator.as_ref().map_or(0, AnyLocator::memory)),
            ("lists", self.blocks.memory()),
            ("filters", self.filters.memory()),
            ("tree", self.tree.memory()),
        ]
    }

    fn list(&self, point: &Point3<f64>) -> Option<Vec<PrimitiveId>> {
        let site = self.site_of(point).filter(|site| self.fans.sites[*site].has_list())?;
        Some(search::primitives(&self.tree, self.blocks_of(site)))
    }

    fn list_lengths(&self) -> Vec<usize> {
        let sites = (0..self.fans.sites.len()).filter(|site| self.fans.sites[*site].has_list());
        sites.map(|site| self.blocks_of(site).map(Block::count).sum()).collect()
    }

    fn with_isa(self, isa: Isa) -> Self {
        Self { tree: self.tree.with_isa(isa), ..self }
    }
}
