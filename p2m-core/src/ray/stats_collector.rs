//! A collector of hits that counts what a search does.

use super::collector::RayCollector;
use super::crossing::Crossing;
use super::line::Ray;
use crate::PrimitiveId;
use std::ops::ControlFlow;

/// A collector with counters, such as [`Hits`](crate::Hits): [`StatsCollector`](crate::StatsCollector) for rays.
///
/// ```
/// use nalgebra::{Point3, Vector3};
/// use p2m_bvh::AabbTree;
/// use p2m_core::{BuildIndex, Hits, Point, Ray, RayStatsCollector};
///
/// let points = [0.0, 1.0, 2.0].map(|x| Point::new(Point3::new(x, 0.0, 0.0)));
/// let tree = AabbTree::build(&points, &Default::default()).unwrap();
/// let rays = [Ray::new(&Point3::new(-1.0, 0.0, 0.0), &Vector3::x()).unwrap()];
/// let [_nodes, _packets, primitives] =
///     RayStatsCollector::of_rays(&rays, &Hits::all(), |ray, counting| tree.visit_ray(ray, counting));
/// assert_eq!(primitives, 3);
/// ```
#[derive(Clone, Debug)]
pub struct RayStatsCollector<C> {
    /// What decides.
    pub collector: C,
    /// Nodes visited.
    pub nodes: usize,
    /// Packets filtered.
    pub packets: usize,
    /// Primitives tested exactly.
    pub primitives: usize,
}

impl<C> RayStatsCollector<C> {
    /// Counts from zero around `collector`.
    #[must_use]
    pub fn new(collector: C) -> Self {
        Self { collector, nodes: 0, packets: 0, primitives: 0 }
    }

    /// Nodes, packets and primitives of some rays, in all: each is searched by `visit` with a copy of `collector`.
    pub fn of_rays<'r>(
        rays: impl IntoIterator<Item = &'r Ray>,
        collector: &C,
        visit: impl Fn(&'r Ray, &mut Self),
    ) -> [usize; 3]
    where
        C: RayCollector<'r> + Clone,
    {
        let mut sums = [0; 3];
        for ray in rays {
            let mut counting = Self::new(collector.clone());
            visit(ray, &mut counting);
            sums = [sums[0] + counting.nodes, sums[1] + counting.packets, sums[2] + counting.primitives];
        }
        sums
    }
}

impl<'r, C: RayCollector<'r>> RayCollector<'r> for RayStatsCollector<C> {
    fn only_crossings(&self) -> bool {
        self.collector.only_crossings()
    }
    fn limit(&self) -> f64 {
        self.collector.limit()
    }
    fn wants(&self, primitive: PrimitiveId) -> bool {
        self.collector.wants(primitive)
    }
    fn offer(&mut self, primitive: PrimitiveId, crossing: &Crossing<'r>) -> ControlFlow<()> {
        self.collector.offer(primitive, crossing)
    }
    fn visit_node(&mut self) {
        self.nodes += 1;
        self.collector.visit_node();
    }
    fn visit_packet(&mut self) {
        self.packets += 1;
        self.collector.visit_packet();
    }
    fn visit_primitive(&mut self) {
        self.primitives += 1;
        self.collector.visit_primitive();
    }
}
