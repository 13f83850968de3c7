//! Nearest-first search.

use super::{Hierarchy, MAX_DEPTH};
use crate::{Collector, PrimitiveId};

impl<V> Hierarchy<V> {
    /// Visits, nearest first, every leaf whose lower bound does not exceed what `collector` still wants.
    ///
    /// `lower_bound` is that of a volume, as a square; `leaf` offers a primitive to the collector. The farther child of a
    /// node waits on a stack with its bound, which is compared again when its turn comes.
    ///
    /// # Complexity
    /// O(log n) nodes expected for queries near well-separated primitives, O(n) at worst (all primitives at the same
    /// distance). No allocation, no recursion.
    #[inline(always)]
    pub fn search<C: Collector>(
        &self,
        collector: &mut C,
        lower_bound: impl Fn(&V) -> f64,
        leaf: impl Fn(&mut C, PrimitiveId),
    ) {
        if self.nodes.is_empty() {
            return;
        }
        let mut stack = [(0.0f64, 0usize); MAX_DEPTH];
        let mut waiting = 0;
        let mut at = 0;
        loop {
            collector.visit_node();
            let node = &self.nodes[at];
            if let Some([a, b]) = node.children() {
                let (bound_a, bound_b) = (lower_bound(&self.nodes[a].volume), lower_bound(&self.nodes[b].volume));
                // Which child is nearer is a coin toss: selected, not branched on. Siblings lie side by side.
                let swap = bound_b < bound_a;
                let (near_bound, far_bound) = if swap { (bound_b, bound_a) } else { (bound_a, bound_b) };
                let (near, far) = (a + usize::from(swap), b - usize::from(swap));
                let limit = collector.prune_above();
                // One entry for each level above, at most; one that is not wanted is overwritten.
                stack[waiting] = (far_bound, far);
                waiting += usize::from(far_bound <= limit);
                if near_bound <= limit {
                    at = near;
                    continue;
                }
            } else {
                for &id in &self.order[node.places()] {
                    leaf(collector, id);
                }
            }
            // The next node that is still of interest.
            let limit = collector.prune_above();
            loop {
                if waiting == 0 {
                    return;
                }
                waiting -= 1;
                let (bound, node) = stack[waiting];
                if bound <= limit {
                    at = node;
                    break;
                }
            }
        }
    }
}
