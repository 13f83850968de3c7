//! Which adjacency of a primitive matter in a region: faces, edges and vertices that can be the nearest point of all.
//!
//! A feature can be that only on one side of some planes. A point that is nearest to the inside of a face lies over it.
//! One that is nearest to an edge lies between its ends, and over no triangle that has the edge: that triangle would be
//! nearer. One that is nearest to a vertex lies behind it edge_directions every edge that begins there, and is as near to it as
//! to the site of the cell. So a feature is *excluded* if all of the region is on the wrong side of a plane, or if the
//! heights above two planes have a sum below zero: then each point is on the wrong side of one of the two. docs/proofs/p2m.md
//! has the margins.

use crate::delaunay::Delaunay;
use crate::voronoi::adjacency::{EdgeAdjacency, NO_PRIMITIVE, OwnedByLowerId};
use p2m_bvh::PacketTree;
use p2m_bvh::engine::packet::LANES;
use p2m_core::engine::number::cross;
use p2m_core::engine::vector::{V3, dot, largest, norm_squared, sub};

/// Part of the largest length by which a feature has to be excluded.
const RELATIVE_MARGIN: f64 = 1.0 / (1u64 << 22) as f64;
/// Edges of a vertex that are looked at.
const MAX_EDGES_OF_VERTEX: usize = 32;

/// Directions of a primitive: those that each test needs.
#[derive(Clone, Copy, Default)]
struct PrimitiveFrame {
    /// From each vertex to the next.
    edge_directions: [V3; 3],
    /// From each side into the triangle.
    inward_normals: [V3; 3],
    /// The least height of a triangle, or the length of a segment, and what part that is of the longest edge; no point
    /// is slim.
    height: f64,
    sine: f64,
}

/// Those of all lanes of all packets.
pub(crate) struct PrimitiveFrames(Vec<PrimitiveFrame>);

impl PrimitiveFrames {
    pub(crate) fn of(tree: &PacketTree) -> Self {
        let mut all = vec![PrimitiveFrame::default(); tree.leaves.packets.len() * LANES];
        for (packet, own) in tree.leaves.packets.iter().zip(all.chunks_exact_mut(LANES)) {
            for (lane, to) in own.iter_mut().enumerate().take(packet.ids().len()) {
                let (positions, count) = packet.vertices_of(lane);
                let mut vertices = [[0.0; 3]; 3];
                vertices
                    .iter_mut()
                    .zip(&positions[..count])
                    .for_each(|(to, position)| *to = tree.leaves.vertices[*position]);
                *to = PrimitiveFrame::of(&vertices[..count]);
            }
        }
        Self(all)
    }

    fn get(&self, packet: usize, lane: usize) -> &PrimitiveFrame {
        &self.0[packet * LANES + lane]
    }
}

impl PrimitiveFrame {
    fn of(vertices: &[V3]) -> Self {
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

/// Where primitives come from.
#[derive(Clone, Copy)]
pub(crate) struct RelevanceContext<'a> {
    pub(crate) tree: &'a PacketTree,
    pub(crate) delaunay: &'a Delaunay,
    pub(crate) adjacency: &'a EdgeAdjacency,
    pub(crate) frames: &'a PrimitiveFrames,
    /// By how much a dominator has to be nearer.
    pub(crate) slack: f64,
}

/// A cell.
#[derive(Clone, Copy)]
pub(crate) struct CellInfo {
    pub(crate) site: usize,
    pub(crate) position: V3,
    /// The largest distance of a corner from it,
    pub(crate) max_distance: f64,
    /// and what a corner may be off.
    pub(crate) max_error: f64,
}

/// A primitive of one to three vertices, as a cell sees it.
pub(crate) struct PrimitiveView<'a> {
    scene: RelevanceContext<'a>,
    cell: CellInfo,
    vertices: [V3; 3],
    count: usize,
    sites: [usize; 3],
    opposite_triangles: [u32; 3],
    owned_by_lower_id: OwnedByLowerId,
    /// The largest distance of a vertex from the site of the cell.
    max_vertex_distance: f64,
    margin: f64,
    frame: &'a PrimitiveFrame,
}

/// A plane by a point and a direction of length 1: what is lower than minus `margin` is on the wrong side.
#[derive(Clone, Copy)]
struct Plane {
    point: V3,
    direction: V3,
    margin: f64,
}

impl<'a> PrimitiveView<'a> {
    /// The one in a lane of a packet; `None` where nothing can be said.
    pub(crate) fn new(scene: RelevanceContext<'a>, cell: CellInfo, packet: usize, lane: usize) -> Option<Self> {
        let (vertices, sites, count) = scene.vertices(packet, lane);
        let max_vertex_distance =
            vertices[..count].iter().map(|v| largest(&[sub(*v, cell.position)])).fold(0.0, f64::max);
        // Rounding of the kernel near the borders of adjacency, and of what is computed here.
        let margin = RELATIVE_MARGIN * (cell.max_distance + max_vertex_distance);
        let frame = scene.frames.get(packet, lane);
        let height = frame.height;
        // Not for NaN either. One of your own has no vertices.
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

    /// Whether a feature is_relevant in the hull of a region that belongs to no primitive of a lower id.
    pub(crate) fn is_relevant(&self, region: &[V3], excluded: &mut ExcludedFeatures) -> bool {
        excluded.set_region(region);
        let edge_count = if self.count == 3 { 3 } else { self.count - 1 };
        if self.count == 3 {
            excluded.begin();
            (0..3).for_each(|i| excluded.add(region, self.side(i)));
            if !excluded.is_excluded(region) {
                return true;
            }
        }
        for i in (0..edge_count).filter(|i| self.owned_by_lower_id >> (3 + i) & 1 == 0) {
            excluded.begin();
            self.edge(i, &mut |plane| excluded.add(region, plane));
            if !excluded.is_excluded(region) {
                return true;
            }
        }
        for i in (0..self.count).filter(|i| self.owned_by_lower_id >> i & 1 == 0) {
            excluded.begin();
            self.vertex(i, &mut |plane| excluded.add(region, plane));
            if !excluded.is_excluded(region) {
                return true;
            }
        }
        false
    }

    /// Of the side of a triangle from vertex i to the next, into the triangle.
    fn side(&self, i: usize) -> Plane {
        Plane {
            point: self.vertices[i],
            direction: self.frame.inward_normals[i],
            margin: self.margin / self.frame.sine,
        }
    }

    fn edge(&self, i: usize, add: &mut dyn FnMut(Plane)) {
        let (p, q) = (self.vertices[i], self.vertices[(i + 1) % self.count]);
        let d = self.frame.edge_directions[i];
        let margin = self.margin;
        add(Plane { point: p, direction: d, margin });
        add(Plane { point: q, direction: d.map(|x| -x), margin });
        if self.count < 3 {
            return;
        }
        let turned = |plane: Plane| Plane { direction: plane.direction.map(|x| -x), ..plane };
        add(turned(self.side(i)));
        let opposite_triangles = self.opposite_triangles[i] as usize;
        if self.opposite_triangles[i] == NO_PRIMITIVE {
            return;
        }
        let (others, sites, _) = self.scene.vertices(opposite_triangles / LANES, opposite_triangles % LANES);
        let frame = self.scene.frames.get(opposite_triangles / LANES, opposite_triangles % LANES);
        let margin = self.margin_with(&others);
        // Where two vertices of the other one are the same, its height is zero.
        let ends = [self.sites[i], self.sites[(i + 1) % 3]];
        let same = (0..3).find(|j| ends.contains(&sites[*j]) && ends.contains(&sites[(j + 1) % 3]));
        if let Some(j) = same.filter(|_| frame.height >= margin) {
            add(turned(Plane { point: others[j], direction: frame.inward_normals[j], margin: margin / frame.sine }));
        }
    }

    fn vertex(&self, i: usize, add: &mut dyn FnMut(Plane)) {
        let point = self.vertices[i];
        let Self { cell, scene, .. } = self;
        let mut edge_directions = |other: V3| {
            let offset = sub(other, point);
            let margin = self.margin_with(&[other]);
            if norm_squared(offset) > margin * margin {
                add(Plane { point, direction: normalized(offset).map(|x| -x), margin });
            }
        };
        (0..self.count).filter(|j| *j != i).for_each(|j| edge_directions(self.vertices[j]));
        if scene.adjacency.is_exact {
            let others = scene.adjacency.edges.of(self.sites[i]).iter().take(MAX_EDGES_OF_VERTEX);
            let own = |w: &&u32| !self.sites[..self.count].contains(&(**w as usize));
            others.filter(own).for_each(|w| edge_directions(scene.position(*w as usize)));
            if self.sites[i] != cell.site {
                // In the cell the vertex is not nearer than the site.
                let offset = sub(point, cell.position);
                let length = norm_squared(offset).sqrt();
                let lead = 2.0 * self.margin * self.margin
                    + 8.0 * (cell.max_distance + self.max_vertex_distance) * scene.slack;
                let margin = 2.0 * cell.max_error + lead / (2.0 * length);
                let mean = std::array::from_fn(|k| cell.position[k] + 0.5 * offset[k]);
                add(Plane { point: mean, direction: normalized(offset), margin });
            }
        }
    }

    /// The margin edge_directions edges of a primitive that has other vertices, too.
    fn margin_with(&self, others: &[V3]) -> f64 {
        let sizes = others.iter().map(|v| largest(&[sub(*v, self.cell.position)]));
        RELATIVE_MARGIN * (self.cell.max_distance + sizes.fold(self.max_vertex_distance, f64::max))
    }
}

impl RelevanceContext<'_> {
    /// The vertices of the primitive in a lane of a packet, their sites, and how many there are.
    fn vertices(&self, packet: usize, lane: usize) -> ([V3; 3], [usize; 3], usize) {
        let leaves = &self.tree.leaves;
        let (positions, count) = leaves.packets[packet].vertices_of(lane);
        let (mut vertices, mut sites) = ([[0.0; 3]; 3], [0; 3]);
        for (i, position) in positions[..count].iter().enumerate() {
            (vertices[i], sites[i]) = (leaves.vertices[*position], self.delaunay.site_of(*position));
        }
        (vertices, sites, count)
    }

    fn position(&self, site: usize) -> V3 {
        self.delaunay.sites()[site].map(|x| x * self.delaunay.unit())
    }
}

/// The planes of a feature, and the heights of a region above them.
#[derive(Default)]
pub(crate) struct ExcludedFeatures {
    /// The mean of the points that span the region.
    mean: V3,
    planes: Vec<PlaneHeights>,
    /// Of planes that the mean is on the wrong side of, and of others when they are asked for.
    heights: Vec<f64>,
    /// Whether one plane is enough.
    is_decided: bool,
}

/// A plane with the height of the mean above it.
struct PlaneHeights {
    plane: Plane,
    mean: f64,
    /// Where the heights of the points begin, if these are known.
    first: Option<usize>,
}

impl Plane {
    fn height(&self, x: &V3) -> f64 {
        dot(sub(*x, self.point), self.direction) + self.margin
    }
}

impl ExcludedFeatures {
    /// For another region.
    fn set_region(&mut self, region: &[V3]) {
        let sum = region.iter().fold([0.0; 3], |sum, h| [sum[0] + h[0], sum[1] + h[1], sum[2] + h[2]]);
        self.mean = sum.map(|x| x / region.len() as f64);
    }

    /// For another feature.
    fn begin(&mut self) {
        self.planes.clear();
        self.heights.clear();
        self.is_decided = false;
    }

    fn add(&mut self, region: &[V3], plane: Plane) {
        if self.is_decided {
            return;
        }
        let mean = plane.height(&self.mean);
        self.planes.push(PlaneHeights { plane, mean, first: None });
        // All points are lower than zero only if their mean is.
        if mean < 0.0 {
            self.is_decided = self.heights_above(self.planes.len() - 1, region).iter().all(|x| *x < 0.0);
        }
    }

    /// The heights of the points above a plane.
    fn heights_above(&mut self, number: usize, region: &[V3]) -> &[f64] {
        let PlaneHeights { plane, first, .. } = &mut self.planes[number];
        let first = *first.get_or_insert_with(|| {
            let first = self.heights.len();
            self.heights.extend(region.iter().map(|h| plane.height(h)));
            first
        });
        &self.heights[first..first + region.len()]
    }

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

/// The direction of a length, zero for none; products with it are lengths.
fn normalized(d: V3) -> V3 {
    let length = norm_squared(d).sqrt();
    if length > 0.0 { d.map(|x| x / length) } else { [0.0; 3] }
}
