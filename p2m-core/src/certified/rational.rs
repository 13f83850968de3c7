//! Squared distances in integers of any length, and their roots, rounded once.
//!
//! Everything is relative to the query, and a multiple of a power of two that divides all coordinates of the query and
//! the primitive. Which feature is nearest is told by the same signs as in [`feature_certificate`](super::feature_certificate), here of integers:
//! nothing is uncertain. A point nearest to the query is a vertex, or inside of an edge that has a length, or inside of a
//! face that has an area, and the conditions stated there are necessary as well; of a triangle without area every point
//! is on an edge. So one of the features is always found.

use super::{Rounded, exists};
use crate::Feature;
use crate::exact::{Fraction, Vector, common_exponent, cross, difference, dot, integer, round_bits, sign};
use crate::kernel::vector::V3;
use dashu_int::ops::{BitTest, SquareRoot, UnsignedAbs};
use dashu_int::{IBig, UBig};
use std::cell::OnceCell;
use std::cmp::Ordering;

/// A squared distance.
pub(super) struct Square {
    /// In units of 4^unit.
    fraction: Fraction,
    unit: i32,
}

impl Square {
    /// Of a primitive, given what probably holds its nearest point, or certainly.
    pub(super) fn new(query: V3, vertices: &[V3], claim: Feature, proved: bool) -> Self {
        let exact = Primitive::new(query, vertices);
        let feature = if proved { claim } else { exact.nearest(claim) };
        Self { fraction: exact.square(feature), unit: exact.unit }
    }

    /// Of a length.
    pub(super) fn of_length(x: f64) -> Self {
        let unit = common_exponent([&x]);
        let x = integer(x, unit);
        Self { fraction: Fraction { numerator: &x * &x, denominator: IBig::ONE }, unit }
    }

    pub(super) fn cmp(&self, other: &Self) -> Ordering {
        let finer = self.unit.min(other.unit);
        let lift = |square: &Self| Fraction {
            numerator: &square.fraction.numerator << (2 * (square.unit - finer)).unsigned_abs() as usize,
            denominator: square.fraction.denominator.clone(),
        };
        match self.unit.cmp(&other.unit) {
            Ordering::Equal => self.fraction.cmp(&other.fraction),
            Ordering::Less => self.fraction.cmp(&lift(other)),
            Ordering::Greater => lift(self).cmp(&other.fraction),
        }
    }

    pub(super) fn distance(&self) -> Rounded {
        let nearest = self.root();
        // Beyond the largest f64 no other one is nearer below.
        let is_above = nearest > 0.0 && (nearest == f64::INFINITY || self.cmp(&Self::of_length(nearest)).is_lt());
        Rounded { nearest, lower: if is_above { nearest.next_down() } else { nearest } }
    }

    /// The square root, rounded to the nearest f64; infinite beyond all of them.
    fn root(&self) -> f64 {
        let numerator = (&self.fraction.numerator).unsigned_abs();
        let denominator = (&self.fraction.denominator).unsigned_abs();
        if numerator == UBig::ZERO {
            return 0.0;
        }
        let bits = |x: &UBig| i64::try_from(x.bit_len()).expect("far fewer");
        // The fraction lies between 2^(top - 1) and 2^(top + 1), so the root between 2^(half - 1) and 2^(half + 1). Its
        // unit gets 2^-56 of 2^half, at least two bits below the last one of f64, or more where that is subnormal.
        let top = bits(&numerator) - bits(&denominator) + 2 * i64::from(self.unit);
        let half = top.div_euclid(2);
        let unit = (half - 56).max(-1076);
        let shift = 2 * (i64::from(self.unit) - unit);
        let by = usize::try_from(shift.unsigned_abs()).expect("far fewer");
        let (numerator, denominator) =
            if shift >= 0 { (numerator << by, denominator) } else { (numerator, denominator << by) };
        // The root of the integer part, rounded down, is the integer part of the root.
        let quotient = &numerator / &denominator;
        let root = quotient.sqrt();
        let exact = &root * &root * &denominator == numerator;
        // 58 bits at most, and one that says that there is more.
        let root = u64::try_from(root).expect("58 bits") << 1 | u64::from(!exact);
        round_bits(root, unit - 1)
    }
}

/// A primitive in integers.
struct Primitive {
    /// From the query to the vertices.
    offsets: Vec<Vector>,
    /// Of coordinates: they are multiples of 2^unit.
    unit: i32,
    normal: OnceCell<Vector>,
}

fn minus(a: &Vector, b: &Vector) -> Vector {
    std::array::from_fn(|k| &a[k] - &b[k])
}

fn is_negative(x: &IBig) -> bool {
    sign(x).is_lt()
}

impl Primitive {
    fn new(query: V3, vertices: &[V3]) -> Self {
        let unit = common_exponent(vertices.as_flattened().iter().chain(&query));
        let offsets = vertices.iter().map(|v| difference(*v, query, unit)).collect();
        Self { offsets, unit, normal: OnceCell::new() }
    }

    /// A feature that holds the nearest point: the claimed one if it does.
    fn nearest(&self, claim: Feature) -> Feature {
        const ALL: [Feature; 7] = [
            Feature::Vertex(0),
            Feature::Vertex(1),
            Feature::Vertex(2),
            Feature::Edge(0),
            Feature::Edge(1),
            Feature::Edge(2),
            Feature::Face,
        ];
        let holds = |feature: &Feature| exists(*feature, self.offsets.len()) && self.holds(*feature);
        std::iter::once(claim).chain(ALL).find(holds).expect("every set of points has a nearest one")
    }

    fn holds(&self, feature: Feature) -> bool {
        match feature {
            Feature::Vertex(i) => {
                let a = &self.offsets[usize::from(i)];
                self.offsets.iter().all(|w| !is_negative(&dot(a, &minus(w, a))))
            }
            Feature::Edge(i) => {
                let [a, b] = self.ends(i);
                let edge = minus(b, a);
                // Inside of the edge, not at its ends: then it has a length.
                is_negative(&dot(a, &edge))
                    && sign(&dot(b, &edge)).is_gt()
                    && (self.offsets.len() < 3 || self.side(i).is_le())
            }
            Feature::Face => self.normal().iter().any(|x| *x != IBig::ZERO) && (0..3).all(|i| self.side(i).is_ge()),
        }
    }

    /// The squared distance of the line or plane of a feature that has a length or an area.
    fn square(&self, feature: Feature) -> Fraction {
        match feature {
            Feature::Vertex(i) => {
                let a = &self.offsets[usize::from(i)];
                Fraction { numerator: dot(a, a), denominator: IBig::ONE }
            }
            Feature::Edge(i) => {
                let [a, b] = self.ends(i);
                let edge = minus(b, a);
                let moment = cross(a, &edge);
                Fraction { numerator: dot(&moment, &moment), denominator: dot(&edge, &edge) }
            }
            Feature::Face => {
                let normal = self.normal();
                let height = dot(normal, &self.offsets[0]);
                Fraction { numerator: &height * &height, denominator: dot(normal, normal) }
            }
        }
    }

    fn ends(&self, i: u8) -> [&Vector; 2] {
        let i = usize::from(i);
        [&self.offsets[i], &self.offsets[(i + 1) % self.offsets.len()]]
    }

    /// Of a triangle.
    fn normal(&self) -> &Vector {
        self.normal.get_or_init(|| {
            let [a, b, c] = [0, 1, 2].map(|i| &self.offsets[i]);
            cross(&minus(b, a), &minus(c, b))
        })
    }

    /// On which side of an edge the foot on the plane of the triangle is: `Greater` inside.
    fn side(&self, i: u8) -> Ordering {
        let [a, b] = self.ends(i);
        sign(&dot(self.normal(), &cross(a, b)))
    }
}
