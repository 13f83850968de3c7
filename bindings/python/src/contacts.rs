//! First contacts of balls that move along segments.

use crate::columns::{NO_FEATURE, NO_PRIMITIVE, borrowed, halves, slice};
use crate::index::Index;
use crate::parts::{Split, answer_in_parts};
use crate::queries::{BadRow, batch_options, check_finite, not_finite};
use crate::scene::triples;
use crate::work::{Monitor, Threads};
use numpy::{PyReadonlyArray1, PyReadwriteArray1};
use p2m_core::batch;
use p2m_core::pair::{BallContact, MovingBall};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// A ball whose path is not finite.
struct BadPath(&'static str, usize);

impl From<BadPath> for PyErr {
    fn from(BadPath(name, row): BadPath) -> Self {
        not_finite(name, row)
    }
}

/// Arrays for contacts.
struct ContactArrays<'py> {
    parameter: Option<PyReadwriteArray1<'py, f64>>,
    upper_parameter: Option<PyReadwriteArray1<'py, f64>>,
    distance_bound: Option<PyReadwriteArray1<'py, f64>>,
    primitive: Option<PyReadwriteArray1<'py, i64>>,
    point: Option<PyReadwriteArray1<'py, f64>>,
    feature: Option<PyReadwriteArray1<'py, u8>>,
}

impl<'py> ContactArrays<'py> {
    fn borrow(out: &Bound<'py, PyDict>) -> PyResult<Self> {
        Ok(Self {
            parameter: borrowed(out, "parameter")?,
            upper_parameter: borrowed(out, "upper_parameter")?,
            distance_bound: borrowed(out, "distance_bound")?,
            primitive: borrowed(out, "primitive")?,
            point: borrowed(out, "point")?,
            feature: borrowed(out, "feature")?,
        })
    }

    fn columns(&mut self) -> PyResult<ContactColumns<'_>> {
        Ok(ContactColumns {
            parameter: slice(&mut self.parameter)?,
            upper_parameter: slice(&mut self.upper_parameter)?,
            distance_bound: slice(&mut self.distance_bound)?,
            primitive: slice(&mut self.primitive)?,
            point: slice(&mut self.point)?.map(|flat| flat.as_chunks_mut().0),
            feature: slice(&mut self.feature)?,
        })
    }
}

/// Places for contacts.
#[derive(Default)]
struct ContactColumns<'a> {
    parameter: Option<&'a mut [f64]>,
    upper_parameter: Option<&'a mut [f64]>,
    distance_bound: Option<&'a mut [f64]>,
    primitive: Option<&'a mut [i64]>,
    point: Option<&'a mut [[f64; 3]]>,
    feature: Option<&'a mut [u8]>,
}

impl ContactColumns<'_> {
    fn set(&mut self, i: usize, contact: Option<&BallContact<f64>>) {
        if let Some(column) = &mut self.parameter {
            column[i] = contact.map_or(f64::INFINITY, |contact| contact.parameter);
        }
        if let Some(column) = &mut self.upper_parameter {
            column[i] = contact.map_or(f64::INFINITY, |contact| contact.upper_parameter);
        }
        if let Some(column) = &mut self.distance_bound {
            column[i] = contact.map_or(f64::INFINITY, |contact| contact.distance_bound);
        }
        if let Some(column) = &mut self.primitive {
            column[i] = contact.map_or(NO_PRIMITIVE, |contact| i64::from(contact.primitive.number()));
        }
        if let Some(column) = &mut self.point {
            column[i] = contact.map_or([f64::NAN; 3], |contact| contact.point.coords.into());
        }
        if let Some(column) = &mut self.feature {
            column[i] = contact.map_or(NO_FEATURE, |contact| contact.feature.code());
        }
    }
}

impl Split for ContactColumns<'_> {
    fn split(self, len: usize) -> (Self, Self) {
        let (mut first, mut second) = (Self::default(), Self::default());
        (first.parameter, second.parameter) = halves(self.parameter, len);
        (first.upper_parameter, second.upper_parameter) = halves(self.upper_parameter, len);
        (first.distance_bound, second.distance_bound) = halves(self.distance_bound, len);
        (first.primitive, second.primitive) = halves(self.primitive, len);
        (first.point, second.point) = halves(self.point, len);
        (first.feature, second.feature) = halves(self.feature, len);
        (first, second)
    }
}

#[pymethods]
impl Index {
    /// Finds the first contacts of balls of one radius, for the arrays of `out`.
    #[pyo3(signature = (starts, ends, out, radius, tolerance, threads, progress))]
    #[allow(clippy::too_many_arguments, reason = "the Python layer passes them all")]
    fn first_contact(
        &self,
        py: Python<'_>,
        starts: PyReadonlyArray1<'_, f64>,
        ends: PyReadonlyArray1<'_, f64>,
        out: &Bound<'_, PyDict>,
        radius: f64,
        tolerance: f64,
        threads: usize,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<()> {
        let index = self.pair_query()?;
        let (starts, ends) = (triples(starts.as_slice())?, triples(ends.as_slice())?);
        if starts.len() != ends.len() {
            return Err(PyTypeError::new_err("the numbers of starts and ends differ"));
        }
        let mut arrays = ContactArrays::borrow(out)?;
        let columns = arrays.columns()?;
        let work = |threads: &Threads, monitor: &Monitor| {
            check_finite(starts).map_err(|BadRow(row)| BadPath("starts", row))?;
            check_finite(ends).map_err(|BadRow(row)| BadPath("ends", row))?;
            answer_in_parts(starts.len(), columns, threads, monitor, &|range, mut columns: ContactColumns<'_>| {
                let ball = |row: usize| {
                    MovingBall::new(starts[row].into(), ends[row].into(), radius).with_tolerance(tolerance)
                };
                let balls: Vec<MovingBall<f64>> = range.map(ball).collect();
                let options = batch_options(balls.len(), false);
                let contacts = batch::map(&balls, &options, |ball| ball.start, |ball| ball.first_contact(&index));
                contacts.iter().enumerate().for_each(|(i, contact)| columns.set(i, contact.as_ref()));
            });
            Ok::<(), BadPath>(())
        };
        self.run(py, starts.len(), threads, progress, work)
    }
}
