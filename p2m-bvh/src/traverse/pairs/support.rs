//! Extents of nodes along the direction of the best pair, from their vertices.

use super::Place;
use super::side::PairSide;
use crate::tree::PacketTree;
use crate::tree::height::Height;
use crate::tree::node_ref::{NodeRef, WIDTH};
use crate::tree::wide_node::{VolumeNodes, WideNode};
use p2m_core::engine::simd::{InstructionSet, Lanes, SimdKernel};
use p2m_core::engine::vector::{V3, dot};
use p2m_core::pair::Pairs;
use std::collections::HashMap;

/// The extents of nodes along the direction of the best pair, as far as they were needed.
pub(super) struct Supports {
    /// The margin of heights; `None` if heights are not used.
    pub(super) margin: Option<f64>,
    pub(super) direction: Option<V3>,
    /// The largest heights of nodes of the first side, and those of the second along the opposite direction.
    known: [HashMap<u32, f64>; 2],
}

impl Supports {
    pub(super) fn new(margin: Option<f64>) -> Self {
        Self { margin, direction: None, known: [HashMap::new(), HashMap::new()] }
    }

    /// Takes the direction of the best pair.
    pub(super) fn follow(&mut self, pairs: &Pairs<'_>) {
        if self.margin.is_none() {
            return;
        }
        let Some(separation) = pairs.separation() else { return };
        let length = dot(separation, separation).sqrt();
        let direction = (length > 1e-150 && length < 1e150).then(|| separation.map(|x| x / length));
        if direction != self.direction {
            self.direction = direction;
            self.known.iter_mut().for_each(HashMap::clear);
        }
    }

    /// Returns whether the extents of two nodes are near enough.
    pub(super) fn is_near(&mut self, sides: [&dyn PairSide; 2], places: &[Place; 2], prune: f64) -> bool {
        let (Some(margin), Some(direction)) = (self.margin, self.direction) else { return true };
        let mut height = |i: usize, direction: V3| {
            *self.known[i].entry(places[i].node.0).or_insert_with(|| sides[i].support(places[i].node, &direction))
        };
        let gap = -height(1, direction.map(|x| -x)) - height(0, direction) - margin;
        // What is not a number excludes nothing.
        !(gap > 0.0 && gap * gap > prune)
    }
}

/// Returns the largest product of a vertex of a node and a direction, in coordinates of the tree.
pub(super) fn support<V: VolumeNodes>(tree: &PacketTree<V>, node: NodeRef, direction: &V3) -> f64 {
    let height = V::Node::height(&tree.shared, direction);
    tree.isa.run(Support { tree, node, direction: *direction, height })
}

struct Support<'a, V: VolumeNodes> {
    tree: &'a PacketTree<V>,
    node: NodeRef,
    direction: V3,
    height: Height,
}

impl<V: VolumeNodes> SimdKernel for Support<'_, V> {
    type Output = f64;

    #[inline(always)]
    fn run<I: InstructionSet>(self) -> f64 {
        let Self { tree, node, direction, height } = self;
        let offset = dot(direction, tree.frame.centre);
        let mut pending = vec![(f64::INFINITY, node)];
        let mut best = f64::NEG_INFINITY;
        while let Some((bound, node)) = pending.pop() {
            if bound <= best {
                continue;
            }
            if node.is_packet() {
                let [first, end] = [0, 1].map(|i| tree.leaves.vertex_offsets[node.number() + i] as usize);
                for vertex in &tree.leaves.vertices[first..end] {
                    best = dot(*vertex, direction).max(best);
                }
                continue;
            }
            let wide = &tree.nodes[node.number()];
            let mut heights = [0.0f32; WIDTH];
            height.of_children::<I::Eight>(wide).store(&mut heights);
            let from = pending.len();
            for (x, child) in heights.iter().zip(wide.children()) {
                let bound = (f64::from(*x) + f64::from(height.slack)) * tree.frame.unit + offset;
                if *child != NodeRef::NONE && bound > best {
                    pending.push((bound, *child));
                }
            }
            pending[from..].sort_unstable_by(|p, q| p.0.total_cmp(&q.0));
        }
        best
    }
}
