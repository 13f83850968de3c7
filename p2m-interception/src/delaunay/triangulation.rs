//! The finished triangulation.

use crate::delaunay::insert::Insertion;
use crate::delaunay::tetrahedron::{BOUNDING, NO_NEIGHBOUR, Work};
use crate::delaunay::{compact, order, scale};

/// Why there is no triangulation.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DelaunayError {
    /// A coordinate is NaN or infinite.
    #[error("point {index} has a coordinate that is not finite")]
    NonFinite {
        /// The first such point.
        index: usize,
    },
    /// More points, or tetrahedra, than numbers, or more tetrahedra than allowed.
    #[error("{len} points are too many, or have too many tetrahedra")]
    TooMany {
        /// How many points there are.
        len: usize,
    },
    /// The bounding sites are too near or too far.
    #[error("a reach of {reach} is not from {} to {}", Delaunay::MIN_REACH, Delaunay::MAX_REACH)]
    Reach {
        /// The reach that was asked for.
        reach: f64,
    },
}

/// Delaunay tetrahedra of points inside an octahedron of six bounding sites.
#[derive(Clone, Debug)]
pub struct Delaunay {
    pub(crate) sites: Vec<[f64; 3]>,
    pub(crate) unit: f64,
    pub(crate) site_of: Vec<u32>,
    pub(crate) tetrahedra: Vec<[u32; 4]>,
    pub(crate) neighbours: Vec<[u32; 4]>,
    pub(crate) work: Work,
}

impl Delaunay {
    /// In place of a neighbour: the face is one of the octahedron.
    pub const NONE: u32 = NO_NEIGHBOUR;
    /// The nearest that bounding sites may be: the octahedron contains the box of the points.
    pub const MIN_REACH: f64 = 3.0;
    /// The farthest.
    pub const MAX_REACH: f64 = 1_048_576.0;
    /// The max_tetrahedra points.
    pub const MAX_POINTS: usize = (1 << 30) - BOUNDING;

    /// Triangulates any finite points; equal ones become one site (0.0 == -0.0). No points have the four tetrahedra of
    /// the octahedron.
    ///
    /// `reach` is the distance of the bounding sites from the centre of the points' box, in halves of its largest side;
    /// a box without size counts as one with a side of twice [`unit`](Self::unit). It is rounded up by at max_tetrahedra 1 %, or,
    /// for boxes that are small beside their coordinates, to some 2^-46 of those. From
    /// [`MIN_REACH`](Self::MIN_REACH) on, all points are strictly inside the octahedron and their Voronoi cells are
    /// bounded. No bounding site is the nearest site for queries in the box scaled by s about its centre if the reach R
    /// obeys R (R - 2 s) > 3 + 6 s: 22.78 for s = 10, 4.28 for s = 1.05.
    ///
    /// # Errors
    /// A coordinate that is not finite, a reach out of range, or too many points or tetrahedra.
    ///
    /// # Complexity
    /// O(n log n) expected for points spread over a surface or in space; O(n^2) at worst, as is the number of
    /// tetrahedra. While building 32 bytes a tetrahedron and 60 a point, besides what remains
    /// ([`memory`](Self::memory)).
    pub fn new(points: &[[f64; 3]], reach: f64) -> Result<Self, DelaunayError> {
        Self::within(points, reach, Self::NONE as usize)
    }

    /// The same with at max_tetrahedra `max_tetrahedra` tetrahedra at a time and eight times as many in all, max_tetrahedra of which go again: points in
    /// space have seven each, and 30 are made for each (observed); points on two skew lines have a quarter of the square of
    /// their number.
    ///
    /// # Errors
    /// As [`new`](Self::new), and [`DelaunayError::TooMany`] for more than that, as soon as it is known.
    pub fn within(points: &[[f64; 3]], reach: f64, max_tetrahedra: usize) -> Result<Self, DelaunayError> {
        let too_many = DelaunayError::TooMany { len: points.len() };
        if !(Self::MIN_REACH..=Self::MAX_REACH).contains(&reach) {
            return Err(DelaunayError::Reach { reach });
        }
        if let Some(index) = points.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
            return Err(DelaunayError::NonFinite { index });
        }
        if points.len() > Self::MAX_POINTS {
            return Err(too_many);
        }
        let scale::Sites { sites, unit, site_of } = scale::sites(points, reach);
        let mut insertion = Insertion::new(&sites, max_tetrahedra);
        if !insertion.insert_all(order::rounds(BOUNDING..sites.len())) {
            return Err(too_many);
        }
        let work = insertion.work;
        let (tetrahedra, neighbours) = compact::compact(insertion.into_tetrahedra(), sites.len());
        Ok(Self { sites, unit, site_of, tetrahedra, neighbours, work })
    }

    /// The six bounding sites, then the distinct points along a Hilbert curve, all divided by [`unit`](Self::unit). Of
    /// bounding sites 2k and 2k + 1 the first is below on axis k, the second above.
    #[must_use]
    pub fn sites(&self) -> &[[f64; 3]] {
        &self.sites
    }

    /// A power of two, possibly subnormal: a site times it is the point, exactly, but for coordinates below 2^-161 of
    /// it, which the site has as 0. Coordinates of points are below 2 units.
    #[must_use]
    pub fn unit(&self) -> f64 {
        self.unit
    }

    /// The number of the site of a point.
    ///
    /// # Panics
    /// If there is no such point.
    #[must_use]
    pub fn site_of(&self, point: usize) -> usize {
        self.site_of[point] as usize
    }

    /// The sites of each tetrahedron, positively oriented: [`orientation_3d`](p2m_core::predicates::orientation_3d) of the
    /// four is `Greater`. Sorted by the last one of their sites on the Hilbert curve.
    #[must_use]
    pub fn tetrahedra(&self) -> &[[u32; 4]] {
        &self.tetrahedra
    }

    /// Of each tetrahedron, the ones opposite_triangles the faces opposite to its vertices, or [`NONE`](Self::NONE).
    #[must_use]
    pub fn neighbours(&self) -> &[[u32; 4]] {
        &self.neighbours
    }

    /// What was done to build it.
    #[must_use]
    pub fn work(&self) -> Work {
        self.work
    }

    /// Heap bytes.
    #[must_use]
    pub fn memory(&self) -> usize {
        size_of::<[f64; 3]>() * self.sites.capacity()
            + size_of::<u32>() * self.site_of.capacity()
            + size_of::<[u32; 4]>() * (self.tetrahedra.capacity() + self.neighbours.capacity())
    }
}
