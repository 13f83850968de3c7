//! The threads of a command.

use crate::io::streams::Streams;
use anyhow::anyhow;
use p2m_core::engine::default_threads;
use rayon::ThreadPool;

/// The streams and the threads of a command.
pub(crate) struct Session<'a> {
    pub(crate) streams: &'a Streams,
    pub(crate) pool: ThreadPool,
}

#[derive(Default, clap::Args)]
pub(crate) struct ThreadArgs {
    /// The number of threads, at most 1024 [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024), allow_negative_numbers = true)]
    threads: Option<u16>,
}

impl ThreadArgs {
    /// Starts the threads of a command with these streams. One more thread only reads, writes and waits.
    pub(crate) fn start<'a>(&self, streams: &'a Streams) -> anyhow::Result<Session<'a>> {
        let threads = self.threads.map_or_else(default_threads, usize::from);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        // The error is kept as text, because its source repeats it.
        let pool = pool.map_err(|e| anyhow!("cannot start threads: {e}"))?;
        Ok(Session { streams, pool })
    }
}
