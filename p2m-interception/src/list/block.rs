//! The blocks of an interception list: up to eight packets each, with lower bounds on their distances and with the
//! lanes that can hold the answer.
//!
//! A block bounds the distances to its packets from below in one of two ways. The build chooses the way that excludes
//! more packets in the cell:
//!
//! - *Boxes* bound as a node of a tree does. They are better where the distance to the cell is about its size.
//! - *Corners* use f(q) = d(q, t)^2 - |q - y|^2, which is concave for any closed set t and any point y, since it is an
//!   infimum of affine functions. Let x_i be the corners of the cell and l_i the trilinear weights of q among them.
//!   Then f(q) >= sum l_i f(x_i), so eight numbers for each packet bound its distance everywhere in the cell. Where
//!   the nearest point of t is the same vertex everywhere in the cell, f is affine and the bound is the distance
//!   itself.
//!
//! The numbers are stored as bytes that are rounded outwards. All lengths are in the frame of the scene.
//! [docs/proofs/octree.md] has the proofs.
//!
//! [docs/proofs/octree.md]: https://github.com/p2m-rs/p2m/blob/main/docs/proofs/octree.md

use p2m_bvh::engine::volume::Rounded;
use p2m_core::engine::simd::Lanes;
use p2m_core::engine::vector::{V3, exponent, power_of_two};

/// The highest level of a cell. A coordinate in units of the cells of this level is an integer of at most 32 bits,
/// so corners of cells are exact.
pub(crate) const MAX_LEVEL: u8 = 30;

/// The number of packets in a block.
pub(crate) const BLOCK_WIDTH: usize = 8;

/// The largest number of blocks in a list.
pub(crate) const MAX_BLOCKS: usize = 256;

/// A packet of a list, as the build hands it to a block.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Entry {
    /// The number of the packet in the tree.
    pub(crate) packet: u32,
    /// The lanes that can hold the answer in the cell, as bits.
    pub(crate) lanes: u16,
    /// The low and the high corner of a box around these lanes, in the frame of the scene.
    pub(crate) bounds: [[f32; 3]; 2],
    /// The function f of these lanes at the corners of the cell.
    pub(crate) f: [f64; 8],
}

/// The way in which a block bounds distances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum BoundKind {
    /// The block has a box for each packet.
    Boxes,
    /// The block has the values of f at the corners of the cell.
    Corners {
        /// The level of the cell.
        level: u8,
        /// The reference point of f. It has to be rounded by [`round_reference`].
        y: V3,
    },
}

/// The level of a block that has boxes.
const LEVEL_OF_BOXES: u8 = u8::MAX;
/// The exponents of the units of bytes. Their powers of two are normal numbers of f32.
const EXPONENTS: std::ops::RangeInclusive<i8> = -100..=100;
/// The unit of reference points. With 16 bits they reach to 4, where the frame of a scene ends.
const REFERENCE_UNIT: f64 = 1.0 / 8192.0;

/// Rounds a point to the nearest one that a block can have as its reference point y.
pub(crate) fn round_reference(y: V3) -> V3 {
    y.map(|x| (x / REFERENCE_UNIT).round().clamp(-32768.0, 32767.0) * REFERENCE_UNIT)
}

/// Eight packets of a list in two cache lines.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C, align(64))]
pub(crate) struct Block {
    /// The bounds of the packets. Row i of a block with corners has f at corner i. A block with boxes has the low
    /// corners in the first three rows, the high corners in the next three, and the origin of both in the last two.
    bounds: [[u8; BLOCK_WIDTH]; 8],
    /// The numbers of the packets in the tree.
    pub(crate) packets: [u32; BLOCK_WIDTH],
    /// The lanes of each packet that can hold the answer, as bits.
    pub(crate) lanes: [u16; BLOCK_WIDTH],
    /// The reference point of f, in [`REFERENCE_UNIT`].
    y: [i16; 3],
    /// The exponent of the power of two that is the unit of the bytes in `bounds`.
    exponent: i8,
    /// The level of the cell, or [`LEVEL_OF_BOXES`] if the block has boxes.
    level: u8,
    /// The value of f that the byte 0 stands for: f = `base` + byte * 2^`exponent`.
    base: f32,
    /// The number of entries in use.
    pub(crate) len: u8,
    /// The number of blocks of the same list that follow this one.
    pub(crate) following: u8,
    unused: [u8; 2],
}

const _: () = assert!(size_of::<Block>() == 128);

/// Zero for each entry in use and infinity for the others, from position `BLOCK_WIDTH` - `len` on.
const UNUSED: [f32; 2 * BLOCK_WIDTH] = {
    let mut row = [0.0; 2 * BLOCK_WIDTH];
    let mut i = BLOCK_WIDTH;
    while i < 2 * BLOCK_WIDTH {
        row[i] = f32::INFINITY;
        i += 1;
    }
    row
};

/// A query point in the forms that blocks need.
#[derive(Clone, Copy, Default)]
pub(crate) struct BlockQuery {
    /// The point in the frame of the scene, rounded to f32 with a bound on the error.
    pub(crate) rounded: Rounded,
    /// The point in the frame of the scene.
    pub(crate) local: V3,
    /// The point in units of the cells of [`MAX_LEVEL`], from the low corner of the domain. Blocks with boxes do
    /// not use it.
    pub(crate) cells: V3,
}

impl Block {
    /// Returns the blocks of a list, which are at least one and at most [`MAX_BLOCKS`].
    pub(crate) fn from_list(entries: &[Entry], bounds: BoundKind) -> impl Iterator<Item = Self> {
        let count = entries.len().div_ceil(BLOCK_WIDTH);
        entries.chunks(BLOCK_WIDTH).enumerate().map(move |(i, entries)| {
            let mut block = match bounds {
                BoundKind::Boxes => Self::from_boxes(entries),
                BoundKind::Corners { level, y } => Self::from_corners(entries, level, y),
            };
            block.following = u8::try_from(count - 1 - i).expect("few blocks");
            block
        })
    }

    #[allow(clippy::cast_possible_truncation, reason = "at most eight")]
    /// Makes a block of up to eight entries without bounds. Unused entries repeat the first packet without lanes.
    fn new(entries: &[Entry], level: u8) -> Self {
        let mut block = Self {
            bounds: [[0; BLOCK_WIDTH]; 8],
            packets: [entries[0].packet; BLOCK_WIDTH],
            lanes: [0; BLOCK_WIDTH],
            y: [0; 3],
            exponent: 0,
            level,
            base: 0.0,
            len: entries.len() as u8,
            following: 0,
            unused: [0; 2],
        };
        for (i, entry) in entries.iter().enumerate() {
            (block.packets[i], block.lanes[i]) = (entry.packet, entry.lanes);
        }
        block
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "rounded outwards within the range")]
    /// Stores the boxes of up to eight entries.
    fn from_boxes(entries: &[Entry]) -> Self {
        let mut low = [f64::INFINITY; 3];
        let mut high = [f64::NEG_INFINITY; 3];
        for entry in entries {
            for k in 0..3 {
                low[k] = low[k].min(f64::from(entry.bounds[0][k]));
                high[k] = high[k].max(f64::from(entry.bounds[1][k]));
            }
        }
        // The boxes span at most 254 units, and the origin is less than 2^23 units away from zero, so it is exact in
        // f32.
        let size = (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max);
        let largest = low.iter().chain(&high).fold(0.0f64, |a, x| a.max(x.abs()));
        let mut exponent = least_exponent(size, 8).max(least_exponent(largest, 23));
        while size > 254.0 * power_of_two(exponent) || largest > 8_388_000.0 * power_of_two(exponent) {
            exponent += 1;
        }
        let (unit, per_unit) = (power_of_two(exponent), power_of_two(-exponent));
        let origin = low.map(|x| (x * per_unit).floor() * unit);
        let mut block = Self::new(entries, LEVEL_OF_BOXES);
        block.exponent = exponent as i8;
        for (k, x) in origin.into_iter().enumerate() {
            block.bounds.as_flattened_mut()[48 + 4 * k..][..4].copy_from_slice(&(x as f32).to_le_bytes());
        }
        (block.bounds[0], block.bounds[1], block.bounds[2]) =
            ([255; BLOCK_WIDTH], [255; BLOCK_WIDTH], [255; BLOCK_WIDTH]);
        for (i, entry) in entries.iter().enumerate() {
            for (k, origin) in origin.iter().enumerate() {
                block.bounds[k][i] = ((f64::from(entry.bounds[0][k]) - origin) * per_unit).floor() as u8;
                block.bounds[3 + k][i] = ((f64::from(entry.bounds[1][k]) - origin) * per_unit).ceil() as u8;
            }
        }
        block
    }

    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a conversion rounds down and saturates"
    )]
    /// Stores the values of f at the corners for up to eight entries.
    fn from_corners(entries: &[Entry], level: u8, y: V3) -> Self {
        let all = || entries.iter().flat_map(|entry| entry.f);
        let min_f = all().fold(f64::INFINITY, f64::min);
        let max_f = all().fold(f64::NEG_INFINITY, f64::max);
        // Values above -min_f may be cut: a minimum of concave functions is concave, and such packets are farther than
        // y.
        let top = if min_f < 0.0 { max_f.min(-min_f) } else { max_f };
        let mut exponent = least_exponent(top - min_f, 8);
        while top - min_f > 254.0 * power_of_two(exponent) && exponent < 100 {
            exponent += 1;
        }
        let (unit, per_unit) = (power_of_two(exponent), power_of_two(-exponent));
        // The base is lowered by the rounding of the sum in `lower_bounds`.
        let base = min_f - unit / 256.0 - min_f.abs() * power_of_two(-20);
        let base = (base as f32).next_down();
        let mut block = Self::new(entries, level);
        block.exponent = exponent as i8;
        block.base = base;
        assert_eq!(y.map(f64::to_bits), round_reference(y).map(f64::to_bits), "a point that blocks can have");
        block.y = y.map(|x| (x / REFERENCE_UNIT) as i16);
        block.bounds = [[255; BLOCK_WIDTH]; 8];
        for (i, entry) in entries.iter().enumerate() {
            for (row, f) in block.bounds.iter_mut().zip(entry.f) {
                row[i] = ((f - min_f) * per_unit) as u8;
            }
        }
        block
    }

    /// Returns the squares of lower bounds of the distances to the packets, as a node of the tree does. The values of
    /// unused entries mean nothing.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "rounding is allowed for")]
    pub(crate) fn lower_bounds<L: Lanes>(&self, query: &BlockQuery) -> L {
        let unit = f32::from_bits(((i32::from(self.exponent) + 127) as u32) << 23);
        if self.level == LEVEL_OF_BOXES {
            let bytes = self.bounds.as_flattened();
            let mut sum = L::splat(0.0);
            for k in 0..3 {
                let origin = L::splat(f32::from_le_bytes(bytes[48 + 4 * k..][..4].try_into().expect("four bytes")));
                let low = L::load_u8(&self.bounds[k]).mul_add(L::splat(unit), origin);
                let high = L::load_u8(&self.bounds[3 + k]).mul_add(L::splat(unit), origin);
                sum = query.rounded.squared_gap(k, low, high, sum);
            }
            return sum;
        }
        let offset = [0, 1, 2].map(|k: usize| query.local[k] - f64::from(self.y[k]) * REFERENCE_UNIT);
        let square = (offset[0] * offset[0] + offset[1] * offset[1] + offset[2] * offset[2]) as f32;
        let [x, y, z] = query.weights(self.level);
        let (z0, z1) = ((1.0 - z) * unit, z * unit);
        let (w00, w10, w01, w11) = ((1.0 - y) * z0, y * z0, (1.0 - y) * z1, y * z1);
        let weights =
            [(1.0 - x) * w00, x * w00, (1.0 - x) * w10, x * w10, (1.0 - x) * w01, x * w01, (1.0 - x) * w11, x * w11];
        let mut even = L::splat(square * (1.0 - 2.0 * f32::EPSILON) + self.base);
        let mut odd = L::splat(-2.0 * f32::EPSILON * square);
        for i in 0..4 {
            even = L::load_u8(&self.bounds[2 * i]).mul_add(L::splat(weights[2 * i]), even);
            odd = L::load_u8(&self.bounds[2 * i + 1]).mul_add(L::splat(weights[2 * i + 1]), odd);
        }
        even.add(odd).max(L::splat(0.0))
    }
}

impl Block {
    /// Returns the [`lower_bounds`](Self::lower_bounds), which are infinite for unused entries.
    #[inline(always)]
    pub(crate) fn lower_bounds_of_used<L: Lanes>(&self, query: &BlockQuery) -> L {
        let len = usize::from(self.len);
        self.lower_bounds::<L>(query).max(L::load(&UNUSED[BLOCK_WIDTH - len..]))
    }

    /// Returns whether the fields of a block from a file are within their ranges, over packets with these
    /// [lanes in use](p2m_bvh::PacketTree::lane_masks). It does not check the number of blocks that follow.
    pub(crate) fn has_valid_fields(&self, lane_masks: &[u16]) -> bool {
        let is_entry =
            |(number, lanes): (&u32, &u16)| lane_masks.get(*number as usize).is_some_and(|mask| lanes & !mask == 0);
        (1..=BLOCK_WIDTH).contains(&usize::from(self.len))
            && (self.level <= MAX_LEVEL || self.level == LEVEL_OF_BOXES)
            && EXPONENTS.contains(&self.exponent)
            && self.base.is_finite()
            && self.unused == [0; 2]
            && self.packets.iter().zip(&self.lanes).fold(true, |is_valid, entry| is_valid & is_entry(entry))
    }

    /// Returns the number of primitives in the block.
    pub(crate) fn primitive_count(&self) -> usize {
        self.lanes[..usize::from(self.len)].iter().map(|lanes| lanes.count_ones() as usize).sum()
    }
}

impl BlockQuery {
    /// Returns the position of the query point in its cell of a level, from 0 to 1 on each axis.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "fewer than 2^30 cells")]
    fn weights(&self, level: u8) -> [f32; 3] {
        let shift = MAX_LEVEL - level;
        let per_side = f64::from_bits((1023 - u64::from(shift)) << 52);
        let part = |x: f64| {
            let x = x * per_side;
            (x - f64::from(x as u32)) as f32
        };
        [part(self.cells[0]), part(self.cells[1]), part(self.cells[2])]
    }
}

/// Returns a lower bound on the exponent of a unit with which `length` is below 2^`bits` units, within [`EXPONENTS`].
fn least_exponent(length: f64, bits: i32) -> i32 {
    let exponent = if length.is_finite() { exponent(length) } else { i32::from(*EXPONENTS.end()) };
    (exponent - bits).clamp(i32::from(*EXPONENTS.start()), i32::from(*EXPONENTS.end()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use p2m_core::engine::simd::{InstructionSet, Isa, SimdKernel};
    use rand::{Rng, RngExt};

    struct Bound<'a>(&'a Block, &'a BlockQuery);

    impl SimdKernel for Bound<'_> {
        type Output = [f32; BLOCK_WIDTH];
        #[inline(always)]
        fn run<I: InstructionSet>(self) -> [f32; BLOCK_WIDTH] {
            let mut bounds = [0.0; BLOCK_WIDTH];
            self.0.lower_bounds::<I::F32x8>(self.1).store(&mut bounds);
            bounds
        }
    }

    fn square(a: &V3, b: &V3) -> f64 {
        (0..3).map(|k| (a[k] - b[k]) * (a[k] - b[k])).sum()
    }

    fn point(rng: &mut impl Rng, around: &V3, size: f64) -> V3 {
        around.map(|x| x + rng.random_range(-size..size))
    }

    /// Sets of points in the frame, near and far from cells of all sizes, are bounded in both ways. No bound exceeds
    /// the distance by more than searches allow for. For a single point the corners bound the distance up to the
    /// precision of the bytes.
    #[test]
    fn bounds_never_exceed_the_distance_and_corners_bound_that_of_a_point_tightly() {
        let (mut compared, mut close) = (0, 0);
        let cases = p2m_testkit::cases(3000, 1000);
        for round in cases.clone() {
            let mut rng = p2m_testkit::rng("blocks", round);
            let level = rng.random_range(1..12u8);
            // The cube is from -8 to 8, so a cell has this side; it may be far from the scene.
            let side = 16.0 / f64::from(1u32 << level);
            let number = [0; 3].map(|_| rng.random_range(0..1u32 << level));
            let low = number.map(|n| -8.0 + f64::from(n) * side);
            let corner =
                |i: usize| -> V3 { std::array::from_fn(|k| low[k] + if i >> k & 1 == 1 { side } else { 0.0 }) };
            let count = rng.random_range(1..=BLOCK_WIDTH);
            let centre = point(&mut rng, &[0.0; 3], 1.0);
            let spread = 2f64.powi(rng.random_range(-12..0));
            let sets: Vec<Vec<V3>> = (0..count)
                .map(|_| {
                    let around = point(&mut rng, &centre, spread);
                    (0..rng.random_range(1..=3)).map(|_| point(&mut rng, &around, spread * 0.3)).collect()
                })
                .collect();
            let y = round_reference(sets[0][0]);
            let least = |q: &V3, set: &[V3]| set.iter().map(|p| square(q, p)).fold(f64::INFINITY, f64::min);
            let entries: Vec<Entry> = sets
                .iter()
                .zip(0..)
                .map(|(set, packet)| {
                    let end =
                        |fold: fn(f64, f64) -> f64, from: f64, k: usize| set.iter().map(|p| p[k]).fold(from, fold);
                    let low = [0, 1, 2].map(|k| (end(f64::min, f64::INFINITY, k) as f32).next_down());
                    let high = [0, 1, 2].map(|k| (end(f64::max, f64::NEG_INFINITY, k) as f32).next_up());
                    let f = std::array::from_fn(|i| least(&corner(i), set) - square(&corner(i), &y) - 1e-13);
                    Entry { packet, lanes: 1, bounds: [low, high], f }
                })
                .collect();
            for bounds in [BoundKind::Boxes, BoundKind::Corners { level, y }] {
                let blocks: Vec<Block> = Block::from_list(&entries, bounds).collect();
                assert_eq!((blocks.len(), blocks[0].len, blocks[0].following), (1, count as u8, 0));
                for _ in 0..4 {
                    let part = [0; 3].map(|_| match rng.random_range(0..6) {
                        0 => 0.0,
                        1 => 1.0 - 1e-9,
                        _ => rng.random::<f64>(),
                    });
                    let q: V3 = std::array::from_fn(|k| low[k] + part[k] * side);
                    let cells = q.map(|x| (x + 8.0) / 16.0 * f64::from(1u32 << MAX_LEVEL));
                    let query = BlockQuery { rounded: Rounded::of(q), local: q, cells };
                    for isa in Isa::available() {
                        let found = isa.run(Bound(&blocks[0], &query));
                        for (set, found) in sets.iter().zip(found) {
                            let (exact, found) = (least(&q, set), f64::from(found));
                            let allowed = exact * (1.0 + 2f64.powi(-20)) + 2f64.powi(-120);
                            assert!(found <= allowed, "{isa}, round {round}: {found} for {exact}, {bounds:?} {q:?}");
                            if bounds != BoundKind::Boxes && set.len() == 1 {
                                compared += 1;
                                // The bound may lose two bytes, and the rounding of the square in f32.
                                let byte = 2f64.powi(i32::from(blocks[0].exponent));
                                let lost = 2.0 * byte + 2f64.powi(-20) * (square(&q, &y) + byte * 256.0);
                                let cut = entries.iter().flat_map(|e| e.f).fold(0.0f64, |a, f| a.max(-f));
                                let f = |i: usize| least(&corner(i), set) - square(&corner(i), &y);
                                close += usize::from(found >= exact - lost || (0..8).any(|i| f(i) > cut));
                            }
                        }
                    }
                }
            }
        }
        assert!(cases.have_more_than(10_000, compared) && close == compared, "{close} of {compared}");
    }

    #[test]
    fn lists_of_several_blocks_know_how_many_follow() {
        let entry = |packet| Entry { packet, lanes: 3, bounds: [[0.0; 3], [0.1; 3]], f: [0.5; 8] };
        let entries: Vec<Entry> = (0..19).map(entry).collect();
        let blocks: Vec<Block> = Block::from_list(&entries, BoundKind::Boxes).collect();
        assert_eq!(blocks.iter().map(|b| (b.len, b.following)).collect::<Vec<_>>(), [(8, 2), (8, 1), (3, 0)]);
        assert_eq!((blocks[2].packets[1], blocks[2].lanes), (17, [3, 3, 3, 0, 0, 0, 0, 0]));
    }
}
