//! Stand-ins for real meshes: a small file of each kind, so that the tests of real meshes run everywhere.

use crate::rng;
use nalgebra::Point3;
use p2m_core::{Element, Soup};
use p2m_mixed::generate::{CableBundle, IcoSphere, KnotAndCables, Subdivide, TorusKnot};
use p2m_mixed::generate::{cable_bundle, ico_sphere, knot_and_cables, subdivide, torus_knot};
use p2m_mixed::{Format, write_scene};
use rand::RngExt;
use std::f64::consts::TAU;
use std::path::Path;

/// Returns the names and contents of all files.
pub(crate) fn files() -> Vec<(&'static str, Vec<u8>)> {
    let knot = torus_knot(&TorusKnot { rings: 60, sides: 8, ..Default::default() }).expect("valid");
    let ball = ico_sphere(&IcoSphere { frequency: 5 }).expect("valid");
    let rough = subdivide(&ball, &Subdivide { levels: 1, amplitude: 0.1, ..Default::default() }).expect("valid");
    let wires = KnotAndCables { rings: 40, sides: 8, cables: 4, cable_segments: 60 };
    let lines = CableBundle { strands: 6, segments: 100, ..Default::default() };
    let scenes = [
        ("non_manifold.ply", non_manifold(&ball)),
        ("scan.obj", knot),
        ("scan.off", ball),
        ("scan.ply", rough),
        ("slivers.stl", slivers()),
        ("mixed.obj", knot_and_cables(&wires).expect("valid")),
        ("lines.obj", cable_bundle(&lines).expect("valid")),
        ("city_far_from_origin.obj", city()),
        ("zero_area.off", zero_area()),
    ];
    let file = |(name, scene): (&'static str, Soup<f64>)| {
        let mut content = Vec::new();
        let format = Format::from_path(Path::new(name)).expect("known");
        write_scene(&scene.into(), format, &mut content).expect("the format can have it");
        (name, content)
    };
    scenes.map(file).into()
}

/// Returns a closed cylinder as CAD programs write it: 300 facets of long triangles, and two fans.
fn slivers() -> Soup<f64> {
    let rim = |i: u32, z: f64| {
        let angle = TAU * f64::from(i) / 300.0;
        Point3::new(angle.cos(), angle.sin(), z)
    };
    let mut positions: Vec<_> = (0..600).map(|i| rim(i / 2, f64::from(i % 2) * 60.0)).collect();
    positions.extend([Point3::origin(), Point3::new(0.0, 0.0, 60.0)]);
    let triangles = (0..300).flat_map(|i| {
        let [a, b, c, d] = [2 * i, 2 * i + 1, (2 * i + 2) % 600, (2 * i + 3) % 600];
        [[a, c, b], [b, c, d], [c, a, 600], [b, d, 601]].map(Element::Triangle)
    });
    Soup::new(positions, triangles.collect::<Vec<_>>()).expect("finite")
}

/// Returns a scan with fins, so that edges have three triangles, and with triangles twice.
fn non_manifold(scan: &Soup<f64>) -> Soup<f64> {
    let triangles = scan.triangles();
    let fins: Vec<_> = triangles.iter().step_by(7).map(|t| (scan.positions()[t[0] as usize] * 1.25, *t)).collect();
    let mut positions = scan.positions().to_vec();
    let mut elements: Vec<_> = scan.elements().collect();
    for (apex, [a, b, _]) in fins {
        elements.push(Element::Triangle([a, b, u32::try_from(positions.len()).expect("small")]));
        positions.push(apex);
    }
    elements.extend(triangles.iter().step_by(11).map(|t| Element::Triangle(*t)));
    Soup::new(positions, elements).expect("finite")
}

/// Returns flat roofs and walls in the metres of a national grid, with walls in common planes and of zero area.
fn city() -> Soup<f64> {
    let mut rng = rng("city", 0);
    let (mut positions, mut elements) = (Vec::new(), Vec::new());
    for house in 0..64 {
        let first = u32::try_from(positions.len()).expect("small");
        let [x, y] = [90_706.125 + 12.1 * f64::from(house % 8), 435_500.37 + 15.3 * f64::from(house / 8)];
        let height = f64::from(rng.random_range(30..250)) / 10.0;
        for corner in 0..8 {
            let at = |bit: u32, size: f64| if corner & bit == 0 { 0.0 } else { size };
            positions.push(Point3::new(x + at(1, 12.1), y + at(2, 9.7), at(4, height)));
        }
        let faces = [[4, 5, 7, 6], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6]];
        let corners = faces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).chain([[4, 5, 4]]);
        elements.extend(corners.map(|triangle| Element::Triangle(triangle.map(|i: u32| i + first))));
    }
    Soup::new(positions, elements).expect("finite")
}

/// Returns four triangles of a pyramid and four without area.
fn zero_area() -> Soup<f64> {
    let positions =
        [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 4.0, 0.0], [0.0, 4.0, 0.0], [2.0, 2.0, 3.0], [2.0, 0.0, 0.0]];
    let triangles = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [0, 5, 1], [0, 0, 1], [4, 4, 4], [5, 1, 0]];
    Soup::new(positions.map(Point3::from).to_vec(), triangles.map(Element::Triangle).to_vec()).expect("finite")
}
