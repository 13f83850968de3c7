//! Times rounds of rays in thread CPU time, with the backends taking turns to begin, and compares the answers.

use super::backend::{OurCaster, Outcome, RayIndex, Rays};
use super::backends::{all_trees, brute};
use crate::backend::{Unavailable, catch};
use crate::measure::Effort;
use crate::rounds::{checksum, rotated, time_answers};
use crate::scene::Scene;
use anyhow::Result;
use p2m_core::Ray;
use p2m_testkit::queries::QuerySet;

/// Rays are generated and answered in chunks of this size, each from its own seed, so that millions need not be kept.
const RAYS_PER_CHUNK: usize = 100_000;

/// The number of rays that are compared to the last bit with every instruction set.
const MAX_COMPARED: usize = 10_000;
/// The number of rays that are compared to the last bit with brute force.
const MAX_COMPARED_WITH_BRUTE: usize = 200;

/// The largest difference of parameters that rounding of the input to f32 explains, relative to the parameter and the
/// diagonal of the box: a thousand units of the last place.
pub(crate) const ROUNDING: f64 = 1000.0 / (1u32 << 24) as f64;

/// The differences between the answers of a competitor and those of our first competitor.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Differences {
    /// The number of rays that were compared.
    pub(crate) compared: usize,
    /// The number of rays for which only the reference found a hit.
    pub(crate) missed: usize,
    /// The number of rays for which only this competitor found a hit.
    pub(crate) added: usize,
    /// The number of rays with other hits: in any bit for our indexes, by more than rounding for external libraries.
    pub(crate) other: usize,
    /// The largest difference of a parameter, relative to the parameter and the diagonal of the box.
    pub(crate) largest: f64,
}

impl Differences {
    /// Returns whether there are no differences.
    pub(crate) fn is_clean(&self) -> bool {
        self.missed + self.added + self.other == 0
    }

    fn add(&mut self, outcome: &Outcome, expected: &Outcome, exact: bool, diagonal: f64) {
        self.compared += 1;
        match (outcome.is_hit, expected.is_hit) {
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

/// The measurements of a competitor.
#[derive(Clone, Debug, Default)]
pub(crate) struct Figures {
    /// The number of rays in a round.
    pub(crate) rays: usize,
    /// Thread CPU seconds for all rays, one value for each round.
    pub(crate) seconds: Vec<f64>,
    /// A checksum of the answers, one value for each round.
    pub(crate) checksums: Vec<u64>,
    /// The number of hits in a round.
    pub(crate) hits: usize,
    /// The differences over all rounds.
    pub(crate) differences: Differences,
    /// The reason why the competitor stopped early.
    pub(crate) failure: Option<Unavailable>,
}

/// Returns the rays of each chunk.
fn chunks(scene: &Scene, set: QuerySet, effort: &Effort) -> impl Iterator<Item = Rays> {
    let Effort { queries, seed, .. } = *effort;
    (0..queries.div_ceil(RAYS_PER_CHUNK).max(1)).map(move |chunk| {
        let count = RAYS_PER_CHUNK.min(queries - chunk * RAYS_PER_CHUNK);
        Rays::new(set.rays(&scene.double, count, seed.wrapping_add(chunk as u64)))
    })
}

/// Returns the rays of the first chunk.
pub(crate) fn first_chunk(scene: &Scene, set: QuerySet, effort: &Effort) -> Rays {
    chunks(scene, set, effort).next().expect("at least one")
}

/// Measures the first hits of all competitors, which take turns to begin a chunk.
pub(crate) fn measure(scene: &Scene, set: QuerySet, indexes: &[&RayIndex<'_>], effort: &Effort) -> Vec<Figures> {
    let mut all = vec![Figures::default(); indexes.len()];
    for round in 0..effort.rounds {
        for figures in &mut all {
            (figures.rays, figures.hits) = (0, 0);
            figures.seconds.push(0.0);
            figures.checksums.push(0);
        }
        for (chunk, rays) in chunks(scene, set, effort).enumerate() {
            let mut outcomes = vec![Vec::new(); indexes.len()];
            for at in rotated(indexes.len(), round + chunk) {
                if all[at].failure.is_none() {
                    outcomes[at] = answer_chunk(indexes[at], &rays, &mut all[at]);
                }
            }
            compare(scene, indexes, &outcomes, &mut all);
        }
    }
    all
}

/// Lets one competitor answer a chunk, and adds the cost to its last round.
fn answer_chunk(index: &RayIndex<'_>, rays: &Rays, figures: &mut Figures) -> Vec<Outcome> {
    let mut outcomes = vec![Outcome::NONE; rays.len()];
    let answer = |rays: &Rays, outcomes: &mut [Outcome]| {
        catch(|| {
            match index {
                RayIndex::Ours(index) => index.first(rays, outcomes),
                RayIndex::External(index) => index.first(rays, outcomes),
            }
            Ok(())
        })
    };
    let outcome = time_answers(rays, &mut outcomes, answer);
    if let (Ok(seconds), Some(sum)) = (&outcome, figures.seconds.last_mut()) {
        *sum += seconds;
    }
    figures.failure = outcome.err();
    figures.rays += rays.len();
    figures.hits += outcomes.iter().filter(|outcome| outcome.is_hit).count();
    let answers = outcomes.iter().map(|o| (o.parameter.to_bits() ^ u64::from(o.is_hit), o.id as u64));
    if let Some(sum) = figures.checksums.last_mut() {
        *sum = checksum(*sum, answers);
    }
    outcomes
}

fn compare(scene: &Scene, indexes: &[&RayIndex<'_>], outcomes: &[Vec<Outcome>], all: &mut [Figures]) {
    let is_ours = |index: &RayIndex<'_>| matches!(index, RayIndex::Ours(_));
    let diagonal = scene.diagonal();
    let Some(expected) = indexes.iter().position(|index| is_ours(index)) else { return };
    for ((index, own_outcomes), figures) in indexes.iter().zip(outcomes).zip(all) {
        for (outcome, expected) in own_outcomes.iter().zip(&outcomes[expected]) {
            figures.differences.add(outcome, expected, is_ours(index), diagonal);
        }
    }
}

/// Compares the first hit and all hits of every tree with every instruction set to the last bit, on a sample of the
/// rays. Returns how many rays were compared, or names a tree and a ray that differ.
pub(crate) fn verify(scene: &Scene, rays: &Rays) -> Result<std::result::Result<String, String>> {
    Ok(verify_trees(&*brute(scene)?, &all_trees(scene)?, &rays.ours[..rays.len().min(MAX_COMPARED)]))
}

fn verify_trees(
    brute: &dyn OurCaster,
    trees: &[(String, Box<dyn OurCaster + '_>)],
    rays: &[Ray],
) -> std::result::Result<String, String> {
    let sample = &rays[..rays.len().min(MAX_COMPARED_WITH_BRUTE)];
    let mut expected: Vec<_> = sample.iter().map(|ray| brute.hits(ray)).collect();
    expected.extend(trees.first().iter().flat_map(|(_, tree)| rays[sample.len()..].iter().map(|ray| tree.hits(ray))));
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
        sample.len()
    ))
}

#[cfg(test)]
mod tests {
    use super::super::backends::ALL;
    use super::*;
    use crate::backend::Prepared;
    use nalgebra::Point3;
    use p2m_core::{BruteForce, Element, Hit, RayQuery, Soup};

    /// An index whose answers are right apart from the parameters.
    struct Wrong<'a>(BruteForce<&'a Soup<f64>>);

    impl Wrong<'_> {
        fn moved(mut hit: Hit) -> Hit {
            hit.parameter = hit.parameter.next_up();
            hit
        }
    }

    impl OurCaster for Wrong<'_> {
        fn first(&self, rays: &Rays, outcomes: &mut [Outcome]) {
            for (ray, outcome) in rays.ours.iter().zip(outcomes) {
                let hit = self.0.first_intersection(ray).map(Self::moved);
                *outcome = hit.map_or(Outcome::NONE, |hit| Outcome::hit(hit.parameter, hit.primitive.index()));
            }
        }
        fn hits(&self, ray: &Ray) -> (Option<Hit>, Vec<Hit>) {
            (self.0.first_intersection(ray).map(Self::moved), self.0.all_intersections(ray))
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
        let hit = |parameter| Outcome::hit(parameter, 3);
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
            [Outcome { id: 4, ..hit(3.0) }, hit(3.0)],
        ];
        let clean = Differences { compared: 7, missed: 1, added: 1, other: 3, largest: 0.0 };
        assert_eq!(differences(true, &pairs), clean);
        assert_eq!(differences(false, &pairs), Differences { other: 1, largest: 0.25, ..clean });
        assert!(differences(true, &pairs[2..4]).is_clean() && !differences(true, &pairs[..1]).is_clean());
    }

    #[test]
    fn chunks_are_all_rays_and_different_ones() {
        let scene = scene(&TRIANGLES);
        let effort = Effort { queries: 2 * RAYS_PER_CHUNK + 10, ..EFFORT };
        let chunks: Vec<_> = chunks(&scene, QuerySet::Box1, &effort).collect();
        assert_eq!(chunks.iter().map(Rays::len).collect::<Vec<_>>(), [RAYS_PER_CHUNK, RAYS_PER_CHUNK, 10]);
        assert_ne!(chunks[0].ours[..10], chunks[1].ours[..10]);
        assert_eq!(first_chunk(&scene, QuerySet::Box1, &effort).ours, chunks[0].ours);
    }

    /// Measures the first hit of all backends over a scene of these elements; absent backends are left out.
    fn measured(elements: &[Element], check: impl Fn(&str, bool, &Figures)) {
        let scene = scene(elements);
        let built = |backend: &super::super::backend::RayBackend| {
            let Prepared { build, .. } = (backend.prepare)(&scene).ok()?;
            Some((backend.name, build().unwrap()))
        };
        let indexes: Vec<_> = ALL.iter().filter_map(built).collect();
        let figures =
            measure(&scene, QuerySet::Box1, &indexes.iter().map(|(_, index)| index).collect::<Vec<_>>(), &EFFORT);
        for ((name, index), figures) in indexes.iter().zip(&figures) {
            check(name, matches!(index, RayIndex::Ours(_)), figures);
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
    fn libraries_are_absent_where_there_is_more() {
        measured(&[TRIANGLES[0], Element::Segment([2, 3])], |name, ours, figures| {
            assert!(ours && figures.differences.is_clean(), "{name}");
        });
    }

    #[test]
    fn right_indexes_agree_and_a_wrong_one_does_not() {
        let scene = scene(&TRIANGLES);
        let wrong = || Wrong(BruteForce::new(&*scene.double).unwrap());
        let indexes = [
            RayIndex::Ours(brute(&scene).unwrap()),
            RayIndex::Ours(all_trees(&scene).unwrap().remove(0).1),
            RayIndex::Ours(Box::new(wrong())),
        ];
        let figures = measure(&scene, QuerySet::Box1, &indexes.each_ref(), &EFFORT);
        assert!(figures[..2].iter().all(|figures| figures.differences.is_clean()));
        assert!(!figures[2].differences.is_clean());
        let rays = first_chunk(&scene, QuerySet::Box1, &EFFORT);
        assert!(verify(&scene, &rays).unwrap().is_ok());
        let trees: [(String, Box<dyn OurCaster + '_>); 1] = [("wrong".into(), Box::new(wrong()))];
        assert!(verify_trees(&*brute(&scene).unwrap(), &trees, &rays.ours).is_err());
    }
}
