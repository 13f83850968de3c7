//! The query sets. All are generated in f64 from a fixed seed. Each set has its own random stream, so leaving one out
//! does not change the others.

use crate::depth::Cases;
use crate::surface::{SurfaceSampler, direction, normal};
use chacha20::ChaCha8Rng;
use nalgebra::{Point3, Vector3};
use p2m_core::{PrimitiveSet, Ray, Soup};
use rand::{RngExt, SeedableRng};

/// A distribution of queries. Percentages are relative to the diagonal of the scene's bounding box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum QuerySet {
    /// Uniform in the box scaled by 10 about its centre.
    Box10,
    /// Uniform in the box scaled by 1.05.
    Box1,
    /// Random points of the scene, offset along the normal by a normal distribution with sigma 1 %.
    Near,
    /// Random points of the scene, offset along the normal by a normal distribution with sigma 0.1 %.
    Nearer,
    /// Random points of the scene.
    Surface,
    /// A regular lattice over the box scaled by 1.05, with z running fastest, of about and at most the requested number
    /// of points.
    Grid,
    /// Uniform on the sphere of 100 diagonals about the centre.
    Far,
    /// Around 8 random points of the scene in random order, normally distributed in each coordinate with sigma 0.5 %.
    Cluster,
}

/// The number of clusters.
const CLUSTERS: usize = 8;

/// The number of the random stream for ray directions, relative to the stream for origins.
const DIRECTIONS: u64 = 1 << 32;

impl QuerySet {
    /// All sets, in the order of the tables.
    pub const ALL: [Self; 8] =
        [Self::Box10, Self::Box1, Self::Near, Self::Nearer, Self::Surface, Self::Grid, Self::Far, Self::Cluster];

    /// Returns the name in tables and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Box10 => "10x",
            Self::Box1 => "1x",
            Self::Near => "near",
            Self::Nearer => "near0.1",
            Self::Surface => "surface",
            Self::Grid => "grid",
            Self::Far => "far",
            Self::Cluster => "cluster",
        }
    }

    /// Generates `count` queries for a scene that is not empty (a lattice may have fewer).
    #[must_use]
    pub fn generate(self, soup: &Soup<f64>, count: usize, seed: u64) -> Vec<Point3<f64>> {
        let scene = &Frame::new(soup);
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        rng.set_stream(self as u64);
        let rng = &mut rng;
        let unit = scene.diagonal;
        match self {
            Self::Box10 => in_box(scene, 10.0, count, rng),
            Self::Box1 => in_box(scene, 1.05, count, rng),
            Self::Near => near(scene, 0.01 * unit, count, rng),
            Self::Nearer => near(scene, 0.001 * unit, count, rng),
            Self::Surface => near(scene, 0.0, count, rng),
            Self::Grid => lattice(scene, count),
            Self::Far => {
                let centre = scene.centre;
                (0..count).map(|_| centre + direction(rng) * (100.0 * unit)).collect()
            }
            Self::Cluster => {
                let sampler = SurfaceSampler::new(scene.soup);
                let centres: [Point3<f64>; CLUSTERS] = std::array::from_fn(|_| sampler.draw(rng).0);
                (0..count)
                    .map(|_| {
                        let centre = centres[rng.random_range(0..CLUSTERS)];
                        centre + Vector3::from_fn(|_, _| normal(rng)) * (0.005 * unit)
                    })
                    .collect()
            }
        }
    }

    /// Generates the queries with the numbers of the cases, out of as many queries as the last case requires.
    pub fn generate_for_cases(
        self,
        soup: &Soup<f64>,
        cases: &Cases,
        seed: u64,
    ) -> impl Iterator<Item = Point3<f64>> + use<> {
        let number = |case: u64| usize::try_from(case).expect("so many fit memory");
        let all = self.generate(soup, number(cases.end()), seed);
        cases.clone().filter_map(move |case| all.get(number(case)).copied())
    }

    /// Generates rays from these queries, whose directions have length 1 and are uniformly distributed on the sphere.
    #[must_use]
    pub fn rays(self, soup: &Soup<f64>, count: usize, seed: u64) -> Vec<Ray> {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        rng.set_stream(DIRECTIONS + self as u64);
        let origins = self.generate(soup, count, seed);
        origins.iter().map(|origin| Ray::new(origin, &direction(&mut rng)).expect("finite, and of length 1")).collect()
    }
}

impl std::fmt::Display for QuerySet {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

impl std::str::FromStr for QuerySet {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        Self::ALL.into_iter().find(|set| set.name() == name).ok_or_else(|| {
            let names: Vec<&str> = Self::ALL.iter().map(|set| set.name()).collect();
            format!("the query sets are {}", names.join(", "))
        })
    }
}

/// Returns the diagonal of a scene's box, or 1 for a scene that is a single point. It is the unit of offsets and
/// differences.
#[must_use]
pub fn diagonal(soup: &Soup<f64>) -> f64 {
    Frame::new(soup).diagonal
}

/// A scene and the dimensions of its box.
struct Frame<'a> {
    soup: &'a Soup<f64>,
    centre: Point3<f64>,
    half_sides: Vector3<f64>,
    diagonal: f64,
}

impl<'a> Frame<'a> {
    fn new(soup: &'a Soup<f64>) -> Self {
        let bounds = soup.aabb();
        // Coordinates are halved, because sums and differences of finite numbers may overflow.
        let (min, max) = (bounds.min.coords * 0.5, bounds.max.coords * 0.5);
        let diagonal = (bounds.max - bounds.min).norm();
        let diagonal = if diagonal > 0.0 { diagonal } else { 1.0 };
        Self { soup, centre: Point3::from(min + max), half_sides: max - min, diagonal }
    }
}

fn in_box(scene: &Frame<'_>, scale: f64, count: usize, rng: &mut ChaCha8Rng) -> Vec<Point3<f64>> {
    let (centre, half_sides) = (scene.centre, scene.half_sides * scale);
    (0..count)
        .map(|_| centre + Vector3::from_fn(|_, _| rng.random_range(-1.0..=1.0)).component_mul(&half_sides))
        .collect()
}

fn near(scene: &Frame<'_>, sigma: f64, count: usize, rng: &mut ChaCha8Rng) -> Vec<Point3<f64>> {
    let sampler = SurfaceSampler::new(scene.soup);
    (0..count)
        .map(|_| {
            let (point, unit) = sampler.draw(rng);
            if sigma > 0.0 { point + unit * (sigma * normal(rng)) } else { point }
        })
        .collect()
}

/// Generates the finest lattice of at most `count` points, including both ends, with equal spacing on all axes as
/// nearly as integers allow. A side of length zero has one layer.
fn lattice(scene: &Frame<'_>, count: usize) -> Vec<Point3<f64>> {
    let (centre, half_sides) = (scene.centre, scene.half_sides * 1.05);
    let [nx, ny, nz] = lattice_sides((half_sides * 2.0).into(), count);
    let coordinate = |k: usize, i: usize, n: usize| match n {
        1 => centre[k],
        _ => centre[k] + half_sides[k] * (2.0 * (i as f64 / (n - 1) as f64) - 1.0),
    };
    let mut points = Vec::with_capacity(nx * ny * nz);
    for x in 0..nx {
        for y in 0..ny {
            points
                .extend((0..nz).map(|z| Point3::new(coordinate(0, x, nx), coordinate(1, y, ny), coordinate(2, z, nz))));
        }
    }
    points
}

/// Returns the number of points of a lattice along each side, by bisection of the spacing.
fn lattice_sides(sides: [f64; 3], count: usize) -> [usize; 3] {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates, and is not negative")]
    let layers = |side: f64, spacing: f64| if side > 0.0 { (side / spacing) as usize + 1 } else { 1 };
    let at = |spacing: f64| sides.map(|side| layers(side, spacing));
    let points = |spacing: f64| at(spacing).iter().fold(1usize, |all, n| all.saturating_mul(*n));
    // Invariant: the spacing `fine` makes too many points, and `coarse` does not.
    let (mut fine, mut coarse) = (0.0, sides.iter().fold(0.0, |a: f64, b| a.max(*b)) * 2.0);
    for _ in 0..100 {
        let middle = 0.5 * (fine + coarse);
        if points(middle) > count {
            fine = middle;
        } else {
            coarse = middle;
        }
    }
    at(coarse)
}

#[cfg(test)]
mod tests {
    use super::*;
    use p2m_core::{BruteForce, ClosestPoint, Element};

    fn scene() -> Soup<f64> {
        let p = [[1.0, 0.0, 0.0], [2.0, 0.0, 1.0], [1.0, 3.0, 0.0], [5.0, 1.0, 2.0]].map(Point3::from).to_vec();
        Soup::new(p, [Element::Triangle([0, 1, 2]), Element::Segment([2, 3]), Element::Point(0)]).unwrap()
    }

    #[test]
    fn names_read_back() {
        for set in QuerySet::ALL {
            assert_eq!(set.to_string().parse(), Ok(set));
        }
        assert!("10".parse::<QuerySet>().unwrap_err().contains("10x, 1x, near"));
    }

    #[test]
    fn sets_are_deterministic_and_differ_by_seed() {
        for set in QuerySet::ALL {
            let queries = set.generate(&scene(), 100, 1);
            assert_eq!(queries, set.generate(&scene(), 100, 1), "{set:?}");
            assert!(set == QuerySet::Grid || queries != set.generate(&scene(), 100, 2), "{set:?}");
            assert!(set == QuerySet::Grid || queries.len() == 100);
        }
    }

    /// Returns the largest coordinate of any query relative to the half sides of the box.
    fn max_relative_coordinate(set: QuerySet) -> f64 {
        let (scene, count) = (scene(), 2000);
        let frame = Frame::new(&scene);
        let (centre, half_sides) = (frame.centre, frame.half_sides);
        let queries = set.generate(&scene, count, 1);
        queries.iter().map(|q| (q - centre).component_div(&half_sides).amax()).fold(0.0, f64::max)
    }

    #[test]
    fn boxes_are_filled_and_not_left() {
        for (set, scale) in [(QuerySet::Box10, 10.0), (QuerySet::Box1, 1.05), (QuerySet::Grid, 1.05)] {
            let largest = max_relative_coordinate(set);
            assert!(largest > 0.99 * scale && largest <= scale * (1.0 + 1e-15), "{set:?} {largest}");
        }
    }

    #[test]
    fn distances_to_the_scene_are_as_named() {
        let scene = scene();
        let index = BruteForce::new(&scene).unwrap();
        // The spread is the root mean square over the diagonal.
        let spread = |set: QuerySet| {
            let queries = set.generate(&scene, 4000, 1);
            let sum: f64 = queries.iter().map(|q| index.closest_point(q).unwrap().distance.powi(2)).sum();
            (sum / 4000.0).sqrt() / diagonal(&scene)
        };
        assert!(spread(QuerySet::Surface) < 1e-15);
        assert!((spread(QuerySet::Near) / 0.01 - 1.0).abs() < 0.05);
        assert!((spread(QuerySet::Nearer) / 0.001 - 1.0).abs() < 0.05);
        assert!(spread(QuerySet::Cluster) < 0.005 * 3f64.sqrt() * 1.05);
        let centre = Frame::new(&scene).centre;
        for q in QuerySet::Far.generate(&scene, 100, 1) {
            assert!(((q - centre).norm() / diagonal(&scene) - 100.0).abs() < 1e-12);
        }
    }

    #[test]
    fn rays_begin_at_queries_and_go_everywhere() {
        let rays = QuerySet::Box1.rays(&scene(), 4000, 1);
        let origins: Vec<_> = rays.iter().map(Ray::origin).collect();
        assert_eq!(origins, QuerySet::Box1.generate(&scene(), 4000, 1));
        let mut octants = [0; 8];
        for direction in rays.iter().map(Ray::direction) {
            assert!((direction.norm() - 1.0).abs() < 1e-15);
            octants[(0..3).map(|k| usize::from(direction[k] > 0.0) << k).sum::<usize>()] += 1;
        }
        assert!(octants.iter().all(|count| (400..600).contains(count)), "{octants:?}");
        // Each coordinate of a uniform point of a sphere is uniformly distributed.
        let steep = rays.iter().filter(|ray| ray.direction().z.abs() > 0.5).count();
        assert!((1850..2150).contains(&steep), "{steep}");
        assert_ne!(rays[0].direction(), QuerySet::Box10.rays(&scene(), 1, 1)[0].direction());
    }

    #[test]
    fn the_lattice_runs_along_z_first_and_is_about_as_large_as_asked() {
        let queries = QuerySet::Grid.generate(&scene(), 10_000, 1);
        assert!((9_000..=10_000).contains(&queries.len()), "{}", queries.len());
        assert!(queries[0].z < queries[1].z && queries[0].xy() == queries[1].xy());
        assert_eq!(lattice_sides([1.0, 1.0, 1.0], 1000), [10, 10, 10]);
        assert_eq!(lattice_sides([1.0, 1.0, 0.0], 10_000), [100, 100, 1]);
        assert_eq!(lattice_sides([0.0; 3], 10_000), [1, 1, 1]);
    }
}
