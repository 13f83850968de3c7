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
//! let centre = signed.closest_point(&[0.0; 3]).unwrap();
//! assert_eq!(centre.sign, Sign::Inside);
//! assert!(centre.distance().unwrap() < -0.9);
//! # Ok::<(), p2m_field::sign::SignError>(())
//! ```

mod boundary;
mod pseudonormal;
mod topology;
mod types;
mod winding;

pub use types::{SharedSoup, Sign, SignError, Signed};
pub use winding::WindingNumbers;

use nalgebra::Point3;
use p2m_bvh::TreeIndex;
use p2m_core::batch::{self, BatchOptions};
use p2m_core::{Aabb, Closest, ClosestPoint, Position, PrimitiveId, QueryOptions, Real, Soup};
use pseudonormal::Pseudonormals;
use std::sync::Arc;
use topology::{RayTree, Topology};
use types::check_kinds;

/// An index over triangles whose answers have signs.
///
/// `I` is the index, and `S` a pointer to its scene: `&Soup<f64>` to borrow it, or `Arc<Soup<f64>>` to share it, so
/// that one value has everything and can be moved, cloned and sent to other threads:
///
/// ```
/// use nalgebra::Point3;
/// use p2m_core::Soup;
/// use p2m_field::sign::{Sign, SharedDistance, SignedDistance};
/// use p2m_mixed::generate::{IcoSphere, ico_sphere};
/// use std::sync::Arc;
///
/// struct World {
///     walls: SharedDistance,
/// }
///
/// let ball: Arc<Soup<f64>> = Arc::new(ico_sphere(&IcoSphere::default()).unwrap());
/// let world = World { walls: SignedDistance::build(ball)? };
/// let inside = std::thread::spawn(move || world.walls.closest_point(&[0.0; 3]).unwrap().sign);
/// assert_eq!(inside.join().unwrap(), Sign::Inside);
/// # Ok::<(), p2m_field::sign::SignError>(())
/// ```
///
/// An index in f32 has signs as well: give it the scene converted to f64, which is exact, and queries in f32.
#[derive(Clone)]
pub struct SignedDistance<I, S> {
    index: I,
    rule: SignRule<S>,
}

/// Signed distances by an AABB tree over a scene that is shared.
pub type SharedDistance = SignedDistance<TreeIndex<f64, Arc<Soup<f64>>, Aabb<f64>>, Arc<Soup<f64>>>;

impl<I, S> std::fmt::Debug for SignedDistance<I, S> {
    /// Writes the name of the rule. The index and its tables are left out, because they are as large as the scene.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let rule = match &self.rule {
            SignRule::Closed(_) => "closed surface",
            SignRule::Winding(_) => "winding numbers",
        };
        f.debug_struct("SignedDistance").field("rule", &rule).finish_non_exhaustive()
    }
}

/// The rule that decides the sign.
#[derive(Clone)]
enum SignRule<S> {
    Closed(Box<Pseudonormals<S>>),
    Winding(Box<WindingNumbers<S>>),
}

impl<S: SharedSoup> SignRule<S> {
    fn sign<T: Real>(&self, query: &Point3<T>, closest: &Closest<T>) -> Sign {
        if closest.distance == T::zero() {
            return Sign::Boundary;
        }
        let query = query.map(Real::to_f64);
        match self {
            Self::Closed(normals) => normals.sign(&query, &closest.into()),
            Self::Winding(winding) => winding.sign(&query),
        }
    }
}

impl SharedDistance {
    /// Builds an AABB tree over a closed surface, with signs as [`SignedDistance::new`] makes them. A scene of its own
    /// is shared by `Arc::new(soup)`.
    ///
    /// # Errors
    /// It returns the errors of [`SignedDistance::new`].
    pub fn build(soup: Arc<Soup<f64>>) -> Result<Self, SignError> {
        Self::new(TreeIndex::new(Arc::clone(&soup))?, soup)
    }
}

impl<I, S: SharedSoup> SignedDistance<I, S> {
    /// Makes signs for a closed surface. `index` has to be an index over `soup`.
    ///
    /// The orientation of the surface is irrelevant, and parts of it may be inside of others. Vertices are welded where
    /// they have the same coordinates. An empty scene is not an error.
    ///
    /// # Accuracy
    /// Signs are those of an exact count of crossings under two conditions. The surface does not intersect itself,
    /// which [`find_self_intersection`] checks; otherwise the sign is that of the nearest part, which differs where
    /// that part is inside of others. And no two sheets of the surface are closer to each other than the error of a
    /// distance, which is 16 u M, with the u of the index, if the farthest vertex of the closest triangle has the
    /// distance M. This is cited \[Baerentzen2005\] for distances without rounding, and observed on all models that are
    /// closed and do not intersect themselves (`cargo test -p p2m-field --test all signs::`).
    ///
    /// # Errors
    /// [`SignError::OtherKinds`], [`SignError::Open`], [`SignError::NotOriented`], [`SignError::OtherScene`] and
    /// [`SignError::Build`].
    ///
    /// # Complexity
    /// O(n log n) time. Memory is 13 bytes for each triangle, 28 bytes for each vertex, and a tree of boxes
    /// for ambiguous queries.
    pub fn new<T: Real>(index: I, soup: S) -> Result<Self, SignError>
    where
        I: ClosestPoint<T>,
    {
        check_scene(&index, &soup)?;
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
    /// [`SignError::OtherKinds`], [`SignError::OtherScene`], [`SignError::Accuracy`] and [`SignError::Build`].
    ///
    /// # Complexity
    /// The complexity is that of [`WindingNumbers::new`].
    pub fn with_winding_numbers<T: Real>(index: I, soup: S, accuracy: f64) -> Result<Self, SignError>
    where
        I: ClosestPoint<T>,
    {
        check_scene(&index, &soup)?;
        Ok(Self { index, rule: SignRule::Winding(Box::new(WindingNumbers::new(soup, accuracy)?)) })
    }

    /// Returns the index.
    pub fn index(&self) -> &I {
        &self.index
    }

    /// Returns the closest point and the sign of a query.
    pub fn closest_point<T: Real>(&self, query: &impl Position<T>) -> Option<Signed<T>>
    where
        I: ClosestPoint<T>,
    {
        self.closest_point_with(query, &QueryOptions::default())
    }

    /// Returns the closest point within the limits of `options`, and the sign of a query. With an epsilon the sign
    /// follows from the approximate closest point.
    pub fn closest_point_with<T: Real>(&self, query: &impl Position<T>, options: &QueryOptions<T>) -> Option<Signed<T>>
    where
        I: ClosestPoint<T>,
    {
        let query = query.point();
        let closest = self.index.closest_point_with(&query, options)?;
        Some(self.with_sign(&query, closest))
    }

    /// Returns the closest points and the signs of queries, in their order, computed as a [`batch`].
    pub fn closest_points<T: Real>(
        &self,
        queries: &[Point3<T>],
        options: &QueryOptions<T>,
        batch: &BatchOptions,
    ) -> Vec<Option<Signed<T>>>
    where
        I: ClosestPoint<T> + Sync,
        S: Send,
    {
        let mut closest = vec![None; queries.len()];
        batch::closest_points_into(&self.index, queries, options, batch, &mut closest);
        let pairs: Vec<(Point3<T>, Option<Closest<T>>)> = queries.iter().copied().zip(closest).collect();
        let position = |pair: &(Point3<T>, _)| pair.0.map(Real::to_f64);
        batch::map(&pairs, batch, position, |(query, closest)| closest.map(|closest| self.with_sign(query, closest)))
    }

    /// Returns the answer to a query whose closest point is known, with its sign.
    pub fn with_sign<T: Real>(&self, query: &Point3<T>, closest: Closest<T>) -> Signed<T> {
        Signed { closest, sign: self.sign(query, &closest) }
    }

    /// Returns the sign of a query by its closest point.
    pub(crate) fn sign<T: Real>(&self, query: &Point3<T>, closest: &Closest<T>) -> Sign {
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
    pub(crate) fn sign_within(&self, radius: f64, centre: &Point3<f64>) -> Option<Sign>
    where
        I: ClosestPoint<f64>,
    {
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

/// Checks at vertices of some triangles whether an index can be over a scene of triangles.
///
/// A vertex is at the distance 0 from its scene, so no lower bound on its distance is above 0.
fn check_scene<T: Real>(index: &impl ClosestPoint<T>, soup: &Soup<f64>) -> Result<(), SignError> {
    const TRIANGLES: usize = 64;
    check_kinds(soup)?;
    let triangles = soup.triangles();
    for triangle in (0..triangles.len()).step_by(triangles.len().div_ceil(TRIANGLES).max(1)) {
        for (vertex, position) in triangles[triangle].into_iter().enumerate() {
            let query = soup.positions()[position as usize].map(T::round_from_f64);
            let is_on_scene = index
                .closest_point(&query)
                .is_some_and(|c| c.lower_bound <= T::zero() && c.primitive.index() < triangles.len());
            if !is_on_scene && query.iter().all(|x| x.is_finite()) {
                return Err(SignError::OtherScene { triangle, vertex });
            }
        }
    }
    Ok(())
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
    let rays = RayTree::new(soup)?;
    Ok(topology.find_self_intersection(soup, &rays).map(|pair| pair.map(PrimitiveId::new)))
}
