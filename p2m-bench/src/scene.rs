//! Scenes from files, in both scalars.

use crate::memory;
use anyhow::{Result, bail};
use nalgebra::Point3;
use p2m_core::{Aabb, Primitive, PrimitiveId, PrimitiveSet, Real, Soup};
use std::path::Path;

/// A scene and what the harness has to know about it.
pub(crate) struct Scene {
    /// The name of its file.
    pub(crate) name: String,
    /// As it was read.
    pub(crate) double: Soup<f64>,
    /// Rounded to f32; `None` if that overflows.
    pub(crate) single: Option<Soup<f32>>,
    /// The box around all primitives.
    pub(crate) bounds: Aabb<f64>,
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
        let bounds = (0..soup.len())
            .map(|i| soup.get(PrimitiveId::new(i)).aabb())
            .fold(Aabb::empty(), |all: Aabb<f64>, b| all.union(&b));
        if !bounds.is_finite() {
            bail!("{name} has no primitives");
        }
        let (double, double_bytes) = trimmed(&soup);
        let single = to_single(&soup).as_ref().map(trimmed);
        let single_bytes = single.as_ref().map_or(0, |(_, bytes)| *bytes);
        let single = single.map(|(soup, _)| soup);
        Ok(Self { name, double, single, bounds, double_bytes, single_bytes })
    }

    /// The diagonal of the box, 1 for a scene that is one point: the unit of offsets and differences.
    pub(crate) fn diagonal(&self) -> f64 {
        let diagonal = (self.bounds.max - self.bounds.min).norm();
        if diagonal > 0.0 { diagonal } else { 1.0 }
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

fn to_single(soup: &Soup<f64>) -> Option<Soup<f32>> {
    let positions = soup.positions().iter().map(single_point).collect();
    Soup::new(positions, soup.elements()).ok()
}

/// The soup without spare capacity, and its heap bytes.
fn trimmed<T: Real>(soup: &Soup<T>) -> (Soup<T>, usize) {
    memory::measured(|| soup.clone())
}
