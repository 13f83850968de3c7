//! Every backend returns the same bits on every instruction set, for any number of threads, and in every run.
//!
//! All answers have a single hash, which is a constant in this file. Each backend, instruction set and number of
//! threads has to result in it. In the deep suite it covers more than a million answers of each scalar. Scenes are
//! generated only by additions, multiplications and comparisons, so the hash does not depend on a mathematical library
//! either.
#![cfg(all(feature = "bvh", feature = "interception", feature = "kdop", feature = "rayon"))]

use nalgebra::Point3;
use p2m::batch::{BatchOptions, closest_points_into};
use p2m::core::Isa;
use p2m::{
    AabbTree, BuildIndex, Closest, ClosestPoint, Feature, KdopTree, OctreeIndex, P2mIndex, PrimitiveSet, QueryOptions,
    Real, Soup,
};
use p2m_testkit::amount;
use p2m_testkit::scenes::{self, Kinds, Layout};
use rand::RngExt;
use std::fmt::Debug;

/// Returns the hash of all answers in f64 and in f32.
fn expected() -> [u64; 2] {
    amount([0x1ac3_5da1_fcdd_df14, 0xf722_b457_7191_f48f], [0x9f7d_d08f_cc6f_b08e, 0xf52e_95e7_6ce9_3d5a])
}

/// Kinds and layouts, with the numbers of primitives and of queries in the deep and in the shallow suite. In both, the
/// last scene is large enough for threads to share its primitives, sites and queries.
const SCENES: [(Kinds, Layout, [usize; 2], [usize; 2]); 5] = [
    (Kinds::Mixed, Layout::Uniform, [300, 10_000], [50, 100]),
    (Kinds::Mixed, Layout::Strewn, [5000, 10_000], [120, 100]),
    (Kinds::Mixed, Layout::Lattice, [400, 10_000], [60, 100]),
    (Kinds::Segments, Layout::Far, [2000, 10_000], [90, 100]),
    (Kinds::Triangles, Layout::Strewn, [20_000, 10_000], [4200, 1100]),
];

fn scene(number: usize) -> (Soup<f64>, Vec<Point3<f64>>) {
    let (kinds, layout, full, shallow) = SCENES[number];
    let [len, query_count] = amount(full, shallow);
    let mut rng = p2m_testkit::rng("determinism", number as u64);
    let soup = scenes::soup(&mut rng, kinds, layout, len);
    let bounds = soup.aabb();
    let (centre, size) = (bounds.min + (bounds.max - bounds.min) * 0.5, (bounds.max - bounds.min) * 0.6);
    let mut query = |i: usize| match i % 4 {
        // Some queries are on the scene, or at positions where ties occur.
        0 => soup.positions()[rng.random_range(0..soup.positions().len())],
        _ => centre + size.map(|x| x * rng.random_range(-1.0..1.0)),
    };
    let queries = (0..query_count).map(&mut query).collect();
    (soup, queries)
}

/// Returns the FNV-1a hash of the bits of all answers, in order. The certified bound is left out: it is lowered by the
/// error of each evaluated candidate, and the candidates depend on where a search begins.
fn hash<T: Real>(mut hash: u64, answers: &[Option<Closest<T>>]) -> u64 {
    let mut add = |x: u64| hash = (hash ^ x).wrapping_mul(0x0100_0000_01b3);
    for answer in answers {
        let Closest { point, distance, primitive, feature, barycentric, .. } = answer.expect("an answer");
        point.iter().chain([&distance]).chain(&barycentric).for_each(|x| add(x.to_f64().to_bits()));
        add(primitive.index() as u64);
        add(match feature {
            Feature::Vertex(i) => u64::from(i),
            Feature::Edge(i) => 10 + u64::from(i),
            Feature::Face => 20,
        });
    }
    hash
}

/// The queries that each index answers.
trait Answers<T: Real>: Send + Sync {
    /// Answers on one thread with the given instruction set.
    fn single_threaded(&self, isa: Isa, queries: &[Point3<T>]) -> Vec<Option<Closest<T>>>;
    /// Answers in batches on the current thread pool.
    fn in_batches(&self, queries: &[Point3<T>]) -> Vec<Option<Closest<T>>>;
}

macro_rules! answers {
    ($($index:ty),+) => {
        $(impl<T: Real> Answers<T> for $index {
            fn single_threaded(&self, isa: Isa, queries: &[Point3<T>]) -> Vec<Option<Closest<T>>> {
                let index = self.clone().with_isa(isa);
                queries.iter().map(|query| index.closest_point(query)).collect()
            }

            fn in_batches(&self, queries: &[Point3<T>]) -> Vec<Option<Closest<T>>> {
                let mut answers = vec![None; queries.len()];
                closest_points_into(self, queries, &QueryOptions::default(), &BatchOptions::default(), &mut answers);
                answers
            }
        })+
    };
}
answers!(AabbTree<T, &Soup<T>>, KdopTree<T, &Soup<T>, 14>, OctreeIndex<T, &Soup<T>>, P2mIndex<T, &Soup<T>>);

fn built<'a, T, I>(soup: &'a Soup<T>) -> Box<dyn Answers<T> + 'a>
where
    T: Real,
    I: BuildIndex<T, &'a Soup<T>, Options: Default, Error: Debug> + Answers<T> + 'a,
{
    Box::new(I::build(soup, &Default::default()).expect("valid"))
}

fn check<T: Real>(of: impl Fn(usize) -> (Soup<T>, Vec<Point3<T>>), expected: u64) {
    let mut hashes: Vec<(String, u64)> = Vec::new();
    let mut add = |name: String, answers: &[Option<Closest<T>>]| match hashes
        .iter_mut()
        .find(|(seen_name, _)| *seen_name == name)
    {
        Some((_, so_far)) => *so_far = hash(*so_far, answers),
        None => hashes.push((name, hash(0xcbf2_9ce4_8422_2325, answers))),
    };
    for number in 0..SCENES.len() {
        let (soup, queries) = of(number);
        // The number of threads also varies for the build.
        for threads in [1, 3, 8] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            let indexes = pool.install(|| {
                [
                    ("aabb", built::<T, AabbTree<_, _>>(&soup)),
                    ("kdop", built::<T, KdopTree<_, _, 14>>(&soup)),
                    ("octree", built::<T, OctreeIndex<_, _>>(&soup)),
                    ("p2m", built::<T, P2mIndex<_, _>>(&soup)),
                ]
            });
            for (name, index) in &indexes {
                add(format!("{name}, {threads} threads"), &pool.install(|| index.in_batches(&queries)));
                if threads == 1 {
                    for isa in Isa::available() {
                        add(format!("{name}, {}", isa.name()), &index.single_threaded(isa, &queries));
                    }
                }
            }
        }
    }
    for (name, hash) in &hashes {
        assert_eq!(*hash, expected, "{name}: {hash:#x}");
    }
    assert_eq!(hashes.len(), 4 * (3 + Isa::available().len()));
    let query_count: usize = SCENES.iter().map(|(_, _, full, shallow)| amount(full, shallow)[1]).sum();
    println!("{} answers, {expected:#x}", hashes.len() * query_count);
}

#[test]
fn answers_are_the_same_bits_in_f64() {
    check(scene, expected()[0]);
}

#[test]
fn answers_are_the_same_bits_in_f32() {
    let single = |number: usize| {
        let (soup, queries) = scene(number);
        (scenes::narrow(&soup).expect("fits f32"), queries.into_iter().map(scenes::to_f32).collect())
    };
    check::<f32>(single, expected()[1]);
}
