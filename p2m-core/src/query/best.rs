//! The collector of the nearest primitive.

use super::answer::{ROUND_DOWN, ROUND_UP, answer, lower_bound, square_within};
use super::closest::Closest;
use super::collector::Collector;
use super::options::QueryOptions;
use crate::kernel::side_by_side::LaneResults;
use crate::{Key, Primitive, PrimitiveId, PrimitiveSet, Projection, Real};
use nalgebra::Point3;
use std::marker::PhantomData;

/// The running minimum of a search. It alone decides the radius, ties, epsilon and the certified lower bound.
#[derive(Clone, Debug)]
pub struct Best<T: Real> {
    hint: Option<PrimitiveId>,
    minimum: BestF64,
    scalar: PhantomData<T>,
}

/// The running minimum in f64. It serves both scalar types of scenes, so that a search is compiled once.
#[derive(Clone, Debug)]
pub struct BestF64 {
    /// The largest f64 distance that is reported as within the radius.
    radius: f64,
    /// The factor (1 + epsilon)^-2, rounded down.
    shrink: f64,
    /// The square above which lower bounds are pruned. At first it is the square of the radius, rounded up. Once an
    /// answer within the radius is known, it is the key times `shrink`.
    prune: f64,
    /// The candidate with the least key.
    best: Option<(PrimitiveId, Projection)>,
    /// The key of `best`, or infinity.
    key: Key,
    /// The smallest `distance - error` of all candidates and the smallest bound of all skipped parts, whichever is
    /// less.
    certified: f64,
    /// Whether the options allow an answer other than the exact one.
    approximate: bool,
    /// The number of visited nodes and packets from which on an approximate search may stop.
    max_visits: u32,
    /// The numbers of visited nodes, filtered packets and offered primitives.
    counts: [u32; 3],
}

/// The largest factor 1 + epsilon, 2^100; its square stays in range, and any answer suffices beyond it.
const MAX_ERROR_FACTOR: f64 = 1.267_650_600_228_229_4e30;

impl<T: Real> Best<T> {
    /// Creates a running minimum without a candidate.
    #[must_use]
    pub fn new(options: &QueryOptions<T>) -> Self {
        let epsilon = options.epsilon.to_f64();
        let factor = 1.0 + if epsilon > 0.0 { epsilon } else { 0.0 };
        let factor = if factor > MAX_ERROR_FACTOR { MAX_ERROR_FACTOR } else { factor };
        let shrink = if factor > 1.0 { ROUND_DOWN / (factor * factor) } else { 1.0 };
        // Distances are compared as they are reported, so some distances beyond the radius round into it. Nothing is
        // within a NaN radius.
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
            counts: [0; 3],
        };
        Self { hint: options.hint, minimum, scalar: PhantomData }
    }

    /// Returns the hint of the options, for an index without a [`PrimitiveSet`]. The scene may lack that primitive.
    #[must_use]
    pub fn hint(&self) -> Option<PrimitiveId> {
        self.hint
    }

    /// Offers the primitive of the hint, if there is a hint and the set has that primitive.
    pub fn offer_hint<S: PrimitiveSet<T> + ?Sized>(&mut self, set: &S, query: &Point3<T>) {
        if let Some(id) = self.hint.filter(|id| id.index() < set.len()) {
            self.offer(id, set.get(id).project(query));
        }
    }

    /// Reports that a part of the scene will be skipped although it could contain the answer. `square` is a lower bound
    /// as for [`Collector::prune_above`]. The certified lower bound of the answer takes it into account.
    pub fn record_skipped(&mut self, square: f64) {
        self.minimum.record_skipped(square);
    }

    /// Returns the nearest point so far, before rounding to the scalar of the scene.
    pub fn nearest_point(&self) -> Option<[f64; 3]> {
        self.minimum.best.as_ref().map(|(_, p)| p.point.coords.into())
    }

    /// Returns the running minimum in f64, for a search that is not generic over the scalar type.
    #[inline(always)]
    pub fn minimum(&mut self) -> &mut BestF64 {
        &mut self.minimum
    }

    /// Returns the running minimum in f64 by reference, without the hint.
    #[inline(always)]
    #[doc(hidden)]
    pub fn minimum_ref(&self) -> &BestF64 {
        &self.minimum
    }

    /// Returns the numbers of nodes, packets and primitives of the search so far.
    #[must_use]
    pub fn counts(&self) -> [usize; 3] {
        self.minimum.counts.map(|count| count as usize)
    }

    /// Returns the answer, or `None` if no candidate was within the radius.
    #[must_use]
    pub fn finish(self) -> Option<Closest<T>> {
        self.minimum.finish()
    }
}

impl<T: Real> Collector for Best<T> {
    forward_methods!(minimum, [#[inline(always)]], {
        fn prune_above(self: &Self) -> f64;
        fn prune_given_upper_bound(self: &Self, square: f64) -> f64;
        fn prune_given_incumbent(self: &Self, square: f64) -> f64;
        fn prune_above_for_id(self: &Self, id: PrimitiveId) -> f64;
        fn is_single_nearest(self: &Self) -> bool;
        fn keeps_near_ties(self: &Self) -> bool;
        fn near_tie_slack(self: &Self) -> f64;
        fn is_approximate(self: &Self) -> bool;
        fn may_stop(self: &Self, has_incumbent: bool) -> bool;
        fn record_skipped(self: &mut Self, square: f64);
        fn offer(self: &mut Self, id: PrimitiveId, projection: Projection);
        fn visit_node(self: &mut Self);
        fn visit_packet(self: &mut Self);
    });
}

impl BestF64 {
    /// Returns the answer, or `None` if no candidate was within the radius.
    #[must_use]
    pub fn finish<T: Real>(&self) -> Option<Closest<T>> {
        let Self { certified, shrink, best, .. } = self;
        let (primitive, p) = best.as_ref()?;
        if !self.is_within_radius(p.key) {
            return None;
        }
        // Pruned parts are farther than the limit that they exceeded, whose square is exact to 5 u.
        let exact = p.key.distance();
        let pruned = exact * shrink.sqrt() * ROUND_DOWN;
        Some(answer(*primitive, p, if *certified < pruned { *certified } else { pruned }))
    }

    /// Returns a lower bound on the distances of all primitives if there is no answer. It is infinite if there are no
    /// primitives.
    pub(crate) fn lower_bound_without_answer<T: Real>(&self) -> T {
        // Parts beyond the radius were pruned by a square that is exact to 5 u.
        let bound = self.certified.min(self.radius * ROUND_DOWN);
        if bound < f64::INFINITY { lower_bound(bound) } else { T::INFINITY }
    }

    /// Takes the candidate in a lane, unless the single kernel has to compute it. Returns whether it was taken. For an
    /// exact search the effect is that of [`offer`](Collector::offer), but the projection is computed only if the
    /// candidate is the best one so far.
    #[inline(always)]
    #[allow(clippy::float_cmp, reason = "ties are equality of bits")]
    pub fn offer_lane(&mut self, id: PrimitiveId, found: &LaneResults, lane: usize) -> bool {
        let Some((square, lower_bound)) = found.square_and_lower_bound(lane) else { return false };
        self.certified = if lower_bound < self.certified { lower_bound } else { self.certified };
        let best_square = self.key.square_above();
        if (square < best_square || (square == best_square && self.best.is_some_and(|(best, _)| id < best)))
            && let Some(projection) = found.projection(lane)
        {
            self.offer(id, projection);
        }
        true
    }

    /// Returns the distance and the primitive of the answer, or `None` if no candidate was within the radius.
    #[inline]
    #[must_use]
    pub fn distance_and_primitive(&self) -> Option<(f64, PrimitiveId)> {
        let (primitive, p) = self.best.as_ref()?;
        let distance = p.key.distance();
        (distance <= self.radius).then_some((distance, *primitive))
    }

    /// Returns whether a distance, as it will be reported, is within the radius.
    #[inline]
    fn is_within_radius(&self, key: Key) -> bool {
        key.distance() <= self.radius
    }
}

impl Collector for BestF64 {
    #[inline(always)]
    fn prune_above(&self) -> f64 {
        self.prune
    }

    #[inline(always)]
    fn prune_given_upper_bound(&self, square: f64) -> f64 {
        // Epsilon does not shrink this bound. Its primitive may be beyond the radius, or be skipped in favour of a
        // candidate that is slightly farther, and only that candidate determines which parts may be skipped.
        if square < self.prune { square } else { self.prune }
    }

    #[inline(always)]
    fn is_approximate(&self) -> bool {
        self.approximate
    }

    #[inline(always)]
    fn prune_given_incumbent(&self, square: f64) -> f64 {
        // An incumbent beyond the radius is not an answer, so epsilon does not apply to it.
        let is_within = square * ROUND_UP < self.radius * self.radius;
        let shrunk = if is_within { square * self.shrink } else { square };
        if shrunk < self.prune { shrunk } else { self.prune }
    }

    #[inline(always)]
    fn may_stop(&self, has_incumbent: bool) -> bool {
        // A search without a candidate at a finite distance goes on, however many nodes and packets it has visited.
        self.counts[0].saturating_add(self.counts[1]) >= self.max_visits
            && (has_incumbent || self.key.distance() < f64::INFINITY)
    }

    #[inline(always)]
    fn visit_node(&mut self) {
        self.counts[0] = self.counts[0].wrapping_add(1);
    }

    #[inline(always)]
    fn visit_packet(&mut self) {
        self.counts[1] = self.counts[1].wrapping_add(1);
    }

    #[inline(always)]
    fn record_skipped(&mut self, square: f64) {
        // The bound of a box is at most 5 u too large, and wrong by a few subnormals near zero. A bound above the range
        // of f64 is replaced by the end of the range.
        let square = if square < f64::MAX { square } else { f64::MAX };
        let bound = (square * ROUND_DOWN - 4.0 * f64::from_bits(1)).max(0.0).sqrt();
        if bound < self.certified {
            self.certified = bound;
        }
    }

    #[inline(always)]
    fn prune_above_for_id(&self, id: PrimitiveId) -> f64 {
        match &self.best {
            // Ties go to the lowest id, so a higher id has to be strictly nearer.
            Some((best, p)) if *best < id && p.key.plain_square() == Some(self.prune) => self.prune.next_down(),
            _ => self.prune,
        }
    }

    #[inline(always)]
    fn is_single_nearest(&self) -> bool {
        true
    }

    #[inline(always)]
    fn has_inlined_filters(&self) -> bool {
        true
    }

    #[inline(always)]
    fn offer(&mut self, id: PrimitiveId, projection: Projection) {
        self.counts[2] = self.counts[2].wrapping_add(1);
        let p = projection;
        // Only a candidate within its error of the certified bound can lower that bound. In most cases its square
        // decides this without a square root.
        let limit = self.certified + p.error;
        let is_beyond = p.key.plain_square().is_some_and(|square| square * ROUND_DOWN > limit * limit);
        if !is_beyond {
            // A distance above the range of f64 is replaced by the end of the range. An error above the range leaves
            // no lower bound.
            let distance = if p.key.distance() < f64::MAX { p.key.distance() } else { f64::MAX };
            let bound = if p.error < f64::INFINITY { distance - p.error } else { f64::NEG_INFINITY };
            if bound < self.certified {
                self.certified = bound;
            }
        }
        let is_closer = p.key < self.key;
        if is_closer || (p.key == self.key && self.best.is_some_and(|(best, _)| id < best)) {
            self.best = Some((id, p));
            self.key = p.key;
            let square = p.key.square_above() * self.shrink;
            // A candidate beyond the radius is not an answer, so epsilon does not apply to it.
            if square < self.prune && (self.shrink >= 1.0 || self.is_within_radius(p.key)) {
                self.prune = square;
            }
        }
    }
}
