//! What building tells of itself.

use std::cell::Cell;

/// A stage of building an interception index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Stage {
    /// The tree over the packets
    Tree,
    /// The Delaunay tetrahedra of the sites
    Delaunay,
    /// The packets that meet their circumscribed balls
    Balls,
    /// The lists of the cells
    Lists,
    /// What locates a query
    Locator,
    /// The cells of an octree with their lists
    Octree,
}

impl Stage {
    /// A word for it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Tree => "tree",
            Self::Delaunay => "delaunay",
            Self::Balls => "balls",
            Self::Lists => "lists",
            Self::Locator => "locator",
            Self::Octree => "octree",
        }
    }
}

/// How far building is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// What is being done.
    pub stage: Stage,
    /// The part of all stages that is done, from 0 to 1: an estimate that never falls.
    pub part: f64,
}

/// Tells somebody, from one thread.
pub(super) struct Teller<'a> {
    tell: &'a (dyn Fn(Progress) + Sync),
    at: Cell<Progress>,
}

impl<'a> Teller<'a> {
    /// The first stage begins.
    pub(super) fn new(tell: &'a (dyn Fn(Progress) + Sync), stage: Stage) -> Self {
        let at = Progress { stage, part: 0.0 };
        tell(at);
        Self { tell, at: Cell::new(at) }
    }

    /// Another stage begins.
    pub(super) fn begin(&self, stage: Stage) {
        self.at.set(Progress { stage, ..self.at.get() });
        (self.tell)(self.at.get());
    }

    /// The stage has come so far in its share of the whole, in percent.
    pub(super) fn reach(&self, [from, to]: [f64; 2], done: usize, all: usize) {
        let part = (from + (to - from) * done as f64 / all as f64).floor() / 100.0;
        if part > self.at.get().part {
            self.at.set(Progress { part, ..self.at.get() });
            (self.tell)(self.at.get());
        }
    }
}
