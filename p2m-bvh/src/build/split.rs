//! Top-down splits.
//!
//! A node is cut in two by the [`SplitRule`] of the options, unless testing all its primitives is cheaper. Where boxes
//! or their centres tell nothing apart (identical primitives, extents that overflow), the node is halved by order;
//! below half of [`MAX_DEPTH`] every node is, so that no input makes the tree deep.

use super::{MAX_DEPTH, Node};
use crate::build::sah::{Bounds, Cut, best_cut, count};
use nalgebra::Point3;
use p2m_core::{Aabb, PrimitiveId, Real};

/// Where nodes are split.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum SplitRule {
    /// Where n_left A_left + n_right A_right is smallest, A being surface areas: the cost of random lines. 16 bins
    /// along each axis \[Wald2007\].
    #[default]
    Sah,
    /// The same cost along the longest side of the node alone, sampled coarsely first and then twice more finely around
    /// the best position, as in \[Cavarga2021\]; but primitives go to one side only, by their centres.
    AdaptiveSah,
    /// Half of the primitives to each side, along the axis on which their centres spread most.
    Median,
}

/// How a set is split. Most programs have use for `rule` and `parallel` alone.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SplitOptions {
    /// Nodes with at most this many primitives are leaves if testing them is not dearer than splitting; larger ones
    /// are always split.
    pub max_leaf: usize,
    /// How many primitives are tested at once: the cost of a leaf is that of as many blocks of this size as it fills.
    pub block: usize,
    /// Cost of visiting an inner node, in units of the cost of testing a primitive.
    pub node_cost: f64,
    /// Where nodes are split.
    pub rule: SplitRule,
    /// Whether to use all threads of the current pool; needs the feature `rayon`, without which nothing does. The tree
    /// is the same for any number of threads.
    pub parallel: bool,
}

impl Default for SplitOptions {
    /// For leaves that are packets of sixteen.
    fn default() -> Self {
        Self { max_leaf: 16, block: 16, node_cost: 16.0, rule: SplitRule::Sah, parallel: true }
    }
}

impl SplitOptions {
    /// For trees that are built more often than they are asked: halves by the median. docs/splits.md has what that
    /// saves and costs.
    #[must_use]
    pub fn fast() -> Self {
        Self::default().with_rule(SplitRule::Median)
    }
    /// With this rule.
    #[must_use]
    pub fn with_rule(self, rule: SplitRule) -> Self {
        Self { rule, ..self }
    }
    /// On one thread, or on all.
    #[must_use]
    pub fn with_parallel(self, parallel: bool) -> Self {
        Self { parallel, ..self }
    }
}

/// A primitive on its way into a leaf: its box and centre in f64, at half scale so that no sum overflows.
#[derive(Clone, Copy)]
pub(crate) struct Item {
    pub(crate) min: [f64; 3],
    pub(crate) max: [f64; 3],
    id: PrimitiveId,
}

impl Item {
    fn new<T: Real>(b: &Aabb<T>, id: PrimitiveId) -> Self {
        let half = |p: &Point3<T>| std::array::from_fn(|k| p[k].to_f64() * 0.5);
        Self { min: half(&b.min), max: half(&b.max), id }
    }

    pub(crate) fn centre(&self, axis: usize) -> f64 {
        self.min[axis] + self.max[axis]
    }
}

/// The nodes without volumes, and the order of the primitives in their leaves, in no order within one. Siblings are
/// side by side, and what is below the left one comes before what is below the right one.
pub(crate) fn build<T: Real>(boxes: &[Aabb<T>], options: &SplitOptions) -> (Vec<Node<()>>, Vec<PrimitiveId>) {
    let mut items: Vec<Item> = boxes.iter().enumerate().map(|(i, b)| Item::new(b, PrimitiveId::new(i))).collect();
    let nodes = if items.is_empty() { Vec::new() } else { subtree(&mut items, 0, 0, options) };
    (nodes, items.into_iter().map(|i| i.id).collect())
}

/// Subtrees of fewer primitives are left to one thread.
#[cfg(feature = "rayon")]
const FORK: usize = 1 << 12;

/// The tree over `items`, which take the places from `first` on; its nodes are numbered from its root, which is 0.
fn subtree(items: &mut [Item], first: usize, depth: usize, options: &SplitOptions) -> Vec<Node<()>> {
    #[cfg(feature = "rayon")]
    if options.parallel && items.len() >= FORK {
        let Some(left) = divide(items, depth, options) else { return vec![leaf(items, first)] };
        let (a, b) = items.split_at_mut(left);
        let (a, b) =
            rayon::join(|| subtree(a, first, depth + 1, options), || subtree(b, first + left, depth + 1, options));
        return joined(&a, &b);
    }
    let mut nodes = vec![Node { volume: (), first: 0, count: 0 }];
    // Nodes whose fate is open: number, places among the items, depth.
    let mut open = vec![(0usize, 0..items.len(), depth)];
    while let Some((at, places, depth)) = open.pop() {
        let here = &mut items[places.clone()];
        match divide(here, depth, options) {
            None => nodes[at] = leaf(here, first + places.start),
            Some(left) => {
                let child = nodes.len();
                nodes[at] = Node { volume: (), first: index(child), count: 0 };
                nodes.extend([Node { volume: (), first: 0, count: 0 }; 2]);
                let middle = places.start + left;
                open.push((child + 1, middle..places.end, depth + 1));
                open.push((child, places.start..middle, depth + 1));
            }
        }
    }
    nodes
}

fn leaf(items: &[Item], first: usize) -> Node<()> {
    Node { volume: (), first: index(first), count: index(items.len()) }
}

/// The tree of two subtrees, in the order of [`build`].
#[cfg(feature = "rayon")]
fn joined(a: &[Node<()>], b: &[Node<()>]) -> Vec<Node<()>> {
    let shifted = |node: &Node<()>, by: usize| match node.count {
        0 => Node { first: node.first + index(by), ..*node },
        _ => *node,
    };
    let (of_a, of_b) = (2, 1 + a.len());
    let mut nodes = Vec::with_capacity(1 + a.len() + b.len());
    nodes.extend([Node { volume: (), first: 1, count: 0 }, shifted(&a[0], of_a), shifted(&b[0], of_b)]);
    nodes.extend(a[1..].iter().map(|node| shifted(node, of_a)));
    nodes.extend(b[1..].iter().map(|node| shifted(node, of_b)));
    nodes
}

fn index(n: usize) -> u32 {
    u32::try_from(n).expect("fewer than 2^30 primitives give fewer than 2^31 nodes")
}

/// Sorts the items of a node into two sides and returns how many are on the left, or `None` to leave it whole.
fn divide(items: &mut [Item], depth: usize, options: &SplitOptions) -> Option<usize> {
    if items.len() <= 1 {
        return None;
    }
    let mut bounds = Bounds::EMPTY;
    let mut centres = Bounds::EMPTY;
    for item in items.iter() {
        bounds.add(&item.min, &item.max);
        let centre = std::array::from_fn(|k| item.centre(k));
        centres.add(&centre, &centre);
    }
    let whole = items.len() <= options.max_leaf;
    let cut = if depth < MAX_DEPTH / 2 { best_cut(items, &bounds, &centres, options) } else { None };
    match cut {
        Some(Cut { cost, .. })
            if whole && cost + options.node_cost >= count(items.len().next_multiple_of(options.block.max(1))) =>
        {
            None
        }
        // Both sides of a cut have items, by the construction of `best_cut`.
        Some(Cut { binning, bin, .. }) => Some(partition(items, |item| binning.of(item) < bin)),
        None if whole => None,
        None => {
            let axis = centres.longest_axis();
            let middle = items.len() / 2;
            items
                .select_nth_unstable_by(middle, |a, b| a.centre(axis).total_cmp(&b.centre(axis)).then(a.id.cmp(&b.id)));
            Some(middle)
        }
    }
}

/// Items for which `left` holds first, in place; returns how many those are. Deterministic.
fn partition(items: &mut [Item], left: impl Fn(&Item) -> bool) -> usize {
    let mut split = 0;
    for i in 0..items.len() {
        if left(&items[i]) {
            items.swap(i, split);
            split += 1;
        }
    }
    split
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(feature = "rayon")]
    use rand::RngExt;

    struct Topology {
        nodes: Vec<Node<()>>,
        order: Vec<PrimitiveId>,
    }

    fn depth(h: &Topology) -> usize {
        let mut deepest = 0;
        let mut open = vec![(0, 0)];
        while let Some((at, depth)) = open.pop() {
            deepest = deepest.max(depth);
            if let Some(children) = h.nodes[at].children() {
                open.extend(children.map(|c| (c, depth + 1)));
            }
        }
        deepest
    }

    fn check(boxes: &[Aabb<f64>]) -> Topology {
        let (nodes, order) = build(boxes, &SplitOptions::default());
        let h = Topology { nodes, order };
        let mut ids: Vec<usize> = h.order.iter().map(|id| id.index()).collect();
        ids.sort_unstable();
        assert!(ids.iter().copied().eq(0..boxes.len()), "every primitive once");
        let mut covered: Vec<usize> = h.nodes.iter().flat_map(|n| n.children().map_or(n.places(), |_| 0..0)).collect();
        covered.sort_unstable();
        assert!(covered.into_iter().eq(0..boxes.len()), "every place in one leaf");
        assert!(depth(&h) <= MAX_DEPTH);
        for node in h.nodes.iter().filter(|n| n.children().is_none()) {
            assert!((1..=SplitOptions::default().max_leaf).contains(&node.places().len()));
        }
        h
    }

    fn point(x: f64, y: f64, z: f64) -> Aabb<f64> {
        Aabb::of_points(&[Point3::new(x, y, z)])
    }

    #[test]
    fn sets_that_defeat_the_cost_are_split_all_the_same() {
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
        // Equal bins cut off one primitive at a time: 1900 levels if nothing stopped it.
        let boxes: Vec<_> = (-950..950).map(|e| point(2f64.powi(e), 0.0, 0.0)).collect();
        assert!(depth(&check(&boxes)) > MAX_DEPTH / 2);
    }

    #[cfg(feature = "rayon")]
    #[test]
    fn the_tree_is_the_same_for_any_number_of_threads() {
        let mut rng = p2m_testkit::rng("splits by threads", 0);
        let mut next = || rng.random::<f64>();
        let boxes: Vec<Aabb<f64>> =
            (0..p2m_testkit::amount(60_000, 20_000)).map(|_| point(next(), next(), next())).collect();
        let expected = build(&boxes, &SplitOptions::default().with_parallel(false));
        for threads in [1, 2, 5] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            assert!(pool.install(|| build(&boxes, &SplitOptions::default())) == expected, "{threads} threads");
        }
    }
}
