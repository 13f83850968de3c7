//! Batches of queries: reordered, with hints, on all cores.
//!
//! Queries that are near each other visit the same nodes and have similar answers. So queries are answered along a
//! curve that fills their box \[Hamilton2006\], each with the primitive of the previous answer as its hint, and the
//! answers are put back into the order of the queries.

use crate::curve;
use crate::real::to_f64_array;
use crate::{Aabb, Closest, ClosestPoint, QueryOptions, Real};
use nalgebra::Point3;

/// Options of a batch. They affect its speed alone, apart from the last bits of lower bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct BatchOptions {
    /// Whether queries are answered along a space-filling curve. Sorting is wasted on queries whose order is spatially
    /// coherent already, such as those of a scan or a grid.
    pub reorder: bool,
    /// Whether the primitive of the previous answer is evaluated first, which makes trees faster. Without hints an
    /// index may interleave several queries, which makes the P2M index faster. If it is `None`,
    /// [`ClosestPoint::gains_from_hints`] decides.
    pub hints: Option<bool>,
    /// Whether all threads of the current pool are used. Without the feature `rayon` one thread is used.
    pub parallel: bool,
}

impl Default for BatchOptions {
    /// Returns options with reordering, all threads, and hints if the index gains from them.
    fn default() -> Self {
        Self { reorder: true, hints: None, parallel: true }
    }
}

impl BatchOptions {
    /// Sets whether queries are answered along a space-filling curve.
    #[must_use]
    pub fn with_reorder(self, reorder: bool) -> Self {
        Self { reorder, ..self }
    }
    /// Sets whether the primitive of the previous answer is evaluated first.
    #[must_use]
    pub fn with_hints(self, hints: bool) -> Self {
        Self { hints: Some(hints), ..self }
    }
    /// Sets whether all threads are used.
    #[must_use]
    pub fn with_parallel(self, parallel: bool) -> Self {
        Self { parallel, ..self }
    }
}

/// The number of reordered queries whose answers are kept before they are put into the order of the queries.
const QUERIES_PER_BLOCK: usize = 1 << 16;
/// The number of queries that a thread takes at a time.
#[cfg(feature = "rayon")]
const QUERIES_PER_CHUNK: usize = 1 << 9;

/// Answers `queries` into `out`, in their order.
///
/// Distance, primitive, point, feature and weights are those of [`ClosestPoint::closest_point_with`] for each query.
/// The certified lower bound may differ in its last bits, since it depends on the primitives that a search has
/// evaluated. Hints between queries are not used for approximate options, whose answers would depend on them, nor if
/// `options` has a hint of its own.
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
/// It panics if the slices differ in length, and for more than 2^32 queries to reorder.
///
/// # Complexity
/// Sorting n queries takes O(n log n) time and 16 bytes a query, besides the queries themselves.
pub fn closest_points_into<T: Real, I: ClosestPoint<T> + Sync + ?Sized>(
    index: &I,
    queries: &[Point3<T>],
    options: &QueryOptions<T>,
    batch: &BatchOptions,
    out: &mut [Option<Closest<T>>],
) {
    assert_eq!(queries.len(), out.len(), "one answer for each query");
    let hints =
        batch.hints.unwrap_or_else(|| index.gains_from_hints()) && options.hint.is_none() && !options.is_approximate();
    let runner = BatchRunner { index, options, hints };
    if !batch.reorder {
        return runner.answer(queries, batch.parallel, out);
    }
    let order = sorted_along_curve(queries, batch.parallel);
    let mut block = Vec::with_capacity(QUERIES_PER_BLOCK.min(queries.len()));
    let mut answers = vec![None; QUERIES_PER_BLOCK.min(queries.len())];
    for entries in order.chunks(QUERIES_PER_BLOCK) {
        block.clear();
        block.extend(entries.iter().map(|&(_, position)| queries[position as usize]));
        runner.answer(&block, batch.parallel, &mut answers[..entries.len()]);
        for (&(_, position), answer) in entries.iter().zip(&answers) {
            out[position as usize] = *answer;
        }
    }
}

/// An index with the options of a batch.
struct BatchRunner<'a, T: Real, I: ?Sized> {
    index: &'a I,
    options: &'a QueryOptions<T>,
    hints: bool,
}

impl<T: Real, I: ClosestPoint<T> + Sync + ?Sized> BatchRunner<'_, T, I> {
    /// Answers queries in their order.
    fn answer(&self, queries: &[Point3<T>], parallel: bool, out: &mut [Option<Closest<T>>]) {
        #[cfg(feature = "rayon")]
        if parallel {
            use rayon::prelude::*;
            let chunks = queries.par_chunks(QUERIES_PER_CHUNK).zip(out.par_chunks_mut(QUERIES_PER_CHUNK));
            return chunks.for_each(|(queries, out)| self.answer(queries, false, out));
        }
        let _ = parallel;
        if !self.hints {
            return self.index.closest_points_into(queries, self.options, out);
        }
        let mut options = *self.options;
        for (query, answer) in queries.iter().zip(out) {
            *answer = self.index.closest_point_with(query, &options);
            if let Some(closest) = answer {
                options.hint = Some(closest.primitive);
            }
        }
    }
}

/// Returns the position on the curve and the position in `queries` of each query, sorted by the former.
fn sorted_along_curve<T: Real>(queries: &[Point3<T>], parallel: bool) -> Vec<(u64, u32)> {
    let finite = queries.iter().filter(|q| q.iter().all(|x| x.is_finite()));
    let bounds = finite.fold(Aabb::empty(), |b, q| b.union(&Aabb { min: *q, max: *q }));
    let (min, max) = (to_f64_array(&bounds.min), to_f64_array(&bounds.max));
    // Coordinates are halved first, since the difference of two finite numbers may be infinite.
    let scale: [f64; 3] = std::array::from_fn(|k| CELLS_PER_AXIS / (max[k] * 0.5 - min[k] * 0.5));
    let key = |q: &Point3<T>| {
        let q = to_f64_array(q);
        // NaN becomes 0, which also arises on an axis without extent.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates, which keeps the order")]
        let cell = |k: usize| (((q[k] * 0.5 - min[k] * 0.5) * scale[k]) as u32).min((1 << BITS_PER_AXIS) - 1);
        curve::position([cell(0), cell(1), cell(2)], BITS_PER_AXIS)
    };
    let position = |i: usize| u32::try_from(i).expect("at most 2^32 queries");
    let mut order: Vec<(u64, u32)> = queries.iter().enumerate().map(|(i, q)| (key(q), position(i))).collect();
    #[cfg(feature = "rayon")]
    if parallel {
        rayon::slice::ParallelSliceMut::par_sort_unstable(order.as_mut_slice());
        return order;
    }
    let _ = parallel;
    order.sort_unstable();
    order
}

/// The binary logarithm of [`CELLS_PER_AXIS`].
const BITS_PER_AXIS: u32 = 16;
/// The number of cells along each axis of the box around the queries.
const CELLS_PER_AXIS: f64 = (1u32 << BITS_PER_AXIS) as f64;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_contains_every_query_once_and_neighbours_together() {
        let queries: Vec<Point3<f64>> =
            (0..4096u32).map(|i| Point3::new(f64::from(i % 16), f64::from(i / 16 % 16), f64::from(i / 256))).collect();
        let order = sorted_along_curve(&queries, false);
        let mut positions: Vec<u32> = order.iter().map(|o| o.1).collect();
        let steps: f64 = positions.windows(2).map(|w| (queries[w[0] as usize] - queries[w[1] as usize]).norm()).sum();
        assert!(steps / 4095.0 < 1.7, "{steps}");
        positions.sort_unstable();
        assert!(positions.into_iter().eq(0..4096));
    }

    #[test]
    fn queries_of_all_kinds_have_a_position() {
        let queries = [f64::NAN, f64::INFINITY, f64::MAX, -f64::MAX, 0.0].map(|x| Point3::new(x, x, 1.0));
        assert_eq!(sorted_along_curve(&queries, false).len(), 5);
        assert!(sorted_along_curve::<f64>(&[], false).is_empty());
    }
}
