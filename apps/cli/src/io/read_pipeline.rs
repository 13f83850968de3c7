//! Reading on the calling thread while other threads parse.

use rayon::ThreadPool;
use std::io::{self, BufRead, ErrorKind, Read};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};

/// The number of chunks that are read before they are parsed.
const CHUNKS: usize = 16;

/// Calls `parse` on a thread of a pool with the bytes of a reader, which this thread reads.
///
/// A reader need not be sent to another thread, and decompression takes no time of the pool.
pub(crate) fn pump<R: Send>(pool: &ThreadPool, mut reader: impl BufRead, parse: impl FnOnce(Pumped) -> R + Send) -> R {
    let (sender, chunks) = sync_channel(CHUNKS);
    let mut result = None;
    pool.in_place_scope(|scope| {
        scope.spawn(|_| result = Some(parse(Pumped { chunks, chunk: Vec::new(), at: 0 })));
        send_chunks(&mut reader, &sender);
        drop(sender); // which tells the other side that the file ends
    });
    result.expect("the scope waited for it")
}

/// Sends the chunks of a reader up to its end, an error, or the end of parsing.
fn send_chunks(reader: &mut impl BufRead, sender: &SyncSender<io::Result<Vec<u8>>>) {
    loop {
        let chunk = match reader.fill_buf() {
            Ok([]) => return,
            Ok(bytes) => Ok(bytes.to_vec()),
            Err(e) if e.kind() == ErrorKind::Interrupted => continue,
            Err(e) => Err(e),
        };
        let length = chunk.as_ref().map_or(0, Vec::len);
        reader.consume(length);
        if sender.send(chunk).is_err() || length == 0 {
            return;
        }
    }
}

/// The bytes that another thread reads.
pub(crate) struct Pumped {
    chunks: Receiver<io::Result<Vec<u8>>>,
    chunk: Vec<u8>,
    /// The number of bytes of `chunk` that were consumed.
    at: usize,
}

impl Read for Pumped {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.fill_buf()?.read(buffer)?;
        self.consume(count);
        Ok(count)
    }
}

impl BufRead for Pumped {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.at == self.chunk.len() {
            // No chunk is empty, and there is none after the end of the file.
            self.chunk = self.chunks.recv().unwrap_or(Ok(Vec::new()))?;
            self.at = 0;
        }
        Ok(&self.chunk[self.at..])
    }

    fn consume(&mut self, count: usize) {
        self.at += count;
    }
}
