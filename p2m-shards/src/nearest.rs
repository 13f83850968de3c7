//! Queries for near primitives: what each shard finds is compared until no other shard can be near enough.

use crate::{Shard, ShardError, ShardedIndex};
use nalgebra::Point3;
use p2m_core::kernel::ERROR_CONSTANT;
use p2m_core::{
    Aabb, Best, BruteForce, CertifiedQuery, Closest, Collector, Key, Position, Primitive, PrimitiveSet, QueryOptions,
    Real, Shape,
};
use std::sync::Arc;

/// The answer to a query for a near primitive of a sharded index.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ShardClosest {
    /// The id of the primitive in the whole scene.
    pub id: u64,
    /// The number of the shard that has it.
    pub shard: usize,
    /// The closest point. Its field `primitive` is the id within the shard.
    pub closest: Closest<f64>,
}

impl ShardClosest {
    /// Makes the answer of an answer of a shard.
    pub(crate) fn new(number: usize, shard: &Shard, closest: Closest<f64>) -> Self {
        Self { id: shard.global_id(closest.primitive), shard: number, closest }
    }

    /// Returns whether this answer wins against another one, which is of another shard.
    #[allow(clippy::float_cmp, reason = "keys decide among equal distances")]
    fn wins(&self, shard: &Shard, other: &Self, other_shard: &Shard, query: &Point3<f64>) -> bool {
        let (distance, least) = (self.closest.distance, other.closest.distance);
        if distance != least {
            return distance < least;
        }
        let key = |shard: &Shard, answer: &Self| key(shard, &answer.closest, query);
        (key(shard, self), self.id) < (key(other_shard, other), other.id)
    }
}

/// Returns the key of the primitive of an answer, which is its squared distance as the kernel computes it: a square
/// with a tier.
pub(crate) fn key(shard: &Shard, closest: &Closest<f64>, query: &Point3<f64>) -> Key {
    shard.soup().get(closest.primitive).project(query).key
}

/// The shards in the order of the bounds of their boxes.
pub(crate) struct ByBound {
    bounds: Vec<f64>,
}

impl ByBound {
    pub(crate) fn new(boxes: &[Aabb<f64>], query: &Point3<f64>) -> Self {
        Self { bounds: boxes.iter().map(|bounds| bounds.lower_bound(query)).collect() }
    }

    /// Takes the shard with the least bound, if that is at most the limit on squared distances.
    ///
    /// Few shards are taken, so looking for each among all costs less than sorting them.
    pub(crate) fn take(&mut self, limit: f64) -> Option<(usize, f64)> {
        let (number, bound) = least(self.bounds.iter().copied(), limit)?;
        self.bounds[number] = f64::NAN;
        Some((number, bound))
    }
}

/// Returns the place and the value of the least of some bounds that are at most a limit.
pub(crate) fn least(bounds: impl Iterator<Item = f64>, limit: f64) -> Option<(usize, f64)> {
    bounds.enumerate().fold(None, |best: Option<(usize, f64)>, (number, bound)| {
        if bound <= limit && best.is_none_or(|(_, least)| bound < least) { Some((number, bound)) } else { best }
    })
}

/// Returns the largest squared lower bound at which a shard may still have something within a distance.
pub(crate) fn limit(distance: f64) -> f64 {
    Best::<f64>::new(&QueryOptions::default().with_max_distance(distance)).prune_above()
}

/// The best answer of some shards.
pub(crate) struct Merged<'a> {
    query: &'a Point3<f64>,
    options: QueryOptions<f64>,
    /// The largest error of a distance from the query.
    error: f64,
    best: Option<(ShardClosest, Arc<Shard>)>,
    /// The least lower bound of the shards that were asked.
    lower_bound: f64,
}

impl<'a> Merged<'a> {
    pub(crate) fn new(index: &ShardedIndex, query: &'a Point3<f64>, options: &QueryOptions<f64>) -> Self {
        let mut options = *options;
        // A hint is an id within one shard.
        options.hint = None;
        Self { query, options, error: index.largest_error(query), best: None, lower_bound: f64::INFINITY }
    }

    /// Returns the options of the next shard.
    ///
    /// The largest distance is the best distance plus the error of the kernel, because a shard without an answer within
    /// it then has no primitive below the lower bound of the best answer.
    pub(crate) fn options(&self) -> QueryOptions<f64> {
        let reach = self.best.as_ref().map_or(f64::INFINITY, |(best, _)| reach(best.closest.distance, self.error));
        self.options.with_max_distance(self.options.max_distance.min(reach))
    }

    /// Takes the answer of a shard, whose box has the squared distance `bound`.
    pub(crate) fn offer(&mut self, number: usize, shard: &Arc<Shard>, bound: f64, answer: Option<Closest<f64>>) {
        let Some(closest) = answer else {
            if self.options.max_visits < u32::MAX {
                // A search that ended early may have missed everything, so it is only known that nothing of the shard
                // is nearer than its box.
                self.lower_bound = self.lower_bound.min(distance_below(bound));
            }
            return;
        };
        self.lower_bound = self.lower_bound.min(closest.lower_bound);
        let answer = ShardClosest::new(number, shard, closest);
        if self.best.as_ref().is_none_or(|(best, best_shard)| answer.wins(shard, best, best_shard, self.query)) {
            self.best = Some((answer, Arc::clone(shard)));
        }
    }

    pub(crate) fn finish(self) -> Option<ShardClosest> {
        let (mut best, _) = self.best?;
        best.closest.lower_bound = self.lower_bound;
        Some(best)
    }
}

/// Returns a distance that exceeds another one by at least an error.
pub(crate) fn reach(distance: f64, error: f64) -> f64 {
    ((distance + error) * (1.0 + 4.0 * f64::EPSILON)).next_up()
}

/// Returns a distance that is not above the root of a bound on squared distances.
fn distance_below(bound: f64) -> f64 {
    (bound.min(f64::MAX).sqrt() * (1.0 - 8.0 * f64::EPSILON) - 4.0 * f64::from_bits(1)).max(0.0)
}

/// The state of a query while shards are asked.
pub(crate) trait Search {
    /// Returns the largest distance of an answer that can still matter, or NaN if the query has none.
    fn largest(&self) -> f64;

    /// Returns the square above which a lower bound rules a shard out. It is negative if the query has no answer.
    fn prune_above(&self) -> f64 {
        let largest = self.largest();
        if largest.is_nan() { -1.0 } else { limit(largest) }
    }

    /// Asks a shard.
    fn ask(&mut self, query: &Point3<f64>, number: usize, shard: &Shard);
}

/// A search for a certified answer.
pub(crate) struct CertifiedSearch {
    /// The certified answers of shards with their primitives.
    winners: Vec<(ShardClosest, Shape<f64>)>,
    largest: f64,
}

impl CertifiedSearch {
    pub(crate) fn new(query: &Point3<f64>, options: &QueryOptions<f64>) -> Self {
        let largest = if may_have_answer(query, options.max_distance) { options.max_distance } else { f64::NAN };
        Self { winners: Vec::new(), largest }
    }

    /// Returns the answer, for which rational arithmetic decides among the nearest primitives of the shards.
    pub(crate) fn finish(
        mut self,
        query: &Point3<f64>,
        options: &QueryOptions<f64>,
    ) -> Result<Option<ShardClosest>, ShardError> {
        if self.winners.len() < 2 {
            return Ok(self.winners.pop().map(|(answer, _)| answer));
        }
        // Of equally near primitives the first one wins.
        self.winners.sort_unstable_by_key(|(answer, _)| answer.id);
        let shapes: Vec<Shape<f64>> = self.winners.iter().map(|(_, shape)| *shape).collect();
        let few = BruteForce::new(shapes)?;
        let decided = few.certified_closest_point(query, options).ok().flatten();
        Ok(decided.map(|decided| {
            let (mut winner, _) = self.winners[decided.primitive.index()];
            let primitive = winner.closest.primitive;
            winner.closest = decided;
            winner.closest.primitive = primitive;
            winner
        }))
    }
}

impl Search for CertifiedSearch {
    fn largest(&self) -> f64 {
        self.largest
    }

    fn ask(&mut self, query: &Point3<f64>, number: usize, shard: &Shard) {
        let within = QueryOptions::default().with_max_distance(self.largest);
        // A query cannot fail here, because every primitive of a scene has vertices.
        let answer = shard.index().certified_closest_point(query, &within).ok().flatten();
        if let Some((closest, shape)) = answer.and_then(|one| Some((one, shard.shape(one.primitive)?))) {
            self.winners.push((ShardClosest::new(number, shard, closest), shape));
            // A primitive that is nearer by less than the rounding of that distance still counts.
            self.largest = self.largest.min(closest.distance.next_up());
        }
    }
}

/// A search for a number of near primitives.
pub(crate) struct NearSearch {
    k: usize,
    /// The primitives that were found, in order.
    found: Vec<Near>,
    largest: f64,
}

/// A near primitive and the key that orders it among others.
struct Near {
    key: Key,
    answer: ShardClosest,
}

impl NearSearch {
    pub(crate) fn new(query: &Point3<f64>, k: usize, radius: f64) -> Self {
        // The comparison is false for a radius of NaN.
        let has_answers = k > 0 && is_finite(query) && radius >= 0.0;
        Self { k, found: Vec::new(), largest: if has_answers { radius } else { f64::NAN } }
    }

    pub(crate) fn finish(self) -> Vec<ShardClosest> {
        self.found.into_iter().map(|near| near.answer).collect()
    }
}

impl Search for NearSearch {
    fn largest(&self) -> f64 {
        self.largest
    }

    fn ask(&mut self, query: &Point3<f64>, number: usize, shard: &Shard) {
        let near = shard.index().k_nearest(query, self.k, self.largest);
        self.found.extend(near.into_iter().map(|closest| Near {
            key: key(shard, &closest, query),
            answer: ShardClosest::new(number, shard, closest),
        }));
        self.found.sort_unstable_by_key(|near| (near.key, near.answer.id));
        self.found.truncate(self.k);
        if let Some(last) = self.found.get(self.k - 1) {
            self.largest = last.answer.closest.distance;
        }
    }
}

impl ShardedIndex {
    /// Returns a bound on the error of the distance of every primitive (contract N1), rounded up.
    pub(crate) fn largest_error(&self, query: &Point3<f64>) -> f64 {
        let farthest = (0..3).map(|k| (query[k] - self.bounds.min[k]).abs().max((self.bounds.max[k] - query[k]).abs()));
        // The sum of three distances along the axes is at least their Euclidean sum.
        let largest: f64 = farthest.sum::<f64>() * (1.0 + 8.0 * f64::EPSILON);
        2.0 * ERROR_CONSTANT * f64::UNIT_ROUNDOFF * largest + 2.0 * f64::from_bits(1)
    }

    /// Returns the closest point, or `None` for an empty scene and for a query that is not finite.
    ///
    /// # Errors
    /// It returns the [errors of loading a shard](ShardError#loading-a-shard).
    pub fn closest_point(&self, query: &impl Position<f64>) -> Result<Option<ShardClosest>, ShardError> {
        self.closest_point_with(query, &QueryOptions::default())
    }

    /// Returns the closest point subject to `options`, or `None` if nothing is within the largest distance. A hint is
    /// ignored, and a limit on visits counts for each shard.
    ///
    /// # Errors
    /// It returns the [errors of loading a shard](ShardError#loading-a-shard).
    ///
    /// # Complexity
    /// It takes the time of a query of each shard that can have the answer, and O(s) for the boxes of s shards.
    pub fn closest_point_with(
        &self,
        query: &impl Position<f64>,
        options: &QueryOptions<f64>,
    ) -> Result<Option<ShardClosest>, ShardError> {
        let query = &query.point();
        if !may_have_answer(query, options.max_distance) {
            return Ok(None);
        }
        let mut merged = Merged::new(self, query, options);
        let mut order = ByBound::new(&self.boxes, query);
        loop {
            let options = merged.options();
            let Some((number, bound)) = order.take(limit(options.max_distance)) else { return Ok(merged.finish()) };
            let shard = self.shard(number)?;
            let answer = shard.index().closest_point_with(query, &options);
            merged.offer(number, &shard, bound, answer);
        }
    }

    /// Returns the certified closest point (contract N8): the primitive is certainly the nearest one, and its distance
    /// is rounded once. Of the options only the largest distance is used, and it is compared without rounding.
    ///
    /// # Errors
    /// It returns the [errors of loading a shard](ShardError#loading-a-shard).
    pub fn certified_closest_point(
        &self,
        query: &impl Position<f64>,
        options: &QueryOptions<f64>,
    ) -> Result<Option<ShardClosest>, ShardError> {
        let query = &query.point();
        let mut search = CertifiedSearch::new(query, options);
        self.search(query, &mut search)?;
        search.finish(query, options)
    }

    /// Returns the nearest primitives, at most `k` and none beyond the radius, nearest first. The radius may be
    /// infinite. The lower bound of each answer is that of its own primitive.
    ///
    /// # Errors
    /// It returns the [errors of loading a shard](ShardError#loading-a-shard).
    pub fn k_nearest(
        &self,
        query: &impl Position<f64>,
        k: usize,
        radius: f64,
    ) -> Result<Vec<ShardClosest>, ShardError> {
        let query = &query.point();
        let mut search = NearSearch::new(query, k, radius);
        self.search(query, &mut search)?;
        Ok(search.finish())
    }

    /// Asks the shards for one query, the nearest box first, as long as a shard may matter.
    fn search(&self, query: &Point3<f64>, search: &mut impl Search) -> Result<(), ShardError> {
        let mut order = ByBound::new(&self.boxes, query);
        while let Some((number, _)) = order.take(search.prune_above()) {
            search.ask(query, number, &*self.shard(number)?);
        }
        Ok(())
    }

    /// Returns all primitives within the radius, nearest first.
    ///
    /// # Errors
    /// It returns the [errors of loading a shard](ShardError#loading-a-shard).
    pub fn all_within(&self, query: &impl Position<f64>, radius: f64) -> Result<Vec<ShardClosest>, ShardError> {
        self.k_nearest(query, usize::MAX, radius)
    }

    /// Returns whether any primitive is within the radius.
    ///
    /// # Errors
    /// It returns the [errors of loading a shard](ShardError#loading-a-shard).
    pub fn is_any_within(&self, query: &impl Position<f64>, radius: f64) -> Result<bool, ShardError> {
        let query = &query.point();
        let may_have_any = is_finite(query) && radius >= 0.0;
        let mut order = ByBound::new(&self.boxes, query);
        while may_have_any && let Some((number, _)) = order.take(limit(radius)) {
            if self.shard(number)?.index().is_any_within(query, radius) {
                return Ok(true);
            }
        }
        Ok(false)
    }
}

/// Returns whether a query may have an answer: its coordinates are finite, and its largest distance is a number.
pub(crate) fn may_have_answer(query: &Point3<f64>, max_distance: f64) -> bool {
    is_finite(query) && !max_distance.is_nan()
}

/// Returns whether all coordinates of a query are finite.
pub(crate) fn is_finite(query: &Point3<f64>) -> bool {
    query.iter().all(|x| x.is_finite())
}
