//! The primitives of a packet as hulls, and the search for pairs between two packets.

use super::height::{extent, unit};
use super::place::NO_NODE;
use crate::kernel::arithmetic::cross;
use crate::kernel::vector::{V3, dot, power_of_two, sub};
use crate::pair::{Hull, Pairs, bounds_of, nearest_of_hulls};
use crate::{Aabb, PrimitiveId};

/// The margin below which products of two lengths of the scenes cannot overflow. A margin is 2^-44 of the sizes of the
/// scenes.
const MAX_MARGIN_OF_PRODUCTS: f64 = power_of_two(450);
/// The largest number of primitives of a packet.
pub const MAX_HULLS: usize = 16;

/// The primitives of a packet, as convex hulls of their vertices.
pub struct Hulls {
    /// The number of the loaded packet.
    pub(super) packet: u32,
    len: usize,
    hulls: [Hull; MAX_HULLS],
    boxes: [Aabb<f64>; MAX_HULLS],
    /// The box around all hulls.
    bounds: Aabb<f64>,
    /// The unit normals of triangles; zero for hulls without a normal.
    normals: [V3; MAX_HULLS],
    /// The extents of hulls along their normals, measured from their first vertices. They are not zero, since rounding
    /// turns the normal of a thin triangle by any angle.
    heights: [[f64; 2]; MAX_HULLS],
    ids: [PrimitiveId; MAX_HULLS],
}

impl Hulls {
    pub(super) fn new() -> Self {
        Self {
            packet: NO_NODE,
            len: 0,
            hulls: [Hull::new(&[]); MAX_HULLS],
            boxes: [Aabb::empty(); MAX_HULLS],
            bounds: Aabb::empty(),
            normals: [[0.0; 3]; MAX_HULLS],
            heights: [[0.0; 2]; MAX_HULLS],
            ids: [PrimitiveId::new(0); MAX_HULLS],
        }
    }

    /// Clears the hulls for a new packet.
    pub fn start(&mut self, packet: u32) {
        (self.packet, self.len, self.bounds) = (packet, 0, Aabb::empty());
    }

    /// Adds a primitive.
    pub fn push(&mut self, id: PrimitiveId, hull: Hull) {
        let i = self.len;
        (self.hulls[i], self.boxes[i], self.ids[i]) = (hull, bounds_of(hull.vertices()), id);
        self.bounds = self.bounds.union(&self.boxes[i]);
        self.normals[i] = match hull.vertices() {
            [a, b, c] => unit(cross(sub(*b, *a), sub(*c, *a))).unwrap_or_default(),
            _ => [0.0; 3],
        };
        self.heights[i] = self.extent(i, self.hulls[i].vertices());
        self.len += 1;
    }

    fn hull(&self, i: usize) -> &[V3] {
        self.hulls[i].vertices()
    }

    /// Returns the extent of several vertices along the normal of a hull, measured from the hull's first vertex.
    fn extent(&self, i: usize, vertices: &[V3]) -> [f64; 2] {
        let first = self.hull(i)[0];
        extent(vertices.iter().map(|vertex| dot(sub(*vertex, first), self.normals[i])))
    }

    /// Returns whether several vertices are farther from a hull than `reach` along the normal of the hull.
    fn is_beyond(&self, i: usize, vertices: &[V3], reach: f64) -> bool {
        let ([low, high], [start, end]) = (self.heights[i], self.extent(i, vertices));
        start - high > reach || low - end > reach
    }

    /// Returns one bit per hull, the first one lowest: whether its box is near another box.
    fn near(&self, bounds: &Aabb<f64>, prune: f64) -> u16 {
        (0..self.len).fold(0, |mask, i| mask | u16::from(self.boxes[i].gap_squared(bounds) <= prune) << i)
    }
}

/// Offers the pairs of the primitives of two packets.
///
/// The basic idea is to reject most of the up to 256 pairs before the kernel sees them. A pair is rejected by the gap
/// between the boxes, by the heights along `direction`, along the normals of both hulls, and along the line through
/// their first vertices. The pair with the nearest first vertices is offered first, so that its distance prunes the
/// others. Heights are compared only if they have a `margin`.
pub(super) fn search_packets(a: &Hulls, b: &Hulls, margin: Option<f64>, direction: Option<V3>, pairs: &mut Pairs<'_>) {
    let least_ids = || [a, b].map(|hulls| *hulls.ids[..hulls.len].iter().min().expect("a packet has primitives"));
    if pairs.is_settled(a.bounds.gap_squared(&b.bounds), least_ids) {
        return;
    }
    let prune = pairs.prune_above();
    let (near_a, near_b) = (a.near(&b.bounds, prune), b.near(&a.bounds, prune));
    let offer = |i: usize, j: usize, pairs: &mut Pairs<'_>| {
        let prune = pairs.prune_above();
        let ids = [a.ids[i], b.ids[j]];
        let gap = a.boxes[i].gap_squared(&b.boxes[j]);
        if gap > prune || pairs.is_settled(gap, || ids) {
            return;
        }
        if margin.is_some_and(|margin| is_apart([a, b], [i, j], direction, prune.sqrt(), margin)) {
            return;
        }
        pairs.offer_result(ids, nearest_of_hulls(a.hull(i), b.hull(j), pairs.kernel_limit()));
    };
    // Two vertices that are nearer than the best pair belong to a pair that is nearer. It is offered first, to exclude
    // other pairs.
    let first = if pairs.is_nearest() { nearest_vertices(a, b, [near_a, near_b], prune) } else { None };
    if let Some((i, j)) = first {
        offer(i, j, pairs);
    }
    for i in ones(near_a) {
        for j in ones(near_b) {
            if Some((i, j)) != first {
                offer(i, j, pairs);
            }
            if pairs.is_done() {
                return;
            }
        }
    }
}

/// Returns whether two hulls are farther apart than a limit and a margin along one of these directions: `direction`,
/// which points from the first to the second, the normal of a hull, or the line through their first vertices.
fn is_apart([a, b]: [&Hulls; 2], [i, j]: [usize; 2], direction: Option<V3>, limit: f64, margin: f64) -> bool {
    let (p, q) = (a.hull(i), b.hull(j));
    let reach = limit + margin;
    let gap = |direction: V3| {
        let [_, end] = extent(p.iter().map(|vertex| dot(sub(*vertex, p[0]), direction)));
        let [start, _] = extent(q.iter().map(|vertex| dot(sub(*vertex, p[0]), direction)));
        start - end
    };
    if direction.is_some_and(|direction| gap(direction) > reach) {
        return true;
    }
    if a.is_beyond(i, q, reach) || b.is_beyond(j, p, reach) {
        return true;
    }
    let line = sub(q[0], p[0]);
    margin < MAX_MARGIN_OF_PRODUCTS && gap(line) > reach * dot(line, line).sqrt()
}

/// Returns the positions of the set bits.
fn ones(mask: u16) -> impl Iterator<Item = usize> {
    (0..MAX_HULLS).filter(move |i| mask >> i & 1 == 1)
}

/// Returns the hulls of two masks whose first vertices are nearest, if they are nearer than `prune` allows.
fn nearest_vertices(a: &Hulls, b: &Hulls, masks: [u16; 2], prune: f64) -> Option<(usize, usize)> {
    let mut best = (prune, None);
    for i in ones(masks[0]) {
        for j in ones(masks[1]) {
            let offset = sub(b.hull(j)[0], a.hull(i)[0]);
            let square = dot(offset, offset);
            if square < best.0 {
                best = (square, Some((i, j)));
            }
        }
    }
    best.1
}
