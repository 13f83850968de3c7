//! The primitives of one kind in a soup, as a set.

use crate::{Point, PrimitiveId, PrimitiveSet, Real, Segment, Soup, Triangle};
use std::ops::Deref;

/// The primitives of one kind in a [`Soup`]: triangles for N = 3, segments for N = 2, points for N = 1.
///
/// The type is written as [`TriangleSet`], [`SegmentSet`] or [`PointSet`]. `S` is a pointer to the soup:
/// [`Soup::triangle_set`] borrows the soup, and with `Box<Soup<f64>>` or `Arc<Soup<f64>>` the set owns or shares it.
///
/// An index over this set is compiled for the kernel of that kind alone. Primitives are numbered in the order of the
/// soup. If the soup has other kinds as well, [`Soup::triangle_ids`], [`Soup::segment_ids`] and [`Soup::point_ids`] map
/// these numbers to ids of the soup.
///
/// ```
/// use p2m_core::{BruteForce, ClosestPoint, Element, Soup};
/// use nalgebra::Point3;
///
/// let positions = vec![Point3::new(0.0, 0.0, 0.0), Point3::new(1.0, 0.0, 0.0), Point3::new(0.0, 1.0, 0.0)];
/// let soup = Soup::new(positions, [Element::Point(2), Element::Segment([0, 1]), Element::Segment([0, 2])])?;
/// let wires = BruteForce::new(soup.segment_set())?;
/// let answer = wires.closest_point(&Point3::new(0.1, 2.0, 0.0)).expect("two segments");
/// assert_eq!(answer.primitive.index(), 1);
/// let id = soup.segment_ids().nth(answer.primitive.index()).expect("a segment of the scene");
/// assert_eq!(id.index(), 2);
/// # Ok::<(), p2m_core::BuildError>(())
/// ```
///
/// An index that shares the soup can be a field of a struct:
///
/// ```
/// use p2m_core::{BruteForce, ClosestPoint, Soup, TriangleSet};
/// use nalgebra::Point3;
/// use std::sync::Arc;
///
/// struct Walls {
///     index: BruteForce<TriangleSet<Arc<Soup<f64>>>>,
/// }
///
/// let soup = Soup::from_arrays(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], &[[0u32, 1, 2]])?;
/// let walls = Walls { index: BruteForce::new(TriangleSet::new(Arc::new(soup)))? };
/// assert_eq!(walls.index.closest_point(&Point3::new(0.2, 0.2, 3.0)).unwrap().distance, 3.0);
/// # Ok::<(), p2m_core::BuildError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct KindSet<S, const N: usize> {
    soup: S,
}

/// The triangles of a soup.
pub type TriangleSet<S> = KindSet<S, 3>;
/// The segments of a soup.
pub type SegmentSet<S> = KindSet<S, 2>;
/// The points of a soup.
pub type PointSet<S> = KindSet<S, 1>;

impl<S, const N: usize> KindSet<S, N> {
    /// Creates the set of the primitives with N vertices.
    pub fn new(soup: S) -> Self {
        Self { soup }
    }

    /// Returns the pointer to the soup.
    pub fn soup(&self) -> &S {
        &self.soup
    }
}

/// Implements the set of primitives of one kind. The arguments are the type of the set, the type of a primitive, the
/// method of a soup that returns its elements, a pattern for an element, and its indices.
macro_rules! set_of_kind {
    ($set:ident, $primitive:ident, $elements:ident, $element:pat, [$($index:ident),+]) => {
        impl<T: Real, S: Deref<Target = Soup<T>>> PrimitiveSet<T> for $set<S> {
            type Primitive<'b>
                = $primitive<T>
            where
                Self: 'b;

            #[inline(always)]
            fn len(&self) -> usize {
                self.soup.$elements().len()
            }

            #[inline(always)]
            fn get(&self, id: PrimitiveId) -> $primitive<T> {
                let soup = &*self.soup;
                let $element = soup.$elements()[id.index()];
                $primitive::new($(soup.positions()[$index as usize]),+)
            }
        }
    };
}

set_of_kind!(PointSet, Point, points, a, [a]);
set_of_kind!(SegmentSet, Segment, segments, [a, b], [a, b]);
set_of_kind!(TriangleSet, Triangle, triangles, [a, b, c], [a, b, c]);

impl<T: Real> Soup<T> {
    /// Returns the triangles of the soup as a set.
    #[must_use]
    pub fn triangle_set(&self) -> TriangleSet<&Self> {
        KindSet::new(self)
    }

    /// Returns the segments of the soup as a set.
    #[must_use]
    pub fn segment_set(&self) -> SegmentSet<&Self> {
        KindSet::new(self)
    }

    /// Returns the points of the soup as a set.
    #[must_use]
    pub fn point_set(&self) -> PointSet<&Self> {
        KindSet::new(self)
    }

    /// Returns the ids of the triangles in their order. The i-th id belongs to triangle i of [`Soup::triangle_set`].
    pub fn triangle_ids(&self) -> impl Iterator<Item = PrimitiveId> + '_ {
        self.ids_of_kind(3)
    }

    /// Returns the ids of the segments in their order. The i-th id belongs to segment i of [`Soup::segment_set`].
    pub fn segment_ids(&self) -> impl Iterator<Item = PrimitiveId> + '_ {
        self.ids_of_kind(2)
    }

    /// Returns the ids of the points in their order. The i-th id belongs to point i of [`Soup::point_set`].
    pub fn point_ids(&self) -> impl Iterator<Item = PrimitiveId> + '_ {
        self.ids_of_kind(1)
    }

    /// Returns the ids of the primitives with this number of vertices.
    fn ids_of_kind(&self, vertex_count: usize) -> impl Iterator<Item = PrimitiveId> + '_ {
        let ids = (0..self.len()).map(PrimitiveId::new);
        ids.filter(move |id| self.element(*id).indices().len() == vertex_count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Element, Shape};
    use nalgebra::Point3;

    #[test]
    fn sets_of_a_kind_are_the_soup_without_the_others() {
        let positions = (0..5).map(|i| Point3::new(f64::from(i), f64::from(i * i), 1.0)).collect();
        let elements = [
            Element::Segment([3, 1]),
            Element::Triangle([4, 0, 2]),
            Element::Point(4),
            Element::Segment([0, 4]),
            Element::Point(0),
        ];
        let soup: Soup<f64> = Soup::new(positions, elements).unwrap();
        let all = |i: PrimitiveId| soup.get(i);
        let triangles: Vec<_> = soup.triangle_ids().map(all).collect();
        let segments: Vec<_> = soup.segment_ids().map(all).collect();
        let points: Vec<_> = soup.point_ids().map(all).collect();
        assert_eq!((triangles.len(), segments.len(), points.len()), (1, 2, 2));
        for (i, triangle) in triangles.into_iter().enumerate() {
            assert_eq!(Shape::Triangle(soup.triangle_set().get(PrimitiveId::new(i))), triangle);
        }
        for (i, segment) in segments.into_iter().enumerate() {
            assert_eq!(Shape::Segment(soup.segment_set().get(PrimitiveId::new(i))), segment);
        }
        for (i, point) in points.into_iter().enumerate() {
            assert_eq!(Shape::Point(soup.point_set().get(PrimitiveId::new(i))), point);
        }
        let shared = std::sync::Arc::new(soup.clone());
        let owned = SegmentSet::new(Box::new(soup.clone()));
        assert_eq!(owned.len(), 2);
        let id = PrimitiveId::new(1);
        assert_eq!(owned.get(id), soup.segment_set().get(id));
        let points = PointSet::new(std::sync::Arc::clone(&shared));
        assert_eq!(points.get(id), soup.point_set().get(id));
        let triangles = TriangleSet::new(&*shared);
        assert_eq!(triangles.len(), 1);
        assert_eq!((soup.triangle_set().len(), soup.segment_set().len(), soup.point_set().len()), (1, 2, 2));
    }
}
