//! The table of Delaunay neighbours, and the walk from any site to the nearest one.
//!
//! If a site v is not the nearest site to q, then some Delaunay neighbour w of v is nearer than v, which means (q - v)
//! . (w - v) > |w - v|^2 / 2 ([docs/proofs/p2m.md]). The offsets w - v are stored side by side as 16-bit integers,
//! eight to a cache line. The test in f32 bounds its error. Where it cannot decide, the comparison is made in f64 and
//! finally in integers. So a walk ends at a site whose closed cell certainly contains q, and never visits a site
//! twice, since each step leads to a nearer site.
//!
//! [docs/proofs/p2m.md]: https://github.com/p2m-rs/p2m/blob/main/docs/proofs/p2m.md

use crate::voronoi::compare_distances;
use crate::voronoi::neighbour_block::{
    NEIGHBOURS_PER_BLOCK, NeighbourBlock, NeighbourBounds, QueryOffset, UNDERFLOW_MARGIN,
};
use crate::voronoi::site::{FarHalfSpace, Site};
use p2m_core::engine::simd::{InstructionSet, Lanes, prefetch_lines};
use p2m_core::engine::vector::{V3, norm_squared, sub};
use p2m_core::storage::{Array, LoadError, Reader, Writer, check_chunks, require};
use std::cmp::Ordering;

/// The number of blocks of each site that lie at a place computed from its number alone, so that they are fetched
/// together with the site.
const INLINE_BLOCKS: usize = 2;

/// The section with the sites.
pub(crate) const SITES: &str = "voronoi/sites";
/// The section with the blocks of neighbours.
const NEIGHBOURS: &str = "voronoi/neighbours";
/// The section with the numbers of the neighbours.
const NUMBERS: &str = "voronoi/neighbours/names";

/// The sites with their neighbours.
#[derive(Clone, Debug, Default)]
pub(crate) struct NeighbourTable {
    /// The sites, by their numbers.
    pub(crate) sites: Array<Site>,
    /// The blocks of offsets: the inline blocks of all sites, then the further blocks.
    blocks: Array<NeighbourBlock>,
    /// The numbers of the neighbours in each block.
    site_numbers: Array<[u32; NEIGHBOURS_PER_BLOCK]>,
    /// Three times the slack of the corner test, in the units of sites. If all other sites are farther than the
    /// nearest one by this much, their primitives cannot tie with it.
    slack: f32,
}

/// The end of a walk.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LocatedSite {
    /// The nearest site.
    pub(crate) site: usize,
    /// Whether the site is certainly the nearest point on all primitives that have it as a vertex, with the lead over
    /// the other sites that its far half-space needs.
    pub(crate) is_certainly_nearest: bool,
}

impl NeighbourTable {
    /// Builds the table. `list_neighbours` appends the Delaunay neighbours of a site to its first list, and the sites
    /// at the other ends of edges of primitives to its second. Sites below `first` have no neighbours.
    #[allow(clippy::cast_possible_truncation, reason = "rounded down")]
    pub(crate) fn new(
        positions: &[V3],
        first: usize,
        slack: f64,
        mut list_neighbours: impl FnMut(usize, &mut Vec<u32>, &mut Vec<u32>),
    ) -> Self {
        let mut blocks = vec![NeighbourBlock::EMPTY; INLINE_BLOCKS * positions.len()];
        let mut site_numbers = vec![[0; NEIGHBOURS_PER_BLOCK]; INLINE_BLOCKS * positions.len()];
        let mut sites = Vec::with_capacity(positions.len());
        let (mut all, mut edges, mut sorted) = (Vec::new(), Vec::new(), Vec::new());
        for (number, position) in positions.iter().enumerate() {
            let mut site = Site {
                position: *position,
                half_next_distance: 0.0,
                first_further_block: u32::try_from(blocks.len()).expect("numbers of 32 bits"),
                block_count: 0,
                far_half_space: FarHalfSpace::NONE,
                owner: 0,
                list: 0,
            };
            if number >= first {
                all.clear();
                edges.clear();
                list_neighbours(number, &mut all, &mut edges);
                edges.sort_unstable();
                all.extend_from_slice(&edges);
                all.sort_unstable();
                all.dedup();
                sorted.clear();
                sorted.extend(all.iter().map(|v| (norm_squared(sub(positions[*v as usize], *position)), *v)));
                sorted.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
                let further =
                    sorted.get(INLINE_BLOCKS * NEIGHBOURS_PER_BLOCK).map_or(0.0, |(square, _)| square.sqrt() * 0.5);
                site.half_next_distance = (further * (1.0 - 1e-6)) as f32;
                all.clear();
                all.extend(sorted.iter().map(|s| s.1));
                site.block_count = u32::try_from(all.len().div_ceil(NEIGHBOURS_PER_BLOCK)).expect("few neighbours");
                for (i, chunk) in all.chunks(NEIGHBOURS_PER_BLOCK).enumerate() {
                    let block = NeighbourBlock::new(positions, number, chunk, |v| edges.binary_search(&v).is_ok());
                    let numbers = std::array::from_fn(|lane| chunk[lane.min(chunk.len() - 1)]);
                    if i < INLINE_BLOCKS {
                        (blocks[INLINE_BLOCKS * number + i], site_numbers[INLINE_BLOCKS * number + i]) =
                            (block, numbers);
                    } else {
                        blocks.push(block);
                        site_numbers.push(numbers);
                    }
                }
            }
            sites.push(site);
        }
        blocks.shrink_to_fit();
        site_numbers.shrink_to_fit();
        Self {
            sites: sites.into(),
            blocks: blocks.into(),
            site_numbers: site_numbers.into(),
            slack: (slack * 3.0) as f32,
        }
    }

    /// Walks from a site to the site nearest to `query`. `on_site` is called with each site before it is read.
    ///
    /// A walk never visits a site twice, since each step leads to a nearer one, so it reads no block twice. Only a
    /// table from a file with wrong offsets can stop it by the [limit](Self::max_walk_work) on its work.
    #[inline(always)]
    pub(crate) fn walk<I: InstructionSet>(
        &self,
        from: usize,
        query: &V3,
        mut on_site: impl FnMut(usize),
    ) -> LocatedSite {
        let mut at = from;
        let mut work_left = self.max_walk_work();
        loop {
            self.prefetch(at);
            on_site(at);
            let (next, is_certainly_nearest) = self.step::<I>(at, query);
            if next == at {
                return LocatedSite { site: at, is_certainly_nearest };
            }
            work_left = work_left.saturating_sub(self.step_work(at));
            if work_left == 0 {
                return LocatedSite { site: at, is_certainly_nearest: false };
            }
            at = next;
        }
    }

    /// Returns an upper bound on the work of a walk: one more than the work of visiting every site.
    #[inline(always)]
    pub(crate) fn max_walk_work(&self) -> usize {
        self.blocks.len() + 1
    }

    /// Returns the work of a step from a site, at most the number of its blocks.
    #[inline(always)]
    pub(crate) fn step_work(&self, at: usize) -> usize {
        (self.sites[at].block_count as usize).max(1)
    }

    /// Prefetches the memory that a step from a site reads.
    #[inline(always)]
    pub(crate) fn prefetch(&self, at: usize) {
        prefetch_lines(self.sites.as_ptr().wrapping_add(at), size_of::<Site>());
        prefetch_lines(
            self.blocks.as_ptr().wrapping_add(INLINE_BLOCKS * at),
            INLINE_BLOCKS * size_of::<NeighbourBlock>(),
        );
    }

    /// Takes one step. Returns a nearer site, which is the nearest neighbour as far as f32 can decide, or the same site
    /// if no neighbour is nearer. The flag is the [`LocatedSite::is_certainly_nearest`] of a walk that ends here.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "rounding is allowed for")]
    pub(crate) fn step<I: InstructionSet>(&self, at: usize, query: &V3) -> (usize, bool) {
        let site = &self.sites[at];
        let exact_offset = sub(*query, site.position);
        let offset = [exact_offset[0] as f32, exact_offset[1] as f32, exact_offset[2] as f32];
        let square = offset[0] * offset[0] + offset[1] * offset[1] + offset[2] * offset[2];
        let size = (offset[0].abs() + offset[1].abs() + offset[2].abs()) * (1.0 + 4.0 * f32::EPSILON);
        let query_offset = QueryOffset {
            offset,
            size,
            square,
            tie: size * self.slack + UNDERFLOW_MARGIN,
            relative_lead: site.far_half_space.relative_lead,
        };
        let mut next = WalkStep { at, best: at, best_gain: 0.0, ties: 0 };
        let block_count = site.block_count as usize;
        let mut i = 0;
        while i < block_count.min(INLINE_BLOCKS) {
            next.consider_block::<I>(self, INLINE_BLOCKS * at + i, query, &query_offset);
            i += 1;
        }
        if block_count > INLINE_BLOCKS {
            // A query nearer to the site than half the distance to a neighbour is farther from this neighbour.
            if square < site.half_next_distance * site.half_next_distance * (1.0 - 1e-5) {
                next.ties = 1;
            } else {
                for block in
                    site.first_further_block as usize..site.first_further_block as usize + block_count - INLINE_BLOCKS
                {
                    next.consider_block::<I>(self, block, query, &query_offset);
                }
            }
        }
        (next.best, next.ties == 0)
    }

    /// Decides exactly whether one site is nearer to the query than another one. Called rarely, so it is kept out of
    /// the loop.
    #[cold]
    #[inline(never)]
    fn is_nearer(&self, query: &V3, site: usize, than: usize) -> bool {
        compare_distances::compare(query, &self.sites[site].position, &self.sites[than].position) == Ordering::Less
    }

    /// Adds the table to a file.
    pub(crate) fn save<'a>(&'a self, writer: &mut Writer<'a>) {
        writer.put(SITES, &self.sites);
        writer.put(NEIGHBOURS, &self.blocks);
        writer.put(NUMBERS, &self.site_numbers);
        writer.put_copy("voronoi/neighbours/slack", &[self.slack]);
    }

    /// Loads the table from a file.
    pub(crate) fn load(reader: &Reader) -> Result<Self, LoadError> {
        let table = Self {
            sites: reader.array(SITES)?,
            blocks: reader.array(NEIGHBOURS)?,
            site_numbers: reader.array(NUMBERS)?,
            slack: reader.one("voronoi/neighbours/slack")?,
        };
        let (sites, blocks) = (table.sites.len(), table.blocks.len());
        require(table.site_numbers.len() == blocks, NUMBERS, "there are not the numbers of all blocks")?;
        require(blocks >= INLINE_BLOCKS * sites, NEIGHBOURS, "there are not the blocks of all sites")?;
        // The further blocks of all sites lie one after the other, so that no block belongs to two sites.
        let mut end = INLINE_BLOCKS * sites;
        for site in table.sites.iter() {
            let further = (site.block_count as usize).saturating_sub(INLINE_BLOCKS);
            require(site.first_further_block as usize == end, NEIGHBOURS, "a block belongs to another site")?;
            require(further <= blocks - end, NEIGHBOURS, "a block does not exist")?;
            end += further;
        }
        require(end == blocks, NEIGHBOURS, "a block belongs to no site")?;
        check_chunks(&table.blocks, |_, chunk| {
            let are_unused = chunk.iter().all(|block| block.unused == [0; 2]);
            require(are_unused, NEIGHBOURS, "a number that has no use is not 0")
        })?;
        check_chunks(&table.site_numbers, |_, chunk| {
            // A fold without an early end is computed in lanes.
            let last = chunk.as_flattened().iter().fold(0, |last: u32, site| last.max(*site));
            require((last as usize) < sites, NUMBERS, "a site does not exist")
        })?;
        Ok(table)
    }

    /// Returns the heap memory in bytes.
    pub(crate) fn memory(&self) -> usize {
        self.sites.memory() + self.blocks.memory() + self.site_numbers.memory()
    }
}

/// One step of a walk.
struct WalkStep {
    /// The site from which the step begins.
    at: usize,
    /// The nearest site so far.
    best: usize,
    /// The gain of `best` over `at`, as far as f32 can decide.
    best_gain: f32,
    /// The bits of neighbours and edges that prevent [`LocatedSite::is_certainly_nearest`]. It is 0 if there are none.
    ties: u32,
}

impl WalkStep {
    /// Tests the neighbours of a block.
    #[inline(always)]
    fn consider_block<I: InstructionSet>(
        &mut self,
        table: &NeighbourTable,
        block: usize,
        query: &V3,
        query_offset: &QueryOffset,
    ) {
        let NeighbourBounds { gains, margins, ties, edges }: NeighbourBounds<I::F32x8> =
            table.blocks[block].bound_query(query_offset);
        self.ties |= ties | edges;
        // The open neighbours are those that are not certainly farther.
        let mut open = I::F32x8::splat(0.0).sub(margins).at_most(gains);
        if open == 0 {
            return;
        }
        let (mut all, mut off) = ([0.0; NEIGHBOURS_PER_BLOCK], [0.0; NEIGHBOURS_PER_BLOCK]);
        gains.store(&mut all);
        margins.store(&mut off);
        while open != 0 {
            let lane = open.trailing_zeros() as usize;
            open &= open - 1;
            let (other, certain) = (table.site_numbers[block][lane] as usize, all[lane] > off[lane]);
            if all[lane] > self.best_gain && certain {
                (self.best, self.best_gain) = (other, all[lane]);
            } else if self.best == self.at && !certain && table.is_nearer(query, other, self.at) {
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

    struct LocateSite<'a>(&'a NeighbourTable, usize, &'a V3);

    impl SimdKernel for LocateSite<'_> {
        type Output = LocatedSite;
        #[inline(always)]
        fn run<I: InstructionSet>(self) -> LocatedSite {
            self.0.walk::<I>(self.1, self.2, |_| ())
        }
    }

    fn neighbour_table(points: &[V3]) -> NeighbourTable {
        let delaunay = Delaunay::new(points, 250.0).expect("finite");
        let mut neighbours = vec![BTreeSet::new(); delaunay.sites().len()];
        for tetrahedron in delaunay.tetrahedra() {
            for v in tetrahedron {
                neighbours[*v as usize].extend(tetrahedron.iter().filter(|w| *w != v && **w as usize >= BOUNDING));
            }
        }
        NeighbourTable::new(delaunay.sites(), BOUNDING, 1e-12, |site, all, _| all.extend(&neighbours[site]))
    }

    /// The sites are random positions, clusters of all sizes and lattices. The queries are anywhere, on sites and in
    /// the middle between two.
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
            let table = neighbour_table(&points);
            let sites = &table.sites;
            for _ in 0..200 {
                let mut some = || rng.random_range(BOUNDING..sites.len());
                let (a, b, from) = (some(), some(), some());
                let (p, q) = (sites[a].position, sites[b].position);
                let query: V3 = match rng.random_range(0..4) {
                    0 => p,
                    1 => std::array::from_fn(|k| (p[k] + q[k]) * 0.5),
                    2 => std::array::from_fn(|k| p[k] + rng.random_range(-1.0..1.0) * 2f64.powi(-(k as i32) * 9)),
                    _ => std::array::from_fn(|_| rng.random_range(-5.0..5.0)),
                };
                for isa in Isa::available() {
                    let found = isa.run(LocateSite(&table, from, &query));
                    for (other, site) in sites.iter().enumerate().skip(BOUNDING) {
                        let compared = compare_distances::compare(&query, &sites[found.site].position, &site.position);
                        assert_ne!(compared, Ordering::Greater, "{isa}, round {round}: {query:?} {other}");
                        ties += usize::from(other != found.site && compared == Ordering::Equal);
                        // Then no other site is as near.
                        let gap = norm_squared(sub(query, site.position))
                            - norm_squared(sub(query, sites[found.site].position));
                        assert!(other == found.site || !found.is_certainly_nearest || gap > 0.0);
                    }
                    close += usize::from(found.is_certainly_nearest);
                }
            }
        }
        // Each instruction set answers all queries.
        let sets = Isa::available().len();
        assert!(cases.have_more_than(670 * sets, ties) && cases.have_more_than(6_700 * sets, close), "{ties} {close}");
    }
}
