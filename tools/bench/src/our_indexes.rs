//! Builds our indexes for the harness: a function for each index and setting of the list of backends.

use crate::backend::{Answer, BenchIndex, BoxedIndex, Prepared, Scalar, ScalarKind, Unavailable};
use crate::scene::Scene;
use nalgebra::Point3;
use p2m_backends::{AnyIndex, BackendEntry, BuildSettings, BuiltIndex};
use p2m_bvh::{AabbTree, SplitOptions};
use p2m_core::batch::{self, BatchOptions, ClosestColumns};
use p2m_core::{BuildError, BuildIndex, Closest, ClosestPoint, Isa, PrimitiveId, QueryOptions, Soup};
use p2m_interception::{OctreeIndex, OctreeOptions, P2mIndex, P2mOptions};
use p2m_kdop::{DirectionChoice, Directions, DirectionsError, KdopOptions, KdopTree};
use std::fmt::Display;
use std::sync::Arc;

/// An index of ours that is queried through the trait [`ClosestPoint`], one query at a time.
struct OneByOne<I>(I);

impl<I: ClosestPoint<f64> + Sync> BenchIndex for OneByOne<I> {
    type Scalar = f64;

    #[inline(always)]
    fn query(&self, query: &Point3<f64>) -> Answer {
        answer(self.0.closest_point(query))
    }
}

/// An index of the registry, which is queried through a pointer.
struct Registered<T: Scalar>(Arc<dyn AnyIndex<T>>);

impl<T: Scalar> BenchIndex for Registered<T> {
    type Scalar = T;

    #[inline(always)]
    fn query(&self, query: &Point3<T>) -> Answer {
        answer(self.0.closest_point(query))
    }
}

/// An index of ours that answers all queries of a round by one batch call on one thread, ordering included.
struct InOneBatch<I>(I);

impl<I: ClosestPoint<f64> + Sync> BenchIndex for InOneBatch<I> {
    type Scalar = f64;

    fn query(&self, query: &Point3<f64>) -> Answer {
        answer(self.0.closest_point(query))
    }

    fn queries(&self, queries: &[Point3<f64>], answers: &mut [Answer]) {
        let (mut distance, mut primitive) = (vec![0.0; queries.len()], vec![0; queries.len()]);
        let columns = ClosestColumns::default().with_distance(&mut distance).with_primitive(&mut primitive);
        let one_thread = BatchOptions::default().with_parallel(false);
        batch::closest_columns_into(&self.0, queries, &QueryOptions::default(), &one_thread, columns);
        for ((answer, distance), id) in answers.iter_mut().zip(distance).zip(primitive) {
            let is_none = id == ClosestColumns::<f64>::NO_PRIMITIVE;
            *answer = if is_none { Answer::NONE } else { Answer { distance, id } };
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

/// Prepares an index over a set that borrows so many bytes of the scene.
pub(crate) fn over_set<'a, S, I, E>(
    set: S,
    borrowed: usize,
    build: impl FnOnce(S) -> Result<I, E> + 'a,
) -> Result<Prepared<'a>, Unavailable>
where
    S: 'a,
    I: ClosestPoint<f64> + Sync + 'a,
    E: Display,
{
    Ok(prepared(set, borrowed, build, OneByOne))
}

/// Prepares an index over a set, to be queried in the way of `harness`.
fn prepared<'a, S: 'a, I: 'a, E: Display, H: BenchIndex + 'a>(
    set: S,
    borrowed: usize,
    build: impl FnOnce(S) -> Result<I, E> + 'a,
    harness: fn(I) -> H,
) -> Prepared<'a> {
    let build = move || {
        let index = build(set).map_err(|error| Unavailable(error.to_string()))?;
        Ok(Box::new(harness(index)) as BoxedIndex<'a>)
    };
    Prepared { build: Box::new(build), borrowed }
}

/// Prepares an index that borrows the scene as it is.
fn over_scene<'a, I, E>(
    scene: &'a Scene,
    build: impl FnOnce(&'a Soup<f64>) -> Result<I, E> + 'a,
) -> Result<Prepared<'a>, Unavailable>
where
    I: ClosestPoint<f64> + Sync + 'a,
    E: Display,
{
    over_set(&*scene.double, scene.double_bytes, build)
}

/// Prepares an index with the given options that borrows the scene as it is.
pub(crate) fn over_soup_with<'a, I>(scene: &'a Scene, options: I::Options) -> Result<Prepared<'a>, Unavailable>
where
    I: BuildIndex<f64, &'a Soup<f64>, Error: Display> + Sync + 'a,
{
    over_scene(scene, move |soup| I::build(soup, &options))
}

/// Prepares the index of an entry of the registry in a scalar, which is built on one thread, because thread CPU time is
/// measured.
pub(crate) fn registered<'a>(
    entry: &'static BackendEntry,
    scene: &'a Scene,
    scalar: ScalarKind,
) -> Result<Prepared<'a>, Unavailable> {
    fn ready<T: Scalar>(built: Result<BuiltIndex<T>, BuildError>) -> Result<BoxedIndex<'static>, Unavailable> {
        let built = built.map_err(|error| Unavailable(error.to_string()))?;
        Ok(Box::new(Registered(built.index)))
    }
    let settings = BuildSettings::default().with_parallel(false);
    match scalar {
        ScalarKind::Double => {
            let (soup, borrowed) = f64::soup(scene)?;
            Ok(Prepared { build: Box::new(move || ready(entry.build(Arc::clone(soup), &settings))), borrowed })
        }
        ScalarKind::Single => {
            let (soup, borrowed) = f32::soup(scene)?;
            Ok(Prepared { build: Box::new(move || ready(entry.build_f32(Arc::clone(soup), &settings))), borrowed })
        }
    }
}

/// Returns options that build on one thread, because thread CPU time is measured.
pub(crate) fn aabb_options() -> SplitOptions {
    SplitOptions::default().with_parallel(false)
}

/// Returns the instruction set of that name, or the best one if no name is given.
pub(crate) fn instruction_set(name: Option<&str>) -> Result<Isa, Unavailable> {
    let Some(name) = name else { return Ok(Isa::best()) };
    let isa = Isa::available().into_iter().find(|isa| isa.name() == name);
    isa.ok_or_else(|| Unavailable(format!("this processor has no {name}")))
}

/// Returns options for one thread with `factor` times the default resolution of the octree and budgets to match.
pub(crate) fn octree_options(factor: f64) -> OctreeOptions {
    OctreeOptions::default().with_splits(aabb_options()).with_finer_cells(factor)
}

/// Returns options that build the P2M index on one thread.
pub(crate) fn p2m_options() -> P2mOptions {
    P2mOptions::default().with_splits(aabb_options())
}

/// Returns options as in the paper: no site is added, and lists may be long.
pub(crate) fn long_lists() -> P2mOptions {
    p2m_options().with_long_lists()
}

/// Prepares the octree with an instruction set and a multiple of the default resolution.
pub(crate) fn octree<'a>(scene: &'a Scene, isa: Option<&str>, factor: f64) -> Result<Prepared<'a>, Unavailable> {
    let isa = instruction_set(isa)?;
    over_scene(scene, move |soup| Ok::<_, BuildError>(OctreeIndex::build(soup, &octree_options(factor))?.with_isa(isa)))
}

/// Prepares the P2M index with an instruction set and the given options.
pub(crate) fn p2m<'a>(scene: &'a Scene, isa: Option<&str>, options: P2mOptions) -> Result<Prepared<'a>, Unavailable> {
    let isa = instruction_set(isa)?;
    over_scene(scene, move |soup| Ok::<_, BuildError>(P2mIndex::build(soup, &options)?.with_isa(isa)))
}

/// Prepares an index that answers all queries by one batch call.
fn in_one_batch<'a, I, E>(
    scene: &'a Scene,
    build: impl FnOnce(&'a Soup<f64>) -> Result<I, E> + 'a,
) -> Result<Prepared<'a>, Unavailable>
where
    I: ClosestPoint<f64> + Sync + 'a,
    E: Display,
{
    Ok(prepared(&*scene.double, scene.double_bytes, build, InOneBatch))
}

/// Prepares the AABB tree with the instruction set of that name for one batch call.
pub(crate) fn aabb_in_batch<'a>(scene: &'a Scene, isa: Option<&str>) -> Result<Prepared<'a>, Unavailable> {
    let isa = instruction_set(isa)?;
    in_one_batch(scene, move |soup| Ok::<_, BuildError>(AabbTree::build(soup, &aabb_options())?.with_isa(isa)))
}

/// Prepares the k-DOP tree with 14 default directions for one batch call.
pub(crate) fn kdop_in_batch(scene: &Scene) -> Result<Prepared<'_>, Unavailable> {
    let options = KdopOptions::new(Directions::<14>::default()).with_splits(aabb_options());
    in_one_batch(scene, move |soup| KdopTree::build_with(soup, &options))
}

/// Prepares the octree with the instruction set of that name for one batch call.
pub(crate) fn octree_in_batch<'a>(
    scene: &'a Scene,
    isa: Option<&str>,
    factor: f64,
) -> Result<Prepared<'a>, Unavailable> {
    let isa = instruction_set(isa)?;
    let options = octree_options(factor);
    in_one_batch(scene, move |soup| Ok::<_, BuildError>(OctreeIndex::build(soup, &options)?.with_isa(isa)))
}

/// Prepares the P2M index with the instruction set of that name for one batch call.
pub(crate) fn p2m_in_batch<'a>(scene: &'a Scene, isa: Option<&str>) -> Result<Prepared<'a>, Unavailable> {
    let isa = instruction_set(isa)?;
    in_one_batch(scene, move |soup| Ok::<_, BuildError>(P2mIndex::build(soup, &p2m_options())?.with_isa(isa)))
}

/// Prepares the AABB tree with the instruction set of that name.
pub(crate) fn aabb<'a>(scene: &'a Scene, isa: Option<&str>) -> Result<Prepared<'a>, Unavailable> {
    let isa = instruction_set(isa)?;
    over_scene(scene, move |soup| Ok::<_, BuildError>(AabbTree::build(soup, &aabb_options())?.with_isa(isa)))
}

/// Prepares the k-DOP tree with default directions.
pub(crate) fn kdop<const K: usize>(scene: &Scene) -> Result<Prepared<'_>, Unavailable>
where
    Directions<K>: Default,
{
    kdop_with::<K>(scene, Ok(Directions::default()))
}

/// Prepares the k-DOP tree with 14 directions that the scene calls for; choosing them is not timed.
pub(crate) fn kdop_of_scene(scene: &Scene) -> Result<Prepared<'_>, Unavailable> {
    kdop_with::<14>(scene, scene_directions(scene).directions())
}

/// Prepares the k-DOP tree with K directions in the frame that the scene calls for.
pub(crate) fn kdop_in_frame<const K: usize>(scene: &Scene) -> Result<Prepared<'_>, Unavailable> {
    kdop_with::<K>(scene, scene_directions(scene).frame_directions())
}

fn kdop_with<const K: usize>(
    scene: &Scene,
    directions: Result<Directions<K>, DirectionsError>,
) -> Result<Prepared<'_>, Unavailable> {
    let directions = directions.map_err(|error| Unavailable(error.to_string()))?;
    let options = KdopOptions::new(directions).with_splits(aabb_options());
    over_scene(scene, move |soup| KdopTree::build_with(soup, &options))
}

/// Returns the directions that the scene calls for.
pub(crate) fn scene_directions(scene: &Scene) -> DirectionChoice {
    DirectionChoice::from_scene(&*scene.double).expect("a scene is finite")
}
