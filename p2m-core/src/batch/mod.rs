//! Batches of queries: reordered, interleaved, and on all cores.
//!
//! Nearby queries visit the same nodes and packets. A batch therefore answers its queries along a space-filling curve
//! through their box \[Hamilton2006\], and backends interleave the searches of neighbours on the curve
//! ([`ClosestPoint::answer_queries`]). Answers are written at the positions of their queries, and only requested
//! columns are computed.
//!
//! Each thread orders and answers a part of its own, so no step runs on one thread alone.

mod columns;
mod interruptible;
mod order;
mod parts;

pub use columns::ClosestColumns;
pub use interruptible::Interruptible;

use crate::real::to_f64_array;
use crate::{Closest, ClosestPoint, Position, QueryOptions, Real};
use columns::Sink;
use nalgebra::Point3;
use order::sorted_along_curve;
use parts::answer_parts;

/// Options of a batch. They only affect its speed, apart from the last bits of lower bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct BatchOptions {
    /// Whether queries are answered along a space-filling curve. Sorting is wasted on queries that are already in a
    /// spatially coherent order, such as the points of a scan or a grid.
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

/// The number of ordered queries that are passed to the index at a time.
const QUERIES_PER_BLOCK: usize = 1 << 10;

/// Answers `queries` into `out`, in their order.
///
/// Each answer has the distance, primitive, point, feature and weights that [`ClosestPoint::closest_point_with`]
/// returns for its query. The certified lower bound may differ in its last bits, since it depends on the primitives
/// that a search has evaluated. It does not depend on the other queries, their order or the number of threads.
///
/// [`closest_columns_into`] is faster if only some fields of the answers are needed.
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
/// Ordering n queries takes O(n) time. A thread orders parts of at most 2^20 queries, and needs 20 bytes per query of
/// its part.
pub fn closest_points_into<T: Real, I: ClosestPoint<T> + Sync + ?Sized>(
    index: &I,
    queries: &[impl Position<T>],
    options: &QueryOptions<T>,
    batch: &BatchOptions,
    out: &mut [Option<Closest<T>>],
) {
    assert_eq!(queries.len(), out.len(), "one answer for each query");
    answer_closest(index, queries, options, batch, out);
}

/// Answers `queries` into columns, in their order. Only the requested columns are computed and written.
///
/// The values equal those of [`closest_points_into`].
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
/// Ordering n queries takes O(n) time. A thread orders parts of at most 2^20 queries, and needs 20 bytes per query of
/// its part.
pub fn closest_columns_into<T: Real, I: ClosestPoint<T> + Sync + ?Sized>(
    index: &I,
    queries: &[impl Position<T>],
    options: &QueryOptions<T>,
    batch: &BatchOptions,
    columns: ClosestColumns<'_, T>,
) {
    if let Some(len) = columns.len() {
        assert_eq!(queries.len(), len, "one value for each query");
        answer_closest(index, queries, options, batch, columns);
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
pub fn distances<T: Real, I: ClosestPoint<T> + Sync + ?Sized>(index: &I, queries: &[impl Position<T>]) -> Vec<T> {
    let mut distance = vec![T::INFINITY; queries.len()];
    let columns = ClosestColumns::default().with_distance(&mut distance);
    closest_columns_into(index, queries, &QueryOptions::default(), &BatchOptions::default(), columns);
    distance
}

/// Calls a function for each query, on all threads, and returns the results in the order of the queries.
///
/// The function is called once per query, along a curve through the positions of the queries, so that nearby queries
/// find the data that they visit in the cache. Use it for the k nearest primitives, for all primitives within a
/// distance, for certified answers, for signs, and for rays, whose position is their origin. Queries whose position is
/// not finite are called in an unspecified order.
///
/// ```
/// use p2m_core::{BruteForce, NearQuery, Point, batch};
/// use nalgebra::Point3;
///
/// let index = BruteForce::new([0.0, 1.0, 10.0].map(|x| Point::new(Point3::new(x, 0.0, 0.0)))).unwrap();
/// let queries = [7.0, 0.4].map(|x| Point3::new(x, 0.0, 0.0));
/// let nearest_two = batch::map(&queries, &Default::default(), |q| *q, |q| index.k_nearest(q, 2, f64::INFINITY));
/// assert_eq!(nearest_two[1].iter().map(|c| c.primitive.index()).collect::<Vec<_>>(), [0, 1]);
/// ```
///
/// # Complexity
/// Ordering n queries takes O(n) time. Each result takes the memory of an `Option` until all results are known.
pub fn map<Q: Sync, R: Send>(
    queries: &[Q],
    batch: &BatchOptions,
    position: impl Fn(&Q) -> Point3<f64> + Sync,
    answer: impl Fn(&Q) -> R + Sync,
) -> Vec<R> {
    let mut out: Vec<Option<R>> = std::iter::repeat_with(|| None).take(queries.len()).collect();
    map_parts_into(queries, batch, position, &mut out, |queries, order, out| {
        for i in order {
            out[*i as usize] = Some(answer(&queries[*i as usize]));
        }
    });
    // Every query has been answered, so `flatten` drops nothing.
    out.into_iter().flatten().collect()
}

/// Answers a batch part by part. The function receives the queries of a part, their order along the curve, and the
/// places of their answers.
#[doc(hidden)]
pub fn map_parts_into<Q: Sync, R: Send>(
    queries: &[Q],
    batch: &BatchOptions,
    position: impl Fn(&Q) -> Point3<f64> + Sync,
    out: &mut [R],
    answer: impl Fn(&[Q], &[u32], &mut [R]) + Sync,
) {
    answer_parts(queries, out, batch.parallel, &|queries, out| {
        answer(queries, &order(queries, batch, |query| position(query).coords.into()), out);
    });
}

/// Answers closest-point queries into any destination.
fn answer_closest<T: Real, Q: Position<T>, O: Sink<T>>(
    index: &(impl ClosestPoint<T> + Sync + ?Sized),
    queries: &[Q],
    options: &QueryOptions<T>,
    batch: &BatchOptions,
    out: O,
) {
    answer_parts(queries, out, batch.parallel, &|queries: &[Q], out: &mut O| {
        let order = order(queries, batch, |query| to_f64_array(&query.point()));
        let mut block = Vec::with_capacity(QUERIES_PER_BLOCK.min(queries.len()));
        for positions in order.chunks(QUERIES_PER_BLOCK) {
            block.clear();
            block.extend(positions.iter().map(|&position| queries[position as usize].point()));
            index.answer_queries(&block, options, &mut |i, found| out.set(positions[i] as usize, found));
        }
    });
}

/// Returns the order in which the queries of a part are answered.
#[allow(clippy::cast_possible_truncation, reason = "a part has fewer than 2^32 queries")]
fn order<Q>(queries: &[Q], batch: &BatchOptions, position: impl Fn(&Q) -> [f64; 3]) -> Vec<u32> {
    if batch.reorder { sorted_along_curve(queries, position) } else { (0..queries.len() as u32).collect() }
}
