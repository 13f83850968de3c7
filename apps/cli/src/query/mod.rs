//! `p2m query`: closest points as a table.

pub(crate) mod accuracy;
pub(crate) mod answers;
mod args;
pub(crate) mod field;
mod field_summary;
mod sharded;

pub(crate) use args::Args;

use crate::answers::blocks::{BlockSize, answer_each};
use crate::answers::summary::{IndexSummary, RunSummary, SceneSummary};
use crate::index::backend::{BackendChoice, PreparedIndex, SceneSource};
use crate::index::kdop_directions::requested;
use crate::index::shards::shard_folder;
use crate::index::sign_rule::SignedIndex;
use crate::io::input::read_scene_and_index;
use crate::io::json;
use crate::io::output::Output;
use crate::io::streams::Streams;
use crate::query::answers::{ClosestAnswer, Source, Task};
use crate::query::args::queries;
use anyhow::Context;
use nalgebra::Point3;
use p2m_backends::{AnyIndex, QueryRegion, Workload};
use p2m_core::{Closest, PrimitiveSet};
use rayon::prelude::*;
use std::time::Instant;

pub(crate) fn run(streams: &Streams, args: &Args) -> anyhow::Result<()> {
    if let Some(folder) = shard_folder(&args.scene.path, args.max_memory)? {
        return sharded::run(streams, args, &folder);
    }
    let (scene_args, query_args) = (&args.scene, &args.query_args);
    query_args.check(scene_args, args.points.as_deref(), "points")?;
    args.check()?;
    let (format, out_format) = (scene_args.format()?, query_args.format(streams)?);
    let pool = query_args.threads.pool()?;
    let start = Instant::now();
    let (scene, saved) = read_scene_and_index(streams, &pool, &scene_args.path, format, scene_args.map)?;
    let (queries, sample) = queries(streams, args, &scene.soup.aabb())?;
    let read_time = start.elapsed();
    // The file is opened before the work, which would be lost if its name were wrong.
    let mut output = Output::open(streams, Some(&query_args.out))?;

    let start = Instant::now();
    let saved = saved.as_ref();
    let region = sample.as_deref().map_or(QueryRegion::SceneBox, QueryRegion::Like);
    let workload = Workload::new(queries.len(), region);
    let backend = BackendChoice::resolve(args.backend, saved, &scene.soup, &workload, &pool);
    let backend = backend.with_context(|| scene_args.name())?;
    let kdop_directions = requested(backend.has_kdop_directions, query_args.k)?;
    let p2m = args.p2m.settings(backend.has_p2m_settings)?;
    let source = SceneSource { soup: &scene.soup, kdop_directions, p2m, saved };
    let PreparedIndex { built, is_loaded, .. } =
        source.prepare(streams, backend, &pool).with_context(|| scene_args.name())?;
    let index = &*built.index;
    let build_time = start.elapsed();

    let signed = args.signed.map(|rule| rule.prepare(streams, index, &scene.soup)).transpose();
    let signed = signed.with_context(|| scene_args.name())?.map(|(signed, _)| signed);
    let source = WholeIndex { index, signed: signed.as_ref(), args };
    let objects = &scene.objects;
    let task = Task { streams, args, pool: &pool, queries, output: &mut output, format: out_format, objects };
    let (summary, query_time) = task.run(&source)?;
    let bytes = output.bytes();
    output.finish()?;

    let (backend, threads) = (backend.name, pool.current_num_threads());
    let scene = SceneSummary::new(scene_args.name(), format, &scene);
    let index = IndexSummary { scene, backend, built: Some(&built), is_loaded, read_time, build_time };
    let run = RunSummary { index, threads, query_time };
    if query_args.json {
        let report = args.report(&summary, &run.index.cells());
        return json::print(streams, &run.json("query", report, &query_args.output_json(out_format, bytes)));
    }
    streams.print_summary(format_args!("{}{summary}", run.text("queries", "query", summary.queries())));
    Ok(())
}

/// An index over the whole scene, with signs if they are asked for.
struct WholeIndex<'a> {
    index: &'a dyn AnyIndex,
    signed: Option<&'a SignedIndex<'a>>,
    args: &'a Args,
}

impl Source for WholeIndex<'_> {
    const BLOCK_SIZE: BlockSize = BlockSize::Adaptive;

    fn closest(&self, queries: &[Point3<f64>]) -> anyhow::Result<Vec<ClosestAnswer>> {
        let answers = self.args.accuracy.answer(self.index, queries, &self.args.options());
        let with_sign = |(query, answer): (&Point3<f64>, Option<Closest<f64>>)| {
            let signed =
                self.signed.zip(answer).and_then(|(signed, answer)| signed.with_sign(query, answer).distance());
            (answer, signed.unwrap_or(f64::NAN))
        };
        Ok(queries.par_iter().zip(answers).map(with_sign).collect())
    }

    fn near(&self, queries: &[Point3<f64>]) -> anyhow::Result<Vec<Vec<Closest<f64>>>> {
        let near = |query: &Point3<f64>| match self.args.near() {
            (None, radius) => self.index.all_within(query, radius),
            (Some(k), radius) => self.index.k_nearest(query, k, radius),
        };
        Ok(answer_each(queries, near))
    }
}
