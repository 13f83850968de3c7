//! Top-down splits.
//!
//! A node is cut in two by the [`SplitRule`] of the options, unless testing all its primitives is cheaper. Where boxes or
//! their centres tell nothing apart (identical primitives, extents that overflow), the node is halved by order; below
//! half of [`MAX_DEPTH`] every node is, so that no input makes the tree deep.

use super::cost::{Bounds, Cut, best_cut, count};
use super::{MAX_DEPTH, Node};
use crate::{Aabb, PrimitiveId, Real};
use nalgebra::Point3;

/// Where nodes are split.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum SplitRule {
    /// Where n_left A_left + n_right A_right is smallest, A being surface areas: the cost of random lines. 16 bins along each
    /// axis \[Wald2007\].
    #[default]
    Sah,
    /// The same cost along the longest side of the node alone, sampled coarsely first and then twice more finely around the
    /// best position, as in \[Cavarga2021\]; but primitives go to one side only, by their centres.
    AdaptiveSah,
    /// The cost of random balls: A is the volume of the box dilated by `radius`, the distance (in units of the scene)
    /// that most answers are expected to have. From volumes (0) it goes through surface areas to the sum of the sides
    /// (large radii). A negative or NaN radius counts as 0; an infinite one halves nodes as [`Median`](Self::Median) does. 16 bins along each axis.
    Ball {
        /// The expected distance.
        radius: f64,
    },
    /// Half of the primitives to each side, along the axis on which their centres spread most.
    Median,
}

/// How a set is split.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SplitOptions {
    /// Nodes with at most this many primitives may be leaves, larger ones are always split.
    pub max_leaf: usize,
    /// Cost of visiting an inner node, in units of the cost of testing a primitive.
    pub node_cost: f64,
    /// Where nodes are split.
    pub rule: SplitRule,
}

impl Default for SplitOptions {
    fn default() -> Self {
        Self { max_leaf: 8, node_cost: 4.0, rule: SplitRule::Sah }
    }
}

impl SplitOptions {
    /// With this rule.
    #[must_use]
    pub fn with_rule(self, rule: SplitRule) -> Self {
        Self { rule, ..self }
    }
}

/// A primitive on its way into a leaf: its box and centre in f64, at half scale so that no sum overflows.
#[derive(Clone, Copy)]
pub(super) struct Item {
    pub(super) min: [f64; 3],
    pub(super) max: [f64; 3],
    id: PrimitiveId,
}

impl Item {
    fn new<T: Real>(b: &Aabb<T>, id: PrimitiveId) -> Self {
        let half = |p: &Point3<T>| std::array::from_fn(|k| p[k].to_f64() * 0.5);
        Self { min: half(&b.min), max: half(&b.max), id }
    }

    pub(super) fn centre(&self, axis: usize) -> f64 {
        self.min[axis] + self.max[axis]
    }
}

/// The nodes without volumes, and the order of the primitives in their leaves.
pub(super) fn build<T: Real>(boxes: &[Aabb<T>], options: &SplitOptions) -> (Vec<Node<()>>, Vec<PrimitiveId>) {
    let mut items: Vec<Item> = boxes.iter().enumerate().map(|(i, b)| Item::new(b, PrimitiveId::new(i))).collect();
    let mut nodes = Vec::new();
    if items.is_empty() {
        return (nodes, Vec::new());
    }
    nodes.push(Node { volume: (), first: 0, count: 0 });
    // Nodes whose fate is open: number, places, depth. Last in, first out keeps children of one region together.
    let mut open = vec![(0usize, 0..items.len(), 0usize)];
    while let Some((at, places, depth)) = open.pop() {
        let here = &mut items[places.clone()];
        match divide(here, depth, options) {
            None => {
                // Neighbours in the user's order tend to be neighbours in memory.
                here.sort_unstable_by_key(|item| item.id);
                nodes[at] = Node { volume: (), first: index(places.start), count: index(places.len()) };
            }
            Some(left) => {
                nodes[at] = Node { volume: (), first: index(nodes.len()), count: 0 };
                let middle = places.start + left;
                let child = nodes.len();
                nodes.extend([Node { volume: (), first: 0, count: 0 }; 2]);
                open.push((child + 1, middle..places.end, depth + 1));
                open.push((child, places.start..middle, depth + 1));
            }
        }
    }
    (nodes, items.into_iter().map(|i| i.id).collect())
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
    let cut = if depth < MAX_DEPTH / 2 { best_cut(items, &bounds, &centres, options.rule) } else { None };
    match cut {
        Some(Cut { cost, .. }) if whole && cost + options.node_cost >= count(items.len()) => None,
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
            assert!((1..=8).contains(&node.places().len()));
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
}
