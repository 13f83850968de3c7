//! Signed distances: the side of a surface that a point is on.
//!
//! [`SignedDistance`] adds a sign to the answers of any index over triangles, by one of two rules:
//!
//! - **Closed surfaces** ([`SignedDistance::new`]): a point is inside if a ray from it crosses the surface an odd
//!   number of times. The angle-weighted pseudonormal at the closest point gives the same sign without a ray
//!   \[Baerentzen2005\]. Where rounding makes its sign ambiguous, exact ray crossings decide.
//! - **Any triangles** ([`SignedDistance::with_winding_numbers`]): a point is inside if its generalised winding number
//!   \[Jacobson2013\] exceeds a half in magnitude. The triangles may have holes, be unconnected, or intersect each
//!   other. Dipoles stand for far parts of the scene \[Barill2018\], within an error that is bounded
//!   ([`WindingNumbers`]).
//!
//! ```
//! use nalgebra::Point3;
//! use p2m_core::{BruteForce, ClosestPoint};
//! use p2m_mixed::generate::{IcoSphere, ico_sphere};
//! use p2m_field::sign::{Sign, SignedDistance};
//!
//! let ball = ico_sphere(&IcoSphere::default()).unwrap();
//! let signed = SignedDistance::new(BruteForce::new(&ball).unwrap(), &ball)?;
//! let centre = signed.closest_point(&Point3::origin()).unwrap();
//! assert_eq!(centre.sign, Sign::Inside);
//! assert!(centre.distance().unwrap() < -0.9);
//! # Ok::<(), p2m_field::sign::SignError>(())
//! ```

mod boundary;
mod pseudonormal;
mod topology;
mod types;
mod winding;

pub use types::{Sign, SignError, Signed};
pub use winding::WindingNumbers;

use nalgebra::Point3;
use p2m_core::{BuildIndex, Closest, ClosestPoint, PrimitiveId, QueryOptions, Soup};
use pseudonormal::Pseudonormals;
use topology::{RayTree, Topology};

/// An index over triangles whose answers have signs.
pub struct SignedDistance<'a, I> {
    index: I,
    rule: SignRule<'a>,
}

/// The rule that decides the sign.
enum SignRule<'a> {
    Closed(Box<Pseudonormals<'a>>),
    Winding(Box<WindingNumbers<'a>>),
}

impl SignRule<'_> {
    fn sign(&self, query: &Point3<f64>, closest: &Closest<f64>) -> Sign {
        if closest.distance == 0.0 {
            return Sign::Boundary;
        }
        match self {
            Self::Closed(normals) => normals.sign(query, closest),
            Self::Winding(winding) => winding.sign(query),
        }
    }
}

impl<'a, I: ClosestPoint<f64>> SignedDistance<'a, I> {
    /// Makes signs for a closed surface. `index` has to be an index over `soup`.
    ///
    /// The orientation of the surface is irrelevant, and parts of it may be inside of others. Vertices are welded where
    /// they have the same coordinates. An empty scene is not an error.
    ///
    /// # Accuracy
    /// Signs are those of an exact count of crossings under two conditions. The surface does not intersect itself,
    /// which [`find_self_intersection`] checks; otherwise the sign is that of the nearest part, which differs where
    /// that part is inside of others. And no two sheets of the surface are closer to each other than the error of a
    /// distance, which is 16 u M if the farthest vertex of the closest triangle has the distance M. This is cited
    /// \[Baerentzen2005\] for distances without rounding, and observed on all models that are closed and do not
    /// intersect themselves (`cargo test --test all signs::`).
    ///
    /// # Errors
    /// [`SignError::OtherKinds`], [`SignError::Open`], [`SignError::NotOriented`] and [`SignError::Build`].
    ///
    /// # Complexity
    /// O(n log n) time. Memory is 13 bytes for each triangle, 28 bytes for each vertex, and a tree of boxes
    /// for ambiguous queries.
    pub fn new(index: I, soup: &'a Soup<f64>) -> Result<Self, SignError> {
        let normals = Pseudonormals::new(soup, &index)?;
        Ok(Self { index, rule: SignRule::Closed(Box::new(normals)) })
    }

    /// Makes signs by winding numbers. `index` has to be an index over `soup`.
    ///
    /// Winding numbers are computed to `accuracy`, for which 0.01 is a good choice. All triangles are summed up if that
    /// accuracy does not decide on which side of a half the number is. Triangles of opposite orientations count with
    /// opposite signs, and a surface may be inside out as a whole.
    ///
    /// # Errors
    /// [`SignError::OtherKinds`], [`SignError::Accuracy`] and [`SignError::Build`].
    ///
    /// # Complexity
    /// The complexity is that of [`WindingNumbers::new`].
    pub fn with_winding_numbers(index: I, soup: &'a Soup<f64>, accuracy: f64) -> Result<Self, SignError> {
        Ok(Self { index, rule: SignRule::Winding(Box::new(WindingNumbers::new(soup, accuracy)?)) })
    }

    /// Returns the index.
    pub fn index(&self) -> &I {
        &self.index
    }

    /// Returns the closest point and the sign of a query.
    pub fn closest_point(&self, query: &Point3<f64>) -> Option<Signed> {
        self.closest_point_with(query, &QueryOptions::default())
    }

    /// Returns the closest point within the limits of `options`, and the sign of a query. With an epsilon the sign
    /// follows from the approximate closest point.
    pub fn closest_point_with(&self, query: &Point3<f64>, options: &QueryOptions<f64>) -> Option<Signed> {
        let closest = self.index.closest_point_with(query, options)?;
        Some(Signed { closest, sign: self.rule.sign(query, &closest) })
    }

    /// Returns the answer to a query whose closest point is known, with its sign.
    pub fn with_sign(&self, query: &Point3<f64>, closest: Closest<f64>) -> Signed {
        Signed { closest, sign: self.sign(query, &closest) }
    }

    /// Returns the sign of a query by its closest point.
    pub(crate) fn sign(&self, query: &Point3<f64>, closest: &Closest<f64>) -> Sign {
        self.rule.sign(query, closest)
    }

    /// Returns the sign of a point that is not on the surface, or `None` if the rule needs the closest point.
    pub(crate) fn sign_without_closest_point(&self, point: &Point3<f64>) -> Option<Sign> {
        match &self.rule {
            SignRule::Closed(_) => None,
            SignRule::Winding(winding) => Some(winding.sign(point)),
        }
    }

    /// Returns whether points that the surface does not separate have the same sign. That is not the case for winding
    /// numbers of an open surface.
    pub(crate) fn changes_only_at_surface(&self) -> bool {
        match &self.rule {
            SignRule::Closed(_) => true,
            SignRule::Winding(winding) => winding.is_closed(),
        }
    }

    /// Returns the common sign of all points within `radius` of a centre that the surface does not separate from it, or
    /// `None` if their signs may differ. The centre is not on the surface.
    pub(crate) fn sign_within(&self, radius: f64, centre: &Point3<f64>) -> Option<Sign> {
        match &self.rule {
            SignRule::Closed(_) => Some(self.closest_point(centre)?.sign),
            SignRule::Winding(winding) => winding.sign_within(radius, centre),
        }
    }

    /// Returns the number of queries so far whose sign was ambiguous, so that rays or the sum of all
    /// triangles decided it.
    pub fn ambiguous_count(&self) -> u64 {
        match &self.rule {
            SignRule::Closed(normals) => normals.ambiguous_count(),
            SignRule::Winding(winding) => winding.ambiguous_count(),
        }
    }
}

/// Searches a closed surface for two triangles that intersect each other elsewhere than at common vertices.
///
/// The first triangle is the lowest one with an edge that intersects another triangle, and the second is the lowest one
/// that this edge intersects. `None` means that no such pair was found.
///
/// Edges are cast as rays, whose directions are rounded, so triangles that barely touch may be missed or reported.
/// Triangles with a common vertex are assumed to intersect only there, so sheets that coincide and have common
/// vertices are missed.
///
/// # Errors
/// [`SignError::OtherKinds`], [`SignError::Open`], [`SignError::NotOriented`] and [`SignError::Build`].
///
/// # Complexity
/// One ray for each edge. A ray takes a few microseconds, or milliseconds where thousands of long slivers lie in one
/// plane along two axes.
pub fn find_self_intersection(soup: &Soup<f64>) -> Result<Option<[PrimitiveId; 2]>, SignError> {
    let topology = Topology::new(soup)?;
    let rays = RayTree::build(soup, &Default::default())?;
    Ok(topology.find_self_intersection(soup, &rays).map(|pair| pair.map(PrimitiveId::new)))
}
