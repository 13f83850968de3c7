//! The border of each split rule, and the surface-area heuristic: the cost of a split, and the split that costs least.

use crate::build::options::{SplitOptions, SplitRule};
use crate::build::primitive::{BuildPrimitive, GrowingBox};

/// A measure of how likely a query is to visit a box, up to a common factor.
struct AreaMeasure {
    /// Lengths are divided by this unit, so that products do not overflow.
    unit: f64,
}

impl AreaMeasure {
    /// The measure for boxes inside of `bounds`, which is at half scale; `None` if it would overflow or divide by zero.
    fn new(bounds: &GrowingBox) -> Option<Self> {
        let unit = bounds.longest_side();
        (unit > 0.0 && unit.is_finite()).then_some(Self { unit })
    }

    /// Half of the surface area of a box.
    fn half_area(&self, bounds: &GrowingBox) -> f64 {
        let [x, y, z]: [f64; 3] = std::array::from_fn(|k| (bounds.max[k] - bounds.min[k]) / self.unit);
        x * y + y * z + z * x
    }
}

/// The number of bins along an axis.
const BINS: usize = 16;

/// A division of an interval of an axis into bins. Centres outside of the interval count for the first or the last bin.
#[derive(Clone, Copy)]
pub(crate) struct Binning {
    axis: usize,
    low: f64,
    scale: f64,
}

impl Binning {
    fn new(axis: usize, low: f64, high: f64) -> Self {
        Self { axis, low, scale: to_f64(BINS) * (1.0 - 1e-9) / (high - low) }
    }

    /// A finer division around the border below `bin`: the two bins beside the border are divided anew.
    fn refined_at(&self, bin: usize) -> Self {
        let border = |bin: usize| self.low + to_f64(bin) / self.scale;
        Self::new(self.axis, border(bin - 1), border(bin + 1))
    }

    /// Whether the interval has a positive length with which arithmetic stays finite.
    fn is_usable(&self) -> bool {
        self.scale.is_finite() && self.scale > 0.0
    }

    /// The bin of the centre of a primitive.
    #[inline]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates at 0, and is limited above")]
    pub(crate) fn bin_of(&self, primitive: &BuildPrimitive) -> usize {
        (((primitive.centre(self.axis) - self.low) * self.scale) as usize).min(BINS - 1)
    }
}

/// A split of a node: primitives whose centre falls into a bin below `bin` go left.
pub(crate) struct SplitPlane {
    pub(crate) binning: Binning,
    pub(crate) bin: usize,
    /// The cost of both sides, in units of the cost of testing a primitive.
    pub(crate) cost: f64,
}

#[inline]
#[allow(clippy::cast_precision_loss, reason = "counts are far below 2^53")]
pub(crate) fn to_f64(n: usize) -> f64 {
    n as f64
}

/// The cost of testing `n` primitives of which `block` are tested at once, in units of the cost of testing one.
fn test_cost(n: usize, block: usize) -> f64 {
    to_f64(n.div_ceil(block) * block)
}

/// The number of times that [`SplitRule::AdaptiveSah`] samples the cost again around the best position.
const RESAMPLINGS: usize = 2;

/// The cheapest split that the rule finds; `None` if there is none, or if the rule does not compare costs.
pub(crate) fn best_split(
    primitives: &[BuildPrimitive],
    bounds: &GrowingBox,
    centres: &GrowingBox,
    options: &SplitOptions,
) -> Option<SplitPlane> {
    let block = options.block.max(1);
    let measure = AreaMeasure::new(bounds)?;
    let node_area = measure.half_area(bounds);
    let on_axis = |axis: usize| Binning::new(axis, centres.min[axis], centres.max[axis]);
    let cheaper = |a: Option<SplitPlane>, b: Option<SplitPlane>| match (a, b) {
        (Some(a), Some(b)) => Some(if b.cost < a.cost { b } else { a }),
        (a, b) => a.or(b),
    };
    match options.rule {
        SplitRule::Median => None,
        SplitRule::Sah => {
            let borders = (0..3).map(|axis| cheapest_border(primitives, on_axis(axis), &measure, node_area, block));
            borders.fold(None, cheaper)
        }
        SplitRule::AdaptiveSah => {
            let mut best = cheapest_border(primitives, on_axis(bounds.longest_axis()), &measure, node_area, block)?;
            for _ in 0..RESAMPLINGS {
                let finer = cheapest_border(primitives, best.binning.refined_at(best.bin), &measure, node_area, block);
                best = cheaper(Some(best), finer)?;
            }
            Some(best)
        }
    }
}

/// The cheapest border between two bins that has primitives on both sides.
fn cheapest_border(
    primitives: &[BuildPrimitive],
    binning: Binning,
    measure: &AreaMeasure,
    node_area: f64,
    block: usize,
) -> Option<SplitPlane> {
    if !binning.is_usable() || !node_area.is_finite() {
        return None;
    }
    let mut bins = [(GrowingBox::EMPTY, 0usize); BINS];
    for primitive in primitives {
        let bin = &mut bins[binning.bin_of(primitive)];
        bin.0.add(&primitive.min, &primitive.max);
        bin.1 += 1;
    }
    // The area and the number of the primitives to the right of the border below each bin.
    let mut right = [(0.0, 0usize); BINS];
    let mut side = Side::EMPTY;
    for (k, bin) in bins.iter().enumerate().skip(1).rev() {
        side.add(bin);
        right[k] = (side.half_area(measure), side.count);
    }
    let mut best: Option<SplitPlane> = None;
    let mut side = Side::EMPTY;
    for k in 1..BINS {
        side.add(&bins[k - 1]);
        let (right_area, right_count) = right[k];
        if side.count == 0 || right_count == 0 {
            continue;
        }
        let sum = side.half_area(measure) * test_cost(side.count, block) + right_area * test_cost(right_count, block);
        // If all boxes lie on a line, every area is zero, and the most balanced split is taken.
        let cost = if node_area > 0.0 { sum / node_area } else { test_cost(side.count.max(right_count), block) };
        if best.as_ref().is_none_or(|b| cost < b.cost) {
            best = Some(SplitPlane { binning, bin: k, cost });
        }
    }
    best
}

/// The primitives on one side of a border.
struct Side {
    bounds: GrowingBox,
    count: usize,
}

impl Side {
    const EMPTY: Self = Self { bounds: GrowingBox::EMPTY, count: 0 };

    fn add(&mut self, (bounds, count): &(GrowingBox, usize)) {
        self.bounds.add(&bounds.min, &bounds.max);
        self.count += count;
    }

    fn half_area(&self, measure: &AreaMeasure) -> f64 {
        if self.count > 0 { measure.half_area(&self.bounds) } else { 0.0 }
    }
}
