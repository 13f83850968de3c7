use crate::AabbOptions;
use nalgebra::Point3;
use p2m_core::hierarchy::{Hierarchy, Overlap};
use p2m_core::{
    Aabb, Best, BoxQuery, BuildError, BuildIndex, Closest, ClosestLeaf, ClosestPoint, Collector, Primitive,
    PrimitiveId, PrimitiveSet, QueryOptions, Real, check_set,
};
use std::ops::ControlFlow;

/// The box of a node.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct NodeBox<T: Real> {
    /// Around everything below the node.
    pub bounds: Aabb<T>,
    /// How far below the root, which is at 0.
    pub depth: usize,
    /// How many primitives it has as a leaf; 0 for an inner node.
    pub primitives: usize,
}

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

    /// The boxes of all nodes, parents before children: for pictures and statistics.
    pub fn boxes(&self) -> impl Iterator<Item = NodeBox<T>> + '_ {
        let of_node = |(node, depth): (&p2m_core::hierarchy::Node<Aabb<T>>, u8)| NodeBox {
            bounds: node.volume,
            depth: usize::from(depth),
            primitives: node.places().len(),
        };
        self.hierarchy.nodes().iter().zip(self.hierarchy.depths()).map(of_node)
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

impl<T: Real, S: PrimitiveSet<T>> BoxQuery<T> for AabbTree<T, S> {
    fn visit_box(&self, bounds: &Aabb<T>, visit: &mut dyn FnMut(PrimitiveId) -> ControlFlow<()>) -> ControlFlow<()> {
        if bounds.is_empty() {
            return ControlFlow::Continue(());
        }
        let of_node = |node: &Aabb<T>| {
            if !bounds.meets(node) {
                Overlap::None
            } else if bounds.contains(node) {
                Overlap::All
            } else {
                Overlap::Some
            }
        };
        self.hierarchy.visit_overlapping(of_node, |id| self.set.get(id).meets_box(bounds), visit)
    }
}

impl<T: Real, S: PrimitiveSet<T>> ClosestLeaf<T> for AabbTree<T, S> {
    fn closest_leaf(&self, query: &Point3<T>) -> Option<Closest<T>> {
        if !query.iter().all(|x| x.is_finite()) {
            return None;
        }
        let mut best = Best::new(&QueryOptions::default());
        let leaf = self.hierarchy.nearest_leaf(|bounds| bounds.lower_bound(query), |aside| best.forgo(aside));
        for &id in leaf {
            self.offer(query, id, &mut best);
        }
        best.finish()
    }
}
