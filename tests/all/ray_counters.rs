//! Checks the work of rays by counters, which are deterministic.
#![cfg(all(feature = "bvh", feature = "kdop"))]

use p2m::bvh::{TreeIndex, Volume};
use p2m::core::{Hits, RayStatsCollector};
use p2m::kdop::Directions;
use p2m::{AabbTree, KdopTree, Ray, Soup};
use p2m_testkit::queries::QuerySet;
use p2m_testkit::rng;
use p2m_testkit::scenes::{self, KINDS, LAYOUTS};
use rand::RngExt;
use std::sync::Arc;

fn model(name: &str) -> Option<Soup<f64>> {
    let path = p2m_testkit::model_files().into_iter().find(|path| path.ends_with(name))?;
    Some(Arc::unwrap_or_clone(p2m::scene::read_scene(&path).expect("readable").soup))
}

/// Returns the numbers of nodes and packets that searches for all hits visit, summed over all rays.
fn work<V: Volume>(tree: &TreeIndex<f64, &Soup<f64>, V>, rays: &[Ray]) -> [usize; 2] {
    let [nodes, packets, _] =
        RayStatsCollector::count_rays(rays, &Hits::all(), |ray, counting| tree.visit_ray(ray, counting));
    [nodes, packets]
}

fn built<const K: usize>(soup: &Soup<f64>) -> KdopTree<f64, &Soup<f64>, K>
where
    Directions<K>: Default,
{
    KdopTree::new(soup).expect("valid")
}

/// Checks that more faces lead to less work. `max_percent` has the largest percentages of the nodes and packets of 6
/// faces that 14, 18 and 26 faces may visit.
fn check_work_falls(name: &str, soup: &Soup<f64>, max_percent: [[usize; 2]; 3]) {
    let boxes = AabbTree::new(soup).expect("valid");
    let trees = (built::<6>(soup), built::<14>(soup), built::<18>(soup), built::<26>(soup));
    // Few rays from the wider box hit the scene.
    for (set, count) in [(QuerySet::Box10, 20_000), (QuerySet::Box1, 2000)] {
        let rays = set.rays(soup, count, 1);
        let boxes = work(&boxes, &rays);
        let rows = [work(&trees.0, &rays), work(&trees.1, &rays), work(&trees.2, &rays), work(&trees.3, &rays)];
        println!("{name}, {set}: boxes {boxes:?}, k-DOPs {rows:?} nodes and packets");
        for counter in [0, 1] {
            // The 6-DOP along the axes is the box.
            let (six, boxes) = (rows[0][counter], boxes[counter]);
            assert!(six.abs_diff(boxes) * 1000 <= boxes, "{name} {set}: {six} {boxes}");
            assert!(rows.windows(2).all(|pair| pair[1][counter] < pair[0][counter]), "{name} {set}: {rows:?}");
            for (row, max_percent) in rows[1..].iter().zip(max_percent) {
                assert!(row[counter] * 100 <= six * max_percent[counter], "{name} {set}: {rows:?}");
            }
        }
    }
}

#[test]
fn visits_fall_with_the_number_of_faces_on_a_turned_gear() {
    check_work_falls("a skewed gear", &scenes::skewed_gear(2000), [[59, 50], [54, 44], [47, 36]]);
    if let Some(soup) = model("gear_skewed_57k_rotated.ply") {
        check_work_falls("gear_skewed_57k_rotated", &soup, [[50, 42], [45, 35], [37, 25]]);
    }
}

/// If neighbouring coordinates at the line differ by more than the size of the scene, the line misses the scene without
/// a test, or passes near it.
#[test]
fn lines_that_pass_far_away_cost_nothing() {
    let mut rng = rng("far away", 0);
    let soup = scenes::soup(&mut rng, KINDS[0], LAYOUTS[0], 2000);
    let (boxes, kdops) = (AabbTree::new(&soup), built::<14>(&soup));
    let boxes: AabbTree<f64, _> = boxes.expect("valid");
    for far in [1e12, 1e20, 1e100, 1e300] {
        let ray = |_| {
            let origin = p2m_testkit::vector(&mut rng) * far;
            // The line passes beside the scene, as closely as the coordinates allow, or through it.
            let beside = origin.map(|x| if rng.random() { x.next_up() } else { x });
            Ray::new(&(soup.positions()[rng.random_range(0..soup.positions().len())] + origin), &-beside)
                .expect("finite")
        };
        let rays: Vec<_> = (0..200).map(ray).collect();
        for [nodes, packets] in [work(&boxes, &rays), work(&kdops, &rays)] {
            println!("{far:e}: {nodes} nodes, {packets} packets of {} lines", rays.len());
            assert!(nodes <= 12 * rays.len() && packets <= 12 * rays.len());
        }
    }
}
