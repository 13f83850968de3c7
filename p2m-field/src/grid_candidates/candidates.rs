//! The candidates of one box.

use super::error_bounds::MAX_COORDINATE;
use super::groups::EntryId;
use p2m_core::Aabb;

/// The primitives that can be nearest to a point of a box, some of them as groups.
#[derive(Clone, Debug)]
pub struct Candidates {
    pub(crate) entries: Vec<EntryId>,
    pub(crate) nearest: f64,
    /// An upper bound on the distance of a point of the box from a vertex of a candidate.
    pub(crate) reach: f64,
    /// The box, or `None` if these are the candidates of any box.
    pub(crate) bounds: Option<Aabb<f64>>,
}

/// Whether groups of candidates are resolved into primitives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Detail {
    /// Groups that are small beside the box stay together. This is for boxes that will be narrowed further.
    Groups,
    /// Every group is resolved into primitives.
    Primitives,
}

impl Candidates {
    /// Returns the number of primitives and groups.
    #[must_use]
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Returns whether there are no candidates, which is the case only for an empty set.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// Returns a lower bound on the distance of the scene from all points of the box, or 0 if none is known.
    #[must_use]
    pub fn nearest(&self) -> f64 {
        self.nearest
    }

    /// Returns whether a box is contained in the box of the candidates and within the range of lists.
    pub(crate) fn covers(&self, part: &Aabb<f64>) -> bool {
        let is_in_range = part.min.iter().chain(part.max.iter()).all(|x| x.abs() <= MAX_COORDINATE);
        !part.is_empty() && is_in_range && self.bounds.is_none_or(|bounds| bounds.contains(part))
    }
}
