//! Box queries and the way down to one leaf.

use crate::traverse::STACK;
use crate::tree::PacketTree;
use crate::tree::aabb_node::NodeRef;
use crate::tree::volume::{Volume, WideNode};
use nalgebra::Point3;
use p2m_core::{Aabb, PrimitiveId};
use std::ops::ControlFlow;

impl<V: Volume> PacketTree<V> {
    /// QueryCost the primitives that meet a box, in the order of the leaves, until `visit` breaks. `meets` tells whether a
    /// primitive does, which is asked only where the box of a node or packet does not tell.
    ///
    /// # Complexity
    /// O(log n + k) nodes expected for k primitives in a compact box, O(n) at worst. No allocation, no recursion.
    pub fn visit_box(
        &self,
        bounds: &Aabb<f64>,
        meets: impl Fn(PrimitiveId) -> bool,
        visit: &mut dyn FnMut(PrimitiveId) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        if bounds.is_empty() {
            return ControlFlow::Continue(());
        }
        // Children, and whether they are known from above to lie in the box.
        let mut stack = [(self.root, false); STACK];
        let mut waiting = usize::from(self.root != NodeRef::NONE);
        while waiting > 0 {
            waiting -= 1;
            let (child, inside) = stack[waiting];
            if child.is_packet() {
                let ids = self.leaves.packets[child.number()].ids();
                ids.iter().filter(|id| inside || meets(**id)).copied().try_for_each(&mut *visit)?;
                continue;
            }
            let node = &self.nodes[child.number()];
            for place in node.used() {
                let enclosed = node.at(place);
                let own = V::Node::disclose(&enclosed, &self.shape, &self.frame);
                let inside = inside || bounds.contains(&own);
                if inside || (bounds.meets(&own) && V::Node::may_meet(&enclosed, &self.shape, &self.frame, bounds)) {
                    stack[waiting] = (node.children()[place], inside);
                    waiting += 1;
                }
            }
        }
        ControlFlow::Continue(())
    }

    /// Goes down from the root to a leaf, to the child with the least lower bound each time, and returns the primitives
    /// of that leaf; `aside` is told the bounds of all other children. Nothing for an empty set.
    ///
    /// # Complexity
    /// O(depth).
    pub fn nearest_leaf(&self, query: &Point3<f64>, mut aside: impl FnMut(f64)) -> &[PrimitiveId] {
        let mut at = self.root;
        while at != NodeRef::NONE && !at.is_packet() {
            let mut nearest = (f64::INFINITY, NodeRef::NONE);
            for (bounds, child) in self.child_boxes(at) {
                let bound = bounds.lower_bound(query);
                let farther = if bound < nearest.0 || nearest.1 == NodeRef::NONE {
                    std::mem::replace(&mut nearest, (bound, child))
                } else {
                    (bound, child)
                };
                if farther.1 != NodeRef::NONE {
                    aside(farther.0);
                }
            }
            at = nearest.1;
        }
        if at == NodeRef::NONE { &[] } else { self.leaves.packets[at.number()].ids() }
    }
}
