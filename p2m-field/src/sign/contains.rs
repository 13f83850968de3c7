//! Tests of whether many points are inside, without computing their distances.
//!
//! Points are taken in the order of a curve that fills their box, in blocks. If the ball around a block has no surface
//! in it, all points of the block have the sign of its centre. Elsewhere, if signs change at the surface alone, the
//! surface in the box of the block lies between two parallel planes. The part of the box beyond either of them is
//! convex and has no surface in it, so its points have the sign of one of them. Points between the planes are answered
//! one by one.

use super::triangle::{corners, unit_normal};
use super::{SharedSoup, Sign, SignedDistance};
use nalgebra::Point3;
use p2m_core::batch::{BatchOptions, map_parts_into};
use p2m_core::engine::vector::{V3, dot, largest, length, sub};
use p2m_core::{Aabb, Closest, ClosestPoint, Position, QueryOptions, Real};
use std::ops::{ControlFlow, Range};

/// The sizes of blocks that are tried in turn, in points. Blocks of the last size are divided by planes.
const BLOCKS: [usize; 3] = [512, 128, 32];
/// The most triangles between the planes of a block.
const MAX_TRIANGLES: usize = 1024;
/// The least height of a point beyond a plane, in units of the largest offset. It far exceeds the rounding of heights.
const MIN_HEIGHT: f64 = 1.0 / (1u64 << 40) as f64;

impl<I, S: SharedSoup> SignedDistance<I, S> {
    /// Returns whether a point is inside. Points on the surface are not, nor are points whose sign is not defined or
    /// that are not finite.
    pub fn contains<T: Real>(&self, point: &impl Position<T>) -> bool
    where
        I: ClosestPoint<T>,
    {
        self.closest_point(point).is_some_and(|answer| answer.sign == Sign::Inside)
    }

    /// Returns whether each of some points is inside, as [`contains`](Self::contains) does, in their order.
    ///
    /// # Complexity
    /// Points that are nearer to each other than to the surface share a query, and so do most points beside a part of
    /// the surface that is nearly flat. So there are far fewer queries than points, unless the points are few.
    pub fn contains_each<T: Real>(&self, points: &[Point3<T>], batch: &BatchOptions) -> Vec<bool>
    where
        I: ClosestPoint<T> + Sync,
    {
        self.contains_each_by(&self.index, points, batch)
    }

    /// Does the same as [`contains_each`](Self::contains_each), by another index over the same scene.
    #[doc(hidden)]
    pub fn contains_each_by<T: Real>(
        &self,
        index: &(impl ClosestPoint<T> + Sync + ?Sized),
        points: &[Point3<T>],
        batch: &BatchOptions,
    ) -> Vec<bool>
    where
        I: ClosestPoint<T> + Sync,
    {
        // A query stands for several points.
        self.signs.prepare_for(points.len() / 4);
        let mut out = vec![false; points.len()];
        let position = |point: &Point3<T>| point.map(Real::to_f64);
        map_parts_into(points, batch, position, &mut out, |points, order, out| {
            self.contains_part(index, points, order, out);
        });
        out
    }

    /// Answers points in an order.
    fn contains_part<T: Real>(
        &self,
        index: &(impl ClosestPoint<T> + ?Sized),
        points: &[Point3<T>],
        order: &[u32],
        out: &mut [bool],
    ) where
        I: ClosestPoint<T>,
    {
        // Points that are neighbours are adjacent in memory from here on.
        let points: Vec<Point3<T>> = order.iter().map(|i| points[*i as usize]).collect();
        let mut inside = vec![false; points.len()];
        let mut blocks: Vec<Range<usize>> = std::iter::once(0..points.len()).collect();
        let mut crossed: Vec<(Range<usize>, Ball<T>, Option<usize>)> = Vec::new();
        for size in BLOCKS {
            let starts =
                blocks.iter().flat_map(|block| block.clone().step_by(size).map(|i| i..(i + size).min(block.end)));
            let parts: Vec<Range<usize>> = starts.collect();
            let balls: Vec<Ball<T>> = parts.iter().map(|part| Ball::around(&points[part.clone()])).collect();
            let centres: Vec<Point3<T>> = balls.iter().map(|ball| ball.centre).collect();
            let answers = answers(index, &centres);
            let count = parts.len();
            blocks.clear();
            crossed.clear();
            for ((part, ball), answer) in parts.into_iter().zip(balls).zip(answers) {
                match answer.and_then(|answer| self.sign_in(&ball, &answer)) {
                    Some(sign) => inside[part].fill(sign == Sign::Inside),
                    None => {
                        blocks.push(part.clone());
                        // The centre of points that are not finite has no answer.
                        crossed.push((part, ball, answer.map(|answer| answer.primitive.index())));
                    }
                }
            }
            // Where winding numbers differ within most blocks, smaller ones do not pay.
            if !self.is_closed() && blocks.len() * 4 > count * 3 {
                break;
            }
        }
        let (mut rest, mut sides) = (Vec::new(), Vec::new());
        if self.is_closed() {
            for (part, ball, triangle) in crossed {
                self.divide(&points, part, &ball, triangle, &mut rest, &mut sides);
            }
        } else {
            rest = blocks.into_iter().flatten().collect();
        }
        let firsts = sides.iter().map(|side: &Vec<usize>| side[0]);
        let asked: Vec<usize> = rest.iter().copied().chain(firsts).collect();
        let queries: Vec<Point3<T>> = asked.iter().map(|i| points[*i]).collect();
        for ((i, query), answer) in asked.into_iter().zip(&queries).zip(answers(index, &queries)) {
            inside[i] = answer.is_some_and(|answer| self.sign(query, &answer) == Sign::Inside);
        }
        for side in sides {
            let is_inside = inside[side[0]];
            side.iter().for_each(|i| inside[*i] = is_inside);
        }
        for (i, is_inside) in order.iter().zip(inside) {
            out[*i as usize] = is_inside;
        }
    }

    /// Returns the common sign of all points of a ball, by the closest point of its centre, or `None` if the ball may
    /// have surface in it or signs may differ.
    fn sign_in<T: Real>(&self, ball: &Ball<T>, closest: &Closest<T>) -> Option<Sign>
    where
        I: ClosestPoint<T>,
    {
        // A radius of NaN is not below the bound.
        let is_empty = closest.lower_bound.to_f64() > ball.radius;
        if !is_empty {
            None
        } else if self.is_closed() {
            Some(self.sign(&ball.centre, closest))
        } else {
            let centre = ball.centre.map(Real::to_f64);
            self.signs.winding.sign_in_ball(ball.radius, &centre, self.index.rays())
        }
    }

    /// Divides the points of a block by two planes that are parallel to a triangle, with all of the surface in the box
    /// of the block between them. The points beyond a plane form a side, and have one sign; the points between the
    /// planes are added to `rest`.
    fn divide<T: Real>(
        &self,
        points: &[Point3<T>],
        part: Range<usize>,
        ball: &Ball<T>,
        triangle: Option<usize>,
        rest: &mut Vec<usize>,
        sides: &mut Vec<Vec<usize>>,
    ) {
        let (Some(triangle), Some(certificates)) = (triangle, self.signs.certificates.get()) else {
            return rest.extend(part);
        };
        let soup = &*self.signs.soup;
        let (origin, bounds): (V3, _) = (ball.centre.map(Real::to_f64).into(), &ball.bounds);
        let normal = unit_normal(corners(soup, soup.triangles()[triangle]));
        let (mut low, mut high, mut most, mut count) = (f64::INFINITY, f64::NEG_INFINITY, ball.radius, 0);
        let height = |point: V3| dot(sub(point, origin), normal.unwrap_or_default());
        let tree = certificates.tree.tree();
        let is_near = |id: p2m_core::PrimitiveId| {
            let [a, b, c] = corners(soup, soup.triangles()[id.index()]);
            (0..3).all(|k| a[k].min(b[k]).min(c[k]) <= bounds.max[k] && a[k].max(b[k]).max(c[k]) >= bounds.min[k])
        };
        let ended = tree.visit_box(bounds, is_near, &mut |id| {
            let corners = corners(soup, soup.triangles()[id.index()]);
            most = corners.iter().map(|corner| largest(&[sub(*corner, origin)])).fold(most, f64::max);
            let [a, b, c] = corners.map(height);
            (low, high) = (low.min(a).min(b).min(c), high.max(a).max(b).max(c));
            count += 1;
            if count > MAX_TRIANGLES { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        let margin = MIN_HEIGHT * most;
        // A margin of NaN is not in the range.
        let is_plain = margin > f64::MIN_POSITIVE && margin < f64::MAX;
        if normal.is_none() || ended.is_break() || !is_plain {
            rest.extend(part);
            return;
        }
        let (mut above, mut below) = (Vec::new(), Vec::new());
        for i in part {
            let height = height(points[i].map(Real::to_f64).into());
            if height > high + margin {
                above.push(i);
            } else if height < low - margin {
                below.push(i);
            } else {
                rest.push(i);
            }
        }
        sides.extend([above, below].into_iter().filter(|side| !side.is_empty()));
    }
}

/// Returns the closest points of queries, in their order.
fn answers<T: Real>(index: &(impl ClosestPoint<T> + ?Sized), queries: &[Point3<T>]) -> Vec<Option<Closest<T>>> {
    let mut answers = vec![None; queries.len()];
    index.closest_points_into(queries, &QueryOptions::default(), &mut answers);
    answers
}

/// A ball around some points, and their box.
struct Ball<T: Real> {
    centre: Point3<T>,
    /// An upper bound on the distances of the points from the centre; NaN if a point is not finite.
    radius: f64,
    bounds: Aabb<f64>,
}

impl<T: Real> Ball<T> {
    fn around(points: &[Point3<T>]) -> Self {
        let all = || points.iter().map(|point| point.map(Real::to_f64));
        let (mut low, mut high) = (Point3::from([f64::INFINITY; 3]), Point3::from([f64::NEG_INFINITY; 3]));
        for point in all() {
            (low, high) = (low.inf(&point), high.sup(&point));
        }
        // Halves are added, so that the sum does not overflow.
        let centre = Point3::from([0, 1, 2].map(|k: usize| T::round_from_f64(0.5 * low[k] + 0.5 * high[k])));
        let exact: V3 = centre.map(Real::to_f64).into();
        // No point is farther from the centre than the farthest corner of the box.
        let far: V3 = [0, 1, 2].map(|k: usize| (high[k] - exact[k]).max(exact[k] - low[k]));
        let is_finite = all().all(|point| point.iter().all(|x| x.is_finite()));
        let radius = if is_finite { length(far) * (1.0 + 1e-12) } else { f64::NAN };
        Self { centre, radius, bounds: Aabb { min: low, max: high } }
    }
}
