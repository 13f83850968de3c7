//! A run that answers points or rays: its index, the file of its answers, and its summary.

use crate::answers::args::QueryArgs;
use crate::answers::summary::{IndexSummary, RunSummary};
use crate::answers::table::AnswerFormat;
use crate::index::shards::{loads_line, shards_json};
use crate::io::{Output, Session, json};
use p2m_mixed::Object;
use p2m_shards::ShardedIndex;
use serde_json::{Value, json};
use std::time::Duration;

/// A run that answers points or rays.
pub(crate) struct AnswerRun<'a> {
    pub(crate) args: &'a QueryArgs,
    pub(crate) session: &'a Session<'a>,
    pub(crate) output: Output<'a>,
    pub(crate) format: AnswerFormat,
    pub(crate) objects: &'a [Object],
    pub(crate) index: IndexSummary<'a>,
    /// The shards and the largest number of their bytes in memory, if the index is in shards.
    pub(crate) shards: Option<(&'a ShardedIndex, Option<u64>)>,
}

impl AnswerRun<'_> {
    /// Completes the file, and prints a summary of `count` queries. `report` and `text` are the parts of it about the
    /// answers, and `words` are the command, and the names of the queries in the plural and in the singular.
    pub(crate) fn finish(
        self,
        [command, many, one]: [&str; 3],
        count: u64,
        query_time: Duration,
        report: Value,
        text: &str,
    ) -> anyhow::Result<()> {
        let Self { session: Session { streams, pool }, args, output, format, index, shards, .. } = self;
        let bytes = output.bytes();
        output.finish()?;
        let run = RunSummary { index, threads: pool.current_num_threads(), query_time };
        if args.json {
            let shards = shards.map(|(index, max_memory)| json!({ "shards": shards_json(index, max_memory) }));
            let answers = json::joined([shards.unwrap_or_default(), report]);
            return run.print_json(streams, command, answers, &args.output_json(format, bytes));
        }
        let loads = shards.map_or_else(String::new, |(index, _)| loads_line(index));
        streams.print_summary(format_args!("{}{loads}{text}", run.text(many, one, count)));
        Ok(())
    }
}
