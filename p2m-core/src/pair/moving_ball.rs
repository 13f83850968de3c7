//! The first contact of a ball that moves along a segment, which is also known as a sphere cast.
//!
//! # Method
//!
//! Primitives are convex, so the distance between the moving centre and a primitive is a convex function of the
//! parameter. The first parameter at which a primitive is within a distance R is therefore found by bisection, between
//! the start and the parameter at which the primitive is nearest. The search for pairs finds some primitive within R of
//! the path, and the path is cut off at its parameter. This is repeated until no primitive is within R of the rest of
//! the path. If primitives are found in a random order, the expected number of searches is logarithmic in the number of
//! primitives near the path.
//!
//! # Rounding
//!
//! R is the radius plus a margin. The margin is the tolerance, or a few roundings of the coordinates if that is more.
//! Finally one search for the nearest pair returns a certified lower bound on the distance between the scene and the
//! path up to the parameter. If the bound is not above the radius, because the primitives have errors beyond the
//! margin, the margin is multiplied by 8 and the whole search is repeated. The loop ends, since the margin grows until
//! the bound is above the radius or the start is within R.
//!
//! Let s be the largest magnitude of a coordinate of the path. A component of the centre a (1 - t) + b t is computed
//! with at most 4 u s + 2 eta of error, so the centre is off by less than 8 u s + 4 eta. The certified bound is reduced
//! by this amount.
//!
//! # Contacts that open
//!
//! A contact at the start is *opening* if the ball never comes nearer to the primitive than it is at the start, to
//! within 64 u (s + radius). The distance is convex, so the ball then never deepens this contact by more. Both
//! distances are true ones, rounded once, because errors of the kernel grow with the primitive. If the ball ignores
//! opening contacts, their primitives are left out of all searches.

use super::query::search_hull;
use super::{NearestPair, PairOptions, PairQuery, Pairs, nearest_of_hulls};
use crate::certified::true_distance;
use crate::kernel::vector::{V3, largest};
use crate::query::answer::ROUND_UP;
use crate::real::{from_f64_array, to_f64_array};
use crate::{Feature, PrimitiveId, Real};
use nalgebra::Point3;
use std::marker::PhantomData;
use std::ops::ControlFlow;

/// A ball whose centre moves along a segment.
///
/// ```
/// use nalgebra::Point3;
/// use p2m_core::pair::MovingBall;
/// use p2m_core::{BruteForce, Triangle};
///
/// let floor = [Triangle::new(Point3::new(-9.0, -9.0, 0.0), Point3::new(9.0, -9.0, 0.0), Point3::new(0.0, 9.0, 0.0))];
/// let scene = BruteForce::new(&floor)?;
/// let ball = MovingBall::new(Point3::new(0.0, 0.0, 5.0), Point3::new(0.0, 0.0, -5.0), 1.0);
/// let contact = ball.first_contact(&scene).expect("the ball falls through the floor");
/// assert!(contact.parameter <= 0.4 && 0.4 - contact.parameter < 1e-12);
/// assert!(contact.point.coords.norm() < 1e-12);
/// let passing = MovingBall::new(Point3::new(0.0, 0.0, 5.0), Point3::new(9.0, 9.0, 5.0), 1.0);
/// assert!(passing.first_contact(&scene).is_none());
/// # Ok::<(), p2m_core::BuildError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct MovingBall<T: Real> {
    /// The centre at the parameter 0.
    pub start: Point3<T>,
    /// The centre at the parameter 1.
    pub end: Point3<T>,
    /// The radius, in units of the scene.
    pub radius: T,
    /// The distance by which a contact may be reported too early, in units of the scene. The default is 0, which leaves
    /// a few roundings. A negative number and NaN count as 0.
    pub tolerance: T,
    /// Whether the ball ignores primitives that it touches at the start and does not approach, to within 64 u (s +
    /// radius), where s is the largest coordinate of the path. The default is `false`.
    pub ignores_opening: bool,
}

/// The first contact of a moving ball with a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct BallContact<T: Real> {
    /// The parameter of the contact, from 0 to 1, rounded down. The ball certainly touches nothing before it.
    pub parameter: T,
    /// A parameter at which the scene is certainly within [`distance_bound`](Self::distance_bound) of the centre. It
    /// exceeds `parameter` by about 2^-48, and is rounded up.
    pub upper_parameter: T,
    /// A certified upper bound on the distance between the scene and the centre at the upper parameter. It exceeds the
    /// radius by at most the tolerance and a few roundings, unless the ball starts nearer.
    pub distance_bound: T,
    /// The point of the scene that is nearest to the centre at the upper parameter.
    pub point: Point3<T>,
    /// The primitive that contains the point. Ties go to the lowest id.
    pub primitive: PrimitiveId,
    /// The feature of the primitive that contains the point.
    pub feature: Feature,
}

/// The difference below which two parameters count as equal.
const PARAMETER_RESOLUTION: f64 = f64::EPSILON * 4.0;
/// The number of searches that end at the first primitive with an earlier contact. A later search evaluates all
/// primitives near the path, so that no order of primitives makes the loop long. There is no record of how the number
/// was tuned.
const SHORT_SEARCHES: usize = 64;

impl<T: Real> MovingBall<T> {
    /// Creates a ball that moves from one centre to another.
    #[must_use]
    pub fn new(start: Point3<T>, end: Point3<T>, radius: T) -> Self {
        Self { start, end, radius, tolerance: T::zero(), ignores_opening: false }
    }
    /// Sets the distance by which a contact may be reported too early.
    #[must_use]
    pub fn with_tolerance(self, tolerance: T) -> Self {
        Self { tolerance, ..self }
    }
    /// Ignores primitives that the ball touches at the start and does not approach, so that a ball can leave the
    /// surface on which it rests. A ball that slides over several primitives still touches the next one. All guarantees
    /// hold for the remaining contacts. The test takes about twenty microseconds per touched primitive.
    ///
    /// ```
    /// use nalgebra::Point3;
    /// use p2m_core::pair::MovingBall;
    /// use p2m_core::{BruteForce, Segment};
    ///
    /// let bar = |z| Segment::new(Point3::new(-9.0, 0.0, z), Point3::new(9.0, 0.0, z));
    /// let scene = BruteForce::new([bar(0.0), bar(7.0)])?;
    /// let ball = MovingBall::new(Point3::new(0.0, 0.0, 1.0), Point3::new(0.0, 0.0, 11.0), 1.0);
    /// assert_eq!(ball.first_contact(&scene).map(|contact| contact.parameter), Some(0.0));
    /// let contact = ball.ignoring_opening().first_contact(&scene).expect("the upper bar");
    /// assert!(contact.parameter <= 0.5 && 0.5 - contact.parameter < 1e-12);
    /// # Ok::<(), p2m_core::BuildError>(())
    /// ```
    #[must_use]
    pub fn ignoring_opening(self) -> Self {
        Self { ignores_opening: true, ..self }
    }

    /// Returns the first contact with the scene of an index. It is `None` if the ball touches nothing, if the radius is
    /// negative, and if a coordinate or the radius is not finite.
    ///
    /// If the ball touches the scene at the start, the parameter is 0. A ball that does not move touches the scene
    /// there or nowhere. Only surfaces count: a ball inside of a closed surface touches it from inside.
    ///
    /// # Panics
    /// Panics if the scene has primitives without vertices.
    ///
    /// # Accuracy
    /// There is certainly no contact before the parameter, and none at all if the answer is `None`. At the upper
    /// parameter the distance exceeds the radius by at most the tolerance, or 64 u (s + radius) if that is more, plus
    /// the error of a distance between primitives; s is the largest coordinate of the path. Primitives near the path
    /// may have larger errors and so need a larger margin, which is then at most 8 times the least one that suffices. A
    /// ball that passes the scene at a distance within this margin of its radius may be reported as a contact. If the
    /// path is nearly tangential, a small error of the distance is a larger error of the parameter. Indexes agree to
    /// within these errors, but not bit for bit.
    ///
    /// # Complexity
    /// It takes a logarithmic number of searches for pairs, and about fifty distance evaluations for each.
    pub fn first_contact<I: PairQuery<T> + ?Sized>(&self, index: &I) -> Option<BallContact<T>> {
        let (start, end) = (to_f64_array(&self.start), to_f64_array(&self.end));
        let mut path = Path { index, scalar: PhantomData, start, end, left_out: Vec::new() };
        let radius = self.radius.to_f64();
        // The comparison is false for NaN.
        let is_valid = [path.start, path.end].as_flattened().iter().all(|x| x.is_finite()) && radius.is_finite();
        if !(is_valid && radius >= 0.0) {
            return None;
        }
        let size = largest(&[path.start, path.end]);
        let rounding = 64.0 * f64::UNIT_ROUNDOFF * (size + radius) + 64.0 * f64::SMALLEST_SUBNORMAL;
        // `max` ignores NaN.
        let mut margin = self.tolerance.to_f64().max(rounding);
        loop {
            if self.ignores_opening {
                path.left_out = path.opening_within(radius + margin, rounding);
            }
            let contact = path.first_within(radius + margin);
            let parameter = contact.map_or(1.0, |[low, _]| low);
            if parameter == 0.0 || path.lower_bound_until(parameter)? - self.path_error() > radius {
                return contact.and_then(|contact| self.contact(&path, contact));
            }
            margin *= 8.0;
        }
    }

    /// Returns the centre at a parameter, rounded.
    #[must_use]
    pub fn centre_at(&self, parameter: T) -> Point3<T> {
        from_f64_array(centre_at(to_f64_array(&self.start), to_f64_array(&self.end), parameter.to_f64()))
    }

    /// Returns a bound on the distance between a centre computed in f64 and the exact one.
    fn path_error(&self) -> f64 {
        let size = largest(&[to_f64_array(&self.start), to_f64_array(&self.end)]);
        8.0 * f64::UNIT_ROUNDOFF * size + 4.0 * f64::SMALLEST_SUBNORMAL
    }

    /// Returns the answer for a bracket of the first contact.
    fn contact<I: PairQuery<T> + ?Sized>(
        &self,
        path: &Path<'_, T, I>,
        [low, high]: [f64; 2],
    ) -> Option<BallContact<T>> {
        let upper_parameter: T = -T::round_down_from_f64(-high);
        // For f32, the centre is taken at the rounded parameter.
        let hull = [path.centre_at(upper_parameter.to_f64())];
        let mut pairs = Pairs::nearest(&PairOptions::<f64>::default()).without(&path.left_out);
        search_hull(path.index, &hull, None, &mut pairs);
        let nearest = pairs.finish::<f64>()?;
        // The certified distance of the nearest primitive is that of its own pair.
        let pair = path.pair_of(nearest.primitives[0], hull[0]);
        let upper = (pair.key.distance() + pair.error + self.path_error()) * ROUND_UP + 8.0 * f64::SMALLEST_SUBNORMAL;
        Some(BallContact {
            parameter: T::round_down_from_f64(low),
            upper_parameter,
            distance_bound: -T::round_down_from_f64(-upper),
            point: from_f64_array(nearest.points[0].coords.into()),
            primitive: nearest.primitives[0],
            feature: nearest.features[0],
        })
    }
}

fn centre_at(start: V3, end: V3, t: f64) -> V3 {
    std::array::from_fn(|k| start[k] * (1.0 - t) + end[k] * t)
}

/// The path of a centre in a scene.
struct Path<'a, T, I: ?Sized> {
    index: &'a I,
    scalar: PhantomData<T>,
    start: V3,
    end: V3,
    /// Ignored primitives, in ascending order.
    left_out: Vec<PrimitiveId>,
}

impl<T: Real, I: PairQuery<T> + ?Sized> Path<'_, T, I> {
    fn centre_at(&self, t: f64) -> V3 {
        centre_at(self.start, self.end, t)
    }

    /// Returns the part of the path up to a parameter.
    fn until(&self, t: f64) -> [V3; 2] {
        [self.start, self.centre_at(t)]
    }

    /// Returns the nearest points of a primitive and a point.
    fn pair_of(&self, primitive: PrimitiveId, point: V3) -> NearestPair {
        nearest_of_hulls(self.index.hull(primitive).vertices(), &[point], f64::INFINITY)
            .expect("no key exceeds infinity")
    }

    /// Returns the primitives within a distance of the start to which the path comes no nearer than its start, up to a
    /// tolerance.
    fn opening_within(&self, distance: f64, tolerance: f64) -> Vec<PrimitiveId> {
        let mut opening = Vec::new();
        let mut visit = |[id, _]: [PrimitiveId; 2], _: &NearestPair| {
            let hull = self.index.hull(id);
            let [on_path, at_start] =
                [&self.until(1.0)[..], &[self.start]].map(|points| true_distance(hull.vertices(), points));
            if on_path >= at_start - tolerance {
                opening.push(id);
            }
            ControlFlow::Continue(())
        };
        let within = PairOptions::<f64>::default().with_max_distance(distance);
        search_hull(self.index, &[self.start], None, &mut Pairs::each(&within, &mut visit));
        opening.sort_unstable();
        opening.dedup();
        opening
    }

    /// Returns a certified lower bound on the distance of the scene from the path until a parameter; `None`
    /// for an empty scene.
    fn lower_bound_until(&self, t: f64) -> Option<f64> {
        let mut pairs = Pairs::nearest(&PairOptions::<f64>::default()).without(&self.left_out);
        search_hull(self.index, &self.until(t), None, &mut pairs);
        Some(pairs.finish::<f64>()?.lower_bound)
    }

    /// Returns a bracket of the first parameter at which the scene is within a distance, up to rounding; `None`
    /// if it never is.
    fn first_within(&self, distance: f64) -> Option<[f64; 2]> {
        let (mut best, mut last): (Option<[f64; 2]>, _) = (None, None);
        for search in 0.. {
            let end = best.map_or(1.0, |[_, high]| high);
            let mut is_improved = false;
            let mut visit = |ids: [PrimitiveId; 2], pair: &NearestPair| {
                // The primitive of the last contact touches the end of the path, so it is not an earlier contact.
                if last == Some(ids[0]) {
                    return ControlFlow::Continue(());
                }
                let [low, high] = self.first_within_of(ids[0], distance, end * pair.barycentric[1][1]);
                if best.is_some_and(|[_, best]| high >= best - PARAMETER_RESOLUTION) {
                    return ControlFlow::Continue(());
                }
                (best, last, is_improved) = (Some([low, high]), Some(ids[0]), true);
                if search < SHORT_SEARCHES || high == 0.0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            };
            let within = PairOptions::default().with_max_distance(distance);
            let mut pairs = Pairs::each(&within, &mut visit).without(&self.left_out);
            search_hull(self.index, &self.until(end), None, &mut pairs);
            let is_at_start = best.is_some_and(|[_, high]| high == 0.0);
            if !is_improved || is_at_start || search >= SHORT_SEARCHES {
                break;
            }
        }
        // Contacts that are earlier by less than the resolution were skipped.
        best.map(|[low, high]| [(low - 2.0 * PARAMETER_RESOLUTION).max(0.0), high])
    }

    /// Returns a bracket of the first parameter at which a primitive is within a distance. At `nearest` it is,
    /// up to rounding.
    fn first_within_of(&self, primitive: PrimitiveId, distance: f64, nearest: f64) -> [f64; 2] {
        let is_within = |t: f64| self.pair_of(primitive, self.centre_at(t)).key.distance() <= distance;
        if is_within(0.0) {
            return [0.0; 2];
        }
        let (mut low, mut high) = (0.0, nearest);
        while high - low > PARAMETER_RESOLUTION / 8.0 {
            let middle = low * 0.5 + high * 0.5;
            *(if is_within(middle) { &mut high } else { &mut low }) = middle;
        }
        [low, high]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BruteForce, Segment, Triangle};

    fn point(x: f64, y: f64, z: f64) -> Point3<f64> {
        Point3::new(x, y, z)
    }

    fn floor() -> [Triangle<f64>; 1] {
        [Triangle::new(point(-90.0, -90.0, 0.0), point(90.0, -90.0, 0.0), point(0.0, 90.0, 0.0))]
    }

    fn contact(scene: &[impl crate::Primitive<f64>], ball: &MovingBall<f64>) -> Option<BallContact<f64>> {
        ball.first_contact(&BruteForce::new(scene).expect("valid"))
    }

    #[test]
    fn contacts_are_those_of_closed_forms() {
        let post = [crate::Point::new(point(0.0, 0.0, 0.0))];
        let pipe = [Segment::new(point(-5.0, 0.0, 0.0), point(5.0, 0.0, 0.0))];
        let falls = |radius| MovingBall::new(point(0.0, 0.0, 8.0), point(0.0, 0.0, -8.0), radius);
        // The ball passes at a distance of 0.6, and touches the scene 0.8 before the middle.
        let passes = MovingBall::new(point(-4.0, 0.6, 0.0), point(4.0, 0.6, 0.0), 1.0);
        let slides = MovingBall::new(point(-20.0, 0.0, 3.0), point(20.0, 0.0, 1.0), 2.0);
        let cases = [
            (contact(&floor(), &falls(2.0)), 6.0 / 16.0),
            (contact(&pipe, &falls(2.0)), 6.0 / 16.0),
            (contact(&post, &falls(0.0)), 0.5),
            (contact(&post, &passes), 3.2 / 8.0),
            (contact(&floor(), &slides), 0.5),
        ];
        for (number, (found, expected)) in cases.into_iter().enumerate() {
            let found = found.expect("a contact");
            assert!(found.parameter <= expected && expected - found.parameter <= 1e-11, "{number}: {found:?}");
            assert!(found.upper_parameter >= found.parameter, "{number}: {found:?}");
            assert!(found.upper_parameter - found.parameter <= 1e-14, "{number}: {found:?}");
        }
    }

    #[test]
    fn a_contact_at_the_start_has_the_parameter_zero() {
        for z in [-0.5, 0.0, 1.0] {
            let ball = MovingBall::new(point(0.0, 0.0, z), point(0.0, 9.0, 9.0), 1.0);
            let found = contact(&floor(), &ball).expect("in contact");
            assert_eq!((found.parameter, found.upper_parameter, found.point), (0.0, 0.0, point(0.0, 0.0, 0.0)));
        }
    }

    #[test]
    fn a_ball_at_rest_touches_at_the_start_or_nowhere() {
        let at_rest = |z: f64| MovingBall::new(point(0.0, 0.0, z), point(0.0, 0.0, z), 1.0);
        assert_eq!(contact(&floor(), &at_rest(0.5)).map(|found| found.parameter), Some(0.0));
        assert_eq!(contact(&floor(), &at_rest(1.0 + 1e-11)), None);
    }

    #[test]
    fn a_ball_that_rolls_touches_and_one_above_it_does_not() {
        let along = |z: f64| MovingBall::new(point(-5.0, 0.0, z), point(5.0, 0.0, z), 1.0);
        assert_eq!(contact(&floor(), &along(1.0)).map(|found| found.parameter), Some(0.0));
        assert_eq!(contact(&floor(), &along(1.0 + 1e-11)), None);
        assert_eq!(
            contact(&floor(), &along(1.0 + 1e-11).with_tolerance(1e-10)).map(|found| found.parameter),
            Some(0.0)
        );
        // The ball grazes a sphere around a point at the middle of its path.
        let post = [crate::Point::new(point(0.0, 0.0, 0.0))];
        let found = contact(&post, &along(1.0)).expect("a contact within rounding");
        assert!(found.parameter <= 0.5 && found.parameter > 0.5 - 1e-7, "{found:?}");
        assert_eq!(contact(&post, &along(1.0 + 1e-11)), None);
    }

    #[test]
    fn contacts_that_open_are_ignored_and_others_are_not() {
        let leaves = |z: f64, end: [f64; 3]| {
            contact(&floor(), &MovingBall::new(point(0.0, 0.0, z), end.into(), 1.0).ignoring_opening())
        };
        // The ball rises, slides, starts deep and rises, and does not move.
        for (z, end) in [(1.0, [0.0, 3.0, 4.0]), (1.0, [5.0, 0.0, 1.0]), (0.3, [0.0, 0.0, 9.0]), (0.3, [0.0, 0.0, 0.3])]
        {
            assert_eq!(leaves(z, end), None, "from {z} to {end:?}");
        }
        // The ball sinks from the start, from within the margin, and from deep inside; it goes through the floor.
        for (z, end) in [(1.0, [0.0, 3.0, 0.9]), (1.0, [0.0, 0.0, -9.0]), (0.3, [0.0, 0.0, -9.0])] {
            assert_eq!(leaves(z, end).map(|found| found.parameter), Some(0.0), "from {z} to {end:?}");
        }
        // A tolerance does not let the ball sink. The errors of a large tilted floor neither let it sink nor hold it.
        let sinks = MovingBall::new(point(0.0, 0.0, 1.0), point(0.0, 0.0, 0.9901), 1.0).with_tolerance(0.01);
        assert!(contact(&floor(), &sinks.ignoring_opening()).is_some());
        let tilted = [Triangle::new(
            point(-757179.6374510855, 45381.96560256183, 956357.3985845932),
            point(6231.222047825344, -1067886.3590815386, -655423.4478254236),
            point(757566.8750134711, 835098.155642776, -422733.3678861386),
        )];
        let start = point(0.7635531245480458, -0.3599742105222726, 0.5399099931075867);
        let end = point(0.7635531244756709, -0.3599742104864832, 0.5399099930485868);
        let ball = MovingBall::new(start, end, 0.9999999999446227);
        assert!(contact(&tilted, &ball.ignoring_opening()).is_some());
        let tilted = [Triangle::new(
            point(100.98650461909278, 5.7654661723437926, 68.32631473036949),
            point(-19.633762753754567, 95.60895047363204, -78.57126669120117),
            point(-85.52936092160977, -84.6674871190063, -4.01808975682669),
        )];
        let start = point(-0.5701337985118745, 0.42416812776892987, 0.7084746081302903);
        let end = point(-0.6306399769886378, 0.4101228804568591, 0.6746850624973458);
        let ball = MovingBall::new(start, end, 1.0000000000000007);
        assert!(contact(&tilted, &ball).is_some() && contact(&tilted, &ball.ignoring_opening()).is_none());
        // The ball leaves the floor, and touches the wall at the end of its path.
        let mut scene = vec![crate::Shape::Triangle(floor()[0])];
        let corners = [point(5.0, -90.0, -90.0), point(5.0, 90.0, -90.0), point(5.0, 0.0, 90.0)];
        scene.push(crate::Shape::Triangle(Triangle::new(corners[0], corners[1], corners[2])));
        let ball = MovingBall::new(point(0.0, 0.0, 1.0), point(8.0, 0.0, 2.0), 1.0);
        assert_eq!(contact(&scene, &ball).map(|found| found.parameter), Some(0.0));
        let found = contact(&scene, &ball.ignoring_opening()).expect("the wall");
        assert!((found.parameter - 0.5).abs() < 1e-11 && found.primitive.index() == 1, "{found:?}");
    }

    #[test]
    fn what_is_not_finite_touches_nothing() {
        let (low, high) = (point(0.0, 0.0, -5.0), point(0.0, 0.0, 5.0));
        let nan = point(f64::NAN, 0.0, 0.0);
        assert!(contact(&floor(), &MovingBall::new(low, high, 1.0)).is_some());
        for ball in [
            MovingBall::new(nan, high, 1.0),
            MovingBall::new(low, nan, 1.0),
            MovingBall::new(low, high, f64::NAN),
            MovingBall::new(low, high, f64::INFINITY),
            MovingBall::new(low, high, -1.0),
        ] {
            assert_eq!(contact(&floor(), &ball), None);
        }
        let empty: [Triangle<f64>; 0] = [];
        assert_eq!(contact(&empty, &MovingBall::new(low, high, 1.0)), None);
        let anywhere = MovingBall::new(low, high, 1.0).with_tolerance(f64::INFINITY);
        assert_eq!(contact(&floor(), &anywhere).map(|found| found.parameter), Some(0.0));
    }

    #[test]
    fn many_primitives_in_the_worst_order_take_few_searches() {
        // Each wall is touched before all walls with a lower id.
        let wall = |x: f64| Segment::new(point(x, -1.0, 0.0), point(x, 1.0, 0.0));
        let walls: Vec<_> = (0..3_000).map(|i| wall(3_000.0 - f64::from(i))).collect();
        let ball = MovingBall::new(point(-1.0, 0.0, 0.0), point(4e3, 0.0, 0.0), 0.5);
        let found = contact(&walls, &ball).expect("a wall");
        assert_eq!((found.primitive.index(), found.point), (2_999, point(1.0, 0.0, 0.0)));
    }
}
