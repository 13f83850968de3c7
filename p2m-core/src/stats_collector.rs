//! A collector that counts what a search does.

use crate::{Best, Collector, PrimitiveId, Projection, QueryOptions, Real};
use nalgebra::Point3;

/// [`Best`] with counters: they are deterministic, so tests can hold a search to them where times only vary.
#[derive(Clone, Debug)]
pub struct StatsCollector<T: Real> {
    /// What decides.
    pub best: Best<T>,
    /// Nodes visited.
    pub nodes: usize,
    /// Packets filtered.
    pub packets: usize,
    /// Primitives that were offered.
    pub primitives: usize,
}

impl<T: Real> StatsCollector<T> {
    /// Counts from zero around `best`.
    #[must_use]
    pub fn new(best: Best<T>) -> Self {
        Self { best, nodes: 0, packets: 0, primitives: 0 }
    }

    /// Nodes, packets and primitives of a query with default options, searched by `visit`.
    pub fn of_query(query: &Point3<T>, visit: impl FnOnce(&Point3<T>, &mut Self)) -> [usize; 3] {
        let mut counting = Self::new(Best::new(&QueryOptions::default()));
        visit(query, &mut counting);
        [counting.nodes, counting.packets, counting.primitives]
    }

    /// The same of some queries in all.
    pub fn of_queries<'a>(
        queries: impl IntoIterator<Item = &'a Point3<T>>,
        visit: impl Fn(&Point3<T>, &mut Self),
    ) -> [usize; 3] {
        let mut sums = [0; 3];
        for query in queries {
            let counts = Self::of_query(query, &visit);
            sums = [0, 1, 2].map(|i| sums[i] + counts[i]);
        }
        sums
    }
}

impl<T: Real> Collector for StatsCollector<T> {
    fn prune_above(&self) -> f64 {
        self.best.prune_above()
    }
    fn prune_above_for(&self, id: PrimitiveId) -> f64 {
        self.best.prune_above_for(id)
    }
    fn prune_given(&self, square: f64) -> f64 {
        self.best.prune_given(square)
    }
    fn is_approximate(&self) -> bool {
        self.best.is_approximate()
    }
    fn prune_held(&self, square: f64) -> f64 {
        self.best.prune_held(square)
    }
    fn is_content(&self, holds: bool) -> bool {
        self.best.is_content(holds)
    }
    fn forgo(&mut self, square: f64) {
        self.best.forgo(square);
    }
    fn is_nearest_only(&self) -> bool {
        self.best.is_nearest_only()
    }
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
