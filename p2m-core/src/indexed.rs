//! The primitives of one kind of a soup, as a set.

use crate::{Point, PrimitiveId, PrimitiveSet, Real, Segment, Soup, Triangle};
use nalgebra::Point3;
use std::ops::Deref;

/// The primitives of one kind of a borrowed [`Soup`]: triangles for N = 3, segments for N = 2, points for N = 1.
///
/// An index over it compiles to the kernel of that kind alone. Primitives are numbered in the order of the soup. If the
/// soup has other kinds as well, [`Soup::triangle_ids`], [`Soup::segment_ids`] and [`Soup::point_ids`] map these
/// numbers to ids of the soup.
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
#[derive(Clone, Copy, Debug)]
pub struct Indexed<'a, T: Real, const N: usize> {
    positions: &'a [Point3<T>],
    elements: &'a [[u32; N]],
}

impl<T: Real, const N: usize> Indexed<'_, T, N> {
    /// Returns the vertices of a primitive.
    #[inline(always)]
    fn vertices(&self, id: PrimitiveId) -> [Point3<T>; N] {
        self.elements[id.index()].map(|i| self.positions[i as usize])
    }
}

/// The primitives of one kind of a soup that the set owns or shares, as [`Indexed`] has those of a borrowed one.
///
/// `S` is a pointer to the soup, such as `Arc<Soup<f64>>` or `Box<Soup<f64>>`.
///
/// ```
/// use p2m_core::{BruteForce, ClosestPoint, OfKind, Soup};
/// use nalgebra::Point3;
/// use std::sync::Arc;
///
/// struct Walls {
///     index: BruteForce<OfKind<Arc<Soup<f64>>, 3>>,
/// }
///
/// let soup = Soup::from_arrays(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], &[[0u32, 1, 2]])?;
/// let walls = Walls { index: BruteForce::new(OfKind::new(Arc::new(soup)))? };
/// assert_eq!(walls.index.closest_point(&Point3::new(0.2, 0.2, 3.0)).unwrap().distance, 3.0);
/// # Ok::<(), p2m_core::BuildError>(())
/// ```
#[derive(Clone, Debug)]
pub struct OfKind<S, const N: usize> {
    soup: S,
}

impl<S, const N: usize> OfKind<S, N> {
    /// Creates the set of the primitives with N vertices.
    pub fn new(soup: S) -> Self {
        Self { soup }
    }

    /// Returns the pointer to the soup.
    pub fn soup(&self) -> &S {
        &self.soup
    }
}

/// Implements the set of primitives of one kind, given their number of vertices, their type, the method of a soup that
/// returns them as a set, and an expression that makes a primitive of its vertices.
macro_rules! set_of_kind {
    ($n:literal, $primitive:ident, $set:ident, $vertices:pat, $value:expr) => {
        impl<T: Real> PrimitiveSet<T> for Indexed<'_, T, $n> {
            type Primitive<'b>
                = $primitive<T>
            where
                Self: 'b;

            #[inline(always)]
            fn len(&self) -> usize {
                self.elements.len()
            }

            #[inline(always)]
            fn get(&self, id: PrimitiveId) -> $primitive<T> {
                let $vertices = self.vertices(id);
                $value
            }
        }

        impl<T: Real, S: Deref<Target = Soup<T>>> PrimitiveSet<T> for OfKind<S, $n> {
            type Primitive<'b>
                = $primitive<T>
            where
                Self: 'b;

            #[inline(always)]
            fn len(&self) -> usize {
                self.soup.$set().len()
            }

            #[inline(always)]
            fn get(&self, id: PrimitiveId) -> $primitive<T> {
                self.soup.$set().get(id)
            }
        }
    };
}

set_of_kind!(1, Point, point_set, [a], Point::new(a));
set_of_kind!(2, Segment, segment_set, [a, b], Segment::new(a, b));
set_of_kind!(3, Triangle, triangle_set, [a, b, c], Triangle::new(a, b, c));

impl<T: Real> Soup<T> {
    /// Returns the triangles of the soup as a set.
    #[must_use]
    pub fn triangle_set(&self) -> Indexed<'_, T, 3> {
        Indexed { positions: self.positions(), elements: self.triangles() }
    }

    /// Returns the segments of the soup as a set.
    #[must_use]
    pub fn segment_set(&self) -> Indexed<'_, T, 2> {
        Indexed { positions: self.positions(), elements: self.segments() }
    }

    /// Returns the points of the soup as a set.
    #[must_use]
    pub fn point_set(&self) -> Indexed<'_, T, 1> {
        Indexed { positions: self.positions(), elements: self.points().as_chunks().0 }
    }

    /// Returns the ids of the triangles in their order: the i-th one is that of triangle i of [`Soup::triangle_set`].
    pub fn triangle_ids(&self) -> impl Iterator<Item = PrimitiveId> + '_ {
        self.ids_of_kind(3)
    }

    /// Returns the ids of the segments in their order: the i-th one is that of segment i of [`Soup::segment_set`].
    pub fn segment_ids(&self) -> impl Iterator<Item = PrimitiveId> + '_ {
        self.ids_of_kind(2)
    }

    /// Returns the ids of the points in their order: the i-th one is that of point i of [`Soup::point_set`].
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
        let owned: OfKind<_, 2> = OfKind::new(Box::new(soup.clone()));
        assert_eq!(PrimitiveSet::<f64>::len(&owned), 2);
        let id = PrimitiveId::new(1);
        assert_eq!(PrimitiveSet::<f64>::get(&owned, id), soup.segment_set().get(id));
        let points: OfKind<_, 1> = OfKind::new(std::sync::Arc::clone(&shared));
        assert_eq!(PrimitiveSet::<f64>::get(&points, id), soup.point_set().get(id));
        let triangles: OfKind<_, 3> = OfKind::new(&*shared);
        assert_eq!(PrimitiveSet::<f64>::len(&triangles), 1);
        assert_eq!((soup.triangle_set().len(), soup.segment_set().len(), soup.point_set().len()), (1, 2, 2));
    }
}
