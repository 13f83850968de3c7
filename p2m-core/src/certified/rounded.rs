//! A reported distance with its lower bound.

/// A distance, rounded to nearest, with a lower bound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RoundedDistance {
    /// The true distance, rounded to the nearest f64.
    pub(crate) nearest: f64,
    /// A lower bound on the true distance: `nearest` or the f64 before it.
    pub(crate) lower: f64,
}
