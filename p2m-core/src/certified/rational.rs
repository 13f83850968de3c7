//! Squared distances as fractions of big integers, and their square roots rounded once.
//!
//! All positions are relative to the query, and are integers in units of a power of two that divides all coordinates of
//! the query and the primitive. The nearest feature is found by the signs that
//! [`feature_certificate`](super::feature_certificate) defines, which are certain for integers. The nearest point is a
//! vertex, in the interior of an edge that has a length, or in the interior of a face that has an area. The conditions
//! are necessary as well as sufficient, and every point of a triangle without area is on an edge. So a feature is
//! always found.

use super::feature::exists;
use super::rounded::RoundedDistance;
use crate::Feature;
use crate::exact::{Fraction, Vector, common_exponent, cross, difference, dot, integer, round_bits, sign};
use crate::kernel::vector::V3;
use crate::pair::edges_of;
use dashu_int::ops::{BitTest, SquareRoot, UnsignedAbs};
use dashu_int::{IBig, UBig};
use std::cell::OnceCell;
use std::cmp::Ordering;

/// A squared distance.
pub(super) struct Square {
    /// The square in units of 4^unit.
    fraction: Fraction,
    unit: i32,
}

impl Square {
    /// Computes the squared distance of a primitive. `claim` is the feature that probably contains its nearest point,
    /// and certainly does if `is_proved`.
    pub(super) fn new(query: V3, vertices: &[V3], claim: Feature, is_proved: bool) -> Self {
        let exact = Primitive::new(query, vertices);
        let feature = if is_proved { claim } else { exact.nearest(claim) };
        Self { fraction: exact.square(feature), unit: exact.unit }
    }

    /// Computes the squared distance of two hulls of one to three vertices that do not intersect. It is the minimum
    /// over each vertex and the other hull, and over each pair of edges that are not parallel and nearest in their
    /// interiors.
    pub(super) fn between(a: &[V3], b: &[V3]) -> Self {
        let of_vertices = |vertices: &[V3], other: &[V3]| -> Vec<Self> {
            vertices.iter().map(|vertex| Self::new(*vertex, other, Feature::Vertex(0), false)).collect()
        };
        let mut all = of_vertices(a, b);
        all.extend(of_vertices(b, a));
        for (_, p) in edges_of(a) {
            all.extend(edges_of(b).filter_map(|(_, q)| Self::inside_of_edges(&p, &q)));
        }
        all.into_iter().min_by(Self::cmp).expect("a hull has a vertex")
    }

    /// Computes the squared distance of the lines of two edges, if they are nearest inside of both edges. With the
    /// edges D and E, the vector R between their first ends, and N = D x E, the parameters are (R x E).N / N.N and (R x
    /// D).N / N.N, and the square is (R.N)^2 / N.N.
    fn inside_of_edges(p: &[V3; 2], q: &[V3; 2]) -> Option<Self> {
        let unit = common_exponent(p.as_flattened().iter().chain(q.as_flattened()));
        let vector = |to: V3, from: V3| difference(to, from, unit);
        let (d, e, r) = (vector(p[1], p[0]), vector(q[1], q[0]), vector(q[0], p[0]));
        let normal = cross(&d, &e);
        let square = dot(&normal, &normal);
        let is_inside = |x: IBig| sign(&x).is_gt() && x < square;
        if !(is_inside(dot(&cross(&r, &e), &normal)) && is_inside(dot(&cross(&r, &d), &normal))) {
            return None;
        }
        let height = dot(&r, &normal);
        Some(Self { fraction: Fraction { numerator: &height * &height, denominator: square }, unit })
    }

    /// Computes the square of a length.
    pub(super) fn from_length(x: f64) -> Self {
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
            Ordering::Equal => self.fraction.compare(&other.fraction),
            Ordering::Less => self.fraction.compare(&lift(other)),
            Ordering::Greater => lift(self).compare(&other.fraction),
        }
    }

    /// Returns the distance.
    pub(super) fn distance(&self) -> RoundedDistance {
        let nearest = self.root();
        // If the rounded distance is infinite, the true distance is below it as well.
        let is_above = nearest > 0.0 && (nearest == f64::INFINITY || self.cmp(&Self::from_length(nearest)).is_lt());
        RoundedDistance { nearest, lower: if is_above { nearest.next_down() } else { nearest } }
    }

    /// Returns the square root rounded to the nearest f64, which is infinite beyond the range of f64.
    fn root(&self) -> f64 {
        let numerator = (&self.fraction.numerator).unsigned_abs();
        let denominator = (&self.fraction.denominator).unsigned_abs();
        if numerator == UBig::ZERO {
            return 0.0;
        }
        let bits = |x: &UBig| i64::try_from(x.bit_len()).expect("far fewer");
        // The fraction lies between 2^(top - 1) and 2^(top + 1), so the root lies between 2^(half - 1) and
        // 2^(half + 1). The unit of the integer root is 2^-56 of 2^half, at least two bits below the last bit of the
        // result, or more if that is subnormal.
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
        // The root has at most 58 bits. One more bit is set if the root is not exact.
        let root = u64::try_from(root).expect("58 bits") << 1 | u64::from(!exact);
        round_bits(root, unit - 1)
    }
}

/// A primitive in integer coordinates relative to the query.
struct Primitive {
    /// The vectors from the query to the vertices.
    offsets: Vec<Vector>,
    /// The exponent of the power of two that is the unit of the coordinates.
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

    /// Returns a feature that contains the nearest point, preferably the claimed one.
    fn nearest(&self, claim: Feature) -> Feature {
        let is_nearest = |feature: &Feature| exists(*feature, self.offsets.len()) && self.is_nearest(*feature);
        let mut all = std::iter::once(claim).chain((0..).map_while(Feature::from_code));
        all.find(is_nearest).expect("every set of points has a nearest one")
    }

    /// Returns whether the interior of a feature contains the nearest point.
    fn is_nearest(&self, feature: Feature) -> bool {
        match feature {
            Feature::Vertex(i) => {
                let a = &self.offsets[usize::from(i)];
                self.offsets.iter().all(|w| !is_negative(&dot(a, &minus(w, a))))
            }
            Feature::Edge(i) => {
                let [a, b] = self.ends(i);
                let edge = minus(b, a);
                // The strict signs exclude the ends, so the edge has a length.
                is_negative(&dot(a, &edge))
                    && sign(&dot(b, &edge)).is_gt()
                    && (self.offsets.len() < 3 || self.side(i).is_le())
            }
            Feature::Face => self.normal().iter().any(|x| *x != IBig::ZERO) && (0..3).all(|i| self.side(i).is_ge()),
        }
    }

    /// Returns the squared distance of the point, line or plane of a feature. An edge must have a positive length and a
    /// face a positive area.
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

    /// Returns the normal of a triangle.
    fn normal(&self) -> &Vector {
        self.normal.get_or_init(|| {
            let [a, b, c] = [0, 1, 2].map(|i| &self.offsets[i]);
            cross(&minus(b, a), &minus(c, b))
        })
    }

    /// Returns the side of an edge on which the projection onto the plane of the triangle lies: `Greater` is inside.
    fn side(&self, i: u8) -> Ordering {
        let [a, b] = self.ends(i);
        sign(&dot(self.normal(), &cross(a, b)))
    }
}
