//! `p2m-bench delaunay`: times Delaunay triangulations of the vertices of scenes and of points that make every
//! predicate zero.

use crate::measure::MedianRange;
use crate::memory;
use crate::rounds::thread_seconds;
use crate::scene::Scene;
use anyhow::{Context, Result};
use p2m_cli::harness::Table;
use p2m_interception::delaunay::{Delaunay, Work};
use p2m_testkit::{rng, vector};
use std::path::PathBuf;

/// The distance of the bounding sites from the centre of the scene, in half diagonals, for queries in ten
/// times the box.
const DOMAIN_HALF_DIAGONALS: f64 = 22.78;

/// Points with a name.
type Input = (String, Vec<[f64; 3]>);

/// Returns grids of integer and of rounded coordinates, and random points in space and on a sphere, a plane and a line.
fn generated() -> Vec<Input> {
    let grid = |spacing: f64| -> Vec<[f64; 3]> {
        (0..1_000_000u32).map(|i| [i % 100, i / 100 % 100, i / 10_000].map(|x| f64::from(x) * spacing)).collect()
    };
    let random = |map: fn([f64; 3]) -> [f64; 3]| -> Vec<[f64; 3]> {
        let mut random = rng("delaunay", 0);
        (0..100_000).map(|_| map(vector(&mut random).into())).collect()
    };
    let onto_sphere = |p: [f64; 3]| {
        let length = p.iter().map(|x| x * x).sum::<f64>().sqrt();
        p.map(|x| x / length)
    };
    [
        ("100^3 grid", grid(1.0)),
        ("100^3 grid, spacing 0.01", grid(0.01)),
        ("uniform", random(|p| p)),
        ("sphere", random(onto_sphere)),
        ("plane", random(|[x, y, _]| [x, y, 0.3 * x + 0.7 * y])),
        ("line", random(|[x, ..]| [x, 0.3 * x, 0.7 * x])),
    ]
    .map(|(name, points)| (name.to_owned(), points))
    .into()
}

/// Returns the numbers of predicates per insertion, and how many of these the filter did not decide.
fn predicates(work: &Work, points: usize) -> [String; 3] {
    let each = |n: u64| n as f64 / points as f64;
    [
        format!("{:.1}", each(work.steps)),
        format!(
            "{:.1}: {:.2}, {:.3}",
            each(work.orientations),
            each(work.whole_orientations),
            each(work.adaptive_orientations)
        ),
        format!(
            "{:.1}: {:.2}, {:.2}, {:.3}",
            each(work.spheres),
            each(work.whole_spheres),
            each(work.double_spheres),
            each(work.adaptive_spheres)
        ),
    ]
}

/// Prints the table, and returns whether all triangulations are valid.
pub(crate) fn print(scenes: &[PathBuf], rounds: usize) -> Result<bool> {
    let mut inputs = Vec::new();
    for path in scenes {
        let scene = Scene::read(path)?;
        let vertices = scene.double.positions().iter().map(|p| [p.x, p.y, p.z]);
        inputs.push((scene.name.clone(), vertices.collect()));
    }
    inputs.extend(generated());
    let mut seconds = vec![Vec::new(); inputs.len()];
    for _ in 0..rounds {
        for ((_, points), seconds) in inputs.iter().zip(&mut seconds) {
            let (delaunay, elapsed) = thread_seconds(|| Delaunay::new(points, DOMAIN_HALF_DIAGONALS));
            delaunay?;
            seconds.push(elapsed);
        }
    }
    let headings =
        ["input", "points", "tetrahedra", "points/s", "minimum", "maximum", "B/point", "peak B/point", "steps"];
    let headings =
        headings.into_iter().chain(["orientations: whole, adaptive", "spheres: whole, double, adaptive", "check"]);
    let mut table = Table::new(headings);
    let mut is_valid = true;
    for ((name, points), seconds) in inputs.iter().zip(&seconds) {
        let before = memory::current();
        memory::reset_peak();
        let (delaunay, bytes) = memory::measured(|| Delaunay::new(points, DOMAIN_HALF_DIAGONALS));
        let peak = memory::peak().saturating_sub(before);
        let delaunay = delaunay?;
        let check = delaunay.check();
        is_valid &= check.is_ok();
        let spread = MedianRange::of(seconds).context("no rounds")?;
        let speed = |seconds: f64| format!("{:.0}", points.len() as f64 / seconds);
        let each = |n: usize| format!("{:.0}", n as f64 / points.len() as f64);
        let mut row = vec![name.clone(), points.len().to_string(), delaunay.tetrahedra().len().to_string()];
        row.extend([speed(spread.median), speed(spread.max), speed(spread.min), each(bytes), each(peak)]);
        row.extend(predicates(&delaunay.work(), points.len()));
        row.push(check.map_or_else(|e| e.to_string(), |()| "valid".to_owned()));
        table.push(row);
    }
    println!("\nTimes are those of {rounds} rounds in turns: median, minimum and maximum of points a second.");
    println!("Predicates are counted for each point: in all, and those that the filter left to each stage.\n\n{table}");
    Ok(is_valid)
}
