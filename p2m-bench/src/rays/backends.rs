//! Who answers rays.

use super::caster::{Backend, Index, Ours};
use super::rivals::{parry_double, parry_single};
use crate::backends::{aabb_options, instruction_set};
use crate::contender::{Absent, Prepared};
use crate::scene::Scene;
use anyhow::{Result, anyhow};
use p2m_bvh::AabbTree;
use p2m_bvh::{TreeIndex, Volume};
use p2m_core::{Aabb, BruteForce, BuildIndex, Isa, Soup};
use p2m_kdop::KdopOptions;
use p2m_kdop::{Directions, Kdop};

/// Every contender, in the order of the tables.
pub(crate) const ALL: &[Backend] = &[
    Backend { name: "aabb", prepare: |s| prepare::<Aabb<f64>>(s, aabb_options(), None), ..OURS },
    Backend { name: "aabb-avx512", prepare: |s| prepare::<Aabb<f64>>(s, aabb_options(), Some("avx512")), ..OURS },
    Backend { name: "aabb-avx2", prepare: |s| prepare::<Aabb<f64>>(s, aabb_options(), Some("avx2")), ..OURS },
    Backend { name: "aabb-portable", prepare: |s| prepare::<Aabb<f64>>(s, aabb_options(), Some("portable")), ..OURS },
    Backend { name: "kdop-6", prepare: |s| prepare::<Kdop<6>>(s, kdop_options(), None), ..OURS },
    Backend { name: "kdop-14", prepare: |s| prepare::<Kdop<14>>(s, kdop_options(), None), ..OURS },
    Backend { name: "kdop-18", prepare: |s| prepare::<Kdop<18>>(s, kdop_options(), None), ..OURS },
    Backend { name: "kdop-26", prepare: |s| prepare::<Kdop<26>>(s, kdop_options(), None), ..OURS },
    Backend { name: YARDSTICK, scalar: "f32", prepare: |s| parry_single(s, true) },
    Backend { name: YARDSTICK_PARAMETER, scalar: "f32", prepare: |s| parry_single(s, false) },
    Backend { name: "parry3d-f64", prepare: |s| parry_double(s, true), ..OURS },
];

/// The rival that ratios refer to: it tells triangle, parameter and normal.
pub(crate) const YARDSTICK: &str = "parry3d";

/// The same rival where it tells the parameter only, to which ratios are given as well.
pub(crate) const YARDSTICK_PARAMETER: &str = "parry3d-parameter";

/// What entries have in common.
const OURS: Backend =
    Backend { name: "", scalar: "f64", prepare: |_| Err(Absent("an entry without a contender".to_owned())) };

/// The usual directions, on one thread.
fn kdop_options<const K: usize>() -> KdopOptions<K>
where
    Directions<K>: Default,
{
    KdopOptions::default().with_splits(aabb_options())
}

/// A tree that borrows the scene, with the instruction set of that name or the best one.
fn prepare<'a, V: Volume + 'a>(
    scene: &'a Scene,
    options: V::Options,
    isa: Option<&str>,
) -> Result<Prepared<'a, Index<'a>>, Absent> {
    let isa = instruction_set(isa)?;
    let build = move || {
        let tree = TreeIndex::<f64, &Soup<f64>, V>::build_with(&scene.double, &options);
        Ok(Index::Ours(Box::new(tree.map_err(|error| Absent(error.to_string()))?.with_isa(isa))))
    };
    Ok(Prepared { build: Box::new(build), borrowed: scene.double_bytes })
}

/// Looks at everything.
pub(crate) fn brute(scene: &Scene) -> Result<Box<dyn Ours + '_>> {
    Ok(Box::new(BruteForce::new(&scene.double)?))
}

/// Every tree with every instruction set of this processor, by their names.
pub(crate) fn all_trees(scene: &Scene) -> Result<Vec<(String, Box<dyn Ours + '_>)>> {
    fn with_each<'a, V: Volume + 'a>(
        name: &str,
        tree: &TreeIndex<f64, &'a Soup<f64>, V>,
    ) -> impl Iterator<Item = (String, Box<dyn Ours + 'a>)>
    where
        TreeIndex<f64, &'a Soup<f64>, V>: Clone,
    {
        let with =
            move |isa| (format!("{name} with {isa}"), Box::new(tree.clone().with_isa(isa)) as Box<dyn Ours + 'a>);
        Isa::available().into_iter().map(with)
    }
    let soup = &scene.double;
    let mut all = Vec::new();
    all.extend(with_each("aabb", &AabbTree::build(soup, &aabb_options())?));
    all.extend(with_each("kdop-6", &TreeIndex::<_, _, Kdop<6>>::build(soup, &kdop_options())?));
    all.extend(with_each("kdop-14", &TreeIndex::<_, _, Kdop<14>>::build(soup, &kdop_options())?));
    all.extend(with_each("kdop-18", &TreeIndex::<_, _, Kdop<18>>::build(soup, &kdop_options())?));
    all.extend(with_each("kdop-26", &TreeIndex::<_, _, Kdop<26>>::build(soup, &kdop_options())?));
    Ok(all)
}

/// An entry by its name.
pub(crate) fn by_name(name: &str) -> Result<&'static Backend> {
    ALL.iter().find(|backend| backend.name == name).ok_or_else(|| anyhow!("there is no contender {name}"))
}
