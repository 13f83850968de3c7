//! Queries for near pairs of primitives.

use crate::{TreeIndex, Volume};
use p2m_core::engine::pairs::PairSide;
use p2m_core::engine::real::{from_f64_array, to_f64_array};
use p2m_core::engine::vector::V3;
use p2m_core::pair::{Motion, PairQuery, hull_of};
use p2m_core::{Aabb, ClosestPoint, PrimitiveId, PrimitiveSet, Real};

impl<T: Real, S: PrimitiveSet<T>, V: Volume> PairQuery<T> for TreeIndex<T, S, V> {
    fn primitive_count(&self) -> usize {
        self.set().len()
    }

    fn hull(&self, id: PrimitiveId) -> ([V3; 3], usize) {
        hull_of(&self.set().get(id), None)
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
        let closest = self.closest_point(&from_f64_array(point))?;
        Some((to_f64_array(&closest.point), closest.primitive))
    }
}
