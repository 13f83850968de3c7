//! Statistics of small scenes that are counted by hand, of real models with known statistics, and the resulting notes.

use nalgebra::Point3;
use p2m_core::{Element, Soup};
use p2m_mixed::read_scene;
use p2m_mixed::statistics::figure::Share;
use p2m_mixed::statistics::{Counts, Extremes, Note, Statistics, objects};
use p2m_testkit::model_file;

fn soup(positions: &[[f64; 3]], elements: &[Element]) -> Soup<f64> {
    Soup::new(positions.iter().map(|&p| Point3::from(p)).collect(), elements.iter().copied()).unwrap()
}

fn obj(text: &str) -> Statistics {
    Statistics::of(&p2m_mixed::read_obj(text.as_bytes(), "scene.obj").unwrap().soup)
}

/// The corner of a cube: three right triangles with one open side.
const CORNER: &str = "v 0 0 0\nv 3 0 0\nv 0 4 0\nv 0 0 12\nf 1 3 2\nf 1 2 4\nf 1 4 3\n";

fn names(statistics: &Statistics) -> Vec<&'static str> {
    statistics.notes().iter().map(Note::name).collect()
}

/// Returns the note of this name.
fn sentence(statistics: &Statistics, name: &str) -> String {
    let notes = statistics.notes();
    notes.iter().find(|n| n.name() == name).unwrap_or_else(|| panic!("no note {name}: {notes:?}")).to_string()
}

#[test]
fn a_small_scene_is_counted_by_hand() {
    let s = obj(&format!("{CORNER}v 9 9 9\nv 0 0 -0\nl 2 3\nl 6 4\np 4\n"));
    assert_eq!(s.primitives, Counts { triangles: 3, segments: 2, points: 1 });
    assert_eq!((s.positions.total, s.positions.used, s.positions.distinct), (6, 5, 4)); // 0 and -0 are one place
    let bounds = s.bounds.unwrap();
    assert_eq!((bounds.min, bounds.max), (Point3::origin(), Point3::new(3.0, 4.0, 12.0)));
    assert_eq!(s.duplicates, Counts::default());
    assert_eq!((s.edges.total, s.edges.boundary, s.edges.non_manifold, s.edges.inconsistent), (6, 3, 0, 0));
    assert_eq!(s.components, 1);
    assert_eq!((s.shapes.zero_area, s.shapes.zero_length, s.shapes.slivers, s.shapes.thin), (0, 0, 0, 0));
    assert_eq!(s.sizes.diagonal, 13.0);
    assert_eq!(s.sizes.edge, Some(Extremes { min: 3.0, max: 160f64.sqrt() }));
    assert_eq!(s.sizes.area, Some(Extremes { min: 6.0, max: 24.0 }));
    // The aspect of a right triangle is c^2 / (a b). The legs (3, 4), (3, 12), (4, 12) give 25/12, 153/36, 160/48.
    assert_eq!(s.shapes.median_aspect, Some(160.0 / 48.0));
    assert_eq!((s.location.distance_from_origin, s.location.largest_coordinate, s.location.beyond_f32), (6.5, 12.0, 0));
    assert_eq!(s.location.f32_step(), Some(f64::from(12.0f32 - 12.0f32.next_down())));
    assert_eq!(names(&s), ["unused"]);
    assert_eq!(sentence(&s, "unused"), "1 position belongs to no primitive and counts for nothing");
}

#[test]
fn closed_surfaces_are_closed_and_flips_are_seen() {
    let closed = obj(&format!("{CORNER}f 2 3 4\n"));
    assert!(closed.edges.is_closed() && names(&closed).is_empty());
    assert!(!obj(CORNER).edges.is_closed() && names(&obj(CORNER)).is_empty(), "an open surface is nothing special");
    let flipped = obj(&format!("{CORNER}f 2 4 3\n"));
    assert_eq!((flipped.edges.inconsistent, flipped.edges.boundary), (3, 0));
    assert!(!flipped.edges.is_closed());
    assert!(sentence(&flipped, "inconsistent").starts_with("3 edges lie between triangles that face opposite sides"));
    assert!(!obj("v 0 0 0\np 1\n").edges.is_closed(), "no triangles close nothing");
}

#[test]
fn edges_are_matched_by_coordinates() {
    // Three triangles around the z axis share no position, and one has no edges because two of its corners are equal.
    let fin = |x: i32, y: i32| format!("v 0 0 0\nv 0 0 1\nv {x} {y} 0\nf -3 -2 -1\n");
    let text = format!("{}{}{}v 5 0 0\nv 5 0 0\nv 6 0 0\nf -3 -2 -1\n", fin(1, 0), fin(0, 1), fin(-1, -1));
    let s = obj(&text);
    assert_eq!((s.edges.total, s.edges.boundary, s.edges.non_manifold), (7, 6, 1));
    assert_eq!(s.components, 2);
    assert!(sentence(&s, "non_manifold").starts_with("1 edge belongs to more than two triangles"));
    assert!(sentence(&s, "zero_area").starts_with("1 triangle has no area"));
}

#[test]
fn positions_that_are_not_shared_are_noted() {
    let unshared: String = (0..4).map(|_| "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\n").collect();
    let s = obj(&unshared);
    assert_eq!((s.positions.used, s.positions.distinct), (12, 3));
    assert_eq!(sentence(&s, "unshared"), "primitives do not share positions: 12 of them are at 3 different places");
    assert_eq!(s.duplicates.triangles, 3);
    assert!(sentence(&s, "duplicates").starts_with("3 primitives repeat others"));
    assert!(!names(&obj(CORNER)).contains(&"unshared"));
}

#[test]
fn duplicates_have_the_same_corners_in_any_order() {
    let s = soup(
        &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, -0.0], [0.0, 0.0, 1.0]],
        &[
            Element::Triangle([0, 1, 2]),
            Element::Triangle([2, 0, 3]),
            Element::Triangle([0, 1, 4]),
            Element::Triangle([2, 3, 0]),
            Element::Segment([0, 1]),
            Element::Segment([3, 0]),
            Element::Segment([0, 2]),
            Element::Point(1),
            Element::Point(3),
            Element::Point(2),
            Element::Point(3),
            // The degenerate segment is not a duplicate of the point, although it covers the same position.
            Element::Segment([1, 3]),
        ],
    );
    let s = Statistics::of(&s);
    assert_eq!(s.duplicates, Counts { triangles: 2, segments: 1, points: 2 });
    assert_eq!((s.shapes.zero_length, s.components), (1, 1));
    assert!(sentence(&s, "zero_length").starts_with("1 segment has no length"));
}

#[test]
fn parts_that_share_a_corner_are_one() {
    let s = obj(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nv 5 0 0\nl 4 2\nv 7 0 0\nv 8 0 0\nl 5 6\nv 9 0 0\np 7\nv 9 0 0\np 8\n",
    );
    assert_eq!(s.components, 3);
}

#[test]
fn an_empty_scene_has_no_figures() {
    let s = Statistics::of(&Soup::default());
    assert_eq!((s.primitives.total(), s.bounds, s.components, s.sizes.edge), (0, None, 0, None));
    assert_eq!(names(&s), ["empty"]);
    let s = Statistics::of(&soup(&[[1.0; 3]], &[]));
    assert_eq!((s.positions.total, s.positions.used), (1, 0));
    assert_eq!(names(&s), ["empty", "unused"]);
}

#[test]
fn unused_positions_may_be_anything() {
    let positions = [[f64::NAN; 3], [0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [f64::INFINITY, 1e300, 0.0]];
    let mut with = Statistics::of(&soup(&positions, &[Element::Triangle([1, 2, 3])]));
    let without = Statistics::of(&soup(&positions[1..4], &[Element::Triangle([0, 1, 2])]));
    assert_eq!((with.positions.total, with.positions.used), (5, 3));
    with.positions = without.positions;
    assert_eq!(with, without);
}

/// Returns `count` triangles of base 1, of which the first `special` have this height and the others have height 1.
fn strip(count: u32, special: u32, height: f64) -> Statistics {
    let mut positions = Vec::new();
    for i in 0..count {
        let (z, h) = (f64::from(i) * 2.0, if i < special { height } else { 1.0 });
        positions.extend([[0.0, 0.0, z], [1.0, 0.0, z], [0.5, h, z]]);
    }
    let elements: Vec<_> = (0..count).map(|i| Element::Triangle([3 * i, 3 * i + 1, 3 * i + 2])).collect();
    Statistics::of(&soup(&positions, &elements))
}

#[test]
fn slivers_are_below_a_1024th_and_noted_from_one_percent_on() {
    let limit = 1.0 / 1024.0;
    assert_eq!(strip(10, 10, limit).shapes.slivers, 0);
    assert_eq!(strip(10, 7, limit * (1.0 - f64::EPSILON)).shapes.slivers, 7);
    let s = strip(200, 2, 1e-6);
    assert_eq!((s.shapes.slivers, s.shapes.thin), (2, 2));
    assert_eq!(
        sentence(&s, "slivers"),
        "1 % of the triangles are slivers (height below 1/1024 of the longest edge): their distances take \
        double-double arithmetic, which is slower"
    );
    assert!(s.notes().contains(&Note::Slivers { share: Share { part: 2, whole: 200 } }));
    assert!(!names(&strip(201, 2, 1e-6)).contains(&"slivers"));
    assert!(sentence(&strip(100, 41, 1e-9), "slivers").starts_with("41 % of the triangles are slivers"));
    // A triangle without area is not a sliver.
    let s = strip(4, 2, 0.0);
    assert_eq!((s.shapes.slivers, s.shapes.thin, s.shapes.zero_area), (0, 0, 2));
    assert_eq!(s.shapes.median_aspect, Some(1.25), "of those with an area");
}

#[test]
fn thin_triangles_are_noted_from_one_half_on() {
    assert_eq!(strip(10, 10, 0.1).shapes.thin, 0);
    assert_eq!(strip(10, 4, 0.099).shapes.thin, 4);
    assert!(!names(&strip(10, 4, 0.099)).contains(&"thin"));
    let s = strip(10, 6, 1.0 / 64.0);
    assert_eq!(s.shapes.median_aspect, Some(64.0));
    assert!(
        sentence(&s, "thin").starts_with("60 % of the triangles are thin (longest edge above 10 heights, median 64)")
    );
    assert!(names(&strip(10, 5, 0.01)).contains(&"thin"));
}

/// Returns the diagonal of a box of this size, with one end at `x`, as a segment.
fn rod(x: f64, size: f64) -> Statistics {
    Statistics::of(&soup(&[[x, 0.0, 0.0], [x + size, size, size]], &[Element::Segment([0, 1])]))
}

#[test]
fn distance_from_the_origin_is_noted_from_a_hundred_sizes_on() {
    let s = rod(524_288.0, 4.0);
    assert_eq!(
        sentence(&s, "far_from_origin"),
        "the scene lies 524,300 units from the origin, 76,000 times its size: f32 has steps of 0.062 units there, f64 of \
        1.2e-10; move it to the origin, or keep it in f64"
    );
    assert!(names(&rod(256.0, 1.0)).contains(&"far_from_origin"));
    assert!(!names(&rod(128.0, 1.0)).contains(&"far_from_origin"));
    // A single point has no size to compare with.
    let point = Statistics::of(&soup(&[[1e9; 3]], &[Element::Point(0)]));
    assert!(names(&point).is_empty(), "{:?}", point.notes());
}

#[test]
fn sizes_that_trees_do_not_prune_are_noted() {
    assert!(names(&rod(0.0, 1e121)).contains(&"extreme_scale"));
    assert!(names(&rod(0.0, 1e-121)).contains(&"extreme_scale"));
    for size in [1e119, 1e-119] {
        assert!(!names(&rod(0.0, size)).contains(&"extreme_scale"), "{size}");
    }
    assert!(names(&rod(0.0, 1e39)).contains(&"beyond_f32"));
    assert!(!names(&rod(0.0, 3e38)).contains(&"beyond_f32"));
}

#[test]
fn lengths_that_differ_by_orders_of_magnitude_are_noted() {
    let with = |tiny: f64| obj(&format!("v 0 0 0\nv 0 1 1\nv {tiny:?} 0 0\nl 1 2\nl 1 3\n"));
    assert!(!names(&with(1e-5)).contains(&"spread"));
    assert!(sentence(&with(1e-7), "spread").starts_with("edge lengths span 7 orders of magnitude"));
}

#[test]
fn flat_scenes_say_where() {
    assert_eq!(sentence(&obj("v 0 0.5 0\nv 1 0.5 1\nl 1 2\n"), "flat"), "the scene is flat: y is 0.5 everywhere");
    assert!(names(&obj("v 0 0.5 0\np 1\n")).is_empty(), "a point is not flat");
}

#[test]
fn f32_holds_what_it_holds() {
    // f32 does not have the numbers 0.1 and 2^24 + 1. A repeated position counts once, and an unused one does not
    // count.
    let s = obj("v 0.1 16777217 0.5\nv 1 2 3\nv 0.3 0 0\nv 0.1 16777217 0.5\nl 1 2\np 1\np 4\n");
    assert_eq!(s.location.beyond_f32, 2);
    assert_eq!(s.location.f32_step(), Some(1.0));
    assert_eq!(rod(0.0, 1e300).location.f32_step(), None);
    assert_eq!(rod(0.0, 1e300).location.beyond_f32, 3);
}

#[test]
fn figures_are_finite_at_every_scale() {
    // There is no note either if the sum of two coordinates overflows.
    let high = Statistics::of(&soup(&[[1.5e308, 0.0, 0.0], [1e308, 0.0, 0.0]], &[Element::Segment([0, 1])]));
    assert_eq!((high.location.distance_from_origin, high.sizes.diagonal), (1.25e308, 0.5e308));
    for (scale, zero_area) in [(1e-300, 0), (1e300, 0), (5e-324, 0), (f64::MAX, 0), (0.0, 1)] {
        let positions = [[-scale, 0.0, 0.0], [scale, 0.0, 0.0], [0.0, scale, 0.0], [0.0, 0.0, scale]];
        let s = Statistics::of(&soup(&positions, &[Element::Triangle([0, 1, 2]), Element::Segment([1, 3])]));
        assert_eq!(s.shapes.zero_area, zero_area, "{scale}");
        let edge = s.sizes.edge.unwrap_or(Extremes { min: 1.0, max: 1.0 });
        let area = s.sizes.area.unwrap_or(Extremes { min: 1.0, max: 1.0 });
        let figures = [
            s.sizes.diagonal,
            edge.min,
            edge.max,
            edge.orders_of_magnitude(),
            area.min,
            area.max,
            s.shapes.median_aspect.unwrap_or(1.0),
            s.location.distance_from_origin,
            s.location.largest_coordinate,
            s.location.f64_step(),
        ];
        assert!(figures.iter().all(|x| x.is_finite()), "{scale}: {figures:?}");
        assert!(edge.min > 0.0 && area.min > 0.0 && edge.min <= edge.max, "{scale}: {figures:?}");
        if zero_area == 0 {
            assert_eq!(s.shapes.median_aspect, Some(2.0), "{scale}");
        }
    }
}

/// The name of a model and its statistics, as far as the list of models states them: zero area, slivers, non-manifold
/// edges, duplicates, components.
const MODELS: &[(&str, [u64; 5])] = &[
    ("degenerate_small.obj", [0, 0, 6, 12, 1]),
    ("degenerate_sliding.off", [4, 0, 0, 0, 1]),
    ("zero_area_triangle.stl", [1, 0, 0, 0, 1]),
    ("camel.off", [0, 0, 0, 0, 1]),
    ("armadillo.obj", [0, 0, 0, 0, 1]),
    ("mixed_armadillo_camel_wireframe.obj", [0, 0, 0, 0, 2]),
    ("dragon_48k_nonmanifold.ply", [0, 0, 2094, 1254, 1]),
    ("sponza_66k.obj", [6, 14, 481, 10, 79]),
    ("gear_skewed_57k.ply", [0, 25_610, 0, 0, 1]),
    ("rotterdam_city_far_from_origin.obj", [1243, 1639, 182, 123, 131]),
    ("hotel_room_nonmanifold.ply", [0, 1794, 4919, 120, 60]),
    ("heavily_nonmanifold.obj", [22, 6, 14_425, 9708, 56]),
    ("political_borders_lines.obj", [0, 0, 0, 15_093, 816]),
    ("scan.off", [0, 0, 0, 0, 1]),
    ("slivers.stl", [0, 600, 0, 0, 1]),
    ("non_manifold.ply", [0, 0, 197, 46, 1]),
    ("mixed.obj", [0, 0, 0, 0, 5]),
    ("lines.obj", [0, 0, 0, 0, 6]),
    ("city_far_from_origin.obj", [64, 0, 3, 0, 32]),
    ("zero_area.off", [4, 0, 1, 1, 1]),
];

#[test]
fn models_have_the_figures_of_their_list() {
    for (name, expected) in MODELS {
        let Some(path) = model_file(name) else { continue };
        let s = Statistics::of(&read_scene(&path).unwrap().soup);
        let found = [s.shapes.zero_area, s.shapes.slivers, s.edges.non_manifold, s.duplicates.total(), s.components];
        assert_eq!(found, *expected, "{name}");
    }
    let closed = ["scan.obj", "scan.off", "scan.ply", "camel.off", "bunny.obj", "dragon_100k.obj", "lucy_100k.ply"];
    for path in closed.into_iter().filter_map(model_file) {
        let (name, s) = (path.display(), Statistics::of(&read_scene(&path).unwrap().soup));
        assert!(s.edges.is_closed() && s.notes().is_empty(), "{name}: {:?}", s.notes());
    }
    let cities = [
        ("rotterdam_city_far_from_origin.obj", "4.452e5 units from the origin, 360"),
        ("city_far_from_origin.obj", "444,900 units from the origin, 2,900"),
    ];
    for (name, expected) in cities {
        let Some(city) = model_file(name) else { continue };
        let city = Statistics::of(&read_scene(&city).unwrap().soup);
        let found = sentence(&city, "far_from_origin");
        assert!(found.starts_with(&format!("the scene lies {expected} times its size")), "{found}");
    }
}

#[test]
fn objects_are_counted_by_name() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\np 1\no b\nf 1 2 3\no a\nl 1 2 3\no b\np 2\nf 3 2 1\no\nl 1 3\n";
    let scene = p2m_mixed::read_obj(text.as_bytes(), "scene.obj").unwrap();
    let counts = |triangles, segments, points| Counts { triangles, segments, points };
    let found: Vec<_> = objects(&scene).into_iter().map(|o| (o.name, o.primitives)).collect();
    let name = |name: &str| Some(name.to_owned());
    assert_eq!(found, [(name("b"), counts(2, 0, 1)), (name("a"), counts(0, 2, 0)), (None, counts(0, 1, 1))]);
    let total: u64 = objects(&scene).iter().map(|o| o.primitives.total()).sum();
    assert_eq!(total, Statistics::of(&scene.soup).primitives.total());
    // If all primitives have a name, there is no entry without one. If none has a name, the list is empty.
    let named = p2m_mixed::read_obj("v 0 0 0\no x\np 1\n".as_bytes(), "scene.obj").unwrap();
    assert_eq!(objects(&named).len(), 1);
    assert!(objects(&p2m_mixed::read_obj("v 0 0 0\np 1\n".as_bytes(), "scene.obj").unwrap()).is_empty());
}

#[test]
fn a_closed_surface_that_faces_inwards_has_a_note() {
    use p2m_mixed::generate::{IcoSphere, Transform, ico_sphere};
    let ball = ico_sphere(&IcoSphere { frequency: 3 }).unwrap();
    let turned: Vec<[u32; 3]> = ball.triangles().iter().map(|&[a, b, c]| [a, c, b]).collect();
    let turned = p2m_core::Soup::from_triangles(ball.positions().to_vec(), turned).unwrap();
    for (soup, is_inside_out) in [(&ball, false), (&turned, true)] {
        for shift in [0.0, 1e6] {
            let moved = Transform::default().translated([shift, 0.0, -shift]).apply(soup).unwrap();
            let notes = Statistics::of(&moved).notes();
            assert_eq!(notes.contains(&Note::InsideOut), is_inside_out, "{shift} {notes:?}");
        }
    }
    // An open surface has no inside.
    let open = p2m_core::Soup::from_triangles(turned.positions().to_vec(), turned.triangles()[1..].to_vec()).unwrap();
    assert!(!Statistics::of(&open).is_inside_out);
}
