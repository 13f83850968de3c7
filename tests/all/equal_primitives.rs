//! Tests of scenes in which many primitives have the same vertices, such as the invalid returns of a scanner. All
//! indexes answer as the primitives one by one do, and searches do not visit equal primitives one by one.
#![cfg(all(feature = "bvh", feature = "interception", feature = "kdop"))]
#![allow(clippy::float_cmp, reason = "bitwise equality is what is tested")]

use nalgebra::{Isometry3, Point3, Vector3};
use p2m::batch::{self, BatchOptions, Interruptible};
use p2m::core::{Collector, IndexStats, Near, Projection};
use p2m::pair::{PairOptions, PairQuery};
use p2m::storage::{SavedFile, Writer};
use p2m::{
    Aabb, AabbTree, BoxQuery, BruteForce, BuildIndex, CertifiedQuery, Closest, ClosestPoint, Element, Feature,
    KdopTree, NearQuery, OctreeIndex, P2mIndex, PrimitiveId, PrimitiveSet, QueryOptions, Ray, RayQuery, Real, Soup,
};
use p2m_testkit::ball::Ball;
use p2m_testkit::saved_file::{correct_checksums, section_mut};
use p2m_testkit::{cases, rng, vector};
use rand::{Rng, RngExt};
use std::cell::Cell;
use std::ops::ControlFlow;

/// Returns a scene of several groups of primitives with the same vertices and some single primitives, in any order. All
/// groups but the first have the same centre.
fn scene<T: Real>(rng: &mut impl Rng, groups: &[usize], singles: usize) -> Soup<T> {
    let mut positions: Vec<Point3<T>> = Vec::new();
    let mut elements = Vec::new();
    let mut add = |rng: &mut dyn Rng, count: usize, corners: [Vector3<f64>; 3]| {
        let first = u32::try_from(positions.len()).expect("few");
        positions.extend(corners.map(|corner| Point3::from(corner.map(T::round_from_f64))));
        let element = match rng.random_range(0..3) {
            0 => Element::Point(first),
            1 => Element::Segment([first, first + 1]),
            _ => Element::Triangle([first, first + 1, first + 2]),
        };
        elements.extend(std::iter::repeat_n(element, count));
    };
    for (number, count) in groups.iter().enumerate() {
        let at = if number == 0 { Vector3::zeros() } else { Vector3::new(0.25, 0.5, 0.125) };
        let half = vector(rng);
        // The box of a triangle of two opposite corners and their middle has the same centre as the box of a point.
        add(rng, *count, [at, at + half, at - half].map(|corner| corner.map(|x| (x * 64.0).round() / 64.0)));
    }
    for _ in 0..singles {
        let at = vector(rng) * 2.0;
        let corners = [(); 3].map(|()| at + vector(rng) * 0.1);
        add(rng, 1, corners);
    }
    for i in (1..elements.len()).rev() {
        elements.swap(i, rng.random_range(0..=i));
    }
    Soup::new(positions, elements).expect("valid")
}

fn bits<T: Real>(closest: &Closest<T>) -> (u64, PrimitiveId, Point3<T>, Feature) {
    (closest.distance.to_f64().to_bits(), closest.primitive, closest.point, closest.feature)
}

/// Returns the answers of an index about near primitives, as text.
fn answers<T: Real>(index: &(impl ClosestPoint<T> + CertifiedQuery<T>), at: &Point3<T>) -> String {
    let mut text = format!("{:?}", index.closest_point(at).as_ref().map(bits));
    for k in [1, 5, 17, 300] {
        text += &format!("{:?}", index.k_nearest(at, k, T::INFINITY).iter().map(bits).collect::<Vec<_>>());
    }
    let radius = T::round_from_f64(1.0);
    text += &format!("{:?}", index.all_within(at, radius).iter().map(bits).collect::<Vec<_>>());
    let among = index.closest_point_among(at, &QueryOptions::default(), &mut |id| id.index() % 50 == 49);
    text += &format!("{:?}", among.as_ref().map(bits));
    let certified = index.certified_closest_point(at, &QueryOptions::default()).expect("vertices");
    text + &format!("{:?}", certified.map(|one| (one.primitive, one.distance.to_f64().to_bits())))
}

fn check_near<T: Real>(case: u64, soup: &Soup<T>, queries: &[Point3<T>]) {
    let brute = BruteForce::new(soup).expect("valid");
    let aabb = AabbTree::new(soup).expect("valid");
    let kdop = KdopTree::<T, _, 14>::new(soup).expect("valid");
    let octree = OctreeIndex::build(soup, &Default::default()).expect("valid");
    let p2m = P2mIndex::build(soup, &Default::default()).expect("valid");
    for at in queries {
        let expected = answers(&brute, at);
        let found = [answers(&aabb, at), answers(&kdop, at), answers(&octree, at), answers(&p2m, at)];
        assert!(found.iter().all(|answer| *answer == expected), "{case}: {at}: {expected} {found:?}");
    }
    let expected: Vec<_> = queries.iter().map(|at| brute.closest_point(at).as_ref().map(bits)).collect();
    for index in [&aabb as &(dyn ClosestPoint<T> + Sync), &kdop, &octree, &p2m] {
        let mut found = vec![None; queries.len()];
        let batch = BatchOptions::default().with_parallel(false);
        batch::closest_points_into(index, queries, &QueryOptions::default(), &batch, &mut found);
        assert!(found.iter().map(|closest| closest.as_ref().map(bits)).eq(expected.iter().copied()), "{case}: a batch");
    }
}

fn queries<T: Real>(rng: &mut impl Rng, soup: &Soup<T>) -> Vec<Point3<T>> {
    let far = [1.0, 3.0, 1e15].map(|far| (0..4).map(|_| vector(rng) * far).collect::<Vec<_>>()).concat();
    let on = soup.positions().iter().step_by(3).take(4).copied();
    far.into_iter().map(|at| Point3::from(at.map(T::round_from_f64))).chain(on).collect()
}

#[test]
fn equal_primitives_have_the_answers_of_brute_force() {
    for case in cases(300, 12) {
        let mut rng = rng("equal primitives", case);
        // The third group does not fill its last packet, and the second one has one primitive more than a packet.
        let groups = [[200, 17, 37, 1], [16, 33, 90, 15], [300, 0, 0, 0]][rng.random_range(0..3)];
        let singles = [0, 8, 100][rng.random_range(0..3)];
        let soup = scene::<f64>(&mut rng, &groups, singles);
        let at = queries(&mut rng, &soup);
        check_near(case, &soup, &at);
        let single = scene::<f32>(&mut rng, &groups, singles);
        let at = queries(&mut rng, &single);
        check_near(case, &single, &at);
    }
}

/// Returns the ids that intersect a box, a ray and a scene, in ascending order.
fn met(index: &(impl BoxQuery<f64> + RayQuery<f64> + PairQuery<f64>), other: &Soup<f64>, ray: &Ray) -> [Vec<usize>; 4] {
    let bounds = Aabb { min: Point3::new(-0.5, -0.5, -0.5), max: Point3::new(0.5, 0.5, 0.25) };
    let mut ids: [Vec<usize>; 4] = Default::default();
    let _ = index.visit_box(&bounds, &mut |id| {
        ids[0].push(id.index());
        ControlFlow::Continue(())
    });
    ids[1].extend(index.all_intersections(ray).iter().map(|hit| hit.primitive.index()));
    ids[1].extend(index.first_intersection(ray).map(|hit| hit.primitive.index()));
    let within = PairOptions::default().with_max_distance(0.3).with_motion(Isometry3::translation(0.1, 0.0, 0.0));
    let tree = AabbTree::new(other).expect("valid");
    let _ = index.visit_pairs_within(&tree, &within, &mut |pair| {
        ids[2].push(pair.primitives[0].index() * other.len() + pair.primitives[1].index());
        ControlFlow::Continue(())
    });
    let shape = other.get(PrimitiveId::new(0));
    let _ = index.visit_near(&shape, &within, &mut |pair| {
        ids[3].push(pair.primitives[0].index());
        ControlFlow::Continue(())
    });
    ids[0].sort_unstable();
    ids[2].sort_unstable();
    ids[3].sort_unstable();
    let nearest = [index.closest_pair(&tree, &within), index.closest_to(&shape, &within)];
    ids[3].extend(nearest.into_iter().flatten().flat_map(|pair| pair.primitives).map(PrimitiveId::index));
    ids
}

#[test]
fn boxes_rays_and_pairs_meet_all_equal_primitives() {
    let mut total = [0; 4];
    for case in cases(100, 8) {
        let mut rng = rng("equal primitives met", case);
        let soup = scene::<f64>(&mut rng, &[90, 40, 17], 20);
        let other = scene::<f64>(&mut rng, &[35, 20], 10);
        let aim = soup.positions()[3 * rng.random_range(0..3)].coords;
        let origin = vector(&mut rng) * 4.0;
        let ray = Ray::new(&Point3::from(origin), &(aim - origin)).expect("finite");
        let expected = met(&BruteForce::new(&soup).expect("valid"), &other, &ray);
        assert_eq!(met(&AabbTree::new(&soup).expect("valid"), &other, &ray), expected, "{case}");
        assert_eq!(met(&KdopTree::<f64, _, 14>::new(&soup).expect("valid"), &other, &ray), expected, "{case}");
        for (total, ids) in total.iter_mut().zip(&expected) {
            *total += ids.len();
        }
    }
    assert!(total.iter().all(|count| *count > 100), "{total:?}");
}

/// A tree that counts the nodes and packets visited by searches for near primitives.
struct Counted<'a, I>(&'a I, &'a Cell<usize>);

macro_rules! counted {
    ($($index:ty),*) => {
        $(impl NearQuery<f64> for Counted<'_, $index> {
            fn search_near(&self, query: &Point3<f64>, near: &mut Near<'_>) {
                self.0.visit(query, &mut Visits(near, self.1));
            }
        })*
    };
}
counted!(AabbTree<f64, &Soup<f64>>, KdopTree<f64, &Soup<f64>, 14>);

/// Counts the visits of nodes and packets of a search.
struct Visits<'a, 'b>(&'a mut Near<'b>, &'a Cell<usize>);

impl Collector for Visits<'_, '_> {
    fn prune_above(&self) -> f64 {
        self.0.prune_above()
    }
    fn prune_above_for_id(&self, id: PrimitiveId) -> f64 {
        self.0.prune_above_for_id(id)
    }
    fn offer(&mut self, id: PrimitiveId, projection: Projection) {
        self.0.offer(id, projection);
    }
    fn visit_node(&mut self) {
        self.1.set(self.1.get() + 1);
    }
    fn visit_packet(&mut self) {
        self.1.set(self.1.get() + 1);
    }
}

/// The scene has more than 1,200 packets of equal primitives.
#[test]
fn few_equal_primitives_are_visited() {
    for case in cases(20, 6) {
        let mut rng = rng("visits of equal primitives", case);
        // Three single primitives are so near to the equal ones that only exact coordinates distinguish them.
        let mut soup = scene::<f64>(&mut rng, &[20_000, 3, 2], 100);
        if case.is_multiple_of(2) {
            soup = scene::<f64>(&mut rng, &[20_000], 0);
        }
        let at = queries(&mut rng, &soup);
        let aabb = AabbTree::new(&soup).expect("valid");
        let kdop = KdopTree::<f64, _, 14>::new(&soup).expect("valid");
        let octree = OctreeIndex::build(&soup, &Default::default()).expect("valid");
        let p2m = P2mIndex::build(&soup, &Default::default()).expect("valid");
        for index in [&aabb as &dyn IndexStats<f64>, &kdop, &octree, &p2m] {
            let counts = index.count_queries(&at);
            assert!(counts[0] + counts[1] < 30 * at.len() && counts[2] < 40 * at.len(), "{case}: {counts:?}");
        }
        let visits = Cell::new(0);
        for query in &at {
            for k in [1, 8, 100] {
                let found = Counted(&aabb, &visits).k_nearest(query, k, f64::INFINITY);
                assert_eq!(Counted(&kdop, &visits).k_nearest(query, k, f64::INFINITY), found);
            }
        }
        assert!(visits.get() < 2 * 3 * 20 * at.len(), "{case}: {} visits", visits.get());
        let steps = Cell::new(0);
        let counting = Interruptible::pairs(&aabb, || {
            steps.set(steps.get() + 1);
            true
        });
        let shape = soup.get(PrimitiveId::new(5));
        let moved = PairOptions::default().with_motion(Isometry3::translation(3.0, 0.0, 0.0));
        assert!(counting.closest_to(&shape, &moved).is_some() && counting.closest_pair(&kdop, &moved).is_some());
        assert!(steps.get() < 200, "{case}: {} steps", steps.get());
    }
}

#[test]
fn equal_primitives_that_move_apart_are_found() {
    for case in cases(60, 6) {
        let mut rng = rng("moved equal primitives", case);
        let count = 500;
        // The primitives have separate vertices, so that they can move.
        let points = |at: &mut dyn FnMut(usize) -> Point3<f64>| -> Soup<f64> {
            Soup::new((0..count).map(at).collect(), (0..count as u32).map(Element::Point)).expect("valid")
        };
        let equal = points(&mut |_| Point3::origin());
        let moved = points(&mut |_| Point3::new(1.0, 2.0, 3.0));
        let lone = rng.random_range(0..count);
        let parted = points(&mut |i| Point3::new(f64::from(u8::from(i == lone)) * 1e-12, 0.0, 0.0));
        let strewn = points(&mut |_| vector(&mut rng).into());
        let mut aabb = AabbTree::new(equal.clone()).expect("valid");
        let mut kdop = KdopTree::<f64, _, 14>::new(equal).expect("valid");
        for soup in [&moved, &parted, &strewn, &moved] {
            aabb.refit(soup.clone(), &Default::default()).expect("finite");
            kdop.refit(soup.clone(), &Default::default()).expect("finite");
            let brute = BruteForce::new(soup).expect("valid");
            for at in [soup.positions()[lone], Point3::new(1e-9, 0.0, 0.0), Point3::from(vector(&mut rng))] {
                let expected = answers(&brute, &at);
                assert_eq!(answers(&aabb, &at), expected, "{case}: {at}");
                assert_eq!(answers(&kdop, &at), expected, "{case}: {at}");
            }
        }
    }
}

#[test]
fn saved_trees_of_equal_primitives_answer_as_before() {
    let mut rng = rng("saved equal primitives", 0);
    let soup = scene::<f64>(&mut rng, &[200, 50], 30);
    let tree = AabbTree::new(&soup).expect("valid");
    let mut writer = Writer::default();
    tree.save(&mut writer);
    let mut bytes = Vec::new();
    writer.write(&mut bytes).expect("memory");
    let loaded =
        AabbTree::load(&soup, SavedFile::read(&bytes[..]).expect("a file").unchecked()).expect("as it was saved");
    for at in queries(&mut rng, &soup) {
        assert_eq!(answers(&loaded, &at), answers(&tree, &at));
    }
    // A view of the tree shows every primitive once.
    let parts: Vec<_> = tree.tree().parts().collect();
    let mut ids: Vec<_> = parts.iter().filter_map(|part| tree.tree().primitives(part)).flatten().collect();
    ids.sort_unstable();
    assert!(ids.into_iter().map(|id| id.index()).eq(0..soup.len()));
}

/// Loads a tree over a set from a forged file, in which some packets continue the previous packet and are no child any
/// more.
fn forged<S: PrimitiveSet<f64> + Copy + Sync>(set: S, is_forged: impl Fn(usize) -> bool) -> Result<(), String> {
    const PACKET: usize = 448;
    const IS_CONTINUED: usize = 406;
    let tree = AabbTree::new(set).expect("valid");
    let mut writer = Writer::default();
    tree.save(&mut writer);
    let mut bytes = Vec::new();
    writer.write(&mut bytes).expect("memory");
    let packets = section_mut(&mut bytes, "tree/packets").len() / PACKET;
    assert!(packets > 1);
    for packet in (1..packets).filter(|packet| is_forged(*packet)) {
        let reference = (1 << 31 | u32::try_from(packet).expect("few")).to_le_bytes();
        let children = section_mut(&mut bytes, "tree/children");
        let at = children.chunks_exact(4).position(|child| child == reference).expect("a child");
        children[4 * at..][..4].copy_from_slice(&u32::MAX.to_le_bytes());
        section_mut(&mut bytes, "tree/packets")[(packet - 1) * PACKET + IS_CONTINUED] = 1;
    }
    correct_checksums(&mut bytes);
    let file = SavedFile::read(&bytes[..]).expect("a file");
    let tree = AabbTree::<f64, S>::load(set, file.checked().expect("whole")).map_err(|error| error.to_string())?;
    // Searches end, whatever they find.
    let origin = Point3::origin();
    tree.closest_point(&origin);
    assert!(tree.k_nearest(&origin, 24, f64::INFINITY).len() <= 24);
    tree.closest_to(&p2m::Point::new(origin), &PairOptions::default());
    Ok(())
}

#[test]
fn forged_runs_are_refused_or_harmless() {
    // Packets of primitives without vertices are never continued.
    let balls: Vec<Ball> =
        (0..24u8).map(|i| Ball { centre: Point3::new(f64::from(i), 0.0, 0.0), radius: 0.25 }).collect();
    let refused = forged(&balls[..], |packet| packet == 1).expect_err("no ball has vertices");
    assert!(refused.contains("a number is out of range"), "{refused}");
    // A node keeps a child.
    let mut accepted = 0;
    for case in cases(1000, 60) {
        let mut rng = rng("forged runs", case);
        let soup: Soup<f64> = scene(&mut rng, &[], 100);
        let all = case == 0;
        let some: Vec<bool> = (0..100).map(|_| all || rng.random()).collect();
        match forged(&soup, |packet| some[packet]) {
            Ok(()) => accepted += 1,
            Err(refused) => assert!(refused.contains("a node has no child"), "{refused}"),
        }
    }
    assert!(accepted > 0, "other runs are accepted");
}
