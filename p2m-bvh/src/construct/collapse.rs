//! The collapse of a binary tree into a tree with eight children per node.
//!
//! Dynamic programming over the expected cost of visits decides which binary nodes become nodes of eight. The basic
//! idea: a node of eight is a binary subtree whose inner nodes are dissolved until at most eight subtrees, a forest,
//! are left below its root. The cheapest forest of at most i trees below a binary node is either a single tree, whose
//! root is a node of eight, or consists of the cheapest forests of j and i - j trees below its two children, for the
//! best j. These tables are computed from the leaves to the root; then the nodes are read off from the root downwards.
//! \[Ylitie2017\] does this for rays; the difference is that leaves stay as they are here. A greedy choice from the
//! root would leave the lowest nodes half empty (decision 010).

use crate::construct::split::{SplitNode, to_u32};
use crate::packet::LANES;
use crate::tree::node_ref::{NodeRef, WIDTH};
use std::ops::Range;

/// A binary tree whose leaves are single packets. Children come after their parents.
pub(crate) struct PacketBinaryTree {
    nodes: Vec<BinaryNode>,
}

/// The primitives of a packet, as a range.
pub(crate) struct PacketRange {
    /// The range of their indices in the order of the leaves.
    pub(crate) primitives: Range<u32>,
    /// Whether the next packet has further primitives with the same vertices.
    pub(crate) is_continued: bool,
}

struct BinaryNode {
    /// Half of the surface area of the box around the node, in any unit.
    half_area: f64,
    content: Content,
}

/// The content of a binary node: the number of a packet, or the number of the first of two consecutive nodes.
#[derive(Clone, Copy)]
enum Content {
    Packet(u32),
    Nodes(u32),
}

impl PacketBinaryTree {
    /// Converts the split tree, and also returns the primitive range of each packet.
    pub(crate) fn new(splits: &[SplitNode]) -> (Self, Vec<PacketRange>) {
        let mut packets = Vec::with_capacity(splits.len().div_ceil(2));
        let node = |split: &SplitNode| {
            let content = if split.count == 0 {
                Content::Nodes(split.first)
            } else {
                let number = to_u32(packets.len());
                let end = split.first + split.count;
                packets.extend((split.first..end).step_by(LANES).map(|first| {
                    let next = first + to_u32(LANES);
                    PacketRange { primitives: first..next.min(end), is_continued: next < end }
                }));
                // The packets that continue a run have no node.
                Content::Packet(number)
            };
            BinaryNode { half_area: split.half_area, content }
        };
        let nodes = splits.iter().map(node).collect();
        (Self { nodes }, packets)
    }

    /// Returns the root, the children of all nodes, and the number of nodes on the longest path. Parents come before
    /// their children.
    pub(crate) fn collapse(&self) -> (NodeRef, Vec<[NodeRef; WIDTH]>, usize) {
        let Some(root) = self.nodes.first() else { return (NodeRef::NONE, Vec::new(), 0) };
        if let Content::Packet(packet) = root.content {
            return (NodeRef::packet(packet as usize), Vec::new(), 0);
        }
        let forests = self.forests();
        let mut nodes = vec![[NodeRef::NONE; WIDTH]];
        let mut longest = 0;
        // The nodes whose children are still unknown: their numbers, their binary nodes and their depths.
        let mut pending = vec![(0, 0, 1)];
        while let Some((number, at, depth)) = pending.pop() {
            longest = longest.max(depth);
            let mut slot = 0;
            // Binary nodes, the number of slots that their forest may fill, and whether the node has to be replaced by
            // its children. The last is true only for the binary node of the wide node itself.
            let mut subtrees = vec![(at, WIDTH, true)];
            while let Some((at, slots, is_opened)) = subtrees.pop() {
                let forests = &forests[at];
                let left = usize::from(forests.left[if is_opened { 0 } else { slots - 1 }]);
                let child = match self.nodes[at].content {
                    Content::Packet(packet) => NodeRef::packet(packet as usize),
                    Content::Nodes(a) if is_opened || (slots > 1 && left > 0) => {
                        let (a, b) = (a as usize, a as usize + 1);
                        subtrees.extend([(b, slots - left, false), (a, left, false)]);
                        continue;
                    }
                    Content::Nodes(_) => {
                        nodes.push([NodeRef::NONE; WIDTH]);
                        pending.push((nodes.len() - 1, at, depth + 1));
                        NodeRef::node(nodes.len() - 1)
                    }
                };
                nodes[number][slot] = child;
                slot += 1;
            }
        }
        (NodeRef::node(0), nodes, longest)
    }

    /// Computes the cheapest forests below each node.
    fn forests(&self) -> Vec<Forests> {
        let scene_area = self.nodes[0].half_area;
        let mut forests = vec![Forests::default(); self.nodes.len()];
        for (at, node) in self.nodes.iter().enumerate().rev() {
            let Content::Nodes(a) = node.content else { continue };
            let area = node.half_area / scene_area;
            let visit = NODE_COST + if area.is_nan() { 1.0 } else { area };
            forests[at] = Forests::above(visit, &forests[a as usize], &forests[a as usize + 1]);
        }
        forests
    }
}

/// The cheapest forests of at most 1, 2, ... trees below a binary node.
#[derive(Clone, Copy, Default)]
struct Forests {
    costs: [f64; WIDTH],
    /// How many trees of each forest are below the first child; 0 if the forest is a single tree. For the forest of one
    /// tree it is the number of children of its root that are below the first child.
    left: [u8; WIDTH],
}

impl Forests {
    /// Computes the forests below a node with these children. A visit of the node costs `visit`.
    fn above(visit: f64, a: &Self, b: &Self) -> Self {
        let best = |slots: usize| {
            let (mut cost, mut left) = (f64::INFINITY, 0);
            for i in 1..slots {
                let sum = a.costs[i - 1] + b.costs[slots - i - 1];
                (cost, left) = if sum < cost { (sum, i) } else { (cost, left) };
            }
            (cost, u8::try_from(left).expect("a node has eight slots"))
        };
        let mut forests = Self::default();
        let (below, left) = best(WIDTH);
        let single = visit + below;
        (forests.costs[0], forests.left[0]) = (single, left);
        for slots in 2..=WIDTH {
            let (cost, left) = best(slots);
            (forests.costs[slots - 1], forests.left[slots - 1]) =
                if cost < single { (cost, left) } else { (single, 0) };
        }
        forests
    }
}

/// The cost of a visit in addition to the node's share of the area of the scene, so that few nodes are created if all
/// areas are equal. There is no record of how it was tuned.
const NODE_COST: f64 = 1e-3;

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;
    use p2m_core::Aabb;
    use rand::{Rng, RngExt};

    /// Builds a tree with random splits over packets along a line, below the node `at`.
    fn binary(random: &mut impl Rng, packets: Range<usize>, at: usize, nodes: &mut Vec<BinaryNode>) {
        let corner = |i: usize| Point3::new(i as f64, (i * i % 7) as f64, (i % 3) as f64);
        let bounds = packets.clone().map(|i| Aabb::from_points(&[corner(i), corner(i + 1)]));
        let side = bounds.fold(Aabb::empty(), |a, b| a.union(&b));
        let side = side.max - side.min;
        nodes[at].half_area = side.x * side.y + side.y * side.z + side.z * side.x;
        nodes[at].content = Content::Packet(packets.start as u32);
        if packets.len() > 1 {
            let middle = random.random_range(packets.start + 1..packets.end);
            let child = nodes.len();
            nodes[at].content = Content::Nodes(child as u32);
            nodes.extend([0, 1].map(|_| BinaryNode { half_area: 0.0, content: Content::Packet(0) }));
            binary(random, packets.start..middle, child, nodes);
            binary(random, middle..packets.end, child + 1, nodes);
        }
    }

    /// Returns the cost of every forest of at most `slots` trees below a node.
    fn all_forests(tree: &PacketBinaryTree, at: usize, slots: usize) -> Vec<f64> {
        let Content::Nodes(a) = tree.nodes[at].content else { return vec![0.0] };
        let a = a as usize;
        let split = |slots: usize| {
            (1..slots).flat_map(move |left| {
                let right = all_forests(tree, a + 1, slots - left);
                all_forests(tree, a, left).into_iter().flat_map(move |x| right.clone().into_iter().map(move |y| x + y))
            })
        };
        let area = tree.nodes[at].half_area / tree.nodes[0].half_area;
        let best = split(WIDTH).fold(f64::INFINITY, f64::min);
        std::iter::once(NODE_COST + area + best).chain(split(slots)).collect()
    }

    #[test]
    fn no_other_choice_of_nodes_costs_less() {
        for case in p2m_testkit::cases(60, 20) {
            let mut random = p2m_testkit::rng("collapse", case);
            // The number of choices grows exponentially with the number of packets.
            let len = 2 + case as usize % p2m_testkit::amount(10, 8);
            let mut tree = PacketBinaryTree { nodes: vec![BinaryNode { half_area: 0.0, content: Content::Packet(0) }] };
            binary(&mut random, 0..len, 0, &mut tree.nodes);
            let expected = all_forests(&tree, 0, 1)[0];
            let found = tree.forests()[0].costs[0];
            assert!((found - expected).abs() < 1e-12 * expected, "{len}: {found} for {expected}");
            // The collapsed tree has as many children in total as there are nodes and packets below the root.
            let (root, nodes, depth) = tree.collapse();
            assert_eq!(root, NodeRef::node(0));
            let children: Vec<NodeRef> = nodes.concat().into_iter().filter(|child| *child != NodeRef::NONE).collect();
            let packets: Vec<usize> = children.iter().filter(|c| c.is_packet()).map(|c| c.number()).collect();
            assert_eq!(packets.len() + nodes.len() - 1, children.len());
            assert!((0..len).all(|packet| packets.contains(&packet)) && packets.len() == len);
            assert!((1..=3).contains(&depth), "{depth}");
        }
    }
}
