//! The k-DOP tree's searches as CGAL's manual has them, to compare counters with: a binary tree, the left child first;
//! for the closest point bounds that are the largest slack of a slab, for rays an interval that every pair of slabs
//! clips.
//!
//! Written from the manual's description, for counting only.

use nalgebra::{Point3, Vector3};
use p2m_bvh::{PacketTree, TreeNode};
use p2m_core::{Primitive, PrimitiveId, PrimitiveSet, Ray, Real};
use p2m_kdop::{Directions, Kdop};
use std::cell::Cell;

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
    /// Primitives tested.
    pub primitives: usize,
}

/// So much of the size of scene and origin is added to slabs that a ray clips: 2^-40, far above the 16 u that the
/// products, the difference and the quotient err by, and below what moves a count.
const MARGIN: f64 = 1.0 / (1u64 << 40) as f64;

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

    /// A tree of its own, as the manual builds it: the primitives of a box are halved along its longest side until
    /// each one is a leaf.
    #[must_use]
    pub fn of_primitives<T: Real, S: PrimitiveSet<T>>(set: &S, directions: &Directions<K>) -> Self {
        let mut result = Self { directions: *directions, nodes: Vec::new() };
        let mut leaves: Vec<_> = (0..set.len())
            .map(|at| {
                let primitive = set.get(PrimitiveId::new(at));
                let bounds = primitive.aabb().to_f64();
                let volume = match primitive.vertices() {
                    [] => Kdop::of_box(directions, &bounds),
                    vertices => Kdop::of_points(directions, vertices),
                };
                Leaf { id: PrimitiveId::new(at), low: bounds.min, high: bounds.max, volume }
            })
            .collect();
        if !leaves.is_empty() {
            result.halve(&mut leaves);
        }
        result
    }

    /// Puts a node over some leaves and returns its place.
    fn halve(&mut self, leaves: &mut [Leaf<K>]) -> usize {
        let at = self.nodes.len();
        if let [leaf] = leaves {
            self.nodes.push(Node { volume: leaf.volume, below: Below::Primitives(vec![leaf.id]) });
            return at;
        }
        let volume = leaves.iter().fold(Kdop::empty(), |all, leaf| all.union(&leaf.volume));
        self.nodes.push(Node { volume, below: Below::Primitives(Vec::new()) });
        let low = leaves.iter().fold(leaves[0].low, |all, leaf| all.inf(&leaf.low));
        let high = leaves.iter().fold(leaves[0].high, |all, leaf| all.sup(&leaf.high));
        let (axis, middle) = ((high - low).imax(), leaves.len() / 2);
        leaves.select_nth_unstable_by(middle, |a, b| {
            (a.low[axis] + a.high[axis]).total_cmp(&(b.low[axis] + b.high[axis])).then(a.id.cmp(&b.id))
        });
        let (left, right) = leaves.split_at_mut(middle);
        let children = [self.halve(left), self.halve(right)];
        self.nodes[at].below = Below::Children(children);
        at
    }

    /// Puts a node over some parts and returns its place.
    fn add(&mut self, tree: &PacketTree<Kdop<K>>, parts: &[TreeNode<Kdop<K>>]) -> usize {
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
        let nearest = Cell::new(set.get(PrimitiveId::new(0)).project(query).key.distance());
        let work = self.walk(
            |volume| {
                let slacks = products.iter().zip(&volume.heights).map(|(product, height)| product - height);
                slacks.fold(0.0, f64::max) <= nearest.get()
            },
            |id| nearest.set(nearest.get().min(set.get(id).project(query).key.distance())),
        );
        (nearest.get(), work)
    }

    /// Tests every primitive that the ray could meet, in the leaves whose k-DOPs it overlaps, and returns the work.
    pub fn along(&self, ray: &Ray, test: impl FnMut(PrimitiveId)) -> Work {
        let Some(root) = self.nodes.first() else { return Work::default() };
        let clip = Clip::new(&self.directions, ray, &root.volume);
        self.walk(|volume| clip.overlaps(volume), test)
    }

    /// Tests the primitives of all leaves that are entered, the left ones first.
    fn walk(&self, enters: impl Fn(&Kdop<K>) -> bool, mut test: impl FnMut(PrimitiveId)) -> Work {
        let mut work = Work::default();
        let mut open = vec![0];
        while let Some(at) = open.pop() {
            let Some(node) = self.nodes.get(at).filter(|node| enters(&node.volume)) else { continue };
            work.nodes += 1;
            match &node.below {
                Below::Children([left, right]) => open.extend([*right, *left]),
                Below::Primitives(ids) => {
                    work.leaves += 1;
                    work.primitives += ids.len();
                    ids.iter().copied().for_each(&mut test);
                }
            }
        }
        work
    }

    /// What the rays do in all.
    pub fn along_all<'r>(&self, rays: impl IntoIterator<Item = &'r Ray>) -> Work {
        rays.into_iter().map(|ray| self.along(ray, |_| ())).fold(Work::default(), |all, work| Work {
            nodes: all.nodes + work.nodes,
            leaves: all.leaves + work.leaves,
            primitives: all.primitives + work.primitives,
        })
    }
}

/// A primitive on its way into the tree.
struct Leaf<const K: usize> {
    id: PrimitiveId,
    low: Point3<f64>,
    high: Point3<f64>,
    volume: Kdop<K>,
}

/// A ray as the slabs see it.
struct Clip<const K: usize> {
    range: [f64; 2],
    /// Of each normal and the origin.
    starts: [f64; K],
    /// Of each normal and the direction.
    speeds: [f64; K],
    /// Added to heights.
    margin: f64,
}

impl<const K: usize> Clip<K> {
    fn new(directions: &Directions<K>, ray: &Ray, scene: &Kdop<K>) -> Self {
        let along = |v: Vector3<f64>| directions.normals().map(|normal| normal.dot(&v));
        let size = scene.heights.iter().fold(ray.origin().coords.amax(), |size, height| size.max(height.abs()));
        Self {
            range: ray.range(),
            starts: along(ray.origin().coords),
            speeds: along(ray.direction()),
            margin: size * MARGIN + ray.radius(),
        }
    }

    /// Whether there is a parameter at which the ray is between the faces of every pair.
    fn overlaps(&self, volume: &Kdop<K>) -> bool {
        let [mut min, mut max] = self.range;
        for ((start, speed), height) in self.starts.iter().zip(&self.speeds).zip(&volume.heights) {
            let room = height + self.margin - start;
            // Into the half-space, out of it, or along its face.
            if *speed < 0.0 {
                min = min.max(room / speed);
            } else if *speed > 0.0 {
                max = max.min(room / speed);
            } else if room < 0.0 {
                return false;
            }
        }
        min <= max
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use p2m_core::Triangle;

    #[test]
    fn rays_along_a_face_are_in_the_slab_or_beside_it() {
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Point3::from);
        let set = [Triangle { vertices: corners }];
        let tree = LeftFirst::<14>::of_primitives(&set, &Directions::default());
        let leaves = |y: f64, z: f64| {
            let ray = Ray::new(&Point3::new(-1.0, y, z), &Vector3::x()).expect("a ray");
            tree.along(&ray, |_| ()).leaves
        };
        assert_eq!([leaves(0.5, 0.0), leaves(1.0, 0.0), leaves(1.1, 0.0), leaves(0.5, 0.1)], [1, 1, 0, 0]);
    }

    #[test]
    fn every_primitive_is_a_leaf_of_its_own_tree() {
        let soup = crate::scenes::skewed_gear(20);
        let tree = LeftFirst::<6>::of_primitives(&soup, &Directions::default());
        let mut leaves: Vec<_> = tree
            .nodes
            .iter()
            .filter_map(|node| match &node.below {
                Below::Primitives(ids) => Some(ids),
                Below::Children(_) => None,
            })
            .flatten()
            .map(|id| id.index())
            .collect();
        leaves.sort_unstable();
        assert_eq!(leaves, (0..soup.len()).collect::<Vec<_>>());
        assert_eq!(tree.nodes.len(), 2 * soup.len() - 1);
    }
}
