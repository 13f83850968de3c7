//! Torus knots: the curve, the frame along it, and a closed tube of triangles around it.

use super::error::{GenerateError, at_least, capacity, in_range};
use super::portable::SinCos;
use nalgebra::{Point3, Vector3};
use p2m_core::{Element, Soup};

/// The distance from the axis of the torus on which the knot lies to the centre of its tube.
const MAJOR_RADIUS: f64 = 2.0;
/// The radius of the tube of that torus.
const MINOR_RADIUS: f64 = 0.8;

/// Options of [`torus_knot`]. The default makes 12,000 triangles along the trefoil.
///
/// ```
/// use p2m_mixed::generate::{TorusKnot, torus_knot};
///
/// let knot = torus_knot(&TorusKnot { p: 3, q: 5, tube_radius: 0.2, ..Default::default() }).unwrap();
/// assert_eq!((knot.positions().len(), knot.triangles().len()), (6000, 12_000));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TorusKnot {
    /// The number of turns of the knot around the axis of its torus.
    pub p: u32,
    /// The number of turns around the tube of the torus. It may not have a common divisor with `p`.
    pub q: u32,
    /// The number of rings of vertices along the knot, at least 3.
    pub rings: u32,
    /// The number of vertices of each ring, at least 3. There are two triangles for each vertex.
    pub sides: u32,
    /// The radius of the tube. The radii of the torus are 2 and 0.8. A tube that is thicker than the gaps of the
    /// knot intersects itself.
    pub tube_radius: f64,
}

impl Default for TorusKnot {
    fn default() -> Self {
        Self { p: 2, q: 3, rings: 300, sides: 20, tube_radius: 0.3 }
    }
}

/// Makes a closed tube along a torus knot. It has 2 `rings` `sides` triangles, which are counter-clockwise
/// seen from outside.
///
/// # Errors
/// [`GenerateError`] if an option is not in its range or there are more primitives than ids.
pub fn torus_knot(options: &TorusKnot) -> Result<Soup<f64>, GenerateError> {
    let &TorusKnot { p, q, rings, sides, tube_radius } = options;
    at_least(3, "rings", rings)?;
    at_least(3, "sides", sides)?;
    if greatest_common_divisor(p, q) != 1 {
        return Err(GenerateError::CommonDivisor { p, q });
    }
    in_range(tube_radius > 0.0 && tube_radius <= 1e3, "tube radius", tube_radius, "above 0 and at most 1000")?;
    capacity(2 * u128::from(rings) * u128::from(sides))?;
    let positions = tube(p, q, rings, sides, tube_radius).collect();
    Ok(Soup::new(positions, tube_elements(rings, sides))?)
}

fn greatest_common_divisor(mut a: u32, mut b: u32) -> u32 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

/// Returns the vertices of a tube, ring after ring.
pub(super) fn tube(p: u32, q: u32, rings: u32, sides: u32, radius: f64) -> impl Iterator<Item = Point3<f64>> {
    (0..rings).flat_map(move |ring| {
        let along = |windings: u32| SinCos::of_fraction(u64::from(windings) * u64::from(ring), rings);
        let frame = Frame::new(p, q, along(p), along(q));
        (0..sides).map(move |side| frame.around(radius, SinCos::of_fraction(u64::from(side), sides)))
    })
}

/// Returns the triangles of a tube whose vertices are the first ones of the scene.
pub(super) fn tube_elements(rings: u32, sides: u32) -> impl Iterator<Item = Element> {
    (0..rings).flat_map(move |ring| {
        (0..sides).flat_map(move |side| {
            let next = |i: u32, count: u32| if i + 1 == count { 0 } else { i + 1 };
            let vertex = |ring: u32, side: u32| ring * sides + side;
            let [a, b] = [vertex(ring, side), vertex(next(ring, rings), side)];
            let [c, d] = [vertex(next(ring, rings), next(side, sides)), vertex(ring, next(side, sides))];
            [Element::Triangle([a, d, c]), Element::Triangle([a, c, b])]
        })
    })
}

/// A point of the knot with two directions perpendicular to the knot.
pub(super) struct Frame {
    origin: Point3<f64>,
    outwards: Vector3<f64>,
    sideways: Vector3<f64>,
}

impl Frame {
    /// Returns the frame where the knot has turned by `long` around the axis and by `short` around the tube
    /// of the torus.
    ///
    /// The normal of the torus is perpendicular to any curve on it, and closes up where the curve does.
    pub(super) fn new(p: u32, q: u32, long: SinCos, short: SinCos) -> Self {
        let radius = MAJOR_RADIUS + MINOR_RADIUS * short.cos;
        let origin = Point3::new(radius * long.cos, radius * long.sin, MINOR_RADIUS * short.sin);
        let outwards = Vector3::new(short.cos * long.cos, short.cos * long.sin, short.sin);
        let around = Vector3::new(-long.sin, long.cos, 0.0) * (f64::from(p) * radius);
        let across = Vector3::new(-short.sin * long.cos, -short.sin * long.sin, short.cos);
        let sideways = (around + across * (f64::from(q) * MINOR_RADIUS)).normalize().cross(&outwards);
        Self { origin, outwards, sideways }
    }

    /// Returns the frame at a parameter in turns. One turn is the complete knot.
    pub(super) fn at(p: u32, q: u32, turns: f64) -> Self {
        Self::new(p, q, SinCos::of_turns(f64::from(p) * turns), SinCos::of_turns(f64::from(q) * turns))
    }

    pub(super) fn around(&self, radius: f64, angle: SinCos) -> Point3<f64> {
        self.origin + (self.outwards * angle.cos + self.sideways * angle.sin) * radius
    }
}
