//! Draws Figures 10 to 17 and 20 to 22 from the measurements.

use super::scenes::stem;
use super::study::Study;
use crate::plot::{Bars, Mark, Plot, Series};
use anyhow::Result;
use std::path::Path;

/// The backends of the plots, in the order of their colours.
pub(super) const COMPARED: [&str; 5] = ["p2m", "aabb", "parry3d", "parry3d-f64", "octree"];
/// The colour of cited values.
const CITED: usize = 6;
const FACES: &str = "primitives";

/// The figures that the paper \[Zong2023\] gives for its Dragon, measured on its own machine and with its own
/// libraries.
mod cited {
    /// The number of faces.
    pub(super) const DRAGON: f64 = 1_499_852.0;
    /// Seconds that the P2M index takes to build.
    pub(super) const BUILD: f64 = 137.4;
    /// Seconds that the trees of PQP and FCPW take to build.
    pub(super) const BUILD_OF_OTHERS: [f64; 2] = [4.0, 1.9];
    /// Microseconds to locate the Voronoi cell of a query, by Section 5.3.
    pub(super) const LOCATE: f64 = 2.83;
    /// Microseconds of a query in all, by Section 5.3.
    pub(super) const QUERY: f64 = 2.83 + 0.39;
    /// Bytes of the index.
    pub(super) const BYTES: f64 = 1.78e9;
    /// The mean and the maximum length of lists, where edges and faces count as one.
    pub(super) const LISTS: [f64; 2] = [41.0, 782.0];
}

fn series(name: &str, mark: Mark, colour: usize, points: impl Iterator<Item = (f64, f64)>) -> Series {
    Series { name: name.to_owned(), mark, colour, points: points.collect() }
}

/// Returns a value of each study over its size.
fn over_size<'a>(
    studies: &'a [&Study],
    value: impl Fn(&Study) -> Option<f64> + 'a,
) -> impl Iterator<Item = (f64, f64)> + 'a {
    studies.iter().filter_map(move |study| Some((study.primitives as f64, value(study)?)))
}

fn cited_at(name: &str, value: f64) -> Series {
    series(&format!("{name} (cited)"), Mark::Cross, CITED, std::iter::once((cited::DRAGON, value)))
}

/// Returns a mean and a maximum over sizes.
fn mean_and_most(
    studies: &[&Study],
    y: &'static str,
    mean: impl Fn(&Study) -> Option<f64>,
    most: impl Fn(&Study) -> Option<f64>,
) -> Plot {
    let series = vec![
        series("mean", Mark::Line, 0, over_size(studies, mean)),
        series("most", Mark::Dashes, 1, over_size(studies, most)),
    ];
    Plot { x: FACES, y, series }
}

/// Returns a value of each backend over sizes.
fn compared(
    studies: &[&Study],
    mark: Mark,
    y: &'static str,
    value: impl Fn(&Study, &str) -> Option<f64> + Copy,
) -> Plot {
    let all = COMPARED.iter().enumerate();
    let series = all.map(|(i, name)| series(name, mark, i, over_size(studies, move |study| value(study, name))));
    let series = series.filter(|series| !series.points.is_empty()).collect();
    Plot { x: FACES, y, series }
}

fn build(study: &Study, name: &str) -> Option<f64> {
    study.backend(name)?.build
}

fn microseconds(study: &Study, name: &str) -> Option<f64> {
    Some(study.query(name)? / 1e3)
}

/// The studies that the plots show.
pub(super) struct Figures<'a> {
    /// The model that is swept, in increasing size.
    pub(super) sweep: &'a [&'a Study],
    /// The five models of the tables.
    pub(super) five: &'a [&'a Study],
    /// The one of the five models that has boxes and threads.
    pub(super) dragon: &'a Study,
    pub(super) boxes: &'a [f64],
    pub(super) threads: &'a [usize],
    /// The studies of all models.
    pub(super) scattered: &'a [&'a Study],
}

impl Figures<'_> {
    /// Writes all figures into a folder, as fig10.svg and so on.
    pub(super) fn write(&self, folder: &Path) -> Result<()> {
        let to = |name: &str| folder.join(format!("{name}.svg"));
        let sweep = self.sweep;
        let lists = |value: fn(&p2m_core::ListStats) -> f64| move |s: &Study| s.inside.lists.as_ref().map(value);
        let mut lists =
            mean_and_most(sweep, "primitives of a list", lists(|lists| lists.mean), lists(|lists| lists.max as f64));
        lists.series.extend(["mean", "most"].into_iter().zip(cited::LISTS).map(|(name, value)| cited_at(name, value)));
        lists.write(&to("fig10"))?;

        let mut stages = compared(sweep, Mark::Line, "seconds to build", build);
        let cited = [("P2M", cited::BUILD), ("PQP", cited::BUILD_OF_OTHERS[0]), ("FCPW", cited::BUILD_OF_OTHERS[1])];
        stages.series.extend(cited.map(|(name, seconds)| cited_at(name, seconds)));
        stages.write(&to("fig11"))?;

        mean_and_most(
            sweep,
            "packets looked at for a list",
            |s| {
                let report = &s.inside.report;
                Some(report.candidates as f64 / (report.list_cells + report.fallback_cells).max(1) as f64)
            },
            |s| Some(s.inside.report.max_candidates as f64),
        )
        .write(&to("fig12"))?;

        // The rest is a difference of medians, so it may be negative for very short lists.
        let bar = |study: &&Study| {
            let super::study::Breakdown { locate, total } = study.inside.breakdown;
            (stem(&study.name).to_owned(), vec![locate, (total - locate).max(0.0)])
        };
        let cited = vec![cited::LOCATE * 1e3, (cited::QUERY - cited::LOCATE) * 1e3];
        let bars = self.five.iter().map(bar).chain([("the paper's Dragon (cited)".to_owned(), cited)]).collect();
        Bars { x: "nanoseconds of a query", parts: vec!["locate the cell", "the rest: its list"], bars }
            .write(&to("fig13"))?;

        let mut queries = compared(sweep, Mark::Line, "microseconds of a query", microseconds);
        queries.series.push(cited_at("P2M", cited::QUERY));
        queries.write(&to("fig14"))?;

        mean_and_most(
            sweep,
            "sites on the way to the cell, and nodes",
            |s| Some(s.inside.visits.nodes.mean),
            |s| Some(s.inside.visits.nodes.max as f64),
        )
        .write(&to("fig15"))?;

        self.over(self.boxes, "side of the box of queries / side of that of the scene", |m| &m.boxes)
            .write(&to("fig16"))?;
        let threads: Vec<f64> = self.threads.iter().map(|count| *count as f64).collect();
        self.over(&threads, "threads", |measured| &measured.threads).write(&to("fig17"))?;

        let scattered = self.scattered;
        compared(scattered, Mark::Dot, "seconds to build", build).write(&to("fig20"))?;
        compared(scattered, Mark::Dot, "microseconds of a query", microseconds).write(&to("fig21"))?;
        let bytes = |study: &Study, name: &str| Some(study.backend(name)?.bytes as f64 / 1e6);
        let mut memory = compared(scattered, Mark::Dot, "megabytes, scene included", bytes);
        memory.series.push(cited_at("P2M", cited::BYTES / 1e6));
        memory.write(&to("fig22"))
    }

    /// Returns a value of each backend for the large model over a parameter other than its size.
    fn over(
        &self,
        at: &[f64],
        x: &'static str,
        times: impl Fn(&super::study::Measured) -> &Vec<Option<f64>> + Copy,
    ) -> Plot {
        let all = COMPARED.iter().enumerate().filter_map(|(i, name)| {
            let times = times(self.dragon.backend(name)?);
            let points = at.iter().zip(times).filter_map(|(x, time)| Some((*x, time.as_ref()? / 1e3)));
            Some(series(name, Mark::Line, i, points))
        });
        Plot { x, y: "microseconds of a query", series: all.collect() }
    }
}
