//! Rounds of rays, contenders taking turns, in thread CPU time, and how their answers compare.

use super::backends::{all_trees, brute};
use super::caster::{Function, Index, Outcome, Rays};
use crate::contender::{Absent, catch};
use crate::measure::{Effort, rotated};
use crate::scene::Scene;
use anyhow::Result;
use cpu_time::ThreadTime;
use p2m_testkit::queries::QuerySet;
use std::hint::black_box;

/// Rays are drawn and answered in parts of so many, each from a seed of its own: millions need not be kept.
const PART: usize = 100_000;

/// So many rays are compared to the last bit with every instruction set,
const COMPARED: usize = 10_000;
/// and so many with brute force.
const COMPARED_BRUTE: usize = 200;

/// What of a parameter is rounding where input is, in f32, relative to the parameter and the diagonal of the box: a
/// thousand units of the last place.
pub(crate) const ROUNDING: f64 = 1000.0 / (1u32 << 24) as f64;

/// Somebody who is asked something.
pub(crate) struct Contender<'a> {
    /// Who.
    pub(crate) index: &'a Index<'a>,
    /// What.
    pub(crate) function: Function,
}

/// How the answers of a contender differ from those of the first one of ours that was asked the same.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Differences {
    /// Rays compared.
    pub(crate) compared: usize,
    /// Rays of which only the other one found a hit.
    pub(crate) missed: usize,
    /// Rays of which only this one did.
    pub(crate) added: usize,
    /// Ours: other hits than the other one, in whatever bit. Rivals: parameters that differ by more than rounding.
    pub(crate) other: usize,
}

impl Differences {
    /// Whether there are none.
    pub(crate) fn is_clean(&self) -> bool {
        self.missed + self.added + self.other == 0
    }

    fn add(&mut self, outcome: &Outcome, expected: &Outcome, exact: bool, diagonal: f64) {
        self.compared += 1;
        match (outcome.hits > 0, expected.hits > 0) {
            (false, true) => self.missed += 1,
            (true, false) => self.added += 1,
            (false, false) => {}
            (true, true) if exact => self.other += usize::from(!outcome.is_same(expected)),
            (true, true) => {
                let room = ROUNDING * (expected.parameter.abs() + diagonal);
                self.other += usize::from((outcome.parameter - expected.parameter).abs() > room);
            }
        }
    }
}

/// What a contender did.
#[derive(Clone, Debug, Default)]
pub(crate) struct Figures {
    /// Thread CPU seconds for all rays, of each round.
    pub(crate) seconds: Vec<f64>,
    /// Checksum of the answers of each round.
    pub(crate) checksums: Vec<u64>,
    /// Hits of a round.
    pub(crate) hits: usize,
    /// Over all rounds.
    pub(crate) differences: Differences,
    /// Why it did not go on.
    pub(crate) failure: Option<Absent>,
}

/// The rays of each part.
fn parts(scene: &Scene, set: QuerySet, effort: &Effort) -> impl Iterator<Item = Rays> {
    let Effort { queries, seed, .. } = *effort;
    (0..queries.div_ceil(PART).max(1)).map(move |part| {
        let count = PART.min(queries - part * PART);
        Rays::new(set.rays(&scene.double, count, seed.wrapping_add(part as u64)))
    })
}

/// The rays of the first part.
pub(crate) fn first_part(scene: &Scene, set: QuerySet, effort: &Effort) -> Rays {
    parts(scene, set, effort).next().expect("at least one")
}

/// Asks all contenders, who begin a part in turn.
pub(crate) fn measure(scene: &Scene, set: QuerySet, contenders: &[Contender<'_>], effort: &Effort) -> Vec<Figures> {
    let mut all = vec![Figures::default(); contenders.len()];
    for round in 0..effort.rounds {
        for figures in &mut all {
            (figures.hits, _) = (0, figures.seconds.push(0.0));
            figures.checksums.push(0);
        }
        for (part, rays) in parts(scene, set, effort).enumerate() {
            let mut outcomes = vec![Vec::new(); contenders.len()];
            for at in rotated(contenders.len(), round + part) {
                if all[at].failure.is_none() {
                    outcomes[at] = ask(&contenders[at], &rays, &mut all[at]);
                }
            }
            compare(scene, contenders, &outcomes, &mut all);
        }
    }
    all
}

/// Asks one of them and adds to its last round.
fn ask(contender: &Contender<'_>, rays: &Rays, figures: &mut Figures) -> Vec<Outcome> {
    let mut outcomes = vec![Outcome::NONE; rays.len()];
    let start = ThreadTime::now();
    let end = catch(|| {
        match contender.index {
            Index::Ours(index) => index.answer(contender.function, black_box(rays), &mut outcomes),
            Index::Rival(index) => index.first(black_box(rays), &mut outcomes),
        }
        Ok(())
    });
    let elapsed = start.elapsed().as_secs_f64();
    black_box(&outcomes);
    figures.failure = end.err();
    figures.hits += outcomes.iter().map(|outcome| outcome.hits).sum::<usize>();
    if let (Some(seconds), Some(sum)) = (figures.seconds.last_mut(), figures.checksums.last_mut()) {
        *seconds += elapsed;
        *sum = outcomes.iter().fold(*sum, |sum, outcome| {
            let bits = outcome.parameter.to_bits() ^ outcome.hits as u64;
            (sum ^ bits).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(23) ^ outcome.id as u64
        });
    }
    outcomes
}

fn compare(scene: &Scene, contenders: &[Contender<'_>], outcomes: &[Vec<Outcome>], all: &mut [Figures]) {
    let is_ours = |contender: &Contender<'_>| matches!(contender.index, Index::Ours(_));
    let diagonal = scene.diagonal();
    for ((contender, own), figures) in contenders.iter().zip(outcomes).zip(all) {
        let same = |(other, _): &(&Contender<'_>, _)| is_ours(other) && other.function == contender.function;
        if let Some((_, expected)) = contenders.iter().zip(outcomes).find(same) {
            for (outcome, expected) in own.iter().zip(expected) {
                figures.differences.add(outcome, expected, is_ours(contender), diagonal);
            }
        }
    }
}

/// Compares first and all hits of every tree with every instruction set to the last bit, on some of the rays; says how
/// many rays were compared, or names a tree and a ray that differ.
pub(crate) fn verify(scene: &Scene, rays: &Rays) -> Result<std::result::Result<String, String>> {
    let rays = &rays.ours[..rays.len().min(COMPARED)];
    let few = &rays[..rays.len().min(COMPARED_BRUTE)];
    let (brute, trees) = (brute(scene)?, all_trees(scene)?);
    let mut expected: Vec<_> = few.iter().map(|ray| brute.hits(ray)).collect();
    expected.extend(trees.first().iter().flat_map(|(_, tree)| rays[few.len()..].iter().map(|ray| tree.hits(ray))));
    for (name, tree) in &trees {
        for (ray, expected) in rays.iter().zip(&expected) {
            let found = tree.hits(ray);
            if found != *expected {
                return Ok(Err(format!("{name} finds {found:?} for {ray:?}, expected were {expected:?}")));
            }
        }
    }
    Ok(Ok(format!(
        "First and all hits of {} rays are the same bits in {} trees, those of {} rays also by brute force.",
        rays.len(),
        trees.len(),
        few.len()
    )))
}
