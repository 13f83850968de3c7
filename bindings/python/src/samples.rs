//! Random points on and around scenes.

use crate::arrays::rows;
use crate::errors::value_error;
use crate::memory::reserve;
use crate::scene::Scene;
use crate::work::run_owned;
use nalgebra::Point3;
use numpy::{PyArray1, PyArray2};
use p2m_core::{Aabb, PrimitiveId};
use p2m_field::sample::{self, Samples, SurfaceSampler};
use pyo3::prelude::*;
use std::sync::Arc;

/// The points, and the ids of their primitives.
type Columns<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray1<i64>>);

/// Returns points of a scene and the ids of their primitives. With `sigmas`, noise moves the points.
#[pyfunction]
pub(crate) fn sample_surface<'py>(
    py: Python<'py>,
    scene: &Scene,
    count: usize,
    sigmas: Vec<f64>,
    seed: u64,
    threads: usize,
) -> PyResult<Columns<'py>> {
    let soup = Arc::clone(&scene.shared.soup);
    let samples = run_owned(py, (threads, None), 1, move |_| -> Option<Samples> {
        check_memory(count);
        let sampler = SurfaceSampler::new(soup)?;
        Some(if sigmas.is_empty() { sampler.surface(seed, count) } else { sampler.near(seed, count, &sigmas) })
    })?;
    let samples =
        samples.ok_or_else(|| value_error("the scene is empty, or no area or length of it is finite and above 0"))?;
    let primitives = samples.primitives.iter().map(|id| i64::from(id.number()));
    Ok((rows(py, samples.points)?, PyArray1::from_iter(py, primitives)))
}

/// Returns points that are uniformly distributed in a box.
#[pyfunction]
pub(crate) fn sample_box<'py>(
    py: Python<'py>,
    low: [f64; 3],
    high: [f64; 3],
    count: usize,
    seed: u64,
    threads: usize,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let bounds = Aabb { min: low.into(), max: high.into() };
    let points = run_owned(py, (threads, None), 1, move |_| {
        check_memory(count);
        sample::in_box(&bounds, seed, count)
    })?;
    rows(py, points)
}

/// Unwinds this thread if there is too little memory for this number of samples.
fn check_memory(count: usize) {
    reserve(&mut Vec::<(Point3<f64>, PrimitiveId)>::new(), count);
}
