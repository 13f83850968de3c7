//! Which points are inside, without their distances.
//!
//! Points are taken in the order of a curve that fills their box, in blocks. If the ball around a block has no surface in
//! it, all points of the block have the sign of its centre. Other blocks are divided once, and the points of blocks that
//! still have no common sign are answered one by one.

use super::{SharedSoup, Sign, SignedDistance};
use nalgebra::Point3;
use p2m_core::batch::{BatchOptions, map_parts_into};
use p2m_core::engine::vector::length;
use p2m_core::{Closest, ClosestPoint, Position, QueryOptions, Real};

/// The numbers of points in blocks.
const BLOCKS: [usize; 2] = [64, 8];

impl<I, S: SharedSoup> SignedDistance<I, S> {
    /// Returns whether a point is inside. Points on the surface are not, nor are points whose sign is not defined or that
    /// are not finite.
    pub fn contains<T: Real>(&self, point: &impl Position<T>) -> bool
    where
        I: ClosestPoint<T>,
    {
        self.closest_point(point).is_some_and(|answer| answer.sign == Sign::Inside)
    }

    /// Returns whether each of some points is inside, as [`contains`](Self::contains) does, in their order.
    ///
    /// # Complexity
    /// Points that are nearer to each other than to the surface share a query, so there are far fewer queries than
    /// points unless most points are near the surface.
    pub fn contains_each<T: Real>(&self, points: &[Point3<T>], batch: &BatchOptions) -> Vec<bool>
    where
        I: ClosestPoint<T> + Sync,
        S: Send,
    {
        let mut out = vec![false; points.len()];
        let position = |point: &Point3<T>| point.map(Real::to_f64);
        map_parts_into(points, batch, position, &mut out, |points, order, out| self.contains_part(points, order, out));
        out
    }

    /// Answers points in an order.
    fn contains_part<T: Real>(&self, points: &[Point3<T>], order: &[u32], out: &mut [bool])
    where
        I: ClosestPoint<T>,
    {
        let mut blocks: Vec<&[u32]> = vec![order];
        for size in BLOCKS {
            let parts: Vec<&[u32]> = blocks.iter().flat_map(|block| block.chunks(size)).collect();
            let balls: Vec<Ball<T>> = parts.iter().map(|part| Ball::around(points, part)).collect();
            let centres: Vec<Point3<T>> = balls.iter().map(|ball| ball.centre).collect();
            let answers = self.answers(&centres);
            let count = parts.len();
            blocks.clear();
            for ((part, ball), answer) in parts.into_iter().zip(balls).zip(answers) {
                match answer.and_then(|answer| self.sign_in(&ball, &answer)) {
                    Some(sign) => part.iter().for_each(|i| out[*i as usize] = sign == Sign::Inside),
                    None => blocks.push(part),
                }
            }
            // Where winding numbers differ within most blocks, smaller ones do not pay.
            if !self.is_closed() && blocks.len() * 4 > count * 3 {
                break;
            }
        }
        let rest: Vec<u32> = blocks.concat();
        let queries: Vec<Point3<T>> = rest.iter().map(|i| points[*i as usize]).collect();
        for ((i, query), answer) in rest.into_iter().zip(&queries).zip(self.answers(&queries)) {
            out[i as usize] = answer.is_some_and(|answer| self.sign(query, &answer) == Sign::Inside);
        }
    }

    fn answers<T: Real>(&self, queries: &[Point3<T>]) -> Vec<Option<Closest<T>>>
    where
        I: ClosestPoint<T>,
    {
        let mut answers = vec![None; queries.len()];
        self.index.closest_points_into(queries, &QueryOptions::default(), &mut answers);
        answers
    }

    /// Returns the common sign of all points of a ball, by the closest point of its centre, or `None` if the ball may
    /// have surface in it or signs may differ.
    fn sign_in<T: Real>(&self, ball: &Ball<T>, closest: &Closest<T>) -> Option<Sign> {
        // False for NaN.
        if !(closest.lower_bound.to_f64() > ball.radius) {
            None
        } else if self.is_closed() {
            Some(self.sign(&ball.centre, closest))
        } else {
            self.signs.winding.sign_along(ball.radius, ball.radius, &ball.centre.map(Real::to_f64))
        }
    }
}

/// A ball around some points.
struct Ball<T: Real> {
    centre: Point3<T>,
    /// An upper bound on the distances of the points from the centre; NaN if a point is not finite.
    radius: f64,
}

impl<T: Real> Ball<T> {
    fn around(points: &[Point3<T>], part: &[u32]) -> Self {
        let all = || part.iter().map(|i| points[*i as usize].map(Real::to_f64));
        let (mut low, mut high) = (Point3::from([f64::INFINITY; 3]), Point3::from([f64::NEG_INFINITY; 3]));
        for point in all() {
            (low, high) = (low.inf(&point), high.sup(&point));
        }
        // Halves are added, so that the sum does not overflow.
        let centre = Point3::from([0, 1, 2].map(|k: usize| T::round_from_f64(0.5 * low[k] + 0.5 * high[k])));
        let exact = centre.map(Real::to_f64);
        let distances = all().map(|point| length((point - exact).into()));
        let radius = distances.fold(0.0, |most: f64, x| if x > most || x.is_nan() { x } else { most });
        Self { centre, radius: radius * (1.0 + 1e-12) }
    }
}
