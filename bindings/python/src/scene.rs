//! Scenes as Python objects.

use crate::arrays::{Coordinates, motions, rows, triples};
use crate::errors::{io_error, read_error, value_error};
use crate::work::run_owned;
use nalgebra::Point3;
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyUntypedArrayMethods};
use p2m_core::pair::Motion;
use p2m_core::{Aabb, Element, PrimitiveSet, Soup};
use p2m_mixed::engine::OutputFile;
use p2m_mixed::{Format, PointColumns, WriteError, write_scene};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::path::PathBuf;
use std::sync::Arc;

/// A scene that several Python objects and indexes share.
pub(crate) type SharedScene = Arc<p2m_mixed::Scene>;

/// The coordinates and indices of a scene, before they are checked.
struct Parts {
    positions: Vec<Point3<f64>>,
    triangles: Vec<[u32; 3]>,
    segments: Vec<[u32; 2]>,
    points: Vec<u32>,
}

impl Parts {
    /// Makes a scene whose primitives are numbered from 0: first all triangles, then all segments, then all points.
    fn soup(self) -> Result<Soup<f64>, p2m_core::BuildError> {
        let Self { positions, triangles, segments, points } = self;
        if segments.is_empty() && points.is_empty() {
            return Soup::from_triangles(positions, triangles);
        }
        let triangles = triangles.into_iter().map(Element::Triangle);
        let segments = segments.into_iter().map(Element::Segment);
        Soup::new(positions, triangles.chain(segments).chain(points.into_iter().map(Element::Point)))
    }
}

/// A scene, see `p2m.Scene`.
#[pyclass(frozen, module = "p2m._p2m", from_py_object)]
#[derive(Clone)]
pub(crate) struct Scene {
    pub(crate) shared: SharedScene,
}

impl Scene {
    pub(crate) fn new(scene: p2m_mixed::Scene) -> Self {
        Self { shared: Arc::new(scene) }
    }
}

#[pymethods]
impl Scene {
    #[new]
    fn from_arrays(
        py: Python<'_>,
        vertices: Coordinates<'_>,
        triangles: PyReadonlyArray1<'_, u32>,
        segments: PyReadonlyArray1<'_, u32>,
        points: PyReadonlyArray1<'_, u32>,
    ) -> PyResult<Self> {
        let contiguous = |_| PyTypeError::new_err("an array of indices is not contiguous");
        let (segments, rest) = segments.as_slice().map_err(contiguous)?.as_chunks();
        if !rest.is_empty() {
            return Err(value_error("segments have two indices each"));
        }
        let parts = Parts {
            positions: vertices.points()?,
            triangles: triples(triangles.as_slice())?.to_vec(),
            segments: segments.to_vec(),
            points: points.as_slice().map_err(contiguous)?.to_vec(),
        };
        let scene = py.detach(|| parts.soup().map(p2m_mixed::Scene::from)).map_err(value_error)?;
        Ok(Self::new(scene))
    }

    /// Reads a file.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let file = path.clone();
        let scene =
            run_owned(py, (crate::threads::default_threads(), None), 1, move |_| p2m_formats::read_scene(&file))?;
        scene.map(Self::new).map_err(|error| read_error(&error, &path))
    }

    /// Writes the scene to a file in the format of its extension.
    fn write(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let format = Format::from_path(&path).map_err(value_error)?;
        let (scene, file) = (Arc::clone(&self.shared), path.clone());
        let written = run_owned(py, (1, None), 1, move |_| -> Result<(), WriteError> {
            let mut out = OutputFile::create(&file)?;
            write_scene(&scene, format, &mut out)?;
            Ok(out.finish()?)
        })?;
        written.map_err(|error| match error {
            WriteError::Io(error) => io_error(&error, &path),
            _ => value_error(format!("{}: {error}", path.display())),
        })
    }

    /// Makes a scene from named parts, which become objects.
    #[staticmethod]
    fn joined(parts: Vec<(String, Self)>) -> PyResult<Self> {
        let mut whole = p2m_mixed::Scene::default();
        for (name, part) in parts {
            whole.add(&name, &part.shared.soup).map_err(value_error)?;
        }
        Ok(Self::new(whole))
    }

    /// Returns a copy of the scene in which the source of each triangle is the number of its polygon.
    fn with_sources(&self, triangles: PyReadonlyArray1<'_, u32>) -> PyResult<Self> {
        let mut scene = (*self.shared).clone();
        let numbers = triangles.as_slice()?;
        if numbers.len() != scene.soup.triangles().len() {
            return Err(value_error("there is not one number for each triangle"));
        }
        let elements = scene.soup.elements().zip(&mut scene.sources);
        let of_triangles = elements.filter(|(element, _)| matches!(element, Element::Triangle(_)));
        of_triangles.zip(numbers).for_each(|((_, source), number)| *source = *number);
        Ok(Self::new(scene))
    }

    /// Loads a scene from the bytes of `to_bytes`.
    #[staticmethod]
    fn from_bytes(py: Python<'_>, bytes: &[u8]) -> PyResult<Self> {
        let scene = py.detach(|| p2m_mixed::read_p2m(bytes, "the pickled scene"));
        scene.map(Self::new).map_err(|error| value_error(&error))
    }

    /// Returns the scene in the format of saved indexes.
    fn to_bytes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let mut bytes = Vec::new();
        py.detach(|| p2m_mixed::write_p2m(&self.shared, &mut bytes)).map_err(value_error)?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// Returns a scene with the same primitives and names over other positions.
    fn moved(&self, py: Python<'_>, vertices: Coordinates<'_>) -> PyResult<Self> {
        let positions = vertices.points()?;
        let moved = py.detach(|| {
            let mut scene = (*self.shared).clone();
            Arc::make_mut(&mut scene.soup).set_positions(positions).map(|()| scene)
        });
        moved.map(Self::new).map_err(value_error)
    }

    /// Returns the scene after a motion, given as a flat matrix of 4 x 4 numbers. Coordinates are rounded.
    fn transformed(&self, py: Python<'_>, transform: PyReadonlyArray1<'_, f64>) -> PyResult<Self> {
        let motions = motions(&transform)?;
        let moved = py.detach(|| {
            let mut scene = (*self.shared).clone();
            let soup = Arc::make_mut(&mut scene.soup);
            for motion in motions.iter().map(Motion::new) {
                soup.map_positions(|position| motion.apply(position.coords.into()).into())?;
            }
            Ok::<_, p2m_core::BuildError>(scene)
        });
        moved.map(Self::new).map_err(value_error)
    }

    /// Returns the number of vertices, triangles, segments and points.
    fn counts(&self) -> (usize, usize, usize, usize) {
        let soup = &self.shared.soup;
        (soup.positions().len(), soup.triangles().len(), soup.segments().len(), soup.points().len())
    }

    /// Returns the corners of the box around all primitives, or `None` for an empty scene.
    fn bounds(&self, py: Python<'_>) -> Option<[[f64; 3]; 2]> {
        let soup = &self.shared.soup;
        let Aabb { min, max } = py.detach(|| soup.aabb());
        (soup.len() > 0).then(|| [min.coords.into(), max.coords.into()])
    }

    fn vertices<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let positions = self.shared.soup.positions();
        PyArray1::from_slice(py, bytemuck::cast_slice(positions)).reshape([positions.len(), 3])
    }

    fn triangles<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<i64>>> {
        index_rows(py, self.shared.soup.triangles())
    }

    fn segments<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<i64>>> {
        index_rows(py, self.shared.soup.segments())
    }

    fn points<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        PyArray1::from_iter(py, self.shared.soup.points().iter().map(|&i| i64::from(i)))
    }

    /// Returns the ids of the primitives with this number of vertices.
    fn ids<'py>(&self, py: Python<'py>, vertices: usize) -> Bound<'py, PyArray1<i64>> {
        let elements = self.shared.soup.elements().enumerate();
        let ids = elements.filter(|(_, element)| element.indices().len() == vertices);
        PyArray1::from_iter(py, ids.map(|(id, _)| i64::try_from(id).unwrap_or(-1)))
    }

    /// Returns the source of each primitive: the number of its statement in the file.
    fn sources<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        PyArray1::from_iter(py, self.shared.sources.iter().map(|&source| i64::from(source)))
    }

    /// Returns the objects: the name, the first id, and the id after the last one.
    fn objects(&self) -> Vec<(String, usize, usize)> {
        self.shared.objects.iter().map(|object| (object.name.clone(), object.ids.start, object.ids.end)).collect()
    }

    /// Returns the unit of the coordinates, if the file states it.
    fn unit(&self) -> Option<String> {
        self.shared.unit.map(|unit| unit.to_string())
    }

    /// Returns descriptions of the records that the reader left out.
    fn skipped(&self) -> Vec<String> {
        self.shared.skipped.iter().map(ToString::to_string).collect()
    }
}

/// The points of a file, their ids, and the unit.
type ReadPoints<'py> = (Bound<'py, PyArray2<f64>>, Option<Vec<String>>, Option<String>);

/// Reads the points of a file, with their ids.
#[pyfunction]
pub(crate) fn read_points(
    py: Python<'_>,
    path: PathBuf,
    coordinates: Vec<String>,
    id: Option<String>,
) -> PyResult<ReadPoints<'_>> {
    let (file, columns) = (path.clone(), PointColumns { coordinates, id });
    let table = run_owned(py, (1, None), 1, move |_| p2m_formats::read_points(&file, &columns))?;
    let table = table.map_err(|error| read_error(&error, &path))?;
    let ids = table.ids.map(|ids| (0..ids.len()).filter_map(|point| ids.get(point).map(str::to_owned)).collect());
    Ok((rows(py, table.points)?, ids, table.unit.map(|unit| unit.to_string())))
}

/// Returns indices as the rows of an array.
fn index_rows<'py, const N: usize>(py: Python<'py>, rows: &[[u32; N]]) -> PyResult<Bound<'py, PyArray2<i64>>> {
    let flat = PyArray1::from_iter(py, rows.as_flattened().iter().map(|&i| i64::from(i)));
    debug_assert_eq!(flat.len(), N * rows.len());
    flat.reshape([rows.len(), N])
}
