//! Which primitives of a long list are worth a look, by where the query is.

use crate::kernel::vector::V3;

/// A primitive of a list, with a box around all places of its cell where it may be the answer.
///
/// Boxes are in the coordinates of the scene, a little larger than the region of docs/p2m.md, and without end where
/// nothing is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region {
    /// The least coordinates of the box,
    pub low: [f64; 3],
    /// and the largest ones.
    pub high: [f64; 3],
    packet: u32,
    /// The bit of its lane.
    lanes: u16,
}

impl Region {
    /// Around points, with some room.
    pub(super) fn around(points: &[V3], room: f64, packet: u32, lane: usize) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for (k, (low, high)) in low.iter_mut().zip(&mut high).enumerate() {
            for x in points.iter().map(|point| point[k]) {
                // What is not a number bounds nothing.
                let [from, to] = if x.is_finite() { [x - room, x + room] } else { [f64::NEG_INFINITY, f64::INFINITY] };
                (*low, *high) = (low.min(from), high.max(to));
            }
        }
        Self { low, high, packet, lanes: 1 << lane }
    }

    /// Whether a place is in the box, its border included.
    #[must_use]
    pub fn contains(&self, place: &[f64; 3]) -> bool {
        (0..3).all(|k| self.low[k] <= place[k] && place[k] <= self.high[k])
    }
}

/// Chooses among the primitives of a long list.
///
/// A list has at least those in whose boxes the query is; to choose more is no mistake, but takes time, so answers do
/// not depend on the filter. A list without a filter is searched in the order of lower bounds on the distances.
pub trait ListFilter: Send + Sync + Sized + 'static {
    /// Whether this is [`SortedLists`], with which queries are compiled in this crate.
    #[doc(hidden)]
    const IS_USUAL: bool = false;

    /// Whether there are filters at all.
    const IS_USED: bool;

    /// For the primitives of one list.
    fn new(regions: Vec<Region>) -> Self;

    /// The primitives in whose boxes a place is, each once, in any order.
    fn containing(&self, place: &[f64; 3]) -> impl Iterator<Item = &Region>;

    /// Heap memory, in bytes.
    fn memory(&self) -> usize;
}

/// No filter: all lists are searched in the order of lower bounds on the distances to their packets.
#[derive(Clone, Copy, Debug)]
pub enum SortedLists {}

impl ListFilter for SortedLists {
    const IS_USUAL: bool = true;
    const IS_USED: bool = false;

    fn new(_: Vec<Region>) -> Self {
        unreachable!("no list has a filter")
    }

    fn containing(&self, _: &[f64; 3]) -> impl Iterator<Item = &Region> {
        std::iter::empty()
    }

    fn memory(&self) -> usize {
        0
    }
}

/// The filters of an index: of each site its number among them, or [`NONE`].
#[derive(Clone, Debug)]
pub(super) struct Filters<F> {
    numbers: Vec<u32>,
    all: Vec<F>,
}

const NONE: u32 = u32::MAX;

impl<F> Default for Filters<F> {
    fn default() -> Self {
        Self { numbers: Vec::new(), all: Vec::new() }
    }
}

impl<F: ListFilter> Filters<F> {
    pub(super) fn new(sites: usize) -> Self {
        Self { numbers: vec![NONE; if F::IS_USED { sites } else { 0 }], all: Vec::new() }
    }

    pub(super) fn add(&mut self, site: usize, filter: F) {
        self.numbers[site] = u32::try_from(self.all.len()).expect("fewer than sites");
        self.all.push(filter);
    }

    /// The filter of a site's list.
    #[inline(always)]
    pub(super) fn of(&self, site: usize) -> Option<&F> {
        if F::IS_USED { self.all.get(self.numbers[site] as usize) } else { None }
    }

    /// How many lists have one.
    pub(super) fn count(&self) -> usize {
        self.all.len()
    }

    pub(super) fn memory(&self) -> usize {
        self.numbers.capacity() * size_of::<u32>()
            + self.all.capacity() * size_of::<F>()
            + self.all.iter().map(F::memory).sum::<usize>()
    }

    /// The packets that a filter chooses for a place, in ascending order, with their lanes.
    pub(super) fn packets(filter: &F, place: &V3) -> Vec<(u32, u16)> {
        let mut chosen: Vec<_> = filter.containing(place).map(|region| (region.packet, region.lanes)).collect();
        chosen.sort_unstable();
        let packets = chosen.chunk_by(|a, b| a.0 == b.0);
        packets.map(|own| (own[0].0, own.iter().fold(0, |lanes, one| lanes | one.1))).collect()
    }
}
