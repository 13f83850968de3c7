//! Counts which stages of a search take the instructions of a query, and writes the table into docs/batches.md.
//!
//! The program of tests/instructions runs its queries in the release profile. Callgrind counts how often each
//! instruction is executed, and addr2line names the functions that were inlined at its address. The first stage in
//! [`STAGES`] that names one of them has the instruction.

use crate::{Outcome, command, make_empty_folder, need, output, read, target};
use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

/// The document, and the comments around its table.
const DOCUMENT: &str = "docs/batches.md";
const MARKS: [&str; 2] = ["<!-- account -->\n", "<!-- end of the account -->"];
/// The rows of this table are the tasks of the program, in the order in which they run.
const TASKS: &str = "tests/instructions.csv";
/// The scenes, each of which runs with these instruction sets in turn.
const SCENES: [&str; 2] = ["knot_and_cables", "scan"];
const LANES: [&str; 2] = ["portable", "avx2"];
/// The queries of a task.
const QUERIES: u64 = 200;
/// The scene of the table, and its columns: an index and a query set each.
const SCENE: &str = "scan";
const COLUMNS: [(&str, &str); 6] = [
    ("octree", "1x"),
    ("octree", "surface"),
    ("octree batch", "1x"),
    ("octree batch", "surface"),
    ("aabb batch", "1x"),
    ("aabb batch", "surface"),
];

/// The stages, each with its functions, and with files all of whose functions belong to it.
const STAGES: [(&str, &str); 12] = [
    ("filters: vertices, edges and normals", "prepare@distance_filter.rs"),
    ("filters: planes", "lanes_before_plane@ place_planes@ set_plane@ is_beyond@distance_filter.rs"),
    ("filters: distances", "squares_of_several@ squares@distance_filter.rs smallest@distance_filter.rs"),
    (
        "filters: frames and limits",
        "convert@ set@distance_filter.rs local@distance_filter.rs update@interleaved_search.rs update_limits@",
    ),
    ("filters: candidates", "push_candidates@ push_pending@ at_most@distance_filter.rs prefetch_vertices@"),
    (
        "evaluation",
        "evaluate_pending_inline@ evaluate@interleaved_search.rs evaluate_early@ evaluate_triangles@ \
         @side_by_side.rs take@interleaved_search.rs",
    ),
    ("order along the curve", "sorted_along_curve@"),
    ("cells", "locate_cell@ locate_code@"),
    ("bounds of lists", "bound@interleaved_lists.rs @block.rs sorted_keys@"),
    ("turns in lists and filters", "@interleaved_lists.rs @interleaved_search.rs search_list@ packet@search_state.rs"),
    ("nodes and turns in trees", "@interleaved_traversal.rs @nearest.rs traverse@"),
    ("beginning, answers and columns", ""),
];

/// Counts instructions and writes the table.
pub(crate) fn run() -> Outcome {
    need("valgrind")?;
    need("addr2line")?;
    let program = build()?;
    let folder = target("account/files");
    make_empty_folder(&folder)?;
    let path = |name: &str| folder.join(name);
    output(Command::new(&program).arg(format!("--save-in={}", folder.display())))?;
    let counts = path("callgrind");
    let valgrind = "valgrind --command-line-only=yes --tool=callgrind --dump-line=no --dump-instr=yes \
        --collect-atstart=no --toggle-collect=*counted_by_callgrind* --dump-after=*written_by_callgrind*";
    output(
        command(valgrind)
            .arg(format!("--callgrind-out-file={}", counts.display()))
            .arg(&program)
            .arg(format!("--measure-in={}", folder.display()))
            .env("RAYON_NUM_THREADS", "1"),
    )?;
    let tasks = read(TASKS)?;
    let tasks: Vec<&str> = tasks.lines().filter(|line| line.starts_with(SCENE)).collect();
    let before = SCENES.iter().position(|scene| *scene == SCENE).ok_or("no such scene")? * LANES.len() * tasks.len();
    let mut table = vec![[0; COLUMNS.len()]; STAGES.len()];
    for (column, (index, set)) in COLUMNS.iter().enumerate() {
        let name = format!("{SCENE},{index},{set},");
        let task =
            tasks.iter().position(|task| task.starts_with(&name)).ok_or_else(|| format!("{TASKS}: no {name}"))?;
        // The last instruction set is the one of the table.
        let dump = before + (LANES.len() - 1) * tasks.len() + task + 1;
        let executed = executed(&read(counts.with_extension(dump.to_string()))?, &program)?;
        let stages = stages(&program, &executed)?;
        for (count, stage) in executed.values().zip(stages) {
            table[stage][column] += count;
        }
    }
    write(&table)
}

/// Compiles the program of tests/instructions with line tables, and returns its path.
fn build() -> Result<std::path::PathBuf, String> {
    let mut cargo = command("cargo test --locked --release --no-run --test instructions --message-format=json");
    cargo.env("CARGO_PROFILE_RELEASE_DEBUG", "line-tables-only");
    cargo.env("CARGO_TARGET_DIR", target("account"));
    let messages = output(cargo.stderr(std::process::Stdio::inherit()))?;
    let program = messages.split("\"executable\":\"").nth(1).and_then(|rest| rest.split('"').next());
    program.map(Into::into).ok_or_else(|| "cargo names no program".to_owned())
}

/// Returns how often each instruction of the program was executed, by its address, from a file of callgrind. Those of
/// system libraries have the address 0.
fn executed(dump: &str, program: &Path) -> Result<BTreeMap<u64, u64>, String> {
    let mut counts = BTreeMap::new();
    let (mut address, mut object, mut program_object) = (0u64, "", "");
    let (mut is_call, mut sum) = (false, 0);
    for line in dump.lines() {
        if let Some(rest) = line.strip_prefix("ob=").or_else(|| line.strip_prefix("cob=")) {
            let (number, name) = rest.split_once(' ').unwrap_or((rest, ""));
            if Path::new(name) == program {
                program_object = number;
            }
            // A called function may be in another object, but its instructions are not in the lines that follow.
            if line.starts_with("ob=") {
                object = number;
            }
            continue;
        }
        if line.starts_with("calls=") {
            is_call = true;
            continue;
        }
        let is_cost = line.starts_with(|first: char| first.is_ascii_digit() || "+-*".contains(first));
        let Some((position, count)) = line.split_once(' ').filter(|_| is_cost) else { continue };
        let number = |text: &str| text.parse::<u64>().map_err(|_| format!("not a line of callgrind: {line}"));
        address = match position.split_at(1) {
            ("+", step) => address + number(step)?,
            ("-", step) => address - number(step)?,
            ("*", _) => address,
            _ => u64::from_str_radix(position.trim_start_matches("0x"), 16).map_err(|e| format!("{line}: {e}"))?,
        };
        // The line after a call has what the called function executed, which has lines of its own.
        if !std::mem::take(&mut is_call) {
            let count = number(count)?;
            sum += count;
            *counts.entry(if object == program_object { address } else { 0 }).or_default() += count;
        }
    }
    let total = dump.lines().find_map(|line| line.strip_prefix("summary: ")?.trim().parse().ok());
    if total == Some(sum) { Ok(counts) } else { Err(format!("{sum} instructions in a file of {total:?}")) }
}

/// Returns the number of the stage of each instruction.
fn stages(program: &Path, executed: &BTreeMap<u64, u64>) -> Result<Vec<usize>, String> {
    let addresses = executed.keys().map(|address| format!("{address:#x}"));
    // A line of the command has room for so many addresses.
    let mut lines = String::new();
    for some in addresses.collect::<Vec<_>>().chunks(5000) {
        let options = "addr2line --addresses --inlines --functions --demangle --exe";
        lines += &output(command(options).arg(program).args(some))?;
    }
    // Each address is followed by the functions that were inlined there, each with its file and line.
    let stage = |text: &str| {
        let lines: Vec<&str> = text.lines().skip(1).collect();
        let function = |pair: &[&str]| {
            let name = pair[0].split('<').next()?.rsplit("::").next()?;
            let file = pair.get(1)?.rsplit('/').next()?.split(':').next()?;
            Some(format!("{name}@{file}"))
        };
        let functions: Vec<String> = lines.chunks(2).filter_map(function).collect();
        let is_named = |name: &&str| {
            functions.iter().any(|function| {
                if name.starts_with('@') { function.ends_with(name) } else { function.starts_with(name) }
            })
        };
        STAGES.iter().position(|(_, names)| names.split(' ').any(|name| is_named(&name))).unwrap_or(STAGES.len() - 1)
    };
    let found: Vec<usize> = lines.split("\n0x").map(stage).collect();
    if found.len() == executed.len() { Ok(found) } else { Err("addr2line left out addresses".to_owned()) }
}

/// Writes the table into the document.
fn write(table: &[[u64; COLUMNS.len()]]) -> Outcome {
    let heads = COLUMNS.map(|(index, set)| format!(" {index}, `{set}` |")).concat();
    let mut text = format!("| stage |{heads}\n|---|{}\n", "--:|".repeat(COLUMNS.len()));
    let row = |name: &str, counts: [u64; COLUMNS.len()]| {
        let cells = counts.map(|count| format!(" {} |", (count + QUERIES / 2) / QUERIES)).concat();
        format!("| {name} |{cells}\n")
    };
    for ((name, _), counts) in STAGES.iter().zip(table) {
        text += &row(name, *counts);
    }
    text += &row("**all**", std::array::from_fn(|column| table.iter().map(|counts| counts[column]).sum()));
    print!("{text}");
    let document = read(DOCUMENT)?;
    let parts = document.split_once(MARKS[0]).and_then(|(head, rest)| Some((head, rest.split_once(MARKS[1])?.1)));
    let (head, tail) = parts.ok_or_else(|| format!("{DOCUMENT} has no place for the table"))?;
    let new = format!("{head}{}\n{text}\n{}{tail}", MARKS[0], MARKS[1]);
    crate::write(DOCUMENT, new)
}
