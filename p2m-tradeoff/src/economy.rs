//! From how many queries on a backend that takes longer to build is worth it.

use crate::curve::{Curve, Point};

/// What building and asking cost together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// Seconds before the first query.
    pub build: f64,
    /// Seconds of each query.
    pub each: f64,
}

impl Cost {
    /// Of a point of a curve.
    #[must_use]
    pub fn of(point: &Point) -> Self {
        Self { build: point.build.seconds, each: point.nanoseconds.median * 1e-9 }
    }

    /// Seconds for so many queries.
    #[must_use]
    pub fn total(self, queries: f64) -> f64 {
        self.build + queries * self.each
    }
}

/// From how many queries on `other` costs no more than `first`; `None` if it never does.
///
/// ```
/// use p2m_tradeoff::{Cost, break_even};
///
/// let (tree, cells) = (Cost { build: 1.0, each: 3e-6 }, Cost { build: 11.0, each: 1e-6 });
/// assert_eq!(break_even(tree, cells).map(f64::round), Some(5e6));
/// ```
#[must_use]
pub fn break_even(first: Cost, other: Cost) -> Option<f64> {
    if other.build <= first.build && other.each <= first.each {
        return Some(0.0);
    }
    let queries = (other.build - first.build) / (first.each - other.each);
    // Cheaper from the beginning, and dearer in the end, is no break-even.
    (first.each > other.each).then_some(queries.max(0.0))
}

/// Which of some is cheapest for how many queries: the number of each in its turn, and from how many on. The first from 0.
#[must_use]
pub fn cheapest(costs: &[Cost]) -> Vec<(usize, f64)> {
    let mut turns = Vec::new();
    let least = |a: &usize, b: &usize| {
        (costs[*a].build.total_cmp(&costs[*b].build)).then(costs[*a].each.total_cmp(&costs[*b].each))
    };
    let Some(mut current) = (0..costs.len()).min_by(least) else { return turns };
    turns.push((current, 0.0));
    loop {
        let faster = (0..costs.len()).filter(|i| costs[*i].each < costs[current].each);
        let next = faster.filter_map(|i| Some((i, break_even(costs[current], costs[i])?)));
        // The first to overtake; of several at a time the fastest.
        let first = next.min_by(|a, b| a.1.total_cmp(&b.1).then(costs[a.0].each.total_cmp(&costs[b.0].each)));
        let Some((i, from)) = first else { return turns };
        turns.push((i, from));
        current = i;
    }
}

/// The usual points of curves with their names and costs.
#[must_use]
pub fn usual_costs(curves: &[Curve]) -> Vec<(&str, Cost)> {
    curves.iter().filter_map(|curve| Some((curve.name.as_str(), Cost::of(curve.usual()?)))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const BRUTE: Cost = Cost { build: 0.0, each: 1e-3 };
    const TREE: Cost = Cost { build: 0.1, each: 1e-6 };
    const CELLS: Cost = Cost { build: 5.0, each: 2e-7 };
    const BAD: Cost = Cost { build: 6.0, each: 2e-6 };

    #[test]
    fn totals_are_equal_where_it_breaks_even() {
        let queries = break_even(TREE, CELLS).unwrap();
        assert!((TREE.total(queries) / CELLS.total(queries) - 1.0).abs() < 1e-12);
        assert_eq!(break_even(CELLS, TREE), None);
        assert_eq!([break_even(BAD, TREE), break_even(TREE, TREE)], [Some(0.0); 2]);
    }

    #[test]
    fn turns_are_those_of_the_least_totals() {
        let costs = [BAD, CELLS, BRUTE, TREE];
        let turns = cheapest(&costs);
        assert_eq!(turns.iter().map(|turn| turn.0).collect::<Vec<_>>(), [2, 3, 1]);
        for queries in [0.0, 50.0, 90.0, 110.0, 1e5, 6e6, 7e6, 1e9] {
            let least = (0..4).min_by(|a, b| costs[*a].total(queries).total_cmp(&costs[*b].total(queries))).unwrap();
            let turn = turns.iter().rev().find(|turn| turn.1 <= queries).unwrap().0;
            assert_eq!(turn, least, "{queries}");
        }
        assert!(cheapest(&[]).is_empty());
    }
}
