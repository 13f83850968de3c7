//! The search of an interception list.

use crate::list::block::{Block, Place, WIDTH};
use p2m_bvh::PacketTree;
use p2m_bvh::engine::nearest::SearchState;
use p2m_core::engine::simd::{EightLanes, InstructionSet, Lanes, lane_of_key, number_of_key};
use p2m_core::{Collector, PrimitiveId};

/// The primitives of a list, in ascending order.
pub(crate) fn primitives<'a>(tree: &PacketTree, list: impl Iterator<Item = &'a Block>) -> Vec<PrimitiveId> {
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
const PREFETCHED: usize = 2;

impl Block {
    /// Asks for the nearest packets, given what was sorted.
    #[inline(always)]
    fn prefetch(&self, tree: &PacketTree, keys: &[u32; WIDTH], count: usize) {
        // Whatever there is: a branch would be mispredicted.
        for back in 1..=PREFETCHED {
            let packet = self.packets[lane_of_key(keys[count.wrapping_sub(back) & 7])] as usize;
            tree.leaves.prefetch(packet);
            tree.leaves.prefetch_vertices(packet);
        }
    }
}

/// Asks for the packets of a list that a search would look at first.
#[inline(always)]
pub(crate) fn prefetch<I: InstructionSet>(tree: &PacketTree, first: &Block, place: &Place) {
    let bounds: I::Eight = first.lower_bounds(place);
    let mut keys = [0u32; WIDTH];
    let count = bounds.sorted_keys(f32::INFINITY, &mut keys);
    first.prefetch(tree, &keys, count);
}

/// Looks at the packets of a list that can be the answer, the nearest ones of each block first. The list has its first
/// block, and as many of the rest as that says.
#[inline(always)]
pub(crate) fn search<I: InstructionSet, C: Collector>(
    tree: &PacketTree,
    first: &Block,
    rest: &[Block],
    place: &Place,
    filter: &mut SearchState<'_, C>,
) {
    let rest = &rest[..usize::from(first.more)];
    for (number, block) in std::iter::once(first).chain(rest).enumerate() {
        if filter.is_content() {
            forgo::<I, C>(std::iter::once(first).chain(rest).skip(number), place, filter);
            return;
        }
        let bounds: I::Eight = block.lower_bounds(place);
        let mut keys = [0u32; WIDTH];
        let count = bounds.sorted_keys(filter.limit(), &mut keys);
        block.prefetch(tree, &keys, count);
        let mut left = count;
        while left > 0 {
            left -= 1;
            let key = keys[left];
            let lane = lane_of_key(key);
            if lane < usize::from(block.len) && number_of_key(key) <= filter.limit() {
                if filter.is_content() {
                    filter.forgo(number_of_key(key));
                    break;
                }
                filter.packet::<I>(block.packets[lane] as usize, u32::from(block.lanes[lane]));
            }
        }
    }
}

/// Gives up some blocks of a list.
#[cold]
#[inline(always)]
fn forgo<'b, I: InstructionSet, C: Collector>(
    blocks: impl Iterator<Item = &'b Block>,
    place: &Place,
    filter: &mut SearchState<'_, C>,
) {
    let mut bounds = [0.0; WIDTH];
    for block in blocks {
        block.lower_bounds::<I::Eight>(place).store(&mut bounds);
        filter.forgo(bounds[..usize::from(block.len)].iter().copied().fold(f32::INFINITY, f32::min));
    }
}
