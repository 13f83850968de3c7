//! Tests the P2M index: ties in lattices, symmetric shapes, slivers, instruction sets, progress, other collectors, and
//! the work of queries. `tests/all/agreement.rs` compares its answers with brute force on random scenes.
#![allow(clippy::float_cmp, reason = "bitwise equality is what is tested")]

use crate::agreement;
use nalgebra::{Point3, Vector3};
use p2m_core::IndexStats;
use p2m_core::Projection;
use p2m_core::{
    Aabb, BruteForce, BuildIndex, Closest, ClosestPoint, Point, Primitive, PrimitiveSet, Segment, Shape, Soup, Triangle,
};
use p2m_interception::{BuildStage, Partition, Progress};
use p2m_interception::{P2mIndex, P2mOptions};
use p2m_testkit::ball::Ball;
use p2m_testkit::near_check::compared_fields;
use p2m_testkit::scenes::{self, Kinds, Layout, kinds_and_layout};
use p2m_testkit::{amount, cases, rng, vector};
use rand::{Rng, RngExt};
use std::path::PathBuf;
use std::sync::Mutex;

fn built<S: PrimitiveSet<f64> + Sync>(set: S) -> P2mIndex<f64, S> {
    P2mIndex::new(set).expect("valid")
}

/// Compares the default index of a set with brute force.
fn agrees<S: PrimitiveSet<f64> + Sync + Copy>(name: &str, set: S, queries: &[Point3<f64>]) {
    agreement::agrees(name, set, built(set), queries);
}

/// Returns queries on, near and between vertices, around, far from and beyond the domain of a scene of about size 1.
fn queries(rng: &mut impl Rng, shapes: &[Shape<f64>], count: usize) -> Vec<Point3<f64>> {
    let vertex = |rng: &mut dyn FnMut(usize) -> usize| {
        let vertices = shapes[rng(shapes.len())].vertices().to_vec();
        vertices[rng(vertices.len())]
    };
    (0..count)
        .map(|_| {
            let mut index = |n: usize| rng.random_range(0..n);
            let (a, b) = (vertex(&mut index), vertex(&mut index));
            match rng.random_range(0..7) {
                0 => a,
                1 => nalgebra::center(&a, &b),
                2 => a + vector(rng) * 2f64.powi(-rng.random_range(1..40)),
                3 => a + (a - b) * rng.random_range(0.0..4.0),
                4 => Point3::from(vector(rng) * 0.6),
                5 => Point3::from(vector(rng) * 5.0),
                _ => Point3::from(vector(rng) * 2f64.powi(rng.random_range(0..50))),
            }
        })
        .collect()
}

/// Returns the surface of a cube of n x n squares a side whose coordinates are multiples of a step, so that
/// ties are everywhere.
fn lattice(n: i32, step: f64) -> Vec<Shape<f64>> {
    let mut shapes = Vec::new();
    let at = |axis: usize, side: i32, i: i32, j: i32| {
        let mut p = [0.0; 3];
        (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) = (f64::from(side * n), f64::from(i), f64::from(j));
        Point3::from(p.map(|x| x * step - 0.5))
    };
    for axis in 0..3 {
        for side in 0..2 {
            for i in 0..n {
                for j in 0..n {
                    let corner = |x: i32, y: i32| at(axis, side, i + x, j + y);
                    shapes.push(Triangle::new(corner(0, 0), corner(1, 0), corner(1, 1)).into());
                    shapes.push(Triangle::new(corner(0, 0), corner(1, 1), corner(0, 1)).into());
                }
            }
        }
    }
    shapes
}

#[test]
fn ties_of_lattices_go_to_the_lowest_id() {
    for (n, step) in [(1, 1.0), (4, 0.25), (5, 0.2), (amount(16, 6), amount(0.0625, 0.125))] {
        let shapes = lattice(n, step);
        let mut rng = rng("p2m lattice", n as u64);
        let mut all = queries(&mut rng, &shapes, amount(800, 60));
        // These queries are on the planes between vertices.
        all.extend((0..amount(800, 60)).map(|_| {
            let cells = [(); 3].map(|()| f64::from(rng.random_range(-4 * n..6 * n)) * 0.5);
            Point3::from(cells.map(|x| x * step - 0.5))
        }));
        agrees(&format!("cube of {n}"), &shapes[..], &all);
    }
}

fn turn(i: u32, n: u32) -> (f64, f64) {
    (f64::from(i) * std::f64::consts::TAU / f64::from(n)).sin_cos()
}

/// Returns a sphere by rings, whose circumcentres coincide.
fn sphere(rings: u32, around: u32) -> Vec<Shape<f64>> {
    let at = |i: u32, j: u32| {
        let (z, r) = turn(i, 2 * rings);
        let (s, c) = turn(j, around);
        Point3::new(0.5 * z * c, 0.5 * z * s, 0.5 * r)
    };
    let mut shapes: Vec<Shape<f64>> = Vec::new();
    for i in 0..rings {
        for j in 0..around {
            let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
            shapes.extend([Triangle::new(a, b, c), Triangle::new(a, c, d)].map(Shape::from));
        }
    }
    shapes
}

fn rim(j: u32, n: u32, z: f64) -> Point3<f64> {
    let (s, c) = turn(j, n);
    Point3::new(0.5 * c, 0.5 * s, z)
}

/// Returns a cylinder without caps, whose triangles are as long as the cylinder.
fn cylinder(n: u32) -> Vec<Shape<f64>> {
    let sides = (0..n).flat_map(|j| {
        let [a, b, c, d] = [rim(j, n, -0.5), rim(j + 1, n, -0.5), rim(j + 1, n, 0.5), rim(j, n, 0.5)];
        [Triangle::new(a, b, c), Triangle::new(a, c, d)].map(Shape::from)
    });
    sides.collect()
}

/// All primitives of a sphere are equally near to its middle: sites there keep lists short, and no sites are added
/// elsewhere. Long triangles get sites on themselves.
#[test]
fn round_shapes_have_short_lists() {
    let sphere = sphere(amount(48, 26), amount(64, 40));
    let report = built(&sphere[..]).report();
    let mean = report.primitives as f64 / report.list_cells as f64;
    println!("sphere: {report}");
    // Vertices that nearly coincide, at the poles, have no lists of their own.
    assert!(report.fallback_cells < 100 && report.added == 0 && mean < 40.0, "{report}");
    assert!((1..100).contains(&report.auxiliary), "{report}");
    let alone = P2mIndex::build(&sphere[..], &P2mOptions::default().with_max_extra_sites(0.0)).expect("valid").report();
    assert!(alone.list_cells == 0 && alone.auxiliary == 0 && alone.fallback_cells > sphere.len() / 3, "{alone}");
    let report = built(&cylinder(amount(400, 200))[..]).report();
    println!("cylinder: {report}");
    assert!(
        report.added > amount(50, 20)
            && report.list_cells > amount(500, 250)
            && report.fallback_cells * 4 < report.list_cells,
        "{report}"
    );
}

#[test]
fn cells_do_not_depend_on_the_number_of_threads() {
    let (mut added, mut auxiliary) = (0, 0);
    // Threads share 1024 sites or more, and the sphere has a site at each of its vertices.
    for shapes in [amount(sphere(40, 48), sphere(36, 32)), cylinder(amount(400, 200))] {
        let [one, all] = [false, true].map(|parallel| {
            let splits = p2m_bvh::SplitOptions::default().with_parallel(parallel);
            P2mIndex::build(&shapes[..], &P2mOptions::default().with_splits(splits)).expect("valid")
        });
        assert_eq!(one.report(), all.report());
        (added, auxiliary) = (added + one.report().added, auxiliary + one.report().auxiliary);
        for q in queries(&mut rng("p2m threads", 0), &shapes, amount(2_000, 200)) {
            assert_eq!(one.partition().list(&q), all.partition().list(&q), "{q:?}");
        }
    }
    assert!(added > 10 && auxiliary > 0, "{added} {auxiliary}");
}

#[test]
fn symmetric_shapes_and_fans_of_slivers_agree() {
    let slivers = amount(200, 60);
    let fan = |j: u32| Triangle::new(Point3::new(0.0, 0.0, 0.3), rim(j, slivers, 0.0), rim(j + 1, slivers, 0.0)).into();
    let fan: Vec<Shape<f64>> = (0..slivers).map(fan).collect();
    let (small, large) = (sphere(amount(16, 8), amount(24, 12)), sphere(amount(40, 16), amount(48, 20)));
    let cylinder = cylinder(amount(400, 100));
    for (name, shapes) in [("sphere", small), ("large sphere", large), ("fan", fan), ("cylinder", cylinder)] {
        let mut rng = rng(name, 0);
        let mut all = queries(&mut rng, &shapes, amount(600, 60));
        all.push(Point3::origin());
        all.extend((0..amount(100, 10)).map(|_| Point3::from(vector(&mut rng) * 1e-9)));
        agrees(name, &shapes[..], &all);
    }
}

#[test]
fn scenes_on_a_line_or_in_a_plane_and_small_ones_agree() {
    for seed in cases(60, 18) {
        let (case, mut rng) = (seed as usize, rng("p2m flat", seed));
        let count = rng.random_range(1..40);
        let dimensions = case % 3 + 1;
        let shift = vector(&mut rng) * [0.0, 1.0, 1e6][case % 3];
        let grid = rng.random::<bool>();
        let mut point = || {
            let mut p = vector(&mut rng) * 0.5;
            p.iter_mut().skip(dimensions).for_each(|x| *x = 0.0);
            Point3::from(shift + if grid { p.map(|x| (x * 8.0).round() / 8.0) } else { p })
        };
        let shapes: Vec<Shape<f64>> = (0..count)
            .map(|i| match (i + case) % 3 {
                0 => Triangle::new(point(), point(), point()).into(),
                1 => Segment::new(point(), point()).into(),
                _ => Point::new(point()).into(),
            })
            .collect();
        let all: Vec<_> = queries(&mut rng, &shapes, amount(60, 15)).into_iter().flat_map(|q| [q, q + shift]).collect();
        agrees(&format!("case {case}"), &shapes[..], &all);
    }
}

/// Vertices differ by less than the distance at which sites are distinct.
#[test]
fn vertices_that_become_one_site_agree() {
    let tiny = 2f64.powi(-170);
    let shapes: Vec<Shape<f64>> = (0..64)
        .map(|i| {
            let at = |bit: u32| if i >> bit & 1 == 1 { tiny * f64::from(bit + 1) } else { 0.0 };
            let a = Point3::new(at(0), at(1), at(2));
            Segment::new(a, Point3::new(0.5, at(3) + 0.5, at(4) - 0.5)).into()
        })
        .chain([Point::new(Point3::new(-1.0, 0.0, 0.0)).into()])
        .collect();
    let mut rng = rng("p2m snapped", 0);
    let mut all = queries(&mut rng, &shapes, amount(400, 60));
    all.extend((0..amount(200, 30)).map(|_| Point3::from(vector(&mut rng) * tiny * 8.0)));
    agrees("snapped", &shapes[..], &all);
}

/// A triangle, or a primitive without vertices.
#[derive(Clone, Copy, Debug)]
enum Mixed {
    Triangle(Triangle<f64>),
    Ball(Ball),
}

impl Primitive<f64> for Mixed {
    fn aabb(&self) -> Aabb<f64> {
        match self {
            Self::Triangle(triangle) => triangle.aabb(),
            Self::Ball(ball) => ball.aabb(),
        }
    }
    fn vertices(&self) -> &[Point3<f64>] {
        match self {
            Self::Triangle(triangle) => triangle.vertices(),
            Self::Ball(_) => &[],
        }
    }
    fn project(&self, query: &Point3<f64>) -> Projection {
        match self {
            Self::Triangle(triangle) => triangle.project(query),
            Self::Ball(ball) => ball.project(query),
        }
    }
    fn intersect_ray(&self, _: &p2m_core::Ray) -> Option<p2m_core::RayHit> {
        unreachable!("no rays are cast")
    }
}

/// A primitive without vertices may be large, far from all vertices, and the last of all.
#[test]
fn primitives_of_ones_own_agree_wherever_they_are() {
    for case in cases(80, 28) {
        let mut rng = rng("p2m balls", case);
        let away = 10f64.powi(rng.random_range(0..6));
        let mut all: Vec<Mixed> = (0..rng.random_range(1..20))
            .map(|_| {
                let centre = Point3::from(vector(&mut rng));
                let [a, b, c] = [(); 3].map(|()| centre + vector(&mut rng) * 0.2);
                Mixed::Triangle(if case % 7 == 0 { Triangle::new(a, a, a) } else { Triangle::new(a, b, c) })
            })
            .collect();
        for _ in 0..rng.random_range(1..4) {
            let ball =
                Ball { centre: Point3::from(vector(&mut rng) * away), radius: away * rng.random_range(0.0..0.5) };
            all.insert(rng.random_range(0..=all.len()), Mixed::Ball(ball));
        }
        let queries: Vec<_> =
            (0..80).map(|i| Point3::from(vector(&mut rng) * [1.0, 5.0, away, away * 5.0][i % 4])).collect();
        agrees(&format!("case {case}"), &all[..], &queries);
    }
}

/// The kernel's rounding decides between features whose distances differ by less than its error, so pruning needs a
/// margin for slivers and for vertices that nearly coincide.
#[test]
fn slivers_and_vertices_that_are_nearly_one_agree() {
    let [a, b, c, d] = [
        [-0.09385277385180002, -0.2820102176108825, -0.86333400843566],
        [0.22181407804052888, 0.5194096455550592, 0.7640106774258804],
        [0.20451761976982324, 0.4754971310244159, 0.6748429384557477],
        [0.9019058404823306, 0.6292557174550899, -0.9853900378582874],
    ]
    .map(Point3::from);
    let points = [
        [0.2042689449616888, -0.4994953512284006, 0.35093793966232556],
        [0.5121567505292512, 0.5070233010974172, 0.3814640306916568],
        [0.7616984008649881, -0.5540654729917704, -0.7836039887532664],
        [-0.18672822889704865, -0.09714400003699275, -0.500564223765682],
    ];
    let mut shapes: Vec<Shape<f64>> =
        vec![Triangle::new(a, b, d).into(), Segment::new(b, c).into(), Triangle::new(b, c, a).into()];
    shapes.extend(points.map(|p| Shape::from(Point::new(Point3::from(p)))));
    agrees("sliver", &shapes[..], &[Point3::new(-0.5708403546368517, -0.06606097613022954, 0.47953094376149297)]);
    for case in cases(3_000, 120) {
        let mut rng = rng("p2m nearly one", case);
        let mut shapes: Vec<Shape<f64>> = (0..14).map(|_| Point::new(Point3::from(vector(&mut rng))).into()).collect();
        let v = shapes[rng.random_range(0..14)];
        let v = v.vertices()[0];
        let (a, c) = (Point3::from(vector(&mut rng)), Point3::from(vector(&mut rng)));
        // The vertices differ by some units in the last place.
        let b = a.map(|x| x + f64::EPSILON * 0.5 * f64::from(rng.random_range(-3..=3)));
        let pair: [Shape<f64>; 2] = if rng.random() {
            [Segment::new(b, a).into(), Segment::new(a, c).into()]
        } else {
            [Segment::new(a, c).into(), Triangle::new(b, a, c).into()]
        };
        shapes.extend(pair);
        let queries: Vec<_> = (0..20)
            .map(|_| {
                // The query is on the plane between both vertices.
                let edge = a - v;
                let aside = vector(&mut rng);
                nalgebra::center(&a, &v) + aside - edge * (aside.dot(&edge) / edge.norm_squared())
            })
            .collect();
        agrees(&format!("case {case}"), &shapes[..], &queries);
    }
}

/// Far enough beside a flat scene, offsets are below the resolution of f64.
#[test]
fn flat_scenes_far_out_agree() {
    for e in 10..19 {
        let z = 10f64.powi(e);
        let at = |x: f64, y: f64| Point3::new(x, y, z);
        let shapes: [Shape<f64>; 2] = [
            Triangle::new(at(0.0, 0.0), at(1.0, 0.0), at(0.0, 1.0)).into(),
            Triangle::new(at(1.0, 1.0), at(1.0, 0.0), at(0.0, 1.0)).into(),
        ];
        agrees(&format!("{z:e}"), &shapes[..], &[at(0.2, 0.2), at(3.0, 2.0), Point3::origin(), at(0.5, 0.5) * 1.5]);
    }
}

fn sheet(len: usize) -> Soup<f64> {
    scenes::soup(&mut rng("p2m sheet", 0), Kinds::Triangles, Layout::Sheet, len)
}

#[test]
fn soups_agree_beyond_the_domain_and_on_its_border() {
    for case in cases(24, 24) {
        let (mut rng, (kinds, layout)) = (rng("p2m soups", case), kinds_and_layout(case));
        let soup = scenes::soup(&mut rng, kinds, layout, amount(400, 50));
        let bounds = soup.aabb();
        let (centre, size) = (nalgebra::center(&bounds.min, &bounds.max), (bounds.max - bounds.min).max());
        let mut all: Vec<_> = (0..amount(100, 15))
            .map(|_| centre + vector(&mut rng) * (size * [0.6, 2.0, 5.1, 1e4][rng.random_range(0..4)]))
            .collect();
        // Cells border on those of the bounding sites there, if anywhere.
        all.extend((0..amount(20, 6)).map(|_| centre + vector(&mut rng).map(f64::signum) * (size * 5.0)));
        all.extend((0..amount(40, 10)).map(|_| {
            let positions = soup.positions();
            positions[rng.random_range(0..positions.len())] + vector(&mut rng) * (size * 1e-3)
        }));
        agrees(&format!("case {case}: {kinds:?} {layout:?}"), &soup, &all);
    }
}

#[test]
fn progress_goes_from_nothing_to_all() {
    let soup = sheet(amount(5_000, 1_000));
    let parts = Mutex::new(Vec::new());
    let index = P2mIndex::build_with_progress(&soup, &P2mOptions::default(), &|progress| {
        parts.lock().expect("whole").push(progress);
    });
    assert_eq!(index.expect("valid").set().len(), soup.len());
    let parts = parts.into_inner().expect("whole");
    let rises = |w: &[Progress]| w[0].part < w[1].part || (w[0].part == w[1].part && w[0].stage != w[1].stage);
    assert!(parts.len() > 20 && parts.windows(2).all(rises), "{parts:?}");
    assert!(parts[0].part >= 0.0 && parts.last().is_some_and(|last| last.part == 1.0), "{parts:?}");
    let mut stages: Vec<BuildStage> = parts.iter().map(|progress| progress.stage).collect();
    stages.dedup();
    assert_eq!(stages[..4], [BuildStage::Tree, BuildStage::Delaunay, BuildStage::Balls, BuildStage::Lists]);
    assert_eq!(stages[4..], [BuildStage::Locator]);
}

#[test]
fn lists_that_are_too_long_are_left_to_the_tree() {
    let soup = sheet(amount(3_000, 800));
    let report = |longest| {
        let options = P2mOptions::default().with_max_list_packets(longest).with_max_extra_sites(0.0);
        P2mIndex::<f64, _>::build(&soup, &options).expect("valid").report()
    };
    let default_report = report(128);
    assert!(
        default_report.list_cells > soup.len() / 3
            && default_report.fallback_cells == 0
            && default_report.entries > 2 * default_report.list_cells,
        "{default_report}"
    );
    let short = report(12);
    assert!(
        short.fallback_cells > soup.len() / 30
            && short.bytes < default_report.bytes
            && short.entries <= 12 * short.list_cells,
        "{short}"
    );
    let none = report(0);
    assert!(none.list_cells == 0 && none.fallback_cells == default_report.list_cells && none.bytes == 0, "{none}");
}

/// The counters detect lost lists, lost bounds, lost hints and lost paths to answers far away.
#[test]
fn lookups_do_little() {
    let soup = sheet(amount(20_000, 4_000));
    let index = built(&soup);
    let mut rng = rng("p2m counters", 0);
    let bounds = soup.aabb();
    let size = bounds.max - bounds.min;
    println!("{}", index.report());
    for (name, extent, limits) in
        [("around", 0.52, [1_750, 2_900, 1_350]), ("far", 4.9, [1_850, amount(1_500, 400), 1_100])]
    {
        let centre = nalgebra::center(&bounds.min, &bounds.max);
        let mut shift = || centre + Vector3::from_fn(|k, _| rng.random_range(-extent..extent) * size[k]);
        let queries: Vec<_> = (0..1000).map(|_| shift()).collect();
        let sums = index.count_queries(&queries);
        println!("{name}: per 1000 queries {sums:?} nodes and sites, packets, primitives");
        assert!((0..3).all(|i| sums[i] <= limits[i]), "{name}: {sums:?}");
    }
}

/// Cells of a town are cut by planes that are equal up to rounding, and the polytope that remains must not
/// grow without end.
#[test]
fn a_part_of_a_flat_town_is_built_within_its_memory() {
    let is_town = |path: &PathBuf| path.to_string_lossy().ends_with("city_far_from_origin.obj");
    for path in p2m_testkit::all_model_files().into_iter().filter(is_town) {
        check_memory_of_town(&p2m_mixed::read_scene(&path).expect("a scene").soup);
    }
}

fn check_memory_of_town(town: &Soup<f64>) {
    let shapes: Vec<Shape<f64>> = (0..town.len()).map(|i| town.get(p2m_core::PrimitiveId::new(i))).collect();
    let middle = |shape: &Shape<f64>| nalgebra::center(&shape.aabb().min, &shape.aabb().max);
    let centre = middle(&shapes[shapes.len() / 2]);
    let mut part = shapes;
    // Bits of numbers that are not negative have the order of the numbers.
    part.sort_by_cached_key(|shape| (middle(shape) - centre).norm_squared().to_bits());
    for count in amount(vec![5500, 6000, 7000], vec![600]) {
        let count = count.min(part.len());
        let index = built(&part[..count]);
        assert!(index.memory() < 1000 * count, "{} bytes", index.memory());
        let brute = BruteForce::new(&part[..count]).expect("valid");
        for shape in part[..count].iter().step_by(count / 20) {
            let query = middle(shape) + vector(&mut rng("town", count as u64)) * 3.0;
            let key = |c: Option<p2m_core::Closest<f64>>| c.map(|c| (c.distance.to_bits(), c.primitive));
            assert_eq!(key(index.closest_point(&query)), key(brute.closest_point(&query)));
        }
    }
}

/// Queries that are not finite have no answer, wherever they stand, and the others are answered side by
/// side without them.
#[test]
fn a_batch_with_queries_that_are_not_finite_answers_the_others() {
    let soup = scenes::skewed_gear(20);
    let index = built(&soup);
    assert!(index.report().list_cells > 100, "{:?}", index.report());
    for case in cases(200, 40) {
        let mut rng = rng("not-finite", case);
        let len = rng.random_range(0..70);
        let queries: Vec<Point3<f64>> = (0..len)
            .map(|_| {
                let mut query = Point3::from(vector(&mut rng) * 3.0);
                if rng.random_range(0..4) < case % 4 {
                    query[rng.random_range(0..3)] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY][case as usize % 3];
                }
                query
            })
            .collect();
        let fields = |answer: Option<Closest<f64>>| answer.as_ref().map(compared_fields);
        let expected: Vec<_> = queries.iter().map(|query| fields(index.closest_point(query))).collect();
        // What stood in the slice before is no answer.
        let mut found = vec![index.closest_point(&[0.0; 3]); len];
        index.closest_points_into(&queries, &Default::default(), &mut found);
        assert_eq!(found.into_iter().map(fields).collect::<Vec<_>>(), expected, "case {case}");
    }
}
