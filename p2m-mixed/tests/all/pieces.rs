//! The pieces of a file make up its scene.

use crate::common::{formats_of_triangles, lossless, measured_on_one_thread, rich_files, written};
use nalgebra::Point3;
use p2m_core::{Element, PrimitiveId, PrimitiveSet, Soup};
use p2m_mixed::{Format, Object, PieceOptions, PieceSummary, ReadError, Scene, read_scene, read_scene_in_pieces};
use p2m_testkit::{cases, rng};
use rand::{Rng, RngExt};
use std::fs;
use std::path::{Path, PathBuf};

/// A folder with a file of a scene.
struct SceneFile {
    folder: tempfile::TempDir,
    path: PathBuf,
}

impl SceneFile {
    fn new(bytes: impl AsRef<[u8]>, format: Format) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(format!("scene.{format}"));
        fs::write(&path, bytes).unwrap();
        Self { folder, path }
    }
}

/// The bits of the corners of a primitive, and its source.
type Corners = (Vec<[u64; 3]>, u32);

/// Returns the primitives of a scene. Zeros of STL files lose their sign.
fn primitives(scene: &Scene, format: Format) -> Vec<Corners> {
    let bits = |x: f64| if format == Format::Stl { (x + 0.0).to_bits() } else { x.to_bits() };
    let position = |&index: &u32| scene.soup.positions()[index as usize].coords.map(bits).data.0[0];
    let corners = scene.soup.elements().map(|element| element.indices().iter().map(position).collect());
    corners.zip(scene.sources.iter().copied()).collect()
}

/// Returns the pieces of a file up to its end or an error.
fn read(path: &Path, options: &PieceOptions) -> (Vec<Scene>, Result<PieceSummary, ReadError>) {
    let mut pieces = Vec::new();
    let summary = read_scene_in_pieces(path, options, &mut |piece| {
        pieces.push(piece);
        Ok(())
    });
    (pieces, summary)
}

/// Checks the pieces of a file against its scene, and returns whether the file is valid.
fn check_with(path: &Path, options: &PieceOptions) -> bool {
    let format = Format::from_path(path).unwrap();
    let (pieces, summary) = read(path, options);
    let full = options.max_primitives;
    let scene = match (read_scene(path), &summary) {
        (Ok(scene), Ok(_)) => scene,
        (Err(expected), Err(error)) => {
            assert_eq!((error.to_string(), error.location), (expected.to_string(), expected.location));
            assert!(pieces.iter().all(|piece| piece.soup.len() == full));
            return false;
        }
        (expected, summary) => panic!("{expected:?} in memory, {summary:?} in pieces"),
    };
    let summary = summary.unwrap();
    assert_eq!((summary.primitive_count, summary.piece_count), (scene.soup.len() as u64, pieces.len() as u64));
    assert_eq!(summary.skipped, scene.skipped);
    assert_eq!(pieces.len(), scene.soup.len().div_ceil(full));
    let mut objects: Vec<Object> = Vec::new();
    let mut all = Vec::new();
    for (number, piece) in pieces.iter().enumerate() {
        let first = all.len();
        assert!(piece.soup.len() == full || number + 1 == pieces.len());
        assert!(piece.skipped.is_empty());
        let mut next = 0;
        for &index in piece.soup.elements().collect::<Vec<_>>().iter().flat_map(Element::indices) {
            assert!(index <= next, "vertices are in the order of their first use");
            next = next.max(index + 1);
        }
        assert_eq!(piece.soup.positions().len(), next as usize, "no other vertices are in a piece");
        for object in &piece.objects {
            let ids = first + object.ids.start..first + object.ids.end;
            match objects.last_mut() {
                Some(last) if object.ids.start == 0 && last.ids.end == first && last.name == object.name => {
                    last.ids.end = ids.end;
                }
                _ => objects.push(Object { name: object.name.clone(), ids }),
            }
        }
        all.extend(primitives(piece, format));
    }
    assert_eq!(all, primitives(&scene, format));
    assert_eq!(objects, scene.objects);
    true
}

/// Checks a file with pieces of several lengths.
fn check(bytes: impl AsRef<[u8]>, format: Format) -> bool {
    let file = SceneFile::new(bytes, format);
    let lengths = [1, 2, 7, 1000];
    let valid = lengths.map(|n| check_with(&file.path, &PieceOptions::default().with_max_primitives(n)));
    assert!(valid.iter().all(|&v| v == valid[0]));
    valid[0]
}

/// Returns a scene of random primitives of the kinds of a format, some of which are in objects.
fn random_scene(rng: &mut impl Rng, format: Format) -> Scene {
    let vertices = rng.random_range(1..30);
    let positions = (0..vertices).map(|_| Point3::from([(); 3].map(|()| f64::from(rng.random_range(-2i8..3)) * 0.5)));
    let positions: Vec<_> = positions.collect();
    let count = rng.random_range(0..40);
    let elements = (0..count).map(|_| {
        let mut vertex = || rng.random_range(0..vertices);
        let corners = [vertex(), vertex(), vertex()];
        match if format.is_lossless() { rng.random_range(0..3) } else { 0 } {
            0 => Element::Triangle(corners),
            1 => Element::Segment([corners[0], corners[1]]),
            _ => Element::Point(corners[0]),
        }
    });
    let elements: Vec<_> = elements.collect();
    let mut scene = Scene::from(Soup::new(positions, elements).unwrap());
    if matches!(format, Format::Obj | Format::P2m) {
        let mut start = 0;
        while start < scene.soup.len() {
            let end = rng.random_range(start + 1..scene.soup.len() + 1);
            if rng.random_bool(0.7) {
                scene.objects.push(Object { name: format!("part {start}"), ids: start..end });
            }
            start = end;
        }
    }
    scene
}

#[test]
fn pieces_of_rich_files_make_up_their_scenes() {
    for (bytes, format, _) in rich_files() {
        assert!(check(&bytes, format), "{format}");
    }
}

#[test]
fn pieces_of_random_scenes_make_up_the_scenes() {
    for case in cases(400, 20) {
        let mut rng = rng("pieces of scenes", case);
        for format in formats_of_triangles() {
            let scene = random_scene(&mut rng, format);
            assert!(check(written(&scene, format), format), "{format}");
        }
    }
}

#[test]
fn damaged_files_have_the_same_errors_in_pieces() {
    let mut valid = 0;
    let cases = cases(1000, 60);
    for case in cases.clone() {
        let mut rng = rng("pieces of damaged files", case);
        for (mut bytes, format, _) in rich_files() {
            let at = rng.random_range(0..bytes.len());
            match rng.random_range(0..4) {
                0 => bytes.truncate(at),
                1 => bytes[at] = *b"0123456789-+.#/\\\n\r eE".get(rng.random_range(0..21)).unwrap(),
                2 => drop(bytes.remove(at)),
                _ => {
                    let end = bytes.len().min(at + rng.random_range(0..60));
                    let part = bytes[at..end].to_vec();
                    bytes.splice(at..at, part);
                }
            }
            valid += usize::from(check(&bytes, format));
        }
    }
    assert!(cases.have_more_than(500, valid), "{valid} valid files");
}

#[test]
fn statements_of_obj_files_mean_the_same_in_pieces() {
    let vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\nv 1 1 -0\n";
    let valid = [
        // Groups are no objects if an object follows, in whatever way it is written.
        "g a\nf 1 2 3\nf 1 2 3\nf 1 2 3\ng b\nf 1 2 3\no c\nf 1 2 3\ng d\nf 1 2 3\n",
        "g a\nf 1 2 3\nf 1 2 3\n\\\no c\nf 1 2 3\n",
        "g a\nf 1 2 3\nf 1 2 3\nusemtl x\\\no c\nf 1 2 3\n",
        "g a\nf 1 2 3\nf 1 2 3\n# \\\n#o c\nf 1 2 3\ng a\np 1\ng\np 1 2\ng a\np 3\n",
        "o a\nf 1 2 3\nf 1 2 3\ng b\nf 1 2 3\no a\nl 1 2 3 1\no\np 1\n",
        // Statements stay in order after a reference to a later vertex.
        "g a\nf 1 2 3\nf 1 2 6\nf 1 2 3\no b\nf 1 -1 2\nv 3 3 3\nf -1 1 2\n",
        // A polygon and a polyline are divided over pieces.
        "v 2 2 0\nv 1 3 0\nv 0 2 0\nf 1 2 5 6 7 8\no x\nl 1 2 3 5 1 2\np 1 1 1\n",
        // Clouds leave out the vertex that is not finite, and control points are none.
        "g a\n",
        "g a\no b\n",
        "g a\ncurv 0 1 1 2\n",
    ];
    for text in valid {
        assert!(check(format!("{vertices}{text}"), Format::Obj), "{text}");
    }
    for text in ["f 1 2 4\n", "p 1\np 1\np 7\n", "f 1 2 3\np 9\nf 1 2 3\nv 0 0 0\n", "p 1 2\nf 1\n", "p 1\np 1\nv x\n"]
    {
        assert!(!check(format!("{vertices}{text}"), Format::Obj), "{text}");
    }
    assert!(!check("", Format::Obj) && !check("hello\n", Format::Obj) && check("# nothing\n", Format::Obj));
}

#[test]
fn facets_of_more_than_three_vertices_are_divided_over_pieces() {
    let facet = |corners: &[[i32; 3]]| {
        let vertices: String = corners.iter().map(|[x, y, z]| format!("vertex {x} {y} {z} ")).collect();
        format!("facet outer loop {vertices} endloop endfacet\n")
    };
    let octagon = [[1, 0, 0], [2, 0, 0], [3, 1, 0], [3, 2, 0], [2, 3, 0], [1, 3, 0], [0, 2, 0], [0, 1, 0]];
    let triangle = [[1, 0, 0], [2, 0, 0], [0, 0, 5]];
    let text = [
        "solid one\n",
        &facet(&triangle),
        &facet(&octagon),
        &facet(&triangle),
        "endsolid\nsolid two\n",
        &facet(&octagon),
        &facet(&octagon),
        "endsolid\n",
    ];
    assert!(check(text.concat(), Format::Stl));
    // Facets after a divided one have the numbers of its vertices again.
    let shifted = octagon.map(|[x, y, z]| [x + 10, y, z + 1]);
    let text = ["solid\n", &facet(&octagon), &facet(&shifted), &facet(&octagon), "endsolid\n"];
    let file = SceneFile::new(text.concat(), Format::Stl);
    assert!((1..9).all(|n| check_with(&file.path, &PieceOptions::default().with_max_primitives(n))));
}

/// An error of reading, or of a visitor.
#[derive(Debug)]
enum Stop {
    Read(ReadError),
    Visitor(usize),
}

impl From<ReadError> for Stop {
    fn from(error: ReadError) -> Self {
        Self::Read(error)
    }
}

#[test]
fn an_error_of_the_visitor_ends_reading_and_is_returned() {
    // A damaged file of a saved index has no pieces.
    for (mut bytes, format, _) in rich_files().into_iter().filter(|(_, format, _)| *format != Format::P2m) {
        bytes.truncate(bytes.len() - 1);
        bytes.extend(b"\nwrong");
        let file = SceneFile::new(&bytes, format);
        for stop in 1..3 {
            let mut visited = 0;
            let options = PieceOptions::default().with_max_primitives(1);
            let error = read_scene_in_pieces(&file.path, &options, &mut |_| {
                visited += 1;
                if visited == stop { Err(Stop::Visitor(stop)) } else { Ok(()) }
            });
            assert!(matches!(error, Err(Stop::Visitor(n)) if n == stop), "{format}: {error:?}");
            assert_eq!(visited, stop);
        }
    }
    // The last piece is one as well, and a file that cannot be opened has none.
    let file = SceneFile::new("v 0 0 0\np 1\n", Format::Obj);
    let error = read_scene_in_pieces(&file.path, &PieceOptions::default(), &mut |_| Err(Stop::Visitor(7)));
    assert!(matches!(error, Err(Stop::Visitor(7))));
    for name in ["missing.obj", "scene.step"] {
        let path = file.folder.path().join(name);
        let error = read_scene_in_pieces(&path, &PieceOptions::default(), &mut |_| Ok::<(), Stop>(())).unwrap_err();
        let Stop::Read(error) = error else { panic!("{error:?}") };
        assert_eq!(error.to_string(), read_scene(&path).unwrap_err().to_string());
    }
}

/// Returns a scene of vertices and primitives in which most primitives use vertices that are far from each other
/// in the file.
fn scattered_scene(vertices: u32, format: Format) -> Scene {
    let position = |i: u32| Point3::new(f64::from(i), f64::from(i % 3) * 0.1, -0.0);
    let elements = (0..2 * vertices).map(|i| match i % 5 {
        0 if format.is_lossless() => Element::Segment([i / 2, vertices - 1 - i / 2]),
        1 => Element::Triangle([i / 2, i % vertices, (7 * i) % vertices]),
        _ => Element::Triangle([i / 2, (i / 2 + 1) % vertices, (i / 2 + 2) % vertices]),
    });
    Soup::new((0..vertices).map(position).collect(), elements).unwrap().into()
}

#[test]
fn vertices_beyond_the_memory_are_in_a_temporary_file() {
    for format in lossless() {
        let file = SceneFile::new(written(&scattered_scene(20_000, format), format), format);
        let options = PieceOptions::default().with_max_position_bytes(0).with_max_primitives(997);
        assert!(check_with(&file.path, &options));
        let (pieces, summary) = read(&file.path, &options.with_folder(file.folder.path().join("missing")));
        assert!(pieces.is_empty());
        let error = summary.unwrap_err().to_string();
        assert!(error.contains("the temporary file of vertices: "), "{error}");
    }
}

#[test]
fn memory_is_that_of_two_pieces_and_of_the_vertices_that_are_allowed() {
    const MAX_BYTES: u64 = 1 << 20;
    // A file of a saved index is read as a whole.
    for format in formats_of_triangles().filter(|format| *format != Format::P2m) {
        let mut scene = scattered_scene(60_000, format);
        if format == Format::Ply {
            // The faces of a file with several kinds have ids, so they stay in memory.
            let only_triangles = scene.soup.elements().filter(|e| matches!(e, Element::Triangle(_)));
            scene = Soup::new(scene.soup.positions().to_vec(), only_triangles.collect::<Vec<_>>()).unwrap().into();
        }
        let file = SceneFile::new(written(&scene, format), format);
        let options = PieceOptions::default().with_max_position_bytes(0).with_max_primitives(1000);
        let mut count = 0;
        let mut summary = None;
        let taken = measured_on_one_thread(|| {
            let read = read_scene_in_pieces(&file.path, &options, &mut |piece| {
                count += piece.soup.len();
                Ok::<(), ReadError>(())
            });
            summary = Some(read.unwrap());
        });
        assert_eq!((count, summary.unwrap().primitive_count), (scene.soup.len(), scene.soup.len() as u64));
        let whole = measured_on_one_thread(|| drop(read_scene(&file.path).unwrap())).bytes_max;
        println!("{format}: {} bytes instead of {whole}", taken.bytes_max);
        assert!(taken.bytes_max < MAX_BYTES && whole > 3 * MAX_BYTES, "{format}: {} of {whole}", taken.bytes_max);
    }
}

#[test]
fn extreme_options_are_limited() {
    let file = SceneFile::new("v 0 0 0\np 1 1\n", Format::Obj);
    let lengths = |n| {
        read(&file.path, &PieceOptions::default().with_max_primitives(n))
            .0
            .iter()
            .map(|p| p.soup.len())
            .collect::<Vec<_>>()
    };
    assert_eq!(lengths(0), [1, 1]);
    assert_eq!(lengths(usize::MAX), [2]);
    let piece = &read(&file.path, &PieceOptions::default()).0[0];
    assert_eq!(piece.soup.element(PrimitiveId::new(1)), Element::Point(0));
}

#[test]
fn pieces_of_models_make_up_the_models() {
    for path in p2m_testkit::model_files() {
        let options = PieceOptions::default().with_max_primitives(10_000).with_max_position_bytes(1 << 19);
        assert!(check_with(&path, &options), "{}", path.display());
    }
}
