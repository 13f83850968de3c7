//! A closest-point collector that counts the work of a search.

use crate::{Best, Collector, PrimitiveId, Projection, QueryOptions, Real};
use nalgebra::Point3;

/// [`Best`] with work counters. Counts are deterministic, so tests can compare them, unlike times.
#[derive(Clone, Debug)]
pub struct StatsCollector<T: Real> {
    /// The collector that makes all decisions.
    pub best: Best<T>,
    /// The number of visited nodes.
    pub nodes: usize,
    /// The number of filtered packets.
    pub packets: usize,
    /// The number of offered primitives.
    pub primitives: usize,
}

impl<T: Real> StatsCollector<T> {
    /// Creates counters at zero around `best`.
    #[must_use]
    pub fn new(best: Best<T>) -> Self {
        Self { best, nodes: 0, packets: 0, primitives: 0 }
    }

    /// Runs a search with [`best`](Self::best), and adds its work to the counters.
    pub fn count(&mut self, search: impl FnOnce(&mut Best<T>)) {
        let before = self.best.minimum_ref().counts();
        search(&mut self.best);
        let after = self.best.minimum_ref().counts();
        let [nodes, packets, primitives] = [0, 1, 2].map(|i| (after[i].wrapping_sub(before[i])) as usize);
        self.nodes += nodes;
        self.packets += packets;
        self.primitives += primitives;
    }

    /// Returns the numbers of nodes, packets and primitives of one query with default options. `visit` runs the search.
    pub fn count_query(query: &Point3<T>, visit: impl FnOnce(&Point3<T>, &mut Self)) -> [usize; 3] {
        let mut stats = Self::new(Best::new(&QueryOptions::default()));
        visit(query, &mut stats);
        [stats.nodes, stats.packets, stats.primitives]
    }

    /// Returns the sums of [`count_query`](Self::count_query) over several queries.
    pub fn count_queries<'a>(
        queries: impl IntoIterator<Item = &'a Point3<T>>,
        visit: impl Fn(&Point3<T>, &mut Self),
    ) -> [usize; 3] {
        let mut sums = [0; 3];
        for query in queries {
            let counts = Self::count_query(query, &visit);
            sums = [0, 1, 2].map(|i| sums[i] + counts[i]);
        }
        sums
    }
}

impl<T: Real> Collector for StatsCollector<T> {
    forward_collector_decisions!(best, []);
    fn offer(&mut self, id: PrimitiveId, projection: Projection) {
        self.primitives += 1;
        self.best.offer(id, projection);
    }
    fn visit_node(&mut self) {
        self.nodes += 1;
        self.best.visit_node();
    }
    fn visit_packet(&mut self) {
        self.packets += 1;
        self.best.visit_packet();
    }
}
