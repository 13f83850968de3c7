//! Every kind of scene has the documented topology and size, and the checksum of earlier versions.

use crate::generator_support::{aspect, assert_not_degenerate, assert_watertight, checksum, corners, volume};
use p2m_core::{BuildError, Element, PrimitiveSet, Soup};
use p2m_mixed::generate::{
    CableBundle, Cone, Cylinder, GenerateError, IcoSphere, Kind, KnotAndCables, MixedSizes, SkewedGear, Sphere,
    TorusKnot, cable_bundle, cone, cylinder, ico_sphere, knot_and_cables, mixed_sizes, skewed_gear, sphere, torus_knot,
};
use std::f64::consts::{PI, TAU};

/// The relative error of sums of some thousand terms of one sign, each of which has a few roundings.
const SUM: f64 = 1e4 * f64::EPSILON;

/// Returns the area of the regular polygon in the unit circle.
fn polygon(sides: u32) -> f64 {
    f64::from(sides) / 2.0 * (TAU / f64::from(sides)).sin()
}

/// Checks that a scene is watertight, not degenerate and not inside out, and has this topology and number of triangles.
fn assert_closed(soup: &Soup<f64>, characteristic: i64, triangles: u32) {
    assert_eq!(soup.triangles().len(), triangles as usize);
    assert_eq!(soup.len(), triangles as usize, "triangles only");
    assert_eq!(assert_watertight(soup), characteristic);
    assert_not_degenerate(soup);
    assert!(volume(soup) > 0.0);
}

#[test]
fn each_kind_is_the_same_as_ever() {
    let checksums = Kind::all().map(|kind| (kind.name(), checksum(&kind.generate().unwrap())));
    let expected = [
        ("knot-and-cables", 0x8921_74f1_6f8b_6b57),
        ("torus-knot", 0xeb93_ff82_5b77_6d45),
        ("skewed-gear", 0x01a9_c204_168b_cd33),
        ("sphere", 0x433b_2f68_0f02_5c05),
        ("ico-sphere", 0x9661_7bf3_e6d3_d539),
        ("cone", 0xab8d_47a1_f527_b9c6),
        ("cylinder", 0xbae2_d097_8132_ef67),
        ("cable-bundle", 0xe11e_8f09_144d_f9e9),
        ("mixed-sizes", 0x131e_b872_ddb9_df80),
    ];
    assert_eq!(checksums, expected, "{checksums:#x?}");
}

#[test]
fn names_find_their_kinds() {
    for kind in Kind::all() {
        assert_eq!(Kind::from_name(kind.name()), Some(kind));
        assert!(!kind.description().is_empty());
    }
    assert_eq!(Kind::from_name("teapot"), None);
}

#[test]
fn torus_knots_are_closed_tubes() {
    for (p, q, rings, sides) in
        [(2, 3, 300, 20), (3, 2, 301, 7), (1, 0, 50, 3), (0, 1, 50, 4), (1, 1, 60, 5), (5, 8, 900, 6)]
    {
        let options = TorusKnot { p, q, rings, sides, tube_radius: 0.1 };
        let knot = torus_knot(&options).unwrap();
        assert_closed(&knot, 0, 2 * rings * sides);
        // Without self-intersection, the volume is that of the cross-section times the length of the centre line.
        let speed = |i: u32| {
            let t = TAU * f64::from(i) / 4096.0;
            let around = f64::from(p) * (2.0 + 0.8 * (f64::from(q) * t).cos());
            around.hypot(0.8 * f64::from(q))
        };
        let length: f64 = (0..4096).map(speed).sum::<f64>() * TAU / 4096.0;
        let expected = 0.01 * polygon(sides) * length;
        // Rings turn relative to each other, so quadrilaterals are not planar. The effect is of first order in the
        // angle between rings.
        let angle = TAU * f64::from(p.max(q)) / f64::from(rings);
        let relative = volume(&knot) / expected - 1.0;
        assert!(relative.abs() < angle, "({p}, {q}): {relative}");
    }
    for (rings, sides) in [(3, 3), (4, 3)] {
        let knot = torus_knot(&TorusKnot { rings, sides, ..Default::default() }).unwrap();
        assert_eq!((assert_watertight(&knot), knot.triangles().len()), (0, 2 * (rings * sides) as usize));
    }
}

#[test]
fn the_torus_knot_is_that_of_the_scene_with_cables_before_rounding() {
    let knot = torus_knot(&TorusKnot { rings: 150, sides: 12, ..Default::default() }).unwrap();
    let rounded = knot_and_cables(&KnotAndCables { cables: 0, ..Default::default() }).unwrap();
    assert_eq!(knot.triangles(), rounded.triangles());
    for (p, q) in knot.positions().iter().zip(rounded.positions()) {
        assert!((p - q).amax() <= 0.5e-5 + 4.0 * f64::EPSILON, "{p} {q}");
    }
}

#[test]
fn gears_are_closed_and_have_a_bore() {
    for (teeth, points) in [(19, 373), (3, 4), (24, 5), (40, 60)] {
        let gear = skewed_gear(&SkewedGear { teeth, points }).unwrap();
        assert_closed(&gear, 0, 8 * teeth * points);
        assert_eq!(gear.positions().len(), 4 * (teeth * points) as usize);
        assert!(gear.positions().iter().all(|p| p.z == 0.0 || p.z == 24.0), "faces are planar");
    }
}

#[test]
fn the_default_gear_is_made_of_slivers() {
    let gear = skewed_gear(&SkewedGear::default()).unwrap();
    assert_eq!((gear.positions().len(), gear.triangles().len()), (28_348, 56_696));
    let mut aspects: Vec<f64> = gear.triangles().iter().map(|&t| aspect(corners(&gear, t))).collect();
    aspects.sort_by(f64::total_cmp);
    let quantile = |percent: usize| aspects[percent * aspects.len() / 100];
    assert!((900.0..1000.0).contains(&quantile(50)), "{}", quantile(50));
    assert!(quantile(5) > 375.0 && quantile(95) < 1260.0, "{} {}", quantile(5), quantile(95));
    assert!(aspects[0] > 300.0, "{}", aspects[0]);
    assert!(gear.positions().iter().all(|p| p.x.hypot(p.y) < 52.0 + 1e-12 && p.x.hypot(p.y) > 25.0 - 1e-12));

    // A section is the rotated outline, which is smaller because points move along a chord rather than an arc.
    let outline: Vec<_> = gear.positions()[..7087].iter().map(|p| (p.x, p.y)).collect();
    let area: f64 = (0..7087).map(|i| (outline[i], outline[(i + 1) % 7087])).map(|(a, b)| a.0 * b.1 - a.1 * b.0).sum();
    let shrunk = 1.0 - (1.0 - (0.05 * TAU).cos()) / 3.0;
    let expected = (area / 2.0 - 625.0 * polygon(7087)) * 24.0 * shrunk;
    let relative = volume(&gear) / expected - 1.0;
    assert!(relative.abs() < 1e-3, "{relative}");
}

/// Returns the volume of the solid over a regular polygon whose profile has these radii and heights.
fn revolved_volume(sides: u32, profile: &[(f64, f64)]) -> f64 {
    let frustum = |a: (f64, f64), b: (f64, f64)| (b.1 - a.1) * (a.0 * a.0 + a.0 * b.0 + b.0 * b.0) / 3.0;
    polygon(sides) * profile.windows(2).map(|w| frustum(w[0], w[1])).sum::<f64>()
}

fn assert_volume(soup: &Soup<f64>, expected: f64) {
    let relative = volume(soup) / expected - 1.0;
    assert!(relative.abs() < SUM, "{relative}");
}

#[test]
fn spheres_are_closed_and_round() {
    for (meridians, bands) in [(80, 79), (3, 2), (4, 3), (7, 40), (200, 5)] {
        let ball = sphere(&Sphere { meridians, bands }).unwrap();
        assert_closed(&ball, 2, 2 * meridians * (bands - 1));
        assert!(ball.positions().iter().all(|p| (p.coords.norm() - 1.0).abs() <= 4.0 * f64::EPSILON));
        let latitude = |i| PI * f64::from(i) / f64::from(bands);
        let profile: Vec<_> = (0..=bands).map(|i| (latitude(i).sin(), -latitude(i).cos())).collect();
        assert_volume(&ball, revolved_volume(meridians, &profile));
    }
    assert!((volume(&sphere(&Sphere::default()).unwrap()) / (4.0 * PI / 3.0) - 1.0).abs() < 2e-3);
}

#[test]
fn cones_and_cylinders_are_closed_with_their_caps() {
    for (sides, bands, cap_bands) in [(100, 43, 20), (3, 1, 1), (5, 1, 4), (8, 6, 1)] {
        let options = Cone { sides, bands, cap_bands };
        let solid = cone(&options).unwrap();
        assert_closed(&solid, 2, sides * (2 * bands + 2 * cap_bands - 2));
        assert_volume(&solid, polygon(sides) * 2.0 / 3.0);

        let options = Cylinder { sides, bands, cap_bands };
        let solid = cylinder(&options).unwrap();
        assert_closed(&solid, 2, sides * (2 * bands + 4 * cap_bands - 2));
        assert_volume(&solid, polygon(sides) * 2.0);
    }
}

#[test]
fn ico_spheres_are_closed_round_and_even() {
    let mut missing = Vec::new();
    for frequency in [1, 2, 3, 4, 5, 8, 16, 24] {
        let ball = ico_sphere(&IcoSphere { frequency }).unwrap();
        assert_closed(&ball, 2, 20 * frequency * frequency);
        assert_eq!(ball.positions().len(), (10 * frequency * frequency + 2) as usize);
        assert!(ball.positions().iter().all(|p| (p.coords.norm() - 1.0).abs() <= 4.0 * f64::EPSILON));
        assert!(ball.triangles().iter().all(|&t| aspect(corners(&ball, t)) < 1.7));
        missing.push(4.0 * PI / 3.0 - volume(&ball));
    }
    // Edges of this length have a circumsphere of radius 1.
    let edge = 4.0 / (10.0 + 2.0 * 5f64.sqrt()).sqrt();
    let icosahedron = 5.0 * (3.0 + 5f64.sqrt()) / 12.0 * edge.powi(3);
    assert!((4.0 * PI / 3.0 - missing[0] - icosahedron).abs() < SUM, "{icosahedron}");
    // The error is of second order: edges of half the length have a quarter of it.
    let ratio = missing[5] / missing[6];
    assert!((3.9..4.1).contains(&ratio), "{ratio}");
}

#[test]
fn bundles_are_polylines() {
    for (strands, segments) in [(64, 256), (1, 1), (3, 50)] {
        let options = CableBundle { strands, segments, ..Default::default() };
        let bundle = cable_bundle(&options).unwrap();
        assert_eq!(bundle.len(), (strands * segments) as usize);
        assert_eq!(bundle.segments().len(), bundle.len());
        assert_eq!(bundle.positions().len(), (strands * (segments + 1)) as usize);
        for strand in bundle.segments().chunks(segments as usize) {
            assert!(strand.windows(2).all(|pair| pair[0][1] == pair[1][0]));
        }
        // No position belongs to two strands.
        let mut ends: Vec<u32> = bundle.segments().chunks(segments as usize).map(|strand| strand[0][0]).collect();
        ends.dedup();
        assert_eq!(ends.len(), strands as usize);
        assert_not_degenerate(&bundle);
    }
}

#[test]
fn strands_stay_within_the_radius_of_the_first_one() {
    let options = CableBundle { strands: 20, segments: 40, radius: 0.25, ..Default::default() };
    let bundle = cable_bundle(&options).unwrap();
    let straight = cable_bundle(&CableBundle { twists: 0.0, ..options }).unwrap();
    let (mut far, mut turned) = (0.0f64, 0);
    for step in 0..=40 {
        let centre: nalgebra::Vector3<f64> =
            (0..20).map(|strand| bundle.positions()[strand * 41 + step].coords).sum::<nalgebra::Vector3<f64>>() / 20.0;
        for strand in 0..20 {
            let p = bundle.positions()[strand * 41 + step];
            far = far.max((p.coords - centre).norm());
            turned += usize::from((p - straight.positions()[strand * 41 + step]).norm() > 0.01);
        }
    }
    // The outermost strand is at sqrt(19.5 / 20) of the radius, and the mean of all strands is near the centre line.
    assert!((0.22..0.28).contains(&far), "{far}");
    // Twelve turns in 40 steps are integers after 0, 10, 20, 30 and 40 steps.
    assert_eq!(turned, 20 * 36);
}

/// Returns half of the lengths of segments, which is the distance of their ends from their centres.
fn segment_sizes(soup: &Soup<f64>) -> Vec<f64> {
    let at = |i: u32| soup.positions()[i as usize];
    soup.segments().iter().map(|&[a, b]| (at(b) - at(a)).norm() / 2.0).collect()
}

#[test]
fn sizes_have_a_uniform_logarithm() {
    let options = MixedSizes { segments: 12_000, ..Default::default() };
    let soup = mixed_sizes(&options).unwrap();
    let mut decades = [0; 6];
    for size in segment_sizes(&soup) {
        let decade = (0.5f64 / size).log10();
        assert!((-1e-9..6.0 + 1e-9).contains(&decade), "{size}");
        decades[(decade.max(0.0).floor() as usize).min(5)] += 1;
    }
    assert!(decades.iter().all(|n| (1850..2150).contains(n)), "{decades:?}");
    for &[a, b, c] in soup.triangles() {
        let [a, b, c] = corners(&soup, [a, b, c]);
        assert!((b - a).norm().max((c - a).norm()).max((c - b).norm()) <= 1.0);
    }
    let equal = segment_sizes(&mixed_sizes(&MixedSizes { decades: 0.0, ..options }).unwrap());
    assert!(equal.iter().all(|size| (size - 0.5).abs() < 1e-15), "without decades, all have the same size");
}

#[test]
fn kinds_are_mixed_in_random_order_and_counts_are_exact() {
    for (triangles, segments, points) in [(6000, 3000, 1000), (0, 5, 0), (1, 0, 70), (0, 0, 0)] {
        let options = MixedSizes { triangles, segments, points, decades: 12.0, ..Default::default() };
        let soup = mixed_sizes(&options).unwrap();
        let counts = [soup.triangles().len(), soup.segments().len(), soup.points().len()];
        assert_eq!(counts, [triangles, segments, points].map(|n| n as usize));
        assert_eq!(soup.positions().len(), (3 * triangles + 2 * segments + points) as usize, "no vertex is shared");
        assert_not_degenerate(&soup);
    }
    let soup = mixed_sizes(&MixedSizes::default()).unwrap();
    let elements: Vec<Element> = soup.elements().collect();
    for part in elements.chunks(1000) {
        let triangles = part.iter().filter(|e| matches!(e, Element::Triangle(_))).count();
        assert!((530..670).contains(&triangles), "{triangles}");
    }
    for octant in 0..8 {
        let inside = |&&i: &&u32| {
            let p = soup.positions()[i as usize];
            (0..3).all(|k| (p[k] > 0.0) == (octant >> k & 1 == 1))
        };
        let count = soup.points().iter().filter(inside).count();
        assert!((90..160).contains(&count), "octant {octant}: {count} of 1000 points");
    }
    assert_ne!(checksum(&soup), checksum(&mixed_sizes(&MixedSizes { seed: 2, ..Default::default() }).unwrap()));
}

#[test]
fn options_out_of_range_are_errors() {
    fn few(option: &'static str, value: u32, least: u32) -> Result<Soup<f64>, GenerateError> {
        Err(GenerateError::TooFew { option, value, least })
    }
    assert_eq!(torus_knot(&TorusKnot { rings: 2, ..Default::default() }), few("rings", 2, 3));
    assert_eq!(torus_knot(&TorusKnot { sides: 2, ..Default::default() }), few("sides", 2, 3));
    assert_eq!(skewed_gear(&SkewedGear { teeth: 2, ..Default::default() }), few("teeth", 2, 3));
    assert_eq!(skewed_gear(&SkewedGear { points: 3, ..Default::default() }), few("points", 3, 4));
    assert_eq!(sphere(&Sphere { meridians: 2, ..Default::default() }), few("meridians", 2, 3));
    assert_eq!(sphere(&Sphere { bands: 1, ..Default::default() }), few("bands", 1, 2));
    assert_eq!(cone(&Cone { sides: 2, ..Default::default() }), few("sides", 2, 3));
    assert_eq!(cone(&Cone { bands: 0, ..Default::default() }), few("bands", 0, 1));
    assert_eq!(cylinder(&Cylinder { cap_bands: 0, ..Default::default() }), few("cap bands", 0, 1));
    assert_eq!(ico_sphere(&IcoSphere { frequency: 0 }), few("frequency", 0, 1));
    assert_eq!(cable_bundle(&CableBundle { strands: 0, ..Default::default() }), few("strands", 0, 1));
    assert_eq!(cable_bundle(&CableBundle { segments: 0, ..Default::default() }), few("segments", 0, 1));

    for (p, q) in [(2, 4), (0, 0), (0, 2), (3, 0), (15, 9)] {
        let knot = torus_knot(&TorusKnot { p, q, ..Default::default() });
        assert_eq!(knot, Err(GenerateError::CommonDivisor { p, q }));
    }
    let range = |result: Result<Soup<f64>, GenerateError>| match result {
        Err(GenerateError::OutOfRange { option, .. }) => option,
        other => panic!("{other:?}"),
    };
    for bad in [f64::NAN, f64::INFINITY, -1e4] {
        assert_eq!(range(torus_knot(&TorusKnot { tube_radius: bad, ..Default::default() })), "tube radius");
        assert_eq!(range(cable_bundle(&CableBundle { twists: bad, ..Default::default() })), "twists");
        assert_eq!(range(cable_bundle(&CableBundle { radius: bad, ..Default::default() })), "radius");
        assert_eq!(range(mixed_sizes(&MixedSizes { decades: bad, ..Default::default() })), "decades");
    }
}

#[test]
fn more_primitives_than_ids_are_errors_before_anything_is_made() {
    const MAX: u32 = u32::MAX;
    let kinds = [
        Kind::KnotAndCables(KnotAndCables { rings: MAX, sides: MAX, cables: MAX, ..Default::default() }),
        Kind::TorusKnot(TorusKnot { rings: MAX, sides: MAX, ..Default::default() }),
        Kind::SkewedGear(SkewedGear { teeth: MAX, points: MAX }),
        Kind::Sphere(Sphere { meridians: MAX, bands: MAX }),
        Kind::Cone(Cone { sides: MAX, bands: MAX, cap_bands: MAX }),
        Kind::Cylinder(Cylinder { sides: MAX, bands: MAX, cap_bands: MAX }),
        Kind::IcoSphere(IcoSphere { frequency: MAX }),
        Kind::CableBundle(CableBundle { strands: MAX, segments: MAX, ..Default::default() }),
        Kind::MixedSizes(MixedSizes { triangles: MAX, segments: MAX, points: MAX, ..Default::default() }),
    ];
    for kind in kinds {
        let result = kind.generate();
        assert!(matches!(result, Err(GenerateError::Build(BuildError::TooMany { .. }))), "{kind:?}");
    }
}
