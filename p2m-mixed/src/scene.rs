//! Scenes: primitives with their sources in a file, named objects, and records that the reader skipped.

use crate::Unit;
use p2m_core::{Element, PrimitiveId, Soup};
use std::fmt;
use std::ops::Range;
use std::sync::Arc;

/// A scene that was read from a file or built of parts that were [added](Scene::add).
///
/// ```
/// use p2m_mixed::Scene;
///
/// let mut scene = Scene::default();
/// scene.add_triangles("roof", &[[0.0, 0.0, 3.0], [4.0, 0.0, 3.0], [0.0, 4.0, 3.0]], &[[0, 1, 2]])?;
/// scene.add_polyline("cable", &[[0.0, 0.0, 0.0], [4.0, 0.0, 0.0]])?;
/// assert_eq!((scene.soup.triangles().len(), scene.soup.segments().len()), (1, 1));
/// # Ok::<(), p2m_core::BuildError>(())
/// ```
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct Scene {
    /// The primitives, numbered in the order of the file.
    ///
    /// Polygons are divided into triangles, which have consecutive ids and the winding of the polygon. Coordinates are
    /// f64; for an f32 scene make a `Soup<f32>` of the rounded positions and the elements. Indexes can share them.
    pub soup: Arc<Soup<f64>>,
    /// The source of each primitive: `sources[id]` is the number of its statement among the statements of the same
    /// kind, counted from 0 in the order of the file.
    ///
    /// - OBJ files count the statements `f` for triangles, `l` for segments and `p` for points.
    /// - PLY files count the elements `face` for triangles, `edge` for segments and `point` for points. The elements
    ///   `tristrips` are counted after the last `face`.
    /// - STL files count facets, and OFF files count faces of any number of vertices.
    /// - Point clouds, which are files with vertices alone, count vertices.
    /// - Parts that were [added](Scene::add) count the primitives of each kind from 0 in each part.
    pub sources: Vec<u32>,
    /// The named parts of the scene, in ascending order of ids. They do not overlap, and primitives need not be in one.
    ///
    /// The objects of an OBJ file are its statements `o` or, if it has none, `g`. The objects of a text STL file
    /// are its solids. Other formats and point clouds have no objects. Objects without a name or without primitives
    /// are left out.
    pub objects: Vec<Object>,
    /// The records that the reader left out because they are not geometry, in the order of first appearance.
    pub skipped: Vec<Skipped>,
    /// The unit of the coordinates, if the file states it. Coordinates are not converted.
    pub unit: Option<Unit>,
    /// Whether the points of the file have two coordinates. Their z is then 0.
    pub is_flat: bool,
}

/// Makes a scene without objects, in which each primitive is a statement of its own.
impl From<Soup<f64>> for Scene {
    fn from(soup: Soup<f64>) -> Self {
        let mut counts = [0; 3];
        let next = |element: Element| {
            let count = &mut counts[element.indices().len() - 1];
            *count += 1;
            *count - 1
        };
        let sources = soup.elements().map(next).collect();
        Self { soup: Arc::new(soup), sources, objects: Vec::new(), ..Self::default() }
    }
}

/// Consecutive primitives under one name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Object {
    /// The name in the file, without blanks around it. Several objects may have the same name.
    ///
    /// Bytes that are not UTF-8 are replaced by U+FFFD. Names come from the file, so they may have any characters.
    pub name: String,
    /// The ids of its primitives.
    pub ids: Range<usize>,
}

/// Returns the number of the object that a primitive belongs to. Objects have to be in ascending order.
#[must_use]
pub fn object_number(objects: &[Object], id: PrimitiveId) -> Option<usize> {
    let number = objects.partition_point(|object| object.ids.start <= id.index()).checked_sub(1)?;
    objects[number].ids.contains(&id.index()).then_some(number)
}

/// A kind of records that the reader left out. It displays as an item of a list: `2 x usemtl`.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Skipped {
    /// The name of the kind: the keyword of an OBJ statement, an element or a property of a PLY file, or a plural such
    /// as `bytes after the last element` (`words` in a text), `facets with attribute bytes`, `vertices with further
    /// numbers`, `faces with a colour`, `vertices that are not finite` (of a point cloud).
    pub what: String,
    /// The number of records.
    pub count: u64,
    /// Whether `what` is a plural that follows the count, rather than a name.
    pub(crate) is_plural: bool,
}

impl fmt::Display for Skipped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}{}", self.count, if self.is_plural { "" } else { "x " }, self.what)
    }
}
