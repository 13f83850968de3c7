//! The answers of `p2m query`: closest points of any source, written as a table.

use crate::answers::{
    AnswerEncoder, AnswerRecord, AnswerRun, AnswerSummary, BlockSize, Queries, QueryStream, Steps, answer_all,
};
use crate::index::SignReport;
use crate::io::json;
use crate::query::args::Args;
use nalgebra::Point3;
use p2m_core::{Closest, Soup};
use p2m_mixed::PointIds;
use serde_json::json;

/// The closest primitive, if there is one, and the distance with a sign, which is NaN where no signs are asked for.
pub(crate) type ClosestAnswer = (Option<Closest<f64>>, f64);

/// A source of answers: an index in memory or one in shards.
pub(crate) trait Source: Sync {
    /// The number of queries that it is best asked at a time.
    const BLOCK_SIZE: BlockSize;

    /// Answers some queries on all threads of the current pool, each with the closest point.
    fn closest(&self, queries: &[Point3<f64>]) -> anyhow::Result<Vec<ClosestAnswer>>;

    /// Answers some queries on all threads of the current pool, each with any number of near primitives.
    fn near(&self, queries: &[Point3<f64>]) -> anyhow::Result<Vec<Vec<Closest<f64>>>>;
}

/// A run that answers points.
pub(crate) struct Run<'a> {
    pub(crate) args: &'a Args,
    pub(crate) run: AnswerRun<'a>,
    pub(crate) queries: Queries,
    /// The ids of the queries, if they have them.
    pub(crate) ids: Option<PointIds>,
    /// What decides signs, if there are signs.
    pub(crate) signs: Option<SignReport>,
    /// The scene, unless the index is in shards.
    pub(crate) soup: Option<&'a Soup<f64>>,
}

impl Run<'_> {
    /// Answers all queries, writes their answers, and prints a summary.
    pub(crate) fn finish<S: Source>(self, source: &S) -> anyhow::Result<()> {
        let Self { args, mut run, queries, ids, signs, soup } = self;
        let has_many = args.has_many_answers();
        let (has_signs, only_inside) = (signs.is_some(), args.has_only_inside());
        let columns = args.columns(run.format, run.objects, ids.is_some());
        let encoder = AnswerEncoder::new(run.format, run.objects, columns).with_ids(ids);
        let encoder = match soup {
            Some(soup) => encoder.with_normals(soup),
            None => encoder,
        };
        let count = queries.len();
        // Only with one answer for each query it is known before how many there are.
        let file = (&mut run.output, encoder.header(), Some(count).filter(|_| !has_many));
        let mut queries = QueryStream { name: "queries", count, iter: queries, block_size: S::BLOCK_SIZE };
        let mut summary = AnswerSummary::default();
        let time = if has_many {
            let steps = Steps {
                answer: |queries: &[_]| source.near(queries),
                encode: |number, query: &_, answers: &Vec<_>, out: &mut _| {
                    for answer in answers {
                        let record = AnswerRecord { number, query, answer: Some(answer), signed_distance: f64::NAN };
                        encoder.encode(&record, out);
                    }
                    answers.len() as u64
                },
                take: |_: &_, answers: &Vec<_>| summary.add_all(answers),
            };
            answer_all(run.session, &mut queries, Some(file), steps)?
        } else {
            let steps = Steps {
                answer: |queries: &[_]| source.closest(queries),
                encode: |number, query: &_, (answer, signed_distance): &ClosestAnswer, out: &mut _| {
                    let answer = answer.as_ref();
                    encoder.encode(&AnswerRecord { number, query, answer, signed_distance: *signed_distance }, out);
                    1
                },
                take: |_: &_, (answer, signed_distance): &ClosestAnswer| {
                    let is_inside = has_signs.then_some(*signed_distance < 0.0);
                    if only_inside { summary.add_side(is_inside) } else { summary.add(answer.as_ref(), is_inside) }
                },
            };
            answer_all(run.session, &mut queries, Some(file), steps)?
        };
        let inside = json!({ "sign_rule": signs.map(|signs| signs.rule), "inside": summary.inside });
        let report = json::joined([args.report(&summary, &run.index.cells()), inside]);
        let text = format!("{summary}{}", signs.map(|signs| signs.text()).unwrap_or_default());
        run.finish(["query", "queries", "query"], summary.queries, time, report, &text)
    }
}
