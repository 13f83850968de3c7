use crate::{Directions, Kdop, SplitOptions};
use nalgebra::Point3;
use p2m_core::hierarchy::PacketTree;
use p2m_core::{
    Aabb, Best, BoxQuery, BuildError, BuildIndex, Closest, ClosestLeaf, ClosestPoint, Collector, Isa, Primitive,
    PrimitiveId, PrimitiveSet, QueryOptions, Real, check_set,
};
use std::marker::PhantomData;
use std::ops::ControlFlow;

/// How a k-DOP tree is built: directions, and splits as for a tree of boxes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct KdopOptions<const K: usize> {
    /// The normals of its k-DOPs.
    pub directions: Directions<K>,
    /// How primitives are split.
    pub splits: SplitOptions,
}

impl<const K: usize> KdopOptions<K> {
    /// With these directions and the usual splits.
    #[must_use]
    pub fn new(directions: Directions<K>) -> Self {
        Self { directions, splits: SplitOptions::default() }
    }
    /// With other splits.
    #[must_use]
    pub fn with_splits(self, splits: SplitOptions) -> Self {
        Self { splits, ..self }
    }
}

impl<const K: usize> Default for KdopOptions<K>
where
    Directions<K>: Default,
{
    /// For K = 6, 14, 18 and 26.
    fn default() -> Self {
        Self::new(Directions::default())
    }
}

/// A k-DOP tree over a set of primitives, which it keeps.
///
/// # Complexity
/// As for a tree of boxes: build O(n log n) expected, query O(log n) expected, O(n) at worst. Memory: 384 bytes a packet, which
/// has 13 primitives of 16 on average (observed), 32 K + 32 bytes a node, rounded up to cache lines, and the exact vertices.
#[derive(Clone, Debug)]
pub struct KdopTree<T: Real, S, const K: usize> {
    set: S,
    scalar: PhantomData<T>,
    tree: PacketTree<Kdop<K>>,
}

impl<T: Real, S: PrimitiveSet<T>, const K: usize> KdopTree<T, S, K> {
    /// Builds the tree: as [`BuildIndex::build`], but for any K.
    ///
    /// # Errors
    /// For a coordinate that is not finite and for more primitives than ids.
    pub fn build_with(set: S, options: &KdopOptions<K>) -> Result<Self, BuildError>
    where
        S: Sync,
    {
        check_set(&set)?;
        let tree = PacketTree::build_kdops(&set, &options.splits, &options.directions);
        Ok(Self { set, scalar: PhantomData, tree })
    }

    /// The set it was built over.
    pub fn set(&self) -> &S {
        &self.set
    }

    /// The tree.
    pub fn tree(&self) -> &PacketTree<Kdop<K>> {
        &self.tree
    }

    /// The directions of its k-DOPs.
    pub fn directions(&self) -> &Directions<K> {
        self.tree.directions()
    }

    /// Heap memory that the tree owns besides its set, in bytes.
    pub fn memory(&self) -> usize {
        self.tree.memory()
    }

    /// Fits the tree to a set of as many primitives as its own, which it then keeps: the same primitives, moved. See
    /// [`PacketTree::refit`].
    ///
    /// # Errors
    /// [`BuildError::OtherLength`] and [`BuildError::NonFinite`]; the tree is then as it was.
    ///
    /// # Complexity
    /// O(n).
    pub fn refit(&mut self, set: S, options: &KdopOptions<K>) -> Result<(), BuildError>
    where
        S: Sync,
    {
        if set.len() != self.set.len() {
            return Err(BuildError::OtherLength { len: set.len(), expected: self.set.len() });
        }
        check_set(&set)?;
        self.tree.refit(&set, options.splits.parallel);
        self.set = set;
        Ok(())
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
}

impl<T: Real, S: PrimitiveSet<T>, const K: usize> ClosestPoint<T> for KdopTree<T, S, K> {
    fn search(&self, query: &Point3<T>, best: &mut Best<T>) {
        if let Some(id) = best.hint(self.set.len()) {
            best.offer(id, self.set.get(id).project(query));
        }
        self.visit(query, best);
    }
}

impl<T: Real, S: PrimitiveSet<T> + Sync, const K: usize> BuildIndex<T, S> for KdopTree<T, S, K>
where
    Directions<K>: Default,
{
    type Options = KdopOptions<K>;
    type Error = BuildError;

    fn build(set: S, options: &KdopOptions<K>) -> Result<Self, BuildError> {
        Self::build_with(set, options)
    }
}

impl<T: Real, S: PrimitiveSet<T>, const K: usize> BoxQuery<T> for KdopTree<T, S, K> {
    fn visit_box(&self, bounds: &Aabb<T>, visit: &mut dyn FnMut(PrimitiveId) -> ControlFlow<()>) -> ControlFlow<()> {
        self.tree.visit_box(&bounds.to_f64(), |id| self.set.get(id).meets_box(bounds), visit)
    }
}

impl<T: Real, S: PrimitiveSet<T>, const K: usize> ClosestLeaf<T> for KdopTree<T, S, K> {
    fn closest_leaf(&self, query: &Point3<T>) -> Option<Closest<T>> {
        if !query.iter().all(|x| x.is_finite()) {
            return None;
        }
        let mut best = Best::new(&QueryOptions::default());
        for &id in self.tree.nearest_leaf(&query.map(T::to_f64), |aside| best.forgo(aside)) {
            if let Some(projection) = self.set.get(id).project_within(query, best.prune_above()) {
                best.offer(id, projection);
            }
        }
        best.finish()
    }
}
