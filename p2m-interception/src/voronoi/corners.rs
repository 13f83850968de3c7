//! CellCorners of Voronoi cells.

use crate::delaunay::{BOUNDING, Delaunay};
use crate::parallel_chunks::map_chunks_in_order;
use crate::voronoi::budget::Limits;
use crate::voronoi::circumsphere;
use p2m_bvh::PacketTree;
use p2m_bvh::engine::range::Selection;
use p2m_core::engine::vector::{V3, norm_squared, sub};
use std::collections::HashMap;
use std::ops::Range;

/// Balls that meet more packets get a site.
pub(crate) const CROWDED_BALL_PACKETS: usize = 24;

/// A corner of Voronoi cells, in coordinates of the scene, and what meets its collect_ball.
#[derive(Clone, Copy)]
pub(crate) struct CellCorner {
    pub(crate) position: V3,
    /// How far it may be from where it is.
    pub(crate) error: f64,
    /// To the sites around it; zero where it is unknown.
    pub(crate) radius: f64,
    /// Its packets begin here.
    pub(crate) first_packet: u32,
    /// Whether it is unknown, or meets too much: while sites are added, more than [`CROWDED_BALL_PACKETS`] packets.
    pub(crate) is_crowded: bool,
}

impl CellCorner {
    const UNKNOWN: Self = Self { position: [0.0; 3], error: 0.0, radius: 0.0, first_packet: 0, is_crowded: true };

    /// The packets that may meet its collect_ball; `false` if there are more than `max_packets`, or if nothing can be told.
    fn collect_ball(
        &self,
        tree: &PacketTree,
        limits: Limits<'_>,
        max_packets: usize,
        selections: &mut Vec<Selection>,
    ) -> bool {
        let mut tests = 0;
        let is_whole = tree.ball(
            self.position,
            self.radius + 2.0 * self.error + limits.slack,
            max_packets,
            selections,
            &mut tests,
        );
        limits.budget.charge(tests);
        is_whole
    }
}

/// The corners of all cells: one for each tetrahedron, and one more for the end.
#[derive(Default)]
pub(crate) struct CellCorners {
    pub(crate) all: Vec<CellCorner>,
    packets: Vec<u32>,
}

impl CellCorners {
    /// A collect_ball for each tetrahedron; those of `reused` ones are copied.
    pub(crate) fn new(
        tree: &PacketTree,
        delaunay: &Delaunay,
        limits: Limits<'_>,
        reused: Option<&ReusedCorners<'_>>,
        progress: &dyn Fn(usize, usize),
    ) -> Self {
        let count = delaunay.tetrahedra().len();
        let mut corners = Self { all: Vec::with_capacity(count + 1), packets: Vec::new() };
        map_chunks_in_order(
            count,
            limits.parallel,
            |chunk| Self::chunk(tree, delaunay, limits, reused, chunk),
            |chunk: Self| {
                corners.append(chunk, limits);
                progress(corners.all.len(), count);
            },
        );
        corners.push(CellCorner::UNKNOWN, std::iter::empty());
        corners
    }

    fn chunk(
        tree: &PacketTree,
        delaunay: &Delaunay,
        limits: Limits<'_>,
        reused: Option<&ReusedCorners<'_>>,
        numbers: Range<usize>,
    ) -> Self {
        let (sites, unit) = (delaunay.sites(), delaunay.unit());
        let mut corners = Self::default();
        let mut selections: Vec<Selection> = Vec::new();
        for tetrahedron in &delaunay.tetrahedra()[numbers] {
            if let Some((reused, to_u32)) = reused.and_then(|reused| Some((reused, reused.to_u32(tetrahedron)?))) {
                corners.push(reused.corners.all[to_u32], reused.corners.packets(to_u32).iter().copied());
                continue;
            }
            selections.clear();
            let mut corner = CellCorner::UNKNOWN;
            if limits.budget.is_exceeded() {
                corners.push(corner, std::iter::empty());
                continue;
            }
            let own = tetrahedron.iter().map(|v| *v as usize).find(|v| *v >= BOUNDING);
            if let (Some(own), Some(centre)) =
                (own, circumsphere::circumcentre(&tetrahedron.map(|v| sites[v as usize])))
            {
                corner.position = centre.position.map(|x| x * unit);
                corner.error = centre.error * unit;
                corner.radius =
                    norm_squared(sub(centre.position, sites[own])).sqrt() * unit * (1.0 + 8.0 * f64::EPSILON);
                corner.is_crowded = !corner.collect_ball(
                    tree,
                    limits,
                    CROWDED_BALL_PACKETS.min(limits.max_list_packets),
                    &mut selections,
                );
            }
            let kept = if corner.is_crowded { &[] } else { &selections[..] };
            corners.push(corner, kept.iter().map(|s| s.packet));
        }
        corners
    }

    /// The same with all packets of crowded balls, if these are not too many for a list.
    pub(crate) fn with_packets_of_crowded(self, tree: &PacketTree, limits: Limits<'_>) -> Self {
        if limits.max_list_packets <= CROWDED_BALL_PACKETS || self.crowded_count() == 0 {
            return self;
        }
        let count = self.all.len() - 1;
        let mut corners = Self { all: Vec::with_capacity(count + 1), packets: Vec::with_capacity(self.packets.len()) };
        let work = |numbers: Range<usize>| {
            let mut chunk = Self::default();
            let mut selections: Vec<Selection> = Vec::new();
            for to_u32 in numbers {
                let corner = self.all[to_u32];
                selections.clear();
                let again = corner.is_crowded && corner.radius > 0.0 && !limits.budget.is_exceeded();
                if again && corner.collect_ball(tree, limits, limits.max_list_packets, &mut selections) {
                    chunk.push(CellCorner { is_crowded: false, ..corner }, selections.iter().map(|s| s.packet));
                } else {
                    chunk.push(corner, self.packets(to_u32).iter().copied());
                }
            }
            chunk
        };
        map_chunks_in_order(count, limits.parallel, work, |chunk| corners.append(chunk, limits));
        corners.push(CellCorner::UNKNOWN, std::iter::empty());
        corners
    }

    /// Adds what a chunk has; its corners without their packets where there is no room for these.
    fn append(&mut self, chunk: Self, limits: Limits<'_>) {
        let first_packet = self.packets.len();
        if !limits.budget.fits::<u32>(first_packet + chunk.packets.len()) {
            self.all.resize(
                self.all.len() + chunk.all.len(),
                CellCorner { first_packet: to_u32(first_packet), ..CellCorner::UNKNOWN },
            );
            return;
        }
        self.packets.extend_from_slice(&chunk.packets);
        let moved = |corner: CellCorner| CellCorner {
            first_packet: to_u32(first_packet + corner.first_packet as usize),
            ..corner
        };
        self.all.extend(chunk.all.into_iter().map(moved));
    }

    /// How many are unknown or meet too much.
    pub(crate) fn crowded_count(&self) -> usize {
        // The last one is none.
        self.all[..self.all.len() - 1].iter().filter(|corner| corner.is_crowded).count()
    }

    /// The packets that meet the collect_ball of a corner, if they are not too many.
    pub(crate) fn packets(&self, to_u32: usize) -> &[u32] {
        &self.packets[self.all[to_u32].first_packet as usize..self.all[to_u32 + 1].first_packet as usize]
    }

    fn push(&mut self, corner: CellCorner, packets: impl Iterator<Item = u32>) {
        let first_packet = to_u32(self.packets.len());
        self.packets.extend(packets);
        self.all.push(CellCorner { first_packet, ..corner });
    }
}

pub(crate) fn to_u32(n: usize) -> u32 {
    u32::try_from(n).expect("numbers of 32 bits")
}

/// Tetrahedra that two triangulations have in common.
pub(crate) struct ReusedCorners<'a> {
    /// Those of the first_packet,
    pub(crate) corners: &'a CellCorners,
    /// and their numbers by its sites.
    pub(crate) numbers: HashMap<[u32; 4], usize>,
    /// Of each site of the second the one of the first_packet, or [`ReusedCorners::NEW`].
    pub(crate) previous_sites: Vec<u32>,
}

impl<'a> ReusedCorners<'a> {
    const NEW: u32 = u32::MAX;

    /// The second one has the points of the first_packet, `points` of them, previous_sites its own.
    #[allow(clippy::float_cmp, reason = "the same or not")]
    pub(crate) fn new(first_packet: &Delaunay, corners: &'a CellCorners, second: &Delaunay, points: usize) -> Self {
        let mut previous_sites = vec![Self::NEW; second.sites().len()];
        let mut numbers = HashMap::new();
        // Sites of another unit may be rounded otherwise, and of another box the bounding ones are elsewhere.
        if first_packet.unit() == second.unit() {
            if first_packet.sites()[..BOUNDING] == second.sites()[..BOUNDING] {
                (0..BOUNDING).for_each(|site| previous_sites[site] = to_u32(site));
            }
            for point in 0..points {
                previous_sites[second.site_of(point)] = to_u32(first_packet.site_of(point));
            }
            numbers.extend(first_packet.tetrahedra().iter().enumerate().map(|(to_u32, t)| (sorted(*t), to_u32)));
        }
        Self { corners, numbers, previous_sites }
    }

    /// The to_u32 in the first_packet triangulation of a tetrahedron of the second.
    fn to_u32(&self, tetrahedron: &[u32; 4]) -> Option<usize> {
        let previous_sites = tetrahedron.map(|v| self.previous_sites[v as usize]);
        if previous_sites.contains(&Self::NEW) { None } else { self.numbers.get(&sorted(previous_sites)).copied() }
    }
}

fn sorted(mut sites: [u32; 4]) -> [u32; 4] {
    sites.sort_unstable();
    sites
}
