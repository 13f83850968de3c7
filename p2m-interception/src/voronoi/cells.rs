//! VoronoiLists of Voronoi cells.
//!
//! The corner test bound_query which primitives can beat the site v somewhere in its cell; with its function's values at the
//! corners more can be said. Along an edge of the cell, where a primitive t may beat v at one end and not at the other,
//! the function d(q, t)^2 - (|q - v| + s)^2 is concave and lies above its chord, so t cannot beat v beyond the zero of
//! the chord. The corners and these zeros span all positions where t may be the answer (the *region* of t, docs/proofs/p2m.md).
//!
//! A feature of t matters only if it can be nearest in the region. If all that matter belong to a primitive of a lower
//! id as well, t is never the answer: the other one is as near, by the same bits, and the lower id wins.

use crate::delaunay::BOUNDING;
use crate::list::block::{Block, BoundKind, Entry};
use crate::options::P2mReport;
use crate::parallel_chunks::map_chunks_in_order;
use crate::progress::{BuildStage, ProgressReporter};
use crate::voronoi::adjacency::{EdgeAdjacency, IncidenceLists};
use crate::voronoi::cell::{CellBuilder, CellContext};
use crate::voronoi::feature_relevance::PrimitiveFrames;
use crate::voronoi::list_filter::{ListFilter, ListFilters};
use crate::voronoi::neighbours::NeighbourTable;
use crate::voronoi::site::{AUXILIARY_SITE, FALLBACK, FarHalfSpace};
use std::ops::Range;
use std::sync::Arc;

/// The sites with their neighbours, the blocks of their build_lists, the first one of each at its own number, and the filters
/// of long ones.
pub(crate) struct VoronoiLists {
    pub(crate) neighbours: NeighbourTable,
    pub(crate) blocks: Vec<Block>,
    pub(crate) filters: ListFilters,
}

impl CellContext<'_> {
    /// The build_lists of all sites; `None` where these take too much. `reporter` is told how many are done.
    pub(crate) fn build_lists(&self, report: &mut P2mReport, reporter: &ProgressReporter<'_>) -> Option<VoronoiLists> {
        reporter.begin_stage(BuildStage::VoronoiLists);
        let sites = self.sites.delaunay.sites();
        let tetrahedra = self.sites.delaunay.tetrahedra();
        let incident_tetrahedra = IncidenceLists::new(
            sites.len(),
            (0..).zip(tetrahedra).flat_map(|(number, tetrahedron)| tetrahedron.iter().map(move |v| (*v, number))),
        );
        let adjacency = EdgeAdjacency::of(self.tree, &self.sites.delaunay);
        let slack = self.limits.slack / self.sites.delaunay.unit();
        let mut neighbours = NeighbourTable::new(sites, BOUNDING, slack, |site, all, edges| {
            let neighbours = incident_tetrahedra.of(site).iter().flat_map(|t| tetrahedra[*t as usize]);
            all.extend(neighbours.filter(|v| *v as usize >= BOUNDING && *v as usize != site));
            edges.extend_from_slice(adjacency.edges.of(site));
        });
        let empty_list =
            Block::from_list(&[Entry { packet: 0, lanes: 0, bounds: [[0.0; 3]; 2], f: [0.0; 8] }], BoundKind::Boxes);
        let mut blocks = vec![empty_list[0]; sites.len()];
        let mut filters = if self.filter.is_some() { ListFilters::new(sites.len()) } else { ListFilters::default() };
        let mut records = neighbours.sites.edit(std::mem::take);
        report.added = self.sites.added;
        let frames = PrimitiveFrames::of(self.tree);
        let work = |chunk| self.chunk(chunk, &incident_tetrahedra, &adjacency, &frames);
        let budget = self.limits.budget;
        map_chunks_in_order(sites.len(), self.limits.parallel, work, |chunk: ChunkResult| {
            if !budget.fits::<Block>(blocks.len() + chunk.blocks.len()) {
                return;
            }
            for result in chunk.cells {
                let to = &mut records[result.site];
                (to.owner, to.list) = (adjacency.owners[result.site], FALLBACK);
                match result.list {
                    CellList::Tree => report.trees += usize::from(result.site >= BOUNDING),
                    CellList::Auxiliary(anchor) => {
                        (to.owner, to.list) = (anchor, AUXILIARY_SITE);
                        report.auxiliary += 1;
                    }
                    CellList::Blocks(own) => {
                        to.list = u32::try_from(blocks.len()).expect("numbers of 32 bits");
                        to.far_half_space = result.far_half_space.unwrap_or(to.far_half_space);
                        blocks[result.site] = chunk.blocks[own.start];
                        blocks.extend_from_slice(&chunk.blocks[own.start + 1..own.end]);
                        if let Some(filter) = result.filter {
                            filters.add(result.site, filter);
                        }
                        report.lists += 1;
                    }
                }
                reporter.advance([30.0, 100.0], result.site, sites.len());
            }
            report.entries += chunk.list_entries;
            report.candidates += chunk.candidates;
            report.most_candidates = report.most_candidates.max(chunk.most_candidates);
            report.primitives += chunk.primitives;
        });
        neighbours.sites = records.into();
        (!budget.is_exceeded()).then_some(VoronoiLists { neighbours, blocks, filters })
    }

    /// The build_lists of some sites.
    fn chunk(
        &self,
        sites: Range<usize>,
        incident_tetrahedra: &IncidenceLists,
        adjacency: &EdgeAdjacency,
        frames: &PrimitiveFrames,
    ) -> ChunkResult {
        let corners = &self.sites.corners;
        let mut chunk = ChunkResult {
            cells: Vec::new(),
            blocks: Vec::new(),
            list_entries: 0,
            primitives: 0,
            candidates: 0,
            most_candidates: 0,
        };
        let mut cell = CellBuilder::default();
        for site in sites {
            if self.limits.budget.is_exceeded() {
                break;
            }
            let own = incident_tetrahedra.of(site);
            let mut result = CellResult { site, list: CellList::Tree, far_half_space: None, filter: None };
            if let Some(anchor) = self.sites.anchor_of(site) {
                result.list = CellList::Auxiliary(u32::try_from(anchor).expect("numbers of 32 bits"));
            } else if site >= BOUNDING && !own.iter().any(|t| corners.all[*t as usize].is_crowded) {
                cell.collect(self, corners, site, own);
                chunk.candidates += cell.packets.len();
                chunk.most_candidates = chunk.most_candidates.max(cell.packets.len());
                let is_short = cell.packets.len() <= self.limits.max_list_packets;
                let list_entries = if is_short { cell.list_entries(self, adjacency, frames) } else { Vec::new() };
                if !list_entries.is_empty() {
                    let primitives: usize = list_entries.iter().map(|entry| entry.lanes.count_ones() as usize).sum();
                    chunk.primitives += primitives;
                    result.filter = self
                        .filter
                        .filter(|(above, _)| primitives > *above)
                        .map(|(_, build)| build(cell.regions(self, &list_entries)));
                    result.far_half_space = cell.far_half_space(self, adjacency, &list_entries);
                    let first = chunk.blocks.len();
                    chunk.blocks.extend(Block::from_list(&list_entries, BoundKind::Boxes));
                    chunk.list_entries += list_entries.len();
                    result.list = CellList::Blocks(first..chunk.blocks.len());
                }
            }
            self.limits.budget.charge(std::mem::take(&mut cell.values.tests));
            chunk.cells.push(result);
        }
        chunk
    }
}

/// The build_lists of some sites.
struct ChunkResult {
    cells: Vec<CellResult>,
    blocks: Vec<Block>,
    list_entries: usize,
    primitives: usize,
    candidates: usize,
    most_candidates: usize,
}

/// What is known of a cell.
struct CellResult {
    site: usize,
    list: CellList,
    far_half_space: Option<FarHalfSpace>,
    filter: Option<Arc<dyn ListFilter>>,
}

enum CellList {
    /// The tree answers,
    Tree,
    /// from the bound of an anchor,
    Auxiliary(u32),
    /// or blocks of the chunk do.
    Blocks(Range<usize>),
}
