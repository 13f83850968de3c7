//! Query points and rays: given points, a grid, or random points and rays around the scene.

use chacha20::ChaCha8Rng;
use nalgebra::{Point3, Vector3};
use p2m_core::{Aabb, Ray};
use rand::{Rng, SeedableRng};

/// The size of the box of queries, in boxes of the scene, unless an option says another one.
pub(crate) const BOX_SCALE: f64 = 1.05;
/// The largest number of points by which an index is chosen.
const MAX_SAMPLE_POINTS: usize = 1024;

/// The box that queries are in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Region {
    min: [f64; 3],
    max: [f64; 3],
    /// The centre of the box of the scene. The middle of the rounded ends may be another point.
    centre: [f64; 3],
}

impl Region {
    /// Returns the box of a scene, scaled about its centre. For an empty one it is the unit cube around the origin.
    ///
    /// An axis without extent would put every query into the plane of the scene. The box is widened along it, to each
    /// side by as much as the scale adds to the longest axis, or for a single point by as much as it would add to an
    /// axis of length 1.
    pub(crate) fn around(bounds: &Aabb<f64>, scale: f64) -> Self {
        let (min, max): ([f64; 3], [f64; 3]) = if bounds.is_empty() {
            ([-0.5; 3], [0.5; 3])
        } else {
            (bounds.min.coords.into(), bounds.max.coords.into())
        };
        // Numbers are halved first, because the sum and the difference of two finite numbers may overflow.
        let half: [f64; 3] = std::array::from_fn(|k| max[k] / 2.0 - min[k] / 2.0);
        let longest = half.iter().fold(0.0f64, |a, &b| a.max(b));
        let reference = if longest > 0.0 { longest } else { 0.5 };
        let centre: [f64; 3] = std::array::from_fn(|k| midpoint(min[k], max[k]));
        let side = |k: usize, sign: f64| {
            let half_side = if half[k] > 0.0 { half[k] * scale } else { reference * (scale - 1.0).max(0.0) };
            (centre[k] + sign * half_side).clamp(f64::MIN, f64::MAX)
        };
        Self { min: std::array::from_fn(|k| side(k, -1.0)), max: std::array::from_fn(|k| side(k, 1.0)), centre }
    }

    /// Returns the point at fractions `t` of the sides. It is exact for 0 and 1.
    fn at(&self, t: [f64; 3]) -> Point3<f64> {
        Point3::from(std::array::from_fn(|k| self.min[k] * (1.0 - t[k]) + self.max[k] * t[k]))
    }
}

/// A sequence of query points, which are computed as they are needed.
pub(crate) struct Queries {
    points: Box<dyn Iterator<Item = Point3<f64>>>,
    /// The number of points that remain.
    left: u64,
}

impl Queries {
    /// Returns given points.
    pub(crate) fn list(points: Vec<Point3<f64>>) -> Self {
        Self { left: points.len() as u64, points: Box::new(points.into_iter()) }
    }

    /// Returns a grid of `side` points along each axis, ends included; z runs fastest, then y. `side` is at most 2^21.
    pub(crate) fn grid(region: Region, side: u64) -> Self {
        let t = move |index: u64| fraction(index % side, side - 1);
        let point = move |i| match side {
            1 => Point3::from(region.centre),
            _ => region.at([t(i / (side * side)), t(i / side), t(i)]),
        };
        let left = side * side * side;
        Self { left, points: Box::new((0..left).map(point)) }
    }

    /// Returns `count` uniformly distributed points. A seed gives the same points on every machine.
    pub(crate) fn random(region: Region, count: u64, seed: u64) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let point = move |_| region.at(std::array::from_fn(|_| unit(&mut rng)));
        Self { left: count, points: Box::new((0..count).map(point)) }
    }

    /// Returns some of the points, by which an index is chosen.
    pub(crate) fn sample_of(points: &[Point3<f64>]) -> Vec<Point3<f64>> {
        points.iter().step_by(points.len().div_ceil(MAX_SAMPLE_POINTS).max(1)).copied().collect()
    }

    /// Returns points of a region, by which an index is chosen.
    pub(crate) fn sample(region: Region) -> Vec<Point3<f64>> {
        Self::random(region, 512, 0).collect()
    }

    /// Returns the number of points that remain.
    pub(crate) fn len(&self) -> u64 {
        self.left
    }
}

impl Iterator for Queries {
    type Item = Point3<f64>;

    fn next(&mut self) -> Option<Point3<f64>> {
        let point = self.points.next()?;
        self.left -= 1;
        Some(point)
    }
}

/// Returns `count` rays. Their origins are the points of [`Queries::random`], and their directions are uniformly
/// distributed on the unit sphere. A seed gives the same rays on every machine.
pub(crate) fn random_rays(region: Region, count: u64, seed: u64) -> impl Iterator<Item = Ray> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    // Directions are independent of origins.
    rng.set_stream(1);
    Queries::random(region, count, seed)
        .map(move |origin| Ray::new(&origin, &direction(&mut rng)).expect("finite, and of length 1"))
}

/// Returns a random unit vector, computed from a point of the unit disk \[Marsaglia1972\]. That needs no functions
/// whose results differ between platforms.
fn direction(rng: &mut ChaCha8Rng) -> Vector3<f64> {
    loop {
        let [u, v] = std::array::from_fn(|_| 2.0 * unit(rng) - 1.0);
        let square = u * u + v * v;
        if square < 1.0 {
            let scale = 2.0 * (1.0 - square).sqrt();
            return Vector3::new(u * scale, v * scale, 1.0 - 2.0 * square);
        }
    }
}

/// From 0 to below 1.
fn unit(rng: &mut ChaCha8Rng) -> f64 {
    fraction(rng.next_u64() >> 11, 1 << 53)
}

/// The number halfway between two others, rounded once unless it is subnormal or the sum would overflow.
fn midpoint(a: f64, b: f64) -> f64 {
    let sum = a + b;
    if sum.is_finite() { sum / 2.0 } else { a / 2.0 + b / 2.0 }
}

/// `a / b` for numbers up to 2^53.
#[allow(clippy::cast_precision_loss, reason = "exact up to 2^53")]
fn fraction(a: u64, b: u64) -> f64 {
    a as f64 / b as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bounds(points: &[[f64; 3]]) -> Aabb<f64> {
        Aabb::from_points(&points.iter().map(|&point| Point3::from(point)).collect::<Vec<_>>())
    }

    /// Checks the number of points, and returns them.
    fn all(queries: Queries) -> Vec<Point3<f64>> {
        let count = queries.len();
        let all: Vec<_> = queries.collect();
        assert_eq!(all.len() as u64, count);
        all
    }

    #[test]
    fn the_box_is_scaled_about_its_centre() {
        let region = Region::around(&bounds(&[[0.0, 0.0, 0.0], [2.0, 4.0, 8.0]]), 1.5);
        assert_eq!(region, Region { min: [-0.5, -1.0, -2.0], max: [2.5, 5.0, 10.0], centre: [1.0, 2.0, 4.0] });
    }

    #[test]
    fn an_axis_without_extent_is_widened() {
        let region = Region::around(&bounds(&[[0.0, 7.0, 0.0], [2.0, 7.0, 8.0]]), 1.5);
        assert_eq!(region, Region { min: [-0.5, 5.0, -2.0], max: [2.5, 9.0, 10.0], centre: [1.0, 7.0, 4.0] });
        let region = Region::around(&bounds(&[[3.0, 3.0, 3.0]]), 1.5);
        assert_eq!(region, Region { min: [2.75; 3], max: [3.25; 3], centre: [3.0; 3] });
        let region = Region::around(&Aabb::empty(), 1.0);
        assert_eq!(region, Region { min: [-0.5; 3], max: [0.5; 3], centre: [0.0; 3] });
    }

    #[test]
    fn boxes_of_any_size_give_finite_queries() {
        let far = Region::around(&bounds(&[[f64::MIN; 3], [f64::MAX; 3]]), 1.05);
        let queries = all(Queries::random(far, 100, 0));
        assert!(queries.iter().flat_map(|p| p.iter()).all(|x| x.is_finite()));
    }

    #[test]
    fn grids_run_along_z_first_and_hit_the_corners() {
        let region = Region { min: [0.1, 0.2, 0.3], max: [1.1, 2.2, 3.3], centre: [0.6, 1.2, 1.8] };
        let points = all(Queries::grid(region, 3));
        assert_eq!(points.len(), 27);
        assert_eq!(points[0], Point3::new(0.1, 0.2, 0.3));
        assert_eq!(points[2], Point3::new(0.1, 0.2, 3.3));
        assert_eq!(points[26], Point3::new(1.1, 2.2, 3.3));
    }

    #[test]
    fn a_grid_of_one_is_the_centre_of_the_scene() {
        for (a, b) in [(0.0, 2.0), (0.1, 0.3), (1.0, 1.0 + 4.0 * f64::EPSILON), (1e300, 1.5e300), (f64::MAX, f64::MAX)]
        {
            for scale in [0.3, 1.0, 1.05, 7.7] {
                let region = Region::around(&bounds(&[[a; 3], [b; 3]]), scale);
                let expected = if a == f64::MAX { f64::MAX } else { (a + b) / 2.0 };
                assert_eq!(all(Queries::grid(region, 1)), [Point3::from([expected; 3])], "{a} {b} {scale}");
            }
        }
    }

    #[test]
    fn random_points_depend_on_the_seed_alone() {
        let region = Region { min: [-1.0; 3], max: [1.0; 3], centre: [0.0; 3] };
        let points = all(Queries::random(region, 1000, 5));
        assert_eq!(all(Queries::random(region, 1000, 5)), points);
        assert_ne!(all(Queries::random(region, 1000, 6)), points);
        assert!(points.iter().flat_map(|p| p.iter()).all(|x| x.abs() <= 1.0));
        let mean: f64 = points.iter().map(|p| p.x + p.y + p.z).sum::<f64>() / 3000.0;
        assert!(mean.abs() < 0.05, "{mean}");
    }
    #[test]
    fn random_rays_go_everywhere_from_random_points() {
        let region = Region { min: [-1.0; 3], max: [1.0; 3], centre: [0.0; 3] };
        let rays: Vec<_> = random_rays(region, 3000, 5).collect();
        assert!(rays.iter().map(Ray::origin).eq(Queries::random(region, 3000, 5)));
        assert!(rays.iter().all(|ray| (ray.direction().norm() - 1.0).abs() < 1e-15));
        assert_ne!(rays[0].direction(), random_rays(region, 1, 6).next().unwrap().direction());
        // A third of the unit sphere's points in each third along any axis.
        for axis in 0..3 {
            let low = rays.iter().filter(|ray| ray.direction()[axis] < -1.0 / 3.0).count();
            let high = rays.iter().filter(|ray| ray.direction()[axis] > 1.0 / 3.0).count();
            assert!((900..1100).contains(&low) && (900..1100).contains(&high), "{low} {high}");
        }
    }
}
