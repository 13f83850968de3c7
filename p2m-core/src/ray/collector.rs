//! What becomes of the hits that a search finds.

use super::crossing::{Crossing, Hit};
use crate::PrimitiveId;
use std::ops::ControlFlow;

/// Decides which hits a search has to find.
pub trait RayCollector<'r> {
    /// Whether only crossings of the surface count (see [`RayQuery::crossings`](super::RayQuery::crossings)), rather
    /// than every primitive that the ray meets.
    fn only_crossings(&self) -> bool {
        false
    }

    /// The parameter above which hits do not matter.
    fn limit(&self) -> f64 {
        f64::INFINITY
    }

    /// Whether a hit of this primitive matters: one of which it does not is not tested exactly.
    fn wants(&self, _primitive: PrimitiveId) -> bool {
        true
    }

    /// Takes a hit, in any order; breaks if no other one matters.
    fn offer(&mut self, primitive: PrimitiveId, crossing: &Crossing<'r>) -> ControlFlow<()>;

    /// A node is visited: the bounds of its children are tested.
    fn visit_node(&mut self) {}

    /// A packet is visited: its primitives are filtered.
    fn visit_packet(&mut self) {}

    /// A primitive passed the filter, and is tested exactly.
    fn visit_primitive(&mut self) {}
}

/// What is wanted of the hits, and what was found: handed to a backend by the methods of
/// [`RayQuery`](super::RayQuery), which take it apart. One of your own serves to count what a search does
/// ([`RayStatsCollector`](super::RayStatsCollector)).
#[derive(Clone, Debug)]
pub struct Hits<'r> {
    wanted: Wanted,
    /// The first one, or any, if that is wanted.
    pub(super) one: Option<(PrimitiveId, Crossing<'r>)>,
    /// Every one, if that is wanted.
    #[doc(hidden)]
    pub all: Vec<Hit>,
    /// How many there are, if that is wanted.
    #[doc(hidden)]
    pub count: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Wanted {
    Any,
    First,
    All,
    Count,
    Crossings,
}

impl Hits<'_> {
    /// One hit, whichever is found first.
    #[must_use]
    pub fn any() -> Self {
        Self::new(Wanted::Any)
    }

    /// The hit with the least parameter.
    #[must_use]
    pub fn first() -> Self {
        Self::new(Wanted::First)
    }

    /// All hits.
    #[must_use]
    pub fn all() -> Self {
        Self::new(Wanted::All)
    }

    /// Only how many there are.
    #[must_use]
    pub fn count() -> Self {
        Self::new(Wanted::Count)
    }

    /// Only how often the surface is crossed.
    #[must_use]
    pub fn crossings() -> Self {
        Self::new(Wanted::Crossings)
    }

    fn new(wanted: Wanted) -> Self {
        Self { wanted, one: None, all: Vec::new(), count: 0 }
    }
}

impl<'r> RayCollector<'r> for Hits<'r> {
    #[inline(always)]
    fn only_crossings(&self) -> bool {
        self.wanted == Wanted::Crossings
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
        match self.wanted {
            Wanted::Any => {
                self.one = Some((primitive, *crossing));
                return ControlFlow::Break(());
            }
            Wanted::First => self.offer_first(primitive, crossing),
            Wanted::All => self.all.push(crossing.hit(primitive)),
            Wanted::Count | Wanted::Crossings => self.count += 1,
        }
        ControlFlow::Continue(())
    }
}

impl<'r> Hits<'r> {
    /// In the order of their parameters and then of ids.
    pub(super) fn sorted(mut self) -> Vec<Hit> {
        self.all.sort_unstable_by(|a, b| a.parameter.total_cmp(&b.parameter).then(a.primitive.cmp(&b.primitive)));
        self.all
    }

    /// Keeps the hit with the least parameter, and of equal ones the lowest id. Parameters are computed only where their
    /// bounds do not decide.
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
