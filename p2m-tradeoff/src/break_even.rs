//! The number of queries from which on a backend that takes longer to build is faster in total.

use crate::curve::{Curve, Point};

/// The cost of a job: a build and a number of queries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JobCost {
    /// The time to build the index, in seconds.
    pub build_seconds: f64,
    /// The time of one query, in seconds.
    pub query_seconds: f64,
}

impl JobCost {
    /// Takes the cost from a point of a curve.
    #[must_use]
    pub fn from_point(point: &Point) -> Self {
        Self { build_seconds: point.build.seconds, query_seconds: point.nanoseconds.median * 1e-9 }
    }

    /// Returns the seconds for a build and this number of queries.
    #[must_use]
    pub fn total(self, queries: f64) -> f64 {
        self.build_seconds + queries * self.query_seconds
    }
}

/// Returns the number of queries from which on `other` costs no more than `first`, or `None` if there is none.
///
/// ```
/// use p2m_tradeoff::{JobCost, break_even};
///
/// let tree = JobCost { build_seconds: 1.0, query_seconds: 3e-6 };
/// let cells = JobCost { build_seconds: 11.0, query_seconds: 1e-6 };
/// assert_eq!(break_even(tree, cells).map(f64::round), Some(5e6));
/// ```
#[must_use]
pub fn break_even(first: JobCost, other: JobCost) -> Option<f64> {
    if other.build_seconds <= first.build_seconds && other.query_seconds <= first.query_seconds {
        return Some(0.0);
    }
    let queries = (other.build_seconds - first.build_seconds) / (first.query_seconds - other.query_seconds);
    // A backend that is cheaper at first and more expensive later has no break-even.
    (first.query_seconds > other.query_seconds).then_some(queries.max(0.0))
}

/// Returns which costs are least for which numbers of queries: an index into `costs` and the number of queries from
/// which on it is the least one, in increasing order. The first entry begins at 0.
#[must_use]
pub fn cheapest(costs: &[JobCost]) -> Vec<(usize, f64)> {
    let mut turns = Vec::new();
    let least = |a: &usize, b: &usize| {
        (costs[*a].build_seconds.total_cmp(&costs[*b].build_seconds))
            .then(costs[*a].query_seconds.total_cmp(&costs[*b].query_seconds))
    };
    let Some(mut current) = (0..costs.len()).min_by(least) else { return turns };
    turns.push((current, 0.0));
    loop {
        let faster = (0..costs.len()).filter(|i| costs[*i].query_seconds < costs[current].query_seconds);
        let next = faster.filter_map(|i| Some((i, break_even(costs[current], costs[i])?)));
        // The next one is the first that gets cheaper; of several with the same break-even it is the fastest.
        let first =
            next.min_by(|a, b| a.1.total_cmp(&b.1).then(costs[a.0].query_seconds.total_cmp(&costs[b.0].query_seconds)));
        let Some((i, from)) = first else { return turns };
        turns.push((i, from));
        current = i;
    }
}

/// Returns the names of curves and the costs of their default settings.
#[must_use]
pub fn default_costs(curves: &[Curve]) -> Vec<(&str, JobCost)> {
    curves.iter().filter_map(|curve| Some((curve.name.as_str(), JobCost::from_point(curve.usual()?)))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const BRUTE: JobCost = JobCost { build_seconds: 0.0, query_seconds: 1e-3 };
    const TREE: JobCost = JobCost { build_seconds: 0.1, query_seconds: 1e-6 };
    const CELLS: JobCost = JobCost { build_seconds: 5.0, query_seconds: 2e-7 };
    const BAD: JobCost = JobCost { build_seconds: 6.0, query_seconds: 2e-6 };

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
