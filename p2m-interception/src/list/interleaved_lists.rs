//! The search of the lists of several queries in turns.
//!
//! The basic idea is that in each round every query visits one packet. A single search waits for memory at each packet,
//! and mispredicts whether the packet is near enough. In a round, the reads of all queries overlap, and arithmetic
//! replaces the branches:
//!
//! ```text
//! while cursors are left:
//!     bound and sort the packets of each block that has been opened
//!     for each cursor: take the nearest packet of its block
//!         if the packet is within the limit of its query, visit it in this round
//!         else open the next block, because the other packets of this block are farther still
//!     filter all packets of the round together
//!     keep the cursors that have packets or blocks left
//! ```

use crate::list::block::{BLOCK_WIDTH, Block, BlockQuery};
use p2m_bvh::PacketTree;
use p2m_bvh::engine::interleaved::{InterleavedSearch, PacketVisit, SEARCHES};
use p2m_core::engine::simd::{EightLanes, InstructionSet, lane_of_key, value_of_key};

/// The position of a search in its list.
#[derive(Clone, Copy, Default)]
struct Cursor {
    search: u32,
    /// The number of the block that is searched, and of the next one.
    block: u32,
    next: u32,
    /// The number of blocks after that.
    following: u32,
    /// The sorted lower bounds of the packets of the block, of which the first `left` were not visited.
    keys: [u32; BLOCK_WIDTH],
    left: u32,
    query: BlockQuery,
}

/// A SIMD kernel that searches a partition for several queries in turns. Each partition implements it.
pub(crate) struct SearchInterleaved<'a, 'b, P> {
    pub(crate) partition: &'a P,
    /// The number of searches of `several` that have begun.
    pub(crate) count: usize,
    pub(crate) several: &'a mut InterleavedSearch<'b>,
    pub(crate) lists: &'a mut InterleavedLists,
}

/// The lists that several queries search. It is large, so a batch makes one and uses it for all of its queries.
#[derive(Default)]
pub(crate) struct InterleavedLists {
    cursors: [Cursor; SEARCHES],
    len: usize,
}

impl InterleavedLists {
    /// Removes all lists.
    #[inline(always)]
    pub(crate) fn clear(&mut self) {
        self.len = 0;
    }

    /// Adds the list of a search, which begins at block `first` and goes on at block `next`.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "fewer than 2^32 blocks")]
    pub(crate) fn push(&mut self, search: usize, first: usize, next: usize, query: BlockQuery) {
        let cursor = &mut self.cursors[self.len];
        (cursor.search, cursor.block, cursor.next, cursor.query) = (search as u32, first as u32, next as u32, query);
        self.len += 1;
    }

    /// Searches all lists.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "at most sixteen searches")]
    pub(crate) fn search<I: InstructionSet>(
        &mut self,
        tree: &PacketTree,
        blocks: &[Block],
        several: &mut InterleavedSearch<'_>,
    ) {
        // The first `count` entries of `active` are the cursors of lists that were not searched to their ends, and the
        // first `opening` entries of `opened` are those whose next block has to be bounded.
        let (mut active, mut opened) = ([0u8; SEARCHES], [0u8; SEARCHES]);
        let (mut count, mut opening) = (self.len, self.len);
        for i in 0..count {
            (active[i], opened[i]) = (i as u8, i as u8);
            let cursor = &mut self.cursors[i];
            cursor.following = u32::from(blocks[cursor.block as usize].following);
        }
        let mut visits = [PacketVisit::default(); SEARCHES];
        while count > 0 {
            for &i in &opened[..opening] {
                let cursor = &mut self.cursors[usize::from(i) % SEARCHES];
                Self::bound::<I>(tree, &blocks[cursor.block as usize], cursor, several);
            }
            // Each search takes its nearest packet. No branch depends on whether it has one.
            let (mut visit_count, mut still_active) = (0, 0);
            opening = 0;
            for at in 0..count {
                let i = active[at];
                let cursor = &mut self.cursors[usize::from(i) % SEARCHES];
                let search = cursor.search;
                let left = cursor.left.wrapping_sub(1);
                let key = cursor.keys[left as usize % BLOCK_WIDTH];
                let lane = lane_of_key(key);
                let block = &blocks[cursor.block as usize];
                let is_within = (cursor.left > 0) & (value_of_key(key) <= several.limit(search as usize));
                visits[visit_count % SEARCHES] =
                    PacketVisit { search, packet: block.packets[lane], lanes: u32::from(block.lanes[lane]) };
                visit_count += usize::from(is_within);
                cursor.left = left;
                let opens_next = !is_within & (cursor.following > 0);
                cursor.block = if opens_next { cursor.next } else { cursor.block };
                cursor.next += u32::from(opens_next);
                cursor.following -= u32::from(opens_next);
                opened[opening % SEARCHES] = i;
                opening += usize::from(opens_next);
                active[still_active % SEARCHES] = i;
                still_active += usize::from((is_within & ((left > 0) | (cursor.following > 0))) | opens_next);
            }
            several.filter::<I, false>(&visits[..visit_count]);
            count = still_active;
        }
    }

    /// Bounds the packets of the block of a cursor.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "at most eight")]
    fn bound<I: InstructionSet>(
        tree: &PacketTree,
        block: &Block,
        cursor: &mut Cursor,
        several: &InterleavedSearch<'_>,
    ) {
        let bounds: I::F32x8 = block.lower_bounds_of_used(&cursor.query);
        cursor.left = bounds.sorted_keys(several.limit(cursor.search as usize), &mut cursor.keys) as u32;
        let nearest = cursor.keys[cursor.left.wrapping_sub(1) as usize & 7];
        tree.leaves.prefetch(block.packets[lane_of_key(nearest)] as usize);
    }
}
