//! The search of a P2M index: a query is located in its cell and searches the list of the cell.
//!
//! A query reads, one after the other, a cell of the locator, a site and its neighbours for each step of the walk, the
//! blocks of the list, packets, and vertices. In a batch, each query takes one step and prefetches the memory of its
//! next step before the other queries take theirs. So most of the latency of memory is hidden.

use crate::list::block::{Block, BlockQuery};
use crate::list::interleaved_lists::{InterleavedLists, SearchInterleaved};
use crate::list::search;
use crate::partition::{CellQuery, are_lists_enough};
use crate::voronoi::Voronoi;
use crate::voronoi::list_filter::{ListFilter, ListFilters};
use crate::voronoi::neighbours::{LocatedSite, NeighbourTable};
use crate::voronoi::site::{AUXILIARY_SITE, Site};
use nalgebra::Point3;
use p2m_bvh::PacketTree;
use p2m_bvh::engine::interleaved::{InterleavedSearch, SEARCHES};
use p2m_bvh::engine::nearest::{EvaluateFn, Search, SearchState, finish, finish_nearest};
use p2m_bvh::engine::packet::LANES;
use p2m_bvh::engine::volume::Rounded;
use p2m_core::engine::adaptive::RANGE;
use p2m_core::engine::query::BestF64;
use p2m_core::engine::real::to_f64_array;
use p2m_core::engine::simd::{InstructionSet, SimdKernel, prefetch_lines};
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
        if are_lists_enough(collector)
            && let Some(position) = self.to_site_units(&query)
            && let Some(site) = self.locator.as_ref().and_then(|locator| locator.start(&position))
        {
            let located = LocatedSite { site, is_certainly_nearest: false };
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

    fn query_near<'n>(&self, query: V3, near: &mut Near<'n>, evaluate: EvaluateFn<'_, Near<'n>>) {
        self.query_with(query, near, evaluate, finish);
    }

    fn search_several(&self, count: usize, several: &mut InterleavedSearch<'_>, lists: &mut InterleavedLists) {
        self.tree.isa().run(SearchInterleaved { partition: self, count, several, lists });
    }
}

impl Voronoi {
    /// Returns the number of the site whose cell contains a query point, which is the first step of every query. It is
    /// `None` outside of the domain, and if the tree answers everything.
    #[must_use]
    pub fn locate_site(&self, query: &Point3<f64>) -> Option<usize> {
        let position = self.to_site_units(&to_f64_array(query))?;
        let start = self.locator.as_ref()?.start(&position)?;
        Some(self.tree.isa().run(LocateSite { neighbours: &self.neighbours, start, position }))
    }

    /// Converts a query point to the units of sites. It is `None` outside of the domain.
    #[inline(always)]
    fn to_site_units(&self, query: &V3) -> Option<V3> {
        // The comparison is false if a coordinate is NaN.
        let is_inside = (0..3).all(|k| query[k] >= self.low[k] && query[k] <= self.high[k]);
        is_inside.then(|| query.map(|x| flush_tiny(x * self.per_unit)))
    }

    /// Prefetches a block of a list. The first block of a list has the number of its site.
    #[inline(always)]
    fn prefetch_block(&self, number: usize) {
        prefetch_lines(self.blocks.as_ptr().wrapping_add(number), size_of::<Block>());
    }

    /// Returns an upper bound of the answer, which is the distance to the site or to the anchor of an auxiliary site.
    #[inline(always)]
    fn upper_bound(&self, site: &Site, query: &V3, position: &V3) -> f64 {
        let length = |offset: V3| norm_squared(offset).sqrt() * (1.0 + 8.0 * f64::EPSILON);
        if site.list == AUXILIARY_SITE {
            length(sub(*query, self.anchors[site.owner as usize])) + self.slack
        } else {
            length(sub(*position, site.position)) * self.unit + self.slack
        }
    }

    /// Returns the packet and the lane of the answer if it is certain without a search, because the query is in the far
    /// half-space of its site.
    #[inline(always)]
    fn known_answer(located: &LocatedSite, site: &Site, position: &V3) -> Option<(usize, usize)> {
        let owner = site.owner as usize;
        let is_known = located.is_certainly_nearest && site.far_half_space.contains(&sub(*position, site.position));
        is_known.then_some((owner / LANES, owner % LANES))
    }
}

/// Returns a coordinate in the units of sites, or 0 if it is too small for the exact predicates. Sites are treated in
/// the same way.
#[inline(always)]
fn flush_tiny(x: f64) -> f64 {
    if x.abs() < *RANGE.start() { 0.0 } else { x }
}

/// A SIMD kernel that walks to the site nearest to a query.
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

/// A SIMD kernel that walks from a first site to the cell of a query and searches its list.
struct LocateAndSearch<'a, C> {
    index: &'a Voronoi,
    located: LocatedSite,
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

/// A SIMD kernel that searches the cell of a query. It is separate from the walk, so that it is compiled only once for
/// single queries and for batches.
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
        // The second block is prefetched as well, because the list may have more than one.
        index.prefetch_block(site.list as usize);
        let mut state = SearchState::new(tree, query, upper_bound, collector, evaluate, finish);
        if let Some((packet, lane)) = known_answer {
            state.add(packet, lane);
            return state.evaluate_pending();
        }
        state.hold(held, upper_bound);
        let (first, rest) = (&index.blocks[located.site], &index.blocks[site.list as usize..]);
        search::search_list::<I, C>(tree, first, rest, &block_query(tree, &query), &mut state);
        state.evaluate_pending();
    }
}

/// A SIMD kernel that searches those primitives of a list that its filter chooses.
struct SearchFilteredList<'a, C> {
    filter: &'a dyn ListFilter,
    search: Search<'a, Aabb<f64>, C>,
}

/// Searches a list that has a filter. It is not inlined, because few indexes have filters and its code would cost the
/// search of the others registers.
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
        state.evaluate_pending();
    }
}

/// Converts a query to the form that blocks with boxes need.
#[inline(always)]
fn block_query(tree: &PacketTree, query: &V3) -> BlockQuery {
    let local = tree.frame.place(query);
    BlockQuery { rounded: Rounded::of(local), local, cells: [0.0; 3] }
}

impl SimdKernel for SearchInterleaved<'_, '_, Voronoi> {
    type Output = ();

    #[inline(always)]
    fn run<I: InstructionSet>(self) {
        let Self { partition: index, count, several, lists } = self;
        lists.clear();
        let Some(locator) = &index.locator else {
            (0..count).for_each(|i| several.search_tree(i));
            return;
        };
        let mut positions = [None; SEARCHES];
        for (i, to) in positions[..count].iter_mut().enumerate() {
            *to = index.to_site_units(several.query(i));
            to.iter().for_each(|position| locator.prefetch(position));
        }
        positions.iter().flatten().for_each(|position| locator.prefetch_more(position));
        let mut locations: [Option<LocatedSite>; SEARCHES] = [None; SEARCHES];
        let mut walking = 0u64;
        for (i, position) in positions[..count].iter().enumerate() {
            let start = position.as_ref().and_then(|position| locator.start(position));
            locations[i] = start.map(|site| LocatedSite { site, is_certainly_nearest: false });
            match start {
                Some(site) => {
                    index.neighbours.prefetch(site);
                    walking |= 1 << i;
                }
                None => several.search_tree(i),
            }
        }
        // Only a table from a file with wrong offsets has walks that take more work.
        let mut work_left = SEARCHES * index.neighbours.max_walk_work();
        while walking != 0 && work_left > 0 {
            let mut rest = walking;
            while rest != 0 {
                let i = rest.trailing_zeros() as usize;
                rest &= rest - 1;
                if let (Some(located), Some(position)) = (&mut locations[i], &positions[i]) {
                    let (next, is_certainly_nearest) = index.neighbours.step::<I>(located.site, position);
                    if next == located.site {
                        located.is_certainly_nearest = is_certainly_nearest;
                        walking &= !(1 << i);
                        index.prefetch_block(next);
                    } else {
                        work_left = work_left.saturating_sub(index.neighbours.step_work(located.site));
                        located.site = next;
                        index.neighbours.prefetch(next);
                    }
                }
            }
        }
        for (i, (located, position)) in locations.iter().zip(&positions).enumerate() {
            if let (Some(located), Some(position)) = (located, position) {
                index.begin_cell(i, located, position, several, lists);
            }
        }
        lists.search::<I>(&index.tree, &index.blocks, several);
        several.evaluate_candidates();
    }
}

impl Voronoi {
    /// Begins the search of a query in its cell. Adds its list to `lists`, unless the far half-space, the tree or a
    /// filter answers.
    #[inline(always)]
    fn begin_cell(
        &self,
        search: usize,
        located: &LocatedSite,
        position: &V3,
        several: &mut InterleavedSearch<'_>,
        lists: &mut InterleavedLists,
    ) {
        let site = &self.neighbours.sites[located.site];
        if let Some((packet, lane)) = Self::known_answer(located, site, position).filter(|_| site.has_list()) {
            self.tree.leaves.prefetch(packet);
            return several.add(search, packet, lane);
        }
        let query = *several.query(search);
        several.limit_to(search, self.upper_bound(site, &query, position));
        if !site.has_list() {
            several.search_tree(search);
        } else if let Some(filter) = self.filters.get(located.site) {
            several.filter_all(search, &ListFilters::packets(filter, &query));
        } else {
            lists.push(search, located.site, site.list as usize, block_query(&self.tree, &query));
        }
    }
}
