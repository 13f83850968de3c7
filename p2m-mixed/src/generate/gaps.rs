//! Meshes divided into primitives without shared vertices, which have gaps between them or penetrate each other.
//!
//! These are the two hard cases of \[Zong2023, section 5.5, Figure 19\].

use super::error::{GenerateError, in_range};
use nalgebra::{Point3, Vector3};
use p2m_core::{Element, Soup};

/// Shrinks each primitive about its centroid to `factor` times its size, and gives it vertices of its own.
///
/// Points do not move. Triangles and segments that shared at most their boundaries are disjoint afterwards.
///
/// ```
/// use p2m_mixed::generate::{IcoSphere, gapped, ico_sphere};
///
/// let ball = ico_sphere(&IcoSphere::default()).unwrap();
/// let shards = gapped(&ball, 0.8).unwrap();
/// assert_eq!(shards.triangles().len(), ball.triangles().len());
/// assert_eq!(shards.positions().len(), 3 * ball.triangles().len());
/// ```
///
/// # Errors
/// [`GenerateError::OutOfRange`] if the factor is not above 0 and below 1, [`GenerateError::Build`] if
/// a coordinate overflows.
pub fn gapped(scene: &Soup<f64>, factor: f64) -> Result<Soup<f64>, GenerateError> {
    in_range(factor > 0.0 && factor < 1.0, "factor", factor, "above 0 and below 1")?;
    about_centroids(scene, factor)
}

/// Enlarges each primitive about its centroid to `factor` times its size, and gives it vertices of its own. On a curved
/// mesh, each triangle crosses its neighbours.
///
/// A point of the surface is then covered by `factor`^2 triangles on average. Points of the scene do not move. On a
/// planar part, triangles overlap in the plane.
///
/// ```
/// use p2m_mixed::generate::{IcoSphere, ico_sphere, penetrating};
///
/// let ball = ico_sphere(&IcoSphere::default()).unwrap();
/// let burr = penetrating(&ball, 2.0).unwrap();
/// assert!(burr.positions().iter().all(|p| p.coords.norm() > 1.0));
/// ```
///
/// # Errors
/// [`GenerateError::OutOfRange`] if the factor is not above 1 and at most 1000, [`GenerateError::Build`] if
/// a coordinate overflows.
pub fn penetrating(scene: &Soup<f64>, factor: f64) -> Result<Soup<f64>, GenerateError> {
    in_range(factor > 1.0 && factor <= 1e3, "factor", factor, "above 1 and at most 1000")?;
    about_centroids(scene, factor)
}

fn about_centroids(scene: &Soup<f64>, factor: f64) -> Result<Soup<f64>, GenerateError> {
    let corners = 3 * scene.triangles().len() + 2 * scene.segments().len() + scene.points().len();
    let mut positions: Vec<Point3<f64>> = Vec::with_capacity(corners);
    let mut elements = Vec::new();
    // There are at most three vertices for each id, so their number is below 2^32.
    let mut first = 0;
    for element in scene.elements() {
        let corners = element.indices().iter().map(|&i| scene.positions()[i as usize].coords);
        let count = f64::from(u8::try_from(element.indices().len()).unwrap_or(u8::MAX));
        let centroid = corners.clone().sum::<Vector3<f64>>() / count;
        elements.push(match element {
            Element::Point(_) => Element::Point(first),
            Element::Segment(_) => Element::Segment([first, first + 1]),
            Element::Triangle(_) => Element::Triangle([first, first + 1, first + 2]),
        });
        for corner in corners {
            let moved = if let Element::Point(_) = element { corner } else { centroid + (corner - centroid) * factor };
            positions.push(Point3::from(moved));
            first += 1;
        }
    }
    Ok(Soup::new(positions, elements)?)
}
