//! An entry of the registry of backends.

use crate::cost_model::CostModel;
use crate::index::{BuildSettings, BuiltIndex};
use crate::kdop_directions::KdopDirections;
use p2m_core::storage::{self, LoadError, Reader};
use p2m_core::{BuildError, Soup};
use std::fmt;
use std::sync::Arc;

/// The structure that a backend searches, as far as it determines how costs grow with the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SearchStructure {
    /// Every query examines every primitive.
    Exhaustive,
    /// A tree of bounding volumes over the primitives.
    Tree,
    /// Cells of space, each with a list of primitives near it or of those that can be nearest in it.
    SpaceCells,
    /// Cells of vertices with lists of the primitives that can be nearest in them.
    VertexCells,
}

impl SearchStructure {
    /// Whether the structure consists of cells with lists.
    #[must_use]
    pub const fn has_cells(self) -> bool {
        matches!(self, Self::SpaceCells | Self::VertexCells)
    }
}

/// A function that builds an index over a scene.
pub(crate) type BuildFn<T> = for<'a> fn(&'a Soup<T>, &BuildSettings<'_>) -> Result<BuiltIndex<'a, T>, BuildError>;
/// A function that loads an index over a borrowed scene.
type LoadFn = for<'a> fn(&'a Soup<f64>, &Reader) -> Result<BuiltIndex<'a>, LoadError>;
/// A function that loads an index over a shared scene.
type LoadSharedFn = fn(Arc<Soup<f64>>, &Reader) -> Result<BuiltIndex<'static>, LoadError>;

/// The functions that recognize and load saved indexes of a backend.
#[derive(Clone, Copy)]
pub(crate) struct SavedFormat {
    /// Returns whether the file has an index of this backend with the requested directions of k-DOPs.
    pub(crate) is_in: fn(&Reader, Option<KdopDirections>) -> bool,
    pub(crate) load: LoadFn,
    pub(crate) load_shared: LoadSharedFn,
}

/// An entry of [`BACKENDS`](crate::BACKENDS). Two entries are equal if their names are.
pub struct BackendEntry {
    /// The name on the command line, in reports and in saved files.
    pub name: &'static str,
    /// A phrase that describes the backend, for the help of commands and for reports.
    pub summary: &'static str,
    /// The structure that is searched.
    pub structure: SearchStructure,
    /// Whether [`AnyIndex::as_ray_query`](crate::AnyIndex::as_ray_query) returns something.
    pub casts_rays: bool,
    /// Whether a build calls [`BuildSettings::progress`].
    pub reports_progress: bool,
    /// Whether it uses [`BuildSettings::kdop_directions`].
    pub has_kdop_directions: bool,
    /// Whether it uses [`BuildSettings::p2m`].
    pub has_p2m_settings: bool,
    /// The expected cost.
    pub cost: CostModel,
    pub(crate) build: BuildFn<f64>,
    pub(crate) build_f32: BuildFn<f32>,
    pub(crate) saved: Option<SavedFormat>,
}

impl BackendEntry {
    /// Whether indexes of this backend can be saved and loaded.
    #[must_use]
    pub fn is_saveable(&self) -> bool {
        self.saved.is_some()
    }

    /// Whether a saved file has an index of this backend, with these directions if it is a k-DOP tree.
    #[must_use]
    pub fn is_in(&self, reader: &Reader, directions: Option<KdopDirections>) -> bool {
        self.saved.is_some_and(|saved| (saved.is_in)(reader, directions))
    }

    /// Builds an index over a scene.
    ///
    /// # Errors
    /// [`BuildError`] for a scene with coordinates that are not finite, or with too many primitives.
    pub fn build<'a>(&self, soup: &'a Soup<f64>, settings: &BuildSettings<'_>) -> Result<BuiltIndex<'a>, BuildError> {
        (self.build)(soup, settings)
    }

    /// Builds an index over a scene in f32.
    ///
    /// # Errors
    /// [`BuildError`] for a scene with coordinates that are not finite, or with too many primitives.
    pub fn build_f32<'a>(
        &self,
        soup: &'a Soup<f32>,
        settings: &BuildSettings<'_>,
    ) -> Result<BuiltIndex<'a, f32>, BuildError> {
        (self.build_f32)(soup, settings)
    }

    /// Loads the index of a saved file over the scene that it was built over.
    ///
    /// # Errors
    /// [`LoadError`], and always if the file has no index of this backend.
    pub fn load<'a>(&self, soup: &'a Soup<f64>, reader: &Reader) -> Result<BuiltIndex<'a>, LoadError> {
        (self.saved_format(reader)?.load)(soup, reader)
    }

    /// Loads the index of a saved file over the scene that it was built over, which the index shares.
    ///
    /// # Errors
    /// The errors are those of [`load`](Self::load).
    pub fn load_shared(&self, soup: Arc<Soup<f64>>, reader: &Reader) -> Result<BuiltIndex<'static>, LoadError> {
        (self.saved_format(reader)?.load_shared)(soup, reader)
    }

    /// Returns the functions that load indexes of this backend.
    fn saved_format(&self, reader: &Reader) -> Result<SavedFormat, LoadError> {
        match self.saved {
            Some(saved) => Ok(saved),
            None => Err(LoadError::OtherKind { found: storage::kind(reader)?, expected: self.name.to_owned() }),
        }
    }
}

impl PartialEq for BackendEntry {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Eq for BackendEntry {}

impl fmt::Debug for BackendEntry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("BackendEntry").field(&self.name).finish()
    }
}

impl fmt::Display for BackendEntry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name)
    }
}
