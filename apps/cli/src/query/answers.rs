//! The answers of `p2m query`: closest points of any source, written as a table.

use crate::answers::blocks::{BlockSize, QueryStream, Steps, answer_all};
use crate::answers::queries::Queries;
use crate::answers::summary::{AnswerSummary, IndexSummary, RunSummary};
use crate::answers::table::{AnswerEncoder, AnswerFormat, AnswerRecord, Table};
use crate::index::shards::{loads_line, shards_json};
use crate::index::sign_rule::SignReport;
use crate::io::json;
use crate::io::output::Output;
use crate::io::streams::Streams;
use crate::query::args::Args;
use nalgebra::Point3;
use p2m_core::{Closest, Soup};
use p2m_mixed::{Object, PointIds};
use p2m_shards::ShardedIndex;
use rayon::ThreadPool;
use serde_json::json;
use std::time::Duration;

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

/// A run that answers queries.
pub(crate) struct Run<'a> {
    pub(crate) streams: &'a Streams,
    pub(crate) args: &'a Args,
    pub(crate) pool: &'a ThreadPool,
    pub(crate) queries: Queries,
    /// The ids of the queries, if they have them.
    pub(crate) ids: Option<PointIds>,
    pub(crate) output: Output<'a>,
    pub(crate) format: AnswerFormat,
    pub(crate) objects: &'a [Object],
    pub(crate) index: IndexSummary<'a>,
    /// What decides signs, if there are signs.
    pub(crate) signs: Option<SignReport>,
    /// The shards, if the index is in shards.
    pub(crate) shards: Option<&'a ShardedIndex>,
    /// The scene, unless the index is in shards.
    pub(crate) soup: Option<&'a Soup<f64>>,
}

impl Run<'_> {
    /// Answers all queries, writes their answers, and prints a summary.
    pub(crate) fn finish(mut self, source: &impl Source) -> anyhow::Result<()> {
        let (summary, query_time) = self.answer(source)?;
        let Self { streams, args, pool, output, format, index, signs, shards, .. } = self;
        let bytes = output.bytes();
        output.finish()?;
        let run = RunSummary { index, threads: pool.current_num_threads(), query_time };
        if args.query_args.json {
            let shards = shards.map(|index| json!({ "shards": shards_json(index, args.max_memory) }));
            let signs = json!({ "sign_rule": signs.map(|signs| signs.rule), "inside": summary.inside() });
            let report = json::joined([shards.unwrap_or_default(), args.report(&summary, &run.index.cells()), signs]);
            return json::print(streams, &run.json("query", report, &args.query_args.output_json(format, bytes)));
        }
        let loads = shards.map_or_else(String::new, loads_line);
        let signs = signs.map(|signs| signs.text()).unwrap_or_default();
        streams
            .print_summary(format_args!("{}{loads}{summary}{signs}", run.text("queries", "query", summary.queries())));
        Ok(())
    }

    /// Answers all queries and writes their answers. Returns a summary, and the time that answering took.
    fn answer<S: Source>(&mut self, source: &S) -> anyhow::Result<(AnswerSummary, Duration)> {
        let cannot_write = self.output.cannot_write();
        let failed = |error| anyhow::Error::new(error).context(cannot_write.clone());
        let has_many = self.args.has_many_answers();
        let (has_signs, only_inside) = (self.signs.is_some(), self.args.has_only_inside());
        let ids = self.ids.take();
        let columns = self.args.columns(self.format, self.objects, ids.is_some());
        let encoder = AnswerEncoder::new(self.format, self.objects, columns).with_ids(ids);
        let encoder = match self.soup {
            Some(soup) => encoder.with_normals(soup),
            None => encoder,
        };
        // Only with one answer for each query it is known before how many there are.
        let count = Some(self.queries.len()).filter(|_| !has_many);
        let mut table = Table::new(&mut self.output, encoder.header(), count).map_err(failed)?;
        let (count, iter) = (self.queries.len(), &mut self.queries);
        let queries = QueryStream { name: "queries", count, iter, block_size: S::BLOCK_SIZE };
        let write = |count, records: &[u8]| table.write(count, records).map_err(failed);
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
                write,
            };
            answer_all(self.streams, self.pool, queries, steps)?
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
                write,
            };
            answer_all(self.streams, self.pool, queries, steps)?
        };
        table.finish().map_err(failed)?;
        Ok((summary, time))
    }
}
