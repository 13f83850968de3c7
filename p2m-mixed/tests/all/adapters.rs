//! The adapters of other crates are compared with the contract of our indexes.
#![cfg(all(feature = "parry", feature = "parry-f32", feature = "rstar"))]
#![allow(clippy::float_cmp, reason = "bitwise equality is what is tested")]

use nalgebra::Point3;
use p2m_core::{BruteForce, BuildError, BuildIndex, Closest, ClosestPoint, NearQuery, PrimitiveSet, Real, Soup};
use p2m_mixed::adapters::{ParryIndex, RstarIndex};
use p2m_testkit::near_check;
use p2m_testkit::scenes::{extreme_soups, narrow, queries, random_soups, to_f32};

macro_rules! adapters {
    ($($name:ident: $index:ident),+ $(,)?) => {
        $(mod $name {
            use super::*;

            #[test]
            fn agrees_on_random_scenes() {
                for (seed, soup) in random_soups(stringify!($name)) {
                    let queries = queries(seed, &soup);
                    agrees::<f64, $index<f64, _>>(seed, &soup, &queries);
                    let single: Vec<_> = queries.into_iter().map(to_f32).collect();
                    agrees::<f32, $index<f32, _>>(seed, &narrow(&soup).expect("fits f32"), &single);
                }
            }

            #[test]
            fn agrees_at_extreme_scales() {
                for (seed, soup, queries) in extreme_soups("scales of adapters") {
                    agrees::<f64, $index<f64, _>>(seed, &soup, &queries);
                }
            }
        })+
    };
}

adapters! {
    parry: ParryIndex,
    rstar: RstarIndex,
}

/// All shapes of triangles and segments, in both precisions, have the distances that parry computes for them.
macro_rules! shapes {
    ($($name:ident: $parry:ident, $add:ident, $tolerance:literal);+ $(;)?) => {
        $(mod $name {
            use super::*;
            use p2m_core::{Element, PrimitiveId};
            use p2m_mixed::Scene;
            use p2m_mixed::adapters::ShapeError;
            use $parry::math::{Pose, Rotation, Vector};
            use $parry::shape::{
                Ball, Compound, ConvexPolyhedron, Cuboid, HalfSpace, Polyline, Segment, Shape, SharedShape, TriMesh, Triangle,
            };

            /// A rotated pose away from the origin.
            fn pose(z: f64) -> Pose {
                Pose::from_parts(Vector::new(1.0, -2.0, z as _), Rotation::from_rotation_x(0.5))
            }

            #[test]
            fn shapes_are_where_parry_has_them() {
                let p = |x, y, z| Vector::new(x, y, z);
                let corners = vec![p(0.0, 0.0, 0.0), p(2.0, 0.0, 0.0), p(0.0, 2.0, 0.0), p(0.0, 0.0, 2.0)];
                let mesh = TriMesh::new(corners.clone(), vec![[0, 2, 1], [0, 1, 3]]).unwrap();
                let line = Polyline::new(corners.clone(), None);
                let hull = ConvexPolyhedron::from_convex_hull(&corners).unwrap();
                let compound = Compound::new(vec![
                    (pose(3.0), SharedShape::new(Cuboid::new(p(1.0, 2.0, 0.5)))),
                    (pose(-3.0), SharedShape::new(Segment::new(corners[1], corners[3]))),
                ]);
                let triangle = Triangle::new(corners[1], corners[2], corners[3]);
                let segment = Segment::new(corners[1], corners[3]);
                let cuboid = Cuboid::new(p(1.0, 2.0, 3.0));
                let shapes: [(&dyn Shape, usize); 7] =
                    [(&mesh, 2), (&line, 3), (&hull, 4), (&compound, 13), (&triangle, 1), (&segment, 1), (&cuboid, 12)];
                for (k, (shape, count)) in shapes.into_iter().enumerate() {
                    let mut scene = Scene::default();
                    scene.add_points("first", &[[50.0, 50.0, 50.0]]).unwrap();
                    assert_eq!(scene.$add("shape", shape, &pose(0.5)).unwrap(), 1..1 + count, "shape {k}");
                    let index = BruteForce::new(&scene.soup).unwrap();
                    for i in 0..200 {
                        // The query is outside of every shape. Inside of solids, the distance of parry is to the
                        // surface as well.
                        let q = Point3::new(i as f64 * 0.07 - 6.0, (i * i % 17) as f64 - 8.0, (i * i % 23) as f64 - 11.0);
                        let answer = index.closest_point(&q).unwrap();
                        let place = Vector::new(q.x as _, q.y as _, q.z as _);
                        let projection = shape.project_point(&pose(0.5), place, false);
                        let expected = f64::from((projection.point - place).length());
                        assert!((answer.distance - expected).abs() < $tolerance, "shape {k}, query {q}");
                        assert_eq!(scene.object_of(answer.primitive).unwrap().name, "shape");
                    }
                }
            }

            #[test]
            fn round_and_infinite_shapes_are_errors() {
                let ball = SharedShape::new(Ball::new(1.0));
                let compound = Compound::new(vec![(Pose::IDENTITY, SharedShape::cuboid(1.0, 1.0, 1.0)), (pose(1.0), ball)]);
                let mut scene = Scene::default();
                let error = scene.$add("", &compound, &Pose::IDENTITY).unwrap_err();
                assert_eq!(error, ShapeError::NotPolygonal("Ball".to_owned()));
                assert!(error.to_string().contains("type Ball does not consist of triangles"));
                let plane = HalfSpace::new(Vector::Y);
                assert!(matches!(scene.$add("", &plane, &Pose::IDENTITY), Err(ShapeError::NotPolygonal(_))));
                assert_eq!(scene, Scene::default());
                let bad = Segment::new(Vector::ZERO, Vector::new(f64::NAN as _, 0.0, 0.0));
                let id = PrimitiveId::new(0);
                let error = scene.$add("", &bad, &Pose::IDENTITY).unwrap_err();
                assert_eq!(error, ShapeError::Build(BuildError::NonFinite { id }));
                scene.$add("", &Segment::new(Vector::ZERO, Vector::X), &Pose::IDENTITY).unwrap();
                assert_eq!(scene.soup.element(id), Element::Segment([0, 1]));
            }
        })+
    };
}

shapes! {
    double_shapes: parry3d_f64, add_parry, 1e-12;
    single_shapes: parry3d, add_parry_f32, 1e-4;
}

fn agrees<'a, T: Real, I>(seed: u64, soup: &'a Soup<T>, queries: &[Point3<T>])
where
    I: NearQuery<T> + BuildIndex<T, &'a Soup<T>, Options = (), Error = BuildError>,
{
    let index = I::build(soup, &()).expect("valid scene");
    let brute = BruteForce::new(soup).expect("valid scene");
    let known = |c: Option<Closest<T>>| c.map(|c| (c.point, c.distance, c.primitive, c.feature, c.barycentric));
    for q in queries {
        assert_eq!(known(index.closest_point(q)), known(brute.closest_point(q)), "seed {seed}, {q:?}");
        assert_eq!(index.closest_point(q).is_some(), !soup.is_empty());
    }
    near_check::agrees(seed, soup, queries, &index);
}

/// A set with more primitives than ids, none of which is ever requested.
struct Absurd(usize);

impl PrimitiveSet<f64> for Absurd {
    type Primitive<'a>
        = p2m_core::Point<f64>
    where
        Self: 'a;

    fn len(&self) -> usize {
        self.0
    }
    fn get(&self, id: p2m_core::PrimitiveId) -> p2m_core::Point<f64> {
        panic!("primitive {id} of {} was asked for", self.0)
    }
}

#[test]
fn more_primitives_than_ids_are_an_error_before_anything_else() {
    for len in [(1 << 30) + 1, usize::MAX] {
        assert_eq!(ParryIndex::<f64, _>::build(Absurd(len), &()).err(), Some(BuildError::TooMany { len }));
        assert_eq!(RstarIndex::<f64, _>::build(Absurd(len), &()).err(), Some(BuildError::TooMany { len }));
    }
}
