//! Distances in exact rational arithmetic.
//!
//! Coordinates are integers in units of a common power of two. So everything up to the squared distance is exact: it is
//! a fraction of two integers. Only a bound on the distance itself needs a square root. The root is taken in fixed
//! point with at least 60 bits below u M, and rounded so that a check can only become stricter.

use crate::integers::{V, clip, cross, dot, integer, lowest_bit, sub};
use crate::ratio::Ratio;
use dashu_int::ops::{BitTest, SquareRoot};
use dashu_int::{IBig, UBig};
use std::cmp::Ordering;

/// The exact squared distance from a query to the convex hull of one to three vertices, or between two such hulls.
#[derive(Clone, Debug)]
pub struct Distance {
    square: Ratio,
    /// The largest squared distance from the query to a vertex, or between vertices of the two hulls.
    max_vertex_distance_squared: IBig,
    /// The exponent of the unit: lengths are multiples of 2^unit.
    unit: i64,
}

impl Distance {
    /// Computes the distance from `query` to the point, segment or triangle of `vertices`, degenerate or not. All
    /// coordinates must be finite.
    #[must_use]
    pub fn new(query: [f64; 3], vertices: &[[f64; 3]]) -> Self {
        Self::between(&[query], vertices)
    }

    /// Computes the distance between two points, segments or triangles, degenerate or not. All coordinates
    /// must be finite.
    ///
    /// The distance is 0 if an edge of one pierces the other. Otherwise the nearest points are a vertex and a point of
    /// the other hull, or they are inside of two edges that are not parallel.
    #[must_use]
    pub fn between(a: &[[f64; 3]], b: &[[f64; 3]]) -> Self {
        let unit = a.iter().chain(b).flatten().map(|x| lowest_bit(*x)).min().expect("coordinates");
        let exact = |hull: &[[f64; 3]]| -> Vec<V> { hull.iter().map(|v| v.map(|x| integer(x, unit))).collect() };
        let (a, b) = (exact(a), exact(b));
        let from_vertices = |from: &[V], to: &[V]| -> Vec<Ratio> { from.iter().map(|v| from_vertex(v, to)).collect() };
        let mut candidates = from_vertices(&a, &b);
        candidates.extend(from_vertices(&b, &a));
        for p in edges(&a) {
            candidates.extend(edges(&b).into_iter().filter_map(|q| inside_of_edges(p, q)));
        }
        if edges(&a).into_iter().any(|edge| pierces(edge, &b)) || edges(&b).into_iter().any(|edge| pierces(edge, &a)) {
            candidates.push(Ratio::new(IBig::ZERO, IBig::ONE));
        }
        let squares = a.iter().flat_map(|v| b.iter().map(|w| sub(w, v))).map(|d| dot(&d, &d));
        let max_vertex_distance_squared = squares.max().expect("at least one vertex");
        let square = candidates.into_iter().min_by(Ratio::compare).expect("at least one vertex");
        Self { square, max_vertex_distance_squared, unit }
    }

    /// Returns whether the distance is zero.
    #[must_use]
    pub fn is_zero(&self) -> bool {
        self.square.numerator == IBig::ZERO
    }

    /// Compares two exact distances.
    #[must_use]
    pub fn compare(&self, other: &Self) -> Ordering {
        let unit = self.unit.min(other.unit);
        let at = |d: &Self| d.square.clone().times_power_of_two(2 * (d.unit - unit));
        at(self).compare(&at(other))
    }

    /// Returns the distance and the largest vertex distance, each rounded down to a multiple of 2^fine.
    fn fixed(&self, fine: i64) -> (UBig, UBig) {
        let shift = usize::try_from(2 * (self.unit - fine)).expect("finer than the input");
        let root = |x: IBig| UBig::try_from(x).expect("squares are not negative").sqrt();
        let square = (&self.square.numerator << shift) / &self.square.denominator;
        (root(square), root(&self.max_vertex_distance_squared << shift))
    }

    /// Returns |computed - true| minus `eta` in units of u M, rounded up, where M is the largest distance from the
    /// query to a vertex. The result is infinite if `computed` is infinite or NaN although the true distance is below
    /// 2^1024.
    ///
    /// `bits` is the precision of the scalar: 53 stands for u = 2^-53.
    #[must_use]
    pub fn error(&self, computed: f64, bits: u32, eta: f64) -> f64 {
        self.error_per(computed, bits, eta, false)
    }

    /// Returns |computed - true| minus `eta` in units of u d, rounded up, where d is the true distance.
    #[must_use]
    pub fn relative_error(&self, computed: f64, bits: u32, eta: f64) -> f64 {
        self.error_per(computed, bits, eta, true)
    }

    fn error_per(&self, computed: f64, bits: u32, eta: f64, relative: bool) -> f64 {
        if !computed.is_finite() {
            let limit = Self::new([0.0; 3], &[[f64::MAX, 0.0, 0.0]]);
            return if computed > 0.0 && self.compare(&limit) == Ordering::Greater { 0.0 } else { f64::INFINITY };
        }
        // An eta that is negligible beside u M is dropped, because it would only make numbers longer. In relative
        // errors it is kept, because the distance may be any fraction of M.
        let eta = if relative || self.unit < lowest_bit(eta) + 174 { eta } else { 0.0 };
        // 2 max(bits, 64) bits below the lowest bit of all numbers suffice, because u M is at least 2^(unit - 53).
        let fine = self.unit.min(lowest_bit(computed)).min(lowest_bit(eta)) - 160;
        let (distance, vertex_distance) = self.fixed(fine);
        let computed = integer(computed, fine);
        let difference = (computed - IBig::from(distance.clone())).into_parts().1 + UBig::ONE;
        let eta = UBig::try_from(integer(eta, fine)).expect("not negative");
        if difference <= eta {
            return 0.0;
        }
        let per = if relative { distance } else { vertex_distance };
        if per == UBig::ZERO {
            return if difference <= UBig::ONE { 0.0 } else { f64::INFINITY };
        }
        // The ratio is in units of 2^-20 u M, rounded up.
        let ratio = ((difference - eta) << (20 + bits as usize)) / per + UBig::ONE;
        ratio.to_f64().value() / f64::from(1 << 20)
    }

    /// Returns whether the true distance is at least `bound`. It is never at least a bound that is infinite or NaN.
    #[must_use]
    pub fn is_at_least(&self, bound: f64) -> bool {
        if bound <= 0.0 {
            return true;
        }
        if !bound.is_finite() {
            return false;
        }
        self.compare(&Self::new([0.0; 3], &[[bound, 0.0, 0.0]])) != Ordering::Less
    }

    /// Returns the true distance as the sum of a rounded number and a remainder, to more than 110 bits. The scale of
    /// the scene must be moderate, so that both stay in the range of f64.
    #[must_use]
    pub fn length(&self) -> [f64; 2] {
        // The root has about 118 bits.
        let bits_of = |x: &IBig| i64::try_from(x.bit_len()).expect("small");
        let bits = (bits_of(&self.square.numerator) - bits_of(&self.square.denominator)) / 2;
        let fine = self.unit + (bits - 118).min(0);
        let (distance, _) = self.fixed(fine);
        let rounded = distance.to_f64().value();
        let rest = (IBig::from(distance) - integer(rounded, 0)).to_f64().value();
        let exponent = i32::try_from(fine).expect("small");
        [rounded, rest].map(|x| x * 2f64.powi(exponent / 2) * 2f64.powi(exponent - exponent / 2))
    }

    /// Returns the largest distance from the query to a vertex, up to a few roundings.
    #[must_use]
    pub fn max_vertex_distance(&self) -> f64 {
        self.times_max_vertex_distance(1.0)
    }

    /// Returns `factor` times the largest distance from the query to a vertex. Only the result has to be in the range
    /// of f64.
    #[must_use]
    pub fn times_max_vertex_distance(&self, factor: f64) -> f64 {
        let fine = self.unit - 64;
        let (_, vertex_distance) = self.fixed(fine);
        let excess = vertex_distance.bit_len().saturating_sub(64);
        let leading = (vertex_distance >> excess).to_f64().value() * factor;
        let exponent = i32::try_from(fine).expect("small") + i32::try_from(excess).expect("small");
        // The factor is applied in two steps, so that neither part leaves the range of f64.
        leading * 2f64.powi(exponent / 2) * 2f64.powi(exponent - exponent / 2)
    }
}

/// Returns the edges of a hull of one to three vertices.
fn edges(hull: &[V]) -> Vec<[&V; 2]> {
    match hull {
        [a, b] => vec![[a, b]],
        [a, b, c] => vec![[a, b], [b, c], [c, a]],
        _ => Vec::new(),
    }
}

/// Returns the squared distance from a query to the hull of one to three vertices.
fn from_vertex(query: &V, vertices: &[V]) -> Ratio {
    let offsets: Vec<V> = vertices.iter().map(|v| sub(v, query)).collect();
    let mut candidates: Vec<Ratio> = offsets.iter().map(|v| Ratio::new(dot(v, v), IBig::ONE)).collect();
    for [a, b] in edges(&offsets) {
        let d = sub(b, a);
        let length = dot(&d, &d);
        let along = -dot(a, &d);
        if along > IBig::ZERO && along < length {
            let numerator = dot(a, a) * &length - &along * &along;
            candidates.push(Ratio::new(numerator, length));
        }
    }
    if let [a, b, c] = &offsets[..] {
        let normal = cross(&sub(b, a), &sub(c, a));
        // The query is the origin: (b - a) x (0 - a) must not point against the normal.
        let inside = edges(&offsets).iter().all(|[a, b]| dot(&normal, &cross(a, &sub(b, a))) >= IBig::ZERO);
        let denominator = dot(&normal, &normal);
        if inside && denominator > IBig::ZERO {
            let height = dot(&normal, a);
            candidates.push(Ratio::new(&height * &height, denominator));
        }
    }
    candidates.into_iter().min_by(Ratio::compare).expect("at least one vertex")
}

/// Returns the squared distance between the lines of two edges, if the nearest points are unique and on the edges.
fn inside_of_edges(p: [&V; 2], q: [&V; 2]) -> Option<Ratio> {
    let (d, e, r) = (sub(p[1], p[0]), sub(q[1], q[0]), sub(q[0], p[0]));
    let normal = cross(&d, &e);
    let denominator = dot(&normal, &normal);
    // The parameters of the nearest points, times the denominator.
    let parameters = [dot(&cross(&r, &e), &normal), dot(&cross(&r, &d), &normal)];
    let is_inside = |t: &IBig| *t >= IBig::ZERO && *t <= denominator;
    if denominator == IBig::ZERO || !parameters.iter().all(is_inside) {
        return None;
    }
    let height = dot(&r, &normal);
    Some(Ratio::new(&height * &height, denominator))
}

/// Returns whether an edge pierces a triangle: its ends are on different sides, and the point in the plane is in the
/// triangle.
fn pierces([p, q]: [&V; 2], triangle: &[V]) -> bool {
    let [a, b, c] = triangle else { return false };
    let normal = cross(&sub(b, a), &sub(c, a));
    let (at_p, at_q) = (dot(&normal, &sub(p, a)), dot(&normal, &sub(q, a)));
    let crosses = (at_p > IBig::ZERO && at_q < IBig::ZERO) || (at_p < IBig::ZERO && at_q > IBig::ZERO);
    if !crosses {
        return false;
    }
    // The edge intersects the plane at p + (q - p) at_p / (at_p - at_q). The denominator has the sign of at_p.
    let weight = &at_p - &at_q;
    let sign = if at_p > IBig::ZERO { IBig::ONE } else { -IBig::ONE };
    edges(triangle).iter().all(|[from, to]| {
        let point: V = std::array::from_fn(|k| (&p[k] - &from[k]) * &weight + (&q[k] - &p[k]) * &at_p);
        dot(&normal, &cross(&sub(to, from), &point)) * &sign >= IBig::ZERO
    })
}

/// Returns whether the convex hull of one to three vertices has a point in a closed box. All coordinates must be
/// finite.
///
/// The hull is clipped by the six half-spaces of the box one after the other, in homogeneous coordinates.
#[must_use]
pub fn intersects_box(vertices: &[[f64; 3]], corners: &[[f64; 3]; 2]) -> bool {
    let unit = vertices.iter().chain(corners).flatten().map(|x| lowest_bit(*x)).min().expect("coordinates");
    let mut hull: Vec<[IBig; 4]> =
        vertices.iter().map(|v| std::array::from_fn(|k| if k < 3 { integer(v[k], unit) } else { IBig::ONE })).collect();
    for k in 0..3 {
        let [low, high] = corners.each_ref().map(|corner| integer(corner[k], unit));
        hull = clip(&hull, |p| &p[k] - &low * &p[3]);
        hull = clip(&hull, |p| &high * &p[3] - &p[k]);
    }
    !hull.is_empty()
}

/// Returns whether a . b is at most `bound`; a and b must be finite.
#[must_use]
pub fn is_product_at_most(a: [f64; 3], b: [f64; 3], bound: f64) -> bool {
    if !bound.is_finite() {
        return bound > 0.0;
    }
    let unit = |v: &[f64; 3]| v.iter().map(|x| lowest_bit(*x)).min().expect("coordinates");
    let (unit_a, unit_b) = (unit(&a), unit(&b));
    let exact = |v: [f64; 3], unit: i64| v.map(|x| integer(x, unit));
    let fine = lowest_bit(bound).min(unit_a + unit_b);
    let up = usize::try_from(unit_a + unit_b - fine).expect("not negative");
    dot(&exact(a, unit_a), &exact(b, unit_b)) << up <= integer(bound, fine)
}

#[cfg(test)]
mod tests {
    use super::*;

    const T: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];

    fn is(query: [f64; 3], vertices: &[[f64; 3]], expected: f64) -> bool {
        Distance::new(query, vertices).relative_error(expected, 53, 0.0) < 1e-5
    }

    #[test]
    fn closed_forms() {
        assert!(is([1.0, 1.0, -7.0], &T, 7.0));
        assert!(is([-3.0, -4.0, 0.0], &T, 5.0));
        assert!(is([2.0, -3.0, 4.0], &T, 5.0));
        assert!(!is([5.0, 5.0, 0.0], &T, 0.0));
        // The root of 8 is not an f64, so the error is that of its rounding, at most half an ulp.
        assert!((0.1..1.0).contains(&Distance::new([4.0, 4.0, 0.0], &T).relative_error(8f64.sqrt(), 53, 0.0)));
        assert!(is([1.0, 5.0, 0.0], &T[..2], 5.0));
        assert!(is([7.0, 4.0, 0.0], &T[..2], 5.0));
        assert!(is([3e-300, 4e-300 - 4e-300, 0.0], &T[..1], 3e-300));
        assert!(is([0.0, 0.0, -1e308], &T, 1e308));
        let flat = [[0.0; 3], [1.0, 1.0, 1.0], [3.0, 3.0, 3.0]];
        assert!(is([4.0, 3.0, 3.0], &flat, 1.0));
    }

    #[test]
    fn hulls_meet_boxes_in_closed_forms() {
        let block = |x: f64| [[x, x, -1.0], [9.0, 9.0, 1.0]];
        assert!(intersects_box(&T, &block(2.0)) && !intersects_box(&T, &block(2.0 + 4.0 * f64::EPSILON)));
        assert!(intersects_box(&T, &[[0.5, 0.5, -1.0], [0.6, 0.6, 1.0]]), "through the face");
        assert!(!intersects_box(&T, &[[0.5, 0.5, 0.1], [0.6, 0.6, 1.0]]), "above the face");
        assert!(intersects_box(&T[1..], &[[1.0, 3.0, 0.0], [1.0, 3.0, 0.0]]) && !intersects_box(&T[1..], &block(2.1)));
        assert!(
            intersects_box(&T[..1], &[[-1.0; 3], [0.0; 3]]) && !intersects_box(&T[..1], &[[-1.0; 3], [-1e-300; 3]])
        );
    }

    #[test]
    fn distances_between_hulls_in_closed_forms() {
        let is = |a: &[[f64; 3]], b: &[[f64; 3]], expected: f64| {
            let both = [Distance::between(a, b), Distance::between(b, a)];
            both.iter().all(|d| d.relative_error(expected, 53, 0.0) < 1e-5 && d.is_zero() == (expected == 0.0))
        };
        let lifted = |t: [[f64; 3]; 3], z: f64| t.map(|[x, y, _]| [x, y, z]);
        assert!(is(&T, &lifted(T, 3.0), 3.0), "parallel triangles");
        assert!(is(&[[0.0, 0.0, 2.0], [0.0, 4.0, 2.0]], &[[-1.0, 1.0, 0.0], [1.0, 1.0, 0.0]], 2.0), "inside of both");
        assert!(is(&[[0.0, 0.0, 2.0], [0.0, 4.0, 2.0]], &[[3.0, 1.0, 0.0], [3.0, 1.0, 2.0]], 3.0), "at an end");
        assert!(is(&[[1.0, 1.0, -1.0], [1.0, 1.0, 1.0]], &T, 0.0), "an edge pierces the face");
        assert!(is(&[[-2.0, 1.0, -1.0], [-2.0, 1.0, 1.0]], &T, 2.0), "an edge passes the face");
        assert!(is(&[[5.0, 0.0, 0.0], [1.0, 1.0, 0.0]], &T, 0.0), "within the plane");
        assert!(is(&[[-1.0, 2.0, 0.0], [2.0, -1.0, 0.0]], &T, 0.0), "across a corner within the plane");
        assert!(is(&T, &[[1.0, 1.0, 0.0], [1.0, 1.0, 5.0], [2.0, 1.0, 5.0]], 0.0), "touching with a vertex");
        assert!(is(&T, &[[1.0, 1.0, 0.5], [1.0, 1.0, 5.0], [2.0, 1.0, 5.0]], 0.5), "above with a vertex");
        let line = [[0.0; 3], [1.0, 0.0, 0.0], [3.0, 0.0, 0.0]];
        assert!(is(&line, &[[1.5, -1.0, 2.0], [1.5, 1.0, 2.0]], 2.0), "a flat triangle");
    }

    /// No two points of the hulls are nearer than the distance, and some are hardly farther apart.
    #[test]
    fn no_sampled_points_are_nearer_than_the_distance_between_hulls() {
        use rand::RngExt;
        for case in crate::cases(3_000, 200) {
            let mut rng = crate::rng("distances between hulls", case);
            let mut hull = |shift: f64| -> Vec<[f64; 3]> {
                let count = rng.random_range(1..=3);
                let mut vertex = || [0; 3].map(|_| f64::from(rng.random_range(-3..=3)) + shift);
                (0..count).map(|_| vertex()).collect()
            };
            let (a, b) = (hull(0.0), hull(if case % 2 == 0 { 0.0 } else { 2.5 }));
            let [distance, _] = Distance::between(&a, &b).length();
            // Points are projected onto the other hull in turns, which converges to the nearest points.
            let mut nearest = f64::INFINITY;
            for start in 0..12 {
                let weights = [0; 3].map(|_| rng.random_range(0.0..1.0f64));
                let sum: f64 = weights[..a.len()].iter().sum();
                let mut point = [0, 1, 2].map(|k: usize| a.iter().zip(weights).map(|(v, w)| v[k] * w / sum).sum());
                for _ in 0..if start < 4 { 400 } else { 20 } {
                    point = nearest_point(point, &b);
                    let other = nearest_point(point, &a);
                    let length = (0..3).map(|k: usize| (point[k] - other[k]).powi(2)).sum::<f64>().sqrt();
                    nearest = nearest.min(length);
                    point = other;
                }
            }
            assert!(nearest >= distance - 1e-12 && nearest <= distance + 0.02, "{nearest} {distance}: {a:?} {b:?}");
        }
    }

    fn nearest_point(query: [f64; 3], hull: &[[f64; 3]]) -> [f64; 3] {
        let shape = crate::families::shape(hull);
        let projection = p2m_core::Primitive::project(&shape, &query.into());
        projection.point.coords.into()
    }

    #[test]
    fn products_are_compared_without_rounding() {
        let (a, b) = ([1.0 + f64::EPSILON, 1e200, 0.5], [1.0 - f64::EPSILON, 0.0, 4.0]);
        assert!(is_product_at_most(a, b, 3.0) && !is_product_at_most(a, b, 3f64.next_down()));
        assert!(is_product_at_most(a, b, f64::INFINITY) && !is_product_at_most(a, b, f64::NAN));
        assert!(
            is_product_at_most([1e-200; 3], [1e-200; 3], 5e-324) && !is_product_at_most([1e-200; 3], [1e-200; 3], 0.0)
        );
    }

    #[test]
    fn errors_are_measured_in_units_of_u_m() {
        let d = Distance::new([0.0, 0.0, 1.0], &T);
        let one_off = 1.0 + f64::EPSILON;
        // The vertex distance is M = sqrt(17), and u = eps / 2.
        let expected = 2.0 / 17f64.sqrt();
        assert!((d.error(one_off, 53, 0.0) - expected).abs() < 1e-5);
        assert_eq!(d.error(f64::NAN, 53, 0.0), f64::INFINITY);
        assert_eq!(d.error(f64::INFINITY, 53, 0.0), f64::INFINITY);
        // The distance is 2.2e-309, rounded, and the vertices are multiples of 2^-344.
        let long = [[-7.794685076942073e307, 4.9483662130201084e-88, -44.0], [0.00390625, 0.0, 0.0]];
        let d309 = Distance::new([0.0; 3], &long);
        assert_eq!(d309.relative_error(2.2050281480702e-309, 53, f64::from_bits(1)), 0.0);
        assert!(d309.relative_error(2.2050281480702e-309, 53, 0.0) > 1.0);
        assert!((d.max_vertex_distance() - 17f64.sqrt()).abs() < 1e-14);
        assert!(d.is_at_least(1.0) && !d.is_at_least(one_off));
    }

    #[test]
    fn lengths_have_twice_as_many_digits() {
        // The first distance is the diagonal of a square, whose root is known; the second is an integer.
        let [rounded, rest] = Distance::new([0.0; 3], &[[1.0, 1.0, 0.0]]).length();
        assert_eq!((rounded, rest), (std::f64::consts::SQRT_2, -9.667_293_313_452_913e-17));
        assert_eq!(Distance::new([0.0, 0.0, 3.0], &T).length(), [3.0, 0.0]);
        assert_eq!(Distance::new([1e-3, 1e-3, 0.0], &T).length(), [0.0, 0.0]);
        // The query is near the surface and far from the vertices, so the error is small in units of u M.
        let query = [0.1, 0.2, 1e-9];
        let [near, rest] = Distance::new(query, &T).length();
        assert_eq!((near, rest.abs() < 1e-30), (1e-9, true));
        // The plane is not parallel to an axis, and the query is 1 / sqrt(3) of a unit in the last place above it.
        let tilted = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let [near, rest] = Distance::new([0.25, 0.25, 0.5 + 2f64.powi(-53)], &tilted).length();
        let expected = 2f64.powi(-53) / 3f64.sqrt();
        assert!((near - expected).abs() <= expected * f64::EPSILON && rest != 0.0, "{near:e} + {rest:e}, {expected:e}");
    }
}
