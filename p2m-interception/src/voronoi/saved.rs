//! Saving a P2M index and loading it.

use crate::list::block::Block;
use crate::voronoi::Voronoi;
use crate::voronoi::any_locator::AnyLocator;
use crate::voronoi::grid_locator::GridLocator;
use crate::voronoi::list_filter::ListFilters;
use crate::voronoi::neighbours::NeighbourTable;
use p2m_bvh::PacketTree;
use p2m_core::engine::vector::V3;
use p2m_core::storage::{Array, LoadError, Reader, Saved, Writer};

/// The fields of a P2M index that are not arrays. The layout is that of the section `voronoi` of the file.
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
        writer.put_copy("voronoi", &[header]);
        writer.put("voronoi/lists", &self.blocks);
        writer.put("voronoi/anchors", &self.anchors);
        self.neighbours.save(writer);
        match &self.locator {
            Some(AnyLocator::Grid(grid)) => grid.save(writer),
            Some(AnyLocator::Other(_)) => GridLocator::new(&self.locator_sites()).save_copy(writer),
            None => {}
        }
        self.tree.save(writer);
    }

    fn load(reader: &Reader) -> Result<Self, LoadError> {
        let Header { per_unit, unit, slack, low, high, report, has_cells } = reader.one("voronoi")?;
        let locator = if has_cells == 0 { None } else { Some(AnyLocator::Grid(GridLocator::load(reader)?)) };
        let neighbours = NeighbourTable::load(reader)?;
        let blocks: Array<Block> = reader.array("voronoi/lists")?;
        if blocks.len() < neighbours.sites.len() {
            return Err(LoadError::Inconsistent { section: "voronoi/lists".to_owned() });
        }
        Ok(Self {
            tree: PacketTree::load(reader)?,
            per_unit,
            unit,
            slack,
            low,
            high,
            neighbours,
            locator,
            blocks,
            filters: ListFilters::default(),
            anchors: reader.array("voronoi/anchors")?,
            report: report.into(),
        })
    }
}
