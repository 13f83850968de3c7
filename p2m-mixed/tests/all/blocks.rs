//! Files that are read in blocks give the scenes and errors of files that are read sequentially.

use crate::common::{ENCODINGS, Encoding, N, Ply, RICH_OBJ, bits, elements, rich_ply};
use p2m_mixed::engine::read_scene_in_blocks;
use p2m_mixed::{Format, ReadError, Scene};
use p2m_testkit::{cases, rng};
use rand::seq::IndexedRandom;
use rand::{Rng, RngExt};
use rayon::ThreadPoolBuilder;
use std::io::{self, BufReader, Read};

/// Returns everything that a reader returns, in a form that can be compared.
fn outcome(result: Result<Scene, ReadError>) -> String {
    match result {
        Err(error) => format!("{error} at {:?}", error.location),
        Ok(scene) => format!(
            "{:?} {:?} {:?} {:?} {:?}",
            bits(&scene),
            elements(&scene),
            scene.sources,
            scene.objects,
            scene.skipped
        ),
    }
}

/// A reader that returns an error after some bytes.
struct Broken<'a>(&'a [u8]);

impl Read for Broken<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.0.is_empty() { Err(io::Error::other("broken")) } else { self.0.read(buffer) }
    }
}

/// Compares blocks of several sizes, on one thread and on three, with sequential reading. Returns whether it succeeds.
fn check(file: &[u8], format: Format, pools: &[rayon::ThreadPool]) -> bool {
    let read = |block_bytes| read_scene_in_blocks(file, format, "t", block_bytes);
    let read_broken = |block_bytes| read_scene_in_blocks(BufReader::new(Broken(file)), format, "t", block_bytes);
    let (expected, expected_broken) = (outcome(read(0)), outcome(read_broken(0)));
    for pool in pools {
        for block_bytes in [1, 2, 3, 5, 8, 13, 40, 200, 1000] {
            let (found, found_broken) =
                pool.install(|| (outcome(read(block_bytes)), outcome(read_broken(block_bytes))));
            let text = String::from_utf8_lossy(file);
            assert_eq!(found, expected, "blocks of {block_bytes} bytes of {text:?}");
            assert_eq!(found_broken, expected_broken, "blocks of {block_bytes} bytes of broken {text:?}");
        }
    }
    read(0).is_ok()
}

fn pools() -> [rayon::ThreadPool; 2] {
    [1, 3].map(|threads| ThreadPoolBuilder::new().num_threads(threads).build().unwrap())
}

/// Returns an OBJ file of usual statements, most of which are valid, and some that are not.
fn random_obj(rng: &mut impl Rng) -> Vec<u8> {
    const WORDS: [&str; 34] = [
        "vn 0 0 1",
        "vt 0 0",
        " vn 1 0 0",
        "g left",
        "g right",
        "o one",
        "o two # 2",
        "usemtl red",
        "s off",
        "# v 1 1 1",
        "# path\\",
        "",
        " \t",
        "v nan 0 0",
        "v 1 2",
        "v 1 2 x",
        "v 1 2 3 # c",
        "v 1 2 3#c",
        "v 1e400 0 0",
        "f 1 2 0",
        "f 1 2 99999999999",
        "f 1 2 3 # c",
        "f 1 \\",
        "l 1",
        "p",
        "f 1/ 2//1 3/1/1/1",
        "f 1/+1 2/-1 3",
        "fo 1 2 3",
        "curv 0 1",
        "nonsense",
        "v 1 2 3 4 5 6",
        "\u{feff}v 0 0 0",
        "vn",
        "f 1 2 -9999",
    ];
    let end = *["\n", "\r\n", "\r"].choose(rng).unwrap();
    // Rare errors make valid files, and frequent ones make early errors.
    let rare = *[0.02, 0.3].choose(rng).unwrap();
    let mut file = Vec::new();
    let mut count = 0i32;
    for _ in 0..rng.random_range(1..80) {
        let line = if rng.random_bool(rare) {
            (*WORDS.choose(rng).unwrap()).to_owned()
        } else if count < 3 || rng.random_bool(0.4) {
            count += 1;
            format!("v {} {} {}", rng.random_range(-9..9), rng.random::<f32>(), rng.random::<f64>())
        } else if rng.random_bool(0.2) {
            (*WORDS[..13].choose(rng).unwrap()).to_owned()
        } else {
            let forward = if rng.random_bool(rare) { 5 } else { 0 };
            let shape = *["f", "f", "f", "l", "p", "  f"].choose(rng).unwrap();
            let mut line = shape.to_owned();
            for _ in 0..rng.random_range(2..5) {
                let index = rng.random_range(1..=count + forward);
                let index = if rng.random_bool(0.3) { (index - count - 1).min(-1) } else { index };
                line += &format!(" {index}{}", ["", "", "/1", "//2", "/1/2"].choose(rng).unwrap());
            }
            line
        };
        file.extend_from_slice(line.as_bytes());
        file.extend_from_slice(if rng.random_bool(0.05) { b"\n" } else { end.as_bytes() });
    }
    if rng.random_bool(0.3) {
        file.truncate(rng.random_range(0..=file.len()));
    }
    file
}

#[test]
fn obj_in_blocks() {
    let pools = pools();
    for end in 0..=RICH_OBJ.len() {
        check(&RICH_OBJ.as_bytes()[..end], Format::Obj, &pools);
    }
    let valid =
        cases(3000, 200).filter(|&case| check(&random_obj(&mut rng("obj in blocks", case)), Format::Obj, &pools));
    assert!(valid.count() > 20);
}

/// Returns a PLY file of rows that blocks can have, with some that they leave to the sequential reader.
fn random_ply(rng: &mut impl Rng, encoding: Encoding) -> Vec<u8> {
    let rare = *[0.0, 0.02, 0.2].choose(rng).unwrap();
    let [vertices, faces, edges] = [0; 3].map(|_: i32| rng.random_range(1..30));
    let has_ids = rng.random_bool(0.3);
    let faces_first = rng.random_bool(0.3);
    let has_extras = rng.random_bool(0.5);
    let extra = if has_extras { "property list uchar short bones\n" } else { "" };
    let id = if has_ids { "property int p2m_id\n" } else { "" };
    let vertex = format!("element vertex {vertices}\nproperty float x\nproperty double y\n{extra}property short z\n");
    let face = format!("element face {faces}\nproperty list uchar int vertex_indices\n{id}");
    let edge = format!("element edge {edges}\nproperty int vertex1\nproperty uchar w\nproperty int vertex2\n{id}");
    let order = if faces_first { [face, vertex, edge] } else { [vertex, face, edge] };
    let mut file = Ply::new(encoding, order.concat().trim_end());
    let mut next_id = 0;
    for element in if faces_first { [1, 0, 2] } else { [0, 1, 2] } {
        for _ in 0..[vertices, faces, edges][element] {
            let indices = [0; 6].map(|_| {
                let is_bad = rng.random_bool(rare / 4.0);
                N::I32(if is_bad { vertices } else { rng.random_range(0..vertices) })
            });
            let mut row = Vec::new();
            match element {
                0 => {
                    let x = if rng.random_bool(rare) { f32::NAN } else { rng.random() };
                    row.extend([N::F32(x), N::F64(rng.random())]);
                    let bones = rng.random_range(0..3u8);
                    if has_extras {
                        row.push(N::U8(bones));
                        row.extend((0..bones).map(|bone| N::I16(bone.into())));
                    }
                    row.push(N::I16(rng.random()));
                }
                1 => {
                    let count = if has_ids || rng.random_bool(0.8) { 3 } else { rng.random_range(2..6) };
                    row.push(N::U8(if rng.random_bool(rare) { 1 } else { count }));
                    row.extend(&indices[..count.into()]);
                }
                _ => row.extend([indices[0], N::U8(7), indices[1]]),
            }
            if has_ids && element > 0 {
                row.push(N::I32(next_id));
                next_id += i32::from(!rng.random_bool(rare / 10.0));
            }
            file = file.row(&row);
            if encoding == Encoding::Ascii && rng.random_bool(rare) {
                let insert: &[u8] = [&b"\n"[..], b" \r\n", b"\r", b"7\n", b"x "].choose(rng).unwrap();
                file.bytes.extend_from_slice(insert);
            }
        }
    }
    file.bytes.extend_from_slice([&b""[..], b"\n", b"rest of it\n"].choose(rng).unwrap());
    if rng.random_bool(0.3) {
        file.bytes.truncate(rng.random_range(0..=file.bytes.len()));
    }
    file.bytes
}

#[test]
fn ply_in_blocks() {
    let pools = pools();
    for encoding in ENCODINGS {
        let rich = rich_ply(encoding);
        for end in (0..=rich.len()).rev().take(300) {
            check(&rich[..end], Format::Ply, &pools);
        }
        let file = |case| random_ply(&mut rng("ply in blocks", case), encoding);
        let valid = cases(2000, 150).filter(|&case| check(&file(case), Format::Ply, &pools));
        assert!(valid.count() > 20);
    }
    // Lines of a text may end in three ways, and an element may extend over several lines.
    for end in ["\r", "\r\n"] {
        let text = String::from_utf8(rich_ply(Encoding::Ascii)).unwrap();
        assert!(check(text.replace('\n', end).as_bytes(), Format::Ply, &pools));
        let at = text.find("end_header").unwrap() + 11;
        check((text[..at].to_owned() + &text[at..].replace(' ', end)).as_bytes(), Format::Ply, &pools);
    }
}
