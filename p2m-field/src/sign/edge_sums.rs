//! A test of whether triangles form a surface without a boundary, which sees each triangle once.

use super::types::SignRule;
use twox_hash::XxHash3_64;

/// Sums over the edges of triangles, which show whether the triangles form a surface without a boundary. Triangles may
/// be added in any order and in parts, and are not kept in memory.
///
/// Each edge has a hash of 128 bits of the coordinates of its ends. The hashes cancel if as many triangles run through
/// each edge in one direction as in the other, and each of their bits is set an even number of times if each edge has
/// an even number of triangles. Other surfaces have such sums with a probability of about 2^-128, if hashes
/// behave like random numbers.
///
/// ```
/// use p2m_field::sign::{EdgeSums, SignRule};
///
/// let mut sums = EdgeSums::default();
/// let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// for [a, b, c] in [[0, 2, 1], [0, 1, 3], [1, 2, 3]] {
///     sums.add([corners[a], corners[b], corners[c]]);
/// }
/// assert_eq!(sums.rule(), None);
/// sums.add([corners[0], corners[3], corners[2]]);
/// assert_eq!(sums.rule(), Some(SignRule::Winding));
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct EdgeSums {
    /// The sum of the hashes of edges that run upwards, less the sum of the hashes of edges that run downwards.
    directed: u128,
    /// The exclusive or of all hashes.
    any: u128,
}

impl EdgeSums {
    /// Adds a triangle.
    pub fn add(&mut self, [a, b, c]: [[f64; 3]; 3]) {
        // The sum of -0 and 0 is 0.
        let [a, b, c] = [a, b, c].map(|corner| corner.map(|x| (x + 0.0).to_bits()));
        // The edges of a triangle with equal corners cancel each other.
        if a == b || b == c || c == a {
            return;
        }
        for (start, end) in [(a, b), (b, c), (c, a)] {
            let hash = hash(start.min(end), start.max(end));
            self.directed =
                if start < end { self.directed.wrapping_add(hash) } else { self.directed.wrapping_sub(hash) };
            self.any ^= hash;
        }
    }

    /// Returns the rule that [`SignedDistance::new`](super::SignedDistance::new) chooses for a surface without a
    /// boundary, or `None` if an edge has an odd number of triangles.
    #[must_use]
    pub fn rule(&self) -> Option<SignRule> {
        match (self.directed, self.any) {
            (0, _) => Some(SignRule::Winding),
            (_, 0) => Some(SignRule::Parity),
            _ => None,
        }
    }
}

fn hash(low: [u64; 3], high: [u64; 3]) -> u128 {
    let mut bytes = [0; 48];
    for (place, number) in bytes.chunks_exact_mut(8).zip(low.into_iter().chain(high)) {
        place.copy_from_slice(&number.to_le_bytes());
    }
    let half = |seed| u128::from(XxHash3_64::oneshot_with_seed(seed, &bytes));
    half(1) << 64 | half(2)
}
