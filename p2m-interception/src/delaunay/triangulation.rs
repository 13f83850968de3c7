//! The finished triangulation, and its construction from all steps.

use crate::delaunay::compact::{self, CompactTetrahedra};
use crate::delaunay::insert::Insertion;
use crate::delaunay::order;
use crate::delaunay::scale::ScaledSites;
use crate::delaunay::tetrahedron::{BOUNDING, NO_NEIGHBOUR, Work};
use p2m_core::engine::parallel::run_beside;

/// The reason why a set of points has no triangulation.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DelaunayError {
    /// A coordinate is NaN or infinite.
    #[error("point {index} has a coordinate that is not finite")]
    NonFinite {
        /// The index of the first such point.
        index: usize,
    },
    /// There are more points or tetrahedra than numbers for them, or more tetrahedra than allowed.
    #[error("{len} points are too many, or have too many tetrahedra")]
    TooMany {
        /// The number of points.
        len: usize,
    },
    /// The distance of the bounding sites is out of range.
    #[error("a reach of {reach} is not from {} to {}", Delaunay::MIN_REACH, Delaunay::MAX_REACH)]
    Reach {
        /// The reach that was requested.
        reach: f64,
    },
}

/// The Delaunay tetrahedra of points inside an octahedron of six bounding sites.
#[derive(Clone, Debug)]
pub struct Delaunay {
    pub(crate) scaled: ScaledSites,
    pub(crate) tetrahedra: Vec<[u32; 4]>,
    pub(crate) neighbours: Vec<[u32; 4]>,
    pub(crate) work: Work,
}

impl Delaunay {
    /// The number that stands for a missing neighbour, where the face is one of the octahedron.
    pub const NONE: u32 = NO_NEIGHBOUR;
    /// The smallest reach. From here on, the octahedron contains the box of the points.
    pub const MIN_REACH: f64 = 3.0;
    /// The largest reach.
    pub const MAX_REACH: f64 = 1_048_576.0;
    /// The largest number of points.
    pub const MAX_POINTS: usize = (1 << 30) - BOUNDING;

    /// Triangulates any finite points. Equal points become one site, where 0.0 equals -0.0. Without points the result
    /// is the four tetrahedra of the octahedron.
    ///
    /// `reach` is the distance of the bounding sites from the centre of the points' box, in halves of its longest
    /// side. A box without extent counts as one with a side of twice [`unit`](Self::unit). The distance is rounded up
    /// by at most 1 %, or by some 2^-46 of the coordinates if the box is small beside them. From
    /// [`MIN_REACH`](Self::MIN_REACH) on, all points are strictly inside the octahedron and their Voronoi cells are
    /// bounded. No bounding site is the nearest site of queries in the box scaled by s about its centre if the reach R
    /// satisfies R (R - 2 s) > 3 + 6 s. So R = 22.78 suffices for s = 10, and R = 4.28 for s = 1.05.
    ///
    /// # Errors
    ///
    /// It fails if a coordinate is not finite, if the reach is out of range, or if there are too many
    /// points or tetrahedra.
    ///
    /// # Complexity
    ///
    /// The time is O(n log n) expected for points spread over a surface or in space. It is O(n^2) in the worst case,
    /// as is the number of tetrahedra. While building it needs 32 bytes per tetrahedron and 60 for each point,
    /// besides the memory that remains ([`memory`](Self::memory)).
    pub fn new(points: &[[f64; 3]], reach: f64) -> Result<Self, DelaunayError> {
        Self::within(points, reach, Self::NONE as usize)
    }

    /// Triangulates as [`new`](Self::new) with at most `max_tetrahedra` tetrahedra at a time and eight times as many
    /// in all, most of which are removed again. Points in space have seven tetrahedra each, and 30 are created for
    /// each point (observed). Points on two skew lines have a quarter of the square of their number.
    ///
    /// # Errors
    ///
    /// It fails as [`new`](Self::new), and with [`DelaunayError::TooMany`] as soon as there are more tetrahedra.
    pub fn within(points: &[[f64; 3]], reach: f64, max_tetrahedra: usize) -> Result<Self, DelaunayError> {
        Ok(Self::build_beside(points, reach, max_tetrahedra, None, false, |_| ())?.0)
    }

    /// Adds points to a triangulation. `points` begins with the points of this triangulation, in their order, and
    /// `reach` is the reach that it was built with. Returns the triangulation of all points and, for each of its
    /// tetrahedra, the number of that tetrahedron in this triangulation, or [`NONE`](Self::NONE) if it is new. At most
    /// `max_tetrahedra` tetrahedra may exist at a time, and eight times as many may be created.
    ///
    /// The tetrahedra satisfy the same definition as after [`new`](Self::new). Where more than four sites are
    /// cospherical, several triangulations do, and the result may be another one. [`work`](Self::work) is the work of
    /// adding.
    ///
    /// # Errors
    ///
    /// It fails as [`within`](Self::within).
    ///
    /// # Panics
    ///
    /// It panics if there are fewer points than this triangulation has.
    ///
    /// # Complexity
    ///
    /// Sites are sorted again, in O(n log n) time for n points. Each point that is added takes the time of a point in
    /// [`new`](Self::new), unless points outside of the box of the others are added: then everything is built again.
    pub fn extend(
        &self,
        points: &[[f64; 3]],
        reach: f64,
        max_tetrahedra: usize,
    ) -> Result<(Self, Vec<u32>), DelaunayError> {
        let (delaunay, mut old_numbers, ()) =
            Self::build_beside(points, reach, max_tetrahedra, Some(self), false, |_| ())?;
        old_numbers.resize(delaunay.tetrahedra.len(), Self::NONE);
        Ok((delaunay, old_numbers))
    }

    /// Triangulates points as [`within`](Self::within), or as [`extend`](Self::extend) if the first ones have a
    /// triangulation already. The second result is the second result of `extend`, but empty if everything was built
    /// anew. The third one is the result of `other`, which receives the sites. If `parallel`, another thread inserts
    /// sites while `other` runs.
    #[allow(clippy::float_cmp, reason = "the same or not")]
    pub(crate) fn build_beside<R>(
        points: &[[f64; 3]],
        reach: f64,
        max_tetrahedra: usize,
        earlier: Option<&Self>,
        parallel: bool,
        other: impl FnOnce(&ScaledSites) -> R,
    ) -> Result<(Self, Vec<u32>, R), DelaunayError> {
        assert!(
            earlier.is_none_or(|old| points.len() >= old.scaled.site_of.len()),
            "a triangulation is extended by points, none is removed"
        );
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
        let scaled = ScaledSites::new(points, reach);
        // Sites in another unit may be rounded differently, and the bounding sites of another box are elsewhere.
        let has_same_frame =
            |old: &ScaledSites| old.unit == scaled.unit && old.positions[..BOUNDING] == scaled.positions[..BOUNDING];
        let earlier = earlier.filter(|old| has_same_frame(&old.scaled));
        let (built, other) =
            run_beside(parallel, || Self::insert_sites(&scaled, max_tetrahedra, earlier), || other(&scaled));
        let ((tetrahedra, neighbours, old_numbers), work) = built.ok_or(too_many)?;
        Ok((Self { scaled, tetrahedra, neighbours, work }, old_numbers, other))
    }

    /// Inserts all sites into the octahedron, or into a triangulation of some of them. It returns `None` if there are
    /// too many tetrahedra.
    fn insert_sites(
        scaled: &ScaledSites,
        max_tetrahedra: usize,
        earlier: Option<&Self>,
    ) -> Option<(CompactTetrahedra, Work)> {
        let sites = &scaled.positions;
        let kept = earlier.map_or_else(Vec::new, |old| old.renumbered_tetrahedra(&scaled.site_of));
        let mut insertion = Insertion::new(sites, max_tetrahedra);
        let mut is_known = vec![false; sites.len()];
        if let Some(old) = earlier {
            insertion.continue_from(kept.iter().zip(&old.neighbours));
            kept.iter().flatten().for_each(|site| is_known[*site as usize] = true);
        }
        if !insertion.insert_all(order::rounds(BOUNDING..sites.len()).filter(|site| !is_known[*site])) {
            return None;
        }
        let work = insertion.work;
        Some((compact::compact(insertion.into_tetrahedra(), sites.len(), &kept), work))
    }

    /// Returns the vertices of all tetrahedra as numbers of other sites, in which the points have these numbers.
    fn renumbered_tetrahedra(&self, site_of: &[u32]) -> Vec<[u32; 4]> {
        let mut new_numbers: Vec<u32> = (0..).take(self.scaled.positions.len()).collect();
        for (old, new) in self.scaled.site_of.iter().zip(site_of) {
            new_numbers[*old as usize] = *new;
        }
        self.tetrahedra.iter().map(|vertices| vertices.map(|v| new_numbers[v as usize])).collect()
    }

    /// Returns the six bounding sites, then the distinct points along a Hilbert curve, all divided by
    /// [`unit`](Self::unit). Of the bounding sites 2k and 2k + 1, the first is below the points on axis k and the
    /// second is above.
    #[must_use]
    pub fn sites(&self) -> &[[f64; 3]] {
        &self.scaled.positions
    }

    /// Returns the unit of the sites, a power of two that may be subnormal. A site times the unit is exactly the
    /// point, except for coordinates below 2^-161 units, which are 0 in the site. Coordinates of points are
    /// below 2 units.
    #[must_use]
    pub fn unit(&self) -> f64 {
        self.scaled.unit
    }

    /// Returns the number of the site of a point.
    ///
    /// # Panics
    /// It panics if there is no such point.
    #[must_use]
    pub fn site_of(&self, point: usize) -> usize {
        self.scaled.site_of[point] as usize
    }

    /// Returns the sites of each tetrahedron, positively oriented:
    /// [`orientation_3d`](p2m_core::predicates::orientation_3d) of the four is `Greater`. Tetrahedra are sorted by the
    /// last one of their sites on the Hilbert curve.
    #[must_use]
    pub fn tetrahedra(&self) -> &[[u32; 4]] {
        &self.tetrahedra
    }

    /// Returns for each tetrahedron the tetrahedra across the faces opposite to its vertices, or [`NONE`](Self::NONE).
    #[must_use]
    pub fn neighbours(&self) -> &[[u32; 4]] {
        &self.neighbours
    }

    /// Returns the work of building the triangulation.
    #[must_use]
    pub fn work(&self) -> Work {
        self.work
    }

    /// Returns the heap memory in bytes.
    #[must_use]
    pub fn memory(&self) -> usize {
        size_of::<[f64; 3]>() * self.scaled.positions.capacity()
            + size_of::<u32>() * self.scaled.site_of.capacity()
            + size_of::<[u32; 4]>() * (self.tetrahedra.capacity() + self.neighbours.capacity())
    }
}
