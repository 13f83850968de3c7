//! Broken files give an error or a scene, but no panic, and take little memory. Scenes are written and read again.

use crate::common::{
    ENCODINGS, RICH_NPY, elements, lossless, npy, obj, off, ply, read_back, rich_files, rich_ply, stl,
};
use nalgebra::Point3;
use p2m_core::Ray;
use p2m_mixed::{Format, PointFormat, ReadError, Scene, read_points_from, read_rays_from, read_scene_from};
use p2m_testkit::{cases, point_file, rng};
use rand::{Rng, RngExt};

/// A limit far above the memory that the files need, and far below the memory that their headers can announce.
const MAX_ALLOCATED_BYTES: u64 = 64 << 20;

/// Runs `work`, and fails if it had more than [`MAX_ALLOCATED_BYTES`] allocated at a time.
fn with_little_memory(work: impl FnOnce()) {
    let taken = allocation_counter::measure(work).bytes_max;
    assert!(taken < MAX_ALLOCATED_BYTES, "{taken} bytes");
}

/// A function that reads a file, checks the result, and returns whether the file is valid.
type Reader = Box<dyn Fn(&[u8]) -> bool>;

/// Returns files, how to read them, and the number of lengths at which a truncated file is still valid.
fn files() -> Vec<(Vec<u8>, Reader, usize)> {
    let anywhere = usize::MAX;
    let scene = |format| Box::new(move |b: &[u8]| check(read_scene_from(b, format, "t"))) as Reader;
    let points = |format| Box::new(move |b: &[u8]| check_points(read_points_from(b, format, "t"))) as Reader;
    let rays = |format| Box::new(move |b: &[u8]| check_rays(read_rays_from(b, format, "t"))) as Reader;
    let single = "{'descr': '<f4', 'fortran_order': False, 'shape': (1, 6)}\n";
    let mut files = vec![
        (npy(RICH_NPY, &[0; 2 * 44]), points(PointFormat::Npy), 0),
        (b"qx;qy;qz\n1;2;-0.0\n".into(), points(PointFormat::Csv), anywhere),
        (npy(single, &[60; 24]), rays(PointFormat::Npy), 0),
        (b"ox,oy,oz,dx,dy,dz\n1,2,3,4,5,6\n".into(), rays(PointFormat::Csv), anywhere),
        (b"1 2 3\n# c\n4 5 6\n".into(), points(PointFormat::Xyz), anywhere),
    ];
    files.extend(rich_files().into_iter().map(|(bytes, format, most)| (bytes, scene(format), most)));
    // Data after the vertices is not read.
    files.extend(ENCODINGS.map(|e| (rich_ply(e), points(PointFormat::Ply), anywhere)));
    files
}

fn check(scene: Result<Scene, ReadError>) -> bool {
    match scene {
        Err(error) => {
            assert!(!error.to_string().is_empty());
            false
        }
        Ok(scene) => {
            let expected = elements(&scene);
            assert_eq!(scene.sources.len(), expected.len());
            for format in lossless() {
                assert_eq!(elements(&read_back(&scene, format)), expected, "{format}");
            }
            assert_eq!(read_back(&scene, Format::Obj).objects, scene.objects);
            true
        }
    }
}

fn check_points(points: Result<Vec<Point3<f64>>, ReadError>) -> bool {
    match points {
        Err(error) => {
            assert!(!error.to_string().is_empty());
            false
        }
        Ok(points) => {
            let rows: Vec<[f64; 3]> = points.iter().map(|p| p.coords.into()).collect();
            for &format in PointFormat::ALL {
                let file = point_file(format.name(), &rows);
                let again = read_points_from(&file[..], format, "t").unwrap();
                let is_same = |(a, b): (&f64, &f64)| a == b || (a.is_nan() && b.is_nan());
                assert_eq!(again.len(), points.len(), "{format}");
                assert!(again.iter().zip(&points).all(|(a, b)| a.iter().zip(b.iter()).all(is_same)), "{format}");
            }
            true
        }
    }
}

fn check_rays(rays: Result<Vec<Ray>, ReadError>) -> bool {
    match rays {
        Err(error) => {
            assert!(!error.to_string().is_empty());
            false
        }
        Ok(rays) => {
            let numbers = |ray: &Ray| [ray.origin().coords, ray.direction()].map(<[f64; 3]>::from);
            let rows: Vec<[f64; 6]> =
                rays.iter().map(|ray| numbers(ray).as_flattened().try_into().expect("six")).collect();
            for &format in PointFormat::ALL {
                let file = point_file(format.name(), &rows);
                assert_eq!(read_rays_from(&file[..], format, "t").unwrap(), rays, "{format}");
            }
            true
        }
    }
}

#[test]
fn truncation_at_every_byte() {
    with_little_memory(|| {
        for (bytes, read, most) in files() {
            assert!(read(&bytes));
            let ends = (0..bytes.len()).filter(|&end| read(&bytes[..end])).count();
            assert!(ends <= most, "{ends}");
        }
    });
}

#[test]
fn random_damage() {
    with_little_memory(|| {
        let mut read_well = 0;
        let cases = cases(5000, 250);
        for round in cases.clone() {
            let mut rng = rng("random damage", round);
            for (mut bytes, read, _) in files() {
                for _ in 0..=round % 4 {
                    let at = rng.random_range(0..bytes.len());
                    match rng.random_range(0..6) {
                        0 => bytes[at] = rng.random(),
                        1 => bytes[at] ^= 1 << rng.random_range(0..8),
                        2 => bytes[at] = *b"0123456789-+.#/\\\n\r eE".get(rng.random_range(0..21)).unwrap(),
                        3 => bytes.insert(at, rng.random()),
                        4 => drop(bytes.remove(at)),
                        _ => {
                            // A part of the file is copied to another position.
                            let from = rng.random_range(0..bytes.len());
                            let piece = bytes[from..bytes.len().min(from + 20)].to_vec();
                            bytes.splice(at..at, piece);
                        }
                    }
                }
                read_well += usize::from(read(&bytes));
            }
        }
        assert!(cases.have_more_than(500, read_well), "{read_well}: the damage should not always be noticed");
    });
}

/// Returns short files that announce more than there can be.
#[test]
fn sizes_that_are_merely_announced() {
    let huge = "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty double x\nproperty double y\n\
                property double z\nelement face 4000000000\nproperty list uint uint vertex_indices\nend_header\n";
    let header = "{'descr': '<f8', 'fortran_order': False, 'shape': (1000000000000, 3), }\n";
    with_little_memory(|| {
        assert!(!check(ply(huge.as_bytes())));
        assert!(!check(stl([&[b' '; 80][..], &[0xff; 4]].concat())));
        assert!(!check(off("OFF 4000000000 4000000000 0\n0 0 0\n")));
        assert!(!check_points(read_points_from(&npy(header, &[])[..], PointFormat::Npy, "t")));
    });
}

#[test]
fn noise() {
    with_little_memory(|| {
        for case in cases(2000, 200) {
            // Steps without a common divisor reach every length, and reach short and long ones early.
            let (mut rng, length) = (rng("noise", case), case as usize * 677 % 2000);
            let mut bytes = vec![0; length];
            rng.fill_bytes(&mut bytes);
            for &format in Format::ALL {
                check(read_scene_from(&bytes[..], format, "t"));
            }
            for &format in PointFormat::ALL {
                check_points(read_points_from(&bytes[..], format, "t"));
                check_rays(read_rays_from(&bytes[..], format, "t"));
            }
            // These are endless facets and faces of noise.
            check(stl([&[0; 80][..], &[0xff; 4], &bytes].concat()));
            check(off([b"OFF BINARY\n", &[0, 0, 0, 2, 0x7f, 0xff, 0xff, 0xff, 0, 0, 0, 0][..], &bytes].concat()));
            // This is noise after a header.
            for encoding in ENCODINGS {
                let mut file = rich_ply(encoding);
                let data = file.windows(11).position(|w| w == b"end_header\n").unwrap() + 11;
                file.truncate(data);
                file.extend(&bytes);
                check(ply(&file));
            }
            // This is noise of the characters of the format.
            let text: Vec<u8> = bytes.iter().map(|b| b"vflp0123456789 -\n\n/#\\."[usize::from(*b) % 22]).collect();
            check(obj(&text));
            check(off([b"OFF\n9 9 9\n", &text[..]].concat()));
        }
    });
}
