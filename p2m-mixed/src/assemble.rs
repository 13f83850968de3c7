//! Building scenes from named parts.

use crate::scene::{Object, Scene, object_number};
use nalgebra::Point3;
use p2m_core::{BuildError, Element, PrimitiveId, PrimitiveSet, Soup};
use std::ops::Range;
use std::sync::Arc;

impl Scene {
    /// Adds a part under a name and returns the ids of its primitives.
    ///
    /// Blanks around the name are removed. If nothing is left, the part has no name.
    ///
    /// [`Transform::apply`](crate::generate::Transform::apply) turns, scales or moves a part before it is added.
    /// Coordinates are transformed once, so queries are not slowed down.
    ///
    /// ```
    /// use nalgebra::Point3;
    /// use p2m_core::{BruteForce, ClosestPoint};
    /// use p2m_mixed::Scene;
    /// use p2m_mixed::generate::{IcoSphere, Transform, ico_sphere};
    ///
    /// let ball = ico_sphere(&IcoSphere::default()).unwrap();
    /// let mut scene = Scene::default();
    /// scene.add("ball", &Transform::default().translated([9.0, 0.0, 0.0]).apply(&ball).unwrap())?;
    /// scene.add_triangles("floor", &[[-5.0, -5.0, -1.0], [5.0, -5.0, -1.0], [0.0, 9.0, -1.0]], &[[0, 1, 2]])?;
    /// scene.add_polyline("wire", &[Point3::new(0.0, 0.0, 3.0), Point3::new(1.0, 0.0, 3.0), Point3::new(1.0, 2.0,
    /// 3.0)])?; scene.add_points("", &[[0.0, 0.0, 9.0]])?;
    ///
    /// let answer = BruteForce::new(&scene.soup)?.closest_point(&Point3::new(1.0, 1.0, 2.0)).unwrap();
    /// assert_eq!(scene.object_of(answer.primitive).unwrap().name, "wire");
    /// # Ok::<(), p2m_core::BuildError>(())
    /// ```
    ///
    /// # Errors
    /// [`BuildError::TooMany`] for more primitives than ids, or more vertices than u32 can number. After an error the
    /// scene is unchanged.
    ///
    /// # Complexity
    /// O(1) for each vertex and primitive of the part. A part without primitives does not change the scene.
    pub fn add(&mut self, name: &str, part: &Soup<f64>) -> Result<Range<usize>, BuildError> {
        let start = self.soup.len();
        let end = start + part.len();
        if start == end {
            return Ok(start..end);
        }
        let first = self.soup.positions().len();
        // Vertices are numbered by u32, and a scene with more of them returns the same error as one with too many
        // primitives.
        let last = u32::try_from(first + part.positions().len());
        let (Ok(first), Ok(_), true) = (u32::try_from(first), last, end <= PrimitiveId::MAX_COUNT) else {
            return Err(BuildError::TooMany { len: end });
        };
        // An index that shares the primitives keeps them as they were.
        let soup = Arc::make_mut(&mut self.soup);
        for position in part.positions() {
            soup.push_position(*position);
        }
        let shifted = |i: u32| i + first;
        let mut next = [0; 3];
        for element in part.elements() {
            let element = match element {
                Element::Point(p) => Element::Point(shifted(p)),
                Element::Segment(s) => Element::Segment(s.map(shifted)),
                Element::Triangle(t) => Element::Triangle(t.map(shifted)),
            };
            let count = &mut next[element.indices().len() - 1];
            self.sources.push(*count);
            *count += 1;
            // This never fails, because the part is valid and the number of primitives was checked.
            soup.push(element)?;
        }
        let name = name.trim();
        if !name.is_empty() {
            self.objects.push(Object { name: name.to_owned(), ids: start..end });
        }
        Ok(start..end)
    }

    /// Adds triangles, each of which has the indices of three positions.
    ///
    /// # Errors
    /// The errors are those of [`Soup::new`], with ids and positions counted in this part. After an error the
    /// scene is unchanged.
    pub fn add_triangles<P: Copy + Into<Point3<f64>>>(
        &mut self,
        name: &str,
        positions: &[P],
        triangles: &[[u32; 3]],
    ) -> Result<Range<usize>, BuildError> {
        self.add_elements(name, positions, triangles.iter().map(|t| Element::Triangle(*t)))
    }

    /// Adds segments, each of which has the indices of two positions.
    ///
    /// # Errors
    /// The errors are those of [`add_triangles`](Self::add_triangles).
    pub fn add_segments<P: Copy + Into<Point3<f64>>>(
        &mut self,
        name: &str,
        positions: &[P],
        segments: &[[u32; 2]],
    ) -> Result<Range<usize>, BuildError> {
        self.add_elements(name, positions, segments.iter().map(|s| Element::Segment(*s)))
    }

    /// Adds the segments from each position to the next. A single position is a point.
    ///
    /// # Errors
    /// The errors are those of [`add_triangles`](Self::add_triangles).
    pub fn add_polyline<P: Copy + Into<Point3<f64>>>(
        &mut self,
        name: &str,
        positions: &[P],
    ) -> Result<Range<usize>, BuildError> {
        match index_count(positions)? {
            1 => self.add_points(name, positions),
            count => self.add_elements(name, positions, (1..count).map(|i| Element::Segment([i - 1, i]))),
        }
    }

    /// Adds a point for each position.
    ///
    /// # Errors
    /// The errors are those of [`add_triangles`](Self::add_triangles).
    pub fn add_points<P: Copy + Into<Point3<f64>>>(
        &mut self,
        name: &str,
        positions: &[P],
    ) -> Result<Range<usize>, BuildError> {
        self.add_elements(name, positions, (0..index_count(positions)?).map(Element::Point))
    }

    fn add_elements<P: Copy + Into<Point3<f64>>>(
        &mut self,
        name: &str,
        positions: &[P],
        elements: impl Iterator<Item = Element>,
    ) -> Result<Range<usize>, BuildError> {
        self.add(name, &Soup::new(positions.iter().map(|p| (*p).into()).collect(), elements)?)
    }

    /// Returns the named part that a primitive is in.
    ///
    /// # Complexity
    /// O(log n) for n parts.
    #[must_use]
    pub fn object_of(&self, id: PrimitiveId) -> Option<&Object> {
        self.object_number(id).map(|number| &self.objects[number])
    }

    /// Returns the number of the named part that a primitive is in, which counts `objects`.
    ///
    /// # Complexity
    /// O(log n) for n parts.
    #[must_use]
    pub fn object_number(&self, id: PrimitiveId) -> Option<usize> {
        object_number(&self.objects, id)
    }
}

/// Returns the number of positions as the type of their indices.
fn index_count<P>(positions: &[P]) -> Result<u32, BuildError> {
    u32::try_from(positions.len()).map_err(|_| BuildError::TooMany { len: positions.len() })
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

    #[test]
    fn parts_keep_their_names_and_numbers() {
        let mut scene = Scene::default();
        assert_eq!(scene.add_triangles("a", &CORNERS, &[[0, 1, 2], [2, 1, 0]]).unwrap(), 0..2);
        assert_eq!(scene.add_polyline(" b\n", &CORNERS).unwrap(), 2..4);
        assert_eq!(scene.add_points(" ", &CORNERS[..1]).unwrap(), 4..5);
        assert_eq!(scene.add_triangles("a", &CORNERS, &[[0, 2, 1]]).unwrap(), 5..6);
        assert_eq!(scene.add_segments("empty", &CORNERS, &[]).unwrap(), 6..6);
        assert_eq!(scene.add_segments("c", &CORNERS.map(Point3::from), &[[2, 0]]).unwrap(), 6..7);
        let name = |i: usize| scene.object_of(PrimitiveId::new(i)).map(|object| object.name.as_str());
        let names: Vec<_> = (0..8).map(name).collect();
        assert_eq!(names, [Some("a"), Some("a"), Some("b"), Some("b"), None, Some("a"), Some("c"), None]);
        assert_eq!(scene.objects.len(), 4);
        assert_eq!(scene.sources, [0, 1, 0, 1, 0, 0, 0]);
        assert_eq!(scene.soup.segments(), [[3, 4], [4, 5], [12, 10]]);
        assert_eq!(scene.soup.triangles()[2], [7, 9, 8]);
        assert_eq!(scene.soup.positions().len(), 13);
    }

    #[test]
    fn positions_may_be_those_of_mint() {
        let mut scene = Scene::default();
        scene.add_points("", &[mint::Point3 { x: 1.0, y: 2.0, z: 3.0 }]).unwrap();
        assert_eq!(scene.soup.positions(), [Point3::new(1.0, 2.0, 3.0)]);
    }

    #[test]
    fn errors_leave_the_scene_unchanged() {
        let mut scene = Scene::default();
        scene.add_triangles("a", &CORNERS, &[[0, 1, 2]]).unwrap();
        let before = scene.clone();
        let id = PrimitiveId::new(1);
        let error = scene.add_triangles("b", &CORNERS, &[[0, 1, 2], [0, 1, 3]]).unwrap_err();
        assert_eq!(error, BuildError::IndexOutOfRange { id, index: 3, len: 3 });
        let bad = [[0.0; 3], [f64::NAN; 3]];
        assert_eq!(scene.add_points("b", &bad).unwrap_err(), BuildError::NonFinite { id });
        assert_eq!(scene, before);
        assert_eq!(scene.add_polyline::<[f64; 3]>("none", &[]).unwrap(), 1..1);
        assert_eq!(scene.objects, before.objects);
    }

    #[test]
    fn a_polyline_of_one_position_is_a_point() {
        let mut scene = Scene::default();
        assert_eq!(scene.add_polyline("one", &CORNERS[1..2]).unwrap(), 0..1);
        assert_eq!((scene.soup.points(), scene.objects.len()), (&[0][..], 1));
    }
}
