//! The distance filter of a packet: lower and upper bounds on the distances between a query point and sixteen
//! primitives.
//!
//! The basic idea is to compute sixteen approximate squared distances side by side in f32, together with a bound on
//! their error, the band. Primitives whose distance minus the error exceeds the limit of a search are excluded. The
//! smallest distance plus the error is an upper bound on the nearest one, and becomes the new limit. The kernel then
//! evaluates only the few primitives that pass, exactly.
//!
//! # The band
//!
//! Lengths are in units of the frame, a power of two for which the box of the packet is less than 2^16 - 1 wide. Let q
//! be the query point in that frame, X = 2^16 + max |q_k| (so that no component of a difference between q and a vertex
//! exceeds X), and u = 2^-24. Then for every point, segment and triangle
//!
//! > d - 1 - 32 u X <= sqrt(square) <= d + 1 + 88 u X,
//!
//! where d is either the true distance or the distance that the kernel of the contract computes. The proof is in
//! [docs/proofs/filter.md]. Other primitives are filtered by their boxes, for which the right inequality holds.
//!
//! Two properties make the band independent of the shape of a triangle. Edges and normals are computed from differences
//! of whole numbers, which are exact, so the normal of a sliver is as good as any. A face counts only if the projection
//! of the query point is inside by more than the error of the test, so the filter always finds the distance of some
//! point of the triangle.
//!
//! [docs/proofs/filter.md]: https://github.com/p2m-rs/p2m/blob/main/docs/proofs/filter.md

use super::layout::{LANES, Packet};
use super::member::Kind;
use super::squared_distance::{Triangles, V3, lanes_before_plane, square_from_edge};
use p2m_core::engine::simd::{Doubles, Float, InstructionSet, Lanes};
use p2m_core::engine::vector::power_of_two;

/// The distance from a query point, in units of the frame, above which the filter lets every primitive pass.
const MAX_QUERY_UNITS: f64 = power_of_two(40);
/// The squared length of the shortest normal for which a plane is placed. Shorter normals exclude little, and their
/// squares may underflow.
const SHORTEST_NORMAL: f32 = 1.0;
/// The unit roundoff u of f32.
const U: f32 = f32::EPSILON / 2.0;
/// A factor that rounds up bounds that are computed in f32 with a few roundings.
pub const ROUND_UP: f32 = 1.0 + 16.0 * f32::EPSILON;

/// A query point in the frame of a packet, with the width of the band.
#[derive(Clone, Copy, Debug)]
pub struct Local {
    query: [f32; 3],
    /// The most by which distances of the filter are too large, in units of the frame.
    pub excess: f32,
    /// The most by which distances of the filter are too small, in units of the frame.
    pub deficit: f32,
    /// The square of the margin by which a projection has to be inside of a face.
    margin_squared: f32,
}

impl Packet {
    /// Returns the query point in the frame of the packet. It is `None` if the frame is not usable, or the point is too
    /// far away.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "rounding is part of the band")]
    pub fn local(&self, query: &[f64; 3]) -> Option<Local> {
        let q: [f64; 3] = std::array::from_fn(|k| (query[k] - self.origin[k]) * self.per_unit);
        let largest = q[0].abs().max(q[1].abs()).max(q[2].abs());
        // The negated comparison is also true if `largest` is NaN, which infinite differences give.
        if !(self.unit > 0.0 && largest <= MAX_QUERY_UNITS) {
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

    /// Computes the squared distances, in the frame, to the primitives or boxes in all lanes. If a square certainly
    /// exceeds the square of `limit`, a distance in the frame, it may be infinite instead.
    #[inline(always)]
    pub fn squares<I: InstructionSet>(&self, local: &Local, limit: f32, squares: &mut [f32; LANES]) {
        let mut at = 0;
        while at < LANES {
            let found = if self.is_beyond::<I::Wide>(at, &local.query, limit) {
                I::Wide::splat(f32::INFINITY)
            } else {
                self.prepare(at).squares(&V3::splat(local.query), local.margin_squared)
            };
            found.store(&mut squares[at..]);
            at += I::Wide::LEN;
        }
    }

    /// Computes the squared distances from several query points, which are at the given places of `locals`. Values that
    /// depend on the packet alone are computed once. Squares of lanes whose bit in `near` is 0 may be infinite instead.
    #[inline(always)]
    pub fn squares_of_several<I: InstructionSet>(
        &self,
        locals: &Locals,
        places: &[u8],
        near: &[u32; PLACES],
        squares: &mut [[f32; LANES]; PLACES],
    ) {
        let mut at = 0;
        while at < LANES {
            let lanes = ((1 << I::Wide::LEN) - 1) << at;
            // Places whose whole packet is excluded are not among `places`.
            if I::Wide::LEN >= LANES || places.iter().any(|&place| near[usize::from(place) % PLACES] & lanes != 0) {
                let primitives: Primitives<I::Wide> = self.prepare(at);
                for place in places.iter().map(|&place| usize::from(place) % PLACES) {
                    let query = [0, 1, 2].map(|k: usize| locals.query[k][place]);
                    primitives
                        .squares(&V3::splat(query), locals.margin_squared[place])
                        .store(&mut squares[place][at..]);
                }
            } else {
                for place in places.iter().map(|&place| usize::from(place) % PLACES) {
                    I::Wide::splat(f32::INFINITY).store(&mut squares[place][at..]);
                }
            }
            at += I::Wide::LEN;
        }
    }

    /// Computes the squared distances from at most [`PLACES`] points, point by point. `locals` receives the points.
    #[inline(always)]
    pub fn squares_at_points<I: InstructionSet>(
        &self,
        points: &[[f64; 3]],
        locals: &mut Locals,
        squares: &mut [[f32; LANES]; PLACES],
    ) {
        const ALL_PLACES: [u8; PLACES] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];
        for (place, point) in points.iter().enumerate() {
            locals.set(place, point, self);
        }
        locals.convert::<I>();
        self.squares_of_several::<I>(locals, &ALL_PLACES[..points.len()], &[u32::MAX; PLACES], squares);
    }

    /// Returns one bit per lane for each vertex: whether this vertex may be the nearest point of its triangle or
    /// segment for every query point in a cube, given by its centre and half of its side. A bit may be wrong because
    /// the packet rounds its vertices.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "rounding is allowed for")]
    pub fn lanes_of_nearest_vertices<I: InstructionSet>(&self, centre: &[f64; 3], half: f64) -> [u32; 3] {
        let others: &[(usize, usize)] = match self.kind() {
            Kind::Triangle => &[(0, 1), (1, 2), (2, 0)],
            Kind::Segment => &[(0, 1)],
            Kind::Point | Kind::Box => return [u32::MAX; 3],
        };
        let query = [0, 1, 2].map(|k: usize| ((centre[k] - self.origin[k]) * self.per_unit) as f32);
        let half = (half * self.per_unit) as f32;
        // Coordinates are below 2^16, and rounded by at most half a unit.
        let reach = query[0].abs() + query[1].abs() + query[2].abs() + 3.0 * 65536.0;
        let tolerance = 2.5 * reach + 6.0 * half;
        let mut all = [u32::MAX; 3];
        let mut at = 0;
        while at < LANES {
            for &(i, j) in others {
                let vertex: V3<I::Wide> = self.vertex(i, at);
                let edge = self.vertex(j, at).sub(&vertex);
                // The largest values in the cube of (q - v) . (w - v), and of the same product with v and w exchanged.
                let middle = V3::splat(query).sub(&vertex).dot(&edge);
                let from = I::Wide::splat(0.0);
                let size =
                    edge.x.max(from.sub(edge.x)).add(edge.y.max(from.sub(edge.y))).add(edge.z.max(from.sub(edge.z)));
                let margin = size.mul(I::Wide::splat(half)).sub(I::Wide::splat(tolerance));
                let above = !(((1 << I::Wide::LEN) - 1) << at);
                all[i] &= middle.add(margin).at_most(from) << at | above;
                all[j] &= edge.square().sub(middle).add(margin).at_most(from) << at | above;
            }
            at += I::Wide::LEN;
        }
        all
    }

    /// Returns one bit per lane: whether its triangle may be in front of the plane of a place, which
    /// [`Locals::place_planes`] sets. For other primitives all bits are 1.
    #[inline(always)]
    pub fn lanes_before_plane<L: Lanes>(&self, locals: &Locals, place: usize) -> u32 {
        if self.kind() != Kind::Triangle {
            return u32::MAX;
        }
        let [query, normal] = [&locals.query, &locals.normal].map(|rows| [0, 1, 2].map(|k: usize| rows[k][place]));
        let mut mask = 0;
        let mut at = 0;
        while at < LANES {
            let vertices: [V3<L>; 3] = [self.vertex(0, at), self.vertex(1, at), self.vertex(2, at)];
            mask |= lanes_before_plane(&vertices, &V3::splat(query), normal, locals.offset[place]) << at;
            at += L::LEN;
        }
        mask
    }

    /// Returns whether the triangles in the lanes from `at` on are certainly farther from a query point than `limit`.
    /// It is false for other primitives.
    #[inline(always)]
    fn is_beyond<L: Lanes>(&self, at: usize, query: &[f32; 3], limit: f32) -> bool {
        self.kind() == Kind::Triangle && {
            let vertices: [V3<L>; 3] = [self.vertex(0, at), self.vertex(1, at), self.vertex(2, at)];
            let normal @ [x, y, z] = self.normal_of_plane(query);
            let square = x * x + y * y + z * z;
            let offset = if square < SHORTEST_NORMAL { f32::INFINITY } else { square.sqrt() * limit };
            lanes_before_plane(&vertices, &V3::splat(*query), normal, offset) == 0
        }
    }

    /// Decodes the primitives of the lanes from `at` on.
    #[inline(always)]
    fn prepare<L: Lanes>(&self, at: usize) -> Primitives<L> {
        match self.kind() {
            Kind::Triangle => {
                Primitives::Triangles(Triangles::new([self.vertex(0, at), self.vertex(1, at), self.vertex(2, at)]))
            }
            Kind::Segment => {
                let a: V3<L> = self.vertex(0, at);
                let vector = self.vertex(1, at).sub(&a);
                Primitives::Segments(a, vector, vector.square().reciprocal())
            }
            Kind::Point => Primitives::Points(self.vertex(0, at)),
            Kind::Box => Primitives::Boxes(self.vertex(0, at), self.vertex(1, at)),
        }
    }

    /// Returns the vector from the query point to one of the packet's vertices, both in the frame.
    #[inline(always)]
    fn normal_of_plane(&self, [x, y, z]: &[f32; 3]) -> [f32; 3] {
        let [a, b, c] = self.sample();
        [a - x, b - y, c - z]
    }

    /// Returns one of the packet's vertices, in the frame.
    #[inline(always)]
    fn sample(&self) -> [f32; 3] {
        const SAMPLE_LANE: usize = LANES / 2;
        [0, 1, 2].map(|k: usize| f32::from(self.rows[k][SAMPLE_LANE]))
    }

    /// Returns vertex v of the lanes from `at` on.
    #[inline(always)]
    fn vertex<L: Lanes>(&self, v: usize, at: usize) -> V3<L> {
        let [x, y, z] = [&self.rows[3 * v], &self.rows[3 * v + 1], &self.rows[3 * v + 2]];
        V3 { x: L::load_u16(&x[at..]), y: L::load_u16(&y[at..]), z: L::load_u16(&z[at..]) }
    }
}

/// Decoded vertices, edges and normals of a group of lanes, shared by all query points.
#[allow(clippy::large_enum_variant, reason = "it stays in registers and on the stack")]
enum Primitives<L> {
    Triangles(Triangles<L>),
    /// The first ends, the vectors to the other ends, and the inverse squares of these vectors.
    Segments(V3<L>, V3<L>, L),
    Points(V3<L>),
    /// The lower and the upper corners.
    Boxes(V3<L>, V3<L>),
}

impl<L: Lanes> Primitives<L> {
    /// Returns the squared distances from a query point.
    #[inline(always)]
    fn squares(&self, query: &V3<L>, margin_squared: f32) -> L {
        match self {
            Self::Triangles(triangles) => triangles.squares(query, margin_squared),
            Self::Segments(a, vector, inverse_square) => square_from_edge(&a.sub(query), vector, *inverse_square),
            Self::Points(point) => point.sub(query).square(),
            Self::Boxes(low, high) => {
                let (below, above) = (low.sub(query), query.sub(high));
                below.max(&above).max(&V3::splat([0.0; 3])).square()
            }
        }
    }
}

/// The number of query points in [`Locals`].
pub const PLACES: usize = 16;

/// Query points paired with packets, one pair in each place, stored as rows.
#[derive(Clone, Debug, Default)]
pub struct Locals {
    /// The query points, in scene coordinates.
    pub position: [[f64; PLACES]; 3],
    origin: [[f64; PLACES]; 3],
    /// The units of the frames of the packets.
    pub unit: [f64; PLACES],
    /// The inverses of the units.
    pub per_unit: [f64; PLACES],
    /// The query points in the frames of the packets.
    query: [[f32; PLACES]; 3],
    /// The excess of each place, as in [`Local`].
    pub excess: [f32; PLACES],
    /// The deficit of each place, as in [`Local`].
    pub deficit: [f32; PLACES],
    /// The squared margin of each place, as in [`Local`].
    margin_squared: [f32; PLACES],
    /// The normals of planes between the query points and the packets. Before the planes are placed, these are a vertex
    /// of each packet in its frame.
    normal: [[f32; PLACES]; 3],
    /// The offsets of the planes. An offset is the dot product of the normal with the vector from the query point to a
    /// point of the plane.
    offset: [f32; PLACES],
    /// One bit per place: whether its query point is too far away for the frame, in which case [`Packet::local`]
    /// returns `None`.
    pub far: u32,
}

impl Locals {
    /// Sets the query point and the packet in a place.
    #[inline(always)]
    pub fn set(&mut self, place: usize, position: &[f64; 3], packet: &Packet) {
        for (k, (position, origin)) in position.iter().zip(&packet.origin).enumerate() {
            (self.position[k][place], self.origin[k][place]) = (*position, *origin);
        }
        (self.unit[place], self.per_unit[place]) = (packet.unit, packet.per_unit);
    }

    /// Sets the packet that the plane of a place faces.
    #[inline(always)]
    pub fn set_plane(&mut self, place: usize, packet: &Packet) {
        for (row, coordinate) in self.normal.iter_mut().zip(packet.sample()) {
            row[place] = coordinate;
        }
    }

    /// Places a plane in front of each query point, at the distance `limits` in the frame of its packet, facing a
    /// vertex of the packet.
    #[inline(always)]
    pub fn place_planes<I: InstructionSet>(&mut self, limits: &[f32; PLACES]) {
        let mut at = 0;
        while at < PLACES {
            let mut square = I::Wide::splat(0.0);
            for k in 0..3 {
                let normal = I::Wide::load(&self.normal[k][at..]).sub(I::Wide::load(&self.query[k][at..]));
                normal.store(&mut self.normal[k][at..]);
                square = normal.mul_add(normal, square);
            }
            let offset = square.sqrt().mul(I::Wide::load(&limits[at..]));
            let everywhere = I::Wide::splat(f32::INFINITY);
            square.if_below(I::Wide::splat(SHORTEST_NORMAL), everywhere, offset).store(&mut self.offset[at..]);
            at += I::Wide::LEN;
        }
    }

    /// Converts all query points to the frames of their packets, as [`Packet::local`] does.
    #[inline(always)]
    pub fn convert<I: InstructionSet>(&mut self) {
        self.far = 0;
        let mut largest_in_f32 = [0.0; PLACES];
        let mut at = 0;
        while at < PLACES {
            let per_unit = I::Doubles::load(&self.per_unit[at..]);
            let mut largest = I::Doubles::splat(0.0);
            for k in 0..3 {
                let offset = I::Doubles::load(&self.position[k][at..]) - I::Doubles::load(&self.origin[k][at..]);
                let q = offset * per_unit;
                q.store_f32(&mut self.query[k][at..]);
                // NaN arises only if an infinite difference is multiplied by an inverse of 0, and then the unit is 0 as
                // well.
                largest = q.abs().max(largest);
            }
            largest.store_f32(&mut largest_in_f32[at..]);
            let is_near = largest.is_at_most(I::Doubles::splat(MAX_QUERY_UNITS))
                & I::Doubles::splat(0.0).is_below(I::Doubles::load(&self.unit[at..]));
            self.far |= u32::from(!I::Doubles::bits(is_near)) << at;
            at += 8;
        }
        let mut at = 0;
        while at < PLACES {
            let (one, up) = (I::Wide::splat(1.0), I::Wide::splat(ROUND_UP));
            let largest = I::Wide::load(&largest_in_f32[at..]);
            let ux = largest.add(I::Wide::splat(65536.0)).mul(I::Wide::splat(U)).mul(up);
            ux.mul(I::Wide::splat(88.0)).add(one).mul(up).store(&mut self.excess[at..]);
            ux.mul(I::Wide::splat(32.0)).add(one).mul(up).store(&mut self.deficit[at..]);
            let margin = ux.mul(I::Wide::splat(32.0));
            margin.mul(margin).store(&mut self.margin_squared[at..]);
            at += I::Wide::LEN;
        }
    }
}

/// Returns one bit per square: whether it is at most `limit`.
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

/// Returns the smallest of sixteen squares.
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

#[cfg(test)]
mod tests {
    use super::super::layout::frame_unit;
    use super::super::member::Member;
    use super::*;
    use nalgebra::Point3;
    use p2m_core::engine::simd::{Isa, SimdKernel};
    use p2m_core::{Aabb, Primitive, PrimitiveId, PrimitiveSet, Shape};
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

    /// Returns a primitive of a random shape. A third are large in the packet, and slivers of every sine and collinear
    /// and repeated vertices are common.
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

    /// Returns a query point near, on, between or far from the primitives of a packet.
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
            let packet = Packet::new(&ids, &members(&shapes), &shapes.aabb(), scale * 2f64.powi(-36), &mut Vec::new());
            assert_eq!((packet.ids(), packet.lanes().count_ones() as usize), (ids.as_slice(), len));
            for q in queries {
                let Some(local) = packet.local(&q.coords.into()) else {
                    let far = (q - Point3::from(packet.origin)).amax() > MAX_QUERY_UNITS * packet.unit();
                    assert!(far, "{q} {packet:?}: near queries are in the frame");
                    continue;
                };
                for isa in Isa::available() {
                    let squares = isa.run(Squares(&packet, &local, f32::INFINITY));
                    let limit = squares[rng.random_range(0..LANES)].sqrt() * rng.random::<f32>() * 2.0;
                    let limited = isa.run(Squares(&packet, &local, limit));
                    for (lane, shape) in shapes.iter().enumerate() {
                        let distance = shape.project(&q).key.distance() / packet.unit();
                        let error = f64::from(squares[lane]).sqrt() - distance;
                        let (excess, deficit) = (f64::from(local.excess), f64::from(local.deficit));
                        assert!(error <= excess && error >= -deficit, "{isa}: {error} of {distance}, {shape:?} {q}");
                        worst = [worst[0].max(error / excess), worst[1].max(-error / deficit)];
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
        // Quantisation alone moves a vertex by up to half a unit along each axis, so a good part of the band is used.
        assert!(cases.is_replay() || worst[0] > 0.5 && worst[1] > 0.5, "{worst:?}");
    }

    fn members(primitives: &[impl Primitive<f64>]) -> Vec<Member> {
        primitives.iter().map(Member::from_primitive).collect()
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
    fn a_query_very_close_to_a_vertex_does_not_exclude_its_packet() {
        // The offset of the vertex in the middle lane is so short that its square underflows.
        let at = |x: f64, y: f64| {
            let [a, b, c] = [[x, y, y], [x + 900.0, y, y], [x + 900.0, y + 1.0, y]].map(Point3::from);
            Shape::from(p2m_core::Triangle::new(a, b, c))
        };
        let shapes: Vec<Shape<f64>> = (0..LANES)
            .map(|lane| if lane == LANES / 2 { at(0.0, 1000.0) } else { at(30_000.0 + lane as f64, 0.0) })
            .collect();
        let ids: Vec<PrimitiveId> = (0..LANES).map(PrimitiveId::new).collect();
        let bounds = shapes.aabb().union(&Aabb::from_points(&[Point3::origin(), Point3::from([40_000.0; 3])]));
        let packet = Packet::new(&ids, &members(&shapes), &bounds, 0.0, &mut Vec::new());
        for tiny in [1e-10, 1e-22, 1e-24, 1e-30, 1e-40, 0.0] {
            let local = packet.local(&[-tiny, 1000.0, 1000.0]).expect("near");
            for isa in Isa::available() {
                let squares = isa.run(Squares(&packet, &local, f32::MAX));
                assert!(squares.iter().all(|s| s.is_finite()), "{isa}, {tiny:e}: {squares:?}");
            }
        }
    }

    #[test]
    fn frames_contain_their_packet_and_waste_at_most_one_bit() {
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
            let packet = Packet::new(&ids, &members(&set), &set.aabb(), 0.0, &mut Vec::new());
            assert!(packet.local(&[0.0; 3]).is_none(), "{size}");
        }
    }
}
