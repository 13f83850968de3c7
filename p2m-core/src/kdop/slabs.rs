//! What all k-DOPs of a tree have in common.

use super::Directions;
use crate::Aabb;
use nalgebra::{Matrix3, Point3};

/// Directions, and what nodes compute from them.
#[derive(Clone, Debug)]
pub(crate) struct Slabs<const K: usize> {
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
        let rounds = normals.map(|n| n.iter().any(|x| *x != 0.0 && !super::is_one(*x)));
        // The determinant is at least 2^-20, so the inverse is good to 2^-28.
        let margin = if orthogonal { 2f64.powi(-40) } else { 2f64.powi(-28) };
        Self { directions: *directions, orthogonal, cosines, rounds, axes, margin }
    }

    /// Whether slab j is a pair of sides of a box along the axes: the distance to it is computed as exactly as for a tree of
    /// boxes.
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
        // The axes give the box itself.
        let points = [Point3::new(0.5, -1.0, 0.25), Point3::new(1.0, 2.0, 0.75)];
        let slabs = Slabs::new(&Directions::<14>::default());
        let bounds = slabs.enclosing_box(&Kdop::of_points(&slabs.directions, &points).heights);
        let expected = Aabb::of_points(&points);
        assert!((bounds.max - expected.max).amax() < 1e-10 && (bounds.min - expected.min).amax() < 1e-10);
    }
}
