//! Batches of pair queries, over shapes or over motions.

use super::{ClosestPair, Hull, PairOptions, PairQuery, bounds_of};
use crate::batch::{BatchOptions, map};
use crate::{Primitive, Real};
use nalgebra::{Isometry3, Point3};

/// Returns the nearest points of a scene and each shape, in the order of the shapes, on all threads.
///
/// ```
/// use nalgebra::Point3;
/// use p2m_core::pair::{PairOptions, closest_to_each};
/// use p2m_core::{BruteForce, Point, Segment};
///
/// let scene = BruteForce::new([Point::new(Point3::new(0.0, 0.0, 5.0))])?;
/// let arm = [1.0, 2.0].map(|z| Segment::new(Point3::new(0.0, 0.0, z - 1.0), Point3::new(0.0, 0.0, z)));
/// let links = closest_to_each(&scene, &arm, &PairOptions::default().with_radius(0.5), &Default::default());
/// assert_eq!(links.iter().flatten().map(|pair| pair.distance).collect::<Vec<_>>(), [3.5, 2.5]);
/// # Ok::<(), p2m_core::BuildError>(())
/// ```
///
/// # Panics
/// Panics if there are primitives without vertices.
///
/// # Complexity
/// It takes the time of [`PairQuery::closest_to`] for each shape.
pub fn closest_to_each<T: Real, P: Primitive<T> + Sync, I: PairQuery<T> + Sync>(
    index: &I,
    shapes: &[P],
    options: &PairOptions<T>,
    batch: &BatchOptions,
) -> Vec<Option<ClosestPair<T>>> {
    let centre = |shape: &P| {
        let bounds = bounds_of(Hull::of(shape).vertices());
        nalgebra::center(&bounds.min, &bounds.max)
    };
    map(shapes, batch, centre, |shape| index.closest_to(shape, options))
}

/// Returns the nearest points of two scenes for each motion of the second one, in the order of the motions, on all
/// threads. The motion and the hint of the options are not used.
///
/// ```
/// use nalgebra::{Isometry3, Point3};
/// use p2m_core::pair::{PairOptions, closest_pair_at_each};
/// use p2m_core::{BruteForce, Point};
///
/// let scene = BruteForce::new([Point::new(Point3::new(0.0, 0.0, 0.0))])?;
/// let motions = [1.0, 2.0].map(|x| Isometry3::translation(x, 0.0, 0.0));
/// let pairs = closest_pair_at_each(&scene, &scene, &motions, &PairOptions::default(), &Default::default());
/// assert_eq!(pairs.iter().flatten().map(|pair| pair.distance).collect::<Vec<_>>(), [1.0, 2.0]);
/// # Ok::<(), p2m_core::BuildError>(())
/// ```
///
/// # Panics
/// Panics if there are primitives without vertices.
///
/// # Complexity
/// It takes the time of [`PairQuery::closest_pair`] for each motion.
pub fn closest_pair_at_each<T: Real, I: PairQuery<T> + Sync, J: PairQuery<T> + Sync + ?Sized>(
    first: &I,
    second: &J,
    motions: &[Isometry3<f64>],
    options: &PairOptions<T>,
    batch: &BatchOptions,
) -> Vec<Option<ClosestPair<T>>> {
    let position = |motion: &Isometry3<f64>| Point3::from(motion.translation.vector);
    map(motions, batch, position, |motion| {
        first.closest_pair(second, &PairOptions { motion: Some(*motion), hint: None, ..*options })
    })
}
