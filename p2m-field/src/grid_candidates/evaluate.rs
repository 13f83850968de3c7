//! Evaluation of candidates: distances of the points of a grid, eight points at once.

use super::candidates::Candidates;
use super::error_bounds::{ERROR_PER_REACH, INSIDE_MARGIN_PER_REACH, UNDERFLOW_ERROR};
use super::groups::Groups;
use super::squared_distances::squared_distances;
use p2m_core::engine::simd::{Doubles, Float, InstructionSet, Isa, SimdKernel};

/// Evaluates candidates at the points of a grid with these coordinates along its axes.
pub(crate) struct Evaluate<'a> {
    pub(crate) groups: &'a Groups,
    pub(crate) candidates: &'a Candidates,
    pub(crate) axes: [&'a [f64]; 3],
    pub(crate) values: &'a mut [f32],
}

/// Points whose least distances are kept in registers and the nearest cache while all candidates are evaluated.
const CHUNK_POINTS: usize = 64;
/// Points in the lanes of one vector.
const LANES: usize = 8;

impl Evaluate<'_> {
    /// Runs the kernel. This function is not generic, so the kernel is compiled in this crate.
    pub(crate) fn run_on(self, isa: Isa) -> Vec<usize> {
        isa.run(self)
    }
}

impl SimdKernel for Evaluate<'_> {
    /// The numbers of the values whose rounding the error bound does not determine.
    type Output = Vec<usize>;

    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "values are rounded to f32")]
    fn run<I: InstructionSet>(self) -> Vec<usize> {
        let Self { groups, candidates: Candidates { entries, reach, .. }, axes: [xs, ys, zs], values } = self;
        let error = reach * ERROR_PER_REACH + UNDERFLOW_ERROR;
        let margin = I::Doubles::splat(reach * INSIDE_MARGIN_PER_REACH);
        let mut ambiguous = Vec::new();
        let mut points = [[0.0; CHUNK_POINTS]; 3];
        let mut start = 0;
        let [mut i, mut j, mut k] = [0; 3];
        while start < values.len() {
            let count = CHUNK_POINTS.min(values.len() - start);
            let [px, py, pz] = &mut points;
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
            // The last vector is filled up with copies of the last point.
            for axis in &mut points {
                for n in count..count.next_multiple_of(LANES) {
                    axis[n] = axis[count - 1];
                }
            }
            let mut least = [f64::INFINITY; CHUNK_POINTS];
            for entry in entries {
                let primitive = &groups.primitives[entry.primitive().expect("candidates are resolved to primitives")];
                for at in (0..count).step_by(LANES) {
                    let [x, y, z] = &points;
                    let eight = [I::Doubles::load(&x[at..]), I::Doubles::load(&y[at..]), I::Doubles::load(&z[at..])];
                    let squares = squared_distances(primitive, &eight, margin).min(I::Doubles::load(&least[at..]));
                    squares.store(&mut least[at..]);
                }
            }
            for at in (0..count).step_by(LANES) {
                I::Doubles::load(&least[at..]).sqrt().store(&mut least[at..]);
            }
            for (n, (value, distance)) in values[start..start + count].iter_mut().zip(&least).enumerate() {
                let (low, high) = ((distance - error) as f32, (distance + error) as f32);
                *value = high;
                // The numbers are compared rather than their bits, because zero has two signs.
                #[allow(clippy::float_cmp, reason = "both are rounded to the same number, or not")]
                if low != high {
                    ambiguous.push(start + n);
                }
            }
            start += count;
        }
        ambiguous
    }
}
