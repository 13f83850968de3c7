//! Broken files: an error or a scene, never a panic, and never much memory.

mod common;

use common::{ENCODINGS, RICH_OBJ, obj, ply, rich_ply};
use p2m_mixed::{ReadError, Scene};
use peak_alloc::PeakAlloc;
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Far more than the files at hand need, far less than their headers can announce.
const MEGABYTES: f32 = 64.0;

type Reader = fn(&[u8]) -> Result<Scene, ReadError>;

fn files() -> Vec<(Vec<u8>, Reader)> {
    let mut files: Vec<(Vec<u8>, Reader)> = vec![(RICH_OBJ.into(), |b| obj(b))];
    files.extend(ENCODINGS.map(|e| (rich_ply(e), (|b| ply(b)) as Reader)));
    files
}

fn check(scene: Result<Scene, ReadError>) -> bool {
    match scene {
        Err(error) => {
            assert!(!error.to_string().is_empty());
            false
        }
        Ok(scene) => {
            let elements = scene.soup.elements().count();
            assert_eq!(scene.sources.len(), elements);
            true
        }
    }
}

#[test]
fn truncation_at_every_byte() {
    for (bytes, read) in files() {
        assert!(check(read(&bytes)));
        let ends = (0..bytes.len()).filter(|&end| check(read(&bytes[..end]))).count();
        // A PLY file says how long it is: only the line end of a text is not needed.
        if bytes.starts_with(b"ply") {
            assert!(ends <= 3, "{ends}");
        }
    }
    assert!(MEMORY.peak_usage_as_mb() < MEGABYTES, "{}", MEMORY.peak_usage_as_mb());
}

#[test]
fn random_damage() {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let mut read_well = 0;
    for round in 0..5000 {
        for (mut bytes, read) in files() {
            for _ in 0..=round % 4 {
                let at = rng.random_range(0..bytes.len());
                match rng.random_range(0..6) {
                    0 => bytes[at] = rng.random(),
                    1 => bytes[at] ^= 1 << rng.random_range(0..8),
                    2 => bytes[at] = *b"0123456789-+.#/\\\n\r eE".get(rng.random_range(0..21)).unwrap(),
                    3 => bytes.insert(at, rng.random()),
                    4 => drop(bytes.remove(at)),
                    _ => {
                        // A piece of the file in another place.
                        let from = rng.random_range(0..bytes.len());
                        let piece = bytes[from..bytes.len().min(from + 20)].to_vec();
                        bytes.splice(at..at, piece);
                    }
                }
            }
            read_well += usize::from(check(read(&bytes)));
        }
    }
    assert!(read_well > 500, "{read_well}: the damage should not always be noticed");
    assert!(MEMORY.peak_usage_as_mb() < MEGABYTES, "{}", MEMORY.peak_usage_as_mb());
}

#[test]
fn noise() {
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    for length in 0..2000 {
        let mut bytes = vec![0; length];
        rng.fill_bytes(&mut bytes);
        check(obj(&bytes));
        check(ply(&bytes));
        // Noise behind a header.
        for encoding in ENCODINGS {
            let mut file = rich_ply(encoding);
            let data = file.windows(11).position(|w| w == b"end_header\n").unwrap() + 11;
            file.truncate(data);
            file.extend(&bytes);
            check(ply(&file));
        }
        // Noise of the letters of the format.
        let text: Vec<u8> = bytes.iter().map(|b| b"vflp0123456789 -\n\n/#\\."[usize::from(*b) % 22]).collect();
        check(obj(&text));
    }
    assert!(MEMORY.peak_usage_as_mb() < MEGABYTES, "{}", MEMORY.peak_usage_as_mb());
}
