//! Memory that is refused is a typed error, and what a build says that it may need is enough: an allocator counts, and refuses
//! what exceeds a limit, which would abort a program that had not asked before.
#![cfg(all(feature = "bvh", feature = "interception", feature = "kdop", feature = "mixed"))]
#![allow(unsafe_code, reason = "an allocator")]

use p2m::saved::{LoadError, SavedFile};
use p2m::scene::{PointFormat, Scene, load_scene, read_off, read_ply, read_points_from, read_stl, write_p2m};
use p2m::{
    AabbTree, BruteForce, BuildError, BuildIndex, ClosestPoint, KdopTree, OctreeIndex, P2mIndex, P2mOptions,
    PrimitiveSet, Soup,
};
use p2m_testkit::adversaries::{ADVERSARIES, queries};
use p2m_testkit::scenes::{self, Kinds, Layout, of_case};
use p2m_testkit::{amount, cases, models, rng};
use std::alloc::{GlobalAlloc, System};
use std::cell::Cell;
use std::sync::atomic::{AtomicUsize, Ordering::SeqCst};
use std::sync::{Mutex, MutexGuard};

/// Bytes in use, from some large number on since what one thread takes another may give back; the most there were at a time but
/// for what is asked for at once, and how many there may be.
static USED: AtomicUsize = AtomicUsize::new(1 << 40);
static MOST: AtomicUsize = AtomicUsize::new(0);
/// From so many bytes on an allocation only asks whether there are as many.
static PROBE: AtomicUsize = AtomicUsize::new(usize::MAX);
static LIMIT: AtomicUsize = AtomicUsize::new(usize::MAX);

thread_local! {
    /// Whether a thread is one that builds: those of the test harness allocate when they like.
    static COUNTS: Cell<bool> = const { Cell::new(false) };
}

/// One test at a time.
static TURN: Mutex<()> = Mutex::new(());

struct Limited;

#[global_allocator]
static ALLOCATOR: Limited = Limited;

impl Limited {
    /// Whether so many bytes more are within the limit, which are then in use.
    fn take(bytes: usize) -> bool {
        if !COUNTS.get() {
            return true;
        }
        let fits = |used: usize| used.checked_add(bytes).filter(|all| *all <= LIMIT.load(SeqCst));
        let used = USED.fetch_update(SeqCst, SeqCst, fits);
        // A probe is not what is used.
        let is_probe = bytes >= PROBE.load(SeqCst);
        used.is_ok_and(|used| is_probe || MOST.fetch_max(used + bytes, SeqCst) < usize::MAX)
    }
}

// SAFETY: everything is that of the system, or a null pointer, as for memory that there is not.
unsafe impl GlobalAlloc for Limited {
    unsafe fn alloc(&self, layout: std::alloc::Layout) -> *mut u8 {
        if !Self::take(layout.size()) {
            return std::ptr::null_mut();
        }
        // SAFETY: the layout is that of the caller.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: std::alloc::Layout) {
        if COUNTS.get() {
            USED.fetch_sub(layout.size(), SeqCst);
        }
        // SAFETY: it comes from the system, with this layout.
        unsafe { System.dealloc(pointer, layout) }
    }
}

/// Waits until it is this thread's turn; from now on this thread and those of the pool count.
fn turn() -> MutexGuard<'static, ()> {
    let turn = TURN.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    COUNTS.set(true);
    // Fails the second time, when there is a pool.
    let _ = rayon::ThreadPoolBuilder::new().start_handler(|_| COUNTS.set(true)).build_global();
    // Its threads have memory of their own.
    rayon::broadcast(|_| ());
    turn
}

/// Runs something while at most so many bytes more may be allocated.
fn with_limit<R>(bytes: usize, run: impl FnOnce() -> R) -> R {
    LIMIT.store(USED.load(SeqCst).saturating_add(bytes), SeqCst);
    let result = run();
    LIMIT.store(usize::MAX, SeqCst);
    result
}

/// The bytes that a build takes at a time, and those that it asked for: from a limit of almost nothing it is told what it may
/// need, and given that.
fn build_by_asking<'a, I: BuildIndex<f64, &'a Soup<f64>, Error = BuildError>>(
    name: &str,
    soup: &'a Soup<f64>,
    options: &I::Options,
) -> [usize; 2] {
    let mut limit = 4096;
    for _ in 0..3 {
        let before = USED.load(SeqCst);
        MOST.store(before, SeqCst);
        PROBE.store(limit / 2, SeqCst);
        match with_limit(limit, || I::build(soup, options)) {
            Ok(index) => {
                let taken = MOST.load(SeqCst) - before;
                let brute = BruteForce::new(soup).expect("valid");
                for q in queries(soup, 5) {
                    let key = |c: p2m::Closest<f64>| (c.distance.to_bits(), c.primitive);
                    assert_eq!(index.closest_point(&q).map(key), brute.closest_point(&q).map(key), "{name}");
                }
                return [taken, limit];
            }
            Err(BuildError::OutOfMemory { bytes }) => {
                assert!(bytes > limit, "{name}: {bytes} bytes may be needed, but {limit} were not enough");
                limit = bytes;
            }
            Err(error) => panic!("{name}: {error}"),
        }
    }
    panic!("{name}: not even {limit} bytes were enough");
}

/// Budgets that nothing exceeds.
fn long_lists() -> P2mOptions {
    P2mOptions::default().with_longest(2048).with_memory(1e5).with_work(1e6).with_added(0.0)
}

fn all_backends(name: &str, soup: &Soup<f64>) {
    let count = soup.len().max(1);
    let each = [
        build_by_asking::<AabbTree<f64, _>>(&format!("aabb, {name}"), soup, &Default::default()),
        build_by_asking::<KdopTree<f64, _, 14>>(&format!("kdop-14, {name}"), soup, &Default::default()),
        build_by_asking::<KdopTree<f64, _, 26>>(&format!("kdop-26, {name}"), soup, &Default::default()),
        build_by_asking::<OctreeIndex<f64, _>>(&format!("octree, {name}"), soup, &Default::default()),
        build_by_asking::<P2mIndex<f64, _>>(&format!("p2m, {name}"), soup, &Default::default()),
    ];
    println!("{name}: {:?} bytes a primitive were taken and asked for", each.map(|two| two.map(|bytes| bytes / count)));
}

#[test]
fn a_build_that_gets_what_it_says_it_may_need_needs_no_more() {
    let _turn = turn();
    for case in cases(72, 24) {
        let (kinds, layout) = of_case(case);
        let count = [1, 30, amount(1_000, 100)][((case + case / 24) % 3) as usize];
        let soup = scenes::soup(&mut rng("out of memory", case), kinds, layout, count);
        all_backends(&format!("case {case}: {kinds:?} {layout:?} {count}"), &soup);
    }
    for adversary in ADVERSARIES {
        let many = amount(1_000, 150);
        for count in [17, many] {
            all_backends(&format!("{} {count}", adversary.name), &adversary.soup(count));
        }
        let [taken, asked] = build_by_asking::<P2mIndex<f64, _>>(adversary.name, &adversary.soup(many), &long_lists());
        println!("{}: {taken} bytes were taken for long lists, {asked} asked for", adversary.name);
    }
}

#[test]
#[ignore = "deep: scenes are large enough for several threads"]
fn a_large_build_that_gets_what_it_says_it_may_need_needs_no_more() {
    let _turn = turn();
    let random = &mut rng("out of memory, large", 0);
    all_backends("mixed", &scenes::soup(random, Kinds::Mixed, Layout::Uniform, 10_000));
    all_backends("skewed gear", &scenes::skewed_gear(1_000));
    let Some(folder) = models() else { return };
    for file in ["camel.off", "rings_lines.obj", "track_lines.obj"] {
        all_backends(file, &p2m::scene::read_scene(&folder.join(file)).expect("a scene").soup);
    }
}

/// Files that announce more than there can be, and are some bytes long.
#[test]
fn sizes_that_are_merely_announced_are_errors_and_take_no_memory() {
    let _turn = turn();
    const ENOUGH: usize = 1 << 20;
    let ply = "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty double x\nproperty double y\n\
               property double z\nelement face 4000000000\nproperty list uint uint vertex_indices\nend_header\n";
    let mut stl = vec![b' '; 80];
    stl.extend(u32::MAX.to_le_bytes());
    let npy = b"\x93NUMPY\x01\x00\x76\x00{'descr': '<f8', 'fortran_order': False, 'shape': (1000000000000, 3), }";
    let mut npy = npy.to_vec();
    npy.resize(127, b' ');
    npy.push(b'\n');
    with_limit(ENOUGH, || {
        assert!(read_ply(ply.as_bytes(), "a.ply").is_err());
        assert!(read_stl(&stl[..], "a.stl").is_err());
        assert!(read_off(&b"OFF 4000000000 4000000000 0\n0 0 0\n"[..], "a.off").is_err());
        assert!(read_points_from(&npy[..], PointFormat::Npy, "a.npy").is_err());
    });
    let mut file = Vec::new();
    write_p2m(&Scene::from(scenes::skewed_gear(10)), &mut file).expect("memory");
    // The number of sections and the length in the head; of each section the offset, the number and the size of elements.
    let sections = u32::from_le_bytes([file[12], file[13], file[14], file[15]]) as usize;
    let places = (0..sections).flat_map(|section| [32, 40, 48].map(|field| (64 + 64 * section + field, 8)));
    for (place, size) in [(12, 4), (16, 8)].into_iter().chain(places) {
        for number in [u64::MAX, 1 << 60, u64::from(u32::MAX)] {
            let mut other = file.clone();
            other[place..place + size].copy_from_slice(&number.to_le_bytes()[..size]);
            // As if it had been written so.
            let sum = twox_hash::XxHash3_64::oneshot(&other[64..64 + 64 * sections]);
            other[24..32].copy_from_slice(&sum.to_le_bytes());
            let load = || -> Result<Scene, LoadError> { load_scene(SavedFile::read(&other[..])?.checked()?) };
            let loaded = with_limit(ENOUGH, load);
            assert!(loaded.is_err(), "{number} at {place}");
        }
    }
}
