//! Which primitives of a packet a line may meet.
//!
//! The line is taken to the foot of the centre of the packet, so it does not matter how far away it begins, and
//! everything is projected along it to the two axes that it is steepest to. There a triangle that it meets has the
//! origin inside, within a margin of one or two units of the frame; docs/proofs/rays.md has the proof. What is left is tested
//! exactly.

use super::{Kind, LANES, Packet, TOP};
use p2m_core::Ray;
use p2m_core::engine::ray::{TINY, foot};
use p2m_core::engine::simd::{InstructionSet, Lanes};
use p2m_core::engine::vector::power_of_two;

/// A line in f64, of which the largest component of the direction is 1 or -1.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    /// The origin of the ray, or a point of its line near the scene.
    pub origin: [f64; 3],
    pub direction: [f64; 3],
    /// The axis of that component.
    pub axis: usize,
    /// What the direction of the ray was divided by.
    pub speed: f64,
    /// How far the origin lies ahead of that of the ray.
    pub ahead: f64,
    /// How near it has to come to segments and points, in units of the scene.
    pub radius: f64,
    /// What the origin may be off, in units of the scene.
    pub off: f64,
}

/// What lengths along a line may be off, in parts of what they are computed from: 2^-50.
const LENGTH_ROUNDING: f64 = power_of_two(-50);

impl Line {
    /// The line of a ray, which has to come within `radius` of segments and points.
    #[inline(always)]
    pub fn of(ray: &Ray, radius: f64) -> Self {
        let d = ray.direction;
        let axis = if d[0].abs() >= d[1].abs() && d[0].abs() >= d[2].abs() {
            0
        } else if d[1].abs() >= d[2].abs() {
            1
        } else {
            2
        };
        let speed = d[axis].abs();
        let direction = [d[0] / speed, d[1] / speed, d[2] / speed];
        Self { origin: ray.origin, direction, axis, speed, ahead: 0.0, radius, off: 0.0 }
    }

    /// The same from the foot of a point, which is rounded once: for rays that come from so far away that f64 would
    /// lose the scene on the way.
    #[cold]
    #[inline(never)]
    pub fn from_afar(ray: &Ray, radius: f64, point: &[f64; 3]) -> Self {
        let line = Self::of(ray, radius);
        let (origin, ahead) = foot(ray, point, line.axis);
        let off = origin.iter().fold(0.0, |a: f64, x| a.max(x.abs())) * LENGTH_ROUNDING + TINY;
        Self { origin, ahead, off, ..line }
    }

    /// The length from the origin at which a parameter of the ray lies, rounded down.
    #[inline(always)]
    pub fn from(&self, parameter: f64) -> f64 {
        let (length, error) = self.length(parameter);
        // NaN comes of infinite parameters, and of lengths that overflow.
        if length - error > f64::MIN { length - error } else { f64::NEG_INFINITY }
    }

    /// The same, rounded up.
    #[inline(always)]
    pub fn to(&self, parameter: f64) -> f64 {
        let (length, error) = self.length(parameter);
        if length + error < f64::MAX { length + error } else { f64::INFINITY }
    }

    #[inline(always)]
    fn length(&self, parameter: f64) -> (f64, f64) {
        let length = parameter * self.speed;
        (length - self.ahead, (length.abs() + self.ahead.abs()) * LENGTH_ROUNDING + self.speed * TINY + self.off)
    }
}

/// The same in the frame of a packet, from near its centre.
struct Local {
    /// The axes to which is projected, and the one along which is.
    axes: [usize; 3],
    base: [f32; 3],
    /// Of the first two axes, per unit of the third.
    slopes: [f32; 2],
    /// Whether it runs down the third axis.
    down: bool,
    /// What a projected coordinate may be off.
    margin: f32,
    /// The same with the radius.
    wire_margin: f32,
    /// The piece of the line that matters, along the third axis.
    low: f32,
    high: f32,
}

/// Half of the edge of the frame.
const CENTRE: f64 = (TOP + 1.0) / 2.0;
/// A line that passes the centre at more than this many units meets nothing: 2^18.
const BESIDE: f64 = 262_144.0;
/// Nor is its place needed to less than this many units.
const COARSE: f64 = 1024.0;

impl Packet {
    /// One bit for each lane that a line may meet between `from` and `to`, which are lengths along its axis from its
    /// origin, in units of the scene.
    #[inline(always)]
    pub fn met_by<I: InstructionSet>(&self, line: &Line, from: f64, to: f64) -> u32 {
        match self.line(line, from, to) {
            Placed::Beside => 0,
            Placed::Unknown => self.lanes(),
            Placed::Near(local) => self.near::<I>(&local) & self.lanes(),
        }
    }

    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "margins have room for rounding")]
    fn line(&self, line: &Line, from: f64, to: f64) -> Placed {
        let d = &line.direction;
        let q: [f64; 3] = std::array::from_fn(|k| (line.origin[k] - self.origin[k]) * self.per_unit);
        let square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        let towards = d[0] * (CENTRE - q[0]) + d[1] * (CENTRE - q[1]) + d[2] * (CENTRE - q[2]);
        // Lengths along the axis are those along the line, as the direction has 1 there.
        let ahead = towards / square;
        let base: [f64; 3] = std::array::from_fn(|k| q[k] + ahead * d[k]);
        let size = |x: &[f64; 3]| x[0].abs().max(x[1].abs()).max(x[2].abs());
        let error = (size(&q) + ahead.abs()) * (8.0 * f64::EPSILON) + line.off * self.per_unit;
        // It does not matter to triangles.
        let radius = if self.kind() == Kind::Triangle { 0.0 } else { line.radius * self.per_unit };
        // Not for NaN either, which comes of infinite differences.
        if !(self.unit > 0.0 && error < COARSE && radius < COARSE) {
            return Placed::Unknown;
        }
        if size(&base.map(|x| x - CENTRE)) > BESIDE {
            return Placed::Beside;
        }
        let axis = line.axis;
        let axes = [(axis + 1) % 3, (axis + 2) % 3, axis];
        let down = d[axis] < 0.0;
        let sign = d[axis];
        let piece = |length: f64| {
            let t = length * self.per_unit;
            (t - ahead, 1.0 + error + t.abs() * (8.0 * f64::EPSILON))
        };
        let ((low, low_error), (high, high_error)) = (piece(from), piece(to));
        let margin = 1.76 + 2.5 * error;
        Placed::Near(Local {
            axes,
            base: axes.map(|k| base[k] as f32),
            slopes: [(d[axes[0]] * sign) as f32, (d[axes[1]] * sign) as f32],
            down,
            margin: margin as f32,
            wire_margin: (margin + 1.75 * radius) as f32,
            // NaN comes of infinite ends, and says nothing.
            low: ((low - low_error).max(f64::NEG_INFINITY) as f32).next_down(),
            high: ((high + high_error).min(f64::INFINITY) as f32).next_up(),
        })
    }

    /// The lanes near a line.
    #[inline(always)]
    fn near<I: InstructionSet>(&self, line: &Local) -> u32 {
        let mut lanes = 0;
        let mut at = 0;
        while at < LANES {
            // Arrays are spelled out: closures are compiled without the instruction set.
            lanes |= match self.kind() {
                Kind::Triangle => triangles::<I::Wide>(
                    line,
                    &self.projected(line, 0, at),
                    &self.projected(line, 1, at),
                    &self.projected(line, 2, at),
                ),
                Kind::Segment => wires::<I::Wide>(line, &self.projected(line, 0, at), &self.projected(line, 1, at)),
                Kind::Point => {
                    let place = self.projected(line, 0, at);
                    wires::<I::Wide>(line, &place, &place)
                }
                Kind::Box => boxes::<I::Wide>(line, &self.offset(line, 0, at), &self.offset(line, 1, at)),
            } << at;
            at += I::Wide::LEN;
        }
        lanes
    }

    /// Vertex v in the lanes from `at` on, as seen from the base of the line; the axis of the line comes last.
    #[inline(always)]
    fn offset<L: Lanes>(&self, line: &Local, v: usize, at: usize) -> [L; 3] {
        [self.coordinate(line, v, 0, at), self.coordinate(line, v, 1, at), self.coordinate(line, v, 2, at)]
    }

    #[inline(always)]
    fn coordinate<L: Lanes>(&self, line: &Local, v: usize, k: usize, at: usize) -> L {
        L::load_u16(&self.rows[3 * v + line.axes[k]][at..]).sub(L::splat(line.base[k]))
    }

    /// The same, projected along the line, and how far along it.
    #[inline(always)]
    fn projected<L: Lanes>(&self, line: &Local, v: usize, at: usize) -> [L; 3] {
        let [x, y, z] = self.offset::<L>(line, v, at);
        let (a, b) = (L::splat(-line.slopes[0]), L::splat(-line.slopes[1]));
        [z.mul_add(a, x), z.mul_add(b, y), if line.down { L::splat(0.0).sub(z) } else { z }]
    }
}

/// Where a line is with respect to a packet.
enum Placed {
    /// So far that it meets nothing.
    Beside,
    /// f64 cannot tell.
    Unknown,
    Near(Local),
}

#[inline(always)]
fn size<L: Lanes>(x: L) -> L {
    x.max(L::splat(0.0).sub(x))
}

/// The lanes whose extent along the line has something in common with the piece that matters. Those that end before it
/// begins are left out: low <= largest is -largest <= -low.
#[inline(always)]
fn in_piece<L: Lanes>(line: &Local, least: L, largest: L) -> u32 {
    least.at_most(L::splat(line.high)) & L::splat(0.0).sub(largest).at_most(L::splat(-line.low))
}

/// The lanes that have the origin on one side of all edges, within the margin.
#[inline(always)]
fn triangles<L: Lanes>(line: &Local, a: &[L; 3], b: &[L; 3], c: &[L; 3]) -> u32 {
    let (left, right) = sides(line, a, b);
    let (left_too, right_too) = sides(line, b, c);
    let (left_three, right_three) = sides(line, c, a);
    let (least, largest) = (a[2].min(b[2]).min(c[2]), a[2].max(b[2]).max(c[2]));
    (left & left_too & left_three | right & right_too & right_three) & in_piece(line, least, largest)
}

/// The lanes that have the origin to the left of an edge or on it, and those that have it to the right or on it.
#[inline(always)]
fn sides<L: Lanes>(line: &Local, a: &[L; 3], b: &[L; 3]) -> (u32, u32) {
    let area = doubled_area(a, b);
    let margin = margin(line.margin, a, b);
    (L::splat(0.0).sub(area).at_most(margin), area.at_most(margin))
}

/// Of the triangle that the origin and two points make.
#[inline(always)]
fn doubled_area<L: Lanes>(a: &[L; 3], b: &[L; 3]) -> L {
    a[0].mul(b[1]).sub(a[1].mul(b[0]))
}

/// By how much that may be off, if coordinates are by `margin`.
#[inline(always)]
fn margin<L: Lanes>(margin: f32, a: &[L; 3], b: &[L; 3]) -> L {
    let sum = size(a[0]).add(size(a[1])).add(size(b[0])).add(size(b[1]));
    L::splat(margin).mul_add(sum, L::splat(2.0 * margin * margin))
}

/// The lanes of segments that come near the origin.
#[inline(always)]
fn wires<L: Lanes>(line: &Local, a: &[L; 3], b: &[L; 3]) -> u32 {
    // Where a line with a radius is nearest is as far off along it.
    let off = L::splat(line.wire_margin);
    let (least, largest) = (a[2].min(b[2]).sub(off), a[2].max(b[2]).add(off));
    let near = size(doubled_area(a, b)).at_most(margin(line.wire_margin, a, b));
    near & reaches(line, a[0], b[0]) & reaches(line, a[1], b[1]) & in_piece(line, least, largest)
}

/// The lanes in which the origin lies between two numbers, within the margin.
#[inline(always)]
fn reaches<L: Lanes>(line: &Local, a: L, b: L) -> u32 {
    let margin = L::splat(line.wire_margin);
    a.min(b).at_most(margin) & L::splat(0.0).sub(a.max(b)).at_most(margin)
}

/// The lanes of boxes, given by two corners, whose projections reach the origin.
#[inline(always)]
fn boxes<L: Lanes>(line: &Local, min: &[L; 3], max: &[L; 3]) -> u32 {
    let (centre, extent) = middle(min[2], max[2]);
    let along = if line.down { L::splat(0.0).sub(centre) } else { centre };
    let extent_too = extent.add(L::splat(line.wire_margin));
    let mut lanes = in_piece(line, along.sub(extent_too), along.add(extent_too));
    for k in 0..2 {
        let slope = line.slopes[k];
        let (own_centre, own_extent) = middle(min[k], max[k]);
        let reach = extent.mul_add(L::splat(slope.abs()), own_extent).add(L::splat(line.wire_margin));
        lanes &= size(centre.mul_add(L::splat(-slope), own_centre)).at_most(reach);
    }
    lanes
}

/// The middle between two numbers, and how far they are from it.
#[inline(always)]
fn middle<L: Lanes>(min: L, max: L) -> (L, L) {
    let half = L::splat(0.5);
    (min.add(max).mul(half), max.sub(min).mul(half))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::packet::Member;
    use nalgebra::{Point3, Vector3};
    use p2m_core::engine::simd::SimdKernel;
    use p2m_core::{Aabb, Crossing, Element, Isa, Primitive, PrimitiveId, PrimitiveSet, Shape, Soup};
    use p2m_testkit::vector;
    use rand::{Rng, RngExt};

    struct Met<'a>(&'a Packet, &'a Line, [f64; 2]);

    impl SimdKernel for Met<'_> {
        type Output = u32;
        #[inline(always)]
        fn run<I: InstructionSet>(self) -> u32 {
            let Self(packet, line, [from, to]) = self;
            packet.met_by::<I>(line, from, to)
        }
    }

    /// A ball, which a packet knows by its box.
    struct Anything(Shape<f64>);

    impl Primitive<f64> for Anything {
        fn aabb(&self) -> Aabb<f64> {
            self.0.aabb()
        }
        fn project(&self, query: &Point3<f64>) -> p2m_core::Projection {
            self.0.project(query)
        }
    }

    /// Sixteen primitives of a kind, of all sizes and shapes, somewhere.
    fn set(rng: &mut impl Rng, kind: Kind) -> Soup<f64> {
        let place = vector(rng) * 2f64.powi(rng.random_range(-20..40));
        let size = place.norm() * 2f64.powi(-rng.random_range(0..30));
        let positions = (0..48).map(|i| {
            let own = size * 2f64.powi(-(i / 3 % 8));
            Point3::from(place + vector(rng) * size * f64::from(i % 2) + vector(rng) * own)
        });
        let elements = (0..16u32).map(|i| match kind {
            Kind::Point => Element::Point(3 * i),
            Kind::Segment => Element::Segment([3 * i, 3 * i + 1]),
            _ => Element::Triangle([3 * i, 3 * i + 1, 3 * i + 2]),
        });
        Soup::new(positions.collect(), elements).expect("valid")
    }

    #[test]
    fn lanes_that_are_met_are_never_left_out_and_few_others_pass() {
        let mut counts = [[0; 3]; 4];
        let cases = p2m_testkit::cases(6_000, 1_200);
        for case in cases.clone() {
            let mut rng = p2m_testkit::rng("lines and packets", case);
            let kind = [Kind::Triangle, Kind::Segment, Kind::Point, Kind::Box][case as usize % 4];
            let soup = set(&mut rng, kind);
            let ids: Vec<_> = (0..16).map(PrimitiveId::new).collect();
            let bounds = PrimitiveSet::aabb(&soup);
            let packet = if kind == Kind::Box {
                let all: Vec<_> = ids.iter().map(|id| Member::of(&Anything(soup.get(*id)))).collect();
                Packet::new(&ids, &all, kind, &bounds, 0.0).0
            } else {
                let all: Vec<_> = ids.iter().map(|id| Member::of(&soup.get(*id))).collect();
                Packet::new(&ids, &all, kind, &bounds, 0.0).0
            };
            let size = (bounds.max - bounds.min).norm();
            for _ in 0..8 {
                // At a point of a primitive: a corner, one of an edge, one inside, or beside it.
                let primitive = soup.get(PrimitiveId::new(rng.random_range(0..16)));
                let vertices = primitive.vertices();
                let mut weights = [0.0; 3].map(|_: f64| f64::from(rng.random_range(0..4u8)));
                weights[0] += 0.01;
                let sum: f64 = weights[..vertices.len()].iter().sum();
                let target: Vector3<f64> = vertices.iter().zip(weights).map(|(v, w)| v.coords * (w / sum)).sum();
                let beside = [0.0, 0.0, 1e-9, 1e-4, 1.0][rng.random_range(0..5)];
                let target = target + vector(&mut rng) * (size * beside);
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
                    Line::from_afar(&ray, radius, &nalgebra::center(&bounds.min, &bounds.max).into())
                } else {
                    Line::of(&ray, radius)
                };
                let (from, to) = (line.from(ray.range()[0]), line.to(ray.range()[1]));
                let hit = |lane: &usize| Crossing::of(&soup.get(ids[*lane]), &ray, f64::INFINITY, false).is_some();
                let hits = (0..16).filter(hit).fold(0, |lanes, lane| lanes | 1 << lane);
                for isa in Isa::available() {
                    let met = isa.run(Met(&packet, &line, [from, to]));
                    assert_eq!(met & hits, hits, "{isa} {kind:?} case {case}: {ray:?}");
                    let count = &mut counts[kind as usize];
                    count[0] += 16;
                    count[1] += hits.count_ones();
                    count[2] += met.count_ones();
                }
            }
        }
        for (kind, [all, hits, passed]) in ["points", "segments", "triangles", "boxes"].iter().zip(counts) {
            println!("{kind}: {passed} of {all} passed, {hits} are met");
            let is_worth_it = hits * 50 > all && passed * 4 < all * if *kind == "boxes" { 4 } else { 3 };
            assert!(cases.is_replay() || is_worth_it, "{kind}");
        }
    }
}
