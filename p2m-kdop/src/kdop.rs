//! k-DOPs: convex polytopes with K faces of given directions.
//!
//! A k-DOP is the set of points x with n_i . x <= h_i for K unit vectors n_i, which come in pairs of opposites, and
//! *heights* h_i. It fits a scene the closer the more directions there are; a box is the k-DOP of the six axes.
//!
//! # References
//! \[Klosowski1998\]; the k-DOP tree of CGAL's manual, of which the sets of directions are.

use crate::Directions;
use nalgebra::{Point3, Vector3};
use p2m_core::{Aabb, Real};

/// A k-DOP by its heights: `heights[i]` is the largest n_i . x, for the normals of some [`Directions`].
///
/// What is computed of points is rounded outwards, so a k-DOP contains what it was made of. Where products leave the
/// range of f64 a height cannot be told, and is infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kdop<const K: usize> {
    /// One for each normal.
    pub heights: [f64; K],
}

impl<const K: usize> Kdop<K> {
    /// The k-DOP that holds nothing.
    #[must_use]
    pub fn empty() -> Self {
        Self { heights: [f64::NEG_INFINITY; K] }
    }

    /// The smallest k-DOP around some points, rounded outwards by 2^-49 of their distance from the origin at most.
    #[must_use]
    pub fn of_points<T: Real>(directions: &Directions<K>, points: &[Point3<T>]) -> Self {
        let mut result = Self::empty();
        for point in points {
            let x = Vector3::from(p2m_core::engine::real::to_f64_array(point));
            for (height, normal) in result.heights.iter_mut().zip(directions.normals()) {
                *height = height.max(above(normal, &x));
            }
        }
        result
    }

    /// The smallest k-DOP around a box, rounded likewise.
    #[must_use]
    pub fn of_box(directions: &Directions<K>, bounds: &Aabb<f64>) -> Self {
        if bounds.is_empty() {
            return Self::empty();
        }
        Self { heights: std::array::from_fn(|i| box_height(&directions.normals()[i], bounds)) }
    }

    /// The smallest k-DOP of the same directions around both.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self { heights: std::array::from_fn(|i| self.heights[i].max(other.heights[i])) }
    }

    /// Whether no pair of faces, of either, has all of one k-DOP before it and all of the other one behind it: never
    /// false for two k-DOPs (of the same directions) with a point in common, but it may be true for two that have
    /// none.
    #[must_use]
    pub fn may_meet(&self, other: &Self) -> bool {
        (0..K).all(|i| -other.heights[i ^ 1] <= self.heights[i])
    }

    /// The same for a box, whose own faces are asked by whoever has a box of the k-DOP.
    #[must_use]
    pub fn may_meet_box(&self, directions: &Directions<K>, bounds: &Aabb<f64>) -> bool {
        !bounds.is_empty() && self.may_meet(&Self::of_box(directions, bounds))
    }

    /// Whether other lies in this k-DOP of the same directions.
    #[must_use]
    pub fn contains(&self, other: &Self) -> bool {
        (0..K).all(|i| other.heights[i] <= self.heights[i])
    }

    /// Whether a point lies in it, apart from roundings inwards.
    #[must_use]
    pub fn contains_point(&self, directions: &Directions<K>, point: &Point3<f64>) -> bool {
        directions
            .normals()
            .iter()
            .zip(&self.heights)
            .all(|(normal, height)| -above(&-normal, &point.coords) <= *height)
    }

    /// Whether some slab has its faces in the wrong order, so that there is no point in it.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        !(0..K).step_by(2).all(|i| -self.heights[i + 1] <= self.heights[i])
    }
}

/// Whether a factor leaves a number as it is, but for its sign.
#[allow(clippy::float_cmp, reason = "exactly 1 is meant")]
pub(crate) fn is_one(x: f64) -> bool {
    x.abs() == 1.0
}

/// normal . x rounded up, exactly where the normal is one of the axes.
fn above(normal: &Vector3<f64>, x: &Vector3<f64>) -> f64 {
    // Terms without a factor are left out: infinite coordinates are allowed there.
    let mut sum = 0.0;
    let mut size = 0.0;
    let mut rounded = false;
    for (n, x) in normal.iter().zip(x) {
        if *n != 0.0 {
            sum += n * x;
            size += (n * x).abs();
            rounded |= !is_one(*n);
        }
    }
    // Three products and their sum err by 3 u of their size and what underflows. Nothing is known of sums that
    // overflow.
    match rounded {
        false => sum,
        true if size.is_finite() => sum + size * (4.0 * f64::EPSILON) + f64::MIN_POSITIVE,
        true => f64::INFINITY,
    }
}

/// The height of a box, rounded up.
fn box_height(normal: &Vector3<f64>, bounds: &Aabb<f64>) -> f64 {
    above(normal, &Vector3::from_fn(|k, _| if normal[k] > 0.0 { bounds.max[k] } else { bounds.min[k] }))
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
                // Products with a normal cancel.
                let n = directions.normals()[rng.random_range(6..26)];
                x = n.cross(&x);
            }
            x *= scale;
            let kdop = Kdop::of_points(&directions, &[Point3::from(x)]);
            for (n, h) in directions.normals().iter().zip(&kdop.heights) {
                assert!(is_product_at_most((*n).into(), x.into(), *h), "{n} {x} {h:e}");
                assert!(h - n.dot(&x) <= x.norm() * 2f64.powi(-48) + 2.0 * f64::MIN_POSITIVE, "{n} {x} {h:e}");
            }
        }
    }

    #[test]
    fn what_touches_meets_and_what_lies_apart_in_either_order_does_not() {
        let directions = Directions::<14>::default();
        let normals = directions.normals();
        for (i, normal) in normals.iter().enumerate() {
            let below = Kdop::of_points(&directions, &[Point3::from(*normal), Point3::from(normal * 2.0)]);
            let above = Kdop::of_points(&directions, &[Point3::from(normal * 3.0)]);
            assert!(!below.may_meet(&above) && !above.may_meet(&below), "apart along {normal}");
            // Only along this one.
            let mut beside = below;
            beside.heights = beside.heights.map(|h| h + 10.0);
            beside.heights[i ^ 1] = -below.heights[i];
            assert!(beside.may_meet(&below) && below.may_meet(&beside), "touching along {normal}");
            beside.heights[i ^ 1] = (-below.heights[i]).next_down();
            assert!(!beside.may_meet(&below) && !below.may_meet(&beside), "apart along {normal}");
        }
    }

    #[test]
    fn heights_that_overflow_are_infinite() {
        let directions = Directions::<26>::default();
        let m = f64::MAX;
        for corner in [[-m, -m, -m], [m, m, m], [0.7 * m, -0.7 * m, 0.7 * m], [-0.7 * m, -0.7 * m, 0.0], [m, -m, 0.0]] {
            let point = Point3::from(corner);
            let kdop = Kdop::of_points(&directions, &[point]);
            assert!(kdop.heights.iter().all(|h| *h > f64::NEG_INFINITY), "{kdop:?}");
            assert!(!kdop.is_empty() && kdop.contains_point(&directions, &point), "{kdop:?}");
            assert!(kdop.may_meet(&kdop) && kdop.may_meet_box(&directions, &Aabb { min: point, max: point }));
            let all = Aabb { min: Point3::new(-m, -m, -m), max: Point3::new(m, m, m) };
            assert!(kdop.may_meet_box(&directions, &all) && Kdop::of_box(&directions, &all).contains(&kdop));
        }
    }

    #[test]
    fn a_box_is_the_six_dop_of_its_corners() {
        let corners = [Point3::new(0.1, -2.0, 3.0), Point3::new(1.5, 7.0, 3.25)];
        let six = Kdop::of_points(&Directions::<6>::default(), &corners);
        assert_eq!(six.heights, [1.5, -0.1, 7.0, 2.0, 3.25, -3.0]);
        assert_eq!(six, Kdop::of_box(&Directions::default(), &Aabb::of_points(&corners)));
        let half = Aabb { max: Point3::new(0.0, f64::INFINITY, 0.0), ..Aabb::of_points(&corners) };
        assert!(Kdop::of_box(&Directions::<6>::default(), &half).is_empty());
    }

    #[test]
    fn kdops_contain_their_points_and_corners_are_cut() {
        let directions = Directions::<26>::default();
        let points = [Point3::new(1.0, 0.0, 0.0), Point3::new(0.0, 1.0, 0.0), Point3::new(0.0, 0.0, 1.0)];
        let kdop = Kdop::of_points(&directions, &points);
        assert!(points.iter().all(|p| kdop.contains_point(&directions, p)) && !kdop.is_empty());
        assert!(!kdop.contains_point(&directions, &Point3::new(0.9, 0.9, 0.9)));
        assert!(!kdop.may_meet(&Kdop::of_points(&directions, &[Point3::new(0.9, 0.9, 0.9)])));
        assert!(kdop.may_meet(&Kdop::of_points(&directions, &[Point3::new(0.25, 0.5, 0.25)])));
        assert!(!kdop.may_meet(&Kdop::empty()) && Kdop::<26>::empty().is_empty());
        let corner = |x: f64| Aabb { min: Point3::new(x, x, x), max: Point3::new(9.0, f64::INFINITY, 9.0) };
        assert!(kdop.may_meet_box(&directions, &corner(0.3)) && !kdop.may_meet_box(&directions, &corner(0.4)));
        assert!(kdop.contains(&Kdop::of_points(&directions, &points[..2])));
        assert!(kdop.union(&Kdop::empty()) == kdop);
    }
}
