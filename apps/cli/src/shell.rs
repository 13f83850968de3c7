//! `p2m completions` and `p2m man`: completions of shells and manual pages.

use crate::io::{Output, Streams};
use anyhow::Context;
use clap_complete::Shell;
use std::path::{Path, PathBuf};

/// Print completions for a shell
#[derive(clap::Args)]
#[command(after_help = COMPLETIONS)]
pub(crate) struct Completions {
    /// The shell
    #[arg(value_enum)]
    shell: Shell,
}

const COMPLETIONS: &str = "\
Examples:
  p2m completions bash > ~/.local/share/bash-completion/completions/p2m
  p2m completions zsh > ~/.zfunc/_p2m
  p2m completions fish > ~/.config/fish/completions/p2m.fish";

/// Print the manual page, or write the pages of all commands
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  p2m man | man -l -\n  p2m man --out ~/.local/share/man/man1")]
pub(crate) struct Man {
    /// Write a page for each command into this folder
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub(crate) fn completions(streams: &Streams, args: &Completions, mut command: clap::Command) -> anyhow::Result<()> {
    // The script is generated in memory, because the generator panics when its output is closed.
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut command, "p2m", &mut script);
    Output::print(streams, script)
}

pub(crate) fn man(streams: &Streams, args: &Man, mut command: clap::Command) -> anyhow::Result<()> {
    command.build();
    let Some(folder) = &args.out else { return Output::print(streams, page(&command)?) };
    std::fs::create_dir_all(folder).with_context(|| format!("{}: cannot be made", folder.display()))?;
    write_pages(streams, folder, &command)
}

/// Writes the page of a command and those of its subcommands, with names like `p2m-generate-knot.1`.
fn write_pages(streams: &Streams, folder: &Path, command: &clap::Command) -> anyhow::Result<()> {
    let name = command.get_display_name().unwrap_or_else(|| command.get_name());
    Output::open(streams, Some(&folder.join(format!("{name}.1"))))?.finish_with(page(command)?)?;
    command.get_subcommands().filter(|c| c.get_name() != "help").try_for_each(|c| write_pages(streams, folder, c))
}

fn page(command: &clap::Command) -> anyhow::Result<Vec<u8>> {
    let mut page = Vec::new();
    clap_mangen::Man::new(command.clone()).render(&mut page).context("the manual page cannot be made")?;
    Ok(page)
}
