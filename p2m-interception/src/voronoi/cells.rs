//! The lists of all Voronoi cells.
//!
//! The corner test excludes a primitive t that cannot beat the site v anywhere in its cell. The values of its function
//! F(q) = d(q, t)^2 - (|q - v| + s)^2 at the corners, where s is the slack of the corner test, restrict the places
//! where t can beat v. Take an edge of the cell with F <= 0 at one end and F > 0 at the other. F is concave, so it lies
//! above its chord, and t cannot beat v beyond the zero of the chord. Therefore t can be the answer only in the convex
//! hull of the corners where F <= 0 and of these zeros, which is the *region* of t ([docs/proofs/p2m.md]). The packets
//! of all cells are found packet by packet ([`packet_cells`](crate::voronoi::packet_cells)).
//!
//! A feature of t is *relevant* only if it can be nearest somewhere in the region
//! ([`feature_relevance`](crate::voronoi::feature_relevance)). If each relevant feature of t also belongs to
//! some primitive with a lower id, t is never the answer: the owner of the nearest feature is as near, by the same
//! bits, and its lower id wins.
//!
//! [docs/proofs/p2m.md]: https://github.com/p2m-rs/p2m/blob/main/docs/proofs/p2m.md

use crate::delaunay::BOUNDING;
use crate::list::block::{BLOCK_WIDTH, Block, BoundKind, Entry};
use crate::options::P2mReport;
use crate::parallel_chunks::map_chunks_in_order;
use crate::progress::{BuildStage, ProgressReporter};
use crate::voronoi::adjacency::{EdgeAdjacency, IncidenceLists, SiteTopology};
use crate::voronoi::any_locator::AnyLocator;
use crate::voronoi::cell::{CellContext, FarPartBuilder};
use crate::voronoi::cell_packets::{CellPackets, ListedPacket};
use crate::voronoi::corner_values::SiteDistances;
use crate::voronoi::list_filter::{ListFilter, ListFilters, Region};
use crate::voronoi::neighbours::NeighbourTable;
use crate::voronoi::site::{AUXILIARY_SITE, FALLBACK, FarHalfSpace};
use p2m_core::engine::parallel::run_beside;
use std::ops::Range;
use std::sync::Arc;

/// The largest number of neighbours plus edges of primitives at a site that is not a *hub*. The number of neighbours is
/// estimated as half the number of the tetrahedra at the site.
///
/// The table has no neighbours of a hub, so a walk ends there, and the tree answers in its cell. Otherwise a query in
/// the cell of a site that all others surround would test all of them: at this number, that takes about as long as the
/// search of a tree.
const MAX_NEIGHBOURS: usize = 1024;

/// The number of sites whose lists one task builds.
const SITES_PER_TASK: usize = 256;

/// The sites with their lists.
pub(crate) struct VoronoiLists {
    /// The sites, their neighbours, and where their lists are.
    pub(crate) neighbours: NeighbourTable,
    /// The locator, if there were threads to build it beside the lists.
    pub(crate) locator: Option<AnyLocator>,
    /// The blocks of the lists. The first block of a list has the number of its site.
    pub(crate) blocks: Vec<Block>,
    /// The filters of long lists.
    pub(crate) filters: ListFilters,
}

impl CellContext<'_> {
    /// Builds the lists of all sites, or returns `None` if that exceeds the budget. `near_tetrahedra` has, for each
    /// packet, the tetrahedra whose balls it intersects. `build_locator` is called if another thread can run it beside
    /// the search for the lists.
    pub(crate) fn build_lists(
        &self,
        near_tetrahedra: IncidenceLists,
        build_locator: impl Fn(&NeighbourTable) -> AnyLocator + Sync,
        report: &mut P2mReport,
        reporter: &ProgressReporter<'_>,
    ) -> Option<VoronoiLists> {
        reporter.begin_stage(BuildStage::Lists);
        let sites = self.sites.delaunay.sites();
        let tetrahedra = self.sites.delaunay.tetrahedra();
        let SiteTopology { adjacency, incident_tetrahedra } = &self.sites.topology;
        let is_hub =
            |site: usize| incident_tetrahedra.get(site).len() / 2 + adjacency.edges.get(site).len() > MAX_NEIGHBOURS;
        let slack = self.limits.slack / self.sites.delaunay.unit();
        let list_neighbours = |site: usize, all: &mut Vec<u32>, edges: &mut Vec<u32>| {
            if is_hub(site) {
                return;
            }
            let neighbours = incident_tetrahedra.get(site).iter().flat_map(|t| tetrahedra[*t as usize]);
            all.extend(neighbours.filter(|v| *v as usize >= BOUNDING && *v as usize != site));
            edges.extend_from_slice(adjacency.edges.get(site));
        };
        let parallel = self.limits.parallel;
        let ((mut neighbours, locator), packets) = run_beside(
            parallel,
            || {
                let neighbours = NeighbourTable::new(sites, BOUNDING, slack, list_neighbours);
                let locator = parallel.then(|| build_locator(&neighbours));
                (neighbours, locator)
            },
            || CellPackets::find(self, adjacency, incident_tetrahedra, near_tetrahedra, is_hub, report, reporter),
        );
        let empty_list: Vec<Block> =
            Block::from_list(&[Entry { packet: 0, lanes: 0, bounds: [[0.0; 3]; 2], f: [0.0; 8] }], BoundKind::Boxes)
                .collect();
        let further_blocks = |site| packets.of_site(site).len().div_ceil(BLOCK_WIDTH).saturating_sub(1);
        let mut blocks = Vec::with_capacity(sites.len() + (0..sites.len()).map(further_blocks).sum::<usize>());
        blocks.resize(sites.len(), empty_list[0]);
        let mut filters = if self.filter.is_some() { ListFilters::new(sites.len()) } else { ListFilters::default() };
        let mut filled_sites = neighbours.sites.edit(std::mem::take);
        report.added = self.sites.added;
        let budget = self.limits.budget;
        let regions = self.filter.map_or_else(Vec::new, |(above, _)| {
            packets.find_regions(self, |site| {
                packets.of_site(site).iter().map(|packet| packet.lanes.count_ones() as usize).sum::<usize>() > above
            })
        });
        let lists = ListBuilder { cells: self, adjacency, incident_tetrahedra, packets, regions };
        let work = |chunk| lists.build_chunk(chunk);
        map_chunks_in_order(sites.len(), SITES_PER_TASK, parallel, work, |chunk: ChunkResult| {
            if !budget.fits::<Block>(blocks.len() + chunk.blocks.len()) {
                return;
            }
            for result in chunk.cells {
                let record = &mut filled_sites[result.site];
                (record.owner, record.list) = (adjacency.owners[result.site], FALLBACK);
                match result.list {
                    CellList::Tree => report.fallback_cells += usize::from(result.site >= BOUNDING),
                    CellList::Auxiliary(anchor) => {
                        (record.owner, record.list) = (anchor, AUXILIARY_SITE);
                        report.auxiliary += 1;
                    }
                    CellList::Blocks(range) => {
                        record.list = u32::try_from(blocks.len()).expect("numbers of 32 bits");
                        record.far_half_space = result.far_half_space.unwrap_or(record.far_half_space);
                        blocks[result.site] = chunk.blocks[range.start];
                        blocks.extend_from_slice(&chunk.blocks[range.start + 1..range.end]);
                        if let Some(filter) = result.filter {
                            filters.add(result.site, filter);
                        }
                        report.list_cells += 1;
                    }
                }
                reporter.advance([80.0, 100.0], result.site, sites.len());
            }
            report.entries += chunk.entries;
            report.primitives += chunk.primitives;
        });
        neighbours.sites = filled_sites.into();
        (!budget.is_exceeded()).then_some(VoronoiLists { neighbours, locator, blocks, filters })
    }
}

/// The data from which lists are built.
struct ListBuilder<'a> {
    /// The data that all cells share.
    cells: &'a CellContext<'a>,
    /// The edges of the primitives.
    adjacency: &'a EdgeAdjacency,
    /// For each site the tetrahedra at it.
    incident_tetrahedra: &'a IncidenceLists,
    /// The packets of all cells.
    packets: CellPackets,
    /// The regions in cells with a filter, sorted by the sites.
    regions: Vec<(u32, Region)>,
}

impl ListBuilder<'_> {
    /// Builds the lists of some sites.
    fn build_chunk(&self, sites: Range<usize>) -> ChunkResult {
        let cells = self.cells;
        let mut chunk = ChunkResult { cells: Vec::new(), blocks: Vec::new(), entries: 0, primitives: 0 };
        let mut far_part = FarPartBuilder::default();
        for site in sites {
            if cells.limits.budget.is_exceeded() {
                break;
            }
            let mut result = CellResult { site, list: CellList::Tree, far_half_space: None, filter: None };
            let entries = self.list_entries(site);
            if let Some(anchor) = cells.sites.anchor_of(site) {
                result.list = CellList::Auxiliary(u32::try_from(anchor).expect("numbers of 32 bits"));
            } else if !entries.is_empty() {
                let primitives: usize = entries.iter().map(|entry| entry.lanes.count_ones() as usize).sum();
                chunk.primitives += primitives;
                result.filter = cells
                    .filter
                    .filter(|(above, _)| primitives > *above)
                    .map(|(_, build)| build(self.regions_of(site)));
                result.far_half_space =
                    far_part.half_space(cells, self.adjacency, site, self.incident_tetrahedra.get(site), &entries);
                let first = chunk.blocks.len();
                chunk.blocks.extend(Block::from_list(&entries, BoundKind::Boxes));
                chunk.entries += entries.len();
                result.list = CellList::Blocks(first..chunk.blocks.len());
            }
            cells.limits.budget.charge(std::mem::take(&mut far_part.values.tests));
            chunk.cells.push(result);
        }
        chunk
    }

    /// Returns the entries of the list of a site, the nearest packets first.
    fn list_entries(&self, site: usize) -> Vec<Entry> {
        let (tree, delaunay) = (self.cells.tree, &self.cells.sites.delaunay);
        let position = delaunay.sites()[site].map(|x| x * delaunay.unit());
        let mut entries: Vec<(f64, Entry)> = Vec::new();
        for &ListedPacket { packet: number, lanes } in self.packets.of_site(site) {
            let packet = &tree.leaves.packets[number as usize];
            let order = SiteDistances::new(tree, packet, &position).least(lanes) * packet.unit();
            let bounds = tree.frame.enclose(&packet.bounds_of(lanes));
            entries.push((order, Entry { packet: number, lanes, bounds, f: [0.0; 8] }));
        }
        entries.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.packet.cmp(&b.1.packet)));
        entries.into_iter().map(|e| e.1).collect()
    }

    /// Returns the regions of the primitives in the list of a site.
    fn regions_of(&self, site: usize) -> Vec<Region> {
        let first = self.regions.partition_point(|(other, _)| (*other as usize) < site);
        self.regions[first..]
            .iter()
            .take_while(|(other, _)| *other as usize == site)
            .map(|(_, region)| *region)
            .collect()
    }
}

/// The lists of a chunk of sites, with their part of the report.
struct ChunkResult {
    /// The cells in the order of their sites.
    cells: Vec<CellResult>,
    /// The blocks of all lists.
    blocks: Vec<Block>,
    /// The number of packets in the lists.
    entries: usize,
    /// The number of primitives in the lists.
    primitives: usize,
}

/// The result of one cell.
struct CellResult {
    /// The number of the site.
    site: usize,
    /// Where the list is.
    list: CellList,
    /// The far half-space of the site, if it has one.
    far_half_space: Option<FarHalfSpace>,
    /// The filter of the list, if it has one.
    filter: Option<Arc<dyn ListFilter>>,
}

/// How the queries in a cell are answered.
enum CellList {
    /// The tree answers.
    Tree,
    /// The tree answers from the bound of the anchor with this number.
    Auxiliary(u32),
    /// A list answers. The field is the range of its blocks in the chunk.
    Blocks(Range<usize>),
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::P2mIndex;
    use crate::voronoi::neighbour_block::NEIGHBOURS_PER_BLOCK;
    use p2m_core::{BruteForce, ClosestPoint, Soup};
    use p2m_testkit::{adversaries, amount, rng, vector};
    use rand::RngExt;

    /// All segments of the star begin at one site, which is a hub if there are enough of them.
    #[test]
    fn a_hub_has_no_neighbours_and_the_tree_answers_in_its_cell() {
        for (count, is_hub) in [(400, false), (1_400, true)] {
            let soup = adversaries::Adversary::named("star").soup(count);
            let index = P2mIndex::<f64, &Soup<f64>>::new(&soup).expect("valid");
            let sites = &index.partition().neighbours.sites;
            let most = sites.iter().map(|site| site.block_count as usize * NEIGHBOURS_PER_BLOCK).max().expect("sites");
            assert!(most < MAX_NEIGHBOURS + NEIGHBOURS_PER_BLOCK && (most >= count) != is_hub, "{count}: {most}");
            let (brute, mut rng) = (BruteForce::new(&soup).expect("valid"), rng("hub", count as u64));
            for _ in 0..amount(2_000, 200) {
                let query = nalgebra::Point3::from(vector(&mut rng) * rng.random_range(0.0..3.0));
                let [found, expected] = [index.closest_point(&query), brute.closest_point(&query)];
                assert_eq!(found.map(|c| (c.distance, c.primitive)), expected.map(|c| (c.distance, c.primitive)));
            }
        }
    }
}
