//! Which of some primitives is nearest, proved, and how far it is, rounded once.
//!
//! The kernel errs by a few u M, M being the largest distance from the query to a vertex: where two primitives are nearer
//! than that to being equally near it may name the wrong one, and at distances about u M it may have no digit right.
//! Contract N8 asks for more. What is answered here is the truth of the real numbers that the floats are:
//!
//! - the winner is nearest, among exactly equally near ones the one with the lowest id;
//! - its distance is the true one, rounded to the nearest f64 (to the even one between two), infinite beyond all of
//!   them: an error of half a unit in the last place, in both stages;
//! - the lower bound is not above the true distance, and at most one unit in the last place below what is reported.
//!
//! All finite input is valid. A degenerate primitive is the set that its vertices span.
//!
//! # Stages
//!
//! 1. The kernel says which feature of a primitive is nearest; [`feature_certificate`] proves it by signs that are certain in f64, or
//!    in double-double. The squared distance of the feature follows in double-double with a bound on its error
//!    ([`double_double`]): about 2^-100 of it, unless the query is very near. Candidates whose nearest features are proved to be
//!    the same vertex, edge or face are equally near, whatever rounding says: it is computed once.
//! 2. Integers of any length ([`rational`]) decide between those that are not told apart by then, find the feature where
//!    the claim was wrong or not to be proved, and round the distance where the first stage cannot tell how.
//!
//! What the kernel says changes the work, never the answer: a wrong claim fails to be proved.

mod double_double;
mod feature_certificate;
mod query;
mod rational;
#[cfg(test)]
mod tests;

pub use query::{CertifiedQuery, CertifyError, shape_of};

use crate::kernel::vector::V3;
use crate::kernel::{Nearest, triangle};
use crate::{Feature, PrimitiveId};
use std::cmp::Ordering;
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// The unit roundoff of f64.
const U: f64 = f64::EPSILON / 2.0;

/// A primitive that may be nearest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Candidate<'a> {
    pub(crate) id: PrimitiveId,
    /// One of a point, two of a segment, three of a triangle; all finite.
    pub(crate) vertices: &'a [[f64; 3]],
    /// What holds the nearest point, as far as the kernel can tell.
    pub(crate) feature: Feature,
}

/// What decided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stage {
    /// Floats with proved bounds on their errors.
    Fast,
    /// Integers of any length, for some of the candidates or for the rounding of the distance.
    Exact,
}

/// The nearest of some candidates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Decision {
    /// Its place in the slice; the lowest id if several are exactly equally near.
    pub(crate) winner: usize,
    /// The true distance, rounded to the nearest f64.
    pub(crate) distance: f64,
    /// Not above the true distance, and not below the f64 before `distance`.
    pub(crate) lower: f64,
    pub(crate) stage: Stage,
}

/// A distance as it is reported.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Rounded {
    /// To the nearest f64.
    nearest: f64,
    /// Not above it.
    lower: f64,
}

impl Rounded {
    fn decide(self, winner: usize, stage: Stage) -> Decision {
        Decision { winner, distance: self.nearest, lower: self.lower, stage }
    }
}

/// The two ends of edge i of a primitive.
fn ends(i: u8, vertices: &[V3]) -> [V3; 2] {
    let i = usize::from(i);
    [vertices[i], vertices[(i + 1) % vertices.len()]]
}

/// Whether a primitive of so many vertices has such a feature.
fn exists(feature: Feature, count: usize) -> bool {
    match feature {
        Feature::Vertex(i) => usize::from(i) < count,
        Feature::Edge(i) => usize::from(i) + 1 < count || count == 3 && i == 2,
        Feature::Face => count == 3,
    }
}

impl Candidate<'_> {
    /// Whether the features of two candidates, both proved to hold their nearest points, are the same set of points.
    ///
    /// -0 is 0. The vertices of a feature that is proved are distinct, so it is enough to find those of one among
    /// those of the other.
    #[allow(clippy::float_cmp, reason = "the same vertices, not near ones")]
    fn shares_feature(&self, other: &Self) -> bool {
        match (self.feature, other.feature) {
            (Feature::Vertex(i), Feature::Vertex(j)) => self.vertices[usize::from(i)] == other.vertices[usize::from(j)],
            (Feature::Edge(i), Feature::Edge(j)) => {
                let ([a, b], [c, d]) = (ends(i, self.vertices), ends(j, other.vertices));
                a == c && b == d || a == d && b == c
            }
            (Feature::Face, Feature::Face) => self.vertices.iter().all(|v| other.vertices.contains(v)),
            _ => false,
        }
    }

    /// The vertices of the feature in an order of their own: the same for two proved candidates that share their feature.
    fn feature_bits(&self) -> [[u64; 3]; 3] {
        let vertices = self.vertices;
        // -0 becomes 0; what is left over is no finite coordinate.
        let bits = |v: V3| v.map(|x| (x + 0.0).to_bits());
        let none = [u64::MAX; 3];
        let mut all = match self.feature {
            Feature::Vertex(i) => [bits(vertices[usize::from(i)]), none, none],
            Feature::Edge(i) => {
                let [a, b] = ends(i, vertices);
                [bits(a), bits(b), none]
            }
            Feature::Face => std::array::from_fn(|i| bits(vertices[i])),
        };
        all.sort_unstable();
        all
    }

    fn is_proved(&self, query: V3) -> bool {
        feature_certificate::is_proved(query, self.vertices, self.feature)
    }

    fn square(&self, query: V3) -> Option<double_double::Square> {
        double_double::Square::new(query, self.vertices, self.feature)
    }
}

/// Decides between candidates, in any order, of which there is at least one; their ids differ.
///
/// # Complexity
/// Some ten nanoseconds for each candidate and fifty to a hundred for each distinct feature; in the second stage about a
/// microsecond for each candidate that is left, and more where exponents differ by hundreds.
pub(crate) fn decide(query: [f64; 3], candidates: &[Candidate<'_>]) -> Decision {
    decide_fast(query, candidates).unwrap_or_else(|| decide_closely(query, candidates))
}

/// The first stage on its own: a running minimum that gives up at the first doubt.
fn decide_fast(query: V3, candidates: &[Candidate<'_>]) -> Option<Decision> {
    let mut winner = 0;
    let mut best: Option<double_double::Square> = None;
    for (place, candidate) in candidates.iter().enumerate() {
        if !candidate.is_proved(query) {
            return None;
        }
        let Some(least) = &best else {
            best = Some(candidate.square(query)?);
            continue;
        };
        if candidate.shares_feature(&candidates[winner]) {
            if candidate.id < candidates[winner].id {
                winner = place;
            }
            continue;
        }
        let square = candidate.square(query)?;
        if square.compare(least)? == Ordering::Less {
            (winner, best) = (place, Some(square));
        }
    }
    Some(best?.distance()?.decide(winner, Stage::Fast))
}

/// Candidates with the same nearest feature, or one of which that is not proved.
struct Group {
    /// Of the lowest id.
    place: usize,
    /// Whether the feature of that candidate is proved to hold the nearest point.
    proved: bool,
    square: Option<double_double::Square>,
}

/// Both stages: the first leaves out what is certainly farther than another one, the second decides between the rest.
#[cold]
#[inline(never)]
fn decide_closely(query: V3, candidates: &[Candidate<'_>]) -> Decision {
    let groups = groups(query, candidates);
    let least = groups.iter().filter_map(|g| g.square.as_ref()).min_by(|a, b| a.rough().total_cmp(&b.rough()));
    let is_farther = |g: &Group| match (&g.square, least) {
        (Some(square), Some(least)) => square.compare(least) == Some(Ordering::Greater),
        _ => false,
    };
    let left: Vec<&Group> = groups.iter().filter(|g| !is_farther(g)).collect();
    if let [Group { place, square: Some(square), .. }] = left[..]
        && let Some(distance) = square.distance()
    {
        return distance.decide(*place, Stage::Fast);
    }
    let exact = |group: &Group| {
        let Candidate { id, vertices, feature } = candidates[group.place];
        (rational::Square::new(query, vertices, feature, group.proved), id, group.place)
    };
    let nearest = left.into_iter().map(exact).min_by(|(a, i, _), (b, j, _)| a.cmp(b).then(i.cmp(j)));
    let (square, _, winner) = nearest.expect("there are candidates, and the least one is not farther than itself");
    square.distance().decide(winner, Stage::Exact)
}

fn groups(query: V3, candidates: &[Candidate<'_>]) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::with_capacity(candidates.len());
    let mut known = HashMap::new();
    for (place, candidate) in candidates.iter().enumerate() {
        if !candidate.is_proved(query) {
            groups.push(Group { place, proved: false, square: None });
            continue;
        }
        match known.entry(candidate.feature_bits()) {
            Entry::Vacant(entry) => {
                entry.insert(groups.len());
                groups.push(Group { place, proved: true, square: candidate.square(query) });
            }
            Entry::Occupied(entry) => {
                let group = &mut groups[*entry.get()];
                if candidate.id < candidates[group.place].id {
                    group.place = place;
                }
            }
        }
    }
    groups
}

/// Whether the true distance from the query to a primitive of one to three vertices is at most `radius`; not for one that
/// is negative or NaN, always for an infinite one. The rest is finite.
///
/// # Complexity
/// As the kernel, unless its distance is within its error of the radius.
pub(crate) fn is_within(query: [f64; 3], vertices: &[[f64; 3]], radius: f64) -> bool {
    if !radius.is_finite() {
        return radius > 0.0;
    }
    if radius < 0.0 {
        return false;
    }
    let nearest = kernel(query, vertices);
    within_by_kernel(&nearest, radius).unwrap_or_else(|| within_closely(query, vertices, nearest.feature, radius))
}

/// From the distance of the kernel, which errs by less than its bound and one smallest subnormal.
fn within_by_kernel(nearest: &Nearest, radius: f64) -> Option<bool> {
    /// For the rounding of this bound and of the difference that is compared with it.
    const SLACK: f64 = 1.0 + 8.0 * U;
    let distance = nearest.key.distance();
    let gap = (distance - radius).abs();
    let is_certain = distance < f64::INFINITY && gap > nearest.error() * SLACK + 4.0 * f64::from_bits(1);
    is_certain.then_some(distance < radius)
}

#[cold]
#[inline(never)]
fn within_closely(query: V3, vertices: &[V3], feature: Feature, radius: f64) -> bool {
    let proved = feature_certificate::is_proved(query, vertices, feature);
    let fast =
        || double_double::Square::new(query, vertices, feature)?.compare(&double_double::Square::of_length(radius)?);
    let order = if proved { fast() } else { None };
    let exact = || rational::Square::new(query, vertices, feature, proved).cmp(&rational::Square::of_length(radius));
    order.unwrap_or_else(exact) != Ordering::Greater
}

/// What the kernel says of a primitive.
fn kernel(query: V3, vertices: &[V3]) -> Nearest {
    let nearest = match *vertices {
        [a] => triangle::point(query, a, f64::INFINITY),
        [a, b] => triangle::segment(query, [a, b], f64::INFINITY),
        [a, b, c] => triangle::triangle(query, [a, b, c], f64::INFINITY),
        _ => unreachable!("one to three vertices"),
    };
    nearest.expect("no key exceeds infinity")
}
