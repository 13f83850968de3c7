//! A corner of Voronoi cells: the circumcentre of a Delaunay tetrahedron, with its ball.

use crate::delaunay::{BOUNDING, Delaunay};
use crate::parallel_chunks::map_chunks_in_order;
use crate::voronoi::budget::Limits;
use crate::voronoi::circumsphere;
use p2m_bvh::PacketTree;
use p2m_bvh::engine::range::Selection;
use p2m_core::engine::vector::{V3, norm_squared, sub};
use std::ops::Range;

/// The number of corners that one task computes.
pub(crate) const CORNERS_PER_TASK: usize = 1024;

/// A corner of Voronoi cells, in coordinates of the scene.
#[derive(Clone, Copy)]
pub(crate) struct CellCorner {
    /// The position of the corner.
    pub(crate) position: V3,
    /// An upper bound of the error of the position.
    pub(crate) error: f64,
    /// The distance to the four sites around it, or zero if the corner is unknown.
    pub(crate) radius: f64,
    /// The index of the first packet of this corner among the packets of all corners.
    pub(crate) first_packet: u32,
    /// Whether the corner has no packets: it is unknown, or its ball intersects too many. While sites are added, the
    /// limit is lower than the limit of a list.
    pub(crate) is_crowded: bool,
}

impl CellCorner {
    /// A corner that could not be computed.
    pub(crate) const UNKNOWN: Self =
        Self { position: [0.0; 3], error: 0.0, radius: 0.0, first_packet: 0, is_crowded: true };

    /// Computes the corner of a tetrahedron. It counts as crowded until its packets are known.
    fn of_tetrahedron(delaunay: &Delaunay, tetrahedron: [u32; 4]) -> Self {
        let (sites, unit) = (delaunay.sites(), delaunay.unit());
        let own_site = tetrahedron.into_iter().map(|v| v as usize).find(|v| *v >= BOUNDING);
        let centre = circumsphere::circumcentre(&tetrahedron.map(|v| sites[v as usize]));
        let (Some(site), Some(centre)) = (own_site, centre) else { return Self::UNKNOWN };
        Self {
            position: centre.position.map(|x| x * unit),
            error: centre.error * unit,
            radius: norm_squared(sub(centre.position, sites[site])).sqrt() * unit * (1.0 + 8.0 * f64::EPSILON),
            ..Self::UNKNOWN
        }
    }

    /// Collects the packets that may intersect the ball of the corner. The result is `false` if there are more than
    /// `max_packets`, or if the ball cannot be decided.
    pub(crate) fn collect_ball(
        &self,
        tree: &PacketTree,
        limits: Limits<'_>,
        max_packets: usize,
        selections: &mut Vec<Selection>,
    ) -> bool {
        let mut tests = 0;
        let is_complete = tree.ball(
            self.position,
            self.radius + 2.0 * self.error + limits.slack,
            max_packets,
            selections,
            &mut tests,
        );
        limits.budget.charge(tests);
        is_complete
    }
}

/// Computes the corners of all tetrahedra. Their packets are not known yet.
pub(crate) fn compute_corners(delaunay: &Delaunay, parallel: bool) -> Vec<CellCorner> {
    let mut corners = Vec::with_capacity(delaunay.tetrahedra().len() + 1);
    let work = |numbers: Range<usize>| -> Vec<CellCorner> {
        let tetrahedra = &delaunay.tetrahedra()[numbers];
        tetrahedra.iter().map(|tetrahedron| CellCorner::of_tetrahedron(delaunay, *tetrahedron)).collect()
    };
    map_chunks_in_order(delaunay.tetrahedra().len(), CORNERS_PER_TASK, parallel, work, |chunk| corners.extend(chunk));
    corners
}
