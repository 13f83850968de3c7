//! Conversion of arguments that are NumPy arrays.

use crate::errors::value_error;
use nalgebra::{Isometry3, Point3};
use numpy::{Element, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadwriteArray1};
use p2m_core::Position;
use p2m_core::pair::isometry_of_matrix;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Borrows an array from a dictionary for writing.
pub(crate) fn borrowed<'py, T: Element>(
    arrays: &Bound<'py, PyDict>,
    name: &str,
) -> PyResult<Option<PyReadwriteArray1<'py, T>>> {
    let Some(array) = arrays.get_item(name)? else { return Ok(None) };
    let array = array.cast_into::<PyArray1<T>>().map_err(|_| PyTypeError::new_err(format!("{name}: wrong array")))?;
    let borrowed = array.try_readwrite().map_err(|_| {
        value_error(format!(
            "out: the array of {name} is read-only, or another array of this call or of a running one \
                             has parts of its memory"
        ))
    })?;
    Ok(Some(borrowed))
}

/// Returns an array as a slice.
pub(crate) fn slice<'a, T: Element>(array: &'a mut Option<PyReadwriteArray1<'_, T>>) -> PyResult<Option<&'a mut [T]>> {
    let contiguous = |_| PyTypeError::new_err("an array of answers is not contiguous");
    array.as_mut().map(|array| array.as_slice_mut().map_err(contiguous)).transpose()
}

/// Coordinates as a flat array, three for each position, in either of the two scalars of positions.
#[derive(FromPyObject)]
pub(crate) enum Coordinates<'py> {
    F64(PyReadonlyArray1<'py, f64>),
    F32(PyReadonlyArray1<'py, f32>),
}

/// Evaluates an expression with the coordinates as a slice of `[T; 3]`, for either scalar.
macro_rules! with_positions {
    ($coordinates:expr, $slice:ident => $body:expr) => {
        match &$coordinates {
            $crate::arrays::Coordinates::F64(array) => {
                let $slice: &[[f64; 3]] = $crate::arrays::triples(array.as_slice())?;
                $body
            }
            $crate::arrays::Coordinates::F32(array) => {
                let $slice: &[[f32; 3]] = $crate::arrays::triples(array.as_slice())?;
                $body
            }
        }
    };
}
pub(crate) use with_positions;

impl Coordinates<'_> {
    /// Returns the coordinates as points in f64.
    pub(crate) fn points(&self) -> PyResult<Vec<Point3<f64>>> {
        Ok(with_positions!(self, slice => slice.iter().map(Position::<f64>::point).collect()))
    }
}

/// Returns a contiguous array as a slice of `[T; 3]`.
pub(crate) fn triples<T, E>(slice: Result<&[T], E>) -> PyResult<&[[T; 3]]> {
    match slice.map(<[T]>::as_chunks) {
        Ok((triples, [])) => Ok(triples),
        _ => Err(PyTypeError::new_err("an array is not contiguous, or its length is not a multiple of three")),
    }
}

/// Returns points as the rows of an array, without copying them.
pub(crate) fn rows(py: Python<'_>, points: Vec<Point3<f64>>) -> PyResult<Bound<'_, PyArray2<f64>>> {
    let count = points.len();
    let rows: Vec<[f64; 3]> = points.into_iter().map(|point| point.coords.into()).collect();
    PyArray1::from_vec(py, rows.into_flattened()).reshape([count, 3])
}

/// Returns the motions that flat 4 x 4 matrices stand for.
pub(crate) fn motions(matrices: &PyReadonlyArray1<'_, f64>) -> PyResult<Vec<Isometry3<f64>>> {
    match matrices.as_slice().map(<[f64]>::as_chunks) {
        Ok((matrices, [])) => Ok(matrices.iter().map(|matrix: &[f64; 16]| isometry_of_matrix(matrix)).collect()),
        _ => Err(PyTypeError::new_err("the transforms are not contiguous matrices of 4 x 4 numbers")),
    }
}
