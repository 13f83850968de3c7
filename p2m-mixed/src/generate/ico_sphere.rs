//! The sphere as a subdivided icosahedron: triangles of nearly the same size and shape everywhere.

use super::error::{GenerateError, at_least, capacity};
use nalgebra::{Point3, Vector3};
use p2m_core::Soup;

/// Options of [`ico_sphere`]. The default makes 11,520 triangles.
///
/// ```
/// use p2m_mixed::generate::{IcoSphere, ico_sphere};
///
/// // Two rounds of midpoint subdivision of the icosahedron.
/// let ball = ico_sphere(&IcoSphere { frequency: 4 }).unwrap();
/// assert_eq!((ball.positions().len(), ball.triangles().len()), (162, 320));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct IcoSphere {
    /// The number of parts that each edge of the icosahedron is divided into, at least 1.
    pub frequency: u32,
}

impl Default for IcoSphere {
    fn default() -> Self {
        Self { frequency: 24 }
    }
}

/// Makes the unit sphere as an icosahedron whose faces are divided into `frequency`^2 triangles each. It has
/// 20 `frequency`^2 triangles and 10 `frequency`^2 + 2 vertices.
///
/// # Errors
/// [`GenerateError`] if an option is not in its range or there are more primitives than ids.
pub fn ico_sphere(options: &IcoSphere) -> Result<Soup<f64>, GenerateError> {
    let n = options.frequency;
    at_least(1, "frequency", n)?;
    let len = capacity(20 * u128::from(n) * u128::from(n))?;
    let (corners, faces) = icosahedron();

    // The corners come first, then the vertices within edges, then those within faces.
    let weighted = |weights: [u32; 3], at: [u32; 3]| {
        let sum = |i: usize, j: usize| f64::from(weights[i]) * corners[at[j] as usize];
        Point3::from((sum(0, 0) + sum(1, 1) + sum(2, 2)).normalize())
    };
    let mut positions = Vec::with_capacity(len / 2 + 2);
    positions.extend(corners.iter().map(|c| Point3::from(c.normalize())));
    let mut edges: Vec<[u32; 2]> = Vec::with_capacity(30);
    for &[a, b, c] in &faces {
        // Each edge runs upwards in one of its two faces.
        edges.extend([[a, b], [b, c], [c, a]].into_iter().filter(|[a, b]| a < b));
    }
    edges.sort_unstable();
    for &[a, b] in &edges {
        positions.extend((1..n).map(|i| weighted([n - i, i, 0], [a, b, a])));
    }
    let in_edges = 12 + 30 * (n - 1);
    let in_face = (n - 1) * n.saturating_sub(2) / 2;
    let mut triangles = Vec::with_capacity(len);
    for (face, &[a, b, c]) in (0u32..).zip(&faces) {
        for i in 1..n {
            positions.extend((1..n - i).map(|j| weighted([n - i - j, i, j], [a, b, c])));
        }
        // `vertex` returns the vertex i steps from a towards b and j steps towards c.
        let within = |from: u32, to: u32, steps: u32| {
            let edge = edges.binary_search(&[from.min(to), from.max(to)]).unwrap_or_else(|_| unreachable!("an edge"));
            let steps = if from < to { steps } else { n - steps };
            12 + u32::try_from(edge).unwrap_or(u32::MAX) * (n - 1) + steps - 1
        };
        let vertex = |i: u32, j: u32| match (n - i - j, i, j) {
            (_, 0, 0) => a,
            (0, _, 0) => b,
            (0, 0, _) => c,
            (_, i, 0) => within(a, b, i),
            (_, 0, j) => within(a, c, j),
            (0, _, j) => within(b, c, j),
            // Row i has n - 1 - i vertices.
            (_, i, j) => in_edges + face * in_face + (i - 1) * (n - 1) - i * (i - 1) / 2 + j - 1,
        };
        for i in 0..n {
            for j in 0..n - i {
                triangles.push([vertex(i, j), vertex(i + 1, j), vertex(i, j + 1)]);
                if i + j + 1 < n {
                    triangles.push([vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)]);
                }
            }
        }
    }
    Ok(Soup::from_triangles(positions, triangles)?)
}

/// Returns the corners and faces of an icosahedron with edges of length 2.
///
/// Corner 4k + 2s + t has the coordinate +-1 on axis k and +-phi, the golden ratio, on the next axis. The first sign is
/// positive if s is 0, the second if t is 0.
///
/// Eight faces have one corner of each k and lie in one octant each. The other twelve faces have an edge between two
/// corners that differ only in s, and a corner of the next k on the same side. Their orientation is the sign of a
/// determinant, which is that of a product of signs.
fn icosahedron() -> ([Vector3<f64>; 12], [[u32; 3]; 20]) {
    let phi = (1.0 + 5f64.sqrt()) / 2.0;
    let signed = |sign: u32, x: f64| if sign == 0 { x } else { -x };
    let number = |k: u32, s: u32, t: u32| 4 * (k % 3) + 2 * s + t;
    let mut corners = [Vector3::zeros(); 12];
    let mut faces = [[0; 3]; 20];
    let mut count = 0;
    let mut face = |odd: bool, [a, b, c]: [u32; 3]| {
        faces[count] = if odd { [a, c, b] } else { [a, b, c] };
        count += 1;
    };
    for signs in 0..8u32 {
        let [x, y, z] = [signs & 1, signs >> 1 & 1, signs >> 2];
        face((x + y + z) % 2 == 1, [number(0, x, y), number(1, y, z), number(2, z, x)]);
    }
    for k in 0..3u32 {
        for (s, t) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let corner = &mut corners[number(k, s, t) as usize];
            corner[k as usize] = signed(s, 1.0);
            corner[(k as usize + 1) % 3] = signed(t, phi);
            face(s != t, [number(k, 0, s), number(k, 1, s), number(k + 1, s, t)]);
        }
    }
    (corners, faces)
}
