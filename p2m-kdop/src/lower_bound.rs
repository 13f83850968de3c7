//! Lower bounds on the distances to eight k-DOPs.
//!
//! A child is at least as far away as the intersection of two half-spaces. If the first three directions are
//! orthogonal, the first half-space contains their box and is orthogonal to the vector to the nearest point of that
//! box; otherwise it lies behind the face with the widest gap. The second one lies behind a face of another direction.
//! The distance to this intersection is computed for every other direction, and the largest one is the bound.
//! [docs/proofs/kdop.md] derives it and bounds its rounding.
//!
//! [docs/proofs/kdop.md]: https://github.com/p2m-rs/p2m/blob/main/docs/proofs/kdop.md

use crate::direction_table::DirectionTable;
use p2m_bvh::engine::node::WIDTH;
use p2m_core::engine::simd::Lanes;

/// The part of an increment that is added to a bound, 1 - 2^-15, which allows for the rounding of its factor.
const INCREMENT_FACTOR: f32 = 1.0 - 1.0 / 32768.0;
/// The least squared sine of the angle between two half-spaces. If the angle is smaller, the bound is computed with
/// this one and gains less than it could.
const MIN_SINE_SQUARED: f32 = 1.0 / 16.0;
/// Squares below this one, 2^-100, are treated as equal to it.
const MIN_SQUARE: f32 = 1.0 / (1u128 << 100) as f32;

/// The squares of the lower bounds, for k-DOPs whose heights are the rows and a query point whose products with the
/// normals are `query`.
#[inline(always)]
pub(crate) fn squared_lower_bounds<L: Lanes, const K: usize>(
    heights: &[[f32; WIDTH]; K],
    table: &DirectionTable<K>,
    query: &[f32; K],
) -> L {
    let zero = L::splat(0.0);
    // Every point of the child is at least as far away along the vector `gap` as that vector is long.
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
        // `excess` belongs to the face that the query point is outside of, and `part` is the part of the gap in the
        // direction of that face.
        let excess = above.max(below);
        let part = below.if_below(above, along, against);
        let rest = along.mul_add(against, square).max(least);
        let more = excess.sub(part).max(zero);
        // The bound is derived only for faces that the query point is outside of.
        let more = zero.if_below(excess, more, zero);
        let both = more.mul(more).mul_add(scaled.mul(rest.reciprocal()), square);
        let excess = excess.max(zero);
        // If the nearest point of the half-space behind the face lies in the other half-space, its distance
        // is the bound.
        let bound = excess.mul(part).if_below(square, both, excess.mul(excess));
        best = bound.max(best);
        j += 1;
    }
    best
}

/// The height of the query point above face i, which is positive if the point is outside of that face.
#[inline(always)]
fn height_excess<L: Lanes, const K: usize>(heights: &[[f32; WIDTH]; K], query: &[f32; K], i: usize) -> L {
    L::splat(query[i]).sub(L::load(&heights[i]))
}

/// The signed distance between the query point and slab j; 0 if the point is in the slab.
#[inline(always)]
fn slab_gap<L: Lanes, const K: usize>(heights: &[[f32; WIDTH]; K], query: &[f32; K], j: usize) -> L {
    let zero = L::splat(0.0);
    let above = height_excess::<L, K>(heights, query, 2 * j).max(zero);
    let below = height_excess::<L, K>(heights, query, 2 * j + 1).max(zero);
    above.sub(below)
}

/// The vector to the slab that is farthest from the query point, for directions of which no three are orthogonal. The
/// first part of the result is the slab from which the caller goes on, the last one is the square of the vector.
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
