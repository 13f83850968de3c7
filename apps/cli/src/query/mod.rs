//! `p2m query`: closest points as a table.

pub(crate) mod accuracy;
pub(crate) mod answers;
mod args;
#[cfg(feature = "cuda")]
mod card;
pub(crate) mod field;
mod field_summary;
pub(crate) mod sample;

pub(crate) use args::Args;

use crate::answers::{AnswerRun, BlockSize, IndexSummary, answer_each};
use crate::index::shards::{open, refuse_options_of_builds, shard_folder, summarize};
use crate::index::{SignReport, SignRule, SignedIndex};
use crate::io::{Output, Streams, usage};
use crate::query::answers::{ClosestAnswer, Run, Source};
use crate::query::args::{PreparedQueries, queries};
use anyhow::Context;
use nalgebra::Point3;
use p2m_backends::{AnyIndex, QueryRegion, Workload};
use p2m_core::batch::BatchOptions;
use p2m_core::engine::parallel;
use p2m_core::{Closest, PrimitiveId, PrimitiveSet};
use p2m_shards::{ShardClosest, ShardedIndex};
use std::path::Path;
use std::time::Instant;

pub(crate) fn run(streams: &Streams, args: &Args) -> anyhow::Result<()> {
    if let Some(folder) = shard_folder(&args.scene.path)? {
        return run_in_shards(streams, args, &folder);
    }
    let (scene_args, query_args) = (&args.scene, &args.query_args);
    query_args.check(scene_args, args.points.points.as_deref(), "points")?;
    let (format, out_format) = (scene_args.format()?, query_args.format(streams)?);
    args.check(out_format)?;
    let session = query_args.threads.start(streams)?;
    let start = Instant::now();
    let mut file = scene_args.read(&session, format)?;
    let PreparedQueries { queries, ids, sample } = queries(streams, args, &file.scene.soup.aabb())?;
    file.read_time = start.elapsed();
    // The file is opened before the work, which would be lost if its name were wrong.
    let output = Output::open(streams, Some(&query_args.out))?;
    let (soup, objects) = (&file.scene.soup, &*file.scene.objects);
    let run = |index| AnswerRun {
        session: &session,
        args: query_args,
        output,
        format: out_format,
        objects,
        index,
        shards: None,
    };

    let start = Instant::now();
    #[cfg(feature = "cuda")]
    if args.device.is_some() {
        let source = session.pool.install(|| card::CardScene::new(soup, args)).with_context(|| scene_args.name())?;
        let run = run(IndexSummary::new(&file, "cuda", None, start.elapsed()));
        return Run { args, run, queries, ids, signs: None, soup: Some(soup) }.finish(&source);
    }
    let is_counted = !args.has_many_answers() && !args.has_only_inside() && args.accuracy.is_default();
    let chosen = match args.backend {
        // Only exact queries for one closest point are counted; others keep the tree.
        None if !is_counted => file.backend().into(),
        backend => {
            let max_bytes = args.max_memory.and_then(|bytes| usize::try_from(bytes).ok()).unwrap_or(usize::MAX);
            let workload = Workload::new(queries.len(), QueryRegion::Like(&sample))
                .with_needs_index(args.signed.is_some())
                .with_max_distance(args.max_distance.unwrap_or(f64::INFINITY))
                .with_max_bytes(max_bytes);
            file.choose(&session, backend, &workload)?
        }
    };
    if args.max_memory.is_some() && !chosen.is_counted() {
        return Err(usage(
            "--max-memory limits indexes in shards, which `p2m shard` writes, and those that auto chooses",
        ));
    }
    let prepared = file.prepare(&session, chosen.with_k(query_args.k)?.with_p2m(&args.p2m)?)?;
    let index = &*prepared.built.index;
    let build_time = start.elapsed();

    let signed = args.signed.map(|rule| rule.prepare_signed(streams, index, soup)).transpose();
    let signed = signed.with_context(|| scene_args.name())?;
    let signs = signed.as_ref().map(SignReport::new);
    let source = WholeIndex { index, signed: signed.as_ref(), args };
    let run = run(IndexSummary::new(&file, prepared.backend.name, Some(&prepared), build_time));
    Run { args, run, queries, ids, signs, soup: Some(soup) }.finish(&source)
}

/// Answers queries by an index in shards, which are loaded as queries need them.
fn run_in_shards(streams: &Streams, args: &Args, folder: &Path) -> anyhow::Result<()> {
    let query_args = &args.query_args;
    query_args.check(&args.scene, args.points.points.as_deref(), "points")?;
    let format = query_args.format(streams)?;
    args.check(format)?;
    #[cfg(feature = "cuda")]
    if args.device.is_some() {
        return Err(usage("--device is not for an index in shards"));
    }
    let has_options_of_builds = args.backend.is_some() || query_args.k.is_some() || !args.p2m.is_unspecified();
    refuse_options_of_builds(&args.scene, has_options_of_builds)?;
    refuse_other_signs(args)?;
    if args.has_normals() {
        return Err(usage("the column normal is not for an index in shards"));
    }
    let start = Instant::now();
    let index = open(folder, args.max_memory, args.scene.map)?;
    let signs =
        args.signed.map(|_| index.sign_rule().map(|rule| SignReport { rule: rule.name(), note: None })).transpose()?;
    let build_time = start.elapsed();
    let start = Instant::now();
    let PreparedQueries { queries, ids, .. } = queries(streams, args, &index.bounds())?;
    let read_time = start.elapsed();
    let output = Output::open(streams, Some(&query_args.out))?;
    let (session, objects) = (query_args.threads.start(streams)?, index.manifest().objects());
    let run = AnswerRun {
        session: &session,
        args: query_args,
        output,
        format,
        objects: &objects,
        index: summarize(args.scene.name(), &index, read_time, build_time),
        shards: Some((&index, args.max_memory)),
    };
    Run { args, run, queries, ids, signs, soup: None }.finish(&Shards { index: &index, args })
}

/// Refuses rules of signs that shards do not have: the surface decides theirs.
fn refuse_other_signs(args: &Args) -> anyhow::Result<()> {
    match args.signed {
        None | Some(SignRule::Auto) => Ok(()),
        Some(_) => Err(usage("--signed of an index in shards takes no rule: the surface decides it")),
    }
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
        if let Some(signed) = self.signed.filter(|_| self.args.has_only_inside()) {
            return Ok(only_inside(signed.contains_each(queries, &BatchOptions::default())));
        }
        let answers = self.args.accuracy.answer(self.index, queries, &self.args.options());
        let with_sign = |i: usize| {
            let answer = answers[i];
            let signed = self.signed.zip(answer);
            let signed = signed.and_then(|(signed, answer)| signed.with_sign(&queries[i], answer).distance());
            (answer, signed.unwrap_or(f64::NAN))
        };
        Ok(parallel::map(queries.len(), true, with_sign))
    }

    fn near(&self, queries: &[Point3<f64>]) -> anyhow::Result<Vec<Vec<Closest<f64>>>> {
        let near = |query: &Point3<f64>| match self.args.near() {
            (None, radius) => self.index.all_within(query, radius),
            (Some(k), radius) => self.index.k_nearest(query, k, radius),
        };
        Ok(answer_each(queries, near))
    }
}

/// An index in shards.
struct Shards<'a> {
    index: &'a ShardedIndex,
    args: &'a Args,
}

impl Source for Shards<'_> {
    const BLOCK_SIZE: BlockSize = BlockSize::OF_SHARDS;

    fn closest(&self, queries: &[Point3<f64>]) -> anyhow::Result<Vec<ClosestAnswer>> {
        let options = self.args.options();
        let batch = self.index.batch();
        if self.args.has_only_inside() {
            return Ok(only_inside(batch.contains(queries)?));
        }
        let answers = match self.args.accuracy.certified {
            true => batch.certified_closest_points(queries, &options)?,
            false => batch.closest_points(queries, &options)?,
        };
        if self.args.signed.is_none() {
            return Ok(answers.into_iter().map(|answer| (answer.map(in_scene), f64::NAN)).collect());
        }
        let are_inside = batch.contains(queries)?;
        let with_sign = |(answer, is_inside): (Option<ShardClosest>, bool)| {
            let distance = answer.map_or(f64::NAN, |answer| answer.closest.distance);
            // A point on the surface has the distance 0, which has no sign.
            (answer.map(in_scene), if is_inside && distance > 0.0 { -distance } else { distance })
        };
        Ok(answers.into_iter().zip(are_inside).map(with_sign).collect())
    }

    fn near(&self, queries: &[Point3<f64>]) -> anyhow::Result<Vec<Vec<Closest<f64>>>> {
        let (k, radius) = self.args.near();
        let near = self.index.batch().k_nearest(queries, k.unwrap_or(usize::MAX), radius)?;
        Ok(near.into_iter().map(|near| near.into_iter().map(in_scene).collect()).collect())
    }
}

/// Returns answers that have a side and no distance.
fn only_inside(are_inside: Vec<bool>) -> Vec<ClosestAnswer> {
    are_inside.into_iter().map(|is_inside| (None, if is_inside { -1.0 } else { 1.0 })).collect()
}

/// Returns an answer with the number of the primitive in the whole scene.
#[allow(clippy::cast_possible_truncation, reason = "a scene has at most 2^30 primitives here")]
fn in_scene(answer: ShardClosest) -> Closest<f64> {
    let mut closest = answer.closest;
    closest.primitive = PrimitiveId::new(answer.id as usize);
    closest
}
