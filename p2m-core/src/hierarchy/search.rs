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
                // A branch, although a coin toss: half of the time the nearer child is being fetched before its bound is known,
                // which is worth more on large scenes than what the other half costs.
                let ((near, near_bound), (far, far_bound)) =
                    if bound_b < bound_a { ((b, bound_b), (a, bound_a)) } else { ((a, bound_a), (b, bound_b)) };
                let limit = collector.prune_above();
                if far_bound <= limit {
                    // One entry for each level above, at most.
                    stack[waiting] = (far_bound, far);
                    waiting += 1;
                }
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
