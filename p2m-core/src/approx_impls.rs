//! The comparison traits of the crate `approx`, implemented coordinate by coordinate.

use crate::{Aabb, Closest, Point, Real, Segment, Triangle};
use approx::{AbsDiffEq, RelativeEq, UlpsEq};

/// Implements the three traits for a type, given its fields with coordinates and a condition on the other fields.
macro_rules! approx_traits {
    ($type:ident, |$a:ident, $b:ident| $same:expr, $($field:ident),+) => {
        impl<T: Real + AbsDiffEq<Epsilon = T>> AbsDiffEq for $type<T> {
            type Epsilon = T;
            fn default_epsilon() -> T {
                T::default_epsilon()
            }
            fn abs_diff_eq(&self, other: &Self, epsilon: T) -> bool {
                let ($a, $b) = (self, other);
                $same $(&& self.$field.abs_diff_eq(&other.$field, epsilon))+
            }
        }
        impl<T: Real + RelativeEq<Epsilon = T>> RelativeEq for $type<T> {
            fn default_max_relative() -> T {
                T::default_max_relative()
            }
            fn relative_eq(&self, other: &Self, epsilon: T, max_relative: T) -> bool {
                let ($a, $b) = (self, other);
                $same $(&& self.$field.relative_eq(&other.$field, epsilon, max_relative))+
            }
        }
        impl<T: Real + UlpsEq<Epsilon = T>> UlpsEq for $type<T> {
            fn default_max_ulps() -> u32 {
                T::default_max_ulps()
            }
            fn ulps_eq(&self, other: &Self, epsilon: T, max_ulps: u32) -> bool {
                let ($a, $b) = (self, other);
                $same $(&& self.$field.ulps_eq(&other.$field, epsilon, max_ulps))+
            }
        }
    };
}

approx_traits!(Aabb, |_a, _b| true, min, max);
approx_traits!(Point, |_a, _b| true, position);
approx_traits!(Segment, |_a, _b| true, vertices);
approx_traits!(Triangle, |_a, _b| true, vertices);
approx_traits!(
    Closest,
    |a, b| a.primitive == b.primitive && a.feature == b.feature,
    point,
    distance,
    lower_bound,
    barycentric
);

#[cfg(test)]
mod tests {
    use crate::{BruteForce, ClosestPoint, Triangle};
    use approx::{assert_abs_diff_eq, assert_relative_eq, assert_ulps_eq};
    use nalgebra::Point3;

    #[test]
    fn answers_compare_by_value_and_by_identity() {
        let t = Triangle::new(Point3::new(0.0, 0.0, 0.0), Point3::new(1.0, 0.0, 0.0), Point3::new(0.0, 1.0, 0.0));
        let index = BruteForce::new([t, t]).unwrap();
        let a = index.closest_point(&Point3::new(0.2, 0.2, 1.0)).unwrap();
        let b = index.closest_point(&Point3::new(0.2, 0.2, 1.0 + 1e-12)).unwrap();
        assert_abs_diff_eq!(a, b, epsilon = 1e-11);
        assert_relative_eq!(a, b, max_relative = 1e-11);
        assert_ulps_eq!(a, a);
        approx::assert_abs_diff_ne!(a, b, epsilon = 1e-13);
        let other = index.closest_point(&Point3::new(2.0, 0.0, 1.0)).unwrap();
        approx::assert_abs_diff_ne!(a, other, epsilon = 1e3);
    }
}
