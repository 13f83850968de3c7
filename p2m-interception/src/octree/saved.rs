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
    /// The counts of an [`OctreeReport`].
    counts: [u64; 7],
    root: u32,
    unused: u32,
}

impl Saved for Octree {
    fn kind() -> String {
        "octree".to_owned()
    }

    fn save<'a>(&'a self, writer: &mut Writer<'a>) {
        let Self { low, cells_per_length, root, mut report, .. } = *self;
        let counts = report.counts().map(|count| *count as u64);
        let OctreeReport { resolution, work, .. } = report;
        let header = Header { low, cells_per_length, resolution, work, counts, root, unused: 0 };
        writer.put_copy(OCTREE, &[header]);
        writer.put(CODES, &self.rows);
        writer.put(LISTS, &self.blocks);
        self.tree.save(writer);
    }

    #[allow(clippy::cast_possible_truncation, reason = "numbers to report")]
    fn load(reader: &Reader, primitives: usize) -> Result<Self, LoadError> {
        let Header { low, cells_per_length, resolution, work, counts, root, unused } = reader.one(OCTREE)?;
        let mut report = OctreeReport { work, resolution, ..OctreeReport::default() };
        report.counts().into_iter().zip(counts).for_each(|(to, count)| *to = count as usize);
        require(unused == 0, OCTREE, "a number that has no use is not 0")?;
        let (rows, blocks) = (reader.array(CODES)?, reader.array(LISTS)?);
        let tree = PacketTree::load(reader, primitives)?;
        let octree = Self { tree, low, cells_per_length, root, rows, blocks, report };
        check(&octree)?;
        Ok(octree)
    }
}
