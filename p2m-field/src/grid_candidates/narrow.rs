//! From the candidates of a box to those of a part of it: what no foot of a corner is nearer than at all corners.

use super::groups::{Group, Groups, Is};
use super::lanes::{squares, squares_from_box};
use super::{Candidates, Detail, ERROR, MARGIN, TINY};
use p2m_core::Aabb;
use p2m_core::engine::simd::{Doubles, InstructionSet, SimdKernel};
use p2m_core::engine::vector::{V3, larger, norm_squared, sub};

/// The sphere around a box, for the distances that occur in it.
struct Ball {
    centre: V3,
    radius: f64,
}

/// Above what a few roundings take away.
const ROUND_UP: f64 = 1.0 + 1e-9;

impl Ball {
    /// Around a box.
    fn around([low, high]: [V3; 2]) -> Self {
        let centre = [0, 1, 2].map(|k: usize| low[k] * 0.5 + high[k] * 0.5);
        // The centre may be rounded by an ulp of it.
        let ulp = f64::EPSILON * p2m_core::engine::vector::largest(&[low, high]);
        Self { centre, radius: norm_squared(sub(high, low)).sqrt() * 0.5 * ROUND_UP + 2.0 * ulp }
    }

    /// No place of it is farther than this from a vertex.
    #[inline(always)]
    fn reach(&self, item: Is<'_>) -> f64 {
        let (way, length) = match item {
            Is::One(flat) => (sub(flat.origin, self.centre), flat.length),
            Is::Many(Group { bounds: [low, high], .. }) => {
                let (low, high) = (sub(*low, self.centre), sub(*high, self.centre));
                ([0, 1, 2].map(|k: usize| larger(-low[k], high[k])), 0.0)
            }
        };
        (norm_squared(way).sqrt() + length + self.radius) * ROUND_UP
    }
}

/// Finds the candidates of a part.
pub(crate) struct Narrow<'a> {
    pub(crate) groups: &'a Groups,
    pub(crate) of: &'a Candidates,
    pub(crate) part: &'a Aabb<f64>,
    pub(crate) detail: Detail,
}

/// Groups whose diagonal is less than this part of the diagonal of the box stay together.
const SMALL: f64 = 0.35;

#[inline(always)]
fn squares_from<D: Doubles>(item: Is<'_>, places: &[D; 3], margin: D) -> D {
    match item {
        Is::One(flat) => squares(flat, places, margin),
        Is::Many(group) => squares_from_box(&group.bounds, places),
    }
}

/// Whether no dominator is nearer to all corners.
#[inline(always)]
fn stays<D: Doubles>(squares: D, dominators: &[D; 8]) -> bool {
    let mut stays = true;
    for dominator in dominators {
        stays &= squares.at_most(*dominator) != 0;
    }
    stays
}

impl SimdKernel for Narrow<'_> {
    type Output = Candidates;

    #[inline(always)]
    fn run<I: InstructionSet>(self) -> Candidates {
        let Self { groups, of, part, detail } = self;
        let Some(first) = of.items.first() else {
            return Candidates { items: Vec::new(), nearest: f64::INFINITY, reach: 0.0, part: Some(*part) };
        };
        let ends: [V3; 2] = [part.min.coords.into(), part.max.coords.into()];
        let ball = Ball::around(ends);
        let corners: [[f64; 8]; 3] = std::array::from_fn(|k| std::array::from_fn(|i| ends[i >> k & 1][k]));
        let places = [I::Doubles::load(&corners[0]), I::Doubles::load(&corners[1]), I::Doubles::load(&corners[2])];
        let reach = of.items.iter().map(|item| ball.reach(groups.get(*item)));
        let reach = if of.reach < f64::INFINITY { of.reach } else { reach.fold(0.0, larger) };
        let (error, margin) = (reach * ERROR + TINY, I::Doubles::splat(reach * MARGIN));

        // What is nearest to each corner.
        let mut kept: Vec<I::Doubles> = Vec::with_capacity(of.items.len());
        let mut least = I::Doubles::splat(f64::INFINITY);
        let mut nearest = [*first; 8];
        for &item in &of.items {
            let squares = squares_from(groups.get(item), &places, margin);
            let mut nearer = !least.at_most(squares);
            least = squares.min(least);
            while nearer != 0 {
                nearest[nearer.trailing_zeros() as usize] = item;
                nearer &= nearer - 1;
            }
            kept.push(squares);
        }
        // Their feet, and how far they are from all corners, with room for 4 E and the errors of either side.
        let mut dominators = [I::Doubles::splat(0.0); 8];
        for (j, squares) in dominators.iter_mut().enumerate() {
            let corner: V3 = [corners[0][j], corners[1][j], corners[2][j]];
            let flat = groups.near(nearest[j], corner);
            let foot = flat.foot(corner);
            let mut most = 0.0f64;
            let mut own = [0.0; 8];
            for (i, square) in own.iter_mut().enumerate() {
                let corner = [corners[0][i], corners[1][i], corners[2][i]];
                *square = norm_squared(sub(sub(corner, flat.origin), foot));
                most = larger(*square, most);
            }
            let room = 16.0 * error * most.sqrt() + 64.0 * error * error;
            *squares = I::Doubles::load(&own.map(|square| square + room));
        }
        let small = match detail {
            Detail::Groups => SMALL * SMALL * norm_squared(sub(ends[1], ends[0])),
            Detail::Primitives => -1.0,
        };
        let (mut items, mut own_reach) = (Vec::with_capacity(of.items.len()), 0.0);
        let mut waiting = Vec::new();
        for (&item, &squares) in of.items.iter().zip(&kept) {
            if !stays(squares, &dominators) {
                continue;
            }
            let mut next = Some(item);
            while let Some(item) = next {
                match groups.get(item) {
                    Is::Many(group) if group.squared_diagonal() > small => {
                        for member in group.members() {
                            if stays(squares_from(groups.get(member), &places, margin), &dominators) {
                                waiting.push(member);
                            }
                        }
                    }
                    is => {
                        own_reach = larger(ball.reach(is), own_reach);
                        items.push(item);
                    }
                }
                next = waiting.pop();
            }
        }
        let mut squares = [0.0; 8];
        least.store(&mut squares);
        let farthest = squares.into_iter().fold(0.0, larger).sqrt();
        let nearest = larger((farthest - error) * (1.0 - 1e-9) - 2.0 * ball.radius, 0.0);
        assert!(!items.is_empty(), "one is nearest");
        Candidates { items, nearest, reach: own_reach, part: Some(*part) }
    }
}
