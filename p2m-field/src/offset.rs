//! Surfaces at a distance from a scene, made of a field on a grid.
//!
//! A cell of the grid whose corners are on both sides of the distance has one or more loops through its crossed edges,
//! as in marching cubes \[Lorensen1987\]. On a face with four crossed edges, the corners nearer to the scene are kept
//! apart, in both cells of the face, so loops fit together. A loop of three edges becomes a triangle, and a longer one
//! a fan around a vertex in its middle. So every edge is shared by exactly two triangles: a face edge belongs to one
//! loop in each of the two cells, and a spoke of a fan, which ends at the middle vertex, to two triangles of the fan.
//!
//! Then each vertex moves along the gradient of the distance (from the closest point) until its distance matches. If
//! that does not converge within a spacing of the grid, as at a crease, bisection between two points of the cell on
//! either side does.

use crate::{Grid, GridError};
use nalgebra::{Point3, Vector3, center};
use p2m_core::batch::{self, BatchOptions};
use p2m_core::{Aabb, Soup};
use std::collections::HashMap;

/// A surface at a distance from a scene.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct OffsetSurface {
    /// The triangles, which face away from the scene. Each edge has two triangles, in opposite directions.
    pub soup: Soup<f64>,
    /// The largest difference of a vertex's distance from the one that was asked for, in units of the scene.
    pub vertex_error: f64,
    /// The largest difference at the centroids of triangles, which shows how far flat triangles are from a curved
    /// surface.
    pub triangle_error: f64,
}

/// Reasons why there is no surface at a distance.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum OffsetError {
    /// The surface leaves the grid.
    #[error("the surface at the distance {distance} leaves the grid")]
    LeavesGrid {
        /// The distance that was asked for.
        distance: f64,
    },
    /// The surface has more than 2^32 - 1 vertices.
    #[error("the surface has more than 2^32 - 1 vertices")]
    TooLarge,
    /// The distance is not finite.
    #[error("a distance of {distance} is not finite")]
    NotFinite {
        /// The distance that was asked for.
        distance: f64,
    },
}

/// Returns the distance of a point, with its sign in a field with signs, and its closest point in the scene, or `None`
/// if the distance is not defined.
pub type MeasureDistance<'a> = dyn Fn(&Point3<f64>) -> Option<(f64, Point3<f64>)> + Sync + 'a;

/// The corners of the faces of a cell, counterclockwise as seen from outside. Bit k of a corner is set if it is at the
/// upper end of axis k.
const FACES: [[usize; 4]; 6] = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
/// The largest number of steps along the gradient.
const STEPS: usize = 8;
/// The largest number of bisections, which reach neighbouring numbers.
const BISECTIONS: usize = 60;
/// The error of a vertex, relative to the spacing of the grid, at which it stays.
const SETTLED: f64 = 1e-7;
/// The fraction of an edge at each end in which no vertex starts, so that triangles are not thin.
const END: f64 = 0.1;

/// Returns a grid with `resolution` points along its longest side that contains all points at a distance from a box,
/// and two layers around them.
///
/// # Errors
/// The errors of [`Grid::around`], and [`GridError::Count`] for a resolution below 8.
pub fn offset_grid(bounds: &Aabb<f64>, distance: f64, resolution: usize) -> Result<Grid, GridError> {
    if resolution < 8 {
        return Err(GridError::Count(resolution, resolution, resolution));
    }
    let reach = distance.max(0.0);
    let longest = (bounds.max - bounds.min).max() + 2.0 * reach;
    let margin = Vector3::repeat(reach + 2.0 * longest / (resolution - 5) as f64);
    let grown = Aabb { min: bounds.min - margin, max: bounds.max + margin };
    Grid::around(if bounds.is_empty() { bounds } else { &grown }, resolution, 1.0)
}

/// Returns the surface of all points at a distance from a scene, given its field on a grid.
///
/// `values` come from [`distances`](crate::distances) or [`signed_distances`](crate::signed_distances); NaN counts as
/// far. `closest` measures the same distances. With a negative distance, the surface is inside. Without signs, a
/// surface around a closed scene has an inner shell too. Details that are smaller than the spacing of the grid may be
/// lost.
///
/// ```
/// use nalgebra::Point3;
/// use p2m_core::{BruteForce, ClosestPoint, Element, PrimitiveSet, Soup};
/// use p2m_field::{FieldOptions, distances, offset_grid, offset_surface};
///
/// let rod = Soup::new(vec![[0.0; 3].into(), [2.0, 0.0, 0.0].into()], [Element::Segment([0, 1])])?;
/// let index = BruteForce::new(&rod)?;
/// let grid = offset_grid(&rod.aabb(), 0.5, 33)?;
/// let values = distances(&index, &grid, &FieldOptions::default(), &|_| ())?;
/// let closest = |x: &Point3<f64>| index.closest_point(x).map(|found| (found.distance, found.point));
/// let capsule = offset_surface(&grid, &values, 0.5, &closest)?;
/// assert!(capsule.vertex_error < 1e-6 && capsule.triangle_error < 0.02);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// An [`OffsetError`] if the surface leaves the grid or has too many vertices, or the distance is not finite.
///
/// # Panics
/// If there is not one value for each point of the grid.
///
/// # Accuracy
/// Vertices have the distance within 10^-7 of the spacing, unless rounding of the values to f32, or a sign that changes
/// away from the surface, prevents it; the result has the largest error.
///
/// # Complexity
/// O(n) for n grid points. A vertex takes about three queries, and 80 bytes.
pub fn offset_surface(
    grid: &Grid,
    values: &[f32],
    distance: f64,
    closest: &MeasureDistance<'_>,
) -> Result<OffsetSurface, OffsetError> {
    assert_eq!(values.len(), grid.len(), "a value for each point of the grid");
    if !distance.is_finite() {
        return Err(OffsetError::NotFinite { distance });
    }
    let mut mesh =
        Mesh { grid, values, distance, vertices: Vec::new(), of_edges: HashMap::new(), triangles: Vec::new() };
    let [nx, ny, nz] = grid.counts();
    for k in 0..nz {
        for j in 0..ny {
            for i in 0..nx {
                let is_border = [(i, nx), (j, ny), (k, nz)].iter().any(|(i, n)| *i == 0 || i + 1 == *n);
                if is_border && mesh.is_near([i, j, k]) {
                    return Err(OffsetError::LeavesGrid { distance });
                }
                if i + 1 < nx && j + 1 < ny && k + 1 < nz {
                    mesh.add_cell([i, j, k])?;
                }
            }
        }
    }
    let Mesh { vertices, triangles, .. } = mesh;
    let settle = |vertex: &Vertex| vertex.settle(distance, grid.spacing(), closest);
    let settled = batch::map(&vertices, &BatchOptions::default(), |vertex| vertex.start, settle);
    let positions: Vec<Point3<f64>> = settled.iter().map(|(point, _)| *point).collect();
    let centroid = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|i| positions[i as usize]);
        a + ((b - a) + (c - a)) / 3.0
    };
    let error =
        |corners: &[u32; 3]| closest(&centroid(corners)).map_or(f64::INFINITY, |found| (found.0 - distance).abs());
    let errors = batch::map(&triangles, &BatchOptions::default(), centroid, error);
    let largest = |errors: &mut dyn Iterator<Item = f64>| errors.fold(0.0, f64::max);
    let (vertex_error, triangle_error) =
        (largest(&mut settled.iter().map(|(_, error)| *error)), largest(&mut errors.into_iter()));
    // The indices of vertices fit, because the number of vertices does.
    let soup = Soup::from_triangles(positions, triangles).map_err(|_| OffsetError::TooLarge)?;
    Ok(OffsetSurface { soup, vertex_error, triangle_error })
}

/// A vertex before it is moved.
#[derive(Clone, Copy)]
struct Vertex {
    start: Point3<f64>,
    /// A point that is nearer to the scene, and one that is farther.
    between: [Point3<f64>; 2],
}

impl Vertex {
    /// Returns where the vertex moves to, and the error there.
    fn settle(&self, distance: f64, spacing: f64, closest: &MeasureDistance<'_>) -> (Point3<f64>, f64) {
        let mut best = (self.start, f64::INFINITY);
        let mut offer = |point: Point3<f64>, error: f64| {
            if error.abs() < best.1 {
                best = (point, error.abs());
            }
            best.1 <= SETTLED * spacing
        };
        let mut point = self.start;
        for _ in 0..STEPS {
            let Some((found, nearest)) = closest(&point) else { break };
            if offer(point, found - distance) {
                return best;
            }
            // The gradient is (point - nearest) / found, for both signs.
            point -= (point - nearest) * ((found - distance) / found);
            let moved = (point - self.start).norm();
            if found == 0.0 || moved > spacing || moved.is_nan() {
                break;
            }
        }
        let [mut near, mut far] = self.between;
        // The start replaces one of the two points, so different vertices of a cell stay apart.
        point = self.start;
        for _ in 0..BISECTIONS {
            let Some((found, _)) = closest(&point) else { break };
            if offer(point, found - distance) {
                break;
            }
            if found < distance {
                near = point
            } else {
                far = point
            }
            point = center(&near, &far);
        }
        best
    }
}

/// A surface that is being made.
struct Mesh<'a> {
    grid: &'a Grid,
    values: &'a [f32],
    distance: f64,
    vertices: Vec<Vertex>,
    /// The vertices of crossed edges, by three times the number of their lower end plus their axis.
    of_edges: HashMap<usize, u32>,
    triangles: Vec<[u32; 3]>,
}

impl Mesh<'_> {
    fn value(&self, point: [usize; 3]) -> f64 {
        f64::from(self.values[self.grid.number(point)])
    }

    /// Tells whether a point of the grid is nearer to the scene than the surface.
    fn is_near(&self, point: [usize; 3]) -> bool {
        self.value(point) < self.distance
    }

    fn add_vertex(&mut self, vertex: Vertex) -> Result<u32, OffsetError> {
        let number = u32::try_from(self.vertices.len()).ok().filter(|number| *number < u32::MAX);
        self.vertices.push(vertex);
        number.ok_or(OffsetError::TooLarge)
    }

    /// Returns the vertex of a crossed edge, which runs from `low` along an axis.
    fn vertex_of_edge(&mut self, low: [usize; 3], axis: usize) -> Result<u32, OffsetError> {
        let key = 3 * self.grid.number(low) + axis;
        if let Some(vertex) = self.of_edges.get(&key) {
            return Ok(*vertex);
        }
        let mut high = low;
        high[axis] += 1;
        let (a, b) = (self.value(low), self.value(high));
        // NaN is far, so the part of an edge to it is not known.
        let part = Some((self.distance - a) / (b - a)).filter(|part| part.is_finite()).unwrap_or(0.5);
        let ends = [low, high].map(|point| self.grid.point(point));
        let start = ends[0] + (ends[1] - ends[0]) * part.clamp(END, 1.0 - END);
        let between = if a < self.distance { ends } else { [ends[1], ends[0]] };
        let vertex = self.add_vertex(Vertex { start, between })?;
        self.of_edges.insert(key, vertex);
        Ok(vertex)
    }

    /// Adds the triangles of a cell, which is given by its lowest corner.
    ///
    /// The loops of a cell follow from its faces. On each face, seen from outside, an edge that runs from far to near
    /// is linked to the next edge that runs back to far, around the same near corners. `next` has the link of each
    /// edge. Following the links from face to face yields the loops.
    fn add_cell(&mut self, cell: [usize; 3]) -> Result<(), OffsetError> {
        let corner = |c: usize| -> [usize; 3] { std::array::from_fn(|k| cell[k] + (c >> k & 1)) };
        let is_near = [0, 1, 2, 3, 4, 5, 6, 7].map(|c| self.is_near(corner(c)));
        if is_near == [is_near[0]; 8] {
            return Ok(());
        }
        // An edge is identified by its lower corner, which has no bit that the other corner lacks, and by its axis.
        let mut next = [[usize::MAX; 3]; 8];
        let edge = |a: usize, b: usize| (a & b, (a ^ b).trailing_zeros() as usize);
        for face in FACES {
            for i in 0..4 {
                if !is_near[face[i]] && is_near[face[(i + 1) % 4]] {
                    let end = (i + 1..i + 4).find(|j| !is_near[face[(j + 1) % 4]]).unwrap_or(i);
                    let (low, axis) = edge(face[i], face[(i + 1) % 4]);
                    let (next_low, next_axis) = edge(face[end % 4], face[(end + 1) % 4]);
                    next[low][axis] = 3 * next_low + next_axis;
                }
            }
        }
        for first in 0..24 {
            let mut edge = first;
            let mut vertices = Vec::new();
            // Links are removed as they are followed, so no edge is in two loops.
            while let following = std::mem::replace(&mut next[edge / 3][edge % 3], usize::MAX)
                && following != usize::MAX
            {
                vertices.push(self.vertex_of_edge(corner(edge / 3), edge % 3)?);
                edge = following;
            }
            self.add_loop(&vertices)?;
        }
        Ok(())
    }

    /// Adds the triangles of a loop.
    fn add_loop(&mut self, vertices: &[u32]) -> Result<(), OffsetError> {
        match *vertices {
            [] => {}
            [a, b, c] => self.triangles.push([a, b, c]),
            _ => {
                let Vertex { start: origin, between } = self.vertices[vertices[0] as usize];
                let offsets = vertices.iter().map(|v| self.vertices[*v as usize].start - origin);
                let start = origin + offsets.sum::<Vector3<f64>>() / vertices.len() as f64;
                let middle = self.add_vertex(Vertex { start, between })?;
                for (i, v) in vertices.iter().enumerate() {
                    self.triangles.push([*v, vertices[(i + 1) % vertices.len()], middle]);
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sign::SignedDistance;
    use crate::{FieldOptions, distances, signed_distances};
    use p2m_bvh::AabbTree;
    use p2m_core::{Aabb, ClosestPoint, PrimitiveSet};
    use p2m_mixed::generate::{IcoSphere, TorusKnot, ico_sphere, torus_knot};
    use p2m_testkit::{cases, rng};
    use rand::RngExt;

    /// Checks that each edge of a surface has exactly two triangles, in opposite directions, by numbers of vertices
    /// and, if they are apart, by their coordinates. Returns the volume inside.
    fn check(surface: &OffsetSurface) -> f64 {
        let mut directed = HashMap::new();
        for triangle in surface.soup.triangles() {
            for k in 0..3 {
                *directed.entry([triangle[k], triangle[(k + 1) % 3]]).or_insert(0) += 1;
            }
        }
        for ([a, b], count) in &directed {
            assert_eq!((*count, directed.get(&[*b, *a]), a == b), (1, Some(&1), false), "the edge from {a} to {b}");
        }
        let corners = |triangle: &[u32; 3]| triangle.map(|i| surface.soup.positions()[i as usize].coords);
        surface.soup.triangles().iter().map(corners).map(|[a, b, c]| a.dot(&b.cross(&c)) / 6.0).sum()
    }

    fn unsigned(soup: &Soup<f64>, grid: &Grid, distance: f64) -> Result<OffsetSurface, OffsetError> {
        let index = AabbTree::new(soup).unwrap();
        let values = distances(&index, grid, &FieldOptions::default(), &|_| ()).unwrap();
        offset_surface(grid, &values, distance, &|x| index.closest_point(x).map(|found| (found.distance, found.point)))
    }

    fn signed(soup: &Soup<f64>, grid: &Grid, distance: f64) -> Result<OffsetSurface, OffsetError> {
        let index = SignedDistance::new(AabbTree::new(soup).unwrap(), soup).unwrap();
        let values = signed_distances(&index, grid, &FieldOptions::default(), &|_| ()).unwrap();
        offset_surface(grid, &values, distance, &|x| {
            let found = index.closest_point(x)?;
            Some((found.distance()?, found.closest.point))
        })
    }

    #[test]
    fn offsets_of_a_ball_have_its_volume() {
        let ball = ico_sphere(&IcoSphere { frequency: 20 }).unwrap();
        let grid = Grid::around(&ball.aabb(), 41, 1.5).unwrap();
        let volume = |r: f64| 4.0 / 3.0 * std::f64::consts::PI * r.powi(3);
        for distance in [-0.4, -0.1, 0.0, 0.25] {
            let surface = signed(&ball, &grid, distance).unwrap();
            let (found, expected) = (check(&surface), volume(1.0 + distance));
            assert!((found / expected - 1.0).abs() < 0.02, "{distance}: {found} for {expected}");
            assert!(surface.vertex_error <= 1e-7 * grid.spacing(), "{distance}: {}", surface.vertex_error);
            // An edge is at most as long as the diagonal of a cell, and a chord of length l is l^2 / 8 r from its arc.
            let sagitta = 3.0 * grid.spacing().powi(2) / (8.0 * (1.0 + distance));
            assert!(surface.triangle_error < sagitta, "{distance}: {}", surface.triangle_error);
        }
        // Without signs there is a shell on either side.
        let both = unsigned(&ball, &grid, 0.25).unwrap();
        let expected = volume(1.25) - volume(0.75);
        assert!((check(&both) / expected - 1.0).abs() < 0.02 && both.vertex_error <= 1e-7 * grid.spacing());
    }

    #[test]
    fn offsets_of_knots_are_closed_where_they_touch_themselves() {
        let knot = torus_knot(&TorusKnot::default()).unwrap();
        for (distance, resolution) in [(-0.1, 60), (0.2, 40), (0.45, 50), (0.9, 30)] {
            let grid = offset_grid(&knot.aabb(), distance, resolution).unwrap();
            let surface = signed(&knot, &grid, distance).unwrap();
            assert!(check(&surface) > 0.0);
            assert!(surface.vertex_error <= 1e-7 * grid.spacing(), "{distance}: {}", surface.vertex_error);
            assert!(surface.triangle_error < grid.spacing(), "{distance}: {}", surface.triangle_error);
        }
    }

    #[test]
    fn any_values_have_a_closed_surface() {
        for case in cases(400, 20) {
            let mut rng = rng("any values", case);
            let grid = Grid::new(Point3::origin(), 1.0, [7, 6, 8]).unwrap();
            let part = rng.random_range(0.1..0.9);
            let value = |i: usize| {
                let is_border = [(i % 7, 7), (i / 7 % 6, 6), (i / 42, 8)].iter().any(|(i, n)| *i == 0 || i + 1 == *n);
                match (is_border || rng.random_range(0.0..1.0) > part, rng.random_range(0..9)) {
                    (true, 0) => f32::NAN,
                    (is_far, _) => {
                        if is_far {
                            1.0
                        } else {
                            -1.0
                        }
                    }
                }
            };
            let values: Vec<f32> = (0..grid.len()).map(value).collect();
            // Cells meet in every way at once. Nothing moves, because no point has a distance.
            let surface = offset_surface(&grid, &values, 0.0, &|_| None).unwrap();
            let inside = values.iter().filter(|value| **value < 0.0).count();
            assert!(check(&surface) > 0.0 || inside == 0);
        }
    }

    #[test]
    fn grids_of_offsets_contain_them() {
        for (size, distance) in
            [([1.0, 2.0, 0.0], 0.3), ([0.0, 0.0, 0.0], 1.0), ([1.0, 9.0, 3.0], -0.1), ([0.0, 0.0, 5.0], 0.01)]
        {
            let bounds = Aabb { min: [7.0; 3].into(), max: Point3::from([7.0; 3]) + Vector3::from(size) };
            for resolution in [8, 9, 64] {
                let grid = offset_grid(&bounds, distance, resolution).unwrap();
                let last = grid.counts().map(|n| n - 1);
                assert_eq!(last.iter().max(), Some(&(resolution - 1)));
                let (low, high, reach) = (grid.origin(), grid.point(last), distance.max(0.0) + 1.5 * grid.spacing());
                for k in 0..3 {
                    assert!(low[k] < bounds.min[k] - reach && high[k] > bounds.max[k] + reach, "{grid:?}");
                }
            }
        }
        assert!(matches!(offset_grid(&Aabb::empty(), 1.0, 9), Err(GridError::Empty)));
        assert!(matches!(offset_grid(&Aabb::empty(), 1.0, 7), Err(GridError::Count(..))));
    }

    #[test]
    fn creases_are_reached_by_bisection() {
        // Between cables, steps along the gradient go to and fro.
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/knot_and_cables.obj");
        let scene = p2m_mixed::read_scene(file.as_ref()).unwrap().soup;
        let grid = offset_grid(&scene.aabb(), 0.3, 40).unwrap();
        let surface = unsigned(&scene, &grid, 0.3).unwrap();
        assert!(check(&surface) > 0.0);
        assert!(surface.vertex_error <= 1e-7 * grid.spacing(), "{}", surface.vertex_error);
    }

    #[test]
    fn surfaces_that_leave_the_grid_are_refused() {
        let ball = ico_sphere(&IcoSphere { frequency: 4 }).unwrap();
        let grid = Grid::around(&ball.aabb(), 20, 1.2).unwrap();
        assert!(matches!(unsigned(&ball, &grid, 0.5), Err(OffsetError::LeavesGrid { distance: 0.5 })));
        assert!(matches!(unsigned(&ball, &grid, f64::INFINITY), Err(OffsetError::NotFinite { .. })));
        assert!(signed(&ball, &grid, -2.0).unwrap().soup.is_empty());
    }
}
