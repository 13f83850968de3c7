//! `p2m stats`: the parts of an index and the costs of its queries, in counts that do not depend on the machine.

use crate::answers::{IndexSummary, Queries, Region};
use crate::index::{IndexArgs, PreparedIndex};
use crate::io::input::has_extension;
use crate::io::usage::{positive, whole_number};
use crate::io::{Output, Progress, Streams, Unit, json, shown};
use crate::page::camera::Camera;
use crate::page::drawing::{value_colours, write_values_ply};
use crate::page::picture::write_png;
use anyhow::{Context, bail};
use nalgebra::{Point3, Vector3};
use p2m_backends::AnyIndex;
use p2m_bvh::AabbTree;
use p2m_core::engine::parallel;
use p2m_core::{ListStats, PrimitiveSet, QueryCost, QueryOptions, RayQuery, Soup, Stat};
use p2m_mixed::statistics::figure::{Count, Time};
use serde_json::{Value, json};
use std::fmt;
use std::path::PathBuf;
use std::time::Instant;

const HELP: &str = "\
Each cell of an octree or a P2M index has a list of the primitives that can be nearest in it; trees have no lists. \
The mean length is weighted by the volume of the cells, so it is the length to expect at a random point. All indexes \
filter packets of at most sixteen primitives, and evaluate some of these exactly.

--out colours each primitive from blue over green to red, on a logarithmic scale: by the length of the list at its \
centroid, or for trees by the number of packets that a query there filters. A PLY file also has the number, as the \
property 'value'.

Examples:
  p2m stats bunny.obj --backend p2m
  p2m stats bunny.p2m --out lists.ply
  p2m stats bunny.obj --backend octree --out lists.png --eye=-1,0.5,1
  p2m stats scene.stl --backend octree --json";

/// Show what an index consists of and what its queries cost
#[derive(clap::Args)]
#[command(after_help = HELP)]
pub(crate) struct Args {
    #[command(flatten)]
    index_args: IndexArgs,

    /// Query N random points and N centroids of primitives
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(..=100_000_000), default_value_t = 10_000, allow_negative_numbers = true)]
    queries: u64,

    /// Scale the box of the scene about its centre by this factor
    #[arg(long, value_name = "S", default_value_t = 1.05, value_parser = positive, allow_negative_numbers = true)]
    box_scale: f64,

    /// The seed of the random points
    #[arg(long, value_name = "SEED", default_value_t = 0, value_parser = whole_number, allow_negative_numbers = true)]
    seed: u64,

    /// Write the scene, coloured by cost (.ply or .png)
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,

    /// The width of a PNG picture in pixels
    #[arg(long, value_name = "N", default_value_t = 800, value_parser = clap::value_parser!(u32).range(1..=8192), allow_negative_numbers = true)]
    width: u32,

    /// The direction to the viewer of a PNG picture; y is up
    #[arg(long, value_name = "X,Y,Z", default_value = "0.45,0.4,1", value_parser = direction, allow_hyphen_values = true)]
    eye: Vector3<f64>,

    /// Print the result as JSON
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(streams: &Streams, args: &Args) -> anyhow::Result<()> {
    let scene_args = &args.index_args.scene;
    if let Some(out) = &args.out {
        if !has_extension(out, &["ply", "png"]) {
            bail!("{}: the name of a picture ends in .ply or .png", out.display());
        }
        Output::refuse_inputs(out, &[&scene_args.path])?;
    }
    let format = scene_args.format()?;
    let session = args.index_args.threads.start(streams)?;
    let file = scene_args.read(&session, format)?;
    let picture = args.out.as_ref().map(|out| Output::open(streams, Some(out))).transpose()?;

    let start = Instant::now();
    let chosen = args.index_args.choice(&session, &file)?;
    let prepared = file.prepare(&session, chosen)?;
    let (soup, index) = (&*file.scene.soup, &*prepared.built.index);
    let build_time = start.elapsed();

    let progress = Progress::start(streams, "querying", None, Unit::None);
    let region = Region::around(&soup.aabb(), args.box_scale);
    let random: Vec<_> = Queries::random(region, args.queries, args.seed).collect();
    let stats = IndexStats {
        lists: ListStats::from_index(index),
        in_box: QueryCost::measure(index, &random),
        on_scene: QueryCost::measure(index, &centroid_sample(soup, args.queries)),
        random_queries: random.len() as u64,
        memory: index.parts(),
        prepared: &prepared,
        primitives: soup.len(),
    };
    if let Some(mut output) = picture {
        let values: Vec<f64> = centroids(soup).map(|centroid| query_cost(index, &centroid)).collect();
        if args.out.as_ref().is_some_and(|out| has_extension(out, &["ply"])) {
            write_values_ply(soup, &values, &mut output).with_context(|| output.cannot_write())?;
        } else {
            args.draw(soup, &values, &mut output)?;
        }
        output.finish()?;
    }
    drop(progress);

    let index = IndexSummary::new(&file, prepared.backend.name, Some(&prepared), build_time);
    if args.json {
        let end = json!({
            "cells": index.cells(),
            "seconds": { "read": file.read_time.as_secs_f64(), "build": build_time.as_secs_f64() },
            "out": args.out.as_ref().map(|out| json!({ "file": shown(out) })),
        });
        return json::print_report(streams, "stats", [index.json(), stats.json(), end]);
    }
    Output::print(streams, format!("{}{stats}", index.text(None)))
}

/// Parses a direction that has an extent across the vertical axis.
fn direction(text: &str) -> Result<Vector3<f64>, String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|x| x.trim().parse().ok()).collect();
    let numbers = numbers.and_then(|numbers| <[f64; 3]>::try_from(numbers).ok()).map(Vector3::from);
    let is_sideways = |v: &Vector3<f64>| v.iter().all(|x| x.is_finite()) && v.cross(&Vector3::y()).norm() > 0.0;
    numbers.filter(is_sideways).ok_or_else(|| "not three numbers x,y,z that lead sideways".to_owned())
}

impl Args {
    /// Draws the scene in colours: the first hit of the ray through each pixel, darker where the surface is oblique
    /// to the view.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to 255")]
    fn draw(&self, soup: &Soup<f64>, values: &[f64], output: &mut Output<'_>) -> anyhow::Result<()> {
        let camera = Camera::before(soup, &self.eye, self.width).filter(|_| !soup.is_empty());
        let camera = camera.context("nothing to draw: the scene is empty or has no extent")?;
        let tree = AabbTree::new(soup)?;
        let colours = value_colours(values);
        let [width, height] = camera.size;
        let pixel = |row: u32, column: u32| -> [u8; 3] {
            let ray = camera.ray([f64::from(column) + 0.5, f64::from(row) + 0.5]);
            let Some(hit) = tree.first_intersection(&ray) else { return [255; 3] };
            let light = match soup.get(hit.primitive).vertices() {
                [a, b, c] => {
                    let normal = (b - a).cross(&(c - a));
                    normal.try_normalize(0.0).map_or(1.0, |n| 0.45 + 0.55 * n.dot(&camera.axes[2]).abs())
                }
                _ => 1.0,
            };
            colours[hit.primitive.index()].map(|x| (f64::from(x) * light).round() as u8)
        };
        let rows: Vec<u32> = (0..height).collect();
        let row = |row: &u32| (0..width).flat_map(|column| pixel(*row, column)).collect::<Vec<u8>>();
        let bytes = parallel::map_slice(&rows, true, row).concat();
        write_png(output, [width, height], &bytes)
    }
}

/// The centroids of the vertices of all primitives.
fn centroids(soup: &Soup<f64>) -> impl Iterator<Item = Point3<f64>> + '_ {
    (0..soup.len()).map(|i| {
        let vertices = soup.get(p2m_core::PrimitiveId::new(i));
        let vertices = vertices.vertices();
        let weight = 1.0 / vertices.len() as f64;
        Point3::from(vertices.iter().map(|v| v.coords * weight).sum::<nalgebra::Vector3<f64>>())
    })
}

/// Returns at most `count` centroids, evenly spaced in the order of the scene.
#[allow(clippy::cast_possible_truncation, reason = "at most as many as there are primitives")]
fn centroid_sample(soup: &Soup<f64>, count: u64) -> Vec<Point3<f64>> {
    let count = count.min(soup.len() as u64) as usize;
    centroids(soup).step_by(soup.len().div_ceil(count.max(1)).max(1)).take(count).collect()
}

/// Returns the number by which a primitive is coloured: the length of the list at its centroid, or for trees the number
/// of packets that a query there filters.
fn query_cost(index: &dyn AnyIndex, centroid: &Point3<f64>) -> f64 {
    let packets = || index.count_query(centroid, &QueryOptions::default())[1];
    index.list_length(centroid).unwrap_or_else(packets) as f64
}

/// The statistics of an index and of the costs of its queries.
struct IndexStats<'a> {
    lists: Option<ListStats>,
    in_box: QueryCost,
    on_scene: QueryCost,
    /// The number of random points.
    random_queries: u64,
    /// The names of the parts of the index, and their bytes.
    memory: Vec<(&'static str, usize)>,
    prepared: &'a PreparedIndex,
    primitives: usize,
}

impl IndexStats<'_> {
    fn json(&self) -> Value {
        let stat = |stat: &Stat| json!({ "mean": stat.mean, "max": stat.max });
        let query_cost = |cost: &QueryCost| {
            json!({
                "nodes": stat(&cost.nodes),
                "packets": stat(&cost.packets),
                "primitives": stat(&cost.primitives),
                "list": self.lists.map(|_| cost.list),
                "without_list": self.lists.map(|_| cost.without_list),
            })
        };
        let lists = self.lists.map(|lists| {
            json!({
                "count": lists.count,
                "mean": lists.mean,
                "median": lists.median,
                "percentile_90": lists.p90,
                "percentile_99": lists.p99,
                "max": lists.max,
            })
        });
        let memory: Value = self.memory.iter().copied().collect();
        let stages = self.prepared.stages.iter().map(|(stage, time)| (stage.name(), time.as_secs_f64()));
        json!({
            "lists": lists,
            "queries": self.random_queries,
            "in_box": query_cost(&self.in_box),
            "on_scene": query_cost(&self.on_scene),
            "memory": memory,
            "stages": stages.collect::<Value>(),
        })
    }
}

impl fmt::Display for IndexStats<'_> {
    #[allow(clippy::cast_precision_loss, reason = "bytes for people to read")]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(lists) = &self.lists {
            let ListStats { count, mean, median, p90, p99, max, .. } = lists;
            writeln!(
                f,
                "lists    {}: {mean:.1} primitives on average; half up to {median}, 90 % up to {p90}, 99 % up to \
                 {p99}, all up to {max}",
                Count(*count as u64)
            )?;
            let QueryCost { list, without_list, .. } = self.in_box;
            writeln!(
                f,
                "volume   {list:.1} primitives in the list at a random point; the tree answers {:.1} %",
                100.0 * without_list
            )?;
        }
        for (region, cost) in [("in the box", &self.in_box), ("on the scene", &self.on_scene)] {
            let QueryCost { nodes, packets, primitives, .. } = cost;
            writeln!(
                f,
                "queries  {region}: {:.2} nodes, {:.2} packets, {:.2} primitives each; at most {}, {}, {}",
                nodes.mean, packets.mean, primitives.mean, nodes.max, packets.max, primitives.max
            )?;
        }
        if !self.prepared.stages.is_empty() {
            let stages: Vec<String> =
                self.prepared.stages.iter().map(|(stage, time)| format!("{} {}", stage.name(), Time(*time))).collect();
            writeln!(f, "stages   {}", stages.join(", "))?;
        }
        if self.prepared.is_loaded {
            return writeln!(f, "memory   that of the file");
        }
        let total: usize = self.memory.iter().map(|part| part.1).sum();
        let used = self.memory.iter().filter(|part| part.1 > 0);
        let parts: Vec<String> = used.map(|(name, bytes)| format!("{name} {:.1} MB", *bytes as f64 / 1e6)).collect();
        if !parts.is_empty() {
            let each = total as f64 / self.primitives.max(1) as f64;
            writeln!(f, "memory   {}: {each:.0} bytes per primitive", parts.join(", "))?;
        }
        Ok(())
    }
}
