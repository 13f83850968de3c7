//! Batches of rays.

use crate::arrays::{borrowed, slice, triples};
use crate::columns::{NO_PRIMITIVE, answer_list, columns};
use crate::errors::{not_finite, value_error};
use crate::index::Index;
use crate::memory::{collected, joined};
use crate::parts::Split;
use crate::queries::write_counts;
use crate::source::Source;
use crate::work::{Run, catch};
use nalgebra::{Point3, Vector3};
use numpy::PyReadonlyArray1;
use p2m_core::{Hit, Ray, RayError, RayQuery, Side};
use p2m_shards::{ShardBatch, ShardError, ShardHit};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The number of rays that shards answer at a time.
const RAYS_PER_PART: usize = 1 << 18;

/// The id of a primitive, and its hit.
type RayHit = (i64, Hit);

columns! { HitArrays, HitColumns, RayHit, {
    t: f64 = f64::INFINITY, |(_, hit)| hit.parameter;
    primitive: i64 = NO_PRIMITIVE, |(id, _)| *id;
    point: [f64; 3] = [f64::NAN; 3], |(_, hit)| hit.point().coords.into();
    barycentric: [f64; 3] = [f64::NAN; 3], |(_, hit)| hit.barycentric();
    side: i8 = 0, |(_, hit)| match hit.side {
        Side::Front => 1,
        Side::Back => -1,
        Side::Along => 0,
    };
}}

answer_list!(HitList, RayHit, HitArrays, Some);

/// Returns a hit of an index over the whole scene, with the id of its primitive.
fn in_whole(hit: Hit) -> RayHit {
    (i64::from(hit.primitive.number()), hit)
}

/// Returns a hit of shards, with the id of its primitive.
fn in_shards(hit: ShardHit) -> RayHit {
    (i64::try_from(hit.id).unwrap_or(i64::MAX), hit.hit)
}

/// The rays of a batch, one for each row, and the index at which they are cast.
struct Cast<'a, 'py> {
    index: Source<'py>,
    origins: &'a [[f64; 3]],
    directions: &'a [[f64; 3]],
    range: [f64; 2],
    radius: f64,
    run: Run,
}

impl Cast<'_, '_> {
    /// Answers all rays in parts, either by a function of an index and a ray, or by a function of shards and all rays,
    /// whose answers are converted.
    fn answer<O: Split, A: Send, B, R: Send>(
        self,
        py: Python<'_>,
        out: O,
        whole: impl Fn(&dyn RayQuery<f64>, &Ray) -> A + Send + Sync,
        shards: impl Fn(ShardBatch<'_>, &[Ray]) -> Result<Vec<B>, ShardError> + Send + Sync,
        convert: impl Fn(B) -> A + Send + Sync,
        store: impl Fn(Vec<A>, O) -> R + Send + Sync,
    ) -> PyResult<Vec<R>> {
        let Self { index, origins, directions, range: [t_min, t_max], radius, run } = self;
        let ray = |row: usize| {
            Ray::new(&Point3::from(origins[row]), &Vector3::from(directions[row]))
                .and_then(|ray| ray.with_range(t_min, t_max)?.with_radius(radius))
                .map_err(|error| bad_ray(row, &error))
        };
        let check = || (0..origins.len()).try_for_each(|row| ray(row).map(drop));
        let size = (origins.len(), RAYS_PER_PART);
        index.answer(py, size, out, run, check, |part, range, out| {
            let rays = range.map(ray).collect::<PyResult<Vec<Ray>>>()?;
            let origin = |ray: &Ray| ray.at(0.0);
            let answers =
                part.ask(&rays, origin, Index::ray_query, |index, ray| whole(index, ray), &shards, &convert)?;
            Ok(store(answers, out))
        })
    }
}

/// Returns the exception for a row that is not a ray.
fn bad_ray(row: usize, error: &RayError) -> PyErr {
    match error {
        RayError::NonFinite => not_finite("origins and directions", row),
        RayError::ZeroDirection => value_error(format!("directions: row {row} is zero")),
        RayError::EmptyRange { .. } => value_error(format!("t_min, t_max: {error}")),
        RayError::Radius(_) => value_error(format!("radius: {error}")),
        _ => value_error(format!("row {row}: {error}")),
    }
}

/// Casts rays. The arrays of `out` depend on the mode: columns of hits for `first`, and the array `value` for the
/// others. The mode `all` returns the hits.
#[pyfunction]
pub(crate) fn rays(
    py: Python<'_>,
    index: Source<'_>,
    origins: PyReadonlyArray1<'_, f64>,
    directions: PyReadonlyArray1<'_, f64>,
    mode: &str,
    out: &Bound<'_, PyDict>,
    t_min: f64,
    t_max: f64,
    radius: f64,
    run: Run,
) -> PyResult<Option<HitList>> {
    if let Source::Whole(index) = &index {
        index.get().ray_query()?;
    }
    let (origins, directions) = (triples(origins.as_slice())?, triples(directions.as_slice())?);
    let cast = Cast { index, origins, directions, range: [t_min, t_max], radius, run };
    let (mut booleans, mut numbers);
    match mode {
        "first" => {
            let mut arrays = HitArrays::borrow(out)?;
            cast.answer(
                py,
                arrays.columns(origins.len())?,
                |index, ray| index.first_intersection(ray).map(in_whole),
                |shards, rays| shards.first_intersections(rays),
                |hit| hit.map(in_shards),
                |hits, mut columns: HitColumns<'_>| columns.set_all(hits.iter().map(Option::as_ref)),
            )?;
        }
        "any" => {
            booleans = borrowed::<bool>(out, "value")?;
            cast.answer(
                py,
                slice(&mut booleans)?.unwrap_or_default(),
                |index, ray| index.do_intersect(ray),
                |shards, rays| shards.do_intersect(rays),
                |is_hit| is_hit,
                |are_hit, values: &mut [bool]| values.copy_from_slice(&are_hit),
            )?;
        }
        "count" | "crossings" => {
            numbers = borrowed::<i64>(out, "value")?;
            let crosses = mode == "crossings";
            cast.answer(
                py,
                slice(&mut numbers)?.unwrap_or_default(),
                |index, ray| if crosses { index.crossings(ray) } else { index.count(ray) },
                |shards, rays| if crosses { shards.crossings(rays) } else { shards.count(rays) },
                |count| count,
                |counts, values: &mut [i64]| write_counts(values, counts.into_iter()),
            )?;
        }
        "all" => {
            numbers = borrowed::<i64>(out, "value")?;
            let hits = cast.answer(
                py,
                slice(&mut numbers)?.unwrap_or_default(),
                |index, ray| collected(index.all_intersections(ray).into_iter().map(in_whole)),
                |shards, rays| shards.all_intersections(rays),
                |hits| collected(hits.into_iter().map(in_shards)),
                |hits, values: &mut [i64]| {
                    write_counts(values, hits.iter().map(Vec::len));
                    joined(hits)
                },
            )?;
            return py.detach(|| catch(|| joined(hits))).map(|hits| Some(HitList(hits)));
        }
        _ => {
            return Err(value_error(format!("mode: '{mode}' is none of 'first', 'all', 'count', 'any', 'crossings'")));
        }
    }
    Ok(None)
}
