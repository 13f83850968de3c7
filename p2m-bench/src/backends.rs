//! The list of all backends. A new backend is one entry of [`ALL`].

use crate::backend::{Backend, ScalarKind, Unavailable};
use crate::external::{parry_double, parry_single};
use crate::kinds::{aabb_by_kind, aabb_of_set, aabb_of_triangles};
use crate::our_indexes::{
    aabb, bvh, kdop, kdop_of_scene, kdop_with, long_lists, octree, over_soup, p2m, p2m_in_batches, p2m_options,
    p2m_with, scene_directions,
};
use p2m_core::BruteForce;
use p2m_interception::{KdTreeLocator, RegionTree};
use p2m_mixed::adapters::{ParryIndex, RstarIndex};

/// Every backend, in the order of the tables.
pub(crate) const ALL: &[Backend] = &[
    Backend { name: "brute", is_exhaustive: true, prepare: |s| over_soup::<f64, BruteForce<_>>(s), ..OURS },
    Backend { name: "aabb", prepare: |s| aabb::<f64>(s, None), ..OURS },
    Backend { name: "aabb-avx512", prepare: |s| aabb::<f64>(s, Some("avx512")), ..OURS },
    Backend { name: "aabb-avx2", prepare: |s| aabb::<f64>(s, Some("avx2")), ..OURS },
    Backend { name: "aabb-portable", prepare: |s| aabb::<f64>(s, Some("portable")), ..OURS },
    Backend { name: "aabb-tri", prepare: aabb_of_triangles, ..OURS },
    Backend { name: "aabb-set", prepare: aabb_of_set, ..OURS },
    Backend { name: "aabb-by-kind", prepare: aabb_by_kind, ..OURS },
    Backend { name: "octree", prepare: |s| octree::<f64>(s, None, 1.0), ..OURS },
    Backend { name: "octree-avx2", prepare: |s| octree::<f64>(s, Some("avx2"), 1.0), ..OURS },
    Backend { name: "octree-portable", prepare: |s| octree::<f64>(s, Some("portable"), 1.0), ..OURS },
    Backend { name: "octree-coarse", prepare: |s| octree::<f64>(s, None, 0.1), ..OURS },
    Backend { name: "octree-fine", prepare: |s| octree::<f64>(s, None, 10.0), ..OURS },
    Backend { name: "p2m", prepare: |s| p2m::<f64>(s, None), ..OURS },
    Backend { name: "p2m-avx2", prepare: |s| p2m::<f64>(s, Some("avx2")), ..OURS },
    Backend { name: "p2m-kiddo", prepare: |s| p2m_with(s, p2m_options().with_locator(KdTreeLocator::build)), ..OURS },
    Backend { name: "p2m-rstar", prepare: |s| p2m_with(s, p2m_options().with_list_filter(RegionTree::build)), ..OURS },
    Backend { name: "p2m-long", prepare: |s| p2m_with(s, long_lists()), ..OURS },
    Backend {
        name: "p2m-long-rstar",
        prepare: |s| p2m_with(s, long_lists().with_list_filter(RegionTree::build)),
        ..OURS
    },
    Backend { name: "p2m-batch", prepare: p2m_in_batches, ..OURS },
    Backend { name: "rstar", prepare: |s| over_soup::<f64, RstarIndex<_, _>>(s), ..OURS },
    Backend { name: "parry-tree", prepare: |s| over_soup::<f64, ParryIndex<_, _>>(s), ..OURS },
    Backend { name: "kdop-6", prepare: kdop::<f64, 6>, ..OURS },
    Backend { name: "kdop-14", prepare: kdop::<f64, 14>, ..OURS },
    Backend { name: "kdop-18", prepare: kdop::<f64, 18>, ..OURS },
    Backend { name: "kdop-26", prepare: kdop::<f64, 26>, ..OURS },
    Backend { name: "kdop-scene", prepare: kdop_of_scene, ..OURS },
    Backend { name: "kdop-frame-6", prepare: |s| kdop_with::<6>(s, scene_directions(s).frame_directions()), ..OURS },
    Backend { name: "kdop-frame-14", prepare: |s| kdop_with::<14>(s, scene_directions(s).frame_directions()), ..OURS },
    Backend { name: "kdop-frame-18", prepare: |s| kdop_with::<18>(s, scene_directions(s).frame_directions()), ..OURS },
    Backend { name: "kdop-frame-26", prepare: |s| kdop_with::<26>(s, scene_directions(s).frame_directions()), ..OURS },
    Backend { name: "brute-f32", is_exhaustive: true, prepare: |s| over_soup::<f32, BruteForce<_>>(s), ..OURS_SINGLE },
    Backend { name: "octree-f32", prepare: |s| octree::<f32>(s, None, 1.0), ..OURS_SINGLE },
    Backend { name: "aabb-f32", prepare: |s| aabb::<f32>(s, None), ..OURS_SINGLE },
    Backend { name: "kdop-14-f32", prepare: kdop::<f32, 14>, ..OURS_SINGLE },
    Backend { name: "p2m-f32", prepare: |s| p2m::<f32>(s, None), ..OURS_SINGLE },
    Backend { name: YARDSTICK, scalar: ScalarKind::Single, prepare: parry_single, ..EXTERNAL },
    Backend { name: YARDSTICK_DOUBLE, prepare: parry_double, ..EXTERNAL },
    Backend { name: "bvh", prepare: bvh, ..EXTERNAL },
];

/// The backends that `query` measures by default.
pub(crate) const DEFAULT: &str = "brute,aabb,aabb-tri,aabb-f32,parry3d,parry3d-f64";

/// The external library that ratios refer to.
pub(crate) const YARDSTICK: &str = "parry3d";

/// The external library in f64, to which ratios are given as well.
pub(crate) const YARDSTICK_DOUBLE: &str = "parry3d-f64";

/// The fields that the entries of our backends in f64 have in common.
pub(crate) const OURS: Backend = Backend {
    name: "",
    scalar: ScalarKind::Double,
    is_ours: true,
    is_exhaustive: false,
    prepare: |_| Err(Unavailable("an entry without a backend".to_owned())),
};
const OURS_SINGLE: Backend = Backend { scalar: ScalarKind::Single, ..OURS };
const EXTERNAL: Backend = Backend { is_ours: false, ..OURS };

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
