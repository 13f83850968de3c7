//! Advice on backends.

use crate::arrays::Coordinates;
use crate::errors::value_error;
use crate::scene::Scene;
use crate::work::run_owned;
use p2m_backends::{Choice, Estimate, QueryRegion, Workload};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::sync::Arc;

/// A row of the table of estimates: the name of the backend; the times of the build and of a query, the memory and the
/// total time; whether it is about as good as the recommended backend; the number of queries at which it breaks even;
/// and the reason for its rank.
type Row = (&'static str, (f64, f64, f64, f64), bool, Option<f64>, String);

/// Returns the estimates for all backends, the recommended one first.
#[pyfunction]
pub(crate) fn advise(
    py: Python<'_>,
    scene: &Scene,
    queries: u64,
    region: &str,
    points: Option<Coordinates<'_>>,
    max_bytes: Option<usize>,
    threads: usize,
) -> PyResult<Vec<Row>> {
    let points = points.map(|points| points.points()).transpose()?;
    let is_near = match region {
        "near" => true,
        "box" => false,
        _ => return Err(PyValueError::new_err(format!("region: '{region}' is none of 'near', 'box'"))),
    };
    let shared = scene.shared.clone();
    let advice = run_owned(py, (threads, None), 1, move |_| {
        let region = match &points {
            Some(points) => QueryRegion::Like(points),
            None if is_near => QueryRegion::NearSurface,
            None => QueryRegion::SceneBox,
        };
        let workload = Workload::new(queries, region).with_max_bytes(max_bytes.unwrap_or(usize::MAX));
        Choice::compare(Arc::clone(&shared.soup), &workload)
    })?;
    let row = |estimate: &Estimate| {
        let costs = (estimate.build_seconds, estimate.query_seconds, estimate.bytes, estimate.total_seconds);
        (estimate.backend.name, costs, estimate.is_about_best, estimate.break_even, estimate.reason.clone())
    };
    Ok(advice.map_err(value_error)?.estimates().into_iter().map(row).collect())
}
