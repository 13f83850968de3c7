//! From a query to its cell and through its list; several side by side, so that some go on while others wait for
//! memory.
//!
//! A query reads, one after the other, a hint, the site with its neighbours for each step of the walk, the blocks of
//! the list, packets and vertices. Side by side every query takes a step and asks for what it reads next before the
//! others take theirs.

use crate::list::block::{Block, Place};
use crate::list::search;
use crate::partition::{LookUp, SIDE_BY_SIDE};
use crate::voronoi::Voronoi;
use crate::voronoi::list_filter::{Filters, ListFilter};
use crate::voronoi::neighbours::{Fans, Found};
use crate::voronoi::site::{AUXILIARY, Site};
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

impl LookUp for Voronoi {
    #[inline(always)]
    fn look_up<C: Collector>(
        &self,
        query: V3,
        collector: &mut C,
        evaluate: EvaluateFn<'_, C>,
        finish: fn(&mut SearchState<'_, C>),
    ) {
        let tree = &self.tree;
        if collector.is_nearest_only()
            && let Some(place) = self.place(&query)
            && let Some(site) = self.locator.as_ref().and_then(|locator| locator.start(&place))
        {
            let found = Found { site, is_nearest: false };
            return tree.isa().run(Answer { index: self, found, query, place, collector, evaluate, finish });
        }
        tree.run(query, collector, evaluate, finish);
    }

    fn nearest(&self, query: V3, minimum: &mut BestF64, evaluate: EvaluateFn<'_, BestF64>) {
        self.look_up(query, minimum, evaluate, finish_nearest);
    }

    fn near<'n>(&self, query: V3, near: &mut Near<'n>, evaluate: EvaluateFn<'_, Near<'n>>) {
        self.look_up(query, near, evaluate, finish);
    }

    fn nearest_of_several(
        &self,
        queries: &[V3; SIDE_BY_SIDE],
        minimums: [&mut BestF64; SIDE_BY_SIDE],
        evaluates: [EvaluateFn<'_, BestF64>; SIDE_BY_SIDE],
    ) {
        self.tree.isa().run(Several { index: self, queries, minimums, evaluates });
    }
}

impl Voronoi {
    /// The number of the site in whose cell a place is, the first step of every query: `None` outside of the domain.
    #[must_use]
    pub fn site_of(&self, query: &Point3<f64>) -> Option<usize> {
        let place = self.place(&to_f64_array(query))?;
        let start = self.locator.as_ref()?.start(&place)?;
        Some(self.tree.isa().run(Walk { fans: &self.fans, start, place }))
    }

    /// A query in the units of sites, if it is in the domain.
    #[inline(always)]
    fn place(&self, query: &V3) -> Option<V3> {
        // Not for NaN either.
        let inside = (0..3).all(|k| query[k] >= self.low[k] && query[k] <= self.high[k]);
        inside.then(|| query.map(|x| snapped(x * self.per_unit)))
    }

    /// Asks for a block of a list: the first one has the number of its site.
    #[inline(always)]
    fn prefetch_block(&self, number: usize) {
        prefetch_lines(self.blocks.as_ptr().wrapping_add(number), size_of::<Block>());
    }

    /// The bound on the answer that a site gives.
    #[inline(always)]
    fn reach(&self, site: &Site, query: &V3, place: &V3) -> f64 {
        let length = |way: V3| norm_squared(way).sqrt() * (1.0 + 8.0 * f64::EPSILON);
        if site.list == AUXILIARY {
            length(sub(*query, self.anchors[site.owner as usize])) + self.slack
        } else {
            length(sub(*place, site.place)) * self.unit + self.slack
        }
    }

    /// The primitive that is certainly the answer for a query from whose site the way is known, as packet and lane.
    #[inline(always)]
    fn certain(found: &Found, site: &Site, place: &V3) -> Option<(usize, usize)> {
        let owner = site.owner as usize;
        let certain = found.is_nearest && site.outside.contains(&sub(*place, site.place));
        certain.then_some((owner / LANES, owner % LANES))
    }
}

/// A coordinate of a query in the units of sites, or 0 below what the predicates can tell, as for sites.
#[inline(always)]
fn snapped(x: f64) -> f64 {
    if x.abs() < *RANGE.start() { 0.0 } else { x }
}

/// The way to a cell alone, as an operation.
struct Walk<'a> {
    fans: &'a Fans,
    start: usize,
    place: V3,
}

impl SimdKernel for Walk<'_> {
    type Output = usize;

    #[inline(always)]
    fn run<I: InstructionSet>(self) -> usize {
        self.fans.walk::<I>(self.start, &self.place, |_| ()).site
    }
}

/// A query on its way to its cell from the site that was found first, as an operation.
struct Answer<'a, C> {
    index: &'a Voronoi,
    found: Found,
    query: V3,
    place: V3,
    collector: &'a mut C,
    evaluate: EvaluateFn<'a, C>,
    finish: fn(&mut SearchState<'_, C>),
}

impl<C: Collector> SimdKernel for Answer<'_, C> {
    type Output = ();

    #[inline(always)]
    fn run<I: InstructionSet>(self) {
        let Self { index, found, place, .. } = self;
        let found = index.fans.walk::<I>(found.site, &place, |at| {
            self.collector.visit_node();
            index.prefetch_block(at);
        });
        index.tree.isa().run(InCell(Answer { found, ..self }));
    }
}

/// A query in its cell, as an operation of its own: it is compiled once, for single queries and for several.
struct InCell<'a, C>(Answer<'a, C>);

impl<C: Collector> SimdKernel for InCell<'_, C> {
    type Output = ();

    #[inline(always)]
    fn run<I: InstructionSet>(self) {
        let Answer { index, found, query, place, collector, evaluate, finish } = self.0;
        let tree = &index.tree;
        let site = &index.fans.sites[found.site];
        let reach = index.reach(site, &query, &place);
        let held = site.holder();
        if !site.has_list() {
            return tree.isa().run(Search { tree, query, reach, held, collector, evaluate, finish });
        }
        let certain = Voronoi::certain(&found, site, &place);
        if certain.is_none()
            && let Some(list) = index.filters.of(found.site)
        {
            let search = Search { tree, query, reach, held, collector, evaluate, finish };
            return search_filtered(InFilteredList { list, search });
        }
        // What comes next, if the list has more than a block.
        index.prefetch_block(site.list as usize);
        let mut filter = SearchState::new(tree, query, reach, collector, evaluate, finish);
        if let Some((packet, lane)) = certain {
            filter.add(packet, lane);
            return filter.evaluate_waiting();
        }
        filter.hold(held, reach);
        let (first, rest) = (&index.blocks[found.site], &index.blocks[site.list as usize..]);
        search::search::<I, C>(tree, first, rest, &in_frame(tree, &query), &mut filter);
        filter.evaluate_waiting();
    }
}

/// A query in the list of its cell, of which a filter chooses the primitives.
struct InFilteredList<'a, C> {
    list: &'a dyn ListFilter,
    search: Search<'a, Aabb<f64>, C>,
}

/// Searches a list that has a filter. This is a function of its own because few indexes have filters, and its code in the
/// search of the others would cost registers.
#[cold]
#[inline(never)]
fn search_filtered<C: Collector>(query: InFilteredList<'_, C>) {
    query.search.tree.isa().run(query);
}

impl<C: Collector> SimdKernel for InFilteredList<'_, C> {
    type Output = ();

    #[inline(always)]
    fn run<I: InstructionSet>(self) {
        let Self { list, search } = self;
        let Search { tree, query, reach, held, collector, evaluate, finish } = search;
        let mut filter = SearchState::new(tree, query, reach, collector, evaluate, finish);
        filter.hold(held, reach);
        for (packet, lanes) in Filters::packets(list, &query) {
            filter.packet::<I>(packet as usize, u32::from(lanes));
        }
        filter.evaluate_waiting();
    }
}

#[inline(always)]
fn in_frame(tree: &PacketTree, query: &V3) -> Place {
    let local = tree.frame.place(query);
    Place { rounded: Rounded::of(local), local, cells: [0.0; 3] }
}

/// Several queries side by side, as an operation.
struct Several<'a> {
    index: &'a Voronoi,
    queries: &'a [V3; SIDE_BY_SIDE],
    minimums: [&'a mut BestF64; SIDE_BY_SIDE],
    evaluates: [EvaluateFn<'a, BestF64>; SIDE_BY_SIDE],
}

impl SimdKernel for Several<'_> {
    type Output = ();

    #[inline(always)]
    fn run<I: InstructionSet>(self) {
        let Self { index, queries, minimums, evaluates } = self;
        let mut places = [None; SIDE_BY_SIDE];
        if let Some(locator) = &index.locator {
            for (to, query) in places.iter_mut().zip(queries) {
                *to = index.place(query);
                to.iter().for_each(|place| locator.prefetch(place));
            }
            places.iter().flatten().for_each(|place| locator.prefetch_more(place));
        }
        let mut ways: [Option<Found>; SIDE_BY_SIDE] = [None; SIDE_BY_SIDE];
        let mut walking = 0u32;
        for (i, (to, place)) in ways.iter_mut().zip(&places).enumerate() {
            let start = place.as_ref().and_then(|place| index.locator.as_ref()?.start(place));
            *to = start.map(|site| Found { site, is_nearest: false });
            if let Some(site) = start {
                index.fans.prefetch(site);
                walking |= 1 << i;
            }
        }
        while walking != 0 {
            let mut rest = walking;
            while rest != 0 {
                let i = rest.trailing_zeros() as usize;
                rest &= rest - 1;
                if let (Some(found), Some(place)) = (&mut ways[i], &places[i]) {
                    let (next, is_nearest) = index.fans.step::<I>(found.site, place);
                    if next == found.site {
                        found.is_nearest = is_nearest;
                        walking &= !(1 << i);
                        index.prefetch_answer(found, place);
                    } else {
                        found.site = next;
                        index.fans.prefetch(next);
                    }
                }
            }
        }
        for ((found, place), query) in ways.iter().zip(&places).zip(queries) {
            if let (Some(found), Some(place)) = (found, place) {
                index.prefetch_packets::<I>(found, query, place);
            }
        }
        let finish = finish_nearest;
        let (tree, isa) = (&index.tree, index.tree.isa());
        for (i, (minimum, evaluate)) in minimums.into_iter().zip(evaluates).enumerate() {
            let (query, collector) = (queries[i], minimum);
            match (ways[i], places[i]) {
                (Some(found), Some(place)) => {
                    isa.run(InCell(Answer { index, found, query, place, collector, evaluate, finish }));
                }
                _ => isa.run(Search { tree, query, reach: f64::INFINITY, held: None, collector, evaluate, finish }),
            }
        }
    }
}

impl Voronoi {
    /// Asks for what a query reads first in its cell.
    #[inline(always)]
    fn prefetch_answer(&self, found: &Found, place: &V3) {
        let site = &self.fans.sites[found.site];
        if let Some((packet, _)) = Self::certain(found, site, place) {
            self.tree.leaves.prefetch(packet);
        } else if site.has_list() {
            self.prefetch_block(found.site);
            self.prefetch_block(site.list as usize);
        }
    }

    /// Asks for the packets and vertices that come after that.
    #[inline(always)]
    fn prefetch_packets<I: InstructionSet>(&self, found: &Found, query: &V3, place: &V3) {
        let (tree, site) = (&self.tree, &self.fans.sites[found.site]);
        if let Some((packet, lane)) = Self::certain(found, site, place) {
            tree.leaves.packets[packet].prefetch_vertices(lane, &tree.leaves.vertices);
        } else if site.has_list() {
            search::prefetch::<I>(tree, &self.blocks[found.site], &in_frame(tree, query));
        }
    }
}
