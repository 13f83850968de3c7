//! What may meet a ball: the lanes of all packets, by their filters.

use super::PacketTree;
use super::volume::{Volume, WideNode};
use super::walk::{Walk, walk};
use crate::packet::{LANES, ROUND_UP, at_most};
use crate::simd::{InstructionSet, Lanes, Operation};
use std::ops::ControlFlow;

/// Some lanes of a packet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Selection {
    pub(crate) packet: u32,
    pub(crate) lanes: u16,
}

impl<V: Volume> PacketTree<V> {
    /// Adds the lanes that may be at most `radius` away from a point to `found`, none that is nearer being left out:
    /// those of at most `most` packets. `false` if there are more, or if f32 cannot place the point.
    pub(crate) fn ball(&self, centre: [f64; 3], radius: f64, most: usize, found: &mut Vec<Selection>) -> bool {
        let Some(local) = V::Node::query(&self.shape, &self.frame, &centre) else { return false };
        let limit = self.frame.square_above(radius * radius * (1.0 + 4.0 * f64::EPSILON));
        self.isa.run(Ball { tree: self, local, centre, radius, limit, most, full: false, found })
    }
}

struct Ball<'a, V: Volume> {
    tree: &'a PacketTree<V>,
    local: <V::Node as WideNode>::Query,
    centre: [f64; 3],
    radius: f64,
    limit: f32,
    /// So many packets more may be found.
    most: usize,
    /// There are more.
    full: bool,
    found: &'a mut Vec<Selection>,
}

impl<V: Volume> Operation for Ball<'_, V> {
    type Output = bool;

    #[inline(always)]
    fn run<I: InstructionSet>(mut self) -> bool {
        walk::<I, V, _>(self.tree, &mut self);
        !self.full
    }
}

impl<V: Volume> Walk<V> for Ball<'_, V> {
    #[inline(always)]
    fn bounds<L: Lanes>(&self, node: &V::Node) -> L {
        node.lower_bounds(&self.tree.shape, &self.local)
    }
    #[inline(always)]
    fn limit(&self) -> f32 {
        self.limit
    }
    #[inline(always)]
    fn visit_node(&mut self) {}
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "rounded up; sixteen lanes")]
    fn visit_packet<I: InstructionSet>(&mut self, number: usize) -> ControlFlow<()> {
        let packet = &self.tree.leaves.packets[number];
        let lanes = match packet.local(&self.centre) {
            None => packet.lanes(),
            Some(local) => {
                let limit = ((self.radius * packet.per_unit()) as f32 + local.excess) * ROUND_UP;
                let mut squares = [0.0; LANES];
                packet.squares::<I>(&local, limit, &mut squares);
                at_most::<I::Wide>(&squares, limit * limit * ROUND_UP) & packet.lanes()
            }
        };
        if lanes != 0 {
            let Some(rest) = self.most.checked_sub(1) else {
                self.full = true;
                return ControlFlow::Break(());
            };
            self.most = rest;
            self.found.push(Selection { packet: number as u32, lanes: lanes as u16 });
        }
        ControlFlow::Continue(())
    }
}
