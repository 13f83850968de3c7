//! Formats Tables 1 to 4 and those of Section 5.5 from the measurements.

use super::scenes::stem;
use super::study::Study;
use super::surfaces::quality;
use crate::scene::Scene;
use p2m_cli::harness::Table;

/// Returns the time of a backend's query in microseconds, with the minimum and maximum of all rounds.
fn query(study: &Study, name: &str) -> String {
    study.backend(name).and_then(|measured| measured.query).map_or("-".to_owned(), |spread| {
        let [median, min, max] = [spread.median, spread.min, spread.max].map(|ns| format!("{:.2}", ns / 1e3));
        format!("{median} ({min}-{max})")
    })
}

/// Returns the ratio of the query times of two backends.
fn ratio(study: &Study, slower: &str, faster: &str) -> String {
    match (study.query(slower), study.query(faster)) {
        (Some(slower), Some(faster)) => format!("{:.2}", slower / faster),
        _ => "-".to_owned(),
    }
}

/// Formats the lists of the P2M index; a list of ours has whole triangles.
pub(super) fn lists(studies: &[&Study]) -> String {
    let mut table = Table::new([
        "ours",
        "primitives",
        "mean list",
        "by volume",
        "most",
        "tested, mean",
        "tested, most",
        "packets, mean",
        "left to the tree",
    ]);
    for study in studies {
        let (inside, name) = (&study.inside, stem(&study.name).to_owned());
        let visits = &inside.visits;
        let mut row = vec![name, study.primitives.to_string()];
        row.extend(match &inside.lists {
            Some(lists) => [format!("{:.1}", lists.mean), format!("{:.1}", visits.list), lists.max.to_string()],
            None => ["-", "-", "-"].map(str::to_owned),
        });
        row.extend([
            format!("{:.2}", visits.primitives.mean),
            visits.primitives.max.to_string(),
            format!("{:.2}", visits.packets.mean),
            format!("{:.1} %", 100.0 * visits.without_list),
        ]);
        table.push(row);
    }
    table.to_string()
}

/// Formats the stages of building the P2M index.
pub(super) fn stages(studies: &[&Study]) -> String {
    let names = ["tree", "delaunay", "balls", "lists", "locator"];
    let head = ["ours, ms"].into_iter().chain(names).chain(["all", "us a primitive"]);
    let mut table = Table::new(head);
    for study in studies {
        let all: f64 = study.inside.stages.iter().map(|(_, seconds)| seconds).sum();
        let mut row = vec![stem(&study.name).to_owned()];
        for name in names {
            let seconds = study.inside.stages.iter().find(|(stage, _)| stage.name() == name).map(|(_, s)| *s);
            row.push(seconds.map_or("-".to_owned(), |s| format!("{:.1} ({:.1} %)", s * 1e3, 100.0 * s / all)));
        }
        row.extend([format!("{:.1}", all * 1e3), format!("{:.1}", all * 1e6 / study.primitives as f64)]);
        table.push(row);
    }
    table.to_string()
}

/// Formats Table 3: the backends, and the gain of the paper's list filter.
pub(super) fn queries(studies: &[&Study]) -> String {
    let mut table = Table::new([
        "ours, us a query",
        "parry3d",
        "parry3d-f64",
        "aabb",
        "p2m, KD-tree",
        "p2m",
        "parry3d / p2m",
        "parry3d-f64 / p2m",
        "long lists",
        "with R-trees",
        "gain of R-trees",
    ]);
    for study in studies {
        let mut row = vec![stem(&study.name).to_owned()];
        row.extend(["parry3d", "parry3d-f64", "aabb", "p2m-kiddo", "p2m"].map(|name| query(study, name)));
        row.extend([ratio(study, "parry3d", "p2m"), ratio(study, "parry3d-f64", "p2m")]);
        row.extend(["p2m-long", "p2m-long-rstar"].map(|name| query(study, name)));
        row.push(ratio(study, "p2m-long", "p2m-long-rstar"));
        table.push(row);
    }
    table.to_string()
}

/// Formats Table 4: pairs of bad and good triangulations.
pub(super) fn triangulations(pairs: &[([Scene; 2], [Study; 2])]) -> String {
    let mut table = Table::new([
        "ours, us a query",
        "triangles",
        "quality",
        "bad triangles",
        "parry3d",
        "parry3d-f64",
        "aabb",
        "p2m",
        "parry3d / p2m",
    ]);
    for (scenes, studies) in pairs {
        for (scene, study) in scenes.iter().zip(studies) {
            let (mean, bad) = quality(&scene.double);
            let mut row = vec![study.name.clone(), scene.len().to_string()];
            row.extend([format!("{mean:.3}"), format!("{:.1} %", 100.0 * bad)]);
            row.extend(["parry3d", "parry3d-f64", "aabb", "p2m"].map(|name| query(study, name)));
            row.push(ratio(study, "parry3d", "p2m"));
            table.push(row);
        }
    }
    table.to_string()
}

/// Formats scenes of other kinds with their lists.
pub(super) fn others(studies: &[&Study]) -> String {
    let mut table = Table::new([
        "ours, us a query",
        "primitives",
        "mean list",
        "parry3d",
        "aabb",
        "octree",
        "p2m",
        "parry3d / p2m",
        "aabb / p2m",
    ]);
    for study in studies {
        let mean = study.inside.lists.map_or("-".to_owned(), |lists| format!("{:.1}", lists.mean));
        let mut row = vec![stem(&study.name).to_owned(), study.primitives.to_string(), mean];
        row.extend(["parry3d", "aabb", "octree", "p2m"].map(|name| query(study, name)));
        row.extend([ratio(study, "parry3d", "p2m"), ratio(study, "aabb", "p2m")]);
        table.push(row);
    }
    table.to_string()
}

/// Formats the parts of the P2M index in memory.
pub(super) fn memory(studies: &[&Study]) -> String {
    let names = ["sites", "locator", "lists", "tree"];
    let head = ["ours"].into_iter().chain(names).chain(["MB", "bytes a primitive"]);
    let mut table = Table::new(head);
    for study in studies {
        let part = |name: &str| study.inside.parts.iter().find(|part| part.0 == name).map_or(0, |part| part.1) as f64;
        let all: f64 = study.inside.parts.iter().map(|part| part.1 as f64).sum();
        let mut row = vec![stem(&study.name).to_owned()];
        row.extend(names.map(|name| format!("{:.1} %", 100.0 * part(name) / all)));
        row.extend([format!("{:.1}", all / 1e6), format!("{:.0}", all / study.primitives as f64)]);
        table.push(row);
    }
    table.to_string()
}

/// Returns the reasons why backends are missing.
pub(super) fn notes<'a>(studies: impl Iterator<Item = &'a Study>) -> String {
    let mut lines: Vec<String> = Vec::new();
    for study in studies {
        for measured in &study.backends {
            if let Some(absent) = &measured.absent {
                let line = format!("- {}, {}: {}\n", stem(&study.name), measured.name, absent.0);
                if !lines.contains(&line) {
                    lines.push(line);
                }
            }
        }
    }
    if lines.is_empty() { "- Every backend could be measured everywhere.\n".to_owned() } else { lines.concat() }
}
