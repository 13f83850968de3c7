//! Shapes of parry as parts of a scene.

use p2m_core::BuildError;

/// Reasons why a shape cannot be added to a scene.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ShapeError {
    /// The shape is round, infinite or custom, so it does not consist of triangles and segments.
    #[error("a shape of type {0} does not consist of triangles and segments; add a mesh of it, as fine as you need")]
    NotPolygonal(String),
    /// The scene would not be valid.
    #[error(transparent)]
    Build(#[from] BuildError),
}

/// The two crates of parry have the same names for different types.
macro_rules! shapes {
    ($module:ident, $parry:ident, $add:ident, $feature:literal) => {
        #[cfg(feature = $feature)]
        mod $module {
            use super::ShapeError;
            use crate::scene::Scene;
            use nalgebra::Point3;
            use p2m_core::{Element, Soup};
            use std::ops::Range;
            use $parry::math::{Pose, Vector};
            use $parry::shape::{Shape, TypedShape};

            impl Scene {
                #[doc = concat!("Adds a shape of the crate ", stringify!($parry), " where `pose` puts it (feature `", $feature, "`).")]
                ///
                /// Triangles, segments, meshes, polylines, cuboids, convex polyhedra, height fields, voxels, and
                /// compounds of these. Solids become their surface: what is inside of one is near its surface, not at
                /// distance 0. Parry turns and moves positions, in its own precision, once.
                ///
                /// ```
                #[doc = concat!("use ", stringify!($parry), "::math::{Pose, Vector};")]
                #[doc = concat!("use ", stringify!($parry), "::shape::{Ball, Cuboid};")]
                /// use nalgebra::Point3;
                /// use p2m_core::{BruteForce, ClosestPoint};
                /// use p2m_mixed::Scene;
                ///
                /// let mut scene = Scene::default();
                /// let crate_on_top = Pose::from_translation(Vector::new(0.0, 0.0, 8.0));
                #[doc = concat!("scene.", stringify!($add), "(\"crate\", &Cuboid::new(Vector::new(1.0, 1.0, 1.0)), &crate_on_top)?;")]
                /// let index = BruteForce::new(&scene.soup)?;
                /// assert_eq!(index.closest_point(&Point3::new(0.5, 0.0, 2.0)).unwrap().distance, 5.0);
                ///
                /// let ball = Ball::new(1.0);
                #[doc = concat!("assert!(scene.", stringify!($add), "(\"ball\", &ball, &Pose::IDENTITY).is_err());")]
                /// let (positions, triangles) = ball.to_trimesh(32, 16); let positions: Vec<[f64; 3]> =
                /// positions.iter().map(|p| [p.x.into(), p.y.into(), p.z.into()]).collect();
                /// scene.add_triangles("ball", &positions, &triangles)?;
                /// # Ok::<(), Box<dyn std::error::Error>>(())
                /// ```
                ///
                /// # Errors
                /// [`ShapeError::NotPolygonal`] for what is round or endless, also inside of a compound; otherwise as
                /// [`Scene::add`]. The scene is then as it was.
                pub fn $add(&mut self, name: &str, shape: &dyn Shape, pose: &Pose) -> Result<Range<usize>, ShapeError> {
                    let mut part = Part::default();
                    part.shape(shape, pose)?;
                    Ok(self.add(name, &Soup::new(part.positions, part.elements)?)?)
                }
            }

            /// The positions and elements of the shapes that were added so far.
            #[derive(Default)]
            struct Part {
                positions: Vec<Point3<f64>>,
                elements: Vec<Element>,
            }

            impl Part {
                fn shape(&mut self, shape: &dyn Shape, pose: &Pose) -> Result<(), ShapeError> {
                    match shape.as_typed_shape() {
                        TypedShape::Segment(s) => self.add(pose, &[s.a, s.b], &[[0, 1]], Element::Segment),
                        TypedShape::Triangle(t) => self.add(pose, &[t.a, t.b, t.c], &[[0, 1, 2]], Element::Triangle),
                        TypedShape::Polyline(p) => self.add(pose, p.vertices(), p.indices(), Element::Segment),
                        TypedShape::TriMesh(m) => self.add(pose, m.vertices(), m.indices(), Element::Triangle),
                        TypedShape::Cuboid(c) => self.mesh(pose, c.to_trimesh()),
                        TypedShape::ConvexPolyhedron(c) => self.mesh(pose, c.to_trimesh()),
                        TypedShape::HeightField(h) => self.mesh(pose, h.to_trimesh()),
                        TypedShape::Voxels(v) => self.mesh(pose, v.to_trimesh()),
                        TypedShape::Compound(c) => {
                            return c.shapes().iter().try_for_each(|(at, shape)| self.shape(&**shape, &(*pose * *at)));
                        }
                        _ => return Err(ShapeError::NotPolygonal(format!("{:?}", shape.shape_type()))),
                    }
                    Ok(())
                }

                fn mesh(&mut self, pose: &Pose, (positions, triangles): (Vec<Vector>, Vec<[u32; 3]>)) {
                    self.add(pose, &positions, &triangles, Element::Triangle);
                }

                fn add<const N: usize>(
                    &mut self,
                    pose: &Pose,
                    positions: &[Vector],
                    elements: &[[u32; N]],
                    element: impl Fn([u32; N]) -> Element,
                ) {
                    // If u32 cannot number the positions, the indices saturate, and the part is an error.
                    let first = u32::try_from(self.positions.len()).unwrap_or(u32::MAX);
                    self.positions.extend(positions.iter().map(|p| {
                        let p = *pose * *p;
                        Point3::new(p.x.into(), p.y.into(), p.z.into())
                    }));
                    self.elements.extend(elements.iter().map(|e| element(e.map(|i| i.saturating_add(first)))));
                }
            }
        }
    };
}

shapes!(double, parry3d_f64, add_parry, "parry");
shapes!(single, parry3d, add_parry_f32, "parry-f32");
