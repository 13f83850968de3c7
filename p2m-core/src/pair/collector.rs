//! The collector of near pairs of primitives, and the answer of a search for them.

use super::NearestPair;
use crate::query::answer::{ROUND_DOWN, square_within};
use crate::real::from_f64_array;
use crate::{Feature, PrimitiveId, Real};
use nalgebra::{Isometry3, Point3};
use std::ops::ControlFlow;

/// The options of a search for pairs.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct PairOptions<T: Real> {
    /// The largest distance of an answer, inclusive, in units of the scene. It is infinite by default.
    pub max_distance: T,
    /// The motion of the second scene. It is applied to each vertex in f64, and each coordinate is rounded: the answer
    /// is that of the scene of these vertices. `None`, the default, leaves the scene where it is.
    pub motion: Option<Isometry3<f64>>,
    /// A pair that is probably near, such as the answer for the last motion. It is evaluated first, so a good one saves
    /// most of the search; it never changes the answer. Ids that a scene does not have are ignored.
    pub hint: Option<[PrimitiveId; 2]>,
}

impl<T: Real> Default for PairOptions<T> {
    fn default() -> Self {
        Self { max_distance: T::INFINITY, motion: None, hint: None }
    }
}

impl<T: Real> PairOptions<T> {
    /// Sets the largest distance.
    #[must_use]
    pub fn with_max_distance(self, max_distance: T) -> Self {
        Self { max_distance, ..self }
    }
    /// Sets the motion of the second scene.
    #[must_use]
    pub fn with_motion(self, motion: Isometry3<f64>) -> Self {
        Self { motion: Some(motion), ..self }
    }
    /// Sets a pair that is probably near.
    #[must_use]
    pub fn with_hint(self, hint: [PrimitiveId; 2]) -> Self {
        Self { hint: Some(hint), ..self }
    }
}

/// The nearest points of two scenes, or of a scene and a shape. Lengths are in units of the scenes, and arrays of two
/// have the first scene first.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ClosestPair<T: Real> {
    /// The nearest points, that of the second scene after its motion.
    pub points: [Point3<T>; 2],
    /// The distance of the scenes, which is 0 if they intersect.
    pub distance: T,
    /// A certified lower bound on the true distance, for the second scene as its motion has rounded it
    /// ([`Motion`](super::Motion)).
    pub lower_bound: T,
    /// The primitives that contain the points: of several pairs with equal keys the one with the lowest id in the first
    /// scene, then in the second. A shape has the id 0.
    pub primitives: [PrimitiveId; 2],
    /// The features of these primitives that contain the points.
    pub features: [Feature; 2],
    /// The weights of the vertices of each primitive.
    pub barycentric: [[T; 3]; 2],
    /// Whether the two primitives intersect, which is exact. If no two primitives do, it is false.
    pub is_intersecting: bool,
}

/// Receives the pairs that a search finds, and decides what it may leave out.
pub struct Pairs<'a> {
    /// The largest f64 distance that is reported within the largest one.
    radius: f64,
    /// The square that lower bounds must not exceed.
    prune: f64,
    mode: Mode<'a>,
    /// Whether nothing can be within the radius.
    is_empty: bool,
    /// Whether the visitor ended the search.
    has_ended: bool,
}

enum Mode<'a> {
    /// The nearest pair so far, and the smallest certified bound of all.
    Nearest { best: Option<([PrimitiveId; 2], NearestPair)>, certified: f64 },
    /// All pairs within the radius.
    Each(&'a mut dyn FnMut([PrimitiveId; 2], &NearestPair) -> ControlFlow<()>),
}

impl<'a> Pairs<'a> {
    fn new<T: Real>(radius: T, mode: Mode<'a>) -> Self {
        let radius = radius.to_f64_above();
        // Nothing is within NaN.
        let is_empty = radius.is_nan() || radius < 0.0;
        Self { radius, prune: square_within(radius), mode, is_empty, has_ended: false }
    }

    /// Creates the collector of the nearest pair within a distance.
    #[must_use]
    pub fn nearest<T: Real>(max_distance: T) -> Self {
        Self::new(max_distance, Mode::Nearest { best: None, certified: f64::INFINITY })
    }

    /// Creates the collector that calls a function for each pair within a distance until it breaks.
    #[must_use]
    pub fn each<T: Real>(
        max_distance: T,
        visit: &'a mut dyn FnMut([PrimitiveId; 2], &NearestPair) -> ControlFlow<()>,
    ) -> Self {
        Self::new(max_distance, Mode::Each(visit))
    }

    /// Returns the square above which a lower bound excludes a pair.
    #[inline]
    #[must_use]
    pub fn prune_above(&self) -> f64 {
        self.prune
    }

    /// Returns whether the search is over.
    #[inline]
    #[must_use]
    pub fn is_done(&self) -> bool {
        self.is_empty || self.has_ended
    }

    /// Returns whether the function that was given to [`each`](Self::each) has ended the search.
    #[must_use]
    pub fn has_ended(&self) -> bool {
        self.has_ended
    }

    /// Returns whether only the nearest pair counts.
    #[doc(hidden)]
    #[must_use]
    pub fn is_nearest(&self) -> bool {
        matches!(self.mode, Mode::Nearest { .. })
    }

    /// Returns the vector from the nearest point of the first scene to that of the second, for the nearest pair so far.
    #[doc(hidden)]
    #[must_use]
    pub fn separation(&self) -> Option<[f64; 3]> {
        match &self.mode {
            Mode::Nearest { best: Some((_, pair)), .. } => Some((pair.points[1] - pair.points[0]).into()),
            _ => None,
        }
    }

    /// Returns whether a pair of these primitives could still change the answer. It could not if a pair with lower ids
    /// intersects.
    #[inline]
    #[must_use]
    pub fn can_change(&self, ids: [PrimitiveId; 2]) -> bool {
        let Mode::Nearest { best: Some((others, pair)), .. } = &self.mode else { return true };
        !(pair.is_intersecting && *others < ids)
    }

    /// Takes the result of the kernel for a pair of primitives.
    pub fn offer_result(&mut self, ids: [PrimitiveId; 2], result: Result<NearestPair, f64>) {
        match (result, &mut self.mode) {
            (Ok(pair), _) => self.offer(ids, &pair),
            (Err(bound), Mode::Nearest { certified, .. }) => *certified = certified.min(bound),
            (Err(_), Mode::Each(_)) => {}
        }
    }

    /// Takes a pair of primitives.
    pub fn offer(&mut self, ids: [PrimitiveId; 2], pair: &NearestPair) {
        let distance = pair.key.distance();
        match &mut self.mode {
            Mode::Nearest { best, certified } => {
                // A distance beyond the range of f64 is at least the largest number.
                *certified = certified.min(distance.min(f64::MAX) - pair.error);
                let is_better = best.as_ref().is_none_or(|(others, other)| (pair.key, ids) < (other.key, *others));
                if is_better && distance <= self.radius {
                    *best = Some((ids, *pair));
                    self.prune = self.prune.min(pair.key.square_above());
                }
            }
            Mode::Each(visit) => {
                if distance <= self.radius {
                    self.has_ended |= visit(ids, pair).is_break();
                }
            }
        }
    }

    /// Returns the nearest pair, or `None` if there was none within the radius.
    #[must_use]
    pub fn finish<T: Real>(self) -> Option<ClosestPair<T>> {
        let Mode::Nearest { best: Some((primitives, pair)), certified } = self.mode else { return None };
        // What was pruned is farther than the best pair, whose square is exact to 5 u.
        let bound =
            certified.min(pair.key.distance().min(f64::MAX) * ROUND_DOWN) * ROUND_DOWN - 8.0 * f64::from_bits(1);
        Some(ClosestPair {
            points: pair.points.map(|point| from_f64_array(point.coords.into())),
            distance: T::round_from_f64(pair.key.distance()),
            lower_bound: if bound > 0.0 { T::round_down_from_f64(bound) } else { T::zero() },
            primitives,
            features: pair.features,
            barycentric: pair.barycentric.map(|weights| weights.map(T::round_from_f64)),
            is_intersecting: pair.is_intersecting,
        })
    }
}
