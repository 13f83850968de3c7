//! The section of a scene.

use super::html::Html;
use super::plots::{Colours, Unit, latencies, pareto, totals};
use crate::break_even::{break_even, cheapest, default_costs};
use crate::curve::{Curve, Point, SceneFigures, SetFigures};
use crate::error::PlotError;
use crate::text::{bytes, count, error, failures, seconds, speedup};

/// Writes the section.
pub(super) fn write(html: &mut Html, scene: &SceneFigures, colours: &Colours) -> Result<(), PlotError> {
    html.within("h2", &format!("id=\"{}\"", anchor(&scene.name)), |html| html.words(&scene.name));
    html.paragraph(&scene.about);
    html.text("h3", "Building");
    html.paragraph(
        "The table has the seconds on one thread, and the heap bytes for each primitive besides the scene. A setting has a \
         line if it has an index of its own.",
    );
    html.table(&["backend", "setting", "seconds", "bytes per primitive"], 2, &build_rows(scene));
    for note in &scene.notes {
        html.paragraph(note);
    }
    scene.sets.iter().try_for_each(|set| write_set(html, set, colours))
}

/// Returns the anchor of the heading of a scene.
pub(super) fn anchor(name: &str) -> String {
    name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect()
}

/// Returns a row for each index. Settings that share an index have one row.
fn build_rows(scene: &SceneFigures) -> Vec<Vec<String>> {
    let Some(set) = scene.sets.first() else { return Vec::new() };
    let mut rows = Vec::new();
    for curve in &set.curves {
        let mut known = None;
        for point in &curve.points {
            if known != Some(point.build) {
                let build = point.build;
                rows.push(vec![
                    curve.name.clone(),
                    point.setting.clone(),
                    seconds(build.seconds),
                    bytes(build.bytes_each),
                ]);
            }
            known = Some(point.build);
        }
    }
    rows
}

fn write_set(html: &mut Html, set: &SetFigures, colours: &Colours) -> Result<(), PlotError> {
    html.text("h3", &format!("Queries: {}", set.name));
    html.paragraph(&set.about);
    let plots = [
        (
            pareto(set, colours, Unit::Relative, |worst| worst.max),
            "Speed and the largest relative error. Lower is faster, further left is more accurate.",
        ),
        (
            pareto(set, colours, Unit::Relative, |worst| worst.p999),
            "Speed and the relative error that one query in a thousand exceeds.",
        ),
        (pareto(set, colours, Unit::Scaled, |worst| worst.max), "Speed and the largest error in units of u M."),
        (
            pareto(set, colours, Unit::Scaled, |worst| worst.p999),
            "Speed and the error in units of u M that one query in a thousand exceeds.",
        ),
        (
            latencies(set, colours),
            "The times of single queries with the default settings: the further to the right, the rarer.",
        ),
        (
            totals(set, colours),
            "The total time of building and querying: the lowest line is the cheapest for a number of queries.",
        ),
    ];
    let drawn = plots.into_iter().filter_map(|(plot, caption)| match plot.svg() {
        // Without a query away from the scene there is no relative error.
        Err(PlotError::Empty) => None,
        svg => Some(svg.map(|svg| (svg, caption))),
    });
    let drawn = drawn.collect::<Result<Vec<_>, PlotError>>()?;
    let far = super::plots::drawn(set).1;
    if !far.is_empty() {
        html.paragraph(&format!("These backends are too slow to be drawn: {}.", far.join(", ")));
    }
    html.within("div", "class=\"figures\"", |html| {
        drawn.iter().for_each(|(svg, caption)| html.figure(svg, caption));
    });
    html.text("h4", "The speed and the errors of each setting");
    html.paragraph(&format!("Rows have {} queries unless the remarks state another number.", max_queries(set)));
    html.table(&SETTING_HEAD, 2, &setting_rows(set));
    html.text("h4", "The time of single queries, in ns");
    html.table(&["backend", "setting", "50 %", "90 %", "99 %", "99.9 %", "all"], 2, &latency_rows(set));
    html.text("h4", "The number of queries from which on a longer build pays");
    write_break_even(html, set);
    Ok(())
}

const SETTING_HEAD: [&str; 11] = [
    "backend",
    "setting",
    "ns per query",
    "as fast",
    "error, relative",
    "99.9 %",
    "error, u M",
    "99.9 %",
    "bound gap",
    "other primitive",
    "remarks",
];

fn setting_rows(set: &SetFigures) -> Vec<Vec<String>> {
    let max_queries = max_queries(set);
    let all = set.curves.iter().flat_map(|curve| curve.points.iter().map(move |point| (curve, point)));
    all.map(|(curve, point)| {
        let (ns, errors) = (&point.nanoseconds, &point.errors);
        vec![
            curve.name.clone(),
            point.setting.clone(),
            format!("{:.0} ({:.0} to {:.0})", ns.median, ns.min, ns.max),
            speedup(curve, ns.median),
            error(errors.relative.max),
            error(errors.relative.p999),
            error(errors.scaled.max),
            error(errors.scaled.p999),
            error(errors.gap),
            errors.other_ids.map_or("-".to_owned(), |other| percentage(other, errors.compared)),
            remarks(curve, point, max_queries),
        ]
    })
    .collect()
}

/// Formats a fraction in per cent.
fn percentage(part: usize, total: usize) -> String {
    if part == 0 { "0".to_owned() } else { format!("{} %", error(100.0 * part as f64 / total as f64)) }
}

/// Returns the largest number of queries of a point.
fn max_queries(set: &SetFigures) -> usize {
    set.curves.iter().flat_map(|curve| curve.points.iter().map(|point| point.queries)).max().unwrap_or(0)
}

/// Returns remarks about a point in words. `max_queries` is the largest number of queries of a point.
fn remarks(curve: &Curve, point: &Point, max_queries: usize) -> String {
    let mut words = Vec::new();
    if point.queries < max_queries {
        words.push(format!("{} queries", point.queries));
    }
    let failures = failures(&point.errors);
    if !failures.is_empty() {
        words.push(failures);
    }
    let default = curve.usual().filter(|default| default.setting != point.setting);
    if default.is_some_and(|default| default.nanoseconds.min <= point.nanoseconds.max) {
        words.push("no faster".to_owned());
    }
    words.join(", ")
}

fn latency_rows(set: &SetFigures) -> Vec<Vec<String>> {
    let all = set.curves.iter().flat_map(|curve| curve.points.iter().map(move |point| (curve, point)));
    all.filter_map(|(curve, point)| {
        let l = point.latency?;
        let mut row = vec![curve.name.clone(), point.setting.clone()];
        // A percentile is shown only if there are enough queries for it.
        let all = [(l.p50, 2), (l.p90, 10), (l.p99, 100), (l.p999, 1000), (l.max, 1)];
        row.extend(
            all.map(|(ns, min_queries)| if point.queries < min_queries { "-".to_owned() } else { ns.to_string() }),
        );
        Some(row)
    })
    .collect()
}

/// Writes which backend is cheapest for which numbers of queries, and a table of the break-even of each pair.
fn write_break_even(html: &mut Html, set: &SetFigures) {
    let costs = default_costs(&set.curves);
    let only: Vec<_> = costs.iter().map(|(_, cost)| *cost).collect();
    let turns = cheapest(&only).into_iter().map(|(i, from)| match from {
        0.0 => costs[i].0.to_owned(),
        _ => format!("{} from {} queries on", costs[i].0, count(from)),
    });
    html.paragraph(&format!("The cheapest backend, with its build: {}.", turns.collect::<Vec<_>>().join(", then ")));
    let head: Vec<&str> = std::iter::once("instead of").chain(costs.iter().map(|(name, _)| *name)).collect();
    let cell = |i: usize, j: usize| match break_even(only[i], only[j]) {
        _ if i == j => String::new(),
        None => "never".to_owned(),
        Some(0.0) => "always".to_owned(),
        Some(queries) => count(queries),
    };
    let rows: Vec<Vec<String>> = costs
        .iter()
        .enumerate()
        .map(|(i, (name, _))| std::iter::once((*name).to_owned()).chain((0..costs.len()).map(|j| cell(i, j))).collect())
        .collect();
    html.table(&head, 1, &rows);
}
