//! Agreement with brute force, bit for bit, on real meshes: far from the origin, non-manifold, degenerate, lines,
//! mixed. Skips, and says so, where there is no folder of models.

#![cfg(all(feature = "bvh", feature = "interception", feature = "kdop", feature = "mixed"))]

use p2m::kdop::Choice;
use p2m::{
    AabbTree, BruteForce, BuildIndex, ClosestPoint, KdopOptions, KdopTree, OctreeIndex, P2mIndex, PrimitiveSet, Real,
    Soup,
};
use p2m_testkit::model_files;
use p2m_testkit::queries::QuerySet;
use p2m_testkit::scenes::narrow;

const QUERIES: usize = 200;

/// Distance bits and primitive of each answer, computed by two threads.
fn answers<T: Real, I: ClosestPoint<T> + Sync>(index: &I, queries: &[nalgebra::Point3<T>]) -> Vec<(u64, usize)> {
    let one =
        |q| index.closest_point(q).map(|c| (c.distance.to_f64().to_bits(), c.primitive.index())).expect("an answer");
    std::thread::scope(|scope| {
        let (left, right) = queries.split_at(queries.len() / 2);
        let left = scope.spawn(move || left.iter().map(one).collect::<Vec<_>>());
        let mut right: Vec<_> = right.iter().map(one).collect();
        let mut all = left.join().expect("no panic");
        all.append(&mut right);
        all
    })
}

/// Compares trees of boxes, of k-DOPs and of the scene's own directions, and the octree, with brute force.
fn agrees<T: Real>(name: &str, set: QuerySet, soup: &Soup<T>, trees: &Trees<'_, T>, queries: &[nalgebra::Point3<T>]) {
    let brute = BruteForce::new(soup).expect("valid");
    let expected = answers(&brute, queries);
    let mut found = vec![
        answers(&trees.0, queries),
        answers(&trees.1, queries),
        answers(&trees.2, queries),
        answers(&trees.3, queries),
    ];
    found.extend(trees.4.iter().map(|index| answers(index, queries)));
    for (tree, found) in ["boxes", "k-DOPs", "the scene's k-DOPs", "octree", "p2m"].iter().zip(found) {
        for (i, (e, f)) in expected.iter().zip(&found).enumerate() {
            assert_eq!(e, f, "{name}, {tree}, {set}, query {i}: {:?}", queries[i]);
        }
    }
}

/// Of boxes, of the usual 14 faces, and of 26 faces along a frame; an octree, and a P2M index.
struct Trees<'a, T: Real>(
    AabbTree<T, &'a Soup<T>>,
    KdopTree<T, &'a Soup<T>, 14>,
    KdopTree<T, &'a Soup<T>, 26>,
    OctreeIndex<T, &'a Soup<T>>,
    Option<P2mIndex<T, &'a Soup<T>>>,
);

impl<'a, T: Real> Trees<'a, T> {
    fn build(soup: &'a Soup<T>, choice: &Choice) -> Self {
        let own = KdopOptions::new(choice.frame_directions::<26>().expect("thirteen"));
        Self(
            AabbTree::build(soup, &Default::default()).expect("valid"),
            KdopTree::build(soup, &Default::default()).expect("valid"),
            KdopTree::build_with(soup, &own).expect("valid"),
            OctreeIndex::build(soup, &Default::default()).expect("valid"),
            // Its cells are made from f64 for both scalars, and take a while.
            (size_of::<T>() == 8).then(|| P2mIndex::build(soup, &Default::default()).expect("valid")),
        )
    }
}

#[test]
fn trees_agree_with_brute_force_on_every_model_in_f64() {
    let mut count = 0;
    for path in model_files() {
        let name = path.file_name().expect("a file").to_string_lossy().into_owned();
        let soup = p2m::scene::read_scene(&path).expect("readable").soup;
        let trees = Trees::build(&soup, &Choice::from_scene(&soup).expect("valid"));
        for set in QuerySet::ALL {
            let queries = set.generate(&soup, QUERIES, 1);
            agrees(&name, set, &soup, &trees, &queries);
            count += queries.len();
        }
        println!("{name}: {} primitives agree", soup.len());
    }
    println!("{count} queries");
}

#[test]
fn trees_agree_with_brute_force_on_every_model_in_f32() {
    for path in model_files() {
        let name = path.file_name().expect("a file").to_string_lossy().into_owned();
        let wide = p2m::scene::read_scene(&path).expect("readable").soup;
        let soup = narrow(&wide).expect("models fit f32");
        let trees = Trees::build(&soup, &Choice::from_scene(&wide).expect("valid"));
        for set in QuerySet::ALL {
            // A quarter of the queries: the scalar changes the boxes, not the kernel.
            let queries: Vec<_> = set.generate(&wide, QUERIES / 4, 2).iter().map(|q| q.map(f32::of_f64)).collect();
            agrees(&name, set, &soup, &trees, &queries);
        }
    }
}
