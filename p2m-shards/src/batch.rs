//! Batches of queries in two phases, each of which loads a shard at most once.

use crate::nearest::{
    ByBound, CertifiedSearch, NearSearch, Search, ShardClosest, key, least, limit, may_have_answer, reach,
};
use crate::{Shard, ShardError, ShardedIndex};
use nalgebra::Point3;
use p2m_core::batch::{BatchOptions, Interruptible, closest_points_into};
use p2m_core::{Closest, Key, Position, QueryOptions};
use rayon::prelude::*;

/// The number that stands for no shard.
const NONE: u32 = u32::MAX;

/// A function that is called with a number of answered queries, and returns whether to go on.
pub type Proceed<'a> = dyn Fn(usize) -> bool + Sync + 'a;

/// The state of a query between the phases.
#[derive(Clone, Copy)]
struct Pending {
    /// The shard with the nearest box, which the first phase asks.
    nearest: u32,
    /// The square above which a shard is not needed any more.
    limit: f64,
    /// The key of the answer so far, if another shard may have as near a primitive.
    key: Option<Key>,
}

impl ShardedIndex {
    /// Answers `queries` into `out`, in their order, on all threads of the current pool.
    ///
    /// The answers are those of [`closest_point_with`](Self::closest_point_with). Only the last bits of lower bounds
    /// may differ, and they do not depend on the other queries of the batch.
    ///
    /// # Errors
    /// It returns the [errors of loading a shard](ShardError#loading-a-shard). The content of `out` is then undefined.
    ///
    /// # Panics
    /// It panics if the slices differ in length.
    ///
    /// # Complexity
    /// Each shard is loaded at most twice, whatever the limit of memory is. With an epsilon or a limit on visits each
    /// query is answered by itself, so shards may be loaded more often. Comparing n queries with the boxes of s shards
    /// takes O(n s). Memory is 40 bytes for each query besides the answers, and about 200 bytes for each query of the
    /// largest group that a shard answers.
    pub fn closest_points_into(
        &self,
        queries: &[impl Position<f64>],
        options: &QueryOptions<f64>,
        out: &mut [Option<ShardClosest>],
    ) -> Result<(), ShardError> {
        self.closest_points_while(queries, options, out, &|_| true)
    }

    /// Answers a batch as [`closest_points_into`](Self::closest_points_into) does, as long as `proceed` returns `true`.
    ///
    /// All threads call it from time to time with the number of queries that they have answered since their last call.
    /// A query that needs several shards counts once.
    ///
    /// # Errors
    /// It returns the errors of [`closest_points_into`](Self::closest_points_into), and [`ShardError::Cancelled`] if
    /// `proceed` has returned `false`. The content of `out` is then undefined.
    ///
    /// # Panics
    /// It panics if the slices differ in length.
    pub fn closest_points_while(
        &self,
        queries: &[impl Position<f64>],
        options: &QueryOptions<f64>,
        out: &mut [Option<ShardClosest>],
        proceed: &Proceed<'_>,
    ) -> Result<(), ShardError> {
        assert_eq!(queries.len(), out.len(), "one answer for each query");
        let mut options = *options;
        // A hint is an id within one shard.
        options.hint = None;
        if options.is_approximate() {
            // What a search leaves out on purpose depends on the order of shards, so each query has its own.
            return queries.par_iter().zip(out).try_for_each(|(query, answer)| {
                *answer = self.closest_point_with(&query.point(), &options)?;
                if proceed(1) { Ok(()) } else { Err(ShardError::Cancelled) }
            });
        }
        let mut pending: Vec<Pending> = queries.par_iter().map(|query| self.begin(&query.point(), &options)).collect();
        out.par_iter_mut().for_each(|answer| *answer = None);
        self.ask_nearest(queries, &options, &mut pending, out, proceed)?;
        self.ask_others(queries, &options, &mut pending, out, proceed)
    }

    /// Answers each query as [`k_nearest`](Self::k_nearest) does, on all threads of the current pool.
    ///
    /// # Errors
    /// It returns the [errors of loading a shard](ShardError#loading-a-shard).
    ///
    /// # Complexity
    /// Each shard is loaded at most twice, and comparing n queries with the boxes of s shards takes O(n s).
    pub fn all_k_nearest(
        &self,
        queries: &[impl Position<f64>],
        k: usize,
        radius: f64,
    ) -> Result<Vec<Vec<ShardClosest>>, ShardError> {
        self.all_k_nearest_while(queries, k, radius, &|_| true)
    }

    /// Answers a batch as [`all_k_nearest`](Self::all_k_nearest) does, as long as `proceed` returns `true`, which is
    /// called as [`closest_points_while`](Self::closest_points_while) calls it.
    ///
    /// # Errors
    /// It returns the errors of [`all_k_nearest`](Self::all_k_nearest), and [`ShardError::Cancelled`] if `proceed` has
    /// returned `false`.
    ///
    /// # Complexity
    /// It is that of [`all_k_nearest`](Self::all_k_nearest).
    pub fn all_k_nearest_while(
        &self,
        queries: &[impl Position<f64>],
        k: usize,
        radius: f64,
        proceed: &Proceed<'_>,
    ) -> Result<Vec<Vec<ShardClosest>>, ShardError> {
        let searches = self.search_all(queries, |query| NearSearch::new(query, k, radius), proceed)?;
        Ok(searches.into_par_iter().map(NearSearch::finish).collect())
    }

    /// Answers each query as [`certified_closest_point`](Self::certified_closest_point) does, on all threads of the
    /// current pool.
    ///
    /// # Errors
    /// It returns the [errors of loading a shard](ShardError#loading-a-shard).
    ///
    /// # Complexity
    /// Each shard is loaded at most twice, and comparing n queries with the boxes of s shards takes O(n s).
    pub fn certified_closest_points(
        &self,
        queries: &[impl Position<f64>],
        options: &QueryOptions<f64>,
    ) -> Result<Vec<Option<ShardClosest>>, ShardError> {
        self.certified_closest_points_while(queries, options, &|_| true)
    }

    /// Answers a batch as [`certified_closest_points`](Self::certified_closest_points) does, as long as `proceed`
    /// returns `true`, which is called as [`closest_points_while`](Self::closest_points_while) calls it.
    ///
    /// # Errors
    /// It returns the errors of [`certified_closest_points`](Self::certified_closest_points), and
    /// [`ShardError::Cancelled`] if `proceed` has returned `false`.
    ///
    /// # Complexity
    /// It is that of [`certified_closest_points`](Self::certified_closest_points).
    pub fn certified_closest_points_while(
        &self,
        queries: &[impl Position<f64>],
        options: &QueryOptions<f64>,
        proceed: &Proceed<'_>,
    ) -> Result<Vec<Option<ShardClosest>>, ShardError> {
        let searches = self.search_all(queries, |query| CertifiedSearch::new(query, options), proceed)?;
        let finish = |(search, query): (CertifiedSearch, &_)| {
            if proceed(0) { search.finish(&Position::point(query), options) } else { Err(ShardError::Cancelled) }
        };
        searches.into_par_iter().zip(queries).map(finish).collect()
    }

    /// Answers queries by one shard alone, on all threads of the current pool, as long as `proceed` returns `true`,
    /// which is called as [`closest_points_while`](Self::closest_points_while) calls it. Each answer
    /// comes with its key.
    ///
    /// Of the answers of all shards that [`nearest_shard`](Self::nearest_shard) and
    /// [`shards_within`](Self::shards_within) name, the one with the least key, and of equal keys with the lowest id,
    /// is the answer of the whole scene. A hint is ignored.
    ///
    /// # Errors
    /// It returns the [errors of loading a shard](ShardError#loading-a-shard), and
    /// [`ShardError::Cancelled`] if `proceed` has returned `false`.
    ///
    /// # Panics
    /// It panics if the manifest has no such shard.
    ///
    /// # Complexity
    /// The shard is loaded at most once, and not at all without queries.
    pub fn closest_points_in_shard_while(
        &self,
        number: usize,
        queries: &[impl Position<f64>],
        options: &QueryOptions<f64>,
        proceed: &Proceed<'_>,
    ) -> Result<Vec<Option<(ShardClosest, Key)>>, ShardError> {
        if queries.is_empty() {
            return Ok(Vec::new());
        }
        let mut options = *options;
        options.hint = None;
        let shard = self.shard(number)?;
        let queries: Vec<Point3<f64>> = queries.par_iter().map(Position::point).collect();
        let answers = ask(&shard, &queries, &options, proceed)?;
        let with_key = |(query, answer): (&_, Option<Closest<f64>>)| {
            answer.map(|closest| (ShardClosest::new(number, &shard, closest), key(&shard, &closest, query)))
        };
        Ok(queries.par_iter().zip(answers).map(with_key).collect())
    }

    /// Returns the shard with the box that is nearest to a query, which is to be asked first, or `None` for a query
    /// that is not finite, an empty scene, and where no box is within the largest distance.
    ///
    /// # Complexity
    /// It takes O(s) for s shards, and loads none.
    #[must_use]
    pub fn nearest_shard(&self, query: &Point3<f64>, max_distance: f64) -> Option<usize> {
        if !may_have_answer(query, max_distance) {
            return None;
        }
        let bounds = self.boxes.iter().map(|bounds| bounds.lower_bound(query));
        least(bounds, limit(max_distance)).map(|(number, _)| number)
    }

    /// Returns all shards that may have a primitive as near as one that was found at `distance`, or a nearer one.
    ///
    /// # Complexity
    /// It takes O(s) for s shards, and loads none.
    pub fn shards_within(&self, query: &Point3<f64>, distance: f64) -> impl Iterator<Item = usize> {
        self.shards_up_to(query, self.limit_of(query, distance, f64::INFINITY))
    }

    /// Returns all shards whose boxes are not beyond a limit on squared distances.
    fn shards_up_to(&self, query: &Point3<f64>, limit: f64) -> impl Iterator<Item = usize> {
        let boxes = self.boxes.iter().enumerate();
        boxes.filter(move |(_, bounds)| bounds.lower_bound(query) <= limit).map(|(number, _)| number)
    }

    /// Searches for all queries: each asks the shard with the nearest box, and then every other one that may matter.
    fn search_all<S: Search + Send + Sync>(
        &self,
        queries: &[impl Position<f64>],
        begin: impl Fn(&Point3<f64>) -> S + Sync,
        proceed: &Proceed<'_>,
    ) -> Result<Vec<S>, ShardError> {
        let first = |query: &_| {
            let query = Position::point(query);
            let search = begin(&query);
            let nearest = ByBound::new(&self.boxes, &query).take(search.prune_above());
            (search, nearest.map(|(number, _)| number))
        };
        let mut searches: Vec<(S, Option<usize>)> = queries.par_iter().map(first).collect();
        for is_nearest in [true, false] {
            for (number, bounds) in self.boxes.iter().enumerate() {
                let needs = |(search, nearest): &(S, Option<usize>), query: &Point3<f64>| {
                    (*nearest == Some(number)) == is_nearest && bounds.lower_bound(query) <= search.prune_above()
                };
                let is_needed = |(search, query): (&(S, Option<usize>), &_)| needs(search, &Position::point(query));
                if !searches.par_iter().zip(queries).any(is_needed) {
                    continue;
                }
                let shard = self.shard(number)?;
                searches.par_iter_mut().zip(queries).try_for_each(|(search, query)| {
                    let query = query.point();
                    if !needs(search, &query) {
                        return Ok(());
                    }
                    search.0.ask(&query, number, &shard);
                    if proceed(usize::from(is_nearest)) { Ok(()) } else { Err(ShardError::Cancelled) }
                })?;
            }
        }
        Ok(searches.into_iter().map(|(search, _)| search).collect())
    }

    /// Returns the shard that a query asks first.
    fn begin(&self, query: &Point3<f64>, options: &QueryOptions<f64>) -> Pending {
        let nearest = self.nearest_shard(query, options.max_distance);
        nearest.map_or(Pending { nearest: NONE, limit: f64::NEG_INFINITY, key: None }, |number| Pending {
            nearest: u32::try_from(number).unwrap_or(NONE),
            limit: limit(options.max_distance),
            key: None,
        })
    }

    /// Asks for each query the shard with the nearest box.
    fn ask_nearest(
        &self,
        queries: &[impl Position<f64>],
        options: &QueryOptions<f64>,
        pending: &mut [Pending],
        out: &mut [Option<ShardClosest>],
        proceed: &Proceed<'_>,
    ) -> Result<(), ShardError> {
        let mut groups: Vec<Vec<usize>> = vec![Vec::new(); self.boxes.len()];
        for (i, one) in pending.iter().enumerate() {
            if one.nearest != NONE {
                groups[one.nearest as usize].push(i);
            }
        }
        for (number, group) in groups.into_iter().enumerate().filter(|(_, group)| !group.is_empty()) {
            let shard = self.shard(number)?;
            let asked: Vec<Point3<f64>> = group.par_iter().map(|i| queries[*i].point()).collect();
            let answers = ask(&shard, &asked, options, proceed)?;
            let rest = |(query, answer): (&Point3<f64>, &Option<Closest<f64>>)| {
                let closest = answer.as_ref()?;
                let limit = self.limit_of(query, closest.distance, options.max_distance);
                let has_others = self.shards_up_to(query, limit).any(|other| other != number);
                Some((limit, has_others.then(|| key(&shard, closest, query))))
            };
            let rests: Vec<_> = asked.par_iter().zip(&answers).map(rest).collect();
            for ((i, answer), rest) in group.into_iter().zip(answers).zip(rests) {
                if let (Some(closest), Some((limit, key))) = (answer, rest) {
                    pending[i] = Pending { limit, key, ..pending[i] };
                    out[i] = Some(ShardClosest::new(number, &shard, closest));
                }
            }
        }
        Ok(())
    }

    /// Asks all other shards that may have something as near as what was found.
    fn ask_others(
        &self,
        queries: &[impl Position<f64>],
        options: &QueryOptions<f64>,
        pending: &mut [Pending],
        out: &mut [Option<ShardClosest>],
        proceed: &Proceed<'_>,
    ) -> Result<(), ShardError> {
        // Most queries need no other shard, so those that do are found once.
        let may_need = |i: &usize| pending[*i].key.is_some() || (pending[*i].nearest != NONE && out[*i].is_none());
        let open: Vec<usize> = (0..queries.len()).into_par_iter().filter(may_need).collect();
        for (number, bounds) in self.boxes.iter().enumerate() {
            let is_needed = |i: &usize| {
                let one = &pending[*i];
                one.nearest as usize != number && bounds.lower_bound(&queries[*i].point()) <= one.limit
            };
            let group: Vec<usize> = open.par_iter().copied().filter(is_needed).collect();
            if group.is_empty() {
                continue;
            }
            let shard = self.shard(number)?;
            let ask = |i: &usize| {
                if !proceed(0) {
                    return Err(ShardError::Cancelled);
                }
                let query = queries[*i].point();
                let error = self.largest_error(&query);
                let best = out[*i].map_or(f64::INFINITY, |best| reach(best.closest.distance, error));
                let within = options.with_max_distance(options.max_distance.min(best));
                let closest = shard.index().closest_point_with(&query, &within);
                Ok(closest.map(|closest| (closest, key(&shard, &closest, &query))))
            };
            let answers: Vec<Option<(Closest<f64>, Key)>> = group.par_iter().map(ask).collect::<Result<_, _>>()?;
            for (i, answer) in group.into_iter().zip(answers) {
                let Some((closest, key)) = answer else { continue };
                let answer = ShardClosest::new(number, &shard, closest);
                let best = out[i].zip(pending[i].key);
                let bound = best.map_or(f64::INFINITY, |(best, _)| best.closest.lower_bound);
                let is_winner = best.is_none_or(|(best, best_key)| (key, answer.id) < (best_key, best.id));
                let (mut winner, key) = best.filter(|_| !is_winner).unwrap_or((answer, key));
                winner.closest.lower_bound = bound.min(closest.lower_bound);
                let limit = self.limit_of(&queries[i].point(), winner.closest.distance, options.max_distance);
                pending[i] = Pending { limit, key: Some(key), ..pending[i] };
                out[i] = Some(winner);
            }
        }
        Ok(())
    }

    /// Returns the square above which no shard is needed for a query whose best answer has this distance.
    fn limit_of(&self, query: &Point3<f64>, distance: f64, max_distance: f64) -> f64 {
        limit(max_distance.min(reach(distance, self.largest_error(query))))
    }
}

/// Answers queries by one shard on all threads of the current pool, and in the order of the batches of the library.
fn ask(
    shard: &Shard,
    queries: &[Point3<f64>],
    options: &QueryOptions<f64>,
    proceed: &Proceed<'_>,
) -> Result<Vec<Option<Closest<f64>>>, ShardError> {
    let mut answers = vec![None; queries.len()];
    let interruptible = Interruptible::new(shard.index(), |left, answer| {
        if !proceed(0) {
            return false;
        }
        answer(left);
        proceed(left)
    });
    closest_points_into(&interruptible, queries, options, &BatchOptions::default(), &mut answers);
    if proceed(0) { Ok(answers) } else { Err(ShardError::Cancelled) }
}
