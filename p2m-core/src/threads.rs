//! The number of threads of the pools that this project starts.

use std::num::NonZero;
use std::thread::available_parallelism;

/// The largest number of threads of a pool. Many more would exhaust the memory or the process ids of a machine.
pub const MAX_THREADS: usize = 1024;

/// Returns the default number of threads of a pool. It is the value of the environment variable `RAYON_NUM_THREADS` or
/// else the number of processors that this process may use, and in any case at most [`MAX_THREADS`].
#[must_use]
pub fn default_threads() -> usize {
    threads_of(std::env::var("RAYON_NUM_THREADS").ok().as_deref())
}

fn threads_of(variable: Option<&str>) -> usize {
    // A number beyond the range of usize counts as a large one.
    let is_number = |text: &&str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    let given = variable.map(str::trim).filter(is_number).map(|text| text.parse().unwrap_or(usize::MAX));
    let given = given.filter(|&number| number > 0);
    given.unwrap_or_else(|| available_parallelism().map_or(1, NonZero::get)).min(MAX_THREADS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_environment_sets_at_most_1024_threads() {
        let processors = threads_of(None);
        assert_eq!(processors, available_parallelism().map_or(1, NonZero::get).min(1024));
        for (text, threads) in [("3", 3), (" 12 ", 12), ("4000", 1024), ("99999999999999999999999", 1024)] {
            assert_eq!(threads_of(Some(text)), threads, "{text}");
        }
        for text in ["", "0", "many", "-1"] {
            assert_eq!(threads_of(Some(text)), processors, "{text}");
        }
    }
}
