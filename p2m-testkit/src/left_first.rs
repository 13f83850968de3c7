//! The k-DOP tree's closest point as CGAL's manual has it, to compare counters with: a binary tree, the left child
//! first, bounds that are the largest slack of a slab.
//!
//! Written from the manual's description, for counting only.

use nalgebra::Point3;
use p2m_core::hierarchy::{PacketTree, Part};
use p2m_core::{Directions, Kdop, Primitive, PrimitiveId, PrimitiveSet, Real};

/// A binary tree of k-DOPs.
pub struct LeftFirst<const K: usize> {
    directions: Directions<K>,
    /// Children come after their parents.
    nodes: Vec<Node<K>>,
}

struct Node<const K: usize> {
    volume: Kdop<K>,
    below: Below,
}

enum Below {
    Children([usize; 2]),
    Primitives(Vec<PrimitiveId>),
}

/// What searches did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Nodes visited, leaves included.
    pub nodes: usize,
    /// Leaves visited.
    pub leaves: usize,
}

impl<const K: usize> LeftFirst<K> {
    /// The packets of a tree as leaves, its nodes of eight as binary ones: the children of each in two halves, and so
    /// on.
    #[must_use]
    pub fn of_packets(tree: &PacketTree<Kdop<K>>) -> Self {
        let mut result = Self { directions: *tree.directions(), nodes: Vec::new() };
        if let Some(root) = tree.root() {
            result.add(tree, &[root]);
        }
        result
    }

    /// Puts a node over some parts and returns its place.
    fn add(&mut self, tree: &PacketTree<Kdop<K>>, parts: &[Part<Kdop<K>>]) -> usize {
        if let [part] = parts {
            let children: Vec<_> = tree.children(part).collect();
            if let Some(ids) = tree.primitives(part) {
                self.nodes.push(Node { volume: part.volume, below: Below::Primitives(ids.to_vec()) });
                return self.nodes.len() - 1;
            }
            return self.add(tree, &children);
        }
        let volume = parts.iter().fold(Kdop::empty(), |all, part| all.union(&part.volume));
        let at = self.nodes.len();
        self.nodes.push(Node { volume, below: Below::Primitives(Vec::new()) });
        let (left, right) = parts.split_at(parts.len() / 2);
        let children = [self.add(tree, left), self.add(tree, right)];
        self.nodes[at].below = Below::Children(children);
        at
    }

    /// The distance to the scene and the work of finding it. The search begins with the distance to some primitive, as
    /// the manual's does with a hint.
    pub fn distance<T: Real, S: PrimitiveSet<T>>(&self, set: &S, query: &Point3<T>) -> (f64, Work) {
        let q = query.map(T::to_f64).coords;
        let products = self.directions.normals().map(|normal| normal.dot(&q));
        let mut work = Work::default();
        let mut nearest = set.get(PrimitiveId::new(0)).project(query).key.distance();
        let mut open = vec![0];
        while let Some(at) = open.pop() {
            let Some(node) = self.nodes.get(at) else { continue };
            let slacks = products.iter().zip(&node.volume.heights).map(|(product, height)| product - height);
            if slacks.fold(0.0, f64::max) > nearest {
                continue;
            }
            work.nodes += 1;
            match &node.below {
                Below::Children([left, right]) => open.extend([*right, *left]),
                Below::Primitives(ids) => {
                    work.leaves += 1;
                    for id in ids {
                        nearest = nearest.min(set.get(*id).project(query).key.distance());
                    }
                }
            }
        }
        (nearest, work)
    }
}
