//! `p2m-bench shards`: writes a generated terrain as shards, queries them within a limit of memory, and compares
//! answers with brute force. The terrain is generated tile by tile, and anew for brute force, so it is never in memory
//! as a whole.

use crate::memory;
use anyhow::{Context, Result};
use chacha20::ChaCha8Rng;
use clap::Args;
use nalgebra::Point3;
use p2m_cli::harness::Table;
use p2m_core::{BruteForce, ClosestPoint, Key, Primitive, PrimitiveSet, QueryOptions, Soup};
use p2m_shards::{ShardClosest, ShardOptions, ShardWriter, ShardedIndex};
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;
use std::path::PathBuf;
use std::time::Instant;

/// The number of cells along a side of a tile. Each has two triangles.
const CELLS: u32 = 500;
/// The number of triangles of a tile.
const TILE_TRIANGLES: u64 = 2 * (CELLS as u64) * (CELLS as u64);

#[derive(Args)]
pub(crate) struct Arguments {
    /// The least number of triangles of the terrain, which is generated in tiles of 500,000
    #[arg(long, default_value_t = 10_000_000)]
    triangles: u64,
    /// The largest length of the file of a shard in bytes
    #[arg(long, default_value_t = 1 << 28)]
    max_bytes: u64,
    /// The largest amount of shards in memory in bytes
    #[arg(long, default_value_t = 1 << 30)]
    max_memory: u64,
    /// The number of queries of each set
    #[arg(long, default_value_t = 1_000_000)]
    queries: usize,
    /// The number of queries of each set that are compared with brute force
    #[arg(long, default_value_t = 16)]
    checked: usize,
    /// The folder for the shards, if it is not that for temporary files
    #[arg(long)]
    folder: Option<PathBuf>,
}

/// A square terrain of tiles, each with a side of length 1.
#[derive(Clone, Copy)]
struct Terrain {
    /// The number of tiles along a side.
    side: u32,
}

impl Terrain {
    /// Returns the smallest terrain with at least this number of triangles.
    fn with_triangles(count: u64) -> Self {
        let tiles = count.div_ceil(TILE_TRIANGLES);
        let side = (1u32..).find(|side| u64::from(*side).pow(2) >= tiles).unwrap_or(1);
        Self { side }
    }

    fn tiles(self) -> u32 {
        self.side * self.side
    }

    /// Returns the height of the terrain at a point of the plane.
    fn height(x: f64, y: f64) -> f64 {
        let wave =
            |frequency: f64, phase: f64| ((frequency * x + phase).sin() * (frequency * y - phase).cos()) / frequency;
        wave(2.0, 0.3) + wave(17.0, 1.1) + wave(131.0, 2.7)
    }

    /// Returns a tile by its number. Adjacent tiles have the same vertices along their common side.
    fn tile(self, number: u32) -> Result<Soup<f64>> {
        let first = [number % self.side, number / self.side].map(|place| place * CELLS);
        let coordinate = |k: usize, i: u32| f64::from(first[k] + i) / f64::from(CELLS);
        let rows = (0..=CELLS).flat_map(|j| (0..=CELLS).map(move |i| [i, j]));
        let vertex = |[i, j]: [u32; 2]| {
            let (x, y) = (coordinate(0, i), coordinate(1, j));
            Point3::new(x, y, Self::height(x, y))
        };
        let corners = |[i, j]: [u32; 2]| {
            let at = |i: u32, j: u32| j * (CELLS + 1) + i;
            [[at(i, j), at(i + 1, j), at(i, j + 1)], [at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]]
        };
        let cells = (0..CELLS).flat_map(|j| (0..CELLS).map(move |i| [i, j]));
        Ok(Soup::from_triangles(rows.map(vertex).collect(), cells.flat_map(corners).collect())?)
    }

    /// Returns random points close to the terrain.
    fn near(self, count: usize, seed: u64) -> Vec<Point3<f64>> {
        self.random_points(count, seed, |[x, y, z], side| {
            Point3::new(x * side, y * side, Self::height(x * side, y * side) + 0.01 * (z - 0.5))
        })
    }

    /// Returns random points in a slab that is one and a half times as wide as the terrain, and as high as two tiles.
    fn around(self, count: usize, seed: u64) -> Vec<Point3<f64>> {
        self.random_points(count, seed, |[x, y, z], side| {
            Point3::new((1.5 * x - 0.25) * side, (1.5 * y - 0.25) * side, 2.0 * z - 1.0)
        })
    }

    /// Returns points that a function makes from three random numbers from 0 to 1 and the length of a side.
    fn random_points(self, count: usize, seed: u64, point: fn([f64; 3], f64) -> Point3<f64>) -> Vec<Point3<f64>> {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let side = f64::from(self.side);
        (0..count).map(|_| point(std::array::from_fn(|_| rng.random::<f64>()), side)).collect()
    }
}

/// The start of a piece of work, whose time and peak memory are measured.
struct Work(Instant);

impl Work {
    fn start() -> Self {
        memory::reset_peak();
        Self(Instant::now())
    }

    /// Returns the cells of a table about this piece of work, with the number of items that were processed.
    #[allow(clippy::cast_precision_loss, reason = "numbers for people to read")]
    fn row(&self, name: &str, count: u64, note: String) -> Vec<String> {
        let seconds = self.0.elapsed().as_secs_f64();
        let (speed, peak) = (count as f64 / seconds, memory::peak() as f64 / 1e9);
        vec![name.to_owned(), format!("{seconds:.1}"), format!("{speed:.0}"), format!("{peak:.2}"), note]
    }
}

/// Writes and queries shards, and returns whether their answers equal brute force.
pub(crate) fn run(arguments: &Arguments) -> Result<bool> {
    let terrain = Terrain::with_triangles(arguments.triangles);
    let triangles = u64::from(terrain.tiles()) * TILE_TRIANGLES;
    let folder = match &arguments.folder {
        Some(folder) => tempfile::tempdir_in(folder),
        None => tempfile::tempdir(),
    };
    let folder = folder.context("there is no folder for the shards")?;
    let head = ["work", "seconds", "triangles or points per second", "peak of the heap, GB", "note"];
    let mut table = Table::new(head.map(str::to_owned));

    let work = Work::start();
    let options = ShardOptions::default().with_max_bytes(arguments.max_bytes);
    let mut writer = ShardWriter::new(&folder.path().join("shards"), options)?;
    for number in 0..terrain.tiles() {
        writer.add_scene(&terrain.tile(number)?.into())?;
    }
    table.push(work.row("generate and spill", triangles, format!("{} tiles", terrain.tiles())));
    let work = Work::start();
    let written = writer.finish()?;
    let shards = &written.manifest().shards;
    let (count, bytes) = (shards.len(), shards.iter().map(|shard| shard.bytes).sum::<u64>());
    table.push(work.row("divide, build and write", triangles, format!("{count} shards, {} MB", bytes / 1_000_000)));

    let sets = [("near", terrain.near(arguments.queries, 1)), ("around", terrain.around(arguments.queries, 2))];
    let mut answers = Vec::new();
    for (name, queries) in &sets {
        let index = ShardedIndex::open_with_max_bytes(&folder.path().join("shards"), arguments.max_memory)?;
        let work = Work::start();
        let out = index.batch().closest_points(queries, &QueryOptions::default())?;
        let note = format!("{} loads of shards", index.loads());
        table.push(work.row(&format!("ask {name}"), queries.len() as u64, note));
        answers.push(out);
    }
    let mut are_equal = true;
    for ((name, queries), answers) in sets.iter().zip(&answers) {
        let checked = queries.len().min(arguments.checked);
        let work = Work::start();
        let is_equal = agrees_with_brute_force(terrain, &queries[..checked], &answers[..checked])?;
        are_equal &= is_equal;
        let verdict = if is_equal { "equal bits" } else { "DIFFERENT" };
        table.push(work.row(&format!("brute force, {checked} points {name}"), checked as u64, verdict.to_owned()));
    }
    println!("{triangles} triangles, at most {} MB of shards in memory\n\n{table}", arguments.max_memory / 1_000_000);
    Ok(are_equal)
}

/// Compares answers with brute force over all tiles, which are generated again one by one.
fn agrees_with_brute_force(
    terrain: Terrain,
    queries: &[Point3<f64>],
    answers: &[Option<ShardClosest>],
) -> Result<bool> {
    let mut best: Vec<Option<(Key, u64, u64)>> = vec![None; queries.len()];
    for number in 0..terrain.tiles() {
        let tile = BruteForce::new(terrain.tile(number)?)?;
        let first = u64::from(number) * TILE_TRIANGLES;
        best.par_iter_mut().zip(queries).for_each(|(best, query)| {
            if let Some(closest) = tile.closest_point(query) {
                let key = tile.set().get(closest.primitive).project(query).key;
                let found = (key, first + closest.primitive.index() as u64, closest.distance.to_bits());
                *best = Some(best.map_or(found, |best| best.min(found)));
            }
        });
    }
    let expected = best.iter().map(|best| best.map(|(_, id, distance)| (id, distance)));
    let found = answers.iter().map(|answer| answer.as_ref().map(|a| (a.id, a.closest.distance.to_bits())));
    Ok(expected.eq(found))
}
