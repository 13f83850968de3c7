//! k-DOPs: convex polytopes whose K faces have given directions.
//!
//! A k-DOP is the set of points x with n_i . x <= h_i for K unit vectors n_i, which come in pairs of opposites, and
//! *heights* h_i. With more directions it fits a scene more closely. A box is the k-DOP whose directions are the axes.
//!
//! # References
//! \[Klosowski1998\] introduces the volumes. The sets of directions are taken from the manual of the k-DOP tree in
//! CGAL.

use crate::Directions;
use nalgebra::{Point3, Vector3};
use p2m_core::{Aabb, Real};

/// A k-DOP, given by its heights along the normals of some [`Directions`].
///
/// Heights of points are rounded outwards, so a k-DOP contains the points from which it was computed. A height is
/// infinite if its computation overflows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kdop<const K: usize> {
    /// The heights: `heights[i]` is the maximum of n_i . x over all points x.
    pub heights: [f64; K],
}

impl<const K: usize> Kdop<K> {
    /// Returns the empty k-DOP.
    #[must_use]
    pub fn empty() -> Self {
        Self { heights: [f64::NEG_INFINITY; K] }
    }

    /// Returns the smallest k-DOP around some points, rounded outwards by at most 2^-49 of their distance from the
    /// origin.
    #[must_use]
    pub fn from_points<T: Real>(directions: &Directions<K>, points: &[Point3<T>]) -> Self {
        let mut result = Self::empty();
        for point in points {
            let x = Vector3::from(p2m_core::engine::real::to_f64_array(point));
            for (height, normal) in result.heights.iter_mut().zip(directions.normals()) {
                *height = height.max(product_above(normal, &x));
            }
        }
        result
    }

    /// Returns the smallest k-DOP around a box, rounded outwards by at most 2^-49 of the distance of its corners from
    /// the origin.
    #[must_use]
    pub fn from_box(directions: &Directions<K>, bounds: &Aabb<f64>) -> Self {
        if bounds.is_empty() {
            return Self::empty();
        }
        Self { heights: std::array::from_fn(|i| box_height(&directions.normals()[i], bounds)) }
    }

    /// Returns the smallest k-DOP around two k-DOPs of the same directions.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self { heights: std::array::from_fn(|i| self.heights[i].max(other.heights[i])) }
    }

    /// Returns whether two k-DOPs of the same directions overlap along every direction.
    ///
    /// The result is never `false` for two k-DOPs with a point in common, but it may be `true` for two without one.
    #[must_use]
    pub fn may_intersect(&self, other: &Self) -> bool {
        (0..K).all(|i| -other.heights[i ^ 1] <= self.heights[i])
    }

    /// Returns whether this k-DOP and a box overlap along every direction of the k-DOP. The directions of the box are
    /// not tested; to test them, compare the box with a box around the k-DOP.
    #[must_use]
    pub fn may_intersect_box(&self, directions: &Directions<K>, bounds: &Aabb<f64>) -> bool {
        !bounds.is_empty() && self.may_intersect(&Self::from_box(directions, bounds))
    }

    /// Returns whether another k-DOP of the same directions lies in this one.
    #[must_use]
    pub fn contains(&self, other: &Self) -> bool {
        (0..K).all(|i| other.heights[i] <= self.heights[i])
    }

    /// Returns whether a point lies in the k-DOP. Products are rounded down, so a point slightly outside may count as
    /// inside.
    #[must_use]
    pub fn contains_point(&self, directions: &Directions<K>, point: &Point3<f64>) -> bool {
        let mut heights = directions.normals().iter().zip(&self.heights);
        heights.all(|(normal, height)| -product_above(&-normal, &point.coords) <= *height)
    }

    /// Returns whether some slab has its faces in the wrong order, so that the k-DOP has no points.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        !(0..K).step_by(2).all(|i| -self.heights[i + 1] <= self.heights[i])
    }
}

/// Returns whether multiplication by a factor changes at most the sign of a number.
#[allow(clippy::float_cmp, reason = "exactly 1 is meant")]
pub(crate) fn is_one(x: f64) -> bool {
    x.abs() == 1.0
}

/// Returns normal . x, rounded up. The result is exact if the normal is along an axis.
fn product_above(normal: &Vector3<f64>, x: &Vector3<f64>) -> f64 {
    // Terms with a factor of 0 are left out, because their coordinates may be infinite.
    let mut sum = 0.0;
    let mut size = 0.0;
    let mut is_rounded = false;
    for (n, x) in normal.iter().zip(x) {
        if *n != 0.0 {
            sum += n * x;
            size += (n * x).abs();
            is_rounded |= !is_one(*n);
        }
    }
    // Three products and their sum err by at most 3 u of their magnitudes, apart from underflow. If the magnitudes
    // overflow, so may any part of the sum.
    match is_rounded {
        false => sum,
        true if size.is_finite() => sum + size * (4.0 * f64::EPSILON) + f64::MIN_POSITIVE,
        true => f64::INFINITY,
    }
}

/// Returns the height of a box along a normal, rounded up.
fn box_height(normal: &Vector3<f64>, bounds: &Aabb<f64>) -> f64 {
    product_above(normal, &Vector3::from_fn(|k, _| if normal[k] > 0.0 { bounds.max[k] } else { bounds.min[k] }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use p2m_testkit::oracle::is_product_at_most;
    use rand::RngExt;

    #[test]
    fn heights_are_never_below_exact_products() {
        let directions = Directions::<26>::default();
        for case in p2m_testkit::cases(2000, 480) {
            let (round, mut rng) = (case as usize, p2m_testkit::rng("heights", case));
            let scale = [1.0, 1e-310, 1e300, 1e8][round % 4];
            let mut x = Vector3::from_fn(|_, _| rng.random_range(-1.0..1.0));
            if round % 3 > 0 {
                // The terms of the product with a normal cancel.
                let n = directions.normals()[rng.random_range(6..26)];
                x = n.cross(&x);
            }
            x *= scale;
            let kdop = Kdop::from_points(&directions, &[Point3::from(x)]);
            for (n, h) in directions.normals().iter().zip(&kdop.heights) {
                assert!(is_product_at_most((*n).into(), x.into(), *h), "{n} {x} {h:e}");
                assert!(h - n.dot(&x) <= x.norm() * 2f64.powi(-48) + 2.0 * f64::MIN_POSITIVE, "{n} {x} {h:e}");
            }
        }
    }

    #[test]
    fn volumes_that_touch_may_meet_and_separate_ones_do_not_in_either_order() {
        let directions = Directions::<14>::default();
        let normals = directions.normals();
        for (i, normal) in normals.iter().enumerate() {
            let below = Kdop::from_points(&directions, &[Point3::from(*normal), Point3::from(normal * 2.0)]);
            let above = Kdop::from_points(&directions, &[Point3::from(normal * 3.0)]);
            assert!(!below.may_intersect(&above) && !above.may_intersect(&below), "apart along {normal}");
            // These two volumes are separated along this normal alone.
            let mut other = below;
            other.heights = other.heights.map(|h| h + 10.0);
            other.heights[i ^ 1] = -below.heights[i];
            assert!(other.may_intersect(&below) && below.may_intersect(&other), "touching along {normal}");
            other.heights[i ^ 1] = (-below.heights[i]).next_down();
            assert!(!other.may_intersect(&below) && !below.may_intersect(&other), "apart along {normal}");
        }
    }

    #[test]
    fn heights_that_overflow_are_infinite() {
        let directions = Directions::<26>::default();
        let m = f64::MAX;
        for corner in [[-m, -m, -m], [m, m, m], [0.7 * m, -0.7 * m, 0.7 * m], [-0.7 * m, -0.7 * m, 0.0], [m, -m, 0.0]] {
            let point = Point3::from(corner);
            let kdop = Kdop::from_points(&directions, &[point]);
            assert!(kdop.heights.iter().all(|h| *h > f64::NEG_INFINITY), "{kdop:?}");
            assert!(!kdop.is_empty() && kdop.contains_point(&directions, &point), "{kdop:?}");
            assert!(kdop.may_intersect(&kdop) && kdop.may_intersect_box(&directions, &Aabb { min: point, max: point }));
            let all = Aabb { min: Point3::new(-m, -m, -m), max: Point3::new(m, m, m) };
            assert!(kdop.may_intersect_box(&directions, &all) && Kdop::from_box(&directions, &all).contains(&kdop));
        }
    }

    #[test]
    fn a_box_is_the_six_dop_of_its_corners() {
        let corners = [Point3::new(0.1, -2.0, 3.0), Point3::new(1.5, 7.0, 3.25)];
        let six = Kdop::from_points(&Directions::<6>::default(), &corners);
        assert_eq!(six.heights, [1.5, -0.1, 7.0, 2.0, 3.25, -3.0]);
        assert_eq!(six, Kdop::from_box(&Directions::default(), &Aabb::from_points(&corners)));
        let half = Aabb { max: Point3::new(0.0, f64::INFINITY, 0.0), ..Aabb::from_points(&corners) };
        assert!(Kdop::from_box(&Directions::<6>::default(), &half).is_empty());
    }

    #[test]
    fn kdops_contain_their_points_and_cut_off_corners() {
        let directions = Directions::<26>::default();
        let points = [Point3::new(1.0, 0.0, 0.0), Point3::new(0.0, 1.0, 0.0), Point3::new(0.0, 0.0, 1.0)];
        let kdop = Kdop::from_points(&directions, &points);
        assert!(points.iter().all(|p| kdop.contains_point(&directions, p)) && !kdop.is_empty());
        assert!(!kdop.contains_point(&directions, &Point3::new(0.9, 0.9, 0.9)));
        assert!(!kdop.may_intersect(&Kdop::from_points(&directions, &[Point3::new(0.9, 0.9, 0.9)])));
        assert!(kdop.may_intersect(&Kdop::from_points(&directions, &[Point3::new(0.25, 0.5, 0.25)])));
        assert!(!kdop.may_intersect(&Kdop::empty()) && Kdop::<26>::empty().is_empty());
        let corner = |x: f64| Aabb { min: Point3::new(x, x, x), max: Point3::new(9.0, f64::INFINITY, 9.0) };
        assert!(
            kdop.may_intersect_box(&directions, &corner(0.3)) && !kdop.may_intersect_box(&directions, &corner(0.4))
        );
        assert!(kdop.contains(&Kdop::from_points(&directions, &points[..2])));
        assert!(kdop.union(&Kdop::empty()) == kdop);
    }
}
