//! Rounds of rays, contenders taking turns, in thread CPU time, and how their answers compare.

use super::backends::{all_trees, brute};
use super::caster::{Function, Index, Ours, Outcome, Rays};
use crate::contender::{Absent, catch};
use crate::measure::{Effort, rotated};
use crate::scene::Scene;
use anyhow::Result;
use cpu_time::ThreadTime;
use p2m_core::Ray;
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
    /// The largest difference of a parameter, relative to itself and the diagonal of the box.
    pub(crate) largest: f64,
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
                let difference = (outcome.parameter - expected.parameter).abs();
                let relative = difference / (expected.parameter.abs() + diagonal);
                self.other += usize::from(relative.is_nan() || relative > ROUNDING);
                self.largest = self.largest.max(relative);
            }
        }
    }
}

/// What a contender did.
#[derive(Clone, Debug, Default)]
pub(crate) struct Figures {
    /// Rays a round.
    pub(crate) rays: usize,
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
            (figures.rays, figures.hits) = (0, 0);
            figures.seconds.push(0.0);
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
    figures.rays += rays.len();
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
    Ok(verify_trees(&*brute(scene)?, &all_trees(scene)?, &rays.ours[..rays.len().min(COMPARED)]))
}

fn verify_trees(
    brute: &dyn Ours,
    trees: &[(String, Box<dyn Ours + '_>)],
    rays: &[Ray],
) -> std::result::Result<String, String> {
    let few = &rays[..rays.len().min(COMPARED_BRUTE)];
    let mut expected: Vec<_> = few.iter().map(|ray| brute.hits(ray)).collect();
    expected.extend(trees.first().iter().flat_map(|(_, tree)| rays[few.len()..].iter().map(|ray| tree.hits(ray))));
    for (name, tree) in trees {
        for (ray, expected) in rays.iter().zip(&expected) {
            let found = tree.hits(ray);
            if found != *expected {
                return Err(format!("{name} finds {found:?} for {ray:?}, expected were {expected:?}"));
            }
        }
    }
    Ok(format!(
        "First and all hits of {} rays are the same bits in {} trees, those of {} rays also by brute force.",
        rays.len(),
        trees.len(),
        few.len()
    ))
}

#[cfg(test)]
mod tests {
    use super::super::backends::ALL;
    use super::*;
    use crate::contender::Prepared;
    use nalgebra::Point3;
    use p2m_core::{BruteForce, Element, Hit, RayQuery, Soup};

    /// Right but for the parameters.
    struct Wrong<'a>(BruteForce<&'a Soup<f64>>);

    impl Wrong<'_> {
        fn moved(mut hit: Hit) -> Hit {
            hit.parameter = hit.parameter.next_up();
            hit
        }
    }

    impl Ours for Wrong<'_> {
        fn answer(&self, _: Function, rays: &Rays, outcomes: &mut [Outcome]) {
            for (ray, outcome) in rays.ours.iter().zip(outcomes) {
                *outcome = self.0.first_intersection(ray).map(Self::moved).map_or(Outcome::NONE, |hit| Outcome {
                    hits: 1,
                    parameter: hit.parameter,
                    id: hit.primitive.index(),
                });
            }
        }
        fn hits(&self, ray: &Ray) -> (Option<Hit>, Vec<Hit>) {
            (self.0.first_intersection(ray).map(Self::moved), self.0.all_intersections(ray))
        }
        fn work(&self, _: &[Ray]) -> [usize; 3] {
            [0; 3]
        }
    }

    fn scene(elements: &[Element]) -> Scene {
        let p = [[1.0, 0.0, 0.0], [2.0, 0.0, 1.0], [1.0, 3.0, 0.0], [5.0, 1.0, 2.0]].map(Point3::from).to_vec();
        Scene::new("test".into(), Soup::new(p, elements.iter().copied()).unwrap()).unwrap()
    }

    const TRIANGLES: [Element; 2] = [Element::Triangle([0, 1, 2]), Element::Triangle([1, 2, 3])];
    const EFFORT: Effort = Effort { rounds: 2, queries: 1000, builds: 1, seed: 1 };

    #[test]
    fn each_kind_of_difference_is_counted_as_such() {
        let hit = |parameter| Outcome { hits: 1, parameter, id: 3 };
        let differences = |exact, pairs: &[[Outcome; 2]]| {
            let mut sum = Differences::default();
            pairs.iter().for_each(|[outcome, expected]| sum.add(outcome, expected, exact, 1.0));
            sum
        };
        let pairs = [
            [Outcome::NONE, hit(1.0)],
            [hit(1.0), Outcome::NONE],
            [Outcome::NONE; 2],
            [hit(3.0), hit(3.0)],
            [hit(3.0_f64.next_up()), hit(3.0)],
            [hit(4.0), hit(3.0)],
            [Outcome { hits: 2, ..hit(3.0) }, hit(3.0)],
            [Outcome { id: 4, ..hit(3.0) }, hit(3.0)],
        ];
        let clean = Differences { compared: 8, missed: 1, added: 1, other: 4, largest: 0.0 };
        assert_eq!(differences(true, &pairs), clean);
        assert_eq!(differences(false, &pairs), Differences { other: 1, largest: 0.25, ..clean });
        assert!(differences(true, &pairs[2..4]).is_clean() && !differences(true, &pairs[..1]).is_clean());
    }

    #[test]
    fn parts_are_all_rays_and_different_ones() {
        let scene = scene(&TRIANGLES);
        let effort = Effort { queries: 2 * PART + 10, ..EFFORT };
        let parts: Vec<_> = parts(&scene, QuerySet::Box1, &effort).collect();
        assert_eq!(parts.iter().map(Rays::len).collect::<Vec<_>>(), [PART, PART, 10]);
        assert_ne!(parts[0].ours[..10], parts[1].ours[..10]);
        assert_eq!(first_part(&scene, QuerySet::Box1, &effort).ours, parts[0].ours);
    }

    /// All contenders over a scene of these elements, asked for the first hit; those that are absent are left out.
    fn measured(elements: &[Element], check: impl Fn(&str, bool, &Figures)) {
        let scene = scene(elements);
        let built = |backend: &super::super::caster::Backend| {
            let Prepared { build, .. } = (backend.prepare)(&scene).ok()?;
            Some((backend.name, build().unwrap()))
        };
        let indexes: Vec<_> = ALL.iter().filter_map(built).collect();
        let contenders: Vec<_> =
            indexes.iter().map(|(_, index)| Contender { index, function: Function::First }).collect();
        let figures = measure(&scene, QuerySet::Box1, &contenders, &EFFORT);
        for ((name, index), figures) in indexes.iter().zip(&figures) {
            check(name, matches!(index, Index::Ours(_)), figures);
        }
    }

    #[test]
    fn all_agree_over_triangles() {
        measured(&TRIANGLES, |name, ours, figures| {
            assert!(figures.failure.is_none() && figures.differences.is_clean(), "{name} {figures:?}");
            assert_eq!((figures.rays, figures.seconds.len(), figures.differences.compared), (1000, 2, 2000), "{name}");
            assert_eq!(figures.checksums[0], figures.checksums[1], "{name}");
            assert!(figures.hits > 50, "{name}");
            assert_eq!(figures.differences.largest > 0.0, !ours, "{name}");
        });
    }

    #[test]
    fn rivals_are_absent_where_there_is_more() {
        measured(&[TRIANGLES[0], Element::Segment([2, 3])], |name, ours, figures| {
            assert!(ours && figures.differences.is_clean(), "{name}");
        });
    }

    #[test]
    fn all_functions_agree_and_a_wrong_index_does_not() {
        let scene = scene(&TRIANGLES);
        let wrong = || Wrong(BruteForce::new(&scene.double).unwrap());
        let indexes = [
            Index::Ours(brute(&scene).unwrap()),
            Index::Ours(all_trees(&scene).unwrap().remove(0).1),
            Index::Ours(Box::new(wrong())),
        ];
        for function in Function::ALL {
            let contenders: Vec<_> = indexes.iter().map(|index| Contender { index, function }).collect();
            let figures = measure(&scene, QuerySet::Box1, &contenders, &EFFORT);
            assert!(figures[..2].iter().all(|figures| figures.differences.is_clean()), "{function:?}");
            assert!(!figures[2].differences.is_clean(), "{function:?}");
        }
        let rays = first_part(&scene, QuerySet::Box1, &EFFORT);
        assert!(verify(&scene, &rays).unwrap().is_ok());
        let trees: [(String, Box<dyn Ours + '_>); 1] = [("wrong".into(), Box::new(wrong()))];
        assert!(verify_trees(&*brute(&scene).unwrap(), &trees, &rays.ours).is_err());
    }
}
