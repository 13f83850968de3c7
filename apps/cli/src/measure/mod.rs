//! Commands that measure indexes: their structure, their cost, and their error.

pub(crate) mod advise;
pub mod harness;
pub(crate) mod stats;
pub(crate) mod tradeoff;
