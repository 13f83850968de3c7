//! Random points of a scene, distributed by area and length.

use chacha20::ChaCha8Rng;
use nalgebra::{Point3, Vector3};
use p2m_core::{Element, PrimitiveId, PrimitiveSet, Shape, Soup};
use rand::RngExt;
use std::f64::consts::TAU;

/// Draws points of a scene, each with a direction that is normal to the scene at the point.
///
/// Triangles are weighted by area, and segments by length times (total area / total length), so that each kind gets
/// half of the draws in a scene with both. Points and degenerate primitives have weight zero. If all weights are zero,
/// all primitives are equally likely.
pub(crate) struct SurfaceSampler<'a> {
    soup: &'a Soup<f64>,
    /// The sums of the weights up to and including each primitive.
    cumulative: Vec<f64>,
}

impl<'a> SurfaceSampler<'a> {
    /// Returns a sampler of a scene that is not empty.
    pub(crate) fn new(soup: &'a Soup<f64>) -> Self {
        let measures: Vec<f64> = (0..soup.len()).map(|i| measure(&soup.get(PrimitiveId::new(i)))).collect();
        let total = |of_segments: bool| -> f64 {
            soup.elements()
                .zip(&measures)
                .filter(|(e, _)| matches!(e, Element::Segment(_)) == of_segments)
                .map(|(_, m)| m)
                .sum()
        };
        let (area, length) = (total(false), total(true));
        let per_length = if area > 0.0 && length > 0.0 { area / length } else { 1.0 };
        let mut sum = 0.0;
        let mut cumulative: Vec<f64> = soup
            .elements()
            .zip(&measures)
            .map(|(element, m)| {
                sum += if matches!(element, Element::Segment(_)) { m * per_length } else { *m };
                sum
            })
            .collect();
        // All weights are zero, or the sum overflows.
        if !(sum > 0.0 && sum.is_finite()) {
            cumulative = (1..=soup.len()).map(|i| i as f64).collect();
        }
        Self { soup, cumulative }
    }

    /// Returns the number of a random primitive.
    pub(crate) fn primitive(&self, rng: &mut ChaCha8Rng) -> usize {
        let last = self.cumulative.len() - 1;
        let at = rng.random::<f64>() * self.cumulative[last];
        self.cumulative.partition_point(|sum| *sum <= at).min(last)
    }

    /// Returns a random point of the scene and a unit vector: the normal of a triangle, a random perpendicular of a
    /// segment, or any direction at a point. A degenerate triangle is treated as its longest edge, and a degenerate
    /// segment as a point.
    pub(crate) fn draw(&self, rng: &mut ChaCha8Rng) -> (Point3<f64>, Vector3<f64>) {
        match self.soup.get(PrimitiveId::new(self.primitive(rng))) {
            Shape::Triangle(t) => {
                let [a, b, c] = t.vertices;
                let (mut u, mut v) = (rng.random::<f64>(), rng.random::<f64>());
                if u + v > 1.0 {
                    (u, v) = (1.0 - u, 1.0 - v);
                }
                let point = Point3::from(a.coords * (1.0 - u - v) + b.coords * u + c.coords * v);
                let edges = [b - a, c - b, a - c];
                let normal = (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_else(|| {
                    let longest = edges.into_iter().max_by(|e, f| e.norm_squared().total_cmp(&f.norm_squared()));
                    perpendicular(rng, &longest.unwrap_or_default())
                });
                (point, normal)
            }
            Shape::Segment(s) => {
                let [a, b] = s.vertices;
                let t = rng.random::<f64>();
                (Point3::from(a.coords * (1.0 - t) + b.coords * t), perpendicular(rng, &(b - a)))
            }
            // `Shape` is non-exhaustive. Shapes other than triangles and segments are treated as points.
            shape => (shape.vertices()[0], direction(rng)),
        }
    }
}

/// Returns the area of a triangle, the length of a segment, or zero for a point.
fn measure(shape: &Shape<f64>) -> f64 {
    match shape {
        Shape::Triangle(t) => {
            let [a, b, c] = t.vertices;
            (b - a).cross(&(c - a)).norm() / 2.0
        }
        Shape::Segment(s) => (s.vertices[1] - s.vertices[0]).norm(),
        _ => 0.0,
    }
}

/// Returns a random unit vector perpendicular to `along`, or any unit vector if `along` is zero.
fn perpendicular(rng: &mut ChaCha8Rng, along: &Vector3<f64>) -> Vector3<f64> {
    let Some(along) = along.try_normalize(0.0) else { return direction(rng) };
    loop {
        let any = direction(rng);
        if let Some(across) = (any - along * along.dot(&any)).try_normalize(1e-3) {
            return across;
        }
    }
}

/// Returns a random unit vector.
pub(crate) fn direction(rng: &mut ChaCha8Rng) -> Vector3<f64> {
    loop {
        if let Some(unit) = Vector3::from_fn(|_, _| normal(rng)).try_normalize(1e-9) {
            return unit;
        }
    }
}

/// Returns a normally distributed number with mean 0 and variance 1, by the method of Box and Muller.
pub fn normal(rng: &mut ChaCha8Rng) -> f64 {
    let radius = (-2.0 * (1.0 - rng.random::<f64>()).ln()).sqrt();
    radius * (TAU * rng.random::<f64>()).cos()
}

#[cfg(test)]
mod tests {
    use super::*;
    use p2m_core::{BruteForce, ClosestPoint};
    use rand::SeedableRng;

    fn positions() -> Vec<Point3<f64>> {
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [3.0, 0.0, 0.0], [0.0, 0.0, 5.0]].map(Point3::from).to_vec()
    }

    /// Returns how often each primitive is drawn.
    fn counts(elements: &[Element], draws: u32) -> Vec<u32> {
        let soup = Soup::new(positions(), elements.iter().copied()).unwrap();
        let sampler = SurfaceSampler::new(&soup);
        let mut rng = ChaCha8Rng::seed_from_u64(7);
        let mut counts = vec![0; elements.len()];
        (0..draws).for_each(|_| counts[sampler.primitive(&mut rng)] += 1);
        counts
    }

    /// Returns Pearson's statistic of `counts` against probabilities.
    fn chi_square(counts: &[u32], expected: &[f64]) -> f64 {
        let total: f64 = counts.iter().copied().map(f64::from).sum();
        counts.iter().zip(expected).map(|(c, p)| (f64::from(*c) - p * total).powi(2) / (p * total)).sum()
    }

    #[test]
    fn triangles_are_drawn_by_area() {
        let counts = counts(&[Element::Triangle([0, 1, 2]), Element::Triangle([0, 3, 2])], 40_000);
        assert!(chi_square(&counts, &[0.25, 0.75]) < 7.9, "{counts:?}");
    }

    #[test]
    fn both_kinds_get_half_and_what_has_no_measure_nothing() {
        let kinds = [
            Element::Triangle([0, 1, 1]),
            Element::Triangle([0, 1, 2]),
            Element::Segment([0, 3]),
            Element::Segment([0, 1]),
            Element::Segment([4, 4]),
            Element::Point(4),
        ];
        let counts = counts(&kinds, 40_000);
        assert_eq!([counts[0], counts[4], counts[5]], [0, 0, 0]);
        assert!(chi_square(&counts[1..4], &[0.5, 0.375, 0.125]) < 10.6, "{counts:?}");
    }

    #[test]
    fn without_any_measure_all_are_equally_likely() {
        let counts = counts(&[Element::Point(0), Element::Segment([1, 1]), Element::Triangle([0, 1, 1])], 1);
        assert_eq!(counts.iter().sum::<u32>(), 1);
        let kinds = [Element::Point(0), Element::Point(1), Element::Segment([2, 2])];
        assert!(chi_square(&self::counts(&kinds, 30_000), &[1.0 / 3.0; 3]) < 10.6);
    }

    #[test]
    fn draws_lie_on_the_scene_and_directions_are_normal_to_it() {
        let elements = [Element::Triangle([1, 2, 4]), Element::Segment([0, 3]), Element::Triangle([0, 1, 3])];
        let soup = Soup::new(positions(), elements).unwrap();
        let (sampler, index) = (SurfaceSampler::new(&soup), BruteForce::new(&soup).unwrap());
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        for _ in 0..1000 {
            let (point, unit) = sampler.draw(&mut rng);
            let answer = index.closest_point(&point).unwrap();
            assert!(answer.distance <= 1e-15 * 5.0, "{answer:?}");
            assert!((unit.norm() - 1.0).abs() < 1e-15 * 4.0);
            let along = match soup.element(answer.primitive) {
                Element::Triangle([a, b, _]) | Element::Segment([a, b]) => {
                    positions()[b as usize] - positions()[a as usize]
                }
                Element::Point(_) => unreachable!("there is none"),
            };
            assert!(along.dot(&unit).abs() < 1e-14);
        }
    }

    #[test]
    fn normal_numbers_have_mean_0_and_variance_1() {
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        let draws: Vec<f64> = (0..50_000).map(|_| normal(&mut rng)).collect();
        let mean = draws.iter().sum::<f64>() / 5e4;
        let variance = draws.iter().map(|x| x * x).sum::<f64>() / 5e4;
        assert!(mean.abs() < 0.02 && (variance - 1.0).abs() < 0.03, "{mean} {variance}");
    }
}
