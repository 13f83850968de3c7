//! Functions that change scenes: gaps and crossings are checked by predicates with error bounds, subdivision keeps
//! meshes closed, and transforms are exact where they have to be.

use crate::generator_support::{assert_not_degenerate, assert_watertight, below, checksum, corners, orient2d, volume};
use nalgebra::{Point3, Vector3};
use p2m_core::{BuildError, Element, PrimitiveSet, Soup};
use p2m_mixed::generate::{
    CableBundle, Cylinder, GenerateError, IcoSphere, Kind, KnotAndCables, MixedSizes, SkewedGear, Sphere, Subdivide,
    TorusKnot, Transform, cable_bundle, cylinder, gapped, ico_sphere, knot_and_cables, mixed_sizes, penetrating,
    skewed_gear, sphere, subdivide, torus_knot,
};
use std::collections::HashMap;

fn ball(frequency: u32) -> Soup<f64> {
    ico_sphere(&IcoSphere { frequency }).unwrap()
}

fn vertices(soup: &Soup<f64>, element: &Element) -> Vec<Point3<f64>> {
    element.indices().iter().map(|&i| soup.positions()[i as usize]).collect()
}

/// Returns the bits of the corners of each triangle and segment, in an order that does not depend on the soup.
fn geometry(soup: &Soup<f64>) -> Vec<Vec<[u64; 3]>> {
    let digits = |p: Point3<f64>| [p.x, p.y, p.z].map(f64::to_bits);
    let mut all: Vec<Vec<_>> = soup.elements().map(|e| vertices(soup, &e).into_iter().map(digits).collect()).collect();
    all.sort_unstable();
    all
}

/// Returns the primitives of a scene with vertices of their own.
fn torn(soup: &Soup<f64>) -> Soup<f64> {
    let mut positions = Vec::new();
    let mut elements = Vec::new();
    for element in soup.elements() {
        let first = positions.len() as u32;
        positions.extend(vertices(soup, &element));
        elements.push(match element {
            Element::Point(_) => Element::Point(first),
            Element::Segment(_) => Element::Segment([first, first + 1]),
            Element::Triangle(_) => Element::Triangle([first, first + 1, first + 2]),
        });
    }
    Soup::new(positions, elements).unwrap()
}

#[test]
fn each_change_is_the_same_as_ever() {
    let scene =
        knot_and_cables(&KnotAndCables { rings: 20, sides: 5, cable_segments: 7, ..Default::default() }).unwrap();
    let options = Subdivide { levels: 2, amplitude: 0.2, ..Default::default() };
    let turned = Transform::default().rotated_x(45.0).rotated_y(45.0).rotated_z(-100.0).scaled(0.3);
    let checksums = [
        ("gapped", checksum(&gapped(&scene, 0.8).unwrap())),
        ("penetrating", checksum(&penetrating(&scene, 2.0).unwrap())),
        ("subdivided", checksum(&subdivide(&scene, &options).unwrap())),
        ("turned", checksum(&turned.translated([9e4, 4e5, -1.0]).apply(&scene).unwrap())),
    ];
    let expected = [
        ("gapped", 0x281a_2c64_eaca_cd45),
        ("penetrating", 0xf672_02fd_1e62_fcd0),
        ("subdivided", 0xa389_99b8_fd0c_feef),
        ("turned", 0x6e2a_0c93_2ddb_c771),
    ];
    assert_eq!(checksums, expected, "{checksums:#x?}");
}

#[test]
fn every_kind_has_vertices_of_its_own_once_it_is_torn() {
    for kind in Kind::all() {
        let scene = kind.generate().unwrap();
        for soup in [gapped(&scene, 0.9).unwrap(), penetrating(&scene, 1.5).unwrap()] {
            assert_eq!(soup.len(), scene.len());
            let used: Vec<u32> = soup.elements().flat_map(|e| e.indices().to_vec()).collect();
            assert!(used.iter().copied().eq(0..soup.positions().len() as u32), "{}: each once", kind.name());
            let same_kind = |(a, b): (Element, Element)| a.indices().len() == b.indices().len();
            assert!(scene.elements().zip(soup.elements()).all(same_kind), "{}: in the same order", kind.name());
        }
    }
}

#[test]
fn sizes_are_scaled_about_centroids() {
    let at = |x: f64, y: f64, z: f64| Point3::new(x, y, z);
    let positions = vec![at(0.0, 0.0, 0.0), at(6.0, 0.0, 0.0), at(0.0, 3.0, 9.0)];
    let elements = [Element::Segment([0, 1]), Element::Point(1), Element::Triangle([2, 0, 1])];
    let scene = Soup::new(positions, elements).unwrap();
    let expected = [at(1.5, 0.0, 0.0), at(4.5, 0.0, 0.0), at(6.0, 0.0, 0.0)];
    let triangle = [at(1.0, 2.0, 6.0), at(1.0, 0.5, 1.5), at(4.0, 0.5, 1.5)];
    assert_eq!(gapped(&scene, 0.5).unwrap().positions(), [expected, triangle].concat());
    let expected = [at(-3.0, 0.0, 0.0), at(9.0, 0.0, 0.0), at(6.0, 0.0, 0.0)];
    let triangle = [at(-2.0, 5.0, 15.0), at(-2.0, -1.0, -3.0), at(10.0, -1.0, -3.0)];
    assert_eq!(penetrating(&scene, 2.0).unwrap().positions(), [expected, triangle].concat());
}

/// Returns whether all corners of `other` are certainly below the plane of `triangle`.
fn is_below(triangle: &[Point3<f64>; 3], other: &[Point3<f64>; 3]) -> bool {
    let [a, b, c] = triangle;
    other.iter().all(|p| below(a, b, c, p) == Some(true))
}

#[test]
fn gapped_triangles_of_a_convex_mesh_are_apart() {
    let meshes = [ball(4), sphere(&Sphere { meridians: 12, bands: 9 }).unwrap()];
    for mesh in meshes {
        let touching = |soup: &Soup<f64>| {
            let all: Vec<_> = soup.triangles().iter().map(|&t| corners(soup, t)).collect();
            let pairs = (0..all.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
            pairs.filter(|&(i, j)| !is_below(&all[i], &all[j]) && !separated_in_space(&all[i], &all[j])).count()
        };
        assert_eq!(touching(&gapped(&mesh, 0.95).unwrap()), 0);
        assert!(touching(&mesh) > 0, "triangles that share vertices are not apart");
    }
}

/// Returns whether a plane through an edge of one triangle and perpendicular to it certainly separates both triangles.
/// This is needed for the halves of a planar quadrilateral.
fn separated_in_space(s: &[Point3<f64>; 3], t: &[Point3<f64>; 3]) -> bool {
    [(s, t), (t, s)].iter().any(|(s, t)| {
        let away = (s[1] - s[0]).cross(&(s[2] - s[0]));
        (0..3).any(|i| {
            let (a, b) = (s[i], s[(i + 1) % 3]);
            let c = a + away;
            let own = below(&a, &b, &c, &s[(i + 2) % 3]);
            own.is_some() && t.iter().all(|p| below(&a, &b, &c, p) == own.map(|side| !side))
        })
    })
}

#[test]
fn gapped_triangles_of_a_planar_mesh_are_apart() {
    let can = cylinder(&Cylinder { sides: 12, bands: 1, cap_bands: 4 }).unwrap();
    let lid = |soup: &Soup<f64>| -> Vec<[[f64; 2]; 3]> {
        let all = soup.triangles().iter().map(|&t| corners(soup, t));
        all.filter(|t| t.iter().all(|p| p.z == 1.0)).map(|t| t.map(|p| [p.x, p.y])).collect()
    };
    let touching = |lid: &[[[f64; 2]; 3]]| {
        let pairs = (0..lid.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
        pairs.filter(|&(i, j)| !separated_in_plane(&lid[i], &lid[j])).count()
    };
    let gaps = lid(&gapped(&can, 0.95).unwrap());
    assert_eq!((gaps.len(), touching(&gaps)), (12 * 7, 0));
    assert!(touching(&lid(&can)) >= 12 * 7, "without gaps, neighbours touch");
}

/// Returns whether one triangle is certainly beyond an edge of the other. Both are counter-clockwise.
fn separated_in_plane(s: &[[f64; 2]; 3], t: &[[f64; 2]; 3]) -> bool {
    let beyond = |s: &[[f64; 2]; 3], t: &[[f64; 2]; 3]| {
        (0..3).any(|i| t.iter().all(|&p| orient2d(s[i], s[(i + 1) % 3], p) == Some(false)))
    };
    beyond(s, t) || beyond(t, s)
}

/// Returns whether a median of one triangle certainly passes through the inside of the other, away from its edges.
///
/// Edges are not sufficient, because the edges of two mirrored triangles intersect where the triangles cross.
fn cross(s: &[Point3<f64>; 3], t: &[Point3<f64>; 3]) -> bool {
    [(s, t), (t, s)].iter().any(|(s, [a, b, c])| {
        (0..3).any(|i| {
            let (p, q) = (s[i], nalgebra::center(&s[(i + 1) % 3], &s[(i + 2) % 3]));
            let ends = (below(a, b, c, &p), below(a, b, c, &q));
            let around = [below(&p, &q, a, b), below(&p, &q, b, c), below(&p, &q, c, a)];
            matches!(ends, (Some(x), Some(y)) if x != y) && (around == [Some(true); 3] || around == [Some(false); 3])
        })
    })
}

/// Returns the pairs of triangles that share an edge.
fn neighbours(mesh: &Soup<f64>) -> Vec<[usize; 2]> {
    let mut first = HashMap::new();
    let mut pairs = Vec::new();
    for (i, &[a, b, c]) in mesh.triangles().iter().enumerate() {
        for [a, b] in [[a, b], [b, c], [c, a]] {
            match first.remove(&[b, a]) {
                Some(other) => pairs.push([other, i]),
                None => assert!(first.insert([a, b], i).is_none()),
            }
        }
    }
    assert!(first.is_empty());
    pairs
}

#[test]
fn penetrating_triangles_cross_all_their_neighbours() {
    let mesh = ball(5);
    let pairs = neighbours(&mesh);
    assert_eq!(pairs.len(), 750);
    let crossing = |soup: &Soup<f64>| {
        let at = |i: usize| corners(soup, soup.triangles()[i]);
        pairs.iter().filter(|[i, j]| cross(&at(*i), &at(*j))).count()
    };
    assert_eq!(crossing(&penetrating(&mesh, 2.0).unwrap()), pairs.len());
    assert_eq!(crossing(&torn(&mesh)), 0, "they touch, but do not cross");

    // Where a mesh is nearly planar, the predicates are not certain for all pairs.
    let mesh = torus_knot(&TorusKnot { rings: 60, sides: 8, ..Default::default() }).unwrap();
    let pairs = neighbours(&mesh);
    let soup = penetrating(&mesh, 2.0).unwrap();
    let at = |i: usize| corners(&soup, soup.triangles()[i]);
    let crossing = pairs.iter().filter(|[i, j]| cross(&at(*i), &at(*j))).count();
    assert!(10 * crossing > 9 * pairs.len(), "{crossing} of {}", pairs.len());
}

#[test]
fn factors_out_of_range_are_errors() {
    let scene = ball(1);
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, 1.0] {
        let refused = |result| matches!(result, Err(GenerateError::OutOfRange { option: "factor", .. }));
        assert!(refused(gapped(&scene, bad)) && refused(penetrating(&scene, bad)), "{bad}");
    }
    assert!(gapped(&scene, 1.5).is_err() && penetrating(&scene, 0.5).is_err());
    let huge = Transform::default().scaled(1.7e308).apply(&scene).unwrap();
    assert!(matches!(penetrating(&huge, 2.0), Err(GenerateError::Build(BuildError::NonFinite { .. }))));
}

#[test]
fn subdivision_keeps_meshes_closed() {
    let meshes = [
        (ball(2), 2),
        (torus_knot(&TorusKnot { rings: 30, sides: 5, ..Default::default() }).unwrap(), 0),
        (skewed_gear(&SkewedGear { points: 4, ..Default::default() }).unwrap(), 0),
    ];
    for (mesh, characteristic) in meshes {
        for (levels, amplitude) in [(0, 0.3), (1, 0.0), (2, 0.1), (p2m_testkit::amount(4, 3), 0.05)] {
            let options = Subdivide { levels, amplitude, ..Default::default() };
            let fine = subdivide(&mesh, &options).unwrap();
            assert_eq!(fine.triangles().len(), mesh.triangles().len() << (2 * levels));
            assert_eq!(assert_watertight(&fine), characteristic);
            assert_not_degenerate(&fine);
            let relative = volume(&fine) / volume(&mesh) - 1.0;
            if amplitude == 0.0 {
                assert!(relative.abs() < 1e4 * f64::EPSILON, "{relative}");
            } else {
                assert!(relative.abs() < 0.5, "{relative}");
            }
            assert_eq!(&fine.positions()[..mesh.positions().len()], mesh.positions(), "old vertices stay");
        }
    }
}

#[test]
fn parts_follow_their_primitive_and_share_what_it_shares() {
    let at = |x: f64, y: f64| Point3::new(x, y, 0.0);
    let positions = vec![at(0.0, 0.0), at(4.0, 0.0), at(0.0, 4.0), at(9.0, f64::NAN)];
    let elements = [Element::Segment([2, 1]), Element::Point(1), Element::Triangle([0, 1, 2])];
    let scene = Soup::new(positions, elements).unwrap();
    let fine = subdivide(&scene, &Subdivide::default()).unwrap();
    let [ab, ca, bc] = [4, 5, 6];
    assert_eq!(fine.positions()[4..], [at(2.0, 0.0), at(0.0, 2.0), at(2.0, 2.0)]);
    let segments = [[2, bc], [bc, 1]].map(Element::Segment);
    let triangles = [[0, ab, ca], [ab, 1, bc], [ca, bc, 2], [bc, ca, ab]].map(Element::Triangle);
    let expected: Vec<_> = segments.into_iter().chain([Element::Point(1)]).chain(triangles).collect();
    assert_eq!(fine.elements().collect::<Vec<_>>(), expected);
}

#[test]
fn middles_move_by_up_to_the_amplitude_and_reach_far_into_it() {
    let amplitude = 0.25;
    let mesh = ball(6);
    let fine = subdivide(&mesh, &Subdivide { amplitude, ..Default::default() }).unwrap();
    let plain = subdivide(&mesh, &Subdivide::default()).unwrap();
    let mut moved = Vec::new();
    for (i, &parent) in mesh.triangles().iter().enumerate() {
        let [a, b, c] = corners(&mesh, parent);
        let [d, e, f] = plain.triangles()[4 * i + 3];
        for (m, p, q) in [(d, b, c), (e, c, a), (f, a, b)] {
            let by: Vector3<f64> = fine.positions()[m as usize] - plain.positions()[m as usize];
            moved.push(by / (p - q).norm());
        }
    }
    let longest = moved.iter().map(|v| v.norm()).fold(0.0, f64::max);
    assert!((0.98 * amplitude..=amplitude * (1.0 + 16.0 * f64::EPSILON)).contains(&longest), "{longest}");
    // Each coordinate of the unit ball has the variance 1/5 and the mean 0.
    for k in 0..3 {
        let mean = moved.iter().map(|v| v[k] / amplitude).sum::<f64>() / moved.len() as f64;
        let square = moved.iter().map(|v| (v[k] / amplitude).powi(2)).sum::<f64>() / moved.len() as f64;
        assert!(mean.abs() < 0.05 && (square - 0.2).abs() < 0.03, "{mean} {square}");
    }
}

#[test]
fn the_order_of_the_primitives_changes_no_position() {
    let scene =
        knot_and_cables(&KnotAndCables { rings: 24, sides: 6, cable_segments: 9, ..Default::default() }).unwrap();
    let mut elements: Vec<Element> = scene.elements().collect();
    elements.reverse();
    elements.rotate_left(77);
    for (i, element) in elements.iter_mut().enumerate() {
        // Triangles start at other corners, and some are reversed.
        if let Element::Triangle(t) = element {
            t.rotate_left(i % 3);
            if i % 2 == 0 {
                t.swap(0, 1);
            }
        }
    }
    let shuffled = Soup::new(scene.positions().to_vec(), elements).unwrap();
    let options = Subdivide { levels: 3, amplitude: 0.2, ..Default::default() };
    let [one, two] = [&scene, &shuffled].map(|soup| subdivide(soup, &options).unwrap());
    assert_eq!(one.positions(), two.positions());
    let sorted = |soup: &Soup<f64>| {
        let mut all: Vec<Vec<u32>> = soup.elements().map(|e| e.indices().to_vec()).collect();
        all.iter_mut().for_each(|indices| indices.sort_unstable());
        all.sort_unstable();
        all
    };
    assert_eq!(sorted(&one), sorted(&two));
    assert_ne!(one.positions(), subdivide(&scene, &Subdivide { seed: 2, ..options }).unwrap().positions());
}

#[test]
fn triangles_without_shared_vertices_stay_joined() {
    let mesh = ball(3);
    let options = Subdivide { levels: 3, amplitude: 0.2, ..Default::default() };
    let [shared, apart] = [mesh.clone(), torn(&mesh)].map(|soup| subdivide(&soup, &options).unwrap());
    assert!(apart.positions().len() > shared.positions().len());
    assert_eq!(geometry(&shared), geometry(&apart));
}

#[test]
fn cables_stay_polylines() {
    let bundle = cable_bundle(&CableBundle { strands: 3, segments: 5, ..Default::default() }).unwrap();
    let fine = subdivide(&bundle, &Subdivide { levels: 4, amplitude: 0.3, ..Default::default() }).unwrap();
    assert_eq!(fine.segments().len(), 3 * 5 * 16);
    for strand in fine.segments().chunks(5 * 16) {
        assert!(strand.windows(2).all(|pair| pair[0][1] == pair[1][0]));
    }
    assert_not_degenerate(&fine);
}

#[test]
fn scenes_of_any_scale_are_displaced_alike() {
    for scale in [1e-300, 1e-160, 1e200, 1e307] {
        let mesh = Transform::default().scaled(scale).apply(&ball(2)).unwrap();
        let fine = subdivide(&mesh, &Subdivide { amplitude: 0.25, ..Default::default() }).unwrap();
        let plain = subdivide(&mesh, &Subdivide::default()).unwrap();
        let moves = fine.positions().iter().zip(plain.positions()).map(|(p, q)| (p - q).amax() / scale);
        let longest = moves.fold(0.0, f64::max);
        assert!((0.1..0.2).contains(&longest), "{scale}: {longest}");
    }
    let origin = Soup::from_triangles(vec![Point3::new(1.0, 2.0, 3.0); 3], vec![[0, 1, 2]]).unwrap();
    let parts = subdivide(&origin, &Subdivide { amplitude: 0.5, ..Default::default() }).unwrap();
    assert!(parts.positions().iter().all(|p| *p == Point3::new(1.0, 2.0, 3.0)), "no edge, no displacement");
}

#[test]
fn subdivisions_with_too_many_primitives_are_errors() {
    let too_many = |scene: &Soup<f64>, levels| {
        let result = subdivide(scene, &Subdivide { levels, ..Default::default() });
        matches!(result, Err(GenerateError::Build(BuildError::TooMany { .. })))
    };
    let segment = Soup::new(vec![Point3::origin(); 2], [Element::Segment([0, 1])]).unwrap();
    for levels in [31, 64, u32::MAX] {
        assert!(too_many(&segment, levels) && too_many(&ball(1), levels), "{levels}");
    }
    assert!(too_many(&ball(1), 13));
    for bad in [-0.1, 0.6, f64::NAN] {
        let result = subdivide(&segment, &Subdivide { amplitude: bad, ..Default::default() });
        assert!(matches!(result, Err(GenerateError::OutOfRange { option: "amplitude", .. })), "{bad}");
    }
    let points = mixed_sizes(&MixedSizes { triangles: 0, segments: 0, points: 5, ..Default::default() }).unwrap();
    assert_eq!(subdivide(&points, &Subdivide { levels: u32::MAX, ..Default::default() }).unwrap(), points);
}

#[test]
fn steps_of_a_transform_follow_each_other() {
    let scene = Soup::new(vec![Point3::new(1.0, 2.0, 3.0)], [Element::Point(0)]).unwrap();
    let image = |transform: Transform| transform.apply(&scene).unwrap().positions()[0];
    let none = Transform::default();
    assert_eq!(image(none), Point3::new(1.0, 2.0, 3.0));
    assert_eq!(image(none.rotated_x(90.0)), Point3::new(1.0, -3.0, 2.0));
    assert_eq!(image(none.rotated_y(90.0)), Point3::new(3.0, 2.0, -1.0));
    assert_eq!(image(none.rotated_z(90.0)), Point3::new(-2.0, 1.0, 3.0));
    assert_eq!(image(none.rotated_x(90.0).rotated_z(90.0)), Point3::new(3.0, 1.0, 2.0));
    assert_eq!(image(none.translated([1.0, 0.0, 0.0]).scaled(2.0)), Point3::new(4.0, 4.0, 6.0));
    assert_eq!(image(none.scaled(2.0).translated([1.0, 0.0, 0.0])), Point3::new(3.0, 4.0, 6.0));
    assert_eq!(image(none.translated([1.0, 0.0, 0.0]).rotated_z(180.0)), Point3::new(-2.0, -2.0, 3.0));
}

#[test]
fn rotations_keep_shapes() {
    let gear = skewed_gear(&SkewedGear { points: 20, ..Default::default() }).unwrap();
    let turned = Transform::default().rotated_x(45.0).rotated_y(45.0).apply(&gear).unwrap();
    assert_eq!(turned.triangles(), gear.triangles());
    assert!((volume(&turned) / volume(&gear) - 1.0).abs() < 1e4 * f64::EPSILON);
    // This is the direction of the axis of the gear.
    let axis = Vector3::new(0.5, -(0.5f64.sqrt()), 0.5);
    let heights = turned.positions().iter().map(|p| p.coords.dot(&axis));
    assert!(heights.into_iter().all(|z| z.abs() < 1e-13 || (z - 24.0).abs() < 1e-13));
    let back = Transform::default().rotated_y(-45.0).rotated_x(-45.0).apply(&turned).unwrap();
    assert!(back.positions().iter().zip(gear.positions()).all(|(p, q)| (p - q).amax() < 1e-13));
}

#[test]
fn invalid_transforms_are_errors() {
    let scene = ball(1);
    let none = Transform::default();
    for bad in [f64::NAN, f64::INFINITY] {
        for (transform, name) in [
            (none.rotated_x(bad), "angle"),
            (none.scaled(bad).rotated_y(45.0), "scale"),
            (none.translated([0.0, bad, 0.0]).scaled(-1.0), "translation"),
        ] {
            let result = transform.apply(&scene);
            assert!(matches!(result, Err(GenerateError::OutOfRange { option, .. }) if option == name), "{result:?}");
        }
    }
    assert!(none.scaled(0.0).apply(&scene).is_err() && none.scaled(-1.0).apply(&scene).is_err());
    let overflow = none.scaled(1e308).scaled(10.0).apply(&scene);
    assert!(matches!(overflow, Err(GenerateError::Build(BuildError::NonFinite { .. }))));
}
