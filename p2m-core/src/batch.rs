//! Many queries at once: reordered, with hints, on all cores.
//!
//! Queries that are near each other visit the same nodes, and the answer of one is nearly that of the next. So queries
//! are answered along a curve that fills their box \[Hamilton2006\], each with the primitive of the one before as its
//! hint, and the answers put back into the order of the queries.

use crate::curve;
use crate::real::to_f64_array;
use crate::{Aabb, Closest, ClosestPoint, QueryOptions, Real};
use nalgebra::Point3;

/// How a batch is worked through. Answers do not depend on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct BatchOptions {
    /// Answer along a space-filling curve. Queries that come in such an order anyway (a scan, a grid) save the sorting
    /// without.
    pub reorder: bool,
    /// Try the primitive of the previous answer first, which pays for trees. Without, an index may answer several queries
    /// side by side, as the P2M index does.
    pub hints: bool,
    /// Use all threads of the current pool; needs the feature `rayon`, without which one thread does it all.
    pub parallel: bool,
}

impl Default for BatchOptions {
    /// Everything.
    fn default() -> Self {
        Self { reorder: true, hints: true, parallel: true }
    }
}

impl BatchOptions {
    /// Along a curve, or in the order given.
    #[must_use]
    pub fn with_reorder(self, reorder: bool) -> Self {
        Self { reorder, ..self }
    }
    /// With the previous answer as hint, or without.
    #[must_use]
    pub fn with_hints(self, hints: bool) -> Self {
        Self { hints, ..self }
    }
    /// On all threads, or on one.
    #[must_use]
    pub fn with_parallel(self, parallel: bool) -> Self {
        Self { parallel, ..self }
    }
}

/// Queries that are answered before their answers are put in place.
const BLOCK: usize = 1 << 16;
/// Queries that one thread takes at a time.
#[cfg(feature = "rayon")]
const SHARE: usize = 1 << 9;

/// Answers `queries` into `out`, in their order: distance, primitive, point, feature and weights are those of
/// [`ClosestPoint::closest_point_with`] for each. The certified lower bound may differ in its last bits, since it
/// depends on what the search has seen. An answer within an epsilon does depend on hints, so none are given then; nor
/// where `options` have one.
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
/// If the slices differ in length, and for more than 2^32 - 1 queries to reorder.
///
/// # Complexity
/// O(n log n) for sorting n queries, 16 bytes each, besides the queries themselves.
pub fn closest_points_into<T: Real, I: ClosestPoint<T> + Sync + ?Sized>(
    index: &I,
    queries: &[Point3<T>],
    options: &QueryOptions<T>,
    batch: &BatchOptions,
    out: &mut [Option<Closest<T>>],
) {
    assert_eq!(queries.len(), out.len(), "one answer for each query");
    let hints = batch.hints && options.hint.is_none() && !options.is_approximate();
    let share = Share { index, options, hints };
    if !batch.reorder {
        return share.answer(queries, batch.parallel, out);
    }
    let order = sorted_along_curve(queries, batch.parallel);
    let mut block = Vec::with_capacity(BLOCK.min(queries.len()));
    let mut answers = vec![None; BLOCK.min(queries.len())];
    for places in order.chunks(BLOCK) {
        block.clear();
        block.extend(places.iter().map(|&(_, place)| queries[place as usize]));
        share.answer(&block, batch.parallel, &mut answers[..places.len()]);
        for (&(_, place), answer) in places.iter().zip(&answers) {
            out[place as usize] = *answer;
        }
    }
}

struct Share<'a, T: Real, I: ?Sized> {
    index: &'a I,
    options: &'a QueryOptions<T>,
    hints: bool,
}

impl<T: Real, I: ClosestPoint<T> + Sync + ?Sized> Share<'_, T, I> {
    fn answer(&self, queries: &[Point3<T>], parallel: bool, out: &mut [Option<Closest<T>>]) {
        #[cfg(feature = "rayon")]
        if parallel {
            use rayon::prelude::*;
            let shares = queries.par_chunks(SHARE).zip(out.par_chunks_mut(SHARE));
            return shares.for_each(|(queries, out)| self.answer(queries, false, out));
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

/// The places of the queries with their place on the curve, sorted.
fn sorted_along_curve<T: Real>(queries: &[Point3<T>], parallel: bool) -> Vec<(u64, u32)> {
    let finite = queries.iter().filter(|q| q.iter().all(|x| x.is_finite()));
    let bounds = finite.fold(Aabb::empty(), |b, q| b.union(&Aabb { min: *q, max: *q }));
    let (min, max) = (to_f64_array(&bounds.min), to_f64_array(&bounds.max));
    // Halves first: the difference of two finite numbers may not be finite.
    let scale: [f64; 3] = std::array::from_fn(|k| CELLS / (max[k] * 0.5 - min[k] * 0.5));
    let key = |q: &Point3<T>| {
        let q = to_f64_array(q);
        // NaN, and an axis without extent, become 0.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates, which keeps the order")]
        let cell = |k: usize| (((q[k] * 0.5 - min[k] * 0.5) * scale[k]) as u32).min((1 << BITS) - 1);
        curve::position([cell(0), cell(1), cell(2)], BITS)
    };
    let place = |i: usize| u32::try_from(i).expect("fewer than 2^32 queries");
    let mut order: Vec<(u64, u32)> = queries.iter().enumerate().map(|(i, q)| (key(q), place(i))).collect();
    #[cfg(feature = "rayon")]
    if parallel {
        rayon::slice::ParallelSliceMut::par_sort_unstable(order.as_mut_slice());
        return order;
    }
    let _ = parallel;
    order.sort_unstable();
    order
}

/// The binary logarithm of the number of cells along each axis of the box around the queries.
const BITS: u32 = 16;
const CELLS: f64 = (1u32 << BITS) as f64;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_holds_every_query_once_and_neighbours_together() {
        let queries: Vec<Point3<f64>> =
            (0..4096u32).map(|i| Point3::new(f64::from(i % 16), f64::from(i / 16 % 16), f64::from(i / 256))).collect();
        let order = sorted_along_curve(&queries, false);
        let mut places: Vec<u32> = order.iter().map(|o| o.1).collect();
        let steps: f64 = places.windows(2).map(|w| (queries[w[0] as usize] - queries[w[1] as usize]).norm()).sum();
        assert!(steps / 4095.0 < 1.7, "{steps}");
        places.sort_unstable();
        assert!(places.into_iter().eq(0..4096));
    }

    #[test]
    fn queries_of_all_kinds_have_a_place() {
        let queries = [f64::NAN, f64::INFINITY, f64::MAX, -f64::MAX, 0.0].map(|x| Point3::new(x, x, 1.0));
        assert_eq!(sorted_along_curve(&queries, false).len(), 5);
        assert!(sorted_along_curve::<f64>(&[], false).is_empty());
    }
}
