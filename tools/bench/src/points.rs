//! `p2m-bench points`: compares indexes over point clouds with the KD-trees of kiddo and nanoflann.
//!
//! The clouds have distributions on which KD-trees differ: uniform in space, on a surface, on a curve, in clusters, with
//! spacings of ten orders of magnitude, and on a lattice, where most distances are equal.

use crate::backend::Backend;
use crate::backends::by_name;
use crate::blocks::Blocks;
use crate::measure::{Effort, Entry, MedianRange, build_all, measure_set};
use crate::report::provenance;
use crate::scene::Scene;
use anyhow::Result;
use clap::ValueEnum;
use nalgebra::Point3;
use p2m_cli::harness::Table;
use p2m_core::{Element, Soup};
use p2m_testkit::queries::QuerySet;
use p2m_testkit::{normal_number, rng, vector};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use std::f64::consts::TAU;
use std::path::Path;

/// The blocks of docs/scale.md.
pub(crate) const BLOCKS: Blocks<3> = Blocks { command: "points", names: ["provenance", "builds", "queries"] };
/// Our backends and their rivals, in the order of the columns.
const BACKENDS: [&str; 8] =
    ["aabb", "octree", "aabb-batch", "octree-batch", "kiddo", "nanoflann", "kiddo-f32", "nanoflann-f32"];
/// The number of backends of ours that are asked one query at a time. As many after them are asked by one batch call.
const SINGLE: usize = 2;
/// The number of backends of ours. The others are rivals.
const OURS: usize = 2 * SINGLE;
/// The largest number of points over which octrees are built, because each takes seconds for a million points.
const MAX_OCTREE_POINTS: usize = 2_000_000;

/// A distribution of points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Distribution {
    /// Points are uniform in a cube.
    Uniform,
    /// Points are on a surface of waves, as those of a scanner are.
    Surface,
    /// Points are on a helix.
    Curve,
    /// Points are normally distributed about a hundred centres.
    Clusters,
    /// The distances from the centre range over ten orders of magnitude.
    Spacings,
    /// Points form a cubic lattice.
    Lattice,
}

impl Distribution {
    /// Returns about `count` points.
    fn generate(self, count: usize) -> Vec<Point3<f64>> {
        let mut rng = rng("points", self as u64);
        let random = &mut rng;
        let repeated = |point: &mut dyn FnMut() -> Point3<f64>| (0..count).map(|_| point()).collect();
        match self {
            Self::Uniform => repeated(&mut || Point3::from(vector(random))),
            Self::Surface => repeated(&mut || {
                let [x, y] = [0; 2].map(|_| random.random_range(-1.0..1.0));
                let wave = |frequency: f64| ((frequency * x).sin() * (frequency * y).cos()) / frequency;
                Point3::new(x, y, wave(3.0) + wave(17.0))
            }),
            Self::Curve => repeated(&mut || {
                let angle = 40.0 * TAU * random.random::<f64>();
                Point3::new(angle.cos(), angle.sin(), angle / 100.0)
            }),
            Self::Clusters => {
                let centres: Vec<_> = (0..100).map(|_| Point3::from(vector(random))).collect();
                let mut centre = centres.iter().cycle();
                repeated(&mut || centre.next().expect("the cycle has no end") + normal(random) * 0.01)
            }
            Self::Spacings => repeated(&mut || {
                let length = 10f64.powf(random.random_range(-10.0..0.0));
                Point3::from(normal(random).normalize() * length)
            }),
            Self::Lattice => {
                let side = (1..).find(|side: &usize| side.pow(3) >= count).unwrap_or(1);
                let coordinates = |i: usize| [i % side, i / side % side, i / (side * side)].map(|x| x as f64);
                (0..side.pow(3)).map(|i| Point3::from(coordinates(i))).collect()
            }
        }
    }
}

/// Returns a vector with normally distributed coordinates.
fn normal(random: &mut ChaCha8Rng) -> nalgebra::Vector3<f64> {
    nalgebra::Vector3::from_fn(|_, _| normal_number(random))
}

/// Returns a scene of points.
fn scene(distribution: Distribution, count: usize) -> Result<Scene> {
    let positions = distribution.generate(count);
    let elements: Vec<Element> = (0..u32::try_from(positions.len())?).map(Element::Point).collect();
    let name = distribution.to_possible_value().map_or(String::new(), |value| value.get_name().to_owned());
    Scene::new(name, Soup::new(positions, elements)?)
}

/// Measures all backends on clouds, prints the tables or replaces the blocks of a document, and returns whether ours agree and no rival is nearer.
pub(crate) fn print(
    distributions: &[Distribution],
    counts: &[usize],
    sets: &[QuerySet],
    effort: &Effort,
    document: Option<&Path>,
) -> Result<bool> {
    BLOCKS.check(document)?;
    let names = BACKENDS.iter().map(|name| (*name).to_owned());
    let heads = ["points", "count", "set"].map(str::to_owned).into_iter();
    let mut builds = Table::new(heads.clone().take(2).chain(names.clone()));
    let mut queries =
        Table::new(heads.chain(names).chain(["rivals / one by one", "rivals / batch"].map(str::to_owned)));
    let mut is_good = true;
    let mut absent: Vec<String> = Vec::new();
    for distribution in distributions {
        for &count in counts {
            let scene = scene(*distribution, count)?;
            let is_built = |name: &&&str| scene.len() <= MAX_OCTREE_POINTS || !name.starts_with("octree");
            let selected: Vec<&Backend> = BACKENDS.iter().filter(is_built).map(|name| by_name(name)).collect();
            let what = format!("{}, {} points", scene.name, scene.len());
            let mut entries = Vec::new();
            for backend in selected {
                entries.extend(build_all(&scene, &[backend], effort.builds));
                eprintln!("{what}: {} is built", backend.name);
            }
            for set in sets {
                measure_set(&scene, *set, &mut entries, effort);
                eprintln!("{what}: {set} is measured");
            }
            let entry_of = |name: &str| entries.iter().find(|entry| entry.backend.name == name);
            let built =
                BACKENDS.map(|name| entry_of(name).map_or("-".to_owned(), |entry| build_cell(entry, scene.len())));
            let row = [scene.name.clone(), scene.len().to_string()];
            builds.push([&row[..], &built].concat());
            for (at, set) in sets.iter().enumerate() {
                let medians = BACKENDS.map(|name| median(entry_of(name)?, at));
                let least = |of: &[Option<f64>]| of.iter().copied().flatten().reduce(f64::min);
                let ratio = |ours: &[Option<f64>]| match (least(&medians[OURS..]), least(ours)) {
                    (Some(rival), Some(ours)) => format!("{:.2}", rival / ours),
                    _ => "-".to_owned(),
                };
                let cells = medians.map(|median| median.map_or("-".to_owned(), |ns| format!("{ns:.0}")));
                let ratios = [ratio(&medians[..SINGLE]), ratio(&medians[SINGLE..OURS])];
                queries.push([&row[..], &[set.to_string()], &cells, &ratios].concat());
            }
            for entry in &entries {
                is_good &= !entry.backend.is_ours || entry.sets.iter().flatten().all(|set| set.agreement.is_clean());
                let note =
                    entry.index.as_ref().err().map(|why| format!("{} is left out: {}", entry.backend.name, why.0));
                absent.extend(note.filter(|note| !absent.contains(note)));
            }
        }
    }
    let Effort { rounds, queries: count, .. } = effort;
    let origin = format!(
        "{}\nOne thread, thread CPU time, medians of {rounds} rounds of {count} queries.\n\n{}",
        provenance(None),
        absent.iter().map(|note| format!("- {note}\n")).collect::<String>()
    );
    BLOCKS.publish(document, &[origin, builds.to_string(), queries.to_string()])?;
    Ok(is_good)
}

/// Describes the build of a backend over `count` points.
fn build_cell(entry: &Entry<'_>, count: usize) -> String {
    match (&entry.index, MedianRange::of(&entry.build.seconds)) {
        (Ok(_), Some(seconds)) => {
            let bytes = (entry.build.owned + entry.build.borrowed) as f64 / count as f64;
            format!("{:.3} / {bytes:.0}", seconds.median)
        }
        _ => "-".to_owned(),
    }
}

/// Returns the median time of a query of a set in nanoseconds.
fn median(entry: &Entry<'_>, set: usize) -> Option<f64> {
    let figures = entry.sets[set].as_ref().ok()?;
    MedianRange::of(&figures.nanoseconds).map(|range| range.median)
}
