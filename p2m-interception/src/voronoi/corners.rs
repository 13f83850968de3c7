//! The corners of all Voronoi cells, with the packets that intersect their balls.

use crate::delaunay::Delaunay;
use crate::parallel_chunks::map_chunks_in_order;
use crate::voronoi::adjacency::IncidenceLists;
use crate::voronoi::budget::{Limits, to_u32};
use crate::voronoi::corner::{CORNERS_PER_TASK, CellCorner, compute_corners};
use crate::voronoi::flood::{Flood, FloodedCorners};
use p2m_bvh::PacketTree;
use p2m_bvh::engine::range::Selection;
use std::ops::Range;

/// A ball that intersects more packets than this is crowded.
const CROWDED_BALL_PACKETS: usize = 24;

/// Floods find the packets of all balls anew if more than one ball in this many is new. Otherwise only the new balls
/// are searched for.
const FLOODED_PART_DIVISOR: usize = 4;

impl Limits<'_> {
    /// Returns the largest number of packets of a ball that is not crowded while sites are added.
    pub(crate) fn max_uncrowded_packets(self) -> usize {
        CROWDED_BALL_PACKETS.min(self.max_list_packets)
    }
}

/// The corners of all cells: one for each tetrahedron, and one more that marks the end.
#[derive(Default)]
pub(crate) struct CellCorners {
    /// The corners, in the order of their tetrahedra.
    pub(crate) all: Vec<CellCorner>,
    /// The packets of the balls that are not crowded, one ball after the other.
    packets: Vec<u32>,
    /// The packets of balls that were crowded while sites were added, each with the number of its corner.
    late_packets: Vec<(u32, u32)>,
    /// The packets of all balls, if floods found them. `packets` and `late_packets` are empty then.
    flooded: Option<FloodedCorners>,
}

impl CellCorners {
    /// Computes the corners of all tetrahedra, and finds their packets. If few balls are new, the packets of the others
    /// are copied from `reused`, the corners of an earlier triangulation.
    pub(crate) fn new(
        tree: &PacketTree,
        delaunay: &Delaunay,
        limits: Limits<'_>,
        reused: Option<&ReusedCorners<'_>>,
        progress: &dyn Fn(usize, usize),
    ) -> Self {
        let are_most_known = reused.is_some_and(|reused| {
            let count = delaunay.tetrahedra().len();
            let new_count = (0..count).filter(|number| reused.find(*number).is_none()).count();
            new_count * FLOODED_PART_DIVISOR <= count
        });
        let found = if are_most_known {
            Err(compute_corners(delaunay, limits.parallel))
        } else {
            Self::flood(tree, delaunay, limits, progress)
        };
        found.unwrap_or_else(|all| Self::search(tree, limits, &all, reused, progress))
    }

    /// Computes the corners of all tetrahedra, and finds their packets by floods. If that takes too long, the error
    /// holds the corners without packets.
    pub(crate) fn flood(
        tree: &PacketTree,
        delaunay: &Delaunay,
        limits: Limits<'_>,
        progress: &dyn Fn(usize, usize),
    ) -> Result<Self, Vec<CellCorner>> {
        let mut all = compute_corners(delaunay, limits.parallel);
        let flooded = Flood::new(tree, delaunay, &all, limits).and_then(|flood| flood.find(progress));
        let Some(flooded) = flooded else { return Err(all) };
        all.push(CellCorner::UNKNOWN);
        let mut corners = Self { all, flooded: Some(flooded), ..Self::default() };
        corners.mark_flooded_crowds(limits.max_uncrowded_packets());
        Ok(corners)
    }

    /// Finds the packets of the corners `all` by searches of the tree, or copies them from `reused`.
    pub(crate) fn search(
        tree: &PacketTree,
        limits: Limits<'_>,
        all: &[CellCorner],
        reused: Option<&ReusedCorners<'_>>,
        progress: &dyn Fn(usize, usize),
    ) -> Self {
        let count = all.len();
        let mut corners = Self { all: Vec::with_capacity(count + 1), ..Self::default() };
        map_chunks_in_order(
            count,
            CORNERS_PER_TASK,
            limits.parallel,
            |numbers| Self::search_chunk(tree, limits, reused, all, numbers),
            |chunk: Self| {
                corners.append(chunk, limits);
                progress(corners.all.len(), count);
            },
        );
        corners.push(CellCorner::UNKNOWN, std::iter::empty());
        corners
    }

    /// Marks the corners that floods found with more than `max_packets` packets as crowded, and all others as not.
    fn mark_flooded_crowds(&mut self, max_packets: usize) {
        let counts = self.flooded.iter().flat_map(|flooded| &flooded.packet_counts);
        for (corner, count) in self.all.iter_mut().zip(counts) {
            corner.is_crowded = *count as usize > max_packets;
        }
    }

    /// Searches the tree for the packets of some of the corners `all`.
    fn search_chunk(
        tree: &PacketTree,
        limits: Limits<'_>,
        reused: Option<&ReusedCorners<'_>>,
        all: &[CellCorner],
        numbers: Range<usize>,
    ) -> Self {
        let mut corners = Self::default();
        let mut selections: Vec<Selection> = Vec::new();
        for tetrahedron in numbers {
            let mut corner = all[tetrahedron];
            if let Some((reused, number)) = reused.and_then(|reused| Some((reused, reused.find(tetrahedron)?))) {
                corner.is_crowded = reused.corners.all[number].is_crowded;
                corners.push(corner, reused.corners.packets(number).iter().copied());
                continue;
            }
            selections.clear();
            if limits.budget.is_exceeded() {
                corners.push(CellCorner::UNKNOWN, std::iter::empty());
                continue;
            }
            let most = limits.max_uncrowded_packets();
            corner.is_crowded = corner.radius <= 0.0 || !corner.collect_ball(tree, limits, most, &mut selections);
            let kept = if corner.is_crowded { &[] } else { &selections[..] };
            corners.push(corner, kept.iter().map(|s| s.packet));
        }
        corners
    }

    /// Finds the packets of crowded balls as well, unless they are too many for a list.
    pub(crate) fn find_packets_of_crowded(&mut self, tree: &PacketTree, limits: Limits<'_>) {
        if self.flooded.is_some() {
            self.mark_flooded_crowds(limits.max_list_packets);
            return;
        }
        if limits.max_list_packets <= CROWDED_BALL_PACKETS || self.count_crowded() == 0 {
            return;
        }
        let all = &self.all;
        let work = |numbers: Range<usize>| {
            let mut late_packets = Vec::new();
            let mut selections: Vec<Selection> = Vec::new();
            for number in numbers {
                let corner = all[number];
                selections.clear();
                let is_retried = corner.is_crowded && corner.radius > 0.0 && !limits.budget.is_exceeded();
                if is_retried && corner.collect_ball(tree, limits, limits.max_list_packets, &mut selections) {
                    late_packets.extend(selections.iter().map(|s| (s.packet, to_u32(number))));
                }
            }
            late_packets
        };
        let mut found = Vec::new();
        map_chunks_in_order(all.len() - 1, CORNERS_PER_TASK, limits.parallel, work, |late_packets: Vec<(u32, u32)>| {
            if limits.budget.fits::<u32>(self.packets.len() + found.len() + late_packets.len()) {
                found.extend(late_packets);
            }
        });
        found.iter().for_each(|(_, number)| self.all[*number as usize].is_crowded = false);
        self.late_packets = found;
    }

    /// Appends the corners of a chunk. They are unknown if the budget has no memory for their packets.
    fn append(&mut self, chunk: Self, limits: Limits<'_>) {
        let first_packet = self.packets.len();
        if !limits.budget.fits::<u32>(first_packet + chunk.packets.len()) {
            self.all.resize(
                self.all.len() + chunk.all.len(),
                CellCorner { first_packet: to_u32(first_packet), ..CellCorner::UNKNOWN },
            );
            return;
        }
        self.packets.extend_from_slice(&chunk.packets);
        let moved = |corner: CellCorner| CellCorner {
            first_packet: to_u32(first_packet + corner.first_packet as usize),
            ..corner
        };
        self.all.extend(chunk.all.into_iter().map(moved));
    }

    /// Groups the packets that floods found by balls, so that a later triangulation can reuse them.
    pub(crate) fn list_packets_of_balls(&mut self, tree: &PacketTree) {
        let Some(FloodedCorners { of_packets, packet_counts }) = self.flooded.take() else { return };
        let mut total = 0;
        for (corner, count) in self.all.iter_mut().zip(packet_counts.into_iter().chain([0])) {
            corner.first_packet = to_u32(total);
            total += if corner.is_crowded { 0 } else { count as usize };
        }
        self.packets = vec![0; total];
        let mut next: Vec<u32> = self.all.iter().map(|corner| corner.first_packet).collect();
        for packet in 0..tree.leaves.packets.len() {
            for &corner in of_packets.get(packet).iter().filter(|corner| !self.all[**corner as usize].is_crowded) {
                self.packets[next[corner as usize] as usize] = to_u32(packet);
                next[corner as usize] += 1;
            }
        }
    }

    /// Returns the number of corners that are crowded or unknown.
    pub(crate) fn count_crowded(&self) -> usize {
        // The last corner only marks the end.
        self.all[..self.all.len() - 1].iter().filter(|corner| corner.is_crowded).count()
    }

    /// Returns the packets that intersect the ball of a corner. A corner that is or was crowded has none.
    fn packets(&self, number: usize) -> &[u32] {
        &self.packets[self.all[number].first_packet as usize..self.all[number + 1].first_packet as usize]
    }

    /// Moves the packets of all balls out. Returns the numbers of the corners of each of `packet_count` packets, in
    /// ascending order.
    pub(crate) fn take_corners_of_packets(&mut self, packet_count: usize) -> IncidenceLists {
        if let Some(flooded) = self.flooded.take() {
            return flooded.of_packets;
        }
        let numbers = 0..self.all.len() - 1;
        let found = numbers.flat_map(|number| self.packets(number).iter().map(move |packet| (*packet, to_u32(number))));
        let mut corners = IncidenceLists::new(packet_count, found.chain(self.late_packets.iter().copied()));
        for (packet, _) in std::mem::take(&mut self.late_packets) {
            corners.get_mut(packet as usize).sort_unstable();
        }
        self.packets = Vec::new();
        corners
    }

    /// Appends a corner with its packets.
    fn push(&mut self, corner: CellCorner, packets: impl Iterator<Item = u32>) {
        let first_packet = to_u32(self.packets.len());
        self.packets.extend(packets);
        self.all.push(CellCorner { first_packet, ..corner });
    }
}

/// The corners of an earlier triangulation, found by the tetrahedra of one that has more sites.
pub(crate) struct ReusedCorners<'a> {
    /// The corners of the earlier triangulation.
    pub(crate) corners: &'a CellCorners,
    /// For each tetrahedron of the later triangulation the number that it has in the earlier one, or
    /// [`Delaunay::NONE`].
    pub(crate) old_numbers: &'a [u32],
}

impl ReusedCorners<'_> {
    /// Returns the number that a tetrahedron has in the earlier triangulation, if it was there.
    fn find(&self, tetrahedron: usize) -> Option<usize> {
        self.old_numbers.get(tetrahedron).filter(|number| **number != Delaunay::NONE).map(|number| *number as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::voronoi::budget::BuildBudget;
    use nalgebra::Point3;
    use p2m_bvh::SplitOptions;
    use p2m_core::Segment;
    use p2m_testkit::{rng, vector};

    /// Balls that are not crowded keep their packets when these are sorted by balls, and a later triangulation of the
    /// same sites takes them over.
    #[test]
    fn packets_that_floods_found_are_reused() {
        let mut rng = rng("reused packets", 0);
        let segments: Vec<Segment<f64>> = (0..600)
            .map(|_| {
                let a = Point3::from(vector(&mut rng));
                Segment::new(a, a + vector(&mut rng))
            })
            .collect();
        let tree: PacketTree = PacketTree::build(&segments[..], &SplitOptions::default());
        let budget = &BuildBudget::new(1e6, 1e6, segments.len());
        let limits = Limits { slack: 1e-9, max_list_packets: 6, max_added_sites: 0, parallel: false, budget };
        let delaunay = Delaunay::new(&tree.leaves.vertices, 300.0).expect("finite");
        let mut corners = CellCorners::new(&tree, &delaunay, limits, None, &|_, _| ());
        let mut expected = vec![Vec::new(); delaunay.tetrahedra().len()];
        let flooded = corners.flooded.as_ref().expect("few packets");
        for packet in 0..tree.leaves.packets.len() {
            flooded.of_packets.get(packet).iter().for_each(|corner| expected[*corner as usize].push(to_u32(packet)));
        }
        corners.list_packets_of_balls(&tree);
        let old_numbers: Vec<u32> = (0..).take(delaunay.tetrahedra().len()).collect();
        let reused = ReusedCorners { corners: &corners, old_numbers: &old_numbers };
        let later = CellCorners::new(&tree, &delaunay, limits, Some(&reused), &|_, _| ());
        assert!(later.flooded.is_none());
        let mut crowded = 0;
        for (number, expected) in expected.iter().enumerate() {
            let is_crowded = corners.all[number].is_crowded;
            crowded += usize::from(is_crowded);
            assert!(is_crowded || expected.len() <= limits.max_list_packets, "{number}");
            assert_eq!(later.all[number].is_crowded, is_crowded, "{number}");
            for corners in [&corners, &later] {
                assert_eq!(corners.packets(number), if is_crowded { &[] } else { &expected[..] }, "{number}");
            }
        }
        assert!(crowded > 0 && crowded < expected.len(), "{crowded} of {}", expected.len());
    }
}
