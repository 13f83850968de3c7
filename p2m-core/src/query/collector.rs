//! The interface between a search and the collector of its candidates.

use crate::{PrimitiveId, Projection};

/// A collector takes the candidates of a search, and decides which parts of the scene the search may skip.
///
/// [`Best`](crate::Best) keeps the single closest candidate. [`Near`](crate::Near) answers all other near queries with
/// the same traversals.
///
/// All squares are squared distances in f64 and in units of the scene. The methods that return limits are called in
/// inner loops, so implementations should be `#[inline]`.
pub trait Collector {
    /// Returns the square above which lower bounds are pruned: a search skips bounds strictly above it and keeps equal
    /// ones. It never rises during a search.
    fn prune_above(&self) -> f64;

    /// Returns the limit of [`prune_above`](Self::prune_above), given that the key of some primitive is at most
    /// `square`. The primitive need not have been offered yet.
    ///
    /// A collector of the single nearest primitive may then prune more. The default ignores `square`.
    #[inline(always)]
    fn prune_given_upper_bound(&self, square: f64) -> f64 {
        let _ = square;
        self.prune_above()
    }

    /// Returns the limit of [`prune_above`](Self::prune_above) for the primitive `id`.
    ///
    /// It is lower than the general limit if the collector would reject that primitive in a tie because of its id, and
    /// infinite if the collector does not compare keys. The default returns the general limit.
    #[inline(always)]
    fn prune_above_for_id(&self, id: PrimitiveId) -> f64 {
        let _ = id;
        self.prune_above()
    }

    /// Returns whether a collector of the nearest primitive also needs all primitives that rounding cannot distinguish
    /// from it. A search then evaluates and offers every primitive that its filters cannot exclude. The default is
    /// `false`.
    #[inline(always)]
    fn keeps_near_ties(&self) -> bool {
        false
    }

    /// Returns the slack of a collector that [keeps near ties](Self::keeps_near_ties): primitives that are farther than
    /// the nearest one by at most this distance are still needed. A search adds it to the upper bounds of its filters
    /// before it reports them, and does not rely on lists of the primitives that can be nearest. It is 0 by default.
    #[inline(always)]
    fn near_tie_slack(&self) -> f64 {
        0.0
    }

    /// Returns whether the collector may accept less than the exact result. A search then calls
    /// [`prune_given_incumbent`](Self::prune_given_incumbent) and [`may_stop`](Self::may_stop). The default is `false`.
    #[inline(always)]
    fn is_approximate(&self) -> bool {
        false
    }

    /// Returns the limit of [`prune_above`](Self::prune_above), given an incumbent with a key of at most `square`: the
    /// search is certain to offer the incumbent, or a primitive that is at least as near.
    ///
    /// An approximate collector may prune more than by [`prune_given_upper_bound`](Self::prune_given_upper_bound),
    /// which is the default.
    #[inline(always)]
    fn prune_given_incumbent(&self, square: f64) -> f64 {
        self.prune_given_upper_bound(square)
    }

    /// Returns whether the search may stop before it has visited everything. `has_incumbent` is whether there is a
    /// primitive that the search will certainly offer. The search reports all parts that it skips by
    /// [`record_skipped`](Self::record_skipped). The default is `false`.
    #[inline(always)]
    fn may_stop(&self, has_incumbent: bool) -> bool {
        let _ = has_incumbent;
        false
    }

    /// Reports that a subtree was skipped although it could contain the answer. `square` is a lower bound, to 16 u, on
    /// the squared distances of its primitives, and limits the certified `lower_bound`. The default ignores it.
    #[inline(always)]
    fn record_skipped(&mut self, square: f64) {
        let _ = square;
    }

    /// Returns whether only the nearest primitive and ties with it are needed. A candidate that is farther than some
    /// other primitive then need not be offered. The default is `false`.
    #[inline(always)]
    fn is_single_nearest(&self) -> bool {
        false
    }

    /// Takes a primitive by its one to three vertices instead of its projection, and returns whether it did. A search
    /// that has the vertices at hand calls it before it evaluates a candidate. The default takes none.
    #[inline(always)]
    fn take_vertices(&mut self, id: PrimitiveId, vertices: &[[f64; 3]]) -> bool {
        let _ = (id, vertices);
        false
    }

    /// Takes a candidate, which has been evaluated.
    fn offer(&mut self, id: PrimitiveId, projection: Projection);

    /// Returns whether searches with this collector contain an inlined copy of the packet filter. That is faster but
    /// adds much code, so it is meant for the collector of the nearest primitive.
    #[doc(hidden)]
    #[inline(always)]
    fn has_inlined_filters(&self) -> bool {
        false
    }

    /// Reports a visit to a node of a tree, or to a site on the way to a Voronoi cell. Collectors that count or limit
    /// visits override it.
    #[inline(always)]
    fn visit_node(&mut self) {}

    /// Reports that a packet of primitives is filtered. Collectors that count or limit visits override it.
    #[inline(always)]
    fn visit_packet(&mut self) {}
}
