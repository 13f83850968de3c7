//! An index whose batches can be observed and ended early.

use crate::{BatchAnswer, Best, ClosestPoint, QueryOptions, Real};
use nalgebra::Point3;

/// An index that answers batches step by step and can end them early. [`pairs`](Self::pairs) does the same for searches
/// for pairs.
///
/// Before each step, a thread calls the function with the number of queries that are left. The function answers at most
/// that many by calling its second argument with the number of queries to answer now, and returns whether to go on. All
/// threads of a batch call the function. The functions of [`batch`](crate::batch) order all queries first, so neither
/// the answers nor their order depend on the steps. The places of unanswered queries keep their content.
///
/// ```
/// use nalgebra::Point3;
/// use p2m_core::batch::{BatchOptions, Interruptible, closest_points_into};
/// use p2m_core::{BruteForce, Point};
/// use std::sync::atomic::{AtomicUsize, Ordering};
///
/// let index = BruteForce::new([Point::new(Point3::origin())])?;
/// let answered = AtomicUsize::new(0);
/// let stopping = Interruptible::new(&index, |left, answer| {
///     answer(left.min(2));
///     answered.fetch_add(left.min(2), Ordering::Relaxed) < 2
/// });
/// let queries = [[1.0, 0.0, 0.0]; 9];
/// let (in_order, mut answers) = (BatchOptions::default().with_reorder(false).with_parallel(false), [None; 9]);
/// closest_points_into(&stopping, &queries, &Default::default(), &in_order, &mut answers);
/// assert_eq!(answers.map(|answer| answer.is_some()), [true, true, true, true, false, false, false, false, false]);
/// # Ok::<(), p2m_core::BuildError>(())
/// ```
pub struct Interruptible<'a, I: ?Sized, F> {
    pub(crate) index: &'a I,
    pub(crate) step: F,
}

impl<'a, I: ?Sized, F: Fn(usize, &mut dyn FnMut(usize)) -> bool> Interruptible<'a, I, F> {
    /// Wraps an index so that its batches call `step` before each step.
    pub fn new(index: &'a I, step: F) -> Self {
        Self { index, step }
    }
}

impl<T: Real, I: ClosestPoint<T> + ?Sized, F: Fn(usize, &mut dyn FnMut(usize)) -> bool> ClosestPoint<T>
    for Interruptible<'_, I, F>
{
    fn search(&self, query: &Point3<T>, best: &mut Best<T>) {
        self.index.search(query, best);
    }

    fn answer_queries(
        &self,
        queries: &[Point3<T>],
        options: &QueryOptions<T>,
        answered: &mut dyn FnMut(usize, BatchAnswer<'_, T>),
    ) {
        let mut first = 0;
        while first < queries.len() {
            let goes_on = (self.step)(queries.len() - first, &mut |count| {
                let step = &queries[first..first + count];
                self.index.answer_queries(step, options, &mut |i, found| answered(first + i, found));
                first += count;
            });
            if !goes_on {
                return;
            }
        }
    }
}
