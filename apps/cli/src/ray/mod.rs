//! `p2m ray`: the hits of rays as a table.

mod answers;
mod args;
mod summary;

pub(crate) use args::Args;

use crate::answers::{AnswerRun, BlockSize, IndexSummary};
use crate::index::Chosen;
use crate::index::shards::{open, refuse_options_of_builds, shard_folder, summarize};
use crate::io::{Output, Streams, usage};
use crate::ray::answers::{RaySource, Run};
use crate::ray::args::rays;
use anyhow::Context;
use p2m_backends::BackendEntry;
use p2m_core::PrimitiveSet;
use std::path::Path;
use std::time::Instant;

pub(crate) fn run(streams: &Streams, args: &Args) -> anyhow::Result<()> {
    let folder = shard_folder(&args.scene.path)?;
    if folder.is_none() && args.max_memory.is_some() {
        return Err(usage("--max-memory needs the folder of an index in shards, which `p2m shard` writes"));
    }
    if let Some(folder) = folder {
        return run_in_shards(streams, args, &folder);
    }
    let (scene_args, query_args) = (&args.scene, &args.query_args);
    args.check()?;
    let (format, out_format) = (scene_args.format()?, query_args.format(streams)?);
    let session = query_args.threads.start(streams)?;
    let start = Instant::now();
    let mut file = scene_args.read(&session, format)?;
    let rays = rays(streams, args, &file.scene.soup.aabb())?;
    file.read_time = start.elapsed();
    // The file is opened before the work, which would be lost if its name were wrong.
    let output = Output::open(streams, Some(&query_args.out))?;

    let start = Instant::now();
    let default = || Some(file.backend()).filter(|backend| backend.casts_rays);
    let backend = args.backend.or_else(default).unwrap_or_else(BackendEntry::default_backend);
    if let Some(other) = file.saved_backend().filter(|other| !other.casts_rays) {
        streams.print_summary(format_args!("note     the saved index ({other}) answers no rays: {backend} is built\n"));
    }
    let prepared = file.prepare(&session, Chosen::from(backend).with_k(query_args.k)?)?;
    let index = IndexSummary::new(&file, backend.name, Some(&prepared), start.elapsed());
    let source = RaySource::Whole(prepared.built.index.as_ray_query().context("the backend casts no rays")?);
    let (objects, format) = (&*file.scene.objects, out_format);
    let run = AnswerRun { session: &session, args: query_args, output, format, objects, index, shards: None };
    Run { args, run, rays }.finish(source)
}

/// Answers rays by an index in shards, which are loaded as rays need them.
fn run_in_shards(streams: &Streams, args: &Args, folder: &Path) -> anyhow::Result<()> {
    let query_args = &args.query_args;
    args.check()?;
    refuse_options_of_builds(&args.scene, args.backend.is_some() || query_args.k.is_some())?;
    let format = query_args.format(streams)?;
    let start = Instant::now();
    let shards = open(folder, args.max_memory, args.scene.map)?;
    let build_time = start.elapsed();
    let start = Instant::now();
    let mut rays = rays(streams, args, &shards.bounds())?;
    rays.block_size = BlockSize::OF_SHARDS;
    let read_time = start.elapsed();
    let output = Output::open(streams, Some(&query_args.out))?;
    let (session, objects) = (query_args.threads.start(streams)?, shards.manifest().objects());
    let run = AnswerRun {
        session: &session,
        args: query_args,
        output,
        format,
        objects: &objects,
        index: summarize(args.scene.name(), &shards, read_time, build_time),
        shards: Some((&shards, args.max_memory)),
    };
    Run { args, run, rays }.finish(RaySource::Shards(&shards))
}
