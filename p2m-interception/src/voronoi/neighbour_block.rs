//! Eight neighbours of a site.

use p2m_bvh::engine::packet::frame_unit;
use p2m_core::engine::simd::Lanes;
use p2m_core::engine::vector::{V3, power_of_two, sub};

/// Neighbours of a block.
pub(crate) const WIDTH: usize = 8;

/// Eight ways to other sites: one cache line.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C, align(64))]
pub(crate) struct Fan {
    /// In units, from [`ZERO`] on.
    pub(crate) ways: [[u16; WIDTH]; 3],
    /// A power of two.
    pub(crate) unit: f32,
    /// One bit for each way along an edge of a primitive.
    pub(crate) edges: u32,
    pub(crate) unused: [u32; 2],
}

const _: () = assert!(size_of::<Fan>() == 64);

/// What is no way at all.
const ZERO: u16 = 1 << 15;
/// What products in f32 may be off, in parts of the sizes of what is summed: five roundings, and some room.
const ROUNDING: f32 = 4.0 * f32::EPSILON;
/// The part of the squares of two lengths by which an angle between them has to be wider than a right one, for the
/// kernel not to compute anything but the distance to the vertex.
const CERTAIN: f32 = 1.0 / (1u64 << 28) as f32;
/// What products lack by underflow, with plenty of room.
pub(crate) const TINY: f32 = 1e-30;

/// What is shorter does not matter beside what underflows.
const LEAST_UNIT: f64 = power_of_two(-99);

/// A query as seen from a site.
#[derive(Clone, Copy)]
pub(crate) struct Offset {
    pub(crate) way: [f32; 3],
    /// The sum of the sizes of the components, rounded up.
    pub(crate) size: f32,
    pub(crate) square: f32,
    /// Gains that are not below minus this much are not certain,
    pub(crate) tie: f32,
    /// nor those above this part of half the square of the way to the neighbour, below zero.
    pub(crate) part: f32,
}

/// What a block says about a query.
pub(crate) struct Said<L> {
    /// By how much each neighbour is nearer than the site, as half a difference of squares.
    pub(crate) gains: L,
    /// What that may be off.
    pub(crate) margins: L,
    /// One bit for each neighbour that may tie with the site by what it is a vertex of.
    pub(crate) ties: u32,
    /// One bit for each way along an edge of which the site is not certainly the nearest point.
    pub(crate) edges: u32,
}

impl Fan {
    pub(crate) const EMPTY: Self = Self { ways: [[ZERO; WIDTH]; 3], unit: 0.0, edges: 0, unused: [0; 2] };

    /// The ways from a site to others, the last one repeated where there are fewer. `is_edge` tells which of them are
    /// along an edge of a primitive.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "rounding is allowed for")]
    pub(crate) fn new(places: &[V3], site: usize, others: &[u32], is_edge: impl Fn(u32) -> bool) -> Self {
        let ways: [V3; WIDTH] =
            std::array::from_fn(|lane| sub(places[others[lane.min(others.len() - 1)] as usize], places[site]));
        let largest = ways.as_flattened().iter().fold(0.0f64, |a, x| a.max(x.abs()));
        // To both sides of zero.
        let unit = frame_unit(2.0 * largest).max(LEAST_UNIT);
        let mut fan = Self { unit: unit as f32, ..Self::EMPTY };
        for (lane, way) in ways.into_iter().enumerate() {
            for (row, x) in fan.ways.iter_mut().zip(way) {
                row[lane] = ((x / unit).round() + f64::from(ZERO)) as u16;
            }
            fan.edges |= u32::from(others.get(lane).is_some_and(|other| is_edge(*other))) << lane;
        }
        fan
    }

    #[inline(always)]
    pub(crate) fn says<L: Lanes>(&self, d: &Offset) -> Said<L> {
        let (zero, bias, unit) = (L::splat(0.0), L::splat(f32::from(ZERO)), L::splat(self.unit));
        let x = L::load_u16(&self.ways[0]).sub(bias).mul(unit);
        let y = L::load_u16(&self.ways[1]).sub(bias).mul(unit);
        let z = L::load_u16(&self.ways[2]).sub(bias).mul(unit);
        let [dx, dy, dz] = [L::splat(d.way[0]), L::splat(d.way[1]), L::splat(d.way[2])];
        let half = z.mul_add(z, y.mul_add(y, x.mul(x))).mul(L::splat(0.5));
        let [px, py, pz] = [x.mul(dx), y.mul(dy), z.mul(dz)];
        let sizes = px.max(zero.sub(px)).add(py.max(zero.sub(py))).add(pz.max(zero.sub(pz)));
        let product = px.add(py).add(pz);
        // Each component is off by half a unit: the product by that much of the query's size, half of the square by
        // that much of the way's. The square of an error is at most 3/8 of a squared unit; what is certainly gained is
        // a whole one on some axis.
        let lengths = x.max(zero.sub(x)).add(y.max(zero.sub(y))).add(z.max(zero.sub(z)));
        let whole = lengths.add(L::splat(d.size)).mul(L::splat(self.unit * 0.51));
        let margins = sizes.add(half).mul_add(L::splat(ROUNDING), whole.add(L::splat(d.tie)));
        let gains = product.sub(half);
        let ties = zero.at_most(half.mul_add(L::splat(d.part), gains.add(margins)));
        // The kernel gives exactly the distance to a vertex that is nearest by this.
        let certain = half.mul_add(L::splat(CERTAIN), L::splat(d.square * CERTAIN));
        let edges = zero.at_most(product.add(margins).add(certain)) & self.edges;
        Said { gains, margins, ties, edges }
    }
}
