//! Queries beyond the closest point: the k nearest primitives, all primitives within a radius, whether there is any,
//! and the closest one that a caller's filter accepts.
//!
//! One collector, [`Near`], serves all of them, so a backend implements one method and its search is compiled once. The
//! same collector finds the primitives among which a [certified](crate::CertifiedQuery) answer is chosen.

use crate::query::answer::{answer, square_within};
use crate::{Closest, Collector, Key, Position, PrimitiveId, Projection, QueryOptions, Real};
use nalgebra::Point3;
use std::collections::{BinaryHeap, TryReserveError};
use std::ops::ControlFlow;

/// Queries for near primitives beyond the closest one. A backend implements one method,
/// [`search_near`](Self::search_near).
///
/// Each answer equals the answer of [`ClosestPoint`](crate::ClosestPoint) for a scene of its primitive alone, bit for
/// bit. So its [`Closest::lower_bound`] bounds the distance of that primitive and not of the scene. Distances are
/// compared before rounding, equal ones by ids, and the radius is inclusive, so all backends give the same answers. The
/// result is empty for a query that is not finite and for a radius that is negative or NaN.
///
/// ```
/// use nalgebra::Point3;
/// use p2m_core::{BruteForce, NearQuery, Point, QueryOptions};
///
/// let index = BruteForce::new([4.0, 1.0, 2.0, 1.0].map(|x| Point::new(Point3::new(x, 0.0, 0.0)))).unwrap();
/// let origin = Point3::<f64>::origin();
/// let ids = |near: Vec<p2m_core::Closest<f64>>| near.iter().map(|c| c.primitive.index()).collect::<Vec<_>>();
/// assert_eq!(ids(index.k_nearest(&origin, 3, f64::INFINITY)), [1, 3, 2]);
/// assert_eq!(ids(index.all_within(&origin, 1.0)), [1, 3]);
/// assert!(!index.is_any_within(&origin, 0.5));
/// let even = index.closest_point_among(&origin, &QueryOptions::default(), &mut |id| id.index() % 2 == 0);
/// assert_eq!(even.unwrap().primitive.index(), 2);
/// ```
///
/// # Complexity
/// Trees take expected O(log n + k log k) for k answers. [`closest_point_among`](Self::closest_point_among) takes as
/// long as a query for all primitives that are nearer than the accepted one. Brute force takes O(n). The interception
/// indexes use their trees, since a list is guaranteed to contain the nearest primitive, but not the second nearest.
pub trait NearQuery<T: Real> {
    /// Offers to `near` every primitive that could be part of the answer, each at most once. `query` is finite.
    fn search_near(&self, query: &Point3<T>, near: &mut Near<'_>);

    /// Returns the nearest primitives, at most `k` and none beyond the radius, nearest first. The radius is in units of
    /// the scene and may be infinite.
    ///
    /// # Panics
    /// It panics if the answers do not fit into memory, as [`all_within`](Self::all_within) does.
    fn k_nearest(&self, query: &dyn Position<T>, k: usize, radius: T) -> Vec<Closest<T>> {
        self.try_k_nearest(query, k, radius).expect("memory for the nearest primitives")
    }

    /// Returns the answer of [`k_nearest`](Self::k_nearest), or an error if it does not fit into memory. With k =
    /// `usize::MAX` it is the answer of [`all_within`](Self::all_within).
    ///
    /// # Errors
    /// It returns the error of the allocation.
    fn try_k_nearest(&self, query: &dyn Position<T>, k: usize, radius: T) -> Result<Vec<Closest<T>>, TryReserveError> {
        let mut near = Near::nearest(k, radius);
        search_near_if_valid(self, query, &mut near);
        near.finish()
    }

    /// Returns all primitives within the radius, nearest first. [`visit_within`](Self::visit_within) visits them
    /// without storing them.
    fn all_within(&self, query: &dyn Position<T>, radius: T) -> Vec<Closest<T>> {
        self.k_nearest(query, usize::MAX, radius)
    }

    /// Calls `visit` for each primitive within the radius until `visit` breaks, and returns whether it did. The order
    /// depends on the backend.
    fn visit_within(
        &self,
        query: &dyn Position<T>,
        radius: T,
        visit: &mut dyn FnMut(&Closest<T>) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let mut flow = ControlFlow::Continue(());
        let mut take = |id, projection: &Projection| {
            flow = visit(&answer_alone(id, projection));
            flow
        };
        search_near_if_valid(self, query, &mut Near::all(radius, &mut take));
        flow
    }

    /// Returns whether any primitive is within the radius. The search ends at the first such primitive.
    fn is_any_within(&self, query: &dyn Position<T>, radius: T) -> bool {
        let mut end = |_: PrimitiveId, _: &Projection| ControlFlow::Break(());
        let mut near = Near::all(radius, &mut end);
        search_near_if_valid(self, query, &mut near);
        near.is_done()
    }

    /// Returns the closest point of the primitives whose ids `among` accepts.
    ///
    /// `among` is called only for nearby primitives, perhaps more than once for the same one, and has to be consistent.
    /// Of the options only the largest distance is used.
    fn closest_point_among(
        &self,
        query: &dyn Position<T>,
        options: &QueryOptions<T>,
        among: &mut dyn FnMut(PrimitiveId) -> bool,
    ) -> Option<Closest<T>> {
        let mut near = Near { among: Some(among), ..Near::nearest(1, options.max_distance) };
        search_near_if_valid(self, query, &mut near);
        near.finish().ok()?.pop() // one answer needs no memory that could be missing
    }
}

/// Calls [`NearQuery::search_near`] unless the query or the radius makes the answer empty.
pub(crate) fn search_near_if_valid<T: Real>(
    index: &(impl NearQuery<T> + ?Sized),
    query: &dyn Position<T>,
    near: &mut Near<'_>,
) {
    let query = query.point();
    // The comparison is false for a NaN radius.
    if query.iter().all(|x| x.is_finite()) && !near.is_done() && near.radius >= 0.0 {
        index.search_near(&query, near);
    }
}

/// The collector of near primitives, which the methods of [`NearQuery`] pass to a backend.
///
/// A backend uses it as a [`Collector`], and may end the search when it [is done](Self::is_done).
pub struct Near<'a> {
    /// The largest f64 distance that is reported as within the radius.
    radius: f64,
    /// The square above which lower bounds are pruned. At first it is the square of the radius, rounded up. Once a list
    /// is full, it is the square of the farthest primitive in it. At the end it is [`PRUNE_ALL`].
    prune: f64,
    mode: NearMode<'a>,
    among: Option<&'a mut dyn FnMut(PrimitiveId) -> bool>,
    /// The allocation error that ended the search.
    error: Option<TryReserveError>,
}

enum NearMode<'a> {
    /// Keeps at most this number of nearest primitives, with the farthest one on top of the heap.
    Nearest(usize, BinaryHeap<NearCandidate>),
    /// Passes every primitive to a function.
    All(&'a mut dyn FnMut(PrimitiveId, &Projection) -> ControlFlow<()>),
    /// Passes every primitive to a function, which returns the new radius. With a finite slack, only primitives that
    /// are farther than the nearest one by at most the slack are needed.
    Shrinking { slack: f64, visit: &'a mut dyn FnMut(PrimitiveId, &[[f64; 3]]) -> f64 },
    /// Keeps all primitives that may be nearest, given the error bounds of the kernel. The true distance of some
    /// primitive is at most `upper_bound`.
    Certification { upper_bound: f64, found: Vec<NearCandidate> },
}

/// A limit below all squares: no other primitive can be part of the answer.
const PRUNE_ALL: f64 = f64::NEG_INFINITY;

/// A primitive and its nearest point, ordered by key and id.
pub(crate) struct NearCandidate {
    key: Key,
    /// The id of the primitive.
    pub(crate) id: PrimitiveId,
    /// The nearest point, computed by the kernel.
    pub(crate) projection: Projection,
}

impl PartialEq for NearCandidate {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for NearCandidate {}

impl PartialOrd for NearCandidate {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for NearCandidate {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.key.cmp(&other.key).then(self.id.cmp(&other.id))
    }
}

impl<'a> Near<'a> {
    fn nearest<T: Real>(k: usize, radius: T) -> Self {
        let mut near = Self::within(radius, NearMode::Nearest(k, BinaryHeap::new()));
        near.prune = if k == 0 { PRUNE_ALL } else { near.prune };
        near
    }

    fn all<T: Real>(radius: T, visit: &'a mut dyn FnMut(PrimitiveId, &Projection) -> ControlFlow<()>) -> Self {
        Self::within(radius, NearMode::All(visit))
    }

    /// Creates a collector that calls `visit` for all primitives within a radius that shrinks during the search. It
    /// serves an index that is composed of other indexes. Some primitives beyond the radius may be visited as well.
    ///
    /// `visit` gets the id of a primitive, and its vertices if the search has them at hand; otherwise it gets no
    /// vertices. It returns the new radius. A larger radius than before has no effect, and a negative one ends the
    /// search. Primitives that are farther than the nearest one of the index by more than `slack` are not needed; it is
    /// infinite if all primitives within the radius are needed. Lengths are in units of the scene and in f64, and the
    /// radius is inclusive.
    ///
    /// ```
    /// use nalgebra::Point3;
    /// use p2m_core::{BruteForce, Near, NearQuery, Point, PrimitiveId};
    ///
    /// let index = BruteForce::new([3.0, 1.0, 2.0].map(|x| Point::new(Point3::new(x, 0.0, 0.0))))?;
    /// let mut visited = Vec::new();
    /// let mut visit = |id: PrimitiveId, _: &[[f64; 3]]| {
    ///     visited.push(id.index());
    ///     index.set()[id.index()].position.x
    /// };
    /// index.search_near(&Point3::origin(), &mut Near::shrinking(f64::INFINITY, f64::INFINITY, &mut visit));
    /// // The last point is farther than the second, to whose distance the radius has shrunk.
    /// assert_eq!(visited, [0, 1]);
    /// # Ok::<(), p2m_core::BuildError>(())
    /// ```
    #[must_use]
    pub fn shrinking(radius: f64, slack: f64, visit: &'a mut dyn FnMut(PrimitiveId, &[[f64; 3]]) -> f64) -> Self {
        let mut near = Self::within(radius, NearMode::Shrinking { slack, visit });
        near.shrink(radius);
        near
    }

    /// Reduces the radius if the new one is smaller. A negative radius and NaN end the search.
    fn shrink(&mut self, radius: f64) {
        if radius >= 0.0 {
            self.radius = self.radius.min(radius);
            self.prune = self.prune.min(square_within(radius));
        } else {
            self.prune = PRUNE_ALL;
        }
    }

    /// Creates a collector of all primitives that may be nearest, if the nearest one is within the radius.
    pub(crate) fn for_certification<T: Real>(radius: T) -> Self {
        Self::within(radius, NearMode::Certification { upper_bound: radius.to_f64_above(), found: Vec::new() })
    }

    /// Returns the primitives that may be nearest, from a collector [for certification](Self::for_certification).
    pub(crate) fn certification_candidates(self) -> Vec<NearCandidate> {
        let NearMode::Certification { upper_bound, mut found } = self.mode else { return Vec::new() };
        found.retain(|candidate| lower_bound(&candidate.projection) <= upper_bound);
        found
    }

    fn within<T: Real>(radius: T, mode: NearMode<'a>) -> Self {
        // Distances are compared as they are reported, so some distances beyond the radius round into it. Nothing is
        // within a NaN radius.
        let radius = radius.to_f64_above();
        Self { radius, prune: square_within(radius), mode, among: None, error: None }
    }

    /// Returns whether no other primitive can be part of the answer.
    #[must_use]
    pub fn is_done(&self) -> bool {
        self.prune < 0.0
    }

    /// Returns the answers, nearest first.
    fn finish<T: Real>(self) -> Result<Vec<Closest<T>>, TryReserveError> {
        let mut answers = Vec::new();
        if let Some(error) = self.error {
            return Err(error);
        }
        if let NearMode::Nearest(_, found) = self.mode {
            answers.try_reserve_exact(found.len())?;
            answers.extend(found.into_sorted_vec().iter().map(|one| answer_alone(one.id, &one.projection)));
        }
        Ok(answers)
    }
}

/// Returns a lower bound on the true distance of a projection, up to the rounding of the subtraction.
fn lower_bound(projection: &Projection) -> f64 {
    // A distance above the range of f64 is replaced by the end of the range. An infinite error gives minus infinity.
    projection.key.distance().min(f64::MAX) - projection.error
}

/// Returns the answer for a primitive alone. Its lower bound says nothing about the rest of the scene.
fn answer_alone<T: Real>(id: PrimitiveId, projection: &Projection) -> Closest<T> {
    answer(id, projection, lower_bound(projection))
}

impl Collector for Near<'_> {
    fn prune_above(&self) -> f64 {
        self.prune
    }

    fn prune_given_upper_bound(&self, square: f64) -> f64 {
        if self.is_single_nearest() && square < self.prune { square } else { self.prune }
    }

    fn prune_above_for_id(&self, id: PrimitiveId) -> f64 {
        match &self.mode {
            // Ties go to the lowest ids, so a higher id has to be strictly nearer than the farthest primitive of a full
            // list.
            NearMode::Nearest(k, found) if found.len() >= *k => match found.peek() {
                Some(last) if last.id < id && last.key == Key::ZERO => PRUNE_ALL,
                Some(last) if last.id < id && last.key.plain_square() == Some(self.prune) => self.prune.next_down(),
                _ => self.prune,
            },
            // The visitor compares true distances and not keys, so no limit on keys applies.
            NearMode::Shrinking { .. } if !self.is_done() => f64::INFINITY,
            _ => self.prune,
        }
    }

    fn is_single_nearest(&self) -> bool {
        match self.mode {
            NearMode::Certification { .. } => true,
            NearMode::Shrinking { slack, .. } => slack < f64::INFINITY,
            NearMode::Nearest(..) | NearMode::All(_) => false,
        }
    }

    fn near_tie_slack(&self) -> f64 {
        if let NearMode::Shrinking { slack, .. } = self.mode { slack } else { 0.0 }
    }

    fn keeps_near_ties(&self) -> bool {
        self.is_single_nearest()
    }

    fn take_vertices(&mut self, id: PrimitiveId, vertices: &[[f64; 3]]) -> bool {
        let is_done = self.is_done();
        let NearMode::Shrinking { visit, .. } = &mut self.mode else { return false };
        if !is_done {
            let radius = visit(id, vertices);
            self.shrink(radius);
        }
        true
    }

    fn offer(&mut self, id: PrimitiveId, projection: Projection) {
        let key = projection.key;
        if let NearMode::Certification { upper_bound, found } = &mut self.mode {
            let candidate = NearCandidate { key, id, projection };
            // The sum is rounded up, and a smallest subnormal covers the rounding of the distance.
            let at_most = (key.distance() + projection.error) * (1.0 + 4.0 * f64::EPSILON) + 2.0 * f64::from_bits(1);
            if lower_bound(&candidate.projection) <= *upper_bound {
                found.push(candidate);
            }
            // If an error of NaN makes the sum NaN, the comparison is false.
            if at_most < *upper_bound {
                *upper_bound = at_most;
                self.prune = self.prune.min(square_within(at_most));
            }
            return;
        }
        // A backend need not check whether the collector is done, so candidates after the end are ignored here.
        let is_near = !self.is_done() && key.distance() <= self.radius;
        if !is_near {
            return;
        }
        match &mut self.mode {
            NearMode::Nearest(k, found) => {
                let next = NearCandidate { key, id, projection };
                let is_full = found.len() >= *k;
                if is_full && found.peek().is_some_and(|last| next >= *last) {
                    return;
                }
                if !self.among.as_mut().is_none_or(|among| among(id)) {
                    return;
                }
                if is_full {
                    found.pop();
                } else if let Err(error) = found.try_reserve(1) {
                    self.error = Some(error);
                    self.prune = PRUNE_ALL;
                    return;
                }
                found.push(next);
                if found.len() == *k
                    && let Some(last) = found.peek()
                {
                    self.prune = self.prune.min(last.key.square_above());
                }
            }
            NearMode::All(visit) => {
                if visit(id, &projection).is_break() {
                    self.prune = PRUNE_ALL;
                }
            }
            NearMode::Shrinking { visit, .. } => {
                let radius = visit(id, &[]);
                self.shrink(radius);
            }
            NearMode::Certification { .. } => {}
        }
    }
}
