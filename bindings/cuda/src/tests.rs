//! Tests on the host: the kernels that the card runs, compiled by a C++ compiler.
#![allow(clippy::float_cmp, reason = "bitwise equality is what is tested")]

use crate::host::HostCard;
use crate::scene::plate;
use crate::{BatchReport, CardColumns, CardQueries, CudaOptions, OnCard};
use bytemuck::{Pod, bytes_of};
use nalgebra::Point3;
use p2m_bvh::AabbTree;
use p2m_core::batch::{self, BatchOptions, ClosestColumns};
use p2m_core::{Feature, Primitive, QueryOptions, Real, Soup};
use p2m_testkit::families::{case, shape, wild};
use p2m_testkit::model_file;
use p2m_testkit::queries::QuerySet;
use p2m_testkit::scenes::{extreme_soups, narrow, queries, random_soups, to_f32};
use p2m_testkit::{amount, cases, rng};
use rand::RngExt;

type Nearest = extern "C" fn(*const f64, *const f64, i32, f64, *mut f64) -> i32;
const FARTHER: i32 = 0;
const FOUND: i32 = 1;

#[test]
fn the_kernel_has_the_bits_of_the_contract() {
    let Some(card) = HostCard::open() else { return };
    let nearest = card.function::<Nearest>("p2m_nearest");
    let (mut decided, mut undecided, mut pruned) = (0, 0, 0);
    let all = cases(100_000_000, 1_000_000);
    for number in all.clone() {
        let mut rng = rng("cuda kernel", number);
        let case = if number % 8 == 0 { wild(&mut rng) } else { case(&mut rng) };
        let expected = shape(&case.vertices).project(&Point3::from(case.query));
        let count = i32::try_from(case.vertices.len()).unwrap();
        let call = |prune: f64| {
            let mut out = [0.0; 9];
            let outcome =
                nearest(case.query.as_ptr(), case.vertices.as_flattened().as_ptr(), count, prune, out.as_mut_ptr());
            (outcome, out)
        };
        let (outcome, out) = call(f64::INFINITY);
        assert_ne!(outcome, FARTHER, "{case:?}");
        if outcome != FOUND {
            undecided += 1;
            continue;
        }
        decided += 1;
        let feature = expected.feature.code();
        let numbers = [
            expected.key.order()[1],
            expected.point.x,
            expected.point.y,
            expected.point.z,
            expected.barycentric[0],
            expected.barycentric[1],
            expected.barycentric[2],
            f64::from(feature),
        ];
        assert_eq!(out[..8].iter().map(|x| x.to_bits()).collect::<Vec<_>>(), numbers.map(f64::to_bits), "{case:?}");
        // A limit at the key changes nothing, and one below it may end the work.
        let (with_limit, limited) = call(out[0]);
        assert_eq!((with_limit, limited), (FOUND, out), "{case:?}");
        let (below, limited) = call(out[0] * 0.5);
        assert!(below == FARTHER || limited == out, "{case:?}");
        pruned += usize::from(below == FARTHER);
    }
    println!("{decided} decided, {undecided} left to the processor, {pruned} pruned");
    assert!(all.have_more_than(40_000_000, decided) && all.have_more_than(30_000_000, pruned));
    assert!(undecided > 0, "the families have slivers and extreme scales");
}

#[test]
fn squares_of_plates_are_within_their_error() {
    let Some(card) = HostCard::open() else { return };
    let square = card.function::<extern "C" fn(*const u8, *const f32) -> f32>("p2m_plate_square");
    let unit = 1.0 / f64::from(1u32 << 24);
    let mut worst = 0.0f64;
    for number in cases(10_000_000, 100_000) {
        let mut rng = rng("plates", number);
        // Vertices are in the cube of the frame, with edges and heights of all sizes, and so are queries, or far away.
        let count = rng.random_range(1..=3);
        let mut near =
            |from: [f64; 3], scale: f64| from.map(|x| (x + scale * rng.random_range(-1.0..1.0)).clamp(-1.0, 1.0));
        let first = near([0.0; 3], 1.0);
        let mut vertices = vec![first];
        let mut scales = [0.0f64; 2].map(|_| near([0.0; 3], 1.0)[0]);
        scales.iter_mut().for_each(|x| *x = (10.0 * *x - 9.0).exp2().min(1.0));
        if count > 1 {
            vertices.push(near(first, scales[0]));
        }
        if count > 2 {
            // The third vertex is near the line of the others as often as not.
            let t = near([0.5; 3], 0.7)[0];
            let on: [f64; 3] = std::array::from_fn(|k| vertices[0][k] * (1.0 - t) + vertices[1][k] * t);
            let height = if scales[1] > 0.01 { scales[0] } else { scales[0] * scales[1].powi(4) };
            vertices.push(near(on.map(|x| x.clamp(-1.0, 1.0)), height));
        }
        let distance = (20.0 * near([0.0; 3], 1.0)[1] - 14.0).exp2();
        let query: [f64; 3] = std::array::from_fn(|k| vertices[0][k] + distance * near([0.0; 3], 1.0)[k]);
        #[allow(clippy::cast_possible_truncation, reason = "as the kernel rounds a query")]
        let rounded = query.map(|x| x as f32);
        let plate = plate(&vertices);
        let computed = f64::from(square(bytes_of(&plate).as_ptr(), rounded.as_ptr())).sqrt();
        // The kernel in f64 errs by less than 2^-48 of that bound.
        let truth = shape(&vertices).project(&Point3::from(query)).key.distance();
        let error = (computed - truth).abs();
        let largest = query.into_iter().fold(0.0f64, |m, x| m.max(x.abs()));
        let bound = 4.0 * unit * (largest + 1.0) + 40.0 * unit * (computed + f64::from(plate.length));
        let used = error / bound;
        worst = worst.max(used);
        assert!(used <= 1.0, "{used}: {vertices:?} {query:?}");
    }
    println!("at most {worst:.3} of the error is used");
    assert!(worst > 0.05, "the error is not far too large");
}

/// Compares all columns of the card with those of the tree, and returns how queries were answered.
fn agrees<T: Real + Pod>(
    soup: &Soup<T>,
    queries: &[Point3<T>],
    max_distance: T,
    options: &CudaOptions,
) -> Option<(BatchReport, u64)> {
    let card = HostCard::open()?;
    let tree = AabbTree::new(soup.clone()).unwrap();
    let expected = answers(queries.len(), |columns| {
        let options = QueryOptions::default().with_max_distance(max_distance);
        batch::closest_columns_into(&tree, queries, &options, &BatchOptions::default(), columns);
    });
    let index = match OnCard::new(card, tree, options) {
        Ok(index) => index,
        Err(error) => {
            // Scenes at the ends of the range, and those without primitives.
            assert!(matches!(error, crate::CudaError::Scale | crate::CudaError::Empty), "{error}");
            return None;
        }
    };
    let mut report = BatchReport::default();
    let found = answers(queries.len(), |mut columns| {
        report = index.closest_columns_into(queries, max_distance, &mut columns).unwrap();
    });
    for (i, query) in queries.iter().enumerate() {
        let bits = |all: &All<T>| {
            let point = all.point[i].coords.map(|x| x.to_f64().to_bits());
            let weights = all.weights[i].map(|x| x.to_f64().to_bits());
            (all.distance[i].to_f64().to_bits(), all.primitive[i], point, all.feature[i], weights)
        };
        assert_eq!(bits(&found), bits(&expected), "{query:?}");
        // Lower bounds depend on the index, but they are bounds and nearly as good.
        let (bound, other) = (found.lower_bound[i].to_f64(), expected.lower_bound[i].to_f64());
        assert!(bound <= found.distance[i].to_f64(), "{query:?}");
        if expected.primitive[i] == ClosestColumns::<T>::NO_PRIMITIVE {
            assert!(bound <= other, "{query:?}: {bound} {other}");
        }
        let scale = found.distance[i].to_f64() + query.coords.norm().to_f64();
        assert!(other - bound <= 1e-6 * scale || other == bound, "{query:?}: {bound} {other}");
    }
    // Distances alone are the same, and so are answers to queries that are on the card.
    let options = CudaOptions { reorder: !options.reorder, checked: 5, ..*options };
    let index = OnCard { options, ..index };
    let mut distance = vec![T::zero(); queries.len()];
    let mut columns = ClosestColumns::default().with_distance(&mut distance);
    index.closest_columns_into(queries, max_distance, &mut columns).unwrap();
    let bits = |column: &[T]| column.iter().map(|x| x.to_f64().to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&distance), bits(&expected.distance));
    let mut all = found;
    let mut features = vec![0u8; queries.len()];
    all.distance.fill(T::zero());
    all.primitive.fill(0);
    all.point.fill(Point3::origin());
    all.weights.fill([T::zero(); 3]);
    let columns = CardColumns {
        distance: all.distance.as_mut_ptr() as u64,
        lower_bound: 0,
        point: all.point.as_mut_ptr() as u64,
        barycentric: all.weights.as_mut_ptr() as u64,
        primitive: all.primitive.as_mut_ptr() as u64,
        feature: features.as_mut_ptr() as u64,
    };
    let on_card = |address, is_f32| CardQueries { address, count: queries.len(), is_f32 };
    index.closest_on_card(&on_card(queries.as_ptr() as u64, false), max_distance, &columns).unwrap();
    let is_missing = |i: usize| expected.primitive[i] == ClosestColumns::<T>::NO_PRIMITIVE;
    assert!((0..queries.len()).all(|i| features[i] == if is_missing(i) { 255 } else { expected.feature[i].code() }));
    assert_eq!((bits(&all.distance), &all.primitive), (bits(&expected.distance), &expected.primitive));
    let points = |all: &All<T>| bits(bytemuck::cast_slice(&all.point));
    assert_eq!(points(&all), points(&expected));
    assert_eq!(bits(all.weights.as_flattened()), bits(expected.weights.as_flattened()));
    // Queries in f32 for a scene of any scalar.
    #[allow(clippy::cast_possible_truncation, reason = "queries of the test")]
    let narrowed: Vec<_> = queries.iter().map(|query| query.coords.map(|x| x.to_f64() as f32)).collect();
    let widened: Vec<Point3<T>> =
        narrowed.iter().map(|query| query.map(|x| T::round_from_f64(f64::from(x))).into()).collect();
    index.closest_on_card(&on_card(narrowed.as_ptr() as u64, true), max_distance, &columns).unwrap();
    let again = answers(queries.len(), |mut columns| {
        index.closest_columns_into(&widened, max_distance, &mut columns).unwrap();
    });
    assert_eq!((bits(&all.distance), &all.primitive), (bits(&again.distance), &again.primitive));
    Some((report, index.engine.cells_without_list()))
}

struct All<T: Real> {
    distance: Vec<T>,
    lower_bound: Vec<T>,
    primitive: Vec<u32>,
    point: Vec<Point3<T>>,
    feature: Vec<Feature>,
    weights: Vec<[T; 3]>,
}

fn answers<T: Real>(count: usize, answer: impl FnOnce(ClosestColumns<'_, T>)) -> All<T> {
    let mut all = All {
        distance: vec![T::zero(); count],
        lower_bound: vec![T::zero(); count],
        primitive: vec![0; count],
        point: vec![Point3::origin(); count],
        feature: vec![Feature::Face; count],
        weights: vec![[T::zero(); 3]; count],
    };
    answer(
        ClosestColumns::default()
            .with_distance(&mut all.distance)
            .with_lower_bound(&mut all.lower_bound)
            .with_primitive(&mut all.primitive)
            .with_point(&mut all.point)
            .with_feature(&mut all.feature)
            .with_barycentric(&mut all.weights),
    );
    all
}

/// Options of small lists, so that tests are fast, and of none.
fn variants() -> [CudaOptions; 3] {
    let of = |memory, reach| CudaOptions { memory: Some(memory), reach, ..CudaOptions::default() };
    [of(1 << 16, 4.0), of(1 << 19, 0.0), of(0, 0.0)]
}

#[test]
fn agrees_on_random_scenes() {
    for (seed, soup) in random_soups("cuda") {
        let queries = queries(seed, &soup);
        let options = variants()[usize::try_from(seed % 3).unwrap()];
        let Some(_) = agrees(&soup, &queries, f64::INFINITY, &options) else { continue };
        for radius in [0.5, 0.0, -1.0, f64::NAN] {
            agrees(&soup, &queries, radius, &options);
        }
        let narrowed: Vec<_> = queries.into_iter().map(to_f32).collect();
        agrees(&narrow(&soup).expect("fits f32"), &narrowed, f32::INFINITY, &options);
    }
}

#[test]
fn agrees_at_extreme_scales() {
    for (seed, soup, queries) in extreme_soups("cuda scales") {
        agrees(&soup, &queries, f64::INFINITY, &variants()[usize::try_from(seed % 3).unwrap()]);
    }
}

#[test]
fn agrees_on_models() {
    for name in [
        "scan.ply",
        "city_far_from_origin.obj",
        "slivers.stl",
        "bunny.obj",
        "rotterdam_city_far_from_origin.obj",
        "thingi10k_1514499_slivers.stl",
        "dragon_100k.obj",
    ] {
        let Some(file) = model_file(name) else { continue };
        let soup = p2m_mixed::read_scene(&file).unwrap().soup;
        let count = amount(50_000, 500);
        let sets = [QuerySet::Box10, QuerySet::Box1, QuerySet::Near, QuerySet::Surface];
        let mut queries: Vec<_> = sets.iter().flat_map(|set| set.generate(&soup, count, 7)).collect();
        queries.extend(soup.positions().iter().step_by(soup.positions().len() / 1000 + 1));
        queries.extend([
            Point3::new(f64::NAN, 0.0, 0.0),
            Point3::new(1e30, 0.0, 0.0),
            Point3::new(0.0, f64::INFINITY, 0.0),
        ]);
        let options = CudaOptions { memory: amount(None, Some(1 << 21)), ..CudaOptions::default() };
        let Some((report, without_list)) = agrees(&soup, &queries, f64::INFINITY, &options) else { return };
        println!("{name}: {report:?} of {}, {without_list} cells without a list", queries.len());
        // Points near the axis of that cylinder are about equally far from all its facets.
        assert!(report.by_processor < queries.len() / 4 || name == "slivers.stl", "{name}: {report:?}");
    }
}

#[test]
fn what_is_refused_is_counted_beyond_32_bits() {
    let Some(card) = HostCard::open() else { return };
    let take_of = card.function::<extern "C" fn(*mut u64, u32, u32) -> bool>("p2m_take_of");
    let mut counter = (1 << 32) - 2u64;
    // Numbers of 32 bits would begin at 0 again, and overwrite what is there.
    assert!(!take_of(&raw mut counter, 8, 64) && !take_of(&raw mut counter, 8, 64));
    assert_eq!(counter, (1 << 32) + 14);
    let mut counter = 56;
    assert!(take_of(&raw mut counter, 8, 64) && !take_of(&raw mut counter, 1, 64));
}

#[test]
fn no_thread_loses_a_query() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let soup = Soup::<f64>::from_arrays(&corners, &[[0u32, 1, 2]]).unwrap();
    // One has a list, one goes to the tree, and one to the processor.
    let kinds = [[0.2, 0.2, 0.5], [0.2, 0.2, 500.0], [f64::NAN, 0.0, 0.0]].map(Point3::from);
    let queries: Vec<_> = kinds.into_iter().cycle().take(300_000).collect();
    let Some((report, _)) = agrees(&soup, &queries, f64::INFINITY, &CudaOptions::default()) else { return };
    assert_eq!([report.by_tree, report.by_processor], [100_000; 2]);
}

#[test]
fn equal_keys_go_to_the_lowest_id() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Point3::from);
    let elements = (0..40_000).map(|_| p2m_core::Element::Triangle([0, 1, 2]));
    let soup = Soup::new(corners.to_vec(), elements).unwrap();
    let queries = [[0.2, 0.2, 5.0], [9.0, 9.0, 0.0], [0.0, 0.0, 0.0]].map(Point3::from);
    agrees(&soup, &queries, f64::INFINITY, &CudaOptions::default());
}

#[test]
fn a_check_finds_other_bits() {
    let Some(card) = HostCard::open() else { return };
    let tree = |z: f64| {
        let corners = [[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]];
        AabbTree::new(Soup::<f64>::from_arrays(&corners, &[[0u32, 1, 2]]).unwrap()).unwrap()
    };
    let index = OnCard::new(card, tree(0.0), &CudaOptions { checked: 3, ..CudaOptions::default() }).unwrap();
    let queries = vec![Point3::new(0.2, 0.2, 1.0); 10];
    let mut distance = vec![0.0; 10];
    let mut columns = ClosestColumns::default().with_distance(&mut distance);
    index.closest_columns_into(&queries, f64::INFINITY, &mut columns).unwrap();
    // The scene on the card is not that of this tree.
    let index = OnCard { tree: tree(0.5), ..index };
    let error = index.closest_columns_into(&queries, f64::INFINITY, &mut columns).unwrap_err();
    assert_eq!(error.to_string(), "the card has answered query 0 with other bits than the processor");
}

#[test]
fn without_a_card_there_is_an_error() {
    let soup: Soup<f64> = Soup::from_arrays(&[[0.0; 3]], &[[0u32, 0, 0]]).unwrap();
    match crate::CudaIndex::new(AabbTree::new(soup).unwrap(), &CudaOptions::default()) {
        Ok(index) => assert_eq!(index.memory()[0] % 4, 0),
        Err(crate::CudaError::Driver(_)) => {}
        Err(error) => assert_eq!(error.to_string(), "there is no NVIDIA driver (libcuda) on this machine"),
    }
}
