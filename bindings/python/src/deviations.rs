//! Deviations: statistics, filters, pages and files.

use crate::arrays::{Coordinates, triples};
use crate::errors::value_error;
use crate::index::Index;
use crate::pages::{ABOUT, page, up_axis};
use crate::scene::{Scene, SharedScene};
use crate::work::run_owned;
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use p2m_core::QueryOptions;
use p2m_core::batch::BatchOptions;
use p2m_field::deviation::{self, DeviationStatistics, LocalPlanes};
use p2m_mixed::{VertexValues, write_ply_with_values};
use p2m_page::{Deviations, ObjectDeviations, Sheet, View, diverging_colour};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use std::sync::Arc;

/// Returns the statistics of deviations by name, including the numbers of finite and other values, and the default
/// limit of the colour scale.
#[pyfunction]
pub(crate) fn deviation_statistics<'py>(
    py: Python<'py>,
    values: PyReadonlyArray1<'py, f64>,
    tolerance: Option<f64>,
) -> PyResult<(Bound<'py, PyDict>, f64)> {
    let values = values.as_slice()?;
    let statistics = py.detach(|| DeviationStatistics::of(values));
    Ok((dictionary(py, &statistics)?, Deviations::usual_limit(&statistics, tolerance)))
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

/// Returns a scan as a PLY file, with its deviations and their colours.
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

/// The deviations of a scan from a scene, with everything that a report shows.
#[pyclass(frozen, module = "p2m._p2m")]
pub(crate) struct Report {
    scan: SharedScene,
    values: Vec<f64>,
    primitives: Vec<u32>,
    scene: SharedScene,
    statistics: DeviationStatistics,
    is_signed: bool,
    limit: f64,
    tolerance: Option<f64>,
    unit: String,
}

impl Report {
    fn deviations(&self) -> Deviations<'_> {
        let Self { values, primitives, statistics, is_signed, limit, tolerance, .. } = self;
        let (is_signed, limit, tolerance) = (*is_signed, *limit, *tolerance);
        Deviations { scan: &self.scan.soup, values, primitives, statistics, is_signed, limit, tolerance }
    }
}

#[pymethods]
impl Report {
    #[new]
    fn new(
        scan: &Scene,
        values: PyReadonlyArray1<'_, f64>,
        primitives: PyReadonlyArray1<'_, u32>,
        scene: &Scene,
        is_signed: bool,
        limit: f64,
        tolerance: Option<f64>,
        unit: String,
    ) -> PyResult<Self> {
        let (scan, scene) = (scan.shared.clone(), scene.shared.clone());
        let (values, primitives) = (values.as_slice()?.to_vec(), primitives.as_slice()?.to_vec());
        let statistics = DeviationStatistics::of(&values);
        Ok(Self { scan, values, primitives, scene, statistics, is_signed, limit, tolerance, unit })
    }

    /// Returns the name of each object of the scene with the statistics of the deviations from the object.
    fn objects<'py>(&self, py: Python<'py>) -> PyResult<Vec<(String, Bound<'py, PyDict>)>> {
        let found = ObjectDeviations::of_scene(&self.scene, &self.deviations());
        found.into_iter().map(|object| Ok((object.name, dictionary(py, &object.statistics)?))).collect()
    }

    /// Returns a page that shows the scan and the scene, as HTML.
    fn page(&self, title: String, summary: String, is_y_up: bool) -> PyResult<String> {
        let deviations = self.deviations();
        let view = View::new(&self.scene, &Deviations::bounds(&self.scan.soup)).with_deviations(&deviations);
        page(view, (title, summary, &self.unit), is_y_up)
    }

    /// Returns the report on one sheet, as a PDF or PNG file.
    fn sheet<'py>(
        &self,
        py: Python<'py>,
        title: &str,
        head: Vec<(String, String)>,
        required: Option<f64>,
        is_y_up: bool,
        is_pdf: bool,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let sheet = Sheet {
            title,
            head: &head,
            required,
            unit: &self.unit,
            up: up_axis(is_y_up),
            scene: &self.scene,
            deviations: self.deviations(),
            about: ABOUT,
        };
        let file = py.detach(|| if is_pdf { Ok(sheet.pdf()) } else { sheet.png() });
        Ok(PyBytes::new(py, &file.map_err(value_error)?))
    }
}

/// Returns the mean deviation around each vertex of a scene. Each deviation has its closest primitive and the weights
/// of the vertices of that primitive.
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

/// Returns which points of a scan are isolated.
#[pyfunction]
pub(crate) fn isolated_points<'py>(
    py: Python<'py>,
    points: Coordinates<'py>,
    threads: usize,
) -> PyResult<Bound<'py, PyArray1<bool>>> {
    let points = points.points()?;
    Ok(run_owned(py, (threads, None), 1, move |_| deviation::isolated_points(&points))?.into_pyarray(py))
}

#[pymethods]
impl Index {
    /// Returns the deviations of points from the local planes of a cloud, NaN beyond a distance; `None` if the scene is
    /// not a cloud.
    fn deviations_from_planes<'py>(
        &self,
        py: Python<'py>,
        points: Coordinates<'py>,
        max_distance: f64,
        threads: usize,
    ) -> PyResult<Option<Bound<'py, PyArray1<f64>>>> {
        let points = points.points()?;
        let (index, soup) = (self.any(), Arc::clone(&self.scene.soup));
        let found = run_owned(py, (threads, None), 1, move |_| {
            let planes = LocalPlanes::new(&soup, &*index)?;
            let options = QueryOptions::default().with_max_distance(max_distance);
            Some(planes.deviations(&*index, &points, &options, &BatchOptions::default()))
        })?;
        Ok(found.map(|found| found.into_pyarray(py)))
    }
}
