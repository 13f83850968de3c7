//! `p2m stats`: what an index is made of and what its queries cost, in what does not depend on the machine.

use crate::backend::{Built, Closest, Source, Stages};
use crate::indexing::{Indexing, MANY};
use crate::input::read_scene_and_index;
use crate::json;
use crate::output::Output;
use crate::picture::write_png;
use crate::progress::{Progress, Unit};
use crate::sampling::{Queries, Region};
use crate::streams::Streams;
use crate::summary::Indexed;
use crate::usage::{positive, whole};
use anyhow::{Context, bail};
use nalgebra::{Point3, Vector3};
use p2m_bvh::AabbTree;
use p2m_core::{BuildIndex, ListStats, PrimitiveSet, QueryCost, RayQuery, Soup, Stat, StatsCollector};
use p2m_mixed::Camera;
use p2m_mixed::picture::{value_colours, write_values_ply};
use p2m_mixed::statistics::figure::Count;
use rayon::prelude::*;
use serde_json::{Value, json};
use std::fmt::{self, Write as _};
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::time::Instant;

fn help() -> String {
    format!(
        "\
A list holds the primitives that can be the nearest somewhere in a cell; trees have none. Its length, weighted by the volumes \
of the cells, is that of the list at a random point. Queries of trees visit nodes; all filter packets of up to sixteen \
primitives, and evaluate some of these exactly.

The picture of --out has each primitive in a colour of its own, from blue over green to red (in a PLY file with the number \
as the property 'value'): the length of the list at its middle, or (for trees) how many packets a query there filters. Colours go by the \
logarithm, from the least number to the largest.

{}

Examples:
  p2m stats bunny.obj --backend p2m
  p2m stats bunny.p2m --out lists.ply
  p2m stats bunny.obj --backend octree --out lists.png --eye=-1,0.5,1
  p2m stats scene.stl --backend octree --json",
        json::STABILITY
    )
}

/// Say what an index is made of and what its queries cost, and colour the scene by that
#[derive(clap::Args)]
#[command(after_help = help())]
pub(crate) struct Args {
    #[command(flatten)]
    indexing: Indexing,

    /// How many random points of the box, and how many middles of primitives, to ask about
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(..=100_000_000), default_value_t = 10_000, allow_negative_numbers = true)]
    queries: u64,

    /// Scale the box of the scene about its centre by this factor before filling it
    #[arg(long, value_name = "S", default_value_t = 1.05, value_parser = positive, allow_negative_numbers = true)]
    box_scale: f64,

    /// Seed of the random points
    #[arg(long, value_name = "SEED", default_value_t = 0, value_parser = whole, allow_negative_numbers = true)]
    seed: u64,

    /// Colour the scene: a name that ends in .ply or .png
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,

    /// How many pixels a PNG picture is wide
    #[arg(long, value_name = "N", default_value_t = 800, value_parser = clap::value_parser!(u32).range(1..=8192), allow_negative_numbers = true)]
    width: u32,

    /// From where a PNG picture is seen: the way from the middle of the scene, as x,y,z; y is up
    #[arg(long, value_name = "X,Y,Z", default_value = "0.45,0.4,1", value_parser = direction, allow_hyphen_values = true)]
    eye: Vector3<f64>,

    /// Report as one JSON object
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(streams: &Streams, args: &Args) -> anyhow::Result<()> {
    let scene_args = &args.indexing.scene;
    if let Some(out) = &args.out {
        if !is(out, "ply") && !is(out, "png") {
            bail!("{}: the name of a picture ends in .ply or .png", out.display());
        }
        Output::refuse_inputs(out, &[&scene_args.path])?;
    }
    let format = scene_args.format()?;
    let start = Instant::now();
    let (scene, saved) = read_scene_and_index(streams, &scene_args.path, format)?;
    let read = start.elapsed();
    let picture = args.out.as_ref().map(|out| Output::open(streams, Some(out))).transpose()?;

    let start = Instant::now();
    let saved = saved.as_ref();
    let (backend, faces) = args.indexing.choice(saved, &scene.soup, MANY)?;
    let source = Source { soup: &scene.soup, faces, saved };
    let Built { index, about, loaded, stages } = backend.build(streams, source).with_context(|| scene_args.name())?;
    let build = start.elapsed();

    let progress = Progress::start(streams, "asking", None, Unit::None);
    let region = Region::around(&scene.soup, args.box_scale);
    let random: Vec<_> = Queries::random(region, args.queries, args.seed).collect();
    let stats = Stats {
        lists: ListStats::of(&*index),
        in_box: QueryCost::of(&*index, &random),
        on_scene: QueryCost::of(&*index, &some_middles(&scene.soup, args.queries)),
        asked: random.len() as u64,
        parts: index.parts(),
        stages,
        primitives: scene.soup.len(),
        loaded,
    };
    if let Some(mut output) = picture {
        let values: Vec<f64> = middles(&scene.soup).map(|middle| value(&*index, &middle)).collect();
        if args.out.as_ref().is_some_and(|out| is(out, "ply")) {
            write_values_ply(&scene.soup, &values, &mut output).with_context(|| output.cannot_write())?;
        } else {
            args.draw(&scene.soup, &values, &mut output)?;
        }
        output.finish()?;
    }
    drop(progress);

    let (scene_name, backend) = (scene_args.name(), backend.name());
    let indexed = Indexed { scene_name, scene: &scene, format, backend, about, loaded, read, build };
    if args.json {
        let end = json!({
            "cells": indexed.cells(),
            "seconds": { "read": read.as_secs_f64(), "build": build.as_secs_f64() },
            "out": args.out.as_ref().map(|out| json!({ "file": out.display().to_string() })),
        });
        return json::print(streams, &json::joined([indexed.json("stats"), stats.json(), end]));
    }
    let mut text = String::new();
    // Nothing fails in writing to memory.
    let _ = indexed.write(&mut text, None);
    let _ = write!(text, "{stats}");
    let mut output = Output::open(streams, None)?;
    output.write_all(text.as_bytes()).with_context(|| output.cannot_write())?;
    output.finish()
}

fn is(path: &Path, extension: &str) -> bool {
    path.extension().is_some_and(|own| own.eq_ignore_ascii_case(extension))
}

fn direction(text: &str) -> Result<Vector3<f64>, String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|x| x.trim().parse().ok()).collect();
    let numbers = numbers.and_then(|numbers| <[f64; 3]>::try_from(numbers).ok()).map(Vector3::from);
    let sideways = |v: &Vector3<f64>| v.iter().all(|x| x.is_finite()) && v.cross(&Vector3::y()).norm() > 0.0;
    numbers.filter(sideways).ok_or_else(|| "not three numbers x,y,z that lead sideways".to_owned())
}

impl Args {
    /// Draws the scene in colours: what the ray through each pixel meets first, darker where it is met askew.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to 255")]
    fn draw(&self, soup: &Soup<f64>, values: &[f64], output: &mut Output<'_>) -> anyhow::Result<()> {
        let camera = Camera::before(soup, &self.eye, self.width).filter(|_| !soup.is_empty());
        let camera = camera.context("nothing to draw: the scene is empty or has no extent")?;
        let tree = AabbTree::build(soup, &Default::default())?;
        let colours = value_colours(values);
        let [width, height] = camera.size();
        let pixel = |row: u32, column: u32| -> [u8; 3] {
            let ray = camera.ray([f64::from(column) + 0.5, f64::from(row) + 0.5]);
            let Some(hit) = tree.first_intersection(&ray) else { return [255; 3] };
            let light = match soup.get(hit.primitive).vertices() {
                [a, b, c] => {
                    let normal = (b - a).cross(&(c - a));
                    normal.try_normalize(0.0).map_or(1.0, |n| 0.45 + 0.55 * n.dot(&camera.axes()[2]).abs())
                }
                _ => 1.0,
            };
            colours[hit.primitive.index()].map(|x| (f64::from(x) * light).round() as u8)
        };
        let rows = (0..height).into_par_iter();
        let bytes: Vec<u8> = rows.flat_map_iter(|row| (0..width).flat_map(move |column| pixel(row, column))).collect();
        write_png(output, [width, height], &bytes)
    }
}

/// The middles of the vertices of all primitives.
fn middles(soup: &Soup<f64>) -> impl Iterator<Item = Point3<f64>> + '_ {
    (0..soup.len()).map(|i| {
        let vertices = soup.get(p2m_core::PrimitiveId::new(i));
        let vertices = vertices.vertices();
        let part = 1.0 / vertices.len() as f64;
        Point3::from(vertices.iter().map(|v| v.coords * part).sum::<nalgebra::Vector3<f64>>())
    })
}

/// Evenly chosen ones.
#[allow(clippy::cast_possible_truncation, reason = "at most as many as there are primitives")]
fn some_middles(soup: &Soup<f64>, count: u64) -> Vec<Point3<f64>> {
    let count = count.min(soup.len() as u64) as usize;
    middles(soup).step_by(soup.len().div_ceil(count.max(1)).max(1)).take(count).collect()
}

/// What a primitive is coloured by.
fn value(index: &dyn Closest, middle: &Point3<f64>) -> f64 {
    let packets = || StatsCollector::of_query(middle, |query, counting| index.inspect(query, counting))[1];
    index.list_length(middle).unwrap_or_else(packets) as f64
}

struct Stats {
    lists: Option<ListStats>,
    in_box: QueryCost,
    on_scene: QueryCost,
    /// How many random points.
    asked: u64,
    parts: Vec<(&'static str, usize)>,
    stages: Stages,
    primitives: usize,
    loaded: bool,
}

impl Stats {
    fn json(&self) -> Value {
        let load = |load: &Stat| json!({ "mean": load.mean, "most": load.most });
        let visits = |visits: &QueryCost| {
            json!({
                "nodes": load(&visits.nodes),
                "packets": load(&visits.packets),
                "primitives": load(&visits.primitives),
                "list": self.lists.map(|_| visits.list),
                "without_list": self.lists.map(|_| visits.without_list),
            })
        };
        let lists = self.lists.map(|lists| {
            json!({
                "count": lists.count,
                "mean": lists.mean,
                "median": lists.median,
                "percent_90": lists.percent_90,
                "percent_99": lists.percent_99,
                "most": lists.most,
            })
        });
        let parts: serde_json::Map<_, _> = self.parts.iter().map(|(name, n)| ((*name).to_owned(), json!(n))).collect();
        let stages: serde_json::Map<_, _> =
            self.stages.iter().map(|(stage, time)| (stage.name().to_owned(), json!(time.as_secs_f64()))).collect();
        json!({
            "lists": lists,
            "queries": self.asked,
            "in_box": visits(&self.in_box),
            "on_scene": visits(&self.on_scene),
            "memory": parts,
            "stages": stages,
        })
    }
}

impl fmt::Display for Stats {
    #[allow(clippy::cast_precision_loss, reason = "bytes for people to read")]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(lists) = &self.lists {
            let ListStats { count, mean, median, percent_90, percent_99, most, .. } = lists;
            writeln!(
                f,
                "lists    {}: {mean:.1} primitives on average; half up to {median}, 90 % up to {percent_90}, 99 % up to \
                 {percent_99}, all up to {most}",
                Count(*count as u64)
            )?;
            let QueryCost { list, without_list, .. } = self.in_box;
            writeln!(
                f,
                "volume   {list:.1} primitives in the list at a random point; the tree answers {:.1} %",
                100.0 * without_list
            )?;
        }
        for (places, visits) in [("in the box", &self.in_box), ("on the scene", &self.on_scene)] {
            let QueryCost { nodes, packets, primitives, .. } = visits;
            writeln!(
                f,
                "queries  {places}: {:.2} nodes, {:.2} packets, {:.2} primitives each; at most {}, {}, {}",
                nodes.mean, packets.mean, primitives.mean, nodes.most, packets.most, primitives.most
            )?;
        }
        if !self.stages.is_empty() {
            let stages: Vec<String> =
                self.stages.iter().map(|(stage, time)| format!("{} {time:.3?}", stage.name())).collect();
            writeln!(f, "stages   {}", stages.join(", "))?;
        }
        if self.loaded {
            return writeln!(f, "memory   that of the file");
        }
        let total: usize = self.parts.iter().map(|part| part.1).sum();
        let held = self.parts.iter().filter(|part| part.1 > 0);
        let parts: Vec<String> = held.map(|(name, bytes)| format!("{name} {:.1} MB", *bytes as f64 / 1e6)).collect();
        if !parts.is_empty() {
            let each = total as f64 / self.primitives.max(1) as f64;
            writeln!(f, "memory   {}: {each:.0} bytes a primitive", parts.join(", "))?;
        }
        Ok(())
    }
}
