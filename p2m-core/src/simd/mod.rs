//! SIMD vectors of f32 and f64, and the choice of an instruction set at run time.
//!
//! Algorithms are written once, generic over [`Lanes`]. A [`SimdKernel`] that is passed to [`Isa::run`] is compiled
//! once for each instruction set, inside of a function that enables it. Everything that it calls is inlined, so the
//! processor is not checked again. Only the folder `isa` has `unsafe` code.
//!
//! Lanes may differ between instruction sets in the last bits of their results. So they are used in filters with a
//! proved error bound, and never for an answer.

mod isa;
mod lanes;
mod operators;
mod portable;

pub use isa::{Isa, prefetch, prefetch_lines};
pub use lanes::{
    Doubles, EightLanes, Float, InstructionSet, Lanes, SimdKernel, lane_of_key, out_of_line, value_of_key,
};
pub use portable::Portable;

#[cfg(test)]
mod tests {
    use super::*;
    use rand::RngExt;

    /// A kernel that applies every method of lanes to the same numbers.
    struct All<'a>(&'a [[f32; 16]; 4], &'a [u16; 16]);

    impl SimdKernel for All<'_> {
        type Output = (Vec<[f32; 16]>, Vec<u32>);
        #[inline(always)]
        fn run<I: InstructionSet>(self) -> Self::Output {
            let (mut numbers, mut masks) = chunks::<I::Wide>(self.0, self.1);
            let (more_numbers, more_masks) = chunks::<I::F32x8>(self.0, self.1);
            numbers.extend(more_numbers);
            masks.extend(more_masks);
            for half in [0, 8] {
                let mut keys = [0; 8];
                let x = I::F32x8::load(&self.0[0][half..]);
                let x = x.max(I::F32x8::splat(0.0).sub(x));
                let limit = x.smallest() * 2.0;
                masks.push(u32::try_from(x.sorted_keys(limit, &mut keys)).expect("eight"));
                masks.extend(keys);
                masks.push(u32::try_from(x.sorted_keys(f32::MAX, &mut keys)).expect("eight"));
                masks.extend(keys);
            }
            (numbers, masks)
        }
    }

    #[inline(always)]
    fn chunks<L: Lanes>(x: &[[f32; 16]; 4], integers16: &[u16; 16]) -> (Vec<[f32; 16]>, Vec<u32>) {
        let mut numbers = vec![[0.0; 16]; 16];
        let mut masks = vec![0; 2];
        let nan = L::splat(f32::NAN);
        let mut least = f32::INFINITY;
        let mut at = 0;
        while at < 16 {
            let [a, b, c, d] = [L::load(&x[0][at..]), L::load(&x[1][at..]), L::load(&x[2][at..]), L::load(&x[3][at..])];
            let integers = L::load_u16(&integers16[at..]);
            let results = [
                L::splat(x[0][3]),
                integers,
                a.add(b),
                a.sub(b),
                a.mul(b),
                a.min(b),
                a.max(b),
                a.if_below(b, c, d),
                a.mul_add(b, c),
                a.reciprocal(),
                L::difference_of_products(integers, integers.add(L::splat(1.0)), integers.sub(L::splat(2.0)), integers),
                nan.min(a),
                nan.max(a),
                a.min(nan),
                a.max(nan),
                a.if_below(nan, c, d),
            ];
            for (to, from) in numbers.iter_mut().zip(results) {
                from.store(&mut to[at..]);
            }
            masks[0] |= a.at_most(b) << at;
            masks[1] |= a.at_most(nan) << at;
            least = least.min(a.smallest());
            at += L::LEN;
        }
        numbers.push([least; 16]);
        (numbers, masks)
    }

    fn numbers(case: u64) -> ([[f32; 16]; 4], [u16; 16]) {
        let mut rng = p2m_testkit::rng("lanes", case);
        let mut next = || rng.random_range(-1.0f32..1.0);
        let mut x = [[0.0; 16]; 4];
        x.as_flattened_mut().fill_with(&mut next);
        // The numbers include equal ones, zeros of both signs, and large and small ones.
        (x[1][2], x[0][5], x[1][5], x[0][7], x[0][9]) = (x[0][2], 0.0, -0.0, 1e30, -1e-30);
        (x, std::array::from_fn(|_| (next().abs() * 65535.0) as u16))
    }

    #[test]
    fn processors_have_the_lanes_of_their_architecture() {
        let has = |name: &str| Isa::available().iter().any(|isa| isa.name() == name);
        assert!(has("portable") && has("neon") == cfg!(target_arch = "aarch64"));
    }

    #[test]
    fn every_instruction_set_computes_what_the_portable_one_does() {
        for case in p2m_testkit::cases(2000, 1000) {
            let (x, integers16) = numbers(case);
            let (expected, expected_masks) = Isa::PORTABLE.run(All(&x, &integers16));
            assert_eq!(expected_masks[1], 0, "comparisons with NaN are false");
            for isa in Isa::available() {
                let (found, masks) = isa.run(All(&x, &integers16));
                assert_eq!(masks, expected_masks, "{isa}");
                for (method, (found, expected)) in found.iter().zip(&expected).enumerate() {
                    for lane in 0..16 {
                        let (f, e) = (f64::from(found[lane]), f64::from(expected[lane]));
                        let exact = match method % 17 {
                            // The operation may be fused or not. The products are at most 1e30 in magnitude.
                            8 => (f - e).abs() <= 2f64.powi(-23) * (f64::from(x[0][lane] * x[1][lane]).abs() + f.abs()),
                            9 => x[0][lane] == 0.0 || (f - e).abs() <= 2f64.powi(-21) * e.abs(),
                            10 => (f - e).abs() <= 2f64.powi(-22) * e.abs(),
                            // Zeros are compared with their signs.
                            _ => found[lane].to_bits() == expected[lane].to_bits(),
                        };
                        assert!(exact, "{isa}: method {method} lane {lane}: {f} for {e}");
                    }
                }
            }
        }
    }

    /// A kernel that applies every method of eight f64 to the same numbers.
    struct AllDoubles<'a>(&'a [[f64; 8]; 4]);

    impl SimdKernel for AllDoubles<'_> {
        type Output = (Vec<[f64; 8]>, u8);
        #[inline(always)]
        fn run<I: InstructionSet>(self) -> Self::Output {
            let [a, b, c, d] = self.0;
            let (a, b, c, d) = (I::Doubles::load(a), I::Doubles::load(b), I::Doubles::load(c), I::Doubles::load(d));
            let (nan, zero) = (I::Doubles::splat(f64::NAN), I::Doubles::splat(0.0));
            let results = [
                a.mul_add(b, c),
                a + b,
                a - b,
                a * b,
                a / c,
                -a,
                a.abs(),
                a.min(b),
                a.max(b),
                a.if_at_most(b, c, d),
                a.max(zero).sqrt(),
                nan.min(a),
                nan.max(a),
                nan.if_at_most(a, c, d),
                I::Doubles::select(a.is_below(b), c, d),
                I::Doubles::select(a.equals(b), c, d),
                I::Doubles::select(!(a.is_below(b) | a.equals(c) & b.equals(b)), c, d),
            ];
            let mut numbers = vec![[0.0; 8]; results.len()];
            for (to, from) in numbers.iter_mut().zip(results) {
                from.store(to);
            }
            (numbers, a.at_most(b))
        }
    }

    #[test]
    fn every_instruction_set_computes_doubles_as_the_portable_one_does() {
        for case in p2m_testkit::cases(2000, 1000) {
            let mut rng = p2m_testkit::rng("doubles", case);
            let mut x = [[0.0; 8]; 4];
            x.as_flattened_mut().fill_with(|| rng.random_range(-1.0..1.0));
            (x[1][2], x[0][5], x[1][5], x[0][7], x[1][7]) = (x[0][2], 0.0, -0.0, 1e300, f64::INFINITY);
            let (expected, expected_mask) = Isa::PORTABLE.run(AllDoubles(&x));
            let by_hand = (0..8).fold(0, |mask, i| mask | u8::from(x[0][i] <= x[1][i]) << i);
            assert_eq!(expected_mask, by_hand);
            let single = |i: usize| {
                let [a, b, c, d] = [x[0][i], x[1][i], x[2][i], x[3][i]];
                let select = <f64 as Float>::select;
                let zero_or_more = Float::max(a, 0.0).sqrt();
                [
                    [a * b + c, a + b, a - b, a * b, a / c, -a, Float::abs(a), Float::min(a, b), Float::max(a, b)]
                        .as_slice(),
                    &[if a <= b { c } else { d }, zero_or_more, a, a, d, select(a.is_below(b), c, d)],
                    &[select(a.equals(b), c, d), select(!(a.is_below(b) | a.equals(c) & b.equals(b)), c, d)],
                ]
                .concat()
            };
            for i in 0..8 {
                // All methods except the fused one return the bits of f64.
                let found: Vec<u64> = expected[1..].iter().map(|row| row[i].to_bits()).collect();
                let by_hand: Vec<u64> = single(i)[1..].iter().map(|x| x.to_bits()).collect();
                assert_eq!(found, by_hand, "lane {i}");
            }
            for isa in Isa::available() {
                let (found, mask) = isa.run(AllDoubles(&x));
                assert_eq!(mask, expected_mask, "{isa}");
                assert_eq!(found[1..], expected[1..], "{isa}");
                for i in 0..7 {
                    // The operation may be fused or not.
                    assert!((found[0][i] - expected[0][i]).abs() <= f64::EPSILON, "{isa}");
                }
            }
        }
    }

    #[test]
    fn differences_of_products_are_right_where_they_cancel() {
        // (n)(n + 1) - (n - 2) n = 3 n, though both products have 32 bits.
        let (x, integers16) = numbers(7);
        for isa in Isa::available() {
            let (found, _) = isa.run(All(&x, &integers16));
            for lane in 0..16 {
                assert_eq!(found[10][lane], 3.0 * f32::from(integers16[lane]), "{isa}");
            }
        }
    }

    #[test]
    fn keys_give_back_lane_and_a_lower_bound() {
        let key = 1.5f32.to_bits() & !15 | 8 | 5;
        assert_eq!((lane_of_key(key), value_of_key(key)), (5, 1.5));
        assert!(value_of_key((1.5f32.next_up()).to_bits() & !15 | 15) <= 1.5f32.next_up());
    }
}
