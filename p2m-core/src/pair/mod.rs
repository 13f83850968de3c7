//! The nearest points of two primitives, and whether two primitives intersect.
//!
//! # Method
//!
//! The nearest points of two points, segments or triangles that do not intersect are
//!
//! - a vertex of one and its nearest point on the other, which the kernel for query points finds, or
//! - points inside of two edges that are not parallel (the file `edges`).
//!
//! So the distance is the smallest key of up to six vertices and nine pairs of edges. Exact predicates decide whether
//! the primitives intersect (the file `intersection`); the distance is then 0.
//!
//! # Accuracy
//!
//! [`ERROR_CONSTANT_OF_PAIRS`] states the bound, and [docs/proofs/pairs.md] derives it. A key is a pure function of two
//! features: it does not depend on the order of the primitives or of their vertices, and it is never below the square
//! of the gap between their boxes, which is computed in the same arithmetic ([`Aabb::gap_squared`]). So a search may
//! prune by boxes without any slack, and equal distances are equal bits.
//!
//! [`Aabb::gap_squared`]: crate::Aabb::gap_squared
//!
//! [docs/proofs/pairs.md]: https://github.com/p2m-rs/p2m/blob/main/docs/proofs/pairs.md

mod batch;
mod collector;
mod edges;
mod hull;
mod interruptible;
mod intersection;
mod motion;
mod moving_ball;
mod query;
#[doc(hidden)]
pub mod search;
#[cfg(test)]
mod tests;

use crate::kernel::vector::{V3, bounds, clamp, largest, sub};
use crate::kernel::{Key, SQRT_3_U, edge_feature, vertex_feature};
use crate::primitive::{Feature, Primitive, Projection};
use crate::query::answer::ROUND_DOWN;
use crate::{Aabb, Real};
pub use batch::{closest_pair_at_each, closest_to_each};
pub use collector::{ClosestPair, PairOptions, Pairs};
use edges::nearest_on_edges;
pub use hull::Hull;
pub use intersection::do_intersect;
pub use motion::{Motion, is_rotation_and_translation, isometry_of_matrix};
pub use moving_ball::{BallContact, MovingBall};
use nalgebra::Point3;
pub use query::{PairQuery, closest_as_guess};

/// The bound on the error of the distance between two primitives in units of u M, where M is the largest distance
/// between a vertex of one and a vertex of the other: |computed - true| <= `ERROR_CONSTANT_OF_PAIRS` u M + 4 eta.
///
/// It is proved in [docs/proofs/pairs.md]. For a vertex and its nearest point the constant is 8, as for query points.
///
/// [docs/proofs/pairs.md]: https://github.com/p2m-rs/p2m/blob/main/docs/proofs/pairs.md
pub const ERROR_CONSTANT_OF_PAIRS: f64 = 32.0;

/// The nearest points of two primitives.
///
/// All numbers are in f64 and in units of the scene, for both scalar types. In arrays of two, the first entry belongs
/// to the first primitive.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct NearestPair {
    /// The squared distance, by which pairs are compared. It is zero if and only if the primitives intersect.
    pub key: Key,
    /// The nearest points. If the primitives intersect, both are near a common point.
    pub points: [Point3<f64>; 2],
    /// The features of lowest dimension that contain the points.
    pub features: [Feature; 2],
    /// The weights of the vertices of each primitive for its point.
    pub barycentric: [[f64; 3]; 2],
    /// A bound on the error of [`Key::distance`], apart from four smallest subnormals.
    pub error: f64,
    /// Whether the primitives have a common point. It is exact.
    pub is_intersecting: bool,
}

impl NearestPair {
    /// Returns the pair with its primitives exchanged.
    #[must_use]
    pub fn swapped(mut self) -> Self {
        self.points.swap(0, 1);
        self.features.swap(0, 1);
        self.barycentric.swap(0, 1);
        self
    }
}

/// Returns the nearest points of two primitives, which have vertices and may be degenerate.
///
/// ```
/// use nalgebra::Point3;
/// use p2m_core::pair::nearest_pair;
/// use p2m_core::{Feature, Segment, Triangle};
///
/// let floor = Triangle::new(Point3::new(0.0, 0.0, 0.0), Point3::new(4.0, 0.0, 0.0), Point3::new(0.0, 4.0, 0.0));
/// let pole = Segment::new(Point3::new(1.0, 1.0, 2.0), Point3::new(1.0, 1.0, 9.0));
/// let pair = nearest_pair(&floor, &pole);
/// assert_eq!((pair.key.distance(), pair.is_intersecting), (2.0, false));
/// assert_eq!(pair.features, [Feature::Face, Feature::Vertex(0)]);
/// assert_eq!(pair.points, [Point3::new(1.0, 1.0, 0.0), Point3::new(1.0, 1.0, 2.0)]);
/// ```
///
/// # Panics
/// Panics if a primitive has no [vertices](Primitive::vertices), as may be the case for types of your own.
///
/// # Accuracy
/// The error of the distance is at most [`ERROR_CONSTANT_OF_PAIRS`] u M + 4 eta (proved) if all coordinates are finite;
/// otherwise the result is meaningless. Whether the primitives intersect is exact.
#[must_use]
pub fn nearest_pair<T: Real>(a: &impl Primitive<T>, b: &impl Primitive<T>) -> NearestPair {
    nearest_pair_within(a, b, f64::INFINITY).expect("no key exceeds infinity")
}

/// Returns the nearest points of two primitives, or `None` if their key certainly exceeds `square`. Pass the [square
/// above](Key::square_above) another key.
///
/// # Panics
/// Panics if a primitive has no vertices.
#[must_use]
pub fn nearest_pair_within<T: Real>(a: &impl Primitive<T>, b: &impl Primitive<T>, square: f64) -> Option<NearestPair> {
    nearest_of_hulls(Hull::of(a).vertices(), Hull::of(b).vertices(), square).ok()
}

/// Returns the nearest points of two hulls of one to three vertices each. If their key certainly exceeds `square`, the
/// error is a lower bound on the true distance, which is infinite if the hulls are farther apart than `square` allows.
///
/// # Panics
/// Panics if a hull has no vertex, or more than three.
#[doc(hidden)]
pub fn nearest_of_hulls(a: &[V3], b: &[V3], square: f64) -> Result<NearestPair, f64> {
    let bounds = [a, b].map(bounds_of);
    let gap = bounds[0].gap_squared(&bounds[1]);
    if gap > square {
        return Err(f64::INFINITY);
    }
    let is_intersecting = gap == 0.0 && do_intersect(a, b);
    // The key will be zero, so rounding must not exclude any candidate.
    let square = if is_intersecting { f64::INFINITY } else { square };
    let mut best = Candidate(None);
    for (i, vertex) in a.iter().enumerate() {
        best.offer_vertex(i, *vertex, b, square, false);
    }
    for (i, vertex) in b.iter().enumerate() {
        best.offer_vertex(i, *vertex, a, square, true);
    }
    for (i, p) in edges_of(a) {
        for (j, q) in edges_of(b) {
            best.offer_edges([i, j], [p, q], square);
        }
    }
    if is_intersecting {
        // A point inside of a face is not among the candidates yet.
        for (i, edge) in edges_of(a) {
            best.offer_piercing(i, edge, b, false);
        }
        for (i, edge) in edges_of(b) {
            best.offer_piercing(i, edge, a, true);
        }
    }
    let size = a.iter().flat_map(|v| b.iter().map(|w| largest(&[sub(*w, *v)]))).fold(0.0, f64::max);
    let error = ERROR_CONSTANT_OF_PAIRS * SQRT_3_U * size;
    match best.0 {
        Some(pair) if is_intersecting => Ok(NearestPair { key: Key::ZERO, is_intersecting, error, ..pair }),
        Some(pair) if pair.key.square_above() <= square.max(Key::ZERO.square_above()) => {
            // If the offset cancels, the distance is still positive, though less than its error. No search may take the
            // pair for an intersecting one.
            let key = if pair.key == Key::ZERO { Key::from_offset([f64::from_bits(1), 0.0, 0.0]) } else { pair.key };
            Ok(NearestPair { key, error, ..pair })
        }
        // Rounding may have replaced points inside of edges by an end that is farther, by as much as the error.
        _ => Err(square.sqrt() * ROUND_DOWN - error),
    }
}

/// Returns the box around the vertices.
#[doc(hidden)]
#[must_use]
pub fn bounds_of(vertices: &[V3]) -> Aabb<f64> {
    vertices.iter().fold(Aabb::empty(), |all, vertex| all.union(&Aabb { min: (*vertex).into(), max: (*vertex).into() }))
}

/// Returns the edges of a hull of one to three vertices, with their numbers.
pub(crate) fn edges_of(hull: &[V3]) -> impl Iterator<Item = (u8, [V3; 2])> + Clone + '_ {
    let count: u8 = match hull.len() {
        1 => 0,
        2 => 1,
        _ => 3,
    };
    (0..count).map(|i| (i, [hull[usize::from(i)], hull[(usize::from(i) + 1) % hull.len()]]))
}

/// Returns the feature and the weights of the point with parameter `t` of an edge.
fn point_of_edge(number: u8, t: f64) -> (Feature, V3) {
    edge_feature(usize::from(number), [1.0 - t, t])
}

/// The best pair of points so far.
struct Candidate(Option<NearestPair>);

impl Candidate {
    /// Returns the square above which a candidate is useless.
    fn limit(&self, square: f64) -> f64 {
        self.0.map_or(square, |best| best.key.square_above().min(square))
    }

    /// Takes a pair if it is nearer than the best so far.
    fn offer(&mut self, key: Key, points: [Point3<f64>; 2], features: [Feature; 2], barycentric: [V3; 2]) {
        if self.0.is_none_or(|best| key < best.key) {
            self.0 = Some(NearestPair { key, points, features, barycentric, error: 0.0, is_intersecting: false });
        }
    }

    /// Offers vertex i of one hull and its nearest point on the other. `is_second` is whether the vertex belongs to the
    /// second hull.
    fn offer_vertex(&mut self, i: usize, vertex: V3, other: &[V3], square: f64, is_second: bool) {
        let Some(projection) = project(vertex, other, self.limit(square)) else { return };
        self.offer_projection(vertex, vertex_feature(i), &projection, is_second);
    }

    /// Offers a point of one hull, with its feature and weights, and its projection onto the other hull.
    fn offer_projection(&mut self, point: V3, at: (Feature, V3), projection: &Projection, is_second: bool) {
        let mut points = [point.into(), projection.point];
        let mut features = [at.0, projection.feature];
        let mut barycentric = [at.1, projection.barycentric];
        if is_second {
            points.swap(0, 1);
            features.swap(0, 1);
            barycentric.swap(0, 1);
        }
        self.offer(projection.key, points, features, barycentric);
    }

    /// Offers the nearest points inside of two edges.
    fn offer_edges(&mut self, numbers: [u8; 2], edges: [[V3; 2]; 2], square: f64) {
        let [p, q] = edges.map(|edge| bounds_of(&edge));
        if p.gap_squared(&q) > self.limit(square) {
            return;
        }
        let Some(nearest) = nearest_on_edges(&edges[0], &edges[1]) else { return };
        let [(p, p_weights), (q, q_weights)] = [0, 1].map(|k: usize| point_of_edge(numbers[k], nearest.parameters[k]));
        self.offer(nearest.key, nearest.points.map(Point3::from), [p, q], [p_weights, q_weights]);
    }

    /// Offers the point in which an edge of one hull pierces the face of the other, if there is one.
    fn offer_piercing(&mut self, number: u8, edge: [V3; 2], other: &[V3], is_second: bool) {
        let Some(t) = intersection::piercing_parameter(&edge, other) else { return };
        let [p, q] = edge;
        let [low, high] = bounds(&edge);
        let point = clamp(std::array::from_fn(|k| p[k] * (1.0 - t) + q[k] * t), low, high);
        let Some(projection) = project(point, other, f64::INFINITY) else { return };
        self.offer_projection(point, point_of_edge(number, t), &projection, is_second);
    }
}

/// Projects a point onto the hull of one to three vertices, unless the key certainly exceeds `square`.
#[doc(hidden)]
#[must_use]
pub fn project(query: V3, hull: &[V3], square: f64) -> Option<Projection> {
    match hull {
        [a] => Projection::onto_point(query, &[*a], square),
        [a, b] => Projection::onto_segment(query, &[*a, *b], square),
        [a, b, c] => Projection::onto_triangle(query, &[*a, *b, *c], square),
        _ => None,
    }
}
