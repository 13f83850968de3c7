//! A block of eight neighbours of a site, with quantized offsets, and the test of a query against them in f32.

use p2m_bvh::engine::packet::frame_unit;
use p2m_core::engine::simd::Lanes;
use p2m_core::engine::vector::{V3, power_of_two, sub};

/// The number of neighbours in a block.
pub(crate) const NEIGHBOURS_PER_BLOCK: usize = 8;

/// Offsets from a site to eight neighbours, quantized to 16 bits, in one cache line.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C, align(64))]
pub(crate) struct NeighbourBlock {
    /// The offsets in units of `unit`, plus [`ZERO_OFFSET`], so that they are unsigned.
    pub(crate) offsets: [[u16; NEIGHBOURS_PER_BLOCK]; 3],
    /// The unit of the offsets, a power of two.
    pub(crate) unit: f32,
    /// A bit mask of the neighbours that an edge of a primitive joins to the site.
    pub(crate) edges: u32,
    pub(crate) unused: [u32; 2],
}

const _: () = assert!(size_of::<NeighbourBlock>() == 64);

/// The encoding of the offset 0, which is the middle of the unsigned range.
const ZERO_OFFSET: u16 = 1 << 15;
/// The relative rounding error of a sum of products in f32, in units of the sum of their absolute values. It covers
/// five roundings with a margin.
const PRODUCT_ROUNDING: f32 = 4.0 * f32::EPSILON;
/// The relative margin by which an angle has to exceed a right angle, so that the kernel returns exactly the distance
/// to the vertex.
const CERTAIN_ANGLE_MARGIN: f32 = 1.0 / (1u64 << 28) as f32;
/// The absolute margin that covers underflow of products in f32.
pub(crate) const UNDERFLOW_MARGIN: f32 = 1e-30;

/// The smallest unit. Shorter offsets are negligible beside what underflows.
const MIN_UNIT: f64 = power_of_two(-99);

/// The offset of a query point from a site, with the lengths and margins that the test needs.
#[derive(Clone, Copy)]
pub(crate) struct QueryOffset {
    /// The offset from the site to the query.
    pub(crate) offset: [f32; 3],
    /// The sum of the absolute values of the components, rounded up.
    pub(crate) size: f32,
    /// The squared length of the offset.
    pub(crate) square: f32,
    /// The part of the error bound of a gain that depends only on the query and the site.
    pub(crate) tie: f32,
    /// The relative lead that the site needs over a neighbour for its far half-space: see
    /// [`FarHalfSpace`](crate::voronoi::site::FarHalfSpace).
    pub(crate) relative_lead: f32,
}

/// The result of testing a query against a block.
pub(crate) struct NeighbourBounds<L> {
    /// The gain of each neighbour: half of the squared distance from the query to the site minus half of the squared
    /// distance to the neighbour. It is positive if the neighbour is nearer.
    pub(crate) gains: L,
    /// The error bounds of the gains.
    pub(crate) margins: L,
    /// A bit mask of the neighbours over which the site may lack the lead that its far half-space needs.
    pub(crate) ties: u32,
    /// A bit mask of the edges of primitives on which the site may not be the nearest point.
    pub(crate) edges: u32,
}

impl NeighbourBlock {
    /// A block without neighbours.
    pub(crate) const EMPTY: Self =
        Self { offsets: [[ZERO_OFFSET; NEIGHBOURS_PER_BLOCK]; 3], unit: 0.0, edges: 0, unused: [0; 2] };

    /// Stores the offsets from a site to at most eight others, and repeats the last one to fill the block. `is_edge`
    /// returns whether an edge of a primitive joins the site to another one.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "rounding is allowed for")]
    pub(crate) fn new(positions: &[V3], site: usize, others: &[u32], is_edge: impl Fn(u32) -> bool) -> Self {
        let offsets: [V3; NEIGHBOURS_PER_BLOCK] =
            std::array::from_fn(|lane| sub(positions[others[lane.min(others.len() - 1)] as usize], positions[site]));
        let largest = offsets.as_flattened().iter().fold(0.0f64, |a, x| a.max(x.abs()));
        // The unit leaves room for offsets on both sides of zero.
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

    /// Tests a query against all neighbours of the block.
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
        // Each component of an offset is off by at most half a unit. So the product is off by that much of the query's
        // size, and half of the square by that much of the offset's size. The square of the error is at most 3/8 of a
        // squared unit. A neighbour that is certainly nearer gains at least one unit on some axis.
        let lengths = x.max(zero.sub(x)).add(y.max(zero.sub(y))).add(z.max(zero.sub(z)));
        let quantization = lengths.add(L::splat(query.size)).mul(L::splat(self.unit * 0.51));
        let margins = sizes.add(half).mul_add(L::splat(PRODUCT_ROUNDING), quantization.add(L::splat(query.tie)));
        let gains = product.sub(half);
        let ties = zero.at_most(half.mul_add(L::splat(query.relative_lead), gains.add(margins)));
        // If an edge passes this test, the kernel returns exactly the distance to the vertex.
        let angle_margin = half.mul_add(L::splat(CERTAIN_ANGLE_MARGIN), L::splat(query.square * CERTAIN_ANGLE_MARGIN));
        let edges = zero.at_most(product.add(margins).add(angle_margin)) & self.edges;
        NeighbourBounds { gains, margins, ties, edges }
    }
}
