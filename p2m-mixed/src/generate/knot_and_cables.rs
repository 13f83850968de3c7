//! A knotted tube of triangles with cables of segments around it.

use super::error::{GenerateError, capacity};
use super::knot::{Frame, tube, tube_elements};
use super::portable::SinCos;
use nalgebra::Point3;
use p2m_core::{Element, Soup};

/// Options of [`knot_and_cables`]. The default makes the scene of `scenes/knot_and_cables.obj`.
///
/// ```
/// use p2m_mixed::generate::{KnotAndCables, knot_and_cables};
///
/// let scene = knot_and_cables(&KnotAndCables { cables: 2, ..Default::default() }).unwrap();
/// assert_eq!((scene.triangles().len(), scene.segments().len()), (3600, 192));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct KnotAndCables {
    /// The number of rings along the knot, at least 3.
    pub rings: u32,
    /// The number of vertices of each ring, at least 3. There are two triangles for each vertex.
    pub sides: u32,
    /// The number of cables.
    pub cables: u32,
    /// The number of segments of each cable, at least 1.
    pub cable_segments: u32,
}

impl Default for KnotAndCables {
    fn default() -> Self {
        Self { rings: 150, sides: 12, cables: 5, cable_segments: 96 }
    }
}

/// The turns of the knot around the axis of its torus and around its tube.
const KNOT: (u32, u32) = (2, 3);
const TUBE_RADIUS: f64 = 0.3;

/// Makes a closed tube of triangles along a (2, 3) torus knot, and cables of segments that wind around it and leave it.
///
/// The triangles of the tube come first, counter-clockwise seen from outside, and then the segments, cable after cable.
/// Coordinates are within 4 of the origin and rounded to five decimals. Options below their minimum are raised to it.
///
/// # Errors
/// [`GenerateError`] if there are more primitives than ids, or they do not fit into memory.
pub fn knot_and_cables(options: &KnotAndCables) -> Result<Soup<f64>, GenerateError> {
    let (rings, sides) = (options.rings.max(3), options.sides.max(3));
    let (cables, steps) = (options.cables, options.cable_segments.max(1));
    capacity(2 * u128::from(rings) * u128::from(sides) + u128::from(cables) * u128::from(steps))?;

    let (p, q) = KNOT;
    let mut positions: Vec<_> = tube(p, q, rings, sides, TUBE_RADIUS).map(rounded).collect();
    let mut elements: Vec<_> = tube_elements(rings, sides).collect();
    let mut next = rings * sides;
    for cable in 0..cables {
        let phase = f64::from(cable) / f64::from(cables);
        for step in 0..=steps {
            // A cable starts near the tube, winds twice around it in a third of the knot, and moves outwards ever
            // faster.
            let s = f64::from(step) / f64::from(steps);
            let radius = TUBE_RADIUS * (1.15 + 0.15 * f64::from(cable % 3) + 2.0 * s * s * s);
            let angle = SinCos::of_turns(phase + 4.0 * s);
            positions.push(rounded(Frame::at(p, q, phase + 0.6 * s).around(radius, angle)));
            if step > 0 {
                elements.push(Element::Segment([next - 1, next]));
            }
            next += 1;
        }
    }
    Ok(Soup::new(positions, elements)?)
}

/// Rounds to five decimals, which keeps files short.
fn rounded(p: Point3<f64>) -> Point3<f64> {
    // The sum of -0 and 0 is 0.
    p.map(|x| (x * 1e5).round() / 1e5 + 0.0)
}
