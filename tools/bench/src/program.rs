//! `p2m-bench program`: compares the program with its library: the same number of queries end to end, through
//! `p2m query` to a file, and through one batch.

use crate::measure::{Effort, MedianRange};
use crate::scene::Scene;
use anyhow::{Context, Result, ensure};
use p2m_backends::{BackendEntry, BuildSettings};
use p2m_cli::Streams;
use p2m_core::batch::closest_points_into;
use p2m_testkit::queries::QuerySet;
use p2m_tradeoff::Table;
use std::io::{self, Write};
use std::path::Path;
use std::sync::{Arc, Mutex};
use std::time::Instant;

/// The backends that are compared.
const BACKENDS: [&str; 2] = ["aabb", "octree"];
/// The formats of the answers.
const FORMATS: [&str; 3] = ["npy", "ply", "csv"];

/// A buffer that `p2m query` writes to and `p2m-bench` reads.
#[derive(Clone, Default)]
struct Shared(Arc<Mutex<Vec<u8>>>);

impl Write for Shared {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.lock().map_err(|_| io::ErrorKind::Other)?.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Prints wall times for a scene in a file. It fails only if the program does.
pub(crate) fn print(scene: &Scene, path: &Path, threads: usize, effort: &Effort) -> Result<()> {
    let folder = tempfile::tempdir()?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
    let queries = QuerySet::Box1.generate(&scene.double, effort.queries, effort.seed);
    let mut table =
        Table::new(["backend", "answers", "program, ns per query", "library, ns per query", "program / library"]);
    for name in BACKENDS {
        let backend = BackendEntry::find(name).context("a backend of the registry")?;
        let built = pool.install(|| backend.build(Arc::clone(&scene.double), &BuildSettings::default()))?;
        let mut answers = vec![None; queries.len()];
        for format in FORMATS {
            let out = folder.path().join(format!("answers.{format}"));
            let (mut program, mut library) = (Vec::new(), Vec::new());
            for _ in 0..effort.rounds {
                program.push(run_program(path, name, threads, &out, effort)?);
                let start = Instant::now();
                pool.install(|| {
                    closest_points_into(
                        &*built.index,
                        &queries,
                        &Default::default(),
                        &Default::default(),
                        &mut answers,
                    );
                });
                library.push(start.elapsed().as_secs_f64());
            }
            let median = |times: &[f64]| MedianRange::of(times).map_or(f64::NAN, |spread| spread.median);
            let [program, library] = [median(&program), median(&library)];
            let each = |seconds: f64| format!("{:.0}", seconds * 1e9 / queries.len() as f64);
            let ratio = format!("{:.2}", program / library);
            table.push(vec![name.to_owned(), format.to_owned(), each(program), each(library), ratio]);
        }
    }
    println!("\n## {}\n\n{} queries in the box, {threads} threads.\n\n{table}", scene.describe(), effort.queries);
    Ok(())
}

/// Runs `p2m query`, and returns the seconds that it takes after it has read the scene and built the index: answering,
/// encoding and writing.
fn run_program(scene: &Path, backend: &str, threads: usize, out: &Path, effort: &Effort) -> Result<f64> {
    let (stdout, stderr) = (Shared::default(), Shared::default());
    let streams = Streams::new(io::empty(), stdout.clone(), stderr.clone());
    let (scene, out) = (scene.display().to_string(), out.display().to_string());
    let [count, seed, threads] = [effort.queries as u64, effort.seed, threads as u64].map(|n| n.to_string());
    let arguments = ["p2m", "query", &scene, "--random", &count, "--seed", &seed, "--backend", backend];
    let more = ["--threads", &threads, "--out", &out, "--json"];
    let start = Instant::now();
    let code = p2m_cli::run(&streams, arguments.iter().chain(&more).map(|argument| (*argument).into()));
    let all = start.elapsed().as_secs_f64();
    let text = |shared: &Shared| String::from_utf8_lossy(&shared.0.lock().expect("no writer panics")).into_owned();
    ensure!(code == 0, "{}", text(&stderr));
    let report: serde_json::Value = serde_json::from_str(&text(&stdout))?;
    let seconds = |key: &str| report["seconds"][key].as_f64().context("a report of version 2");
    Ok(all - seconds("read")? - seconds("build")?)
}
