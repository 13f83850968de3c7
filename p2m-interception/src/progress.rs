//! What building tells of itself.

use std::cell::Cell;
use std::sync::Mutex;
use std::time::Duration;

/// A stage of building an interception index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum BuildStage {
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

impl BuildStage {
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
    pub stage: BuildStage,
    /// The part of all stages that is done, from 0 to 1: an estimate that never falls.
    pub part: f64,
}

/// Tells somebody, from one thread.
pub(crate) struct ProgressReporter<'a> {
    tell: &'a (dyn Fn(Progress) + Sync),
    at: Cell<Progress>,
}

impl<'a> ProgressReporter<'a> {
    /// The first stage begins.
    pub(crate) fn new(tell: &'a (dyn Fn(Progress) + Sync), stage: BuildStage) -> Self {
        let at = Progress { stage, part: 0.0 };
        tell(at);
        Self { tell, at: Cell::new(at) }
    }

    /// Another stage begins.
    pub(crate) fn begin_stage(&self, stage: BuildStage) {
        self.at.set(Progress { stage, ..self.at.get() });
        (self.tell)(self.at.get());
    }

    /// The stage has come so far in its share of the whole, in percent.
    pub(crate) fn advance(&self, [from, to]: [f64; 2], done: usize, all: usize) {
        let part = (from + (to - from) * done as f64 / all as f64).floor() / 100.0;
        if part > self.at.get().part {
            self.at.set(Progress { part, ..self.at.get() });
            (self.tell)(self.at.get());
        }
    }
}

/// Sums the times of the stages of a build: give [`tell`](Self::tell) what is told of progress.
///
/// ```
/// use nalgebra::Point3;
/// use p2m_core::Segment;
/// use p2m_interception::{Partition, BuildStage, StageTimes, Voronoi};
/// use std::time::Instant;
///
/// let wires = [Segment::new(Point3::new(0.0, 0.0, 0.0), Point3::new(4.0, 1.0, 2.0))];
/// let start = Instant::now();
/// let times = StageTimes::new(move || start.elapsed());
/// let cells: Voronoi = Partition::build(&wires, &Default::default(), &|progress| times.tell(progress));
/// assert!(times.finish().iter().any(|(stage, _)| *stage == BuildStage::Tree));
/// # drop(cells);
/// ```
pub struct StageTimes<C> {
    /// The time since some moment.
    clock: C,
    recorded: Mutex<RecordedTimes>,
}

#[derive(Default)]
struct RecordedTimes {
    times: Vec<(BuildStage, Duration)>,
    /// The stage that is being done, and when it began.
    current: Option<(BuildStage, Duration)>,
}

impl<C: Fn() -> Duration> StageTimes<C> {
    /// With a clock that tells the time since some moment, the same one each time.
    pub fn new(clock: C) -> Self {
        Self { clock, recorded: Mutex::default() }
    }

    /// Ends one stage and begins another, if that is what is told. The clock is asked only then.
    ///
    /// # Panics
    /// If the clock panicked.
    pub fn tell(&self, progress: Progress) {
        let mut recorded = self.recorded.lock().expect("a clock that did not panic");
        if recorded.current.is_none_or(|(stage, _)| stage != progress.stage) {
            let now = (self.clock)();
            recorded.end(now);
            recorded.current = Some((progress.stage, now));
        }
    }

    /// The time of each stage, in the order in which they began for the first time; of one that came several times the
    /// sum.
    ///
    /// # Panics
    /// If the clock panicked.
    pub fn finish(self) -> Vec<(BuildStage, Duration)> {
        let mut recorded = self.recorded.into_inner().expect("a clock that did not panic");
        recorded.end((self.clock)());
        recorded.times
    }
}

impl RecordedTimes {
    fn end(&mut self, now: Duration) {
        let Some((stage, began)) = self.current.take() else { return };
        let time = now.saturating_sub(began);
        match self.times.iter_mut().find(|(known, _)| *known == stage) {
            Some((_, sum)) => *sum += time,
            None => self.times.push((stage, time)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stage_lasts_until_another_begins_and_may_come_again() {
        let now = std::cell::Cell::new(0);
        let times = StageTimes::new(|| Duration::from_secs(now.get()));
        for (time, stage) in
            [(1, BuildStage::Tree), (3, BuildStage::Delaunay), (4, BuildStage::Balls), (4, BuildStage::Balls)]
        {
            now.set(time);
            times.tell(Progress { stage, part: 0.0 });
        }
        for (time, stage) in [(9, BuildStage::Delaunay), (11, BuildStage::Lists)] {
            now.set(time);
            times.tell(Progress { stage, part: 0.5 });
        }
        now.set(20);
        let expected =
            [(BuildStage::Tree, 2), (BuildStage::Delaunay, 3), (BuildStage::Balls, 5), (BuildStage::Lists, 9)];
        assert_eq!(times.finish(), expected.map(|(stage, time)| (stage, Duration::from_secs(time))));
        assert!(StageTimes::new(|| Duration::ZERO).finish().is_empty());
    }
}
