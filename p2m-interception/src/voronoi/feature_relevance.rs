//! Feature relevance: it excludes the vertices, edges and faces of a primitive that cannot hold the nearest point of
//! the scene anywhere in a region.
//!
//! Each kind of feature requires the query to lie on one side of some planes:
//!
//! - If the nearest point is inside of a face, the query is over the face, hence on the inner side of each of its
//!   edges.
//! - If it is inside of an edge, the query is between the ends of the edge, and over no triangle with this edge,
//!   because such a triangle would be nearer.
//! - If it is a vertex, the query is behind the vertex along every edge that begins there, and in the cell of another
//!   site it is no nearer to that site than to the vertex.
//!
//! A feature is *excluded* if the whole region is on the wrong side of one plane. It is also excluded if the heights
//! above two planes have a negative sum in the whole region, because then each point is on the wrong side of one of
//! the two. [docs/proofs/p2m.md] has the margins.
//!
//! [docs/proofs/p2m.md]: https://github.com/p2m-rs/p2m/blob/main/docs/proofs/p2m.md

use crate::delaunay::Delaunay;
use crate::voronoi::adjacency::{EdgeAdjacency, NO_PRIMITIVE};
use crate::voronoi::excluded_features::{ExcludedFeatures, Plane, RegionPoints};
use crate::voronoi::primitive_frame::{PrimitiveFrame, normalized};
use p2m_bvh::PacketTree;
use p2m_bvh::engine::packet::LANES;
use p2m_core::engine::simd::Doubles;
use p2m_core::engine::vector::{V3, norm_squared, sub};
use std::ops::Range;

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
    /// The slack of the corner test: a dominator has to be nearer by this much.
    pub(crate) slack: f64,
}

/// A cell in which features are tested.
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

impl CellInfo {
    /// Returns the margin of planes that depend on vertices in a box. It covers the rounding of the kernel near the
    /// borders of features, and the rounding of the tests.
    #[inline(always)]
    fn margin(&self, [low, high]: &[V3; 2]) -> f64 {
        let reach = |k: usize| (high[k] - self.position[k]).max(self.position[k] - low[k]);
        RELATIVE_MARGIN * (self.max_distance + reach(0).max(reach(1)).max(reach(2)))
    }
}

/// A plane of a feature. Its margin depends on the cell.
struct FeaturePlane {
    /// A point of the plane.
    point: V3,
    /// The normal of the plane, which points to the right side.
    direction: V3,
    /// Whether the plane depends on vertices of other primitives.
    is_foreign: bool,
    /// The plane excludes nothing in cells whose margin is more than this length.
    max_margin: f64,
    /// The factor of the margin: the reciprocal of the sine of a triangle, for its sides.
    margin_factor: f64,
}

/// The features of a primitive of one to three vertices with their planes, which all cells share. Its
/// vectors are reused.
#[derive(Default)]
pub(crate) struct PrimitiveFeatures {
    /// The box of the vertices.
    bounds: [V3; 2],
    /// The box of all vertices that planes depend on, including vertices of other primitives.
    foreign_bounds: [V3; 2],
    /// The largest margin of cells in which anything can be excluded.
    max_margin: f64,
    /// The planes of all features.
    planes: Vec<FeaturePlane>,
    /// The features that belong to no primitive with a lower id.
    features: Vec<Feature>,
}

/// A feature of a primitive.
struct Feature {
    /// The range of its planes.
    planes: Range<usize>,
    /// The vertex with its site, if the feature is a vertex whose site is exact.
    vertex: Option<(V3, usize)>,
}

impl PrimitiveFeatures {
    /// Prepares the test of the primitive in a lane of a packet.
    pub(crate) fn prepare(&mut self, scene: RelevanceContext<'_>, packet: usize, lane: usize) {
        self.planes.clear();
        self.features.clear();
        let (vertices, sites, count) = scene.vertices(packet, lane);
        let frame = PrimitiveFrame::from_vertices(&vertices[..count]);
        // Primitives of unknown kinds have no vertices. The height is NaN if a product overflows.
        self.max_margin = if count == 0 || frame.height.is_nan() { f64::NEG_INFINITY } else { frame.height };
        if count == 0 {
            return;
        }
        self.bounds = box_of(&vertices[..count]);
        self.foreign_bounds = self.bounds;
        let view = PrimitiveView { scene, vertices: &vertices[..count], sites, frame };
        let owned_by_lower_id = scene.adjacency.owned_by_lower_id[packet][lane];
        if count == 3 {
            self.planes.extend((0..3).map(|i| view.side_plane(i)));
            self.features.push(Feature { planes: 0..3, vertex: None });
        }
        let edge_count = if count == 3 { 3 } else { count - 1 };
        for i in (0..edge_count).filter(|i| owned_by_lower_id >> (3 + i) & 1 == 0) {
            let first = self.planes.len();
            view.add_edge_planes(
                i,
                scene.adjacency.opposite_triangles[packet][lane][i],
                &mut self.planes,
                &mut self.foreign_bounds,
            );
            self.features.push(Feature { planes: first..self.planes.len(), vertex: None });
        }
        for i in (0..count).filter(|i| owned_by_lower_id >> i & 1 == 0) {
            let first = self.planes.len();
            view.add_vertex_planes(i, &mut self.planes, &mut self.foreign_bounds);
            let vertex = scene.adjacency.is_exact.then_some((vertices[i], sites[i]));
            self.features.push(Feature { planes: first..self.planes.len(), vertex });
        }
    }

    /// Returns whether the primitive can be the answer in a region of a cell: whether a feature that belongs to no
    /// primitive with a lower id may be relevant in the convex hull of the region.
    #[inline(always)]
    pub(crate) fn is_relevant<D: Doubles>(
        &self,
        cell: &CellInfo,
        slack: f64,
        region: &RegionPoints,
        excluded: &mut ExcludedFeatures,
    ) -> bool {
        let margin = cell.margin(&self.bounds);
        // The negated comparison is true as well if a length is NaN.
        if !(cell.max_error < margin * 0.25 && self.max_margin >= margin) {
            return true;
        }
        let foreign_margin = cell.margin(&self.foreign_bounds);
        excluded.begin_region::<D>(region);
        for Feature { planes, vertex } in &self.features {
            excluded.begin_feature();
            let mut is_excluded = false;
            for plane in &self.planes[planes.clone()] {
                let margin = if plane.is_foreign { foreign_margin } else { margin };
                if plane.max_margin >= margin {
                    let margin = margin * plane.margin_factor;
                    let plane = Plane { point: plane.point, direction: plane.direction, margin };
                    is_excluded = excluded.add::<D>(region, plane);
                    if is_excluded {
                        break;
                    }
                }
            }
            if let Some((vertex, site)) = vertex
                && !is_excluded
                && *site != cell.site
            {
                is_excluded = excluded.add::<D>(region, bisector(cell, vertex, margin, slack));
            }
            if !is_excluded {
                return true;
            }
        }
        false
    }
}

/// Returns the bisector between the site of a cell and a vertex, with the margins of both. No point of the cell lies
/// beyond it, where the vertex is nearer.
#[inline(always)]
fn bisector(cell: &CellInfo, vertex: &V3, margin: f64, slack: f64) -> Plane {
    let offset = sub(*vertex, cell.position);
    let length = norm_squared(offset).sqrt();
    // `margin` is a part of the sum of the largest distances of corners and vertices.
    let lead = 2.0 * margin * margin + 8.0 * (margin / RELATIVE_MARGIN) * slack;
    let margin = 2.0 * cell.max_error + lead / (2.0 * length);
    let midpoint = std::array::from_fn(|k| cell.position[k] + 0.5 * offset[k]);
    Plane { point: midpoint, direction: normalized(offset), margin }
}

/// The planes around the largest features of the primitives of a packet, lane by lane: the sides of triangles, and the
/// ends of segments. A point on the right side of all of them is over the feature.
pub(crate) struct LanesOver {
    /// For each plane its point and its normal, row by row.
    planes: [[[[f64; LANES]; 3]; 2]; 3],
    /// A bit mask of the lanes with such a feature that no primitive with a lower id has.
    lanes: u16,
}

impl Default for LanesOver {
    fn default() -> Self {
        Self { planes: [[[[0.0; LANES]; 3]; 2]; 3], lanes: 0 }
    }
}

impl LanesOver {
    /// Collects the planes of a packet.
    pub(crate) fn prepare(&mut self, scene: RelevanceContext<'_>, number: usize) {
        let packet = &scene.tree.leaves.packets[number];
        self.lanes = 0;
        for lane in 0..packet.ids().len() {
            let (vertices, _, count) = scene.vertices(number, lane);
            let frame = PrimitiveFrame::from_vertices(&vertices[..count]);
            let direction = frame.edge_directions[0];
            let planes = match count {
                3 => [0, 1, 2].map(|i: usize| [vertices[i], frame.inward_normals[i]]),
                2 if scene.adjacency.owned_by_lower_id[number][lane] >> 3 & 1 == 0 => {
                    let start = [vertices[0], direction];
                    [start, [vertices[1], direction.map(|x| -x)], start]
                }
                _ => continue,
            };
            self.lanes |= 1 << lane;
            for (rows, vectors) in self.planes.iter_mut().zip(planes) {
                for (rows, vector) in rows.iter_mut().zip(vectors) {
                    for (row, x) in rows.iter_mut().zip(vector) {
                        row[lane] = x;
                    }
                }
            }
        }
    }

    /// Returns a bit mask of the lanes whose largest feature lies below a point. Such a feature is relevant in every
    /// region that contains the point.
    #[inline(always)]
    pub(crate) fn lanes_below_point<D: Doubles>(&self, point: &V3) -> u16 {
        let mut lanes = 0;
        for first in [0, LANES / 2] {
            let mut bits = 0xff;
            for [points, normals] in &self.planes {
                let mut height = D::splat(0.0);
                for k in 0..3 {
                    let offset = D::splat(point[k]) - D::load(&points[k][first..]);
                    height = height + offset * D::load(&normals[k][first..]);
                }
                bits &= D::bits(D::splat(0.0).is_at_most(height));
            }
            lanes |= u16::from(bits) << first;
        }
        lanes & self.lanes
    }
}

/// A primitive of one to three vertices whose planes are collected.
struct PrimitiveView<'a> {
    /// The data that all tests share.
    scene: RelevanceContext<'a>,
    /// The vertices of the primitive.
    vertices: &'a [V3],
    /// The sites of the vertices.
    sites: [usize; 3],
    /// The directions of the primitive.
    frame: PrimitiveFrame,
}

impl PrimitiveView<'_> {
    /// Returns the plane through the side of the triangle from vertex i to the next one. The triangle is on its right
    /// side.
    fn side_plane(&self, i: usize) -> FeaturePlane {
        FeaturePlane {
            point: self.vertices[i],
            direction: self.frame.inward_normals[i],
            is_foreign: false,
            max_margin: f64::INFINITY,
            margin_factor: self.frame.sine.recip(),
        }
    }

    /// Adds the planes of the edge from vertex i to the next one.
    fn add_edge_planes(&self, i: usize, opposite: u32, planes: &mut Vec<FeaturePlane>, foreign_bounds: &mut [V3; 2]) {
        let count = self.vertices.len();
        let (p, q) = (self.vertices[i], self.vertices[(i + 1) % count]);
        let direction = self.frame.edge_directions[i];
        let end = |point, direction| FeaturePlane {
            point,
            direction,
            is_foreign: false,
            max_margin: f64::INFINITY,
            margin_factor: 1.0,
        };
        planes.extend([end(p, direction), end(q, direction.map(|x| -x))]);
        if count < 3 {
            return;
        }
        let flipped = |plane: FeaturePlane| FeaturePlane { direction: plane.direction.map(|x| -x), ..plane };
        planes.push(flipped(self.side_plane(i)));
        if opposite == NO_PRIMITIVE {
            return;
        }
        let opposite = opposite as usize;
        let (vertices, sites, _) = self.scene.vertices(opposite / LANES, opposite % LANES);
        let other = PrimitiveView {
            scene: self.scene,
            vertices: &vertices,
            sites,
            frame: PrimitiveFrame::from_vertices(&vertices),
        };
        // The height of the other triangle is zero if two of its vertices are equal, so `common_side` is its only
        // side with these ends.
        let ends = [self.sites[i], self.sites[(i + 1) % 3]];
        let common_side = (0..3).find(|j| ends.contains(&sites[*j]) && ends.contains(&sites[(j + 1) % 3]));
        if let Some(j) = common_side {
            let plane = flipped(other.side_plane(j));
            planes.push(FeaturePlane { is_foreign: true, max_margin: other.frame.height, ..plane });
            extend_box(foreign_bounds, &vertices);
        }
    }

    /// Adds the planes of vertex i.
    fn add_vertex_planes(&self, i: usize, planes: &mut Vec<FeaturePlane>, foreign_bounds: &mut [V3; 2]) {
        let point = self.vertices[i];
        let mut add_edge_to = |end: V3| {
            let offset = sub(end, point);
            planes.push(FeaturePlane {
                point,
                direction: normalized(offset).map(|x| -x),
                is_foreign: true,
                max_margin: norm_squared(offset).sqrt().next_down(),
                margin_factor: 1.0,
            });
            extend_box(foreign_bounds, &[end]);
        };
        (0..self.vertices.len()).filter(|j| *j != i).for_each(|j| add_edge_to(self.vertices[j]));
        if self.scene.adjacency.is_exact {
            let others = self.scene.adjacency.edges.get(self.sites[i]).iter().take(MAX_EDGES_OF_VERTEX);
            let is_other_site = |w: &&u32| !self.sites[..self.vertices.len()].contains(&(**w as usize));
            others.filter(is_other_site).for_each(|w| add_edge_to(self.scene.position(*w as usize)));
        }
    }
}

/// Returns the corners of the box around some points.
fn box_of(points: &[V3]) -> [V3; 2] {
    let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    extend_box(&mut bounds, points);
    bounds
}

/// Enlarges a box, given by its corners, so that it has some points.
fn extend_box([low, high]: &mut [V3; 2], points: &[V3]) {
    for point in points {
        for k in 0..3 {
            (low[k], high[k]) = (low[k].min(point[k]), high[k].max(point[k]));
        }
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
    pub(crate) fn position(&self, site: usize) -> V3 {
        self.delaunay.sites()[site].map(|x| x * self.delaunay.unit())
    }
}
