//! Signs by the normal at the closest point, where that is proved to decide, and by rays elsewhere.
//!
//! The segment from a query to its closest point crosses no other part of the surface, except perhaps nearer to the
//! closest point than the error of the distance. So the query is on the side of the surface from which the segment
//! arrives, if the surface is simple there. The side follows from the pseudonormal: on a face, its normal; at an edge,
//! the sum of the unit normals of its two faces; at a vertex, the sum of the unit normals of the faces around it, each
//! multiplied by its angle there \[Baerentzen2005\].
//!
//! **Where the surface is simple.** A vertex is simple if its triangles form one fan that projects along its
//! pseudonormal without overlap. A triangle is simple if it is no sliver, its vertices are simple, and no triangle
//! without a common vertex is within [`Certificates::clearance`] of it. [docs/proofs/fields.md] proves that then a ball
//! around the closest point has only the triangles of its feature.
//!
//! **What the sides mean.** All points just in front of a simple triangle have one winding number, and those just
//! behind it one more. Simple triangles with a common edge have the same numbers. They form patches, and one exact ray
//! decides the numbers of a patch, when the first query arrives there.
//!
//! [docs/proofs/fields.md]: https://github.com/p2m-rs/p2m/blob/main/docs/proofs/fields.md

use super::crowding;
use super::surface::{NO_TRIANGLE, Surface};
use super::triangle::{MIN_SINE, ROUNDING, angle, corners, unit_normal};
use super::types::{RayTree, SharedSoup};
use nalgebra::Point3;
use p2m_bvh::TreeIndex;
use p2m_core::engine::arithmetic::cross;
use p2m_core::engine::vector::{V3, add, add_scaled, dot, largest, length, scaled, sub};
use p2m_core::engine::weld::UnionFind;
use p2m_core::{BuildError, Closest, Feature, Real};
use std::sync::atomic::{AtomicI64, Ordering};

/// The smallest cosine between the normals of a fan and its pseudonormal: 2^-4.
const MIN_COSINE: f64 = 1.0 / 16.0;
/// The bound on the error of a pseudonormal: 2^-24. Normals of triangles that are no slivers have errors below
/// 12 * 2^-53 / 2^-16 < 2^-33, and there are fewer than 2^8 of them around a vertex.
const NORMAL_ERROR: f64 = 1.0 / (1 << 24) as f64;
/// A vertex with this many triangles is not simple.
const MAX_VALENCE: u8 = u8::MAX;
/// The clearance of triangles, in units of the roundoff of the index and the size of the scene.
const CLEARANCE: f64 = 128.0;
/// Marks a triangle that is not simple.
const NO_PATCH: u32 = u32::MAX;
/// Marks a patch whose winding number is unknown.
const UNKNOWN: i64 = i64::MIN;

/// The simple triangles of a closed surface, and their patches.
pub(super) struct Certificates<S> {
    soup: S,
    /// The tree of the surface.
    pub(super) tree: RayTree<S>,
    /// The distance that other parts of the surface have from simple triangles.
    clearance: f64,
    /// The triangle beyond each edge, or [`NO_TRIANGLE`].
    neighbours: Vec<[u32; 3]>,
    /// The vertex id of each position.
    vertex_ids: Vec<u32>,
    /// The pseudonormal of each simple vertex and the smallest height of its triangles over the opposite
    /// edges, or zeros.
    fans: Vec<Fan>,
    /// The patch of each triangle, or [`NO_PATCH`].
    patches: Vec<u32>,
    /// The winding number of the points in front of each patch, or [`UNKNOWN`].
    fronts: Vec<AtomicI64>,
}

/// The triangles around a vertex.
#[derive(Clone, Copy, Default)]
struct Fan {
    normal: V3,
    reach: f64,
}

/// The side of a patch that a query is on.
#[derive(Clone, Copy)]
pub(super) struct PatchSide {
    patch: u32,
    is_front: bool,
}

impl<S: SharedSoup> Certificates<S> {
    /// Finds the simple triangles of a closed surface. `roundoff` is the unit roundoff of the index.
    ///
    /// # Errors
    /// Errors of building a tree.
    pub(super) fn new(soup: S, roundoff: f64) -> Result<Self, BuildError> {
        let Surface { welder, neighbours, .. } = Surface::new(&soup);
        let tree = TreeIndex::new(soup.clone())?;
        let bounds = soup.aabb();
        let extent = length((bounds.max - bounds.min).into());
        let clearance = CLEARANCE * roundoff * extent;
        let mut found = Self {
            clearance,
            neighbours,
            vertex_ids: welder.vertex_ids,
            fans: vec![Fan::default(); welder.vertex_count],
            patches: vec![NO_PATCH; soup.triangles().len()],
            fronts: Vec::new(),
            soup,
            tree,
        };
        // Elsewhere products of lengths may overflow or underflow.
        if (1e-90..1e90).contains(&extent) {
            found.find_fans();
            found.find_patches();
        }
        Ok(found)
    }

    fn weld(&self, corners: [u32; 3]) -> [u32; 3] {
        corners.map(|i| self.vertex_ids[i as usize])
    }

    /// Computes the fans of simple vertices.
    fn find_fans(&mut self) {
        let soup = &*self.soup;
        let mut counts = vec![0u8; self.fans.len()];
        let normals: Vec<Option<V3>> = soup.triangles().iter().map(|t| unit_normal(corners(soup, *t))).collect();
        for (t, triangle) in soup.triangles().iter().enumerate() {
            let (corners, neighbours) = (corners(soup, *triangle), self.neighbours[t]);
            for (i, vertex) in self.weld(*triangle).into_iter().enumerate() {
                let (fan, count) = (&mut self.fans[vertex as usize], &mut counts[vertex as usize]);
                // The edges of the triangle at the vertex need neighbours, or it is the end of an open fan.
                let is_closed = neighbours[i] != NO_TRIANGLE && neighbours[(i + 2) % 3] != NO_TRIANGLE;
                match normals[t] {
                    Some(normal) if is_closed && *count < MAX_VALENCE => {
                        let height = height(corners, i);
                        fan.reach = if *count == 0 { height } else { fan.reach.min(height) };
                        fan.normal = add(fan.normal, scaled(normal, angle(corners, i)));
                        *count += 1;
                    }
                    _ => *count = MAX_VALENCE,
                }
            }
        }
        // All triangles of a vertex turn once around it, from below an axis to above it, if and only if they are one
        // fan that projects without overlap.
        let mut turns = vec![0u8; self.fans.len()];
        for (t, triangle) in soup.triangles().iter().enumerate() {
            let corners = corners(soup, *triangle);
            for (i, vertex) in self.weld(*triangle).into_iter().enumerate() {
                let (fan, count) = (&self.fans[vertex as usize], &mut counts[vertex as usize]);
                if *count == MAX_VALENCE {
                    continue;
                }
                // An axis in the plane of projection.
                let n = fan.normal;
                let across = if n[0].abs() < n[1].abs() { [0.0, n[2], -n[1]] } else { [n[2], 0.0, -n[0]] };
                let is_below = |k: usize| dot(sub(corners[(i + k) % 3], corners[i]), across) < 0.0;
                let least = MIN_COSINE * length(n) * (1.0 + NORMAL_ERROR);
                if normals[t].is_some_and(|normal| dot(normal, n) > least) {
                    turns[vertex as usize] =
                        turns[vertex as usize].saturating_add(u8::from(is_below(1) && !is_below(2)));
                } else {
                    *count = MAX_VALENCE;
                }
            }
        }
        for ((fan, count), turns) in self.fans.iter_mut().zip(counts).zip(turns) {
            if count == MAX_VALENCE || turns != 1 {
                *fan = Fan::default();
            }
        }
    }

    /// Finds the simple triangles, and joins those with common edges to patches.
    fn find_patches(&mut self) {
        let soup = &*self.soup;
        let triangles = soup.triangles();
        let welded: Vec<[u32; 3]> = triangles.iter().map(|corners| self.weld(*corners)).collect();
        // All triangles of a simple vertex have normals.
        let has_fans = |vertices: &[u32; 3]| vertices.iter().all(|vertex| self.fans[*vertex as usize].reach > 0.0);
        let mut simple: Vec<bool> = welded.iter().map(has_fans).collect();
        crowding::exclude(&mut simple, &self.soup, &welded, &self.tree, self.clearance);
        let mut sets = UnionFind::new(triangles.len());
        for (t, neighbours) in self.neighbours.iter().enumerate().filter(|(t, _)| simple[*t]) {
            for neighbour in neighbours.iter().filter(|n| simple.get(**n as usize) == Some(&true)) {
                sets.union(u32::try_from(t).unwrap_or(NO_TRIANGLE), *neighbour);
            }
        }
        let mut patch_of = vec![NO_PATCH; triangles.len()];
        for t in (0..triangles.len()).filter(|t| simple[*t]) {
            let set = sets.find(u32::try_from(t).unwrap_or(NO_TRIANGLE)) as usize;
            if patch_of[set] == NO_PATCH {
                patch_of[set] = u32::try_from(self.fronts.len()).unwrap_or(NO_PATCH);
                self.fronts.push(AtomicI64::new(UNKNOWN));
            }
            self.patches[t] = patch_of[set];
        }
    }

    /// Returns the side of a patch from which the surface is reached from a query, or `None` if that is not proved.
    pub(super) fn side<T: Real>(&self, query: &Point3<f64>, closest: &Closest<T>) -> Option<PatchSide> {
        let soup = &*self.soup;
        let triangle = closest.primitive.index();
        let patch = self.patches[triangle];
        if patch == NO_PATCH {
            return None;
        }
        let numbers = soup.triangles()[triangle];
        let corners = corners(soup, numbers);
        let q: V3 = (*query).into();
        let approach = match closest.feature {
            Feature::Face => Approach::at_face(q, corners),
            Feature::Edge(i) => {
                let neighbour = self.neighbours[triangle][usize::from(i)] as usize;
                Approach::at_edge(q, corners, self::corners(soup, soup.triangles()[neighbour]), usize::from(i))?
            }
            Feature::Vertex(i) => {
                let i = usize::from(i);
                let fan = &self.fans[self.vertex_ids[numbers[i] as usize] as usize];
                let offset = sub(q, corners[i]);
                Approach { offset, normal: fan.normal, reach: fan.reach, magnitude: largest(&[offset]) }
            }
        };
        let is_front = approach.is_from_front(closest.lower_bound.to_f64(), self.clearance)?;
        Some(PatchSide { patch, is_front })
    }

    /// Returns the winding number on a side of a patch. `decide` computes it by a ray from the query on that side.
    pub(super) fn winding_number(&self, side: PatchSide, decide: impl FnOnce() -> i64) -> i64 {
        let front = &self.fronts[side.patch as usize];
        let behind = i64::from(!side.is_front);
        match front.load(Ordering::Relaxed) {
            UNKNOWN => {
                let number = decide();
                front.store(number - behind, Ordering::Relaxed);
                number
            }
            number => number + behind,
        }
    }
}

/// The arrival of the segment from a query at a point of the surface.
struct Approach {
    /// The offset of the query from the point.
    offset: V3,
    /// The pseudonormal at the point: unit normals times the angles of their triangles there.
    normal: V3,
    /// The distance of the point from the edges and vertices that it does not lie on, of all triangles at the point.
    reach: f64,
    /// The largest magnitude of the numbers from which the offset was computed.
    magnitude: f64,
}

impl Approach {
    fn at_face(q: V3, corners: [V3; 3]) -> Self {
        let (v, e, f) = (sub(q, corners[0]), sub(corners[1], corners[0]), sub(corners[2], corners[0]));
        let n = cross(e, f);
        let square = dot(n, n);
        let (along_e, along_f) = (dot(cross(v, f), n) / square, dot(cross(e, v), n) / square);
        let offset = sub(v, add(scaled(e, along_e), scaled(f, along_f)));
        let size = square.sqrt();
        let reach = |weight: f64, edge: V3| weight * size / dot(edge, edge).sqrt();
        let reach = reach(along_e, f).min(reach(along_f, e)).min(reach(1.0 - along_e - along_f, sub(f, e)));
        let normal = scaled(n, std::f64::consts::TAU / size);
        Self { offset, normal, reach, magnitude: largest(&[v, e, f]) }
    }

    /// Makes the approach to edge `i` of a triangle. `other` has the corners of the triangle beyond the edge.
    fn at_edge(q: V3, corners: [V3; 3], other: [V3; 3], i: usize) -> Option<Self> {
        let (start, end) = (corners[i], corners[(i + 1) % 3]);
        let (v, e) = (sub(q, start), sub(end, start));
        let square = dot(e, e);
        let along = dot(v, e) / square;
        let offset = add_scaled(v, -along, e);
        let normal = scaled(add(unit_normal(corners)?, unit_normal(other)?), std::f64::consts::PI);
        // The third edge of a triangle that is no sliver may be 2 sqrt(3) times as long as the largest component of the
        // others, so its angles have sines of at least a sixth of the smallest sine.
        let reach = along.min(1.0 - along) * square.sqrt() * (MIN_SINE / 8.0);
        Some(Self { offset, normal, reach, magnitude: largest(&[v, e]) })
    }

    /// Returns whether the segment arrives from the front, or `None` if that is not proved.
    ///
    /// `lower_bound` is a lower bound on the distance of the query from the surface.
    fn is_from_front(&self, lower_bound: f64, clearance: f64) -> Option<bool> {
        let error = ROUNDING * self.magnitude;
        let distance = length(self.offset) + error;
        // Other parts of the surface that the segment crosses are within this of its end.
        let excess = distance - lower_bound + error;
        // The foot of a perpendicular on a triangle has a larger error than its distance.
        let is_simple = excess < clearance.min(self.reach * (0.5 * MIN_COSINE)) && self.reach > error * FOOT_ERROR;
        // No direction from the point along the surface has a larger cosine with the offset.
        let step = (2.0 * distance * excess).sqrt().min(self.reach);
        let cosine = step / (2.0 * distance) + excess / step;
        let product = dot(self.offset, self.normal);
        let least = distance * (8.0 * std::f64::consts::PI * cosine * 1.001 + NORMAL_ERROR) + 8.0 * error;
        (is_simple && product.abs() > least).then_some(product > 0.0)
    }
}

/// The bound on the error of the foot of a perpendicular, in units of the error of its distance: four over the smallest
/// sine.
const FOOT_ERROR: f64 = 4.0 / MIN_SINE;

/// Returns the height of corner `i` over the opposite edge, less its rounding error.
fn height(corners: [V3; 3], i: usize) -> f64 {
    let [e, f] = [1, 2].map(|k| sub(corners[(i + k) % 3], corners[i]));
    let (normal, opposite) = (cross(e, f), sub(f, e));
    (dot(normal, normal) / dot(opposite, opposite)).sqrt() * (1.0 - NORMAL_ERROR)
}
