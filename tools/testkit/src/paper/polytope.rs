//! Bounded convex polytopes that are cut by half-spaces, in f64 with a tolerance.

use nalgebra::{Point3, Vector3};

/// The half-space of points x with `normal . x <= offset`.
#[derive(Clone, Copy, Debug)]
pub(super) struct HalfSpace {
    /// The normal, a unit vector.
    normal: Vector3<f64>,
    offset: f64,
}

impl HalfSpace {
    /// Returns the half-space behind a plane through a point.
    pub(super) fn behind(point: &Point3<f64>, normal: &Vector3<f64>) -> Self {
        let normal = normal.normalize();
        Self { normal, offset: normal.dot(&point.coords) }
    }

    /// Returns the half-space of points that are at least as near to `a` as to `b`.
    pub(super) fn nearer_to(a: &Point3<f64>, b: &Point3<f64>) -> Self {
        Self::behind(&nalgebra::center(a, b), &(b - a))
    }

    pub(super) fn height(&self, x: &Point3<f64>) -> f64 {
        self.normal.dot(&x.coords) - self.offset
    }
}

/// A bounded convex polytope, as a list of faces with ordered corners. A flat polytope, a segment or a point has faces
/// with fewer corners, and an empty one has no faces.
#[derive(Clone, Debug)]
pub struct Polytope {
    faces: Vec<Face>,
    tolerance: f64,
}

#[derive(Clone, Debug)]
pub(super) struct Face {
    /// The vertex of the cell behind the face.
    neighbour: Option<usize>,
    corners: Vec<Point3<f64>>,
}

impl Polytope {
    pub(super) fn cube(centre: &Point3<f64>, half_width: f64, tolerance: f64) -> Self {
        let mut faces = Vec::new();
        for axis in 0..3 {
            for side in [-half_width, half_width] {
                let corner = |(i, j): (f64, f64)| {
                    let mut offset = Vector3::zeros();
                    (offset[axis], offset[(axis + 1) % 3], offset[(axis + 2) % 3]) =
                        (side, i * half_width, j * half_width);
                    centre + offset
                };
                let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(corner).to_vec();
                faces.push(Face { neighbour: None, corners });
            }
        }
        Self { faces, tolerance }
    }

    /// Returns the corners, some of them several times.
    pub fn corners(&self) -> impl Iterator<Item = &Point3<f64>> {
        self.faces.iter().flat_map(|face| &face.corners)
    }

    /// Intersects the polytope with a half-space (section 4.4, *plane cutting*). The new face gets the given
    /// `neighbour`.
    pub(super) fn cut(&mut self, by: &HalfSpace, neighbour: Option<usize>) {
        if self.corners().all(|x| by.height(x) <= self.tolerance) {
            return;
        }
        let mut new: Vec<Point3<f64>> = Vec::new();
        for face in &mut self.faces {
            let mut rest = Vec::new();
            for (i, a) in face.corners.iter().enumerate() {
                let b = &face.corners[(i + 1) % face.corners.len()];
                let (ha, hb) = (by.height(a), by.height(b));
                if ha <= self.tolerance {
                    rest.push(*a);
                }
                if ha.min(hb) < -self.tolerance && ha.max(hb) > self.tolerance {
                    rest.push(a + (b - a) * (ha / (ha - hb)));
                }
            }
            new.extend(rest.iter().filter(|x| by.height(x).abs() <= self.tolerance));
            face.corners = rest;
        }
        self.faces.retain(|face| !face.corners.is_empty());
        if let Some(centre) = centre(&new) {
            // Corners are sorted around the normal; equal corners of several faces become adjacent.
            let u = new.iter().map(|x| x - centre).max_by(|a, b| a.norm().total_cmp(&b.norm())).expect("not empty");
            let w = by.normal.cross(&u);
            let angle = |x: &Point3<f64>| (x - centre).dot(&w).atan2((x - centre).dot(&u));
            new.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
            new.dedup_by(|a, b| (*a - *b).norm() <= self.tolerance);
            self.faces.push(Face { neighbour, corners: new });
        }
    }

    /// Returns the vertices of the neighbouring cells, as far as their faces have remained.
    pub(super) fn neighbours(&self) -> impl Iterator<Item = usize> {
        let has_area = |face: &&Face| {
            let first = face.corners[0];
            let fan = face.corners.windows(2).map(|pair| (pair[0] - first).cross(&(pair[1] - first)));
            fan.sum::<Vector3<f64>>().norm() > self.tolerance
        };
        self.faces.iter().filter(has_area).filter_map(|face| face.neighbour)
    }
}

/// Returns the mean of some points.
#[must_use]
pub fn centre(points: &[Point3<f64>]) -> Option<Point3<f64>> {
    let sum: Vector3<f64> = points.iter().map(|x| x.coords).sum();
    (!points.is_empty()).then(|| Point3::from(sum / points.len() as f64))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn cubes_are_cut_at_edges_and_at_corners() {
        let cases = [(-0.1, 0), (0.0, 1), (0.5, 4), (1.0, 4), (1.5, 10), (2.0, 7), (2.5, 10), (3.0, 8), (4.0, 8)];
        for (height, expected) in cases {
            let mut cube = Polytope::cube(&Point3::new(0.5, 0.5, 0.5), 0.5, 1e-11);
            let normal = Vector3::repeat(1.0);
            cube.cut(&HalfSpace::behind(&Point3::new(height, 0.0, 0.0), &normal), Some(7));
            let corners: BTreeSet<_> = cube.corners().map(|x| [0, 1, 2].map(|k| (x[k] * 1e6).round() as i64)).collect();
            assert_eq!(corners.len(), expected, "{height}");
            let is_cut = (0.1..2.9).contains(&height);
            assert_eq!(cube.neighbours().collect::<Vec<_>>(), if is_cut { vec![7] } else { vec![] }, "{height}");
        }
    }
}
