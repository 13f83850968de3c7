//! Midpoint subdivision with displacement, which makes scenes of any size from small ones.
//!
//! What belongs to an edge depends on nothing but the edge: a vertex that two triangles share stays shared, two edges
//! at the same place are split at the same place, and the order of the primitives changes no position.

use super::error::{GenerateError, capacity};
use super::portable::in_ball;
use nalgebra::{Point3, Vector3};
use p2m_core::{BuildError, Element, Soup};

/// How [`subdivide`] splits and displaces.
///
/// ```
/// use p2m_mixed::generate::{IcoSphere, Subdivide, ico_sphere, subdivide};
///
/// let ball = ico_sphere(&IcoSphere::default().with_frequency(1)).unwrap();
/// let rough = subdivide(&ball, &Subdivide::default().with_levels(3).with_amplitude(0.1)).unwrap();
/// assert_eq!((rough.positions().len(), rough.triangles().len()), (642, 20 * 64));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Subdivide {
    /// How often each triangle becomes four and each segment two.
    pub levels: u32,
    /// How far at most the middle of an edge is displaced, relative to the length of the edge: from 0 to 0.5. In each
    /// level, edges are those of the level before.
    pub amplitude: f64,
    /// Another seed displaces otherwise.
    pub seed: u64,
}

impl Default for Subdivide {
    fn default() -> Self {
        Self { levels: 1, amplitude: 0.0, seed: 1 }
    }
}

impl Subdivide {
    /// That often.
    #[must_use]
    pub fn with_levels(self, levels: u32) -> Self {
        Self { levels, ..self }
    }
    /// With displacements up to that part of an edge.
    #[must_use]
    pub fn with_amplitude(self, amplitude: f64) -> Self {
        Self { amplitude, ..self }
    }
    /// From that seed.
    #[must_use]
    pub fn with_seed(self, seed: u64) -> Self {
        Self { seed, ..self }
    }
}

/// Splits each triangle at the middles of its edges into four and each segment into two, `levels` times.
///
/// The parts of a primitive follow each other in its place, those of a triangle with its orientation: at its first,
/// second and third corner, then the middle one. Points stay. The positions come first, those of the middles after
/// them. Middles are displaced in random directions, so that large amplitudes let triangles cross each other.
///
/// # Errors
/// [`GenerateError::OutOfRange`] for an amplitude that is not from 0 to 0.5, [`GenerateError::Build`] if there are more
/// primitives than ids or a coordinate overflows.
///
/// # Complexity
/// Time O(m log m) and memory O(m) for m primitives of the result.
pub fn subdivide(scene: &Soup<f64>, options: &Subdivide) -> Result<Soup<f64>, GenerateError> {
    let &Subdivide { levels, amplitude, seed } = options;
    if !(0.0..=0.5).contains(&amplitude) {
        return Err(GenerateError::OutOfRange { option: "amplitude", value: amplitude, range: "from 0 to 0.5" });
    }
    // A segment has too many parts after 31 levels already.
    let parts = |count: usize, each: u128| count as u128 * each.pow(levels.min(31));
    capacity(parts(scene.triangles().len(), 4) + parts(scene.segments().len(), 2) + scene.points().len() as u128)?;

    let mut positions = scene.positions().to_vec();
    let mut elements: Vec<Element> = scene.elements().collect();
    if scene.triangles().is_empty() && scene.segments().is_empty() {
        return Ok(Soup::new(positions, elements)?);
    }
    for _ in 0..levels {
        let edges = Edges::of(&elements, positions.len());
        let old = positions.len();
        // A soup of 2^30 primitives uses fewer positions than 2^32, but may have others.
        if u32::try_from(old + edges.upper.len()).is_err() {
            return Err(BuildError::TooMany { len: old + edges.upper.len() }.into());
        }
        positions.reserve(edges.upper.len());
        for (a, b) in edges.iter() {
            let middle = middle(&positions[a], &positions[b], amplitude, seed);
            positions.push(middle);
        }
        let mut parts = Vec::with_capacity(2 * elements.len());
        for &element in &elements {
            let middle = |a: u32, b: u32| edges.number(a, b, old);
            match element {
                Element::Point(_) => parts.push(element),
                Element::Segment([a, b]) => {
                    let m = middle(a, b);
                    parts.extend([[a, m], [m, b]].map(Element::Segment));
                }
                Element::Triangle([a, b, c]) => {
                    let [d, e, f] = [middle(b, c), middle(c, a), middle(a, b)];
                    parts.extend([[a, f, e], [f, b, d], [e, d, c], [d, e, f]].map(Element::Triangle));
                }
            }
        }
        elements = parts;
    }
    Ok(Soup::new(positions, elements)?)
}

/// The edges of all primitives, each once, in the order of their lower and then their upper vertex.
struct Edges {
    /// Where the edges of a lower vertex begin, and where those of the last one end.
    start: Vec<usize>,
    upper: Vec<u32>,
}

impl Edges {
    fn of(elements: &[Element], vertices: usize) -> Self {
        let mut pairs: Vec<[u32; 2]> = Vec::with_capacity(3 * elements.len());
        for element in elements {
            match *element {
                Element::Point(_) => {}
                Element::Segment([a, b]) => pairs.push([a, b]),
                Element::Triangle([a, b, c]) => pairs.extend([[a, b], [b, c], [c, a]]),
            }
        }
        for pair in &mut pairs {
            pair.sort_unstable();
        }
        pairs.sort_unstable();
        pairs.dedup();
        let mut start = vec![0; vertices + 1];
        for &[lower, _] in &pairs {
            start[lower as usize + 1] += 1;
        }
        for i in 0..vertices {
            start[i + 1] += start[i];
        }
        Self { start, upper: pairs.into_iter().map(|[_, upper]| upper).collect() }
    }

    fn iter(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.start
            .windows(2)
            .enumerate()
            .flat_map(|(lower, range)| self.upper[range[0]..range[1]].iter().map(move |&upper| (lower, upper as usize)))
    }

    /// The number of the vertex in the middle of an edge, if the first one has the number `first`.
    fn number(&self, a: u32, b: u32, first: usize) -> u32 {
        let (lower, upper) = (a.min(b) as usize, a.max(b));
        let start = self.start[lower];
        let place = self.upper[start..self.start[lower + 1]].partition_point(|&u| u < upper);
        #[allow(clippy::cast_possible_truncation, reason = "checked by the caller for the last edge")]
        let number = (first + start + place) as u32;
        number
    }
}

/// The middle of an edge, displaced: the same for both directions of the edge.
fn middle(a: &Point3<f64>, b: &Point3<f64>, amplitude: f64, seed: u64) -> Point3<f64> {
    let middle = Point3::from(a.coords * 0.5 + b.coords * 0.5);
    let along = b - a;
    let longest = along.amax();
    if amplitude == 0.0 || longest == 0.0 {
        return middle;
    }
    let length = (along / longest).norm() * longest;
    let mut random = EdgeRandom::new(a, b, seed);
    let by: Vector3<f64> = in_ball(|| random.next()) * (amplitude * length);
    middle + by
}

/// Random numbers of an edge, from the digits of its ends: splitmix64, absorbing them first.
struct EdgeRandom(u64);

impl EdgeRandom {
    fn new(a: &Point3<f64>, b: &Point3<f64>, seed: u64) -> Self {
        // Adding zero turns -0 into 0.
        let digits = |p: &Point3<f64>| [p.x, p.y, p.z].map(|x| (x + 0.0).to_bits());
        let mut ends = [digits(a), digits(b)];
        ends.sort_unstable();
        let mut state = Self(seed);
        for word in ends.into_iter().flatten() {
            state.0 = state.next() ^ word;
        }
        state
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }
}
