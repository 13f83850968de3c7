//! The settings of a P2M index that a build by name accepts: its locator and the filter of its long lists.

#[cfg(feature = "paper")]
use p2m_interception::KdTreeLocator;
use p2m_interception::P2mOptions;
#[cfg(feature = "paper")]
use p2m_interception::RegionTree;

/// The structure by which a P2M index finds a site near a query. Answers do not depend on it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum LocatorKind {
    /// A grid. This is the fastest, and the only kind that can be saved.
    #[default]
    Grid,
    /// The KD-tree of the crate kiddo, as in the paper. Queries take up to three times as long.
    #[cfg(feature = "paper")]
    KdTree,
}

/// The structure by which a P2M index searches lists of more than 64 primitives. Answers do not depend on it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum ListFilterKind {
    /// Lists in the order of the lower bounds on their packets. This is the fastest, and the only kind that can be
    /// saved.
    #[default]
    Sorted,
    /// An R-tree of the crate rstar for each list, as in the paper. Queries take up to ten times as long where lists
    /// are long.
    #[cfg(feature = "paper")]
    RTree,
}

/// The settings that only a P2M index has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct P2mSettings {
    /// The kind of the locator.
    pub locator: LocatorKind,
    /// The kind of the filter of long lists.
    pub list_filter: ListFilterKind,
}

impl P2mSettings {
    /// Sets the locator.
    #[must_use]
    pub fn with_locator(self, locator: LocatorKind) -> Self {
        Self { locator, ..self }
    }

    /// Sets the filter of long lists.
    #[must_use]
    pub fn with_list_filter(self, list_filter: ListFilterKind) -> Self {
        Self { list_filter, ..self }
    }

    /// Returns the options of an index with these settings.
    pub(crate) fn options(self) -> P2mOptions {
        let options = match self.locator {
            LocatorKind::Grid => P2mOptions::default(),
            #[cfg(feature = "paper")]
            LocatorKind::KdTree => P2mOptions::default().with_locator(KdTreeLocator::build),
        };
        match self.list_filter {
            ListFilterKind::Sorted => options,
            #[cfg(feature = "paper")]
            ListFilterKind::RTree => options.with_list_filter(RegionTree::build),
        }
    }
}
