//! The interface of a node of eight children, which boxes and k-DOPs implement.

use crate::packet::Member;
use crate::tree::frame::Frame;
use crate::tree::frame_line::FrameLine;
use crate::tree::node_ref::{NodeRef, WIDTH};
use p2m_core::Aabb;
use p2m_core::engine::pairs::{Height, Rows};
use p2m_core::engine::simd::{InstructionSet, Lanes, out_of_line};
use p2m_core::storage::{LoadError, Reader, Writer};
use std::fmt::Debug;

/// A node of eight children with their bounds in f32, in the frame of the tree.
///
/// A child occupies one of eight slots, which are the lanes of its bounds.
pub trait WideNode: Rows + Copy + Debug + Send + Sync {
    /// Whether portable searches contain inlined copies of the node bounds and the packet filter even if [processors
    /// have faster lanes](Lanes::INLINES). Each type of nodes adds a copy of that code.
    const INLINES_PORTABLE: bool;
    /// The bounding volume of a child, in coordinates of the scene.
    type Volume;
    /// The data that all nodes of a tree share, such as the directions of k-DOPs.
    type Shared: Sync;
    /// The bounds of a child in the frame, rounded outwards.
    type Bounds: Copy + Debug + Send + Sync;
    /// A query point in the frame, rounded.
    type Query: Copy;
    /// A ray in the frame, rounded.
    type Ray: Copy;

    /// The bounds of the empty set.
    const EMPTY: Self::Bounds;
    /// The number of rows of numbers that hold the bounds of eight children.
    const ROWS: usize;

    /// Creates a node with these children, whose bounds are still empty.
    fn new(children: [NodeRef; WIDTH]) -> Self;
    /// Returns the children of the node. Unused slots have [`NodeRef::NONE`].
    fn children(&self) -> &[NodeRef; WIDTH];
    /// Returns the bounds of the children as rows of numbers, in the form that files store.
    fn rows(&self) -> impl Iterator<Item = [f32; WIDTH]> {
        (0..Self::ROWS).map(|number| *self.row(number))
    }
    /// Creates a node from the rows of a file.
    fn from_rows(rows: &[[f32; WIDTH]], children: [NodeRef; WIDTH]) -> Self;
    /// Sets the bounds of the child in a slot.
    fn set_bounds(&mut self, slot: usize, bounds: &Self::Bounds);
    /// Returns the bounds of the child in a slot.
    fn bounds(&self, slot: usize) -> Self::Bounds;

    /// Returns the bounds of some primitives, whose common box is `bounds`.
    fn enclose(shared: &Self::Shared, frame: &Frame, primitives: &[Member], bounds: &Aabb<f64>) -> Self::Bounds;
    /// Returns the smallest bounds around two bounds.
    fn union(a: &Self::Bounds, b: &Self::Bounds) -> Self::Bounds;

    /// Converts a query point to the frame. The result is `None` if the point is too far away to search in f32, or if
    /// the frame is too small or too large for that.
    fn query(shared: &Self::Shared, frame: &Frame, query: &[f64; 3]) -> Option<Self::Query>;
    /// Returns the squares of lower bounds on the distances to the contents of the eight children, in the frame. A
    /// square may be too large by at most 2^-20 of itself, apart from underflow.
    fn lower_bounds<L: Lanes>(&self, shared: &Self::Shared, query: &Self::Query) -> L;

    /// Converts a unit vector of the frame to the form in which heights along it are computed.
    fn height(shared: &Self::Shared, direction: &[f64; 3]) -> Height;

    /// Converts a ray to the form that the intersection with nodes uses.
    fn ray(shared: &Self::Shared, line: &FrameLine) -> Self::Ray;
    /// Returns the lengths from the base of a ray at which it enters the eight children. A length may be too large by
    /// at most 2^-22 of itself, is never negative, and is infinite for a child that the ray misses.
    fn entries<L: Lanes>(&self, ray: &Self::Ray) -> L;

    /// Returns a box in scene coordinates around bounds in the frame.
    fn scene_box(bounds: &Self::Bounds, shared: &Self::Shared, frame: &Frame) -> Aabb<f64>;
    /// Returns the volume in scene coordinates around bounds in the frame, rounded outwards.
    fn scene_volume(bounds: &Self::Bounds, shared: &Self::Shared, frame: &Frame) -> Self::Volume;

    /// Returns whether a child may have a point in common with a box that intersects the box of the child. The default
    /// returns `true`.
    fn may_intersect_box(bounds: &Self::Bounds, shared: &Self::Shared, frame: &Frame, other: &Aabb<f64>) -> bool {
        let _ = (bounds, shared, frame, other);
        true
    }

    /// Returns the slots in use.
    fn used_slots(&self) -> impl Iterator<Item = usize> + '_ {
        (0..WIDTH).filter(|&slot| self.children()[slot] != NodeRef::NONE)
    }
}

/// The part of a bounding volume that trees and traversals need. [`Volume`](crate::Volume) adds the searches.
pub trait VolumeNodes: Clone + 'static {
    /// The data that all volumes of a tree share.
    type Shared: Clone + Debug + Send + Sync;
    /// The type of the nodes.
    type Node: WideNode<Volume = Self, Shared = Self::Shared>;

    /// Returns the kind of a saved index with these volumes.
    fn name() -> String;
    /// Adds the shared data to a file.
    fn save_shared(shared: &Self::Shared, writer: &mut Writer<'_>);
    /// Reads the shared data from a file.
    ///
    /// # Errors
    /// Returns a [`LoadError`] if a section is missing or inconsistent.
    fn load_shared(reader: &Reader) -> Result<Self::Shared, LoadError>;
}

/// Returns whether searches of trees with volumes `V` contain an inlined copy of the packet filter.
#[inline(always)]
pub(crate) fn is_inlined<V: VolumeNodes, I: InstructionSet>() -> bool {
    I::F32x8::INLINES || V::Node::INLINES_PORTABLE
}

/// Returns [`WideNode::lower_bounds`], inlined or out of line as the lanes prefer.
#[inline(always)]
pub(crate) fn lower_bounds<N: WideNode, L: Lanes>(node: &N, shared: &N::Shared, query: &N::Query) -> L {
    if L::INLINES || N::INLINES_PORTABLE {
        node.lower_bounds(shared, query)
    } else {
        out_of_line(|| node.lower_bounds(shared, query))
    }
}

/// Returns [`WideNode::entries`], inlined or out of line as the lanes prefer.
#[inline(always)]
pub(crate) fn entries<N: WideNode, L: Lanes>(node: &N, ray: &N::Ray) -> L {
    if L::INLINES || N::INLINES_PORTABLE { node.entries(ray) } else { out_of_line(|| node.entries(ray)) }
}
