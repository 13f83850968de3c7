//! Counts of instructions by callgrind, which runs this program on saved indexes.
//!
//! Callgrind finds the functions of this file by name, so none of them is inlined.

use crate::table::Row;
use crate::tasks::{COUNTERS, Indexes, QUERIES, SCENES, Task, scene};
use p2m::core::Isa;
use p2m_testkit::compiled;
use std::path::Path;
use std::process::Command;
use std::{env, fs};

/// The instruction sets for which instructions are counted. AVX-512 is missing, because valgrind does not support it.
const INSTRUCTION_SETS: [&str; 2] = ["portable", "avx2"];
/// The argument with which this program runs all queries on the indexes in a folder.
pub(crate) const MEASURE: &str = "--measure-in=";

/// The argument with which this program saves the indexes in a folder, for `cargo xtask account`.
pub(crate) const SAVE: &str = "--save-in=";

/// The function in which callgrind counts instructions.
#[inline(never)]
fn counted_by_callgrind(task: &Task<'_>) {
    (task.run)();
    std::hint::black_box(task);
}

/// The function after which callgrind writes its counts to a file.
#[inline(never)]
fn written_by_callgrind(task: &Task<'_>) {
    counted_by_callgrind(task);
    std::hint::black_box(task);
}

/// Runs all queries under callgrind on the indexes in a folder, for each scene and each instruction set in turn.
pub(crate) fn run_everything(folder: &Path) {
    for name in SCENES {
        let soup = scene(name);
        let indexes = Indexes::load(&soup, folder, name);
        for isa in Isa::available().into_iter().filter(|isa| INSTRUCTION_SETS.contains(&isa.name())) {
            indexes.clone().with_isa(isa).tasks().iter().for_each(written_by_callgrind);
        }
    }
}

/// Returns the reason why the counts of callgrind would not be comparable with the table; `None` if they are.
pub(crate) fn find_obstacle() -> Option<String> {
    let program = env::current_exe().expect("a program");
    let is_in_debug_folder = program.components().any(|part| part.as_os_str() == "debug");
    let is_changed = env::vars_os().any(|(name, _)| name.to_string_lossy().starts_with("CARGO_PROFILE_"));
    let is_profile_test = is_in_debug_folder && !is_changed && !cfg!(debug_assertions) && compiled::OPT_LEVEL == "3";
    if !cfg!(all(target_arch = "x86_64", target_os = "linux")) {
        Some(format!("this is {}, not Linux on x86-64", compiled::TARGET))
    } else if !is_profile_test {
        Some("this is not the profile test of the workspace".to_owned())
    } else if !compiled::FLAGS.is_empty() {
        Some(format!("the compiler has the flags {}", compiled::FLAGS))
    } else if !Command::new("valgrind").arg("--version").output().is_ok_and(|output| output.status.success()) {
        Some("valgrind is not installed".to_owned())
    } else {
        None
    }
}

/// Adds the instructions for the indexes in a folder to the rows.
pub(crate) fn count_instructions(folder: &Path, rows: &mut [Row]) {
    let counts = folder.join("callgrind");
    let output = Command::new("valgrind")
        .args(["--command-line-only=yes", "--tool=callgrind", "--dump-line=no", "--collect-atstart=no"])
        .args(["--toggle-collect=*counted_by_callgrind*", "--dump-after=*written_by_callgrind*"])
        .arg(format!("--callgrind-out-file={}", counts.display()))
        .arg(env::current_exe().expect("a program"))
        .arg(format!("{MEASURE}{}", folder.display()))
        .output()
        .expect("valgrind starts");
    assert!(output.status.success(), "valgrind failed: {}", String::from_utf8_lossy(&output.stderr));
    let dumps: Vec<u64> = (1..).map_while(|number| instructions(&counts.with_extension(number.to_string()))).collect();
    let sets = dumps.len() / rows.len();
    assert!(
        [1, 2].contains(&sets) && dumps.len() == sets * rows.len(),
        "{} counts of {} rows",
        dumps.len(),
        rows.len()
    );
    if sets == 1 {
        println!("no instructions with AVX2: the processor has none");
    }
    let tasks = rows.len() / SCENES.len();
    for (rows, dumps) in rows.chunks_mut(tasks).zip(dumps.chunks(sets * tasks)) {
        for (column, dumps) in (COUNTERS..).zip(dumps.chunks(tasks)) {
            for (row, count) in rows.iter_mut().zip(dumps) {
                row.figures[column] = Some((*count as f64 / QUERIES as f64).round());
            }
        }
    }
}

/// Returns the total in a file of callgrind; `None` if there is no such file.
fn instructions(file: &Path) -> Option<u64> {
    let text = fs::read_to_string(file).ok()?;
    let total = text.lines().find_map(|line| line.strip_prefix("totals: ")).expect("a file of callgrind has totals");
    Some(total.trim().parse().expect("a number"))
}
