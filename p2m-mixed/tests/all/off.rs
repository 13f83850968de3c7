//! Forms of OFF files, and files that are errors.

use crate::common::{elements, off, p, s, skipped, t};
use nalgebra::Point3;
use p2m_core::Element;
use p2m_mixed::{FileLocation, HeaderProblem, Reason};

const SQUARE: &str = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

#[test]
fn a_bit_of_everything() {
    let file = format!(
        "OFF # a square\n\n# and a point\n5 5 0 # edges do not matter\n{SQUARE}\n0.5 .5 1e0 # top\n\
        4 0 1 2 3 255 0 0\n3 0 1 4 0.5 0.5 0.5 1\n2 0 4 7\n\n1 4\n3\n1 1\n2 # wrapped\n"
    );
    let scene = off(file).unwrap();
    assert_eq!(elements(&scene), [t(0, 1, 2), t(0, 2, 3), t(0, 1, 4), s(0, 4), p(4), t(1, 1, 2)]);
    assert_eq!(scene.sources, [0, 0, 1, 2, 3, 4]);
    assert_eq!(scene.soup.positions()[4], Point3::new(0.5, 0.5, 1.0));
    assert_eq!(skipped(&scene), [("faces with a colour", 3)]);
    assert_eq!(scene.objects, []);
}

#[test]
fn headers_of_the_wild() {
    for header in [
        "OFF\n4 1 0",
        "OFF 4 1 5",
        "OFF 4 1",
        "OFF\n4 1",
        "OFF4 1 0",
        "off\n4 1 0",
        "4 1 0",
        "4 1",
        "# first\n\nOFF\n# then\n4 1 0",
        "OFF\r\n4 1 0\r",
        "\u{feff}OFF\n4 1 0",
        "COFF\n4 1 0",
        "STOFF\n4 1 0",
        "CNOFF\n4 1 0",
        "NCOFF 4 1 0",
        "STCNOFF 4 1",
        "nOFF\n3\n4 1 0",
        "nOFF 3 4 1 0",
        "nOFF 3\n4\n1 0",
    ] {
        let scene = off(format!("{header}\n{SQUARE}3 0 1 2\n")).unwrap();
        assert_eq!(elements(&scene), [t(0, 1, 2)], "{header}");
        assert_eq!((scene.soup.positions().len(), skipped(&scene)), (4, vec![]), "{header}");
    }
}

#[test]
fn colours_and_normals_of_vertices_are_left_out() {
    for (header, extras) in [
        ("COFF", " 255 0 0 255"),
        ("COFF", " 0.5 0.25 1"),
        ("NOFF", "\t0 0 1"),
        ("CNOFF", " 0 0 1 255 0 0 255"),
        ("STOFF", " 0.5 0.5"),
        ("OFF", " 12 13 14"),
    ] {
        let vertices = SQUARE.replace('\n', &format!("{extras}\n"));
        let scene = off(format!("{header}\n4 1 0\n{vertices}3 0 1 2\n")).unwrap();
        assert_eq!(elements(&scene), [t(0, 1, 2)]);
        assert_eq!(scene.soup.positions()[2], Point3::new(1.0, 1.0, 0.0));
        assert_eq!(skipped(&scene), [("vertices with further numbers", 4)]);
    }
}

#[test]
fn a_vertex_may_go_on_over_lines_but_then_nothing_follows_it() {
    let scene = off("OFF 3 1\n0 0\n0 1\n0 0\n0\n1\n0\n3 0 1 2\n").unwrap_err();
    assert_eq!(scene.to_string(), "t.off:3: '1' is more than the header declares for the element on this line");
    assert_eq!(elements(&off("OFF 3 1\n0 0\n0\n1\n0\n0\n0 1\n0\n3 0\n1\n2\n").unwrap()), [t(0, 1, 2)]);
}

#[test]
fn vertices_alone_are_a_point_cloud() {
    let scene = off(format!("OFF 5 0 0\n{SQUARE}nan 0 0")).unwrap();
    assert_eq!(elements(&scene), [p(0), p(1), p(2), p(3)]);
    assert_eq!(scene.sources, [0, 1, 2, 3]);
    assert_eq!(skipped(&scene), [("vertices that are not finite", 1)]);
    assert_eq!(elements(&off("OFF 0 0 0").unwrap()), []);
}

#[test]
fn polygons_of_any_shape() {
    // The face is an arrow, whose reflex corner is the last one.
    let scene = off("OFF 4 1 0\n0 0 0\n4 0 0\n4 4 0\n3 1 0\n4 0 1 2 3\n").unwrap();
    assert_eq!(elements(&scene), [t(1, 2, 3), t(1, 3, 0)]);
}

#[test]
fn data_after_the_last_face_is_counted() {
    let scene = off(format!("OFF 4 1 0\n{SQUARE}3 0 1 2\n7 8 # no word\nx")).unwrap();
    assert_eq!(skipped(&scene), [("words after the last face", 3)]);
}

#[test]
fn errors_have_location_and_reason() {
    let message = |file: &str| off(file).unwrap_err().to_string();
    let with = |rest: &str| format!("OFF\n4 2 0\n{SQUARE}3 0 1 2\n{rest}");
    assert_eq!(
        message(&with("3 0 1 4\n")),
        "t.off:8: vertex index 4 is out of range, the file has 4 vertices, counted from 0"
    );
    assert_eq!(
        message(&with("3 0 1 -1\n")),
        "t.off:8: vertex index -1 is out of range, the file has 4 vertices, counted from 0"
    );
    assert_eq!(message(&with("0\n")), "t.off:8: 1 or more vertices expected, found 0");
    assert_eq!(message(&with("-3 0 1 2\n")), "t.off:8: a list cannot have -3 items");
    assert_eq!(
        message(&with("40000 0 1 2\n")),
        "t.off:8: 40000 vertices are more than the 32768 that are supported here"
    );
    assert_eq!(message(&with("3 0 1 1.5\n")), "t.off:8: '1.5' is not a number that fits here");
    assert_eq!(message(&with("3 0 1 2 red\n")), "t.off:8: 'red' is not a number that fits here");
    assert_eq!(
        message(&with("3 0 1 2 3 0 2 3 1\n")),
        "t.off:8: '1' is more than the header declares for the element on this line"
    );
    assert_eq!(message(&with("")), "t.off:8: unexpected end of file");
    assert_eq!(message("OFF 1 0\n0 0\n"), "t.off:3: unexpected end of file");
    assert_eq!(message("OFF 1 0\n0 x 0\n"), "t.off:2: 'x' is not a number that fits here");
    assert_eq!(message("OFF 1 0\n0 0 0 red\n"), "t.off:2: 'red' is not a number that fits here");
    assert_eq!(
        message("OFF 2 1\n0 0 0\n0 inf 0\n2 0 1\n"),
        "t.off:4: vertex 1 is part of a primitive, but has a coordinate that is not finite"
    );
    assert_eq!(message("OFF 1 0 0 0\n"), "t.off:1: '0' is more than the header declares for the element on this line");
    assert_eq!(message("OFF -1 0 0\n"), "t.off:1: '-1' is not a number that fits here");
    assert_eq!(message(""), "t.off:1: unexpected end of file");
    assert_eq!(
        message("OFF 4294967296 0 0"),
        "t.off:1: 4294967296 vertices are more than the 4294967295 that are supported here"
    );
    assert_eq!(elements(&off("OFF 2 1\n0 0 0\n0 inf 0\n1 0\n").unwrap()), [p(0)], "an unused vertex may be anything");
    for header in ["4OFF", "4nOFF", "C4OFF", "nOFF 2", "nOFF 4\n", "nOFF BINARY"] {
        let error = off(format!("{header}\n1 0 0\n0 0 0 1\n")).unwrap_err();
        assert!(matches!(error.reason, Reason::UnsupportedFormat { .. }), "{header}: {error}");
    }
    for header in ["ply", "v 0 0 0", "xOFF", "OFFx", "OFF8x 1", "nOFF3 1 0 0", "-4 1 0", "COF"] {
        let error = off(format!("{header}\n1 0 0\n0 0 0\n")).unwrap_err();
        assert!(matches!(error.reason, Reason::BadHeader(HeaderProblem::NotOff { .. })), "{header}: {error}");
        assert_eq!(error.location, FileLocation::Line(1));
    }
}

/// Returns numbers in the byte order of binary files.
fn be(numbers: &[i32]) -> Vec<u8> {
    numbers.iter().flat_map(|n| n.to_be_bytes()).collect()
}

fn floats(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|n| n.to_be_bytes()).collect()
}

#[test]
fn binary_files() {
    let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.1, 0.0], [0.0, 0.1, f32::NAN]];
    for (header, extras) in
        [("OFF BINARY\n", 0), ("NOFF BINARY\n", 3), ("STCNOFF binary # x\r\n", 9), ("OFF BINARY\r", 0)]
    {
        let mut file = header.as_bytes().to_vec();
        file.extend(be(&[4, 3, 0]));
        for vertex in square {
            file.extend(floats(&vertex));
            file.extend(floats(&vec![7.0; extras]));
        }
        file.extend(be(&[3, 0, 1, 2, 0]));
        file.extend(be(&[2, 0, 2, 4]));
        file.extend(floats(&[1.0, 0.0, 0.0, 1.0]));
        file.extend(be(&[1, 1, 1, 99]));
        let scene = off(&file).unwrap();
        assert_eq!(elements(&scene), [t(0, 1, 2), s(0, 2), p(1)], "{header}");
        assert_eq!(scene.soup.positions()[2], Point3::new(1.0, f64::from(0.1f32), 0.0));
        let expected = [("vertices with further numbers", 4), ("faces with a colour", 2)];
        assert_eq!(skipped(&scene), expected[usize::from(extras == 0)..]);
        // Every number of the file is needed.
        for end in header.len()..file.len() {
            let error = off(&file[..end]).unwrap_err();
            assert!(matches!(error.reason, Reason::UnexpectedEnd), "{error}");
        }
        let location = file.len() - 16;
        file.extend(b"abc");
        assert_eq!(off(&file).unwrap().skipped.last().unwrap().to_string(), "3 bytes after the last face");
        file[location + 7] = 3;
        let error = off(&file).unwrap_err();
        assert_eq!(error.location, FileLocation::Byte(location as u64 + 4), "{error}");
        assert!(matches!(error.reason, Reason::NonFiniteVertex { index: 3 }), "{error}");
        file[location + 7] = 4;
        assert!(matches!(off(&file).unwrap_err().reason, Reason::NoSuchVertex { index: 4, count: 4 }));
    }
    let error = off([b"OFF BINARY\n".to_vec(), be(&[-1, 0, 0])].concat()).unwrap_err();
    assert_eq!(
        (error.location, error.to_string().as_str()),
        (FileLocation::Byte(11), "t.off at byte 11: a list cannot have -1 items")
    );
    let file = [b"OFF BINARY\n".to_vec(), be(&[1, 1, 0]), floats(&[0.0; 3]), be(&[1, 0, 5, 0, 0, 0, 0, 0])].concat();
    assert!(matches!(off(file).unwrap_err().reason, Reason::BadListCount { count: 5 }));
}

#[test]
fn every_face_of_a_large_count_is_what_it_says() {
    let n = 100u32;
    let mut file = format!("OFF\n{n} {n} 0\n");
    (0..n).for_each(|i| file += &format!("{i} {} 0\n", i * i));
    (0..n).for_each(|i| file += &format!("3 {i} {} {}\n", (i + 1) % n, (i + 7) % n));
    let expected: Vec<Element> = (0..n).map(|i| t(i, (i + 1) % n, (i + 7) % n)).collect();
    assert_eq!(elements(&off(file).unwrap()), expected);
}
