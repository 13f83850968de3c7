//! The signs of the points of a block with respect to an open surface.
//!
//! The winding number of a point is the number of crossings of a ray less the sum of the solid angles of the caps (the
//! module `winding`). Both are computed for all points of a block together:
//!
//! - The solid angles of the caps are summed by a polynomial, except for caps that are near (`local`, `near`).
//! - The crossings are counted by one ray, from one point. The counts of the other points follow from the triangles
//!   between neighbouring points (`flood`).
//!
//! If the numbers of some points are too near a half for the error of the polynomial, a smaller error is tried.

use super::flood::{Lattice, Wall, change};
use super::local::Local;
use super::near::{AddAngles, EightSums, LANES};
use super::solid_angles::{Estimate, box_of};
use super::{SharedSoup, Sign, SignedDistance};
use nalgebra::Point3;
use p2m_core::{ClosestPoint, PrimitiveId};

/// The error bounds of the polynomial that are tried in turn, until all points have signs.
const ERRORS: [f64; 5] = [0.4, 0.1, 1.0 / 64.0, 1.0 / 256.0, 1.0 / 1024.0];

/// A block of points of a grid.
pub(crate) struct PointBlock<'a> {
    /// The coordinates of the points along each axis.
    pub(crate) axes: [&'a [f64]; 3],
    /// The distances of the points, with x running fastest.
    pub(crate) distances: &'a [f32],
    /// Neighbours at a larger distance than this have no surface between them.
    pub(crate) max_neighbour_distance: f64,
    /// Points at a smaller distance than this may be on the surface.
    pub(crate) on_surface: f64,
}

impl PointBlock<'_> {
    fn counts(&self) -> [usize; 3] {
        self.axes.map(<[f64]>::len)
    }

    fn points(&self) -> Vec<Point3<f64>> {
        let [x, y, _] = self.counts();
        let indices = (0..self.distances.len()).map(|n| [n % x, n / x % y, n / (x * y)]);
        indices.map(|indices| [0, 1, 2].map(|k: usize| self.axes[k][indices[k]]).into()).collect()
    }

    /// Returns the point, among the eight points in the middle, that is farthest from the surface.
    fn start(&self) -> usize {
        let counts = self.counts();
        let middles = (0..8).map(|i| {
            let at = |k: usize| counts[k].saturating_sub(1 + (i >> k & 1)).div_ceil(2);
            at(0) + counts[0] * (at(1) + counts[1] * at(2))
        });
        middles.max_by(|a, b| self.distances[*a].total_cmp(&self.distances[*b])).unwrap_or(0)
    }

    fn is_off_surface(&self, n: usize) -> bool {
        f64::from(self.distances[n]) > self.on_surface
    }

    /// Returns whether the surface may be between two neighbours.
    pub(crate) fn may_be_crossed(&self, from: usize, to: usize) -> bool {
        let distance = f64::from(self.distances[from].max(self.distances[to]).min(f32::MAX));
        distance <= self.max_neighbour_distance
    }
}

impl<I: ClosestPoint<f64>, S: SharedSoup> SignedDistance<I, S> {
    /// Computes the signs of the points of a block. Points that single queries have to decide get `None`: points that
    /// may be on the surface, that are reached only along edges of triangles, or whose numbers are too near a half.
    /// `triangles` has all triangles of the surface that intersect the box of the block.
    ///
    /// In pseudo-code, with `w = crossings - w(caps)`:
    ///
    /// ```text
    /// crossings = the crossings of a ray from the start, the middle point that is farthest from the surface
    /// for each error bound, from 0.4 down to 2^-10:
    ///     refine the polynomial of the caps until its error is below the bound; some caps remain near
    ///     flood the block from the start; the count changes by one where two neighbours are on different sides
    ///         of a triangle of the surface or of a near cap
    ///     for each point without a sign: crossings + its change - (polynomial + near caps)
    ///         gives the sign, if it is farther from a half than the error
    ///     return if all points have signs
    /// ```
    pub(crate) fn signs_of_block(
        &self,
        block: &PointBlock<'_>,
        triangles: impl Iterator<Item = PrimitiveId>,
        out: &mut [Option<Sign>],
    ) {
        out.fill(None);
        let (start, soup) = (block.start(), &*self.signs.soup);
        let Some(angles) = self.signs.winding.solid_angles().filter(|_| block.is_off_surface(start)) else { return };
        let points = block.points();
        let triangles = triangles.map(|id| soup.triangles()[id.index()].map(|i| soup.positions()[i as usize].into()));
        let walls = Wall::in_box(triangles, &box_of(points.iter().map(|point| (*point).into())));
        let lattice =
            Lattice { points: points.iter().map(|point| angles.point(point)).collect(), counts: block.counts() };
        let bounds = box_of(lattice.points.iter().copied());
        let radius = points.iter().map(|point| (point - points[start]).norm()).fold(0.0, f64::max);
        let Some(mut local) = angles.local(lattice.points[start], radius) else { return };
        let crossings = self.signs.winding.crossings(&points[start], self.index.rays());
        // Walls change the number of crossings by one, as a rule.
        let changes = if walls.is_empty() { 0..=0 } else { -1..=1 };
        let is_decided = |local: &Local| {
            let is_decided = |change: i64| local.estimate().complement(crossings + change).is_decided();
            local.is_whole() && changes.clone().all(is_decided)
        };
        let mut sums: Vec<EightSums> = lattice.points.chunks(LANES).map(EightSums::new).collect();
        for error in ERRORS {
            let known = local.near.len();
            angles.refine(&mut local, |local| local.error < error || is_decided(local));
            let caps = Wall::in_box(angles.triangles(&local.near).copied(), &bounds);
            let change = |from: usize, to: usize| {
                let by_caps = change(&caps, lattice.points[from], lattice.points[to])?;
                let is_crossed = block.may_be_crossed(from, to);
                let by_surface = if is_crossed { change(&walls, points[from].into(), points[to].into())? } else { 0 };
                Some(by_caps + by_surface)
            };
            let is_free = walls.is_empty() && caps.is_empty();
            let changes = if is_free { vec![Some(0); points.len()] } else { lattice.flood(start, change) };
            for (chunk, sums) in sums.iter_mut().enumerate() {
                let first = chunk * LANES;
                let is_wanted = |n: &usize| out[*n].is_none() && block.is_off_surface(*n);
                let wanted: Vec<usize> = (first..points.len().min(first + LANES)).filter(is_wanted).collect();
                if wanted.is_empty() {
                    continue;
                }
                angles.isa.run(AddAngles { triangles: angles.triangles(&local.near[known..]), sums });
                for n in wanted {
                    let angles = local.at(lattice.points[n], sums.estimate(n - first));
                    let number = changes[n].map(|change| angles.complement(crossings + change));
                    out[n] = number.filter(|number| number.is_decided()).map(Estimate::sign);
                }
            }
            if (0..points.len()).all(|n| out[n].is_some() || !block.is_off_surface(n)) {
                return;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sign::WindingNumbers;
    use nalgebra::Vector3;
    use p2m_core::{RayQuery, Soup};
    use p2m_mixed::generate::{IcoSphere, TorusKnot, ico_sphere, torus_knot};
    use p2m_testkit::vector;
    use rand::RngExt;

    /// Half of a ball, and a knot that lacks a triangle and has another one twice.
    fn open_surfaces() -> [(Soup<f64>, &'static str); 2] {
        let ball = ico_sphere(&IcoSphere { frequency: 8 }).expect("valid");
        let low = |t: &[u32; 3]| t.iter().all(|i| ball.positions()[*i as usize].x <= 0.0);
        let half = ball.triangles().iter().filter(|t| low(t)).copied().collect();
        let half = Soup::from_triangles(ball.positions().to_vec(), half).expect("valid");
        let knot = torus_knot(&TorusKnot::default()).expect("valid");
        let mut rest = knot.triangles()[1..].to_vec();
        rest.push(rest[500]);
        let holes = Soup::from_triangles(knot.positions().to_vec(), rest).expect("valid");
        [(half, "half a ball"), (holes, "holes")]
    }

    #[test]
    fn winding_numbers_in_balls_are_within_their_bounds() {
        for (soup, name) in open_surfaces() {
            let winding = WindingNumbers::new(&soup).expect("triangles");
            let angles = winding.solid_angles().expect("open");
            let everywhere = [[f64::NEG_INFINITY; 3], [f64::INFINITY; 3]];
            let corners = |t: &[u32; 3]| t.map(|i| soup.positions()[i as usize].into());
            let surface = Wall::in_box(soup.triangles().iter().map(corners), &everywhere);
            let none = None::<&dyn RayQuery<f64>>;
            let (mut by_polynomial, mut with_near, mut with_change, mut largest) = (0, 0, 0, 0.0f64);
            let cases = p2m_testkit::cases(2000, 40);
            for case in cases.clone() {
                let mut rng = p2m_testkit::rng(name, case);
                let radius = 10f64.powf(rng.random_range(-3.0..0.0));
                // Every other centre is near a cap.
                let cap = angles.triangles[rng.random_range(0..angles.triangles.len())].map(Vector3::from);
                let [a, b, c] = cap.map(|v| v / angles.scale);
                let on_cap = a + (b - a) * rng.random_range(0.0..0.5) + (c - a) * rng.random_range(0.0..0.5);
                let is_near = case % 2 == 0;
                let centre = if is_near { on_cap + vector(&mut rng) * (0.3 * radius) } else { vector(&mut rng) * 1.5 };
                let centre = Point3::from(centre);
                let wanted = 10f64.powf(rng.random_range(-4.0..0.0));
                let mut local = angles.local(angles.point(&centre), radius).expect("near");
                angles.refine(&mut local, |local| local.error < wanted);
                let caps = Wall::in_box(angles.triangles(&local.near).copied(), &everywhere);
                let crossings = winding.crossings(&centre, none);
                for _ in 0..8 {
                    let point = centre + vector(&mut rng).normalize() * (radius * rng.random_range(0.0..1.0));
                    let (p, q) = (angles.point(&centre), angles.point(&point));
                    let by_surface = change(&surface, centre.into(), point.into());
                    let by_caps = change(&caps, p, q);
                    let (Some(by_surface), Some(by_caps)) = (by_surface, by_caps) else { continue };
                    let mut sums = EightSums::new(&[q]);
                    angles.isa.run(AddAngles { triangles: angles.triangles(&local.near), sums: &mut sums });
                    let found = local.at(q, sums.estimate(0)).complement(crossings + by_surface + by_caps);
                    let error = (found.value - winding.sum(&point)).abs();
                    assert!(error <= found.error + 1e-9, "{name}, case {case}: {error} for {}", found.error);
                    by_polynomial += usize::from(local.is_whole());
                    with_near += usize::from(!local.is_whole());
                    with_change += usize::from(by_caps != 0);
                    largest = largest.max(error / found.error);
                }
            }
            println!("{name}: {by_polynomial}, {with_near}, {with_change} with change; {largest:.2} of the bound");
            let is_decisive = [by_polynomial, with_near, with_change].iter().all(|n| cases.have_more_than(500, *n));
            assert!(is_decisive && (cases.is_replay() || largest > 0.1), "{name}");
        }
    }
}
