//! Sets of queries in both scalars, and parts of them.

use nalgebra::Point3;
use p2m_core::{Real, Soup};

/// Queries in both scalars.
#[derive(Clone, Debug)]
pub struct Queries {
    double: Vec<Point3<f64>>,
    single: Vec<Point3<f32>>,
}

/// A slice of queries in both scalars.
#[derive(Clone, Copy, Debug)]
pub struct QuerySlice<'a> {
    /// The queries in f64.
    pub double: &'a [Point3<f64>],
    /// The queries rounded to f32.
    pub single: &'a [Point3<f32>],
}

impl Queries {
    /// Stores queries in f64, and rounds them to f32.
    #[must_use]
    pub fn new(double: Vec<Point3<f64>>) -> Self {
        let single = double.iter().map(|p| p.map(f32::round_from_f64)).collect();
        Self { double, single }
    }

    /// Returns the number of queries.
    #[must_use]
    pub fn len(&self) -> usize {
        self.double.len()
    }

    /// Returns whether there are no queries.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.double.is_empty()
    }

    /// Returns the queries with these indices.
    ///
    /// # Panics
    /// If an index is not below the number of queries.
    #[must_use]
    pub fn gather(&self, chosen: &[usize]) -> Self {
        Self {
            double: chosen.iter().map(|&i| self.double[i]).collect(),
            single: chosen.iter().map(|&i| self.single[i]).collect(),
        }
    }

    /// Returns the queries of a range of indices.
    ///
    /// # Panics
    /// If the range exceeds the number of queries.
    #[must_use]
    pub fn slice(&self, range: std::ops::Range<usize>) -> QuerySlice<'_> {
        QuerySlice { double: &self.double[range.clone()], single: &self.single[range] }
    }

    /// Returns all queries.
    #[must_use]
    pub fn all(&self) -> QuerySlice<'_> {
        self.slice(0..self.len())
    }
}

/// A scalar in which queries are stored.
pub trait Scalar: Real {
    /// Returns the queries in this scalar.
    fn of(queries: QuerySlice<'_>) -> &[Point3<Self>];
}

impl Scalar for f64 {
    fn of(queries: QuerySlice<'_>) -> &[Point3<f64>] {
        queries.double
    }
}

impl Scalar for f32 {
    fn of(queries: QuerySlice<'_>) -> &[Point3<f32>] {
        queries.single
    }
}

/// Rounds a scene to f32. Returns `None` if a coordinate of a primitive overflows.
#[must_use]
pub fn rounded(soup: &Soup<f64>) -> Option<Soup<f32>> {
    let positions = soup.positions().iter().map(|p| p.map(f32::round_from_f64)).collect();
    Soup::new(positions, soup.elements()).ok()
}

/// Returns about `count` of the numbers below `total`: never more, but at least one. They are at most 50 runs of
/// consecutive numbers, evenly spaced, so that a slow backend gets the same mixture of queries as the others, and on a
/// lattice the same order.
#[must_use]
pub fn sample_indices(total: usize, count: usize) -> Vec<usize> {
    if count >= total {
        return (0..total).collect();
    }
    let runs = count.clamp(1, 50);
    let length = (count / runs).max(1);
    (0..runs).flat_map(|run| (0..length).map(move |i| run * total / runs + i)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sample_is_increasing_and_within_bounds() {
        for total in [1, 2, 49, 50, 51, 99, 101, 1000, 1037] {
            for count in [0, 1, 2, 49, 50, 73, 99, 100, 999, 2000] {
                let chosen = sample_indices(total, count);
                assert!(chosen.windows(2).all(|w| w[0] < w[1]), "{total} {count}");
                assert!(chosen.last().is_some_and(|last| *last < total));
                assert!(chosen.len() <= count.max(1) && 2 * chosen.len() >= count.min(total));
            }
        }
        assert_eq!(sample_indices(200_000, 20_000).len(), 20_000);
    }
}
