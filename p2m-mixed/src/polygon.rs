//! Triangulation of polygons.

use earcut::Earcut;
use nalgebra::Point3;
use p2m_core::engine::arithmetic::cross;
use p2m_core::kernel::power_of_two;

/// The largest number of vertices of a polygon in a file: 2^15. The limit bounds the time of triangulation, which is
/// quadratic for simple concave polygons (observed: two to three seconds for a spiral of this size).
pub const MAX_CORNERS: usize = 1 << 15;

/// The largest sum of the squared numbers of vertices over all polygons of a file with more than 256 vertices: 2^34,
/// which sixteen polygons of [`MAX_CORNERS`] reach. It bounds the time of triangulation (observed: about half a
/// minute).
pub(crate) const MAX_CORNER_SQUARES: u64 = 1 << 34;

/// The number of corners above which a polygon is checked for repeated corners before it is triangulated.
pub(crate) const CHECK_REPEATS_ABOVE_CORNERS: usize = 256;

/// Divides polygons into triangles, and reuses its buffers for the next polygon.
///
/// The polygon is projected along the axis on which its normal (by Newell's sum) is largest, and triangulated in the
/// projection:
///
/// - A simple planar polygon, convex or concave, is covered exactly and without overlap, up to rounding of the
///   orientation of three points; on small integer coordinates there is no rounding.
/// - A polygon that is not planar gets the triangles of its projection. They form a patch without gaps if the
///   projection is simple.
/// - A polygon without area becomes a triangle fan. So does a polygon that crosses itself, whose triangles do not add
///   up to its area, because there is no correct triangulation.
/// - A large polygon with less than half as many distinct corners as corners becomes a fan as well, because cutting
///   ears would take cubic time.
///
/// In every case each edge of the polygon is an edge of a triangle, so the outline is complete.
///
/// Triangles have the winding of the polygon in the projection, except some triangles in the fan of a polygon that
/// crosses itself or repeats corners.
#[derive(Default)]
pub(crate) struct Triangulator {
    offsets: Vec<[f64; 3]>,
    projected: Vec<[f64; 2]>,
    cutter: Option<Earcut<f64>>,
    indices: Vec<u32>,
    edges: Vec<[u32; 2]>,
    corner_keys: Vec<[u64; 2]>,
    triangles: Vec<[u32; 3]>,
    /// The number of polygons so far that became fans because they cross themselves or repeat most corners.
    pub(crate) uncovered: u64,
}

impl Triangulator {
    /// Triangulates the polygon with these corners, of which there are at least three. Triangles are
    /// indices of corners.
    pub(crate) fn triangulate(&mut self, corners: &[Point3<f64>]) -> &[[u32; 3]] {
        let n = corners.len();
        if n == 3 {
            self.make_fan(0, n);
        } else if !self.project(corners) {
            // A polygon without area has triangles without area, or it crosses itself.
            self.uncovered += u64::from(!self.is_flat());
            self.make_fan(0, n);
        } else if self.fan_covers(0) {
            self.make_fan(0, n);
        } else if n == 4 {
            // One of the two diagonals of a simple quadrilateral is inside.
            let second_covers = self.fan_covers(1);
            self.uncovered += u64::from(!second_covers);
            self.make_fan(u32::from(second_covers), n);
        } else {
            let repeats = n > CHECK_REPEATS_ABOVE_CORNERS && 2 * self.count_distinct_corners() < n;
            if !repeats {
                self.cut_ears();
            }
            if repeats || !self.covers() {
                self.uncovered += 1;
                self.make_fan(0, n);
            }
        }
        &self.triangles
    }

    /// Projects the corners, with the first corner at the origin and the extent near 1. Returns `false` if the polygon
    /// has no area.
    fn project(&mut self, corners: &[Point3<f64>]) -> bool {
        // Scales are powers of two, so they do not round. The first one prevents the overflow of differences, the
        // second one prevents the underflow of products of differences.
        let scale = Scale::to_unit(corners.iter().flat_map(|p| p.iter().copied()));
        let first = scale.apply3(corners[0].coords.into());
        self.offsets.clear();
        self.offsets.extend(corners.iter().map(|p| {
            let p = scale.apply3(p.coords.into());
            [p[0] - first[0], p[1] - first[1], p[2] - first[2]]
        }));
        let scale = Scale::to_unit(self.offsets.iter().flatten().copied());
        for offset in &mut self.offsets {
            *offset = scale.apply3(*offset);
        }

        let mut normal = [0.0; 3];
        for pair in self.offsets.windows(2) {
            for (k, sum) in normal.iter_mut().enumerate() {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                *sum += pair[0][i] * pair[1][j] - pair[0][j] * pair[1][i];
            }
        }
        let axis = (1..3).fold(0, |best, k| if normal[k].abs() > normal[best].abs() { k } else { best });
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        self.projected.clear();
        self.projected.extend(self.offsets.iter().map(|o| [o[i], o[j]]));
        normal[axis] != 0.0
    }

    /// Returns whether all triangles of the fan around the first corner have no area, up to rounding.
    fn is_flat(&self) -> bool {
        self.offsets.windows(2).all(|pair| cross(pair[0], pair[1]).iter().all(|x| x.abs() <= 8.0 * f64::EPSILON))
    }

    /// Returns whether the fan around corner `apex` is a triangulation.
    ///
    /// The oriented triangles of a fan add up to the winding number of the polygon, wherever its apex is. So if all of
    /// them have the same orientation and the polygon is simple, they cover its inside exactly once. A convex polygon
    /// passes with any apex.
    fn fan_covers(&self, apex: u32) -> bool {
        let n = self.projected.len();
        let (mut left, mut right) = (false, false);
        for triangle in triangle_fan(apex, n) {
            let area = area(&self.projected, triangle);
            left |= area > 0.0;
            right |= area < 0.0;
        }
        !(left && right)
    }

    /// Returns the number of distinct projected corners.
    fn count_distinct_corners(&mut self) -> usize {
        self.corner_keys.clear();
        // The sum of -0 and 0 is 0, so equal corners have equal bits.
        self.corner_keys.extend(self.projected.iter().map(|p| p.map(|x| (x + 0.0).to_bits())));
        self.corner_keys.sort_unstable();
        self.corner_keys.dedup();
        self.corner_keys.len()
    }

    fn make_fan(&mut self, apex: u32, n: usize) {
        self.triangles.clear();
        self.triangles.extend(triangle_fan(apex, n));
    }

    /// Triangulates by cutting ears, and then adds the edges that the ear cutter left out.
    fn cut_ears(&mut self) {
        let cutter = self.cutter.get_or_insert_with(Earcut::new);
        cutter.earcut_slice::<u32>(&self.projected, &[], &mut self.indices);
        let positive = outline_area(&self.projected) > 0.0;
        self.triangles.clear();
        for t in self.indices.chunks_exact(3) {
            let triangle = [t[0], t[1], t[2]];
            let turned = (area(&self.projected, triangle) > 0.0) != positive;
            self.triangles.push(if turned { [t[0], t[2], t[1]] } else { triangle });
        }
        self.add_missing_edges();
    }

    /// Adds each edge of the polygon that no triangle has as a degenerate triangle. The ear cutter leaves out spikes
    /// and parts of polygons that cross or touch themselves. It keeps every corner of a simple polygon.
    #[allow(clippy::cast_possible_truncation, reason = "at most MAX_CORNERS corners")]
    fn add_missing_edges(&mut self) {
        let edge = |a: u32, b: u32| [a.min(b), a.max(b)];
        self.edges.clear();
        self.edges.extend(self.triangles.iter().flat_map(|&[a, b, c]| [edge(a, b), edge(b, c), edge(c, a)]));
        self.edges.sort_unstable();
        let n = self.projected.len() as u32;
        for a in 0..n {
            let b = (a + 1) % n;
            if self.edges.binary_search(&edge(a, b)).is_err() {
                self.triangles.push([a, b, b]);
            }
        }
    }

    /// Returns whether the areas of the triangles add up to that of the polygon, within the rounding error.
    #[allow(clippy::cast_precision_loss, reason = "at most MAX_CORNERS corners")]
    fn covers(&self) -> bool {
        let n = self.projected.len();
        let outline = outline_area(&self.projected).abs();
        let inside: f64 = self.triangles.iter().map(|&t| area(&self.projected, t).abs()).sum();
        // To first order a sum of m terms has an error of m u times the sum of their magnitudes, where u = EPSILON / 2.
        // Terms come from coordinates of magnitude up to 2 and differences up to 4, so each term has an error below 64
        // u. The products of the outline are at most 8 each.
        let terms = (n + self.triangles.len()) as f64;
        let sizes = inside + 8.0 * n as f64;
        (inside - outline).abs() <= 0.5 * f64::EPSILON * terms * (sizes + 64.0)
    }
}

#[allow(clippy::cast_possible_truncation, reason = "at most MAX_CORNERS corners")]
fn triangle_fan(apex: u32, n: usize) -> impl Iterator<Item = [u32; 3]> {
    let n = n as u32;
    (1..n - 1).map(move |i| [apex, (apex + i) % n, (apex + i + 1) % n])
}

/// Returns twice the signed area, which is positive if the corners are counter-clockwise.
fn area(projected: &[[f64; 2]], [a, b, c]: [u32; 3]) -> f64 {
    let [a, b, c] = [a, b, c].map(|i| projected[i as usize]);
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Returns twice the signed area of the polygon, whose first corner is the origin.
fn outline_area(projected: &[[f64; 2]]) -> f64 {
    projected.windows(2).map(|p| p[0][0] * p[1][1] - p[0][1] * p[1][0]).sum()
}

/// A power of two as a product of two factors, because the inverse of a tiny number may exceed the range of f64.
struct Scale([f64; 2]);

impl Scale {
    /// Returns the scale that brings the largest of some finite numbers into [1, 2), or near to it if it is subnormal.
    #[allow(clippy::cast_possible_truncation, reason = "11 bits")]
    fn to_unit(numbers: impl Iterator<Item = f64>) -> Self {
        let largest = numbers.fold(0.0f64, |m, x| m.max(x.abs()));
        let exponent = (largest.to_bits() >> 52) as i32 - 1023;
        let half = -exponent / 2;
        Self([power_of_two(half), power_of_two(-exponent - half)])
    }

    fn apply3(&self, v: [f64; 3]) -> [f64; 3] {
        v.map(|x| x * self.0[0] * self.0[1])
    }
}
