//! Saving an octree and loading it.

use crate::octree::Octree;
use crate::octree::validate::{CODES, LISTS, OCTREE, check};
use crate::options::OctreeReport;
use p2m_bvh::PacketTree;
use p2m_core::engine::vector::V3;
use p2m_core::storage::{LoadError, Reader, Saved, Writer, require};

/// The fields of an octree that are not arrays, in the layout of the section `octree` of the file.
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Header {
    low: V3,
    cells_per_length: f64,
    resolution: f64,
    work: u64,
    list_cells: u64,
    single_cells: u64,
    fallback_cells: u64,
    entries: u64,
    depth: u64,
    bytes: u64,
    tree_bytes: u64,
    root: u32,
    unused: u32,
}

impl Saved for Octree {
    fn kind() -> String {
        "octree".to_owned()
    }

    fn save<'a>(&'a self, writer: &mut Writer<'a>) {
        let OctreeReport {
            list_cells,
            single_cells,
            fallback_cells,
            entries,
            depth,
            bytes,
            tree_bytes,
            work,
            resolution,
        } = self.report;
        let [list_cells, single_cells, fallback_cells, entries, depth, bytes, tree_bytes] =
            [list_cells, single_cells, fallback_cells, entries, depth, bytes, tree_bytes].map(|n| n as u64);
        let Self { low, cells_per_length, root, .. } = *self;
        let header = Header {
            low,
            cells_per_length,
            resolution,
            work,
            list_cells,
            single_cells,
            fallback_cells,
            entries,
            depth,
            bytes,
            tree_bytes,
            root,
            unused: 0,
        };
        writer.put_copy(OCTREE, &[header]);
        writer.put(CODES, &self.rows);
        writer.put(LISTS, &self.blocks);
        self.tree.save(writer);
    }

    #[allow(clippy::cast_possible_truncation, reason = "numbers to report")]
    fn load(reader: &Reader, primitives: usize) -> Result<Self, LoadError> {
        let header: Header = reader.one(OCTREE)?;
        let Header { list_cells, single_cells, fallback_cells, entries, depth, bytes, tree_bytes, .. } = header;
        let [list_cells, single_cells, fallback_cells, entries, depth, bytes, tree_bytes] =
            [list_cells, single_cells, fallback_cells, entries, depth, bytes, tree_bytes].map(|n| n as usize);
        let Header { low, cells_per_length, resolution, work, root, .. } = header;
        let report = OctreeReport {
            list_cells,
            single_cells,
            fallback_cells,
            entries,
            depth,
            bytes,
            tree_bytes,
            work,
            resolution,
        };
        require(header.unused == 0, OCTREE, "a number that has no use is not 0")?;
        let (rows, blocks) = (reader.array(CODES)?, reader.array(LISTS)?);
        let tree = PacketTree::load(reader, primitives)?;
        let octree = Self { tree, low, cells_per_length, root, rows, blocks, report };
        check(&octree)?;
        Ok(octree)
    }
}
