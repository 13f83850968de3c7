//! A check for primitive types of your own.

use super::interface::Primitive;
use super::projection::Projection;
use crate::Real;
use crate::kernel::Key;
use crate::real::to_f64_array;
use nalgebra::Point3;

/// A violated requirement of the trait [`Primitive`].
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PrimitiveDefect {
    /// The box has a coordinate that is not finite, or is empty.
    #[error("the box of the primitive is empty or not finite")]
    Box,
    /// Two calls of `project` with the same query return different results.
    #[error("project returns different results for the query {query:?}")]
    NotPure {
        /// The query of the failed check.
        query: [f64; 3],
    },
    /// A coordinate of the nearest point or a weight is NaN.
    #[error("the nearest point or a weight is NaN for the query {query:?}")]
    Nan {
        /// The query of the failed check.
        query: [f64; 3],
    },
    /// The nearest point lies outside of the box of the primitive.
    #[error("the nearest point {point:?} to the query {query:?} lies outside of the box of the primitive")]
    OutsideBox {
        /// The query of the failed check.
        query: [f64; 3],
        /// The nearest point that `project` returns.
        point: [f64; 3],
    },
    /// The key differs by more than rounding from the key that [`Projection::new`] computes from the query and the
    /// point.
    #[error("the key for the query {query:?} is not the distance of the point, which Projection::new computes")]
    Key {
        /// The query of the failed check.
        query: [f64; 3],
    },
    /// The error bound is negative, NaN or infinite.
    #[error("the bound on the error for the query {query:?} is {error}, which is no finite number from 0 on")]
    ErrorBound {
        /// The query of the failed check.
        query: [f64; 3],
        /// The error bound.
        error: f64,
    },
    /// The distances of two queries differ by more than the distance between the queries and both error bounds allow.
    /// So one of the points is not the nearest one, or one of the bounds is too small.
    #[error("the distances from {query:?} and {other:?} differ by more than the queries are apart and errors allow")]
    NotNearest {
        /// The first query.
        query: [f64; 3],
        /// The second query.
        other: [f64; 3],
    },
    /// `project_within` and `project` return different results, or `project_within` returns none although the key does
    /// not exceed the square.
    #[error("project_within disagrees with project for the query {query:?}")]
    Within {
        /// The query of the failed check.
        query: [f64; 3],
    },
}

/// Checks that a primitive of your own meets the requirements of [`Primitive`] at some finite queries. Call it in a
/// test.
///
/// Queries should lie inside of the primitive, on it, beside it and far away. The check adds six queries beyond the
/// faces of the box. It proves nothing about other queries.
///
/// ```
/// use nalgebra::Point3;
/// use p2m_core::{Aabb, Feature, Primitive, PrimitiveDefect, Projection, Ray, RayHit, check_primitive};
///
/// /// A point that claims to be the centre of the box around the origin.
/// struct Wrong;
/// impl Primitive<f64> for Wrong {
///     fn aabb(&self) -> Aabb<f64> {
///         Aabb { min: Point3::new(-1.0, -1.0, -1.0), max: Point3::new(1.0, 1.0, 1.0) }
///     }
///     fn project(&self, query: &Point3<f64>) -> Projection {
///         Projection::new(query, Point3::new(2.0, 0.0, 0.0), Feature::Face, [1.0, 0.0, 0.0], 0.0)
///     }
///     fn intersect_ray(&self, _: &Ray) -> Option<RayHit> {
///         None
///     }
/// }
/// let defect = check_primitive(&Wrong, &[Point3::origin()]).unwrap_err();
/// assert!(matches!(defect, PrimitiveDefect::OutsideBox { .. }));
/// ```
///
/// # Errors
/// It returns the first [`PrimitiveDefect`] that it finds.
///
/// # Complexity
/// It compares all pairs of queries, so pass a hundred or so.
pub fn check_primitive<T: Real>(primitive: &impl Primitive<T>, queries: &[Point3<T>]) -> Result<(), PrimitiveDefect> {
    let bounds = primitive.aabb();
    if bounds.is_empty() || !bounds.is_finite() {
        return Err(PrimitiveDefect::Box);
    }
    let bounds = bounds.to_f64();
    let mut all: Vec<([f64; 3], Projection)> = Vec::with_capacity(queries.len() + 6);
    let centre = nalgebra::center(&bounds.min, &bounds.max);
    let size = (bounds.max - bounds.min).norm();
    let beyond = (0..6).map(|face| {
        let mut query = centre;
        query[face / 2] += if face % 2 == 0 { size } else { -size };
        query.map(T::round_from_f64)
    });
    for point in &queries.iter().copied().chain(beyond.filter(|p| p.iter().all(|x| x.is_finite()))).collect::<Vec<_>>()
    {
        let query = to_f64_array(point);
        let found = primitive.project(point);
        if found.point.iter().chain(&found.barycentric).any(|x| x.is_nan()) {
            return Err(PrimitiveDefect::Nan { query });
        }
        if primitive.project(point) != found {
            return Err(PrimitiveDefect::NotPure { query });
        }
        if !(0..3).all(|k| (bounds.min[k]..=bounds.max[k]).contains(&found.point[k])) {
            return Err(PrimitiveDefect::OutsideBox { query, point: found.point.coords.into() });
        }
        if !(0.0..f64::INFINITY).contains(&found.error) {
            return Err(PrimitiveDefect::ErrorBound { query, error: found.error });
        }
        // The kernel of p2m computes more precise keys than `Projection::new`.
        let expected =
            Projection::new(point, found.point, found.feature, found.barycentric, found.error).key.distance();
        let largest = query.iter().chain(found.point.iter()).fold(0.0f64, |largest, x| largest.max(x.abs()));
        let rounding = 16.0 * f64::EPSILON * largest + found.error + f64::MIN_POSITIVE;
        if (expected - found.key.distance()).abs() > rounding {
            return Err(PrimitiveDefect::Key { query });
        }
        let is_same = |within: Option<Projection>| within == Some(found);
        let square = found.key.distance() * found.key.distance() * (1.0 + 8.0 * f64::EPSILON) + f64::MIN_POSITIVE;
        if !is_same(primitive.project_within(point, f64::INFINITY)) || !is_same(primitive.project_within(point, square))
        {
            return Err(PrimitiveDefect::Within { query });
        }
        for (other, earlier) in &all {
            let apart = Key::from_offset([0, 1, 2].map(|k: usize| query[k] - other[k])).distance();
            let difference = (found.key.distance() - earlier.key.distance()).abs();
            let rounding = 8.0 * f64::EPSILON * (apart + found.key.distance() + earlier.key.distance());
            if difference > apart + found.error + earlier.error + rounding {
                return Err(PrimitiveDefect::NotNearest { query, other: *other });
            }
        }
        all.push((query, found));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Aabb, Feature, Ray, RayHit, Triangle};
    use rand::RngExt;
    use std::cell::Cell;

    /// A ball of radius 1 with one of several defects.
    struct Ball(Mistake, Cell<u32>);

    #[derive(PartialEq)]
    enum Mistake {
        None,
        Changes,
        NanPoint,
        WrongKey,
        NegativeError,
        FarPoint,
        NeverWithin,
    }

    impl Primitive<f64> for Ball {
        fn aabb(&self) -> Aabb<f64> {
            Aabb { min: Point3::new(-1.0, -1.0, -1.0), max: Point3::new(1.0, 1.0, 1.0) }
        }

        fn project(&self, query: &Point3<f64>) -> Projection {
            self.1.set(self.1.get() + 1);
            let length = query.coords.norm();
            let mut point = if length > 1.0 { query / length } else { *query };
            match self.0 {
                Mistake::Changes if self.1.get() % 2 == 1 => point *= 0.5,
                Mistake::NanPoint => point.x = f64::NAN,
                Mistake::FarPoint if query.x > 0.0 => point = -point,
                _ => {}
            }
            let error = if self.0 == Mistake::NegativeError { -1.0 } else { 1e-14 };
            let point = if point.x.is_nan() { point } else { self.aabb().clamp(point) };
            let mut found = Projection::new(query, point, Feature::Face, [1.0, 0.0, 0.0], error);
            if self.0 == Mistake::WrongKey {
                found.key = crate::Key::from_offset([9.0; 3]);
            }
            found
        }

        fn project_within(&self, query: &Point3<f64>, square: f64) -> Option<Projection> {
            (self.0 != Mistake::NeverWithin || square == f64::INFINITY).then(|| self.project(query))
        }

        fn intersect_ray(&self, _: &Ray) -> Option<RayHit> {
            None
        }
    }

    /// A primitive that delegates its projection to another one.
    struct Delegate(Triangle<f64>);

    impl Primitive<f64> for Delegate {
        fn aabb(&self) -> Aabb<f64> {
            self.0.aabb()
        }
        fn project(&self, query: &Point3<f64>) -> Projection {
            self.0.project(query)
        }
        fn intersect_ray(&self, _: &Ray) -> Option<RayHit> {
            None
        }
    }

    #[test]
    fn mistakes_of_primitives_are_found() {
        let queries: Vec<Point3<f64>> = (0..64)
            .map(|i| Point3::new(f64::from(i % 4) - 1.5, f64::from(i / 4 % 4) - 1.5, f64::from(i / 16)))
            .collect();
        let defect = |mistake| check_primitive(&Ball(mistake, Cell::new(0)), &queries);
        assert_eq!(defect(Mistake::None), Ok(()));
        assert!(matches!(defect(Mistake::Changes), Err(PrimitiveDefect::NotPure { .. })));
        assert!(matches!(defect(Mistake::NanPoint), Err(PrimitiveDefect::Nan { .. })));
        assert!(matches!(defect(Mistake::WrongKey), Err(PrimitiveDefect::Key { .. })));
        assert!(matches!(defect(Mistake::NegativeError), Err(PrimitiveDefect::ErrorBound { .. })));
        assert!(matches!(defect(Mistake::FarPoint), Err(PrimitiveDefect::NotNearest { .. })));
        assert!(matches!(defect(Mistake::NeverWithin), Err(PrimitiveDefect::Within { .. })));
        let mut rng = p2m_testkit::rng("primitives are checked", 0);
        for case in 0..300 {
            let scale = 2f64.powi([0, -560, 40, 500][case % 4]);
            let mut point = || Point3::from([(); 3].map(|()| scale * rng.random_range(-1.0..1.0)));
            let queries: Vec<Point3<f64>> = (0..20).map(|_| point()).collect();
            let triangle = Triangle::new(point(), point(), point());
            assert_eq!(check_primitive(&triangle, &queries), Ok(()), "{triangle:?}");
            assert_eq!(check_primitive(&Delegate(triangle), &queries), Ok(()), "{triangle:?}");
        }
        let [a, b, c] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.5]].map(Point3::from);
        assert_eq!(check_primitive(&Triangle::new(a, b, c * f64::NAN), &queries), Err(PrimitiveDefect::Box));
    }
}
