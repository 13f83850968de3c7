//! The budget: how large the repository may be. `budget.csv` has a row for each measure, with its exact value, so a
//! change that makes something larger has to change its row.

mod circles;
mod source;

use crate::{Outcome, command, fail_if_any, make_folder, output, read, start, target, write};
use source::{RUST, Source};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

const TABLE: &str = "tools/xtask/budget.csv";
const HEAD: &str = "measure,of,value";

/// Values by the measure and what is measured.
type Rows = BTreeMap<(String, String), usize>;

/// Builds whose crates are counted: their names and the arguments that choose them.
const BUILDS: [(&str, &str); 5] = [
    ("the program", "-p p2m-cli"),
    ("p2m", "-p p2m"),
    ("p2m with bvh alone", "-p p2m --no-default-features --features bvh"),
    ("p2m-c", "-p p2m-c"),
    ("p2m-python", "-p p2m-python"),
];

/// The crates whose LLVM is counted on request.
const INSTANTIATING: [&str; 6] = ["p2m-core", "p2m-bvh", "p2m-kdop", "p2m-interception", "p2m-backends", "p2m-field"];

/// Measures everything and compares it with the table, or with `--write` renews the table.
pub(crate) fn check(arguments: &[String]) -> Outcome {
    let has = |name: &str| arguments.iter().any(|argument| argument == name);
    let sources = sources()?;
    let mut rows = Rows::new();
    count_sources(&sources, &mut rows);
    for (name, build) in BUILDS {
        rows.insert(("crates".into(), name.into()), crates(build)?);
    }
    let old = if has("--write") && !Path::new(TABLE).exists() { Rows::new() } else { parse(&read(TABLE)?)? };
    if has("--llvm") {
        for name in INSTANTIATING {
            rows.insert(("LLVM".into(), name.into()), llvm_lines(name)?);
        }
    } else {
        println!("lines of LLVM: skipped (--llvm counts them)");
        rows.extend(old.iter().filter(|((measure, _), _)| measure == "LLVM").map(|(row, value)| (row.clone(), *value)));
    }
    let circles = circles::circles(&sources);
    let (too_large, hints) = compare(&old, &rows);
    hints.iter().for_each(|line| println!("  {line}"));
    let sum = |of: fn(&Source) -> usize| sources.iter().map(of).sum::<usize>();
    println!("{} lines of code and {} of tests", sum(Source::lines), sum(|source| source.tests));
    if has("--write") {
        let lines = rows.iter().map(|((measure, of), value)| format!("{measure},{of},{value}\n"));
        let table = format!("{HEAD}\n{}", lines.collect::<String>());
        write(TABLE, table)?;
    }
    fail_if_any("files import each other in a circle:", &circles.into_iter().collect::<Vec<_>>())?;
    let how = "make it smaller, or raise the row by `cargo xtask budget --write` and give the reason in the commit";
    if has("--write") { Ok(()) } else { fail_if_any(&format!("the budget is exceeded: {how}"), &too_large) }
}

/// Returns the rows that are exceeded, and those that could be lower by more than one percent.
fn compare(old: &Rows, new: &Rows) -> (Vec<String>, Vec<String>) {
    let row = |(measure, of): &(String, String), old: usize, new: usize| {
        format!("{measure} of {of}: {new}, and the row of {TABLE} has {old}")
    };
    let value = |rows: &Rows, name| rows.get(name).copied().unwrap_or(0);
    let larger = new.iter().filter(|(name, new)| **new > value(old, name));
    let smaller = old.iter().filter(|(name, old)| **old > value(new, name) + **old / 100);
    (
        larger.map(|(name, new)| row(name, value(old, name), *new)).collect(),
        smaller.map(|(name, old)| row(name, *old, value(new, name)) + "; `--write` lowers it").collect(),
    )
}

fn parse(table: &str) -> Result<Rows, String> {
    let row = |line: &str| {
        let mut cells = line.split(',');
        let (measure, of, value) = (cells.next()?, cells.next()?, cells.next()?.parse().ok()?);
        Some(((measure.to_owned(), of.to_owned()), value))
    };
    table.lines().skip(1).map(|line| row(line).ok_or_else(|| format!("{TABLE}: {line}"))).collect()
}

/// Returns the files of the repository that have code, also new ones.
fn sources() -> Result<Vec<Source>, String> {
    let files = output(&mut command("git ls-files --cached --others --exclude-standard"))?;
    // Files that are not text have no code, and files that are deleted are still in the list of Git.
    let source = |path: &str| Source::new(path, &fs::read_to_string(path).ok()?);
    Ok(files.lines().filter_map(source).collect())
}

/// Returns the folder of the crate or face that a file belongs to; `p2m` is the facade with its examples and tests.
fn unit(path: &str) -> Option<String> {
    let mut folders = path.split('/');
    match folders.next()? {
        "src" | "examples" | "tests" => Some("p2m".to_owned()),
        group @ ("apps" | "bindings" | "tools") => Some(format!("{group}/{}", folders.next()?)),
        folder => folder.starts_with("p2m-").then(|| folder.to_owned()),
    }
}

/// Adds the lines of code of each crate and face, and the public names of the crates that are published.
fn count_sources(sources: &[Source], rows: &mut Rows) {
    for source in sources {
        let Some(unit) = unit(&source.path) else { continue };
        *rows.entry(("lines".into(), format!("{unit} {}", source.language))).or_default() += source.lines();
        let manifest = if unit == "p2m" { "Cargo.toml".to_owned() } else { format!("{unit}/Cargo.toml") };
        let is_published = fs::read_to_string(manifest).is_ok_and(|manifest| !manifest.contains("publish = false"));
        if source.language == RUST && is_published {
            *rows.entry(("public names".into(), unit)).or_default() += source.public_names();
        }
    }
}

/// Returns how many crates a build compiles on Linux.
fn crates(build: &str) -> Result<usize, String> {
    let tree = "cargo tree --locked --edges normal,build --target x86_64-unknown-linux-gnu --prefix none --format {p}";
    let tree = output(&mut command(&format!("{tree} {build}")))?;
    let names = tree.lines().map(|line| line.split(' ').take(2).collect::<Vec<_>>());
    Ok(names.collect::<std::collections::BTreeSet<_>>().len())
}

/// Returns the lines of LLVM's language that the compiler makes of a crate.
fn llvm_lines(name: &str) -> Outcome<usize> {
    let folder = target("llvm");
    let file = folder.join(format!("{name}.ll"));
    make_folder(&folder)?;
    let mut rustc = command(&format!("cargo rustc --locked --release --lib -p {name} --target-dir"));
    rustc.arg(&folder).args(["--", "-C", "codegen-units=1"]).arg(format!("--emit=llvm-ir={}", file.display()));
    start(&mut rustc)?;
    Ok(read(&file)?.lines().filter(|line| line.starts_with("  ")).count())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn larger_and_new_rows_exceed_the_table() {
        let [old, new] = ["m,a,100\nm,b,100\nm,c,100", "m,a,101\nm,b,99\nm,c,98\nm,d,1"]
            .map(|rows| parse(&format!("{HEAD}\n{rows}")).unwrap());
        let (exceeded, hints) = compare(&old, &new);
        assert_eq!(exceeded.len(), 2, "{exceeded:?}");
        assert!(
            exceeded[0].contains("m of a: 101") && exceeded[0].contains("100") && exceeded[1].contains("m of d: 1")
        );
        assert!(hints.len() == 1 && hints[0].contains("m of c: 98"), "{hints:?}");
        assert!(parse("measure,of,value\na,b").is_err());
    }
}
