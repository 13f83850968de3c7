//! The library parry3d in both scalars, queried for the first hit of a ray with a `TriMesh`, which is hollow.
//!
//! It promises nothing about rays through edges, and a parameter of f32 is as accurate as its rounding.

pub(super) use double::prepare as parry_double;
pub(super) use single::prepare as parry_single;

/// Generates the adapter for one of the two crates of parry, which have the same names for different types.
macro_rules! parry {
    ($module:ident, $parry:ident, $scalar:ty, $rays:ident) => {
        mod $module {
            use crate::backend::{Prepared, Scalar, Unavailable};
            use crate::rays::backend::{ExternalCaster, Outcome, RayIndex, Rays};
            use crate::scene::Scene;
            use $parry::math::Vector;
            use $parry::query::{Ray, RayCast};
            use $parry::shape::TriMesh;

            struct Parry {
                mesh: TriMesh,
                /// Whether triangle and normal are requested as well.
                normal: bool,
            }

            impl ExternalCaster for Parry {
                fn first(&self, rays: &Rays, outcomes: &mut [Outcome]) {
                    let of = |(o, d): &(nalgebra::Point3<$scalar>, nalgebra::Vector3<$scalar>)| {
                        Ray::new(Vector::new(o.x, o.y, o.z), Vector::new(d.x, d.y, d.z))
                    };
                    let pairs = rays.$rays.iter().map(of).zip(outcomes);
                    let found = |parameter: $scalar, id: usize| Outcome::hit(parameter.into(), id);
                    if self.normal {
                        pairs.for_each(|(ray, outcome)| {
                            let hit = self.mesh.cast_local_ray_and_get_normal(&ray, <$scalar>::MAX, false);
                            let hit = std::hint::black_box(hit);
                            *outcome =
                                hit.map_or(Outcome::NONE, |hit| found(hit.time_of_impact, hit.subshape as usize));
                        });
                    } else {
                        pairs.for_each(|(ray, outcome)| {
                            let hit = self.mesh.cast_local_ray(&ray, <$scalar>::MAX, false);
                            *outcome = hit.map_or(Outcome::NONE, |parameter| found(parameter, usize::MAX));
                        });
                    }
                }
            }

            /// Copies the positions, as a user of parry has to.
            pub(in crate::rays) fn prepare(
                scene: &Scene,
                normal: bool,
            ) -> Result<Prepared<'_, RayIndex<'_>>, Unavailable> {
                let (soup, _) = <$scalar as Scalar>::soup(scene)?;
                if !soup.points().is_empty() || !soup.segments().is_empty() {
                    return Err(Unavailable("its rays meet triangles only".to_owned()));
                }
                let positions = soup.positions().iter().map(|p| Vector::new(p.x, p.y, p.z)).collect();
                let triangles = soup.triangles().to_vec();
                let build = move || {
                    let mesh = TriMesh::new(positions, triangles).map_err(|error| Unavailable(error.to_string()))?;
                    Ok(RayIndex::External(Box::new(Parry { mesh, normal })))
                };
                Ok(Prepared { build: Box::new(build), borrowed: 0 })
            }
        }
    };
}

parry!(single, parry3d, f32, single);
parry!(double, parry3d_f64, f64, double);
