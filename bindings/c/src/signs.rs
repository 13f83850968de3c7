//! Signed distances.

use crate::arrays::{Array, Column, Out, reference};
use crate::index::{Index, Signs};
use crate::queries::{Batch, BatchOptions, check_finite};
use crate::status::{Call, Failure, Status, invalid, run};
use crate::threads::{Cancel, in_pool, with_threads};
use nalgebra::Point3;
use p2m_core::batch::{self, Interruptible};
use p2m_core::{ClosestPoint, QueryOptions};
use p2m_field::sign::SignedDistance;
use std::sync::Arc;

impl Index {
    /// Returns the signs of the scene, which the first call prepares.
    fn signs(&self, threads: u32) -> Call<&Signs> {
        let prepare = || {
            let (index, soup) = (Arc::clone(&self.built.index), Arc::clone(&self.scene.soup));
            SignedDistance::new(index, soup).map_err(|error| error.to_string())
        };
        // The lock is taken outside of the pool. Threads of the pool may steal other work that waits for the lock.
        let signs = self.signs.get_or_init(|| in_pool(threads, prepare).unwrap_or_else(|failure| Err(failure.1)));
        signs.as_ref().map_err(|error| Failure(Status::Unsupported, error.clone()))
    }
}

/// Answers queries into a column.
///
/// # Safety
/// The pointers have to be valid, and the column has to point to as much memory as it claims.
unsafe fn answer<V: Copy + Send>(
    index: *const Index,
    queries: *const Array,
    options: *const BatchOptions,
    column: Column,
    unset: V,
    fill: impl Fn(&Signs, &(dyn ClosestPoint<f64> + Sync), &[Point3<f64>], f64, &batch::BatchOptions, &mut [V]) + Sync,
) -> Call {
    // SAFETY: the caller vouches for the pointers.
    let (index, queries, batch) =
        unsafe { (reference(index, "index")?, reference(queries, "queries")?, Batch::new(options)?) };
    let signs = index.signs(batch.threads)?;
    // SAFETY: the caller vouches for the memory.
    let points = unsafe { queries.points("queries") }?;
    check_finite("queries", &points)?;
    if points.is_empty() {
        return Ok(());
    }
    // SAFETY: the caller vouches for the column.
    let out = unsafe { column.out("answers", points.len(), unset) }?;
    let mut out: Out<'_, V> = out.ok_or_else(|| invalid("answers: the column is null"))?;
    let interruptible = Interruptible::new(&*index.built.index, batch.step());
    let values = out.values();
    with_threads(batch.threads, |is_parallel| {
        fill(signs, &interruptible, &points, batch.max_distance, &batch.options(is_parallel), values);
    })?;
    Cancel::check(batch.cancel)?;
    out.finish();
    Ok(())
}

/// Writes the signed distance of each query, of type `double`: negative inside of the surface that the triangles form,
/// and positive outside. It is NaN if nothing is within the largest distance, and if the sign is not determined. In a
/// scene without triangles and without a largest distance it is infinity. The first call for an index prepares the
/// signs. Fails with `P2M_STATUS_UNSUPPORTED` for a scene with segments or points.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn p2m_signed_distances(
    index: *const Index,
    queries: *const Array,
    options: *const BatchOptions,
    distances: Column,
) -> Status {
    // SAFETY: the caller vouches for the pointers.
    run(|| unsafe {
        answer(index, queries, options, distances, f64::NAN, |signs, index, points, max_distance, batch, out| {
            let options = QueryOptions::default().with_max_distance(max_distance);
            signs.distances_into(index, points, &options, batch, out);
            if max_distance < f64::INFINITY {
                out.iter_mut().filter(|distance| distance.is_infinite()).for_each(|distance| *distance = f64::NAN);
            }
        })
    })
}

/// Writes whether each query is inside of the surface that the triangles form, as 1 or 0 of type `uint8_t`. The largest
/// distance of the options is ignored.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn p2m_contains(
    index: *const Index,
    queries: *const Array,
    options: *const BatchOptions,
    is_inside: Column,
) -> Status {
    // SAFETY: the caller vouches for the pointers.
    run(|| unsafe {
        answer(index, queries, options, is_inside, 0u8, |signs, index, points, _, batch, out| {
            let inside = signs.contains_each_by(index, points, batch);
            out.iter_mut().zip(inside).for_each(|(out, is_inside)| *out = u8::from(is_inside));
        })
    })
}
