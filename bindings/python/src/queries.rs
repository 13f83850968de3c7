//! Batches of point queries.

use crate::arrays::{Coordinates, borrowed, slice, with_positions};
use crate::columns::{ClosestArrays, ClosestValues, Near, NearList, Rows};
use crate::index::Index;
use crate::memory::{collected, joined, out_of_memory};
use crate::parts::{answer_in_parts, batch_options, check_finite};
use crate::sharded::{ANSWERS_PER_PART, in_shards};
use crate::signs::Signed as SignedIndex;
use crate::source::{Part, Source};
use crate::work::{Monitor, Run, Threads, catch};
use nalgebra::Point3;
use numpy::{PyReadonlyArray1, PyReadwriteArray1};
use p2m_core::batch::{BatchOptions, Interruptible, closest_columns_into};
use p2m_core::{AnyIndex, Closest, ClosestPoint, Feature, Position, PrimitiveId, QueryOptions};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::ops::Range;

/// The number of queries that shards answer at a time if each query has any number of answers.
const LISTS_PER_PART: usize = 1 << 16;

/// Returns the options of queries for the closest point.
fn query_options(max_distance: f64, epsilon: f64, max_visits: Option<u32>) -> QueryOptions<f64> {
    let options = QueryOptions::default().with_max_distance(max_distance).with_epsilon(epsilon);
    options.with_max_visits(max_visits.unwrap_or(u32::MAX))
}

/// Returns an answer of an index over the whole scene, with the id of its primitive.
fn in_whole(closest: Closest<f64>) -> Near {
    (i64::from(closest.primitive.number()), closest)
}

/// Returns an index as an index that answers point queries, which all do.
#[allow(clippy::unnecessary_wraps, reason = "other kinds of queries are refused by some indexes")]
fn any_index(index: &Index) -> PyResult<&dyn AnyIndex> {
    Ok(&*index.built.index)
}

/// Answers closest-point queries into the arrays of `out`.
#[pyfunction]
pub(crate) fn closest(
    py: Python<'_>,
    index: Source<'_>,
    points: Coordinates<'_>,
    out: &Bound<'_, PyDict>,
    max_distance: f64,
    epsilon: f64,
    max_visits: Option<u32>,
    certified: bool,
    run: Run,
) -> PyResult<()> {
    let options = query_options(max_distance, epsilon, max_visits);
    let mut arrays = ClosestArrays::borrow(out)?;
    with_positions!(points, points => {
        let columns = arrays.columns(points.len())?;
        let check = || check_finite("points", points, 1);
        if let (Source::Whole(index), false) = (&index, certified) {
            let index = index.get();
            return index.run(py, points.len(), run, |threads, monitor| {
                check()?;
                let interruptible =
                    Interruptible::new(&*index.built.index, |left, answer| monitor.run_step(left, answer));
                let batch = batch_options(points.len(), threads.is_parallel());
                columns.fill(|columns| closest_columns_into(&interruptible, points, &options, &batch, columns));
                Ok(())
            });
        }
        let size = (points.len(), ANSWERS_PER_PART);
        index.answer(py, size, columns, run, check, |part, range, mut columns: ClosestValues<'_>| {
            let answers = part.ask(
                &points[range],
                Position::point,
                any_index,
                // The primitives of scenes have vertices, so certification never fails.
                |index, query| index.certified_closest_point(query, &options).ok().flatten().map(in_whole),
                |shards, points| match certified {
                    true => shards.certified_closest_points(points, &options),
                    false => shards.closest_points(points, &options),
                },
                |answer| answer.map(in_shards),
            )?;
            columns.set_all(answers.iter().map(Option::as_ref));
            Ok(())
        })?;
        Ok(())
    })
}

/// Answers queries for the k nearest primitives into the arrays of `out`, which have k rows for each query.
#[pyfunction]
pub(crate) fn k_nearest(
    py: Python<'_>,
    index: Source<'_>,
    points: Coordinates<'_>,
    k: usize,
    out: &Bound<'_, PyDict>,
    max_distance: f64,
    run: Run,
) -> PyResult<()> {
    let mut arrays = ClosestArrays::borrow(out)?;
    with_positions!(points, points => {
        let rows = Rows { columns: arrays.columns(points.len() * k)?, width: k };
        let (size, check) =
            ((points.len(), (ANSWERS_PER_PART / k.max(1)).max(1)), || check_finite("points", points, 1));
        index.answer(py, size, rows, run, check, |part, range, mut rows: Rows<ClosestValues<'_>>| {
            let answers = near(part, &points[range], k, max_distance)?;
            rows.columns.set_all(answers.iter().flat_map(|near| (0..k).map(|place| near.get(place))));
            Ok(())
        })?;
    });
    Ok(())
}

/// Finds the k nearest primitives for a part of a batch.
fn near<P: Position<f64>>(part: &Part<'_>, points: &[P], k: usize, radius: f64) -> PyResult<Vec<Vec<Near>>> {
    part.ask(
        points,
        Position::point,
        any_index,
        |index, query| {
            let near = index.try_k_nearest(query, k, radius).unwrap_or_else(|_| out_of_memory());
            collected(near.into_iter().map(in_whole))
        },
        |shards, points| shards.k_nearest(points, k, radius),
        |near| collected(near.into_iter().map(in_shards)),
    )
}

/// Returns all primitives within a distance of each query, and writes their numbers to `counts`.
#[pyfunction]
pub(crate) fn within(
    py: Python<'_>,
    index: Source<'_>,
    points: Coordinates<'_>,
    radius: f64,
    mut counts: PyReadwriteArray1<'_, i64>,
    run: Run,
) -> PyResult<NearList> {
    let counts = counts.as_slice_mut()?;
    let parts = with_positions!(points, points => {
        let (size, check) = ((points.len(), LISTS_PER_PART), || check_finite("points", points, 1));
        index.answer(py, size, counts, run, check, |part, range, counts: &mut [i64]| {
            let answers = near(part, &points[range], usize::MAX, radius)?;
            write_counts(counts, answers.iter().map(Vec::len));
            Ok(joined(answers))
        })?
    });
    py.detach(|| catch(|| joined(parts))).map(NearList)
}

/// Writes counts to a column.
pub(crate) fn write_counts(values: &mut [i64], counts: impl Iterator<Item = usize>) {
    for (value, count) in values.iter_mut().zip(counts) {
        *value = i64::try_from(count).unwrap_or(i64::MAX);
    }
}

/// Writes to `out` whether any primitive is within a distance of each query.
#[pyfunction]
pub(crate) fn is_any_within(
    py: Python<'_>,
    index: Source<'_>,
    points: Coordinates<'_>,
    radius: f64,
    out: &Bound<'_, PyDict>,
    run: Run,
) -> PyResult<()> {
    let mut array = borrowed::<bool>(out, "is_within")?;
    let out = slice(&mut array)?.unwrap_or_default();
    with_positions!(points, points => {
        let (size, check) = ((points.len(), ANSWERS_PER_PART), || check_finite("points", points, 1));
        index.answer(py, size, out, run, check, |part, range, out: &mut [bool]| {
            let answers = part.ask(
                &points[range],
                Position::point,
                any_index,
                |index, query| index.is_any_within(query, radius),
                |shards, points| shards.is_any_within(points, radius),
                |is_within| is_within,
            )?;
            out.copy_from_slice(&answers);
            Ok(())
        })?;
    });
    Ok(())
}

#[pymethods]
impl Index {
    /// Writes the normals at features of primitives to `out`; NaN if there is no normal.
    fn normals(
        &self,
        py: Python<'_>,
        primitive: PyReadonlyArray1<'_, i64>,
        feature: PyReadonlyArray1<'_, u8>,
        out: &Bound<'_, PyDict>,
    ) -> PyResult<()> {
        let normals = self.surface_normals(py);
        let mut array = borrowed::<f64>(out, "normal")?;
        let out = slice(&mut array)?.unwrap_or_default();
        let (primitive, feature) = (primitive.as_slice()?, feature.as_slice()?);
        for ((place, primitive), code) in out.chunks_exact_mut(3).zip(primitive).zip(feature) {
            let normal = Feature::from_code(*code)
                .zip(usize::try_from(*primitive).ok().filter(|id| *id < PrimitiveId::MAX_COUNT))
                .and_then(|(feature, id)| normals.at(PrimitiveId::new(id), feature));
            place.copy_from_slice(&normal.map_or([f64::NAN; 3], Into::into));
        }
        Ok(())
    }

    /// Returns the name of the rule that decides signs, and a sentence with the reason if the surface is open or not
    /// consistently oriented.
    fn sign_rule(&self, py: Python<'_>, sign: &str, threads: usize) -> PyResult<(&'static str, Option<&'static str>)> {
        let signed = self.signs(py, sign, threads)?;
        Ok((signed.rule().name(), signed.note()))
    }

    /// Writes to `out` whether each point is inside.
    fn contains(
        &self,
        py: Python<'_>,
        points: Coordinates<'_>,
        out: &Bound<'_, PyDict>,
        sign: &str,
        run: Run,
    ) -> PyResult<()> {
        let signed = self.signs(py, sign, run.0)?;
        let mut array = borrowed::<bool>(out, "contains")?;
        let out = slice(&mut array)?.unwrap_or_default();
        self.answer_signed(py, points, &signed, out, run, |index, points, batch, out| {
            out.copy_from_slice(&signed.contains_each_by(index, points, batch));
        })
    }

    /// Writes signed distances to `out`.
    fn signed_distance(
        &self,
        py: Python<'_>,
        points: Coordinates<'_>,
        out: &Bound<'_, PyDict>,
        sign: &str,
        inside_is_negative: bool,
        max_distance: f64,
        run: Run,
    ) -> PyResult<()> {
        let signed = self.signs(py, sign, run.0)?;
        let mut array = borrowed::<f64>(out, "signed_distance")?;
        let out = slice(&mut array)?.unwrap_or_default();
        let factor = if inside_is_negative { 1.0 } else { -1.0 };
        let options = QueryOptions::default().with_max_distance(max_distance);
        // Without primitives, everything is outside. The side of a point beyond the largest distance is unknown.
        let missing = if max_distance < f64::INFINITY { f64::NAN } else { factor * f64::INFINITY };
        let value_of = |distance: f64| if distance == f64::INFINITY { missing } else { factor * distance };
        self.answer_signed(py, points, &signed, out, run, |index, points, batch, out| {
            signed.distances_into(index, points, &options, batch, out);
            out.iter_mut().for_each(|distance| *distance = value_of(*distance));
        })
    }
}

impl Index {
    /// Answers queries by an index with signs. `answer` is called with the index that it has to use.
    fn answer_signed<V: Copy + Send>(
        &self,
        py: Python<'_>,
        points: Coordinates<'_>,
        signed: &SignedIndex,
        out: &mut [V],
        run: Run,
        answer: impl Fn(&(dyn ClosestPoint<f64> + Sync), &[Point3<f64>], &BatchOptions, &mut [V]) + Sync,
    ) -> PyResult<()> {
        with_positions!(points, points => {
            let work = |threads: &Threads, monitor: &Monitor| {
                check_finite("points", points, 1)?;
                let answer = |index: &(dyn ClosestPoint<f64> + Sync), range: Range<usize>, parallel, out: &mut [V]| {
                    let batch = batch_options(range.len(), parallel);
                    let points: Vec<Point3<f64>> = points[range].iter().map(Position::point).collect();
                    answer(index, &points, &batch, out);
                };
                if signed.is_closed() {
                    // All points are ordered together, so that neighbours share queries and signs.
                    let index = Interruptible::new(&*self.built.index, |left, answer| monitor.run_step(left, answer));
                    answer(&index, 0..points.len(), threads.is_parallel(), out);
                } else {
                    // The index does only a small part of the work, so steps of the index would not suffice for
                    // interrupts.
                    answer_in_parts(points.len(), out, threads, monitor, &|range, out: &mut [V]| {
                        answer(&self.built.index, range, false, out);
                    });
                }
                Ok(())
            };
            self.run(py, points.len(), run, work)
        })
    }
}
