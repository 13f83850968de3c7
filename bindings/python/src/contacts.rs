//! First contacts of balls that move along segments.

use crate::arrays::triples;
use crate::columns::{NO_FEATURE, NO_PRIMITIVE, columns};
use crate::index::Index;
use crate::parts::{answer_in_parts, batch_options, check_finite};
use crate::work::{Monitor, Run, Threads};
use numpy::PyReadonlyArray1;
use p2m_core::batch;
use p2m_core::pair::{BallContact, MovingBall};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

columns! { ContactArrays, ContactColumns, BallContact<f64>, {
    parameter: f64 = f64::INFINITY, |contact| contact.parameter;
    upper_parameter: f64 = f64::INFINITY, |contact| contact.upper_parameter;
    distance_bound: f64 = f64::INFINITY, |contact| contact.distance_bound;
    primitive: i64 = NO_PRIMITIVE, |contact| i64::from(contact.primitive.number());
    point: [f64; 3] = [f64::NAN; 3], |contact| contact.point.coords.into();
    feature: u8 = NO_FEATURE, |contact| contact.feature.code();
}}

#[pymethods]
impl Index {
    /// Finds the first contacts of balls of one radius, and writes them into the arrays of `out`.
    fn first_contact(
        &self,
        py: Python<'_>,
        starts: PyReadonlyArray1<'_, f64>,
        ends: PyReadonlyArray1<'_, f64>,
        out: &Bound<'_, PyDict>,
        radius: f64,
        tolerance: f64,
        ignore_opening: bool,
        run: Run,
    ) -> PyResult<()> {
        let index = self.pair_query()?;
        let (starts, ends) = (triples(starts.as_slice())?, triples(ends.as_slice())?);
        if starts.len() != ends.len() {
            return Err(PyTypeError::new_err("the numbers of starts and ends differ"));
        }
        let mut arrays = ContactArrays::borrow(out)?;
        let columns = arrays.columns(starts.len())?;
        let work = |threads: &Threads, monitor: &Monitor| {
            check_finite("starts", starts, 1)?;
            check_finite("ends", ends, 1)?;
            answer_in_parts(starts.len(), columns, threads, monitor, &|range, mut columns: ContactColumns<'_>| {
                let ball = |row: usize| {
                    let ball = MovingBall::new(starts[row].into(), ends[row].into(), radius).with_tolerance(tolerance);
                    if ignore_opening { ball.ignoring_opening() } else { ball }
                };
                let balls: Vec<MovingBall<f64>> = range.map(ball).collect();
                let options = batch_options(balls.len(), false);
                let contacts = batch::map(&balls, &options, |ball| ball.start, |ball| ball.first_contact(&index));
                columns.set_all(contacts.iter().map(Option::as_ref));
            });
            Ok(())
        };
        self.run(py, starts.len(), run, work)
    }
}
