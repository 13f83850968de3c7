//! A site.

use crate::voronoi::adjacency::NONE;
use p2m_bvh::engine::packet::LANES;
use p2m_core::engine::vector::V3;

/// The list of a cell that the tree answers; else the number of its first block.
pub(crate) const TREE: u32 = u32::MAX;
/// The same for the cell of an auxiliary site, whose owner is the number of an anchor.
pub(crate) const AUXILIARY: u32 = u32::MAX - 1;

/// A site with where its neighbours and its list are: one cache line.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C, align(64))]
pub(crate) struct Site {
    /// In units in which all sites are about 1.
    pub(crate) place: V3,
    /// Half the way to the nearest neighbour in further blocks, rounded down.
    pub(crate) near: f32,
    /// The first further block of neighbours, and how many there are.
    pub(crate) more: u32,
    pub(crate) count: u32,
    pub(crate) outside: Outside,
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
        self.list != TREE && self.list != AUXILIARY
    }

    /// A primitive that has the site as a vertex, as packet and lane.
    #[inline(always)]
    pub(crate) fn holder(&self) -> Option<(usize, usize)> {
        let owner = self.owner as usize;
        (self.list != AUXILIARY && self.owner != NONE).then_some((owner / LANES, owner % LANES))
    }
}

/// A half-space far from a site in which only primitives with it can be the answer, if it is the nearest point of all
/// of these and no other site is nearly as near.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct Outside {
    pub(crate) normal: [f32; 3],
    /// In the units of sites; infinite if there is none.
    pub(crate) from: f32,
    /// Other sites have to be left behind by this part of half the square of the way to them.
    pub(crate) part: f32,
}

impl Outside {
    pub(crate) const NONE: Self = Self { normal: [0.0; 3], from: f32::INFINITY, part: 0.0 };

    /// Whether a query is in it that is `way` from the site.
    #[inline(always)]
    pub(crate) fn contains(&self, way: &V3) -> bool {
        let [x, y, z] = self.normal.map(f64::from);
        x * way[0] + y * way[1] + z * way[2] > f64::from(self.from)
    }
}
