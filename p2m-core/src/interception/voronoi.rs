//! A partition into Voronoi cells \[Zong2023\].
//!
//! Sites are the vertices of the scene: in its cell a site is the nearest vertex, so it is a dominator, and the cell is
//! the hull of the centres of its Delaunay tetrahedra. By the corner test a primitive can be the answer in the cell only
//! if it meets one of their circumscribed balls, so one ball query for each tetrahedron serves four lists: no flooding,
//! no cutting of cells. Six far sites close the cells of the hull.

use super::block::{self, Block, Place};
use super::cells::Cells;
use super::fan::Fans;
use super::hints::Hints;
use super::options::{P2mOptions, P2mReport};
use super::partition::{LookUp, Partition};
use crate::delaunay::{BOUNDING, Delaunay};
use crate::hierarchy::PacketTree;
use crate::hierarchy::wide::search::{Evaluate, Filter, Search, finish_nearest};
use crate::hierarchy::wide::volume::Rounded;
use crate::kernel::vector::{V3, norm_squared, sub};
use crate::packet::LANES;
use crate::predicates::staged::RANGE;
use crate::query::Minimum;
use crate::real::wide;
use crate::simd::{InstructionSet, Operation, prefetch_lines};
use crate::{Aabb, Collector, Isa, PrimitiveSet, Real};
use nalgebra::Point3;
use std::cell::Cell;

/// The list of a cell that the tree answers; else the number of its first block.
pub(super) const TREE: u32 = u32::MAX;
/// As many packets as a list can have.
const LONGEST: usize = 2048;
/// The cube of the domain is so many times as wide as the scene.
const REACH: f64 = 10.0;
/// The distance of the bounding sites, in halves of the widest side: none of them is nearest in the domain, nor nearly
/// (docs/p2m.md).
const BOUNDING_DISTANCE: f64 = 250.0;

/// An interception index whose cells are those of the vertices, over a set of primitives that it does not keep.
#[derive(Clone, Debug)]
pub struct Voronoi {
    tree: PacketTree,
    /// Of the places of sites.
    per_unit: f64,
    unit: f64,
    /// By how much a dominator has to be nearer.
    slack: f64,
    low: V3,
    high: V3,
    fans: Fans,
    hints: Option<Hints>,
    blocks: Vec<Block>,
    report: P2mReport,
}

impl Voronoi {
    fn make_cells(&mut self, options: &P2mOptions, progress: &(dyn Fn(f64) + Sync)) {
        let tree = &self.tree;
        // Around the vertices: primitives of your own may be elsewhere.
        let vertices = tree.leaves.vertices.iter().map(|v| Point3::from(*v));
        let bounds = vertices.fold(Aabb::empty(), |all, v| all.union(&Aabb { min: v, max: v }));
        let half = (bounds.max - bounds.min).max() * 0.5;
        // No extent, or one that f32 cannot tell apart; not for NaN either, which comes of no vertices.
        if !tree.frame.is_plain() || half.is_nan() || half <= 0.0 {
            return;
        }
        // What cannot be triangulated is left to the tree, too: there are more vertices than numbers.
        let Ok(delaunay) = Delaunay::new(&tree.leaves.vertices, BOUNDING_DISTANCE) else { return };
        let centre = wide(&nalgebra::center(&bounds.min, &bounds.max));
        let domain = half * REACH;
        let (low, high) = (centre.map(|x| x - domain), centre.map(|x| x + domain));
        let pad = half * 0.25;
        let own = [wide(&bounds.min).map(|x| x - pad), wide(&bounds.max).map(|x| x + pad)];
        // In the plane of a flat scene, far out, f64 has no room beside it.
        if (0..3).any(|k| own[0][k] >= own[1][k] || low[k] >= high[k]) {
            return;
        }
        let whole = tree.bounds();
        let size = (whole.max - whole.min).max();
        let far = half.max(size) * BOUNDING_DISTANCE + centre.iter().fold(0.0f64, |a, x| a.max(x.abs()));
        let all = (delaunay.tetrahedra().len() + 4 * delaunay.sites().len()) as f64;
        let percent = Cell::new(0.0);
        // What comes before is about a tenth of all.
        let done = |steps: usize| {
            let part = (10.0 + 90.0 * steps as f64 / all).floor();
            if part > percent.replace(part) {
                progress(part / 100.0);
            }
        };
        // Rounding of keys and of corners: all below 2^-44 of this.
        let slack = far / (1u64 << 40) as f64;
        let cells = Cells { tree, delaunay: &delaunay, slack, most: options.longest.min(LONGEST), progress: &done };
        let corners = cells.corners();
        let (fans, blocks) = cells.lists(&corners, &mut self.report);
        drop(corners);
        // To find one's cell in vain costs more than the few lists save.
        if self.report.lists < self.report.trees {
            return;
        }
        self.slack = cells.slack;
        (self.unit, self.per_unit) = (delaunay.unit(), delaunay.unit().recip());
        drop(delaunay);
        (self.low, self.high) = (low, high);
        let scaled = |p: V3| p.map(|x| x * self.per_unit);
        let (own, all) = (own.map(scaled), [low, high].map(scaled));
        self.hints = Some(Hints::new(&fans, self.tree.isa(), own, all, BOUNDING));
        (self.fans, self.blocks) = (fans, blocks);
        self.blocks.shrink_to_fit();
        self.report.bytes = self.memory() - self.tree.memory();
    }
}

impl LookUp for Voronoi {
    #[inline(always)]
    fn look_up<C: Collector>(
        &self,
        query: V3,
        collector: &mut C,
        evaluate: Evaluate<'_, C>,
        finish: fn(&mut Filter<'_, C>),
    ) {
        let tree = &self.tree;
        // Not for NaN either.
        let inside = (0..3).all(|k| query[k] >= self.low[k] && query[k] <= self.high[k]);
        if inside && let Some(hints) = &self.hints {
            let place = query.map(|x| snapped(x * self.per_unit));
            if let Some(start) = hints.start(&place) {
                return tree.isa().run(Lookup { index: self, start, query, place, collector, evaluate, finish });
            }
        }
        tree.isa().run(Search { tree, query, reach: f64::INFINITY, collector, evaluate, finish });
    }

    fn nearest(&self, query: V3, minimum: &mut Minimum, evaluate: Evaluate<'_, Minimum>) {
        self.look_up(query, minimum, evaluate, finish_nearest);
    }
}

impl Partition for Voronoi {
    type Options = P2mOptions;
    type Report = P2mReport;

    fn build<T: Real, S: PrimitiveSet<T> + Sync + ?Sized>(
        set: &S,
        options: &P2mOptions,
        progress: &(dyn Fn(f64) + Sync),
    ) -> Self {
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
            hints: None,
            blocks: Vec::new(),
            report,
        };
        index.make_cells(options, progress);
        progress(1.0);
        index
    }

    fn tree(&self) -> &PacketTree {
        &self.tree
    }

    fn report(&self) -> P2mReport {
        self.report
    }

    fn memory(&self) -> usize {
        self.tree.memory()
            + self.fans.memory()
            + self.hints.as_ref().map_or(0, Hints::memory)
            + self.blocks.capacity() * size_of::<Block>()
    }

    fn with_isa(self, isa: Isa) -> Self {
        Self { tree: self.tree.with_isa(isa), ..self }
    }
}

/// A coordinate of a query in the units of sites, or 0 below what the predicates can tell, as for sites.
#[inline(always)]
fn snapped(x: f64) -> f64 {
    if x.abs() < *RANGE.start() { 0.0 } else { x }
}

/// A query on its way to its cell, as an operation.
struct Lookup<'a, C> {
    index: &'a Voronoi,
    start: usize,
    query: V3,
    place: V3,
    collector: &'a mut C,
    evaluate: Evaluate<'a, C>,
    finish: fn(&mut Filter<'_, C>),
}

impl<C: Collector> Operation for Lookup<'_, C> {
    type Output = ();

    #[inline(always)]
    fn run<I: InstructionSet>(self) {
        let Self { index, start, query, place, collector, evaluate, finish } = self;
        let tree = &index.tree;
        let blocks = &index.blocks;
        let found = index.fans.walk::<I>(start, &place, |at| {
            prefetch_lines(blocks.as_ptr().wrapping_add(at), size_of::<Block>());
        });
        let site = &index.fans.sites[found.site];
        let way = sub(place, site.place);
        // The vertex itself is at most this far.
        let reach = norm_squared(way).sqrt() * index.unit * (1.0 + 8.0 * f64::EPSILON) + index.slack;
        if site.list == TREE {
            return Search { tree, query, reach, collector, evaluate, finish }.run::<I>();
        }
        // What comes next, if the list has more than a block.
        prefetch_lines(blocks.as_ptr().wrapping_add(site.list as usize), size_of::<Block>());
        let mut filter = Filter::new(tree, query, reach, collector, evaluate, finish);
        if found.is_nearest && site.outside.contains(&way) {
            filter.add(site.owner as usize / LANES, site.owner as usize % LANES);
            return filter.evaluate_waiting();
        }
        let local = tree.frame.place(&query);
        let place = Place { rounded: Rounded::of(local), local, cells: [0.0; 3] };
        let (first, rest) = (&blocks[found.site], &blocks[site.list as usize..]);
        block::search::<I, C>(tree, first, rest, &place, &mut filter);
        filter.evaluate_waiting();
    }
}
