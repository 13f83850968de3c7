//! The part of a field that one thread fills: the values of consecutive layers of the grid.

use crate::grid::Grid;

/// Consecutive layers of a grid, with a value for each of their points.
pub(crate) struct Layers<'a> {
    pub(crate) grid: &'a Grid,
    /// The index of the lowest layer.
    pub(crate) first: usize,
    /// The values, with x running fastest and z slowest.
    pub(crate) values: &'a mut [f32],
}

impl Layers<'_> {
    /// Sets the values of a block of points; `value` computes one from the indices of its point and is called with
    /// x running fastest.
    pub(crate) fn fill(&mut self, first: [usize; 3], counts: [usize; 3], mut value: impl FnMut([usize; 3]) -> f32) {
        let before = self.grid.number([0, 0, self.first]);
        for (j, k) in (0..counts[1] * counts[2]).map(|n| (n % counts[1], n / counts[1])) {
            let row = [first[0], first[1] + j, first[2] + k];
            let start = self.grid.number(row) - before;
            for (i, out) in self.values[start..start + counts[0]].iter_mut().enumerate() {
                *out = value([row[0] + i, row[1], row[2]]);
            }
        }
    }
}
