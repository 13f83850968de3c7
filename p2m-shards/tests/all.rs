//! An index in shards has the answers of one index over the whole scene, bit for bit, however the scene is divided and
//! whatever memory shards may take; and it answers nothing if the file of a shard is wrong.

use nalgebra::{Point3, Vector3};
use p2m_backends::{BACKENDS, BackendEntry};
use p2m_bvh::AabbTree;
use p2m_core::{
    BruteForce, CertifiedQuery, Closest, ClosestPoint, Element, Hit, NearQuery, PrimitiveId, PrimitiveSet,
    QueryOptions, Ray, RayQuery, Soup,
};
use p2m_field::sign::{SignRule, SignedDistance};
use p2m_mixed::generate::Transform;
use p2m_mixed::{Object, PieceOptions, Scene};
use p2m_shards::{
    MANIFEST_FILE, Manifest, ShardClosest, ShardError, ShardHit, ShardOptions, ShardWriter, ShardedIndex,
};
use p2m_testkit::scenes::{self, KINDS, LAYOUTS, Layout};
use p2m_testkit::{amount, cases, rng};
use rand::{Rng, RngExt};
use std::fs;
use std::path::Path;

/// Writes a scene as shards, in random pieces.
fn write(rng: &mut impl Rng, folder: &Path, soup: &Soup<f64>, options: ShardOptions) -> ShardedIndex {
    let mut writer = ShardWriter::new(folder, options).unwrap();
    let mut first = 0;
    while first < soup.len() {
        let end = rng.random_range(first + 1..=soup.len());
        let elements = (first..end).map(|i| soup.element(PrimitiveId::new(i)));
        writer.add_scene(&Soup::new(soup.positions().to_vec(), elements).unwrap().into()).unwrap();
        first = end;
    }
    writer.finish().unwrap()
}

/// Returns queries in, around, on and far from a scene, of which some are not finite.
fn queries(rng: &mut impl Rng, soup: &Soup<f64>, count: usize) -> Vec<Point3<f64>> {
    let bounds = soup.aabb();
    let size = if soup.is_empty() { 1.0 } else { (bounds.max - bounds.min).norm().max(1e-30) };
    let positions = if soup.is_empty() { &[Point3::new(0.0, 0.0, 0.0)] } else { soup.positions() };
    let random = |_| {
        let near = positions[rng.random_range(0..positions.len())];
        let away = size * [0.0, 1e-6, 0.01, 0.3, 5.0, 1e9][rng.random_range(0..6)];
        let mut query = near.map(|x| x + away * rng.random_range(-1.0..1.0));
        if rng.random_range(0..16) == 0 {
            query[rng.random_range(0..3)] = [f64::NAN, f64::INFINITY, 1e300][rng.random_range(0..3)];
        }
        query
    };
    (0..count).map(random).collect()
}

/// The bits of an answer, apart from its lower bound, with its id in the whole scene.
type Fields = (u64, [u64; 7], String);

fn fields(id: u64, closest: &Closest<f64>) -> Fields {
    let [x, y, z]: [f64; 3] = closest.point.coords.into();
    let [a, b, c] = closest.barycentric;
    (id, [closest.distance, x, y, z, a, b, c].map(f64::to_bits), format!("{:?}", closest.feature))
}

fn of_index(closest: &Closest<f64>) -> Fields {
    fields(closest.primitive.index() as u64, closest)
}

fn of_shards(closest: &ShardClosest) -> Fields {
    fields(closest.id, &closest.closest)
}

/// The bits of a hit.
fn of_hit(id: u64, hit: &Hit) -> (u64, u64, String) {
    (id, hit.parameter.to_bits(), format!("{:?} {:?} {:?}", hit.side, hit.point(), hit.barycentric()))
}

fn of_shard_hit(hit: &ShardHit) -> (u64, u64, String) {
    of_hit(hit.id, &hit.hit)
}

/// Answers each query by the shard with the nearest box and then by all others that may matter, one after the other.
fn merged_answers(
    shards: &ShardedIndex,
    points: &[Point3<f64>],
    options: &QueryOptions<f64>,
) -> Vec<Option<ShardClosest>> {
    let ask = |number: usize, query: &Point3<f64>| {
        shards.batch().closest_points_in_shard(number, &[*query], options).unwrap()[0]
    };
    let answer = |query: &Point3<f64>| {
        let nearest = shards.nearest_shard(query, options.max_distance)?;
        let first = ask(nearest, query);
        let distance = first.map_or(options.max_distance, |(answer, _)| answer.closest.distance);
        let others = shards.shards_within(query, distance).filter(|other| *other != nearest);
        let answers = others.filter_map(|other| ask(other, query)).chain(first);
        answers.min_by_key(|(answer, key)| (*key, answer.id)).map(|(answer, _)| answer)
    };
    points.iter().map(answer).collect()
}

/// Compares all queries by points with those of brute force.
fn check_points(rng: &mut impl Rng, shards: &ShardedIndex, soup: &Soup<f64>, name: &str) {
    let brute = BruteForce::new(soup).unwrap();
    let points = queries(rng, soup, 12);
    let default = QueryOptions::default();
    let radius = points.iter().find_map(|query| brute.closest_point(query)).map_or(1.0, |c| c.distance);
    let beyond = [radius, f64::NAN, -1.0].map(|largest| default.with_max_distance(largest));
    for options in [default].into_iter().chain(beyond) {
        let expected: Vec<_> = points.iter().map(|query| brute.closest_point_with(query, &options)).collect();
        let batch = shards.batch().closest_points(&points, &options).unwrap();
        let merged = merged_answers(shards, &points, &options);
        let all_certified = shards.batch().certified_closest_points(&points, &options).unwrap();
        let merged: Vec<_> = merged.iter().map(|one| one.as_ref().map(of_shards)).collect();
        let expected_fields: Vec<_> = expected.iter().map(|one| one.as_ref().map(of_index)).collect();
        assert_eq!(merged, expected_fields, "{name}, shard by shard");
        let batches = batch.iter().zip(&all_certified);
        for ((query, expected), (batch, batch_certified)) in points.iter().zip(&expected).zip(batches) {
            let found = shards.closest_point_with(query, &options).unwrap();
            assert_eq!(found.as_ref().map(of_shards), expected.as_ref().map(of_index), "{name}, {query}");
            assert_eq!(batch.as_ref().map(of_shards), expected.as_ref().map(of_index), "{name}, batch, {query}");
            let certified = shards.certified_closest_point(query, &options).unwrap();
            let bits = |one: &ShardClosest| (of_shards(one), one.closest.lower_bound.to_bits());
            assert_eq!(batch_certified.as_ref().map(bits), certified.as_ref().map(bits), "{name}, batch, {query}");
            let expected = brute.certified_closest_point(query, &options).unwrap();
            assert_eq!(certified.as_ref().map(of_shards), expected.as_ref().map(of_index), "{name}, {query}");
            if let (Some(certified), Some(expected)) = (certified, expected) {
                let [bound, distance] = [certified.closest.lower_bound, expected.distance];
                assert!(bound <= distance && bound >= distance.next_down(), "{name}, {query}");
                // The true distance is not below the lower bound, and rounding is monotone.
                for found in [found, *batch].into_iter().flatten() {
                    assert!(found.closest.lower_bound <= certified.closest.distance, "{name}, {query}");
                }
            }
        }
    }
    for k in [0, 1, 3, 100] {
        let bits = |one: &ShardClosest| (of_shards(one), one.closest.lower_bound.to_bits());
        let batch = shards.batch().k_nearest(&points, k, radius * 3.0).unwrap();
        for (query, batch) in points.iter().zip(batch) {
            let found: Vec<_> = shards.k_nearest(query, k, radius * 3.0).unwrap();
            let [batch, one_by_one] = [&batch, &found].map(|list| list.iter().map(bits).collect::<Vec<_>>());
            assert_eq!(batch, one_by_one, "{name}, {k} nearest, batch, {query}");
            let expected = brute.k_nearest(query, k, radius * 3.0);
            let bounds = |closest: &Closest<f64>| closest.lower_bound.to_bits();
            assert_eq!(
                found.iter().map(|one| (of_shards(one), bounds(&one.closest))).collect::<Vec<_>>(),
                expected.iter().map(|one| (of_index(one), bounds(one))).collect::<Vec<_>>(),
                "{name}, {k} nearest, {query}"
            );
        }
    }
    let one_by_one: Vec<bool> = points.iter().map(|query| brute.is_any_within(query, radius)).collect();
    assert_eq!(shards.batch().is_any_within(&points, radius).unwrap(), one_by_one, "{name}, any, batch");
    for query in &points {
        let found: Vec<_> = shards.all_within(query, radius).unwrap().iter().map(of_shards).collect();
        let expected: Vec<_> = brute.all_within(query, radius).iter().map(of_index).collect();
        assert_eq!(found, expected, "{name}, {query}");
        for radius in [0.0, radius / 2.0, radius, f64::NAN, -1.0] {
            let expected = brute.is_any_within(query, radius);
            assert_eq!(shards.is_any_within(query, radius).unwrap(), expected, "{name}, {query}, {radius}");
        }
        for options in [default.with_epsilon(0.3), default.with_max_visits(rng.random_range(0..9))] {
            let found = shards.closest_point_with(query, &options).unwrap();
            let truth = brute.certified_closest_point(query, &default).unwrap();
            assert_eq!(found.is_some(), truth.is_some(), "{name}, {query}");
            if let (Some(found), Some(truth)) = (found, truth) {
                assert!(found.closest.lower_bound <= truth.distance, "{name}, {query}, {options:?}");
                let largest = truth.distance * (1.0 + options.epsilon) * (1.0 + 1e-12) + 1e-9 * truth.distance.max(1.0);
                assert!(options.epsilon == 0.0 || found.closest.distance <= largest, "{name}, {query}");
            }
        }
    }
}

/// Compares all queries by rays with those of brute force.
fn check_rays(rng: &mut impl Rng, shards: &ShardedIndex, soup: &Soup<f64>, name: &str) {
    let brute = BruteForce::new(soup).unwrap();
    let ends = queries(rng, soup, 24);
    let mut rays = Vec::new();
    for pair in ends.chunks_exact(2) {
        let Ok(ray) = Ray::through(&pair[0], &pair[1]) else { continue };
        let axis = Vector3::from(std::array::from_fn(|k| if k == rng.random_range(0..3) { 1.0 } else { 0.0 }));
        let along = Ray::new(&pair[0], &axis).unwrap_or(ray);
        let part = ray.with_range(-0.5, rng.random_range(-0.5..2.0)).unwrap();
        for ray in [ray, ray.line(), part, along, part.with_radius(0.05).unwrap()] {
            check_ray(shards, &brute, &ray, name);
            rays.push(ray);
        }
    }
    let (batch, each) = (shards.batch(), |index: &dyn Fn(&Ray) -> usize| rays.iter().map(index).collect::<Vec<_>>());
    let first = rays.iter().map(|ray| shards.first_intersection(ray).unwrap()).collect::<Vec<_>>();
    assert_eq!(batch.first_intersections(&rays).unwrap(), first, "{name}, batch");
    let all = rays.iter().map(|ray| shards.all_intersections(ray).unwrap()).collect::<Vec<_>>();
    assert_eq!(batch.all_intersections(&rays).unwrap(), all, "{name}, batch");
    assert_eq!(batch.count(&rays).unwrap(), each(&|ray| brute.count(ray)), "{name}, batch");
    assert_eq!(batch.crossings(&rays).unwrap(), each(&|ray| brute.crossings(ray)), "{name}, batch");
    let is_hit = rays.iter().map(|ray| brute.do_intersect(ray)).collect::<Vec<_>>();
    assert_eq!(batch.do_intersect(&rays).unwrap(), is_hit, "{name}, batch");
}

/// Compares all queries by a ray with those of brute force, and returns the number of hits.
fn check_ray(shards: &ShardedIndex, brute: &BruteForce<&Soup<f64>>, ray: &Ray, name: &str) -> usize {
    let name = format!("{name}, {ray:?}");
    let first = shards.first_intersection(ray).unwrap();
    let expected = brute.first_intersection(ray).map(|hit| of_hit(hit.primitive.index() as u64, &hit));
    assert_eq!(first.as_ref().map(of_shard_hit), expected, "{name}");
    let all: Vec<_> = shards.all_intersections(ray).unwrap().iter().map(of_shard_hit).collect();
    let expected: Vec<_> =
        brute.all_intersections(ray).iter().map(|hit| of_hit(hit.primitive.index() as u64, hit)).collect();
    assert_eq!(all, expected, "{name}");
    assert_eq!(shards.count(ray).unwrap(), brute.count(ray), "{name}");
    assert_eq!(shards.crossings(ray).unwrap(), brute.crossings(ray), "{name}");
    assert_eq!(shards.do_intersect(ray).unwrap(), brute.do_intersect(ray), "{name}");
    all.len()
}

#[test]
fn rays_hit_scenes_at_the_ends_of_f64() {
    let mut hits = 0;
    for case in cases(300, 20) {
        let rng = &mut rng("shards at the ends of f64", case);
        // Triangles across two faces of a box that is wider than the largest number.
        let axis = rng.random_range(0..3);
        let corner = |number: usize, rng: &mut dyn Rng| {
            let mut corner = Point3::from([(); 3].map(|()| rng.random_range(-1.0..1.0)));
            corner[axis] = if number < 9 { f64::MAX } else { -f64::MAX } * rng.random_range(0.9..1.0);
            corner
        };
        let positions = (0..18).map(|number| corner(number, rng)).collect();
        let soup = Soup::new(positions, (0..6).map(|i| Element::Triangle([3 * i, 3 * i + 1, 3 * i + 2]))).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let shards = write(rng, folder.path(), &soup, ShardOptions::default().with_max_bytes(1));
        let brute = BruteForce::new(&soup).unwrap();
        for (origin, size) in [(0.9 * f64::MAX, 1e308), (1.0, f64::MAX), (f64::MAX, 1e-3), (0.0, 1e-310)] {
            let mut from = Point3::from([(); 3].map(|()| rng.random_range(-0.2..0.2)));
            from[axis] = origin;
            let mut along = Vector3::zeros();
            along[axis] = -size;
            for direction in [along, -along] {
                let ray = Ray::new(&from, &direction).unwrap();
                for ray in [ray, ray.line(), ray.with_range(0.0, 10.0).unwrap()] {
                    hits += check_ray(&shards, &brute, &ray, &format!("case {case}"));
                }
            }
        }
    }
    assert!(hits > 100, "{hits}");
}

#[test]
fn random_scenes_in_random_shards_have_the_answers_of_one_index() {
    let saveable: Vec<&BackendEntry> = BACKENDS.iter().filter(|backend| backend.is_saveable()).collect();
    let mut most = 0;
    for case in cases(4_000, 60) {
        let rng = &mut rng("shards", case);
        let kinds = KINDS[rng.random_range(0..KINDS.len())];
        let layout = LAYOUTS[rng.random_range(0..LAYOUTS.len())];
        let len = [0, 1, 2, 10, 60, 200][rng.random_range(0..6)];
        let (positions, elements) = scenes::scene(rng, kinds, layout, len);
        let soup = Soup::new(positions.into_iter().map(Point3::from).collect(), elements).unwrap();
        let backend = saveable[if rng.random_range(0..3) == 0 { rng.random_range(0..saveable.len()) } else { 0 }];
        let max_bytes = [1, 3_000, 6_000, 20_000, 1 << 30][rng.random_range(0..5)];
        let folder = tempfile::tempdir().unwrap();
        let options = ShardOptions::default().with_max_bytes(max_bytes).with_backend(backend);
        let shards = write(rng, folder.path(), &soup, options);
        let files = &shards.manifest().shards;
        assert!(files.iter().all(|shard| shard.bytes <= max_bytes || shard.primitives == 1));
        assert_eq!(shards.manifest().primitive_count(), soup.len() as u64);
        most = most.max(files.len());
        let budget = [0, 20_000, u64::MAX][rng.random_range(0..3)];
        let shards = ShardedIndex::open_with_max_bytes(folder.path(), budget).unwrap();
        let name = format!("case {case}, {kinds:?}, {layout:?}, {len}, {backend}, {max_bytes}, {budget}");
        check_points(rng, &shards, &soup, &name);
        if backend.casts_rays {
            check_rays(rng, &shards, &soup, &name);
        }
    }
    assert!(most > 50, "scenes are divided: {most}");
}

#[test]
fn many_queries_of_a_mesh_in_one_batch() {
    let rng = &mut rng("shards of a mesh", 0);
    let (positions, elements) = scenes::scene(rng, scenes::Kinds::Triangles, Layout::Sheet, amount(60_000, 3_000));
    let soup = Soup::new(positions.into_iter().map(Point3::from).collect(), elements).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let shards = write(rng, folder.path(), &soup, ShardOptions::default().with_max_bytes(40_000));
    assert!(shards.manifest().shards.len() > 4);
    let index = AabbTree::new(&soup).unwrap();
    let points = queries(rng, &soup, amount(200_000, 5_000));
    let shards = ShardedIndex::open_with_max_bytes(folder.path(), 0).unwrap();
    let found = shards.batch().closest_points(&points, &QueryOptions::default()).unwrap();
    for (query, found) in points.iter().zip(&found) {
        let expected = index.closest_point(query);
        assert_eq!(found.as_ref().map(of_shards), expected.as_ref().map(of_index), "{query}");
    }
    // Each shard is loaded once for each phase.
    assert!(shards.loads() <= 2 * shards.manifest().shards.len() as u64, "{}", shards.loads());
    let stopped = shards.batch().with_proceed(&|_| false).closest_points(&points, &QueryOptions::default());
    assert_eq!(stopped.unwrap_err().to_string(), "the work was cancelled");
    // A query that is not finite has no answer, and takes none from the others.
    let finite = points.iter().find(|query| query.iter().all(|x| x.is_finite())).expect("most are");
    let in_first = |queries: &[Point3<f64>]| {
        let answers = shards.batch().closest_points_in_shard(0, queries, &QueryOptions::default()).unwrap();
        answers.iter().map(|answer| answer.as_ref().map(|(answer, _)| of_shards(answer))).collect::<Vec<_>>()
    };
    let alone = in_first(&[*finite]).remove(0);
    assert!(alone.is_some());
    assert_eq!(in_first(&[Point3::new(f64::NAN, 0.0, 0.0), *finite]), [None, alone]);
}

#[test]
fn closed_surfaces_have_an_inside() {
    let sphere = p2m_mixed::generate::ico_sphere(&Default::default()).unwrap();
    let rng = &mut rng("inside of shards", 0);
    let folder = tempfile::tempdir().unwrap();
    let shards = write(rng, folder.path(), &sphere, ShardOptions::default().with_max_bytes(20_000));
    assert!(shards.manifest().shards.len() > 2);
    let random_point = |_| Point3::from(std::array::from_fn(|_| rng.random_range(-1.2..1.2)));
    let points: Vec<Point3<f64>> = (0..amount(10_000, 300)).map(random_point).collect();
    let batch = shards.batch().contains(&points).unwrap();
    for (query, is_inside) in points.into_iter().zip(batch) {
        assert_eq!(shards.contains(&query).unwrap(), is_inside, "{query}");
        let radius = query.coords.norm();
        // The sphere is a polyhedron, whose faces are a little inside.
        if !(0.98..=1.0).contains(&radius) {
            assert_eq!(is_inside, radius < 0.98, "{query}");
        }
    }
    assert!(!shards.contains(&Point3::new(f64::NAN, 0.0, 0.0)).unwrap());
    // Overlapping shells, and the same with half of their triangles turned: the rules are those of one index.
    let mut scene = p2m_mixed::Scene::default();
    scene.add("", &sphere).unwrap();
    scene.add("", &Transform::default().translated([0.9, 0.2, 0.1]).apply(&sphere).unwrap()).unwrap();
    let turned = scene
        .soup
        .triangles()
        .iter()
        .enumerate()
        .map(|(i, [a, b, c])| if i % 2 == 0 { [*a, *b, *c] } else { [*a, *c, *b] });
    let turned = Soup::from_triangles(scene.soup.positions().to_vec(), turned.collect()).unwrap();
    for (soup, rule) in [(&*scene.soup, SignRule::Winding), (&turned, SignRule::Parity)] {
        let folder = tempfile::tempdir().unwrap();
        let shards = write(rng, folder.path(), soup, ShardOptions::default().with_max_bytes(20_000));
        assert_eq!(shards.sign_rule().unwrap(), rule);
        let signed = SignedDistance::new(AabbTree::new(soup).unwrap(), soup).unwrap();
        assert_eq!(signed.rule(), rule);
        let points: Vec<Point3<f64>> = (0..amount(10_000, 500))
            .map(|_| Point3::from(std::array::from_fn(|_| rng.random_range(-1.2..2.2))))
            .collect();
        let (inside, expected) =
            (shards.batch().contains(&points).unwrap(), signed.contains_each(&points, &Default::default()));
        assert_eq!(inside, expected);
        assert!(inside.iter().filter(|inside| **inside).count() > points.len() / 20);
    }
    let open = Soup::from_triangles(sphere.positions().to_vec(), sphere.triangles()[1..].to_vec()).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let shards = write(rng, folder.path(), &open, ShardOptions::default());
    assert!(matches!(shards.contains(&[0.0; 3]), Err(ShardError::Open)));
    let folder = tempfile::tempdir().unwrap();
    let point = Soup::new(vec![Point3::origin()], [Element::Point(0)]).unwrap();
    let shards = write(rng, folder.path(), &point, ShardOptions::default());
    assert!(matches!(shards.contains(&[0.0; 3]), Err(ShardError::NoInside)));
}

#[test]
fn names_and_sources_are_kept() {
    let triangle = |x: f64| {
        let positions = [[x, 0.0, 0.0], [x + 1.0, 0.0, 0.0], [x, 1.0, 0.0]];
        let mut scene = Scene::from(Soup::from_arrays(&positions, &[[0u32, 1, 2]]).unwrap());
        scene.sources = vec![7];
        scene.objects = vec![Object { name: if x < 20.0 { "a".to_owned() } else { "b".to_owned() }, ids: 0..1 }];
        scene
    };
    let folder = tempfile::tempdir().unwrap();
    let mut writer = ShardWriter::new(folder.path(), ShardOptions::default().with_max_bytes(1)).unwrap();
    (0..4).for_each(|i| writer.add_scene(&triangle(10.0 * f64::from(i))).unwrap());
    let shards = writer.finish().unwrap();
    let objects = shards.manifest().objects();
    let named: Vec<_> = objects.iter().map(|object| (&*object.name, object.ids.clone())).collect();
    assert_eq!(named, [("a", 0..2), ("b", 2..4)]);
    assert_eq!(shards.manifest().shards.len(), 4);
    let scene = p2m_mixed::read_scene(&folder.path().join(&shards.manifest().shards[3].file)).unwrap();
    assert_eq!((scene.soup.len(), scene.sources), (1, vec![7]));
}

#[test]
fn a_file_in_pieces_has_the_ids_and_objects_of_its_scene() {
    let folder = tempfile::tempdir().unwrap();
    let mut text = String::from("o strip\n");
    for i in 1..40 {
        // A triangle, a segment and a point of each vertex, in two objects and none.
        text += &format!("v {i} {} 0\nf -1 1 1\nl 1 -1\np -1\n{}", i % 3, ["", "o\n", "o rest\n"][i / 14]);
    }
    let path = folder.path().join("mixed.obj");
    fs::write(&path, text).unwrap();
    let scene = p2m_mixed::read_scene(&path).unwrap();
    let first = Soup::new(vec![Point3::new(1e3, 0.0, 0.0)], [Element::Point(0)]).unwrap();
    let options = ShardOptions::default().with_max_bytes(3_000);
    let mut writer = ShardWriter::new(&folder.path().join("small"), options).unwrap();
    let summary = writer.add_file(&path, &PieceOptions::default()).unwrap();
    assert!(summary.piece_count > 2, "a piece takes no more memory than a shard: {}", summary.piece_count);
    for len in [1, 5, 1000] {
        let mut writer = ShardWriter::new(&folder.path().join(len.to_string()), ShardOptions::default()).unwrap();
        writer.add_scene(&first.clone().into()).unwrap();
        let summary = writer.add_file(&path, &PieceOptions::default().with_max_primitives(len)).unwrap();
        assert_eq!(summary.primitive_count, scene.soup.len() as u64);
        assert!(matches!(writer.add_file(folder.path(), &PieceOptions::default()), Err(ShardError::Scene(_))));
        let shards = writer.finish().unwrap();
        let objects: Vec<_> = shards.manifest().objects().iter().map(|o| (o.name.clone(), o.ids.clone())).collect();
        let expected = scene.objects.iter().map(|o| (o.name.clone(), o.ids.start + 1..o.ids.end + 1));
        assert_eq!(objects, expected.collect::<Vec<_>>());
        let index = BruteForce::new(&scene.soup).unwrap();
        for query in queries(&mut rng("shards of a file", 0), &scene.soup, 50) {
            let expected = index.closest_point(&query).map(|c| fields(c.primitive.index() as u64 + 1, &c));
            let found = shards.closest_point(&query).unwrap().filter(|answer| answer.id > 0);
            if let Some(answer) = found {
                assert_eq!(Some(fields(answer.id, &answer.closest)), expected);
            }
        }
    }
}

/// Returns the message of the error of a query for which all shards are needed.
fn error_of(folder: &Path) -> String {
    match ShardedIndex::open(folder) {
        Ok(shards) => shards.k_nearest(&[0.0; 3], usize::MAX, f64::INFINITY).unwrap_err().to_string(),
        Err(error) => error.to_string(),
    }
}

#[test]
fn a_wrong_file_is_an_error_that_names_it() {
    let rng = &mut rng("wrong shards", 0);
    let sphere = p2m_mixed::generate::ico_sphere(&Default::default()).unwrap();
    let options = ShardOptions::default().with_max_bytes(20_000);
    let write = |rng: &mut _, folder: &Path| write(rng, folder, &sphere, options.with_replace(true));
    let [folder, other] = [(); 2].map(|()| tempfile::tempdir().unwrap());
    let (folder, other) = (folder.path(), other.path());
    write(rng, folder);
    let mut larger = sphere.clone();
    larger.map_positions(|p| p * 2.0).unwrap();
    crate::write(rng, other, &larger, options);
    let file = folder.join("0-00001.p2m");
    let bytes = fs::read(&file).unwrap();

    fs::remove_file(&file).unwrap();
    assert!(error_of(folder).contains("0-00001.p2m"), "{}", error_of(folder));
    fs::write(&file, &bytes[..bytes.len() - 64]).unwrap();
    let length = format!("0-00001.p2m has {} bytes instead of {}", bytes.len() - 64, bytes.len());
    assert!(error_of(folder).ends_with(&length), "{}", error_of(folder));
    let mut damaged = bytes.clone();
    damaged[bytes.len() / 2] ^= 1;
    fs::write(&file, &damaged).unwrap();
    assert!(error_of(folder).contains("0-00001.p2m is damaged: the checksum of"), "{}", error_of(folder));
    let mut version = bytes.clone();
    version[8] = 250;
    fs::write(&file, &version).unwrap();
    assert!(error_of(folder).contains("0-00001.p2m has version 250 of the format"), "{}", error_of(folder));
    // A shard of the same length that belongs to another scene.
    let same = Manifest::read(other).unwrap().shards.iter().find(|shard| shard.bytes == bytes.len() as u64).cloned();
    fs::copy(other.join(same.expect("both spheres are divided alike").file), &file).unwrap();
    assert!(error_of(folder).ends_with("not the shard that the manifest describes: its checksum differs"));
    fs::write(&file, &bytes).unwrap();
    assert!(ShardedIndex::open(folder).unwrap().closest_point(&[0.0; 3]).unwrap().is_some());

    let manifest = folder.join(MANIFEST_FILE);
    let text = fs::read_to_string(&manifest).unwrap();
    fs::write(&manifest, text.replacen("\"primitives\": ", "\"primitives\": 1", 1)).unwrap();
    assert!(error_of(folder).ends_with("the manifest is damaged: its checksum is wrong"), "{}", error_of(folder));
    fs::write(&manifest, text.replacen("\"version\": 2", "\"version\": 3", 1)).unwrap();
    assert!(error_of(folder).ends_with("the manifest has version 3, but this program reads version 2"));
    fs::write(&manifest, "{}").unwrap();
    assert!(error_of(folder).contains("not the manifest of a sharded index"), "{}", error_of(folder));
    fs::remove_file(&manifest).unwrap();
    assert!(error_of(folder).contains(MANIFEST_FILE), "{}", error_of(folder));
}

/// Lies with a right checksum are found as well.
#[test]
fn a_manifest_that_contradicts_itself_or_its_files_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let sphere = p2m_mixed::generate::ico_sphere(&Default::default()).unwrap();
    write(&mut rng("forged manifests", 0), folder, &sphere, ShardOptions::default().with_max_bytes(20_000));
    let path = folder.join(MANIFEST_FILE);
    let text = fs::read_to_string(&path).unwrap();
    let true_one = Manifest::read(folder).unwrap();
    let forged = |forge: &dyn Fn(&mut Manifest)| {
        let (mut manifest, mut document) =
            (true_one.clone(), serde_json::from_str::<serde_json::Value>(&text).unwrap());
        forge(&mut manifest);
        document["checksum"] = manifest.checksum().into();
        document["manifest"] = serde_json::to_value(&manifest).unwrap();
        fs::write(&path, document.to_string()).unwrap();
        error_of(folder)
    };
    let twice = forged(&|manifest| {
        let (first, second) = (manifest.shards[0].clone(), manifest.shards[1].primitives);
        manifest.triangles += first.primitives;
        manifest.triangles -= second;
        manifest.shards[1] = first;
    });
    assert!(twice.ends_with("the manifest contradicts itself: the file of a shard is there twice"), "{twice}");
    let object = |first: u64, primitives: u64| {
        let entry = serde_json::json!({ "name": "a", "first": first, "primitives": primitives });
        forged(&|manifest| manifest.objects = vec![serde_json::from_value(entry.clone()).unwrap()])
    };
    let total = true_one.primitive_count();
    for error in [object(0, total + 1), object(total, 1), object(u64::MAX, 2)] {
        assert!(error.ends_with("an object has primitives that the scene does not have"), "{error}");
    }
    let other = BACKENDS.iter().find(|backend| backend.name != true_one.backend).expect("several backends");
    let backend = forged(&|manifest| manifest.backend = other.name.to_owned());
    assert!(backend.ends_with("not the shard that the manifest describes: its backend differs"), "{backend}");
}

#[test]
fn an_index_is_only_replaced_on_purpose_and_unfinished_ones_leave_nothing() {
    let rng = &mut rng("replaced shards", 0);
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("site");
    let sphere = p2m_mixed::generate::ico_sphere(&Default::default()).unwrap();
    let options = ShardOptions::default().with_max_bytes(20_000);
    let mut writer = ShardWriter::new(&folder, options).unwrap();
    writer.add_scene(&sphere.clone().into()).unwrap();
    let cancelled = writer.finish_with_progress(&mut |_| std::ops::ControlFlow::Break(()));
    assert!(matches!(cancelled, Err(ShardError::Cancelled)));
    assert!(!folder.exists());
    let count = write(rng, &folder, &sphere, options).manifest().shards.len();
    assert!(matches!(ShardWriter::new(&folder, options), Err(ShardError::Exists { .. })));
    let one = write(rng, &folder, &sphere, ShardOptions::default().with_replace(true));
    assert_eq!(one.manifest().shards.len(), 1);
    assert!(count > 1 && fs::read_dir(&folder).unwrap().count() == 2, "the shards that were replaced are gone");
}

/// Returns the sorted names of the files of a folder.
fn names(folder: &Path) -> Vec<String> {
    let name = |entry: std::io::Result<fs::DirEntry>| entry.unwrap().file_name().into_string().unwrap();
    let mut names: Vec<String> = fs::read_dir(folder).unwrap().map(name).collect();
    names.sort_unstable();
    names
}

/// Returns a writer to which a sphere of several shards was added.
fn writer_of_sphere(folder: &Path, replace: bool) -> ShardWriter {
    let options = ShardOptions::default().with_max_bytes(20_000).with_replace(replace);
    let mut writer = ShardWriter::new(folder, options).unwrap();
    writer.add_scene(&p2m_mixed::generate::ico_sphere(&Default::default()).unwrap().into()).unwrap();
    writer
}

/// Checks that the index of a folder has the manifest, and that all of its shards can be loaded.
fn assert_whole(folder: &Path, manifest: &Manifest) {
    let shards = ShardedIndex::open(folder).unwrap();
    assert_eq!(shards.manifest(), manifest);
    (0..manifest.shards.len()).for_each(|number| drop(shards.shard(number).unwrap()));
}

#[test]
fn a_replacement_that_fails_keeps_the_old_index() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let old = writer_of_sphere(folder, false).finish().unwrap().manifest().clone();
    let files = names(folder);
    drop(writer_of_sphere(folder, true));
    assert_whole(folder, &old);
    let cancelled = writer_of_sphere(folder, true).finish_with_progress(&mut |_| std::ops::ControlFlow::Break(()));
    assert!(matches!(cancelled, Err(ShardError::Cancelled)));
    assert_whole(folder, &old);
    assert_eq!(names(folder), files);
    // The manifest cannot be replaced by a file.
    fs::remove_file(folder.join(MANIFEST_FILE)).unwrap();
    fs::create_dir_all(folder.join(MANIFEST_FILE).join("full")).unwrap();
    assert!(matches!(writer_of_sphere(folder, true).finish(), Err(ShardError::Io { .. })));
    assert_eq!(names(folder), files);
}

#[test]
fn two_writers_do_not_disturb_each_other() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let [first, second] = [(); 2].map(|()| writer_of_sphere(folder, false));
    let manifest = first.finish().unwrap().manifest().clone();
    assert!(matches!(second.finish(), Err(ShardError::Exists { .. })));
    assert_whole(folder, &manifest);
    assert_eq!(names(folder).len(), manifest.shards.len() + 1);
    // A replacement that finishes during another one removes the files of that, which notices it.
    let [first, second] = [(); 2].map(|()| writer_of_sphere(folder, true));
    let (mut second, mut manifest) = (Some(second), manifest);
    let overtaken = first.finish_with_progress(&mut |_| {
        if let Some(second) = second.take() {
            manifest = second.finish().unwrap().manifest().clone();
        }
        std::ops::ControlFlow::Continue(())
    });
    assert!(matches!(overtaken, Err(ShardError::Io { .. })));
    assert_whole(folder, &manifest);
    assert_eq!(names(folder).len(), manifest.shards.len() + 1);
}

#[test]
fn a_writer_changes_no_file_of_others_and_a_replacement_removes_what_runs_have_left() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let (foreign, left) = (["00000.p2m", "0.p2m", "notes.txt"], ["0-00000.p2m", "3-00001.p2m", "1-manifest.json"]);
    let all = || foreign.iter().chain(&left).map(|name| folder.join(name));
    all().for_each(|file| fs::write(file, "another").unwrap());
    let manifest = writer_of_sphere(folder, false).finish().unwrap().manifest().clone();
    all().for_each(|file| assert_eq!(fs::read(file).unwrap(), b"another"));
    assert_whole(folder, &manifest);
    let manifest = writer_of_sphere(folder, true).finish().unwrap().manifest().clone();
    assert_whole(folder, &manifest);
    foreign.iter().for_each(|name| assert_eq!(fs::read(folder.join(name)).unwrap(), b"another"));
    assert_eq!(names(folder).len(), foreign.len() + manifest.shards.len() + 1);
}

#[test]
fn shards_are_used_while_others_make_room() {
    let folder = tempfile::tempdir().unwrap();
    let mut rng = rng("shards_are_used_while_others_make_room", 0);
    let positions: Vec<Point3<f64>> =
        (0..2000).map(|_| Point3::from([0; 3].map(|_| rng.random_range(0.0..1.0)))).collect();
    let soup = Soup::new(positions.clone(), (0..2000).map(Element::Point)).unwrap();
    let written = write(&mut rng, folder.path(), &soup, ShardOptions::default().with_max_bytes(6000));
    assert!(written.manifest().shards.len() > 40);
    let shards = ShardedIndex::open_with_max_bytes(folder.path(), 0).unwrap();
    // Approximate queries ask for shards one by one, on all threads at the same time.
    let options = QueryOptions::default().with_epsilon(0.01);
    let answers = shards.batch().closest_points(&positions, &options).unwrap();
    assert!(answers.iter().all(|answer| answer.is_some_and(|answer| answer.closest.distance == 0.0)));
}
