//! Compares the builds of indexes with those of an earlier revision.
//!
//! `p2m-bench` of both revisions runs in turns, once a round, so that a change of the load of the machine meets both.

use crate::{Outcome, output, start, target_folder};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

/// The names of both programs.
const BASE: &str = "base";
const HERE: &str = "here";

/// A scene and a backend.
type Build = (String, String);

/// The measured builds of a program, as CPU seconds and as the largest memory in bytes a primitive.
#[derive(Default)]
struct Measured {
    seconds: Vec<f64>,
    peak: f64,
}

/// Runs the task with `BASE SCENE.. [--backends NAME,NAME] [--rounds N]`.
pub(crate) fn run(arguments: &[String]) -> Outcome {
    let usage = "give a revision and files of scenes: BASE SCENE.. [--backends p2m,octree] [--rounds 5]";
    let (mut words, mut backends, mut rounds) = (Vec::new(), "p2m,octree,aabb".to_owned(), 5);
    let mut rest = arguments.iter();
    while let Some(word) = rest.next() {
        match word.as_str() {
            "--backends" => backends = rest.next().ok_or(usage)?.clone(),
            "--rounds" => rounds = rest.next().and_then(|n| n.parse().ok()).filter(|n| *n > 0).ok_or(usage)?,
            _ => words.push(word.as_str()),
        }
    }
    let [revision, scenes @ ..] = &words[..] else { return Err(usage.into()) };
    if scenes.is_empty() {
        return Err(usage.into());
    }
    let folder = target_folder().join("builds");
    let clone = folder.join("clone");
    let [base, here] = [*revision, "HEAD"].map(|name| output("git", &["rev-parse", "--short", name]));
    let (base, here) = (base?, here?);
    let is_changed = !output("git", &["status", "--porcelain", "--untracked-files=no"])?.is_empty();
    let (base, here) = (base.trim(), format!("{}{}", here.trim(), if is_changed { "+changes" } else { "" }));
    // A clone of an earlier run is kept, so that nothing is compiled again.
    if clone.exists() {
        start(Command::new("git").arg("-C").arg(&clone).args(["fetch", "--quiet"]))?;
    } else {
        start(Command::new("git").args(["clone", "--quiet", "--no-checkout", "."]).arg(&clone))?;
    }
    start(Command::new("git").arg("-C").arg(&clone).args(["checkout", "--quiet", base]))?;
    let programs = [(BASE, clone.as_path()), (HERE, Path::new("."))];
    for (name, source) in programs {
        let mut cargo = Command::new("cargo");
        cargo.args(["build", "--locked", "--release", "--package", "p2m-bench", "--manifest-path"]);
        start(cargo.arg(source.join("Cargo.toml")).arg("--target-dir").arg(folder.join(name)))?;
    }
    let mut measured: BTreeMap<Build, BTreeMap<&str, Measured>> = BTreeMap::new();
    for round in 1..=rounds {
        eprintln!("round {round} of {rounds}");
        for scene in scenes {
            for backend in backends.split(',') {
                for (name, _) in programs {
                    let (seconds, peak) = build(&folder, name, scene, backend)?;
                    let of_backend = measured.entry(((*scene).to_owned(), backend.to_owned())).or_default();
                    let of_program = of_backend.entry(name).or_default();
                    of_program.seconds.push(seconds);
                    of_program.peak = of_program.peak.max(peak);
                }
            }
        }
    }
    println!("\nThread CPU time, medians of {rounds} rounds in turns; bytes are the largest memory during a build.\n");
    println!(
        "| scene | backend | {base} s | {here} s | {here} / {base} | {base} B a primitive | {here} B a primitive |"
    );
    println!("|---|---|---:|---:|---:|---:|---:|");
    for ((scene, backend), mut of_programs) in measured {
        let [of_base, of_here] = [BASE, HERE].map(|name| of_programs.remove(name).unwrap_or_default());
        let peaks = [of_base.peak, of_here.peak];
        let [before, after] = [of_base, of_here].map(|program| median(program.seconds));
        let scene = Path::new(&scene).file_name().unwrap_or_default().to_string_lossy().into_owned();
        println!(
            "| {scene} | {backend} | {before:.3} | {after:.3} | {:.3} | {:.0} | {:.0} |",
            after / before,
            peaks[0],
            peaks[1]
        );
    }
    Ok(())
}

/// Builds an index once and returns its CPU seconds, and its largest memory in bytes a primitive.
fn build(folder: &Path, program: &str, scene: &str, backend: &str) -> Result<(f64, f64), String> {
    let record = folder.join("builds.csv");
    let path = |p: &Path| p.to_string_lossy().into_owned();
    let _ = fs::remove_file(&record);
    let bench = path(&folder.join(program).join("release/p2m-bench"));
    let few_queries = ["--sets", "10x", "--queries", "1000", "--rounds", "1", "--builds", "1"];
    output(&bench, &[&["query", scene, "--backends", backend, "--csv", &path(&record)], &few_queries[..]].concat())?;
    let text = fs::read_to_string(&record).map_err(|e| format!("{}: {e}", record.display()))?;
    let mut lines = text.lines();
    let (head, row) = lines.next().zip(lines.next()).ok_or("p2m-bench wrote no row")?;
    // The text between quotation marks has no comma, so each comma separates two columns.
    let number = |name: &str| {
        let column = head.split(',').position(|column| column == name);
        let text = column.and_then(|at| row.split(',').nth(at)).ok_or_else(|| format!("no column {name}"))?;
        text.parse::<f64>().map_err(|e| format!("{name} is {text}: {e}"))
    };
    Ok((number("build_s_median")?, number("peak_bytes")? / number("primitives")?))
}

/// Returns the median.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
