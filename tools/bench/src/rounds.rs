//! Checksums of answers, and the rounds of `p2m_cli::harness`, which all measuring loops of this program share.

use p2m_core::Closest;

pub(crate) use p2m_cli::harness::rounds::{Rounds, rotated, thread_seconds};

/// Returns a checksum of answers, each given by the bits of its number and the id of its primitive. It depends on every
/// bit and on the order of the answers. `start` is the checksum of earlier answers, or 0.
pub(crate) fn checksum(start: u64, answers: impl Iterator<Item = (u64, u64)>) -> u64 {
    answers.fold(start, |sum, (bits, id)| (sum ^ bits).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(23) ^ id)
}

/// Returns a checksum of the distances and primitives of answers.
pub(crate) fn checksum_of_closest(answers: &[Option<Closest<f64>>]) -> u64 {
    let answers = answers.iter().flatten();
    checksum(0, answers.map(|answer| (answer.distance.to_bits(), answer.primitive.index() as u64)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checksums_see_order_and_ids() {
        let sum = |answers: &[(u64, u64)]| checksum(0, answers.iter().copied());
        assert_ne!(sum(&[(1, 3), (2, 3)]), sum(&[(2, 3), (1, 3)]));
        assert_ne!(sum(&[(1, 3), (2, 3)]), sum(&[(1, 4), (2, 3)]));
        assert_eq!(sum(&[(1, 3), (2, 3)]), checksum(sum(&[(1, 3)]), [(2, 3)].into_iter()));
    }
}
