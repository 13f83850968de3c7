//! Hausdorff distances.

use crate::arrays::rows;
use crate::errors::value_error;
use crate::index::Index;
use crate::scene::Scene;
use crate::work::{Run, run_owned};
use numpy::{PyArray1, PyArray2};
use p2m_field::{
    Direction, HausdorffDistance, HausdorffOptions, HausdorffProgress, hausdorff_distance, one_sided_hausdorff_distance,
};
use pyo3::prelude::*;
use std::ops::ControlFlow;
use std::sync::Arc;

/// The fields of `p2m.HausdorffDistance`, in order.
type Parts<'py> = (f64, f64, Bound<'py, PyArray2<f64>>, Bound<'py, PyArray1<i64>>, u8, u64, bool);

/// Returns the Hausdorff distance of two scenes, or the one-sided distance if there is no index of the first scene;
/// `None` if a scene is empty.
#[pyfunction]
pub(crate) fn hausdorff<'py>(
    py: Python<'py>,
    first: &Scene,
    first_index: Option<&Index>,
    second: &Index,
    tolerance: f64,
    max_queries: u64,
    run: Run,
) -> PyResult<Option<Parts<'py>>> {
    let options = HausdorffOptions::new(tolerance).with_max_queries(max_queries);
    let (a, b) = (Arc::clone(&first.shared.soup), Arc::clone(&second.scene.soup));
    let (of_a, of_b) = (first_index.map(|index| Arc::clone(&index.built.index)), Arc::clone(&second.built.index));
    let limit = usize::try_from(max_queries).unwrap_or(usize::MAX);
    let vertices = a.positions().len() + if of_a.is_some() { b.positions().len() } else { 0 };
    let found = run_owned(py, run, limit.saturating_add(vertices), move |monitor| {
        let mut report = |progress: &HausdorffProgress<f64>| {
            monitor.set_done(usize::try_from(progress.queries).unwrap_or(usize::MAX));
            if monitor.is_cancelled() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        match &of_a {
            Some(of_a) => hausdorff_distance((&*a, &**of_a), (&*b, &*of_b), &options, &mut report),
            None => one_sided_hausdorff_distance(&*a, &*of_b, &options, &mut report),
        }
    })?;
    let Some(found) = found.map_err(value_error)? else { return Ok(None) };
    let HausdorffDistance { lower_bound, upper_bound, points, primitives, queries, .. } = found;
    let primitives = PyArray1::from_iter(py, primitives.map(|id| i64::from(id.number())));
    let from_scene = u8::from(found.direction == Direction::SecondToFirst);
    let points = rows(py, points.to_vec())?;
    Ok(Some((lower_bound, upper_bound, points, primitives, from_scene, queries, found.is_tolerance_reached)))
}
