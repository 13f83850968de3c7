//! Compares indexes with brute force, bit for bit, on real meshes: far from the origin, non-manifold, degenerate,
//! lines, mixed. If there is no folder of models, the tests are skipped with a message.

#![cfg(all(feature = "bvh", feature = "interception", feature = "kdop", feature = "scene"))]

use nalgebra::Point3;
use p2m::kdop::DirectionChoice;
use p2m::{AabbTree, BruteForce, ClosestPoint, KdopOptions, KdopTree, OctreeIndex, P2mIndex, PrimitiveSet, Real, Soup};
use p2m_testkit::queries::QuerySet;
use p2m_testkit::scenes::narrow;
use p2m_testkit::{amount, depth, model_files};

/// Returns the number of queries in a set. Every index answers all of them.
fn queries() -> usize {
    amount(200, 12)
}

/// The largest number of primitives of a model for which brute force answers all queries. For larger models it answers
/// every eighth query, because it would otherwise take most of the time of all tests.
const MAX_PRIMITIVES_FOR_ALL_QUERIES: usize = 20_000;
/// Returns the largest number of primitives of a model on which all indexes are tested. Larger models are tested only
/// with the trees in f64, because the other indexes would take half of the remaining time.
fn max_primitives_for_all_indexes() -> usize {
    amount(300_000, 5_000)
}

/// Returns whether nothing is left out: `P2M_DEEP=2 cargo test --profile deep --test all models:: --
/// --include-ignored`.
fn is_in_full() -> bool {
    depth() > 1
}

/// Returns the distance bits and the primitive of each answer, computed by two threads.
fn answers<T: Real, I: ClosestPoint<T> + Sync>(index: &I, queries: &[Point3<T>]) -> Vec<(u64, usize)> {
    let one = |q: &Point3<T>| {
        index.closest_point(q).map(|c| (c.distance.to_f64().to_bits(), c.primitive.index())).expect("an answer")
    };
    std::thread::scope(|scope| {
        let (left, right) = queries.split_at(queries.len() / 2);
        let left = scope.spawn(move || left.iter().map(one).collect::<Vec<_>>());
        let mut right: Vec<_> = right.iter().map(one).collect();
        let mut all = left.join().expect("no panic");
        all.append(&mut right);
        all
    })
}

/// Compares trees of boxes, trees of k-DOPs with default directions and with the scene's own, the octree and the P2M
/// index with each other and with brute force. Returns how many answers brute force confirmed.
fn agrees<T: Real>(name: &str, set: QuerySet, soup: &Soup<T>, trees: &Trees<'_, T>, queries: &[Point3<T>]) -> usize {
    let boxes = answers(&trees.0, queries);
    let every = if soup.len() > MAX_PRIMITIVES_FOR_ALL_QUERIES && !is_in_full() { 8 } else { 1 };
    let brute_queries: Vec<_> = queries.iter().step_by(every).copied().collect();
    let brute = answers(&BruteForce::new(soup).expect("valid"), &brute_queries);
    let box_answers: Vec<_> = boxes.iter().step_by(every).copied().collect();
    let mut pairs = vec![
        ("brute force", &brute_queries[..], box_answers, brute),
        ("k-DOPs", queries, answers(&trees.1, queries), boxes.clone()),
        ("the scene's k-DOPs", queries, answers(&trees.2, queries), boxes.clone()),
    ];
    pairs.extend(trees.3.iter().map(|index| ("octree", queries, answers(index, queries), boxes.clone())));
    pairs.extend(trees.4.iter().map(|index| ("p2m", queries, answers(index, queries), boxes.clone())));
    for (index, queries, found, expected) in pairs {
        for ((query, found), expected) in queries.iter().zip(found).zip(expected) {
            assert_eq!(found, expected, "{name}, {index} and boxes, {set}: {query:?}");
        }
    }
    brute_queries.len()
}

/// The indexes of a model: boxes, k-DOPs of 14 default faces and of 26 faces along a frame, an octree, and a P2M index.
struct Trees<'a, T: Real>(
    AabbTree<T, &'a Soup<T>>,
    KdopTree<T, &'a Soup<T>, 14>,
    KdopTree<T, &'a Soup<T>, 26>,
    Option<OctreeIndex<T, &'a Soup<T>>>,
    Option<P2mIndex<T, &'a Soup<T>>>,
);

impl<'a, T: Real> Trees<'a, T> {
    fn build(soup: &'a Soup<T>, choice: &DirectionChoice) -> Self {
        let is_small = soup.len() <= max_primitives_for_all_indexes() || is_in_full();
        let frame_options = KdopOptions::new(choice.frame_directions::<26>().expect("thirteen"));
        Self(
            AabbTree::new(soup).expect("valid"),
            KdopTree::new(soup).expect("valid"),
            KdopTree::build_with(soup, &frame_options).expect("valid"),
            is_small.then(|| OctreeIndex::new(soup).expect("valid")),
            // The cells are built in f64 for both scalars, which takes a while, so the P2M index is only tested in f64.
            (size_of::<T>() == 8 && is_small).then(|| P2mIndex::new(soup).expect("valid")),
        )
    }
}

#[test]
fn trees_agree_with_brute_force_on_every_model_in_f64() {
    let (mut count, mut confirmed) = (0, 0);
    for path in model_files() {
        let name = path.file_name().expect("a file").to_string_lossy().into_owned();
        let soup = p2m::scene::read_scene(&path).expect("readable").soup;
        if soup.len() > amount(usize::MAX, 10_000) {
            println!("{name}: left out");
            continue;
        }
        let trees = Trees::build(&soup, &DirectionChoice::from_scene(&soup).expect("valid"));
        for set in QuerySet::ALL {
            let queries = set.generate(&soup, queries(), 1);
            confirmed += agrees(&name, set, &soup, &trees, &queries);
            count += queries.len();
        }
        println!("{name}: {} primitives agree", soup.len());
    }
    println!("{count} queries, {confirmed} of them by brute force");
}

#[test]
fn trees_agree_with_brute_force_on_every_model_in_f32() {
    for path in model_files() {
        let name = path.file_name().expect("a file").to_string_lossy().into_owned();
        let double = p2m::scene::read_scene(&path).expect("readable").soup;
        if double.len() > max_primitives_for_all_indexes() && !is_in_full() {
            println!("{name}: left out");
            continue;
        }
        let soup = narrow(&double).expect("models fit f32");
        let trees = Trees::build(&soup, &DirectionChoice::from_scene(&double).expect("valid"));
        for set in QuerySet::ALL {
            // A quarter of the queries suffices, because the scalar changes the boxes but not the kernel.
            let queries: Vec<_> =
                set.generate(&double, queries() / 4, 2).iter().map(|q| q.map(f32::round_from_f64)).collect();
            agrees(&name, set, &soup, &trees, &queries);
        }
    }
}
