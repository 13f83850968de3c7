use super::fit::Fit;
use super::pose::Pose;
use super::search::rotations;
use super::*;
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use p2m_bvh::AabbTree;
use p2m_core::{BruteForce, Element, Soup};
use p2m_mixed::generate::{IcoSphere, ico_sphere};
use p2m_testkit::{normal_number, rng};
use rand::RngExt;

const GO_ON: fn(&AlignRound) -> ControlFlow<()> = |_| ControlFlow::Continue(());

/// Returns boxes, each given by two opposite corners, as triangles.
fn boxes(boxes: &[[[f64; 3]; 2]]) -> Soup<f64> {
    const FACES: [[u32; 4]; 6] = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for corners in boxes {
        let first = u32::try_from(positions.len()).unwrap();
        positions.extend((0..8).map(|k| Point3::from(std::array::from_fn(|axis| corners[k >> axis & 1][axis]))));
        for [a, b, c, d] in FACES.map(|face| face.map(|corner| corner + first)) {
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    Soup::from_triangles(positions, triangles).unwrap()
}

/// A part without symmetries.
fn bracket() -> Soup<f64> {
    boxes(&[[[0.0; 3], [6.0, 4.0, 1.0]], [[0.0, 0.0, 1.0], [1.0, 2.0, 5.0]], [[4.0, 3.0, 1.0], [6.0, 3.5, 2.0]]])
}

/// Returns points of the triangles of a scene, uniformly distributed by area, with noise in each coordinate.
fn noisy_points(soup: &Soup<f64>, count: usize, sigma: f64) -> Vec<Point3<f64>> {
    let mut rng = rng("align", 1);
    let mut total = 0.0;
    let triangles: Vec<_> = soup.triangles().iter().map(|t| t.map(|i| soup.positions()[i as usize])).collect();
    let area = |[a, b, c]: &[Point3<f64>; 3]| (b - a).cross(&(c - a)).norm();
    let sums: Vec<f64> = triangles
        .iter()
        .map(|t| {
            total += area(t);
            total
        })
        .collect();
    let mut point = || {
        let x = rng.random_range(0.0..total);
        let [a, b, c] = triangles[sums.partition_point(|sum| *sum < x)];
        let (u, v): (f64, f64) = (rng.random_range(0.0..1.0), rng.random_range(0.0..1.0));
        let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
        a + (b - a) * u + (c - a) * v + Vector3::from_fn(|_, _| sigma * normal_number(&mut rng))
    };
    (0..count).map(|_| point()).collect()
}

fn moved(points: &[Point3<f64>], motion: &Isometry3<f64>) -> Vec<Point3<f64>> {
    points.iter().map(|point| motion * point).collect()
}

/// Returns the largest distance of an aligned point from where it was before the motion.
fn error(found: &Alignment, scan: &[Point3<f64>], points: &[Point3<f64>]) -> f64 {
    scan.iter().zip(points).map(|(x, y)| (found.apply(x) - y).norm()).fold(0.0, f64::max)
}

fn aligned(soup: &Soup<f64>, scan: &[Point3<f64>], options: &AlignOptions) -> Alignment {
    align(soup, &AabbTree::new(soup).unwrap(), scan, options, &mut { GO_ON }).unwrap()
}

#[test]
fn every_rotation_is_near_one_of_the_sixty() {
    let rotations = rotations();
    assert_eq!(rotations.len(), 60);
    let mut rng = rng("rotations", 0);
    let mut largest: f64 = 0.0;
    for _ in 0..20_000 {
        let parts = nalgebra::Vector4::from_fn(|_, _| normal_number(&mut rng));
        let any = UnitQuaternion::new_normalize(parts.into());
        let angle = rotations.iter().map(|rotation| any.angle_to(rotation)).fold(f64::INFINITY, f64::min);
        largest = largest.max(angle.to_degrees());
    }
    assert!((40.0..45.0).contains(&largest), "{largest}");
}

#[test]
fn noisy_points_return_from_any_start_with_the_same_bits() {
    let part = bracket();
    let sigma = 0.005;
    let points = noisy_points(&part, 20_000, sigma);
    let tree = AabbTree::<f64, _>::new(&part).unwrap();
    for (angle, axis) in [(20.0f64, Vector3::x_axis()), (75.0, Vector3::y_axis()), (170.0, Vector3::z_axis())] {
        let turn = UnitQuaternion::from_axis_angle(&axis, angle.to_radians());
        let scan = moved(&points, &Isometry3::from_parts(Translation3::new(3.0, -4.0, 5.0), turn));
        let found = align(&part, &tree, &scan, &AlignOptions::default(), &mut { GO_ON }).unwrap();
        assert!(found.is_converged && found.ambiguity.is_none() && found.coverage > 0.99, "{found:?}");
        // The pose is as exact as so many points allow, and the rest is the noise in one direction.
        assert!(error(&found, &scan, &points) < 20.0 * sigma / (points.len() as f64).sqrt(), "{angle}");
        assert!((found.rms / sigma - 1.0).abs() < 0.03, "{found:?}");
        for (x, y) in scan.iter().zip(&points).step_by(1000) {
            assert!((found.matrix.transform_point(x) - found.apply(x)).norm() < 1e-13 && (x - y).norm() > 1.0);
        }
        let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap();
        let brute = BruteForce::new(&part).unwrap();
        let threaded = pool.install(|| align(&part, &brute, &scan, &AlignOptions::default(), &mut { GO_ON }).unwrap());
        assert_eq!(threaded, found);
    }
}

#[test]
fn exact_points_far_from_the_origin_return_exactly() {
    let far = Vector3::new(3e6, -5e6, 1e5);
    let mut part = bracket();
    part.map_positions(|point| point + far).unwrap();
    let points = noisy_points(&part, 3000, 0.0);
    let pivot = Translation3::from(far + Vector3::new(1.0, 2.0, 3.0));
    let turn = UnitQuaternion::from_euler_angles(0.1, -0.2, 0.3);
    let motion = pivot * turn * pivot.inverse();
    let scan = moved(&points, &motion);
    let found = aligned(&part, &scan, &AlignOptions::default());
    assert!(found.is_converged, "{found:?}");
    // Coordinates have steps of 1e-9.
    assert!(error(&found, &scan, &points) < 2e-8, "{}", error(&found, &scan, &points));
}

#[test]
fn scenes_of_segments_and_points_have_distances_of_points() {
    let mut rng = rng("align", 2);
    let mut at = || Point3::from(std::array::from_fn(|_| rng.random_range(0.0..10.0)));
    let cloud: Vec<_> = (0..400).map(|_| at()).collect();
    let motion = Isometry3::new(Vector3::new(0.5, 0.1, -0.2), Vector3::new(0.05, -0.1, 0.08));
    let scan = moved(&cloud, &motion);
    let points = Soup::new(cloud.clone(), (0..400).map(Element::Point)).unwrap();
    let path = Soup::new(cloud.clone(), (0..399).map(|i| Element::Segment([i, i + 1]))).unwrap();
    for scene in [points, path] {
        let found = aligned(&scene, &scan, &AlignOptions::default());
        assert!(found.is_converged && found.ambiguity.is_none() && error(&found, &scan, &cloud) < 1e-6, "{found:?}");
    }
    // On triangles both residuals lead to the same pose.
    let part = bracket();
    let points = noisy_points(&part, 2000, 0.0);
    let scan = moved(&points, &motion);
    let found = aligned(&part, &scan, &AlignOptions::default().with_point_to_point(true));
    assert!(error(&found, &scan, &points) < 0.01, "{}", error(&found, &scan, &points));
    assert!(found.rounds.len() > aligned(&part, &scan, &AlignOptions::default()).rounds.len());
}

#[test]
fn a_plate_does_not_slide() {
    // Its narrow sides are 1 % of its surface, and its faces fit from the start.
    let plate = boxes(&[[[0.0; 3], [100.0, 60.0, 0.5]]]);
    let points = noisy_points(&plate, 50_000, 0.01);
    let scan = moved(&points, &Isometry3::new(Vector3::new(3.0, -2.0, 0.0), Vector3::new(0.0, 0.0, 0.02)));
    let found = aligned(&plate, &scan, &AlignOptions::default().with_search(false));
    assert!(found.is_converged && error(&found, &scan, &points) < 0.01, "{}", error(&found, &scan, &points));
}

#[test]
fn steps_in_noise_go_all_the_way() {
    // Weights change with a step. If they were fixed, each step would leave a sixth of the way.
    let side = 100.0;
    let corners = [[0.0, 0.0], [side, 0.0], [0.0, side], [side, side]].map(|[x, y]| Point3::new(x, y, 0.0));
    let plane = Soup::from_triangles(corners.to_vec(), vec![[0, 1, 2], [1, 3, 2]]).unwrap();
    let index = BruteForce::new(&plane).unwrap();
    let sigma = 0.01;
    let points = noisy_points(&plane, 20_000, sigma);
    let shift = Isometry3::translation(0.0, 0.0, 0.3 * sigma);
    let centre = Translation3::new(side / 2.0, side / 2.0, 0.0);
    let tilt = centre * UnitQuaternion::from_scaled_axis(Vector3::x() * (0.3 * sigma / 30.0)) * centre.inverse();
    for motion in [shift, tilt] {
        let scan = moved(&points, &motion);
        let fit = Fit::new(&plane, &index, &scan, &AlignOptions::default()).unwrap();
        // The limit of distances follows from the noise from the start.
        let start = Pose { limit: 0.0, ..Pose::identity(fit.centre) };
        let first = fit.round(&scan, &[start]).remove(0);
        let end = (0..12).fold(first.next, |pose, _| fit.round(&scan, &[pose]).remove(0).next);
        // The plane determines motions along its normal only.
        let heights = |pose: &Pose| corners.map(|corner| pose.apply(&(motion * corner)).z);
        let to_end =
            |pose: &Pose| heights(pose).into_iter().zip(heights(&end)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let left = to_end(&first.next) / to_end(&start);
        assert!(first.is_settled && left < 0.08, "{left}");
    }
}

#[test]
fn a_scale_is_found_if_it_is_asked_for() {
    let part = bracket();
    let points = noisy_points(&part, 5000, 0.001);
    let motion = Isometry3::new(Vector3::new(30.0, 10.0, -20.0), Vector3::new(0.2, -0.4, 0.3));
    // Inches instead of millimetres.
    let scan: Vec<_> = points.iter().map(|point| motion * (point / 25.4)).collect();
    let found = aligned(&part, &scan, &AlignOptions::default().with_scale(true));
    assert!((found.scale / 25.4 - 1.0).abs() < 1e-4 && error(&found, &scan, &points) < 0.002, "{found:?}");
    assert_eq!(aligned(&part, &scan, &AlignOptions::default()).scale, 1.0);
}

#[test]
fn outliers_and_what_is_beyond_the_part_have_no_weight() {
    let part = bracket();
    let points = noisy_points(&part, 5000, 0.002);
    let motion = Isometry3::new(Vector3::new(0.3, -0.2, 0.1), Vector3::new(0.05, 0.1, -0.08));
    let mut scan = moved(&points, &motion);
    let mut rng = rng("align", 3);
    scan.extend((0..1000).map(|_| Point3::from(std::array::from_fn(|_| rng.random_range(-5.0..9.0)))));
    scan.push(Point3::new(f64::NAN, 0.0, 0.0));
    let found = aligned(&part, &scan, &AlignOptions::default());
    assert!(error(&found, &scan[..5000], &points) < 0.002, "{found:?}");
    assert!((0.82..0.88).contains(&found.coverage), "{}", found.coverage);
    // Two thirds of the scan are a table beside the part, which only an overlap makes harmless.
    let table = (0..10_000).map(|_| Point3::new(rng.random_range(-9.0..9.0), rng.random_range(-9.0..9.0), -1.0));
    let scan: Vec<_> = moved(&points, &motion).into_iter().chain(table).collect();
    let options = AlignOptions::default().with_search(false);
    let of_part = |found: &Alignment| error(found, &scan[..5000], &points);
    assert!(of_part(&aligned(&part, &scan, &options)) > 0.1);
    assert!(of_part(&aligned(&part, &scan, &options.with_overlap(0.3))) < 0.01);
}

#[test]
fn symmetric_parts_are_ambiguous() {
    let ball = ico_sphere(&IcoSphere { frequency: 24 }).unwrap();
    let found = aligned(&ball, &noisy_points(&ball, 3000, 0.001), &AlignOptions::default());
    assert!(matches!(found.ambiguity, Some(Ambiguity::Sliding { eigenvalue }) if eigenvalue < 0.003), "{found:?}");
    let cuboid = boxes(&[[[0.0; 3], [3.0, 2.0, 1.0]]]);
    let points = noisy_points(&cuboid, 3000, 0.001);
    let motion = Isometry3::new(Vector3::new(0.3, -0.2, 0.1), Vector3::new(0.1, 0.3, -0.2));
    let scan = moved(&points, &motion);
    let found = aligned(&cuboid, &scan, &AlignOptions::default());
    // Of poses that fit equally well it is the one near the start.
    assert!(error(&found, &scan, &points) < 0.001, "{found:?}");
    let Some(Ambiguity::OtherPose { matrix }) = found.ambiguity else { panic!("{found:?}") };
    let other: Vec<_> = scan.iter().map(|point| matrix.transform_point(point)).collect();
    let rms = aligned(&cuboid, &other, &AlignOptions::default().with_search(false)).rounds[0].rms;
    assert!(rms < 1.2 * found.rms && (other[0] - found.apply(&scan[0])).norm() > 0.1, "{rms}");
}

#[test]
fn an_alignment_can_be_ended_and_be_refused() {
    let part = bracket();
    let tree = AabbTree::<f64, _>::new(&part).unwrap();
    let points = noisy_points(&part, 2000, 0.01);
    let mut rounds = 0;
    let mut stop = |_: &AlignRound| {
        rounds += 1;
        if rounds == 2 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let options = AlignOptions::default().with_search(false);
    let found = align(&part, &tree, &points, &options, &mut stop).unwrap();
    assert_eq!((found.is_converged, found.rounds.len()), (false, 2));
    let refused = |points: &[Point3<f64>], overlap| {
        align(&part, &tree, points, &options.with_overlap(overlap), &mut { GO_ON }).unwrap_err()
    };
    assert_eq!(refused(&points[..5], 1.0), AlignError::TooFewPoints { count: 5 });
    assert_eq!(refused(&[points[0]; 9], 1.0), AlignError::OnePoint);
    assert_eq!(refused(&points, 0.0), AlignError::Overlap { overlap: 0.0 });
    let far = points.iter().map(|point| point * 1e200).collect::<Vec<_>>();
    assert_eq!(refused(&far, 1.0), AlignError::OnePoint);
    let dot = Soup::new(vec![points[0]], [Element::Point(0)]).unwrap();
    let scaled = |scene: &Soup<f64>| {
        let index = BruteForce::new(scene).unwrap();
        align(scene, &index, &points, &AlignOptions::default().with_scale(true), &mut { GO_ON }).unwrap_err()
    };
    let mut huge = bracket();
    huge.map_positions(|point| point * 1e160).unwrap();
    assert_eq!([scaled(&dot), scaled(&huge)], [AlignError::NoSize; 2]);
    let empty = Soup::<f64>::default();
    let found = align(&empty, &BruteForce::new(&empty).unwrap(), &points, &options, &mut { GO_ON });
    assert_eq!(found.unwrap_err(), AlignError::EmptyScene);
}
