//! Triangles, segments and points of sizes over orders of magnitude, strewn over a cube.

use super::error::{GenerateError, capacity};
use super::portable::{Random, power_of_a_tenth};
use nalgebra::{Point3, Vector3};
use p2m_core::{Element, Soup};

/// What [`mixed_sizes`] makes: by default 6,000 triangles, 3,000 segments and 1,000 points over six decades.
///
/// ```
/// use p2m_mixed::generate::{MixedSizes, mixed_sizes};
///
/// let soup = mixed_sizes(&MixedSizes::default().with_points(10).with_decades(3.0)).unwrap();
/// assert_eq!((soup.triangles().len(), soup.segments().len(), soup.points().len()), (6000, 3000, 10));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct MixedSizes {
    /// Triangles.
    pub triangles: u32,
    /// Segments.
    pub segments: u32,
    /// Points.
    pub points: u32,
    /// The largest size is 10^`decades` times the least one; from 0 to 12.
    pub decades: f64,
    /// Another seed makes another scene.
    pub seed: u64,
}

impl Default for MixedSizes {
    fn default() -> Self {
        Self { triangles: 6000, segments: 3000, points: 1000, decades: 6.0, seed: 1 }
    }
}

impl MixedSizes {
    /// With that many triangles.
    #[must_use]
    pub fn with_triangles(self, triangles: u32) -> Self {
        Self { triangles, ..self }
    }
    /// With that many segments.
    #[must_use]
    pub fn with_segments(self, segments: u32) -> Self {
        Self { segments, ..self }
    }
    /// With that many points.
    #[must_use]
    pub fn with_points(self, points: u32) -> Self {
        Self { points, ..self }
    }
    /// With sizes over that many orders of magnitude.
    #[must_use]
    pub fn with_decades(self, decades: f64) -> Self {
        Self { decades, ..self }
    }
    /// From that seed.
    #[must_use]
    pub fn with_seed(self, seed: u64) -> Self {
        Self { seed, ..self }
    }
}

/// The size of the largest primitives.
const LARGEST: f64 = 0.5;

/// Primitives of random shape in random order, without shared vertices.
///
/// Their centres are uniform in the cube from -1 to 1. Each lies on a sphere about its centre whose radius, its size,
/// is at most 1/2 and has a uniform logarithm: three random places on it for a triangle, two opposite ones for a
/// segment.
///
/// # Errors
/// [`GenerateError`] if an option is not in its range or there are more primitives than ids.
pub fn mixed_sizes(options: &MixedSizes) -> Result<Soup<f64>, GenerateError> {
    let &MixedSizes { triangles, segments, points, decades, seed } = options;
    // Beyond 12, the least ones would be a few units in the last place of their coordinates.
    if !(0.0..=12.0).contains(&decades) {
        return Err(GenerateError::OutOfRange { option: "decades", value: decades, range: "from 0 to 12" });
    }
    let kinds = [triangles, segments, points].map(u64::from);
    capacity(kinds.iter().copied().map(u128::from).sum())?;

    let mut random = Random::new(seed);
    let mut positions: Vec<Point3<f64>> = Vec::new();
    let mut elements = Vec::new();
    let mut first = 0;
    let [mut triangles, mut segments, mut points] = kinds;
    while triangles + segments + points > 0 {
        let centre = Point3::from(Vector3::from_fn(|_, _| 2.0 * random.unit() - 1.0));
        let size = LARGEST * power_of_a_tenth(decades * random.unit());
        // Drawn without putting back: the numbers of the kinds come out as asked for.
        let draw = random.below(triangles + segments + points);
        if draw < triangles {
            triangles -= 1;
            positions.extend(std::iter::repeat_with(|| centre + direction(&mut random) * size).take(3));
            elements.push(Element::Triangle([first, first + 1, first + 2]));
            first += 3;
        } else if draw < triangles + segments {
            segments -= 1;
            let half = direction(&mut random) * size;
            positions.extend([centre - half, centre + half]);
            elements.push(Element::Segment([first, first + 1]));
            first += 2;
        } else {
            points -= 1;
            positions.push(centre);
            elements.push(Element::Point(first));
            first += 1;
        }
    }
    Ok(Soup::new(positions, elements)?)
}

/// Uniform on the unit sphere.
fn direction(random: &mut Random) -> Vector3<f64> {
    loop {
        let v = random.in_ball();
        // Away from the centre, where few digits are left.
        if v.norm_squared() > 1e-6 {
            return v.normalize();
        }
    }
}
