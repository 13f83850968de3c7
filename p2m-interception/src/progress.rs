//! The progress of a build: the stages, a reporter, and a collector of their times.

use std::cell::Cell;
use std::sync::Mutex;
use std::time::Duration;

/// A stage of building an interception index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum BuildStage {
    /// The tree over the packets is built.
    Tree,
    /// The sites are triangulated into Delaunay tetrahedra.
    Delaunay,
    /// The packets that intersect the circumscribed balls of the tetrahedra are collected.
    Balls,
    /// The lists of the cells are built.
    Lists,
    /// The locator is built.
    Locator,
    /// The cells of an octree are built with their lists.
    Octree,
}

impl BuildStage {
    /// Returns the name of the stage, in lower case.
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

/// The progress of a build.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// The current stage.
    pub stage: BuildStage,
    /// The finished fraction of all stages, from 0 to 1. It is an estimate that never decreases.
    pub part: f64,
}

/// Reports the progress of a build from the building thread.
pub(crate) struct ProgressReporter<'a> {
    /// The function that receives the progress.
    report: &'a (dyn Fn(Progress) + Sync),
    /// The progress that was reported last.
    last: Cell<Progress>,
}

impl<'a> ProgressReporter<'a> {
    /// Begins the first stage.
    pub(crate) fn new(report: &'a (dyn Fn(Progress) + Sync), stage: BuildStage) -> Self {
        let last = Progress { stage, part: 0.0 };
        report(last);
        Self { report, last: Cell::new(last) }
    }

    /// Begins another stage.
    pub(crate) fn begin_stage(&self, stage: BuildStage) {
        self.last.set(Progress { stage, ..self.last.get() });
        (self.report)(self.last.get());
    }

    /// Reports that `done` of `all` steps are finished. The steps cover the given range of the whole build, in
    /// percent. Only whole percents that exceed the last report are reported.
    pub(crate) fn advance(&self, [from, to]: [f64; 2], done: usize, all: usize) {
        let part = (from + (to - from) * done as f64 / all as f64).floor() / 100.0;
        if part > self.last.get().part {
            self.last.set(Progress { part, ..self.last.get() });
            (self.report)(self.last.get());
        }
    }
}

/// A collector of the times of the stages of a build. Its method [`tell`](Self::tell) takes each report of progress.
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
    /// The clock returns the time since a fixed moment.
    clock: C,
    /// The times so far.
    recorded: Mutex<RecordedTimes>,
}

/// The times that have been recorded.
#[derive(Default)]
struct RecordedTimes {
    /// The time of each finished stage.
    times: Vec<(BuildStage, Duration)>,
    /// The current stage, and when it began.
    current: Option<(BuildStage, Duration)>,
}

impl<C: Fn() -> Duration> StageTimes<C> {
    /// Makes an empty sum. `clock` has to return the time since a fixed moment.
    pub fn new(clock: C) -> Self {
        Self { clock, recorded: Mutex::default() }
    }

    /// Ends the current stage and begins another one if `progress` says so. The clock is read only then.
    ///
    /// # Panics
    ///
    /// It panics if the clock panicked before.
    pub fn tell(&self, progress: Progress) {
        let mut recorded = self.recorded.lock().expect("a clock that did not panic");
        if recorded.current.is_none_or(|(stage, _)| stage != progress.stage) {
            let now = (self.clock)();
            recorded.end(now);
            recorded.current = Some((progress.stage, now));
        }
    }

    /// Returns the time of each stage, in the order in which the stages began for the first time. A stage that began
    /// several times has the sum of its times.
    ///
    /// # Panics
    ///
    /// It panics if the clock panicked before.
    pub fn finish(self) -> Vec<(BuildStage, Duration)> {
        let mut recorded = self.recorded.into_inner().expect("a clock that did not panic");
        recorded.end((self.clock)());
        recorded.times
    }
}

impl RecordedTimes {
    /// Ends the current stage at a time.
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
