//! The split of a cell: which of its children the candidates of the cell can reach.
//!
//! The children have 27 corners together, the *lattice*: the corners of the cell, and the middles of its edges, faces
//! and interior. Each candidate is tested in two steps, the cheap one first:
//!
//! 1. Bound the distances from the lattice to the box of the candidate, and compare them with the distances to each
//!    dominator. The box may reach a child if, for every dominator, some corner of the child may be nearer to the box
//!    than to the dominator.
//! 2. If the candidate is a packet, run its filter at the corners of the children that its box may reach, and nowhere
//!    else. This leaves the lanes of the packet that can hold the answer in each child.
//!
//! Every distance serves all children that share its lattice point, and later the children themselves, whose corners
//! are lattice points.

use crate::list::corner_test::{Corner, Dominators, exclusion_of, least_of_lanes};
use crate::octree::candidate::Candidate;
use crate::octree::cube::{CHILD_CORNERS, CUBE_CORNERS, Cube, LATTICE_POINTS};
use p2m_bvh::engine::packet::{LANES, Locals, PLACES, Packet, ROUND_UP, at_most, smallest};
use p2m_core::engine::simd::{Doubles, Float, InstructionSet, Lanes, SimdKernel};
use p2m_core::engine::vector::{V3, norm_squared, sub};

/// The number of points of a lattice, rounded up to whole vectors.
const WIDTH: usize = LATTICE_POINTS.next_multiple_of(16);
/// The number of candidates, those with the nearest boxes, that are evaluated to find the nearest point to a lattice
/// point.
pub(crate) const NEAREST_BOX_COUNT: usize = 4;
/// The reciprocal of [`ROUND_UP`], rounded down.
const ROUND_DOWN: f32 = 1.0 - 16.0 * f32::EPSILON;

/// For each child of a cell the lattice points at its corners, as bits.
const CHILD_POINTS: [u32; 8] = {
    let mut all = [0; 8];
    let mut child = 0;
    while child < 8 {
        let mut corner = 0;
        while corner < 8 {
            all[child] |= 1 << CHILD_CORNERS[child][corner];
            corner += 1;
        }
        child += 1;
    }
    all
};

/// For each lattice point the mean of the squared distances to the corners around it, in sides of the cell. These are
/// the corners of the smallest edge, face or cube of the cell that has the point in the middle.
const MEAN_SQUARES: [f32; LATTICE_POINTS] = {
    let mut all = [0.0; LATTICE_POINTS];
    let mut at = 0;
    while at < LATTICE_POINTS {
        let steps = [at % 3, at / 3 % 3, at / 9];
        let mut k = 0;
        while k < 3 {
            all[at] += if steps[k] == 1 { 0.25 } else { 0.0 };
            k += 1;
        }
        at += 1;
    }
    all
};

/// The lattice points at the corners of a cell, as bits.
pub(crate) const CUBE_POINTS: u32 = {
    let mut all = 0;
    let mut corner = 0;
    while corner < 8 {
        all |= 1 << CUBE_CORNERS[corner];
        corner += 1;
    }
    all
};

/// The distances from the lattice points of a cell to the lanes of a packet, computed by the filter of the packet.
/// Values that no child needs are undefined.
#[derive(Clone)]
#[repr(align(64))]
pub(crate) struct LatticeDistances {
    /// The squared distances in the unit of the packet. All are zero if the filter cannot be used at the point.
    squared: [[f32; LANES]; LATTICE_POINTS],
    /// The smallest squared distance at each point.
    least: [f32; LATTICE_POINTS],
    /// The amounts by which the filter may exceed the true distances, in the unit of the packet.
    error_above: [f32; LATTICE_POINTS],
}

impl Default for LatticeDistances {
    fn default() -> Self {
        Self {
            squared: [[0.0; LANES]; LATTICE_POINTS],
            least: [0.0; LATTICE_POINTS],
            error_above: [f32::INFINITY; LATTICE_POINTS],
        }
    }
}

impl LatticeDistances {
    /// Copies the distances from a point of another lattice.
    #[inline(always)]
    fn copy(&mut self, to: usize, other: &Self, from: usize) {
        (self.squared[to], self.least[to], self.error_above[to]) =
            (other.squared[from], other.least[from], other.error_above[from]);
    }
}

/// The distances from the lattice of the parent of a cell, which include those from the corners of the cell.
#[derive(Clone, Copy)]
pub(crate) struct KnownDistances<'a> {
    /// The distances to each packet of the parent.
    pub(crate) distances: &'a [LatticeDistances],
    /// The points of the lattice that are the corners of the cell.
    pub(crate) corners: &'a [usize; 8],
}

/// The memory of a split, which is used again for each one.
#[derive(Default)]
pub(crate) struct Lattice {
    /// For each candidate, lower bounds on the squared distances from the lattice to its box, in squared sides of the
    /// cell.
    squares: Vec<[f32; WIDTH]>,
    /// For each lattice point, the few smallest values of `squares` in ascending order.
    few_squares: [[f32; WIDTH]; NEAREST_BOX_COUNT],
    /// The candidates with the distances in `few_squares`.
    few_numbers: [[u32; WIDTH]; NEAREST_BOX_COUNT],
    /// For each candidate the children that its box may reach, as bits.
    children: Vec<u8>,
    /// For each candidate the lanes that may hold the answer in each child, as bits.
    pub(crate) lanes: Vec<[u16; 8]>,
    /// The points of a packet.
    locals: Locals,
}

impl Lattice {
    /// Returns the few candidates whose boxes are nearest to a lattice point, the nearest first, with lower bounds of
    /// their squared distances. If there are fewer candidates, the other bounds are infinite.
    pub(crate) fn nearest_boxes(&self, at: usize, side: f64) -> [(f64, usize); NEAREST_BOX_COUNT] {
        std::array::from_fn(|i| (f64::from(self.few_squares[i][at]) * side * side, self.few_numbers[i][at] as usize))
    }

    /// Keeps all lanes of each candidate in the children that its box may reach.
    pub(crate) fn keep_all_lanes(&mut self) {
        self.lanes.clear();
        let row = |children: &u8| std::array::from_fn(|child| if children >> child & 1 == 1 { u16::MAX } else { 0 });
        self.lanes.extend(self.children.iter().map(row));
    }
}

/// A SIMD kernel that bounds the distances from the lattice of a cell to the boxes of all candidates.
pub(crate) struct BoundBoxes<'a> {
    pub(crate) lattice: &'a mut Lattice,
    pub(crate) cube: &'a Cube,
    pub(crate) candidates: &'a [Candidate],
    /// For each candidate lower bounds of the distances from the corners of the cell. It is empty if there are none.
    pub(crate) from_corners: &'a [[f64; 8]],
}

impl SimdKernel for BoundBoxes<'_> {
    type Output = ();

    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "rounding is allowed for; few candidates")]
    fn run<I: InstructionSet>(self) {
        let Self { lattice, cube, candidates, from_corners } = self;
        let Lattice { squares, few_squares, few_numbers, .. } = lattice;
        let (half, per_side) = (cube.side * 0.5, cube.side.recip());
        *few_squares = [[f32::INFINITY; WIDTH]; NEAREST_BOX_COUNT];
        squares.clear();
        squares.reserve(candidates.len());
        for (number, candidate) in candidates.iter().enumerate() {
            let mut gaps = [[0.0f32; 3]; 3];
            for (k, gaps) in gaps.iter_mut().enumerate() {
                let (low, high) = (candidate.bounds.min[k], candidate.bounds.max[k]);
                for (step, gap) in gaps.iter_mut().enumerate() {
                    let x = cube.low[k] + half * step as f64;
                    let outside = (low - x).max(x - high).max(0.0) * per_side;
                    *gap = (outside * outside) as f32;
                }
            }
            let mut row = [0.0f32; WIDTH];
            for z in 0..3 {
                for y in 0..3 {
                    let gap = gaps[2][z] + gaps[1][y];
                    for x in 0..3 {
                        row[9 * z + 3 * y + x] = (gap + gaps[0][x]) * ROUND_DOWN;
                    }
                }
            }
            if !from_corners.is_empty() {
                raise_to_interpolated(&mut row, &from_corners[number], per_side);
            }
            squares.push(row);
            // Each column of `few_squares` is kept sorted by insertion.
            let mut numbers = [number as u32; WIDTH];
            for (few_squares, few_numbers) in few_squares.iter_mut().zip(few_numbers.iter_mut()) {
                for at in 0..WIDTH {
                    let (new, old) = ((row[at], numbers[at]), (few_squares[at], few_numbers[at]));
                    let is_less = new.0 < old.0;
                    (few_squares[at], few_numbers[at]) = if is_less { new } else { old };
                    (row[at], numbers[at]) = if is_less { old } else { new };
                }
            }
        }
    }
}

/// Raises lower bounds on the squared distances from the lattice to a packet, in squared sides of the cell, by
/// interpolation between lower bounds on the distances from the corners of the cell. By the concave function of the
/// corner test, the squared distance from a weighted mean of corners is at least the mean of their squared distances,
/// minus the mean of the squared distances between the corners and their mean.
#[inline(always)]
#[allow(clippy::cast_possible_truncation, reason = "rounding is allowed for")]
fn raise_to_interpolated(row: &mut [f32; WIDTH], from_corners: &[f64; 8], per_side: f64) {
    let mut means = [0.0f32; LATTICE_POINTS];
    for (at, distance) in CUBE_CORNERS.into_iter().zip(from_corners) {
        let distance = distance * per_side;
        means[at] = (distance * distance) as f32;
    }
    // The points in the middle between two others, first along x, then along y, then along z.
    for first in [0, 6, 18, 24] {
        means[first + 1] = 0.5 * (means[first] + means[first + 2]);
    }
    for first in [0, 18] {
        for x in 0..3 {
            means[first + x + 3] = 0.5 * (means[first + x] + means[first + x + 6]);
        }
    }
    for at in 0..9 {
        means[at + 9] = 0.5 * (means[at] + means[at + 18]);
    }
    for at in 0..LATTICE_POINTS {
        row[at] = row[at].max((means[at] * ROUND_DOWN - MEAN_SQUARES[at]) * ROUND_DOWN);
    }
}

/// A SIMD kernel that finds the children that the box of each candidate may reach.
pub(crate) struct ReachChildren<'a> {
    pub(crate) lattice: &'a mut Lattice,
    /// The squared distances from the lattice to its dominators, rounded up, in units of the side of the cell.
    pub(crate) limits: &'a LatticeLimits,
}

/// For each dominator, the squared distances from the lattice to it, rounded up, in squared sides of the cell.
pub(crate) struct LatticeLimits {
    rows: [[f32; WIDTH]; LATTICE_POINTS],
    /// The number of rows in use.
    count: usize,
}

impl LatticeLimits {
    /// Collects the lattice's dominators, each once. `slack` is the s of the corner test.
    #[allow(clippy::cast_possible_truncation, reason = "rounded up")]
    pub(crate) fn new(lattice: &[Corner; LATTICE_POINTS], side: f64, slack: f64) -> Self {
        let mut limits = Self { rows: [[0.0; WIDTH]; LATTICE_POINTS], count: 0 };
        for (at, corner) in lattice.iter().enumerate() {
            let is_new = lattice[..at].iter().all(|before| before.y.map(f64::to_bits) != corner.y.map(f64::to_bits));
            if !corner.y[0].is_finite() || !is_new {
                continue;
            }
            for (limit, point) in limits.rows[limits.count].iter_mut().zip(lattice) {
                let distance = (norm_squared(sub(point.x, corner.y)).sqrt() + slack) / side;
                // The summand exceeds the rounding of squares that are not normal numbers of f32.
                *limit = (distance * distance) as f32 * ROUND_UP + f32::MIN_POSITIVE;
            }
            limits.count += 1;
        }
        limits
    }
}

impl SimdKernel for ReachChildren<'_> {
    type Output = ();

    #[inline(always)]
    fn run<I: InstructionSet>(self) {
        let Self { lattice: Lattice { squares, children, .. }, limits } = self;
        children.clear();
        children.reserve(squares.len());
        for squares in squares.iter() {
            let mut reached = CHILD_POINTS;
            for row in &limits.rows[..limits.count] {
                let mut near = 0;
                let mut at = 0;
                while at < WIDTH {
                    near |= I::Wide::load(&squares[at..]).at_most(I::Wide::load(&row[at..])) << at;
                    at += I::Wide::LEN;
                }
                // Once a dominator leaves none of the corners of a child near, `near & points` is zero, and the minimum
                // stays zero.
                for (reached, points) in reached.iter_mut().zip(&CHILD_POINTS) {
                    *reached = (*reached).min(near & points);
                }
            }
            let mut bits = 0;
            for (child, reached) in reached.iter().enumerate() {
                bits |= u8::from(*reached != 0) << child;
            }
            children.push(bits);
        }
    }
}

/// A SIMD kernel that runs the filters of the packets of a cell at the lattice points of the children that their boxes
/// may reach, and applies the corner test. It returns the number of tests of a packet at a point.
pub(crate) struct FilterLanes<'a> {
    pub(crate) lattice: &'a mut Lattice,
    pub(crate) packets: &'a [Packet],
    pub(crate) candidates: &'a [Candidate],
    /// The lattice points.
    pub(crate) points: &'a [V3; LATTICE_POINTS],
    /// The distances from the corners of the cell, if they are known.
    pub(crate) known: Option<KnownDistances<'a>>,
    /// The eight children, each with its dominators.
    pub(crate) dominators: &'a [Dominators; 8],
    /// Receives the distances from the lattice to each packet.
    pub(crate) distances: &'a mut [LatticeDistances],
}

impl SimdKernel for FilterLanes<'_> {
    type Output = usize;

    #[inline(always)]
    fn run<I: InstructionSet>(self) -> usize {
        let Self { lattice, packets, candidates, points, known, dominators, distances } = self;
        let Lattice { children, lanes, locals, .. } = lattice;
        lanes.clear();
        lanes.reserve(candidates.len());
        let mut tests = 0;
        for ((candidate, children), distances) in candidates.iter().zip(children.iter()).zip(distances) {
            let packet = &packets[candidate.child.number()];
            let mut needed = 0;
            for (child, points) in CHILD_POINTS.iter().enumerate() {
                needed |= points * u32::from(children >> child & 1);
            }
            if let Some(known) = &known {
                let from = &known.distances[candidate.index as usize];
                for (to, from_corner) in CUBE_CORNERS.into_iter().zip(known.corners) {
                    distances.copy(to, from, *from_corner);
                }
                needed &= !CUBE_POINTS;
            }
            tests += needed.count_ones() as usize;
            distances_at_points::<I>(packet, points, needed, locals, distances);
            let mut kept = [0; 8];
            for child in 0..8 {
                if children >> child & 1 == 1 {
                    let (dominators, corners) = (&dominators[child], &CHILD_CORNERS[child]);
                    kept[child] = keep_lanes::<I>(packet, dominators, distances, corners, candidate.lanes);
                }
            }
            lanes.push(kept);
        }
        tests
    }
}

/// A SIMD kernel that runs the filters of packets at the corners of a cell, and applies the corner test. It keeps only
/// the candidates that pass.
pub(crate) struct FilterAtCorners<'a> {
    pub(crate) lattice: &'a mut Lattice,
    pub(crate) packets: &'a [Packet],
    pub(crate) points: &'a [V3; LATTICE_POINTS],
    pub(crate) dominators: &'a Dominators,
    pub(crate) candidates: &'a mut Vec<Candidate>,
    /// Receives the distances from the corners to each packet that is kept.
    pub(crate) distances: &'a mut Vec<LatticeDistances>,
}

impl SimdKernel for FilterAtCorners<'_> {
    type Output = ();

    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "few candidates")]
    fn run<I: InstructionSet>(self) {
        let Self { lattice, packets, points, dominators, candidates, distances: all } = self;
        let mut count = 0;
        for i in 0..candidates.len() {
            let mut candidate = candidates[i];
            let packet = &packets[candidate.child.number()];
            if all.len() == count {
                all.push(LatticeDistances::default());
            }
            let distances = &mut all[count];
            distances_at_points::<I>(packet, points, CUBE_POINTS, &mut lattice.locals, distances);
            candidate.lanes = keep_lanes::<I>(packet, dominators, distances, &CUBE_CORNERS, candidate.lanes);
            candidate.index = count as u32;
            candidates[count] = candidate;
            count += usize::from(candidate.lanes != 0);
        }
        candidates.truncate(count);
    }
}

/// Runs the filter of a packet at the lattice points that have a bit in `needed`.
#[inline(always)]
fn distances_at_points<I: InstructionSet>(
    packet: &Packet,
    points: &[V3; LATTICE_POINTS],
    mut needed: u32,
    locals: &mut Locals,
    distances: &mut LatticeDistances,
) {
    let mut squares = [[0.0; LANES]; PLACES];
    while needed != 0 {
        let (mut at, mut chunk, mut count) = ([0; PLACES], [[0.0; 3]; PLACES], 0);
        while needed != 0 && count < PLACES {
            at[count] = needed.trailing_zeros() as usize;
            chunk[count] = points[at[count]];
            needed &= needed - 1;
            count += 1;
        }
        packet.squares_at_points::<I>(&chunk[..count], locals, &mut squares);
        for place in 0..count {
            let (to, squares) = (at[place], &squares[place]);
            if locals.far >> place & 1 == 1 {
                (distances.squared[to], distances.least[to], distances.error_above[to]) =
                    ([0.0; LANES], 0.0, f32::INFINITY);
            } else {
                (distances.squared[to], distances.least[to], distances.error_above[to]) =
                    (*squares, smallest::<I::Wide>(squares), locals.excess[place]);
            }
        }
    }
}

/// Applies the corner test to a packet, given its distances from points that include the corners of the cell. Returns
/// the lanes among `lanes` that pass.
#[inline(always)]
#[allow(clippy::cast_possible_truncation, reason = "sixteen lanes")]
fn keep_lanes<I: InstructionSet>(
    packet: &Packet,
    dominators: &Dominators,
    distances: &LatticeDistances,
    corners: &[usize; 8],
    lanes: u16,
) -> u16 {
    let (per_unit, round_up) = (I::Doubles::splat(packet.per_unit()), I::F32x8::splat(ROUND_UP));
    let mut kept = u32::from(lanes) & packet.lanes();
    let (mut error_above, mut least) = ([0.0; 8], [0.0; 8]);
    for i in 0..8 {
        (error_above[i], least[i]) = (distances.error_above[corners[i]], distances.least[corners[i]]);
    }
    let (error_above, least) = (I::F32x8::load(&error_above), I::F32x8::load(&least));
    let mut limits = [[0.0; 8]; 8];
    let mut is_near_to_all = true;
    for (limits, row) in limits.iter_mut().zip(&dominators.rows[..dominators.count]) {
        (I::Doubles::load(row) * per_unit).store_f32(limits);
        // The filter exceeds the distance by `error_above` at most.
        let limit = I::F32x8::load(limits).add(error_above).mul(round_up);
        let limit = limit.mul(limit).mul(round_up);
        limit.store(limits);
        is_near_to_all &= least.at_most(limit) != 0;
    }
    if !is_near_to_all {
        return 0;
    }
    for limits in &limits[..dominators.count] {
        let mut near = 0;
        for i in 0..8 {
            near |= at_most::<I::Wide>(&distances.squared[corners[i]], limits[i]);
        }
        kept &= near;
        if kept == 0 {
            break;
        }
    }
    kept as u16
}

/// A SIMD kernel that bounds the distances from the corners of a cell to all candidates from below.
pub(crate) struct BoundFromCorners<'a> {
    pub(crate) packets: &'a [Packet],
    pub(crate) candidates: &'a [Candidate],
    pub(crate) known: KnownDistances<'a>,
    /// The bounds for each candidate are appended to this.
    pub(crate) bounds: &'a mut Vec<[f64; 8]>,
}

impl SimdKernel for BoundFromCorners<'_> {
    type Output = ();

    #[inline(always)]
    fn run<I: InstructionSet>(self) {
        let Self { packets, candidates, known: KnownDistances { distances, corners }, bounds } = self;
        bounds.reserve(candidates.len());
        for candidate in candidates {
            let unit = packets[candidate.child.number()].unit();
            let distances = &distances[candidate.index as usize];
            let exclusion = exclusion_of(candidate.lanes);
            let mut row = [0.0; 8];
            for i in 0..8 {
                let at = corners[i];
                row[i] = least_of_lanes::<I>(&distances.squared[at], distances.error_above[at], &exclusion) * unit;
            }
            bounds.push(row);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::RngExt;

    /// The distances from the lattice to sets of points are at least what follows from those at the corners, and nearly
    /// that if a set is one point.
    #[test]
    fn distances_from_corners_bound_those_between_them() {
        let mut close = 0;
        let cases = p2m_testkit::cases(2000, 500);
        for case in cases.clone() {
            let mut rng = p2m_testkit::rng("interpolated", case);
            let side = 2f64.powi(rng.random_range(-9..9));
            let corner = Corner { x: [0.0; 3], y: [0.0; 3] };
            let cube = Cube {
                low: [0; 3].map(|_| f64::from(rng.random_range(-9..9)) * side),
                side,
                level: 5,
                corners: [corner; 8],
            };
            let reach = side * 2f64.powi(rng.random_range(-2..8));
            let set: Vec<V3> = (0..rng.random_range(1..4))
                .map(|_| [0, 1, 2].map(|k: usize| cube.low[k] + rng.random_range(-reach..reach)))
                .collect();
            let square =
                |at: usize| set.iter().map(|p| norm_squared(sub(cube.point(at), *p))).fold(f64::INFINITY, f64::min);
            let mut row = [0.0; WIDTH];
            raise_to_interpolated(&mut row, &CUBE_CORNERS.map(|at| square(at).sqrt()), side.recip());
            let largest = CUBE_CORNERS.iter().map(|at| square(*at)).fold(0.0, f64::max) / (side * side);
            for (at, bound) in row.into_iter().enumerate().take(LATTICE_POINTS) {
                let (bound, exact) = (f64::from(bound), square(at) / (side * side));
                assert!(bound <= exact, "case {case}, point {at}: {bound} for {exact}");
                close += usize::from(set.len() == 1 && bound >= exact - largest * 2f64.powi(-17));
            }
        }
        assert!(cases.have_more_than(5000, close), "{close}");
    }
}
