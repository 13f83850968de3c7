//! Models and their stand-ins have the numbers of primitives that a list states.

use crate::common::{bits, lossless, read_back};
use p2m_mixed::{Format, WriteError, read_scene, stl_rounding, write_stl};
use std::path::PathBuf;

/// The name of a model and its numbers of triangles and segments.
const MODELS: &[(&str, usize, usize)] = &[
    ("bunny.obj", 28_576, 0),
    ("armadillo.obj", 86_482, 0),
    ("dragon_100k.obj", 100_000, 0),
    ("lucy_100k.ply", 99_970, 0),
    ("dragon_871k.ply", 871_414, 0),
    ("dragon_48k_nonmanifold.ply", 47_794, 0),
    ("bunny_subdivided_278k.ply", 277_804, 0),
    ("gear_skewed_57k.ply", 56_692, 0),
    ("gear_skewed_57k_rotated.ply", 56_692, 0),
    ("mixed_armadillo_camel_wireframe.obj", 86_482, 29_304),
    ("rotterdam_city_far_from_origin.obj", 38_772, 0),
    ("hotel_room_nonmanifold.ply", 99_029, 0),
    ("heavily_nonmanifold.obj", 41_262, 0),
    ("political_borders_lines.obj", 0, 94_161),
    ("track_lines.obj", 0, 16_266),
    ("rings_lines.obj", 0, 6_144),
    ("degenerate_small.obj", 24, 0),
    // The file has 40,211 faces, some of which are quadrilaterals.
    ("sponza_66k.obj", 66_450, 0),
    ("camel.off", 19_536, 0),
    ("gear_diff_ring.stl", 57_640, 0),
    ("thingi10k_1514499_slivers.stl", 26_700, 0),
    ("thingi10k_73416.stl", 76_840, 0),
    ("degenerate_sliding.off", 8, 0),
    ("zero_area_triangle.stl", 14, 0),
    ("scan.obj", 960, 0),
    ("scan.off", 500, 0),
    ("scan.ply", 2000, 0),
    ("slivers.stl", 1200, 0),
    ("non_manifold.ply", 618, 0),
    ("mixed.obj", 640, 240),
    ("lines.obj", 0, 600),
    ("city_far_from_origin.obj", 704, 0),
    ("zero_area.off", 8, 0),
];

#[test]
fn models_have_the_counts_of_their_list() {
    for (path, name, [triangles, segments]) in models() {
        let scene = read_scene(&path).unwrap();
        let found = (scene.soup.triangles().len(), scene.soup.segments().len(), scene.soup.points().len());
        assert_eq!(found, (triangles, segments, 0), "{name}");
    }
    for path in p2m_testkit::all_model_files() {
        assert!(MODELS.iter().any(|(name, ..)| path.ends_with(name)), "{} is not in the list", path.display());
    }
}

/// Returns the models of this depth, with their names and their numbers of triangles and segments.
fn models() -> impl Iterator<Item = (PathBuf, &'static str, [usize; 2])> {
    MODELS
        .iter()
        .filter_map(|&(name, triangles, segments)| Some((p2m_testkit::model_file(name)?, name, [triangles, segments])))
}

#[test]
fn models_are_written_and_read_back_as_the_same_scene() {
    for (path, name, [_, segments]) in models() {
        let scene = read_scene(&path).unwrap();
        for format in lossless() {
            let again = read_back(&scene, format);
            assert_eq!(again.soup, scene.soup, "{name} as {format}");
            assert_eq!(bits(&again), bits(&scene), "{name} as {format}");
        }
        assert_eq!(read_back(&scene, Format::Obj).objects, scene.objects, "{name}");
        if segments > 0 {
            let error = write_stl(&scene, Vec::new()).unwrap_err();
            assert!(matches!(error, WriteError::NotATriangle { .. }), "{name}: {error}");
            continue;
        }
        // The corners of each triangle are compared in single precision, because positions get other numbers.
        let again = read_back(&scene, Format::Stl);
        let (before, after) = (scene.soup.triangles(), again.soup.triangles());
        assert_eq!(before.len(), after.len(), "{name}");
        let rounding = stl_rounding(&scene);
        let mut largest = 0.0f64;
        for (&i, &j) in before.as_flattened().iter().zip(after.as_flattened()) {
            let (p, q) = (scene.soup.positions()[i as usize], again.soup.positions()[j as usize]);
            assert_eq!(p.map(|x| f64::from(x as f32)), q, "{name}");
            largest = largest.max((p - q).amax());
        }
        assert_eq!(rounding.largest, largest, "{name}");
        assert_eq!(rounding.count == 0, largest == 0.0, "{name}");
        if name.ends_with(".stl") {
            assert_eq!(rounding.count, 0, "{name}");
            assert_eq!((&again.soup, bits(&again)), (&scene.soup, bits(&scene)), "{name}");
        }
    }
}
