//! The bounding volumes of a tree.

use crate::construct::primitive::BuildPrimitive;
use crate::construct::{SplitOptions, TreeOptions};
use crate::packet::Members;
use crate::traverse::evaluate::{finish, finish_nearest};
use crate::traverse::interleaved_search::InterleavedSearch;
use crate::traverse::interleaved_traversal::InterleavedTraversal;
use crate::traverse::pairs::TreeSide;
use crate::traverse::primitive_fn::{EvaluateFn, evaluation, intersection};
use crate::traverse::ray::{ExactTests, RaySearch, TestFn};
use crate::tree::PacketTree;
use crate::tree::wide_node::VolumeNodes;
use nalgebra::Point3;
use p2m_core::engine::pairs::PairSide;
use p2m_core::engine::query::BestF64;
use p2m_core::engine::real::to_f64_array;
use p2m_core::engine::vector::V3;
use p2m_core::pair::Motion;
use p2m_core::storage::{LoadError, Reader, Saved, Writer};
use p2m_core::{Aabb, Best, Near, PrimitiveId, PrimitiveSet, Ray, RayCollector, Real};

/// The bounding volume of the nodes of a [`PacketTree`]: [`Aabb<f64>`] or a k-DOP of the crate p2m-kdop.
///
/// The trait is sealed, because searches rely on proofs about the rounding of the nodes. Everything else about a tree
/// is the same for all volumes.
///
/// Hidden methods search a tree with the collectors of the library. They depend neither on the set nor on the scalar
/// type, so they are compiled once for each volume, in the crate that defines it, and not in every crate that calls
/// them (decision 013).
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a bounding volume of trees",
    note = "volumes are `Aabb<f64>` and k-DOPs with an even K from 6 to 26"
)]
pub trait Volume: VolumeNodes {
    /// The options for building a tree.
    type Options: TreeOptions<Self::Shared>;
    /// The directions of the faces of all volumes of a tree, or `()` for boxes, which need none.
    type Directions;

    /// Returns the directions of the faces, from the data that all volumes of a tree share.
    fn directions(shared: &Self::Shared) -> &Self::Directions;

    /// Searches for the nearest primitive.
    #[doc(hidden)]
    #[inline(never)]
    fn nearest(tree: &PacketTree<Self>, query: V3, minimum: &mut BestF64, evaluate: EvaluateFn<'_, BestF64>) {
        tree.run(query, minimum, evaluate, finish_nearest);
    }

    /// Runs the first `count` searches of `several` in turns.
    #[doc(hidden)]
    #[inline(never)]
    fn nearest_of_several(
        tree: &PacketTree<Self>,
        walkers: &mut InterleavedTraversal<Self>,
        several: &mut InterleavedSearch<'_>,
        count: usize,
    ) {
        walkers.search(tree, several, count);
    }

    /// Searches for the primitives near a point.
    #[doc(hidden)]
    #[inline(never)]
    fn near<'n>(tree: &PacketTree<Self>, query: V3, near: &mut Near<'n>, evaluate: EvaluateFn<'_, Near<'n>>) {
        tree.run(query, near, evaluate, finish);
    }

    /// Searches for the primitives that a ray may hit, and tests them exactly. `limit` is the parameter above which
    /// hits are not needed. Returns the numbers of visited nodes and packets.
    #[doc(hidden)]
    #[inline(never)]
    fn cast(tree: &PacketTree<Self>, ray: &Ray, radius: f64, limit: f64, test: TestFn<'_>) -> [usize; 2] {
        tree.isa.run(RaySearch { tree, ray, radius, limit, test })
    }

    /// Passes a tree, with the motions that are applied to it in their order, to a search for pairs.
    #[doc(hidden)]
    #[inline(never)]
    fn as_pair_side(tree: &PacketTree<Self>, motions: &[Motion], search: &mut dyn FnMut(&dyn PairSide)) {
        search(&TreeSide::new(tree, motions));
    }
}

impl Volume for Aabb<f64> {
    type Options = SplitOptions;
    type Directions = ();

    fn directions((): &()) -> &() {
        &()
    }
}

/// The searches of a tree. They are compiled in the crate that names them for its volume.
pub type Searches<V> = (
    fn(&PacketTree<V>, V3, &mut BestF64, EvaluateFn<'_, BestF64>),
    fn(&PacketTree<V>, &mut InterleavedTraversal<V>, &mut InterleavedSearch<'_>, usize),
    for<'n> fn(&PacketTree<V>, V3, &mut Near<'n>, EvaluateFn<'_, Near<'n>>),
    fn(&PacketTree<V>, &Ray, f64, f64, TestFn<'_>) -> [usize; 2],
    fn(&PacketTree<V>, &[Motion], &mut dyn FnMut(&dyn PairSide)),
    fn(Vec<BuildPrimitive>, Aabb<f64>, Members<'_>, <V as VolumeNodes>::Shared, &SplitOptions) -> PacketTree<V>,
    fn(&mut PacketTree<V>, Members<'_>, bool),
    for<'a> fn(&'a PacketTree<V>, &mut Writer<'a>),
    fn(&Reader, usize) -> Result<PacketTree<V>, LoadError>,
);

/// Returns the searches of a tree with volumes `V`.
pub const fn searches<V: Volume>() -> Searches<V> {
    (
        V::nearest,
        V::nearest_of_several,
        V::near,
        V::cast,
        V::as_pair_side,
        PacketTree::build_from_primitives,
        PacketTree::refit_to,
        <PacketTree<V> as Saved>::save,
        <PacketTree<V> as Saved>::load,
    )
}

/// The searches that this crate compiles.
#[doc(hidden)]
#[cfg(not(test))]
pub static COMPILED_SEARCHES: Searches<Aabb<f64>> = searches();

/// The exact tests for the library's collector, which this crate compiles.
#[used]
static COMPILED_TESTS: fn(&mut ExactTests<'static, 'static, p2m_core::Hits<'static>>, usize, usize) -> Option<f64> =
    ExactTests::test;

impl<V: Volume> PacketTree<V> {
    /// Returns the directions of the faces of the volumes, see [`Volume::Directions`].
    #[must_use]
    pub fn directions(&self) -> &V::Directions {
        V::directions(&self.shared)
    }

    /// Offers to `best` the primitives of `set` that may be the nearest.
    #[inline]
    #[doc(hidden)]
    pub fn search_nearest<T: Real, S: PrimitiveSet<T> + ?Sized>(&self, set: &S, query: &Point3<T>, best: &mut Best<T>) {
        V::nearest(self, to_f64_array(query), best.minimum(), &evaluation(set, query));
    }

    /// Offers to `near` the primitives of `set` that it may need.
    #[inline]
    #[doc(hidden)]
    pub fn search_near<T: Real, S: PrimitiveSet<T> + ?Sized>(&self, set: &S, query: &Point3<T>, near: &mut Near<'_>) {
        V::near(self, to_f64_array(query), near, &evaluation(set, query));
    }

    /// Offers to `collector` every hit of a ray with `set` that it may need. The tree has to be built over that set.
    #[inline]
    pub fn search_ray<'r, T: Real, S: PrimitiveSet<T> + ?Sized, C: RayCollector<'r>>(
        &self,
        set: &S,
        ray: &'r Ray,
        collector: &mut C,
    ) {
        let only_crossings = collector.only_crossings();
        let Some(radius) = self.search_radius(ray, only_crossings) else { return };
        let (limit, intersect) = (collector.limit(), intersection(set, ray, only_crossings));
        let mut tests = ExactTests {
            leaves: &self.leaves,
            isa: self.isa,
            ray,
            only_crossings,
            hits: collector,
            intersect: &intersect,
        };
        let [nodes, packets] = V::cast(self, ray, radius, limit, &mut |packet, lane| tests.test(packet, lane));
        tests.hits.record_visits(nodes, packets);
    }

    /// Calls `visit` for the primitives that a ray may hit, as
    /// [`RayQuery::visit_ray_candidates`](p2m_core::RayQuery::visit_ray_candidates).
    #[doc(hidden)]
    pub fn search_ray_candidates(&self, ray: &Ray, visit: &mut dyn FnMut(PrimitiveId, &[V3]) -> f64) {
        let Some(radius) = self.search_radius(ray, false) else { return };
        let mut limit = f64::INFINITY;
        V::cast(self, ray, radius, limit, &mut |packet, lane| {
            let packet = &self.leaves.packets[packet];
            let (indices, count) = packet.vertices_of(lane);
            let vertices = if count == 0 { Default::default() } else { indices.map(|i| self.leaves.vertices[i]) };
            limit = limit.min(visit(packet.ids()[lane], &vertices[..count]));
            (limit > f64::NEG_INFINITY).then_some(limit)
        });
    }
}
