//! Tests of options of `p2m query` about several answers, sides, columns and files.

use crate::common::*;
use flate2::Compression;
use flate2::write::GzEncoder;
use p2m_backends::BACKENDS;
use std::fs;
use std::io::Write;
use tempfile::TempDir;

/// Three points on a line, and a triangle far above.
const POINTS: &str = "v 0 0 0\nv 1 0 0\nv 3 0 0\np 1\np 2\np 3\n";
/// A tetrahedron with its faces outwards.
const TETRAHEDRON: &str = "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 0 0 4\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

#[test]
fn several_answers_have_a_row_each() {
    let folder = TempDir::new().unwrap();
    let scene = write(&folder, "s.obj", POINTS);
    let points = write(&folder, "q.csv", "x,y,z\n0,0,0\n2.5,0,0\n");
    let run = |more: &[&str]| table(&[&["query", &scene, "--points", &points], more].concat());
    let header = "number,qx,qy,qz,x,y,z,distance,primitive,feature\n";
    let two = "0,0.0,0.0,0.0,0.0,0.0,0.0,0.0,0,vertex0\n0,0.0,0.0,0.0,1.0,0.0,0.0,1.0,1,vertex0\n\
        1,2.5,0.0,0.0,3.0,0.0,0.0,0.5,2,vertex0\n1,2.5,0.0,0.0,1.0,0.0,0.0,1.5,1,vertex0\n";
    for backend in BACKENDS.iter().map(|backend| backend.name) {
        assert_eq!(run(&["--k-nearest", "2", "--backend", backend]), format!("{header}{two}"), "{backend}");
        let within = run(&["--within", "1", "--columns", "number,primitive", "--backend", backend]);
        assert_eq!(within, "number,primitive\n0,0\n0,1\n1,2\n", "{backend}");
    }
    let none = run(&["--within", "0.25", "--columns", "number,primitive"]);
    assert_eq!(none, "number,primitive\n0,0\n");
    let limited = run(&["--k-nearest", "5", "--max-distance", "1", "--columns", "number,primitive"]);
    assert_eq!(limited, "number,primitive\n0,0\n0,1\n1,2\n");
    // The number of records of an array is that of the answers.
    let out = path(&folder, "a.npy");
    let summary = text(&p2m(&["query", &scene, "--points", &points, "--k-nearest", "2", "--out", &out]).stderr);
    assert!(summary.contains("answers  4, without answer 0\n"), "{summary}");
    let bytes = fs::read(&out).unwrap();
    let header = text(&bytes[10..10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]))]);
    assert!(header.contains("('number', '<i8')") && header.contains("'shape': (4,)"), "{header}");
    for wrong in
        [&["--within", "1", "--k-nearest", "1"][..], &["--k-nearest", "1", "--certified"], &["--k-nearest", "0"]]
    {
        failure(&[&["query", &scene, "--points", &points], wrong].concat(), 2);
    }
}

#[test]
fn signed_distances_are_negative_inside() {
    let folder = TempDir::new().unwrap();
    let scene = write(&folder, "s.obj", TETRAHEDRON);
    let points = write(&folder, "q.csv", "x,y,z\n0.5,1,1\n-2,1,1\n0,1,1\n");
    let run = |more: &[&str]| table(&[&["query", &scene, "--points", &points], more].concat());
    let expected = "signed_distance\n-0.5\n2.0\n0.0\n";
    for rule in ["--signed", "--signed=parity", "--signed=winding"] {
        for backend in ["brute", "aabb", "octree", "p2m"] {
            assert_eq!(run(&[rule, "--columns", "signed", "--backend", backend]), expected, "{rule} {backend}");
        }
    }
    assert!(run(&["--signed"]).starts_with("qx,qy,qz,x,y,z,distance,signed_distance,primitive,feature\n"));
    // The column inside needs no distances if it is alone, and says the same with them.
    let (alone, other) = (run(&["--signed", "--columns", "inside"]), run(&["--signed", "--columns", "inside,signed"]));
    assert_eq!((&*alone, &*other), ("inside\n1\n0\n0\n", "inside,signed_distance\n1,-0.5\n0,2.0\n0,0.0\n"));
    let report = |columns: &str| {
        let out = path(&folder, "inside.npy");
        json(&["query", &scene, "--points", &points, "--signed", "--columns", columns, "--out", &out, "--json"])
    };
    let (alone, other) = (report("query,inside"), report("query,inside,distance"));
    assert_eq!((&alone["inside"], &alone["answers"]), (&1.into(), &0.into()));
    assert_eq!((&other["inside"], &other["answers"]), (&1.into(), &3.into()));
    // The first query is nearest to the face at x = 0, and the second to its inside.
    assert_eq!(run(&["--columns", "normal"]), "nx,ny,nz\n-1.0,0.0,0.0\n-1.0,0.0,0.0\n-1.0,0.0,0.0\n");
    let open = write(&folder, "open.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n");
    let message = failure(&["query", &open, "--points", &points, "--signed=parity"], 1);
    assert!(message.contains("open.obj"), "{message}");
    let message = failure(&["query", &scene, "--points", &points, "--columns", "signed"], 2);
    assert!(message.contains("the column signed needs --signed"), "{message}");
}

#[test]
fn columns_are_those_that_are_named_in_every_format() {
    let folder = TempDir::new().unwrap();
    let scene = write(&folder, "s.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\no flat\nf 1 2 3\n");
    let points = write(&folder, "q.csv", "x,y,z\n0.25,0.25,2\n9,9,9\n");
    let all = "number,query,point,distance,lower_bound,barycentric,primitive,feature,object";
    let run = |out: &str| {
        let out = path(&folder, out);
        let arguments = ["query", &scene, "--points", &points, "--max-distance", "3", "--columns", all, "--out", &out];
        assert_eq!(p2m(&arguments).code, 0);
        fs::read(out).unwrap()
    };
    let csv = text(&run("a.csv"));
    let lines: Vec<_> = csv.lines().collect();
    assert_eq!(lines[0], "number,qx,qy,qz,x,y,z,distance,lower_bound,w0,w1,w2,primitive,feature,object");
    assert!(lines[1].starts_with("0,0.25,0.25,2.0,0.25,0.25,0.0,2.0,1.99"), "{csv}");
    assert!(lines[1].ends_with(",0.5,0.25,0.25,0,face,flat"), "{csv}");
    assert_eq!(lines[2], "1,9.0,9.0,9.0,,,,,,,,,,,");
    assert_eq!(lines[0].matches(',').count(), lines[2].matches(',').count());
    let npy = run("a.npy");
    let record = 8 + 24 + 24 + 8 + 8 + 24 + 4 + 4 + 4;
    let header = 10 + usize::from(u16::from_le_bytes([npy[8], npy[9]]));
    assert_eq!(npy.len(), header + 2 * record);
    assert_eq!(npy[header + record - 4..header + record], 0i32.to_le_bytes());
    assert_eq!(npy[npy.len() - 4..], (-1i32).to_le_bytes());
    let ply = run("a.ply");
    let end = ply.windows(11).position(|window| window == b"end_header\n").unwrap() + 11;
    assert_eq!(ply.len(), end + 2 * (record + 4));
    assert!(text(&ply[..end]).contains("property double number\n"));
    let message = failure(&["query", &scene, "--points", &points, "--columns", "query,query"], 2);
    assert!(message.contains("the column query is named twice"), "{message}");
    failure(&["query", &scene, "--points", &points, "--columns", "nothing"], 2);
}

#[test]
fn quiet_runs_write_errors_alone() {
    let folder = TempDir::new().unwrap();
    let out = path(&folder, "a.csv");
    for quiet in ["--quiet", "-q"] {
        let output = p2m(&["query", SCENE, "--random", "5", quiet, "--out", &out]);
        assert_eq!(output.code, 0);
        assert_eq!((text(&output.stderr).as_str(), text(&output.stdout).as_str()), ("", ""));
    }
    assert!(!failure(&["query", "none.obj", "--random", "5", "-q"], 1).is_empty());
}

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

fn zstd(bytes: &[u8]) -> Vec<u8> {
    ruzstd::encoding::compress_to_vec(bytes, ruzstd::encoding::CompressionLevel::Fastest)
}

#[test]
fn compressed_files_are_read_in_every_format() {
    let folder = TempDir::new().unwrap();
    let points = "x,y,z\n0.25,0.25,2\n1,2,3\n";
    let plain = write(&folder, "q.csv", points);
    let index = path(&folder, "index.p2m");
    assert_eq!(p2m(&["build", SCENE, "--backend", "octree", "--out", &index]).code, 0);
    let expected = table(&["query", SCENE, "--points", &plain]);
    let mut scenes = vec![("obj", fs::read(SCENE).unwrap()), ("p2m", fs::read(&index).unwrap())];
    for extension in ["ply", "stl", "off"] {
        let other = path(&folder, &format!("scene.{extension}"));
        // The scene has segments, which STL and OFF do not have.
        let output = p2m(&["generate", "ico-sphere", "--out", &other]);
        assert_eq!(output.code, 0, "{}", text(&output.stderr));
        scenes.push((extension, fs::read(other).unwrap()));
    }
    for (extension, bytes) in scenes {
        let uncompressed = write(&folder, &format!("u.{extension}"), &bytes);
        let expected_here = table(&["query", &uncompressed, "--points", &plain]);
        assert!(extension != "obj" || expected_here == expected);
        for (suffix, compress) in [("gz", gzip as fn(&[u8]) -> Vec<u8>), ("zst", zstd)] {
            // Two streams, one after the other, are one file.
            let half = bytes.len() / 2;
            let compressed = [compress(&bytes[..half]), compress(&bytes[half..])].concat();
            let scene = write(&folder, &format!("s.{extension}.{suffix}"), &compressed);
            let queries = write(&folder, &format!("q.csv.{suffix}"), compress(points.as_bytes()));
            assert_eq!(table(&["query", &scene, "--points", &queries]), expected_here, "{extension} {suffix}");
            let cut = write(&folder, &format!("cut.{extension}.{suffix}"), &compressed[..compressed.len() - 9]);
            failure(&["query", &cut, "--points", &plain], 1);
            // A bit that changes in the middle is found by the checksum, if nothing else finds it.
            let mut flipped = compressed.clone();
            for bit in 0..8 {
                flipped[compressed.len() / 3] = compressed[compressed.len() / 3] ^ (1 << bit);
                let flipped = write(&folder, &format!("flipped.{extension}.{suffix}"), &flipped);
                failure(&["query", &flipped, "--points", &plain], 1);
            }
        }
    }
}

#[test]
fn frames_of_zstd_that_have_no_data_are_skipped() {
    let folder = TempDir::new().unwrap();
    let skippable = [&[0x53, 0x2a, 0x4d, 0x18, 3, 0, 0, 0][..], b"abc"].concat();
    let (first, second) = (zstd(b"v 0 0 0\nv 1 0 0\n"), zstd(b"p 1\np 2\n"));
    let scene = [&skippable[..], &first, &skippable, &skippable, &second, &skippable].concat();
    let points = write(&folder, "q.csv", "x,y,z\n1,0,1\n");
    let query =
        |name: &str, bytes: &[u8]| ["query", &write(&folder, name, bytes), "--points", &points].map(str::to_owned);
    let arguments = query("s.obj.zst", &scene);
    let answers = table(&arguments.each_ref().map(String::as_str));
    assert!(answers.ends_with("\n1.0,0.0,1.0,1.0,0.0,0.0,1.0,1,vertex0\n"), "{answers}");
    let arguments = query("cut.obj.zst", &scene[..scene.len() - 1]);
    failure(&arguments.each_ref().map(String::as_str), 1);
}

#[test]
fn saved_indexes_are_mapped_on_request() {
    let folder = TempDir::new().unwrap();
    let index = path(&folder, "index.p2m");
    assert_eq!(p2m(&["build", SCENE, "--backend", "p2m", "--out", &index]).code, 0);
    let run = |more: &[&str]| table(&[&["query", &index, "--random", "100"], more].concat());
    assert_eq!(run(&["--map"]), run(&[]));
    let message = failure(&["query", SCENE, "--random", "5", "--map"], 2);
    assert!(message.contains("--map needs the file of a saved index"), "{message}");
    let message = failure(&["query", &path(&folder, "none.p2m"), "--random", "5", "--map"], 1);
    assert!(message.contains("none.p2m: cannot be read"), "{message}");
}

/// A saved index that answers no rays is not used without a word.
#[test]
fn rays_over_a_saved_index_without_rays_are_noted() {
    let folder = TempDir::new().unwrap();
    let index = path(&folder, "index.p2m");
    assert_eq!(p2m(&["build", SCENE, "--backend", "octree", "--out", &index]).code, 0);
    let summary = |scene: &str| text(&p2m(&["ray", scene, "--random", "5"]).stderr);
    let note = "note     the saved index (octree) answers no rays: aabb is built\n";
    assert!(summary(&index).starts_with(note), "{}", summary(&index));
    assert!(!summary(SCENE).contains("note"));
}

#[test]
fn directories_and_missing_folders_are_named() {
    let folder = TempDir::new().unwrap();
    let directory = folder.path().display().to_string();
    for arguments in
        [&["query", &directory, "--random", "3"][..], &["query", SCENE, "--points", &directory], &["info", &directory]]
    {
        let message = failure(arguments, 1);
        assert!(message.contains("is a directory"), "{message}");
    }
    let out = path(&folder, "none/a.csv");
    let message = failure(&["query", SCENE, "--random", "3", "--out", &out], 1);
    assert!(message.contains("the folder does not exist"), "{message}");
    let picture = path(&folder, "picture.jpg");
    let field = path(&folder, "field.npy");
    let message = failure(&["field", SCENE, "--resolution", "4", "--out", &field, "--slice", &picture], 2);
    assert!(message.contains("ends in .png"), "{message}");
}

/// The note comes before the work, which a broken pipe ends.
#[test]
fn huge_runs_are_announced() {
    let mut run = program(&["query", SCENE, "--random", "1000000000000", "--threads", "1"]);
    let mut child = run.stdout(std::process::Stdio::piped()).stderr(std::process::Stdio::piped()).spawn().unwrap();
    let mut some = [0; 1000];
    std::io::Read::read_exact(child.stdout.as_mut().unwrap(), &mut some).unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    let message = text(&output.stderr);
    assert!(message.starts_with("note     1,000,000,000,000 queries: about "), "{message}");
}
