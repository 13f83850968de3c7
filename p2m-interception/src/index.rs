//! The index: a partition together with the set that it was built over.

use crate::list::interleaved_lists::InterleavedLists;
use crate::octree::Octree;
use crate::options::{OctreeOptions, RefinementProgress};
use crate::partition::Partition;
use crate::progress::Progress;
use crate::voronoi::Voronoi;
use nalgebra::Point3;
use p2m_bvh::AabbTree;
use p2m_bvh::engine::interleaved::answer_in_groups;
use p2m_core::engine::answer_one_by_one;
use p2m_core::storage::{self, LoadError, Reader, Saved, Writer};
use p2m_core::{
    AnyIndex, BatchAnswer, Best, BuildError, BuildIndex, CellSummary, CertifiedQuery, ClosestPoint, Collector,
    IndexStats, Isa, Near, NearQuery, PrimitiveId, PrimitiveSet, QueryOptions, Real, Shape, check_set, shape_of,
};
use std::marker::PhantomData;
use std::ops::ControlFlow;

/// An interception index whose cells are cubes.
///
/// The AABB tree over the same packets answers queries outside of the domain
/// ([`OctreeOptions::domain`](crate::OctreeOptions::domain)) and collectors of more than the nearest primitive.
///
/// # Methods
///
/// The alias has the methods of [`InterceptionIndex`] and the traits of queries:
///
/// - [`build`](BuildIndex::build) and [`build_with_progress`](InterceptionIndex::build_with_progress) build it with
///   [`OctreeOptions`](crate::OctreeOptions), and [`build_until`](OctreeIndex::build_until) ends the build early.
/// - [`closest_point`](ClosestPoint::closest_point),
///   [`closest_point_with`](ClosestPoint::closest_point_with) and
///   [`closest_points_into`](ClosestPoint::closest_points_into) return the nearest primitive;
///   [`NearQuery`] and [`CertifiedQuery`] have the other queries.
/// - [`save`](InterceptionIndex::save) and [`load`](InterceptionIndex::load) write it to a file and read it.
/// - [`set`](InterceptionIndex::set) and [`partition`](InterceptionIndex::partition) return its parts,
///   [`report`](InterceptionIndex::report) its statistics ([`OctreeReport`](crate::OctreeReport)), and
///   [`memory`](InterceptionIndex::memory) its size.
/// - [`visit`](InterceptionIndex::visit) searches with any [`Collector`], and
///   [`with_isa`](InterceptionIndex::with_isa) selects the instruction set.
///
/// # Complexity
/// A query takes O(log n) steps to its cell and then searches the list of the cell. The list has a few packets,
/// independently of n, wherever cells could be made small enough.
/// # Examples
/// ```
/// use nalgebra::Point3;
/// use p2m_core::{BuildIndex, ClosestPoint, Point};
/// use p2m_interception::{OctreeIndex, OctreeOptions};
///
/// let scene: Vec<_> = (0..100).map(|i| Point::new(Point3::new(f64::from(i), 0.0, 0.0))).collect();
/// let options = OctreeOptions::default().with_finer_cells(30.0); // for batches of many millions of queries
/// let index = OctreeIndex::<f64, _>::build(&scene, &options)?;
/// let answer = index.closest_point(&[41.75, 3.0, 0.0]).expect("the scene is not empty");
/// assert_eq!(answer.primitive.index(), 42);
/// # Ok::<(), p2m_core::BuildError>(())
/// ```
pub type OctreeIndex<T, S> = InterceptionIndex<T, S, Octree>;

/// An interception index whose cells are the Voronoi cells of the scene's vertices.
///
/// The AABB tree over the same packets answers queries that are farther from the scene than five of its sizes, and
/// collectors of more than the nearest primitive.
///
/// # Methods
///
/// The alias has the methods of [`InterceptionIndex`] and the traits of queries:
///
/// - [`build`](BuildIndex::build) and [`build_with_progress`](InterceptionIndex::build_with_progress) build it with
///   [`P2mOptions`](crate::P2mOptions).
/// - [`closest_point`](ClosestPoint::closest_point),
///   [`closest_point_with`](ClosestPoint::closest_point_with) and
///   [`closest_points_into`](ClosestPoint::closest_points_into) return the nearest primitive;
///   [`NearQuery`] and [`CertifiedQuery`] have the other queries.
/// - [`save`](InterceptionIndex::save) and [`load`](InterceptionIndex::load) write it to a file and read it.
/// - [`set`](InterceptionIndex::set) and [`partition`](InterceptionIndex::partition) return its parts,
///   [`report`](InterceptionIndex::report) its statistics ([`P2mReport`](crate::P2mReport)), and
///   [`memory`](InterceptionIndex::memory) its size.
/// - [`visit`](InterceptionIndex::visit) searches with any [`Collector`], and
///   [`with_isa`](InterceptionIndex::with_isa) selects the instruction set.
///
/// # Complexity
/// A query begins at a site that a grid returns, takes a few steps to its cell and then searches the list of the cell.
///
/// # References
/// \[Zong2023\]
/// # Examples
/// ```
/// use nalgebra::Point3;
/// use p2m_core::{ClosestPoint, Point};
/// use p2m_interception::P2mIndex;
///
/// let scene: Vec<_> = (0..100).map(|i| Point::new(Point3::new(f64::from(i), 0.0, 0.0))).collect();
/// let index = P2mIndex::<f64, _>::new(&scene)?;
/// let far = index.closest_point(&[42.0, 400.0, 300.0]).expect("the scene is not empty");
/// assert_eq!((far.primitive.index(), far.distance), (42, 500.0));
/// # Ok::<(), p2m_core::BuildError>(())
/// ```
pub type P2mIndex<T, S> = InterceptionIndex<T, S, Voronoi>;

/// An interception index over a set of primitives, which it stores.
///
/// [`OctreeIndex`] and [`P2mIndex`] are the aliases for the two partitions.
#[derive(Clone, Debug)]
pub struct InterceptionIndex<T: Real, S, P> {
    /// The set of primitives.
    set: S,
    /// The scalar of the set.
    scalar: PhantomData<T>,
    /// The cells with their lists, and the tree.
    partition: P,
}

impl<T: Real, S: PrimitiveSet<T>, P: Partition> InterceptionIndex<T, S, P> {
    /// Builds the index over `set` with default options. Pass a reference to borrow the scene, or an `Arc` to share it.
    ///
    /// # Errors
    /// Same as [`build_with`](Self::build_with).
    pub fn new(set: S) -> Result<Self, BuildError>
    where
        S: Sync,
    {
        Self::build_with(set, &P::Options::default())
    }

    /// Builds the index with `options`.
    ///
    /// # Errors
    /// [`BuildError::NonFinite`] for a coordinate that is not finite, and [`BuildError::TooMany`] for more
    /// than 2^30 primitives.
    pub fn build_with(set: S, options: &P::Options) -> Result<Self, BuildError>
    where
        S: Sync,
    {
        Self::build_with_progress(set, options, &|_| ())
    }

    /// Builds the index as [`BuildIndex::build`] and reports the progress. `progress` is called for each stage that
    /// begins, from the calling thread, and for each percent, from any thread. [`StageTimes`](crate::StageTimes) sums
    /// the times of the stages.
    ///
    /// # Errors
    ///
    /// It fails if a coordinate is not finite, and if there are more primitives than ids.
    pub fn build_with_progress(
        set: S,
        options: &P::Options,
        progress: &(dyn Fn(Progress) + Sync),
    ) -> Result<Self, BuildError>
    where
        S: Sync,
    {
        check_set(&set)?;
        let partition = P::build(&set, options, progress);
        Ok(Self { set, scalar: PhantomData, partition })
    }

    /// Returns the set that the index was built over.
    pub fn set(&self) -> &S {
        &self.set
    }

    /// Returns the set and drops the index.
    pub fn into_set(self) -> S {
        self.set
    }

    /// Returns the cells with their lists, without the set.
    pub fn partition(&self) -> &P {
        &self.partition
    }

    /// Returns the statistics of the cells.
    pub fn report(&self) -> P::Report {
        self.partition.report()
    }

    /// Returns the heap memory that the index owns besides its set, in bytes.
    pub fn memory(&self) -> usize {
        self.partition.memory()
    }

    /// Selects the instruction set of searches. Answers do not depend on it.
    #[must_use]
    pub fn with_isa(self, isa: Isa) -> Self {
        Self { partition: self.partition.with_isa(isa), ..self }
    }

    /// Offers to any collector every primitive that it may need. [`ClosestPoint::search`] does this with a [`Best`].
    /// `query` has to be finite.
    #[inline]
    pub fn visit<C: Collector>(&self, query: &Point3<T>, collector: &mut C) {
        self.partition.search(&self.set, query, collector);
    }
}

impl<T: Real, S: PrimitiveSet<T>, P: Saved> InterceptionIndex<T, S, P> {
    /// Adds the cells to a file, without the set.
    ///
    /// # Panics
    ///
    /// It panics if the file has an index already.
    pub fn save<'a>(&'a self, writer: &mut Writer<'a>) {
        storage::save(&self.partition, &self.set, writer);
    }

    /// Loads the cells of a file over a set that equals the one they were built over. The index answers as if it
    /// had been built.
    ///
    /// # Errors
    ///
    /// It returns a [`LoadError`] if the file is damaged, has another kind of index, or belongs to another set.
    ///
    /// # Complexity
    ///
    /// It takes O(n) to compare the set and to copy the nodes of the tree. The large arrays stay in the file.
    pub fn load(set: S, reader: &Reader) -> Result<Self, LoadError> {
        let partition = storage::load(&set, reader)?;
        Ok(Self { set, scalar: PhantomData, partition })
    }
}

impl<T: Real, S: PrimitiveSet<T>, P: Partition> IndexStats<T> for InterceptionIndex<T, S, P> {
    fn parts(&self) -> Vec<(&'static str, usize)> {
        self.partition.parts()
    }

    fn list_lengths(&self) -> Vec<usize> {
        self.partition.list_lengths()
    }

    fn list_length(&self, point: &Point3<T>) -> Option<usize> {
        self.partition.list(&point.map(Real::to_f64)).map(|list| list.len())
    }
}

impl<T: Real, S: PrimitiveSet<T>, P: Partition> ClosestPoint<T> for InterceptionIndex<T, S, P> {
    fn search(&self, query: &Point3<T>, best: &mut Best<T>) {
        best.offer_hint(&self.set, query);
        self.partition.search_nearest(&self.set, query, best);
    }

    fn answer_queries(
        &self,
        queries: &[Point3<T>],
        options: &QueryOptions<T>,
        answered: &mut dyn FnMut(usize, BatchAnswer<'_, T>),
    ) {
        if options.is_approximate() {
            // Searches that take turns do not count the sites that they visit, which the options may limit.
            return answer_one_by_one(self, queries, options, answered);
        }
        let (partition, mut lists) = (&self.partition, InterleavedLists::default());
        answer_in_groups(partition.tree(), &self.set, queries, options, answered, |count, several| {
            partition.search_several(count, several, &mut lists);
        });
    }
}

impl<T: Real, S: PrimitiveSet<T> + Send + Sync, P: Partition + Saved + Send + Sync> AnyIndex<T>
    for InterceptionIndex<T, S, P>
{
    fn save<'s>(&'s self, writer: &mut Writer<'s>) {
        self.save(writer);
    }

    fn primitive_count(&self) -> usize {
        self.set.len()
    }

    fn memory_bytes(&self) -> usize {
        self.memory()
    }

    fn cells(&self) -> Option<CellSummary> {
        Some(self.report().into())
    }
}

impl<T: Real, S: PrimitiveSet<T>, P: Partition> NearQuery<T> for InterceptionIndex<T, S, P> {
    fn search_near(&self, query: &Point3<T>, near: &mut Near<'_>) {
        self.partition.search_near(&self.set, query, near);
    }
}

impl<T: Real, S: PrimitiveSet<T>, P: Partition> CertifiedQuery<T> for InterceptionIndex<T, S, P> {
    fn shape(&self, id: PrimitiveId) -> Option<Shape<T>> {
        shape_of(&self.set, id)
    }
}

impl<T: Real, S: PrimitiveSet<T> + Sync, P: Partition> BuildIndex<T, S> for InterceptionIndex<T, S, P> {
    type Options = P::Options;
    type Error = BuildError;

    fn build(set: S, options: &P::Options) -> Result<Self, BuildError> {
        Self::build_with_progress(set, options, &|_| ())
    }
}

impl<T: Real, S: PrimitiveSet<T> + Sync> OctreeIndex<T, S> {
    /// Builds the index as [`build_with_progress`](InterceptionIndex::build_with_progress) does, until `visit` ends its
    /// refinement. The index is complete then and gives the same answers as any other index, but its cells are coarser,
    /// so queries take longer.
    ///
    /// `visit` is called between the chunks of the refinement, from the calling thread, with the size that the octree
    /// would have if its refinement ended now. Other threads work on the next chunks meanwhile. After it returned
    /// [`ControlFlow::Break`], the cells that would have been split get their lists, which takes a part of the time
    /// that was spent so far. The index depends only on how many calls `visit` continued, and not on the number of
    /// threads.
    ///
    /// ```
    /// use nalgebra::Point3;
    /// use p2m_core::{ClosestPoint, Segment};
    /// use p2m_interception::{OctreeIndex, OctreeOptions};
    /// use std::ops::ControlFlow;
    ///
    /// let wire = |i: i32| Segment::new(Point3::new(f64::from(i), 0.0, 0.0), Point3::new(f64::from(i), 9.0, 2.0));
    /// let wires: Vec<Segment<f64>> = (0..1000).map(wire).collect();
    /// let index = OctreeIndex::build_until(&wires[..], &OctreeOptions::default(), &|_| (), &mut |so_far| {
    ///     if so_far.cells < 500 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    /// })?;
    /// assert!(index.report().list_cells < 5000);
    /// assert_eq!(index.closest_point(&Point3::new(7.0, -1.0, 0.0)).expect("not empty").distance, 1.0);
    /// # Ok::<(), p2m_core::BuildError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// It fails if a coordinate is not finite, and if there are more primitives than ids.
    pub fn build_until(
        set: S,
        options: &OctreeOptions,
        progress: &(dyn Fn(Progress) + Sync),
        visit: &mut dyn FnMut(&RefinementProgress) -> ControlFlow<()>,
    ) -> Result<Self, BuildError> {
        check_set(&set)?;
        let partition = Octree::build_until(&set, options, progress, visit);
        Ok(Self { set, scalar: PhantomData, partition })
    }

    /// Builds the index that [`build_until`](Self::build_until) builds over the set of a tree. The tree becomes a part
    /// of the index.
    pub fn build_on(
        tree: AabbTree<T, S>,
        options: &OctreeOptions,
        progress: &(dyn Fn(Progress) + Sync),
        visit: &mut dyn FnMut(&RefinementProgress) -> ControlFlow<()>,
    ) -> Self {
        let (set, tree) = tree.into_parts();
        let partition = Octree::build_on(tree, &set, options, progress, visit);
        Self { set, scalar: PhantomData, partition }
    }
}

#[cfg(feature = "serde")]
impl<T: Real, S: PrimitiveSet<T> + serde::Serialize, P: Saved> serde::Serialize for InterceptionIndex<T, S, P> {
    fn serialize<Z: serde::Serializer>(&self, serializer: Z) -> Result<Z::Ok, Z::Error> {
        storage::serialize_index(&self.partition, &self.set, serializer)
    }
}

#[cfg(feature = "serde")]
impl<'de, T: Real, S: PrimitiveSet<T> + serde::Deserialize<'de>, P: Saved> serde::Deserialize<'de>
    for InterceptionIndex<T, S, P>
{
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let (set, partition) = storage::deserialize_index(deserializer)?;
        Ok(Self { set, scalar: PhantomData, partition })
    }
}
