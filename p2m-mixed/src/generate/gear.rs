//! A gear whose triangles are nearly all slivers. It is a hard case for boxes, and for k-DOPs with unsuitable
//! directions.

use super::error::{GenerateError, at_least, capacity};
use super::portable::SinCos;
use nalgebra::Point3;
use p2m_core::{Element, Soup};

/// Options of [`skewed_gear`]. The default makes 28,348 vertices and 56,696 triangles.
///
/// ```
/// use p2m_mixed::generate::{SkewedGear, Transform, skewed_gear};
///
/// let gear = skewed_gear(&SkewedGear { points: 37, ..Default::default() }).unwrap();
/// assert_eq!((gear.positions().len(), gear.triangles().len()), (19 * 37 * 4, 19 * 37 * 8));
/// let turned = Transform::default().rotated_x(45.0).rotated_y(45.0).apply(&gear).unwrap();
/// assert_eq!(turned.triangles(), gear.triangles());
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SkewedGear {
    /// The number of teeth, at least 3.
    pub teeth: u32,
    /// The number of points of the outline for each tooth, at least 4. More points make thinner triangles.
    pub points: u32,
}

impl Default for SkewedGear {
    fn default() -> Self {
        Self { teeth: 19, points: 373 }
    }
}

const BORE_RADIUS: f64 = 25.0;
const ROOT_RADIUS: f64 = 46.0;
const TIP_RADIUS: f64 = 52.0;
const HEIGHT: f64 = 24.0;
/// The rotation of the upper face relative to the lower one, in turns. It is 18 degrees.
const TWIST: f64 = 0.05;

/// Makes a helical gear with a bore around the z axis, whose lower face is at z = 0 and whose upper face is at z = 24.
///
/// Outline and bore have the same number of points, and every triangle spans the height of the gear or the distance
/// from bore to outline. By default nine of ten triangles have an aspect of 380 to 1250, and the median is 950. The
/// surface is closed, of genus 1, and counter-clockwise seen from outside. The faces are exactly planar.
///
/// # Errors
/// [`GenerateError`] if an option is not in its range or there are more primitives than ids.
pub fn skewed_gear(options: &SkewedGear) -> Result<Soup<f64>, GenerateError> {
    let &SkewedGear { teeth, points } = options;
    at_least(3, "teeth", teeth)?;
    at_least(4, "points", points)?;
    capacity(8 * u128::from(teeth) * u128::from(points))?;
    let around = teeth * points;

    // The four rings are lower outline, upper outline, upper bore and lower bore. Each is connected to the next.
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

/// Returns the radius at a point of a tooth, of which root, rising flank, tip and falling flank are a quarter each.
fn outline(point: u32, points: u32) -> f64 {
    let quarters = 4.0 * f64::from(point) / f64::from(points);
    let rise = if quarters < 3.0 { quarters - 1.0 } else { 4.0 - quarters };
    ROOT_RADIUS + (TIP_RADIUS - ROOT_RADIUS) * rise.clamp(0.0, 1.0)
}
