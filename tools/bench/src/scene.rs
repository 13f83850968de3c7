//! Scenes from files, in both scalars.

use crate::memory;
use anyhow::{Result, bail};
use p2m_core::{PrimitiveSet, Real, Soup};
use p2m_testkit::queries::diagonal;
use p2m_testkit::scenes::narrow;
use std::path::Path;
use std::sync::Arc;

/// A scene with the data that the harness needs.
pub(crate) struct Scene {
    /// The name of the file.
    pub(crate) name: String,
    /// The scene in f64, as it was read.
    pub(crate) double: Arc<Soup<f64>>,
    /// The scene rounded to f32; `None` if that overflows.
    pub(crate) single: Option<Arc<Soup<f32>>>,
    /// Heap bytes of `double` without spare capacity. They count as memory of an index that borrows the scene.
    pub(crate) double_bytes: usize,
    /// Heap bytes of `single` without spare capacity.
    pub(crate) single_bytes: usize,
}

impl Scene {
    /// Reads a scene; an empty one is an error, because there is nothing to measure.
    pub(crate) fn read(path: &Path) -> Result<Self> {
        let soup = Arc::unwrap_or_clone(p2m_mixed::read_scene(path)?.soup);
        let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
        Self::new(name, soup)
    }

    /// Makes a scene with a name.
    pub(crate) fn new(name: String, soup: Soup<f64>) -> Result<Self> {
        if soup.is_empty() {
            bail!("{name} has no primitives");
        }
        let (double, double_bytes) = trimmed(&soup);
        let single = narrow(&soup).as_ref().map(trimmed);
        let single_bytes = single.as_ref().map_or(0, |(_, bytes)| *bytes);
        let single = single.map(|(soup, _)| soup);
        Ok(Self { name, double, single, double_bytes, single_bytes })
    }

    /// Returns the diagonal of the bounding box, to which differences are relative.
    pub(crate) fn diagonal(&self) -> f64 {
        diagonal(&self.double)
    }

    /// Returns the number of primitives.
    pub(crate) fn len(&self) -> usize {
        self.double.len()
    }

    /// Returns the name and the size in words.
    pub(crate) fn describe(&self) -> String {
        let soup = &self.double;
        format!(
            "{}: {} triangles, {} segments, {} points",
            self.name,
            soup.triangles().len(),
            soup.segments().len(),
            soup.points().len()
        )
    }
}

/// Returns the soup without spare capacity, and its heap bytes.
fn trimmed<T: Real>(soup: &Soup<T>) -> (Arc<Soup<T>>, usize) {
    let (soup, bytes) = memory::measured(|| soup.clone());
    (Arc::new(soup), bytes)
}
