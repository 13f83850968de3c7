//! An index of any backend, and the settings that it is built with.

use super::kdop_directions::{ChosenDirections, KdopDirections};
use super::p2m_settings::P2mSettings;
use p2m_bvh::SplitOptions;
use p2m_core::storage::Writer;
use p2m_core::{AnyIndex, Real};
use p2m_interception::{OctreeOptions, Progress, RefinementProgress};
use std::ops::ControlFlow;
use std::sync::Arc;

/// An index that was built or loaded, with the facts that reports state about it.
#[derive(Clone)]
pub struct BuiltIndex<T: Real = f64> {
    /// The index itself, which shares its scene.
    pub index: Arc<dyn AnyIndex<T>>,
    /// The directions of a k-DOP tree.
    pub directions: Option<ChosenDirections>,
}

impl BuiltIndex {
    /// Adds the index and its directions to a file, without the scene.
    pub fn save<'s>(&'s self, writer: &mut Writer<'s>) {
        self.index.save(writer);
        if let Some(directions) = &self.directions {
            directions.save(writer);
        }
    }
}

/// The settings that a build by name accepts. A backend ignores those that it does not have.
#[derive(Clone, Copy)]
#[non_exhaustive]
pub struct BuildSettings<'p> {
    /// Whether the build uses all threads of the current pool; true by default. It has no effect without the feature
    /// `rayon` of the crate of the index.
    pub is_parallel: bool,
    /// The directions of k-DOPs; `None` for the default, which has 14 faces.
    pub kdop_directions: Option<KdopDirections>,
    /// The locator and the list filter of a P2M index; a grid and sorted lists by default.
    pub p2m: P2mSettings,
    /// The fineness of the cells of an octree; `None` for the default. Finer cells have larger budgets.
    pub resolution: Option<f64>,
    /// The largest number of bytes of the cells and lists of an octree, besides its tree; unlimited by default. Cells
    /// stay coarser if they would take more.
    pub max_cell_bytes: usize,
    /// Receives the progress of the build, from backends that [report it](crate::BackendEntry::reports_progress).
    pub progress: &'p (dyn Fn(Progress) + Sync),
    /// Receives the size that an octree would have if its refinement ended now, and may end it
    /// ([`OctreeIndex::build_until`](p2m_interception::OctreeIndex::build_until)).
    pub visit_octree: &'p (dyn Fn(&RefinementProgress) -> ControlFlow<()> + Sync),
}

impl Default for BuildSettings<'_> {
    fn default() -> Self {
        Self {
            is_parallel: true,
            kdop_directions: None,
            p2m: P2mSettings::default(),
            resolution: None,
            max_cell_bytes: usize::MAX,
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

    /// Sets the fineness of the cells of an octree.
    #[must_use]
    pub fn with_resolution(self, resolution: Option<f64>) -> Self {
        Self { resolution, ..self }
    }

    /// Sets the largest number of bytes of the cells and lists of an octree.
    #[must_use]
    pub fn with_max_cell_bytes(self, max_cell_bytes: usize) -> Self {
        Self { max_cell_bytes, ..self }
    }

    /// Sets the function that receives the progress of the build.
    #[must_use]
    pub fn with_progress(self, progress: &'p (dyn Fn(Progress) + Sync)) -> Self {
        Self { progress, ..self }
    }

    /// Sets the function that may end the refinement of an octree.
    #[must_use]
    pub fn with_visit_octree(self, visit_octree: &'p (dyn Fn(&RefinementProgress) -> ControlFlow<()> + Sync)) -> Self {
        Self { visit_octree, ..self }
    }

    /// Returns the options of an octree over `primitives` primitives.
    pub(crate) fn octree_options(&self, primitives: usize) -> OctreeOptions {
        let options = OctreeOptions::default().with_splits(self.splits());
        let factor = self.resolution.map_or(1.0, |resolution| resolution / options.resolution);
        options.with_finer_cells(factor).with_max_bytes(self.max_cell_bytes, primitives)
    }

    /// Returns the splits of trees, with the choice of threads.
    pub(crate) fn splits(&self) -> SplitOptions {
        SplitOptions::default().with_parallel(self.is_parallel)
    }
}
