//! Dividing primitives among parts of space, by the splits of a KD-tree of a sample of them.
//!
//! A part holds the primitives whose centres are in one cell of the tree, in the order of their ids. Any division gives
//! the same answers, so the sample only has to make parts compact and about equally large.

use super::spill::Spill;
use std::io;
use std::path::Path;

/// The number of primitives whose centres decide the splits.
const SAMPLE_LEN: u64 = 1 << 16;
/// The largest number of parts that are written at a time, each with a buffer and a file of its own.
const MAX_PARTS: usize = 64;

/// A node of the KD-tree.
enum Node {
    /// The number of a part.
    Part(usize),
    /// The axis, the least coordinate of the upper half, and the two halves.
    Split(usize, f64, Box<[Node; 2]>),
}

/// Divides primitives into parts of about `capacity` primitives, but at most [`MAX_PARTS`] parts. If centres cannot be
/// told apart, the primitives are halved in the order of their ids. It returns at least two parts for two primitives.
pub(super) fn divide(mut spill: Spill, capacity: u64, folder: &Path) -> io::Result<Vec<Spill>> {
    let wanted = spill.len().div_ceil(capacity.max(1)).clamp(2, MAX_PARTS as u64);
    let mut sample = spill.sample_centres(SAMPLE_LEN)?;
    let mut count = 0;
    let tree = split(&mut sample, usize::try_from(wanted).unwrap_or(MAX_PARTS), &mut count);
    if count < 2 {
        return halve(spill, folder);
    }
    let mut parts = (0..count).map(|_| Spill::new(folder)).collect::<io::Result<Vec<_>>>()?;
    spill.for_each(|record| parts[tree.part(record.centre())].push(&record))?;
    parts.retain(|part| part.len() > 0);
    if parts.len() < 2 { halve(spill, folder) } else { Ok(parts) }
}

/// Divides primitives into two halves in the order of their ids.
fn halve(mut spill: Spill, folder: &Path) -> io::Result<Vec<Spill>> {
    let mut parts = vec![Spill::new(folder)?, Spill::new(folder)?];
    let (mut number, half) = (0, spill.len() / 2);
    spill.for_each(|record| {
        number += 1;
        parts[usize::from(number > half)].push(&record)
    })?;
    Ok(parts)
}

/// Makes a tree of `wanted` parts, or of fewer where centres are equal, and counts them.
fn split(centres: &mut [[f64; 3]], wanted: usize, count: &mut usize) -> Node {
    let extent = |k: usize| {
        let along = || centres.iter().map(|centre| centre[k]);
        // Halves do not overflow.
        along().fold(f64::NEG_INFINITY, f64::max) * 0.5 - along().fold(f64::INFINITY, f64::min) * 0.5
    };
    let axis = (1..3).fold(0, |widest, k| if extent(k) > extent(widest) { k } else { widest });
    let lower = wanted / 2;
    let at = centres.len() * lower / wanted.max(1);
    if lower == 0 || at == 0 || extent(axis).is_nan() || extent(axis) <= 0.0 {
        *count += 1;
        return Node::Part(*count - 1);
    }
    let value = centres.select_nth_unstable_by(at, |a, b| a[axis].total_cmp(&b[axis])).1[axis];
    // Where many centres have the coordinate of the border, the least larger one may separate them.
    let below = centres.iter().filter(|centre| centre[axis] < value).count();
    let next = centres.iter().map(|centre| centre[axis]).filter(|x| *x > value).fold(f64::INFINITY, f64::min);
    let value = if below == 0 { next } else { value };
    let mut sorted: Vec<[f64; 3]> = centres.to_vec();
    sorted.sort_unstable_by(|a, b| a[axis].total_cmp(&b[axis]));
    let border = sorted.partition_point(|centre| centre[axis] < value);
    let (left, right) = sorted.split_at_mut(border);
    let halves = [split(left, lower, count), split(right, wanted - lower, count)];
    Node::Split(axis, value, Box::new(halves))
}

impl Node {
    /// Returns the part of a centre.
    fn part(&self, centre: [f64; 3]) -> usize {
        match self {
            Self::Part(number) => *number,
            Self::Split(axis, value, halves) => halves[usize::from(centre[*axis] >= *value)].part(centre),
        }
    }
}
