//! What a tree bounds its nodes with.
//!
//! Everything about a tree but the layout of its nodes and the bounds of their children is the same for all volumes. A
//! volume is a type of nodes, [`WideNode`].

use crate::build::SplitOptions;
use crate::packet::Member;
use crate::traverse::nearest::{EvaluateFn, finish, finish_nearest};
use crate::traverse::ray::{FrameLine, Intersect};
use crate::tree::PacketTree;
use crate::tree::aabb_node::{BoxNode, Frame, NodeRef, WIDTH};
use p2m_core::engine::query::BestF64;
use p2m_core::engine::simd::Lanes;
use p2m_core::engine::vector::V3;
use p2m_core::storage::{LoadError, Reader, Writer};
use p2m_core::{Aabb, Hits, Near, Ray};
use std::fmt::Debug;

/// What the nodes of a [`PacketTree`](crate::tree::PacketTree) are bounded by: [`Aabb<f64>`] or the k-DOPs of the crate p2m-kdop.
///
/// Sealed: searches rest on proofs about the rounding of the nodes.
pub trait Volume: Nodes {
    /// How a tree of them is built.
    type Options: TreeOptions<Self::Shape>;
    /// The directions of the faces of all volumes of a tree; `()` for boxes, which need none.
    type Directions;

    /// The directions of the faces.
    fn directions(shape: &Self::Shape) -> &Self::Directions;

    /// Whether the volume may have a point in common with a box: never false if it has one.
    fn may_meet_box(&self, directions: &Self::Directions, bounds: &Aabb<f64>) -> bool;
}

impl Volume for Aabb<f64> {
    type Options = SplitOptions;
    type Directions = ();

    fn directions((): &()) -> &() {
        &()
    }

    fn may_meet_box(&self, (): &(), bounds: &Aabb<f64>) -> bool {
        self.meets(bounds)
    }
}

/// The nodes of a volume.
pub trait Nodes: Sized {
    /// What all volumes of a tree have in common.
    type Shape: Clone + Debug + Send + Sync;
    /// A node.
    type Node: WideNode<Volume = Self, Shape = Self::Shape>;

    /// What files call trees of it.
    fn name() -> String;
    /// Adds to a file what all volumes have in common,
    fn save_shape(shape: &Self::Shape, writer: &mut Writer<'_>);
    /// and takes it from there.
    fn load_shape(reader: &Reader) -> Result<Self::Shape, LoadError>;

    /// The search of a tree for the nearest primitive, in a function of its own: what is not generic is compiled once, in this
    /// crate.
    fn nearest(tree: &PacketTree<Self>, query: V3, minimum: &mut BestF64, evaluate: EvaluateFn<'_, BestF64>)
    where
        Self: Volume;

    /// The same for what is near,
    fn near<'n>(tree: &PacketTree<Self>, query: V3, near: &mut Near<'n>, evaluate: EvaluateFn<'_, Near<'n>>)
    where
        Self: Volume;

    /// and for what a ray meets.
    fn rays<'r>(tree: &PacketTree<Self>, ray: &'r Ray, radius: f64, hits: &mut Hits<'r>, intersect: Intersect<'_, 'r>)
    where
        Self: Volume;
}

impl Nodes for Aabb<f64> {
    type Shape = ();
    type Node = BoxNode;

    fn name() -> String {
        "aabb".to_owned()
    }
    fn save_shape((): &(), _: &mut Writer<'_>) {}
    fn load_shape(_: &Reader) -> Result<(), LoadError> {
        Ok(())
    }

    fn nearest(tree: &PacketTree, query: V3, minimum: &mut BestF64, evaluate: EvaluateFn<'_, BestF64>) {
        tree.run(query, minimum, evaluate, finish_nearest);
    }

    fn near<'n>(tree: &PacketTree, query: V3, near: &mut Near<'n>, evaluate: EvaluateFn<'_, Near<'n>>) {
        tree.run(query, near, evaluate, finish);
    }

    fn rays<'r>(tree: &PacketTree, ray: &'r Ray, radius: f64, hits: &mut Hits<'r>, intersect: Intersect<'_, 'r>) {
        tree.run_ray(ray, radius, hits, intersect);
    }
}

/// How a tree is built of volumes that have this in common.
pub trait TreeOptions<Shape> {
    fn splits(&self) -> &SplitOptions;
    fn shape(&self) -> Shape;
}

impl TreeOptions<()> for SplitOptions {
    fn splits(&self) -> &SplitOptions {
        self
    }
    fn shape(&self) {}
}

/// A node of eight children with their bounds in f32, in a frame of the scene.
pub trait WideNode: Copy + Debug + Send + Sync {
    /// What bounds a child, in coordinates of the scene.
    type Volume;
    /// What all nodes of a tree have in common.
    type Shape: Sync;
    /// The bounds of a child in the frame, rounded outwards.
    type Bounds: Copy + Debug + Send + Sync;
    /// A query in the frame, rounded.
    type Query: Copy;
    /// A ray in the frame, rounded.
    type Ray: Copy;

    /// The bounds of no primitive.
    const NOTHING: Self::Bounds;

    /// A node with these children, whose bounds are still empty.
    fn new(children: [NodeRef; WIDTH]) -> Self;
    /// The children; [`NodeRef::NONE`] for unused places.
    fn children(&self) -> &[NodeRef; WIDTH];
    /// How many rows of numbers the bounds of the children are,
    const ROWS: usize;
    /// these rows,
    fn rows(&self) -> impl Iterator<Item = [f32; WIDTH]>;
    /// and a node of them.
    fn of_rows(rows: &[[f32; WIDTH]], children: [NodeRef; WIDTH]) -> Self;
    /// Sets the bounds of a child.
    fn put(&mut self, place: usize, bounds: &Self::Bounds);

    /// The bounds of some primitives, of which `bounds` is the common box.
    fn enclose(shape: &Self::Shape, frame: &Frame, primitives: &[Member], bounds: &Aabb<f64>) -> Self::Bounds;
    /// The smallest bounds around both.
    fn join(a: &Self::Bounds, b: &Self::Bounds) -> Self::Bounds;

    /// The query in the frame; `None` if it is too far or the frame too small or large to search in f32.
    fn query(shape: &Self::Shape, frame: &Frame, query: &[f64; 3]) -> Option<Self::Query>;
    /// Squares of lower bounds of the distances to what the eight children hold, in the frame: at most 2^-20 (relative)
    /// too large, apart from underflow.
    fn lower_bounds<L: Lanes>(&self, shape: &Self::Shape, query: &Self::Query) -> L;

    /// A ray in the frame.
    fn ray(shape: &Self::Shape, line: &FrameLine) -> Self::Ray;
    /// How far from its base it enters the eight children: at most 2^-22 (relative) too far, and not below 0; infinite
    /// for those that it does not meet.
    fn entries<L: Lanes>(&self, ray: &Self::Ray) -> L;

    /// The bounds of a child.
    fn at(&self, place: usize) -> Self::Bounds;
    /// A box around bounds of the frame, in coordinates of the scene.
    fn disclose(bounds: &Self::Bounds, shape: &Self::Shape, frame: &Frame) -> Aabb<f64>;
    /// Their volume, rounded outwards.
    fn volume(bounds: &Self::Bounds, shape: &Self::Shape, frame: &Frame) -> Self::Volume;

    /// Whether a child may have something in common with a box that meets its own.
    fn may_meet(bounds: &Self::Bounds, shape: &Self::Shape, frame: &Frame, other: &Aabb<f64>) -> bool {
        let _ = (bounds, shape, frame, other);
        true
    }

    /// The places in use.
    fn used(&self) -> impl Iterator<Item = usize> + '_ {
        (0..WIDTH).filter(|&place| self.children()[place] != NodeRef::NONE)
    }
}

/// A point of the frame in f32, rounded both ways.
#[derive(Clone, Copy, Debug)]
pub struct Rounded {
    pub low: [f32; 3],
    pub high: [f32; 3],
}

impl Rounded {
    /// Adds the squares of the gaps to some boxes on axis k to `sum`.
    #[inline(always)]
    pub fn squared_gap<L: Lanes>(&self, k: usize, min: L, max: L, sum: L) -> L {
        let below = min.sub(L::splat(self.high[k]));
        let above = L::splat(self.low[k]).sub(max);
        let gap = below.max(above).max(L::splat(0.0));
        gap.mul_add(gap, sum)
    }

    #[inline(always)]
    #[allow(
        clippy::cast_possible_truncation,
        reason = "rounded both ways, which covers the rounding of the difference"
    )]
    pub fn of(point: [f64; 3]) -> Self {
        let mut result = Self { low: [0.0; 3], high: [0.0; 3] };
        for (k, x) in point.into_iter().enumerate() {
            let x = x as f32;
            // At least a unit in the last place, where the conversion errs by half of one.
            let margin = x.abs() * f32::EPSILON + f32::MIN_POSITIVE;
            (result.low[k], result.high[k]) = (x - margin, x + margin);
        }
        result
    }
}
