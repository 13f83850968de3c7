//! Signed distances: the side of a surface that a point is on.
//!
//! [`SignedDistance`] adds a sign to the answers of any index over triangles. A point is inside if its generalised
//! winding number \[Jacobson2013\] exceeds a half in magnitude ([`SignRule::Winding`]). The triangles may have holes,
//! be unconnected, overlap or intersect each other.
//!
//! A surface is *closed* if each edge has an even number of triangles. It is *oriented* if as many triangles run
//! through each edge in one direction as in the other; every oriented surface is closed. The winding number of an
//! oriented surface is an integer: the signed number of crossings of a ray, which is decided without rounding. The
//! normal at the closest point gives the same sign without a ray, and is used where that is proved. Surfaces that are
//! closed but not oriented have their signs by parity ([`SignRule::Parity`]), unless another rule is chosen.
//!
//! ```
//! use nalgebra::Point3;
//! use p2m_core::{BruteForce, ClosestPoint};
//! use p2m_mixed::generate::{IcoSphere, ico_sphere};
//! use p2m_field::sign::{Sign, SignedDistance};
//!
//! let ball = ico_sphere(&IcoSphere::default()).unwrap();
//! let signed = SignedDistance::new(BruteForce::new(&ball).unwrap(), &ball)?;
//! let centre = signed.closest_point(&[0.0; 3]).unwrap();
//! assert_eq!(centre.sign, Sign::Inside);
//! assert!(centre.distance().unwrap() < -0.9);
//! # Ok::<(), p2m_field::sign::SignError>(())
//! ```

mod block;
mod caps;
mod certificate;
mod contains;
mod crowding;
mod edge_sums;
mod flood;
mod local;
mod near;
mod normals;
mod solid_angles;
mod surface;
mod triangle;
mod types;
mod winding;

pub(crate) use block::PointBlock;
pub use edge_sums::EdgeSums;
pub use normals::Normals;
pub use types::{SharedSoup, Sign, SignError, SignRule, Signed};
pub use winding::WindingNumbers;

use certificate::Certificates;
use nalgebra::Point3;
use p2m_bvh::TreeIndex;
use p2m_core::batch::{self, BatchOptions};
use p2m_core::{Aabb, BatchAnswer, Closest, ClosestPoint, Hits, Position, QueryOptions, Ray, RayQuery, Real, Soup};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};
use surface::Surface;
use types::{check_kinds, ray};

/// An index over triangles whose answers have signs.
///
/// `I` is the index, and `S` a pointer to its scene: `&Soup<f64>` to borrow it, or `Arc<Soup<f64>>` to share it, so
/// that one value has everything and can be moved, cloned and sent to other threads:
///
/// ```
/// use nalgebra::Point3;
/// use p2m_core::Soup;
/// use p2m_field::sign::{Sign, SharedDistance, SignedDistance};
/// use p2m_mixed::generate::{IcoSphere, ico_sphere};
/// use std::sync::Arc;
///
/// struct World {
///     walls: SharedDistance,
/// }
///
/// let ball: Arc<Soup<f64>> = Arc::new(ico_sphere(&IcoSphere::default()).unwrap());
/// let world = World { walls: SignedDistance::build(ball)? };
/// let inside = std::thread::spawn(move || world.walls.closest_point(&[0.0; 3]).unwrap().sign);
/// assert_eq!(inside.join().unwrap(), Sign::Inside);
/// # Ok::<(), p2m_field::sign::SignError>(())
/// ```
///
/// An index in f32 has signs as well: give it the scene converted to f64, which is exact, and queries in f32.
#[derive(Clone)]
pub struct SignedDistance<I, S> {
    index: I,
    signs: Arc<Signs<S>>,
}

/// Signed distances by an AABB tree over a scene that is shared.
pub type SharedDistance = SignedDistance<TreeIndex<f64, Arc<Soup<f64>>, Aabb<f64>>, Arc<Soup<f64>>>;

impl<I, S> std::fmt::Debug for SignedDistance<I, S> {
    /// Writes the name of the rule. The index and its tables are left out, because they are as large as the scene.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("SignedDistance").field("rule", &self.signs.rule).finish_non_exhaustive()
    }
}

/// The assumed number of queries of a batch per sign that has to be decided, where neighbours share signs. Near a
/// surface fewer queries share a sign; if more signs have to be decided than assumed, certificates are prepared later.
const QUERIES_PER_SIGN: usize = 16;
/// The number of queries that are passed to an index at once.
const BATCH_LEN: usize = 512;

/// The rule of signs of a scene, with the tables that decide them.
struct Signs<S> {
    soup: S,
    rule: SignRule,
    winding: WindingNumbers<S>,
    /// Whether each edge has an even number of triangles.
    is_even: bool,
    /// Whether signs change at the surface alone.
    is_closed: bool,
    /// The proved facts about the normals of a closed surface, once there are enough queries for them to pay.
    certificates: OnceLock<Certificates<S>>,
    /// Whether a thread prepares the certificates or has prepared them.
    is_prepared: AtomicBool,
    /// The unit roundoff of the index.
    roundoff: f64,
    bounds: Aabb<f64>,
    ray_count: AtomicU64,
}

/// The number of rays per triangle above which certificates are prepared, counting the rays so far and the queries of
/// the next batch. Casting so many rays takes about as long as preparing them.
const RAYS_PER_TRIANGLE: f64 = 2.0;

impl SharedDistance {
    /// Builds an AABB tree over triangles, with signs as [`SignedDistance::new`] makes them. A scene of its own is
    /// shared by `Arc::new(soup)`.
    ///
    /// # Errors
    /// It returns the errors of [`SignedDistance::new`].
    pub fn build(soup: Arc<Soup<f64>>) -> Result<Self, SignError> {
        Self::new(TreeIndex::new(Arc::clone(&soup))?, soup)
    }
}

impl<I, S: SharedSoup> SignedDistance<I, S> {
    /// Makes signs for any triangles. `index` has to be an index over `soup`.
    ///
    /// The rule is [`SignRule::Winding`], except for surfaces that are closed but not oriented, where it is
    /// [`SignRule::Parity`] ([the module](self) defines both words). Vertices are welded where they have the same
    /// coordinates. An empty scene is not an error.
    ///
    /// # Accuracy
    /// Signs of oriented surfaces and signs by parity come from an exact count of crossings (proved,
    /// [docs/proofs/fields.md]). Other winding numbers have an error bound that is proved except for the rounding of
    /// solid angles, which is observed. Where the bound does not decide, the sign is [`Sign::Undefined`].
    ///
    /// # Errors
    /// [`SignError::OtherKinds`], [`SignError::OtherScene`] and [`SignError::Build`].
    ///
    /// # Complexity
    /// O(n log n) time, and the same again once enough signs have been requested for certificates to pay. Then memory
    /// is 100 bytes per triangle and 36 bytes per vertex. A boundary edge takes 300 bytes.
    ///
    /// [docs/proofs/fields.md]: https://github.com/p2m-rs/p2m/blob/main/docs/proofs/fields.md
    pub fn new<T: Real>(index: I, soup: S) -> Result<Self, SignError>
    where
        I: ClosestPoint<T>,
    {
        Self::prepare(index, soup, None)
    }

    /// Makes signs by a rule of your choice.
    ///
    /// # Errors
    /// The errors of [`new`](Self::new), and [`SignError::Open`] for [`SignRule::Parity`] if an edge has an odd number
    /// of triangles.
    ///
    /// # Complexity
    /// Same as [`new`](Self::new).
    pub fn with_rule<T: Real>(index: I, soup: S, rule: SignRule) -> Result<Self, SignError>
    where
        I: ClosestPoint<T>,
    {
        Self::prepare(index, soup, Some(rule))
    }

    fn prepare<T: Real>(index: I, soup: S, rule: Option<SignRule>) -> Result<Self, SignError>
    where
        I: ClosestPoint<T>,
    {
        check_scene(&index, &soup)?;
        let signs = Signs::new(soup, rule, T::UNIT_ROUNDOFF, index.rays().is_some())?;
        Ok(Self { index, signs: Arc::new(signs) })
    }

    /// Returns the rule that decides signs.
    pub fn rule(&self) -> SignRule {
        self.signs.rule
    }

    /// Returns whether the sign can change only at the surface. This holds for the rule parity, and for oriented
    /// surfaces by the rule winding.
    pub fn is_closed(&self) -> bool {
        self.signs.is_closed
    }

    /// Returns a sentence for people that says what the rule means for this surface, unless the surface is oriented.
    pub fn note(&self) -> Option<&'static str> {
        match self.signs.rule {
            _ if self.signs.winding.is_closed() => None,
            SignRule::Winding if self.signs.is_even => Some(
                "the surface is closed, but its triangles have different orientations: points are inside where the \
                 winding number exceeds a half in magnitude, which means little there",
            ),
            SignRule::Winding => Some(
                "the surface is open: points are inside where the winding number exceeds a half in magnitude, which is \
                 a guess near holes",
            ),
            SignRule::Parity => Some(
                "the surface is closed, but its triangles have different orientations: points are inside where a ray \
                 crosses it an odd number of times",
            ),
        }
    }

    /// Returns the winding number of a point, as [`WindingNumbers::number`] does.
    #[must_use]
    pub fn winding_number<T: Real>(&self, point: &Point3<T>, accuracy: f64) -> f64
    where
        I: ClosestPoint<T>,
    {
        self.signs.winding.number_by(&point.map(Real::to_f64), accuracy, self.index.rays())
    }

    /// Returns the index.
    pub fn index(&self) -> &I {
        &self.index
    }

    /// Returns the closest point and the sign of a query.
    pub fn closest_point<T: Real>(&self, query: &impl Position<T>) -> Option<Signed<T>>
    where
        I: ClosestPoint<T>,
    {
        self.closest_point_with(query, &QueryOptions::default())
    }

    /// Returns the closest point within the limits of `options`, and the sign of a query. With an epsilon the sign
    /// follows from the approximate closest point.
    pub fn closest_point_with<T: Real>(&self, query: &impl Position<T>, options: &QueryOptions<T>) -> Option<Signed<T>>
    where
        I: ClosestPoint<T>,
    {
        let query = query.point();
        let closest = self.index.closest_point_with(&query, options)?;
        Some(self.with_sign(&query, closest))
    }

    /// Returns the closest points and the signs of queries, in their order, computed as a [`batch`].
    pub fn closest_points<T: Real>(
        &self,
        queries: &[Point3<T>],
        options: &QueryOptions<T>,
        batch: &BatchOptions,
    ) -> Vec<Option<Signed<T>>>
    where
        I: ClosestPoint<T> + Sync,
    {
        self.signs.prepare_for(queries.len());
        let mut out = vec![None; queries.len()];
        answer_parts(&self.index, queries, options, batch, &mut out, || {
            |query: &Point3<T>, found: BatchAnswer<'_, T>| found.closest().map(|closest| self.with_sign(query, closest))
        });
        out
    }

    /// Writes the signed distances of queries, in their order, computed as a [`batch`]: NaN where the sign is not
    /// defined, and infinity where there is no answer. `index` is an index over the same scene.
    ///
    /// The values equal the distances of [`closest_points`](Self::closest_points), but neighbours share signs: if the
    /// surface is closed, all points within a ball whose radius is the distance of its centre from the surface have one
    /// sign, and so do the points of two such balls that intersect.
    pub fn distances_into<T: Real>(
        &self,
        index: &(impl ClosestPoint<T> + Sync + ?Sized),
        queries: &[Point3<T>],
        options: &QueryOptions<T>,
        batch: &BatchOptions,
        out: &mut [T],
    ) where
        I: ClosestPoint<T> + Sync,
    {
        self.signs.prepare_for(queries.len() / QUERIES_PER_SIGN);
        answer_parts(index, queries, options, batch, out, || {
            let mut balls = [KnownBall::default(); 2];
            move |query: &Point3<T>, found: BatchAnswer<'_, T>| self.distance_of(query, &found, &mut balls)
        });
    }

    /// Returns the signed distance of a query, given the answer to it. `balls` are known balls of outside and of inside
    /// points, from earlier queries.
    fn distance_of<T: Real>(&self, query: &Point3<T>, found: &BatchAnswer<'_, T>, balls: &mut [KnownBall; 2]) -> T
    where
        I: ClosestPoint<T>,
    {
        let Some((distance, _)) = found.distance_and_index() else { return T::INFINITY };
        let point = query.map(Real::to_f64);
        let side_of = |radius: f64| balls.iter().position(|ball| ball.meets(&point, radius));
        let with_side = |side: usize| if side == 1 { -distance } else { distance };
        if distance > T::zero()
            && let Some(side) = side_of(0.0)
        {
            return with_side(side);
        }
        let Some(closest) = found.closest() else { return T::INFINITY };
        let radius = closest.lower_bound.to_f64();
        if radius > 0.0
            && let Some(side) = side_of(radius)
        {
            balls[side] = KnownBall { centre: point, radius };
            return with_side(side);
        }
        let signed = self.with_sign(query, closest);
        let is_inside = signed.sign == Sign::Inside;
        if self.is_closed() && (is_inside || signed.sign == Sign::Outside) {
            balls[usize::from(is_inside)] = KnownBall { centre: point, radius };
        }
        signed.distance().unwrap_or(T::round_from_f64(f64::NAN))
    }

    /// Returns the answer to a query whose closest point is known, with its sign.
    pub fn with_sign<T: Real>(&self, query: &Point3<T>, closest: Closest<T>) -> Signed<T>
    where
        I: ClosestPoint<T>,
    {
        Signed { closest, sign: self.sign(query, &closest) }
    }

    /// Returns the sign of a query by its closest point.
    pub(crate) fn sign<T: Real>(&self, query: &Point3<T>, closest: &Closest<T>) -> Sign
    where
        I: ClosestPoint<T>,
    {
        self.signs.sign(&query.map(Real::to_f64), closest, self.index.rays())
    }

    /// Returns the number of queries so far whose sign a ray or a winding number has decided, because the
    /// closest point did not.
    pub fn ambiguous_count(&self) -> u64 {
        self.signs.ray_count.load(Ordering::Relaxed)
    }
}

impl<I: ClosestPoint<f64>, S: SharedSoup> SignedDistance<I, S> {
    /// Returns the sign of a point that is not on the surface, without its closest point.
    pub(crate) fn sign_without_closest_point(&self, point: &Point3<f64>) -> Sign {
        self.signs.sign_without_closest_point(point, self.index.rays())
    }

    /// Returns the common sign of all points of a ball that the surface does not cross, or `None` if they may differ.
    pub(crate) fn sign_in_ball(&self, radius: f64, centre: &Point3<f64>) -> Option<Sign> {
        if self.is_closed() {
            Some(self.sign_without_closest_point(centre))
        } else {
            self.signs.winding.sign_in_ball(radius, centre, self.index.rays())
        }
    }
}

/// Answers queries in the parts of a [`batch`]. For each part, `begin` makes a function that turns answers into
/// results. Queries are passed to the index in the order of the batch, so that the function sees neighbours one after
/// the other and they can share signs.
fn answer_parts<T: Real, R: Send, F: FnMut(&Point3<T>, BatchAnswer<'_, T>) -> R>(
    index: &(impl ClosestPoint<T> + Sync + ?Sized),
    queries: &[Point3<T>],
    options: &QueryOptions<T>,
    batch: &BatchOptions,
    out: &mut [R],
    begin: impl Fn() -> F + Sync,
) {
    let position = |query: &Point3<T>| query.map(Real::to_f64);
    batch::map_parts_into(queries, batch, position, out, |queries, order, out| {
        let (mut answer, mut asked) = (begin(), [Point3::origin(); BATCH_LEN]);
        for order in order.chunks(BATCH_LEN) {
            let asked = &mut asked[..order.len()];
            asked.iter_mut().zip(order).for_each(|(query, i)| *query = queries[*i as usize]);
            index.answer_queries(asked, options, &mut |i, found| out[order[i] as usize] = answer(&asked[i], found));
        }
    });
}

/// An open ball without surface, whose points have one sign.
#[derive(Clone, Copy, Default)]
struct KnownBall {
    centre: Point3<f64>,
    /// The radius, or at most 0 if there is no ball.
    radius: f64,
}

impl KnownBall {
    /// Returns whether a point, or the open ball of this radius around it, certainly intersects the known ball. Then no
    /// surface separates the points of both. A radius of 0 stands for the point alone.
    fn meets(&self, point: &Point3<f64>, radius: f64) -> bool {
        let reach = self.radius + radius;
        // Smaller squares would lose digits to underflow, and an infinite square is never below another one. The factor
        // covers the rounding of both squares.
        self.radius > 1e-140 && (point - self.centre).norm_squared() < reach * reach * (1.0 - 1e-12)
    }
}

impl<S: SharedSoup> Signs<S> {
    fn new(soup: S, rule: Option<SignRule>, roundoff: f64, has_rays: bool) -> Result<Self, SignError> {
        check_kinds(&soup)?;
        let surface = Surface::new(&soup);
        let is_even = surface.open.is_none();
        let rule =
            rule.unwrap_or(if is_even && !surface.boundary.is_empty() { SignRule::Parity } else { SignRule::Winding });
        if let (SignRule::Parity, Some((triangle, edge))) = (rule, surface.open) {
            return Err(SignError::Open { triangle, edge });
        }
        let winding = WindingNumbers::of_surface(soup.clone(), &surface, !has_rays)?;
        let is_closed = rule == SignRule::Parity || winding.is_closed();
        let (certificates, is_prepared, ray_count) = (OnceLock::new(), AtomicBool::default(), AtomicU64::default());
        let bounds = soup.aabb();
        Ok(Self { soup, rule, winding, is_even, is_closed, certificates, is_prepared, roundoff, bounds, ray_count })
    }

    /// Prepares the certificates if they pay for this number of queries.
    fn prepare_for(&self, queries: usize) {
        let rays = self.ray_count.load(Ordering::Relaxed) as f64 + queries as f64;
        let pays = self.is_closed && rays > RAYS_PER_TRIANGLE * self.soup.triangles().len() as f64;
        // Only one thread prepares them. The others go on with rays, because a thread that waits for work that it could
        // do itself may wait forever.
        if pays && self.certificates.get().is_none() && !self.is_prepared.swap(true, Ordering::Relaxed) {
            // An index over the scene was built, so a tree can be built as well.
            if let Ok(certificates) = Certificates::new(self.soup.clone(), self.roundoff) {
                let _ = self.certificates.set(certificates);
            }
        }
    }

    /// Returns the sign of a query by its closest point. Rays are cast on `rays`, if it is given.
    fn sign<T: Real>(&self, query: &Point3<f64>, closest: &Closest<T>, rays: Option<&dyn RayQuery<T>>) -> Sign {
        if closest.distance == T::zero() {
            return Sign::Boundary;
        }
        if query.iter().any(|x| !x.is_finite()) {
            return Sign::Outside;
        }
        if self.is_closed && !self.is_in_bounds(query) {
            return Sign::Outside;
        }
        let certificates = self.certificates.get();
        if let Some((certificates, side)) = certificates.and_then(|all| Some((all, all.side(query, closest)?))) {
            return self.sign_of(certificates.winding_number(side, || self.crossings(query, rays)));
        }
        self.ray_count.fetch_add(1, Ordering::Relaxed);
        if certificates.is_none() {
            self.prepare_for(0);
        }
        if closest.lower_bound <= T::zero() && self.is_on_surface(query, rays) {
            return Sign::Boundary;
        }
        self.sign_without_closest_point(query, rays)
    }

    /// Returns the sign of a point that is not on the surface.
    fn sign_without_closest_point<T: Real>(&self, point: &Point3<f64>, rays: Option<&dyn RayQuery<T>>) -> Sign {
        if !self.is_closed {
            self.winding.sign(point, rays)
        } else if self.is_in_bounds(point) {
            self.sign_of(self.crossings(point, rays))
        } else {
            Sign::Outside
        }
    }

    fn is_in_bounds(&self, point: &Point3<f64>) -> bool {
        (0..3).all(|k| self.bounds.min[k] <= point[k] && point[k] <= self.bounds.max[k])
    }

    /// Returns the number of crossings of a ray, by which the rule decides.
    fn crossings<T: Real>(&self, query: &Point3<f64>, rays: Option<&dyn RayQuery<T>>) -> i64 {
        match self.rule {
            SignRule::Winding => self.winding.crossings(query, rays),
            SignRule::Parity => {
                let count = self.winding.hits(&ray(query), Hits::crossings(), rays).count;
                i64::try_from(count).unwrap_or(0)
            }
        }
    }

    fn sign_of(&self, crossings: i64) -> Sign {
        let is_inside = match self.rule {
            SignRule::Winding => crossings != 0,
            SignRule::Parity => crossings % 2 != 0,
        };
        if is_inside { Sign::Inside } else { Sign::Outside }
    }

    /// Returns whether the query is exactly on a triangle.
    fn is_on_surface<T: Real>(&self, query: &Point3<f64>, rays: Option<&dyn RayQuery<T>>) -> bool {
        let here: Ray = ray(query).with_range(0.0, 0.0).expect("0 is a valid parameter");
        self.winding.hits(&here, Hits::count(), rays).count > 0
    }
}

/// Checks at vertices of some triangles whether an index can be over a scene of triangles.
///
/// A vertex is at the distance 0 from its scene, so no lower bound on its distance is above 0.
fn check_scene<T: Real>(index: &impl ClosestPoint<T>, soup: &Soup<f64>) -> Result<(), SignError> {
    const TRIANGLES: usize = 16;
    check_kinds(soup)?;
    let triangles = soup.triangles();
    for triangle in (0..triangles.len()).step_by(triangles.len().div_ceil(TRIANGLES).max(1)) {
        for (vertex, position) in triangles[triangle].into_iter().enumerate() {
            let query = soup.positions()[position as usize].map(T::round_from_f64);
            let is_on_scene = index
                .closest_point(&query)
                .is_some_and(|c| c.lower_bound <= T::zero() && c.primitive.index() < triangles.len());
            if !is_on_scene && query.iter().all(|x| x.is_finite()) {
                return Err(SignError::OtherScene { triangle, vertex });
            }
        }
    }
    Ok(())
}
