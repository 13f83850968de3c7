//! Compares signed distances with rays, which decide without rounding, and with surfaces whose distance is known.

use nalgebra::{Point3, Vector3};
use p2m_bvh::AabbTree;
use p2m_core::batch::BatchOptions;
use p2m_core::{BruteForce, Closest, Element, PrimitiveSet, Ray, RayQuery, Soup};
use p2m_field::sign::{Sign, SignError, SignRule, SignedDistance, WindingNumbers};
use p2m_interception::{OctreeIndex, P2mIndex};
use p2m_mixed::generate::{IcoSphere, SkewedGear, TorusKnot, Transform, ico_sphere, skewed_gear, torus_knot};
use p2m_testkit::queries::QuerySet;
use p2m_testkit::{Cases, amount, cases, model_files, models, rng};
use rand::RngExt;
use std::sync::Arc;

fn tree(soup: &Soup<f64>) -> AabbTree<f64, &Soup<f64>> {
    AabbTree::new(soup).expect("valid")
}

/// Returns whether the crossings of a ray in another direction than the library's do not cancel.
fn is_inside(index: &impl RayQuery<f64>, query: &Point3<f64>) -> bool {
    let ray = Ray::new(query, &Vector3::new(-0.31, 0.17, -0.83)).expect("finite");
    index.signed_crossings(&ray) != 0
}

/// Returns the sign by rays, and that of a query on the surface.
fn expected(index: &impl RayQuery<f64>, query: &Point3<f64>, closest: &Closest<f64>) -> Sign {
    let here = Ray::new(query, &Vector3::new(0.4, 0.5, -0.6)).expect("finite").with_range(0.0, 0.0).expect("one place");
    if closest.distance == 0.0 || closest.lower_bound <= 0.0 && index.do_intersect(&here) {
        Sign::Boundary
    } else if is_inside(index, query) {
        Sign::Inside
    } else {
        Sign::Outside
    }
}

/// Checks that signs of a closed surface are those of rays, and returns how many were ambiguous.
fn agrees_with_rays(name: &str, soup: &Soup<f64>, sets: &[QuerySet], cases: &Cases) -> (usize, u64) {
    let index = tree(soup);
    let signed = SignedDistance::new(tree(soup), soup).expect("closed");
    let mut inside = 0;
    for set in sets {
        for query in set.generate_for_cases(soup, cases, 3) {
            let answer = signed.closest_point(&query).expect("not empty");
            let expected = expected(&index, &query, &answer.closest);
            assert_eq!(answer.sign, expected, "{name}, {set}, {query:?}: {:?}", answer.closest);
            let distance = answer.distance().expect("defined");
            let is_boundary = expected == Sign::Boundary;
            assert_eq!(distance.abs(), if is_boundary { 0.0 } else { answer.closest.distance });
            assert_eq!(distance < 0.0, expected == Sign::Inside);
            inside += usize::from(expected == Sign::Inside);
        }
    }
    (inside, signed.ambiguous_count())
}

#[test]
fn signs_of_closed_models_are_those_of_rays() {
    let sets = [QuerySet::Box1, QuerySet::Near];
    // This is the number for each model and set. `P2M_DEEP=20` makes it 10^5, which takes minutes.
    let cases = cases(5_000, 300);
    let mut closed = 0;
    for path in model_files() {
        let name = path.file_name().expect("a file").to_string_lossy().into_owned();
        let soup = Arc::unwrap_or_clone(p2m_mixed::read_scene(&path).expect("readable").soup);
        let signed = SignedDistance::new(tree(&soup), &soup);
        match signed.map(|signed| (signed.rule(), signed.is_closed())) {
            Err(error) => println!("{name}: {error}"),
            Ok((SignRule::Winding, true)) => {
                closed += 1;
                let (inside, ambiguous_count) = agrees_with_rays(&name, &soup, &sets, &cases);
                println!("{name}: {inside} of {} inside, {ambiguous_count} in doubt", 2 * cases.len());
                // All sheets of degenerate_small.obj occur twice, so nothing is inside.
                assert!(cases.is_replay() || inside > 0 || name == "degenerate_small.obj", "{name}");
            }
            Ok((rule, is_closed)) => println!("{name}: {rule}, closed: {is_closed}"),
        }
    }
    // Three stand-ins are scans, and one is a cylinder.
    let least = 4 + if models().is_some() { amount(6, 1) } else { 0 };
    assert!(closed >= least, "{closed} closed models");
}

#[test]
fn generated_surfaces_have_the_signs_of_rays() {
    let knot = torus_knot(&TorusKnot::default()).expect("valid");
    let gear = skewed_gear(&SkewedGear::default()).expect("valid");
    let cases = cases(3000, 200);
    for (name, soup) in [("knot", knot), ("gear", gear)] {
        let (inside, ambiguous_count) =
            agrees_with_rays(name, &soup, &[QuerySet::Box1, QuerySet::Near, QuerySet::Surface], &cases);
        println!("{name}: {inside} of {} inside, {ambiguous_count} in doubt", 3 * cases.len());
        assert!(cases.have_more_than(1000, inside), "{name}");
    }
}

/// Returns a box of eight corners and twelve triangles with their fronts outside.
fn cube(min: [f64; 3], max: [f64; 3]) -> Soup<f64> {
    let at = |i: usize| Point3::from([0, 1, 2].map(|k| if i >> k & 1 == 0 { min[k] } else { max[k] }));
    let faces: [[u32; 4]; 6] = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    Soup::from_triangles((0..8).map(at).collect(), triangles).expect("valid")
}

fn joined(parts: &[Soup<f64>]) -> Soup<f64> {
    let mut scene = p2m_mixed::Scene::default();
    for part in parts {
        scene.add("", part).expect("room");
    }
    Arc::unwrap_or_clone(scene.soup)
}

fn flipped(soup: &Soup<f64>) -> Soup<f64> {
    let triangles = soup.triangles().iter().map(|[a, b, c]| [*a, *c, *b]).collect();
    Soup::from_triangles(soup.positions().to_vec(), triangles).expect("valid")
}

/// Returns a lattice of points around and in a scene, some of which are on its faces, edges and vertices.
fn lattice() -> impl Iterator<Item = Point3<f64>> {
    (0..11usize.pow(3)).map(|i| Point3::from([i, i / 11, i / 121].map(|i| (i % 11) as f64 * 0.5 - 1.0)))
}

#[test]
fn parts_may_be_inside_out_or_inside_of_others_or_touch() {
    let big = cube([0.0; 3], [3.0; 3]);
    let small = cube([1.0; 3], [2.0; 3]);
    // The boxes touch along an edge, with four triangles at it, or at a corner alone, with two fans at it.
    let at_edge = cube([3.0, 3.0, 0.0], [4.0, 4.0, 3.0]);
    let at_corner = cube([3.0; 3], [4.0; 3]);
    let unshared = |soup: &Soup<f64>| {
        let positions = soup.triangles().iter().flatten().map(|i| soup.positions()[*i as usize]).collect();
        Soup::new(positions, (0..soup.len() as u32).map(|t| Element::Triangle([3 * t, 3 * t + 1, 3 * t + 2])))
            .expect("valid")
    };
    let scenes = [
        ("cube", big.clone()),
        ("inside out", flipped(&big)),
        ("unshared", unshared(&big)),
        ("cavity", joined(&[big.clone(), flipped(&small)])),
        ("cavity with its front inside", joined(&[big.clone(), small.clone()])),
        ("common edge", joined(&[big.clone(), at_edge.clone()])),
        ("common edge, one inside out", joined(&[big.clone(), flipped(&at_edge)])),
        ("common corner", joined(&[big.clone(), at_corner])),
    ];
    for (name, soup) in scenes {
        let brute = BruteForce::new(&soup).expect("valid");
        let signed = SignedDistance::new(tree(&soup), &soup).expect("closed");
        let mut seen = [0; 3];
        for query in lattice() {
            let answer = signed.closest_point(&query).expect("not empty");
            let expected = expected(&brute, &query, &answer.closest);
            assert_eq!(answer.sign, expected, "{name}, {query}");
            seen[expected as usize] += 1;
        }
        assert!(seen.iter().all(|n| *n > 20), "{name}: {seen:?}");
    }
}

#[test]
fn far_and_tiny_queries_have_signs() {
    // The thin plate has two sides that are equally far from a distant query; the open one is no closed surface.
    let plate = cube([0.0; 3], [1.0, 1.0, 1e-6]);
    let signed = SignedDistance::new(tree(&plate), &plate).expect("closed");
    for far in [1e3, 1e12, 1e100, 1e300] {
        for sign in [1.0, -1.0] {
            let answer = signed.closest_point(&Point3::new(0.5, 0.25, sign * far)).expect("not empty");
            assert_eq!(answer.sign, Sign::Outside);
        }
    }
    assert_eq!(signed.closest_point(&Point3::new(0.5, 0.25, 5e-7)).expect("not empty").sign, Sign::Inside);
    // Two tetrahedra touch at the origin, and queries beside it are nearer than squares can represent.
    let up = |z: f64| [[0.0, 0.0, 0.0], [0.1, 0.0, z], [-0.1, 0.1, z], [-0.1, -0.1, z]].map(Point3::from);
    let positions: Vec<Point3<f64>> = up(1.0).into_iter().chain(up(-1.0)).collect();
    let faces = |o: u32, turn: bool| {
        [[0, 2, 1], [0, 3, 2], [0, 1, 3], [1, 2, 3]]
            .map(|[a, b, c]| if turn { [o + a, o + c, o + b] } else { [o + a, o + b, o + c] })
    };
    let triangles = faces(0, false).into_iter().chain(faces(4, true)).collect();
    let soup = Soup::from_triangles(positions, triangles).expect("valid");
    let signed = SignedDistance::new(tree(&soup), &soup).expect("closed");
    for size in [1e-320, 1e-300, 1e-160, 1e-3] {
        let at = |x: f64, z: f64| signed.closest_point(&Point3::new(x * size, 0.0, z * size)).expect("not empty").sign;
        assert_eq!((at(1.0, 0.0), at(0.0, 1.0), at(0.0, -1.0)), (Sign::Outside, Sign::Inside, Sign::Inside), "{size}");
    }
    for scale in [1e-250, 1e-150, 1e-90, 1e90, 1e150, 1e250] {
        let block = cube([-scale; 3], [scale; 3]);
        let signed = SignedDistance::new(tree(&block), &block).expect("closed");
        let at =
            |x: f64| signed.closest_point(&Point3::new(x * scale, 0.1 * scale, 0.2 * scale)).expect("not empty").sign;
        assert_eq!((at(0.5), at(1.0), at(1.5)), (Sign::Inside, Sign::Boundary, Sign::Outside), "{scale}");
    }
}

#[test]
fn the_rule_follows_from_the_surface() {
    let whole = cube([0.0; 3], [1.0; 3]);
    let found = |soup: &Soup<f64>, rule: Option<SignRule>| {
        let signed = match rule {
            None => SignedDistance::new(tree(soup), soup),
            Some(rule) => SignedDistance::with_rule(tree(soup), soup, rule),
        };
        signed.map(|signed| {
            let centre = signed.closest_point(&Point3::new(0.5, 0.5, 0.4)).expect("not empty");
            (signed.rule(), signed.is_closed(), centre.sign)
        })
    };
    let (winding, parity) = (SignRule::Winding, SignRule::Parity);
    assert_eq!(found(&whole, None), Ok((winding, true, Sign::Inside)));
    assert_eq!(found(&whole, Some(parity)), Ok((parity, true, Sign::Inside)));
    let mut triangles = whole.triangles().to_vec();
    triangles.pop();
    let open = Soup::from_triangles(whole.positions().to_vec(), triangles.clone()).expect("valid");
    assert_eq!(found(&open, None), Ok((winding, false, Sign::Inside)));
    let error = found(&open, Some(parity)).expect_err("open");
    assert_eq!(error, SignError::Open { triangle: 2, edge: 1 });
    let message = "the surface is open at edge 1 of triangle 2: the rule parity needs a closed surface, the rule winding does not";
    assert_eq!(error.to_string(), message);
    // Every second triangle is turned, so winding numbers cancel.
    let turned =
        whole.triangles().iter().enumerate().map(|(i, [a, b, c])| if i % 2 == 0 { [*a, *b, *c] } else { [*a, *c, *b] });
    let turned = Soup::from_triangles(whole.positions().to_vec(), turned.collect()).expect("valid");
    assert_eq!(found(&turned, None), Ok((parity, true, Sign::Inside)));
    assert_eq!(found(&turned, Some(winding)), Ok((winding, false, Sign::Outside)));
    let mut mixed = whole.clone();
    mixed.push(Element::Segment([0, 7])).expect("valid");
    assert_eq!(found(&mixed, None), Err(SignError::OtherKinds { others: 1 }));
    let nothing = Soup::default();
    let signed = SignedDistance::new(tree(&nothing), &nothing).expect("no error");
    assert!(signed.closest_point(&[0.0; 3]).is_none());
    let signed = SignedDistance::new(tree(&whole), &whole).expect("triangles");
    assert!(signed.closest_point(&Point3::new(f64::NAN, 0.0, 0.0)).is_none());
    assert!(signed.winding_number(&Point3::new(f64::NAN, 0.0, 0.0), 0.01).is_nan());
}

#[test]
fn points_that_are_not_finite_take_no_answers_from_others() {
    let ball = ico_sphere(&IcoSphere { frequency: 4 }).expect("valid");
    let signed = SignedDistance::new(tree(&ball), &ball).expect("triangles");
    for wrong in [f64::INFINITY, f64::NEG_INFINITY, f64::NAN] {
        let mut points: Vec<Point3<f64>> =
            (0..2000).map(|i| Point3::new(f64::from(i) / 1000.0 - 0.99, 0.1, 0.05)).collect();
        for i in (0..points.len()).step_by(20) {
            points[i].y = wrong;
        }
        for reorder in [false, true] {
            let found = signed.contains_each(&points, &BatchOptions::default().with_reorder(reorder));
            assert!(points.iter().zip(&found).all(|(point, found)| signed.contains(point) == *found), "{wrong}");
            assert!(found.iter().filter(|inside| **inside).count() > 1000);
        }
    }
    let open = Soup::from_triangles(ball.positions().to_vec(), ball.triangles()[1..].to_vec()).expect("valid");
    let open = SignedDistance::new(tree(&open), &open).expect("triangles");
    let closest = open.closest_point(&[0.0; 3]).expect("not empty").closest;
    assert_eq!(open.with_sign(&Point3::new(f64::NAN, 0.0, 0.0), closest).sign, Sign::Outside);
}

#[test]
fn every_backend_has_the_same_signs() {
    let soup = torus_knot(&TorusKnot { rings: 60, sides: 8, ..Default::default() }).expect("valid");
    let aabb = SignedDistance::new(tree(&soup), &soup).expect("closed");
    let octree = OctreeIndex::new(&soup).expect("valid");
    let octree = SignedDistance::new(octree, &soup).expect("closed");
    let p2m = P2mIndex::new(&soup).expect("valid");
    let p2m = SignedDistance::new(p2m, &soup).expect("closed");
    for query in QuerySet::Box1.generate_for_cases(&soup, &cases(1000, 100), 5) {
        let known = |c: Option<p2m_field::sign::Signed>| c.map(|c| (c.distance(), c.sign, c.closest.primitive));
        let expected = known(aabb.closest_point(&query));
        assert_eq!(known(octree.closest_point(&query)), expected);
        assert_eq!(known(p2m.closest_point(&query)), expected);
    }
}

/// Checks that distances of a mesh with its vertices on a surface are those of the surface, up to the distance
/// between the two.
fn is_near_analytic(name: &str, soup: &Soup<f64>, error: f64, analytic: impl Fn(&Point3<f64>) -> f64) {
    let signed = SignedDistance::new(tree(soup), soup).expect("closed");
    let parity = SignedDistance::with_rule(tree(soup), soup, SignRule::Parity).expect("triangles");
    for query in QuerySet::Box1.generate_for_cases(soup, &cases(2000, 60), 11) {
        let expected = analytic(&query);
        let found = signed.closest_point(&query).and_then(|s| s.distance()).expect("defined");
        assert!((found - expected).abs() <= error, "{name}, {query}: {found} for {expected}");
        let by_parity = parity.closest_point(&query).and_then(|s| s.distance());
        assert_eq!(by_parity, Some(found), "{name}, {query}");
    }
}

#[test]
fn distances_are_those_of_a_sphere_a_box_and_a_torus() {
    let ball = ico_sphere(&IcoSphere { frequency: 24 }).expect("valid");
    // The error is the largest height of the sphere above a face.
    let height = ball.triangles().iter().map(|t| {
        let sum: Vector3<f64> = t.iter().map(|i| ball.positions()[*i as usize].coords).sum();
        1.0 - (sum / 3.0).norm()
    });
    let sag = height.fold(0.0, f64::max);
    assert!(sag > 1e-4 && sag < 2e-3, "{sag}");
    is_near_analytic("sphere", &ball, 1.5 * sag, |q| q.coords.norm() - 1.0);

    let block = cube([-1.0, -2.0, -3.0], [1.0, 2.0, 3.0]);
    is_near_analytic("box", &block, 1e-14, |q| {
        let beyond = q.coords.abs() - Vector3::new(1.0, 2.0, 3.0);
        beyond.map(|x| x.max(0.0)).norm() + beyond.max().min(0.0)
    });

    let (around, across) = amount((192, 96), (96, 48));
    let turn = |i: u32, n: u32| (f64::from(i % n) / f64::from(n) * std::f64::consts::TAU).sin_cos();
    let places = (0..around * across).map(|i| {
        let ((s, c), (v, u)) = (turn(i / across, around), turn(i % across, across));
        Point3::new((2.0 + u) * c, (2.0 + u) * s, v)
    });
    let number = |i: u32, k: u32| (i % around) * across + k % across;
    let triangles = (0..around * across).flat_map(|i| {
        let (i, k) = (i / across, i % across);
        let [a, b, c, d] = [number(i, k), number(i + 1, k), number(i + 1, k + 1), number(i, k + 1)];
        [[a, b, c], [a, c, d]]
    });
    let torus = Soup::from_triangles(places.collect(), triangles.collect()).expect("valid");
    // A chord of half angle h is off its arc by r (1 - cos h), both for the tube and for the widest circle; the errors
    // add up.
    let off = |r: f64, n: u32| r * (1.0 - (std::f64::consts::PI / f64::from(n)).cos());
    is_near_analytic("torus", &torus, off(1.0, across) + off(3.0, around), |q| {
        let from_circle = q.x.hypot(q.y) - 2.0;
        from_circle.hypot(q.z) - 1.0
    });
}

#[test]
fn winding_numbers_are_within_their_bound() {
    let options = TorusKnot::default();
    let options = amount(options, TorusKnot { rings: 60, sides: 8, ..options });
    let knot = torus_knot(&options).expect("valid");
    let half_cube: Vec<[u32; 3]> =
        knot.triangles().iter().enumerate().filter(|(i, _)| i % 3 != 0).map(|(_, t)| *t).collect();
    let holes = Soup::from_triangles(knot.positions().to_vec(), half_cube).expect("valid");
    let mut random = rng("winding numbers", 0);
    let loose_ones = amount(2000, 500);
    let loose: Vec<Point3<f64>> =
        (0..3 * loose_ones).map(|_| Point3::from([0; 3].map(|_| random.random_range(-1.0..1.0)))).collect();
    let loose =
        Soup::from_triangles(loose, (0..loose_ones).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect()).expect("valid");
    let far = Transform::default().scaled(1e-3).translated([1e4, -3e4, 2e4]).apply(&knot).expect("valid");
    let tiny = Transform::default().scaled(1e-140).apply(&knot).expect("valid");
    let huge = Transform::default().scaled(1e140).apply(&knot).expect("valid");
    // A position that no primitive uses does not affect the scale.
    let mut unused = cube([-1.0; 3], [1.0; 3]);
    unused.push_position(Point3::new(1e200, 0.0, 0.0));
    let winding = WindingNumbers::new(&unused).expect("triangles");
    assert!(winding.number(&Point3::origin(), 0.01) == 1.0);
    for far in [1e30, 1e160, 1e200, 1e300] {
        assert!(winding.number(&Point3::new(far, -far, 0.0), 0.01) == 0.0, "{far}");
    }
    let cases = cases(300, 6);
    let scenes = [("knot", knot), ("holes", holes), ("loose", loose), ("far", far), ("tiny", tiny), ("huge", huge)];
    for (name, soup) in &scenes {
        for accuracy in [0.2, 0.01, 1e-4] {
            let winding = WindingNumbers::new(soup).expect("triangles");
            let mut worst = 0.0f64;
            for set in [QuerySet::Box1, QuerySet::Near, QuerySet::Box10] {
                for query in set.generate_for_cases(soup, &cases, 7) {
                    let (found, exact) = (winding.number(&query, accuracy), winding.sum(&query));
                    worst = worst.max((found - exact).abs());
                }
            }
            assert!(worst <= accuracy + 1e-9, "{name}: {worst} for {accuracy}");
            println!("{name}, {accuracy}: at most {worst:.1e}");
        }
    }
}

#[test]
fn in_the_middle_of_a_hole_there_is_no_sign() {
    // The half of a cube is cut at x = 0 and open there, so its winding number is a half on that plane.
    let half_cube = cube([-1.0; 3], [1.0; 3]);
    let open: Vec<[u32; 3]> = half_cube
        .triangles()
        .iter()
        .filter(|t| !t.iter().all(|i| half_cube.positions()[*i as usize].x == 1.0))
        .copied()
        .collect();
    let positions = half_cube.positions().iter().map(|p| Point3::new(p.x.min(0.0), p.y, p.z)).collect();
    let half_cube = Soup::from_triangles(positions, open).expect("valid");
    let winding = SignedDistance::new(tree(&half_cube), &half_cube).expect("triangles");
    let at = |x: f64| winding.closest_point(&Point3::new(x, 0.1, 0.2)).expect("not empty");
    let number = WindingNumbers::new(&half_cube).expect("triangles").sum(&Point3::new(0.0, 0.1, 0.2));
    // Seen from the plane of the cut, half a cube covers half of all directions.
    assert!((number - 0.5).abs() < 1e-12, "{number}");
    // That is so beside the rim as well, where rounding errors are large.
    for case in 0..2000 {
        let mut rng = rng("rim", case);
        let beside = 1.0 - f64::from(rng.random_range(1..9u8)) * 2f64.powi(-rng.random_range(40..54));
        let query = Point3::new(0.0, rng.random_range(-0.9..0.9), beside);
        let sign = winding.closest_point(&query).expect("not empty").sign;
        assert!(matches!(sign, Sign::Undefined | Sign::Boundary), "{query:?}: {sign}");
    }
    assert_eq!((at(0.0).sign, at(0.0).distance()), (Sign::Undefined, None));
    assert_eq!((at(-0.1).sign, at(0.1).sign), (Sign::Inside, Sign::Outside));
}

#[test]
fn distances_of_neighbours_are_those_of_single_answers() {
    let knot = torus_knot(&TorusKnot::default()).unwrap();
    // Two balls, one in the other, and one that lacks triangles.
    let ball = ico_sphere(&IcoSphere { frequency: 8 }).unwrap();
    let mut small = ball.clone();
    small.map_positions(|point| point * 0.9).unwrap();
    let shells = joined(&[ball.clone(), flipped(&small)]);
    let open = Soup::from_triangles(ball.positions().to_vec(), ball.triangles()[9..].to_vec()).unwrap();
    let count = amount(200_000, 20_000);
    for (name, soup) in [("knot", &knot), ("shells", &shells), ("open", &open)] {
        let signed = SignedDistance::new(tree(soup), soup).unwrap();
        let sampler = p2m_field::sample::SurfaceSampler::new(soup).unwrap();
        let mut queries = sampler.near(1, count, &[0.0, 0.003, 0.03, 0.3]).points;
        queries.extend(p2m_field::sample::in_box(&PrimitiveSet::aabb(soup), 1, count));
        queries.extend(soup.positions());
        queries.push(Point3::new(f64::NAN, 0.0, 0.0));
        let (options, batch) = (Default::default(), BatchOptions::default());
        let answers = signed.closest_points(&queries, &options, &batch);
        let rays = signed.ambiguous_count();
        let mut found = vec![0.0; queries.len()];
        let fresh = SignedDistance::new(tree(soup), soup).unwrap();
        fresh.distances_into(fresh.index(), &queries, &options, &batch, &mut found);
        for ((query, answer), found) in queries.iter().zip(&answers).zip(&found) {
            let expected = answer.as_ref().map_or(f64::INFINITY, |answer| answer.distance().unwrap_or(f64::NAN));
            assert!(expected.to_bits() == found.to_bits() || expected.is_nan() && found.is_nan(), "{name}: {query}");
        }
        // Both signs occur.
        assert!(found.iter().any(|x| *x < 0.0) && found.iter().any(|x| *x > 0.0 && x.is_finite()), "{name}");
        println!("{name}: {rays} signs by rays, {} with neighbours", fresh.ambiguous_count());
    }
}
