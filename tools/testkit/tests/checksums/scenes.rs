//! The scenes and the queries.

use nalgebra::Point3;
use p2m::scene::generate::{CableBundle, IcoSphere, MixedSizes, SkewedGear, Subdivide};
use p2m::scene::generate::{cable_bundle, ico_sphere, mixed_sizes, skewed_gear, subdivide};
use p2m::scene::{Format, read_scene_from};
use p2m::{PrimitiveSet, Soup};
use p2m_testkit::scenes::{Kinds, Layout, query, soup};
use std::sync::Arc;

/// A scene with its name and its queries.
pub(crate) struct Case {
    pub(crate) name: &'static str,
    pub(crate) soup: Soup<f64>,
    pub(crate) queries: Vec<Point3<f64>>,
    /// Whether the scene consists of triangles that enclose an inside.
    pub(crate) has_inside: bool,
}

/// The scene whose saved indexes are in files.
pub(crate) const SMALLEST: &str = "ties";
/// The number of queries of each scene.
const QUERIES: usize = 60;
/// The scene in the repository, compiled in for machines without files.
const KNOT_AND_CABLES: &[u8] = include_bytes!("../../../../scenes/knot_and_cables.obj");

/// Returns a lump with noise, like a scan.
fn scan() -> Soup<f64> {
    let lump = ico_sphere(&IcoSphere { frequency: 2 }).expect("valid options");
    subdivide(&lump, &Subdivide { levels: 2, amplitude: 0.15, ..Default::default() }).expect("valid options")
}

pub(crate) fn all() -> [Case; 6] {
    let knot = read_scene_from(KNOT_AND_CABLES, Format::Obj, "knot_and_cables.obj").expect("the carried scene");
    let gear = SkewedGear { teeth: 7, points: 20 };
    let cables = CableBundle { strands: 8, segments: 100, ..Default::default() };
    let sizes = MixedSizes { triangles: 600, segments: 300, points: 100, ..Default::default() };
    let ties = soup(&mut p2m_testkit::rng("checksums", 0), Kinds::Mixed, Layout::Lattice, 40);
    [
        ("knot_and_cables", Arc::unwrap_or_clone(knot.soup), false),
        ("skewed_gear", skewed_gear(&gear).expect("valid options"), true),
        ("scan", scan(), true),
        ("cable_bundle", cable_bundle(&cables).expect("valid options"), false),
        ("mixed_sizes", mixed_sizes(&sizes).expect("valid options"), false),
        (SMALLEST, ties, false),
    ]
    .map(|(name, soup, has_inside)| {
        let mut rng = p2m_testkit::rng("queries of checksums", soup.len() as u64);
        let queries = (0..QUERIES).map(|_| query(&mut rng, soup.positions())).collect();
        Case { name, soup, queries, has_inside }
    })
}
