//! Trees as sides of a search for pairs.

use crate::packet::LANES;
use crate::tree::PacketTree;
use crate::tree::node_ref::NodeRef;
use crate::tree::wide_node::{VolumeNodes, WideNode};
use p2m_core::engine::pairs::{
    Children, Height, Hulls, MAX_HULLS, NO_NODE, PairSide, Place, Placement, Slab, WIDTH, bound_children,
};
use p2m_core::engine::simd::{InstructionSet, Lanes, SimdKernel};
use p2m_core::engine::vector::{V3, dot, largest};
use p2m_core::pair::{Hull, Motion};
use p2m_core::{Aabb, PrimitiveId};

const _: () = assert!(LANES <= MAX_HULLS);

/// A tree as a side of a search for pairs. Motions are applied to it in their order, and each rounds the coordinates of
/// vertices.
pub struct TreeSide<'a, V: VolumeNodes> {
    tree: &'a PacketTree<V>,
    motions: &'a [Motion],
    /// A node with the root in its first slot.
    above_root: V::Node,
}

impl<'a, V: VolumeNodes> TreeSide<'a, V> {
    /// Creates a side from a tree.
    pub fn new(tree: &'a PacketTree<V>, motions: &'a [Motion]) -> Self {
        let mut above_root = V::Node::new([NodeRef::NONE; WIDTH]);
        above_root.set_bounds(0, &tree.root_bounds);
        Self { tree, motions, above_root }
    }

    fn parent(&self, place: &Place) -> &V::Node {
        if place.parent == NO_NODE { &self.above_root } else { &self.tree.nodes[NodeRef(place.parent).number()] }
    }

    /// Converts a direction of the scene to the coordinates of the tree before its motions.
    fn turned_back(&self, direction: &V3) -> V3 {
        self.motions.iter().rev().fold(*direction, |direction, motion| motion.apply_inverse_to_vector(direction))
    }

    /// Returns the height of the origin of the tree's coordinates.
    fn shift(&self, direction: &V3) -> f64 {
        dot(self.moved([0.0; 3]), *direction)
    }

    fn moved(&self, point: V3) -> V3 {
        self.motions.iter().fold(point, |point, motion| motion.apply(point))
    }

    /// Returns a box around a child after the motions. Where the box of the whole scene is smaller, it is cut to that
    /// box.
    fn child_box(&self, node: &V::Node, slot: usize) -> Aabb<f64> {
        self.moved_box(&self.tree.child_box(node, slot).intersection(&self.tree.bounds))
    }

    fn moved_box(&self, bounds: &Aabb<f64>) -> Aabb<f64> {
        self.motions.iter().fold(*bounds, |bounds, motion| motion.apply_to_box(&bounds))
    }
}

impl<V: VolumeNodes> PairSide for TreeSide<'_, V> {
    fn root(&self) -> Option<Place> {
        (self.tree.root != NodeRef::NONE).then_some(Place::root(self.tree.root.0))
    }

    fn is_packet(&self, node: u32) -> bool {
        NodeRef(node).is_packet()
    }

    fn bounds(&self) -> Aabb<f64> {
        self.moved_box(&self.tree.bounds)
    }

    fn placement(&self) -> Placement {
        let frame = &self.tree.frame;
        let centre = self.moved(frame.centre);
        // No coordinate of a moved vertex is larger than the length of the vertex plus the translation.
        let grow = |size: f64, motion: &Motion| 2.0 * size + largest(&[motion.translation()]);
        let size = self.motions.iter().fold(largest(&[self.tree.bounds.min.into(), self.tree.bounds.max.into()]), grow);
        Placement { centre, unit: frame.unit, size, is_tree: true }
    }

    fn directions(&self) -> Vec<V3> {
        if self.motions.is_empty() {
            return Vec::new();
        }
        let turned = |axis| self.motions.iter().fold(axis, |axis, motion| motion.turn(axis));
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(turned).into()
    }

    fn height(&self, direction: &V3) -> Height {
        V::Node::height(&self.tree.shared, &self.turned_back(direction))
    }

    fn extent(&self, place: &Place, _: &V3, offset: f64, heights: &[Height; 2]) -> [f64; 2] {
        let node = self.parent(place);
        let [above, below] = [0, 1].map(|i| heights[i].of_child(node, usize::from(place.slot)) * self.tree.frame.unit);
        [offset - below, offset + above]
    }

    fn support(&self, node: u32, direction: &V3) -> f64 {
        let (tree, node, local) = (self.tree, NodeRef(node), self.turned_back(direction));
        let height = V::Node::height(&tree.shared, &local);
        tree.isa.run(Support { tree, node, direction: local, height }) + self.shift(direction)
    }

    fn cut(&self, node: u32, slabs: &[Slab], triples: usize) -> Children {
        self.tree.isa.run(Cut { tree: self.tree, node: NodeRef(node), slabs, triples })
    }

    fn cut_by_box(&self, node: u32, bounds: &Aabb<f64>) -> Children {
        let wide = &self.tree.nodes[NodeRef(node).number()];
        let mut children = Children { nodes: wide.children().map(|child| child.0), ..Children::NONE };
        for slot in wide.used_slots() {
            let child = self.child_box(wide, slot);
            children.squares[slot] = child.gap_squared(bounds);
            #[allow(clippy::cast_possible_truncation, reason = "gaps and sizes only order pairs")]
            {
                children.gaps[slot] = children.squares[slot].sqrt() as f32;
                children.sizes[slot] = (child.max - child.min).sum() as f32;
            }
        }
        children
    }

    fn box_of(&self, place: &Place) -> Aabb<f64> {
        if place.parent == NO_NODE {
            return self.bounds();
        }
        self.child_box(self.parent(place), usize::from(place.slot))
    }

    fn least_id(&self, node: u32) -> PrimitiveId {
        self.tree.least_id(NodeRef(node))
    }

    fn next_packet(&self, packet: u32) -> Option<u32> {
        let is_continued = self.tree.leaves.packets[NodeRef(packet).number()].is_continued();
        is_continued.then(|| NodeRef::packet(NodeRef(packet).number() + 1).0)
    }

    fn load(&self, number: u32, hulls: &mut Hulls) {
        let leaves = &self.tree.leaves;
        let packet = &leaves.packets[NodeRef(number).number()];
        hulls.start(number);
        for (lane, id) in packet.ids().iter().enumerate() {
            let (indices, count) = packet.vertices_of(lane);
            assert!(count > 0, "distances between primitives are defined for those that have vertices");
            let hull = Hull::new(&indices.map(|index| leaves.vertices[index])[..count]);
            hulls.push(*id, hull.map(|vertex| self.moved(vertex)));
        }
    }
}

/// A kernel that bounds the distances between the children of a node and several slabs.
struct Cut<'a, V: VolumeNodes> {
    tree: &'a PacketTree<V>,
    node: NodeRef,
    slabs: &'a [Slab],
    triples: usize,
}

impl<V: VolumeNodes> SimdKernel for Cut<'_, V> {
    type Output = Children;

    #[inline(always)]
    fn run<I: InstructionSet>(self) -> Children {
        let node = &self.tree.nodes[self.node.number()];
        let bounds = bound_children::<I::F32x8, _>(node, self.slabs, self.triples);
        let (mut squares, mut gaps, mut sizes) = ([0.0f32; WIDTH], [0.0f32; WIDTH], [0.0f32; WIDTH]);
        bounds.squares.store(&mut squares);
        bounds.gaps.store(&mut gaps);
        bounds.sizes.store(&mut sizes);
        let frame = &self.tree.frame;
        #[allow(clippy::cast_possible_truncation, reason = "sizes and gaps only order pairs")]
        let unit = frame.unit as f32;
        let mut children = Children::NONE;
        for slot in 0..WIDTH {
            children.squares[slot] = frame.square_below(squares[slot]);
            children.gaps[slot] = gaps[slot] * unit;
            children.sizes[slot] = sizes[slot] * unit;
            children.nodes[slot] = node.children()[slot].0;
        }
        children
    }
}

/// The computation of the largest product of a vertex of a node and a direction, in coordinates of the tree.
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
            height.of_children::<I::F32x8, _>(wide).store(&mut heights);
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
