//! Tests of near queries with known answers, and of their counters. `registry.rs` compares the answers of every backend
//! (k nearest, all within a distance, any within a distance, filtered nearest) with the primitives one by one.
#![cfg(all(feature = "bvh", feature = "interception", feature = "kdop"))]
#![allow(clippy::float_cmp, reason = "bitwise equality is what is tested")]

use nalgebra::Point3;
use p2m::core::Near;
use p2m::core::Projection;
use p2m::{AabbTree, ClosestPoint, NearQuery, PrimitiveId, PrimitiveSet, QueryOptions, Soup};
use p2m_testkit::rng;
use p2m_testkit::scenes::{Kinds, Layout, soup};

#[test]
fn invalid_queries_return_none() {
    let soup = soup(&mut rng("stated", 0), Kinds::Mixed, Layout::Uniform, 300);
    let index = AabbTree::new(&soup).expect("valid scene");
    let at = soup.positions()[0];
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(index.k_nearest(&Point3::new(0.0, bad, 0.0), 3, f64::INFINITY).is_empty());
        assert!(!index.is_any_within(&Point3::new(bad, 0.0, 0.0), f64::INFINITY));
    }
    for radius in [f64::NAN, -1.0, f64::NEG_INFINITY, -f64::from_bits(1)] {
        assert!(index.all_within(&at, radius).is_empty() && !index.is_any_within(&at, radius), "{radius}");
    }
    assert!(index.is_any_within(&at, 0.0) && index.is_any_within(&at, f64::INFINITY));
    assert_eq!(index.all_within(&at, f64::INFINITY).len(), soup.len());
    let empty = AabbTree::<f64, _>::new(Soup::new(vec![], []).expect("empty")).expect("valid");
    assert!(empty.k_nearest(&at, 3, f64::INFINITY).is_empty() && !empty.is_any_within(&at, f64::INFINITY));
}

/// The counters reveal a lost bound or a lost early exit.
#[test]
fn searches_end_early() {
    let soup = soup(&mut rng("near sheet", 0), Kinds::Triangles, Layout::Sheet, 20_000);
    let index = AabbTree::new(&soup).expect("valid scene");
    let mut rng = rng("near counters", 0);
    let mut sums = [0; 4];
    for _ in 0..200 {
        let q = p2m_testkit::scenes::query(&mut rng, soup.positions());
        let radius = index.closest_point(&q).expect("not empty").distance;
        let mut calls = 0;
        let mut count_calls = |_: PrimitiveId| {
            calls += 1;
            true
        };
        assert!(index.closest_point_among(&q, &QueryOptions::default(), &mut count_calls).is_some());
        sums[0] += calls;
        sums[1] += index.k_nearest(&q, 8, f64::INFINITY).len();
        let counted = Counted(&index, std::cell::Cell::new(0));
        assert!(counted.is_any_within(&q, radius * 1.5));
        sums[2] += counted.1.replace(0);
        counted.k_nearest(&q, 8, f64::INFINITY);
        sums[3] += counted.1.get();
    }
    println!("asked {}, found {}, packets for any {}, for eight {}", sums[0], sums[1], sums[2], sums[3]);
    assert_eq!(sums[1], 1_600);
    let limits = [330, 1_600, 220, 750];
    assert!((0..4).all(|i| sums[i] <= limits[i]), "{sums:?}");
}

/// A tree that counts packets.
struct Counted<'a, I>(&'a I, std::cell::Cell<usize>);

impl NearQuery<f64> for Counted<'_, AabbTree<f64, &Soup<f64>>> {
    fn search_near(&self, query: &Point3<f64>, near: &mut Near<'_>) {
        self.0.visit(query, &mut Packets(near, &self.1));
    }
}

struct Packets<'a, 'b>(&'a mut Near<'b>, &'a std::cell::Cell<usize>);

impl p2m::core::Collector for Packets<'_, '_> {
    fn prune_above(&self) -> f64 {
        self.0.prune_above()
    }
    fn offer(&mut self, id: PrimitiveId, projection: Projection) {
        self.0.offer(id, projection);
    }
    fn visit_packet(&mut self) {
        self.1.set(self.1.get() + 1);
    }
}
