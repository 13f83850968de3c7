//! `p2m build`: an index in a file, for other commands to use.

use crate::backend::{About, Built, Source};
use crate::indexing::{Indexing, MANY};
use crate::input::read_scene;
use crate::json;
use crate::output::Output;
use crate::streams::Streams;
use crate::summary::Indexed;
use crate::usage::usage;
use anyhow::Context;
use p2m_core::storage::Writer;
use p2m_mixed::{Format, save_scene};
use serde_json::json;
use std::io::Write;
use std::path::PathBuf;
use std::time::Instant;

fn help() -> String {
    format!(
        "\
The file has the scene, too, so every command takes it in place of one. A command that searches by another backend, or with \
another --k, builds its own index from that scene.

Files are for the version of their format, and for processors that are little-endian. They are checked before use: what is \
damaged or cut off is refused. While a command uses a file it must not be changed; this one replaces a file at once, \
which harms nobody.

{}

Examples:
  p2m build bunny.obj --backend p2m --out bunny.p2m
  p2m query bunny.p2m --random 100000 --out answers.csv
  p2m build turned.stl --backend kdop --k 18 --out turned.p2m",
        json::STABILITY
    )
}

/// Build an index over a scene and save it, for other commands to load instead of building it
#[derive(clap::Args)]
#[command(after_help = help())]
pub(crate) struct Args {
    #[command(flatten)]
    indexing: Indexing,

    /// Where to write the file, usually a name that ends in .p2m
    #[arg(long, value_name = "FILE")]
    out: PathBuf,

    /// Report as one JSON object on the standard output, instead of a summary on the standard error
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(streams: &Streams, args: &Args) -> anyhow::Result<()> {
    let scene_args = &args.indexing.scene;
    args.indexing.check()?;
    if args.indexing.is_brute() {
        return Err(usage("--backend brute has no index to save"));
    }
    if args.json && crate::input::is_standard(&args.out) {
        return Err(usage("--json reports on the standard output, so the index has to go to a file"));
    }
    Output::refuse_inputs(&args.out, &[&scene_args.path])?;
    Output::refuse_terminal(streams, &args.out, Format::P2m.name())?;
    let format = scene_args.format()?;
    let start = Instant::now();
    let scene = read_scene(streams, &scene_args.path, format)?;
    let read = start.elapsed();
    // Before any work, so that it is not lost to a wrong name.
    let mut output = Output::open(streams, Some(&args.out))?;

    let start = Instant::now();
    let (backend, faces) = args.indexing.choice(None, &scene.soup, MANY)?;
    let source = Source { soup: &scene.soup, faces, saved: None };
    let Built { index, about, loaded, .. } = backend.build(streams, source).with_context(|| scene_args.name())?;
    let build = start.elapsed();

    let start = Instant::now();
    output = output.with_progress(streams);
    let mut writer = Writer::default();
    save_scene(&scene, &mut writer);
    index.save(&mut writer);
    if let About::Faces(used) = &about {
        used.save(&mut writer);
    }
    writer.write(&mut output).with_context(|| output.cannot_write())?;
    let bytes = output.bytes();
    output.finish()?;
    let written = start.elapsed();

    let (scene_name, backend) = (scene_args.name(), backend.name());
    let indexed = Indexed { scene_name, scene: &scene, format, backend, about, loaded, read, build };
    let out = args.out.display();
    if args.json {
        let end = json!({
            "cells": indexed.cells(),
            "seconds": {
                "read": read.as_secs_f64(),
                "build": build.as_secs_f64(),
                "write": written.as_secs_f64(),
            },
            "out": { "file": out.to_string(), "bytes": bytes },
        });
        return json::print(streams, &json::joined([indexed.json("build"), end]));
    }
    let mut text = String::new();
    // Nothing fails in writing to memory; the file is complete, and whether anybody reads this is not our concern.
    let _ = indexed.write(&mut text, None);
    let _ = writeln!(streams.stderr(), "{text}written  {out}, {bytes} bytes in {written:.3?}");
    Ok(())
}
