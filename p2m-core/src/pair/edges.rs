//! The nearest points inside of two edges that are not parallel.
//!
//! Let P run from p0 along D and Q from q0 along E, with r = q0 - p0 and N = D x E. The nearest point of the line of P
//! to the line of Q is at the parameter s = (r x E).N / N.N. The distance from the point at s + ds to the line of Q is
//! the root of d^2 + (ds |D| sin)^2, where sin is the sine of the angle between the lines. N is computed in
//! double-double and rounded, so it has a relative error of 2 u for every angle. Then the error of s |D| sin is a few u
//! |r|, however nearly parallel the edges are; with the plain cross product it would be larger by the factor 1 / sin.
//!
//! The rounding of s has no further effect: the kernel for segments computes the distance from the point at the rounded
//! s to the edge Q. Vertices cover all cases in which a nearest point is not strictly inside.
//!
//! The edges are sorted, and so are the ends of each edge, so the value does not depend on the order of the arguments.

use crate::Feature;
use crate::kernel::arithmetic::cross;
use crate::kernel::double_double::Double;
use crate::kernel::vector::{
    V3, add, bounds, clamp, dot, exponent, largest, lexicographically_less, power_of_two, scale_by_power, sub,
};
use crate::kernel::{Key, triangle};

/// The sizes of edges and offsets for which products of four of them and of the smallest sine are in range.
const PLAIN_SIZES: std::ops::RangeInclusive<f64> = power_of_two(-100)..=power_of_two(100);
/// The least size of edges that are scaled down, so that sums of differences of vertices are finite.
const HUGE: f64 = power_of_two(1020);
/// The exponent of the scale of huge edges. The digits that they lose are far below the error of their distance.
const HUGE_SHIFT: i32 = 6;

/// The nearest points inside of two edges.
pub(super) struct NearestOnEdges {
    pub(super) key: Key,
    pub(super) points: [V3; 2],
    /// The parameters of the points: 0 at the first end, 1 at the second.
    pub(super) parameters: [f64; 2],
}

/// Returns the nearest points of two edges, if both points are strictly inside and the edges are not parallel.
pub(super) fn nearest_on_edges(p: &[V3; 2], q: &[V3; 2]) -> Option<NearestOnEdges> {
    let [low, high] = bounds(&[p[0], p[1], q[0], q[1]]);
    let is_huge = largest(&[sub(high, low)]) >= HUGE;
    let shift = if is_huge { HUGE_SHIFT } else { 0 };
    let scaled = |edge: &[V3; 2]| if is_huge { edge.map(|v| v.map(|x| scale_by_power(x, -shift))) } else { *edge };
    let sorted = |[a, b]: [V3; 2]| {
        let is_reversed = lexicographically_less(b, a);
        (if is_reversed { [b, a] } else { [a, b] }, is_reversed)
    };
    let ((p, p_reversed), (q, q_reversed)) = (sorted(scaled(p)), sorted(scaled(q)));
    let is_swapped = q < p;
    let [first, second] = if is_swapped { [q, p] } else { [p, q] };
    let Inside { offset, foot, parameters } = inside(&first, &second)?;
    // The point of the second edge, relative to the first end of the first edge, is foot + offset.
    let on_first = within(add(first[0], foot), &first);
    let on_second = within(add(first[0], add(foot, offset)), &second);
    let order = |pair: [f64; 2]| if is_swapped { [pair[1], pair[0]] } else { pair };
    let [s, t] = order(parameters);
    let points = if is_swapped { [on_second, on_first] } else { [on_first, on_second] };
    Some(NearestOnEdges {
        key: if is_huge { Key::from_scaled_offset(offset, shift) } else { Key::from_offset(offset) },
        points: if is_huge { points.map(|v| v.map(|x| scale_by_power(x, shift))) } else { points },
        parameters: [if p_reversed { 1.0 - s } else { s }, if q_reversed { 1.0 - t } else { t }],
    })
}

/// Returns the point of the box of an edge that is nearest to `x`.
fn within(x: V3, edge: &[V3; 2]) -> V3 {
    let [low, high] = bounds(edge);
    clamp(x, low, high)
}

/// The nearest points inside of two edges, relative to the first end of the first one.
struct Inside {
    /// The vector from the point of the first edge to the point of the second.
    offset: V3,
    /// The point of the first edge.
    foot: V3,
    parameters: [f64; 2],
}

fn inside(p: &[V3; 2], q: &[V3; 2]) -> Option<Inside> {
    let d = sub(p[1], p[0]);
    let s = parameter_of_line(d, sub(q[0], p[0]), sub(q[1], q[0]))?;
    let foot = d.map(|x| s * x);
    let nearest = triangle::segment(foot, q.map(|v| sub(v, p[0])), f64::INFINITY)?;
    if nearest.feature != Feature::Edge(0) {
        return None;
    }
    // The gap between the boxes is a lower bound on the distance, and it remains one for the computed distance.
    let ([p_low, p_high], [q_low, q_high]) = (bounds(p), bounds(q));
    let offset = clamp(nearest.unscaled_offset(), sub(q_low, p_high), sub(q_high, p_low));
    Some(Inside { offset, foot, parameters: [s, nearest.weights[1]] })
}

/// Returns the parameter, strictly between 0 and 1, of the point at which a line from the origin along `d` is nearest
/// to the line through `r` along `e`. It is `None` if the parameter is not in that range or the lines are parallel.
fn parameter_of_line(d: V3, r: V3, e: V3) -> Option<f64> {
    let sizes = [d, r, e].map(|v| largest(&[v]));
    let is_plain = PLAIN_SIZES.contains(&sizes[0]) && PLAIN_SIZES.contains(&sizes[2]) && sizes[1] <= *PLAIN_SIZES.end();
    let [d, r, e] = if is_plain {
        [d, r, e]
    } else {
        if sizes[0] == 0.0 || sizes[2] == 0.0 {
            return None;
        }
        let (d_exponent, e_exponent) = (exponent(sizes[0]), exponent(sizes[2]));
        let scaled = |v: V3, by: i32| v.map(|x| scale_by_power(x, by));
        [scaled(d, -d_exponent), scaled(r, -d_exponent), scaled(e, -e_exponent)]
    };
    let normal = accurate_cross(d, e);
    let s = dot(cross(r, e), normal) / dot(normal, normal);
    // Parallel lines give NaN, for which the comparison is false.
    (s > 0.0 && s < 1.0).then_some(s)
}

/// Returns the cross product with a relative error of at most 2 u in each component.
fn accurate_cross(a: V3, b: V3) -> V3 {
    std::array::from_fn(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        (Double::product(a[i], b[j]) - Double::product(a[j], b[i])).round()
    })
}
