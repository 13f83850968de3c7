//! Statistics of indexes: how long lists are, and what queries cost in what does not depend on the machine.

use crate::{Real, StatsCollector};
use nalgebra::Point3;

/// What statistics ask an index.
pub trait Inspect<T: Real> {
    /// Offers to a counting collector every primitive that a search for the nearest would want.
    fn inspect(&self, query: &Point3<T>, counting: &mut StatsCollector<T>);

    /// Heap memory besides the set, by parts, in bytes.
    fn parts(&self) -> Vec<(&'static str, usize)>;

    /// How many primitives the list of each cell has; empty for an index without cells.
    fn list_lengths(&self) -> Vec<usize> {
        Vec::new()
    }

    /// How many primitives the list of the cell has that a point is in. `None` where there is no list.
    fn list_length(&self, point: &Point3<T>) -> Option<usize> {
        let _ = point;
        None
    }
}

/// How many primitives the lists of an index have.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ListStats {
    /// How many lists there are.
    pub count: usize,
    /// The mean of their lengths.
    pub mean: f64,
    /// The length that half of the lists do not exceed,
    pub median: usize,
    /// that 90 of 100 do not,
    pub percent_90: usize,
    /// 99 of 100,
    pub percent_99: usize,
    /// and all.
    pub most: usize,
}

impl ListStats {
    /// Those of an index; `None` if it has none.
    ///
    /// # Complexity
    /// O(n log n) for n lists.
    pub fn of<T: Real>(index: &(impl Inspect<T> + ?Sized)) -> Option<Self> {
        let mut lengths = index.list_lengths();
        lengths.sort_unstable();
        let (count, most) = (lengths.len(), *lengths.last()?);
        // The least length that so many of a hundred do not exceed.
        let percent = |n: usize| lengths[(count * n).div_ceil(100).max(1) - 1];
        let mean = lengths.iter().sum::<usize>() as f64 / count as f64;
        Some(Self { count, mean, median: percent(50), percent_90: percent(90), percent_99: percent(99), most })
    }
}

/// A mean and a maximum.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stat {
    /// The mean over the queries; 0 without any.
    pub mean: f64,
    /// The most for one query.
    pub most: usize,
}

/// What queries cost.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct QueryCost {
    /// Nodes of trees that a query visits, and sites on its way to a Voronoi cell.
    pub nodes: Stat,
    /// Packets of primitives that it filters.
    pub packets: Stat,
    /// Primitives that it evaluates.
    pub primitives: Stat,
    /// The length of the list of the cell that it is in, over the queries that have one; 0 if none has. For points that
    /// are spread evenly it is the mean length weighted by the volumes of cells.
    pub list: f64,
    /// The part of the queries that have no list.
    pub without_list: f64,
}

impl QueryCost {
    /// Those of some queries; all zero without any.
    pub fn of<T: Real>(index: &(impl Inspect<T> + ?Sized), queries: &[Point3<T>]) -> Self {
        let mut loads = [Stat::default(); 3];
        for query in queries {
            let counts = StatsCollector::of_query(query, |query, counting| index.inspect(query, counting));
            for (load, count) in loads.iter_mut().zip(counts) {
                *load = Stat { mean: load.mean + count as f64, most: load.most.max(count) };
            }
        }
        let lengths: Vec<usize> = queries.iter().filter_map(|query| index.list_length(query)).collect();
        let all = queries.len().max(1) as f64;
        let [nodes, packets, primitives] = loads.map(|load| Stat { mean: load.mean / all, ..load });
        let list = lengths.iter().sum::<usize>() as f64 / lengths.len().max(1) as f64;
        Self { nodes, packets, primitives, list, without_list: (queries.len() - lengths.len()) as f64 / all }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BruteForce, Collector, Point, Primitive, PrimitiveId};

    /// Lists of 1 to 200 primitives; a query has that of its x, and looks at it all.
    struct Made;

    impl Inspect<f64> for Made {
        fn inspect(&self, query: &Point3<f64>, counting: &mut StatsCollector<f64>) {
            counting.visit_node();
            for i in 0..self.list_length(query).unwrap_or(0) {
                counting.visit_packet();
                counting.offer(PrimitiveId::new(i), Point::new(Point3::origin()).project(query));
            }
        }
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
    fn lengths_are_those_that_so_many_do_not_exceed() {
        let lists = ListStats::of(&Made).expect("lists");
        assert_eq!((lists.count, lists.most, lists.mean), (200, 200, 100.5));
        assert_eq!([lists.median, lists.percent_90, lists.percent_99], [100, 180, 198]);
    }

    #[test]
    fn visits_are_means_over_the_queries() {
        let at = |x: f64| Point3::new(x, 0.0, 0.0);
        let visits = QueryCost::of(&Made, &[at(3.0), at(5.0), at(-1.0), at(-2.0)]);
        let load = |mean, most| Stat { mean, most };
        assert_eq!([visits.nodes, visits.packets, visits.primitives], [load(1.0, 1), load(2.0, 5), load(2.0, 5)]);
        assert_eq!([visits.list, visits.without_list], [4.0, 0.5]);
        let nothing = QueryCost::of(&Made, &[]);
        assert_eq!((nothing.nodes, nothing.list, nothing.without_list), (Stat::default(), 0.0, 0.0));
        let points = [at(1.0), at(2.0), at(3.0)].map(Point::new);
        let brute = QueryCost::of(&BruteForce::new(points).expect("valid"), &[at(0.0), at(9.0)]);
        assert_eq!((brute.nodes, brute.primitives, brute.without_list), (Stat::default(), load(3.0, 3), 1.0));
        assert_eq!(ListStats::of(&BruteForce::new(points).expect("valid")), None);
    }
}
