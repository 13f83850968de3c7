//! The indexes of the page: our backends, and external libraries.

use crate::backend::{BenchIndex, Prepared, Scalar, Unavailable, catch};
use crate::bvh_crate;
use crate::external;
use crate::measure::{BuildFigures, measure_build};
use crate::memory;
use crate::our_indexes::{aabb_options, octree_options, p2m_options};
use crate::scene::Scene;
use nalgebra::Point3;
use p2m_bvh::AabbTree;
use p2m_core::batch::{BatchOptions, closest_points_into};
use p2m_core::{BruteForce, BuildIndex, CertifiedQuery, ClosestPoint, QueryOptions, Soup};
use p2m_interception::{OctreeIndex, P2mIndex};
use p2m_kdop::{KdopOptions, KdopTree};
use p2m_tradeoff::queries::QuerySlice;
use p2m_tradeoff::settings::{Promise, SETTINGS, Setting};
use p2m_tradeoff::{Answer, AnswerQuery, Build, Competitor, MedianRange};
use std::time::Instant;

/// An index is not built again once its builds have taken this many seconds in all.
const MAX_BUILD_SECONDS: f64 = 10.0;

/// An index that was built.
pub(super) trait Built: Sync {
    /// Returns a competitor that answers queries with a setting.
    fn competitor(&self, name: &str, setting: &Setting, build: Build) -> Competitor<'_>;
    /// Returns the wall seconds of a batch on the threads of the current pool; `None` for external libraries.
    fn batch(&self, queries: QuerySlice<'_>) -> Option<f64>;
}

/// An index of ours.
struct Ours<I>(I);

impl<I: ClosestPoint<f64> + CertifiedQuery<f64> + Sync> Built for Ours<I> {
    fn competitor(&self, name: &str, setting: &Setting, build: Build) -> Competitor<'_> {
        Competitor::new(name, &self.0, setting, build)
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

/// An external library, which has no settings.
struct External<C>(C);

/// An external library that answers one query at a time.
struct OneByOne<'a, C>(&'a C);

impl<C: BenchIndex> AnswerQuery for OneByOne<'_, C> {
    type Scalar = C::Scalar;

    #[inline(always)]
    fn answer_query(&self, query: &Point3<C::Scalar>) -> Answer {
        Answer::of_distance(self.0.query(query).distance)
    }
}

impl<C: BenchIndex> Built for External<C> {
    fn competitor(&self, name: &str, setting: &Setting, build: Build) -> Competitor<'_> {
        let (backend, setting) = (name.to_owned(), setting.name.to_owned());
        Competitor { backend, setting, promise: Promise::Nothing, index: Box::new(OneByOne(&self.0)), build }
    }

    fn batch(&self, _: QuerySlice<'_>) -> Option<f64> {
        None
    }
}

/// An index before it is built.
type PreparedIndex<'a> = Result<Prepared<'a, Box<dyn Built + 'a>>, Unavailable>;

/// Prepares a scene for the build.
type PrepareFn = for<'a> fn(&'a Scene) -> PreparedIndex<'a>;

/// A backend in the list.
pub(super) struct Candidate {
    /// The name of the backend.
    pub(super) name: &'static str,
    /// A description for readers who have not seen the backend.
    pub(super) about: &'static str,
    /// Prepares the scene: in f64 for our backends, in its own scalar for an external library.
    prepare: PrepareFn,
    /// Whether the backend has settings.
    pub(super) has_settings: bool,
}

/// All backends, in the order of tables and colours.
pub(super) const ALL: &[Candidate] = &[
    Candidate {
        name: "aabb",
        about: "our tree of boxes (`AabbTree`); quick to build, answers every kind of question",
        prepare: |s| ours::<AabbTree<_, _>>(s, aabb_options()),
        has_settings: true,
    },
    Candidate {
        name: "kdop",
        about: "our tree of polytopes with 14 faces (`KdopTree`), which fit closer what does not lie along the axes",
        prepare: |s| ours::<KdopTree<_, _, 14>>(s, KdopOptions::default().with_splits(aabb_options())),
        has_settings: true,
    },
    Candidate {
        name: "octree",
        about: "our cubes with lists of what can be nearest in them (`OctreeIndex`)",
        prepare: |s| ours::<OctreeIndex<_, _>>(s, octree_options(1.0)),
        has_settings: true,
    },
    Candidate {
        name: "p2m",
        about: "our cells of the vertices with lists of what can be nearest in them (`P2mIndex`), one query at a time",
        prepare: |s| ours::<P2mIndex<_, _>>(s, p2m_options()),
        has_settings: true,
    },
    Candidate {
        name: "brute",
        about: "every primitive, every time (`BruteForce`)",
        prepare: |s| ours::<BruteForce<_>>(s, ()),
        has_settings: false,
    },
    Candidate {
        name: "parry3d",
        about: "the crate parry3d 0.31, in f32: `TriMesh` and `Polyline`, the latter within the answer of the former",
        prepare: |s| external_index(external::single(s)?),
        has_settings: false,
    },
    Candidate {
        name: "parry3d-f64",
        about: "the same in f64",
        prepare: |s| external_index(external::double(s)?),
        has_settings: false,
    },
    Candidate {
        name: "bvh",
        about: "the crate bvh 0.13 in f64, `Bvh::nearest_to`; it leaves the distance to a primitive to its user: here it is the \
                closest point on a triangle of Ericson's Real-Time Collision Detection, 5.1.5",
        prepare: |s| external_index(bvh_crate::tree(s)),
        has_settings: false,
    },
];

fn ours<'a, I>(scene: &'a Scene, options: I::Options) -> PreparedIndex<'a>
where
    I: BuildIndex<f64, &'a Soup<f64>, Options: 'a> + CertifiedQuery<f64> + Sync + 'a,
{
    let (soup, borrowed) = f64::soup(scene)?;
    let build = move || {
        let index = I::build(soup, &options).map_err(|error| Unavailable(error.to_string()))?;
        Ok(Box::new(Ours(index)) as Box<dyn Built>)
    };
    Ok(Prepared { build: Box::new(build), borrowed })
}

/// Prepares an external library; copies of the scene count as its own memory.
fn external_index<'a, C: BenchIndex + 'a>(build: impl FnOnce() -> Result<C, Unavailable> + 'a) -> PreparedIndex<'a> {
    let build = move || Ok(Box::new(External(build()?)) as Box<dyn Built>);
    Ok(Prepared { build: Box::new(build), borrowed: 0 })
}

/// An index of a scene, and its cost.
pub(super) struct Index<'a> {
    /// The backend that was built.
    pub(super) candidate: &'static Candidate,
    /// The index that answers.
    pub(super) built: Box<dyn Built + 'a>,
    /// The cost of the builds.
    pub(super) build: Build,
}

/// Builds every backend over a scene, and returns the reasons why others are missing.
pub(super) fn build_all(scene: &Scene, builds: usize) -> (Vec<Index<'_>>, Vec<String>) {
    let (mut indexes, mut notes) = (Vec::new(), Vec::new());
    for candidate in ALL {
        match build(scene, candidate.prepare, builds) {
            Ok((built, build)) => indexes.push(Index { candidate, built, build }),
            Err(Unavailable(why)) => notes.push(format!("`{}` is left out here: {why}.", candidate.name)),
        }
    }
    (indexes, notes)
}

/// Builds an index at least once; the seconds are the median.
fn build(scene: &Scene, prepare: PrepareFn, builds: usize) -> Result<(Box<dyn Built + '_>, Build), Unavailable> {
    let mut figures = BuildFigures::default();
    loop {
        let before = memory::current();
        let prepared = prepare(scene)?;
        let built = measure_build(&mut figures, before, || catch(prepared.build))?;
        if figures.seconds.len() >= builds || figures.seconds.iter().sum::<f64>() > MAX_BUILD_SECONDS {
            let seconds = MedianRange::of(&figures.seconds).map_or(0.0, |seconds| seconds.median);
            return Ok((
                built,
                Build { seconds, bytes_per_primitive: Some(figures.owned as f64 / scene.len() as f64) },
            ));
        }
    }
}

/// Returns every setting of every index, or the default setting alone.
pub(super) fn competitors<'a>(indexes: &'a [Index<'_>], default_only: bool) -> Vec<Competitor<'a>> {
    let settings = |index: &Index<'_>| {
        let count = if index.candidate.has_settings && !default_only { SETTINGS.len() } else { 1 };
        &SETTINGS[..count]
    };
    let of = |index: &'a Index<'_>, setting| index.built.competitor(index.candidate.name, setting, index.build);
    indexes.iter().flat_map(|index| settings(index).iter().map(move |setting| of(index, setting))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::queries::Queries;
    use p2m_mixed::generate::{KnotAndCables, knot_and_cables};

    #[test]
    fn every_backend_is_built_and_queried() {
        let soup = knot_and_cables(&KnotAndCables { rings: 30, ..Default::default() }).unwrap();
        let scene = Scene::new("knot".to_owned(), soup).unwrap();
        let (indexes, notes) = build_all(&scene, 1);
        assert_eq!((indexes.len(), notes.len()), (ALL.len(), 0), "{notes:?}");
        assert_eq!(competitors(&indexes, false).len(), 4 * SETTINGS.len() + 4);
        assert_eq!(competitors(&indexes, true).len(), ALL.len());
        let queries = Queries::new(vec![Point3::new(1.0, 2.0, 3.0); 100]);
        assert_eq!(indexes.iter().filter_map(|index| index.built.batch(queries.all())).count(), 5);
        // The number of bytes is not asserted, because other tests of this program allocate and free at the same time.
        assert!(indexes.iter().all(|index| index.build.seconds > 0.0 && index.build.bytes_per_primitive.is_some()));
    }
}
