//! A bundle of twisted strands along a knot, which consists of segments.

use super::error::{GenerateError, at_least, capacity, in_range};
use super::knot::Frame;
use super::portable::SinCos;
use p2m_core::{Element, Soup};

/// Options of [`cable_bundle`]. The default makes 64 strands of 256 segments.
///
/// ```
/// use p2m_mixed::generate::{CableBundle, cable_bundle};
///
/// let bundle = cable_bundle(&CableBundle { strands: 7, segments: 100, ..Default::default() }).unwrap();
/// assert_eq!((bundle.positions().len(), bundle.segments().len()), (707, 700));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CableBundle {
    /// The number of strands, at least 1.
    pub strands: u32,
    /// The number of segments of each strand, at least 1.
    pub segments: u32,
    /// The number of turns of the bundle about itself, from -1000 to 1000.
    pub twists: f64,
    /// The radius of the bundle. The torus of the knot has the radii 2 and 0.8.
    pub radius: f64,
}

impl Default for CableBundle {
    fn default() -> Self {
        Self { strands: 64, segments: 256, twists: 12.0, radius: 0.3 }
    }
}

/// The golden angle, in turns. Strands at its multiples fill a disc evenly.
const GOLDEN_TURN: f64 = 0.381_966_011_250_105_1;
/// The fraction of the trefoil that the bundle follows. The bundle is open, because its strands would not close.
const KNOT_FRACTION: f64 = 0.95;

/// Makes strands that wind about a trefoil knot. Each strand is a polyline, and the segments of a
/// strand are consecutive.
///
/// # Errors
/// [`GenerateError`] if an option is not in its range or there are more primitives than ids.
pub fn cable_bundle(options: &CableBundle) -> Result<Soup<f64>, GenerateError> {
    let &CableBundle { strands, segments, twists, radius } = options;
    at_least(1, "strands", strands)?;
    at_least(1, "segments", segments)?;
    in_range((-1e3..=1e3).contains(&twists), "twists", twists, "from -1000 to 1000")?;
    in_range(radius > 0.0 && radius <= 1e3, "radius", radius, "above 0 and at most 1000")?;
    let len = capacity(u128::from(strands) * u128::from(segments))?;

    let mut positions = Vec::with_capacity(len + strands as usize);
    for strand in 0..strands {
        let area_fraction = (f64::from(strand) + 0.5) / f64::from(strands);
        let (distance, phase) = (radius * area_fraction.sqrt(), GOLDEN_TURN * f64::from(strand));
        positions.extend((0..=segments).map(|step| {
            let s = f64::from(step) / f64::from(segments);
            Frame::at(2, 3, KNOT_FRACTION * s).around(distance, SinCos::of_turns(phase + twists * s))
        }));
    }
    let elements = (0..strands).flat_map(|strand| {
        let first = strand * (segments + 1);
        (first..first + segments).map(|i| Element::Segment([i, i + 1]))
    });
    Ok(Soup::new(positions, elements)?)
}
