//! The library parry3d in both scalars: closest points and rays of scenes, and distances of primitives and meshes.
//!
//! Triangles are a `TriMesh`, segments a `Polyline`. In a mixed scene the polyline is queried within the distance of
//! the mesh's answer. parry has no shape for a set of points. A query of a scene is
//! `project_local_point_and_get_location(query, false)`, and the distance is computed from the projected point.

use nalgebra::Point3;
use p2m_core::Soup;

/// Generates the adapter for one of the two crates of parry. Both have the same names for different types.
macro_rules! parry {
    ($(#[$about:meta])* $module:ident, $parry:ident, $scalar:ty) => {
        $(#[$about])*
        pub(crate) mod $module {
            use super::used_positions;
            use crate::backend::{Answer, BenchIndex, BoxedIndex, Prepared, Scalar, Unavailable};
            use crate::scene::Scene;
            use nalgebra::{Isometry3, Point3};
            use std::hint::black_box;
            use $parry::math::{Pose, Vector};
            use $parry::query::{self, PointQueryWithLocation, RayCast};
            use $parry::shape::{Capsule, Polyline, Segment, Shape, TriMesh, Triangle};

            pub(crate) use $parry::query::Ray;

            #[allow(clippy::cast_possible_truncation, reason = "the library of f32 gets rounded coordinates")]
            fn vector([x, y, z]: [f64; 3]) -> Vector {
                Vector::new(x as $scalar, y as $scalar, z as $scalar)
            }

            /// Converts a ray to parry's type.
            pub(crate) fn ray(ray: &p2m_core::Ray) -> Ray {
                Ray::new(vector(ray.origin().into()), vector(ray.direction().into()))
            }

            /// Returns the shape of a segment or a triangle.
            fn shape(vertices: &[[f64; 3]]) -> Box<dyn Shape> {
                match *vertices {
                    [a, b] => Box::new(Segment::new(vector(a), vector(b))),
                    [a, b, c] => Box::new(Triangle::new(vector(a), vector(b), vector(c))),
                    _ => unreachable!("segments and triangles"),
                }
            }

            /// Returns the distance from a query to a segment or a triangle.
            #[allow(clippy::useless_conversion, reason = "one of the scalars is f64")]
            pub(crate) fn distance_to(query: [f64; 3], vertices: &[[f64; 3]]) -> f64 {
                let query = vector(query);
                (shape(vertices).project_local_point(query, false).point - query).length().into()
            }

            #[allow(clippy::useless_conversion, reason = "one of the scalars is f64")]
            fn distance(a: &dyn Shape, motion: &Pose, b: &dyn Shape) -> f64 {
                query::distance(&Pose::IDENTITY, a, motion, b).map_or(f64::NAN, |found| found.distance.into())
            }

            /// Returns the distance between two primitives, each a segment or a triangle.
            pub(crate) fn distance_between(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
                distance(&*shape(a), &Pose::IDENTITY, &*shape(b))
            }

            /// The shapes of a scene: a mesh, a polyline, or both.
            struct Parry {
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
                    // An answer of the polyline is nearer than the answer of the mesh, because the search was limited
                    // to that distance.
                    match of_lines.or(of_mesh) {
                        Some((distance, id)) => Answer { distance: distance.into(), id },
                        None => Answer::NONE,
                    }
                }
            }

            /// Copies the positions of a scene, as a user of parry has to, and returns a function that builds the
            /// shapes.
            fn copied(scene: &Scene) -> Result<impl FnOnce() -> Result<Parry, Unavailable> + use<>, Unavailable> {
                <$scalar as Scalar>::soup(scene)?;
                let soup = &scene.double;
                if !soup.points().is_empty() {
                    return Err(Unavailable("no shape for points".to_owned()));
                }
                let vectors =
                    |points: Vec<Point3<f64>>| points.into_iter().map(|p| vector(p.into())).collect::<Vec<_>>();
                let (triangle_positions, triangles) = used_positions(soup, soup.triangles());
                let (segment_positions, segments) = used_positions(soup, soup.segments());
                let (triangle_positions, segment_positions) = (vectors(triangle_positions), vectors(segment_positions));
                Ok(move || {
                    // parry does not accept an empty mesh.
                    let mesh = (!triangles.is_empty()).then(|| TriMesh::new(triangle_positions, triangles));
                    let mesh = mesh.transpose().map_err(Unavailable::because)?;
                    let lines = (!segments.is_empty()).then(|| Polyline::new(segment_positions, Some(segments)));
                    Ok(Parry { mesh, lines })
                })
            }

            /// Prepares the backend for the list.
            pub(crate) fn prepare(scene: &Scene) -> Result<Prepared, Unavailable> {
                let build = copied(scene)?;
                let build = move || Ok(Box::new(build()?) as BoxedIndex);
                Ok(Prepared { build: Box::new(build), borrowed: 0 })
            }

            /// The triangles of a scene.
            pub(crate) struct Mesh(TriMesh);

            impl Mesh {
                /// Builds the mesh of a scene. Segments are left out.
                pub(crate) fn build(scene: &Scene) -> Result<Self, Unavailable> {
                    let mesh = copied(scene)?()?.mesh;
                    mesh.map(Self).ok_or_else(|| Unavailable("the scene has no triangles".to_owned()))
                }

                /// Returns the parameter of the first hit of a ray, and the triangle if the normal is requested.
                #[allow(clippy::useless_conversion, reason = "one of the scalars is f64")]
                pub(crate) fn first_hit(&self, ray: &Ray, with_normal: bool) -> Option<(f64, usize)> {
                    if with_normal {
                        let hit = black_box(self.0.cast_local_ray_and_get_normal(ray, <$scalar>::MAX, false));
                        return hit.map(|hit| (hit.time_of_impact.into(), hit.subshape as usize));
                    }
                    self.0.cast_local_ray(ray, <$scalar>::MAX, false).map(|parameter| (parameter.into(), usize::MAX))
                }

                /// Returns the distance from another mesh after a motion.
                pub(crate) fn distance(&self, other: &Self, motion: &Isometry3<f64>) -> f64 {
                    distance(&self.0, &pose(motion), &other.0)
                }

                /// Returns 0 if another mesh intersects this one after a motion, else NaN.
                pub(crate) fn intersection(&self, other: &Self, motion: &Isometry3<f64>) -> f64 {
                    match query::intersection_test(&Pose::IDENTITY, &self.0, &pose(motion), &other.0) {
                        Ok(found) if found.intersecting => 0.0,
                        _ => f64::NAN,
                    }
                }

                /// Returns the distance from a capsule with this axis.
                #[allow(clippy::cast_possible_truncation, reason = "the library of f32 gets rounded coordinates")]
                pub(crate) fn distance_to_capsule(&self, axis: &[Point3<f64>; 2], radius: f64) -> f64 {
                    let [a, b] = axis.map(|end| vector(end.into()));
                    distance(&self.0, &Pose::IDENTITY, &Capsule::new(a, b, radius as $scalar))
                }
            }

            fn pose(motion: &Isometry3<f64>) -> Pose {
                let (turn, shift) = (motion.rotation.scaled_axis(), motion.translation.vector);
                Pose::new(vector(shift.into()), vector(turn.into()))
            }
        }
    };
}

parry!(
    /// The adapter for parry3d, to which ratios refer.
    single, parry3d, f32
);
parry!(
    /// The adapter for parry3d-f64.
    double, parry3d_f64, f64
);

/// Returns the positions that `elements` use, in order, and the renumbered elements. Each shape of parry owns its
/// positions, and should not own those of the other shape.
#[allow(clippy::cast_possible_truncation, reason = "no more positions than were numbered by u32")]
fn used_positions<const N: usize>(soup: &Soup<f64>, elements: &[[u32; N]]) -> (Vec<Point3<f64>>, Vec<[u32; N]>) {
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
