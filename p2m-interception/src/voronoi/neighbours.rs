//! From a site to the nearest one: the walk over Delaunay neighbours.
//!
//! If a site v is not the nearest one to q, some Delaunay neighbour w of it is nearer: (q - v) . (w - v) > |w - v|^2 /
//! 2 (docs/proofs/p2m.md). The ways w - v lie side by side as whole numbers of 16 bits, eight to a cache line. Where their
//! products do not tell, f64 does, and integers at last; so a walk ends at a site that certainly has q in its closed
//! cell, and never runs in a circle, for each step is one to a nearer site.

use crate::voronoi::compare_distances;
use crate::voronoi::neighbour_block::{Fan, Offset, Said, TINY, WIDTH};
use crate::voronoi::site::{Outside, Site};
use p2m_core::engine::simd::{InstructionSet, Lanes, prefetch_lines};
use p2m_core::engine::vector::{V3, norm_squared, sub};
use p2m_core::storage::{Array, LoadError, Reader, Writer};
use std::cmp::Ordering;

/// Blocks of each site that are found by its number.
const FIXED: usize = 2;

/// The sites, with their neighbours.
#[derive(Clone, Debug, Default)]
pub(crate) struct Fans {
    pub(crate) sites: Array<Site>,
    blocks: Array<Fan>,
    /// The neighbours of each block.
    names: Array<[u32; WIDTH]>,
    /// By how much more than the nearest site others have to be farther away, for their primitives not to tie: three
    /// times the slack, in the units of sites.
    slack: f32,
}

/// Where a walk ends.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Found {
    pub(crate) site: usize,
    /// Whether the site is certainly the nearest point of all primitives that have it as a vertex, and no other site
    /// nearly as near.
    pub(crate) is_nearest: bool,
}

impl Fans {
    /// The blocks of all sites: `others` gives the neighbours of each, and those along edges of primitives.
    #[allow(clippy::cast_possible_truncation, reason = "rounded down")]
    pub(crate) fn new(
        places: &[V3],
        first: usize,
        slack: f64,
        mut others: impl FnMut(usize, &mut Vec<u32>, &mut Vec<u32>),
    ) -> Self {
        let mut blocks = vec![Fan::EMPTY; FIXED * places.len()];
        let mut names = vec![[0; WIDTH]; FIXED * places.len()];
        let mut sites = Vec::with_capacity(places.len());
        let (mut all, mut edges, mut sorted) = (Vec::new(), Vec::new(), Vec::new());
        for (number, place) in places.iter().enumerate() {
            let mut site = Site {
                place: *place,
                near: 0.0,
                more: u32::try_from(blocks.len()).expect("numbers of 32 bits"),
                count: 0,
                outside: Outside::NONE,
                owner: 0,
                list: 0,
            };
            if number >= first {
                all.clear();
                edges.clear();
                others(number, &mut all, &mut edges);
                edges.sort_unstable();
                all.extend_from_slice(&edges);
                all.sort_unstable();
                all.dedup();
                sorted.clear();
                sorted.extend(all.iter().map(|v| (norm_squared(sub(places[*v as usize], *place)), *v)));
                sorted.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
                let further = sorted.get(FIXED * WIDTH).map_or(0.0, |(square, _)| square.sqrt() * 0.5);
                site.near = (further * (1.0 - 1e-6)) as f32;
                all.clear();
                all.extend(sorted.iter().map(|s| s.1));
                site.count = u32::try_from(all.len().div_ceil(WIDTH)).expect("few neighbours");
                for (i, chunk) in all.chunks(WIDTH).enumerate() {
                    let fan = Fan::new(places, number, chunk, |v| edges.binary_search(&v).is_ok());
                    let own = std::array::from_fn(|lane| chunk[lane.min(chunk.len() - 1)]);
                    if i < FIXED {
                        (blocks[FIXED * number + i], names[FIXED * number + i]) = (fan, own);
                    } else {
                        blocks.push(fan);
                        names.push(own);
                    }
                }
            }
            sites.push(site);
        }
        blocks.shrink_to_fit();
        names.shrink_to_fit();
        Self { sites: sites.into(), blocks: blocks.into(), names: names.into(), slack: (slack * 3.0) as f32 }
    }

    /// From a site to the nearest one to `query`; `ahead` is told of every site on the way before it is looked at.
    #[inline(always)]
    pub(crate) fn walk<I: InstructionSet>(&self, from: usize, query: &V3, mut ahead: impl FnMut(usize)) -> Found {
        let mut at = from;
        loop {
            self.prefetch(at);
            ahead(at);
            let (next, is_nearest) = self.step::<I>(at, query);
            if next == at {
                return Found { site: at, is_nearest };
            }
            at = next;
        }
    }

    /// Asks for what a step reads.
    #[inline(always)]
    pub(crate) fn prefetch(&self, at: usize) {
        prefetch_lines(self.sites.as_ptr().wrapping_add(at), size_of::<Site>());
        prefetch_lines(self.blocks.as_ptr().wrapping_add(FIXED * at), FIXED * size_of::<Fan>());
    }

    /// A nearer site than this one, the nearest of its neighbours as far as f32 tells; or the same if there is none,
    /// and what [`Found::is_nearest`] says.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "rounding is allowed for")]
    pub(crate) fn step<I: InstructionSet>(&self, at: usize, query: &V3) -> (usize, bool) {
        let site = &self.sites[at];
        let d = sub(*query, site.place);
        let way = [d[0] as f32, d[1] as f32, d[2] as f32];
        let square = way[0] * way[0] + way[1] * way[1] + way[2] * way[2];
        let size = (way[0].abs() + way[1].abs() + way[2].abs()) * (1.0 + 4.0 * f32::EPSILON);
        let d = Offset { way, size, square, tie: size * self.slack + TINY, part: site.outside.part };
        let mut next = Next { at, best: at, most: 0.0, ties: 0 };
        let count = site.count as usize;
        let mut i = 0;
        while i < count.min(FIXED) {
            next.look::<I>(self, FIXED * at + i, query, &d);
            i += 1;
        }
        if count > FIXED {
            // Nearer than half the way to a neighbour that one is farther.
            if square < site.near * site.near * (1.0 - 1e-5) {
                next.ties = 1;
            } else {
                for block in site.more as usize..site.more as usize + count - FIXED {
                    next.look::<I>(self, block, query, &d);
                }
            }
        }
        (next.best, next.ties == 0)
    }

    /// Whether one site is nearer than another.
    #[cold]
    #[inline(never)]
    fn is_nearer(&self, query: &V3, site: usize, than: usize) -> bool {
        compare_distances::compare(query, &self.sites[site].place, &self.sites[than].place) == Ordering::Less
    }

    pub(crate) fn save<'a>(&'a self, writer: &mut Writer<'a>) {
        writer.put("voronoi/sites", &self.sites);
        writer.put("voronoi/neighbours", &self.blocks);
        writer.put("voronoi/neighbours/names", &self.names);
        writer.put_copy("voronoi/neighbours/slack", &[self.slack]);
    }

    pub(crate) fn load(reader: &Reader) -> Result<Self, LoadError> {
        let fans = Self {
            sites: reader.array("voronoi/sites")?,
            blocks: reader.array("voronoi/neighbours")?,
            names: reader.array("voronoi/neighbours/names")?,
            slack: reader.one("voronoi/neighbours/slack")?,
        };
        let fits = fans.names.len() == fans.blocks.len() && fans.blocks.len() >= FIXED * fans.sites.len();
        if fits { Ok(fans) } else { Err(LoadError::Inconsistent { section: "voronoi/neighbours".to_owned() }) }
    }

    /// Heap memory, in bytes.
    pub(crate) fn memory(&self) -> usize {
        self.sites.memory() + self.blocks.memory() + self.names.memory()
    }
}

/// The way on from a site.
struct Next {
    at: usize,
    best: usize,
    /// The gain of the best one, if f32 can tell.
    most: f32,
    /// Not zero if something else may be as near as the site.
    ties: u32,
}

impl Next {
    #[inline(always)]
    fn look<I: InstructionSet>(&mut self, fans: &Fans, block: usize, query: &V3, d: &Offset) {
        let Said { gains, margins, ties, edges }: Said<I::Eight> = fans.blocks[block].says(d);
        self.ties |= ties | edges;
        // Neighbours that are not certainly farther.
        let mut open = I::Eight::splat(0.0).sub(margins).at_most(gains);
        if open == 0 {
            return;
        }
        let (mut all, mut off) = ([0.0; WIDTH], [0.0; WIDTH]);
        gains.store(&mut all);
        margins.store(&mut off);
        while open != 0 {
            let lane = open.trailing_zeros() as usize;
            open &= open - 1;
            let (other, certain) = (fans.names[block][lane] as usize, all[lane] > off[lane]);
            if all[lane] > self.most && certain {
                (self.best, self.most) = (other, all[lane]);
            } else if self.best == self.at && !certain && fans.is_nearer(query, other, self.at) {
                self.best = other;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::delaunay::{BOUNDING, Delaunay};
    use p2m_core::engine::simd::{Isa, SimdKernel};
    use rand::RngExt;
    use std::collections::BTreeSet;

    struct Walk<'a>(&'a Fans, usize, &'a V3);

    impl SimdKernel for Walk<'_> {
        type Output = Found;
        #[inline(always)]
        fn run<I: InstructionSet>(self) -> Found {
            self.0.walk::<I>(self.1, self.2, |_| ())
        }
    }

    fn fans(points: &[V3]) -> Fans {
        let delaunay = Delaunay::new(points, 250.0).expect("finite");
        let mut neighbours = vec![BTreeSet::new(); delaunay.sites().len()];
        for tetrahedron in delaunay.tetrahedra() {
            for v in tetrahedron {
                neighbours[*v as usize].extend(tetrahedron.iter().filter(|w| *w != v && **w as usize >= BOUNDING));
            }
        }
        Fans::new(delaunay.sites(), BOUNDING, 1e-12, |site, all, _| all.extend(&neighbours[site]))
    }

    /// Random places, clusters of all sizes and lattices; queries anywhere, on sites and in the middle of two.
    #[test]
    fn walks_end_at_the_nearest_site_wherever_they_begin() {
        let (mut ties, mut close) = (0, 0);
        let cases = p2m_testkit::cases(60, 30);
        for case in cases.clone() {
            let (round, mut rng) = (case as usize, p2m_testkit::rng("walks", case));
            let count = [1, 2, 5, 30, 200][round % 5];
            let spread = rng.random_range(0..30);
            let points: Vec<V3> = (0..count)
                .map(|_| match round % 3 {
                    0 => std::array::from_fn(|_| rng.random_range(-1.0..1.0)),
                    1 => std::array::from_fn(|_| f64::from(rng.random_range(-3..=3)) / 4.0),
                    _ => {
                        let size = 2f64.powi(-rng.random_range(0..=spread));
                        std::array::from_fn(|k| 0.3 * k as f64 + rng.random_range(-1.0..1.0) * size)
                    }
                })
                .collect();
            let fans = fans(&points);
            let sites = &fans.sites;
            for _ in 0..200 {
                let mut some = || rng.random_range(BOUNDING..sites.len());
                let (a, b, from) = (some(), some(), some());
                let (p, q) = (sites[a].place, sites[b].place);
                let query: V3 = match rng.random_range(0..4) {
                    0 => p,
                    1 => std::array::from_fn(|k| (p[k] + q[k]) * 0.5),
                    2 => std::array::from_fn(|k| p[k] + rng.random_range(-1.0..1.0) * 2f64.powi(-(k as i32) * 9)),
                    _ => std::array::from_fn(|_| rng.random_range(-5.0..5.0)),
                };
                for isa in Isa::available() {
                    let found = isa.run(Walk(&fans, from, &query));
                    for (other, site) in sites.iter().enumerate().skip(BOUNDING) {
                        let compared = compare_distances::compare(&query, &sites[found.site].place, &site.place);
                        assert_ne!(compared, Ordering::Greater, "{isa}, round {round}: {query:?} {other}");
                        ties += usize::from(other != found.site && compared == Ordering::Equal);
                        // No other site is nearly as near, then.
                        let gap =
                            norm_squared(sub(query, site.place)) - norm_squared(sub(query, sites[found.site].place));
                        assert!(other == found.site || !found.is_nearest || gap > 0.0);
                    }
                    close += usize::from(found.is_nearest);
                }
            }
        }
        assert!(cases.have_more_than(2_000, ties) && cases.have_more_than(20_000, close), "{ties} {close}");
    }
}
