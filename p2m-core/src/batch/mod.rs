//! Batches of queries: reordered, several at a time, on all cores.
//!
//! Queries that are near each other visit the same nodes and packets. So queries are answered along a curve that fills
//! their box \[Hamilton2006\], and backends let neighbours on it take turns
//! ([`ClosestPoint::answer_queries`]). Answers are written to the places of their
//! queries, and only those columns that the caller asks for are computed.
//!
//! Each thread orders and answers a part of its own, so no step is left to one thread.

mod columns;
mod order;
mod query_point;

pub use columns::ClosestColumns;
pub use query_point::QueryPoint;

use crate::{Closest, ClosestPoint, QueryOptions, Real};
use columns::Sink;
use order::sorted_along_curve;

/// Options of a batch. They affect its speed alone, apart from the last bits of lower bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct BatchOptions {
    /// Whether queries are answered along a space-filling curve. Sorting is wasted on queries whose order is spatially
    /// coherent already, such as those of a scan or a grid.
    pub reorder: bool,
    /// Whether all threads of the current pool are used. Without the feature `rayon` one thread is used.
    pub parallel: bool,
}

impl Default for BatchOptions {
    /// Returns options with reordering and all threads.
    fn default() -> Self {
        Self { reorder: true, parallel: true }
    }
}

impl BatchOptions {
    /// Sets whether queries are answered along a space-filling curve.
    #[must_use]
    pub fn with_reorder(self, reorder: bool) -> Self {
        Self { reorder, ..self }
    }
    /// Sets whether all threads are used.
    #[must_use]
    pub fn with_parallel(self, parallel: bool) -> Self {
        Self { parallel, ..self }
    }
}

/// The largest number of queries that are ordered and answered at a time by one thread.
const MAX_QUERIES_PER_PART: usize = 1 << 20;
/// The number of queries below which a batch is not divided among threads any further.
const MIN_QUERIES_PER_PART: usize = 1 << 10;
/// The number of parts for each thread, so that none waits long for the others.
const PARTS_PER_THREAD: usize = 4;
/// The number of ordered queries that are handed to the index at a time.
const QUERIES_PER_BLOCK: usize = 1 << 10;

/// Answers `queries` into `out`, in their order.
///
/// Distance, primitive, point, feature and weights are those of [`ClosestPoint::closest_point_with`] for each query.
/// The certified lower bound may differ in its last bits, since it depends on the primitives that a search has
/// evaluated. It does not depend on the other queries, their order or the number of threads.
///
/// [`closest_columns_into`] is faster where only some parts of the answers are needed.
///
/// ```
/// use p2m_core::{BruteForce, Point, batch};
/// use nalgebra::Point3;
///
/// let index = BruteForce::new([0.0, 10.0].map(|x| Point::new(Point3::new(x, 0.0, 0.0)))).unwrap();
/// let queries = [7.0, 2.0, 9.0].map(|x| Point3::new(x, 0.0, 0.0));
/// let mut answers = [None; 3];
/// batch::closest_points_into(&index, &queries, &Default::default(), &Default::default(), &mut answers);
/// assert_eq!(answers.map(|a| a.unwrap().distance), [3.0, 2.0, 1.0]);
/// ```
///
/// # Panics
/// It panics if the slices differ in length.
///
/// # Complexity
/// Ordering n queries takes O(n) time. Each thread needs 20 bytes for each query of the part that it orders, which has
/// at most 2^20 queries.
pub fn closest_points_into<T: Real, I: ClosestPoint<T> + Sync + ?Sized>(
    index: &I,
    queries: &[impl QueryPoint<T>],
    options: &QueryOptions<T>,
    batch: &BatchOptions,
    out: &mut [Option<Closest<T>>],
) {
    assert_eq!(queries.len(), out.len(), "one answer for each query");
    BatchRunner::new(index, options, batch).answer(queries, out);
}

/// Answers `queries` into columns, in their order: only what is asked for is computed and written.
///
/// The values are those of [`closest_points_into`].
///
/// ```
/// use p2m_core::batch::{ClosestColumns, closest_columns_into};
/// use p2m_core::{BruteForce, Point};
/// use nalgebra::Point3;
///
/// let index = BruteForce::new([0.0, 10.0].map(|x| Point::new(Point3::new(x, 0.0, 0.0)))).unwrap();
/// let queries: [[f32; 3]; 2] = [[7.0, 0.0, 0.0], [2.0, 0.0, 0.0]];
/// let (mut distance, mut primitive) = ([0.0; 2], [0; 2]);
/// let columns = ClosestColumns::default().with_distance(&mut distance).with_primitive(&mut primitive);
/// closest_columns_into(&index, &queries, &Default::default(), &Default::default(), columns);
/// assert_eq!((distance, primitive), ([3.0, 2.0], [1, 0]));
/// ```
///
/// # Panics
/// It panics if a column has another length than `queries`.
///
/// # Complexity
/// Ordering n queries takes O(n) time. Each thread needs 20 bytes for each query of the part that it orders, which has
/// at most 2^20 queries.
pub fn closest_columns_into<T: Real, I: ClosestPoint<T> + Sync + ?Sized>(
    index: &I,
    queries: &[impl QueryPoint<T>],
    options: &QueryOptions<T>,
    batch: &BatchOptions,
    columns: ClosestColumns<'_, T>,
) {
    if let Some(len) = columns.len() {
        assert_eq!(queries.len(), len, "one value for each query");
        BatchRunner::new(index, options, batch).answer(queries, columns);
    }
}

/// Returns the distances of `queries`, in their order; infinity for a query without an answer.
///
/// ```
/// use p2m_core::{BruteForce, Point, batch};
/// use nalgebra::Point3;
///
/// let index = BruteForce::new([Point::new(Point3::new(1.0, 0.0, 0.0))]).unwrap();
/// assert_eq!(batch::distances(&index, &[[4.0, 4.0, 0.0], [f64::NAN; 3]]), [5.0, f64::INFINITY]);
/// ```
#[must_use]
pub fn distances<T: Real, I: ClosestPoint<T> + Sync + ?Sized>(index: &I, queries: &[impl QueryPoint<T>]) -> Vec<T> {
    let mut distance = vec![T::INFINITY; queries.len()];
    let columns = ClosestColumns::default().with_distance(&mut distance);
    closest_columns_into(index, queries, &QueryOptions::default(), &BatchOptions::default(), columns);
    distance
}

/// An index with the options of a batch.
struct BatchRunner<'a, T: Real, I: ?Sized> {
    index: &'a I,
    options: &'a QueryOptions<T>,
    reorder: bool,
    parallel: bool,
}

impl<'a, T: Real, I: ClosestPoint<T> + Sync + ?Sized> BatchRunner<'a, T, I> {
    fn new(index: &'a I, options: &'a QueryOptions<T>, batch: &BatchOptions) -> Self {
        Self { index, options, reorder: batch.reorder, parallel: batch.parallel }
    }

    /// Answers queries, divided among the threads.
    fn answer(&self, queries: &[impl QueryPoint<T>], out: impl Sink<T>) {
        #[cfg(feature = "rayon")]
        if self.parallel {
            let threads = rayon::current_num_threads();
            let part = queries.len().div_ceil(threads * PARTS_PER_THREAD);
            return self.answer_in_parallel(queries, out, part.clamp(MIN_QUERIES_PER_PART, MAX_QUERIES_PER_PART));
        }
        let _ = (self.parallel, PARTS_PER_THREAD, MIN_QUERIES_PER_PART);
        self.answer_parts(queries, out);
    }

    /// Halves the queries until a part is small enough for one thread.
    #[cfg(feature = "rayon")]
    fn answer_in_parallel(&self, queries: &[impl QueryPoint<T>], out: impl Sink<T>, part: usize) {
        if queries.len() <= part {
            return self.answer_parts(queries, out);
        }
        let middle = queries.len() / 2;
        let (first_out, second_out) = out.split(middle);
        let (first, second) = queries.split_at(middle);
        rayon::join(
            || self.answer_in_parallel(first, first_out, part),
            || self.answer_in_parallel(second, second_out, part),
        );
    }

    /// Answers queries on this thread, part by part.
    fn answer_parts(&self, mut queries: &[impl QueryPoint<T>], mut out: impl Sink<T>) {
        while queries.len() > MAX_QUERIES_PER_PART {
            let (part, rest) = queries.split_at(MAX_QUERIES_PER_PART);
            let (mut part_out, rest_out) = out.split(MAX_QUERIES_PER_PART);
            self.answer_part(part, &mut part_out);
            (queries, out) = (rest, rest_out);
        }
        self.answer_part(queries, &mut out);
    }

    /// Answers at most [`MAX_QUERIES_PER_PART`] queries.
    #[allow(clippy::cast_possible_truncation, reason = "a part has fewer than 2^32 queries")]
    fn answer_part(&self, queries: &[impl QueryPoint<T>], out: &mut impl Sink<T>) {
        let order = if self.reorder { sorted_along_curve(queries) } else { (0..queries.len() as u32).collect() };
        let mut block = Vec::with_capacity(QUERIES_PER_BLOCK.min(queries.len()));
        for positions in order.chunks(QUERIES_PER_BLOCK) {
            block.clear();
            block.extend(positions.iter().map(|&position| queries[position as usize].point()));
            self.index.answer_queries(&block, self.options, &mut |i, found| out.set(positions[i] as usize, found));
        }
    }
}
