//! The loop that answers rays and writes their hits or counts, whichever index they are asked of.

use crate::answers::{AnswerRun, HitEncoder, NumberEncoder, Steps, answer_all};
use crate::ray::args::{Args, Mode, Rays};
use crate::ray::summary::RaySummary;
use p2m_core::engine::parallel;
use p2m_core::{Hit, PrimitiveId, Ray, RayQuery};
use p2m_shards::{ShardBatch, ShardError, ShardHit, ShardedIndex};
use std::time::Duration;

/// A source of hits: an index in memory or one in shards.
#[derive(Clone, Copy)]
pub(crate) enum RaySource<'a> {
    Whole(&'a (dyn RayQuery<f64> + Sync)),
    Shards(&'a ShardedIndex),
}

impl<'a> RaySource<'a> {
    /// Answers rays on all threads of the current pool, by a function of an index and a ray, or by one of shards and
    /// all rays, whose answers are converted.
    fn ask<A: Send, B>(
        self,
        rays: &[Ray],
        whole: impl Fn(&dyn RayQuery<f64>, &Ray) -> A + Sync,
        shards: impl Fn(ShardBatch<'a>, &[Ray]) -> Result<Vec<B>, ShardError>,
        convert: impl Fn(B) -> A,
    ) -> anyhow::Result<Vec<A>> {
        match self {
            Self::Whole(index) => Ok(parallel::map_slice(rays, true, |ray| whole(index, ray))),
            Self::Shards(index) => Ok(shards(index.batch(), rays)?.into_iter().map(convert).collect()),
        }
    }
}

/// Returns a hit with the number of the primitive in the whole scene.
#[allow(clippy::cast_possible_truncation, reason = "a scene has at most 2^30 primitives here")]
fn in_scene(hit: ShardHit) -> Hit {
    let mut in_scene = hit.hit;
    in_scene.primitive = PrimitiveId::new(hit.id as usize);
    in_scene
}

/// A run that answers rays.
pub(crate) struct Run<'a> {
    pub(crate) args: &'a Args,
    pub(crate) run: AnswerRun<'a>,
    pub(crate) rays: Rays<'a>,
}

impl Run<'_> {
    /// Answers all rays, writes the answers, and prints a summary.
    pub(crate) fn finish(mut self, source: RaySource<'_>) -> anyhow::Result<()> {
        let (query_time, summary) = self.answer(source)?;
        let report = self.args.report(summary.json());
        self.run.finish(["ray", "rays", "ray"], summary.rays, query_time, report, &summary.to_string())
    }

    /// Answers all rays and writes the answers. Returns the time that answering took, and a summary.
    fn answer(&mut self, source: RaySource<'_>) -> anyhow::Result<(Duration, RaySummary)> {
        let (hits, one_each) = (RaySummary::with_counts("hits"), Some(self.rays.count));
        let mode = self.args.mode;
        match mode {
            Mode::Intersects => self.counts("hit", RaySummary::default(), |rays| {
                source.ask(rays, |index, ray| index.do_intersect(ray).into(), ShardBatch::do_intersect, u64::from)
            }),
            Mode::Count => self.counts("count", hits, |rays| {
                source.ask(rays, |index, ray| index.count(ray) as u64, ShardBatch::count, |count| count as u64)
            }),
            Mode::Crossings => self.counts("crossings", RaySummary::with_counts("crossed"), |rays| {
                source.ask(rays, |index, ray| index.crossings(ray) as u64, ShardBatch::crossings, |count| count as u64)
            }),
            Mode::Any | Mode::First => {
                let hit = |index: &dyn RayQuery<f64>, ray: &_| match mode {
                    Mode::Any => index.any_intersection(ray),
                    _ => index.first_intersection(ray),
                };
                let hits = |rays: &[_]| source.ask(rays, hit, ShardBatch::first_intersections, |hit| hit.map(in_scene));
                self.hits(one_each, RaySummary::default(), hits, Option::as_slice)
            }
            Mode::All => {
                let all = |index: &dyn RayQuery<f64>, ray: &_| index.all_intersections(ray);
                let in_scene = |hits: Vec<_>| hits.into_iter().map(in_scene).collect();
                let all = |rays: &[_]| source.ask(rays, all, ShardBatch::all_intersections, in_scene);
                self.hits(None, hits, all, Vec::as_slice)
            }
        }
    }

    /// Writes a count for each ray.
    fn counts(
        &mut self,
        name: &'static str,
        mut summary: RaySummary,
        count: impl Fn(&[Ray]) -> anyhow::Result<Vec<u64>> + Sync,
    ) -> anyhow::Result<(Duration, RaySummary)> {
        let encoder = NumberEncoder::new(self.run.format, name);
        let steps = Steps {
            answer: count,
            encode: |number, ray: &_, count: &u64, out: &mut _| {
                encoder.encode(number, ray, *count, out);
                1
            },
            take: |_: &_, count: &u64| summary.add(*count),
        };
        let file = (&mut self.run.output, encoder.header(), Some(self.rays.count));
        Ok((answer_all(self.run.session, &mut self.rays, Some(file), steps)?, summary))
    }

    /// Writes the hits of each ray, which `slice` takes from its answer. `records` is the number of records if each ray
    /// has exactly one; otherwise each hit has one.
    fn hits<A: Send + Sync>(
        &mut self,
        records: Option<u64>,
        mut summary: RaySummary,
        intersect: impl Fn(&[Ray]) -> anyhow::Result<Vec<A>> + Sync,
        slice: fn(&A) -> &[Hit],
    ) -> anyhow::Result<(Duration, RaySummary)> {
        let encoder = HitEncoder::new(self.run.format, self.run.objects);
        let steps = Steps {
            answer: intersect,
            encode: |number, ray: &_, answer: &A, out: &mut _| {
                let hits = slice(answer);
                if hits.is_empty() && records.is_some() {
                    encoder.encode(number, ray, None, out);
                    return 1;
                }
                hits.iter().for_each(|hit| encoder.encode(number, ray, Some(hit), out));
                hits.len() as u64
            },
            take: |_: &_, answer: &A| summary.add_hits(slice(answer)),
        };
        let file = (&mut self.run.output, encoder.header(), records);
        Ok((answer_all(self.run.session, &mut self.rays, Some(file), steps)?, summary))
    }
}
