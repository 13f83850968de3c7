//! An index of any backend with the details of its backend, and the settings that it is built with.

use crate::kdop_directions::{ChosenDirections, KdopDirections};
use crate::p2m_settings::P2mSettings;
use p2m_bvh::SplitOptions;
use p2m_core::storage::Writer;
use p2m_core::{AnyIndex, Real};
use p2m_interception::{OctreeReport, OctreeSoFar, P2mReport, Progress};
use std::ops::ControlFlow;

/// An index that was built or loaded, with the details that reports have about it.
pub struct BuiltIndex<'a, T: Real = f64> {
    /// The index itself.
    pub index: Box<dyn AnyIndex<T> + 'a>,
    /// The details of its backend.
    pub details: IndexDetails,
}

impl<'a, T: Real> BuiltIndex<'a, T> {
    /// Puts an index behind the pointer.
    pub(crate) fn new(index: impl AnyIndex<T> + 'a, details: IndexDetails) -> Self {
        Self { index: Box::new(index), details }
    }
}

impl BuiltIndex<'_> {
    /// Adds the index and its details to a file, without the scene.
    pub fn save<'s>(&'s self, writer: &mut Writer<'s>) {
        self.index.save(writer);
        if let IndexDetails::Kdop(directions) = &self.details {
            directions.save(writer);
        }
    }
}

/// The details of an index that only its backend has.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum IndexDetails {
    /// The backend has none.
    None,
    /// The directions of a k-DOP tree.
    Kdop(ChosenDirections),
    /// The numbers of cells of an octree.
    Octree(OctreeReport),
    /// The numbers of cells of a P2M index.
    P2m(P2mReport),
}

/// The settings that a build by name accepts. A backend ignores those that it does not have.
#[derive(Clone, Copy)]
#[non_exhaustive]
pub struct BuildSettings<'p> {
    /// Whether the build uses all threads of the current pool; true by default. It has no effect without the feature
    /// `rayon` of the crate of the index.
    pub is_parallel: bool,
    /// The directions of k-DOPs; `None` for those with 14 faces.
    pub kdop_directions: Option<KdopDirections>,
    /// The locator and the list filter of a P2M index; a grid and sorted lists by default.
    pub p2m: P2mSettings,
    /// The factor of the memory and work budgets of an octree, 1 by default. These budgets have a minimum, which is
    /// too large for a small sample of a scene.
    pub octree_budget_scale: f64,
    /// A function that is called with the progress of the build, by backends that
    /// [report it](crate::BackendEntry::reports_progress).
    pub progress: &'p (dyn Fn(Progress) + Sync),
    /// A function that sees what an octree would be if its refinement ended now, and may end it
    /// ([`OctreeIndex::build_until`](p2m_interception::OctreeIndex::build_until)).
    pub visit_octree: &'p (dyn Fn(&OctreeSoFar) -> ControlFlow<()> + Sync),
}

impl Default for BuildSettings<'_> {
    fn default() -> Self {
        Self {
            is_parallel: true,
            kdop_directions: None,
            p2m: P2mSettings::default(),
            octree_budget_scale: 1.0,
            progress: &|_| (),
            visit_octree: &|_| ControlFlow::Continue(()),
        }
    }
}

impl<'p> BuildSettings<'p> {
    /// Sets whether the build uses all threads.
    #[must_use]
    pub fn with_parallel(self, is_parallel: bool) -> Self {
        Self { is_parallel, ..self }
    }

    /// Sets the directions of k-DOPs.
    #[must_use]
    pub fn with_kdop_directions(self, kdop_directions: Option<KdopDirections>) -> Self {
        Self { kdop_directions, ..self }
    }

    /// Sets the locator and the list filter of a P2M index.
    #[must_use]
    pub fn with_p2m(self, p2m: P2mSettings) -> Self {
        Self { p2m, ..self }
    }

    /// Sets the factor of the budgets of an octree.
    #[must_use]
    pub fn with_octree_budget_scale(self, octree_budget_scale: f64) -> Self {
        Self { octree_budget_scale, ..self }
    }

    /// Sets the function that receives the progress of the build.
    #[must_use]
    pub fn with_progress(self, progress: &'p (dyn Fn(Progress) + Sync)) -> Self {
        Self { progress, ..self }
    }

    /// Sets the function that may end the refinement of an octree.
    #[must_use]
    pub fn with_visit_octree(self, visit_octree: &'p (dyn Fn(&OctreeSoFar) -> ControlFlow<()> + Sync)) -> Self {
        Self { visit_octree, ..self }
    }

    /// The splits of trees, with the choice of threads.
    pub(crate) fn splits(&self) -> SplitOptions {
        SplitOptions::default().with_parallel(self.is_parallel)
    }
}
