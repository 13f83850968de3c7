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

use crate::list::block::{Block, DEEPEST};
use crate::list::search;
use crate::octree::budget::Done;
use crate::octree::code::{CellCode, Codes, Row, TREE};
use crate::octree::domain::Shape;
use crate::octree::refinement::{Refinement, Searched};
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

/// Resolutions from which on nothing changes any more.
const FINEST: f64 = 1e9;
const COARSEST: f64 = 1e-9;
/// Budgets are for at least so many primitives.
const FEW: usize = 10_000;
/// As many times the work of a refinement is done in vain at most, for one that is within the budgets.
const IN_VAIN: u64 = 5;

/// An interception index whose cells are cubes, over a set of primitives that it does not keep.
#[derive(Clone, Debug)]
pub struct Octree {
    tree: PacketTree,
    low: V3,
    /// Finest cells in a unit of length.
    per_length: f64,
    root: u32,
    rows: Array<Row>,
    blocks: Array<Block>,
    report: OctreeReport,
}

impl Octree {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates; NaN is no budget")]
    fn refine<T: Real, S: PrimitiveSet<T> + Sync + ?Sized>(
        &mut self,
        set: &S,
        options: &OctreeOptions,
        shape: &Shape,
        progress: &(dyn Fn(Progress) + Sync),
    ) {
        let tree = &self.tree;
        let owners = owners(tree);
        let search = |x: V3| {
            // Nearest to a rounded place: any point of the scene will do.
            let mut counting = StatsCollector::<T>::new(Best::new(&QueryOptions::default()));
            tree.search(set, &from_f64_array(x), &mut counting);
            let StatsCollector { best, nodes, packets, primitives } = counting;
            Searched { nearest: best.nearest_point().unwrap_or([f64::INFINITY; 3]), nodes, packets, primitives }
        };
        let count = tree.packets().1.max(FEW) as f64;
        let most = [options.memory, options.work].map(|budget| (budget * count) as u64);
        // NaN is no resolution either.
        let mut resolution = if options.resolution > 0.0 { options.resolution.min(FINEST) } else { 0.0 };
        let mut percent = 0;
        let mut in_vain = 0;
        let (cells, done) = loop {
            if resolution < COARSEST || in_vain > most[1].saturating_mul(IN_VAIN) {
                // Not even the coarsest cells are within the budgets, or it takes too long to find those that are.
                return;
            }
            let done = Done {
                bytes: AtomicU64::new(0),
                work: AtomicU64::new(0),
                most,
                share: AtomicU64::new(0),
                percent: AtomicU64::new(percent),
                progress,
            };
            let refinement = Refinement {
                tree,
                owners: &owners,
                search: &search,
                domain: options.domain,
                slack: shape.slack,
                even: &shape.even,
                per_packet: 1.0 / tree.packets().0 as f64,
                resolution,
                parallel: options.splits.parallel,
                done,
            };
            let cells = refinement.cells(shape.low, shape.side);
            if !refinement.done.is_over() {
                break (cells, refinement.done);
            }
            percent = refinement.done.percent.into_inner();
            in_vain += refinement.done.work.into_inner();
            resolution = coarser(resolution);
        };
        self.report.work = done.work.into_inner();
        self.report.resolution = resolution;
        self.low = shape.low;
        self.per_length = 2f64.powi(i32::from(DEEPEST)) / shape.side;
        let mut codes = Codes { rows: Vec::new(), blocks: Vec::new(), report: &mut self.report };
        self.root = codes.code(cells, 0);
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
            per_length: 0.0,
            root: TREE,
            rows: Array::default(),
            blocks: Array::default(),
            report: OctreeReport { tree_bytes, ..OctreeReport::default() },
        };
        if let Some(shape) = Shape::of(&octree.tree, options) {
            octree.refine(set, options, &shape, progress);
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
        let code = self.cell_of(&to_f64_array(point)).0;
        match CellCode::decode(code) {
            CellCode::Single(packet, lane) => Some(vec![self.tree.leaves.packets[packet].ids()[lane]]),
            CellCode::List(number) => {
                let blocks = &self.blocks[number..=number + usize::from(self.blocks[number].more)];
                Some(search::primitives(&self.tree, blocks.iter()))
            }
            CellCode::Rows | CellCode::Tree => None,
        }
    }

    fn list_lengths(&self) -> Vec<usize> {
        let mut lengths = vec![1; self.report.singles];
        // One list after the other.
        let mut rest = &self.blocks[..];
        while let Some(first) = rest.first() {
            let (own, others) = rest.split_at(usize::from(first.more) + 1);
            lengths.push(own.iter().map(Block::count).sum());
            rest = others;
        }
        lengths
    }

    fn with_isa(self, isa: Isa) -> Self {
        Self { tree: self.tree.with_isa(isa), ..self }
    }
}

/// The next lower of the powers of 0.3, so that who asks for more does not get less.
#[allow(clippy::cast_possible_truncation, reason = "some dozens")]
fn coarser(resolution: f64) -> f64 {
    let steps = (resolution.ln() / 0.3f64.ln() + 1e-6).floor() as i32 + 1;
    0.3f64.powi(steps)
}

/// For each vertex of a tree the lowest primitive that has it, bit for bit.
fn owners(tree: &PacketTree) -> Vec<PrimitiveId> {
    let leaves = &tree.leaves;
    let mut owners: HashMap<[u64; 3], PrimitiveId> = HashMap::with_capacity(leaves.vertices.len());
    let key = |v: &V3| v.map(f64::to_bits);
    for packet in leaves.packets.iter().filter(|p| p.has_vertices()) {
        for (lane, id) in packet.ids().iter().enumerate() {
            let (corners, count) = packet.vertices_of(lane);
            for &v in &corners[..count] {
                owners.entry(key(&leaves.vertices[v])).and_modify(|o| *o = (*o).min(*id)).or_insert(*id);
            }
        }
    }
    leaves.vertices.iter().map(|v| owners[&key(v)]).collect()
}
