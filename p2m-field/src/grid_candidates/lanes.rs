//! Squared distances of eight places at once.

use super::flat::{Flat, Kind};
use p2m_core::engine::simd::Doubles;
use p2m_core::engine::vector::V3;

/// Eight places, or ways, coordinate by coordinate. (Written out: what standard functions like `map` are given is compiled without
/// the instruction set.)
pub(crate) type Eight<D> = [D; 3];

#[inline(always)]
pub(crate) fn splat<D: Doubles>(v: &V3) -> Eight<D> {
    [D::splat(v[0]), D::splat(v[1]), D::splat(v[2])]
}

#[inline(always)]
fn sub<D: Doubles>(a: &Eight<D>, b: &Eight<D>) -> Eight<D> {
    [a[0].sub(b[0]), a[1].sub(b[1]), a[2].sub(b[2])]
}

#[inline(always)]
fn dot<D: Doubles>(a: &Eight<D>, b: &Eight<D>) -> D {
    a[0].mul_add(b[0], a[1].mul_add(b[1], a[2].mul(b[2])))
}

/// The square of what is across an edge, and of what is beyond its ends.
#[inline(always)]
fn square_from_edge<D: Doubles>(across: D, along: D, length: f64) -> D {
    let beyond = along.sub(D::splat(length)).max(D::splat(0.0).sub(along)).max(D::splat(0.0));
    beyond.mul_add(beyond, across.mul(across))
}

/// The squared distances of eight places from a primitive. One is above the inside of a triangle if it is by `margin` at least.
#[inline(always)]
pub(crate) fn squares<D: Doubles>(flat: &Flat, places: &Eight<D>, margin: D) -> D {
    let way = sub(places, &splat(&flat.origin));
    if flat.kind == Kind::Point {
        return dot(&way, &way);
    }
    let [first, second, third] = &flat.axes;
    let (x, y, h) = (dot(&way, &splat(first)), dot(&way, &splat(second)), dot(&way, &splat(third)));
    let mut square = square_from_edge(y, x, flat.length);
    if flat.kind == Kind::Triangle {
        let mut inside = y;
        for edge in &flat.edges {
            let (dx, dy) = (D::splat(edge.direction[0]), D::splat(edge.direction[1]));
            let along = x.mul_add(dx, y.mul_add(dy, D::splat(-edge.along)));
            let across = y.mul_add(dx, x.mul_add(D::splat(-edge.direction[1]), D::splat(-edge.across)));
            square = square_from_edge(across, along, edge.length).min(square);
            inside = across.min(inside);
        }
        square = margin.if_at_most(inside, D::splat(0.0), square);
    }
    h.mul_add(h, square)
}

/// The squared distances of eight places from a box.
#[inline(always)]
pub(crate) fn squares_from_box<D: Doubles>([low, high]: &[V3; 2], places: &Eight<D>) -> D {
    let (below, above) = (sub(&splat(low), places), sub(places, &splat(high)));
    let zero = D::splat(0.0);
    let gaps = [below[0].max(above[0]).max(zero), below[1].max(above[1]).max(zero), below[2].max(above[2]).max(zero)];
    dot(&gaps, &gaps)
}
