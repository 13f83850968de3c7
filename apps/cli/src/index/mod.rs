//! The index of a run: its backend, its options, its signs.

pub(crate) mod args;
pub(crate) mod backend;
pub(crate) mod kdop_directions;
pub(crate) mod p2m_args;
pub(crate) mod shards;
pub(crate) mod sign_rule;

pub(crate) use args::IndexArgs;
pub(crate) use backend::{Backend, BackendChoice, Chosen, PreparedIndex, backend_choices, backends};
pub(crate) use kdop_directions::kdop_faces;
pub(crate) use p2m_args::P2mArgs;
pub(crate) use sign_rule::{SignReport, SignRule, SignedIndex};
