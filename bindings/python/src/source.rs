//! The index that answers a batch: an index over the whole scene, or a sharded one. Both answer all kinds of queries in
//! parts.

use crate::errors::shard_error;
use crate::index::Index;
use crate::parts::{Split, answer_in_parts, batch_options};
use crate::sharded::Shards;
use crate::work::Run;
use nalgebra::Point3;
use p2m_core::batch;
use p2m_shards::{ShardBatch, ShardError};
use pyo3::prelude::*;
use std::ops::Range;

/// A Python object that is an index.
#[derive(FromPyObject)]
pub(crate) enum Source<'py> {
    Whole(Bound<'py, Index>),
    Shards(Bound<'py, Shards>),
}

/// The index for a part of a batch.
pub(crate) enum Part<'a> {
    /// An index, to be used on this thread alone.
    Whole(&'a Index),
    /// Shards, on all threads of the current pool.
    Shards(ShardBatch<'a>),
}

impl Source<'_> {
    /// Answers a batch of queries in parts, detached from the interpreter, each part with the room for its answers.
    /// Returns the results in the order of the parts. `check` is called first, and `per_part` is the number of queries
    /// that shards answer at a time.
    pub(crate) fn answer<O: Split, R: Send>(
        &self,
        py: Python<'_>,
        (queries, per_part): (usize, usize),
        out: O,
        run: Run,
        check: impl FnOnce() -> PyResult<()> + Send,
        answer: impl Fn(&Part<'_>, Range<usize>, O) -> PyResult<R> + Send + Sync,
    ) -> PyResult<Vec<R>> {
        match self {
            Self::Whole(index) => {
                let index = index.get();
                index.run(py, queries, run, |threads, monitor| {
                    check()?;
                    let part = |range, out| answer(&Part::Whole(index), range, out);
                    answer_in_parts(queries, out, threads, monitor, &part).into_iter().collect()
                })
            }
            Self::Shards(shards) => {
                let part = |batch: ShardBatch<'_>, range, out| answer(&Part::Shards(batch), range, out);
                shards.get().answer(py, (queries, per_part), out, run, check, part)
            }
        }
    }
}

impl Part<'_> {
    /// Answers queries either by a function of an index and a query, or by a function of shards and all queries, whose
    /// answers are converted. `place` returns the position of a query, and `as_kind` casts the index to the trait of
    /// the queries.
    pub(crate) fn ask<'a, Q: Sync, A: Send, B, I: Copy + Sync>(
        &'a self,
        queries: &[Q],
        place: impl Fn(&Q) -> Point3<f64> + Sync,
        as_kind: impl FnOnce(&'a Index) -> PyResult<I>,
        whole: impl Fn(I, &Q) -> A + Sync,
        shards: impl FnOnce(ShardBatch<'_>, &[Q]) -> Result<Vec<B>, ShardError>,
        convert: impl Fn(B) -> A,
    ) -> PyResult<Vec<A>> {
        match *self {
            Self::Whole(index) => {
                let index = as_kind(index)?;
                Ok(batch::map(queries, &batch_options(queries.len(), false), place, |query| whole(index, query)))
            }
            Self::Shards(batch) => Ok(shards(batch, queries).map_err(shard_error)?.into_iter().map(convert).collect()),
        }
    }
}
