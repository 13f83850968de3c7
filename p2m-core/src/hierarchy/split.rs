//! Top-down splits by a binned surface-area heuristic [Wald2007].
//!
//! A node is split along the axis and at the bin border that minimise n_left A_left + n_right A_right, A being the
//! surface areas of the children's boxes, unless testing all its primitives is cheaper. Where boxes or their centres
//! tell nothing apart (identical primitives, extents that overflow), the node is halved by order; below half of
//! [`MAX_DEPTH`] every node is, so that no input makes the tree deep.

use super::{MAX_DEPTH, Node};
use crate::{Aabb, PrimitiveId, Real};
use nalgebra::Point3;

/// How finely a set is split.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SplitOptions {
    /// Nodes with at most this many primitives may be leaves, larger ones are always split.
    pub max_leaf: usize,
    /// Cost of visiting an inner node, in units of the cost of testing a primitive.
    pub node_cost: f64,
}

impl Default for SplitOptions {
    fn default() -> Self {
        Self { max_leaf: 8, node_cost: 4.0 }
    }
}

const BINS: usize = 16;

/// A primitive on its way into a leaf: its box and centre in f64, at half scale so that no sum overflows.
#[derive(Clone, Copy)]
struct Item {
    min: [f64; 3],
    max: [f64; 3],
    id: PrimitiveId,
}

impl Item {
    fn new<T: Real>(b: &Aabb<T>, id: PrimitiveId) -> Self {
        let half = |p: &Point3<T>| std::array::from_fn(|k| p[k].to_f64() * 0.5);
        Self { min: half(&b.min), max: half(&b.max), id }
    }

    fn centre(&self, axis: usize) -> f64 {
        self.min[axis] + self.max[axis]
    }
}

/// A box that grows.
#[derive(Clone, Copy)]
struct Bounds {
    min: [f64; 3],
    max: [f64; 3],
}

impl Bounds {
    const EMPTY: Self = Self { min: [f64::INFINITY; 3], max: [f64::NEG_INFINITY; 3] };

    fn add(&mut self, min: &[f64; 3], max: &[f64; 3]) {
        for k in 0..3 {
            self.min[k] = if min[k] < self.min[k] { min[k] } else { self.min[k] };
            self.max[k] = if max[k] > self.max[k] { max[k] } else { self.max[k] };
        }
    }

    /// Half the surface area, in units of `unit` squared.
    fn area(&self, unit: f64) -> f64 {
        let [x, y, z]: [f64; 3] = std::array::from_fn(|k| (self.max[k] - self.min[k]) / unit);
        x * y + y * z + z * x
    }

    fn longest_side(&self) -> f64 {
        (0..3).map(|k| self.max[k] - self.min[k]).fold(0.0, f64::max)
    }
}

/// Where to cut a node: primitives whose centre falls into a bin below `bin` go left.
struct Cut {
    axis: usize,
    bin: usize,
    cost: f64,
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
    let cut = if depth < MAX_DEPTH / 2 { best_cut(items, &bounds, &centres) } else { None };
    match cut {
        Some(cut) if whole && cut.cost + options.node_cost >= count(items.len()) => None,
        Some(cut) => {
            let bin = Binning::new(&centres, cut.axis);
            let left = partition(items, |item| bin.of(item) < cut.bin);
            // Both sides of a cut have items, by the construction of `best_cut`.
            Some(left)
        }
        None if whole => None,
        None => {
            let axis = (0..3).max_by(|a, b| {
                let side = |k: usize| centres.max[k] * 0.5 - centres.min[k] * 0.5;
                side(*a).total_cmp(&side(*b))
            });
            let axis = axis.unwrap_or(0);
            let middle = items.len() / 2;
            items
                .select_nth_unstable_by(middle, |a, b| a.centre(axis).total_cmp(&b.centre(axis)).then(a.id.cmp(&b.id)));
            Some(middle)
        }
    }
}

/// Which of the bins along an axis a centre falls into.
struct Binning {
    axis: usize,
    low: f64,
    scale: f64,
}

impl Binning {
    fn new(centres: &Bounds, axis: usize) -> Self {
        let low = centres.min[axis];
        Self { axis, low, scale: count(BINS) * (1.0 - 1e-9) / (centres.max[axis] - low) }
    }

    /// Whether the axis tells anything apart and its arithmetic stays finite.
    fn is_usable(&self) -> bool {
        self.scale.is_finite() && self.scale > 0.0
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 <= value < BINS")]
    fn of(&self, item: &Item) -> usize {
        (((item.centre(self.axis) - self.low) * self.scale) as usize).min(BINS - 1)
    }
}

#[allow(clippy::cast_precision_loss, reason = "counts are far below 2^53")]
fn count(n: usize) -> f64 {
    n as f64
}

/// The cheapest cut between two bins over all axes, in units of the cost of one primitive test; `None` if there is none.
fn best_cut(items: &[Item], bounds: &Bounds, centres: &Bounds) -> Option<Cut> {
    let unit = bounds.longest_side();
    let whole = bounds.area(unit);
    if !(unit > 0.0 && unit.is_finite() && whole.is_finite()) {
        return None;
    }
    let mut best: Option<Cut> = None;
    for axis in 0..3 {
        let binning = Binning::new(centres, axis);
        if !binning.is_usable() {
            continue;
        }
        let mut bins = [(Bounds::EMPTY, 0usize); BINS];
        for item in items {
            let bin = &mut bins[binning.of(item)];
            bin.0.add(&item.min, &item.max);
            bin.1 += 1;
        }
        let mut right = [(0.0, 0usize); BINS];
        let mut side = (Bounds::EMPTY, 0);
        for (k, bin) in bins.iter().enumerate().skip(1).rev() {
            if bin.1 > 0 {
                side.0.add(&bin.0.min, &bin.0.max);
                side.1 += bin.1;
            }
            right[k] = (if side.1 > 0 { side.0.area(unit) } else { 0.0 }, side.1);
        }
        let mut side = (Bounds::EMPTY, 0);
        for k in 1..BINS {
            let bin = &bins[k - 1];
            if bin.1 > 0 {
                side.0.add(&bin.0.min, &bin.0.max);
                side.1 += bin.1;
            }
            let (right_area, right_count) = right[k];
            if side.1 == 0 || right_count == 0 {
                continue;
            }
            let sum = side.0.area(unit) * count(side.1) + right_area * count(right_count);
            // On a line every area is zero: any balanced cut will do.
            let cost = if whole > 0.0 { sum / whole } else { count(side.1.max(right_count)) };
            if best.as_ref().is_none_or(|b| cost < b.cost) {
                best = Some(Cut { axis, bin: k, cost });
            }
        }
    }
    best
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
