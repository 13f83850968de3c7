//! `p2m-bench field`: compares distance fields on a grid with those of parry3d.

use crate::backend::{Answer, Prepared, Unavailable};
use crate::command::{all_good, at_least_one};
use crate::external::{parry_double, parry_single};
use crate::measure::MedianRange;
use crate::memory::measured;
use crate::our_indexes::{aabb_options, octree_options, p2m_options};
use crate::queries::Queries;
use crate::rounds::{rotated, thread_seconds};
use crate::scene::Scene;
use anyhow::{Context as _, Result, anyhow};
use clap::Args;
use clap::builder::RangedU64ValueParser;
use p2m_bvh::AabbTree;
use p2m_cli::harness::Table;
use p2m_core::{BuildIndex, ClosestPoint, PrimitiveSet, Soup};
use p2m_field::grid_candidates::CandidateLists;
use p2m_field::sign::{SignError, SignRule, SignedDistance};
use p2m_field::{FieldOptions, Grid, distances, distances_by_lists, signed_distances, signed_distances_by_lists};
use p2m_interception::{Domain, OctreeIndex, P2mIndex};
use std::path::PathBuf;

/// The number of layers of the grid in a slab, which methods fill in turn.
const LAYERS: usize = 16;

/// Fills a slab of the field.
type Fill<'a> = dyn Fn(&Grid) -> Vec<f32> + 'a;

/// A method that is built.
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
    fn new(name: &'static str, seconds: f64, bytes: usize, fill: impl Fn(&Grid) -> Vec<f32> + 'a) -> Self {
        Self { name, seconds, bytes, fill: Box::new(fill), times: Vec::new(), difference: 0.0 }
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
            // Signed values are compared by their magnitudes. `f64::max` would drop a NaN, so a NaN of one method alone
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
        "Grid of {x} x {y} x {z} points around the 1.05-fold box ({:.1} MB of f32), {} of {} slabs of {LAYERS} layers, which \
         methods fill in turns; one thread, thread CPU time, means over the slabs. *With build*: as if the whole grid was \
         filled once. *Difference*: from the first method, in diagonals; `=` is bit for bit.\n\n{table}",
        points * 4.0 / 1e6,
        slabs.len(),
        z.div_ceil(LAYERS),
    );
    Ok(is_same)
}

fn mean(times: &[f64]) -> f64 {
    times.iter().sum::<f64>() / times.len().max(1) as f64
}

/// Adds a sign to the distances of a tree.
type Sided<'a> = fn(Tree<'a>, &'a Soup<f64>) -> Result<SignedDistance<Tree<'a>, &'a Soup<f64>>, SignError>;
type Tree<'a> = AabbTree<f64, &'a Soup<f64>>;

/// Returns a value with the seconds and the bytes that it took.
fn built<B>(build: impl FnOnce() -> Result<B>) -> Result<(B, f64, usize)> {
    let ((built, bytes), seconds) = thread_seconds(|| measured(build));
    Ok((built?, seconds, bytes))
}

/// Builds an index of ours as a method.
fn ours<'a, I: ClosestPoint<f64> + Sync + 'a>(
    name: &'static str,
    build: impl FnOnce() -> Result<I>,
    options: FieldOptions,
) -> Result<Method<'a>> {
    let (index, seconds, bytes) = built(build)?;
    let fill = move |grid: &Grid| distances(&index, grid, &options, &|_| ()).expect("memory");
    Ok(Method::new(name, seconds, bytes, fill))
}

fn methods<'a>(scene: &'a Scene, grid: &Grid) -> Result<Vec<Method<'a>>> {
    let soup = &*scene.double;
    let [x, y, z] = grid.counts();
    let domain = p2m_core::Aabb { min: grid.origin(), max: grid.point([x - 1, y - 1, z - 1]) };
    let options = one_thread();
    let octree = octree_options(1.0).with_domain(Domain::Box(domain));
    let fine = octree_options(10.0).with_domain(Domain::Box(domain));
    let mut all = vec![
        ours("aabb", || Ok(AabbTree::build(soup, &aabb_options())?), options)?,
        ours("octree", || Ok(OctreeIndex::build(soup, &octree)?), options)?,
        ours("octree-fine", || Ok(OctreeIndex::build(soup, &fine)?), options)?,
        ours("p2m", || Ok(P2mIndex::build(soup, &p2m_options())?), options)?,
    ];
    let (lists, seconds, bytes) = built(|| CandidateLists::new(soup).context("a scene out of range"))?;
    let fill = move |grid: &Grid| distances_by_lists(&lists, grid, &options, &|_| ()).expect("memory");
    all.push(Method::new("lists", seconds, bytes, fill));
    if soup.triangles().len() == soup.len() {
        if let Ok((signed, seconds, bytes)) =
            built(|| Ok(SignedDistance::new(AabbTree::build(soup, &aabb_options())?, soup)?))
        {
            let fill = move |grid: &Grid| signed_distances(&signed, grid, &options, &|_| ()).expect("memory");
            all.push(Method::new("aabb, signed", seconds, bytes, fill));
        }
        let variants: [(&'static str, Sided<'a>); 2] = [
            ("lists, signed", |tree, soup| SignedDistance::new(tree, soup)),
            ("lists, winding", |tree, soup| SignedDistance::with_rule(tree, soup, SignRule::Winding)),
        ];
        for (name, sided) in variants {
            let both = built(|| {
                let lists = CandidateLists::new(soup).context("a scene out of range")?;
                Ok((lists, sided(AabbTree::build(soup, &aabb_options())?, soup)?))
            });
            if let Ok(((lists, signed), seconds, bytes)) = both {
                let fill = move |grid: &Grid| {
                    signed_distances_by_lists(&lists, &signed, grid, &options, &|_| ()).expect("memory")
                };
                all.push(Method::new(name, seconds, bytes, fill));
            }
        }
    }
    all.extend(external_method("parry3d", parry_single(scene)));
    all.extend(external_method("parry3d-f64", parry_double(scene)));
    Ok(all)
}

fn external_method<'a>(name: &'static str, prepared: Result<Prepared, Unavailable>) -> Option<Method<'a>> {
    let build = prepared.ok()?.build;
    let ((index, bytes), seconds) = thread_seconds(|| measured(build));
    let index = index.ok()?;
    #[allow(clippy::cast_possible_truncation, reason = "fields are f32")]
    let fill = move |grid: &Grid| {
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
    };
    Some(Method::new(name, seconds, bytes, fill))
}

fn one_thread() -> FieldOptions {
    FieldOptions::default().with_parallel(false)
}
