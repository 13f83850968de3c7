//! Nodes of eight children, in f32 in a frame of the scene; and those that bound their children by boxes.

use crate::packet::Member;
use crate::traverse::ray::FrameLine;
use crate::traverse::ray_slab::{Piece, SlabRay};
use crate::tree::volume::{Rounded, WideNode};
use nalgebra::Point3;
use p2m_core::Aabb;
use p2m_core::engine::simd::Lanes;
use p2m_core::engine::vector::{exponent, power_of_two};

/// Children of a node.
pub const WIDTH: usize = 8;

/// A node or a packet, by its number; `NONE` for neither.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NodeRef(pub u32);

const PACKET_BIT: u32 = 1 << 31;

impl NodeRef {
    pub const NONE: Self = Self(u32::MAX);

    pub fn node(number: usize) -> Self {
        Self(u32::try_from(number).expect("fewer nodes than primitives"))
    }
    pub fn packet(number: usize) -> Self {
        Self(u32::try_from(number).expect("fewer packets than primitives") | PACKET_BIT)
    }
    #[inline(always)]
    pub fn is_packet(self) -> bool {
        self.0 & PACKET_BIT != 0
    }
    #[inline(always)]
    pub fn number(self) -> usize {
        (self.0 & !PACKET_BIT) as usize
    }
}

/// Eight boxes side by side. Unused ones are empty: infinitely far from everything.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct BoxNode {
    min: [[f32; WIDTH]; 3],
    max: [[f32; WIDTH]; 3],
    children: [NodeRef; WIDTH],
}

const _: () = assert!(size_of::<BoxNode>() == 256);

/// The lower and the upper corner of a box in the frame.
type Corners = [[f32; 3]; 2];

impl WideNode for BoxNode {
    type Volume = Aabb<f64>;
    type Shape = ();
    type Bounds = Corners;
    type Query = Rounded;
    type Ray = [SlabRay; 3];

    const NOTHING: Corners = [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]];

    fn new(children: [NodeRef; WIDTH]) -> Self {
        Self { min: [[f32::INFINITY; WIDTH]; 3], max: [[f32::NEG_INFINITY; WIDTH]; 3], children }
    }

    #[inline(always)]
    fn children(&self) -> &[NodeRef; WIDTH] {
        &self.children
    }

    const ROWS: usize = 6;

    fn rows(&self) -> impl Iterator<Item = [f32; WIDTH]> {
        self.min.into_iter().chain(self.max)
    }

    fn of_rows(rows: &[[f32; WIDTH]], children: [NodeRef; WIDTH]) -> Self {
        let [min, max] = [0, 3].map(|first| std::array::from_fn(|k| rows[first + k]));
        Self { min, max, children }
    }

    fn put(&mut self, place: usize, bounds: &Corners) {
        let [low, high] = *bounds;
        self.min.iter_mut().zip(low).for_each(|(row, x)| row[place] = x);
        self.max.iter_mut().zip(high).for_each(|(row, x)| row[place] = x);
    }

    fn enclose((): &(), frame: &Frame, _: &[Member], bounds: &Aabb<f64>) -> Corners {
        frame.enclose(bounds)
    }

    fn join(a: &Corners, b: &Corners) -> Corners {
        [[0, 1, 2].map(|k| a[0][k].min(b[0][k])), [0, 1, 2].map(|k| a[1][k].max(b[1][k]))]
    }

    #[inline(always)]
    fn query((): &(), frame: &Frame, query: &[f64; 3]) -> Option<Rounded> {
        Some(Rounded::of(frame.local(query)?))
    }

    #[inline(always)]
    fn lower_bounds<L: Lanes>(&self, (): &(), query: &Rounded) -> L {
        let mut sum = L::splat(0.0);
        for k in 0..3 {
            sum = query.squared_gap(k, L::load(&self.min[k]), L::load(&self.max[k]), sum);
        }
        sum
    }

    fn ray((): &(), line: &FrameLine) -> [SlabRay; 3] {
        std::array::from_fn(|k| SlabRay::new(line.base[k], line.direction[k], line.margin))
    }

    #[inline(always)]
    fn entries<L: Lanes>(&self, ray: &[SlabRay; 3]) -> L {
        let mut piece = Piece::new();
        for (slab, (min, max)) in ray.iter().zip(self.min.iter().zip(&self.max)) {
            piece.clip(slab, L::load(min), L::load(max));
        }
        piece.entry()
    }

    fn at(&self, place: usize) -> Corners {
        [self.min.map(|row| row[place]), self.max.map(|row| row[place])]
    }

    fn disclose(bounds: &Corners, (): &(), frame: &Frame) -> Aabb<f64> {
        let [min, max] = bounds.map(|corner| Point3::from(corner.map(f64::from)));
        frame.disclose(&Aabb { min, max })
    }

    fn volume(bounds: &Corners, (): &(), frame: &Frame) -> Aabb<f64> {
        Self::disclose(bounds, &(), frame)
    }
}

/// The frame of the nodes: the scene fits into the cube from -1 to 1 (from -4 to 4, for the largest ones).
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    pub centre: [f64; 3],
    pub unit: f64,
    pub per_unit: f64,
}

/// Units in which squares of lengths are plain, as searches in f32 need them.
const PLAIN: std::ops::RangeInclusive<f64> = power_of_two(-320)..=power_of_two(300);
/// Beyond this many units from the scene, its boxes are asked in f64.
const FARTHEST: f64 = power_of_two(40);

impl Frame {
    pub fn around(bounds: &Aabb<f64>) -> Self {
        // Halves first: sums and differences of two finite numbers may not be finite.
        let halves: [f64; 3] = std::array::from_fn(|k| bounds.max[k] * 0.5 - bounds.min[k] * 0.5);
        let centre: [f64; 3] = std::array::from_fn(|k| bounds.max[k] * 0.5 + bounds.min[k] * 0.5);
        let half = halves.into_iter().fold(0.0, f64::max);
        // A scene that is one point has the size of what rounding takes from it.
        let half = if half > 0.0 { half } else { centre.iter().fold(0.0, |a, x| x.abs().max(a)) * f64::EPSILON };
        let e = if half > 0.0 && half.is_finite() { exponent(half) + 1 } else { 0 };
        // Not so small that its inverse overflows, nor so large that it does.
        let unit = power_of_two(e.clamp(-1000, 1022));
        Self { centre, unit, per_unit: unit.recip() }
    }

    /// A point in the frame.
    #[inline(always)]
    pub fn place(&self, point: &[f64; 3]) -> [f64; 3] {
        std::array::from_fn(|k| (point[k] - self.centre[k]) * self.per_unit)
    }

    /// The query in the frame; `None` if it is too far or the frame too small or large to search in f32.
    #[inline(always)]
    pub fn local(&self, query: &[f64; 3]) -> Option<[f64; 3]> {
        let q = self.place(query);
        let largest = q[0].abs().max(q[1].abs()).max(q[2].abs());
        (PLAIN.contains(&self.unit) && largest <= FARTHEST).then_some(q)
    }

    /// Whether lengths of the scene have plain squares, so that searches in f32 are possible at all.
    #[inline]
    pub fn is_plain(&self) -> bool {
        PLAIN.contains(&self.unit)
    }

    /// A box in the frame, rounded outwards.
    #[allow(clippy::cast_possible_truncation, reason = "rounded outwards, which covers the rounding of the difference")]
    pub fn enclose(&self, bounds: &Aabb<f64>) -> Corners {
        let [min, max] = [&bounds.min, &bounds.max].map(|corner| self.place(&[corner.x, corner.y, corner.z]));
        [min.map(|x| (x as f32).next_down()), max.map(|x| (x as f32).next_up())]
    }

    /// A box around a box of the frame.
    pub fn disclose(&self, bounds: &Aabb<f64>) -> Aabb<f64> {
        let place = |x: f64, k: usize| self.centre[k] + x * self.unit;
        Aabb {
            min: Point3::from(std::array::from_fn(|k| place(bounds.min[k], k).next_down())),
            max: Point3::from(std::array::from_fn(|k| place(bounds.max[k], k).next_up())),
        }
    }

    /// The square of a length in the frame, a bound of a node, in the scene, rounded down.
    pub fn square_below(&self, square: f32) -> f64 {
        // As `square_above`.
        let square = f64::from(square) * (1.0 - power_of_two(-19)) - power_of_two(-120);
        square.max(0.0) * (self.unit * self.unit)
    }

    /// The square of a length of the scene in the frame, rounded up.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "rounded up before")]
    pub fn square_above(&self, square: f64) -> f32 {
        // 2^-20 for the bounds it is compared with and for this product, 2^-120 for what underflows in either.
        let square = square * (self.per_unit * self.per_unit) * (1.0 + power_of_two(-19)) + power_of_two(-120);
        if square < f64::from(f32::MAX) { square as f32 } else { f32::MAX }
    }
}
