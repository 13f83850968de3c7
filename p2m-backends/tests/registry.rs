//! Tests that the entries of the registry are what they say of themselves, and that the settings of the P2M index change
//! no answer.

use nalgebra::Point3;
use p2m_backends::{BACKENDS, BackendEntry, BuildSettings, SearchStructure};
use p2m_core::storage::{SavedFile, Writer};
use p2m_mixed::generate::{IcoSphere, ico_sphere};
use std::sync::Arc;

#[test]
fn entries_are_what_they_say_of_themselves() {
    let soup = Arc::new(ico_sphere(&IcoSphere::default()).unwrap());
    let query = Point3::new(0.1, 0.2, 3.0);
    for (i, backend) in BACKENDS.iter().enumerate() {
        assert!(BACKENDS[..i].iter().all(|other| other != backend), "{backend}");
        assert_eq!(BackendEntry::find(backend.name), Some(backend));
        let built = backend.build(Arc::clone(&soup), &BuildSettings::default()).unwrap();
        let answer = built.index.closest_point(&query);
        assert!(answer.is_some());
        assert_eq!(built.index.as_ray_query().is_some(), backend.casts_rays, "{backend}");
        assert_eq!(built.index.memory_bytes() > 0, backend.structure != SearchStructure::Exhaustive, "{backend}");
        assert_eq!(built.index.as_pair_query().is_some(), backend.answers_pairs, "{backend}");
        assert_eq!(built.index.refitted(Arc::clone(&soup)).is_some(), backend.has_refit, "{backend}");
        assert_eq!(built.index.surface_area().is_some(), backend.structure == SearchStructure::Tree, "{backend}");
        assert_eq!(built.index.cells().is_some(), backend.structure.has_cells(), "{backend}");
        assert_eq!(built.directions.is_some(), backend.has_kdop_directions, "{backend}");
        let finer = BuildSettings::default().with_resolution(Some(3.0));
        let finer = backend.build(Arc::clone(&soup), &finer).unwrap();
        assert_eq!(finer.index.cells() != built.index.cells(), backend.has_resolution, "{backend}");
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
            let loaded = backend.load(Arc::clone(&soup), reader).unwrap();
            assert_eq!(loaded.index.closest_point(&query), answer, "{backend}");
            assert_eq!(loaded.directions, built.directions, "{backend}");
            assert_eq!(loaded.index.cells(), built.index.cells(), "{backend}");
        } else {
            assert!(backend.load(Arc::clone(&soup), reader).is_err());
        }
    }
    assert_eq!(BackendEntry::default_backend().name, "aabb");
}

#[cfg(feature = "paper")]
#[test]
fn every_locator_and_filter_gives_the_same_answers() {
    use p2m_backends::{ListFilterKind, LocatorKind, P2mSettings};
    let soup = Arc::new(ico_sphere(&IcoSphere::default()).unwrap());
    let queries: Vec<_> = (0..100).map(|i| Point3::new(0.1 * f64::from(i), 0.2, 3.0 - f64::from(i % 7))).collect();
    let backend = BackendEntry::find("p2m").unwrap();
    let expected = backend.build(Arc::clone(&soup), &BuildSettings::default()).unwrap();
    for locator in [LocatorKind::Grid, LocatorKind::KdTree] {
        for list_filter in [ListFilterKind::Sorted, ListFilterKind::RTree] {
            let p2m = P2mSettings::default().with_locator(locator).with_list_filter(list_filter);
            let built = backend.build(Arc::clone(&soup), &BuildSettings::default().with_p2m(p2m)).unwrap();
            for query in &queries {
                assert_eq!(built.index.closest_point(query), expected.index.closest_point(query), "{p2m:?}");
            }
        }
    }
}
