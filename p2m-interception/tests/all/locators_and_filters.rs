//! Answers depend neither on the locator nor on the filter of lists.

use nalgebra::Point3;
use p2m_core::storage::{SavedFile, Writer};
use p2m_core::{BruteForce, BuildIndex, ClosestPoint, Element, IndexStats, Soup};
use p2m_interception::{
    BuildListFilter, BuildLocator, KdTreeLocator, ListFilter, Locator, LocatorSites, P2mIndex, P2mOptions, Region,
    RegionTree,
};
use p2m_testkit::scenes::{self, Kinds, Layout, kinds_and_layout};
use p2m_testkit::{amount, cases, rng, vector};
use std::sync::Arc;

type Index<'a> = P2mIndex<f64, &'a Soup<f64>>;

/// A locator that answers every query with the same site, or with none.
#[derive(Debug)]
struct Constant(Option<usize>);

impl Locator for Constant {
    fn start(&self, _: &[f64; 3]) -> Option<usize> {
        self.0
    }
    fn memory(&self) -> usize {
        0
    }
}

fn first_site(sites: &LocatorSites<'_>) -> Arc<dyn Locator> {
    Arc::new(Constant(Some(sites.first())))
}

fn no_site(_: &LocatorSites<'_>) -> Arc<dyn Locator> {
    Arc::new(Constant(None))
}

/// A filter that tests all regions one by one. If it `takes_all`, it chooses all of them.
#[derive(Debug)]
struct OneByOne {
    regions: Vec<Region>,
    takes_all: bool,
}

impl ListFilter for OneByOne {
    fn containing(&self, point: &[f64; 3], visit: &mut dyn FnMut(&Region)) {
        self.regions.iter().filter(|region| self.takes_all || region.contains(point)).for_each(visit);
    }
    fn memory(&self) -> usize {
        0
    }
}

fn one_by_one(regions: Vec<Region>) -> Arc<dyn ListFilter> {
    Arc::new(OneByOne { regions, takes_all: false })
}

fn all_regions(regions: Vec<Region>) -> Arc<dyn ListFilter> {
    Arc::new(OneByOne { regions, takes_all: true })
}

/// Builds an index with filters of lists that have more primitives than `above`.
fn filtered(soup: &Soup<f64>, filter: BuildListFilter, above: usize) -> Index<'_> {
    let options = P2mOptions::default().with_list_filter(filter).with_filter_above(above);
    Index::build(soup, &options).expect("valid")
}

type Answers = Vec<Option<(u64, usize)>>;

/// Returns the answers to queries one at a time, and side by side.
fn answers(index: &impl ClosestPoint<f64>, queries: &[Point3<f64>]) -> [Answers; 2] {
    let key = |c: p2m_core::Closest<f64>| (c.distance.to_bits(), c.primitive.index());
    let mut several = vec![None; queries.len()];
    index.closest_points_into(queries, &Default::default(), &mut several);
    [
        queries.iter().map(|q| index.closest_point(q).map(key)).collect(),
        several.into_iter().map(|answer| answer.map(key)).collect(),
    ]
}

/// Returns the number of packets that all queries visit.
fn packets(index: &Index<'_>, queries: &[Point3<f64>]) -> usize {
    index.count_queries(queries)[1]
}

#[test]
fn every_filter_leaves_the_answer() {
    let (mut with_filter, mut all, mut fewer) = (0, 0, 0);
    let cases = cases(24, 24);
    for case in cases.clone() {
        let (mut rng, (kinds, layout)) = (rng("filters", case), kinds_and_layout(case));
        let soup = scenes::soup(&mut rng, kinds, layout, amount(300, 60));
        let mut queries: Vec<_> =
            (0..amount(150, 20)).map(|i| Point3::from(vector(&mut rng) * [1.0, 4.0, 9.0][i % 3])).collect();
        queries.extend(soup.positions().iter().take(amount(50, 10)));
        let expected = answers(&BruteForce::new(&soup).expect("valid"), &queries);
        let trees = filtered(&soup, RegionTree::build, 0);
        let (chosen, everything) = (filtered(&soup, one_by_one, 0), filtered(&soup, all_regions, 0));
        assert_eq!(answers(&trees, &queries), expected, "case {case}: {kinds:?} {layout:?}");
        assert_eq!(
            answers(&filtered(&soup, RegionTree::build, 30), &queries),
            expected,
            "case {case}: {kinds:?} {layout:?}, long ones"
        );
        assert_eq!(answers(&everything, &queries), expected, "case {case}: {kinds:?} {layout:?}, all");
        // Both filters treat the border of a box as part of the box.
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
        let (mut rng, (kinds, layout)) = (rng("locators", case), kinds_and_layout(case));
        let soup = scenes::soup(&mut rng, kinds, layout, amount(300, 60));
        let mut queries: Vec<_> =
            (0..amount(150, 20)).map(|i| Point3::from(vector(&mut rng) * [1.0, 20.0, 1e9][i % 3])).collect();
        queries.extend(soup.positions().iter().take(amount(50, 10)));
        let expected = answers(&BruteForce::new(&soup).expect("valid"), &queries);
        let locators: [(&str, BuildLocator); 3] =
            [("KD-tree", KdTreeLocator::build), ("first site", first_site), ("no site", no_site)];
        for (name, locator) in locators {
            let index = Index::build(&soup, &P2mOptions::default().with_locator(locator)).expect("valid");
            assert_eq!(index.report().filtered, 0);
            lists += index.report().list_cells;
            assert_eq!(answers(&index, &queries), expected, "case {case}: {kinds:?} {layout:?}, {name}");
        }
    }
    assert!(cases.have_more_than(amount(15_000, 2_880), lists), "{lists}");
}

#[test]
fn a_saved_index_has_a_grid_instead_of_another_locator() {
    let soup = scenes::skewed_gear(400);
    let queries: Vec<_> = soup.positions().iter().map(|p| p + vector(&mut rng("saved locators", 0)) * 0.1).collect();
    let saved = |options: &P2mOptions| {
        let index = Index::build(&soup, options).expect("valid");
        let (mut writer, mut bytes) = (Writer::default(), Vec::new());
        index.save(&mut writer);
        writer.write(&mut bytes).expect("in memory");
        bytes
    };
    let options = P2mOptions::default();
    let bytes = saved(&options.with_locator(KdTreeLocator::build).with_list_filter(RegionTree::build));
    let file = SavedFile::read(&bytes[..]).expect("complete");
    let loaded = Index::load(&soup, file.checked().expect("whole")).expect("an index");
    let built = Index::build(&soup, &options).expect("valid");
    assert!(built.report().list_cells > 100, "{}", built.report());
    assert_eq!(answers(&loaded, &queries), answers(&built, &queries));
    // Queries visit the same packets, so the lists and the sites at which queries end are the same.
    assert_eq!(packets(&loaded, &queries), packets(&built, &queries));
}

/// Returns queries on the positions of a scene, near them, and at 10 and at 1e9 times their distance from the origin.
fn queries_at_all_distances(soup: &Soup<f64>, case: u64) -> Vec<Point3<f64>> {
    let mut rng = rng("distances", case);
    let scaled = |rng: &mut _, factor| Point3::from(vector(rng) * factor);
    let mut queries: Vec<_> = (0..60).map(|i| scaled(&mut rng, [1.0, 3.0, 10.0, 1e9][i % 4])).collect();
    queries.extend(soup.positions().iter().take(60));
    queries.extend(soup.positions().iter().take(60).map(|p| p + vector(&mut rng) * 1e-3));
    queries
}

/// Makes points of a curve or a grid, with segments between consecutive points and a triangle for every third one.
fn chain(count: u32, position: impl Fn(f64, f64) -> [f64; 3]) -> Soup<f64> {
    let points = (0..count).map(|i| Point3::from(position(f64::from(i % 20) / 20.0, f64::from(i / 20) / 20.0)));
    let elements = (2..count).flat_map(|i| {
        let triangle = (i % 3 == 0).then_some(Element::Triangle([i - 2, i - 1, i]));
        [Element::Segment([i - 1, i]), Element::Point(i)].into_iter().chain(triangle)
    });
    Soup::new(points.collect(), elements).expect("valid")
}

#[test]
fn the_kd_tree_leads_to_the_answer_in_degenerate_scenes() {
    let scenes = [
        ("a plane", chain(400, |x, y| [x, y, 0.25])),
        ("a slanted plane", chain(400, |x, y| [x, y, x + y])),
        ("a line", chain(400, |x, y| [20.0 * y + x, 0.0, 0.0])),
        ("a slanted line", chain(400, |x, y| [20.0 * y + x; 3])),
        ("one point", chain(400, |_, _| [0.5, 0.25, 0.125])),
        ("duplicates", chain(400, |x, y| [(4.0 * x).floor(), (4.0 * y).floor(), (x * y * 4.0).floor()])),
        ("three points", chain(3, |x, _| [x, x * x, 1.0])),
    ];
    for (case, (name, soup)) in (0..).zip(&scenes) {
        let queries = queries_at_all_distances(soup, case);
        let expected = answers(&BruteForce::new(soup).expect("valid"), &queries);
        let options = P2mOptions::default().with_locator(KdTreeLocator::build);
        assert_eq!(answers(&Index::build(soup, &options).expect("valid"), &queries), expected, "{name}");
        let paper = Index::build(soup, &P2mOptions::as_in_paper()).expect("valid");
        assert_eq!(answers(&paper, &queries), expected, "{name}, as in the paper");
    }
}

/// Far queries begin near their site, so walks stay short, and they end where those from the grid end.
#[test]
fn walks_from_the_kd_tree_are_short_and_end_at_the_same_site() {
    let mut rng = rng("walks from the KD-tree", 0);
    let soup = scenes::soup(&mut rng, Kinds::Triangles, Layout::Uniform, 600);
    let kd_tree = P2mOptions::default().with_locator(KdTreeLocator::build);
    let [grid, kd_tree] = [P2mOptions::default(), kd_tree].map(|options| Index::build(&soup, &options).expect("valid"));
    assert!(kd_tree.report().list_cells > 100, "{}", kd_tree.report());
    let bounds = soup.positions().iter().fold(0.0f64, |all, p| all.max(p.coords.amax()));
    for scale in [1.0, 3.0, 9.0] {
        let queries: Vec<_> = (0..300).map(|_| Point3::from(vector(&mut rng) * (bounds * scale))).collect();
        for query in &queries {
            assert_eq!(kd_tree.partition().locate_site(query), grid.partition().locate_site(query), "{query:?}");
        }
        let visited = |index: &Index<'_>| index.count_queries(&queries)[0] as f64;
        let (from_kd_tree, from_grid) = (visited(&kd_tree), visited(&grid));
        assert!(from_kd_tree < 2.0 * from_grid, "{scale}: {from_kd_tree} and {from_grid} sites");
    }
}
