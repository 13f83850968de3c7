//! Sharded indexes as objects of Python, and the writer of shards.

use crate::columns::{Arrays, borrowed, slice};
use crate::errors::{shard_error, value_error};
use crate::index::backend;
use crate::parts::{Split, answer_in_parts};
use crate::queries::{BadRow, NearList, batch_options, check_finite, query_options};
use crate::rays::{BadRay, HitArrays, HitList, Rays};
use crate::scene::{Coordinates, Scene, triples, with_positions};
use crate::work::{FIRST_STEP_QUERIES, Monitor, Threads, run_batch};
use nalgebra::Point3;
use numpy::{PyArray1, PyReadonlyArray1};
use p2m_core::batch;
use p2m_core::{Key, Position, Ray};
use p2m_shards::{Proceed, ShardClosest, ShardError, ShardHit, ShardOptions, ShardedIndex};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// The number of answers that the two phases of a batch take at a time, which limits the memory besides the answers to
/// about 350 MB. A shard is loaded at most twice for each such part.
const ANSWERS_PER_PART: usize = 1 << 20;

/// The reason why a batch has no answers.
enum Failure {
    Row(BadRow),
    Ray(BadRay),
    Shard(ShardError),
}

impl From<Failure> for PyErr {
    fn from(failure: Failure) -> Self {
        match failure {
            Failure::Row(error) => error.into(),
            Failure::Ray(error) => error.into(),
            Failure::Shard(error) => shard_error(&error),
        }
    }
}

impl From<BadRow> for Failure {
    fn from(error: BadRow) -> Self {
        Self::Row(error)
    }
}

impl From<BadRay> for Failure {
    fn from(error: BadRay) -> Self {
        Self::Ray(error)
    }
}

impl From<ShardError> for Failure {
    fn from(error: ShardError) -> Self {
        Self::Shard(error)
    }
}

/// Returns the id of a primitive as NumPy has it.
fn number(id: u64) -> i64 {
    i64::try_from(id).unwrap_or(i64::MAX)
}

/// Returns what a column needs of an answer.
fn with_id(answer: &ShardClosest) -> (i64, &p2m_core::Closest<f64>) {
    (number(answer.id), &answer.closest)
}

/// Maps the shards of a folder.
#[allow(unsafe_code, reason = "the user asked for it and was told what it needs")]
fn open_mapped(folder: &Path, max_bytes: u64) -> Result<ShardedIndex, ShardError> {
    // SAFETY: the documentation of `p2m.Shards` says that with `map=True` nobody may change the files.
    unsafe { ShardedIndex::open_mapped(folder, max_bytes) }
}

/// A sharded index. `p2m.Shards` has its documentation.
#[pyclass(frozen, module = "p2m._p2m")]
pub(crate) struct Shards {
    index: ShardedIndex,
}

impl Shards {
    /// Runs a batch of so many queries on threads of a pool, detached from the interpreter.
    ///
    /// The library divides batches among the threads of the current pool, so there has to be one. A single thread is
    /// not shared with other batches, because several threads of Python may each want one.
    fn run<R: Send>(
        py: Python<'_>,
        queries: usize,
        threads: usize,
        progress: Option<Py<PyAny>>,
        work: impl FnOnce(&Threads, &Monitor) -> Result<R, Failure> + Send,
    ) -> PyResult<R> {
        let pool = if threads == 1 { crate::threads::start(1) } else { crate::threads::pool(py, threads) };
        let threads = Threads::Pool(pool?);
        let monitor = threads.monitor(queries, FIRST_STEP_QUERIES, progress);
        run_batch(py, &threads, &monitor, || work(&threads, &monitor))?.map_err(PyErr::from)
    }

    /// Answers points in parts of so many, each by one batch of the library, and calls `set` with the number and the
    /// answer of each point.
    fn answer_batches<P: Position<f64>, A>(
        points: &[P],
        points_per_part: usize,
        monitor: &Monitor,
        answer: impl Fn(&[P], &Proceed<'_>) -> Result<Vec<A>, ShardError>,
        mut set: impl FnMut(usize, &A),
    ) -> Result<(), Failure> {
        let done = AtomicUsize::new(0);
        let proceed = |count: usize| {
            monitor.set_done(done.fetch_add(count, Ordering::Relaxed) + count);
            !monitor.is_cancelled()
        };
        for (part, points) in points.chunks(points_per_part).enumerate() {
            let answers = answer(points, &proceed)?;
            answers.iter().enumerate().for_each(|(i, answer)| set(part * points_per_part + i, answer));
        }
        Ok(())
    }
}

/// Answers points one by one, in parts, and stores the answers of each part.
///
/// After an error the other points are left out.
fn answer_each<P: Position<f64>, A: Send, O: Split, R: Send>(
    points: &[P],
    out: O,
    threads: &Threads,
    monitor: &Monitor,
    answer: impl Fn(&Point3<f64>) -> Result<A, ShardError> + Sync,
    store: impl Fn(Vec<A>, O) -> R + Sync,
) -> Result<Vec<R>, Failure> {
    let has_failed = AtomicBool::new(false);
    let parts = answer_in_parts(points.len(), out, threads, monitor, &|range, out: O| {
        let options = batch_options(range.len(), false);
        let answers = batch::map(&points[range], &options, Position::point, |point| {
            guarded(&has_failed, || answer(&point.point()))
        });
        Ok(store(answers.into_iter().collect::<Result<_, ShardError>>()?, out))
    });
    first_error(parts)
}

/// Calls a function, unless one has failed already.
fn guarded<A>(has_failed: &AtomicBool, answer: impl FnOnce() -> Result<A, ShardError>) -> Result<A, ShardError> {
    if has_failed.load(Ordering::Relaxed) {
        return Err(ShardError::Cancelled);
    }
    let answer = answer();
    if answer.is_err() {
        has_failed.store(true, Ordering::Relaxed);
    }
    answer
}

/// Returns all results, or an error that says why there are none.
fn first_error<R>(parts: Vec<Result<R, ShardError>>) -> Result<Vec<R>, Failure> {
    let mut results = Vec::with_capacity(parts.len());
    let mut found = None;
    for part in parts {
        match part {
            Ok(result) => results.push(result),
            // What other errors have cancelled is no reason.
            Err(error) if found.is_none() || matches!(found, Some(ShardError::Cancelled)) => found = Some(error),
            Err(_) => {}
        }
    }
    found.map_or(Ok(results), |error| Err(error.into()))
}

#[pymethods]
impl Shards {
    /// Opens the sharded index of a folder.
    #[new]
    fn open(py: Python<'_>, path: PathBuf, max_bytes: u64, map: bool) -> PyResult<Self> {
        let opened = py.detach(|| {
            if map { open_mapped(&path, max_bytes) } else { ShardedIndex::open_with_max_bytes(&path, max_bytes) }
        });
        opened.map(|index| Self { index }).map_err(|error| shard_error(&error))
    }

    /// Returns the name of the backend.
    fn backend(&self) -> &str {
        &self.index.manifest().backend
    }

    /// Returns the number of triangles, segments and points.
    fn counts(&self) -> (u64, u64, u64) {
        let manifest = self.index.manifest();
        (manifest.triangles, manifest.segments, manifest.points)
    }

    /// Returns the corners of the box around all primitives, or nothing for an empty scene.
    fn bounds(&self) -> Option<[[f64; 3]; 2]> {
        let bounds = self.index.bounds();
        (self.index.manifest().primitive_count() > 0).then(|| [bounds.min.coords.into(), bounds.max.coords.into()])
    }

    /// Returns the names of the objects, with their first id and the one after their last.
    fn objects(&self) -> Vec<(String, u64, u64)> {
        let objects = self.index.manifest().objects.iter();
        objects.map(|object| (object.name.clone(), object.first, object.first + object.primitives)).collect()
    }

    /// Returns the file, its length, the number of primitives and the box of each shard.
    fn shards(&self) -> Vec<(String, u64, u64, [[f64; 3]; 2])> {
        let shards = self.index.manifest().shards.iter();
        shards.map(|shard| (shard.file.clone(), shard.bytes, shard.primitives, [shard.min, shard.max])).collect()
    }

    /// Returns the checksum of the manifest that was read.
    fn checksum(&self) -> String {
        self.index.manifest().checksum()
    }

    /// Returns the number of times that a shard was loaded.
    fn loads(&self) -> u64 {
        self.index.loads()
    }

    /// Answers queries for the closest point into the arrays of `out`.
    #[pyo3(signature = (points, out, max_distance, epsilon, max_visits, certified, threads, progress))]
    #[allow(clippy::too_many_arguments, reason = "the Python layer passes them all")]
    fn closest(
        &self,
        py: Python<'_>,
        points: Coordinates<'_>,
        out: &Bound<'_, PyDict>,
        max_distance: f64,
        epsilon: f64,
        max_visits: Option<u32>,
        certified: bool,
        threads: usize,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<()> {
        let options = query_options(max_distance, epsilon, max_visits);
        let mut arrays = Arrays::borrow(out)?;
        with_positions!(points, points => {
            let mut columns = arrays.columns(points.len())?;
            let work = |_: &Threads, monitor: &Monitor| {
                check_finite(points)?;
                let answer = |points: &[_], proceed: &Proceed<'_>| {
                    if certified {
                        return self.index.batch().with_proceed(proceed).certified_closest_points(points, &options);
                    }
                    self.index.batch().with_proceed(proceed).closest_points(points, &options)
                };
                Self::answer_batches(points, ANSWERS_PER_PART, monitor, answer, |i, one: &Option<_>| {
                    columns.set_with_id(i, one.as_ref().map(with_id));
                })
            };
            Self::run(py, points.len(), threads, progress, work)
        })
    }

    /// Answers queries for the k nearest primitives into the arrays of `out`, k places for each query.
    #[pyo3(signature = (points, k, out, max_distance, threads, progress))]
    #[allow(clippy::too_many_arguments, reason = "the Python layer passes them all")]
    fn k_nearest(
        &self,
        py: Python<'_>,
        points: Coordinates<'_>,
        k: usize,
        out: &Bound<'_, PyDict>,
        max_distance: f64,
        threads: usize,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<()> {
        let mut arrays = Arrays::borrow(out)?;
        with_positions!(points, points => {
            let mut columns = arrays.columns(points.len() * k)?;
            let work = |_: &Threads, monitor: &Monitor| {
                check_finite(points)?;
                let answer = |points: &[_], proceed: &Proceed<'_>| {
                    self.index.batch().with_proceed(proceed).k_nearest(points, k, max_distance)
                };
                let points_per_part = (ANSWERS_PER_PART / k.max(1)).max(1);
                Self::answer_batches(points, points_per_part, monitor, answer, |i, near: &Vec<ShardClosest>| {
                    for place in 0..k {
                        columns.set_with_id(i * k + place, near.get(place).map(with_id));
                    }
                })
            };
            Self::run(py, points.len(), threads, progress, work)
        })
    }

    /// Writes to `out` the shard with the nearest box of each query, or -1.
    #[pyo3(signature = (points, out, max_distance, threads))]
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
                check_finite(points)?;
                answer_in_parts(points.len(), out, threads, monitor, &|range, out: &mut [i64]| {
                    for (shard, point) in out.iter_mut().zip(&points[range]) {
                        let nearest = self.index.nearest_shard(&point.point(), max_distance);
                        *shard = nearest.and_then(|number| i64::try_from(number).ok()).unwrap_or(-1);
                    }
                });
                Ok(())
            };
            Self::run(py, points.len(), threads, None, work)
        })
    }

    /// Returns the rows of queries and the shards that may have something as near as a distance, as two arrays.
    #[pyo3(signature = (points, distances, threads))]
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
                check_finite(points)?;
                let parts = answer_in_parts(points.len(), (), threads, monitor, &|range, ()| {
                    let mut pairs = Vec::with_capacity(range.len());
                    for row in range {
                        let query = points[row].point();
                        pairs.extend(self.index.shards_within(&query, distances[row]).map(|shard| (row, shard)));
                    }
                    pairs
                });
                Ok(parts.concat())
            };
            Self::run(py, points.len(), threads, None, work)
        })?;
        let column = |part: fn(&(usize, usize)) -> usize| {
            PyArray1::from_iter(py, pairs.iter().map(|pair| i64::try_from(part(pair)).unwrap_or(i64::MAX)))
        };
        Ok([column(|pair| pair.0), column(|pair| pair.1)])
    }

    /// Answers queries for the closest point by one shard into the arrays of `out`, among which `key` may be.
    #[pyo3(signature = (points, shard, out, max_distance, threads, progress))]
    #[allow(clippy::too_many_arguments, reason = "the Python layer passes them all")]
    fn closest_in_shard(
        &self,
        py: Python<'_>,
        points: Coordinates<'_>,
        shard: usize,
        out: &Bound<'_, PyDict>,
        max_distance: f64,
        threads: usize,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<()> {
        let options = query_options(max_distance, 0.0, None);
        let mut arrays = Arrays::borrow(out)?;
        let mut key_array = borrowed::<f64>(out, "key")?;
        let mut keys = slice(&mut key_array)?.map(|flat| flat.as_chunks_mut::<2>().0);
        with_positions!(points, points => {
            let mut columns = arrays.columns(points.len())?;
            let work = |_: &Threads, monitor: &Monitor| {
                check_finite(points)?;
                let answer = |points: &[_], proceed: &Proceed<'_>| {
                    self.index.batch().with_proceed(proceed).closest_points_in_shard(shard, points, &options)
                };
                Self::answer_batches(points, ANSWERS_PER_PART, monitor, answer, |i, one: &Option<_>| {
                    columns.set_with_id(i, one.as_ref().map(|(answer, _)| with_id(answer)));
                    if let Some(keys) = &mut keys {
                        keys[i] = one.as_ref().map_or(Key::INFINITY, |(_, key)| *key).order();
                    }
                })
            };
            Self::run(py, points.len(), threads, progress, work)
        })
    }

    /// Returns the number of primitives within a distance of each query, in `counts`, and a function that fills
    /// columns with all of them.
    #[pyo3(signature = (points, radius, counts, threads, progress))]
    fn within(
        &self,
        py: Python<'_>,
        points: Coordinates<'_>,
        radius: f64,
        counts: &Bound<'_, PyArray1<i64>>,
        threads: usize,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<NearList> {
        let dictionary = PyDict::new(py);
        dictionary.set_item("counts", counts)?;
        let mut counts = borrowed::<i64>(&dictionary, "counts")?;
        let counts = slice(&mut counts)?.unwrap_or_default();
        with_positions!(points, points => {
            let work = |threads: &Threads, monitor: &Monitor| {
                check_finite(points)?;
                let all = |query: &_| self.index.all_within(query, radius);
                let parts = answer_each(points, counts, threads, monitor, all, |answers, counts: &mut [i64]| {
                    for (count, near) in counts.iter_mut().zip(&answers) {
                        *count = i64::try_from(near.len()).unwrap_or(i64::MAX);
                    }
                    answers.concat()
                })?;
                let answers = || parts.iter().flatten();
                let ids = answers().map(|answer| number(answer.id)).collect();
                Ok(NearList { list: answers().map(|answer| answer.closest).collect(), ids: Some(ids) })
            };
            Self::run(py, points.len(), threads, progress, work)
        })
    }

    /// Writes to `out` whether any primitive is within a distance of each query.
    #[pyo3(signature = (points, radius, out, threads, progress))]
    fn is_any_within(
        &self,
        py: Python<'_>,
        points: Coordinates<'_>,
        radius: f64,
        out: &Bound<'_, PyDict>,
        threads: usize,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<()> {
        self.decide(py, points, out, "is_within", threads, progress, |query| self.index.is_any_within(query, radius))
    }

    /// Writes to `out` whether each query is inside of the closed surface that the triangles form.
    #[pyo3(signature = (points, out, threads, progress))]
    fn is_inside(
        &self,
        py: Python<'_>,
        points: Coordinates<'_>,
        out: &Bound<'_, PyDict>,
        threads: usize,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<()> {
        self.decide(py, points, out, "is_inside", threads, progress, |query| self.index.is_inside(query))
    }

    /// Casts rays, as `Index.rays` does.
    #[pyo3(signature = (origins, directions, mode, out, t_min, t_max, radius, threads, progress))]
    #[allow(clippy::too_many_arguments, reason = "the Python layer passes them all")]
    fn rays(
        &self,
        py: Python<'_>,
        origins: PyReadonlyArray1<'_, f64>,
        directions: PyReadonlyArray1<'_, f64>,
        mode: &str,
        out: &Bound<'_, PyDict>,
        t_min: f64,
        t_max: f64,
        radius: f64,
        threads: usize,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Option<HitList>> {
        let (origins, directions) = (triples(origins.as_slice())?, triples(directions.as_slice())?);
        let rays = Rays { origins, directions, range: [t_min, t_max], radius };
        let index = &self.index;
        match mode {
            "first" => {
                let mut arrays = HitArrays::borrow(out)?;
                let columns = arrays.columns()?;
                Self::run(py, origins.len(), threads, progress, |threads, monitor| {
                    let first = |ray: &Ray| index.first_intersection(ray);
                    cast_each(&rays, columns, threads, monitor, first, |hits, mut columns| {
                        let hits = hits.iter().enumerate();
                        hits.for_each(|(i, hit)| {
                            columns.set_with_id(i, hit.as_ref().map(|hit| (number(hit.id), &hit.hit)));
                        });
                    })
                })?;
                Ok(None)
            }
            "any" => {
                let mut array = borrowed::<bool>(out, "value")?;
                let values = slice(&mut array)?.unwrap_or_default();
                Self::run(py, origins.len(), threads, progress, |threads, monitor| {
                    let any = |ray: &Ray| index.do_intersect(ray);
                    let store = |hits: Vec<bool>, values: &mut [bool]| values.copy_from_slice(&hits);
                    cast_each(&rays, values, threads, monitor, any, store)
                })?;
                Ok(None)
            }
            "count" | "crossings" | "all" => {
                let mut array = borrowed::<i64>(out, "value")?;
                let values = slice(&mut array)?.unwrap_or_default();
                Self::run(py, origins.len(), threads, progress, |threads, monitor| {
                    if mode == "all" {
                        let all = |ray: &Ray| index.all_intersections(ray);
                        let parts = cast_each(&rays, values, threads, monitor, all, |hits, values: &mut [i64]| {
                            write_counts(values, hits.iter().map(Vec::len));
                            hits.concat()
                        })?;
                        return Ok(Some(hit_list(&parts)));
                    }
                    let count = |ray: &Ray| if mode == "count" { index.count(ray) } else { index.crossings(ray) };
                    cast_each(&rays, values, threads, monitor, count, |counts, values: &mut [i64]| {
                        write_counts(values, counts.into_iter());
                    })?;
                    Ok(None)
                })
            }
            _ => Err(value_error(format!("mode: '{mode}' is none of 'first', 'all', 'count', 'any', 'crossings'"))),
        }
    }
}

/// Writes numbers to a column.
fn write_counts(values: &mut [i64], counts: impl Iterator<Item = usize>) {
    for (value, count) in values.iter_mut().zip(counts) {
        *value = i64::try_from(count).unwrap_or(i64::MAX);
    }
}

/// Makes a list of the hits of all parts.
fn hit_list(parts: &[Vec<ShardHit>]) -> HitList {
    let hits = || parts.iter().flatten();
    HitList { list: hits().map(|hit| hit.hit).collect(), ids: Some(hits().map(|hit| number(hit.id)).collect()) }
}

/// Answers rays one by one, in parts, as [`answer_each`] does for points.
fn cast_each<O: Split, A: Send, R: Send>(
    rays: &Rays<'_>,
    out: O,
    threads: &Threads,
    monitor: &Monitor,
    answer: impl Fn(&Ray) -> Result<A, ShardError> + Sync,
    store: impl Fn(Vec<A>, O) -> R + Sync,
) -> Result<Vec<R>, Failure> {
    rays.check()?;
    let has_failed = AtomicBool::new(false);
    let guarded = |ray: &Ray| guarded(&has_failed, || answer(ray));
    let parts = rays.answer(out, threads, monitor, guarded, |answers, out| {
        Ok(store(answers.into_iter().collect::<Result<_, ShardError>>()?, out))
    });
    first_error(parts)
}

impl Shards {
    /// Writes to an array of `out` what a function decides for each query.
    #[allow(clippy::too_many_arguments, reason = "the Python layer passes them all")]
    fn decide(
        &self,
        py: Python<'_>,
        points: Coordinates<'_>,
        out: &Bound<'_, PyDict>,
        name: &str,
        threads: usize,
        progress: Option<Py<PyAny>>,
        decide: impl Fn(&Point3<f64>) -> Result<bool, ShardError> + Sync + Send,
    ) -> PyResult<()> {
        let mut array = borrowed::<bool>(out, name)?;
        let out = slice(&mut array)?.unwrap_or_default();
        with_positions!(points, points => {
            let work = |threads: &Threads, monitor: &Monitor| {
                check_finite(points)?;
                answer_each(points, out, threads, monitor, decide, |answers, out: &mut [bool]| {
                    out.copy_from_slice(&answers);
                })?;
                Ok(())
            };
            Self::run(py, points.len(), threads, progress, work)
        })
    }
}

/// A writer of shards. `p2m.write_shards` uses it.
#[pyclass(frozen, module = "p2m._p2m")]
pub(crate) struct ShardWriter {
    /// The writer, unless it has finished or failed.
    writer: Mutex<Option<p2m_shards::ShardWriter>>,
}

impl ShardWriter {
    /// Takes the writer, which is dropped and removes its files unless it is put back.
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
        let writer = p2m_shards::ShardWriter::new(&folder, options).map_err(|error| shard_error(&error))?;
        Ok(Self { writer: Mutex::new(Some(writer)) })
    }

    /// Adds the primitives of a scene.
    fn add(&self, py: Python<'_>, scene: &Scene) -> PyResult<()> {
        let mut writer = self.take()?;
        let shared = scene.shared.clone();
        let added = py.detach(|| writer.add_scene(&shared).map(|()| writer));
        let writer = added.map_err(|error| shard_error(&error))?;
        *self.writer.lock().unwrap_or_else(PoisonError::into_inner) = Some(writer);
        Ok(())
    }

    /// Ends writing. What was written is removed unless it was finished.
    fn close(&self) {
        drop(self.writer.lock().unwrap_or_else(PoisonError::into_inner).take());
    }

    /// Builds and writes the shards. An exception of a signal or of the callback ends it after the shard that is being
    /// built, and all files are removed before this returns.
    #[pyo3(signature = (threads, progress))]
    fn finish(&self, py: Python<'_>, threads: usize, progress: Option<Py<PyAny>>) -> PyResult<()> {
        let writer = self.take()?;
        let total = usize::try_from(writer.primitive_count()).unwrap_or(usize::MAX);
        Shards::run(py, total, threads, progress, |_, monitor| {
            writer.finish_with_progress(&mut |done| {
                monitor.set_done(usize::try_from(done).unwrap_or(usize::MAX));
                if monitor.is_cancelled() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            })?;
            Ok(())
        })
    }
}
