//! The library parry3d in both scalars: `query::distance` of two `TriMesh`es, and of a `TriMesh` and a `Capsule`.

use super::arm::Arm;
use super::poses::Set;
use super::{Competitor, Kind, each};
use crate::scene::Scene;
use anyhow::Result;
use nalgebra::Isometry3;

/// The meshes of parry3d in both scalars.
pub(super) struct Scenes {
    single: single::Meshes,
    double: double::Meshes,
}

impl Scenes {
    pub(super) fn build(scene: &Scene, other: &Scene) -> Result<Self> {
        Ok(Self { single: single::Meshes::build(scene, other)?, double: double::Meshes::build(scene, other)? })
    }

    pub(super) fn competitors(&self, set: Set) -> Vec<Competitor<'_, Isometry3<f64>>> {
        let mut all = vec![
            Competitor::new("parry3d-f64", Kind::External, |poses: &[Isometry3<f64>], out: &mut [f64]| {
                each(poses, out, |pose| self.double.distance(pose));
            }),
            Competitor::new("parry3d", Kind::External, |poses: &[Isometry3<f64>], out: &mut [f64]| {
                each(poses, out, |pose| self.single.distance(pose));
            }),
        ];
        if set == Set::Deep {
            all.push(Competitor::new("parry3d-f64, whether they intersect", Kind::External, |poses, out| {
                each(poses, out, |pose| self.double.intersects(pose));
            }));
            all.push(Competitor::new("parry3d, whether they intersect", Kind::External, |poses, out| {
                each(poses, out, |pose| self.single.intersects(pose));
            }));
        }
        all
    }

    pub(super) fn arm_competitors(&self) -> Vec<Competitor<'_, Arm>> {
        vec![
            Competitor::new("parry3d-f64", Kind::External, |arms: &[Arm], out: &mut [f64]| {
                each(arms, out, |arm| self.double.arm_distance(arm));
            }),
            Competitor::new("parry3d", Kind::External, |arms: &[Arm], out: &mut [f64]| {
                each(arms, out, |arm| self.single.arm_distance(arm));
            }),
        ]
    }
}

/// Generates the adapter for one of the two crates of parry, which have the same names for different types.
macro_rules! parry {
    ($module:ident, $parry:ident, $scalar:ty) => {
        mod $module {
            use super::super::arm::Arm;
            use crate::scene::Scene;
            use anyhow::{Result, anyhow};
            use nalgebra::{Isometry3, Point3};
            use $parry::math::{Pose, Vector};
            use $parry::query::{distance, intersection_test};
            use $parry::shape::{Capsule, TriMesh};

            pub(super) struct Meshes([TriMesh; 2]);

            #[allow(clippy::cast_possible_truncation, reason = "the library of f32 gets rounded coordinates")]
            fn vector(p: &Point3<f64>) -> Vector {
                Vector::new(p.x as $scalar, p.y as $scalar, p.z as $scalar)
            }

            fn pose(motion: &Isometry3<f64>) -> Pose {
                let (turn, shift) = (motion.rotation.scaled_axis(), motion.translation.vector);
                Pose::new(vector(&shift.into()), vector(&turn.into()))
            }

            impl Meshes {
                pub(super) fn build(scene: &Scene, other: &Scene) -> Result<Self> {
                    let mesh = |scene: &Scene| {
                        let positions = scene.double.positions().iter().map(vector).collect();
                        TriMesh::new(positions, scene.double.triangles().to_vec()).map_err(|error| anyhow!("{error}"))
                    };
                    Ok(Self([mesh(scene)?, mesh(other)?]))
                }

                #[allow(clippy::useless_conversion, reason = "one of the scalars is f64")]
                pub(super) fn distance(&self, motion: &Isometry3<f64>) -> f64 {
                    let [a, b] = &self.0;
                    distance(&Pose::IDENTITY, a, &pose(motion), b).map_or(f64::NAN, |found| found.distance.into())
                }

                pub(super) fn intersects(&self, motion: &Isometry3<f64>) -> f64 {
                    let [a, b] = &self.0;
                    match intersection_test(&Pose::IDENTITY, a, &pose(motion), b) {
                        Ok(found) if found.intersecting => 0.0,
                        _ => f64::NAN,
                    }
                }

                #[allow(clippy::useless_conversion, reason = "one of the scalars is f64")]
                #[allow(clippy::cast_possible_truncation, reason = "the library of f32 gets rounded coordinates")]
                pub(super) fn arm_distance(&self, arm: &Arm) -> f64 {
                    let distances = arm.axes.iter().map(|[a, b]| {
                        let capsule = Capsule::new(vector(a), vector(b), arm.radius as $scalar);
                        let found = distance(&Pose::IDENTITY, &self.0[0], &Pose::IDENTITY, &capsule);
                        found.map_or(f64::NAN, |found| found.distance.into())
                    });
                    distances.fold(f64::INFINITY, f64::min)
                }
            }
        }
    };
}

parry!(single, parry3d, f32);
parry!(double, parry3d_f64, f64);
