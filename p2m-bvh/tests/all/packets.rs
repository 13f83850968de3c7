//! Tests packets and wide nodes: every instruction set, other collectors, moved sets, batches, and the work of queries.
#![allow(clippy::float_cmp, reason = "bitwise equality is what is tested")]

use nalgebra::{Point3, Vector3};
use p2m_bvh::{AabbTree, SplitOptions};
use p2m_core::{Best, Collector};
use p2m_core::{
    BruteForce, BuildError, BuildIndex, Closest, ClosestPoint, Point, Primitive, PrimitiveId, PrimitiveSet,
    QueryOptions, Real, Segment, Shape, Soup, Triangle, batch,
};
use p2m_core::{Isa, Projection};
use p2m_testkit::scenes::{self, Kinds, LAYOUTS, Layout, kinds_and_layout};
use p2m_testkit::{amount, cases, rng};
use rand::{Rng, RngExt};

/// Returns a query near, inside, at vertices, on a lattice, far or very far.
fn query(rng: &mut impl Rng, soup: &Soup<f64>) -> Point3<f64> {
    let bounds = soup.aabb();
    let size = bounds.max - bounds.min;
    let vertex = soup.positions()[rng.random_range(0..soup.positions().len())];
    let mut random = || Vector3::from_fn(|_, _| rng.random::<f64>() - 0.5);
    let (a, b) = (random(), random());
    match rng.random_range(0..6) {
        0 => vertex,
        1 => vertex + size.component_mul(&a) * 1e-3,
        2 => nalgebra::center(&bounds.min, &bounds.max) + size.component_mul(&a) * 1.1,
        3 => (vertex + size.component_mul(&a)).map(f64::round),
        4 => vertex + b * size.norm() * 100.0,
        _ => vertex + b * size.norm() * 10f64.powi(rng.random_range(3..18)),
    }
}

fn same<T: Real>(a: Option<Closest<T>>, b: Option<Closest<T>>, what: &str) {
    let bits =
        |c: Closest<T>| (c.distance.to_f64().to_bits(), c.primitive, c.feature, c.point.map(|x| x.to_f64().to_bits()));
    assert_eq!(a.map(bits), b.map(bits), "{what}");
}

#[test]
fn every_instruction_set_answers_as_brute_force() {
    println!("{:?}", Isa::available());
    for case in cases(144, 48) {
        let (mut rng, (kinds, layout)) = (rng("instruction sets", case), kinds_and_layout(case));
        let soup = scenes::soup(&mut rng, kinds, layout, amount(400, 90));
        let queries: Vec<_> = (0..amount(100, 8)).map(|_| query(&mut rng, &soup)).collect();
        // Each kind in each layout comes with each scale, and the first scenes have all scales as well.
        let e = [0, -340, 310, 0, -900, 900][((case + case / 24) % 6) as usize];
        if e != 0 && layout == Layout::Sizes {
            continue; // The scale is beyond the range of f64.
        }
        let scale = |p: &Point3<f64>| p.map(|x| x * 2f64.powi(e));
        let queries: Vec<_> = queries.iter().map(scale).filter(|q| q.iter().all(|x| x.is_finite())).collect();
        let soup = Soup::new(soup.positions().iter().map(scale).collect(), soup.elements()).expect("finite");
        let brute = BruteForce::new(&soup).expect("valid");
        let mut tree = AabbTree::new(&soup).expect("valid");
        for isa in Isa::available() {
            tree = tree.with_isa(isa);
            for q in &queries {
                let what = format!("case {case}: {isa} {kinds:?} {layout:?} 2^{e} {q}");
                let expected = brute.closest_point(q);
                same(tree.closest_point(q), expected, &what);
                let near = QueryOptions::default().with_max_distance(expected.expect("one").distance);
                same(tree.closest_point_with(q, &near), brute.closest_point_with(q, &near), &what);
            }
        }
        let (Some(single), true) = (scenes::narrow(&soup), e == 0) else { continue };
        let brute = BruteForce::new(&single).expect("valid");
        let mut tree = AabbTree::new(&single).expect("valid");
        for isa in Isa::available() {
            tree = tree.with_isa(isa);
            for q in queries.iter().map(|q| q.map(|x| x as f32)).filter(|q| q.iter().all(|x| x.is_finite())) {
                let what = format!("case {case}: f32 {isa} {kinds:?} {layout:?} {q}");
                same(tree.closest_point(&q), brute.closest_point(&q), &what);
            }
        }
    }
}

/// A collector of all primitives within a radius except some ids, which no shortcut for the nearest primitive may skip.
struct Within {
    square: f64,
    found: Vec<(PrimitiveId, u64)>,
}

impl Collector for Within {
    fn prune_above(&self) -> f64 {
        self.square
    }
    fn offer(&mut self, id: PrimitiveId, projection: Projection) {
        if !id.index().is_multiple_of(3) && projection.key.square_above() <= self.square {
            self.found.push((id, projection.key.distance().to_bits()));
        }
    }
}

#[test]
fn collectors_of_more_than_the_nearest_get_all() {
    let (mut total, mut searches) = (0, 0);
    let cases = cases(24, 24);
    for case in cases.clone() {
        let (mut rng, (kinds, layout)) = (rng("collectors", case), kinds_and_layout(case));
        let soup = scenes::soup(&mut rng, kinds, layout, amount(400, 150));
        let tree = AabbTree::new(&soup).expect("valid");
        for _ in 0..amount(50, 6) {
            let q = query(&mut rng, &soup);
            let nearest = tree.closest_point(&q).expect("not empty").distance;
            let radius = nearest * rng.random_range(1.0..3.0) + soup.aabb().max.coords.norm() * 0.01;
            let mut collector = Within { square: radius * radius, found: Vec::new() };
            tree.visit(&q, &mut collector);
            let mut expected = Within { square: radius * radius, found: Vec::new() };
            for id in (0..soup.len()).map(PrimitiveId::new) {
                expected.offer(id, soup.get(id).project(&q));
            }
            collector.found.sort();
            assert_eq!(collector.found, expected.found, "case {case}: {kinds:?} {layout:?} {q} {radius}");
            total += expected.found.len();
            searches += 1;
        }
    }
    assert!(cases.have_more_than(amount(10_000, 8 * searches), total), "{total} found, {searches} times");
}

#[test]
fn a_tree_that_is_refitted_answers_as_one_that_is_built() {
    let mut rng = rng("refit", 0);
    for layout in LAYOUTS {
        let soup = scenes::soup(&mut rng, Kinds::Mixed, layout, 500);
        let mut tree = AabbTree::new(soup.clone()).expect("valid");
        let size = (soup.aabb().max - soup.aabb().min).norm();
        for step in 0..4 {
            // The motion is a twist, a shift by the size of the scene, and noise.
            let mut moved = |p: &Point3<f64>| {
                let noise = Vector3::from_fn(|_, _| rng.random::<f64>() - 0.5) * size * 0.01 * f64::from(step);
                Point3::new(p.x + p.y * 0.1, p.y - p.z * 0.2, p.z + size) + noise
            };
            let moved =
                Soup::new(tree.set().positions().iter().map(&mut moved).collect(), soup.elements()).expect("valid");
            tree.refit(moved.clone(), &SplitOptions::default()).expect("as many");
            let brute = BruteForce::new(&moved).expect("valid");
            for _ in 0..50 {
                let q = query(&mut rng, &moved);
                same(tree.closest_point(&q), brute.closest_point(&q), &format!("{layout:?} step {step} {q}"));
            }
        }
        let fewer = scenes::soup(&mut rng, Kinds::Mixed, layout, 40);
        let len = soup.len();
        let before = tree.closest_point(&[0.0; 3]);
        let error = tree.refit(fewer.clone(), &SplitOptions::default());
        assert_eq!(error, Err(BuildError::OtherLength { len: fewer.len(), expected: len }));
        same(tree.closest_point(&[0.0; 3]), before, "as it was");
    }
}

/// Trees of few primitives have many nodes and leaves of every size.
#[test]
fn trees_of_every_shape_are_built() {
    let mut rng = rng("shapes of trees", 0);
    for base in [1.5f64, 2.0, 8.0, 16.0, 17.0, 100.0] {
        for n in [1, 2, 17, 33, 34, 40, 68, 69, 100] {
            let set: Vec<Point<f64>> = (0..n).map(|i| Point::new(Point3::new(base.powi(-i), 0.0, 0.0))).collect();
            let tree = AabbTree::new(&set).expect("valid");
            let brute = BruteForce::new(&set).expect("valid");
            for i in 0..n {
                let q = Point3::new(base.powi(-i) * 1.25, 0.1, 0.0);
                same(tree.closest_point(&q), brute.closest_point(&q), &format!("{n} points of base {base}"));
            }
        }
    }
    for max_leaf in [0, 1, 2, 3, 4, 8, 16, 17, 100, 1000, usize::MAX] {
        for (layout, len) in [(Layout::Strewn, 300), (Layout::Sheet, 70), (Layout::Strewn, 5)] {
            let soup = scenes::soup(&mut rng, Kinds::Mixed, layout, len);
            let mut options = SplitOptions::default();
            options.max_leaf = max_leaf;
            let tree = AabbTree::build(&soup, &options).expect("valid");
            let brute = BruteForce::new(&soup).expect("valid");
            for _ in 0..50 {
                let q = query(&mut rng, &soup);
                same(tree.closest_point(&q), brute.closest_point(&q), &format!("leaves of {max_leaf}, {layout:?}"));
            }
        }
    }
}

/// The primitives of a packet change to other kinds, and zeros have both signs.
#[test]
fn refitted_packets_may_mix_kinds_and_zeros_keep_their_signs() {
    let shape = |kind: usize, i: usize| -> Shape<f64> {
        // Every second primitive has the same position, with zeros of the other sign.
        let (x, zero) = ((i / 2) as f64, if i.is_multiple_of(2) { 0.0 } else { -0.0 });
        let at = |y: f64| Point3::new(x + f64::from(i as u32 % 2) * 1e-3 * y * y, y, zero);
        match kind {
            0 => Point::new(at(zero)).into(),
            1 => Segment::new(at(zero), at(1.0)).into(),
            _ => Triangle::new(at(zero), at(1.0), at(-1.0)).into(),
        }
    };
    let of = |kind: &dyn Fn(usize) -> usize| -> Vec<Shape<f64>> { (0..40).map(|i| shape(kind(i), i)).collect() };
    let mut tree = AabbTree::new(of(&|_| 2)).expect("valid");
    for step in 0..6usize {
        let moved = of(&|i| [i % 3, 1, (i / 5) % 2, 2, i * i % 3, 0][step]);
        tree.refit(moved.clone(), &SplitOptions::default()).expect("as many");
        let brute = BruteForce::new(&moved).expect("valid");
        for i in 0..400 {
            let q = Point3::new(f64::from(i) * 0.1, f64::from(i % 7) * 0.3 - 0.9, f64::from(i % 5) * 0.2 - 0.4);
            same(tree.closest_point(&q), brute.closest_point(&q), &format!("step {step} {q}"));
        }
    }
}

#[test]
fn batches_are_single_queries() {
    for case in cases(6, 6) {
        let (mut rng, layout) = (rng("batches", case), LAYOUTS[(case % 6) as usize]);
        let soup = scenes::soup(&mut rng, Kinds::Mixed, layout, amount(500, 200));
        let tree = AabbTree::new(&soup).expect("valid");
        // Threads take at least 512 queries each, so in shallow tests one case has enough queries for three threads.
        let count = amount(2000, if case == 0 { 1100 } else { 100 });
        let mut queries: Vec<_> = (0..count).map(|_| query(&mut rng, &soup)).collect();
        (queries[3].y, queries[70].x) = (f64::NAN, f64::INFINITY);
        let near = QueryOptions::default().with_max_distance((soup.aabb().max - soup.aabb().min).norm() * 0.1);
        for options in [QueryOptions::default(), near, near.with_hint(PrimitiveId::new(7)), near.with_epsilon(0.1)] {
            let expected: Vec<_> = queries.iter().map(|q| tree.closest_point_with(q, &options)).collect();
            for bits in 0..4 {
                let batch_options =
                    batch::BatchOptions::default().with_reorder(bits & 1 != 0).with_parallel(bits & 2 != 0);
                let mut out = vec![None; queries.len()];
                batch::closest_points_into(&tree, &queries, &options, &batch_options, &mut out);
                for (i, (found, expected)) in out.into_iter().zip(&expected).enumerate() {
                    same(found, *expected, &format!("{layout:?} {batch_options:?} query {i}"));
                }
            }
        }
    }
}

/// The last answer of sixteen queries limits the next sixteen, and shows at which node they begin.
#[test]
fn limits_from_neighbours_lose_no_answer() {
    // Eight triangles from 0 to 10 are a child of the root, and all others are far to the left.
    let near = (0..8).map(|k| [f64::from(k) * 10.0 / 7.0, 0.0]);
    let far = (0..500).map(|k| [-1002.0 - f64::from(k % 25) * 0.08, f64::from(k / 25) * 0.1]);
    let corners: Vec<_> =
        near.chain(far).flat_map(|[x, y]| [[x, y, 0.0], [x + 0.3, y - 0.5, 0.0], [x - 0.3, y - 0.5, 0.0]]).collect();
    let faces: Vec<[u32; 3]> = (0..508).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    let tree = AabbTree::new(Soup::<f64>::from_arrays(&corners, &faces).expect("valid")).expect("valid");
    let [left, middle, right] = [-1003.0, 0.0, 10.0].map(|x| Point3::new(x, 0.1, 0.0));
    // The limits of the second sixteen reach from the middle to the left, but not from the right to the left.
    let mut queries = [[middle; 16], [left; 16]].concat();
    queries[24..].fill(right);
    // From here on queries move away from a vertex, so that no limit is larger than the distance.
    queries.extend((0..64).map(|k| Point3::new(0.0, f64::from(k), 0.0)));
    let mut out = vec![None; queries.len()];
    let in_order = batch::BatchOptions::default().with_reorder(false).with_parallel(false);
    batch::closest_points_into(&tree, &queries, &QueryOptions::default(), &in_order, &mut out);
    for (i, (query, found)) in queries.iter().zip(out).enumerate() {
        same(found, tree.closest_point(query), &format!("query {i}"));
    }
}

#[test]
fn trees_do_not_depend_on_the_number_of_threads() {
    let mut rng = rng("threads", 0);
    let soup = scenes::soup(&mut rng, Kinds::Triangles, Layout::Strewn, 30_000);
    let boxes = |options| {
        let tree = AabbTree::build(&soup, &options).expect("valid");
        let tree = tree.tree();
        tree.parts().map(|p| (p.volume, p.depth, tree.primitives(&p).map(<[_]>::to_vec))).collect::<Vec<_>>()
    };
    let expected = boxes(SplitOptions::default().with_parallel(false));
    assert!(expected == boxes(SplitOptions::default().with_parallel(true)));
    assert!(expected.len() > 2000);
}

/// The counters detect lost pruning, lost filters and lost bounds. They are the same on every run, and nearly so on
/// every instruction set.
#[test]
fn searches_do_little() {
    let mut rng = rng("counters", 0);
    let soup = scenes::soup(&mut rng, Kinds::Triangles, Layout::Sheet, 20_000);
    let queries: Vec<Point3<f64>> = (0..1000)
        .map(|_| soup.positions()[rng.random_range(0..soup.positions().len())] + Vector3::new(0.01, 0.02, 0.3))
        .collect();
    let mut tree = AabbTree::new(&soup).expect("valid");
    for isa in Isa::available() {
        tree = tree.with_isa(isa);
        let mut sums = [0; 3];
        let mut hinted = 0;
        for q in &queries {
            let mut best = Best::<f64>::new(&QueryOptions::default());
            tree.visit(q, &mut best);
            let counts = best.counts();
            sums = [0, 1, 2].map(|i| sums[i] + counts[i]);
            // A hint that is the answer leaves less to visit.
            let found = best.finish().expect("not empty").primitive;
            let mut best = Best::<f64>::new(&QueryOptions::default());
            best.offer(found, soup.get(found).project(q));
            tree.visit(q, &mut best);
            let [nodes, packets, _] = best.counts();
            hinted += nodes + packets;
        }
        println!("{isa}: per 1000 queries {sums:?} nodes, packets, primitives; with a hint {hinted} nodes and packets");
        assert!(sums[0] <= NODES && sums[1] <= PACKETS && sums[2] <= PRIMITIVES, "{isa}: {sums:?}");
        assert!(hinted < sums[0] + sums[1], "{hinted}");
        let (packets, filled) = tree.tree().packets();
        assert!(filled * 10 >= packets * 16 * 7, "{filled} lanes of {packets} packets");
    }
}

const NODES: usize = 4_700;
const PACKETS: usize = 2_250;
const PRIMITIVES: usize = 1_100;
