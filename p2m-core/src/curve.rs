//! Orders along a Hilbert curve: neighbours on the curve are near each other in space.

use crate::kernel::vector::{V3, larger, sub};

/// The number of bits per coordinate in a key of 64 bits.
const BITS_PER_AXIS: u32 = 21;

/// The transition table of one level of the curve. `LEVEL[state][octant]` has the position of the octant on the curve
/// and the state in it.
///
/// The basic idea: the curve visits the eight octants of a cube in the order of a Gray code, and visits each octant by
/// a smaller copy of itself that is rotated and mirrored. A state is such an orientation: the corner at which the curve
/// enters a cube, times 3, plus the axis along which the exit lies from there \[Hamilton2006\]. The key of a cell is
/// found level by level, by one look-up each.
#[allow(clippy::cast_possible_truncation, reason = "small numbers")]
const LEVEL: [[(u8, u8); 8]; 24] = {
    let mut table = [[(0, 0); 8]; 24];
    let mut state = 0;
    while state < 24 {
        let (entry, axis) = ((state / 3) as u8, (state % 3) as u8);
        let mut position = 0;
        while position < 8 {
            let gray = position ^ position >> 1;
            let octant = rotate(gray, axis + 1) ^ entry;
            let (inner_entry, inner_axis) = if position == 0 {
                (0, 0)
            } else {
                let even = (position - 1) & !1;
                let turning = if position % 2 == 0 { position - 1 } else { position };
                (even ^ even >> 1, turning.trailing_ones() as u8 % 3)
            };
            let next = (entry ^ rotate(inner_entry, axis + 1)) * 3 + (axis + inner_axis + 1) % 3;
            table[state][octant as usize] = (position, next);
            position += 1;
        }
        state += 1;
    }
    table
};

/// Returns three bits, rotated to the left.
const fn rotate(bits: u8, by: u8) -> u8 {
    let by = by % 3;
    (bits << by | bits >> (3 - by)) & 7
}

/// The transition table of two levels at once. The index is a state times 64 plus two octants, the outer one in the
/// higher bits. The entry is the state in the inner octant times 64 plus its position on the curve. Unused entries make
/// the length a power of two.
const TWO_LEVELS: [u16; 2048] = {
    let mut table = [0; 2048];
    let mut state = 0;
    while state < 24 {
        let mut octants = 0;
        while octants < 64 {
            let (outer, between) = LEVEL[state][octants >> 3];
            let (inner, next) = LEVEL[between as usize][octants & 7];
            table[state << 6 | octants] = (next as u16) << 6 | (outer << 3 | inner) as u16;
            octants += 1;
        }
        state += 1;
    }
    table
};

/// Returns the position on the curve of a cell in a cube with 2^bits cells along each side. `bits` is at most 21.
#[must_use]
#[inline]
pub fn position([x, y, z]: [u32; 3], bits: u32) -> u64 {
    let octants = spread(x) | spread(y) << 1 | spread(z) << 2;
    let (mut key, mut state, mut bits_left) = (0, 0, 3 * bits);
    if bits % 2 == 1 {
        bits_left -= 3;
        let (position, next) = LEVEL[0][(octants >> bits_left & 7) as usize];
        (key, state) = (u64::from(position), u64::from(next) << 6);
    }
    while bits_left > 0 {
        bits_left -= 6;
        let entry = u64::from(TWO_LEVELS[((state | octants >> bits_left & 63) & 2047) as usize]);
        (key, state) = (key << 6 | entry & 63, entry & !63);
    }
    key
}

/// Inserts two zeros between each two of the lowest 21 bits of a number.
#[inline]
fn spread(x: u32) -> u64 {
    let x = u64::from(x);
    let x = (x | x << 32) & 0x1f_0000_0000_ffff;
    let x = (x | x << 16) & 0x1f_0000_ff00_00ff;
    let x = (x | x << 8) & 0x100f_00f0_0f00_f00f;
    let x = (x | x << 4) & 0x10c3_0c30_c30c_30c3;
    (x | x << 2) & 0x1249_2492_4924_9249
}

/// Returns the lower and the upper corner of the smallest box around some points. Without points, the lower corner is
/// infinity and the upper one minus infinity.
pub fn bounds(points: impl IntoIterator<Item = V3>) -> [V3; 2] {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for p in points {
        for k in 0..3 {
            low[k] = low[k].min(p[k]);
            high[k] = high[k].max(p[k]);
        }
    }
    [low, high]
}

/// Sorts the indices of points along the curve through their box. Equal points become neighbours, ordered by index.
pub fn sort_along_curve(points: &[V3], indices: &mut [u32]) {
    let [low, high] = bounds(indices.iter().map(|&i| points[i as usize]));
    let side = sub(high, low).into_iter().fold(0.0, larger);
    if side == 0.0 || indices.is_empty() {
        return;
    }
    let cells = f64::from(1u32 << BITS_PER_AXIS);
    let scale = cells / side;
    let mut keys: Vec<(u64, u32)> = indices
        .iter()
        .map(|&i| {
            let p = sub(points[i as usize], low);
            // The casts truncate and saturate.
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to 2^BITS_PER_AXIS")]
            let cell = p.map(|x| ((x * scale) as u32).min((1 << BITS_PER_AXIS) - 1));
            (position(cell, BITS_PER_AXIS), i)
        })
        .collect();
    keys.sort_unstable();
    for (index, (_, i)) in indices.iter_mut().zip(&keys) {
        *index = *i;
    }
    // Points of the same cell are sorted recursively, along a curve through their own box.
    let mut start = 0;
    for run in keys.chunk_by(|a, b| a.0 == b.0) {
        if run.len() > 1 {
            sort_along_curve(points, &mut indices[start..start + run.len()]);
        }
        start += run.len();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_spread() {
        for bit in 0..21 {
            assert_eq!(spread(1 << bit), 1 << (3 * bit));
        }
        assert_eq!(spread((1 << 21) - 1).count_ones(), 21);
    }

    #[test]
    fn two_levels_at_once_are_two_levels() {
        let one_by_one = |cell: [u32; 3], bits: u32| {
            (0..bits).rev().fold((0, 0), |(key, state), bit| {
                let octant = cell.iter().enumerate().fold(0, |octant, (k, x)| octant | (x >> bit & 1) << k);
                let (position, next) = LEVEL[usize::from(state)][octant as usize];
                (key << 3 | u64::from(position), next)
            })
        };
        for bits in 1..=21 {
            for i in 0..200u32 {
                let cell = [1u32, 7919, 104_729]
                    .map(|factor| i.wrapping_mul(factor.wrapping_mul(2_654_435_761)) >> (32 - bits));
                assert_eq!(position(cell, bits), one_by_one(cell, bits).0, "{cell:?} of {bits} bits");
            }
        }
    }

    #[test]
    fn the_curve_goes_from_cell_to_neighbouring_cell() {
        const SIDE: u32 = 16;
        let mut cells = Vec::new();
        for x in 0..SIDE {
            for y in 0..SIDE {
                for z in 0..SIDE {
                    cells.push((position([x, y, z], 4), [x, y, z]));
                }
            }
        }
        cells.sort_unstable();
        assert!(cells.iter().enumerate().all(|(i, c)| c.0 == i as u64));
        for pair in cells.windows(2) {
            let step: u32 = (0..3).map(|k| pair[0].1[k].abs_diff(pair[1].1[k])).sum();
            assert_eq!(step, 1, "{pair:?}");
        }
    }

    #[test]
    fn clusters_within_a_cell_are_sorted_too_and_equal_points_are_together() {
        let at = |i: u32| {
            let small = f64::from(i % 4) * 2f64.powi(-60);
            [f64::from(i % 3), small, small * 2f64.powi(-60)]
        };
        let points: Vec<V3> = (0..120).map(at).collect();
        let mut numbers: Vec<u32> = (0..120).collect();
        sort_along_curve(&points, &mut numbers);
        let runs: Vec<&[u32]> = numbers.chunk_by(|a, b| points[*a as usize] == points[*b as usize]).collect();
        assert_eq!(runs.len(), 12);
        assert!(runs.iter().all(|run| run.is_sorted() && run.len() == 10));
        numbers.sort_unstable();
        assert_eq!(numbers, (0..120).collect::<Vec<_>>());
    }
}
