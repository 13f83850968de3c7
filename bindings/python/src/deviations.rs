//! Statistics, filters, pages and files of deviations.

use crate::arrays::{Coordinates, triples, with_positions};
use crate::errors::value_error;
use crate::index::Index;
use crate::scene::Scene;
use crate::work::run_owned;
use nalgebra::Point3;
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use p2m_core::batch::BatchOptions;
use p2m_core::{Position, QueryOptions};
use p2m_field::deviation::{self, DeviationStatistics, LocalPlanes};
use p2m_mixed::{VertexValues, write_ply_with_values};
use p2m_page::{Deviations, ObjectDeviations, Sheet, UpAxis, View, diverging_colour};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use std::sync::Arc;

/// Returns the statistics of deviations by their names, with the numbers of values that are finite and that are not.
#[pyfunction]
pub(crate) fn deviation_statistics<'py>(
    py: Python<'py>,
    values: PyReadonlyArray1<'py, f64>,
) -> PyResult<Bound<'py, PyDict>> {
    let values = values.as_slice()?;
    dictionary(py, &py.detach(|| DeviationStatistics::of(values)))
}

fn dictionary<'py>(py: Python<'py>, statistics: &DeviationStatistics) -> PyResult<Bound<'py, PyDict>> {
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

/// Returns the name of each object of a scene, with the statistics of the deviations from it.
#[pyfunction]
pub(crate) fn deviation_objects<'py>(
    py: Python<'py>,
    scene: &Scene,
    values: PyReadonlyArray1<'_, f64>,
    primitives: PyReadonlyArray1<'_, u32>,
) -> PyResult<Vec<(String, Bound<'py, PyDict>)>> {
    let (values, primitives) = (values.as_slice()?, primitives.as_slice()?);
    let statistics = &DeviationStatistics::of(values);
    let scan = &scene.shared.soup;
    let deviations = Deviations { scan, values, primitives, statistics, is_signed: true, limit: 1.0, tolerance: None };
    let found = ObjectDeviations::of_scene(&scene.shared, &deviations);
    found.into_iter().map(|object| Ok((object.name, dictionary(py, &object.statistics)?))).collect()
}

/// Returns the report of a scan and a scene on one sheet, as a PDF or a PNG file. `texts` has the title, the unit and
/// what made the report.
#[pyfunction]
pub(crate) fn deviation_sheet<'py>(
    py: Python<'py>,
    scan: &Scene,
    values: PyReadonlyArray1<'_, f64>,
    primitives: PyReadonlyArray1<'_, u32>,
    scene: &Scene,
    is_signed: bool,
    limit: f64,
    tolerance: Option<f64>,
    required: Option<f64>,
    is_y_up: bool,
    head: Vec<(String, String)>,
    texts: [String; 3],
    is_pdf: bool,
) -> PyResult<Bound<'py, PyBytes>> {
    let (values, primitives) = (values.as_slice()?, primitives.as_slice()?);
    let [title, unit, about] = &texts;
    let sheet = Sheet {
        title,
        head: &head,
        required,
        unit,
        up: if is_y_up { UpAxis::Y } else { UpAxis::Z },
        scene: &scene.shared,
        deviations: Deviations {
            scan: &scan.shared.soup,
            values,
            primitives,
            statistics: &DeviationStatistics::of(values),
            is_signed,
            limit,
            tolerance,
        },
        about,
    };
    let file = py.detach(|| if is_pdf { Ok(sheet.pdf()) } else { sheet.png() });
    Ok(PyBytes::new(py, &file.map_err(value_error)?))
}

/// Returns the mean deviation around each vertex of a scene, given the closest primitive of each deviation and the
/// weights of its vertices.
#[pyfunction]
pub(crate) fn deviation_on_vertices<'py>(
    py: Python<'py>,
    scene: &Scene,
    primitives: PyReadonlyArray1<'_, u32>,
    barycentric: PyReadonlyArray1<'_, f64>,
    values: PyReadonlyArray1<'_, f64>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let (primitives, values) = (primitives.as_slice()?, values.as_slice()?);
    let barycentric = triples(barycentric.as_slice())?;
    let found = py.detach(|| deviation::on_vertices(&scene.shared.soup, primitives, barycentric, values));
    Ok(found.into_pyarray(py))
}

/// Tells which points of a scan are isolated.
#[pyfunction]
pub(crate) fn isolated_points<'py>(
    py: Python<'py>,
    points: Coordinates<'py>,
    threads: usize,
) -> PyResult<Bound<'py, PyArray1<bool>>> {
    let points: Vec<Point3<f64>> = with_positions!(points, slice => slice.iter().map(Position::<f64>::point).collect());
    Ok(run_owned(py, threads, 1, None, move |_| deviation::isolated_points(&points))?.into_pyarray(py))
}

#[pymethods]
impl Index {
    /// Returns the deviations of points from the local planes of a cloud, with NaN beyond a distance; None for a scene
    /// that is no cloud.
    fn deviations_from_planes<'py>(
        &self,
        py: Python<'py>,
        points: Coordinates<'py>,
        max_distance: f64,
        threads: usize,
    ) -> PyResult<Option<Bound<'py, PyArray1<f64>>>> {
        let points: Vec<Point3<f64>> =
            with_positions!(points, slice => slice.iter().map(Position::<f64>::point).collect());
        let (index, soup) = (self.any(), Arc::clone(&self.scene.soup));
        let found = run_owned(py, threads, 1, None, move |_| {
            let planes = LocalPlanes::new(&soup, &*index)?;
            let options = QueryOptions::default().with_max_distance(max_distance);
            Some(planes.deviations(&*index, &points, &options, &BatchOptions::default()))
        })?;
        Ok(found.map(|found| found.into_pyarray(py)))
    }
}
