//! Writes scenes as STL.

use crate::{Scene, WriteError};
use nalgebra::Vector3;
use p2m_core::{Element, PrimitiveId, PrimitiveSet, Soup};
use std::io::Write;

/// The header of a binary file, which must not start with `solid`.
const HEADER: &[u8; 80] = b"binary STL                                                                      ";

/// Writes a scene as binary STL.
///
/// Triangles come in the order of their ids, with unit normals. The normal of a triangle without area is 0. Coordinates
/// are rounded to single precision, and [`stl_rounding`] computes by how much.
///
/// Vertices are not shared in the file. [`read_stl`](crate::read_stl) returns the same soup if no coordinate is
/// rounded, no two positions are equal, and the triangles use all positions in ascending order. Otherwise positions get
/// other numbers, equal positions are merged, and unused positions are lost. Ids are kept, and objects are lost.
///
/// # Errors
/// [`WriteError`] for segments, points and coordinates that are infinite in single precision, before anything is
/// written, and for errors of `writer`.
pub fn write_stl(scene: &Scene, mut writer: impl Write) -> Result<(), WriteError> {
    let soup = &scene.soup;
    for (i, element) in soup.elements().enumerate() {
        let id = PrimitiveId::new(i);
        let Element::Triangle(triangle) = element else { return Err(WriteError::NotATriangle { id }) };
        let coordinates = corners(soup, triangle);
        if let Some(&coordinate) = coordinates.as_flattened().iter().find(|x| single(**x).is_infinite()) {
            return Err(WriteError::BeyondSinglePrecision { id, coordinate });
        }
    }
    let count = u32::try_from(soup.len()).map_err(|_| WriteError::TooMany { count: soup.len() })?;
    writer.write_all(HEADER)?;
    writer.write_all(&count.to_le_bytes())?;
    for &triangle in soup.triangles() {
        let corners = corners(soup, triangle).map(|p| p.map(single));
        let mut facet = [0; 50];
        let numbers = [normal(&corners), corners[0], corners[1], corners[2]];
        for (bytes, x) in facet.as_chunks_mut().0.iter_mut().zip(numbers.as_flattened()) {
            *bytes = x.to_le_bytes();
        }
        writer.write_all(&facet)?;
    }
    writer.flush()?;
    Ok(())
}

#[allow(clippy::cast_possible_truncation, reason = "rounds to the nearest")]
fn single(x: f64) -> f32 {
    x as f32
}

fn corners(soup: &Soup<f64>, triangle: [u32; 3]) -> [[f64; 3]; 3] {
    triangle.map(|i| soup.positions()[i as usize].coords.into())
}

/// Returns the unit normal of a triangle, or 0 if it has no area. Products of differences of single precision neither
/// overflow nor vanish in f64.
fn normal(corners: &[[f32; 3]; 3]) -> [f32; 3] {
    let [a, b, c] = corners.map(|p| Vector3::from(p.map(f64::from)));
    let normal = (b - a).cross(&(c - a));
    let length = normal.norm();
    if length > 0.0 { (normal / length).map(single).into() } else { [0.0; 3] }
}

/// The rounding of a scene that is written as STL, see [`stl_rounding`].
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[non_exhaustive]
pub struct StlRounding {
    /// The number of coordinates of triangles that single precision cannot represent exactly. Each vertex counts once.
    pub count: u64,
    /// The largest change of a coordinate, in units of the scene. It is infinite if a coordinate is beyond the range of
    /// single precision, and then [`write_stl`] returns an error.
    pub largest: f64,
}

/// Computes how much [`write_stl`] rounds the vertices of the triangles of a scene.
///
/// ```
/// use p2m_mixed::{read_obj, stl_rounding};
///
/// let scene = read_obj("v 0.5 0 0\nv 1 0 0\nv 0 16777217 0\nf 1 2 3\n".as_bytes(), "t.obj").unwrap();
/// let rounding = stl_rounding(&scene);
/// assert_eq!((rounding.count, rounding.largest), (1, 1.0)); // 2^24 + 1
/// ```
#[must_use]
pub fn stl_rounding(scene: &Scene) -> StlRounding {
    let soup = &scene.soup;
    let mut is_counted = vec![false; soup.positions().len()];
    let mut rounding = StlRounding::default();
    for &vertex in soup.triangles().as_flattened() {
        if std::mem::replace(&mut is_counted[vertex as usize], true) {
            continue;
        }
        for x in soup.positions()[vertex as usize].iter() {
            // The difference is exact or infinite.
            let error = (x - f64::from(single(*x))).abs();
            if error > 0.0 {
                rounding.count += 1;
                rounding.largest = rounding.largest.max(error);
            }
        }
    }
    rounding
}
