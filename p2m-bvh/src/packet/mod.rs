//! Packets: up to sixteen primitives of one kind, filtered at once.
//!
//! A packet keeps the vertices of its primitives as whole numbers of 16 bits in a frame of its own, lane beside lane:
//! half the room of f32, and more precise, for the frame is as small as the packet. [`Packet::squares`] computes
//! squared distances to all of them in f32. They decide nothing but which primitives cannot be the answer: everything
//! within a proven band is evaluated by the kernel of the contract.
//!
//! # The band
//!
//! Lengths are in units of the frame, a power of two for which the box of the packet is less than 2^16 - 1 wide. Let q
//! be the query in that frame, X = 2^16 + max |q_k| (so that no component of a difference between q and a vertex
//! exceeds X), u = 2^-24. Then for every point, segment and triangle
//!
//! > d - 1 - 32 u X <= sqrt(square) <= d + 1 + 88 u X,
//!
//! where d is its distance, the true one as well as the one that the kernel of the contract computes; docs/proofs/filter.md
//! proves it. For other primitives, which are filtered by their boxes, the right inequality holds.
//!
//! Two things make the band independent of the shape of a triangle: edges and normals are made of differences of whole
//! numbers, which are exact, so the normal of a sliver is as good as any; and a face counts only where the foot is
//! inside by more than the test can err, so that what is found is the distance of a point of the triangle in any case.

mod line_filter;
mod squared_distance;

pub use line_filter::Line;
use nalgebra::Point3;
use p2m_core::engine::real::to_f64_array;
use p2m_core::engine::simd::{InstructionSet, Lanes, prefetch};
use p2m_core::engine::vector::V3 as Vertex;
use p2m_core::engine::vector::power_of_two;
use p2m_core::{Aabb, Collector, Primitive, PrimitiveId, Projection, Real};
use squared_distance::{V3, beyond, edge, triangle};

/// Lanes of a packet.
pub const LANES: usize = 16;

/// What the primitives of a packet are, by how many vertices span them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Kind {
    Point,
    Segment,
    Triangle,
    /// Anything else, by its box.
    Box,
}

impl Kind {
    /// That of a primitive.
    pub fn of<T: Real>(primitive: &impl Primitive<T>) -> Self {
        match primitive.vertices().len() {
            1 => Self::Point,
            2 => Self::Segment,
            3 => Self::Triangle,
            _ => Self::Box,
        }
    }
}

/// A primitive of a packet in f64: so packets and nodes are made by the same code for all sets.
#[derive(Clone, Copy, Debug)]
pub struct Member {
    pub kind: Kind,
    pub bounds: Aabb<f64>,
    vertices: [Vertex; 3],
}

impl Member {
    /// Of a primitive.
    pub fn of<T: Real>(primitive: &impl Primitive<T>) -> Self {
        let kind = Kind::of(primitive);
        let mut vertices = [[0.0; 3]; 3];
        if kind != Kind::Box {
            vertices.iter_mut().zip(primitive.vertices()).for_each(|(to, vertex)| *to = to_f64_array(vertex));
        }
        Self { kind, bounds: primitive.aabb().to_f64(), vertices }
    }

    /// Those that span it; none for a box.
    pub fn vertices(&self) -> &[Vertex] {
        let count = match self.kind {
            Kind::Point => 1,
            Kind::Segment => 2,
            Kind::Triangle => 3,
            Kind::Box => 0,
        };
        &self.vertices[..count]
    }
}

/// The members of a set by their ids.
pub type Members<'a> = &'a (dyn Fn(PrimitiveId) -> Member + Sync);

/// Up to sixteen primitives in a frame of their own.
///
/// Unused lanes repeat the first primitive, so they need no mask while computing.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C, align(64))]
pub struct Packet {
    /// Coordinate k of vertex v in row 3 v + k; boxes are two vertices.
    rows: [[u16; LANES]; 9],
    ids: [PrimitiveId; LANES],
    /// Vertex v of lane l among the exact vertices of the packet.
    corners: [[u8; LANES]; 3],
    /// Where these begin among those of the tree.
    pub first_vertex: u32,
    len: u8,
    /// A [`Kind`], as a number.
    kind: u8,
    unused: [u8; 2],
    origin: [f64; 3],
    /// The unit of the frame; its inverse; both 0 if the box of the packet does not fit a frame of f64.
    unit: f64,
    per_unit: f64,
}

const _: () = assert!(size_of::<Packet>() == 448);

/// The largest number of the rows.
const TOP: f64 = 65535.0;
/// Where a query stands in a frame: beyond this many units the filter lets everything pass.
const FARTHEST: f64 = power_of_two(40);
/// Frames with other units are not used: squares of lengths must stay in the plain range of keys.
const UNITS: std::ops::RangeInclusive<f64> = power_of_two(-360)..=power_of_two(300);

/// u of f32.
const U: f32 = f32::EPSILON / 2.0;
/// For bounds that are computed in f32 themselves, with some roundings.
pub const ROUND_UP: f32 = 1.0 + 16.0 * f32::EPSILON;

/// A query in the frame of a packet, with the band.
#[derive(Clone, Copy, Debug)]
pub struct Local {
    query: [f32; 3],
    /// The distances that the filter finds are at most this much too large,
    pub excess: f32,
    /// and at most this much too small.
    pub deficit: f32,
    /// The margin by which the foot on a face has to be inside, squared.
    margin_squared: f32,
}

impl Packet {
    /// What its primitives are.
    #[inline(always)]
    fn kind(&self) -> Kind {
        match self.kind {
            0 => Kind::Point,
            1 => Kind::Segment,
            2 => Kind::Triangle,
            _ => Kind::Box,
        }
    }

    /// Packs primitives of these ids, at most sixteen of one kind or all of them as boxes, with the box around all of them, and
    /// gives their exact vertices, each once. Units below `finest` are not needed.
    ///
    /// # Panics
    /// For more than sixteen ids, or none.
    pub fn new(
        ids: &[PrimitiveId],
        primitives: &[Member],
        kind: Kind,
        bounds: &Aabb<f64>,
        finest: f64,
    ) -> (Self, Vec<Vertex>) {
        let [min, max] = [to_f64_array(&bounds.min), to_f64_array(&bounds.max)];
        let size = (0..3).map(|k| max[k] - min[k]).fold(0.0, f64::max);
        let unit = frame_unit(size).max(finest);
        let unit = if UNITS.contains(&unit) { unit } else { 0.0 };
        let mut packet = Self {
            rows: [[0; LANES]; 9],
            origin: min,
            unit,
            per_unit: if unit > 0.0 { unit.recip() } else { 0.0 },
            ids: [ids[0]; LANES],
            corners: [[0; LANES]; 3],
            first_vertex: 0,
            len: u8::try_from(ids.len()).expect("at most sixteen"),
            kind: kind as u8,
            unused: [0; 2],
        };
        let mut exact = Vec::new();
        for lane in 0..LANES {
            let place = if lane < ids.len() { lane } else { 0 };
            let primitive = &primitives[place];
            packet.ids[lane] = ids[place];
            if kind == Kind::Box {
                packet.put(lane, 0, to_f64_array(&primitive.bounds.min), f64::floor);
                packet.put(lane, 1, to_f64_array(&primitive.bounds.max), f64::ceil);
            } else {
                for (v, vertex) in primitive.vertices().iter().enumerate() {
                    packet.put(lane, v, *vertex, f64::round);
                    packet.corners[v][lane] = place_of(&mut exact, *vertex);
                }
            }
        }
        (packet, exact)
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the range of u16")]
    fn put(&mut self, lane: usize, vertex: usize, position: [f64; 3], round: impl Fn(f64) -> f64) {
        for (k, x) in position.into_iter().enumerate() {
            let x = round((x - self.origin[k]) * self.per_unit);
            self.rows[3 * vertex + k][lane] = x.clamp(0.0, TOP) as u16;
        }
    }

    /// Offers the primitive in a lane to a collector, as the contract has it, unless its key certainly exceeds
    /// `square`. `vertices` are all the exact vertices of the tree. Does nothing for a box, of which only the set
    /// knows.
    #[inline(always)]
    pub fn offer<C: Collector>(&self, lane: usize, vertices: &[Vertex], query: Vertex, square: f64, collector: &mut C) {
        let id = self.ids[lane];
        let [a, b, c] = self.corners(lane).map(|place| &vertices[place]);
        // Each kind for itself: a projection that is kept in registers need not be copied.
        match self.kind() {
            Kind::Triangle => {
                if let Some(projection) = Projection::of_near_triangle(query, &[*a, *b, *c], square) {
                    collector.offer(id, projection);
                }
            }
            Kind::Segment => {
                if let Some(projection) = Projection::of_segment(query, &[*a, *b], square) {
                    collector.offer(id, projection);
                }
            }
            Kind::Point => {
                if let Some(projection) = Projection::of_point(query, &[*a], square) {
                    collector.offer(id, projection);
                }
            }
            Kind::Box => {}
        }
    }

    /// Where the exact vertices of the primitive in a lane are; unused corners are the first
    /// vertex of the packet.
    #[inline(always)]
    fn corners(&self, lane: usize) -> [usize; 3] {
        let [a, b, c] = &self.corners;
        [a[lane], b[lane], c[lane]].map(|place| self.first_vertex as usize + usize::from(place))
    }

    /// The corners of the triangle in a lane; `None` if the packet has no triangles.
    #[inline(always)]
    pub fn triangle_corners<'a>(&self, lane: usize, vertices: &'a [Vertex]) -> Option<[&'a Vertex; 3]> {
        if self.kind() != Kind::Triangle {
            return None;
        }
        Some(self.corners(lane).map(|place| &vertices[place]))
    }

    /// Where the vertices of the primitive in a lane are among the exact vertices of the tree, and how many there are.
    #[inline]
    pub fn vertices_of(&self, lane: usize) -> ([usize; 3], usize) {
        let count = match self.kind() {
            Kind::Box => 0,
            Kind::Point => 1,
            Kind::Segment => 2,
            Kind::Triangle => 3,
        };
        (self.corners(lane), count)
    }

    /// A box around the primitives in some lanes.
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
        // Vertices are rounded by half a unit.
        let at = |k: usize, x: u16, off: f64| self.origin[k] + (f64::from(x) + off) * self.unit;
        Aabb {
            min: Point3::from(std::array::from_fn(|k| at(k, low[k], -0.75))),
            max: Point3::from(std::array::from_fn(|k| at(k, high[k], 0.75))),
        }
    }

    /// Asks for what [`offer`](Self::offer) reads.
    #[inline(always)]
    pub fn prefetch_vertices(&self, lane: usize, vertices: &[Vertex]) {
        for place in self.corners(lane) {
            prefetch(vertices.as_ptr().wrapping_add(place).cast());
        }
    }

    /// Its primitives, lane by lane.
    #[inline(always)]
    pub fn ids(&self) -> &[PrimitiveId] {
        &self.ids[..usize::from(self.len)]
    }

    /// One bit for each lane in use.
    #[inline(always)]
    pub fn lanes(&self) -> u32 {
        (1 << self.len) - 1
    }

    /// Whether its primitives are what their vertices say, rather than boxes around something else: the squares then
    /// bound distances from above as well.
    #[inline(always)]
    pub fn has_vertices(&self) -> bool {
        self.kind() != Kind::Box
    }

    /// Whether its primitives are triangles.
    pub fn has_triangles(&self) -> bool {
        self.kind() == Kind::Triangle
    }

    /// The unit of its frame.
    #[inline(always)]
    pub fn unit(&self) -> f64 {
        self.unit
    }

    /// The inverse of the unit.
    #[inline(always)]
    pub fn per_unit(&self) -> f64 {
        self.per_unit
    }

    /// The query in the frame; `None` if the frame is not usable, or not for this query.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "rounding is part of the band")]
    pub fn local(&self, query: &[f64; 3]) -> Option<Local> {
        let q: [f64; 3] = std::array::from_fn(|k| (query[k] - self.origin[k]) * self.per_unit);
        let largest = q[0].abs().max(q[1].abs()).max(q[2].abs());
        // Not for NaN either, which comes of infinite differences.
        if !(self.unit > 0.0 && largest <= FARTHEST) {
            return None;
        }
        let ux = U * (largest as f32 + 65536.0) * ROUND_UP;
        Some(Local {
            query: q.map(|x| x as f32),
            excess: (1.0 + 88.0 * ux) * ROUND_UP,
            deficit: (1.0 + 32.0 * ux) * ROUND_UP,
            margin_squared: (32.0 * ux) * (32.0 * ux),
        })
    }

    /// Squared distances in the frame to the primitives in all lanes; for boxes, to the boxes. Where they certainly
    /// exceed `limit`, a distance in the frame, they may be infinite instead.
    #[inline(always)]
    pub fn squares<I: InstructionSet>(&self, local: &Local, limit: f32, squares: &mut [f32; LANES]) {
        let q = V3::splat(local.query);
        let towards = self.towards(&local.query);
        let mut at = 0;
        while at < LANES {
            let result = match self.kind() {
                Kind::Triangle => {
                    let vertices = [self.vertex(0, at), self.vertex(1, at), self.vertex(2, at)];
                    let offsets = [vertices[0].sub(&q), vertices[1].sub(&q), vertices[2].sub(&q)];
                    if beyond::<I::Wide>(&offsets, towards, limit) {
                        I::Wide::splat(f32::INFINITY)
                    } else {
                        triangle::<I::Wide>(offsets, vertices, local.margin_squared)
                    }
                }
                Kind::Segment => {
                    let (a, b) = (self.vertex(0, at), self.vertex(1, at));
                    edge(&a.sub(&q), &b.sub(&a)).0
                }
                Kind::Point => self.vertex(0, at).sub(&q).square(),
                Kind::Box => {
                    let (below, above) = (self.vertex(0, at).sub(&q), q.sub(&self.vertex(1, at)));
                    below.max(&above).max(&V3::splat([0.0; 3])).square()
                }
            };
            result.store(&mut squares[at..]);
            at += I::Wide::LEN;
        }
    }

    /// From a query in the frame to some vertex.
    #[inline(always)]
    fn towards(&self, [x, y, z]: &[f32; 3]) -> [f32; 3] {
        const SOME: usize = LANES / 2;
        [f32::from(self.rows[0][SOME]) - x, f32::from(self.rows[1][SOME]) - y, f32::from(self.rows[2][SOME]) - z]
    }

    /// Vertex v in the lanes from `at` on.
    #[inline(always)]
    fn vertex<L: Lanes>(&self, v: usize, at: usize) -> V3<L> {
        let [x, y, z] = [&self.rows[3 * v], &self.rows[3 * v + 1], &self.rows[3 * v + 2]];
        V3 { x: L::load_u16(&x[at..]), y: L::load_u16(&y[at..]), z: L::load_u16(&z[at..]) }
    }
}

/// One bit for each square that is at most `limit`.
#[inline(always)]
pub fn at_most<L: Lanes>(squares: &[f32; LANES], limit: f32) -> u32 {
    let mut mask = 0;
    let mut at = 0;
    while at < LANES {
        mask |= L::load(&squares[at..]).at_most(L::splat(limit)) << at;
        at += L::LEN;
    }
    mask
}

/// The smallest square.
#[inline(always)]
pub fn smallest<L: Lanes>(squares: &[f32; LANES]) -> f32 {
    let mut all = L::load(&squares[..]);
    let mut at = L::LEN;
    while at < LANES {
        all = all.min(L::load(&squares[at..]));
        at += L::LEN;
    }
    all.smallest()
}

/// The place of a vertex in a list of at most 48, at the end of which it is put if it is not there yet. The same vertex
/// is one with the same bits.
#[allow(clippy::cast_possible_truncation, reason = "at most 48")]
fn place_of(list: &mut Vec<Vertex>, vertex: Vertex) -> u8 {
    let bits = vertex.map(f64::to_bits);
    let place = list.iter().position(|v| v.map(f64::to_bits) == bits).unwrap_or(list.len());
    if place == list.len() {
        list.push(vertex);
    }
    place as u8
}

/// The smallest power of two of which `size` is at most 65534; 0 for 0.
pub fn frame_unit(size: f64) -> f64 {
    if size <= 0.0 {
        return 0.0;
    }
    if !size.is_finite() {
        return f64::INFINITY;
    }
    let mut e = p2m_core::engine::vector::exponent(size) - 16;
    while size * scale(-e) > TOP - 1.0 {
        e += 1;
    }
    scale(e)
}

/// 2^e, as far as f64 has it.
fn scale(e: i32) -> f64 {
    2f64.powi(e)
}

#[cfg(test)]
mod tests {
    use super::*;
    use p2m_core::engine::simd::{Isa, SimdKernel};
    use p2m_core::{Primitive, PrimitiveSet, Shape};
    use rand::{Rng, RngExt};

    struct Squares<'a>(&'a Packet, &'a Local, f32);

    impl SimdKernel for Squares<'_> {
        type Output = [f32; LANES];
        #[inline(always)]
        fn run<I: InstructionSet>(self) -> [f32; LANES] {
            let mut squares = [0.0; LANES];
            self.0.squares::<I>(self.1, self.2, &mut squares);
            squares
        }
    }

    fn point(rng: &mut impl Rng) -> [f64; 3] {
        [(); 3].map(|()| rng.random())
    }

    fn along(a: [f64; 3], b: [f64; 3], t: f64) -> [f64; 3] {
        [0, 1, 2].map(|k: usize| a[k] + t * (b[k] - a[k]))
    }

    /// Primitives of all shapes: a third of them large in the packet, slivers of every sine, collinear, repeated.
    fn shape(rng: &mut impl Rng, kind: Kind) -> Shape<f64> {
        let size = 2f64.powi(-(rng.random_range(0..18)));
        let corner = point(rng);
        let [a, b, mut c] = [(); 3].map(|()| along(corner, point(rng), size));
        match rng.random_range(0..6) {
            0 => c = along(a, b, rng.random::<f64>()),
            1 => c = along(along(a, b, 2.0 * rng.random::<f64>() - 0.5), c, 2f64.powi(-(rng.random_range(0..40)))),
            2 => c = a,
            _ => {}
        }
        let [a, b, c] = [a, b, c].map(Point3::from);
        match kind {
            Kind::Point => p2m_core::Point::new(a).into(),
            Kind::Segment => p2m_core::Segment::new(a, if rng.random_range(0..8) == 0 { a } else { b }).into(),
            _ => p2m_core::Triangle::new(a, b, c).into(),
        }
    }

    /// Near, on, between and far from the primitives of a packet.
    fn query<R: Rng>(rng: &mut R, shapes: &[Shape<f64>]) -> Point3<f64> {
        let on = |rng: &mut R| {
            let s = &shapes[rng.random_range(0..shapes.len())];
            let v: Vec<[f64; 3]> = s.vertices().iter().map(|v| v.coords.into()).collect();
            along(along(v[0], v[v.len() / 2], rng.random::<f64>()), v[v.len() - 1], rng.random::<f64>())
        };
        let target = on(rng);
        let away = 2f64.powi(rng.random_range(-40..30));
        let direction = point(rng).map(|x| 2.0 * x - 1.0);
        match rng.random_range(0..3) {
            0 => Point3::from(target),
            1 => Point3::from(along(target, on(rng), rng.random::<f64>())),
            _ => Point3::from([0, 1, 2].map(|k: usize| target[k] + away * direction[k])),
        }
    }

    #[test]
    fn squares_are_within_the_band_on_every_instruction_set() {
        let mut worst = [0.0f64; 2];
        let mut skipped = 0;
        let cases = p2m_testkit::cases(6000, 1000);
        for case in cases.clone() {
            let (round, mut rng) = (case as usize, p2m_testkit::rng("band", case));
            let kind = [Kind::Triangle, Kind::Triangle, Kind::Segment, Kind::Point][round % 4];
            let len = rng.random_range(1..=16);
            let scale = 2f64.powi([0, 0, 40, -300, 250][round % 5]);
            let shapes: Vec<Shape<f64>> = (0..len).map(|_| shape(&mut rng, kind)).collect();
            let queries: Vec<_> = (0..8).map(|_| query(&mut rng, &shapes) * scale).collect();
            let shapes: Vec<Shape<f64>> = shapes.iter().map(|s| scaled(s, scale)).collect();
            let ids: Vec<PrimitiveId> = (0..len).map(PrimitiveId::new).collect();
            let (packet, _) = Packet::new(&ids, &members(&shapes), kind, &shapes.aabb(), scale * 2f64.powi(-36));
            assert_eq!((packet.ids(), packet.lanes().count_ones() as usize), (ids.as_slice(), len));
            for q in queries {
                let Some(local) = packet.local(&q.coords.into()) else {
                    let far = (q - Point3::from(packet.origin)).amax() > FARTHEST * packet.unit();
                    assert!(far, "{q} {packet:?}: near queries have a place");
                    continue;
                };
                for isa in Isa::available() {
                    let squares = isa.run(Squares(&packet, &local, f32::INFINITY));
                    let limit = squares[rng.random_range(0..LANES)].sqrt() * rng.random::<f32>() * 2.0;
                    let limited = isa.run(Squares(&packet, &local, limit));
                    for (lane, shape) in shapes.iter().enumerate() {
                        let distance = shape.project(&q).key.distance() / packet.unit();
                        let off = f64::from(squares[lane]).sqrt() - distance;
                        let (excess, deficit) = (f64::from(local.excess), f64::from(local.deficit));
                        assert!(off <= excess && off >= -deficit, "{isa}: {off} of {distance}, {shape:?} {q}");
                        worst = [worst[0].max(off / excess), worst[1].max(-off / deficit)];
                        if limited[lane] != squares[lane] {
                            assert_eq!(limited[lane], f32::INFINITY);
                            assert!(distance + excess > f64::from(limit), "{isa}: {distance} is within {limit}");
                            skipped += 1;
                        }
                    }
                }
            }
        }
        println!("largest part of the band: {worst:?}");
        assert!(cases.have_more_than(10_000, skipped), "{skipped}");
        // The quantisation alone takes a good part of a unit.
        assert!(cases.is_replay() || worst[0] > 0.5 && worst[1] > 0.5, "{worst:?}");
    }

    fn members(primitives: &[impl Primitive<f64>]) -> Vec<Member> {
        primitives.iter().map(Member::of).collect()
    }

    fn scaled(shape: &Shape<f64>, factor: f64) -> Shape<f64> {
        let v: Vec<Point3<f64>> = shape.vertices().iter().map(|p| p * factor).collect();
        match *v.as_slice() {
            [a] => p2m_core::Point::new(a).into(),
            [a, b] => p2m_core::Segment::new(a, b).into(),
            [a, b, c] => p2m_core::Triangle::new(a, b, c).into(),
            _ => unreachable!("one to three vertices"),
        }
    }

    #[test]
    fn a_query_that_is_hardly_beside_a_vertex_keeps_its_packet() {
        // The way to the vertex in the middle lane is so short that its square underflows.
        let at = |x: f64, y: f64| {
            let [a, b, c] = [[x, y, y], [x + 900.0, y, y], [x + 900.0, y + 1.0, y]].map(Point3::from);
            Shape::from(p2m_core::Triangle::new(a, b, c))
        };
        let shapes: Vec<Shape<f64>> = (0..LANES)
            .map(|lane| if lane == LANES / 2 { at(0.0, 1000.0) } else { at(30_000.0 + lane as f64, 0.0) })
            .collect();
        let ids: Vec<PrimitiveId> = (0..LANES).map(PrimitiveId::new).collect();
        let bounds = shapes.aabb().union(&Aabb::of_points(&[Point3::origin(), Point3::from([40_000.0; 3])]));
        let (packet, _) = Packet::new(&ids, &members(&shapes), Kind::Triangle, &bounds, 0.0);
        for tiny in [1e-10, 1e-22, 1e-24, 1e-30, 1e-40, 0.0] {
            let local = packet.local(&[-tiny, 1000.0, 1000.0]).expect("near");
            for isa in Isa::available() {
                let squares = isa.run(Squares(&packet, &local, f32::MAX));
                assert!(squares.iter().all(|s| s.is_finite()), "{isa}, {tiny:e}: {squares:?}");
            }
        }
    }

    #[test]
    fn frames_hold_their_packet_with_at_most_a_bit_lost() {
        for size in [1.0, 65534.0, 65535.0, 0.1, 1e-100, 1e90] {
            let unit = frame_unit(size);
            assert!(size / unit <= 65534.0 && size / unit > 32766.0, "{size}");
            assert_eq!(unit.log2().fract(), 0.0);
        }
        assert_eq!((frame_unit(0.0), frame_unit(f64::INFINITY)), (0.0, f64::INFINITY));
    }

    #[test]
    fn packets_of_extreme_size_let_everything_pass() {
        let ids = [PrimitiveId::new(0)];
        for size in [1e-200, 1e200, f64::MAX] {
            let set = [p2m_core::Segment::new(Point3::from([-size; 3]), Point3::from([size; 3]))];
            let (packet, _) = Packet::new(&ids, &members(&set), Kind::Segment, &set.aabb(), 0.0);
            assert!(packet.local(&[0.0; 3]).is_none(), "{size}");
        }
    }
}
