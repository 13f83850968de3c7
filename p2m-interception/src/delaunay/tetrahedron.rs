//! The tetrahedra of a triangulation that grows, and the numbers that all parts of the construction use.

/// The number of a neighbour that does not exist, because the face is one of the octahedron.
pub(crate) const NO_NEIGHBOUR: u32 = u32::MAX;

/// The number of bounding sites.
pub const BOUNDING: usize = 6;

/// The work of building a triangulation. The counts of predicates include those that the filter in f64 decided.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Work {
    /// Tetrahedra that were visited to locate new points.
    pub steps: u64,
    /// Tetrahedra that were created, most of which were removed again.
    pub created: u64,
    /// Points whose cavity had so many faces that the table of edges could not link the new tetrahedra.
    pub large_cavities: u64,
    /// Orientation tests of a point and a face.
    pub orientations: u64,
    /// Orientation tests that integers decided.
    pub whole_orientations: u64,
    /// Orientation tests that adaptive arithmetic decided.
    pub adaptive_orientations: u64,
    /// Tests of a point against a sphere.
    pub spheres: u64,
    /// Sphere tests that integers decided.
    pub whole_spheres: u64,
    /// Sphere tests that double-double arithmetic decided.
    pub double_spheres: u64,
    /// Sphere tests that adaptive arithmetic decided.
    pub adaptive_spheres: u64,
}

/// The vertices of the face opposite to each vertex, in an order in which `orientation_3d` of the face and the vertex
/// is `Greater`.
pub(crate) const FACES: [[usize; 3]; 4] = [[1, 3, 2], [0, 2, 3], [0, 3, 1], [0, 1, 2]];

/// The flag, in the first vertex of a tetrahedron, of a tetrahedron in the current cavity. Numbers of sites are
/// below both flags.
pub(crate) const IN_CAVITY: u32 = 1 << 31;
/// The flag, in the first vertex of a tetrahedron, of a tetrahedron that was tested and is not in the current cavity.
pub(crate) const NOT_IN_CAVITY: u32 = 1 << 30;

/// A tetrahedron in half a cache line.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(crate) struct Tetrahedron {
    /// The sites at the vertices. The first one of a removed tetrahedron is [`NO_NEIGHBOUR`]. While a cavity is found,
    /// the first one has the flag [`IN_CAVITY`] or [`NOT_IN_CAVITY`] once the tetrahedron has been tested.
    pub(crate) vertices: [u32; 4],
    /// The neighbours across the faces opposite to the vertices.
    pub(crate) neighbours: [u32; 4],
}

/// Returns the index of a number that occurs in `of`.
#[inline(always)]
pub(crate) fn index_in(of: &[u32; 4], number: u32) -> usize {
    // The index cannot be predicted, so it is computed without branches.
    usize::from(of[1] == number) + 2 * usize::from(of[2] == number) + 3 * usize::from(of[3] == number)
}
