//! The boundary of triangles, by which alone winding numbers change where no triangle is.
//!
//! The solid angle of a surface is that of any other with the same boundary, beside whole turns, so its gradient is an integral along the
//! boundary, that of dl x r / |r|^3 (the law of Biot and Savart; **cited**: \[Jacobson2013\] has winding numbers as harmonic functions off the
//! surface). So the winding number changes by at most r L / (4 pi (d - r)^2) within r of a place at the distance d from a boundary of the length L,
//! unless a triangle is in between; without boundary, not at all.

use nalgebra::Point3;
use p2m_bvh::TreeIndex;
use p2m_core::{Aabb, BuildError, BuildIndex, ClosestPoint, PrimitiveSet, Soup};
use p2m_mixed::engine::places::{Places, by_place};
use std::f64::consts::PI;

/// Edges are few if triangles are so many times as many.
const FEW: usize = 4;

/// The edges that triangles do not run through as often one way as the other.
pub(super) struct Boundary {
    /// `None` if there are so many that they are near everything.
    edges: Option<TreeIndex<f64, Soup<f64>, Aabb<f64>>>,
    /// Of all edges, each as often as it is left over.
    length: f64,
}

impl Boundary {
    /// # Errors
    /// Those of a tree of edges.
    pub(super) fn new(soup: &Soup<f64>) -> Result<Self, BuildError> {
        let places = Places::new(soup);
        let mut position_of = vec![0; places.len];
        for i in soup.triangles().as_flattened() {
            position_of[places.of[*i as usize] as usize] = *i;
        }
        // From the lower place, the higher one and the direction.
        let halves = soup.triangles().iter().flat_map(|corners| {
            let [a, b, c] = places.of(*corners);
            let edges = [(a, b), (b, c), (c, a)].into_iter().filter(|(a, b)| a != b);
            edges.map(|(a, b)| (a.min(b), (a.max(b), a < b)))
        });
        let (mut edges, mut length, mut low) = (Soup::default(), 0.0, 0u32);
        let mut pushed = Ok(());
        by_place(places.len, halves, |halves: &[(u32, bool)]| {
            for halves in halves.chunk_by(|x, y| x.0 == y.0) {
                let along = halves.iter().filter(|half| half.1).count();
                let left = along.abs_diff(halves.len() - along);
                if left > 0 {
                    let ends = [low, halves[0].0].map(|place| position_of[place as usize]);
                    let [a, b] = ends.map(|i| soup.positions()[i as usize]);
                    length += (b - a).norm() * left as f64;
                    let ends = [a, b].map(|end| edges.push_position(end));
                    let element = p2m_core::Element::Segment(ends.map(|i| u32::try_from(i).unwrap_or(u32::MAX)));
                    pushed = pushed.and(edges.push(element).map(|_| ()));
                }
            }
            low += 1;
        });
        pushed?;
        let are_few = edges.len() * FEW <= soup.len();
        let edges = are_few.then(|| TreeIndex::build(edges, &Default::default())).transpose()?;
        Ok(Self { edges, length: length * (1.0 + 1e-9) })
    }

    /// Whether there is none.
    pub(super) fn is_none(&self) -> bool {
        self.length == 0.0
    }

    /// How much winding numbers may change within `radius` of a place, if no triangle is there.
    pub(super) fn change_within(&self, radius: f64, place: &Point3<f64>) -> f64 {
        let Some(edges) = &self.edges else { return f64::INFINITY };
        let Some(closest) = edges.closest_point(place) else { return 0.0 };
        let apart = closest.lower_bound - radius;
        if apart > 0.0 { radius * (self.length / apart) / apart / (4.0 * PI) * (1.0 + 1e-9) } else { f64::INFINITY }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sign::WindingNumbers;
    use p2m_core::BruteForce;
    use p2m_mixed::generate::{IcoSphere, TorusKnot, ico_sphere, torus_knot};
    use p2m_testkit::vector;
    use rand::RngExt;

    #[test]
    fn winding_numbers_change_by_no_more_than_the_boundary_lets_them() {
        let knot = torus_knot(&TorusKnot::default()).expect("valid");
        assert!(Boundary::new(&knot).expect("valid").is_none());
        let ball = ico_sphere(&IcoSphere::default().with_frequency(8)).expect("valid");
        let low = |t: &[u32; 3]| t.iter().all(|i| ball.positions()[*i as usize].x <= 0.0);
        let half = ball.triangles().iter().filter(|t| low(t)).copied().collect();
        let half = Soup::from_triangles(ball.positions().to_vec(), half).expect("valid");
        // One triangle is missing, and one is there twice.
        let mut rest = knot.triangles()[1..].to_vec();
        rest.push(rest[500]);
        let holes = Soup::from_triangles(knot.positions().to_vec(), rest).expect("valid");
        for (soup, edges, name) in [(half, 24, "half a ball"), (holes, 6, "a hole")] {
            let boundary = Boundary::new(&soup).expect("valid");
            let found = boundary.edges.as_ref().expect("few").set().len();
            assert!(found == edges || name == "half a ball" && found > 10, "{name}: {found} edges");
            let winding = WindingNumbers::new(&soup, 0.01).expect("triangles");
            let surface = BruteForce::new(&soup).expect("valid");
            let (mut told, mut most) = (0, 0.0f64);
            let cases = p2m_testkit::cases(2000, 60);
            for case in cases.clone() {
                let mut rng = p2m_testkit::rng(name, case);
                let place = Point3::from(vector(&mut rng) * 1.5);
                let radius = surface.closest_point(&place).expect("not empty").distance * rng.random_range(0.01..0.99);
                let bound = boundary.change_within(radius, &place);
                if bound > 0.5 {
                    continue;
                }
                told += 1;
                let other = place + vector(&mut rng).normalize() * radius;
                let change = (winding.exact_number(&other) - winding.exact_number(&place)).abs();
                assert!(change <= bound + 1e-9, "{name}, case {case}: {change} for {bound}");
                most = most.max(change / bound);
            }
            println!("{name}: {told} told, at most {most:.2} of the bound");
            let is_worth_it = cases.have_more_than(500, told) && (cases.is_replay() || most > 0.005);
            assert!(is_worth_it, "{name}: {told} told, {most}");
        }
    }
}
