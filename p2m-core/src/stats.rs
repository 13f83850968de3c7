//! Statistics of indexes: lengths of lists, and costs of queries in units that do not depend on the machine.

use crate::{Best, ClosestPoint, QueryOptions, Real};
use nalgebra::Point3;

/// The interface by which statistics of an index are collected.
pub trait IndexStats<T: Real>: ClosestPoint<T> {
    /// Returns the numbers of nodes and packets that the search for a finite query visits, and of the primitives that it
    /// evaluates. They are the same on every run, so tests can compare them where times would vary.
    fn count_query(&self, query: &Point3<T>, options: &QueryOptions<T>) -> [usize; 3] {
        let mut best = Best::new(options);
        self.search(query, &mut best);
        best.counts()
    }

    /// Returns the sums of [`count_query`](Self::count_query) with default options over several queries.
    fn count_queries(&self, queries: &[Point3<T>]) -> [usize; 3] {
        let counts = queries.iter().map(|query| self.count_query(query, &QueryOptions::default()));
        counts.fold([0; 3], |sums, counts| [0, 1, 2].map(|i| sums[i] + counts[i]))
    }

    /// Returns the heap memory in bytes, without the set's, as names and sizes of its parts.
    fn parts(&self) -> Vec<(&'static str, usize)>;

    /// Returns the number of primitives in the list of each cell. It is empty for an index without cells.
    fn list_lengths(&self) -> Vec<usize> {
        Vec::new()
    }

    /// Returns the number of primitives in the list of the cell that contains a point, or `None` if there is no list.
    fn list_length(&self, point: &Point3<T>) -> Option<usize> {
        let _ = point;
        None
    }
}

/// Statistics of the lengths of the lists of an index, in primitives.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ListStats {
    /// The number of lists.
    pub count: usize,
    /// The mean length.
    pub mean: f64,
    /// The median length.
    pub median: usize,
    /// The 90th percentile of the lengths.
    pub p90: usize,
    /// The 99th percentile of the lengths.
    pub p99: usize,
    /// The maximum length.
    pub max: usize,
}

impl ListStats {
    /// Computes the statistics of an index, or returns `None` if it has no lists.
    ///
    /// # Complexity
    /// It takes O(n log n) for n lists.
    pub fn from_index<T: Real>(index: &(impl IndexStats<T> + ?Sized)) -> Option<Self> {
        let mut lengths = index.list_lengths();
        lengths.sort_unstable();
        let (count, max) = (lengths.len(), *lengths.last()?);
        let percentile = |n| percentile(&lengths, n, 100);
        let mean = lengths.iter().sum::<usize>() as f64 / count as f64;
        Some(Self { count, mean, median: percentile(50)?, p90: percentile(90)?, p99: percentile(99)?, max })
    }
}

/// Returns the nearest-rank percentile of sorted values: the smallest value such that at least the fraction `numerator
/// / denominator` of all values is not larger. Returns `None` if there are no values.
///
/// ```
/// use p2m_core::engine::stats::percentile;
///
/// let sorted: Vec<u64> = (1..=2000).collect();
/// assert_eq!(percentile(&sorted, 999, 1000), Some(1998));
/// ```
#[must_use]
pub fn percentile<V: Copy>(sorted: &[V], numerator: usize, denominator: usize) -> Option<V> {
    let rank = (sorted.len() * numerator).div_ceil(denominator).max(1);
    sorted.get(rank.min(sorted.len()).checked_sub(1)?).copied()
}

/// The mean and the maximum of a count over several queries.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stat {
    /// The mean over the queries, or 0 without queries.
    pub mean: f64,
    /// The maximum over the queries.
    pub max: usize,
}

/// The mean and the maximum work of several queries.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct QueryCost {
    /// The number of visited nodes of trees, and of sites on the way to a Voronoi cell.
    pub nodes: Stat,
    /// The number of filtered packets.
    pub packets: Stat,
    /// The number of evaluated primitives.
    pub primitives: Stat,
    /// The mean length of the list of the cell that contains a query. It is taken over the queries that have a list,
    /// and is 0 if none has. For uniformly distributed queries it is the mean length weighted by the volumes of cells.
    pub list: f64,
    /// The fraction of queries without a list.
    pub without_list: f64,
}

impl QueryCost {
    /// Measures several queries. All numbers are zero without queries.
    pub fn measure<T: Real>(index: &(impl IndexStats<T> + ?Sized), queries: &[Point3<T>]) -> Self {
        let mut stats = [Stat::default(); 3];
        for query in queries {
            for (stat, count) in stats.iter_mut().zip(index.count_query(query, &QueryOptions::default())) {
                *stat = Stat { mean: stat.mean + count as f64, max: stat.max.max(count) };
            }
        }
        let lengths: Vec<usize> = queries.iter().filter_map(|query| index.list_length(query)).collect();
        let query_count = queries.len().max(1) as f64;
        let [nodes, packets, primitives] = stats.map(|stat| Stat { mean: stat.mean / query_count, ..stat });
        let list = lengths.iter().sum::<usize>() as f64 / lengths.len().max(1) as f64;
        Self { nodes, packets, primitives, list, without_list: (queries.len() - lengths.len()) as f64 / query_count }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BruteForce, Collector, Point, Primitive, PrimitiveId};

    /// An index with lists of 1 to 200 primitives. A query evaluates the list whose length is its x.
    struct TestLists;

    impl ClosestPoint<f64> for TestLists {
        fn search(&self, query: &Point3<f64>, best: &mut Best<f64>) {
            best.visit_node();
            for i in 0..self.list_length(query).unwrap_or(0) {
                best.visit_packet();
                best.offer(PrimitiveId::new(i), Point::new(Point3::origin()).project(query));
            }
        }
    }

    impl IndexStats<f64> for TestLists {
        fn parts(&self) -> Vec<(&'static str, usize)> {
            vec![("lists", 20_100)]
        }
        fn list_lengths(&self) -> Vec<usize> {
            (1..=200).rev().collect()
        }
        fn list_length(&self, point: &Point3<f64>) -> Option<usize> {
            (point.x >= 0.0).then_some(point.x as usize)
        }
    }

    #[test]
    fn percentiles_are_lengths_that_as_many_lists_do_not_exceed() {
        let lists = ListStats::from_index(&TestLists).expect("lists");
        assert_eq!((lists.count, lists.max, lists.mean), (200, 200, 100.5));
        assert_eq!([lists.median, lists.p90, lists.p99], [100, 180, 198]);
    }

    #[test]
    fn percentiles_are_of_the_nearest_rank() {
        let five = [10, 20, 30, 40, 50];
        let of = |parts| percentile(&five, parts, 100);
        assert_eq!([of(0), of(20), of(21), of(50), of(99), of(100)], [10, 10, 20, 30, 50, 50].map(Some));
        assert_eq!(percentile::<u32>(&[], 50, 100), None);
        // Exactly one in a thousand is above.
        let many: Vec<usize> = (0..3000).collect();
        let at = percentile(&many, 999, 1000).unwrap();
        assert_eq!(many.iter().filter(|value| **value > at).count(), 3);
    }

    #[test]
    fn visits_are_means_over_the_queries() {
        let at = |x: f64| Point3::new(x, 0.0, 0.0);
        let cost = QueryCost::measure(&TestLists, &[at(3.0), at(5.0), at(-1.0), at(-2.0)]);
        let stat = |mean, max| Stat { mean, max };
        assert_eq!([cost.nodes, cost.packets, cost.primitives], [stat(1.0, 1), stat(2.0, 5), stat(2.0, 5)]);
        assert_eq!([cost.list, cost.without_list], [4.0, 0.5]);
        let nothing = QueryCost::measure(&TestLists, &[]);
        assert_eq!((nothing.nodes, nothing.list, nothing.without_list), (Stat::default(), 0.0, 0.0));
        let points = [at(1.0), at(2.0), at(3.0)].map(Point::new);
        let brute = QueryCost::measure(&BruteForce::new(points).expect("valid"), &[at(0.0), at(9.0)]);
        assert_eq!((brute.nodes, brute.primitives, brute.without_list), (Stat::default(), stat(3.0, 3), 1.0));
        assert_eq!(ListStats::from_index(&BruteForce::new(points).expect("valid")), None);
    }
}
