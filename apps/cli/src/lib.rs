//! The program `p2m` as a function, so that tests and other programs can run it within themselves.
//!
//! `p2m` reads a scene, computes closest points or hits of rays, and writes a table; `p2m --help` lists all commands.

#![deny(unsafe_code)]

mod answers;
mod compare;
mod index;
mod io;
mod measure;
mod page;
mod query;
mod ray;
mod scene;
mod shell;

pub use io::interrupt::listen;
pub use io::streams::Streams;
/// The measuring loop of `p2m tradeoff`, for p2m-bench. It may change in any release.
#[doc(hidden)]
pub use measure::harness;

use crate::compare::deviation::NotPassed;
use crate::io::limits::{Change, Limits};
use clap::{ArgMatches, CommandFactory, FromArgMatches, Parser, Subcommand};
use std::ffi::OsString;
use std::io::{ErrorKind, Write};

/// Closest points and hits of rays in scenes of triangles, segments and points
#[derive(Parser)]
#[command(name = "p2m", version, after_help = help())]
struct Cli {
    /// Print errors only: no summary, notes or progress
    #[arg(long, short, global = true)]
    quiet: bool,

    #[arg(long, global = true, value_name = "NAME=VALUE", value_parser = Change::parse, hide_short_help = true, help = Limits::HELP)]
    read_limit: Vec<Change>,

    #[command(subcommand)]
    command: Command,
}

fn help() -> String {
    format!(
        "\
Scenes are {} files, and indexes that `p2m build` saved. A `-` in place of a file name is the standard input or \
output.

The exit code is 0 for success, 1 if something could not be read, written or computed, 2 for wrong usage, 3 if \
`p2m deviation --require` fails, and 130 \
after Ctrl-C (128 plus the number of any other signal). An interrupted run leaves no half-written file. While a \
progress bar says so, the first Ctrl-C only ends the refinement of an octree, and the run continues with a coarser \
index.

Reports of --json are one object. Its key \"p2m\" names the report, and \"version\" (now {}) its version. Within a \
version, keys may be added, but none is removed, renamed or redefined. Lengths are in the unit of the scene and \
times in seconds. Values that do not exist or are infinite are null.

Examples:
  p2m query scene.obj --random 1000 --out answers.csv
  p2m ray scene.obj --random 1000 --out hits.csv
  p2m info scene.obj
  p2m convert scene.obj scene.ply
  p2m generate torus-knot --out knot.obj",
        io::input::format_list(p2m_formats::FileFormat::all(), "and"),
        io::json::VERSION
    )
}

#[derive(Subcommand)]
enum Command {
    Query(query::Args),
    Build(scene::build::Args),
    Shard(scene::shard::Args),
    Distance(compare::distance::Args),
    Hausdorff(compare::hausdorff::Args),
    Deviation(compare::deviation::Args),
    Align(compare::align::Args),
    Stats(measure::stats::Args),
    Field(query::field::Args),
    Sample(query::sample::Args),
    Advise(measure::advise::Args),
    Tradeoff(measure::tradeoff::Args),
    Ray(ray::Args),
    Info(scene::info::Args),
    Convert(scene::convert::Args),
    Generate(scene::generate::Args),
    Boxes(page::boxes::Args),
    View(page::view::Args),
    Completions(shell::Completions),
    Man(shell::Man),
}

impl Command {
    fn run(&self, streams: &Streams) -> anyhow::Result<()> {
        match self {
            Self::Query(args) => query::run(streams, args),
            Self::Build(args) => scene::build::run(streams, args),
            Self::Shard(args) => scene::shard::run(streams, args),
            Self::Distance(args) => compare::distance::run(streams, args),
            Self::Hausdorff(args) => compare::hausdorff::run(streams, args),
            Self::Deviation(args) => compare::deviation::run(streams, args),
            Self::Align(args) => compare::align::run(streams, args),
            Self::Stats(args) => measure::stats::run(streams, args),
            Self::Field(args) => query::field::run(streams, args),
            Self::Sample(args) => query::sample::run(streams, args),
            Self::Advise(args) => measure::advise::run(streams, args),
            Self::Tradeoff(args) => measure::tradeoff::run(streams, args),
            Self::Ray(args) => ray::run(streams, args),
            Self::Info(args) => scene::info::run(streams, args),
            Self::Convert(args) => scene::convert::run(streams, args),
            Self::Generate(args) => scene::generate::run(streams, args),
            Self::Boxes(args) => page::boxes::run(streams, args),
            Self::View(args) => page::view::run(streams, args),
            Self::Completions(args) => shell::completions(streams, args, command()),
            // Manual pages have the text of the help in one piece.
            Self::Man(args) => shell::man(streams, args, Cli::command()),
        }
    }
}

/// Options that few users need. They are in `--help`, under a heading of their own, and not in `-h`.
const ADVANCED: &str = "\
    box_scale displace_seed drop_isolated farthest filter format from histogram k limit locator map \
    max_memory max_queries max_visits only_outside out_format points_columns points_format points_id \
    rays_format read_limit round_seconds scan_columns scan_format second_format seed threads to";
/// The order of a help text: examples come before options.
const HELP_TEMPLATE: &str = "{about-with-newline}\n{usage-heading} {usage}\n\n{before-help}{all-args}{after-help}";
/// The line above the examples, which end the text of the help of each command.
const EXAMPLES: &str = "Examples:\n";
/// The number of examples that `-h` shows.
const SHORT_EXAMPLES: usize = 3;

/// Returns the grammar of the program, with its help in the order in which users need it.
fn command() -> clap::Command {
    arranged(Cli::command())
}

/// Moves examples before the options, and explanations and advanced options into the long help.
fn arranged(command: clap::Command) -> clap::Command {
    let help = command.get_after_help().map(ToString::to_string).unwrap_or_default();
    let (text, examples) = help.split_once(EXAMPLES).unwrap_or((&help, ""));
    let few: Vec<&str> = examples.lines().take(SHORT_EXAMPLES).collect();
    let (few, all) = (format!("{EXAMPLES}{}", few.join("\n")), format!("{EXAMPLES}{examples}"));
    let command = if examples.is_empty() { command } else { command.before_help(few).before_long_help(all) };
    command
        .help_template(HELP_TEMPLATE)
        .after_help("")
        .after_long_help(text.trim_end().to_owned())
        .mut_args(|argument| {
            let is_advanced = ADVANCED.split(' ').any(|name| argument.get_id() == name);
            if is_advanced { argument.help_heading("Advanced options").hide_short_help(true) } else { argument }
        })
        .mut_subcommands(arranged)
}

/// Runs the program with these arguments, of which the first is its name, and returns its exit code.
///
/// A run does not handle signals: a program that is to remove unfinished files at a signal calls [`listen`] first.
pub fn run(streams: &Streams, arguments: impl IntoIterator<Item = OsString>) -> u8 {
    let matches = streams.fit(command()).try_get_matches_from(arguments);
    let (path, command) = match matches.and_then(|matches| Ok((path(&matches), Cli::from_arg_matches(&matches)?))) {
        Ok((path, cli)) => {
            streams.set_quiet(cli.quiet);
            let limits = Limits::with(&cli.read_limit);
            streams.set_limits(limits);
            p2m_mixed::set_max_line_bytes(usize::try_from(limits.line).unwrap_or(usize::MAX));
            (path, cli.command)
        }
        Err(error) => {
            let shown = streams.show(&error);
            return match shown {
                _ if error.use_stderr() => 2,
                // A reader that closes the pipe early, such as `head`, is no error.
                Err(error) if error.kind() != ErrorKind::BrokenPipe => {
                    streams.show_error(&format!("the standard output: cannot be written: {error}"));
                    1
                }
                _ => 0,
            };
        }
    };
    match command.run(streams) {
        Ok(()) => 0,
        // A reader that closes the pipe early, such as `head`, is no error.
        Err(error) if is_closed_pipe(&error) => 0,
        Err(error) if error.is::<NotPassed>() => 3,
        Err(error) => {
            let mut message = format!("{error:#}");
            if message.contains(LINE_TOO_LONG) {
                message += " (--read-limit line=.. raises the limit)";
            }
            streams.show_error(&message);
            if error.is::<crate::io::usage::Usage>() {
                // An error of writing the message cannot be reported anywhere.
                let _ = writeln!(streams.stderr(), "\nFor more information, try '{path} --help'.");
                return 2;
            }
            1
        }
    }
}

/// Returns the words of the command line that select a command, such as `p2m generate sphere`.
fn path(matches: &ArgMatches) -> String {
    let names = std::iter::successors(matches.subcommand(), |(_, matches)| matches.subcommand());
    names.fold("p2m".to_owned(), |path, (name, _)| format!("{path} {name}"))
}

/// The part of the message for a line that is too long.
const LINE_TOO_LONG: &str = "a line has more than";

fn is_closed_pipe(error: &anyhow::Error) -> bool {
    error
        .chain()
        .any(|e| e.downcast_ref::<std::io::Error>().is_some_and(|e| e.kind() == std::io::ErrorKind::BrokenPipe))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Visits every command of the tree with the words that select it.
    fn visit_commands(command: &clap::Command, path: &str, visit: &mut impl FnMut(&clap::Command, &str)) {
        visit(command, path);
        for sub in command.get_subcommands() {
            visit_commands(sub, &format!("{path} {}", sub.get_name()), visit);
        }
    }

    /// Returns the lines of examples in the help of a command.
    fn examples(command: &clap::Command) -> Vec<String> {
        let help = command.get_after_help().map(ToString::to_string).unwrap_or_default();
        let examples = help.lines().filter(|line| line.starts_with("  p2m "));
        examples.map(|line| line.trim().to_owned()).collect()
    }

    #[test]
    fn the_grammar_is_sound() {
        Cli::command().debug_assert();
    }

    #[test]
    fn every_command_has_an_example_of_itself() {
        let mut count = 0;
        visit_commands(&Cli::command(), "p2m", &mut |command, path| {
            let examples = examples(command);
            assert!(examples.iter().any(|e| e.contains(path)), "{path}: {examples:?}");
            count += 1;
        });
        assert!(count > 15, "{count}");
    }

    #[test]
    fn short_help_fits_a_screen() {
        visit_commands(&command().term_width(100), "p2m", &mut |command, path| {
            let lines = command.clone().term_width(100).render_help().to_string().lines().count();
            assert!(lines <= 40, "{path}: {lines} lines");
        });
    }

    #[test]
    fn advanced_options_exist() {
        let mut names: Vec<String> = Vec::new();
        visit_commands(&Cli::command(), "p2m", &mut |command, _| {
            names.extend(command.get_arguments().map(|argument| argument.get_id().to_string()));
        });
        for name in ADVANCED.split(' ') {
            assert!(names.iter().any(|other| other == name), "{name}");
        }
    }

    /// Each `p2m` of a pipe in an example has to be parsed without an error.
    #[test]
    fn every_example_is_right_usage() {
        visit_commands(&Cli::command(), "p2m", &mut |command, path| {
            for example in examples(command) {
                let line = example.split(" > ").next().unwrap();
                for words in line.split(" | ").map(str::split_whitespace).filter(|w| w.clone().next() == Some("p2m")) {
                    let parsed = Cli::try_parse_from(words);
                    assert!(parsed.is_ok(), "{path}: {example}: {}", parsed.err().unwrap());
                }
            }
        });
    }
}
