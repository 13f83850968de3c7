//! `p2m ray`: the hits of rays as a table.

mod answers;
mod args;
mod summary;

pub(crate) use args::Args;

use crate::answers::blocks::BlockSize;
use crate::answers::summary::{IndexSummary, SceneSummary};
use crate::index::backend::{Backend, PreparedIndex, SceneSource, saved_or_default};
use crate::index::kdop_directions::requested;
use crate::index::shards::{open, refuse_options_of_builds, shard_folder, summarize};
use crate::io::input::read_scene_and_index;
use crate::io::output::Output;
use crate::io::streams::Streams;
use crate::io::usage::usage;
use crate::ray::answers::{RaySource, Run};
use crate::ray::args::rays;
use anyhow::Context;
use p2m_backends::{BackendEntry, P2mSettings};
use p2m_core::PrimitiveSet;
use p2m_core::storage::Reader;
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
    let pool = query_args.threads.pool()?;
    let start = Instant::now();
    let (scene, saved) = read_scene_and_index(streams, &pool, &scene_args.path, format, scene_args.map)?;
    let rays = rays(streams, args, &scene.soup.aabb())?;
    let read_time = start.elapsed();
    // The file is opened before the work, which would be lost if its name were wrong.
    let output = Output::open(streams, Some(&query_args.out))?;

    let start = Instant::now();
    let saved = saved.as_ref();
    let backend = args.backend.unwrap_or_else(|| ray_backend(saved));
    if let Some(other) = saved.and_then(BackendEntry::from_saved).filter(|other| !other.casts_rays) {
        streams.print_summary(format_args!("note     the saved index ({other}) answers no rays: {backend} is built\n"));
    }
    let kdop_directions = requested(backend.has_kdop_directions, query_args.k)?;
    let source = SceneSource { soup: &scene.soup, kdop_directions, p2m: P2mSettings::default(), saved };
    let PreparedIndex { built, is_loaded, reason, .. } =
        source.prepare(streams, backend, &pool).with_context(|| scene_args.name())?;
    let build_time = start.elapsed();

    let index = built.index.as_ray_query().context("the backend casts no rays")?;
    let (summary, backend) = (SceneSummary::new(scene_args.name(), format, &scene), backend.name);
    let summary =
        IndexSummary { scene: summary, backend, built: Some(&built), is_loaded, reason, read_time, build_time };
    let (objects, index, source) = (scene.objects.as_slice(), summary, RaySource::Whole(index));
    Run { streams, args, pool: &pool, rays, output, format: out_format, objects, index }.finish(source)
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
    let (pool, objects) = (query_args.threads.pool()?, shards.manifest().objects());
    let (objects, index) = (&*objects, summarize(args.scene.name(), &shards, read_time, build_time));
    Run { streams, args, pool: &pool, rays, output, format, objects, index }.finish(RaySource::Shards(&shards))
}

/// Returns the backend of a saved index that casts rays, or else the default one.
fn ray_backend(saved: Option<&Reader>) -> Backend {
    Some(saved_or_default(saved)).filter(|backend| backend.casts_rays).unwrap_or_else(|| saved_or_default(None))
}
