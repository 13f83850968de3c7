//! Feature relevance: it excludes the vertices, edges and faces of a primitive that cannot hold the nearest point of
//! the scene anywhere in a region.
//!
//! Each kind of feature requires the query to lie on one side of some planes:
//!
//! - If the nearest point is inside of a face, the query is over the face, hence inside of each of its sides.
//! - If it is inside of an edge, the query is between the ends of the edge, and over no triangle with this edge,
//!   because such a triangle would be nearer.
//! - If it is a vertex, the query is behind the vertex along every edge that begins there, and in the cell of another
//!   site it is as near to the vertex as to that site.
//!
//! A feature is *excluded* if the whole region is on the wrong side of one plane. It is also excluded if the heights
//! above two planes have a negative sum in the whole region, because then each point is on the wrong side of one of
//! the two. docs/proofs/p2m.md has the margins.

use crate::delaunay::Delaunay;
use crate::voronoi::adjacency::{EdgeAdjacency, NO_PRIMITIVE, OwnedByLowerId};
use crate::voronoi::excluded_features::{ExcludedFeatures, Plane};
use crate::voronoi::primitive_frame::{PrimitiveFrame, PrimitiveFrames, normalized};
use p2m_bvh::PacketTree;
use p2m_bvh::engine::packet::LANES;
use p2m_core::engine::vector::{V3, largest, norm_squared, sub};

/// The margin by which a feature has to be excluded, as a part of the largest length.
const RELATIVE_MARGIN: f64 = 1.0 / (1u64 << 22) as f64;
/// The largest number of edges of a vertex that are examined.
const MAX_EDGES_OF_VERTEX: usize = 32;

/// The data that all tests of a build share.
#[derive(Clone, Copy)]
pub(crate) struct RelevanceContext<'a> {
    /// The tree over the packets.
    pub(crate) tree: &'a PacketTree,
    /// The Delaunay tetrahedra of the sites.
    pub(crate) delaunay: &'a Delaunay,
    /// The vertices and edges of the primitives.
    pub(crate) adjacency: &'a EdgeAdjacency,
    /// The directions of the primitives.
    pub(crate) frames: &'a PrimitiveFrames,
    /// The slack of the corner test: a dominator has to be nearer by this much.
    pub(crate) slack: f64,
}

/// The cell whose list is being built.
#[derive(Clone, Copy)]
pub(crate) struct CellInfo {
    /// The number of the site.
    pub(crate) site: usize,
    /// The position of the site.
    pub(crate) position: V3,
    /// An upper bound of the distance from the site to a corner.
    pub(crate) max_distance: f64,
    /// An upper bound of the error of a corner.
    pub(crate) max_error: f64,
}

/// A primitive of one to three vertices, as seen from a cell.
pub(crate) struct PrimitiveView<'a> {
    /// The data that all tests share.
    scene: RelevanceContext<'a>,
    /// The cell whose list is being built.
    cell: CellInfo,
    /// The vertices of the primitive.
    vertices: [V3; 3],
    /// The number of vertices.
    count: usize,
    /// The sites of the vertices.
    sites: [usize; 3],
    /// For each edge another triangle with this edge, or [`NO_PRIMITIVE`].
    opposite_triangles: [u32; 3],
    /// The features that a primitive with a lower id has as well.
    owned_by_lower_id: OwnedByLowerId,
    /// The largest distance of a vertex from the site of the cell.
    max_vertex_distance: f64,
    /// The margin of planes through the vertices.
    margin: f64,
    /// The directions of the primitive.
    frame: &'a PrimitiveFrame,
}

impl<'a> PrimitiveView<'a> {
    /// Prepares the test of the primitive in a lane of a packet. The result is `None` if nothing can be excluded.
    pub(crate) fn new(scene: RelevanceContext<'a>, cell: CellInfo, packet: usize, lane: usize) -> Option<Self> {
        let (vertices, sites, count) = scene.vertices(packet, lane);
        let max_vertex_distance =
            vertices[..count].iter().map(|v| largest(&[sub(*v, cell.position)])).fold(0.0, f64::max);
        // The margin covers the rounding of the kernel near the borders of features, and that of the tests.
        let margin = RELATIVE_MARGIN * (cell.max_distance + max_vertex_distance);
        let frame = scene.frames.get(packet, lane);
        let height = frame.height;
        // Primitives of unknown kinds have no vertices. The height is NaN if a product overflows.
        if count == 0 || cell.max_error >= margin * 0.25 || height.is_nan() || height < margin {
            return None;
        }
        let opposite_triangles = scene.adjacency.opposite_triangles[packet][lane];
        let owned_by_lower_id = scene.adjacency.owned_by_lower_id[packet][lane];
        Some(Self {
            scene,
            cell,
            vertices,
            count,
            sites,
            opposite_triangles,
            owned_by_lower_id,
            max_vertex_distance,
            margin,
            frame,
        })
    }

    /// Returns whether some feature may be relevant in the convex hull of a region and belongs to no primitive with
    /// a lower id.
    pub(crate) fn is_relevant(&self, region: &[V3], excluded: &mut ExcludedFeatures) -> bool {
        excluded.begin_region(region);
        let edge_count = if self.count == 3 { 3 } else { self.count - 1 };
        if self.count == 3 {
            excluded.begin_feature();
            (0..3).for_each(|i| excluded.add(region, self.side_plane(i)));
            if !excluded.is_excluded(region) {
                return true;
            }
        }
        for i in (0..edge_count).filter(|i| self.owned_by_lower_id >> (3 + i) & 1 == 0) {
            excluded.begin_feature();
            self.add_edge_planes(i, &mut |plane| excluded.add(region, plane));
            if !excluded.is_excluded(region) {
                return true;
            }
        }
        for i in (0..self.count).filter(|i| self.owned_by_lower_id >> i & 1 == 0) {
            excluded.begin_feature();
            self.add_vertex_planes(i, &mut |plane| excluded.add(region, plane));
            if !excluded.is_excluded(region) {
                return true;
            }
        }
        false
    }

    /// Returns the plane through a side of the triangle, from vertex i to the next one. Its right side is that
    /// of the triangle.
    fn side_plane(&self, i: usize) -> Plane {
        Plane {
            point: self.vertices[i],
            direction: self.frame.inward_normals[i],
            margin: self.margin / self.frame.sine,
        }
    }

    /// Adds the planes of the edge from vertex i to the next one.
    fn add_edge_planes(&self, i: usize, add: &mut dyn FnMut(Plane)) {
        let (p, q) = (self.vertices[i], self.vertices[(i + 1) % self.count]);
        let d = self.frame.edge_directions[i];
        let margin = self.margin;
        add(Plane { point: p, direction: d, margin });
        add(Plane { point: q, direction: d.map(|x| -x), margin });
        if self.count < 3 {
            return;
        }
        let flipped = |plane: Plane| Plane { direction: plane.direction.map(|x| -x), ..plane };
        add(flipped(self.side_plane(i)));
        let opposite = self.opposite_triangles[i] as usize;
        if self.opposite_triangles[i] == NO_PRIMITIVE {
            return;
        }
        let (others, sites, _) = self.scene.vertices(opposite / LANES, opposite % LANES);
        let frame = self.scene.frames.get(opposite / LANES, opposite % LANES);
        let margin = self.margin_with(&others);
        // The height of the other triangle is zero if two of its vertices are equal, so `common_side` is its only
        // side with
        // these ends.
        let ends = [self.sites[i], self.sites[(i + 1) % 3]];
        let common_side = (0..3).find(|j| ends.contains(&sites[*j]) && ends.contains(&sites[(j + 1) % 3]));
        if let Some(j) = common_side.filter(|_| frame.height >= margin) {
            add(flipped(Plane { point: others[j], direction: frame.inward_normals[j], margin: margin / frame.sine }));
        }
    }

    /// Adds the planes of vertex i.
    fn add_vertex_planes(&self, i: usize, add: &mut dyn FnMut(Plane)) {
        let point = self.vertices[i];
        let Self { cell, scene, .. } = self;
        let mut add_edge_to = |other: V3| {
            let offset = sub(other, point);
            let margin = self.margin_with(&[other]);
            if norm_squared(offset) > margin * margin {
                add(Plane { point, direction: normalized(offset).map(|x| -x), margin });
            }
        };
        (0..self.count).filter(|j| *j != i).for_each(|j| add_edge_to(self.vertices[j]));
        if scene.adjacency.is_exact {
            let others = scene.adjacency.edges.get(self.sites[i]).iter().take(MAX_EDGES_OF_VERTEX);
            let is_other_site = |w: &&u32| !self.sites[..self.count].contains(&(**w as usize));
            others.filter(is_other_site).for_each(|w| add_edge_to(scene.position(*w as usize)));
            if self.sites[i] != cell.site {
                // In the cell, the vertex is not nearer than the site.
                let offset = sub(point, cell.position);
                let length = norm_squared(offset).sqrt();
                let lead = 2.0 * self.margin * self.margin
                    + 8.0 * (cell.max_distance + self.max_vertex_distance) * scene.slack;
                let margin = 2.0 * cell.max_error + lead / (2.0 * length);
                let midpoint = std::array::from_fn(|k| cell.position[k] + 0.5 * offset[k]);
                add(Plane { point: midpoint, direction: normalized(offset), margin });
            }
        }
    }

    /// Returns the margin of planes that depend on further vertices as well.
    fn margin_with(&self, others: &[V3]) -> f64 {
        let sizes = others.iter().map(|v| largest(&[sub(*v, self.cell.position)]));
        RELATIVE_MARGIN * (self.cell.max_distance + sizes.fold(self.max_vertex_distance, f64::max))
    }
}

impl RelevanceContext<'_> {
    /// Returns the vertices of the primitive in a lane of a packet, their sites, and how many there are.
    fn vertices(&self, packet: usize, lane: usize) -> ([V3; 3], [usize; 3], usize) {
        let leaves = &self.tree.leaves;
        let (positions, count) = leaves.packets[packet].vertices_of(lane);
        let (mut vertices, mut sites) = ([[0.0; 3]; 3], [0; 3]);
        for (i, position) in positions[..count].iter().enumerate() {
            (vertices[i], sites[i]) = (leaves.vertices[*position], self.delaunay.site_of(*position));
        }
        (vertices, sites, count)
    }

    /// Returns the position of a site in coordinates of the scene.
    fn position(&self, site: usize) -> V3 {
        self.delaunay.sites()[site].map(|x| x * self.delaunay.unit())
    }
}
