//! An entry of the registry of backends.

use super::IndexKind;
use super::cost::Cost;
use std::fmt;

/// The structure that a backend searches, as far as it determines how costs grow with the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SearchStructure {
    /// Every query examines every primitive.
    Exhaustive,
    /// A tree of bounding volumes over the primitives.
    Tree,
    /// Cells of space, each with a list of the primitives near it, or of the primitives that can be nearest in it.
    SpaceCells,
    /// Cells of vertices with lists of the primitives that can be nearest in them.
    VertexCells,
}

impl SearchStructure {
    /// Returns whether the structure consists of cells with lists.
    #[must_use]
    pub const fn has_cells(self) -> bool {
        matches!(self, Self::SpaceCells | Self::VertexCells)
    }
}

/// An entry of [`BACKENDS`](crate::BACKENDS). Two entries are equal if their names are.
pub struct BackendEntry {
    /// The name on the command line, in reports and in saved files.
    pub name: &'static str,
    /// A phrase that describes the backend, for the help of commands and for reports.
    pub summary: &'static str,
    /// The structure that is searched.
    pub structure: SearchStructure,
    /// The feature of the crate `p2m` that has the type of the index, unless every build has it.
    pub feature: Option<&'static str>,
    /// Whether [`AnyIndex::as_ray_query`](crate::AnyIndex::as_ray_query) returns something.
    pub casts_rays: bool,
    /// Whether [`AnyIndex::as_pair_query`](crate::AnyIndex::as_pair_query) returns something.
    pub answers_pairs: bool,
    /// Whether [`AnyIndex::refitted`](crate::AnyIndex::refitted) returns something.
    pub has_refit: bool,
    /// Whether a build calls [`BuildSettings::progress`](crate::BuildSettings::progress).
    pub reports_progress: bool,
    /// Whether it uses [`BuildSettings::kdop_directions`](crate::BuildSettings::kdop_directions).
    pub has_kdop_directions: bool,
    /// Whether it uses [`BuildSettings::resolution`](crate::BuildSettings::resolution).
    pub has_resolution: bool,
    /// Whether it uses [`BuildSettings::p2m`](crate::BuildSettings::p2m).
    pub has_p2m_settings: bool,
    /// The expected costs: those with the default settings first, then those with finer cells.
    pub costs: &'static [Cost],
    /// The same for scenes of slivers that boxes fit badly; empty if they are the same.
    pub sliver_costs: &'static [Cost],
    pub(crate) kind: IndexKind,
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
