//! Scenes and query points from bytes, with coordinates that are hard in one way or another.

use super::bytes::Bytes;
use nalgebra::Point3;
use p2m::{Element, Point, PrimitiveId, PrimitiveSet, Segment, Shape, Soup, Triangle};

/// The largest number of primitives of a scene.
const MAX_PRIMITIVES: usize = 40;
/// The number of positions that the primitives share.
const POSITIONS: usize = 48;

/// Returns x 2^exponent, multiplied in two steps, so that no factor leaves the range.
fn scaled(x: f64, exponent: i32) -> f64 {
    x * 2f64.powi(exponent / 2) * 2f64.powi(exponent - exponent / 2)
}

/// Returns the number `steps` representable numbers up or down. A number that is not finite stays.
fn beside(x: f64, steps: i8) -> f64 {
    let one = |x: f64| if steps < 0 { x.next_down() } else { x.next_up() };
    if x.is_finite() { (0..steps.unsigned_abs()).fold(x, |x, _| one(x)) } else { x }
}

/// A distribution of coordinates.
enum Coordinates {
    /// Integers from -4 to 4, and quarters for queries, moved and scaled without rounding, so that ties are frequent.
    Lattice { offset: f64, exponent: i32 },
    /// Any bits, mostly from a pool, so that some coincide.
    Bits { pool: [f64; 6] },
    /// Numbers within a few units in the last place of an f32.
    Neighbours { anchor: [f32; 3] },
    /// Positions on and next to a lattice: slivers and needles.
    Slivers,
    /// Numbers with few digits and any magnitude.
    Magnitudes,
}

/// The names of the distributions.
pub const MODES: [&str; 5] = ["lattice", "bits", "neighbours", "slivers", "magnitudes"];

const EXPONENTS: [i32; 16] = [0, 0, 0, 0, -1074, -1060, -541, -400, -300, -260, -100, 100, 252, 400, 515, 970];
const OFFSETS: [f64; 6] = [0.0, 0.0, 0.0, 1000.0, 1_073_741_824.0, 1_125_899_906_842_624.0];

impl Coordinates {
    fn draw(bytes: &mut Bytes<'_>) -> Self {
        match bytes.below(MODES.len()) {
            0 => Self::Lattice { offset: bytes.pick(&OFFSETS), exponent: bytes.pick(&EXPONENTS) },
            1 => Self::Bits { pool: std::array::from_fn(|_| f64::from_bits(bytes.word())) },
            #[allow(clippy::cast_possible_truncation, reason = "half of the bits are used")]
            2 => Self::Neighbours { anchor: std::array::from_fn(|_| f32::from_bits(bytes.word() as u32)) },
            3 => Self::Slivers,
            _ => Self::Magnitudes,
        }
    }

    fn mode(&self) -> &'static str {
        MODES[match self {
            Self::Lattice { .. } => 0,
            Self::Bits { .. } => 1,
            Self::Neighbours { .. } => 2,
            Self::Slivers => 3,
            Self::Magnitudes => 4,
        }]
    }

    fn number(&self, bytes: &mut Bytes<'_>, axis: usize, is_query: bool) -> f64 {
        let integer = |bytes: &mut Bytes<'_>| f64::from(bytes.byte() % 9) - 4.0;
        match self {
            Self::Lattice { offset, exponent } => {
                let small = if is_query { (f64::from(bytes.byte() % 65) - 32.0) * 0.25 } else { integer(bytes) };
                scaled(offset + small, *exponent)
            }
            Self::Bits { pool } => match bytes.below(9) {
                i @ 0..6 => pool[i],
                6 => f64::from_bits(bytes.word()),
                7 => -bytes.pick(pool),
                _ => 0.0,
            },
            Self::Neighbours { anchor } => {
                f64::from(f32::from_bits(anchor[axis].to_bits().wrapping_add_signed(i32::from(bytes.signed()))))
            }
            Self::Slivers => {
                let (near, steps) = (integer(bytes), bytes.signed());
                let aside = 2f64.powi(-i32::from(steps.unsigned_abs()));
                match steps {
                    0 => near,
                    1.. => near + aside,
                    _ => near - aside,
                }
            }
            Self::Magnitudes => scaled(f64::from(bytes.signed()), 8 * i32::from(bytes.signed())),
        }
    }

    fn point(&self, bytes: &mut Bytes<'_>, is_query: bool) -> Point3<f64> {
        Point3::from(std::array::from_fn(|axis| self.number(bytes, axis, is_query)))
    }
}

/// A scene that may be invalid, and the distribution of query points.
pub struct SceneDraft {
    pub mode: &'static str,
    pub positions: Vec<Point3<f64>>,
    pub elements: Vec<Element>,
    coordinates: Coordinates,
}

impl SceneDraft {
    /// Generates a scene of at most `max_primitives` primitives, and at most [`MAX_PRIMITIVES`].
    pub fn new(bytes: &mut Bytes<'_>, max_primitives: usize) -> Self {
        let coordinates = Coordinates::draw(bytes);
        let count = 1 + bytes.below(POSITIONS);
        let mut positions: Vec<_> = (0..count).map(|_| coordinates.point(bytes, false)).collect();
        // Moving some coordinates of an exact tie makes near-ties.
        for _ in 0..bytes.below(8) {
            let (position, axis) = (bytes.below(count), bytes.below(3));
            positions[position][axis] = beside(positions[position][axis], bytes.signed() % 4);
        }
        let len = bytes.below(1 + max_primitives.min(MAX_PRIMITIVES));
        let element = |_| {
            let mut vertex = || bytes.byte() % u8::try_from(count).expect("few");
            match vertex() % 4 {
                0 => Element::Point(vertex().into()),
                1 => Element::Segment([0; 2].map(|_| vertex().into())),
                _ => Element::Triangle([0; 3].map(|_| vertex().into())),
            }
        };
        let elements = (0..len).map(element).collect();
        Self { mode: coordinates.mode(), positions, elements, coordinates }
    }

    /// Returns a point around the scene or anywhere. It may not be finite.
    pub fn query(&self, bytes: &mut Bytes<'_>) -> Point3<f64> {
        let kind = bytes.below(9);
        let vertex = |bytes: &mut Bytes<'_>| self.positions[bytes.below(self.positions.len())];
        match kind {
            0 | 1 => self.coordinates.point(bytes, true),
            2 => vertex(bytes),
            3 => vertex(bytes).map(|x| beside(x, bytes.signed() % 4)),
            4 => (vertex(bytes) * 0.5) + vertex(bytes).coords * 0.5,
            5 => (vertex(bytes) * 0.25) + vertex(bytes).coords * 0.25 + vertex(bytes).coords * 0.5,
            6 => vertex(bytes) + (vertex(bytes) - vertex(bytes)) * f64::from(bytes.signed()),
            7 => {
                let exponent = 4 * i32::from(bytes.signed());
                let a = vertex(bytes);
                a.map(|x| x + scaled(f64::from(bytes.signed()), exponent))
            }
            _ => Point3::from(std::array::from_fn(|_| f64::from_bits(bytes.word()))),
        }
    }

    /// Returns the primitives one by one, for any coordinates.
    pub fn shapes(&self) -> Vec<Shape<f64>> {
        let at = |i: u32| self.positions[i as usize];
        let shape = |element: &Element| match *element {
            Element::Point(a) => Point::new(at(a)).into(),
            Element::Segment([a, b]) => Segment::new(at(a), at(b)).into(),
            Element::Triangle([a, b, c]) => Triangle::new(at(a), at(b), at(c)).into(),
        };
        self.elements.iter().map(shape).collect()
    }

    /// Returns the scene, or the first primitive with a coordinate that is not finite.
    pub fn soup(&self) -> Result<Soup<f64>, PrimitiveId> {
        let is_finite = |i: &u32| self.positions[*i as usize].iter().all(|x| x.is_finite());
        let soup = Soup::new(self.positions.clone(), self.elements.iter().copied());
        match self.elements.iter().position(|element| !element.indices().iter().all(is_finite)) {
            None => Ok(soup.expect("finite")),
            Some(bad) => {
                let id = PrimitiveId::new(bad);
                assert_eq!(soup, Err(p2m::BuildError::NonFinite { id }));
                Err(id)
            }
        }
    }

    /// Formats the positions and the elements of the scene.
    pub fn describe(&self) -> String {
        format!("positions {:?}\nelements {:?}", self.positions, self.elements)
    }
}

/// Returns the vertices of a primitive in f64.
pub fn vertices<T: p2m::Real>(soup: &Soup<T>, id: usize) -> Vec<[f64; 3]> {
    let shape = soup.get(PrimitiveId::new(id));
    p2m::Primitive::vertices(&shape).iter().map(|v| v.map(T::to_f64).coords.into()).collect()
}
