//! A line and a primitive in integers, and the part of the primitive that lies on the line.
//!
//! The point P of a primitive is given by the weights of the vertices. It lies on the line through O with direction D
//! if the three components of (P - O) x D are zero. Two components suffice if the third component of D is not zero,
//! because D . ((P - O) x D) = 0. Each of them gives two half-spaces. So the primitive is clipped by four half-spaces,
//! and a point or a segment remains.

use crate::integers::{V, clip, cross, dot, integer, lowest_bit, sub};
use crate::ratio::Ratio;
use dashu_int::IBig;
use p2m_core::Ray;

/// A point of a primitive on a line.
#[derive(Clone, Debug)]
pub(crate) struct LinePoint {
    pub(crate) parameter: Ratio,
    pub(crate) weights: [Ratio; 3],
}

/// A ray and a primitive in integers: offsets from the origin as multiples of 2^unit, and the direction as multiples of
/// another power of two.
pub(crate) struct LineAndPrimitive {
    pub(crate) offsets: Vec<V>,
    pub(crate) direction: V,
    pub(crate) radius: IBig,
    /// The exponent of the unit of parameters, which is the unit of offsets divided by the unit of the direction.
    pub(crate) unit: i64,
}

impl LineAndPrimitive {
    pub(crate) fn new(ray: &Ray, vertices: &[[f64; 3]]) -> Self {
        let (origin, direction): ([f64; 3], [f64; 3]) = (ray.origin().coords.into(), ray.direction().into());
        let lowest = |x: &mut dyn Iterator<Item = &f64>| x.map(|x| lowest_bit(*x)).min().expect("some");
        let unit = lowest(&mut vertices.as_flattened().iter().chain(&origin).chain([&ray.radius()]));
        let direction_unit = lowest(&mut direction.iter());
        let exact = |p: [f64; 3]| p.map(|x| integer(x, unit));
        Self {
            offsets: vertices.iter().map(|v| sub(&exact(*v), &exact(origin))).collect(),
            direction: direction.map(|x| integer(x, direction_unit)),
            radius: integer(ray.radius(), unit),
            unit: unit - direction_unit,
        }
    }

    /// Returns the part of the primitive that lies on the line, as the corners of a polygon. A corner is given by its
    /// weights.
    pub(crate) fn clip_to_line(&self) -> Vec<V> {
        let aside: Vec<V> = self.offsets.iter().map(|v| cross(v, &self.direction)).collect();
        let corner = |i: usize| std::array::from_fn(|k| IBig::from(u8::from(i == k)));
        let mut polygon: Vec<V> = (0..self.offsets.len()).map(corner).collect();
        let rest = self.direction.iter().position(|x| *x != IBig::ZERO).expect("a direction");
        for k in (0..3).filter(|k| *k != rest) {
            for sign in [1, -1] {
                if polygon.is_empty() {
                    return polygon;
                }
                polygon = clip(&polygon, |w| aside.iter().zip(w).map(|(a, w)| &a[k] * w).sum::<IBig>() * sign);
            }
        }
        polygon
    }

    /// Returns the part of a segment or a point that is nearest to the line, if it is within the radius.
    pub(crate) fn nearest_part(&self) -> Vec<V> {
        let aside: Vec<V> = self.offsets.iter().map(|v| cross(v, &self.direction)).collect();
        let (zero, first, last) = (IBig::ZERO, &aside[0], &aside[aside.len() - 1]);
        // |first + s change| has its minimum at s = - first . change / change^2.
        let change = sub(last, first);
        let square = dot(&change, &change);
        let parts: Vec<V> = if square == zero {
            let ends = [[IBig::ONE, zero.clone(), zero.clone()], [zero.clone(), IBig::ONE, zero.clone()]];
            ends.into_iter().take(aside.len()).collect()
        } else {
            let part = (-dot(first, &change)).clamp(zero.clone(), square.clone());
            vec![[&square - &part, part, zero]]
        };
        let limit = &self.radius * &self.radius * dot(&self.direction, &self.direction);
        let within = |w: &V| {
            let all = &w[0] + &w[1];
            let far: V = std::array::from_fn(|k| &first[k] * &w[0] + &last[k] * &w[1]);
            dot(&far, &far) <= &limit * &all * &all
        };
        parts.into_iter().filter(within).collect()
    }

    pub(crate) fn line_point(&self, weights: &V) -> LinePoint {
        let all = weights.iter().sum::<IBig>();
        let along: IBig = self.offsets.iter().zip(weights).map(|(v, w)| dot(v, &self.direction) * w).sum();
        let parameter = Ratio::new(along, dot(&self.direction, &self.direction) * &all).times_power_of_two(self.unit);
        LinePoint { parameter, weights: weights.each_ref().map(|w| Ratio::new(w.clone(), all.clone())) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Point3, Vector3};

    #[test]
    fn without_a_radius_the_nearest_part_is_the_common_part() {
        let mut rng = crate::rng("nearest of radius 0", 0);
        let mut met = 0;
        for _ in 0..2000 {
            use rand::RngExt;
            let mut lattice = || std::array::from_fn(|_| f64::from(rng.random_range(-2..=2)));
            let (vertices, origin, direction) = ([lattice(), lattice()], lattice(), lattice());
            if direction == [0.0; 3] {
                continue;
            }
            let ray = Ray::new(&Point3::from(origin), &Vector3::from(direction)).expect("a ray").line();
            let exact = LineAndPrimitive::new(&ray, &vertices);
            let ends = |parts: Vec<V>| {
                let mut all: Vec<f64> = parts.iter().map(|w| exact.line_point(w).parameter.round()).collect();
                all.sort_by(f64::total_cmp);
                all.first().copied().zip(all.last().copied())
            };
            let (common, nearest) = (ends(exact.clip_to_line()), ends(exact.nearest_part()));
            assert_eq!(common, nearest, "{vertices:?} {origin:?} {direction:?}");
            met += usize::from(common.is_some());
        }
        assert!(met > 100, "{met}");
    }
}
