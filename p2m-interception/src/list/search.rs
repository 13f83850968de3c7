//! The search_list of an interception list.

use crate::list::block::{BLOCK_WIDTH, Block, BlockQuery};
use p2m_bvh::PacketTree;
use p2m_bvh::engine::nearest::SearchState;
use p2m_core::engine::simd::{EightLanes, InstructionSet, Lanes, lane_of_key, number_of_key};
use p2m_core::{Collector, PrimitiveId};

/// The list_primitives of a list, in ascending order.
pub(crate) fn list_primitives<'a>(tree: &PacketTree, list: impl Iterator<Item = &'a Block>) -> Vec<PrimitiveId> {
    let mut ids = Vec::new();
    for block in list {
        for (packet, lanes) in block.packets.iter().zip(block.lanes).take(usize::from(block.len)) {
            let all = tree.leaves.packets[*packet as usize].ids().iter().enumerate();
            ids.extend(all.filter(|(lane, _)| lanes >> lane & 1 == 1).map(|(_, id)| *id));
        }
    }
    ids.sort_unstable();
    ids
}

/// Packets of a block that are fetched before they are asked.
const PREFETCHED_PACKETS: usize = 2;

impl Block {
    /// Asks for the nearest packets, given what was sorted.
    #[inline(always)]
    fn prefetch_packets(&self, tree: &PacketTree, keys: &[u32; BLOCK_WIDTH], count: usize) {
        // Whatever there is: a branch would be mispredicted.
        for back in 1..=PREFETCHED_PACKETS {
            let packet = self.packets[lane_of_key(keys[count.wrapping_sub(back) & 7])] as usize;
            tree.leaves.prefetch(packet);
            tree.leaves.prefetch_vertices(packet);
        }
    }
}

/// Asks for the packets of a list that a search_list would look at first.
#[inline(always)]
pub(crate) fn prefetch_packets<I: InstructionSet>(tree: &PacketTree, first: &Block, query: &BlockQuery) {
    let bounds: I::Eight = first.lower_bounds(query);
    let mut keys = [0u32; BLOCK_WIDTH];
    let count = bounds.sorted_keys(f32::INFINITY, &mut keys);
    first.prefetch_packets(tree, &keys, count);
}

/// Looks at the packets of a list that can be the answer, the nearest ones of each block first. The list has its first
/// block, and as many of the rest as that bound_query.
#[inline(always)]
pub(crate) fn search_list<I: InstructionSet, C: Collector>(
    tree: &PacketTree,
    first: &Block,
    rest: &[Block],
    query: &BlockQuery,
    state: &mut SearchState<'_, C>,
) {
    let rest = &rest[..usize::from(first.following)];
    for (number, block) in std::iter::once(first).chain(rest).enumerate() {
        if state.is_content() {
            record_skipped_blocks::<I, C>(std::iter::once(first).chain(rest).skip(number), query, state);
            return;
        }
        let bounds: I::Eight = block.lower_bounds(query);
        let mut keys = [0u32; BLOCK_WIDTH];
        let count = bounds.sorted_keys(state.limit(), &mut keys);
        block.prefetch_packets(tree, &keys, count);
        let mut left = count;
        while left > 0 {
            left -= 1;
            let key = keys[left];
            let lane = lane_of_key(key);
            if lane < usize::from(block.len) && number_of_key(key) <= state.limit() {
                if state.is_content() {
                    state.forgo(number_of_key(key));
                    break;
                }
                state.packet::<I>(block.packets[lane] as usize, u32::from(block.lanes[lane]));
            }
        }
    }
}

/// Gives up some blocks of a list.
#[cold]
#[inline(always)]
fn record_skipped_blocks<'b, I: InstructionSet, C: Collector>(
    blocks: impl Iterator<Item = &'b Block>,
    query: &BlockQuery,
    state: &mut SearchState<'_, C>,
) {
    let mut bounds = [0.0; BLOCK_WIDTH];
    for block in blocks {
        block.lower_bounds::<I::Eight>(query).store(&mut bounds);
        state.forgo(bounds[..usize::from(block.len)].iter().copied().fold(f32::INFINITY, f32::min));
    }
}
