//! A check of primitives of your own.

use super::interface::Primitive;
use super::projection::Projection;
use crate::Real;
use crate::real::to_f64_array;
use nalgebra::Point3;

/// A way in which a primitive does not keep what [`Primitive`] requires.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PrimitiveDefect {
    /// The box contains a coordinate that is not finite, or is empty.
    #[error("the box of the primitive is empty or not finite")]
    Box,
    /// Two calls of `project` with one query return different results.
    #[error("project returns different results for the query {query:?}")]
    NotPure {
        /// The query.
        query: [f64; 3],
    },
    /// The nearest point lies outside of the box of the primitive, or is NaN.
    #[error("the nearest point {point:?} to the query {query:?} lies outside of the box of the primitive")]
    OutsideBox {
        /// The query.
        query: [f64; 3],
        /// The nearest point that `project` returns.
        point: [f64; 3],
    },
    /// The key is not the one that [`Projection::new`] makes of the query and the point.
    #[error("the key for the query {query:?} is not that of Projection::new")]
    Key {
        /// The query.
        query: [f64; 3],
    },
    /// The bound on the error is negative, NaN or infinite.
    #[error("the bound on the error for the query {query:?} is {error}, which is no finite number from 0 on")]
    ErrorBound {
        /// The query.
        query: [f64; 3],
        /// The bound on the error.
        error: f64,
    },
    /// The distances of two queries differ by more than the distance between the queries and both bounds on the errors
    /// allow, so one of the points is not the nearest one or one of the bounds is too small.
    #[error("the distances from {query:?} and {other:?} differ by more than the queries are apart and errors allow")]
    NotNearest {
        /// One query.
        query: [f64; 3],
        /// The other query.
        other: [f64; 3],
    },
    /// `project_within` returns another result than `project`, or none although the key does not exceed the square.
    #[error("project_within disagrees with project for the query {query:?}")]
    Within {
        /// The query.
        query: [f64; 3],
    },
}

/// Checks whether a primitive of your own keeps what [`Primitive`] requires, at some finite queries. Call it in a test.
///
/// Queries should lie inside of the primitive, on it, beside it and far away. The check finds most mistakes, but it
/// proves nothing about other queries.
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
/// It compares all pairs of queries, so some hundred queries are enough.
pub fn check_primitive<T: Real>(primitive: &impl Primitive<T>, queries: &[Point3<T>]) -> Result<(), PrimitiveDefect> {
    let bounds = primitive.aabb();
    if bounds.is_empty() || !bounds.is_finite() {
        return Err(PrimitiveDefect::Box);
    }
    let bounds = bounds.to_f64();
    let mut all: Vec<([f64; 3], Projection)> = Vec::with_capacity(queries.len());
    for point in queries {
        let query = to_f64_array(point);
        let found = primitive.project(point);
        if primitive.project(point) != found {
            return Err(PrimitiveDefect::NotPure { query });
        }
        if !(0..3).all(|k| (bounds.min[k]..=bounds.max[k]).contains(&found.point[k])) {
            return Err(PrimitiveDefect::OutsideBox { query, point: found.point.coords.into() });
        }
        // The kernel makes the keys of primitives with vertices, and those may be more precise.
        let expected = Projection::new(point, found.point, found.feature, found.barycentric, found.error).key;
        if primitive.vertices().is_empty() && expected != found.key {
            return Err(PrimitiveDefect::Key { query });
        }
        if !(0.0..f64::INFINITY).contains(&found.error) {
            return Err(PrimitiveDefect::ErrorBound { query, error: found.error });
        }
        let is_same = |within: Option<Projection>| within == Some(found);
        let square = found.key.distance() * found.key.distance() * (1.0 + 8.0 * f64::EPSILON) + f64::MIN_POSITIVE;
        if !is_same(primitive.project_within(point, f64::INFINITY)) || !is_same(primitive.project_within(point, square))
        {
            return Err(PrimitiveDefect::Within { query });
        }
        for (other, earlier) in &all {
            let apart = (0..3).map(|k| (query[k] - other[k]).powi(2)).sum::<f64>().sqrt();
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
    use std::cell::Cell;

    /// A ball of radius 1 with one of several mistakes.
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

    #[test]
    fn mistakes_of_primitives_are_found() {
        let queries: Vec<Point3<f64>> = (0..64)
            .map(|i| Point3::new(f64::from(i % 4) - 1.5, f64::from(i / 4 % 4) - 1.5, f64::from(i / 16)))
            .collect();
        let defect = |mistake| check_primitive(&Ball(mistake, Cell::new(0)), &queries);
        assert_eq!(defect(Mistake::None), Ok(()));
        assert!(matches!(defect(Mistake::Changes), Err(PrimitiveDefect::NotPure { .. })));
        assert!(matches!(defect(Mistake::NanPoint), Err(PrimitiveDefect::NotPure { .. })), "NaN differs from itself");
        assert!(matches!(defect(Mistake::WrongKey), Err(PrimitiveDefect::Key { .. })));
        assert!(matches!(defect(Mistake::NegativeError), Err(PrimitiveDefect::ErrorBound { .. })));
        assert!(matches!(defect(Mistake::FarPoint), Err(PrimitiveDefect::NotNearest { .. })));
        assert!(matches!(defect(Mistake::NeverWithin), Err(PrimitiveDefect::Within { .. })));
        let [a, b, c] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.5]].map(Point3::from);
        assert_eq!(check_primitive(&Triangle::new(a, b, c), &queries), Ok(()));
        assert_eq!(check_primitive(&Triangle::new(a, b, c * f64::NAN), &queries), Err(PrimitiveDefect::Box));
    }
}
