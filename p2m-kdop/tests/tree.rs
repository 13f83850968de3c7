//! Tests k-DOP trees: every instruction set, moved sets, box queries, and the work of queries.
#![allow(clippy::float_cmp, reason = "bitwise equality is what is tested")]

use nalgebra::{Point3, Rotation3, Vector3};
use p2m_bvh::AabbTree;
use p2m_bvh::{TreeIndex, Volume};
use p2m_core::IndexStats;
use p2m_core::Isa;
use p2m_core::{Aabb, BoxQuery, BruteForce, BuildError, ClosestPoint, Point, Primitive, PrimitiveSet, Soup};
use p2m_kdop::Directions;
use p2m_kdop::{KdopOptions, KdopTree};
use p2m_testkit::queries::QuerySet;
use p2m_testkit::scenes::{self, KINDS, LAYOUTS, kinds_and_layout};
use p2m_testkit::{amount, cases, rng};
use rand::RngExt;
use std::cell::Cell;
use std::ops::ControlFlow;
use std::sync::Arc;

type Tree<'a, const K: usize> = KdopTree<f64, &'a Soup<f64>, K>;

/// Returns the nodes and packets that all queries visit.
fn work<V: Volume>(tree: &TreeIndex<f64, &Soup<f64>, V>, queries: &[Point3<f64>]) -> [usize; 2] {
    let [nodes, packets, _] = tree.count_queries(queries);
    [nodes, packets]
}

fn model(name: &str) -> Option<Soup<f64>> {
    let path = p2m_testkit::model_files().into_iter().find(|path| path.ends_with(name))?;
    Some(Arc::unwrap_or_clone(p2m_mixed::read_scene(&path).expect("readable").soup))
}

fn built<const K: usize>(soup: &Soup<f64>) -> Tree<'_, K>
where
    Directions<K>: Default,
{
    Tree::<K>::new(soup).expect("valid")
}

#[test]
fn every_instruction_set_refitted_and_boxes_agree_with_brute_force() {
    for case in cases(24, 24) {
        let (mut rng, (kinds, layout)) = (rng("kdop", case), kinds_and_layout(case));
        let soup = scenes::soup(&mut rng, kinds, layout, amount(300, 80));
        let turn = Rotation3::new(Vector3::new(0.2, 0.4, 0.7));
        let moved: Vec<_> = soup.positions().iter().map(|p| turn * p * 3.0).collect();
        let moved = Soup::new(moved, soup.elements()).expect("finite");
        let tree = built::<14>(&soup);
        for isa in Isa::available() {
            let mut tree = tree.clone().with_isa(isa);
            for (scene, refit) in [(&soup, false), (&moved, true)] {
                if refit {
                    tree.refit(scene, &KdopOptions::default()).expect("as many");
                }
                let brute = BruteForce::new(scene).expect("valid");
                for _ in 0..amount(40, 5) {
                    let q = scenes::query(&mut rng, scene.positions());
                    let [found, expected] = [tree.closest_point(&q), brute.closest_point(&q)]
                        .map(|c| c.map(|c| (c.distance, c.primitive, c.feature, c.point)));
                    assert_eq!(found, expected, "case {case}: {isa} {kinds:?} {layout:?} {q}");
                    let half_extent = Vector3::from_fn(|_, _| rng.random_range(0.0..0.2))
                        * (scene.aabb().max - scene.aabb().min).norm();
                    let bounds = Aabb { min: q - half_extent, max: q + half_extent };
                    let (mut found, mut expected) = (Vec::new(), Vec::new());
                    tree.primitives_in_box_into(&bounds, &mut found);
                    brute.primitives_in_box_into(&bounds, &mut expected);
                    assert_eq!(found, expected, "case {case}: {isa} {kinds:?} {layout:?} {bounds:?}");
                }
            }
        }
    }
    let mut rng = rng("kdop", u64::MAX);
    let few = scenes::soup(&mut rng, KINDS[0], LAYOUTS[0], 20);
    let other = scenes::soup(&mut rng, KINDS[0], LAYOUTS[0], 30);
    let error = built::<18>(&few).refit(&other, &KdopOptions::default());
    assert_eq!(error, Err(BuildError::OtherLength { len: other.len(), expected: few.len() }));
}

/// Checks that more faces lead to fewer nodes and packets, and that k-DOPs visit fewer than boxes. `most` is the
/// largest percentage of the nodes of 6 faces that 14, 18 and 26 faces may visit, for queries in the box.
fn check_work_falls(soup: &Soup<f64>, max_percent: [usize; 3]) {
    let boxes = AabbTree::new(soup).expect("valid");
    let trees = (built::<6>(soup), built::<14>(soup), built::<18>(soup), built::<26>(soup));
    for set in [QuerySet::Box10, QuerySet::Box1, QuerySet::Near, QuerySet::Surface] {
        let queries = set.generate(soup, amount(2000, 200), 1);
        let boxes = work(&boxes, &queries);
        let rows =
            [work(&trees.0, &queries), work(&trees.1, &queries), work(&trees.2, &queries), work(&trees.3, &queries)];
        println!("{set}: boxes {boxes:?}, k-DOPs {rows:?} nodes and packets");
        // The 6-DOP of the axes is the box.
        let [six, fourteen, eighteen, all] = rows;
        assert!(
            six[0].abs_diff(boxes[0]) * 1000 <= boxes[0] && six[1].abs_diff(boxes[1]) * 1000 <= boxes[1],
            "{six:?} {boxes:?}"
        );
        // The sets of 14 and of 18 directions are not subsets of each other, so far from the scene 14 may visit less.
        for (more, less) in [(fourteen, six), (eighteen, six), (all, fourteen), (all, eighteen)] {
            assert!(more[0] < less[0] && more[1] < less[1], "{set}: {rows:?}");
        }
        if set == QuerySet::Near || set == QuerySet::Surface {
            assert!(eighteen[0] < fourteen[0] && eighteen[1] < fourteen[1], "{set}: {rows:?}");
        }
        if set == QuerySet::Box1 {
            for (row, max_percent) in rows[1..].iter().zip(max_percent) {
                assert!(row[0] * 100 <= six[0] * max_percent, "{rows:?}");
            }
        }
    }
}

#[test]
fn visits_fall_with_the_number_of_faces_on_a_turned_gear() {
    check_work_falls(&scenes::skewed_gear(amount(2000, 600)), amount([70, 66, 58], [74, 70, 64]));
    if let Some(soup) = model("gear_skewed_57k_rotated.ply") {
        check_work_falls(&soup, [65, 66, 53]);
    }
}

#[test]
fn boxes_of_any_size_hold_their_points() {
    for size in [1e-300, 1e150, 1e300, 0.5 * f64::MAX, 0.7 * f64::MAX, f64::MAX] {
        for size in [size, -size] {
            let points: Vec<_> = (0..40).map(|i| Point3::from([size * (1.0 - f64::from(i) / 99.0); 3])).collect();
            let set: Vec<_> = points.iter().copied().map(Point::new).collect();
            let tree = KdopTree::<f64, _, 26>::new(&set).expect("finite");
            let mut found = Vec::new();
            tree.primitives_in_box_into(
                &Aabb::from_points(&[[-f64::MAX; 3], [f64::MAX; 3]].map(Point3::from)),
                &mut found,
            );
            assert_eq!(found.len(), points.len(), "{size:e}");
            assert!(points.iter().all(|p| tree.intersects_box(&Aabb { min: *p, max: *p })), "{size:e}");
        }
    }
}

/// A box query skips leaves whose boxes intersect the box if their k-DOPs do not.
#[test]
fn fewer_primitives_are_asked_by_box_queries_with_more_faces() {
    fn tested_primitives<const K: usize>(soup: &Soup<f64>, boxes: &[Aabb<f64>]) -> usize
    where
        Directions<K>: Default,
    {
        let tree = built::<K>(soup);
        let tested_primitives = Cell::new(0);
        for bounds in boxes {
            let is_hit = |id| {
                tested_primitives.set(tested_primitives.get() + 1);
                Primitive::intersects_box(&soup.get(id), bounds)
            };
            let _ = tree.tree().visit_box(bounds, is_hit, &mut |_| ControlFlow::Continue(()));
        }
        tested_primitives.get()
    }
    let soup = scenes::skewed_gear(amount(500, 300));
    let half_extent = Vector3::repeat(0.03);
    let queries = QuerySet::Near.generate(&soup, amount(300, 50), 1);
    let boxes: Vec<_> = queries.iter().map(|q| Aabb { min: q - half_extent, max: q + half_extent }).collect();
    let counts = [
        tested_primitives::<6>(&soup, &boxes),
        tested_primitives::<14>(&soup, &boxes),
        tested_primitives::<26>(&soup, &boxes),
    ];
    println!("{counts:?} primitives asked");
    assert!(counts[1] * 10 < counts[0] * 8 && counts[2] < counts[1], "{counts:?}");
}
