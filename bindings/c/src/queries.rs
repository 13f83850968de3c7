//! Queries by points.

use crate::arrays::{Array, Column, Out, check_pointer, length, point, reference, with_coordinates, write};
use crate::index::Index;
use crate::status::{Call, Failure, Status, invalid, run};
use crate::threads::{Cancel, checked, with_threads};
use p2m_core::batch::{self, ClosestColumns, Interruptible, closest_columns_into};
use p2m_core::{Feature, Position, PrimitiveId, QueryOptions};
use std::ffi::{c_int, c_void};
use std::ops::ControlFlow;

/// The closest point of a scene.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Closest {
    /// The distance, in units of the scene; infinity if there is no answer.
    pub distance: f64,
    /// The closest point.
    pub point: [f64; 3],
    /// The weights of the vertices of the primitive. The point is the weighted sum of the vertices.
    pub weights: [f64; 3],
    /// A lower bound on the true distance. If there is no answer, it is infinity, or about the largest distance in a
    /// batch.
    pub lower_bound: f64,
    /// The id of the primitive, the lowest of equally near ones; `P2M_NO_PRIMITIVE` if there is no answer.
    pub primitive: u32,
    /// The feature that the point lies on: 0 to 2 for a vertex, 3 to 5 for the edge from vertex 0, 1 or 2 to the next
    /// one, 6 for the face, and 255 if there is no answer.
    pub feature: u8,
}

/// The id that stands for no primitive. The header defines it by a macro.
pub(crate) const P2M_NO_PRIMITIVE: u32 = u32::MAX;

impl Closest {
    const NONE: Self = Self {
        distance: f64::INFINITY,
        point: [f64::NAN; 3],
        weights: [f64::NAN; 3],
        lower_bound: f64::INFINITY,
        primitive: P2M_NO_PRIMITIVE,
        feature: u8::MAX,
    };
}

impl From<&p2m_core::Closest<f64>> for Closest {
    fn from(closest: &p2m_core::Closest<f64>) -> Self {
        Self {
            distance: closest.distance,
            point: closest.point.into(),
            weights: closest.barycentric,
            lower_bound: closest.lower_bound,
            primitive: closest.primitive.number(),
            feature: closest.feature.code(),
        }
    }
}

/// The options of a batch. `p2m_batch_options_default` returns the defaults.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct BatchOptions {
    /// The largest distance of an answer, in units of the scene. It may be infinite.
    pub max_distance: f64,
    /// The number of threads; 0 stands for all processors, and 1 for the calling thread.
    pub threads: u32,
    /// 1 to answer queries in their order, because neighbours in it are near each other already, and 0 to reorder them.
    pub keeps_order: u8,
    /// A switch that cancels the call, or null.
    pub cancel: *const Cancel,
}

/// Returns the default options of a batch: no largest distance, all processors, any order, no switch.
#[unsafe(no_mangle)]
pub extern "C" fn p2m_batch_options_default() -> BatchOptions {
    BatchOptions { max_distance: f64::INFINITY, threads: 0, keeps_order: 0, cancel: std::ptr::null() }
}

/// The columns of the answers of a batch. Each has a row for each query; a column whose `data` is null is not computed.
/// All fields are as in `p2m_closest`.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Columns {
    /// `double`.
    pub distance: Column,
    /// `uint32_t`.
    pub primitive: Column,
    /// `double[3]`.
    pub point: Column,
    /// `uint8_t`.
    pub feature: Column,
    /// `double[3]`.
    pub weights: Column,
    /// `double`.
    pub lower_bound: Column,
    /// `double[3]`: the normal of the surface at the closest point, of length 1. On edges and at vertices it is the
    /// mean of the normals of the adjacent faces, weighted by their angles. It is NaN if there is none.
    pub normal: Column,
}

pub(crate) struct Batch<'a> {
    pub(crate) max_distance: f64,
    pub(crate) threads: u32,
    keeps_order: bool,
    pub(crate) cancel: Option<&'a Cancel>,
}

impl<'a> Batch<'a> {
    /// Returns the options that a pointer refers to, or the defaults for null.
    ///
    /// # Safety
    /// A pointer that is not null has to point to valid options.
    pub(crate) unsafe fn new(options: *const BatchOptions) -> Call<Self> {
        // SAFETY: the caller vouches for the pointers.
        let (options, cancel) = unsafe {
            let options = if options.is_null() { p2m_batch_options_default() } else { *reference(options, "options")? };
            let has_cancel = !options.cancel.is_null();
            (options, has_cancel.then(|| reference(options.cancel, "cancel")).transpose()?)
        };
        Ok(Self {
            max_distance: length(options.max_distance, "max_distance")?,
            threads: checked(options.threads)?,
            keeps_order: options.keeps_order != 0,
            cancel,
        })
    }

    pub(crate) fn options(&self, is_parallel: bool) -> batch::BatchOptions {
        batch::BatchOptions::default().with_parallel(is_parallel).with_reorder(!self.keeps_order)
    }

    /// Returns the function that answers a step of a batch, and stops the batch if the switch is set.
    pub(crate) fn step(&self) -> impl Fn(usize, &mut dyn FnMut(usize)) -> bool + Sync + use<'a> {
        let cancel = self.cancel;
        move |left, answer| {
            let goes_on = Cancel::check(cancel).is_ok();
            if goes_on {
                answer(left.min(QUERIES_PER_STEP));
            }
            goes_on
        }
    }
}

/// The number of queries between two checks of the switch.
const QUERIES_PER_STEP: usize = 256;

/// Fails if a row has a coordinate that is not finite.
pub(crate) fn check_finite<P: Position<f64>>(name: &str, rows: &[P]) -> Call {
    let bad = rows.iter().position(|row| !row.point().iter().all(|x| x.is_finite()));
    bad.map_or(Ok(()), |row| Err(invalid(format!("{name}: row {row} is not finite"))))
}

/// Finds the closest point of the scene to `query`, which has three finite coordinates, within a distance, which may be
/// infinite. If there is none, `answer` has `P2M_NO_PRIMITIVE`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn p2m_closest_point(
    index: *const Index,
    query: *const f64,
    max_distance: f64,
    answer: *mut Closest,
) -> Status {
    // SAFETY: the caller vouches for the pointers.
    run(|| unsafe {
        let (index, query) = (reference(index, "index")?, point(query, "query")?);
        let options = QueryOptions::default().with_max_distance(length(max_distance, "max_distance")?);
        match index.built.index.closest_point_with(&query, &options) {
            Some(found) => write(answer, "answer", Closest::from(&found)),
            None => write(answer, "answer", Closest::NONE),
        }
    })
}

/// Finds the closest points of many queries, and writes the columns. Queries are rows of three finite coordinates,
/// `float` or `double`. `options` may be null. The answers are the same bits as those of single queries, for any number
/// of threads; only lower bounds may differ in their last digits.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn p2m_closest_points(
    index: *const Index,
    queries: *const Array,
    options: *const BatchOptions,
    columns: *const Columns,
) -> Status {
    // SAFETY: the caller vouches for the pointers.
    run(|| unsafe {
        let (index, queries) = (reference(index, "index")?, reference(queries, "queries")?);
        let (batch, columns) = (Batch::new(options)?, *reference(columns, "columns")?);
        with_coordinates!(queries, "queries", rows => closest_points(index, rows, &batch, columns))
    })
}

/// # Safety
/// The columns have to point to as much memory as they say.
unsafe fn closest_points<P: Position<f64> + Sync>(
    index: &Index,
    queries: &[P],
    batch: &Batch<'_>,
    columns: Columns,
) -> Call {
    check_finite("queries", queries)?;
    let count = queries.len();
    if count == 0 {
        return Ok(());
    }
    // SAFETY: the caller vouches for the columns.
    let (mut distance, mut primitive, mut point, mut feature, mut weights, mut lower_bound, mut normal) = unsafe {
        (
            columns.distance.out("distance", count, f64::INFINITY)?,
            columns.primitive.out("primitive", count, P2M_NO_PRIMITIVE)?,
            columns.point.out("point", count, [f64::NAN; 3])?,
            columns.feature.out("feature", count, u8::MAX)?,
            columns.weights.out("weights", count, [f64::NAN; 3])?,
            columns.lower_bound.out("lower_bound", count, f64::INFINITY)?,
            columns.normal.out("normal", count, [f64::NAN; 3])?,
        )
    };
    let has_features = feature.is_some() || normal.is_some();
    let mut features = has_features.then(|| vec![Feature::Face; count]);
    let mut own_ids = (has_features && primitive.is_none()).then(|| vec![P2M_NO_PRIMITIVE; count]);
    let mut wanted = ClosestColumns::default();
    wanted.distance = distance.as_mut().map(Out::values);
    wanted.primitive = primitive.as_mut().map(Out::values).or(own_ids.as_deref_mut());
    wanted.point = point.as_mut().map(|out| bytemuck::cast_slice_mut(out.values()));
    wanted.feature = features.as_deref_mut();
    wanted.barycentric = weights.as_mut().map(Out::values);
    wanted.lower_bound = lower_bound.as_mut().map(Out::values);
    let query_options = QueryOptions::default().with_max_distance(batch.max_distance);
    let interruptible = Interruptible::new(&*index.built.index, batch.step());
    with_threads(batch.threads, |is_parallel| {
        closest_columns_into(&interruptible, queries, &query_options, &batch.options(is_parallel), wanted);
    })?;
    Cancel::check(batch.cancel)?;
    let ids = primitive.as_mut().map(Out::values).or(own_ids.as_deref_mut()).unwrap_or_default();
    let found = ids.iter().map(|id| (*id != P2M_NO_PRIMITIVE).then(|| PrimitiveId::new(*id as usize)));
    let found = found.zip(features.as_deref().unwrap_or_default());
    if let Some(out) = &mut feature {
        for (code, (id, feature)) in out.values().iter_mut().zip(found.clone()) {
            *code = id.map_or(u8::MAX, |_| feature.code());
        }
    }
    if let Some(out) = &mut normal {
        let normals = index.normals(batch.threads);
        for (normal, (id, feature)) in out.values().iter_mut().zip(found) {
            *normal = id.and_then(|id| normals.at(id, *feature)).map_or([f64::NAN; 3], Into::into);
        }
    }
    [distance, lower_bound].into_iter().flatten().for_each(Out::finish);
    [point, weights, normal].into_iter().flatten().for_each(Out::finish);
    primitive.into_iter().for_each(Out::finish);
    feature.into_iter().for_each(Out::finish);
    Ok(())
}

/// Finds the `k` primitives nearest to a point within a distance, the nearest first. Writes them to `answers`, which
/// has room for `k`, and their number to `count`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn p2m_k_nearest(
    index: *const Index,
    query: *const f64,
    k: usize,
    max_distance: f64,
    answers: *mut Closest,
    count: *mut usize,
) -> Status {
    // SAFETY: the caller vouches for the pointers.
    run(|| unsafe {
        let (index, query) = (reference(index, "index")?, point(query, "query")?);
        write(count, "count", 0)?;
        if k > 0 {
            check_pointer(answers, "answers")?;
        }
        let found = index.built.index.try_k_nearest(&query, k, length(max_distance, "max_distance")?);
        let found = found.map_err(|error| Failure(Status::OutOfMemory, error.to_string()))?;
        for (i, closest) in found.iter().enumerate() {
            write(answers.wrapping_add(i), "answers", Closest::from(closest))?;
        }
        write(count, "count", found.len())
    })
}

/// A function that receives an answer, and the `user` pointer of the call. Any result but 0 ends the search.
pub type VisitClosest = Option<unsafe extern "C" fn(answer: *const Closest, user: *mut c_void) -> c_int>;

/// Calls a function for each primitive within a radius of a point, in any order, until it returns anything but 0. The
/// function must not throw or jump out.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn p2m_visit_within(
    index: *const Index,
    query: *const f64,
    radius: f64,
    visit: VisitClosest,
    user: *mut c_void,
) -> Status {
    // SAFETY: the caller vouches for the pointers and the function.
    run(|| unsafe {
        let (index, query) = (reference(index, "index")?, point(query, "query")?);
        let visit = visit.ok_or_else(|| invalid("visit: the function is null"))?;
        let _ = index.built.index.visit_within(&query, length(radius, "radius")?, &mut |closest| {
            let answer = Closest::from(closest);
            if visit(&raw const answer, user) == 0 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        });
        Ok(())
    })
}

/// Writes whether any primitive is within a radius of a point.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn p2m_is_any_within(
    index: *const Index,
    query: *const f64,
    radius: f64,
    is_within: *mut bool,
) -> Status {
    // SAFETY: the caller vouches for the pointers.
    run(|| unsafe {
        let (index, query) = (reference(index, "index")?, point(query, "query")?);
        write(is_within, "is_within", index.built.index.is_any_within(&query, length(radius, "radius")?))
    })
}
