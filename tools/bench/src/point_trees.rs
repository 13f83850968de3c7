//! KD-trees of the crate kiddo and of the C++ library nanoflann, for scenes of points only.
//!
//! Both are built with their default settings. nanoflann is compiled with the feature `nanoflann`; its tree is not
//! counted as memory, because the allocator of this program does not see it.

use crate::backend::{Answer, BenchIndex, BoxedIndex, Prepared, Scalar, Unavailable};
use crate::scene::Scene;
use kiddo::{ImmutableKdTree, SquaredEuclidean};
use nalgebra::Point3;

/// Returns the points of a scene, if it has nothing else.
fn points<T: Scalar>(scene: &Scene) -> Result<Vec<[T; 3]>, Unavailable> {
    let (soup, _) = T::soup(scene)?;
    if soup.points().len() < scene.len() {
        return Err(Unavailable("the scene has other primitives than points".to_owned()));
    }
    Ok(soup.points().iter().map(|vertex| soup.positions()[*vertex as usize].into()).collect())
}

/// Generates the adapter of kiddo for a scalar, because its traits are bounded differently for each.
macro_rules! kiddo {
    ($name:ident, $scalar:ty) => {
        impl BenchIndex for Kiddo<$scalar> {
            type Scalar = $scalar;

            #[inline(always)]
            fn query(&self, query: &Point3<$scalar>) -> Answer {
                let nearest =
                    self.0.query(&[query.x, query.y, query.z]).nearest_one::<SquaredEuclidean<$scalar>>().execute();
                Answer { distance: f64::from(nearest.distance.sqrt()), id: nearest.item }
            }
        }

        /// Prepares the KD-tree of kiddo in a scalar.
        pub(crate) fn $name(scene: &Scene) -> Result<Prepared<'_>, Unavailable> {
            let points = points::<$scalar>(scene)?;
            let build = move || {
                let tree = ImmutableKdTree::new_from_slice(&points);
                Ok(Box::new(Kiddo(tree.map_err(|error| Unavailable(format!("{error:?}")))?)) as BoxedIndex<'_>)
            };
            Ok(Prepared { build: Box::new(build), borrowed: 0 })
        }
    };
}

/// The KD-tree of kiddo.
struct Kiddo<T: Copy + Default>(ImmutableKdTree<T, 3>);

kiddo!(kiddo_double, f64);
kiddo!(kiddo_single, f32);

#[cfg(feature = "nanoflann")]
mod nanoflann {
    use super::*;

    impl<T: Scalar + p2m_nanoflann::Scalar> BenchIndex for p2m_nanoflann::KdTree<T> {
        type Scalar = T;

        fn query(&self, query: &Point3<T>) -> Answer {
            let mut answer = [Answer::NONE];
            self.queries(std::slice::from_ref(query), &mut answer);
            answer[0]
        }

        fn queries(&self, queries: &[Point3<T>], answers: &mut [Answer]) {
            let coordinates: Vec<[T; 3]> = queries.iter().map(|query| query.coords.into()).collect();
            let (mut squares, mut numbers) = (vec![T::zero(); queries.len()], vec![0; queries.len()]);
            self.nearest(&coordinates, &mut squares, &mut numbers);
            for ((answer, square), id) in answers.iter_mut().zip(squares).zip(numbers) {
                *answer = Answer { distance: square.to_f64().sqrt(), id };
            }
        }
    }

    /// Prepares the KD-tree of nanoflann in a scalar.
    pub(super) fn prepare<T: Scalar + p2m_nanoflann::Scalar>(scene: &Scene) -> Result<Prepared<'_>, Unavailable> {
        let points = points::<T>(scene)?;
        let build = move || {
            let tree = p2m_nanoflann::KdTree::new(points).ok_or_else(|| Unavailable("no tree".to_owned()))?;
            Ok(Box::new(tree) as BoxedIndex<'_>)
        };
        Ok(Prepared { build: Box::new(build), borrowed: 0 })
    }
}

/// Prepares the KD-tree of nanoflann in f64.
pub(crate) fn nanoflann_double(scene: &Scene) -> Result<Prepared<'_>, Unavailable> {
    #[cfg(feature = "nanoflann")]
    return nanoflann::prepare::<f64>(scene);
    #[cfg(not(feature = "nanoflann"))]
    without_nanoflann(scene)
}

/// Prepares the KD-tree of nanoflann in f32.
pub(crate) fn nanoflann_single(scene: &Scene) -> Result<Prepared<'_>, Unavailable> {
    #[cfg(feature = "nanoflann")]
    return nanoflann::prepare::<f32>(scene);
    #[cfg(not(feature = "nanoflann"))]
    without_nanoflann(scene)
}

#[cfg(not(feature = "nanoflann"))]
fn without_nanoflann(_: &Scene) -> Result<Prepared<'_>, Unavailable> {
    Err(Unavailable("this program was compiled without the feature `nanoflann`".to_owned()))
}
