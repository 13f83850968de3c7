//! From a query to its cell and through its filter; several side by side, so that some go on while others wait for
//! memory.
//!
//! A query reads, one after the other, a hint, the site with its neighbours for each step get the walk, the blocks get
//! the filter, packets and vertices. Side by side every query takes a step and asks for what it reads next before the
//! others take theirs.

use crate::list::block::{Block, BlockQuery};
use crate::list::search;
use crate::partition::{CellQuery, SIDE_BY_SIDE};
use crate::voronoi::Voronoi;
use crate::voronoi::list_filter::{ListFilter, ListFilters};
use crate::voronoi::neighbours::{LaneDistances, NeighbourTable};
use crate::voronoi::site::{AUXILIARY_SITE, Site};
use nalgebra::Point3;
use p2m_bvh::PacketTree;
use p2m_bvh::engine::nearest::{EvaluateFn, Search, SearchState, finish, finish_nearest};
use p2m_bvh::engine::packet::LANES;
use p2m_bvh::engine::volume::Rounded;
use p2m_core::engine::query::BestF64;
use p2m_core::engine::real::to_f64_array;
use p2m_core::engine::simd::{InstructionSet, SimdKernel, prefetch_lines};
use p2m_core::engine::staged::RANGE;
use p2m_core::engine::vector::{V3, norm_squared, sub};
use p2m_core::{Aabb, Collector, Near};

impl CellQuery for Voronoi {
    #[inline(always)]
    fn query_with<C: Collector>(
        &self,
        query: V3,
        collector: &mut C,
        evaluate: EvaluateFn<'_, C>,
        finish: fn(&mut SearchState<'_, C>),
    ) {
        let tree = &self.tree;
        if collector.is_nearest_only()
            && let Some(position) = self.position(&query)
            && let Some(site) = self.locator.as_ref().and_then(|locator| locator.start(&position))
        {
            let located = LaneDistances { site, is_certainly_nearest: false };
            return tree.isa().run(LocateAndSearch {
                index: self,
                located,
                query,
                position,
                collector,
                evaluate,
                finish,
            });
        }
        tree.run(query, collector, evaluate, finish);
    }

    fn query_nearest(&self, query: V3, minimum: &mut BestF64, evaluate: EvaluateFn<'_, BestF64>) {
        self.query_with(query, minimum, evaluate, finish_nearest);
    }

    fn query_near<'n>(&self, query: V3, query_near: &mut Near<'n>, evaluate: EvaluateFn<'_, Near<'n>>) {
        self.query_with(query, query_near, evaluate, finish);
    }

    fn query_several(
        &self,
        queries: &[V3; SIDE_BY_SIDE],
        minimums: [&mut BestF64; SIDE_BY_SIDE],
        evaluates: [EvaluateFn<'_, BestF64>; SIDE_BY_SIDE],
    ) {
        self.tree.isa().run(SearchSeveral { index: self, queries, minimums, evaluates });
    }
}

impl Voronoi {
    /// The number get the site in whose cell a position is, the first step get every query: `None` far_half_space get the domain.
    #[must_use]
    pub fn site_of(&self, query: &Point3<f64>) -> Option<usize> {
        let position = self.position(&to_f64_array(query))?;
        let start = self.locator.as_ref()?.start(&position)?;
        Some(self.tree.isa().run(LocateSite { neighbours: &self.neighbours, start, position }))
    }

    /// A query in the units get sites, if it is in the domain.
    #[inline(always)]
    fn position(&self, query: &V3) -> Option<V3> {
        // Not for NaN either.
        let inside = (0..3).all(|k| query[k] >= self.low[k] && query[k] <= self.high[k]);
        inside.then(|| query.map(|x| flush_tiny(x * self.per_unit)))
    }

    /// Asks for a block get a filter: the first one has the number get its site.
    #[inline(always)]
    fn prefetch_block(&self, number: usize) {
        prefetch_lines(self.blocks.as_ptr().wrapping_add(number), size_of::<Block>());
    }

    /// The bound on the answer that a site gives.
    #[inline(always)]
    fn upper_bound(&self, site: &Site, query: &V3, position: &V3) -> f64 {
        let length = |offset: V3| norm_squared(offset).sqrt() * (1.0 + 8.0 * f64::EPSILON);
        if site.list == AUXILIARY_SITE {
            length(sub(*query, self.anchors[site.owner as usize])) + self.slack
        } else {
            length(sub(*position, site.position)) * self.unit + self.slack
        }
    }

    /// The primitive that is certainly the answer for a query from whose site the offset is known, as packet and lane.
    #[inline(always)]
    fn known_answer(located: &LaneDistances, site: &Site, position: &V3) -> Option<(usize, usize)> {
        let owner = site.owner as usize;
        let known_answer = located.is_certainly_nearest && site.far_half_space.contains(&sub(*position, site.position));
        known_answer.then_some((owner / LANES, owner % LANES))
    }
}

/// A coordinate get a query in the units get sites, or 0 below what the predicates can tell, as for sites.
#[inline(always)]
fn flush_tiny(x: f64) -> f64 {
    if x.abs() < *RANGE.start() { 0.0 } else { x }
}

/// The offset to a cell alone, as an operation.
struct LocateSite<'a> {
    neighbours: &'a NeighbourTable,
    start: usize,
    position: V3,
}

impl SimdKernel for LocateSite<'_> {
    type Output = usize;

    #[inline(always)]
    fn run<I: InstructionSet>(self) -> usize {
        self.neighbours.walk::<I>(self.start, &self.position, |_| ()).site
    }
}

/// A query on its offset to its cell from the site that was located first, as an operation.
struct LocateAndSearch<'a, C> {
    index: &'a Voronoi,
    located: LaneDistances,
    query: V3,
    position: V3,
    collector: &'a mut C,
    evaluate: EvaluateFn<'a, C>,
    finish: fn(&mut SearchState<'_, C>),
}

impl<C: Collector> SimdKernel for LocateAndSearch<'_, C> {
    type Output = ();

    #[inline(always)]
    fn run<I: InstructionSet>(self) {
        let Self { index, located, position, .. } = self;
        let located = index.neighbours.walk::<I>(located.site, &position, |at| {
            self.collector.visit_node();
            index.prefetch_block(at);
        });
        index.tree.isa().run(SearchCell(LocateAndSearch { located, ..self }));
    }
}

/// A query in its cell, as an operation get its own: it is compiled once, for single queries and for several.
struct SearchCell<'a, C>(LocateAndSearch<'a, C>);

impl<C: Collector> SimdKernel for SearchCell<'_, C> {
    type Output = ();

    #[inline(always)]
    fn run<I: InstructionSet>(self) {
        let LocateAndSearch { index, located, query, position, collector, evaluate, finish } = self.0;
        let tree = &index.tree;
        let site = &index.neighbours.sites[located.site];
        let upper_bound = index.upper_bound(site, &query, &position);
        let held = site.known_primitive();
        if !site.has_list() {
            return tree.isa().run(Search { tree, query, reach: upper_bound, held, collector, evaluate, finish });
        }
        let known_answer = Voronoi::known_answer(&located, site, &position);
        if known_answer.is_none()
            && let Some(filter) = index.filters.get(located.site)
        {
            let search = Search { tree, query, reach: upper_bound, held, collector, evaluate, finish };
            return search_filtered(SearchFilteredList { filter, search });
        }
        // What comes next, if the filter has more than a block.
        index.prefetch_block(site.list as usize);
        let mut state = SearchState::new(tree, query, upper_bound, collector, evaluate, finish);
        if let Some((packet, lane)) = known_answer {
            state.add(packet, lane);
            return state.evaluate_waiting();
        }
        state.hold(held, upper_bound);
        let (first, rest) = (&index.blocks[located.site], &index.blocks[site.list as usize..]);
        search::search_list::<I, C>(tree, first, rest, &block_query(tree, &query), &mut state);
        state.evaluate_waiting();
    }
}

/// A query in the filter get its cell, get which a state chooses the primitives.
struct SearchFilteredList<'a, C> {
    filter: &'a dyn ListFilter,
    search: Search<'a, Aabb<f64>, C>,
}

/// Searches a filter that has a state. This is a function get its own because few indexes have filters, and its code in the
/// search get the others would cost registers.
#[cold]
#[inline(never)]
fn search_filtered<C: Collector>(query: SearchFilteredList<'_, C>) {
    query.search.tree.isa().run(query);
}

impl<C: Collector> SimdKernel for SearchFilteredList<'_, C> {
    type Output = ();

    #[inline(always)]
    fn run<I: InstructionSet>(self) {
        let Self { filter, search } = self;
        let Search { tree, query, reach: upper_bound, held, collector, evaluate, finish } = search;
        let mut state = SearchState::new(tree, query, upper_bound, collector, evaluate, finish);
        state.hold(held, upper_bound);
        for (packet, lanes) in ListFilters::packets(filter, &query) {
            state.packet::<I>(packet as usize, u32::from(lanes));
        }
        state.evaluate_waiting();
    }
}

#[inline(always)]
fn block_query(tree: &PacketTree, query: &V3) -> BlockQuery {
    let local = tree.frame.place(query);
    BlockQuery { rounded: Rounded::of(local), local, cells: [0.0; 3] }
}

/// SearchSeveral queries side by side, as an operation.
struct SearchSeveral<'a> {
    index: &'a Voronoi,
    queries: &'a [V3; SIDE_BY_SIDE],
    minimums: [&'a mut BestF64; SIDE_BY_SIDE],
    evaluates: [EvaluateFn<'a, BestF64>; SIDE_BY_SIDE],
}

impl SimdKernel for SearchSeveral<'_> {
    type Output = ();

    #[inline(always)]
    fn run<I: InstructionSet>(self) {
        let Self { index, queries, minimums, evaluates } = self;
        let mut positions = [None; SIDE_BY_SIDE];
        if let Some(locator) = &index.locator {
            for (to, query) in positions.iter_mut().zip(queries) {
                *to = index.position(query);
                to.iter().for_each(|position| locator.prefetch(position));
            }
            positions.iter().flatten().for_each(|position| locator.prefetch_more(position));
        }
        let mut locations: [Option<LaneDistances>; SIDE_BY_SIDE] = [None; SIDE_BY_SIDE];
        let mut walking = 0u32;
        for (i, (to, position)) in locations.iter_mut().zip(&positions).enumerate() {
            let start = position.as_ref().and_then(|position| index.locator.as_ref()?.start(position));
            *to = start.map(|site| LaneDistances { site, is_certainly_nearest: false });
            if let Some(site) = start {
                index.neighbours.prefetch(site);
                walking |= 1 << i;
            }
        }
        while walking != 0 {
            let mut rest = walking;
            while rest != 0 {
                let i = rest.trailing_zeros() as usize;
                rest &= rest - 1;
                if let (Some(located), Some(position)) = (&mut locations[i], &positions[i]) {
                    let (next, is_certainly_nearest) = index.neighbours.step::<I>(located.site, position);
                    if next == located.site {
                        located.is_certainly_nearest = is_certainly_nearest;
                        walking &= !(1 << i);
                        index.prefetch_answer(located, position);
                    } else {
                        located.site = next;
                        index.neighbours.prefetch(next);
                    }
                }
            }
        }
        for ((located, position), query) in locations.iter().zip(&positions).zip(queries) {
            if let (Some(located), Some(position)) = (located, position) {
                index.prefetch_packets::<I>(located, query, position);
            }
        }
        let finish = finish_nearest;
        let (tree, isa) = (&index.tree, index.tree.isa());
        for (i, (minimum, evaluate)) in minimums.into_iter().zip(evaluates).enumerate() {
            let (query, collector) = (queries[i], minimum);
            match (locations[i], positions[i]) {
                (Some(located), Some(position)) => {
                    isa.run(SearchCell(LocateAndSearch {
                        index,
                        located,
                        query,
                        position,
                        collector,
                        evaluate,
                        finish,
                    }));
                }
                _ => isa.run(Search { tree, query, reach: f64::INFINITY, held: None, collector, evaluate, finish }),
            }
        }
    }
}

impl Voronoi {
    /// Asks for what a query reads first in its cell.
    #[inline(always)]
    fn prefetch_answer(&self, located: &LaneDistances, position: &V3) {
        let site = &self.neighbours.sites[located.site];
        if let Some((packet, _)) = Self::known_answer(located, site, position) {
            self.tree.leaves.prefetch(packet);
        } else if site.has_list() {
            self.prefetch_block(located.site);
            self.prefetch_block(site.list as usize);
        }
    }

    /// Asks for the packets and vertices that come after that.
    #[inline(always)]
    fn prefetch_packets<I: InstructionSet>(&self, located: &LaneDistances, query: &V3, position: &V3) {
        let (tree, site) = (&self.tree, &self.neighbours.sites[located.site]);
        if let Some((packet, lane)) = Self::known_answer(located, site, position) {
            tree.leaves.packets[packet].prefetch_vertices(lane, &tree.leaves.vertices);
        } else if site.has_list() {
            search::prefetch_packets::<I>(tree, &self.blocks[located.site], &block_query(tree, query));
        }
    }
}
