//! Trees in saved files.

use crate::tree::frame::Frame;
use crate::tree::frame_line::half_extent;
use crate::tree::node_ref::{NodeRef, WIDTH};
use crate::tree::wide_node::{VolumeNodes, WideNode};
use crate::tree::{Leaves, PacketTree};
use bytemuck::{Pod, Zeroable};
use nalgebra::Point3;
use p2m_core::storage::{LoadError, Reader, Saved, Writer};
use p2m_core::{Aabb, Isa};

/// The fields of a tree that are not arrays, as the section `tree` has them.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Header {
    bounds: [[f64; 3]; 2],
    /// The frame of the nodes and the lists. It follows from the bounds and is only compared with that result.
    frame: [f64; 5],
    depth: u64,
    len: u64,
    root: u32,
    has_non_triangles: u32,
}

/// The numbers of a frame, as [`Header::frame`] has them.
fn frame_numbers(frame: &Frame) -> [f64; 5] {
    let [x, y, z] = frame.centre;
    [x, y, z, frame.unit, frame.per_unit]
}

impl<V: VolumeNodes> Saved for PacketTree<V> {
    fn kind() -> String {
        V::name()
    }

    fn save<'a>(&'a self, writer: &mut Writer<'a>) {
        let header = Header {
            bounds: [self.bounds.min.coords.into(), self.bounds.max.coords.into()],
            frame: frame_numbers(&self.frame),
            depth: self.depth as u64,
            len: self.len as u64,
            root: self.root.0,
            has_non_triangles: u32::from(self.leaves.has_non_triangles),
        };
        writer.put_copy("tree", &[header]);
        V::save_shared(&self.shared, writer);
        // The bounds of the whole scene are stored as those of the first child of an additional node.
        let mut last = V::Node::new([NodeRef::NONE; WIDTH]);
        last.set_bounds(0, &self.root_bounds);
        let nodes = || self.nodes.iter().chain([&last]);
        let rows: Vec<[f32; WIDTH]> = nodes().flat_map(WideNode::rows).collect();
        let children: Vec<u32> = nodes().flat_map(|node| node.children().map(|child| child.0)).collect();
        writer.put_copy("tree/bounds", &rows);
        writer.put_copy("tree/children", &children);
        writer.put("tree/packets", &self.leaves.packets);
        writer.put("tree/vertices", &self.leaves.vertices);
        writer.put("tree/first-vertices", &self.leaves.vertex_offsets);
    }

    fn load(reader: &Reader) -> Result<Self, LoadError> {
        let inconsistent = |section: &str| LoadError::Inconsistent { section: section.to_owned() };
        let header: Header = reader.one("tree")?;
        let rows = reader.array::<[f32; WIDTH]>("tree/bounds")?;
        let children = reader.array::<u32>("tree/children")?;
        let rows = rows.chunks_exact(V::Node::ROWS);
        let mut nodes: Vec<V::Node> = rows
            .zip(children.chunks_exact(WIDTH))
            .map(|(rows, references)| V::Node::from_rows(rows, std::array::from_fn(|i| NodeRef(references[i]))))
            .collect();
        let root_bounds = nodes.pop().ok_or_else(|| inconsistent("tree/bounds"))?.bounds(0);
        if (nodes.len() + 1) * WIDTH != children.len() {
            return Err(inconsistent("tree/children"));
        }
        let leaves = Leaves {
            packets: reader.array("tree/packets")?,
            vertices: reader.array("tree/vertices")?,
            vertex_offsets: reader.array("tree/first-vertices")?,
            has_non_triangles: header.has_non_triangles != 0,
        };
        if leaves.vertex_offsets.len() != leaves.packets.len() + 1 {
            return Err(inconsistent("tree/first-vertices"));
        }
        let (Ok(depth), Ok(len)) = (usize::try_from(header.depth), usize::try_from(header.len)) else {
            return Err(inconsistent("tree"));
        };
        let [min, max] = header.bounds.map(Point3::from);
        let bounds = Aabb { min, max };
        let frame = Frame::around(&bounds);
        if frame_numbers(&frame).map(f64::to_bits) != header.frame.map(f64::to_bits) {
            return Err(inconsistent("tree"));
        }
        Ok(Self {
            isa: Isa::best(),
            shared: V::load_shared(reader)?,
            frame,
            bounds,
            half_extent: half_extent(&frame, &bounds),
            root_bounds,
            root: NodeRef(header.root),
            depth,
            nodes,
            leaves,
            len,
        })
    }
}
