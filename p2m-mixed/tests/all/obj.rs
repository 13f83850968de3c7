//! Forms of OBJ statements, and statements that are errors.

use crate::common::{RICH_OBJ, elements, obj, p, s, skipped, t};
use nalgebra::Point3;
use p2m_core::{Element, Soup};
use p2m_mixed::{FileLocation, Format, MAX_CORNERS, Reason, read_scene, write_obj};
use p2m_testkit::amount;
use std::error::Error;
use std::path::Path;

const FOUR: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

fn with_four(statements: &str) -> Vec<Element> {
    elements(&obj(format!("{FOUR}{statements}")).unwrap())
}

#[test]
fn a_bit_of_everything() {
    let scene = obj(RICH_OBJ).unwrap();
    let quad = [t(0, 1, 2), t(0, 2, 3)];
    // The last face has its reflex corner at vertex 4. A fan around that vertex covers it, but other triangulations do
    // too.
    let found = elements(&scene);
    assert_eq!(found[..3], [t(0, 1, 2), quad[0], quad[1]]);
    assert!(found[3..6].iter().all(|e| matches!(e, Element::Triangle(_))));
    assert_eq!(found[6..], [s(0, 5), s(5, 1), s(0, 1), p(0), p(5), t(0, 0, 1)]);
    assert_eq!(scene.sources, [0, 1, 1, 2, 2, 2, 0, 0, 1, 0, 0, 3]);
    assert_eq!(skipped(&scene), [("mtllib", 1), ("vt", 1), ("vn", 1), ("usemtl", 1), ("curv", 1)]);
    assert_eq!(scene.soup.positions()[5], Point3::new(0.5, 0.5, -7.0));
    assert_eq!(scene.soup.positions()[2], Point3::new(4.0, 4.0, 0.0));
}

#[test]
fn references_in_all_forms() {
    for face in
        ["1 2 3", "1/5 2/6 3/7", "1//5 2//5 3//5", "1/1/1 2/2/2 3/3/3", "-4 -3 -2", "-4/-1/-1 2//-1 +3", "1/ 2/ 3/"]
    {
        assert_eq!(with_four(&format!("f {face}\n")), [t(0, 1, 2)], "{face}");
    }
    assert_eq!(with_four("l 1 2 3 4\n"), [s(0, 1), s(1, 2), s(2, 3)]);
    assert_eq!(with_four("l -1 1/2\n"), [s(3, 0)]);
    assert_eq!(with_four("p 4 -4\np 2"), [p(3), p(0), p(1)]);
}

#[test]
fn negative_references_count_from_where_they_stand() {
    let scene = obj("v 0 0 0\nv 1 0 0\nl -1 -2\nv 2 0 0\nl -1 -2\n").unwrap();
    assert_eq!(elements(&scene), [s(1, 0), s(2, 1)]);
}

#[test]
fn layout_of_text_does_not_matter() {
    let expected = [t(0, 1, 2), s(0, 3)];
    for statements in [
        "f 1 2 3\nl 1 4",
        "f 1 2 3\r\nl 1 4\r\n",
        "\t f  1\t2   3 \t\n\n   \nl 1 4 ",
        "f 1 2 3#comment\nl 1 4 # comment \\\n",
        "f 1 \\\n2 \\\r\n 3\nl \\\n\\\n1 4\\",
        "# comment with a path C:\\dir\\\nf 1 2 3\n#\\\nl 1 4",
        "o caf\u{e9}\nf 1 2 3\nl 1 4",
    ] {
        assert_eq!(with_four(statements), expected, "{statements:?}");
    }
    let mut latin1 = FOUR.as_bytes().to_vec();
    latin1.extend(b"# stra\xdfe\ng M\xfcller\xff\nf 1 2 3 # \xe9\nl 1 4\n\xe9t\xe9 1\n");
    let scene = obj(&latin1).unwrap();
    assert_eq!(elements(&scene), expected);
    assert_eq!(skipped(&scene), [("\\xe9t\\xe9", 1)]);
    let with_mark = [b"\xef\xbb\xbf", FOUR.as_bytes(), b"f 1 2 3\nl 1 4"].concat();
    assert_eq!(elements(&obj(with_mark).unwrap()), expected);
}

#[test]
fn vertices_alone_are_a_point_cloud() {
    let scene = obj("v 0 0 0\nvn 1 0 0\nv 1 2 3\n").unwrap();
    assert_eq!(elements(&scene), [p(0), p(1)]);
    assert_eq!(scene.sources, [0, 1]);
}

#[test]
fn vertices_that_are_not_finite_may_stay_unused() {
    let scene = obj("v 0 0 0\nv nan 0 0\nv 1 1e999 0\nv 1 0 0\nl 1 4\n").unwrap();
    assert_eq!((elements(&scene), skipped(&scene)), (vec![s(0, 3)], vec![]));
    let scene = obj("v 0 0 0\nv nan 0 0\nv 1 1e999 0\nv 1 0 0\n").unwrap();
    assert_eq!(elements(&scene), [p(0), p(3)]);
    assert_eq!(scene.sources, [0, 3]);
    assert_eq!(skipped(&scene), [("vertices that are not finite", 2)]);
    assert_eq!(scene.skipped[0].to_string(), "2 vertices that are not finite");
}

#[test]
fn control_points_are_no_point_cloud() {
    for statement in ["cstype bspline", "curv 0 1 1 2", "curv2 1 2", "surf 0 1 0 1 1 2", "bzp 1 2"] {
        let scene = obj(format!("v 0 0 0\nv 1 0 0\n{statement}\n")).unwrap();
        assert_eq!(elements(&scene), [], "{statement}");
        assert_eq!(skipped(&scene), [(statement.split(' ').next().unwrap(), 1)]);
        // Other statements are unchanged.
        assert_eq!(elements(&obj(format!("v 0 0 0\n{statement}\np 1")).unwrap()), [p(0)]);
    }
}

#[test]
fn files_of_other_formats_are_errors() {
    for text in [
        &b"<!DOCTYPE html>\n<p>not found</p>\n"[..],
        b"solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nendloop\n",
        b"\x1f\x8b\x08\x00\x01\x02\x03",
        b"# a comment\ng\nword\n",
    ] {
        let error = obj(text).unwrap_err();
        assert!(matches!((&error.location, &error.reason), (FileLocation::File, Reason::NoVertex)), "{error}");
    }
}

#[test]
fn lines_may_end_in_a_return_alone() {
    let text = format!("# head\n{FOUR}f 1 2 3\nl 1 \\\n 4 # more\n");
    let scene = obj(&text).unwrap();
    assert_eq!(elements(&scene), [t(0, 1, 2), s(0, 3)]);
    assert_eq!(obj(text.replace('\n', "\r")).unwrap(), scene);
    assert_eq!(obj("v 0 0 0\r\rp 2\r").unwrap_err().location, FileLocation::Line(3));
}

#[test]
fn empty_files_are_empty_scenes() {
    let error = obj("").unwrap_err();
    assert!(matches!(error.reason, Reason::NoVertex), "{error}");
    for text in ["\n", "# nothing\n", "g\nvn 0 0 1\n"] {
        assert_eq!(elements(&obj(text).unwrap()), [], "{text:?}");
    }
}

/// Primitives and objects stay in the order of the file, wherever their vertices are.
#[test]
fn references_may_be_to_later_vertices() {
    let before =
        obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\nv 6 6 6\ng a\nf 1 2 3\np 1\no b\nl 1 2 4\no c\nf 2 5\np -4\n");
    let after = obj("v 0 0 0\ng a\nf 1 2 3\np 1\no b\nl 1 2 4\nv 1 0 0\no c\nf 2 5\np -1\nv 0 1 0\nv 5 5 5\nv 6 6 6\n");
    let before = before.unwrap();
    assert_eq!(elements(&before), [t(0, 1, 2), p(0), s(0, 1), s(1, 3), s(1, 4), p(1)]);
    assert_eq!(
        before.objects.iter().map(|o| (o.name.as_str(), o.ids.clone())).collect::<Vec<_>>(),
        [("b", 2..4), ("c", 4..6)]
    );
    assert_eq!(after.unwrap(), before);
}

/// The squares of the numbers of vertices of large polygons have a sum that no file may exceed.
#[test]
fn large_polygons_have_a_total_budget() {
    let corners = 1 << 13;
    let mut text: String =
        (0..corners).map(|i| format!("v {} {} 0\n", f64::from(i).cos(), f64::from(i).sin())).collect();
    // Each polygon has two distinct corners, so it is a fan, which takes no time.
    let polygon = format!("f{}\n", " 1 2".repeat(corners as usize / 2));
    let allowed = (1u64 << 34) / u64::from(corners as u32).pow(2);
    text += &polygon.repeat(usize::try_from(allowed).unwrap());
    assert!(obj(&text).is_ok());
    let error = obj(text + &polygon).unwrap_err();
    assert!(matches!(error.reason, Reason::PolygonsTooLarge { limit } if limit == 1 << 34), "{error}");
}

#[test]
fn noise_is_counted_in_bounded_room() {
    let text: String =
        std::iter::once("v 0 0 0\n".to_owned()).chain((0..1000).map(|i| format!("word{i} x\n"))).collect();
    let scene = obj(text).unwrap();
    assert_eq!(scene.skipped.len(), 65);
    assert_eq!(scene.skipped.iter().map(|s| s.count).sum::<u64>(), 1000);
}

#[test]
fn degenerate_faces_stay() {
    assert_eq!(with_four("f 1 1 1\nf 1 2 1\nl 2 2"), [t(0, 0, 0), t(0, 1, 0), s(1, 1)]);
    assert_eq!(with_four("f 1 1 2 2"), [t(0, 0, 1), t(0, 1, 1)]);
}

/// Returns the error of `FOUR` followed by `statements`.
fn statement_error(statements: &str) -> (FileLocation, Reason) {
    let error = obj(format!("{FOUR}{statements}")).unwrap_err();
    assert_eq!(error.file, "t.obj");
    (error.location, error.reason)
}

macro_rules! assert_refused {
    ($statements:expr, $line:expr, $reason:pat) => {
        let (location, reason) = statement_error($statements);
        assert_eq!(location, FileLocation::Line($line), "{:?}", $statements);
        assert!(matches!(&reason, $reason), "{:?}: {reason:?}", $statements);
    };
}

#[test]
fn errors_have_line_and_reason() {
    assert_refused!("f 1 2 0\n", 5, Reason::IndexZero);
    assert_refused!("\n\nf 1 2 5\n", 7, Reason::IndexOutOfRange { index: 5, count: 4 });
    assert_refused!("f 1 2 -5\n", 5, Reason::IndexOutOfRange { index: -5, count: 4 });
    assert_refused!("p 99999999999999999999\n", 5, Reason::IndexOutOfRange { index: i64::MAX, count: 4 });
    assert_refused!("l 1 4294967297\n", 5, Reason::IndexOutOfRange { index: 4_294_967_297, count: 4 });
    assert_refused!("f 1 2 6\nv 0 0 0\n", 5, Reason::IndexOutOfRange { index: 6, count: 5 });
    assert_refused!("f 1 2 5\nl 1 \\\n 9\nv 0 0 0\n", 7, Reason::IndexOutOfRange { index: 9, count: 5 });
    assert_refused!("f 1 2 5\nv 0 nan 0\n", 5, Reason::NonFiniteVertex { index: 5 });
    assert_refused!("f 1\n", 5, Reason::TooFewVertices { found: 1, needed: 2 });
    assert_refused!("f # 1 2 3\n", 5, Reason::TooFewVertices { found: 0, needed: 2 });
    assert_refused!("l 1\n", 5, Reason::TooFewVertices { found: 1, needed: 2 });
    assert_refused!("p\n", 5, Reason::TooFewVertices { found: 0, needed: 1 });
    assert_refused!("# \\\nv 1 2 # 3\n", 6, Reason::TooFewCoordinates { found: 2 });
    assert_refused!("f 1 \\\n 2 \\\r\n 9\n", 7, Reason::IndexOutOfRange { index: 9, count: 4 });
    for (word, line) in [
        ("x", 6),
        ("1.5", 6),
        ("/1/1", 6),
        ("1/x", 6),
        ("1/2.0/3", 6),
        ("--1", 6),
        ("0x1", 6),
        ("-", 6),
        ("1/+-+", 6),
        ("2/---", 6),
        ("1/2/3/4", 6),
        ("1/2/3/", 6),
        ("1/-", 6),
    ] {
        assert_refused!(&format!("o name\nf 1 2 {word}\n"), line, Reason::BadNumber { .. });
    }
    for word in ["x", "1,5", "1e", "\u{e9}", "0x10", "1_000"] {
        assert_refused!(&format!("v 1 {word} 2\n"), 5, Reason::BadNumber { .. });
    }
    // Some C libraries print NaN like this. Text after `#` is a comment, so the error is about a missing number.
    assert_refused!("v 1 2 1.#QNAN\nv 1 1.#QNAN 2\n", 6, Reason::TooFewCoordinates { found: 2 });
    for word in ["nan", "NaN", "-nan", "inf", "-Infinity", "1e999", "-1e400"] {
        assert_refused!(&format!("v 1 {word} 2\nf 1 2 3\nl 1 5\n"), 7, Reason::NonFiniteVertex { index: 5 });
    }
    for words in ["x", "1 red", "0 0 0,5", "1 v"] {
        assert_refused!(&format!("v 1 2 3 {words}\n"), 5, Reason::BadNumber { .. });
    }
    let text = statement_error(&format!("v 1 2 {}\n", "x\u{7}".repeat(1000))).1.to_string();
    assert!(text.len() < 150 && !text.contains('\u{7}'), "{text}");
}

#[test]
fn faces_have_a_limit_and_lines_have_none() {
    let refs = " 1 2 3 4".repeat(MAX_CORNERS / 4);
    assert_eq!(with_four(&format!("l{refs} 1")).len(), MAX_CORNERS);
    assert_refused!(&format!("f{refs} 1"), 5, Reason::ElementTooLarge { .. });
}

#[test]
fn messages_read_well() {
    let message = |text: &str| obj(text).unwrap_err().to_string();
    assert_eq!(
        message(&format!("{FOUR}f 1 2 99\n")),
        "t.obj:5: vertex index 99 is out of range, 4 vertices were found"
    );
    assert_eq!(message("f 0 1 2"), "t.obj:1: vertex index 0, but vertices are numbered from 1");
    assert_eq!(
        message("v 1 2 1e999\np 1"),
        "t.obj:2: vertex 1 is part of a primitive, but has a coordinate that is not finite"
    );
    assert_eq!(message("<html>\n"), "t.obj: no vertex in it, is this an OBJ file?");
    assert_eq!(message("\nv 1 2"), "t.obj:2: a point needs 3 coordinates, found 2");
    assert_eq!(message("v 0 0 0\nf 1"), "t.obj:2: 2 or more vertices expected, found 1");
}

#[test]
fn extensions_select_the_format() {
    let error = read_scene(Path::new("scene.stp")).unwrap_err();
    let names = Format::NAMES.join(", ");
    assert_eq!(error.to_string(), format!("scene.stp: unknown extension 'stp', expected one of {names}"));
    let error = read_scene(Path::new("obj")).unwrap_err();
    assert_eq!(error.to_string(), format!("obj: unknown extension '', expected one of {names}"));
    for name in ["/nonexistent/a.OBJ", "/nonexistent/a.Ply"] {
        let error = read_scene(Path::new(name)).unwrap_err();
        assert!(matches!(&error.reason, Reason::Io(e) if e.kind() == std::io::ErrorKind::NotFound), "{error}");
        let message = error.to_string();
        assert!(message.starts_with(&format!("{name}: cannot be read: ")) && message.len() > name.len() + 20);
        // The message has the reason, which a chain of sources would repeat.
        assert!(error.source().is_none());
    }
    // The error has no line, whatever error the system returns for a directory.
    let folder = std::env::temp_dir().join(format!("p2m-mixed-{}.obj", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let error = read_scene(&folder).unwrap_err();
    std::fs::remove_dir(&folder).unwrap();
    assert_eq!(error.location, FileLocation::File);
    assert!(matches!(&error.reason, Reason::Io(e) if e.kind() == std::io::ErrorKind::IsADirectory), "{error}");
}

#[test]
fn written_scenes_read_back_bit_by_bit() {
    let values =
        [0.0, -0.0, 0.1, -1.0 / 3.0, 1e300, -1e-300, 5e-324, f64::MAX, f64::MIN_POSITIVE, 123_456_789.123_456_79, 1.0];
    let positions: Vec<_> = (0..values.len())
        .map(|i| Point3::new(values[i], values[(i + 3) % values.len()], values[(i + 7) % values.len()]))
        .collect();
    let soup = Soup::new(positions, [t(0, 1, 2), p(9), s(3, 3), t(4, 5, 6), p(7), s(8, 10)]).unwrap();
    let mut text = Vec::new();
    write_obj(&soup.clone().into(), &mut text).unwrap();
    let again = obj(&text).unwrap().soup;
    assert_eq!(*again, soup);
    let bits = |s: &Soup<f64>| {
        s.positions().iter().flat_map(|p| p.iter().map(|x| x.to_bits()).collect::<Vec<_>>()).collect::<Vec<_>>()
    };
    assert_eq!(bits(&again), bits(&soup));
}

#[test]
fn an_unused_position_that_a_file_cannot_hold_is_written_as_the_origin() {
    let soup = Soup::new(vec![Point3::new(f64::NAN, 0.0, 1.0), Point3::new(1.0, 2.0, 3.0)], [p(1)]).unwrap();
    let mut text = Vec::new();
    write_obj(&soup.clone().into(), &mut text).unwrap();
    let again = obj(&text).unwrap();
    assert_eq!(elements(&again), [p(1)]);
    assert_eq!(again.soup.positions()[1], Point3::new(1.0, 2.0, 3.0));
}

#[test]
fn objects_are_o_statements_or_else_groups() {
    let objects = |statements: &str| -> Vec<(String, std::ops::Range<usize>)> {
        let scene = obj(format!("{FOUR}{statements}")).unwrap();
        scene.objects.into_iter().map(|o| (o.name, o.ids)).collect()
    };
    let named = |name: &str, ids| (name.to_owned(), ids);
    assert_eq!(objects("o a\nf 1 2 3 4\no b\nl 1 2 3\np 1"), [named("a", 0..2), named("b", 2..5)]);
    assert_eq!(objects("f 1 2 3\ng a b \nf 1 2 3\ng\nf 1 2 3\ng c\n"), [named("a b", 1..2)]);
    assert_eq!(objects("g a\nf 1 2 3\no b\nf 1 2 3\ng c\nf 1 2 3"), [named("b", 1..3)]);
    assert_eq!(objects("g a\nf 1 2 3\no\nf 1 2 3"), [], "an object without a name is one, too");
    assert_eq!(objects("g a\nf 1 2 3\ng b\ng a\nf 1 2 3\ng c\nf 1 2 3"), [named("a", 0..2), named("c", 2..3)]);
    assert_eq!(objects("o two \\\n words\nf 1 2 3\no #1 \t\nf 1 2 3"), [named("two   words", 0..1), named("#1", 1..2)]);
    assert_eq!(objects("o caf\u{e9}\nf 1 2 3"), [named("caf\u{e9}", 0..1)]);

    let skips = |statements: &str| {
        obj(format!("{FOUR}{statements}")).unwrap().skipped.iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    assert_eq!(skips("g a\nf 1 2 3\ng b"), [] as [&str; 0]);
    assert_eq!(skips("g a\ns 1\nf 1 2 3\ng b\no c\no c"), ["2 x g", "1 x s"]);
    // A point cloud has no objects.
    assert_eq!(objects("o a\nv 1 1 1"), []);
    assert_eq!(skips("g a\no b\no b"), ["1 x g", "2 x o"]);
}

#[test]
fn many_groups_are_cheap() {
    let mut text = String::from(FOUR);
    let count = amount(1_000_000, 50_000);
    for i in 0..count {
        text += if i % 2 == 0 { "g same name\nf 1 2 3\n" } else { "g other\ng same name\n" };
    }
    let scene = obj(&text).unwrap();
    assert_eq!((scene.objects.len(), scene.objects[0].ids.clone()), (1, 0..count / 2));
}
