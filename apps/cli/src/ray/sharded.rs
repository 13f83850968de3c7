//! `p2m ray` of an index in shards, which are loaded as rays need them.

use crate::answers::summary::RunSummary;
use crate::index::shards::{loads_line, open, refuse_options_of_builds, summarize};
use crate::io::json;
use crate::io::output::Output;
use crate::io::streams::Streams;
use crate::ray::answers::{RaySource, Task};
use crate::ray::args::{Args, rays};
use p2m_core::{Hit, PrimitiveId, Ray};
use p2m_shards::{ShardHit, ShardedIndex};
use serde_json::json;
use std::path::Path;
use std::time::Instant;

pub(crate) fn run(streams: &Streams, args: &Args, folder: &Path) -> anyhow::Result<()> {
    let query_args = &args.query_args;
    args.check()?;
    refuse_options_of_builds(&args.scene, args.backend.is_some() || query_args.k.is_some())?;
    let format = query_args.format(streams)?;
    let start = Instant::now();
    let index = open(folder, args.max_memory, args.scene.map)?;
    let build_time = start.elapsed();
    let start = Instant::now();
    let rays = rays(streams, args, &index.bounds())?;
    let read_time = start.elapsed();
    let mut output = Output::open(streams, Some(&query_args.out))?;

    let pool = query_args.threads.pool()?;
    let objects = index.manifest().objects();
    let task = Task { streams, pool: &pool, rays, output: &mut output, format, objects: &objects };
    let (query_time, summary) = task.run(&Shards(&index), args.mode)?;
    let bytes = output.bytes();
    output.finish()?;

    let index_summary = summarize(args.scene.name(), &index, read_time, build_time);
    let run = RunSummary { index: index_summary, threads: pool.current_num_threads(), query_time };
    if query_args.json {
        let (count, loads) = (index.manifest().shards.len(), index.loads());
        let shards = json!({ "shards": { "count": count, "loads": loads, "max_memory": args.max_memory } });
        let report = json::joined([shards, args.report(summary.json())]);
        return json::print(streams, &run.json("ray", report, &query_args.output_json(format, bytes)));
    }
    let text = run.text("rays", "ray", summary.rays());
    streams.print_summary(format_args!("{text}{}{summary}", loads_line(&index)));
    Ok(())
}

/// An index in shards.
struct Shards<'a>(&'a ShardedIndex);

impl RaySource for Shards<'_> {
    fn do_intersect(&self, ray: &Ray) -> anyhow::Result<bool> {
        Ok(self.0.do_intersect(ray)?)
    }

    fn any_intersection(&self, ray: &Ray) -> anyhow::Result<Option<Hit>> {
        self.first_intersection(ray)
    }

    fn first_intersection(&self, ray: &Ray) -> anyhow::Result<Option<Hit>> {
        Ok(self.0.first_intersection(ray)?.map(in_scene))
    }

    fn all_intersections(&self, ray: &Ray) -> anyhow::Result<Vec<Hit>> {
        Ok(self.0.all_intersections(ray)?.into_iter().map(in_scene).collect())
    }

    fn count(&self, ray: &Ray) -> anyhow::Result<usize> {
        Ok(self.0.count(ray)?)
    }

    fn crossings(&self, ray: &Ray) -> anyhow::Result<usize> {
        Ok(self.0.crossings(ray)?)
    }
}

/// Returns a hit with the number of the primitive in the whole scene.
#[allow(clippy::cast_possible_truncation, reason = "a scene has at most 2^30 primitives here")]
fn in_scene(hit: ShardHit) -> Hit {
    let mut in_scene = hit.hit;
    in_scene.primitive = PrimitiveId::new(hit.id as usize);
    in_scene
}
