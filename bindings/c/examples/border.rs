//! Measures the overhead of the C interface: queries through p2m.h and through the same index in Rust take turns on one
//! thread. Usage: `border SCENE COUNT`. The program links to the shared library.

use nalgebra::{Point3, Vector3};
use p2m_backends::{BackendEntry, BuildSettings};
use p2m_core::batch::{BatchOptions, ClosestColumns, closest_columns_into};
use p2m_core::{ClosestPoint, PrimitiveSet, QueryOptions};
use std::error::Error;
use std::ffi::{CString, c_char, c_int, c_void};
use std::hint::black_box;
use std::ptr::{null, null_mut};
use std::sync::Arc;
use std::time::Duration;

#[repr(C)]
struct Closest([f64; 8], u32, u8);

#[repr(C)]
#[derive(Clone, Copy)]
struct Array(*const c_void, usize, usize, c_int);

#[repr(C)]
#[derive(Clone, Copy)]
struct Column(*mut c_void, usize);

#[repr(C)]
struct Options(f64, u32, u8, *const c_void);

#[link(name = "p2m")]
unsafe extern "C" {
    fn p2m_scene_read(path: *const c_char, scene: *mut *mut c_void) -> c_int;
    fn p2m_index_build(scene: *const c_void, options: *const c_void, index: *mut *mut c_void) -> c_int;
    fn p2m_closest_point(index: *const c_void, query: *const f64, max_distance: f64, answer: *mut Closest) -> c_int;
    fn p2m_closest_points(
        index: *const c_void,
        queries: *const Array,
        options: *const Options,
        columns: *const [Column; 7],
    ) -> c_int;
}

/// The number of rounds, whose medians are compared.
const ROUNDS: usize = 21;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let [_, file, count] = &arguments[..] else { return Err("border SCENE COUNT".into()) };
    let soup = p2m_mixed::read_scene(file.as_ref())?.soup;
    let entry = BackendEntry::find("aabb").ok_or("no such backend")?;
    let index = entry.build(Arc::clone(&soup), &BuildSettings::default())?.index;
    let (mut c_scene, mut c_index, path) = (null_mut(), null_mut(), CString::new(file.as_str())?);
    // SAFETY: all pointers are valid, and null stands for the default options.
    let status =
        unsafe { p2m_scene_read(path.as_ptr(), &raw mut c_scene) + p2m_index_build(c_scene, null(), &raw mut c_index) };
    assert_eq!(status, 0, "the scene is read and indexed");

    // Points along a diagonal of the box and back, so that consecutive queries are near each other.
    let bounds = soup.aabb();
    let count: usize = count.parse()?;
    let size = bounds.max - bounds.min;
    let place = |i: usize, turns: f64| (i as f64 * turns / count as f64).fract();
    let point = |i| bounds.min + size.component_mul(&Vector3::new(place(i, 1.0), place(i, 7.0), place(i, 31.0)));
    let queries: Vec<Point3<f64>> = (0..count).map(point).collect();

    let single_in_rust = |within: f64| {
        let options = QueryOptions::default().with_max_distance(within);
        let answer = |q: &Point3<f64>| black_box(index.closest_point_with(q, &options)).map_or(0.0, |c| c.distance);
        queries.iter().map(answer).sum()
    };
    let single_in_c = |within: f64| {
        let mut answer = Closest([0.0; 8], 0, 0);
        let mut sum = 0.0;
        for query in &queries {
            // SAFETY: all pointers are valid.
            unsafe { p2m_closest_point(c_index, query.coords.as_ptr(), within, &raw mut answer) };
            let Closest(numbers, primitive, _) = black_box(&answer);
            sum += if *primitive == u32::MAX { 0.0 } else { numbers[0] };
        }
        sum
    };
    let batch_in_rust = || {
        let mut distances = vec![0.0; count];
        let columns = ClosestColumns::default().with_distance(&mut distances);
        let options = BatchOptions::default().with_parallel(false);
        closest_columns_into(&*index, &queries, &QueryOptions::default(), &options, columns);
        distances.iter().sum()
    };
    let batch_in_c = || {
        let mut distances = vec![0.0; count];
        let mut columns = [Column(null_mut(), 0); 7];
        columns[0].0 = distances.as_mut_ptr().cast();
        let rows = Array(queries.as_ptr().cast(), count, 0, 1);
        let options = Options(f64::INFINITY, 1, 0, null());
        // SAFETY: the queries are rows of f64, and the column has room for their distances.
        let status = unsafe { p2m_closest_points(c_index, &raw const rows, &raw const options, &raw const columns) };
        assert_eq!(status, 0, "a batch is answered");
        distances.iter().sum()
    };
    type Timed<'a> = &'a dyn Fn() -> f64;
    let (rust, c) = (single_in_rust, single_in_c);
    for (name, rust, c) in [
        ("single", (&|| rust(f64::INFINITY)) as Timed<'_>, (&|| c(f64::INFINITY)) as Timed<'_>),
        ("single, without an answer", &|| rust(0.0), &|| c(0.0)),
        ("batch", &batch_in_rust, &batch_in_c),
    ] {
        let time = |call: &dyn Fn() -> f64| -> (Duration, f64) {
            let start = cpu_time::ThreadTime::now();
            let sum = call();
            (start.elapsed(), sum)
        };
        let mut times = [Vec::new(), Vec::new()];
        for round in 0..ROUNDS {
            // The two take turns in beginning a round.
            let order = if round % 2 == 0 { [0, 1] } else { [1, 0] };
            let mut sums = [0.0; 2];
            for i in order {
                let (elapsed, sum) = time([rust, c][i]);
                times[i].push(elapsed.as_nanos() as f64 / count as f64);
                sums[i] = sum;
            }
            assert_eq!(sums[0].to_bits(), sums[1].to_bits(), "answers are the same");
        }
        let [rust, c] = times.map(|mut times| {
            times.sort_by(f64::total_cmp);
            times[ROUNDS / 2]
        });
        println!(
            "{name}: {rust:.1} ns in Rust, {c:.1} ns in C, {:.1} ns or {:.2} % more",
            c - rust,
            100.0 * (c / rust - 1.0)
        );
    }
    Ok(())
}
