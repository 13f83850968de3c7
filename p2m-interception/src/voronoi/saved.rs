//! Saving a P2M index and loading it.

use crate::voronoi::Voronoi;
use crate::voronoi::any_locator::AnyLocator;
use crate::voronoi::grid_locator::GridLocator;
use crate::voronoi::list_filter::ListFilters;
use crate::voronoi::locator::LocatorSites;
use crate::voronoi::neighbours::NeighbourTable;
use crate::voronoi::validate::{ANCHORS, LISTS, VORONOI, check};
use p2m_bvh::PacketTree;
use p2m_core::engine::vector::V3;
use p2m_core::storage::{LoadError, Reader, Saved, Writer, require};

/// The fields of a P2M index that are not arrays, in the layout of the section `voronoi` of the file.
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Header {
    per_unit: f64,
    unit: f64,
    slack: f64,
    low: V3,
    high: V3,
    /// The numbers of a [`P2mReport`](crate::P2mReport).
    report: [u64; 11],
    /// Whether the index has cells: 0 or 1.
    has_cells: u64,
}

impl Saved for Voronoi {
    fn kind() -> String {
        "p2m".to_owned()
    }

    fn save<'a>(&'a self, writer: &mut Writer<'a>) {
        let has_cells = u64::from(self.locator.is_some());
        let Self { per_unit, unit, slack, low, high, .. } = *self;
        let header = Header { per_unit, unit, slack, low, high, report: self.report.into(), has_cells };
        writer.put_copy(VORONOI, &[header]);
        writer.put(LISTS, &self.blocks);
        writer.put(ANCHORS, &self.anchors);
        self.neighbours.save(writer);
        match &self.locator {
            Some(AnyLocator::Grid(grid)) => grid.save(writer),
            Some(AnyLocator::Other(_)) => {
                let sites = LocatorSites::new(&self.tree, &self.neighbours, per_unit, [low, high]);
                GridLocator::new(&sites).save_copy(writer);
            }
            None => {}
        }
        self.tree.save(writer);
    }

    fn load(reader: &Reader, primitives: usize) -> Result<Self, LoadError> {
        let Header { per_unit, unit, slack, low, high, report, has_cells } = reader.one(VORONOI)?;
        require(has_cells <= 1, VORONOI, "the number that says whether there are cells is neither 0 nor 1")?;
        let neighbours = NeighbourTable::load(reader)?;
        let site_count = neighbours.sites.len();
        let locator = match has_cells {
            0 => None,
            _ => Some(AnyLocator::Grid(GridLocator::load(reader, site_count)?)),
        };
        let index = Self {
            tree: PacketTree::load(reader, primitives)?,
            per_unit,
            unit,
            slack,
            low,
            high,
            neighbours,
            locator,
            blocks: reader.array(LISTS)?,
            filters: ListFilters::default(),
            anchors: reader.array(ANCHORS)?,
            report: report.into(),
        };
        check(&index)?;
        Ok(index)
    }
}
