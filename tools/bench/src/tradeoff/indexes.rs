//! The indexes of the page: our backends, and external libraries.

use crate::backend::{BenchIndex, Prepared, Scalar, Unavailable, catch};
use crate::bvh_crate;
use crate::external;
use crate::measure::{BuildFigures, measure_build};
use crate::memory;
use crate::scene::Scene;
use nalgebra::Point3;
use p2m_backends::{AnyIndex, BACKENDS, BackendEntry, BuildSettings, SearchStructure};
use p2m_core::QueryOptions;
use p2m_core::batch::{BatchOptions, closest_points_into};
use p2m_tradeoff::queries::QuerySlice;
use p2m_tradeoff::settings::{Promise, SETTINGS, Setting};
use p2m_tradeoff::{Answer, AnswerQuery, Build, Competitor, MedianRange};
use std::sync::{Arc, LazyLock};
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
struct Ours(Arc<dyn AnyIndex>);

impl Built for Ours {
    fn competitor(&self, name: &str, setting: &Setting, build: Build) -> Competitor<'_> {
        Competitor::new(name, &*self.0, setting, build)
    }

    fn batch(&self, queries: QuerySlice<'_>) -> Option<f64> {
        let mut answers = vec![None; queries.double.len()];
        let start = Instant::now();
        closest_points_into(&*self.0, queries.double, &QueryOptions::default(), &BatchOptions::default(), &mut answers);
        Some(start.elapsed().as_secs_f64())
    }
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

/// A function that prepares a scene for the build.
type Prepare = Box<dyn for<'a> Fn(&'a Scene) -> PreparedIndex<'a> + Send + Sync>;

/// A backend in the list.
pub(super) struct Candidate {
    /// The name of the backend.
    pub(super) name: &'static str,
    /// A description for readers who have not seen the backend.
    pub(super) about: &'static str,
    /// Prepares the scene: in f64 for our backends, in its own scalar for an external library.
    prepare: Prepare,
    /// Whether the backend has settings.
    pub(super) has_settings: bool,
}

/// All backends, in the order of tables and colours: those of the registry, exhaustive searches last, and external
/// libraries.
pub(super) static ALL: LazyLock<Vec<Candidate>> = LazyLock::new(|| {
    let mut ours: Vec<&'static BackendEntry> = BACKENDS.iter().collect();
    ours.sort_by_key(|entry| entry.structure == SearchStructure::Exhaustive);
    ours.into_iter().map(of_registry).chain(external()).collect()
});

/// Makes the candidate of an entry of the registry.
fn of_registry(entry: &'static BackendEntry) -> Candidate {
    Candidate {
        name: entry.name,
        about: entry.summary,
        prepare: Box::new(move |scene| registered(entry, scene)),
        has_settings: entry.structure != SearchStructure::Exhaustive,
    }
}

/// Prepares an index of ours, which is built on one thread, because thread CPU time is measured.
fn registered<'a>(entry: &'static BackendEntry, scene: &'a Scene) -> PreparedIndex<'a> {
    let (soup, borrowed) = f64::soup(scene)?;
    let build = move || {
        let built = entry.build(Arc::clone(soup), &BuildSettings::default().with_parallel(false));
        let index = built.map_err(|error| Unavailable(error.to_string()))?.index;
        Ok(Box::new(Ours(index)) as Box<dyn Built>)
    };
    Ok(Prepared { build: Box::new(build), borrowed })
}

/// Returns external libraries.
fn external() -> [Candidate; 3] {
    [
        Candidate {
            name: "parry3d",
            about: "the crate parry3d 0.31, in f32: `TriMesh` and `Polyline`, the latter within the answer of the former",
            prepare: Box::new(|s| external_index(external::single(s)?)),
            has_settings: false,
        },
        Candidate {
            name: "parry3d-f64",
            about: "the same in f64",
            prepare: Box::new(|s| external_index(external::double(s)?)),
            has_settings: false,
        },
        Candidate {
            name: "bvh",
            about: "the crate bvh 0.13 in f64, `Bvh::nearest_to`; it leaves the distance to a primitive to its user: here \
                    it is the closest point on a triangle of Ericson's Real-Time Collision Detection, 5.1.5",
            prepare: Box::new(|s| external_index(bvh_crate::tree(s))),
            has_settings: false,
        },
    ]
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
    for candidate in &*ALL {
        match build(scene, &candidate.prepare, builds) {
            Ok((built, build)) => indexes.push(Index { candidate, built, build }),
            Err(Unavailable(why)) => notes.push(format!("`{}` is left out here: {why}.", candidate.name)),
        }
    }
    (indexes, notes)
}

/// Builds an index at least once; the seconds are the median.
fn build<'a>(scene: &'a Scene, prepare: &Prepare, builds: usize) -> Result<(Box<dyn Built + 'a>, Build), Unavailable> {
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
        let (ours, with_settings) = (BACKENDS.len(), ALL.iter().filter(|candidate| candidate.has_settings).count());
        assert_eq!(competitors(&indexes, false).len(), with_settings * SETTINGS.len() + ALL.len() - with_settings);
        assert_eq!(competitors(&indexes, true).len(), ALL.len());
        let queries = Queries::new(vec![Point3::new(1.0, 2.0, 3.0); 100]);
        assert_eq!(indexes.iter().filter_map(|index| index.built.batch(queries.all())).count(), ours);
        // The number of bytes is not asserted, because other tests of this program allocate and free at the same time.
        assert!(indexes.iter().all(|index| index.build.seconds > 0.0 && index.build.bytes_per_primitive.is_some()));
    }
}
