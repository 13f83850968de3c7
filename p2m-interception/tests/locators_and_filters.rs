//! Answers depend neither on the locator nor on the filter of lists.

use nalgebra::Point3;
use p2m_core::{BruteForce, BuildIndex, ClosestPoint, Counting, Soup};
use p2m_interception::{
    Hints, KdTreeLocator, ListFilter, Locator, LocatorSites, P2mIndexWith, P2mOptions, Region, RegionTree,
};
use p2m_testkit::scenes::{self, of_case};
use p2m_testkit::{amount, cases, rng, vector};
use std::sync::Mutex;

/// One index of any locator and filter: each type of an index compiles every search anew.
type Index<'a> = P2mIndexWith<f64, &'a Soup<f64>, AnyLocator, AnyFilter>;

/// Which locator and which filter an index has that is built now.
static PARTS: Mutex<(LocatorKind, FilterKind)> = Mutex::new((LocatorKind::Hints, FilterKind::Tree));

#[derive(Clone, Copy, Debug)]
enum LocatorKind {
    Hints,
    KdTree,
    /// The first site, wherever the query is.
    First,
    /// Knows nothing.
    Nothing,
}

enum AnyLocator {
    Hints(Box<Hints>),
    KdTree(KdTreeLocator),
    Always(Option<usize>),
}

impl Locator for AnyLocator {
    fn new(sites: &LocatorSites<'_>) -> Self {
        match PARTS.lock().expect("no panic").0 {
            LocatorKind::Hints => Self::Hints(Box::new(Hints::new(sites))),
            LocatorKind::KdTree => Self::KdTree(KdTreeLocator::new(sites)),
            LocatorKind::First => Self::Always(Some(sites.first())),
            LocatorKind::Nothing => Self::Always(None),
        }
    }
    fn start(&self, place: &[f64; 3]) -> Option<usize> {
        match self {
            Self::Hints(hints) => hints.start(place),
            Self::KdTree(tree) => tree.start(place),
            Self::Always(site) => *site,
        }
    }
    fn memory(&self) -> usize {
        0
    }
}

#[derive(Clone, Copy, Debug)]
enum FilterKind {
    Tree,
    /// Finds boxes one by one.
    OneByOne,
    /// Leaves nothing out.
    All,
}

enum AnyFilter {
    Tree(RegionTree),
    OneByOne { regions: Vec<Region>, takes_all: bool },
}

impl ListFilter for AnyFilter {
    const IS_USED: bool = true;

    fn new(regions: Vec<Region>) -> Self {
        match PARTS.lock().expect("no panic").1 {
            FilterKind::Tree => Self::Tree(RegionTree::new(regions)),
            FilterKind::OneByOne => Self::OneByOne { regions, takes_all: false },
            FilterKind::All => Self::OneByOne { regions, takes_all: true },
        }
    }
    fn containing(&self, place: &[f64; 3]) -> impl Iterator<Item = &Region> {
        let found: Vec<&Region> = match self {
            Self::Tree(tree) => tree.containing(place).collect(),
            Self::OneByOne { regions, takes_all } => {
                regions.iter().filter(|region| *takes_all || region.contains(place)).collect()
            }
        };
        found.into_iter()
    }
    fn memory(&self) -> usize {
        0
    }
}

/// With filters of lists of more than so many primitives.
fn built(soup: &Soup<f64>, locator: LocatorKind, filter: FilterKind, above: usize) -> Index<'_> {
    // One at a time.
    static TURN: Mutex<()> = Mutex::new(());
    let _turn = TURN.lock().expect("no panic");
    *PARTS.lock().expect("no panic") = (locator, filter);
    Index::build(soup, &P2mOptions::default().with_filter_above(above)).expect("valid")
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

/// Packets that queries look at, in all.
fn packets(index: &Index<'_>, queries: &[Point3<f64>]) -> usize {
    Counting::of_queries(queries, |query, counting| index.visit(query, counting))[1]
}

#[test]
fn every_filter_leaves_the_answer() {
    let (mut with_filter, mut all, mut fewer) = (0, 0, 0);
    let cases = cases(24, 24);
    for case in cases.clone() {
        let (mut rng, (kinds, layout)) = (rng("filters", case), of_case(case));
        let soup = scenes::soup(&mut rng, kinds, layout, amount(300, 60));
        let mut queries: Vec<_> =
            (0..amount(150, 20)).map(|i| Point3::from(vector(&mut rng) * [1.0, 4.0, 9.0][i % 3])).collect();
        queries.extend(soup.positions().iter().take(amount(50, 10)));
        let expected = answers(&BruteForce::new(&soup).expect("valid"), &queries);
        let filtered = |filter, above| built(&soup, LocatorKind::Hints, filter, above);
        let trees = filtered(FilterKind::Tree, 0);
        let [chosen, everything] = [FilterKind::OneByOne, FilterKind::All].map(|filter| filtered(filter, 0));
        assert_eq!(answers(&trees, &queries), expected, "case {case}: {kinds:?} {layout:?}");
        assert_eq!(
            answers(&filtered(FilterKind::Tree, 30), &queries),
            expected,
            "case {case}: {kinds:?} {layout:?}, long ones"
        );
        assert_eq!(answers(&everything, &queries), expected, "case {case}: {kinds:?} {layout:?}, all");
        // What lies on the border of a box is in it for both.
        assert_eq!(packets(&trees, &queries), packets(&chosen, &queries), "case {case}: {kinds:?} {layout:?}");
        with_filter += trees.report().filtered;
        all += packets(&everything, &queries);
        fewer += packets(&trees, &queries);
    }
    assert!(cases.have_more_than(amount(5_000, 480), with_filter), "{with_filter}");
    assert!(cases.is_replay() || fewer * 3 < all * 2, "{fewer} of {all}");
}

#[test]
fn every_locator_leads_to_the_answer() {
    let mut lists = 0;
    let cases = cases(24, 24);
    for case in cases.clone() {
        let (mut rng, (kinds, layout)) = (rng("locators", case), of_case(case));
        let soup = scenes::soup(&mut rng, kinds, layout, amount(300, 60));
        let mut queries: Vec<_> =
            (0..amount(150, 20)).map(|i| Point3::from(vector(&mut rng) * [1.0, 20.0, 1e9][i % 3])).collect();
        queries.extend(soup.positions().iter().take(amount(50, 10)));
        let expected = answers(&BruteForce::new(&soup).expect("valid"), &queries);
        for locator in [LocatorKind::KdTree, LocatorKind::First, LocatorKind::Nothing] {
            let index = built(&soup, locator, FilterKind::Tree, usize::MAX);
            assert_eq!(index.report().filtered, 0);
            lists += index.report().lists;
            assert_eq!(answers(&index, &queries), expected, "case {case}: {kinds:?} {layout:?}, {locator:?}");
        }
    }
    assert!(cases.have_more_than(amount(15_000, 2_880), lists), "{lists}");
}
