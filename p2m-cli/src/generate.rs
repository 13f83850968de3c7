//! `p2m generate`: scenes made from nothing.

use crate::output::Output;
use anyhow::Context;
use clap::Subcommand;
use p2m_mixed::generate::{KnotAndCables, knot_and_cables};
use std::path::PathBuf;

/// Write a synthetic scene
#[derive(clap::Args)]
#[command(after_help = "Example:\n  p2m generate knot-and-cables --out knot_and_cables.obj")]
pub(crate) struct Args {
    #[command(subcommand)]
    scene: Scene,
}

#[derive(Subcommand)]
enum Scene {
    /// A torus knot of triangles with cables of segments around it, as OBJ
    #[command(after_help = "Example:\n  p2m generate knot-and-cables --rings 600 --sides 24 --out fine.obj")]
    KnotAndCables {
        /// Where to write the scene; `-` is the standard output
        #[arg(long, value_name = "FILE", default_value = "-")]
        out: PathBuf,
        /// Rings of vertices along the knot
        #[arg(long, default_value_t = KnotAndCables::default().rings, value_parser = clap::value_parser!(u32).range(3..))]
        rings: u32,
        /// Vertices of each ring
        #[arg(long, default_value_t = KnotAndCables::default().sides, value_parser = clap::value_parser!(u32).range(3..))]
        sides: u32,
        /// Cables
        #[arg(long, default_value_t = KnotAndCables::default().cables)]
        cables: u32,
        /// Segments of each cable
        #[arg(long, default_value_t = KnotAndCables::default().cable_segments, value_parser = clap::value_parser!(u32).range(1..))]
        cable_segments: u32,
    },
}

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let Scene::KnotAndCables { out, rings, sides, cables, cable_segments } = &args.scene;
    let options = KnotAndCables::default()
        .with_rings(*rings)
        .with_sides(*sides)
        .with_cables(*cables)
        .with_cable_segments(*cable_segments);
    let soup = knot_and_cables(&options)?;
    let mut output = Output::open(Some(out))?;
    p2m_mixed::write_obj(&soup.into(), &mut output).with_context(|| output.cannot_write())?;
    output.finish()
}
