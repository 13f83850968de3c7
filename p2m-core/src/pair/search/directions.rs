//! The directions in which a search compares two nodes.

use super::height::{Height, Rows};
use super::side::{PairSide, Place};
use crate::kernel::vector::{V3, dot, power_of_two};
use crate::simd::Lanes;

/// A frame resolves what is at most this many units away from its centre.
const MAX_UNITS: f64 = power_of_two(10);
/// The part of all magnitudes by which heights are wrong that are computed in f64, the vertices of which a motion has
/// rounded, and keys.
const ROUNDING: f64 = power_of_two(-44);

/// The lengths of vectors that have a direction.
const PLAIN_LENGTHS: std::ops::RangeInclusive<f64> = power_of_two(-400)..=power_of_two(400);

/// Returns a vector of length 1 along `v`, unless the length of `v` overflows or vanishes.
pub(super) fn unit(v: V3) -> Option<V3> {
    let length = dot(v, v).sqrt();
    PLAIN_LENGTHS.contains(&length).then(|| v.map(|x| x / length))
}

/// Returns the least and the largest of some heights.
pub(super) fn extent(heights: impl Iterator<Item = f64>) -> [f64; 2] {
    heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
}

/// The extent of something between two planes that are orthogonal to a direction, in the frame of a tree.
#[derive(Clone, Copy, Debug)]
pub struct Slab {
    /// The direction and its opposite.
    heights: [Height; 2],
    low: f32,
    high: f32,
}

/// A direction of the scene, as both sides need it.
struct Direction {
    vector: V3,
    /// The direction and its opposite in the frame of each side.
    heights: [[Height; 2]; 2],
    /// The height of the centre of each frame.
    offsets: [f64; 2],
}

/// The directions of a search.
pub(super) struct Directions {
    all: Vec<Direction>,
    /// The number of leading triples of orthogonal directions.
    pub(super) triples: usize,
    /// The inverse of the unit of each frame.
    per_unit: [f64; 2],
    /// A bound on the errors of heights that are computed in f64, and of the keys of pairs.
    pub(super) margin: f64,
}

impl Directions {
    /// Returns the directions for two sides, unless f32 does not resolve one of them in the frame of the other.
    pub(super) fn new(sides: [&dyn PairSide; 2]) -> Option<Self> {
        let bounds = sides.map(PairSide::bounds);
        let frames = sides.map(PairSide::placement);
        let margin = (frames[0].size + frames[1].size) * ROUNDING;
        for (frame, other) in frames.iter().zip([&bounds[1], &bounds[0]]) {
            let reach = |k: usize| (other.min[k] - frame.centre[k]).abs().max((other.max[k] - frame.centre[k]).abs());
            let farthest = reach(0).max(reach(1)).max(reach(2));
            let is_resolved = frame.is_plain && farthest <= MAX_UNITS * frame.unit && margin <= 0.01 * frame.unit;
            if frame.is_tree && !is_resolved {
                return None;
            }
        }
        let mut vectors: Vec<V3> = vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let mut triples = 1;
        // The orthogonal directions of trees come before those of shapes.
        for wants_trees in [true, false] {
            for (side, _) in sides.iter().zip(&frames).filter(|(_, frame)| frame.is_tree == wants_trees) {
                let own = side.directions();
                triples += usize::from(wants_trees && !own.is_empty());
                vectors.extend(own);
            }
        }
        let direction = |vector: &V3| Direction {
            vector: *vector,
            heights: sides.map(|side| [1.0, -1.0].map(|sign| side.height(&vector.map(|x| x * sign)))),
            offsets: frames.map(|frame| dot(*vector, frame.centre)),
        };
        let all = vectors.iter().map(direction).collect();
        Some(Self { all, triples, per_unit: frames.map(|frame| frame.unit.recip()), margin })
    }

    /// Computes the extents of a node of one side in the frame of the other.
    #[allow(clippy::cast_possible_truncation, reason = "rounded outwards")]
    pub(super) fn slabs(&self, of: usize, side: &dyn PairSide, place: &Place, slabs: &mut Vec<Slab>) {
        let other = 1 - of;
        let per_unit = self.per_unit[other];
        slabs.clear();
        slabs.extend(self.all.iter().map(|direction| {
            let [low, high] = side.extent(place, &direction.vector, direction.offsets[of], &direction.heights[of]);
            let heights = direction.heights[other];
            let slack = f64::from(heights[0].slack.max(heights[1].slack));
            let in_frame = |height: f64| (height - direction.offsets[other]) * per_unit;
            Slab {
                heights,
                low: ((in_frame(low - self.margin) - slack) as f32).next_down(),
                high: ((in_frame(high + self.margin) + slack) as f32).next_up(),
            }
        }));
    }
}

/// Bounds on the distances of the eight children of a node from what is in some slabs, in units of its frame.
#[derive(Clone, Copy)]
pub struct ChildBounds<L> {
    /// Squares of lower bounds.
    pub squares: L,
    /// The widest gaps in any direction, negative for what overlaps.
    pub gaps: L,
    /// The sums of the widths along the first three directions.
    pub sizes: L,
}

/// Bounds the distances of the children of a node from what is in some slabs, of which the given number of leading
/// triples are orthogonal.
#[inline(always)]
pub fn bound_children<L: Lanes, N: Rows>(node: &N, slabs: &[Slab], triples: usize) -> ChildBounds<L> {
    let zero = L::splat(0.0);
    let mut bounds = ChildBounds { squares: zero, gaps: L::splat(f32::NEG_INFINITY), sizes: zero };
    let mut sum = zero;
    let mut i = 0;
    while i < slabs.len() {
        let (gap, width) = slabs[i].gap_and_width::<L, N>(node);
        bounds.gaps = gap.max(bounds.gaps);
        let gap = gap.max(zero);
        if i < 3 {
            bounds.sizes = bounds.sizes.add(width);
        }
        // The gaps in orthogonal directions add up.
        sum = if i % 3 == 0 || i >= 3 * triples { gap.mul(gap) } else { gap.mul_add(gap, sum) };
        bounds.squares = sum.max(bounds.squares);
        i += 1;
    }
    bounds
}

impl Slab {
    /// Returns the gaps between the slab and the children of a node, negative where they overlap, and the widths of the
    /// children.
    #[inline(always)]
    fn gap_and_width<L: Lanes, N: Rows>(&self, node: &N) -> (L, L) {
        let (above, below) = (self.heights[0].of_children::<L, N>(node), self.heights[1].of_children::<L, N>(node));
        let gap = L::splat(self.low).sub(above).max(L::splat(0.0).sub(below).sub(L::splat(self.high)));
        (gap, above.add(below))
    }
}
