//! The order of points along a Hilbert curve, and the rounds in which they are inserted.
//!
//! Points next to each other on the curve are near each other in space, so the way from the last point inserted to the
//! next is short. A biased randomised order \[Amenta2003\] keeps the expected number of tetrahedra that come and go low
//! as well: every point is put off to the last round with probability 7/8, else to the one before with the same
//! probability, and so on. A round is a part of the one sequence along the curve.

use crate::kernel::vector::{V3, larger, sub};

/// Bits of a coordinate in a key: three times as many fit into 64.
const BITS: u32 = 21;

/// One level of the curve: of a state and an octant, the place of the octant on the curve and the state in it.
///
/// A state is the corner at which the curve enters a cube, and the axis along which it goes on to the exit
/// \[Hamilton2006\].
#[allow(clippy::cast_possible_truncation, reason = "small numbers")]
const LEVEL: [[(u8, u8); 8]; 24] = {
    let mut table = [[(0, 0); 8]; 24];
    let mut state = 0;
    while state < 24 {
        let (entry, axis) = ((state / 3) as u8, (state % 3) as u8);
        let mut place = 0;
        while place < 8 {
            let gray = place ^ place >> 1;
            let octant = rotate(gray, axis + 1) ^ entry;
            let (inner_entry, inner_axis) = if place == 0 {
                (0, 0)
            } else {
                let even = (place - 1) & !1;
                let turning = if place % 2 == 0 { place - 1 } else { place };
                (even ^ even >> 1, turning.trailing_ones() as u8 % 3)
            };
            let next = (entry ^ rotate(inner_entry, axis + 1)) * 3 + (axis + inner_axis + 1) % 3;
            table[state][octant as usize] = (place, next);
            place += 1;
        }
        state += 1;
    }
    table
};

/// Three bits, rotated to the left.
const fn rotate(bits: u8, by: u8) -> u8 {
    let by = by % 3;
    (bits << by | bits >> (3 - by)) & 7
}

/// The place of a cell of side 2^-BITS of the cube on the curve.
fn place([x, y, z]: [u32; 3], bits: u32) -> u64 {
    let (mut key, mut state) = (0, 0);
    for bit in (0..bits).rev() {
        let octant = (x >> bit & 1) | (y >> bit & 1) << 1 | (z >> bit & 1) << 2;
        let (place, next) = LEVEL[usize::from(state)][octant as usize];
        key = key << 3 | u64::from(place);
        state = next;
    }
    key
}

/// The smallest box around some points, of which there is one.
pub(super) fn bounds(points: impl IntoIterator<Item = V3>) -> [V3; 2] {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for p in points {
        for k in 0..3 {
            low[k] = low[k].min(p[k]);
            high[k] = high[k].max(p[k]);
        }
    }
    [low, high]
}

/// Sorts the numbers of points along the curve through their box; equal points become neighbours, in the order of their
/// numbers.
pub(crate) fn along_the_curve(points: &[V3], numbers: &mut [u32]) {
    let [low, high] = bounds(numbers.iter().map(|&i| points[i as usize]));
    let side = sub(high, low).into_iter().fold(0.0, larger);
    if side == 0.0 || numbers.is_empty() {
        return;
    }
    let cells = f64::from(1u32 << BITS);
    let scale = cells / side;
    let mut keys: Vec<(u64, u32)> = numbers
        .iter()
        .map(|&i| {
            let p = sub(points[i as usize], low);
            // Casts cut off, and never wrap.
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to 2^BITS")]
            let cell = p.map(|x| ((x * scale) as u32).min((1 << BITS) - 1));
            (place(cell, BITS), i)
        })
        .collect();
    keys.sort_unstable();
    for (number, (_, i)) in numbers.iter_mut().zip(&keys) {
        *number = *i;
    }
    // In a cell the same again: its box is smaller by 2^BITS.
    let mut start = 0;
    for run in keys.chunk_by(|a, b| a.0 == b.0) {
        if run.len() > 1 {
            along_the_curve(points, &mut numbers[start..start + run.len()]);
        }
        start += run.len();
    }
}

/// The round of a site, counted from the last one.
fn round(site: usize) -> u32 {
    // Mixes all bits into the lowest ones \[Steele2014\].
    let mut x = (site as u64).wrapping_add(0x9e37_79b9_7f4a_7c15);
    x = (x ^ x >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ x >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    (x ^ x >> 31).trailing_zeros() / 3
}

/// The sites in order of insertion, rounds one after the other.
pub(super) fn rounds(sites: std::ops::Range<usize>) -> impl Iterator<Item = usize> {
    // About 64 sites come first.
    let first = (sites.len() / 64).checked_ilog2().unwrap_or(0) / 3;
    (0..=first).rev().flat_map(move |r| sites.clone().filter(move |&site| round(site).min(first) == r))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_goes_from_cell_to_neighbouring_cell() {
        const SIDE: u32 = 16;
        let mut cells = Vec::new();
        for x in 0..SIDE {
            for y in 0..SIDE {
                for z in 0..SIDE {
                    cells.push((place([x, y, z], 4), [x, y, z]));
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
        along_the_curve(&points, &mut numbers);
        let runs: Vec<&[u32]> = numbers.chunk_by(|a, b| points[*a as usize] == points[*b as usize]).collect();
        assert_eq!(runs.len(), 12);
        assert!(runs.iter().all(|run| run.is_sorted() && run.len() == 10));
        numbers.sort_unstable();
        assert_eq!(numbers, (0..120).collect::<Vec<_>>());
    }

    #[test]
    fn every_site_has_its_turn() {
        for n in [0, 1, 63, 64, 1000, 100_000] {
            let mut sites: Vec<usize> = rounds(6..6 + n).collect();
            if n == 100_000 {
                let last = sites.iter().rev().take_while(|&&s| round(s) == 0).count();
                assert!((86_000..89_000).contains(&last), "{last}");
            }
            sites.sort_unstable();
            assert!(sites.into_iter().eq(6..6 + n));
        }
    }
}
