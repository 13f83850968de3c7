//! Forms of PLY files, and files that are errors.

use crate::common::{ENCODINGS, Encoding, N, Ply, elements, p, ply, rich_ply, s, skipped, t};
use nalgebra::Point3;
use p2m_core::Element;
use p2m_mixed::{FileLocation, HeaderProblem, PointFormat, ReadError, Reason, read_points_from};

const XYZ: &str = "property float x\nproperty float y\nproperty float z";
const LIST: &str = "property list uchar int vertex_indices";

/// Returns a file with the four vertices of a square and these faces.
fn square(encoding: Encoding, faces: &[&[i32]]) -> Ply {
    let header = format!("element vertex 4\n{XYZ}\nelement face {}\n{LIST}", faces.len());
    let file = Ply::new(encoding, &header)
        .float_row([0.0, 0.0, 0.0])
        .float_row([1.0, 0.0, 0.0])
        .float_row([1.0, 1.0, 0.0])
        .float_row([0.0, 1.0, 0.0]);
    faces.iter().fold(file, |file, face| file.list(face))
}

#[test]
fn a_bit_of_everything_is_the_same_in_every_encoding() {
    let scenes = ENCODINGS.map(|e| ply(rich_ply(e)).unwrap());
    assert_eq!(scenes[0], scenes[1]);
    assert_eq!(scenes[0], scenes[2]);
    let found = elements(&scenes[0]);
    assert_eq!(found[..3], [t(0, 1, 2), t(0, 1, 2), t(0, 2, 3)]);
    assert!(found[3..6].iter().all(|e| matches!(e, Element::Triangle(_))));
    assert_eq!(found[6..], [s(0, 5), s(5, 1), t(0, 1, 2), t(2, 1, 3), t(3, 4, 5)]);
    assert_eq!(scenes[0].sources, [0, 1, 1, 2, 2, 2, 0, 1, 3, 3, 3]);
    assert_eq!(scenes[0].soup.positions()[5], Point3::new(0.5, 0.5, 7.0));
    assert_eq!(
        skipped(&scenes[0]),
        [
            ("property flags of face", 3),
            ("property bones of vertex", 6),
            ("property weight of edge", 2),
            ("element material", 2)
        ]
    );
}

#[test]
fn every_type_under_both_names() {
    let values: [(&str, &str, N); 8] = [
        ("char", "int8", N::I8(-3)),
        ("uchar", "uint8", N::U8(200)),
        ("short", "int16", N::I16(-300)),
        ("ushort", "uint16", N::U16(60_000)),
        ("int", "int32", N::I32(-70_000)),
        ("uint", "uint32", N::U32(4_000_000_000)),
        ("float", "float32", N::F32(0.25)),
        ("double", "float64", N::F64(0.1)),
    ];
    let expected = [-3.0, 200.0, -300.0, 60_000.0, -70_000.0, 4e9, 0.25, 0.1];
    for encoding in ENCODINGS {
        for (i, &(old, new, _)) in values.iter().enumerate() {
            for name in [old, new] {
                let (_, other_type, other) = values[(i + 3) % 8];
                // Properties are in another order, and lists of every type are between them.
                let header = format!(
                    "element vertex 1\nproperty {other_type} z\nproperty list uchar {name} more\nproperty {name} x\nproperty {name} y"
                );
                let value = values[i].2;
                let file = Ply::new(encoding, &header).row(&[other, N::U8(3), value, value, value, value, value]);
                let scene = file.read().unwrap();
                let point = Point3::new(expected[i], expected[i], expected[(i + 3) % 8]);
                assert_eq!(scene.soup.positions(), [point], "{encoding:?} {name}");
            }
        }
    }
}

#[test]
fn counts_and_indices_of_every_integer_type() {
    for encoding in ENCODINGS {
        for (count_type, count) in [
            ("char", N::I8(3)),
            ("uchar", N::U8(3)),
            ("short", N::I16(3)),
            ("ushort", N::U16(3)),
            ("int", N::I32(3)),
            ("uint", N::U32(3)),
        ] {
            for (item_type, items) in [
                ("int8", [0, 1, 2].map(N::I8)),
                ("uint8", [0, 1, 2].map(N::U8)),
                ("int16", [0, 1, 2].map(N::I16)),
                ("uint16", [0, 1, 2].map(N::U16)),
                ("int32", [0, 1, 2].map(N::I32)),
                ("uint32", [0, 1, 2].map(N::U32)),
            ] {
                let header = format!(
                    "element vertex 3\n{XYZ}\nelement face 1\nproperty list {count_type} {item_type} vertex_index"
                );
                let file = Ply::new(encoding, &header)
                    .float_row([0.0; 3])
                    .float_row([1.0; 3])
                    .float_row([2.0; 3])
                    .row(&[count, items[0], items[1], items[2]]);
                assert_eq!(elements(&file.read().unwrap()), [t(0, 1, 2)], "{encoding:?} {count_type} {item_type}");
            }
        }
    }
}

#[test]
fn header_lines_may_end_either_way() {
    for encoding in ENCODINGS {
        // The first byte of the data is that of a line end, but belongs to a number.
        let header = format!("comment x\n\nelement vertex 1\n{XYZ}");
        let value = f32::from_le_bytes([b'\n', b'\r', b'\n', 0x40]);
        let value = if encoding == Encoding::Big { f32::from_bits(value.to_bits().swap_bytes()) } else { value };
        for end in ["\n", "\r\n"] {
            let scene = Ply::with_line_end(encoding, &header, end).float_row([value, 1.0, 2.0]).read().unwrap();
            let read = scene.soup.positions()[0].x;
            // Text is read in double precision.
            let near = (read - f64::from(value)).abs() <= 1e-7 * f64::from(value).abs();
            assert!(if encoding == Encoding::Ascii { near } else { read == f64::from(value) }, "{encoding:?} {end:?}");
        }
    }
}

#[test]
fn vertices_alone_are_a_point_cloud() {
    for encoding in ENCODINGS {
        for rest in
            ["", "\nelement face 0\nproperty list uchar int vertex_indices", "\nelement camera 1\nproperty uchar on"]
        {
            let mut file =
                Ply::new(encoding, &format!("element vertex 2\n{XYZ}{rest}")).float_row([0.0; 3]).float_row([1.0; 3]);
            if rest.contains("camera") {
                file = file.row(&[N::U8(1)]);
            }
            let scene = file.read().unwrap();
            assert_eq!(elements(&scene), [p(0), p(1)], "{encoding:?} {rest}");
            assert_eq!(scene.sources, [0, 1]);
        }
        assert_eq!(elements(&square(encoding, &[]).read().unwrap()).len(), 4);
        assert_eq!(elements(&Ply::new(encoding, &format!("element vertex 0\n{XYZ}")).read().unwrap()), []);
        assert_eq!(elements(&Ply::new(encoding, "comment nothing").read().unwrap()), []);
        // A file with a strip that is too short for a triangle is not a point cloud.
        let file = Ply::new(encoding, &format!("element vertex 1\n{XYZ}\nelement tristrips 1\n{LIST}"))
            .float_row([0.0; 3])
            .list(&[0]);
        assert_eq!(elements(&file.read().unwrap()), []);
    }
}

#[test]
fn strips_turn_every_other_triangle_and_start_anew() {
    for encoding in ENCODINGS {
        let header = format!("element vertex 6\n{XYZ}\nelement tristrips 2\n{LIST}");
        let file = (0u8..6).fold(Ply::new(encoding, &header), |f, i| f.float_row([f32::from(i), 0.0, 0.0]));
        let scene = file.list(&[0, 1, 2, 3, 4, -1, 1, 2, 3, -1, -1, 5, 4]).list(&[-1, 3, 4, 5, -1]).read().unwrap();
        assert_eq!(elements(&scene), [t(0, 1, 2), t(2, 1, 3), t(2, 3, 4), t(1, 2, 3), t(3, 4, 5)]);
        assert_eq!(scene.sources, [0, 0, 0, 0, 1]);
    }
}

#[test]
fn data_after_the_last_element_is_reported() {
    for encoding in ENCODINGS {
        let mut file = square(encoding, &[&[0, 1, 2]]);
        file.bytes.extend(b"more\n");
        let (what, count) = if encoding == Encoding::Ascii { ("words", 1) } else { ("bytes", 5) };
        let scene = file.read().unwrap();
        assert_eq!(skipped(&scene), [(format!("{what} after the last element").as_str(), count)]);
        assert_eq!(scene.skipped[0].to_string(), format!("{count} {what} after the last element"));
    }
}

#[test]
fn text_may_break_lines_within_an_element() {
    let text = format!(
        "ply\nformat ascii 1.0\nelement vertex 3\n{XYZ}\nelement face 1\n{LIST}\nend_header\n0 0\n0 \n1 0 \r\n\n0\r1 1\t0\n3 0\n1\n2"
    );
    assert_eq!(elements(&ply(text).unwrap()), [t(0, 1, 2)]);
}

#[test]
fn text_is_read_in_double_precision() {
    let text = format!("ply\nformat ascii 1.0\nelement vertex 1\n{XYZ}\nend_header\n0.1 90706.123456789 1e300\n");
    assert_eq!(ply(text).unwrap().soup.positions(), [Point3::new(0.1, 90_706.123_456_789, 1e300)]);
}

fn header_error(text: &str) -> (FileLocation, HeaderProblem) {
    match ply(text).unwrap_err() {
        ReadError { location, reason: Reason::BadHeader(problem), .. } => (location, problem),
        other => panic!("{other}"),
    }
}

#[test]
fn bad_headers() {
    for text in ["", "p", "plyx\n", "OFF\n", " ply\n", "\0\0\0\0"] {
        assert_eq!(header_error(text), (FileLocation::Line(1), HeaderProblem::NotPly), "{text:?}");
    }
    let start = "ply\nformat ascii 1.0\n";
    for line in [
        "what is this",
        "element vertex",
        "element vertex x",
        "element vertex -1",
        "element vertex 1 2",
        "property float x",
        "format ascii 1.0",
        "element vertex 99999999999999999999999 7",
    ] {
        let problem = HeaderProblem::BadLine { text: line.to_owned() };
        assert_eq!(header_error(&format!("{start}{line}\n")), (FileLocation::Line(3), problem));
    }
    let vertex = format!("{start}element vertex 1\n");
    let bad_type = |declared: &str| HeaderProblem::BadType { name: "x".to_owned(), declared: declared.to_owned() };
    for (line, problem) in [
        ("property float", HeaderProblem::BadLine { text: "property float".to_owned() }),
        ("property list uchar int", HeaderProblem::BadLine { text: "property list uchar int".to_owned() }),
        ("property half x", bad_type("half")),
        ("property list float int x", bad_type("list float int")),
        ("property list uchar half x", bad_type("list uchar half")),
    ] {
        assert_eq!(header_error(&format!("{vertex}{line}\n")), (FileLocation::Line(4), problem));
    }
    let twice = format!("{vertex}property float x\nproperty int x\n");
    assert_eq!(header_error(&twice), (FileLocation::Line(5), HeaderProblem::Duplicate { name: "x".to_owned() }));
    let twice = format!("{vertex}property float x\nelement vertex 2\n");
    assert_eq!(header_error(&twice), (FileLocation::Line(5), HeaderProblem::Duplicate { name: "vertex".to_owned() }));
    assert_eq!(header_error("ply\nend_header\n"), (FileLocation::Line(2), HeaderProblem::NoFormat));
    let long = format!("ply\ncomment {}\n", "x".repeat(70_000));
    assert_eq!(header_error(&long), (FileLocation::Line(2), HeaderProblem::LineTooLong));
    for (header, element, property) in [
        ("element vertex 1\nproperty float x\nproperty float y", "vertex", "z"),
        ("element face 1\nproperty int vertex_indices_of", "face", "vertex_indices"),
        ("element tristrips 1", "tristrips", "vertex_indices"),
        ("element edge 1\nproperty int vertex1", "edge", "vertex2"),
    ] {
        let problem = HeaderProblem::MissingProperty { element, property };
        assert_eq!(header_error(&format!("{start}{header}\nend_header\n")), (FileLocation::File, problem));
    }
    for (header, name, declared) in [
        ("element vertex 1\nproperty list uchar float x\nproperty float y\nproperty float z", "x", "list uchar float"),
        ("element face 1\nproperty list uchar float vertex_indices", "vertex_indices", "list uchar float"),
        ("element face 1\nproperty int vertex_index", "vertex_index", "int"),
        ("element edge 1\nproperty float vertex1\nproperty int vertex2", "vertex1", "float"),
    ] {
        let problem = HeaderProblem::BadType { name: name.to_owned(), declared: declared.to_owned() };
        assert_eq!(header_error(&format!("{start}{header}\nend_header\n")), (FileLocation::File, problem));
    }
}

#[test]
fn formats_we_do_not_know() {
    for format in ["ascii 2.0", "binary_middle_endian 1.0", "ascii", ""] {
        let error = ply(format!("ply\nformat {format}\nend_header\n")).unwrap_err();
        assert_eq!(error.location, FileLocation::Line(2));
        assert!(matches!(&error.reason, Reason::UnsupportedFormat { text } if text == format), "{error}");
    }
}

/// Checks the reason of an error, and its location as the number of numbers of vertices and faces before it.
fn check(encoding: Encoding, file: &Ply, bytes_or_line: (u64, u64), expected: impl Fn(&Reason) -> bool) {
    let error = file.read().unwrap_err();
    let data = file.bytes.windows(11).position(|w| w == b"end_header\n").unwrap() as u64 + 11;
    let lines = file.bytes[..usize::try_from(data).unwrap()].iter().filter(|&&b| b == b'\n').count() as u64;
    let location = if encoding == Encoding::Ascii {
        FileLocation::Line(lines + bytes_or_line.1)
    } else {
        FileLocation::Byte(data + bytes_or_line.0)
    };
    assert_eq!(error.location, location, "{encoding:?} {error}");
    assert!(expected(&error.reason), "{encoding:?} {error}");
}

#[test]
fn errors_have_location_and_reason() {
    for e in ENCODINGS {
        // The vertices have 48 bytes on 4 lines, and a face of three vertices has 13 bytes.
        let faces: [&[i32]; 2] = [&[0, 1, 2], &[0, 4, 1]];
        check(e, &square(e, &faces), (48 + 13 + 5, 6), |r| matches!(r, Reason::NoSuchVertex { index: 4, count: 4 }));
        let faces: [&[i32]; 1] = [&[0, 1, -1]];
        check(e, &square(e, &faces), (48 + 9, 5), |r| matches!(r, Reason::NoSuchVertex { index: -1, count: 4 }));
        let empty: [&[i32]; 1] = [&[]];
        check(e, &square(e, &empty), (48, 5), |r| matches!(r, Reason::TooFewVertices { found: 0, needed: 1 }));
        // Faces of one and two vertices are points and segments.
        let scene = square(e, &[&[0, 1], &[0, 1, 2], &[3], &[3, 2]]).read().unwrap();
        assert_eq!(elements(&scene), [s(0, 1), t(0, 1, 2), p(3), s(3, 2)]);
        let header = format!("element vertex 4\n{XYZ}\nelement face 1\nproperty list char int vertex_indices");
        let vertices = |header: &str| (0..4).fold(Ply::new(e, header), |f, _| f.float_row([0.0; 3]));
        check(e, &vertices(&header).row(&[N::I8(-2)]), (48, 5), |r| matches!(r, Reason::BadListCount { count: -2 }));
        let header = format!("element vertex 4\n{XYZ}\nelement face 1\nproperty list uint int vertex_indices");
        let file = vertices(&header).row(&[N::U32(4_000_000_000)]);
        check(e, &file, (48, 5), |r| matches!(r, Reason::ElementTooLarge { count: 4_000_000_000, .. }));
        let header = format!("element vertex 4\n{XYZ}\nelement edge 1\nproperty int vertex1\nproperty int vertex2");
        let file = vertices(&header).row(&[N::I32(0), N::I32(4)]);
        check(e, &file, (52, 5), |r| matches!(r, Reason::NoSuchVertex { index: 4, count: 4 }));
        let header = format!("element vertex 4\n{XYZ}\nelement tristrips 1\n{LIST}");
        let file = vertices(&header).list(&[0, 1, -2]);
        check(e, &file, (57, 5), |r| matches!(r, Reason::NoSuchVertex { index: -2, count: 4 }));

        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            let file = Ply::new(e, &format!("element vertex 2\n{XYZ}\nelement face 1\n{LIST}"))
                .float_row([1.0; 3])
                .float_row([0.0, bad, 0.0]);
            // The location is that of the vertex.
            check(e, &file.list(&[0, 0, 1]), (16, 2), |r| matches!(r, Reason::NonFiniteVertex { index: 1 }));
            // The location is that of the vertex even if the face comes first.
            let header = format!("element face 1\n{LIST}\nelement vertex 2\n{XYZ}");
            let file = Ply::new(e, &header).list(&[0, 0, 1]).float_row([1.0; 3]).float_row([0.0, bad, 0.0]);
            check(e, &file, (13 + 16, 3), |r| matches!(r, Reason::NonFiniteVertex { index: 1 }));
        }
        // The faces come before the vertices, whose number is in the header.
        let file = Ply::new(e, &format!("element face 1\n{LIST}\nelement vertex 3\n{XYZ}")).list(&[0, 1, 3]);
        check(e, &file, (9, 1), |r| matches!(r, Reason::NoSuchVertex { index: 3, count: 3 }));
    }
    let text = |rows: &str| {
        ply(format!("ply\nformat ascii 1.0\nelement vertex 1\nproperty int x\nproperty float y\nproperty float z\nend_header\n{rows}")).unwrap_err()
    };
    assert_eq!(text("1.5 0 0\n").to_string(), "t.ply:8: '1.5' is not a number that fits here");
    assert_eq!(text("1 0 x\n").to_string(), "t.ply:8: 'x' is not a number that fits here");
    assert!(matches!(text("1 0\n").reason, Reason::UnexpectedEnd));
}

#[test]
fn vertices_that_are_not_finite_may_stay_unused() {
    for e in ENCODINGS {
        let vertices = |more: &str| {
            Ply::new(e, &format!("element vertex 4\n{XYZ}{more}"))
                .float_row([0.0; 3])
                .float_row([f32::NAN, 0.0, 0.0])
                .float_row([1.0; 3])
                .float_row([2.0; 3])
        };
        let scene = vertices(&format!("\nelement face 1\n{LIST}")).list(&[0, 2, 3]).read().unwrap();
        assert_eq!(elements(&scene), [t(0, 2, 3)], "{e:?}");
        assert_eq!(skipped(&scene), []);
        let scene = vertices("").read().unwrap();
        assert_eq!(elements(&scene), [p(0), p(2), p(3)], "{e:?}");
        assert_eq!(scene.sources, [0, 2, 3]);
        assert_eq!(skipped(&scene), [("vertices that are not finite", 1)]);
    }
}

#[test]
fn text_with_more_columns_than_declared_is_an_error() {
    let read = |rest: &str, data: &str| {
        let text = format!("ply\nformat ascii 1.0\nelement vertex 3\n{XYZ}{rest}\nend_header\n{data}");
        ply(text).unwrap_err().to_string()
    };
    let extra = |line: u32, word: &str| {
        format!("t.ply:{line}: '{word}' is more than the header declares for the element on this line")
    };
    assert_eq!(read("", "0 0 0 7\n1 0 0 8\n0 1 0 9\n"), extra(8, "7"));
    let vertices = "0 0 0\n1 0 0\n0 1 0 \n";
    assert_eq!(read(&format!("\nelement face 1\n{LIST}"), &format!("{vertices}3 0 1 2 255\n")), extra(13, "255"));
    let edges = "\nelement edge 1\nproperty int vertex1\nproperty int vertex2";
    assert_eq!(read(edges, &format!("{vertices}\n0 1 2\n")), extra(15, "2"));
    let other = "\nelement camera 1\nproperty float a";
    assert_eq!(read(other, &format!("{vertices}0 1\n")), extra(13, "1"));
}

#[test]
fn unknown_connectivity_is_no_point_cloud() {
    for e in ENCODINGS {
        for name in ["vertex_indices", "vertex_index", "vertex_indexes"] {
            let header = format!("element vertex 1\n{XYZ}\nelement tetra 1\nproperty list uchar int {name}");
            let scene = Ply::new(e, &header).float_row([0.0; 3]).list(&[0, 0, 0, 0]).read().unwrap();
            assert_eq!(elements(&scene), [], "{e:?} {name}");
            assert_eq!(skipped(&scene), [("element tetra", 1)]);
        }
        // The element has no members, or has another meaning.
        let header = format!("element vertex 1\n{XYZ}\nelement tetra 0\nproperty list uchar int vertex_indices");
        assert_eq!(elements(&Ply::new(e, &header).float_row([0.0; 3]).read().unwrap()), [p(0)]);
    }
}

#[test]
fn elements_of_which_there_are_none_need_no_properties() {
    for e in ENCODINGS {
        let header = format!("element vertex 1\n{XYZ}\nelement face 0\nelement edge 0");
        let scene = Ply::new(e, &header).float_row([0.0; 3]).read().unwrap();
        assert_eq!((elements(&scene), skipped(&scene)), (vec![p(0)], vec![]), "{e:?}");
    }
}

#[test]
fn headers_end_lines_as_their_first_one_does() {
    // The first byte of the data is the number of a line feed or of a carriage return.
    for (end, first) in [("\n", 10), ("\n", 13), ("\r\n", 10), ("\r\n", 13), ("\r", 10), ("\r", 13)] {
        for e in ENCODINGS {
            let header = "element vertex 1\nproperty uchar x\nproperty uchar y\nproperty uchar z";
            let scene = Ply::with_line_end(e, header, end).row(&[N::U8(first), N::U8(2), N::U8(3)]).read().unwrap();
            assert_eq!(scene.soup.positions(), [Point3::new(f64::from(first), 2.0, 3.0)], "{e:?} {end:?}");
        }
    }
    let text =
        format!("ply\nformat ascii 1.0\nelement vertex 2\n{XYZ}\nend_header\n1 2 3\n4 x 6\n").replace('\n', "\r");
    assert_eq!(ply(text).unwrap_err().location, FileLocation::Line(9));
}

#[test]
fn a_mark_of_utf8_may_come_first() {
    for e in ENCODINGS {
        let mut bytes = b"\xef\xbb\xbf".to_vec();
        bytes.extend(&square(e, &[&[0, 1, 2]]).bytes);
        assert_eq!(elements(&ply(&bytes).unwrap()), [t(0, 1, 2)]);
    }
}

#[test]
fn messages_read_well() {
    let message = |header: &str, data: &str| {
        ply(format!("ply\nformat ascii 1.0\n{header}\nend_header\n{data}")).unwrap_err().to_string()
    };
    let header = format!("element vertex 1\n{XYZ}\nelement face 1\nproperty list char int vertex_indices");
    assert_eq!(
        message(&header, "0 0 0\n3 0 0 1\n"),
        "t.ply:11: vertex index 1 is out of range, the file has 1 vertices, counted from 0"
    );
    assert_eq!(message(&header, "0 0 0\n-3 0 0 1\n"), "t.ply:11: a list cannot have -3 items");
    assert_eq!(
        message("element vertex 1\nproperty half x", ""),
        "t.ply:4: bad header: property 'x' is of type 'half', which is unknown or does not fit"
    );
    assert_eq!(message(&header, "0 0 0\n0\n"), "t.ply:11: 1 or more vertices expected, found 0");
}

#[test]
fn announced_sizes_are_not_believed() {
    for encoding in ENCODINGS {
        for header in [
            format!("element vertex 4294967295\n{XYZ}"),
            "element x 18446744073709551615\nproperty int a".to_owned(),
            "element x 9999999999\nproperty list uint double a".to_owned(),
            format!("element vertex 3\n{XYZ}\nelement face 4000000000\n{LIST}"),
            "element tristrips 1\nproperty list uint int vertex_indices".to_owned(),
        ] {
            // The number is too large as a count, and finite as a coordinate.
            let file = Ply::new(encoding, &header).row(&[N::U32(0x7f00_0000)]);
            let error = file.read().unwrap_err();
            assert!(matches!(error.reason, Reason::UnexpectedEnd), "{header}: {error}");
        }
        // This takes neither memory nor time, because there is nothing to read.
        let file = Ply::new(encoding, "element x 9000000000000000000");
        assert_eq!(skipped(&file.read().unwrap()), [("element x", 9_000_000_000_000_000_000)]);
        let file = Ply::new(encoding, &format!("element vertex 4294967296\n{XYZ}"));
        assert!(matches!(file.read().unwrap_err().reason, Reason::ElementTooLarge { .. }));
    }
}

#[test]
fn vertices_of_a_ply_file_are_points() {
    let text = "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\nelement vertex 2\n\
        property float y\nproperty float x\nproperty uchar c\nproperty int z\nelement other 5\nproperty int a\nend_header\n\
        3 9 9 9\n2 1 0 3\n5 4 0 6\nwhat follows is not read";
    let read = |text: &str| read_points_from(text.as_bytes(), PointFormat::Ply, "q.ply");
    assert_eq!(read(text).unwrap(), [Point3::new(1.0, 2.0, 3.0), Point3::new(4.0, 5.0, 6.0)]);
    let message = |text: &str| read(text).unwrap_err().to_string();
    assert_eq!(read(&text.replace("5 4 0", "5 inf 0")).unwrap()[1].x, f64::INFINITY);
    assert_eq!(message(&text.replace("5 4 0 6\nwhat follows is not read", "")), "q.ply:15: unexpected end of file");
    assert_eq!(message(&text.replace("vertex 2", "vertices 2")), "q.ply: bad header: there is no element 'vertex'");
    assert_eq!(message(&text.replace("float x", "float r")), "q.ply: bad header: element 'vertex' has no property 'x'");
}

#[test]
fn raw_scans_and_other_spellings_are_clouds() {
    let header = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float X\nproperty float Y\nproperty float Z\n\
        property int64 time\nelement range_grid 2\nproperty list uchar int vertex_indices\nend_header\n";
    let scene = p2m_mixed::read_ply(format!("{header}0 0 0 9\n1 2 3 9\n1 1\n0\n").as_bytes(), "scan.ply").unwrap();
    assert_eq!((scene.soup.points(), scene.soup.positions()[1]), (&[0, 1][..], nalgebra::Point3::new(1.0, 2.0, 3.0)));
}
