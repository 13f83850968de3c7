//! Fields on octrees: cells are cut in eight where the distance is not what its values at the corners say.

use nalgebra::Point3;
use p2m_core::Aabb;
use std::collections::HashMap;

/// A cube with the field at its corners, between which it is interpolated by each coordinate (trilinearly).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// The corner of the least coordinates.
    pub origin: Point3<f64>,
    /// The length of its sides.
    pub size: f64,
    /// The values at its corners; bit k of the number of a corner says whether it is at the end of axis k.
    pub values: [f64; 8],
}

impl Cell {
    /// The field at a place in the cell.
    #[must_use]
    pub fn value(&self, place: &Point3<f64>) -> f64 {
        let weights = (place - self.origin) / self.size;
        (0..8)
            .map(|c| {
                self.values[c]
                    * (0..3).map(|k| if c >> k & 1 == 1 { weights[k] } else { 1.0 - weights[k] }).product::<f64>()
            })
            .sum()
    }
}

/// How fine a field on an octree is.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct RefineOptions {
    /// Cells that the surface may run through are cut where the interpolated field is farther than this from the distance, at
    /// the middle of the cell, of a face or of an edge; in units of the scene.
    pub error: f64,
    /// Other cells are cut where it is off by more than this part of the distance. Infinite by default: they are as coarse as can be.
    pub relative: f64,
    /// Cells are not cut more often than this: 12 by default.
    pub depth: u32,
}

impl RefineOptions {
    /// To this error where the surface is.
    #[must_use]
    pub fn new(error: f64) -> Self {
        Self { error, relative: f64::INFINITY, depth: 12 }
    }
    /// To this part of the distance elsewhere.
    #[must_use]
    pub fn with_relative(self, relative: f64) -> Self {
        Self { relative, ..self }
    }
    /// Cut at most so often.
    #[must_use]
    pub fn with_depth(self, depth: u32) -> Self {
        Self { depth, ..self }
    }
}

/// The leaves of an octree over a cube around `bounds`, in depth-first order. `distance` is the field: `|q|` the distance of
/// the scene, signed or not.
///
/// Each place is asked once. Cells share corners, but where a small one is beside a large one the field jumps by no more than the
/// error of the large one there.
///
/// # Complexity
/// 27 places for each cell that is looked at, most of them shared with neighbours; 32 bytes a place while it runs.
pub fn refined(bounds: &Aabb<f64>, distance: &dyn Fn(&Point3<f64>) -> f64, options: &RefineOptions) -> Vec<Cell> {
    let half = (0..3).map(|k| bounds.max[k] * 0.5 - bounds.min[k] * 0.5).fold(0.0, f64::max);
    let origin = std::array::from_fn::<f64, 3, _>(|k| bounds.min[k] * 0.5 + bounds.max[k] * 0.5 - half);
    let mut refine = Refine {
        origin,
        // Places are numbered by their multiples of half of the smallest cell.
        unit: half / f64::from(1u32 << options.depth.min(MOST)),
        distance,
        options,
        known: HashMap::new(),
        cells: Vec::new(),
    };
    if half > 0.0 && half.is_finite() {
        refine.cell([0; 3], options.depth.min(MOST));
    }
    refine.cells
}

/// No field is cut more often.
const MOST: u32 = 28;

struct Refine<'a> {
    origin: [f64; 3],
    unit: f64,
    distance: &'a dyn Fn(&Point3<f64>) -> f64,
    options: &'a RefineOptions,
    known: HashMap<[u32; 3], f64>,
    cells: Vec<Cell>,
}

impl Refine<'_> {
    fn place(&self, number: [u32; 3]) -> Point3<f64> {
        std::array::from_fn::<f64, 3, _>(|k| self.origin[k] + self.unit * f64::from(number[k])).into()
    }

    fn at(&mut self, number: [u32; 3]) -> f64 {
        let place = self.place(number);
        *self.known.entry(number).or_insert_with(|| (self.distance)(&place))
    }

    /// The cell that begins at a place and may be cut so often.
    fn cell(&mut self, first: [u32; 3], depth: u32) {
        let half = 1u32 << depth;
        let values =
            [0u32, 1, 2, 3, 4, 5, 6, 7].map(|c| self.at(std::array::from_fn(|k| first[k] + 2 * half * (c >> k & 1))));
        let cell = Cell { origin: self.place(first), size: self.unit * f64::from(2 * half), values };
        if depth == 0 || !self.is_cut(&cell, first, half) {
            self.cells.push(cell);
            return;
        }
        for part in 0..8u32 {
            self.cell(std::array::from_fn(|k| first[k] + half * (part >> k & 1)), depth - 1);
        }
    }

    fn is_cut(&mut self, cell: &Cell, first: [u32; 3], half: u32) -> bool {
        let middle = self.at(first.map(|x| x + half)).abs();
        // The surface is no nearer to the middle than that; without a number it may be anywhere.
        let is_beside = middle > cell.size * 0.75f64.sqrt();
        let may_have_surface = !is_beside;
        if !may_have_surface && self.options.relative == f64::INFINITY {
            return false;
        }
        // All but the corners of the 27 places.
        (0..27u32).any(|n| {
            let steps = [n % 3, n / 3 % 3, n / 9];
            if steps.iter().all(|s| *s != 1) {
                return false;
            }
            let number = std::array::from_fn(|k| first[k] + half * steps[k]);
            let value = self.at(number);
            let error = (cell.value(&self.place(number)) - value).abs();
            let allowed = if may_have_surface { self.options.error } else { self.options.relative * value.abs() };
            error > allowed
        })
    }
}
