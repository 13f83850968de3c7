//! Signed distances: on which side of a surface a place is.
//!
//! [`SignedDistance`] puts a sign to the answers of any index over triangles, by one of two rules:
//!
//! - **Closed surfaces** ([`SignedDistance::new`]): inside is where a ray crosses the surface an odd number of times. The
//!   angle-weighted pseudonormal at the closest point tells the same \[Baerentzen2005\], without a ray; where it is in doubt
//!   rays decide, without rounding.
//! - **Any triangles** ([`SignedDistance::with_winding_numbers`]): inside is where the generalised winding number
//!   \[Jacobson2013\] is more than a half. Soups, holes and parts that meet each other are no obstacles. Far parts of the scene are
//!   summed up by dipoles \[Barill2018\], within an error that is bounded ([`WindingNumbers`]).
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
mod winding;

pub use winding::WindingNumbers;

use nalgebra::Point3;
use p2m_core::{BuildIndex, Closest, ClosestPoint, PrimitiveId, QueryOptions, Soup};
use pseudonormal::{Pseudonormals, Rays};
use topology::Topology;

/// Which side of the surface a place is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Sign {
    /// Beside what the surface encloses.
    Outside,
    /// In what it encloses.
    Inside,
    /// On the surface: the distance is 0, or that and the error of a distance tell no difference and the query is on a triangle,
    /// without rounding (of closed surfaces).
    Boundary,
    /// Not defined here: the winding number is a half, as near as f64 can tell.
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

/// Why a scene has no signs.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SignError {
    /// Only triangles have sides.
    #[error("{others} of the primitives are no triangles, and have no side")]
    OtherKinds {
        /// How many segments and points there are.
        others: usize,
    },
    /// The surface has a hole or an edge to which it does not come back.
    #[error("the surface is open at edge {edge} of triangle {triangle}; winding numbers have signs for it")]
    Open {
        /// The number of a triangle, the lowest one of which that is said.
        triangle: usize,
        /// The edge, from its vertex of that number to the next.
        edge: usize,
    },
    /// Neighbours run through their common edge in the same direction: one has its front where the other has its back.
    #[error(
        "edge {edge} of triangle {triangle} has neighbours of the opposite orientation; winding numbers have signs, but those count by orientation"
    )]
    NotOriented {
        /// The number of a triangle, the lowest one of which that is said.
        triangle: usize,
        /// The edge, from its vertex of that number to the next.
        edge: usize,
    },
    /// The scene is refused by indexes.
    #[error(transparent)]
    Build(#[from] p2m_core::BuildError),
    /// An accuracy that is none.
    #[error("{0} is no accuracy of winding numbers: it is above 0 and below 0.5")]
    Accuracy(f64),
}

/// A closest point, and which side of the surface the query is on.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Signed {
    /// The closest point, whose distance has no sign.
    pub closest: Closest<f64>,
    /// The side.
    pub sign: Sign,
}

impl Signed {
    /// The distance, negative inside; `None` where the sign is not defined.
    #[must_use]
    pub fn distance(&self) -> Option<f64> {
        match self.sign {
            Sign::Outside => Some(self.closest.distance),
            Sign::Inside => Some(-self.closest.distance),
            Sign::Boundary => Some(0.0),
            Sign::Undefined => None,
        }
    }
}

/// Signs for the answers of an index over triangles.
pub struct SignedDistance<'a, I> {
    index: I,
    sides: Sides<'a>,
}

/// What tells the sign.
enum Sides<'a> {
    Closed(Box<Pseudonormals<'a>>),
    Winding(Box<WindingNumbers<'a>>),
}

impl Sides<'_> {
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
    /// Signs of a closed surface. `index` is one over `soup`.
    ///
    /// Signs are those of a count of crossings without rounding, provided that the surface does not meet itself
    /// ([`meets_itself`] tells; one that does has the sign of its nearest part, which is another one where that is inside of
    /// others), and that no two sheets of it are closer to each other than the error of a distance, 16 u M with the farthest
    /// vertex of the closest triangle at the distance M. Cited
    /// \[Baerentzen2005\], for distances without rounding; observed on all models that are closed and do not meet themselves
    /// (`cargo test --test all signs::`). Which way the surface is oriented does not matter, nor whether parts of it are inside of
    /// others.
    ///
    /// # Errors
    /// [`SignError::OtherKinds`], [`SignError::Open`] and [`SignError::NotOriented`]. Vertices are joined where they have the
    /// same coordinates. An empty scene is no error.
    ///
    /// # Complexity
    /// O(n log n) time; 13 bytes a triangle, 28 bytes a vertex, and a tree of boxes for queries in doubt.
    pub fn new(index: I, soup: &'a Soup<f64>) -> Result<Self, SignError> {
        let normals = Pseudonormals::new(soup, &index)?;
        Ok(Self { index, sides: Sides::Closed(Box::new(normals)) })
    }

    /// Signs by winding numbers, which are computed to `accuracy`: 0.01 is usual. Where that does not tell which side of a
    /// half the number is, all triangles are summed up.
    ///
    /// Triangles that face the other way count the other way; a surface may be inside out as a whole.
    ///
    /// # Errors
    /// [`SignError::OtherKinds`] and [`SignError::Accuracy`].
    ///
    /// # Complexity
    /// That of [`WindingNumbers::new`].
    pub fn with_winding_numbers(index: I, soup: &'a Soup<f64>, accuracy: f64) -> Result<Self, SignError> {
        Ok(Self { index, sides: Sides::Winding(Box::new(WindingNumbers::new(soup, accuracy)?)) })
    }

    /// The index.
    pub fn index(&self) -> &I {
        &self.index
    }

    /// The closest point and its sign.
    pub fn closest_point(&self, query: &Point3<f64>) -> Option<Signed> {
        self.closest_point_with(query, &QueryOptions::default())
    }

    /// The same within what `options` ask. With an epsilon the sign is that of the closest point that is answered.
    pub fn closest_point_with(&self, query: &Point3<f64>, options: &QueryOptions<f64>) -> Option<Signed> {
        let closest = self.index.closest_point_with(query, options)?;
        Some(Signed { closest, sign: self.sides.sign(query, &closest) })
    }

    /// The sign of a query by its closest point.
    pub(crate) fn sign(&self, query: &Point3<f64>, closest: &Closest<f64>) -> Sign {
        self.sides.sign(query, closest)
    }

    /// The sign of a place that is far from the surface, if that is not the one of its surroundings.
    pub(crate) fn sign_far_away(&self, place: &Point3<f64>) -> Option<Sign> {
        match &self.sides {
            Sides::Closed(_) => None,
            Sides::Winding(winding) => Some(winding.sign(place)),
        }
    }

    /// Whether places that no surface is between have the same sign: by winding numbers of an open one they need not.
    pub(crate) fn changes_at_surface(&self) -> bool {
        match &self.sides {
            Sides::Closed(_) => true,
            Sides::Winding(winding) => winding.is_closed(),
        }
    }

    /// The sign of all places within `radius` of one that is not on the surface, between which and it no surface is; `None` where they may
    /// differ.
    pub(crate) fn sign_within(&self, radius: f64, place: &Point3<f64>) -> Option<Sign> {
        match &self.sides {
            Sides::Closed(_) => Some(self.closest_point(place)?.sign),
            Sides::Winding(winding) => winding.sign_within(radius, place),
        }
    }

    /// How often the sign was in doubt so far, and rays decided or all triangles were summed up.
    pub fn doubts(&self) -> u64 {
        match &self.sides {
            Sides::Closed(normals) => normals.doubts(),
            Sides::Winding(winding) => winding.doubts(),
        }
    }
}

/// Two triangles of a closed surface that meet elsewhere than at common vertices, if there are any: the lowest one that has an
/// edge which meets another one, and the lowest one that this edge meets.
///
/// Edges are asked for as rays, whose directions are rounded: what touches within that may be told or not. Triangles that have a
/// common vertex are taken to meet there alone, so sheets that lie on each other with common vertices are not told.
///
/// # Errors
/// As [`SignedDistance::new`].
///
/// # Complexity
/// A search along each edge: a few microseconds, but milliseconds where thousands of long slivers lie in one plane along two axes.
pub fn meets_itself(soup: &Soup<f64>) -> Result<Option<[PrimitiveId; 2]>, SignError> {
    let topology = Topology::new(soup)?;
    let rays = Rays::build(soup, &Default::default())?;
    Ok(topology.meets_itself(soup, &rays).map(|pair| pair.map(PrimitiveId::new)))
}

/// Only triangles.
fn check_kinds(soup: &Soup<f64>) -> Result<(), SignError> {
    match soup.segments().len() + soup.points().len() {
        0 => Ok(()),
        others => Err(SignError::OtherKinds { others }),
    }
}
