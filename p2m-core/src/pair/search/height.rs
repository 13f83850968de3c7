//! Heights: upper bounds on the extents of nodes along a direction.

use super::place::WIDTH;
use crate::kernel::vector::{V3, dot, power_of_two};
use crate::simd::Lanes;

/// The slack per unit of the sum of all factors. Coordinates in a frame are at most 4, and each term has at most four
/// roundings of 2^-24.
const SLACK: f64 = power_of_two(-19);

/// The lengths of vectors that can be normalised.
const PLAIN_LENGTHS: std::ops::RangeInclusive<f64> = power_of_two(-400)..=power_of_two(400);

/// Returns the unit vector along `v`, or `None` if the length of `v` overflows or vanishes.
pub(super) fn unit(v: V3) -> Option<V3> {
    let length = dot(v, v).sqrt();
    PLAIN_LENGTHS.contains(&length).then(|| v.map(|x| x / length))
}

/// Returns the least and the largest of several heights.
pub(super) fn extent(heights: impl Iterator<Item = f64>) -> [f64; 2] {
    heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
}

/// A direction in a frame, as the weighted sum of three rows of a node.
///
/// The height of a child along a direction is the largest dot product of the direction and a point of the child. The
/// sum is an upper bound on it.
#[derive(Clone, Copy, Debug)]
pub struct Height {
    rows: [usize; 3],
    factors: [f32; 3],
    /// The most by which the sum may be too small.
    pub slack: f32,
}

impl Height {
    /// Creates the sum of three rows with these factors.
    #[must_use]
    #[allow(clippy::cast_possible_truncation, reason = "the slack covers the rounding")]
    pub fn new(terms: [(usize, f64); 3]) -> Self {
        // An unused slot has infinite bounds, and zero times infinity would be NaN.
        let factor =
            |x: f64| if (x as f32).abs() < f32::MIN_POSITIVE { f32::MIN_POSITIVE.copysign(x as f32) } else { x as f32 };
        let sum: f64 = terms.iter().map(|(_, factor)| factor.abs()).sum();
        Self {
            rows: terms.map(|(row, _)| row),
            factors: terms.map(|(_, x)| factor(x)),
            slack: ((sum * SLACK) as f32).next_up(),
        }
    }

    /// Returns the heights of the eight children of a node. The heights of unused slots are minus infinity if their
    /// bounds are those of the empty set.
    #[inline(always)]
    pub fn of_children<L: Lanes, N: Rows>(&self, node: &N) -> L {
        // No closure here, because a closure would be compiled without the instruction set.
        let [x, y, z] = self.factors;
        let sum = L::load(node.row(self.rows[0])).mul(L::splat(x));
        let sum = L::load(node.row(self.rows[1])).mul_add(L::splat(y), sum);
        L::load(node.row(self.rows[2])).mul_add(L::splat(z), sum)
    }

    /// Returns the height of the child in a slot, with slack.
    #[inline(always)]
    pub fn of_child<N: Rows>(&self, node: &N, slot: usize) -> f64 {
        let term = |i: usize| f64::from(node.row(self.rows[i])[slot]) * f64::from(self.factors[i]);
        term(0) + term(1) + term(2) + f64::from(self.slack)
    }
}

/// A node as rows of numbers that bound its children.
pub trait Rows {
    /// Returns a row.
    fn row(&self, number: usize) -> &[f32; WIDTH];
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::{InstructionSet, Isa, SimdKernel};
    use p2m_testkit::{cases, rng, vector};
    use rand::RngExt;

    struct Node([[f32; WIDTH]; 3]);

    impl Rows for Node {
        fn row(&self, number: usize) -> &[f32; WIDTH] {
            &self.0[number]
        }
    }

    struct Heights<'a>(&'a Height, &'a Node);

    impl SimdKernel for Heights<'_> {
        type Output = [f32; WIDTH];

        fn run<I: InstructionSet>(self) -> Self::Output {
            let mut heights = [0.0; WIDTH];
            self.0.of_children::<I::F32x8, _>(self.1).store(&mut heights);
            heights
        }
    }

    #[test]
    fn heights_with_their_slack_are_upper_bounds() {
        for case in cases(100_000, 2_000) {
            let mut rng = rng("heights of rows", case);
            let size = [1.0, 4.0][rng.random_range(0..2)];
            let node = Node(std::array::from_fn(|_| std::array::from_fn(|_| size * rng.random_range(-1.0..1.0))));
            let direction = vector(&mut rng).normalize();
            let height = Height::new(std::array::from_fn(|k| (k, direction[k])));
            for isa in Isa::available() {
                let heights = isa.run(Heights(&height, &node));
                for (slot, computed) in heights.into_iter().enumerate() {
                    // The error of the product in f64 is far below the roundings of f32.
                    let exact: f64 = (0..3).map(|k| direction[k] * f64::from(node.0[k][slot])).sum();
                    let at_most = f64::from(computed) + f64::from(height.slack);
                    assert!(exact <= at_most && exact <= height.of_child(&node, slot), "{case}: {exact} {at_most}");
                }
            }
        }
    }
}
