//! Hausdorff distances.

use crate::errors::value_error;
use crate::index::Index;
use crate::scene::Scene;
use crate::work::run_owned;
use p2m_field::{
    Direction, HausdorffDistance, HausdorffOptions, HausdorffProgress, hausdorff_distance, one_sided_hausdorff_distance,
};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::ops::ControlFlow;
use std::sync::Arc;

/// Returns the Hausdorff distance of two scenes, or the one-sided one if there is no index of the first scene, by the
/// names of its parts; `None` if a scene is empty.
#[pyfunction]
pub(crate) fn hausdorff<'py>(
    py: Python<'py>,
    first: &Scene,
    first_index: Option<&Index>,
    second: &Index,
    tolerance: f64,
    max_queries: u64,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<Option<Bound<'py, PyDict>>> {
    let options = HausdorffOptions::new(tolerance).with_max_queries(max_queries);
    let (a, b) = (Arc::clone(&first.shared.soup), Arc::clone(&second.scene.soup));
    let (of_a, of_b) = (first_index.map(|index| Arc::clone(&index.built.index)), Arc::clone(&second.built.index));
    let limit = usize::try_from(max_queries).unwrap_or(usize::MAX);
    let vertices = a.positions().len() + if of_a.is_some() { b.positions().len() } else { 0 };
    let found = run_owned(py, threads, limit.saturating_add(vertices), progress, move |monitor| {
        let mut report = |progress: &HausdorffProgress<f64>| {
            monitor.set_done(usize::try_from(progress.queries).unwrap_or(usize::MAX));
            if monitor.is_cancelled() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        match &of_a {
            Some(of_a) => hausdorff_distance((&*a, &**of_a), (&*b, &*of_b), &options, &mut report),
            None => one_sided_hausdorff_distance(&*a, &*of_b, &options, &mut report),
        }
    })?;
    found.map_err(value_error)?.map(|found| parts(py, &found)).transpose()
}

/// Returns a Hausdorff distance by the names of its parts.
fn parts<'py>(py: Python<'py>, found: &HausdorffDistance<f64>) -> PyResult<Bound<'py, PyDict>> {
    let dictionary = PyDict::new(py);
    dictionary.set_item("lower_bound", found.lower_bound)?;
    dictionary.set_item("upper_bound", found.upper_bound)?;
    dictionary.set_item("reached", found.is_tolerance_reached)?;
    dictionary.set_item("points", found.points.map(|point| <[f64; 3]>::from(point.coords)))?;
    dictionary.set_item("primitives", found.primitives.map(|id| id.number()))?;
    dictionary.set_item("from_scene", u8::from(found.direction == Direction::SecondToFirst))?;
    dictionary.set_item("queries", found.queries)?;
    Ok(dictionary)
}
