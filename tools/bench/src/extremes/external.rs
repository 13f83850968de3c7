//! Answers of external libraries about one primitive.

use crate::bvh_crate::on_triangle;
use nalgebra::Point3;
use p2m_testkit::truth::Truth;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// A distance function of an external library.
pub(super) struct Library {
    /// The name in tables.
    pub(super) name: &'static str,
    /// Whether the library computes in f32.
    pub(super) single: bool,
    /// Returns the distance from a query to a segment or a triangle.
    distance: fn([f64; 3], &[[f64; 3]]) -> f64,
}

/// All external libraries.
pub(super) const LIBRARIES: [Library; 3] = [
    Library { name: "parry3d-f64", single: false, distance: parry_double },
    Library { name: "parry3d", single: true, distance: parry_single },
    Library { name: "Ericson", single: false, distance: ericson },
];

/// The result of a call.
pub(super) enum CallResult {
    /// The error in u M; infinite if the answer is not a finite number.
    Error(f64),
    /// The call panicked.
    Panic,
}

impl Library {
    /// Checks the answer to a case in the scalar of the library; `None` if it has no such primitive.
    pub(super) fn check(&self, query: [f64; 3], vertices: &[[f64; 3]]) -> Option<CallResult> {
        if vertices.len() < 2 || self.name == "Ericson" && vertices.len() < 3 {
            return None;
        }
        let Ok(distance) = catch_unwind(AssertUnwindSafe(|| (self.distance)(query, vertices))) else {
            return Some(CallResult::Panic);
        };
        let truth = Truth::new(query, vertices);
        let (bits, eta) = if self.single { (24, f64::from(f32::from_bits(1))) } else { (53, f64::from_bits(1)) };
        let limit = if self.single { f64::from(f32::MAX) } else { f64::MAX };
        let beyond = distance == f64::INFINITY && truth.is_at_least(limit);
        Some(CallResult::Error(if beyond { 0.0 } else { truth.error(distance, bits, eta) }))
    }
}

/// Generates the adapter for one of the two crates of parry, which have the same names for different types.
macro_rules! parry {
    ($name:ident, $parry:ident, $scalar:ty) => {
        #[allow(clippy::cast_possible_truncation, reason = "to the scalar of the crate; f32 is rounded to before")]
        fn $name(query: [f64; 3], vertices: &[[f64; 3]]) -> f64 {
            use $parry::math::Vector;
            use $parry::query::PointQuery;
            use $parry::shape::{Segment, Triangle};
            let vector = |v: [f64; 3]| Vector::new(v[0] as $scalar, v[1] as $scalar, v[2] as $scalar);
            let q = vector(query);
            let point = match *vertices {
                [a, b] => Segment::new(vector(a), vector(b)).project_local_point(q, false).point,
                [a, b, c] => Triangle::new(vector(a), vector(b), vector(c)).project_local_point(q, false).point,
                _ => unreachable!("segments and triangles"),
            };
            (point - q).length().into()
        }
    };
}
parry!(parry_double, parry3d_f64, f64);
parry!(parry_single, parry3d, f32);

/// Returns the distance to the closest point on a triangle of Real-Time Collision Detection, 5.1.5, which many
/// libraries use and which the crate bvh gets here.
fn ericson(query: [f64; 3], vertices: &[[f64; 3]]) -> f64 {
    let &[a, b, c] = vertices else { unreachable!("triangles") };
    let query = Point3::from(query);
    (on_triangle(&query, &[a.into(), b.into(), c.into()]) - query).norm()
}
