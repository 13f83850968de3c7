//! Our contenders, and the list of all. A new backend is one entry of [`ALL`].

use crate::bvh_crate;
use crate::contender::{Absent, Answer, Backend, Contender, Prepared, Ready, Scalar, ScalarKind};
use crate::kinds::{aabb_by_kind, aabb_of_set, aabb_of_triangles};
use crate::rivals::{parry_double, parry_single};
use crate::scene::Scene;
use nalgebra::Point3;
use p2m_bvh::{AabbOptions, AabbTree};
use p2m_core::{BruteForce, BuildIndex, Closest, ClosestPoint, Isa, PrimitiveId, PrimitiveSet, QueryOptions, Soup};
use p2m_interception::{
    InterceptionIndex, KdTreeLocator, Octree, OctreeOptions, P2mOptions, Partition, RegionTree, Voronoi,
};
use p2m_kdop::{DirectionChoice, KdopOptions, KdopTree};
use p2m_kdop::{Directions, DirectionsError};
use p2m_mixed::adapters::{ParryIndex, RstarIndex};
use std::marker::PhantomData;

/// Every contender, in the order of the tables.
pub(crate) const ALL: &[Backend] = &[
    Backend { name: "brute", exhaustive: true, prepare: |s| over_soup::<f64, BruteForce<_>>(s), ..OURS },
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
    Backend { name: "kdop-frame-6", prepare: |s| kdop_with::<6>(s, frame(s).frame_directions()), ..OURS },
    Backend { name: "kdop-frame-14", prepare: |s| kdop_with::<14>(s, frame(s).frame_directions()), ..OURS },
    Backend { name: "kdop-frame-18", prepare: |s| kdop_with::<18>(s, frame(s).frame_directions()), ..OURS },
    Backend { name: "kdop-frame-26", prepare: |s| kdop_with::<26>(s, frame(s).frame_directions()), ..OURS },
    Backend { name: "brute-f32", exhaustive: true, prepare: |s| over_soup::<f32, BruteForce<_>>(s), ..OURS_SINGLE },
    Backend { name: "octree-f32", prepare: |s| octree::<f32>(s, None, 1.0), ..OURS_SINGLE },
    Backend { name: "aabb-f32", prepare: |s| aabb::<f32>(s, None), ..OURS_SINGLE },
    Backend { name: "kdop-14-f32", prepare: kdop::<f32, 14>, ..OURS_SINGLE },
    Backend { name: "p2m-f32", prepare: |s| p2m::<f32>(s, None), ..OURS_SINGLE },
    Backend { name: YARDSTICK, scalar: ScalarKind::Single, prepare: parry_single, ..RIVAL },
    Backend { name: YARDSTICK_DOUBLE, prepare: parry_double, ..RIVAL },
    Backend { name: "bvh", prepare: bvh, ..RIVAL },
];

/// What `query` measures unless told otherwise.
pub(crate) const DEFAULT: &str = "brute,aabb,aabb-tri,aabb-f32,parry3d,parry3d-f64";

/// The rival that ratios refer to.
pub(crate) const YARDSTICK: &str = "parry3d";

/// The rival of our precision, to which ratios are given as well.
pub(crate) const YARDSTICK_DOUBLE: &str = "parry3d-f64";

/// What entries of ours have in common.
pub(crate) const OURS: Backend = Backend {
    name: "",
    scalar: ScalarKind::Double,
    ours: true,
    exhaustive: false,
    prepare: |_| Err(Absent("an entry without a contender".to_owned())),
};
const OURS_SINGLE: Backend = Backend { scalar: ScalarKind::Single, ..OURS };
const RIVAL: Backend = Backend { ours: false, ..OURS };

/// An index of ours, asked through the trait.
struct Ours<T, I>(I, PhantomData<fn() -> T>);

impl<T: Scalar, I: ClosestPoint<T> + Sync> Contender for Ours<T, I> {
    type Scalar = T;

    #[inline(always)]
    fn query(&self, query: &Point3<T>) -> Answer {
        answer(self.0.closest_point(query))
    }
}

/// The same, asked for several queries at a time.
struct Batches<T, I>(I, PhantomData<fn() -> T>);

/// Queries of a batch.
const BATCH: usize = 256;

impl<T: Scalar, I: ClosestPoint<T> + Sync> Contender for Batches<T, I> {
    type Scalar = T;

    fn query(&self, query: &Point3<T>) -> Answer {
        answer(self.0.closest_point(query))
    }

    fn queries(&self, queries: &[Point3<T>], answers: &mut [Answer]) {
        let mut closest = [None; BATCH];
        for (queries, answers) in queries.chunks(BATCH).zip(answers.chunks_mut(BATCH)) {
            let closest = &mut closest[..queries.len()];
            self.0.closest_points_into(queries, &QueryOptions::default(), closest);
            answers.iter_mut().zip(closest).for_each(|(to, closest)| *to = answer(*closest));
        }
    }
}

#[inline(always)]
fn answer<T: Scalar>(closest: Option<Closest<T>>) -> Answer {
    closest.map_or(Answer::NONE, |c| Answer { distance: c.distance.to_f64(), id: id_of(c.primitive) })
}

#[allow(clippy::cast_possible_truncation, reason = "ids are below 2^30")]
pub(crate) fn id_of(primitive: PrimitiveId) -> u32 {
    primitive.index() as u32
}

/// An index over a set.
pub(crate) fn build<'a, T, I, S>(set: S, options: &I::Options) -> Result<Ready<'a>, Absent>
where
    T: Scalar,
    S: PrimitiveSet<T>,
    I: BuildIndex<T, S> + Sync + 'a,
{
    let index = I::build(set, options).map_err(|error| Absent(error.to_string()))?;
    Ok(Box::new(Ours(index, PhantomData::<fn() -> T>)))
}

/// An index with default options that borrows the scene as it is.
fn over_soup<'a, T, I>(scene: &'a Scene) -> Result<Prepared<'a>, Absent>
where
    T: Scalar,
    I: BuildIndex<T, &'a Soup<T>> + Sync + 'a,
{
    over_soup_with::<T, I>(scene, I::Options::default())
}

/// The same with other options.
pub(crate) fn over_soup_with<'a, T, I>(scene: &'a Scene, options: I::Options) -> Result<Prepared<'a>, Absent>
where
    T: Scalar,
    I: BuildIndex<T, &'a Soup<T>> + Sync + 'a,
{
    let (soup, borrowed) = T::soup(scene)?;
    Ok(Prepared { build: Box::new(move || build::<T, I, _>(soup, &options)), borrowed })
}

/// What is timed is one thread's work.
pub(crate) fn aabb_options() -> AabbOptions {
    AabbOptions::default().with_parallel(false)
}

/// The instruction set of that name; the best one without.
pub(crate) fn instruction_set(name: Option<&str>) -> Result<Isa, Absent> {
    let Some(name) = name else { return Ok(Isa::best()) };
    let isa = Isa::available().into_iter().find(|isa| isa.name() == name);
    isa.ok_or_else(|| Absent(format!("this processor has no {name}")))
}

/// So many times the usual resolution of the octree, and budgets to match, on one thread.
pub(crate) fn octree_options(times: f64) -> OctreeOptions {
    let usual = OctreeOptions::default();
    let budget = times.max(1.0);
    usual
        .with_splits(aabb_options())
        .with_resolution(usual.resolution * times)
        .with_memory(usual.memory * budget)
        .with_work(usual.work * budget)
}

/// The P2M index on one thread.
pub(crate) fn p2m_options() -> P2mOptions {
    P2mOptions::default().with_splits(aabb_options())
}

/// An interception index, with the instruction set of that name or the best one.
fn cells<'a, T, P>(scene: &'a Scene, isa: Option<&str>, options: P::Options) -> Result<Prepared<'a>, Absent>
where
    T: Scalar,
    P: Partition<Options: 'a> + Sync + 'a,
{
    let isa = instruction_set(isa)?;
    let (soup, borrowed) = T::soup(scene)?;
    let build = move || {
        let index = InterceptionIndex::<T, _, P>::build(soup, &options);
        let index = index.map_err(|error| Absent(error.to_string()))?;
        Ok(Box::new(Ours(index.with_isa(isa), PhantomData::<fn() -> T>)) as Ready<'a>)
    };
    Ok(Prepared { build: Box::new(build), borrowed })
}

/// The octree, with an instruction set and so many times the usual resolution.
fn octree<'a, T: Scalar>(scene: &'a Scene, isa: Option<&str>, times: f64) -> Result<Prepared<'a>, Absent> {
    cells::<T, Octree>(scene, isa, octree_options(times))
}

/// The P2M index, with an instruction set.
fn p2m<'a, T: Scalar>(scene: &'a Scene, isa: Option<&str>) -> Result<Prepared<'a>, Absent> {
    cells::<T, Voronoi>(scene, isa, p2m_options())
}

/// The P2M index with options of its own.
fn p2m_with(scene: &Scene, options: P2mOptions) -> Result<Prepared<'_>, Absent> {
    cells::<f64, Voronoi>(scene, None, options)
}

/// As in the paper: no site is added, and lists may be long.
fn long_lists() -> P2mOptions {
    p2m_options().with_max_list_packets(2048).with_max_extra_sites(0.0).with_memory(1e5).with_work(1e6)
}

/// The P2M index, asked for several queries at a time.
fn p2m_in_batches(scene: &Scene) -> Result<Prepared<'_>, Absent> {
    let (soup, borrowed) = f64::soup(scene)?;
    let build = move || {
        let index = InterceptionIndex::<f64, _, Voronoi>::build(soup, &p2m_options());
        let index = index.map_err(|error| Absent(error.to_string()))?;
        Ok(Box::new(Batches(index, PhantomData::<fn() -> f64>)) as Ready<'_>)
    };
    Ok(Prepared { build: Box::new(build), borrowed })
}

/// The AABB tree, with the instruction set of that name or the best one.
fn aabb<'a, T: Scalar>(scene: &'a Scene, isa: Option<&str>) -> Result<Prepared<'a>, Absent> {
    let isa = instruction_set(isa)?;
    let (soup, borrowed) = T::soup(scene)?;
    let build = move || {
        let tree = AabbTree::build(soup, &aabb_options()).map_err(|error| Absent(error.to_string()))?;
        Ok(Box::new(Ours(tree.with_isa(isa), PhantomData::<fn() -> T>)) as Ready<'a>)
    };
    Ok(Prepared { build: Box::new(build), borrowed })
}

/// The k-DOP tree of the usual directions.
fn kdop<T: Scalar, const K: usize>(scene: &Scene) -> Result<Prepared<'_>, Absent>
where
    Directions<K>: Default,
{
    over_soup_with::<T, KdopTree<T, _, K>>(scene, KdopOptions::default().with_splits(aabb_options()))
}

/// The k-DOP tree of what the scene requires; choosing is not part of the time.
fn kdop_of_scene(scene: &Scene) -> Result<Prepared<'_>, Absent> {
    let choice = frame(scene);
    match choice.k {
        6 => kdop_with::<6>(scene, choice.directions()),
        14 => kdop_with::<14>(scene, choice.directions()),
        18 => kdop_with::<18>(scene, choice.directions()),
        _ => kdop_with::<26>(scene, choice.directions()),
    }
}

/// The crate bvh, with a distance of its own.
fn bvh(scene: &Scene) -> Result<Prepared<'_>, Absent> {
    let build = bvh_crate::tree(scene);
    Ok(Prepared { build: Box::new(move || Ok(Box::new(build()?) as Ready<'_>)), borrowed: 0 })
}

/// The k-DOP tree of these directions.
fn kdop_with<const K: usize>(
    scene: &Scene,
    directions: Result<Directions<K>, DirectionsError>,
) -> Result<Prepared<'_>, Absent> {
    let directions = directions.map_err(|error| Absent(error.to_string()))?;
    let (soup, borrowed) = f64::soup(scene)?;
    let options = KdopOptions::new(directions).with_splits(aabb_options());
    let build = move || {
        let tree = KdopTree::build_with(soup, &options).map_err(|error| Absent(error.to_string()))?;
        Ok(Box::new(Ours(tree, PhantomData::<fn() -> f64>)) as Ready<'_>)
    };
    Ok(Prepared { build: Box::new(build), borrowed })
}

/// An entry by its name.
pub(crate) fn kdop_backend(name: &str) -> &'static Backend {
    ALL.iter().find(|backend| backend.name == name).expect("a name of the list")
}

/// What the scene requires.
pub(crate) fn frame(scene: &Scene) -> DirectionChoice {
    DirectionChoice::from_scene(&scene.double).expect("a scene is finite")
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
