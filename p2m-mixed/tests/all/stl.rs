//! Forms of STL files, and files that are errors.

use crate::common::{elements, skipped, stl, t};
use nalgebra::Point3;
use p2m_mixed::{FileLocation, HeaderProblem, Reason, Scene};

/// Returns a binary file.
fn binary(header: &str, facets: &[[[f32; 3]; 3]]) -> Vec<u8> {
    let mut file = header.as_bytes().to_vec();
    file.resize(80, if header.len().is_multiple_of(2) { b' ' } else { 0 });
    file.extend((facets.len() as u32).to_le_bytes());
    for facet in facets {
        file.extend([f32::NAN, 0.0, 1.0].iter().flat_map(|x| x.to_le_bytes())); // a normal of no use
        file.extend(facet.as_flattened().iter().flat_map(|x| x.to_le_bytes()));
        file.extend([0, 0]);
    }
    file
}

const SQUARE: [[[f32; 3]; 3]; 2] =
    [[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.1, 0.0]], [[-0.0, 0.0, 0.0], [1.0, 0.1, -0.0], [0.0, 0.1, 0.0]]];

fn check_square(scene: &Scene) {
    assert_eq!(elements(scene), [t(0, 1, 2), t(0, 2, 3)]);
    assert_eq!(scene.sources, [0, 1]);
    // The vertex has the exact number of single precision, and the sign of the first zero.
    assert_eq!(scene.soup.positions()[2], Point3::new(1.0, f64::from(0.1f32), 0.0));
    assert!(scene.soup.positions()[0].iter().all(|x| x.is_sign_positive()));
}

/// Returns a text file of one facet between these words.
fn text(facet: &str) -> String {
    format!("solid\n{facet}\nendsolid\n")
}

const FACET: &str = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet";

#[test]
fn binary_files_are_recognised_whatever_their_header_says() {
    for header in ["", "binary", "solid", "solid part", "solid part\nfacet normal", "  SOLID x\n  facet normal 0 0 1\n"]
    {
        check_square(&stl(binary(header, &SQUARE)).unwrap());
        assert_eq!(elements(&stl(binary(header, &[])).unwrap()), [], "{header}");
    }
    // The reader returns one byte at a time.
    let file = binary("solid", &SQUARE);
    check_square(&p2m_mixed::read_stl(std::io::BufReader::with_capacity(1, &file[..]), "t.stl").unwrap());
}

#[test]
fn layout_of_text_does_not_matter() {
    let facets = |facet: &str| facet.replace('!', FACET);
    for file in [
        facets("solid\n!\nendsolid\n"),
        facets("solid a name with facet in it\n!\nendsolid a name"),
        facets("\n \t solid\r\n!\r\nendsolid\r\n").replace('\n', "\r\n"),
        facets("SOLID x\n!\nENDSOLID x").to_uppercase(),
        facets("solid x\n!\nendsolid x\n").replace('\n', "\r"),
        facets("\u{feff}solid\n!\nendsolid"),
        facets("solid\n!\nendsolid\n\x1a"),
        facets("solid x\n!\nendsolid").replace(" normal 0 0 1", ""),
        facets("solid x\n!\nendsolid").replace("0 0 1\n", "-nan(ind) 1.#QNAN ?\n"),
        facets("solid x\n!\nendsolid").replace(" 0 0 1\n", "\n"),
        facets("solid x\n!\nendsolid").replace("outer loop\n", "outer loop "),
        facets("solid x\n!\nendsolid").replace(" 0 1 0", " 0\n+1.0e0\t.0"),
        facets("solid stra\u{df}e \u{1f600}\n!\nendsolid"),
        facets(&format!("solid {}\n!\nendsolid", "long ".repeat(2000))),
    ] {
        let scene = stl(&file).unwrap();
        assert_eq!(elements(&scene), [t(0, 1, 2)], "{file}");
        assert_eq!(scene.soup.positions()[2], Point3::new(0.0, 1.0, 0.0), "{file}");
        assert_eq!(skipped(&scene), []);
    }
    assert_eq!(elements(&stl("solid nothing\nendsolid").unwrap()), []);
}

#[test]
fn text_is_read_in_double_precision() {
    let scene = stl(text(&FACET.replace("1 0 0", "0.1 1e300 5e-324"))).unwrap();
    assert_eq!(scene.soup.positions()[1], Point3::new(0.1, 1e300, 5e-324));
}

#[test]
fn solids_with_names_are_objects() {
    let other = FACET.replace("vertex 1", "vertex 2");
    let file = format!(
        "solid  first part \n{FACET}\n{other}\nendsolid\nsolid\n{FACET}\nendsolid\nsolid empty\nendsolid\n\
        solid first part\n{FACET}\nendsolid anything\nsolid last\n{FACET}\nsolid unclosed before\n{FACET}\nendsolid"
    );
    let scene = stl(file).unwrap();
    assert_eq!(scene.soup.triangles(), [[0, 1, 2], [0, 3, 2], [0, 1, 2], [0, 1, 2], [0, 1, 2], [0, 1, 2]]);
    let objects: Vec<_> = scene.objects.iter().map(|o| (o.name.as_str(), o.ids.clone())).collect();
    assert_eq!(objects, [("first part", 0..2), ("first part", 3..4), ("last", 4..5), ("unclosed before", 5..6)]);
    assert_eq!(stl(binary("solid name", &SQUARE)).unwrap().objects, []);
    let latin1 = [b"solid M\xfcller\n", FACET.as_bytes(), b"\nendsolid"].concat();
    assert_eq!(stl(latin1).unwrap().objects[0].name, "M\u{fffd}ller");
}

#[test]
fn equal_corners_are_one_vertex_and_degenerate_facets_stay() {
    let facet = [[1.0, 2.0, 3.0]; 3];
    let next = [1.0, 2.0, f32::from_bits(3.0f32.to_bits() + 1)];
    let scene = stl(binary("", &[facet, [facet[0], next, next], facet])).unwrap();
    assert_eq!(elements(&scene), [t(0, 0, 0), t(0, 1, 1), t(0, 0, 0)]);
    assert_eq!(scene.soup.positions().len(), 2);
    let scene = stl(text(&FACET.replace(" 0 0 0", " -0 0 -0.0").replace(" 0 1 0", " 0 0 0"))).unwrap();
    assert_eq!(elements(&scene), [t(0, 1, 0)]);
    assert!(scene.soup.positions()[0].x.is_sign_negative(), "the first of equal ones is kept");
}

#[test]
fn facets_of_more_vertices_are_polygons() {
    let scene = stl(text(&FACET.replace("vertex 0 1 0", "vertex 1 1 0\nvertex 0 1 0"))).unwrap();
    assert_eq!(elements(&scene), [t(0, 1, 2), t(0, 2, 3)]);
    assert_eq!(scene.sources, [0, 0]);
}

#[test]
fn attributes_and_what_follows_are_counted() {
    let mut file = binary("", &SQUARE);
    file[84 + 49] = 1;
    file.extend(b"more");
    let scene = stl(file).unwrap();
    check_square(&scene);
    assert_eq!(skipped(&scene), [("facets with attribute bytes", 1), ("bytes after the last facet", 4)]);
}

#[test]
fn errors_have_location_and_reason() {
    let message = |file: &str| stl(file).unwrap_err().to_string();
    assert_eq!(
        message(&text(&FACET.replace("vertex 1 0 0", "vertex 1 nan 0"))),
        "t.stl:5: coordinate 'nan' is not finite"
    );
    assert_eq!(
        message(&text(&FACET.replace("vertex 1 0 0", "vertex 1e999 0 0"))),
        "t.stl:5: coordinate '1e999' is not finite"
    );
    assert_eq!(
        message(&text(&FACET.replace("vertex 1 0 0", "vertex 1 0"))),
        "t.stl:6: 'vertex' is not a number that fits here"
    );
    assert_eq!(message(&text(&FACET.replace("vertex 1 0 0\n", ""))), "t.stl:7: 3 or more vertices expected, found 2");
    assert_eq!(
        message(&text(&FACET.replace("endloop\n", ""))),
        "t.stl:7: 'endfacet' is not 'vertex' or 'endloop', which should be here"
    );
    assert_eq!(
        message(&text(&FACET.replace("outer loop\n", ""))),
        "t.stl:3: 'vertex' is not 'outer loop', which should be here"
    );
    assert_eq!(
        message(&format!("solid\n{FACET}\nendsolid\n{FACET}")),
        "t.stl:10: 'facet' is not 'solid', which should be here"
    );
    assert_eq!(message("solid\nfoo"), "t.stl:2: 'foo' is not 'facet' or 'endsolid', which should be here");
    assert_eq!(message("o part\nv 0 0 0\n"), "t.stl: bad header: the file is text, but does not start with 'solid'");
    for not_stl in ["solidus\n", "  \n", "facet normal 0 0 1"] {
        let reason = stl(not_stl).unwrap_err().reason;
        assert!(matches!(reason, Reason::BadHeader(HeaderProblem::NotStl)), "{not_stl}: {reason}");
    }
    // The text is truncated.
    assert_eq!(message(&format!("solid\n{FACET}\n")), "t.stl:9: unexpected end of file");
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mut facets = SQUARE;
        facets[1][2][0] = bad;
        let error = stl(binary("", &facets)).unwrap_err();
        assert_eq!(error.location, FileLocation::Byte(84 + 50));
        assert!(matches!(&error.reason, Reason::NonFinite { text } if *text == bad.to_string()), "{error}");
    }
}

#[test]
fn a_truncated_binary_file_is_an_error() {
    let file = binary("", &SQUARE);
    for end in 0..file.len() {
        let error = stl(&file[..end]).unwrap_err();
        assert!(
            matches!(error.reason, Reason::UnexpectedEnd | Reason::BadHeader(HeaderProblem::NotStl)),
            "{end}: {error}"
        );
    }
}

#[test]
fn ends_may_be_two_words() {
    let text = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nend loop\nend facet\n\
        end solid a\nsolid b\nendsolid b\n";
    let scene = p2m_mixed::read_stl(text.as_bytes(), "t.stl").unwrap();
    assert_eq!(scene.soup.triangles(), [[0, 1, 2]]);
    let error = p2m_mixed::read_stl(text.replace("end loop", "end solid").as_bytes(), "t.stl").unwrap_err();
    assert_eq!(error.to_string(), "t.stl:7: 'solid' is not 'loop', which should be here");
}
