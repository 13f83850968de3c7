//! The library parry3d in both scalars, queried for closest points.
//!
//! Triangles are a `TriMesh`, segments a `Polyline`. In mixed scenes the polyline is queried within the distance of the
//! mesh's answer. parry has no shape for a set of points. Every query is `project_local_point_and_get_location(query,
//! false)`, and the distance is that of the projected point.

use nalgebra::Point3;
use p2m_core::{Real, Soup};

pub(crate) use double::prepare as parry_double;
pub(crate) use single::prepare as parry_single;

/// Generates the adapter for one of the two crates of parry, which have the same names for different types.
macro_rules! parry {
    ($(#[$about:meta])* $module:ident, $parry:ident, $scalar:ty) => {
        $(#[$about])*
        mod $module {
            use super::used_positions;
            use crate::backend::{Unavailable, Answer, BenchIndex, Prepared, BoxedIndex, Scalar};
            use crate::scene::Scene;
            use nalgebra::Point3;
            use $parry::math::Vector;
            use $parry::query::PointQueryWithLocation;
            use $parry::shape::{Polyline, TriMesh};

            /// The shapes of a scene: a mesh, a polyline, or both.
            pub(crate) struct Parry {
                mesh: Option<TriMesh>,
                lines: Option<Polyline>,
            }

            impl BenchIndex for Parry {
                type Scalar = $scalar;

                #[inline(always)]
                fn query(&self, query: &Point3<$scalar>) -> Answer {
                    let q = Vector::new(query.x, query.y, query.z);
                    let of_mesh = self.mesh.as_ref().map(|mesh| {
                        let (projection, (id, _)) = mesh.project_local_point_and_get_location(q, false);
                        ((projection.point - q).length(), id)
                    });
                    let of_lines = self.lines.as_ref().and_then(|lines| {
                        let found = match of_mesh {
                            Some((reach, _)) => {
                                lines.project_local_point_and_get_location_with_max_dist(q, false, reach)
                            }
                            None => Some(lines.project_local_point_and_get_location(q, false)),
                        };
                        found.map(|(projection, (id, _))| ((projection.point - q).length(), id))
                    });
                    // An answer of the polyline is nearer than the mesh, because it was searched within that distance.
                    match of_lines.or(of_mesh) {
                        Some((distance, id)) => Answer { distance: distance.into(), id },
                        None => Answer::NONE,
                    }
                }
            }

            /// Prepares the backend of the list. It copies the positions, as a user of parry has to.
            pub(crate) fn prepare(scene: &Scene) -> Result<Prepared, Unavailable> {
                let (soup, _) = <$scalar as Scalar>::soup(scene)?;
                if !soup.points().is_empty() {
                    return Err(Unavailable("no shape for points".to_owned()));
                }
                let vectors = |points: Vec<Point3<$scalar>>| -> Vec<Vector> {
                    points.iter().map(|p| Vector::new(p.x, p.y, p.z)).collect()
                };
                let (triangle_positions, triangles) = used_positions(soup, soup.triangles());
                let (segment_positions, segments) = used_positions(soup, soup.segments());
                let (triangle_positions, segment_positions) = (vectors(triangle_positions), vectors(segment_positions));
                let build = move || {
                    // parry does not accept an empty mesh.
                    let mesh = (!triangles.is_empty()).then(|| TriMesh::new(triangle_positions, triangles));
                    let mesh = mesh.transpose().map_err(Unavailable::because)?;
                    let lines = (!segments.is_empty()).then(|| Polyline::new(segment_positions, Some(segments)));
                    Ok(Box::new(Parry { mesh, lines }) as BoxedIndex)
                };
                Ok(Prepared { build: Box::new(build), borrowed: 0 })
            }
        }
    };
}

parry!(
    /// The adapter for parry3d, which ratios refer to.
    single, parry3d, f32
);
parry!(
    /// The adapter for parry3d-f64.
    double, parry3d_f64, f64
);

/// Returns the positions that `elements` use, in their order, and the renumbered elements. Each shape of parry owns its
/// positions and should not own those of the other shape.
#[allow(clippy::cast_possible_truncation, reason = "no more positions than were numbered by u32")]
fn used_positions<T: Real, const N: usize>(soup: &Soup<T>, elements: &[[u32; N]]) -> (Vec<Point3<T>>, Vec<[u32; N]>) {
    let mut used = vec![false; soup.positions().len()];
    elements.iter().flatten().for_each(|&i| used[i as usize] = true);
    let mut next = 0;
    let renumbered: Vec<u32> = used
        .iter()
        .map(|&is_used| {
            next += u32::from(is_used);
            next.wrapping_sub(1)
        })
        .collect();
    let positions = soup.positions().iter().zip(used).filter(|(_, is_used)| *is_used).map(|(p, _)| *p).collect();
    (positions, elements.iter().map(|e| e.map(|i| renumbered[i as usize])).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use p2m_core::Element;

    #[test]
    fn positions_of_other_kinds_are_left_out() {
        let positions: Vec<Point3<f64>> = (0..5).map(|i| Point3::new(f64::from(i), 0.0, 0.0)).collect();
        let elements = [Element::Triangle([0, 3, 4]), Element::Segment([1, 3])];
        let soup = Soup::new(positions, elements).unwrap();
        let (positions, triangles) = used_positions(&soup, soup.triangles());
        assert_eq!(positions.iter().map(|p| p.x).collect::<Vec<_>>(), [0.0, 3.0, 4.0]);
        assert_eq!(triangles, [[0, 1, 2]]);
        let (positions, segments) = used_positions(&soup, soup.segments());
        assert_eq!((positions[1].x, segments[0]), (3.0, [0, 1]));
    }
}
