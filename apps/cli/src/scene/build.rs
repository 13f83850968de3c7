//! `p2m build`: saves an index in a file that other commands use.

use crate::answers::IndexSummary;
use crate::index::IndexArgs;
use crate::io::{Output, Streams, json, shown, usage};
use anyhow::Context;
use p2m_core::storage::Writer;
use p2m_mixed::statistics::figure::{Count, Time};
use p2m_mixed::{Format, save_scene};
use serde_json::json;
use std::path::PathBuf;
use std::time::Instant;

const HELP: &str = "\
The file also has the scene, so every command accepts it as a scene. A command that needs another backend or another \
--k builds its own index from it.

Programs with the same version of the format can read the file, on little-endian processors. It is checked before \
use: damaged, truncated and contradictory files are refused. p2m replaces a file by a new one, which does not \
disturb commands that have mapped the old one. Never change a mapped file in place.

Examples:
  p2m build bunny.obj --backend p2m --out bunny.p2m
  p2m query bunny.p2m --random 100000 --out answers.csv
  p2m build turned.stl --backend kdop --k 18 --out turned.p2m";

/// Build an index and save it
#[derive(clap::Args)]
#[command(after_help = HELP)]
pub(crate) struct Args {
    #[command(flatten)]
    index_args: IndexArgs,

    /// Write the index to this file, such as scene.p2m
    #[arg(long, value_name = "FILE")]
    out: PathBuf,

    /// Print the summary as JSON
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(streams: &Streams, args: &Args) -> anyhow::Result<()> {
    let scene_args = &args.index_args.scene;
    args.index_args.check()?;
    if let Some(backend) = args.index_args.named().filter(|backend| !backend.is_saveable()) {
        return Err(usage(format!("--backend {backend} has no index to save")));
    }
    args.index_args.p2m.check_saveable()?;
    Output::refuse_report(args.json, &args.out, "the index has to go to a file")?;
    Output::refuse_inputs(&args.out, &[&scene_args.path])?;
    Output::refuse_terminal(streams, &args.out, Format::P2m.name())?;
    let format = scene_args.format()?;
    let session = args.index_args.threads.start(streams)?;
    let mut file = scene_args.read(&session, format)?;
    // The index of a saved file is built again.
    file.saved = None;
    // The file is opened before the work, which would be lost if its name were wrong.
    let mut output = Output::open(streams, Some(&args.out))?;

    let start = Instant::now();
    let chosen = args.index_args.choice(&session, &file)?;
    let prepared = file.prepare(&session, chosen)?;
    let build_time = start.elapsed();

    let start = Instant::now();
    output = output.with_progress(streams);
    let mut writer = Writer::default();
    save_scene(&file.scene, &mut writer);
    prepared.built.save(&mut writer);
    writer.write(&mut output).with_context(|| output.cannot_write())?;
    let bytes = output.bytes();
    output.finish()?;
    let write_time = start.elapsed();

    let index = IndexSummary::new(&file, prepared.backend.name, Some(&prepared), build_time);
    let out = shown(&args.out);
    if args.json {
        let end = json!({
            "threads": session.pool.current_num_threads(),
            "cells": index.cells(),
            "seconds": index.seconds("write", write_time),
            "out": { "file": out, "bytes": bytes },
        });
        return json::print_report(streams, "build", [index.json(), end]);
    }
    let (text, bytes, time) = (index.text(None), Count(bytes), Time(write_time));
    streams.print_summary(format_args!("{text}written  {out}, {bytes} bytes in {time}\n"));
    Ok(())
}
