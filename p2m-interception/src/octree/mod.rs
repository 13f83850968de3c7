//! The partition of the domain into cubes: an octree whose leaves have interception lists.
//!
//! A query locates its leaf by the bits of its coordinates ([`query`]). The build starts from the tree over the
//! packets, refines a cube ([`domain`]) in [`passes`] and encodes the result ([`code`]). [`refinement`] refines one
//! cell, and [`split_rule`] says whether it is worth it. [docs/proofs/octree.md] has the proofs.
//!
//! [docs/proofs/octree.md]: https://github.com/p2m-rs/p2m/blob/main/docs/proofs/octree.md

pub(crate) mod budget;
pub(crate) mod candidate;
pub(crate) mod cell;
pub(crate) mod cell_list;
pub(crate) mod code;
pub(crate) mod cube;
pub(crate) mod domain;
pub(crate) mod lattice;
pub(crate) mod passes;
pub(crate) mod query;
pub(crate) mod refinement;
pub(crate) mod saved;
pub(crate) mod scene_tree;
pub(crate) mod split_rule;
pub(crate) mod task;
mod validate;

use crate::list::block::{Block, MAX_LEVEL};
use crate::list::search;
use crate::octree::budget::{FinishedPart, MIN_PRIMITIVES_FOR_BUDGETS, Spent};
use crate::octree::code::{CellCode, CodeWriter, FALLBACK_CODE, Row};
use crate::octree::domain::DomainCube;
use crate::octree::passes::Passes;
use crate::octree::refinement::Refinement;
use crate::octree::scene_tree::{SceneTree, TreeProbe};
use crate::octree::split_rule::ExpectedQueries;
use crate::options::{OctreeOptions, OctreeReport, RefinementProgress};
use crate::partition::Partition;
use crate::progress::{BuildStage, Progress};
use nalgebra::Point3;
use p2m_bvh::PacketTree;
use p2m_core::engine::real::{from_f64_array, to_f64_array};
use p2m_core::engine::vector::V3;
use p2m_core::storage::Array;
use p2m_core::{Best, Isa, PrimitiveId, PrimitiveSet, QueryOptions, Real};
use rustc_hash::{FxBuildHasher, FxHashMap};
use std::ops::ControlFlow;

/// The resolution above which cells do not become finer any more.
const MAX_RESOLUTION: f64 = 1e9;
/// The resolution below which there are no cells.
const MIN_RESOLUTION: f64 = 1e-9;

/// An interception index whose cells are cubes, over a set of primitives that it does not store.
///
/// Searches ask the set only to evaluate primitives of unknown kinds. [`OctreeIndex`](crate::OctreeIndex) combines an
/// octree with its set.
#[derive(Clone, Debug)]
pub struct Octree {
    /// The tree over the packets. It answers outside of the domain and in cells without a list.
    tree: PacketTree,
    /// The low corner of the cube of the domain.
    low: V3,
    /// The number of cells of [`MAX_LEVEL`] in a unit of length.
    cells_per_length: f64,
    /// The code of the cube of the domain.
    root: u32,
    /// The codes of the cubes below it.
    rows: Array<Row>,
    /// The blocks of all lists.
    blocks: Array<Block>,
    /// The statistics of the build.
    report: OctreeReport,
}

impl Octree {
    /// Refines the cube of the domain. If even the coarsest cells exceed a budget, the octree stays empty.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates; NaN is no budget")]
    fn refine_within_budgets<T: Real, S: PrimitiveSet<T> + Sync + ?Sized>(
        &mut self,
        set: &S,
        options: &OctreeOptions,
        cube: &DomainCube,
        progress: &(dyn Fn(Progress) + Sync),
        visit: &mut dyn FnMut(&RefinementProgress) -> ControlFlow<()>,
    ) {
        let tree = &self.tree;
        let lowest_owners = lowest_owners(tree);
        let search = |x: V3| {
            // The query is rounded to the scalar of the set, which is harmless: any point of the scene can be a
            // dominator.
            let mut best = Best::<T>::new(&QueryOptions::default());
            tree.search_nearest(set, &from_f64_array(x), &mut best);
            let [nodes, packets, primitives] = best.counts();
            TreeProbe { nearest: best.nearest_point().unwrap_or([f64::INFINITY; 3]), nodes, packets, primitives }
        };
        let count = tree.packets().1.max(MIN_PRIMITIVES_FOR_BUDGETS) as f64;
        let [bytes, tests] = [options.memory, options.work].map(|budget| (budget * count) as i64);
        let budgets = Spent { bytes: bytes.max(0), tests: tests.max(0) };
        // The comparison is false if the resolution is NaN.
        let last_resolution = if options.resolution > 0.0 { options.resolution.min(MAX_RESOLUTION) } else { 0.0 };
        if last_resolution < MIN_RESOLUTION {
            return;
        }
        let refinement = Refinement {
            scene: SceneTree { tree, lowest_owners: &lowest_owners, search: &search, slack: cube.slack },
            queries: ExpectedQueries::new(options.domain, cube, tree.packets().0),
            domain: options.domain,
            last_resolution,
            parallel: options.splits.parallel,
            budgets,
            finished: FinishedPart::new(progress),
        };
        let Some(Passes { refined, spent, resolution, .. }) = Passes::run(&refinement, cube.low, cube.side, visit)
        else {
            return;
        };
        self.report.work = u64::try_from(spent.tests).unwrap_or(0);
        self.report.resolution = resolution;
        self.low = cube.low;
        self.cells_per_length = 2f64.powi(i32::from(MAX_LEVEL)) / cube.side;
        let block_count = refined.blocks.iter().map(Vec::len).sum();
        let mut codes = CodeWriter {
            refined: &refined,
            rows: Vec::new(),
            blocks: Vec::with_capacity(block_count),
            report: &mut self.report,
        };
        self.root = codes.encode(0, 0);
        codes.rows.shrink_to_fit();
        debug_assert_eq!(codes.blocks.len(), block_count, "each list has a cell");
        (self.rows, self.blocks) = (codes.rows.into(), codes.blocks.into());
        self.report.bytes = self.memory() - self.tree.memory();
    }

    /// Builds the octree over a set whose bounding boxes are finite, until `visit` ends its refinement
    /// ([`OctreeIndex::build_until`](crate::OctreeIndex::build_until)).
    pub(crate) fn build_until<T: Real, S: PrimitiveSet<T> + Sync + ?Sized>(
        set: &S,
        options: &OctreeOptions,
        progress: &(dyn Fn(Progress) + Sync),
        visit: &mut dyn FnMut(&RefinementProgress) -> ControlFlow<()>,
    ) -> Self {
        progress(Progress { stage: BuildStage::Tree, part: 0.0 });
        let tree = PacketTree::build(set, &options.splits);
        Self::build_on(tree, set, options, progress, visit)
    }

    /// Builds the octree on the tree of its set.
    pub(crate) fn build_on<T: Real, S: PrimitiveSet<T> + Sync + ?Sized>(
        tree: PacketTree,
        set: &S,
        options: &OctreeOptions,
        progress: &(dyn Fn(Progress) + Sync),
        visit: &mut dyn FnMut(&RefinementProgress) -> ControlFlow<()>,
    ) -> Self {
        progress(Progress { stage: BuildStage::Octree, part: 0.0 });
        let tree_bytes = tree.memory();
        let mut octree = Self {
            tree,
            low: [0.0; 3],
            cells_per_length: 0.0,
            root: FALLBACK_CODE,
            rows: Array::default(),
            blocks: Array::default(),
            report: OctreeReport { tree_bytes, ..OctreeReport::default() },
        };
        if let Some(cube) = DomainCube::from_tree(&octree.tree, options) {
            octree.refine_within_budgets(set, options, &cube, progress, visit);
        }
        progress(Progress { stage: BuildStage::Octree, part: 1.0 });
        octree
    }
}

impl Partition for Octree {
    type Options = OctreeOptions;
    type Report = OctreeReport;

    fn build<T: Real, S: PrimitiveSet<T> + Sync + ?Sized>(
        set: &S,
        options: &OctreeOptions,
        progress: &(dyn Fn(Progress) + Sync),
    ) -> Self {
        Self::build_until(set, options, progress, &mut |_| ControlFlow::Continue(()))
    }

    fn tree(&self) -> &PacketTree {
        &self.tree
    }

    fn report(&self) -> OctreeReport {
        self.report
    }

    fn parts(&self) -> Vec<(&'static str, usize)> {
        vec![("cells", self.rows.memory()), ("lists", self.blocks.memory()), ("tree", self.tree.memory())]
    }

    fn list(&self, point: &Point3<f64>) -> Option<Vec<PrimitiveId>> {
        let code = self.locate_cell(&to_f64_array(point)).0;
        match CellCode::decode(code) {
            CellCode::Single(packet, lane) => Some(vec![self.tree.leaves.packets[packet].ids()[lane]]),
            CellCode::List(number) => {
                let blocks = &self.blocks[number..=number + usize::from(self.blocks[number].following)];
                Some(search::list_primitives(&self.tree, blocks.iter()))
            }
            CellCode::Rows | CellCode::Tree => None,
        }
    }

    fn list_lengths(&self) -> Vec<usize> {
        let mut lengths = vec![1; self.report.single_cells];
        // The lists lie one after the other in the array.
        let mut rest = &self.blocks[..];
        while let Some(first) = rest.first() {
            let (list, others) = rest.split_at(usize::from(first.following) + 1);
            lengths.push(list.iter().map(Block::primitive_count).sum());
            rest = others;
        }
        lengths
    }

    fn with_isa(self, isa: Isa) -> Self {
        Self { tree: self.tree.with_isa(isa), ..self }
    }
}

/// Returns for each vertex of a tree the primitive with the lowest id that has this vertex, bit for bit.
fn lowest_owners(tree: &PacketTree) -> Vec<PrimitiveId> {
    let leaves = &tree.leaves;
    let mut owners = vec![PrimitiveId::new(PrimitiveId::MAX_COUNT - 1); leaves.vertices.len()];
    for packet in leaves.packets.iter().filter(|p| p.has_vertices()) {
        for (lane, id) in packet.ids().iter().enumerate() {
            let (corners, count) = packet.vertices_of(lane);
            for &v in &corners[..count] {
                owners[v] = owners[v].min(*id);
            }
        }
    }
    // Packets do not share vertices, so the tree may have several copies of a vertex of the scene.
    let key = |v: &V3| v.map(f64::to_bits);
    let mut lowest: FxHashMap<[u64; 3], PrimitiveId> = FxHashMap::with_capacity_and_hasher(owners.len(), FxBuildHasher);
    for (v, owner) in leaves.vertices.iter().zip(&owners) {
        lowest.entry(key(v)).and_modify(|o| *o = (*o).min(*owner)).or_insert(*owner);
    }
    leaves.vertices.iter().map(|v| lowest[&key(v)]).collect()
}
