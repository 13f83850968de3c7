//! A coarser picture of a scene that has more triangles than a browser draws.

use p2m_core::Soup;
use std::collections::HashMap;

/// The largest number of primitives of a picture.
pub(crate) const MAX_PRIMITIVES: usize = 1_000_000;
/// The number of cells along each axis that is tried first; it is halved while there are too many primitives.
const FIRST_CELLS: f64 = 1024.0;

/// Returns for each vertex a vertex that stands for it, so that at most [`MAX_PRIMITIVES`] primitives keep distinct
/// vertices. Vertices in the same cell of a grid have the same one. `positions` are in the frame of the picture.
#[allow(clippy::cast_possible_truncation, reason = "cells of a grid over positions within 1")]
pub(crate) fn representatives(soup: &Soup<f64>, positions: &[[f32; 3]]) -> Vec<u32> {
    let mut cells = FIRST_CELLS;
    loop {
        let mut first = HashMap::new();
        let cell = |p: &[f32; 3]| p.map(|x| (f64::from(x) * cells / 2.0).floor() as i32);
        let stand_ins: Vec<u32> =
            (0u32..).zip(positions).map(|(i, position)| *first.entry(cell(position)).or_insert(i)).collect();
        let kept = soup.elements().filter(|e| is_distinct(e.indices(), &stand_ins)).count();
        let points = soup.points().len().min(first.len());
        if kept - soup.points().len() + points <= MAX_PRIMITIVES || cells < 4.0 {
            return stand_ins;
        }
        cells /= 2.0;
    }
}

/// Returns whether no two vertices of a primitive have the same stand-in.
pub(crate) fn is_distinct(indices: &[u32], stand_ins: &[u32]) -> bool {
    let stand_in = |i: usize| stand_ins[indices[i] as usize];
    (0..indices.len()).all(|i| (0..i).all(|j| stand_in(i) != stand_in(j)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;
    use p2m_core::Element;

    #[test]
    fn vertices_of_one_cell_have_one_representative() {
        let positions = [[0.0, 0.0, 0.0], [1e-6, 0.0, 0.0], [0.5, 0.0, 0.0], [0.0, 0.5, 0.0]];
        let points: Vec<_> = positions.iter().map(|p: &[f32; 3]| Point3::from(p.map(f64::from))).collect();
        let soup = Soup::new(points, [Element::Triangle([0, 1, 2]), Element::Triangle([1, 2, 3])]).unwrap();
        let stand_ins = representatives(&soup, &positions);
        assert_eq!(stand_ins, [0, 0, 2, 3]);
        assert!(!is_distinct(&[0, 1, 2], &stand_ins) && is_distinct(&[1, 2, 3], &stand_ins));
    }
}
