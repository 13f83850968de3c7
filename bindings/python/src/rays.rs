//! Batches of rays.

use crate::columns::{NO_PRIMITIVE, borrowed, halves, slice};
use crate::errors::value_error;
use crate::index::{Index, alternatives};
use crate::parts::{Split, answer_in_parts};
use crate::queries::{batch_options, not_finite};
use crate::scene::triples;
use crate::work::{Monitor, Threads};
use nalgebra::{Point3, Vector3};
use numpy::{PyReadonlyArray1, PyReadwriteArray1};
use p2m_core::batch;
use p2m_core::{Hit, Ray, RayError, RayQuery, Side};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Rays that have a row each.
pub(crate) struct Rays<'a> {
    pub(crate) origins: &'a [[f64; 3]],
    pub(crate) directions: &'a [[f64; 3]],
    pub(crate) range: [f64; 2],
    pub(crate) radius: f64,
}

/// The reason why a row is not a ray.
pub(crate) struct BadRay(usize, RayError);

impl From<BadRay> for PyErr {
    fn from(BadRay(row, error): BadRay) -> Self {
        match error {
            RayError::NonFinite => not_finite("origins and directions", row),
            RayError::ZeroDirection => value_error(format!("directions: row {row} is zero")),
            RayError::EmptyRange { .. } => value_error(format!("t_min, t_max: {error}")),
            RayError::Radius(_) => value_error(format!("radius: {error}")),
            _ => value_error(format!("row {row}: {error}")),
        }
    }
}

impl Rays<'_> {
    fn ray(&self, row: usize) -> Result<Ray, BadRay> {
        let [min, max] = self.range;
        Ray::new(&Point3::from(self.origins[row]), &Vector3::from(self.directions[row]))
            .and_then(|ray| ray.with_range(min, max)?.with_radius(self.radius))
            .map_err(|error| BadRay(row, error))
    }

    pub(crate) fn check(&self) -> Result<(), BadRay> {
        (0..self.origins.len()).try_for_each(|row| self.ray(row).map(drop))
    }

    /// Answers all rays in parts.
    pub(crate) fn answer<O: Split, A: Send, R: Send>(
        &self,
        out: O,
        threads: &Threads,
        monitor: &Monitor,
        answer: impl Fn(&Ray) -> A + Sync,
        store: impl Fn(Vec<A>, O) -> R + Sync,
    ) -> Vec<R> {
        answer_in_parts(self.origins.len(), out, threads, monitor, &|range, out: O| {
            // All rays were checked.
            let rays: Vec<Ray> = range.filter_map(|row| self.ray(row).ok()).collect();
            let options = batch_options(rays.len(), false);
            store(batch::map(&rays, &options, |ray| ray.at(0.0), &answer), out)
        })
    }
}

/// Places for hits.
#[derive(Default)]
pub(crate) struct HitColumns<'a> {
    t: Option<&'a mut [f64]>,
    primitive: Option<&'a mut [i64]>,
    point: Option<&'a mut [[f64; 3]]>,
    barycentric: Option<&'a mut [[f64; 3]]>,
    side: Option<&'a mut [i8]>,
}

impl HitColumns<'_> {
    fn set(&mut self, i: usize, hit: Option<&Hit>) {
        self.set_with_id(i, hit.map(|hit| (i64::from(hit.primitive.number()), hit)));
    }

    /// Writes a hit of the primitive with this id, or that there is none.
    pub(crate) fn set_with_id(&mut self, i: usize, answer: Option<(i64, &Hit)>) {
        let hit = answer.map(|(_, hit)| hit);
        if let Some(column) = &mut self.t {
            column[i] = hit.map_or(f64::INFINITY, |hit| hit.parameter);
        }
        if let Some(column) = &mut self.primitive {
            column[i] = answer.map_or(NO_PRIMITIVE, |(id, _)| id);
        }
        if let Some(column) = &mut self.point {
            column[i] = hit.map_or([f64::NAN; 3], |hit| hit.point().coords.into());
        }
        if let Some(column) = &mut self.barycentric {
            column[i] = hit.map_or([f64::NAN; 3], Hit::barycentric);
        }
        if let Some(column) = &mut self.side {
            column[i] = match hit.map(|hit| hit.side) {
                Some(Side::Front) => 1,
                Some(Side::Back) => -1,
                Some(Side::Along) | None => 0,
            };
        }
    }
}

impl Split for HitColumns<'_> {
    fn split(self, len: usize) -> (Self, Self) {
        let (mut first, mut second) = (Self::default(), Self::default());
        (first.t, second.t) = halves(self.t, len);
        (first.primitive, second.primitive) = halves(self.primitive, len);
        (first.point, second.point) = halves(self.point, len);
        (first.barycentric, second.barycentric) = halves(self.barycentric, len);
        (first.side, second.side) = halves(self.side, len);
        (first, second)
    }
}

/// Arrays for hits.
pub(crate) struct HitArrays<'py> {
    t: Option<PyReadwriteArray1<'py, f64>>,
    primitive: Option<PyReadwriteArray1<'py, i64>>,
    point: Option<PyReadwriteArray1<'py, f64>>,
    barycentric: Option<PyReadwriteArray1<'py, f64>>,
    side: Option<PyReadwriteArray1<'py, i8>>,
}

impl<'py> HitArrays<'py> {
    pub(crate) fn borrow(out: &Bound<'py, PyDict>) -> PyResult<Self> {
        Ok(Self {
            t: borrowed(out, "t")?,
            primitive: borrowed(out, "primitive")?,
            point: borrowed(out, "point")?,
            barycentric: borrowed(out, "barycentric")?,
            side: borrowed(out, "side")?,
        })
    }

    pub(crate) fn columns(&mut self) -> PyResult<HitColumns<'_>> {
        Ok(HitColumns {
            t: slice(&mut self.t)?,
            primitive: slice(&mut self.primitive)?,
            point: slice(&mut self.point)?.map(|flat| flat.as_chunks_mut().0),
            barycentric: slice(&mut self.barycentric)?.map(|flat| flat.as_chunks_mut().0),
            side: slice(&mut self.side)?,
        })
    }
}

/// The hits of some rays, before they are columns.
#[pyclass(frozen, module = "p2m._p2m")]
pub(crate) struct HitList {
    pub(crate) list: Vec<Hit>,
    /// The ids of the primitives, where they are not those of the hits.
    pub(crate) ids: Option<Vec<i64>>,
}

#[pymethods]
impl HitList {
    fn __len__(&self) -> usize {
        self.list.len()
    }

    /// Writes the columns of the arrays of `out`, which have a place for each hit of the list.
    fn fill(&self, py: Python<'_>, out: &Bound<'_, PyDict>) -> PyResult<()> {
        let mut arrays = HitArrays::borrow(out)?;
        let mut columns = arrays.columns()?;
        py.detach(|| match &self.ids {
            None => self.list.iter().enumerate().for_each(|(i, hit)| columns.set(i, Some(hit))),
            Some(ids) => {
                let hits = ids.iter().copied().zip(&self.list);
                hits.enumerate().for_each(|(i, hit)| columns.set_with_id(i, Some(hit)));
            }
        });
        Ok(())
    }
}

#[pymethods]
impl Index {
    /// Casts rays. The arrays of `out` depend on the mode: columns of hits for `first`, and the array `value` for all
    /// others. The mode `all` returns the hits.
    #[pyo3(signature = (origins, directions, mode, out, t_min, t_max, radius, threads, progress))]
    #[allow(clippy::too_many_arguments, reason = "the Python layer passes them all")]
    fn rays(
        &self,
        py: Python<'_>,
        origins: PyReadonlyArray1<'_, f64>,
        directions: PyReadonlyArray1<'_, f64>,
        mode: &str,
        out: &Bound<'_, PyDict>,
        t_min: f64,
        t_max: f64,
        radius: f64,
        threads: usize,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Option<HitList>> {
        let Some(index) = self.built.index.as_ray_query() else {
            return Err(value_error(format!(
                "the backend '{}' casts no rays: use {}",
                self.backend,
                alternatives(|backend| backend.casts_rays)
            )));
        };
        let cast = Cast { parent: self, index, range: [t_min, t_max], radius, mode, threads, progress };
        cast.run(py, triples(origins.as_slice())?, triples(directions.as_slice())?, out)
    }
}

/// The arguments of a batch of rays.
struct Cast<'a> {
    parent: &'a Index,
    index: &'a (dyn RayQuery<f64> + Sync),
    range: [f64; 2],
    radius: f64,
    mode: &'a str,
    threads: usize,
    progress: Option<Py<PyAny>>,
}

impl Cast<'_> {
    fn run(
        self,
        py: Python<'_>,
        origins: &[[f64; 3]],
        directions: &[[f64; 3]],
        out: &Bound<'_, PyDict>,
    ) -> PyResult<Option<HitList>> {
        let Self { parent, index, range, radius, mode, threads, progress } = self;
        let rays = Rays { origins, directions, range, radius };
        match mode {
            "first" => {
                let mut arrays = HitArrays::borrow(out)?;
                let columns = arrays.columns()?;
                let work = |threads: &Threads, monitor: &Monitor| {
                    rays.check()?;
                    let first = |ray: &Ray| index.first_intersection(ray);
                    rays.answer(columns, threads, monitor, first, |hits, mut columns: HitColumns<'_>| {
                        hits.iter().enumerate().for_each(|(i, hit)| columns.set(i, hit.as_ref()));
                    });
                    Ok::<(), BadRay>(())
                };
                parent.run(py, origins.len(), threads, progress, work)?;
                Ok(None)
            }
            "any" => {
                let mut array = borrowed::<bool>(out, "value")?;
                let values = slice(&mut array)?.unwrap_or_default();
                let work = |threads: &Threads, monitor: &Monitor| {
                    rays.check()?;
                    let hits = |ray: &Ray| index.do_intersect(ray);
                    rays.answer(values, threads, monitor, hits, |hits, values: &mut [bool]| {
                        values.copy_from_slice(&hits);
                    });
                    Ok::<(), BadRay>(())
                };
                parent.run(py, origins.len(), threads, progress, work)?;
                Ok(None)
            }
            "count" | "crossings" => {
                let mut array = borrowed::<i64>(out, "value")?;
                let values = slice(&mut array)?.unwrap_or_default();
                let crosses = mode == "crossings";
                let work = |threads: &Threads, monitor: &Monitor| {
                    rays.check()?;
                    let count = |ray: &Ray| if crosses { index.crossings(ray) } else { index.count(ray) };
                    rays.answer(values, threads, monitor, count, |counts, values: &mut [i64]| {
                        for (value, count) in values.iter_mut().zip(counts) {
                            *value = i64::try_from(count).unwrap_or(i64::MAX);
                        }
                    });
                    Ok::<(), BadRay>(())
                };
                parent.run(py, origins.len(), threads, progress, work)?;
                Ok(None)
            }
            "all" => {
                let mut array = borrowed::<i64>(out, "value")?;
                let values = slice(&mut array)?.unwrap_or_default();
                let work = |threads: &Threads, monitor: &Monitor| {
                    rays.check()?;
                    let all = |ray: &Ray| index.all_intersections(ray);
                    let parts = rays.answer(values, threads, monitor, all, |hits, values: &mut [i64]| {
                        for (value, hits) in values.iter_mut().zip(&hits) {
                            *value = i64::try_from(hits.len()).unwrap_or(i64::MAX);
                        }
                        hits.concat()
                    });
                    Ok::<_, BadRay>(HitList { list: parts.concat(), ids: None })
                };
                parent.run(py, origins.len(), threads, progress, work).map(Some)
            }
            _ => Err(value_error(format!("mode: '{mode}' is none of 'first', 'all', 'count', 'any', 'crossings'"))),
        }
    }
}
