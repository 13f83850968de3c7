//! The loop that answers queries block by block on all threads, and writes the records of their answers.
//!
//! While the threads answer and encode one block, the calling thread writes the records of the block before it and
//! makes the queries of the block after it. So the threads wait for the file or the
//! source of the queries only if these are slower than answering.

use crate::answers::table::{Header, Table};
use crate::io::{Output, Progress, Session, Streams, Unit};
use indicatif::{DecimalBytes, HumanCount, HumanDuration};
use p2m_core::engine::parallel;
use std::time::{Duration, Instant};

/// The largest number of queries of a block. The records of two blocks are in memory at a time.
const MAX_BLOCK: usize = 1 << 14;
/// The time of a block. Shorter ones are followed by larger blocks and longer ones by smaller, so that progress is
/// shown often enough.
const BLOCK_TIME: Duration = Duration::from_millis(100);
/// The number of bytes of the records of a block, above which the next block is smaller.
const MAX_BLOCK_BYTES: usize = 1 << 25;
/// The number of answers that one thread encodes at a time.
const ANSWERS_PER_TASK: usize = 1 << 11;

/// The numbers of queries of blocks.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum BlockSize {
    /// Blocks are as large as the time of the block before them allows.
    Adaptive,
    /// Every block has this number of queries, because what a block costs depends little on how many it has.
    Fixed(usize),
}

impl BlockSize {
    /// The block size of an index in shards. A block may load every shard, however few queries it has.
    pub(crate) const OF_SHARDS: Self = Self::Fixed(1 << 18);
}

/// A stream of points or rays to query with.
pub(crate) struct QueryStream<I> {
    /// The name of the queries in messages, in the plural.
    pub(crate) name: &'static str,
    /// The number of queries that `iter` returns.
    pub(crate) count: u64,
    pub(crate) iter: I,
    pub(crate) block_size: BlockSize,
}

/// The records of some answers.
struct Encoded {
    records: u64,
    bytes: Vec<u8>,
}

/// A block of queries with their answers.
struct Block<Q, A> {
    queries: Vec<Q>,
    answers: Vec<A>,
    encoded: Vec<Encoded>,
}

impl<Q, A> Block<Q, A> {
    /// Returns the number of bytes of all records.
    fn bytes(&self) -> usize {
        self.encoded.iter().map(|part| part.bytes.len()).sum()
    }
}

/// The functions that turn queries into records.
pub(crate) struct Steps<Answer, Encode, Take> {
    /// Answers some queries on all threads of the current pool.
    pub(crate) answer: Answer,
    /// Appends the records of a query, given its number and its answer, and returns how many there are.
    pub(crate) encode: Encode,
    /// Takes each query with its answer, in order, for a summary.
    pub(crate) take: Take,
}

/// Answers queries on all threads of a pool, and writes the records of their answers in order to a file, if there is
/// one. The file is given with its header, and with the number of its records if it is known. Returns the time that
/// the answers took.
///
/// # Errors
/// It returns the first error of answering or writing, after which nothing more is answered.
pub(crate) fn answer_all<Q: Send + Sync, A: Send + Sync>(
    session: &Session<'_>,
    queries: &mut QueryStream<impl Iterator<Item = Q>>,
    file: Option<(&mut Output<'_>, Header, Option<u64>)>,
    steps: Steps<
        impl Fn(&[Q]) -> anyhow::Result<Vec<A>> + Sync,
        impl Fn(u64, &Q, &A, &mut Vec<u8>) -> u64 + Sync,
        impl FnMut(&Q, &A),
    >,
) -> anyhow::Result<Duration> {
    let Steps { answer, encode, mut take } = steps;
    let cannot_write = file.as_ref().map(|(output, ..)| output.cannot_write()).unwrap_or_default();
    let failed = |error| anyhow::Error::new(error).context(cannot_write.clone());
    let mut table =
        file.map(|(output, header, count)| Table::new(output, header, count)).transpose().map_err(failed)?;
    let progress = Progress::start(session.streams, "answering", Some(queries.count), Unit::Items(queries.name));
    // A query by brute force can take milliseconds, and one with many answers much memory.
    let min_block = match queries.block_size {
        BlockSize::Adaptive => session.pool.current_num_threads(),
        BlockSize::Fixed(size) => size,
    };
    let (mut time, mut first, mut size) = (Duration::ZERO, 0, min_block);
    let mut finished: Option<Block<Q, A>> = None;
    let mut pending: Vec<Q> = queries.iter.by_ref().take(size).collect();
    let mut write_block = |block: Block<Q, A>| {
        block.queries.iter().zip(&block.answers).for_each(|(query, answer)| take(query, answer));
        let mut parts = block.encoded.iter();
        parts.try_for_each(|part| table.as_mut().map_or(Ok(()), |table| table.write(part.records, &part.bytes)))
    };
    while !pending.is_empty() {
        let mut answered = None;
        let (written, next) = session.pool.in_place_scope(|scope| {
            let (block, answered) = (std::mem::take(&mut pending), &mut answered);
            scope.spawn(|_| {
                let start = Instant::now();
                let answers = answer(&block);
                let elapsed = start.elapsed();
                *answered = Some(answers.map(|answers| {
                    let encoded = encode_all(first, &block, &answers, &encode);
                    (Block { queries: block, answers, encoded }, elapsed)
                }));
            });
            let written = finished.take().map_or(Ok(()), &mut write_block);
            (written, queries.iter.by_ref().take(size).collect())
        });
        written.map_err(failed)?;
        let (block, elapsed) = answered.expect("the scope ends after its task")?;
        let (count, bytes) = (block.queries.len() as u64, block.bytes());
        if first == 0 {
            announce(session.streams, queries, count, bytes, elapsed);
        }
        time += elapsed;
        first += count;
        progress.add(count);
        let is_small = elapsed < BLOCK_TIME && bytes < MAX_BLOCK_BYTES;
        if queries.block_size == BlockSize::Adaptive {
            size = if is_small { MAX_BLOCK.min(2 * size) } else { min_block.max(size / 2) };
        }
        (finished, pending) = (Some(block), next);
    }
    finished.map_or(Ok(()), write_block).map_err(failed)?;
    table.map_or(Ok(()), |table| table.finish().map(drop)).map_err(failed)?;
    Ok(time)
}

/// The number of bytes of answers, 10 GB, above which a run is announced.
const ANNOUNCED_BYTES: f64 = 1e10;
/// The number of seconds of answering above which a run is announced.
const ANNOUNCED_SECONDS: f64 = 600.0;

/// Estimates the size and the time of all answers from the first block, which has this number of queries and of bytes,
/// and announces them above the limits.
#[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "estimates")]
fn announce<I>(streams: &Streams, queries: &QueryStream<I>, count: u64, bytes: usize, elapsed: Duration) {
    let scale = queries.count as f64 / count as f64;
    let bytes = bytes as f64 * scale;
    let seconds = elapsed.as_secs_f64() * scale;
    if bytes > ANNOUNCED_BYTES || seconds > ANNOUNCED_SECONDS {
        let (count, name) = (HumanCount(queries.count), queries.name);
        let bytes = DecimalBytes(bytes as u64);
        let time = HumanDuration(Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX));
        streams.print_summary(format_args!("note     {count} {name}: about {bytes} of answers, in about {time}\n"));
    }
}

/// Encodes the answers of a block, whose first query has this number.
fn encode_all<Q: Sync, A: Sync>(
    first: u64,
    queries: &[Q],
    answers: &[A],
    encode: &(impl Fn(u64, &Q, &A, &mut Vec<u8>) -> u64 + Sync),
) -> Vec<Encoded> {
    let parts: Vec<(&[Q], &[A])> = queries.chunks(ANSWERS_PER_TASK).zip(answers.chunks(ANSWERS_PER_TASK)).collect();
    let encode_part = |part: usize| {
        let (queries, answers) = parts[part];
        let first = first + (part * ANSWERS_PER_TASK) as u64;
        let (mut records, mut bytes) = (0, Vec::new());
        for (number, (query, answer)) in (first..).zip(queries.iter().zip(answers)) {
            records += encode(number, query, answer, &mut bytes);
            if number == first {
                // The other records are about as long as the first one.
                bytes.reserve(bytes.len() * (queries.len() - 1) * 5 / 4);
            }
        }
        Encoded { records, bytes }
    };
    parallel::map(parts.len(), true, encode_part)
}

/// Answers queries one by one on all threads of the current pool.
pub(crate) fn answer_each<Q: Sync, A: Send>(queries: &[Q], answer: impl Fn(&Q) -> A + Sync) -> Vec<A> {
    parallel::map_slice(queries, true, answer)
}
