//! The answer to a closest-point query.

use crate::{Feature, PrimitiveId, Real};
use nalgebra::Point3;

/// The answer to a closest-point query. Lengths are in units of the scene.
///
/// The distance has no sign: for a query inside of a closed mesh it is the distance from the surface. The crate
/// p2m-field has signed distances.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Closest<T: Real> {
    /// The closest point. It lies in the box of the primitive, and if a vertex is nearest, it is that vertex verbatim.
    /// How ill-conditioned it is depends on the scene.
    pub point: Point3<T>,
    /// The distance of the closest point, computed from the offset before `point` is rounded.
    pub distance: T,
    /// A certified lower bound on the true distance of the scene. For exact answers it is `distance` less its error
    /// bound. It is zero if that error exceeds the range of f64, as it does for coordinates near the end of the range.
    pub lower_bound: T,
    /// The primitive that contains the closest point. Ties go to the lowest id.
    pub primitive: PrimitiveId,
    /// The feature of the primitive that contains the closest point.
    pub feature: Feature,
    /// The weights of the primitive's vertices in their order: three for a triangle, two for a segment, one for a
    /// point. They are >= 0 and add up to 1 within 4 u; unused ones are 0. The weighted sum of the vertices is `point`
    /// within 4 u |query| + 8 u M and 8 u of the largest coordinate of a vertex (observed, `p2m_testkit::contract`).
    pub barycentric: [T; 3],
}
