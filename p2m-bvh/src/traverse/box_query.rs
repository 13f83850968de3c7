//! Box queries.

use crate::traverse::STACK_LEN;
use crate::tree::PacketTree;
use crate::tree::node_ref::NodeRef;
use crate::tree::wide_node::{VolumeNodes, WideNode};
use p2m_core::{Aabb, PrimitiveId};
use std::ops::ControlFlow;

impl<V: VolumeNodes> PacketTree<V> {
    /// Visits the primitives that intersect a box, in the order of the leaves, until `visit` breaks.
    ///
    /// `intersects` returns whether a primitive intersects the box. It is called only if the boxes of nodes do not
    /// decide that.
    ///
    /// # Complexity
    /// O(log n + k) nodes expected for k primitives in a compact box, O(n) at worst. There is no allocation and no
    /// recursion.
    pub fn visit_box(
        &self,
        bounds: &Aabb<f64>,
        intersects: impl Fn(PrimitiveId) -> bool,
        visit: &mut dyn FnMut(PrimitiveId) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        if bounds.is_empty() {
            return ControlFlow::Continue(());
        }
        // Each entry is a child, and whether it is known to lie in the box.
        let mut stack = [(self.root, false); STACK_LEN];
        let mut len = usize::from(self.root != NodeRef::NONE);
        while len > 0 {
            len -= 1;
            let (child, is_inside) = stack[len];
            if child.is_packet() {
                for packet in self.leaves.run(child.number()) {
                    let ids = packet.ids().iter();
                    ids.filter(|id| is_inside || intersects(**id)).copied().try_for_each(&mut *visit)?;
                }
                continue;
            }
            let node = &self.nodes[child.number()];
            for slot in node.used_slots() {
                let child_bounds = node.bounds(slot);
                let child_box = V::Node::scene_box(&child_bounds, &self.shared, &self.frame);
                let is_inside = is_inside || bounds.contains(&child_box);
                if is_inside
                    || (bounds.intersects(&child_box)
                        && V::Node::may_intersect_box(&child_bounds, &self.shared, &self.frame, bounds))
                {
                    stack[len] = (node.children()[slot], is_inside);
                    len += 1;
                }
            }
        }
        ControlFlow::Continue(())
    }
}
