//! Distances from one primitive by external libraries.

use super::counts::Precision;
use crate::bvh_crate::on_triangle;
use crate::parry::{double, single};
use nalgebra::Point3;
use p2m_testkit::truth::Truth;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// A distance function of an external library.
pub(super) struct Library {
    /// The name in tables.
    pub(super) name: &'static str,
    /// The index of its scalar in [`Precision::ALL`].
    pub(super) scalar: usize,
    /// Returns the distance from a query to a segment or a triangle.
    distance: fn([f64; 3], &[[f64; 3]]) -> f64,
}

/// All external libraries.
pub(super) const LIBRARIES: [Library; 3] = [
    Library { name: "parry3d-f64", scalar: 0, distance: double::distance_to },
    Library { name: "parry3d", scalar: 1, distance: single::distance_to },
    Library { name: "Ericson", scalar: 0, distance: ericson },
];

impl Library {
    /// Returns whether the library has primitives with this number of vertices.
    pub(super) fn has(&self, vertices: usize) -> bool {
        vertices == 3 || vertices == 2 && self.name != "Ericson"
    }

    /// Returns the error of the answer to a case in the scalar of the library; `None` if the call panicked.
    pub(super) fn error(&self, query: [f64; 3], vertices: &[[f64; 3]]) -> Option<f64> {
        let distance = catch_unwind(AssertUnwindSafe(|| (self.distance)(query, vertices))).ok()?;
        Some(Precision::ALL[self.scalar].error(&Truth::new(query, vertices), distance))
    }
}

/// Returns the distance from the closest point of a triangle in Real-Time Collision Detection, 5.1.5, which many
/// libraries use, and the crate bvh does here.
fn ericson(query: [f64; 3], vertices: &[[f64; 3]]) -> f64 {
    let &[a, b, c] = vertices else { unreachable!("triangles") };
    let query = Point3::from(query);
    (on_triangle(&query, &[a.into(), b.into(), c.into()]) - query).norm()
}
