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
use p2m_bvh::PacketTree;
use p2m_bvh::engine::packet::LANES;
use p2m_core::engine::number::cross;
use p2m_core::engine::vector::{V3, dot, largest, norm_squared, sub};

/// The margin by which a feature has to be excluded, as a part of the largest length.
const RELATIVE_MARGIN: f64 = 1.0 / (1u64 << 22) as f64;
/// The largest number of edges of a vertex that are examined.
const MAX_EDGES_OF_VERTEX: usize = 32;

/// The directions and proportions of a primitive that the tests need.
#[derive(Clone, Copy, Default)]
struct PrimitiveFrame {
    /// The directions from each vertex to the next one.
    edge_directions: [V3; 3],
    /// The directions from each side into the triangle.
    inward_normals: [V3; 3],
    /// The least height of a triangle or the length of a segment. It is infinite for a point, which cannot be thin.
    height: f64,
    /// The height as a part of the longest edge. It is 1 for segments and points.
    sine: f64,
}

/// The frames of all lanes of all packets.
pub(crate) struct PrimitiveFrames(Vec<PrimitiveFrame>);

impl PrimitiveFrames {
    /// Computes the frames of all primitives of a tree.
    pub(crate) fn from_tree(tree: &PacketTree) -> Self {
        let mut all = vec![PrimitiveFrame::default(); tree.leaves.packets.len() * LANES];
        for (packet, packet_frames) in tree.leaves.packets.iter().zip(all.chunks_exact_mut(LANES)) {
            for (lane, to) in packet_frames.iter_mut().enumerate().take(packet.ids().len()) {
                let (positions, count) = packet.vertices_of(lane);
                let mut vertices = [[0.0; 3]; 3];
                vertices
                    .iter_mut()
                    .zip(&positions[..count])
                    .for_each(|(to, position)| *to = tree.leaves.vertices[*position]);
                *to = PrimitiveFrame::from_vertices(&vertices[..count]);
            }
        }
        Self(all)
    }

    /// Returns the frame of a primitive.
    fn get(&self, packet: usize, lane: usize) -> &PrimitiveFrame {
        &self.0[packet * LANES + lane]
    }
}

impl PrimitiveFrame {
    /// Computes the frame of a primitive with one to three vertices.
    fn from_vertices(vertices: &[V3]) -> Self {
        let mut frame = Self { height: f64::INFINITY, sine: 1.0, ..Self::default() };
        if vertices.len() < 2 {
            return frame;
        }
        let offset = |i: usize| sub(vertices[(i + 1) % vertices.len()], vertices[i]);
        (0..vertices.len()).for_each(|i| frame.edge_directions[i] = normalized(offset(i)));
        let length = |i: usize| norm_squared(offset(i)).sqrt();
        if vertices.len() == 2 {
            frame.height = length(0);
            return frame;
        }
        let normal = cross(offset(0), sub(vertices[2], vertices[0]));
        frame.height = norm_squared(normal).sqrt() / length(0).max(length(1)).max(length(2));
        frame.sine = frame.height / length(0).max(length(1)).max(length(2));
        (0..3).for_each(|i| frame.inward_normals[i] = cross(normalized(normal), frame.edge_directions[i]));
        frame
    }
}

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

/// A plane through a point with a normal of length 1. A query on its right side has a height of at least minus
/// `margin`.
#[derive(Clone, Copy)]
struct Plane {
    /// A point of the plane.
    point: V3,
    /// The normal of the plane, which points to the right side.
    direction: V3,
    /// The height below the plane up to which points count as above.
    margin: f64,
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

/// The test of one feature: its planes, and the heights of a region above them. Its vectors are reused.
#[derive(Default)]
pub(crate) struct ExcludedFeatures {
    /// The mean of the points that span the region.
    mean: V3,
    /// The planes so far.
    planes: Vec<PlaneHeights>,
    /// The heights of the points above some planes: those whose right side does not contain the mean, and
    /// others on demand.
    heights: Vec<f64>,
    /// Whether one plane has excluded the feature already.
    is_decided: bool,
}

/// A plane, with the heights of a region above it.
struct PlaneHeights {
    /// The plane, with its margin.
    plane: Plane,
    /// The height of the mean of the region.
    mean: f64,
    /// The index of the first height of the points, if the heights have been computed.
    first: Option<usize>,
}

impl Plane {
    /// Returns the height of a point above the plane, increased by the margin. It is negative on the wrong side.
    fn height(&self, x: &V3) -> f64 {
        dot(sub(*x, self.point), self.direction) + self.margin
    }
}

impl ExcludedFeatures {
    /// Begins another region.
    fn begin_region(&mut self, region: &[V3]) {
        let sum = region.iter().fold([0.0; 3], |sum, h| [sum[0] + h[0], sum[1] + h[1], sum[2] + h[2]]);
        self.mean = sum.map(|x| x / region.len() as f64);
    }

    /// Begins another feature.
    fn begin_feature(&mut self) {
        self.planes.clear();
        self.heights.clear();
        self.is_decided = false;
    }

    /// Adds a plane of the feature.
    fn add(&mut self, region: &[V3], plane: Plane) {
        if self.is_decided {
            return;
        }
        let mean = plane.height(&self.mean);
        self.planes.push(PlaneHeights { plane, mean, first: None });
        // All points can have a negative height only if their mean has.
        if mean < 0.0 {
            self.is_decided = self.heights_above(self.planes.len() - 1, region).iter().all(|x| *x < 0.0);
        }
    }

    /// Returns the heights of the points above a plane.
    fn heights_above(&mut self, number: usize, region: &[V3]) -> &[f64] {
        let PlaneHeights { plane, first, .. } = &mut self.planes[number];
        let first = *first.get_or_insert_with(|| {
            let first = self.heights.len();
            self.heights.extend(region.iter().map(|h| plane.height(h)));
            first
        });
        &self.heights[first..first + region.len()]
    }

    /// Returns whether the planes exclude the feature.
    fn is_excluded(&mut self, region: &[V3]) -> bool {
        if self.is_decided || region.is_empty() {
            return true;
        }
        for i in 0..self.planes.len() {
            for j in 0..i {
                if self.planes[i].mean + self.planes[j].mean < 0.0 {
                    self.heights_above(i, region);
                    self.heights_above(j, region);
                    let [a, b] = [i, j].map(|n| &self.heights[self.planes[n].first.unwrap_or(0)..][..region.len()]);
                    if a.iter().zip(b).all(|(x, y)| x + y < 0.0) {
                        return true;
                    }
                }
            }
        }
        false
    }
}

/// Returns the direction of a vector, or zero if the vector is zero.
fn normalized(d: V3) -> V3 {
    let length = norm_squared(d).sqrt();
    if length > 0.0 { d.map(|x| x / length) } else { [0.0; 3] }
}
