//! A partition into cubes.

pub(crate) mod build;
pub(crate) mod cell;

use crate::list::block::{self, Block, Place};
use crate::octree::build::{Cell, Done, Refinement, Searched};
use crate::octree::cell::DEEPEST;
use crate::options::{Domain, OctreeOptions, OctreeReport};
use crate::partition::{LookUp, Partition};
use crate::progress::{BuildStage, Progress};
use nalgebra::Point3;
use p2m_bvh::PacketTree;
use p2m_bvh::engine::nearest::{EvaluateFn, SearchState, finish, finish_nearest};
use p2m_bvh::engine::packet::LANES;
use p2m_bvh::engine::volume::Rounded;
use p2m_core::engine::query::BestF64;
use p2m_core::engine::real::{from_f64_array, to_f64_array};
use p2m_core::engine::simd::{InstructionSet, SimdKernel, prefetch_lines};
use p2m_core::engine::vector::V3;
use p2m_core::storage::{Array, LoadError, Reader, Saved, Writer};
use p2m_core::{Aabb, Best, Collector, Isa, Near, PrimitiveId, PrimitiveSet, QueryOptions, Real, StatsCollector};
use std::collections::HashMap;
use std::sync::atomic::AtomicU64;

/// What a code means is in its three highest bits, the rest is a number:
const SHIFT: u32 = 29;
/// the first of eight rows of codes, two levels of cubes;
const TWO_LEVELS: u32 = 0;
/// a row of codes, one level;
const ONE_LEVEL: u32 = 1;
/// the first block of a list;
const LIST: u32 = 2;
/// a packet and its lane;
const SINGLE: u32 = 3;
/// none: the tree answers.
const TREE: u32 = 4 << SHIFT;

/// [`Domain::Everywhere`] in sizes of the scene.
const EVERYWHERE: f64 = 10.0;
/// Where queries are taken to be, evenly in boxes of so many sizes of the scene: more of them the nearer it is.
const QUERIES: [(f64, f64); 4] = [(EVERYWHERE, 1.0), (4.0, 0.3), (2.0, 0.3), (1.05, 1.0)];
/// Resolutions from which on nothing changes any more.
const FINEST: f64 = 1e9;
const COARSEST: f64 = 1e-9;
/// Budgets are for at least so many primitives.
const FEW: usize = 10_000;
/// As many times the work of a refinement is done in vain at most, for one that is within the budgets.
const IN_VAIN: u64 = 5;

/// Codes of eight cubes, x lowest.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C, align(32))]
pub(crate) struct Row([u32; 8]);

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

/// The codes of cells, as they are made.
struct Codes<'a> {
    rows: Vec<Row>,
    blocks: Vec<Block>,
    report: &'a mut OctreeReport,
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

/// What is no array.
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Head {
    low: V3,
    per_length: f64,
    resolution: f64,
    work: u64,
    lists: u64,
    singles: u64,
    trees: u64,
    entries: u64,
    depth: u64,
    bytes: u64,
    tree_bytes: u64,
    root: u32,
    unused: u32,
}

impl Saved for Octree {
    fn kind() -> String {
        "octree".to_owned()
    }

    fn save<'a>(&'a self, writer: &mut Writer<'a>) {
        let OctreeReport { lists, singles, trees, entries, depth, bytes, tree_bytes, work, resolution } = self.report;
        let [lists, singles, trees, entries, depth, bytes, tree_bytes] =
            [lists, singles, trees, entries, depth, bytes, tree_bytes].map(|n| n as u64);
        let Self { low, per_length, root, .. } = *self;
        let head = Head {
            low,
            per_length,
            resolution,
            work,
            lists,
            singles,
            trees,
            entries,
            depth,
            bytes,
            tree_bytes,
            root,
            unused: 0,
        };
        writer.put_copy("octree", &[head]);
        writer.put("octree/codes", &self.rows);
        writer.put("octree/lists", &self.blocks);
        self.tree.save(writer);
    }

    #[allow(clippy::cast_possible_truncation, reason = "numbers to report")]
    fn load(reader: &Reader) -> Result<Self, LoadError> {
        let head: Head = reader.one("octree")?;
        let Head { lists, singles, trees, entries, depth, bytes, tree_bytes, .. } = head;
        let [lists, singles, trees, entries, depth, bytes, tree_bytes] =
            [lists, singles, trees, entries, depth, bytes, tree_bytes].map(|n| n as usize);
        let Head { low, per_length, resolution, work, root, .. } = head;
        let report = OctreeReport { lists, singles, trees, entries, depth, bytes, tree_bytes, work, resolution };
        let (rows, blocks) = (reader.array("octree/codes")?, reader.array("octree/lists")?);
        Ok(Self { tree: PacketTree::load(reader)?, low, per_length, root, rows, blocks, report })
    }
}

impl Codes<'_> {
    /// Keeps a cell of a level, and gives its code.
    fn code(&mut self, cell: Cell, level: usize) -> u32 {
        let code =
            |what: u32, n: usize| u32::try_from(n).ok().filter(|n| n >> SHIFT == 0).map_or(TREE, |n| what << SHIFT | n);
        self.report.depth = self.report.depth.max(level);
        match cell {
            Cell::Tree => {
                self.report.trees += 1;
                TREE
            }
            Cell::Single(packet, lane) => {
                self.report.singles += 1;
                code(SINGLE, packet as usize * LANES + usize::from(lane))
            }
            Cell::Blocks(blocks) => {
                self.report.lists += 1;
                self.report.entries += blocks.iter().map(|block| usize::from(block.len)).sum::<usize>();
                let first = self.blocks.len();
                self.blocks.extend(blocks);
                code(LIST, first)
            }
            Cell::Split(children) => {
                let row = self.rows.len();
                let inner = children.iter().filter(|child| matches!(child, Cell::Split(_))).count();
                // Two levels at once, unless most of their codes would be the same.
                if inner < 4 {
                    self.rows.push(Row([TREE; 8]));
                    for (c, child) in children.into_iter().enumerate() {
                        self.rows[row].0[c] = self.code(child, level + 1);
                    }
                    return code(ONE_LEVEL, row);
                }
                self.rows.resize(row + 8, Row([TREE; 8]));
                for (c, child) in children.into_iter().enumerate() {
                    match child {
                        Cell::Split(grandchildren) => {
                            for (g, grandchild) in grandchildren.into_iter().enumerate() {
                                let code = self.code(grandchild, level + 2);
                                self.put(row, c, g, code);
                            }
                        }
                        leaf => {
                            let code = self.code(leaf, level + 1);
                            (0..8).for_each(|g| self.put(row, c, g, code));
                        }
                    }
                }
                code(TWO_LEVELS, row)
            }
        }
    }

    /// Puts the code of grandchild `g` of child `c` into a node of two levels: two bits for each axis, x lowest.
    fn put(&mut self, row: usize, c: usize, g: usize, code: u32) {
        let place: usize = (0..3).map(|k| ((c >> k & 1) << 1 | (g >> k & 1)) << (2 * k)).sum();
        self.rows[row + place / 8].0[place % 8] = code;
    }
}

impl Octree {
    /// The code of the cell of a place in finest cells of the cube.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the cube")]
    fn locate(&self, place: &V3) -> u32 {
        let cells = f64::from(1u32 << DEEPEST);
        let mut at = [0u32; 3];
        for k in 0..3 {
            // Not for NaN either.
            if !(place[k] >= 0.0 && place[k] < cells) {
                return TREE;
            }
            at[k] = place[k] as u32;
        }
        let mut shift = DEEPEST;
        let mut code = self.root;
        while code < LIST << SHIFT {
            let row = (code & !(ONE_LEVEL << SHIFT)) as usize;
            if code < ONE_LEVEL << SHIFT {
                shift -= 2;
                let [x, y, z] = [at[0] >> shift & 3, at[1] >> shift & 3, at[2] >> shift & 3];
                code = self.rows[row + (z << 1 | y >> 1) as usize].0[((y & 1) << 2 | x) as usize];
            } else {
                shift -= 1;
                let [x, y, z] = [at[0] >> shift & 1, at[1] >> shift & 1, at[2] >> shift & 1];
                code = self.rows[row].0[(z << 2 | y << 1 | x) as usize];
            }
        }
        code
    }

    /// The code of the cell of a query, and its place in finest cells.
    #[inline(always)]
    fn cell_of(&self, query: &V3) -> (u32, V3) {
        let cells: V3 = std::array::from_fn(|k| (query[k] - self.low[k]) * self.per_length);
        (self.locate(&cells), cells)
    }

    /// How many packets the list of the cell of a point has: 1 where one primitive is the nearest throughout, `None`
    /// where the tree answers.
    #[must_use]
    pub fn list_length(&self, point: &Point3<f64>) -> Option<usize> {
        let code = self.cell_of(&to_f64_array(point)).0;
        match code >> SHIFT {
            SINGLE => Some(1),
            LIST => {
                let first = (code & !(LIST << SHIFT)) as usize;
                let blocks = &self.blocks[first..=first + usize::from(self.blocks[first].more)];
                Some(blocks.iter().map(|block| usize::from(block.len)).sum())
            }
            _ => None,
        }
    }
}

impl LookUp for Octree {
    #[inline(always)]
    fn look_up<C: Collector>(
        &self,
        query: V3,
        collector: &mut C,
        evaluate: EvaluateFn<'_, C>,
        finish: fn(&mut SearchState<'_, C>),
    ) {
        let tree = &self.tree;
        let (code, cells) = self.cell_of(&query);
        match tree.frame.local(&query) {
            Some(local) if code != TREE && collector.is_single_nearest() => {
                let place = Place { rounded: Rounded::of(local), local, cells };
                tree.isa().run(Lookup { octree: self, code, query, place, collector, evaluate, finish });
            }
            _ => tree.run(query, collector, evaluate, finish),
        }
    }

    fn nearest(&self, query: V3, minimum: &mut BestF64, evaluate: EvaluateFn<'_, BestF64>) {
        self.look_up(query, minimum, evaluate, finish_nearest);
    }

    fn near<'n>(&self, query: V3, near: &mut Near<'n>, evaluate: EvaluateFn<'_, Near<'n>>) {
        self.look_up(query, near, evaluate, finish);
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
        let number = (code & ((1 << SHIFT) - 1)) as usize;
        match code >> SHIFT {
            SINGLE => Some(vec![self.tree.leaves.packets[number / LANES].ids()[number % LANES]]),
            LIST => {
                let blocks = &self.blocks[number..=number + usize::from(self.blocks[number].more)];
                Some(block::primitives(&self.tree, blocks.iter()))
            }
            _ => None,
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

/// The cube of the domain, and what follows from it.
struct Shape {
    low: V3,
    side: f64,
    slack: f64,
    /// Boxes with queries evenly in them, and how many for each unit of volume.
    even: Vec<(Aabb<f64>, f64)>,
}

impl Shape {
    /// `None` for a scene without extent, one that f32 cannot tell apart and a domain without extent: the tree answers.
    #[allow(clippy::cast_possible_truncation, reason = "an exponent")]
    fn of(tree: &PacketTree, options: &OctreeOptions) -> Option<Self> {
        let bounds = tree.bounds();
        let extent = bounds.max - bounds.min;
        let size = extent.max();
        let centre = bounds.min + extent * 0.5;
        // A flat scene has a flat box, but queries beside it are in the domain, too.
        let extent = extent.map(|x| x.max(size * 0.05));
        let domain = match options.domain {
            Domain::Everywhere => {
                Aabb { min: centre - extent * (EVERYWHERE * 0.5), max: centre + extent * (EVERYWHERE * 0.5) }
            }
            Domain::Box(bounds) => bounds,
            Domain::Band(width) => {
                Aabb { min: centre - extent.map(|x| x * 0.5 + width), max: centre + extent.map(|x| x * 0.5 + width) }
            }
        };
        let span = domain.max - domain.min;
        let reach = span.max();
        let sound = span.iter().all(|x| *x > 0.0 && x.is_finite()) && domain.min.iter().all(|x| x.is_finite());
        let usable = size > 0.0 && size.is_finite() && tree.frame.is_plain() && sound;
        // Lists have places in the frame of the scene in f32, and cells have to be of some use.
        if !usable || reach > size * 2f64.powi(20) || reach < size * 2f64.powi(-20) {
            return None;
        }
        // Dyadic: a power of two as side, and the corner a multiple of a small part of it, so that all corners are
        // exact.
        let side = 2f64.powi((reach * 1.0001).log2().ceil() as i32);
        let grain = side / 4096.0;
        let middle = domain.min + span * 0.5;
        let low: V3 = std::array::from_fn(|k| ((middle[k] - side * 0.5) / grain).floor() * grain);
        let ends = [to_f64_array(&bounds.min), to_f64_array(&bounds.max)];
        let scale = side * 4.0 + low.iter().chain(ends.as_flattened()).fold(0.0f64, |a, x| a.max(x.abs()));
        let share = |scale: f64, part: f64| {
            let half = extent * (scale * 0.5);
            let around = Aabb { min: centre - half, max: centre + half };
            (around, part / (half * 2.0).product())
        };
        let even = match options.domain {
            Domain::Everywhere => QUERIES.map(|(scale, part)| share(scale, part)).to_vec(),
            Domain::Box(_) | Domain::Band(_) => vec![(domain, 1.0 / span.product())],
        };
        Some(Self {
            low,
            side,
            // Rounding of keys, of dominators and of locating a query: all below 2^-46 of this.
            slack: scale / (1u64 << 42) as f64,
            even,
        })
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

/// A query in its cell, as an operation.
struct Lookup<'a, C> {
    octree: &'a Octree,
    code: u32,
    query: V3,
    place: Place,
    collector: &'a mut C,
    evaluate: EvaluateFn<'a, C>,
    finish: fn(&mut SearchState<'_, C>),
}

impl<C: Collector> SimdKernel for Lookup<'_, C> {
    type Output = ();

    #[inline(always)]
    fn run<I: InstructionSet>(self) {
        let octree = self.octree;
        let tree = &octree.tree;
        let number = (self.code & !(7 << SHIFT)) as usize;
        let mut filter = SearchState::new(tree, self.query, f64::INFINITY, self.collector, self.evaluate, self.finish);
        if self.code >> SHIFT == SINGLE {
            filter.add(number / LANES, number % LANES);
            return filter.evaluate_waiting();
        }
        // What comes next, if the list has more than a block.
        prefetch_lines(octree.blocks.as_ptr().wrapping_add(number), 2 * size_of::<Block>());
        let (first, rest) = (&octree.blocks[number], &octree.blocks[number + 1..]);
        block::search::<I, C>(tree, first, rest, &self.place, &mut filter);
        filter.evaluate_waiting();
    }
}
