//! Top-down splits.
//!
//! A node is split in two by the [`SplitRule`](crate::SplitRule) of the options, unless testing all its primitives is
//! cheaper by the cost of that rule. If the rule returns no border (it is the rule of medians, or boxes and their
//! centres do not separate the primitives, or their extent overflows), each child gets half of them in the order of
//! their centres along the longest axis. Below half of [`MAX_SPLIT_DEPTH`] every node is
//! split like that, so that no input makes the tree deep.

use crate::build::options::SplitOptions;
use crate::build::primitive::{BuildPrimitive, GrowingBox};
use crate::build::sah::{SplitPlane, best_split, to_f64};
use crate::tree::MAX_DEPTH;
use p2m_core::engine::simd::{InstructionSet, Isa, SimdKernel};
use p2m_core::{Aabb, PrimitiveId, Real};

/// The largest depth of a node below the root, whatever the input. Half of it is for splits by cost and half for
/// halving, which suffices because sets have at most 2^30 primitives. A tree of eight children per node may have two
/// nodes more on a path: the root itself, and one above the packets of a leaf with several kinds.
pub(crate) const MAX_SPLIT_DEPTH: usize = MAX_DEPTH - 2;

/// A node of the binary tree: either a leaf with `count` primitives from index `first` on, or, if `count` is 0, the
/// parent of the nodes `first` and `first + 1`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SplitNode<V> {
    /// A volume that contains everything below the node.
    pub(crate) volume: V,
    pub(crate) first: u32,
    pub(crate) count: u32,
}

impl<V> SplitNode<V> {
    /// The children of an inner node; `None` for a leaf.
    pub(crate) fn children(&self) -> Option<[usize; 2]> {
        (self.count == 0).then_some([self.first as usize, self.first as usize + 1])
    }

    /// The indices of the primitives of a leaf in the order of the leaves; an empty range for an inner node.
    pub(crate) fn range(&self) -> std::ops::Range<usize> {
        let first = if self.count == 0 { 0 } else { self.first as usize };
        first..first + self.count as usize
    }
}

/// Splits boxes, and returns the nodes without volumes and the primitives in the order of the leaves.
///
/// The primitives of one leaf are in no particular order. Siblings are side by side, and everything below the left one
/// comes before everything below the right one.
pub(crate) fn split<T: Real>(boxes: &[Aabb<T>], options: &SplitOptions) -> (Vec<SplitNode<()>>, Vec<PrimitiveId>) {
    let mut primitives: Vec<BuildPrimitive> =
        boxes.iter().enumerate().map(|(i, b)| BuildPrimitive::new(b, PrimitiveId::new(i))).collect();
    let nodes = if primitives.is_empty() { Vec::new() } else { subtree(&mut primitives, 0, 0, options) };
    (nodes, primitives.into_iter().map(|i| i.id).collect())
}

/// The least number of primitives for which the two sides of a split are built on different threads.
#[cfg(feature = "rayon")]
const MIN_PRIMITIVES_TO_FORK: usize = 1 << 12;

/// The tree over some primitives, which have the indices from `first` on. Its nodes are numbered from its root,
/// which is 0.
fn subtree(
    primitives: &mut [BuildPrimitive],
    first: usize,
    depth: usize,
    options: &SplitOptions,
) -> Vec<SplitNode<()>> {
    #[cfg(feature = "rayon")]
    if options.parallel && primitives.len() >= MIN_PRIMITIVES_TO_FORK {
        let Some(left) = divide(primitives, depth, options) else { return vec![leaf(primitives, first)] };
        let (a, b) = primitives.split_at_mut(left);
        let (a, b) =
            rayon::join(|| subtree(a, first, depth + 1, options), || subtree(b, first + left, depth + 1, options));
        return joined(&a, &b);
    }
    let mut nodes = vec![SplitNode { volume: (), first: 0, count: 0 }];
    // The nodes that still have to be split: their numbers, the ranges of their primitives and their depths.
    let mut pending = vec![(0usize, 0..primitives.len(), depth)];
    while let Some((at, range, depth)) = pending.pop() {
        let here = &mut primitives[range.clone()];
        match divide(here, depth, options) {
            None => nodes[at] = leaf(here, first + range.start),
            Some(left) => {
                let child = nodes.len();
                nodes[at] = SplitNode { volume: (), first: to_u32(child), count: 0 };
                nodes.extend([SplitNode { volume: (), first: 0, count: 0 }; 2]);
                let middle = range.start + left;
                pending.push((child + 1, middle..range.end, depth + 1));
                pending.push((child, range.start..middle, depth + 1));
            }
        }
    }
    nodes
}

fn leaf(primitives: &[BuildPrimitive], first: usize) -> SplitNode<()> {
    SplitNode { volume: (), first: to_u32(first), count: to_u32(primitives.len()) }
}

/// Joins two subtrees below a new root, in the order of [`split`].
#[cfg(feature = "rayon")]
fn joined(a: &[SplitNode<()>], b: &[SplitNode<()>]) -> Vec<SplitNode<()>> {
    let shifted = |node: &SplitNode<()>, by: usize| match node.count {
        0 => SplitNode { first: node.first + to_u32(by), ..*node },
        _ => *node,
    };
    let (shift_a, shift_b) = (2, 1 + a.len());
    let mut nodes = Vec::with_capacity(1 + a.len() + b.len());
    nodes.extend([SplitNode { volume: (), first: 1, count: 0 }, shifted(&a[0], shift_a), shifted(&b[0], shift_b)]);
    nodes.extend(a[1..].iter().map(|node| shifted(node, shift_a)));
    nodes.extend(b[1..].iter().map(|node| shifted(node, shift_b)));
    nodes
}

fn to_u32(n: usize) -> u32 {
    u32::try_from(n).expect("fewer than 2^30 primitives give fewer than 2^31 nodes")
}

/// Sorts the primitives of a node into two sides and returns how many are on the left, or `None` if the node is to
/// be a leaf.
fn divide(primitives: &mut [BuildPrimitive], depth: usize, options: &SplitOptions) -> Option<usize> {
    if primitives.len() <= 1 {
        return None;
    }
    let [bounds, centres] = Isa::best().run(BoundPrimitives(primitives));
    let may_be_leaf = primitives.len() <= options.max_leaf;
    let plane = if depth < MAX_SPLIT_DEPTH / 2 { best_split(primitives, &bounds, &centres, options) } else { None };
    match plane {
        Some(SplitPlane { cost, .. })
            if may_be_leaf
                && cost + options.node_cost >= to_f64(primitives.len().next_multiple_of(options.block.max(1))) =>
        {
            None
        }
        // Both sides have primitives, because `best_split` considers no other planes.
        Some(SplitPlane { binning, bin, .. }) => {
            Some(partition(primitives, |primitive| binning.bin_of(primitive) < bin))
        }
        None if may_be_leaf => None,
        None => {
            let axis = centres.longest_axis();
            let middle = primitives.len() / 2;
            primitives
                .select_nth_unstable_by(middle, |a, b| a.centre(axis).total_cmp(&b.centre(axis)).then(a.id.cmp(&b.id)));
            Some(middle)
        }
    }
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
            bounds.add(&primitive.bounds);
            let centre = [primitive.centre(0), primitive.centre(1), primitive.centre(2)];
            centres.add(&GrowingBox::new(centre, centre));
        }
        [bounds, centres]
    }
}

/// Moves the primitives for which `is_left` holds to the front and returns their number. The order of the
/// result is deterministic.
fn partition(primitives: &mut [BuildPrimitive], is_left: impl Fn(&BuildPrimitive) -> bool) -> usize {
    let mut split = 0;
    for i in 0..primitives.len() {
        if is_left(&primitives[i]) {
            primitives.swap(i, split);
            split += 1;
        }
    }
    split
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;
    #[cfg(feature = "rayon")]
    use rand::RngExt;

    struct Topology {
        nodes: Vec<SplitNode<()>>,
        order: Vec<PrimitiveId>,
    }

    fn depth(h: &Topology) -> usize {
        let mut deepest = 0;
        let mut pending = vec![(0, 0)];
        while let Some((at, depth)) = pending.pop() {
            deepest = deepest.max(depth);
            if let Some(children) = h.nodes[at].children() {
                pending.extend(children.map(|c| (c, depth + 1)));
            }
        }
        deepest
    }

    fn check(boxes: &[Aabb<f64>]) -> Topology {
        let (nodes, order) = split(boxes, &SplitOptions::default());
        let h = Topology { nodes, order };
        let mut ids: Vec<usize> = h.order.iter().map(|id| id.index()).collect();
        ids.sort_unstable();
        assert!(ids.iter().copied().eq(0..boxes.len()), "every primitive once");
        let mut covered: Vec<usize> = h.nodes.iter().flat_map(|n| n.children().map_or(n.range(), |_| 0..0)).collect();
        covered.sort_unstable();
        assert!(covered.into_iter().eq(0..boxes.len()), "every index in one leaf");
        assert!(depth(&h) <= MAX_SPLIT_DEPTH);
        for node in h.nodes.iter().filter(|n| n.children().is_none()) {
            assert!((1..=SplitOptions::default().max_leaf).contains(&node.range().len()));
        }
        h
    }

    fn point(x: f64, y: f64, z: f64) -> Aabb<f64> {
        Aabb::from_points(&[Point3::new(x, y, z)])
    }

    #[test]
    fn sets_without_a_cheapest_split_are_split_all_the_same() {
        check(&[point(1.0, 2.0, 3.0)]);
        check(&vec![point(1.0, 2.0, 3.0); 10_000]);
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
        // Equal bins separate one primitive at a time, which would give 1900 levels without a limit.
        let boxes: Vec<_> = (-950..950).map(|e| point(2f64.powi(e), 0.0, 0.0)).collect();
        assert!(depth(&check(&boxes)) > MAX_SPLIT_DEPTH / 2);
    }

    #[cfg(feature = "rayon")]
    #[test]
    fn the_tree_is_the_same_for_any_number_of_threads() {
        let mut rng = p2m_testkit::rng("splits by threads", 0);
        let mut next = || rng.random::<f64>();
        let boxes: Vec<Aabb<f64>> =
            (0..p2m_testkit::amount(60_000, 20_000)).map(|_| point(next(), next(), next())).collect();
        let expected = split(&boxes, &SplitOptions::default().with_parallel(false));
        for threads in [1, 2, 5] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            assert!(pool.install(|| split(&boxes, &SplitOptions::default())) == expected, "{threads} threads");
        }
    }
}
