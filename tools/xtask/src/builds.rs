//! Checks the builds that `p2m info` and `p2m advise` name: their numbers of crates, and that they work.

use crate::{Outcome, command, compare_or_write, make_folder, output, read, start, target, write};
use std::collections::BTreeSet;

/// The table of the numbers of crates, in which the program looks builds up.
const TABLE: &str = "apps/cli/src/scene/crates.csv";

/// Compares the table with what `cargo tree` says; with `P2M_BLESS` set, it writes the table.
pub(crate) fn check_crates() -> Outcome {
    let table = read(TABLE)?;
    let mut counted = String::new();
    for (i, line) in table.lines().enumerate() {
        // The first lines are a comment and the names of the columns.
        counted += &if i < 2 { line.to_owned() } else { row(line)? };
        counted.push('\n');
    }
    let is_blessed = std::env::var_os("P2M_BLESS").is_some();
    compare_or_write(TABLE, &counted, "P2M_BLESS=1 cargo xtask promises", is_blessed)
}

/// Returns the row of the features of a row, with the number of crates for one platform.
fn row(line: &str) -> Result<String, String> {
    let (features, _) = line.split_once(',').ok_or_else(|| format!("{TABLE}: {line}"))?;
    let all = if features.starts_with("default") { "" } else { "--no-default-features" };
    let tree = "cargo tree --locked --package p2m --edges normal,build --prefix none --no-dedupe \
        --target x86_64-unknown-linux-gnu --features";
    let tree = output(&mut command(&format!("{tree} {} {all}", features.replace(' ', ","))))?;
    Ok(format!("{features},{}", tree.lines().collect::<BTreeSet<_>>().len()))
}

/// A scene with one triangle, in files of `p2m-mixed` and of `p2m-formats`.
const SCENES: [(&str, &str); 2] = [
    ("scene.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n"),
    ("scene.geojson", r#"{"type":"Polygon","coordinates":[[[0,0],[4,0],[0,4],[0,0]]]}"#),
];

/// Runs programs that have the named features alone: they read a file and find a closest point.
pub(crate) fn run_programs() -> Outcome {
    let repository = std::env::current_dir().map_err(|error| error.to_string())?;
    let folder = target("smallest-builds");
    make_folder(folder.join("src"))?;
    for (features, reader, index, scene) in [
        ("\"bvh\", \"scene\"", "scene", "AabbTree", SCENES[0]),
        ("\"interception\", \"scene\"", "scene", "OctreeIndex", SCENES[0]),
        ("\"bvh\", \"formats\"", "formats", "AabbTree", SCENES[1]),
    ] {
        let manifest = format!(
            "[package]\nname = \"smallest\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n[workspace]\n\n[dependencies]\n\
             p2m = {{ path = {:?}, default-features = false, features = [{features}] }}\n",
            repository.display().to_string()
        );
        let program = format!(
            "use p2m::ClosestPoint;\n\nfn main() {{\n    \
             let scene = p2m::{reader}::read_scene({:?}.as_ref()).expect(\"a scene\");\n    \
             let index = p2m::{index}::new(scene.soup).expect(\"an index\");\n    \
             let answer = index.closest_point(&[1.0, 1.0, 3.0]).expect(\"an answer\");\n    \
             assert_eq!(answer.distance, 3.0);\n}}\n",
            scene.0
        );
        // With the versions of the repository, nothing has to be downloaded.
        let lock = read("Cargo.lock")?;
        let files = [("Cargo.toml", &*manifest), ("src/main.rs", &program), scene, ("Cargo.lock", &lock)];
        files.iter().try_for_each(|(name, text)| write(folder.join(name), text))?;
        start(command("cargo run --offline --quiet --target-dir target").current_dir(&folder))?;
    }
    Ok(())
}
