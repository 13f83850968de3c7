//! Random scenes and queries for comparisons of backends.

use nalgebra::{Point3, Vector3};
use p2m_core::{Element, Real, Soup};
use rand::{Rng, RngExt};

/// The kinds of primitives of a random scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kinds {
    /// Only points.
    Points,
    /// Only segments.
    Segments,
    /// Only triangles.
    Triangles,
    /// All three kinds in random order.
    Mixed,
}

/// All combinations of kinds.
pub const KINDS: [Kinds; 4] = [Kinds::Points, Kinds::Segments, Kinds::Triangles, Kinds::Mixed];

/// The distribution of coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// Primitives of any size, uniform in a cube.
    Uniform,
    /// Small primitives, scattered over a cube.
    Strewn,
    /// Small integers, so that ties, duplicates and degenerate primitives are common.
    Lattice,
    /// A curved grid with shared vertices, so that most nearest features are shared.
    Sheet,
    /// Primitives whose sizes range over ten orders of magnitude.
    Sizes,
    /// A scene far from the origin.
    Far,
}

/// All distributions of coordinates.
pub const LAYOUTS: [Layout; 6] =
    [Layout::Uniform, Layout::Strewn, Layout::Lattice, Layout::Sheet, Layout::Sizes, Layout::Far];

/// Generates the positions and elements of a random scene with up to `len` primitives.
pub fn scene(rng: &mut impl Rng, kinds: Kinds, layout: Layout, len: usize) -> (Vec<[f64; 3]>, Vec<Element>) {
    let mut positions: Vec<[f64; 3]> = Vec::new();
    let mut corners: Vec<[u32; 3]> = Vec::new();
    if layout == Layout::Sheet {
        let side = len.isqrt().max(2);
        for i in 0..side {
            for j in 0..side {
                let (x, y) = (i as f64 / 4.0, j as f64 / 4.0);
                positions.push([x, y, (x * 1.3).sin() * (y * 0.7).cos()]);
            }
        }
        let at = |i: usize, j: usize| u32::try_from(i * side + j).expect("small");
        for i in 0..side - 1 {
            for j in 0..side - 1 {
                corners.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
                corners.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
            }
        }
        corners.truncate(len);
    } else {
        let far = if layout == Layout::Far { [9e4, 4.4e5, -1e6] } else { [0.0; 3] };
        for _ in 0..len {
            let centre: [f64; 3] = std::array::from_fn(|_| rng.random_range(-1.0..1.0));
            let size = match layout {
                Layout::Uniform => 1.0,
                Layout::Sizes => 10f64.powf(rng.random_range(-10.0..0.0)),
                _ => 0.05,
            };
            let first = u32::try_from(positions.len()).expect("small");
            for _ in 0..3 {
                positions.push(if layout == Layout::Lattice {
                    std::array::from_fn(|_| f64::from(rng.random_range(0..4)))
                } else {
                    std::array::from_fn(|k| far[k] + centre[k] + size * rng.random_range(-1.0..1.0))
                });
            }
            corners.push([first, first + 1, first + 2]);
        }
    }
    let elements = corners
        .into_iter()
        .map(|[a, b, c]| {
            let kind = match kinds {
                Kinds::Points => 0,
                Kinds::Segments => 1,
                Kinds::Triangles => 2,
                Kinds::Mixed => rng.random_range(0..3),
            };
            match kind {
                0 => Element::Point(a),
                1 => Element::Segment([a, b]),
                _ => Element::Triangle([a, b, c]),
            }
        })
        .collect();
    (positions, elements)
}

/// Returns the kinds and the layout for the scene of a case. Any 24 consecutive cases have all kinds in all layouts.
#[must_use]
#[allow(clippy::cast_possible_truncation, reason = "remainders are small")]
pub fn kinds_and_layout(case: u64) -> (Kinds, Layout) {
    (KINDS[(case % 4) as usize], LAYOUTS[(case / 4 % 6) as usize])
}

/// Generates random scenes of every kind and layout, with sizes from zero to several hundred, and with their seeds.
/// Large scenes are smaller in shallow tests.
#[track_caller]
pub fn random_soups(name: &'static str) -> impl Iterator<Item = (u64, Soup<f64>)> {
    crate::cases(240, 24).map(move |seed| {
        let mut rng = crate::rng(name, seed);
        let (kinds, layout) = kinds_and_layout(seed);
        let len = [0, 1, 2, 5, 30, crate::amount(300, 60), crate::amount(700, 150)][rng.random_range(0..7)];
        (seed, soup(&mut rng, kinds, layout, len))
    })
}

/// Generates random scenes that are scaled to both ends of the range of f64, with the queries that stay finite.
#[track_caller]
pub fn extreme_soups(name: &'static str) -> impl Iterator<Item = (u64, Soup<f64>, Vec<Point3<f64>>)> {
    random_soups(name).filter_map(|(seed, soup)| {
        let e = [-1060, -1000, -600, -400, 400, 600, 1000, 1021][usize::try_from(seed).ok()? % 8];
        let scale = |p: &Point3<f64>| p.map(|x| x * 2f64.powi(e / 2) * 2f64.powi(e - e / 2));
        let queries = queries(seed, &soup).iter().map(scale).filter(|q| q.iter().all(|x| x.is_finite())).collect();
        let soup = Soup::new(soup.positions().iter().map(scale).collect(), soup.elements()).ok()?;
        Some((seed, soup, queries))
    })
}

/// Generates sixty queries around a scene, or eight in shallow tests.
#[must_use]
pub fn queries(seed: u64, soup: &Soup<f64>) -> Vec<Point3<f64>> {
    let mut rng = crate::rng("queries", seed);
    (0..crate::amount(60, 8)).map(|_| query(&mut rng, soup.positions())).collect()
}

/// Rounds a point to f32.
#[must_use]
pub fn to_f32(p: Point3<f64>) -> Point3<f32> {
    p.map(f32::round_from_f64)
}

/// Generates a random scene as a soup of f64.
pub fn soup(rng: &mut impl Rng, kinds: Kinds, layout: Layout, len: usize) -> Soup<f64> {
    let (positions, elements) = scene(rng, kinds, layout, len);
    Soup::new(positions.into_iter().map(Point3::from).collect(), elements).expect("random scenes are valid")
}

/// Converts a soup to f32; `None` if a coordinate that it uses overflows.
#[must_use]
pub fn narrow(soup: &Soup<f64>) -> Option<Soup<f32>> {
    let positions = soup.positions().iter().map(|p| p.map(f32::round_from_f64)).collect();
    Soup::new(positions, soup.elements()).ok()
}

/// Returns the sides of a gear with fine teeth, skewed and turned: long triangles that are neither axis-aligned nor
/// parallel to each other.
#[must_use]
pub fn skewed_gear(teeth: u32) -> Soup<f64> {
    let turn = nalgebra::Rotation3::new(Vector3::new(0.4, 0.7, 0.3));
    let corners = 4 * teeth;
    let positions = (0..2 * corners).map(|i| {
        let (corner, side) = (i / 2, f64::from(i % 2));
        let radius = if corner % 4 < 2 { 1.0 } else { 0.9 };
        let angle = std::f64::consts::TAU * f64::from(corner) / f64::from(corners) + side * 0.9;
        turn * Point3::new(radius * angle.cos(), radius * angle.sin(), side * 0.8)
    });
    let elements = (0..corners).flat_map(|i| {
        let [a, b] = [2 * i, 2 * ((i + 1) % corners)];
        [Element::Triangle([a, b, b + 1]), Element::Triangle([a, b + 1, a + 1])]
    });
    Soup::new(positions.collect(), elements.collect::<Vec<_>>()).expect("finite")
}

/// Generates a query around a scene: on a position, between two positions, near one, uniform in the box, on a
/// half-integer lattice, or far away.
pub fn query(rng: &mut impl Rng, positions: &[Point3<f64>]) -> Point3<f64> {
    if positions.is_empty() {
        return Point3::origin();
    }
    let a = positions[rng.random_range(0..positions.len())];
    let b = positions[rng.random_range(0..positions.len())];
    let noise: Vector3<f64> = Vector3::from_fn(|_, _| rng.random_range(-1.0..1.0));
    match rng.random_range(0..8) {
        0 => a,
        1 => a + (b - a) * 0.5,
        2 => a + noise * 1e-3,
        3 => a + noise * 1e-9,
        4 => a + noise * 1e5,
        5 => (a + noise * 2.0).map(|x| (2.0 * x).round() / 2.0),
        _ => a + (b - a) * rng.random_range(0.0..1.0) + noise * 0.5,
    }
}

/// Returns a square spiral with this number of arms, of width 1 and with gaps of 1.
#[must_use]
pub fn square_spiral(arms: i64) -> Vec<[i64; 2]> {
    const DIRECTIONS: [[i64; 2]; 4] = [[1, 0], [0, 1], [-1, 0], [0, -1]];
    let longest = arms + 2;
    let (mut at, mut outer, mut inner) = ([0, 0], vec![[0, 0]], vec![[0, 1]]);
    for arm in 0..arms {
        let length = longest - 2 * ((arm.max(1) - 1) / 2);
        let [dx, dy] = DIRECTIONS[usize::try_from(arm % 4).expect("not negative")];
        at = [at[0] + length * dx, at[1] + length * dy];
        outer.push(at);
        // The corner is to the left of this arm and, if there is one, of the next.
        let [left_x, left_y] = if arm + 1 < arms { [-dy - dx, dx - dy] } else { [-dy, dx] };
        inner.push([at[0] + left_x, at[1] + left_y]);
    }
    outer.extend(inner.into_iter().rev());
    outer
}
