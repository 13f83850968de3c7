//! The saved form of a tree.

use crate::packet::Packet;
use crate::tree::frame::Frame;
use crate::tree::frame_line::half_extent;
use crate::tree::node_ref::{NodeRef, WIDTH};
use crate::tree::validate::{CHILDREN, PACKETS, VERTEX_OFFSETS, VERTICES, check_leaves, check_references};
use crate::tree::wide_node::{VolumeNodes, WideNode};
use crate::tree::{Leaves, PacketTree};
use bytemuck::{Pod, Zeroable};
use nalgebra::Point3;
use p2m_core::storage::{Array, LoadError, Reader, Saved, Writer, require};
use p2m_core::{Aabb, Isa};
use std::sync::OnceLock;

/// The section with the bounds of the nodes.
const BOUNDS: &str = "tree/bounds";

/// The fields of a tree that are not arrays, as they are stored in the section `tree`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Header {
    bounds: [[f64; 3]; 2],
    /// The frame of the nodes and the lists. It follows from the bounds, and is only compared with the frame that
    /// follows from them.
    frame: [f64; 5],
    depth: u64,
    len: u64,
    root: u32,
    has_non_triangles: u32,
}

/// Returns the numbers of a frame, as [`Header::frame`] stores them.
fn frame_numbers(frame: &Frame) -> [f64; 5] {
    let [x, y, z] = frame.centre;
    [x, y, z, frame.unit, frame.per_unit]
}

impl<V: VolumeNodes> Saved for PacketTree<V> {
    fn kind() -> String {
        V::name()
    }

    #[inline(never)]
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
        // The bounds of the whole scene are stored as the bounds of the first child of an additional node.
        let mut last = V::Node::new([NodeRef::NONE; WIDTH]);
        last.set_bounds(0, &self.root_bounds);
        let nodes = || self.nodes.iter().chain([&last]);
        let rows: Vec<[f32; WIDTH]> = nodes().flat_map(WideNode::rows).collect();
        let children: Vec<u32> = nodes().flat_map(|node| node.children().map(|child| child.0)).collect();
        writer.put_copy(BOUNDS, &rows);
        writer.put_copy(CHILDREN, &children);
        writer.put(PACKETS, &self.leaves.packets);
        writer.put(VERTICES, &self.leaves.vertices);
        writer.put(VERTEX_OFFSETS, &self.leaves.vertex_offsets);
    }

    #[inline(never)]
    fn load(reader: &Reader, primitives: usize) -> Result<Self, LoadError> {
        let header: Header = reader.one("tree")?;
        require(usize::try_from(header.len) == Ok(primitives), "tree", "the number of primitives is wrong")?;
        let leaves = load_leaves(reader)?;
        check_leaves(&leaves, primitives)?;
        let mut nodes = load_nodes::<V>(reader)?;
        // The additional node, which has the bounds of the whole scene and no children.
        let last = nodes.pop();
        let root_bounds = last.ok_or_else(|| LoadError::inconsistent(CHILDREN, "there is no node"))?.bounds(0);
        nodes.iter_mut().for_each(clear_unused_slots::<V>);
        let [min, max] = header.bounds.map(Point3::from);
        let bounds = Aabb { min, max };
        let frame = Frame::around(&bounds);
        let is_frame = frame_numbers(&frame).map(f64::to_bits) == header.frame.map(f64::to_bits);
        require(is_frame, "tree", "the frame is not that of the bounds")?;
        let mut tree = Self {
            isa: Isa::best(),
            shared: V::load_shared(reader)?,
            frame,
            bounds,
            half_extent: half_extent(&frame, &bounds),
            root_bounds,
            root: NodeRef(header.root),
            depth: 0,
            nodes,
            leaves,
            len: primitives,
            least_ids: OnceLock::new(),
        };
        tree.depth = check_references(&tree)?;
        Ok(tree)
    }
}

/// Loads the nodes, including the additional one with the bounds of the scene.
fn load_nodes<V: VolumeNodes>(reader: &Reader) -> Result<Vec<V::Node>, LoadError> {
    let rows = reader.array::<[f32; WIDTH]>(BOUNDS)?;
    let children = reader.array::<u32>(CHILDREN)?;
    require(children.len() % WIDTH == 0, CHILDREN, "there are not eight of each node")?;
    require(rows.len() == children.len() / WIDTH * V::Node::ROWS, BOUNDS, "there are not those of all nodes")?;
    require(rows.as_flattened().iter().all(|x| !x.is_nan()), BOUNDS, "a number is NaN")?;
    let load = |(rows, references): (&[[f32; WIDTH]], &[u32])| {
        let children: [NodeRef; WIDTH] = std::array::from_fn(|slot| NodeRef(references[slot]));
        V::Node::from_rows(rows, children)
    };
    Ok(rows.chunks_exact(V::Node::ROWS).zip(children.chunks_exact(WIDTH)).map(load).collect())
}

/// Makes the bounds of unused slots empty, because a search visits a slot on the basis of its bounds alone.
fn clear_unused_slots<V: VolumeNodes>(node: &mut V::Node) {
    let children = *node.children();
    let unused = (0..WIDTH).filter(|slot| children[*slot] == NodeRef::NONE);
    unused.for_each(|slot| node.set_bounds(slot, &V::Node::EMPTY));
}

/// Loads the packets and their exact vertices.
fn load_leaves(reader: &Reader) -> Result<Leaves, LoadError> {
    let packets: Array<Packet> = reader.array(PACKETS)?;
    let has_non_triangles = packets.iter().any(|packet| !packet.has_triangles());
    let (vertices, vertex_offsets) = (reader.array(VERTICES)?, reader.array(VERTEX_OFFSETS)?);
    Ok(Leaves { packets, vertices, vertex_offsets, has_non_triangles })
}
