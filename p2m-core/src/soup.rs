//! Soups: sets of points, segments and triangles over shared positions.

use crate::{BuildError, Point, Position, PrimitiveId, PrimitiveSet, Real, Segment, Shape, Triangle};
use nalgebra::Point3;

/// One primitive of a [`Soup`], as indices of positions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Element {
    /// A point at a position.
    Point(u32),
    /// A segment between two positions.
    Segment([u32; 2]),
    /// A triangle of three positions.
    Triangle([u32; 3]),
}

impl Element {
    /// Returns the indices of the positions of the primitive.
    #[must_use]
    pub fn indices(&self) -> &[u32] {
        match self {
            Self::Point(i) => std::slice::from_ref(i),
            Self::Segment(s) => s,
            Self::Triangle(t) => t,
        }
    }
}

/// The location of a primitive: its kind in the two upper bits, and its index within that kind in the lower bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Slot(u32);

/// The number of bits of the index in a [`Slot`].
const SLOT_INDEX_BITS: u32 = 30;
/// The kind of points in a [`Slot`].
const POINT: u32 = 0;
/// The kind of segments in a [`Slot`].
const SEGMENT: u32 = 1;
/// The kind of triangles in a [`Slot`].
const TRIANGLE: u32 = 2;

impl Slot {
    #[allow(clippy::cast_possible_truncation, reason = "indices are below PrimitiveId::MAX_COUNT = 2^30")]
    fn new(kind: u32, index: usize) -> Self {
        Self(kind << SLOT_INDEX_BITS | index as u32)
    }
    fn kind(self) -> u32 {
        self.0 >> SLOT_INDEX_BITS
    }
    fn index(self) -> usize {
        (self.0 & ((1 << SLOT_INDEX_BITS) - 1)) as usize
    }
}

/// A set of points, segments and triangles in any order, over shared positions.
///
/// Primitives have ids in the order in which they were given. They are stored by kind: a soup of one kind has no
/// further overhead, and a mixed soup needs four more bytes per primitive. Every index of a position is in range, and
/// every position that a primitive uses is finite. Degenerate primitives are ordinary members.
///
/// Coordinates have any unit, the same on all axes, and primitives are straight, so longitudes and latitudes have to be
/// projected first. Neighbouring f32 coordinates near 5,000,000 differ by half a unit; f64 resolves any location on
/// earth.
///
/// ```
/// use p2m_core::{Element, Soup, PrimitiveSet};
/// use nalgebra::Point3;
///
/// let positions = vec![Point3::new(0.0, 0.0, 0.0), Point3::new(1.0, 0.0, 0.0), Point3::new(0.0, 1.0, 0.0)];
/// let elements = [Element::Triangle([0, 1, 2]), Element::Segment([0, 1]), Element::Point(2)];
/// let soup = Soup::new(positions, elements).unwrap();
/// assert_eq!(soup.len(), 3);
/// assert_eq!(soup.segments(), &[[0, 1]]);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Soup<T: Real = f64> {
    positions: Vec<Point3<T>>,
    points: Vec<u32>,
    segments: Vec<[u32; 2]>,
    triangles: Vec<[u32; 3]>,
    /// The slot of each id. It is empty as long as the soup has primitives of one kind only.
    slots: Vec<Slot>,
}

impl<T: Real> Soup<T> {
    /// Creates a soup of `elements` over `positions`, with ids in their order.
    ///
    /// # Errors
    /// It returns a [`BuildError`] for the first primitive with an index out of range or a position that is not finite,
    /// and for more than 2^30 primitives. Positions that no primitive uses are not part of the scene and are not
    /// checked.
    pub fn new(positions: Vec<Point3<T>>, elements: impl IntoIterator<Item = Element>) -> Result<Self, BuildError> {
        let mut soup = Self { positions, ..Self::default() };
        for element in elements {
            soup.push(element)?;
        }
        Ok(soup)
    }

    /// Creates a soup of triangles.
    ///
    /// # Errors
    /// It returns the errors of [`Soup::new`].
    pub fn from_triangles(positions: Vec<Point3<T>>, triangles: Vec<[u32; 3]>) -> Result<Self, BuildError> {
        if triangles.len() > PrimitiveId::MAX_COUNT {
            return Err(BuildError::TooMany { len: triangles.len() });
        }
        let soup = Self { positions, triangles, ..Self::default() };
        for (i, t) in soup.triangles.iter().enumerate() {
            soup.check(PrimitiveId::new(i), t)?;
        }
        Ok(soup)
    }

    /// Creates a soup of triangles from arrays, which are copied. Positions are of any [`Position`] type, such as
    /// `[f32; 3]`, and indices of any integer type, such as `u32` or `usize`.
    ///
    /// ```
    /// use p2m_core::{PrimitiveSet, Soup};
    ///
    /// let positions: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    /// let soup: Soup<f64> = Soup::from_arrays(&positions, &[[0usize, 1, 2]])?;
    /// assert_eq!(soup.len(), 1);
    /// # Ok::<(), p2m_core::BuildError>(())
    /// ```
    ///
    /// # Errors
    /// It returns the errors of [`Soup::new`]. An index that is negative or too large for `u32` is reported as
    /// `u32::MAX`.
    pub fn from_arrays<P: Position<T>, I: TryInto<u32> + Copy>(
        positions: &[P],
        triangles: &[[I; 3]],
    ) -> Result<Self, BuildError> {
        let index = |i: I| i.try_into().unwrap_or(u32::MAX);
        let triangles = triangles.iter().map(|triangle| triangle.map(index)).collect();
        Self::from_triangles(positions.iter().map(Position::point).collect(), triangles)
    }

    /// Creates a soup of triangles from flat arrays of coordinates (x, y, z, x, ...) and indices, which are copied.
    ///
    /// ```
    /// use p2m_core::{BuildError, PrimitiveSet, Soup};
    ///
    /// let coordinates = [0.0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    /// let soup: Soup<f32> = Soup::from_flat_arrays(&coordinates, &[0u32, 1, 2])?;
    /// assert_eq!(soup.len(), 1);
    /// let plane: Result<Soup<f32>, _> = Soup::from_flat_arrays(&coordinates[..8], &[0u32, 1, 2]);
    /// assert_eq!(plane.unwrap_err(), BuildError::NotTriples { len: 8 });
    /// # Ok::<(), BuildError>(())
    /// ```
    ///
    /// # Errors
    /// It returns [`BuildError::NotTriples`] for an array whose length is not a multiple of three, and the errors of
    /// [`Soup::from_arrays`].
    pub fn from_flat_arrays<X: Copy, I: TryInto<u32> + Copy>(
        coordinates: &[X],
        indices: &[I],
    ) -> Result<Self, BuildError>
    where
        [X; 3]: Position<T>,
    {
        Self::from_arrays(triples(coordinates)?, triples(indices)?)
    }

    /// Replaces all positions, in their order. Primitives keep their ids and the indices of their positions.
    ///
    /// # Errors
    /// It returns [`BuildError::OtherPositionCount`] for another number of positions and [`BuildError::NonFinite`] for
    /// a primitive with a position that is not finite. The soup is then unchanged.
    pub fn set_positions(&mut self, positions: Vec<Point3<T>>) -> Result<(), BuildError> {
        if positions.len() != self.positions.len() {
            return Err(BuildError::OtherPositionCount { len: positions.len(), expected: self.positions.len() });
        }
        let old = std::mem::replace(&mut self.positions, positions);
        let first_bad = (0..self.len()).map(PrimitiveId::new).find_map(|id| {
            let element = self.element(id);
            self.check(id, element.indices()).err()
        });
        if let Some(error) = first_bad {
            self.positions = old;
            return Err(error);
        }
        Ok(())
    }

    /// Replaces each position by its image.
    ///
    /// # Errors
    /// It returns [`BuildError::NonFinite`] for a primitive with an image that is not finite. The soup
    /// is then unchanged.
    pub fn map_positions(&mut self, image: impl FnMut(Point3<T>) -> Point3<T>) -> Result<(), BuildError> {
        self.set_positions(self.positions.iter().copied().map(image).collect())
    }

    /// Checks that the positions of a primitive exist and are finite.
    fn check(&self, id: PrimitiveId, indices: &[u32]) -> Result<(), BuildError> {
        for &index in indices {
            match self.positions.get(index as usize) {
                None => return Err(BuildError::IndexOutOfRange { id, index, len: self.positions.len() }),
                Some(p) if !p.iter().all(|x| x.is_finite()) => return Err(BuildError::NonFinite { id }),
                Some(_) => {}
            }
        }
        Ok(())
    }

    /// Adds a primitive and returns its id.
    ///
    /// # Errors
    /// It returns the errors of [`Soup::new`], and the soup is then unchanged.
    pub fn push(&mut self, element: Element) -> Result<PrimitiveId, BuildError> {
        let len = self.len();
        if len >= PrimitiveId::MAX_COUNT {
            return Err(BuildError::TooMany { len: len + 1 });
        }
        let id = PrimitiveId::new(len);
        self.check(id, element.indices())?;
        let slot = match element {
            Element::Point(_) => Slot::new(POINT, self.points.len()),
            Element::Segment(_) => Slot::new(SEGMENT, self.segments.len()),
            Element::Triangle(_) => Slot::new(TRIANGLE, self.triangles.len()),
        };
        if self.slots.is_empty() && slot.index() != len {
            // This is the first primitive of a second kind, so from now on the slot of each primitive is stored.
            let kind = self.only_kind();
            self.slots.try_reserve_exact(len + 1).map_err(|_| BuildError::OutOfMemory)?;
            self.slots.extend((0..len).map(|i| Slot::new(kind, i)));
        }
        let has_slots = !self.slots.is_empty();
        if has_slots {
            reserve_half(&mut self.slots)?;
        }
        match element {
            Element::Point(p) => push_growing_by_half(&mut self.points, p),
            Element::Segment(s) => push_growing_by_half(&mut self.segments, s),
            Element::Triangle(t) => push_growing_by_half(&mut self.triangles, t),
        }?;
        if has_slots {
            self.slots.push(slot);
        }
        Ok(id)
    }

    /// Adds a position and returns its index, which later [`Element`]s can use. The position is checked when one does.
    ///
    /// # Panics
    /// It panics if the position does not fit into memory.
    pub fn push_position(&mut self, position: Point3<T>) -> usize {
        self.try_push_position(position).expect("memory for a position")
    }

    /// Adds a position as [`push_position`](Self::push_position) does.
    ///
    /// # Errors
    /// It returns [`BuildError::OutOfMemory`] if the position does not fit into memory.
    pub fn try_push_position(&mut self, position: Point3<T>) -> Result<usize, BuildError> {
        push_growing_by_half(&mut self.positions, position)?;
        Ok(self.positions.len() - 1)
    }

    /// Frees the memory that is reserved for further positions and primitives.
    pub fn shrink_to_fit(&mut self) {
        self.positions.shrink_to_fit();
        self.points.shrink_to_fit();
        self.segments.shrink_to_fit();
        self.triangles.shrink_to_fit();
        self.slots.shrink_to_fit();
    }

    /// Returns the kind of all primitives while `slots` is empty.
    #[inline(always)]
    fn only_kind(&self) -> u32 {
        if !self.triangles.is_empty() {
            TRIANGLE
        } else if !self.segments.is_empty() {
            SEGMENT
        } else {
            POINT
        }
    }

    #[inline(always)]
    fn slot(&self, id: PrimitiveId) -> Slot {
        if self.slots.is_empty() { Slot::new(self.only_kind(), id.index()) } else { self.slots[id.index()] }
    }

    /// Returns all positions, whether a primitive uses them or not.
    #[must_use]
    pub fn positions(&self) -> &[Point3<T>] {
        &self.positions
    }

    /// Returns the points in the order of their ids, as indices of positions.
    #[must_use]
    pub fn points(&self) -> &[u32] {
        &self.points
    }

    /// Returns the segments in the order of their ids, as indices of positions.
    #[must_use]
    pub fn segments(&self) -> &[[u32; 2]] {
        &self.segments
    }

    /// Returns the triangles in the order of their ids, as indices of positions.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Returns the primitive with an id, as indices of positions.
    ///
    /// # Panics
    /// It panics if there is no such primitive.
    #[inline(always)]
    #[must_use]
    pub fn element(&self, id: PrimitiveId) -> Element {
        let slot = self.slot(id);
        match slot.kind() {
            POINT => Element::Point(self.points[slot.index()]),
            SEGMENT => Element::Segment(self.segments[slot.index()]),
            _ => Element::Triangle(self.triangles[slot.index()]),
        }
    }

    /// Returns all primitives in the order of their ids, as indices of positions.
    pub fn elements(&self) -> impl Iterator<Item = Element> + '_ {
        (0..self.len()).map(|i| self.element(PrimitiveId::new(i)))
    }

    #[inline(always)]
    fn position(&self, index: u32) -> Point3<T> {
        self.positions[index as usize]
    }
}

/// Returns a flat array as triples.
fn triples<X>(flat: &[X]) -> Result<&[[X; 3]], BuildError> {
    match flat.as_chunks() {
        (triples, []) => Ok(triples),
        _ => Err(BuildError::NotTriples { len: flat.len() }),
    }
}

/// Appends to a list. Its capacity grows by half instead of doubling, so that a soup that is filled one by one has a
/// lower peak of memory.
fn push_growing_by_half<X>(list: &mut Vec<X>, item: X) -> Result<(), BuildError> {
    reserve_half(list)?;
    list.push(item);
    Ok(())
}

/// Reserves memory for one item, and for half as many more as there are.
#[inline]
fn reserve_half<X>(list: &mut Vec<X>) -> Result<(), BuildError> {
    if list.len() == list.capacity() {
        list.try_reserve_exact(list.len() / 2 + 4).map_err(|_| BuildError::OutOfMemory)?;
    }
    Ok(())
}

impl<T: Real> PrimitiveSet<T> for Soup<T> {
    type Primitive<'a> = Shape<T>;

    #[inline(always)]
    fn len(&self) -> usize {
        self.points.len() + self.segments.len() + self.triangles.len()
    }

    #[inline(always)]
    fn get(&self, id: PrimitiveId) -> Shape<T> {
        match self.element(id) {
            Element::Point(p) => Shape::Point(Point::new(self.position(p))),
            Element::Segment([a, b]) => Shape::Segment(Segment::new(self.position(a), self.position(b))),
            Element::Triangle([a, b, c]) => {
                Shape::Triangle(Triangle::new(self.position(a), self.position(b), self.position(c)))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn positions() -> Vec<Point3<f64>> {
        (0..4).map(|i| Point3::new(f64::from(i), 0.0, 1.0)).collect()
    }

    #[test]
    fn ids_are_those_of_the_order_given_for_every_order_of_kinds() {
        let kinds = [Element::Point(3), Element::Segment([0, 1]), Element::Triangle([1, 2, 3])];
        for code in 0..3usize.pow(5) {
            let elements: Vec<Element> = (0..5).map(|i| kinds[code / 3usize.pow(i) % 3]).collect();
            let soup = Soup::new(positions(), elements.iter().copied()).unwrap();
            assert_eq!(soup.elements().collect::<Vec<_>>(), elements);
        }
    }

    #[test]
    fn bad_elements_are_refused_and_named() {
        let mut with_nan = positions();
        with_nan[2].y = f64::NAN;
        let id = PrimitiveId::new(1);
        let elements = [Element::Segment([0, 1]), Element::Triangle([1, 2, 3])];
        assert_eq!(Soup::new(with_nan.clone(), elements), Err(BuildError::NonFinite { id }));
        assert!(Soup::new(with_nan, [Element::Segment([0, 1])]).is_ok(), "an unused position may be anything");
        let elements = [Element::Point(0), Element::Segment([0, 4])];
        assert_eq!(Soup::new(positions(), elements), Err(BuildError::IndexOutOfRange { id, index: 4, len: 4 }));
        let triangles = vec![[0, 1, 2], [0, 9, 1]];
        assert_eq!(
            Soup::from_triangles(positions(), triangles),
            Err(BuildError::IndexOutOfRange { id, index: 9, len: 4 })
        );
    }

    #[test]
    fn a_soup_grows_by_positions_and_elements_in_turns() {
        let elements = [Element::Point(0), Element::Segment([0, 1]), Element::Triangle([1, 0, 3])];
        let mut soup = Soup::default();
        for (i, p) in positions().into_iter().enumerate() {
            assert_eq!(soup.push_position(p), i);
            for &element in elements.iter().filter(|e| e.indices().iter().max() == Some(&(i as u32))) {
                soup.push(element).unwrap();
            }
        }
        soup.shrink_to_fit();
        assert_eq!(soup, Soup::new(positions(), elements).unwrap());
    }

    #[test]
    fn refused_positions_leave_the_soup_as_it_was() {
        let mut soup = Soup::new(positions(), [Element::Segment([0, 1])]).unwrap();
        let before = soup.clone();
        let count = BuildError::OtherPositionCount { len: 1, expected: 4 };
        assert_eq!(soup.set_positions(vec![Point3::origin()]), Err(count));
        let id = PrimitiveId::new(0);
        assert_eq!(soup.map_positions(|p| p * f64::NAN), Err(BuildError::NonFinite { id }));
        assert_eq!(soup, before);
        soup.map_positions(|p| if p.x == 3.0 { p * f64::INFINITY } else { p * 2.0 }).unwrap();
        assert_eq!(soup.positions()[1], Point3::new(2.0, 0.0, 2.0));
    }

    #[test]
    fn indices_that_are_no_u32_are_out_of_range() {
        let bad = |error: BuildError| matches!(error, BuildError::IndexOutOfRange { index: u32::MAX, .. });
        assert!(bad(Soup::<f64>::from_arrays(&positions(), &[[0i64, 1, -1]]).unwrap_err()));
        assert!(bad(Soup::<f64>::from_arrays(&positions(), &[[0usize, 1, 1 << 32]]).unwrap_err()));
    }

    #[test]
    fn a_refused_element_leaves_the_soup_as_it_was() {
        let mut soup = Soup::new(positions(), [Element::Point(0)]).unwrap();
        let before = soup.clone();
        soup.push(Element::Segment([0, 7])).unwrap_err();
        assert_eq!(soup, before);
    }
}
