//! The contract kernel, which defines the distance from a query to a primitive, bit for bit.
//!
//! The functions of `triangle` compute the nearest point, and all filters leave the decision to them. Candidates are
//! compared by their [`Key`]. [docs/proofs/accuracy.md] has the error bound and its proof.
//!
//! [docs/proofs/accuracy.md]: https://github.com/p2m-rs/p2m/blob/main/docs/proofs/accuracy.md

#![allow(clippy::float_cmp, reason = "ties are equality of bits, and are decided here")]

pub(crate) mod arithmetic;
pub(crate) mod double_double;
mod edge;
mod face;
mod key;
mod nearest;
mod rescaled;
pub(crate) mod side_by_side;
pub(crate) mod triangle;
pub(crate) mod vector;

pub use face::SLIVER_SINE;
pub use key::Key;
pub use nearest::ERROR_CONSTANT;
pub(crate) use nearest::{Nearest, SQRT_3_U, edge_feature, vertex_feature};
pub use vector::{exponent, power_of_two};
