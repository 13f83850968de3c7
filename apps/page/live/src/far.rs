//! The scene in f32, a million units from the origin.

use crate::ordinary;
use p2m::nalgebra::{Point3, Vector3};
use p2m::{AabbTree, ClosestPoint, PrimitiveSet, Soup};
use std::sync::Arc;

/// The offset of the scene in each coordinate, which is a million units from the origin. Numbers of f32 are 1/16 apart
/// there.
pub const OFFSET: f64 = 577_350.25;
/// The least longest side of the scene, in units. A smaller scene is enlarged by a power of two, because vertices that
/// are 1/16 apart would not resemble it.
const MIN_SIDE: f64 = 16.0;
/// The largest longest side of the scene, in units. A larger scene is reduced by a power of two, because it would leave
/// the range in which numbers are 1/16 apart.
const MAX_SIDE: f64 = 65536.0;

/// An answer far from the origin, beside that of ordinary arithmetic. All of it is in the frame of the scene.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct FarAnswer {
    /// The query as f32 represents it.
    pub query: Point3<f64>,
    /// The closest point in p2m, from the weights of the vertices of its primitive.
    pub point: Point3<f64>,
    /// The distance in p2m.
    pub distance: f64,
    /// The closest point in ordinary arithmetic.
    pub ordinary_point: Point3<f64>,
    /// The distance in ordinary arithmetic.
    pub ordinary_distance: f64,
    /// The distance in f64, of the same vertices and the same query.
    pub true_distance: f64,
}

impl FarAnswer {
    /// The number of values of an answer as an array.
    pub const LEN: usize = 12;

    /// Returns the values in the order of the fields.
    #[must_use]
    pub fn values(&self) -> [f64; Self::LEN] {
        let [query, point, other] = [self.query, self.point, self.ordinary_point].map(<[f64; 3]>::from);
        let mut values = [0.0; Self::LEN];
        for (part, (vector, number)) in values.chunks_exact_mut(4).zip([
            (query, self.true_distance),
            (point, self.distance),
            (other, self.ordinary_distance),
        ]) {
            part[..3].copy_from_slice(&vector);
            part[3] = number;
        }
        values
    }
}

/// A scene whose vertices are rounded to f32 after it was moved away from the origin, with trees in f32 and in f64.
pub struct FarScene {
    scale: f64,
    centre: Point3<f64>,
    index: AabbTree<f32, Soup<f32>>,
    exact: AabbTree<f64, Arc<Soup<f64>>>,
}

impl FarScene {
    /// Moves a scene. `None` stands for an empty scene, and for one that f32 cannot represent.
    pub(crate) fn new(soup: &Soup<f64>) -> Option<Self> {
        let bounds = soup.aabb();
        if bounds.is_empty() {
            return None;
        }
        let side = (bounds.max - bounds.min).max();
        let scale = match side {
            ..MIN_SIDE if side > 0.0 => (MIN_SIDE / side).log2().ceil().exp2(),
            MAX_SIDE.. => (MAX_SIDE / side).log2().floor().exp2(),
            _ => 1.0,
        };
        let centre = Point3::from(bounds.min.coords * 0.5 + bounds.max.coords * 0.5);
        let moved: Vec<Point3<f32>> = soup.positions().iter().map(|p| rounded(p, &centre, scale)).collect();
        let widened = moved.iter().map(|p| p.cast::<f64>()).collect();
        let index = AabbTree::new(Soup::new(moved, soup.elements()).ok()?).ok()?;
        let widened = Arc::new(Soup::new(widened, soup.elements()).ok()?);
        let exact = AabbTree::new(widened).ok()?;
        Some(Self { scale, centre, index, exact })
    }

    /// Returns the factor by which the scene is scaled.
    #[must_use]
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// Answers a query, which is moved and rounded as the scene is.
    #[must_use]
    pub fn query(&self, query: &Point3<f64>) -> Option<FarAnswer> {
        let query = rounded(query, &self.centre, self.scale);
        let closest = self.index.closest_point(&query)?;
        let exact = self.exact.closest_point(&query.cast::<f64>())?;
        let (ordinary_point, ordinary_distance) = ordinary::closest_point(self.index.set(), &query)?;
        let vertices = self.exact.set().element(closest.primitive);
        let weighted = vertices.indices().iter().zip(closest.barycentric).map(|(&i, weight)| {
            // Weights of f32 add up to one only nearly, so the vertices are relative to a point near them.
            self.relative_to_centre(&self.exact.set().positions()[i as usize]) * f64::from(weight)
        });
        Some(FarAnswer {
            query: self.back(&query.cast()),
            point: self.centre + weighted.fold(Vector3::zeros(), |sum, part| sum + part),
            distance: f64::from(closest.distance) / self.scale,
            ordinary_point: self.back(&ordinary_point.cast()),
            ordinary_distance: f64::from(ordinary_distance) / self.scale,
            true_distance: exact.distance / self.scale,
        })
    }

    /// Returns a point far from the origin in the frame of the scene.
    fn back(&self, point: &Point3<f64>) -> Point3<f64> {
        self.centre + self.relative_to_centre(point)
    }

    /// Returns the vector from the centre of the scene to a point far from the origin, in the unit of the scene.
    fn relative_to_centre(&self, point: &Point3<f64>) -> Vector3<f64> {
        point.coords.map(|x| (x - OFFSET) / self.scale)
    }
}

#[allow(clippy::cast_possible_truncation, reason = "the loss of digits is what the page shows")]
fn rounded(point: &Point3<f64>, centre: &Point3<f64>, scale: f64) -> Point3<f32> {
    Point3::from(std::array::from_fn(|k| ((point[k] - centre[k]) * scale + OFFSET) as f32))
}

#[cfg(test)]
mod tests {
    use super::FarScene;
    use crate::scene::tests::{live, queries};
    use p2m::nalgebra::{Point3, Vector3};
    use p2m::{Element, Soup};

    /// Scenes that are large, tiny or far from the origin themselves are treated as any other.
    #[test]
    fn the_closest_point_is_where_the_distance_says() {
        for (size, origin) in [(1.0, 0.0), (1.0, 1e6), (1e20, 0.0), (1e20, 3e22), (1e-200, 0.0), (1e200, 0.0)] {
            let at = |x: f64, y: f64, z: f64| Point3::from(Vector3::repeat(origin) + Vector3::new(x, y, z) * size);
            let positions = vec![at(0.0, 0.0, 0.0), at(1.0, 0.1, 0.0), at(0.0, 1.0, 0.3)];
            let soup = Soup::new(positions, [Element::Triangle([0, 1, 2])]).unwrap();
            let far = FarScene::new(&soup).unwrap();
            for query in [at(0.3, 0.2, 0.9), at(1.4, 1.1, 0.2), at(-0.4, 0.2, -0.3)] {
                let answer = far.query(&query).unwrap();
                let measured = ((answer.point - answer.query) / size).norm();
                let rounding = 2.0 * f64::EPSILON * origin / size;
                assert!(
                    (measured - answer.true_distance / size).abs() <= 1e-6 + rounding,
                    "{size} {origin} {answer:?}"
                );
                assert!((answer.distance / answer.true_distance - 1.0).abs() <= f64::from(f32::EPSILON), "{answer:?}");
            }
        }
    }

    /// A city of some kilometres keeps its size, so ordinary arithmetic is off by a part of 1/16 of its unit.
    #[test]
    fn only_tiny_and_huge_scenes_are_scaled() {
        for (side, scale) in
            [(0.75, 32.0), (8.0, 2.0), (16.0, 1.0), (3000.0, 1.0), (65536.0, 1.0), (1e5, 0.5), (3e5, 0.125)]
        {
            let positions = vec![Point3::origin(), Point3::new(side, 0.0, 0.0), Point3::new(0.0, side, 0.0)];
            let soup = Soup::new(positions, [Element::Triangle([0, 1, 2])]).unwrap();
            assert_eq!(FarScene::new(&soup).unwrap().scale(), scale, "{side}");
        }
    }

    #[test]
    fn distances_far_away_are_accurate_where_those_of_ordinary_arithmetic_jump() {
        let mut live = live();
        let scale = live.build_far().unwrap();
        assert_eq!(scale, 2.0);
        let far = live.far().unwrap();
        let mut worst = 0.0f64;
        for query in queries() {
            let answer = far.query(&query).unwrap();
            // Half a spacing of f32, in each coordinate.
            assert!((answer.query - query).amax() <= 1.0 / 32.0 / scale);
            // The unit roundoff of f32 twice: for the distance, and for the frame of the page.
            let bound = f64::from(f32::EPSILON) * answer.true_distance;
            assert!((answer.distance - answer.true_distance).abs() <= bound, "{answer:?}");
            let measured = (answer.point - answer.query).norm();
            assert!((measured - answer.true_distance).abs() <= 16.0 * f64::from(f32::EPSILON) * 16.0, "{answer:?}");
            worst = worst.max((answer.ordinary_distance - answer.true_distance).abs());
        }
        assert!(worst > 0.01, "{worst}");
    }
}
