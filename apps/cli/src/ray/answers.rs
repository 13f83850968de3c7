//! The loop that answers rays and writes their hits or counts, whichever index they are asked of.

use crate::answers::blocks::{Steps, answer_all};
use crate::answers::table::{AnswerFormat, HitEncoder, NumberEncoder, Table};
use crate::io::output::Output;
use crate::io::streams::Streams;
use crate::ray::args::{Mode, Rays};
use crate::ray::summary::RaySummary;
use p2m_core::{Hit, Ray, RayQuery};
use p2m_mixed::Object;
use rayon::ThreadPool;
use rayon::prelude::*;
use std::time::Duration;

/// A source of hits: an index in memory or one in shards.
pub(crate) trait RaySource: Sync {
    /// Returns whether a ray hits anything.
    fn do_intersect(&self, ray: &Ray) -> anyhow::Result<bool>;

    /// Returns some hit.
    fn any_intersection(&self, ray: &Ray) -> anyhow::Result<Option<Hit>>;

    /// Returns the hit with the least parameter.
    fn first_intersection(&self, ray: &Ray) -> anyhow::Result<Option<Hit>>;

    /// Returns all hits, by parameter and then by primitive.
    fn all_intersections(&self, ray: &Ray) -> anyhow::Result<Vec<Hit>>;

    /// Returns the number of hits.
    fn count(&self, ray: &Ray) -> anyhow::Result<usize>;

    /// Returns the number of crossings of the surface of the triangles.
    fn crossings(&self, ray: &Ray) -> anyhow::Result<usize>;
}

/// An index over the whole scene.
pub(crate) struct WholeIndex<'a>(pub(crate) &'a (dyn RayQuery<f64> + Sync));

impl RaySource for WholeIndex<'_> {
    fn do_intersect(&self, ray: &Ray) -> anyhow::Result<bool> {
        Ok(self.0.do_intersect(ray))
    }

    fn any_intersection(&self, ray: &Ray) -> anyhow::Result<Option<Hit>> {
        Ok(self.0.any_intersection(ray))
    }

    fn first_intersection(&self, ray: &Ray) -> anyhow::Result<Option<Hit>> {
        Ok(self.0.first_intersection(ray))
    }

    fn all_intersections(&self, ray: &Ray) -> anyhow::Result<Vec<Hit>> {
        Ok(self.0.all_intersections(ray))
    }

    fn count(&self, ray: &Ray) -> anyhow::Result<usize> {
        Ok(self.0.count(ray))
    }

    fn crossings(&self, ray: &Ray) -> anyhow::Result<usize> {
        Ok(self.0.crossings(ray))
    }
}

/// The rays to answer, and the file for their answers.
pub(crate) struct Task<'a, 's> {
    pub(crate) streams: &'a Streams,
    pub(crate) pool: &'a ThreadPool,
    pub(crate) rays: Rays<'a>,
    pub(crate) output: &'a mut Output<'s>,
    pub(crate) format: AnswerFormat,
    pub(crate) objects: &'a [Object],
}

impl Task<'_, '_> {
    /// Answers all rays and writes the answers. Returns the time that answering took, and a summary.
    pub(crate) fn run<S: RaySource>(self, source: &S, mode: Mode) -> anyhow::Result<(Duration, RaySummary)> {
        let (hits, one_each) = (RaySummary::with_counts("hits"), Some(self.rays.count));
        match mode {
            Mode::Intersects => {
                self.counts("hit", RaySummary::default(), |ray| Ok(u64::from(source.do_intersect(ray)?)))
            }
            Mode::Count => self.counts("count", hits, |ray| Ok(source.count(ray)? as u64)),
            Mode::Crossings => {
                let crossed = RaySummary::with_counts("crossed");
                self.counts("crossings", crossed, |ray| Ok(source.crossings(ray)? as u64))
            }
            Mode::Any => {
                self.hits(one_each, RaySummary::default(), |ray| source.any_intersection(ray), Option::as_slice)
            }
            Mode::First => {
                self.hits(one_each, RaySummary::default(), |ray| source.first_intersection(ray), Option::as_slice)
            }
            Mode::All => self.hits(None, hits, |ray| source.all_intersections(ray), Vec::as_slice),
        }
    }

    /// Writes a count for each ray.
    fn counts(
        self,
        name: &'static str,
        mut summary: RaySummary,
        count: impl Fn(&Ray) -> anyhow::Result<u64> + Sync,
    ) -> anyhow::Result<(Duration, RaySummary)> {
        let cannot_write = self.output.cannot_write();
        let failed = |error| anyhow::Error::new(error).context(cannot_write.clone());
        let encoder = NumberEncoder::new(self.format, name);
        let mut table = Table::new(self.output, encoder.header(), Some(self.rays.count)).map_err(failed)?;
        let steps = Steps {
            answer: |rays: &[_]| rays.par_iter().map(&count).collect(),
            encode: |number, ray: &_, count: &u64, out: &mut _| {
                encoder.encode(number, ray, *count, out);
                1
            },
            take: |_: &_, count: &u64| summary.add(*count),
            write: |count, records: &[u8]| table.write(count, records).map_err(failed),
        };
        let time = answer_all(self.streams, self.pool, self.rays, steps)?;
        table.finish().map_err(failed)?;
        Ok((time, summary))
    }

    /// Writes the hits of each ray, which `slice` takes from its answer. `records` is the number of records if each ray
    /// has exactly one; otherwise each hit has one.
    fn hits<A: Send + Sync>(
        self,
        records: Option<u64>,
        mut summary: RaySummary,
        intersect: impl Fn(&Ray) -> anyhow::Result<A> + Sync,
        slice: fn(&A) -> &[Hit],
    ) -> anyhow::Result<(Duration, RaySummary)> {
        let cannot_write = self.output.cannot_write();
        let failed = |error| anyhow::Error::new(error).context(cannot_write.clone());
        let encoder = HitEncoder::new(self.format, self.objects);
        let mut table = Table::new(self.output, encoder.header(), records).map_err(failed)?;
        let steps = Steps {
            answer: |rays: &[_]| rays.par_iter().map(&intersect).collect(),
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
            write: |count, records: &[u8]| table.write(count, records).map_err(failed),
        };
        let time = answer_all(self.streams, self.pool, self.rays, steps)?;
        table.finish().map_err(failed)?;
        Ok((time, summary))
    }
}
