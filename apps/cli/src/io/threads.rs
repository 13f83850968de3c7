//! The threads of a run.

use anyhow::anyhow;
use p2m_core::engine::default_threads;
use rayon::ThreadPool;

#[derive(Default, clap::Args)]
pub(crate) struct ThreadArgs {
    /// The number of threads, at most 1024 [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024), allow_negative_numbers = true)]
    threads: Option<u16>,
}

impl ThreadArgs {
    /// Starts the threads. One more thread only reads, writes and waits.
    pub(crate) fn pool(&self) -> anyhow::Result<ThreadPool> {
        let threads = self.threads.map_or_else(default_threads, usize::from);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        // The error is kept as text, because its source repeats it.
        pool.map_err(|e| anyhow!("cannot start threads: {e}"))
    }
}
