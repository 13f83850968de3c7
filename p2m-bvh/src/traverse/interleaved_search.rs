//! The state of interleaved searches for the nearest primitive, with the filters of their packets.
//!
//! A single search spends much of its time on mispredicted branches, and on the latency of memory and of divisions. The
//! basic idea is to run sixteen searches step by step, each step for all searches before the next one (decision 048). A
//! step is a loop over packets or candidates with a long body without such branches, so the processor works on several
//! iterations at a time. Memory that a step needs is prefetched in the step before.
//!
//! A round goes as follows. Each search names a packet ([`PacketVisit`]). All query points are converted to the frames
//! of their packets; optionally a plane in front of each query excludes far lanes; the filters run; the limits of all
//! searches are updated; and the lanes within the limits become candidates. At the end, or once a search has many
//! candidates, the kernel evaluates them eight at a time, and offers them to the collectors.

use crate::packet::{LANES, Locals, PLACES, ROUND_UP, at_most, smallest};
use crate::traverse::evaluate::offer;
use crate::traverse::primitive_fn::EvaluateFn;
use crate::tree::Leaves;
use crate::tree::frame::Frame;
use p2m_core::engine::query::BestF64;
use p2m_core::engine::side_by_side::{LaneResults, SIDE_BY_SIDE, TriangleLanes, evaluate_segments, evaluate_triangles};
use p2m_core::engine::simd::{Doubles, Float, InstructionSet, Lanes, SimdKernel};
use p2m_core::engine::vector::V3;
use p2m_core::{Collector, Isa, PrimitiveId};

/// The number of interleaved searches. With more of them, searches displace each other's packets and nodes from the
/// cache; with fewer, few searches share a packet. It was tuned on dragon_100k (decision 048).
pub const SEARCHES: usize = PLACES;
/// The number of candidates of a search from which on they are evaluated at once. There is no record of how it was
/// tuned.
const MAX_CANDIDATES: u32 = 32;
/// The capacity for candidates. All lanes that pass a filter are added before the number is checked.
const CANDIDATE_ROOM: usize = SEARCHES * (MAX_CANDIDATES as usize + LANES);

/// A visit of a packet by a search.
#[derive(Clone, Copy, Debug, Default)]
pub struct PacketVisit {
    /// The number of the search.
    pub search: u32,
    /// The number of the packet.
    pub packet: u32,
    /// One bit per lane: whether it may hold the answer.
    pub lanes: u32,
}

/// A primitive that may be the answer of a search.
#[derive(Clone, Copy, Default)]
struct Candidate {
    /// A lower bound on the distance of the primitive, in the frame of the tree.
    lower_bound: f32,
    search: u32,
    packet: u32,
    lane: u32,
}

/// The limits of the searches whose packets are filtered, stored as rows.
#[derive(Default)]
struct LimitRows {
    /// The distances above which primitives are not candidates.
    candidate: [f64; SEARCHES],
    /// The smallest square that the filter of each packet found, in the packet's frame. It is infinite for a packet of
    /// boxes, whose filter gives no upper bounds.
    nearest_square: [f32; SEARCHES],
    /// The squares of the distances above which nodes are skipped, in the frame of the tree.
    node: [f32; SEARCHES],
    /// The distances above which primitives are not candidates, in the frames of the packets.
    limit: [f32; SEARCHES],
    /// The limits before the filters, in the frames of the packets.
    old_limit: [f32; SEARCHES],
}

impl LimitRows {
    /// Converts the limits before the filters to the frames of the packets.
    #[inline(always)]
    fn convert<I: InstructionSet>(&mut self, locals: &Locals) {
        let mut at = 0;
        while at < SEARCHES {
            let candidate = I::Doubles::load(&self.candidate[at..]);
            (candidate * I::Doubles::load(&locals.per_unit[at..])).store_f32(&mut self.old_limit[at..]);
            at += 8;
        }
        let mut at = 0;
        while at < SEARCHES {
            let limit = I::Wide::load(&self.old_limit[at..]).add(I::Wide::load(&locals.excess[at..]));
            limit.mul(I::Wide::splat(ROUND_UP)).store(&mut self.old_limit[at..]);
            at += I::Wide::LEN;
        }
    }

    /// Computes the limits after the filters from the limits before them and the smallest squares.
    #[inline(always)]
    fn update<I: InstructionSet>(&mut self, locals: &Locals, frame: &Frame) {
        let mut nearest = [0.0; SEARCHES];
        let up = I::Wide::splat(ROUND_UP);
        let mut at = 0;
        while at < SEARCHES {
            let root = I::Wide::load(&self.nearest_square[at..]).sqrt();
            root.add(I::Wide::load(&locals.deficit[at..])).mul(up).store(&mut nearest[at..]);
            at += I::Wide::LEN;
        }
        let mut at = 0;
        while at < SEARCHES {
            let candidate = I::Doubles::load(&self.candidate[at..]);
            let upper_bound = I::Doubles::load_f32(&nearest[at..]) * I::Doubles::load(&locals.unit[at..]);
            upper_bound.min(candidate).store(&mut self.candidate[at..]);
            frame.squares_above::<I::Doubles>(upper_bound, &mut self.node[at..]);
            at += 8;
        }
        let mut at = 0;
        while at < SEARCHES {
            let excess = I::Wide::load(&locals.excess[at..]);
            let new = I::Wide::load(&nearest[at..]).add(excess).mul(up);
            new.min(I::Wide::load(&self.old_limit[at..])).store(&mut self.limit[at..]);
            at += I::Wide::LEN;
        }
    }
}

/// The limits of a search.
#[derive(Clone, Copy)]
struct Limits {
    query: V3,
    /// The distance above which primitives are not candidates.
    candidate: f64,
    /// The square of the distance above which packets are skipped, in the frame of the tree.
    node: f32,
}

/// The part of the state that the evaluation of candidates needs.
struct Searches<'a> {
    leaves: &'a Leaves,
    /// The frame of the tree.
    frame: &'a Frame,
    isa: Isa,
    /// The function that searches the whole tree for one query.
    search_tree: SearchTreeFn<'a>,
    /// Evaluates primitives without stored vertices.
    evaluate: EvaluateSearchFn<'a>,
    limits: [Limits; SEARCHES],
    minimums: [BestF64; SEARCHES],
}

impl Searches<'_> {
    /// Offers results to the collectors of their searches. Results that are not certain are computed by the kernel for
    /// single primitives.
    #[inline(always)]
    fn take(&mut self, candidates: &[Candidate], found: &LaneResults) {
        for (i, candidate) in candidates.iter().enumerate() {
            if found.was_skipped(i) {
                continue;
            }
            let id = self.leaves.packets[candidate.packet as usize].ids()[candidate.lane as usize];
            if !self.minimums[candidate.search as usize].offer_lane(id, found, i) {
                self.offer_single(*candidate);
            }
        }
    }

    /// Evaluates a candidate with the kernel for single primitives.
    #[inline(never)]
    fn offer_single(&mut self, candidate: Candidate) {
        let (search, lane) = (candidate.search as usize, candidate.lane as usize);
        let packet = &self.leaves.packets[candidate.packet as usize];
        let (minimum, evaluate) = (&mut self.minimums[search], self.evaluate);
        let square = minimum.prune_above();
        let evaluate = |collector: &mut BestF64, id, square| evaluate(search, collector, id, square);
        offer(self.leaves, packet, lane, self.limits[search].query, square, minimum, &evaluate);
    }
}

/// The state of interleaved searches. It is large, so a batch creates it once and uses it for all of its queries.
pub struct InterleavedSearch<'a> {
    searches: Searches<'a>,
    candidates: [Candidate; CANDIDATE_ROOM],
    candidate_count: usize,
    /// The number of candidates of each search.
    counts: [u32; SEARCHES],
    /// One bit per search: whether its candidates are evaluated after the filters of this round. These are searches
    /// with many candidates, and searches whose packet has boxes, which are limited by evaluations alone. A bit depends
    /// on its search alone, so answers, including their lower bounds, do not depend on the other searches.
    early: u32,
    locals: Locals,
    rows: LimitRows,
    /// The squared distances that the filters found, in the frames of their packets.
    squares: [[f32; LANES]; SEARCHES],
    triangles: LaneQueue<3>,
    segments: LaneQueue<2>,
}

/// A function that offers a primitive to the collector of a search, which is given by its number, unless the key
/// exceeds a square. It is called for primitives without stored vertices.
pub(crate) type EvaluateSearchFn<'a> = &'a dyn Fn(usize, &mut BestF64, PrimitiveId, f64);

/// A function that searches the whole tree for one query.
pub(crate) type SearchTreeFn<'a> = &'a dyn Fn(V3, &mut BestF64, EvaluateFn<'_, BestF64>);

/// A factor that rounds up bounds that are computed in f64 with a few roundings.
pub(super) const ROUND_UP_F64: f64 = 1.0 + 4.0 * f64::EPSILON;

impl<'a> InterleavedSearch<'a> {
    /// Creates the state of searches that have not begun. `template` is a collector without a candidate.
    pub fn new(
        leaves: &'a Leaves,
        frame: &'a Frame,
        isa: Isa,
        search_tree: SearchTreeFn<'a>,
        template: &BestF64,
        evaluate: EvaluateSearchFn<'a>,
    ) -> Self {
        Self {
            searches: Searches {
                leaves,
                frame,
                isa,
                search_tree,
                evaluate,
                limits: [Limits { query: [0.0; 3], candidate: 0.0, node: 0.0 }; SEARCHES],
                minimums: std::array::from_fn(|_| template.clone()),
            },
            candidates: [Candidate::default(); CANDIDATE_ROOM],
            candidate_count: 0,
            counts: [0; SEARCHES],
            early: 0,
            locals: Locals::default(),
            rows: LimitRows::default(),
            squares: [[0.0; LANES]; SEARCHES],
            triangles: LaneQueue::default(),
            segments: LaneQueue::default(),
        }
    }

    /// Begins the search with this number for the nearest primitive to `query`. Its collector has to be set before.
    #[inline(always)]
    pub fn begin(&mut self, search: usize, query: V3) {
        self.searches.limits[search] = Limits { query, candidate: f64::INFINITY, node: f32::INFINITY };
        self.update_limit(search);
    }

    /// Limits a search by an upper bound on the distance of its nearest primitive.
    #[inline(always)]
    pub fn limit_to(&mut self, search: usize, upper_bound: f64) {
        let limits = &mut self.searches.limits[search];
        limits.candidate = if upper_bound < limits.candidate { upper_bound } else { limits.candidate };
        let node = self.searches.frame.square_above(upper_bound * upper_bound * ROUND_UP_F64);
        limits.node = if node < limits.node { node } else { limits.node };
    }

    /// Returns the collectors of the searches.
    #[inline(always)]
    pub fn minimums(&mut self) -> &mut [BestF64; SEARCHES] {
        &mut self.searches.minimums
    }

    /// Returns the query point of a search.
    #[inline(always)]
    pub fn query(&self, search: usize) -> &V3 {
        &self.searches.limits[search].query
    }

    /// Tightens the limits of a search to its collector's.
    #[inline(always)]
    fn update_limit(&mut self, search: usize) {
        let prune = self.searches.minimums[search].prune_above();
        let limits = &mut self.searches.limits[search];
        let bound = prune.sqrt() * ROUND_UP_F64;
        limits.candidate = if limits.candidate < bound { limits.candidate } else { bound };
        let square = limits.candidate * limits.candidate * ROUND_UP_F64;
        let node = self.searches.frame.square_above(if square < prune { square } else { prune });
        limits.node = if node < limits.node { node } else { limits.node };
    }

    /// Returns the square of the distance above which a search skips packets, in the frame of the tree.
    #[inline(always)]
    pub fn limit(&self, search: usize) -> f32 {
        self.searches.limits[search].node
    }

    /// Adds a primitive that is evaluated without a filter.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "searches, packets and lanes fit")]
    pub fn add(&mut self, search: usize, packet: usize, lane: usize) {
        let candidate = Candidate { lower_bound: 0.0, search: search as u32, packet: packet as u32, lane: lane as u32 };
        self.candidates[self.candidate_count] = candidate;
        self.candidate_count += 1;
    }

    /// Answers one of the queries by a search of the whole tree, apart from this state.
    #[cold]
    #[inline(never)]
    pub fn search_tree(&mut self, search: usize) {
        let (query, evaluate) = (self.searches.limits[search].query, self.searches.evaluate);
        let evaluate = |collector: &mut BestF64, id, square| evaluate(search, collector, id, square);
        (self.searches.search_tree)(query, &mut self.searches.minimums[search], &evaluate);
    }

    /// Filters packets for one search, given by their numbers and lanes.
    #[cold]
    #[inline(never)]
    #[allow(clippy::cast_possible_truncation, reason = "at most sixteen searches")]
    pub fn filter_all(&mut self, search: usize, packets: &[(u32, u16)]) {
        for &(packet, lanes) in packets {
            let visit = PacketVisit { search: search as u32, packet, lanes: u32::from(lanes) };
            self.searches.isa.run(Filter::<true> { several: self, visits: &[visit] });
        }
    }

    /// Filters at most [`SEARCHES`] packets. Primitives that may be the answer become candidates.
    ///
    /// If `PLANES`, or if a vector has fewer lanes than a packet, planes exclude primitives before the filter runs.
    /// That pays off if many packets are far, as in trees; lists have few such packets (decision 048).
    ///
    /// No branch depends on the results of the filters until all of them have run. Nearby searches often visit the same
    /// packet one after the other; values that depend on the packet alone are then computed once.
    #[inline(always)]
    pub fn filter<I: InstructionSet, const PLANES: bool>(&mut self, visits: &[PacketVisit]) {
        I::call(Filter::<PLANES> { several: self, visits });
    }

    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "rounded up")]
    fn filter_inline<I: InstructionSet, const PLANES: bool>(&mut self, visits: &[PacketVisit]) {
        let leaves = self.searches.leaves;
        for (i, visit) in visits.iter().enumerate() {
            let packet = &leaves.packets[visit.packet as usize];
            let limits = &self.searches.limits[visit.search as usize % SEARCHES];
            self.locals.set(i % SEARCHES, &limits.query, packet);
            self.rows.candidate[i % SEARCHES] = limits.candidate;
            self.early |= u32::from(!packet.has_vertices()) << visit.search;
        }
        self.locals.convert::<I>();
        self.rows.convert::<I>(&self.locals);
        let mut near = [u32::MAX; SEARCHES];
        if PLANES || I::Wide::LEN < LANES {
            // Before the first packet no distance is known, so no plane excludes anything.
            let is_limited = self.rows.candidate[..visits.len()].iter().any(|limit| *limit < f64::INFINITY);
            if is_limited {
                for (i, visit) in visits.iter().enumerate() {
                    self.locals.set_plane(i % SEARCHES, &leaves.packets[visit.packet as usize]);
                }
                self.locals.place_planes::<I>(&self.rows.old_limit);
            }
            for (i, (near, visit)) in near.iter_mut().zip(visits).enumerate() {
                let is_far = self.locals.far >> i & 1 == 1;
                let mut lanes = visit.lanes;
                if is_limited {
                    lanes &= leaves.packets[visit.packet as usize].lanes_before_plane::<I::Wide>(&self.locals, i);
                }
                *near = if is_far { u32::MAX } else { lanes };
            }
        }
        // The first `count` entries are the places with a lane that may be near enough.
        let (mut places, mut count) = ([0u8; SEARCHES], 0);
        for (i, near) in near[..visits.len()].iter().enumerate() {
            places[count % SEARCHES] = i as u8;
            count += usize::from(*near != 0);
        }
        let places = &places[..count];
        let packet_of = |place: u8| visits[usize::from(place) % SEARCHES].packet;
        for run in places.chunk_by(|a, b| packet_of(*a) == packet_of(*b)) {
            let packet = &leaves.packets[packet_of(run[0]) as usize];
            packet.squares_of_several::<I>(&self.locals, run, &near, &mut self.squares);
        }
        for &place in places {
            let has_vertices = leaves.packets[packet_of(place) as usize].has_vertices();
            let place = usize::from(place) % SEARCHES;
            let nearest = smallest::<I::Wide>(&self.squares[place]);
            self.rows.nearest_square[place] = if has_vertices { nearest } else { f32::INFINITY };
        }
        self.rows.update::<I>(&self.locals, self.searches.frame);
        for &place in places {
            let place = usize::from(place) % SEARCHES;
            // Lanes behind the plane are excluded even if their squares were computed for another search.
            let visit = PacketVisit { lanes: visits[place].lanes & near[place], ..visits[place] };
            self.push_candidates::<I>(&visit, place);
        }
        if self.early != 0 {
            self.evaluate_early();
        }
    }

    /// Stores the new limits of a search, and adds the primitives that passed the filter of a packet as candidates.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "`distance_below` allows for the rounding")]
    fn push_candidates<I: InstructionSet>(&mut self, visit: &PacketVisit, place: usize) {
        let packet = &self.searches.leaves.packets[visit.packet as usize];
        let squares = &self.squares[place];
        let mut passed = visit.lanes & packet.lanes();
        if self.locals.far >> place & 1 == 0 {
            let limits = &mut self.searches.limits[visit.search as usize % SEARCHES];
            limits.candidate = self.rows.candidate[place];
            let node = self.rows.node[place];
            limits.node = if node < limits.node { node } else { limits.node };
            let limit = self.rows.limit[place];
            passed &= at_most::<I::Wide>(squares, limit * limit);
        }
        let scale = packet.unit() * self.searches.frame.per_unit;
        let count = &mut self.counts[visit.search as usize % SEARCHES];
        *count += passed.count_ones();
        self.early |= u32::from(*count >= MAX_CANDIDATES) << visit.search;
        while passed != 0 {
            let lane = passed.trailing_zeros();
            passed &= passed - 1;
            packet.prefetch_vertices(lane as usize, &self.searches.leaves.vertices);
            let is_far = self.locals.far >> place & 1 == 1;
            let distance = squares[lane as usize].sqrt() * (1.0 - f32::EPSILON) - self.locals.excess[place];
            let lower_bound = if is_far { 0.0 } else { (f64::from(distance) * scale) as f32 };
            self.candidates[self.candidate_count] =
                Candidate { lower_bound, search: visit.search, packet: visit.packet, lane };
            self.candidate_count += 1;
        }
    }

    /// Evaluates the candidates of some searches early, before all packets were visited, and limits the searches by the
    /// results.
    #[cold]
    #[inline(never)]
    fn evaluate_early(&mut self) {
        let early = std::mem::take(&mut self.early);
        self.evaluate(early);
        (0..SEARCHES).filter(|search| early >> search & 1 == 1).for_each(|search| self.update_limit(search));
    }

    /// Evaluates all candidates.
    #[inline(never)]
    pub fn evaluate_candidates(&mut self) {
        self.evaluate(u32::MAX);
    }

    /// Evaluates the candidates of the searches whose bits are set in `searches` and offers them to the collectors.
    /// Candidates beyond the limits of their searches are dropped.
    #[inline(always)]
    fn evaluate(&mut self, searches: u32) {
        let leaves = self.searches.leaves;
        let computes_in_lanes = self.searches.isa.has_fast_doubles();
        for i in 0..std::mem::take(&mut self.candidate_count) {
            if searches >> self.candidates[i].search & 1 == 0 {
                self.candidates[self.candidate_count] = self.candidates[i];
                self.candidate_count += 1;
                continue;
            }
            let candidate = self.candidates[i];
            let limits = &self.searches.limits[candidate.search as usize];
            let distance =
                f64::from(candidate.lower_bound) * (1.0 - f64::from(f32::EPSILON)) * self.searches.frame.unit;
            if distance > limits.candidate {
                continue;
            }
            let packet = &leaves.packets[candidate.packet as usize];
            let (indices, count) = packet.vertices_of(candidate.lane as usize);
            match count {
                3 if computes_in_lanes => {
                    let vertices = indices.map(|index| &leaves.vertices[index]);
                    if self.triangles.push(&limits.query, vertices, candidate) {
                        self.evaluate_triangles(true);
                    }
                }
                2 if computes_in_lanes => {
                    let vertices = [&leaves.vertices[indices[0]], &leaves.vertices[indices[1]]];
                    if self.segments.push(&limits.query, vertices, candidate) {
                        self.evaluate_segments();
                    }
                }
                _ => self.searches.offer_single(candidate),
            }
        }
        for (search, count) in self.counts.iter_mut().enumerate() {
            *count = if searches >> search & 1 == 1 { 0 } else { *count };
        }
        if self.triangles.len > 0 {
            self.evaluate_triangles(false);
        }
        if self.segments.len > 0 {
            self.evaluate_segments();
        }
    }

    /// Evaluates the queued triangles. If `may_skip`, some of them may stay in the queue.
    #[inline(never)]
    fn evaluate_triangles(&mut self, may_skip: bool) {
        let waiting = &mut self.triangles;
        let found = evaluate_triangles(self.searches.isa, &waiting.eight, may_skip);
        let len = std::mem::take(&mut waiting.len);
        self.searches.take(&waiting.candidates[..len], &found);
        for lane in 0..len {
            if found.was_skipped(lane) {
                waiting.eight.copy_lane(lane, waiting.len);
                waiting.candidates[waiting.len] = waiting.candidates[lane];
                waiting.len += 1;
            }
        }
    }

    #[inline(never)]
    fn evaluate_segments(&mut self) {
        let found = evaluate_segments(self.searches.isa, &self.segments.eight);
        let len = std::mem::take(&mut self.segments.len);
        self.searches.take(&self.segments.candidates[..len], &found);
    }
}

/// A SIMD kernel that filters packets.
struct Filter<'a, 'b, const PLANES: bool> {
    several: &'a mut InterleavedSearch<'b>,
    visits: &'a [PacketVisit],
}

impl<const PLANES: bool> SimdKernel for Filter<'_, '_, PLANES> {
    type Output = ();

    #[inline(always)]
    fn run<I: InstructionSet>(self) {
        self.several.filter_inline::<I, PLANES>(self.visits);
    }
}

/// A queue of candidates of one kind, which fill the first `len` lanes.
#[derive(Default)]
struct LaneQueue<const N: usize> {
    eight: TriangleLanes<N>,
    candidates: [Candidate; SIDE_BY_SIDE],
    len: usize,
}

impl<const N: usize> LaneQueue<N> {
    /// Adds a candidate, and returns whether all lanes are full.
    #[inline(always)]
    fn push(&mut self, query: &V3, vertices: [&V3; N], candidate: Candidate) -> bool {
        self.eight.set(self.len, query, vertices);
        self.candidates[self.len] = candidate;
        self.len += 1;
        self.len == SIDE_BY_SIDE
    }
}
