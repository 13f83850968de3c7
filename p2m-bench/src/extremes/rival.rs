//! What rivals answer about one primitive.

use super::tally::ROUNDING;
use crate::bvh_crate::on_triangle;
use nalgebra::Point3;
use p2m_testkit::truth::Truth;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// A function of a rival.
pub(super) struct Rival {
    /// For tables.
    pub(super) name: &'static str,
    /// What is called.
    pub(super) about: &'static str,
    /// Whether it computes in f32.
    pub(super) single: bool,
    /// The distance of a query to a segment or a triangle.
    distance: fn([f64; 3], &[[f64; 3]]) -> f64,
}

/// All.
pub(super) const RIVALS: [Rival; 3] = [
    Rival {
        name: "parry3d-f64",
        about: "parry3d-f64 0.31, `project_local_point` of `Triangle` and `Segment`",
        single: false,
        distance: parry_double,
    },
    Rival { name: "parry3d", about: "parry3d 0.31, the same in f32", single: true, distance: parry_single },
    Rival {
        name: "Ericson",
        about: "the closest point on a triangle of Real-Time Collision Detection, 5.1.5, in f64, as many libraries have it; it is what the \
                crate bvh 0.13 is given here",
        single: false,
        distance: ericson,
    },
];

/// What it said.
pub(super) enum Said {
    /// An error in u M; infinite for what is no number.
    Error(f64),
    /// It panicked.
    Panic,
}

/// What is wrong with an answer of a rival.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Kind {
    /// No answer.
    Panic,
    /// NaN, or infinity for what is in range.
    NotANumber,
    /// Beyond any rounding.
    Wrong,
    /// Another primitive than the nearest, beyond any rounding.
    WrongPrimitive,
}

impl Kind {
    /// Of an error in u M, which is infinite for what is no number, if it is so large that nobody can doubt it.
    pub(super) fn of_error(error: f64) -> Option<Self> {
        match error {
            e if !e.is_finite() => Some(Self::NotANumber),
            e if e > 1e3 * ROUNDING => Some(Self::Wrong),
            _ => None,
        }
    }
}

impl Said {
    /// What is wrong with it, if something is.
    pub(super) fn kind(&self) -> Option<Kind> {
        match self {
            Self::Panic => Some(Kind::Panic),
            Self::Error(error) => Kind::of_error(*error),
        }
    }
}

impl Rival {
    /// What it says of a case in its scalar; `None` if it has no such primitive.
    pub(super) fn ask(&self, query: [f64; 3], vertices: &[[f64; 3]]) -> Option<Said> {
        if vertices.len() < 2 || self.name == "Ericson" && vertices.len() < 3 {
            return None;
        }
        let Ok(distance) = catch_unwind(AssertUnwindSafe(|| (self.distance)(query, vertices))) else {
            return Some(Said::Panic);
        };
        let truth = Truth::new(query, vertices);
        let (bits, eta) = if self.single { (24, f64::from(f32::from_bits(1))) } else { (53, f64::from_bits(1)) };
        let limit = if self.single { f64::from(f32::MAX) } else { f64::MAX };
        let beyond = distance == f64::INFINITY && truth.is_at_least(limit);
        Some(Said::Error(if beyond { 0.0 } else { truth.error(distance, bits, eta) }))
    }

    /// The distance that it computes.
    pub(super) fn distance(&self, query: [f64; 3], vertices: &[[f64; 3]]) -> f64 {
        (self.distance)(query, vertices)
    }
}

/// The two crates of parry have the same names for different types.
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

fn ericson(query: [f64; 3], vertices: &[[f64; 3]]) -> f64 {
    let &[a, b, c] = vertices else { unreachable!("triangles") };
    let query = Point3::from(query);
    (on_triangle(&query, &[a.into(), b.into(), c.into()]) - query).norm()
}
