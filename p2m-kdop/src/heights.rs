//! What all k-DOPs of a tree have in common.

use crate::Directions;
use crate::kdop::is_one;
use nalgebra::{Matrix3, Point3};
use p2m_core::Aabb;

/// Directions, and what nodes compute from them.
#[derive(Clone, Debug)]
pub struct Slabs<const K: usize> {
    pub(crate) directions: Directions<K>,
    /// Whether the first three directions are orthogonal.
    pub(crate) orthogonal: bool,
    /// If so, the cosines between normal i and these three; else the coordinates of normal i.
    pub(crate) cosines: [[f32; 3]; K],
    /// Whether products with normal i are rounded: not with those along an axis.
    pub(crate) rounds: [bool; K],
    /// The axes as combinations of the first three directions.
    axes: Matrix3<f64>,
    /// How much boxes are widened, in parts of what they are computed from.
    margin: f64,
}

impl<const K: usize> Slabs<K> {
    #[allow(clippy::cast_possible_truncation, reason = "rounding to f32 is part of the bounds' margin")]
    pub(crate) fn new(directions: &Directions<K>) -> Self {
        let normals = directions.normals();
        let first = Matrix3::from_columns(&[normals[0], normals[2], normals[4]]);
        let orthogonal = directions.starts_orthogonal();
        let axes = if orthogonal { first.transpose() } else { first.try_inverse().expect("directions are not flat") };
        let cosines = normals.map(|n| if orthogonal { first.transpose() * n } else { n }.map(|x| x as f32).into());
        let rounds = normals.map(|n| n.iter().any(|x| *x != 0.0 && !is_one(*x)));
        // With M for the matrix of the three and E for M^T M - 1, the inverse is M^T - E M^T in first order. Off its
        // diagonal E is 2^-40 at most, so row j of E M^T is at most 2^-40 times the sum of two components of one unit
        // vector: the transpose is good to 1.42 x 2^-40, and the sums below to 2^-50.
        // Otherwise the determinant is 2^-20 at least: the relative error of its computed value is 2^-30, that of an
        // entry of the inverse as much, and 2^-31 more where the entry is less than 1.
        let margin = if orthogonal { 2f64.powi(-39) } else { 2f64.powi(-28) };
        Self { directions: *directions, orthogonal, cosines, rounds, axes, margin }
    }

    /// Whether slab j is a pair of sides of a box along the axes: the distance to it is computed as exactly as for a
    /// tree of boxes.
    #[inline(always)]
    pub(crate) fn is_exact_side(&self, j: usize) -> bool {
        j < 3 && self.orthogonal && !self.rounds[2 * j]
    }

    /// A box around the k-DOP of these heights.
    pub(crate) fn enclosing_box(&self, heights: &[f64; K]) -> Aabb<f64> {
        let extent = |axis: usize, sign: f64| {
            let terms = (0..3).map(|j| {
                let weight = sign * self.axes[(j, axis)];
                let height = heights[2 * j + usize::from(weight < 0.0)];
                let size = heights[2 * j].abs().max(heights[2 * j + 1].abs());
                weight.abs() * height + self.margin * weight.abs().max(1.0) * size
            });
            terms.sum::<f64>()
        };
        Aabb {
            min: Point3::from(std::array::from_fn(|k| -extent(k, -1.0))),
            max: Point3::from(std::array::from_fn(|k| extent(k, 1.0))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Kdop;
    use nalgebra::Vector3;
    use rand::RngExt;

    #[test]
    fn boxes_hold_the_points_whatever_the_directions() {
        let skew = [Vector3::new(1.0, 1.0, 0.0), Vector3::new(1.0, -0.8, 0.1), Vector3::new(0.2, 0.1, 1.0)];
        let turned = [Vector3::new(2.0, 1.0, 0.0), Vector3::new(1.0, -2.0, 0.0), Vector3::z()];
        let flat = [Vector3::x(), Vector3::new(1.0, 2e-6, 0.0), Vector3::z()];
        for directions in [skew, turned, flat] {
            let directions = Directions::<6>::new(&directions).expect("three");
            let slabs = Slabs::new(&directions);
            for i in 0..200 {
                let t = f64::from(i) * 0.37;
                let points = [Point3::new(t.sin(), t.cos(), 0.3), Point3::new(-t.sin(), (2.0 * t).cos(), 1.0)];
                let bounds = slabs.enclosing_box(&Kdop::of_points(&directions, &points).heights);
                let around = Aabb::of_points(&points);
                assert!(bounds.contains(&around), "{bounds:?} for {around:?}");
            }
        }
        // Orthogonal to nearly 2^-40; and with a determinant of a little more than 2^-20.
        let c = 0.99 * 2f64.powi(-40) * 2f64.sqrt();
        let nearly = [Vector3::new(1.0, 0.0, c), Vector3::new(0.0, 1.0, 1.0), Vector3::new(0.0, -1.0, 1.0)];
        let nearly = Directions::<6>::new(&nearly).expect("three");
        assert!(nearly.starts_orthogonal());
        let check = |directions: &Directions<6>, points: &[Point3<f64>]| {
            let bounds = Slabs::new(directions).enclosing_box(&Kdop::of_points(directions, points).heights);
            assert!(points.iter().all(|p| bounds.contains(&Aabb::of_points(&[*p]))), "{directions:?} {points:?}");
        };
        for sign in [-1.0, 1.0] {
            check(&nearly, &[Point3::new(sign, 0.0, 0.0)]);
        }
        for case in p2m_testkit::cases(2000, 2000) {
            let mut rng = p2m_testkit::rng("enclosing boxes", case);
            let mut random = || rng.random_range(-1.0..1.0);
            let point = Point3::new(random(), random(), random());
            check(&nearly, &[point]);
            let [u, v] = [(); 2].map(|()| Vector3::new(random(), random(), random()).normalize());
            let flat = [u, v, u * random() + v * random() + u.cross(&v) * 4e-6];
            if let Ok(directions) = Directions::<6>::new(&flat) {
                check(&directions, &[point]);
            }
        }
        // The axes give the box itself.
        let points = [Point3::new(0.5, -1.0, 0.25), Point3::new(1.0, 2.0, 0.75)];
        let slabs = Slabs::new(&Directions::<14>::default());
        let bounds = slabs.enclosing_box(&Kdop::of_points(&slabs.directions, &points).heights);
        let expected = Aabb::of_points(&points);
        assert!((bounds.max - expected.max).amax() < 1e-10 && (bounds.min - expected.min).amax() < 1e-10);
    }
}
