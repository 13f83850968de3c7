//! Validation of the P2M index of a saved file.
//!
//! The checks take one pass over the sites, the neighbours, the blocks and the cells of the locator. They cover what
//! locating a query and searching its list rely on in order to end without a panic. They do not cover bounds,
//! half-spaces and lists that lack a primitive, which can only make answers wrong. A walk ends whatever the offsets of
//! neighbours are, because it is stopped after it has read as many blocks of neighbours as there are.

use crate::voronoi::Voronoi;
use crate::voronoi::neighbours::SITES;
use crate::voronoi::site::{AUXILIARY_SITE, FALLBACK, Site};
use p2m_core::storage::{LoadError, check_chunks, require};

/// The section with the fields that are not arrays.
pub(super) const VORONOI: &str = "voronoi";
/// The section with the blocks of all lists.
pub(super) const LISTS: &str = "voronoi/lists";
/// The section with the anchors.
pub(super) const ANCHORS: &str = "voronoi/anchors";

/// Checks the sites, the lists and the numbers of the domain.
pub(super) fn check(index: &Voronoi) -> Result<(), LoadError> {
    let numbers = [[index.per_unit, index.unit, index.slack], index.low, index.high];
    require(numbers.as_flattened().iter().all(|x| x.is_finite()), VORONOI, "a number is not finite")?;
    require(index.anchors.as_flattened().iter().all(|x| x.is_finite()), ANCHORS, "a coordinate is not finite")?;
    let (sites, blocks) = (&index.neighbours.sites, &index.blocks);
    require(blocks.len() >= sites.len(), LISTS, "there are fewer blocks than sites")?;
    let lane_masks = &index.tree.lane_masks();
    for (site, first) in sites.iter().zip(blocks.iter()) {
        check_site(index, lane_masks, site)?;
        if site.has_list() {
            // The first block of a list has the number of its site, and the other blocks come after the first blocks of
            // all sites.
            let start = site.list as usize;
            let end = start + usize::from(first.following);
            require(start >= sites.len() && end <= blocks.len(), LISTS, "a list exceeds the section")?;
        }
    }
    check_chunks(blocks, |_, chunk| {
        let are_valid = chunk.iter().all(|block| block.has_valid_fields(lane_masks));
        require(are_valid, LISTS, "a number is out of range")
    })
}

/// Checks the position and the owner of a site.
fn check_site(index: &Voronoi, lane_masks: &[u16], site: &Site) -> Result<(), LoadError> {
    require(site.position.iter().all(|x| x.is_finite()), SITES, "a coordinate is not finite")?;
    let has_far_half_space = site.far_half_space.height < f32::INFINITY;
    if site.list == AUXILIARY_SITE {
        return require((site.owner as usize) < index.anchors.len(), SITES, "an anchor does not exist")
            .and_then(|()| require(!has_far_half_space, SITES, "an auxiliary site has a half-space"));
    }
    require(site.list != FALLBACK || !has_far_half_space, SITES, "a site without a list has a half-space")?;
    let Some((packet, lane)) = site.known_primitive() else {
        return require(!has_far_half_space, SITES, "a site without a primitive has a half-space");
    };
    let is_lane = lane_masks.get(packet).is_some_and(|mask| mask >> lane & 1 == 1);
    require(is_lane, SITES, "a primitive does not exist")
}
