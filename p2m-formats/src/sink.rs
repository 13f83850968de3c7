//! The builder of scenes for the readers of this crate.

use nalgebra::{Matrix4, Point3};
use p2m_core::Element;
use p2m_mixed::engine::SceneBuilder;
use p2m_mixed::{Reason, Scene};

/// The most bytes of a scene, or of decompressed data, for each byte of its file.
pub(crate) const MAX_RATIO: usize = 1000;
/// The number of bytes to which any file may expand, however short it is.
const MIN_BYTES: usize = 1 << 26;

/// Returns the largest number of bytes that a file of this length may expand to.
pub(crate) fn expanded_limit(file_len: usize) -> usize {
    file_len.saturating_mul(MAX_RATIO).max(MIN_BYTES)
}

/// Collects vertices and primitives, and numbers the primitives by kind.
pub(crate) struct Sink {
    pub(crate) builder: SceneBuilder<'static>,
    next: [usize; 3],
    /// The number of bytes that further vertices and primitives may take.
    bytes_left: usize,
    /// The number of points that the file marks as invalid.
    pub(crate) invalid: u64,
}

impl Sink {
    /// Makes a sink for a file of this length.
    pub(crate) fn new(file_len: usize) -> Self {
        Self { builder: SceneBuilder::default(), next: [0; 3], bytes_left: expanded_limit(file_len), invalid: 0 }
    }

    /// Subtracts bytes from the allowance of the file, and returns an error if it is used up.
    pub(crate) fn take(&mut self, bytes: usize) -> Result<(), Reason> {
        let too_large = || Reason::Format("the scene would take more than 1,000 times the size of its file".into());
        self.bytes_left = self.bytes_left.checked_sub(bytes).ok_or_else(too_large)?;
        Ok(())
    }

    /// Adds a vertex and returns its index.
    pub(crate) fn vertex(&mut self, position: [f64; 3]) -> Result<u32, Reason> {
        self.take(size_of::<[f64; 3]>())?;
        self.builder.push_vertex(Point3::from(position))
    }

    /// Adds a primitive. Its vertices have to be finite.
    pub(crate) fn push(&mut self, element: Element) -> Result<(), Reason> {
        let count = &mut self.next[element.indices().len() - 1];
        *count += 1;
        let source = *count - 1;
        self.push_from(element, source)
    }

    /// Adds a primitive that comes from the statement with this number. Its vertices have to be finite.
    pub(crate) fn push_from(&mut self, element: Element, source: usize) -> Result<(), Reason> {
        self.take(2 * size_of::<[u32; 3]>())?;
        for &index in element.indices() {
            if !self.builder.is_finite(index)? {
                return Err(Reason::NonFiniteVertex { index: index.into() });
            }
        }
        self.builder.push(element, source)
    }

    /// Adds the triangles of a polygon that comes from the statement with this number.
    pub(crate) fn polygon(&mut self, vertices: &[u32], source: usize) -> Result<(), Reason> {
        self.take(2 * size_of::<[u32; 3]>() * vertices.len())?;
        for &index in vertices {
            if !self.builder.is_finite(index)? {
                return Err(Reason::NonFiniteVertex { index: index.into() });
            }
        }
        if vertices.len() < 3 {
            return Err(Reason::TooFewVertices { found: vertices.len() as u64, needed: 3 });
        }
        self.builder.push_polygon(vertices, source)
    }

    /// Adds a vertex and a point of the scene there. A point that is not finite is left out.
    pub(crate) fn point(&mut self, position: [f64; 3]) -> Result<(), Reason> {
        let vertex = self.vertex(position)?;
        let source = self.next[0];
        self.next[0] += 1;
        if position.iter().all(|x| x.is_finite()) {
            self.push_from(Element::Point(vertex), source)
        } else {
            self.invalid += 1;
            Ok(())
        }
    }

    pub(crate) fn finish(mut self) -> Scene {
        self.builder.skipped.add_plural(self.invalid, "vertices that are not finite");
        self.builder.finish()
    }
}

/// Returns a position transformed by a matrix.
pub(crate) fn moved(matrix: &Matrix4<f64>, position: [f64; 3]) -> [f64; 3] {
    matrix.transform_point(&Point3::from(position)).coords.into()
}

/// Returns whether a matrix mirrors a mesh. Its triangles then have to be reversed, so that they still face outside.
pub(crate) fn is_mirrored(matrix: &Matrix4<f64>) -> bool {
    matrix.fixed_view::<3, 3>(0, 0).determinant() < 0.0
}

/// Returns the triangles of a strip. Every other one is reversed, so that all face the same side.
pub(crate) fn strip(corners: &[u32]) -> impl Iterator<Item = Element> {
    (0..).zip(corners.windows(3)).map(|(i, t)| {
        let [b, c] = if i % 2 == 0 { [t[1], t[2]] } else { [t[2], t[1]] };
        Element::Triangle([t[0], b, c])
    })
}

/// Returns the triangles of a fan, which share the first corner.
pub(crate) fn fan(corners: &[u32]) -> impl Iterator<Item = Element> {
    corners.get(1..).unwrap_or_default().windows(2).map(|t| Element::Triangle([corners[0], t[0], t[1]]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_and_fans_face_one_side() {
        let triangles = |all: &[[u32; 3]]| all.iter().copied().map(Element::Triangle).collect::<Vec<_>>();
        assert_eq!(strip(&[0, 1, 2, 3, 4]).collect::<Vec<_>>(), triangles(&[[0, 1, 2], [1, 3, 2], [2, 3, 4]]));
        assert_eq!(fan(&[0, 1, 2, 3]).collect::<Vec<_>>(), triangles(&[[0, 1, 2], [0, 2, 3]]));
        assert_eq!((strip(&[0, 1]).count(), fan(&[]).count(), fan(&[0]).count()), (0, 0, 0));
    }
}
