//! Answers the queries of `compare.py` in Rust, to show the overhead of a call from Python.
//!
//! Usage: `rust_batch SCENE POINTS BACKEND THREADS`. SCENE is a file of a scene, POINTS a file of coordinates as f64 in
//! the byte order of the machine, and BACKEND is `aabb` or `octree`. For each line of the standard input the program
//! answers all queries once, with distances, primitives and points, and prints the CPU time and the wall time in
//! seconds.

use cpu_time::ProcessTime;
use nalgebra::Point3;
use p2m_bvh::AabbTree;
use p2m_core::batch::{BatchOptions, ClosestColumns, closest_columns_into};
use p2m_core::{ClosestPoint, QueryOptions};
use p2m_interception::OctreeIndex;
use std::error::Error;
use std::io::{BufRead, Write, stdin, stdout};
use std::time::Instant;

type Outcome = Result<(), Box<dyn Error + Send + Sync>>;

fn main() -> Outcome {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [scene, points, backend, threads] = &arguments[..] else {
        return Err("usage: rust_batch SCENE POINTS BACKEND THREADS".into());
    };
    let scene = p2m_mixed::read_scene(scene.as_ref())?.soup;
    let points: Vec<Point3<f64>> = std::fs::read(points)?
        .as_chunks::<24>()
        .0
        .iter()
        .map(|row| Point3::from(std::array::from_fn(|axis| f64::from_ne_bytes(row.as_chunks::<8>().0[axis]))))
        .collect();
    let threads = threads.parse()?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
    pool.install(|| match backend.as_str() {
        "aabb" => answer_rounds(&AabbTree::new(&scene)?, &points, threads > 1),
        "octree" => answer_rounds(&OctreeIndex::new(&scene)?, &points, threads > 1),
        _ => Err(format!("{backend}: the backends are aabb and octree").into()),
    })
}

/// Answers all queries for each line of the standard input.
fn answer_rounds(index: &(impl ClosestPoint<f64> + Sync), points: &[Point3<f64>], parallel: bool) -> Outcome {
    let batch = BatchOptions::default().with_parallel(parallel);
    for line in stdin().lock().lines() {
        line?;
        let (cpu, wall) = (ProcessTime::now(), Instant::now());
        // New arrays are made each time, as by a call from Python.
        let mut distance = vec![0.0; points.len()];
        let mut primitive = vec![0; points.len()];
        let mut nearest = vec![Point3::origin(); points.len()];
        let columns = ClosestColumns::default()
            .with_distance(&mut distance)
            .with_primitive(&mut primitive)
            .with_point(&mut nearest);
        closest_columns_into(index, points, &QueryOptions::default(), &batch, columns);
        let (cpu, wall) = (cpu.elapsed().as_secs_f64(), wall.elapsed().as_secs_f64());
        let sum: f64 = distance.iter().sum();
        println!("{cpu} {wall} {sum}");
        stdout().flush()?;
    }
    Ok(())
}
