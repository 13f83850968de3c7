//! The interface of filters: they choose the primitives of a long list that can be the answer for a query.

use p2m_core::engine::vector::V3;
use std::fmt::Debug;
use std::sync::Arc;

/// A primitive of a list, with a box around all points of its cell where it may be the answer.
///
/// The box is in the coordinates of the scene. It is a little larger than the region of [docs/proofs/p2m.md], and it is
/// unbounded if nothing is known.
///
/// [docs/proofs/p2m.md]: https://github.com/p2m-rs/p2m/blob/main/docs/proofs/p2m.md
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region {
    /// The least coordinates of the box.
    pub low: [f64; 3],
    /// The largest coordinates of the box.
    pub high: [f64; 3],
    /// The packet of the primitive.
    packet: u32,
    /// The lane of the primitive, as a bit.
    lanes: u16,
}

impl Region {
    /// Makes the region of a primitive from points that span it, enlarged by `padding`.
    pub(crate) fn from_points(points: impl Iterator<Item = V3>, padding: f64, packet: u32, lane: usize) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for point in points {
            for ((low, high), x) in low.iter_mut().zip(&mut high).zip(point) {
                // A coordinate that is not finite bounds nothing.
                let [from, to] =
                    if x.is_finite() { [x - padding, x + padding] } else { [f64::NEG_INFINITY, f64::INFINITY] };
                (*low, *high) = (low.min(from), high.max(to));
            }
        }
        Self { low, high, packet, lanes: 1 << lane }
    }

    /// Returns whether a point is in the box. The border belongs to it.
    #[must_use]
    pub fn contains(&self, point: &[f64; 3]) -> bool {
        (0..3).all(|k| self.low[k] <= point[k] && point[k] <= self.high[k])
    }
}

/// Chooses among the primitives of a long list.
///
/// The choice includes at least the primitives whose boxes contain the query point. Choosing more only takes time, so
/// answers do not depend on the filter. A list without a filter is searched in the order of the lower bounds on its
/// packets.
pub trait ListFilter: Debug + Send + Sync {
    /// Calls `visit` once for each primitive whose box contains a point, in any order.
    fn containing(&self, point: &[f64; 3], visit: &mut dyn FnMut(&Region));

    /// Returns the heap memory that the filter owns, in bytes.
    fn memory(&self) -> usize;
}

/// Makes the filter of one list from its regions: a function such as `RegionTree::build`.
pub type BuildListFilter = fn(Vec<Region>) -> Arc<dyn ListFilter>;

/// The filters of an index.
#[derive(Clone, Debug, Default)]
pub(crate) struct ListFilters {
    /// For each site the index of its filter, or [`NO_FILTER`]. It is empty if there are no filters.
    numbers: Vec<u32>,
    /// The filters, by their indices.
    all: Vec<Arc<dyn ListFilter>>,
}

/// Marks a site whose list has no filter.
const NO_FILTER: u32 = u32::MAX;

impl ListFilters {
    /// Makes an empty set of filters for some number of sites.
    pub(crate) fn new(sites: usize) -> Self {
        Self { numbers: vec![NO_FILTER; sites], all: Vec::new() }
    }

    /// Adds the filter of a site's list.
    pub(crate) fn add(&mut self, site: usize, filter: Arc<dyn ListFilter>) {
        self.numbers[site] = u32::try_from(self.all.len()).expect("fewer than sites");
        self.all.push(filter);
    }

    /// Returns the filter of a site's list, if it has one.
    #[inline(always)]
    pub(crate) fn get(&self, site: usize) -> Option<&dyn ListFilter> {
        if self.all.is_empty() {
            return None;
        }
        self.all.get(self.numbers[site] as usize).map(|filter| &**filter)
    }

    /// Returns the number of lists that have a filter.
    pub(crate) fn count(&self) -> usize {
        self.all.len()
    }

    /// Returns the heap memory in bytes.
    pub(crate) fn memory(&self) -> usize {
        self.numbers.capacity() * size_of::<u32>()
            + self.all.capacity() * size_of::<Arc<dyn ListFilter>>()
            + self.all.iter().map(|filter| filter.memory()).sum::<usize>()
    }

    /// Returns the packets that a filter chooses for a point, in ascending order, with their lanes.
    pub(crate) fn packets(filter: &dyn ListFilter, point: &V3) -> Vec<(u32, u16)> {
        let mut chosen: Vec<(u32, u16)> = Vec::new();
        filter.containing(point, &mut |region| chosen.push((region.packet, region.lanes)));
        chosen.sort_unstable();
        let packets = chosen.chunk_by(|a, b| a.0 == b.0);
        packets
            .map(|lanes_of_packet| (lanes_of_packet[0].0, lanes_of_packet.iter().fold(0, |lanes, one| lanes | one.1)))
            .collect()
    }
}
