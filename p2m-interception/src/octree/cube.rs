//! The cubes of an octree, and the lattice of the corners of their children.

use crate::list::corner_test::Corner;
use p2m_core::Aabb;
use p2m_core::engine::vector::V3;

/// A cube with its corners. Corner c lies on the upper side along axis k if bit k of c is set.
#[derive(Clone, Copy)]
pub(crate) struct Cube {
    /// The corner with the least coordinates.
    pub(crate) low: V3,
    /// The length of an edge.
    pub(crate) side: f64,
    /// The number of halvings from the cube of the domain.
    pub(crate) level: u8,
    /// The corners with their dominators.
    pub(crate) corners: [Corner; 8],
}

/// The number of corners that the children of a cube have together: 3 on each axis.
pub(crate) const LATTICE_POINTS: usize = 27;
/// The lattice point in the centre of the cube.
pub(crate) const LATTICE_CENTRE: usize = LATTICE_POINTS / 2;

/// For each child of a cube the lattice points at its corners.
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

/// The lattice points at the corners of the cube.
pub(crate) const CUBE_CORNERS: [usize; 8] = {
    let mut all = CHILD_CORNERS[0];
    let mut corner = 0;
    while corner < 8 {
        all[corner] *= 2;
        corner += 1;
    }
    all
};

/// Returns the corner of the cube at a lattice point, if there is one.
pub(crate) fn cube_corner_at(at: usize) -> Option<usize> {
    CUBE_CORNERS.into_iter().position(|corner| corner == at)
}

impl Cube {
    /// Returns a lattice point. It is exact, since the coordinates of cubes are dyadic.
    pub(crate) fn point(&self, at: usize) -> V3 {
        let steps = [at % 3, at / 3 % 3, at / 9];
        std::array::from_fn(|k| self.low[k] + self.side * 0.5 * steps[k] as f64)
    }

    /// Returns the cube as a box.
    pub(crate) fn bounds(&self) -> Aabb<f64> {
        Aabb { min: self.low.into(), max: self.low.map(|x| x + self.side).into() }
    }

    /// Returns the eight children, given the corners on the whole lattice.
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
