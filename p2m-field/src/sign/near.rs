//! Sums of the solid angles of a few triangles at the points of a block, eight points at once.
//!
//! Half of a solid angle is the argument of a complex number, so the sum of such halves is the argument of the product.
//! The product is continued across the negative real axis by counting turns.

use super::solid_angles::{Estimate, MAX_CANCELLATION};
use super::triangle::ROUNDING;
use p2m_core::engine::simd::{Doubles, Float, InstructionSet, SimdKernel};
use p2m_core::engine::vector::V3;
use std::f64::consts::PI;

/// Points in the lanes of one vector.
pub(super) const LANES: usize = 8;

/// The sums of eight points.
#[derive(Clone)]
pub(super) struct EightSums {
    points: [[f64; LANES]; 3],
    /// The real and the imaginary part of the product.
    product: [[f64; LANES]; 2],
    /// How often the argument of the product has passed pi.
    turns: [f64; LANES],
    error: [f64; LANES],
}

impl EightSums {
    /// Returns empty sums of at most eight points.
    pub(super) fn new(points: &[V3]) -> Self {
        let coordinate = |k: usize| std::array::from_fn(|n| points[n.min(points.len() - 1)][k]);
        let (one, zero) = ([1.0; LANES], [0.0; LANES]);
        Self { points: [coordinate(0), coordinate(1), coordinate(2)], product: [one, zero], turns: zero, error: zero }
    }

    /// Returns the sum of a point over 4 pi. The error is infinite if the point is on an edge or on a
    /// triangle, apart from rounding.
    pub(super) fn estimate(&self, n: usize) -> Estimate {
        let half = f64::atan2(self.product[1][n], self.product[0][n]) + 2.0 * PI * self.turns[n];
        Estimate { value: half / (2.0 * PI), error: self.error[n] }
    }
}

/// Adds the solid angles of triangles to sums.
pub(super) struct AddAngles<'a, T> {
    pub(super) triangles: T,
    pub(super) sums: &'a mut EightSums,
}

impl<'a, T: Iterator<Item = &'a [V3; 3]>> SimdKernel for AddAngles<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run<I: InstructionSet>(self) {
        let Self { triangles, sums } = self;
        let load = |values: &[f64; LANES]| I::Doubles::load(values);
        let q = [load(&sums.points[0]), load(&sums.points[1]), load(&sums.points[2])];
        let (mut re, mut im) = (load(&sums.product[0]), load(&sums.product[1]));
        let (mut turns, mut error) = (load(&sums.turns), load(&sums.error));
        let (zero, one) = (I::Doubles::splat(0.0), I::Doubles::splat(1.0));
        let rounding = I::Doubles::splat(ROUNDING);
        for triangle in triangles {
            let [a, b, c] = [offset(&triangle[0], &q), offset(&triangle[1], &q), offset(&triangle[2], &q)];
            let (la, lb, lc) = (dot(&a, &a).sqrt(), dot(&b, &b).sqrt(), dot(&c, &c).sqrt());
            let normal = [b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]];
            let volume = dot(&a, &normal);
            let size = la * lb * lc;
            let other = size + dot(&a, &b) * lc + dot(&b, &c) * la + dot(&c, &a) * lb;
            let scale = one / (volume * volume + other * other).sqrt();
            let (x, y, cancellation) = (other * scale, volume * scale, size * scale);
            // NaN is not below the bound.
            let is_known = cancellation.is_below(I::Doubles::splat(MAX_CANCELLATION))
                & (zero.is_at_most(x) | (rounding * cancellation).is_below(y.abs()));
            let more = rounding + rounding * cancellation;
            error = error + I::Doubles::select(is_known, more, I::Doubles::splat(f64::INFINITY));
            let (before, is_up) = (zero.is_at_most(im), zero.is_at_most(y));
            (re, im) = (re * x - im * y, re * y + im * x);
            let after = zero.is_at_most(im);
            turns = turns + I::Doubles::select(before & is_up & !after, one, zero);
            turns = turns - I::Doubles::select(!before & !is_up & after, one, zero);
        }
        re.store(&mut sums.product[0]);
        im.store(&mut sums.product[1]);
        turns.store(&mut sums.turns);
        error.store(&mut sums.error);
    }
}

#[inline(always)]
fn offset<D: Doubles>(corner: &V3, q: &[D; 3]) -> [D; 3] {
    [D::splat(corner[0]) - q[0], D::splat(corner[1]) - q[1], D::splat(corner[2]) - q[2]]
}

#[inline(always)]
fn dot<D: Doubles>(a: &[D; 3], b: &[D; 3]) -> D {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::super::solid_angles::{HalfAngle, centroid};
    use super::*;
    use p2m_core::engine::simd::Isa;
    use p2m_testkit::vector;

    #[test]
    fn sums_are_those_of_single_angles_and_unknown_on_a_triangle() {
        let mut rng = p2m_testkit::rng("near", 0);
        for _ in 0..500 {
            let triangles: [[V3; 3]; 9] = std::array::from_fn(|_| std::array::from_fn(|_| vector(&mut rng).into()));
            let points: [V3; LANES] = std::array::from_fn(|_| vector(&mut rng).into());
            let single = |q: V3| {
                let half = |t: &[V3; 3]| HalfAngle::new(t, q).and_then(|angle| angle.value(t, q)).expect("off edges");
                triangles.iter().map(half).sum::<f64>() / (2.0 * PI)
            };
            for isa in Isa::available() {
                let mut sums = EightSums::new(&points);
                isa.run(AddAngles { triangles: triangles.iter(), sums: &mut sums });
                for (n, q) in points.iter().enumerate() {
                    let found = sums.estimate(n);
                    assert!((found.value - single(*q)).abs() <= found.error, "{found:?} for {}", single(*q));
                }
                // The side of a triangle is rounding for its centroid, which is on it apart from that.
                let mut sums = EightSums::new(&[centroid(&triangles[0])]);
                isa.run(AddAngles { triangles: triangles.iter(), sums: &mut sums });
                assert_eq!(sums.estimate(0).error, f64::INFINITY);
            }
        }
    }
}
