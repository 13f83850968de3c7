use crate::AabbOptions;
use nalgebra::Point3;
use p2m_core::hierarchy::Hierarchy;
use p2m_core::{
    Aabb, Best, BuildError, BuildIndex, ClosestPoint, Collector, Primitive, PrimitiveId, PrimitiveSet, Real, check_set,
};

/// An AABB tree over a set of primitives, which it keeps.
///
/// # Complexity
/// Build O(n log n) expected, query O(log n) expected, O(n) at worst. Memory: at most 2 n - 1 nodes with a box each
/// (56 bytes in f64, 32 in f32) and 4 bytes a primitive, besides the set.
#[derive(Clone, Debug)]
pub struct AabbTree<T: Real, S> {
    set: S,
    hierarchy: Hierarchy<Aabb<T>>,
}

impl<T: Real, S: PrimitiveSet<T>> AabbTree<T, S> {
    /// The set it was built over.
    pub fn set(&self) -> &S {
        &self.set
    }

    /// The box around everything, `None` for an empty set.
    pub fn bounds(&self) -> Option<&Aabb<T>> {
        self.hierarchy.nodes().first().map(|root| &root.volume)
    }

    /// Heap memory that the tree owns besides its set, in bytes.
    pub fn memory(&self) -> usize {
        self.hierarchy.memory()
    }

    /// Offers to any collector every primitive that it could want; [`ClosestPoint::search`] with [`Best`].
    /// `query` is finite.
    #[inline]
    pub fn visit<C: Collector>(&self, query: &Point3<T>, collector: &mut C) {
        self.hierarchy.search(
            collector,
            |bounds| bounds.lower_bound(query),
            |collector, id| self.offer(query, id, collector),
        );
    }

    #[inline(always)]
    fn offer<C: Collector>(&self, query: &Point3<T>, id: PrimitiveId, collector: &mut C) {
        if let Some(projection) = self.set.get(id).project_within(query, collector.prune_above()) {
            collector.offer(id, projection);
        }
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

impl<T: Real, S: PrimitiveSet<T>> BuildIndex<T, S> for AabbTree<T, S> {
    type Options = AabbOptions;
    type Error = BuildError;

    fn build(set: S, options: &AabbOptions) -> Result<Self, BuildError> {
        check_set(&set)?;
        let boxes: Vec<Aabb<T>> = (0..set.len()).map(|i| set.get(PrimitiveId::new(i)).aabb()).collect();
        let hierarchy = Hierarchy::build(&boxes, options, |id| boxes[id.index()], Aabb::union);
        Ok(Self { set, hierarchy })
    }
}
