//! Builds, queries, moves, saves, loads and drops random scenes on all cores, for as long as requested. No answer may
//! be lost, and memory has to remain constant.
//!
//! `P2M_SOAK=600 cargo test --release --test soak -- --nocapture` runs for ten minutes. The default is a moment, or
//! three seconds with `P2M_DEEP`.
#![cfg(all(feature = "bvh", feature = "interception", feature = "kdop"))]

use nalgebra::Point3;
use p2m::storage::{SavedFile, Writer};
use p2m::{AabbTree, BruteForce, BuildIndex, ClosestPoint, KdopTree, OctreeIndex, P2mIndex, PrimitiveId, Soup};
use p2m_testkit::amount;
use p2m_testkit::extremes::Extreme;
use p2m_testkit::scenes::{self, KINDS, LAYOUTS};
use peak_alloc::PeakAlloc;
use rand::{Rng, RngExt};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// The number of times that memory is measured.
const MEASUREMENTS: usize = 10;

type Answers = Vec<Option<(u64, PrimitiveId)>>;

fn answers(index: &(impl ClosestPoint<f64> + ?Sized), queries: &[Point3<f64>]) -> Answers {
    queries.iter().map(|q| index.closest_point(q).map(|c| (c.distance.to_bits(), c.primitive))).collect()
}

fn brute(soup: &Soup<f64>, queries: &[Point3<f64>]) -> Answers {
    answers(&BruteForce::new(soup).expect("valid"), queries)
}

/// Returns either a small hard scene or a larger ordinary one.
fn scene(rng: &mut impl Rng) -> (Soup<f64>, Vec<Point3<f64>>) {
    if rng.random_bool(0.5) {
        return Extreme::ALL[rng.random_range(0..Extreme::ALL.len())].generate(rng, 32);
    }
    let (kinds, layout) = (KINDS[rng.random_range(0..4)], LAYOUTS[rng.random_range(0..6)]);
    let len = [0, 1, 100, amount(3000, 200)][rng.random_range(0..4)];
    let soup = scenes::soup(rng, kinds, layout, len);
    let queries = (0..32).map(|_| scenes::query(rng, soup.positions())).collect();
    (soup, queries)
}

/// Returns the same elements with each vertex moved by up to a tenth of itself.
fn moved(rng: &mut impl Rng, soup: &Soup<f64>) -> Soup<f64> {
    let positions = soup.positions().iter().map(|p| p.map(|x| x * rng.random_range(0.9..1.0)));
    Soup::new(positions.collect(), soup.elements()).expect("smaller numbers are finite")
}

/// Runs one scene and returns the number of answers.
fn cycle(seed: u64) -> u64 {
    let mut rng = p2m_testkit::rng("soak", seed);
    let (soup, queries) = scene(&mut rng);
    let expected = brute(&soup, &queries);
    let elsewhere = moved(&mut rng, &soup);
    let expected_there = brute(&elsewhere, &queries);
    let mut count = 0;
    let mut same = |found: Answers, expected: &Answers, what: &str| {
        assert_eq!(found, *expected, "seed {seed}: {what}");
        count += found.len() as u64;
    };
    macro_rules! index {
        ($name:literal, $index:ty) => {{
            let index = <$index>::build(&soup, &Default::default()).expect("valid");
            same(answers(&index, &queries), &expected, concat!($name, " built"));
            let (mut writer, mut bytes) = (Writer::default(), Vec::new());
            index.save(&mut writer);
            writer.write(&mut bytes).expect("memory");
            drop(index);
            let file = SavedFile::read(&bytes[..]).expect("written whole");
            let index = <$index>::load(&soup, file.checked().expect("undamaged")).expect("the same set");
            same(answers(&index, &queries), &expected, concat!($name, " loaded"));
            index
        }};
    }
    macro_rules! tree {
        ($name:literal, $index:ty) => {{
            let mut index = index!($name, $index);
            index.refit(&elsewhere, &Default::default()).expect("as many primitives");
            same(answers(&index, &queries), &expected_there, concat!($name, " moved"));
        }};
    }
    tree!("aabb", AabbTree<f64, &Soup<f64>>);
    tree!("kdop", KdopTree<f64, &Soup<f64>, 14>);
    index!("octree", OctreeIndex<f64, &Soup<f64>>);
    index!("p2m", P2mIndex<f64, &Soup<f64>>);
    count
}

#[test]
fn nothing_is_lost_and_memory_is_flat() {
    let seconds: f64 = std::env::var("P2M_SOAK").map_or_else(|_| amount(3.0, 0.5), |s| s.parse().expect("seconds"));
    // One cycle runs first, so that allocations that happen only once are not measured.
    let first = amount(50, 12);
    for seed in 0..first {
        cycle(seed);
    }
    let before = MEMORY.current_usage();
    let (scenes, answers) = (AtomicU64::new(first), AtomicU64::new(0));
    // The largest memory in each part of the time. Each thread measures memory between two scenes.
    let peaks: [AtomicUsize; MEASUREMENTS] = Default::default();
    let start = Instant::now();
    let failed = Mutex::new(false);
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, Into::into) {
            scope.spawn(|| {
                while start.elapsed() < Duration::from_secs_f64(seconds) && !*failed.lock().expect("plain") {
                    let seed = scenes.fetch_add(1, Ordering::Relaxed);
                    let Ok(count) = std::panic::catch_unwind(|| cycle(seed)) else {
                        *failed.lock().expect("plain") = true;
                        return;
                    };
                    answers.fetch_add(count, Ordering::Relaxed);
                    #[allow(clippy::cast_sign_loss, reason = "time is not negative")]
                    let part = (start.elapsed().as_secs_f64() / seconds * MEASUREMENTS as f64) as usize;
                    peaks[part.min(MEASUREMENTS - 1)].fetch_max(MEMORY.current_usage(), Ordering::Relaxed);
                }
            });
        }
    });
    assert!(!failed.into_inner().expect("plain"), "see above");
    let after = MEMORY.current_usage();
    let peaks = peaks.map(AtomicUsize::into_inner);
    println!(
        "{} scenes, {} answers in {:.0?}; {before} bytes before, {after} after, at most {peaks:?} between two scenes",
        scenes.into_inner() - first,
        answers.into_inner(),
        start.elapsed()
    );
    // Threads keep some small buffers.
    assert!(after <= before + (1 << 16), "{before} bytes before, {after} after");
}
