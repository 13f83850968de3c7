//! What every partition of space into cells with lists offers.

use crate::hierarchy::PacketTree;
use crate::{Best, Collector, Isa, PrimitiveSet, Real};
use nalgebra::Point3;

/// A partition with its lists, over a set of primitives that it does not keep: every method that needs the set is given
/// the same one.
pub trait Partition: Sized {
    /// How it is built.
    type Options: Default;
    /// What it is made of.
    type Report;

    /// Builds it over a set whose boxes are finite. `progress` is told what part is done, each percent once, from any
    /// thread.
    #[must_use]
    fn build<T: Real, S: PrimitiveSet<T> + Sync + ?Sized>(
        set: &S,
        options: &Self::Options,
        progress: &(dyn Fn(f64) + Sync),
    ) -> Self;

    /// Offers to `collector` every primitive of the set that it could want. `query` is finite.
    fn search<T: Real, S: PrimitiveSet<T>, C: Collector>(&self, set: &S, query: &Point3<T>, collector: &mut C);

    /// The same for the nearest primitive.
    fn search_nearest<T: Real, S: PrimitiveSet<T>>(&self, set: &S, query: &Point3<T>, best: &mut Best<T>);

    /// The tree over the packets, which answers what cells do not.
    fn tree(&self) -> &PacketTree;

    /// What it is made of.
    fn report(&self) -> Self::Report;

    /// Heap memory it owns, in bytes.
    fn memory(&self) -> usize;

    /// Searches with another instruction set. Answers do not depend on it.
    #[must_use]
    fn with_isa(self, isa: Isa) -> Self;
}
