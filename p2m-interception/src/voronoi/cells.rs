//! Lists of Voronoi cells.
//!
//! The corner test says which primitives can beat the site v somewhere in its cell; with its function's values at the
//! corners more can be said. Along an edge of the cell, where a primitive t may beat v at one end and not at the other,
//! the function d(q, t)^2 - (|q - v| + s)^2 is concave and lies above its chord, so t cannot beat v beyond the zero of
//! the chord. The corners and these zeros span all places where t may be the answer (the *region* of t, docs/proofs/p2m.md).
//!
//! A feature of t matters only if it can be nearest in the region. If all that matter belong to a primitive of a lower
//! id as well, t is never the answer: the other one is as near, by the same bits, and the lower id wins.

use crate::delaunay::BOUNDING;
use crate::list::block::{Block, Bounds, Entry};
use crate::options::P2mReport;
use crate::parallel_chunks::in_shares;
use crate::progress::{BuildStage, Teller};
use crate::voronoi::adjacency::{Features, Incidences};
use crate::voronoi::cell::{Cell, Cells};
use crate::voronoi::feature_relevance::Outlines;
use crate::voronoi::list_filter::{Filters, ListFilter};
use crate::voronoi::neighbours::Fans;
use crate::voronoi::site::{AUXILIARY, Outside, TREE};
use std::ops::Range;
use std::sync::Arc;

/// The sites with their neighbours, the blocks of their lists, the first one of each at its own number, and the filters
/// of long ones.
pub(crate) struct Lists {
    pub(crate) fans: Fans,
    pub(crate) blocks: Vec<Block>,
    pub(crate) filters: Filters,
}

impl Cells<'_> {
    /// The lists of all sites; `None` where these take too much. `teller` is told how many are done.
    pub(crate) fn lists(&self, report: &mut P2mReport, teller: &Teller<'_>) -> Option<Lists> {
        teller.begin(BuildStage::Lists);
        let sites = self.sites.delaunay.sites();
        let tetrahedra = self.sites.delaunay.tetrahedra();
        let around = Incidences::new(
            sites.len(),
            (0..).zip(tetrahedra).flat_map(|(number, tetrahedron)| tetrahedron.iter().map(move |v| (*v, number))),
        );
        let features = Features::of(self.tree, &self.sites.delaunay);
        let slack = self.limits.slack / self.sites.delaunay.unit();
        let mut fans = Fans::new(sites, BOUNDING, slack, |site, all, edges| {
            let neighbours = around.of(site).iter().flat_map(|t| tetrahedra[*t as usize]);
            all.extend(neighbours.filter(|v| *v as usize >= BOUNDING && *v as usize != site));
            edges.extend_from_slice(features.edges.of(site));
        });
        let nothing =
            Block::of_list(&[Entry { packet: 0, lanes: 0, bounds: [[0.0; 3]; 2], f: [0.0; 8] }], Bounds::Boxes);
        let mut blocks = vec![nothing[0]; sites.len()];
        let mut filters = if self.filter.is_some() { Filters::new(sites.len()) } else { Filters::default() };
        let mut records = fans.sites.edit(std::mem::take);
        report.added = self.sites.added;
        let outlines = Outlines::of(self.tree);
        let work = |share| self.share(share, &around, &features, &outlines);
        let allowance = self.limits.allowance;
        in_shares(sites.len(), self.limits.parallel, work, |share: Share| {
            if !allowance.holds::<Block>(blocks.len() + share.blocks.len()) {
                return;
            }
            for made in share.cells {
                let to = &mut records[made.site];
                (to.owner, to.list) = (features.owners[made.site], TREE);
                match made.list {
                    List::Tree => report.trees += usize::from(made.site >= BOUNDING),
                    List::Auxiliary(anchor) => {
                        (to.owner, to.list) = (anchor, AUXILIARY);
                        report.auxiliary += 1;
                    }
                    List::Blocks(own) => {
                        to.list = u32::try_from(blocks.len()).expect("numbers of 32 bits");
                        to.outside = made.outside.unwrap_or(to.outside);
                        blocks[made.site] = share.blocks[own.start];
                        blocks.extend_from_slice(&share.blocks[own.start + 1..own.end]);
                        if let Some(filter) = made.filter {
                            filters.add(made.site, filter);
                        }
                        report.lists += 1;
                    }
                }
                teller.reach([30.0, 100.0], made.site, sites.len());
            }
            report.entries += share.entries;
            report.candidates += share.candidates;
            report.most_candidates = report.most_candidates.max(share.most_candidates);
            report.primitives += share.primitives;
        });
        fans.sites = records.into();
        (!allowance.is_over()).then_some(Lists { fans, blocks, filters })
    }

    /// The lists of some sites.
    fn share(&self, sites: Range<usize>, around: &Incidences, features: &Features, outlines: &Outlines) -> Share {
        let corners = &self.sites.corners;
        let mut share = Share {
            cells: Vec::new(),
            blocks: Vec::new(),
            entries: 0,
            primitives: 0,
            candidates: 0,
            most_candidates: 0,
        };
        let mut cell = Cell::default();
        for site in sites {
            if self.limits.allowance.is_over() {
                break;
            }
            let own = around.of(site);
            let mut made = Made { site, list: List::Tree, outside: None, filter: None };
            if let Some(anchor) = self.sites.anchor_of(site) {
                made.list = List::Auxiliary(u32::try_from(anchor).expect("numbers of 32 bits"));
            } else if site >= BOUNDING && !own.iter().any(|t| corners.all[*t as usize].full) {
                cell.gather(self, corners, site, own);
                share.candidates += cell.packets.len();
                share.most_candidates = share.most_candidates.max(cell.packets.len());
                let few = cell.packets.len() <= self.limits.most;
                let entries = if few { cell.entries(self, features, outlines) } else { Vec::new() };
                if !entries.is_empty() {
                    let primitives: usize = entries.iter().map(|entry| entry.lanes.count_ones() as usize).sum();
                    share.primitives += primitives;
                    made.filter = self
                        .filter
                        .filter(|(above, _)| primitives > *above)
                        .map(|(_, build)| build(cell.regions(self, &entries)));
                    made.outside = cell.outside(self, features, &entries);
                    let first = share.blocks.len();
                    share.blocks.extend(Block::of_list(&entries, Bounds::Boxes));
                    share.entries += entries.len();
                    made.list = List::Blocks(first..share.blocks.len());
                }
            }
            self.limits.allowance.spend(std::mem::take(&mut cell.values.tests));
            share.cells.push(made);
        }
        share
    }
}

/// The lists of some sites.
struct Share {
    cells: Vec<Made>,
    blocks: Vec<Block>,
    entries: usize,
    primitives: usize,
    candidates: usize,
    most_candidates: usize,
}

/// What is known of a cell.
struct Made {
    site: usize,
    list: List,
    outside: Option<Outside>,
    filter: Option<Arc<dyn ListFilter>>,
}

enum List {
    /// The tree answers,
    Tree,
    /// from the bound of an anchor,
    Auxiliary(u32),
    /// or blocks of the share do.
    Blocks(Range<usize>),
}
