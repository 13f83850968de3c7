//! Convex polytopes, represented by their corners and edges: a Voronoi cell, and its parts.

use p2m_core::engine::vector::{V3, norm_squared, sub};

/// Corners of cells, with the lengths that the corner test needs.
#[derive(Default)]
pub(crate) struct CornerPoints {
    /// The positions of the corners.
    pub(crate) positions: Vec<V3>,
    /// For each corner its distance from the sites of its cells, increased by its error and by the slack.
    pub(crate) upper_bounds: Vec<f64>,
    /// For each corner an upper bound of the error of its position.
    pub(crate) errors: Vec<f64>,
    /// The largest of `upper_bounds`.
    pub(crate) max_upper_bound: f64,
    /// The largest of `errors`.
    pub(crate) max_error: f64,
}

impl CornerPoints {
    /// Removes all corners.
    pub(crate) fn clear(&mut self) {
        self.positions.clear();
        self.upper_bounds.clear();
        self.errors.clear();
        (self.max_upper_bound, self.max_error) = (0.0, 0.0);
    }

    /// Adds a corner.
    pub(crate) fn push(&mut self, position: V3, upper_bound: f64, error: f64) {
        self.positions.push(position);
        self.upper_bounds.push(upper_bound);
        self.errors.push(error);
        (self.max_upper_bound, self.max_error) = (self.max_upper_bound.max(upper_bound), self.max_error.max(error));
    }

    /// Returns a length that exceeds the errors of the corners.
    pub(crate) fn margin(&self) -> f64 {
        margin(self.max_upper_bound, self.max_error)
    }
}

/// Returns a length that exceeds the errors of the corners of a cell.
pub(crate) fn margin(max_upper_bound: f64, max_error: f64) -> f64 {
    4.0 * max_error + 1e-12 * max_upper_bound
}

/// A convex polytope around a site or beside it.
#[derive(Default)]
pub(crate) struct CellPolytope {
    /// The corners of the polytope.
    pub(crate) corners: CornerPoints,
    /// For each corner the numbers of three faces that meet there.
    faces: Vec<[u32; 3]>,
    /// The pairs of corners that an edge joins.
    pub(crate) edges: Vec<[u32; 2]>,
}

impl CellPolytope {
    /// Removes all corners, faces and edges.
    pub(crate) fn clear(&mut self) {
        self.corners.clear();
        self.faces.clear();
        self.edges.clear();
    }

    /// Adds a corner.
    pub(crate) fn push(&mut self, corner: V3, error: f64, faces: [u32; 3], site: &V3, slack: f64) {
        let distance = norm_squared(sub(corner, *site)).sqrt() * (1.0 + 8.0 * f64::EPSILON);
        self.corners.push(corner, distance + error + slack, error);
        self.faces.push(faces);
    }

    /// Returns whether the number of edges is plausible: about as many as a polytope with three edges at each corner
    /// has. Where planes nearly coincide, as those of coplanar cells do, rounding may cut a face more than twice. Then
    /// an edge joins any two of the cuts, and each further plane multiplies their number.
    pub(crate) fn is_simple(&self) -> bool {
        self.edges.len() <= 2 * self.corners.positions.len() + 16
    }

    /// Replaces the polytope by the part of another one where `height`, which is linear, is at least zero. The new face
    /// gets the number `face`.
    ///
    /// Corners with a height of at least zero are kept. An edge whose ends lie on different sides gets a new corner
    /// where its height is zero. Two new corners on the same old face are the ends of a new edge, because the plane
    /// cuts that face there.
    pub(crate) fn clip(&mut self, source: &Self, height: impl Fn(&V3) -> f64, face: u32, site: &V3, slack: f64) {
        self.clear();
        let heights: Vec<f64> = source.corners.positions.iter().map(height).collect();
        let mut numbers = vec![u32::MAX; heights.len()];
        let number = |polytope: &Self| u32::try_from(polytope.corners.positions.len()).expect("few corners");
        for (i, corner) in source.corners.positions.iter().enumerate().filter(|(i, _)| heights[*i] >= 0.0) {
            numbers[i] = number(self);
            self.push(*corner, source.corners.errors[i], source.faces[i], site, slack);
        }
        let first = number(self);
        for [a, b] in source.edges.iter().map(|e| e.map(|i| i as usize)) {
            let (a, b) = if heights[a] >= 0.0 { (a, b) } else { (b, a) };
            if heights[a] < 0.0 {
                continue;
            }
            if heights[b] >= 0.0 {
                self.edges.push([numbers[a], numbers[b]]);
                continue;
            }
            let t = heights[a] / (heights[a] - heights[b]);
            let (from, to) = (source.corners.positions[a], source.corners.positions[b]);
            let corner = std::array::from_fn(|k| from[k] + t * (to[k] - from[k]));
            // The error covers both ends and the rounding of the sum. A displacement along the edge is harmless.
            let error = source.corners.errors[a].max(source.corners.errors[b])
                + source.corners.max_upper_bound * 4.0 * f64::EPSILON;
            let mut faces = [face; 3];
            let common = source.faces[a].iter().filter(|f| source.faces[b].contains(f));
            faces.iter_mut().zip(common.take(2)).for_each(|(to, f)| *to = *f);
            self.edges.push([numbers[a], number(self)]);
            self.push(corner, error, faces, site, slack);
        }
        // The new face shares an edge with each face that it cuts.
        let ends_on_faces: Vec<(u32, u32)> = (first..number(self))
            .flat_map(|i| self.faces[i as usize].into_iter().filter(|f| *f != face).map(move |f| (f, i)))
            .collect();
        for (n, (f, i)) in ends_on_faces.iter().enumerate() {
            let others = ends_on_faces[..n].iter().filter(|(g, _)| g == f);
            self.edges.extend(others.map(|(_, j)| [*i, *j]));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use p2m_core::engine::vector::dot;
    use rand::RngExt;
    use std::collections::BTreeSet;

    fn cube() -> CellPolytope {
        let mut polytope = CellPolytope::default();
        for i in 0..8u32 {
            let bits = [0, 1, 2].map(|k| i >> k & 1);
            // Each axis has two faces.
            let faces = std::array::from_fn(|k| 2 * k as u32 + bits[k]);
            polytope.push(bits.map(f64::from), 0.0, faces, &[0.5; 3], 0.0);
            polytope.edges.extend((0..3).filter(|k| i >> k & 1 == 0).map(|k| [i, i | 1 << k]));
        }
        polytope
    }

    /// A cube is cut again and again. Each time the rest is a polytope by Euler's formula, its corners are above all
    /// planes and on the faces that they name, and no point of it is lost.
    #[test]
    fn what_is_cut_off_is_what_lies_below() {
        let mut cuts = 0;
        let cases = p2m_testkit::cases(300, 150);
        for case in cases.clone() {
            let mut rng = p2m_testkit::rng("hulls", case);
            let (mut polytope, mut planes) = (cube(), Vec::<(V3, f64)>::new());
            for face in 6..14 {
                let normal: V3 = p2m_testkit::vector(&mut rng).into();
                let inside: V3 = std::array::from_fn(|_| rng.random_range(0.2..0.8));
                let offset = dot(inside, normal);
                planes.push((normal, offset));
                let mut next = CellPolytope::default();
                next.clip(&polytope, |x| dot(*x, normal) - offset, face, &[0.5; 3], 0.0);
                polytope = next;
                let faces: BTreeSet<u32> = polytope.faces.iter().flatten().copied().collect();
                if polytope.corners.positions.is_empty() {
                    break;
                }
                assert_eq!(
                    polytope.corners.positions.len() + faces.len(),
                    polytope.edges.len() + 2,
                    "case {case}, face {face}"
                );
                assert!(polytope.is_simple());
                cuts += 1;
                for (corner, faces) in polytope.corners.positions.iter().zip(&polytope.faces) {
                    for (number, (normal, offset)) in (6..).zip(&planes) {
                        let height = dot(*corner, *normal) - offset;
                        assert!(height > -1e-12 && (!faces.contains(&number) || height < 1e-12), "{height}");
                    }
                }
            }
            // A random point above all planes is in no direction beyond all corners.
            for _ in 0..200 {
                let point: V3 = std::array::from_fn(|_| rng.random());
                if planes.iter().all(|(normal, offset)| dot(point, *normal) > *offset) {
                    let direction: V3 = p2m_testkit::vector(&mut rng).into();
                    let farthest =
                        polytope.corners.positions.iter().map(|c| dot(*c, direction)).fold(f64::NEG_INFINITY, f64::max);
                    assert!(dot(point, direction) <= farthest + 1e-12, "case {case}");
                }
            }
        }
        assert!(cases.have_more_than(1000, cuts), "{cuts}");
    }

    /// The planes differ only by rounding, as those of coplanar cells do.
    #[test]
    fn polytopes_that_rounding_has_spoiled_are_detected_before_they_grow() {
        let mut detected = 0;
        let cases = p2m_testkit::cases(300, 150);
        for case in cases.clone() {
            let mut rng = p2m_testkit::rng("hulls of rounding", case);
            let mut polytope = cube();
            for face in 6..14 {
                let normal: V3 = p2m_testkit::vector(&mut rng).into();
                let mut next = CellPolytope::default();
                next.clip(&polytope, |x| dot(sub(*x, [0.5; 3]), normal) + 0.2, face, &[0.5; 3], 0.0);
                polytope = next;
            }
            let normal: V3 = p2m_testkit::vector(&mut rng).into();
            for face in 14..80 {
                let [tilt, offset]: [V3; 2] = [(); 2].map(|()| p2m_testkit::vector(&mut rng).into());
                let normal: V3 = std::array::from_fn(|k| normal[k] + 2e-16 * tilt[k]);
                let mut next = CellPolytope::default();
                next.clip(&polytope, |x| dot(sub(*x, [0.5; 3]), normal) + 1e-16 * offset[0], face, &[0.5; 3], 0.0);
                polytope = next;
                if !polytope.is_simple() {
                    detected += 1;
                    break;
                }
                assert!(polytope.corners.positions.len() < 1000, "{} corners", polytope.corners.positions.len());
            }
        }
        assert!(cases.have_more_than(10, detected), "{detected}");
    }
}
