//! Detection of triangles whose nearest point is certainly a vertex, eight at a time.
//!
//! For a query far from a mesh, all triangles around the nearest vertex have equal keys, and only the lowest id among
//! them remains to be found.

use super::triangle::{MAX_PLAIN_SIZE, MIN_PLAIN_SIZE, OUTWARD_MARGIN};
use super::vector::{V3, larger, smaller};

/// The number of triangles that are computed at once.
pub const SIDE_BY_SIDE: usize = 8;
type Row = [f64; SIDE_BY_SIDE];

/// Returns the squares of the keys of triangles whose nearest point is certainly a vertex, with the bits of
/// `kernel::triangle::triangle`, and infinity for the others. `corners[v][k]` has coordinate k of vertex v
/// of each triangle.
#[inline(always)]
#[allow(clippy::needless_range_loop, reason = "rows side by side")]
pub fn certain_vertices(query: V3, corners: &[[Row; 3]; 3]) -> Row {
    let mut offsets = *corners;
    let mut size = [0.0; SIDE_BY_SIDE];
    let mut squares = [[0.0; SIDE_BY_SIDE]; 3];
    for v in 0..3 {
        for k in 0..3 {
            for i in 0..SIDE_BY_SIDE {
                offsets[v][k][i] = corners[v][k][i] - query[k];
                size[i] = larger(offsets[v][k][i].abs(), size[i]);
            }
        }
        for i in 0..SIDE_BY_SIDE {
            let [x, y, z] = [offsets[v][0][i], offsets[v][1][i], offsets[v][2][i]];
            squares[v][i] = x * x + y * y + z * z;
        }
    }
    let mut result = [f64::INFINITY; SIDE_BY_SIDE];
    for v in 0..3 {
        let (next, last) = ((v + 1) % 3, (v + 2) % 3);
        for i in 0..SIDE_BY_SIDE {
            let mut least = f64::INFINITY;
            for w in [next, last] {
                let [x, y, z] = [offsets[v][0][i], offsets[v][1][i], offsets[v][2][i]];
                let outward = x * (offsets[w][0][i] - x) + y * (offsets[w][1][i] - y) + z * (offsets[w][2][i] - z);
                least = smaller(outward, least);
            }
            let is_certain = least > OUTWARD_MARGIN * (size[i] * size[i]);
            result[i] = if is_certain { squares[v][i] } else { result[i] };
        }
    }
    for i in 0..SIDE_BY_SIDE {
        // The square is plain: the size is, and the distance is at least 2^-38 of it.
        let is_plain = size[i] >= MIN_PLAIN_SIZE && size[i] <= MAX_PLAIN_SIZE;
        result[i] = if is_plain { result[i] } else { f64::INFINITY };
    }
    result
}

#[cfg(test)]
#[allow(clippy::needless_range_loop, reason = "rows side by side")]
mod tests {
    use super::*;
    use crate::kernel::triangle::triangle;
    use rand::RngExt;

    #[test]
    fn squares_are_the_keys_of_the_kernel_where_they_are_certain() {
        let (mut certain, mut others) = (0, 0);
        let cases = p2m_testkit::cases(20_000, 6_000);
        for case in cases.clone() {
            let (round, mut rng) = (case as usize, p2m_testkit::rng("certain vertices", case));
            let mut unit = || rng.random_range(-0.5..0.5);
            let scale = 2f64.powi([0, 0, 30, -200, 300][round % 5]);
            let far = 2f64.powi(round as i32 % 12 - 2);
            let mut corners = [[[0.0; SIDE_BY_SIDE]; 3]; 3];
            for v in 0..3 {
                for k in 0..3 {
                    for i in 0..SIDE_BY_SIDE {
                        // The fifth triangle has two equal vertices.
                        let is_repeated = v == 2 && i == 4;
                        corners[v][k][i] = if is_repeated { corners[0][k][i] } else { unit() * scale };
                    }
                }
            }
            let query = [0; 3].map(|_| unit() * far * scale);
            let squares = certain_vertices(query, &corners);
            for i in 0..SIDE_BY_SIDE {
                let vertices = [0, 1, 2].map(|v: usize| [0, 1, 2].map(|k: usize| corners[v][k][i]));
                let key = triangle(query, vertices, f64::INFINITY).expect("no key exceeds infinity").key;
                if squares[i] < f64::INFINITY {
                    assert_eq!(key.plain_square(), Some(squares[i]), "{query:?} {vertices:?}");
                    certain += 1;
                } else {
                    others += 1;
                }
            }
        }
        assert!(cases.have_more_than(20_000, certain.min(others)), "{certain} {others}");
    }
}
