//! Collectors of ray hits, which decide which hits a search has to find, and store them.

use super::crossing::Crossing;
use super::hit::{Hit, Side};
use crate::PrimitiveId;
use std::ops::ControlFlow;

/// A collector of ray hits: it decides which hits a search has to find, and takes them.
pub trait RayCollector<'r> {
    /// Returns whether only crossings of the surface are needed (see
    /// [`RayQuery::crossings`](super::RayQuery::crossings)), rather than every primitive that the ray hits. The default
    /// is `false`.
    fn only_crossings(&self) -> bool {
        false
    }

    /// Returns the parameter above which hits are not needed. The default is infinity.
    fn limit(&self) -> f64 {
        f64::INFINITY
    }

    /// Returns whether a hit on this primitive is needed. Otherwise the primitive is not tested exactly. The default is
    /// `true`.
    fn wants(&self, _primitive: PrimitiveId) -> bool {
        true
    }

    /// Takes a hit, and breaks if no other hit is needed. Hits may come in any order.
    fn offer(&mut self, primitive: PrimitiveId, crossing: &Crossing<'r>) -> ControlFlow<()>;

    /// Reports the work of a search at its end: the number of nodes whose children's bounds were tested, and the number
    /// of filtered packets.
    fn record_visits(&mut self, _nodes: usize, _packets: usize) {}

    /// Reports that a primitive passed the filter and is tested exactly.
    fn visit_primitive(&mut self) {}
}

/// The collector of the methods of [`RayQuery`](super::RayQuery), which has a mode for each of them. A backend uses it
/// as a [`RayCollector`]. Your own code needs one to count the work of a search
/// ([`RayStatsCollector`](super::RayStatsCollector)).
#[derive(Clone, Debug)]
pub struct Hits<'r> {
    mode: HitMode,
    /// The hit of the modes that need one hit: the first one, or any.
    pub(super) one: Option<(PrimitiveId, Crossing<'r>)>,
    /// The hits of the mode that needs all hits.
    #[doc(hidden)]
    pub all: Vec<Hit>,
    /// The number of hits, in the counting modes.
    #[doc(hidden)]
    pub count: usize,
    /// The number of crossings from back to front minus the number from front to back, in the mode of crossings.
    #[doc(hidden)]
    pub signed_count: i64,
}

/// The hits that a query needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum HitMode {
    /// One hit, whichever is found first.
    Any,
    /// The hit with the least parameter.
    First,
    /// All hits, in the order in which they are found.
    All,
    /// The number of hits.
    Count,
    /// The number of crossings of the surface, and their signed sum.
    Crossings,
}

impl Hits<'_> {
    /// Creates a collector of any one hit.
    #[must_use]
    pub fn any() -> Self {
        Self::new(HitMode::Any)
    }

    /// Creates a collector of the hit with the least parameter.
    #[must_use]
    pub fn first() -> Self {
        Self::new(HitMode::First)
    }

    /// Creates a collector of all hits.
    #[must_use]
    pub fn all() -> Self {
        Self::new(HitMode::All)
    }

    /// Creates a collector that counts hits.
    #[must_use]
    pub fn count() -> Self {
        Self::new(HitMode::Count)
    }

    /// Creates a collector that counts crossings of the surface.
    #[must_use]
    pub fn crossings() -> Self {
        Self::new(HitMode::Crossings)
    }

    fn new(mode: HitMode) -> Self {
        Self { mode, one: None, all: Vec::new(), count: 0, signed_count: 0 }
    }
}

impl<'r> RayCollector<'r> for Hits<'r> {
    #[inline(always)]
    fn only_crossings(&self) -> bool {
        self.mode == HitMode::Crossings
    }

    #[inline(always)]
    fn limit(&self) -> f64 {
        match &self.one {
            Some((_, first)) => first.bounds()[1],
            None => f64::INFINITY,
        }
    }

    #[inline]
    fn offer(&mut self, primitive: PrimitiveId, crossing: &Crossing<'r>) -> ControlFlow<()> {
        match self.mode {
            HitMode::Any => {
                self.one = Some((primitive, *crossing));
                return ControlFlow::Break(());
            }
            HitMode::First => self.offer_first(primitive, crossing),
            HitMode::All => self.all.push(crossing.hit(primitive)),
            HitMode::Count => self.count += 1,
            HitMode::Crossings => {
                self.count += 1;
                self.signed_count += if crossing.side() == Side::Back { 1 } else { -1 };
            }
        }
        ControlFlow::Continue(())
    }
}

impl<'r> Hits<'r> {
    /// Returns all hits, ordered by parameter and then by id.
    pub(super) fn sorted(mut self) -> Vec<Hit> {
        self.all.sort_unstable_by(|a, b| a.parameter.total_cmp(&b.parameter).then(a.primitive.cmp(&b.primitive)));
        self.all
    }

    /// Keeps the hit with the least parameter. Ties go to the lowest id. Parameters are computed only if their bounds
    /// do not decide.
    fn offer_first(&mut self, primitive: PrimitiveId, crossing: &Crossing<'r>) {
        let Some((id, first)) = &mut self.one else {
            self.one = Some((primitive, *crossing));
            return;
        };
        let ([low, high], [first_low, first_high]) = (crossing.bounds(), first.bounds());
        if low > first_high {
            return;
        }
        if high < first_low {
            (*id, *first) = (primitive, *crossing);
            return;
        }
        let crossing = crossing.resolved();
        *first = first.resolved();
        let ([t, _], [first_t, _]) = (crossing.bounds(), first.bounds());
        if t < first_t || t.total_cmp(&first_t).is_eq() && primitive < *id {
            (*id, *first) = (primitive, crossing);
        }
    }
}
