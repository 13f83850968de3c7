//! Parallel parsing of a file in blocks, which one thread joins in order.
//!
//! A block is a part of a file that can be parsed without knowing what precedes it. Joining the blocks resolves what
//! depends on earlier blocks, such as a relative index. Unusual input is left to the sequential reader of the format,
//! which continues where the last block was joined. So both readers together return the same scene and the same errors
//! as the sequential reader alone.

use crate::parse::bytes::fill_buffer;
use p2m_core::engine::parallel::{thread_count, with_helpers};
use std::collections::VecDeque;
use std::io::{self, BufRead, Read};
use std::sync::{Mutex, PoisonError};

/// The size of a block in bytes. Parsing one takes about a tenth of a millisecond.
pub(crate) const BLOCK_BYTES: usize = 1 << 15;
/// The number of blocks per thread that are read ahead while the blocks before them are parsed
/// (docs/decisions/060-files-are-parsed-in-blocks.md has the memory and the times).
const BLOCKS_PER_THREAD: usize = 4;
/// The number of bytes of a typical row, to estimate the size of a file from its number of rows.
const BYTES_PER_ROW: usize = 32;
/// The length of a line or row, in blocks, above which it is left to the sequential reader.
const MAX_BLOCKS_PER_ROW: usize = 32;

/// A reader that takes bytes back, as `ungetc` does.
pub(crate) struct Source<R> {
    reader: R,
    /// Returned bytes, which come before the rest of `reader`.
    returned: Vec<u8>,
    /// The number of bytes of `returned` that have been read again.
    at: usize,
    /// An error of `reader` after the bytes of `returned`.
    error: Option<io::Error>,
    /// The size of a block, or 0 if there are no blocks.
    block_bytes: usize,
}

impl<R: BufRead> Source<R> {
    pub(crate) fn new(reader: R) -> Self {
        Self::with_block_bytes(reader, BLOCK_BYTES)
    }

    /// Sets the size of blocks. With 0 there are no blocks, and the sequential reader reads everything.
    pub(crate) fn with_block_bytes(reader: R, block_bytes: usize) -> Self {
        Self { reader, returned: Vec::new(), at: 0, error: None, block_bytes }
    }

    /// Returns the reader, for formats that are not read in blocks, before anything is read.
    pub(crate) fn into_reader(self) -> R {
        self.reader
    }

    /// Puts an error back, so that the next read returns it.
    pub(crate) fn return_error(&mut self, error: io::Error) {
        self.error = Some(error);
    }

    /// Puts bytes back that were read last.
    fn return_bytes(&mut self, bytes: &[u8]) {
        self.returned.splice(..self.at, bytes.iter().copied());
        self.at = 0;
    }

    /// Appends at most `max_count` bytes and returns their number, which is 0 only at the end of the file.
    fn append(&mut self, max_count: usize, block: &mut Vec<u8>) -> io::Result<usize> {
        let bytes = fill_buffer(self)?;
        let count = bytes.len().min(max_count);
        block.extend_from_slice(&bytes[..count]);
        self.consume(count);
        Ok(count)
    }

    /// Returns whether this number of rows is worth reading in blocks.
    pub(crate) fn has_blocks_of(&self, rows: u64) -> bool {
        self.block_bytes > 0 && rows >= (self.block_bytes / BYTES_PER_ROW) as u64
    }

    /// Reads the next block. `cut` gets the bytes read so far and returns the length of the longest block that they
    /// start with, 0 if it needs more bytes, or `None` if no further block is wanted. At the end of the file, before an
    /// error and if there is no block, this function returns `None` and consumes nothing.
    fn next_block(&mut self, cut: &mut impl FnMut(&[u8]) -> Option<usize>) -> Option<Vec<u8>> {
        let mut block = Vec::new();
        let mut want = self.block_bytes;
        while want > 0 && want <= self.block_bytes * MAX_BLOCKS_PER_ROW {
            while block.len() < want {
                match self.append(want - block.len(), &mut block) {
                    Ok(0) => break,
                    Ok(_) => {}
                    Err(error) => {
                        self.return_error(error);
                        break;
                    }
                }
            }
            let Some(length) = cut(&block) else { break };
            if length > 0 {
                self.return_bytes(&block[length..]);
                block.truncate(length);
                return Some(block);
            }
            if block.len() < want {
                break;
            }
            want *= 2;
        }
        self.return_bytes(&block);
        None
    }
}

impl<R: BufRead> Read for Source<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let bytes = self.fill_buf()?;
        let count = bytes.len().min(buffer.len());
        buffer[..count].copy_from_slice(&bytes[..count]);
        self.consume(count);
        Ok(count)
    }
}

impl<R: BufRead> BufRead for Source<R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.at < self.returned.len() {
            return Ok(&self.returned[self.at..]);
        }
        match self.error.take() {
            Some(error) => Err(error),
            None => self.reader.fill_buf(),
        }
    }

    fn consume(&mut self, count: usize) {
        if self.at < self.returned.len() {
            self.at += count;
        } else {
            self.reader.consume(count);
        }
    }
}

/// Parses a file in blocks and passes each block to `join`, in order and on this thread. With the feature `rayon`, all
/// threads of the current pool parse.
///
/// `cut` decides where blocks end (see [`Source::next_block`]). `join` returns a number to stop: the block is used up
/// to that byte, and the source continues there. Blocks after it are put back as well.
pub(crate) fn for_each_block<R: BufRead, P: Send, E>(
    source: &mut Source<R>,
    mut cut: impl FnMut(&[u8]) -> Option<usize>,
    parse: impl Fn(&[u8]) -> P + Sync,
    mut join: impl FnMut(&[u8], P) -> Result<Option<usize>, E>,
) -> Result<(), E> {
    if thread_count(true) > 1 {
        return for_each_block_on_threads(source, &mut cut, &parse, &mut join);
    }
    while let Some(block) = source.next_block(&mut cut) {
        let parsed = parse(&block);
        if let Some(used) = join(&block, parsed)? {
            source.return_bytes(&block[used..]);
            break;
        }
    }
    Ok(())
}

/// A block and its parsed form.
struct Slot<P> {
    bytes: Vec<u8>,
    parsed: Option<P>,
}

/// Parses blocks on all threads, in a pipeline with three stages: a round of blocks is read, parsed and joined.
///
/// In each step of the loop, the helpers parse the blocks of `next`. Meanwhile this thread joins the blocks of
/// `parsed`, which come before them, and then reads the blocks of `after` from the file. Then the rounds move up. If
/// `join` stops early, the bytes of all blocks that were read ahead go back to the source.
fn for_each_block_on_threads<R: BufRead, P: Send, E>(
    source: &mut Source<R>,
    cut: &mut impl FnMut(&[u8]) -> Option<usize>,
    parse: &(impl Fn(&[u8]) -> P + Sync),
    join: &mut impl FnMut(&[u8], P) -> Result<Option<usize>, E>,
) -> Result<(), E> {
    let blocks_per_round = thread_count(true) * BLOCKS_PER_THREAD;
    let mut parsed = VecDeque::<Slot<P>>::new();
    // A file of one block needs no other thread.
    let mut next = read_round(source, cut, 1);
    if let Some(slot) = next.front_mut() {
        slot.parsed = Some(parse(&slot.bytes));
    }
    loop {
        let mut after = VecDeque::new();
        let mut stopped = Ok(None);
        let mut all_joined = true;
        let open: Vec<_> = next.iter_mut().filter(|slot| slot.parsed.is_none()).collect();
        let (count, open) = (open.len(), Mutex::new(open.into_iter()));
        let parse_next = || {
            let slot = open.lock().unwrap_or_else(PoisonError::into_inner).next();
            if let Some(slot) = slot {
                slot.parsed = Some(parse(&slot.bytes));
            }
        };
        with_helpers(&parse_next, &mut |call_helper| {
            (0..count).for_each(|_| call_helper());
            while let Some(Slot { bytes, parsed: Some(block) }) = parsed.pop_front() {
                match join(&bytes, block) {
                    Ok(None) => {}
                    Ok(Some(used)) => {
                        stopped = Ok(Some(bytes[used..].to_vec()));
                    }
                    Err(error) => stopped = Err(error),
                }
                if !matches!(stopped, Ok(None)) {
                    all_joined = false;
                    return;
                }
            }
            after = read_round(source, cut, blocks_per_round);
        });
        drop(open);
        if !all_joined {
            let mut bytes = stopped?.unwrap_or_default();
            for slot in parsed.iter().chain(&next) {
                bytes.extend_from_slice(&slot.bytes);
            }
            source.return_bytes(&bytes);
            return Ok(());
        }
        if next.is_empty() {
            return Ok(());
        }
        parsed = std::mem::replace(&mut next, after);
    }
}

fn read_round<R: BufRead, P>(
    source: &mut Source<R>,
    cut: &mut impl FnMut(&[u8]) -> Option<usize>,
    count: usize,
) -> VecDeque<Slot<P>> {
    let blocks = std::iter::from_fn(|| source.next_block(cut));
    blocks.take(count).map(|bytes| Slot { bytes, parsed: None }).collect()
}
