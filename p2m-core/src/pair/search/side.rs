//! The interface of the two sides of a search for pairs, which trees of other crates and single shapes implement.

use super::height::{Height, extent};
use super::hulls::Hulls;
use super::place::{NO_NODE, Place, WIDTH};
use super::slab::Slab;
use crate::kernel::arithmetic::cross;
use crate::kernel::vector::{V3, dot, largest, sub};
use crate::pair::{Hull, bounds_of};
use crate::{Aabb, PrimitiveId};

/// The eight children of a node, with bounds on their distances from a slab or a box.
#[derive(Clone, Copy, Debug)]
pub struct Children {
    /// Squares of lower bounds on the distances.
    pub squares: [f64; WIDTH],
    /// The widest gap in any direction, by which children are ordered. It is negative if a child overlaps.
    pub gaps: [f32; WIDTH],
    /// The sums of the sides of the boxes.
    pub sizes: [f32; WIDTH],
    /// The numbers of the children.
    pub nodes: [u32; WIDTH],
}

impl Children {
    /// The value for a node without children.
    pub const NONE: Self = Self {
        squares: [f64::INFINITY; WIDTH],
        gaps: [f32::INFINITY; WIDTH],
        sizes: [0.0; WIDTH],
        nodes: [NO_NODE; WIDTH],
    };
}

/// One side of a search for pairs: a tree of nodes with eight children over packets of primitives. It is used as `dyn`,
/// so that a search is compiled once. Lengths and heights are in units of the scene.
pub trait PairSide {
    /// Returns the root, or `None` for an empty side.
    fn root(&self) -> Option<Place>;
    /// Returns whether a node is a packet of primitives.
    fn is_packet(&self, node: u32) -> bool;
    /// Returns a box around the whole side.
    fn bounds(&self) -> Aabb<f64>;
    /// Returns the placement of the frame of the nodes in the scene.
    fn placement(&self) -> Placement;
    /// Returns vectors along which the contents of this side are often narrower than along the axes. A tree returns
    /// three orthogonal vectors.
    fn directions(&self) -> Vec<V3>;
    /// Converts a direction of the scene to the form in which the heights of nodes are computed.
    fn height(&self, direction: &V3) -> Height;
    /// Returns the least and the largest height of a node along a direction. `heights` are the forms of the direction
    /// and its opposite, and `offset` is the height of the centre of the frame.
    fn extent(&self, place: &Place, direction: &V3, offset: f64, heights: &[Height; 2]) -> [f64; 2];
    /// Returns the largest height of a vertex of a node along a direction.
    fn support(&self, node: u32, direction: &V3) -> f64;
    /// Bounds the distances between the children of a node and the intersection of several slabs. `triples` is the
    /// number of leading triples of orthogonal slabs.
    fn cut(&self, node: u32, slabs: &[Slab], triples: usize) -> Children;
    /// Bounds the distances between the children of a node and a box.
    fn cut_by_box(&self, node: u32, bounds: &Aabb<f64>) -> Children;
    /// Returns a box around a node.
    fn box_of(&self, place: &Place) -> Aabb<f64>;
    /// Returns the least id of a node or a packet.
    fn least_id(&self, node: u32) -> PrimitiveId;
    /// Returns the packet that continues the run of a packet, with further primitives that have the same vertices and
    /// higher ids. No node refers to it.
    fn next_packet(&self, packet: u32) -> Option<u32> {
        let _ = packet;
        None
    }
    /// Loads the primitives of a packet.
    fn load(&self, packet: u32, hulls: &mut Hulls);
}

/// The placement of the frame of a tree in the scene.
#[derive(Clone, Copy, Debug)]
pub struct Placement {
    /// The origin of the frame.
    pub centre: V3,
    /// The unit of the frame.
    pub unit: f64,
    /// A bound on the magnitudes of all coordinates of vertices, before, between and after the motions.
    pub size: f64,
    /// Whether there is a frame. A shape has none and uses coordinates of the scene.
    pub is_tree: bool,
}

/// A single shape of one to three vertices, as a tree of one packet.
pub struct ShapeSide<'a>(pub &'a [V3]);

impl PairSide for ShapeSide<'_> {
    fn root(&self) -> Option<Place> {
        Some(Place { size: 0.0, ..Place::root(0) })
    }

    fn is_packet(&self, _: u32) -> bool {
        true
    }

    fn bounds(&self) -> Aabb<f64> {
        bounds_of(self.0)
    }

    fn placement(&self) -> Placement {
        Placement { centre: [0.0; 3], unit: 1.0, size: largest(self.0), is_tree: false }
    }

    fn directions(&self) -> Vec<V3> {
        let edges: Vec<V3> = match self.0 {
            [a, b] => vec![sub(*b, *a)],
            [a, b, c] => vec![sub(*b, *a), sub(*c, *b), sub(*a, *c)],
            _ => Vec::new(),
        };
        let mut vectors: Vec<V3> =
            edges.iter().flat_map(|[x, y, z]| [[0.0, *z, -y], [-z, 0.0, *x], [*y, -x, 0.0]]).collect();
        if let [d, e, _] = edges[..] {
            vectors.push(cross(d, e));
        }
        vectors
    }

    fn height(&self, direction: &V3) -> Height {
        Height::new(std::array::from_fn(|k| (k, direction[k])))
    }

    fn extent(&self, _: &Place, direction: &V3, _: f64, _: &[Height; 2]) -> [f64; 2] {
        extent(self.0.iter().map(|vertex| dot(*vertex, *direction)))
    }

    fn support(&self, _: u32, direction: &V3) -> f64 {
        let [_, largest] = extent(self.0.iter().map(|vertex| dot(*vertex, *direction)));
        largest
    }

    fn cut(&self, _: u32, _: &[Slab], _: usize) -> Children {
        Children::NONE
    }

    fn cut_by_box(&self, _: u32, _: &Aabb<f64>) -> Children {
        Children::NONE
    }

    fn box_of(&self, _: &Place) -> Aabb<f64> {
        bounds_of(self.0)
    }

    fn least_id(&self, _: u32) -> PrimitiveId {
        PrimitiveId::new(0)
    }

    fn load(&self, packet: u32, hulls: &mut Hulls) {
        hulls.start(packet);
        hulls.push(PrimitiveId::new(0), Hull::new(self.0));
    }
}
