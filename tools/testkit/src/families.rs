//! Families of single primitives that break kernels, over every scale, offset, sine and query position of the contract.

use p2m_core::{Real, Shape};
use rand::{Rng, RngExt};

type V = [f64; 3];

/// The way in which a case was generated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Family {
    /// The coordinates are small integers.
    Lattice,
    /// The coordinates have any magnitude.
    Wild,
    /// Edges and faces are almost parallel to an axis.
    AlmostFlat,
    /// Vertices and query are within a few units in the last place of an f32.
    Neighbours,
    /// The shape, its scale, its offset and the query position are parameters.
    Shaped {
        /// The sine of the smallest angle, or about the length of a segment.
        sine: f64,
        /// The exponent of the scale: coordinates are multiplied by 2^scale.
        scale: i32,
        /// The distance from the origin before scaling.
        offset: f64,
        /// Whether one edge is tiny.
        needle: bool,
        /// The name of the query position.
        query_position: &'static str,
    },
}

impl std::fmt::Display for Family {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Lattice => write!(f, "lattice"),
            Self::Wild => write!(f, "coordinates of any magnitude"),
            Self::AlmostFlat => write!(f, "almost parallel to an axis"),
            Self::Neighbours => write!(f, "neighbours of an f32"),
            Self::Shaped { sine, scale, offset, needle, query_position } => {
                let needle = if *needle { "needle, " } else { "" };
                write!(f, "{needle}sine {sine:e}, scale 2^{scale}, offset {offset:e}, query {query_position}")
            }
        }
    }
}

/// One isolated primitive and a query.
#[derive(Clone, Debug)]
pub struct Case {
    /// The family of the case.
    pub family: Family,
    /// The query point.
    pub query: V,
    /// The vertices, one to three.
    pub vertices: Vec<V>,
}

/// Returns the primitive of one to three vertices.
#[must_use]
pub fn shape<T: Real>(vertices: &[[T; 3]]) -> Shape<T> {
    Shape::from_vertices(vertices).expect("one to three vertices")
}

/// Exponents of the power-of-two scales of f64, from subnormal coordinates to the edge of overflow.
pub const SCALES: [i32; 12] = [-1070, -1000, -500, -270, -249, -240, 0, 248, 250, 500, 1000, 1020];
/// Exponents of the power-of-two scales of f32, from subnormal coordinates to the edge of overflow.
pub const SCALES_OF_F32: [i32; 12] = [-146, -140, -126, -120, -75, -63, 0, 62, 75, 100, 120, 124];
/// Distances of the primitive from the origin, before scaling.
pub const OFFSETS: [f64; 4] = [0.0, 1e3, 1e8, 1e15];
/// Sines of the smallest angle of a triangle.
pub const SINES: [f64; 11] = [1.0, 1e-2, 1e-3, 1e-4, 1e-8, 1e-12, 1e-15, 2e-16, 6e-17, 1e-17, 0.0];

/// The range of a scalar.
#[derive(Clone, Copy, Debug)]
pub struct Span {
    /// The exponents of the scales of shapes; zero is one of them.
    pub scales: &'static [i32],
    /// The exponents of the smallest and of the largest numbers of the scalar, and of numbers far from both.
    low: i32,
    high: i32,
    middle: i32,
    largest: f64,
    is_single: bool,
}

impl Span {
    /// The ranges of f64.
    pub const F64: Self =
        Self { scales: &SCALES, low: -1074, high: 1023, middle: 300, largest: f64::MAX, is_single: false };
    /// The ranges of f32.
    pub const F32: Self =
        Self { scales: &SCALES_OF_F32, low: -149, high: 127, middle: 40, largest: f32::MAX as f64, is_single: true };

    /// Returns the nearest number of the scalar, clamped to its range.
    #[allow(clippy::cast_possible_truncation, reason = "rounds")]
    fn rounded(&self, x: f64) -> f64 {
        let x = x.clamp(-self.largest, self.largest);
        if self.is_single { f64::from(x as f32) } else { x }
    }
}

pub(crate) fn unit(rng: &mut impl Rng) -> V {
    loop {
        let v: V = std::array::from_fn(|_| rng.random_range(-1.0..1.0));
        let n = norm(v);
        if (0.1..1.0).contains(&n) {
            return v.map(|x| x / n);
        }
    }
}

fn norm(v: V) -> f64 {
    (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt()
}

fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn combine<const N: usize>(terms: [(f64, V); N]) -> V {
    std::array::from_fn(|k| terms.iter().map(|(w, v)| w * v[k]).sum())
}

/// Returns a vector of any length that is perpendicular to the first three vertices.
fn normal(vertices: &[V]) -> V {
    let edge = |k: usize| std::array::from_fn(|c| vertices[k][c] - vertices[0][c]);
    cross(edge(1), edge(2))
}

fn pick<T: Copy>(rng: &mut impl Rng, from: &[T]) -> T {
    from[rng.random_range(0..from.len())]
}

/// Returns a triangle of size about one, whose height over its longest side is about `sine` times the length of that
/// side.
pub(crate) fn triangle(rng: &mut impl Rng, sine: f64) -> [V; 3] {
    if sine == 0.0 && rng.random_bool(0.5) {
        // Small integers along one direction make the vertices exactly collinear or equal.
        let direction: V = std::array::from_fn(|_| f64::from(rng.random_range(-3..=3)));
        return std::array::from_fn(|_| direction.map(|x| x * f64::from(rng.random_range(-2..=2))));
    }
    let base = unit(rng);
    let up = loop {
        let u = cross(base, unit(rng));
        let n = norm(u);
        if n > 0.1 {
            break u.map(|x| x / n);
        }
    };
    let start = unit(rng);
    // This exponential function has the same bits on every machine, which the checksums of answers need.
    let length = libm::exp2(rng.random_range(-1.0..1.0));
    // The apex is anywhere over the base, or close to one of its ends.
    let along = if rng.random_bool(0.7) { rng.random_range(0.0..1.0) } else { 2f64.powi(-rng.random_range(1..50)) };
    let along = if rng.random_bool(0.5) { along } else { 1.0 - along };
    let height = sine * rng.random_range(0.3..0.9);
    let a = start;
    let b = combine([(1.0, start), (length, base)]);
    let c = combine([(1.0, start), (length * along, base), (length * height, up)]);
    // The order of the vertices is random, so that any of them may be the apex.
    let mut t = [a, b, c];
    t.rotate_left(rng.random_range(0..3));
    t
}

/// Generates small integers and a query at integers of any size, so that ties are exact, and large lengths often round
/// to equal ones.
fn lattice(rng: &mut impl Rng) -> Case {
    let count = rng.random_range(1..=3);
    let vertices: Vec<V> = (0..count).map(|_| std::array::from_fn(|_| f64::from(rng.random_range(-6..=6)))).collect();
    if count == 3 && rng.random_bool(0.5) {
        // The query is exactly above a quarter point of an edge, or beyond its end.
        let (i, j) = (rng.random_range(0..3), rng.random_range(0..3));
        let quarters = f64::from(rng.random_range(-1..=5)) * 0.25;
        let base = combine([(1.0 - quarters, vertices[i]), (quarters, vertices[j])]);
        let height = 2f64.powi(rng.random_range(-10..58));
        let query = combine([(1.0, base), (height, normal(&vertices))]);
        return Case { family: Family::Lattice, query, vertices };
    }
    let exponent = if rng.random_bool(0.5) { rng.random_range(0..50) } else { rng.random_range(50..56) };
    let query = std::array::from_fn(|_| (2f64.powi(exponent) * rng.random_range(-6.0..6.0f64)).round());
    Case { family: Family::Lattice, query, vertices }
}

/// Generates coordinates of any magnitude from a small pool, so that some coincide.
#[must_use]
pub fn wild(rng: &mut impl Rng) -> Case {
    wild_in(rng, &Span::F64)
}

fn wild_in(rng: &mut impl Rng, span: &Span) -> Case {
    let Span { low, high, middle, .. } = *span;
    let (low, high) = [(low, high), (low, 0), (0, high), (-middle, middle)][rng.random_range(0..4)];
    let pool: [f64; 6] = std::array::from_fn(|_| match rng.random_range(0..10) {
        0 => 0.0,
        1 => span.largest,
        _ => {
            let e: i32 = rng.random_range(low..=high);
            let mantissa: f64 = if rng.random_bool(0.5) { 1.0 } else { rng.random_range(1.0..2.0) };
            mantissa * 2f64.powi(e / 2) * 2f64.powi(e - e / 2)
        }
    });
    let mut coordinate = || pool[rng.random_range(0..6)] * if rng.random_bool(0.5) { 1.0 } else { -1.0 };
    let query = std::array::from_fn(|_| coordinate());
    let vertices: [V; 3] = std::array::from_fn(|_| std::array::from_fn(|_| coordinate()));
    let count = rng.random_range(1..=3);
    Case { family: Family::Wild, query, vertices: vertices[..count].to_vec() }
}

/// Generates edges and faces that are almost parallel to the axes. Their box is thin, so rounding easily moves a
/// projection out of it.
fn almost_flat(rng: &mut impl Rng) -> Case {
    let (count, axis) = (rng.random_range(2..=3), rng.random_range(0..3));
    let level = rng.random_range(-1.0..1.0);
    let mut vertices: Vec<V> = (0..count).map(|_| unit(rng)).collect();
    for v in &mut vertices {
        v[axis] = level * (1.0 + f64::from(rng.random_range(-3..=3)) * f64::EPSILON);
    }
    let query = std::array::from_fn(|_| rng.random_range(-2.0..2.0));
    Case { family: Family::AlmostFlat, query, vertices }
}

/// Generates vertices and a query within a few units in the last place of one point, whose coordinates are any f32.
fn neighbours(rng: &mut impl Rng) -> Case {
    let anchor: [f32; 3] = std::array::from_fn(|_| {
        loop {
            let x = f32::from_bits(rng.random());
            if x.abs() < f32::MAX / 2.0 {
                break x;
            }
        }
    });
    let mut near = || -> V {
        std::array::from_fn(|k| {
            let steps: i8 = rng.random_range(-32..32);
            f64::from(anchor[k] * (1.0 + f32::from(steps) * f32::EPSILON))
        })
    };
    let vertices = vec![near(), near(), near()];
    Case { family: Family::Neighbours, query: near(), vertices }
}

/// Generates a case of any family, with one to three vertices.
pub fn case(rng: &mut impl Rng) -> Case {
    case_in(rng, &Span::F64)
}

/// Generates a case of any family in the range of a scalar. All numbers are representable in that scalar, and not all
/// are zero.
pub fn case_in(rng: &mut impl Rng, span: &Span) -> Case {
    loop {
        let Case { family, query, vertices } = drawn(rng, span);
        let rounded = |v: V| v.map(|x| span.rounded(x));
        let case = Case { family, query: rounded(query), vertices: vertices.into_iter().map(rounded).collect() };
        if case.vertices.as_flattened().iter().chain(&case.query).any(|x| *x != 0.0) {
            return case;
        }
    }
}

/// Generates two hulls in the range of f64, as [`pair_in`] does.
pub fn pair(rng: &mut impl Rng) -> (Family, [Vec<V>; 2]) {
    pair_in(rng, &Span::F64)
}

/// Generates two hulls of one to three vertices in the range of a scalar. They are from one family side by side, or are
/// moved against each other so that they touch, cross, are parallel, or share vertices.
pub fn pair_in(rng: &mut impl Rng, span: &Span) -> (Family, [Vec<V>; 2]) {
    let Case { family, query, vertices: a } = case_in(rng, span);
    let mut b = match rng.random_range(0..4) {
        0 => case_in(rng, span).vertices,
        _ => {
            // A hull of the same family and scale, from the query and points between it and the first hull.
            let point = |rng: &mut dyn Rng| -> V {
                let (v, t) = (a[rng.random_range(0..a.len())], [0.0, 0.5, 1.0, 1.5][rng.random_range(0..4)]);
                std::array::from_fn(|k| query[k] * (1.0 - t) + v[k] * t)
            };
            (0..rng.random_range(1..=3)).map(|_| point(rng)).collect::<Vec<_>>()
        }
    };
    let i = rng.random_range(0..a.len());
    let direction = |k: usize| -> V { std::array::from_fn(|axis| a[(i + k) % a.len()][axis] - a[i][axis]) };
    match rng.random_range(0..8) {
        // Edges are exactly or nearly parallel.
        0 if b.len() >= 2 => b[1] = sum(b[0], direction(1)),
        1 if b.len() >= 2 => {
            let tiny = 2f64.powi(-rng.random_range(20..60));
            let aside: V = std::array::from_fn(|k| direction(1)[(k + 1) % 3] * tiny);
            b[1] = sum(sum(b[0], direction(1)), aside);
        }
        // The hulls share a vertex, or one begins on an edge of the other.
        2 => b[0] = a[i],
        3 => b[0] = std::array::from_fn(|k| a[i][k] + 0.5 * direction(1)[k]),
        // An edge passes through the face or close to it.
        4 if b.len() >= 2 && a.len() == 3 => {
            let inside: V = std::array::from_fn(|k| a[0][k] * 0.5 + a[1][k] * 0.25 + a[2][k] * 0.25);
            b[1] = std::array::from_fn(|k| 2.0 * inside[k] - b[0][k]);
        }
        _ => {}
    }
    for v in b.iter_mut().flatten() {
        *v = span.rounded(if v.is_finite() { *v } else { f64::MAX });
    }
    (family, [a, b])
}

fn sum(a: V, b: V) -> V {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn drawn(rng: &mut impl Rng, span: &Span) -> Case {
    match rng.random_range(0..100) {
        0..10 => return lattice(rng),
        10..13 => return wild_in(rng, span),
        13..18 => return almost_flat(rng),
        18..23 => return neighbours(rng),
        _ => {}
    }
    let kinds = rng.random_range(0..10);
    let count = if kinds == 0 {
        1
    } else if kinds < 4 {
        2
    } else {
        3
    };
    let sine = pick(rng, &SINES);
    let scale = if rng.random_bool(0.5) { 0 } else { pick(rng, span.scales) };
    let offset = if rng.random_bool(0.5) { 0.0 } else { pick(rng, &OFFSETS) };
    let shift = unit(rng).map(|x| x * offset);
    let mut vertices: Vec<V> =
        triangle(rng, sine)[..count].iter().map(|v| combine([(1.0, *v), (1.0, shift)])).collect();
    if count == 2 && sine < 1e-3 {
        // A segment becomes short instead of flat.
        vertices[1] = std::array::from_fn(|k| vertices[0][k] + sine * (vertices[1][k] - vertices[0][k]));
    }
    let needle = count == 3 && rng.random_bool(0.1);
    if needle {
        // A needle has one tiny edge.
        let tiny = 2f64.powi(-rng.random_range(1..60));
        vertices[2] = combine([(1.0, vertices[0]), (tiny, unit(rng))]);
    }
    let (query_position, mut query) = query(rng, &vertices);
    if rng.random_bool(0.2) {
        // Rounding to few digits makes components equal and sums exact, and puts projections on the box.
        let rounded = |v: V| v.map(|x| if x == 0.0 { x } else { (x * 2f64.powi(20)).round() * 2f64.powi(-20) });
        vertices.iter_mut().for_each(|v| *v = rounded(*v));
        query = rounded(query);
    }
    let factor =
        |x: f64| if scale >= -500 { x * 2f64.powi(scale) } else { x * 2f64.powi(-500) * 2f64.powi(scale + 500) };
    // Offsets times the largest scales would overflow, so they are clamped to the end of the range.
    let clip = |v: V| v.map(|x| factor(x).clamp(-span.largest, span.largest));
    Case {
        family: Family::Shaped { sine, scale, offset, needle, query_position },
        query: clip(query),
        vertices: vertices.into_iter().map(clip).collect(),
    }
}

fn query(rng: &mut impl Rng, vertices: &[V]) -> (&'static str, V) {
    let n = vertices.len();
    let mut weights: Vec<f64> = (0..n).map(|_| rng.random_range(0.0..1.0)).collect();
    let sum: f64 = weights.iter().sum();
    weights.iter_mut().for_each(|w| *w /= sum);
    let weighted = |w: &[f64]| -> V { std::array::from_fn(|k| (0..n).map(|i| w[i] * vertices[i][k]).sum()) };
    let inside = weighted(&weights);
    let direction = unit(rng);
    let (i, j) = (rng.random_range(0..n), rng.random_range(0..n));
    let t = rng.random_range(0.0..1.0);
    let on_edge = combine([(1.0 - t, vertices[i]), (t, vertices[j])]);
    let small = 10f64.powi(-rng.random_range(0..20));
    match rng.random_range(0..10) {
        0 => ("on a vertex", vertices[i]),
        1 => ("on an edge", on_edge),
        2 => ("in the face", inside),
        3 => ("near the face", combine([(1.0, inside), (small, direction)])),
        4 if n == 3 => {
            let up = normal(vertices);
            let up = up.map(|x| x / norm(up).max(f64::MIN_POSITIVE));
            let height = 2f64.powi(rng.random_range(-60..60));
            match rng.random_range(0..3) {
                0 => ("above the face", combine([(1.0, inside), (height, up)])),
                1 => ("above a vertex", combine([(1.0, vertices[i]), (height, up)])),
                _ => {
                    // The query is above an edge, slightly towards its inner or outer side.
                    let along: V = std::array::from_fn(|k| vertices[j][k] - vertices[i][k]);
                    let aside = 2f64.powi(-rng.random_range(20..70)) * if rng.random_bool(0.5) { 1.0 } else { -1.0 };
                    ("above an edge", combine([(1.0, on_edge), (height, up), (aside, cross(up, along))]))
                }
            }
        }
        5 if rng.random_bool(0.3) => {
            let beyond = 1.0 + 2f64.powi(rng.random_range(-55..5));
            ("on the extension of an edge", combine([(1.0 - beyond, vertices[i]), (beyond, vertices[j])]))
        }
        5 => ("near an edge", combine([(1.0, on_edge), (small, direction)])),
        6 => {
            // The query is equally far from two vertices, up to rounding.
            let middle = combine([(0.5, vertices[i]), (0.5, vertices[j])]);
            let along: V = std::array::from_fn(|k| vertices[j][k] - vertices[i][k]);
            ("equidistant", combine([(1.0, middle), (1.0, cross(along, direction))]))
        }
        7 => ("far", combine([(1.0, inside), (10f64.powi(rng.random_range(1..20)), direction)])),
        8 if n > 1 && rng.random_bool(0.5) => {
            // The query is almost perpendicularly above a vertex, so rounding decides whether an edge from the vertex
            // leads towards it.
            let along: V = std::array::from_fn(|k| vertices[(i + 1) % n][k] - vertices[i][k]);
            let lean = if rng.random_bool(0.5) { small } else { -small };
            let aside = cross(along, direction);
            ("beside a vertex", combine([(1.0, vertices[i]), (rng.random_range(0.1..3.0), aside), (lean, along)]))
        }
        8 => ("near a vertex", combine([(1.0, vertices[i]), (small, direction)])),
        _ => ("around", combine([(1.0, inside), (2.0, direction)])),
    }
}
