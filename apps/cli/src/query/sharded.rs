//! `p2m query` of an index in shards, which are loaded as queries need them.

use crate::answers::blocks::BlockSize;
use crate::answers::summary::RunSummary;
use crate::index::shards::{loads_line, open, refuse_options_of_builds, summarize};
use crate::index::sign_rule::SignRule;
use crate::io::json;
use crate::io::output::Output;
use crate::io::streams::Streams;
use crate::io::usage::usage;
use crate::query::answers::{ClosestAnswer, Source, Task};
use crate::query::args::{Args, queries};
use nalgebra::Point3;
use p2m_core::{Closest, PrimitiveId};
use p2m_shards::{ShardClosest, ShardedIndex};
use rayon::prelude::*;
use serde_json::json;
use std::path::Path;
use std::time::Instant;

pub(crate) fn run(streams: &Streams, args: &Args, folder: &Path) -> anyhow::Result<()> {
    let query_args = &args.query_args;
    query_args.check(&args.scene, args.points.as_deref(), "points")?;
    args.check()?;
    let has_options_of_builds = args.backend.is_some() || query_args.k.is_some() || !args.p2m.is_unspecified();
    refuse_options_of_builds(&args.scene, has_options_of_builds)?;
    refuse_other_signs(args)?;
    let format = query_args.format(streams)?;
    let start = Instant::now();
    let index = open(folder, args.max_memory, args.scene.map)?;
    let manifest = index.manifest();
    if args.signed.is_some() {
        // Without points this checks that the scene has an inside.
        index.are_inside(&[] as &[Point3<f64>])?;
    }
    let build_time = start.elapsed();
    let start = Instant::now();
    let (queries, _) = queries(streams, args, &index.bounds())?;
    let read_time = start.elapsed();
    let mut output = Output::open(streams, Some(&query_args.out))?;

    let pool = query_args.threads.pool()?;
    let objects = manifest.objects();
    let source = Shards { index: &index, args };
    let task = Task { streams, args, pool: &pool, queries, output: &mut output, format, objects: &objects };
    let (summary, query_time) = task.run(&source)?;
    let bytes = output.bytes();
    output.finish()?;

    let index_summary = summarize(args.scene.name(), &index, read_time, build_time);
    let run = RunSummary { index: index_summary, threads: pool.current_num_threads(), query_time };
    if query_args.json {
        let (signs, closed_checked) = args.signed.map(|_| ("crossings", false)).unzip();
        let shards = json!({
            "count": manifest.shards.len(),
            "loads": index.loads(),
            "max_memory": args.max_memory,
            "signs": signs,
            "closed_checked": closed_checked,
        });
        let answers = json::joined([json!({ "shards": shards }), args.report(&summary, &run.index.cells())]);
        return json::print(streams, &run.json("query", answers, &query_args.output_json(format, bytes)));
    }
    let text = run.text("queries", "query", summary.queries());
    streams.print_summary(format_args!("{text}{}{summary}", loads_line(&index)));
    if args.signed.is_some() {
        streams.print_summary(format_args!("note     that the surface is closed was not checked\n"));
    }
    Ok(())
}

/// Refuses rules of signs that shards do not have.
fn refuse_other_signs(args: &Args) -> anyhow::Result<()> {
    let (rule, reason) = match args.signed {
        None | Some(SignRule::Auto) => return Ok(()),
        Some(SignRule::Closed) => ("closed", "which cannot check that the surface is closed"),
        Some(SignRule::Winding) => ("winding", "which has no winding numbers"),
    };
    Err(usage(format!(
        "--signed={rule} is not for an index in shards, {reason}: use --signed, which counts crossings of a ray, if you \
         know that the surface is closed"
    )))
}

/// An index in shards.
struct Shards<'a> {
    index: &'a ShardedIndex,
    args: &'a Args,
}

impl Source for Shards<'_> {
    // A block may load every shard, however few queries it has.
    const BLOCK_SIZE: BlockSize = BlockSize::Fixed(1 << 18);

    fn closest(&self, queries: &[Point3<f64>]) -> anyhow::Result<Vec<ClosestAnswer>> {
        let options = self.args.options();
        let mut answers = vec![None; queries.len()];
        if self.args.accuracy.is_certified() {
            answers = self.index.certified_closest_points(queries, &options)?;
        } else {
            self.index.closest_points_into(queries, &options, &mut answers)?;
        }
        if self.args.signed.is_none() {
            return Ok(answers.into_par_iter().map(|answer| (answer.map(in_scene), f64::NAN)).collect());
        }
        let are_inside = self.index.are_inside(queries)?;
        let with_sign = |(answer, is_inside): (Option<ShardClosest>, bool)| {
            let distance = answer.map_or(f64::NAN, |answer| answer.closest.distance);
            // A point on the surface has the distance 0, which has no sign.
            (answer.map(in_scene), if is_inside && distance > 0.0 { -distance } else { distance })
        };
        Ok(answers.into_par_iter().zip(are_inside).map(with_sign).collect())
    }

    fn near(&self, queries: &[Point3<f64>]) -> anyhow::Result<Vec<Vec<Closest<f64>>>> {
        let (k, radius) = self.args.near();
        let near = self.index.all_k_nearest(queries, k.unwrap_or(usize::MAX), radius)?;
        Ok(near.into_par_iter().map(|near| near.into_iter().map(in_scene).collect()).collect())
    }
}

/// Returns an answer with the number of the primitive in the whole scene.
#[allow(clippy::cast_possible_truncation, reason = "a scene has at most 2^30 primitives here")]
fn in_scene(answer: ShardClosest) -> Closest<f64> {
    let mut closest = answer.closest;
    closest.primitive = PrimitiveId::new(answer.id as usize);
    closest
}
