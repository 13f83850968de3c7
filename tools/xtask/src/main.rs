//! The tasks for changing p2m, each as one command: `cargo xtask` lists them.
//!
//! A task prints the commands that it starts, so that each can be started alone. The first command that fails ends it.
#![forbid(unsafe_code)]

mod account;
mod arm;
mod budget;
mod builds;
mod c;
mod cuda;
mod debian;
mod deep;
mod figures;
mod links;
mod memory;
mod package;
mod pages;
mod platforms;
mod promises;
mod python;
mod release;
mod site;
mod tools;
mod wasm;
mod workflows;

use std::ffi::OsString;
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// Why a task ends before its end.
enum Stop {
    /// Something that it needs is not here.
    Skipped(String),
    Failed(String),
}

impl<S: Into<String>> From<S> for Stop {
    fn from(why: S) -> Self {
        Self::Failed(why.into())
    }
}

/// The result of a task.
type Outcome<T = ()> = Result<T, Stop>;

/// The tasks, each with its arguments and with what it does.
const TASKS: &str = "\
quick [FILTER]                  Test the contract and the agreement of all backends, or the tests that a filter names
test [FILTER]                   Run all tests, with a small part of their cases
deep [FILTER]                   Run all tests with all of their cases, and count these
lint                            Check the format and the lints of all code
budget [--write] [--llvm]       Compare lines, public names, crates and import circles with budget.csv, or renew that
docs                            Make the documentation, in which no link may be broken
figures [--check]               Renew the figures of the documents from docs/measurements, or check them
site                            Check the links of all documents, and build the site of docs below target/book
promises [--all]                Check what the manifests promise: lock files, Rust versions, crates of builds, each feature
wasm [--all|--build]            Check the library for WebAssembly, also its answers, or build the module of pages
arm [--all|--instructions]      Run tests for ARM under qemu: of lanes, or all that concern answers
platforms [--wine|TARGET..]     Check that all compiles for other platforms, or run tests for Windows under wine
cuda [--build]                  Check that the kernels for cards are those of their sources, or compile them
release [TARGET]                Build the program and the wheel of the Python package, as a release has them
workflows                       Check the workflows of hosted checks with actionlint
package                         Pack the crates as for publishing, and check what is in them and in their dependencies
python [--rivals] [FILTER]      Build the Python package and run its tests, or compare it with others
c [--build|--fuzz SECONDS]      Check the header of the C interface and test it, write the header, or fuzz it
pages                           Check the script of pages and test them in Chromium
js                              Build the npm package and test it in Node and in Chromium
fuzz [SECONDS] [TARGET]..       Fuzz each target for so many seconds, 60 by default
account                         Count the instructions of the stages of a search, and write the table of docs/batches.md
memory                          Run tests of unsafe code and of saved files under AddressSanitizer and valgrind
ci                              Run everything that a change has to pass";

/// Runs a task. What cannot be checked on this machine is skipped with a message.
fn run_task(name: &str, rest: &[String]) -> Outcome {
    match name {
        "quick" => start(command("cargo test --locked --package p2m --test all --").args(rest)),
        "test" => start(command("cargo test --locked --workspace").args(rest)),
        "deep" => deep::run(rest),
        "lint" => lint(),
        "budget" => budget::check(rest),
        "docs" => start(command("cargo doc --locked --workspace --no-deps").env("RUSTDOCFLAGS", "-D warnings")),
        "figures" => figures::run(rest),
        "site" => site::build(),
        "promises" => promises::check(rest),
        "wasm" => wasm::run(rest),
        "arm" => arm::run(rest),
        "platforms" => platforms::check(rest),
        "cuda" => cuda::run(rest),
        "release" => release::build(rest),
        "workflows" => workflows::check(),
        "package" => package::run(),
        "python" => python::check(rest),
        "c" => c::check(rest),
        "pages" => pages::run(),
        "js" => pages::package(),
        "fuzz" => start(command(if rest.is_empty() { "tools/fuzz/run 60" } else { "tools/fuzz/run" }).args(rest)),
        "account" => account::run(),
        "memory" => memory::run(),
        "ci" => start(command(".ci/run").args(rest)),
        _ => Err(format!("there is no task {name}\n\n{TASKS}").into()),
    }
}

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().unwrap_or_default();
    let rest: Vec<String> = arguments.collect();
    if ["", "help", "-h", "--help"].contains(&name.as_str()) {
        println!("Usage: cargo xtask TASK\n\n{TASKS}");
        return ExitCode::SUCCESS;
    }
    // Paths of tasks are relative to the workspace, wherever the task is called.
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let moved = std::env::set_current_dir(&root).map_err(|error| failed(&root, error).into());
    let outcome = moved.and_then(|()| check_arguments(&name, &rest)).and_then(|()| run_task(&name, &rest));
    match go_on(outcome) {
        Ok(()) => ExitCode::SUCCESS,
        Err(Stop::Skipped(why) | Stop::Failed(why)) => {
            eprintln!("error: {why}");
            ExitCode::FAILURE
        }
    }
}

/// Refuses arguments of a task that its line does not name.
fn check_arguments(name: &str, rest: &[String]) -> Outcome {
    let mut lines = TASKS.lines().filter_map(|line| line.strip_prefix(name)?.strip_prefix(' '));
    let usage = lines.next().and_then(|line| line.split("  ").next()).unwrap_or("..").trim();
    // A task whose line has words in capital letters checks its arguments itself.
    let takes_others = usage.contains("..") || usage.contains(|c: char| c.is_ascii_uppercase());
    let is_named = |argument: &String| usage.split(['[', '|', ']', ' ']).any(|word| word == argument);
    let fits = takes_others || rest.len() <= usage.matches('[').count() && rest.iter().all(is_named);
    if fits { Ok(()) } else { Err(format!("cargo xtask {name} {usage}: other arguments are not known").into()) }
}

/// Runs clippy: all lints for libraries and programs, while tests may compare floats exactly, cast, and panic.
fn lint() -> Outcome {
    run("cargo fmt --all --check")?;
    let clippy = "cargo clippy --locked --workspace --features p2m-cli/cuda,p2m-python/cuda";
    run(&format!("{clippy} --lib --bins -- -D warnings"))?;
    let allowed = "-A clippy::float_cmp -A clippy::cast_possible_truncation -A clippy::missing_panics_doc";
    run(&format!("{clippy} --tests --examples -- -D warnings {allowed}"))
}

/// Says why a check is skipped. It is an error where `P2M_REQUIRE_TOOLS` is set, as in hosted checks.
fn skip(why: &str) -> Outcome {
    if std::env::var_os("P2M_REQUIRE_TOOLS").is_some() {
        return Err(why.into());
    }
    println!("\n== skipped: {why}");
    // `.ci/run` counts the lines.
    let Some(list) = std::env::var_os("P2M_SKIPS") else { return Ok(()) };
    let list = fs::OpenOptions::new().create(true).append(true).open(list);
    let line = format!("a check: {}\n", why.lines().next().unwrap_or_default());
    list.and_then(|mut list| list.write_all(line.as_bytes())).map_err(|error| format!("P2M_SKIPS: {error}").into())
}

/// Goes on after what was skipped, with a message.
fn go_on(outcome: Outcome) -> Outcome {
    outcome.or_else(|stop| if let Stop::Skipped(why) = stop { skip(&why) } else { Err(stop) })
}

/// Turns an error into the reason to skip the rest of a task.
trait OrSkip<T> {
    fn or_skip(self, why: &str) -> Outcome<T>;
}

impl<T> OrSkip<T> for Result<T, String> {
    fn or_skip(self, why: &str) -> Outcome<T> {
        self.map_err(|error| Stop::Skipped(format!("{why}: {error}")))
    }
}

/// Skips the rest of a task where a program is missing.
fn need(program: &str) -> Outcome {
    output(Command::new(program).arg("--version")).map(drop).or_skip(&format!("there is no program '{program}'"))
}

/// Returns whether there is a program.
fn exists(program: &str) -> bool {
    need(program).is_ok()
}

/// Returns the absolute path of the folder for what is compiled and for files of tasks, or of something in it.
fn target(path: &str) -> PathBuf {
    let folder = std::env::var_os("CARGO_TARGET_DIR").unwrap_or_else(|| "target".into());
    std::path::absolute(folder).expect("the current folder exists").join(path)
}

/// Returns the path of a file that a build without `--release` makes for this machine.
fn debug_program() -> PathBuf {
    target("debug").join(format!("p2m{}", std::env::consts::EXE_SUFFIX))
}

/// Compiles what the tests of other languages need: libraries, examples and the program. The profile and the features are
/// about those of `cargo test --workspace`, so little is compiled after it, and nothing after another of these tasks.
fn build_for_tests() -> Outcome {
    let what = "--workspace --lib --examples --bin p2m --features p2m-python/cuda";
    run(&format!("cargo build --profile test --locked {what}"))
}

/// Returns the command of a line, whose words are separated by spaces.
fn command(line: &str) -> Command {
    let mut words = line.split_whitespace();
    let mut command = Command::new(words.next().unwrap_or_default());
    command.args(words);
    command
}

/// Runs the command of a line.
fn run(line: &str) -> Outcome {
    start(&mut command(line))
}

/// Prints a command, runs it and waits for its end.
fn start(command: &mut Command) -> Outcome {
    let set = command.get_envs().filter_map(|(name, value)| Some(format!("{}={:?}", name.display(), value?)));
    let words = std::iter::once(command.get_program()).chain(command.get_args()).map(|word| word.display().to_string());
    let line = set.chain(words).collect::<Vec<_>>().join(" ");
    println!("\n== {line}");
    let status = command.status().map_err(|error| format!("{line}: cannot be started: {error}"))?;
    if status.success() { Ok(()) } else { Err(format!("{line}: ended with {status}").into()) }
}

/// Returns the standard output of a command that succeeds.
fn output(command: &mut Command) -> Result<String, String> {
    let program = command.get_program().display().to_string();
    let output = command.output().map_err(|error| format!("{program}: {error}"))?;
    if !output.status.success() {
        return Err(format!("{program}: {}", String::from_utf8_lossy(&output.stderr).trim()));
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

/// Returns the message for an error of a file or folder.
fn failed(path: impl AsRef<Path>, error: impl std::fmt::Display) -> String {
    format!("{}: {error}", path.as_ref().display())
}

fn read(path: impl AsRef<Path>) -> Result<String, String> {
    fs::read_to_string(&path).map_err(|error| failed(path, error))
}

fn write(path: impl AsRef<Path>, content: impl AsRef<[u8]>) -> Outcome {
    fs::write(&path, content).map_err(|error| failed(path, error).into())
}

/// Makes a folder, and those around it.
fn make_folder(path: impl AsRef<Path>) -> Outcome {
    fs::create_dir_all(&path).map_err(|error| failed(path, error).into())
}

/// Makes a folder that is empty.
fn make_empty_folder(path: &Path) -> Outcome {
    if path.exists() {
        fs::remove_dir_all(path).map_err(|error| failed(path, error))?;
    }
    make_folder(path)
}

/// Returns what is in a folder, in order.
fn entries(folder: impl AsRef<Path>) -> Result<Vec<PathBuf>, String> {
    let found = fs::read_dir(&folder).map_err(|error| failed(folder, error))?;
    let mut paths: Vec<PathBuf> = found.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.sort();
    Ok(paths)
}

/// Returns the files in a folder and in those below it.
fn files_below(folder: impl AsRef<Path>) -> Result<Vec<PathBuf>, String> {
    let mut files = Vec::new();
    for path in entries(folder)? {
        if path.is_dir() { files.extend(files_below(&path)?) } else { files.push(path) }
    }
    Ok(files)
}

/// Copies a file, and makes the folder for it.
fn copy(from: &Path, to: &Path) -> Outcome {
    make_folder(to.parent().unwrap_or(to))?;
    fs::copy(from, to).map(drop).map_err(|error| failed(from, error).into())
}

/// Returns `PATH` with a folder in front, or behind with `is_last`.
fn path_with(folder: &Path, is_last: bool) -> Result<OsString, String> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let mut folders: Vec<PathBuf> = std::env::split_paths(&path).collect();
    folders.insert(if is_last { folders.len() } else { 0 }, folder.to_owned());
    std::env::join_paths(folders).map_err(|error| format!("PATH: {error}"))
}

/// Fails if there are faults, which the message lists.
fn fail_if_any(what: &str, faults: &[String]) -> Outcome {
    if faults.is_empty() { Ok(()) } else { Err(format!("{what}\n  {}", faults.join("\n  ")).into()) }
}

/// Returns a path as text.
fn text(path: impl AsRef<Path>) -> String {
    path.as_ref().display().to_string()
}

/// Compares a file of the repository with what its sources make, or with `builds` replaces it.
fn compare_or_write(file: &str, made: &str, task: &str, builds: bool) -> Outcome {
    if builds {
        return write(file, made);
    }
    let is_same = read(file)? == made;
    if is_same { Ok(()) } else { Err(format!("{file} is not that of its sources: run `{task}`").into()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arguments_are_those_that_the_list_of_tasks_names() {
        let fits = |line: &str| {
            let words: Vec<String> = line.split(' ').map(str::to_owned).collect();
            check_arguments(&words[0], &words[1..]).is_ok()
        };
        for line in ["wasm", "wasm --all", "c --fuzz 60", "quick a", "platforms a b", "fuzz 1 a b", "python --rivals b"]
        {
            assert!(fits(line), "{line}");
        }
        for line in ["lint a", "wasm --al", "wasm --all --build", "arm --build", "pages --all", "figures --check 1"] {
            assert!(!fits(line), "{line}");
        }
    }
}
