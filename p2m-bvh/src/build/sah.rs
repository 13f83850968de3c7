//! The border of each split rule, and the surface-area heuristic: the cost of a split, and the split that costs least.

use crate::build::options::{SplitOptions, SplitRule};
use crate::build::primitive::{BuildPrimitive, GrowingBox};
use p2m_core::engine::simd::{InstructionSet, Isa, SimdKernel};
use p2m_core::engine::vector::{exponent, power_of_two};

/// A measure of how likely a query is to visit a box, up to a common factor.
struct AreaMeasure {
    /// Lengths are multiplied by this power of two, so that products do not overflow.
    per_unit: f64,
}

impl AreaMeasure {
    /// The measure for boxes inside of `bounds`, which is at half scale; `None` if it would overflow or divide by zero.
    fn new(bounds: &GrowingBox) -> Option<Self> {
        let longest = bounds.longest_side();
        let is_usable = longest > 0.0 && longest.is_finite();
        // The power is at most 2^1022, with which the longest side of a subnormal length stays below 1.
        is_usable.then(|| Self { per_unit: power_of_two((-exponent(longest)).clamp(-1022, 1022)) })
    }

    /// Half of the surface area of a box.
    fn half_area(&self, bounds: &GrowingBox) -> f64 {
        let [x, y, z]: [f64; 3] = std::array::from_fn(|k| (bounds.max(k) - bounds.min(k)) * self.per_unit);
        x * y + y * z + z * x
    }
}

/// The number of bins along an axis.
const BINS: usize = 16;
/// The number of the last bin.
const LAST_BIN: f64 = 15.0;
const _: () = assert!(BINS == 16);

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

    /// The bin of the centre of a primitive. It never decreases while the centre moves up.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "the lowest bits are those of a bin")]
    pub(crate) fn bin_of(&self, primitive: &BuildPrimitive) -> usize {
        // At this size the unit in the last place is 1, so the sum is rounded to an integer, whose lowest bits are
        // those of its mantissa. That takes fewer instructions than a conversion.
        const SHIFT: f64 = power_of_two(52);
        let bin = (primitive.centre(self.axis) - self.low) * self.scale - 0.5;
        // The number is NaN if the binning is not usable, and then the first bin has all primitives.
        let bin = if bin > 0.0 { bin } else { 0.0 };
        let bin = if bin < LAST_BIN { bin } else { LAST_BIN };
        (bin + SHIFT).to_bits() as usize % BINS
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
#[inline(always)]
fn test_cost(n: usize, block: usize) -> f64 {
    // The usual sizes need no division.
    let tested = if block.is_power_of_two() { (n + block - 1) & !(block - 1) } else { n.next_multiple_of(block) };
    to_f64(tested)
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
    let on_axis = |axis: usize| Binning::new(axis, centres.min(axis), centres.max(axis));
    let cheaper = |a: Option<SplitPlane>, b: Option<SplitPlane>| match (a, b) {
        (Some(a), Some(b)) => Some(if b.cost < a.cost { b } else { a }),
        (a, b) => a.or(b),
    };
    match options.rule {
        SplitRule::Median => None,
        SplitRule::Sah => {
            let binnings = [on_axis(0), on_axis(1), on_axis(2)];
            let bins = Bins::of(primitives, &binnings);
            let borders = binnings.into_iter().zip(&bins);
            borders
                .map(|(binning, bins)| cheapest_border(bins, binning, &measure, node_area, block))
                .fold(None, cheaper)
        }
        SplitRule::AdaptiveSah => {
            let border_of = |binning: Binning| {
                let [bins] = Bins::of(primitives, &[binning]);
                cheapest_border(&bins, binning, &measure, node_area, block)
            };
            let mut best = border_of(on_axis(bounds.longest_axis()))?;
            for _ in 0..RESAMPLINGS {
                let finer = border_of(best.binning.refined_at(best.bin));
                best = cheaper(Some(best), finer)?;
            }
            Some(best)
        }
    }
}

/// The boxes and the numbers of the primitives in the bins of an axis.
#[derive(Clone, Copy)]
struct Bins([(GrowingBox, usize); BINS]);

impl Bins {
    /// Sorts primitives into the bins of several binnings.
    fn of<const N: usize>(primitives: &[BuildPrimitive], binnings: &[Binning; N]) -> [Self; N] {
        let mut bins = [Self([(GrowingBox::EMPTY, 0); BINS]); N];
        Isa::best().run(FillBins { primitives, binnings, bins: &mut bins });
        bins
    }
}

/// A SIMD kernel that adds primitives to bins. It uses the instruction set only through the compiler.
struct FillBins<'a, const N: usize> {
    primitives: &'a [BuildPrimitive],
    binnings: &'a [Binning; N],
    bins: &'a mut [Bins; N],
}

impl<const N: usize> SimdKernel for FillBins<'_, N> {
    type Output = ();

    #[inline(always)]
    fn run<I: InstructionSet>(self) {
        for primitive in self.primitives {
            for (binning, bins) in self.binnings.iter().zip(self.bins.iter_mut()) {
                let (bounds, count) = &mut bins.0[binning.bin_of(primitive)];
                bounds.add(&primitive.bounds);
                *count += 1;
            }
        }
    }
}

/// The cheapest border between two bins that has primitives on both sides.
fn cheapest_border(
    Bins(bins): &Bins,
    binning: Binning,
    measure: &AreaMeasure,
    node_area: f64,
    block: usize,
) -> Option<SplitPlane> {
    if !binning.is_usable() || !node_area.is_finite() {
        return None;
    }
    // The area and the number of the primitives to the right of the border below each bin.
    let mut right = [(0.0, 0usize); BINS];
    let mut side = Side::EMPTY;
    for (k, bin) in bins.iter().enumerate().skip(1).rev() {
        if bin.1 > 0 {
            side.add(bin);
            right[k] = (side.half_area(measure), side.count);
        }
    }
    let mut best: Option<SplitPlane> = None;
    let mut side = Side::EMPTY;
    let mut after = 0;
    for (k, bin) in bins.iter().enumerate() {
        if bin.1 == 0 {
            continue;
        }
        // Borders beside empty bins divide the primitives as the first border before them does.
        let border = std::mem::replace(&mut after, k + 1);
        let (right_area, right_count) = right[k];
        if side.count > 0 {
            let left_cost = side.half_area(measure) * test_cost(side.count, block);
            let sum = left_cost + right_area * test_cost(right_count, block);
            // If all boxes lie on a line, every area is zero, and the most balanced split is taken.
            let cost = if node_area > 0.0 { sum / node_area } else { test_cost(side.count.max(right_count), block) };
            if best.as_ref().is_none_or(|b| cost < b.cost) {
                best = Some(SplitPlane { binning, bin: border, cost });
            }
        }
        side.add(bin);
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
        self.bounds.add(bounds);
        self.count += count;
    }

    fn half_area(&self, measure: &AreaMeasure) -> f64 {
        if self.count > 0 { measure.half_area(&self.bounds) } else { 0.0 }
    }
}
