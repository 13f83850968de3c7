//! The workload of an index, and the sample of its queries whose work is counted.

use chacha20::ChaCha8Rng;
use chacha20::rand_core::{Rng, SeedableRng};
use nalgebra::{Point3, Vector3};
use p2m_core::{Primitive, PrimitiveId, PrimitiveSet, Soup};
use std::borrow::Cow;

/// The height of a triangle, as a fraction of its longest edge, below which it is a sliver.
///
/// No record exists of how this and the next constants were chosen; docs/measurements/auto.md has the choices that
/// result from them.
const SLIVER_HEIGHT_PER_EDGE: f64 = 1.0 / 256.0;
/// The number of triangles that are examined for slivers.
const SLIVER_TEST_TRIANGLES: usize = 4096;
/// The standard deviation of generated queries near the surface, as a fraction of the diagonal.
const NEAR_DEVIATION_PER_DIAGONAL: f64 = 0.01;
/// The smallest and the largest number of queries that are counted.
const COUNTED: [u64; 2] = [8, 512];
/// One query in this many is counted.
const QUERIES_PER_COUNTED: u64 = 200;

/// The region that queries come from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum QueryRegion<'a> {
    /// About a hundredth of the diagonal of the scene away from its surface.
    NearSurface,
    /// Anywhere in the box of the scene.
    SceneBox,
    /// Where these points are, which are an example of the queries.
    Like(&'a [Point3<f64>]),
}

/// The work that an index is needed for, and the limits on the index.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Workload<'a> {
    /// The number of queries.
    pub queries: u64,
    /// The region that queries come from.
    pub region: QueryRegion<'a>,
    /// The largest number of bytes that the index may occupy besides the scene; unlimited by default. The default tree
    /// may exceed it, because there is no smaller index.
    pub max_bytes: usize,
    /// The largest distance of an answer; unlimited by default.
    pub max_distance: f64,
    /// Whether an exhaustive search is excluded, because the index is saved or answers other queries as well; false by
    /// default.
    pub needs_index: bool,
}

impl<'a> Workload<'a> {
    /// Describes a number of queries from a region, without limits.
    #[must_use]
    pub fn new(queries: u64, region: QueryRegion<'a>) -> Self {
        Self { queries, region, max_bytes: usize::MAX, max_distance: f64::INFINITY, needs_index: false }
    }

    /// Sets the largest number of bytes that the index may occupy.
    #[must_use]
    pub fn with_max_bytes(self, max_bytes: usize) -> Self {
        Self { max_bytes, ..self }
    }

    /// Sets the largest distance of an answer.
    #[must_use]
    pub fn with_max_distance(self, max_distance: f64) -> Self {
        Self { max_distance, ..self }
    }

    /// Sets whether an exhaustive search is excluded.
    #[must_use]
    pub fn with_needs_index(self, needs_index: bool) -> Self {
        Self { needs_index, ..self }
    }

    /// Returns whether there are so few queries that the work of one in 200 of them means nothing.
    pub(super) fn has_few_queries(&self) -> bool {
        self.queries < COUNTED[0] * QUERIES_PER_COUNTED
    }

    /// Returns one in 200 queries, but at least 8 and at most 512 of them.
    #[allow(clippy::cast_possible_truncation, reason = "at most 512")]
    pub(super) fn counted_queries(&self, soup: &Soup<f64>) -> Vec<Point3<f64>> {
        let [least, most] = COUNTED;
        let wanted = (self.queries / QUERIES_PER_COUNTED).clamp(least, most) as usize;
        let sample = match self.region {
            QueryRegion::Like(points) => Cow::Borrowed(points),
            region => Cow::Owned(generate(soup, region == QueryRegion::NearSurface, most as usize)),
        };
        sample.iter().step_by(sample.len().div_ceil(wanted).max(1)).take(wanted).copied().collect()
    }
}

/// Returns queries near the surface of a scene or in its box; none for an empty scene.
fn generate(soup: &Soup<f64>, is_near: bool, count: usize) -> Vec<Point3<f64>> {
    let count = if soup.is_empty() { 0 } else { count };
    let mut random = ChaCha8Rng::seed_from_u64(soup.len() as u64);
    let mut unit = move || (random.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
    let bounds = soup.aabb();
    let sigma = NEAR_DEVIATION_PER_DIAGONAL * (bounds.max.coords * 0.5 - bounds.min.coords * 0.5).norm() * 2.0;
    let mut query = || {
        if is_near {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "below the count")]
            let i = (unit() * soup.len() as f64) as usize;
            let bounds = soup.get(PrimitiveId::new(i.min(soup.len() - 1))).aabb();
            // The sum of three uniform numbers is approximately normal. Scaled like this, its variance is 1/3, so
            // the offset has variance 1.
            let mut offset = || (unit() + unit() + unit() - 1.5) * 2.0 * 0.58;
            let centre = Point3::from(bounds.min.coords * 0.5 + bounds.max.coords * 0.5);
            return centre + Vector3::new(offset(), offset(), offset()) * sigma;
        }
        Point3::from(std::array::from_fn::<f64, 3, _>(|k| {
            let t = unit();
            bounds.min[k] * (1.0 - t) + bounds.max[k] * t
        }))
    };
    (0..count).map(|_| query()).collect()
}

/// Returns whether most primitives are slivers.
///
/// Many slivers are about equally near to a query, so lists are long and cells fall back to a tree.
pub(super) fn is_mostly_slivers(soup: &Soup<f64>) -> bool {
    let is_sliver = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|i| soup.positions()[i as usize]);
        let longest_squared = (b - a).norm_squared().max((c - b).norm_squared()).max((a - c).norm_squared());
        (b - a).cross(&(c - a)).norm() < SLIVER_HEIGHT_PER_EDGE * longest_squared
    };
    let step = soup.triangles().len().div_ceil(SLIVER_TEST_TRIANGLES).max(1);
    let slivers = soup.triangles().iter().step_by(step).filter(|t| is_sliver(t)).count();
    2 * slivers * step > soup.len()
}
