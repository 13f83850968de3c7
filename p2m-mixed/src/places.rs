//! Positions by their coordinates: files often repeat them, or have some that nothing uses.

use nalgebra::Point3;
use p2m_core::{PrimitiveSet, Soup};

/// No place: nothing uses the position.
pub const UNUSED: u32 = u32::MAX;

/// The distinct coordinates among the positions that primitives use; 0 and -0 are the same.
pub struct Places {
    /// The place of each position, from 0; `UNUSED` where there is none.
    pub of: Vec<u32>,
    /// How many there are.
    pub len: usize,
    /// How many positions are used.
    pub used: usize,
}

impl Places {
    /// # Complexity
    /// O(n log n) time; 32 bytes a used position while it runs, 4 bytes a position after.
    #[allow(clippy::cast_possible_truncation, reason = "positions are numbered by u32")]
    pub fn new(soup: &Soup<f64>) -> Self {
        let mut of = vec![UNUSED; soup.positions().len()];
        let indices = soup.triangles().iter().flatten().chain(soup.segments().iter().flatten()).chain(soup.points());
        for &i in indices {
            of[i as usize] = 0;
        }
        let mut sorted: Vec<([u64; 3], u32)> =
            (0..of.len()).filter(|&i| of[i] != UNUSED).map(|i| (key(&soup.positions()[i]), i as u32)).collect();
        sorted.sort_unstable();
        let mut len = 0;
        for (same, group) in sorted.chunk_by(|a, b| a.0 == b.0).enumerate() {
            for &(_, i) in group {
                of[i as usize] = same as u32;
            }
            len = same + 1;
        }
        Self { of, len, used: sorted.len() }
    }

    pub fn of<const N: usize>(&self, indices: [u32; N]) -> [u32; N] {
        indices.map(|i| self.of[i as usize])
    }

    /// How many parts the scene has that share no place with each other.
    pub fn components(&self, soup: &Soup<f64>) -> usize {
        let mut forest = Forest::new(self.len);
        for t in soup.triangles() {
            let [a, b, c] = self.of(*t);
            forest.unite(a, b);
            forest.unite(b, c);
        }
        for s in soup.segments() {
            let [a, b] = self.of(*s);
            forest.unite(a, b);
        }
        assert!(self.len > 0 || soup.is_empty(), "a scene has the places of its vertices");
        forest.trees
    }
}

/// Equal for equal coordinates.
fn key(p: &Point3<f64>) -> [u64; 3] {
    // Adding zero turns -0 into 0.
    [p.x, p.y, p.z].map(|x| (x + 0.0).to_bits())
}

/// Disjoint sets.
pub struct Forest {
    parent: Vec<u32>,
    trees: usize,
}

impl Forest {
    #[allow(clippy::cast_possible_truncation, reason = "whoever has more than u32 can number has no room for them")]
    pub fn new(len: usize) -> Self {
        Self { parent: (0..len as u32).collect(), trees: len }
    }

    /// The number of its set: that of a member.
    pub fn root(&mut self, mut x: u32) -> u32 {
        loop {
            let parent = self.parent[x as usize];
            if parent == x {
                return x;
            }
            // Halving the path keeps it short.
            self.parent[x as usize] = self.parent[parent as usize];
            x = parent;
        }
    }

    pub fn unite(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        if a != b {
            self.parent[a.max(b) as usize] = a.min(b);
            self.trees -= 1;
        }
    }
}

/// Sorts pairs by their first, a place, and then by their second, and shows those of each place, which are sorted, to
/// `visit`.
///
/// # Complexity
/// O(n log n) for the most pairs at one place, O(n) for meshes.
pub fn by_place<K: Copy + Default + Ord>(
    places: usize,
    pairs: impl Iterator<Item = (u32, K)> + Clone,
    mut visit: impl FnMut(&[K]),
) {
    let mut ends = vec![0usize; places + 1];
    let mut count = 0;
    for (place, _) in pairs.clone() {
        ends[place as usize + 1] += 1;
        count += 1;
    }
    for i in 1..ends.len() {
        ends[i] += ends[i - 1];
    }
    // The start of each place moves to its end while the pairs are put in.
    let mut sorted = vec![K::default(); count];
    for (place, key) in pairs {
        let at = &mut ends[place as usize];
        sorted[*at] = key;
        *at += 1;
    }
    let mut start = 0;
    for &end in &ends[..places] {
        let group = &mut sorted[start..end];
        group.sort_unstable();
        visit(group);
        start = end;
    }
}
