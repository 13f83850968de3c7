//! Options of a closest-point query.

use crate::{PrimitiveId, Real};

/// Options of a closest-point query. Build them from the default by the `with_` methods.
///
/// ```
/// use p2m_core::QueryOptions;
///
/// let options = QueryOptions::default().with_max_distance(2.5f64).with_epsilon(0.01);
/// assert_eq!(options.max_distance, 2.5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct QueryOptions<T: Real> {
    /// The largest distance of an answer, inclusive, in units of the scene. The default is infinity. A negative or NaN
    /// value admits no answer.
    pub max_distance: T,
    /// A primitive that is probably near, such as the previous answer along a path. It affects the time of a query but
    /// never an exact answer, and it is ignored if the set has no such primitive.
    pub hint: Option<PrimitiveId>,
    /// The largest relative error of the distance: reported <= (1 + epsilon) true, apart from rounding (contract N7).
    /// The default is 0, and a negative or NaN value counts as 0.
    pub epsilon: T,
    /// The maximum number of nodes and packets to visit, in addition to the visits that finding any answer at all
    /// takes. When it is exhausted, the best candidate so far is the answer, and its `lower_bound` remains valid. The
    /// default is unlimited.
    ///
    /// The interception indexes count the sites on the way to a cell and the packets of its list; with a limit of 0
    /// their answer comes from the cell alone. If there is a largest distance as well, `None` means that nothing was
    /// found within it, not that nothing is there. [`BruteForce`](crate::BruteForce) ignores the limit and answers
    /// exactly.
    pub max_visits: u32,
}

impl<T: Real> Default for QueryOptions<T> {
    fn default() -> Self {
        Self { max_distance: T::INFINITY, hint: None, epsilon: T::zero(), max_visits: u32::MAX }
    }
}

impl<T: Real> QueryOptions<T> {
    /// Sets the largest distance of an answer.
    #[must_use]
    pub fn with_max_distance(self, max_distance: T) -> Self {
        Self { max_distance, ..self }
    }
    /// Sets the primitive that is evaluated first.
    #[must_use]
    pub fn with_hint(self, hint: PrimitiveId) -> Self {
        Self { hint: Some(hint), ..self }
    }
    /// Sets the largest relative error of the distance.
    #[must_use]
    pub fn with_epsilon(self, epsilon: T) -> Self {
        Self { epsilon, ..self }
    }
    /// Sets the maximum number of nodes and packets to visit.
    #[must_use]
    pub fn with_max_visits(self, max_visits: u32) -> Self {
        Self { max_visits, ..self }
    }
    /// Returns whether the answer may differ from the exact one.
    #[must_use]
    pub fn is_approximate(&self) -> bool {
        self.epsilon > T::zero() || self.max_visits < u32::MAX
    }
}
