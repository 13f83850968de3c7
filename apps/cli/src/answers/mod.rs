//! The queries of a run, the loop that answers them, and the table and the summary of the answers.

pub(crate) mod args;
pub(crate) mod blocks;
pub(crate) mod queries;
pub(crate) mod run;
pub(crate) mod running_stats;
pub(crate) mod summary;
pub(crate) mod table;

pub(crate) use args::QueryArgs;
pub(crate) use blocks::{BlockSize, QueryStream, Steps, answer_all, answer_each};
pub(crate) use queries::{Queries, Region, random_rays};
pub(crate) use run::AnswerRun;
pub(crate) use running_stats::RunningStats;
pub(crate) use summary::{AnswerSummary, IndexSummary, RunSummary, listed};
pub(crate) use table::{AnswerColumn, AnswerEncoder, AnswerFormat, AnswerRecord, HitEncoder, NumberEncoder};
