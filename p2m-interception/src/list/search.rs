//! The search of an interception list, and the primitives in one.

use crate::list::block::{BLOCK_WIDTH, Block, BlockQuery};
use p2m_bvh::PacketTree;
use p2m_bvh::engine::nearest::SearchState;
use p2m_core::engine::simd::{EightLanes, InstructionSet, Lanes, lane_of_key, value_of_key};
use p2m_core::{Collector, PrimitiveId};

/// Returns the primitives of a list in ascending order.
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

/// The number of packets of a block that are prefetched before their filters run.
const PREFETCHED_PACKETS: usize = 2;

impl Block {
    /// Prefetches the nearest packets of the block, given the sorted lower bounds.
    #[inline(always)]
    fn prefetch_packets(&self, tree: &PacketTree, keys: &[u32; BLOCK_WIDTH], count: usize) {
        // The loop prefetches even if fewer packets are left, because a branch would be mispredicted.
        for back in 1..=PREFETCHED_PACKETS {
            let packet = self.packets[lane_of_key(keys[count.wrapping_sub(back) & 7])] as usize;
            tree.leaves.prefetch(packet);
            tree.leaves.prefetch_vertices(packet);
        }
    }
}

/// Searches a list. Passes the packets that can hold the answer to `state`, the nearest ones of each block first.
/// `rest` begins with the blocks that follow `first` in the list and may be longer.
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
        if state.may_stop() {
            record_skipped_blocks::<I, C>(std::iter::once(first).chain(rest).skip(number), query, state);
            return;
        }
        let bounds: I::F32x8 = block.lower_bounds(query);
        let mut keys = [0u32; BLOCK_WIDTH];
        let count = bounds.sorted_keys(state.limit(), &mut keys);
        block.prefetch_packets(tree, &keys, count);
        let mut left = count;
        while left > 0 {
            left -= 1;
            let key = keys[left];
            let lane = lane_of_key(key);
            if lane < usize::from(block.len) && value_of_key(key) <= state.limit() {
                if state.may_stop() {
                    state.record_skipped(value_of_key(key));
                    break;
                }
                state.packet::<I>(block.packets[lane] as usize, u32::from(block.lanes[lane]));
            }
        }
    }
}

/// Reports the lower bound of each block to the collector, for blocks that a search skips because it stops early.
#[cold]
#[inline(always)]
fn record_skipped_blocks<'b, I: InstructionSet, C: Collector>(
    blocks: impl Iterator<Item = &'b Block>,
    query: &BlockQuery,
    state: &mut SearchState<'_, C>,
) {
    let mut bounds = [0.0; BLOCK_WIDTH];
    for block in blocks {
        block.lower_bounds::<I::F32x8>(query).store(&mut bounds);
        state.record_skipped(bounds[..usize::from(block.len)].iter().copied().fold(f32::INFINITY, f32::min));
    }
}
