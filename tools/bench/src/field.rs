//! `p2m-bench field`: compares distance fields on a grid with those of parry3d.

use crate::backend::{Answer, BoxedIndex};
use crate::command::{all_good, at_least_one};
use crate::measure::MedianRange;
use crate::memory::measured;
use crate::our_indexes::{aabb_options, octree_options, p2m_options};
use crate::parry::{double, single};
use crate::queries::Queries;
use crate::rounds::{rotated, thread_seconds};
use crate::scene::Scene;
use anyhow::{Context as _, Result, anyhow};
use clap::Args;
use clap::builder::RangedU64ValueParser;
use p2m_bvh::AabbTree;
use p2m_cli::harness::Table;
use p2m_core::{BuildIndex, ClosestPoint, PrimitiveSet};
use p2m_field::grid_candidates::CandidateLists;
use p2m_field::sign::SignedDistance;
use p2m_field::{FieldOptions, Grid, distances, distances_by_lists, signed_distances_by_lists};
use p2m_interception::{Domain, OctreeIndex, P2mIndex};
use std::path::PathBuf;

/// The number of layers of the grid in a slab. Methods fill slabs in turns.
const LAYERS: usize = 16;

/// A function that fills a slab of the field.
type Fill<'a> = dyn Fn(&Grid) -> Vec<f32> + 'a;

/// A method of filling the field, after its build.
struct Method<'a> {
    name: &'static str,
    seconds: f64,
    bytes: usize,
    fill: Box<Fill<'a>>,
    /// The time of each slab, in nanoseconds per point.
    times: Vec<f64>,
    /// The largest difference from the first method, in diagonals.
    difference: f64,
}

#[derive(Args)]
pub(crate) struct Arguments {
    /// Files of scenes
    #[arg(required = true)]
    scenes: Vec<PathBuf>,
    /// Points along the longest side of the grid
    #[arg(long, default_value_t = 256, value_parser = RangedU64ValueParser::<usize>::new().range(2..=2048))]
    resolution: usize,
    /// Fill every n-th slab of sixteen layers only
    #[arg(long, default_value_t = 1, value_parser = at_least_one())]
    stride: usize,
}

/// Times distance fields, and returns whether ours are equal.
pub(crate) fn run(arguments: &Arguments) -> Result<bool> {
    all_good(&arguments.scenes, "", |scene| print(&scene, arguments.resolution, arguments.stride))
}

impl<'a> Method<'a> {
    /// Builds an index, and makes a method from it.
    fn build<I: 'a>(
        name: &'static str,
        build: impl FnOnce() -> Result<I>,
        fill: impl Fn(&I, &Grid) -> Vec<f32> + 'a,
    ) -> Result<Self> {
        let ((index, bytes), seconds) = thread_seconds(|| measured(build));
        let index = index?;
        let fill = Box::new(move |grid: &Grid| fill(&index, grid));
        Ok(Self { name, seconds, bytes, fill, times: Vec::new(), difference: 0.0 })
    }
}

/// Prints the table of a scene for every `stride`-th slab of the grid, and returns whether all fields of
/// ours are equal.
fn print(scene: &Scene, resolution: usize, stride: usize) -> Result<bool> {
    let bounds = scene.double.aabb();
    let grid = Grid::around(&bounds, resolution, 1.05)?;
    let [x, y, z] = grid.counts();
    let mut all = methods(scene, &grid)?;
    let mut is_same = true;
    let slabs: Vec<usize> = (0..z).step_by(LAYERS).step_by(stride).collect();
    for (turn, first) in slabs.iter().enumerate() {
        let slab = Grid::new(grid.point([0, 0, *first]), grid.spacing(), [x, y, LAYERS.min(z - first)])?;
        let count = all.len();
        let mut fields: Vec<Option<Vec<f32>>> = vec![None; count];
        for i in rotated(count, turn) {
            let (field, seconds) = thread_seconds(|| (all[i].fill)(&slab));
            all[i].times.push(seconds * 1e9 / slab.len() as f64);
            fields[i] = Some(field);
        }
        let expected = fields[0].take().unwrap_or_default();
        for (method, field) in all.iter_mut().zip(fields).skip(1) {
            let Some(field) = field else { continue };
            // The magnitudes of signed values are compared. `f64::max` would drop a NaN, so a NaN of only one method
            // becomes an infinite difference.
            let difference = |(a, b): (&f32, &f32)| {
                let (a, b) = (f64::from(a.abs()), f64::from(b.abs()));
                let difference = if a.total_cmp(&b).is_eq() { 0.0 } else { (a - b).abs() };
                if difference.is_nan() { f64::INFINITY } else { difference }
            };
            let largest = expected.iter().zip(&field).map(difference).fold(0.0, f64::max);
            method.difference = method.difference.max(largest / scene.diagonal());
        }
    }
    let of_parry = all.iter().find(|c| c.name == "parry3d").map(|c| mean(&c.times));
    let mut table = Table::new([
        "method",
        "build s",
        "MB",
        "ns per point (slabs from - to)",
        "times parry3d",
        "with build",
        "difference",
    ]);
    let points = grid.len() as f64;
    for method in &all {
        let Method { name, seconds, bytes, times, difference, .. } = method;
        let ns = mean(times);
        let spread = MedianRange::of(times).ok_or_else(|| anyhow!("no slab was measured"))?;
        let rate = |ns: f64| of_parry.map_or_else(|| "-".to_owned(), |parry| format!("{:.2}", parry / ns));
        let is_ours = !name.starts_with("parry");
        is_same &= !is_ours || *difference == 0.0;
        table.push(vec![
            (*name).to_owned(),
            format!("{seconds:.3}"),
            format!("{:.1}", *bytes as f64 / 1e6),
            format!("{ns:.0} ({:.0} - {:.0})", spread.min, spread.max),
            rate(ns),
            rate(ns + seconds * 1e9 / points),
            if is_ours && *difference == 0.0 { "=".to_owned() } else { format!("{difference:.1e}") },
        ]);
    }
    println!("\n## {}\n", scene.describe());
    println!(
        "Grid of {x} x {y} x {z} points around the 1.05-fold box ({:.1} MB of f32), {} of {} slabs of {LAYERS} layers, \
         which methods fill in turns; one thread, thread CPU time, means over the slabs. *With build*: as if the whole \
         grid was filled once. *Difference*: from the first method, in diagonals; `=` is bit for bit.\n\n{table}",
        points * 4.0 / 1e6,
        slabs.len(),
        z.div_ceil(LAYERS),
    );
    Ok(is_same)
}

fn mean(times: &[f64]) -> f64 {
    times.iter().sum::<f64>() / times.len().max(1) as f64
}

fn methods<'a>(scene: &'a Scene, grid: &Grid) -> Result<Vec<Method<'a>>> {
    let soup = &*scene.double;
    let [x, y, z] = grid.counts();
    let domain = p2m_core::Aabb { min: grid.origin(), max: grid.point([x - 1, y - 1, z - 1]) };
    let octree = octree_options(1.0).with_domain(Domain::Box(domain));
    let fine = octree_options(10.0).with_domain(Domain::Box(domain));
    let lists = || CandidateLists::new(soup).context("a scene out of range");
    let mut all = vec![
        Method::build("aabb", || Ok(AabbTree::build(soup, &aabb_options())?), by_queries)?,
        Method::build("octree", || Ok(OctreeIndex::build(soup, &octree)?), by_queries)?,
        Method::build("octree-fine", || Ok(OctreeIndex::build(soup, &fine)?), by_queries)?,
        Method::build("p2m", || Ok(P2mIndex::build(soup, &p2m_options())?), by_queries)?,
        Method::build("lists", lists, |lists, grid| {
            distances_by_lists(lists, grid, &one_thread(), &|_| ()).expect("memory")
        })?,
    ];
    if soup.triangles().len() == soup.len() {
        let signed = || Ok((lists()?, SignedDistance::new(AabbTree::build(soup, &aabb_options())?, soup)?));
        let method = Method::build("lists, signed", signed, |(lists, signed), grid| {
            signed_distances_by_lists(lists, signed, grid, &one_thread(), &|_| ()).expect("memory")
        });
        all.extend(method.ok());
    }
    for (name, prepared) in [("parry3d", single::prepare(scene)), ("parry3d-f64", double::prepare(scene))] {
        let build = || Ok((prepared?.build)()?);
        all.extend(Method::build(name, build, by_external_queries).ok());
    }
    Ok(all)
}

fn by_queries(index: &(impl ClosestPoint<f64> + Sync), grid: &Grid) -> Vec<f32> {
    distances(index, grid, &one_thread(), &|_| ()).expect("memory")
}

#[allow(clippy::cast_possible_truncation, reason = "fields are f32")]
fn by_external_queries(index: &BoxedIndex, grid: &Grid) -> Vec<f32> {
    let [x, y, z] = grid.counts();
    let mut values = Vec::with_capacity(grid.len());
    let mut answers = vec![Answer::NONE; x];
    for (j, k) in (0..y * z).map(|row| (row % y, row / y)) {
        let row = Queries::new((0..x).map(|i| grid.point([i, j, k])).collect());
        if index.answer(row.all(), &mut answers).is_err() {
            answers.fill(Answer::NONE);
        }
        values.extend(answers.iter().map(|answer| answer.distance as f32));
    }
    values
}

fn one_thread() -> FieldOptions {
    FieldOptions::default().with_parallel(false)
}
