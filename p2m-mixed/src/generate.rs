//! Scenes made from nothing.

use nalgebra::{Point3, Vector3};
use p2m_core::{BuildError, Element, Soup};
use std::f64::consts::TAU;

/// How fine [`knot_and_cables`] is. The default is that of `scenes/knot_and_cables.obj`.
///
/// ```
/// use p2m_mixed::generate::{KnotAndCables, knot_and_cables};
///
/// let scene = knot_and_cables(&KnotAndCables::default().with_cables(2)).unwrap();
/// assert_eq!((scene.triangles().len(), scene.segments().len()), (3600, 192));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct KnotAndCables {
    /// Rings along the knot; at least 3.
    pub rings: u32,
    /// Vertices of each ring; at least 3. There are two triangles for each vertex.
    pub sides: u32,
    /// Cables.
    pub cables: u32,
    /// Segments of each cable; at least 1.
    pub cable_segments: u32,
}

impl Default for KnotAndCables {
    fn default() -> Self {
        Self { rings: 150, sides: 12, cables: 5, cable_segments: 96 }
    }
}

impl KnotAndCables {
    /// With that many rings.
    #[must_use]
    pub fn with_rings(self, rings: u32) -> Self {
        Self { rings, ..self }
    }
    /// With that many vertices in a ring.
    #[must_use]
    pub fn with_sides(self, sides: u32) -> Self {
        Self { sides, ..self }
    }
    /// With that many cables.
    #[must_use]
    pub fn with_cables(self, cables: u32) -> Self {
        Self { cables, ..self }
    }
    /// With that many segments in a cable.
    #[must_use]
    pub fn with_cable_segments(self, cable_segments: u32) -> Self {
        Self { cable_segments, ..self }
    }
}

/// The torus on which the knot lies, and the knot's thickness.
const MAJOR_RADIUS: f64 = 2.0;
const MINOR_RADIUS: f64 = 0.8;
const TUBE_RADIUS: f64 = 0.3;

/// A closed tube of triangles along a (2, 3) torus knot, and free cables of segments that wind around it and leave it.
///
/// The tube's triangles come first, outside counter-clockwise; then the segments, cable after cable. Coordinates are
/// within 4 of the origin and rounded to five decimals: the same on every machine, whatever the last bit of its sine.
/// Numbers below the least that makes sense count as that.
///
/// # Errors
/// [`BuildError`] if there are more primitives than ids.
pub fn knot_and_cables(options: &KnotAndCables) -> Result<Soup<f64>, BuildError> {
    let (rings, sides) = (options.rings.max(3), options.sides.max(3));
    let (cables, steps) = (options.cables, options.cable_segments.max(1));
    let count = 2 * u64::from(rings) * u64::from(sides) + u64::from(cables) * u64::from(steps);
    if count > p2m_core::PrimitiveId::MAX_COUNT as u64 {
        return Err(BuildError::TooMany { len: usize::try_from(count).unwrap_or(usize::MAX) });
    }

    let mut positions = Vec::new();
    let mut elements = Vec::new();
    for ring in 0..rings {
        let frame = Frame::at(TAU * f64::from(ring) / f64::from(rings));
        positions.extend((0..sides).map(|side| frame.around(TUBE_RADIUS, TAU * f64::from(side) / f64::from(sides))));
    }
    for ring in 0..rings {
        for side in 0..sides {
            let vertex = |ring: u32, side: u32| ring % rings * sides + side % sides;
            let [a, b] = [vertex(ring, side), vertex(ring + 1, side)];
            let [c, d] = [vertex(ring + 1, side + 1), vertex(ring, side + 1)];
            elements.extend([Element::Triangle([a, d, c]), Element::Triangle([a, c, b])]);
        }
    }
    let mut next = rings * sides;
    for cable in 0..cables {
        let phase = f64::from(cable) / f64::from(cables);
        for step in 0..=steps {
            // From near the tube, twice around it per third of the knot, and outwards ever faster.
            let s = f64::from(step) / f64::from(steps);
            let frame = Frame::at(TAU * (phase + 0.6 * s));
            let radius = TUBE_RADIUS * (1.15 + 0.15 * f64::from(cable % 3) + 2.0 * s * s * s);
            positions.push(frame.around(radius, TAU * (phase + 4.0 * s)));
            if step > 0 {
                elements.push(Element::Segment([next - 1, next]));
            }
            next += 1;
        }
    }
    Soup::new(positions, elements)
}

/// A point of the knot with two directions across it.
struct Frame {
    origin: Point3<f64>,
    outwards: Vector3<f64>,
    sideways: Vector3<f64>,
}

impl Frame {
    /// The normal of the torus is perpendicular to any curve on it, and closes up where the curve does.
    fn at(t: f64) -> Self {
        let (sin_long, cos_long) = (2.0 * t).sin_cos();
        let (sin_short, cos_short) = (3.0 * t).sin_cos();
        let radius = MAJOR_RADIUS + MINOR_RADIUS * cos_short;
        let origin = Point3::new(radius * cos_long, radius * sin_long, MINOR_RADIUS * sin_short);
        let outwards = Vector3::new(cos_short * cos_long, cos_short * sin_long, sin_short);
        let around = Vector3::new(-sin_long, cos_long, 0.0) * (2.0 * radius);
        let across = Vector3::new(-sin_short * cos_long, -sin_short * sin_long, cos_short) * (3.0 * MINOR_RADIUS);
        let sideways = (around + across).normalize().cross(&outwards);
        Self { origin, outwards, sideways }
    }

    fn around(&self, radius: f64, angle: f64) -> Point3<f64> {
        let (sin, cos) = angle.sin_cos();
        let p = self.origin + (self.outwards * cos + self.sideways * sin) * radius;
        // Adding zero turns -0 into 0.
        p.map(|x| (x * 1e5).round() / 1e5 + 0.0)
    }
}
