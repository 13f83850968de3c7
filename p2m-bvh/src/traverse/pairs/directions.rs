//! The directions in which a search compares two nodes.

use super::side::PairSide;
use super::{Children, Place};
use crate::tree::PacketTree;
use crate::tree::height::Height;
use crate::tree::node_ref::{NodeRef, WIDTH};
use crate::tree::wide_node::{VolumeNodes, WideNode};
use p2m_core::engine::simd::{InstructionSet, Lanes, SimdKernel};
use p2m_core::engine::vector::{V3, dot, power_of_two};

/// A frame resolves what is at most this many units away from its centre.
const MAX_UNITS: f64 = power_of_two(10);
/// The part of all magnitudes by which heights are wrong that are computed in f64.
const ROUNDING: f64 = power_of_two(-46);

/// The lengths of vectors that have a direction.
const PLAIN_LENGTHS: std::ops::RangeInclusive<f64> = power_of_two(-400)..=power_of_two(400);

/// Returns a vector of length 1 along `v`, unless the length of `v` overflows or vanishes.
pub(super) fn unit(v: V3) -> Option<V3> {
    let length = dot(v, v).sqrt();
    PLAIN_LENGTHS.contains(&length).then(|| v.map(|x| x / length))
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
        let size =
            bounds.iter().flat_map(|b| b.min.iter().chain(b.max.iter())).fold(0.0, |size: f64, x| size.max(x.abs()));
        let margin = size * ROUNDING;
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
        for (side, frame) in sides.iter().zip(&frames) {
            let own = side.directions();
            triples += usize::from(frame.is_tree && !own.is_empty());
            vectors.extend(own);
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

/// Bounds the distances of the children of a node from what is in some slabs.
pub(super) struct Cut<'a, V: VolumeNodes> {
    pub(super) tree: &'a PacketTree<V>,
    pub(super) node: NodeRef,
    pub(super) slabs: &'a [Slab],
    pub(super) triples: usize,
}

impl<V: VolumeNodes> SimdKernel for Cut<'_, V> {
    type Output = Children;

    #[inline(always)]
    fn run<I: InstructionSet>(self) -> Children {
        let node = &self.tree.nodes[self.node.number()];
        let zero = I::Eight::splat(0.0);
        let mut best = zero;
        let mut widest = I::Eight::splat(f32::NEG_INFINITY);
        let (mut size, mut sum) = (zero, zero);
        let mut i = 0;
        while i < self.slabs.len() {
            let (gap, width) = self.slabs[i].gap_and_width::<I::Eight>(node);
            widest = gap.max(widest);
            let gap = gap.max(zero);
            if i < 3 {
                size = size.add(width);
            }
            // The gaps in orthogonal directions add up.
            sum = if i % 3 == 0 || i >= 3 * self.triples { gap.mul(gap) } else { gap.mul_add(gap, sum) };
            best = sum.max(best);
            i += 1;
        }
        let (mut squares, mut gaps, mut sizes) = ([0.0f32; WIDTH], [0.0f32; WIDTH], [0.0f32; WIDTH]);
        best.store(&mut squares);
        widest.store(&mut gaps);
        size.store(&mut sizes);
        let frame = &self.tree.frame;
        #[allow(clippy::cast_possible_truncation, reason = "sizes and gaps only order pairs")]
        let unit = frame.unit as f32;
        let mut children = Children { nodes: *node.children(), ..Children::NONE };
        for slot in 0..WIDTH {
            children.squares[slot] = frame.square_below(squares[slot]);
            children.gaps[slot] = gaps[slot] * unit;
            children.sizes[slot] = sizes[slot] * unit;
        }
        children
    }
}

impl Slab {
    /// Returns the gaps between the slab and the children of a node, negative where they overlap, and the widths of the
    /// children.
    #[inline(always)]
    fn gap_and_width<L: Lanes>(&self, node: &impl WideNode) -> (L, L) {
        let (above, below) = (self.heights[0].of_children::<L>(node), self.heights[1].of_children::<L>(node));
        let gap = L::splat(self.low).sub(above).max(L::splat(0.0).sub(below).sub(L::splat(self.high)));
        (gap, above.add(below))
    }
}
