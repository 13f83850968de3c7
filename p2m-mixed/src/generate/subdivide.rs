//! Midpoint subdivision with displacement, which makes large scenes from small ones.
//!
//! The displacement of an edge depends only on the coordinates of its ends. So a shared edge stays shared, two edges
//! with the same ends get the same midpoint, and the order of primitives changes no position.

use super::error::{GenerateError, capacity, in_range};
use super::portable::in_ball;
use nalgebra::{Point3, Vector3};
use p2m_core::{BuildError, Element, Soup};

/// Options of [`subdivide`].
///
/// ```
/// use p2m_mixed::generate::{IcoSphere, Subdivide, ico_sphere, subdivide};
///
/// let ball = ico_sphere(&IcoSphere { frequency: 1 }).unwrap();
/// let rough = subdivide(&ball, &Subdivide { levels: 3, amplitude: 0.1, ..Default::default() }).unwrap();
/// assert_eq!((rough.positions().len(), rough.triangles().len()), (642, 20 * 64));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Subdivide {
    /// The number of times that each triangle becomes four and each segment two.
    pub levels: u32,
    /// The largest displacement of a midpoint as a fraction of the length of its edge, from 0 to 0.5. Each level
    /// displaces the midpoints of the edges of the level before.
    pub amplitude: f64,
    /// The seed of the random displacements.
    pub seed: u64,
}

impl Default for Subdivide {
    fn default() -> Self {
        Self { levels: 1, amplitude: 0.0, seed: 1 }
    }
}

/// Splits each triangle at the midpoints of its edges into four and each segment into two, `levels` times.
///
/// The parts of a primitive take its place in the order. A triangle becomes the parts at its first, second and third
/// corner and then the central part, all with its orientation. Points do not change. Midpoints come after the positions
/// of the level before. They are displaced in random directions, so triangles may cross each other for large
/// amplitudes.
///
/// # Errors
/// [`GenerateError::OutOfRange`] for an amplitude that is not from 0 to 0.5, [`GenerateError::Build`] if there are more
/// primitives than ids or a coordinate overflows.
///
/// # Complexity
/// Time O(m log m) and memory O(m) for m primitives of the result.
pub fn subdivide(scene: &Soup<f64>, options: &Subdivide) -> Result<Soup<f64>, GenerateError> {
    let &Subdivide { levels, amplitude, seed } = options;
    in_range((0.0..=0.5).contains(&amplitude), "amplitude", amplitude, "from 0 to 0.5")?;
    // More levels make no difference, because a segment has too many parts after 31 levels.
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
        // A soup of 2^30 primitives uses fewer than 2^32 positions, but may have unused ones.
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
            let middle = |a: u32, b: u32| edges.midpoint_index(a, b, old);
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

/// The distinct edges of all primitives, in compressed rows: an edge is stored at its lower vertex. The edges are
/// sorted, so the place of an edge is the number of its midpoint, and no hash table is needed to share midpoints
/// between triangles.
struct Edges {
    /// The index of the first edge of each lower vertex, and the number of edges at the end.
    start: Vec<usize>,
    /// The upper vertex of each edge.
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

    /// Returns the index of the midpoint of an edge. `first` is the index of the first midpoint.
    fn midpoint_index(&self, a: u32, b: u32, first: usize) -> u32 {
        let (lower, upper) = (a.min(b) as usize, a.max(b));
        let start = self.start[lower];
        let offset = self.upper[start..self.start[lower + 1]].partition_point(|&u| u < upper);
        #[allow(clippy::cast_possible_truncation, reason = "checked by the caller for the last edge")]
        let index = (first + start + offset) as u32;
        index
    }
}

/// Returns the displaced midpoint of an edge, which is the same for both directions of the edge.
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

/// Random numbers that depend on the coordinates of the ends of an edge: a splitmix64 generator that absorbs them first
/// \[Steele2014\].
struct EdgeRandom(u64);

impl EdgeRandom {
    fn new(a: &Point3<f64>, b: &Point3<f64>, seed: u64) -> Self {
        // The sum of -0 and 0 is 0, so equal coordinates have equal bits.
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
