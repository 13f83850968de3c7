//! The collector of near pairs of primitives, its options, and the answer of a search for pairs.

use super::NearestPair;
use crate::query::answer::{ROUND_DOWN, square_within};
use crate::real::from_f64_array;
use crate::{Feature, PrimitiveId, Real};
use nalgebra::{Isometry3, Point3};
use std::ops::ControlFlow;

/// The options of a search for pairs.
///
/// ```
/// use nalgebra::{Isometry3, Point3};
/// use p2m_core::pair::{PairOptions, PairQuery};
/// use p2m_core::{BruteForce, Segment};
///
/// let pipe = |y: f64| [Segment::new(Point3::new(0.0, y, 0.0), Point3::new(9.0, y, 0.0))];
/// let (first, second) = (BruteForce::new(pipe(0.0))?, BruteForce::new(pipe(4.0))?);
/// // The second pipe has a radius of 1, and is moved towards the first one.
/// let options = PairOptions::default().with_radius(1.0).with_motion(Isometry3::translation(0.0, -1.0, 0.0));
/// assert_eq!(first.closest_pair(&second, &options).map(|pair| pair.distance), Some(2.0));
/// # Ok::<(), p2m_core::BuildError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct PairOptions<T: Real> {
    /// The largest distance of an answer, inclusive, in units of the scene. It is infinite by default. With 0, only
    /// primitives that intersect are answers, and no others whose distance rounds to 0.
    pub max_distance: T,
    /// The motion of the second scene. It is applied to each vertex in f64, and each coordinate is rounded; the answer
    /// is exact for the rounded vertices. `None`, the default, leaves the scene where it is.
    pub motion: Option<Isometry3<f64>>,
    /// The radius around the shape or the second scene, in units of the scene: all points within this distance belong
    /// to it, so a segment becomes a capsule. It is 0 by default. Nothing is near a shape with a negative or NaN
    /// radius.
    pub radius: T,
    /// A pair that is probably near, such as the answer for the previous motion. It is evaluated first, so a good hint
    /// saves most of the search; it never changes the answer. Ids that a scene does not have are ignored.
    pub hint: Option<[PrimitiveId; 2]>,
}

impl<T: Real> Default for PairOptions<T> {
    fn default() -> Self {
        Self { max_distance: T::INFINITY, motion: None, radius: T::zero(), hint: None }
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
    /// Sets the radius around the shape or the second scene.
    #[must_use]
    pub fn with_radius(self, radius: T) -> Self {
        Self { radius, ..self }
    }
    /// Sets a pair that is probably near.
    #[must_use]
    pub fn with_hint(self, hint: [PrimitiveId; 2]) -> Self {
        Self { hint: Some(hint), ..self }
    }
}

/// The nearest points of two scenes, or of a scene and a shape. Lengths are in units of the scenes. In arrays of two,
/// the first entry belongs to the first scene.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ClosestPair<T: Real> {
    /// The nearest points; the point of the second scene is given after the motion. With a radius, the second point is
    /// moved towards the first by the radius, or equals the first one if the scenes intersect.
    pub points: [Point3<T>; 2],
    /// The distance between the scenes, which is 0 if they intersect. With a radius it is the distance between the
    /// primitives less the radius, rounded.
    pub distance: T,
    /// A certified lower bound on the true distance. It holds for the second scene as rounded by its motion
    /// ([`Motion`](super::Motion)).
    pub lower_bound: T,
    /// The primitives that contain the points. Ties go to the lowest id in the first scene, then to the lowest id in
    /// the second. A shape has the id 0.
    pub primitives: [PrimitiveId; 2],
    /// The features of these primitives that contain the points.
    pub features: [Feature; 2],
    /// The weights of the vertices of each primitive.
    pub barycentric: [[T; 3]; 2],
    /// Whether the two primitives intersect, which is exact. If it is false, no two primitives intersect. With a radius
    /// it is whether the computed distance between the primitives is at most the radius.
    pub is_intersecting: bool,
}

/// A collector of pairs: it receives the pairs that a search finds, and decides which parts the search may skip.
pub struct Pairs<'a> {
    /// The largest f64 distance between primitives that is reported as within the largest distance.
    reach: f64,
    /// The radius around the second scene.
    radius: f64,
    /// The square above which lower bounds are pruned.
    prune: f64,
    mode: Mode<'a>,
    /// The offsets that are added to the ids that a search offers.
    offsets: [usize; 2],
    /// Primitives of the first scene that are ignored, in ascending order.
    left_out: &'a [PrimitiveId],
    /// Whether nothing can be within reach.
    is_empty: bool,
    /// Whether the visitor ended the search.
    has_ended: bool,
}

/// Pairs with the ids of their primitives.
type Found = Vec<([PrimitiveId; 2], NearestPair)>;

enum Mode<'a> {
    /// The nearest pair so far, and the smallest certified lower bound of all pairs.
    Nearest { best: Option<([PrimitiveId; 2], NearestPair)>, certified: f64 },
    /// All pairs within reach.
    Each(&'a mut dyn FnMut([PrimitiveId; 2], &NearestPair) -> ControlFlow<()>),
    /// All pairs that may be nearest, given the error bounds of the kernel. The true distance of some pair is at most
    /// `upper_bound`.
    Certification { upper_bound: f64, best: Option<([PrimitiveId; 2], NearestPair)>, found: Found },
}

impl<'a> Pairs<'a> {
    fn new<T: Real>(options: &PairOptions<T>, mode: Mode<'a>) -> Self {
        let (largest, radius) = (options.max_distance.to_f64(), options.radius.to_f64());
        let reach = match (largest, radius) {
            (_, radius) if radius > 0.0 => largest + radius,
            // Only primitives that intersect are within 0, not every distance that rounds to 0.
            (0.0, _) => 0.0,
            _ => options.max_distance.to_f64_above(),
        };
        // Nothing is within a NaN or negative distance.
        let is_valid = largest >= 0.0 && radius >= 0.0;
        Self {
            reach,
            radius,
            prune: square_within(reach),
            mode,
            offsets: [0, 0],
            left_out: &[],
            is_empty: !is_valid,
            has_ended: false,
        }
    }

    /// Creates the collector of the nearest pair within the largest distance of the options.
    #[must_use]
    pub fn nearest<T: Real>(options: &PairOptions<T>) -> Self {
        Self::new(options, Mode::Nearest { best: None, certified: f64::INFINITY })
    }

    /// Creates the collector that calls a function for each pair within the largest distance of the options, until the
    /// function breaks.
    #[must_use]
    pub fn each<T: Real>(
        options: &PairOptions<T>,
        visit: &'a mut dyn FnMut([PrimitiveId; 2], &NearestPair) -> ControlFlow<()>,
    ) -> Self {
        Self::new(options, Mode::Each(visit))
    }

    /// Ignores primitives of the first scene, whose ids are in ascending order.
    pub(crate) fn without(self, left_out: &'a [PrimitiveId]) -> Self {
        Self { left_out, ..self }
    }

    /// Creates a collector of all pairs that may be nearest, if the nearest one is within the largest distance of the
    /// options. The radius is not added to that distance.
    pub(crate) fn for_certification<T: Real>(options: &PairOptions<T>) -> Self {
        let options = PairOptions { radius: T::zero(), ..*options };
        let upper_bound = options.max_distance.to_f64_above();
        Self::new(&options, Mode::Certification { upper_bound, best: None, found: Vec::new() })
    }

    /// Returns the pairs that may be nearest, each once, from a collector [for certification](Self::for_certification).
    pub(crate) fn certification_candidates(self) -> Found {
        let Mode::Certification { upper_bound, mut found, .. } = self.mode else { return Vec::new() };
        found.retain(|(_, pair)| lower_bound(pair) <= upper_bound);
        found.sort_unstable_by_key(|(ids, _)| *ids);
        found.dedup_by_key(|(ids, _)| *ids);
        found
    }

    /// Returns the nearest pair so far.
    fn best(&self) -> Option<&([PrimitiveId; 2], NearestPair)> {
        match &self.mode {
            Mode::Nearest { best, .. } | Mode::Certification { best, .. } => best.as_ref(),
            Mode::Each(_) => None,
        }
    }

    /// Returns the square above which the kernel may skip a pair that no bound excludes. Rounding may let a key exceed
    /// a limit that the true distance does not, so for certified answers the kernel evaluates all such pairs.
    #[inline]
    pub(crate) fn kernel_limit(&self) -> f64 {
        if matches!(self.mode, Mode::Certification { .. }) { f64::INFINITY } else { self.prune }
    }

    /// Returns the square above which a lower bound excludes a pair.
    #[inline]
    #[must_use]
    pub fn prune_above(&self) -> f64 {
        self.prune
    }

    /// Sets the offsets that are added to the ids that a search offers, for scenes of several trees.
    pub(crate) fn set_offsets(&mut self, offsets: [usize; 2]) {
        self.offsets = offsets;
    }

    /// Converts ids of primitives of the searched trees to ids of their scenes.
    fn scene_ids(&self, ids: [PrimitiveId; 2]) -> [PrimitiveId; 2] {
        [0, 1].map(|i| PrimitiveId::new(ids[i].index() + self.offsets[i]))
    }

    /// Returns the distance beyond which nothing can change the answer, or NaN once the search is over.
    #[doc(hidden)]
    #[must_use]
    pub fn reach(&self) -> f64 {
        if self.is_done() { f64::NAN } else { self.prune.sqrt() * (1.0 + 8.0 * f64::EPSILON) }
    }

    /// Returns whether the search is over.
    #[inline]
    #[must_use]
    pub fn is_done(&self) -> bool {
        self.is_empty || self.has_ended
    }

    /// Returns whether the function that was passed to [`each`](Self::each) has ended the search.
    #[must_use]
    pub fn has_ended(&self) -> bool {
        self.has_ended
    }

    /// Returns whether only the nearest pair counts.
    #[doc(hidden)]
    #[must_use]
    pub fn is_nearest(&self) -> bool {
        !matches!(self.mode, Mode::Each(_))
    }

    /// Returns the vector between the points of the nearest pair so far, from the first scene to the second.
    #[doc(hidden)]
    #[must_use]
    pub fn separation(&self) -> Option<[f64; 3]> {
        self.best().map(|(_, pair)| (pair.points[1] - pair.points[0]).into())
    }

    /// Returns whether no pair of primitives with at least these ids can change the answer, if the square of the gap
    /// between their boxes is at least `square`. Such a pair could only tie with the nearest one, which has lower ids.
    ///
    /// Keys are never below the gap, so this is exact. For certified answers, keys only decide whether primitives
    /// intersect.
    #[inline]
    pub(crate) fn is_settled(&self, square: f64, ids: impl FnOnce() -> [PrimitiveId; 2]) -> bool {
        let Some((best, pair)) = self.best() else { return false };
        let can_only_tie = match &self.mode {
            Mode::Certification { .. } => pair.is_intersecting,
            Mode::Nearest { .. } | Mode::Each(_) => pair.key.plain_square().is_some_and(|key| key <= square),
        };
        can_only_tie && *best <= self.scene_ids(ids())
    }

    /// Returns whether a pair is within reach. Only pairs that intersect are within 0. The distance of any other pair
    /// is positive, even if it rounds to 0.
    fn is_within(&self, pair: &NearestPair) -> bool {
        pair.is_intersecting || self.reach > 0.0 && pair.key.distance() <= self.reach
    }

    /// Takes the kernel's result for a pair of primitives.
    pub fn offer_result(&mut self, ids: [PrimitiveId; 2], result: Result<NearestPair, f64>) {
        match (result, &mut self.mode) {
            (Ok(pair), _) => self.offer(ids, &pair),
            (Err(bound), Mode::Nearest { certified, .. }) => *certified = certified.min(bound),
            (Err(_), Mode::Each(_) | Mode::Certification { .. }) => {}
        }
    }

    /// Takes a pair of primitives.
    pub fn offer(&mut self, ids: [PrimitiveId; 2], pair: &NearestPair) {
        let distance = pair.key.distance();
        let ids = self.scene_ids(ids);
        if self.left_out.binary_search(&ids[0]).is_ok() {
            return;
        }
        let is_within = self.is_within(pair);
        match &mut self.mode {
            Mode::Nearest { best, certified } => {
                // A distance beyond the range of f64 is at least the largest number.
                *certified = certified.min(distance.min(f64::MAX) - pair.error);
                let is_better = best.as_ref().is_none_or(|(others, other)| (pair.key, ids) < (other.key, *others));
                if is_better && is_within {
                    *best = Some((ids, *pair));
                    self.prune = self.prune.min(pair.key.square_above());
                }
            }
            Mode::Each(visit) => {
                if is_within {
                    self.has_ended |= visit(ids, pair).is_break();
                }
            }
            Mode::Certification { upper_bound, best, found } => {
                if best.as_ref().is_none_or(|(others, other)| (pair.key, ids) < (other.key, *others)) {
                    *best = Some((ids, *pair));
                }
                if lower_bound(pair) <= *upper_bound {
                    found.push((ids, *pair));
                }
                // The sum is rounded up, and a smallest subnormal covers the rounding of the distance. The comparison
                // is false for NaN.
                let at_most = (distance + pair.error) * (1.0 + 4.0 * f64::EPSILON) + 8.0 * f64::from_bits(1);
                if at_most < *upper_bound {
                    *upper_bound = at_most;
                    self.prune = self.prune.min(square_within(at_most));
                }
            }
        }
    }

    /// Returns the nearest pair, or `None` if none is within reach.
    #[must_use]
    pub fn finish<T: Real>(self) -> Option<ClosestPair<T>> {
        let Mode::Nearest { best: Some((primitives, pair)), certified } = self.mode else { return None };
        let between = pair.key.distance();
        // Everything that was pruned is farther than the best pair, whose square is exact to 5 u.
        let bound =
            certified.min(between.min(f64::MAX) * ROUND_DOWN) * ROUND_DOWN - 8.0 * f64::from_bits(1) - self.radius;
        let [on_first, on_second] = pair.points;
        let on_second = if self.radius == 0.0 {
            on_second
        } else if between <= self.radius {
            on_first
        } else {
            on_second + (on_first - on_second) * (self.radius / between)
        };
        Some(ClosestPair {
            points: [on_first, on_second].map(|point| from_f64_array(point.coords.into())),
            distance: T::round_from_f64((between - self.radius).max(0.0)),
            lower_bound: if bound > 0.0 { T::round_down_from_f64(bound.next_down()) } else { T::zero() },
            primitives,
            features: pair.features,
            barycentric: pair.barycentric.map(|weights| weights.map(T::round_from_f64)),
            is_intersecting: pair.is_intersecting || (self.radius > 0.0 && between <= self.radius),
        })
    }
}

/// Returns a lower bound on the true distance of a pair.
fn lower_bound(pair: &NearestPair) -> f64 {
    // A distance beyond the range of f64 is at least the largest number.
    pair.key.distance().min(f64::MAX) * ROUND_DOWN - pair.error - 8.0 * f64::from_bits(1)
}
