//! What a cut costs, and where it costs least.

use super::{SplitOptions, SplitRule};
use crate::build::split::Item;

/// A box that grows.
#[derive(Clone, Copy)]
pub(crate) struct Bounds {
    pub(crate) min: [f64; 3],
    pub(crate) max: [f64; 3],
}

impl Bounds {
    pub(crate) const EMPTY: Self = Self { min: [f64::INFINITY; 3], max: [f64::NEG_INFINITY; 3] };

    pub(crate) fn add(&mut self, min: &[f64; 3], max: &[f64; 3]) {
        for k in 0..3 {
            self.min[k] = if min[k] < self.min[k] { min[k] } else { self.min[k] };
            self.max[k] = if max[k] > self.max[k] { max[k] } else { self.max[k] };
        }
    }

    fn longest_side(&self) -> f64 {
        (0..3).map(|k| self.max[k] - self.min[k]).fold(0.0, f64::max)
    }

    /// The last one if several are as long. Halves first: a difference may overflow.
    pub(crate) fn longest_axis(&self) -> usize {
        let side = |k: usize| self.max[k] * 0.5 - self.min[k] * 0.5;
        (0..3).max_by(|a, b| side(*a).total_cmp(&side(*b))).unwrap_or(0)
    }
}

/// How likely a query is to visit a box, up to a factor.
struct Measure {
    /// Lengths are divided by this, so that nothing overflows.
    unit: f64,
}

impl Measure {
    /// For boxes inside of `bounds`, which is at half scale; `None` if numbers leave their range.
    fn new(bounds: &Bounds) -> Option<Self> {
        let unit = bounds.longest_side();
        (unit > 0.0 && unit.is_finite()).then_some(Self { unit })
    }

    /// Half of the surface area.
    fn of(&self, bounds: &Bounds) -> f64 {
        let [x, y, z]: [f64; 3] = std::array::from_fn(|k| (bounds.max[k] - bounds.min[k]) / self.unit);
        x * y + y * z + z * x
    }
}

const BINS: usize = 16;

/// Which of the bins on a part of an axis a centre falls into; those beyond it go into the first and the last.
#[derive(Clone, Copy)]
pub(crate) struct Binning {
    axis: usize,
    low: f64,
    scale: f64,
}

impl Binning {
    fn new(axis: usize, low: f64, high: f64) -> Self {
        Self { axis, low, scale: count(BINS) * (1.0 - 1e-9) / (high - low) }
    }

    /// Twice as many bins as fit around the border below `bin`: the two bins beside it, divided anew.
    fn around(&self, bin: usize) -> Self {
        let border = |bin: usize| self.low + count(bin) / self.scale;
        Self::new(self.axis, border(bin - 1), border(bin + 1))
    }

    /// Whether it tells anything apart and its arithmetic stays finite.
    fn is_usable(&self) -> bool {
        self.scale.is_finite() && self.scale > 0.0
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates at 0, and is limited above")]
    pub(crate) fn of(&self, item: &Item) -> usize {
        (((item.centre(self.axis) - self.low) * self.scale) as usize).min(BINS - 1)
    }
}

/// Where to cut a node: primitives whose centre falls into a bin below `bin` go left.
pub(crate) struct Cut {
    pub(crate) binning: Binning,
    pub(crate) bin: usize,
    /// In units of the cost of one primitive test.
    pub(crate) cost: f64,
}

#[allow(clippy::cast_precision_loss, reason = "counts are far below 2^53")]
pub(crate) fn count(n: usize) -> f64 {
    n as f64
}

/// The cost of testing `n` primitives, `block` of which are tested at once, in units of that of one primitive.
fn blocks(n: usize, block: usize) -> f64 {
    count(n.div_ceil(block) * block)
}

/// How often the article's search for the best position starts anew around the best so far.
const RESAMPLINGS: usize = 2;

/// The cheapest cut that `rule` finds; `None` if there is none, or if it does not go by cost.
pub(crate) fn best_cut(items: &[Item], bounds: &Bounds, centres: &Bounds, options: &SplitOptions) -> Option<Cut> {
    let (rule, block) = (options.rule, options.block.max(1));
    if rule == SplitRule::Median {
        return None;
    }
    let measure = Measure::new(bounds)?;
    let whole = measure.of(bounds);
    let on_axis = |axis: usize| Binning::new(axis, centres.min[axis], centres.max[axis]);
    let cheaper = |a: Option<Cut>, b: Option<Cut>| match (a, b) {
        (Some(a), Some(b)) => Some(if b.cost < a.cost { b } else { a }),
        (a, b) => a.or(b),
    };
    if rule == SplitRule::AdaptiveSah {
        let mut best = cheapest_border(items, on_axis(bounds.longest_axis()), &measure, whole, block)?;
        for _ in 0..RESAMPLINGS {
            let finer = cheapest_border(items, best.binning.around(best.bin), &measure, whole, block);
            best = cheaper(Some(best), finer)?;
        }
        return Some(best);
    }
    (0..3).map(|axis| cheapest_border(items, on_axis(axis), &measure, whole, block)).fold(None, cheaper)
}

/// The cheapest border between two bins that has items on either side.
fn cheapest_border(items: &[Item], binning: Binning, measure: &Measure, whole: f64, block: usize) -> Option<Cut> {
    if !binning.is_usable() || !whole.is_finite() {
        return None;
    }
    let mut bins = [(Bounds::EMPTY, 0usize); BINS];
    for item in items {
        let bin = &mut bins[binning.of(item)];
        bin.0.add(&item.min, &item.max);
        bin.1 += 1;
    }
    // What lies to the right of the border below each bin.
    let mut right = [(0.0, 0usize); BINS];
    let mut side = Side::EMPTY;
    for (k, bin) in bins.iter().enumerate().skip(1).rev() {
        side.add(bin);
        right[k] = (side.measure(measure), side.count);
    }
    let mut best: Option<Cut> = None;
    let mut side = Side::EMPTY;
    for k in 1..BINS {
        side.add(&bins[k - 1]);
        let (right_measure, right_count) = right[k];
        if side.count == 0 || right_count == 0 {
            continue;
        }
        let sum = side.measure(measure) * blocks(side.count, block) + right_measure * blocks(right_count, block);
        // On a line every area is zero: any balanced cut will do.
        let cost = if whole > 0.0 { sum / whole } else { blocks(side.count.max(right_count), block) };
        if best.as_ref().is_none_or(|b| cost < b.cost) {
            best = Some(Cut { binning, bin: k, cost });
        }
    }
    best
}

/// What lies on one side of a border.
struct Side {
    bounds: Bounds,
    count: usize,
}

impl Side {
    const EMPTY: Self = Self { bounds: Bounds::EMPTY, count: 0 };

    fn add(&mut self, (bounds, count): &(Bounds, usize)) {
        self.bounds.add(&bounds.min, &bounds.max);
        self.count += count;
    }

    fn measure(&self, measure: &Measure) -> f64 {
        if self.count > 0 { measure.of(&self.bounds) } else { 0.0 }
    }
}
