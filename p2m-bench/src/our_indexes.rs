//! Builds our indexes for the harness: a function for each index and setting of the list of backends.

use crate::backend::{Answer, BenchIndex, BoxedIndex, Prepared, Scalar, Unavailable};
use crate::bvh_crate;
use crate::scene::Scene;
use nalgebra::Point3;
use p2m_bvh::{AabbOptions, AabbTree};
use p2m_core::{BuildIndex, Closest, ClosestPoint, Isa, PrimitiveId, PrimitiveSet, QueryOptions, Soup};
use p2m_interception::{InterceptionIndex, Octree, OctreeOptions, P2mOptions, Partition, Voronoi};
use p2m_kdop::{DirectionChoice, Directions, DirectionsError, KdopOptions, KdopTree};
use std::marker::PhantomData;

/// An index of ours that is queried through the trait [`ClosestPoint`], one query at a time.
struct OneByOne<T, I>(I, PhantomData<fn() -> T>);

impl<T: Scalar, I: ClosestPoint<T> + Sync> BenchIndex for OneByOne<T, I> {
    type Scalar = T;

    #[inline(always)]
    fn query(&self, query: &Point3<T>) -> Answer {
        answer(self.0.closest_point(query))
    }
}

/// An index of ours that is queried through the trait [`ClosestPoint`], several queries at a time.
struct InBatches<T, I>(I, PhantomData<fn() -> T>);

/// The number of queries in a batch of [`InBatches`].
const QUERIES_PER_BATCH: usize = 256;

impl<T: Scalar, I: ClosestPoint<T> + Sync> BenchIndex for InBatches<T, I> {
    type Scalar = T;

    fn query(&self, query: &Point3<T>) -> Answer {
        answer(self.0.closest_point(query))
    }

    fn queries(&self, queries: &[Point3<T>], answers: &mut [Answer]) {
        let mut closest = [None; QUERIES_PER_BATCH];
        for (queries, answers) in queries.chunks(QUERIES_PER_BATCH).zip(answers.chunks_mut(QUERIES_PER_BATCH)) {
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

/// Builds an index over a set.
pub(crate) fn build<'a, T, I, S>(set: S, options: &I::Options) -> Result<BoxedIndex<'a>, Unavailable>
where
    T: Scalar,
    S: PrimitiveSet<T>,
    I: BuildIndex<T, S> + Sync + 'a,
{
    let index = I::build(set, options).map_err(|error| Unavailable(error.to_string()))?;
    Ok(Box::new(OneByOne(index, PhantomData::<fn() -> T>)))
}

/// Prepares an index with default options that borrows the scene as it is.
pub(crate) fn over_soup<'a, T, I>(scene: &'a Scene) -> Result<Prepared<'a>, Unavailable>
where
    T: Scalar,
    I: BuildIndex<T, &'a Soup<T>> + Sync + 'a,
{
    over_soup_with::<T, I>(scene, I::Options::default())
}

/// Prepares an index with the given options that borrows the scene as it is.
pub(crate) fn over_soup_with<'a, T, I>(scene: &'a Scene, options: I::Options) -> Result<Prepared<'a>, Unavailable>
where
    T: Scalar,
    I: BuildIndex<T, &'a Soup<T>> + Sync + 'a,
{
    let (soup, borrowed) = T::soup(scene)?;
    Ok(Prepared { build: Box::new(move || build::<T, I, _>(soup, &options)), borrowed })
}

/// Returns options that build on one thread, because thread CPU time is measured.
pub(crate) fn aabb_options() -> AabbOptions {
    AabbOptions::default().with_parallel(false)
}

/// Returns the instruction set of that name, or the best one if no name is given.
pub(crate) fn instruction_set(name: Option<&str>) -> Result<Isa, Unavailable> {
    let Some(name) = name else { return Ok(Isa::best()) };
    let isa = Isa::available().into_iter().find(|isa| isa.name() == name);
    isa.ok_or_else(|| Unavailable(format!("this processor has no {name}")))
}

/// Returns options for one thread with `factor` times the default resolution of the octree and budgets to match.
pub(crate) fn octree_options(factor: f64) -> OctreeOptions {
    let default = OctreeOptions::default();
    let budget = factor.max(1.0);
    default
        .with_splits(aabb_options())
        .with_resolution(default.resolution * factor)
        .with_memory(default.memory * budget)
        .with_work(default.work * budget)
}

/// Returns options that build the P2M index on one thread.
pub(crate) fn p2m_options() -> P2mOptions {
    P2mOptions::default().with_splits(aabb_options())
}

/// Prepares an interception index with the instruction set of that name or the best one.
fn interception<'a, T, P>(scene: &'a Scene, isa: Option<&str>, options: P::Options) -> Result<Prepared<'a>, Unavailable>
where
    T: Scalar,
    P: Partition<Options: 'a> + Sync + 'a,
{
    let isa = instruction_set(isa)?;
    let (soup, borrowed) = T::soup(scene)?;
    let build = move || {
        let index = InterceptionIndex::<T, _, P>::build(soup, &options);
        let index = index.map_err(|error| Unavailable(error.to_string()))?;
        Ok(Box::new(OneByOne(index.with_isa(isa), PhantomData::<fn() -> T>)) as BoxedIndex<'a>)
    };
    Ok(Prepared { build: Box::new(build), borrowed })
}

/// Prepares the octree with an instruction set and a multiple of the default resolution.
pub(crate) fn octree<'a, T: Scalar>(
    scene: &'a Scene,
    isa: Option<&str>,
    factor: f64,
) -> Result<Prepared<'a>, Unavailable> {
    interception::<T, Octree>(scene, isa, octree_options(factor))
}

/// Prepares the P2M index with an instruction set.
pub(crate) fn p2m<'a, T: Scalar>(scene: &'a Scene, isa: Option<&str>) -> Result<Prepared<'a>, Unavailable> {
    interception::<T, Voronoi>(scene, isa, p2m_options())
}

/// Prepares the P2M index with the given options.
pub(crate) fn p2m_with(scene: &Scene, options: P2mOptions) -> Result<Prepared<'_>, Unavailable> {
    interception::<f64, Voronoi>(scene, None, options)
}

/// Returns options as in the paper: no site is added, and lists may be long.
pub(crate) fn long_lists() -> P2mOptions {
    p2m_options().with_max_list_packets(2048).with_max_extra_sites(0.0).with_memory(1e5).with_work(1e6)
}

/// Prepares the P2M index for batches of queries.
pub(crate) fn p2m_in_batches(scene: &Scene) -> Result<Prepared<'_>, Unavailable> {
    let (soup, borrowed) = f64::soup(scene)?;
    let build = move || {
        let index = InterceptionIndex::<f64, _, Voronoi>::build(soup, &p2m_options());
        let index = index.map_err(|error| Unavailable(error.to_string()))?;
        Ok(Box::new(InBatches(index, PhantomData::<fn() -> f64>)) as BoxedIndex<'_>)
    };
    Ok(Prepared { build: Box::new(build), borrowed })
}

/// Prepares the AABB tree with the instruction set of that name or the best one.
pub(crate) fn aabb<'a, T: Scalar>(scene: &'a Scene, isa: Option<&str>) -> Result<Prepared<'a>, Unavailable> {
    let isa = instruction_set(isa)?;
    let (soup, borrowed) = T::soup(scene)?;
    let build = move || {
        let tree = AabbTree::build(soup, &aabb_options()).map_err(|error| Unavailable(error.to_string()))?;
        Ok(Box::new(OneByOne(tree.with_isa(isa), PhantomData::<fn() -> T>)) as BoxedIndex<'a>)
    };
    Ok(Prepared { build: Box::new(build), borrowed })
}

/// Prepares the k-DOP tree with default directions.
pub(crate) fn kdop<T: Scalar, const K: usize>(scene: &Scene) -> Result<Prepared<'_>, Unavailable>
where
    Directions<K>: Default,
{
    over_soup_with::<T, KdopTree<T, _, K>>(scene, KdopOptions::default().with_splits(aabb_options()))
}

/// Prepares the k-DOP tree with 14 directions that the scene calls for; choosing them is not timed.
pub(crate) fn kdop_of_scene(scene: &Scene) -> Result<Prepared<'_>, Unavailable> {
    kdop_with::<14>(scene, scene_directions(scene).directions())
}

/// Prepares the tree of the crate bvh, with a distance function of our own.
pub(crate) fn bvh(scene: &Scene) -> Result<Prepared<'_>, Unavailable> {
    let build = bvh_crate::tree(scene);
    Ok(Prepared { build: Box::new(move || Ok(Box::new(build()?) as BoxedIndex<'_>)), borrowed: 0 })
}

/// Prepares the k-DOP tree with the given directions.
pub(crate) fn kdop_with<const K: usize>(
    scene: &Scene,
    directions: Result<Directions<K>, DirectionsError>,
) -> Result<Prepared<'_>, Unavailable> {
    let directions = directions.map_err(|error| Unavailable(error.to_string()))?;
    let (soup, borrowed) = f64::soup(scene)?;
    let options = KdopOptions::new(directions).with_splits(aabb_options());
    let build = move || {
        let tree = KdopTree::build_with(soup, &options).map_err(|error| Unavailable(error.to_string()))?;
        Ok(Box::new(OneByOne(tree, PhantomData::<fn() -> f64>)) as BoxedIndex<'_>)
    };
    Ok(Prepared { build: Box::new(build), borrowed })
}

/// Returns the directions that the scene calls for.
pub(crate) fn scene_directions(scene: &Scene) -> DirectionChoice {
    DirectionChoice::from_scene(&scene.double).expect("a scene is finite")
}
