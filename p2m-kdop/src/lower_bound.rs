//! Lower bounds on the distances to eight k-DOPs.
//!
//! The basic idea: each child lies in the intersection of two half-spaces, so it is at least as far away as that
//! intersection, whose distance has a closed form. If the first three directions are orthogonal, the first half-space
//! contains the box of their slabs, and its face is orthogonal to the vector to the nearest point of that box.
//! Otherwise it lies behind the face with the widest gap. The second half-space lies behind a face of another
//! direction. The distance is computed for every other direction, and the largest one is the bound.
//! [docs/proofs/kdop.md] derives it and bounds its rounding.
//!
//! [docs/proofs/kdop.md]: https://github.com/p2m-rs/p2m/blob/main/docs/proofs/kdop.md

use crate::direction_table::DirectionTable;
use p2m_bvh::engine::node::WIDTH;
use p2m_core::engine::simd::Lanes;

/// The fraction of an increment that is added to a bound, 1 - 2^-15, which allows for the rounding of its factor.
const INCREMENT_FACTOR: f32 = 1.0 - 1.0 / 32768.0;
/// The least squared sine of the angle between two half-spaces. For a smaller angle the bound is computed with this
/// sine, and gains less than it could.
const MIN_SINE_SQUARED: f32 = 1.0 / 16.0;
/// The least square, 2^-100. Smaller squares are replaced by it.
const MIN_SQUARE: f32 = 1.0 / (1u128 << 100) as f32;

/// Returns the squares of the lower bounds. The rows of `heights` are the heights of the k-DOPs, and `query` has the
/// products of the query point with the normals.
#[inline(always)]
pub(crate) fn squared_lower_bounds<L: Lanes, const K: usize>(
    heights: &[[f32; WIDTH]; K],
    table: &DirectionTable<K>,
    query: &[f32; K],
) -> L {
    let zero = L::splat(0.0);
    // Along the vector `gap`, every point of the child is at least as far away as `gap` is long.
    let (first, gap, square) = if table.is_orthogonal {
        let gap: [L; 3] = [slab_gap(heights, query, 0), slab_gap(heights, query, 1), slab_gap(heights, query, 2)];
        (3, gap, gap[2].mul_add(gap[2], gap[1].mul_add(gap[1], gap[0].mul(gap[0]))))
    } else {
        widest_gap(heights, table, query)
    };
    let scaled = square.mul(L::splat(INCREMENT_FACTOR));
    let least = square.mul(L::splat(MIN_SINE_SQUARED)).max(L::splat(MIN_SQUARE));
    let mut best = square;
    let mut j = first;
    while j < K / 2 {
        let above = height_excess::<L, K>(heights, query, 2 * j);
        let below = height_excess::<L, K>(heights, query, 2 * j + 1);
        let [x, y, z] = table.cosines[2 * j];
        let along = gap[2].mul_add(L::splat(z), gap[1].mul_add(L::splat(y), gap[0].mul(L::splat(x))));
        let against = zero.sub(along);
        // `excess` belongs to the face outside of which the query point lies, and `part` is the component of the gap in
        // the direction of that face.
        let excess = above.max(below);
        let part = below.if_below(above, along, against);
        let rest = along.mul_add(against, square).max(least);
        let more = excess.sub(part).max(zero);
        // The bound is valid only for faces outside of which the query point lies.
        let more = zero.if_below(excess, more, zero);
        let both = more.mul(more).mul_add(scaled.mul(rest.reciprocal()), square);
        let excess = excess.max(zero);
        // If the nearest point of the half-space behind the face lies in the other half-space, its distance is the
        // bound.
        let bound = excess.mul(part).if_below(square, both, excess.mul(excess));
        best = bound.max(best);
        j += 1;
    }
    best
}

/// Returns the height of the query point above face i, which is positive if the point is outside of that face.
#[inline(always)]
fn height_excess<L: Lanes, const K: usize>(heights: &[[f32; WIDTH]; K], query: &[f32; K], i: usize) -> L {
    L::splat(query[i]).sub(L::load(&heights[i]))
}

/// Returns the signed distance between the query point and slab j, or 0 if the point is in the slab.
#[inline(always)]
fn slab_gap<L: Lanes, const K: usize>(heights: &[[f32; WIDTH]; K], query: &[f32; K], j: usize) -> L {
    let zero = L::splat(0.0);
    let above = height_excess::<L, K>(heights, query, 2 * j).max(zero);
    let below = height_excess::<L, K>(heights, query, 2 * j + 1).max(zero);
    above.sub(below)
}

/// Returns the vector to the slab that is farthest from the query point, if no three directions are orthogonal. The
/// first part of the result is the slab from which the caller continues, and the last one is the square of the vector.
#[inline(always)]
fn widest_gap<L: Lanes, const K: usize>(
    heights: &[[f32; WIDTH]; K],
    table: &DirectionTable<K>,
    query: &[f32; K],
) -> (usize, [L; 3], L) {
    let zero = L::splat(0.0);
    let mut gap = [zero; 3];
    let mut widest = zero;
    let mut i = 0;
    while i < K {
        let excess = height_excess::<L, K>(heights, query, i);
        let [x, y, z] = table.cosines[i];
        gap = [
            widest.if_below(excess, excess.mul(L::splat(x)), gap[0]),
            widest.if_below(excess, excess.mul(L::splat(y)), gap[1]),
            widest.if_below(excess, excess.mul(L::splat(z)), gap[2]),
        ];
        widest = excess.max(widest);
        i += 1;
    }
    (0, gap, widest.mul(widest))
}
