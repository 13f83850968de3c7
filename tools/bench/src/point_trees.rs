//! The KD-tree of the crate kiddo with default settings, for scenes of only points.

use crate::backend::{Answer, BenchIndex, BoxedIndex, Prepared, Scalar, Unavailable};
use crate::scene::Scene;
use kiddo::{ImmutableKdTree, SquaredEuclidean};
use nalgebra::Point3;

/// Returns the points of a scene, unless it has other primitives.
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
        pub(crate) fn $name(scene: &Scene) -> Result<Prepared, Unavailable> {
            let points = points::<$scalar>(scene)?;
            let build = move || {
                let tree = ImmutableKdTree::new_from_slice(&points);
                Ok(Box::new(Kiddo(tree.map_err(|error| Unavailable(format!("{error:?}")))?)) as BoxedIndex)
            };
            Ok(Prepared { build: Box::new(build), borrowed: 0 })
        }
    };
}

/// The KD-tree of kiddo.
struct Kiddo<T: Copy + Default>(ImmutableKdTree<T, 3>);

kiddo!(kiddo_double, f64);
kiddo!(kiddo_single, f32);
