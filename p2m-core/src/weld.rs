//! Welding of vertices: positions with the same coordinates become one vertex.
//!
//! Files often repeat positions (STL files repeat them for each triangle), and some have positions that no primitive
//! uses. Topology, components and statistics are therefore computed on welded vertices.

use crate::{PrimitiveSet, Soup};
use nalgebra::Point3;

/// The vertex id of a position that no primitive uses.
pub const UNUSED: u32 = u32::MAX;

/// The distinct vertices of a soup. Positions that primitives use are welded if their coordinates are equal.
///
/// The coordinates 0 and -0 are equal.
pub struct VertexWelder {
    /// The vertex id of each position, from 0, or [`UNUSED`].
    pub vertex_ids: Vec<u32>,
    /// The number of vertices.
    pub vertex_count: usize,
    /// The number of positions that primitives use.
    pub used_positions: usize,
}

impl VertexWelder {
    /// Welds the positions of a soup.
    ///
    /// # Complexity
    /// O(n log n) time. It takes 32 bytes per used position while the function runs, and 4 bytes per position
    /// afterwards.
    #[allow(clippy::cast_possible_truncation, reason = "positions are numbered by u32")]
    pub fn new(soup: &Soup<f64>) -> Self {
        let mut vertex_ids = vec![UNUSED; soup.positions().len()];
        let indices = soup.triangles().iter().flatten().chain(soup.segments().iter().flatten()).chain(soup.points());
        for &i in indices {
            vertex_ids[i as usize] = 0;
        }
        let mut sorted: Vec<([u64; 3], u32)> = (0..vertex_ids.len())
            .filter(|&i| vertex_ids[i] != UNUSED)
            .map(|i| (coordinate_key(&soup.positions()[i]), i as u32))
            .collect();
        sorted.sort_unstable();
        let mut vertex_count = 0;
        for (vertex, group) in sorted.chunk_by(|a, b| a.0 == b.0).enumerate() {
            for &(_, i) in group {
                vertex_ids[i as usize] = vertex as u32;
            }
            vertex_count = vertex + 1;
        }
        Self { vertex_ids, vertex_count, used_positions: sorted.len() }
    }

    /// Converts indices of positions to vertex ids.
    pub fn weld<const N: usize>(&self, positions: [u32; N]) -> [u32; N] {
        positions.map(|i| self.vertex_ids[i as usize])
    }

    /// Returns the number of connected components of the scene. Different components share no vertex.
    ///
    /// # Panics
    /// Panics if the scene is not the scene of [`VertexWelder::new`] and has more positions.
    pub fn count_components(&self, soup: &Soup<f64>) -> usize {
        let mut sets = UnionFind::new(self.vertex_count);
        for t in soup.triangles() {
            let [a, b, c] = self.weld(*t);
            sets.union(a, b);
            sets.union(b, c);
        }
        for s in soup.segments() {
            let [a, b] = self.weld(*s);
            sets.union(a, b);
        }
        assert!(self.vertex_count > 0 || soup.is_empty(), "every primitive has a vertex");
        sets.set_count
    }
}

/// Returns a key that is equal for equal coordinates.
fn coordinate_key(p: &Point3<f64>) -> [u64; 3] {
    // The sum of -0 and 0 is 0.
    [p.x, p.y, p.z].map(|x| (x + 0.0).to_bits())
}

/// A union-find structure: disjoint sets of the numbers below a limit.
pub struct UnionFind {
    parent: Vec<u32>,
    set_count: usize,
}

impl UnionFind {
    /// Creates a set for each number below `len`.
    #[allow(clippy::cast_possible_truncation, reason = "more numbers than u32 has do not fit into memory")]
    pub fn new(len: usize) -> Self {
        Self { parent: (0..len as u32).collect(), set_count: len }
    }

    /// Returns the representative of the set that contains `x`.
    pub fn find(&mut self, mut x: u32) -> u32 {
        loop {
            let parent = self.parent[x as usize];
            if parent == x {
                return x;
            }
            // Path halving keeps paths short.
            self.parent[x as usize] = self.parent[parent as usize];
            x = parent;
        }
    }

    /// Merges the sets that contain `a` and `b`.
    pub fn union(&mut self, a: u32, b: u32) {
        let (a, b) = (self.find(a), self.find(b));
        if a != b {
            self.parent[a.max(b) as usize] = a.min(b);
            self.set_count -= 1;
        }
    }
}

/// Groups pairs by vertex, and calls `visit` for each vertex in ascending order with the sorted values of its pairs.
///
/// # Complexity
/// O(n log n) if most pairs are at one vertex, O(n) for meshes.
pub fn group_by_vertex<V: Copy + Default + Ord>(
    vertex_count: usize,
    pairs: impl Iterator<Item = (u32, V)> + Clone,
    mut visit: impl FnMut(&[V]),
) {
    let mut ends = vec![0usize; vertex_count + 1];
    let mut count = 0;
    for (vertex, _) in pairs.clone() {
        ends[vertex as usize + 1] += 1;
        count += 1;
    }
    for i in 1..ends.len() {
        ends[i] += ends[i - 1];
    }
    // `ends` has the start of each group at first. Inserting a value moves it by one, so that it becomes the end of the
    // group.
    let mut sorted = vec![V::default(); count];
    for (vertex, value) in pairs {
        let end = &mut ends[vertex as usize];
        sorted[*end] = value;
        *end += 1;
    }
    let mut start = 0;
    for &end in &ends[..vertex_count] {
        let group = &mut sorted[start..end];
        group.sort_unstable();
        visit(group);
        start = end;
    }
}
