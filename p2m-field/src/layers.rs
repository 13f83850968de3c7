//! The values of some layers of a grid, which one thread fills.

use super::Grid;

pub(super) struct Layers<'a> {
    pub(super) grid: &'a Grid,
    /// The first one.
    pub(super) first: usize,
    pub(super) values: &'a mut [f32],
}

impl Layers<'_> {
    /// Gives each point of a block a value, by its number in the grid; x fastest.
    pub(super) fn fill(&mut self, first: [usize; 3], counts: [usize; 3], mut value: impl FnMut([usize; 3]) -> f32) {
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
