//! Support values: the exact extents of nodes along the direction of the best pair.

use super::height::unit;
use super::place::Place;
use super::side::PairSide;
use crate::kernel::vector::V3;
use crate::pair::Pairs;
use std::collections::HashMap;

/// A cache of the extents of nodes along the direction of the best pair.
pub(super) struct Supports {
    /// The margin of heights, or `None` if heights are not used.
    pub(super) margin: Option<f64>,
    pub(super) direction: Option<V3>,
    /// The largest heights of nodes: of the first side along the direction, and of the second side along its opposite.
    known: [HashMap<u32, f64>; 2],
}

impl Supports {
    pub(super) fn new(margin: Option<f64>) -> Self {
        Self { margin, direction: None, known: [HashMap::new(), HashMap::new()] }
    }

    /// Adopts the direction of the best pair, and clears the cache if the direction has changed.
    pub(super) fn follow(&mut self, pairs: &Pairs<'_>) {
        if self.margin.is_none() {
            return;
        }
        let Some(separation) = pairs.separation() else { return };
        let direction = unit(separation);
        if direction != self.direction {
            self.direction = direction;
            self.known.iter_mut().for_each(HashMap::clear);
        }
    }

    /// Returns whether two nodes may be within `prune` of each other, by their extents.
    pub(super) fn is_near(&mut self, sides: [&dyn PairSide; 2], places: &[Place; 2], prune: f64) -> bool {
        let (Some(margin), Some(direction)) = (self.margin, self.direction) else { return true };
        let mut height = |i: usize, direction: V3| {
            *self.known[i].entry(places[i].node).or_insert_with(|| sides[i].support(places[i].node, &direction))
        };
        let gap = -height(1, direction.map(|x| -x)) - height(0, direction) - margin;
        // NaN excludes nothing.
        !(gap > 0.0 && gap * gap > prune)
    }
}
