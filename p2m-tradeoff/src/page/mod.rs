//! All results as one HTML page, which needs no other file, no network and no script.

mod html;
mod plots;
mod scene;
mod verdict;

use crate::curve::SceneFigures;
use crate::error::PlotError;
use crate::plot::{Mark, Plot, Series};
use crate::provenance::Provenance;
use crate::settings::SETTINGS;
use crate::text::error;
use html::Html;
use plots::{Colours, Unit};

/// A quantity of each backend as a function of another quantity. It becomes a plot and a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// The heading of its section.
    pub title: String,
    /// A sentence about the measurement.
    pub about: String,
    /// The names of the given and of the measured quantity.
    pub axes: [&'static str; 2],
    /// The names of backends, and their points.
    pub lines: Vec<(String, Vec<(f64, f64)>)>,
}

/// The content of a page.
#[derive(Clone, Copy, Debug)]
pub struct Page<'a> {
    /// The origin of the figures.
    pub provenance: &'a Provenance,
    /// Sentences about the amount of work: rounds, queries, seed and duration.
    pub effort: &'a str,
    /// Sentences about the truth that answers were compared with.
    pub truth: &'a str,
    /// The time to read the clock, in nanoseconds.
    pub clock: f64,
    /// The results for each scene.
    pub scenes: &'a [SceneFigures],
    /// The results that depend on another quantity.
    pub sweeps: &'a [Sweep],
    /// The names of backends, and phrases that describe them.
    pub backends: &'a [(&'a str, &'a str)],
}

const STYLE: &str = include_str!("style.css");

impl Page<'_> {
    /// Returns the page as HTML.
    ///
    /// # Errors
    /// [`PlotError::Draw`]
    pub fn html(&self) -> Result<String, PlotError> {
        let colours = self.colours();
        let mut html = Html::default();
        html.raw("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n");
        html.raw("<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n");
        html.text("title", "Closest points: speed against accuracy");
        html.within("style", "", |html| html.raw(STYLE));
        html.raw("</head>\n<body>\n");
        html.text("h1", "Closest points: speed against accuracy");
        self.write_head(&mut html);
        self.write_verdict(&mut html);
        self.write_contents(&mut html);
        self.write_compared(&mut html);
        self.write_reading(&mut html);
        for scene in self.scenes {
            scene::write(&mut html, scene, &colours)?;
        }
        self.write_sweeps(&mut html, &colours)?;
        html.raw("</body>\n</html>\n");
        Ok(html.finish())
    }

    /// Returns the plots of speed over the largest relative error and those of sweeps, with names for their files.
    ///
    /// # Errors
    /// [`PlotError::Draw`]
    pub fn plots(&self) -> Result<Vec<(String, String)>, PlotError> {
        let colours = self.colours();
        let mut plots = Vec::new();
        for scene in self.scenes {
            for set in &scene.sets {
                match plots::pareto(set, &colours, Unit::Relative, |worst| worst.max).svg() {
                    Err(PlotError::Empty) => {}
                    svg => plots.push((file_name(&format!("{} {}", stem(&scene.name), set.name)), svg?)),
                }
            }
        }
        for sweep in self.sweeps {
            plots.push((file_name(&sweep.title), sweep_plot(sweep, &colours).svg()?));
        }
        Ok(plots)
    }

    /// Assigns colours to backends, in the order of their first appearance.
    fn colours(&self) -> Colours {
        let mut names: Vec<String> = Vec::new();
        let curves = self.scenes.iter().flat_map(|scene| scene.sets.iter().flat_map(|set| &set.curves));
        for name in curves.map(|curve| &curve.name) {
            if !names.contains(name) {
                names.push(name.clone());
            }
        }
        Colours(names)
    }

    fn write_head(&self, html: &mut Html) {
        html.paragraph(
            "Which point of a scene of triangles, segments and points is closest to a query point? Several backends compute it, \
             and each has settings that trade accuracy for speed. This page shows the measured time and the measured errors of \
             each, so that one can be chosen.",
        );
        html.within("div", "class=\"machine\"", |html| {
            html.paragraph(&format!(
                "Measured on {} by `{}`: {}.",
                self.provenance.date,
                self.provenance.command,
                self.provenance.machine()
            ));
            html.paragraph(self.effort);
        });
    }

    /// Writes links to the scenes.
    fn write_contents(&self, html: &mut Html) {
        html.within("nav", "", |html| {
            html.words("The scenes in detail: ");
            for (i, scene) in self.scenes.iter().enumerate() {
                html.words(if i > 0 { ", " } else { "" });
                html.within("a", &format!("href=\"#{}\"", scene::anchor(&scene.name)), |html| html.words(&scene.name));
            }
            html.words(".");
        });
    }

    fn write_compared(&self, html: &mut Html) {
        html.text("h2", "What was compared");
        html.text("h3", "Backends");
        html.terms(self.backends.iter().copied());
        html.text("h3", "Settings");
        html.terms(SETTINGS.iter().map(|setting| (setting.name, setting.about)));
    }

    fn write_verdict(&self, html: &mut Html) {
        html.text("h2", "In short");
        html.paragraph(
            "The table has the fastest backend and setting for each scene and set of queries. The first of these columns \
             requires the default setting with no error but rounding (16 u M at most). The next two allow a largest error of \
             1 % and of 10 % of the distance, and a setting counts only if it is faster beyond noise. The last three columns \
             have the backend that takes the least total time, with the build, without errors but rounding. All times are for \
             one thread. The names are explained below.",
        );
        html.within("div", "class=\"words\"", |html| html.table(&verdict::head(), 2, &verdict::rows(self.scenes)));
        let promised =
            self.scenes.iter().flat_map(|s| s.sets.iter().flat_map(|set| set.curves.iter().flat_map(|c| &c.points)));
        let (mut answers, mut broken) = (0, 0);
        for point in promised {
            answers += point.errors.compared;
            broken += point.errors.broken;
        }
        html.paragraph(&format!(
            "{broken} of {answers} answers have a larger error than their setting promises (other libraries and limits of visits promise nothing but lower bounds)."
        ));
    }

    fn write_reading(&self, html: &mut Html) {
        html.text("h2", "How to read it");
        let clock = format!(
            "Each query is timed on its own by the wall clock. Reading the clock takes {:.0} ns here, as measured, and is \
             included in each figure. The largest times show other activity of the machine.",
            self.clock
        );
        let truth = format!("Errors are those of the distance. {}", self.truth);
        html.terms([
            (
                "A point in a plot",
                "A point shows one setting of one backend: the time of a query (the median of the rounds) and the error (the \
                 largest one, or the one that one query in a thousand exceeds). A line connects the settings of one backend \
                 from the most accurate one on. Dots beside it are settings that are both slower and less accurate than another \
                 one. A point below and to the left of another is better in both. The name of a point appears under the mouse.",
            ),
            ("exact", "Errors of 0 lie at the left end of an axis, because a logarithmic axis has no position for them."),
            (
                "Time",
                "Times are thread CPU times of one thread, for one query at a time, with backends taking turns. The minimum and \
                 the maximum of the rounds are in brackets. Slow backends get fewer queries, which the remarks state. Backends \
                 that are more than 30 times slower than the fastest one are in the tables only.",
            ),
            ("Errors", &truth),
            (
                "u M",
                "This is the unit of rounding errors: u = 2^-53, and M is the largest distance from the query to a vertex of the \
                 nearest primitive. An error of 8 u M in a scene of one metre is less than 1e-15 metres.",
            ),
            (
                "Relative errors",
                "They are relative to the true distance. Queries on the surface itself have distances that consist of rounding \
                 errors (or are 0, and left out); their errors in u M are meaningful.",
            ),
            (
                "Bound gap",
                "Each answer of a p2m backend has a certified lower bound of the true distance. The gap is the largest \
                 difference between a distance and its lower bound, relative to the distance.",
            ),
            (
                "Other primitive",
                "This is the number of answers with another primitive than the nearest one. Among equally near primitives the \
                 one with the lowest id is right. Other libraries do not return it.",
            ),
            (
                "Remarks",
                "They state failures of answers. `no faster` means that some rounds were not faster than all rounds of the \
                 default setting of the same backend.",
            ),
            ("The time of single queries", &clock),
            (
                "The number of queries from which on a longer build pays",
                "It is the additional time to build divided by the time that each query saves. The row is the present backend, \
                 and the column the one that replaces it. `never` means that its queries are slower, and `always` that neither \
                 its build nor its queries are slower.",
            ),
        ]);
    }

    fn write_sweeps(&self, html: &mut Html, colours: &Colours) -> Result<(), PlotError> {
        if self.sweeps.is_empty() {
            return Ok(());
        }
        html.text("h2", "With size and with threads");
        for sweep in self.sweeps {
            html.text("h3", &sweep.title);
            html.paragraph(&sweep.about);
            let svg = sweep_plot(sweep, colours).svg()?;
            html.within("div", "class=\"figures\"", |html| {
                html.figure(&svg, &format!("{} over {}", sweep.axes[1], sweep.axes[0]))
            });
            let (head, rows) = sweep_table(sweep);
            html.table(&head.iter().map(String::as_str).collect::<Vec<_>>(), 1, &rows);
        }
        Ok(())
    }
}

fn sweep_plot(sweep: &Sweep, colours: &Colours) -> Plot {
    let series =
        sweep.lines.iter().map(|(name, points)| Series { mark: Mark::Line, ..colours.line(name, points.clone()) });
    Plot {
        x: sweep.axes[0],
        y: sweep.axes[1],
        series: series.collect(),
        size: plots::SIZE,
        legend: plots::LEGEND_WIDTH,
        ..Plot::default()
    }
}

/// A column for each backend, a row for each given value.
fn sweep_table(sweep: &Sweep) -> (Vec<String>, Vec<Vec<String>>) {
    let mut given: Vec<f64> = sweep.lines.iter().flat_map(|(_, points)| points.iter().map(|p| p.0)).collect();
    given.sort_by(f64::total_cmp);
    given.dedup();
    let head = std::iter::once(sweep.axes[0].to_owned()).chain(sweep.lines.iter().map(|(name, _)| name.clone()));
    let rows = given.iter().map(|x| {
        let value = |points: &[(f64, f64)]| {
            points.iter().find(|p| p.0.total_cmp(x).is_eq()).map_or("-".to_owned(), |p| figure(p.1))
        };
        std::iter::once(format!("{x}")).chain(sweep.lines.iter().map(|(_, points)| value(points))).collect()
    });
    (head.collect(), rows.collect())
}

/// Formats a number with about three digits.
fn figure(value: f64) -> String {
    match value {
        x if x >= 100.0 => format!("{x:.0}"),
        x if x >= 10.0 => format!("{x:.1}"),
        x if x >= 0.01 => format!("{x:.3}"),
        x => error(x),
    }
}

/// Returns a name without its extension.
fn stem(name: &str) -> &str {
    name.rsplit_once('.').map_or(name, |(stem, _)| stem)
}

/// Returns a name that every file system accepts.
fn file_name(text: &str) -> String {
    let kept = |c: char| if c.is_ascii_alphanumeric() || c == '.' { c.to_ascii_lowercase() } else { '-' };
    format!("{}.svg", text.chars().map(kept).collect::<String>())
}

#[cfg(test)]
mod tests;
