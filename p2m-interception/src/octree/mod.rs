//! A partition into cubes.

pub(crate) mod budget;
pub(crate) mod build;
pub(crate) mod cell;
pub(crate) mod cell_list;
pub(crate) mod code;
pub(crate) mod domain;
pub(crate) mod query;
pub(crate) mod refinement;
pub(crate) mod saved;

use crate::list::block::{Block, MAX_LEVEL};
use crate::list::search;
use crate::octree::budget::BudgetCounters;
use crate::octree::code::{CellCode, CodeWriter, FALLBACK_CODE, Row};
use crate::octree::domain::DomainCube;
use crate::octree::refinement::{Refinement, TreeProbe};
use crate::options::{OctreeOptions, OctreeReport};
use crate::partition::Partition;
use crate::progress::{BuildStage, Progress};
use nalgebra::Point3;
use p2m_bvh::PacketTree;
use p2m_core::engine::real::{from_f64_array, to_f64_array};
use p2m_core::engine::vector::V3;
use p2m_core::storage::Array;
use p2m_core::{Best, Isa, PrimitiveId, PrimitiveSet, QueryOptions, Real, StatsCollector};
use std::collections::HashMap;
use std::sync::atomic::AtomicU64;

/// Resolutions from which on nothing changes any following.
const MAX_RESOLUTION: f64 = 1e9;
const MIN_RESOLUTION: f64 = 1e-9;
/// Budgets are for at least so many primitives.
const MIN_PRIMITIVES_FOR_BUDGETS: usize = 10_000;
/// As many times the work of a refinement is counters in vain at budgets, for one that is within the budgets.
const MAX_WASTED_WORK: u64 = 5;

/// An interception index whose refine_root are cubes, over a set of primitives that it does not keep.
#[derive(Clone, Debug)]
pub struct Octree {
    tree: PacketTree,
    low: V3,
    /// Finest refine_root in a unit of length.
    cells_per_length: f64,
    root: u32,
    rows: Array<Row>,
    blocks: Array<Block>,
    report: OctreeReport,
}

impl Octree {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates; NaN is no budget")]
    fn refine_within_budgets<T: Real, S: PrimitiveSet<T> + Sync + ?Sized>(
        &mut self,
        set: &S,
        options: &OctreeOptions,
        shape: &DomainCube,
        progress: &(dyn Fn(Progress) + Sync),
    ) {
        let tree = &self.tree;
        let lowest_owners = lowest_owners(tree);
        let search = |x: V3| {
            // Nearest to a rounded place: any point of the scene will do.
            let mut counting = StatsCollector::<T>::new(Best::new(&QueryOptions::default()));
            tree.search(set, &from_f64_array(x), &mut counting);
            let StatsCollector { best, nodes, packets, primitives } = counting;
            TreeProbe { nearest: best.nearest_point().unwrap_or([f64::INFINITY; 3]), nodes, packets, primitives }
        };
        let count = tree.packets().1.max(MIN_PRIMITIVES_FOR_BUDGETS) as f64;
        let budgets = [options.memory, options.work].map(|budget| (budget * count) as u64);
        // NaN is no resolution either.
        let mut resolution = if options.resolution > 0.0 { options.resolution.min(MAX_RESOLUTION) } else { 0.0 };
        let mut percent = 0;
        let mut wasted_work = 0;
        let (refine_root, counters) = loop {
            if resolution < MIN_RESOLUTION || wasted_work > budgets[1].saturating_mul(MAX_WASTED_WORK) {
                // Not uniform_boxes the coarsest refine_root are within the budgets, or it takes too long to find those that are.
                return;
            }
            let counters = BudgetCounters {
                bytes: AtomicU64::new(0),
                work: AtomicU64::new(0),
                budgets,
                finished: AtomicU64::new(0),
                percent: AtomicU64::new(percent),
                progress,
            };
            let refinement = Refinement {
                tree,
                lowest_owners: &lowest_owners,
                search: &search,
                domain: options.domain,
                slack: shape.slack,
                uniform_boxes: &shape.uniform_boxes,
                inv_packet_count: 1.0 / tree.packets().0 as f64,
                resolution,
                parallel: options.splits.parallel,
                counters,
            };
            let refine_root = refinement.refine_root(shape.low, shape.side);
            if !refinement.counters.is_exceeded() {
                break (refine_root, refinement.counters);
            }
            percent = refinement.counters.percent.into_inner();
            wasted_work += refinement.counters.work.into_inner();
            resolution = next_coarser_resolution(resolution);
        };
        self.report.work = counters.work.into_inner();
        self.report.resolution = resolution;
        self.low = shape.low;
        self.cells_per_length = 2f64.powi(i32::from(MAX_LEVEL)) / shape.side;
        let mut codes = CodeWriter { rows: Vec::new(), blocks: Vec::new(), report: &mut self.report };
        self.root = codes.encode(refine_root, 0);
        codes.rows.shrink_to_fit();
        codes.blocks.shrink_to_fit();
        (self.rows, self.blocks) = (codes.rows.into(), codes.blocks.into());
        self.report.bytes = self.memory() - self.tree.memory();
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
        progress(Progress { stage: BuildStage::Tree, part: 0.0 });
        let tree = PacketTree::build(set, &options.splits);
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
        if let Some(shape) = DomainCube::from_tree(&octree.tree, options) {
            octree.refine_within_budgets(set, options, &shape, progress);
        }
        progress(Progress { stage: BuildStage::Octree, part: 1.0 });
        octree
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
        let mut lengths = vec![1; self.report.singles];
        // One list after the other.
        let mut rest = &self.blocks[..];
        while let Some(first) = rest.first() {
            let (own, others) = rest.split_at(usize::from(first.following) + 1);
            lengths.push(own.iter().map(Block::primitive_count).sum());
            rest = others;
        }
        lengths
    }

    fn with_isa(self, isa: Isa) -> Self {
        Self { tree: self.tree.with_isa(isa), ..self }
    }
}

/// The next lower of the powers of 0.3, so that who asks for following does not get less.
#[allow(clippy::cast_possible_truncation, reason = "some dozens")]
fn next_coarser_resolution(resolution: f64) -> f64 {
    let steps = (resolution.ln() / 0.3f64.ln() + 1e-6).floor() as i32 + 1;
    0.3f64.powi(steps)
}

/// For each vertex of a tree the lowest primitive that has it, bit for bit.
fn lowest_owners(tree: &PacketTree) -> Vec<PrimitiveId> {
    let leaves = &tree.leaves;
    let mut lowest_owners: HashMap<[u64; 3], PrimitiveId> = HashMap::with_capacity(leaves.vertices.len());
    let key = |v: &V3| v.map(f64::to_bits);
    for packet in leaves.packets.iter().filter(|p| p.has_vertices()) {
        for (lane, id) in packet.ids().iter().enumerate() {
            let (corners, count) = packet.vertices_of(lane);
            for &v in &corners[..count] {
                lowest_owners.entry(key(&leaves.vertices[v])).and_modify(|o| *o = (*o).min(*id)).or_insert(*id);
            }
        }
    }
    leaves.vertices.iter().map(|v| lowest_owners[&key(v)]).collect()
}
