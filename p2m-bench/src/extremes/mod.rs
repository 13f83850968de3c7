//! `p2m-bench extremes`: checks the accuracy contract on inputs where other libraries fail, and writes a page.

pub(crate) mod counts;
mod example;
mod external;
mod primitives;
mod scenes;

use anyhow::{Context, Result, ensure};
use example::Example;
use external::{Kind, LIBRARIES};
use p2m_testkit::extremes::Extreme;
use p2m_testkit::oracle::Distance;
use p2m_tradeoff::{Provenance, Table};
use std::fmt::Write as _;
use std::path::Path;
use std::time::Instant;

/// The number of checks.
pub(crate) struct Amount {
    /// The number of answers about isolated primitives.
    pub(crate) cases: u64,
    /// The number of scenes of each family.
    pub(crate) scenes: u64,
    /// The seed of all random numbers.
    pub(crate) seed: u64,
}

/// Checks everything and writes the page, or prints it. Returns whether our backends broke no promise.
pub(crate) fn write(amount: &Amount, out: Option<&Path>, provenance: &Provenance) -> Result<bool> {
    // Panics of external libraries are caught and counted; a message for each would bury the report.
    let default_hook = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| ()));
    let start = Instant::now();
    let (alone, together) = (primitives::run(amount.cases, amount.seed), scenes::run(amount.scenes, amount.seed));
    let broken = alone.broken + together.broken;
    let page = page(amount, &alone, &together, provenance);
    std::panic::set_hook(default_hook);
    let page = page?;
    match out {
        Some(path) => std::fs::write(path, &page).with_context(|| path.display().to_string())?,
        None => print!("{page}"),
    }
    alone.shown.iter().chain(&together.shown).for_each(|what| eprintln!("BROKEN {what}"));
    println!(
        "{} answers of ours compared with the true distance, {} more with each other in {:.0?}, {broken} promises broken.",
        alone.checked.iter().sum::<u64>() + together.queries,
        alone.invariant + together.checked,
        start.elapsed()
    );
    Ok(broken == 0)
}

fn page(
    amount: &Amount,
    alone: &primitives::Findings,
    together: &scenes::Findings,
    provenance: &Provenance,
) -> Result<String> {
    let mut page = String::from("# Extremes\n\n");
    let Amount { cases, scenes, seed } = amount;
    writeln!(
        page,
        "Made by `cargo run --release -p p2m-bench -- extremes --cases {cases} --scenes {scenes} --seed {seed} --out docs/extremes.md`.\n\n{provenance}\nErrors are in units of u M: u is 2^-53 \
         or 2^-24, M the distance from the query to the farthest vertex of the primitive. \"Fails\" are NaN, infinity for what is in range, and no answer.\n"
    )?;
    writeln!(page, "## What was checked\n")?;
    let mut table = Table::new(["", "answers", "promises broken"]);
    let mut row = |what: &str, count: u64, broken: String| table.push(vec![what.to_owned(), count.to_string(), broken]);
    for (scalar, count) in ["f64", "f32"].into_iter().zip(alone.checked) {
        row(
            &format!("isolated primitives in {scalar} against the truth: N1, N5, N6, N7"),
            count,
            alone.broken.to_string(),
        );
    }
    row("the same against those of another order or scale: N4", alone.invariant, "counted above".to_owned());
    row(
        "scenes, brute force against the truth of every primitive: N1, N2, N6, N7",
        together.queries,
        together.broken.to_string(),
    );
    row("scenes, every backend against brute force: N3, N6", together.checked, "counted above".to_owned());
    writeln!(page, "{table}")?;
    writeln!(
        page,
        "Broken promises of isolated primitives are those of both scalars. Cases of a scalar are drawn in its own range, and none has zeros alone. In scenes \
         distances and primitives are compared; points and weights are functions of the primitive.\n"
    )?;
    writeln!(
        page,
        "The truth is a pair of bounds, from a point of the primitive and a plane before it, in twice the precision (`p2m_testkit::enclosure`); where they \
         are too far apart to tell, as for {} of the isolated primitives and {} of those of scenes, it is rational arithmetic.\n",
        alone.rational, together.rational
    )?;
    writeln!(page, "## Isolated primitives\n")?;
    writeln!(
        page,
        "The largest error of a distance, and fractions of answers that are wrong in other ways. Sines, needles and positions of queries are of scale one at the \
         origin, offsets of scale one, scales at the origin. Other libraries answer every twentieth case of their scalar.\n"
    )?;
    let mut table = Table::new(["", "p2m f64", "p2m f32"].into_iter().chain(LIBRARIES.iter().map(|r| r.name)));
    for (label, counts) in &alone.rows {
        table.push(std::iter::once(label.clone()).chain(counts.iter().map(counts::Counts::cell)).collect());
    }
    writeln!(page, "{table}")?;
    LIBRARIES.iter().try_for_each(|library| writeln!(page, "- {}: {}.", library.name, library.about))?;
    writeln!(page, "\n## Small scenes\n")?;
    writeln!(
        page,
        "Queries on, near, equidistant and far; at scales of both scalars except where the family has its own. All backends of ours have the same bits, so \
         one column is all of them; a column of its own is for what is not. Where a scene is too small, too large or too far away for cells, the octree and the P2M index \
         are their trees: \"cells\" says in how many of the scenes in f64 they are more.\n"
    )?;
    let subjects = scenes::subjects();
    let shown = ["aabb", "aabb-f32", "parry3d-f64", "parry3d", "bvh"];
    let columns: Vec<usize> =
        shown.iter().filter_map(|name| subjects.iter().position(|subject| subject.name == *name)).collect();
    let mut table = Table::new(["", "ours f64", "ours f32", "parry3d-f64", "parry3d", "bvh", "cells: octree, p2m"]);
    for ((family, counts), [scenes, octree, p2m]) in Extreme::ALL.iter().zip(&together.rows).zip(&together.cells) {
        let part = |count: &u64| format!("{} %", count * 100 / scenes.max(&1));
        let cells = columns.iter().map(|column| counts[*column].cell()).chain([part(octree) + ", " + &part(p2m)]);
        table.push(std::iter::once(family.name().to_owned()).chain(cells).collect());
    }
    writeln!(page, "{table}")?;
    let ours: Vec<&str> = subjects.iter().filter(|subject| subject.is_ours).map(|subject| subject.name).collect();
    writeln!(page, "Ours: {}.\n", ours.join(", "))?;
    for (why, count) in &together.absent {
        writeln!(page, "- Left out of {count} scenes: {why}.")?;
    }
    writeln!(
        page,
        "\nScenes at which building takes too long or too much memory, for us and for other libraries, are in [adversaries.md](adversaries.md)."
    )?;
    writeln!(page, "\n## Wrong answers of other libraries\n")?;
    writeln!(
        page,
        "The plainest case of each kind that was found, as f64. Each was run again from the text below and checked again by rational arithmetic.\n"
    )?;
    let mut examples = alone.examples.clone();
    examples.sort_by_key(|example| example.library);
    for example in &examples {
        writeln!(page, "{}\n", described(example)?)?;
    }
    writeln!(page, "Over scenes, with the primitives that it takes:\n")?;
    let mut examples: Vec<_> = together.examples.iter().cloned().map(Example::reduced).collect();
    examples.sort_by_key(|example| (example.library, example.kind));
    for example in &examples {
        let said = example
            .confirmed()
            .with_context(|| format!("{} is right when it runs again: {example:?}", example.library))?;
        writeln!(page, "- {} {said}: {}.\n", versioned(example.library), example.text())?;
    }
    Ok(page)
}

/// Returns a crate's name with the version that was built.
fn versioned(name: &str) -> String {
    let lock = include_str!("../../../Cargo.lock");
    let entry = format!("name = \"{name}\"\nversion = \"");
    let version = lock.split_once(&entry).and_then(|(_, rest)| rest.split_once('"')).map(|(version, _)| version);
    version.map_or_else(|| name.to_owned(), |version| format!("{name} {version}"))
}

/// Describes a case after running it once more from its own text.
fn described(example: &primitives::Example) -> Result<String> {
    let text = example.text();
    let numbers = text.split(|c: char| !(c.is_ascii_digit() || "+-.e".contains(c))).filter(|part| !part.is_empty());
    let numbers = numbers.map(str::parse::<f64>).collect::<Result<Vec<_>, _>>()?;
    let points: Vec<[f64; 3]> = numbers.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect();
    let (query, vertices) = (points[0], &points[1..]);
    let library = &LIBRARIES[example.library];
    let again = library.check(query, vertices).and_then(|result| result.kind());
    ensure!(again == Some(example.kind), "{} is right when it runs again: {example:?}", library.name);
    let said = match example.kind {
        Kind::Panic => "panics".to_owned(),
        _ => format!("answers {:e}", library.distance(query, vertices)),
    };
    let distance = Distance::new(query, vertices).length()[0];
    Ok(format!(
        "- {} {said}: query `{query:?}`, vertices `{vertices:?}`. The distance is {distance:e}.",
        versioned(library.name)
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ours_break_nothing_over_single_primitives_and_libraries_run_twice() {
        let amount = Amount { cases: p2m_testkit::amount(30_000, 3_000), scenes: 0, seed: 7 };
        let alone = primitives::run(amount.cases, amount.seed);
        assert!(alone.checked.iter().all(|count| *count >= amount.cases / 2), "{:?}", alone.checked);
        assert!(alone.invariant > amount.cases * 2 / 3, "{}", alone.invariant);
        assert_eq!(alone.broken, 0, "{:?}", alone.shown);
        let mut wrong =
            alone.examples.iter().find(|e| e.library == 2 && e.kind == Kind::Wrong).expect("slivers").clone();
        assert!(described(&wrong).unwrap().contains("Ericson answers"));
        wrong.kind = Kind::Panic;
        assert!(described(&wrong).is_err(), "it does not panic");
    }

    #[test]
    #[ignore = "deep: every index is built over scenes of every extreme"]
    fn ours_break_nothing_over_scenes_and_libraries_run_twice() {
        let together = scenes::run(1, 7);
        assert!(together.checked > 1000, "{}", together.checked);
        assert_eq!(together.broken, 0, "{:?}", together.shown);
        for example in together.examples {
            let (count, mut example) = (example.vertices.len(), example.reduced());
            assert!(example.is_confirmed() && example.vertices.len() <= count, "{example:?}");
            // Our own tree is not wrong in that way.
            example.library = "aabb";
            assert!(!example.is_confirmed(), "{example:?}");
        }
    }
}
