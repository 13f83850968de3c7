//! Columns of answers in arrays of NumPy.

use crate::errors::value_error;
use crate::parts::Split;
use nalgebra::Point3;
use numpy::{Element, PyArray1, PyArrayMethods, PyReadwriteArray1};
use p2m_core::batch::ClosestColumns;
use p2m_core::{Closest, Feature};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The number that stands for no primitive.
pub(crate) const NO_PRIMITIVE: i64 = -1;
/// The number that stands for no feature.
pub(crate) const NO_FEATURE: u8 = 255;

/// Arrays that are borrowed for writing, each as long as the answers. Those that are not asked for are missing.
pub(crate) struct Arrays<'py> {
    distance: Option<PyReadwriteArray1<'py, f64>>,
    primitive: Option<PyReadwriteArray1<'py, i64>>,
    point: Option<PyReadwriteArray1<'py, f64>>,
    feature: Option<PyReadwriteArray1<'py, u8>>,
    barycentric: Option<PyReadwriteArray1<'py, f64>>,
    lower_bound: Option<PyReadwriteArray1<'py, f64>>,
}

/// Borrows an array of a dictionary for writing.
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

impl<'py> Arrays<'py> {
    /// Borrows the arrays of a dictionary by their names.
    pub(crate) fn borrow(arrays: &Bound<'py, PyDict>) -> PyResult<Self> {
        Ok(Self {
            distance: borrowed(arrays, "distance")?,
            primitive: borrowed(arrays, "primitive")?,
            point: borrowed(arrays, "point")?,
            feature: borrowed(arrays, "feature")?,
            barycentric: borrowed(arrays, "barycentric")?,
            lower_bound: borrowed(arrays, "lower_bound")?,
        })
    }

    /// Returns the columns, which have places for `len` answers.
    pub(crate) fn columns(&mut self, len: usize) -> PyResult<Columns<'_>> {
        let barycentric = slice(&mut self.barycentric)?.map(|flat| flat.as_chunks_mut().0);
        let columns = Columns {
            distance: slice(&mut self.distance)?,
            primitive: slice(&mut self.primitive)?,
            point: slice(&mut self.point)?.map(bytemuck::cast_slice_mut),
            feature: slice(&mut self.feature)?,
            barycentric,
            lower_bound: slice(&mut self.lower_bound)?,
        };
        if columns.lengths().all(|other| other == len) {
            return Ok(columns);
        }
        Err(PyTypeError::new_err("an array of answers has another length"))
    }
}

/// Columns of answers, as NumPy has them.
#[derive(Default)]
pub(crate) struct Columns<'a> {
    distance: Option<&'a mut [f64]>,
    primitive: Option<&'a mut [i64]>,
    point: Option<&'a mut [Point3<f64>]>,
    feature: Option<&'a mut [u8]>,
    barycentric: Option<&'a mut [[f64; 3]]>,
    lower_bound: Option<&'a mut [f64]>,
}

impl Columns<'_> {
    fn lengths(&self) -> impl Iterator<Item = usize> {
        [
            self.distance.as_ref().map(|column| column.len()),
            self.primitive.as_ref().map(|column| column.len()),
            self.point.as_ref().map(|column| column.len()),
            self.feature.as_ref().map(|column| column.len()),
            self.barycentric.as_ref().map(|column| column.len()),
            self.lower_bound.as_ref().map(|column| column.len()),
        ]
        .into_iter()
        .flatten()
    }

    /// Writes an answer, or that there is none.
    pub(crate) fn set(&mut self, i: usize, closest: Option<&Closest<f64>>) {
        self.set_with_id(i, closest.map(|closest| (i64::from(closest.primitive.number()), closest)));
    }

    /// Writes an answer whose primitive has this id, or that there is none.
    pub(crate) fn set_with_id(&mut self, i: usize, answer: Option<(i64, &Closest<f64>)>) {
        let closest = answer.map(|(_, closest)| closest);
        if let Some(column) = &mut self.distance {
            column[i] = closest.map_or(f64::INFINITY, |c| c.distance);
        }
        if let Some(column) = &mut self.primitive {
            column[i] = answer.map_or(NO_PRIMITIVE, |(id, _)| id);
        }
        if let Some(column) = &mut self.point {
            column[i] = closest.map_or(Point3::new(f64::NAN, f64::NAN, f64::NAN), |c| c.point);
        }
        if let Some(column) = &mut self.feature {
            column[i] = closest.map_or(NO_FEATURE, |c| c.feature.code());
        }
        if let Some(column) = &mut self.barycentric {
            column[i] = closest.map_or([f64::NAN; 3], |c| c.barycentric);
        }
        if let Some(column) = &mut self.lower_bound {
            column[i] = closest.map_or(f64::INFINITY, |c| c.lower_bound);
        }
    }

    /// Lets a batch fill the columns.
    ///
    /// Primitives of a batch are u32. They are written to the first half of their column and spread from its end, so no
    /// other memory is needed.
    pub(crate) fn fill(self, batch: impl FnOnce(ClosestColumns<'_, f64>)) {
        let Self { distance, mut primitive, point, feature, barycentric, lower_bound } = self;
        let mut features = feature.as_ref().map(|column| vec![Feature::Face; column.len()]);
        let mut distances = Vec::new();
        let mut columns = ClosestColumns::default();
        // A query without an answer has the feature of a vertex, so its distance decides.
        let known_distance = match (distance, &feature) {
            (Some(column), _) => Some(column),
            (None, Some(feature)) => {
                distances.resize(feature.len(), 0.0);
                Some(&mut distances[..])
            }
            (None, None) => None,
        };
        columns.lower_bound = lower_bound;
        columns.barycentric = barycentric;
        columns.point = point;
        columns.feature = features.as_deref_mut();
        columns.primitive = primitive.as_deref_mut().map(|column| {
            let len = column.len();
            &mut bytemuck::cast_slice_mut::<i64, u32>(column)[..len]
        });
        let mut known_distance = known_distance;
        columns.distance = known_distance.as_deref_mut();
        batch(columns);
        if let Some(column) = primitive {
            spread(column);
        }
        if let (Some(column), Some(features), Some(distances)) = (feature, features, known_distance) {
            for ((number, feature), distance) in column.iter_mut().zip(features).zip(distances) {
                *number = if *distance < f64::INFINITY { feature.code() } else { NO_FEATURE };
            }
        }
    }
}

/// Widens the u32 in the first half of a column to i64.
fn spread(column: &mut [i64]) {
    for i in (0..column.len()).rev() {
        // The value is at or before the place that is written, so nothing that is still needed is overwritten.
        let number = bytemuck::cast_slice::<i64, u32>(column)[i];
        column[i] = if number == ClosestColumns::<f64>::NO_PRIMITIVE { NO_PRIMITIVE } else { i64::from(number) };
    }
}

/// Columns with several places for each query.
pub(crate) struct Rows<'a> {
    pub(crate) columns: Columns<'a>,
    /// The number of places for each query.
    pub(crate) width: usize,
}

impl Split for Rows<'_> {
    fn split(self, len: usize) -> (Self, Self) {
        let (width, at) = (self.width, len * self.width);
        let (mut first, mut second) = (Columns::default(), Columns::default());
        let columns = self.columns;
        (first.distance, second.distance) = halves(columns.distance, at);
        (first.primitive, second.primitive) = halves(columns.primitive, at);
        (first.point, second.point) = halves(columns.point, at);
        (first.feature, second.feature) = halves(columns.feature, at);
        (first.barycentric, second.barycentric) = halves(columns.barycentric, at);
        (first.lower_bound, second.lower_bound) = halves(columns.lower_bound, at);
        (Self { columns: first, width }, Self { columns: second, width })
    }
}

/// The two parts of a column, if there is one.
type Halves<'a, T> = (Option<&'a mut [T]>, Option<&'a mut [T]>);

/// Divides a column in two, the first of so many places.
pub(crate) fn halves<T>(column: Option<&mut [T]>, at: usize) -> Halves<'_, T> {
    column.map_or((None, None), |column| {
        let (first, second) = column.split_at_mut(at);
        (Some(first), Some(second))
    })
}
