//! All results as one HTML page, which needs no other file and no network.
//!
//! The page is a template with a script, and this module puts the results into it as JSON. The script draws the plots
//! and the tables in the browser.

use crate::measure::harness::Provenance;
use crate::measure::tradeoff::curve::SceneFigures;
use crate::measure::tradeoff::settings::{SETTINGS, Setting};
use crate::measure::tradeoff::text;
use p2m_core::kernel::ERROR_CONSTANT;
use p2m_page::template::{STYLE, escape, fill, script_data};
use serde::Serialize;

/// The content of a page.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Page<'a> {
    /// The origin of the figures.
    pub(crate) provenance: &'a Provenance,
    /// Sentences about the amount of work: rounds, queries, seed and duration.
    pub(crate) effort: &'a str,
    /// Sentences about the truth that answers were compared with.
    pub(crate) truth: &'a str,
    /// The time to read the clock, in nanoseconds.
    pub(crate) clock: f64,
    /// The results for each scene. There is at least one, and all scenes have the same sets of queries.
    pub(crate) scenes: &'a [SceneFigures],
    /// The names of backends, and phrases that describe them.
    pub(crate) backends: &'a [(&'a str, &'a str)],
}

/// The value that the script reads.
#[derive(Serialize)]
struct PageData<'a> {
    #[serde(flatten)]
    page: &'a Page<'a>,
    settings: Vec<SettingData>,
    /// The largest error, in u M, that the contract allows: once for the primitive of the answer and once for
    /// the nearest one.
    exact_limit: f64,
}

/// A setting, and the relative error that it guarantees, if it guarantees any.
#[derive(Serialize)]
struct SettingData {
    #[serde(flatten)]
    setting: &'static Setting,
    guarantee: Option<f64>,
}

const TEMPLATE: &str = include_str!("report.html");
const SCRIPT: &str =
    concat!(include_str!("judgement.js"), "\n", include_str!("plot.js"), "\n", include_str!("report.js"));

impl Page<'_> {
    /// Returns the page as HTML.
    ///
    /// # Errors
    /// An error of the conversion to JSON, which all pages that this type can hold are free of.
    pub(crate) fn html(&self) -> serde_json::Result<String> {
        let settings =
            SETTINGS.iter().map(|setting| SettingData { setting, guarantee: setting.promise().relative() }).collect();
        let data = PageData { page: self, settings, exact_limit: 2.0 * ERROR_CONSTANT };
        let sets = self.scenes.iter().flat_map(|scene| scene.sets.iter().map(move |set| (scene, set)));
        let tables: String =
            sets.map(|(scene, set)| format!("{}, {}\n\n{}\n", scene.name, set.name, text::table(set))).collect();
        let texts =
            [("tables", &*escape(&tables)), ("data", &script_data(&data)?), ("script", SCRIPT), ("style", STYLE)];
        Ok(fill(TEMPLATE, &texts))
    }
}

#[cfg(test)]
mod tests;
