//! The search of an octree: a query descends to its leaf and searches the list of the leaf.

use crate::list::block::{Block, BlockQuery, MAX_LEVEL};
use crate::list::interleaved_lists::{InterleavedLists, SearchInterleaved};
use crate::list::search;
use crate::octree::Octree;
use crate::octree::code::{CellCode, FALLBACK_CODE, KIND_LIST, KIND_ONE_LEVEL, KIND_SHIFT, KIND_SINGLE};
use crate::partition::{CellQuery, are_lists_enough};
use nalgebra::Point3;
use p2m_bvh::engine::interleaved::InterleavedSearch;
use p2m_bvh::engine::nearest::{EvaluateFn, SearchState, finish, finish_nearest};
use p2m_bvh::engine::packet::LANES;
use p2m_bvh::engine::volume::Rounded;
use p2m_core::engine::query::BestF64;
use p2m_core::engine::real::to_f64_array;
use p2m_core::engine::simd::{InstructionSet, SimdKernel, prefetch_lines};
use p2m_core::engine::vector::V3;
use p2m_core::{Collector, Near};

impl Octree {
    /// Returns the code of the leaf at a position, which is given in units of the cells of [`MAX_LEVEL`].
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the cube")]
    fn locate_code(&self, position: &V3) -> u32 {
        let cells = f64::from(1u32 << MAX_LEVEL);
        let mut at = [0u32; 3];
        for k in 0..3 {
            // The comparison is false if a coordinate is NaN, so the tree answers.
            if !(position[k] >= 0.0 && position[k] < cells) {
                return FALLBACK_CODE;
            }
            at[k] = position[k] as u32;
        }
        let mut shift = MAX_LEVEL;
        let mut code = self.root;
        while code < KIND_LIST << KIND_SHIFT {
            let row = (code & !(KIND_ONE_LEVEL << KIND_SHIFT)) as usize;
            if code < KIND_ONE_LEVEL << KIND_SHIFT {
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

    /// Returns the code of the leaf that contains a query point, and the point in units of the cells of [`MAX_LEVEL`].
    #[inline(always)]
    pub(crate) fn locate_cell(&self, query: &V3) -> (u32, V3) {
        let cells: V3 = std::array::from_fn(|k| (query[k] - self.low[k]) * self.cells_per_length);
        (self.locate_code(&cells), cells)
    }

    /// Returns the number of packets in the list of the cell that contains a point. It is 1 if one primitive is the
    /// nearest everywhere in the cell, and `None` if the tree answers.
    #[must_use]
    pub fn list_length(&self, point: &Point3<f64>) -> Option<usize> {
        let code = self.locate_cell(&to_f64_array(point)).0;
        match CellCode::decode(code) {
            CellCode::Single(..) => Some(1),
            CellCode::List(first) => {
                let blocks = &self.blocks[first..=first + usize::from(self.blocks[first].following)];
                Some(blocks.iter().map(|block| usize::from(block.len)).sum())
            }
            CellCode::Rows | CellCode::Tree => None,
        }
    }
}

impl CellQuery for Octree {
    #[inline(always)]
    fn query_with<C: Collector>(
        &self,
        query: V3,
        collector: &mut C,
        evaluate: EvaluateFn<'_, C>,
        finish: fn(&mut SearchState<'_, C>),
    ) {
        let tree = &self.tree;
        let (code, cells) = self.locate_cell(&query);
        match tree.frame.local(&query) {
            Some(local) if code != FALLBACK_CODE && are_lists_enough(collector) => {
                let block_query = BlockQuery { rounded: Rounded::of(local), local, cells };
                tree.isa().run(SearchCell { octree: self, code, query, block_query, collector, evaluate, finish });
            }
            _ => tree.run(query, collector, evaluate, finish),
        }
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

impl SimdKernel for SearchInterleaved<'_, '_, Octree> {
    type Output = ();

    #[inline(always)]
    fn run<I: InstructionSet>(self) {
        let Self { partition: octree, count, several, lists } = self;
        let tree = &octree.tree;
        lists.clear();
        for i in 0..count {
            let query = *several.query(i);
            let (code, cells) = octree.locate_cell(&query);
            let local = tree.frame.local(&query);
            let number = (code & !(7 << KIND_SHIFT)) as usize;
            match (code >> KIND_SHIFT, local) {
                (KIND_SINGLE, Some(_)) => {
                    let (packet, lane) = (number / LANES, number % LANES);
                    tree.leaves.prefetch(packet);
                    several.add(i, packet, lane);
                }
                (KIND_LIST, Some(local)) => {
                    prefetch_lines(octree.blocks.as_ptr().wrapping_add(number), size_of::<Block>());
                    lists.push(i, number, number + 1, BlockQuery { rounded: Rounded::of(local), local, cells });
                }
                _ => several.search_tree(i),
            }
        }
        lists.search::<I>(tree, &octree.blocks, several);
        several.evaluate_candidates();
    }
}

/// A SIMD kernel that searches the leaf of a query.
struct SearchCell<'a, C> {
    octree: &'a Octree,
    code: u32,
    query: V3,
    block_query: BlockQuery,
    collector: &'a mut C,
    evaluate: EvaluateFn<'a, C>,
    finish: fn(&mut SearchState<'_, C>),
}

impl<C: Collector> SimdKernel for SearchCell<'_, C> {
    type Output = ();

    #[inline(always)]
    fn run<I: InstructionSet>(self) {
        let octree = self.octree;
        let tree = &octree.tree;
        let number = (self.code & !(7 << KIND_SHIFT)) as usize;
        let mut state = SearchState::new(tree, self.query, f64::INFINITY, self.collector, self.evaluate, self.finish);
        if self.code >> KIND_SHIFT == KIND_SINGLE {
            state.add(number / LANES, number % LANES);
            return state.evaluate_pending();
        }
        // The second block is prefetched as well, because the list may have more than one.
        prefetch_lines(octree.blocks.as_ptr().wrapping_add(number), 2 * size_of::<Block>());
        let (first, rest) = (&octree.blocks[number], &octree.blocks[number + 1..]);
        search::search_list::<I, C>(tree, first, rest, &self.block_query, &mut state);
        state.evaluate_pending();
    }
}
