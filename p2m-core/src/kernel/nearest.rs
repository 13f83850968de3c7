//! The nearest point of one primitive, as the kernel returns it.

use super::key::Key;
use super::vector::{V3, bounds, clamp, scale_by_power};
use crate::Feature;

/// The bound on the error of a distance in units of u M, where M is the largest distance from the query to a vertex of
/// the primitive: |computed - true| <= `ERROR_CONSTANT` u M + eta.
///
/// It is proved in [docs/proofs/accuracy.md]. The largest error observed is 3.3 u M.
///
/// [docs/proofs/accuracy.md]: https://github.com/p2m-rs/p2m/blob/main/docs/proofs/accuracy.md
pub const ERROR_CONSTANT: f64 = 8.0;

/// The nearest point of one primitive.
///
/// It consists of numbers and a small code rather than an enum with payloads, so that it stays in registers on its way
/// to a collector.
#[derive(Clone, Copy)]
pub(crate) struct Nearest {
    /// The squared length of the offset.
    pub(crate) key: Key,
    /// The vector from the query to the nearest point, divided by 2^`exponent`.
    pub(super) offset: V3,
    pub(super) exponent: i32,
    /// The feature of lowest dimension that contains the nearest point.
    pub(crate) feature: Feature,
    /// The weights of the vertices.
    pub(crate) weights: V3,
    /// The magnitude of the largest component of an offset to a vertex.
    pub(super) size: f64,
}

/// Returns vertex i as a feature, and its weights.
#[inline(always)]
#[allow(clippy::cast_possible_truncation, reason = "a primitive has at most three vertices")]
pub(crate) fn vertex_feature(i: usize) -> (Feature, V3) {
    let weights = match i {
        0 => [1.0, 0.0, 0.0],
        1 => [0.0, 1.0, 0.0],
        _ => [0.0, 0.0, 1.0],
    };
    (Feature::Vertex(i as u8), weights)
}

/// Returns edge i as a feature, and the weights of all vertices, given those of vertices i and i + 1.
#[inline(always)]
#[allow(clippy::cast_possible_truncation, reason = "a primitive has at most three vertices")]
pub(crate) fn edge_feature(i: usize, [a, b]: [f64; 2]) -> (Feature, V3) {
    let weights = match i {
        0 => [a, b, 0.0],
        1 => [0.0, a, b],
        _ => [b, 0.0, a],
    };
    (Feature::Edge(i as u8), weights)
}

/// The code of the face among features.
pub(super) const FACE_CODE: f64 = 6.0;

/// Returns the code of edge i among features. The codes of vertices are their indices.
pub(super) fn edge_feature_code(i: usize) -> f64 {
    [3.0, 4.0, 5.0][i]
}

/// Returns the feature of a code.
#[inline(always)]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small whole number")]
pub(super) fn feature_of_code(code: f64) -> Feature {
    match code as u8 {
        vertex @ 0..=2 => Feature::Vertex(vertex),
        edge @ 3..=5 => Feature::Edge(edge - 3),
        _ => Feature::Face,
    }
}

/// An upper bound on sqrt(3) u. Its margin exceeds the rounding of products with it.
pub(crate) const SQRT_3_U: f64 = 1.7321 * (f64::EPSILON / 2.0);
/// The bound on the error of a distance per unit of the largest component of an offset to a vertex, apart from eta. It
/// is `ERROR_CONSTANT` u M with M <= sqrt(3) size.
pub(super) const ERROR_PER_SIZE: f64 = ERROR_CONSTANT * SQRT_3_U;

impl Nearest {
    /// Returns the nearest point of a primitive with these vertices. It lies in the box of the primitive, and a vertex
    /// is returned verbatim.
    #[inline(always)]
    pub(crate) fn point<const N: usize>(&self, query: V3, vertices: &[V3; N]) -> V3 {
        match self.feature {
            Feature::Vertex(i) => vertices[usize::from(i)],
            Feature::Edge(i) => {
                let i = usize::from(i);
                let [low, high] = bounds(&[vertices[i], vertices[(i + 1) % N]]);
                clamp(self.unclamped_point(query), low, high)
            }
            Feature::Face => {
                let [low, high] = bounds(vertices);
                clamp(self.unclamped_point(query), low, high)
            }
        }
    }

    /// Returns the sum of the query and the offset, each coordinate rounded once.
    #[inline(always)]
    fn unclamped_point(&self, query: V3) -> V3 {
        if self.exponent == 0 {
            [query[0] + self.offset[0], query[1] + self.offset[1], query[2] + self.offset[2]]
        } else {
            self.unclamped_point_rescaled(query)
        }
    }

    /// Computes [`unclamped_point`](Self::unclamped_point) for an offset that is scaled by a power of two.
    #[cold]
    fn unclamped_point_rescaled(&self, query: V3) -> V3 {
        std::array::from_fn(|k| {
            let sum_at =
                |shift: i32| scale_by_power(query[k], shift) + scale_by_power(self.offset[k], self.exponent + shift);
            // The sum is rounded once. It is computed at an eighth of the scale if the offset overflows, and at a much
            // larger scale if the offset is subnormal.
            let offset = scale_by_power(self.offset[k], self.exponent);
            if !offset.is_finite() {
                sum_at(-3) * 8.0
            } else if offset.abs() < f64::MIN_POSITIVE && query[k].abs() < 1.0 {
                scale_by_power(sum_at(600), -600)
            } else {
                query[k] + offset
            }
        })
    }

    /// Returns the vector from the query to the nearest point.
    #[inline]
    pub(crate) fn unscaled_offset(&self) -> V3 {
        if self.exponent == 0 { self.offset } else { self.offset.map(|x| scale_by_power(x, self.exponent)) }
    }

    /// Returns a bound on the error of the computed distance, apart from eta.
    #[inline(always)]
    pub(crate) fn error(&self) -> f64 {
        ERROR_PER_SIZE * self.size
    }
}
