//! The memory layout of a packet: quantised vertices, ids, and references to the exact vertices.

use super::member::{Kind, Member};
use nalgebra::Point3;
use p2m_core::engine::real::to_f64_array;
use p2m_core::engine::simd::{InstructionSet, Isa, SimdKernel, prefetch};
use p2m_core::engine::vector::{V3, power_of_two};
use p2m_core::pair::project;
use p2m_core::storage::as_ids;
use p2m_core::{Aabb, Collector, PrimitiveId, Projection};

/// The number of lanes of a packet, which is the largest number of its primitives.
pub const LANES: usize = 16;

/// A packet: up to sixteen primitives in a frame of their own.
///
/// Unused lanes repeat the first primitive, so computations need no mask.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C, align(64))]
pub struct Packet {
    /// Coordinate k of vertex v is in row 3 v + k. A box is stored as two vertices, its lower and its upper corner.
    pub(super) rows: [[u16; LANES]; 9],
    /// The ids as plain numbers, which a file may set to any value.
    ids: [u32; LANES],
    /// `corners[v][lane]` is the index of vertex v of a lane among the exact vertices of the packet.
    corners: [[u8; LANES]; 3],
    /// The index of the first exact vertex of the packet among the exact vertices of the tree.
    pub(crate) vertex_offset: u32,
    len: u8,
    /// The [`Kind`] as a number.
    kind: u8,
    /// 1 if the next packet continues the run: it has further primitives with the same vertices and higher ids.
    is_continued: u8,
    unused: u8,
    /// The origin of the frame, in coordinates of the scene.
    pub(super) origin: [f64; 3],
    /// The unit of the frame, a power of two. It is 0 if no frame in f64 can hold the box of the packet.
    pub(super) unit: f64,
    /// The inverse of the unit; 0 if the unit is 0.
    pub(super) per_unit: f64,
}

const _: () = assert!(size_of::<Packet>() == 448);

/// The largest coordinate in the frame of a packet.
pub(super) const GRID_MAX: f64 = 65535.0;
/// The units that frames may have. With others, squares of lengths would leave the plain range of keys.
const USABLE_UNITS: std::ops::RangeInclusive<f64> = power_of_two(-360)..=power_of_two(300);

impl Packet {
    /// Returns the kind of all primitives of the packet.
    #[inline(always)]
    pub(super) fn kind(&self) -> Kind {
        match self.kind {
            0 => Kind::Point,
            1 => Kind::Segment,
            2 => Kind::Triangle,
            _ => Kind::Box,
        }
    }

    /// Packs at most sixteen primitives with these ids, and appends each distinct exact vertex once to `vertices`.
    ///
    /// If the primitives are of several kinds, the packet gets their boxes. `bounds` is the box around all of them. The
    /// unit of the frame is at least `finest`, because a finer one would bring nothing.
    ///
    /// # Panics
    /// Panics if there are no ids, or more than sixteen.
    pub fn new(
        ids: &[PrimitiveId],
        primitives: &[Member],
        bounds: &Aabb<f64>,
        finest: f64,
        vertices: &mut Vec<V3>,
    ) -> Self {
        let first = primitives[0].kind;
        let kind = if primitives.iter().all(|primitive| primitive.kind == first) { first } else { Kind::Box };
        let [min, max] = [to_f64_array(&bounds.min), to_f64_array(&bounds.max)];
        let size = (0..3).map(|k| max[k] - min[k]).fold(0.0, f64::max);
        let unit = frame_unit(size).max(finest);
        let unit = if USABLE_UNITS.contains(&unit) { unit } else { 0.0 };
        let mut packet = Self {
            rows: [[0; LANES]; 9],
            origin: min,
            unit,
            per_unit: if unit > 0.0 { unit.recip() } else { 0.0 },
            ids: [ids[0].number(); LANES],
            corners: [[0; LANES]; 3],
            vertex_offset: u32::try_from(vertices.len()).expect("a primitive has three vertices at most"),
            len: u8::try_from(ids.len()).expect("at most sixteen"),
            kind: kind as u8,
            is_continued: 0,
            unused: 0,
        };
        packet.ids.iter_mut().zip(ids).for_each(|(number, id)| *number = id.number());
        if kind == Kind::Box {
            for lane in 0..LANES {
                let bounds = &primitives[if lane < ids.len() { lane } else { 0 }].bounds;
                packet.quantize(lane, 0, to_f64_array(&bounds.min), f64::floor);
                packet.quantize(lane, 1, to_f64_array(&bounds.max), f64::ceil);
            }
        } else {
            Isa::best().run(PackVertices { packet: &mut packet, primitives, vertices });
        }
        packet
    }

    /// Stores a vertex in the rows, rounded to the grid of the frame by `round`.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the range of u16")]
    fn quantize(&mut self, lane: usize, vertex: usize, position: V3, round: impl Fn(f64) -> f64) {
        for (k, x) in position.into_iter().enumerate() {
            let x = round((x - self.origin[k]) * self.per_unit);
            self.rows[3 * vertex + k][lane] = x.clamp(0.0, GRID_MAX) as u16;
        }
    }

    /// Evaluates the primitive in a lane and offers it to a collector, unless its key certainly exceeds `square`.
    ///
    /// `vertices` are all exact vertices of the tree. The method does nothing for a box, because only the set can
    /// evaluate such a primitive.
    #[inline(always)]
    pub fn offer<C: Collector>(&self, lane: usize, vertices: &[V3], query: V3, square: f64, collector: &mut C) {
        let id = as_ids(&self.ids)[lane];
        let [a, b, c] = self.corners(lane).map(|index| &vertices[index]);
        // Each kind has a call of its own, so that the projection stays in registers and is not copied.
        match self.kind() {
            Kind::Triangle if collector.take_vertices(id, &[*a, *b, *c]) => {}
            Kind::Triangle => {
                if let Some(projection) = Projection::onto_near_triangle(query, &[*a, *b, *c], square) {
                    collector.offer(id, projection);
                }
            }
            Kind::Segment if collector.take_vertices(id, &[*a, *b]) => {}
            Kind::Segment => {
                if let Some(projection) = Projection::onto_segment(query, &[*a, *b], square) {
                    collector.offer(id, projection);
                }
            }
            Kind::Point if collector.take_vertices(id, &[*a]) => {}
            Kind::Point => {
                if let Some(projection) = Projection::onto_point(query, &[*a], square) {
                    collector.offer(id, projection);
                }
            }
            Kind::Box => {}
        }
    }

    /// Returns the indices of the vertices of a lane among the exact vertices of the tree. Unused corners refer to the
    /// first vertex of the packet.
    #[inline(always)]
    fn corners(&self, lane: usize) -> [usize; 3] {
        let [a, b, c] = &self.corners;
        let offset = self.vertex_offset as usize;
        [offset + usize::from(a[lane]), offset + usize::from(b[lane]), offset + usize::from(c[lane])]
    }

    /// Returns the corners of the triangle in a lane, or `None` if the packet has no triangles.
    #[inline(always)]
    pub fn triangle_corners<'a>(&self, lane: usize, vertices: &'a [V3]) -> Option<[&'a V3; 3]> {
        if self.kind() != Kind::Triangle {
            return None;
        }
        Some(self.corners(lane).map(|index| &vertices[index]))
    }

    /// Returns the indices of the vertices of a lane among the exact vertices of the tree, and the number of used ones.
    #[inline]
    pub fn vertices_of(&self, lane: usize) -> ([usize; 3], usize) {
        (self.corners(lane), self.kind().vertex_count())
    }

    /// Returns a box around the primitives in the lanes whose bits are set in `lanes`.
    pub fn bounds_of(&self, lanes: u16) -> Aabb<f64> {
        let count = if self.kind() == Kind::Box { 2 } else { self.vertices_of(0).1 };
        let (mut low, mut high) = ([u16::MAX; 3], [0; 3]);
        let mut rest = lanes;
        while rest != 0 {
            let lane = rest.trailing_zeros() as usize;
            rest &= rest - 1;
            for v in 0..count {
                for k in 0..3 {
                    let x = self.rows[3 * v + k][lane];
                    (low[k], high[k]) = (low[k].min(x), high[k].max(x));
                }
            }
        }
        // Vertices were rounded by at most half a unit.
        let scene = |k: usize, x: u16, margin: f64| self.origin[k] + (f64::from(x) + margin) * self.unit;
        Aabb {
            min: Point3::from(std::array::from_fn(|k| scene(k, low[k], -0.75))),
            max: Point3::from(std::array::from_fn(|k| scene(k, high[k], 0.75))),
        }
    }

    /// Prefetches the vertices that [`offer`](Self::offer) reads for a lane.
    #[inline(always)]
    pub fn prefetch_vertices(&self, lane: usize, vertices: &[V3]) {
        for index in self.corners(lane) {
            prefetch(vertices.as_ptr().wrapping_add(index).cast());
        }
    }

    /// Returns the ids of the primitives, lane by lane.
    #[inline(always)]
    pub fn ids(&self) -> &[PrimitiveId] {
        &as_ids(&self.ids)[..usize::from(self.len)]
    }

    /// Returns whether the next packet continues the run: it has further primitives with the same vertices and higher
    /// ids. No node refers to that packet, because a search for the nearest primitive needs only the first packet of a
    /// run.
    #[inline(always)]
    pub fn is_continued(&self) -> bool {
        self.is_continued != 0
    }

    /// Sets whether the next packet [continues](Self::is_continued) the primitives of this one.
    #[must_use]
    pub(crate) fn with_continuation(self, is_continued: bool) -> Self {
        Self { is_continued: u8::from(is_continued), ..self }
    }

    /// Returns whether the key of the primitive in a lane may be at most `square`. It is always `true` for a box.
    pub(crate) fn is_lane_within(&self, lane: usize, vertices: &[V3], query: V3, square: f64) -> bool {
        let (corners, count) = self.vertices_of(lane);
        let corners = &corners[..count];
        let hull: [V3; 3] = std::array::from_fn(|i| corners.get(i).map_or([0.0; 3], |&index| vertices[index]));
        count == 0 || project(query, &hull[..count], square).is_some_and(|found| found.key.square_above() <= square)
    }

    /// Returns one bit per used lane.
    #[inline(always)]
    pub fn lanes(&self) -> u32 {
        (1 << self.len) - 1
    }

    /// Returns whether the vertices span the primitives. If so, the filter bounds distances from above as well. If not,
    /// the packet has only boxes around the primitives.
    #[inline(always)]
    pub fn has_vertices(&self) -> bool {
        self.kind() != Kind::Box
    }

    /// Returns whether the fields of a packet from a file are within their ranges, if its exact vertices have the
    /// indices from `first` to `end`. The ids are not checked.
    pub(crate) fn has_valid_fields(&self, first: u32, end: u32) -> bool {
        let has_frame = USABLE_UNITS.contains(&self.unit) && self.per_unit.to_bits() == self.unit.recip().to_bits();
        let has_no_frame = self.unit == 0.0 && self.per_unit == 0.0;
        let vertices = self.vertices_of(0).1;
        let count = end.saturating_sub(first);
        self.len >= 1
            && usize::from(self.len) <= LANES
            && self.kind <= Kind::Box as u8
            && (has_frame || has_no_frame)
            && self.origin.iter().all(|x| x.is_finite())
            && self.vertex_offset == first
            && self.is_continued <= u8::from(self.kind != Kind::Box as u8)
            && self.unused == 0
            && (vertices == 0 || u32::from(largest(&self.corners[..vertices])) < count)
            && largest(&self.corners[vertices..]) == 0
    }

    /// Returns whether the primitives are triangles.
    pub(crate) fn has_triangles(&self) -> bool {
        self.kind() == Kind::Triangle
    }

    /// Returns the unit of the frame of the packet, in units of the scene.
    #[inline(always)]
    pub fn unit(&self) -> f64 {
        self.unit
    }

    /// Returns the inverse of the unit of the frame.
    #[inline(always)]
    pub fn per_unit(&self) -> f64 {
        self.per_unit
    }
}

/// Returns the largest number in several rows, or 0 if there are none. No early exit, so that it is vectorised.
fn largest(rows: &[[u8; LANES]]) -> u8 {
    rows.iter().flatten().fold(0, |largest, number| largest.max(*number))
}

/// A SIMD kernel that stores the vertices of primitives of one kind in a packet. It uses the instruction set only
/// through the compiler.
struct PackVertices<'a> {
    packet: &'a mut Packet,
    primitives: &'a [Member],
    vertices: &'a mut Vec<V3>,
}

impl SimdKernel for PackVertices<'_> {
    type Output = ();

    #[inline(always)]
    fn run<I: InstructionSet>(self) {
        let Self { packet, primitives, vertices } = self;
        let count = primitives[0].vertices().len();
        let (origin, per_unit) = (packet.origin, packet.per_unit);
        for v in 0..count {
            for (k, origin) in origin.into_iter().enumerate() {
                // Unused lanes repeat the first primitive.
                let mut row = [primitives[0].vertices()[v][k]; LANES];
                for (x, primitive) in row.iter_mut().zip(primitives) {
                    *x = primitive.vertices()[v][k];
                }
                let rounded = &mut packet.rows[3 * v + k];
                for lane in 0..LANES {
                    rounded[lane] = round_to_grid((row[lane] - origin) * per_unit);
                }
            }
        }
        let mut exact = ExactVertices::new(vertices);
        for v in 0..count {
            for (lane, primitive) in primitives.iter().enumerate() {
                packet.corners[v][lane] = exact.find_or_push(&primitive.vertices()[v]);
            }
            let first = packet.corners[v][0];
            packet.corners[v][primitives.len()..].fill(first);
        }
    }
}

/// The most vertices of a packet.
const MAX_VERTICES: usize = 3 * LANES;

/// The exact vertices of one packet, at the end of a vertex list.
struct ExactVertices<'a> {
    list: &'a mut Vec<V3>,
    /// The index of the first vertex of the packet.
    first: usize,
    /// A hash of each vertex. Different vertices may have equal ones.
    keys: [u32; MAX_VERTICES],
}

impl<'a> ExactVertices<'a> {
    #[inline(always)]
    fn new(list: &'a mut Vec<V3>) -> Self {
        Self { first: list.len(), list, keys: [0; MAX_VERTICES] }
    }

    /// Returns the index of a vertex, and appends the vertex if it is new. Two vertices are the same if they have the
    /// same bits.
    #[inline(always)]
    #[allow(
        clippy::cast_possible_truncation,
        reason = "the key is a part of the bits, and there are at most 48 vertices"
    )]
    fn find_or_push(&mut self, vertex: &V3) -> u8 {
        let [x, y, z] = vertex.map(f64::to_bits);
        let mixed = x ^ y.rotate_left(21) ^ z.rotate_left(43);
        let key = (mixed >> 32) as u32 ^ mixed as u32;
        // All keys are compared, in lanes.
        let mut found = u32::MAX;
        for (i, other) in self.keys.iter().enumerate() {
            found = found.min(if *other == key { i as u32 } else { u32::MAX });
        }
        let (found, count) = (found as usize, self.list.len() - self.first);
        // Equal vertices have equal keys.
        if found < count {
            let known = &self.list[self.first..];
            let is_same = |other: &V3| other.map(f64::to_bits) == [x, y, z];
            if is_same(&known[found]) {
                return found as u8;
            }
            if let Some(index) = known.iter().position(is_same) {
                return index as u8;
            }
        }
        self.keys[count] = key;
        self.list.push(*vertex);
        count as u8
    }
}

/// Rounds a number to the nearest integer of the grid, ties to even.
#[inline(always)]
#[allow(clippy::cast_possible_truncation, reason = "the lowest bits are the integer")]
fn round_to_grid(x: f64) -> u16 {
    // At this magnitude the unit in the last place is 1. The library function would be a call on processors without a
    // rounding instruction.
    const SHIFT: f64 = power_of_two(52);
    // A frame without a unit may give NaN, which becomes 0.
    let x = if x > 0.0 { x } else { 0.0 };
    let x = if x < GRID_MAX { x } else { GRID_MAX };
    (x + SHIFT).to_bits() as u16
}

/// Returns the smallest power of two such that `size` is at most 65534 times as large, or 0 for a size of 0.
pub fn frame_unit(size: f64) -> f64 {
    if size <= 0.0 {
        return 0.0;
    }
    if !size.is_finite() {
        return f64::INFINITY;
    }
    let mut e = p2m_core::engine::vector::exponent(size) - 16;
    while size * scale(-e) > GRID_MAX - 1.0 {
        e += 1;
    }
    scale(e)
}

/// Returns 2^e, or 0 or infinity beyond the range of f64.
fn scale(e: i32) -> f64 {
    // The library function is slow, and almost all exponents are in the range of the fast one.
    if (-1022..=1023).contains(&e) { power_of_two(e) } else { 2f64.powi(e) }
}
