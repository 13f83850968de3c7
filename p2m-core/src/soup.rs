//! Mixed scenes: points, segments and triangles over shared positions.

use crate::{BuildError, Point, PrimitiveId, PrimitiveSet, Real, Segment, Shape, Triangle};
use nalgebra::Point3;

/// One primitive of a [`Soup`], by the numbers of its positions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Element {
    /// A point.
    Point(u32),
    /// A segment.
    Segment([u32; 2]),
    /// A triangle.
    Triangle([u32; 3]),
}

impl Element {
    /// The numbers of its positions.
    #[must_use]
    pub fn indices(&self) -> &[u32] {
        match self {
            Self::Point(i) => std::slice::from_ref(i),
            Self::Segment(s) => s,
            Self::Triangle(t) => t,
        }
    }
}

/// Where a primitive is stored: its kind in the two upper bits, its place among those of its kind below.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Slot(u32);

const PLACE_BITS: u32 = 30;
const POINT: u32 = 0;
const SEGMENT: u32 = 1;
const TRIANGLE: u32 = 2;

impl Slot {
    #[allow(clippy::cast_possible_truncation, reason = "places are below PrimitiveId::MAX_COUNT = 2^30")]
    fn new(kind: u32, place: usize) -> Self {
        Self(kind << PLACE_BITS | place as u32)
    }
    fn kind(self) -> u32 {
        self.0 >> PLACE_BITS
    }
    fn place(self) -> usize {
        (self.0 & ((1 << PLACE_BITS) - 1)) as usize
    }
}

/// A set of points, segments and triangles in any order, over shared positions.
///
/// Ids are those of the order in which primitives were given. Stored by kind; a soup of one kind has no further
/// overhead, a mixed one pays four bytes a primitive. Every index is in range and every position that a primitive
/// uses is finite. Degenerate primitives are ordinary members.
///
/// Coordinates have any unit, the same on all axes, and primitives are straight: longitudes and latitudes have to be
/// projected first. In f32 coordinates of 5,000,000 are half a unit apart; f64 has room for any place on earth.
///
/// ```
/// use p2m_core::{Element, Soup, PrimitiveSet};
/// use nalgebra::Point3;
///
/// let positions = vec![Point3::new(0.0, 0.0, 0.0), Point3::new(1.0, 0.0, 0.0), Point3::new(0.0, 1.0, 0.0)];
/// let soup = Soup::new(positions, [Element::Triangle([0, 1, 2]), Element::Segment([0, 1]), Element::Point(2)]).unwrap();
/// assert_eq!(soup.len(), 3);
/// assert_eq!(soup.segments(), &[[0, 1]]);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Soup<T: Real> {
    positions: Vec<Point3<T>>,
    points: Vec<u32>,
    segments: Vec<[u32; 2]>,
    triangles: Vec<[u32; 3]>,
    /// One slot per id; empty while the soup has one kind only.
    slots: Vec<Slot>,
}

impl<T: Real> Default for Soup<T> {
    fn default() -> Self {
        Self {
            positions: Vec::new(),
            points: Vec::new(),
            segments: Vec::new(),
            triangles: Vec::new(),
            slots: Vec::new(),
        }
    }
}

impl<T: Real> Soup<T> {
    /// A soup of `elements` over `positions`, numbered in their order.
    ///
    /// # Errors
    /// [`BuildError`] names the first primitive with an index out of range or a position that is not finite, or says
    /// that there are too many. Positions that nothing uses are not part of the scene and may be anything.
    pub fn new(positions: Vec<Point3<T>>, elements: impl IntoIterator<Item = Element>) -> Result<Self, BuildError> {
        let mut soup = Self { positions, ..Self::default() };
        for element in elements {
            soup.push(element)?;
        }
        Ok(soup)
    }

    /// A soup of triangles.
    ///
    /// # Errors
    /// As [`Soup::new`].
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

    /// Adds a primitive under the next id.
    ///
    /// # Errors
    /// As [`Soup::new`]; the soup is then as it was.
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
        if self.slots.is_empty() && slot.place() != len {
            // The second kind: write down what was implicit so far.
            let kind = self.only_kind();
            self.slots = (0..len).map(|i| Slot::new(kind, i)).collect();
        }
        if !self.slots.is_empty() {
            push_by_half(&mut self.slots, slot);
        }
        match element {
            Element::Point(p) => push_by_half(&mut self.points, p),
            Element::Segment(s) => push_by_half(&mut self.segments, s),
            Element::Triangle(t) => push_by_half(&mut self.triangles, t),
        }
        Ok(id)
    }

    /// Adds a position and returns its number, for [`Element`]s to come. It may be anything as long as none uses it.
    pub fn push_position(&mut self, position: Point3<T>) -> usize {
        push_by_half(&mut self.positions, position);
        self.positions.len() - 1
    }

    /// Gives back the memory that is held for more positions and primitives.
    pub fn shrink_to_fit(&mut self) {
        self.positions.shrink_to_fit();
        self.points.shrink_to_fit();
        self.segments.shrink_to_fit();
        self.triangles.shrink_to_fit();
        self.slots.shrink_to_fit();
    }

    /// The kind of all primitives while `slots` is empty.
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

    /// The positions, used or not.
    #[must_use]
    pub fn positions(&self) -> &[Point3<T>] {
        &self.positions
    }

    /// The points among the primitives, in the order of their ids.
    #[must_use]
    pub fn points(&self) -> &[u32] {
        &self.points
    }

    /// The segments, in the order of their ids.
    #[must_use]
    pub fn segments(&self) -> &[[u32; 2]] {
        &self.segments
    }

    /// The triangles, in the order of their ids.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The primitive of that id, by the numbers of its positions.
    ///
    /// # Panics
    /// If there is no such primitive.
    #[inline(always)]
    #[must_use]
    pub fn element(&self, id: PrimitiveId) -> Element {
        let slot = self.slot(id);
        match slot.kind() {
            POINT => Element::Point(self.points[slot.place()]),
            SEGMENT => Element::Segment(self.segments[slot.place()]),
            _ => Element::Triangle(self.triangles[slot.place()]),
        }
    }

    /// All primitives in the order of their ids.
    pub fn elements(&self) -> impl Iterator<Item = Element> + '_ {
        (0..self.len()).map(|i| self.element(PrimitiveId::new(i)))
    }

    #[inline(always)]
    fn position(&self, index: u32) -> Point3<T> {
        self.positions[index as usize]
    }
}

/// Grows by half instead of doubling, so that a soup that is filled one by one needs less memory at its peak.
fn push_by_half<X>(list: &mut Vec<X>, item: X) {
    if list.len() == list.capacity() {
        list.reserve_exact(list.len() / 2 + 4);
    }
    list.push(item);
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
    fn a_refused_element_leaves_the_soup_as_it_was() {
        let mut soup = Soup::new(positions(), [Element::Point(0)]).unwrap();
        let before = soup.clone();
        soup.push(Element::Segment([0, 7])).unwrap_err();
        assert_eq!(soup, before);
    }
}
