//! Tests the octree: domains, budgets, threads, instruction sets, progress, other collectors, and the work of queries.
//! `tests/all/agreement.rs` compares its answers with brute force.
#![allow(clippy::float_cmp, reason = "bitwise equality is what is tested")]

use nalgebra::{Point3, Vector3};
use p2m_core::{Aabb, BruteForce, BuildIndex, ClosestPoint, Point, PrimitiveId, PrimitiveSet, Segment, Shape, Soup};
use p2m_core::{Collector, IndexStats};
use p2m_core::{Isa, Projection};
use p2m_interception::{Domain, OctreeReport, RefinementProgress};
use p2m_interception::{OctreeIndex, OctreeOptions};
use p2m_mixed::generate::{IcoSphere, ico_sphere};
use p2m_testkit::scenes::{self, KINDS, Kinds, LAYOUTS, Layout, kinds_and_layout};
use p2m_testkit::{amount, cases, rng};
use rand::{Rng, RngExt};
use std::ops::ControlFlow;
use std::sync::Mutex;

fn sheet(len: usize) -> Soup<f64> {
    scenes::soup(&mut rng("octree sheet", 0), Kinds::Triangles, Layout::Sheet, len)
}

fn built<'a>(soup: &'a Soup<f64>, options: &OctreeOptions) -> OctreeIndex<f64, &'a Soup<f64>> {
    OctreeIndex::build(soup, options).expect("valid")
}

/// Returns a query in, around or far from the box of a scene.
fn query(rng: &mut impl Rng, soup: &Soup<f64>) -> Point3<f64> {
    let bounds = soup.aabb();
    let size = bounds.max - bounds.min;
    let extent = [0.6, 0.6, 2.0, 12.0, 1e4][rng.random_range(0..5)];
    let offset = Vector3::from_fn(|_, _| rng.random_range(-extent..extent));
    match rng.random_range(0..3) {
        0 => soup.positions()[rng.random_range(0..soup.positions().len())] + offset * (size.max() * 1e-3),
        _ => nalgebra::center(&bounds.min, &bounds.max) + offset * size.max(),
    }
}

#[test]
fn domains_change_the_work_and_never_the_answer() {
    for case in cases(24, 24) {
        let (mut rng, (kinds, layout)) = (rng("octree domains", case), kinds_and_layout(case));
        let soup = scenes::soup(&mut rng, kinds, layout, amount(600, 80));
        let bounds = soup.aabb();
        let fifth = (bounds.max - bounds.min) * 0.2;
        let away = bounds.max + fifth;
        let domains = [
            Domain::Everywhere,
            Domain::Box(Aabb { min: bounds.min + fifth, max: bounds.max - fifth }),
            Domain::Box(Aabb { min: away, max: away + fifth }),
            Domain::Band(fifth.max() * 0.1),
            // An empty domain is useless but harmless.
            Domain::Box(Aabb::empty()),
            Domain::Box(Aabb { min: [f64::NAN; 3].into(), max: away }),
            Domain::Box(Aabb { min: [-f64::MAX; 3].into(), max: [f64::MAX; 3].into() }),
            Domain::Box(Aabb { min: away, max: away }),
            Domain::Band(-1.0),
            Domain::Band(f64::NAN),
            Domain::Band(f64::INFINITY),
        ];
        let brute = BruteForce::new(&soup).expect("valid");
        let queries: Vec<_> = (0..amount(60, 8)).map(|_| query(&mut rng, &soup)).collect();
        let key = |c: p2m_core::Closest<f64>| (c.distance.to_bits(), c.primitive);
        let expected: Vec<_> = queries.iter().map(|q| brute.closest_point(q).map(key)).collect();
        for domain in domains {
            let index = built(&soup, &OctreeOptions::default().with_domain(domain));
            for (q, expected) in queries.iter().zip(&expected) {
                let found = index.closest_point(q).map(key);
                assert_eq!(found, *expected, "case {case}: {kinds:?} {layout:?} {domain:?} {q}");
            }
        }
    }
}

#[test]
fn what_is_not_asked_for_is_not_made() {
    let soup = sheet(amount(20_000, 5_000));
    let bounds = soup.aabb();
    let bytes = |domain| built(&soup, &OctreeOptions::default().with_domain(domain)).report();
    let all = bytes(Domain::Everywhere);
    let band = bytes(Domain::Band((bounds.max - bounds.min).norm() * 0.02));
    let corner = Aabb { min: bounds.min, max: nalgebra::center(&bounds.min, &bounds.max) };
    let part = bytes(Domain::Box(corner));
    println!("everywhere: {all}\nband: {band}\na corner: {part}");
    assert!(band.bytes < all.bytes && part.bytes < all.bytes && band.work < all.work && part.work < all.work);
    // Outside of the domain the tree answers.
    let index = built(&soup, &OctreeOptions::default().with_domain(Domain::Box(corner)));
    assert_eq!(index.partition().list_length(&(bounds.max + Vector3::repeat(1.0))), None);
    let inside = nalgebra::center(&corner.min, &corner.max);
    assert!(index.partition().list_length(&inside).is_some());
}

#[test]
fn budgets_are_kept() {
    let soup = sheet(amount(20_000, 3_000));
    // The smallest budget is that of ten thousand primitives.
    let count = soup.len().max(10_000) as f64;
    let default_report = built(&soup, &OctreeOptions::default()).report();
    assert!(
        default_report.bytes as f64 <= OctreeOptions::default().memory * count
            && default_report.list_cells > soup.len() / 20,
        "{default_report}"
    );
    for memory in [amount(60.0, 20.0), 10.0, 0.001, 0.0, -1.0, f64::NAN] {
        let report = built(&soup, &OctreeOptions::default().with_memory(memory)).report();
        println!("{memory} bytes: {report}");
        assert!(report.bytes as f64 <= memory.max(0.0) * count, "{memory}: {report}");
        assert!(report.resolution < default_report.resolution);
    }
    // The most valuable cells are split until little of a budget is left.
    let memory = default_report.bytes as f64 / count * 0.5;
    let half = built(&soup, &OctreeOptions::default().with_memory(memory)).report();
    assert!(half.bytes as f64 > 0.7 * memory * count, "{half}");
    for work in [amount(20.0, 5.0), 2.0, 0.0] {
        let report = built(&soup, &OctreeOptions::default().with_work(work)).report();
        assert!(report.work as f64 <= work * count && report.bytes < default_report.bytes, "{work}: {report}");
    }
    let fine = built(&soup, &OctreeOptions::default().with_resolution(1.0).with_memory(1e4).with_work(1e5)).report();
    assert!(fine.bytes > default_report.bytes && fine.resolution == 1.0, "{fine}");
    // Thirty times the default resolution fits into thirty times the budgets, and has shorter lists.
    let finer = built(&soup, &OctreeOptions::default().with_finer_cells(30.0)).report();
    let mean_length = |report: &OctreeReport| report.entries as f64 / report.list_cells as f64;
    assert_eq!(finer.resolution, 30.0 * OctreeOptions::default().resolution);
    assert!(mean_length(&finer) < 0.8 * mean_length(&default_report), "{finer}, {default_report}");
}

/// Builds an octree whose refinement ends after `calls` visits, and returns it with the last visit and their number.
fn built_until<'a>(
    soup: &'a Soup<f64>,
    options: &OctreeOptions,
    calls: usize,
) -> (OctreeIndex<f64, &'a Soup<f64>>, RefinementProgress, usize) {
    let (mut last, mut count) = (RefinementProgress::default(), 0);
    let index = OctreeIndex::build_until(soup, options, &|_| (), &mut |so_far| {
        assert!(so_far.cells >= last.cells, "{so_far:?} after {last:?}");
        (last, count) = (*so_far, count + 1);
        if count >= calls { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    (index.expect("valid"), last, count)
}

#[test]
fn a_refinement_that_ends_early_gives_an_exact_index() {
    let (mut lists, mut announced) = (0, 0);
    for case in cases(60, 8) {
        let (mut rng, (kinds, layout)) = (rng("octree ends early", case), kinds_and_layout(case));
        let soup = scenes::soup(&mut rng, kinds, layout, amount(3_000, 600));
        let brute = BruteForce::new(&soup).expect("valid");
        let options = |parallel| {
            let memory = [190.0, 20.0][case as usize % 2];
            let splits = p2m_bvh::SplitOptions::default().with_parallel(parallel);
            OctreeOptions::default().with_memory(memory).with_splits(splits)
        };
        let (whole, last, all_calls) = built_until(&soup, &options(true), usize::MAX);
        assert_eq!(whole.report(), built(&soup, &options(true)).report());
        check_so_far(&whole.report(), &last);
        let key = |c: p2m_core::Closest<f64>| (c.distance.to_bits(), c.primitive);
        for calls in [1, 2, rng.random_range(1..=all_calls), rng.random_range(1..=all_calls), all_calls - 1] {
            let (index, last, count) = built_until(&soup, &options(true), calls);
            assert!(count <= calls.max(1), "nobody asks after the end");
            let report = index.report();
            check_so_far(&report, &last);
            (lists, announced) = (lists + report.list_cells, announced + last.list_cells);
            assert!(report.bytes <= whole.report().bytes && report.work <= whole.report().work);
            let (alone, ..) = built_until(&soup, &options(false), calls);
            assert_eq!(report, alone.report(), "case {case}, {calls} of {all_calls} calls");
            for _ in 0..amount(60, 20) {
                let q = query(&mut rng, &soup);
                let [found, same] = [&index, &alone].map(|index| index.closest_point(&q).map(key));
                assert_eq!(found, brute.closest_point(&q).map(key), "case {case}, {calls} calls, {q}");
                assert_eq!(found, same);
                let lengths = [&index, &alone].map(|index| index.partition().list_length(&q));
                assert_eq!(lengths[0], lengths[1], "case {case}, {calls} calls, {q}");
            }
        }
    }
    // Nearly all cells that are open at the end get their lists.
    println!("{lists} lists of {announced}");
    assert!(lists as f64 > 0.98 * announced as f64, "{lists} of {announced}");
}

/// Checks that what an octree was announced to be bounds what it is.
fn check_so_far(report: &OctreeReport, so_far: &RefinementProgress) {
    assert_eq!(so_far.cells, report.list_cells + report.single_cells + report.fallback_cells, "{so_far:?} {report:?}");
    assert!(report.list_cells <= so_far.list_cells && report.entries <= so_far.entries, "{so_far:?} {report:?}");
    assert!(report.bytes <= so_far.bytes, "{so_far:?} {report:?}");
}

/// Budgets end the refinement in the middle of a pass, while several threads are at work.
#[test]
fn cells_do_not_depend_on_the_number_of_threads() {
    check_threads(&sheet(amount(5_000, 2_000)), &[1.0, 0.5, 0.3, 0.2, 0.1, 0.05]);
}

/// All triangles are about equally near to the middle of a sphere, so searches there are charged to the budget of work.
#[test]
fn cells_of_a_sphere_do_not_depend_on_the_number_of_threads() {
    let sphere = ico_sphere(&IcoSphere { frequency: 25 }).expect("valid");
    check_threads(&sphere, &[0.2, 0.05]);
}

/// Checks that octrees over a scene are the same on several threads, with parts of the default budgets.
fn check_threads(soup: &Soup<f64>, parts: &[f64]) {
    let mut rng = rng("octree threads", 0);
    let points: Vec<_> = (0..amount(2000, 400)).map(|_| query(&mut rng, soup)).collect();
    let pools = [2, 3, 8].map(|threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads"));
    let mut ended_early = 0;
    for &part in parts {
        let default = OctreeOptions::default();
        for default in [default.with_memory(default.memory * part), default.with_work(default.work * part)] {
            let cells = |parallel| {
                let splits = p2m_bvh::SplitOptions::default().with_parallel(parallel);
                let index = built(soup, &default.with_splits(splits));
                let lists: Vec<_> = points.iter().map(|point| index.partition().list_length(point)).collect();
                (index.report(), lists)
            };
            let expected = cells(false);
            for pool in &pools {
                assert!(pool.install(|| cells(true)) == expected, "{} threads, {part}", pool.current_num_threads());
            }
            ended_early += usize::from(expected.0.resolution < default.resolution);
            assert!(part < 1.0 || expected.1.iter().flatten().count() > points.len() / 2);
        }
    }
    assert!(ended_early > 0);
}

#[test]
fn every_instruction_set_answers_the_same() {
    let mut rng = rng("octree instruction sets", 0);
    for kinds in KINDS {
        let soup = scenes::soup(&mut rng, kinds, LAYOUTS[0], amount(2_000, 200));
        let queries: Vec<_> = (0..amount(300, 60)).map(|_| query(&mut rng, &soup)).collect();
        let brute = BruteForce::new(&soup).expect("valid");
        let expected: Vec<_> =
            queries.iter().map(|q| brute.closest_point(q).map(|c| (c.distance, c.primitive))).collect();
        let mut index = built(&soup, &OctreeOptions::default());
        for isa in Isa::available() {
            index = index.with_isa(isa);
            let found: Vec<_> =
                queries.iter().map(|q| index.closest_point(q).map(|c| (c.distance, c.primitive))).collect();
            assert!(found == expected, "{isa} {kinds:?}");
        }
    }
}

#[test]
fn progress_goes_from_nothing_to_all() {
    let soup = sheet(amount(5_000, 2_000));
    for memory in [1e4, 20.0] {
        let parts = Mutex::new(Vec::new());
        let options = OctreeOptions::default().with_memory(memory);
        let index = OctreeIndex::build_with_progress(&soup, &options, &|progress| {
            parts.lock().expect("whole").push(progress.part);
        });
        assert_eq!(index.expect("valid").set().len(), soup.len());
        let mut parts = parts.into_inner().expect("whole");
        assert!(parts.iter().all(|part| (0.0..=1.0).contains(part)) && parts.last() == Some(&1.0));
        assert!(parts.len() > 20, "{parts:?}");
        parts.dedup();
        let len = parts.len();
        parts.sort_by(f64::total_cmp);
        parts.dedup();
        assert_eq!(parts.len(), len, "each once");
    }
}

/// A collector of all primitives within a distance.
struct Within(f64, Vec<PrimitiveId>);

impl Collector for Within {
    fn prune_above(&self) -> f64 {
        self.0 * self.0
    }
    fn offer(&mut self, id: PrimitiveId, projection: Projection) {
        if projection.key.distance() <= self.0 {
            self.1.push(id);
        }
    }
}

#[test]
fn other_collectors_get_all_that_they_want() {
    let soup = sheet(3_000);
    let index = built(&soup, &OctreeOptions::default());
    let size = (soup.aabb().max - soup.aabb().min).norm();
    let mut rng = rng("octree collectors", 0);
    let mut sum = 0;
    for _ in 0..50 {
        let q = query(&mut rng, &soup);
        let mut within = Within(size * 0.1, Vec::new());
        index.visit(&q, &mut within);
        within.1.sort();
        within.1.dedup();
        let ids = (0..soup.len()).map(PrimitiveId::new);
        let expected: Vec<_> =
            ids.filter(|id| p2m_core::Primitive::project(&soup.get(*id), &q).key.distance() <= size * 0.1).collect();
        assert!(within.1 == expected);
        sum += expected.len();
    }
    assert!(sum > 500, "{sum}");
}

/// The counters detect lost bounds, lost lists and coarser cells.
#[test]
fn lookups_do_little() {
    let soup = sheet(amount(20_000, 4_000));
    let index = built(&soup, &OctreeOptions::default());
    let mut rng = rng("octree counters", 0);
    let bounds = soup.aabb();
    let size = bounds.max - bounds.min;
    for (name, extent, limits) in
        [("around", 0.52, [10, 3_400, 1_350]), ("far", 4.9, amount([250, 2_100, 1_100], [100, 2_400, 1_050]))]
    {
        let centre = nalgebra::center(&bounds.min, &bounds.max);
        let mut point = || centre + Vector3::from_fn(|k, _| rng.random_range(-extent..extent) * size[k]);
        let queries: Vec<_> = (0..1000).map(|_| point()).collect();
        let sums = index.count_queries(&queries);
        println!("{name}: per 1000 queries {sums:?} nodes, packets, primitives");
        assert!((0..3).all(|i| sums[i] <= limits[i]), "{name}: {sums:?}");
    }
}

/// Rounding may put a query into the cell beside its own, where a tie of the whole cell may be the nearest primitive.
#[test]
fn queries_beside_a_face_that_rounding_moves_across_it_lose_nothing() {
    let mut found = 0;
    for shift in [36.0f64, 36.5, 37.0] {
        let mut rng = rng("face", 0);
        // The query is so near to a face of cells, the plane x = 0, that its offset from the end of the domain rounds
        // to that of the plane.
        let a = 2f64.powf(-shift);
        let along = Vector3::new(-(2f64.powi(-5)), 0.0, 0.0);
        let vertices: Vec<_> =
            (0..8).map(|_| Point3::new(-a, rng.random_range(-0.5..0.5), rng.random_range(-0.5..0.5))).collect();
        let mut shapes: Vec<Shape<f64>> = vertices.iter().map(|v| Point::new(*v).into()).collect();
        shapes.extend(vertices.iter().map(|v| Shape::from(Segment::new(*v, v + along))));
        shapes.extend([-0.6, 0.6].map(|x| Shape::from(Point::new(Point3::new(x, 0.0, 0.0)))));
        let extent = 1.9 * 2f64.powf(18.2);
        let domain = Domain::Box(Aabb { min: [-extent; 3].into(), max: [extent; 3].into() });
        let options = OctreeOptions::default().with_domain(domain).with_resolution(2e3).with_memory(2e4).with_work(2e4);
        let index = OctreeIndex::<f64, _>::build(&shapes[..], &options).expect("valid");
        println!("{}", index.report());
        let brute = BruteForce::new(&shapes[..]).expect("valid");
        for v in &vertices {
            for part in [0.3, 0.5, 0.9] {
                let q = v - Vector3::x() * (a * part);
                let key = |c: p2m_core::Closest<f64>| (c.distance.to_bits(), c.primitive);
                assert_eq!(index.closest_point(&q).map(key), brute.closest_point(&q).map(key), "{shift} {q}");
                found += usize::from(index.partition().list_length(&q).is_some());
            }
        }
    }
    assert!(found > 30, "{found}");
}

#[test]
fn budgets_without_end_are_those_that_suffice() {
    let soup = scenes::soup(&mut rng("budgets without end", 0), Kinds::Mixed, Layout::Uniform, 300);
    let enough = built(&soup, &OctreeOptions::default().with_memory(1e4).with_work(1e4)).report();
    let default_report = built(&soup, &OctreeOptions::default()).report();
    assert!(enough.bytes >= default_report.bytes && enough.list_cells > 0, "{enough}\n{default_report}");
    for budget in [1e15, f64::MAX, f64::INFINITY] {
        let report = built(&soup, &OctreeOptions::default().with_memory(budget).with_work(budget)).report();
        assert_eq!(report.bytes, enough.bytes, "{budget:e}: {report}");
    }
}

#[test]
fn any_resolution_ends() {
    let soup = sheet(amount(1_200, 100));
    let all = vec![0.0, -1.0, f64::NAN, f64::INFINITY, 1e300, 1e9, 10.0, 1e-9];
    for resolution in amount(all, vec![f64::NAN, 10.0, 1e-9]) {
        for memory in [0.0, 2.0, 190.0].into_iter().skip(amount(0, 2)) {
            let options = OctreeOptions::default();
            let options = options.with_memory(memory);
            let report = built(&soup, &options.with_resolution(resolution)).report();
            let default_report = built(&soup, &options).report();
            // A larger budget does not lead to fewer cells.
            assert!(
                resolution.is_nan() || resolution <= 1.0 || report.bytes >= default_report.bytes,
                "{resolution} {memory}: {report}\n{default_report}"
            );
        }
    }
}
