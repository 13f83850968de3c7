//! `p2m-bench field`: distance fields on a grid, against parry3d and against the figures of the article on AABB trees.

use crate::backends::{aabb_options, octree_options, p2m_options};
use crate::contender::{Absent, Answer, Prepared};
use crate::measure::Spread;
use crate::memory::measured;
use crate::queries::Queries;
use crate::rivals::{parry_double, parry_single};
use crate::scene::Scene;
use anyhow::{Context as _, Result, anyhow};
use cpu_time::ThreadTime;
use p2m_bvh::AabbTree;
use p2m_core::{BruteForce, BuildIndex, ClosestPoint, PrimitiveSet, Soup};
use p2m_field::grid_candidates::CandidateLists;
use p2m_field::sign::{SignError, SignedDistance};
use p2m_field::{FieldOptions, Grid, distances, distances_by_lists, signed_distances, signed_distances_by_lists};
use p2m_interception::{Domain, OctreeIndex, P2mIndex};
use p2m_mixed::generate::{IcoSphere, ico_sphere};
use p2m_tradeoff::Table;

/// Layers that contenders fill in turn.
const LAYERS: usize = 16;

/// Fills a part of the field; the time it takes is the caller's affair.
type Fill<'a> = Box<dyn Fn(&Grid) -> Vec<f32> + 'a>;

/// A contender that is built.
struct Built<'a> {
    name: &'static str,
    seconds: f64,
    bytes: usize,
    fill: Fill<'a>,
    /// Of each part, in nanoseconds a point.
    times: Vec<f64>,
    /// The largest difference from the first contender, in diagonals.
    difference: f64,
}

/// Prints the table of a scene: every `stride`-th slab of the grid; whether all fields of ours are the same.
pub(crate) fn print(scene: &Scene, resolution: usize, stride: usize) -> Result<bool> {
    let bounds = scene.double.aabb();
    let grid = Grid::around(&bounds, resolution, 1.05)?;
    let [x, y, z] = grid.counts();
    let mut all = contenders(scene, &grid)?;
    let mut same = true;
    let slabs: Vec<usize> = (0..z).step_by(LAYERS).step_by(stride).collect();
    for (turn, first) in slabs.iter().enumerate() {
        let part = Grid::new(grid.point([0, 0, *first]), grid.spacing(), [x, y, LAYERS.min(z - first)])?;
        let count = all.len();
        let mut fields: Vec<Option<Vec<f32>>> = vec![None; count];
        for i in (0..count).map(|i| (i + turn) % count) {
            let start = ThreadTime::now();
            let field = (all[i].fill)(&part);
            all[i].times.push(start.elapsed().as_nanos() as f64 / part.len() as f64);
            fields[i] = Some(field);
        }
        let expected = fields[0].take().unwrap_or_default();
        for (contender, field) in all.iter_mut().zip(fields).skip(1) {
            let Some(field) = field else { continue };
            // Signed ones are compared by their magnitudes.
            let differs = |(a, b): (&f32, &f32)| f64::from(a.abs()) - f64::from(b.abs());
            // NaN of one alone is a difference, and not lost in the maximum.
            let most =
                expected.iter().zip(&field).map(differs).fold(0.0f64, |m, d| if d.abs() <= m { m } else { d.abs() });
            contender.difference = contender.difference.max(most / scene.diagonal());
        }
    }
    let of_parry = all.iter().find(|c| c.name == "parry3d").map(|c| mean(&c.times));
    let mut table = Table::new([
        "contender",
        "build s",
        "MB",
        "ns a point (slabs from - to)",
        "times parry3d",
        "with build",
        "difference",
    ]);
    let points = grid.len() as f64;
    for contender in &all {
        let Built { name, seconds, bytes, times, difference, .. } = contender;
        let ns = mean(times);
        let spread = Spread::of(times).ok_or_else(|| anyhow!("no slab was measured"))?;
        let rate = |ns: f64| of_parry.map_or_else(|| "-".to_owned(), |parry| format!("{:.2}", parry / ns));
        let is_ours = !name.starts_with("parry");
        same &= !is_ours || *difference == 0.0;
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
         contenders fill in turns; one thread, thread CPU time, means over the slabs. *With build*: as if the whole grid was \
         filled once. *Difference*: from the first contender, in diagonals; `=` is bit for bit.\n\n{table}",
        points * 4.0 / 1e6,
        slabs.len(),
        z.div_ceil(LAYERS),
    );
    Ok(same)
}

fn mean(times: &[f64]) -> f64 {
    times.iter().sum::<f64>() / times.len().max(1) as f64
}

/// What puts signs to the answers of a tree.
type Sided<'a> = fn(Tree<'a>, &'a Soup<f64>) -> Result<SignedDistance<'a, Tree<'a>>, SignError>;
type Tree<'a> = AabbTree<f64, &'a Soup<f64>>;

/// Something with the seconds and the bytes that it took.
fn built<B>(build: impl FnOnce() -> Result<B>) -> Result<(B, f64, usize)> {
    let start = ThreadTime::now();
    let (built, bytes) = measured(build);
    let seconds = start.elapsed().as_secs_f64();
    Ok((built?, seconds, bytes))
}

/// An index of ours by its build.
fn ours<'a, I: ClosestPoint<f64> + Sync + 'a>(
    name: &'static str,
    build: impl FnOnce() -> Result<I>,
    options: FieldOptions,
) -> Result<Built<'a>> {
    let (index, seconds, bytes) = built(build)?;
    let fill = Box::new(move |grid: &Grid| distances(&index, grid, &options, &|_| ()).expect("memory"));
    Ok(Built { name, seconds, bytes, fill, times: Vec::new(), difference: 0.0 })
}

fn contenders<'a>(scene: &'a Scene, grid: &Grid) -> Result<Vec<Built<'a>>> {
    let soup = &scene.double;
    let [x, y, z] = grid.counts();
    let domain = p2m_core::Aabb { min: grid.origin(), max: grid.point([x - 1, y - 1, z - 1]) };
    let (hints, several) = (one_thread(), one_thread().with_hints(false));
    let octree = octree_options(1.0).with_domain(Domain::Box(domain));
    let fine = octree_options(10.0).with_domain(Domain::Box(domain));
    let mut all = vec![
        ours("aabb", || Ok(AabbTree::build(soup, &aabb_options())?), hints)?,
        ours("octree", || Ok(OctreeIndex::build(soup, &octree)?), several)?,
        ours("octree-fine", || Ok(OctreeIndex::build(soup, &fine)?), several)?,
        ours("p2m", || Ok(P2mIndex::build(soup, &p2m_options())?), hints)?,
        ours("p2m, side by side", || Ok(P2mIndex::build(soup, &p2m_options())?), several)?,
    ];
    let (lists, seconds, bytes) = built(|| CandidateLists::new(soup).context("a scene out of range"))?;
    let fill = Box::new(move |grid: &Grid| distances_by_lists(&lists, grid, &hints, &|_| ()).expect("memory"));
    all.push(Built { name: "lists", seconds, bytes, fill, times: Vec::new(), difference: 0.0 });
    if soup.triangles().len() == soup.len() {
        if let Ok((signed, seconds, bytes)) =
            built(|| Ok(SignedDistance::new(AabbTree::build(soup, &aabb_options())?, soup)?))
        {
            let fill = Box::new(move |grid: &Grid| signed_distances(&signed, grid, &hints, &|_| ()).expect("memory"));
            all.push(Built { name: "aabb, signed", seconds, bytes, fill, times: Vec::new(), difference: 0.0 });
        }
        let ways: [(&'static str, Sided<'a>); 2] = [
            ("lists, signed", |tree, soup| SignedDistance::new(tree, soup)),
            ("lists, winding", |tree, soup| SignedDistance::with_winding_numbers(tree, soup, 0.01)),
        ];
        for (name, sided) in ways {
            let both = built(|| {
                let lists = CandidateLists::new(soup).context("a scene out of range")?;
                Ok((lists, sided(AabbTree::build(soup, &aabb_options())?, soup)?))
            });
            if let Ok(((lists, signed), seconds, bytes)) = both {
                let fill = Box::new(move |grid: &Grid| {
                    signed_distances_by_lists(&lists, &signed, grid, &hints, &|_| ()).expect("memory")
                });
                all.push(Built { name, seconds, bytes, fill, times: Vec::new(), difference: 0.0 });
            }
        }
    }
    all.extend(rival("parry3d", parry_single(scene)));
    all.extend(rival("parry3d-f64", parry_double(scene)));
    Ok(all)
}

fn rival<'a>(name: &'static str, prepared: Result<Prepared<'a>, Absent>) -> Option<Built<'a>> {
    let build = prepared.ok()?.build;
    let start = ThreadTime::now();
    let (ready, bytes) = measured(build);
    let (ready, seconds) = (ready.ok()?, start.elapsed().as_secs_f64());
    #[allow(clippy::cast_possible_truncation, reason = "fields are f32")]
    let fill = Box::new(move |grid: &Grid| {
        let [x, y, z] = grid.counts();
        let mut values = Vec::with_capacity(grid.len());
        let mut answers = vec![Answer::NONE; x];
        for (j, k) in (0..y * z).map(|row| (row % y, row / y)) {
            let row = Queries::new((0..x).map(|i| grid.point([i, j, k])).collect());
            if ready.answer(row.all(), &mut answers).is_err() {
                answers.fill(Answer::NONE);
            }
            values.extend(answers.iter().map(|answer| answer.distance as f32));
        }
        values
    });
    Some(Built { name, seconds, bytes, fill, times: Vec::new(), difference: 0.0 })
}

fn one_thread() -> FieldOptions {
    FieldOptions::default().with_parallel(false)
}

/// What the article tells, beside ours.
pub(crate) fn print_article(scene: &Scene) -> Result<()> {
    let ball = ico_sphere(&IcoSphere::default().with_frequency(16))?;
    let ball = Scene::new("ico-sphere".to_owned(), ball)?;
    let time = |run: &mut dyn FnMut()| {
        let start = ThreadTime::now();
        run();
        start.elapsed().as_secs_f64()
    };
    let mut table = Table::new(["what", "the article (cited)", "ours, s"]);
    let grid = Grid::around(&ball.double.aabb(), 45, 1.05)?;
    let brute = BruteForce::new(&ball.double)?;
    let mut fields = [Vec::new(), Vec::new()];
    let seconds = time(&mut || fields[0] = distances(&brute, &grid, &one_thread(), &|_| ()).expect("memory"));
    let about = format!("45^3 points, {} triangles, brute force", ball.len());
    table.push(vec![about, "over 10 min (at least 5,000 triangles)".to_owned(), format!("{seconds:.2}")]);
    let tree = AabbTree::build(&ball.double, &aabb_options())?;
    let seconds = time(&mut || fields[1] = distances(&tree, &grid, &one_thread(), &|_| ()).expect("memory"));
    table.push(vec!["the same with the AABB tree".to_owned(), "-".to_owned(), format!("{seconds:.3}")]);
    assert!(fields[0] == fields[1], "fields of brute force and tree differ");
    let grid = Grid::around(&scene.double.aabb(), 100, 1.05)?;
    let start = ThreadTime::now();
    let tree = AabbTree::build(&scene.double, &aabb_options())?;
    let build = start.elapsed().as_secs_f64();
    let field = time(&mut || drop(distances(&tree, &grid, &one_thread(), &|_| ())));
    let name = &scene.name;
    table.push(vec![format!("AABB tree of {name}"), "0.05 s on average (the bunny)".to_owned(), format!("{build:.3}")]);
    table.push(vec![
        format!("field of {name}, 100 points a side"),
        "1.25 s (the tree is about 4 % of it)".to_owned(),
        format!("{:.3}, of which the tree is {:.1} %", build + field, 100.0 * build / (build + field)),
    ]);
    let mut by_lists = Vec::new();
    let seconds = time(&mut || {
        let lists = CandidateLists::new(&scene.double).expect("in range");
        by_lists = distances_by_lists(&lists, &grid, &one_thread(), &|_| ()).expect("memory");
    });
    assert!(
        by_lists == distances(&tree, &grid, &one_thread(), &|_| ()).expect("memory"),
        "fields of lists and tree differ"
    );
    table.push(vec!["the same by lists".to_owned(), "-".to_owned(), format!("{seconds:.3}")]);
    println!("\n## The article's figures\n\nOne thread, thread CPU time.\n\n{table}");
    Ok(())
}
