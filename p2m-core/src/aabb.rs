//! An axis-aligned bounding box.

use crate::Real;
use crate::real::to_f64_array;
use nalgebra::Point3;

/// An axis-aligned box. It is empty if a coordinate of `min` exceeds the same coordinate of `max`.
///
/// ```
/// use nalgebra::Point3;
/// use p2m_core::Aabb;
///
/// let cube = Aabb { min: Point3::new(0.0, 0.0, 0.0), max: Point3::new(1.0, 1.0, 1.0) };
/// assert_eq!(cube.clamp(Point3::new(0.5, 2.0, -1.0)), Point3::new(0.5, 1.0, 0.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb<T: Real> {
    /// The corner with the smallest coordinates.
    pub min: Point3<T>,
    /// The corner with the largest coordinates.
    pub max: Point3<T>,
}

impl<T: Real> Aabb<T> {
    /// Returns the empty box, which is the neutral element of [`union`](Self::union).
    #[must_use]
    pub fn empty() -> Self {
        Self {
            min: Point3::new(T::INFINITY, T::INFINITY, T::INFINITY),
            max: Point3::new(-T::INFINITY, -T::INFINITY, -T::INFINITY),
        }
    }

    /// Returns the smallest box around `points`. A NaN coordinate makes the box NaN on that axis.
    #[inline(always)]
    #[must_use]
    pub fn from_points(points: &[Point3<T>]) -> Self {
        let Some((first, rest)) = points.split_first() else { return Self::empty() };
        rest.iter().fold(Self { min: *first, max: *first }, |b, p| b.union(&Self { min: *p, max: *p }))
    }

    /// Returns the smallest box around two boxes. A NaN coordinate of either makes the result NaN on that axis.
    #[inline(always)]
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        // Comparisons with NaN are false, so both expressions return the operand that is NaN.
        let low = |a: T, b: T| if a <= b || a.partial_cmp(&a).is_none() { a } else { b };
        let high = |a: T, b: T| if a >= b || a.partial_cmp(&a).is_none() { a } else { b };
        Self {
            min: Point3::from(std::array::from_fn(|k| low(self.min[k], other.min[k]))),
            max: Point3::from(std::array::from_fn(|k| high(self.max[k], other.max[k]))),
        }
    }

    /// Returns the box in f64, exactly.
    #[inline]
    #[must_use]
    pub fn to_f64(&self) -> Aabb<f64> {
        Aabb { min: Point3::from(to_f64_array(&self.min)), max: Point3::from(to_f64_array(&self.max)) }
    }

    /// Returns whether all coordinates are finite. The [`empty`](Self::empty) box has infinite ones.
    #[inline]
    #[must_use]
    pub fn is_finite(&self) -> bool {
        // No early exit, so that the comparisons are vectorised.
        self.min.iter().chain(self.max.iter()).fold(true, |all, x| all & x.is_finite())
    }

    /// Returns whether `other` lies in this box.
    #[must_use]
    pub fn contains(&self, other: &Self) -> bool {
        (0..3).all(|k| self.min[k] <= other.min[k] && other.max[k] <= self.max[k])
    }

    /// Returns the intersection of two boxes, which may be empty. A NaN coordinate of either makes it empty or NaN
    /// on that axis.
    #[must_use]
    pub fn intersection(&self, other: &Self) -> Self {
        let low = |a: T, b: T| if a >= b { a } else { b };
        let high = |a: T, b: T| if a <= b { a } else { b };
        Self {
            min: Point3::from(std::array::from_fn(|k| low(self.min[k], other.min[k]))),
            max: Point3::from(std::array::from_fn(|k| high(self.max[k], other.max[k]))),
        }
    }

    /// Returns whether the box contains no point. A box with a NaN coordinate contains none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        !(0..3).all(|k| self.min[k] <= self.max[k])
    }

    /// Returns whether two closed boxes have a point in common.
    #[must_use]
    pub fn intersects(&self, other: &Self) -> bool {
        (0..3).all(|k| self.min[k] <= other.max[k] && other.min[k] <= self.max[k])
    }

    /// Returns the point of the box that is nearest to `point`.
    #[must_use]
    pub fn clamp(&self, point: Point3<T>) -> Point3<T> {
        Point3::from(std::array::from_fn(|k| {
            if point[k] < self.min[k] {
                self.min[k]
            } else if point[k] > self.max[k] {
                self.max[k]
            } else {
                point[k]
            }
        }))
    }

    /// Returns a lower bound on the squared distance from `query` to all points of the box, in f64.
    ///
    /// # Accuracy
    /// The bound never exceeds the key of a primitive in the box, rounding included. The kernel and this function
    /// subtract coordinates and sum squares in the same order, the kernel keeps each component of its offset within the
    /// box of the vertices minus the query, and rounding is monotone. So pruning needs no slack: a search skips a box
    /// if and only if its bound is strictly above [`Collector::prune_above`](crate::Collector::prune_above). The bound
    /// exceeds the true squared distance by a relative error of at most 5 u.
    #[inline(always)]
    #[must_use]
    pub fn lower_bound(&self, query: &Point3<T>) -> f64 {
        let (q, min, max) = (to_f64_array(query), to_f64_array(&self.min), to_f64_array(&self.max));
        let gap = |k: usize| {
            let below = min[k] - q[k];
            let above = q[k] - max[k];
            let outside = if below > above { below } else { above };
            if outside > 0.0 { outside } else { 0.0 }
        };
        let (x, y, z) = (gap(0), gap(1), gap(2));
        x * x + y * y + z * z
    }

    /// Returns a lower bound on the squared distance between points of two boxes, in f64.
    ///
    /// # Accuracy
    /// The bound never exceeds the key of a pair of primitives in the boxes ([`pair`](crate::pair)), rounding included.
    /// [`lower_bound`](Self::lower_bound) states the reason.
    #[must_use]
    pub fn gap_squared(&self, other: &Self) -> f64 {
        let [[min, max], [other_min, other_max]] =
            [self, other].map(|bounds| [&bounds.min, &bounds.max].map(to_f64_array));
        let gap = |k: usize| (other_min[k] - max[k]).max(min[k] - other_max[k]).max(0.0);
        let (x, y, z) = (gap(0), gap(1), gap(2));
        x * x + y * y + z * z
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_nan_coordinate_makes_the_box_not_finite_wherever_it_stands() {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for axis in 0..3 {
                for at in 0..3 {
                    let mut points = [Point3::new(1.0, 2.0, 3.0), Point3::new(-1.0, 0.0, 5.0), Point3::origin()];
                    points[at][axis] = bad;
                    assert!(!Aabb::from_points(&points).is_finite(), "{bad} on axis {axis} of point {at}");
                }
            }
        }
        assert!(!Aabb::<f32>::empty().is_finite());
    }

    #[test]
    fn the_bound_is_zero_inside_and_the_distance_outside() {
        let b = Aabb::from_points(&[Point3::new(0.0, 0.0, 0.0), Point3::new(1.0, 2.0, 3.0)]);
        assert_eq!(b.lower_bound(&Point3::new(0.5, 2.0, 0.0)), 0.0);
        assert_eq!(b.lower_bound(&Point3::new(-3.0, 6.0, 1.0)), 25.0);
        assert_eq!(b.clamp(Point3::new(-3.0, 6.0, 1.0)), Point3::new(0.0, 2.0, 1.0));
    }
}
