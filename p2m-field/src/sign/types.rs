//! The sign of a query, and the reasons why a scene has none.

use nalgebra::{Point3, Vector3};
use p2m_bvh::TreeIndex;
use p2m_core::{Aabb, Closest, PrimitiveSet, Ray, Real, Soup};
use std::ops::Deref;

/// The rule that decides which points are inside of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SignRule {
    /// A point is inside where the winding number exceeds a half in magnitude. For an oriented surface that is where
    /// the crossings of a ray, counted with the directions in which they pass the surface, do not cancel. So
    /// overlapping shells of the same orientation are united, a shell that is turned inward inside of another is a
    /// cavity, and a surface that is turned inside out as a whole is solid.
    Winding,
    /// A point is inside where a ray crosses the surface an odd number of times. The orientation of triangles is
    /// irrelevant, and points inside both of two overlapping shells are outside.
    Parity,
}

impl SignRule {
    /// The name of the rule in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Winding => "winding",
            Self::Parity => "parity",
        }
    }
}

impl std::fmt::Display for SignRule {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

/// The side of the surface that a point is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Sign {
    /// The surface does not enclose the point.
    Outside,
    /// The surface encloses the point.
    Inside,
    /// The point is on the surface: its distance is 0, or the error of its distance cannot exclude 0 and it is exactly
    /// on a triangle.
    Boundary,
    /// The sign is not defined: rounding leaves it open on which side of a half the winding number of an
    /// open surface is.
    Undefined,
}

impl std::fmt::Display for Sign {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Outside => "outside",
            Self::Inside => "inside",
            Self::Boundary => "boundary",
            Self::Undefined => "undefined",
        })
    }
}

/// Reasons why a scene has no signs.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SignError {
    /// The scene has segments or points, which have no sides.
    #[error("{others} of the primitives are no triangles, and have no side")]
    OtherKinds {
        /// The number of segments and points.
        others: usize,
    },
    /// The surface has an edge with an odd number of triangles, so parity is not defined.
    #[error(
        "the surface is open at edge {edge} of triangle {triangle}: the rule parity needs a closed surface, \
         the rule winding does not"
    )]
    Open {
        /// The lowest index of a triangle with such an edge.
        triangle: usize,
        /// The edge of that triangle, which runs from the vertex of this index to the next.
        edge: usize,
    },
    /// The index was built over another scene than the given one.
    #[error("the index is over another scene: vertex {vertex} of triangle {triangle} is not on its scene")]
    OtherScene {
        /// The triangle of the given scene that shows it.
        triangle: usize,
        /// The vertex of that triangle, from 0 to 2.
        vertex: usize,
    },
    /// An index of the scene cannot be built.
    #[error(transparent)]
    Build(#[from] p2m_core::BuildError),
}

/// A closest point, and the side of the surface that the query is on.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Signed<T: Real = f64> {
    /// The closest point; its distance has no sign.
    pub closest: Closest<T>,
    /// The sign of the query.
    pub sign: Sign,
}

impl<T: Real> Signed<T> {
    /// Returns the distance, negative inside, or `None` where the sign is not defined.
    #[must_use]
    pub fn distance(&self) -> Option<T> {
        match self.sign {
            Sign::Outside => Some(self.closest.distance),
            Sign::Inside => Some(-self.closest.distance),
            Sign::Boundary => Some(T::zero()),
            Sign::Undefined => None,
        }
    }

    /// Returns the distance from the scene as a solid: 0 inside, or `None` where the sign is not defined.
    #[must_use]
    pub fn distance_to_solid(&self) -> Option<T> {
        self.distance().map(|distance| if distance > T::zero() { distance } else { T::zero() })
    }
}

/// A pointer to a scene: `&Soup<f64>` to borrow it, or `Arc<Soup<f64>>` to share it.
pub trait SharedSoup: Deref<Target = Soup<f64>> + PrimitiveSet<f64> + Clone + Send + Sync {}

impl<S: Deref<Target = Soup<f64>> + PrimitiveSet<f64> + Clone + Send + Sync> SharedSoup for S {}

/// Returns an error if a primitive is not a triangle.
pub(super) fn check_kinds(soup: &Soup<f64>) -> Result<(), SignError> {
    match soup.segments().len() + soup.points().len() {
        0 => Ok(()),
        others => Err(SignError::OtherKinds { others }),
    }
}

/// The tree in which rays are cast.
pub(super) type RayTree<S> = TreeIndex<f64, S, Aabb<f64>>;

/// The direction of rays, which is parallel to no edge or face that scenes usually have.
const RAY_DIRECTION: [f64; 3] = [0.539_217, 0.283_165, 0.793_121];

/// Returns the ray from a finite query whose crossings are counted.
pub(super) fn ray(query: &Point3<f64>) -> Ray {
    Ray::new(query, &Vector3::from(RAY_DIRECTION)).expect("the query is finite")
}
