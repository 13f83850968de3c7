//! Building a tree.
//!
//! Primitives are split top-down into a binary tree ([`split`], by the surface-area heuristic of [`sah`]) whose leaves
//! are packets. Its nodes are merged into nodes of eight children ([`collapse`]), beside which the packets are made.
//! Finally all nodes are bounded from the leaves to the root ([`packet_tree`]).

mod collapse;
mod options;
mod packet_tree;
pub(crate) mod primitive;
mod sah;
mod split;

pub use options::{SplitOptions, SplitRule, TreeOptions};

/// Runs two functions, on two threads if `parallel` is set and the feature `rayon` is on.
pub(crate) fn run_both<A: Send, B: Send>(
    parallel: bool,
    a: impl FnOnce() -> A + Send,
    b: impl FnOnce() -> B + Send,
) -> (A, B) {
    #[cfg(feature = "rayon")]
    if parallel {
        return rayon::join(a, b);
    }
    let _ = parallel;
    (a(), b())
}

/// Returns the number of threads that work if `parallel` is set.
pub(crate) fn thread_count(parallel: bool) -> usize {
    #[cfg(feature = "rayon")]
    if parallel {
        return rayon::current_num_threads();
    }
    let _ = parallel;
    1
}
