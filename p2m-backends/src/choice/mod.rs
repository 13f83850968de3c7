//! The choice of an index for a scene and a workload, by counted work.
//!
//! The tree of boxes is built first, since an octree contains it. A few of the queries are searched in the tree, and
//! their nodes and packets are counted. Each entry of the registry has the time of its index per node, per packet and,
//! for its build, per primitive ([`Cost`](crate::Cost)). From these follow the times of all indexes. The one with the
//! least time for its build and all queries is chosen. Nothing else is built, with one exception: boxes fit slivers
//! badly, and the boxes do not show how much better k-DOPs fit. Where they may pay, they are built, and their work is
//! counted as well.
//!
//! No time is measured, so the choice depends on the scene, the queries and their number, and not on the load of the
//! machine; only near a break-even the roundings of instruction sets may differ. It is the one model behind `auto`,
//! `p2m advise` and the sentences of `p2m tradeoff` ([decision 081]).
//!
//! [decision 081]: https://github.com/p2m-rs/p2m/blob/main/docs/decisions/081-one-model.md

mod estimate;
mod workload;

use crate::{BackendEntry, BuildSettings, BuiltIndex, SearchStructure};
pub use estimate::Estimate;
use estimate::{Model, Work, rank, turns, turns_in_words};
use p2m_bvh::{AabbTree, SplitOptions};
use p2m_core::{BuildError, BuildIndex, Soup};
use std::sync::Arc;
pub use workload::{QueryRegion, Workload};

/// The index that suits a scene and a workload.
pub struct Choice {
    soup: Arc<Soup<f64>>,
    /// The tree, unless the workload is too small for it. It is the index or becomes a part of it.
    tree: Option<Box<AabbTree<f64, Arc<Soup<f64>>>>>,
    /// Another index that was built to count its work.
    counted: Option<(&'static BackendEntry, BuiltIndex)>,
    /// The estimates of all indexes, the chosen one first.
    estimates: Vec<Estimate>,
    /// The largest number of bytes of the index.
    max_bytes: usize,
    /// The reason for the choice, unless queries or primitives are few.
    reason: Option<String>,
}

impl Choice {
    /// Chooses the index for a workload. It builds a tree over the scene, unless the queries are so few that an
    /// exhaustive search is done before that.
    ///
    /// ```
    /// use p2m_backends::{Choice, QueryRegion, Workload};
    /// use p2m_mixed::generate::{IcoSphere, ico_sphere};
    /// use std::sync::Arc;
    ///
    /// let ball = Arc::new(ico_sphere(&IcoSphere::default()).unwrap());
    /// let few = Choice::new(Arc::clone(&ball), &Workload::new(1_000, QueryRegion::SceneBox))?;
    /// let many = Choice::new(ball, &Workload::new(10_000_000, QueryRegion::SceneBox))?;
    /// assert_eq!((few.backend().name, many.backend().name), ("aabb", "octree"));
    /// # Ok::<(), p2m_core::BuildError>(())
    /// ```
    ///
    /// # Errors
    /// [`BuildError`] for a scene with coordinates that are not finite, or with too many primitives.
    ///
    /// # Complexity
    /// It builds one tree or two, and searches for one in 200 queries, but for at least 8 and at most 512 of them.
    pub fn new(soup: Arc<Soup<f64>>, workload: &Workload<'_>) -> Result<Self, BuildError> {
        // Zero is a lower bound on the work of queries in a tree.
        let mut estimates = Model::new(&soup, workload, &[], Work::default()).estimates(workload);
        rank(&mut estimates, workload.max_bytes as f64);
        if estimates[0].backend.structure != SearchStructure::Exhaustive {
            return Self::compare(soup, workload);
        }
        Ok(Self { soup, tree: None, counted: None, estimates, max_bytes: workload.max_bytes, reason: None })
    }

    /// Chooses the same index as [`new`](Self::new), but always counts, so that there are estimates for all indexes.
    ///
    /// # Errors
    /// Same as [`new`](Self::new).
    pub fn compare(soup: Arc<Soup<f64>>, workload: &Workload<'_>) -> Result<Self, BuildError> {
        let tree = Box::new(AabbTree::build(Arc::clone(&soup), &SplitOptions::default())?);
        let queries = workload.counted_queries(&soup);
        let work = Work::of(&*tree, &queries, workload);
        let model = Model::new(&soup, workload, &queries, work);
        let mut estimates = model.estimates(workload);
        let tree_seconds = |e: &&Estimate| e.backend == BackendEntry::default_backend();
        let tree_seconds = estimates.iter().find(tree_seconds).map_or(0.0, |tree| tree.total_seconds);
        let may_win = |e: &Estimate| e.is_permitted && e.counted.is_some() && e.total_seconds < tree_seconds;
        let (mut counted, mut slivers) = (None, String::new());
        if let Some(i) = estimates.iter().position(may_win) {
            let backend = estimates[i].backend;
            let built = backend.build(Arc::clone(&soup), &BuildSettings::default())?;
            let own = Work::of(&*built.index, &queries, workload);
            model.set_counted(&mut estimates, i, own);
            let [boxes, other] = [work.packets, own.packets];
            slivers =
                format!("slivers: a query filters about {boxes:.0} packets with boxes, {other:.0} in {backend}; ");
            counted = Some((backend, built));
        }
        rank(&mut estimates, workload.max_bytes as f64);
        let permitted = estimates.iter().filter(|estimate| estimate.is_permitted);
        let reason = slivers + &turns_in_words(&turns(permitted));
        let reason = (!workload.has_few_queries() && model.may_have_cells()).then_some(reason);
        Ok(Self { soup, tree: Some(tree), counted, estimates, max_bytes: workload.max_bytes, reason })
    }

    /// Returns the backend that was chosen.
    #[must_use]
    pub fn backend(&self) -> &'static BackendEntry {
        self.estimates[0].backend
    }

    /// Returns the resolution of the cells of an octree, unless it is the default one.
    #[must_use]
    pub fn resolution(&self) -> Option<f64> {
        self.estimates[0].resolution
    }

    /// Returns the reason for the choice as a phrase for people; `None` for few queries and small scenes.
    #[must_use]
    pub fn reason(&self) -> Option<&str> {
        self.reason.as_deref()
    }

    /// Returns an estimate for each backend, with the cells that suit the workload: the chosen one first, then the
    /// others by total time, and at the end the ones that the workload does not permit. Without
    /// [`compare`](Self::compare), queries in an index may seem to take no time.
    #[must_use]
    pub fn estimates(&self) -> Vec<&Estimate> {
        let is_first = |i: usize| self.estimates[..i].iter().all(|e| e.backend != self.estimates[i].backend);
        (0..self.estimates.len()).filter(|i| is_first(*i)).map(|i| &self.estimates[i]).collect()
    }

    /// Returns the fastest of the estimates that fit, for all numbers of queries: each with the number from which on it
    /// has the least total time. The numbers ascend from 0.
    pub fn turns(&self, fits: impl Fn(&Estimate) -> bool) -> Vec<(&Estimate, f64)> {
        turns(self.estimates.iter().filter(|estimate| fits(estimate)))
    }

    /// Builds the index that was chosen. A resolution in the settings is used in place of the chosen one.
    ///
    /// # Errors
    /// Same as [`BackendEntry::build`].
    pub fn build(self, settings: &BuildSettings<'_>) -> Result<BuiltIndex, BuildError> {
        let (backend, resolution) = (self.backend(), self.resolution());
        let settings = settings.with_resolution(settings.resolution.or(resolution));
        match (self.counted, self.tree) {
            // Unless other directions were asked for.
            (Some((counted, built)), _) if counted == backend && settings.kdop_directions.is_none() => Ok(built),
            (_, Some(tree)) => {
                let max_cell_bytes = settings.max_cell_bytes.min(self.max_bytes.saturating_sub(tree.memory()));
                backend.build_on(*tree, &settings.with_max_cell_bytes(max_cell_bytes))
            }
            (_, None) => backend.build(self.soup, &settings),
        }
    }
}
