//! The answers to the points of a scan: the closest point and the deviation of each.

use crate::answers::{AnswerEncoder, AnswerRecord, BlockSize, QueryStream, Steps, answer_all};
use crate::index::SignedIndex;
use crate::io::{Output, Session};
use crate::query::answers::ClosestAnswer;
use nalgebra::Point3;
use p2m_backends::AnyIndex;
use p2m_core::batch::{self, BatchOptions};
use p2m_core::engine::parallel;
use p2m_core::{Closest, QueryOptions};
use p2m_field::deviation::LocalPlanes;
use std::time::Duration;

/// A rule of signs of deviations.
pub(super) enum Signs<'a> {
    /// There are none: deviations are distances.
    None,
    /// The inside of a surface.
    Surface(SignedIndex<'a>),
    /// The planes of a cloud of points, from which deviations are measured.
    Planes(LocalPlanes),
}

impl Signs<'_> {
    /// Returns the name of the rule, if there is one.
    pub(super) fn rule(&self) -> Option<&'static str> {
        match self {
            Self::None => None,
            Self::Surface(signed) => Some(signed.rule().name()),
            Self::Planes(_) => Some("planes"),
        }
    }

    fn deviation(&self, point: &Point3<f64>, answer: Closest<f64>) -> Option<f64> {
        match self {
            Self::None => Some(answer.distance),
            Self::Surface(signed) => signed.with_sign(point, answer).distance(),
            Self::Planes(planes) => Some(planes.deviation(point, &answer)),
        }
    }
}

/// Which points of a scan have a deviation, and which of these a table has.
pub(super) struct Filter {
    /// Points that are left out, by their numbers; none if there are no numbers.
    pub(super) left_out: Vec<bool>,
    /// The largest distance of a point that counts.
    pub(super) max_distance: f64,
    /// If it is not negative, the table has the points with larger deviations alone.
    pub(super) beyond: f64,
}

impl Filter {
    pub(super) fn is_left_out(&self, number: usize) -> bool {
        self.left_out.get(number).is_some_and(|is| *is)
    }

    /// Tells whether a table has a deviation.
    pub(super) fn is_in_table(&self, deviation: f64) -> bool {
        self.beyond < 0.0 || deviation.abs() > self.beyond
    }
}

/// The answers to the points of a scan, and where they come from.
pub(super) struct Answers<'a> {
    pub(super) index: &'a dyn AnyIndex,
    pub(super) signs: &'a Signs<'a>,
    pub(super) filter: &'a Filter,
    /// The deviation of each point, or NaN.
    pub(super) values: Vec<f64>,
    /// The closest primitive of each point, or `u32::MAX`.
    pub(super) primitives: Vec<u32>,
    /// The weights of the vertices of each primitive, if there is a list.
    pub(super) barycentric: Option<Vec<[f64; 3]>>,
}

impl Answers<'_> {
    /// Answers points on all threads, and writes their table, if there is one. Returns the time that the answers took.
    pub(super) fn add(
        &mut self,
        session: &Session<'_>,
        points: &[Point3<f64>],
        table: Option<(&AnswerEncoder<'_>, &mut Output<'_>)>,
    ) -> anyhow::Result<Duration> {
        let Self { index, signs, filter, values, primitives, barycentric } = self;
        let with_deviation = |(point, answer): (&Point3<f64>, Option<Closest<f64>>)| {
            let deviation = answer.and_then(|answer| signs.deviation(point, answer));
            (answer, deviation.unwrap_or(f64::NAN))
        };
        let options = QueryOptions::default().with_max_distance(filter.max_distance);
        let count = (filter.beyond < 0.0).then_some(points.len() as u64);
        let (encoder, output) = table.unzip();
        let file = output.zip(encoder).map(|(output, encoder)| (output, encoder.header(), count));
        let counted = |number: usize, (answer, deviation): &ClosestAnswer| {
            if filter.is_left_out(number) { (None, f64::NAN) } else { (*answer, *deviation) }
        };
        let steps = Steps {
            answer: |points: &[Point3<f64>]| {
                let mut answers = vec![None; points.len()];
                batch::closest_points_into(*index, points, &options, &BatchOptions::default(), &mut answers);
                Ok(parallel::map(points.len(), true, |i| with_deviation((&points[i], answers[i]))))
            },
            encode: |number, query: &_, answer: &ClosestAnswer, out: &mut _| {
                let (answer, deviation) = counted(usize::try_from(number).unwrap_or(usize::MAX), answer);
                if !filter.is_in_table(deviation) {
                    return 0;
                }
                let record = AnswerRecord { number, query, answer: answer.as_ref(), signed_distance: deviation };
                encoder.map_or(0, |encoder| {
                    encoder.encode(&record, out);
                    1
                })
            },
            take: |_: &_, answer: &ClosestAnswer| {
                let (answer, deviation) = counted(values.len(), answer);
                values.push(deviation);
                primitives.push(answer.map_or(u32::MAX, |answer| answer.primitive.number()));
                if let Some(all) = barycentric {
                    all.push(answer.map_or([0.0; 3], |answer| answer.barycentric));
                }
            },
        };
        let iter = points.iter().copied();
        let mut queries =
            QueryStream { name: "points", count: points.len() as u64, iter, block_size: BlockSize::Adaptive };
        answer_all(session, &mut queries, file, steps)
    }
}
