//! The nearest points of the scene to the corners and centres of cells, which become dominators.

use crate::list::corner_test::DistancesAtPoint;
use crate::octree::budget::{Account, Spent};
use crate::octree::candidate::Candidate;
use crate::octree::lattice::NEAREST_BOX_COUNT;
use p2m_bvh::PacketTree;
use p2m_core::engine::vector::V3;
use p2m_core::{Best, Isa, PrimitiveId, QueryOptions};
use rustc_hash::FxHashMap;

/// The number of tests above which a search of the tree is charged to the work budget. Shorter searches are included in
/// the charge of a split.
const CHARGE_SEARCH_ABOVE_TESTS: usize = 512;

/// The result of one search of the tree, and the work of it.
pub(crate) struct TreeProbe {
    /// The nearest point of the scene, on whichever primitive.
    pub(crate) nearest: V3,
    /// The number of visited nodes.
    pub(crate) nodes: usize,
    /// The number of tested packets.
    pub(crate) packets: usize,
    /// The number of evaluated primitives.
    pub(crate) primitives: usize,
}

/// The scene of an octree: its tree, and how it is searched.
pub(crate) struct SceneTree<'a> {
    /// The tree over the packets.
    pub(crate) tree: &'a PacketTree,
    /// For each vertex of the tree the primitive with the lowest id that has this vertex.
    pub(crate) lowest_owners: &'a [PrimitiveId],
    /// Searches the tree for the nearest point of the scene.
    pub(crate) search: &'a (dyn Fn(V3) -> TreeProbe + Sync),
    /// The slack of the corner test: a dominator has to be nearer by this much.
    pub(crate) slack: f64,
}

impl SceneTree<'_> {
    /// Returns the instruction set of the tree.
    pub(crate) fn isa(&self) -> Isa {
        self.tree.isa()
    }

    /// Searches the tree. The charge of a split includes the work of an ordinary search. Where most of the scene is
    /// about equally near, a search takes time in proportion to the size of the scene, and is charged here.
    pub(crate) fn probe(&self, account: &mut Account, x: V3) -> TreeProbe {
        let probe = (self.search)(x);
        let tests = probe.packets + probe.primitives;
        account.spent.tests += if tests > CHARGE_SEARCH_ABOVE_TESTS { tests as i64 } else { 0 };
        probe
    }

    /// Returns the point of the scene that is nearest to `x`.
    pub(crate) fn nearest(&self, account: &mut Account, x: V3) -> V3 {
        self.probe(account, x).nearest
    }

    /// Returns the point of the scene that is nearest to a lattice point, which may be known already.
    pub(crate) fn nearest_to_lattice_point(
        &self,
        account: &mut Account,
        known: &mut FxHashMap<[u64; 3], V3>,
        x: V3,
    ) -> V3 {
        *known.entry(x.map(f64::to_bits)).or_insert_with(|| self.nearest(account, x))
    }

    /// Returns a point of the scene that is the nearest to `x`, or nearly so. `few` are the candidates with the boxes
    /// nearest to `x`, nearest first, with squared lower bounds on their distances. The tree is searched if the filter
    /// of one of them cannot be used.
    pub(crate) fn nearest_of_few(
        &self,
        account: &mut Account,
        candidates: &[Candidate],
        few: [(f64, usize); NEAREST_BOX_COUNT],
        x: V3,
    ) -> V3 {
        let mut best = (f64::INFINITY, 0, 0);
        for (square, number) in few {
            if square >= best.0 * best.0 {
                break;
            }
            account.spent += Spent::new(0, 1);
            let packet = candidates[number].child.number();
            let at = DistancesAtPoint { packet: &self.tree.leaves.packets[packet], point: &x };
            let Some((distance, lane)) = self.isa().run(at).1 else { return self.nearest(account, x) };
            if distance < best.0 {
                best = (distance, packet, lane);
            }
        }
        let (distance, packet, lane) = best;
        if distance == f64::INFINITY {
            return self.nearest(account, x);
        }
        let mut best = Best::<f64>::new(&QueryOptions::default());
        self.tree.leaves.packets[packet].offer(lane, &self.tree.leaves.vertices, x, f64::INFINITY, &mut best);
        best.finish().map_or([f64::INFINITY; 3], |closest| closest.point.coords.into())
    }
}
