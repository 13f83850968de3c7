//! Tetrahedra of a triangulation that grows, and numbers that all of its parts use.

/// The number of a neighbour that does not exist: the face is one of the octahedron.
pub(crate) const NO_NEIGHBOUR: u32 = u32::MAX;

/// How many bounding sites there are.
pub const BOUNDING: usize = 6;

/// What was done to build a triangulation. Numbers of predicates include those that needed more than the filter in f64.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Work {
    /// Tetrahedra met on the way to the one around a new point.
    pub steps: u64,
    /// Tetrahedra made, most of which went again.
    pub created: u64,
    /// Points whose cavity had so many faces that edges were not linked through the table.
    pub large_cavities: u64,
    /// Orientations asked for.
    pub orientations: u64,
    /// Those decided in whole numbers.
    pub whole_orientations: u64,
    /// Those left to adaptive arithmetic.
    pub adaptive_orientations: u64,
    /// Points tested against spheres.
    pub spheres: u64,
    /// Those decided in whole numbers.
    pub whole_spheres: u64,
    /// Those decided in double-double.
    pub double_spheres: u64,
    /// Those left to adaptive arithmetic.
    pub adaptive_spheres: u64,
}

/// The face opposite to each vertex, so that orientation_3d of it and the vertex is `Greater`.
pub(crate) const FACES: [[usize; 3]; 4] = [[1, 3, 2], [0, 2, 3], [0, 3, 1], [0, 1, 2]];

/// In the first vertex of a tetrahedron: in the cavity,
pub(crate) const IN_CAVITY: u32 = 1 << 31;
/// or tested, and not in it. Numbers of sites are below.
pub(crate) const NOT_IN_CAVITY: u32 = 1 << 30;

/// Half a cache line.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(crate) struct Tetrahedron {
    /// In place of a removed one the first is [`NO_NEIGHBOUR`]. While a cavity is found, the first has [`IN_CAVITY`] or
    /// [`NOT_IN_CAVITY`] besides, once that is known.
    pub(crate) vertices: [u32; 4],
    /// Across the face opposite to each vertex.
    pub(crate) neighbours: [u32; 4],
}

/// What `number` is the index of; it occurs.
#[inline(always)]
pub(crate) fn index_in(of: &[u32; 4], number: u32) -> usize {
    // Without branches: which it is cannot be predicted.
    usize::from(of[1] == number) + 2 * usize::from(of[2] == number) + 3 * usize::from(of[3] == number)
}
