//! Scenes from files, in both scalars.

use crate::memory;
use anyhow::{Result, bail};
use nalgebra::Point3;
use p2m_core::{PrimitiveSet, Real, Soup};
use p2m_testkit::queries::diagonal;
use p2m_testkit::scenes::narrow;
use std::path::Path;

/// A scene and what the harness has to know about it.
pub(crate) struct Scene {
    /// The name of its file.
    pub(crate) name: String,
    /// As it was read.
    pub(crate) double: Soup<f64>,
    /// Rounded to f32; `None` if that overflows.
    pub(crate) single: Option<Soup<f32>>,
    /// Heap bytes of `double`, trimmed: what an index that borrows the scene depends on.
    pub(crate) double_bytes: usize,
    /// Heap bytes of `single`, trimmed.
    pub(crate) single_bytes: usize,
}

impl Scene {
    /// Reads a scene; an empty one is an error, since there is nothing to measure.
    pub(crate) fn read(path: &Path) -> Result<Self> {
        let soup = p2m_mixed::read_scene(path)?.soup;
        let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
        Self::new(name, soup)
    }

    /// A scene of that name.
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

    /// The unit of differences.
    pub(crate) fn diagonal(&self) -> f64 {
        diagonal(&self.double)
    }

    /// How many primitives it has.
    pub(crate) fn len(&self) -> usize {
        self.double.len()
    }

    /// Its name and size in words.
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

/// The point in f32, to nearest.
pub(crate) fn single_point(p: &Point3<f64>) -> Point3<f32> {
    Point3::new(f32::of_f64(p.x), f32::of_f64(p.y), f32::of_f64(p.z))
}

/// The soup without spare capacity, and its heap bytes.
fn trimmed<T: Real>(soup: &Soup<T>) -> (Soup<T>, usize) {
    memory::measured(|| soup.clone())
}
