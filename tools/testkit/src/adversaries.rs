//! Adversarial scenes for any number of primitives: they make trees deep, lists long, cells many, Delaunay tetrahedra
//! quadratic in number, or builds slow.

use crate::{rng, vector};
use nalgebra::{Point3, Vector3};
use p2m_core::{Element, Point, PrimitiveSet, Segment, Shape, Soup, Triangle};
use rand::{Rng, RngExt};
use std::f64::consts::TAU;

/// A family of adversarial scenes.
#[derive(Clone, Copy, Debug)]
pub struct Adversary {
    /// The name in messages.
    pub name: &'static str,
    make: fn(usize) -> Vec<Shape<f64>>,
}

/// All families, each with the weakness that it exploits.
pub const ADVERSARIES: &[Adversary] = &[
    // The same triangle again and again, so that nothing can be split.
    Adversary { name: "identical", make: identical },
    // Points at one place, so that boxes have no size.
    Adversary { name: "one place", make: coincident_points },
    // Triangles in a corner, over 1000 octaves, which make trees deep.
    Adversary { name: "nested", make: nested },
    // Segments, each longer than all before, over 580 octaves. Every split by cost takes only one off.
    Adversary { name: "staircase", make: staircase },
    // Triangles with one apex, the narrower the more they are, which make lists long.
    Adversary { name: "fan", make: triangle_fan },
    // Long thin triangles through one point, whose boxes overlap.
    Adversary { name: "comb", make: comb },
    // Segments from one point to a sphere, so that one site has all others as neighbours.
    Adversary { name: "star", make: star },
    // Points on a sphere, all of which are nearest to its centre.
    Adversary { name: "sphere", make: sphere },
    // The same points on sixteen concentric spheres, so that again many are equally near to the centre.
    Adversary { name: "spheres", make: spheres },
    // Points on two skew lines, whose pairs all make Delaunay tetrahedra.
    Adversary { name: "skew points", make: skew_points },
    // Two skew wires of segments, whose pairs all make Delaunay tetrahedra.
    Adversary { name: "skew wires", make: skew_wires },
    // Two helices around each other, whose pairs all make Delaunay tetrahedra.
    Adversary { name: "helices", make: helices },
    // Points (t, t^2, t^3), whose Delaunay tetrahedra have an edge for every pair.
    Adversary { name: "moment curve", make: moment_curve },
    // Points of a grid, which are cospherical everywhere.
    Adversary { name: "grid", make: grid },
    // Long thin triangles at random in a box, which boxes cannot separate.
    Adversary { name: "needles", make: needles },
    // Large parallel squares on top of each other, so that no vertex is near a query.
    Adversary { name: "sheets", make: sheets },
    // Segments on a line up to rounding, which make tetrahedra flat.
    Adversary { name: "line", make: line },
    // Triangles in a plane that is not axis-aligned, up to rounding, which make tetrahedra flat.
    Adversary { name: "plane", make: plane },
    // Triangles of sizes 10^6 and 1 in turns.
    Adversary { name: "huge and tiny", make: |n| sizes(n, 1e6) },
    // Triangles of sizes 10^12 and 1 in turns.
    Adversary { name: "huger and tiny", make: |n| sizes(n, 1e12) },
    // A huge triangle over tiny ones, which crosses every split.
    Adversary { name: "one over all", make: one_over_all },
    // Two dense clouds of points far apart, which make grids nearly empty.
    Adversary { name: "two clouds", make: two_clouds },
];

impl Adversary {
    /// Returns the family with this name.
    #[must_use]
    pub fn named(name: &str) -> &'static Self {
        ADVERSARIES.iter().find(|adversary| adversary.name == name).expect("a name of the list")
    }

    /// Returns the scene with about `count` primitives.
    #[must_use]
    pub fn soup(&self, n: usize) -> Soup<f64> {
        let mut soup = Soup::default();
        for shape in (self.make)(n) {
            let mut local = [0; 3];
            for (to, p) in local.iter_mut().zip(shape.vertices()) {
                *to = u32::try_from(soup.push_position(*p)).expect("few positions");
            }
            let element = match shape.vertices().len() {
                1 => Element::Point(local[0]),
                2 => Element::Segment([local[0], local[1]]),
                _ => Element::Triangle(local),
            };
            soup.push(element).expect("finite");
        }
        soup.shrink_to_fit();
        soup
    }
}

/// Returns queries for any scene that is not empty: its middle and the origin, where these scenes are hardest, then
/// vertices, points between and near vertices, points in and around the bounding box, and points far away.
#[must_use]
pub fn queries(soup: &Soup<f64>, count: usize) -> Vec<Point3<f64>> {
    let random = &mut rng("adversaries", count as u64);
    let bounds = soup.aabb();
    let (middle, size) = (nalgebra::center(&bounds.min, &bounds.max), bounds.max - bounds.min);
    let vertex = |random: &mut dyn FnMut(usize) -> usize| soup.positions()[random(soup.positions().len())];
    let others = (2..count).map(|i| {
        let mut number = |n: usize| random.random_range(0..n);
        let (a, b) = (vertex(&mut number), vertex(&mut number));
        match i % 6 {
            0 => a,
            1 => nalgebra::center(&a, &b),
            2 => a + vector(random) * ((b - a).norm() * 2f64.powi(-random.random_range(0..40))),
            3 => middle + vector(random).component_mul(&size) * 0.525,
            4 => middle + vector(random) * (size.max() * 5.0),
            _ => middle + vector(random) * (size.max() * 1e-3),
        }
    });
    [middle, Point3::origin()].into_iter().chain(others).take(count).collect()
}

/// Returns the fraction i / n.
fn fraction(i: usize, n: usize) -> f64 {
    i as f64 / n as f64
}

/// Returns 2 to the power of `exponent`.
fn power(exponent: f64) -> f64 {
    let integer = exponent.floor();
    #[allow(clippy::cast_possible_truncation, reason = "exponents of f64")]
    let scale = 2f64.powi(integer as i32);
    scale * (exponent - integer).exp2()
}

fn triangle([a, b, c]: [Point3<f64>; 3]) -> Shape<f64> {
    Triangle::new(a, b, c).into()
}

fn points(places: impl Iterator<Item = Point3<f64>>) -> Vec<Shape<f64>> {
    places.map(|p| Point::new(p).into()).collect()
}

/// Returns a random direction.
fn direction(random: &mut impl Rng) -> Vector3<f64> {
    loop {
        let v = vector(random);
        if (0.01..1.0).contains(&v.norm_squared()) {
            return v.normalize();
        }
    }
}

fn identical(n: usize) -> Vec<Shape<f64>> {
    let corner = [[0.1, 0.2, 0.3], [1.1, 0.3, 0.2], [0.2, 1.4, 0.5]].map(Point3::from);
    vec![triangle(corner); n]
}

fn coincident_points(n: usize) -> Vec<Shape<f64>> {
    vec![Point::new(Point3::new(0.1, 0.2, 0.3)).into(); n]
}

fn nested(n: usize) -> Vec<Shape<f64>> {
    let scaled = |s: f64| triangle([Point3::new(s, 0.0, 0.0), Point3::new(0.0, s, 0.0), Point3::new(0.0, 0.0, s)]);
    (0..n).map(|i| scaled(power(-1000.0 * fraction(i, n)))).collect()
}

fn staircase(n: usize) -> Vec<Shape<f64>> {
    let at = |i: usize| power(580.0 * fraction(i, n) - 290.0);
    (0..n).map(|i| Segment::new(Point3::new(at(i), 0.0, at(i)), Point3::new(at(i + 1), 0.0, at(i))).into()).collect()
}

/// Returns a point on a circle around the z axis.
fn on_circle(turns: f64, radius: f64, z: f64) -> Point3<f64> {
    let (sine, cosine) = (turns * TAU).sin_cos();
    Point3::new(radius * cosine, radius * sine, z)
}

fn triangle_fan(n: usize) -> Vec<Shape<f64>> {
    let rim = |i: usize| on_circle(fraction(i, n), 0.5, 0.0);
    (0..n).map(|i| triangle([Point3::new(0.0, 0.0, 0.3), rim(i), rim(i + 1)])).collect()
}

fn comb(n: usize) -> Vec<Shape<f64>> {
    let random = &mut rng("comb", 0);
    (0..n)
        .map(|_| {
            let (end, aside) = (direction(random), vector(random) * 1e-3);
            triangle([Point3::from(-end), Point3::from(end), Point3::from(aside)])
        })
        .collect()
}

fn star(n: usize) -> Vec<Shape<f64>> {
    let random = &mut rng("star", 0);
    (0..n).map(|_| Segment::new(Point3::origin(), Point3::from(direction(random))).into()).collect()
}

fn sphere(n: usize) -> Vec<Shape<f64>> {
    let random = &mut rng("sphere", 0);
    points((0..n).map(|_| Point3::from(direction(random))))
}

fn spheres(n: usize) -> Vec<Shape<f64>> {
    const SPHERES: usize = 16;
    let random = &mut rng("spheres", 0);
    let directions: Vec<Vector3<f64>> = (0..n.div_ceil(SPHERES)).map(|_| direction(random)).collect();
    points((0..n).map(|i| Point3::from(directions[i / SPHERES] * fraction(i % SPHERES + 1, SPHERES))))
}

/// Returns the point at `t` from 0 to 1 on one of two skew lines.
fn on_skew_line(first: bool, t: f64) -> Point3<f64> {
    if first { Point3::new(t - 0.5, 0.0, -0.5) } else { Point3::new(0.0, t - 0.5, 0.5) }
}

fn skew_points(n: usize) -> Vec<Shape<f64>> {
    points((0..n).map(|i| on_skew_line(i.is_multiple_of(2), fraction(i / 2, n.div_ceil(2)))))
}

fn skew_wires(n: usize) -> Vec<Shape<f64>> {
    let half_count = n.div_ceil(2);
    let on = |i: usize, next: usize| on_skew_line(i.is_multiple_of(2), fraction(i / 2 + next, half_count));
    (0..n).map(|i| Segment::new(on(i, 0), on(i, 1)).into()).collect()
}

fn helices(n: usize) -> Vec<Shape<f64>> {
    let half_count = n.div_ceil(2);
    let on = |i: usize, next: usize| {
        let t = fraction(i / 2 + next, half_count);
        on_circle(t + if i.is_multiple_of(2) { 0.0 } else { 0.5 }, 1.0, t * TAU)
    };
    (0..n).map(|i| Segment::new(on(i, 0), on(i, 1)).into()).collect()
}

fn moment_curve(n: usize) -> Vec<Shape<f64>> {
    points((0..n).map(|i| fraction(i + 1, n)).map(|t| Point3::new(t, t * t, t * t * t)))
}

fn grid(n: usize) -> Vec<Shape<f64>> {
    let side = (1..).find(|side| side * side * side >= n).expect("numbers have roots");
    points((0..n).map(|i| Point3::from([i % side, i / side % side, i / side / side].map(|x| x as f64))))
}

fn needles(n: usize) -> Vec<Shape<f64>> {
    let random = &mut rng("needles", 0);
    (0..n)
        .map(|_| {
            let (a, b, aside) = (vector(random), vector(random), vector(random) * 1e-6);
            triangle([Point3::from(a), Point3::from(b), Point3::from(b + aside)])
        })
        .collect()
}

fn sheets(n: usize) -> Vec<Shape<f64>> {
    let at = |x: f64, y: f64, i: usize| Point3::new(x, y, fraction(i / 2, n));
    (0..n)
        .map(|i| {
            let other = if i.is_multiple_of(2) { at(1.0, 0.0, i) } else { at(0.0, 1.0, i) };
            triangle([at(0.0, 0.0, i), other, at(1.0, 1.0, i)])
        })
        .collect()
}

fn line(n: usize) -> Vec<Shape<f64>> {
    let at = |i: usize| Point3::new(0.1, 0.3, -0.7) + Vector3::new(0.3, 0.7, 0.9) * fraction(i, n);
    (0..n).map(|i| Segment::new(at(i), at(i + 1)).into()).collect()
}

fn plane(n: usize) -> Vec<Shape<f64>> {
    let random = &mut rng("plane", 0);
    let (u, v) = (Vector3::new(0.3, 0.7, 0.9), Vector3::new(-0.8, 0.1, 0.3));
    let size = 2.0 / (n as f64).sqrt();
    (0..n)
        .map(|_| {
            let corner: [f64; 2] = [random.random(), random.random()];
            triangle([(); 3].map(|()| {
                let [s, t] = corner.map(|x| x + size * random.random::<f64>());
                Point3::new(0.1, 0.3, -0.7) + u * s + v * t
            }))
        })
        .collect()
}

fn sizes(n: usize, huge: f64) -> Vec<Shape<f64>> {
    let random = &mut rng("sizes", 0);
    (0..n)
        .map(|i| {
            let (centre, size) = (vector(random) * huge, if i.is_multiple_of(2) { huge } else { 1.0 });
            triangle([(); 3].map(|()| Point3::from(centre + vector(random) * size)))
        })
        .collect()
}

fn one_over_all(n: usize) -> Vec<Shape<f64>> {
    let random = &mut rng("one over all", 0);
    let huge = [[-1e3, -1e3, 0.5], [1e3, -1e3, 0.5], [0.0, 1e3, 0.5]].map(Point3::from);
    let size = 1.0 / (n as f64).sqrt();
    let tiny = (1..n).map(|_| {
        let centre = vector(random).component_mul(&Vector3::new(1.0, 1.0, 0.0));
        triangle([(); 3].map(|()| Point3::from(centre + vector(random) * size)))
    });
    std::iter::once(triangle(huge)).chain(tiny).collect()
}

fn two_clouds(n: usize) -> Vec<Shape<f64>> {
    let random = &mut rng("two clouds", 0);
    points(
        (0..n).map(|i| {
            Point3::from(vector(random) * 1e-6 + Vector3::repeat(if i.is_multiple_of(2) { 1.0 } else { -1.0 }))
        }),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_adversary_has_as_many_primitives_as_asked_for() {
        for adversary in ADVERSARIES {
            for n in [1, 2, 3, 17, 500] {
                let soup = adversary.soup(n);
                assert_eq!(soup.len(), n, "{}", adversary.name);
                assert!(queries(&soup, 40).iter().flat_map(|q| q.iter()).all(|x| x.is_finite()), "{}", adversary.name);
            }
        }
    }
}
