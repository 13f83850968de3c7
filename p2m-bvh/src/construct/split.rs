//! Top-down splits of the primitives into a binary tree.
//!
//! The basic idea is the usual one: a node is split in two by the [`SplitRule`](crate::SplitRule) of the options, and
//! its sides are split in turn, until testing all primitives of a node is cheaper than a further split, by the cost of
//! that rule. Three cases need more than that:
//!
//! - *No border.* If the rule returns no border (it is the median rule, or centres do not separate the primitives),
//!   each child gets half of the primitives in the order of their centres along the longest axis. Below half of
//!   [`MAX_SPLIT_DEPTH`] every node is split like that, so that no input makes the tree deep.
//! - *Equal primitives.* If more primitives than a packet has lanes have the same vertices, they become one leaf of
//!   several packets, a run. Only ids distinguish them, so a search for the nearest one reads only the first packet.
//! - *Small details.* Boxes are in f32, in a frame. A node that is much smaller than its frame gets a frame of its own,
//!   so that the details of a scene are split as well as the whole (decision 057).

use crate::construct::options::SplitOptions;
use crate::construct::primitive::{BuildPrimitive, GrowingBox};
use crate::construct::sah::{SplitPlane, best_split};
use crate::packet::{LANES, Members};
use crate::tree::MAX_DEPTH;
use crate::tree::frame::Frame;
use p2m_core::Aabb;
use p2m_core::engine::parallel::{join, thread_count};
use p2m_core::engine::simd::{InstructionSet, Isa, SimdKernel};

/// The largest depth of a binary node below the root, for any input. Half of it is for splits by cost and half for
/// halving, which suffices because sets have at most 2^30 primitives. In the tree of eight children per node, a path
/// may have two more nodes: the root itself, and one above the leaves of a node that is not split.
pub(crate) const MAX_SPLIT_DEPTH: usize = MAX_DEPTH - 2;

/// The length, in units of its frame, below which a node gets a frame of its own. A coordinate of a shorter node would
/// have fewer than 14 of the 24 bits of f32.
const MIN_SIDE: f32 = 1.0 / 1024.0;

/// A node of the binary tree. If `count` is 0, it is the parent of the nodes `first` and `first + 1`. Otherwise it is
/// the leaf of one packet, which gets `count` primitives of one kind from index `first` on. More than [`LANES`]
/// primitives have the same vertices and get a run of packets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SplitNode {
    /// Half of the surface area of the box around the node, in the frame of the scene.
    pub(crate) half_area: f64,
    pub(crate) first: u32,
    pub(crate) count: u32,
}

impl SplitNode {
    /// A node whose content is not known yet.
    const UNKNOWN: Self = Self { half_area: 0.0, first: 0, count: 0 };

    /// Returns the children of an inner node, or `None` for a leaf.
    #[cfg(test)]
    pub(crate) fn children(&self) -> Option<[usize; 2]> {
        (self.count == 0).then_some([self.first as usize, self.first as usize + 1])
    }

    /// Returns the indices of the primitives of a leaf, in the order of the leaves.
    #[cfg(test)]
    pub(crate) fn range(&self) -> std::ops::Range<usize> {
        assert!(self.count > 0, "a leaf");
        self.first as usize..self.first as usize + self.count as usize
    }
}

/// Splits primitives, which are in the frame of the scene, sorts them into the order of the leaves, and returns the
/// nodes. Node 0 is the root. An empty set has no nodes.
///
/// The primitives of one leaf are sorted by [`BuildPrimitive::rank`]. Siblings are adjacent, and everything below the
/// left one comes before everything below the right one. Parents come before their children. Neither the nodes nor the
/// order depend on the number of threads: the sides of a split have the same primitives in any order, and a leaf sorts
/// its own.
pub(crate) fn split(
    primitives: &mut [BuildPrimitive],
    frame: &Frame,
    members: Members<'_>,
    options: &SplitOptions,
) -> Vec<SplitNode> {
    if primitives.is_empty() {
        return Vec::new();
    }
    let splitter = Splitter { isa: Isa::best(), frame, members, options };
    let root = splitter.root(primitives);
    splitter.subtree(primitives, 0, root)
}

/// A node that is not split yet, with the boxes that its split needs.
#[derive(Clone, Copy)]
struct Part {
    /// The box around the primitives.
    bounds: GrowingBox,
    /// The box around the doubled centres of the primitives.
    centres: GrowingBox,
    /// The unit of the frame of the primitives, in units of the frame of the scene.
    unit: f64,
    /// Whether a frame of its own would not be finer.
    is_finest: bool,
    depth: usize,
}

impl Part {
    fn half_area(&self) -> f64 {
        f64::from(self.bounds.half_area()) * (self.unit * self.unit)
    }
}

/// The decision about a node: what it becomes in the binary tree.
enum Division {
    /// A leaf. It becomes a packet for each kind of primitive, or several packets if there are more primitives than
    /// lanes.
    Leaf,
    /// A leaf of primitives with the same vertices, in a run of packets.
    Run,
    /// The parent of two nodes. The first one gets this number of primitives.
    Sides(usize, [Part; 2]),
}

/// The fewest primitives for which the two sides of a split are built on different threads. There is no record of how
/// the number was tuned.
#[cfg(feature = "rayon")]
const MIN_PRIMITIVES_TO_FORK: usize = 1 << 13;

/// The fewest primitives of a node that several threads divide together. There is no record of how the number was
/// tuned.
const MIN_PRIMITIVES_TO_SHARE: usize = 1 << 15;

/// The data that are shared by all splits of a tree.
struct Splitter<'a> {
    isa: Isa,
    /// The frame of the scene.
    frame: &'a Frame,
    members: Members<'a>,
    options: &'a SplitOptions,
}

impl Splitter<'_> {
    /// Returns the root over primitives that are in the frame of the scene.
    fn root(&self, primitives: &[BuildPrimitive]) -> Part {
        let [bounds, centres] = bounds_of(self.isa, primitives, self.tasks(primitives.len(), 0));
        Part { bounds, centres, unit: 1.0, is_finest: false, depth: 0 }
    }

    /// Returns the number of tasks that divide a node at this depth. Near the root there are fewer nodes than threads,
    /// so several threads divide each node.
    fn tasks(&self, len: usize, depth: usize) -> usize {
        if len < MIN_PRIMITIVES_TO_SHARE {
            return 1;
        }
        (thread_count(self.options.parallel) >> depth.min(31)).max(1)
    }

    /// Returns the tree over some primitives, whose indices begin at `first`. The nodes are numbered from 0, the root
    /// of this tree.
    fn subtree(&self, primitives: &mut [BuildPrimitive], first: usize, part: Part) -> Vec<SplitNode> {
        #[cfg(feature = "rayon")]
        if self.options.parallel && primitives.len() >= MIN_PRIMITIVES_TO_FORK {
            let (left, [a, b]) = match self.divide(primitives, &part) {
                Division::Sides(left, sides) => (left, sides),
                leaf => {
                    let mut nodes = vec![SplitNode::UNKNOWN];
                    add_leaves(&mut nodes, 0, first, primitives, part.half_area(), &leaf);
                    return nodes;
                }
            };
            let (before, after) = primitives.split_at_mut(left);
            let (a, b) = join(true, || self.subtree(before, first, a), || self.subtree(after, first + left, b));
            return joined(part.half_area(), &a, &b);
        }
        let mut nodes = vec![SplitNode::UNKNOWN];
        // The nodes that still have to be split: their numbers, the ranges of their primitives, and their boxes.
        let mut pending = vec![(0usize, 0..primitives.len(), part)];
        while let Some((at, range, part)) = pending.pop() {
            let here = &mut primitives[range.clone()];
            match self.divide(here, &part) {
                Division::Sides(left, [a, b]) => {
                    let child = nodes.len();
                    nodes[at] = SplitNode { half_area: part.half_area(), first: to_u32(child), count: 0 };
                    nodes.extend([SplitNode::UNKNOWN; 2]);
                    let middle = range.start + left;
                    pending.push((child + 1, middle..range.end, b));
                    pending.push((child, range.start..middle, a));
                }
                leaf => add_leaves(&mut nodes, at, first + range.start, here, part.half_area(), &leaf),
            }
        }
        nodes
    }

    /// Sorts the primitives of a node into two sides, unless the node becomes a leaf.
    fn divide(&self, primitives: &mut [BuildPrimitive], part: &Part) -> Division {
        let Self { isa, options, .. } = *self;
        let leaf_cost = primitives.len().next_multiple_of(options.block.max(1)) as f64;
        let may_be_leaf = primitives.len() <= options.max_leaf;
        // A split costs at least the visit of its node.
        if primitives.len() <= 1 || (may_be_leaf && options.node_cost >= leaf_cost) {
            return Division::Leaf;
        }
        let is_fine = part.is_finest || part.bounds.longest_side() >= MIN_SIDE;
        let part = &if is_fine { *part } else { self.placed_anew(primitives, part) };
        let tasks = self.tasks(primitives.len(), part.depth);
        let plane = if part.depth < MAX_SPLIT_DEPTH / 2 {
            best_split(isa, primitives, &part.bounds, &part.centres, options, tasks)
        } else {
            None
        };
        let (left, bounds, centres) = match plane {
            Some(SplitPlane { cost, .. }) if may_be_leaf && f64::from(cost) + options.node_cost >= leaf_cost => {
                return Division::Leaf;
            }
            // Both sides have primitives, because `best_split` considers no other planes.
            Some(plane) => {
                let (left, centres) = partition(isa, primitives, &plane, tasks);
                (left, plane.bounds, centres)
            }
            None if may_be_leaf => return Division::Leaf,
            None if self.are_same(primitives, part) => return Division::Run,
            None => {
                let middle = primitives.len() / 2;
                self.halve(primitives, part);
                let (before, after) = primitives.split_at(middle);
                let ([a, c], [b, d]) = (bounds_of(isa, before, tasks), bounds_of(isa, after, tasks));
                (middle, [a, b], [c, d])
            }
        };
        let side = |i: usize| Part { bounds: bounds[i], centres: centres[i], depth: part.depth + 1, ..*part };
        Division::Sides(left, [side(0), side(1)])
    }

    /// Returns whether the primitives have the same vertices and are more than a packet has lanes.
    fn are_same(&self, primitives: &[BuildPrimitive], part: &Part) -> bool {
        if part.centres.longest_side() > 0.0 || primitives.len() <= LANES {
            return false;
        }
        let first = (self.members)(primitives[0].id());
        primitives.iter().all(|primitive| (self.members)(primitive.id()).is_same(&first))
    }

    /// Moves the lower half of the primitives to the front, by their centres along the longest axis. If all centres are
    /// equal, it compares vertices instead, so that primitives with the same vertices become adjacent.
    fn halve(&self, primitives: &mut [BuildPrimitive], part: &Part) {
        let middle = primitives.len() / 2;
        let ids = |a: &BuildPrimitive, b: &BuildPrimitive| a.id().cmp(&b.id());
        if part.centres.longest_side() > 0.0 {
            let axis = part.centres.longest_axis();
            primitives.select_nth_unstable_by(middle, |a, b| {
                a.centre()[axis].total_cmp(&b.centre()[axis]).then_with(|| ids(a, b))
            });
        } else {
            primitives.select_nth_unstable_by(middle, |a, b| {
                (self.members)(a.id()).compare(&(self.members)(b.id())).then_with(|| ids(a, b))
            });
        }
    }

    /// Places the primitives of a node into a frame of their own.
    #[cold]
    fn placed_anew(&self, primitives: &mut [BuildPrimitive], part: &Part) -> Part {
        let bounds = primitives
            .iter()
            .fold(Aabb::empty(), |all: Aabb<f64>, primitive| all.union(&(self.members)(primitive.id()).bounds));
        let frame = Frame::around(&bounds);
        for primitive in primitives.iter_mut() {
            *primitive = BuildPrimitive::from_member(&frame, &(self.members)(primitive.id()), primitive.id());
        }
        let [bounds, centres] = bounds_of(self.isa, primitives, 1);
        let is_finest = bounds.longest_side() < MIN_SIDE;
        Part { bounds, centres, unit: frame.unit * self.frame.per_unit, is_finest, depth: part.depth }
    }
}

/// Adds the leaves of a node that is not split, one leaf per packet, because a packet has at most [`LANES`] primitives
/// of one kind. The leaves are halved until each is alone, below the node itself, whose number is `at`. A run is one
/// leaf. The primitives, whose indices begin at `first`, are sorted.
fn add_leaves(
    nodes: &mut Vec<SplitNode>,
    at: usize,
    first: usize,
    primitives: &mut [BuildPrimitive],
    half_area: f64,
    leaf: &Division,
) {
    primitives.sort_unstable_by_key(BuildPrimitive::rank);
    // The kind is the first part of a rank, so the first and the last primitive tell whether there are several kinds.
    let is_one_kind = primitives.first().zip(primitives.last()).is_none_or(|(first, last)| first.is_same_kind(last));
    if matches!(leaf, Division::Run) || (is_one_kind && primitives.len() <= LANES) {
        nodes[at] = SplitNode { half_area, first: to_u32(first), count: to_u32(primitives.len()) };
        return;
    }
    let mut packets = Vec::new();
    let mut packet_first = to_u32(first);
    for packet in primitives.chunk_by(BuildPrimitive::is_same_kind).flat_map(|run| run.chunks(LANES)) {
        let count = to_u32(packet.len());
        packets.push(SplitNode { half_area, first: packet_first, count });
        packet_first += count;
    }
    halve_leaves(nodes, at, &packets);
}

/// Makes a node the root of a balanced tree over several leaves.
fn halve_leaves(nodes: &mut Vec<SplitNode>, at: usize, leaves: &[SplitNode]) {
    if let [leaf] = leaves {
        nodes[at] = *leaf;
        return;
    }
    let child = nodes.len();
    nodes[at] = SplitNode { half_area: leaves[0].half_area, first: to_u32(child), count: 0 };
    nodes.extend([SplitNode::UNKNOWN; 2]);
    let (before, after) = leaves.split_at(leaves.len() / 2);
    halve_leaves(nodes, child, before);
    halve_leaves(nodes, child + 1, after);
}

/// Joins two subtrees below a new root, in the order of [`split`].
#[cfg(feature = "rayon")]
fn joined(half_area: f64, a: &[SplitNode], b: &[SplitNode]) -> Vec<SplitNode> {
    let shifted = |node: &SplitNode, by: usize| match node.count {
        0 => SplitNode { first: node.first + to_u32(by), ..*node },
        _ => *node,
    };
    let (shift_a, shift_b) = (2, 1 + a.len());
    let mut nodes = Vec::with_capacity(1 + a.len() + b.len());
    nodes.extend([SplitNode { half_area, first: 1, count: 0 }, shifted(&a[0], shift_a), shifted(&b[0], shift_b)]);
    nodes.extend(a[1..].iter().map(|node| shifted(node, shift_a)));
    nodes.extend(b[1..].iter().map(|node| shifted(node, shift_b)));
    nodes
}

/// Converts a number of nodes or primitives to 32 bits.
pub(crate) fn to_u32(n: usize) -> u32 {
    u32::try_from(n).expect("2^30 primitives have less than 2^32 nodes or vertices")
}

/// Returns the box around some primitives and the box around their centres, computed by about `tasks` tasks.
fn bounds_of(isa: Isa, primitives: &[BuildPrimitive], tasks: usize) -> [GrowingBox; 2] {
    if tasks <= 1 {
        return isa.run(BoundPrimitives(primitives));
    }
    let (before, after) = primitives.split_at(primitives.len() / 2);
    let ([a, c], [b, d]) =
        join(true, || bounds_of(isa, before, tasks.div_ceil(2)), || bounds_of(isa, after, tasks.div_ceil(2)));
    [a.union(&b), c.union(&d)]
}

/// Moves the primitives below a plane to the front, with about `tasks` tasks. Returns their number and the boxes around
/// the centres of both sides. The order within a side depends on the number of tasks.
fn partition(
    isa: Isa,
    primitives: &mut [BuildPrimitive],
    plane: &SplitPlane,
    tasks: usize,
) -> (usize, [GrowingBox; 2]) {
    if tasks <= 1 {
        return isa.run(Partition { primitives, plane });
    }
    let (before, after) = primitives.split_at_mut(primitives.len() / 2);
    let ((a, [a_left, a_right]), (b, [b_left, b_right])) = join(
        true,
        || partition(isa, before, plane, tasks.div_ceil(2)),
        || partition(isa, after, plane, tasks.div_ceil(2)),
    );
    // The right side of the first half and the left side of the second half are adjacent, and have to change places. It
    // suffices to swap as many primitives as the smaller one has.
    let moved = b.min(before.len() - a);
    swap(&mut before[a..a + moved], &mut after[b - moved..b], tasks);
    (a + b, [a_left.union(&b_left), a_right.union(&b_right)])
}

/// Swaps the contents of two slices, with about `tasks` tasks.
fn swap(a: &mut [BuildPrimitive], b: &mut [BuildPrimitive], tasks: usize) {
    if tasks <= 1 {
        a.swap_with_slice(b);
        return;
    }
    let middle = a.len() / 2;
    let ((a, a_after), (b, b_after)) = (a.split_at_mut(middle), b.split_at_mut(middle));
    join(true, || swap(a, b, tasks.div_ceil(2)), || swap(a_after, b_after, tasks.div_ceil(2)));
}

/// A SIMD kernel that returns the box around some primitives and the box around their centres. It uses the instruction
/// set only through the compiler.
struct BoundPrimitives<'a>(&'a [BuildPrimitive]);

impl SimdKernel for BoundPrimitives<'_> {
    type Output = [GrowingBox; 2];

    #[inline(always)]
    fn run<I: InstructionSet>(self) -> [GrowingBox; 2] {
        let (mut bounds, mut centres) = (GrowingBox::EMPTY, GrowingBox::EMPTY);
        for primitive in self.0 {
            bounds.add::<I>(&primitive.bounds());
            centres.add::<I>(&primitive.centre_box());
        }
        [bounds, centres]
    }
}

/// A SIMD kernel that moves the primitives below a plane to the front, and returns their number and the boxes around
/// the centres of both sides. The order of the result is deterministic.
struct Partition<'a> {
    primitives: &'a mut [BuildPrimitive],
    plane: &'a SplitPlane,
}

impl SimdKernel for Partition<'_> {
    type Output = (usize, [GrowingBox; 2]);

    #[inline(always)]
    fn run<I: InstructionSet>(self) -> (usize, [GrowingBox; 2]) {
        let Self { primitives, plane } = self;
        let mut split = 0;
        let [mut left, mut right] = [GrowingBox::EMPTY; 2];
        for i in 0..primitives.len() {
            let primitive = primitives[i];
            let is_left = plane.is_left(&primitive);
            // Every primitive is swapped, so that no branch depends on its side.
            primitives[i] = primitives[split];
            primitives[split] = primitive;
            split += usize::from(is_left);
            let centre = primitive.centre_box();
            left.add::<I>(&centre.only_if(is_left));
            right.add::<I>(&centre.only_if(!is_left));
        }
        (split, [left, right])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(feature = "rayon")]
    use crate::construct::options::SplitRule;
    use crate::packet::Member;
    use nalgebra::Point3;
    use p2m_core::PrimitiveId;
    #[cfg(feature = "rayon")]
    use rand::RngExt;

    /// Splits points as a build does, and returns the nodes and the order of the points.
    fn topology(points: &[Point3<f64>], options: &SplitOptions) -> (Vec<SplitNode>, Vec<usize>) {
        let frame = Frame::around(&Aabb::from_points(points));
        let member = |id: PrimitiveId| Member::from_primitive(&p2m_core::Point::new(points[id.index()]));
        let placed = |i| BuildPrimitive::from_member(&frame, &member(PrimitiveId::new(i)), PrimitiveId::new(i));
        let mut primitives: Vec<_> = (0..points.len()).map(placed).collect();
        let nodes = split(&mut primitives, &frame, &member, options);
        (nodes, primitives.iter().map(|primitive| primitive.id().index()).collect())
    }

    fn depth(nodes: &[SplitNode]) -> usize {
        let mut deepest = 0;
        let mut pending = vec![(0, 0)];
        while let Some((at, depth)) = pending.pop() {
            deepest = deepest.max(depth);
            if let Some(children) = nodes[at].children() {
                pending.extend(children.map(|c| (c, depth + 1)));
            }
        }
        deepest
    }

    fn check(points: &[Point3<f64>]) -> Vec<SplitNode> {
        let (nodes, order) = topology(points, &SplitOptions::default());
        let mut ids = order.clone();
        ids.sort_unstable();
        assert!(ids.into_iter().eq(0..points.len()), "every primitive once");
        let leaves = nodes.iter().filter(|node| node.children().is_none());
        let mut covered: Vec<usize> = leaves.flat_map(SplitNode::range).collect();
        covered.sort_unstable();
        assert!(covered.into_iter().eq(0..points.len()), "every index in one leaf");
        assert!(depth(&nodes) <= MAX_SPLIT_DEPTH);
        for node in nodes.iter().filter(|n| n.children().is_none()) {
            let leaf = &order[node.range()];
            let are_same = leaf.iter().all(|id| points[*id] == points[leaf[0]]);
            assert!((1..=SplitOptions::default().max_leaf).contains(&leaf.len()) || are_same);
        }
        nodes
    }

    fn point(x: f64, y: f64, z: f64) -> Point3<f64> {
        Point3::new(x, y, z)
    }

    #[test]
    fn sets_without_a_cheapest_split_are_split_all_the_same() {
        check(&[point(1.0, 2.0, 3.0)]);
        assert_eq!(check(&vec![point(1.0, 2.0, 3.0); 10_000]).len(), 1);
        // A frame rounds two kinds of points to the same coordinates, and halves of the others are runs.
        let near = |i: u64| {
            if i.is_multiple_of(997) {
                point(1.0, 2.0, f64::from_bits(3f64.to_bits() + i % 3))
            } else {
                point(1.0, 2.0, 3.0)
            }
        };
        let leaves = check(&(0..10_000).map(near).collect::<Vec<_>>()).iter().filter(|node| node.count > 0).count();
        assert!(leaves < 40, "{leaves}");
        check(&(0..1000).map(|i| point(f64::from(i), 0.0, 0.0)).collect::<Vec<_>>());
        check(
            &(0..1000)
                .map(|i| point(f64::from(i % 10) * 1e300, f64::from(i / 10) * -1e306, 1.7e308))
                .collect::<Vec<_>>(),
        );
        check(&(0..1000).map(|i| point(f64::from_bits(i), 0.0, 0.0)).collect::<Vec<_>>());
    }

    #[test]
    fn geometric_progressions_do_not_make_the_tree_deep() {
        // Equal bins would separate one primitive at a time, which would give 1900 levels without a limit.
        let points: Vec<_> = (-950..950).map(|e| point(2f64.powi(e), 0.0, 0.0)).collect();
        assert!(depth(&check(&points)) > MAX_SPLIT_DEPTH / 2);
    }

    #[test]
    fn details_of_a_large_scene_are_split_as_well_as_the_whole_of_it() {
        // In a frame of the whole scene, all points of the small grid would have the same coordinates. They would be
        // split in the order of their ids, which jumps over the grid.
        let grid = (0..1024).map(|i| i * 397 % 1024).map(|i| point(f64::from(i % 32), f64::from(i / 32), 0.0));
        let points: Vec<_> = grid.chain([point(1e12, 1e12, 1e12)]).collect();
        let (nodes, order) = topology(&points, &SplitOptions::default());
        for leaf in nodes.iter().filter(|node| node.count > 0) {
            let inside = order[leaf.range()].iter().filter(|id| **id < 1024).map(|id| points[*id]);
            let bounds = Aabb::from_points(&inside.collect::<Vec<_>>());
            assert!(bounds.is_empty() || (bounds.max - bounds.min).max() < 16.0, "{bounds:?}");
        }
    }

    /// Several threads leave the primitives of a side in a different order. Neither equal centres, whose zeros may
    /// differ in sign, nor leaves of several packets may depend on that order.
    #[cfg(feature = "rayon")]
    #[test]
    fn the_tree_is_the_same_for_any_number_of_threads() {
        let mut rng = p2m_testkit::rng("splits by threads", 0);
        let count = p2m_testkit::amount(100_000, 40_000);
        let spread: Vec<Point3<f64>> =
            (0..count).map(|_| Point3::from(std::array::from_fn(|_| rng.random::<f64>()))).collect();
        let few: Vec<_> = spread.iter().map(|p| p.map(|x| (x * 3.0).floor() - 1.0)).collect();
        let zeros: Vec<_> = spread.iter().map(|p| p.map(|x| if x < 0.5 { 0.0 } else { -0.0 })).collect();
        let default = SplitOptions::default();
        let rules = SplitRule::ALL.map(|rule| SplitOptions { rule, ..default });
        let options = rules.into_iter().chain([SplitOptions { max_leaf: 64, ..default }]);
        for (options, points) in options.flat_map(|options| [&spread, &few, &zeros].map(|points| (options, points))) {
            let expected = topology(points, &options.with_parallel(false));
            for threads in [1, 2, 3, 8] {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                assert!(pool.install(|| topology(points, &options)) == expected, "{threads} threads, {options:?}");
            }
        }
    }
}
