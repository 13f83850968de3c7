use crate::AabbOptions;
use nalgebra::Point3;
use p2m_core::hierarchy::PacketTree;
use p2m_core::{
    Aabb, Best, BoxQuery, BuildError, BuildIndex, Closest, ClosestLeaf, ClosestPoint, Collector, Isa, Primitive,
    PrimitiveId, PrimitiveSet, QueryOptions, Real, check_set,
};
use std::marker::PhantomData;
use std::ops::ControlFlow;

/// An AABB tree over a set of primitives, which it keeps.
///
/// Nodes of eight boxes over packets of sixteen primitives, see [`PacketTree`].
///
/// # Complexity
/// Build O(n log n) expected, query O(log n) expected, O(n) at worst: equally distant primitives, queries more than 2^40 sizes
/// away, scenes smaller than 1e-96 or larger than 1e90. Memory besides the set, for any scalar: 448 bytes a packet, 24 for each exact
/// vertex of a packet, 256 a node; about 65 bytes a triangle (observed).
#[derive(Clone, Debug)]
pub struct AabbTree<T: Real, S> {
    set: S,
    scalar: PhantomData<T>,
    tree: PacketTree,
}

impl<T: Real, S: PrimitiveSet<T>> AabbTree<T, S> {
    /// The set it was built over.
    pub fn set(&self) -> &S {
        &self.set
    }

    /// The tree.
    pub fn tree(&self) -> &PacketTree {
        &self.tree
    }

    /// Heap memory that the tree owns besides its set, in bytes.
    pub fn memory(&self) -> usize {
        self.tree.memory()
    }

    /// Fits the tree to a set of as many primitives as its own, which it then keeps: the same primitives, moved. That takes
    /// a fraction of the time of building. The tree keeps its shape, so searches get slower the further apart neighbours have
    /// moved; answers are those of a tree that is built anew.
    ///
    /// # Errors
    /// [`BuildError::OtherLength`] and [`BuildError::NonFinite`]; the tree is then as it was.
    ///
    /// # Complexity
    /// O(n).
    pub fn refit(&mut self, set: S, options: &AabbOptions) -> Result<(), BuildError>
    where
        S: Sync,
    {
        if set.len() != self.set.len() {
            return Err(BuildError::OtherLength { len: set.len(), expected: self.set.len() });
        }
        check_set(&set)?;
        self.tree.refit(&set, options.parallel);
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

impl<T: Real, S: PrimitiveSet<T>> ClosestPoint<T> for AabbTree<T, S> {
    fn search(&self, query: &Point3<T>, best: &mut Best<T>) {
        if let Some(id) = best.hint(self.set.len()) {
            best.offer(id, self.set.get(id).project(query));
        }
        self.visit(query, best);
    }
}

impl<T: Real, S: PrimitiveSet<T> + Sync> BuildIndex<T, S> for AabbTree<T, S> {
    type Options = AabbOptions;
    type Error = BuildError;

    fn build(set: S, options: &AabbOptions) -> Result<Self, BuildError> {
        check_set(&set)?;
        let tree = PacketTree::build(&set, options);
        Ok(Self { set, scalar: PhantomData, tree })
    }
}

impl<T: Real, S: PrimitiveSet<T>> BoxQuery<T> for AabbTree<T, S> {
    fn visit_box(&self, bounds: &Aabb<T>, visit: &mut dyn FnMut(PrimitiveId) -> ControlFlow<()>) -> ControlFlow<()> {
        self.tree.visit_box(&bounds.to_f64(), |id| self.set.get(id).meets_box(bounds), visit)
    }
}

impl<T: Real, S: PrimitiveSet<T>> ClosestLeaf<T> for AabbTree<T, S> {
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
