//! A gear whose triangles are nearly all slivers: the hard case for boxes, and for k-DOPs whose directions miss it.

use super::error::{GenerateError, at_least, capacity};
use super::portable::SinCos;
use nalgebra::Point3;
use p2m_core::{Element, Soup};

/// What [`skewed_gear`] makes: by default 28,348 vertices and 56,696 triangles.
///
/// ```
/// use p2m_mixed::generate::{SkewedGear, Transform, skewed_gear};
///
/// let gear = skewed_gear(&SkewedGear::default().with_points(37)).unwrap();
/// assert_eq!((gear.positions().len(), gear.triangles().len()), (19 * 37 * 4, 19 * 37 * 8));
/// let turned = Transform::default().rotated_x(45.0).rotated_y(45.0).apply(&gear).unwrap();
/// assert_eq!(turned.triangles(), gear.triangles());
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct SkewedGear {
    /// Teeth; at least 3.
    pub teeth: u32,
    /// Points of the outline for each tooth; at least 4. The more, the thinner the triangles.
    pub points: u32,
}

impl Default for SkewedGear {
    fn default() -> Self {
        Self { teeth: 19, points: 373 }
    }
}

impl SkewedGear {
    /// With that many teeth.
    #[must_use]
    pub fn with_teeth(self, teeth: u32) -> Self {
        Self { teeth, ..self }
    }
    /// With that many points of the outline for each tooth.
    #[must_use]
    pub fn with_points(self, points: u32) -> Self {
        Self { points, ..self }
    }
}

const BORE_RADIUS: f64 = 25.0;
const ROOT_RADIUS: f64 = 46.0;
const TIP_RADIUS: f64 = 52.0;
const HEIGHT: f64 = 24.0;
/// By how much of a turn the upper face is turned against the lower one: 18 degrees.
const TWIST: f64 = 0.05;

/// A helical gear with a bore around the z axis, its lower face at z = 0 and its upper one at z = 24.
///
/// Outline and bore have the same number of points, and every triangle spans the height of the gear or the way from
/// bore to outline: by default nine of ten triangles are 380 to 1250 times as long as high, 950 in the median. Closed,
/// outside counter-clockwise, of genus 1. The faces are planar to the last bit.
///
/// # Errors
/// [`GenerateError`] if an option is not in its range or there are more primitives than ids.
pub fn skewed_gear(options: &SkewedGear) -> Result<Soup<f64>, GenerateError> {
    let &SkewedGear { teeth, points } = options;
    at_least(3, "teeth", teeth)?;
    at_least(4, "points", points)?;
    capacity(8 * u128::from(teeth) * u128::from(points))?;
    let around = teeth * points;

    // Four rings: lower outline, upper outline, upper bore, lower bore. Each is joined to the next.
    let mut positions = Vec::with_capacity(4 * around as usize);
    for (is_bore, is_upper) in [(false, false), (false, true), (true, true), (true, false)] {
        let twist = SinCos::of_turns(if is_upper { TWIST } else { 0.0 });
        let z = if is_upper { HEIGHT } else { 0.0 };
        positions.extend((0..around).map(|i| {
            let radius = if is_bore { BORE_RADIUS } else { outline(i % points, points) };
            let SinCos { sin, cos } = SinCos::of_fraction(u64::from(i), around);
            let [x, y] = [cos * twist.cos - sin * twist.sin, sin * twist.cos + cos * twist.sin];
            Point3::new(radius * x, radius * y, z)
        }));
    }
    let elements = (0..4u32).flat_map(|ring| {
        (0..around).flat_map(move |i| {
            let next = if i + 1 == around { 0 } else { i + 1 };
            let other = (ring + 1) % 4 * around;
            let [a, b, c, d] = [ring * around + i, ring * around + next, other + next, other + i];
            [Element::Triangle([a, b, c]), Element::Triangle([a, c, d])]
        })
    });
    Ok(Soup::new(positions, elements)?)
}

/// The radius at a point of a tooth: a quarter of it each is root, rising flank, tip and falling flank.
fn outline(point: u32, points: u32) -> f64 {
    let quarters = 4.0 * f64::from(point) / f64::from(points);
    let rise = if quarters < 3.0 { quarters - 1.0 } else { 4.0 - quarters };
    ROOT_RADIUS + (TIP_RADIUS - ROOT_RADIUS) * rise.clamp(0.0, 1.0)
}
