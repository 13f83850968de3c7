//! Certified queries: the nearest of several primitives in real arithmetic, and its distance, rounded once.
//!
//! The kernel has errors of a few u M, where M is the largest distance from the query to a vertex. If the distances of
//! two primitives differ by less than that, it may name the wrong one, and a distance of about u M may have no correct
//! digit. Contract N8 promises more. The coordinates are taken as real numbers, and
//!
//! - the winner is the nearest primitive; exact ties go to the lowest id;
//! - its distance is the true one, rounded to the nearest f64 (ties to even), and infinite beyond the range of f64. So
//!   the error is at most half a unit in the last place;
//! - the lower bound is at most the true distance, and at most one unit in the last place below the reported one.
//!
//! All finite input is valid. A degenerate primitive is the set that its vertices span.
//!
//! # Stages
//!
//! 1. The kernel names the feature of each primitive that is probably nearest. [`feature_certificate`] proves this
//!    claim by signs that are certain in f64 or in double-double. The squared distance of the feature is then computed
//!    in double-double with a bound on its relative error ([`double_double`]), which is about 2^-100 unless the query
//!    is very near. If the nearest features of several candidates are proved to be the same vertex, edge or face, the
//!    candidates are equally near whatever rounding says, and the distance is computed once.
//! 2. Big integers ([`rational`]) decide between candidates that the first stage cannot distinguish. They also find the
//!    feature if the claim of the kernel is wrong or cannot be proved, and round the distance if the first stage admits
//!    two roundings.
//!
//! The claims of the kernel affect the work and never the answer, since a wrong claim cannot be proved.

mod candidate;
mod decide;
mod double_double;
mod feature;
mod feature_certificate;
mod pairs;
mod query;
mod rational;
mod rounded;
#[cfg(test)]
mod tests;

pub(crate) use pairs::{PairCandidate, decide_pairs, true_distance};
pub use query::{CertifiedQuery, CertifyError, shape_of};
