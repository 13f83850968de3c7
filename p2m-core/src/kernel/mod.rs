//! The contract kernel: what the distance from a query to a primitive is, bit for bit.
//!
//! `scalar` is the reference and the finish of every filter; a [`Key`] is the number by which it compares.
//! See docs/proofs/accuracy.md for the error bound and its proof.

#![allow(clippy::float_cmp, reason = "ties are equality of bits, and are decided here")]

pub mod arithmetic;
pub mod double_double;
mod edge;
mod face;
mod key;
mod rescaled;
pub(crate) mod triangle;
pub mod vector;
pub mod vertices;

pub use key::Key;

use crate::Feature;
pub use vector::exponent;
pub use vector::power_of_two;
use vector::{V3, bounds, clamp, scale_by_power};

/// Bound on the error of a distance in units of u M, where M is the largest distance from the query to a vertex of
/// the primitive: |computed - true| <= `ERROR_CONSTANT` u M + eta. Proved in docs/proofs/accuracy.md; the largest error
/// observed is 3.3 u M.
pub const ERROR_CONSTANT: f64 = 8.0;

/// Triangles whose height is below this part of their longest edge are slivers: they get that height in double-double,
/// which takes longer. 2^-10.
pub const SLIVER_SINE: f64 = 1.0 / 1024.0;

/// The winner among the features of one primitive.
///
/// Numbers and a small code, no payloads in an enum: they stay in registers on their way to a collector.
#[derive(Clone, Copy)]
pub struct Nearest {
    pub key: Key,
    /// From the query to the nearest point, divided by 2^`exponent`.
    pub offset: V3,
    pub exponent: i32,
    pub feature: Feature,
    /// Of the vertices.
    pub weights: V3,
    /// The largest component of an offset to a vertex.
    pub size: f64,
}

/// Vertex i and its weights.
#[inline(always)]
#[allow(clippy::cast_possible_truncation, reason = "a primitive has at most three vertices")]
fn of_vertex(i: usize) -> (Feature, V3) {
    let weights = match i {
        0 => [1.0, 0.0, 0.0],
        1 => [0.0, 1.0, 0.0],
        _ => [0.0, 0.0, 1.0],
    };
    (Feature::Vertex(i as u8), weights)
}

/// Edge i, with the weights of vertices i and i + 1.
#[inline(always)]
#[allow(clippy::cast_possible_truncation, reason = "a primitive has at most three vertices")]
fn of_edge(i: usize, [a, b]: [f64; 2]) -> (Feature, V3) {
    let weights = match i {
        0 => [a, b, 0.0],
        1 => [0.0, a, b],
        _ => [b, 0.0, a],
    };
    (Feature::Edge(i as u8), weights)
}

impl Nearest {
    /// The nearest point of a primitive with these vertices, in its box; a vertex is given verbatim.
    #[inline(always)]
    pub fn point<const N: usize>(&self, query: V3, vertices: &[V3; N]) -> V3 {
        match self.feature {
            Feature::Vertex(i) => vertices[usize::from(i)],
            Feature::Edge(i) => {
                let i = usize::from(i);
                let [low, high] = bounds(&[vertices[i], vertices[(i + 1) % N]]);
                clamp(self.landing(query), low, high)
            }
            Feature::Face => {
                let [low, high] = bounds(vertices);
                clamp(self.landing(query), low, high)
            }
        }
    }

    #[inline(always)]
    fn landing(&self, query: V3) -> V3 {
        if self.exponent == 0 {
            [query[0] + self.offset[0], query[1] + self.offset[1], query[2] + self.offset[2]]
        } else {
            self.scaled_landing(query)
        }
    }

    #[cold]
    fn scaled_landing(&self, query: V3) -> V3 {
        std::array::from_fn(|k| {
            let at =
                |shift: i32| scale_by_power(query[k], shift) + scale_by_power(self.offset[k], self.exponent + shift);
            // The sum is rounded once: at an eighth of the scale where the offset overflows, far up where it is
            // subnormal.
            let offset = scale_by_power(self.offset[k], self.exponent);
            if !offset.is_finite() {
                at(-3) * 8.0
            } else if offset.abs() < f64::MIN_POSITIVE && query[k].abs() < 1.0 {
                scale_by_power(at(600), -600)
            } else {
                query[k] + offset
            }
        })
    }

    /// How far the computed distance may be from the true one (without eta): `ERROR_CONSTANT` u M, M <= sqrt(3) size.
    #[inline(always)]
    pub fn error(&self) -> f64 {
        /// Above sqrt(3) 2^-53 by more than the rounding of the product.
        const SQRT_3_U: f64 = 1.7321 * (f64::EPSILON / 2.0);
        (ERROR_CONSTANT * SQRT_3_U) * self.size
    }
}
