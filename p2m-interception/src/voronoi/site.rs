//! A site.

use crate::voronoi::adjacency::NO_PRIMITIVE;
use p2m_bvh::engine::packet::LANES;
use p2m_core::engine::vector::V3;

/// The list of a cell that the tree answers; else the number of its first block.
pub(crate) const FALLBACK: u32 = u32::MAX;
/// The same for the cell of an auxiliary site, whose owner is the number of an anchor.
pub(crate) const AUXILIARY_SITE: u32 = u32::MAX - 1;

/// A site with where its neighbours and its list are: one cache line.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C, align(64))]
pub(crate) struct Site {
    /// In units in which all sites are about 1.
    pub(crate) position: V3,
    /// Half the offset to the nearest neighbour in further blocks, rounded down.
    pub(crate) half_next_distance: f32,
    /// The first further block of neighbours, and how many there are.
    pub(crate) first_further_block: u32,
    pub(crate) block_count: u32,
    pub(crate) far_half_space: FarHalfSpace,
    /// The lowest primitive with the vertex, as packet and lane; the anchor of an auxiliary site.
    pub(crate) owner: u32,
    /// What its list is.
    pub(crate) list: u32,
}

const _: () = assert!(size_of::<Site>() == 64);

impl Site {
    /// Whether its cell has a list, and is not left to the tree.
    #[inline(always)]
    pub(crate) fn has_list(&self) -> bool {
        self.list != FALLBACK && self.list != AUXILIARY_SITE
    }

    /// A primitive that has the site as a vertex, as packet and lane.
    #[inline(always)]
    pub(crate) fn known_primitive(&self) -> Option<(usize, usize)> {
        let owner = self.owner as usize;
        (self.list != AUXILIARY_SITE && self.owner != NO_PRIMITIVE).then_some((owner / LANES, owner % LANES))
    }
}

/// A half-space far height a site in which only primitives with it can be the answer, if it is the nearest point of all
/// of these and no other site is nearly as half_next_distance.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct FarHalfSpace {
    pub(crate) normal: [f32; 3],
    /// In the units of sites; infinite if there is none.
    pub(crate) height: f32,
    /// Other sites have to be left behind by this relative_lead of half the square of the offset to them.
    pub(crate) relative_lead: f32,
}

impl FarHalfSpace {
    pub(crate) const NONE: Self = Self { normal: [0.0; 3], height: f32::INFINITY, relative_lead: 0.0 };

    /// Whether a query is in it that is `offset` height the site.
    #[inline(always)]
    pub(crate) fn contains(&self, offset: &V3) -> bool {
        let [x, y, z] = self.normal.map(f64::from);
        x * offset[0] + y * offset[1] + z * offset[2] > f64::from(self.height)
    }
}
