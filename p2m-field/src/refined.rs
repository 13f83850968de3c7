//! Fields on octrees: a cell is divided into eight where interpolation between its corners misses the distance.

use nalgebra::Point3;
use p2m_core::Aabb;
use std::collections::HashMap;

/// A cube with the values of the field at its corners, between which the field is interpolated trilinearly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// The corner with the smallest coordinates.
    pub origin: Point3<f64>,
    /// The length of an edge, in units of the scene.
    pub size: f64,
    /// The values at the corners. Bit k of the index of a corner is set if the corner is at the upper end of axis k.
    pub values: [f64; 8],
}

impl Cell {
    /// Interpolates the field at a point in the cell.
    #[must_use]
    pub fn value(&self, point: &Point3<f64>) -> f64 {
        let weights = (point - self.origin) / self.size;
        (0..8)
            .map(|c| {
                self.values[c]
                    * (0..3).map(|k| if c >> k & 1 == 1 { weights[k] } else { 1.0 - weights[k] }).product::<f64>()
            })
            .sum()
    }
}

/// Options of [`refined`]: the resolution of a field on an octree.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct RefineOptions {
    /// The largest interpolation error in cells that the surface may cross, in units of the scene. The error is
    /// measured at the centres of the cell, its faces and its edges, and a cell with a larger one is divided.
    pub error: f64,
    /// The largest interpolation error in all other cells, as a fraction of the distance. By default it is infinite, so
    /// these cells are as large as possible.
    pub relative: f64,
    /// The largest number of divisions above a cell. The default is 12.
    pub depth: u32,
}

impl RefineOptions {
    /// Allows this interpolation error near the surface, in units of the scene.
    #[must_use]
    pub fn new(error: f64) -> Self {
        Self { error, relative: f64::INFINITY, depth: 12 }
    }
    /// Sets the largest interpolation error away from the surface, as a fraction of the distance.
    #[must_use]
    pub fn with_relative(self, relative: f64) -> Self {
        Self { relative, ..self }
    }
    /// Sets the largest number of divisions above a cell.
    #[must_use]
    pub fn with_depth(self, depth: u32) -> Self {
        Self { depth, ..self }
    }
}

/// Returns the leaves of an octree over a cube around `bounds`, in depth-first order.
///
/// `distance` is the field: the distance of the scene from a point, with or without a sign. It is called once for
/// each point. Where a small cell touches a large one the interpolated field is discontinuous, by at most the error
/// of the large cell.
///
/// # Complexity
/// Each examined cell needs 27 points, most of which it shares with its neighbours. Memory is 32 bytes per point
/// until the function returns.
pub fn refined(bounds: &Aabb<f64>, distance: &dyn Fn(&Point3<f64>) -> f64, options: &RefineOptions) -> Vec<Cell> {
    let half = (0..3).map(|k| bounds.max[k] * 0.5 - bounds.min[k] * 0.5).fold(0.0, f64::max);
    let origin = std::array::from_fn::<f64, 3, _>(|k| bounds.min[k] * 0.5 + bounds.max[k] * 0.5 - half);
    let mut refine = Refine {
        origin,
        unit: half / f64::from(1u32 << options.depth.min(MAX_DEPTH)),
        distance,
        options,
        values: HashMap::new(),
        cells: Vec::new(),
    };
    if half > 0.0 && half.is_finite() {
        refine.add_cell([0; 3], options.depth.min(MAX_DEPTH));
    }
    refine.cells
}

/// The largest number of divisions above a cell, whatever the options say.
const MAX_DEPTH: u32 = 28;

struct Refine<'a> {
    origin: [f64; 3],
    /// Half of the edge of a cell of the greatest depth. A point is identified by its offset from `origin`
    /// in this unit.
    unit: f64,
    distance: &'a dyn Fn(&Point3<f64>) -> f64,
    options: &'a RefineOptions,
    /// The values of the field that were computed so far.
    values: HashMap<[u32; 3], f64>,
    cells: Vec<Cell>,
}

impl Refine<'_> {
    fn point(&self, offset: [u32; 3]) -> Point3<f64> {
        std::array::from_fn::<f64, 3, _>(|k| self.origin[k] + self.unit * f64::from(offset[k])).into()
    }

    fn value(&mut self, offset: [u32; 3]) -> f64 {
        let point = self.point(offset);
        *self.values.entry(offset).or_insert_with(|| (self.distance)(&point))
    }

    /// Adds the cell with this lowest corner, or the cells that it is divided into at most `depth` times.
    fn add_cell(&mut self, first: [u32; 3], depth: u32) {
        let half = 1u32 << depth;
        let values = [0u32, 1, 2, 3, 4, 5, 6, 7]
            .map(|c| self.value(std::array::from_fn(|k| first[k] + 2 * half * (c >> k & 1))));
        let cell = Cell { origin: self.point(first), size: self.unit * f64::from(2 * half), values };
        if depth == 0 || !self.is_divided(&cell, first, half) {
            self.cells.push(cell);
            return;
        }
        for octant in 0..8u32 {
            self.add_cell(std::array::from_fn(|k| first[k] + half * (octant >> k & 1)), depth - 1);
        }
    }

    /// Whether the interpolation error of the cell exceeds the limit that the options give.
    fn is_divided(&mut self, cell: &Cell, first: [u32; 3], half: u32) -> bool {
        let distance_at_centre = self.value(first.map(|x| x + half)).abs();
        // The surface does not cross the cell if it is farther from the centre than a corner is. NaN compares as
        // `false`, so a cell without a distance may have surface in it.
        let is_off_surface = distance_at_centre > cell.size * 0.75f64.sqrt();
        let may_have_surface = !is_off_surface;
        if !may_have_surface && self.options.relative == f64::INFINITY {
            return false;
        }
        // The interpolation is exact at the corners, so the loop leaves them out of the 27 points.
        (0..27u32).any(|n| {
            let steps = [n % 3, n / 3 % 3, n / 9];
            if steps.iter().all(|s| *s != 1) {
                return false;
            }
            let offset = std::array::from_fn(|k| first[k] + half * steps[k]);
            let value = self.value(offset);
            let error = (cell.value(&self.point(offset)) - value).abs();
            let allowed = if may_have_surface { self.options.error } else { self.options.relative * value.abs() };
            error > allowed
        })
    }
}
