//! The decision between candidates, in two stages.

use super::candidate::Candidate;
use super::double_double::Square;
use super::feature::U;
use super::rounded::RoundedDistance;
use super::{feature_certificate, rational};
use crate::kernel::vector::V3;
use crate::pair::project;
use crate::{Feature, Projection};
use std::cmp::Ordering;
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// The arithmetic that decided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum DecidedBy {
    /// Floats with proved bounds on their errors.
    Floats,
    /// Big integers, for some of the candidates or to round the distance.
    Integers,
}

/// The nearest of several candidates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Decision {
    /// The index of the nearest candidate. Exact ties go to the lowest id.
    pub(super) winner: usize,
    /// Its true distance.
    pub(super) distance: RoundedDistance,
    /// The arithmetic that made the decision.
    pub(super) decided_by: DecidedBy,
}

/// Returns the nearest of several candidates, which may be in any order. There is at least one, and their ids differ.
///
/// # Complexity
/// The first stage takes about ten nanoseconds per candidate and fifty to a hundred per distinct feature. The second
/// stage takes about a microsecond per remaining candidate, and more if exponents differ by hundreds.
pub(super) fn decide(query: [f64; 3], candidates: &[Candidate<'_>]) -> Decision {
    decide_fast(query, candidates).unwrap_or_else(|| decide_in_stages(query, candidates))
}

/// Decides by the first stage alone: a running minimum that returns `None` at the first uncertain comparison.
fn decide_fast(query: V3, candidates: &[Candidate<'_>]) -> Option<Decision> {
    let mut winner = 0;
    let mut best: Option<Square> = None;
    for (index, candidate) in candidates.iter().enumerate() {
        if !candidate.is_proved(query) {
            return None;
        }
        let Some(least) = &best else {
            best = Some(candidate.square(query)?);
            continue;
        };
        if candidate.shares_feature(&candidates[winner]) {
            if candidate.id < candidates[winner].id {
                winner = index;
            }
            continue;
        }
        let square = candidate.square(query)?;
        if square.compare(least)? == Ordering::Less {
            (winner, best) = (index, Some(square));
        }
    }
    Some(Decision { winner, distance: best?.distance()?, decided_by: DecidedBy::Floats })
}

/// Candidates that share a proved feature, or a single candidate without a proof.
struct Group {
    /// The index of the candidate with the lowest id.
    index: usize,
    /// Whether the feature of that candidate is proved to contain the nearest point.
    is_proved: bool,
    /// The squared distance of a proved feature, if it is in range.
    square: Option<Square>,
}

/// Decides by both stages. The first stage excludes candidates that are certainly farther than another one, and the
/// second stage decides between the rest.
#[cold]
#[inline(never)]
fn decide_in_stages(query: V3, candidates: &[Candidate<'_>]) -> Decision {
    let groups = groups(query, candidates);
    let least = groups.iter().filter_map(|g| g.square.as_ref()).min_by(|a, b| a.rough().total_cmp(&b.rough()));
    let is_farther = |g: &Group| match (&g.square, least) {
        (Some(square), Some(least)) => square.compare(least) == Some(Ordering::Greater),
        _ => false,
    };
    let remaining: Vec<&Group> = groups.iter().filter(|g| !is_farther(g)).collect();
    if let [Group { index, square: Some(square), .. }] = remaining[..]
        && let Some(distance) = square.distance()
    {
        return Decision { winner: *index, distance, decided_by: DecidedBy::Floats };
    }
    let exact = |group: &Group| {
        let Candidate { id, vertices, feature } = candidates[group.index];
        (rational::Square::new(query, vertices, feature, group.is_proved), id, group.index)
    };
    let nearest = remaining.into_iter().map(exact).min_by(|(a, i, _), (b, j, _)| a.cmp(b).then(i.cmp(j)));
    let (square, _, winner) = nearest.expect("there are candidates, and the least one is not farther than itself");
    Decision { winner, distance: square.distance(), decided_by: DecidedBy::Integers }
}

/// Groups candidates that share a proved feature.
fn groups(query: V3, candidates: &[Candidate<'_>]) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::with_capacity(candidates.len());
    let mut group_of_feature = HashMap::new();
    for (index, candidate) in candidates.iter().enumerate() {
        if !candidate.is_proved(query) {
            groups.push(Group { index, is_proved: false, square: None });
            continue;
        }
        match group_of_feature.entry(candidate.feature_bits()) {
            Entry::Vacant(entry) => {
                entry.insert(groups.len());
                groups.push(Group { index, is_proved: true, square: candidate.square(query) });
            }
            Entry::Occupied(entry) => {
                let group = &mut groups[*entry.get()];
                if candidate.id < candidates[group.index].id {
                    group.index = index;
                }
            }
        }
    }
    groups
}

/// Returns whether the true distance from the query to a primitive of one to three vertices is at most `radius`. The
/// query and the vertices are finite. The result is `false` for a negative radius and for NaN, and `true` for an
/// infinite one.
///
/// # Complexity
/// It takes as long as the kernel, unless the distance of the kernel is within its error of the radius.
pub(super) fn is_within(query: [f64; 3], vertices: &[[f64; 3]], radius: f64) -> bool {
    if !radius.is_finite() {
        return radius > 0.0;
    }
    if radius < 0.0 {
        return false;
    }
    let nearest = project(query, vertices, f64::INFINITY).expect("no key exceeds infinity");
    is_within_by_kernel(&nearest, radius)
        .unwrap_or_else(|| is_within_in_stages(query, vertices, nearest.feature, radius))
}

/// Compares the distance of the kernel with the radius, or returns `None` if its error, which is less than its bound
/// and one smallest subnormal, leaves that open.
fn is_within_by_kernel(nearest: &Projection, radius: f64) -> Option<bool> {
    /// A factor that covers the rounding of this bound and of the difference that is compared with it.
    const SLACK: f64 = 1.0 + 8.0 * U;
    let distance = nearest.key.distance();
    let gap = (distance - radius).abs();
    let is_certain = distance < f64::INFINITY && gap > nearest.error * SLACK + 4.0 * f64::from_bits(1);
    is_certain.then_some(distance < radius)
}

#[cold]
#[inline(never)]
fn is_within_in_stages(query: V3, vertices: &[V3], feature: Feature, radius: f64) -> bool {
    let is_proved = feature_certificate::is_proved(query, vertices, feature);
    let fast = || Square::new(query, vertices, feature)?.compare(&Square::from_length(radius)?);
    let order = if is_proved { fast() } else { None };
    let exact =
        || rational::Square::new(query, vertices, feature, is_proved).cmp(&rational::Square::from_length(radius));
    order.unwrap_or_else(exact) != Ordering::Greater
}
