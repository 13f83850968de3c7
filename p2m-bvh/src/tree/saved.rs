//! Trees in files.

use crate::traverse::ray;
use crate::tree::aabb_node::{Frame, NodeRef, WIDTH};
use crate::tree::volume::{Nodes, Volume, WideNode};
use crate::tree::{Leaves, PacketTree};
use bytemuck::{Pod, Zeroable};
use nalgebra::Point3;
use p2m_core::storage::{LoadError, Reader, Saved, Writer};
use p2m_core::{Aabb, Isa};

/// What is no array.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Head {
    bounds: [[f64; 3]; 2],
    /// That of the nodes and the lists: it follows from the bounds, and has to be the same.
    frame: [f64; 5],
    depth: u64,
    len: u64,
    root: u32,
    has_others: u32,
}

fn numbers(frame: &Frame) -> [f64; 5] {
    let [x, y, z] = frame.centre;
    [x, y, z, frame.unit, frame.per_unit]
}

impl<V: Volume> Saved for PacketTree<V> {
    fn kind() -> String {
        V::name()
    }

    fn save<'a>(&'a self, writer: &mut Writer<'a>) {
        let head = Head {
            bounds: [self.bounds.min.coords.into(), self.bounds.max.coords.into()],
            frame: numbers(&self.frame),
            depth: self.depth as u64,
            len: self.len as u64,
            root: self.root.0,
            has_others: u32::from(self.leaves.has_others),
        };
        writer.put_copy("tree", &[head]);
        V::save_shape(&self.shape, writer);
        // The bounds of everything as those of the first child of one more node.
        let mut last = V::Node::new([NodeRef::NONE; WIDTH]);
        last.put(0, &self.whole);
        let nodes = || self.nodes.iter().chain([&last]);
        let rows: Vec<[f32; WIDTH]> = nodes().flat_map(WideNode::rows).collect();
        let children: Vec<u32> = nodes().flat_map(|node| node.children().map(|child| child.0)).collect();
        writer.put_copy("tree/bounds", &rows);
        writer.put_copy("tree/children", &children);
        writer.put("tree/packets", &self.leaves.packets);
        writer.put("tree/vertices", &self.leaves.vertices);
        writer.put("tree/first-vertices", &self.leaves.firsts);
    }

    fn load(reader: &Reader) -> Result<Self, LoadError> {
        let inconsistent = |section: &str| LoadError::Inconsistent { section: section.to_owned() };
        let head: Head = reader.one("tree")?;
        let rows = reader.array::<[f32; WIDTH]>("tree/bounds")?;
        let children = reader.array::<u32>("tree/children")?;
        let rows = rows.chunks_exact(V::Node::ROWS);
        let mut nodes: Vec<V::Node> = rows
            .zip(children.chunks_exact(WIDTH))
            .map(|(rows, own)| V::Node::of_rows(rows, std::array::from_fn(|i| NodeRef(own[i]))))
            .collect();
        let whole = nodes.pop().ok_or_else(|| inconsistent("tree/bounds"))?.at(0);
        if (nodes.len() + 1) * WIDTH != children.len() {
            return Err(inconsistent("tree/children"));
        }
        let leaves = Leaves {
            packets: reader.array("tree/packets")?,
            vertices: reader.array("tree/vertices")?,
            firsts: reader.array("tree/first-vertices")?,
            has_others: head.has_others != 0,
        };
        if leaves.firsts.len() != leaves.packets.len() + 1 {
            return Err(inconsistent("tree/first-vertices"));
        }
        let (Ok(depth), Ok(len)) = (usize::try_from(head.depth), usize::try_from(head.len)) else {
            return Err(inconsistent("tree"));
        };
        let [min, max] = head.bounds.map(Point3::from);
        let bounds = Aabb { min, max };
        let frame = Frame::around(&bounds);
        if numbers(&frame).map(f64::to_bits) != head.frame.map(f64::to_bits) {
            return Err(inconsistent("tree"));
        }
        Ok(Self {
            isa: Isa::best(),
            shape: <V as Nodes>::load_shape(reader)?,
            frame,
            bounds,
            half: ray::half_box(&frame, &bounds),
            whole,
            root: NodeRef(head.root),
            depth,
            nodes,
            leaves,
            len,
        })
    }
}
