//! The index that users build and query: a tree together with its set.

use crate::traverse::groups::answer_in_groups;
use crate::traverse::interleaved_traversal::InterleavedTraversal;
use crate::{PacketTree, Volume};

use nalgebra::Point3;
use p2m_core::engine::answer_one_by_one;
use p2m_core::pair::PairQuery;
use p2m_core::storage::{self, LoadError, Reader, Writer};
use p2m_core::{
    Aabb, AnyIndex, BatchAnswer, Best, BoxQuery, BuildError, BuildIndex, CertifiedQuery, ClosestPoint, Collector, Hits,
    IndexStats, Isa, Near, NearQuery, Point, Primitive, PrimitiveId, PrimitiveSet, QueryOptions, Ray, RayCollector,
    RayQuery, Real, Refitted, Shape, Soup, check_set, shape_of,
};
use std::marker::PhantomData;
use std::ops::ControlFlow;
use std::sync::Arc;

/// A [`PacketTree`] with the set over which it was built.
///
/// The bounding volume `V` makes it an AABB tree or a k-DOP tree.
///
/// # Complexity
/// The build takes O(n log n) expected time and a query O(log n). A query takes O(n) at worst. This happens if many
/// primitives are equally distant, if the query point is more than 2^40 scene sizes away, and in scenes smaller than
/// 1e-96 or larger than 1e90.
///
/// In addition to the set, and for any scalar type, the tree takes 448 bytes per packet, 24 bytes per exact vertex of a
/// packet, and 256 bytes per node of boxes or 32 K + 32 bytes per node of k-DOPs, rounded up to cache lines. With boxes
/// that is about 65 bytes per triangle (observed).
#[derive(Clone, Debug)]
pub struct TreeIndex<T: Real, S, V: Volume> {
    set: S,
    scalar: PhantomData<T>,
    tree: PacketTree<V>,
}

impl<T: Real, S: PrimitiveSet<T>, V: Volume> TreeIndex<T, S, V> {
    /// Builds the tree over `set` with default options. Pass a reference to borrow the scene, or an `Arc` to share it.
    ///
    /// ```
    /// use p2m_bvh::AabbTree;
    /// use p2m_core::{ClosestPoint, Soup};
    ///
    /// let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    /// let scene: Soup = Soup::from_arrays(&positions, &[[0, 1, 2]])?;
    /// let tree = AabbTree::new(scene)?;
    /// assert_eq!(tree.closest_point(&[0.25, 0.25, 2.0]).unwrap().distance, 2.0);
    /// # Ok::<(), p2m_core::BuildError>(())
    /// ```
    ///
    /// # Errors
    /// Returns the errors of [`build_with`](Self::build_with).
    pub fn new(set: S) -> Result<Self, BuildError>
    where
        S: Sync,
        V::Options: Default,
    {
        Self::build_with(set, &V::Options::default())
    }

    /// Builds the tree. Unlike [`BuildIndex::build`] this also works for volumes without default options, such as
    /// k-DOPs of any K.
    ///
    /// # Errors
    /// Returns an error for a coordinate that is not finite, and for more primitives than ids.
    pub fn build_with(set: S, options: &V::Options) -> Result<Self, BuildError>
    where
        S: Sync,
    {
        let tree = PacketTree::build_checked(&set, options)?;
        Ok(Self { set, scalar: PhantomData, tree })
    }

    /// Returns the set over which the tree was built.
    pub fn set(&self) -> &S {
        &self.set
    }

    /// Returns the set and drops the tree.
    pub fn into_set(self) -> S {
        self.set
    }

    /// Returns the set and the tree over it.
    pub fn into_parts(self) -> (S, PacketTree<V>) {
        (self.set, self.tree)
    }

    /// Returns the tree without its set.
    pub fn tree(&self) -> &PacketTree<V> {
        &self.tree
    }

    /// Returns the heap memory of the tree without its set, in bytes.
    pub fn memory(&self) -> usize {
        self.tree.memory()
    }

    /// Refits the tree to a set in which the same primitives have moved, and replaces the old set.
    ///
    /// This takes a fraction of the time of a build. The tree keeps its shape, so searches get slower the farther
    /// neighbours have moved apart. Answers equal the answers of a tree that is built anew. Of the options only the
    /// choice to use all threads has an effect: the tree keeps its directions and splits.
    ///
    /// # Errors
    /// Returns [`BuildError::OtherLength`] for a set with another number of primitives, and [`BuildError::NonFinite`]
    /// for a coordinate that is not finite. The tree then stays as it was.
    ///
    /// # Complexity
    /// O(n), or the time of a build if more than sixteen primitives that had the same vertices have moved apart.
    pub fn refit(&mut self, set: S, options: &V::Options) -> Result<(), BuildError>
    where
        S: Sync,
    {
        self.check_fit(set.len())?;
        check_set(&set)?;
        self.tree.refit(&set, options);
        self.set = set;
        Ok(())
    }

    /// Changes the set in place and refits the tree to it, as [`refit`](Self::refit) does. So no second set is needed.
    ///
    /// ```
    /// use nalgebra::{Point3, Vector3};
    /// use p2m_bvh::AabbTree;
    /// use p2m_core::{ClosestPoint, Soup};
    ///
    /// let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    /// let soup: Soup<f64> = Soup::from_arrays(&positions, &[[0u32, 1, 2]])?;
    /// let mut tree = AabbTree::new(soup)?;
    /// let raised = |soup: &mut Soup<f64>| soup.map_positions(|p| p + Vector3::new(0.0, 0.0, 2.0));
    /// tree.refit_in_place(&Default::default(), raised)?;
    /// assert_eq!(tree.closest_point(&[0.0; 3]).unwrap().distance, 2.0);
    /// # Ok::<(), p2m_core::BuildError>(())
    /// ```
    ///
    /// The tree is refitted to the set even if `change` returns an error or panics, so answers always belong to the set
    /// as it is.
    ///
    /// # Errors
    /// Returns the error of `change`. Returns [`BuildError::OtherLength`] or [`BuildError::NonFinite`] if `change` left
    /// another number of primitives or a coordinate that is not finite. No tree fits such a set, so queries then find
    /// nothing, and the index has to be built anew.
    ///
    /// # Complexity
    /// O(n).
    pub fn refit_in_place(
        &mut self,
        options: &V::Options,
        change: impl FnOnce(&mut S) -> Result<(), BuildError>,
    ) -> Result<(), BuildError>
    where
        S: Sync,
    {
        let on_panic = RefitOnDrop { index: self, options };
        let changed = change(&mut on_panic.index.set);
        std::mem::forget(on_panic);
        self.refit_to_set(options)?;
        changed
    }

    /// Refits the tree to the set of the index. If no tree fits the set, the tree becomes empty.
    fn refit_to_set(&mut self, options: &V::Options) -> Result<(), BuildError>
    where
        S: Sync,
    {
        let fits = self.check_fit(self.set.len()).and_then(|()| check_set(&self.set));
        if fits.is_ok() {
            self.tree.refit(&self.set, options);
        } else {
            let nothing: [Point<f64>; 0] = [];
            self.tree = PacketTree::build(&nothing, options);
        }
        fits
    }

    /// Checks that a set of this length has as many primitives as the tree.
    fn check_fit(&self, len: usize) -> Result<(), BuildError> {
        let expected = self.tree.packets().1;
        if len == expected { Ok(()) } else { Err(BuildError::OtherLength { len, expected }) }
    }

    /// Returns the sum of the surface areas of the bounding boxes of all nodes and packets below the root, in squared
    /// units of the scene.
    ///
    /// The area is a measure of the quality of the tree for one scene. A refit keeps the shape of the tree, so the area
    /// grows as neighbours move apart. Compare it with its value after the build, and build anew when it has grown by a
    /// third ([docs/measurements/motion.md] has the figures). If the scene grows as a whole, divide the area by the
    /// square of that growth. The area is 0 for a set of up to sixteen primitives, which are one packet.
    ///
    /// # Complexity
    /// O(n).
    ///
    /// [docs/measurements/motion.md]: https://github.com/p2m-rs/p2m/blob/main/docs/measurements/motion.md
    pub fn surface_area(&self) -> f64 {
        self.tree.surface_area()
    }

    /// Adds the tree to a file, without the set.
    ///
    /// # Panics
    /// Panics if the file has an index already.
    pub fn save<'a>(&'a self, writer: &mut Writer<'a>) {
        storage::save(&self.tree, &self.set, writer);
    }

    /// Loads the tree of a file, over a set with the same primitives as the set over which it was built.
    ///
    /// # Errors
    /// Returns a [`LoadError`] if the file has no such tree, or if the tree does not fit the set.
    ///
    /// # Complexity
    /// O(n), to compare the set and copy the nodes; packets and vertices stay in the file.
    pub fn load(set: S, reader: &Reader) -> Result<Self, LoadError> {
        let tree = storage::load(&set, reader)?;
        Ok(Self { set, scalar: PhantomData, tree })
    }

    /// Returns the tree with another instruction set for its searches. Answers do not depend on it.
    #[must_use]
    pub fn with_isa(self, isa: Isa) -> Self {
        Self { tree: self.tree.with_isa(isa), ..self }
    }

    /// Offers to a collector every primitive that it may need. `query` has to be finite.
    ///
    /// [`ClosestPoint::search`] does this for the collector [`Best`].
    #[inline]
    pub fn visit<C: Collector>(&self, query: &Point3<T>, collector: &mut C) {
        self.tree.search(&self.set, query, collector);
    }

    /// Offers to a collector every hit of a ray that it may need.
    ///
    /// [`RayQuery::search_ray`] does this for the collector [`Hits`].
    #[inline]
    pub fn visit_ray<'r, C: RayCollector<'r>>(&self, ray: &'r Ray, collector: &mut C) {
        self.tree.search_ray(&self.set, ray, collector);
    }

    /// Returns the directions of the faces of all bounding volumes of a k-DOP tree, or `()` for an AABB tree.
    pub fn directions(&self) -> &V::Directions {
        self.tree.directions()
    }
}

/// A guard that refits the tree to its set when it is dropped, which happens if a change of the set panics.
struct RefitOnDrop<'a, T: Real, S: PrimitiveSet<T> + Sync, V: Volume> {
    index: &'a mut TreeIndex<T, S, V>,
    options: &'a V::Options,
}

impl<T: Real, S: PrimitiveSet<T> + Sync, V: Volume> Drop for RefitOnDrop<'_, T, S, V> {
    fn drop(&mut self) {
        // We are unwinding, so an error could not be reported.
        let _ = self.index.refit_to_set(self.options);
    }
}

impl<T: Real, S: PrimitiveSet<T>, V: Volume> IndexStats<T> for TreeIndex<T, S, V> {
    fn parts(&self) -> Vec<(&'static str, usize)> {
        vec![("tree", self.memory())]
    }
}

impl<T: Real, S: PrimitiveSet<T>, V: Volume> ClosestPoint<T> for TreeIndex<T, S, V> {
    fn search(&self, query: &Point3<T>, best: &mut Best<T>) {
        best.offer_hint(&self.set, query);
        self.tree.search_nearest(&self.set, query, best);
    }

    fn rays(&self) -> Option<&dyn RayQuery<T>> {
        Some(self)
    }

    fn answer_queries(
        &self,
        queries: &[Point3<T>],
        options: &QueryOptions<T>,
        answered: &mut dyn FnMut(usize, BatchAnswer<'_, T>),
    ) {
        match InterleavedTraversal::new(&self.tree) {
            Some(mut walkers) if !options.is_approximate() => {
                answer_in_groups(&self.tree, &self.set, queries, options, answered, |count, several| {
                    V::nearest_of_several(&self.tree, &mut walkers, several, count);
                });
            }
            _ => answer_one_by_one(self, queries, options, answered),
        }
    }
}

impl<T: Real, S: PrimitiveSet<T> + Send + Sync, V: Volume> AnyIndex<T> for TreeIndex<T, S, V> {
    fn save<'s>(&'s self, writer: &mut Writer<'s>) {
        self.save(writer);
    }

    fn primitive_count(&self) -> usize {
        self.set.len()
    }

    fn memory_bytes(&self) -> usize {
        self.memory()
    }

    fn as_ray_query(&self) -> Option<&(dyn RayQuery<T> + Sync)> {
        Some(self)
    }

    fn as_box_query(&self) -> Option<&(dyn BoxQuery<T> + Sync)> {
        Some(self)
    }

    fn as_pair_query(&self) -> Option<&(dyn PairQuery<T> + Sync)> {
        Some(self)
    }

    fn refitted(&self, soup: Arc<Soup<T>>) -> Option<Refitted<T>> {
        let refitted = self.check_fit(soup.len()).and_then(|()| check_set(&soup)).map(|()| {
            let mut tree = self.tree.clone();
            tree.refit_with(&soup, true);
            Arc::new(TreeIndex { set: soup, scalar: PhantomData, tree }) as Arc<dyn AnyIndex<T>>
        });
        Some(refitted)
    }

    fn surface_area(&self) -> Option<f64> {
        Some(self.surface_area())
    }
}

impl<T: Real, S: PrimitiveSet<T>, V: Volume> NearQuery<T> for TreeIndex<T, S, V> {
    fn search_near(&self, query: &Point3<T>, near: &mut Near<'_>) {
        self.tree.search_near(&self.set, query, near);
    }
}

impl<T: Real, S: PrimitiveSet<T>, V: Volume> CertifiedQuery<T> for TreeIndex<T, S, V> {
    fn shape(&self, id: PrimitiveId) -> Option<Shape<T>> {
        shape_of(&self.set, id)
    }
}

impl<T: Real, S: PrimitiveSet<T> + Sync, V: Volume> BuildIndex<T, S> for TreeIndex<T, S, V>
where
    V::Options: Default,
{
    type Options = V::Options;
    type Error = BuildError;

    fn build(set: S, options: &V::Options) -> Result<Self, BuildError> {
        Self::build_with(set, options)
    }
}

impl<T: Real, S: PrimitiveSet<T>, V: Volume> BoxQuery<T> for TreeIndex<T, S, V> {
    fn visit_box(&self, bounds: &Aabb<T>, visit: &mut dyn FnMut(PrimitiveId) -> ControlFlow<()>) -> ControlFlow<()> {
        self.tree.visit_box(&bounds.to_f64(), |id| self.set.get(id).intersects_box(bounds), visit)
    }
}

impl<T: Real, S: PrimitiveSet<T>, V: Volume> RayQuery<T> for TreeIndex<T, S, V> {
    fn search_ray<'r>(&self, ray: &'r Ray, hits: &mut Hits<'r>) {
        self.tree.search_ray(&self.set, ray, hits);
    }

    fn visit_ray_candidates(&self, ray: &Ray, visit: &mut dyn FnMut(PrimitiveId, &[[f64; 3]]) -> f64) {
        self.tree.search_ray_candidates(ray, visit);
    }
}

#[cfg(feature = "serde")]
impl<T: Real, S: PrimitiveSet<T> + serde::Serialize, V: Volume> serde::Serialize for TreeIndex<T, S, V> {
    fn serialize<Z: serde::Serializer>(&self, serializer: Z) -> Result<Z::Ok, Z::Error> {
        storage::serialize_index(&self.tree, &self.set, serializer)
    }
}

#[cfg(feature = "serde")]
impl<'de, T: Real, S: PrimitiveSet<T> + serde::Deserialize<'de>, V: Volume> serde::Deserialize<'de>
    for TreeIndex<T, S, V>
{
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let (set, tree) = storage::deserialize_index(deserializer)?;
        Ok(Self { set, scalar: PhantomData, tree })
    }
}
