//! Runs every backend over the adversarial scenes of p2m-testkit. Answers have to equal those of brute force, and
//! counters have to stay below the bounds of docs/measurements/adversaries.md, which also has times and memory.
#![cfg(all(feature = "bvh", feature = "interception", feature = "kdop"))]

use nalgebra::Point3;
use p2m::bvh::{PacketTree, Volume};
use p2m::core::{IndexStats, QueryCost};
use p2m::interception::Partition;
use p2m::interception::delaunay::{Delaunay, DelaunayError};
use p2m::{
    AabbTree, BruteForce, BuildError, BuildIndex, ClosestPoint, KdopOptions, KdopTree, OctreeIndex, OctreeOptions,
    P2mIndex, P2mOptions, Point, PrimitiveId, PrimitiveSet, Soup, SplitOptions,
};
use p2m_testkit::adversaries::{ADVERSARIES, Adversary, queries};
use p2m_testkit::ball::Ball;
use p2m_testkit::{amount, is_deep};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// Returns the number of primitives of a scene.
fn count() -> usize {
    amount(2_000, 200)
}

/// Returns the number of queries for each scene.
fn query_count() -> usize {
    amount(40, 6)
}

/// The largest number of nodes on a path to a packet, for any scene.
const MAX_DEPTH: usize = 66;
/// The largest number of bytes per primitive of a tree.
const MAX_TREE_BYTES_PER_PRIMITIVE: usize = 160;
/// The largest number of bytes per site, with its neighbours and its entries in the grids, but without lists.
const MAX_BYTES_PER_SITE: usize = 512;

fn answers(index: &impl ClosestPoint<f64>, queries: &[Point3<f64>]) -> Vec<Option<(u64, PrimitiveId)>> {
    queries.iter().map(|q| index.closest_point(q).map(|c| (c.distance.to_bits(), c.primitive))).collect()
}

/// Compares an index with brute force, and compares the work of its queries with the size of the tree.
fn check_work<I: ClosestPoint<f64> + IndexStats<f64>, V: Volume>(
    name: &str,
    index: &I,
    tree: &PacketTree<V>,
    soup: &Soup<f64>,
) {
    let queries = queries(soup, query_count());
    let brute = BruteForce::new(soup).expect("valid");
    for ((q, found), expected) in queries.iter().zip(answers(index, &queries)).zip(answers(&brute, &queries)) {
        assert_eq!(found, expected, "{name} {q:?}");
    }
    let visits = QueryCost::measure(index, &queries);
    // No node or packet is visited twice. Only primitives may be evaluated twice: those that seem near are evaluated
    // early.
    assert!(visits.packets.max <= tree.packets().0, "{name}: {visits:?}");
    assert!(visits.primitives.max <= soup.len() + 1, "{name}: {visits:?}");
    assert!(tree.depth() <= MAX_DEPTH, "{name}: {}", tree.depth());
    // The nodes of small trees are almost empty, so a minimum number of primitives is assumed.
    assert!(
        tree.memory() <= MAX_TREE_BYTES_PER_PRIMITIVE * soup.len().max(amount(64, 320)),
        "{name}: {} bytes of tree",
        tree.memory()
    );
}

fn splits() -> SplitOptions {
    SplitOptions::default()
}

#[test]
fn every_backend_answers_within_its_bounds() {
    std::thread::scope(|scope| {
        for part in 0..2 {
            scope.spawn(move || ADVERSARIES.iter().skip(part).step_by(2).for_each(every_backend));
        }
    });
}

fn every_backend(adversary: &Adversary) {
    let name = adversary.name;
    let soup = &adversary.soup(count());
    let aabb = AabbTree::build(soup, &splits()).expect("valid");
    check_work(&format!("{name}, aabb"), &aabb, aabb.tree(), soup);
    let kdop = KdopTree::<f64, _, 14>::build(soup, &KdopOptions::default().with_splits(splits())).expect("valid");
    check_work(&format!("{name}, kdop"), &kdop, kdop.tree(), soup);

    let options = OctreeOptions::default();
    let options = options.with_work(options.work * amount(1.0, 0.04));
    let octree = OctreeIndex::build(soup, &options).expect("valid");
    check_work(&format!("{name}, octree"), &octree, octree.partition().tree(), soup);
    let report = octree.report();
    let (bytes, work) = (options.memory * 10_000.0, options.work * 10_000.0);
    assert!(report.bytes as f64 <= bytes && report.work as f64 <= work, "{name}: {report}");
    assert!(report.depth <= 30 && report.entries <= 256 * report.list_cells, "{name}: {report}");
    assert!(octree.list_lengths().into_iter().all(|len| len <= 256 * 16), "{name}");

    let options = P2mOptions::default();
    let p2m = P2mIndex::build(soup, &options).expect("valid");
    check_work(&format!("{name}, p2m"), &p2m, p2m.partition().tree(), soup);
    let report = p2m.report();
    let sites = report.list_cells + report.fallback_cells + report.auxiliary;
    // A vertex that occurs in several packets counts several times.
    let vertices: usize = (0..soup.len()).map(|i| p2m::Primitive::vertices(&soup.get(PrimitiveId::new(i))).len()).sum();
    assert!(sites <= 6 + 3 * vertices / 2 + soup.len(), "{name}: {report}");
    assert!(
        report.bytes as f64 <= options.memory * count() as f64 + (MAX_BYTES_PER_SITE * sites) as f64,
        "{name}: {report}"
    );
    assert!(report.entries <= options.max_list_packets * report.list_cells, "{name}: {report}");
    assert!(p2m.list_lengths().into_iter().all(|len| len <= options.max_list_packets * 16), "{name}");
    // A scene with fewer primitives stays within the budget.
    if is_deep() && ["skew points", "skew wires", "helices", "moment curve"].contains(&name) {
        assert!(report.list_cells == 0 && report.bytes == 0, "{name}: {report}");
    }
}

/// Points on two skew lines need quadratically many tetrahedra: every pair of neighbours on one line makes a
/// tetrahedron with every pair on the other.
#[test]
fn quadratic_tetrahedra_are_given_up() {
    let points = |n: usize| -> Vec<[f64; 3]> {
        let soup = Adversary::named("skew points").soup(n);
        soup.positions().iter().map(|p| [p.x, p.y, p.z]).collect()
    };
    let few = points(400);
    let all = Delaunay::new(&few, 300.0).expect("finite");
    let count = all.tetrahedra().len();
    assert!(count > 199 * 199, "{count}");
    let too_many = |points: &[[f64; 3]], most: usize| match Delaunay::within(points, 300.0, most) {
        Err(DelaunayError::TooMany { len }) => assert_eq!(len, points.len()),
        other => panic!("{most}: {other:?}"),
    };
    too_many(&few, count - 1);
    too_many(&few, 0);
    // The build stops after a small part of some millions of tetrahedra.
    too_many(&points(4_000), 16 * 4_000);
    let within = Delaunay::within(&few, 300.0, 2 * count).expect("few enough");
    assert_eq!((within.tetrahedra(), within.work()), (all.tetrahedra(), all.work()));
}

#[test]
fn cells_of_vertices_that_take_too_much_are_left_to_the_tree() {
    let soup = &Adversary::named("grid").soup(count());
    let built = |options: &P2mOptions| P2mIndex::build(soup, options).expect("valid");
    let unlimited = built(&P2mOptions::default());
    assert_eq!((unlimited.report().list_cells, unlimited.report().fallback_cells), (count(), 0));
    let queries = queries(soup, query_count());
    for (memory, work) in
        [(100.0, 1e5), (1.0, 1e5), (1e5, 20.0), (0.0, 1e5), (1e5, -1.0), (f64::NAN, 1e5), (1e5, f64::NAN)]
    {
        for parallel in [false, true] {
            let part = amount(1.0, 0.1);
            let options = P2mOptions::default().with_memory(memory * part).with_work(work * part);
            let index = built(&options.with_splits(splits().with_parallel(parallel)));
            let report = index.report();
            assert!(
                report.list_cells == 0 && report.bytes == 0 && report.fallback_cells >= count(),
                "{memory} {work}: {report}"
            );
            assert_eq!(answers(&index, &queries), answers(&unlimited, &queries));
        }
    }
    let ample = built(&P2mOptions::default().with_memory(f64::INFINITY).with_work(f64::INFINITY));
    assert_eq!(ample.report(), unlimited.report());
}

/// Budgets that are never exceeded change no answer, with added sites and with lists of any length.
#[test]
fn indexes_with_unlimited_budgets_answer_as_brute_force() {
    for name in ["grid", "sphere", "spheres", "sheets", "plane", "needles", "one over all", "two clouds"] {
        let soup = &Adversary::named(name).soup(amount(1_000, 200));
        let queries = queries(soup, query_count());
        let expected = answers(&BruteForce::new(soup).expect("valid"), &queries);
        let unlimited = f64::INFINITY;
        let options = OctreeOptions::default().with_memory(unlimited).with_work(unlimited);
        let octree = OctreeIndex::build(soup, &options).expect("valid");
        assert_eq!(answers(&octree, &queries), expected, "{name}: {}", octree.report());
        let options = P2mOptions::default().with_memory(unlimited).with_work(unlimited);
        let long_lists = options.with_max_list_packets(2048).with_max_extra_sites(0.0);
        for options in [options, long_lists] {
            let p2m = P2mIndex::build(soup, &options).expect("valid");
            assert_eq!(answers(&p2m, &queries), expected, "{name}: {}", p2m.report());
            assert!(name != "grid" || p2m.report().list_cells == soup.len(), "{}", p2m.report());
        }
    }
}

/// A set that counts how often its primitives are accessed.
struct Counted<'a> {
    balls: &'a [Ball],
    query_count: AtomicUsize,
}

impl PrimitiveSet<f64> for Counted<'_> {
    type Primitive<'a>
        = Ball
    where
        Self: 'a;

    fn len(&self) -> usize {
        self.balls.len()
    }
    fn get(&self, id: PrimitiveId) -> Ball {
        self.query_count.fetch_add(1, Relaxed);
        self.balls[id.index()]
    }
}

/// If all primitives are equally near, a search for one corner of a cell visits the whole scene, which counts as work.
#[test]
#[ignore = "deep: the least budget of an octree is millions of searches for corners"]
fn corners_of_cubes_that_take_the_whole_scene_are_few() {
    let balls = vec![Ball { centre: Point3::new(0.1, 0.2, 0.3), radius: 0.5 }; 8_000];
    let set = Counted { balls: &balls, query_count: AtomicUsize::new(0) };
    let options = OctreeOptions::default();
    let index = OctreeIndex::build(&set, &options).expect("valid");
    let query_count = set.query_count.load(Relaxed);
    println!("{query_count} times; {}", index.report());
    // The limit is the budget, as often as it may be spent, plus the tree and its last searches.
    assert!((query_count as f64) < 7.0 * options.work * 10_000.0, "{query_count}");
}

/// A set with more primitives than there are ids. None of them is ever accessed.
struct TooManyPrimitives(usize);

impl PrimitiveSet<f64> for TooManyPrimitives {
    type Primitive<'a>
        = Point<f64>
    where
        Self: 'a;

    fn len(&self) -> usize {
        self.0
    }
    fn get(&self, id: PrimitiveId) -> Point<f64> {
        panic!("primitive {id} of {} was asked for", self.0)
    }
}

#[test]
fn more_primitives_than_ids_are_an_error_before_anything_else() {
    fn error<'a, I: BuildIndex<f64, &'a TooManyPrimitives, Error = BuildError>>(
        set: &'a TooManyPrimitives,
    ) -> Option<BuildError> {
        I::build(set, &Default::default()).err()
    }
    for len in [(1 << 30) + 1, u32::MAX as usize, 1 << 40, usize::MAX] {
        let set = &TooManyPrimitives(len);
        let errors = [
            error::<BruteForce<_>>(set),
            error::<AabbTree<f64, _>>(set),
            error::<KdopTree<f64, _, 6>>(set),
            error::<KdopTree<f64, _, 14>>(set),
            error::<OctreeIndex<f64, _>>(set),
            error::<P2mIndex<f64, _>>(set),
        ];
        assert_eq!(errors, [Some(BuildError::TooMany { len }); 6]);
    }
}
