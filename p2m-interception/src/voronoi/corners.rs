//! Corners of Voronoi cells.

use crate::delaunay::{BOUNDING, Delaunay};
use crate::parallel_chunks::in_shares;
use crate::voronoi::budget::Limits;
use crate::voronoi::circumsphere;
use p2m_bvh::PacketTree;
use p2m_bvh::engine::range::Selection;
use p2m_core::engine::vector::{V3, norm_squared, sub};
use std::collections::HashMap;
use std::ops::Range;

/// Balls that meet more packets get a site.
pub(crate) const CROWDED: usize = 24;

/// A corner of Voronoi cells, in coordinates of the scene, and what meets its ball.
#[derive(Clone, Copy)]
pub(crate) struct Corner {
    pub(crate) place: V3,
    /// How far it may be from where it is.
    pub(crate) error: f64,
    /// To the sites around it; zero where it is unknown.
    pub(crate) radius: f64,
    /// Its packets begin here.
    pub(crate) first: u32,
    /// Whether it is unknown, or meets too much: while sites are added, more than [`CROWDED`] packets.
    pub(crate) full: bool,
}

impl Corner {
    const UNKNOWN: Self = Self { place: [0.0; 3], error: 0.0, radius: 0.0, first: 0, full: true };

    /// The packets that may meet its ball; `false` if there are more than `most`, or if nothing can be told.
    fn ball(&self, tree: &PacketTree, limits: Limits<'_>, most: usize, met: &mut Vec<Selection>) -> bool {
        let mut tests = 0;
        let is_whole = tree.ball(self.place, self.radius + 2.0 * self.error + limits.slack, most, met, &mut tests);
        limits.allowance.spend(tests);
        is_whole
    }
}

/// The corners of all cells: one for each tetrahedron, and one more for the end.
#[derive(Default)]
pub(crate) struct Corners {
    pub(crate) all: Vec<Corner>,
    packets: Vec<u32>,
}

impl Corners {
    /// A ball for each tetrahedron; those of `known` ones are copied.
    pub(crate) fn new(
        tree: &PacketTree,
        delaunay: &Delaunay,
        limits: Limits<'_>,
        known: Option<&Known<'_>>,
        progress: &dyn Fn(usize, usize),
    ) -> Self {
        let count = delaunay.tetrahedra().len();
        let mut corners = Self { all: Vec::with_capacity(count + 1), packets: Vec::new() };
        in_shares(
            count,
            limits.parallel,
            |share| Self::share(tree, delaunay, limits, known, share),
            |share: Self| {
                corners.append(share, limits);
                progress(corners.all.len(), count);
            },
        );
        corners.push(Corner::UNKNOWN, std::iter::empty());
        corners
    }

    fn share(
        tree: &PacketTree,
        delaunay: &Delaunay,
        limits: Limits<'_>,
        known: Option<&Known<'_>>,
        numbers: Range<usize>,
    ) -> Self {
        let (sites, unit) = (delaunay.sites(), delaunay.unit());
        let mut corners = Self::default();
        let mut met: Vec<Selection> = Vec::new();
        for tetrahedron in &delaunay.tetrahedra()[numbers] {
            if let Some((known, number)) = known.and_then(|known| Some((known, known.number(tetrahedron)?))) {
                corners.push(known.corners.all[number], known.corners.packets(number).iter().copied());
                continue;
            }
            met.clear();
            let mut corner = Corner::UNKNOWN;
            if limits.allowance.is_over() {
                corners.push(corner, std::iter::empty());
                continue;
            }
            let own = tetrahedron.iter().map(|v| *v as usize).find(|v| *v >= BOUNDING);
            if let (Some(own), Some(centre)) = (own, circumsphere::centre(&tetrahedron.map(|v| sites[v as usize]))) {
                corner.place = centre.place.map(|x| x * unit);
                corner.error = centre.error * unit;
                corner.radius = norm_squared(sub(centre.place, sites[own])).sqrt() * unit * (1.0 + 8.0 * f64::EPSILON);
                corner.full = !corner.ball(tree, limits, CROWDED.min(limits.most), &mut met);
            }
            let kept = if corner.full { &[] } else { &met[..] };
            corners.push(corner, kept.iter().map(|s| s.packet));
        }
        corners
    }

    /// The same with all packets of crowded balls, if these are not too many for a list.
    pub(crate) fn finished(self, tree: &PacketTree, limits: Limits<'_>) -> Self {
        if limits.most <= CROWDED || self.full() == 0 {
            return self;
        }
        let count = self.all.len() - 1;
        let mut corners = Self { all: Vec::with_capacity(count + 1), packets: Vec::with_capacity(self.packets.len()) };
        let work = |numbers: Range<usize>| {
            let mut share = Self::default();
            let mut met: Vec<Selection> = Vec::new();
            for number in numbers {
                let corner = self.all[number];
                met.clear();
                let again = corner.full && corner.radius > 0.0 && !limits.allowance.is_over();
                if again && corner.ball(tree, limits, limits.most, &mut met) {
                    share.push(Corner { full: false, ..corner }, met.iter().map(|s| s.packet));
                } else {
                    share.push(corner, self.packets(number).iter().copied());
                }
            }
            share
        };
        in_shares(count, limits.parallel, work, |share| corners.append(share, limits));
        corners.push(Corner::UNKNOWN, std::iter::empty());
        corners
    }

    /// Adds what a share has; its corners without their packets where there is no room for these.
    fn append(&mut self, share: Self, limits: Limits<'_>) {
        let first = self.packets.len();
        if !limits.allowance.holds::<u32>(first + share.packets.len()) {
            self.all.resize(self.all.len() + share.all.len(), Corner { first: number(first), ..Corner::UNKNOWN });
            return;
        }
        self.packets.extend_from_slice(&share.packets);
        let moved = |corner: Corner| Corner { first: number(first + corner.first as usize), ..corner };
        self.all.extend(share.all.into_iter().map(moved));
    }

    /// How many are unknown or meet too much.
    pub(crate) fn full(&self) -> usize {
        // The last one is none.
        self.all[..self.all.len() - 1].iter().filter(|corner| corner.full).count()
    }

    /// The packets that meet the ball of a corner, if they are not too many.
    pub(crate) fn packets(&self, number: usize) -> &[u32] {
        &self.packets[self.all[number].first as usize..self.all[number + 1].first as usize]
    }

    fn push(&mut self, corner: Corner, packets: impl Iterator<Item = u32>) {
        let first = number(self.packets.len());
        self.packets.extend(packets);
        self.all.push(Corner { first, ..corner });
    }
}

pub(crate) fn number(n: usize) -> u32 {
    u32::try_from(n).expect("numbers of 32 bits")
}

/// Tetrahedra that two triangulations have in common.
pub(crate) struct Known<'a> {
    /// Those of the first,
    pub(crate) corners: &'a Corners,
    /// and their numbers by its sites.
    pub(crate) numbers: HashMap<[u32; 4], usize>,
    /// Of each site of the second the one of the first, or [`Known::NEW`].
    pub(crate) before: Vec<u32>,
}

impl<'a> Known<'a> {
    const NEW: u32 = u32::MAX;

    /// The second one has the points of the first, `points` of them, before its own.
    #[allow(clippy::float_cmp, reason = "the same or not")]
    pub(crate) fn new(first: &Delaunay, corners: &'a Corners, second: &Delaunay, points: usize) -> Self {
        let mut before = vec![Self::NEW; second.sites().len()];
        let mut numbers = HashMap::new();
        // Sites of another unit may be rounded otherwise, and of another box the bounding ones are elsewhere.
        if first.unit() == second.unit() {
            if first.sites()[..BOUNDING] == second.sites()[..BOUNDING] {
                (0..BOUNDING).for_each(|site| before[site] = number(site));
            }
            for point in 0..points {
                before[second.site_of(point)] = number(first.site_of(point));
            }
            numbers.extend(first.tetrahedra().iter().enumerate().map(|(number, t)| (sorted(*t), number)));
        }
        Self { corners, numbers, before }
    }

    /// The number in the first triangulation of a tetrahedron of the second.
    fn number(&self, tetrahedron: &[u32; 4]) -> Option<usize> {
        let before = tetrahedron.map(|v| self.before[v as usize]);
        if before.contains(&Self::NEW) { None } else { self.numbers.get(&sorted(before)).copied() }
    }
}

fn sorted(mut sites: [u32; 4]) -> [u32; 4] {
    sites.sort_unstable();
    sites
}
