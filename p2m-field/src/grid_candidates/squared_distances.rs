//! Squared distances of eight points at once from a primitive or a box.

use super::local_primitive::{Kind, LocalPrimitive};
use p2m_core::engine::simd::Doubles;
use p2m_core::engine::vector::V3;

/// Eight points or vectors: the eight values of each coordinate are the lanes of one `D`.
///
/// Functions on it write the coordinates out, because closures that are passed to standard functions such as `map`
/// would be compiled without the instruction set.
pub(crate) type Eight<D> = [D; 3];

#[inline(always)]
fn splat<D: Doubles>(v: &V3) -> Eight<D> {
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

/// Returns the squared distance from an edge of points with these components perpendicular to it and along it.
#[inline(always)]
fn square_from_edge<D: Doubles>(across: D, along: D, length: f64) -> D {
    let beyond = along.sub(D::splat(length)).max(D::splat(0.0).sub(along)).max(D::splat(0.0));
    beyond.mul_add(beyond, across.mul(across))
}

/// Returns the squared distances of eight points from a primitive. A point counts as above the inside of a triangle if
/// it is inside of all edges by at least `margin`.
#[inline(always)]
pub(crate) fn squared_distances<D: Doubles>(primitive: &LocalPrimitive, points: &Eight<D>, margin: D) -> D {
    let offset = sub(points, &splat(&primitive.origin));
    if primitive.kind == Kind::Point {
        return dot(&offset, &offset);
    }
    let [first, second, third] = &primitive.axes;
    let (x, y, h) = (dot(&offset, &splat(first)), dot(&offset, &splat(second)), dot(&offset, &splat(third)));
    let mut square = square_from_edge(y, x, primitive.length);
    if primitive.kind == Kind::Triangle {
        let mut inside = y;
        for edge in &primitive.edges {
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

/// Returns the squared distances of eight points from a box.
#[inline(always)]
pub(crate) fn squared_distances_from_box<D: Doubles>([low, high]: &[V3; 2], points: &Eight<D>) -> D {
    let (below, above) = (sub(&splat(low), points), sub(points, &splat(high)));
    let zero = D::splat(0.0);
    let gaps = [below[0].max(above[0]).max(zero), below[1].max(above[1]).max(zero), below[2].max(above[2]).max(zero)];
    dot(&gaps, &gaps)
}
