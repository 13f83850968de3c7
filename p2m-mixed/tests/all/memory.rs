//! Reading takes at most three times the memory of the scene, for large files of every format.

use crate::common::{formats_of_triangles, lossless, measured_on_one_thread, written};
use nalgebra::Point3;
use p2m_core::{Element, PrimitiveSet, Soup};
use p2m_mixed::{Format, Scene, read_scene, read_scene_from};
use p2m_testkit::amount;

/// The size of buffers that do not depend on the file.
const FIXED: usize = 1 << 17;

/// Reads a scene, and returns it with its memory and the largest memory while it was read.
fn measure(read: impl FnOnce() -> Scene + Send) -> (Scene, usize, usize) {
    let mut scene = None;
    let taken = measured_on_one_thread(|| scene = Some(read()));
    (scene.expect("a scene"), usize::try_from(taken.bytes_current).expect("not negative"), taken.bytes_max as usize)
}

/// Returns the memory of a scene according to its documentation, without names.
fn scene_bytes(scene: &Scene) -> usize {
    let soup = &scene.soup;
    let kinds = [soup.points().len(), soup.segments().len(), soup.triangles().len()];
    let slots = if kinds.iter().filter(|&&n| n > 0).count() > 1 { 4 * soup.len() } else { 0 };
    let indices = 4 * (kinds[0] + 2 * kinds[1] + 3 * kinds[2]);
    24 * soup.positions().len() + indices + slots + 4 * scene.sources.len()
}

fn check(what: &str, file: &[u8], format: Format) -> Scene {
    let (scene, held, peak) = measure(|| read_scene_from(file, format, "large").unwrap());
    check_peak(what, &scene, held, peak);
    scene
}

fn check_peak(what: &str, scene: &Scene, held: usize, peak: usize) {
    println!("{what}: {:.2} of {held} bytes", peak as f64 / held as f64);
    assert!(peak <= 3 * held + FIXED, "{what}: {peak} bytes taken for {held}");
    let least = scene_bytes(scene);
    assert!(held >= least, "{what}");
    let names: usize = scene.objects.iter().map(|o| o.name.len()).sum();
    let objects = 2 * scene.objects.len() * size_of_val(scene.objects.first().map_or(&[][..], std::slice::from_ref));
    assert!(held <= least + names + objects + 1000, "{what}: {held} bytes held, {least} needed");
}

/// Returns a grid of n x n squares, each of two triangles. A mixed grid also has every tenth edge and every tenth
/// vertex, alternately.
fn grid(n: u32, is_mixed: bool) -> Scene {
    let side = n + 1;
    let positions = (0..side * side)
        .map(|i| Point3::new(f64::from(i % side), f64::from(i / side), f64::from(i % 7) * 0.5))
        .collect::<Vec<_>>();
    let elements = (0..n * n).flat_map(|i| {
        let a = i / n * side + i % n;
        let triangles = [Element::Triangle([a, a + 1, a + side]), Element::Triangle([a + 1, a + side + 1, a + side])];
        let others = [Element::Segment([a, a + 1]), Element::Point(a)];
        triangles.into_iter().chain(others.into_iter().filter(move |_| is_mixed && i % 10 == 0))
    });
    Soup::new(positions, elements).unwrap().into()
}

#[test]
fn reading_takes_no_more_than_three_times_the_scene() {
    // Just above a power of two, the capacity of growing vectors is largest relative to their length. Other sizes are
    // just below.
    for n in amount(vec![363, 361, 400, 460], vec![91]) {
        let scene = grid(n, false);
        // The file of a saved index is in memory as a whole.
        for format in formats_of_triangles().filter(|format| *format != Format::P2m) {
            let again = check(&format!("{n}, {format}"), &written(&scene, format), format);
            assert_eq!(again.soup.triangles().len(), scene.soup.triangles().len());
        }
        let scene = grid(n, true);
        for format in lossless().filter(|format| *format != Format::P2m) {
            let again = check(&format!("{n}, mixed, {format}"), &written(&scene, format), format);
            assert_eq!(again.soup, scene.soup);
        }

        // The faces come before their vertices.
        let soup = grid(n, false).soup;
        let xyz = "property float x\nproperty float y\nproperty float z\n";
        let header = format!(
            "ply\nformat binary_little_endian 1.0\nelement face {}\nproperty list uchar int vertex_indices\n\
            element vertex {}\n{xyz}end_header\n",
            soup.triangles().len(),
            soup.positions().len()
        );
        let mut file = header.into_bytes();
        for triangle in soup.triangles() {
            file.push(3);
            triangle.iter().for_each(|i| file.extend(i.to_le_bytes()));
        }
        soup.positions().iter().flat_map(|p| p.iter()).for_each(|&x| file.extend((x as f32).to_le_bytes()));
        assert_eq!(check(&format!("{n}, faces first"), &file, Format::Ply).soup, soup);

        // The point cloud is that of a scanner, in which every other point is invalid.
        let count = 2 * n * n;
        let header = format!("ply\nformat binary_little_endian 1.0\nelement vertex {count}\n{xyz}end_header\n");
        let mut file = header.into_bytes();
        for i in 0..count {
            let x = if i % 2 == 0 { f32::NAN } else { i as f32 };
            file.extend([x, x, x].iter().flat_map(|x| x.to_le_bytes()));
        }
        let scene = check(&format!("{n}, half a cloud"), &file, Format::Ply);
        assert_eq!(scene.soup.points().len(), (n * n) as usize);

        // These are point clouds, and a file with a group for each face.
        let mut cloud = String::new();
        let mut groups = String::from("v 0 0 0\n");
        for i in 0..n * n {
            cloud += &format!("v {i} 0.25 {}\n", i % 100);
            groups += &format!("g part {}\nf 1 1 1\ng part {}\n", i / 2, i / 2);
        }
        assert_eq!(check(&format!("{n}, cloud"), cloud.as_bytes(), Format::Obj).soup.points().len(), (n * n) as usize);
        let scene = check(&format!("{n}, groups"), groups.as_bytes(), Format::Obj);
        assert_eq!(scene.objects.len(), (n * n).div_ceil(2) as usize);
    }

    // These are a file of one strip, and facets without shared vertices. The sizes are just above a power of two again.
    for count in amount(vec![262_147i32, 300_000], vec![32_771]) {
        let mut strip = b"ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
            property float z\nelement tristrips 1\nproperty list int uchar vertex_indices\nend_header\n"
            .to_vec();
        strip.extend([0; 36]);
        strip.extend(count.to_le_bytes());
        strip.extend((0..count).map(|i| (i % 3) as u8));
        check("strip", &strip, Format::Ply);
    }
    for count in amount(vec![76_460u32, 87_382, 100_000], vec![10_923]) {
        let positions = (0..3 * count).map(|i| Point3::new(f64::from(i), 0.0, f64::from(i % 17))).collect();
        let triangles = (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let apart: Scene = Soup::from_triangles(positions, triangles).unwrap().into();
        assert_eq!(check("apart", &written(&apart, Format::Stl), Format::Stl).soup, apart.soup);
    }

    for path in p2m_testkit::model_files() {
        let (scene, held, peak) = measure(|| read_scene(&path).unwrap());
        check_peak(&path.display().to_string(), &scene, held, peak);
    }
}
