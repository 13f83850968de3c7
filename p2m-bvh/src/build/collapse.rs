//! From a binary tree to one of eight children a node.
//!
//! Which nodes of the binary tree become nodes of eight is decided by dynamic programming over the cost of visits: the
//! forest of at most i trees below a binary node costs least either as one tree, with a node of its own on top, or as
//! forests of j and i - j trees below its two children. (For trees of rays this is \[Ylitie2017\]; leaves stay as they
//! are here.) A greedy choice from the root leaves the lowest nodes half empty.

use crate::build::Node;
use crate::tree::aabb_node::{NodeRef, WIDTH};
use p2m_core::Aabb;
use std::ops::Range;

/// A binary tree down to single packets. Children come after their parents.
pub(crate) struct Binary {
    nodes: Vec<BinaryNode>,
}

struct BinaryNode {
    bounds: Aabb<f64>,
    below: Below,
}

#[derive(Clone, Copy)]
enum Below {
    Packet(usize),
    Nodes([usize; 2]),
}

/// How the trees of a forest below a binary node are chosen.
#[derive(Clone, Copy, Default)]
struct Forest {
    cost: f64,
    /// How many trees are below its first child; 0 for a single tree.
    left: usize,
}

impl Binary {
    /// The tree of splits, of which the leaves have the packets `of_leaf`.
    pub(crate) fn new(splits: &[Node<Aabb<f64>>], of_leaf: &[Range<usize>], packet_boxes: &[Aabb<f64>]) -> Self {
        /// What a node is made of.
        enum Source {
            Split(usize),
            Packets(Range<usize>),
        }
        let mut binary = Self { nodes: Vec::with_capacity((2 * packet_boxes.len()).saturating_sub(1)) };
        if splits.is_empty() {
            return binary;
        }
        let mut sources = std::collections::VecDeque::from([Source::Split(0)]);
        let mut placed = 1;
        while let Some(source) = sources.pop_front() {
            let packets = match source {
                Source::Split(at) if let Some(children) = splits[at].children() => {
                    binary
                        .nodes
                        .push(BinaryNode { bounds: splits[at].volume, below: Below::Nodes([placed, placed + 1]) });
                    sources.extend(children.map(Source::Split));
                    placed += 2;
                    continue;
                }
                Source::Split(at) => of_leaf[at].clone(),
                Source::Packets(packets) => packets,
            };
            let bounds = packet_boxes[packets.clone()].iter().fold(Aabb::empty(), |a, b| a.union(b));
            if packets.len() == 1 {
                binary.nodes.push(BinaryNode { bounds, below: Below::Packet(packets.start) });
            } else {
                let middle = packets.start + packets.len() / 2;
                binary.nodes.push(BinaryNode { bounds, below: Below::Nodes([placed, placed + 1]) });
                sources.extend([packets.start..middle, middle..packets.end].map(Source::Packets));
                placed += 2;
            }
        }
        binary
    }

    /// The root, the children of the nodes, parents before children, and how many nodes are on the longest path.
    pub(crate) fn collapse(&self) -> (NodeRef, Vec<[NodeRef; WIDTH]>, usize) {
        let Some(root) = self.nodes.first() else { return (NodeRef::NONE, Vec::new(), 0) };
        if let Below::Packet(packet) = root.below {
            return (NodeRef::packet(packet), Vec::new(), 0);
        }
        let forests = self.forests();
        let mut nodes = vec![[NodeRef::NONE; WIDTH]];
        let mut longest = 0;
        let mut open = vec![(0, 0, 1)];
        while let Some((number, at, depth)) = open.pop() {
            longest = longest.max(depth);
            let mut place = 0;
            // Binary nodes, and for how many trees each has room; the node itself has to be opened.
            let mut rooms = vec![(at, WIDTH, true)];
            while let Some((at, room, opened)) = rooms.pop() {
                let forest = forests[at][room - 1];
                let child = match self.nodes[at].below {
                    Below::Packet(packet) => NodeRef::packet(packet),
                    Below::Nodes([a, b]) if opened || (room > 1 && forest.left > 0) => {
                        let left = if opened { forests[at][0].left } else { forest.left };
                        rooms.extend([(b, room - left, false), (a, left, false)]);
                        continue;
                    }
                    Below::Nodes(_) => {
                        nodes.push([NodeRef::NONE; WIDTH]);
                        open.push((nodes.len() - 1, at, depth + 1));
                        NodeRef::node(nodes.len() - 1)
                    }
                };
                nodes[number][place] = child;
                place += 1;
            }
        }
        (NodeRef::node(0), nodes, longest)
    }

    /// For each node the best forests of at most 1, 2, .. trees. That of one tree tells how the children of its root
    /// are chosen.
    fn forests(&self) -> Vec<[Forest; WIDTH]> {
        let whole = half_area(&self.nodes[0].bounds);
        let mut forests = vec![[Forest::default(); WIDTH]; self.nodes.len()];
        for (at, node) in self.nodes.iter().enumerate().rev() {
            let Below::Nodes([a, b]) = node.below else { continue };
            let best = |room: usize| {
                let split = |left: usize| forests[a][left - 1].cost + forests[b][room - left - 1].cost;
                let all = (1..room).map(|left| Forest { cost: split(left), left });
                all.min_by(|x, y| x.cost.total_cmp(&y.cost)).expect("room for two")
            };
            let mut own = [Forest::default(); WIDTH];
            let below = best(WIDTH);
            let area = half_area(&node.bounds) / whole;
            let visit = VISIT + if area.is_nan() { 1.0 } else { area };
            own[0] = Forest { cost: visit + below.cost, left: below.left };
            let single = Forest { cost: own[0].cost, left: 0 };
            for room in 2..=WIDTH {
                let split = best(room);
                own[room - 1] = if split.cost < single.cost { split } else { single };
            }
            forests[at] = own;
        }
        forests
    }
}

/// What a node costs beside its area over that of the scene: so that nodes are not wasted where areas tell nothing.
const VISIT: f64 = 1e-3;

/// Infinite where it overflows.
fn half_area(bounds: &Aabb<f64>) -> f64 {
    let side = bounds.max - bounds.min;
    side.x * side.y + side.y * side.z + side.z * side.x
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;
    use rand::{Rng, RngExt};

    /// Splits at places that a number decides, over packets along a line.
    fn binary(random: &mut impl Rng, packets: Range<usize>, nodes: &mut Vec<BinaryNode>) -> usize {
        let at = nodes.len();
        let corner = |i: usize| Point3::new(i as f64, (i * i % 7) as f64, (i % 3) as f64);
        let bounds = packets.clone().map(|i| Aabb::of_points(&[corner(i), corner(i + 1)]));
        let bounds = bounds.fold(Aabb::empty(), |a, b| a.union(&b));
        nodes.push(BinaryNode { bounds, below: Below::Packet(packets.start) });
        if packets.len() > 1 {
            let middle = random.random_range(packets.start + 1..packets.end);
            let children = [packets.start..middle, middle..packets.end].map(|half| binary(random, half, nodes));
            nodes[at].below = Below::Nodes(children);
        }
        at
    }

    /// All ways to have a forest of at most `room` trees below a node, by their costs.
    fn all_forests(tree: &Binary, at: usize, room: usize) -> Vec<f64> {
        let Below::Nodes([a, b]) = tree.nodes[at].below else { return vec![0.0] };
        let split = |room: usize| {
            (1..room).flat_map(move |left| {
                let right = all_forests(tree, b, room - left);
                all_forests(tree, a, left).into_iter().flat_map(move |x| right.clone().into_iter().map(move |y| x + y))
            })
        };
        let area = half_area(&tree.nodes[at].bounds) / half_area(&tree.nodes[0].bounds);
        let best = split(WIDTH).fold(f64::INFINITY, f64::min);
        std::iter::once(VISIT + area + best).chain(split(room)).collect()
    }

    #[test]
    fn no_other_choice_of_nodes_costs_less() {
        for case in p2m_testkit::cases(60, 20) {
            let mut random = p2m_testkit::rng("collapse", case);
            // Each further packet makes many times as many choices.
            let len = 2 + case as usize % p2m_testkit::amount(10, 8);
            let mut tree = Binary { nodes: Vec::new() };
            binary(&mut random, 0..len, &mut tree.nodes);
            let expected = all_forests(&tree, 0, 1)[0];
            let found = tree.forests()[0][0].cost;
            assert!((found - expected).abs() < 1e-12 * expected, "{len}: {found} for {expected}");
            // And the nodes are those: as many children in all as there are nodes and packets below the root.
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
