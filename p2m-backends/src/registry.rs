//! The registry of backends: one table that the program `p2m`, the advisor, measurements and tests read.
//!
//! A new backend joins them with one entry of [`BACKENDS`] and, if its index has a type of its own, with an
//! implementation of [`AnyIndex`] for that type, as the module `index` has for the others. The values of `--backend`, the
//! files of `p2m build`, the estimates of `p2m advise`, the list of `p2m-bench` and the tests of agreement all come
//! from that entry.
//!
//! Indexes are behind one pointer, [`Box<dyn AnyIndex>`](AnyIndex), with a borrowed [`Soup`] as the set. The pointer costs
//! one indirect call for each query, or for each batch of queries. In rounds of `p2m tradeoff` it makes no measurable
//! difference to queries of 700 to 1000 ns, so no command needs the types behind it. The searches below that call are
//! compiled for each index. Code that needs another set uses the types of the index crates instead.

use crate::backend_entry::{BackendEntry, SavedFormat, SearchStructure};
use crate::cost_model::CostModel;
use crate::index::{BuildSettings, BuiltIndex, IndexDetails};
use crate::kdop_directions::{KdopDirections, KdopVisitor};
use p2m_bvh::AabbTree;
use p2m_core::storage::{self, LoadError, Reader, Saved};
use p2m_core::{AnyIndex, BruteForce, BuildError, BuildIndex, PrimitiveSet, Real, Soup};
use p2m_interception::{Octree, OctreeIndex, OctreeOptions, P2mIndex, Voronoi};
use p2m_kdop::KdopTree;
use std::marker::PhantomData;

/// All backends, the simplest one first. Tables and estimates keep this order.
pub static BACKENDS: &[BackendEntry] = &[
    BackendEntry {
        name: "brute",
        summary: "Every primitive, every time",
        structure: SearchStructure::Exhaustive,
        casts_rays: true,
        reports_progress: false,
        has_kdop_directions: false,
        has_p2m_settings: false,
        cost: CostModel {
            build_seconds_per_primitive: 0.04e-6,
            near_query_seconds: 0.0,
            box_query_seconds: 0.0,
            bytes_per_primitive: 0.0,
            near_growth: 2.0,
            box_growth: 2.0,
            sliver_query_factor: 1.0,
            sample_correction: 1.0,
        },
        build: build_brute,
        build_f32: build_brute,
        saved: None,
    },
    BackendEntry {
        name: "aabb",
        summary: "A tree of boxes",
        structure: SearchStructure::Tree,
        casts_rays: true,
        reports_progress: false,
        has_kdop_directions: false,
        has_p2m_settings: false,
        cost: CostModel {
            build_seconds_per_primitive: 0.37e-6,
            near_query_seconds: 700e-9,
            box_query_seconds: 1200e-9,
            bytes_per_primitive: 65.0,
            near_growth: 1.11,
            box_growth: 1.27,
            sliver_query_factor: 1.0,
            sample_correction: 1.0,
        },
        build: build_aabb,
        build_f32: build_aabb,
        saved: Some(SavedFormat {
            is_in: |reader, _| has_kind(reader, "aabb"),
            load: |soup, reader| load_aabb(soup, reader),
            load_shared: load_aabb,
        }),
    },
    BackendEntry {
        name: "kdop",
        summary: "A tree of polytopes (k-DOPs), which fit closer what does not lie along the axes",
        structure: SearchStructure::Tree,
        casts_rays: true,
        reports_progress: false,
        has_kdop_directions: true,
        has_p2m_settings: false,
        cost: CostModel {
            build_seconds_per_primitive: 0.4e-6,
            near_query_seconds: 750e-9,
            box_query_seconds: 1250e-9,
            bytes_per_primitive: 66.0,
            near_growth: 1.11,
            box_growth: 1.27,
            sliver_query_factor: 0.75,
            sample_correction: 1.08,
        },
        build: build_kdop,
        build_f32: build_kdop,
        saved: Some(SavedFormat {
            is_in: |reader, directions| KdopDirections::saved_faces(directions, reader).is_some(),
            load: |soup, reader| load_kdop(soup, reader),
            load_shared: load_kdop,
        }),
    },
    BackendEntry {
        name: "octree",
        summary: "Cells in space with lists of what can be nearest there: no search, for more memory and a longer build",
        structure: SearchStructure::SpaceCells,
        casts_rays: false,
        reports_progress: true,
        has_kdop_directions: false,
        has_p2m_settings: false,
        cost: CostModel {
            build_seconds_per_primitive: 6.5e-6,
            near_query_seconds: 640e-9,
            box_query_seconds: 690e-9,
            bytes_per_primitive: 235.0,
            near_growth: 1.15,
            box_growth: 1.23,
            sliver_query_factor: 1.0,
            sample_correction: 1.0,
        },
        build: build_octree,
        build_f32: build_octree,
        saved: Some(SavedFormat {
            is_in: |reader, _| has_kind(reader, &Octree::kind()),
            load: |soup, reader| load_octree(soup, reader),
            load_shared: load_octree,
        }),
    },
    BackendEntry {
        name: "p2m",
        summary: "Cells of the vertices with lists of what can be nearest there: fastest far from the scene",
        structure: SearchStructure::VertexCells,
        casts_rays: false,
        reports_progress: true,
        has_kdop_directions: false,
        has_p2m_settings: true,
        cost: CostModel {
            build_seconds_per_primitive: 21e-6,
            near_query_seconds: 430e-9,
            box_query_seconds: 500e-9,
            bytes_per_primitive: 330.0,
            near_growth: 1.12,
            box_growth: 1.24,
            sliver_query_factor: 1.0,
            sample_correction: 1.0,
        },
        build: build_p2m,
        build_f32: build_p2m,
        saved: Some(SavedFormat {
            is_in: |reader, _| has_kind(reader, &Voronoi::kind()),
            load: |soup, reader| load_p2m(soup, reader),
            load_shared: load_p2m,
        }),
    },
];

/// The result of building an index in the scalar `T`.
type Built<'a, T> = Result<BuiltIndex<'a, T>, BuildError>;

fn build_brute<'a, T: Real>(soup: &'a Soup<T>, _: &BuildSettings<'_>) -> Built<'a, T> {
    Ok(BuiltIndex::new(BruteForce::build(soup, &())?, IndexDetails::None))
}

fn build_aabb<'a, T: Real>(soup: &'a Soup<T>, settings: &BuildSettings<'_>) -> Built<'a, T> {
    Ok(BuiltIndex::new(AabbTree::build(soup, &settings.splits())?, IndexDetails::None))
}

fn build_kdop<'a, T: Real>(soup: &'a Soup<T>, settings: &BuildSettings<'_>) -> Built<'a, T> {
    let directions = settings.kdop_directions.unwrap_or(KdopDirections::Fourteen);
    let (index, directions) = directions.build(soup, settings.splits(), BoxTree(PhantomData))?;
    Ok(BuiltIndex { index, details: IndexDetails::Kdop(directions) })
}

fn build_octree<'a, T: Real>(soup: &'a Soup<T>, settings: &BuildSettings<'_>) -> Built<'a, T> {
    let options = OctreeOptions::default().with_splits(settings.splits());
    let (memory, work) = (options.memory, options.work);
    let scale = settings.octree_budget_scale;
    let options = options.with_memory(memory * scale).with_work(work * scale);
    let index =
        OctreeIndex::build_until(soup, &options, settings.progress, &mut |so_far| (settings.visit_octree)(so_far))?;
    let report = index.report();
    Ok(BuiltIndex::new(index, IndexDetails::Octree(report)))
}

fn build_p2m<'a, T: Real>(soup: &'a Soup<T>, settings: &BuildSettings<'_>) -> Built<'a, T> {
    let options = settings.p2m.options().with_splits(settings.splits());
    let index = P2mIndex::build_with_progress(soup, &options, settings.progress)?;
    let report = index.report();
    Ok(BuiltIndex::new(index, IndexDetails::P2m(report)))
}

/// The result of loading an index.
type Loaded<'a> = Result<BuiltIndex<'a>, LoadError>;

fn load_aabb<'a, S: PrimitiveSet<f64> + Send + Sync + 'a>(set: S, reader: &Reader) -> Loaded<'a> {
    Ok(BuiltIndex::new(AabbTree::load(set, reader)?, IndexDetails::None))
}

fn load_kdop<'a, S: PrimitiveSet<f64> + Send + Sync + 'a>(set: S, reader: &Reader) -> Loaded<'a> {
    let faces = KdopDirections::saved_faces(None, reader).unwrap_or(14);
    let (index, directions) = KdopDirections::load(faces, set, reader, BoxTree(PhantomData))?;
    Ok(BuiltIndex { index, details: IndexDetails::Kdop(directions) })
}

fn load_octree<'a, S: PrimitiveSet<f64> + Send + Sync + 'a>(set: S, reader: &Reader) -> Loaded<'a> {
    let index = OctreeIndex::load(set, reader)?;
    let report = index.report();
    Ok(BuiltIndex::new(index, IndexDetails::Octree(report)))
}

fn load_p2m<'a, S: PrimitiveSet<f64> + Send + Sync + 'a>(set: S, reader: &Reader) -> Loaded<'a> {
    let index = P2mIndex::load(set, reader)?;
    let report = index.report();
    Ok(BuiltIndex::new(index, IndexDetails::P2m(report)))
}

fn has_kind(reader: &Reader, kind: &str) -> bool {
    storage::kind(reader).is_ok_and(|found| found == kind)
}

/// Erases the number of faces of a k-DOP tree.
struct BoxTree<'a>(PhantomData<&'a ()>);

impl<'a, T: Real, S: PrimitiveSet<T> + Send + Sync + 'a> KdopVisitor<S, T> for BoxTree<'a> {
    type Output = Box<dyn AnyIndex<T> + 'a>;
    fn visit<const K: usize>(self, tree: KdopTree<T, S, K>) -> Self::Output {
        Box::new(tree)
    }
}

impl BackendEntry {
    /// Returns the backend of this name.
    #[must_use]
    pub fn find(name: &str) -> Option<&'static Self> {
        BACKENDS.iter().find(|backend| backend.name == name)
    }

    /// Returns the backend that is used where none is named: the tree of boxes, which is quick to build and answers
    /// every kind of query.
    ///
    /// # Panics
    /// It does not panic: the table has a tree.
    #[must_use]
    pub fn default_backend() -> &'static Self {
        BACKENDS.iter().find(|backend| backend.structure == SearchStructure::Tree).expect("the table has a tree")
    }

    /// Returns the backend of the index in a saved file, if there is one.
    #[must_use]
    pub fn from_saved(reader: &Reader) -> Option<&'static Self> {
        BACKENDS.iter().find(|backend| backend.is_in(reader, None))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;
    use p2m_core::storage::{SavedFile, Writer};
    use p2m_mixed::generate::{IcoSphere, ico_sphere};
    use std::sync::Arc;

    #[test]
    fn entries_are_what_they_say_of_themselves() {
        let soup = ico_sphere(&IcoSphere::default()).unwrap();
        let query = Point3::new(0.1, 0.2, 3.0);
        for (i, backend) in BACKENDS.iter().enumerate() {
            assert!(BACKENDS[..i].iter().all(|other| other != backend), "{backend}");
            assert_eq!(BackendEntry::find(backend.name), Some(backend));
            let built = backend.build(&soup, &BuildSettings::default()).unwrap();
            let answer = built.index.closest_point(&query);
            assert!(answer.is_some());
            assert_eq!(built.index.as_ray_query().is_some(), backend.casts_rays, "{backend}");
            assert_eq!(built.index.memory_bytes() > 0, backend.structure != SearchStructure::Exhaustive, "{backend}");
            assert_eq!(matches!(built.details, IndexDetails::Kdop(_)), backend.has_kdop_directions, "{backend}");
            let mut file = Vec::new();
            let mut writer = Writer::default();
            built.save(&mut writer);
            writer.write(&mut file).unwrap();
            let file = SavedFile::read(&file[..]).unwrap();
            let reader = file.checked().unwrap();
            for other in BACKENDS {
                assert_eq!(other.is_in(reader, None), other == backend && backend.is_saveable(), "{other} {backend}");
            }
            if backend.is_saveable() {
                assert_eq!(BackendEntry::from_saved(reader), Some(backend));
                let loaded = backend.load(&soup, reader).unwrap();
                assert_eq!(loaded.index.closest_point(&query), answer, "{backend}");
                let shared = backend.load_shared(Arc::new(soup.clone()), reader).unwrap();
                assert_eq!(shared.index.closest_point(&query), answer, "{backend}");
                assert_eq!(loaded.details, built.details, "{backend}");
            } else {
                assert!(backend.load(&soup, reader).is_err());
            }
        }
        assert_eq!(BackendEntry::default_backend().name, "aabb");
    }
    #[cfg(all(feature = "kiddo", feature = "rstar"))]
    #[test]
    fn every_locator_and_filter_gives_the_same_answers() {
        use crate::p2m_settings::{ListFilterKind, LocatorKind, P2mSettings};
        let soup = ico_sphere(&IcoSphere::default()).unwrap();
        let queries: Vec<_> = (0..100).map(|i| Point3::new(0.1 * f64::from(i), 0.2, 3.0 - f64::from(i % 7))).collect();
        let backend = BackendEntry::find("p2m").unwrap();
        let expected = backend.build(&soup, &BuildSettings::default()).unwrap();
        for locator in [LocatorKind::Grid, LocatorKind::KdTree] {
            for list_filter in [ListFilterKind::Sorted, ListFilterKind::RTree] {
                let p2m = P2mSettings { locator, list_filter };
                let built = backend.build(&soup, &BuildSettings::default().with_p2m(p2m)).unwrap();
                for query in &queries {
                    assert_eq!(built.index.closest_point(query), expected.index.closest_point(query), "{p2m:?}");
                }
            }
        }
    }
}
