//! The record of a site: its position, and where its neighbours and its list are.

use crate::voronoi::adjacency::NO_PRIMITIVE;
use p2m_bvh::engine::packet::LANES;
use p2m_core::engine::vector::V3;

/// The value of [`Site::list`] in a cell that the tree answers.
pub(crate) const FALLBACK: u32 = u32::MAX;
/// The value of [`Site::list`] in the cell of an auxiliary site, which the tree answers from the bound of an anchor.
pub(crate) const AUXILIARY_SITE: u32 = u32::MAX - 1;

/// A site in one cache line.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C, align(64))]
pub(crate) struct Site {
    /// The position, in units in which all sites are about 1.
    pub(crate) position: V3,
    /// Half the distance to the nearest neighbour that is not in an inline block, rounded down.
    pub(crate) half_next_distance: f32,
    /// The number of the first block of neighbours after the inline blocks.
    pub(crate) first_further_block: u32,
    /// The number of blocks of neighbours, inline blocks included.
    pub(crate) block_count: u32,
    /// The half-space in which the answer is known without a search.
    pub(crate) far_half_space: FarHalfSpace,
    /// The primitive with the lowest id that has the vertex, as its packet times [`LANES`] plus its lane, or
    /// [`NO_PRIMITIVE`]. For an auxiliary site it is the number of its anchor.
    pub(crate) owner: u32,
    /// The number of the second block of the list. It is [`FALLBACK`] or [`AUXILIARY_SITE`] if the cell has no list.
    pub(crate) list: u32,
}

const _: () = assert!(size_of::<Site>() == 64);

impl Site {
    /// Returns whether the cell has a list and is not left to the tree.
    #[inline(always)]
    pub(crate) fn has_list(&self) -> bool {
        self.list != FALLBACK && self.list != AUXILIARY_SITE
    }

    /// Returns the packet and the lane of a primitive that has the site as a vertex.
    #[inline(always)]
    pub(crate) fn known_primitive(&self) -> Option<(usize, usize)> {
        let owner = self.owner as usize;
        (self.list != AUXILIARY_SITE && self.owner != NO_PRIMITIVE).then_some((owner / LANES, owner % LANES))
    }
}

/// A half-space far from a site in which only primitives at the site can be the answer. This holds for queries
/// whose nearest point on all these primitives is the site, and that are nearer to the site than to all other
/// sites by a margin.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct FarHalfSpace {
    /// The direction of the half-space, of about length 1.
    pub(crate) normal: [f32; 3],
    /// The distance of the half-space from the site along `normal`, in the units of sites. It is infinite if there is
    /// no such half-space.
    pub(crate) height: f32,
    /// The margin: a query has to be nearer to the site than to another one by this part of half the squared distance
    /// between the two.
    pub(crate) relative_lead: f32,
}

impl FarHalfSpace {
    /// The value for a site without such a half-space.
    pub(crate) const NONE: Self = Self { normal: [0.0; 3], height: f32::INFINITY, relative_lead: 0.0 };

    /// Returns whether the half-space contains the query at an offset from the site.
    #[inline(always)]
    pub(crate) fn contains(&self, offset: &V3) -> bool {
        let [x, y, z] = self.normal.map(f64::from);
        x * offset[0] + y * offset[1] + z * offset[2] > f64::from(self.height)
    }
}
