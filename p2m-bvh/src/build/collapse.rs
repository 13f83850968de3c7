//! Collapsing a binary tree into a tree of eight children per node.
//!
//! Dynamic programming over the cost of visits decides which nodes of the binary tree become nodes of eight. The
//! cheapest forest of at most i trees below a binary node is either a single tree, whose root is a node of eight,
//! or consists of the cheapest forests of j and i - j trees below its two children. \[Ylitie2017\] does this for
//! rays; the difference is that leaves stay as they are here. A greedy choice from the root would leave the lowest
//! nodes half empty.

use crate::build::split::SplitNode;
use crate::tree::node_ref::{NodeRef, WIDTH};
use p2m_core::Aabb;
use std::ops::Range;

/// A binary tree whose leaves are single packets. Children come after their parents.
pub(crate) struct PacketBinaryTree {
    nodes: Vec<BinaryNode>,
}

struct BinaryNode {
    bounds: Aabb<f64>,
    content: Content,
}

/// The content of a binary node: a packet or two nodes, by their numbers.
#[derive(Clone, Copy)]
enum Content {
    Packet(usize),
    Nodes([usize; 2]),
}

/// The cheapest forest of at most a certain number of trees below a binary node.
#[derive(Clone, Copy, Default)]
struct Forest {
    cost: f64,
    /// The number of trees below the first child; 0 if the forest is a single tree.
    left: usize,
}

impl PacketBinaryTree {
    /// Continues a tree of splits down to single packets. `leaf_packets` has the packets of each leaf of that tree.
    pub(crate) fn new(
        splits: &[SplitNode<Aabb<f64>>],
        leaf_packets: &[Range<usize>],
        packet_boxes: &[Aabb<f64>],
    ) -> Self {
        /// The source of a node: a node of the splits, or several packets of one leaf.
        enum Source {
            Split(usize),
            Packets(Range<usize>),
        }
        let mut binary = Self { nodes: Vec::with_capacity((2 * packet_boxes.len()).saturating_sub(1)) };
        if splits.is_empty() {
            return binary;
        }
        let mut sources = std::collections::VecDeque::from([Source::Split(0)]);
        let mut numbered = 1;
        while let Some(source) = sources.pop_front() {
            let packets = match source {
                Source::Split(at) if let Some(children) = splits[at].children() => {
                    binary.nodes.push(BinaryNode {
                        bounds: splits[at].volume,
                        content: Content::Nodes([numbered, numbered + 1]),
                    });
                    sources.extend(children.map(Source::Split));
                    numbered += 2;
                    continue;
                }
                Source::Split(at) => leaf_packets[at].clone(),
                Source::Packets(packets) => packets,
            };
            let bounds = packet_boxes[packets.clone()].iter().fold(Aabb::empty(), |a, b| a.union(b));
            if packets.len() == 1 {
                binary.nodes.push(BinaryNode { bounds, content: Content::Packet(packets.start) });
            } else {
                let middle = packets.start + packets.len() / 2;
                binary.nodes.push(BinaryNode { bounds, content: Content::Nodes([numbered, numbered + 1]) });
                sources.extend([packets.start..middle, middle..packets.end].map(Source::Packets));
                numbered += 2;
            }
        }
        binary
    }

    /// Returns the root, the children of all nodes, and the number of nodes on the longest path. Parents
    /// come before children.
    pub(crate) fn collapse(&self) -> (NodeRef, Vec<[NodeRef; WIDTH]>, usize) {
        let Some(root) = self.nodes.first() else { return (NodeRef::NONE, Vec::new(), 0) };
        if let Content::Packet(packet) = root.content {
            return (NodeRef::packet(packet), Vec::new(), 0);
        }
        let forests = self.forests();
        let mut nodes = vec![[NodeRef::NONE; WIDTH]];
        let mut longest = 0;
        // The nodes whose children are still unknown: their numbers, their binary nodes and their depths.
        let mut pending = vec![(0, 0, 1)];
        while let Some((number, at, depth)) = pending.pop() {
            longest = longest.max(depth);
            let mut slot = 0;
            // Binary nodes with the number of slots that their forest may fill, and whether the node has to be replaced
            // by its children, which is so for the node itself.
            let mut subtrees = vec![(at, WIDTH, true)];
            while let Some((at, slots, is_opened)) = subtrees.pop() {
                let forest = forests[at][slots - 1];
                let child = match self.nodes[at].content {
                    Content::Packet(packet) => NodeRef::packet(packet),
                    Content::Nodes([a, b]) if is_opened || (slots > 1 && forest.left > 0) => {
                        let left = if is_opened { forests[at][0].left } else { forest.left };
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

    /// The cheapest forests of at most 1, 2, .. trees below each node. `left` of the forest of one tree is the number
    /// of children of its root that are below the first child.
    fn forests(&self) -> Vec<[Forest; WIDTH]> {
        let scene_area = half_area(&self.nodes[0].bounds);
        let mut forests = vec![[Forest::default(); WIDTH]; self.nodes.len()];
        for (at, node) in self.nodes.iter().enumerate().rev() {
            let Content::Nodes([a, b]) = node.content else { continue };
            let best = |slots: usize| {
                let split = |left: usize| forests[a][left - 1].cost + forests[b][slots - left - 1].cost;
                let all = (1..slots).map(|left| Forest { cost: split(left), left });
                all.min_by(|x, y| x.cost.total_cmp(&y.cost)).expect("two slots or more")
            };
            let mut chosen = [Forest::default(); WIDTH];
            let below = best(WIDTH);
            let area = half_area(&node.bounds) / scene_area;
            let visit = NODE_COST + if area.is_nan() { 1.0 } else { area };
            chosen[0] = Forest { cost: visit + below.cost, left: below.left };
            let single = Forest { cost: chosen[0].cost, left: 0 };
            for slots in 2..=WIDTH {
                let split = best(slots);
                chosen[slots - 1] = if split.cost < single.cost { split } else { single };
            }
            forests[at] = chosen;
        }
        forests
    }
}

/// The cost of a node in addition to its share of the area of the scene, so that few nodes are made where all
/// areas are equal.
const NODE_COST: f64 = 1e-3;

/// Half of the surface area of a box, which is infinite if it overflows.
fn half_area(bounds: &Aabb<f64>) -> f64 {
    let side = bounds.max - bounds.min;
    side.x * side.y + side.y * side.z + side.z * side.x
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;
    use rand::{Rng, RngExt};

    /// Builds a tree with random splits over packets along a line.
    fn binary(random: &mut impl Rng, packets: Range<usize>, nodes: &mut Vec<BinaryNode>) -> usize {
        let at = nodes.len();
        let corner = |i: usize| Point3::new(i as f64, (i * i % 7) as f64, (i % 3) as f64);
        let bounds = packets.clone().map(|i| Aabb::from_points(&[corner(i), corner(i + 1)]));
        let bounds = bounds.fold(Aabb::empty(), |a, b| a.union(&b));
        nodes.push(BinaryNode { bounds, content: Content::Packet(packets.start) });
        if packets.len() > 1 {
            let middle = random.random_range(packets.start + 1..packets.end);
            let children = [packets.start..middle, middle..packets.end].map(|half| binary(random, half, nodes));
            nodes[at].content = Content::Nodes(children);
        }
        at
    }

    /// Returns the costs of all forests of at most `slots` trees below a node.
    fn all_forests(tree: &PacketBinaryTree, at: usize, slots: usize) -> Vec<f64> {
        let Content::Nodes([a, b]) = tree.nodes[at].content else { return vec![0.0] };
        let split = |slots: usize| {
            (1..slots).flat_map(move |left| {
                let right = all_forests(tree, b, slots - left);
                all_forests(tree, a, left).into_iter().flat_map(move |x| right.clone().into_iter().map(move |y| x + y))
            })
        };
        let area = half_area(&tree.nodes[at].bounds) / half_area(&tree.nodes[0].bounds);
        let best = split(WIDTH).fold(f64::INFINITY, f64::min);
        std::iter::once(NODE_COST + area + best).chain(split(slots)).collect()
    }

    #[test]
    fn no_other_choice_of_nodes_costs_less() {
        for case in p2m_testkit::cases(60, 20) {
            let mut random = p2m_testkit::rng("collapse", case);
            // The number of choices grows exponentially with that of packets.
            let len = 2 + case as usize % p2m_testkit::amount(10, 8);
            let mut tree = PacketBinaryTree { nodes: Vec::new() };
            binary(&mut random, 0..len, &mut tree.nodes);
            let expected = all_forests(&tree, 0, 1)[0];
            let found = tree.forests()[0][0].cost;
            assert!((found - expected).abs() < 1e-12 * expected, "{len}: {found} for {expected}");
            // The collapsed tree has as many children in all as there are nodes and packets below the root.
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
