//! Ids of instances.

use std::fmt::{self, Display, Formatter};

/// The id of an instance in its scene. It stays the same while other instances are added and removed, and no later
/// instance of the scene has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct InstanceId(pub(crate) u64);

impl Display for InstanceId {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}
