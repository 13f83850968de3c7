//! What takes part: our backends, and rivals.

use crate::backends::{aabb_options, octree_options, p2m_options};
use crate::bvh_crate;
use crate::contender::{Absent, Contender, Prepared, Scalar, catch};
use crate::measure::{BuildFigures, weigh};
use crate::memory;
use crate::rivals;
use crate::scene::Scene;
use nalgebra::Point3;
use p2m_bvh::AabbTree;
use p2m_core::batch::{BatchOptions, closest_points_into};
use p2m_core::{BruteForce, BuildIndex, CertifiedQuery, ClosestPoint, QueryOptions, Soup};
use p2m_interception::{OctreeIndex, P2mIndex};
use p2m_kdop::{KdopOptions, KdopTree};
use p2m_tradeoff::queries::QuerySlice;
use p2m_tradeoff::settings::{Ask, DEFAULT, Promise, SETTINGS, Setting};
use p2m_tradeoff::{Answer, Asked, AskedForProof, Build, Entrant, Respond, Spread, Subject};
use std::time::Instant;

/// Building again stops after so many seconds.
const BUILD_SECONDS: f64 = 10.0;

/// An index that was built.
pub(super) trait Built: Sync {
    /// What answers as a setting asks.
    fn subject(&self, setting: &Setting) -> Box<dyn Subject + '_>;
    /// Wall seconds of a batch on the threads of the current pool; `None` for rivals.
    fn batch(&self, queries: QuerySlice<'_>) -> Option<f64>;
}

/// One of ours.
struct Ours<I>(I);

impl<I: ClosestPoint<f64> + CertifiedQuery<f64> + Sync> Built for Ours<I> {
    fn subject(&self, setting: &Setting) -> Box<dyn Subject + '_> {
        match setting.ask {
            Ask::Certified => Box::new(AskedForProof::new(&self.0)),
            _ => Box::new(Asked::new(&self.0, setting.options::<f64>())),
        }
    }

    fn batch(&self, queries: QuerySlice<'_>) -> Option<f64> {
        Some(seconds_of_batch(&self.0, queries))
    }
}

fn seconds_of_batch(index: &(impl ClosestPoint<f64> + Sync), queries: QuerySlice<'_>) -> f64 {
    let mut answers = vec![None; queries.double.len()];
    let start = Instant::now();
    closest_points_into(index, queries.double, &QueryOptions::default(), &BatchOptions::default(), &mut answers);
    start.elapsed().as_secs_f64()
}

/// One of others, which has no settings.
struct Rival<C>(C);

/// The same, asked.
struct AskedRival<'a, C>(&'a C);

impl<C: Contender> Respond for AskedRival<'_, C> {
    type Scalar = C::Scalar;

    #[inline(always)]
    fn respond(&self, query: &Point3<C::Scalar>) -> Answer {
        Answer::of_distance(self.0.query(query).distance)
    }
}

impl<C: Contender> Built for Rival<C> {
    fn subject(&self, _: &Setting) -> Box<dyn Subject + '_> {
        Box::new(AskedRival(&self.0))
    }

    fn batch(&self, _: QuerySlice<'_>) -> Option<f64> {
        None
    }
}

/// An index before it is built.
type Made<'a> = Result<Prepared<'a, Box<dyn Built + 'a>>, Absent>;

/// Makes it ready to be built over a scene.
type Make = for<'a> fn(&'a Scene) -> Made<'a>;

/// An entry of the list.
pub(super) struct Candidate {
    /// Its name.
    pub(super) name: &'static str,
    /// What it is, for who has not seen it.
    pub(super) about: &'static str,
    /// Over the scene in f64, or in what scalar a rival has.
    make: Make,
    /// Whether it is ours, and its answers promise something.
    ours: bool,
    /// Whether it has settings.
    pub(super) varied: bool,
}

/// All, in the order of tables and colours.
pub(super) const ALL: &[Candidate] = &[
    Candidate {
        name: "aabb",
        about: "our tree of boxes (`AabbTree`); quick to build, answers every kind of question",
        make: |s| ours::<AabbTree<_, _>>(s, aabb_options()),
        ours: true,
        varied: true,
    },
    Candidate {
        name: "kdop",
        about: "our tree of polytopes with 14 faces (`KdopTree`), which fit closer what does not lie along the axes",
        make: |s| ours::<KdopTree<_, _, 14>>(s, KdopOptions::default().with_splits(aabb_options())),
        ours: true,
        varied: true,
    },
    Candidate {
        name: "octree",
        about: "our cubes with lists of what can be nearest in them (`OctreeIndex`)",
        make: |s| ours::<OctreeIndex<_, _>>(s, octree_options(1.0)),
        ours: true,
        varied: true,
    },
    Candidate {
        name: "p2m",
        about: "our cells of the vertices with lists of what can be nearest in them (`P2mIndex`), one query at a time",
        make: |s| ours::<P2mIndex<_, _>>(s, p2m_options()),
        ours: true,
        varied: true,
    },
    Candidate {
        name: "brute",
        about: "every primitive, every time (`BruteForce`)",
        make: |s| ours::<BruteForce<_>>(s, ()),
        ours: true,
        varied: false,
    },
    Candidate {
        name: "parry3d",
        about: "the crate parry3d 0.31, in f32: `TriMesh` and `Polyline`, the latter within the answer of the former",
        make: |s| rival(rivals::single(s)?),
        ours: false,
        varied: false,
    },
    Candidate {
        name: "parry3d-f64",
        about: "the same in f64",
        make: |s| rival(rivals::double(s)?),
        ours: false,
        varied: false,
    },
    Candidate {
        name: "bvh",
        about: "the crate bvh 0.13 in f64, `Bvh::nearest_to`; it leaves the distance to a primitive to its user: here it is the \
                closest point on a triangle of Ericson's Real-Time Collision Detection, 5.1.5",
        make: |s| rival(bvh_crate::tree(s)),
        ours: false,
        varied: false,
    },
];

fn ours<'a, I>(scene: &'a Scene, options: I::Options) -> Made<'a>
where
    I: BuildIndex<f64, &'a Soup<f64>, Options: 'a> + CertifiedQuery<f64> + Sync + 'a,
{
    let (soup, borrowed) = f64::soup(scene)?;
    let build = move || {
        let index = I::build(soup, &options).map_err(|error| Absent(error.to_string()))?;
        Ok(Box::new(Ours(index)) as Box<dyn Built>)
    };
    Ok(Prepared { build: Box::new(build), borrowed })
}

/// What it copied of the scene is its own.
fn rival<'a, C: Contender + 'a>(build: impl FnOnce() -> Result<C, Absent> + 'a) -> Made<'a> {
    let build = move || Ok(Box::new(Rival(build()?)) as Box<dyn Built>);
    Ok(Prepared { build: Box::new(build), borrowed: 0 })
}

/// An index of a scene, and what it cost.
pub(super) struct Index<'a> {
    /// Which one.
    pub(super) candidate: &'static Candidate,
    /// What answers.
    pub(super) built: Box<dyn Built + 'a>,
    /// Of its builds.
    pub(super) build: Build,
}

/// All that can be built over a scene, and why others cannot, in sentences.
pub(super) fn build_all(scene: &Scene, builds: usize) -> (Vec<Index<'_>>, Vec<String>) {
    let (mut indexes, mut notes) = (Vec::new(), Vec::new());
    for candidate in ALL {
        match build(scene, candidate.make, builds) {
            Ok((built, build)) => indexes.push(Index { candidate, built, build }),
            Err(Absent(why)) => notes.push(format!("`{}` is left out here: {why}.", candidate.name)),
        }
    }
    (indexes, notes)
}

/// Builds at least once; seconds are the median.
fn build(scene: &Scene, make: Make, builds: usize) -> Result<(Box<dyn Built + '_>, Build), Absent> {
    let mut figures = BuildFigures::default();
    loop {
        let before = memory::current();
        let prepared = make(scene)?;
        let built = weigh(&mut figures, before, || catch(prepared.build))?;
        if figures.seconds.len() >= builds || figures.seconds.iter().sum::<f64>() > BUILD_SECONDS {
            let seconds = Spread::of(&figures.seconds).map_or(0.0, |spread| spread.median);
            return Ok((built, Build { seconds, bytes_each: Some(figures.owned as f64 / scene.len() as f64) }));
        }
    }
}

/// Every setting of every index, or the usual one alone.
pub(super) fn entrants<'a>(indexes: &'a [Index<'_>], usual: bool) -> Vec<Entrant<'a>> {
    let mut entrants = Vec::new();
    for index in indexes {
        let candidate = index.candidate;
        for setting in SETTINGS.iter().filter(|setting| **setting == DEFAULT || candidate.varied && !usual) {
            entrants.push(Entrant {
                backend: candidate.name.to_owned(),
                setting: setting.name.to_owned(),
                promise: if candidate.ours { setting.promise() } else { Promise::Nothing },
                subject: index.built.subject(setting),
                build: index.build,
            });
        }
    }
    entrants
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::queries::Queries;
    use p2m_mixed::generate::{KnotAndCables, knot_and_cables};

    #[test]
    fn everyone_is_built_and_asked() {
        let soup = knot_and_cables(&KnotAndCables::default().with_rings(30)).unwrap();
        let scene = Scene::new("knot".to_owned(), soup).unwrap();
        let (indexes, notes) = build_all(&scene, 1);
        assert_eq!((indexes.len(), notes.len()), (ALL.len(), 0), "{notes:?}");
        assert_eq!(entrants(&indexes, false).len(), 4 * SETTINGS.len() + 4);
        assert_eq!(entrants(&indexes, true).len(), ALL.len());
        let queries = Queries::new(vec![Point3::new(1.0, 2.0, 3.0); 100]);
        assert_eq!(indexes.iter().filter_map(|index| index.built.batch(queries.all())).count(), 5);
        // What they are is not asserted: other tests of this program allocate and free at the same time.
        assert!(indexes.iter().all(|index| index.build.seconds > 0.0 && index.build.bytes_each.is_some()));
    }
}
