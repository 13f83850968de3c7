//! Answers depend neither on the locator nor on the filter of lists.

use nalgebra::Point3;
use p2m_core::{BruteForce, BuildIndex, ClosestPoint, Counting, Soup};
use p2m_interception::{
    Hints, KdTreeLocator, ListFilter, Locator, LocatorSites, P2mIndexWith, P2mOptions, Region, RegionTree, SortedLists,
};
use p2m_testkit::scenes::{self, KINDS, LAYOUTS};
use p2m_testkit::{rng, vector};

/// A locator that is always wrong, and one that knows nothing.
struct First(usize);
struct Nothing;

impl Locator for First {
    fn new(sites: &LocatorSites<'_>) -> Self {
        Self(sites.first())
    }
    fn start(&self, _: &[f64; 3]) -> Option<usize> {
        Some(self.0)
    }
    fn memory(&self) -> usize {
        0
    }
}

impl Locator for Nothing {
    fn new(_: &LocatorSites<'_>) -> Self {
        Self
    }
    fn start(&self, _: &[f64; 3]) -> Option<usize> {
        None
    }
    fn memory(&self) -> usize {
        0
    }
}

type Answers = Vec<Option<(u64, usize)>>;

/// One query at a time, and side by side.
fn answers(index: &impl ClosestPoint<f64>, queries: &[Point3<f64>]) -> [Answers; 2] {
    let key = |c: p2m_core::Closest<f64>| (c.distance.to_bits(), c.primitive.index());
    let mut several = vec![None; queries.len()];
    index.closest_points_into(queries, &Default::default(), &mut several);
    [
        queries.iter().map(|q| index.closest_point(q).map(key)).collect(),
        several.into_iter().map(|answer| answer.map(key)).collect(),
    ]
}

fn built<L: Locator>(soup: &Soup<f64>) -> P2mIndexWith<f64, &Soup<f64>, L, SortedLists> {
    P2mIndexWith::build(soup, &Default::default()).expect("valid")
}

/// A filter that leaves nothing out.
struct All(Vec<Region>);

impl ListFilter for All {
    const IS_USED: bool = true;

    fn new(regions: Vec<Region>) -> Self {
        Self(regions)
    }
    fn containing(&self, _: &[f64; 3]) -> impl Iterator<Item = &Region> {
        self.0.iter()
    }
    fn memory(&self) -> usize {
        0
    }
}

/// One that finds boxes one by one.
struct OneByOne(Vec<Region>);

impl ListFilter for OneByOne {
    const IS_USED: bool = true;

    fn new(regions: Vec<Region>) -> Self {
        Self(regions)
    }
    fn containing(&self, place: &[f64; 3]) -> impl Iterator<Item = &Region> {
        self.0.iter().filter(|region| region.contains(place))
    }
    fn memory(&self) -> usize {
        0
    }
}

fn filtered<F: ListFilter>(soup: &Soup<f64>, above: usize) -> P2mIndexWith<f64, &Soup<f64>, Hints, F> {
    P2mIndexWith::build(soup, &P2mOptions::default().with_filter_above(above)).expect("valid")
}

/// Packets that queries look at, in all.
fn packets<F: ListFilter>(index: &P2mIndexWith<f64, &Soup<f64>, Hints, F>, queries: &[Point3<f64>]) -> usize {
    Counting::of_queries(queries, |query, counting| index.visit(query, counting))[1]
}

#[test]
fn every_filter_leaves_the_answer() {
    let (mut with_filter, mut all, mut fewer) = (0, 0, 0);
    for (case, kinds) in KINDS.into_iter().enumerate() {
        for layout in LAYOUTS {
            let mut rng = rng("filters", case as u64);
            let soup = scenes::soup(&mut rng, kinds, layout, 300);
            let mut queries: Vec<_> =
                (0..150).map(|i| Point3::from(vector(&mut rng) * [1.0, 4.0, 9.0][i % 3])).collect();
            queries.extend(soup.positions().iter().take(50));
            let expected = answers(&BruteForce::new(&soup).expect("valid"), &queries);
            let trees = filtered::<RegionTree>(&soup, 0);
            let (chosen, everything) = (filtered::<OneByOne>(&soup, 0), filtered::<All>(&soup, 0));
            assert_eq!(answers(&trees, &queries), expected, "{kinds:?} {layout:?}");
            assert_eq!(
                answers(&filtered::<RegionTree>(&soup, 30), &queries),
                expected,
                "{kinds:?} {layout:?}, long ones"
            );
            assert_eq!(answers(&everything, &queries), expected, "{kinds:?} {layout:?}, all");
            // What lies on the border of a box is in it for both.
            assert_eq!(packets(&trees, &queries), packets(&chosen, &queries), "{kinds:?} {layout:?}");
            with_filter += trees.report().filtered;
            all += packets(&everything, &queries);
            fewer += packets(&trees, &queries);
        }
    }
    assert!(with_filter > 5_000, "{with_filter}");
    assert!(fewer * 3 < all * 2, "{fewer} of {all}");
}

#[test]
fn every_locator_leads_to_the_answer() {
    let mut lists = 0;
    for (case, kinds) in KINDS.into_iter().enumerate() {
        for layout in LAYOUTS {
            let mut rng = rng("locators", case as u64);
            let soup = scenes::soup(&mut rng, kinds, layout, 300);
            let mut queries: Vec<_> =
                (0..150).map(|i| Point3::from(vector(&mut rng) * [1.0, 20.0, 1e9][i % 3])).collect();
            queries.extend(soup.positions().iter().take(50));
            let expected = answers(&BruteForce::new(&soup).expect("valid"), &queries);
            let kd_tree = built::<KdTreeLocator>(&soup);
            lists += kd_tree.report().lists;
            assert_eq!(answers(&kd_tree, &queries), expected, "{kinds:?} {layout:?}");
            assert_eq!(answers(&built::<First>(&soup), &queries), expected, "{kinds:?} {layout:?}, first");
            assert_eq!(answers(&built::<Nothing>(&soup), &queries), expected, "{kinds:?} {layout:?}, nothing");
        }
    }
    assert!(lists > 5_000, "{lists}");
}
