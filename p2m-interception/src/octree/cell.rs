//! Cubes, their corners and the lattice of their children's corners.

use crate::list::corner_test::Corner;
use p2m_core::Aabb;
use p2m_core::engine::vector::V3;

#[derive(Clone, Copy)]
pub(crate) struct Cube {
    pub(crate) low: V3,
    pub(crate) side: f64,
    /// Halvings from the cube of the whole domain.
    pub(crate) level: u8,
    pub(crate) corners: [Corner; 8],
}

/// CellCorners of the children of a cube: 3 on each axis.
pub(crate) const LATTICE_POINTS: usize = 27;
/// The middle of the cube.
pub(crate) const LATTICE_CENTRE: usize = LATTICE_POINTS / 2;

/// The lattice points of the corners of each child.
pub(crate) const CHILD_CORNERS: [[usize; 8]; 8] = {
    let mut all = [[0; 8]; 8];
    let mut child = 0;
    while child < 8 {
        let mut corner = 0;
        while corner < 8 {
            let mut step = 1;
            let mut k = 0;
            while k < 3 {
                all[child][corner] += step * ((child >> k & 1) + (corner >> k & 1));
                step *= 3;
                k += 1;
            }
            corner += 1;
        }
        child += 1;
    }
    all
};

/// The lattice points that are neither corners of the cube nor its middle.
pub(crate) const NEW_LATTICE_POINTS: [usize; LATTICE_POINTS - 9] = {
    let mut all = [0; LATTICE_POINTS - 9];
    let mut count = 0;
    let mut at = 0;
    while at < LATTICE_POINTS {
        let is_halfway = at % 3 == 1 || at / 3 % 3 == 1 || at / 9 == 1;
        if is_halfway && at != LATTICE_CENTRE {
            all[count] = at;
            count += 1;
        }
        at += 1;
    }
    assert!(count == all.len());
    all
};

/// The corner of the cube itself that lies on a lattice point, if there is one.
pub(crate) fn cube_corner_at(at: usize) -> Option<usize> {
    (0..8).find(|&corner| 2 * CHILD_CORNERS[0][corner] == at)
}

impl Cube {
    /// A point of the lattice: exact, since cubes are dyadic.
    pub(crate) fn point(&self, at: usize) -> V3 {
        let steps = [at % 3, at / 3 % 3, at / 9];
        std::array::from_fn(|k| self.low[k] + self.side * 0.5 * steps[k] as f64)
    }

    pub(crate) fn bounds(&self) -> Aabb<f64> {
        Aabb { min: self.low.into(), max: self.low.map(|x| x + self.side).into() }
    }

    /// Its eight halves, given the corners on the whole lattice.
    pub(crate) fn children(&self, lattice: &[Corner; LATTICE_POINTS]) -> [Self; 8] {
        std::array::from_fn(|child| Self {
            low: lattice[CHILD_CORNERS[child][0]].x,
            side: self.side * 0.5,
            level: self.level + 1,
            corners: CHILD_CORNERS[child].map(|at| lattice[at]),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn children_share_the_lattice() {
        let cube =
            Cube { low: [-1.0, 2.0, 0.5], side: 4.0, level: 3, corners: [Corner { x: [0.0; 3], y: [0.0; 3] }; 8] };
        let lattice: [Corner; LATTICE_POINTS] =
            std::array::from_fn(|at| Corner { x: cube.point(at), y: cube.point(at) });
        assert_eq!(cube.point(LATTICE_CENTRE), [1.0, 4.0, 2.5]);
        assert_eq!((0..LATTICE_POINTS).filter_map(cube_corner_at).collect::<Vec<_>>(), [0, 1, 2, 3, 4, 5, 6, 7]);
        assert!(
            NEW_LATTICE_POINTS.is_sorted()
                && NEW_LATTICE_POINTS.iter().all(|&at| cube_corner_at(at).is_none() && at != LATTICE_CENTRE)
        );
        for (c, child) in cube.children(&lattice).iter().enumerate() {
            assert_eq!((child.side, child.level), (2.0, 4));
            for (i, corner) in child.corners.iter().enumerate() {
                for k in 0..3 {
                    let steps = (c >> k & 1) + (i >> k & 1);
                    assert_eq!(corner.x[k], cube.low[k] + 2.0 * steps as f64);
                }
            }
        }
    }
}
