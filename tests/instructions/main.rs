//! A repeatable gate for performance, which compares the work of queries with a table, for each backend and query set.
//!
//! `tests/instructions.csv` has the nodes, packets and primitives that a query visits, and the instructions that it
//! executes with the portable instruction set and with AVX2. No time is measured.
//!
//! - **Counters** are taken in this process with the portable instruction set, and do not depend on the number of
//!   threads. They have to be exactly those of the table; after an improvement the table is renewed.
//! - **Instructions** are counted by callgrind, if valgrind is installed: this program saves the indexes and starts
//!   itself under valgrind, which counts the queries only. Instructions depend on the compiler, the target and the
//!   profile, so they are left out, with a message, if those are not the table's. The test fails for a query that takes
//!   more instructions than the table has, beyond a tolerance, and prints a message for one that takes fewer.
//!
//! `P2M_BLESS=1 cargo test --test instructions` rewrites the table. The table is for the profile `test`, which
//! optimises the libraries that contain the counted code, but not this program.

mod callgrind;
mod marks;
mod table;
mod tasks;

use callgrind::{MEASURE, SAVE, count_instructions, find_obstacle, run_everything};
use marks::{MARK, run_between_marks};
use p2m::core::Isa;
use p2m_testkit::compiled;
use std::env;
use std::path::Path;
use std::process::ExitCode;
use table::{COLUMNS, RENEWAL, Row, Table, compare, print_rows};
use tasks::{Indexes, QUERIES, SCENES, Task, scene};

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let folder_after = |name: &str| arguments.iter().find_map(|argument| argument.strip_prefix(name)).map(Path::new);
    if let Some(folder) = folder_after(SAVE) {
        SCENES.iter().for_each(|name| Indexes::build(&scene(name)).save(folder, name));
        return ExitCode::SUCCESS;
    }
    if let Some(folder) = folder_after(MEASURE) {
        run_everything(folder);
        return ExitCode::SUCCESS;
    }
    if arguments.iter().any(|argument| argument == MARK) {
        run_between_marks();
        return ExitCode::SUCCESS;
    }
    if is_selected(&arguments) { check_table() } else { ExitCode::SUCCESS }
}

/// The name of the only test in this program.
const NAME: &str = "work_is_that_of_the_table";

/// Returns whether the arguments of a test program select this test. If they request a list of the tests, the function
/// prints it.
fn is_selected(arguments: &[String]) -> bool {
    let is_set = |flag: &str| arguments.iter().any(|argument| argument == flag);
    let (mut filters, mut skips) = (Vec::new(), Vec::new());
    let mut rest = arguments.iter();
    while let Some(argument) = rest.next() {
        match argument.as_str() {
            "--skip" => skips.extend(rest.next()),
            "--test-threads" | "--format" | "--color" | "--logfile" | "--shuffle-seed" | "-Z" => drop(rest.next()),
            _ if !argument.starts_with('-') => filters.push(argument),
            _ => {}
        }
    }
    let matches = |filter: &&String| if is_set("--exact") { *filter == NAME } else { NAME.contains(filter.as_str()) };
    let is_chosen = (filters.is_empty() || filters.iter().any(matches)) && !skips.iter().any(matches);
    let is_chosen = is_chosen && !is_set("--ignored");
    if is_set("--list") {
        if is_chosen {
            println!("{NAME}: test");
        }
        return false;
    }
    is_chosen
}

/// Returns the rows of the indexes, with their counters.
fn count_rows(scene: &str, indexes: Indexes<'_>) -> Vec<Row> {
    let row = |task: &Task<'_>| {
        let mut figures = [None; COLUMNS.len()];
        for (figure, count) in figures.iter_mut().zip((task.count)()) {
            *figure = Some(count as f64 / QUERIES as f64);
        }
        Row { names: [scene, task.backend, task.set].map(str::to_owned), figures }
    };
    indexes.with_isa(Isa::PORTABLE).tasks().iter().map(row).collect()
}

/// Measures everything, and compares it with the table or writes the table.
fn check_table() -> ExitCode {
    let is_renewed = env::var_os("P2M_BLESS").is_some();
    let mut table = Table::read();
    let compiler = format!("{}, {}, profile test", compiled::RUSTC, compiled::TARGET);
    let mut obstacle = find_obstacle();
    if obstacle.is_none() && !is_renewed && table.compiler != compiler {
        obstacle = Some(format!("this is {compiler}, and the table has {}", table.compiler));
    }
    let folder = tempfile::tempdir().expect("a folder");
    let mut rows = Vec::new();
    for name in SCENES {
        let soup = scene(name);
        let indexes = Indexes::build(&soup);
        if obstacle.is_none() {
            indexes.save(folder.path(), name);
        }
        rows.extend(count_rows(name, indexes));
    }
    match &obstacle {
        None => count_instructions(folder.path(), &mut rows),
        Some(why) => println!("instructions are not counted: {why}"),
    }
    print_rows(&rows, &table);
    if is_renewed {
        table = Table { compiler, rows };
        table.write();
        println!("tests/instructions.csv is written{}", if obstacle.is_some() { ", without instructions" } else { "" });
        return ExitCode::SUCCESS;
    }
    let (wrong, better) = compare(&rows, &table);
    if !better.is_empty() {
        println!("\nfewer instructions than in the table; to keep the gain, renew it ({RENEWAL}):");
        better.iter().for_each(|message| println!("  {message}"));
    }
    if wrong.is_empty() {
        println!("test {NAME} ... ok");
        return ExitCode::SUCCESS;
    }
    println!("\nnot as in tests/instructions.csv; if it is meant to be so, renew it ({RENEWAL}):");
    wrong.iter().for_each(|message| println!("  {message}"));
    println!("test {NAME} ... FAILED");
    ExitCode::FAILURE
}
