//! Advice: which backend of the registry a scene and its queries call for.
//!
//! [`recommend`] estimates for each backend the time to build its index and to answer all queries, and its memory. It
//! recommends the one with the least time among those that fit into the memory. The estimates come from a sample of the
//! scene, over which every index that may win is built and timed: a few neighbourhoods for queries near the surface,
//! and primitives from everywhere for other queries. The results are scaled to the whole scene: builds by the number of
//! primitives, queries by a growth for each doubling of the scene ([`CostModel`](crate::CostModel)).
//!
//! Some backends are not measured. An index that takes longer to build than a tree takes for the whole job cannot win.
//! Indexes with cells are left out for scenes of slivers, where most cells would fall back to the tree.
//!
//! All indexes that may win are built over a sample of 300 primitives, and those that may still win over a sample that
//! is as large as a small part of the expected time of the job permits. If there is no time for the smallest sample,
//! the figures of [docs/measurements/paper.md] decide.
//!
//! Estimates are for one thread. They depend on the machine and its load, so the advice may differ from run to run
//! where two backends are about equally good.
//!
//! [docs/measurements/paper.md]: https://github.com/p2m-rs/p2m/blob/main/docs/measurements/paper.md

mod estimate;
mod recommend;
mod sample;
mod workload;

pub use estimate::{Advice, Estimate};
pub use recommend::recommend;
pub(crate) use sample::{is_mostly_slivers, sample_queries};
pub use workload::{QueryRegion, Workload};
