//! Batches return the same bits as single queries, for every backend, size, instruction set and number of threads. Some
//! queries have no answer.
#![cfg(all(feature = "bvh", feature = "interception", feature = "kdop"))]

use nalgebra::Point3;
use p2m::batch::{BatchOptions, ClosestColumns, closest_columns_into, closest_points_into, distances, map};
use p2m::core::Isa;
use p2m::{AabbTree, Closest, ClosestPoint, Feature, KdopTree, NearQuery, OctreeIndex, P2mIndex};
use p2m::{PrimitiveId, PrimitiveSet, QueryOptions, Real, Soup};
use p2m_backends::{BACKENDS, BuildSettings};
use p2m_testkit::scenes::{self, Kinds, Layout, narrow};
use p2m_testkit::{amount, cases, rng};
use rand::{Rng, RngExt};
use std::sync::Arc;

/// Returns queries in, around, on and far from a scene. Some of them are not finite.
fn queries<T: Real>(rng: &mut impl Rng, soup: &Soup<T>, count: usize) -> Vec<Point3<T>> {
    let bounds = soup.aabb();
    let size = Real::to_f64((bounds.max - bounds.min).norm()).max(1e-30);
    let positions = soup.positions();
    (0..count)
        .map(|_| {
            let vertex = positions[rng.random_range(0..positions.len())].map(|x| x.to_f64());
            let away = size * [0.0, 1e-6, 0.01, 0.3, 5.0, 1e9][rng.random_range(0..6)];
            let mut query = vertex.map(|x| x + away * rng.random_range(-1.0..1.0));
            if rng.random_range(0..16) == 0 {
                query[rng.random_range(0..3)] = [f64::NAN, f64::INFINITY, 1e300][rng.random_range(0..3)];
            }
            query.map(T::round_from_f64)
        })
        .collect()
}

/// The fields of an answer that do not depend on the other candidates of a search.
type Fields<T> = (T, PrimitiveId, Point3<T>, Feature, [T; 3]);

fn fields<T: Real>(closest: Closest<T>) -> Fields<T> {
    (closest.distance, closest.primitive, closest.point, closest.feature, closest.barycentric)
}

/// Checks batches of these queries with all options of an index.
fn check<T: Real>(index: &(impl ClosestPoint<T> + Sync + ?Sized), queries: &[Point3<T>], name: &str) {
    let radius = queries.iter().find_map(|query| index.closest_point(query)).map_or(T::one(), |c| c.distance);
    let default = QueryOptions::default();
    for options in [default, default.with_max_distance(radius), default.with_hint(PrimitiveId::new(1))] {
        let expected: Vec<_> = queries.iter().map(|q| index.closest_point_with(q, &options).map(fields)).collect();
        let mut bounds: Option<Vec<Option<T>>> = None;
        for bits in 0..4 {
            let batch = BatchOptions::default().with_reorder(bits & 1 == 1).with_parallel(bits & 2 == 2);
            let mut out = vec![None; queries.len()];
            closest_points_into(index, queries, &options, &batch, &mut out);
            let found: Vec<_> = out.iter().map(|closest| closest.map(fields)).collect();
            assert!(found == expected, "{name}, {} queries, {options:?}, {batch:?}", queries.len());
            // Lower bounds do not depend on the order of the queries.
            let lower: Vec<_> = out.iter().map(|closest| closest.map(|c| c.lower_bound)).collect();
            assert!(bounds.get_or_insert(lower.clone()) == &lower, "{name}, {options:?}, {batch:?}");
            check_columns(index, queries, (&options, &batch), &out);
        }
    }
}

/// Checks that columns have the values of the answers, both all columns together and each alone.
fn check_columns<T: Real>(
    index: &(impl ClosestPoint<T> + Sync + ?Sized),
    queries: &[Point3<T>],
    (options, batch): (&QueryOptions<T>, &BatchOptions),
    expected: &[Option<Closest<T>>],
) {
    let none = ClosestColumns::<T>::NO_PRIMITIVE;
    let n = queries.len();
    let (mut distance, mut lower_bound) = (vec![T::zero(); n], vec![T::zero(); n]);
    let (mut primitive, mut alone) = (vec![0; n], vec![0; n]);
    let (mut point, mut feature) = (vec![Point3::origin(); n], vec![Feature::Face; n]);
    let mut barycentric = vec![[T::zero(); 3]; n];
    let columns = ClosestColumns::default()
        .with_distance(&mut distance)
        .with_primitive(&mut primitive)
        .with_point(&mut point)
        .with_feature(&mut feature)
        .with_barycentric(&mut barycentric)
        .with_lower_bound(&mut lower_bound);
    closest_columns_into(index, queries, options, batch, columns);
    closest_columns_into(index, queries, options, batch, ClosestColumns::default().with_primitive(&mut alone));
    assert_eq!(primitive, alone);
    for (i, expected) in expected.iter().enumerate() {
        let Some(c) = expected else {
            assert!(distance[i] == T::INFINITY && primitive[i] == none);
            // Everything beyond the limits of the options is at least as far as the bound. The true distance exceeds
            // the distance of an answer by at most the difference between that distance and the bound.
            let bound = lower_bound[i];
            let is_bound = index
                .closest_point(&queries[i])
                .map_or(bound == T::INFINITY, |c| bound.to_f64() <= 2.0 * c.distance.to_f64() - c.lower_bound.to_f64());
            let is_finite = queries[i].iter().all(|x| x.is_finite());
            assert!(is_bound || !is_finite, "{bound:?} for {:?}", queries[i]);
            assert!(point[i].iter().chain(&barycentric[i]).all(|x| x.to_f64().is_nan()));
            assert_eq!(feature[i], Feature::Vertex(0));
            continue;
        };
        assert_eq!((distance[i], primitive[i] as usize, point[i]), (c.distance, c.primitive.index(), c.point));
        assert_eq!((feature[i], barycentric[i], lower_bound[i]), (c.feature, c.barycentric, c.lower_bound));
    }
}

const LAYOUTS: [Layout; 6] =
    [Layout::Uniform, Layout::Strewn, Layout::Lattice, Layout::Sheet, Layout::Sizes, Layout::Far];
const KINDS: [Kinds; 4] = [Kinds::Triangles, Kinds::Segments, Kinds::Points, Kinds::Mixed];

#[test]
fn every_backend_answers_batches_of_every_size_as_single_queries() {
    for case in cases(12, 4) {
        let mut rng = rng("batches of every backend", case);
        let soup = scenes::soup(&mut rng, KINDS[case as usize % 4], LAYOUTS[case as usize % 6], amount(2000, 300));
        let (all, soup) = (queries(&mut rng, &soup, 40), Arc::new(soup));
        for entry in BACKENDS {
            let built = entry.build(Arc::clone(&soup), &BuildSettings::default()).expect("valid");
            for count in (0..=40).step_by(amount(1, 13)).chain([15, 16, 17, 40]) {
                check(&*built.index, &all[..count], entry.name);
            }
        }
    }
}

#[test]
fn batches_in_f32_are_single_queries_and_f32_arrays_are_queries_in_f64() {
    for case in cases(8, 2) {
        let mut rng = rng("batches in f32", case);
        let soup = scenes::soup(&mut rng, KINDS[case as usize % 4], Layout::Sheet, 300);
        let single: Soup<f32> = narrow(&soup).expect("fits f32");
        let all = queries(&mut rng, &single, 100);
        check(&AabbTree::new(&single).expect("valid"), &all, "aabb");
        check(&OctreeIndex::new(&single).expect("valid"), &all, "octree");
        let tree = AabbTree::new(&soup).expect("valid");
        let arrays: Vec<[f32; 3]> = all.iter().map(|q| q.coords.into()).collect();
        let double: Vec<Point3<f64>> = all.iter().map(|q| q.map(f64::from)).collect();
        assert_eq!(distances(&tree, &arrays), distances(&tree, &double));
    }
}

#[test]
fn every_instruction_set_answers_batches_alike() {
    for case in cases(12, 4) {
        let mut rng = rng("batches of instruction sets", case);
        let soup = scenes::soup(&mut rng, KINDS[case as usize % 4], LAYOUTS[case as usize % 6], amount(3000, 400));
        let all = queries(&mut rng, &soup, amount(300, 100));
        let tree = AabbTree::new(&soup).expect("valid");
        let expected: Vec<_> = all.iter().map(|q| tree.closest_point(q).map(fields)).collect();
        for isa in Isa::available() {
            let answers = |index: &dyn ClosestPoint<f64>| {
                let mut out = vec![None; all.len()];
                index.closest_points_into(&all, &QueryOptions::default(), &mut out);
                out.into_iter().map(|closest| closest.map(fields)).collect::<Vec<_>>()
            };
            let kdop: KdopTree<f64, _, 14> = KdopTree::new(&soup).expect("valid");
            let octree = OctreeIndex::new(&soup).expect("valid");
            let p2m = P2mIndex::new(&soup).expect("valid");
            assert!(answers(&tree.clone().with_isa(isa)) == expected, "aabb, {isa}");
            assert!(answers(&kdop.with_isa(isa)) == expected, "kdop, {isa}");
            assert!(answers(&octree.with_isa(isa)) == expected, "octree, {isa}");
            assert!(answers(&p2m.with_isa(isa)) == expected, "p2m, {isa}");
        }
    }
}

#[test]
fn a_large_batch_on_several_threads_is_single_queries() {
    let mut rng = rng("large batches", 0);
    // The scene is small, because a search for a query far beyond it takes linear time.
    let soup = scenes::soup(&mut rng, Kinds::Triangles, Layout::Strewn, 1000);
    let all = queries(&mut rng, &soup, amount(1_100_000, 20_000));
    let octree = OctreeIndex::new(&soup).expect("valid");
    let tree = AabbTree::new(&soup).expect("valid");
    for index in [&octree as &(dyn ClosestPoint<f64> + Sync), &tree] {
        let expected: Vec<_> = all.iter().map(|q| index.closest_point(q).map(fields)).collect();
        for threads in [1, 3] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            let mut out = vec![None; all.len()];
            pool.install(|| closest_points_into(index, &all, &Default::default(), &Default::default(), &mut out));
            assert!(out.into_iter().map(|closest| closest.map(fields)).eq(expected.iter().copied()), "{threads}");
        }
    }
}

#[test]
fn other_queries_are_mapped_to_their_results_in_order() {
    let mut rng = rng("mapped batches", 0);
    let soup = scenes::soup(&mut rng, Kinds::Mixed, Layout::Strewn, 1000);
    let all = queries(&mut rng, &soup, amount(100_000, 5000));
    let tree = AabbTree::new(&soup).expect("valid");
    let nearest = |query: &Point3<f64>| tree.k_nearest(query, 3, f64::INFINITY).into_iter().map(fields).collect();
    let expected: Vec<Vec<_>> = all.iter().map(nearest).collect();
    for bits in 0..4 {
        let batch = BatchOptions::default().with_reorder(bits & 1 == 1).with_parallel(bits & 2 == 2);
        assert!(map(&all, &batch, |query| *query, nearest) == expected, "{batch:?}");
        assert!(map(&all[..0], &batch, |query| *query, nearest).is_empty());
    }
}
