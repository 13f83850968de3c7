//! Scenes in f64 that an index keeps in f32.
//!
//! Every vertex is moved to the middle of the scene's box and rounded, so the scene that is searched differs from the user's by
//! what rounding moves a vertex at most. A triangle is the convex hull of its vertices, so it and the distance to it change by
//! no more: |d - d'| <= m + w, where m is the largest move of a vertex and w that of the query. Both are measured, not estimated. That is
//! 2^-24 of half of the box's diagonal at most, for queries in the box, wherever it lies.

use crate::real::{narrow, wide};
use crate::{
    Best, BuildError, BuildIndex, Closest, ClosestPoint, Collector, Key, PrimitiveSet, Projection, QueryOptions, Real,
    Soup,
};
use nalgebra::Point3;

/// An index over a scene in f64 of which positions are kept in f32: half the memory for the scene, and a stated error.
///
/// The index itself is as large as over f64, and as fast: its tree has exact vertices in f64 in any case. Answers are about the
/// user's scene: without other approximations its distance is off by at most `distance - lower_bound`, on either side, of which
/// 2^-24 of the distance, and a smallest subnormal of f32, are for its own rounding. A bound of zero says nothing of the other
/// side: that close, what rounding moved is as large as the distance.
///
/// ```
/// use nalgebra::Point3;
/// use p2m_core::{BruteForce, ClosestPoint, Element, Soup, StoredInF32};
///
/// // A millionth beside 100,000 is lost to f32, but not once the scene is moved to its middle.
/// let positions = vec![Point3::new(1e5, 0.0, 0.0), Point3::new(1e5 + 1.0, 1e-6, 0.0)];
/// let soup = Soup::new(positions, [Element::Segment([0, 1])]).unwrap();
/// let index = StoredInF32::<BruteForce<Soup<f32>>>::build(&soup, &()).unwrap();
/// let query = Point3::new(1e5 + 1.0, 1.0, 0.0);
/// let answer = index.closest_point(&query).unwrap();
/// let error = answer.distance - answer.lower_bound;
/// assert!((answer.distance - (1.0 - 1e-6)).abs() <= error && error < 4e-7);
/// ```
#[derive(Clone, Debug)]
pub struct StoredInF32<I> {
    index: I,
    centre: [f64; 3],
    /// The largest move of a vertex.
    moved: f64,
}

/// A place in the frame of the scene, rounded, and how far that moved it at most.
fn rounded(place: &Point3<f64>, centre: &[f64; 3]) -> (Point3<f32>, f64) {
    let place = wide(place);
    let exact: [f64; 3] = std::array::from_fn(|k| place[k] - centre[k]);
    let stored: Point3<f32> = narrow(exact);
    // The difference of a number and its rounding is exact; the one before lost up to u of itself.
    let moved: [f64; 3] =
        std::array::from_fn(|k| (exact[k] - f64::from(stored[k])).abs() + exact[k].abs() * f64::EPSILON);
    // Rounded up, with some subnormals for where it is tiny.
    let length = Key::of_offset(moved).distance() * (1.0 + 8.0 * f64::EPSILON) + 4.0 * f64::from_bits(1);
    (stored, length)
}

impl<I> StoredInF32<I> {
    /// Builds an index over the scene as it is kept.
    ///
    /// # Errors
    /// Those of the index, of which [`BuildError::NonFinite`] also where a coordinate is beyond the range of f32 once the
    /// middle of the box is taken off.
    pub fn build(soup: &Soup<f64>, options: &I::Options) -> Result<Self, BuildError>
    where
        I: BuildIndex<f32, Soup<f32>, Error = BuildError>,
    {
        let bounds = soup.aabb();
        // Halves first: a sum of two finite numbers may not be finite.
        let centre: [f64; 3] = std::array::from_fn(|k| bounds.min[k] * 0.5 + bounds.max[k] * 0.5);
        let centre = centre.map(|x| if x.is_finite() { x } else { 0.0 });
        let places = soup.positions().iter().map(|position| rounded(position, &centre));
        let (positions, moves): (Vec<_>, Vec<f64>) = places.unzip();
        // Positions that nothing uses may be anything.
        let used = soup.elements().flat_map(|element| element.indices().to_vec());
        let moved = used.map(|i| moves[i as usize]).fold(0.0, f64::max);
        let index = I::build(Soup::new(positions, soup.elements())?, options)?;
        Ok(Self { index, centre, moved })
    }

    /// The index over the scene as it is kept: moved, and in f32.
    pub fn index(&self) -> &I {
        &self.index
    }
}

impl<I: ClosestPoint<f32>> ClosestPoint<f64> for StoredInF32<I> {
    fn search(&self, query: &Point3<f64>, best: &mut Best<f64>) {
        if let Some(Closest { point, distance, lower_bound, primitive, feature, barycentric }) =
            self.closest_point(query)
        {
            // The distance as it is reported, not that of the point, which was rounded once more.
            let key = Key::of_offset([distance, 0.0, 0.0]);
            best.offer(primitive, Projection { key, point, feature, barycentric, error: distance - lower_bound });
        }
    }

    /// `None` also for a query that is beyond the range of f32 once the middle of the scene is taken off; bounds stay in that range.
    fn closest_point_with(&self, query: &Point3<f64>, options: &QueryOptions<f64>) -> Option<Closest<f64>> {
        let (stored, moved) = rounded(query, &self.centre);
        let error = self.moved + moved;
        let found = self.index.closest_point_with(&stored, &narrowed(options, error))?;
        let point = Point3::from(std::array::from_fn(|k| self.centre[k] + f64::from(found.point[k])));
        let distance = match f64::from(found.distance) {
            // Beyond the range of f32; rounding the point moves it by less than the last error below.
            f64::INFINITY => {
                Key::of_offset(std::array::from_fn(|k| f64::from(found.point[k]) - f64::from(stored[k]))).distance()
            }
            distance => distance,
        };
        if distance > options.max_distance {
            return None;
        }
        // The distance may have been rounded down, where the bound was not.
        let error = error + distance * f64::from(f32::EPSILON) + f32::SMALLEST_SUBNORMAL;
        let lower = (f64::from(found.lower_bound) - error) * (1.0 - f64::EPSILON);
        Some(Closest {
            point,
            distance,
            lower_bound: lower.max(0.0),
            primitive: found.primitive,
            feature: found.feature,
            barycentric: found.barycentric.map(f64::from),
        })
    }
}

/// The options for the scene as it is kept: what is within a radius is found there if that is larger by an error.
#[allow(clippy::cast_possible_truncation, reason = "rounded to the safe side")]
fn narrowed(options: &QueryOptions<f64>, error: f64) -> QueryOptions<f32> {
    QueryOptions {
        max_distance: ((options.max_distance + error) as f32).next_up(),
        hint: options.hint,
        epsilon: (options.epsilon as f32).next_down().max(0.0),
        near_enough: (options.near_enough as f32).next_down().max(0.0),
        budget: options.budget,
    }
}
