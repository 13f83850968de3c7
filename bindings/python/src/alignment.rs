//! Alignments of scans.

use crate::arrays::{Coordinates, rows};
use crate::errors::value_error;
use crate::index::Index;
use crate::work::run_owned;
use nalgebra::{Matrix4, Point3};
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use p2m_field::align::{self as alignment, AlignError, AlignOptions, Ambiguity};
use pyo3::prelude::*;
use std::ops::ControlFlow;
use std::sync::Arc;

type Array2<'py> = Bound<'py, PyArray2<f64>>;

/// The fields of `p2m.Alignment`, in order.
type Parts<'py> =
    (Array2<'py>, Array2<'py>, f64, f64, f64, bool, Vec<(usize, f64, f64)>, Option<String>, Option<Array2<'py>>);

/// Aligns the points of a scan with the scene of an index.
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
) -> PyResult<Parts<'py>> {
    let points = scan.points()?;
    let options = AlignOptions::default()
        .with_point_to_point(point_to_point)
        .with_scale(scale)
        .with_overlap(overlap)
        .with_search(search);
    let (scene, built) = (Arc::clone(&index.scene), index.any());
    let found = run_owned(py, (threads, None), 1, move |monitor| {
        let mut report =
            |_: &_| if monitor.is_cancelled() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
        let found = alignment::align(&*scene.soup, &*built, &points, &options, &mut report)?;
        let moved: Vec<Point3<f64>> = points.iter().map(|point| found.apply(point)).collect();
        Ok::<_, AlignError>((found, moved))
    })?;
    let (found, moved) = found.map_err(value_error)?;
    let rounds = found.rounds.iter().map(|round| (round.points, round.rms, round.step)).collect();
    let other = match &found.ambiguity {
        Some(Ambiguity::OtherPose { matrix: other }) => Some(matrix(py, other)?),
        _ => None,
    };
    let (matrix, points, ambiguity) = (matrix(py, &found.matrix)?, rows(py, moved)?, found.ambiguity);
    let ambiguity = ambiguity.map(|ambiguity| ambiguity.to_string());
    Ok((matrix, points, found.rms, found.coverage, found.scale, found.is_converged, rounds, ambiguity, other))
}

fn matrix<'py>(py: Python<'py>, matrix: &Matrix4<f64>) -> PyResult<Array2<'py>> {
    // nalgebra stores columns, so the transpose is written to get rows.
    PyArray1::from_slice(py, matrix.transpose().as_slice()).reshape([4, 4])
}
