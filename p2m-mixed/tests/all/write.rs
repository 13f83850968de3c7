//! Scenes are written and read again in every format.

use crate::common::{bits, elements, formats_of_triangles, lossless, obj, p, ply, read_back, s, t, written};
use nalgebra::Point3;
use p2m_core::{Element, PrimitiveSet, Soup};
use p2m_mixed::{
    Format, HeaderProblem, Reason, Scene, WriteError, stl_rounding, write_ply_ascii, write_scene, write_stl,
};

fn scene(positions: Vec<Point3<f64>>, elements: impl IntoIterator<Item = Element>) -> Scene {
    Soup::new(positions, elements).unwrap().into()
}

/// Numbers that are hard to write without loss.
fn awkward() -> Vec<Point3<f64>> {
    let values =
        [0.0, -0.0, 0.1, -1.0 / 3.0, 1e300, -1e-300, 5e-324, f64::MAX, f64::MIN_POSITIVE, 123_456_789.123_456_79, 1.0];
    let at = |i: usize| values[i % values.len()];
    (0..values.len()).map(|i| Point3::new(at(i), at(i + 3), at(i + 7))).collect()
}

fn ascii(scene: &Scene) -> Scene {
    let mut text = Vec::new();
    write_ply_ascii(scene, &mut text).unwrap();
    assert!(text.is_ascii());
    ply(text).unwrap()
}

fn check_same(scene: &Scene) {
    for format in lossless() {
        let again = read_back(scene, format);
        assert_eq!(again.soup, scene.soup, "{format}");
        assert_eq!(bits(&again), bits(scene), "{format}");
        assert!(again.skipped.is_empty(), "{format}");
    }
    assert_eq!((ascii(scene).soup, bits(&ascii(scene))), (scene.soup.clone(), bits(scene)));
}

#[test]
fn every_order_of_kinds_comes_back_with_its_ids() {
    for length in 1..=6u32 {
        for code in 0..3usize.pow(length) {
            let kinds = [p(3), s(10, 0), t(2, 2, 9)];
            check_same(&scene(awkward(), (0..length).map(|i| kinds[code / 3usize.pow(i) % 3])));
        }
    }
}

#[test]
fn kinds_in_a_row_need_no_ids_in_a_ply_file() {
    let header = |elements: &[Element]| {
        let file = written(&scene(awkward(), elements.iter().copied()), Format::Ply);
        let end = file.windows(10).position(|w| w == b"end_header").unwrap();
        String::from_utf8(file[..end].to_vec()).unwrap()
    };
    let names = |header: &str| -> Vec<String> {
        header.lines().filter_map(|l| l.strip_prefix("element ")).map(str::to_owned).collect()
    };
    let h = header(&[p(1), p(2), t(0, 1, 2), s(1, 2), s(1, 3)]);
    assert_eq!(names(&h), ["vertex 11", "point 2", "face 1", "edge 2"]);
    assert!(!h.contains("p2m_id"));
    let h = header(&[p(1), t(0, 1, 2), p(1)]);
    assert_eq!(names(&h), ["vertex 11", "face 1", "point 2"]);
    assert_eq!(h.matches("property int p2m_id").count(), 2);
    // A point cloud is one for every program.
    assert_eq!(names(&header(&(0..11).map(p).collect::<Vec<_>>())), ["vertex 11"]);
    assert_eq!(names(&header(&(1..11).map(p).collect::<Vec<_>>())), ["vertex 11", "point 10"]);
}

#[test]
fn points_that_are_not_all_vertices_stay_what_they_are() {
    check_same(&scene(awkward(), (0..11).map(p)));
    check_same(&scene(awkward(), (0..10).map(p)));
    check_same(&scene(awkward(), (0..11).rev().map(p)));
    check_same(&scene(awkward(), [p(4), p(4), p(4)]));
    check_same(&scene(vec![Point3::origin()], [p(0)]));
    check_same(&scene(Vec::new(), []));
}

#[test]
fn positions_without_primitives_survive_in_ply_and_p2m_only() {
    let empty = scene(awkward(), []);
    let nothing = scene(Vec::new(), []);
    for format in lossless() {
        let again = read_back(&empty, format);
        // The file is not read as a point cloud.
        assert_eq!(again.soup.len(), 0, "{format}");
        assert_eq!(
            bits(&again),
            bits(if matches!(format, Format::Ply | Format::P2m) { &empty } else { &nothing }),
            "{format}"
        );
    }
    assert_eq!(bits(&ascii(&empty)), bits(&empty));
    assert_eq!(read_back(&empty, Format::Stl).soup, nothing.soup);
}

#[test]
fn unused_positions_that_are_not_finite() {
    let nan = f64::from_bits(f64::NAN.to_bits() | 1 << 63 | 12345);
    let bad = [Point3::new(nan, 1.0, -0.0), Point3::new(1.0, f64::NEG_INFINITY, f64::INFINITY)];
    let with_bad = scene(vec![bad[0], Point3::new(1.0, 2.0, 3.0), bad[1]], [p(1), s(1, 1), p(1)]);
    assert_eq!(bits(&read_back(&with_bad, Format::Ply)), bits(&with_bad));
    for format in [Format::Obj, Format::Off] {
        let again = read_back(&with_bad, format);
        assert_eq!(elements(&again), elements(&with_bad));
        assert_eq!(again.soup.positions(), [Point3::origin(), Point3::new(1.0, 2.0, 3.0), Point3::origin()]);
    }
    let again = ascii(&with_bad);
    assert!(again.soup.positions()[0].x.is_nan());
    assert_eq!(again.soup.positions()[2], bad[1]);
    assert_eq!(elements(&again), elements(&with_bad));
}

#[test]
fn objects_survive_in_obj() {
    let text = "v 0 0 0\no a\np 1\np 1\no\np 1\no b # c\np 1\no  a \np 1\no a\no d\np 1\no\np 1\n";
    let scene = obj(text).unwrap();
    let objects: Vec<_> = scene.objects.iter().map(|o| (o.name.as_str(), o.ids.clone())).collect();
    assert_eq!(objects, [("a", 0..2), ("b # c", 3..4), ("a", 4..5), ("d", 5..6)]);
    assert_eq!(read_back(&scene, Format::Obj).objects, scene.objects);
    assert_eq!(read_back(&scene, Format::Ply).objects, []);

    // These names cannot be written on a line as they are.
    let mut named = obj("v 0 0 0\no a\np 1\no b\np 1\no c\np 1\n").unwrap();
    named.objects[0].name = "path\\".to_owned();
    named.objects[1].name = " two\r\nlines ".to_owned();
    named.objects[2].name = "\\".to_owned();
    let again = read_back(&named, Format::Obj);
    assert_eq!(again.soup, named.soup);
    let names: Vec<_> = again.objects.iter().map(|o| (o.name.as_str(), o.ids.clone())).collect();
    assert_eq!(names, [("path\\", 0..1), ("two  lines", 1..2), ("\\", 2..3)]);

    // Invalid objects, which no reader makes, do not cause a panic.
    named.objects[0].ids = 1..9;
    named.objects[1].ids = 2..2;
    named.objects[2].ids = 0..2;
    assert_eq!(read_back(&named, Format::Obj).soup, named.soup);
    // Valid objects among them are written.
    named.objects[0].ids = 0..0;
    named.objects[1].ids = 0..1;
    named.objects[2].ids = 2..3;
    let again = read_back(&named, Format::Obj);
    assert_eq!(again.soup, named.soup);
    let ids: Vec<_> = again.objects.iter().map(|o| o.ids.clone()).collect();
    assert_eq!(ids, [0..1, 2..3]);
}

#[test]
fn stl_comes_back_where_nothing_is_rounded_and_vertices_are_used_in_order() {
    let positions: Vec<_> = (0..5).map(|i| Point3::new(i as f64, f64::from(0.1f32 * (i * i) as f32), -1.0)).collect();
    let fan = scene(positions, [t(0, 1, 2), t(0, 2, 3), t(3, 2, 4), t(4, 4, 4)]);
    assert_eq!(stl_rounding(&fan), Default::default());
    let again = read_back(&fan, Format::Stl);
    assert_eq!((&again.soup, bits(&again)), (&fan.soup, bits(&fan)));
}

#[test]
fn stl_numbers_vertices_anew_and_merges_equal_ones() {
    let at = |x: f64| Point3::new(x, 0.0, 0.0);
    let before = scene(vec![at(7.0), at(1.0), at(0.1), at(1.0), at(-0.0)], [t(2, 1, 3), t(3, 4, 4)]);
    let again = read_back(&before, Format::Stl);
    assert_eq!(elements(&again), [t(0, 1, 1), t(1, 2, 2)]);
    assert_eq!(again.soup.positions(), [at(f64::from(0.1f32)), at(1.0), at(0.0)]);
    assert!(again.soup.positions()[2].x.is_sign_negative());
    let rounding = stl_rounding(&before);
    assert_eq!((rounding.count, rounding.largest), (1, (0.1 - f64::from(0.1f32)).abs()));
}

#[test]
fn rounding_counts_each_coordinate_of_a_used_vertex_once() {
    let positions = vec![
        Point3::new(16_777_217.0, 16_777_219.0, 1.0), // 2^24 + 1 and + 3
        Point3::new(0.1, 0.0, 0.0),
        Point3::new(0.3, 0.3, 1e300),        // not used by a triangle
        Point3::new(33_554_433.5, 0.0, 0.0), // 2^25 + 1.5: rounds to 2^25
    ];
    let rounding = stl_rounding(&scene(positions.clone(), [t(3, 1, 1), t(1, 0, 3), s(2, 2)]));
    assert_eq!((rounding.count, rounding.largest), (4, 1.5));
    let rounding = stl_rounding(&scene(positions, [t(0, 1, 2)]));
    assert_eq!((rounding.count, rounding.largest), (6, f64::INFINITY));
}

#[test]
fn scenes_beyond_stl_are_errors_before_anything_is_written() {
    let at = |x: f64| Point3::new(x, 0.0, 0.0);
    let refused = |elements: &[Element], positions: Vec<_>| {
        let mut file = Vec::new();
        let error = write_scene(&scene(positions, elements.iter().copied()), Format::Stl, &mut file).unwrap_err();
        assert!(file.is_empty());
        error.to_string()
    };
    assert_eq!(
        refused(&[t(0, 0, 0), s(0, 0)], vec![at(0.0)]),
        "primitive 1 is no triangle, and an STL file holds nothing else"
    );
    assert_eq!(refused(&[p(0)], vec![at(0.0)]), "primitive 0 is no triangle, and an STL file holds nothing else");
    // This is the smallest number that is rounded to infinity.
    let above = f64::from(f32::MAX) + 0.5 * (2.0f64.powi(128) - f64::from(f32::MAX));
    assert_eq!(
        refused(&[t(1, 1, 1), t(1, 0, 1)], vec![at(-above), at(above.next_down())]),
        "primitive 1 has a coordinate -3.4028235677973366e38, which is beyond the single precision of an STL file"
    );
    let largest = scene(vec![at(above.next_down())], [t(0, 0, 0)]);
    assert_eq!(read_back(&largest, Format::Stl).soup.positions(), [at(f64::from(f32::MAX))]);
}

#[test]
fn stl_files_have_unit_normals_where_there_are_any() {
    let tiny = f64::from(f32::from_bits(1));
    let positions = vec![
        Point3::origin(),
        Point3::new(3.0, 0.0, 0.0),
        Point3::new(0.0, 0.0, 2.0),
        Point3::new(tiny, 0.0, 0.0),
        Point3::new(0.0, tiny, 0.0),
        Point3::new(3e38, 0.0, 0.0),
        Point3::new(0.0, -3e38, 0.0),
    ];
    let file = written(&scene(positions, [t(0, 1, 2), t(0, 3, 4), t(0, 1, 3), t(0, 5, 6)]), Format::Stl);
    assert!(!file.starts_with(b"solid"));
    let normals: Vec<[f32; 3]> = file[84..]
        .chunks(50)
        .map(|facet| std::array::from_fn(|k| f32::from_le_bytes(facet[4 * k..4 * k + 4].try_into().unwrap())))
        .collect();
    assert_eq!(normals, [[0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0], [0.0, 0.0, -1.0]]);
}

#[test]
fn a_soup_is_a_scene_of_statements_of_their_own() {
    let scene = scene(awkward(), [p(0), t(0, 1, 2), p(1), s(0, 1), t(0, 1, 2), p(2)]);
    assert_eq!(scene.sources, [0, 0, 1, 0, 1, 2]);
    assert!(scene.objects.is_empty() && scene.skipped.is_empty());
    assert_eq!(read_back(&scene, Format::Obj), scene);
}

/// A writer that returns an error after this number of bytes.
struct Full(usize);

impl std::io::Write for Full {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0 = self.0.checked_sub(bytes.len()).ok_or(std::io::ErrorKind::StorageFull)?;
        Ok(bytes.len())
    }
    fn flush(&mut self) -> std::io::Result<()> {
        if self.0 == 0 { Err(std::io::ErrorKind::StorageFull.into()) } else { Ok(()) }
    }
}

#[test]
fn a_full_disk_is_reported_wherever_it_is_noticed() {
    let scene = scene(awkward()[..3].iter().map(|p| p.map(|x| x.clamp(-1.0, 1.0))).collect(), [t(0, 1, 2)]);
    for format in formats_of_triangles() {
        let length = written(&scene, format).len();
        for room in 0..=length {
            let error = write_scene(&scene, format, Full(room)).unwrap_err();
            assert!(matches!(&error, WriteError::Io(e) if e.kind() == std::io::ErrorKind::StorageFull), "{error}");
        }
        write_scene(&scene, format, Full(length + 1)).unwrap();
    }
    assert!(write_stl(&scene, Full(83)).is_err());
}

/// Returns a text PLY file with three vertices, these elements and rows.
fn ply_with(elements: &str, rows: &str) -> Result<Scene, p2m_mixed::ReadError> {
    let xyz = "property float x\nproperty float y\nproperty float z";
    ply(format!(
        "ply\nformat ascii 1.0\nelement vertex 3\n{xyz}\n{elements}\nend_header\n0 0 0\n1 0 0\n0 1 0\n{rows}\n"
    ))
}

const FACES: &str = "property list uchar int vertex_indices\nproperty int p2m_id";

#[test]
fn ids_in_ply_files_decide_the_order() {
    let edges = "element edge 1\nproperty int p2m_id\nproperty int vertex2\nproperty int vertex1";
    let points = "element point 1\nproperty short vertex_index\nproperty uchar p2m_id";
    let scene =
        ply_with(&format!("element face 2\n{FACES}\n{edges}\n{points}"), "3 0 1 2 3\n3 2 1 0 0\n2 1 0\n2 1").unwrap();
    assert_eq!(elements(&scene), [t(2, 1, 0), p(2), s(0, 1), t(0, 1, 2)]);
    assert_eq!(scene.sources, [1, 0, 0, 0]);
    assert!(scene.skipped.is_empty());
    check_same(&scene);
    // The element may come before the vertices.
    let text = "ply\nformat ascii 1.0\nelement face 2\nproperty list uchar int vertex_indices\nproperty int p2m_id\n\
        element vertex 3\nproperty float x\nproperty float y\nproperty float z\nend_header\n3 0 1 2 1\n3 2 1 0 0\n0 0 0\n\
        1 0 0\n0 1 0\n";
    assert_eq!(elements(&ply(text).unwrap()), [t(2, 1, 0), t(0, 1, 2)]);
}

#[test]
fn invalid_ids_in_ply_files_are_errors() {
    let message = |elements: &str, rows: &str| ply_with(elements, rows).unwrap_err().to_string();
    let faces = format!("element face 2\n{FACES}");
    assert_eq!(
        message(&faces, "3 0 1 2 0\n3 2 1 0 2"),
        "t.ply:15: primitive id 2 is out of range or there twice, the file has 2 primitives"
    );
    assert_eq!(
        message(&faces, "3 0 1 2 0\n3 2 1 0 -1"),
        "t.ply:15: primitive id -1 is out of range or there twice, the file has 2 primitives"
    );
    assert_eq!(
        message(&faces, "3 0 1 2 1\n3 2 1 0 1"),
        "t.ply: primitive id 1 is out of range or there twice, the file has 2 primitives"
    );
    assert_eq!(
        message(&faces, "4 0 1 2 1 0\n3 2 1 0 1"),
        "t.ply:14: 4 vertices are more than the 3 that are supported here"
    );
    let without = format!("{faces}\nelement edge 1\nproperty int vertex1\nproperty int vertex2");
    assert_eq!(message(&without, ""), "t.ply: bad header: element 'edge' has no property 'p2m_id'");
    let strips = format!("{faces}\nelement tristrips 1\nproperty list int int vertex_indices\nproperty int p2m_id");
    assert_eq!(message(&strips, ""), "t.ply: bad header: element 'tristrips' has no property 'p2m_id'");
    let float = "element face 1\nproperty list uchar int vertex_indices\nproperty float p2m_id";
    let error = ply_with(float, "").unwrap_err();
    assert!(matches!(error.reason, Reason::BadHeader(HeaderProblem::BadType { .. })), "{error}");
    // An element without members needs no properties.
    let none = without.replace("edge 1", "edge 0");
    assert_eq!(elements(&ply_with(&none, "3 0 1 2 1\n3 2 1 0 0").unwrap()), [t(2, 1, 0), t(0, 1, 2)]);
}

#[test]
fn vertices_that_are_not_finite_are_found_whatever_the_order() {
    let text = |with_id: bool, faces_first: bool| {
        let id = if with_id { "property int p2m_id\n" } else { "" };
        let vertices = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
        let faces = format!("element face 1\nproperty list uchar int vertex_indices\n{id}");
        let rows = ["0 0 0\n1 nan 0\n0 1 0\n", if with_id { "3 0 1 2 0\n" } else { "3 0 1 2\n" }];
        let (header, rows) = if faces_first {
            (faces + vertices, format!("{}{}", rows[1], rows[0]))
        } else {
            (vertices.to_owned() + &faces, rows.concat())
        };
        format!("ply\nformat ascii 1.0\n{header}end_header\n{rows}")
    };
    for (with_id, faces_first) in [(false, false), (false, true), (true, false), (true, true)] {
        let file = text(with_id, faces_first);
        let line = 1 + file.lines().position(|l| l.contains("nan")).unwrap();
        let error = ply(&file).unwrap_err();
        assert_eq!(
            error.to_string(),
            format!("t.ply:{line}: vertex 1 is part of a primitive, but has a coordinate that is not finite"),
            "{file}"
        );
    }
}

#[test]
fn elements_of_points_are_primitives_if_they_name_vertices() {
    let scene = ply_with("element point 2\nproperty int vertex_index", "2\n0").unwrap();
    assert_eq!(elements(&scene), [p(2), p(0)]);
    assert_eq!(scene.sources, [0, 1]);
    let scene = ply_with("element point 0\nproperty int vertex_index", "").unwrap();
    assert_eq!((elements(&scene).len(), scene.soup.positions().len()), (0, 3));
    // The element of this name has another meaning.
    let scene = ply_with("element point 1\nproperty float x", "0.5").unwrap();
    assert_eq!(elements(&scene), [p(0), p(1), p(2)]);
    assert_eq!(crate::common::skipped(&scene), [("element point", 1)]);
}

#[test]
fn primitives_before_and_behind_their_vertices_keep_the_order_of_the_file() {
    let text = "ply\nformat ascii 1.0\nelement face 2\nproperty list uchar int vertex_indices\nelement vertex 4\n\
        property float x\nproperty float y\nproperty float z\nelement edge 1\nproperty int vertex1\nproperty int vertex2\n\
        element point 1\nproperty int vertex_index\nend_header\n3 0 1 2\n4 0 1 2 3\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 3\n2\n";
    let scene = ply(text).unwrap();
    assert_eq!(elements(&scene), [t(0, 1, 2), t(0, 1, 2), t(0, 2, 3), s(0, 3), p(2)]);
    assert_eq!(scene.sources, [0, 1, 1, 0, 0]);
}
