//! Closest-point queries: their options, their answers, and the collectors between a search and an answer.
//!
//! A backend only traverses its structure. It reports candidates to a [`Collector`], which returns the limit for
//! pruning. So only [`Best`] decides the radius, ties, epsilon and the certified lower bound.
//!
//! # Approximation
//!
//! Two options give up exactness: a relative error (epsilon) and a limit on visits (`max_visits`). A search with these
//! options keeps an *incumbent*: the primitive with the least upper bound on its distance, which need not have been
//! evaluated. Incumbents are evaluated before the search ends, so the answer is never farther than the incumbent was.
//! Subtrees whose lower bound exceeds the distance of the incumbent / (1 + epsilon) are skipped, and the smallest bound
//! of all unvisited subtrees is reported ([`Best::record_skipped`]). So the lower bound of the answer is certified for
//! all options, and a caller knows the error without another query ([docs/proofs/accuracy.md], N7).
//!
//! [docs/proofs/accuracy.md]: https://github.com/p2m-rs/p2m/blob/main/docs/proofs/accuracy.md

#[macro_use]
mod forward;

pub(crate) mod answer;
mod batch_answer;
mod best;
mod closest;
mod collector;
mod options;

pub use batch_answer::BatchAnswer;
pub use best::{Best, BestF64};
pub use closest::Closest;
pub use collector::Collector;
pub use options::QueryOptions;
