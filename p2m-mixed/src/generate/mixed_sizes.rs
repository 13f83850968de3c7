//! Triangles, segments and points of sizes over several orders of magnitude, distributed in a cube.

use super::error::{GenerateError, capacity, in_range};
use super::portable::Random;
use nalgebra::{Point3, Vector3};
use p2m_core::{Element, Soup};

/// Options of [`mixed_sizes`]. The default makes 6,000 triangles, 3,000 segments and 1,000 points over six decades.
///
/// ```
/// use p2m_mixed::generate::{MixedSizes, mixed_sizes};
///
/// let soup = mixed_sizes(&MixedSizes { points: 10, decades: 3.0, ..Default::default() }).unwrap();
/// assert_eq!((soup.triangles().len(), soup.segments().len(), soup.points().len()), (6000, 3000, 10));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MixedSizes {
    /// The number of triangles.
    pub triangles: u32,
    /// The number of segments.
    pub segments: u32,
    /// The number of points.
    pub points: u32,
    /// The orders of magnitude between the smallest and the largest size, from 0 to 12.
    pub decades: f64,
    /// The seed of the random numbers.
    pub seed: u64,
}

impl Default for MixedSizes {
    fn default() -> Self {
        Self { triangles: 6000, segments: 3000, points: 1000, decades: 6.0, seed: 1 }
    }
}

/// The size of the largest primitives.
const LARGEST_SIZE: f64 = 0.5;

/// Makes primitives of random shape in random order, without shared vertices.
///
/// The centres are uniformly distributed in the cube from -1 to 1. The vertices of a primitive are on a sphere about
/// its centre: three random points for a triangle, two opposite points for a segment. The radius of the sphere is the
/// size of the primitive. It is at most 1/2, and its logarithm is uniformly distributed.
///
/// # Errors
/// [`GenerateError`] if an option is not in its range or there are more primitives than ids.
pub fn mixed_sizes(options: &MixedSizes) -> Result<Soup<f64>, GenerateError> {
    let &MixedSizes { triangles, segments, points, decades, seed } = options;
    // Beyond 12, the smallest sizes would be a few units in the last place of the coordinates.
    in_range((0.0..=12.0).contains(&decades), "decades", decades, "from 0 to 12")?;
    let kinds = [triangles, segments, points].map(u64::from);
    capacity(kinds.iter().copied().map(u128::from).sum())?;

    let mut random = Random::new(seed);
    let mut positions: Vec<Point3<f64>> = Vec::new();
    let mut elements = Vec::new();
    let mut first = 0;
    let [mut triangles, mut segments, mut points] = kinds;
    while triangles + segments + points > 0 {
        let centre = Point3::from(Vector3::from_fn(|_, _| 2.0 * random.unit() - 1.0));
        let size = LARGEST_SIZE * libm::exp10(-decades * random.unit());
        // Kinds are drawn without replacement, so the numbers of the options are met.
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

/// Returns a uniformly distributed unit vector.
fn direction(random: &mut Random) -> Vector3<f64> {
    loop {
        let v = random.in_ball();
        // Vectors near the centre are rejected, because they have few significant digits.
        if v.norm_squared() > 1e-6 {
            return v.normalize();
        }
    }
}
