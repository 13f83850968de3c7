//! Solids of revolution around the z axis: sphere, cone and cylinder.

use super::error::{GenerateError, at_least, capacity};
use super::portable::SinCos;
use nalgebra::Point3;
use p2m_core::Soup;

/// Options of [`sphere`]. The default makes 12,480 triangles.
///
/// ```
/// use p2m_mixed::generate::{Sphere, sphere};
///
/// let ball = sphere(&Sphere { meridians: 24, bands: 10 }).unwrap();
/// assert_eq!((ball.positions().len(), ball.triangles().len()), (24 * 9 + 2, 2 * 24 * 9));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sphere {
    /// The number of vertices of each parallel, at least 3.
    pub meridians: u32,
    /// The number of bands between parallels, including the two at the poles, at least 2.
    pub bands: u32,
}

impl Default for Sphere {
    fn default() -> Self {
        Self { meridians: 80, bands: 79 }
    }
}

/// Options of [`cone`]. The default makes 12,400 triangles.
///
/// ```
/// use p2m_mixed::generate::{Cone, cone};
///
/// let cone = cone(&Cone { sides: 6, bands: 1, cap_bands: 1 }).unwrap();
/// assert_eq!((cone.positions().len(), cone.triangles().len()), (8, 12));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Cone {
    /// The number of vertices around the axis, at least 3.
    pub sides: u32,
    /// The number of bands of the slope, including the one at the apex, at least 1.
    pub bands: u32,
    /// The number of rings of triangles of the base, at least 1.
    pub cap_bands: u32,
}

impl Default for Cone {
    fn default() -> Self {
        Self { sides: 100, bands: 43, cap_bands: 20 }
    }
}

/// Options of [`cylinder`]. The default makes 12,200 triangles.
///
/// ```
/// use p2m_mixed::generate::{Cylinder, cylinder};
///
/// let can = cylinder(&Cylinder { sides: 6, bands: 1, cap_bands: 1 }).unwrap();
/// assert_eq!((can.positions().len(), can.triangles().len()), (14, 24));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Cylinder {
    /// The number of vertices around the axis, at least 3.
    pub sides: u32,
    /// The number of bands of the wall, at least 1.
    pub bands: u32,
    /// The number of rings of triangles of each cap, at least 1.
    pub cap_bands: u32,
}

impl Default for Cylinder {
    fn default() -> Self {
        Self { sides: 100, bands: 32, cap_bands: 15 }
    }
}

/// Makes the unit sphere by latitude and longitude. It has 2 `meridians` (`bands` - 1) triangles, which are thin
/// at the poles.
///
/// # Errors
/// [`GenerateError`] if an option is not in its range or there are more primitives than ids.
pub fn sphere(options: &Sphere) -> Result<Soup<f64>, GenerateError> {
    let &Sphere { meridians, bands } = options;
    at_least(3, "meridians", meridians)?;
    at_least(2, "bands", bands)?;
    check_size(meridians, &[bands])?;
    let parallel = |i: u32| {
        // The bands divide half a turn evenly.
        let SinCos { sin, cos } = SinCos::of_fraction(u64::from(i), 2 * bands);
        (sin, 0.0 - cos)
    };
    revolve(meridians, (1..bands).map(parallel))
}

/// Makes a closed cone of radius 1 from its base at z = -1 to its apex at z = 1. It has
/// `sides` (2 `bands` + 2 `cap_bands` - 2) triangles.
///
/// # Errors
/// [`GenerateError`] if an option is not in its range or there are more primitives than ids.
pub fn cone(options: &Cone) -> Result<Soup<f64>, GenerateError> {
    let &Cone { sides, bands, cap_bands } = options;
    check_sides_and_bands(sides, bands, cap_bands)?;
    check_size(sides, &[bands, cap_bands])?;
    let base = (1..=cap_bands).map(|i| (ratio(i, cap_bands), -1.0));
    let slope = (1..bands).map(|i| (ratio(bands - i, bands), 2.0 * ratio(i, bands) - 1.0));
    revolve(sides, base.chain(slope))
}

/// Makes a closed cylinder of radius 1 from z = -1 to z = 1. It has `sides` (2 `bands` + 4 `cap_bands` - 2) triangles.
///
/// # Errors
/// [`GenerateError`] if an option is not in its range or there are more primitives than ids.
pub fn cylinder(options: &Cylinder) -> Result<Soup<f64>, GenerateError> {
    let &Cylinder { sides, bands, cap_bands } = options;
    check_sides_and_bands(sides, bands, cap_bands)?;
    check_size(sides, &[bands, cap_bands, cap_bands])?;
    let base = (1..=cap_bands).map(|i| (ratio(i, cap_bands), -1.0));
    let wall = (1..bands).map(|i| (1.0, 2.0 * ratio(i, bands) - 1.0));
    let lid = (0..cap_bands).map(|i| (ratio(cap_bands - i, cap_bands), 1.0));
    revolve(sides, base.chain(wall).chain(lid))
}

fn ratio(part: u32, whole: u32) -> f64 {
    f64::from(part) / f64::from(whole)
}

fn check_sides_and_bands(sides: u32, bands: u32, cap_bands: u32) -> Result<(), GenerateError> {
    at_least(3, "sides", sides)?;
    at_least(1, "bands", bands)?;
    at_least(1, "cap bands", cap_bands)
}

/// Checks the number of primitives. `bands` has the numbers of bands from pole to pole, and there is one ring fewer
/// than bands.
fn check_size(sides: u32, bands: &[u32]) -> Result<(), GenerateError> {
    let bands: u128 = bands.iter().copied().map(u128::from).sum();
    capacity(2 * u128::from(sides) * (bands - 1)).map(drop)
}

/// Makes the closed surface from the lower pole over rings of given radius and height to the upper pole.
fn revolve(sides: u32, rings: impl Iterator<Item = (f64, f64)>) -> Result<Soup<f64>, GenerateError> {
    let mut positions = vec![Point3::new(0.0, 0.0, -1.0)];
    let mut triangles = Vec::new();
    let next = |side: u32| if side + 1 == sides { 0 } else { side + 1 };
    // `first` is the first vertex of the current ring.
    let mut first = 1;
    for (i, (radius, z)) in rings.enumerate() {
        if i > 0 {
            first += sides;
        }
        for side in 0..sides {
            let SinCos { sin, cos } = SinCos::of_fraction(u64::from(side), sides);
            positions.push(Point3::new(radius * cos, radius * sin, z));
            let [c, d] = [first + next(side), first + side];
            if i == 0 {
                triangles.push([0, c, d]);
            } else {
                let [a, b] = [d - sides, c - sides];
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
    }
    let pole = first + sides;
    positions.push(Point3::new(0.0, 0.0, 1.0));
    triangles.extend((0..sides).map(|side| [first + side, first + next(side), pole]));
    Ok(Soup::from_triangles(positions, triangles)?)
}
