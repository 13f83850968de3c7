//! Eight neighbours of a site.

use p2m_bvh::engine::packet::frame_unit;
use p2m_core::engine::simd::Lanes;
use p2m_core::engine::vector::{V3, power_of_two, sub};

/// Neighbours of a block.
pub(crate) const NEIGHBOURS_PER_BLOCK: usize = 8;

/// Eight offsets to other sites: one cache line.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C, align(64))]
pub(crate) struct NeighbourBlock {
    /// In units, from [`ZERO_OFFSET`] on.
    pub(crate) offsets: [[u16; NEIGHBOURS_PER_BLOCK]; 3],
    /// A power of two.
    pub(crate) unit: f32,
    /// One bit for each offset along an edge of a primitive.
    pub(crate) edges: u32,
    pub(crate) unused: [u32; 2],
}

const _: () = assert!(size_of::<NeighbourBlock>() == 64);

/// What is no offset at all.
const ZERO_OFFSET: u16 = 1 << 15;
/// What products in f32 may be off, in parts of the sizes of what is summed: five roundings, and some room.
const PRODUCT_ROUNDING: f32 = 4.0 * f32::EPSILON;
/// The relative_lead of the squares of two lengths by which an angle between them has to be wider than a right one, for the
/// kernel not to compute anything but the distance to the vertex.
const CERTAIN_ANGLE_MARGIN: f32 = 1.0 / (1u64 << 28) as f32;
/// What products lack by underflow, with plenty of room.
pub(crate) const UNDERFLOW_MARGIN: f32 = 1e-30;

/// What is shorter does not matter beside what underflows.
const MIN_UNIT: f64 = power_of_two(-99);

/// A query as seen from a site.
#[derive(Clone, Copy)]
pub(crate) struct QueryOffset {
    pub(crate) offset: [f32; 3],
    /// The sum of the sizes of the components, rounded up.
    pub(crate) size: f32,
    pub(crate) square: f32,
    /// Gains that are not below minus this much are not angle_margin,
    pub(crate) tie: f32,
    /// nor those above this relative_lead of half the square of the offset to the neighbour, below zero.
    pub(crate) relative_lead: f32,
}

/// What a block bound_query about a query.
pub(crate) struct NeighbourBounds<L> {
    /// By how much each neighbour is nearer than the site, as half a difference of squares.
    pub(crate) gains: L,
    /// What that may be off.
    pub(crate) margins: L,
    /// One bit for each neighbour that may tie with the site by what it is a vertex of.
    pub(crate) ties: u32,
    /// One bit for each offset along an edge of which the site is not certainly the nearest point.
    pub(crate) edges: u32,
}

impl NeighbourBlock {
    pub(crate) const EMPTY: Self =
        Self { offsets: [[ZERO_OFFSET; NEIGHBOURS_PER_BLOCK]; 3], unit: 0.0, edges: 0, unused: [0; 2] };

    /// The offsets from a site to others, the last one repeated where there are fewer. `is_edge` tells which of them are
    /// along an edge of a primitive.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "rounding is allowed for")]
    pub(crate) fn new(positions: &[V3], site: usize, others: &[u32], is_edge: impl Fn(u32) -> bool) -> Self {
        let offsets: [V3; NEIGHBOURS_PER_BLOCK] =
            std::array::from_fn(|lane| sub(positions[others[lane.min(others.len() - 1)] as usize], positions[site]));
        let largest = offsets.as_flattened().iter().fold(0.0f64, |a, x| a.max(x.abs()));
        // To both sides of zero.
        let unit = frame_unit(2.0 * largest).max(MIN_UNIT);
        let mut block = Self { unit: unit as f32, ..Self::EMPTY };
        for (lane, offset) in offsets.into_iter().enumerate() {
            for (row, x) in block.offsets.iter_mut().zip(offset) {
                row[lane] = ((x / unit).round() + f64::from(ZERO_OFFSET)) as u16;
            }
            block.edges |= u32::from(others.get(lane).is_some_and(|other| is_edge(*other))) << lane;
        }
        block
    }

    #[inline(always)]
    pub(crate) fn bound_query<L: Lanes>(&self, query: &QueryOffset) -> NeighbourBounds<L> {
        let (zero, bias, unit) = (L::splat(0.0), L::splat(f32::from(ZERO_OFFSET)), L::splat(self.unit));
        let x = L::load_u16(&self.offsets[0]).sub(bias).mul(unit);
        let y = L::load_u16(&self.offsets[1]).sub(bias).mul(unit);
        let z = L::load_u16(&self.offsets[2]).sub(bias).mul(unit);
        let [dx, dy, dz] = [L::splat(query.offset[0]), L::splat(query.offset[1]), L::splat(query.offset[2])];
        let half = z.mul_add(z, y.mul_add(y, x.mul(x))).mul(L::splat(0.5));
        let [px, py, pz] = [x.mul(dx), y.mul(dy), z.mul(dz)];
        let sizes = px.max(zero.sub(px)).add(py.max(zero.sub(py))).add(pz.max(zero.sub(pz)));
        let product = px.add(py).add(pz);
        // Each component is off by half a unit: the product by that much of the query's size, half of the square by
        // that much of the offset's. The square of an error is at most 3/8 of a squared unit; what is certainly gained is
        // a quantization one on some axis.
        let lengths = x.max(zero.sub(x)).add(y.max(zero.sub(y))).add(z.max(zero.sub(z)));
        let quantization = lengths.add(L::splat(query.size)).mul(L::splat(self.unit * 0.51));
        let margins = sizes.add(half).mul_add(L::splat(PRODUCT_ROUNDING), quantization.add(L::splat(query.tie)));
        let gains = product.sub(half);
        let ties = zero.at_most(half.mul_add(L::splat(query.relative_lead), gains.add(margins)));
        // The kernel gives exactly the distance to a vertex that is nearest by this.
        let angle_margin = half.mul_add(L::splat(CERTAIN_ANGLE_MARGIN), L::splat(query.square * CERTAIN_ANGLE_MARGIN));
        let edges = zero.at_most(product.add(margins).add(angle_margin)) & self.edges;
        NeighbourBounds { gains, margins, ties, edges }
    }
}
