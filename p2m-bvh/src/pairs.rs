//! Queries for near pairs of primitives.

use crate::{TreeIndex, Volume};
use p2m_core::engine::pairs::PairSide;
use p2m_core::engine::vector::V3;
use p2m_core::pair::{Hull, Motion, PairQuery, closest_as_guess};
use p2m_core::{Aabb, PrimitiveId, PrimitiveSet, Real};

impl<T: Real, S: PrimitiveSet<T>, V: Volume> PairQuery<T> for TreeIndex<T, S, V> {
    fn primitive_count(&self) -> usize {
        self.set().len()
    }

    fn hull(&self, id: PrimitiveId) -> Hull {
        Hull::of(&self.set().get(id))
    }

    fn pair_bounds(&self) -> Aabb<f64> {
        *self.tree().bounds()
    }

    fn visit_pair_sides(
        &self,
        motions: &[Motion],
        _: &Aabb<f64>,
        search: &mut dyn FnMut(&dyn PairSide, usize) -> f64,
    ) -> bool {
        V::as_pair_side(self.tree(), motions, &mut |side| {
            search(side, 0);
        });
        true
    }

    fn guess_closest(&self, point: V3) -> Option<(V3, PrimitiveId)> {
        closest_as_guess(self, point)
    }
}
