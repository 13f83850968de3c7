//! A collector of hits that counts what a search does.

use super::collect::RayCollector;
use super::crossing::Crossing;
use super::line::Ray;
use crate::PrimitiveId;
use std::ops::ControlFlow;

/// A collector with counters, such as [`Hits`](crate::Hits): [`Counting`](crate::Counting) for rays.
///
/// ```
/// use nalgebra::{Point3, Vector3};
/// use p2m_core::hierarchy::TreeIndex;
/// use p2m_core::{BuildIndex, Directions, Hits, Kdop, KdopOptions, Point, Ray, RayCounting};
///
/// let points = [0.0, 1.0, 2.0].map(|x| Point::new(Point3::new(x, 0.0, 0.0)));
/// let tree = TreeIndex::<f64, _, Kdop<14>>::build(&points, &KdopOptions::default()).unwrap();
/// let rays = [Ray::new(&Point3::new(-1.0, 0.0, 0.0), &Vector3::x()).unwrap()];
/// let [_nodes, _packets, primitives] =
///     RayCounting::of_rays(&rays, &Hits::all(), |ray, counting| tree.visit_ray(ray, counting));
/// assert_eq!(primitives, 3);
/// ```
#[derive(Clone, Debug)]
pub struct RayCounting<C> {
    /// What decides.
    pub collector: C,
    /// Nodes visited.
    pub nodes: usize,
    /// Packets filtered.
    pub packets: usize,
    /// Primitives tested exactly.
    pub primitives: usize,
}

impl<C> RayCounting<C> {
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

impl<'r, C: RayCollector<'r>> RayCollector<'r> for RayCounting<C> {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hierarchy::TreeIndex;
    use crate::{BuildIndex, Hits, Kdop, KdopOptions, Triangle};
    use nalgebra::{Point3, Vector3};

    /// Wants the hit of one primitive.
    #[derive(Clone)]
    struct Only(usize, Vec<PrimitiveId>);

    impl<'r> RayCollector<'r> for Only {
        fn wants(&self, primitive: PrimitiveId) -> bool {
            primitive.index() == self.0
        }
        fn offer(&mut self, primitive: PrimitiveId, _: &Crossing<'r>) -> ControlFlow<()> {
            self.1.push(primitive);
            ControlFlow::Continue(())
        }
    }

    #[test]
    fn what_is_not_wanted_is_not_tested() {
        let points = [0.0, 1.0, 2.0].map(|x| crate::Point::new(Point3::new(x, 0.0, 0.0)));
        let tree = TreeIndex::<f64, _, Kdop<6>>::build(&points, &KdopOptions::default()).unwrap();
        let ray = Ray::new(&Point3::new(-1.0, 0.0, 0.0), &Vector3::x()).unwrap();
        for wanted in 0..3 {
            let mut counting = RayCounting::new(Only(wanted, Vec::new()));
            tree.visit_ray(&ray, &mut counting);
            assert_eq!((counting.primitives, counting.collector.1), (1, vec![PrimitiveId::new(wanted)]));
        }
    }

    #[test]
    fn what_is_counted_is_what_is_wanted() {
        let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]].map(|[x, y]| Point3::new(x, y, 0.0));
        let square =
            [Triangle::new(corners[0], corners[1], corners[2]), Triangle::new(corners[0], corners[2], corners[3])];
        let tree = TreeIndex::<f64, _, Kdop<6>>::build(square, &KdopOptions::default()).unwrap();
        let ray = Ray::new(&Point3::new(1.0, 1.0, 3.0), &Vector3::new(0.0, 0.0, -1.0)).unwrap();
        let search = |wanted: Hits<'static>| {
            let mut counting = RayCounting::new(RayCounting::new(wanted));
            tree.visit_ray(&ray, &mut counting);
            let inner = &counting.collector;
            assert_eq!(
                [counting.nodes, counting.packets, counting.primitives],
                [inner.nodes, inner.packets, inner.primitives]
            );
            (counting.primitives, counting.limit(), counting.collector.collector)
        };
        assert_eq!(search(Hits::any()).0, 1);
        assert_eq!(search(Hits::first()).1, 3.0);
        assert_eq!(search(Hits::all()).2.all.len(), 2);
        assert_eq!(search(Hits::count()).2.count, 2);
        assert_eq!(search(Hits::crossings()).2.count, 1);
    }
}
