//! Queries for near primitives, which ask shards until no other one can have a primitive that is near enough.

use crate::search::{CHUNK_LEN, Proceed, Search, collect, go_on, least};
use crate::{Shard, ShardError, ShardedIndex};
use nalgebra::Point3;
use p2m_core::batch::{BatchOptions, Interruptible, closest_points_into};
use p2m_core::engine::parallel;
use p2m_core::kernel::ERROR_CONSTANT;
use p2m_core::{
    Aabb, Best, BruteForce, CertifiedQuery, Closest, Collector, Key, Position, Primitive, PrimitiveSet, QueryOptions,
    Real, Shape,
};

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
    /// Makes the answer of the index from the answer of a shard.
    fn new(number: usize, shard: &Shard, closest: Closest<f64>) -> Self {
        Self { id: shard.global_id(closest.primitive), shard: number, closest }
    }
}

/// Returns the squared distance of a query from a box, by the arithmetic of the kernel.
fn bound(query: &Point3<f64>, bounds: &Aabb<f64>) -> f64 {
    bounds.lower_bound(query)
}

/// Returns the key of the primitive of an answer, which is its squared distance as the kernel computes it: a square
/// with a tier.
fn key(shard: &Shard, closest: &Closest<f64>, query: &Point3<f64>) -> Key {
    shard.soup().get(closest.primitive).project(query).key
}

/// Returns the largest squared lower bound at which a shard may still have something within a distance, or NaN if the
/// distance is NaN.
fn limit(distance: f64) -> f64 {
    if distance.is_nan() {
        return f64::NAN;
    }
    Best::<f64>::new(&QueryOptions::default().with_max_distance(distance)).prune_above()
}

/// Returns the largest distance of a query that has no answer unless its coordinates are finite.
fn largest_distance(query: &Point3<f64>, max_distance: f64) -> f64 {
    if is_finite(query) { max_distance } else { f64::NAN }
}

/// Returns a distance that exceeds another one by at least an error.
fn reach(distance: f64, error: f64) -> f64 {
    ((distance + error) * (1.0 + 4.0 * f64::EPSILON)).next_up()
}

/// Returns a distance that is at most the root of a bound on squared distances.
fn distance_below(bound: f64) -> f64 {
    (bound.min(f64::MAX).sqrt() * (1.0 - 8.0 * f64::EPSILON) - 4.0 * f64::from_bits(1)).max(0.0)
}

/// A search for the closest point.
pub(crate) struct ClosestSearch {
    query: Point3<f64>,
    /// The options, without a hint, which is an id within one shard.
    options: QueryOptions<f64>,
    /// The largest error of a distance from the query.
    error: f64,
    best: Option<ShardClosest>,
    /// The key of the best answer, if others may be as near.
    key: Option<Key>,
    /// The least lower bound of the shards that were asked.
    lower_bound: f64,
}

impl ClosestSearch {
    pub(crate) fn new(index: &ShardedIndex, query: &Point3<f64>, options: &QueryOptions<f64>) -> Self {
        let mut options = options.with_max_distance(largest_distance(query, options.max_distance));
        options.hint = None;
        let error = index.largest_error(query);
        Self { query: *query, options, error, best: None, key: None, lower_bound: f64::INFINITY }
    }

    /// Returns the largest distance of an answer that can still matter.
    ///
    /// It is the best distance plus the error of the kernel. A shard without an answer within this distance has no
    /// primitive below the lower bound of the best answer.
    fn largest(&self) -> f64 {
        let largest = self.options.max_distance;
        self.best.map_or(largest, |best| largest.min(reach(best.closest.distance, self.error)))
    }

    /// Takes the answer of a shard.
    #[allow(clippy::float_cmp, reason = "keys decide among equal distances")]
    fn offer(&mut self, number: usize, shard: &Shard, closest: Closest<f64>) {
        self.lower_bound = self.lower_bound.min(closest.lower_bound);
        let answer = ShardClosest::new(number, shard, closest);
        let wins = self.best.is_none_or(|best| {
            if closest.distance != best.closest.distance {
                return closest.distance < best.closest.distance;
            }
            (Some(key(shard, &closest, &self.query)), answer.id) < (self.key, best.id)
        });
        if wins {
            (self.best, self.key) = (Some(answer), None);
        }
    }

    /// Returns the answer of the only shard that was asked, with its key.
    pub(crate) fn finish_with_key(mut self, shard: &Shard) -> Option<(ShardClosest, Key)> {
        self.prepare_for_others(shard);
        let key = self.key;
        self.finish().zip(key)
    }
}

impl Search for ClosestSearch {
    type Answer = Option<ShardClosest>;

    fn bound(&self, bounds: &Aabb<f64>) -> f64 {
        bounds.lower_bound(&self.query)
    }

    fn limit(&self) -> f64 {
        limit(self.largest())
    }

    fn ask(&mut self, number: usize, shard: &Shard) -> Result<(), ShardError> {
        let options = self.options.with_max_distance(self.largest());
        if let Some(closest) = shard.index().closest_point_with(&self.query, &options) {
            self.offer(number, shard, closest);
        } else if self.options.max_visits < u32::MAX {
            // A search that ended early may have missed anything, so the box of the shard is the only bound on its
            // primitives.
            self.lower_bound = self.lower_bound.min(distance_below(self.bound(shard.bounds())));
        }
        Ok(())
    }

    /// Asks for all queries in one batch of the index.
    fn ask_first(
        group: &mut [&mut Self],
        number: usize,
        shard: &Shard,
        proceed: &Proceed<'_>,
    ) -> Result<(), ShardError> {
        // All queries of a batch have the same options, except that a query which is not finite has no distance.
        let options = group.iter().map(|search| search.options).find(|options| !options.max_distance.is_nan());
        let Some(options) = options else { return Ok(()) };
        let queries: Vec<Point3<f64>> = group.iter().map(|search| search.query).collect();
        let mut answers = vec![None; queries.len()];
        let interruptible = Interruptible::new(shard.index(), |left, answer| {
            if !proceed(0) {
                return false;
            }
            answer(left);
            proceed(left)
        });
        closest_points_into(&interruptible, &queries, &options, &BatchOptions::default(), &mut answers);
        go_on(proceed, 0)?;
        let mut answered: Vec<_> = group.iter_mut().zip(answers).collect();
        parallel::for_each_chunk(&mut answered, CHUNK_LEN, true, |_, answered| {
            for (search, answer) in answered {
                if let Some(closest) = *answer {
                    search.offer(number, shard, closest);
                }
            }
        });
        Ok(())
    }

    fn prepare_for_others(&mut self, shard: &Shard) {
        // Without a key, the best answer comes from the shard that was asked last.
        if let (Some(best), None) = (&self.best, self.key) {
            self.key = Some(key(shard, &best.closest, &self.query));
        }
    }

    /// Returns `true` for approximate searches, because the order of shards decides what they leave out on purpose.
    fn depends_on_order(&self) -> bool {
        self.options.is_approximate()
    }

    fn finish(self) -> Option<ShardClosest> {
        let mut best = self.best?;
        best.closest.lower_bound = self.lower_bound;
        Some(best)
    }
}

/// Returns the search for a certified answer.
pub(crate) fn certified(
    query: &Point3<f64>,
    options: &QueryOptions<f64>,
) -> impl Search<Answer = Option<ShardClosest>> + use<> {
    let max_distance = largest_distance(query, options.max_distance);
    // A primitive that is nearer by less than the rounding of the best distance still counts.
    let largest = move |found: &Option<(ShardClosest, Shape<f64>)>| {
        found.as_ref().map_or(max_distance, |(best, _)| max_distance.min(best.closest.distance.next_up()))
    };
    collect(
        *query,
        None,
        bound,
        move |found| limit(largest(found)),
        move |found, query, number, shard| {
            let within = QueryOptions::default().with_max_distance(largest(found));
            // A query cannot fail here, because every primitive of a scene has vertices.
            let answer = shard.index().certified_closest_point(query, &within).ok().flatten();
            let Some(closest) = answer else { return Ok(()) };
            let next = (ShardClosest::new(number, shard, closest), shard.soup().get(closest.primitive));
            *found = Some(match found.take() {
                Some(best) => certainly_nearest(query, best, next)?,
                None => next,
            });
            Ok(())
        },
        |found| found.map(|(answer, _)| answer),
    )
}

/// Returns which of two answers is certainly the nearest one, for which rational arithmetic decides
/// between their primitives.
fn certainly_nearest(
    query: &Point3<f64>,
    first: (ShardClosest, Shape<f64>),
    second: (ShardClosest, Shape<f64>),
) -> Result<(ShardClosest, Shape<f64>), ShardError> {
    // Of equally near primitives the one with the lowest id wins.
    let [first, second] = if first.0.id < second.0.id { [first, second] } else { [second, first] };
    let both = BruteForce::new([first.1, second.1])?;
    let decided = both.certified_closest_point(query, &QueryOptions::default()).ok().flatten();
    Ok(if decided.is_some_and(|closest| closest.primitive.index() == 1) { second } else { first })
}

/// Returns the search for at most `k` primitives within a distance.
pub(crate) fn near(query: &Point3<f64>, k: usize, radius: f64) -> impl Search<Answer = Vec<ShardClosest>> + use<> {
    // The comparison is false for a radius of NaN.
    let radius = if k > 0 && radius >= 0.0 { largest_distance(query, radius) } else { f64::NAN };
    let largest = move |found: &Vec<(Key, ShardClosest)>| {
        found.get(k.wrapping_sub(1)).map_or(radius, |(_, last)| last.closest.distance)
    };
    collect(
        *query,
        Vec::new(),
        bound,
        move |found| limit(largest(found)),
        move |found, query, number, shard| {
            let near = shard.index().try_k_nearest(query, k, largest(found))?;
            found.try_reserve(near.len())?;
            found.extend(
                near.into_iter()
                    .map(|closest| (key(shard, &closest, query), ShardClosest::new(number, shard, closest))),
            );
            found.sort_unstable_by_key(|(key, answer)| (*key, answer.id));
            found.truncate(k);
            Ok(())
        },
        |found| found.into_iter().map(|(_, answer)| answer).collect(),
    )
}

/// Returns the search that decides whether any primitive is within a distance.
pub(crate) fn any_within(query: &Point3<f64>, radius: f64) -> impl Search<Answer = bool> + use<> {
    let radius = if radius >= 0.0 { largest_distance(query, radius) } else { f64::NAN };
    collect(
        *query,
        false,
        bound,
        move |is_within| if *is_within { f64::NAN } else { limit(radius) },
        move |is_within, query, _, shard| {
            *is_within = shard.index().is_any_within(query, radius);
            Ok(())
        },
        |is_within| is_within,
    )
}

impl ShardedIndex {
    /// Returns a bound on the error of the distance of every primitive (contract N1), rounded up.
    fn largest_error(&self, query: &Point3<f64>) -> f64 {
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
        self.answer(ClosestSearch::new(self, &query.point(), options))
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
        self.answer(certified(&query.point(), options))
    }

    /// Returns the nearest primitives, at most `k` and none beyond the radius, nearest first. The radius may be
    /// infinite. Each answer has a lower bound on the distance of its own primitive.
    ///
    /// # Errors
    /// It returns the [errors of loading a shard](ShardError#loading-a-shard).
    pub fn k_nearest(
        &self,
        query: &impl Position<f64>,
        k: usize,
        radius: f64,
    ) -> Result<Vec<ShardClosest>, ShardError> {
        self.answer(near(&query.point(), k, radius))
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
        self.answer(any_within(&query.point(), radius))
    }

    /// Returns the shard with the box that is nearest to a query, which is to be asked first, or `None` for a query
    /// that is not finite, an empty scene, and where no box is within the largest distance.
    ///
    /// # Complexity
    /// It takes O(s) for s shards, and loads none.
    #[must_use]
    pub fn nearest_shard(&self, query: &Point3<f64>, max_distance: f64) -> Option<usize> {
        let limit = limit(largest_distance(query, max_distance));
        least(self.boxes.iter().map(|bounds| bounds.lower_bound(query)), limit)
    }

    /// Returns all shards that may have a primitive as near as one that was found at `distance`, or a nearer one.
    ///
    /// # Complexity
    /// It takes O(s) for s shards, and loads none.
    pub fn shards_within(&self, query: &Point3<f64>, distance: f64) -> impl Iterator<Item = usize> {
        let limit = limit(reach(distance, self.largest_error(query)));
        let boxes = self.boxes.iter().enumerate();
        boxes.filter(move |(_, bounds)| bounds.lower_bound(query) <= limit).map(|(number, _)| number)
    }
}

/// Returns whether all coordinates of a query are finite.
pub(crate) fn is_finite(query: &Point3<f64>) -> bool {
    query.iter().all(|x| x.is_finite())
}
