//! The list of all backends: those of the registry of p2m-backends, settings of them, and external libraries.

use crate::backend::{Backend, ScalarKind};
use crate::bvh_crate::prepare as bvh;
use crate::external::{parry_double, parry_single};
use crate::kinds::{aabb_by_kind, aabb_of_set, aabb_of_triangles};
use crate::our_indexes::{
    aabb, aabb_in_batch, kdop, kdop_in_batch, kdop_in_frame, kdop_of_scene, long_lists, octree, octree_in_batch,
    over_soup_with, p2m, p2m_in_batch, p2m_options, registered,
};
use crate::point_trees::{kiddo_double, kiddo_single};
use p2m_backends::{BACKENDS, BackendEntry, SearchStructure};
use p2m_interception::{KdTreeLocator, P2mOptions, RegionTree};
use p2m_testkit::adapters::{ParryIndex, RstarIndex};
use std::sync::LazyLock;

/// Every backend, in the order of the tables.
pub(crate) static ALL: LazyLock<Vec<Backend>> = LazyLock::new(|| {
    let in_f32 = BACKENDS.iter().map(|entry| of_registry(entry, ScalarKind::Single));
    BACKENDS
        .iter()
        .map(|entry| of_registry(entry, ScalarKind::Double))
        .chain(settings())
        .chain(in_f32)
        .chain(external())
        .collect()
});

/// Makes the backend of an entry of the registry in a scalar. The names of those in f32 end in `-f32`.
fn of_registry(entry: &'static BackendEntry, scalar: ScalarKind) -> Backend {
    let name = match scalar {
        ScalarKind::Double => entry.name,
        ScalarKind::Single => format!("{}-f32", entry.name).leak(),
    };
    let is_exhaustive = entry.structure == SearchStructure::Exhaustive;
    Backend { scalar, is_exhaustive, ..Backend::new(name, move |scene| registered(entry, scene, scalar)) }
}

/// Returns our indexes with other settings than those of the registry, and our indexes of other crates' trees.
fn settings() -> Vec<Backend> {
    vec![
        Backend::new("aabb-avx512", |s| aabb(s, Some("avx512"))),
        Backend::new("aabb-avx2", |s| aabb(s, Some("avx2"))),
        Backend::new("aabb-portable", |s| aabb(s, Some("portable"))),
        Backend::new("aabb-tri", aabb_of_triangles),
        Backend::new("aabb-set", aabb_of_set),
        Backend::new("aabb-by-kind", aabb_by_kind),
        Backend::new("octree-avx2", |s| octree(s, Some("avx2"), 1.0)),
        Backend::new("octree-portable", |s| octree(s, Some("portable"), 1.0)),
        Backend::new("octree-coarse", |s| octree(s, None, 0.1)),
        Backend::new("octree-fine", |s| octree(s, None, 10.0)),
        Backend::new("p2m-avx2", |s| p2m(s, Some("avx2"), p2m_options())),
        Backend::new("p2m-kiddo", |s| p2m(s, None, p2m_options().with_locator(KdTreeLocator::build))),
        Backend::new("p2m-rstar", |s| p2m(s, None, p2m_options().with_list_filter(RegionTree::build))),
        Backend::new("p2m-long", |s| p2m(s, None, long_lists())),
        Backend::new("p2m-long-rstar", |s| p2m(s, None, long_lists().with_list_filter(RegionTree::build))),
        Backend::new("p2m-paper", |s| p2m(s, None, P2mOptions::as_in_paper().with_splits(p2m_options().splits))),
        Backend::new("aabb-batch", |s| aabb_in_batch(s, None)),
        Backend::new("aabb-batch-avx2", |s| aabb_in_batch(s, Some("avx2"))),
        Backend::new("aabb-batch-portable", |s| aabb_in_batch(s, Some("portable"))),
        Backend::new("kdop-batch", kdop_in_batch),
        Backend::new("octree-batch", |s| octree_in_batch(s, None, 1.0)),
        Backend::new("octree-batch-fine", |s| octree_in_batch(s, None, 10.0)),
        Backend::new("octree-batch-finest", |s| octree_in_batch(s, None, 30.0)),
        Backend::new("octree-batch-avx2", |s| octree_in_batch(s, Some("avx2"), 1.0)),
        Backend::new("octree-batch-portable", |s| octree_in_batch(s, Some("portable"), 1.0)),
        Backend::new("p2m-batch", |s| p2m_in_batch(s, None)),
        Backend::new("p2m-batch-avx2", |s| p2m_in_batch(s, Some("avx2"))),
        Backend::new("p2m-batch-portable", |s| p2m_in_batch(s, Some("portable"))),
        Backend::new("rstar", |s| over_soup_with::<RstarIndex<_, _>>(s, ())),
        Backend::new("parry-tree", |s| over_soup_with::<ParryIndex<_, _>>(s, ())),
        Backend::new("kdop-6", kdop::<6>),
        Backend::new("kdop-14", kdop::<14>),
        Backend::new("kdop-18", kdop::<18>),
        Backend::new("kdop-26", kdop::<26>),
        Backend::new("kdop-scene", kdop_of_scene),
        Backend::new("kdop-frame-6", kdop_in_frame::<6>),
        Backend::new("kdop-frame-14", kdop_in_frame::<14>),
        Backend::new("kdop-frame-18", kdop_in_frame::<18>),
        Backend::new("kdop-frame-26", kdop_in_frame::<26>),
    ]
}

/// Returns external libraries.
fn external() -> [Backend; 5] {
    [
        Backend { is_ours: false, scalar: ScalarKind::Single, ..Backend::new(YARDSTICK, parry_single) },
        Backend { is_ours: false, ..Backend::new(YARDSTICK_DOUBLE, parry_double) },
        Backend { is_ours: false, ..Backend::new("bvh", bvh) },
        Backend { is_ours: false, ..Backend::new("kiddo", kiddo_double) },
        Backend { is_ours: false, scalar: ScalarKind::Single, ..Backend::new("kiddo-f32", kiddo_single) },
    ]
}

/// The backends that `query` measures by default.
pub(crate) const DEFAULT: &str = "brute,aabb,aabb-tri,aabb-f32,parry3d,parry3d-f64";

/// The external library that ratios refer to.
pub(crate) const YARDSTICK: &str = "parry3d";

/// The external library in f64, to which ratios are given as well.
pub(crate) const YARDSTICK_DOUBLE: &str = "parry3d-f64";

/// Returns the backend of that name from the list.
pub(crate) fn by_name(name: &str) -> &'static Backend {
    ALL.iter().find(|backend| backend.name == name).expect("a name of the list")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_distinct_and_defaults_exist() {
        for (i, backend) in ALL.iter().enumerate() {
            assert!(!backend.name.is_empty() && ALL[..i].iter().all(|other| other.name != backend.name));
        }
        for name in DEFAULT.split(',') {
            assert!(ALL.iter().any(|backend| backend.name == name), "{name}");
        }
    }
}
