//! Checks that a search for hits only tests and offers the primitives that its collector wants, for trees of boxes and
//! of k-DOPs.
#![cfg(all(feature = "bvh", feature = "kdop"))]

use nalgebra::{Point3, Vector3};
use p2m::bvh::{TreeIndex, Volume};
use p2m::core::{Crossing, Hits, RayCollector, RayStatsCollector};
use p2m::kdop::Kdop;
use p2m::{Aabb, Point, PrimitiveId, PrimitiveSet, Ray, Triangle};
use std::ops::ControlFlow;

/// A collector that wants only the hits of one primitive.
#[derive(Clone)]
struct HitsOfOne(usize, Vec<PrimitiveId>);

impl<'r> RayCollector<'r> for HitsOfOne {
    fn wants(&self, primitive: PrimitiveId) -> bool {
        primitive.index() == self.0
    }
    fn offer(&mut self, primitive: PrimitiveId, _: &Crossing<'r>) -> ControlFlow<()> {
        self.1.push(primitive);
        ControlFlow::Continue(())
    }
}

fn tree<V: Volume<Options: Default>, S: PrimitiveSet<f64> + Sync>(set: S) -> TreeIndex<f64, S, V> {
    TreeIndex::build_with(set, &Default::default()).expect("valid")
}

fn test_only_wanted_primitives<V: Volume<Options: Default>>() {
    let points = [0.0, 1.0, 2.0].map(|x| Point::new(Point3::new(x, 0.0, 0.0)));
    let tree = tree::<V, _>(&points);
    let ray = Ray::new(&Point3::new(-1.0, 0.0, 0.0), &Vector3::x()).expect("a direction");
    for wanted in 0..3 {
        let mut counting = RayStatsCollector::new(HitsOfOne(wanted, Vec::new()));
        tree.visit_ray(&ray, &mut counting);
        assert_eq!((counting.primitives, counting.collector.1), (1, vec![PrimitiveId::new(wanted)]));
    }
}

#[test]
fn primitives_that_the_collector_does_not_want_are_not_tested() {
    test_only_wanted_primitives::<Aabb<f64>>();
    test_only_wanted_primitives::<Kdop<6>>();
}

fn count_what_the_mode_needs<V: Volume<Options: Default>>() {
    let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]].map(|[x, y]| Point3::new(x, y, 0.0));
    let square = [Triangle::new(corners[0], corners[1], corners[2]), Triangle::new(corners[0], corners[2], corners[3])];
    let tree = tree::<V, _>(&square);
    let ray = Ray::new(&Point3::new(1.0, 1.0, 3.0), &Vector3::new(0.0, 0.0, -1.0)).expect("a direction");
    let search = |wanted: Hits<'static>| {
        let mut counting = RayStatsCollector::new(RayStatsCollector::new(wanted));
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

#[test]
fn collectors_count_only_what_their_mode_needs() {
    count_what_the_mode_needs::<Aabb<f64>>();
    count_what_the_mode_needs::<Kdop<6>>();
}
