//! Advice on backends.

use crate::arrays::Coordinates;
use crate::errors::value_error;
use crate::scene::Scene;
use crate::work::run_owned;
use p2m_backends::{Estimate, QueryRegion, Workload, recommend};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::time::Duration;

/// The name of a backend, the times of its build and of a query, its memory and the total time; whether they are
/// measured, the number of queries at which it breaks even, and the reason for its rank.
type Row = (&'static str, (f64, f64, f64, f64), bool, Option<f64>, String);

/// Returns the estimates of all backends, the recommended one first.
#[pyfunction]
pub(crate) fn advise(
    py: Python<'_>,
    scene: &Scene,
    queries: u64,
    region: &str,
    points: Option<Coordinates<'_>>,
    max_bytes: Option<usize>,
    max_seconds: Option<f64>,
    threads: usize,
) -> PyResult<Vec<Row>> {
    let points = points.map(|points| points.points()).transpose()?;
    let is_near = match region {
        "near" => true,
        "box" => false,
        _ => return Err(PyValueError::new_err(format!("region: '{region}' is none of 'near', 'box'"))),
    };
    let max_time = max_seconds.map_or(Ok(Duration::MAX), Duration::try_from_secs_f64);
    let max_time = max_time.map_err(|error| PyValueError::new_err(format!("max_seconds: {error}")))?;
    let shared = scene.shared.clone();
    let advice = run_owned(py, (threads, None), 1, move |_| {
        let region = match &points {
            Some(points) => QueryRegion::Like(points),
            None if is_near => QueryRegion::NearSurface,
            None => QueryRegion::SceneBox,
        };
        let workload = Workload::new(queries, region).with_max_time(max_time);
        recommend(&shared.soup, &workload.with_max_bytes(max_bytes.unwrap_or(usize::MAX)))
    })?;
    let row = |estimate: &Estimate| {
        let Estimate { backend, build_seconds, query_seconds, bytes, total_seconds, .. } = *estimate;
        let costs = (build_seconds, query_seconds, bytes, total_seconds);
        (backend.name, costs, estimate.is_measured, estimate.break_even, estimate.reason())
    };
    Ok(advice.map_err(value_error)?.estimates.iter().map(row).collect())
}
