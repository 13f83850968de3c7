//! Batches of queries, which all threads answer and which can be ended early.

use crate::nearest::{ClosestSearch, any_within, certified, near};
use crate::rays::{all_hits, any_hit, count, crossings, first_hit};
use crate::search::{Proceed, Search};
use crate::{ShardClosest, ShardError, ShardHit, ShardedIndex};
use p2m_core::engine::parallel;
use p2m_core::{Key, Position, QueryOptions, Ray};

/// A batch of queries. Its methods answer each query as the methods of [`ShardedIndex`] do, on all threads of the
/// current pool, and return the answers in the order of the queries.
///
/// ```
/// # use p2m_core::{Point, Soup};
/// # use p2m_shards::{ShardOptions, ShardWriter};
/// # let folder = tempfile::tempdir()?;
/// # let mut writer = ShardWriter::new(folder.path(), ShardOptions::default())?;
/// # let positions = [[0.0, 0.0, 0.0], [9.0, 0.0, 0.0], [0.0, 9.0, 0.0]];
/// # writer.add_scene(&Soup::from_arrays(&positions, &[[0u32, 1, 2]])?.into())?;
/// # let index = writer.finish()?;
/// let answers = index.batch().k_nearest(&[[1.0, 1.0, 3.0], [1.0, 1.0, -5.0]], 1, f64::INFINITY)?;
/// assert_eq!(answers[1][0].closest.distance, 5.0);
/// // All threads call this function from time to time.
/// let stopped = index.batch().with_proceed(&|_| false).is_any_within(&[[1.0, 1.0, 3.0]], 4.0);
/// assert!(stopped.is_err());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// All methods return the errors of the query, which include the
/// [errors of loading a shard](ShardError#loading-a-shard), and [`ShardError::Cancelled`] if the function of
/// [`with_proceed`](Self::with_proceed) has returned `false`.
///
/// # Complexity
/// A batch loads each shard at most twice, whatever the limit of memory is. Only with an epsilon or a limit on visits
/// is each query answered by itself, so shards may be loaded more often. Comparing n queries with the boxes of s shards
/// takes O(n s). Memory is about 250 bytes per query besides the answers, and 120 bytes per query of the
/// largest group that a shard answers.
#[derive(Clone, Copy)]
pub struct ShardBatch<'a> {
    index: &'a ShardedIndex,
    proceed: &'a Proceed<'a>,
}

/// The answers of a batch.
type Answers<A> = Result<Vec<A>, ShardError>;

impl ShardedIndex {
    /// Returns a batch, whose methods answer many queries.
    #[must_use]
    pub fn batch(&self) -> ShardBatch<'_> {
        ShardBatch { index: self, proceed: &|_| true }
    }
}

impl<'a> ShardBatch<'a> {
    /// Sets a function that decides whether to go on. All threads call it from time to time with the number of queries
    /// that they have answered since their last call. A query that needs several shards counts once.
    #[must_use]
    pub fn with_proceed(self, proceed: &'a Proceed<'a>) -> Self {
        Self { proceed, ..self }
    }

    fn answer<Q: Sync, S: Search>(self, queries: &[Q], begin: impl Fn(&Q) -> S + Sync) -> Answers<S::Answer> {
        self.index.answer_all(queries, begin, self.proceed)
    }

    /// Answers as [`ShardedIndex::closest_point_with`]. Only the last bits of lower bounds may differ, and they do not
    /// depend on the other queries of the batch.
    ///
    /// # Errors
    /// See the [errors of all batches](Self#errors).
    pub fn closest_points(
        self,
        queries: &[impl Position<f64>],
        options: &QueryOptions<f64>,
    ) -> Answers<Option<ShardClosest>> {
        self.answer(queries, |query| ClosestSearch::new(self.index, &query.point(), options))
    }

    /// Answers as [`ShardedIndex::certified_closest_point`].
    ///
    /// # Errors
    /// See the [errors of all batches](Self#errors).
    pub fn certified_closest_points(
        self,
        queries: &[impl Position<f64>],
        options: &QueryOptions<f64>,
    ) -> Answers<Option<ShardClosest>> {
        self.answer(queries, |query| certified(&query.point(), options))
    }

    /// Answers as [`ShardedIndex::k_nearest`].
    ///
    /// # Errors
    /// See the [errors of all batches](Self#errors).
    pub fn k_nearest(self, queries: &[impl Position<f64>], k: usize, radius: f64) -> Answers<Vec<ShardClosest>> {
        self.answer(queries, |query| near(&query.point(), k, radius))
    }

    /// Answers as [`ShardedIndex::is_any_within`].
    ///
    /// # Errors
    /// See the [errors of all batches](Self#errors).
    pub fn is_any_within(self, queries: &[impl Position<f64>], radius: f64) -> Answers<bool> {
        self.answer(queries, |query| any_within(&query.point(), radius))
    }

    /// Answers as [`ShardedIndex::contains`].
    ///
    /// # Errors
    /// See the [errors of all batches](Self#errors).
    pub fn contains(self, queries: &[impl Position<f64>]) -> Answers<bool> {
        let rule = self.index.sign_rule()?;
        self.answer(queries, |query| self.index.inside(rule, &query.point()))
    }

    /// Answers as [`ShardedIndex::first_intersection`].
    ///
    /// # Errors
    /// See the [errors of all batches](Self#errors).
    pub fn first_intersections(self, rays: &[Ray]) -> Answers<Option<ShardHit>> {
        self.answer(rays, first_hit)
    }

    /// Answers as [`ShardedIndex::all_intersections`].
    ///
    /// # Errors
    /// See the [errors of all batches](Self#errors).
    pub fn all_intersections(self, rays: &[Ray]) -> Answers<Vec<ShardHit>> {
        self.answer(rays, all_hits)
    }

    /// Answers as [`ShardedIndex::count`].
    ///
    /// # Errors
    /// See the [errors of all batches](Self#errors).
    pub fn count(self, rays: &[Ray]) -> Answers<usize> {
        self.answer(rays, count)
    }

    /// Answers as [`ShardedIndex::crossings`].
    ///
    /// # Errors
    /// See the [errors of all batches](Self#errors).
    pub fn crossings(self, rays: &[Ray]) -> Answers<usize> {
        self.answer(rays, crossings)
    }

    /// Answers as [`ShardedIndex::do_intersect`].
    ///
    /// # Errors
    /// See the [errors of all batches](Self#errors).
    pub fn do_intersect(self, rays: &[Ray]) -> Answers<bool> {
        self.answer(rays, any_hit)
    }

    /// Answers queries by one shard alone, each with the key of the answer.
    ///
    /// To answer for the whole scene, ask all shards that [`nearest_shard`](ShardedIndex::nearest_shard) and
    /// [`shards_within`](ShardedIndex::shards_within) name. The answer is the one with the least key, and of equal keys
    /// the one with the lowest id. A hint is ignored.
    ///
    /// # Errors
    /// See the [errors of all batches](Self#errors).
    ///
    /// # Panics
    /// It panics if the manifest has no such shard.
    ///
    /// # Complexity
    /// The shard is loaded at most once, and not at all without queries.
    pub fn closest_points_in_shard(
        self,
        number: usize,
        queries: &[impl Position<f64>],
        options: &QueryOptions<f64>,
    ) -> Answers<Option<(ShardClosest, Key)>> {
        if queries.is_empty() {
            return Ok(Vec::new());
        }
        let shard = self.index.shard(number)?;
        let begin = |query: &_| ClosestSearch::new(self.index, &Position::point(query), options);
        let mut searches: Vec<ClosestSearch> = parallel::map_slice(queries, true, begin);
        ClosestSearch::ask_first(&mut searches.iter_mut().collect::<Vec<_>>(), number, &shard, self.proceed)?;
        Ok(parallel::map_owned(searches, true, |search| search.finish_with_key(&shard)))
    }
}
