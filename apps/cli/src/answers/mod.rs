//! The queries of a run, the loop that answers them, and the table and the summary of the answers.

pub(crate) mod args;
pub(crate) mod blocks;
pub(crate) mod queries;
pub(crate) mod run;
pub(crate) mod running_stats;
pub(crate) mod summary;
pub(crate) mod table;
