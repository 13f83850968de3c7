//! Batches of queries with closest points.

use crate::columns::{Arrays, Columns, Rows, borrowed, slice};
use crate::errors::value_error;
use crate::index::Index;
use crate::parts::answer_in_parts;
use crate::scene::{Coordinates, with_positions};
use crate::signs::SignRule;
use crate::work::{Monitor, Threads};
use nalgebra::Point3;
use numpy::PyArray1;
use p2m_core::batch::{self, BatchOptions, Interruptible, closest_columns_into};
use p2m_core::{Closest, Position, QueryOptions};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// A row of query points that is not finite.
pub(crate) struct BadRow(pub(crate) usize);

/// The number of rows that are checked at a time.
const ROWS_PER_CHECK: usize = 1 << 10;

/// Checks that all coordinates are finite. A block of rows is checked without branches.
pub(crate) fn check_finite<P: Position<f64>>(points: &[P]) -> Result<(), BadRow> {
    let is_finite = |point: &P| point.point().iter().fold(true, |all, x| all & x.is_finite());
    for (block, rows) in points.chunks(ROWS_PER_CHECK).enumerate() {
        if !rows.iter().fold(true, |all, row| all & is_finite(row)) {
            let row = rows.iter().position(|row| !is_finite(row)).unwrap_or(0);
            return Err(BadRow(block * ROWS_PER_CHECK + row));
        }
    }
    Ok(())
}

/// The exception for a row that is not finite.
pub(crate) fn not_finite(name: &str, row: usize) -> PyErr {
    value_error(format!("{name}: row {row} has a coordinate that is not finite"))
}

impl From<BadRow> for PyErr {
    fn from(BadRow(row): BadRow) -> Self {
        not_finite("points", row)
    }
}

/// The number of queries from which on their order along a curve saves more time than finding it takes.
const MIN_ORDERED_QUERIES: usize = 256;

/// The options of a batch of so many queries. Parts that were divided already are not divided again.
pub(crate) fn batch_options(queries: usize, parallel: bool) -> BatchOptions {
    BatchOptions::default().with_parallel(parallel).with_reorder(queries >= MIN_ORDERED_QUERIES)
}

/// Answers queries with several columns by a function of one query, in parts.
fn answer_rows<P: Position<f64>, A: Send>(
    points: &[P],
    rows: Rows<'_>,
    threads: &Threads,
    monitor: &Monitor,
    answer: impl Fn(&Point3<f64>) -> A + Sync,
    set: impl Fn(&mut Rows<'_>, usize, &A) + Sync,
) {
    answer_in_parts(points.len(), rows, threads, monitor, &|range, mut rows: Rows<'_>| {
        // Queries of brute force take so long that each asks whether to go on.
        let answer = |query: &P| answer(&query.point());
        let options = batch_options(range.len(), false);
        let answers = batch::map(&points[range], &options, Position::point, answer);
        answers.iter().enumerate().for_each(|(i, answer)| set(&mut rows, i, answer));
    });
}

/// Returns the options of queries for the closest point.
pub(crate) fn query_options(max_distance: f64, epsilon: f64, max_visits: Option<u32>) -> QueryOptions<f64> {
    let options = QueryOptions::default().with_max_distance(max_distance).with_epsilon(epsilon);
    options.with_max_visits(max_visits.unwrap_or(u32::MAX))
}

/// Flat lists of all near primitives of some queries.
#[derive(Default)]
struct Flat {
    counts: Vec<usize>,
    answers: Vec<Closest<f64>>,
}

#[pymethods]
impl Index {
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
            let columns = arrays.columns(points.len())?;
            let index = &*self.built.index;
            let work = |threads: &Threads, monitor: &Monitor| {
                check_finite(points)?;
                if certified {
                    let certify = |query: &Point3<f64>| {
                        // Primitives of scenes have vertices, so no answer fails.
                        index.certified_closest_point(query, &options).ok().flatten()
                    };
                    let rows = Rows { columns, width: 1 };
                    answer_rows(points, rows, threads, monitor, certify, |rows, i, answer| {
                        rows.columns.set(i, answer.as_ref());
                    });
                } else {
                    let interruptible = Interruptible::new(index, |left, answer| monitor.run_step(left, answer));
                    let batch = batch_options(points.len(), threads.is_parallel());
                    columns.fill(|columns| closest_columns_into(&interruptible, points, &options, &batch, columns));
                }
                Ok::<(), BadRow>(())
            };
            self.run(py, points.len(), threads, progress, work)
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
            let columns = arrays.columns(points.len() * k)?;
            let index = &*self.built.index;
            let set = |rows: &mut Rows<'_>, i: usize, near: &Vec<Closest<f64>>| {
                for place in 0..k {
                    rows.columns.set(i * k + place, near.get(place));
                }
            };
            let work = |threads: &Threads, monitor: &Monitor| {
                check_finite(points)?;
                let nearest = |query: &Point3<f64>| index.k_nearest(query, k, max_distance);
                answer_rows(points, Rows { columns, width: k }, threads, monitor, nearest, set);
                Ok::<(), BadRow>(())
            };
            self.run(py, points.len(), threads, progress, work)
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
            let index = &*self.built.index;
            let work = |threads: &Threads, monitor: &Monitor| {
                check_finite(points)?;
                let parts = answer_in_parts(points.len(), (), threads, monitor, &|range, ()| {
                    let options = batch_options(range.len(), false);
                    let answers =
                        batch::map(&points[range], &options, Position::point, |query| index.all_within(query, radius));
                    Flat { counts: answers.iter().map(Vec::len).collect(), answers: answers.concat() }
                });
                let total = parts.iter().map(|part| part.answers.len()).sum();
                let mut list = Vec::with_capacity(total);
                let mut at = 0;
                for mut part in parts {
                    for count in part.counts {
                        counts[at] = i64::try_from(count).unwrap_or(i64::MAX);
                        at += 1;
                    }
                    list.append(&mut part.answers);
                }
                Ok::<_, BadRow>(NearList { list, ids: None })
            };
            self.run(py, points.len(), threads, progress, work)
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
        let mut array = borrowed::<bool>(out, "is_within")?;
        let out = slice(&mut array)?.unwrap_or_default();
        with_positions!(points, points => {
            let index = &*self.built.index;
            let work = |threads: &Threads, monitor: &Monitor| {
                check_finite(points)?;
                answer_in_parts(points.len(), out, threads, monitor, &|range, out: &mut [bool]| {
                    let options = batch_options(range.len(), false);
                    let answers = batch::map(&points[range], &options, Position::point, |query| {
                        index.is_any_within(query, radius)
                    });
                    out.copy_from_slice(&answers);
                });
                Ok::<(), BadRow>(())
            };
            self.run(py, points.len(), threads, progress, work)
        })
    }

    /// Writes signed distances to `out`.
    #[pyo3(signature = (points, out, sign, inside_is_negative, max_distance, threads, progress))]
    #[allow(clippy::too_many_arguments, reason = "the Python layer passes them all")]
    fn signed_distance(
        &self,
        py: Python<'_>,
        points: Coordinates<'_>,
        out: &Bound<'_, PyDict>,
        sign: &str,
        inside_is_negative: bool,
        max_distance: f64,
        threads: usize,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<()> {
        let signed = self.signs(py, SignRule::from_name(sign)?, threads)?;
        let mut array = borrowed::<f64>(out, "signed_distance")?;
        let out = slice(&mut array)?.unwrap_or_default();
        let factor = if inside_is_negative { 1.0 } else { -1.0 };
        let options = QueryOptions::default().with_max_distance(max_distance);
        // Without primitives there is nothing inside. The side of a point beyond the largest distance is not known.
        let missing = if max_distance < f64::INFINITY { f64::NAN } else { factor * f64::INFINITY };
        with_positions!(points, points => {
            let work = |threads: &Threads, monitor: &Monitor| {
                check_finite(points)?;
                answer_in_parts(points.len(), out, threads, monitor, &|range, out: &mut [f64]| {
                    let batch = batch_options(range.len(), false);
                    let queries: Vec<Point3<f64>> = points[range].iter().map(Position::point).collect();
                    let answers = signed.closest_points(&queries, &options, &batch);
                    for (value, answer) in out.iter_mut().zip(&answers) {
                        *value = match answer {
                            Some(answer) => answer.distance().map_or(f64::NAN, |distance| factor * distance),
                            None => missing,
                        };
                    }
                });
                Ok::<(), BadRow>(())
            };
            self.run(py, points.len(), threads, progress, work)
        })
    }
}

/// The primitives within a distance of some queries, before they are columns.
#[pyclass(frozen, module = "p2m._p2m")]
pub(crate) struct NearList {
    pub(crate) list: Vec<Closest<f64>>,
    /// The ids of the primitives, where they are not those of the answers.
    pub(crate) ids: Option<Vec<i64>>,
}

#[pymethods]
impl NearList {
    fn __len__(&self) -> usize {
        self.list.len()
    }

    /// Writes the columns of the arrays of `out`, which have a place for each primitive of the list.
    fn fill(&self, py: Python<'_>, out: &Bound<'_, PyDict>) -> PyResult<()> {
        let mut arrays = Arrays::borrow(out)?;
        let mut columns: Columns<'_> = arrays.columns(self.list.len())?;
        py.detach(|| match &self.ids {
            None => self.list.iter().enumerate().for_each(|(i, closest)| columns.set(i, Some(closest))),
            Some(ids) => {
                let answers = ids.iter().copied().zip(&self.list);
                answers.enumerate().for_each(|(i, answer)| columns.set_with_id(i, Some(answer)));
            }
        });
        Ok(())
    }
}
