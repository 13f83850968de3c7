//! `p2m query` of an index in shards, which are loaded as queries need them.

use crate::answering::BlockSize;
use crate::closest_answers::{ClosestAnswer, Source, Task};
use crate::input::SceneArgs;
use crate::json;
use crate::output::Output;
use crate::query::{Args, queries};
use crate::sign_rule::SignRule;
use crate::streams::Streams;
use crate::summary::{IndexSummary, RunSummary, SceneSummary};
use crate::usage::usage;
use nalgebra::Point3;
use p2m_core::{Closest, PrimitiveId};
use p2m_shards::{ShardClosest, ShardedIndex, folder_of};
use rayon::prelude::*;
use serde_json::json;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Returns the folder of shards at a path, if it is one.
pub(crate) fn shard_folder(path: &Path, max_memory: Option<u64>) -> anyhow::Result<Option<PathBuf>> {
    let folder = folder_of(path);
    if folder.is_none() && path.is_dir() {
        anyhow::bail!(
            "{}: cannot be read: is a directory without the file manifest.json, so it is no finished index in shards",
            path.display()
        );
    }
    if folder.is_none() && max_memory.is_some() {
        return Err(usage("--max-memory needs the folder of an index in shards, which `p2m shard` writes"));
    }
    Ok(folder)
}

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

/// Refuses options that say how to read a scene or to build an index.
pub(crate) fn refuse_options_of_builds(scene: &SceneArgs, has_options_of_builds: bool) -> anyhow::Result<()> {
    if scene.has_format() {
        return Err(usage("--format is for files, but this is the folder of an index in shards"));
    }
    if has_options_of_builds {
        return Err(usage(
            "--backend, --k, --locator and --filter have no effect on an index in shards: each is built",
        ));
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

/// Opens an index in shards, whose primitives have to have numbers in a table.
pub(crate) fn open(folder: &Path, max_memory: Option<u64>, is_mapped: bool) -> anyhow::Result<ShardedIndex> {
    let max_bytes = max_memory.unwrap_or(u64::MAX);
    let index = if is_mapped {
        // SAFETY: `--map` says that the user has to keep the files unchanged.
        #[allow(unsafe_code, reason = "the user asked for it and was told what it needs")]
        unsafe {
            ShardedIndex::open_mapped(folder, max_bytes)
        }
    } else {
        ShardedIndex::open_with_max_bytes(folder, max_bytes)
    }?;
    if index.manifest().primitive_count() > PrimitiveId::MAX_COUNT as u64 {
        anyhow::bail!("{}: has more than 2^30 primitives, whose numbers fit into no table", folder.display());
    }
    Ok(index)
}

/// Returns the summary of an index in shards.
pub(crate) fn summarize(
    name: String,
    index: &ShardedIndex,
    read_time: Duration,
    build_time: Duration,
) -> IndexSummary<'_> {
    let manifest = index.manifest();
    let scene = SceneSummary { name, format: "p2m-shards", counts: manifest.counts(), skipped: &[] };
    IndexSummary { scene, backend: &manifest.backend, built: None, is_loaded: true, read_time, build_time }
}

/// Returns the line of a summary about the shards and how often they were loaded.
pub(crate) fn loads_line(index: &ShardedIndex) -> String {
    let (count, loads) = (index.manifest().shards.len(), index.loads());
    format!("shards   {count}, loaded {loads} {}\n", if loads == 1 { "time" } else { "times" })
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
