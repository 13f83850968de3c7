//! Runs the checks of the fuzz targets on their seeds and on inputs that once failed (`tools/fuzz/crashes`), without a
//! nightly compiler.
//!
//! `P2M_FUZZED=tools/fuzz/corpus cargo test --test all fuzzed::` adds a folder that has a folder for each target, such
//! as the one that fuzzing leaves behind. `P2M_BLESS=1 cargo test --test all fuzzed::seeds_are` rewrites the seeds of
//! scenes and saved indexes.
#![cfg(all(feature = "bvh", feature = "interception", feature = "kdop", feature = "scene"))]

#[allow(unreachable_pub, unexpected_cfgs, reason = "a crate of its own, with its own features")]
#[path = "../../tools/fuzz/src/lib.rs"]
mod fuzz;

use fuzz::readers::Reader;
use fuzz::{QUESTIONS, backends, pairs, queries, rays, saved, scene};
use rand::RngExt;
use std::collections::BTreeSet;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

type Check = Box<dyn Fn(&[u8])>;

/// Returns the names of the targets, which are also the names of the folders of their seeds, with their checks.
fn targets() -> Vec<(String, Check)> {
    let others: [(&str, Check); 4] = [
        ("queries", Box::new(|input| _ = queries::check(input))),
        ("rays", Box::new(|input| _ = rays::check(input))),
        ("pairs", Box::new(|input| _ = pairs::check(input))),
        ("saved", Box::new(|input| _ = saved::check(input))),
    ];
    let readers = Reader::all().into_iter();
    let readers = readers.map(|reader| (reader.name(), Box::new(move |file: &[u8]| reader.check(file)) as Check));
    readers.chain(others.map(|(name, check)| (name.to_owned(), check))).collect()
}

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tools/fuzz").join(name)
}

/// Returns the sorted files of a folder, or none if the folder does not exist.
fn files(folder: &Path) -> Vec<PathBuf> {
    let mut files: Vec<_> =
        std::fs::read_dir(folder).into_iter().flatten().map(|entry| entry.expect("a file").path()).collect();
    files.sort();
    files
}

fn inputs(target: &str) -> Vec<Vec<u8>> {
    files(&folder("seeds").join(target)).iter().map(|file| std::fs::read(file).expect("readable")).collect()
}

#[test]
fn every_seed_and_everything_that_once_failed_passes() {
    let mut folders = vec![folder("seeds"), folder("crashes")];
    folders.extend(std::env::var_os("P2M_FUZZED").map(PathBuf::from));
    let mut failed = Vec::new();
    for (target, check) in targets() {
        let mut count = 0;
        for file in folders.iter().flat_map(|folder| files(&folder.join(&target))) {
            let input = std::fs::read(&file).expect("readable");
            count += 1;
            if catch_unwind(AssertUnwindSafe(|| check(&input))).is_err() {
                let content = match target.as_str() {
                    "queries" => queries::describe(&input),
                    "rays" => rays::describe(&input),
                    "pairs" => pairs::describe(&input),
                    _ => String::new(),
                };
                eprintln!("{} fails\n{content}", file.display());
                failed.push(file);
            }
        }
        assert!(count > 0, "nothing for {target}");
    }
    assert!(failed.is_empty(), "{failed:?}");
}

/// Each crash has a line in the table of its folder, and each line has a file.
#[test]
fn what_once_failed_is_explained() {
    let text = std::fs::read_to_string(folder("crashes/README.md")).expect("a page");
    let lines = text.lines().filter_map(|line| line.strip_prefix("| `")?.split('`').next());
    let explained: BTreeSet<String> = lines.map(str::to_owned).collect();
    let there = targets().into_iter().flat_map(|(target, _)| {
        let name = |file: &PathBuf| format!("{target}/{}", file.file_name().expect("a file").display());
        files(&folder("crashes").join(&target)).iter().map(name).collect::<Vec<_>>()
    });
    assert_eq!(explained, there.collect());
}

#[test]
fn seeds_reach_every_backend_and_question() {
    let reached: BTreeSet<_> = inputs("queries").iter().map(|input| queries::check(input)).collect();
    assert!(reached.contains(&queries::Reached::Refused));
    let all = |wanted: &[&str], of: fn(&queries::Reached) -> Option<&'static str>| {
        let found: BTreeSet<_> = reached.iter().filter_map(of).collect();
        assert_eq!(found, wanted.iter().copied().collect());
    };
    use queries::Reached::Answers;
    all(&scene::MODES, |r| if let Answers(mode, ..) = r { Some(mode) } else { None });
    all(&[&backends::TREES[..], &backends::OTHERS].concat(), |r| {
        if let Answers(_, name, _) = r { Some(name) } else { None }
    });
    all(&QUESTIONS, |r| if let Answers(.., question) = r { Some(question) } else { None });
    let trees: BTreeSet<_> = inputs("rays").iter().filter_map(|input| rays::check(input)).collect();
    assert!(backends::TREES.iter().all(|name| trees.iter().any(|(tree, rays)| tree == name && *rays > 0)));
    let answered = inputs("pairs").iter().filter(|input| pairs::check(input) == Some(true)).count();
    assert!(answered > 2, "{answered}");
    let reached: BTreeSet<_> = inputs("saved").iter().map(|input| saved::check(input)).collect();
    assert_eq!(reached.len(), 2, "{reached:?}");
}

/// The seeds of scenes are random bytes after a head that selects the question and the backend. The seeds of saved
/// indexes change valid files.
#[test]
fn seeds_are_those_that_are_made_here() {
    let mut made = Vec::new();
    let mut random = |name: String, head: &[u8], len: usize| {
        let mut rng = p2m_testkit::rng(&name, 0);
        let bytes: Vec<u8> = head.iter().copied().chain((0..len).map(|_| rng.random())).collect();
        made.push((name, bytes));
    };
    for (q, question) in QUESTIONS.iter().enumerate() {
        for (m, mode) in scene::MODES.iter().enumerate() {
            // The head selects f64 (f32 for the lattice of every second question), then backend, instruction set and
            // option, the seed, and the mode.
            let is_single = u8::from(m == 0 && q % 2 == 1);
            let head = [q as u8, is_single, (q * 5 + m) as u8, 0, 1, m as u8 * 3, m as u8];
            random(format!("queries/{question}-{mode}"), &head, if m == 1 { 300 } else { 180 });
        }
    }
    for (m, mode) in scene::MODES.iter().enumerate() {
        for tree in 0..4 {
            random(format!("rays/{mode}-{tree}"), &[tree, tree, 0, 7, m as u8], 120);
        }
    }
    for (m, mode) in scene::MODES.iter().enumerate() {
        for motion in 0..4 {
            // The head selects the scalar, the motion, the seed, and the mode.
            random(format!("pairs/{mode}-{motion}"), &[motion, motion, 5, m as u8], 240);
        }
    }
    for kind in 0..5 {
        for scene in 0..2 {
            random(format!("saved/damaged-{kind}-{scene}"), &[0, scene, kind], 5);
            for round in 0..3 {
                random(format!("saved/changed-{kind}-{scene}-{round}"), &[1, scene, kind], 40);
            }
        }
    }
    // The input has a point at infinity.
    let infinity = f64::INFINITY.to_le_bytes();
    made.push(("queries/infinity".into(), [&[0, 0, 0, 0, 0, 0, 1][..], &infinity, &[0; 45], &[1, 0, 0]].concat()));
    // The first child of the first node becomes a node that does not exist, or the first node itself.
    made.push(("saved/child-that-is-not-there".into(), vec![1, 0, 0, 2, 7, 0, 0, 4]));
    made.push(("saved/child-of-itself".into(), vec![1, 0, 0, 2, 7, 0, 0, 0]));
    // The inputs are a file of four sections without names, and an empty file.
    let head = b"\x89P2M\r\n\x1a\n\x01\0\0\0\x04\0\0\0";
    made.push(("saved/made-up".into(), [&[2, 0, 0][..], head, &[0; 400]].concat()));
    made.push(("saved/nothing".into(), vec![0, 3, 0]));
    let is_wanted = std::env::var_os("P2M_BLESS").is_some();
    for (name, bytes) in made {
        let path = folder("seeds").join(&name);
        if is_wanted {
            std::fs::write(&path, &bytes).expect("written");
        }
        assert_eq!(std::fs::read(&path).ok(), Some(bytes), "{name}");
    }
}
