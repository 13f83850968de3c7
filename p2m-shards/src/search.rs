//! The search for the answer to a query of any kind, by itself or in a batch: shards are asked until no other one can
//! matter.

use crate::{Shard, ShardError, ShardedIndex};
use p2m_core::Aabb;
use p2m_core::engine::parallel;

/// Receives a number of answered queries, and returns whether to go on.
pub type Proceed<'a> = dyn Fn(usize) -> bool + Sync + 'a;

/// Reports a number of answered queries. Returns [`ShardError::Cancelled`] if `proceed` returned `false`.
pub(crate) fn go_on(proceed: &Proceed<'_>, answered: usize) -> Result<(), ShardError> {
    if proceed(answered) { Ok(()) } else { Err(ShardError::Cancelled) }
}

/// The state of a query that asks shards one after the other.
pub(crate) trait Search: Send + Sync + Sized {
    /// The type of an answer.
    type Answer: Send;

    /// Returns the bound of the box of a shard, by which shards are ordered. NaN rules the shard out.
    fn bound(&self, bounds: &Aabb<f64>) -> f64;

    /// Returns the largest bound of a shard that may still matter, or NaN if none does.
    fn limit(&self) -> f64;

    /// Asks a shard.
    fn ask(&mut self, number: usize, shard: &Shard) -> Result<(), ShardError>;

    /// Asks a shard for queries that have asked no other one, on all threads of the current pool.
    fn ask_first(
        group: &mut [&mut Self],
        number: usize,
        shard: &Shard,
        proceed: &Proceed<'_>,
    ) -> Result<(), ShardError> {
        // Threads share the progress, so they report several queries at a time.
        parallel::try_for_each_chunk(group, ASKED_LEN, true, |_, searches| {
            searches.iter_mut().try_for_each(|search| search.ask(number, shard))?;
            go_on(proceed, searches.len())
        })
    }

    /// Prepares the answer of the shard that was asked last for the comparison with answers of other shards.
    fn prepare_for_others(&mut self, _: &Shard) {}

    /// Returns whether the answer depends on the order of the shards, which are then asked in the order of their
    /// bounds.
    fn depends_on_order(&self) -> bool {
        false
    }

    /// Returns the answer.
    fn finish(self) -> Self::Answer;
}

/// A search that is given by functions, and asks all shards in the same way.
struct Collecting<Q, F, L, A, E> {
    query: Q,
    found: F,
    bound: fn(&Q, &Aabb<f64>) -> f64,
    limit: L,
    ask: A,
    finish: E,
}

/// Returns a search that collects what shards find, beginning with `found`: `bound` is [`Search::bound`] of the query,
/// `limit` is [`Search::limit`] of what was found so far, `ask` adds what a shard finds, and `finish` makes the answer.
pub(crate) fn collect<Q: Send + Sync, F: Send + Sync, R: Send>(
    query: Q,
    found: F,
    bound: fn(&Q, &Aabb<f64>) -> f64,
    limit: impl Fn(&F) -> f64 + Send + Sync,
    ask: impl Fn(&mut F, &Q, usize, &Shard) -> Result<(), ShardError> + Send + Sync,
    finish: impl Fn(F) -> R + Send + Sync,
) -> impl Search<Answer = R> {
    Collecting { query, found, bound, limit, ask, finish }
}

impl<Q, F, L, A, E, R> Search for Collecting<Q, F, L, A, E>
where
    Q: Send + Sync,
    F: Send + Sync,
    L: Fn(&F) -> f64 + Send + Sync,
    A: Fn(&mut F, &Q, usize, &Shard) -> Result<(), ShardError> + Send + Sync,
    E: Fn(F) -> R + Send + Sync,
    R: Send,
{
    type Answer = R;

    fn bound(&self, bounds: &Aabb<f64>) -> f64 {
        (self.bound)(&self.query, bounds)
    }

    fn limit(&self) -> f64 {
        (self.limit)(&self.found)
    }

    fn ask(&mut self, number: usize, shard: &Shard) -> Result<(), ShardError> {
        (self.ask)(&mut self.found, &self.query, number, shard)
    }

    fn finish(self) -> R {
        (self.finish)(self.found)
    }
}

/// A query of a batch, with the state of its search.
struct Pending<S> {
    search: S,
    /// The shard with the least bound, which the first phase asks, or [`NONE`].
    first: usize,
    /// The limit of the search.
    limit: f64,
}

/// The number of queries that a thread handles at a time.
pub(crate) const CHUNK_LEN: usize = 1024;
/// The number of queries for which a thread asks a shard at a time.
const ASKED_LEN: usize = 16;
/// The number that stands for no shard.
const NONE: usize = usize::MAX;

impl ShardedIndex {
    /// Asks the shards for one query, in the order of their bounds.
    ///
    /// Few shards are asked, so looking for each among all costs less than sorting them.
    pub(crate) fn answer<S: Search>(&self, mut search: S) -> Result<S::Answer, ShardError> {
        let mut bounds: Vec<f64> = self.boxes.iter().map(|bounds| search.bound(bounds)).collect();
        let mut next = least(bounds.iter().copied(), search.limit());
        while let Some(number) = next {
            bounds[number] = f64::NAN;
            let shard = self.shard(number)?;
            search.ask(number, &shard)?;
            next = least(bounds.iter().copied(), search.limit());
            if next.is_some() {
                search.prepare_for_others(&shard);
            }
        }
        Ok(search.finish())
    }

    /// Answers a batch of queries in two phases, each of which loads a shard at most once: each query asks the shard
    /// with the least bound, and then every other shard that may matter.
    pub(crate) fn answer_all<Q: Sync, S: Search>(
        &self,
        queries: &[Q],
        begin: impl Fn(&Q) -> S + Sync,
        proceed: &Proceed<'_>,
    ) -> Result<Vec<S::Answer>, ShardError> {
        let pending = |query: &Q| {
            let search = begin(query);
            let limit = if search.depends_on_order() { f64::NAN } else { search.limit() };
            let first = least(self.boxes.iter().map(|bounds| search.bound(bounds)), limit).unwrap_or(NONE);
            Pending { search, first, limit }
        };
        let chunks: Vec<&[Q]> = queries.chunks(CHUNK_LEN).collect();
        let mut all: Vec<Vec<Pending<S>>> = parallel::try_map(chunks.len(), true, |chunk| {
            go_on(proceed, 0)?;
            Ok::<_, ShardError>(chunks[chunk].iter().map(pending).collect())
        })?;
        self.ask_first(all.iter_mut().flatten(), proceed)?;
        // Most queries need no other shard, so the queries that do are found once.
        let mut open: Vec<&mut Pending<S>> = all.iter_mut().flatten().filter(|one| !one.limit.is_nan()).collect();
        for (number, bounds) in self.boxes.iter().enumerate() {
            let is_needed = |one: &&mut Pending<S>| one.first != number && one.search.bound(bounds) <= one.limit;
            let is_needed = parallel::map_slice(&open, true, is_needed);
            let mut group: Vec<_> = open.iter_mut().zip(is_needed).filter_map(|(one, is)| is.then_some(one)).collect();
            if group.is_empty() {
                continue;
            }
            let shard = self.shard(number)?;
            parallel::try_for_each_chunk(&mut group, ASKED_LEN, true, |_, group| {
                group.iter_mut().try_for_each(|one| {
                    go_on(proceed, 0)?;
                    one.search.ask(number, &shard)?;
                    one.search.prepare_for_others(&shard);
                    one.limit = one.search.limit();
                    Ok::<(), ShardError>(())
                })
            })?;
        }
        let finish = |Pending { search, .. }: Pending<S>| {
            if search.depends_on_order() {
                return self.answer(search).and_then(|answer| go_on(proceed, 1).map(|()| answer));
            }
            Ok(search.finish())
        };
        let finish_chunk = |chunk: Vec<Pending<S>>| chunk.into_iter().map(finish).collect::<Result<Vec<_>, _>>();
        Ok(parallel::try_map_owned(all, true, finish_chunk)?.into_iter().flatten().collect())
    }

    /// Asks for each query the shard with the least bound. The limits of queries that need no other shard become NaN.
    fn ask_first<'p, S: Search + 'p>(
        &self,
        all: impl Iterator<Item = &'p mut Pending<S>>,
        proceed: &Proceed<'_>,
    ) -> Result<(), ShardError> {
        let mut groups: Vec<Vec<&mut Pending<S>>> = self.boxes.iter().map(|_| Vec::new()).collect();
        for one in all {
            if let Some(group) = groups.get_mut(one.first) {
                group.push(one);
            } else {
                one.limit = f64::NAN;
            }
        }
        for (number, mut group) in groups.into_iter().enumerate().filter(|(_, group)| !group.is_empty()) {
            let shard = self.shard(number)?;
            let mut searches: Vec<&mut S> = group.iter_mut().map(|one| &mut one.search).collect();
            S::ask_first(&mut searches, number, &shard, proceed)?;
            let needs_others = |one: &Pending<S>| {
                let mut boxes = self.boxes.iter().enumerate();
                boxes.any(|(other, bounds)| other != number && one.search.bound(bounds) <= one.search.limit())
            };
            parallel::for_each_chunk(&mut group, CHUNK_LEN, true, |_, group| {
                for one in group {
                    one.limit = f64::NAN;
                    if needs_others(one) {
                        one.limit = one.search.limit();
                        one.search.prepare_for_others(&shard);
                    }
                }
            });
        }
        Ok(())
    }
}

/// Returns the position of the least of some bounds that are at most a limit.
pub(crate) fn least(bounds: impl Iterator<Item = f64>, limit: f64) -> Option<usize> {
    let within = bounds.enumerate().filter(|(_, bound)| *bound <= limit);
    within.reduce(|best, next| if next.1 < best.1 { next } else { best }).map(|(number, _)| number)
}
