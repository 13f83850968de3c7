//! The boundary of a set of triangles, which bounds how much winding numbers vary away from the triangles.
//!
//! Two surfaces with the same boundary have the same solid angle up to multiples of 4 pi. So the gradient of the solid
//! angle is an integral along the boundary, that of dl x r / |r|^3 (the law of Biot and Savart; **cited**: winding
//! numbers are harmonic functions off the surface \[Jacobson2013\]). Along a path that does not cross the surface, the
//! winding number changes at most by the length of the path times the largest sum of l / (4 pi d^2) over the edges of
//! the boundary, which have the length l and the distance d from a point of the path.

use super::surface::Surface;
use nalgebra::Point3;
use p2m_core::Soup;
use p2m_core::engine::vector::{V3, length, sub};
use std::f64::consts::PI;

/// The edges through which triangles run more often in one direction than in the other, as a tree.
#[derive(Clone)]
pub(super) struct Boundary {
    /// The nodes, from the root. The two children of a node are side by side.
    nodes: Vec<Node>,
}

#[derive(Clone)]
struct Node {
    /// The corners of the box of the edges.
    bounds: [V3; 2],
    /// The length of the diagonal of the box.
    diagonal: f64,
    /// The total length of the edges over 4 pi.
    length: f64,
    /// The index of the first child, or 0 for a single edge.
    children: usize,
}

/// The largest diagonal of a node that is not divided, in units of its distance.
const MAX_DIAGONAL: f64 = 0.5;
/// Room for the rounding of sums and distances.
const INFLATION: f64 = 1.0 + 1e-9;

impl Boundary {
    pub(super) fn new(soup: &Soup<f64>, surface: &Surface) -> Self {
        let mut position_of = vec![0; surface.welder.vertex_count];
        for i in soup.triangles().as_flattened() {
            position_of[surface.welder.vertex_ids[*i as usize] as usize] = *i as usize;
        }
        let position = |vertex: u32| -> V3 { soup.positions()[position_of[vertex as usize]].into() };
        let mut edges: Vec<[V3; 2]> = surface.boundary.iter().map(|ends| ends.map(position)).collect();
        let mut nodes = Vec::with_capacity(2 * edges.len());
        if !edges.is_empty() {
            nodes.push(Node::new(&edges));
            build(&mut edges, 0, &mut nodes);
        }
        Self { nodes }
    }

    /// Returns an upper bound on the change of winding numbers along a path that does not cross the surface. The path has
    /// at most the length `path`, and is within `radius` of `centre`. Changes of more than `enough` are not told apart.
    pub(super) fn max_change(&self, path: f64, radius: f64, centre: &Point3<f64>, enough: f64) -> f64 {
        let centre: V3 = (*centre).into();
        let mut gradient = 0.0;
        // Each level halves the edges, so there are at most 32 levels.
        let mut stack = [0usize; 64];
        let mut len = usize::from(!self.nodes.is_empty());
        while len > 0 {
            len -= 1;
            let node = &self.nodes[stack[len]];
            let beyond =
                [0, 1, 2].map(|k| f64::max(node.bounds[0][k] - centre[k], centre[k] - node.bounds[1][k]).max(0.0));
            let distance = length(beyond) - radius;
            if node.children != 0 && node.diagonal > MAX_DIAGONAL * distance {
                stack[len] = node.children;
                stack[len + 1] = node.children + 1;
                len += 2;
            } else if distance > 0.0 {
                gradient += node.length / distance / distance;
            } else {
                return f64::INFINITY;
            }
            if gradient * path > enough {
                break;
            }
        }
        gradient * path * INFLATION
    }
}

impl Node {
    fn new(edges: &[[V3; 2]]) -> Self {
        let corners = edges.as_flattened();
        let end =
            |pick: fn(f64, f64) -> f64| corners.iter().fold(corners[0], |a, b| [0, 1, 2].map(|k| pick(a[k], b[k])));
        let bounds = [end(f64::min), end(f64::max)];
        let total: f64 = edges.iter().map(|[a, b]| length(sub(*b, *a))).sum();
        let diagonal = length(sub(bounds[1], bounds[0]));
        Self { bounds, diagonal, length: total / (4.0 * PI) * INFLATION, children: 0 }
    }
}

/// Appends the nodes below a node.
fn build(edges: &mut [[V3; 2]], node: usize, nodes: &mut Vec<Node>) {
    if edges.len() < 2 {
        return;
    }
    let [low, high] = nodes[node].bounds;
    let extent = sub(high, low);
    let axis = (0..3).fold(0, |longest, k| if extent[k] > extent[longest] { k } else { longest });
    let (centre, half) = (|[a, b]: &[V3; 2]| a[axis] + b[axis], edges.len() / 2);
    edges.select_nth_unstable_by(half, |a, b| centre(a).total_cmp(&centre(b)));
    let (one, other) = edges.split_at_mut(half);
    let children = nodes.len();
    nodes[node].children = children;
    nodes.push(Node::new(one));
    nodes.push(Node::new(other));
    build(one, children, nodes);
    build(other, children + 1, nodes);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sign::winding::WindingNumbers;
    use p2m_core::{BruteForce, ClosestPoint};
    use p2m_mixed::generate::{IcoSphere, TorusKnot, ico_sphere, torus_knot};
    use p2m_testkit::vector;
    use rand::RngExt;

    #[test]
    fn winding_numbers_change_by_at_most_the_bound_of_the_boundary() {
        let knot = torus_knot(&TorusKnot::default()).expect("valid");
        assert!(Surface::new(&knot).boundary.is_empty());
        let ball = ico_sphere(&IcoSphere { frequency: 8 }).expect("valid");
        let low = |t: &[u32; 3]| t.iter().all(|i| ball.positions()[*i as usize].x <= 0.0);
        let half = ball.triangles().iter().filter(|t| low(t)).copied().collect();
        let half = Soup::from_triangles(ball.positions().to_vec(), half).expect("valid");
        // One triangle is missing, and another one is duplicated.
        let mut rest = knot.triangles()[1..].to_vec();
        rest.push(rest[500]);
        let holes = Soup::from_triangles(knot.positions().to_vec(), rest).expect("valid");
        for (soup, edges, name) in [(half, 24, "half a ball"), (holes, 6, "a hole")] {
            let surface = Surface::new(&soup);
            let (boundary, found) = (Boundary::new(&soup, &surface), surface.boundary.len());
            assert!(found == edges || name == "half a ball" && found > 10, "{name}: {found} edges");
            let winding = WindingNumbers::new(&soup).expect("triangles");
            let surface = BruteForce::new(&soup).expect("valid");
            let (mut bounded, mut largest) = (0, 0.0f64);
            let cases = p2m_testkit::cases(2000, 60);
            for case in cases.clone() {
                let mut rng = p2m_testkit::rng(name, case);
                let centre = Point3::from(vector(&mut rng) * 1.5);
                let radius = surface.closest_point(&centre).expect("not empty").distance * rng.random_range(0.01..0.99);
                let bound = boundary.max_change(radius, radius, &centre, f64::INFINITY);
                if bound > 0.5 {
                    continue;
                }
                bounded += 1;
                let other = centre + vector(&mut rng).normalize() * radius;
                let change = (winding.sum(&other) - winding.sum(&centre)).abs();
                assert!(change <= bound + 1e-9, "{name}, case {case}: {change} for {bound}");
                largest = largest.max(change / bound);
            }
            println!("{name}: {bounded} are bounded, at most {largest:.2} of the bound");
            let is_decisive = cases.have_more_than(500, bounded) && (cases.is_replay() || largest > 0.005);
            assert!(is_decisive, "{name}: {bounded} are bounded, {largest}");
        }
    }
}
