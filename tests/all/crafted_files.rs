//! Tests of saved indexes with correct checksums and wrong contents. Each is refused by a typed error, or searches in
//! it end.
#![cfg(all(feature = "bvh", feature = "interception", feature = "kdop", feature = "scene"))]

use super::saved::{INDEXES, Kind, answers_of, queries, scene};
use cpu_time::ThreadTime;
use nalgebra::Point3;
use p2m::storage::LoadError;
use p2m_testkit::saved_file::{correct_checksums, section_mut};
use p2m_testkit::{cases, rng};
use rand::RngExt;
use std::time::Duration;

/// The number of bytes of a packet.
const PACKET: usize = 448;
/// The number of bytes of a block of a list.
const BLOCK: usize = 128;
/// The number of bytes of a site, and of a block of its neighbours.
const SITE: usize = 64;

/// The upper half of a NaN of 64 bits.
const NAN_HIGH_BITS: u32 = 0x7ff8_0000;

fn index(name: &str) -> &'static Kind {
    INDEXES.iter().find(|index| index.name == name).expect("an index")
}

/// Returns the file of an index after a change of a section, with correct checksums.
fn crafted(index: &Kind, section: &str, change: impl FnOnce(&mut [u8])) -> Vec<u8> {
    let mut bytes = (index.saved)(&scene());
    change(section_mut(&mut bytes, section));
    correct_checksums(&mut bytes);
    bytes
}

/// Returns a change that writes a 32-bit number at an offset.
fn put(at: usize, number: u32) -> impl FnOnce(&mut [u8]) {
    move |section| section[at..at + 4].copy_from_slice(&number.to_le_bytes())
}

/// Returns a change that writes a byte at an offset.
fn byte(at: usize, number: u8) -> impl FnOnce(&mut [u8]) {
    move |section| section[at] = number
}

fn some_queries() -> Vec<Point3<f64>> {
    queries(&mut rng("crafted", 0), &scene().soup, 60)
}

/// Asserts that a changed file is refused with a reason that names a section.
#[track_caller]
fn assert_refused(name: &str, section: &str, change: impl FnOnce(&mut [u8]), reason: &str) {
    let file = crafted(index(name), section, change);
    let found = answers_of(index(name), &file, &some_queries()).map(|answers| answers.len());
    let error = found.expect_err(reason);
    assert!(matches!(error, LoadError::Inconsistent { .. }), "{error:?}");
    assert!(error.to_string().contains(reason), "{error}");
}

/// Returns the 32-bit numbers of a section.
fn numbers(name: &str, section: &str) -> Vec<u32> {
    let mut bytes = (index(name).saved)(&scene());
    section_mut(&mut bytes, section).chunks_exact(4).map(|n| u32::from_le_bytes(n.try_into().expect("four"))).collect()
}

#[test]
fn trees_that_lie_are_refused() {
    let children = numbers("aabb", "tree/children");
    let packet = children.iter().position(|child| child >> 31 == 1 && *child != u32::MAX).expect("a packet");
    let node = children.iter().position(|child| child >> 31 == 0).expect("a node below the root");
    // A child is its own parent, which would make a search endless; it does not exist; or it is used twice.
    assert_refused("aabb", "tree/children", put(4 * node, 0), "used twice");
    assert_refused("aabb", "tree/children", put(4 * node, 1 << 20), "does not exist");
    assert_refused("kdop-14", "tree/children", put(0, 1 << 31 | 1 << 20), "does not exist");
    let other = children.iter().rposition(|child| child >> 31 == 1 && *child != u32::MAX).expect("a packet");
    assert_refused("aabb", "tree/children", put(4 * packet, children[other]), "used twice");
    assert_refused("aabb", "tree/children", put(4 * packet, u32::MAX), "not used");
    // The number of primitives is wrong, and the root is not the first node.
    assert_refused("aabb", "tree", byte(96, 1), "number of primitives");
    assert_refused("aabb", "tree", put(104, 1), "before its parent");
    assert_refused("aabb", "tree/bounds", put(0, f32::NAN.to_bits()), "NaN");
    assert_refused("kdop-26", "tree/directions", put(4, NAN_HIGH_BITS), "polytope");
}

/// The depth in the file is ignored, so a search always has a large enough stack.
#[test]
fn a_wrong_depth_changes_nothing() {
    let queries = some_queries();
    let expected = answers_of(index("aabb"), &(index("aabb").saved)(&scene()), &queries).expect("valid");
    for depth in [0, 1, 255] {
        let file = crafted(index("aabb"), "tree", byte(88, depth));
        assert_eq!(answers_of(index("aabb"), &file, &queries).expect("valid"), expected);
    }
}

#[test]
fn packets_that_lie_are_refused() {
    assert_refused("aabb", "tree/packets", byte(404, 17), "out of range");
    assert_refused("aabb", "tree/packets", byte(PACKET + 404, 0), "out of range");
    assert_refused("aabb", "tree/packets", byte(405, 9), "out of range");
    assert_refused("aabb", "tree/packets", byte(352, 255), "out of range");
    assert_refused("aabb", "tree/packets", put(400, 7), "out of range");
    assert_refused("aabb", "tree/packets", byte(439, 0x7f), "out of range");
    let ids = numbers("aabb", "tree/packets");
    assert_refused("octree", "tree/packets", put(288, ids[73]), "an id is wrong");
    assert_refused("octree", "tree/packets", put(288, 1 << 30), "an id is wrong");
    assert_refused("p2m", "tree/vertices", put(4, NAN_HIGH_BITS), "not finite");
    assert_refused("aabb", "tree/first-vertices", put(4, 1 << 30), "ascending");
    assert_refused("aabb", "tree/first-vertices", put(0, 1), "all vertices");
}

#[test]
fn octrees_that_lie_are_refused() {
    let codes = numbers("octree", "octree/codes");
    let kind = |code: &u32| code >> 29;
    let position = |wanted: u32| codes.iter().position(|code| kind(code) == wanted).expect("a code");
    // A row leads to itself or to the row before it, which would make locating a query endless.
    assert_refused("octree", "octree/codes", put(0, 0), "before the code");
    assert_refused("octree", "octree/codes", put(4 * position(2), 2 << 29 | 1 << 28), "a list does not exist");
    assert_refused("octree", "octree/codes", put(4 * position(2), 3 << 29 | 1 << 20), "a primitive does not exist");
    assert_refused("octree", "octree/codes", put(4 * position(2), 7 << 29), "no meaning");
    assert_refused("octree", "octree/lists", byte(125, 200), "list");
    assert_refused("octree", "octree/lists", put(BLOCK + 64, 1 << 20), "out of range");
    assert_refused("octree", "octree/lists", byte(124, 9), "out of range");
    assert_refused("octree", "octree/lists", byte(119, 31), "out of range");
    assert_refused("octree", "octree/lists", byte(118, 127), "out of range");
    // A report on this number of cells would not fit into memory.
    assert_refused("octree", "octree", byte(64 + 5, 1), "more cells");
}

#[test]
fn p2m_indexes_that_lie_are_refused() {
    let sites = numbers("p2m", "voronoi/sites");
    let site = |wanted: fn(&[u32]) -> bool| SITE * sites.chunks_exact(16).position(wanted).expect("a site");
    let listed = site(|site| site[15] < 1 << 30);
    assert_refused("p2m", "voronoi/sites", put(listed + 60, 1 << 30), "exceeds the section");
    assert_refused("p2m", "voronoi/sites", put(listed + 56, 1 << 30), "a primitive does not exist");
    assert_refused("p2m", "voronoi/sites", put(listed + 60, 0), "exceeds the section");
    assert_refused("p2m", "voronoi/sites", put(listed + 32, 1 << 30), "a block does not exist");
    assert_refused("p2m", "voronoi/sites", put(listed + 28, 0), "a block belongs to another site");
    assert_refused("p2m", "voronoi/neighbours", byte(56, 1), "has no use");
    assert_refused("aabb", "tree/packets", byte(407, 1), "out of range");
    assert_refused("aabb", "tree/packets", byte(406, 2), "out of range");
    // The next packet belongs to a node, and the last packet has no next one.
    assert_refused("aabb", "tree/packets", byte(406, 1), "used twice");
    let last = numbers("aabb", "tree/packets").len() * 4 - PACKET;
    assert_refused("aabb", "tree/packets", byte(last + 406, 1), "does not exist");
    assert_refused("octree", "octree/lists", byte(126, 1), "out of range");
    assert_refused("p2m", "voronoi/sites", put(listed + 4, NAN_HIGH_BITS), "not finite");
    assert_refused("p2m", "voronoi/sites", put(listed + 60, u32::MAX - 1), "anchor");
    assert_refused("p2m", "voronoi/neighbours/names", put(0, 1 << 30), "a site does not exist");
    assert_refused("p2m", "voronoi/lists", byte(BLOCK * (listed / SITE) + 124, 0), "out of range");
    assert_refused("p2m", "hints/near/cells", put(0, 1 << 30), "a cell has no site");
    assert_refused("p2m", "hints/near/cells", put(0, u32::MAX), "a cell has no site");
    assert_refused("p2m", "hints/far/counts", put(0, 1 << 30), "not as many cells");
    assert_refused("p2m", "voronoi", byte(160, 7), "neither 0 nor 1");
}

/// All sites claim that the next site is much nearer, so a walk would go in circles.
#[test]
fn walks_end_whatever_the_offsets_are() {
    let file = crafted(index("p2m"), "voronoi/neighbours", |section| {
        for block in section.chunks_exact_mut(SITE) {
            // The offsets to all neighbours are long, in a fixed direction.
            block[..16].copy_from_slice(&[0xff; 16]);
        }
    });
    let start = ThreadTime::now();
    let answers = answers_of(index("p2m"), &file, &some_queries()).expect("numbers in range");
    assert_eq!(answers.len(), some_queries().len());
    assert!(start.elapsed() < Duration::from_secs(1));
}

/// Unused bytes have to be zero, and headers have a checksum.
#[test]
fn unused_bytes_are_refused() {
    let bytes = (index("aabb").saved)(&scene());
    for at in 32..64 {
        let mut other = bytes.clone();
        other[at] = 1;
        let error = answers_of(index("aabb"), &other, &[]).expect_err("refused");
        assert_eq!(error.to_string(), "has contradictory contents: in the header, unused bytes are not zero");
    }
}

/// Every section is changed at random. Loading and searching end without a panic and in little time.
#[test]
fn random_lies_neither_panic_nor_search_without_end() {
    let queries = queries(&mut rng("lies", 0), &scene().soup, 12);
    let cases = cases(40_000, 400);
    let mut loaded = 0;
    let files: Vec<_> = INDEXES.iter().map(|index| (index.saved)(&scene())).collect();
    for case in cases.clone() {
        let number = case as usize % INDEXES.len();
        let (mut rng, mut bytes) = (rng("lie", case), files[number].clone());
        let sections: Vec<_> = p2m_testkit::saved_file::entries(&bytes)
            .filter_map(|entry| p2m_testkit::saved_file::section(&bytes, entry))
            .filter(|section| !section.is_empty())
            .collect();
        for _ in 0..rng.random_range(1..4) {
            let section = &sections[rng.random_range(0..sections.len())];
            let at = rng.random_range(section.clone());
            match rng.random_range(0..4) {
                0 => bytes[at] = rng.random(),
                1 => bytes[at] ^= 1 << rng.random_range(0..8),
                _ => {
                    let at = at - at % 4;
                    let number = [0, 1, rng.random_range(0..2000), 1 << 31, u32::MAX, f32::NAN.to_bits()];
                    let number: u32 = number[rng.random_range(0..number.len())];
                    if at + 4 <= section.end {
                        bytes[at..at + 4].copy_from_slice(&number.to_le_bytes());
                    }
                }
            }
        }
        correct_checksums(&mut bytes);
        let start = ThreadTime::now();
        loaded += usize::from(answers_of(&INDEXES[number], &bytes, &queries).is_ok());
        assert!(start.elapsed() < Duration::from_secs(1), "case {case}");
    }
    assert!(cases.have_more_than(5_000, loaded), "{loaded}");
}
