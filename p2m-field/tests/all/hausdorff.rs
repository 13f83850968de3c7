//! Tests that every backend of the registry gives the same Hausdorff distance as brute force, bit for bit.
use p2m_backends::{AnyIndex, BACKENDS, BuildSettings};
use p2m_core::{BruteForce, Real, Soup};
use p2m_field::{HausdorffOptions, hausdorff_distance, one_sided_hausdorff_distance};
use p2m_testkit::scenes::{self, kinds_and_layout, narrow};
use p2m_testkit::{cases, rng};
use std::ops::ControlFlow;
use std::sync::Arc;

fn check<T: Real>(case: u64, [a, b]: [&Soup<T>; 2], indexes: [&dyn AnyIndex<T>; 2]) {
    let options = HausdorffOptions::new(T::round_from_f64(1e-3)).with_max_queries(20_000);
    let mut go_on = |_: &_| ControlFlow::Continue(());
    let brute = [a, b].map(|soup| BruteForce::new(soup).expect("valid"));
    let expected = hausdorff_distance((a, &brute[0]), (b, &brute[1]), &options, &mut go_on);
    let found = hausdorff_distance((a, indexes[0]), (b, indexes[1]), &options, &mut go_on);
    assert_eq!(found, expected, "{case}");
    let expected = one_sided_hausdorff_distance(a, &brute[1], &options, &mut go_on);
    assert_eq!(one_sided_hausdorff_distance(a, indexes[1], &options, &mut go_on), expected, "{case}");
    assert!(expected.is_ok_and(|found| found.is_some()), "{case}");
}

#[test]
fn all_backends_give_the_same_bounds() {
    for case in cases(500, 48) {
        let (mut rng, (kinds, layout)) = (rng("hausdorff of backends", case), kinds_and_layout(case));
        let soups = [30, 60].map(|len| Arc::new(scenes::soup(&mut rng, kinds, layout, len)));
        let [Some(a), Some(b)] = [0, 1].map(|k: usize| narrow(&soups[k]).map(Arc::new)) else {
            panic!("coordinates are small")
        };
        for backend in BACKENDS {
            let settings = BuildSettings::default();
            let [built_a, built_b] = [0, 1].map(|k| backend.build(Arc::clone(&soups[k]), &settings).expect("valid"));
            check(case, [&soups[0], &soups[1]], [&*built_a.index, &*built_b.index]);
            let [built_a, built_b] = [&a, &b].map(|soup| backend.build_in(Arc::clone(soup), &settings).expect("valid"));
            check(case, [&a, &b], [&*built_a.index, &*built_b.index]);
        }
    }
}
