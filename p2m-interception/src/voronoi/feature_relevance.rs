//! Which features of a primitive matter in a region: faces, edges and vertices that can be the nearest point of all.
//!
//! A feature can be that only on one side of some planes. A point that is nearest to the inside of a face lies over it.
//! One that is nearest to an edge lies between its ends, and over no triangle that has the edge: that triangle would be
//! nearer. One that is nearest to a vertex lies behind it along every edge that begins there, and is as near to it as
//! to the site of the cell. So a feature is *missed* if all of the region is on the wrong side of a plane, or if the
//! heights above two planes have a sum below zero: then each point is on the wrong side of one of the two. docs/proofs/p2m.md
//! has the margins.

use crate::delaunay::Delaunay;
use crate::voronoi::adjacency::{Features, NONE, Shared};
use p2m_bvh::PacketTree;
use p2m_bvh::engine::packet::LANES;
use p2m_core::engine::number::cross;
use p2m_core::engine::vector::{V3, dot, largest, norm_squared, sub};

/// Part of the largest length by which a feature has to be missed.
const MARGIN: f64 = 1.0 / (1u64 << 22) as f64;
/// Edges of a vertex that are looked at.
const MOST_EDGES: usize = 32;

/// Directions of a primitive: those that each test needs.
#[derive(Clone, Copy, Default)]
struct Outline {
    /// From each vertex to the next.
    along: [V3; 3],
    /// From each side into the triangle.
    inward: [V3; 3],
    /// The least height of a triangle, or the length of a segment, and what part that is of the longest edge; no point
    /// is slim.
    height: f64,
    sine: f64,
}

/// Those of all lanes of all packets.
pub(crate) struct Outlines(Vec<Outline>);

impl Outlines {
    pub(crate) fn of(tree: &PacketTree) -> Self {
        let mut all = vec![Outline::default(); tree.leaves.packets.len() * LANES];
        for (packet, own) in tree.leaves.packets.iter().zip(all.chunks_exact_mut(LANES)) {
            for (lane, to) in own.iter_mut().enumerate().take(packet.ids().len()) {
                let (places, count) = packet.vertices_of(lane);
                let mut vertices = [[0.0; 3]; 3];
                vertices.iter_mut().zip(&places[..count]).for_each(|(to, place)| *to = tree.leaves.vertices[*place]);
                *to = Outline::of(&vertices[..count]);
            }
        }
        Self(all)
    }

    fn get(&self, packet: usize, lane: usize) -> &Outline {
        &self.0[packet * LANES + lane]
    }
}

impl Outline {
    fn of(vertices: &[V3]) -> Self {
        let mut outline = Self { height: f64::INFINITY, sine: 1.0, ..Self::default() };
        if vertices.len() < 2 {
            return outline;
        }
        let way = |i: usize| sub(vertices[(i + 1) % vertices.len()], vertices[i]);
        (0..vertices.len()).for_each(|i| outline.along[i] = unit(way(i)));
        let length = |i: usize| norm_squared(way(i)).sqrt();
        if vertices.len() == 2 {
            outline.height = length(0);
            return outline;
        }
        let normal = cross(way(0), sub(vertices[2], vertices[0]));
        outline.height = norm_squared(normal).sqrt() / length(0).max(length(1)).max(length(2));
        outline.sine = outline.height / length(0).max(length(1)).max(length(2));
        (0..3).for_each(|i| outline.inward[i] = cross(unit(normal), outline.along[i]));
        outline
    }
}

/// Where primitives come from.
#[derive(Clone, Copy)]
pub(crate) struct Scene<'a> {
    pub(crate) tree: &'a PacketTree,
    pub(crate) delaunay: &'a Delaunay,
    pub(crate) features: &'a Features,
    pub(crate) outlines: &'a Outlines,
    /// By how much a dominator has to be nearer.
    pub(crate) slack: f64,
}

/// A cell.
#[derive(Clone, Copy)]
pub(crate) struct Around {
    pub(crate) site: usize,
    pub(crate) place: V3,
    /// The largest distance of a corner from it,
    pub(crate) reach: f64,
    /// and what a corner may be off.
    pub(crate) error: f64,
}

/// A primitive of one to three vertices, as a cell sees it.
pub(crate) struct Seen<'a> {
    scene: Scene<'a>,
    cell: Around,
    vertices: [V3; 3],
    count: usize,
    sites: [usize; 3],
    across: [u32; 3],
    shared: Shared,
    /// The largest distance of a vertex from the site of the cell.
    size: f64,
    margin: f64,
    outline: &'a Outline,
}

/// A plane by a point and a direction of length 1: what is lower than minus `margin` is on the wrong side.
#[derive(Clone, Copy)]
struct Plane {
    point: V3,
    direction: V3,
    margin: f64,
}

impl<'a> Seen<'a> {
    /// The one in a lane of a packet; `None` where nothing can be said.
    pub(crate) fn new(scene: Scene<'a>, cell: Around, packet: usize, lane: usize) -> Option<Self> {
        let (vertices, sites, count) = scene.vertices(packet, lane);
        let size = vertices[..count].iter().map(|v| largest(&[sub(*v, cell.place)])).fold(0.0, f64::max);
        // Rounding of the kernel near the borders of features, and of what is computed here.
        let margin = MARGIN * (cell.reach + size);
        let outline = scene.outlines.get(packet, lane);
        let height = outline.height;
        // Not for NaN either. One of your own has no vertices.
        if count == 0 || cell.error >= margin * 0.25 || height.is_nan() || height < margin {
            return None;
        }
        let across = scene.features.across[packet][lane];
        let shared = scene.features.shared[packet][lane];
        Some(Self { scene, cell, vertices, count, sites, across, shared, size, margin, outline })
    }

    /// Whether a feature matters in the hull of a region that belongs to no primitive of a lower id.
    pub(crate) fn matters(&self, region: &[V3], missed: &mut Missed) -> bool {
        missed.set_region(region);
        let edge_count = if self.count == 3 { 3 } else { self.count - 1 };
        if self.count == 3 {
            missed.begin();
            (0..3).for_each(|i| missed.add(region, self.side(i)));
            if !missed.is_missed(region) {
                return true;
            }
        }
        for i in (0..edge_count).filter(|i| self.shared >> (3 + i) & 1 == 0) {
            missed.begin();
            self.edge(i, &mut |plane| missed.add(region, plane));
            if !missed.is_missed(region) {
                return true;
            }
        }
        for i in (0..self.count).filter(|i| self.shared >> i & 1 == 0) {
            missed.begin();
            self.vertex(i, &mut |plane| missed.add(region, plane));
            if !missed.is_missed(region) {
                return true;
            }
        }
        false
    }

    /// Of the side of a triangle from vertex i to the next, into the triangle.
    fn side(&self, i: usize) -> Plane {
        Plane { point: self.vertices[i], direction: self.outline.inward[i], margin: self.margin / self.outline.sine }
    }

    fn edge(&self, i: usize, add: &mut dyn FnMut(Plane)) {
        let (p, q) = (self.vertices[i], self.vertices[(i + 1) % self.count]);
        let d = self.outline.along[i];
        let margin = self.margin;
        add(Plane { point: p, direction: d, margin });
        add(Plane { point: q, direction: d.map(|x| -x), margin });
        if self.count < 3 {
            return;
        }
        let turned = |plane: Plane| Plane { direction: plane.direction.map(|x| -x), ..plane };
        add(turned(self.side(i)));
        let across = self.across[i] as usize;
        if self.across[i] == NONE {
            return;
        }
        let (others, sites, _) = self.scene.vertices(across / LANES, across % LANES);
        let outline = self.scene.outlines.get(across / LANES, across % LANES);
        let margin = self.margin_with(&others);
        // Where two vertices of the other one are the same, its height is zero.
        let ends = [self.sites[i], self.sites[(i + 1) % 3]];
        let same = (0..3).find(|j| ends.contains(&sites[*j]) && ends.contains(&sites[(j + 1) % 3]));
        if let Some(j) = same.filter(|_| outline.height >= margin) {
            add(turned(Plane { point: others[j], direction: outline.inward[j], margin: margin / outline.sine }));
        }
    }

    fn vertex(&self, i: usize, add: &mut dyn FnMut(Plane)) {
        let point = self.vertices[i];
        let Self { cell, scene, .. } = self;
        let mut along = |other: V3| {
            let way = sub(other, point);
            let margin = self.margin_with(&[other]);
            if norm_squared(way) > margin * margin {
                add(Plane { point, direction: unit(way).map(|x| -x), margin });
            }
        };
        (0..self.count).filter(|j| *j != i).for_each(|j| along(self.vertices[j]));
        if scene.features.exact {
            let others = scene.features.edges.of(self.sites[i]).iter().take(MOST_EDGES);
            let own = |w: &&u32| !self.sites[..self.count].contains(&(**w as usize));
            others.filter(own).for_each(|w| along(scene.place(*w as usize)));
            if self.sites[i] != cell.site {
                // In the cell the vertex is not nearer than the site.
                let way = sub(point, cell.place);
                let length = norm_squared(way).sqrt();
                let lead = 2.0 * self.margin * self.margin + 8.0 * (cell.reach + self.size) * scene.slack;
                let margin = 2.0 * cell.error + lead / (2.0 * length);
                let middle = std::array::from_fn(|k| cell.place[k] + 0.5 * way[k]);
                add(Plane { point: middle, direction: unit(way), margin });
            }
        }
    }

    /// The margin along edges of a primitive that has other vertices, too.
    fn margin_with(&self, others: &[V3]) -> f64 {
        let sizes = others.iter().map(|v| largest(&[sub(*v, self.cell.place)]));
        MARGIN * (self.cell.reach + sizes.fold(self.size, f64::max))
    }
}

impl Scene<'_> {
    /// The vertices of the primitive in a lane of a packet, their sites, and how many there are.
    fn vertices(&self, packet: usize, lane: usize) -> ([V3; 3], [usize; 3], usize) {
        let leaves = &self.tree.leaves;
        let (places, count) = leaves.packets[packet].vertices_of(lane);
        let (mut vertices, mut sites) = ([[0.0; 3]; 3], [0; 3]);
        for (i, place) in places[..count].iter().enumerate() {
            (vertices[i], sites[i]) = (leaves.vertices[*place], self.delaunay.site_of(*place));
        }
        (vertices, sites, count)
    }

    fn place(&self, site: usize) -> V3 {
        self.delaunay.sites()[site].map(|x| x * self.delaunay.unit())
    }
}

/// The planes of a feature, and the heights of a region above them.
#[derive(Default)]
pub(crate) struct Missed {
    /// The mean of the points that span the region.
    middle: V3,
    planes: Vec<Height>,
    /// Of planes that the middle is on the wrong side of, and of others when they are asked for.
    heights: Vec<f64>,
    /// Whether one plane is enough.
    found: bool,
}

/// A plane with the height of the middle above it.
struct Height {
    plane: Plane,
    middle: f64,
    /// Where the heights of the points begin, if these are known.
    first: Option<usize>,
}

impl Plane {
    fn height(&self, x: &V3) -> f64 {
        dot(sub(*x, self.point), self.direction) + self.margin
    }
}

impl Missed {
    /// For another region.
    fn set_region(&mut self, region: &[V3]) {
        let sum = region.iter().fold([0.0; 3], |sum, h| [sum[0] + h[0], sum[1] + h[1], sum[2] + h[2]]);
        self.middle = sum.map(|x| x / region.len() as f64);
    }

    /// For another feature.
    fn begin(&mut self) {
        self.planes.clear();
        self.heights.clear();
        self.found = false;
    }

    fn add(&mut self, region: &[V3], plane: Plane) {
        if self.found {
            return;
        }
        let middle = plane.height(&self.middle);
        self.planes.push(Height { plane, middle, first: None });
        // All points are lower than zero only if their mean is.
        if middle < 0.0 {
            self.found = self.row(self.planes.len() - 1, region).iter().all(|x| *x < 0.0);
        }
    }

    /// The heights of the points above a plane.
    fn row(&mut self, number: usize, region: &[V3]) -> &[f64] {
        let Height { plane, first, .. } = &mut self.planes[number];
        let first = *first.get_or_insert_with(|| {
            let first = self.heights.len();
            self.heights.extend(region.iter().map(|h| plane.height(h)));
            first
        });
        &self.heights[first..first + region.len()]
    }

    fn is_missed(&mut self, region: &[V3]) -> bool {
        if self.found || region.is_empty() {
            return true;
        }
        for i in 0..self.planes.len() {
            for j in 0..i {
                if self.planes[i].middle + self.planes[j].middle < 0.0 {
                    self.row(i, region);
                    self.row(j, region);
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
fn unit(d: V3) -> V3 {
    let length = norm_squared(d).sqrt();
    if length > 0.0 { d.map(|x| x / length) } else { [0.0; 3] }
}
