//! The corners, edges and faces of a k-DOP, for visualisation and measurements.

use crate::{Directions, Kdop};
use nalgebra::{Point3, Vector3};
use std::io::{self, Write};

/// The largest magnitude of heights, 2^1000, for which a polytope is computed, so that sums of products do not
/// overflow.
const MAX_HEIGHT: f64 = f64::from_bits((1000 + 1023) << 52);

/// A convex polytope, given by its corners and faces.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polytope {
    /// The positions of the corners.
    pub corners: Vec<Point3<f64>>,
    /// The indices of the corners around each face, counterclockwise as seen from outside.
    pub faces: Vec<Vec<usize>>,
}

impl Polytope {
    /// Computes the polytope of a k-DOP.
    ///
    /// A cube around the k-DOP is cut by one face after the other, so the polytope is closed in spite of rounding.
    ///
    /// Faces are moved outwards by 1e-9 of half the longest side of a box around the first three slabs, so that flat
    /// k-DOPs get a thickness. Corners that are closer together than that may be merged. The result has no corners and
    /// no faces if the k-DOP is empty, or if a height is not finite or exceeds 2^1000 in magnitude.
    ///
    /// # Complexity
    /// O(K^2).
    #[must_use]
    pub fn new<const K: usize>(kdop: &Kdop<K>, directions: &Directions<K>) -> Self {
        // The comparison is false for NaN, so a height that is NaN gives the empty polytope.
        if kdop.is_empty() || !kdop.heights.iter().all(|h| h.abs() <= MAX_HEIGHT) {
            return Self::default();
        }
        let (centre, half) = centre_and_half_cube(kdop, directions.normals());
        let mut polytope = Self::cube(half * 2.0);
        let thickness = half * 1e-9;
        for (normal, height) in directions.normals().iter().zip(&kdop.heights) {
            polytope.cut(normal, height - normal.dot(&centre) + thickness, thickness * 0.25);
        }
        for corner in &mut polytope.corners {
            *corner += centre;
        }
        polytope
    }

    /// Returns the cube from -h to h along each axis.
    fn cube(h: f64) -> Self {
        let corner = |i: usize| Point3::from([0, 1, 2].map(|k| if i >> k & 1 == 0 { -h } else { h }));
        let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        Self { corners: (0..8).map(corner).collect(), faces: faces.map(Vec::from).to_vec() }
    }

    /// Cuts off the part above a plane. Corners within `tolerance` of the plane count as lying on it.
    ///
    /// The basic idea is to clip each face as a polygon: keep its corners below the plane, and add one corner for each
    /// edge that crosses the plane. Where a clipped face follows the plane it has a new edge. These rim edges, chained
    /// end to end, are the border of the new face.
    fn cut(&mut self, normal: &Vector3<f64>, height: f64, tolerance: f64) {
        let above: Vec<f64> = self.corners.iter().map(|p| normal.dot(&p.coords) - height).collect();
        if above.iter().all(|d| *d <= tolerance) {
            return;
        }
        // Each edge that crosses the plane gets one new corner, which both of its faces share.
        let mut crossings: Vec<([usize; 2], usize)> = Vec::new();
        let mut corners = std::mem::take(&mut self.corners);
        let mut rim_edges = Vec::new();
        let mut faces = Vec::new();
        for face in &self.faces {
            let mut kept = Vec::with_capacity(face.len() + 1);
            let mut ends = [None; 2];
            for (i, &a) in face.iter().enumerate() {
                let b = face[(i + 1) % face.len()];
                if above[a] <= tolerance {
                    kept.push(a);
                }
                let (inside, outside) = if above[a] <= tolerance { (a, b) } else { (b, a) };
                if (above[a] <= tolerance) == (above[b] <= tolerance) {
                    continue;
                }
                let on = if above[inside] >= -tolerance {
                    inside
                } else {
                    let edge = [inside, outside];
                    match crossings.iter().find(|(known, _)| *known == edge) {
                        Some((_, corner)) => *corner,
                        None => {
                            let t = above[inside] / (above[inside] - above[outside]);
                            corners.push(corners[inside] + (corners[outside] - corners[inside]) * t);
                            crossings.push((edge, corners.len() - 1));
                            corners.len() - 1
                        }
                    }
                };
                if on != inside {
                    kept.push(on);
                }
                // A path around the face leaves the kept part once and returns to it once.
                ends[usize::from(inside == b)] = Some(on);
            }
            if kept.len() >= 3 {
                faces.push(kept);
            }
            if let [Some(leaves), Some(returns)] = ends
                && leaves != returns
            {
                rim_edges.push([returns, leaves]);
            }
        }
        // The new face runs along the rim edges, in the opposite direction to the adjacent faces.
        if let Some(&[first, mut at]) = rim_edges.first() {
            let mut around = vec![first];
            while at != first && around.len() <= rim_edges.len() {
                around.push(at);
                let Some([_, next]) = rim_edges.iter().find(|[from, _]| *from == at) else { break };
                at = *next;
            }
            if around.len() >= 3 {
                faces.push(around);
            }
        }
        self.corners = corners;
        self.faces = faces;
        self.compact();
    }

    /// Removes corners without a face.
    fn compact(&mut self) {
        let mut new_indices = vec![usize::MAX; self.corners.len()];
        let mut kept = Vec::new();
        for corner in self.faces.iter_mut().flatten() {
            if new_indices[*corner] == usize::MAX {
                new_indices[*corner] = kept.len();
                kept.push(self.corners[*corner]);
            }
            *corner = new_indices[*corner];
        }
        self.corners = kept;
    }

    /// Iterates over the edges, each of which occurs once.
    pub fn edges(&self) -> impl Iterator<Item = [Point3<f64>; 2]> + '_ {
        let around = |face: &'_ Vec<usize>| {
            let face = face.clone();
            (0..face.len()).map(move |i| [face[i], face[(i + 1) % face.len()]])
        };
        let once = self.faces.iter().flat_map(around).filter(|[a, b]| a < b);
        once.map(|edge| edge.map(|i| self.corners[i]))
    }

    /// Returns the total area of the faces.
    #[must_use]
    pub fn area(&self) -> f64 {
        let of = |face: &Vec<usize>| {
            let at = |i: usize| self.corners[face[i]] - self.corners[face[0]];
            (1..face.len() - 1).map(|i| at(i).cross(&at(i + 1))).sum::<Vector3<f64>>().norm() / 2.0
        };
        self.faces.iter().map(of).sum()
    }

    /// Returns the volume of the polytope.
    #[must_use]
    pub fn volume(&self) -> f64 {
        let Some(origin) = self.corners.first() else { return 0.0 };
        let at = |i: usize| self.corners[i] - origin;
        let cones = self
            .faces
            .iter()
            .flat_map(|face| (1..face.len() - 1).map(|i| at(face[0]).dot(&at(face[i]).cross(&at(face[i + 1])))));
        cones.sum::<f64>() / 6.0
    }
}

/// Returns the centre of the box of the first three slabs, and half of the edge of a cube around that centre that
/// contains the k-DOP.
fn centre_and_half_cube<const K: usize>(kdop: &Kdop<K>, normals: &[Vector3<f64>; K]) -> (Vector3<f64>, f64) {
    let rows = nalgebra::Matrix3::from_rows(&[0, 2, 4].map(|i: usize| normals[i].transpose()));
    let inverse = rows.try_inverse().expect("directions do not lie in a plane");
    let heights = &kdop.heights;
    let mean = Vector3::from_fn(|j, _| heights[2 * j] * 0.5 - heights[2 * j + 1] * 0.5);
    let extent = Vector3::from_fn(|j, _| heights[2 * j] * 0.5 + heights[2 * j + 1] * 0.5);
    let centre = inverse * mean;
    let half = (inverse.abs() * extent.abs()).max();
    // A single point gets the size of the rounding error of its position.
    (centre, if half > centre.amax() * 1e-12 { half } else { centre.amax() * 1e-12 + f64::MIN_POSITIVE * 1e9 })
}

/// Writes polytopes as a PLY file of polygons, one polytope after the other.
///
/// The number beside each polytope, such as its level in a tree, becomes the property `property` of its faces. Viewers
/// can colour the faces by it.
///
/// # Errors
/// Returns the errors of the writer.
pub fn write_polytopes_ply(out: &mut impl Write, polytopes: &[(Polytope, usize)], property: &str) -> io::Result<()> {
    let corners: usize = polytopes.iter().map(|(p, _)| p.corners.len()).sum();
    let faces: usize = polytopes.iter().map(|(p, _)| p.faces.len()).sum();
    writeln!(out, "ply\nformat ascii 1.0\nelement vertex {corners}")?;
    writeln!(out, "property double x\nproperty double y\nproperty double z")?;
    writeln!(
        out,
        "element face {faces}\nproperty list uint uint vertex_indices\nproperty uint {property}\nend_header"
    )?;
    for corner in polytopes.iter().flat_map(|(p, _)| &p.corners) {
        writeln!(out, "{} {} {}", corner.x, corner.y, corner.z)?;
    }
    let mut first = 0;
    for (polytope, value) in polytopes {
        for face in &polytope.faces {
            write!(out, "{}", face.len())?;
            for corner in face {
                write!(out, " {}", first + corner)?;
            }
            writeln!(out, " {value}")?;
        }
        first += polytope.corners.len();
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use p2m_core::Aabb;
    use rand::RngExt;

    /// Checks Euler's formula, that each edge has two faces, and that all corners lie within all heights and attain
    /// them.
    fn check<const K: usize>(points: &[Point3<f64>], directions: &Directions<K>) -> Polytope {
        let kdop = Kdop::from_points(directions, points);
        let p = Polytope::new(&kdop, directions);
        let edges: usize = p.faces.iter().map(Vec::len).sum();
        assert_eq!(edges, 2 * p.edges().count(), "{p:?}");
        assert_eq!(p.corners.len() + p.faces.len(), edges / 2 + 2, "{p:?}");
        let size = kdop.heights.iter().fold(0.0, |a: f64, h| a.max(h.abs()));
        for corner in &p.corners {
            for (n, h) in directions.normals().iter().zip(&kdop.heights) {
                assert!(n.dot(&corner.coords) <= h + 1e-7 * size, "{corner} is outside");
            }
        }
        for (n, h) in directions.normals().iter().zip(&kdop.heights) {
            // Heights are attained by points, so corners attain them.
            let reached = p.corners.iter().map(|c| n.dot(&c.coords)).fold(f64::NEG_INFINITY, f64::max);
            assert!(reached >= h - 1e-7 * size, "{reached} of {h}");
        }
        p
    }

    #[test]
    fn polytopes_are_closed_and_their_corners_lie_on_the_faces() {
        let cube: Vec<_> =
            (0..8).map(|i| Point3::from([0, 1, 2].map(|k| f64::from(i >> k & 1) * f64::from(k + 1)))).collect();
        let six = check(&cube, &Directions::<6>::default());
        assert_eq!((six.corners.len(), six.faces.len()), (8, 6));
        assert!((six.volume() - 6.0).abs() < 1e-6 && (six.area() - 22.0).abs() < 1e-6);
        for round in p2m_testkit::cases(300, 100) {
            let mut rng = p2m_testkit::rng("polytopes", round);
            let mut random = move || rng.random_range(-1.0..1.0);
            let far = if round % 3 == 0 { 1e4 } else { 0.0 };
            let points: Vec<_> =
                (0..3 + round % 9).map(|_| Point3::new(random() + far, random(), random() * 0.1)).collect();
            let six = check(&points, &Directions::<6>::default()).volume();
            let fourteen = check(&points, &Directions::<14>::default()).volume();
            let eighteen = check(&points, &Directions::<18>::default()).volume();
            let all = check(&points, &Directions::<26>::default()).volume();
            assert!(six * 1.000_001 >= fourteen && fourteen * 1.000_001 >= all && eighteen * 1.000_001 >= all);
            assert!(all > 0.0);
        }
    }

    #[test]
    fn flat_and_empty_polytopes_are_valid() {
        let p = Point3::new(3.0, 4.0, 5.0);
        check(&[p], &Directions::<14>::default());
        check(&[p, Point3::new(3.0, 9.0, 5.0)], &Directions::<26>::default());
        check(&[p, Point3::new(3.0, 9.0, 5.0), Point3::new(3.0, 9.0, 7.0)], &Directions::<18>::default());
        let directions = Directions::<14>::default();
        assert_eq!(Polytope::new(&Kdop::empty(), &directions), Polytope::default());
        for far in [f64::MAX, 0.7 * f64::MAX, 1e305] {
            let large = Kdop::from_points(&directions, &[Point3::new(far, far, far), Point3::new(-far, 0.0, far)]);
            assert_eq!(Polytope::new(&large, &directions), Polytope::default());
        }
        check(&[Point3::new(1e300, 1e300, -1e300), Point3::origin()], &directions);
        check(&[Point3::new(1e-300, 1e-300, -1e-300), Point3::origin()], &directions);
    }

    #[test]
    fn thickness_is_small_against_the_polytope_for_any_directions() {
        for round in p2m_testkit::cases(300, 150) {
            let mut rng = p2m_testkit::rng("flat polytopes", round);
            let mut vector = || Vector3::from_fn(|_, _| rng.random_range(-1.0..1.0));
            // The directions lie nearly in a plane, or are nearly parallel.
            let mut directions = [(); 7].map(|()| vector());
            let first = directions[0].normalize();
            for direction in &mut directions[1..4] {
                match round % 3 {
                    0 => direction.z *= 1e-5,
                    1 => *direction = first + *direction * 2e-5,
                    _ => {}
                }
            }
            let Ok(directions) = Directions::<14>::new(&directions) else { continue };
            let points = [(); 6].map(|()| Point3::from(vector()));
            let kdop = Kdop::from_points(&directions, &points);
            let polytope = check(&points, &directions);
            let bounds = Aabb::from_points(&polytope.corners);
            let size = (bounds.max - bounds.min).max() * 0.5;
            for (normal, height) in directions.normals().iter().zip(&kdop.heights) {
                let beyond = polytope.corners.iter().map(|c| normal.dot(&c.coords)).fold(f64::MIN, f64::max) - height;
                assert!(beyond <= 3e-9 * size, "{beyond:e} of {size:e} in round {round}");
            }
        }
    }

    #[test]
    fn files_have_all_polytopes() {
        let directions = Directions::<6>::default();
        let unit = Kdop::from_points(&directions, &[Point3::origin(), Point3::new(1.0, 1.0, 1.0)]);
        let one = Polytope::new(&unit, &directions);
        let mut out = Vec::new();
        write_polytopes_ply(&mut out, &[(one.clone(), 0), (one, 3)], "level").expect("memory");
        let text = String::from_utf8(out).expect("text");
        assert!(text.contains("element vertex 16\n") && text.contains("element face 12\n"));
        assert_eq!(text.lines().filter(|line| line.starts_with("4 ") && line.ends_with(" 3")).count(), 6);
    }
}
