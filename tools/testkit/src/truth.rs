//! The true distance to one primitive. Bounds decide if they can, and rational arithmetic otherwise.

use crate::enclosure::Enclosure;
use crate::oracle::Distance;
use std::cell::{Cell, OnceCell};

thread_local! {
    static RATIONAL: Cell<u64> = const { Cell::new(0) };
}

/// Returns the number of distances that this thread had to compute in rational arithmetic so far.
#[must_use]
pub fn rational_distances() -> u64 {
    RATIONAL.get()
}

/// The distance from a query to the convex hull of one to three vertices.
#[derive(Clone, Debug)]
pub struct Truth<'a> {
    query: [f64; 3],
    vertices: &'a [[f64; 3]],
    enclosure: Option<Enclosure>,
    exact: OnceCell<Distance>,
}

impl<'a> Truth<'a> {
    /// Computes the bounds of the distance; coordinates have to be finite.
    ///
    /// # Panics
    /// Panics unless there are one to three vertices.
    #[must_use]
    pub fn new(query: [f64; 3], vertices: &'a [[f64; 3]]) -> Self {
        Self { query, vertices, enclosure: Enclosure::new(query, vertices), exact: OnceCell::new() }
    }

    /// Returns the distance in rational arithmetic.
    pub fn exact(&self) -> &Distance {
        self.exact.get_or_init(|| {
            RATIONAL.set(RATIONAL.get() + 1);
            Distance::new(self.query, self.vertices)
        })
    }

    /// Returns [`Distance::error`], or up to a thousandth more.
    #[must_use]
    pub fn error(&self, computed: f64, bits: u32, eta: f64) -> f64 {
        let fast = self.enclosure.and_then(|e| e.error(computed, bits, eta));
        fast.unwrap_or_else(|| self.exact().error(computed, bits, eta))
    }

    /// Returns [`Distance::relative_error`], or up to a thousandth more.
    #[must_use]
    pub fn relative_error(&self, computed: f64, bits: u32, eta: f64) -> f64 {
        let fast = self.enclosure.and_then(|e| e.relative_error(computed, bits, eta));
        fast.unwrap_or_else(|| self.exact().relative_error(computed, bits, eta))
    }

    /// Returns whether the distance is at least `bound`. It is never at least a bound that is infinite or NaN.
    #[must_use]
    pub fn is_at_least(&self, bound: f64) -> bool {
        if bound <= 0.0 {
            return true;
        }
        let fast = self.enclosure.and_then(|e| e.is_at_least(bound));
        fast.unwrap_or_else(|| self.exact().is_at_least(bound))
    }

    /// Returns `factor` times the largest distance from the query to a vertex, up to a few roundings.
    #[must_use]
    pub fn times_max_vertex_distance(&self, factor: f64) -> f64 {
        self.enclosure
            .map_or_else(|| self.exact().times_max_vertex_distance(factor), |e| e.times_max_vertex_distance(factor))
    }
}
