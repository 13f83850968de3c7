//! Checks of saved indexes from bytes: damaged files, files modified on purpose, and files made up.
//!
//! The first byte selects one of these, and the next two a valid file. Damage has to be detected, or change no answer.
//! A file that is modified and has its checksums corrected passes for a valid one: `p2m::storage` promises that loading
//! it succeeds or is an error, takes memory in proportion to its size, and has no undefined behaviour. Its answers may
//! be wrong, but no query panics, and all queries together take less than a second.

use super::bytes::Bytes;
use super::memory;
use cpu_time::ThreadTime;
use nalgebra::Point3;
use p2m::core::IndexStats;
use p2m::scene::{Scene, load_scene, read_p2m, save_scene, write_p2m};
use p2m::storage::{LoadError, Reader, SavedFile, Writer};
use p2m::{
    AabbTree, BuildIndex, CertifiedQuery, ClosestPoint, Element, KdopTree, NearQuery, OctreeIndex, P2mIndex,
    PrimitiveId, QueryOptions, Soup,
};
use p2m_testkit::saved_file::{HEADER_BYTES, correct_checksums, entries, section};
use std::sync::LazyLock;
use std::time::Duration;

/// The memory that loading may take for each byte of a file.
const MEMORY_PER_BYTE: usize = 64;
/// The largest CPU time of loading and querying a file that was modified on purpose.
const MAX_TIME: Duration = Duration::from_secs(1);

type Answers = Vec<Option<(u64, PrimitiveId, [u64; 3])>>;

/// The outcome of an input.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Reached {
    /// The file was refused.
    Refused,
    /// The file was loaded and answered queries, correctly where that is promised.
    Answered,
}

/// An index with the queries that every index answers.
trait LoadedIndex: ClosestPoint<f64> + NearQuery<f64> + CertifiedQuery<f64> + IndexStats<f64> {}

impl<I: ClosestPoint<f64> + NearQuery<f64> + CertifiedQuery<f64> + IndexStats<f64>> LoadedIndex for I {}

type LoadResult<'a> = Result<Box<dyn LoadedIndex + 'a>, LoadError>;

/// A type of index, with functions that write its file and load it.
struct Kind {
    saved: fn(&Scene) -> Vec<u8>,
    loaded: for<'a> fn(&'a Soup<f64>, &Reader) -> LoadResult<'a>,
    name: &'static str,
}

macro_rules! kinds {
    ($all:ident: $($name:literal: $index:ident $(<$k:literal>)?,)*) => {
        const $all: &[Kind] = &[$(Kind {
            name: $name,
            saved: |scene| {
                let index = $index::<f64, &Soup<f64> $(, $k)?>::build(&scene.soup, &Default::default())
                    .expect("finite");
                let (mut writer, mut bytes) = (Writer::default(), Vec::new());
                save_scene(scene, &mut writer);
                index.save(&mut writer);
                writer.write(&mut bytes).expect("memory");
                bytes
            },
            loaded: |soup, reader| Ok(Box::new($index::<f64, &Soup<f64> $(, $k)?>::load(soup, reader)?)),
        },)*];
    };
}

kinds! {
    KINDS:
    "aabb": AabbTree,
    "kdop-14": KdopTree<14>,
    "kdop-26": KdopTree<26>,
    "octree": OctreeIndex,
    "p2m": P2mIndex,
}

/// Returns a bent strip that is large enough for cells, a tripod, one point, and an empty scene.
fn scenes() -> [Scene; 4] {
    let at = |i: i32, j: i32| {
        let (x, y) = (f64::from(i) * 0.5, f64::from(j) * 0.5);
        Point3::new(x, y, x * x * 0.125 - x * y * 0.25)
    };
    let (long, wide) = (9, 7);
    let positions = (0..long * wide).map(|n| at(n / wide, n % wide)).collect();
    let corner = |i: i32, j: i32| u32::try_from(i * wide + j).expect("not negative");
    let cells = (0..long - 1).flat_map(|i| (0..wide - 1).map(move |j| (i, j)));
    let triangles = cells.flat_map(|(i, j)| {
        let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
        [Element::Triangle([a, b, c]), Element::Triangle([a, c, d])]
    });
    let strip = Soup::new(positions, triangles.collect::<Vec<_>>()).expect("finite");
    let text = "o feet\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\np 1\no legs\nl 1 2\nl 1 3\no roof\nf 2 3 4\n";
    let tripod = p2m::scene::read_obj(text.as_bytes(), "tripod").expect("a scene");
    let point = Soup::new(vec![Point3::new(1.0, 2.0, 3.0)], [Element::Point(0)]).expect("finite");
    [Scene::from(strip), tripod, Scene::from(point), Scene::default()]
}

/// A valid file with its answers.
struct ValidFile {
    bytes: Vec<u8>,
    answers: Answers,
}

/// The valid files of every scene and type of index.
static VALID_FILES: LazyLock<Vec<ValidFile>> = LazyLock::new(|| {
    let of = |scene: &Scene, kind: &Kind| {
        let bytes = (kind.saved)(scene);
        let answers = answers_of(&bytes).expect("valid");
        ValidFile { bytes, answers }
    };
    scenes().iter().flat_map(|scene| KINDS.iter().map(move |kind| of(scene, kind))).collect()
});

fn query_points(soup: &Soup<f64>) -> Vec<Point3<f64>> {
    let mut query_points =
        [[0.0; 3], [1.1, 0.7, 0.2], [-3.0, 9.0, 1.0], [1e4, -2e5, 7e3], [1e200, 0.0, 0.0]].map(Point3::from).to_vec();
    query_points.extend(soup.positions().iter().step_by(5).take(6).filter(|p| p.iter().all(|x| x.is_finite())));
    query_points
}

/// Loads the index of a file over the scene of the file, and passes both to `use_it`.
fn loaded<R>(bytes: &[u8], use_it: impl FnOnce(&Soup<f64>, &dyn LoadedIndex) -> R) -> Result<R, LoadError> {
    let missing = |section: &str| LoadError::Missing { section: section.to_owned() };
    let mut scene = None;
    let limit = MEMORY_PER_BYTE * bytes.len();
    let file = memory::at_most(limit, || SavedFile::read(bytes))?;
    let reader = file.checked()?;
    let soup = &scene.insert(memory::at_most(limit, || load_scene(reader))?).soup;
    let name = p2m::storage::kind(reader)?;
    let kind = KINDS.iter().find(|kind| kind.name == name).ok_or_else(|| missing(&name))?;
    let index = memory::at_most(limit, || (kind.loaded)(soup, reader))?;
    Ok(use_it(soup, &*index))
}

/// Returns the answers of the index of a file.
fn answers_of(bytes: &[u8]) -> Result<Answers, LoadError> {
    let bits = |c: p2m::Closest<f64>| (c.distance.to_bits(), c.primitive, [0, 1, 2].map(|k| c.point[k].to_bits()));
    loaded(bytes, |soup, index| {
        let query_points = query_points(soup);
        let mut answers: Answers = query_points.iter().map(|q| index.closest_point(q).map(bits)).collect();
        let mut side_by_side = vec![None; 2 * query_points.len()];
        index.closest_points_into(
            &[&query_points[..], &query_points].concat(),
            &QueryOptions::default(),
            &mut side_by_side,
        );
        answers.extend(side_by_side.into_iter().map(|c| c.map(bits)));
        answers
    })
}

/// Loads a file that passes for a valid one, and checks that searches in it end.
fn check_modified(bytes: &[u8]) -> Reached {
    let start = ThreadTime::now();
    let read = loaded(bytes, |soup, index| {
        index.list_lengths();
        for point in &query_points(soup) {
            index.closest_point(point);
            index.closest_point_with(point, &QueryOptions::default().with_max_visits(1));
            index.k_nearest(point, 3, f64::INFINITY);
            index.all_within(point, 2.0);
            // Only primitives without vertices have no certified answers.
            let _ = index.certified_closest_point(point, &QueryOptions::default());
            index.list_length(point);
        }
        let points = [query_points(soup), query_points(soup), query_points(soup)].concat();
        index.closest_points_into(&points, &QueryOptions::default(), &mut vec![None; points.len()]);
    });
    assert!(start.elapsed() < MAX_TIME, "queries without end");
    let scene = memory::at_most(MEMORY_PER_BYTE * bytes.len(), || read_p2m(bytes, "fuzz"));
    if let Ok(scene) = scene {
        let mut written = Vec::new();
        write_p2m(&scene, &mut written).expect("memory");
        let again = read_p2m(&written[..], "again").expect("valid");
        assert!(again.soup.elements().eq(scene.soup.elements()) && again.objects == scene.objects);
    }
    checked_result(read).map_or(Reached::Refused, |_| Reached::Answered)
}

/// Returns the result of loading; an error has to have a message.
fn checked_result<R>(read: Result<R, LoadError>) -> Option<R> {
    if let Err(error) = &read {
        assert!(!matches!(error, LoadError::Io(_)) && !error.to_string().is_empty(), "{error:?}");
    }
    read.ok()
}

/// Modifies a file as an input demands: in the header, the table, or a section.
fn modify(file: &mut Vec<u8>, bytes: &mut Bytes<'_>) {
    while !bytes.is_empty() && !file.is_empty() {
        let operation = bytes.below(8);
        let all: Vec<_> = entries(file).collect();
        let parts = all.iter().filter_map(|entry| section(file, *entry)).filter(|part| !part.is_empty());
        let mut parts: Vec<_> = parts.collect();
        parts.extend(all.iter().map(|entry| entry + 32..entry + 56));
        parts.push(0..file.len().min(HEADER_BYTES));
        let position = |bytes: &mut Bytes<'_>| {
            let part = &parts[bytes.below(256) % parts.len()];
            part.start + bytes.pair() % part.len()
        };
        let at = position(bytes);
        let mut put = |at: usize, value: &[u8]| {
            // Elements are aligned in their section.
            let at = at - at % value.len();
            if let Some(to) = file.get_mut(at..at + value.len()) {
                to.copy_from_slice(value);
            }
        };
        match operation {
            0 => put(at, &[bytes.byte()]),
            1 => file[at] ^= 1 << bytes.below(8),
            2 => put(at, &bytes.pick(&[0, 1, 2, 8, 1 << 30, 1 << 31, 3 << 30, u32::MAX - 1, u32::MAX]).to_le_bytes()),
            3 => put(at, &u32::from(bytes.byte()).to_le_bytes()),
            4 => put(at, &bytes.pick(&[0.0, -1.0, 1e-300, f64::MAX, f64::INFINITY, f64::NAN]).to_le_bytes()),
            5 => put(at, &bytes.word().to_le_bytes()),
            6 => {
                let (from, len) = (position(bytes), 1 + usize::from(bytes.byte()));
                let len = len.min(file.len() - at.max(from));
                file.copy_within(from..from + len, at);
            }
            _ => match bytes.signed() {
                more @ 0.. => file.resize(file.len() + usize::from(more.unsigned_abs()), 0),
                less => file.truncate(file.len().saturating_sub(usize::from(less.unsigned_abs()))),
            },
        }
    }
}

/// Runs the check of an input.
///
/// # Panics
/// Panics if a promise is broken.
pub fn check(input: &[u8]) -> Reached {
    let mut bytes = Bytes::new(input);
    let (mode, scene, kind) = (bytes.below(3), bytes.below(4), bytes.below(KINDS.len()));
    let valid = &VALID_FILES[scene * KINDS.len() + kind];
    let mut file = match mode {
        0 | 1 => valid.bytes.clone(),
        _ => bytes.rest().to_vec(),
    };
    if mode < 2 {
        modify(&mut file, &mut bytes);
    }
    if mode == 0 {
        let Some(answers) = checked_result(answers_of(&file)) else { return Reached::Refused };
        assert_eq!(answers, valid.answers, "another answer");
        return Reached::Answered;
    }
    correct_checksums(&mut file);
    check_modified(&file)
}
