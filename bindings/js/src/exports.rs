//! Functions of the WebAssembly module that the C interface lacks: memory for the caller, indexes as bytes, answers of
//! any number as arrays, and scenes whose primitives are in any order.

use crate::arrays::{Array, give, length, point, reference, write};
use crate::index::Index;
use crate::pairs::Pair;
use crate::queries::Closest;
use crate::rays::{Hit, Ray};
use crate::scene::Scene;
use crate::status::{Failure, Status, invalid, run};
use p2m_core::storage::SavedFile;
use p2m_core::{Element, QueryOptions, Soup};
use std::alloc::{Layout, alloc_zeroed, dealloc};
use std::mem::offset_of;
use std::ops::ControlFlow;

// `answers.ts` reads structures with this layout.
const _: () = {
    assert!(size_of::<Closest>() == 72 && offset_of!(Closest, primitive) == 64 && offset_of!(Closest, feature) == 68);
    assert!(size_of::<Hit>() == 64 && offset_of!(Hit, primitive) == 56 && offset_of!(Hit, side) == 60);
    assert!(size_of::<Pair>() == 128 && offset_of!(Pair, primitives) == 112 && offset_of!(Pair, features) == 120);
};

/// The alignment of all memory that is passed between the module and its caller.
const ALIGNMENT: usize = 8;

/// Memory that the caller owns, and frees with `p2m_js_free`.
#[repr(C)]
pub struct Memory {
    data: *mut u8,
    bytes: usize,
}

impl Memory {
    fn of<T>(values: Vec<T>) -> Self {
        const { assert!(align_of::<T>() == ALIGNMENT) };
        let values = Box::leak(values.into_boxed_slice());
        Self { data: values.as_mut_ptr().cast(), bytes: size_of_val(values) }
    }
}

/// Returns zeroed memory of this number of bytes, or null if there is not enough.
#[unsafe(no_mangle)]
pub extern "C" fn p2m_js_alloc(bytes: usize) -> *mut u8 {
    match Layout::from_size_align(bytes, ALIGNMENT) {
        // SAFETY: the size is not 0.
        Ok(layout) if bytes > 0 => unsafe { alloc_zeroed(layout) },
        _ => std::ptr::null_mut(),
    }
}

/// Frees memory of this number of bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn p2m_js_free(data: *mut u8, bytes: usize) {
    if let (Ok(layout), true) = (Layout::from_size_align(bytes, ALIGNMENT), bytes > 0 && !data.is_null()) {
        // SAFETY: the caller vouches that the memory was given with this size.
        unsafe { dealloc(data, layout) };
    }
}

/// Makes a scene of primitives in any order. `sizes` has the number of vertices of each primitive, of type u8, and
/// `vertices` the indices of all their vertices, one primitive after the other.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn p2m_js_scene_of_mixed(
    positions: *const Array,
    sizes: *const u8,
    count: usize,
    vertices: *const Array,
    scene: *mut *mut Scene,
) -> Status {
    // SAFETY: the caller vouches for the pointers.
    run(|| unsafe {
        give(scene, "scene", || {
            let positions = reference(positions, "positions")?.points("positions")?.into_owned();
            let vertices = reference(vertices, "vertices")?.indices::<1>("vertices")?;
            let mut rest: &[[u32; 1]] = &vertices;
            let mut elements = Vec::with_capacity(count);
            for i in 0..count {
                let size = usize::from(sizes.add(i).read());
                let (own, others) = rest.split_at_checked(size).unwrap_or_default();
                rest = others;
                elements.push(match *own {
                    [[a]] => Element::Point(a),
                    [[a], [b]] => Element::Segment([a, b]),
                    [[a], [b], [c]] => Element::Triangle([a, b, c]),
                    _ => return Err(invalid("sizes: a primitive has 1 to 3 vertices, and vertices has all of them")),
                });
            }
            if !rest.is_empty() {
                return Err(invalid("sizes: their sum is less than the number of vertices"));
            }
            Scene::of(Soup::new(positions, elements))
        })
    })
}

/// Saves an index with its scene.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn p2m_js_save(index: *const Index, saved: *mut Memory) -> Status {
    // SAFETY: the caller vouches for the pointers.
    run(|| unsafe {
        let writer = reference(index, "index")?.saved()?;
        let failed = |error: std::io::Error| Failure(Status::OutOfMemory, error.to_string());
        let mut count = Count(0);
        writer.write(&mut count).map_err(failed)?;
        let data = p2m_js_alloc(count.0);
        if data.is_null() {
            return Err(Failure(Status::OutOfMemory, format!("there is no memory for {} bytes", count.0)));
        }
        writer.write(std::slice::from_raw_parts_mut(data, count.0)).map_err(failed)?;
        write(saved, "saved", Memory { data, bytes: count.0 })
    })
}

/// A writer that only counts the bytes.
struct Count(usize);

impl std::io::Write for Count {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0 += bytes.len();
        Ok(bytes.len())
    }
    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

/// Loads an index with its scene.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn p2m_js_load(data: *const u8, bytes: usize, index: *mut *mut Index) -> Status {
    // SAFETY: the caller vouches for the pointers.
    run(|| unsafe {
        give(index, "index", || {
            let saved = std::slice::from_raw_parts(reference(data, "data")?, bytes);
            Index::load(SavedFile::read_with_length(saved, bytes as u64))
        })
    })
}

/// Finds all primitives within a radius, the nearest first. Equally near primitives come in the order of their ids.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn p2m_js_within(
    index: *const Index,
    query: *const f64,
    radius: f64,
    answers: *mut Memory,
) -> Status {
    // SAFETY: the caller vouches for the pointers.
    run(|| unsafe {
        let (index, query) = (reference(index, "index")?, point(query, "query")?);
        let mut found = Vec::new();
        let _ = index.built.index.visit_within(&query, length(radius, "radius")?, &mut |closest| {
            found.push(Closest::from(closest));
            ControlFlow::Continue(())
        });
        found.sort_unstable_by(|a, b| a.distance.total_cmp(&b.distance).then(a.primitive.cmp(&b.primitive)));
        write(answers, "answers", Memory::of(found))
    })
}

/// Finds all hits of a ray, the nearest first.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn p2m_js_hits(index: *const Index, ray: *const Ray, hits: *mut Memory) -> Status {
    // SAFETY: the caller vouches for the pointers.
    run(|| unsafe {
        let (index, ray) = (reference(index, "index")?.rays()?, reference(ray, "ray")?.checked()?);
        write(hits, "hits", Memory::of(index.all_intersections(&ray).iter().map(Hit::from).collect()))
    })
}

/// Writes the numbers of nodes, packets and primitives that a query for the closest point visits.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn p2m_js_work(index: *const Index, query: *const f64, work: *mut [f64; 3]) -> Status {
    // SAFETY: the caller vouches for the pointers.
    run(|| unsafe {
        let (index, query) = (reference(index, "index")?, point(query, "query")?);
        let counts = index.built.index.count_query(&query.into(), &QueryOptions::default());
        write(work, "work", counts.map(|count| count as f64))
    })
}
