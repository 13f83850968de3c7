//! Saving and loading indexes.

use crate::errors::{io_error, load_error, value_error};
use crate::index::{Index, Origin, backend, build};
use crate::scene::SharedScene;
use crate::work::{Monitor, run_owned};
use p2m_backends::{BackendEntry, BuildSettings, BuiltIndex};
use p2m_core::storage::{self, LoadError, SavedFile, Writer};
use p2m_mixed::engine::OutputFile;
use p2m_mixed::{load_scene, save_scene};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Maps the file at a path into memory.
#[allow(unsafe_code, reason = "the user asked for it and was told what it needs")]
fn map(path: &Path) -> Result<SavedFile, LoadError> {
    // SAFETY: the documentation of `p2m.load` says that with `map=True` nobody may change the file.
    unsafe { SavedFile::map(path) }
}

/// A scene and its index from a saved file.
type Loaded = (SharedScene, Option<(&'static BackendEntry, BuiltIndex)>);

/// Loads the scene of a file, and its index if it has one.
fn load_file(file: &SavedFile) -> Result<Loaded, LoadError> {
    let reader = file.checked()?;
    let scene = Arc::new(load_scene(reader)?);
    let Some(backend) = BackendEntry::from_saved(reader) else {
        return match storage::kind(reader) {
            // The file has an index of an unknown kind.
            Ok(found) => Err(LoadError::OtherKind { found, expected: "one of p2m.backends()".to_owned() }),
            Err(_) => Ok((scene, None)),
        };
    };
    let built = backend.load(Arc::clone(&scene.soup), reader)?;
    Ok((scene, Some((backend, built))))
}

/// Loads an index from the file at a path.
#[pyfunction]
pub(crate) fn load(py: Python<'_>, path: PathBuf, map: bool, threads: usize) -> PyResult<Index> {
    let name = path.display().to_string();
    let file = path.clone();
    let loaded = run_owned(py, (threads, None), 1, move |_| {
        let saved = if map { self::map(&file) } else { SavedFile::open(&file) }?;
        let loaded = load_file(&saved)?;
        Ok::<_, LoadError>((loaded, format!("{:016x}", saved.checksum())))
    })?;
    let ((scene, index), checksum) = loaded.map_err(|error| load_error(&error, &name))?;
    let Some((backend, built)) = index else {
        return Err(PyValueError::new_err(format!("{name} has a scene but no index: read it with p2m.read")));
    };
    Ok(Index::new(scene, built, backend, Some(Origin { path, checksum, is_mapped: map })))
}

/// Loads an index from the bytes of `Index.to_bytes`. If the backend has no saved form, the index is built.
#[pyfunction]
pub(crate) fn load_bytes(py: Python<'_>, bytes: &[u8], backend: &str, threads: usize) -> PyResult<Index> {
    let name = "the pickled index";
    let loaded = py.detach(|| SavedFile::read_with_length(bytes, bytes.len() as u64).and_then(|file| load_file(&file)));
    let (scene, index) = loaded.map_err(|error| load_error(&error, name))?;
    if let Some((backend, built)) = index {
        return Ok(Index::new(scene, built, backend, None));
    }
    let entry = self::backend(backend)?;
    let soup = Arc::clone(&scene.soup);
    let work =
        move |monitor: &Monitor| build(BuildSettings::default(), monitor, |settings| entry.build(soup, settings));
    let built = run_owned(py, (threads, None), 1, work)?;
    Ok(Index::new(scene, built.map_err(value_error)?, entry, None))
}

/// Writes a scene and its index.
fn write(scene: &SharedScene, built: &BuiltIndex, out: impl Write) -> io::Result<()> {
    let mut writer = Writer::default();
    save_scene(scene, &mut writer);
    built.save(&mut writer);
    writer.write(out)
}

/// Writes a file, which appears under its name when it is complete, unless the work was cancelled.
fn write_file(path: &Path, monitor: &Monitor, write: impl FnOnce(&mut OutputFile) -> io::Result<()>) -> io::Result<()> {
    let mut file = OutputFile::create(path)?;
    write(&mut file)?;
    if monitor.is_cancelled() { Ok(()) } else { file.finish() }
}

/// Writes bytes to a file, which appears under its name when it is complete.
#[pyfunction]
pub(crate) fn write_bytes(py: Python<'_>, path: PathBuf, bytes: Vec<u8>) -> PyResult<()> {
    let file = path.clone();
    let saved = run_owned(py, (1, None), 1, move |monitor| write_file(&file, monitor, |out| out.write_all(&bytes)))?;
    saved.map_err(|error| io_error(&error, &path))
}

#[pymethods]
impl Index {
    /// Saves the index with its scene.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        if !self.backend.is_saveable() {
            return Err(value_error(format!("the backend '{}' has no saved form", self.backend.name)));
        }
        let (scene, built, file) = (self.scene.clone(), self.built.clone(), path.clone());
        let saved =
            run_owned(py, (1, None), 1, move |monitor| write_file(&file, monitor, |out| write(&scene, &built, out)))?;
        saved.map_err(|error| io_error(&error, &path))
    }

    /// Returns the index with its scene in the format of saved files. If the backend has no saved form, only the scene
    /// is saved.
    fn to_bytes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let mut bytes = Vec::new();
        py.detach(|| write(&self.scene, &self.built, &mut bytes)).map_err(value_error)?;
        Ok(PyBytes::new(py, &bytes))
    }
}
