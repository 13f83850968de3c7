//! Axis-aligned boxes.

use crate::Real;
use crate::real::to_f64_array;
use nalgebra::Point3;

/// A box with sides along the axes. Empty if a lower corner exceeds the upper one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb<T: Real> {
    /// The corner with the smallest coordinates.
    pub min: Point3<T>,
    /// The corner with the largest coordinates.
    pub max: Point3<T>,
}

impl<T: Real> Aabb<T> {
    /// The box that holds nothing.
    #[must_use]
    pub fn empty() -> Self {
        Self {
            min: Point3::new(T::INFINITY, T::INFINITY, T::INFINITY),
            max: Point3::new(-T::INFINITY, -T::INFINITY, -T::INFINITY),
        }
    }

    /// The smallest box around `points`; a NaN coordinate makes the box NaN on that axis.
    #[inline(always)]
    #[must_use]
    pub fn of_points(points: &[Point3<T>]) -> Self {
        points.iter().fold(Self::empty(), |b, p| b.union(&Self { min: *p, max: *p }))
    }

    /// The smallest box around both; NaN wins.
    #[inline(always)]
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        // Written so that NaN on either side is kept: a comparison with NaN is false.
        let low = |a: T, b: T| if a <= b || a.partial_cmp(&a).is_none() { a } else { b };
        let high = |a: T, b: T| if a >= b || a.partial_cmp(&a).is_none() { a } else { b };
        Self {
            min: Point3::new(low(self.min.x, other.min.x), low(self.min.y, other.min.y), low(self.min.z, other.min.z)),
            max: Point3::new(
                high(self.max.x, other.max.x),
                high(self.max.y, other.max.y),
                high(self.max.z, other.max.z),
            ),
        }
    }

    /// The same box in f64, exactly.
    #[inline]
    #[must_use]
    pub fn to_f64(&self) -> Aabb<f64> {
        Aabb { min: Point3::from(to_f64_array(&self.min)), max: Point3::from(to_f64_array(&self.max)) }
    }

    /// Whether every corner coordinate is finite. The empty box is not.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.min.iter().chain(self.max.iter()).all(|x| x.is_finite())
    }

    /// Whether `other` lies in this box.
    #[must_use]
    pub fn contains(&self, other: &Self) -> bool {
        (0..3).all(|k| self.min[k] <= other.min[k] && other.max[k] <= self.max[k])
    }

    /// What both have in common; empty if that is nothing. NaN makes it empty or NaN on that axis.
    #[must_use]
    pub fn intersection(&self, other: &Self) -> Self {
        let low = |a: T, b: T| if a >= b { a } else { b };
        let high = |a: T, b: T| if a <= b { a } else { b };
        Self {
            min: Point3::from(std::array::from_fn(|k| low(self.min[k], other.min[k]))),
            max: Point3::from(std::array::from_fn(|k| high(self.max[k], other.max[k]))),
        }
    }

    /// Whether there is no point in it; a box with a NaN coordinate has none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        !(0..3).all(|k| self.min[k] <= self.max[k])
    }

    /// Whether both have a point in common, be it of their boundaries.
    #[must_use]
    pub fn meets(&self, other: &Self) -> bool {
        (0..3).all(|k| self.min[k] <= other.max[k] && other.min[k] <= self.max[k])
    }

    /// The nearest point of the box.
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

    /// Lower bound of the square of the distance from `query` to anything in the box, in f64.
    ///
    /// # Accuracy
    /// Never above the key of a primitive in the box, rounding included: both subtract coordinates and sum squares in
    /// the same order, the kernel keeps each component of its offset within the box of the vertices minus the query,
    /// and rounding is monotone. So pruning on it needs no slack: a box goes iff its bound exceeds
    /// [`Collector::prune_above`](crate::Collector::prune_above), strictly. Against the true distance the bound is at
    /// most 5 u (relative, on the square) too large.
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
                    assert!(!Aabb::of_points(&points).is_finite(), "{bad} on axis {axis} of point {at}");
                }
            }
        }
        assert!(!Aabb::<f32>::empty().is_finite());
    }

    #[test]
    fn the_bound_is_zero_inside_and_the_distance_outside() {
        let b = Aabb::of_points(&[Point3::new(0.0, 0.0, 0.0), Point3::new(1.0, 2.0, 3.0)]);
        assert_eq!(b.lower_bound(&Point3::new(0.5, 2.0, 0.0)), 0.0);
        assert_eq!(b.lower_bound(&Point3::new(-3.0, 6.0, 1.0)), 25.0);
        assert_eq!(b.clamp(Point3::new(-3.0, 6.0, 1.0)), Point3::new(0.0, 2.0, 1.0));
    }
}
