//! An index whose searches for pairs can be ended early.

use super::search::PairSide;
use super::{Hull, Motion, PairQuery};
use crate::batch::Interruptible;
use crate::{Aabb, PrimitiveId, Real};

impl<'a, I: ?Sized, F: Fn() -> bool> Interruptible<'a, I, F> {
    /// Wraps an index so that its searches for pairs call the function before each step. The index has to be the first
    /// scene of the search. Once the function returns `false`, the search ends, and its answer is the best among the
    /// primitives that it has compared.
    ///
    /// ```
    /// use p2m_core::batch::Interruptible;
    /// use p2m_core::pair::PairQuery;
    /// use p2m_core::{BruteForce, Point};
    ///
    /// let points = BruteForce::new([1.0, 2.0, 4.0].map(|x| Point::new([x, 0.0, 0.0].into())))?;
    /// let stopped = Interruptible::pairs(&points, || false);
    /// assert!(!stopped.is_any_pair_near(&points, &Default::default()));
    /// # Ok::<(), p2m_core::BuildError>(())
    /// ```
    pub fn pairs(index: &'a I, goes_on: F) -> Self {
        Self { index, step: goes_on }
    }
}

impl<T: Real, I: PairQuery<T> + ?Sized, F: Fn() -> bool> PairQuery<T> for Interruptible<'_, I, F> {
    fn primitive_count(&self) -> usize {
        self.index.primitive_count()
    }

    fn hull(&self, id: PrimitiveId) -> Hull {
        self.index.hull(id)
    }

    fn pair_bounds(&self) -> Aabb<f64> {
        self.index.pair_bounds()
    }

    fn visit_pair_sides(
        &self,
        motions: &[Motion],
        near: &Aabb<f64>,
        search: &mut dyn FnMut(&dyn PairSide, usize) -> f64,
    ) -> bool {
        self.index.visit_pair_sides(motions, near, search)
    }

    fn guess_closest(&self, point: [f64; 3]) -> Option<([f64; 3], PrimitiveId)> {
        self.index.guess_closest(point)
    }

    fn goes_on(&self) -> bool {
        (self.step)()
    }
}
