//! Statistics, pages and files of deviations.

use crate::errors::value_error;
use crate::scene::Scene;
use numpy::PyReadonlyArray1;
use p2m_field::deviation::DeviationStatistics;
use p2m_mixed::{VertexValues, write_ply_with_values};
use p2m_page::{Deviations, UpAxis, View, diverging_colour};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

/// Returns the statistics of deviations by their names, with the numbers of values that are finite and that are not.
#[pyfunction]
pub(crate) fn deviation_statistics<'py>(
    py: Python<'py>,
    values: PyReadonlyArray1<'py, f64>,
) -> PyResult<Bound<'py, PyDict>> {
    let values = values.as_slice()?;
    let statistics = py.detach(|| DeviationStatistics::of(values));
    let dictionary = PyDict::new(py);
    dictionary.set_item("count", statistics.count)?;
    dictionary.set_item("missing", statistics.missing)?;
    for named in statistics.named() {
        dictionary.set_item(named.key, named.value)?;
    }
    Ok(dictionary)
}

/// Returns a page that shows a scan with its deviations from a scene, as HTML. `texts` has the title, the
/// summary and the unit.
#[pyfunction]
pub(crate) fn deviation_page(
    scan: &Scene,
    values: PyReadonlyArray1<'_, f64>,
    primitives: PyReadonlyArray1<'_, u32>,
    scene: &Scene,
    is_signed: bool,
    limit: f64,
    tolerance: Option<f64>,
    is_y_up: bool,
    texts: [String; 3],
) -> PyResult<String> {
    let (values, primitives) = (values.as_slice()?, primitives.as_slice()?);
    let (scan, [title, summary, unit]) = (&*scan.shared.soup, texts);
    let statistics = &DeviationStatistics::of(values);
    let deviations = &Deviations { scan, values, primitives, statistics, is_signed, limit, tolerance };
    let mut view = View::new(&scene.shared, &Deviations::bounds(scan))
        .with_unit(&unit)
        .with_up(if is_y_up { UpAxis::Y } else { UpAxis::Z })
        .with_deviations(deviations);
    (view.title, view.summary) = (title, summary);
    view.about = format!("p2m {} for Python", env!("CARGO_PKG_VERSION"));
    view.html().map_err(value_error)
}

/// Returns a scan with its deviations and their colours as a PLY file.
#[pyfunction]
pub(crate) fn deviation_ply<'py>(
    py: Python<'py>,
    scan: &Scene,
    values: PyReadonlyArray1<'_, f64>,
    limit: f64,
) -> PyResult<Bound<'py, PyBytes>> {
    let values = values.as_slice()?;
    let colours: Vec<[u8; 3]> = values.iter().map(|value| diverging_colour(*value, limit)).collect();
    let mut file = Vec::new();
    let values = VertexValues { name: "deviation", values, colours: &colours };
    write_ply_with_values(&scan.shared, &values, &mut file).map_err(value_error)?;
    Ok(PyBytes::new(py, &file))
}
