//! Alignments of scans.

use crate::arrays::{Coordinates, with_positions};
use crate::errors::value_error;
use crate::index::Index;
use crate::work::run_owned;
use nalgebra::{Matrix4, Point3};
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use p2m_core::Position;
use p2m_field::align::{self as alignment, AlignError, AlignOptions, Ambiguity};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::ops::ControlFlow;
use std::sync::Arc;

/// Aligns the points of a scan with the scene of an index, and returns the parts of the result by their names.
#[pyfunction]
pub(crate) fn align<'py>(
    py: Python<'py>,
    scan: Coordinates<'py>,
    index: &Index,
    point_to_point: bool,
    scale: bool,
    overlap: f64,
    search: bool,
    threads: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let points: Vec<Point3<f64>> = with_positions!(scan, slice => slice.iter().map(Position::<f64>::point).collect());
    let options = AlignOptions::default()
        .with_point_to_point(point_to_point)
        .with_scale(scale)
        .with_overlap(overlap)
        .with_search(search);
    let (scene, built) = (Arc::clone(&index.scene), Arc::clone(&index.built.index));
    let found = run_owned(py, threads, 1, None, move |monitor| {
        let mut report =
            |_: &_| if monitor.is_cancelled() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
        let found = alignment::align(&*scene.soup, &*built, &points, &options, &mut report)?;
        let moved: Vec<[f64; 3]> = points.iter().map(|point| found.apply(point).coords.into()).collect();
        Ok::<_, AlignError>((found, moved))
    })?;
    let (found, moved) = found.map_err(value_error)?;
    let dictionary = PyDict::new(py);
    let count = moved.len();
    dictionary.set_item("points", PyArray1::from_vec(py, moved.into_flattened()).reshape([count, 3])?)?;
    dictionary.set_item("matrix", matrix(py, &found.matrix)?)?;
    dictionary.set_item("scale", found.scale)?;
    dictionary.set_item("rms", found.rms)?;
    dictionary.set_item("coverage", found.coverage)?;
    dictionary.set_item("converged", found.is_converged)?;
    let rounds: Vec<_> = found.rounds.iter().map(|round| (round.points, round.rms, round.step)).collect();
    dictionary.set_item("rounds", rounds)?;
    dictionary.set_item("ambiguity", found.ambiguity.map(|ambiguity| ambiguity.to_string()))?;
    let other = match &found.ambiguity {
        Some(Ambiguity::OtherPose { matrix: other }) => Some(matrix(py, other)?),
        _ => None,
    };
    dictionary.set_item("other", other)?;
    Ok(dictionary)
}

fn matrix<'py>(py: Python<'py>, matrix: &Matrix4<f64>) -> PyResult<Bound<'py, PyArray2<f64>>> {
    // The columns of the transpose are the rows.
    PyArray1::from_slice(py, matrix.transpose().as_slice()).reshape([4, 4])
}
