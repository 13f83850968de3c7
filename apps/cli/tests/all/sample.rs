//! Tests of `p2m sample`.

use crate::common::*;
use std::fs;
use tempfile::TempDir;

/// Returns the numbers of an array of an NPZ file, whose members are stored, and its header.
fn array(file: &[u8], name: &str) -> (String, Vec<f64>) {
    let mut archive = zip::ZipArchive::new(std::io::Cursor::new(file)).unwrap();
    let mut bytes = Vec::new();
    std::io::Read::read_to_end(&mut archive.by_name(&format!("{name}.npy")).unwrap(), &mut bytes).unwrap();
    let length = usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let header = text(&bytes[10..10 + length]);
    let rest = &bytes[10 + length..];
    let numbers = match () {
        () if header.contains("<f8") => rest.as_chunks().0.iter().map(|x| f64::from_le_bytes(*x)).collect(),
        () if header.contains("<f4") => rest.as_chunks().0.iter().map(|x| f64::from(f32::from_le_bytes(*x))).collect(),
        () => rest.as_chunks().0.iter().map(|x| i64::from_le_bytes(*x) as f64).collect(),
    };
    (header, numbers)
}

#[test]
fn samples_have_their_signed_distances_and_the_same_bits_on_any_number_of_threads() {
    let folder = TempDir::new().unwrap();
    let (ball, out) = (path(&folder, "ball.ply"), path(&folder, "samples.npz"));
    table(&["generate", "ico-sphere", "--frequency", "30", "--out", &ball]);
    let command = ["sample", &ball, "--near", "2e3", "--uniform", "1000", "--sigma", "0.01", "--seed", "4"];
    let report = json(&[&command[..], &["--out", &out, "--json"]].concat());
    assert_eq!((&report["near"], &report["uniform"], &report["seed"]), (&2000.into(), &1000.into(), &4.into()));
    let file = fs::read(&out).unwrap();
    assert_eq!(report["out"]["bytes"], file.len());
    let ((header, points), (_, distances)) = (array(&file, "points"), array(&file, "distances"));
    assert!(header.contains("'shape': (3000, 3)") && distances.len() == 3000, "{header}");
    let (points, _) = points.as_chunks::<3>();
    let norm = |[x, y, z]: [f64; 3]| (x * x + y * y + z * z).sqrt();
    assert!(points.iter().zip(&distances).all(|(point, d)| (norm(*point) - 1.0 - d).abs() < 0.002));
    let rms = (distances[..2000].iter().map(|d| d * d).sum::<f64>() / 2000.0).sqrt();
    assert!((0.009..0.011).contains(&rms), "{rms}");
    assert!(points[2000..].iter().flatten().all(|x| x.abs() <= 1.1001) && points[2000..].iter().any(|p| p[0] > 1.02));
    table(&[&command[..], &["--out", &out, "--threads", "1", "--backend", "octree"]].concat());
    assert_eq!(fs::read(&out).unwrap(), file);
    table(&[&command[..], &["--out", &out, "--f32"]].concat());
    let (header, rounded) = array(&fs::read(&out).unwrap(), "points");
    assert!(
        header.contains("<f4") && rounded.iter().zip(points.iter().flatten()).all(|(a, b)| *a == f64::from(*b as f32))
    );
}

#[test]
fn points_of_the_surface_have_their_primitives() {
    let folder = TempDir::new().unwrap();
    let scene = write(&folder, "two.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 3\nf 1 2 3\nf 1 2 4\n");
    let out = path(&folder, "points.npz");
    table(&["sample", &scene, "--surface", "4000", "--out", &out]);
    let file = fs::read(&out).unwrap();
    let (_, primitives) = array(&file, "primitives");
    let (_, points) = array(&file, "points");
    let first = primitives.iter().filter(|id| **id == 0.0).count();
    assert!((900..1100).contains(&first) && primitives.len() == 4000, "{first}");
    assert!(points.chunks(3).zip(&primitives).all(|(p, id)| if *id == 0.0 { p[2] == 0.0 } else { p[1] == 0.0 }));
}

#[test]
fn wrong_uses_are_refused() {
    let folder = TempDir::new().unwrap();
    let scene = write(&folder, "two.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\n");
    let out = path(&folder, "samples.npz");
    assert!(failure(&["sample", &scene, "--near", "5", "--out", &out], 1).contains("no triangles"));
    assert!(failure(&["sample", &scene, "--out", &out], 2).contains("--surface"));
    assert!(failure(&["sample", &scene, "--surface", "5", "--near", "5", "--out", &out], 2).contains("cannot be used"));
    assert!(failure(&["sample", &scene, "--surface", "5", "--out", &path(&folder, "s.csv")], 2).contains(".npz"));
    let empty = write(&folder, "empty.xyz", "");
    assert!(failure(&["sample", &empty, "--surface", "5", "--out", &out], 1).contains("the scene is empty"));
    let flat = write(&folder, "flat.obj", "v 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 3\n");
    assert!(failure(&["sample", &flat, "--surface", "5", "--out", &out], 1).contains("no area or length of it is"));
    for count in ["1e15", "18446744073709551615"] {
        assert!(failure(&["sample", &scene, "--surface", count, "--out", &out], 1).contains("no memory for "));
        let both = ["sample", &scene, "--near", count, "--uniform", count, "--out", &out];
        assert!(failure(&both, 1).contains("no memory for "));
    }
    assert!(!std::path::Path::new(&out).exists());
}
