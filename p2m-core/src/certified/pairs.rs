//! Certified pairs: the nearest of several pairs of primitives in real arithmetic.

use super::rational::Square;
use super::rounded::RoundedDistance;
use crate::kernel::vector::V3;
use crate::pair::{Hull, NearestPair, nearest_of_hulls};
use crate::{PrimitiveId, Real};

/// A pair of primitives that may be nearest.
pub(crate) struct PairCandidate {
    /// The ids of the primitives.
    pub(crate) ids: [PrimitiveId; 2],
    /// The vertices of both primitives.
    pub(crate) hulls: [Hull; 2],
    /// The nearest points, computed by the kernel.
    pub(crate) pair: NearestPair,
}

/// Returns the nearest of several pairs, which may be in any order. It is `None` if there is none, or if the nearest
/// one is farther than the limit. Once `goes_on` returns `false`, the remaining pairs are ignored.
///
/// # Complexity
/// It takes about ten microseconds per pair that does not intersect, in big integers.
pub(crate) fn decide_pairs<T: Real>(
    candidates: &[PairCandidate],
    limit: T,
    goes_on: &dyn Fn() -> bool,
) -> Option<(usize, RoundedDistance)> {
    let touching = candidates.iter().enumerate().filter(|(_, one)| one.pair.is_intersecting);
    if let Some((winner, _)) = touching.min_by_key(|(_, one)| one.ids) {
        return Some((winner, RoundedDistance { nearest: 0.0, lower: 0.0 }));
    }
    let square = |one: &PairCandidate| Square::between(one.hulls[0].vertices(), one.hulls[1].vertices());
    let all = candidates.iter().take_while(|_| goes_on()).map(square).enumerate();
    let (winner, least) = all.min_by(|(i, a), (j, b)| a.cmp(b).then(candidates[*i].ids.cmp(&candidates[*j].ids)))?;
    if limit < T::INFINITY && least.cmp(&Square::from_length(limit.to_f64())).is_gt() {
        return None;
    }
    Some((winner, least.distance()))
}

/// Returns the true distance between the convex hulls of two sets of points, rounded to the nearest f64.
pub(crate) fn true_distance(a: &[V3], b: &[V3]) -> f64 {
    let pair = nearest_of_hulls(a, b, f64::INFINITY).expect("no key exceeds infinity");
    if pair.is_intersecting { 0.0 } else { Square::between(a, b).distance().nearest }
}
