//! The cost that each backend is expected to have before anything is measured.
//!
//! The times of queries are those of the scene dragon_100k in [docs/measurements/paper.md], and those of builds are
//! from `p2m-bench query dragon_100k.obj dragon_871k.ply --backends aabb,kdop-14,octree,p2m`. The factors
//! were fitted to scenes of 16,000 to 86,000 primitives (decision 046).
//!
//! [docs/measurements/paper.md]: https://github.com/p2m-rs/p2m/blob/main/docs/measurements/paper.md

/// The number of primitives of the scene that the times of a [`CostModel`] belong to.
pub(crate) const REFERENCE_PRIMITIVES: f64 = 100_000.0;

/// The seconds that an exhaustive search spends on each primitive of the scene, in each query.
pub(crate) const EXHAUSTIVE_SECONDS_PER_PRIMITIVE: f64 = 48e-9;

/// The expected cost of a backend, on one thread.
///
/// The times of queries are those of a scene of 100,000 primitives; [`near_growth`](Self::near_growth) scales them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CostModel {
    /// Building takes this many seconds for each primitive.
    pub build_seconds_per_primitive: f64,
    /// A query near the surface takes this many seconds. Exhaustive searches ignore it.
    pub near_query_seconds: f64,
    /// A query anywhere in the box of the scene takes this many seconds. Exhaustive searches ignore it.
    pub box_query_seconds: f64,
    /// The index occupies this many bytes for each primitive.
    pub bytes_per_primitive: f64,
    /// The factor by which a query near the surface gets slower when the number of primitives doubles.
    pub near_growth: f64,
    /// The factor by which a query in the box of the scene gets slower when the number of primitives doubles.
    pub box_growth: f64,
    /// The time of a query in a scene of slivers, relative to that of the AABB tree. Only trees use it: the cells of
    /// such a scene fall back to a tree, which then determines their time.
    pub sliver_query_factor: f64,
    /// The factor that corrects times of queries that were measured on a sample of a scene without slivers. Samples
    /// have triangles of few orientations, which favours some bounding volumes.
    pub sample_correction: f64,
}
