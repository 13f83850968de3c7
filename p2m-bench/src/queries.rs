//! Query sets in both scalars, and parts of them.

use crate::scene::single_point;
use nalgebra::Point3;

/// Queries as every contender wants them.
pub(crate) struct Queries {
    double: Vec<Point3<f64>>,
    single: Vec<Point3<f32>>,
}

/// Some of them.
#[derive(Clone, Copy)]
pub(crate) struct QuerySlice<'a> {
    /// In f64.
    pub(crate) double: &'a [Point3<f64>],
    /// The same rounded to f32.
    pub(crate) single: &'a [Point3<f32>],
}

impl Queries {
    /// Rounds once for all.
    pub(crate) fn new(double: Vec<Point3<f64>>) -> Self {
        let single = double.iter().map(single_point).collect();
        Self { double, single }
    }

    /// How many there are.
    pub(crate) fn len(&self) -> usize {
        self.double.len()
    }

    /// Those at the given places.
    pub(crate) fn gather(&self, chosen: &[usize]) -> Self {
        Self {
            double: chosen.iter().map(|&i| self.double[i]).collect(),
            single: chosen.iter().map(|&i| self.single[i]).collect(),
        }
    }

    /// Those in a range.
    pub(crate) fn slice(&self, range: std::ops::Range<usize>) -> QuerySlice<'_> {
        QuerySlice { double: &self.double[range.clone()], single: &self.single[range] }
    }

    /// All of them.
    pub(crate) fn all(&self) -> QuerySlice<'_> {
        self.slice(0..self.len())
    }
}

/// About `count` (never more, but at least one) of `total` places, spread evenly in at most 50 runs of neighbours: a
/// slow contender gets the same mixture, and on the lattice the same order, as the others.
pub(crate) fn spread(total: usize, count: usize) -> Vec<usize> {
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
    fn a_spread_is_increasing_and_within_bounds() {
        for total in [1, 2, 49, 50, 51, 99, 101, 1000, 1037] {
            for count in [0, 1, 2, 49, 50, 73, 99, 100, 999, 2000] {
                let chosen = spread(total, count);
                assert!(chosen.windows(2).all(|w| w[0] < w[1]), "{total} {count}");
                assert!(chosen.last().is_some_and(|last| *last < total));
                assert!(chosen.len() <= count.max(1) && 2 * chosen.len() >= count.min(total));
            }
        }
        assert_eq!(spread(200_000, 20_000).len(), 20_000);
    }
}
