//! `p2m ray`: the hits of rays as a table.

mod answers;
mod args;
mod sharded;
mod summary;

pub(crate) use args::Args;

use crate::answers::summary::{IndexSummary, RunSummary, SceneSummary};
use crate::index::backend::{Backend, PreparedIndex, SceneSource, saved_or_default};
use crate::index::kdop_directions::requested;
use crate::index::shards::shard_folder;
use crate::io::input::read_scene_and_index;
use crate::io::json;
use crate::io::output::Output;
use crate::io::streams::Streams;
use crate::ray::answers::{Task, WholeIndex};
use crate::ray::args::rays;
use anyhow::Context;
use p2m_backends::{BackendEntry, P2mSettings};
use p2m_core::PrimitiveSet;
use p2m_core::storage::Reader;
use std::time::Instant;

pub(crate) fn run(streams: &Streams, args: &Args) -> anyhow::Result<()> {
    if let Some(folder) = shard_folder(&args.scene.path, args.max_memory)? {
        return sharded::run(streams, args, &folder);
    }
    let (scene_args, query_args) = (&args.scene, &args.query_args);
    args.check()?;
    let (format, out_format) = (scene_args.format()?, query_args.format(streams)?);
    let pool = query_args.threads.pool()?;
    let start = Instant::now();
    let (scene, saved) = read_scene_and_index(streams, &pool, &scene_args.path, format, scene_args.map)?;
    let rays = rays(streams, args, &scene.soup.aabb())?;
    let read_time = start.elapsed();
    // The file is opened before the work, which would be lost if its name were wrong.
    let mut output = Output::open(streams, Some(&query_args.out))?;

    let start = Instant::now();
    let saved = saved.as_ref();
    let backend = args.backend.unwrap_or_else(|| ray_backend(saved));
    if let Some(other) = saved.and_then(BackendEntry::from_saved).filter(|other| !other.casts_rays) {
        streams.print_summary(format_args!("note     the saved index ({other}) answers no rays: {backend} is built\n"));
    }
    let kdop_directions = requested(backend.has_kdop_directions, query_args.k)?;
    let source = SceneSource { soup: &scene.soup, kdop_directions, p2m: P2mSettings::default(), saved };
    let PreparedIndex { built, is_loaded, .. } =
        source.prepare(streams, backend, &pool).with_context(|| scene_args.name())?;
    let build_time = start.elapsed();

    let index = built.index.as_ray_query().context("the backend casts no rays")?;
    let (output_file, objects) = (&mut output, scene.objects.as_slice());
    let task = Task { streams, pool: &pool, rays, output: output_file, format: out_format, objects };
    let (query_time, summary) = task.run(&WholeIndex(index), args.mode)?;
    let bytes = output.bytes();
    output.finish()?;

    let (backend, threads) = (backend.name, pool.current_num_threads());
    let scene = SceneSummary::new(scene_args.name(), format, &scene);
    let index = IndexSummary { scene, backend, built: Some(&built), is_loaded, read_time, build_time };
    let run = RunSummary { index, threads, query_time };
    if query_args.json {
        let report = args.report(summary.json());
        return json::print(streams, &run.json("ray", report, &query_args.output_json(out_format, bytes)));
    }
    streams.print_summary(format_args!("{}{summary}", run.text("rays", "ray", summary.rays())));
    Ok(())
}

/// Returns the backend of a saved index that casts rays, or else the default one.
fn ray_backend(saved: Option<&Reader>) -> Backend {
    Some(saved_or_default(saved)).filter(|backend| backend.casts_rays).unwrap_or_else(|| saved_or_default(None))
}
