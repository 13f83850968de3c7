//! The searches of the k-DOP tree in CGAL's manual, for a comparison of counters.
//!
//! The tree is binary and the left child is visited first. Closest-point queries bound a node by the largest slack of a
//! slab. Rays keep an interval that every pair of slabs clips. The code follows the manual's description and is for
//! counting only.

use nalgebra::{Point3, Vector3};
use p2m_bvh::{PacketTree, TreeNode};
use p2m_core::{Primitive, PrimitiveId, PrimitiveSet, Ray, Real};
use p2m_kdop::{Directions, Kdop};
use std::cell::Cell;

/// A binary tree of k-DOPs.
pub struct LeftFirst<const K: usize> {
    directions: Directions<K>,
    /// The nodes; children come after their parents.
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

/// The work of searches.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Nodes visited, leaves included.
    pub nodes: usize,
    /// The number of leaves visited.
    pub leaves: usize,
    /// The number of primitives tested.
    pub primitives: usize,
}

/// The margin of slabs that a ray clips, relative to the sizes of scene and origin. It is 2^-40, far above the 16 u by
/// which the products, the difference and the quotient err, and too small to change a count.
const RELATIVE_MARGIN: f64 = 1.0 / (1u64 << 40) as f64;

impl<const K: usize> LeftFirst<K> {
    /// Builds a tree whose leaves are the packets of another tree. Each node of eight children becomes binary nodes by
    /// halving its children repeatedly.
    #[must_use]
    pub fn from_packets(tree: &PacketTree<Kdop<K>>) -> Self {
        let mut result = Self { directions: *tree.directions(), nodes: Vec::new() };
        if let Some(root) = tree.root() {
            result.add(tree, &[root]);
        }
        result
    }

    /// Builds a tree as the manual does: the primitives of a box are halved along its longest side until each one
    /// is a leaf.
    #[must_use]
    pub fn from_primitives<T: Real, S: PrimitiveSet<T>>(set: &S, directions: &Directions<K>) -> Self {
        let mut result = Self { directions: *directions, nodes: Vec::new() };
        let mut leaves: Vec<_> = (0..set.len())
            .map(|at| {
                let primitive = set.get(PrimitiveId::new(at));
                let bounds = primitive.aabb().to_f64();
                let volume = match primitive.vertices() {
                    [] => Kdop::from_box(directions, &bounds),
                    vertices => Kdop::from_points(directions, vertices),
                };
                Leaf { id: PrimitiveId::new(at), low: bounds.min, high: bounds.max, volume }
            })
            .collect();
        if !leaves.is_empty() {
            result.halve(&mut leaves);
        }
        result
    }

    /// Adds a node over some leaves and returns its index.
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

    /// Adds a node over some subtrees and returns its index.
    fn add(&mut self, tree: &PacketTree<Kdop<K>>, subtrees: &[TreeNode<Kdop<K>>]) -> usize {
        if let [part] = subtrees {
            let children: Vec<_> = tree.children(part).collect();
            if let Some(ids) = tree.primitives(part) {
                self.nodes.push(Node { volume: part.volume, below: Below::Primitives(ids.to_vec()) });
                return self.nodes.len() - 1;
            }
            return self.add(tree, &children);
        }
        let volume = subtrees.iter().fold(Kdop::empty(), |all, part| all.union(&part.volume));
        let at = self.nodes.len();
        self.nodes.push(Node { volume, below: Below::Primitives(Vec::new()) });
        let (left, right) = subtrees.split_at(subtrees.len() / 2);
        let children = [self.add(tree, left), self.add(tree, right)];
        self.nodes[at].below = Below::Children(children);
        at
    }

    /// Returns the distance to the scene and the work of finding it. The search begins with the distance to some
    /// primitive, as the manual's search begins with a hint.
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

    /// Tests every primitive that the ray may intersect, in the leaves whose k-DOPs it overlaps, and returns the work.
    pub fn along(&self, ray: &Ray, test: impl FnMut(PrimitiveId)) -> Work {
        let Some(root) = self.nodes.first() else { return Work::default() };
        let clip = Clip::new(&self.directions, ray, &root.volume);
        self.walk(|volume| clip.overlaps(volume), test)
    }

    /// Tests the primitives of all leaves that `enters` accepts, the left ones first.
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

    /// Returns the work of several rays in all.
    pub fn along_all<'r>(&self, rays: impl IntoIterator<Item = &'r Ray>) -> Work {
        rays.into_iter().map(|ray| self.along(ray, |_| ())).fold(Work::default(), |all, work| Work {
            nodes: all.nodes + work.nodes,
            leaves: all.leaves + work.leaves,
            primitives: all.primitives + work.primitives,
        })
    }
}

/// A primitive that is being inserted into the tree.
struct Leaf<const K: usize> {
    id: PrimitiveId,
    low: Point3<f64>,
    high: Point3<f64>,
    volume: Kdop<K>,
}

/// A ray in the frame of the slabs.
struct Clip<const K: usize> {
    range: [f64; 2],
    /// The dot products of the normals with the origin.
    starts: [f64; K],
    /// The dot products of the normals with the direction.
    speeds: [f64; K],
    /// The margin that is added to heights.
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
            margin: size * RELATIVE_MARGIN + ray.radius(),
        }
    }

    /// Returns whether the ray is between the faces of every pair at a common parameter.
    fn overlaps(&self, volume: &Kdop<K>) -> bool {
        let [mut min, mut max] = self.range;
        for ((start, speed), height) in self.starts.iter().zip(&self.speeds).zip(&volume.heights) {
            let distance = height + self.margin - start;
            // The ray enters the half-space, leaves it, or is parallel to its face.
            if *speed < 0.0 {
                min = min.max(distance / speed);
            } else if *speed > 0.0 {
                max = max.min(distance / speed);
            } else if distance < 0.0 {
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
        let tree = LeftFirst::<14>::from_primitives(&set, &Directions::default());
        let leaves = |y: f64, z: f64| {
            let ray = Ray::new(&Point3::new(-1.0, y, z), &Vector3::x()).expect("a ray");
            tree.along(&ray, |_| ()).leaves
        };
        assert_eq!([leaves(0.5, 0.0), leaves(1.0, 0.0), leaves(1.1, 0.0), leaves(0.5, 0.1)], [1, 1, 0, 0]);
    }

    #[test]
    fn every_primitive_is_a_leaf_of_its_own_tree() {
        let soup = crate::scenes::skewed_gear(20);
        let tree = LeftFirst::<6>::from_primitives(&soup, &Directions::default());
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
