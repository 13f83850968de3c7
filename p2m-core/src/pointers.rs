//! Implementations for references and smart pointers to sets and indexes, which delegate to their targets.
//!
//! So an index can own its scene, borrow it, or share it with others (`Arc<Soup<f64>>`), and a function over `impl
//! ClosestPoint<T>` also takes `&I`, `Box<dyn ClosestPoint<T>>` and `Arc<I>`.

use crate::pair::search::PairSide;
use crate::pair::{Hull, Motion, PairQuery};
use crate::{
    Aabb, BatchAnswer, Best, BoxQuery, CertifiedQuery, ClosestPoint, Hits, IndexStats, Near, NearQuery, PrimitiveId,
    PrimitiveSet, QueryOptions, Ray, RayQuery, Real, Shape,
};
use nalgebra::Point3;
use std::ops::ControlFlow;
use std::rc::Rc;
use std::sync::Arc;

/// Implements the traits of sets and indexes for a pointer type by delegation to its target. Methods that no backend of
/// this project overrides keep their defaults, so if your type overrides one, it is not called through a pointer.
macro_rules! point_to {
    ($target:ident, $pointer:ty) => {
        impl<T: Real, $target: PrimitiveSet<T> + ?Sized> PrimitiveSet<T> for $pointer {
            type Primitive<'a>
                = $target::Primitive<'a>
            where
                Self: 'a;

            #[inline(always)]
            fn len(&self) -> usize {
                (**self).len()
            }
            #[inline(always)]
            fn get(&self, id: PrimitiveId) -> Self::Primitive<'_> {
                (**self).get(id)
            }
        }

        impl<T: Real, $target: ClosestPoint<T> + ?Sized> ClosestPoint<T> for $pointer {
            fn search(&self, query: &Point3<T>, best: &mut Best<T>) {
                (**self).search(query, best);
            }
            fn answer_queries(
                &self,
                queries: &[Point3<T>],
                options: &QueryOptions<T>,
                answered: &mut dyn FnMut(usize, BatchAnswer<'_, T>),
            ) {
                (**self).answer_queries(queries, options, answered);
            }
            fn rays(&self) -> Option<&dyn RayQuery<T>> {
                (**self).rays()
            }
        }

        impl<T: Real, $target: NearQuery<T> + ?Sized> NearQuery<T> for $pointer {
            fn search_near(&self, query: &Point3<T>, near: &mut Near<'_>) {
                (**self).search_near(query, near);
            }
        }

        impl<T: Real, $target: PairQuery<T> + ?Sized> PairQuery<T> for $pointer {
            fn primitive_count(&self) -> usize {
                (**self).primitive_count()
            }
            fn hull(&self, id: PrimitiveId) -> Hull {
                (**self).hull(id)
            }
            fn pair_bounds(&self) -> Aabb<f64> {
                (**self).pair_bounds()
            }
            fn visit_pair_sides(
                &self,
                motions: &[Motion],
                near: &Aabb<f64>,
                search: &mut dyn FnMut(&dyn PairSide, usize) -> f64,
            ) -> bool {
                (**self).visit_pair_sides(motions, near, search)
            }
            fn guess_closest(&self, point: [f64; 3]) -> Option<([f64; 3], PrimitiveId)> {
                (**self).guess_closest(point)
            }
            fn goes_on(&self) -> bool {
                (**self).goes_on()
            }
        }

        impl<T: Real, $target: CertifiedQuery<T> + ?Sized> CertifiedQuery<T> for $pointer {
            fn shape(&self, id: PrimitiveId) -> Option<Shape<T>> {
                (**self).shape(id)
            }
        }

        impl<T: Real, $target: IndexStats<T> + ?Sized> IndexStats<T> for $pointer {
            fn parts(&self) -> Vec<(&'static str, usize)> {
                (**self).parts()
            }
            fn list_lengths(&self) -> Vec<usize> {
                (**self).list_lengths()
            }
            fn list_length(&self, point: &Point3<T>) -> Option<usize> {
                (**self).list_length(point)
            }
        }

        impl<T: Real, $target: RayQuery<T> + ?Sized> RayQuery<T> for $pointer {
            fn search_ray<'r>(&self, ray: &'r Ray, hits: &mut Hits<'r>) {
                (**self).search_ray(ray, hits);
            }
            fn visit_ray_candidates(&self, ray: &Ray, visit: &mut dyn FnMut(PrimitiveId, &[[f64; 3]]) -> f64) {
                (**self).visit_ray_candidates(ray, visit);
            }
        }

        impl<T: Real, $target: BoxQuery<T> + ?Sized> BoxQuery<T> for $pointer {
            fn visit_box(
                &self,
                bounds: &Aabb<T>,
                visit: &mut dyn FnMut(PrimitiveId) -> ControlFlow<()>,
            ) -> ControlFlow<()> {
                (**self).visit_box(bounds, visit)
            }
        }
    };
}

point_to!(I, &I);
point_to!(I, Box<I>);
point_to!(I, Rc<I>);
point_to!(I, Arc<I>);
