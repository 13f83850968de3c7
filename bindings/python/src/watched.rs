//! An index whose batches can be watched and cancelled.

use crate::work::Monitor;
use nalgebra::Point3;
use p2m_core::{Best, ClosestPoint, Found, QueryOptions};
use std::time::Instant;

/// An index that answers queries in steps, and leaves the rest out when the work is cancelled.
///
/// Batches of the library order all their queries and hand them to the index by the thousand. So the order of a batch
/// does not depend on how often it is watched, and steps cost nothing that can be measured.
pub(crate) struct Watched<'a, I: ?Sized> {
    pub(crate) index: &'a I,
    pub(crate) monitor: &'a Monitor,
}

impl<I: ClosestPoint<f64> + ?Sized> ClosestPoint<f64> for Watched<'_, I> {
    fn search(&self, query: &Point3<f64>, best: &mut Best<f64>) {
        self.index.search(query, best);
    }

    fn answer_queries(
        &self,
        queries: &[Point3<f64>],
        options: &QueryOptions<f64>,
        answered: &mut dyn FnMut(usize, Found<'_, f64>),
    ) {
        let mut first = 0;
        while first < queries.len() && !self.monitor.is_cancelled() {
            let count = self.monitor.step().min(queries.len() - first);
            let start = Instant::now();
            if count == queries.len() {
                self.index.answer_queries(queries, options, answered);
            } else {
                let step = &queries[first..first + count];
                self.index.answer_queries(step, options, &mut |i, found| answered(first + i, found));
            }
            first += count;
            self.monitor.end_step(count, start);
        }
    }
}
