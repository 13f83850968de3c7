//! What a query asks and gets, and the running best that decides everything between them.
//!
//! # Approximation
//!
//! Two options give up exactness: a relative error (epsilon) and a max_visits of visits.
//! A search that honours them *holds* a primitive as soon as it knows from both sides how far it is, before it is evaluated:
//! it is evaluated first in the end, so the answer is never farther than what is held. Parts of the scene whose lower bound
//! exceeds the distance held / (1 + epsilon) are left out, and parts that a search does not come to are left out with the
//! smallest of their bounds ([`Best::forgo`]). So the answer's lower bound is certified whatever was asked, and the error is
//! known to the caller without another query (docs/proofs/accuracy.md, N7).

use crate::real::from_f64_array;
use crate::{Feature, Key, Primitive, PrimitiveId, PrimitiveSet, Projection, Real};
use nalgebra::Point3;
use std::marker::PhantomData;

/// What a query may ask beyond the closest point. Built from the default by the `with_` methods.
///
/// ```
/// use p2m_core::QueryOptions;
///
/// let options = QueryOptions::default().with_max_distance(2.5f64).with_epsilon(0.01);
/// assert_eq!(options.max_distance, 2.5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct QueryOptions<T: Real> {
    /// Answers farther than this are no answers; the bound is inclusive. Unlimited by default. With a negative or NaN
    /// bound nothing is near enough.
    pub max_distance: T,
    /// A primitive that is probably near: that of the previous answer along a path, say. It changes the work, never an exact
    /// answer. Ignored if there is no such primitive.
    pub hint: Option<PrimitiveId>,
    /// The reported distance may exceed the true one by this fraction of it: reported <= (1 + epsilon) true, apart
    /// from rounding (contract N7). 0 by default; a negative or NaN value counts as 0.
    pub epsilon: T,
    /// So many nodes and packets may be visited, and those that it takes to find any answer; then the best one found so
    /// far is the answer. The interception indexes visit the sites on the way to a cell and the packets of its list: with
    /// a limit of 0 the answer is what the cell itself tells. Unlimited by default. If there is a largest distance as
    /// well, `None` says that nothing was found within it, not that there is nothing. [`BruteForce`](crate::BruteForce), indexes over trees of other
    /// crates have no use for it: their answers are exact.
    pub max_visits: u32,
}

impl<T: Real> Default for QueryOptions<T> {
    fn default() -> Self {
        Self { max_distance: T::INFINITY, hint: None, epsilon: T::zero(), max_visits: u32::MAX }
    }
}

impl<T: Real> QueryOptions<T> {
    /// With answers up to this distance only.
    #[must_use]
    pub fn with_max_distance(self, max_distance: T) -> Self {
        Self { max_distance, ..self }
    }
    /// With a primitive to look at first.
    #[must_use]
    pub fn with_hint(self, hint: PrimitiveId) -> Self {
        Self { hint: Some(hint), ..self }
    }
    /// With a relative error that is good enough.
    #[must_use]
    pub fn with_epsilon(self, epsilon: T) -> Self {
        Self { epsilon, ..self }
    }
    /// With so many visits at most.
    #[must_use]
    pub fn with_max_visits(self, max_visits: u32) -> Self {
        Self { max_visits, ..self }
    }
    /// Whether the answer may differ from the exact one.
    #[must_use]
    pub fn is_approximate(&self) -> bool {
        self.epsilon > T::zero() || self.max_visits < u32::MAX
    }
}

/// The answer to a query. Lengths are in units of the scene.
///
/// The distance has no sign: a place inside of a closed mesh has its distance from the surface. It is inside where a ray
/// from it crosses the surface an odd number of times ([`RayQuery::crossings`](crate::RayQuery::crossings)); crate
/// p2m-mixed has signed distances.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Closest<T: Real> {
    /// The closest point. It lies in the primitive's box, on a vertex verbatim; how ill-conditioned it is depends on
    /// the scene, not on the library.
    pub point: Point3<T>,
    /// Its distance, from the unrounded offset rather than from `point`.
    pub distance: T,
    /// Certified: the true distance of the scene is not below this. Exact answers: `distance` less its error bound.
    pub lower_bound: T,
    /// The primitive that holds it; among equally near ones (equal keys) the lowest id.
    pub primitive: PrimitiveId,
    /// The part of that primitive that holds it.
    pub feature: Feature,
    /// Weights of that primitive's vertices in their order (three of a triangle, two of a segment, one of a point), >= 0,
    /// adding up to 1 within 4 u; the others are 0. Vertices in these parts add up to `point` within 4 u |query| + 8 u M and 8 u of
    /// the largest coordinate of a vertex (observed, `p2m_testkit::contract`).
    pub barycentric: [T; 3],
}

/// What a search reports to: it says how far is still of interest and takes candidates.
///
/// [`Best`] keeps the single closest one. All primitives within a distance, the k nearest ones and filters by id are
/// other collectors for the same traversals.
pub trait Collector {
    /// The square above which a lower bound is of no interest: skip what lies strictly above it, keep equals. It never
    /// rises during a search.
    fn prune_above(&self) -> f64;

    /// The same if some primitive is known to have a key of at most `square`, without being offered yet. A collector
    /// that looks for the nearest primitive alone may then skip more; others ignore it, as by default.
    #[inline(always)]
    fn prune_given(&self, square: f64) -> f64 {
        let _ = square;
        self.prune_above()
    }

    /// The same for the primitive `id`: a collector that would refuse it at equality says so. As
    /// [`prune_above`](Self::prune_above) by default.
    #[inline(always)]
    fn prune_above_for(&self, id: PrimitiveId) -> f64 {
        let _ = id;
        self.prune_above()
    }

    /// Whether a collector of the nearest primitive wants all that are as near but for rounding as well: everything that filters leave is
    /// then evaluated and offered. Not by default.
    #[inline(always)]
    fn wants_near_ties(&self) -> bool {
        false
    }

    /// Whether it may be content with less than everything that it could want: searches then ask it what follows from a
    /// primitive that they [hold](Self::prune_held), and whether they may end. Not by default.
    #[inline(always)]
    fn is_approximate(&self) -> bool {
        false
    }

    /// As [`prune_given`](Self::prune_given) if that primitive is certain to be offered, or one that is as near: a
    /// collector that is content with less than the nearest may then skip still more.
    #[inline(always)]
    fn prune_held(&self, square: f64) -> f64 {
        self.prune_given(square)
    }

    /// Whether the search may end; `holds` says whether it holds some primitive that is certain to be offered, or one that is as near.
    /// What was not searched is to be [given up](Self::forgo).
    #[inline(always)]
    fn is_content(&self, holds: bool) -> bool {
        let _ = holds;
        false
    }

    /// A part of the scene is not searched although it may hold what is wanted: the squares of all distances to it are at least
    /// `square`, but for 16 u.
    #[inline(always)]
    fn forgo(&mut self, square: f64) {
        let _ = square;
    }

    /// Whether only the nearest primitive counts, and ties with it: a candidate that is farther than some primitive
    /// need not be offered. Not by default.
    #[inline(always)]
    fn is_nearest_only(&self) -> bool {
        false
    }

    /// Takes a candidate.
    fn offer(&mut self, id: PrimitiveId, projection: Projection);

    /// Called once for every node of a tree that is visited, and for every site on the way to a
    /// Voronoi cell. For those who count, and those who keep a max_visits.
    #[inline(always)]
    fn visit_node(&mut self) {}

    /// Called once for every packet of primitives that is filtered; likewise.
    #[inline(always)]
    fn visit_packet(&mut self) {}
}

/// The running minimum of a search. Radius, ties, epsilon and lower bound are decided here and nowhere else.
#[derive(Clone, Debug)]
pub struct Best<T: Real> {
    hint: Option<PrimitiveId>,
    minimum: BestF64,
    scalar: PhantomData<T>,
}

/// The same in f64, whatever the scalar of the scene: a search is compiled once for both.
#[derive(Clone, Debug)]
pub struct BestF64 {
    /// The largest distance within the radius.
    radius: f64,
    /// (1 + epsilon)^-2, rounded down
    shrink: f64,
    /// The square of the radius, rounded up; from the first answer within it, the key times `shrink`.
    prune: f64,
    best: Option<(PrimitiveId, Projection)>,
    key: Key,
    /// The smallest `distance - error` among all candidates, or bound of what was given up.
    certified: f64,
    /// Whether the answer may be another one.
    approximate: bool,
    /// QueryCost that are left, if there is a max_visits.
    max_visits: u32,
}

/// Relative errors of a few roundings are absorbed by this factor: 1 + 16 u of f64.
const ROUND_UP: f64 = 1.0 + 8.0 * f64::EPSILON;
const ROUND_DOWN: f64 = 1.0 - 8.0 * f64::EPSILON;
/// 2^100
const LARGEST_FACTOR: f64 = 1.267_650_600_228_229_4e30;

impl<T: Real> Best<T> {
    /// Nothing found yet.
    #[must_use]
    pub fn new(options: &QueryOptions<T>) -> Self {
        let epsilon = options.epsilon.to_f64();
        let factor = 1.0 + if epsilon > 0.0 { epsilon } else { 0.0 };
        // Beyond 2^100 any answer will do, and squares stay in range.
        let factor = if factor > LARGEST_FACTOR { LARGEST_FACTOR } else { factor };
        let shrink = if factor > 1.0 { ROUND_DOWN / (factor * factor) } else { 1.0 };
        // A distance counts as it will be reported, so somewhat beyond the radius; nothing is within NaN.
        let radius = options.max_distance.to_f64_above();
        let prune = square_within(radius);
        let minimum = BestF64 {
            radius,
            shrink,
            prune,
            best: None,
            key: Key::INFINITY,
            certified: f64::INFINITY,
            approximate: options.is_approximate(),
            max_visits: options.max_visits,
        };
        Self { hint: options.hint, minimum, scalar: PhantomData }
    }

    /// Offers the primitive to look at first, if the caller named one and the set has it.
    pub fn offer_hint<S: PrimitiveSet<T> + ?Sized>(&mut self, set: &S, query: &Point3<T>) {
        if let Some(id) = self.hint.filter(|id| id.index() < set.len()) {
            self.offer(id, set.get(id).project(query));
        }
    }

    /// A part of the scene will not be searched although it may hold the answer; `square` is a lower bound as for
    /// [`Collector::prune_above`]. The answer is then approximate, and its certified lower bound says so.
    pub fn forgo(&mut self, square: f64) {
        self.minimum.forgo(square);
    }

    /// The nearest point so far, as it was before rounding.
    pub fn nearest_point(&self) -> Option<[f64; 3]> {
        self.minimum.best.as_ref().map(|(_, p)| p.point.coords.into())
    }

    /// What collects for it.
    #[inline(always)]
    pub fn minimum(&mut self) -> &mut BestF64 {
        &mut self.minimum
    }

    /// The answer.
    #[must_use]
    pub fn finish(self) -> Option<Closest<T>> {
        let BestF64 { certified, shrink, best, .. } = self.minimum;
        let (primitive, p) = best?;
        if !self.minimum.within(p.key) {
            return None;
        }
        // What was pruned is farther than the bound it was pruned by, the bound itself being within 5 u on the square.
        let exact = p.key.distance();
        let pruned = exact * shrink.sqrt() * ROUND_DOWN;
        Some(answer(primitive, &p, if certified < pruned { certified } else { pruned }))
    }
}

/// The square above which a lower bound is beyond a radius.
pub fn square_within(radius: f64) -> f64 {
    // Further by what a distance loses in rounding: near zero a smallest subnormal.
    Key::of_offset([radius + f64::from_bits(1), 0.0, 0.0]).square_above() * ROUND_UP
}

/// An answer, of which the distance is not below some bound but for roundings.
pub fn answer<T: Real>(primitive: PrimitiveId, p: &Projection, bound: f64) -> Closest<T> {
    // One smallest subnormal for each rounding near zero; an infinite error leaves nothing to certify.
    let bound = bound * ROUND_DOWN - 2.0 * f64::from_bits(1);
    Closest {
        point: from_f64_array(p.point.coords.into()),
        distance: T::of_f64(p.key.distance()),
        lower_bound: if bound > 0.0 { T::of_f64_below(bound) } else { T::zero() },
        primitive,
        feature: p.feature,
        barycentric: p.barycentric.map(T::of_f64),
    }
}

impl<T: Real> Collector for Best<T> {
    #[inline(always)]
    fn prune_above(&self) -> f64 {
        self.minimum.prune_above()
    }
    #[inline(always)]
    fn prune_given(&self, square: f64) -> f64 {
        self.minimum.prune_given(square)
    }
    #[inline(always)]
    fn prune_above_for(&self, id: PrimitiveId) -> f64 {
        self.minimum.prune_above_for(id)
    }
    #[inline(always)]
    fn is_nearest_only(&self) -> bool {
        self.minimum.is_nearest_only()
    }
    #[inline(always)]
    fn is_approximate(&self) -> bool {
        self.minimum.approximate
    }
    #[inline(always)]
    fn prune_held(&self, square: f64) -> f64 {
        self.minimum.prune_held(square)
    }
    #[inline(always)]
    fn is_content(&self, holds: bool) -> bool {
        self.minimum.is_content(holds)
    }
    #[inline(always)]
    fn forgo(&mut self, square: f64) {
        self.minimum.forgo(square);
    }
    #[inline(always)]
    fn offer(&mut self, id: PrimitiveId, projection: Projection) {
        self.minimum.offer(id, projection);
    }
    #[inline(always)]
    fn visit_node(&mut self) {
        self.minimum.visit_node();
    }
    #[inline(always)]
    fn visit_packet(&mut self) {
        self.minimum.visit_packet();
    }
}

impl BestF64 {
    /// Whether a distance is within the radius, as it will be reported.
    #[inline]
    fn within(&self, key: Key) -> bool {
        key.distance() <= self.radius
    }
}

impl Collector for BestF64 {
    #[inline(always)]
    fn prune_above(&self) -> f64 {
        self.prune
    }

    #[inline(always)]
    fn prune_given(&self, square: f64) -> f64 {
        // Not shrunk by epsilon: that primitive may be beyond the radius, or be left out for a candidate that is a
        // little farther, and what may be left out for a candidate depends on that candidate alone.
        if square < self.prune { square } else { self.prune }
    }

    #[inline(always)]
    fn is_approximate(&self) -> bool {
        self.approximate
    }

    #[inline(always)]
    fn prune_held(&self, square: f64) -> f64 {
        // What is beyond the radius is no answer that others may be compared with.
        let within = square * ROUND_UP < self.radius * self.radius;
        let own = if within { square * self.shrink } else { square };
        if own < self.prune { own } else { self.prune }
    }

    #[inline(always)]
    fn is_content(&self, holds: bool) -> bool {
        // As long as there is nothing, everything is still to be found.
        self.max_visits == 0 && (holds || self.best.is_some())
    }

    #[inline(always)]
    fn visit_node(&mut self) {
        // An exact search makes nothing of it.
        self.max_visits = self.max_visits.saturating_sub(1);
    }

    #[inline(always)]
    fn visit_packet(&mut self) {
        self.max_visits = self.max_visits.saturating_sub(1);
    }

    #[inline(always)]
    fn forgo(&mut self, square: f64) {
        // A bound on a box is at most 5 u too large, and wrong by some subnormals near zero; above the range it is at
        // least its end.
        let square = if square < f64::MAX { square } else { f64::MAX };
        let bound = (square * ROUND_DOWN - 4.0 * f64::from_bits(1)).max(0.0).sqrt();
        if bound < self.certified {
            self.certified = bound;
        }
    }

    #[inline(always)]
    fn prune_above_for(&self, id: PrimitiveId) -> f64 {
        match &self.best {
            // Ties go to the lowest id.
            Some((held, p)) if *held < id && p.key.plain_square() == Some(self.prune) => self.prune.next_down(),
            _ => self.prune,
        }
    }

    #[inline(always)]
    fn is_nearest_only(&self) -> bool {
        true
    }

    #[inline(always)]
    fn offer(&mut self, id: PrimitiveId, projection: Projection) {
        let p = projection;
        // Only a candidate within its error of the certified bound can lower it; the square tells most without a root.
        let reach = self.certified + p.error;
        let beyond = p.key.plain_square().is_some_and(|square| square * ROUND_DOWN > reach * reach);
        if !beyond {
            // A distance above the range is at least its end; an error above the range leaves nothing to certify.
            let distance = if p.key.distance() < f64::MAX { p.key.distance() } else { f64::MAX };
            let bound = if p.error < f64::INFINITY { distance - p.error } else { f64::NEG_INFINITY };
            if bound < self.certified {
                self.certified = bound;
            }
        }
        let closer = p.key < self.key;
        if closer || (p.key == self.key && self.best.is_some_and(|(held, _)| id < held)) {
            self.best = Some((id, p));
            self.key = p.key;
            let square = p.key.square_above() * self.shrink;
            // What is beyond the radius is no answer that others may be compared with.
            if square < self.prune && (self.shrink >= 1.0 || self.within(p.key)) {
                self.prune = square;
            }
        }
    }
}
