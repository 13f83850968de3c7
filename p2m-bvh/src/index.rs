use crate::{PacketTree, Volume};
use nalgebra::Point3;
use p2m_core::storage::{self, LoadError, Reader, Writer};
use p2m_core::{
    Aabb, Best, BoxQuery, BuildError, BuildIndex, CertifiedQuery, Closest, ClosestLeaf, ClosestPoint, Collector, Hits,
    Inspect, Isa, Near, NearQuery, Primitive, PrimitiveId, PrimitiveSet, QueryOptions, Ray, RayCollector, RayQuery,
    Real, Shape, StatsCollector, check_set, shape_of,
};
use std::marker::PhantomData;
use std::ops::ControlFlow;

/// A [`PacketTree`] with the set that it was built over: an AABB tree or a k-DOP tree, by its volume.
///
/// # Complexity
/// Build O(n log n) expected, query O(log n) expected, O(n) at worst: equally distant primitives, queries more than
/// 2^40 sizes away, scenes smaller than 1e-96 or larger than 1e90. Memory besides the set, for any scalar: 448 bytes a
/// packet, 24 for each exact vertex of a packet, and the nodes: 256 bytes for boxes, 32 K + 32 for k-DOPs, rounded up
/// to cache lines. About 65 bytes a triangle with boxes (observed).
#[derive(Clone, Debug)]
pub struct TreeIndex<T: Real, S, V: Volume> {
    set: S,
    scalar: PhantomData<T>,
    tree: PacketTree<V>,
}

impl<T: Real, S: PrimitiveSet<T>, V: Volume> TreeIndex<T, S, V> {
    /// Builds the tree: as [`BuildIndex::build`], but also for volumes without usual options, such as k-DOPs of any K.
    ///
    /// # Errors
    /// For a coordinate that is not finite, and for more primitives than ids.
    pub fn build_with(set: S, options: &V::Options) -> Result<Self, BuildError>
    where
        S: Sync,
    {
        check_set(&set)?;
        let tree = PacketTree::build(&set, options);
        Ok(Self { set, scalar: PhantomData, tree })
    }

    /// The set it was built over.
    pub fn set(&self) -> &S {
        &self.set
    }

    /// The tree.
    pub fn tree(&self) -> &PacketTree<V> {
        &self.tree
    }

    /// Heap memory that the tree owns besides its set, in bytes.
    pub fn memory(&self) -> usize {
        self.tree.memory()
    }

    /// Fits the tree to a set of as many primitives as its own, which it then keeps: the same primitives, moved. That
    /// takes a fraction of the time of building. The tree keeps its shape, so searches get slower the further apart
    /// neighbours have moved; answers are those of a tree that is built anew. Of the options only whether all
    /// threads are used matters: directions and splits stay those that it was built with.
    ///
    /// # Errors
    /// [`BuildError::OtherLength`] and [`BuildError::NonFinite`]; the tree is then as it was.
    ///
    /// # Complexity
    /// O(n).
    pub fn refit(&mut self, set: S, options: &V::Options) -> Result<(), BuildError>
    where
        S: Sync,
    {
        if set.len() != self.set.len() {
            return Err(BuildError::OtherLength { len: set.len(), expected: self.set.len() });
        }
        check_set(&set)?;
        self.tree.refit(&set, options);
        self.set = set;
        Ok(())
    }

    /// Adds the tree to a file, without the set.
    ///
    /// # Panics
    /// If the file has an index already.
    pub fn save<'a>(&'a self, writer: &mut Writer<'a>) {
        storage::save(&self.tree, &self.set, writer);
    }

    /// The tree of a file over a set like the one that it was built over, as if it had been built.
    ///
    /// # Errors
    /// [`LoadError`].
    ///
    /// # Complexity
    /// O(n) to look at the set and copy the nodes; packets and vertices stay in the file.
    pub fn load(set: S, reader: &Reader) -> Result<Self, LoadError> {
        let tree = storage::load(&set, reader)?;
        Ok(Self { set, scalar: PhantomData, tree })
    }

    /// The same tree, searched with another instruction set. Answers do not depend on it.
    #[must_use]
    pub fn with_isa(self, isa: Isa) -> Self {
        Self { tree: self.tree.with_isa(isa), ..self }
    }

    /// Offers to any collector every primitive that it could want; [`ClosestPoint::search`] with [`Best`].
    /// `query` is finite.
    #[inline]
    pub fn visit<C: Collector>(&self, query: &Point3<T>, collector: &mut C) {
        self.tree.search(&self.set, query, collector);
    }

    /// Offers to any collector every hit that it could want; [`RayQuery::search_ray`] with [`Hits`].
    #[inline]
    pub fn visit_ray<'r, C: RayCollector<'r>>(&self, ray: &'r Ray, collector: &mut C) {
        self.tree.search_ray(&self.set, ray, collector);
    }
}

impl<T: Real, S: PrimitiveSet<T>, V: Volume> TreeIndex<T, S, V> {
    /// The directions of the faces of its volumes: those of a k-DOP tree, and `()` for an AABB tree.
    pub fn directions(&self) -> &V::Directions {
        self.tree.directions()
    }
}

impl<T: Real, S: PrimitiveSet<T>, V: Volume> Inspect<T> for TreeIndex<T, S, V> {
    fn inspect(&self, query: &Point3<T>, counting: &mut StatsCollector<T>) {
        self.visit(query, counting);
    }

    fn parts(&self) -> Vec<(&'static str, usize)> {
        vec![("tree", self.memory())]
    }
}

impl<T: Real, S: PrimitiveSet<T>, V: Volume> ClosestPoint<T> for TreeIndex<T, S, V> {
    fn search(&self, query: &Point3<T>, best: &mut Best<T>) {
        best.offer_hint(&self.set, query);
        self.tree.search_nearest(&self.set, query, best);
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
        self.tree.visit_box(&bounds.to_f64(), |id| self.set.get(id).meets_box(bounds), visit)
    }
}

impl<T: Real, S: PrimitiveSet<T>, V: Volume> ClosestLeaf<T> for TreeIndex<T, S, V> {
    fn closest_leaf(&self, query: &Point3<T>) -> Option<Closest<T>> {
        if !query.iter().all(|x| x.is_finite()) {
            return None;
        }
        let mut best = Best::new(&QueryOptions::default());
        for &id in self.tree.nearest_leaf(&query.map(T::to_f64), |aside| best.record_skipped(aside)) {
            if let Some(projection) = self.set.get(id).project_within(query, best.prune_above()) {
                best.offer(id, projection);
            }
        }
        best.finish()
    }
}

impl<T: Real, S: PrimitiveSet<T>, V: Volume> RayQuery<T> for TreeIndex<T, S, V> {
    fn search_ray<'r>(&self, ray: &'r Ray, hits: &mut Hits<'r>) {
        self.tree.search_hits(&self.set, ray, hits);
    }
}
