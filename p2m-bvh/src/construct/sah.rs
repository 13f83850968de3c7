//! The binned surface-area heuristic: the cost of a split, and the cheapest split by each rule.
//!
//! The basic idea \[Wald2007\]: a random line that hits a box hits a smaller box inside of it with a probability that
//! is the ratio of their surface areas. So a split into two sides costs about the area of each side times the number of
//! its primitives, divided by the area of the node. To find a cheap split, primitives are counted in 16 bins along an
//! axis by their centres, and two sweeps over the bins, from both ends, give the areas and numbers on both sides of the
//! 15 borders.

use crate::construct::options::{SplitOptions, SplitRule};
use crate::construct::primitive::{BuildPrimitive, GrowingBox};
use p2m_core::engine::parallel::join;
use p2m_core::engine::simd::{InstructionSet, Isa, SimdKernel};

/// The number of bins along an axis. More bins give 2 % fewer nodes for 20 % more build time
/// (docs/decisions/rejected.md).
const BINS: usize = 16;
/// The number of the last bin.
const LAST_BIN: f32 = 15.0;
const _: () = assert!(BINS == 16);

/// A division of an interval of each axis into bins. Centres outside of the interval count for the first or the last
/// bin.
#[derive(Clone, Copy)]
pub(crate) struct Binning {
    low: [f32; 4],
    /// Bins per unit of length. It is 0 along an axis whose interval is so short that the quotient would not be finite;
    /// the first bin then has all primitives.
    scale: [f32; 4],
}

impl Binning {
    /// Creates the bins over a box around the centres of the primitives.
    #[inline(always)]
    fn of(centres: &GrowingBox) -> Self {
        let mut binning = Self { low: [0.0; 4], scale: [0.0; 4] };
        for axis in 0..3 {
            binning.set(axis, centres.min(axis), centres.max(axis));
        }
        binning
    }

    /// Sets the interval of an axis.
    #[inline(always)]
    fn set(&mut self, axis: usize, low: f32, high: f32) {
        // In spite of all roundings, the centre at the upper end falls into the last bin.
        const UNROUNDED_BINS: f32 = 16.0 * (1.0 - 4.0 * f32::EPSILON);
        let scale = UNROUNDED_BINS / (high - low);
        self.low[axis] = low;
        self.scale[axis] = if scale.is_finite() && scale > 0.0 { scale } else { 0.0 };
    }

    /// Returns a finer division around the border below `bin`: the two bins beside the border are divided anew.
    fn refined_at(mut self, axis: usize, bin: usize) -> Self {
        let border = |bin: u8| self.low[axis] + f32::from(bin) / self.scale[axis];
        let bin = u8::try_from(bin).expect("there are sixteen bins");
        let [low, high] = [border(bin - 1), border(bin + 1)];
        self.set(axis, low, high);
        self
    }

    /// Returns the bin of a centre along an axis, given twice its coordinate. It never decreases as the centre moves
    /// up.
    #[inline(always)]
    fn bin_at(&self, axis: usize, centre: f32) -> u32 {
        // At this magnitude the unit in the last place is 1, so the sum is rounded to an integer, whose lowest bits are
        // the lowest bits of the mantissa. That takes fewer instructions than a conversion.
        const SHIFT: f32 = (1u32 << 23) as f32;
        let bin = (centre - self.low[axis]) * self.scale[axis] - 0.5;
        let bin = if bin > 0.0 { bin } else { 0.0 };
        let bin = if bin < LAST_BIN { bin } else { LAST_BIN };
        (bin + SHIFT).to_bits() % 16
    }

    /// Returns the bins of the centre of a primitive along all axes.
    #[inline(always)]
    fn bins_of(&self, primitive: &BuildPrimitive) -> [u32; 4] {
        let centre = primitive.centre();
        std::array::from_fn(|k| self.bin_at(k, centre[k]))
    }
}

/// A split of a node. Primitives whose centre falls into a bin below `bin` along the axis go left.
pub(crate) struct SplitPlane {
    binning: Binning,
    axis: usize,
    bin: usize,
    /// The cost of both sides, in units of the cost of testing a primitive.
    pub(crate) cost: f32,
    /// The boxes around the primitives of both sides.
    pub(crate) bounds: [GrowingBox; 2],
}

impl SplitPlane {
    /// Returns whether a primitive goes left.
    #[inline(always)]
    pub(crate) fn is_left(&self, primitive: &BuildPrimitive) -> bool {
        (self.binning.bin_at(self.axis, primitive.centre_at(self.axis)) as usize) < self.bin
    }
}

/// The number of times that [`SplitRule::AdaptiveSah`] resamples the cost around the best position.
const RESAMPLINGS: usize = 2;

/// Returns the cheapest split that the rule finds, or `None` if there is none or the rule does not compare costs. About
/// `tasks` tasks sort the primitives into bins.
pub(crate) fn best_split(
    isa: Isa,
    primitives: &[BuildPrimitive],
    bounds: &GrowingBox,
    centres: &GrowingBox,
    options: &SplitOptions,
    tasks: usize,
) -> Option<SplitPlane> {
    let (node_area, block) = (bounds.half_area(), options.block.max(1));
    let binning = Binning::of(centres);
    match options.rule {
        SplitRule::Median => None,
        SplitRule::Sah => {
            let axes = [0, 1, 2];
            let bins = fill_bins(isa, primitives, axes, &binning, tasks);
            isa.run(FindBorder { bins: &bins, axes, binning, node_area, block })
        }
        SplitRule::AdaptiveSah => {
            let axes = [bounds.longest_axis()];
            let border_of = |binning| {
                let bins = fill_bins(isa, primitives, axes, &binning, tasks);
                isa.run(FindBorder { bins: &bins, axes, binning, node_area, block })
            };
            let mut best = border_of(binning)?;
            for _ in 0..RESAMPLINGS {
                let finer = border_of(best.binning.refined_at(best.axis, best.bin));
                best = finer.filter(|finer| finer.cost < best.cost).unwrap_or(best);
            }
            Some(best)
        }
    }
}

/// The boxes and the numbers of the primitives in the bins of an axis.
#[derive(Clone, Copy)]
struct Bins {
    boxes: [GrowingBox; BINS],
    counts: [u32; BINS],
}

impl Bins {
    const EMPTY: Self = Self { boxes: [GrowingBox::EMPTY; BINS], counts: [0; BINS] };

    /// Adds the contents of other bins of the same division.
    fn add(&mut self, other: &Self) {
        self.boxes.iter_mut().zip(&other.boxes).for_each(|(bin, other)| *bin = bin.union(other));
        self.counts.iter_mut().zip(&other.counts).for_each(|(count, other)| *count += other);
    }

    /// Returns the box around the primitives of some bins.
    #[inline(always)]
    fn bounds<I: InstructionSet>(&self, bins: std::ops::Range<usize>) -> GrowingBox {
        let mut bounds = GrowingBox::EMPTY;
        for bin in bins {
            bounds.add::<I>(&self.boxes[bin]);
        }
        bounds
    }

    /// Returns the cheapest border between two bins that has primitives on both sides, and its cost. The cost of a side
    /// is its half area times the cost of testing its primitives.
    #[inline(always)]
    fn cheapest_border<I: InstructionSet>(&self, node_area: f32, block: usize) -> (usize, f32) {
        // The area and the number of the primitives to the right of the border below each bin.
        let (mut areas, mut counts) = ([0.0; BINS], [0; BINS]);
        let (mut side, mut count) = (GrowingBox::EMPTY, 0);
        for bin in (1..BINS).rev() {
            side.add::<I>(&self.boxes[bin]);
            count += self.counts[bin];
            (areas[bin], counts[bin]) = (side.half_area(), count);
        }
        let mut best = (0, f32::INFINITY);
        let (mut side, mut count) = (GrowingBox::EMPTY, 0);
        for bin in 1..BINS {
            side.add::<I>(&self.boxes[bin - 1]);
            count += self.counts[bin - 1];
            let [left, right] = [test_cost(count, block), test_cost(counts[bin], block)];
            // If all boxes lie on a line, every area is zero, and the most balanced split wins.
            let sum = if node_area > 0.0 { side.half_area() * left + areas[bin] * right } else { left.max(right) };
            if (count > 0) & (counts[bin] > 0) & (sum < best.1) {
                best = (bin, sum);
            }
        }
        best
    }
}

/// Returns the cost of testing `n` primitives in blocks of `block`, in units of the cost of testing one primitive.
#[inline(always)]
#[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, reason = "costs are rounded")]
fn test_cost(n: u32, block: usize) -> f32 {
    // The usual sizes are powers of two, which need no division.
    let tested = if block.is_power_of_two() {
        n.wrapping_add(block as u32 - 1) & !(block as u32 - 1)
    } else {
        (n as usize).next_multiple_of(block) as u32
    };
    tested as f32
}

/// Sorts primitives into the bins of some axes, with about `tasks` tasks.
fn fill_bins<const N: usize>(
    isa: Isa,
    primitives: &[BuildPrimitive],
    axes: [usize; N],
    binning: &Binning,
    tasks: usize,
) -> [Bins; N] {
    if tasks <= 1 {
        return isa.run(FillBins { primitives, axes, binning });
    }
    let (before, after) = primitives.split_at(primitives.len() / 2);
    let (mut bins, others) = join(
        true,
        || fill_bins(isa, before, axes, binning, tasks.div_ceil(2)),
        || fill_bins(isa, after, axes, binning, tasks.div_ceil(2)),
    );
    bins.iter_mut().zip(&others).for_each(|(bins, others)| bins.add(others));
    bins
}

/// A SIMD kernel that sorts primitives into the bins of some axes. It uses the instruction set only through the
/// compiler.
struct FillBins<'a, const N: usize> {
    primitives: &'a [BuildPrimitive],
    axes: [usize; N],
    binning: &'a Binning,
}

impl<const N: usize> SimdKernel for FillBins<'_, N> {
    type Output = [Bins; N];

    #[inline(always)]
    fn run<I: InstructionSet>(self) -> [Bins; N] {
        let Self { primitives, axes, binning } = self;
        let mut bins = [Bins::EMPTY; N];
        for primitive in primitives {
            let numbers = binning.bins_of(primitive);
            for i in 0..N {
                let bin = (numbers[axes[i]] as usize) % BINS;
                bins[i].boxes[bin].add::<I>(&primitive.bounds());
                bins[i].counts[bin] += 1;
            }
        }
        bins
    }
}

/// A SIMD kernel that returns the cheapest border of the bins of some axes. It uses the instruction set only through
/// the compiler.
struct FindBorder<'a, const N: usize> {
    bins: &'a [Bins; N],
    axes: [usize; N],
    binning: Binning,
    node_area: f32,
    block: usize,
}

impl<const N: usize> SimdKernel for FindBorder<'_, N> {
    type Output = Option<SplitPlane>;

    #[inline(always)]
    fn run<I: InstructionSet>(self) -> Option<SplitPlane> {
        let Self { bins, axes, binning, node_area, block } = self;
        let mut best = (0, 0, f32::INFINITY);
        for (i, bins) in bins.iter().enumerate() {
            let (bin, cost) = bins.cheapest_border::<I>(node_area, block);
            if cost < best.2 {
                best = (i, bin, cost);
            }
        }
        let (i, bin, sum) = best;
        if bin == 0 {
            return None;
        }
        let cost = if node_area > 0.0 { sum / node_area } else { sum };
        let bounds = [bins[i].bounds::<I>(0..bin), bins[i].bounds::<I>(bin..BINS)];
        Some(SplitPlane { binning, axis: axes[i], bin, cost, bounds })
    }
}
