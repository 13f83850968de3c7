//! Slabs between two parallel planes, and the distances between the children of a node and slabs.

use super::height::{Height, Rows};
use crate::simd::Lanes;

/// A slab: the space between two planes that are orthogonal to a direction, in the frame of a tree.
#[derive(Clone, Copy, Debug)]
pub struct Slab {
    /// The direction and its opposite.
    pub(super) heights: [Height; 2],
    pub(super) low: f32,
    pub(super) high: f32,
}

/// Bounds on the distances between the eight children of a node and the intersection of several slabs, in units of the
/// node's frame.
#[derive(Clone, Copy)]
pub struct ChildBounds<L> {
    /// Squares of lower bounds.
    pub squares: L,
    /// The widest gaps in any direction, negative for children that overlap.
    pub gaps: L,
    /// The sums of the widths along the first three directions.
    pub sizes: L,
}

/// Bounds the distances between the children of a node and the intersection of several slabs. `triples` is the number
/// of leading triples of orthogonal slabs.
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
        // The squared gaps in orthogonal directions add up.
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
