//! Columns of near pairs of primitives in arrays of NumPy. Arrays of two have the first scene first.

use crate::columns::{NO_FEATURE, NO_PRIMITIVE, borrowed, halves, slice};
use crate::parts::Split;
use numpy::PyReadwriteArray1;
use p2m_core::Feature;
use p2m_core::pair::ClosestPair;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Arrays that are borrowed for writing. Those that are not asked for are missing.
pub(crate) struct PairArrays<'py> {
    distance: Option<PyReadwriteArray1<'py, f64>>,
    primitive: Option<PyReadwriteArray1<'py, i64>>,
    primitives: Option<PyReadwriteArray1<'py, i64>>,
    points: Option<PyReadwriteArray1<'py, f64>>,
    features: Option<PyReadwriteArray1<'py, u8>>,
    barycentric: Option<PyReadwriteArray1<'py, f64>>,
    lower_bound: Option<PyReadwriteArray1<'py, f64>>,
    is_intersecting: Option<PyReadwriteArray1<'py, bool>>,
}

impl<'py> PairArrays<'py> {
    /// Borrows the arrays of a dictionary by their names.
    pub(crate) fn borrow(arrays: &Bound<'py, PyDict>) -> PyResult<Self> {
        Ok(Self {
            distance: borrowed(arrays, "distance")?,
            primitive: borrowed(arrays, "primitive")?,
            primitives: borrowed(arrays, "primitives")?,
            points: borrowed(arrays, "points")?,
            features: borrowed(arrays, "features")?,
            barycentric: borrowed(arrays, "barycentric")?,
            lower_bound: borrowed(arrays, "lower_bound")?,
            is_intersecting: borrowed(arrays, "is_intersecting")?,
        })
    }

    /// Returns the columns, which have places for `len` pairs.
    pub(crate) fn columns(&mut self, len: usize) -> PyResult<PairColumns<'_>> {
        let columns = PairColumns {
            distance: slice(&mut self.distance)?,
            primitive: slice(&mut self.primitive)?,
            primitives: slice(&mut self.primitives)?.map(|flat| flat.as_chunks_mut().0),
            points: slice(&mut self.points)?.map(bytemuck::cast_slice_mut),
            features: slice(&mut self.features)?.map(|flat| flat.as_chunks_mut().0),
            barycentric: slice(&mut self.barycentric)?.map(bytemuck::cast_slice_mut),
            lower_bound: slice(&mut self.lower_bound)?,
            is_intersecting: slice(&mut self.is_intersecting)?,
        };
        if columns.lengths().all(|other| other == len) {
            return Ok(columns);
        }
        Err(PyTypeError::new_err("an array of answers has another length"))
    }
}

/// Columns of pairs, as NumPy has them.
#[derive(Default)]
pub(crate) struct PairColumns<'a> {
    distance: Option<&'a mut [f64]>,
    /// The primitive of the first scene.
    primitive: Option<&'a mut [i64]>,
    primitives: Option<&'a mut [[i64; 2]]>,
    points: Option<&'a mut [[[f64; 3]; 2]]>,
    features: Option<&'a mut [[u8; 2]]>,
    barycentric: Option<&'a mut [[[f64; 3]; 2]]>,
    lower_bound: Option<&'a mut [f64]>,
    is_intersecting: Option<&'a mut [bool]>,
}

impl PairColumns<'_> {
    fn lengths(&self) -> impl Iterator<Item = usize> {
        [
            self.distance.as_ref().map(|column| column.len()),
            self.primitive.as_ref().map(|column| column.len()),
            self.primitives.as_ref().map(|column| column.len()),
            self.points.as_ref().map(|column| column.len()),
            self.features.as_ref().map(|column| column.len()),
            self.barycentric.as_ref().map(|column| column.len()),
            self.lower_bound.as_ref().map(|column| column.len()),
            self.is_intersecting.as_ref().map(|column| column.len()),
        ]
        .into_iter()
        .flatten()
    }

    /// Writes pairs, some of which may be missing, to the first places.
    pub(crate) fn set_all(&mut self, pairs: &[Option<ClosestPair<f64>>]) {
        for (i, pair) in pairs.iter().enumerate() {
            self.set(i, pair.as_ref());
        }
    }

    /// Writes a pair, or that there is none.
    fn set(&mut self, i: usize, pair: Option<&ClosestPair<f64>>) {
        if let Some(column) = &mut self.distance {
            column[i] = pair.map_or(f64::INFINITY, |pair| pair.distance);
        }
        if let Some(column) = &mut self.primitive {
            column[i] = pair.map_or(NO_PRIMITIVE, |pair| i64::from(pair.primitives[0].number()));
        }
        if let Some(column) = &mut self.primitives {
            column[i] = pair.map_or([NO_PRIMITIVE; 2], |pair| pair.primitives.map(|id| i64::from(id.number())));
        }
        if let Some(column) = &mut self.points {
            column[i] = pair.map_or([[f64::NAN; 3]; 2], |pair| pair.points.map(|point| point.coords.into()));
        }
        if let Some(column) = &mut self.features {
            column[i] = pair.map_or([NO_FEATURE; 2], |pair| pair.features.map(Feature::code));
        }
        if let Some(column) = &mut self.barycentric {
            column[i] = pair.map_or([[f64::NAN; 3]; 2], |pair| pair.barycentric);
        }
        if let Some(column) = &mut self.lower_bound {
            column[i] = pair.map_or(f64::INFINITY, |pair| pair.lower_bound);
        }
        if let Some(column) = &mut self.is_intersecting {
            column[i] = pair.is_some_and(|pair| pair.is_intersecting);
        }
    }
}

impl Split for PairColumns<'_> {
    fn split(self, len: usize) -> (Self, Self) {
        let (mut first, mut second) = (Self::default(), Self::default());
        (first.distance, second.distance) = halves(self.distance, len);
        (first.primitive, second.primitive) = halves(self.primitive, len);
        (first.primitives, second.primitives) = halves(self.primitives, len);
        (first.points, second.points) = halves(self.points, len);
        (first.features, second.features) = halves(self.features, len);
        (first.barycentric, second.barycentric) = halves(self.barycentric, len);
        (first.lower_bound, second.lower_bound) = halves(self.lower_bound, len);
        (first.is_intersecting, second.is_intersecting) = halves(self.is_intersecting, len);
        (first, second)
    }
}

/// Pairs of primitives of two scenes, before they are columns.
#[pyclass(frozen, module = "p2m._p2m")]
pub(crate) struct PairList {
    pub(crate) list: Vec<Option<ClosestPair<f64>>>,
}

#[pymethods]
impl PairList {
    fn __len__(&self) -> usize {
        self.list.len()
    }

    /// Writes the columns of the arrays of `out`, which have a place for each pair of the list.
    fn fill(&self, py: Python<'_>, out: &Bound<'_, PyDict>) -> PyResult<()> {
        let mut arrays = PairArrays::borrow(out)?;
        let mut columns = arrays.columns(self.list.len())?;
        py.detach(|| columns.set_all(&self.list));
        Ok(())
    }
}
