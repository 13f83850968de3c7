//! More than the one closest point: the k nearest primitives, all within a distance, whether there is any, and the
//! closest one of those that a caller wants; and all that may be nearest but for rounding, from which a
//! [certified](crate::CertifiedQuery) answer is chosen.
//!
//! One collector, [`Near`], does all of that, so a backend writes one method and searches are compiled once for all of
//! these questions.

use crate::query::answer::{answer, square_within};
use crate::{Closest, Collector, Key, PrimitiveId, Projection, QueryOptions, Real};
use nalgebra::Point3;
use std::collections::BinaryHeap;
use std::ops::ControlFlow;

/// Questions about what is near, beyond the closest point. A backend writes one method,
/// [`search_near`](Self::search_near).
///
/// Each answer is what [`ClosestPoint`](crate::ClosestPoint) says of that primitive alone, bit for bit, but for
/// [`Closest::lower_bound`], which bounds the distance of that primitive and not of the scene. Distances are compared
/// before rounding, equal ones by ids, and the radius is inclusive, so every backend answers the same. Nothing is near a
/// query that is not finite, nor within a radius that is negative or NaN.
///
/// ```
/// use nalgebra::Point3;
/// use p2m_core::{BruteForce, NearQuery, Point, QueryOptions};
///
/// let index = BruteForce::new([4.0, 1.0, 2.0, 1.0].map(|x| Point::new(Point3::new(x, 0.0, 0.0)))).unwrap();
/// let origin = Point3::origin();
/// let ids = |near: Vec<p2m_core::Closest<f64>>| near.iter().map(|c| c.primitive.index()).collect::<Vec<_>>();
/// assert_eq!(ids(index.k_nearest(&origin, 3, f64::INFINITY)), [1, 3, 2]);
/// assert_eq!(ids(index.all_within(&origin, 1.0)), [1, 3]);
/// assert!(!index.is_any_within(&origin, 0.5));
/// let even = index.closest_point_among(&origin, &QueryOptions::default(), &mut |id| id.index() % 2 == 0);
/// assert_eq!(even.unwrap().primitive.index(), 2);
/// ```
///
/// # Complexity
/// Expected O(log n + k log k) for trees and k answers, and as much for the closest one among some after k that are not
/// wanted; O(n) for brute force. The interception indexes ask their trees: lists know the nearest primitive alone.
pub trait NearQuery<T: Real> {
    /// Offers to `near` every primitive that it could want, each once at most. `query` is finite.
    fn search_near(&self, query: &Point3<T>, near: &mut Near<'_>);

    /// The nearest primitives, at most `k` and none beyond the radius (in units of the scene; infinity for no limit),
    /// nearest first.
    fn k_nearest(&self, query: &Point3<T>, k: usize, radius: T) -> Vec<Closest<T>> {
        let mut near = Near::nearest(k, radius);
        ask(self, query, &mut near);
        near.finish()
    }

    /// All primitives within the radius, nearest first. [`visit_within`](Self::visit_within) needs no memory for them.
    fn all_within(&self, query: &Point3<T>, radius: T) -> Vec<Closest<T>> {
        self.k_nearest(query, usize::MAX, radius)
    }

    /// Calls `visit` for each primitive within the radius, in an order that depends on the backend, until it breaks; whether
    /// it did.
    fn visit_within(
        &self,
        query: &Point3<T>,
        radius: T,
        visit: &mut dyn FnMut(&Closest<T>) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let mut flow = ControlFlow::Continue(());
        let mut take = |id, projection: &Projection| {
            flow = visit(&of_one(id, projection));
            flow
        };
        ask(self, query, &mut Near::all(radius, &mut take));
        flow
    }

    /// Whether any primitive is within the radius. Ends at the first one that is found.
    fn is_any_within(&self, query: &Point3<T>, radius: T) -> bool {
        let mut end = |_: PrimitiveId, _: &Projection| ControlFlow::Break(());
        let mut near = Near::all(radius, &mut end);
        ask(self, query, &mut near);
        near.is_done()
    }

    /// The closest point of the primitives whose ids `among` accepts. It is asked about those alone that are near, perhaps
    /// more than once, and has to say the same each time. Of the options the largest distance alone matters.
    fn closest_point_among(
        &self,
        query: &Point3<T>,
        options: &QueryOptions<T>,
        among: &mut dyn FnMut(PrimitiveId) -> bool,
    ) -> Option<Closest<T>> {
        let mut near = Near { among: Some(among), ..Near::nearest(1, options.max_distance) };
        ask(self, query, &mut near);
        near.finish().pop()
    }
}

/// [`NearQuery::search_near`] for any query, if something is wanted at all.
pub fn ask<T: Real>(index: &(impl NearQuery<T> + ?Sized), query: &Point3<T>, near: &mut Near<'_>) {
    // Not for a radius of NaN either.
    if query.iter().all(|x| x.is_finite()) && !near.is_done() && near.radius >= 0.0 {
        index.search_near(query, near);
    }
}

/// What is wanted of the primitives near a query, and what was found: handed to a backend by the methods of
/// [`NearQuery`], which take it apart. A backend searches with it as a [`Collector`], and may end when it
/// [is done](Self::is_done).
pub struct Near<'a> {
    /// The largest distance within the radius.
    radius: f64,
    /// The square of the radius, rounded up; of the farthest one where there are as many as wanted; below zero at the
    /// end.
    prune: f64,
    wanted: Wanted<'a>,
    among: Option<&'a mut dyn FnMut(PrimitiveId) -> bool>,
}

enum Wanted<'a> {
    /// As many as this, the farthest one on top.
    Nearest(usize, BinaryHeap<Found>),
    /// Every one.
    All(&'a mut dyn FnMut(PrimitiveId, &Projection) -> ControlFlow<()>),
    /// Those that may be nearest: some primitive is truly at most `reach` far.
    Contest { reach: f64, found: Vec<Found> },
}

/// Nothing is of interest any more.
const DONE: f64 = f64::NEG_INFINITY;

/// A primitive and its nearest point, ordered by key and id.
pub struct Found {
    key: Key,
    pub id: PrimitiveId,
    pub projection: Projection,
}

impl Found {
    /// Its true distance is at least this, but for the rounding of this difference.
    fn at_least(&self) -> f64 {
        // A distance above the range is at least its end; an error above the range leaves nothing known.
        self.key.distance().min(f64::MAX) - self.projection.error
    }
}

impl PartialEq for Found {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Found {}

impl PartialOrd for Found {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Found {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.key.cmp(&other.key).then(self.id.cmp(&other.id))
    }
}

impl<'a> Near<'a> {
    fn nearest<T: Real>(k: usize, radius: T) -> Self {
        let mut near = Self::within(radius, Wanted::Nearest(k, BinaryHeap::new()));
        near.prune = if k == 0 { DONE } else { near.prune };
        near
    }

    fn all<T: Real>(radius: T, visit: &'a mut dyn FnMut(PrimitiveId, &Projection) -> ControlFlow<()>) -> Self {
        Self::within(radius, Wanted::All(visit))
    }

    /// All that may be nearest, if the nearest is within the radius.
    pub fn contest<T: Real>(radius: T) -> Self {
        Self::within(radius, Wanted::Contest { reach: radius.to_f64_above(), found: Vec::new() })
    }

    /// What may be nearest.
    pub fn contestants(self) -> Vec<Found> {
        let Wanted::Contest { reach, mut found } = self.wanted else { return Vec::new() };
        found.retain(|one| one.at_least() <= reach);
        found
    }

    fn within<T: Real>(radius: T, wanted: Wanted<'a>) -> Self {
        // A distance counts as it will be reported, so somewhat beyond the radius; nothing is within NaN.
        let radius = radius.to_f64_above();
        Self { radius, prune: square_within(radius), wanted, among: None }
    }

    /// Whether no other primitive can be wanted.
    #[must_use]
    pub fn is_done(&self) -> bool {
        self.prune < 0.0
    }

    /// The answers, nearest first.
    fn finish<T: Real>(self) -> Vec<Closest<T>> {
        match self.wanted {
            Wanted::Nearest(_, found) => found.into_sorted_vec().iter().map(|f| of_one(f.id, &f.projection)).collect(),
            Wanted::All(_) | Wanted::Contest { .. } => Vec::new(),
        }
    }
}

/// The answer that a primitive is on its own.
fn of_one<T: Real>(id: PrimitiveId, projection: &Projection) -> Closest<T> {
    // A distance above the range is at least its end.
    answer(id, projection, projection.key.distance().min(f64::MAX) - projection.error)
}

impl Collector for Near<'_> {
    fn prune_above(&self) -> f64 {
        self.prune
    }

    /// The same in a contest: some primitive is that near.
    fn prune_given_upper_bound(&self, square: f64) -> f64 {
        if self.is_single_nearest() && square < self.prune { square } else { self.prune }
    }

    fn is_single_nearest(&self) -> bool {
        matches!(self.wanted, Wanted::Contest { .. })
    }

    fn keeps_near_ties(&self) -> bool {
        self.is_single_nearest()
    }

    fn offer(&mut self, id: PrimitiveId, projection: Projection) {
        let key = projection.key;
        if let Wanted::Contest { reach, found } = &mut self.wanted {
            let one = Found { key, id, projection };
            // Rounded up, with a smallest subnormal for the distance.
            let at_most = (key.distance() + projection.error) * (1.0 + 4.0 * f64::EPSILON) + 2.0 * f64::from_bits(1);
            if one.at_least() <= *reach {
                found.push(one);
            }
            // Not for NaN either.
            if at_most < *reach {
                *reach = at_most;
                self.prune = self.prune.min(square_within(at_most));
            }
            return;
        }
        // Not what comes after the end, in a loop that does not look.
        let is_near = !self.is_done() && key.distance() <= self.radius;
        if !is_near {
            return;
        }
        match &mut self.wanted {
            Wanted::Nearest(k, found) => {
                let next = Found { key, id, projection };
                let is_full = found.len() >= *k;
                if is_full && found.peek().is_some_and(|last| next >= *last) {
                    return;
                }
                if !self.among.as_mut().is_none_or(|among| among(id)) {
                    return;
                }
                if is_full {
                    found.pop();
                }
                found.push(next);
                if found.len() == *k
                    && let Some(last) = found.peek()
                {
                    self.prune = self.prune.min(last.key.square_above());
                }
            }
            Wanted::All(visit) => {
                if visit(id, &projection).is_break() {
                    self.prune = DONE;
                }
            }
            Wanted::Contest { .. } => {}
        }
    }
}
