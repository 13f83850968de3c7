use super::error_bounds::{ERROR_PER_REACH, INSIDE_MARGIN_PER_REACH};
use super::local_primitive::LocalPrimitive;
use super::squared_distances::squared_distances;
use super::*;
use p2m_core::engine::simd::{Doubles, Float, InstructionSet, SimdKernel};
use p2m_core::engine::vector::{V3, largest, norm_squared, sub};
use p2m_core::{BruteForce, ClosestPoint, Element, PrimitiveId, Soup};
use p2m_testkit::cases;
use rand::{Rng, RngExt};

/// Makes a scene of mixed kinds with slivers and degenerate primitives, spread over `size` around `centre`.
fn scene(rng: &mut impl Rng, count: usize, centre: V3, size: f64) -> Soup<f64> {
    let mut positions = Vec::new();
    let mut elements = Vec::new();
    for _ in 0..count {
        let around: V3 = centre.map(|x| x + size * rng.random_range(-1.0..1.0));
        let own = size * 2f64.powi(rng.random_range(-8..1));
        let mut v: Vec<V3> = (0..3).map(|_| around.map(|x| x + own * rng.random_range(-1.0..1.0))).collect();
        match rng.random_range(0..8) {
            // The third vertex is close to the edge, which makes a sliver of any sine.
            0..3 => {
                let t = rng.random_range(-0.2..1.2);
                let off = own * 10f64.powi(rng.random_range(-18..-1));
                v[2] = std::array::from_fn(|k| v[0][k] + t * (v[1][k] - v[0][k]) + off * rng.random_range(-1.0..1.0));
            }
            // The third vertex is close to the first or equal to it, which makes a needle.
            3 => v[2] = v[0].map(|x| x + own * [0.0, 1e-9, 1e-15][rng.random_range(0..3)]),
            4 => v = vec![v[0]; 3],
            _ => {}
        }
        let first = u32::try_from(positions.len()).expect("few");
        positions.extend(v.into_iter().map(Point3::from));
        elements.push(match rng.random_range(0..6) {
            0 => Element::Point(first),
            1 => Element::Segment([first, first + 1]),
            _ => Element::Triangle([first, first + 1, first + 2]),
        });
    }
    Soup::new(positions, elements).expect("valid")
}

fn axes(low: V3, side: f64, count: usize) -> [Vec<f64>; 3] {
    low.map(|x| (0..count).map(|i| x + side * i as f64 / (count - 1) as f64).collect())
}

/// The evaluation of single primitives is compared with the kernel, which is accurate to 8 u M, and stays within
/// the proved error.
#[test]
fn distances_to_one_primitive_are_within_half_of_the_error_bound() {
    struct SquaredDistance<'a>(&'a LocalPrimitive, V3, f64);
    impl SimdKernel for SquaredDistance<'_> {
        type Output = f64;
        #[inline(always)]
        fn run<I: InstructionSet>(self) -> f64 {
            let mut found = [0.0; 8];
            let point = self.1.map(I::Doubles::splat);
            squared_distances(self.0, &point, I::Doubles::splat(self.2)).sqrt().store(&mut found);
            found[5]
        }
    }
    let mut worst = 0.0f64;
    let cases = cases(200_000, 20_000);
    for case in cases.clone() {
        let mut rng = p2m_testkit::rng("candidates of one", case);
        let centre = [0.0; 3].map(|_: f64| rng.random_range(-1.0..1.0) * 10f64.powi(rng.random_range(-3..6)));
        let soup = scene(&mut rng, 1, centre, 1.0);
        let primitive = soup.get(PrimitiveId::new(0));
        let local = LocalPrimitive::from_primitive(&primitive).expect("vertices");
        let far = 10f64.powi(rng.random_range(-6..3));
        let point: V3 = match rng.random_range(0..3) {
            0 => centre.map(|x| x + far * rng.random_range(-1.0..1.0)),
            1 => soup.positions()[0].map(|x| x + far * rng.random_range(-1e-3..1e-3)).into(),
            // Other points are close to the triangle of the three vertices.
            _ => {
                let w = [rng.random_range(0.0..1.0), rng.random_range(0.0..1.0)];
                std::array::from_fn(|k| {
                    let [a, b, c] = [0, 1, 2].map(|i: usize| soup.positions()[i][k]);
                    a + w[0] * (b - a) + w[1] * (c - a) + far * rng.random_range(-1e-6..1e-6)
                })
            }
        };
        let reach = norm_squared(sub(local.origin, point)).sqrt() + local.length;
        let exact = primitive.project(&Point3::from(point)).key.distance();
        for isa in Isa::available() {
            let found = isa.run(SquaredDistance(&local, point, reach * INSIDE_MARGIN_PER_REACH));
            worst = worst.max((found - exact).abs() / reach);
        }
        // The closest point is on the primitive, up to its rounding as a position, and has the distance of the kernel.
        let closest = local.closest_offset(point);
        let position: V3 = std::array::from_fn(|k| local.origin[k] + closest[k]);
        let off = primitive.project(&Point3::from(position)).key.distance();
        let rounding = 2.0 * f64::EPSILON * largest(&[position]);
        let distance = norm_squared(sub(sub(point, local.origin), closest)).sqrt();
        let bound = reach * ERROR_PER_REACH / 4.0;
        assert!(off <= bound + rounding, "case {case}: {off:e} {reach:e}");
        assert!((distance - exact).abs() <= bound, "case {case}: {distance:e} {exact:e} {reach:e}");
    }
    println!("at most {:.1} u of the reach", worst * 2f64.powi(53));
    assert!((cases.is_replay() || worst > 0.0) && worst < ERROR_PER_REACH / 2.0, "{:.1} u", worst * 2f64.powi(53));
}

#[test]
fn distances_of_a_box_by_its_candidates_are_those_of_brute_force() {
    let (mut ambiguous, mut all, mut candidates) = (0, 0, 0);
    let cases = cases(160, 16);
    for case in cases.clone() {
        let (round, mut rng) = (case as usize, p2m_testkit::rng("candidates", case));
        let count = rng.random_range(1..300);
        let offset = [0.0, 1.0, 1e3, 1e9][round % 4];
        let size = [1.0, 1e-30, 1e30, 1e-200][round / 4 % 4];
        let centre = [offset * size; 3];
        let soup = scene(&mut rng, count, centre, size);
        let brute = BruteForce::new(&soup).expect("valid");
        let lists = CandidateLists::new(&soup).expect("plain");
        let mut list = lists.all();
        // Each box is a part of the one before.
        let mut low: V3 = centre.map(|x| x - 2.0 * size);
        let mut side = 4.0 * size;
        for level in 0..5 {
            let grid = axes(low, side, 5);
            let end = |pick: fn(&Vec<f64>) -> f64| Point3::from([0, 1, 2].map(|k| pick(&grid[k])));
            let part = Aabb { min: end(|axis| axis[0]), max: end(|axis| axis[4]) };
            list = lists.narrowed(&list, &part, Detail::Groups);
            candidates += list.len();
            let isa = Isa::available()[round % Isa::available().len()];
            let lists = CandidateLists::new(&soup).expect("plain").with_isa(isa);
            let mut values = vec![0.0; 125];
            ambiguous += lists.distances(
                &lists.narrowed(&list, &part, Detail::Primitives),
                [&grid[0], &grid[1], &grid[2]],
                &mut values,
            );
            all += values.len();
            for (n, value) in values.iter().enumerate() {
                let point = Point3::new(grid[0][n % 5], grid[1][n / 5 % 5], grid[2][n / 25]);
                let exact = brute.closest_point(&point).expect("not empty").distance;
                assert_eq!(value.to_bits(), (exact as f32).to_bits(), "round {round}, level {level}, {point}");
                assert!(list.nearest() <= exact, "{} {exact}", list.nearest());
            }
            low = low.map(|x| x + side * rng.random_range(0.0..0.5));
            side *= 0.5;
        }
    }
    println!("{ambiguous} of {all} are ambiguous, {} candidates on average", candidates / (5 * cases.len()));
    assert!(cases.is_replay() || ambiguous * 100 < all, "{ambiguous} of {all}");
}

/// Compares the points of a grid in a box with brute force. Their candidates were narrowed to the box in one step.
fn check(soup: &Soup<f64>, axes: &[Vec<f64>; 3]) {
    let brute = BruteForce::new(soup).expect("valid");
    let lists = CandidateLists::new(soup).expect("plain");
    let end = |last: bool| Point3::from([0, 1, 2].map(|k| axes[k][if last { axes[k].len() - 1 } else { 0 }]));
    let part = Aabb { min: end(false), max: end(true) };
    let list = lists.narrowed(&lists.narrowed(&lists.all(), &part, Detail::Groups), &part, Detail::Primitives);
    // Candidates that are resolved to primitives can be narrowed again.
    let list = lists.narrowed(&list, &part, Detail::Primitives);
    let counts = [0, 1, 2].map(|k: usize| axes[k].len());
    let mut values = vec![0.0; counts.iter().product()];
    lists.distances(&list, [&axes[0], &axes[1], &axes[2]], &mut values);
    for (n, value) in values.iter().enumerate() {
        let at = [n % counts[0], n / counts[0] % counts[1], n / (counts[0] * counts[1])];
        let point = Point3::from([0, 1, 2].map(|k: usize| axes[k][at[k]]));
        let exact = brute.closest_point(&point).expect("not empty").distance as f32;
        assert_eq!(value.to_bits(), exact.to_bits(), "{value} for {exact} at {point} of {:?}", soup.positions());
    }
}

/// The triangles are on a lattice, and many of them are collinear or have equal vertices. The points are on their lines
/// and in their planes.
#[test]
fn degenerate_triangles_have_the_distances_of_their_convex_hulls() {
    let collinear =
        |c: V3| Soup::from_triangles([[0.0; 3], [1.0, 0.0, 0.0], c].map(Point3::from).to_vec(), vec![[0, 1, 2]]);
    for c in [[0.5, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0; 3], [3.0, 0.0, 0.0]] {
        let soup = collinear(c).expect("valid");
        check(&soup, &[vec![5.0, 6.0], vec![0.0, 1.0], vec![3.0, 4.0]]);
        check(&soup, &[vec![-2.0, 2.0], vec![0.0], vec![0.0]]);
    }
    for case in cases(3000, 1000) {
        let mut rng = p2m_testkit::rng("candidates on a lattice", case);
        let count = rng.random_range(1..6u32);
        let mut lattice = |most: i32| -> V3 { std::array::from_fn(|_| f64::from(rng.random_range(-most..=most))) };
        let positions = (0..3 * count).map(|_| Point3::from(lattice(1))).collect();
        let soup = Soup::from_triangles(positions, (0..count).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect());
        let low = lattice(4);
        let sides: [usize; 3] = lattice(1).map(|x| if x < 0.0 { 1 } else { 2 });
        let axes = [0, 1, 2].map(|k: usize| (0..sides[k]).map(|i| low[k] + i as f64).collect());
        check(&soup.expect("valid"), &axes);
    }
}

/// Some sizes are so small that their squares vanish beside others, and the box is tiny beside its scene.
#[test]
fn primitives_of_all_scales_in_one_scene_have_the_distances_of_brute_force() {
    for case in cases(2000, 500) {
        let mut rng = p2m_testkit::rng("candidates of all scales", case);
        let case = case as u32;
        let mut vertex = || -> V3 {
            let scale = 10f64.powi([0, -3, -100, -154, -162, -170, -308, 6][rng.random_range(0..8)]);
            std::array::from_fn(|_| scale * f64::from(rng.random_range(-3..=3)))
        };
        let count = 1 + case % 4;
        let positions: Vec<Point3<f64>> = (0..3 * count).map(|_| Point3::from(vertex())).collect();
        let elements = (0..count).map(|t| match (t + case) % 3 {
            0 => Element::Segment([3 * t, 3 * t + 1]),
            _ => Element::Triangle([3 * t, 3 * t + 1, 3 * t + 2]),
        });
        let soup = Soup::new(positions, elements).expect("valid");
        let (low, side) = (vertex(), 10f64.powi(rng.random_range(-6..2)));
        check(&soup, &low.map(|x| vec![x, x + side, x + 2.0 * side]));
    }
    let thin = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 3e-162, 0.0]].map(Point3::from).to_vec();
    check(&Soup::from_triangles(thin, vec![[0, 1, 2]]).expect("valid"), &[vec![2.0], vec![5.0], vec![0.0]]);
}

#[test]
fn boxes_and_points_outside_of_the_narrowed_box_panic() {
    let soup = scene(&mut p2m_testkit::rng("candidates beside", 0), 20, [0.0; 3], 1.0);
    let lists = CandidateLists::new(&soup).expect("plain");
    let part = |low: f64, high: f64| Aabb { min: Point3::from([low; 3]), max: Point3::from([high; 3]) };
    let list = lists.narrowed(&lists.all(), &part(0.0, 1.0), Detail::Primitives);
    let panics = |f: &dyn Fn()| std::panic::catch_unwind(std::panic::AssertUnwindSafe(f)).is_err();
    for (low, high) in [(0.5, 1.5), (1.0, 0.0), (f64::NAN, 1.0), (0.0, f64::INFINITY)] {
        assert!(panics(&|| drop(lists.narrowed(&list, &part(low, high), Detail::Groups))), "{low} {high}");
    }
    assert!(panics(&|| drop(lists.narrowed(&lists.all(), &part(0.0, 1e76), Detail::Groups))));
    let points = |x: f64| lists.distances(&list, [&[x], &[0.0], &[0.0]], &mut [0.0]);
    assert!(!panics(&|| _ = points(0.5)) && panics(&|| _ = points(1.5)));
    assert!(panics(&|| _ = lists.distances(&list, [&[0.0], &[0.0], &[0.0]], &mut [0.0; 2])));
}
