//! Distances of the places of a grid from some candidates, eight places at once.

use super::groups::Groups;
use super::lanes::squares;
use super::{Candidates, ERROR, MARGIN, TINY};
use p2m_core::engine::simd::{Doubles, InstructionSet, SimdKernel};

/// Evaluates candidates at the places of a grid.
pub(crate) struct Evaluate<'a> {
    pub(crate) groups: &'a Groups,
    pub(crate) candidates: &'a Candidates,
    pub(crate) axes: [&'a [f64]; 3],
    pub(crate) values: &'a mut [f32],
}

/// Places that are evaluated at once.
const PLACES: usize = 64;
/// Places of a step.
const STEP: usize = 8;

impl SimdKernel for Evaluate<'_> {
    /// The values that are in doubt.
    type Output = Vec<usize>;

    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "values are rounded to f32")]
    fn run<I: InstructionSet>(self) -> Vec<usize> {
        let Self { groups, candidates: Candidates { items, reach, .. }, axes: [xs, ys, zs], values } = self;
        let (error, margin) = (reach * ERROR + TINY, I::Doubles::splat(reach * MARGIN));
        let mut doubts = Vec::new();
        let mut places = [[0.0; PLACES]; 3];
        let mut start = 0;
        let [mut i, mut j, mut k] = [0; 3];
        while start < values.len() {
            let count = PLACES.min(values.len() - start);
            let [px, py, pz] = &mut places;
            for ((x, y), z) in px.iter_mut().zip(py).zip(pz).take(count) {
                (*x, *y, *z) = (xs[i], ys[j], zs[k]);
                i += 1;
                if i == xs.len() {
                    (i, j) = (0, j + 1);
                }
                if j == ys.len() {
                    (j, k) = (0, k + 1);
                }
            }
            // The last step is filled up with places that are as good as any.
            for axis in &mut places {
                for n in count..count.next_multiple_of(STEP) {
                    axis[n] = axis[count - 1];
                }
            }
            let mut least = [f64::INFINITY; PLACES];
            for item in items {
                let flat = &groups.flats[item.one().expect("candidates are down to primitives")];
                for at in (0..count).step_by(STEP) {
                    let [x, y, z] = &places;
                    let eight = [I::Doubles::load(&x[at..]), I::Doubles::load(&y[at..]), I::Doubles::load(&z[at..])];
                    let squares = squares(flat, &eight, margin).min(I::Doubles::load(&least[at..]));
                    squares.store(&mut least[at..]);
                }
            }
            for at in (0..count).step_by(STEP) {
                I::Doubles::load(&least[at..]).sqrt().store(&mut least[at..]);
            }
            for (n, (value, distance)) in values[start..start + count].iter_mut().zip(&least).enumerate() {
                let (low, high) = ((distance - error) as f32, (distance + error) as f32);
                *value = high;
                // Not by their bits: zero has two signs, and one value.
                #[allow(clippy::float_cmp, reason = "both are rounded to the same number, or not")]
                if low != high {
                    doubts.push(start + n);
                }
            }
            start += count;
        }
        doubts
    }
}
