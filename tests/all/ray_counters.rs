//! Checks the work of rays with counters, which are deterministic.
#![cfg(all(feature = "bvh", feature = "kdop"))]

use p2m::backend::{Hits, RayStatsCollector};
use p2m::bvh::{TreeIndex, Volume};
use p2m::kdop::Directions;
use p2m::{AabbTree, BruteForce, BuildIndex, KdopTree, Ray, RayQuery, Soup};
use p2m_testkit::left_first::LeftFirst;
use p2m_testkit::queries::QuerySet;
use p2m_testkit::scenes::{self, KINDS, LAYOUTS, kinds_and_layout};
use p2m_testkit::{amount, cases, rng};
use rand::RngExt;
use std::sync::Arc;

fn model(name: &str) -> Option<Soup<f64>> {
    let path = p2m_testkit::model_files().into_iter().find(|path| path.ends_with(name));
    if path.is_none() {
        println!("skipped: no model {name}");
    }
    path.map(|path| Arc::unwrap_or_clone(p2m::scene::read_scene(&path).expect("readable").soup))
}

fn manual<const K: usize>(soup: &Soup<f64>) -> LeftFirst<K>
where
    Directions<K>: Default,
{
    LeftFirst::from_primitives(&soup, &Directions::default())
}

/// The manual's traversal skips no primitive that a ray intersects, because its counts would otherwise be too small.
#[test]
fn clipping_by_slabs_leaves_no_hit_out() {
    fn check<const K: usize>(soup: &Soup<f64>, rays: &[Ray]) -> usize
    where
        Directions<K>: Default,
    {
        let (tree, brute) = (manual::<K>(soup), BruteForce::new(soup).expect("valid"));
        let mut hits = 0;
        for ray in rays {
            let mut tested = Vec::new();
            let work = tree.along(ray, |id| tested.push(id));
            assert_eq!((work.leaves, work.primitives), (tested.len(), tested.len()));
            for hit in brute.all_intersections(ray) {
                assert!(tested.contains(&hit.primitive), "{K} {ray:?} {hit:?}");
                hits += 1;
            }
        }
        hits
    }
    let mut hits = 0;
    let cases = cases(24, 24);
    for case in cases.clone() {
        let (mut rng, (kinds, layout)) = (rng("clipping by slabs", case), kinds_and_layout(case));
        let soup = scenes::soup(&mut rng, kinds, layout, 100);
        let rays: Vec<_> = (0..amount(60, 12))
            .filter_map(|_| {
                let [from, to] = [(); 2].map(|()| scenes::query(&mut rng, soup.positions()));
                let mut ray = Ray::through(&from, &to).ok()?;
                if rng.random_range(0..3) == 0 {
                    // This ray is parallel to the faces of most slabs.
                    let mut along = ray.direction();
                    along[rng.random_range(0..3)] = 0.0;
                    ray = Ray::new(&from, &along).ok()?;
                }
                let ray = if rng.random() { ray.line() } else { ray };
                if rng.random() { ray.with_radius(0.01).ok() } else { Some(ray) }
            })
            .collect();
        hits += check::<6>(&soup, &rays) + check::<14>(&soup, &rays) + check::<26>(&soup, &rays);
    }
    assert!(cases.have_more_than(amount(1000, 192), hits), "{hits}");
}

/// Returns the nodes and packets that searches for all hits visit, for all rays.
fn work<V: Volume>(tree: &TreeIndex<f64, &Soup<f64>, V>, rays: &[Ray]) -> [usize; 2] {
    let [nodes, packets, _] =
        RayStatsCollector::count_rays(rays, &Hits::all(), |ray, counting| tree.visit_ray(ray, counting));
    [nodes, packets]
}

fn built<const K: usize>(soup: &Soup<f64>) -> KdopTree<f64, &Soup<f64>, K>
where
    Directions<K>: Default,
{
    KdopTree::build(soup, &Default::default()).expect("valid")
}

/// Both counters for 6, 14, 18 and 26 faces.
type Rows = [[usize; 2]; 4];

/// The trees that are compared: of boxes, of k-DOPs, and those of the manual.
struct Trees<'a> {
    boxes: AabbTree<f64, &'a Soup<f64>>,
    ours: (Kdops<'a, 6>, Kdops<'a, 14>, Kdops<'a, 18>, Kdops<'a, 26>),
    theirs: (LeftFirst<6>, LeftFirst<14>, LeftFirst<18>, LeftFirst<26>),
}

type Kdops<'a, const K: usize> = KdopTree<f64, &'a Soup<f64>, K>;

impl<'a> Trees<'a> {
    fn build(soup: &'a Soup<f64>) -> Self {
        Self {
            boxes: AabbTree::build(soup, &Default::default()).expect("valid"),
            ours: (built(soup), built(soup), built(soup), built(soup)),
            theirs: (manual(soup), manual(soup), manual(soup), manual(soup)),
        }
    }
}

fn rows(name: &str, trees: &Trees<'_>, rays: &[Ray]) -> (Rows, Rows) {
    let Trees { boxes, ours, theirs } = trees;
    let boxes = work(boxes, rays);
    let ours = [work(&ours.0, rays), work(&ours.1, rays), work(&ours.2, rays), work(&ours.3, rays)];
    let theirs =
        [theirs.0.along_all(rays), theirs.1.along_all(rays), theirs.2.along_all(rays), theirs.3.along_all(rays)]
            .map(|work| [work.nodes, work.leaves]);
    println!("{name}: boxes {boxes:?}, k-DOPs {ours:?} nodes and packets; {theirs:?} binary nodes and leaves");
    // The 6-DOP of the axes is the box.
    for (six, boxes) in ours[0].iter().zip(boxes) {
        assert!(six.abs_diff(boxes) * 1000 <= boxes, "{name}: {six} {boxes}");
    }
    (ours, theirs)
}

/// Checks that more faces lead to less work with either tree, as in the manual's table, where 56, 49 and 43 % of the
/// nodes remain and 44, 32 and 25 % of the leaves.
fn check_work_falls(name: &str, soup: &Soup<f64>, max_percent: [[[usize; 2]; 3]; 2]) {
    let trees = Trees::build(soup);
    // Few rays from the wider box hit the scene.
    for (set, count) in [(QuerySet::Box10, 20_000), (QuerySet::Box1, 2000)] {
        let (ours, theirs) = rows(&format!("{name}, {set}"), &trees, &set.rays(soup, count, 1));
        for (rows, max_percent) in [ours, theirs].iter().zip(max_percent) {
            for counter in [0, 1] {
                let falling = rows.windows(2).all(|pair| pair[1][counter] < pair[0][counter]);
                assert!(falling, "{name} {set}: {rows:?}");
                for (row, max_percent) in rows[1..].iter().zip(max_percent) {
                    assert!(row[counter] * 100 <= rows[0][counter] * max_percent[counter], "{name} {set}: {rows:?}");
                }
            }
        }
    }
}

#[test]
fn visits_fall_with_the_number_of_faces_on_a_turned_gear() {
    check_work_falls(
        "a skewed gear",
        &scenes::skewed_gear(2000),
        [[[59, 50], [54, 44], [47, 36]], [[49, 47], [44, 41], [36, 32]]],
    );
    if let Some(soup) = model("gear_skewed_57k_rotated.ply") {
        check_work_falls(
            "gear_skewed_57k_rotated",
            &soup,
            [[[50, 42], [45, 35], [37, 25]], [[43, 42], [36, 34], [27, 24]]],
        );
    }
}

/// Lines so far away that neighbouring coordinates differ by more than the scene's size miss it without a test, or
/// pass near it.
#[test]
fn lines_that_pass_far_away_cost_nothing() {
    let mut rng = rng("far away", 0);
    let soup = scenes::soup(&mut rng, KINDS[0], LAYOUTS[0], 2000);
    let (boxes, kdops) = (AabbTree::build(&soup, &Default::default()), built::<14>(&soup));
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
