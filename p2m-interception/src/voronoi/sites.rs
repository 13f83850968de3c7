//! Where the sites of a Voronoi partition are: at the vertices, and at points that are added until few primitives meet
//! the ball of a corner.
//!
//! Where many primitives are about as far from a place as the nearest vertices (around the centre of a sphere, on the
//! axis of a cylinder, between long edges), every cell nearby has all of them in its list. A site in such a ball ends
//! it: its corner is no corner any more. If the scene itself reaches well into the ball, points of it are added, which
//! bound the answer as vertices do. If not, the ball is empty but for its border, and its centre is added: an
//! *auxiliary* site, in whose cell the tree answers, from the bound that a point of the scene gives.
//!
//! Corners are the centres of the spheres through Delaunay tetrahedra, whose balls have no site inside; so points are
//! added in rounds, each with new tetrahedra, until no ball meets too much, a round does not help, or the budget is
//! spent.

use crate::delaunay::{BOUNDING, Delaunay};
use crate::parallel_chunks::in_shares;
use crate::progress::{BuildStage, Teller};
use crate::voronoi::budget::{Allowance, most_tetrahedra};
use crate::voronoi::circumsphere;
use p2m_bvh::PacketTree;
use p2m_bvh::engine::packet::LANES;
use p2m_bvh::engine::range::Selection;
use p2m_core::engine::vector::{V3, exponent, norm_squared, scale_by_power, sub};
use p2m_core::{Aabb, Best, QueryOptions};
use std::collections::{HashMap, HashSet};
use std::ops::Range;

/// The distance of the bounding sites, in halves of the widest side: none of them is nearest in the domain, nor nearly
/// (docs/proofs/p2m.md).
pub(crate) const BOUNDING_DISTANCE: f64 = 300.0;
/// Balls that meet more packets get a site.
const CROWDED: usize = 24;
/// As many rounds of added points.
const ROUNDS: usize = 6;
/// Centres of so many balls beside each other are worth an auxiliary site.
const CLUSTER: usize = 3;
/// Points of the scene that are nearer to a centre than this part of the radius are added.
const DEEP: f64 = 0.9;
/// Packets of a ball that are looked at for such points.
const LOOKED_AT: usize = 64;
/// Added points lie in the box of the vertices, widened by this part of its widest side.
const BESIDE: f64 = 0.5;
/// Centres that are nearer to each other than about this part of the radius are one cluster.
const CLOSE: f64 = 0.25;
/// Those that are not known so well are left alone.
const BARELY: f64 = 1e-3;
/// Added points are apart by about this part of their distance to the centre of a ball, or of this part of its radius.
const APART: f64 = 0.5;
const LEAST: f64 = 0.1;

/// A corner of Voronoi cells, in coordinates of the scene, and what meets its ball.
#[derive(Clone, Copy)]
pub(crate) struct Corner {
    pub(crate) place: V3,
    /// How far it may be from where it is.
    pub(crate) error: f64,
    /// To the sites around it; zero where it is unknown.
    radius: f64,
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
    fn new(
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
    fn finished(self, tree: &PacketTree, limits: Limits<'_>) -> Self {
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
    fn full(&self) -> usize {
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

fn number(n: usize) -> u32 {
    u32::try_from(n).expect("numbers of 32 bits")
}

/// The sites and the corners of their cells.
pub(crate) struct Sites {
    pub(crate) delaunay: Delaunay,
    pub(crate) corners: Corners,
    /// Of each auxiliary site a point of the scene that is near.
    pub(crate) anchors: Vec<(usize, V3)>,
    /// How many points of the scene were added.
    pub(crate) added: usize,
}

/// How many sites there may be, and what a list may have.
#[derive(Clone, Copy)]
pub(crate) struct Limits<'a> {
    /// By how much a dominator has to be nearer.
    pub(crate) slack: f64,
    /// Packets of a list.
    pub(crate) most: usize,
    /// Points that may be added.
    pub(crate) added: usize,
    /// Whether all threads are used.
    pub(crate) parallel: bool,
    /// What building may take.
    pub(crate) allowance: &'a Allowance,
}

/// A point that is added.
struct Added {
    place: V3,
    /// For an auxiliary one a point of the scene.
    anchor: Option<V3>,
}

impl Sites {
    /// Those of the vertices of a tree, which lie in `bounds`, and more; `None` where that takes too much. `teller` is told of
    /// its stages.
    pub(crate) fn new(tree: &PacketTree, bounds: &Aabb<f64>, limits: Limits<'_>, teller: &Teller<'_>) -> Option<Self> {
        let progress = |done, all| teller.reach([5.0, 30.0], done, all);
        let triangulated = |points: &[V3]| {
            teller.begin(BuildStage::Delaunay);
            let delaunay = Delaunay::within(points, BOUNDING_DISTANCE, most_tetrahedra(points.len())).ok();
            teller.begin(BuildStage::Balls);
            delaunay
        };
        let vertices = &tree.leaves.vertices;
        let mut points = vertices.to_vec();
        let mut added: Vec<Added> = Vec::new();
        let mut delaunay = triangulated(&points)?;
        let mut corners = Corners::new(tree, &delaunay, limits, None, &progress);
        for _ in 0..ROUNDS {
            let more = Crowds { tree, corners: &corners, bounds, limits }.added(limits.added - added.len());
            if limits.allowance.is_over() {
                return None;
            }
            if more.is_empty() {
                break;
            }
            points.extend(more.iter().map(|a| a.place));
            let before = points.len() - more.len();
            let Some(next) = triangulated(&points) else {
                points.truncate(before);
                break;
            };
            let known = Known::new(&delaunay, &corners, &next, before);
            let all = Corners::new(tree, &next, limits, Some(&known), &progress);
            let (full, rest) = (corners.full(), all.full());
            added.extend(more);
            (delaunay, corners) = (next, all);
            // Points do not help everywhere: between long thin triangles there would have to be too many.
            if rest * 8 > full * 7 && rest * 16 > corners.all.len() {
                break;
            }
        }
        let corners = corners.finished(tree, limits);
        if limits.allowance.is_over() {
            return None;
        }
        // A site at a point of the scene is no auxiliary one.
        let mut anchors: Vec<(usize, V3)> = Vec::new();
        let mut own = vec![false; delaunay.sites().len()];
        let of_scene = |i: usize| i < vertices.len() || added[i - vertices.len()].anchor.is_none();
        (0..points.len()).filter(|i| of_scene(*i)).for_each(|i| own[delaunay.site_of(i)] = true);
        for (i, point) in (vertices.len()..).zip(&added) {
            let site = delaunay.site_of(i);
            if let Some(anchor) = point.anchor.filter(|_| !own[site]) {
                own[site] = true;
                anchors.push((site, anchor));
            }
        }
        anchors.sort_unstable_by_key(|(site, _)| *site);
        let added = added.iter().filter(|point| point.anchor.is_none()).count();
        Some(Self { delaunay, corners, anchors, added })
    }

    /// How many cells have a corner that is full.
    pub(crate) fn left_to_the_tree(&self) -> usize {
        let mut left = vec![false; self.delaunay.sites().len()];
        for (tetrahedron, corner) in self.delaunay.tetrahedra().iter().zip(&self.corners.all) {
            tetrahedron.iter().for_each(|v| left[*v as usize] |= corner.full);
        }
        left[BOUNDING..].iter().filter(|left| **left).count()
    }

    /// Which of the anchors is that of a site, if it is an auxiliary one.
    pub(crate) fn anchor_of(&self, site: usize) -> Option<usize> {
        self.anchors.binary_search_by_key(&site, |(site, _)| *site).ok()
    }
}

/// Tetrahedra that two triangulations have in common.
struct Known<'a> {
    /// Those of the first,
    corners: &'a Corners,
    /// and their numbers by its sites.
    numbers: HashMap<[u32; 4], usize>,
    /// Of each site of the second the one of the first, or [`Known::NEW`].
    before: Vec<u32>,
}

impl<'a> Known<'a> {
    const NEW: u32 = u32::MAX;

    /// The second one has the points of the first, `points` of them, before its own.
    #[allow(clippy::float_cmp, reason = "the same or not")]
    fn new(first: &Delaunay, corners: &'a Corners, second: &Delaunay, points: usize) -> Self {
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

/// Balls that meet too much.
struct Crowds<'a> {
    tree: &'a PacketTree,
    corners: &'a Corners,
    bounds: &'a Aabb<f64>,
    limits: Limits<'a>,
}

/// A cube of a grid: the exponent of its side, and its place.
type Cube = (i32, [i64; 3]);

/// The cube that has a place, of about `size`.
#[allow(clippy::cast_possible_truncation, reason = "rounded down; a cube that is too far away is another one")]
fn cube(place: &V3, size: f64) -> Cube {
    let exponent = exponent(size);
    (exponent, place.map(|x| (scale_by_power(x, -exponent)).floor() as i64))
}

impl Crowds<'_> {
    /// Points for them, at most `budget`.
    fn added(&self, budget: usize) -> Vec<Added> {
        // Where their centres are, each time the first one and how many there are.
        let mut clusters: HashMap<Cube, (usize, usize)> = HashMap::new();
        for (number, corner) in self.corners.all.iter().enumerate() {
            if corner.full
                && corner.radius > 0.0
                && self.is_near(&corner.place)
                && corner.error < corner.radius * BARELY
            {
                clusters.entry(cube(&corner.place, corner.radius * CLOSE)).or_insert((number, 0)).1 += 1;
            }
        }
        let mut clusters: Vec<(usize, usize)> = clusters.into_values().collect();
        clusters.sort_unstable();
        let mut taken: HashSet<Cube> = HashSet::new();
        let mut added = Vec::new();
        for (number, count) in clusters {
            if added.len() >= budget || self.limits.allowance.is_over() {
                break;
            }
            let corner = &self.corners.all[number];
            let near = self.near(corner);
            let deep = near.partition_point(|(distance, _)| *distance < corner.radius * DEEP);
            if let Some((_, anchor)) = near.first().filter(|_| deep == 0 && count >= CLUSTER) {
                added.push(Added { place: corner.place, anchor: Some(*anchor) });
            }
            for &(distance, place) in &near[..deep] {
                if added.len() < budget && taken.insert(cube(&place, distance.max(corner.radius * LEAST) * APART)) {
                    added.push(Added { place, anchor: None });
                }
            }
        }
        added
    }

    /// Whether a place is in the box of the vertices, or a little beside it.
    fn is_near(&self, place: &V3) -> bool {
        let Aabb { min, max } = self.bounds;
        let pad = (max - min).max() * BESIDE;
        (0..3).all(|k| place[k] >= min[k] - pad && place[k] <= max[k] + pad)
    }

    /// The points of primitives that are nearest to a corner, with their distances, the nearest one first: of some that
    /// meet its ball.
    fn near(&self, corner: &Corner) -> Vec<(f64, V3)> {
        let leaves = &self.tree.leaves;
        let (mut met, mut tests) = (Vec::new(), 0);
        self.tree.ball(corner.place, corner.radius + 2.0 * corner.error, LOOKED_AT, &mut met, &mut tests);
        let mut points = Vec::new();
        for Selection { packet, lanes } in met {
            let packet = &leaves.packets[packet as usize];
            for lane in (0..LANES).filter(|lane| packet.has_vertices() && lanes >> lane & 1 == 1) {
                let mut best = Best::<f64>::new(&QueryOptions::default());
                packet.offer(lane, &leaves.vertices, corner.place, f64::INFINITY, &mut best);
                points.extend(best.finish().map(|closest| (closest.distance, closest.point.coords.into())));
            }
        }
        self.limits.allowance.spend(tests + points.len());
        points.sort_by(|a: &(f64, V3), b| a.0.total_cmp(&b.0));
        points
    }
}
