//! The directions in which a search compares two nodes.

use super::height::{Height, unit};
use super::place::Place;
use super::side::PairSide;
use super::slab::Slab;
use crate::kernel::vector::{V3, dot, power_of_two};

/// The largest distance from the centre of a frame, in units of the frame, at which f32 resolves coordinates well
/// enough.
const MAX_UNITS: f64 = power_of_two(10);
/// The largest sum of all magnitudes with which sums of heights cannot overflow.
const MAX_SIZE: f64 = power_of_two(1000);
/// The relative error of heights that are computed in f64, of vertices that were rounded by a motion, and of keys, as a
/// fraction of the sum of all magnitudes (docs/proofs/pairs.md).
const ROUNDING: f64 = power_of_two(-44);

/// A direction of the scene, in the forms that both sides need.
struct Direction {
    vector: V3,
    /// The direction and its opposite, in the frame of each side.
    heights: [[Height; 2]; 2],
    /// The height of the centre of each frame.
    offsets: [f64; 2],
}

/// The directions of a search.
pub struct Directions {
    all: Vec<Direction>,
    /// The number of leading triples of orthogonal directions.
    pub triples: usize,
    /// The inverse of the unit of each frame.
    per_unit: [f64; 2],
    /// A bound on the errors of heights that are computed in f64, and of the keys of pairs.
    pub(super) margin: f64,
}

impl Directions {
    /// Returns the directions for two sides. It is `None` if f32 does not resolve one side in the frame of the other,
    /// or if their sizes are near the end of the range.
    #[must_use]
    pub fn new(sides: [&dyn PairSide; 2]) -> Option<Self> {
        let bounds = sides.map(PairSide::bounds);
        let frames = sides.map(PairSide::placement);
        let size = frames[0].size + frames[1].size;
        let margin = size * ROUNDING;
        if size > MAX_SIZE {
            return None;
        }
        for (frame, other) in frames.iter().zip([&bounds[1], &bounds[0]]) {
            let reach = |k: usize| (other.min[k] - frame.centre[k]).abs().max((other.max[k] - frame.centre[k]).abs());
            let farthest = reach(0).max(reach(1)).max(reach(2));
            let is_resolved = farthest <= MAX_UNITS * frame.unit && margin <= 0.01 * frame.unit;
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
                vectors.extend(own.into_iter().filter_map(unit));
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
    pub fn slabs(&self, of: usize, side: &dyn PairSide, place: &Place, slabs: &mut Vec<Slab>) {
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
