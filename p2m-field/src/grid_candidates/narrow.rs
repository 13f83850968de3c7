//! Narrows the candidates of a box to the candidates of a part of the box.
//!
//! The basic idea is that each corner of the part offers its closest point as a *dominator*. A candidate is excluded
//! if, for some dominator, it is farther than the dominator at all eight corners:
//!
//! ```text
//! for each candidate: the squared distances from the eight corners, in one vector
//! for each corner: descend to a primitive near it, from the candidate that is nearest there;
//!     dominator = the closest point of that primitive, with its squared distances from all corners and a slack
//! keep a candidate unless some dominator is nearer at all corners
//! open the groups that are kept, unless they are small beside the part, and test their members in the same way
//! ```

use super::candidates::{Candidates, Detail};
use super::error_bounds::{ERROR_PER_REACH, INSIDE_MARGIN_PER_REACH, UNDERFLOW_ERROR};
use super::groups::{Entry, Group, Groups};
use super::squared_distances::{squared_distances, squared_distances_from_box};
use p2m_core::Aabb;
use p2m_core::engine::simd::{Doubles, Float, InstructionSet, Isa, SimdKernel};
use p2m_core::engine::vector::{V3, larger, norm_squared, sub};

/// The bounding ball of a box, which bounds the distances of its points.
struct Ball {
    centre: V3,
    radius: f64,
}

/// A factor that turns the result of a few roundings into an upper bound.
const ROUND_UP: f64 = 1.0 + 1e-9;

impl Ball {
    fn around([low, high]: [V3; 2]) -> Self {
        let centre = [0, 1, 2].map(|k: usize| low[k] * 0.5 + high[k] * 0.5);
        // The radius covers the rounding of the centre, which is at most one ulp.
        let ulp = f64::EPSILON * p2m_core::engine::vector::largest(&[low, high]);
        Self { centre, radius: norm_squared(sub(high, low)).sqrt() * 0.5 * ROUND_UP + 2.0 * ulp }
    }

    /// Returns an upper bound on the distance of a point of the ball from a vertex of an entry.
    #[inline(always)]
    fn reach(&self, entry: Entry<'_>) -> f64 {
        let (offset, length) = match entry {
            Entry::Primitive(primitive) => (sub(primitive.origin, self.centre), primitive.length),
            Entry::Group(Group { bounds: [low, high], .. }) => {
                let (low, high) = (sub(*low, self.centre), sub(*high, self.centre));
                ([0, 1, 2].map(|k: usize| larger(-low[k], high[k])), 0.0)
            }
        };
        (norm_squared(offset).sqrt() + length + self.radius) * ROUND_UP
    }
}

/// Finds the candidates of a part of the box of `candidates`.
pub(crate) struct Narrow<'a> {
    pub(crate) groups: &'a Groups,
    pub(crate) candidates: &'a Candidates,
    pub(crate) part: &'a Aabb<f64>,
    pub(crate) detail: Detail,
}

/// The largest diagonal of a group that stays together, as a fraction of the diagonal of the part. No record exists of
/// the scenes on which it was tuned.
const MAX_GROUP_DIAGONAL_FRACTION: f64 = 0.35;

/// Returns the squared distances of eight points from an entry.
#[inline(always)]
fn entry_squared_distances<D: Doubles>(entry: Entry<'_>, points: &[D; 3], margin: D) -> D {
    match entry {
        Entry::Primitive(primitive) => squared_distances(primitive, points, margin),
        Entry::Group(group) => squared_distances_from_box(&group.bounds, points),
    }
}

/// Returns whether a candidate with these squared distances from the corners is kept, because no dominator is nearer at
/// all corners.
#[inline(always)]
fn is_kept<D: Doubles>(squares: D, dominators: &[D; 8]) -> bool {
    let mut is_kept = true;
    for dominator in dominators {
        is_kept &= squares.at_most(*dominator) != 0;
    }
    is_kept
}

impl Narrow<'_> {
    /// Runs the kernel. This function is not generic, so the kernel is compiled in this crate.
    pub(crate) fn run_on(self, isa: Isa) -> Candidates {
        isa.run(self)
    }
}

impl SimdKernel for Narrow<'_> {
    type Output = Candidates;

    #[inline(always)]
    fn run<I: InstructionSet>(self) -> Candidates {
        let Self { groups, candidates, part, detail } = self;
        let Some(first) = candidates.entries.first() else {
            return Candidates { entries: Vec::new(), nearest: f64::INFINITY, reach: 0.0, bounds: Some(*part) };
        };
        let ends: [V3; 2] = [part.min.coords.into(), part.max.coords.into()];
        let ball = Ball::around(ends);
        let corners: [[f64; 8]; 3] = std::array::from_fn(|k| std::array::from_fn(|i| ends[i >> k & 1][k]));
        let points = [I::Doubles::load(&corners[0]), I::Doubles::load(&corners[1]), I::Doubles::load(&corners[2])];
        let reach = candidates.entries.iter().map(|entry| ball.reach(groups.get(*entry)));
        let reach = if candidates.reach < f64::INFINITY { candidates.reach } else { reach.fold(0.0, larger) };
        let error = reach * ERROR_PER_REACH + UNDERFLOW_ERROR;
        let margin = I::Doubles::splat(reach * INSIDE_MARGIN_PER_REACH);

        // The loop finds the entry that is nearest to each corner.
        let mut all_squares: Vec<I::Doubles> = Vec::with_capacity(candidates.entries.len());
        let mut least = I::Doubles::splat(f64::INFINITY);
        let mut nearest = [*first; 8];
        for &entry in &candidates.entries {
            let squares = entry_squared_distances(groups.get(entry), &points, margin);
            let mut nearer = !least.at_most(squares);
            least = squares.min(least);
            while nearer != 0 {
                nearest[nearer.trailing_zeros() as usize] = entry;
                nearer &= nearer - 1;
            }
            all_squares.push(squares);
        }
        // The dominator of a corner is the closest point of the entry nearest there. Its squared distances from all
        // corners are increased by the slack of the proof, which is 4 E and the errors of both sides.
        let mut dominators = [I::Doubles::splat(0.0); 8];
        for (j, squares) in dominators.iter_mut().enumerate() {
            let corner: V3 = [corners[0][j], corners[1][j], corners[2][j]];
            let primitive = groups.descend(nearest[j], corner);
            let closest = primitive.closest_offset(corner);
            let mut largest = 0.0f64;
            let mut from_corners = [0.0; 8];
            for (i, square) in from_corners.iter_mut().enumerate() {
                let corner = [corners[0][i], corners[1][i], corners[2][i]];
                *square = norm_squared(sub(sub(corner, primitive.origin), closest));
                largest = larger(*square, largest);
            }
            let slack = 16.0 * error * largest.sqrt() + 64.0 * error * error;
            *squares = I::Doubles::load(&from_corners.map(|square| square + slack));
        }
        let max_squared_diagonal = match detail {
            Detail::Groups => {
                MAX_GROUP_DIAGONAL_FRACTION * MAX_GROUP_DIAGONAL_FRACTION * norm_squared(sub(ends[1], ends[0]))
            }
            Detail::Primitives => -1.0,
        };
        let (mut entries, mut kept_reach) = (Vec::with_capacity(candidates.entries.len()), 0.0);
        let mut pending = Vec::new();
        for (&entry, &squares) in candidates.entries.iter().zip(&all_squares) {
            if !is_kept(squares, &dominators) {
                continue;
            }
            let mut next = Some(entry);
            while let Some(id) = next {
                match groups.get(id) {
                    Entry::Group(group) if group.squared_diagonal() > max_squared_diagonal => {
                        for member in group.members() {
                            if is_kept(entry_squared_distances(groups.get(member), &points, margin), &dominators) {
                                pending.push(member);
                            }
                        }
                    }
                    entry => {
                        kept_reach = larger(ball.reach(entry), kept_reach);
                        entries.push(id);
                    }
                }
                next = pending.pop();
            }
        }
        let mut squares = [0.0; 8];
        least.store(&mut squares);
        let farthest = squares.into_iter().fold(0.0, larger).sqrt();
        let nearest = larger((farthest - error) * (1.0 - 1e-9) - 2.0 * ball.radius, 0.0);
        assert!(!entries.is_empty(), "the nearest primitive is a candidate");
        Candidates { entries, nearest, reach: kept_reach, bounds: Some(*part) }
    }
}
