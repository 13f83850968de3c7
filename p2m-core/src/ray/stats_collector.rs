//! A collector of ray hits that counts the work of a search.

use super::collector::RayCollector;
use super::crossing::Crossing;
use super::line::Ray;
use crate::PrimitiveId;
use std::ops::ControlFlow;

/// A collector of ray hits, such as [`Hits`](crate::Hits), with work counters. For closest points
/// [`IndexStats`](crate::IndexStats) counts the work.
///
/// ```
/// use nalgebra::{Point3, Vector3};
/// use p2m_bvh::AabbTree;
/// use p2m_core::{Hits, Point, Ray, RayStatsCollector};
///
/// let points = [0.0, 1.0, 2.0].map(|x| Point::new(Point3::new(x, 0.0, 0.0)));
/// let tree = AabbTree::new(&points).unwrap();
/// let rays = [Ray::new(&Point3::new(-1.0, 0.0, 0.0), &Vector3::x()).unwrap()];
/// let [_nodes, _packets, primitives] =
///     RayStatsCollector::count_rays(&rays, &Hits::all(), |ray, stats| tree.visit_ray(ray, stats));
/// assert_eq!(primitives, 3);
/// ```
#[derive(Clone, Debug)]
pub struct RayStatsCollector<C> {
    /// The collector that makes all decisions.
    pub collector: C,
    /// The number of visited nodes.
    pub nodes: usize,
    /// The number of filtered packets.
    pub packets: usize,
    /// The number of primitives that were tested exactly.
    pub primitives: usize,
}

impl<C> RayStatsCollector<C> {
    /// Creates counters at zero around `collector`.
    #[must_use]
    pub fn new(collector: C) -> Self {
        Self { collector, nodes: 0, packets: 0, primitives: 0 }
    }

    /// Returns the total numbers of nodes, packets and primitives over several rays. `visit` searches each ray with a
    /// copy of `collector`.
    pub fn count_rays<'r>(
        rays: impl IntoIterator<Item = &'r Ray>,
        collector: &C,
        visit: impl Fn(&'r Ray, &mut Self),
    ) -> [usize; 3]
    where
        C: RayCollector<'r> + Clone,
    {
        let mut sums = [0; 3];
        for ray in rays {
            let mut stats = Self::new(collector.clone());
            visit(ray, &mut stats);
            sums = [sums[0] + stats.nodes, sums[1] + stats.packets, sums[2] + stats.primitives];
        }
        sums
    }
}

impl<'r, C: RayCollector<'r>> RayCollector<'r> for RayStatsCollector<C> {
    forward_methods!(collector, [], {
        fn only_crossings(self: &Self) -> bool;
        fn limit(self: &Self) -> f64;
        fn wants(self: &Self, primitive: PrimitiveId) -> bool;
        fn offer(self: &mut Self, primitive: PrimitiveId, crossing: &Crossing<'r>) -> ControlFlow<()>;
    });
    fn record_visits(&mut self, nodes: usize, packets: usize) {
        self.nodes += nodes;
        self.packets += packets;
        self.collector.record_visits(nodes, packets);
    }
    fn visit_primitive(&mut self) {
        self.primitives += 1;
        self.collector.visit_primitive();
    }
}
