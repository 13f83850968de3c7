//! The packets in the lists of all cells.
//!
//! The balls of corners give the tetrahedra around each packet. Each packet is examined by itself
//! ([`packet_cells`](crate::voronoi::packet_cells)), in tasks that may run in parallel, and the results of the packets
//! are then sorted by cells.

use crate::delaunay::BOUNDING;
use crate::options::P2mReport;
use crate::parallel_chunks::map_chunks_in_order;
use crate::progress::ProgressReporter;
use crate::voronoi::adjacency::{EdgeAdjacency, IncidenceLists};
use crate::voronoi::budget::to_u32;
use crate::voronoi::cell::CellContext;
use crate::voronoi::cell_polytope::margin;
use crate::voronoi::feature_relevance::RelevanceContext;
use crate::voronoi::list_filter::Region;
use crate::voronoi::packet_cells::{CellSize, FindRelevantLanes, PacketCells, PacketInCell};
use p2m_core::engine::vector::{norm_squared, sub};
use std::ops::Range;

/// The number of packets that one task examines.
const PACKETS_PER_TASK: usize = 64;

/// The number of sites whose cells one task measures.
const MEASURED_SITES_PER_TASK: usize = 1024;

/// A packet in the list of a cell.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ListedPacket {
    /// The number of the packet.
    pub(crate) packet: u32,
    /// The lanes that can hold the answer in the cell, as bits. There is at least one.
    pub(crate) lanes: u16,
}

/// The packets of all cells.
pub(crate) struct CellPackets {
    /// The lengths of each cell that gets a list.
    sizes: Vec<Option<CellSize>>,
    /// For each packet, the tetrahedra whose balls it intersects. `None` if no list gets a filter.
    near_tetrahedra: Option<IncidenceLists>,
    /// For each site its packets, in ascending order.
    of_sites: IncidenceLists<ListedPacket>,
}

impl CellPackets {
    /// Finds the packets of all cells except hubs. They are incomplete if the budget is exceeded.
    pub(crate) fn find(
        cells: &CellContext<'_>,
        adjacency: &EdgeAdjacency,
        incident_tetrahedra: &IncidenceLists,
        near_tetrahedra: IncidenceLists,
        is_hub: impl Fn(usize) -> bool + Sync,
        report: &mut P2mReport,
        reporter: &ProgressReporter<'_>,
    ) -> Self {
        let (sites, corners) = (&cells.sites.delaunay.sites(), &cells.sites.corners);
        let has_list = |site: usize| {
            site >= BOUNDING
                && !is_hub(site)
                && cells.sites.anchor_of(site).is_none()
                && !incident_tetrahedra.get(site).iter().any(|t| corners.all[*t as usize].is_crowded)
        };
        let size_of = |site: usize| has_list(site).then(|| cells.measure(site, incident_tetrahedra.get(site)));
        let packet_count = cells.tree.leaves.packets.len();
        let mut sizes: Vec<Option<CellSize>> = Vec::with_capacity(sites.len());
        let measure = |sites: Range<usize>| sites.map(size_of).collect();
        map_chunks_in_order(sites.len(), MEASURED_SITES_PER_TASK, cells.limits.parallel, measure, |chunk: Vec<_>| {
            sizes.extend(chunk);
        });
        // A single vector of all packets would be copied as it grows.
        let mut packets: Vec<Vec<PacketInCell>> = Vec::new();
        let (mut packets_in_cells, mut candidates) = (0, vec![0u32; sites.len()]);
        let (budget, parallel) = (cells.limits.budget, cells.limits.parallel);
        let scene = RelevanceContext {
            tree: cells.tree,
            delaunay: &cells.sites.delaunay,
            adjacency,
            slack: cells.limits.slack,
        };
        let work = |chunk: Range<usize>| {
            let (mut packet, mut found) = (PacketCells::default(), Vec::new());
            for number in chunk {
                if budget.is_exceeded() {
                    break;
                }
                packet.begin(cells, &sizes, to_u32(number), near_tetrahedra.get(number));
                let sizes = &sizes;
                cells.tree.isa().run(FindRelevantLanes { scene, sizes, packet: &mut packet, found: &mut found });
                budget.charge(std::mem::take(&mut packet.values.tests));
            }
            found
        };
        let mut done = 0;
        map_chunks_in_order(packet_count, PACKETS_PER_TASK, parallel, work, |mut chunk: Vec<PacketInCell>| {
            if budget.fits::<PacketInCell>(packets_in_cells + chunk.len()) {
                packets_in_cells += chunk.len();
                chunk.iter().for_each(|packet| candidates[packet.site as usize] += 1);
                chunk.retain(|packet| packet.lanes != 0);
                chunk.shrink_to_fit();
                packets.push(chunk);
            }
            done = packet_count.min(done + PACKETS_PER_TASK);
            reporter.advance([30.0, 80.0], done, packet_count);
        });
        let near_tetrahedra = cells.filter.is_some().then_some(near_tetrahedra);
        let listed = packets
            .iter()
            .flatten()
            .map(|&PacketInCell { site, packet, lanes }| (site, ListedPacket { packet, lanes }));
        let of_sites = IncidenceLists::new(sites.len(), listed);
        for (size, candidates) in sizes.iter_mut().zip(candidates) {
            let candidates = candidates as usize;
            report.candidates += candidates;
            report.max_candidates = report.max_candidates.max(candidates);
            if candidates > cells.limits.max_list_packets {
                *size = None;
            }
        }
        Self { sizes, near_tetrahedra, of_sites }
    }

    /// Returns the packets of a site in ascending order. A site without a list has none.
    pub(crate) fn of_site(&self, site: usize) -> &[ListedPacket] {
        if self.sizes[site].is_some() { self.of_sites.get(site) } else { &[] }
    }

    /// Finds the regions of all primitives in the cells of some sites, sorted by the sites. There are none if no list
    /// gets a filter.
    pub(crate) fn find_regions(
        &self,
        cells: &CellContext<'_>,
        is_wanted: impl Fn(usize) -> bool + Sync,
    ) -> Vec<(u32, Region)> {
        let Some(near_tetrahedra) = &self.near_tetrahedra else { return Vec::new() };
        let work = |chunk: Range<usize>| {
            let (mut packet, mut regions) = (PacketCells::default(), Vec::new());
            for number in chunk {
                packet.begin(cells, &self.sizes, to_u32(number), near_tetrahedra.get(number));
                let lanes_of = |site: u32| {
                    let packets = if is_wanted(site as usize) { self.of_site(site as usize) } else { &[] };
                    let found = packets.binary_search_by_key(&number, |packet| packet.packet as usize);
                    found.map_or(0, |found| packets[found].lanes)
                };
                packet.visit_regions(lanes_of, |site, lane, points| {
                    let CellSize { max_distance, max_error } = self.sizes[site as usize].expect("a cell with a list");
                    let padding = margin(max_distance, max_error);
                    regions.push((site, Region::from_points(points.iter(), padding, to_u32(number), lane)));
                });
            }
            regions
        };
        let mut regions = Vec::new();
        let packet_count = cells.tree.leaves.packets.len();
        map_chunks_in_order(packet_count, PACKETS_PER_TASK, cells.limits.parallel, work, |chunk| regions.extend(chunk));
        regions.sort_by_key(|(site, _)| *site);
        regions
    }
}

impl CellContext<'_> {
    /// Returns the lengths of a cell whose corners are known.
    fn measure(&self, site: usize, tetrahedra: &[u32]) -> CellSize {
        let position = self.sites.delaunay.sites()[site].map(|x| x * self.sites.delaunay.unit());
        let mut size = CellSize { max_distance: 0.0, max_error: 0.0 };
        for tetrahedron in tetrahedra {
            let corner = &self.sites.corners.all[*tetrahedron as usize];
            let distance = norm_squared(sub(corner.position, position)).sqrt() * (1.0 + 8.0 * f64::EPSILON);
            size.max_distance = size.max_distance.max(distance + corner.error + self.limits.slack);
            size.max_error = size.max_error.max(corner.error);
        }
        size
    }
}
