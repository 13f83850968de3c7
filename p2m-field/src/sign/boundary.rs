//! The boundary of a set of triangles, which bounds how much winding numbers vary away from the triangles.
//!
//! Two surfaces with the same boundary have the same solid angle up to multiples of 4 pi. So the gradient of the solid
//! angle is an integral along the boundary, that of dl x r / |r|^3 (the law of Biot and Savart; **cited**: winding
//! numbers are harmonic functions off the surface \[Jacobson2013\]). Let a point have the distance d from a boundary of
//! length L. Then the winding number varies by at most r L / (4 pi (d - r)^2) within r of the point, unless a triangle
//! is in between. It is constant if there is no boundary.

use nalgebra::Point3;
use p2m_bvh::TreeIndex;
use p2m_core::engine::weld::{VertexWelder, group_by_vertex};
use p2m_core::{Aabb, BuildError, ClosestPoint, PrimitiveSet, Soup};
use std::f64::consts::PI;

/// The boundary has a tree of its edges only if it has at least this many triangles for each edge.
const MIN_TRIANGLES_PER_EDGE: usize = 4;

/// The edges through which triangles run more often in one direction than in the other.
#[derive(Clone)]
pub(super) struct Boundary {
    /// A tree of the edges, or `None` if there are so many edges that they are near to every point.
    edges: Option<TreeIndex<f64, Soup<f64>, Aabb<f64>>>,
    /// The total length of the edges, each multiplied by its excess of directions.
    length: f64,
}

impl Boundary {
    /// # Errors
    /// Errors of building a tree of the edges.
    pub(super) fn new(soup: &Soup<f64>) -> Result<Self, BuildError> {
        let welder = VertexWelder::new(soup);
        let mut position_of = vec![0; welder.vertex_count];
        for i in soup.triangles().as_flattened() {
            position_of[welder.vertex_ids[*i as usize] as usize] = *i;
        }
        // A half-edge is stored at its lower vertex, with the higher vertex and whether it runs upwards.
        let half_edges = soup.triangles().iter().flat_map(|corners| {
            let [a, b, c] = welder.weld(*corners);
            let edges = [(a, b), (b, c), (c, a)].into_iter().filter(|(a, b)| a != b);
            edges.map(|(a, b)| (a.min(b), (a.max(b), a < b)))
        });
        let (mut edges, mut length, mut low) = (Soup::default(), 0.0, 0u32);
        let mut pushed = Ok(());
        group_by_vertex(welder.vertex_count, half_edges, |half_edges: &[(u32, bool)]| {
            for half_edges in half_edges.chunk_by(|x, y| x.0 == y.0) {
                let upwards = half_edges.iter().filter(|half_edge| half_edge.1).count();
                let excess = upwards.abs_diff(half_edges.len() - upwards);
                if excess > 0 {
                    let ends = [low, half_edges[0].0].map(|vertex| position_of[vertex as usize]);
                    let [a, b] = ends.map(|i| soup.positions()[i as usize]);
                    length += (b - a).norm() * excess as f64;
                    let ends = [a, b].map(|end| edges.push_position(end));
                    let element = p2m_core::Element::Segment(ends.map(|i| u32::try_from(i).unwrap_or(u32::MAX)));
                    pushed = pushed.and(edges.push(element).map(|_| ()));
                }
            }
            low += 1;
        });
        pushed?;
        let has_tree = edges.len() * MIN_TRIANGLES_PER_EDGE <= soup.len();
        let edges = has_tree.then(|| TreeIndex::new(edges)).transpose()?;
        Ok(Self { edges, length: length * (1.0 + 1e-9) })
    }

    /// Returns whether the triangles have no boundary.
    pub(super) fn is_empty(&self) -> bool {
        self.length == 0.0
    }

    /// Returns an upper bound on the change of winding numbers within `radius` of a point, if no triangle
    /// is in between.
    pub(super) fn max_change_within(&self, radius: f64, centre: &Point3<f64>) -> f64 {
        let Some(edges) = &self.edges else { return f64::INFINITY };
        let Some(closest) = edges.closest_point(centre) else { return 0.0 };
        let gap = closest.lower_bound - radius;
        if gap > 0.0 { radius * (self.length / gap) / gap / (4.0 * PI) * (1.0 + 1e-9) } else { f64::INFINITY }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sign::winding::WindingNumbers;
    use p2m_core::BruteForce;
    use p2m_mixed::generate::{IcoSphere, TorusKnot, ico_sphere, torus_knot};
    use p2m_testkit::vector;
    use rand::RngExt;

    #[test]
    fn winding_numbers_change_by_at_most_the_bound_of_the_boundary() {
        let knot = torus_knot(&TorusKnot::default()).expect("valid");
        assert!(Boundary::new(&knot).expect("valid").is_empty());
        let ball = ico_sphere(&IcoSphere { frequency: 8 }).expect("valid");
        let low = |t: &[u32; 3]| t.iter().all(|i| ball.positions()[*i as usize].x <= 0.0);
        let half = ball.triangles().iter().filter(|t| low(t)).copied().collect();
        let half = Soup::from_triangles(ball.positions().to_vec(), half).expect("valid");
        // One triangle is missing, and another one is duplicated.
        let mut rest = knot.triangles()[1..].to_vec();
        rest.push(rest[500]);
        let holes = Soup::from_triangles(knot.positions().to_vec(), rest).expect("valid");
        for (soup, edges, name) in [(half, 24, "half a ball"), (holes, 6, "a hole")] {
            let boundary = Boundary::new(&soup).expect("valid");
            let found = boundary.edges.as_ref().expect("few").set().len();
            assert!(found == edges || name == "half a ball" && found > 10, "{name}: {found} edges");
            let winding = WindingNumbers::new(&soup, 0.01).expect("triangles");
            let surface = BruteForce::new(&soup).expect("valid");
            let (mut bounded, mut largest) = (0, 0.0f64);
            let cases = p2m_testkit::cases(2000, 60);
            for case in cases.clone() {
                let mut rng = p2m_testkit::rng(name, case);
                let centre = Point3::from(vector(&mut rng) * 1.5);
                let radius = surface.closest_point(&centre).expect("not empty").distance * rng.random_range(0.01..0.99);
                let bound = boundary.max_change_within(radius, &centre);
                if bound > 0.5 {
                    continue;
                }
                bounded += 1;
                let other = centre + vector(&mut rng).normalize() * radius;
                let change = (winding.exact_number(&other) - winding.exact_number(&centre)).abs();
                assert!(change <= bound + 1e-9, "{name}, case {case}: {change} for {bound}");
                largest = largest.max(change / bound);
            }
            println!("{name}: {bounded} are bounded, at most {largest:.2} of the bound");
            let is_decisive = cases.have_more_than(500, bounded) && (cases.is_replay() || largest > 0.005);
            assert!(is_decisive, "{name}: {bounded} are bounded, {largest}");
        }
    }
}
