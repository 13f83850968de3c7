//! Tests that saved indexes return the same answers bit for bit, copied or mapped, and that invalid files are typed
//! errors.
#![cfg(all(feature = "bvh", feature = "interception", feature = "kdop", feature = "scene"))]

use nalgebra::Point3;
use p2m::scene::{Scene, load_scene, save_scene};
use p2m::storage::{LoadError, Reader, SavedFile, VERSION, Writer};
use p2m::{
    AabbTree, BuildIndex, ClosestPoint, KdopTree, OctreeIndex, P2mIndex, Point, PrimitiveId, PrimitiveSet, Ray,
    RayQuery, Segment, Soup,
};
use p2m_testkit::ball::Ball;
use p2m_testkit::scenes::{self, kinds_and_layout};
use p2m_testkit::{amount, cases, rng, vector};
use rand::{Rng, RngExt};
use std::panic::{AssertUnwindSafe, catch_unwind};

type Answers = Vec<Option<(u64, PrimitiveId, [u64; 3])>>;
type Loaded = Result<Answers, LoadError>;

fn answers(index: &dyn ClosestPoint<f64>, queries: &[Point3<f64>]) -> Answers {
    let bits = |c: p2m::Closest<f64>| (c.distance.to_bits(), c.primitive, [0, 1, 2].map(|k| c.point[k].to_bits()));
    queries.iter().map(|q| index.closest_point(q).map(bits)).collect()
}

pub(super) fn queries(rng: &mut impl Rng, soup: &Soup<f64>, count: usize) -> Vec<Point3<f64>> {
    let mut queries: Vec<_> = (0..count).map(|i| Point3::from(vector(rng) * [1.0, 5.0, 1e6][i % 3])).collect();
    queries.extend(soup.positions().iter().take(count));
    queries
}

/// A type of index: its answers after the build, its file, and its answers after loading.
pub(super) struct Kind {
    pub(super) name: &'static str,
    built: fn(&Soup<f64>, &[Point3<f64>]) -> Answers,
    pub(super) saved: fn(&Scene) -> Vec<u8>,
    loaded: fn(&Soup<f64>, &Reader, &[Point3<f64>]) -> Loaded,
    /// Loads the index of a file over its scene, and returns the file of saving it again.
    saved_again: fn(&Scene, &Reader) -> Vec<u8>,
}

/// Returns the file of a scene and an index, which `save` adds.
fn file<'a>(scene: &'a Scene, save: impl FnOnce(&mut Writer<'a>)) -> Vec<u8> {
    let (mut writer, mut bytes) = (Writer::default(), Vec::new());
    save_scene(scene, &mut writer);
    save(&mut writer);
    writer.write(&mut bytes).expect("memory");
    bytes
}

macro_rules! kinds {
    ($($name:literal: $index:ty,)*) => {
        [$(Kind {
            name: $name,
            built: |soup, queries| answers(&<$index>::build(soup, &Default::default()).expect("valid"), queries),
            saved: |scene| {
                let index = <$index>::build(&scene.soup, &Default::default()).expect("valid");
                file(scene, |writer| index.save(writer))
            },
            loaded: |soup, reader, queries| Ok(answers(&<$index>::load(soup, reader)?, queries)),
            saved_again: |scene, reader| {
                let index = <$index>::load(&scene.soup, reader).expect("an index");
                file(scene, |writer| index.save(writer))
            },
        },)*]
    };
}

pub(super) const INDEXES: [Kind; 6] = kinds! {
    "aabb": AabbTree<f64, &Soup<f64>>,
    "kdop-6": KdopTree<f64, &Soup<f64>, 6>,
    "kdop-14": KdopTree<f64, &Soup<f64>, 14>,
    "kdop-26": KdopTree<f64, &Soup<f64>, 26>,
    "octree": OctreeIndex<f64, &Soup<f64>>,
    "p2m": P2mIndex<f64, &Soup<f64>>,
};

#[test]
fn what_is_loaded_answers_as_what_was_saved() {
    let folder = tempfile::tempdir().expect("a folder");
    for case in cases(96, 24) {
        let (mut rng, (kinds, layout)) = (rng("saved", case), kinds_and_layout(case));
        // Any 24 cases have all sizes, and any 96 have each size in every layout.
        let count = [0, 1, 17, amount(400, 60)][((case / 4 + case / 24) % 4) as usize];
        let scene = Scene::from(scenes::soup(&mut rng, kinds, layout, count));
        let queries = queries(&mut rng, &scene.soup, amount(60, 8));
        for index in &INDEXES {
            let bytes = (index.saved)(&scene);
            let path = folder.path().join("index.p2m");
            std::fs::write(&path, &bytes).expect("written");
            let expected = (index.built)(&scene.soup, &queries);
            // SAFETY: nobody else knows the file.
            #[allow(unsafe_code, reason = "the file is that of this test alone")]
            let mapped = unsafe { SavedFile::map(&path) }.expect("mapped");
            for file in [SavedFile::open(&path).expect("read"), mapped] {
                let reader = file.checked().expect("whole");
                assert_eq!(p2m::storage::kind(reader).expect("a kind"), index.name);
                let again = load_scene(reader).expect("a scene");
                assert_eq!(again, scene, "case {case}: {} {kinds:?} {layout:?}", index.name);
                let found = (index.loaded)(&again.soup, reader, &queries).expect("an index");
                assert_eq!(found, expected, "case {case}: {} {kinds:?} {layout:?} {count}", index.name);
                // Searches for pairs and boxes use numbers that these queries do not need.
                let bytes_again = (index.saved_again)(&again, reader);
                assert!(bytes_again == bytes, "case {case}: {} {kinds:?} {layout:?} {count}", index.name);
            }
        }
    }
}

/// Returns a mesh large enough for cells, with names, skipped records and a position that no primitive uses.
pub(super) fn scene() -> Scene {
    let mut text = String::from("usemtl red\nv 9 9 9\n");
    let (rings, sides) = (12, 16);
    for i in 0..=rings {
        for j in 0..sides {
            let [u, v] = [f64::from(i) * 0.25, f64::from(j) * std::f64::consts::TAU / f64::from(sides)];
            text += &format!("v {} {} {}\n", v.cos() * (1.0 + 0.1 * u.sin()), v.sin(), u);
        }
    }
    for i in 0..rings {
        if i % 5 == 0 {
            text += &format!("o ring ä {i}\n");
        }
        for j in 0..sides {
            let at = |i: i32, j: i32| 2 + i * sides + j % sides;
            text += &format!("f {} {} {} {}\n", at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
        }
    }
    text += "o wires\nl 2 40 90\np 3\n";
    p2m::scene::read_obj(text.as_bytes(), "scene").expect("a scene")
}

#[test]
fn names_origins_and_what_was_skipped_come_back() {
    let scene = scene();
    let counts = [scene.objects.len(), scene.skipped.len(), scene.soup.segments().len()];
    assert_eq!(counts, [4, 1, 2], "{:?} {:?}", scene.objects, scene.skipped);
    let mut file = Vec::new();
    p2m::scene::write_p2m(&scene, &mut file).expect("memory");
    assert_eq!(p2m::scene::read_p2m(&file[..], "scene").expect("a scene"), scene);
    // A file with only a scene has no index.
    let saved = SavedFile::read(&file[..]).expect("read");
    let error = p2m::storage::kind(saved.checked().expect("whole")).expect_err("none");
    assert!(matches!(error, LoadError::Missing { .. }), "{error}");
}

/// Loads a file as a program would, and returns the answers or the error.
pub(super) fn answers_of(index: &Kind, bytes: &[u8], queries: &[Point3<f64>]) -> Loaded {
    let file = SavedFile::read(bytes)?;
    let reader = file.checked()?;
    (index.loaded)(&load_scene(reader)?.soup, reader, queries)
}

#[test]
fn every_corruption_is_an_error() {
    let scene = scene();
    let mut unchanged = 0;
    let cases = cases(1667, 72);
    for (number, index) in INDEXES.iter().enumerate() {
        let queries = queries(&mut rng("corruption", number as u64), &scene.soup, 20);
        let bytes = (index.saved)(&scene);
        let expected = answers_of(index, &bytes, &queries).expect("whole");
        for case in cases.clone() {
            let mut rng = rng(index.name, case);
            let mut other = bytes.clone();
            match case % 6 {
                // A bit or a byte changes, in the whole file or in its beginning.
                0 => other[rng.random_range(0..bytes.len())] ^= 1 << rng.random_range(0..8),
                1 => other[rng.random_range(0..bytes.len().min(2048))] ^= rng.random_range(1..=255),
                2 => other[rng.random_range(0..64)] = rng.random(),
                // The file is truncated, or bytes are appended.
                3 => other.truncate(rng.random_range(0..bytes.len())),
                4 => other.extend((0..rng.random_range(1..200)).map(|_| 0)),
                // A part of the file is copied over another part.
                _ => {
                    let len = rng.random_range(1..bytes.len() / 2);
                    let [from, to] = [0, 1].map(|_| rng.random_range(0..bytes.len() - len));
                    other.copy_within(from..from + len, to);
                }
            }
            let found = catch_unwind(AssertUnwindSafe(|| answers_of(index, &other, &queries)));
            match found.unwrap_or_else(|_| panic!("{} {case}: a panic", index.name)) {
                Ok(found) => {
                    assert_eq!(found, expected, "{} {case}", index.name);
                    assert!(other == bytes, "{} {case}: a change was not found", index.name);
                    unchanged += 1;
                }
                Err(error) => assert!(!matches!(error, LoadError::Io(_)), "{} {case}: {error}", index.name),
            }
        }
    }
    let all = cases.len() * INDEXES.len();
    assert!(cases.is_replay() || unchanged < all / 10, "{unchanged} of {all}");
}

#[test]
fn other_files_are_told_apart() {
    let scene = scene();
    let bytes = (INDEXES[0].saved)(&scene);
    let error = |bytes: &[u8]| answers_of(&INDEXES[0], bytes, &[]).expect_err("no index");
    assert!(matches!(error(b""), LoadError::Foreign));
    assert!(matches!(error(b"solid cube\nendsolid\n"), LoadError::Foreign));
    assert!(matches!(error(&bytes[..40]), LoadError::Length { found: 40, .. }));
    assert!(matches!(error(&bytes[..bytes.len() - 64]), LoadError::Length { .. }));
    let mut newer = bytes.clone();
    newer[8..12].copy_from_slice(&(VERSION + 1).to_le_bytes());
    let message = error(&newer);
    assert!(matches!(message, LoadError::Version { found } if found == VERSION + 1), "{message}");
    let mut last = bytes.clone();
    let offset = last.len() - 80;
    last[offset] ^= 4;
    assert!(matches!(error(&last), LoadError::Damaged { .. }), "{}", error(&last));

    let valid = SavedFile::read(&bytes[..]).expect("read");
    let reader = valid.checked().expect("whole");
    let other = OctreeIndex::<f64, _>::load(&scene.soup, reader).expect_err("another kind");
    assert_eq!(other.to_string(), "has an index of the kind aabb, not octree");
    // The sets differ in the number of primitives, in a coordinate, or in a kind.
    let moved = scene.soup.triangles().iter().map(|t| t.map(|i| scene.soup.positions()[i as usize]));
    let triangles: Vec<_> = moved.map(|[a, b, c]| p2m::Triangle::new(a, b, c)).collect();
    assert!(matches!(AabbTree::<f64, _>::load(&triangles, reader), Err(LoadError::OtherSet)));
    let mut positions = scene.soup.positions().to_vec();
    positions[5].x = positions[5].x.next_up();
    let near = Soup::new(positions, scene.soup.elements()).expect("valid");
    assert!(matches!(AabbTree::<f64, _>::load(&near, reader), Err(LoadError::OtherSet)));
    assert!(AabbTree::<f64, _>::load(&scene.soup, reader).is_ok());
    assert!(SavedFile::open("no such file".as_ref()).is_err_and(|e| matches!(e, LoadError::Io(_))));
}

#[test]
fn rays_moved_sets_and_primitives_of_ones_own_work_as_before() {
    let mut rng = rng("saved-others", 0);
    let scene = scene();
    let bytes = (INDEXES[2].saved)(&scene);
    let file = SavedFile::read(&bytes[..]).expect("read");
    let reader = file.checked().expect("whole").clone();
    drop((file, bytes));
    let mut loaded = KdopTree::<f64, &Soup<f64>, 14>::load(&scene.soup, &reader).expect("an index");
    let mut built = KdopTree::<f64, &Soup<f64>, 14>::new(&scene.soup).expect("valid");
    assert_eq!(loaded.directions(), built.directions());
    let rays: Vec<Ray> =
        (0..200).map(|_| Ray::new(&Point3::from(vector(&mut rng) * 3.0), &vector(&mut rng)).expect("a ray")).collect();
    for ray in &rays {
        assert_eq!(loaded.all_intersections(ray), built.all_intersections(ray));
    }
    assert!(rays.iter().filter(|ray| loaded.do_intersect(ray)).count() > 10);
    // A loaded tree can be refitted to moved positions as a built one.
    let moved = scene.soup.positions().iter().map(|p| p * 1.5 + vector(&mut rng) * 0.01).collect();
    let moved = Soup::new(moved, scene.soup.elements()).expect("valid");
    let queries = queries(&mut rng, &moved, 100);
    loaded.refit(&moved, &Default::default()).expect("as many");
    built.refit(&moved, &Default::default()).expect("as many");
    assert_eq!(answers(&loaded, &queries), answers(&built, &queries));

    let balls: Vec<Ball> =
        (0..300).map(|_| Ball { centre: Point3::from(vector(&mut rng)), radius: rng.random_range(0.0..0.1) }).collect();
    let index = P2mIndex::<f64, _>::new(&balls).expect("valid");
    let (mut writer, mut bytes) = (Writer::default(), Vec::new());
    index.save(&mut writer);
    writer.write(&mut bytes).expect("memory");
    let file = SavedFile::read(&bytes[..]).expect("read");
    let again = P2mIndex::<f64, _>::load(&balls, file.checked().expect("whole")).expect("an index");
    assert_eq!(answers(&again, &queries), answers(&index, &queries));
    assert_eq!(again.report(), index.report());
    let fewer = &balls[1..];
    assert!(matches!(P2mIndex::<f64, _>::load(fewer, file.unchecked()), Err(LoadError::OtherSet)));
}

/// Files that announce more than they can contain are errors, and take no memory.
#[test]
fn sizes_that_are_merely_announced_are_refused() {
    const ENOUGH: u64 = 1 << 20;
    let mut file = Vec::new();
    p2m::scene::write_p2m(&Scene::from(scenes::skewed_gear(10)), &mut file).expect("memory");
    // The header has the number of sections and the length. Each section has an offset, a number of elements and their
    // size.
    let sections = u32::from_le_bytes([file[12], file[13], file[14], file[15]]) as usize;
    let places = (0..sections).flat_map(|section| [32, 40, 48].map(|field| (64 + 64 * section + field, 8)));
    for (offset, size) in [(12, 4), (16, 8)].into_iter().chain(places) {
        for number in [u64::MAX, 1 << 60, u64::from(u32::MAX)] {
            let mut other = file.clone();
            other[offset..offset + size].copy_from_slice(&number.to_le_bytes()[..size]);
            // The checksum is corrected, as if the file had been written like this.
            let sum = twox_hash::XxHash3_64::oneshot(&other[64..64 + 64 * sections]);
            other[24..32].copy_from_slice(&sum.to_le_bytes());
            let load = || -> Result<Scene, LoadError> { load_scene(SavedFile::read(&other[..])?.checked()?) };
            let taken = allocation_counter::measure(|| assert!(load().is_err(), "{number} at {offset}")).bytes_max;
            assert!(taken < ENOUGH, "{number} at {offset}: {taken} bytes");
        }
    }
}

#[test]
fn single_precision_comes_back_as_well() {
    let wires: Vec<Segment<f32>> = (0..500u16)
        .map(|i| f32::from(i).sin_cos())
        .map(|(x, y)| Segment::new(Point3::new(x, y, x * y), Point3::new(-y, x, 1.0)))
        .collect();
    let index = P2mIndex::<f32, _>::new(&wires).expect("valid");
    let (mut writer, mut bytes) = (Writer::default(), Vec::new());
    index.save(&mut writer);
    writer.write(&mut bytes).expect("memory");
    let file = SavedFile::read(&bytes[..]).expect("read");
    let again = P2mIndex::<f32, _>::load(&wires, file.checked().expect("whole")).expect("an index");
    let mut rng = rng("saved-f32", 0);
    for _ in 0..500 {
        let query = Point3::from((vector(&mut rng) * 2.0).map(|x| x as f32));
        assert_eq!(again.closest_point(&query), index.closest_point(&query));
    }
    // Points are not segments, even at the same coordinates.
    let points: Vec<Point<f32>> = wires.iter().map(|wire| Point::new(wire.vertices[0])).collect();
    assert_eq!(points.len(), PrimitiveSet::<f32>::len(&wires));
    assert!(matches!(P2mIndex::<f32, _>::load(&points, file.unchecked()), Err(LoadError::OtherSet)));
}
