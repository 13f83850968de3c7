//! Sharded indexes and the writer of shards as Python objects.

use crate::arrays::{Coordinates, borrowed, slice, with_positions};
use crate::columns::{ClosestArrays, Near, column};
use crate::errors::{shard_error, value_error};
use crate::index::backend;
use crate::memory::joined;
use crate::parts::{Split, answer_in_parts, check_finite};
use crate::scene::Scene;
use crate::work::{FIRST_STEP_QUERIES, Monitor, Run, Threads, run_batch};
use numpy::{PyArray1, PyReadonlyArray1};
use p2m_core::{Key, Position, QueryOptions};
use p2m_shards::{ShardBatch, ShardClosest, ShardError, ShardOptions, ShardedIndex};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::ops::{ControlFlow, Range};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// The number of answers in a part of a batch. It limits the memory besides the answers to about 350 MB. A part loads
/// each shard at most twice.
pub(crate) const ANSWERS_PER_PART: usize = 1 << 20;

/// Returns an answer of shards, with the id of its primitive.
pub(crate) fn in_shards(answer: ShardClosest) -> Near {
    (i64::try_from(answer.id).unwrap_or(i64::MAX), answer.closest)
}

/// Maps the shards in a folder into memory.
#[allow(unsafe_code, reason = "the user asked for it and was told what it needs")]
fn open_mapped(folder: &Path, max_bytes: u64) -> Result<ShardedIndex, ShardError> {
    // SAFETY: the documentation of `p2m.Shards` says that with `map=True` nobody may change the files.
    unsafe { ShardedIndex::open_mapped(folder, max_bytes) }
}

/// A sharded index, see `p2m.Shards`.
#[pyclass(frozen, module = "p2m._p2m")]
pub(crate) struct Shards {
    index: ShardedIndex,
}

impl Shards {
    /// Runs a batch of this number of queries on a pool, detached from the interpreter.
    ///
    /// The library divides batches among the threads of the current pool, so the work has to run on one.
    fn run<R: Send>(
        py: Python<'_>,
        queries: usize,
        (threads, progress): Run,
        work: impl FnOnce(&Threads, &Monitor) -> PyResult<R> + Send,
    ) -> PyResult<R> {
        let threads = Threads::Pool(crate::threads::pool(py, threads)?);
        run_batch(py, &threads, (queries, FIRST_STEP_QUERIES), progress, work)
    }

    /// Runs a batch of queries in parts of `per_part` queries, each as a batch of the library with the room for its
    /// answers. There is at least one part, even without queries, so that errors of the index are returned.
    pub(crate) fn answer<O: Split, R: Send>(
        &self,
        py: Python<'_>,
        (queries, per_part): (usize, usize),
        mut out: O,
        run: Run,
        check: impl FnOnce() -> PyResult<()> + Send,
        answer: impl Fn(ShardBatch<'_>, Range<usize>, O) -> PyResult<R> + Send + Sync,
    ) -> PyResult<Vec<R>> {
        Self::run(py, queries, run, |_, monitor| {
            check()?;
            let done = AtomicUsize::new(0);
            let proceed = |count: usize| {
                monitor.set_done(done.fetch_add(count, Ordering::Relaxed) + count);
                !monitor.is_cancelled()
            };
            let (mut results, mut start) = (Vec::new(), 0);
            loop {
                let end = queries.min(start + per_part);
                let (first, rest) = out.split(end - start);
                results.push(answer(self.index.batch().with_proceed(&proceed), start..end, first)?);
                if end == queries {
                    return Ok(results);
                }
                (out, start) = (rest, end);
            }
        })
    }
}

#[pymethods]
impl Shards {
    /// Opens the sharded index in a folder.
    #[new]
    fn open(py: Python<'_>, path: PathBuf, max_bytes: u64, map: bool) -> PyResult<Self> {
        let opened = py.detach(|| {
            if map { open_mapped(&path, max_bytes) } else { ShardedIndex::open_with_max_bytes(&path, max_bytes) }
        });
        opened.map(|index| Self { index }).map_err(shard_error)
    }

    /// Returns the name of the backend.
    fn backend(&self) -> &str {
        &self.index.manifest().backend
    }

    /// Returns the numbers of triangles, segments and points.
    fn counts(&self) -> (u64, u64, u64) {
        let manifest = self.index.manifest();
        (manifest.triangles, manifest.segments, manifest.points)
    }

    /// Returns the corners of the box around all primitives, or `None` for an empty scene.
    fn bounds(&self) -> Option<[[f64; 3]; 2]> {
        let bounds = self.index.bounds();
        (self.index.manifest().primitive_count() > 0).then(|| [bounds.min.coords.into(), bounds.max.coords.into()])
    }

    /// Returns the objects: the name, the first id, and the id after the last one.
    fn objects(&self) -> Vec<(String, u64, u64)> {
        let objects = self.index.manifest().objects.iter();
        objects.map(|object| (object.name.clone(), object.first, object.first + object.primitives)).collect()
    }

    /// Returns the file, its length, the number of primitives and the box of each shard.
    fn shards(&self) -> Vec<(String, u64, u64, [[f64; 3]; 2])> {
        let shards = self.index.manifest().shards.iter();
        shards.map(|shard| (shard.file.clone(), shard.bytes, shard.primitives, [shard.min, shard.max])).collect()
    }

    /// Returns the checksum of the manifest.
    fn checksum(&self) -> String {
        self.index.manifest().checksum()
    }

    /// Returns the number of times that a shard was loaded.
    fn loads(&self) -> u64 {
        self.index.loads()
    }

    /// Writes the number of the shard with the nearest box to `out` for each query, or -1.
    fn nearest_shards(
        &self,
        py: Python<'_>,
        points: Coordinates<'_>,
        out: &Bound<'_, PyDict>,
        max_distance: f64,
        threads: usize,
    ) -> PyResult<()> {
        let mut array = borrowed::<i64>(out, "shard")?;
        let out = slice(&mut array)?.unwrap_or_default();
        with_positions!(points, points => {
            let work = |threads: &Threads, monitor: &Monitor| {
                check_finite("points", points, 1)?;
                answer_in_parts(points.len(), out, threads, monitor, &|range, out: &mut [i64]| {
                    for (shard, point) in out.iter_mut().zip(&points[range]) {
                        let nearest = self.index.nearest_shard(&point.point(), max_distance);
                        *shard = nearest.and_then(|number| i64::try_from(number).ok()).unwrap_or(-1);
                    }
                });
                Ok(())
            };
            Self::run(py, points.len(), (threads, None), work)
        })
    }

    /// Returns pairs of a query and a shard that may have something within the distance of the query, as two arrays.
    fn shards_within<'py>(
        &self,
        py: Python<'py>,
        points: Coordinates<'py>,
        distances: PyReadonlyArray1<'py, f64>,
        threads: usize,
    ) -> PyResult<[Bound<'py, PyArray1<i64>>; 2]> {
        let distances = distances.as_slice()?;
        let pairs = with_positions!(points, points => {
            let work = |threads: &Threads, monitor: &Monitor| {
                check_finite("points", points, 1)?;
                let parts = answer_in_parts(points.len(), (), threads, monitor, &|range, ()| {
                    let mut pairs = Vec::with_capacity(range.len());
                    for row in range {
                        let query = points[row].point();
                        pairs.extend(self.index.shards_within(&query, distances[row]).map(|shard| (row, shard)));
                    }
                    pairs
                });
                Ok(joined(parts))
            };
            Self::run(py, points.len(), (threads, None), work)
        })?;
        let column = |part: fn(&(usize, usize)) -> usize| {
            PyArray1::from_iter(py, pairs.iter().map(|pair| i64::try_from(part(pair)).unwrap_or(i64::MAX)))
        };
        Ok([column(|pair| pair.0), column(|pair| pair.1)])
    }

    /// Answers closest-point queries by one shard into the arrays of `out`, which may include `key`.
    fn closest_in_shard(
        &self,
        py: Python<'_>,
        points: Coordinates<'_>,
        shard: usize,
        out: &Bound<'_, PyDict>,
        max_distance: f64,
        run: Run,
    ) -> PyResult<()> {
        let options = QueryOptions::default().with_max_distance(max_distance);
        let (mut arrays, mut keys) = (ClosestArrays::borrow(out)?, borrowed::<f64>(out, "key")?);
        with_positions!(points, points => {
            let places = (arrays.columns(points.len())?, column::<[f64; 2]>(&mut keys, points.len())?);
            let (size, check) = ((points.len(), ANSWERS_PER_PART), || check_finite("points", points, 1));
            self.answer(py, size, places, run, check, |batch, range, (mut columns, keys)| {
                let answers = batch.closest_points_in_shard(shard, &points[range], &options).map_err(shard_error)?;
                for (key, answer) in keys.into_iter().flatten().zip(&answers) {
                    *key = answer.as_ref().map_or(Key::INFINITY, |(_, key)| *key).order();
                }
                let answers: Vec<_> =
                    answers.iter().map(|answer| answer.map(|(answer, _)| in_shards(answer))).collect();
                columns.set_all(answers.iter().map(Option::as_ref));
                Ok(())
            })?;
        });
        Ok(())
    }

    /// Writes to `out` whether each query is inside of the surface that the triangles form.
    fn contains(&self, py: Python<'_>, points: Coordinates<'_>, out: &Bound<'_, PyDict>, run: Run) -> PyResult<()> {
        let mut array = borrowed::<bool>(out, "contains")?;
        let out = slice(&mut array)?.unwrap_or_default();
        with_positions!(points, points => {
            let (size, check) = ((points.len(), ANSWERS_PER_PART), || check_finite("points", points, 1));
            self.answer(py, size, out, run, check, |batch, range, out: &mut [bool]| {
                out.copy_from_slice(&batch.contains(&points[range]).map_err(shard_error)?);
                Ok(())
            })?;
        });
        Ok(())
    }
}

/// A writer of shards, used by `p2m.write_shards`.
#[pyclass(frozen, module = "p2m._p2m")]
pub(crate) struct ShardWriter {
    /// The writer, unless it has finished or failed.
    writer: Mutex<Option<p2m_shards::ShardWriter>>,
}

impl ShardWriter {
    /// Takes the writer. Unless it is put back, it is dropped, which removes its files.
    fn take(&self) -> PyResult<p2m_shards::ShardWriter> {
        let mut place = self.writer.lock().unwrap_or_else(PoisonError::into_inner);
        place.take().ok_or_else(|| value_error("the shards were written, or could not be written"))
    }
}

#[pymethods]
impl ShardWriter {
    #[new]
    fn new(folder: PathBuf, max_bytes: u64, backend: &str, replace: bool) -> PyResult<Self> {
        let options = ShardOptions::default().with_backend(self::backend(backend)?);
        let options = options.with_max_bytes(max_bytes).with_replace(replace);
        let writer = p2m_shards::ShardWriter::new(&folder, options).map_err(shard_error)?;
        Ok(Self { writer: Mutex::new(Some(writer)) })
    }

    /// Adds the primitives of a scene.
    fn add(&self, py: Python<'_>, scene: &Scene) -> PyResult<()> {
        let mut writer = self.take()?;
        let shared = scene.shared.clone();
        let added = py.detach(|| writer.add_scene(&shared).map(|()| writer));
        let writer = added.map_err(shard_error)?;
        *self.writer.lock().unwrap_or_else(PoisonError::into_inner) = Some(writer);
        Ok(())
    }

    /// Ends writing. If the shards were not finished, their files are removed.
    fn close(&self) {
        drop(self.writer.lock().unwrap_or_else(PoisonError::into_inner).take());
    }

    /// Builds and writes the shards. If a signal handler or the callback raises an exception, this function ends after
    /// the shard that is being built, and removes all files first.
    fn finish(&self, py: Python<'_>, run: Run) -> PyResult<()> {
        let writer = self.take()?;
        let total = usize::try_from(writer.primitive_count()).unwrap_or(usize::MAX);
        Shards::run(py, total, run, |_, monitor| {
            let written = writer.finish_with_progress(&mut |done| {
                monitor.set_done(usize::try_from(done).unwrap_or(usize::MAX));
                if monitor.is_cancelled() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            });
            written.map(drop).map_err(shard_error)
        })
    }
}
