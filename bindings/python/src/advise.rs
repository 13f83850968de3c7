//! Advice on backends.

use crate::errors::build_error;
use crate::scene::{Coordinates, Scene, with_positions};
use crate::work::run_owned;
use nalgebra::Point3;
use p2m_backends::{Estimate, QueryRegion, Workload, recommend};
use p2m_core::Position;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use std::time::Duration;

/// Returns the estimates of all backends, the recommended one first.
#[pyfunction]
#[pyo3(signature = (scene, queries, region, points, max_bytes, max_seconds, threads))]
#[allow(clippy::too_many_arguments, reason = "the Python layer passes them all")]
pub(crate) fn advise<'py>(
    py: Python<'py>,
    scene: &Scene,
    queries: u64,
    region: &str,
    points: Option<Coordinates<'py>>,
    max_bytes: Option<usize>,
    max_seconds: Option<f64>,
    threads: usize,
) -> PyResult<Bound<'py, PyList>> {
    let points: Option<Vec<Point3<f64>>> = match points {
        Some(points) => Some(with_positions!(points, slice => slice.iter().map(Position::<f64>::point).collect())),
        None => None,
    };
    let is_near = match region {
        "near" => true,
        "box" => false,
        _ => return Err(PyValueError::new_err(format!("region: '{region}' is none of 'near', 'box'"))),
    };
    let max_time = max_seconds.map_or(Ok(Duration::MAX), Duration::try_from_secs_f64);
    let max_time = max_time.map_err(|error| PyValueError::new_err(format!("max_seconds: {error}")))?;
    let shared = scene.shared.clone();
    let advice = run_owned(py, threads, 1, None, move |_| {
        let region = match &points {
            Some(points) => QueryRegion::Like(points),
            None if is_near => QueryRegion::NearSurface,
            None => QueryRegion::SceneBox,
        };
        let workload = Workload::new(queries, region).with_max_time(max_time);
        recommend(&shared.soup, &workload.with_max_bytes(max_bytes.unwrap_or(usize::MAX)))
    })?;
    let advice = advice.map_err(build_error)?;
    PyList::new(py, advice.estimates.iter().map(|estimate| row(py, estimate)).collect::<PyResult<Vec<_>>>()?)
}

fn row<'py>(py: Python<'py>, estimate: &Estimate) -> PyResult<Bound<'py, PyDict>> {
    let row = PyDict::new(py);
    row.set_item("backend", estimate.backend.name)?;
    row.set_item("build_seconds", estimate.build_seconds)?;
    row.set_item("query_seconds", estimate.query_seconds)?;
    row.set_item("memory_bytes", estimate.bytes)?;
    row.set_item("total_seconds", estimate.total_seconds)?;
    row.set_item("is_measured", estimate.is_measured)?;
    row.set_item("break_even_queries", estimate.break_even)?;
    row.set_item("reason", estimate.reason())?;
    Ok(row)
}
