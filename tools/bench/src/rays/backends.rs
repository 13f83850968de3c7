//! The list of backends that cast rays.

use super::backend::{OurCaster, RayBackend, RayIndex};
use super::external::{parry_double, parry_single};
use crate::backend::{Prepared, Unavailable};
use crate::our_indexes::{aabb_options, instruction_set};
use crate::scene::Scene;
use anyhow::Result;
use p2m_bvh::AabbTree;
use p2m_bvh::{TreeIndex, Volume};
use p2m_core::{Aabb, BruteForce, BuildIndex, Isa, Soup};
use p2m_kdop::KdopOptions;
use p2m_kdop::{Directions, Kdop};

/// Every backend, in the order of the tables.
pub(crate) const ALL: &[RayBackend] = &[
    RayBackend { name: "aabb", prepare: |s| prepare::<Aabb<f64>>(s, aabb_options(), None), ..OURS },
    RayBackend { name: "aabb-avx512", prepare: |s| prepare::<Aabb<f64>>(s, aabb_options(), Some("avx512")), ..OURS },
    RayBackend { name: "aabb-avx2", prepare: |s| prepare::<Aabb<f64>>(s, aabb_options(), Some("avx2")), ..OURS },
    RayBackend {
        name: "aabb-portable",
        prepare: |s| prepare::<Aabb<f64>>(s, aabb_options(), Some("portable")),
        ..OURS
    },
    RayBackend { name: "kdop-6", prepare: |s| prepare::<Kdop<6>>(s, kdop_options(), None), ..OURS },
    RayBackend { name: "kdop-14", prepare: |s| prepare::<Kdop<14>>(s, kdop_options(), None), ..OURS },
    RayBackend { name: "kdop-18", prepare: |s| prepare::<Kdop<18>>(s, kdop_options(), None), ..OURS },
    RayBackend { name: "kdop-26", prepare: |s| prepare::<Kdop<26>>(s, kdop_options(), None), ..OURS },
    RayBackend { name: YARDSTICK, scalar: "f32", prepare: |s| parry_single(s, true) },
    RayBackend { name: YARDSTICK_PARAMETER, scalar: "f32", prepare: |s| parry_single(s, false) },
    RayBackend { name: "parry3d-f64", prepare: |s| parry_double(s, true), ..OURS },
];

/// The external library that ratios refer to; it returns the triangle, the parameter and the normal.
pub(crate) const YARDSTICK: &str = "parry3d";

/// The external library where it returns the parameter alone, to which ratios are given as well.
pub(crate) const YARDSTICK_PARAMETER: &str = "parry3d-parameter";

/// The fields that entries have in common.
const OURS: RayBackend =
    RayBackend { name: "", scalar: "f64", prepare: |_| Err(Unavailable("an entry without a competitor".to_owned())) };

/// Returns options for default directions on one thread.
fn kdop_options<const K: usize>() -> KdopOptions<K>
where
    Directions<K>: Default,
{
    KdopOptions::default().with_splits(aabb_options())
}

/// Prepares a tree that borrows the scene, with the instruction set of that name or the best one.
fn prepare<'a, V: Volume + 'a>(
    scene: &'a Scene,
    options: V::Options,
    isa: Option<&str>,
) -> Result<Prepared<'a, RayIndex<'a>>, Unavailable> {
    let isa = instruction_set(isa)?;
    let build = move || {
        let tree = TreeIndex::<f64, &Soup<f64>, V>::build_with(&*scene.double, &options);
        Ok(RayIndex::Ours(Box::new(tree.map_err(|error| Unavailable(error.to_string()))?.with_isa(isa))))
    };
    Ok(Prepared { build: Box::new(build), borrowed: scene.double_bytes })
}

/// Builds brute force over a scene.
pub(crate) fn brute(scene: &Scene) -> Result<Box<dyn OurCaster + '_>> {
    Ok(Box::new(BruteForce::new(&*scene.double)?))
}

/// Builds every tree with every instruction set of this processor, and returns them with their names.
pub(crate) fn all_trees(scene: &Scene) -> Result<Vec<(String, Box<dyn OurCaster + '_>)>> {
    fn with_each<'a, V: Volume + 'a>(
        name: &str,
        tree: &TreeIndex<f64, &'a Soup<f64>, V>,
    ) -> impl Iterator<Item = (String, Box<dyn OurCaster + 'a>)>
    where
        TreeIndex<f64, &'a Soup<f64>, V>: Clone,
    {
        let with =
            move |isa| (format!("{name} with {isa}"), Box::new(tree.clone().with_isa(isa)) as Box<dyn OurCaster + 'a>);
        Isa::available().into_iter().map(with)
    }
    let soup = &*scene.double;
    let mut all = Vec::new();
    all.extend(with_each("aabb", &AabbTree::build(soup, &aabb_options())?));
    all.extend(with_each("kdop-6", &TreeIndex::<_, _, Kdop<6>>::build(soup, &kdop_options())?));
    all.extend(with_each("kdop-14", &TreeIndex::<_, _, Kdop<14>>::build(soup, &kdop_options())?));
    all.extend(with_each("kdop-18", &TreeIndex::<_, _, Kdop<18>>::build(soup, &kdop_options())?));
    all.extend(with_each("kdop-26", &TreeIndex::<_, _, Kdop<26>>::build(soup, &kdop_options())?));
    Ok(all)
}
