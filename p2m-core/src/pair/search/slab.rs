//! Slabs between two planes, and the distances of the children of a node from them.

use super::height::{Height, Rows};
use crate::simd::Lanes;

/// The extent of something between two planes that are orthogonal to a direction, in the frame of a tree.
#[derive(Clone, Copy, Debug)]
pub struct Slab {
    /// The direction and its opposite.
    pub(super) heights: [Height; 2],
    pub(super) low: f32,
    pub(super) high: f32,
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
    /// Returns the gaps between the slab and the children of a node, negative where they overlap, and the widths
    /// of the children.
    #[inline(always)]
    fn gap_and_width<L: Lanes, N: Rows>(&self, node: &N) -> (L, L) {
        let (above, below) = (self.heights[0].of_children::<L, N>(node), self.heights[1].of_children::<L, N>(node));
        let gap = L::splat(self.low).sub(above).max(L::splat(0.0).sub(below).sub(L::splat(self.high)));
        (gap, above.add(below))
    }
}
