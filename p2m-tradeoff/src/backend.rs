//! The interface of measured backends. One dynamic call answers many queries, so that a query itself costs no dynamic
//! call but those of the backend.

use crate::queries::{QuerySlice, Scalar};
use crate::settings::{Accuracy, Setting};
use nalgebra::Point3;
use p2m_core::{CertifiedQuery, Closest, ClosestPoint, QueryOptions};
use std::time::Instant;

/// The part of an answer that is compared with the truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// The distance; NaN if there was no answer.
    pub distance: f64,
    /// The certified lower bound; NaN if there is none.
    pub lower_bound: f64,
    /// The id of the primitive; [`u32::MAX`] if it is not known.
    pub id: u32,
}

impl Answer {
    /// The value of a query without an answer.
    pub const NONE: Self = Self { distance: f64::NAN, lower_bound: f64::NAN, id: u32::MAX };

    /// Makes an answer of a distance without a lower bound and a primitive.
    #[must_use]
    pub const fn of_distance(distance: f64) -> Self {
        Self { distance, ..Self::NONE }
    }
}

impl From<Option<Closest<f64>>> for Answer {
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "ids are below 2^30")]
    fn from(closest: Option<Closest<f64>>) -> Self {
        closest.map_or(Self::NONE, |c| Self {
            distance: c.distance,
            lower_bound: c.lower_bound,
            id: c.primitive.index() as u32,
        })
    }
}

/// A backend that answers one query at a time. It is a [`AnswerQueries`] as well.
pub trait AnswerQuery: Sync {
    /// The scalar of the queries.
    type Scalar: Scalar;
    /// Answers one query.
    fn answer_query(&self, query: &Point3<Self::Scalar>) -> Answer;
}

/// A backend whose scalar is erased. The loop over queries is compiled for each backend.
pub trait AnswerQueries: Sync {
    /// Answers queries in their order.
    ///
    /// # Panics
    /// If the backend panics. Those of this project do not.
    fn answer(&self, queries: QuerySlice<'_>, answers: &mut [Answer]);

    /// Answers queries in their order, and measures the wall time of each single query in nanoseconds. The time to read
    /// the clock is included.
    ///
    /// # Panics
    /// If the backend panics.
    fn answer_timed(&self, queries: QuerySlice<'_>, answers: &mut [Answer], nanoseconds: &mut [u64]);
}

impl<R: AnswerQuery> AnswerQueries for R {
    fn answer(&self, queries: QuerySlice<'_>, answers: &mut [Answer]) {
        for (query, answer) in R::Scalar::of(queries).iter().zip(answers) {
            *answer = self.answer_query(query);
        }
    }

    fn answer_timed(&self, queries: QuerySlice<'_>, answers: &mut [Answer], nanoseconds: &mut [u64]) {
        for ((query, answer), nanoseconds) in R::Scalar::of(queries).iter().zip(answers).zip(nanoseconds) {
            let start = Instant::now();
            *answer = self.answer_query(query);
            *nanoseconds = elapsed_nanoseconds(start);
        }
    }
}

#[allow(clippy::cast_possible_truncation, reason = "584 years")]
fn elapsed_nanoseconds(start: Instant) -> u64 {
    start.elapsed().as_nanos() as u64
}

/// Measures the time between two readings of the clock, in nanoseconds: the median of many.
#[must_use]
pub fn clock_nanoseconds() -> f64 {
    const READINGS: usize = 10_000;
    let mut all: Vec<u64> = (0..READINGS).map(|_| elapsed_nanoseconds(Instant::now())).collect();
    all.sort_unstable();
    all[READINGS / 2] as f64
}

/// Makes an index answer with a setting. The index is borrowed, because several settings use the same one.
pub(crate) fn with_setting<'a, I>(index: &'a I, setting: &Setting) -> Box<dyn AnswerQueries + 'a>
where
    I: ClosestPoint<f64> + CertifiedQuery<f64> + Sync + ?Sized,
{
    match setting.accuracy {
        Accuracy::Certified => Box::new(WithCertificate(index)),
        _ => Box::new(WithOptions { index, options: setting.options() }),
    }
}

/// An index that answers with these options.
struct WithOptions<'a, I: ?Sized> {
    index: &'a I,
    options: QueryOptions<f64>,
}

impl<I: ClosestPoint<f64> + Sync + ?Sized> AnswerQuery for WithOptions<'_, I> {
    type Scalar = f64;

    #[inline(always)]
    fn answer_query(&self, query: &Point3<f64>) -> Answer {
        self.index.closest_point_with(query, &self.options).into()
    }
}

/// An index that returns certified answers.
struct WithCertificate<'a, I: ?Sized>(&'a I);

impl<I: CertifiedQuery<f64> + Sync + ?Sized> AnswerQuery for WithCertificate<'_, I> {
    type Scalar = f64;

    /// Returns no answer where there is no certificate.
    #[inline(always)]
    fn answer_query(&self, query: &Point3<f64>) -> Answer {
        self.0.certified_closest_point(query, &QueryOptions::default()).ok().flatten().into()
    }
}
