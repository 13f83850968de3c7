//! Extents of nodes along the direction of the best pair, from their vertices.

use super::height::unit;
use super::place::Place;
use super::side::PairSide;
use crate::kernel::vector::V3;
use crate::pair::Pairs;
use std::collections::HashMap;

/// The extents of nodes along the direction of the best pair, as far as they were needed.
pub(super) struct Supports {
    /// The margin of heights; `None` if heights are not used.
    pub(super) margin: Option<f64>,
    pub(super) direction: Option<V3>,
    /// The largest heights of nodes of the first side, and those of the second along the opposite direction.
    known: [HashMap<u32, f64>; 2],
}

impl Supports {
    pub(super) fn new(margin: Option<f64>) -> Self {
        Self { margin, direction: None, known: [HashMap::new(), HashMap::new()] }
    }

    /// Takes the direction of the best pair.
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

    /// Returns whether the extents of two nodes are near enough.
    pub(super) fn is_near(&mut self, sides: [&dyn PairSide; 2], places: &[Place; 2], prune: f64) -> bool {
        let (Some(margin), Some(direction)) = (self.margin, self.direction) else { return true };
        let mut height = |i: usize, direction: V3| {
            *self.known[i].entry(places[i].node).or_insert_with(|| sides[i].support(places[i].node, &direction))
        };
        let gap = -height(1, direction.map(|x| -x)) - height(0, direction) - margin;
        // What is not a number excludes nothing.
        !(gap > 0.0 && gap * gap > prune)
    }
}
