//! Visiting what overlaps a region.

use super::{Hierarchy, MAX_DEPTH};
use crate::PrimitiveId;
use std::ops::ControlFlow;

/// How the volume of a node lies to a region.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Overlap {
    /// Nothing in common: what is below the node is skipped.
    None,
    /// Perhaps: what is below the node is looked at.
    Some,
    /// The volume lies in the region: everything below the node does.
    All,
}

impl<V> Hierarchy<V> {
    /// Visits the primitives that overlap a region, in the order of the leaves, until `visit` breaks.
    ///
    /// `of_volume` tells how a volume lies to the region, `of_primitive` whether a primitive meets it, which is asked only
    /// where a volume does not tell.
    ///
    /// # Complexity
    /// O(log n + k) nodes expected for k primitives in a compact region, O(n) at worst. No allocation, no recursion.
    pub fn visit_overlapping(
        &self,
        of_volume: impl Fn(&V) -> Overlap,
        of_primitive: impl Fn(PrimitiveId) -> bool,
        visit: &mut dyn FnMut(PrimitiveId) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        if self.nodes.is_empty() {
            return ControlFlow::Continue(());
        }
        // One entry for each level, and one more for the second child of the last. Whether a node is known to lie in the
        // region is known from above.
        let mut stack = [(0usize, false); MAX_DEPTH + 1];
        let mut waiting = 1;
        while waiting > 0 {
            waiting -= 1;
            let (at, known) = stack[waiting];
            let node = &self.nodes[at];
            let overlap = if known { Overlap::All } else { of_volume(&node.volume) };
            if overlap == Overlap::None {
                continue;
            }
            let known = overlap == Overlap::All;
            if let Some([a, b]) = node.children() {
                stack[waiting] = (b, known);
                stack[waiting + 1] = (a, known);
                waiting += 2;
            } else {
                self.order[node.places()]
                    .iter()
                    .filter(|id| known || of_primitive(**id))
                    .copied()
                    .try_for_each(&mut *visit)?;
            }
        }
        ControlFlow::Continue(())
    }

    /// Goes down from the root to a leaf, to the child with the lower bound each time, and returns the primitives of that
    /// leaf; `aside` is told the bound of every other child. Nothing for an empty set.
    ///
    /// # Complexity
    /// O(depth).
    pub fn nearest_leaf(&self, lower_bound: impl Fn(&V) -> f64, mut aside: impl FnMut(f64)) -> &[PrimitiveId] {
        let Some(mut node) = self.nodes.first() else { return &[] };
        while let Some([a, b]) = node.children() {
            let (bound_a, bound_b) = (lower_bound(&self.nodes[a].volume), lower_bound(&self.nodes[b].volume));
            let (near, far_bound) = if bound_b < bound_a { (b, bound_a) } else { (a, bound_b) };
            aside(far_bound);
            node = &self.nodes[near];
        }
        &self.order[node.places()]
    }
}
