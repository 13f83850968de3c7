//! The line filter of a packet: which of its primitives a line may hit.
//!
//! The basic idea is to look along the line. The origin of the line is moved to the projection of the packet's centre
//! onto it, so the filter does not depend on how far away the line begins. All vertices are then projected along the
//! line onto the two axes to which it is steepest, so that the line becomes the point 0. A triangle that the line hits
//! contains this point, within a margin of one or two units of the frame. The proof is in [docs/proofs/rays.md].
//! Primitives that pass the filter are tested exactly.
//!
//! [docs/proofs/rays.md]: https://github.com/p2m-rs/p2m/blob/main/docs/proofs/rays.md

use super::layout::{GRID_MAX, LANES, Packet};
use super::line::RayLine;
use super::member::Kind;
use p2m_core::engine::simd::{InstructionSet, Lanes, out_of_line};

/// A line in the frame of a packet, with an origin near the centre of the packet.
struct PacketLine {
    /// The two axes of the projection plane, and then the axis along which the line is projected.
    axes: [usize; 3],
    base: [f32; 3],
    /// The growth of the first two coordinates along the line, per unit of the third.
    slopes: [f32; 2],
    /// Whether the third coordinate decreases along the line.
    is_descending: bool,
    /// A bound on the error of a projected coordinate.
    margin: f32,
    /// A bound on the error of a projected coordinate plus the radius of the ray, for segments, points and boxes.
    wire_margin: f32,
    /// The least third coordinate of the searched piece of the line, relative to its base.
    low: f32,
    /// The largest third coordinate of the searched piece of the line, relative to its base.
    high: f32,
}

/// Half of the edge of the frame, in its units.
const CENTRE: f64 = (GRID_MAX + 1.0) / 2.0;
/// The distance from the centre, 2^18 units, beyond which a line hits nothing in the packet.
const MAX_CENTRE_OFFSET: f64 = 262_144.0;
/// The uncertainty of the position of a line, in units of the frame, from which on the filter is not used.
const MAX_POSITION_ERROR: f64 = 1024.0;

impl Packet {
    /// Returns one bit per lane: whether the line may hit its primitive.
    ///
    /// Only hits between the lengths `from` and `to` count, which are measured from the origin of the line in units of
    /// the scene. `is_inlined` is whether the caller contains the code of the filter.
    #[inline(always)]
    pub fn lanes_hit_by<I: InstructionSet>(&self, is_inlined: bool, line: &RayLine, from: f64, to: f64) -> u32 {
        match self.position_of(line, from, to) {
            LinePosition::Beside => 0,
            LinePosition::Unknown => self.lanes(),
            LinePosition::Near(local) if is_inlined => self.lanes_near::<I>(&local) & self.lanes(),
            LinePosition::Near(local) => out_of_line(|| self.lanes_near::<I>(&local)) & self.lanes(),
        }
    }

    /// Returns the position of a line relative to the packet.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "the margins allow for rounding")]
    fn position_of(&self, line: &RayLine, from: f64, to: f64) -> LinePosition {
        let d = &line.direction;
        let q: [f64; 3] = std::array::from_fn(|k| (line.origin[k] - self.origin[k]) * self.per_unit);
        let square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        let towards = d[0] * (CENTRE - q[0]) + d[1] * (CENTRE - q[1]) + d[2] * (CENTRE - q[2]);
        // Lengths along the axis equal lengths along the line, because the direction has the component 1 there.
        let ahead = towards / square;
        let base: [f64; 3] = std::array::from_fn(|k| q[k] + ahead * d[k]);
        let size = |x: &[f64; 3]| x[0].abs().max(x[1].abs()).max(x[2].abs());
        let error = (size(&q) + ahead.abs()) * (8.0 * f64::EPSILON) + line.origin_error * self.per_unit;
        // The radius does not apply to triangles.
        let radius = if self.kind() == Kind::Triangle { 0.0 } else { line.radius * self.per_unit };
        // The negated comparison is also true if the error is NaN, which infinite differences give.
        if !(self.unit > 0.0 && error < MAX_POSITION_ERROR && radius < MAX_POSITION_ERROR) {
            return LinePosition::Unknown;
        }
        if size(&base.map(|x| x - CENTRE)) > MAX_CENTRE_OFFSET {
            return LinePosition::Beside;
        }
        let axis = line.axis;
        let axes = [(axis + 1) % 3, (axis + 2) % 3, axis];
        let is_descending = d[axis] < 0.0;
        let sign = d[axis];
        let from_base = |length: f64| {
            let t = length * self.per_unit;
            (t - ahead, 1.0 + error + t.abs() * (8.0 * f64::EPSILON))
        };
        let ((low, low_error), (high, high_error)) = (from_base(from), from_base(to));
        let margin = 1.76 + 2.5 * error;
        LinePosition::Near(PacketLine {
            axes,
            base: axes.map(|k| base[k] as f32),
            slopes: [(d[axes[0]] * sign) as f32, (d[axes[1]] * sign) as f32],
            is_descending,
            margin: margin as f32,
            wire_margin: (margin + 1.75 * radius) as f32,
            // Infinite ends give NaN, for which `max` and `min` return the other operand: no limit.
            low: ((low - low_error).max(f64::NEG_INFINITY) as f32).next_down(),
            high: ((high + high_error).min(f64::INFINITY) as f32).next_up(),
        })
    }

    /// Returns one bit per lane: whether its projection reaches the origin.
    #[inline(always)]
    fn lanes_near<I: InstructionSet>(&self, line: &PacketLine) -> u32 {
        let mut lanes = 0;
        let mut at = 0;
        while at < LANES {
            // The arrays are written out, because closures are compiled without the instruction set.
            lanes |= match self.kind() {
                Kind::Triangle => triangle_lanes::<I::Wide>(
                    line,
                    &self.projected(line, 0, at),
                    &self.projected(line, 1, at),
                    &self.projected(line, 2, at),
                ),
                Kind::Segment => {
                    segment_lanes::<I::Wide>(line, &self.projected(line, 0, at), &self.projected(line, 1, at))
                }
                Kind::Point => {
                    let point = self.projected(line, 0, at);
                    segment_lanes::<I::Wide>(line, &point, &point)
                }
                Kind::Box => box_lanes::<I::Wide>(line, &self.offset(line, 0, at), &self.offset(line, 1, at)),
            } << at;
            at += I::Wide::LEN;
        }
        lanes
    }

    /// Returns vertex v of the lanes from `at` on, relative to the base of the line. The axis of the line comes last.
    #[inline(always)]
    fn offset<L: Lanes>(&self, line: &PacketLine, v: usize, at: usize) -> [L; 3] {
        [self.coordinate(line, v, 0, at), self.coordinate(line, v, 1, at), self.coordinate(line, v, 2, at)]
    }

    #[inline(always)]
    fn coordinate<L: Lanes>(&self, line: &PacketLine, v: usize, k: usize, at: usize) -> L {
        L::load_u16(&self.rows[3 * v + line.axes[k]][at..]).sub(L::splat(line.base[k]))
    }

    /// Returns vertex v of the lanes from `at` on, projected along the line. The last coordinate is the length along
    /// it.
    #[inline(always)]
    fn projected<L: Lanes>(&self, line: &PacketLine, v: usize, at: usize) -> [L; 3] {
        let [x, y, z] = self.offset::<L>(line, v, at);
        let (a, b) = (L::splat(-line.slopes[0]), L::splat(-line.slopes[1]));
        [z.mul_add(a, x), z.mul_add(b, y), if line.is_descending { L::splat(0.0).sub(z) } else { z }]
    }
}

/// The position of a line relative to a packet.
enum LinePosition {
    /// The line passes so far from the packet that it hits nothing there.
    Beside,
    /// The position cannot be computed in f64 with enough accuracy.
    Unknown,
    Near(PacketLine),
}

#[inline(always)]
fn abs<L: Lanes>(x: L) -> L {
    x.max(L::splat(0.0).sub(x))
}

/// Returns one bit per lane: whether its extent along the line overlaps the searched piece.
#[inline(always)]
fn in_searched_piece<L: Lanes>(line: &PacketLine, least: L, largest: L) -> u32 {
    // The second comparison is low <= largest, written as -largest <= -low.
    least.at_most(L::splat(line.high)) & L::splat(0.0).sub(largest).at_most(L::splat(-line.low))
}

/// Returns one bit per triangle: whether the origin is on one side of all its edges, within the margin.
#[inline(always)]
fn triangle_lanes<L: Lanes>(line: &PacketLine, a: &[L; 3], b: &[L; 3], c: &[L; 3]) -> u32 {
    let (left_of_ab, right_of_ab) = sides(line, a, b);
    let (left_of_bc, right_of_bc) = sides(line, b, c);
    let (left_of_ca, right_of_ca) = sides(line, c, a);
    let (least, largest) = (a[2].min(b[2]).min(c[2]), a[2].max(b[2]).max(c[2]));
    (left_of_ab & left_of_bc & left_of_ca | right_of_ab & right_of_bc & right_of_ca)
        & in_searched_piece(line, least, largest)
}

/// Returns two masks: the lanes with the origin to the left of an edge or on it, and the lanes with the origin to the
/// right or on it.
#[inline(always)]
fn sides<L: Lanes>(line: &PacketLine, a: &[L; 3], b: &[L; 3]) -> (u32, u32) {
    let area = doubled_area(a, b);
    let margin = area_margin(line.margin, a, b);
    (L::splat(0.0).sub(area).at_most(margin), area.at_most(margin))
}

/// Returns twice the signed area of the triangle between the origin and two points.
#[inline(always)]
fn doubled_area<L: Lanes>(a: &[L; 3], b: &[L; 3]) -> L {
    a[0].mul(b[1]).sub(a[1].mul(b[0]))
}

/// Returns a bound on the error of [`doubled_area`] if each coordinate errs by at most `margin`.
#[inline(always)]
fn area_margin<L: Lanes>(margin: f32, a: &[L; 3], b: &[L; 3]) -> L {
    let sum = abs(a[0]).add(abs(a[1])).add(abs(b[0])).add(abs(b[1]));
    L::splat(margin).mul_add(sum, L::splat(2.0 * margin * margin))
}

/// Returns one bit per segment: whether it comes near the origin.
#[inline(always)]
fn segment_lanes<L: Lanes>(line: &PacketLine, a: &[L; 3], b: &[L; 3]) -> u32 {
    // With a radius, the nearest point of a segment to the line may be farther along the line by that much.
    let margin = L::splat(line.wire_margin);
    let (least, largest) = (a[2].min(b[2]).sub(margin), a[2].max(b[2]).add(margin));
    let near = abs(doubled_area(a, b)).at_most(area_margin(line.wire_margin, a, b));
    near & spans_origin(line, a[0], b[0]) & spans_origin(line, a[1], b[1]) & in_searched_piece(line, least, largest)
}

/// Returns one bit per lane: whether 0 lies between two numbers, within the margin.
#[inline(always)]
fn spans_origin<L: Lanes>(line: &PacketLine, a: L, b: L) -> u32 {
    let margin = L::splat(line.wire_margin);
    a.min(b).at_most(margin) & L::splat(0.0).sub(a.max(b)).at_most(margin)
}

/// Returns one bit per box, given by two corners: whether its projection contains the origin.
#[inline(always)]
fn box_lanes<L: Lanes>(line: &PacketLine, min: &[L; 3], max: &[L; 3]) -> u32 {
    let (centre, extent) = centre_and_extent(min[2], max[2]);
    let along = if line.is_descending { L::splat(0.0).sub(centre) } else { centre };
    let extent_with_margin = extent.add(L::splat(line.wire_margin));
    let mut lanes = in_searched_piece(line, along.sub(extent_with_margin), along.add(extent_with_margin));
    for k in 0..2 {
        let slope = line.slopes[k];
        let (own_centre, own_extent) = centre_and_extent(min[k], max[k]);
        let limit = extent.mul_add(L::splat(slope.abs()), own_extent).add(L::splat(line.wire_margin));
        lanes &= abs(centre.mul_add(L::splat(-slope), own_centre)).at_most(limit);
    }
    lanes
}

/// Returns the middle between two numbers, and half of their difference.
#[inline(always)]
fn centre_and_extent<L: Lanes>(min: L, max: L) -> (L, L) {
    let half = L::splat(0.5);
    (min.add(max).mul(half), max.sub(min).mul(half))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::packet::Member;
    use nalgebra::{Point3, Vector3};
    use p2m_core::engine::simd::SimdKernel;
    use p2m_core::{Aabb, Crossing, Element, Isa, Primitive, PrimitiveId, PrimitiveSet, Ray, Shape, Soup};
    use p2m_testkit::vector;
    use rand::{Rng, RngExt};

    struct FilteredLanes<'a>(&'a Packet, &'a RayLine, [f64; 2]);

    impl SimdKernel for FilteredLanes<'_> {
        type Output = u32;
        #[inline(always)]
        fn run<I: InstructionSet>(self) -> u32 {
            let Self(packet, line, [from, to]) = self;
            packet.lanes_hit_by::<I>(true, line, from, to)
        }
    }

    /// A primitive without vertices, whose box a packet stores.
    struct WithoutVertices(Shape<f64>);

    impl Primitive<f64> for WithoutVertices {
        fn aabb(&self) -> Aabb<f64> {
            self.0.aabb()
        }
        fn project(&self, query: &Point3<f64>) -> p2m_core::Projection {
            self.0.project(query)
        }
        fn intersect_ray(&self, _: &p2m_core::Ray) -> Option<p2m_core::RayHit> {
            unreachable!("boxes are tested alone")
        }
    }

    /// Returns sixteen primitives of a kind, of random sizes and shapes, at a random position.
    fn set(rng: &mut impl Rng, kind: Kind) -> Soup<f64> {
        let centre = vector(rng) * 2f64.powi(rng.random_range(-20..40));
        let size = centre.norm() * 2f64.powi(-rng.random_range(0..30));
        let positions = (0..48).map(|i| {
            let spread = size * 2f64.powi(-(i / 3 % 8));
            Point3::from(centre + vector(rng) * size * f64::from(i % 2) + vector(rng) * spread)
        });
        let elements = (0..16u32).map(|i| match kind {
            Kind::Point => Element::Point(3 * i),
            Kind::Segment => Element::Segment([3 * i, 3 * i + 1]),
            _ => Element::Triangle([3 * i, 3 * i + 1, 3 * i + 2]),
        });
        Soup::new(positions.collect(), elements).expect("valid")
    }

    #[test]
    fn lanes_that_are_hit_always_pass_and_few_others_do() {
        let mut counts = [[0; 3]; 4];
        let cases = p2m_testkit::cases(6_000, 1_200);
        for case in cases.clone() {
            let mut rng = p2m_testkit::rng("lines and packets", case);
            let kind = [Kind::Triangle, Kind::Segment, Kind::Point, Kind::Box][case as usize % 4];
            let soup = set(&mut rng, kind);
            let ids: Vec<_> = (0..16).map(PrimitiveId::new).collect();
            let bounds = PrimitiveSet::aabb(&soup);
            let packet = if kind == Kind::Box {
                let all: Vec<_> =
                    ids.iter().map(|id| Member::from_primitive(&WithoutVertices(soup.get(*id)))).collect();
                Packet::new(&ids, &all, &bounds, 0.0, &mut Vec::new())
            } else {
                let all: Vec<_> = ids.iter().map(|id| Member::from_primitive(&soup.get(*id))).collect();
                Packet::new(&ids, &all, &bounds, 0.0, &mut Vec::new())
            };
            let size = (bounds.max - bounds.min).norm();
            for _ in 0..8 {
                // The ray aims at a point of a primitive (a corner, a point of an edge or an inner point) or beside it.
                let primitive = soup.get(PrimitiveId::new(rng.random_range(0..16)));
                let vertices = primitive.vertices();
                let mut weights = [0.0; 3].map(|_: f64| f64::from(rng.random_range(0..4u8)));
                weights[0] += 0.01;
                let sum: f64 = weights[..vertices.len()].iter().sum();
                let target: Vector3<f64> = vertices.iter().zip(weights).map(|(v, w)| v.coords * (w / sum)).sum();
                let offset = [0.0, 0.0, 1e-9, 1e-4, 1.0][rng.random_range(0..5)];
                let target = target + vector(&mut rng) * (size * offset);
                let mut direction = vector(&mut rng);
                if rng.random_bool(0.3) {
                    direction[rng.random_range(0..3)] = 0.0;
                }
                let distance = size * 2f64.powi(rng.random_range(-4..44)) * f64::from(rng.random_range(-1..2i8));
                let origin = Point3::from(target - direction * distance);
                let radius = [0.0, 1e-3, 0.1][rng.random_range(0..3)] * size;
                let ray = Ray::new(&origin, &direction).and_then(|ray| ray.line().with_radius(radius)).expect("valid");
                let range = rng.random_range(0.0..2.0) * distance;
                let ray = if rng.random() { ray.with_range(range, f64::INFINITY).expect("in order") } else { ray };
                let line = if distance > 1e6 * size {
                    RayLine::from_afar(&ray, radius, &nalgebra::center(&bounds.min, &bounds.max).into())
                } else {
                    RayLine::from_ray(&ray, radius)
                };
                let (from, to) = (line.length_below(ray.range()[0]), line.length_above(ray.range()[1]));
                let hit = |lane: &usize| {
                    Crossing::from_primitive(&soup.get(ids[*lane]), &ray, f64::INFINITY, false).is_some()
                };
                let hits = (0..16).filter(hit).fold(0, |lanes, lane| lanes | 1 << lane);
                for isa in Isa::available() {
                    let passed = isa.run(FilteredLanes(&packet, &line, [from, to]));
                    assert_eq!(passed & hits, hits, "{isa} {kind:?} case {case}: {ray:?}");
                    let count = &mut counts[kind as usize];
                    count[0] += 16;
                    count[1] += hits.count_ones();
                    count[2] += passed.count_ones();
                }
            }
        }
        for (kind, [all, hits, passed]) in ["points", "segments", "triangles", "boxes"].iter().zip(counts) {
            println!("{kind}: {passed} of {all} passed, {hits} are hit");
            let is_worth_it = hits * 50 > all && passed * 4 < all * if *kind == "boxes" { 4 } else { 3 };
            assert!(cases.is_replay() || is_worth_it, "{kind}");
        }
    }
}
