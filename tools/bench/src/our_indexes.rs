//! Our indexes for the harness: those of the registry, and variants with other settings.

use crate::backend::{Answer, Backend, BenchIndex, BoxedIndex, Prepared, Scalar, ScalarKind, Unavailable};
use nalgebra::Point3;
use p2m_backends::{BackendEntry, BuildSettings, BuiltIndex, SearchStructure};
use p2m_bvh::{AabbTree, SplitOptions};
use p2m_core::batch::{self, BatchOptions, ClosestColumns};
use p2m_core::{BuildError, BuildIndex, ClosestPoint, Isa, PrimitiveId, QueryOptions, Soup};
use p2m_interception::{KdTreeLocator, OctreeIndex, OctreeOptions, P2mIndex, P2mOptions, RegionTree};
use p2m_kdop::{Directions, KdopOptions, KdopTree};
use std::fmt::Display;
use std::sync::{Arc, Mutex};

type Scene = Arc<Soup<f64>>;

/// The way in which an index answers the queries of a round.
#[derive(Clone, Copy)]
pub(crate) enum Way {
    OneByOne,
    /// By one batch on one thread, including sorting.
    Batch,
}

/// One of our indexes.
struct Ours<T, I> {
    index: I,
    way: Way,
    /// The columns of batches, which are reused as a user would do.
    columns: Mutex<(Vec<T>, Vec<u32>)>,
}

impl<T: Scalar, I: ClosestPoint<T> + Sync> BenchIndex for Ours<T, I> {
    type Scalar = T;

    #[inline(always)]
    fn query(&self, query: &Point3<T>) -> Answer {
        let closest = self.index.closest_point(query);
        closest.map_or(Answer::NONE, |c| Answer { distance: c.distance.to_f64(), id: id_of(c.primitive) })
    }

    #[inline(always)]
    fn queries(&self, queries: &[Point3<T>], answers: &mut [Answer]) {
        match self.way {
            Way::OneByOne => queries.iter().zip(answers).for_each(|(query, answer)| *answer = self.query(query)),
            Way::Batch => self.batch(queries, answers),
        }
    }
}

impl<T: Scalar, I: ClosestPoint<T> + Sync> Ours<T, I> {
    fn boxed(index: I, way: Way) -> BoxedIndex
    where
        I: 'static,
    {
        Box::new(Self { index, way, columns: Mutex::default() })
    }

    fn batch(&self, queries: &[Point3<T>], answers: &mut [Answer]) {
        let mut columns = self.columns.lock().expect("no panic while it is locked");
        let (distance, primitive) = &mut *columns;
        distance.resize(queries.len(), T::round_from_f64(0.0));
        primitive.resize(queries.len(), 0);
        let columns = ClosestColumns::default().with_distance(distance).with_primitive(primitive);
        let one_thread = BatchOptions::default().with_parallel(false);
        batch::closest_columns_into(&self.index, queries, &QueryOptions::default(), &one_thread, columns);
        for ((answer, distance), &mut id) in answers.iter_mut().zip(distance).zip(primitive) {
            let is_none = id == ClosestColumns::<T>::NO_PRIMITIVE;
            *answer = if is_none { Answer::NONE } else { Answer { distance: distance.to_f64(), id } };
        }
    }
}

#[allow(clippy::cast_possible_truncation, reason = "ids are below 2^30")]
pub(crate) fn id_of(primitive: PrimitiveId) -> u32 {
    primitive.index() as u32
}

/// Makes the backend for an entry of the registry in a scalar. Its index is built on one thread, because thread CPU
/// time is measured, and queried through a pointer.
pub(crate) fn registered(entry: &'static BackendEntry, scalar: ScalarKind, way: Way) -> Backend {
    fn ready<T: Scalar>(built: Result<BuiltIndex<T>, BuildError>, way: Way) -> Result<BoxedIndex, Unavailable> {
        Ok(Ours::boxed(built.map_err(Unavailable::because)?.index, way))
    }
    let of_scalar = if scalar == ScalarKind::Double { "" } else { "-f32" };
    let of_way = if matches!(way, Way::Batch) { "-batch" } else { "" };
    let prepare = move |scene: &crate::scene::Scene| {
        let settings = BuildSettings::default().with_parallel(false);
        if scalar == ScalarKind::Double {
            let (soup, borrowed) = (Arc::clone(&scene.double), scene.double_bytes);
            return Ok(Prepared { build: Box::new(move || ready(entry.build(soup, &settings), way)), borrowed });
        }
        let (soup, borrowed) = f32::soup(scene)?;
        let soup = Arc::clone(soup);
        Ok(Prepared { build: Box::new(move || ready(entry.build_in(soup, &settings), way)), borrowed })
    };
    let name = format!("{}{of_way}{of_scalar}", entry.name).leak();
    let is_exhaustive = entry.structure == SearchStructure::Exhaustive;
    Backend { scalar, is_exhaustive, ..Backend::new(name, prepare) }
}

/// Makes the backend for one of our indexes, with the instruction set of that name or the best one.
fn setting<I: ClosestPoint<f64> + Sync + 'static, E: Display>(
    name: &'static str,
    isa: Option<&'static str>,
    way: Way,
    build: impl Fn(Scene, Isa) -> Result<I, E> + Clone + Send + Sync + 'static,
) -> Backend {
    Backend::new(name, move |scene| {
        let found = isa.map_or(Some(Isa::best()), |isa| Isa::available().into_iter().find(|i| i.name() == isa));
        let isa = found.ok_or_else(|| Unavailable(format!("this processor has no {}", isa.unwrap_or_default())))?;
        let (soup, build) = (Arc::clone(&scene.double), build.clone());
        let build = move || Ok(Ours::boxed(build(soup, isa).map_err(Unavailable::because)?, way));
        Ok(Prepared { build: Box::new(build), borrowed: scene.double_bytes })
    })
}

/// Returns our indexes with settings that are not in the registry.
pub(crate) fn settings() -> Vec<Backend> {
    use Way::{Batch, OneByOne};
    let (avx2, portable) = (Some("avx2"), Some("portable"));
    let long = p2m_options().with_long_lists();
    let as_in_paper = P2mOptions::as_in_paper().with_splits(aabb_options());
    vec![
        setting("aabb-avx2", avx2, OneByOne, aabb),
        setting("aabb-portable", portable, OneByOne, aabb),
        setting("octree-avx2", avx2, OneByOne, octree(1.0)),
        setting("octree-portable", portable, OneByOne, octree(1.0)),
        setting("octree-fine", None, OneByOne, octree(10.0)),
        setting("octree-batch-fine", None, Batch, octree(10.0)),
        setting("octree-batch-finest", None, Batch, octree(30.0)),
        // The curve of time against memory, from 100 to 2,000 bytes per triangle.
        setting("octree-batch-x0.1", None, Batch, octree(0.1)),
        setting("octree-batch-x3", None, Batch, octree(3.0)),
        setting("octree-batch-x100", None, Batch, octree(100.0)),
        setting("octree-batch-x200", None, Batch, octree(200.0)),
        setting("octree-batch-avx2", avx2, Batch, octree(1.0)),
        setting("p2m-avx2", avx2, OneByOne, p2m(p2m_options())),
        setting("p2m-kiddo", None, OneByOne, p2m(p2m_options().with_locator(KdTreeLocator::build))),
        setting("p2m-rstar", None, OneByOne, p2m(p2m_options().with_list_filter(RegionTree::build))),
        setting("p2m-long", None, OneByOne, p2m(long)),
        setting("p2m-long-rstar", None, OneByOne, p2m(long.with_list_filter(RegionTree::build))),
        setting("p2m-paper", None, OneByOne, p2m(as_in_paper)),
        setting("kdop-6", None, OneByOne, kdop::<6>),
        setting("kdop-14", None, OneByOne, kdop::<14>),
        setting("kdop-18", None, OneByOne, kdop::<18>),
        setting("kdop-26", None, OneByOne, kdop::<26>),
    ]
}

/// Returns options that build on one thread, because thread CPU time is measured.
pub(crate) fn aabb_options() -> SplitOptions {
    SplitOptions::default().with_parallel(false)
}

/// Returns options for one thread with `factor` times the default resolution of the octree and budgets to match.
pub(crate) fn octree_options(factor: f64) -> OctreeOptions {
    OctreeOptions::default().with_splits(aabb_options()).with_finer_cells(factor)
}

/// Returns options that build the P2M index on one thread.
pub(crate) fn p2m_options() -> P2mOptions {
    P2mOptions::default().with_splits(aabb_options())
}

/// Returns options for default directions on one thread.
pub(crate) fn kdop_options<const K: usize>() -> KdopOptions<K>
where
    Directions<K>: Default,
{
    KdopOptions::default().with_splits(aabb_options())
}

fn aabb(soup: Scene, isa: Isa) -> Result<AabbTree<f64, Scene>, BuildError> {
    Ok(AabbTree::build(soup, &aabb_options())?.with_isa(isa))
}

fn kdop<const K: usize>(soup: Scene, isa: Isa) -> Result<KdopTree<f64, Scene, K>, BuildError>
where
    Directions<K>: Default,
{
    Ok(KdopTree::build_with(soup, &kdop_options())?.with_isa(isa))
}

fn octree(factor: f64) -> impl Fn(Scene, Isa) -> Result<OctreeIndex<f64, Scene>, BuildError> + Copy {
    move |soup, isa| Ok(OctreeIndex::build(soup, &octree_options(factor))?.with_isa(isa))
}

fn p2m(options: P2mOptions) -> impl Fn(Scene, Isa) -> Result<P2mIndex<f64, Scene>, BuildError> + Clone {
    move |soup, isa| Ok(P2mIndex::build(soup, &options)?.with_isa(isa))
}
