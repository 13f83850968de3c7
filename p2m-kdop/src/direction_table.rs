//! The table of directions that all k-DOPs of a tree share.

use crate::Directions;
use crate::kdop::is_one;
use nalgebra::{Matrix3, Point3};
use p2m_core::Aabb;

/// The directions of a tree, with the constants that its nodes derive from them.
#[derive(Clone, Debug)]
pub struct DirectionTable<const K: usize> {
    pub(crate) directions: Directions<K>,
    /// Whether the first three directions are orthogonal.
    pub(crate) is_orthogonal: bool,
    /// The cosines between normal i and the first three directions if these are orthogonal, or else the coordinates of
    /// normal i.
    pub(crate) cosines: [[f32; 3]; K],
    /// Whether products with normal i are rounded. Products with a normal along an axis are exact.
    pub(crate) is_rounded: [bool; K],
    /// The axes as combinations of the first three directions.
    axes: Matrix3<f64>,
    /// The margin of enclosing boxes, relative to the heights from which they are computed.
    box_margin: f64,
}

impl<const K: usize> DirectionTable<K> {
    #[allow(clippy::cast_possible_truncation, reason = "rounding to f32 is part of the bounds' margin")]
    pub(crate) fn new(directions: &Directions<K>) -> Self {
        let normals = directions.normals();
        let first = Matrix3::from_columns(&[normals[0], normals[2], normals[4]]);
        let is_orthogonal = directions.starts_orthogonal();
        let axes =
            if is_orthogonal { first.transpose() } else { first.try_inverse().expect("directions are not flat") };
        let cosines = normals.map(|n| if is_orthogonal { first.transpose() * n } else { n }.map(|x| x as f32).into());
        let is_rounded = normals.map(|n| n.iter().any(|x| *x != 0.0 && !is_one(*x)));
        // Let M be the matrix of the first three directions and E = M^T M - 1. If the directions are orthogonal, the
        // inverse of M is M^T - E M^T in first order. Entries of E off the diagonal are at most 2^-40, so row j of
        // E M^T is at most 2^-40 times the sum of two components of one unit vector. The transpose therefore errs by at
        // most 1.42 x 2^-40, and the sums of `enclosing_box` by 2^-50.
        // Otherwise the determinant of M is at least 2^-20. Its computed value has a relative error of at most 2^-30,
        // and so has an entry of the inverse, with 2^-31 more if the entry is less than 1.
        let box_margin = if is_orthogonal { 2f64.powi(-39) } else { 2f64.powi(-28) };
        Self { directions: *directions, is_orthogonal, cosines, is_rounded, axes, box_margin }
    }

    /// Returns whether slab j is bounded by two sides of an axis-aligned box. The distance to such a slab is as
    /// accurate as in a tree of boxes.
    #[inline(always)]
    pub(crate) fn is_exact_side(&self, j: usize) -> bool {
        j < 3 && self.is_orthogonal && !self.is_rounded[2 * j]
    }

    /// Returns a direction as a weighted sum of three heights: their numbers and non-negative factors.
    pub(crate) fn as_sum_of_heights(&self, direction: &[f64; 3]) -> [(usize, f64); 3] {
        std::array::from_fn(|j| {
            let weight: f64 = (0..3).map(|axis| direction[axis] * self.axes[(j, axis)]).sum();
            (2 * j + usize::from(weight < 0.0), weight.abs())
        })
    }

    /// Returns a box around the k-DOP with these heights.
    pub(crate) fn enclosing_box(&self, heights: &[f64; K]) -> Aabb<f64> {
        let extent = |axis: usize, sign: f64| {
            let terms = (0..3).map(|j| {
                let weight = sign * self.axes[(j, axis)];
                let height = heights[2 * j + usize::from(weight < 0.0)];
                let size = heights[2 * j].abs().max(heights[2 * j + 1].abs());
                weight.abs() * height + self.box_margin * weight.abs().max(1.0) * size
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
    fn boxes_contain_the_points_for_any_directions() {
        let skew = [Vector3::new(1.0, 1.0, 0.0), Vector3::new(1.0, -0.8, 0.1), Vector3::new(0.2, 0.1, 1.0)];
        let turned = [Vector3::new(2.0, 1.0, 0.0), Vector3::new(1.0, -2.0, 0.0), Vector3::z()];
        let flat = [Vector3::x(), Vector3::new(1.0, 2e-6, 0.0), Vector3::z()];
        for directions in [skew, turned, flat] {
            let directions = Directions::<6>::new(&directions).expect("three");
            let table = DirectionTable::new(&directions);
            for i in 0..200 {
                let t = f64::from(i) * 0.37;
                let points = [Point3::new(t.sin(), t.cos(), 0.3), Point3::new(-t.sin(), (2.0 * t).cos(), 1.0)];
                let bounds = table.enclosing_box(&Kdop::from_points(&directions, &points).heights);
                let around = Aabb::from_points(&points);
                assert!(bounds.contains(&around), "{bounds:?} for {around:?}");
            }
        }
        // These directions are orthogonal to slightly less than 2^-40. The directions of the loop below have a
        // determinant slightly above 2^-20.
        let c = 0.99 * 2f64.powi(-40) * 2f64.sqrt();
        let nearly = [Vector3::new(1.0, 0.0, c), Vector3::new(0.0, 1.0, 1.0), Vector3::new(0.0, -1.0, 1.0)];
        let nearly = Directions::<6>::new(&nearly).expect("three");
        assert!(nearly.starts_orthogonal());
        let check = |directions: &Directions<6>, points: &[Point3<f64>]| {
            let bounds = DirectionTable::new(directions).enclosing_box(&Kdop::from_points(directions, points).heights);
            assert!(points.iter().all(|p| bounds.contains(&Aabb::from_points(&[*p]))), "{directions:?} {points:?}");
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
        // With the axes as directions, the box is the box of the points.
        let points = [Point3::new(0.5, -1.0, 0.25), Point3::new(1.0, 2.0, 0.75)];
        let table = DirectionTable::new(&Directions::<14>::default());
        let bounds = table.enclosing_box(&Kdop::from_points(&table.directions, &points).heights);
        let expected = Aabb::from_points(&points);
        assert!((bounds.max - expected.max).amax() < 1e-10 && (bounds.min - expected.min).amax() < 1e-10);
    }
}
