//! The two sides of a search for pairs: trees, and single shapes.

use super::directions::{Cut, Slab, unit};
use super::hulls::Hulls;
use super::support::support;
use super::{Children, Place};
use crate::tree::PacketTree;
use crate::tree::height::Height;
use crate::tree::node_ref::{NodeRef, WIDTH};
use crate::tree::wide_node::{VolumeNodes, WideNode};
use p2m_core::engine::arithmetic::cross;
use p2m_core::engine::vector::{V3, dot, sub};
use p2m_core::pair::{Motion, bounds_of};
use p2m_core::{Aabb, PrimitiveId};

/// One of the two sides of a search. It is used as `dyn`, so that a search is compiled once.
pub trait PairSide {
    /// Returns the root; `None` if there is nothing.
    fn root(&self) -> Option<Place>;
    /// Returns a box around everything.
    fn bounds(&self) -> Aabb<f64>;
    /// Returns where the frame of the nodes is in the scene.
    fn placement(&self) -> Placement;
    /// Returns directions of length 1 along which the contents of this side are often narrower than along the axes.
    /// Those of a tree are three orthogonal ones.
    fn directions(&self) -> Vec<V3>;
    /// Converts a direction of the scene to the form in which heights of nodes along it are computed.
    fn height(&self, direction: &V3) -> Height;
    /// Returns the least and the largest height of a node along a direction, which is also given by the heights of it
    /// and its opposite. `offset` is the height of the centre of the frame.
    fn extent(&self, place: &Place, direction: &V3, offset: f64, heights: &[Height; 2]) -> [f64; 2];
    /// Returns the largest height of a vertex of a node along a direction.
    fn support(&self, node: NodeRef, direction: &V3) -> f64;
    /// Bounds the distances of the children of a node from what is in some slabs, of which the given number of leading
    /// triples are orthogonal.
    fn cut(&self, node: NodeRef, slabs: &[Slab], triples: usize) -> Children;
    /// Bounds the distances of the children of a node from a box.
    fn cut_by_box(&self, node: NodeRef, bounds: &Aabb<f64>) -> Children;
    /// Returns a box around a node.
    fn box_of(&self, place: &Place) -> Aabb<f64>;
    /// Returns the least id of a packet.
    fn first_id(&self, packet: NodeRef) -> PrimitiveId;
    /// Loads the primitives of a packet.
    fn load(&self, packet: NodeRef, hulls: &mut Hulls);
}

/// Where the frame of a tree is in the scene.
#[derive(Clone, Copy, Debug)]
pub struct Placement {
    pub(super) centre: V3,
    pub(super) unit: f64,
    pub(super) is_plain: bool,
    /// Whether there is a frame. A shape has coordinates of the scene.
    pub(super) is_tree: bool,
}

/// A single shape of one to three vertices, which is a tree of one packet.
pub(crate) struct ShapeSide<'a>(pub(crate) &'a [V3]);

impl PairSide for ShapeSide<'_> {
    fn root(&self) -> Option<Place> {
        Some(Place { size: 0.0, ..Place::root(NodeRef::packet(0)) })
    }

    fn bounds(&self) -> Aabb<f64> {
        bounds_of(self.0)
    }

    fn placement(&self) -> Placement {
        Placement { centre: [0.0; 3], unit: 1.0, is_plain: true, is_tree: false }
    }

    fn directions(&self) -> Vec<V3> {
        let edges: Vec<V3> = match self.0 {
            [a, b] => vec![sub(*b, *a)],
            [a, b, c] => vec![sub(*b, *a), sub(*c, *b), sub(*a, *c)],
            _ => Vec::new(),
        };
        let mut vectors: Vec<V3> =
            edges.iter().flat_map(|[x, y, z]| [[0.0, *z, -y], [-z, 0.0, *x], [*y, -x, 0.0]]).collect();
        if let [d, e, _] = edges[..] {
            vectors.push(cross(d, e));
        }
        vectors.into_iter().filter_map(unit).collect()
    }

    fn height(&self, direction: &V3) -> Height {
        Height::new(std::array::from_fn(|k| (k, direction[k])))
    }

    fn extent(&self, _: &Place, direction: &V3, _: f64, _: &[Height; 2]) -> [f64; 2] {
        let heights = self.0.iter().map(|vertex| dot(*vertex, *direction));
        heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
    }

    fn support(&self, _: NodeRef, direction: &V3) -> f64 {
        self.0.iter().map(|vertex| dot(*vertex, *direction)).fold(f64::NEG_INFINITY, f64::max)
    }

    fn cut(&self, _: NodeRef, _: &[Slab], _: usize) -> Children {
        Children::NONE
    }

    fn cut_by_box(&self, _: NodeRef, _: &Aabb<f64>) -> Children {
        Children::NONE
    }

    fn box_of(&self, _: &Place) -> Aabb<f64> {
        bounds_of(self.0)
    }

    fn first_id(&self, _: NodeRef) -> PrimitiveId {
        PrimitiveId::new(0)
    }

    fn load(&self, packet: NodeRef, hulls: &mut Hulls) {
        hulls.start(packet);
        hulls.push(PrimitiveId::new(0), self.0);
    }
}

/// A tree, which may have moved.
pub struct TreeSide<'a, V: VolumeNodes> {
    tree: &'a PacketTree<V>,
    motion: Option<Motion>,
    /// A node with the root in its first slot.
    above_root: V::Node,
}

impl<'a, V: VolumeNodes> TreeSide<'a, V> {
    /// Makes a side of a tree.
    pub fn new(tree: &'a PacketTree<V>, motion: Option<Motion>) -> Self {
        let mut above_root = V::Node::new([NodeRef::NONE; WIDTH]);
        above_root.set_bounds(0, &tree.root_bounds);
        Self { tree, motion, above_root }
    }

    fn parent(&self, place: &Place) -> &V::Node {
        if place.parent == Place::NO_PARENT { &self.above_root } else { &self.tree.nodes[place.parent as usize] }
    }

    /// Converts a direction of the scene to that of the tree before its motion.
    fn turned_back(&self, direction: &V3) -> V3 {
        self.motion.map_or(*direction, |motion| motion.turn_back(*direction))
    }

    /// Returns the height of the origin of the coordinates of the tree.
    fn shift(&self, direction: &V3) -> f64 {
        self.motion.map_or(0.0, |motion| dot(motion.translation(), *direction))
    }

    fn moved_box(&self, bounds: &Aabb<f64>) -> Aabb<f64> {
        self.motion.map_or(*bounds, |motion| motion.apply_to_box(bounds))
    }
}

impl<V: VolumeNodes> PairSide for TreeSide<'_, V> {
    fn root(&self) -> Option<Place> {
        (self.tree.root != NodeRef::NONE).then_some(Place::root(self.tree.root))
    }

    fn bounds(&self) -> Aabb<f64> {
        self.moved_box(&self.tree.bounds)
    }

    fn placement(&self) -> Placement {
        let frame = &self.tree.frame;
        let centre = self.motion.map_or(frame.centre, |motion| motion.apply(frame.centre));
        Placement { centre, unit: frame.unit, is_plain: frame.is_plain(), is_tree: true }
    }

    fn directions(&self) -> Vec<V3> {
        self.motion.map_or(Vec::new(), |motion| {
            [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| motion.turn(axis)).into()
        })
    }

    fn height(&self, direction: &V3) -> Height {
        V::Node::height(&self.tree.shared, &self.turned_back(direction))
    }

    fn extent(&self, place: &Place, _: &V3, offset: f64, heights: &[Height; 2]) -> [f64; 2] {
        let node = self.parent(place);
        let [above, below] = [0, 1].map(|i| heights[i].of_child(node, usize::from(place.slot)) * self.tree.frame.unit);
        [offset - below, offset + above]
    }

    fn support(&self, node: NodeRef, direction: &V3) -> f64 {
        let local = self.turned_back(direction);
        support(self.tree, node, &local) + self.shift(direction)
    }

    fn cut(&self, node: NodeRef, slabs: &[Slab], triples: usize) -> Children {
        self.tree.isa.run(Cut { tree: self.tree, node, slabs, triples })
    }

    fn cut_by_box(&self, node: NodeRef, bounds: &Aabb<f64>) -> Children {
        let wide = &self.tree.nodes[node.number()];
        let mut children = Children { nodes: *wide.children(), ..Children::NONE };
        for slot in wide.used_slots() {
            let child = self.moved_box(&self.tree.child_box(wide, slot));
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
        if place.parent == Place::NO_PARENT {
            return self.bounds();
        }
        self.moved_box(&self.tree.child_box(self.parent(place), usize::from(place.slot)))
    }

    fn first_id(&self, packet: NodeRef) -> PrimitiveId {
        self.tree.leaves.packets[packet.number()].ids().iter().copied().min().expect("a packet has primitives")
    }

    fn load(&self, number: NodeRef, hulls: &mut Hulls) {
        let leaves = &self.tree.leaves;
        let packet = &leaves.packets[number.number()];
        hulls.start(number);
        for (lane, id) in packet.ids().iter().enumerate() {
            let (indices, count) = packet.vertices_of(lane);
            assert!(count > 0, "distances between primitives are defined for those that have vertices");
            let moved = |index: usize| self.motion.map_or(leaves.vertices[index], |m| m.apply(leaves.vertices[index]));
            hulls.push(*id, &indices.map(moved)[..count]);
        }
    }
}
