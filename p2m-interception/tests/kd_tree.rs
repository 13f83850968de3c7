//! Answers do not depend on the locator.

use nalgebra::Point3;
use p2m_core::{BruteForce, BuildIndex, ClosestPoint, Soup};
use p2m_interception::{KdTreeLocator, Locator, LocatorSites, P2mIndexWith};
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

fn built<L: Locator>(soup: &Soup<f64>) -> P2mIndexWith<f64, &Soup<f64>, L> {
    P2mIndexWith::build(soup, &Default::default()).expect("valid")
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
